#include "loading/history/record.h"

#include "base/csv.h"
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

/** A record of the PEER ground motion database: four lines of heading, the last with the number of values and the time step in seconds
 *  (NPTS= 4000, DT= .005 SEC, or 4000 .005 NPTS, DT), then the values. The first is of time 0. */
static int read_peer(Record *record, const char *path, const Units *units, Error *error)
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

/** Rows of two numbers, time and value, parted by blanks, tabs, commas or semicolons; lines that begin with no number are headings and remarks. */
static int read_plain(Record *record, const char *path, Error *error)
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

/** Size of the unit in parentheses behind the name of the column of times; 1 where there is none, NaN where it is none of time. */
static double unit_of_times(const char *label, const Units *units)
{
  const char *open = strchr(label, '('), *end = open ? strchr(open, ')') : NULL;
  double size = 1;
  if (!end) return 1;
  char *words = text_format("1 %.*s", (int)(end - open - 1), open + 1);
  Text ignored = {0};
  if (!words || units_read(units, dimension_find("time"), words, &size, &ignored)) size = NAN;
  text_free(&ignored);
  free(words);
  return size;
}

static int read_columns(Record *record, const RecordFile *file, char *label, Error *error)
{
  char heading[RECORD_LABEL];
  int count;
  double *times = csv_column(file->path, file->times, CSV_FINISHED, &count, heading, error);
  double *values = times ? csv_column(file->path, file->column, CSV_FINISHED, &count, label, error) : NULL;
  double *rows = values ? memory_zeroed((size_t)(2 * count), sizeof *rows, "record", error) : NULL;
  const double unit = times ? unit_of_times(heading, file->units) : 1;
  if (isnan(unit)) error_add(error, BRECCIA_USER_ERROR, "%s: '%s' has no unit of time", file->path, heading);
  for (int k = 0; rows && k < count; ++k) {
    rows[2 * k] = times[k] * unit;
    rows[2 * k + 1] = values[k];
  }
  free(times);
  free(values);
  *record = (Record){rows, count};
  return rows && !isnan(unit) ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

/** Times ascend, and every cell is a number. */
static int check_rows(const Record *record, const char *path, Error *error)
{
  const double *row = record->rows;
  if (record->count < 2)
    return error_add(error, BRECCIA_USER_ERROR, "%s: holds %d rows of numbers; a history needs two at least", path,
                     record->count);
  for (int k = 0; k < record->count; ++k) {
    if (!isfinite(row[2 * k]) || !isfinite(row[2 * k + 1]))
      return error_add(error, BRECCIA_USER_ERROR, "%s: row %d of its numbers lacks a time or a value", path, k + 1);
    if (k && row[2 * k] <= row[2 * k - 2])
      return error_add(error, BRECCIA_USER_ERROR, "%s: times must grow from row to row; row %d has %g after %g", path,
                       k + 1, row[2 * k], row[2 * k - 2]);
  }
  return BRECCIA_OK;
}

/** Endings of files of the PEER database, and what their values are. */
static const char *peer_label(const char *path)
{
  static const char *const kinds[][2] = {
      {".at2", "acceleration (g)"}, {".vt2", "velocity (cm/s)"}, {".dt2", "displacement (cm)"}};
  const char *ending = strrchr(path, '.');
  for (size_t k = 0; ending && k < sizeof kinds / sizeof *kinds; ++k)
    if (!strcasecmp(ending, kinds[k][0])) return kinds[k][1];
  return NULL;
}

int record_read(Record *record, const RecordFile *file, char *label, Error *error)
{
  const char *peer = file->column ? NULL : peer_label(file->path);
  if (label) snprintf(label, RECORD_LABEL, "%s", peer ? peer : "");
  const int status = file->column ? read_columns(record, file, label, error)
                     : peer       ? read_peer(record, file->path, file->units, error)
                                  : read_plain(record, file->path, error);
  return status ? status : check_rows(record, file->path, error);
}
