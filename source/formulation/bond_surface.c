/* Particles near a surface lack bonds and are too soft. By the energy method (Madenci and Oterkus 2014; docs/theory.md 1) each particle gets
 * a factor for each axis: the energy of a stretch along it inside the body over that of its own family. A bond between i and j along n
 * has the factor 1 / |(n_a / g_a)|, g being the mean of both ends: an ellipsoid through the three factors. As that mean is less than a
 * particle at the surface would need, it is done again with the factors found: of a stretched cube's end, 0.50 of the stress inside
 * becomes 0.71 in one turn and 0.88 in three, of its sides 0.71 becomes 0.98 and 1.00, and the inside stays within 1 %. What counts as
 * inside is the whole family of the lattice, so that deep inside the factor is 1 whatever the calibration; among particles from a file,
 * those whose neighbours fill the horizon. It is found once, with the notches and cuts of the beginning. */
#include "formulation/bond_based.h"
#include "formulation/whole_family.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>

enum { TURNS = 3 };

/** Adds the energies of a unit stretch along each axis of one bond: w L n_a^4, for c = 4. */
static void add_energies(const double xi[3], double length, double weight, double energy[3])
{
  for (int a = 0; a < 3; ++a) energy[a] += weight * length * pow(xi[a] / length, 4);
}

static void family_energies(const BondBased *b, bool corrected, int64_t place, double energy[3])
{
  const Family *f = b->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    Bond bond = family_bond(f, slice, slot, lane);
    add_energies(bond.xi, bond.length, bond.weight * (corrected ? bond_factor(b, slice, slot, lane) : 1), energy);
  }
}

/** The same of a whole family inside a block. */
static void inner_energies(const BondBased *b, int block, double energy[3])
{
  const Family *f = b->family;
  for (int k = f->pattern_begin[block]; k < f->pattern_begin[block + 1]; ++k)
    add_energies(f->patterns[k].xi, f->patterns[k].length, f->patterns[k].weight, energy);
  int64_t count = 0;
  const bool cloud = !b->body->lattices[block].chunks;
  const double least = cloud ? whole_family_volume(b->body, f, block, LEAST_FILLED) : 0;
  for (int64_t place = 0; cloud && place < b->particles->places; ++place)
    if (whole_family_at(f, block, place, least)) {
      family_energies(b, false, place, energy);
      ++count;
    }
  for (int a = 0; a < 3 && count; ++a) energy[a] /= (double)count;
}

static float factor_of_ends(const Bond *bond, double *const factor[3], int64_t place)
{
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    double n = bond->xi[a] / bond->length, mean = (factor[a][place] + factor[a][bond->neighbour]) / 2;
    if (n != 0) sum += n * n / (mean * mean); /* across an axis without bonds the mean may be infinite */
  }
  return (float)(1 / sqrt(sum));
}

typedef struct Correction {
  BondBased *bonds;
  const double *inner; /* [3][blocks] */
  double *factor[3];
  int turn;
} Correction;

static void find_factors(void *context, int64_t place)
{
  const Correction *c = context;
  const BondBased *b = c->bonds;
  double own[3] = {0};
  family_energies(b, c->turn > 0, place, own);
  for (int a = 0; a < 3; ++a)
    c->factor[a][place] =
        (c->turn ? c->factor[a][place] : 1) * c->inner[3 * b->particles->block[place / SLICE] + a] / own[a];
}

/** Layers outside a support have the factors of what they are images of: their own outermost ones lack bonds, and turn by turn that would spread
 *  into the body. */
static void take_over_factors(void *context, int64_t place)
{
  const Correction *c = context;
  const BondBased *b = c->bonds;
  const int32_t number = b->particles->number[place];
  if (number < 0 || !body_outside(b->body, number)) return;
  const int32_t original = b->particles->place_of[body_original(b->body, number)];
  for (int a = 0; a < 3; ++a) c->factor[a][place] = c->factor[a][original];
}

static void correct_slice(void *context, int64_t slice)
{
  const Correction *c = context;
  const Family *f = c->bonds->family;
  float *factors = c->bonds->surface[slice];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      Bond bond = family_bond(f, slice, slot, lane);
      factors[(slot - f->first[slice]) * SLICE + lane] = factor_of_ends(&bond, c->factor, slice * SLICE + lane);
    }
}

int bond_correct_surface(BondBased *b, Error *error)
{
  const Family *f = b->family;
  const Particles *p = b->particles;
  double *inner = memory_zeroed(3 * (size_t)b->body->block_count, sizeof(double), "surface correction", error);
  Correction c = {.bonds = b, .inner = inner};
  int failed = !inner || bond_make_factors(b, NULL, error);
  for (int a = 0; a < 3; ++a) failed |= !(c.factor[a] = places_array(p->places, "surface correction", error));
  for (int block = 0; block < b->body->block_count && !failed; ++block) {
    inner_energies(b, block, inner + 3 * block);
    if (inner[3 * block] > 0 || block_is_foreign(b->foreign, p, block)) continue;
    failed = error_add(error, BRECCIA_USER_ERROR,
                       "block '%s': surface correction: energy compares particles from a file with those whose "
                       "neighbours fill the horizon of %g; there are none; take more particles, a shorter horizon, or "
                       "'surface correction: none'",
                       b->body->blocks[block]->head.name, f->horizon);
  }
  for (; c.turn < TURNS && !failed; ++c.turn) {
    team_each(p->places, find_factors, &c);
    if (b->body->margin_of) team_each(p->places, take_over_factors, &c);
    team_each(p->slices, correct_slice, &c);
  }
  for (int a = 0; a < 3; ++a) places_free(&c.factor[a]);
  free(inner);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}
