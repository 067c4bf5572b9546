/* Micropolar peridynamics (Gerstle, Sau and Silling 2007; Rahman 2012; Tuniki 2012; docs/theory.md 6): particles have rotations, and bonds are links
 * that resist stretch, shear and bending like beams between them, so that Poisson's ratio is free up to a limit. */
#include "formulation/micropolar.h"

#include "base/memory.h"
#include "base/tensor.h"
#include "formulation/shape_tensor.h"

#include <stdlib.h>
#include <string.h>

typedef struct MicropolarSpec {
  SectionHead head;
  int kinematics; /* index of its word */
  double torsion;
} MicropolarSpec;

enum { KINEMATICS_COROTATIONAL, KINEMATICS_OF_THESIS };

static const Field micropolar_fields[] = {
    {.key = "kinematics",
     .kind = FIELD_CHOICE,
     .offset = offsetof(MicropolarSpec, kinematics),
     .standard = "corotational",
     .meaning = "corotational: links turn with their ends, at any rotation; thesis: the stiffness along the present "
                "direction times all of the displacements and rotations, as in Tuniki 2012, in the plane only: it "
                "resists rigid rotation and is there to compare with",
     .words =
         (const char *const[]){[KINEMATICS_COROTATIONAL] = "corotational", [KINEMATICS_OF_THESIS] = "thesis", NULL}},
    {.key = "torsion",
     .kind = FIELD_NUMBER,
     .offset = offsetof(MicropolarSpec, torsion),
     .dimension = "1",
     .standard = "1",
     .range = "[0, 10]",
     .meaning = "torsional stiffness of links in space, over that of round beams; elasticity does not say it"},
};
static const Section micropolar_section = {.name = "micropolar",
                                           .about = "Keys of `peridynamics` with `formulation: micropolar`.",
                                           .size = sizeof(MicropolarSpec),
                                           FIELDS(micropolar_fields)};

static bool takes(const breccia_law *law)
{
  return law->linear || law->link;
}

static int check(const void *keys, const Body *body, const DeckReader *reader)
{
  const MicropolarSpec *spec = keys;
  if (body->dimensions == 1)
    return node_error(reader->document, section_node(keys, "formulation"), reader->error,
                      "formulation: micropolar has no shear along a line; bars take bond-based");
  if (body->dimensions == 3 && spec->kinematics == KINEMATICS_OF_THESIS)
    return node_error(reader->document, section_node(keys, "kinematics"), reader->error,
                      "kinematics: thesis is of plane bodies; leave it out");
  return BRECCIA_OK;
}

static void destroy(void *formulation)
{
  Micropolar *m = formulation;
  if (!m) return;
  for (int k = 0; k < 4; ++k) places_free(&m->shown[k]);
  places_free(&m->record);
  places_free(&m->turns);
  for (int k = 0; k < 3; ++k) places_free(&m->spin[k]);
  micropolar_damage_destroy(m);
  free(m->constants);
  free(m->rows);
  free(m);
}

/** Links of the lattice of a block. */
static void fill_rows(Micropolar *m, int block)
{
  int64_t slice = 0;
  while (m->particles->block[slice] != block) ++slice;
  for (int k = m->family->pattern_begin[block]; k < m->family->pattern_begin[block + 1]; ++k) {
    const Pattern *p = &m->family->patterns[k];
    const Bond bond = {.neighbour = (int32_t)(slice * SLICE), .length = p->length};
    const LinkStiffness stiffness = micropolar_stiffness(m, slice * SLICE, &bond);
    LinkRow *row = &m->rows[k];
    for (int c = 0; c < 3; ++c) {
      row->xi[c] = p->xi[c];
      row->n[c] = p->xi[c] / p->length;
    }
    row->by_length = 1 / p->length;
    row->axial = stiffness.axial * p->weight;
    row->bending = stiffness.bending * p->weight / p->length;
    row->twist = stiffness.twist * p->weight / p->length;
  }
}

