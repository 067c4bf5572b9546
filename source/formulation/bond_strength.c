/* Strength of a body of softening bonds: largest stress of an infinite body under uniaxial tension with free sides,
 * over the largest stress of one bond. The file also computes the largest stress in uniaxial compression, over the
 * compressive strength of the law. For laws that yield it computes the stress of the body beyond yielding over that of a
 * bond at the same strain: slanted bonds yield later, and bonds across the pull press until they yield, too. With perfect
 * plasticity an isotropic plane family carries 1.41 times the yield stress. The stress of slanted bonds still increases when bonds along the pull have begun to
 * soften, so that a body carries more than its bonds (docs/theory.md 2). The stress of a uniform strain e is
 *   sigma = 1/2 sum (c / E) w L sigma_b(n . e n) n n
 * over the bonds of a particle, with the stress sigma_b of the law. For particles from a file the sum is the mean over
 * families inside the block. */
#include "base/linear.h"
#include "base/memory.h"
#include "base/tensor.h"
#include "constitutive/min_max.h"
#include "formulation/bond_based.h"
#include "formulation/whole_family.h"

#include <math.h>
#include <stdlib.h>

/* STRENGTH_TURNS: iterations with tangents; STRENGTH_ELASTIC_TURNS: iterations with the elastic stiffness.
 * STRENGTH_FAMILIES: number of families whose mean represents particles from a file. */
enum { STRENGTH_STEPS = 400, STRENGTH_TURNS = 40, STRENGTH_ELASTIC_TURNS = 400, STRENGTH_FAMILIES = 8, PARTS = 6 };

/* Number of increments of a pull beyond yielding. */
enum { YIELD_STEPS = 100 };

/* Strain of that pull over the strain at yielding; largest strain at yielding. Stresses across the pull vanish up to
 * `yield_side_tolerance` times the stress of a bond. */
static const double yield_multiple = 20, yield_largest = 0.2, yield_side_tolerance = 1e-4;

/* Increments of the pull, as a share of the strain at which the law begins to soften; the pull ends where the stress
 * has fallen to this share of the peak. Stresses across the pull vanish to this share of the peak. */
static const double strength_increment = 0.02, strength_fallen = 0.9, strength_side_tolerance = 1e-9;

/* Increment of the pressure over the ratio of strength to Young's modulus. Stresses across the pressure vanish up to
 * `crushing_side_tolerance` times the strength. */
static const double crushing_increment = 0.05, crushing_side_tolerance = 1e-4;

/** Bonds of a particle of an infinite body. Components of strain and stress: along the pull, across it, and the shear
 *  between both; in space also along the second direction across, and the other two shears. */
typedef struct StrengthBonds {
  const Material *material;
  Space space;
  int count, parts;
  double *share[PARTS], *weight; /* [count] bond strain of a unit component; (c / E) w L / 2 */
  double *direction[3]; /* [count] direction cosines of the bond with the pull and with the directions across */
  double *strain, *stress, *tangent, *length, *lateral, *committed, *trial;
} StrengthBonds;

/** A strain and its stress, by components. */
typedef struct StrengthState {
  double strain[PARTS], stress[PARTS];
} StrengthState;

static void strength_free(StrengthBonds *s)
{
  for (int k = 0; k < PARTS; ++k) free(s->share[k]);
  for (int k = 0; k < 3; ++k) free(s->direction[k]);
  free(s->weight);
  free(s->strain);
  free(s->stress);
  free(s->tangent);
  free(s->length);
  free(s->lateral);
  free(s->committed);
  free(s->trial);
}

static bool strength_reserve(StrengthBonds *s)
{
  const size_t count = (size_t)s->count, values = count * (size_t)s->material->history_values + 1;
  double **const rows[] = {&s->weight,  &s->strain,       &s->stress,       &s->tangent,     &s->length,
                           &s->lateral, &s->direction[0], &s->direction[1], &s->direction[2]};
  bool made = true;
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
    made &= (*rows[k] = memory_zeroed(count + 1, sizeof(double), "strength of bonds", NULL)) != NULL;
  for (int k = 0; k < s->parts; ++k)
    made &= (s->share[k] = memory_zeroed(count + 1, sizeof(double), "strength of bonds", NULL)) != NULL;
  made &= (s->committed = memory_zeroed(values, sizeof(double), "strength of bonds", NULL)) != NULL;
  made &= (s->trial = memory_zeroed(values, sizeof(double), "strength of bonds", NULL)) != NULL;
  return made;
}

