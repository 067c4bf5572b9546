#include "body/lattice.h"

#include "base/lanes.h"
#include <math.h>
#include <string.h>

static const LatticeType types[] = {
#define LATTICE(word, in_dimensions, turned_axes, ...)                                                                 \
  {.name = word, .dimensions = in_dimensions, .turns = turned_axes, .vector = {__VA_ARGS__}},
#include "body/lattices.h"
#undef LATTICE
};

const char *lattice_word(int k)
{
  return k < (int)(sizeof types / sizeof *types) ? types[k].name : NULL;
}

const LatticeType *lattice_at(int k)
{
  return &types[k];
}

const LatticeType *lattice_find(const char *name)
{
  for (size_t k = 0; k < sizeof types / sizeof *types; ++k)
    if (!strcmp(types[k].name, name)) return &types[k];
  return NULL;
}

bool lattice_is_grid(const LatticeType *type)
{
  return type->vector[1][0] == 0 && type->vector[2][0] == 0 && type->vector[2][1] == 0;
}

/** How many planes across axis k, one after the other, there are until one is met whose particles stand like those of the first. */
static int planes_per_cell(const LatticeType *type, int k)
{
  enum { MOST = 12 };
  for (int planes = 1; planes < MOST; ++planes) {
    bool whole = true;
    for (int j = k + 1; j < type->dimensions; ++j) {
      const double shift = planes * type->vector[j][k] / type->vector[k][k];
      whole &= fabs(shift - round(shift)) < 1e-9;
    }
    if (whole) return planes;
  }
  return MOST;
}

void lattice_measure(Lattice *lattice, const LatticeType *type, double spacing)
{
  *lattice = (Lattice){.type = type, .spacing = spacing, .dimensions = type->dimensions, .across = {1, 2}};
  for (int k = 0; k < 3; ++k) {
    lattice->unit.size[k] = spacing * type->vector[k][k];
    lattice->plane[k] = lattice->unit.size[k] / planes_per_cell(type, k);
    lattice->unit.first[k] = lattice->plane[k] / 2;
    lattice->cells[k] = 1;
    lattice->filled[k] = 1;
  }
}

void lattice_lay_rows(Lattice *lattice)
{
  const double(*vector)[3] = lattice->type->vector;
  lattice->axis = 0;
  for (int k = 1; k < lattice->type->turns; ++k)
    if (lattice->cells[k] > lattice->cells[lattice->axis]) lattice->axis = k;
  lattice->across[0] = lattice->axis == 0 ? 1 : 0;
  lattice->across[1] = lattice->axis == 2 ? 1 : 2;
  lattice->chunks = (lattice->cells[lattice->axis] + SLICE - 1) / SLICE;
  lattice->shift[0] = vector[1][0] / vector[0][0];
  lattice->shift[1] = vector[2][0] / vector[0][0];
  lattice->shift[2] = vector[2][1] / vector[1][1];
}

int64_t lattice_row_count(const Lattice *lattice)
{
  return lattice->cells[lattice->across[0]] * lattice->cells[lattice->across[1]];
}

void lattice_cell(const Lattice *lattice, int64_t row, int64_t chunk, int lane, int64_t cell[3])
{
  cell[lattice->axis] = chunk * SLICE + lane;
  cell[lattice->across[0]] = row % lattice->cells[lattice->across[0]];
  cell[lattice->across[1]] = row / lattice->cells[lattice->across[0]];
}

int64_t lattice_row(const Lattice *lattice, const int64_t cell[3])
{
  return cell[lattice->across[0]] + lattice->cells[lattice->across[0]] * cell[lattice->across[1]];
}

/** How a row stands to the first one. Cells are counted from the low side in every row, rows from there in every layer: of the shift of a row
 * the whole cells are taken off, `whole`, and `rest` remains. */
typedef struct RowStart {
  int64_t whole[2]; /* along `axis`, along across[0] */
  double rest[2];
} RowStart;

