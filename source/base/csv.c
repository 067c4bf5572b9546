#include "base/csv.h"

#include "base/memory.h"
#include "base/text.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL = 128 };

/** @return which column of the heading has the name, or -1 */
static int column_index(const char *heading, const char *column, char *label)
{
  int index = 0;
  size_t n = strlen(column);
  for (const char *cell = heading; cell; ++index) {
    cell += strspn(cell, " ");
    const char *comma = strchr(cell, ',');
    size_t length = comma ? (size_t)(comma - cell) : strlen(cell);
    while (length && cell[length - 1] == ' ') --length;
    if (length >= n && !strncmp(cell, column, n) && (length == n || !strncmp(cell + n, " (", 2))) {
      if (label) snprintf(label, LABEL, "%.*s", (int)length, cell);
      return index;
    }
    cell = comma ? comma + 1 : NULL;
  }
  return -1;
}

static double number_of(const char *cell)
{
  char *end;
  double value = strtod(cell, &end);
  if (end == cell) return NAN;
  end += strspn(end, " \t\r");
  return *end == ',' || *end == '\n' || !*end ? value : NAN;
}

typedef struct Table { /* a file's content, its heading without an end of line */
  char *text, *heading, *rows;
} Table;

/** @return whether the file could be read; `rows` is NULL if it has no heading */
static bool read_table(Table *table, const char *path, Error *error)
{
  *table = (Table){.text = text_read_file(path, NULL)};
  if (!table->text) {
    error_add(error, BRECCIA_USER_ERROR, "%s: %s", path, text_why_unread(errno));
    return false;
  }
  table->heading =
      table->text + (!strncmp(table->text, "\xef\xbb\xbf", 3) ? 3 : 0); /* a mark that spreadsheets write */
  while (table->heading && *table->heading == '#') {
    table->heading = strchr(table->heading, '\n');
    if (table->heading) ++table->heading;
  }
  char *end = table->heading ? strchr(table->heading, '\n') : NULL;
  if (!end) return true;
  *end = 0;
  if (end > table->heading && end[-1] == '\r') end[-1] = 0;
  table->rows = end + 1;
  return true;
}

static int count_commas(const char *from, const char *end)
{
  int count = 0;
  while ((from = memchr(from, ',', (size_t)(end - from)))) ++from, ++count;
  return count;
}

/** Looks whether a row has cells behind the last column of the heading: a comma in its numbers would move all that follow it.
 *  @return 0, or 1 after saying so */
static int check_widths(const Table *table, const char *path, Error *error)
{
  const int commas = count_commas(table->heading, table->rows - 1);
  int line = 2; /* counted from the one behind the heading, and those before it */
  for (const char *c = table->text; c < table->heading; ++c) line += *c == '\n';
  for (const char *row = table->rows, *next; *row; row = next, ++line) {
    const char *end = row + strcspn(row, "\n");
    next = end + (*end != 0);
    while (end > row && strchr(", \t\r", end[-1])) --end; /* empty cells do no harm */
    const int here = *row == '#' ? 0 : count_commas(row, end);
    if (here <= commas) continue;
    error_add(error, BRECCIA_USER_ERROR,
              "%s:%d: has %d cells, but the heading names %d columns; write decimals with a point, and one number in "
              "each cell",
              path, line, here + 1, commas + 1);
    return 1;
  }
  return 0;
}

static size_t most_rows(const Table *table)
{
  size_t rows = 1;
  for (const char *c = table->rows; *c; ++c) rows += *c == '\n';
  return rows;
}

/** The next row of numbers or words. @param[in,out] at  behind it afterwards
 *  @return where its cell in that column begins, `end` if it has none; NULL after the last row
 *  @param[out] end  of the row */
static char *next_cell(char **at, int column, CsvState state, char **end)
{
  while (**at) {
    char *row = *at, *next = strchr(row, '\n');
    if (!next && state == CSV_LIVING) return NULL;
    *end = next ? next : row + strlen(row);
    *at = next ? next + 1 : *end;
    if (*row == '#' || row + strspn(row, " \t\r") >= *end) continue;
    for (int k = 0; row && k < column; ++k) {
      row = memchr(row, ',', (size_t)(*end - row));
      if (row) ++row;
    }
    return row ? row : *end;
  }
  return NULL;
}

double *csv_column(const char *path, const char *column, CsvState state, int *count, char *label, Error *error)
{
  Table table;
  *count = 0;
  if (!read_table(&table, path, error)) return NULL;
  const int index = table.rows ? column_index(table.heading, column, label) : -1;
  if (index < 0) {
    error_add(error, BRECCIA_USER_ERROR, "%s: has no column '%s'; its columns are %s", path, column,
              table.rows ? table.heading : "none");
    free(table.text);
    return NULL;
  }
  if (state == CSV_FINISHED && check_widths(&table, path, error)) {
    free(table.text);
    return NULL;
  }
  double *values = memory_plain(most_rows(&table), sizeof(double));
  char *at = table.rows, *cell, *end;
  while (values && (cell = next_cell(&at, index, state, &end))) values[(*count)++] = cell < end ? number_of(cell) : NAN;
  free(table.text);
  if (!values) error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  return values;
}

int csv_words(CsvWords *words, const char *path, const char *column, Error *error)
{
  static const char *const around = " \t\r\"";
  Table table;
  *words = (CsvWords){0};
  if (!read_table(&table, path, error)) return BRECCIA_USER_ERROR;
  const int index = table.rows ? column_index(table.heading, column, NULL) : -1;
  words->text = table.text;
  if (index < 0) return BRECCIA_OK;
  words->cells = memory_plain(most_rows(&table), sizeof(char *));
  if (!words->cells) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  char *at = table.rows, *cell, *end;
  while ((cell = next_cell(&at, index, CSV_FINISHED, &end))) {
    char *comma = memchr(cell, ',', (size_t)(end - cell));
    if (comma) end = comma;
    *end = 0;
    cell += strspn(cell, around);
    while (end > cell && strchr(around, end[-1])) *--end = 0;
    words->cells[words->count++] = cell;
  }
  return BRECCIA_OK;
}

void csv_words_destroy(CsvWords *words)
{
  free(words->cells);
  free(words->text);
  *words = (CsvWords){0};
}