/** Finds two unit vectors across a unit vector; in a plane the first one lies in it. */
static void strength_turn(const double n[3], double across[2][3])
{
  const bool plane = n[2] == 0;
  const double flat = sqrt(n[0] * n[0] + n[1] * n[1]);
  for (int k = 0; k < 3; ++k) across[0][k] = across[1][k] = 0;
  if (plane || flat > 0) {
    across[0][0] = -n[1] / flat;
    across[0][1] = n[0] / flat;
  } else {
    across[0][0] = 1;
  }
  for (int k = 0; k < 3; ++k)
    across[1][k] = n[(k + 1) % 3] * across[0][(k + 2) % 3] - n[(k + 2) % 3] * across[0][(k + 1) % 3];
}

/** Sets the shares and the weight of bond k. @param[in] rows  directions along the pull and across it */
static void strength_take(StrengthBonds *s, int k, const double xi[3], double length, double weight,
                          const double *const rows[3])
{
  double part[3];
  for (int r = 0; r < 3; ++r) part[r] = (xi[0] * rows[r][0] + xi[1] * rows[r][1] + xi[2] * rows[r][2]) / length;
  for (int r = 0; r < 3; ++r) s->direction[r][k] = part[r];
  s->share[0][k] = part[0] * part[0];
  s->share[1][k] = part[1] * part[1];
  s->share[2][k] = 2 * part[0] * part[1];
  if (s->parts == PARTS) {
    s->share[3][k] = part[2] * part[2];
    s->share[4][k] = 2 * part[1] * part[2];
    s->share[5][k] = 2 * part[0] * part[2];
  }
  s->weight[k] = weight * length / 2;
  s->length[k] = s->material->length;
}

/** Adds the bonds of families in the middle of a block of particles from a file. */
static bool strength_take_cloud(StrengthBonds *s, const BondBased *b, int block, const double *const rows[3])
{
  const Family *f = b->family;
  const Particles *p = b->particles;
  int64_t places[STRENGTH_FAMILIES];
  const int families = whole_families_in_the_middle(b->body, f, block, LEAST_FILLED, STRENGTH_FAMILIES, places);
  double volume = 0;
  for (int turn = 0; turn < 2; ++turn) { /* the first turn counts bonds, the second stores them */
    int bonds = 0;
    for (int n = 0; n < families; ++n) {
      const int64_t place = places[n], slice = place / SLICE;
      if (turn == 0) volume += p->volume[place];
      for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
        if (!(f->intact[slot] >> place % SLICE & 1)) continue;
        const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
        if (turn)
          strength_take(s, bonds, bond.xi, bond.length, b->per_stress[block] * bond.weight * p->volume[place] / volume,
                        rows);
        ++bonds;
      }
    }
    if (turn) continue;
    s->count = bonds;
    if (!bonds || !strength_reserve(s)) return false;
  }
  return true;
}

static bool strength_take_lattice(StrengthBonds *s, const BondBased *b, int block, const double *const rows[3])
{
  const int first = b->family->pattern_begin[block];
  s->count = b->family->pattern_begin[block + 1] - first;
  if (!strength_reserve(s)) return false;
  for (int k = 0; k < s->count; ++k) {
    const Pattern *p = &b->family->patterns[first + k];
    strength_take(s, k, p->xi, p->length, b->per_stress[block] * p->weight, rows);
  }
  return true;
}

static void strength_begin_histories(StrengthBonds *s)
{
  const breccia_law *law = s->material->law;
  for (int k = 0; k < s->count && law->begin; ++k) {
    law->begin(s->material->constants, s->committed + (ptrdiff_t)k * s->material->history_values);
    law->begin(s->material->constants, s->trial + (ptrdiff_t)k * s->material->history_values);
  }
}

static bool strength_begin(StrengthBonds *s, const BondBased *b, int block, const double n[3])
{
  double across[2][3];
  strength_turn(n, across);
  const double *const rows[3] = {n, across[0], across[1]};
  const bool lattice = b->body->lattices[block].chunks != 0;
  if (!(lattice ? strength_take_lattice(s, b, block, rows) : strength_take_cloud(s, b, block, rows))) return false;
  strength_begin_histories(s);
  return true;
}

