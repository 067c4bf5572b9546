#include "model/measured_points.h"

#include "base/memory.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static char *skip(char *c)
{
  return c + strspn(c, " \t\r");
}

/** The factors that the units in parentheses of a heading's first two cells ask for. */
static int read_heading(const char *heading, const char *path, int line, const Units *units, double *factor,
                        Error *error)
{
  static const char *const dimensions[2] = {"1", "stress"};
  int status = BRECCIA_OK;
  const char *cell = heading;
  for (int k = 0; k < 2 && cell; ++k) {
    const char *comma = strchr(cell, ',');
    const int length = comma ? (int)(comma - cell) : (int)strcspn(cell, "\r");
    const char *open = memchr(cell, '(', (size_t)length), *close = open ? strchr(open, ')') : NULL;
    const int size = close && close < cell + length ? (int)(close - open - 1) : 0;
    const char *word = cell + strspn(cell, " \"");
    if (k && !strncasecmp(word, "strain", 6))
      status = error_add(error, BRECCIA_USER_ERROR,
                         "%s:%d: the first two columns must be strain and stress of the curve; the second is '%.*s'",
                         path, line, length, cell);
    else if (size > 0 && strncmp(open, "(-)", 3) != 0) {
      Text reason = {0};
      char *one = text_format("1 %.*s", size, open + 1);
      if (!one || units_read(units, dimension_find(dimensions[k]), one, &factor[k], &reason))
        status = error_add(error, BRECCIA_USER_ERROR, "%s:%d: column %d, '%.*s': its unit is not one of %s", path, line,
                           k + 1, length, cell, k ? "stress, like kPa" : "strain, like % or 1");
      free(one);
      text_free(&reason);
    }
    cell = comma ? comma + 1 : NULL;
  }
  return status;
}

/** @return whether a row begins with two numbers and a comma between; `first` tells whether it begins with one at all */
static bool read_row(char *row, double *x, double *y, bool *first)
{
  char *end, *rest;
  *x = strtod(row, &end);
  *first = end != row;
  end = skip(end);
  if (!*first || *end != ',') return false;
  end = skip(end + 1);
  *y = strtod(end, &rest);
  const bool two = rest != end;
  rest = skip(rest);
  return two && (*rest == ',' || !*rest) && isfinite(*x) && isfinite(*y);
}

int measured_points_read(MeasuredPoints *p, const char *path, const Units *units, int least, Error *error)
{
  char *text = text_read_file(path, NULL);
  *p = (MeasuredPoints){.path = text_format("%s", path)};
  if (!text) return error_add(error, BRECCIA_USER_ERROR, "%s: measured points: %s", path, text_why_unread(errno));
  size_t rows = 1;
  for (const char *c = text; *c; ++c) rows += *c == '\n';
  p->x = memory_zeroed(rows, sizeof(double), "points", error);
  p->y = memory_zeroed(rows, sizeof(double), "points", error);
  p->line = memory_zeroed(rows, sizeof(int), "points", error);
  int status = p->path && p->x && p->y && p->line ? BRECCIA_OK : BRECCIA_FAILURE, line = 0;
  double factor[2] = {1, 1};
  const bool empty = !text[strspn(text, " \t\r\n")];
  for (char *row = text, *next; row && !status; row = next) {
    next = strchr(row, '\n');
    if (next) *next++ = 0;
    ++line;
    row += !strncmp(row, "\xef\xbb\xbf", 3) ? 3 : 0; /* a mark that spreadsheets write */
    char *begin = skip(row);
    if (!*begin || *begin == '#') continue;
    double x, y;
    bool number;
    if (read_row(begin, &x, &y, &number)) {
      p->x[p->count] = factor[0] * x;
      p->y[p->count] = factor[1] * y;
      p->line[p->count++] = line;
    } else if (!number && !p->count)
      status = read_heading(begin, path, line, units, factor, error);
    else
      status = error_add(error, BRECCIA_USER_ERROR,
                         "%s:%d: expected strain and stress with a comma between, like '0.001,25.3'%s; found '%.60s'",
                         path, line, strpbrk(begin, ";\t") ? " (and points in the numbers, no commas)" : "", begin);
  }
  free(text);
  if (!status && p->count < least)
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s: %s; expected at least %d rows of strain and stress with a comma between", path,
                       empty      ? "the file is empty"
                       : p->count ? "there is only one point"
                                  : "there are no numbers",
                       least);
  return status;
}

