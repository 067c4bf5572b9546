/* Bond-based peridynamics (Silling 2000; docs/theory.md 2): every bond is a fibre with a uniaxial law of its own.
 *
 * With y = xi + eta and the stretch s = (|y| - |xi|) / |xi|, the force on a particle per volume is sum c w s y / |y|, where
 * w = omega beta V_j and c follows from Young's modulus. */
#include "formulation/bond_based.h"

#include "base/memory.h"
#include "base/tensor.h"
#include "formulation/interface.h"
#include "formulation/shape_tensor.h"

#include <stdlib.h>
#include <string.h>

typedef struct BondBasedSpec {
  SectionHead head;
  int calibration, surface_correction, strength_of; /* indices of their words */
} BondBasedSpec;

enum { SURFACE_AS_IS, SURFACE_BY_ENERGY };
enum { STRENGTH_OF_BODY, STRENGTH_OF_BONDS };

static const Field bond_based_fields[] = {
    {.key = "calibration",
     .kind = FIELD_CHOICE,
     .offset = offsetof(BondBasedSpec, calibration),
     .standard = "uniform-expansion",
     .meaning =
         "which field shall have the energy of the continuum on this lattice, or whether the continuum's integrals are "
         "taken",
     .words = (const char *const[]){[CALIBRATION_CONTINUUM] = "continuum",
                                    [CALIBRATION_EXPANSION] = "uniform-expansion",
                                    [CALIBRATION_UNIAXIAL] = "uniaxial",
                                    NULL}},
    {.key = "surface correction",
     .kind = FIELD_CHOICE,
     .offset = offsetof(BondBasedSpec, surface_correction),
     .standard = "none",
     .meaning = "stiffens bonds of particles near surfaces, whose families are not whole, such that stretching along "
                "each axis costs them as much energy as inside",
     .words = (const char *const[]){[SURFACE_AS_IS] = "none", [SURFACE_BY_ENERGY] = "energy", NULL}},
    {.key = "strength of",
     .kind = FIELD_CHOICE,
     .offset = offsetof(BondBasedSpec, strength_of),
     .standard = "body",
     .meaning = "owner of the tensile strength of laws that soften. `body`: the body carries the strength under "
                "uniaxial tension in its strongest direction, and bonds carry less. `bonds`: each bond carries the "
                "strength, as published, and a body carries 1.1 to 2 times as much; always so for laws without a "
                "fracture energy, bars and lines",
     .words = (const char *const[]){[STRENGTH_OF_BODY] = "body", [STRENGTH_OF_BONDS] = "bonds", NULL}},
};
static const Section bond_based_section = {.name = "bond-based",
                                           .about = "Keys of `peridynamics` with `formulation: bond-based`.",
                                           .size = sizeof(BondBasedSpec),
                                           FIELDS(bond_based_fields)};

static void destroy(void *formulation)
{
  BondBased *b = formulation;
  if (!b) return;
  free(b->stiffness);
  free(b->per_stress);
  free(b->rows);
  places_free(&b->numbers);
  places_free(&b->shown);
  free(b->by_length);
  free(b->range);
  free(b->surface);
  free(b->surfaces);
  free(b->gaps);
  free(b->around);
  free(b->confining);
  places_free(&b->pull);
  places_free(&b->tension);
  places_free(&b->slope);
  free(b);
}

const Material *bond_material(const BondBased *b, int block)
{
  int64_t slice = 0;
  while (b->particles->block[slice] != block) ++slice;
  return &b->materials[b->material[slice]];
}

