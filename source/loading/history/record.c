#include "loading/history/record.h"

#include "base/memory.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static char *read_text(const char *path, Error *error)
{
  char *text = text_read_file(path, NULL);
  if (!text) error_add(error, BRECCIA_USER_ERROR, "%s: %s", path, text_why_unread(errno));
  return text;
}

/** The number behind a word and its equals sign. @return NaN if there is none */
static double number_behind(const char *line, const char *word)
{
  for (const char *c = line; *c && *c != '\n'; ++c) {
    if (strncasecmp(c, word, strlen(word)) != 0) continue;
    char *end;
    const char *from = c + strlen(word) + strspn(c + strlen(word), " =");
    const double value = strtod(from, &end);
    if (end > from) return value;
  }
  return NAN;
}

/** Number of values and time step in seconds from the last line of the heading. */
static bool read_heading(const char *line, double *count, double *step)
{
  char *end, *next;
  *count = number_behind(line, "NPTS");
  *step = number_behind(line, "DT");
  if (!isnan(*count) && !isnan(*step)) return true;
  *count = strtod(line, &end);
  *step = strtod(end, &next);
  return end > line && next > end;
}

int record_read_peer(Record *record, const char *path, const Units *units, Error *error)
{
  char *text = read_text(path, error), *at = text;
  double count = 0, step = 0, unit = 1;
  if (!text) return BRECCIA_USER_ERROR;
  for (int line = 0; line < 3 && at; ++line) at = (at = strchr(at, '\n')) ? at + 1 : NULL;
  Text ignored = {0};
  units_read(units, dimension_find("time"), "1 s", &unit, &ignored);
  text_free(&ignored);
  int status = BRECCIA_OK;
  if (!at || !read_heading(at, &count, &step) || !(count >= 2) || count > 1e8 || !(step > 0))
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s:4: expected the number of values and the time step, like 'NPTS= 4000, DT= .005 SEC'", path);
  else if (!(record->rows = memory_zeroed((size_t)count * 2, sizeof(double), "record", error)))
    status = BRECCIA_FAILURE;
  at = status ? NULL : strchr(at, '\n');
  for (char *end; at && record->count < (int)count; at = end) {
    const double value = strtod(at, &end);
    if (end == at) break;
    record->rows[2 * record->count] = record->count * step * unit;
    record->rows[2 * record->count++ + 1] = value;
  }
  if (!status && (record->count < (int)count || at[strspn(at, " \t\r\n")]))
    status = error_add(error, BRECCIA_USER_ERROR, "%s: its heading says %g values, but it holds %s numbers", path,
                       count, record->count < (int)count ? "fewer" : "more");
  free(text);
  return status;
}

int record_read_plain(Record *record, const char *path, Error *error)
{
  static const char *const between = " \t\r,;";
  char *text = read_text(path, error);
  if (!text) return BRECCIA_USER_ERROR;
  size_t lines = 1;
  int status = BRECCIA_OK, number = 0;
  for (const char *c = text; *c; ++c) lines += *c == '\n';
  record->rows = memory_zeroed(2 * lines, sizeof(double), "record", error);
  if (!record->rows) status = BRECCIA_FAILURE;
  for (char *line = text, *next; line && *line && !status; line = next) {
    next = strchr(line, '\n');
    if (next) *next++ = 0;
    ++number;
    char *end, *last;
    const char *first = line + strspn(line, between);
    const double time = strtod(first, &end);
    if (!*first || (end == first && !record->count) || strchr("#%!", *first)) continue;
    const char *second = end + strspn(end, between);
    const double value = strtod(second, &last);
    if (end == first || last == second || last[strspn(last, between)]) {
      status = error_add(error, BRECCIA_USER_ERROR,
                         "%s:%d: expected two numbers, time and value, found '%.40s'; of a file with more columns and "
                         "a heading choose one with 'column'",
                         path, number, first);
    } else {
      record->rows[2 * record->count] = time;
      record->rows[2 * record->count++ + 1] = value;
    }
  }
  free(text);
  return status;
}
