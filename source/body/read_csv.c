/* Particles from a table: columns x, y, z, volume and, where wanted, group. */
#include "body/cloud.h"

static int read(Cloud *cloud, const char *path, int dimensions, Error *reason)
{
  static const char *const names[] = {"x", "y", "z", "volume"};
  static const char *const columns[] = {"x, volume", "x, y, volume", "x, y, z, volume"};
  for (int k = 0; k < 4; ++k) {
    if (k < 3 && k >= dimensions) continue;
    Error *words = breccia_error_create();
    int count = 0;
    double *column = csv_column(path, names[k], CSV_FINISHED, &count, NULL, words);
    if (!column)
      error_add(reason, BRECCIA_USER_ERROR, "%s; expected a CSV file with the columns %s, in the deck's units",
                breccia_error_text(words), columns[dimensions - 1]);
    breccia_error_destroy(&words);
    if (!column) return BRECCIA_USER_ERROR;
    *(k == 3 ? &cloud->volume : &cloud->position[k]) = column;
    cloud->count = count;
  }
  return csv_words(&cloud->groups, path, "group", reason) ? BRECCIA_FAILURE : BRECCIA_OK;
}

const BodyReader csv_reader = {
    .ending = ".csv", .about = "columns x, y, z, volume and, where wanted, group (a name)", .read = read};
