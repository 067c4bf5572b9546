#include "family/search.h"

#include "base/team.h"
#include "family/cells.h"
#include <math.h>
#include <stdlib.h>

typedef struct Search {
  const Cells *cells;
  const Body *body;
  const StoredWeight *weight;
  bool weighted;            /* bonds have other weights than 1 */
  double farthest, nearest; /* squares of distances: none beyond are bonded, none within may be on top of each other */
} Search;

/** True if two particles of these blocks are nearer than a hundredth of their spacings. */
static bool on_top(const Body *body, int own, int block, double square)
{
  return sqrt(square) < 0.005 * (body->lattices[own].spacing + body->lattices[block].spacing);
}

/** Finds the neighbours of a place that stand in no common lattice with it. Those at higher places come first, cell by cell and by number within a
 *  cell, and the others behind them the other way round: bonds are kept once, by their lower ends (family/bond_list.h), and slots are full of bonds that
 *  eight particles keep so.
 *  @param[in] total              how many there are
 *  @param[out] neighbour, scale  where they go; either may be NULL
 *  @return how many, or -1 if a particle lies on top of this one */
static int64_t collect(const Search *search, int32_t place, int64_t total, int32_t *neighbour, double *scale)
{
  const Cells *cells = search->cells;
  const Body *body = search->body;
  const StoredWeight *rule = search->weight;
  const Particles *p = &body->particles;
  const int own = p->block[place / SLICE];
  const bool own_too = !body->lattices[own].chunks;
  const double here[3] = {p->position[0][place], p->position[1][place], p->position[2][place]};
  int64_t rows[9][2], count = 0, higher = 0;
  const int row_count = cells_around(cells, here, rows);
  for (int row = 0; row < row_count; ++row)
    for (int64_t k = rows[row][0]; k < rows[row][1]; ++k) {
      const double *there = cells->position + 3 * k;
      double square = 0;
      for (int i = 0; i < 3; ++i) square += (there[i] - here[i]) * (there[i] - here[i]);
      if (square > search->farthest) continue;
      int32_t other = cells->places[k];
      int block = p->block[other / SLICE];
      if (block == own && (!own_too || other == place)) continue;
      if (square < search->nearest && on_top(body, own, block, square)) return -1;
      double share = 1, length = 0;
      if (search->weighted) {
        double half = (body->lattices[own].spacing + body->lattices[block].spacing) / 4;
        double reach = rule->horizon + (rule->correction == VOLUME_PARTIAL_BEYOND ? half : 0);
        length = sqrt(square);
        share = length > reach * (1 + 1e-9) ? 0 : rule->share(rule->correction, length, rule->horizon, half);
      }
      if (share == 0 || (body->crack_count && body_cuts_bond(body, place, other))) continue;
      const int64_t at = other > place ? higher++ : total - 1 - (count - higher);
      if (neighbour) neighbour[at] = other;
      if (scale) scale[at] = rule->influence->value(fmin(1, length / rule->horizon), length) * share;
      ++count;
    }
  return count;
}

typedef struct Sweep {
  const Search *search;
  StoredBonds *stored;
  bool fill;
} Sweep;

/** Counts or fills. Where a particle lies on top of this one the count is left at -1. */
static void sweep_place(void *context, int64_t place)
{
  const Sweep *s = context;
  StoredBonds *stored = s->stored;
  if (s->search->body->particles.number[place] < 0) return;
  int64_t at = s->fill ? stored->first[place] : 0;
  const int64_t total = s->fill ? stored->first[place + 1] - at : 0;
  int64_t count = collect(s->search, (int32_t)place, total, s->fill ? stored->neighbour + at : NULL,
                          s->fill && stored->scale ? stored->scale + at : NULL);
  if (!s->fill) stored->first[place + 1] = count;
}

int search_beyond_lattices(StoredBonds *stored, const Body *body, const StoredWeight *weight, Error *error)
{
  const Particles *p = &body->particles;
  Cells cells = {0};
  const double beyond = weight->correction == VOLUME_PARTIAL_BEYOND ? body->largest_spacing / 2 : 0;
  const double farthest = (weight->horizon + beyond) * (1 + 1e-9);
  int status = cells_create(&cells, p, (const double *const *)p->position, farthest, error);
  stored->first = memory_zeroed((size_t)p->places + 1, sizeof(int64_t), "stored bonds", error);
  if (!stored->first) status = BRECCIA_FAILURE;
  const bool weighted = weight->correction != VOLUME_WHOLE || weight->influence != influence_at(INFLUENCE_CONSTANT);
  const double nearest = 0.01 * body->largest_spacing;
  Search search = {&cells, body, weight, weighted, farthest * farthest, nearest * nearest};
  Sweep sweep = {.search = &search, .stored = stored};
  int64_t bad = p->places;
  if (!status) {
    team_each(p->places, sweep_place, &sweep);
    for (bad = 0; bad < p->places && stored->first[bad + 1] >= 0;) ++bad;
  }
  if (bad < p->places)
    status = error_add(error, BRECCIA_USER_ERROR,
                       "two particles lie on top of each other at [%g, %g, %g] (block '%s'); blocks must not overlap",
                       p->position[0][bad], p->position[1][bad], p->position[2][bad],
                       body->blocks[p->block[bad / SLICE]]->head.name);
  if (!status) {
    for (int64_t place = 0; place < p->places; ++place) stored->first[place + 1] += stored->first[place];
    size_t bonds = (size_t)stored->first[p->places];
    stored->neighbour = memory_zeroed(bonds, sizeof(int32_t), "stored bonds", error);
    if (weighted) stored->scale = memory_zeroed(bonds, sizeof(double), "stored bonds", error);
    sweep.fill = true;
    if (!stored->neighbour || (weighted && !stored->scale))
      status = BRECCIA_FAILURE;
    else
      team_each(p->places, sweep_place, &sweep);
  }
  cells_destroy(&cells);
  return status;
}

void stored_bonds_destroy(StoredBonds *stored)
{
  free(stored->first);
  free(stored->neighbour);
  free(stored->scale);
  *stored = (StoredBonds){0};
}
