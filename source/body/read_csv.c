/* Particles from a table: columns x, y, z, volume and, where wanted, group. */
#include "body/cloud.h"

#include <stdlib.h>
#include <string.h>

/** Brings a column into the deck's units, from the unit in parentheses behind its name. @return 0, or 1 after saying that it is none */
static int convert(double *values, int count, const char *label, const char *dimension, const Units *units,
                   const char *path, Error *reason)
{
  const char *open = strchr(label, '('), *end = open ? strchr(open, ')') : NULL;
  if (!end) return 0;
  char *words = text_format("1 %.*s", (int)(end - open - 1), open + 1);
  double size = 1;
  Text ignored = {0};
  const int bad = !words || units_read(units, dimension_find(dimension), words, &size, &ignored);
  if (bad) error_add(reason, BRECCIA_USER_ERROR, "%s: '%s' has no unit of %s", path, label, dimension);
  for (int64_t n = 0; n < count && !bad; ++n) values[n] *= size;
  text_free(&ignored);
  free(words);
  return bad;
}

static int read(Cloud *cloud, const char *path, int dimensions, const Units *units, Error *reason)
{
  static const char *const names[] = {"x", "y", "z", "volume"};
  static const char *const columns[] = {"x, volume", "x, y, volume", "x, y, z, volume"};
  for (int k = 0; k < 4; ++k) {
    if (k < 3 && k >= dimensions) continue;
    Error *words = breccia_error_create();
    int count = 0;
    char label[128];
    double *column = csv_column(path, names[k], CSV_FINISHED, &count, label, words);
    if (!column)
      error_add(reason, BRECCIA_USER_ERROR, "%s; expected a CSV file with the columns %s, in the deck's units",
                breccia_error_text(words), columns[dimensions - 1]);
    breccia_error_destroy(&words);
    if (!column) return BRECCIA_USER_ERROR;
    *(k == 3 ? &cloud->volume : &cloud->position[k]) = column;
    cloud->count = count;
    if (convert(column, count, label, k == 3 ? "volume" : "length", units, path, reason)) return BRECCIA_USER_ERROR;
  }
  return csv_words(&cloud->groups, path, "group", reason) ? BRECCIA_FAILURE : BRECCIA_OK;
}

const BodyReader csv_reader = {
    .ending = ".csv", .about = "columns x, y, z, volume and, where wanted, group (a name)", .read = read};