static void *create(const FormulationParts *parts, Error *error)
{
  BondBased *b = memory_plain(1, sizeof *b);
  if (!b) {
    error_add(error, BRECCIA_FAILURE, "out of memory: bond-based");
    return NULL;
  }
  *b = (BondBased){.particles = parts->particles,
                   .family = parts->family,
                   .body = parts->body,
                   .points = parts->points,
                   .bonds = parts->bonds,
                   .materials = parts->materials,
                   .material = parts->material,
                   .foreign = parts->foreign,
                   .may_break = parts->may_break,
                   .space = parts->space,
                   .influence = parts->influence};
  static const BondBasedSpec standard = {
      .calibration = CALIBRATION_EXPANSION, .surface_correction = SURFACE_AS_IS, .strength_of = STRENGTH_OF_BODY};
  const BondBasedSpec *spec = parts->keys ? parts->keys : &standard;
  b->surface_corrected = spec->surface_correction == SURFACE_BY_ENERGY;
  b->strength_of_body = spec->strength_of == STRENGTH_OF_BODY;
  const Family *f = b->family;
  b->stiffness = memory_zeroed((size_t)b->body->block_count, sizeof(double), "bond constants", error);
  b->range = memory_zeroed((size_t)b->particles->slices, 1, "bond constants", error);
  b->gaps = memory_zeroed((size_t)b->particles->slices, 1, "bond constants", error);
  b->per_stress = memory_zeroed((size_t)b->body->block_count, sizeof(double), "bond constants", error);
  if (!b->stiffness || !b->per_stress || !b->range || !b->gaps || bond_springs_create(b, error)) {
    destroy(b);
    return NULL;
  }
  for (int64_t slice = 0; slice < b->particles->slices; ++slice) bond_note_gaps(b, slice);
  for (int block = 0; block < b->body->block_count; ++block) {
    if (block_is_foreign(b->foreign, b->particles, block)) continue;
    double factor = bond_calibration(b, block, (Calibration)spec->calibration) * bond_continuum_constant(b, 1);
    if (!(factor > 0) || !isfinite(factor)) {
      if (!b->body->lattices[block].chunks)
        error_add(
            error, BRECCIA_USER_ERROR,
            "block '%s': particles from a file are calibrated over those whose neighbours fill the horizon of %g; "
            "there "
            "are none, or their bonds do not resist every strain; give another horizon, or 'calibration: continuum'",
            b->body->blocks[block]->head.name, b->family->horizon);
      else
        error_add(error, BRECCIA_USER_ERROR,
                  "block '%s': the bonds within the horizon of %g do not resist every strain, so that there is no "
                  "stiffness to calibrate; give a longer horizon, or 'calibration: continuum'",
                  b->body->blocks[block]->head.name, b->family->horizon);
      destroy(b);
      return NULL;
    }
    b->per_stress[block] = factor;
    b->stiffness[block] = factor * material_young(bond_material(b, block));
  }
  if ((spec->surface_correction == SURFACE_BY_ENERGY && bond_correct_surface(b, error)) ||
      bond_correct_interfaces(b, parts, error) || bond_lateral_create(b, error) || bond_confinement_create(b, error)) {
    destroy(b);
    return NULL;
  }
  if ((f->stored_slots && !b->bonds && !(b->by_length = stretch_lengths(f, error))) ||
      (f->stored_slots && !(b->shown = places_array(BOND_SHOWN * b->particles->places, "bond constants", error))) ||
      (b->bonds && !(b->pull = places_array(b->bonds->count, "pulls of bonds", error)))) {
    destroy(b);
    return NULL;
  }
  return b;
}

/* ---- single bonds and places ---- */

/** Both ends give a bond half of its force. */
static void half_state(const void *formulation, double *const *u, double *const *at, int64_t slice, int64_t slot,
                       int lane, double state[3])
{
  const BondBased *b = formulation;
  const Bond bond = family_bond(b->family, slice, slot, lane);
  const double factor = bond_own_share(b, &bond) * bond.weight / b->particles->volume[bond.neighbour];
  double y[3];
  if (at) {
    bond_change(b, u, at, slice, slot, lane, &bond, y);
  } else {
    const double pull = bond_pull(b, u, slice, slot, lane, &bond, y);
    for (int k = 0; k < 3; ++k) y[k] *= pull;
  }
  for (int k = 0; k < 3; ++k) state[k] = factor * y[k];
}

/** Returns the elastic strain of a bond whose force follows from laws of points [-]. If the bond joins two materials,
 *  the result is the mean of the elastic strains of both laws, weighted by the tension that each law carries, because
 *  one law may have torn before the other. */
static double bond_elastic_strain(const BondBased *b, int64_t slice, int64_t slot, int lane, const Bond *bond,
                                  double stretch)
{
  const int64_t other = bond->neighbour / SLICE;
  const int32_t *block = b->particles->block;
  const double share = bond_share(b, slice, other), lateral = bond_lateral(b, slice * SLICE + lane, bond);
  const double constant[] = {share * b->per_stress[block[slice]], (1 - share) * b->per_stress[block[other]]};
  int64_t rows[2];
  bond_list_rows(b->bonds, b->family, slice, slot, lane, rows);
  if (rows[0] == rows[1]) return points_elastic_strain(b->points, rows[0], stretch, lateral, 0);
  double tension = 0, sum = 0;
  for (int end = 0; end < 2; ++end) {
    if (!(constant[end] > 0)) continue;
    const double own = constant[end] * points_try(b->points, rows[end], stretch, lateral, NULL);
    tension += own;
    sum += own * points_elastic_strain(b->points, rows[end], stretch, lateral, 0);
  }
  return tension != 0 ? sum / tension : 0;
}

