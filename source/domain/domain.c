#include "domain/domain.h"

#include "base/tensor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Laws take one strain or six; formulations offer one or the other. */
static int check_law(const Domain *d, const DeckReader *reader, const MaterialSpec *spec, const breccia_law *made)
{
  const LawList *laws = reader->context;
  const breccia_law *law = spec->model ? law_find(laws, spec->model) : made;
  if (law->uniaxial == d->type->uniaxial) return BRECCIA_OK;
  Text words = {0};
  for (int k = 0; law_at(laws, k); ++k)
    if (law_at(laws, k)->uniaxial == d->type->uniaxial)
      text_add(&words, "%s%s", words.length ? ", " : "", law_at(laws, k)->name);
  node_error(reader->document,
             section_place(spec, spec->model      ? "model"
                                 : spec->opensees ? "opensees"
                                                  : "remote"),
             reader->error, "material '%s': '%s' is a law of %s; %s takes %s", spec->head.name,
             spec->model ? law->name : law->source, law->uniaxial ? "one strain" : "strain in space", d->type->name,
             words.characters);
  text_free(&words);
  return BRECCIA_USER_ERROR;
}

/** @param[in] length  over which laws spread a fracture energy, or NaN */
static int create_materials(Domain *d, const DeckReader *reader, const DomainSpec *spec, double length)
{
  d->materials = memory_zeroed((size_t)spec->materials->count, sizeof(Material), "materials", reader->error);
  if (!d->materials) return BRECCIA_FAILURE;
  int status = BRECCIA_OK;
  for (int k = 0; k < spec->materials->count; ++k) {
    const MaterialSpec *material = spec->materials->items[k];
    Material *new = &d->materials[d->material_count];
    int bad =
        material->model ? check_law(d, reader, material, NULL) : 0; /* what its parameters lack may follow from that */
    if (!bad) {
      ++d->material_count;
      bad = material_create(new, reader, material, length);
    }
    if (!bad && new->remote) bad = check_law(d, reader, material, new->law);
    if (bad) status = bad;
  }
  for (int b = 0; b < spec->blocks->count; ++b) {
    const BlockSpec *block = spec->blocks->items[b];
    if (section_find(spec->materials, block->material)) continue;
    section_unknown(reader, section_place(block, "material"), "material", block->material, spec->materials);
    status = BRECCIA_USER_ERROR;
  }
  return status;
}

static int check_space(const Domain *d, const DeckReader *reader, const DomainSpec *spec)
{
  Space space = peridynamics_space(spec->peridynamics);
  if (d->type->uniaxial && spec->peridynamics->control)
    return node_error(reader->document, section_place(spec->peridynamics, "zero-energy control"), reader->error,
                      "zero-energy control: is for correspondence; %s has no modes without energy: leave it out",
                      d->type->name);
  if (!d->type->uniaxial && strcmp(spec->peridynamics->surface_correction, "none"))
    return node_error(reader->document, section_place(spec->peridynamics, "surface correction"), reader->error,
                      "surface correction: is for bond-based peridynamics; the strains of %s are exact at surfaces",
                      d->type->name);
  if (d->body.dimensions == 1 && !d->type->uniaxial)
    return node_error(reader->document, section_place(spec->peridynamics, "formulation"), reader->error,
                      "formulation: %s has no strain along a line; bars take bond-based", d->type->name);
  if (d->body.dimensions == (space == SPACE_3D ? 3 : space == SPACE_BAR ? 1 : 2)) return BRECCIA_OK;
  return node_error(reader->document, section_place(spec->peridynamics, "space"), reader->error,
                    d->body.dimensions == 1   ? "space: a line needs '1-D'"
                    : d->body.dimensions == 2 ? "space: a square lattice needs 'plane strain' or 'plane stress'"
                                              : "space: '%s' needs a square lattice; this body's is cubic",
                    spec->peridynamics->space);
}

/** True if the row of a slice goes on in the slice after it. */
static bool row_goes_on(const Domain *d, int64_t slice)
{
  const Particles *p = d->particles;
  if (slice + 1 >= p->slices || p->block[slice + 1] != p->block[slice]) return false;
  const Lattice *lattice = &d->body.lattices[p->block[slice]];
  if (!lattice->chunks) return false;
  for (int k = 0; k < 3; ++k) {
    double step = p->position[k][(slice + 1) * SLICE] - p->position[k][slice * SLICE];
    if (fabs(step - (k == lattice->axis) * SLICE * lattice->spacing) > 0.5 * lattice->spacing) return false;
  }
  return true;
}

