#include "formulation/shape_table.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PORTION = 2048 }; /* slices whose shapes are found at once before alike ones are looked for */

/* A family that has lost most of its bonds answers with the whole stress through the few that are left, so that the stable step would
 * fall to a quarter and less (docs/theory.md 4). It carries only a share of its stress when its demand, or the part of its neighbours
 * alone, passes these shares of what a whole family and all its neighbours demand together; families at a plane face or edge
 * stay below both. */
static const double most_demand = 0.45, most_alone = 0.10;

static double poverty(const ShapeTensor *shape)
{
  return fmax(shape->demand / most_demand, shape->alone / most_alone);
}

/** @param[in,out] whole  where shapes are found for the first time: least demand of a whole family and its neighbours seen so far
 *                         in this block, or NULL */
static SliceShape slice_shape(ShapeTable *table, const Family *family, int64_t slice, double *whole)
{
  const bool first_time = whole;
  SliceShape shapes = {.share = {1, 1, 1, 1, 1, 1, 1, 1}};
  for (int lane = 0; lane < SLICE; ++lane) {
    int32_t place = (int32_t)(slice * SLICE + lane);
    if (family->particles->number[place] < 0) continue;
    ShapeTensor shape =
        shape_tensor(family, place, table->plane ? 2 : 3, first_time ? 0 : (double)table->roundness[place]);
    for (int k = 0; k < 6; ++k) shapes.inverse[k][lane] = shape.inverse[k];
    for (int k = 0; k < 3; ++k) shapes.first_moment[k][lane] = shape.first_moment[k];
    shapes.weight_sum[lane] = shape.weight_sum;
    shapes.mean_influence[lane] = shape.mean_influence;
    table->mode[place] = (uint8_t)shape.mode;
    if (first_time) {
      table->roundness[place] = (float)shape.roundness;
      table->allowed[place] = poverty(&shape);
      *whole = fmin(*whole, shape.alone * (shape.bonds + 1));
    } else {
      const double allowed = table->allowed[place], needed = poverty(&shape); /* none where no bond is left */
      shapes.share[lane] = table->kept[place] * (needed > allowed ? allowed / needed : 1);
    }
  }
  return shapes;
}

static uint64_t hash(const SliceShape *shape)
{
  uint64_t words[sizeof *shape / sizeof(uint64_t)], sum = 0;
  memcpy(words, shape, sizeof words);
  for (size_t k = 0; k < sizeof words / sizeof *words; ++k) {
    sum = (sum ^ words[k]) * 0x9e3779b97f4a7c15u;
    sum ^= sum >> 29;
  }
  return sum;
}

/** Entry with this shape, made if there is none; `slots` is an open-addressed table of entries plus one. */
static int32_t find_entry(ShapeTable *table, const SliceShape *shape, int32_t *slots, uint64_t mask)
{
  for (uint64_t at = hash(shape);; ++at) {
    int32_t entry = slots[at & mask] - 1;
    if (entry < 0) {
      table->entries[table->count] = *shape;
      slots[at & mask] = (int32_t)++table->count;
      return (int32_t)table->count - 1;
    }
    if (memcmp(&table->entries[entry], shape, sizeof *shape)) continue;
    table->shared[entry] = 1;
    return entry;
  }
}

typedef struct Portion { /* of slices whose shapes are found together */
  ShapeTable *table;
  const Family *family;
  int64_t begin;
  SliceShape *shapes;
  double *whole; /* [slices] as of slice_shape */
} Portion;

static void find_shape(void *context, int64_t n)
{
  const Portion *portion = context;
  const int64_t slice = portion->begin + n;
  portion->whole[slice] = INFINITY;
  portion->shapes[n] = slice_shape(portion->table, portion->family, slice, &portion->whole[slice]);
}

/** Families that are poor from the beginning, and all that are no poorer than at a face, carry their whole stress.
 *  @param[in] whole  [slices] as of slice_shape */