/** Makes what stored links read of places. */
static int create_records(Micropolar *m, Error *error)
{
  const Particles *p = m->particles;
  if (!m->family->stored_slots) return BRECCIA_OK;
  m->record = places_array(LINK_RECORD * p->places, "links", error);
  m->turns = places_array(QUAD * p->places, "links", error);
  if (!m->record || !m->turns) return BRECCIA_FAILURE;
  for (int64_t place = 0; place < p->places; ++place)
    for (int k = 0; k < 4; ++k) m->record[LINK_RECORD * place + k] = k < 3 ? p->position[k][place] : p->volume[place];
  return BRECCIA_OK;
}

static void *create(const FormulationParts *parts, Error *error)
{
  static const MicropolarSpec standard = {.kinematics = KINEMATICS_COROTATIONAL, .torsion = 1};
  const MicropolarSpec *spec = parts->keys ? parts->keys : &standard;
  Micropolar *m = memory_zeroed(1, sizeof *m, "micropolar", error);
  if (!m) return NULL;
  *m = (Micropolar){.particles = parts->particles,
                    .family = parts->family,
                    .body = parts->body,
                    .materials = parts->materials,
                    .material = parts->material,
                    .points = parts->points,
                    .foreign = parts->foreign,
                    .space = parts->space,
                    .influence = parts->influence,
                    .secant = spec->kinematics == KINEMATICS_OF_THESIS,
                    .torsion = spec->torsion,
                    .sweeps = parts->space == SPACE_3D ? micropolar_space_chosen() : micropolar_plane_chosen()};
  const int blocks = m->body->block_count;
  m->constants = memory_zeroed((size_t)blocks, sizeof *m->constants, "links", error);
  m->rows = memory_zeroed((size_t)m->family->pattern_count, sizeof *m->rows, "links", error);
  int failed = !m->constants || !m->rows;
  for (int k = 0; k < (parts->space == SPACE_3D ? 4 : 2); ++k)
    failed |= !(m->shown[k] = places_array(m->particles->places, "rotations", error));
  if (!failed) failed = create_records(m, error);
  if (!failed && m->secant && m->foreign)
    failed = error_add(error, BRECCIA_USER_ERROR,
                       "kinematics: links of 'thesis' cannot stand beside other formulations; leave 'kinematics' out");
  for (int k = 0; k < 3 && parts->space == SPACE_3D; ++k)
    failed |= !(m->spin[k] = places_array(m->particles->places, "rotations", error));
  for (int block = 0; block < blocks && !failed; ++block)
    if (!block_is_foreign(m->foreign, m->particles, block)) failed = micropolar_find_constants(m, block, error);
  for (int block = 0; block < blocks && !failed; ++block)
    if (!block_is_foreign(m->foreign, m->particles, block)) fill_rows(m, block);
  if (!failed) failed = micropolar_damage_create(m, error);
  if (!failed) return m;
  destroy(m);
  return NULL;
}

static double gyration(const void *formulation, int64_t place)
{
  const Micropolar *m = formulation;
  return m->constants[m->particles->block[place / SLICE]].gyration;
}

/* ---- sweeps ---- */

static int64_t show_displacements(void *formulation, const Sweep *sweep)
{
  const Micropolar *m = formulation;
  double *const *u = sweep->linearised_at ? sweep->linearised_at : sweep->displacement;
  m->sweeps->show(m, u, sweep->first, sweep->last);
  if (sweep->linearised_at && m->sweeps->show_spins) m->sweeps->show_spins(m, sweep);
  return -1;
}

static int64_t find_damage(void *formulation, const Sweep *sweep)
{
  const Micropolar *m = formulation;
  if (m->damage && !sweep->linearised_at && !m->points->clock->elastic_stage) m->damage->sweeps->find_tension(m, sweep);
  return -1;
}

static int64_t resist(void *formulation, const Sweep *sweep)
{
  const Micropolar *m = formulation;
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice) {
    if (sweep->linearised_at) {
      if (!m->secant) m->sweeps->resist_changes(m, sweep, slice);
      if (m->secant || m->foreign) micropolar_resist_changes_one_by_one(m, sweep, slice, !m->secant);
      continue;
    }
    if (micropolar_is_weak(m, slice)) m->damage->sweeps->find_compression(m, sweep->displacement, slice);
    if (!m->secant) m->sweeps->resist(m, sweep, slice);
    if (m->secant || m->foreign) micropolar_resist_one_by_one(m, sweep, slice, !m->secant);
  }
  return -1;
}