void measured_points_destroy(MeasuredPoints *p)
{
  free(p->path);
  free(p->x);
  free(p->y);
  free(p->line);
  *p = (MeasuredPoints){0};
}

typedef struct Range {
  double low, high, size; /* size: largest amount */
} Range;

static Range range_of(const double *v, int count)
{
  Range r = {INFINITY, -INFINITY, 0};
  for (int i = 0; i < count; ++i) {
    r.low = fmin(r.low, v[i]);
    r.high = fmax(r.high, v[i]);
  }
  r.size = fmax(fabs(r.low), fabs(r.high));
  return r;
}

int measured_points_opposed(const MeasuredPoints *p, const ElementCurve *curve, Error *error)
{
  const Range x = range_of(p->x, p->count), c = range_of(curve->x, curve->count);
  const double some = 0.02 * x.size, little = 0.02 * c.size;
  if (!(x.low >= -some && c.high <= little) && !(x.high <= some && c.low >= -little)) return BRECCIA_OK;
  return error_add(error, BRECCIA_USER_ERROR,
                   "%s: its strains reach %g and the test goes to %g: tension is positive here; change the sign of "
                   "strains and stresses, or of the test",
                   p->path, x.high > -x.low ? x.high : x.low, c.high > -c.low ? c.high : c.low);
}

void measured_points_doubt(const MeasuredPoints *p, const ElementTest *test, const ElementCurve *curve,
                           const Units *units, Error *doubts)
{
  const Range x = range_of(p->x, p->count), y = range_of(p->y, p->count), cx = range_of(curve->x, curve->count),
              cy = range_of(curve->y, curve->count);
  const double wide = x.high - x.low;
  char unit[64];
  units_name(units, dimension_find("stress"), unit, sizeof unit);
  if (x.size > 30 * cx.size)
    error_add(doubts, BRECCIA_USER_ERROR,
              "%s: its strains reach %g and the test goes to %g: if they are in per cent, say so in the heading, like "
              "'strain (%%),stress (%s)'",
              p->path, x.size, cx.size, unit);
  else if (x.high > cx.high + 0.02 * wide || x.low < cx.low - 0.02 * wide) {
    int beyond = 0;
    for (int i = 0; i < p->count; ++i) beyond += p->x[i] > cx.high + 0.02 * wide || p->x[i] < cx.low - 0.02 * wide;
    error_add(doubts, BRECCIA_USER_ERROR,
              "%s: %d of %d points lie at strains that the test does not reach (it goes from %g to %g): let it go as "
              "far%s",
              p->path, beyond, p->count, cx.low, cx.high,
              test->consolidation ? "; its strains count from the end of the consolidation" : "");
  }
  if (y.size > 0 && cy.size > 0 && (y.size > 100 * cy.size || y.size < cy.size / 100))
    error_add(doubts, BRECCIA_USER_ERROR,
              "%s: its stresses reach %g %s, those of the test %g %s: if they are in another unit, say so in the "
              "heading, like 'strain,stress (MPa)'; otherwise look at the units of the parameters",
              p->path, y.size, unit, cy.size, unit);
  /* Scatter turns back a little; a test that goes once to its strain does not turn back by a twentieth of it. */
  double farthest = p->count ? p->x[0] : 0;
  const double way = fabs(x.high) > fabs(x.low) ? 1 : -1;
  for (int i = 1; !test->turns && i < p->count; ++i) {
    if (way * p->x[i] >= way * farthest)
      farthest = p->x[i];
    else if (way * (farthest - p->x[i]) > 0.05 * wide) {
      error_add(doubts, BRECCIA_USER_ERROR,
                "%s:%d: the strain turns back from %g to %g, but the test goes once to its strain: give its 'cycles' "
                "and 'return strain', or 'stages', or leave such rows out",
                p->path, p->line[i], farthest, p->x[i]);
      break;
    }
  }
}
