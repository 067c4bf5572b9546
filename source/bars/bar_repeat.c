#include "bars/bar_repeat.h"

#include "bars/bars.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 10000 }; /* lines of one bar: a slab of a kilometre at 100 mm; more is a mistake of a unit */

enum { GAP_SHORT, GAP_EVEN, GAP_OPEN };

static const Field repeat_fields[] = {
    {.key = "along",
     .kind = FIELD_POINT,
     .offset = offsetof(RepeatSpec, along),
     .dimension = "1",
     .meaning = "direction in which the lines follow each other, of any length but zero"},
    {.key = "pitch",
     .kind = FIELD_NUMBER,
     .offset = offsetof(RepeatSpec, pitch),
     .dimension = "length",
     .range = "(0, inf)",
     .meaning = "from one line to the next"},
    {.key = "number",
     .kind = FIELD_COUNT,
     .offset = offsetof(RepeatSpec, number),
     .standard = "",
     .range = "[2, 10000]",
     .meaning = "of lines, with the first",
     .group = 'A'},
    {.key = "over",
     .kind = FIELD_NUMBER,
     .offset = offsetof(RepeatSpec, over),
     .dimension = "length",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "length over which there are lines, from the first on",
     .group = 'A'},
    {.key = "last gap",
     .kind = FIELD_CHOICE,
     .offset = offsetof(RepeatSpec, last_gap),
     .standard = "short",
     .words = (const char *const[]){[GAP_SHORT] = "short", [GAP_EVEN] = "even", [GAP_OPEN] = "open", NULL},
     .meaning = "where 'over' is no multiple of the pitch: 'short': a line at its end, with less than the pitch before "
                "it; 'even': all gaps alike, as many as make none longer than the pitch; 'open': no line beyond the "
                "last whole pitch"},
};

/** Gaps, as a number that need not be whole; roundings of a multiple are none. */
static double gaps(const RepeatSpec *r)
{
  const double found = r->over / r->pitch, whole = round(found);
  return fabs(found - whole) < 1e-9 * fmax(1, whole) ? whole : found;
}

/** Of a length, however many. */
static double lines(const RepeatSpec *r)
{
  return 1 + (r->last_gap == GAP_OPEN ? floor(gaps(r)) : ceil(gaps(r)));
}

static void check_repeat(const DeckReader *reader, void *section)
{
  const RepeatSpec *r = section;
  if (r->along[0] == 0 && r->along[1] == 0 && r->along[2] == 0)
    node_error(reader->document, section_node(r, "along"), reader->error, "along: must not be zero");
  if (isnan(r->over)) {
    const Node *node = section_node(r, "last gap");
    if (node != r->head.node)
      node_error(reader->document, node, reader->error,
                 "last gap: says how lines fill a length; with 'number' leave it out");
    return;
  }
  if (gaps(r) < 1 && r->last_gap == GAP_OPEN)
    node_error(reader->document, section_node(r, "over"), reader->error,
               "over: shorter than one pitch, so that there is only the first line; leave 'repeat' out");
  if (lines(r) > MOST)
    node_error(reader->document, section_node(r, "pitch"), reader->error,
               "pitch: makes %.6g lines, and a bar may have %d; look at the units", lines(r), MOST);
}

const Section repeat_section = {
    .name = "repeat",
    .about = "Lines like the first of a bar side by side at a pitch: stirrups along a beam, bars of a mesh. A list of "
             "two repeats the lines of the first along another direction.",
    .size = sizeof(RepeatSpec),
    FIELDS(repeat_fields),
    .check = check_repeat};

int64_t repeat_lines(const RepeatSpec *r)
{
  return isnan(r->over) ? r->number : (int64_t)lines(r);
}

double repeat_offset(const RepeatSpec *r, int64_t line)
{
  const int64_t last = repeat_lines(r) - 1;
  if (isnan(r->over) || r->last_gap == GAP_OPEN) return r->pitch * (double)line;
  if (r->last_gap == GAP_EVEN) return r->over * (double)line / (double)last;
  return line == last ? r->over : r->pitch * (double)line;
}

/** Lines of a bar of the deck. */
static double lines_of(const BarSpec *bar)
{
  double count = 1;
  for (int k = 0; k < bar->repeat.count; ++k) count *= (double)repeat_lines(bar->repeat.items[k]);
  return count;
}

void bar_check_repeat(const DeckReader *reader, const BarSpec *bar)
{
  if (bar->repeat.count > 2)
    node_error(reader->document, section_node(bar, "repeat"), reader->error,
               "repeat: one or two directions, and here are %d", bar->repeat.count);
  else if (lines_of(bar) > MOST)
    node_error(reader->document, section_node(bar, "repeat"), reader->error,
               "repeat: makes %.0f lines, and a bar may have %d; look at the units", lines_of(bar), MOST);
}

/** Moves a point to a line. */
static void move(const BarSpec *bar, int64_t line, double point[3])
{
  for (int k = 0; k < bar->repeat.count; ++k) {
    const RepeatSpec *r = bar->repeat.items[k];
    const int64_t lines = repeat_lines(r);
    const double by = repeat_offset(r, line % lines),
                 size = sqrt(r->along[0] * r->along[0] + r->along[1] * r->along[1] + r->along[2] * r->along[2]);
    for (int j = 0; j < 3; ++j) point[j] += by * (r->along[j] / size);
    line /= lines;
  }
}

/** A bar of one line. @return NULL: no memory */
static BarSpec *line_of(const BarSpec *bar, int64_t line)
{
  BarSpec *own = memory_zeroed(1, sizeof *own, "bars", NULL);
  const size_t numbers = 3 * (size_t)bar->points.count;
  double *points = memory_zeroed(numbers, sizeof *points, "bars", NULL);
  char *name = text_format("%s %lld", bar->head.name, (long long)line + 1);
  if (!own || !points || !name) {
    free(own);
    free(points);
    free(name);
    return NULL;
  }
  memcpy(points, bar->points.values, numbers * sizeof *points);
  for (int n = 0; n < bar->points.count; ++n) move(bar, line, points + 3 * n);
  *own = *bar;
  own->head.name = name;
  own->points.values = points;
  return own;
}

bool bar_lines_create(BarLines *lines, const SectionList *deck)
{
  int64_t all = 0;
  *lines = (BarLines){.deck = deck};
  for (int n = 0; n < deck->count; ++n) all += (int64_t)lines_of(deck->items[n]);
  lines->specs.items = memory_zeroed((size_t)all, sizeof *lines->specs.items, "bars", NULL);
  lines->first = memory_zeroed((size_t)deck->count + 1, sizeof *lines->first, "bars", NULL);
  bool whole = lines->specs.items && lines->first;
  for (int n = 0; n < deck->count && whole; ++n) {
    BarSpec *bar = deck->items[n];
    const int64_t count = (int64_t)lines_of(bar);
    for (int64_t line = 0; line < count && whole; ++line) {
      BarSpec *own = bar->repeat.count ? line_of(bar, line) : bar;
      whole = own != NULL;
      if (whole) lines->specs.items[lines->specs.count++] = own;
    }
    lines->first[n + 1] = lines->specs.count;
  }
  if (!whole) bar_lines_destroy(lines);
  return whole;
}

void bar_lines_destroy(BarLines *lines)
{
  for (int n = 0; lines->specs.items && n < lines->specs.count; ++n) {
    BarSpec *bar = lines->specs.items[n];
    if (!bar->repeat.count) continue; /* the deck's own */
    free((void *)bar->head.name);
    free(bar->points.values);
    free(bar);
  }
  free(lines->specs.items);
  free(lines->first);
  *lines = (BarLines){0};
}
