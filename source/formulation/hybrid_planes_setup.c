/* Which bonds planes go through (hybrid_planes.c): of which lattices, of which kinds, and of which slices all. */
#include "formulation/hybrid.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/** Steps along the rows, across them in a layer, and to the next layer, from the lower ends of bonds to their others. */
static const int ways[HYBRID_KINDS][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {-1, 1, 0}, {1, 0, 1},
                                          {-1, 0, 1}, {0, 1, 1},  {0, -1, 1}, {2, 0, 0},  {0, 2, 0},  {0, 0, 2},
                                          {1, 1, 1},  {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};

/** Kind of the bonds along a lattice vector from their lower ends. @return -1: there is none, or -2: the lattice is no cubic one */
static int kind_of(const Hybrid *h, int block, int vector)
{
  const Lattice *lattice = &h->family->lattices[block];
  const Pattern *pattern = &h->family->patterns[h->family->pattern_begin[block] + vector - 1];
  for (int k = 0; k < 3; ++k)
    if (fabs(pattern->xi[k] - lattice->spacing * pattern->offset[k]) > 1e-9 * lattice->spacing) return -2;
  const int way[3] = {pattern->offset[lattice->axis], pattern->offset[lattice->across[0]],
                      pattern->offset[lattice->across[1]]};
  for (int n = 0; n < HYBRID_KINDS; ++n)
    if (!memcmp(ways[n], way, sizeof way)) return n;
  return -1;
}

/** First slices of the layers of a block. */
static void find_layers(const Lattice *of, int32_t *layer)
{
  const int64_t layers = of->cells[of->across[1]], size = of->cells[of->across[0]] * of->chunks;
  int32_t next = 0;
  for (int64_t n = 0; n < layers * size; ++n)
    if (of->slice[n] >= next) next = of->slice[n] + 1;
  for (int64_t n = layers * size - 1; n >= 0; --n) {
    if (n == layers * size - 1) layer[layers] = next;
    if (of->slice[n] >= 0) next = of->slice[n];
    if (n % size == 0) layer[n / size] = next;
  }
}

int hybrid_planes_create(Hybrid *h, int block, Error *error)
{
  HybridLattice *lattice = &h->lattice[block];
  const Lattice *of = &h->family->lattices[block];
  const int kinds = lattice->count / 2;
  if (h->dimensions != 3 || h->pairwise || h->own != 1 || (kinds != NEAR_KINDS && kinds != HYBRID_KINDS))
    return BRECCIA_OK;
  int8_t kind[HYBRID_NEAR] = {-1};
  int found = 0;
  for (int n = 1; n < lattice->count; ++n) {
    kind[n] = (int8_t)kind_of(h, block, n);
    if (kind[n] < -1) return BRECCIA_OK;
    found += kind[n] >= 0 && kind[n] < kinds;
  }
  if (found != kinds || lattice->count != 2 * kinds + 1) return BRECCIA_OK;
  lattice->kinds = kinds;
  lattice->kind = memory_zeroed((size_t)lattice->count, sizeof *lattice->kind, "lattices", error);
  lattice->layer = memory_zeroed((size_t)of->cells[of->across[1]] + 1, sizeof *lattice->layer, "lattices", error);
  if (!lattice->kind || !lattice->layer) return BRECCIA_FAILURE;
  memcpy(lattice->kind, kind, sizeof *kind * (size_t)lattice->count);
  find_layers(of, lattice->layer);
  return BRECCIA_OK;
}

void hybrid_planes_weigh(const Hybrid *h, int64_t slice, HybridPlanes *planes)
{
  const BondList *l = h->bonds;
  const int block = h->particles->block[slice];
  memset(planes, 0, sizeof *planes);
  planes->full = true;
  for (int lane = 0; lane < SLICE; ++lane) planes->full &= h->particles->number[slice * SLICE + lane] >= 0;
  for (int64_t group = l->owned_first[slice]; group < l->owned_first[slice + 1]; ++group) {
    planes->leaves |= h->active[group] & ~h->planar[group];
    if (!h->planar[group]) continue;
    planes->some = true;
    const int64_t slot = h->family->first[slice] + l->owned[group];
    double *of = planes->volume[h->lattice[block].kind[hybrid_vector(h, block, slice, slot)]];
    const int32_t *mixed = h->group[group] < 0 ? h->mixed[-1 - h->group[group]] : NULL;
    for (int lane = 0; lane < SLICE; ++lane)
      if (h->planar[group] >> lane & 1) of[lane] = h->table.geometry[mixed ? mixed[lane] : h->group[group]].volume;
  }
}

void hybrid_planes_mark(Hybrid *h, int64_t slice)
{
  HybridPlanes planes;
  hybrid_planes_weigh(h, slice, &planes);
  int n = 0;
  while (n < h->plane_kinds && memcmp(&h->planes[n], &planes, sizeof planes) != 0) ++n;
  h->planar_kind[slice] = (uint8_t)n;
  if (n < h->plane_kinds || n == HYBRID_ODD) return;
  memcpy(&h->planes[h->plane_kinds++], &planes, sizeof planes); /* with what lies between its members */
}

/** Whether planes gain something in a block: where they leave few bonds, and stripes have half a layer or more. Measured: docs/performance.md. */
static bool is_worth_it(const Hybrid *h, int block)
{
  struct rlimit stack;
  const rlim_t enough = (rlim_t)2 << 20; /* a column of planes takes a quarter of it */
  if (!getrlimit(RLIMIT_STACK, &stack) && stack.rlim_cur < enough) return false;
  const HybridLattice *lattice = &h->lattice[block];
  const int64_t layers = h->family->lattices[block].cells[h->family->lattices[block].across[1]];
  const double least = lattice->kinds == NEAR_KINDS ? 0.8 : 0.65;
  int64_t all = 0, planar = 0, stripes = 0;
  for (int64_t slice = lattice->layer[0]; slice < lattice->layer[layers]; ++slice)
    for (int64_t group = h->bonds->owned_first[slice]; group < h->bonds->owned_first[slice + 1]; ++group) {
      all += __builtin_popcount(h->active[group]);
      planar += __builtin_popcount(h->planar[group]);
    }
  for (int64_t n = 0; n < h->stripes; ++n)
    stripes += h->stripe[n].first < lattice->layer[layers] && h->stripe[n].last > lattice->layer[0];
  return (double)planar >= least * (double)all && 2 * layers >= stripes;
}

void hybrid_planes_choose(Hybrid *h)
{
  for (int block = 0; block < h->body->block_count; ++block) {
    HybridLattice *lattice = &h->lattice[block];
    if (!lattice->kind || is_worth_it(h, block)) continue;
    free(lattice->kind);
    lattice->kind = NULL;
    for (int32_t n = 0; n < h->table.count; ++n)
      if (h->table.geometry[n].block == block) h->table.geometry[n].planar = false;
    for (int64_t slice = 0; slice < h->particles->slices; ++slice)
      for (int64_t group = h->bonds->owned_first[slice]; group < h->bonds->owned_first[slice + 1]; ++group)
        if (h->particles->block[slice] == block) h->planar[group] = 0;
  }
  for (int64_t slice = 0; slice < h->particles->slices; ++slice) hybrid_planes_mark(h, slice);
}