/** Links change by what is held and nothing else; those that are damaged by what is left of them. */
static int linearise(void *formulation, double *const *displacement, Error *error)
{
  (void)formulation, (void)displacement, (void)error;
  return BRECCIA_OK;
}

/* ---- single bonds and places ---- */

/** Share of a link that its own end gives: foreign ends give the other half by their own formulation. */
static double own_share(const Link *link)
{
  return link->alone ? 1 : 0.5;
}

static void half_state(const void *formulation, double *const *u, double *const *at, int64_t slice, int64_t slot,
                       int lane, double state[3])
{
  const Micropolar *m = formulation;
  const Link l = micropolar_link(m, at ? at : u, slice, slot, lane);
  const double *force = l.force;
  LinkChange change;
  if (at) {
    const LinkMotion motion = micropolar_motion(m, u, at, slice * SLICE + lane, l.bond.neighbour);
    change = micropolar_change(m, at, slice * SLICE + lane, &l, &motion);
    force = change.force;
  }
  for (int k = 0; k < 3; ++k)
    state[k] = own_share(&l) * force[k] * l.bond.weight / m->particles->volume[l.bond.neighbour];
}

static void bond_energy(const void *formulation, int64_t slice, int64_t slot, int lane, double time,
                        StoredEnergy *energy)
{
  const Micropolar *m = formulation;
  const Particles *p = m->particles;
  const int64_t place = slice * SLICE + lane;
  const Link l = micropolar_link(m, p->displacement.row, slice, slot, lane);
  const double weight = l.bond.weight * p->volume[place];
  double power = 0; /* that the link takes */
  for (int k = 0; k < 3; ++k) power += l.force[k] * (p->velocity.row[k][l.bond.neighbour] - p->velocity.row[k][place]);
  for (int k = p->space.rotation; k < p->space.rows; ++k) {
    const int axis = p->space.row[k].axis;
    power -= l.moment[0][axis] * p->velocity.row[k][place] + l.moment[1][axis] * p->velocity.row[k][l.bond.neighbour];
  }
  *energy = (StoredEnergy){.stored = weight * l.energy, .received = weight * (l.energy - 0.5 * time * power)};
}

static bool takes_secants(const void *formulation)
{
  const Micropolar *m = formulation;
  return m->damage != NULL;
}

/** Half of what the links of a place store; the other half is that of their other ends. */
static void stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy)
{
  const Micropolar *m = formulation;
  const Family *f = m->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  *energy = (StoredEnergy){0};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    StoredEnergy bond;
    bond_energy(formulation, slice, slot, lane, time, &bond);
    const double share = is_foreign(m->foreign, family_bond(f, slice, slot, lane).neighbour) ? 1 : 0.5;
    energy->stored += share * bond.stored;
    energy->received += share * bond.received;
  }
}

static void show_held(const void *formulation, int64_t slice)
{
  const Micropolar *m = formulation;
  m->sweeps->show(m, m->particles->displacement.row, slice, slice + 1);
}

static void stored_energies(const void *formulation, int64_t slice, double energies[SLICE])
{
  const Micropolar *m = formulation;
  const Family *f = m->family;
  if (!m->secant) m->sweeps->store(m, slice, energies);
  for (int lane = 0; lane < SLICE && m->secant; ++lane) {
    StoredEnergy energy;
    stored_energy(formulation, slice * SLICE + lane, 0, &energy);
    energies[lane] = energy.stored;
  }
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1] && m->foreign && !m->secant; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      StoredEnergy bond;
      if (!(f->intact[slot] >> lane & 1)) continue;
      if (!is_foreign(m->foreign, family_bond(f, slice, slot, lane).neighbour)) continue;
      bond_energy(formulation, slice, slot, lane, 0, &bond);
      energies[lane] += bond.stored;
    }
}

static double poisson_of(const Micropolar *m, int64_t place)
{
  return material_poisson(&m->materials[m->material[place / SLICE]]);
}

static const char *strain_free(const void *formulation)
{
  const Micropolar *m = formulation;
  return m->secant ? "links of 'kinematics: thesis' take none; leave 'kinematics' out" : NULL;
}