/** Computes the stress of a strain. @return false if the law could not be integrated */
static bool strength_try(StrengthBonds *s, StrengthState *state)
{
  breccia_batch batch = {.size = sizeof batch,
                         .count = s->count,
                         .strain = {s->strain},
                         .stress = {s->stress},
                         .tangent = s->tangent,
                         .committed = s->committed,
                         .trial = s->trial,
                         .length = s->length,
                         .lateral = s->lateral};
  const double *e = state->strain;
  const double around[6] = {[XX] = e[0], [YY] = e[1], [ZZ] = e[3], [XY] = e[2], [YZ] = e[4], [ZX] = e[5]};
  for (int k = 0; k < s->count; ++k) {
    const double n[3] = {s->direction[0][k], s->direction[1][k], s->direction[2][k]};
    s->lateral[k] = bond_elongation_of_pressure(s->space, around, n);
    s->strain[k] = 0;
    for (int r = 0; r < s->parts; ++r) s->strain[k] += s->share[r][k] * state->strain[r];
  }
  if (material_update(s->material, &batch) >= 0) return false;
  for (int r = 0; r < s->parts; ++r) {
    state->stress[r] = 0;
    for (int k = 0; k < s->count; ++k) state->stress[r] += s->weight[k] * s->stress[k] * s->share[r][k];
  }
  return true;
}

static void strength_commit(StrengthBonds *s)
{
  double *const held = s->committed;
  s->committed = s->trial;
  s->trial = held;
}

/** Corrects the strain components across the pull with a stiffness of the bonds: positive tangents, or elastic
 *  stiffness.
 *  @return false if that stiffness is singular */
static bool strength_correct(const StrengthBonds *s, bool elastic, StrengthState *state)
{
  const double young = material_young(s->material);
  const int sides = s->parts - 1;
  double stiffness[(PARTS - 1) * (PARTS - 1)] = {0}, correction[PARTS - 1];
  for (int r = 0; r < sides; ++r) correction[r] = state->stress[r + 1];
  for (int k = 0; k < s->count; ++k) {
    const double slope = s->weight[k] * (elastic ? young : fmax(0, s->tangent[k]));
    for (int r = 0; r < sides; ++r)
      for (int q = 0; q < sides; ++q) stiffness[r * sides + q] += slope * s->share[r + 1][k] * s->share[q + 1][k];
  }
  if (!linear_solve(sides, stiffness, 1, correction)) return false;
  for (int r = 0; r < sides; ++r) state->strain[r + 1] -= correction[r];
  return true;
}

/** Solves for the strain components for which stresses across the pull vanish.
 *  @return false if the law could not be integrated, or if the iteration does not converge */
static bool strength_solve_sides(StrengthBonds *s, double tolerance, StrengthState *state)
{
  for (int turn = 0; turn < STRENGTH_TURNS + STRENGTH_ELASTIC_TURNS; ++turn) {
    double left = 0;
    if (!strength_try(s, state)) return false;
    for (int r = 1; r < s->parts; ++r) left = fmax(left, fabs(state->stress[r]));
    if (left <= tolerance) return true;
    const bool elastic = turn >= STRENGTH_TURNS || !strength_correct(s, false, state);
    if (elastic && !strength_correct(s, true, state)) return false;
  }
  return false;
}

/** Returns what one bond carries at most. */
static double strength_of_bond(const Material *m, double step)
{
  StrengthBonds one = {.material = m, .space = SPACE_BAR, .count = 1, .parts = 1};
  double most = 0;
  bool going = strength_reserve(&one);
  if (going) {
    one.share[0][0] = one.weight[0] = 1;
    one.length[0] = m->length;
    strength_begin_histories(&one);
  }
  for (int k = 1; going && k <= STRENGTH_STEPS; ++k) {
    StrengthState state = {.strain = {k * step}};
    going = strength_try(&one, &state) && state.stress[0] > strength_fallen * most;
    most = fmax(most, state.stress[0]);
    strength_commit(&one);
  }
  strength_free(&one);
  return most;
}

/** Computes the stress of one bond at a strain that it reaches in equal increments.
 *  @return NaN if the law could not be integrated */
static double stress_of_bond(const Material *m, double strain, int increments)
{
  StrengthBonds one = {.material = m, .space = SPACE_BAR, .count = 1, .parts = 1};
  StrengthState state = {.strain = {0}, .stress = {NAN}};
  bool going = strength_reserve(&one);
  if (going) {
    one.share[0][0] = one.weight[0] = 1;
    one.length[0] = m->length;
    strength_begin_histories(&one);
  }
  for (int k = 1; going && k <= increments; ++k) {
    state.strain[0] = k * strain / increments;
    going = strength_try(&one, &state);
    strength_commit(&one);
  }
  strength_free(&one);
  return going ? state.stress[0] : NAN;
}