static void bond_energy(const void *formulation, int64_t slice, int64_t slot, int lane, double time,
                        StoredEnergy *energy)
{
  const BondBased *b = formulation;
  const Particles *p = b->particles;
  const int64_t place = slice * SLICE + lane;
  const Bond bond = family_bond(b->family, slice, slot, lane);
  double y[3], square = 0, along = 0;
  const double pull = bond_pull(b, p->displacement.row, slice, slot, lane, &bond, y) * bond.weight * p->volume[place];
  for (int k = 0; k < 3; ++k) {
    square += y[k] * y[k];
    along += y[k] * time * (p->velocity.row[k][bond.neighbour] - p->velocity.row[k][place]);
  }
  const double length = sqrt(square), stretch = (length - bond.length) / bond.length;
  const double elastic =
      b->bonds ? bond.length * bond_elastic_strain(b, slice, slot, lane, &bond, stretch) : length - bond.length;
  const double stored = 0.5 * pull * length * elastic;
  *energy = (StoredEnergy){.stored = stored, .received = stored - 0.5 * pull * along};
}

/** Half of what the bonds of a place store; the other half is that of their other ends. */
static void stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy)
{
  const BondBased *b = formulation;
  const Family *f = b->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  *energy = (StoredEnergy){0};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    StoredEnergy bond;
    bond_energy(formulation, slice, slot, lane, time, &bond);
    const Bond held = family_bond(f, slice, slot, lane);
    energy->stored += bond_own_share(b, &held) * bond.stored;
    energy->received += bond_own_share(b, &held) * bond.received;
  }
}

/** Where bonds leave no stress across a plane, Poisson's ratio is 1/3 (docs/theory.md 2): E_zz = -(E_xx + E_yy) / 2, down to a
 *  thickness of nothing; both sides without the free strain. */
static double thickness_ratio(const double f[9], double freely)
{
  const double sum = (f[0] * f[0] + f[3] * f[3] + f[1] * f[1] + f[4] * f[4]) / 2 - 1; /* E_xx + E_yy */
  return sqrt(fmax(0, 1 - sum + 4 * freely));
}

static void gradient(const void *formulation, int64_t place, double f[9])
{
  const BondBased *b = formulation;
  ShapeTensor shape = shape_tensor(b->family, (int32_t)place, b->body->dimensions, 0);
  shape_gradient(b->family, b->particles->displacement.row, (int32_t)place, shape.inverse, f);
  if (b->space == SPACE_PLANE_STRESS)
    f[8] = thickness_ratio(f, b->particles->free_strain ? b->particles->free_strain[place] : 0);
}

/** Half of the sum of force (x) y over the bonds. In plane strain each bond of the plane stands for a fan of bonds that slant through the
 *  thickness, which press across the plane with a quarter of what they carry along it (docs/theory.md 2). */
void bond_stress(const void *formulation, int64_t place, double s[6])
{
  const BondBased *b = formulation;
  const Family *f = b->family;
  int64_t slice = place / SLICE;
  int lane = (int)(place % SLICE);
  for (int k = 0; k < 6; ++k) s[k] = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    Bond bond = family_bond(f, slice, slot, lane);
    double y[3], pull = bond_pull(b, b->particles->displacement.row, slice, slot, lane, &bond, y) *
                        bond_own_share(b, &bond) * bond.weight;
    for (int k = 0; k < 6; ++k) s[k] += pull * y[symmetric_row[k]] * y[symmetric_column[k]];
  }
  if (b->space == SPACE_PLANE_STRAIN) s[ZZ] = (s[XX] + s[YY]) / 4;
}