static RowStart row_start(const Lattice *lattice, int64_t row, int64_t layer)
{
  static const double rounding = 1e-9;
  RowStart start;
  double shift = lattice->shift[2] * (double)layer, cells = floor(shift + rounding);
  start.whole[1] = (int64_t)cells;
  start.rest[1] = fmax(0, shift - cells);
  shift = lattice->shift[0] * (double)(row - start.whole[1]) + lattice->shift[1] * (double)layer;
  cells = floor(shift + rounding);
  start.whole[0] = (int64_t)cells;
  start.rest[0] = fmax(0, shift - cells);
  return start;
}

static RowStart row_start_of(const Lattice *lattice, const int64_t cell[3])
{
  return row_start(lattice, cell[lattice->across[0]], cell[lattice->across[1]]);
}

void lattice_point(const Lattice *lattice, const int64_t cell[3], double point[3])
{
  const RowStart start = row_start_of(lattice, cell);
  double at[3] = {(double)cell[0], (double)cell[1], (double)cell[2]};
  at[lattice->axis] += start.rest[0];
  at[lattice->across[0]] += start.rest[1];
  for (int k = 0; k < 3; ++k) point[k] = lattice->origin[k] + lattice->unit.size[k] * at[k];
}

double lattice_row_shift(const Lattice *lattice, const int64_t cell[3])
{
  return row_start_of(lattice, cell).rest[0];
}

bool lattice_neighbour(const Lattice *lattice, const int64_t cell[3], const int offset[3], int64_t other[3])
{
  const int along = lattice->axis, row = lattice->across[0], layer = lattice->across[1];
  other[layer] = cell[layer] + offset[layer];
  const RowStart here = row_start_of(lattice, cell), layer_there = row_start(lattice, 0, other[layer]);
  other[row] = cell[row] + offset[row] + layer_there.whole[1] - here.whole[1];
  other[along] = cell[along] + offset[along] + row_start_of(lattice, other).whole[0] - here.whole[0];
  return other[row] >= 0 && other[row] < lattice->cells[row] && other[layer] >= 0 &&
         other[layer] < lattice->cells[layer];
}

void lattice_vector(const Lattice *lattice, const int offset[3], double way[3])
{
  const int axes[3] = {lattice->axis, lattice->across[0], lattice->across[1]};
  for (int k = 0; k < 3; ++k) {
    way[axes[k]] = 0;
    for (int n = k; n < 3; ++n) way[axes[k]] += offset[axes[n]] * lattice->type->vector[n][k];
  }
}

double lattice_period(const LatticeType *type, int axis)
{
  return axis == 0 ? type->vector[0][0] : type->vector[1][1] * planes_per_cell(type, 0);
}

/** Keeps of a polygon what is nearer to the origin than to a point. @return the new number of corners */
static int keep_nearer(double corners[][2], int count, const double point[2])
{
  double kept[8][2], half = (point[0] * point[0] + point[1] * point[1]) / 2;
  int kept_count = 0;
  for (int n = 0; n < count; ++n) {
    const double *a = corners[n], *b = corners[(n + 1) % count];
    const double from = a[0] * point[0] + a[1] * point[1] - half, to = b[0] * point[0] + b[1] * point[1] - half;
    if (from <= 1e-12) memcpy(kept[kept_count++], a, sizeof *kept);
    if ((from < -1e-12 && to > 1e-12) || (from > 1e-12 && to < -1e-12)) {
      const double t = from / (from - to);
      for (int k = 0; k < 2; ++k) kept[kept_count][k] = a[k] + t * (b[k] - a[k]);
      ++kept_count;
    }
  }
  memcpy(corners, kept, sizeof *kept * (size_t)kept_count);
  return kept_count;
}

int lattice_cell_corners(const LatticeType *type, double corners[6][2])
{
  double polygon[8][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  int count = 4;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const double point[2] = {i * type->vector[0][0] + j * type->vector[1][0], j * type->vector[1][1]};
      if (i || j) count = keep_nearer(polygon, count, point);
    }
  memcpy(corners, polygon, sizeof *corners * (size_t)count);
  return count;
}
