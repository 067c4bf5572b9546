#include "formulation/shape_table.h"

#include "base/team.h"
#include <stdlib.h>
#include <string.h>

enum { BATCH = 2048 }; /* slices whose shapes are found at once before alike ones are looked for */

static SliceShape slice_shape(ShapeTable *table, const Family *family, int64_t slice, bool first_time)
{
  SliceShape shapes = {0};
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
    if (first_time) table->roundness[place] = (float)shape.roundness;
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

typedef struct Batch { /* of slices whose shapes are found together */
  ShapeTable *table;
  const Family *family;
  int64_t begin;
  SliceShape *shapes;
} Batch;

static void find_shape(void *context, int64_t n)
{
  const Batch *batch = context;
  batch->shapes[n] = slice_shape(batch->table, batch->family, batch->begin + n, true);
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
  table->mode = memory_zeroed((size_t)family->particles->places, 1, "shape tensors", error);
  SliceShape *shapes = memory_zeroed(BATCH, sizeof *shapes, "shape tensors", error);
  int32_t *slots = memory_zeroed(slots_count, sizeof *slots, "shape tensors", error);
  /* Not zeroed: pages that no entry ever needs are never touched, and so take no memory. */
  table->entries = aligned_alloc(64, (capacity * sizeof(SliceShape) + 63) / 64 * 64);
  int failed = !table->entry_of || !table->shared || !table->roundness || !table->mode || !shapes || !slots;
  if (!table->entries) failed = error_add(error, BRECCIA_FAILURE, "out of memory: shape tensors");
  for (int64_t begin = 0; begin < slices && !failed; begin += BATCH) {
    int64_t end = begin + BATCH < slices ? begin + BATCH : slices;
    Batch batch = {table, family, begin, shapes};
    team_each(end - begin, find_shape, &batch);
    for (int64_t slice = begin; slice < end; ++slice)
      table->entry_of[slice] = find_entry(table, &shapes[slice - begin], slots, slots_count - 1);
  }
  free(shapes);
  free(slots);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void shape_table_destroy(ShapeTable *table)
{
  free(table->entries);
  free(table->entry_of);
  free(table->shared);
  free(table->roundness);
  free(table->mode);
  *table = (ShapeTable){0};
}

void shape_table_renew(ShapeTable *table, const Family *family, int64_t slice)
{
  if (table->shared[table->entry_of[slice]]) table->entry_of[slice] = (int32_t)table->count++;
  table->entries[table->entry_of[slice]] = slice_shape(table, family, slice, false);
}

size_t shape_table_bytes(const ShapeTable *table, const Family *family)
{
  return (size_t)table->count * (sizeof *table->entries + 1) +
         (size_t)family->particles->slices * sizeof *table->entry_of +
         (size_t)family->particles->places * (sizeof *table->roundness + 1);
}