static int64_t show_displacements(void *formulation, const Sweep *sweep)
{
  const BondBased *b = formulation;
  const Particles *p = b->particles;
  const double *constant = b->bonds ? b->per_stress : b->stiffness;
  for (int64_t place = sweep->first * SLICE; b->shown && !sweep->linearised_at && place < sweep->last * SLICE;
       ++place) {
    double *shown = b->shown + BOND_SHOWN * place;
    for (int k = 0; k < 3; ++k) {
      shown[k] = p->position[k][place];
      shown[4 + k] = sweep->displacement[k][place];
    }
    shown[3] = p->volume[place];
    shown[7] = constant[p->block[place / SLICE]] / 2;
  }
  return -1;
}

static void renew(void *formulation, int64_t slice)
{
  bond_note_gaps(formulation, slice);
  bond_lateral_renew(formulation, slice);
}

static int64_t resist(void *formulation, const Sweep *sweep)
{
  const BondBased *b = formulation;
  if (sweep->linearised_at)
    bond_resist_changes(b, sweep);
  else if (b->bonds)
    b->point_sweeps->resist(b, sweep);
  else
    b->resist_springs(b, sweep);
  return -1;
}

/** Returns true if a law reads the pressure across bonds: tangents of bonds lack its derivative by family strains. */
static bool takes_secants(const void *formulation)
{
  return ((const BondBased *)formulation)->around != NULL;
}

static bool strength_of_body(const void *formulation)
{
  return ((const BondBased *)formulation)->strength_of_body;
}

static bool shifts_interface(const void *formulation, const Material *one, const Material *other)
{
  return ((const BondBased *)formulation)->may_break || !interfaces_join(one, other);
}

static FormerBonds former_bonds(const void *formulation)
{
  const BondBased *b = formulation;
  return (FormerBonds){.share = 1, .alike = !b->surface};
}

static size_t bytes(const void *formulation)
{
  const BondBased *b = formulation;
  return 2 * (size_t)b->particles->slices + (b->surface ? (size_t)b->particles->slices * sizeof *b->surface : 0) +
         b->surface_count * sizeof *b->surfaces +
         (b->bonds ? sizeof(double) * (size_t)b->bonds->count * (b->tension ? 3 : 1) : 0) +
         (b->shown ? BOND_SHOWN * sizeof(double) * (size_t)b->particles->places : 0) + bond_lateral_bytes(b) +
         bond_confinement_bytes(b) +
         (b->by_length ? (size_t)b->family->stored_slots * SLICE * sizeof *b->by_length : 0);
}

const FormulationType formulation_bond_based = {
    .name = "bond-based",
    .about = "every bond is a fibre with a uniaxial law of its own; Poisson's ratio is 1/4 (1/3 in plane stress)",
    .source = "Silling 2000; Silling and Askari 2005",
    .maturity = "verified against closed forms on lattices",
    .components = 1,
    .on_bonds = true,
    .fixed_poisson = true,
    .section = &bond_based_section,
    .create = create,
    .destroy = destroy,
    .renew = renew,
    .phases = {{.run = show_displacements, .reads = OF_DISPLACEMENTS, .writes = OF_SHOWN},
               {.run = bond_lateral_strains,
                .reads = OF_DISPLACEMENTS,
                .writes = OF_SHOWN,
                .of_neighbours = OF_DISPLACEMENTS},
               {.run = bond_stretch,
                .reads = OF_DISPLACEMENTS,
                .writes = OF_STRAINS,
                .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN},
               {.run = bond_pull_of_stress, .reads = OF_STRESSES, .writes = OF_STATES},
               {.run = resist,
                .reads = OF_DISPLACEMENTS,
                .writes = OF_FORCES,
                .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN,
                .of_lower = OF_STATES}},
    .linearise = bond_linearise,
    .half_state = half_state,
    .point_count = bond_point_count,
    .point = bond_point,
    .stored_energy = stored_energy,
    .bond_energy = bond_energy,
    .energy_room = bond_energy_room,
    .gradient = gradient,
    .stress = bond_stress,
    .characteristic_length = bond_characteristic_length,
    .crack_length = bond_crack_length,
    .uniaxial_strength = bond_uniaxial_strength,
    .uniaxial_crushing = bond_uniaxial_crushing,
    .strength_of_body = strength_of_body,
    .critical_stretch = bond_critical_stretch,
    .shown_young = bond_shown_young,
    .shifts_interface = shifts_interface,
    .describe = bond_describe,
    .former_bonds = former_bonds,
    .takes_secants = takes_secants,
    .state = bond_confinement_state,
    .commit = bond_confinement_commit,
    .bytes = bytes,
};
