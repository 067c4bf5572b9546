#include "domain/domain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int create_materials(Domain *d, const DeckReader *reader, const DomainSpec *spec)
{
  d->materials = memory_zeroed((size_t)spec->materials->count, sizeof(Material), "materials", reader->error);
  if (!d->materials) return BRECCIA_FAILURE;
  int status = BRECCIA_OK;
  for (int k = 0; k < spec->materials->count; ++k) {
    int bad = material_create(&d->materials[d->material_count++], reader, spec->materials->items[k]);
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
  if (d->body.plane == (space != SPACE_3D)) return BRECCIA_OK;
  return node_error(reader->document, section_place(spec->peridynamics, "space"), reader->error,
                    d->body.plane ? "space: a square lattice needs 'plane strain' or 'plane stress'"
                                  : "space: '%s' needs a square lattice; this body's is cubic",
                    spec->peridynamics->space);
}

/** True if the row of a slice goes on in the slice after it. */
static bool row_goes_on(const Domain *d, int64_t slice)
{
  const Particles *p = d->particles;
  if (slice + 1 >= p->slices || p->block[slice + 1] != p->block[slice]) return false;
  const Lattice *lattice = &d->body.lattices[p->block[slice]];
  for (int k = 0; k < 3; ++k) {
    double step = p->position[k][(slice + 1) * SLICE] - p->position[k][slice * SLICE];
    if (fabs(step - (k == lattice->axis) * SLICE * lattice->spacing) > 0.5 * lattice->spacing) return false;
  }
  return true;
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
    for (; end < slices && end - s < BLOCK / SLICE && d->material[end] == d->material[s]; ++end)
      if (!row_goes_on(d, end)) row_end = end + 1;
    if (row_end > s) end = row_end;
    d->rows_cut |= row_goes_on(d, end - 1);
    d->blocks[d->block_count++] = (Span){s, end};
    s = end;
  }
  d->block_sum = memory_zeroed((size_t)d->block_count, sizeof(double), "block sums", error);
  d->block_failed = memory_zeroed((size_t)d->block_count, sizeof(int64_t), "block sums", error);
  return d->block_sum && d->block_failed ? BRECCIA_OK : BRECCIA_FAILURE;
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

int domain_create(Domain *d, const DeckReader *reader, const DomainSpec *spec)
{
  Error *error = reader->error;
  const PeridynamicsSpec *pd = spec->peridynamics;
  d->failed_place = -1;
  int status = create_materials(d, reader, spec), bad = body_create(&d->body, reader, spec->blocks, spec->cracks);
  if (bad) status = bad;
  if (!bad && (bad = check_space(d, reader, spec))) status = bad;
  if (status) return status;
  d->particles = &d->body.particles;
  if ((status = fill_particles(d, spec, error))) return status;

  double horizon = pd->horizon.value * (pd->horizon.in_spacings ? d->body.largest_spacing : 1);
  if (horizon < d->body.largest_spacing)
    return node_error(reader->document, section_place(pd, "horizon"), error,
                      "horizon: %g is less than the spacing of %g, so that no particle has a neighbour", horizon,
                      d->body.largest_spacing);
  int correction = 0;
  while (strcmp(volume_correction_word(correction), pd->volume_correction)) ++correction;
  status =
      family_create(&d->family, &d->body, horizon, influence_find(pd->influence), (VolumeCorrection)correction, error);
  if (status) return status;
#pragma omp parallel for schedule(static)
  for (int32_t place = 0; place < (int32_t)d->particles->places; ++place)
    d->family_volume[place] = family_volume(&d->family, place);

  if ((status =
           points_create(&d->points, d->particles->slices, peridynamics_space(pd), d->materials, d->material, error)))
    return status;
  if ((status = share_out(d, error))) return status;
  FormulationParts parts = {pd, &d->body, d->particles, &d->family, &d->points};
  d->type = formulation_find(pd->formulation);
  d->formulation = d->type->create(&parts, error);
  d->failure = failure_of(spec->failure);
  return d->formulation ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

void domain_destroy(Domain *d)
{
  if (d->formulation) d->type->destroy(d->formulation);
  points_destroy(&d->points);
  family_destroy(&d->family);
  body_destroy(&d->body);
  for (int k = 0; k < d->material_count; ++k) material_destroy(&d->materials[k]);
  free(d->materials);
  free(d->material);
  free(d->blocks);
  free(d->block_sum);
  free(d->block_failed);
  free(d->family_volume);
  free(d->suspects);
  free(d->look_again);
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

void domain_forces(Domain *d)
{
  _Alignas(64) double carry[CARRY * BLOCK];
#pragma omp for schedule(static)
  for (int64_t b = 0; b < d->block_count; ++b)
    d->type->sum_displacements(d->formulation, d->blocks[b].first, d->blocks[b].last);
#pragma omp for schedule(static)
  for (int64_t b = 0; b < d->block_count; ++b) {
    Span span = d->blocks[b];
    d->type->deform(d->formulation, span.first, span.last, carry);
    d->block_failed[b] = points_update(&d->points, span.first, span.last, NULL);
    d->type->respond(d->formulation, span.first, span.last, carry);
    if (!d->rows_cut) d->type->sum_states(d->formulation, span.first, span.last);
  }
  if (d->rows_cut) {
#pragma omp for schedule(static)
    for (int64_t b = 0; b < d->block_count; ++b)
      d->type->sum_states(d->formulation, d->blocks[b].first, d->blocks[b].last);
  }
#pragma omp for schedule(static)
  for (int64_t b = 0; b < d->block_count; ++b) {
    d->type->resist(d->formulation, d->blocks[b].first, d->blocks[b].last);
    d->block_sum[b] = force_magnitude(d->particles, &d->blocks[b]);
  }
#pragma omp single
  {
    d->type->finish(d->formulation);
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
  _Alignas(64) double carry[CARRY * BLOCK];
  for (int64_t n = 0; n < d->broken_count; ++n) {
    d->type->renew(d->formulation, d->particles->place_of[d->broken[n].a] / SLICE);
    d->type->renew(d->formulation, d->particles->place_of[d->broken[n].b] / SLICE);
    lattice_rows_mark(&d->family, d->particles->place_of[d->broken[n].a] / SLICE);
    lattice_rows_mark(&d->family, d->particles->place_of[d->broken[n].b] / SLICE);
  }
  for (int64_t b = 0; b < d->block_count; ++b)
    d->type->sum_displacements(d->formulation, d->blocks[b].first, d->blocks[b].last);
  for (int64_t b = 0; b < d->block_count; ++b) {
    d->type->deform(d->formulation, d->blocks[b].first, d->blocks[b].last, carry);
    d->type->respond(d->formulation, d->blocks[b].first, d->blocks[b].last, carry);
  }
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
        if (!d->failure.criterion->exceeds(d->failure.limit, f, s, &bond, lane)) continue;
        int32_t place = (int32_t)(s * SLICE + lane), a = d->particles->number[place];
        int32_t b = d->particles->number[bond.neighbour];
        d->fracture_energy += released_energy(d, s, slot, lane, &bond);
        family_break(&d->family, place, bond.neighbour);
        d->suspects[bond.neighbour / SLICE] = 1; /* so that its family is renewed */
        BrokenBond event = {step, time, a < b ? a : b, a < b ? b : a};
        if (domain_record(d, &event)) return true;
      }
  }
  return d->broken_count > before;
}

void domain_break(Domain *d, int64_t step, double time, double motion)
{
  if (!d->failure.criterion) return;
#pragma omp single
  d->motion += motion;
#pragma omp for schedule(static)
  for (int64_t b = 0; b < d->block_count; ++b)
    for (int64_t s = d->blocks[b].first; s < d->blocks[b].last; ++s) {
      d->suspects[s] = 0;
      if (d->motion < d->look_again[s]) continue;
      d->look_again[s] = d->motion + d->failure.criterion->suspect(d->failure.limit, &d->family, s, &d->suspects[s]);
    }
#pragma omp single
  {
    int any = 0;
    for (int64_t s = 0; s < d->particles->slices; ++s) any |= d->suspects[s];
    if (any && judge(d, step, time))
      for (int64_t s = 0; s < d->particles->slices; ++s)
        if (d->suspects[s]) d->type->renew(d->formulation, s);
  }
}

double domain_damage(const Domain *d, int32_t place)
{
  double whole = d->family_volume[place];
  return whole > 0 ? fmax(0, 1 - family_volume(&d->family, place) / whole) : 0;
}

size_t domain_particle_bytes(const Domain *d)
{
  size_t places = (size_t)d->particles->places;
  return places * sizeof(double) * (15 + 2 + 12 + 1) + places * sizeof(int32_t) * 2 +
         2 * d->points.history_size * sizeof(double);
}

size_t domain_bytes(const Domain *d)
{
  return domain_particle_bytes(d) + family_bytes(&d->family) + d->type->bytes(d->formulation);
}
