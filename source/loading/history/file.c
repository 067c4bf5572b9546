/* Histories from files: records in the format of the PEER database, tables with a heading, two plain columns. */
#include "loading/history/record.h"

#include "base/csv.h"
#include "base/memory.h"
#include "deck/named_file.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct FileSpec {
  SectionHead head;
  const char *name, *column, *times;
  double scale;
} FileSpec;

static const Field file_fields[] = {
    {.key = "name",
     .kind = FIELD_TEXT,
     .offset = offsetof(FileSpec, name),
     .meaning = "of the file, relative to the deck's. `.AT2`, `.VT2` and `.DT2` are read as the PEER database writes "
                "them (first value at time 0, accelerations in g); others have two columns, times and values, parted "
                "by blanks or commas, or a heading and the 'column' that it names"},
    {.key = "column",
     .kind = FIELD_TEXT,
     .offset = offsetof(FileSpec, column),
     .standard = "",
     .meaning = "of a CSV file with a heading: which one holds the values"},
    {.key = "times",
     .kind = FIELD_TEXT,
     .offset = offsetof(FileSpec, times),
     .standard = "time",
     .meaning = "of a CSV file with a heading: the column of times, in the unit that stands behind its name in "
                "parentheses, else in the deck's"},
    {.key = "scale",
     .kind = FIELD_NUMBER,
     .offset = offsetof(FileSpec, scale),
     .dimension = "1",
     .standard = "1",
     .meaning = "factor on all values"},
};

const Section file_history_section = {.name = "file history",
                                      .about = "Numbers from a file as factors on the load's value: straight lines "
                                               "between them, 0 before the first and after the last.",
                                      .size = sizeof(FileSpec),
                                      FIELDS(file_fields)};

/** Size of the unit in parentheses behind a column's name, in the deck's unit of time; 1 where there is none. */
static double unit_of_times(const char *label, const DeckReader *reader)
{
  const char *open = strchr(label, '('), *end = open ? strchr(open, ')') : NULL;
  double size = 1;
  if (!end) return 1;
  char *words = text_format("1 %.*s", (int)(end - open - 1), open + 1);
  Text ignored = {0};
  if (!words || units_read(reader->units, dimension_find("time"), words, &size, &ignored)) size = NAN;
  text_free(&ignored);
  free(words);
  return size;
}

static int read_columns(Record *record, const FileSpec *spec, const char *path, const DeckReader *reader, Error *error)
{
  char label[128];
  int count;
  double *times = csv_column(path, spec->times, CSV_FINISHED, &count, label, error);
  double *values = times ? csv_column(path, spec->column, CSV_FINISHED, &count, NULL, error) : NULL;
  double *rows = values ? memory_zeroed((size_t)(2 * count), sizeof *rows, "record", error) : NULL;
  const double unit = times ? unit_of_times(label, reader) : 1;
  if (isnan(unit)) error_add(error, BRECCIA_USER_ERROR, "%s: '%s' has no unit of time", path, label);
  for (int k = 0; rows && k < count; ++k) {
    rows[2 * k] = times[k] * unit;
    rows[2 * k + 1] = values[k];
  }
  free(times);
  free(values);
  *record = (Record){rows, count};
  return error_count(error) ? BRECCIA_USER_ERROR : BRECCIA_OK;
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

static bool is_peer(const char *name)
{
  const char *ending = strrchr(name, '.');
  return ending && (!strcasecmp(ending, ".at2") || !strcasecmp(ending, ".vt2") || !strcasecmp(ending, ".dt2"));
}

static int create(History *h, const DeckReader *reader)
{
  const FileSpec *spec = h->value->section;
  if (!spec) return BRECCIA_USER_ERROR; /* said when it was read */
  const Node *node = section_node(spec, "name");
  char *path = text_beside(node_file(reader->document, node), spec->name);
  if (path) named_file_note(reader, spec->name, path);
  Error *words = breccia_error_create();
  Record record = {0};
  int status = path && words ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status && spec->column)
    status = read_columns(&record, spec, path, reader, words);
  else if (!status && is_peer(spec->name))
    status = record_read_peer(&record, path, reader->units, words);
  else if (!status)
    status = record_read_plain(&record, path, words);
  if (!status) status = check_rows(&record, path, words);
  if (status)
    node_error(reader->document, node, reader->error, "file: %s", words ? breccia_error_text(words) : "out of memory");
  h->rows = record.rows;
  for (int k = 0; !status && k < record.count; ++k) h->rows[2 * k + 1] *= spec->scale;
  h->line = (Polyline){.rows = h->rows, .count = record.count, .ends = true};
  if (!status) status = polyline_prepare(&h->line, reader->error);
  breccia_error_destroy(&words);
  free(path);
  return status;
}

static double factor(const History *h, double time)
{
  return polyline_value(&h->line, time);
}

static double integral(const History *h, double scale, double time)
{
  return scale * polyline_integral(&h->line, time);
}

static double corner(const History *h, double time)
{
  return polyline_corner(&h->line, time);
}

static double rise(const History *h)
{
  return polyline_rise(&h->line);
}

const HistoryType file_history = {
    .create = create, .factor = factor, .integral = integral, .corner = corner, .rise = rise};
