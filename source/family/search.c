#include "family/search.h"

#include <math.h>
#include <stdlib.h>

/* Particles sorted into cubic cells at least as wide as the reach: all neighbours lie in the 27 cells around. */
typedef struct Cells {
  double low[3], width;
  int64_t count[3];
  int64_t *first;  /* [cells + 1] */
  int32_t *places; /* ascending by number within a cell */
} Cells;

static int64_t cell_along(const Cells *cells, int k, double x)
{
  int64_t c = (int64_t)floor((x - cells->low[k]) / cells->width);
  return c < 0 ? 0 : c >= cells->count[k] ? cells->count[k] - 1 : c;
}

static int64_t cell_of(const Cells *cells, const Particles *p, int32_t place)
{
  int64_t c[3];
  for (int k = 0; k < 3; ++k) c[k] = cell_along(cells, k, p->position[k][place]);
  return c[0] + cells->count[0] * (c[1] + cells->count[1] * c[2]);
}

static int cells_create(Cells *cells, const Particles *p, double reach, Error *error)
{
  double high[3];
  particles_bounds(p, cells->low, high);
  cells->width = reach * (1 + 1e-6);
  double total;
  do { /* a thin body in a wide box: cells may be wider, never more than a few per particle */
    total = 1;
    for (int k = 0; k < 3; ++k) total *= floor((high[k] - cells->low[k]) / cells->width) + 1;
    if (total > 4.0 * (double)p->count + 64) cells->width *= 2;
  } while (total > 4.0 * (double)p->count + 64);
  for (int k = 0; k < 3; ++k) cells->count[k] = (int64_t)floor((high[k] - cells->low[k]) / cells->width) + 1;
  cells->first = memory_zeroed((size_t)total + 1, sizeof(int64_t), "search cells", error);
  cells->places = memory_zeroed((size_t)p->count, sizeof(int32_t), "search cells", error);
  if (!cells->first || !cells->places) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < p->count; ++n) ++cells->first[cell_of(cells, p, p->place_of[n]) + 1];
  for (int64_t c = 0; c < (int64_t)total; ++c) cells->first[c + 1] += cells->first[c];
  for (int64_t n = p->count - 1; n >= 0; --n) { /* backwards, so that shifting the starts down leaves ascending order */
    int64_t c = cell_of(cells, p, p->place_of[n]);
    cells->places[--cells->first[c + 1]] = p->place_of[n];
  }
  for (int64_t c = 0; c < (int64_t)total; ++c) cells->first[c] = cells->first[c + 1];
  cells->first[(int64_t)total] = p->count;
  return BRECCIA_OK;
}

typedef struct Candidate {
  int32_t number, place;
  double weight;
} Candidate;

static int by_number(const void *a, const void *b)
{
  const Candidate *x = a, *y = b;
  return x->number < y->number ? -1 : x->number > y->number;
}

typedef struct Found {
  Candidate *items;
  int64_t count, capacity;
} Found;

/** Collects the neighbours of a place in other blocks. @return 0, 1 when memory is out, 2 for coinciding particles */
static int collect(const Cells *cells, const Body *body, const StoredWeight *weight, int32_t place, Found *found)
{
  const Particles *p = &body->particles;
  int own = p->block[place / SLICE];
  double here[3] = {p->position[0][place], p->position[1][place], p->position[2][place]};
  int64_t centre[3];
  for (int k = 0; k < 3; ++k) centre[k] = cell_along(cells, k, here[k]);
  found->count = 0;
  for (int64_t c = 0; c < 27; ++c) {
    int64_t cell[3] = {centre[0] + c % 3 - 1, centre[1] + c / 3 % 3 - 1, centre[2] + c / 9 - 1};
    bool outside = false;
    for (int k = 0; k < 3; ++k) outside |= cell[k] < 0 || cell[k] >= cells->count[k];
    if (outside) continue;
    int64_t at = cell[0] + cells->count[0] * (cell[1] + cells->count[1] * cell[2]);
    for (int64_t k = cells->first[at]; k < cells->first[at + 1]; ++k) {
      int32_t other = cells->places[k];
      int block = p->block[other / SLICE];
      if (block == own) continue;
      double there[3] = {p->position[0][other], p->position[1][other], p->position[2][other]}, square = 0;
      for (int i = 0; i < 3; ++i) square += (there[i] - here[i]) * (there[i] - here[i]);
      double length = sqrt(square), half = (body->lattices[own].spacing + body->lattices[block].spacing) / 4;
      double reach = weight->horizon + (weight->correction == VOLUME_PARTIAL_BEYOND ? half : 0);
      if (length > reach * (1 + 1e-9)) continue;
      if (length < 0.02 * half) return 2;
      double share = weight->share(weight->correction, length, weight->horizon, half);
      if (share == 0 || body_cuts(body, here, there)) continue;
      if (found->count == found->capacity) {
        int64_t capacity = found->capacity ? 2 * found->capacity : 64;
        Candidate *grown = realloc(found->items, sizeof(Candidate) * (size_t)capacity);
        if (!grown) return 1;
        found->items = grown;
        found->capacity = capacity;
      }
      double influence = weight->influence->value(fmin(1, length / weight->horizon), length);
      found->items[found->count++] = (Candidate){p->number[other], other, influence * share * p->volume[other]};
    }
  }
  if (found->count) qsort(found->items, (size_t)found->count, sizeof(Candidate), by_number);
  return 0;
}

int search_between_blocks(StoredBonds *stored, const Body *body, const StoredWeight *weight, Error *error)
{
  const Particles *p = &body->particles;
  Cells cells = {0};
  int status = cells_create(&cells, p, weight->horizon + body->largest_spacing / 2, error);
  stored->first = memory_zeroed((size_t)p->places + 1, sizeof(int64_t), "stored bonds", error);
  if (!stored->first) status = BRECCIA_FAILURE;
  Found found = {0};
  for (int pass = 0; pass < 2 && !status; ++pass) {
    for (int64_t place = 0; place < p->places && !status; ++place) {
      if (p->number[place] < 0) {
        if (!pass) stored->first[place + 1] = stored->first[place];
        continue;
      }
      int bad = collect(&cells, body, weight, (int32_t)place, &found);
      if (bad == 1) status = error_add(error, BRECCIA_FAILURE, "out of memory: stored bonds");
      if (bad == 2)
        status = error_add(error, BRECCIA_USER_ERROR,
                           "blocks overlap: two particles lie on top of each other at [%g, %g, %g] (block '%s')",
                           p->position[0][place], p->position[1][place], p->position[2][place],
                           body->blocks[p->block[place / SLICE]]->head.name);
      if (status) break;
      if (!pass) stored->first[place + 1] = stored->first[place] + found.count;
      for (int64_t k = 0; pass && k < found.count; ++k) {
        stored->neighbour[stored->first[place] + k] = found.items[k].place;
        stored->weight[stored->first[place] + k] = found.items[k].weight;
      }
    }
    if (!pass && !status) {
      size_t bonds = (size_t)stored->first[p->places];
      stored->neighbour = memory_zeroed(bonds, sizeof(int32_t), "stored bonds", error);
      stored->weight = memory_zeroed(bonds, sizeof(double), "stored bonds", error);
      if (!stored->neighbour || !stored->weight) status = BRECCIA_FAILURE;
    }
  }
  free(found.items);
  free(cells.first);
  free(cells.places);
  return status;
}

void stored_bonds_destroy(StoredBonds *stored)
{
  free(stored->first);
  free(stored->neighbour);
  free(stored->weight);
  *stored = (StoredBonds){0};
}
