#include "family/cells.h"

#include <math.h>
#include <stdlib.h>

static int64_t cell_along(const Cells *cells, int k, double x)
{
  double c = floor((x - cells->low[k]) / cells->width);
  if (!(c > 0)) return 0;
  return c < (double)cells->count[k] ? (int64_t)c : cells->count[k] - 1;
}

static int64_t cell_of(const Cells *cells, const double *point)
{
  return cell_along(cells, 0, point[0]) +
         cells->count[0] * (cell_along(cells, 1, point[1]) + cells->count[1] * cell_along(cells, 2, point[2]));
}

/** Chooses the cells' width and number: a thin body in a wide box may have wider cells, never more than a few per particle. */
static double shape_cells(Cells *cells, const Particles *p, const double *const position[3], double reach)
{
  double high[3], total;
  for (int k = 0; k < 3; ++k) {
    cells->low[k] = INFINITY;
    high[k] = -INFINITY;
    for (int64_t n = 0; n < p->count; ++n) {
      double x = position[k][p->place_of[n]];
      if (!isfinite(x)) continue;
      cells->low[k] = fmin(cells->low[k], x);
      high[k] = fmax(high[k], x);
    }
    if (high[k] < cells->low[k]) cells->low[k] = high[k] = 0;
  }
  cells->width = reach * (1 + 1e-6);
  for (;; cells->width *= 2) {
    total = 1;
    for (int k = 0; k < 3; ++k) total *= floor((high[k] - cells->low[k]) / cells->width) + 1;
    if (total <= 4.0 * (double)p->count + 64) break;
  }
  for (int k = 0; k < 3; ++k) cells->count[k] = (int64_t)floor((high[k] - cells->low[k]) / cells->width) + 1;
  return total;
}

int cells_create(Cells *cells, const Particles *p, const double *const position[3], double reach, Error *error)
{
  *cells = (Cells){.width = 0};
  const int64_t total = (int64_t)shape_cells(cells, p, position, reach);
  cells->first = memory_zeroed((size_t)total + 1, sizeof(int64_t), "search cells", error);
  cells->places = memory_zeroed((size_t)p->count, sizeof(int32_t), "search cells", error);
  cells->position = memory_zeroed(3 * (size_t)p->count, sizeof(double), "search cells", error);
  int64_t *own = memory_zeroed((size_t)p->count, sizeof(int64_t), "search cells", error);
  if (!cells->first || !cells->places || !cells->position || !own) {
    free(own);
    cells_destroy(cells);
    return BRECCIA_FAILURE;
  }
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t place = p->place_of[n];
    own[n] = cell_of(cells, (const double[]){position[0][place], position[1][place], position[2][place]});
    ++cells->first[own[n] + 1];
  }
  for (int64_t c = 0; c < total; ++c) cells->first[c + 1] += cells->first[c];
  for (int64_t n = p->count - 1; n >= 0; --n) /* backwards, so that shifting the starts down leaves ascending order */
    cells->places[--cells->first[own[n] + 1]] = p->place_of[n];
  for (int64_t c = 0; c < total; ++c) cells->first[c] = cells->first[c + 1];
  cells->first[total] = p->count;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) cells->position[3 * n + k] = position[k][cells->places[n]];
  free(own);
  return BRECCIA_OK;
}

void cells_destroy(Cells *cells)
{
  free(cells->first);
  free(cells->places);
  free(cells->position);
  *cells = (Cells){.width = 0};
}

int cells_around(const Cells *cells, const double point[3], int64_t rows[9][2])
{
  int64_t low[3], high[3];
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    int64_t centre = cell_along(cells, k, point[k]);
    low[k] = centre > 0 ? centre - 1 : 0;
    high[k] = centre + 1 < cells->count[k] ? centre + 1 : centre;
  }
  for (int64_t z = low[2]; z <= high[2]; ++z)
    for (int64_t y = low[1]; y <= high[1]; ++y) {
      int64_t row = cells->count[0] * (y + cells->count[1] * z);
      rows[count][0] = cells->first[row + low[0]];
      rows[count++][1] = cells->first[row + high[0] + 1];
    }
  return count;
}
