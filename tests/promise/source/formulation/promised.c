/* A formulation as somebody would add one: bonds are springs of one micromodulus. */
#include "formulation/formulation.h"

#include <math.h>
#include <stdlib.h>

typedef struct PromisedSpec {
  SectionHead head;
  double share;
} PromisedSpec;

static const Field fields[] = {{.key = "promised share",
                                .kind = FIELD_NUMBER,
                                .offset = offsetof(PromisedSpec, share),
                                .dimension = "1",
                                .standard = "1",
                                .range = "(0, 1]",
                                .meaning = "of the usual micromodulus"}};
static const Section section = {
    .name = "promised", .about = "Keys of a formulation.", .size = sizeof(PromisedSpec), FIELDS(fields)};

typedef struct Promised {
  FormulationParts parts;
  double modulus;
} Promised;

static void *create(const FormulationParts *parts, Error *error)
{
  Promised *p = calloc(1, sizeof *p);
  if (!p) {
    error_add(error, BRECCIA_FAILURE, "out of memory: formulation");
    return NULL;
  }
  p->parts = *parts;
  p->modulus = ((const PromisedSpec *)parts->keys)->share *
               micromodulus(parts->body, material_young(&parts->materials[0]), parts->family->horizon);
  return p;
}

/** Deformed bond, and its stretch. */
static double stretch_of(double *const *u, int64_t place, const Bond *bond, double y[3])
{
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    y[k] = bond->xi[k] + u[k][bond->neighbour] - u[k][place];
    square += y[k] * y[k];
  }
  for (int k = 0; k < 3; ++k) y[k] /= sqrt(square);
  return sqrt(square) / bond->length - 1;
}

static void half_state(const void *formulation, double *const *u, double *const *at, int64_t slice, int64_t slot,
                       int lane, double state[3])
{
  (void)at;
  const Promised *p = formulation;
  const Bond bond = family_bond(p->parts.family, slice, slot, lane);
  const double pull = p->modulus * stretch_of(u, slice * SLICE + lane, &bond, state) / 2;
  for (int k = 0; k < 3; ++k) state[k] *= pull;
}

static int64_t resist(void *formulation, const Sweep *sweep)
{
  const Promised *p = formulation;
  const Family *f = p->parts.family;
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; ++place) {
    double force[3] = {0}, half[3];
    const int64_t slice = place / SLICE;
    const int lane = (int)(place % SLICE);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      half_state(p, sweep->displacement, NULL, slice, slot, lane, half);
      for (int k = 0; k < 3; ++k) force[k] += 2 * half[k] * family_bond(f, slice, slot, lane).weight;
    }
    for (int k = 0; k < 3; ++k) sweep->internal[k][place] = force[k];
  }
  return -1;
}

static int linearise(void *formulation, double *const *displacement, Error *error)
{
  (void)formulation, (void)displacement;
  return error_add(error, BRECCIA_FAILURE, "promised: has no linearised step");
}

static int64_t point_count(const void *formulation)
{
  (void)formulation;
  return 0;
}

static int point(const void *formulation, double *const *displacement, int64_t number, Operator *op, Error *error)
{
  (void)formulation, (void)displacement, (void)number, (void)op;
  return error_add(error, BRECCIA_FAILURE, "promised: has no points");
}

static void gradient(const void *formulation, int64_t place, double f[9])
{
  (void)formulation, (void)place;
  for (int k = 0; k < 9; ++k) f[k] = k % 4 == 0;
}

static void bond_energy(const void *formulation, int64_t slice, int64_t slot, int lane, double time, StoredEnergy *e)
{
  const Promised *p = formulation;
  const int64_t place = slice * SLICE + lane;
  const Bond bond = family_bond(p->parts.family, slice, slot, lane);
  double y[3];
  (void)time;
  const double stretch = stretch_of(p->parts.particles->displacement.row, place, &bond, y);
  *e = (StoredEnergy){.stored = p->modulus * stretch * stretch * bond.length / 2 * p->parts.particles->volume[place] *
                                bond.weight};
  e->received = e->stored;
}

static void stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy)
{
  const Family *f = ((const Promised *)formulation)->parts.family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  *energy = (StoredEnergy){0};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    StoredEnergy one;
    if (!(f->intact[slot] >> lane & 1)) continue;
    bond_energy(formulation, slice, slot, lane, time, &one);
    energy->stored += one.stored / 2; /* the other half is the neighbour's */
    energy->received += one.received / 2;
  }
}

static void stress(const void *formulation, int64_t place, double tensor[6])
{
  (void)formulation, (void)place;
  for (int k = 0; k < 6; ++k) tensor[k] = 0;
}

static FormerBonds former_bonds(const void *formulation)
{
  (void)formulation;
  return (FormerBonds){1, true};
}

static size_t bytes(const void *formulation)
{
  (void)formulation;
  return sizeof(Promised);
}

const FormulationType formulation_promised = {
    .name = "promised",
    .about = "bonds are springs",
    .source = "tests/promise",
    .maturity = "experimental",
    .components = 6,
    .keeps_no_points = true,
    .section = &section,
    .create = create,
    .destroy = free,
    .phases = {{.reads = OF_DISPLACEMENTS, .writes = OF_FORCES, .of_neighbours = OF_DISPLACEMENTS, .run = resist}},
    .linearise = linearise,
    .half_state = half_state,
    .point_count = point_count,
    .point = point,
    .gradient = gradient,
    .stored_energy = stored_energy,
    .bond_energy = bond_energy,
    .stress = stress,
    .former_bonds = former_bonds,
    .bytes = bytes,
};
