#include "base/csv.h"

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

double *csv_column(const char *path, const char *column, CsvState state, int *count, char *label, Error *error)
{
  char *text = text_read_file(path, NULL), *heading = text;
  *count = 0;
  if (!text) {
    error_add(error, BRECCIA_USER_ERROR, "%s: %s", path, strerror(errno));
    return NULL;
  }
  while (heading && *heading == '#') {
    heading = strchr(heading, '\n');
    if (heading) ++heading;
  }
  char *end = heading ? strchr(heading, '\n') : NULL;
  int index = -1;
  if (end) {
    *end = 0;
    if (end > heading && end[-1] == '\r') end[-1] = 0;
    index = column_index(heading, column, label);
  }
  if (index < 0) {
    error_add(error, BRECCIA_USER_ERROR, "%s: has no column '%s'; its columns are %s", path, column,
              end ? heading : "none");
    free(text);
    return NULL;
  }
  size_t capacity = 1;
  for (char *c = end + 1; *c; ++c) capacity += *c == '\n';
  double *values = malloc(sizeof(double) * capacity);
  for (char *row = end + 1; values && *row;) {
    char *next = strchr(row, '\n');
    if (!next && state == CSV_LIVING) break;
    if (!next) next = row + strlen(row);
    char *cell = row;
    for (int k = 0; cell && k < index; ++k) {
      cell = memchr(cell, ',', (size_t)(next - cell));
      if (cell) ++cell;
    }
    bool blank = row + strspn(row, " \t\r") >= next;
    if (*row != '#' && !blank) values[(*count)++] = cell ? number_of(cell) : NAN;
    row = *next ? next + 1 : next;
  }
  free(text);
  if (!values) error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  return values;
}