/** Limit of each material: the smallest of what the deck says for all and what its law says. */
static int create_failure(Domain *d, const DeckReader *reader, const FailureSpec *spec, double length)
{
  if (spec && !isnan(spec->critical_stretch) && !isnan(spec->fracture_energy))
    return node_error(reader->document, section_place(spec, "fracture energy"), reader->error,
                      "failure: give 'critical stretch' or 'fracture energy', not both");
  if (spec && !isnan(spec->fracture_energy) && !d->type->uniaxial)
    return node_error(reader->document, section_place(spec, "fracture energy"), reader->error,
                      "fracture energy: only bond-based peridynamics has a critical stretch that follows from it; give "
                      "'critical stretch'");
  d->failure.limit = memory_zeroed((size_t)d->material_count, sizeof(double), "failure", reader->error);
  d->failure.material = d->material;
  if (!d->failure.limit) return BRECCIA_FAILURE;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    double limit = material_failure_strain(m), of_deck = spec ? spec->critical_stretch : NAN;
    if (spec && !isnan(spec->fracture_energy)) of_deck = sqrt(2 * spec->fracture_energy / (material_young(m) * length));
    d->failure.limit[k] = fmin(limit, of_deck); /* of a number and NaN: the number */
    if (isfinite(d->failure.limit[k])) d->failure.criterion = &criterion_critical_stretch;
  }
  return BRECCIA_OK;
}

static bool same_server(const Domain *d, int64_t a, int64_t b)
{
  return !d->points.server || d->points.server[a] == d->points.server[b];
}

/* Blocks end with a row, as far as rows are no longer than a block: sums along rows can then be made while what is summed is still
 * in the cache. */
static int share_out(Domain *d, Error *error)
{
  int64_t slices = d->particles->slices;
  d->blocks = memory_zeroed((size_t)slices, sizeof(Span), "blocks", error);
  if (!d->blocks) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < slices;) {
    int64_t end = s + 1, row_end = row_goes_on(d, s) ? s : end;
    for (; end < slices && end - s < BLOCK / SLICE && d->material[end] == d->material[s] && same_server(d, s, end);
         ++end)
      if (!row_goes_on(d, end)) row_end = end + 1;
    if (row_end > s && same_server(d, s, row_end - 1)) end = row_end;
    d->rows_cut |= row_goes_on(d, end - 1);
    d->blocks[d->block_count++] = (Span){s, end};
    s = end;
  }
  d->block_sum = memory_zeroed((size_t)d->block_count, sizeof(double), "block sums", error);
  d->block_failed = memory_zeroed((size_t)d->block_count, sizeof(int64_t), "block sums", error);
  if (!d->block_sum || !d->block_failed) return BRECCIA_FAILURE;
  for (int64_t b = 0; b < d->block_count; ++b) d->block_failed[b] = -1;
  return BRECCIA_OK;
}

/** Blocks whose laws live in one server, to be sent together. In plane stress each block finds its strain across the plane by itself. */
static int make_parts(Domain *d, Error *error)
{
  const Points *p = &d->points;
  if (!p->server || p->where != POINTS_ON_PARTICLES || p->space == SPACE_PLANE_STRESS) return BRECCIA_OK;
  int most = 0;
  for (int k = 0; k < d->material_count; ++k)
    if (d->materials[k].remote) most += remote_servers(d->materials[k].remote);
  d->parts = memory_zeroed((size_t)most, sizeof(Part), "servers", error);
  d->part_of = memory_zeroed((size_t)d->block_count, sizeof(int32_t), "servers", error);
  d->carry = memory_zeroed((size_t)d->block_count * CARRY * BLOCK, sizeof(double), "servers", error);
  if (!d->parts || !d->part_of || !d->carry) return BRECCIA_FAILURE;
  for (int64_t b = 0; b < d->block_count; ++b) {
    const int64_t slice = d->blocks[b].first;
    d->part_of[b] = -1;
    if (!d->materials[d->material[slice]].remote) continue;
    int k = 0;
    while (k < d->part_count && (d->parts[k].material != d->material[slice] || d->parts[k].server != p->server[slice]))
      ++k;
    if (k == d->part_count) d->parts[d->part_count++] = (Part){d->material[slice], p->server[slice], b, b};
    d->parts[k].last = b + 1;
    d->part_of[b] = k;
  }
  return BRECCIA_OK;
}

