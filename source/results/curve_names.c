#include "results/curve_names.h"

#include <stdbool.h>
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

/** Words between two places without the spaces around them. */
static void trimmed(const char *begin, const char *end, char words[CURVE_NAME])
{
  while (begin < end && *begin == ' ') ++begin;
  while (end > begin && end[-1] == ' ') --end;
  snprintf(words, CURVE_NAME, "%.*s", (int)(end - begin), begin);
}

static bool of_all_histories(const char *words)
{
  return !strcmp(words, "time") || !strcmp(words, "step");
}

void curve_advise(const char *curve, Text *text)
{
  const char *colon = strchr(curve, ':');
  char side[2][CURVE_NAME];
  CurveNames other = {.count = 0};
  text_add(text,
           "curve: '%s' should be 'watch.column : watch.column', like 'opening.distance : pull.value', or with a minus "
           "'tip.y : -grip.y'",
           curve);
  if (!colon) return;
  trimmed(curve, colon, side[0]);
  trimmed(colon + 1, curve + strlen(curve), side[1]);
  for (int k = 0; k < 2; ++k) {
    const char *there = side[1 - k];
    const char *end = there + strcspn(there, ",");
    if (!of_all_histories(side[k]) || add_name(there, end, &other)) continue;
    text_add(text, "; each history has its %s: '%s%s%s.%s%s%s'", side[k], k ? there : "", k ? " : " : "",
             other.watch[0], side[k], k ? "" : " : ", k ? "" : there);
    return;
  }
}
