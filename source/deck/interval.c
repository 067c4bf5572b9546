#include "deck/interval.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void interval_ends(const char *interval, double *low, double *high, bool *low_in, bool *high_in)
{
  char *end;
  *low_in = interval[0] == '[';
  *low = strtod(interval + 1, &end);
  while (*end == ',' || *end == ' ') ++end;
  *high = strtod(end, &end);
  *high_in = *end == ']';
}

bool interval_contains(const char *interval, double value)
{
  if (!interval) return true;
  double low, high;
  bool low_in, high_in;
  interval_ends(interval, &low, &high, &low_in, &high_in);
  return (value > low || (low_in && value == low)) && (value < high || (high_in && value == high));
}

bool interval_is_valid(const char *interval)
{
  char *end;
  if (*interval != '(' && *interval != '[') return false;
  const double low = strtod(interval + 1, &end);
  if (end == interval + 1 || *end != ',') return false;
  const char *second = end + 1;
  const double high = strtod(second, &end);
  return end != second && (*end == ')' || *end == ']') && !end[1] && low < high;
}

void interval_describe(const char *interval, char *words, size_t size)
{
  double low, high;
  bool low_in, high_in;
  interval_ends(interval, &low, &high, &low_in, &high_in);
  char below[48] = "", above[48] = "";
  if (isfinite(low)) snprintf(below, sizeof below, "%s %g", low_in ? "at least" : "greater than", low);
  if (isfinite(high)) snprintf(above, sizeof above, "%s %g", high_in ? "at most" : "less than", high);
  snprintf(words, size, "%s%s%s", below, *below && *above ? " and " : "", above);
}