static void gradient(const void *formulation, int64_t place, double f[9])
{
  const Micropolar *m = formulation;
  const ShapeTensor shape = shape_tensor(m->family, (int32_t)place, m->body->dimensions, 0);
  shape_gradient(m->family, m->particles->displacement.row, (int32_t)place, shape.inverse, f);
  if (m->space != SPACE_PLANE_STRESS) return;
  const double nu = poisson_of(m, place),
               sum = (f[0] * f[0] + f[3] * f[3] + f[1] * f[1] + f[4] * f[4]) / 2 - 1; /* E_xx + E_yy */
  const double freely = m->particles->free_strain ? m->particles->free_strain[place] : 0;
  f[8] = sqrt(fmax(0, 1 - 2 * nu / (1 - nu) * (sum - 2 * freely) + 2 * freely));
}

/** The symmetric part of half the sum of force (x) y over the links. */
static void stress(const void *formulation, int64_t place, double s[6])
{
  const Micropolar *m = formulation;
  const Family *f = m->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  for (int k = 0; k < 6; ++k) s[k] = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Link l = micropolar_link(m, m->particles->displacement.row, slice, slot, lane);
    for (int k = 0; k < 6; ++k)
      s[k] +=
          l.bond.weight / 4 *
          (l.force[symmetric_row[k]] * l.y[symmetric_column[k]] + l.force[symmetric_column[k]] * l.y[symmetric_row[k]]);
  }
  if (m->space == SPACE_PLANE_STRAIN) s[ZZ] = poisson_of(m, place) * (s[XX] + s[YY]);
}

/** Links find from a fracture energy themselves where they end. */
static double characteristic_length(const BondLength *of)
{
  (void)of;
  return INFINITY;
}

static FormerBonds former_bonds(const void *formulation)
{
  (void)formulation;
  return (FormerBonds){.share = 1, .alike = true};
}

static size_t bytes(const void *formulation)
{
  const Micropolar *m = formulation;
  size_t arrays = 0;
  for (int k = 0; k < 4; ++k) arrays += m->shown[k] != NULL;
  for (int k = 0; k < 3; ++k) arrays += m->spin[k] != NULL;
  if (m->record) arrays += LINK_RECORD + QUAD;
  return arrays * sizeof(double) * (size_t)m->particles->places + (size_t)m->family->pattern_count * sizeof *m->rows +
         micropolar_damage_bytes(m);
}

const FormulationType formulation_micropolar = {
    .name = "micropolar",
    .about =
        "particles have rotations, and bonds are links that stretch, bend and twist like beams; Poisson's ratio up "
        "to 1/4 (1/3 in plane stress)",
    .source = "Gerstle, Sau and Silling 2007; Rahman 2012; Tuniki 2012",
    .maturity = "verified against closed forms",
    .components = 6,
    .horizon = 1.5,
    .keeps_no_points = true,
    .takes = takes,
    .section = &micropolar_section,
    .check = check,
    .create = create,
    .destroy = destroy,
    .gyration = gyration,
    .phases = {{.run = show_displacements, .reads = OF_DISPLACEMENTS, .writes = OF_SHOWN},
               {.run = find_damage,
                .reads = OF_DISPLACEMENTS,
                .writes = OF_STATES,
                .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN},
               {.run = resist,
                .reads = OF_DISPLACEMENTS | OF_SHOWN | OF_STATES,
                .writes = OF_FORCES,
                .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN | OF_STATES}},
    .linearise = linearise,
    .takes_secants = takes_secants,
    .state = micropolar_state,
    .commit = micropolar_commit,
    .history = micropolar_history,
    .bond_damage = micropolar_link_damage,
    .characteristic_length = characteristic_length,
    .crack_length = micropolar_crack_length,
    .half_state = half_state,
    .point_count = micropolar_point_count,
    .point = micropolar_point,
    .stored_energy = stored_energy,
    .stored_energies = stored_energies,
    .show_held = show_held,
    .bond_energy = bond_energy,
    .gradient = gradient,
    .stress = stress,
    .strain_free = strain_free,
    .describe = micropolar_describe,
    .former_bonds = former_bonds,
    .bytes = bytes,
};
