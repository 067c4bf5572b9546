#include "results/curve_names.h"

#include <stdio.h>
#include <string.h>

/** Adds the name between two places, which is split at its last dot. */
static int add_name(const char *begin, const char *end, CurveNames *names)
{
  const char *dot = NULL;
  while (begin < end && *begin == ' ') ++begin;
  while (end > begin && end[-1] == ' ') --end;
  const bool minus = begin < end && *begin == '-';
  for (begin += minus; begin < end && *begin == ' ';) ++begin;
  for (const char *c = begin; c < end; ++c)
    if (*c == '.') dot = c;
  if (!dot || dot == begin || dot + 1 == end || names->count == CURVE_COLUMNS) return 1;
  names->minus[names->count] = minus;
  snprintf(names->watch[names->count], CURVE_NAME, "%.*s", (int)(dot - begin), begin);
  snprintf(names->column[names->count++], CURVE_NAME, "%.*s", (int)(end - dot - 1), dot + 1);
  return 0;
}

int curve_names(const char *curve, CurveNames *names)
{
  const char *colon = strchr(curve, ':');
  names->count = 0;
  if (!colon || strchr(colon + 1, ':')) return 1;
  int bad = add_name(curve, colon, names);
  for (const char *rest = colon + 1; rest && !bad;) {
    const char *comma = strchr(rest, ',');
    bad = add_name(rest, comma ? comma : rest + strlen(rest), names);
    rest = comma ? comma + 1 : NULL;
  }
  return bad;
}