static int fill_particles(Domain *d, const DomainSpec *spec, Error *error)
{
  Particles *p = d->particles;
  d->material = memory_zeroed((size_t)p->slices, sizeof(int32_t), "materials of slices", error);
  d->family_volume = memory_zeroed((size_t)p->places, sizeof(double), "family volumes", error);
  d->suspects = memory_zeroed((size_t)p->slices, 1, "suspect slices", error);
  d->look_again = memory_zeroed((size_t)p->slices, sizeof(double), "suspect slices", error);
  if (!d->material || !d->family_volume || !d->suspects || !d->look_again) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < p->slices; ++s) {
    const SectionHead *named = section_find(spec->materials, d->body.blocks[p->block[s]]->material);
    while (strcmp(d->materials[d->material[s]].name, named->name)) ++d->material[s];
    for (int lane = 0; lane < SLICE; ++lane) p->density[s * SLICE + lane] = d->materials[d->material[s]].density;
  }
  return BRECCIA_OK;
}

static int create_contact(Domain *d, const ContactSpec *spec, Error *error)
{
  double *constant = memory_zeroed((size_t)d->body.block_count, sizeof(double), "contact", error);
  if (!constant) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < d->particles->slices; ++s)
    constant[d->particles->block[s]] =
        micromodulus(&d->body, material_young(&d->materials[d->material[s]]), d->family.horizon) / d->family.horizon;
  int status = contact_create(&d->contact, spec, &d->body, &d->family, constant, error);
  free(constant);
  return status;
}

/** Where material points are needed. */
static PointsWhere points_where(const Domain *d)
{
  if (!d->type->uniaxial) return POINTS_ON_PARTICLES;
  for (int k = 0; k < d->material_count; ++k)
    if (!d->materials[k].law->linear) return POINTS_ON_BONDS;
  return POINTS_NOWHERE;
}

int domain_create(Domain *d, const DeckReader *reader, const DomainSpec *spec)
{
  Error *error = reader->error;
  const PeridynamicsSpec *pd = spec->peridynamics;
  const Influence *influence = influence_find(pd->influence);
  const Space space = peridynamics_space(pd);
  d->failed_place = -1;
  d->type = formulation_find(pd->formulation);
  int status = body_create(&d->body, reader, spec->blocks, spec->cracks);
  if (!status) status = check_space(d, reader, spec);
  double horizon = pd->horizon.value * (pd->horizon.in_spacings ? d->body.largest_spacing : 1);
  double length =
      d->type->characteristic_length ? d->type->characteristic_length(&(BondLength){space, influence, horizon}) : NAN;
  int bad = create_materials(d, reader, spec, length);
  if (bad) status = bad;
  if (status) return status;
  d->particles = &d->body.particles;
  if ((status = fill_particles(d, spec, error))) return status;

  if (horizon < d->body.largest_spacing)
    return node_error(reader->document, section_place(pd, "horizon"), error,
                      "horizon: %g is less than the spacing of %g, so that no particle has a neighbour", horizon,
                      d->body.largest_spacing);
  int correction = 0;
  while (strcmp(volume_correction_word(correction), pd->volume_correction)) ++correction;
  const FamilySpec family = {horizon, influence, (VolumeCorrection)correction, d->type->row_sums,
                             d->type->bond_lengths};
  if ((status = family_create(&d->family, &d->body, &family, error))) return status;
#pragma omp parallel for schedule(static)
  for (int32_t place = 0; place < (int32_t)d->particles->places; ++place)
    d->family_volume[place] = family_volume(&d->family, place);

  const PointsSpec points = {.where = points_where(d),
                             .space = space,
                             .family = &d->family,
                             .materials = d->materials,
                             .material_count = d->material_count,
                             .material = d->material,
                             .may_give_up = spec->failure && !strcmp(spec->failure->failed_laws, "break")};
  if ((status = points_create(&d->points, &points, error))) return status;
  if ((status = share_out(d, error)) || (status = make_parts(d, error))) return status;
  FormulationParts parts = {pd, &d->body, d->particles, &d->family, &d->points};
  d->formulation = d->type->create(&parts, error);
  if (!d->formulation) return BRECCIA_USER_ERROR;
  status = create_failure(d, reader, spec->failure, length);
  return status ? status : create_contact(d, spec->contact, error);
}