/** Returns the strain at which a bond has yielded in tension: the first one, by steps of 5 %, at which the stress is less
 *  than 0.9 of the elastic stress; NAN if the bond does not yield below `yield_largest`. */
static double yield_strain(const Material *m)
{
  const double elastic_share = 0.9, growth = 1.05, smallest = 1e-6;
  for (double strain = smallest; strain < yield_largest; strain *= growth) {
    const double stress = stress_of_bond(m, strain, 1);
    if (isnan(stress) || stress < elastic_share * material_young(m) * strain) return isnan(stress) ? NAN : strain;
  }
  return NAN;
}

/** Returns the stress of a body whose bonds yield in uniaxial tension, over that of a bond at the same strain of
 *  `yield_multiple` times that at yielding; NaN if bonds do not yield, or tear or soften below that strain. */
static double strength_of_yielding(const BondBased *b, int block, const double n[3])
{
  const Material *m = bond_material(b, block);
  const double begin = yield_strain(m), end = yield_multiple * begin;
  if (isnan(begin)) return NAN;
  const double first = stress_of_bond(m, begin, YIELD_STEPS), bond = stress_of_bond(m, end, YIELD_STEPS);
  if (!(first > 0) || !(bond >= strength_fallen * first)) return NAN;
  StrengthBonds s = {.material = m, .space = b->space, .parts = b->body->dimensions == 2 ? 3 : PARTS};
  StrengthState state = {.strain = {0}};
  bool going = strength_begin(&s, b, block, n);
  for (int k = 1; going && k <= YIELD_STEPS; ++k) {
    state.strain[0] = k * end / YIELD_STEPS;
    going = strength_solve_sides(&s, yield_side_tolerance * bond, &state);
    strength_commit(&s);
  }
  strength_free(&s);
  return going ? state.stress[0] / bond : NAN;
}

double bond_uniaxial_strength(const void *formulation, int block, const double n[3])
{
  const BondBased *b = formulation;
  const int dimensions = b->body->dimensions;
  if (dimensions < 2 || block_is_foreign(b->foreign, b->particles, block)) return NAN;
  const Material *m = bond_material(b, block);
  if (m->remote || m->law->components != 1 || m->law->linear) return NAN;
  if (!(m->softening_energy > 0)) return strength_of_yielding(b, block, n);
  const double begin = sqrt(2 * m->softening_energy / material_young(m)), step = strength_increment * begin,
               bond = strength_of_bond(m, step);
  StrengthBonds s = {.material = m, .space = b->space, .parts = dimensions == 2 ? 3 : PARTS};
  StrengthState state = {.strain = {0}}, before = state;
  double most = 0;
  bool going = bond > 0 && strength_begin(&s, b, block, n);
  for (int k = 1; going && k <= STRENGTH_STEPS; ++k) {
    const StrengthState last = state;
    for (int r = 1; r < s.parts; ++r) state.strain[r] += last.strain[r] - before.strain[r];
    state.strain[0] = k * step;
    going =
        strength_solve_sides(&s, strength_side_tolerance * bond, &state) && state.stress[0] > strength_fallen * most;
    most = fmax(most, state.stress[0]);
    strength_commit(&s);
    before = last;
  }
  strength_free(&s);
  return most > 0 ? most / bond : NAN;
}

double bond_uniaxial_crushing(const void *formulation, int block, const double n[3])
{
  const BondBased *b = formulation;
  const int dimensions = b->body->dimensions;
  const Material *m = bond_material(b, block);
  if (dimensions < 2 || !b->body->lattices[block].chunks || block_is_foreign(b->foreign, b->particles, block) ||
      m->remote || m->law->components != 1 || isnan(material_compressive_strength(m)))
    return NAN;
  const double wanted = material_compressive_strength(m), step = -crushing_increment * wanted / material_young(m);
  StrengthBonds s = {.material = m, .space = b->space, .parts = dimensions == 2 ? 3 : PARTS};
  StrengthState state = {.strain = {0}};
  double most = 0;
  bool going = strength_begin(&s, b, block, n);
  for (int k = 1; going && k <= STRENGTH_STEPS; ++k) {
    state.strain[0] = k * step;
    going =
        strength_solve_sides(&s, crushing_side_tolerance * wanted, &state) && -state.stress[0] > strength_fallen * most;
    most = fmax(most, -state.stress[0]);
    strength_commit(&s);
  }
  strength_free(&s);
  return most > 0 ? most / wanted : NAN;
}
