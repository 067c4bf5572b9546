/* Files of values in time: which format a file has, and those that have none: two plain columns, values alone, and
 * CSV files with a heading. */
#include "loading/history/record_formats.h"

#include "base/csv.h"
#include "base/memory.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Formats with a header, in the order in which they are tried. */
static const RecordFormat *const record_formats[] = {&record_knet, &record_cosmos, &record_smc, &record_peer};

static const RecordFormat *record_format(const RecordText *text)
{
  for (size_t k = 0; k < sizeof record_formats / sizeof *record_formats; ++k)
    if (record_formats[k]->recognises(text)) return record_formats[k];
  return NULL;
}

/** Splits a row into its first two numbers, which blanks, tabs, commas or semicolons part.
 *  @return how many there are; -1 if anything else stands in the row */
static int record_row(const char *row, double pair[2])
{
  static const char *const between = " \t,;";
  const char *at = row + strspn(row, between);
  for (int count = 0; count <= 2; ++count) {
    if (!*at) return count;
    const char *end;
    const double value = record_number(at, &end);
    if (count == 2 || end == at || (*end && !strchr(between, *end))) return -1;
    pair[count] = value;
    at = end + strspn(end, between);
  }
  return -1;
}

/** Refuses a row of a plain file. @param[in] count  numbers of a row before; 0: there is none */
static int record_refuse_row(const RecordText *text, int line, int count, Error *error)
{
  const char *row = text->lines[line] + strspn(text->lines[line], " \t,;");
  if (count == 1)
    return error_add(error, BRECCIA_USER_ERROR, "%s:%d: expected one value, as in the rows before, found '%.40s'",
                     text->path, line + 1, row);
  return error_add(error, BRECCIA_USER_ERROR,
                   "%s:%d: expected two numbers, time and value, found '%.40s'; of a file with more columns and "
                   "a heading choose one with 'column', and of values alone write one a line",
                   text->path, line + 1, row);
}

/** Reads rows of two numbers, time and value, or of values alone where their step is given. Lines that begin with no
 *  number before the first row are headings, and lines behind # % ! are remarks. */
static int read_plain(Record *record, const RecordText *text, const RecordFile *file, Error *error)
{
  int numbers = 0; /* in each row */
  record->rows = memory_zeroed(2 * (size_t)text->count, sizeof(double), "record", error);
  if (!record->rows) return BRECCIA_FAILURE;
  for (int k = 0; k < text->count; ++k) {
    const char *first = text->lines[k] + strspn(text->lines[k], " \t,;"), *end;
    double pair[2];
    if (!*first || strchr("#%!", *first)) continue;
    if (!record->count && (record_number(first, &end), end == first)) continue;
    const int count = record_row(first, pair);
    if (count < 1 || (numbers && count != numbers)) return record_refuse_row(text, k, numbers, error);
    numbers = count;
    if (count == 1 && !(file->step > 0))
      return error_add(error, BRECCIA_USER_ERROR,
                       "%s:%d: holds values without times, found '%.40s'; give the step between them ('time step' in "
                       "a deck, --time-step of 'breccia spectrum'), or write times before them",
                       text->path, k + 1, first);
    record->rows[2 * record->count] = count == 1 ? record->count * file->step : pair[0];
    record->rows[2 * record->count++ + 1] = count == 1 ? pair[0] : pair[1];
  }
  record->stepped = numbers == 1;
  return BRECCIA_OK;
}

/** Reads a file without `column`, by the first format that recognises it. */
static int read_text(Record *record, const RecordFile *file, char *label, Error *error)
{
  RecordText text = {0};
  char *characters = text_read_file(file->path, NULL);
  if (!characters) return error_add(error, BRECCIA_USER_ERROR, "%s: %s", file->path, text_why_unread(errno));
  int status = record_split(&text, file->path, characters, error);
  const RecordFormat *format = status ? NULL : record_format(&text);
  if (!status && file->channel && format != &record_cosmos)
    status = error_add(
        error, BRECCIA_USER_ERROR,
        "%s: 'channel' is for files of several channels (COSMOS V2), which this one is not; leave it out", file->path);
  if (!status)
    status = format ? format->read(record, &text, file, label, error) : read_plain(record, &text, file, error);
  free(text.lines);
  free(characters);
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
  *record = (Record){.rows = rows, .count = count};
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

int record_read(Record *record, const RecordFile *file, char *label, Error *error)
{
  if (label) *label = 0;
  const int status = file->column ? read_columns(record, file, label, error) : read_text(record, file, label, error);
  return status ? status : check_rows(record, file->path, error);
}