void domain_destroy(Domain *d)
{
  if (d->formulation) d->type->destroy(d->formulation);
  contact_destroy(&d->contact);
  points_destroy(&d->points);
  family_destroy(&d->family);
  body_destroy(&d->body);
  for (int k = 0; k < d->material_count; ++k) material_destroy(&d->materials[k]);
  free(d->materials);
  free(d->material);
  free(d->blocks);
  free(d->parts);
  free(d->part_of);
  free(d->carry);
  free(d->block_sum);
  free(d->block_failed);
  free(d->family_volume);
  free(d->suspects);
  free(d->look_again);
  free(d->failure.limit);
  free(d->broken);
  *d = (Domain){0};
}

/** Not finite if any force of the block is not. */
BRECCIA_CLONES
static double force_magnitude(const Particles *p, const Span *span)
{
  Lanes sum = {0};
  for (int k = 0; k < 3; ++k)
    for (int64_t place = span->first * SLICE; place < span->last * SLICE; place += LANES)
      sum += lanes_absolute(lanes_load(p->internal[k] + place));
  return lanes_total(sum);
}

/** Stresses of a block, and what its particles show their neighbours. */
static void answer(Domain *d, int64_t block, bool resume)
{
  _Alignas(64) double carry[CARRY * BLOCK];
  Span span = d->blocks[block];
  d->type->deform(d->formulation, span.first, span.last, carry);
  if (!resume) d->block_failed[block] = points_update(&d->points, span.first, span.last, NULL);
  d->type->respond(d->formulation, span.first, span.last, carry);
}

/** The same of all blocks, where some have laws in servers: strains go out part by part, so that servers work while further
 *  parts are deformed. */
static void answer_in_parts(Domain *d)
{
  const FormulationType *type = d->type;
  for (int k = 0; k < d->part_count; ++k) {
    const Part *part = &d->parts[k];
#pragma omp for schedule(static)
    for (int64_t b = part->first; b < part->last; ++b) {
      if (d->part_of[b] != k) continue;
      type->deform(d->formulation, d->blocks[b].first, d->blocks[b].last, d->carry + b * CARRY * BLOCK);
      points_pack(&d->points, d->blocks[b].first, d->blocks[b].last);
    }
#pragma omp single nowait
    points_post(&d->points, part->material, part->server);
  }
#pragma omp for schedule(static)
  for (int64_t b = 0; b < d->block_count; ++b)
    if (d->part_of[b] < 0) answer(d, b, false);
  for (int k = 0; k < d->part_count; ++k) {
    const Part *part = &d->parts[k];
#pragma omp single
    {
      const int64_t failed = points_collect(&d->points, part->material, part->server);
      for (int64_t b = part->first; b < part->last; ++b)
        if (d->part_of[b] == k)
          d->block_failed[b] = failed >= d->blocks[b].first * SLICE && failed < d->blocks[b].last * SLICE ? failed : -1;
    }
#pragma omp for schedule(static)
    for (int64_t b = part->first; b < part->last; ++b) {
      if (d->part_of[b] != k) continue;
      points_unpack(&d->points, d->blocks[b].first, d->blocks[b].last);
      type->respond(d->formulation, d->blocks[b].first, d->blocks[b].last, d->carry + b * CARRY * BLOCK);
    }
  }
}

/** Laws act on bonds, and some live in servers. */
static bool points_on_bonds_elsewhere(const Domain *d)
{
  return d->points.server && d->points.where == POINTS_ON_BONDS;
}

