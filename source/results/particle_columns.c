#include "results/particle_columns.h"

#include "base/memory.h"
#include "results/dataset.h"
#include <stdlib.h>
#include <string.h>

enum { ROWS_AT_ONCE = 1 << 16, ROWS_PER_CHUNK = 4096 };

static const Lattice *column_lattice_of(const Domain *d, int64_t n)
{
  return &d->body.lattices[d->particles->block[d->particles->place_of[n] / SLICE]];
}
static double column_spacing(const Domain *d, int64_t n)
{
  return column_lattice_of(d, n)->spacing;
}
static double column_lattice(const Domain *d, int64_t n)
{
  int k = 0;
  while (strcmp(lattice_word(k), column_lattice_of(d, n)->type->name)) ++k;
  return k;
}
static const char *column_lattice_word(const Domain *d, int k)
{
  (void)d;
  return lattice_word(k);
}
static double column_volume(const Domain *d, int64_t n)
{
  return d->particles->volume[d->particles->place_of[n]];
}
static double column_block(const Domain *d, int64_t n)
{
  return d->particles->block[d->particles->place_of[n] / SLICE];
}
static const char *column_block_word(const Domain *d, int k)
{
  return k < d->body.block_count ? d->body.blocks[k]->head.name : NULL;
}
static double column_material(const Domain *d, int64_t n)
{
  return d->material[d->particles->place_of[n] / SLICE];
}
static const char *column_material_word(const Domain *d, int k)
{
  return k < d->material_count ? d->materials[k].name : NULL;
}
static double column_group(const Domain *d, int64_t n)
{
  return d->body.group_of[n];
}
static const char *column_group_word(const Domain *d, int k)
{
  return k < d->body.group_count ? d->body.groups[k] : NULL;
}
static bool column_group_is_needed(const Domain *d)
{
  return d->body.group_of != NULL;
}
static double column_strength(const Domain *d, int64_t n)
{
  return d->strength[d->particles->place_of[n]];
}
static bool column_strength_is_needed(const Domain *d)
{
  return d->strength != NULL;
}
static double column_outside(const Domain *d, int64_t n)
{
  return body_outside(&d->body, n);
}
static bool column_outside_is_needed(const Domain *d)
{
  return d->body.margin_of != NULL;
}

static const ParticleColumn columns[] = {
    {.name = "Spacing", .dimension = "length", .about = "spacing of the lattice", .value = column_spacing},
    {.name = "Lattice",
     .dimension = "",
     .about = "index of the lattice",
     .value = column_lattice,
     .word = column_lattice_word},
    {.name = "Volume",
     .dimension = "volume",
     .about = "volume: of a plane body times its thickness, of a bar times its area",
     .value = column_volume},
    {.name = "Block",
     .dimension = "",
     .about = "index of the block of the deck",
     .value = column_block,
     .word = column_block_word},
    {.name = "Material",
     .dimension = "",
     .about = "index of the material of the deck",
     .value = column_material,
     .word = column_material_word},
    {.name = "Group",
     .dimension = "",
     .about = "index of the group that a file of particles names, or -1; absent where no file names groups",
     .value = column_group,
     .word = column_group_word,
     .is_needed = column_group_is_needed},
    {.name = "Strength",
     .dimension = "1",
     .about = "factor on the strength (`fields`); absent where the deck gives none",
     .value = column_strength,
     .is_needed = column_strength_is_needed},
    {.name = "Outside",
     .dimension = "",
     .about = "1 for particles of the layers outside of supports, else 0; absent where there are no such layers",
     .value = column_outside,
     .is_needed = column_outside_is_needed},
};

const ParticleColumn *particle_column_at(int k)
{
  return k < (int)(sizeof columns / sizeof *columns) ? &columns[k] : NULL;
}

/** Creates and writes one column. @param[out] values  [ROWS_AT_ONCE] work array */
static int particle_column_write(hid_t own, const Domain *d, const Units *units, const ParticleColumn *column,
                                 double *values)
{
  const int64_t count = d->particles->count;
  int bad = dataset_create(own, column->name, *column->dimension ? H5T_IEEE_F64LE : H5T_STD_I32LE, 1, ROWS_PER_CHUNK);
  for (int64_t first = 0; first < count && !bad; first += ROWS_AT_ONCE) {
    const int64_t rows = count - first < ROWS_AT_ONCE ? count - first : ROWS_AT_ONCE;
    for (int64_t i = 0; i < rows; ++i) values[i] = column->value(d, first + i);
    bad = dataset_write(own, column->name, H5T_NATIVE_DOUBLE, 1, (hsize_t)first, (hsize_t)rows, values);
  }
  if (*column->dimension) {
    char unit[64];
    units_name(units, dimension_find(column->dimension), unit, sizeof unit);
    bad = bad || attribute_text(own, column->name, "unit", unit);
  }
  if (!column->word) return bad;
  Text names = {0};
  for (int k = 0; column->word(d, k); ++k) text_add(&names, "%s%s", k ? ";" : "", column->word(d, k));
  bad = bad || attribute_text(own, column->name, "names", text_words(&names));
  text_free(&names);
  return bad;
}

int particle_columns_write(hid_t own, const Domain *d, const Units *units)
{
  double *values = memory_plain(ROWS_AT_ONCE, sizeof *values);
  int bad = !values;
  for (int k = 0; !bad && particle_column_at(k); ++k)
    if (!columns[k].is_needed || columns[k].is_needed(d))
      bad = particle_column_write(own, d, units, &columns[k], values);
  free(values);
  return bad;
}
