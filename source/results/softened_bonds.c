#include "results/softened_bonds.h"

#include "base/memory.h"
#include "results/dataset.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SOFTENED_COUNTS = 3, SOFTENED_COLUMNS = 7, SOFTENED_ROWS_PER_CHUNK = 256 };

static const char softened_counts[] = "SoftenedCounts", softened_list[] = "Softened",
                  softened_counts_path[] = "Breccia/SoftenedCounts", softened_list_path[] = "Breccia/Softened";

int softened_bonds_create(hid_t own, const Domain *d)
{
  const char *const noun = domain_softening_noun(d);
  if (!noun) return 0;
  return dataset_create(own, softened_counts, H5T_STD_I64LE, SOFTENED_COUNTS, SOFTENED_ROWS_PER_CHUNK) ||
         dataset_create(own, softened_list, H5T_IEEE_F64LE, SOFTENED_COLUMNS, SOFTENED_ROWS_PER_CHUNK) ||
         attribute_text(own, softened_counts, "columns", "all;past the peak;carry nothing") ||
         attribute_text(own, softened_counts, "noun", noun) ||
         attribute_text(own, softened_list, "columns", "a;b;damage;opening;x;y;z");
}

int softened_bonds_write(hid_t own, const Domain *d, int64_t state)
{
  if (H5Lexists(own, softened_counts, H5P_DEFAULT) <= 0) return 0;
  SoftenedPoints found;
  double rows[SOFTENED_LISTED][SOFTENED_COLUMNS];
  domain_find_softened(d, &found);
  for (int k = 0; k < SOFTENED_LISTED; ++k) {
    const SoftenedPoint *one = &found.worst[k];
    const double row[SOFTENED_COLUMNS] = {
        (double)one->particles[0], (double)one->particles[1], one->damage,     one->opening,
        one->position[0],          one->position[1],          one->position[2]};
    const double none[SOFTENED_COLUMNS] = {-1, -1};
    memcpy(rows[k], k < found.listed ? row : none, sizeof row);
  }
  const int64_t counts[SOFTENED_COUNTS] = {found.total, found.softened, found.spent};
  return dataset_write(own, softened_counts, H5T_NATIVE_INT64, SOFTENED_COUNTS, (hsize_t)state, 1, counts) ||
         dataset_write(own, softened_list, H5T_NATIVE_DOUBLE, SOFTENED_COLUMNS, (hsize_t)(state * SOFTENED_LISTED),
                       SOFTENED_LISTED, rows);
}

int softened_bonds_cut(hid_t own, int64_t states)
{
  if (H5Lexists(own, softened_counts, H5P_DEFAULT) <= 0) return 0;
  return dataset_write(own, softened_counts, H5T_NATIVE_INT64, SOFTENED_COUNTS, (hsize_t)states, 0, NULL) ||
         dataset_write(own, softened_list, H5T_NATIVE_DOUBLE, SOFTENED_COLUMNS, (hsize_t)(states * SOFTENED_LISTED), 0,
                       NULL);
}

/** Reads the listed points of a state. @param[in] rows  [SOFTENED_LISTED][SOFTENED_COLUMNS] */
static void softened_take_rows(const double *rows, SoftenedPoints *points)
{
  while (points->listed < SOFTENED_LISTED && rows[SOFTENED_COLUMNS * points->listed] >= 0) {
    const double *row = rows + SOFTENED_COLUMNS * points->listed;
    points->worst[points->listed++] = (SoftenedPoint){.particles = {(int64_t)row[0], (int64_t)row[1]},
                                                      .damage = row[2],
                                                      .opening = row[3],
                                                      .position = {row[4], row[5], row[6]}};
  }
}

int softened_bonds_read(const ResultView *view, SoftenedView *s, Error *error)
{
  int64_t states = 0, rows = 0;
  *s = (SoftenedView){.noun = ""};
  if (H5Lexists(view->file.id, softened_counts_path, H5P_DEFAULT) <= 0) return BRECCIA_OK;
  int64_t *counts = result_view_numbers(view, softened_counts_path, H5T_NATIVE_INT64, sizeof *counts, &states, error);
  double *list =
      counts ? result_view_numbers(view, softened_list_path, H5T_NATIVE_DOUBLE, sizeof *list, &rows, error) : NULL;
  int status = list ? BRECCIA_OK : result_view_lost(view);
  if (!status && (states < view->steps || rows != states * SOFTENED_LISTED))
    status = result_view_say_damaged(view, softened_list_path, error);
  if (!status && view->steps > 0) {
    const int64_t last = view->steps - 1, *count = counts + SOFTENED_COUNTS * last;
    s->points = (SoftenedPoints){.total = count[0], .softened = count[1], .spent = count[2]};
    softened_take_rows(list + SOFTENED_COLUMNS * SOFTENED_LISTED * last, &s->points);
    result_view_words(view, softened_counts_path, "noun", s->noun, sizeof s->noun);
  }
  free(counts);
  free(list);
  return status;
}