void domain_forces(Domain *d)
{
  const FormulationType *type = d->type;
  if (type->show_displacements) {
#pragma omp for schedule(static)
    for (int64_t b = 0; b < d->block_count; ++b)
      type->show_displacements(d->formulation, d->blocks[b].first, d->blocks[b].last);
  }
  const bool parts = d->part_count && !d->points.elastic_stage && points_begun(&d->points);
  if (type->deform) {
    if (parts) answer_in_parts(d);
#pragma omp for schedule(static)
    for (int64_t b = 0; b < d->block_count; ++b) {
      if (!parts) answer(d, b, false);
      if (type->row_sums && !d->rows_cut) type->sum_states(d->formulation, d->blocks[b].first, d->blocks[b].last);
    }
  }
  if (type->row_sums && d->rows_cut) {
#pragma omp for schedule(static)
    for (int64_t b = 0; b < d->block_count; ++b)
      type->sum_states(d->formulation, d->blocks[b].first, d->blocks[b].last);
  }
  if (points_on_bonds_elsewhere(d)) {
#pragma omp single
    d->gathering = points_gather_bonds(&d->points);
    if (d->gathering) {
#pragma omp for schedule(static)
      for (int64_t b = 0; b < d->block_count; ++b) type->resist(d->formulation, d->blocks[b].first, d->blocks[b].last);
#pragma omp single
      points_ask_bonds(&d->points);
    }
  }
#pragma omp for schedule(static)
  for (int64_t b = 0; b < d->block_count; ++b) {
    int64_t failed = type->resist(d->formulation, d->blocks[b].first, d->blocks[b].last);
    if (!type->deform) d->block_failed[b] = failed;
    d->block_sum[b] = force_magnitude(d->particles, &d->blocks[b]);
  }
  if (type->finish) {
#pragma omp single
    type->finish(d->formulation);
  }
  contact_resist(&d->contact);
#pragma omp single
  {
    d->force_sum = 0;
    d->failed_place = -1;
    for (int64_t b = 0; b < d->block_count; ++b) {
      d->force_sum += d->block_sum[b];
      if (d->failed_place < 0) d->failed_place = d->block_failed[b];
    }
  }
}

void domain_resume(Domain *d)
{
  for (int64_t n = 0; n < d->broken_count; ++n)
    for (int end = 0; end < 2; ++end) {
      int64_t slice = d->particles->place_of[end ? d->broken[n].b : d->broken[n].a] / SLICE;
      lattice_rows_mark(&d->family, slice);
      if (d->contact.spec) d->contact.touched[d->particles->place_of[end ? d->broken[n].b : d->broken[n].a]] = 1;
      if (d->type->renew) d->type->renew(d->formulation, slice);
    }
  for (int64_t b = 0; d->type->show_displacements && b < d->block_count; ++b)
    d->type->show_displacements(d->formulation, d->blocks[b].first, d->blocks[b].last);
  for (int64_t b = 0; d->type->deform && b < d->block_count; ++b) answer(d, b, true);
  if (d->contact.spec) contact_search(&d->contact);
}

double domain_history(const Domain *d, int64_t place, int k)
{
  if (d->points.where == POINTS_NOWHERE) return 0;
  if (d->points.where == POINTS_ON_BONDS) return points_bond_history(&d->points, place, k);
  const int64_t slice = place / SLICE;
  return d->points
      .committed[d->points.history_start[slice] + place % SLICE * d->materials[d->material[slice]].history_values + k];
}

void domain_look(const Domain *d, int64_t place, double strain[6], double stress[6])
{
  if (d->points.where == POINTS_ON_PARTICLES) {
    for (int k = 0; k < 6; ++k) {
      strain[k] = d->points.strain[k][place];
      stress[k] = d->points.stress[k][place];
    }
    return;
  }
  double f[9];
  d->type->stress(d->formulation, place, stress);
  d->type->gradient(d->formulation, place, f);
  for (int k = 0; k < 6; ++k) {
    int r = symmetric_row[k], s = symmetric_column[k];
    double green = f[r] * f[s] + f[3 + r] * f[3 + s] + f[6 + r] * f[6 + s] - (r == s);
    strain[k] = k < 3 ? green / 2 : green;
  }
}

int domain_observe(Domain *d, Error *error)
{
  if (d->points.where == POINTS_ON_PARTICLES) return BRECCIA_OK;
  if (points_show(&d->points, error)) return BRECCIA_FAILURE;
#pragma omp parallel for schedule(static)
  for (int64_t n = 0; n < d->particles->count; ++n) {
    int32_t place = d->particles->place_of[n];
    double strain[6], stress[6];
    domain_look(d, place, strain, stress);
    for (int k = 0; k < 6; ++k) {
      d->points.strain[k][place] = strain[k];
      d->points.stress[k][place] = stress[k];
    }
  }
  return BRECCIA_OK;
}

int domain_record(Domain *d, const BrokenBond *bond)
{
  if (d->broken_count == d->broken_capacity) {
    int64_t capacity = d->broken_capacity ? 2 * d->broken_capacity : 256;
    BrokenBond *grown = realloc(d->broken, sizeof(BrokenBond) * (size_t)capacity);
    if (!grown) return BRECCIA_FAILURE;
    d->broken = grown;
    d->broken_capacity = capacity;
  }
  d->broken[d->broken_count++] = *bond;
  return BRECCIA_OK;
}

