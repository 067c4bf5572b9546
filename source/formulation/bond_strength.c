/* Strength of a lattice of softening bonds: what an infinite body carries at most that is pulled along one direction
 * and free across it, over what one bond carries at most; and what it carries at most if pressed, over the compressive
 * strength of its law. Slanted bonds still gain when those along the pull have
 * begun to soften, so that the body carries more than its bonds (docs/theory.md 2). The stress of a uniform strain e is
 *   sigma = 1/2 sum (c / E) w L sigma_b(n . e n) n n
 * over the bonds of a particle, with the stress sigma_b of the law. */
#include "base/memory.h"
#include "constitutive/min_max.h"
#include "formulation/bond_based.h"

#include <math.h>
#include <stdlib.h>

enum { STRENGTH_STEPS = 400, STRENGTH_TURNS = 200 };

/* Increments of the pull, as a share of the strain at which the law begins to soften; the pull ends where the stress
 * has fallen to this share of the peak. Stresses across the pull vanish to this share of the peak. */
static const double strength_increment = 0.02, strength_fallen = 0.9, strength_side_tolerance = 1e-6;

/* Increments of the pressure, as a share of strength over Young's modulus. Stresses across vanish to this share of the
 * strength. */
static const double crushing_increment = 0.05, crushing_side_tolerance = 1e-4;

/** Bonds of a particle of an infinite lattice. Rows are the pull and the two directions across it. */
typedef struct StrengthBonds {
  const Material *material;
  Space space;
  int count;
  double *share[3], *weight; /* [count] squares of the parts of n along the rows; (c / E) w L / 2 */
  double *strain, *stress, *length, *lateral, *committed, *trial;
} StrengthBonds;

static void strength_free(StrengthBonds *s)
{
  for (int k = 0; k < 3; ++k) free(s->share[k]);
  free(s->weight);
  free(s->strain);
  free(s->stress);
  free(s->length);
  free(s->lateral);
  free(s->committed);
  free(s->trial);
}