static int allow_faces(ShapeTable *table, const Family *family, const double *whole, Error *error)
{
  const Particles *p = family->particles;
  int blocks = 0;
  for (int64_t slice = 0; slice < p->slices; ++slice) blocks = p->block[slice] >= blocks ? p->block[slice] + 1 : blocks;
  double *least = memory_zeroed((size_t)blocks, sizeof *least, "shape tensors", error);
  if (!least) return BRECCIA_FAILURE;
  for (int b = 0; b < blocks; ++b) least[b] = INFINITY;
  for (int64_t slice = 0; slice < p->slices; ++slice)
    least[p->block[slice]] = fmin(least[p->block[slice]], whole[slice]);
  for (int64_t place = 0; place < p->places; ++place)
    table->allowed[place] = fmax(table->allowed[place], least[p->block[place / SLICE]]);
  free(least);
  return BRECCIA_OK;
}

int shape_table_create(ShapeTable *table, const Family *family, bool plane, Error *error)
{
  int64_t slices = family->particles->slices;
  size_t capacity = (size_t)(slices + slices / 2 + 1), slots_count = 1; /* shared entries, and one for each slice */
  while (slots_count < 2 * (size_t)slices + 2) slots_count *= 2;
  *table = (ShapeTable){.plane = plane};
  table->entry_of = memory_zeroed((size_t)slices, sizeof *table->entry_of, "shape tensors", error);
  table->shared = memory_zeroed(capacity, 1, "shape tensors", error);
  table->roundness = memory_zeroed((size_t)family->particles->places, sizeof *table->roundness, "shape tensors", error);
  table->allowed = memory_zeroed((size_t)family->particles->places, sizeof *table->allowed, "shape tensors", error);
  table->kept = memory_zeroed((size_t)family->particles->places, sizeof *table->kept, "shape tensors", error);
  table->mode = memory_zeroed((size_t)family->particles->places, 1, "shape tensors", error);
  double *whole = memory_zeroed((size_t)slices, sizeof *whole, "shape tensors", error);
  SliceShape *shapes = memory_zeroed(PORTION, sizeof *shapes, "shape tensors", error);
  int32_t *slots = memory_zeroed(slots_count, sizeof *slots, "shape tensors", error);
  /* Not zeroed: pages that no entry ever needs are never touched, and so take no memory. */
  table->entries = memory_noted(aligned_alloc(64, (capacity * sizeof(SliceShape) + 63) / 64 * 64));
  int failed = !table->entry_of || !table->shared || !table->roundness || !table->allowed || !table->kept ||
               !table->mode || !whole || !shapes || !slots;
  for (int64_t place = 0; table->kept && place < family->particles->places; ++place) table->kept[place] = 1;
  if (!table->entries) failed = error_add(error, BRECCIA_FAILURE, "out of memory: shape tensors");
  for (int64_t begin = 0; begin < slices && !failed; begin += PORTION) {
    int64_t end = begin + PORTION < slices ? begin + PORTION : slices;
    Portion portion = {table, family, begin, shapes, whole};
    team_each(end - begin, find_shape, &portion);
    for (int64_t slice = begin; slice < end; ++slice)
      table->entry_of[slice] = find_entry(table, &shapes[slice - begin], slots, slots_count - 1);
  }
  failed = failed || allow_faces(table, family, whole, error);
  free(shapes);
  free(slots);
  free(whole);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void shape_table_destroy(ShapeTable *table)
{
  free(table->entries);
  free(table->entry_of);
  free(table->shared);
  free(table->roundness);
  free(table->allowed);
  free(table->kept);
  free(table->mode);
  *table = (ShapeTable){0};
}

void shape_table_renew(ShapeTable *table, const Family *family, int64_t slice)
{
  if (table->shared[table->entry_of[slice]]) table->entry_of[slice] = (int32_t)table->count++;
  table->entries[table->entry_of[slice]] = slice_shape(table, family, slice, NULL);
}

size_t shape_table_bytes(const ShapeTable *table, const Family *family)
{
  return (size_t)table->count * (sizeof *table->entries + 1) +
         (size_t)family->particles->slices * sizeof *table->entry_of +
         (size_t)family->particles->places *
             (sizeof *table->roundness + sizeof *table->allowed + sizeof *table->kept + 1);
}