/** Work that the bond could still have done: half of force times elongation, as of a linear spring. */
static double released_energy(const Domain *d, int64_t slice, int64_t slot, int lane, const Bond *bond)
{
  const Particles *p = d->particles;
  double force[3], y[3], length = 0, along = 0;
  d->type->bond_force(d->formulation, slice, slot, lane, force);
  for (int k = 0; k < 3; ++k) {
    y[k] = bond->xi[k] + p->displacement[k][bond->neighbour] - p->displacement[k][slice * SLICE + lane];
    length += y[k] * y[k];
    along += force[k] * y[k];
  }
  length = sqrt(length);
  return 0.5 * along / length * (length - bond->length) * p->volume[slice * SLICE + lane] * p->volume[bond->neighbour];
}

/** Judges the bonds of the suspect slices in order; @return true if any broke */
static bool judge(Domain *d, int64_t step, double time)
{
  const Family *f = &d->family;
  int64_t before = d->broken_count;
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    if (!d->suspects[s]) continue;
    for (int64_t slot = f->first[s]; slot < f->first[s + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        Bond bond = family_bond(f, s, slot, lane);
        int32_t place = (int32_t)(s * SLICE + lane), a = d->particles->number[place];
        const uint8_t *gave_up = d->points.gave_up;
        if (!(gave_up && gave_up[place]) &&
            !(d->failure.criterion && d->failure.criterion->exceeds(&d->failure, f, s, &bond, lane)))
          continue;
        int32_t b = d->particles->number[bond.neighbour];
        d->fracture_energy += released_energy(d, s, slot, lane, &bond);
        family_break(&d->family, place, bond.neighbour);
        contact_bond_broke(&d->contact, place, bond.neighbour);
        d->suspects[bond.neighbour / SLICE] = 1; /* so that its family is renewed */
        BrokenBond event = {step, time, a < b ? a : b, a < b ? b : a};
        if (domain_record(d, &event)) return true;
      }
  }
  return d->broken_count > before;
}

void domain_break(Domain *d, int64_t step, double time, double motion)
{
  if (d->contact.spec) {
#pragma omp single
    contact_follow(&d->contact, motion);
  }
  if (!d->failure.criterion && !d->points.gave_up) return;
#pragma omp single
  d->motion += motion;
#pragma omp for schedule(static)
  for (int64_t b = 0; b < d->block_count; ++b)
    for (int64_t s = d->blocks[b].first; s < d->blocks[b].last; ++s) {
      d->suspects[s] = 0;
      if (d->failure.criterion && d->motion >= d->look_again[s])
        d->look_again[s] = d->motion + d->failure.criterion->suspect(&d->failure, &d->family, s, &d->suspects[s]);
      for (int lane = 0; d->points.gave_up && lane < SLICE; ++lane)
        if (d->points.gave_up[s * SLICE + lane]) d->suspects[s] = 1;
    }
#pragma omp single
  {
    int any = 0;
    for (int64_t s = 0; s < d->particles->slices; ++s) any |= d->suspects[s];
    if (any && judge(d, step, time))
      for (int64_t s = 0; s < d->particles->slices; ++s)
        if (d->suspects[s] && d->type->renew) d->type->renew(d->formulation, s);
    if (any && d->points.gave_up) memset(d->points.gave_up, 0, (size_t)d->points.places);
  }
}

double domain_damage(const Domain *d, int32_t place)
{
  if (!d->broken_count) return 0;
  double whole = d->family_volume[place];
  return whole > 0 ? fmax(0, 1 - family_volume(&d->family, place) / whole) : 0;
}

size_t domain_particle_bytes(const Domain *d)
{
  size_t places = (size_t)d->particles->places;
  size_t arrays = 15 + 2 + 1 + (d->points.where == POINTS_ON_PARTICLES ? 12 : 0);
  return places * sizeof(double) * arrays + places * sizeof(int32_t) * 2 + 2 * d->points.history_size * sizeof(double);
}

size_t domain_bytes(const Domain *d)
{
  return domain_particle_bytes(d) + family_bytes(&d->family) + d->type->bytes(d->formulation);
}