static bool strength_reserve(StrengthBonds *s)
{
  const size_t count = (size_t)s->count, values = count * (size_t)s->material->history_values + 1;
  double **const rows[] = {&s->share[0], &s->share[1], &s->share[2], &s->weight,
                           &s->strain,   &s->stress,   &s->length,   &s->lateral};
  bool made = true;
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
    made &= (*rows[k] = memory_zeroed(count, sizeof(double), "strength of bonds", NULL)) != NULL;
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

static bool strength_begin(StrengthBonds *s, const BondBased *b, int block, const double n[3])
{
  const int first = b->family->pattern_begin[block];
  double across[2][3];
  s->count = b->family->pattern_begin[block + 1] - first;
  if (!strength_reserve(s)) return false;
  strength_turn(n, across);
  for (int k = 0; k < s->count; ++k) {
    const Pattern *p = &b->family->patterns[first + k];
    const double *const rows[3] = {n, across[0], across[1]};
    for (int r = 0; r < 3; ++r)
      s->share[r][k] = pow((p->xi[0] * rows[r][0] + p->xi[1] * rows[r][1] + p->xi[2] * rows[r][2]) / p->length, 2);
    s->weight[k] = b->per_stress[block] * p->weight * p->length / 2;
    s->length[k] = s->material->length;
  }
  const breccia_law *law = s->material->law;
  for (int k = 0; k < s->count && law->begin; ++k) {
    law->begin(s->material->constants, s->committed + (size_t)(k * s->material->history_values));
    law->begin(s->material->constants, s->trial + (size_t)(k * s->material->history_values));
  }
  return true;
}

/** Finds the stresses along the rows for strains along them. @return false if the law could not be integrated */
static bool strength_try(StrengthBonds *s, const double strain[3], double stress[3])
{
  breccia_batch batch = {.size = sizeof batch,
                         .count = s->count,
                         .strain = {s->strain},
                         .stress = {s->stress},
                         .committed = s->committed,
                         .trial = s->trial,
                         .length = s->length,
                         .lateral = s->lateral};
  const double around[6] = {strain[0], strain[1], strain[2], 0, 0, 0};
  for (int k = 0; k < s->count; ++k) {
    const double n[3] = {sqrt(s->share[0][k]), sqrt(s->share[1][k]), sqrt(s->share[2][k])};
    s->strain[k] = s->share[0][k] * strain[0] + s->share[1][k] * strain[1] + s->share[2][k] * strain[2];
    s->lateral[k] = bond_elongation_of_pressure(s->space, around, n);
  }
  if (material_update(s->material, &batch) >= 0) return false;
  for (int r = 0; r < 3; ++r) {
    stress[r] = 0;
    for (int k = 0; k < s->count; ++k) stress[r] += s->weight[k] * s->stress[k] * s->share[r][k];
  }
  return true;
}

static void strength_commit(StrengthBonds *s)
{
  double *const held = s->committed;
  s->committed = s->trial;
  s->trial = held;
}

/** Solves for the lateral strains at which the lateral stresses vanish, by steps with the elastic stiffness.
 *  @return false if the law could not be integrated, or the steps do not converge */
static bool strength_solve_sides(StrengthBonds *s, int dimensions, double tolerance, double strain[3], double stress[3])
{
  double stiffness[3] = {0};
  for (int r = 1; r < dimensions; ++r)
    for (int k = 0; k < s->count; ++k)
      for (int q = 1; q < dimensions; ++q)
        stiffness[r] += material_young(s->material) * s->weight[k] * s->share[r][k] * s->share[q][k];
  for (int turn = 0; turn < STRENGTH_TURNS; ++turn) {
    double left = 0;
    if (!strength_try(s, strain, stress)) return false;
    for (int r = 1; r < dimensions; ++r) left = fmax(left, fabs(stress[r]));
    if (left <= tolerance) return true;
    for (int r = 1; r < dimensions; ++r) strain[r] -= stress[r] / stiffness[r];
  }
  return false;
}

/** Returns what one bond carries at most. */
static double strength_of_bond(const Material *m, double step)
{
  StrengthBonds one = {.material = m, .space = SPACE_BAR, .count = 1};
  double most = 0, stress[3];
  bool going = strength_reserve(&one);
  if (going) {
    one.share[0][0] = one.weight[0] = 1;
    one.length[0] = m->length;
    if (m->law->begin) m->law->begin(m->constants, one.committed);
    if (m->law->begin) m->law->begin(m->constants, one.trial);
  }
  for (int k = 1; going && k <= STRENGTH_STEPS; ++k) {
    going = strength_try(&one, (const double[]){k * step, 0, 0}, stress) && stress[0] > strength_fallen * most;
    most = fmax(most, stress[0]);
    strength_commit(&one);
  }
  strength_free(&one);
  return most;
}

double bond_uniaxial_strength(const void *formulation, int block, const double n[3])
{
  const BondBased *b = formulation;
  const Material *m = bond_material(b, block);
  if (!b->body->lattices[block].chunks || block_is_foreign(b->foreign, b->particles, block) || m->remote ||
      m->law->components != 1 || !(m->softening_energy > 0))
    return NAN;
  const double begin = sqrt(2 * m->softening_energy / material_young(m)), step = strength_increment * begin,
               bond = strength_of_bond(m, step);
  StrengthBonds s = {.material = m, .space = b->space};
  double strain[3] = {0}, stress[3], most = 0;
  bool going = strength_begin(&s, b, block, n) && bond > 0;
  for (int k = 1; going && k <= STRENGTH_STEPS; ++k) {
    strain[0] = k * step;
    going = strength_solve_sides(&s, b->body->dimensions, strength_side_tolerance * bond, strain, stress) &&
            stress[0] > strength_fallen * most;
    most = fmax(most, stress[0]);
    strength_commit(&s);
  }
  strength_free(&s);
  return most > 0 ? most / bond : NAN;
}

double bond_uniaxial_crushing(const void *formulation, int block, const double n[3])
{
  const BondBased *b = formulation;
  const Material *m = bond_material(b, block);
  if (!b->body->lattices[block].chunks || block_is_foreign(b->foreign, b->particles, block) || m->remote ||
      m->law->components != 1 || isnan(material_compressive_strength(m)))
    return NAN;
  const double wanted = material_compressive_strength(m), step = -crushing_increment * wanted / material_young(m);
  StrengthBonds s = {.material = m, .space = b->space};
  double strain[3] = {0}, stress[3], most = 0;
  bool going = strength_begin(&s, b, block, n);
  for (int k = 1; going && k <= STRENGTH_STEPS; ++k) {
    strain[0] = k * step;
    going = strength_solve_sides(&s, b->body->dimensions, crushing_side_tolerance * wanted, strain, stress) &&
            -stress[0] > strength_fallen * most;
    most = fmax(most, -stress[0]);
    strength_commit(&s);
  }
  strength_free(&s);
  return most > 0 ? most / wanted : NAN;
}
