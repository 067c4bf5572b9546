/* Everything that a step needs, built from the deck. */
#include "domain/regions.h"

#include "base/check.h"
#include "base/team.h"
#include "domain/strength_field.h"
#include "domain/tensile_strength.h"
#include "loading/support.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int check_space(const Domain *d, const DeckReader *reader, const DomainSpec *spec)
{
  Space space = peridynamics_space(spec->peridynamics);
  int status = BRECCIA_OK;
  for (int r = 0; r < d->region_count && !status; ++r)
    if (d->regions[r].type->check) status = d->regions[r].type->check(d->regions[r].keys, &d->body, reader);
  if (status) return status;
  if (d->body.dimensions == (space == SPACE_3D ? 3 : space == SPACE_BAR ? 1 : 2)) return BRECCIA_OK;
  return node_error(reader->document, section_node(spec->peridynamics, "space"), reader->error,
                    d->body.dimensions == 1 ? "space: a line needs '1-D'"
                    : d->body.dimensions == 2
                        ? "space: a lattice of the plane needs 'plane strain' or 'plane stress'"
                        : "space: '%s' needs a square or hexagonal lattice; this body's is one of space",
                    space_word(spec->peridynamics->space));
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
    if (fabs(step - (k == lattice->axis) * SLICE * lattice->unit.size[k]) > 0.25 * lattice->spacing) return false;
  }
  return true;
}

/** What a criterion works on. */
static int create_failure_parts(Domain *d, const Influence *influence, Error *error)
{
  Failure *failure = &d->failure;
  failure->limit = memory_zeroed((size_t)d->material_count, sizeof(double), "failure", error);
  failure->regions = memory_zeroed((size_t)d->region_count, sizeof *failure->regions, "failure", error);
  if (!failure->limit || !failure->regions) return BRECCIA_FAILURE;
  failure->material = d->material;
  failure->material_count = d->material_count;
  failure->region = d->region;
  failure->region_count = d->region_count;
  failure->influence = influence;
  for (int r = 0; r < d->region_count; ++r)
    failure->regions[r] = (FailureRegion){d->regions[r].type, d->regions[r].formulation};
  return BRECCIA_OK;
}

LimitsOf domain_limits_of(const Domain *d, int region, const BondLength *lengths)
{
  const Region *r = &d->regions[region];
  return (LimitsOf){.type = r->type,
                    .lengths = lengths,
                    .formulation = r->formulation,
                    .body = &d->body,
                    .family = &d->family,
                    .has_points = r->points.on_bonds && r->points.components == 1,
                    .section = body_section(&d->body),
                    .materials = d->materials,
                    .material_count = d->material_count};
}

/** Finds the factors on limits: those on strengths, squared for limits that are energies. */
static int create_limit_factors(Domain *d, Error *error)
{
  Failure *failure = &d->failure;
  const double exponent = 2.0 / failure->criterion->power;
  failure->factor = places_array(d->particles->places, "strengths", error);
  if (!failure->factor) return BRECCIA_FAILURE;
  failure->least_factor = INFINITY;
  for (int64_t i = 0; i < d->particles->places; ++i) {
    failure->factor[i] = pow(d->strength[i], exponent);
    failure->least_factor = fmin(failure->least_factor, failure->factor[i]);
  }
  return BRECCIA_OK;
}

static int create_failure(Domain *d, const DeckReader *reader, const FailureSpec *spec, const BondLength *lengths)
{
  const Criterion *criterion = criterion_of(spec);
  double *limit = memory_zeroed((size_t)d->material_count, sizeof(double), "failure", reader->error);
  bool *present = memory_zeroed((size_t)d->material_count, sizeof(bool), "failure", reader->error);
  int status = limit && present ? create_failure_parts(d, lengths->influence, reader->error) : BRECCIA_FAILURE;
  d->failure.keys = spec ? spec->keys : NULL;
  for (int k = 0; k < d->material_count && !status; ++k) d->failure.limit[k] = INFINITY;
  for (int r = 0; r < d->region_count && !status; ++r) {
    for (int k = 0; k < d->material_count; ++k)
      present[k] = region_has_material(d, &d->regions[r], d->materials[k].name);
    LimitsOf of = domain_limits_of(d, r, lengths);
    of.reader = reader;
    of.present = present;
    status = criterion->limits(spec, &of, limit);
    for (int k = 0; k < d->material_count && !status; ++k)
      if (present[k]) d->failure.limit[k] = fmin(d->failure.limit[k], limit[k]);
  }
  for (int k = 0; k < d->material_count && !status; ++k)
    if (isfinite(d->failure.limit[k])) d->failure.criterion = criterion;
  if (!status && d->strength && d->failure.criterion) status = create_limit_factors(d, reader->error);
  free(limit);
  free(present);
  if (!status && d->failure.criterion && criterion->create)
    status = criterion->create(&d->failure, &d->family, reader->error);
  return status;
}

static int find_lowest(Domain *d, Error *error)
{
  const Family *f = &d->family;
  int32_t *batch_of = memory_zeroed((size_t)d->particles->slices, sizeof *batch_of, "batches", error);
  d->lowest = memory_zeroed((size_t)d->batch_count, sizeof *d->lowest, "batches", error);
  if (!batch_of || !d->lowest) {
    free(batch_of);
    return BRECCIA_FAILURE;
  }
  for (int64_t b = 0; b < d->batch_count; ++b)
    for (int64_t s = d->batches[b].first; s < d->batches[b].last; ++s) batch_of[s] = (int32_t)b;
  for (int64_t b = 0; b < d->batch_count; ++b) {
    d->lowest[b] = b;
    for (int64_t s = d->batches[b].first; s < d->batches[b].last; ++s)
      for (int64_t slot = f->first[s]; slot < f->first[s + 1]; ++slot)
        for (int lane = 0; lane < SLICE; ++lane) {
          if (!(f->intact[slot] >> lane & 1)) continue;
          const int32_t there = slot < f->stored[s] ? family_base(f, s, slot) + lane
                                                    : f->neighbour[(int64_t)f->base[slot] * SLICE + lane];
          if (d->region[there / SLICE] != d->region[s]) continue;
          if (batch_of[there / SLICE] < d->lowest[b]) d->lowest[b] = batch_of[there / SLICE];
        }
  }
  free(batch_of);
  return BRECCIA_OK;
}

/** How many batches bonds along lattices lead back, at most. */
static int64_t reach_of(const Domain *d, const Region *region)
{
  const Family *f = &d->family;
  int64_t reach = 0;
  for (int64_t b = region->first_batch, low = b; b < region->last_batch; ++b) {
    int64_t first = d->batches[b].first;
    for (int64_t s = first; s < d->batches[b].last; ++s)
      for (int64_t slot = f->first[s]; slot < f->stored[s]; ++slot)
        if (f->intact[slot] && family_base(f, s, slot) / SLICE < first) first = family_base(f, s, slot) / SLICE;
    while (low > region->first_batch && d->batches[low].first > first) --low;
    while (low < b && d->batches[low].last <= first) ++low;
    if (b - low > reach) reach = b - low;
  }
  return reach;
}

/** Stripes are much longer than bonds reach, so that what they have in common is little, but not so long that many threads find no work. */
static int create_stripes(const Domain *d, Region *region, Error *error)
{
  enum { LEAST = 8, MANY = 16, LONG = 6 };
  const int64_t batches = region->last_batch - region->first_batch, wanted = LONG * reach_of(d, region),
                most = batches / MANY;
  int64_t size = wanted < most ? wanted : most;
  if (size < LEAST) size = LEAST;
  region->stripe_count = (batches + size - 1) / size;
  region->stripe = memory_zeroed((size_t)region->stripe_count + 1, sizeof *region->stripe, "batches", error);
  region->stripe_slice =
      memory_zeroed((size_t)region->stripe_count + 1, sizeof *region->stripe_slice, "batches", error);
  if (!region->stripe || !region->stripe_slice) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < region->stripe_count; ++n) {
    region->stripe[n] = region->first_batch + n * size;
    region->stripe_slice[n] = d->batches[region->stripe[n]].first;
  }
  region->stripe[region->stripe_count] = region->last_batch;
  region->stripe_slice[region->stripe_count] = d->batches[region->last_batch - 1].last;
  return BRECCIA_OK;
}

/* Batches end with a row, as far as rows are no longer than a batch: sums along rows can then be made while what is summed is still
 * in the cache. */
static int share_out(Domain *d, Error *error)
{
  int64_t slices = d->particles->slices;
  d->batches = memory_zeroed((size_t)slices, sizeof(Batch), "batches", error);
  if (!d->batches) return BRECCIA_FAILURE;
  for (int r = 0; r < d->region_count; ++r) {
    d->regions[r].first_batch = d->batch_count;
    for (int64_t s = 0; s < slices;) {
      int64_t end = s + 1, row_end = row_goes_on(d, s) ? s : end;
      if (d->region[s] != r) {
        s = end;
        continue;
      }
      for (; end < slices && end - s < BATCH / SLICE && d->region[end] == r && d->material[end] == d->material[s];
           ++end)
        if (!row_goes_on(d, end)) row_end = end + 1;
      if (row_end > s) end = row_end;
      d->rows_cut |= row_goes_on(d, end - 1);
      d->batches[d->batch_count++] = (Batch){s, end};
      s = end;
    }
    d->regions[r].last_batch = d->batch_count;
    if (create_stripes(d, &d->regions[r], error)) return BRECCIA_FAILURE;
  }
  d->batch_sum = memory_zeroed((size_t)d->batch_count * MAX_SUMS, sizeof(double), "batch sums", error);
  d->batch_failed = memory_zeroed((size_t)d->batch_count, sizeof(int64_t), "batch sums", error);
  if (!d->batch_sum || !d->batch_failed) return BRECCIA_FAILURE;
  for (int64_t b = 0; b < d->batch_count; ++b) d->batch_failed[b] = -1;
  d->particles->space.tiles = d->batches;
  d->particles->space.tile_count = d->batch_count;
  d->particles->space.sums = d->batch_sum;
  return find_lowest(d, error);
}

/** Layers outside supports stand for what the body is half of, and have no energy of its own. */
static int count_volumes(Domain *d, Error *error)
{
  const Particles *p = d->particles;
  const bool apart = d->body.margin_of != NULL;
  d->counted = apart ? places_array(p->places, "volumes", error) : p->volume;
  if (!d->counted) return BRECCIA_FAILURE;
  for (int64_t n = 0; apart && n < p->count; ++n)
    d->counted[p->place_of[n]] = body_outside(&d->body, n) ? 0 : p->volume[p->place_of[n]];
  return BRECCIA_OK;
}

/** Whether bonds may break: where a deck tells a criterion, and those of laws that soften. */
static bool may_break(const Domain *d, const DomainSpec *spec)
{
  return spec->failure || !domain_is_hookean(d, NULL);
}

static int fill_particles(Domain *d, const DomainSpec *spec, Error *error)
{
  Particles *p = d->particles;
  d->material = memory_zeroed((size_t)p->slices, sizeof(int32_t), "materials of slices", error);
  if (may_break(d, spec) &&
      !(d->family_volume = memory_zeroed((size_t)p->places, sizeof(double), "family volumes", error)))
    return BRECCIA_FAILURE;
  d->is_torn = memory_zeroed((size_t)p->places, 1, "torn families", error);
  d->suspects = memory_zeroed((size_t)p->slices, 1, "suspect slices", error);
  d->look_again = memory_zeroed((size_t)p->slices, sizeof(double), "suspect slices", error);
  if (!d->material || !d->is_torn || !d->suspects || !d->look_again) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < p->slices; ++s) {
    if (s && p->block[s] == p->block[s - 1]) d->material[s] = d->material[s - 1]; /* so that it is not looked for */
    const SectionHead *named = section_find(spec->materials, d->body.blocks[p->block[s]]->material);
    while (strcmp(d->materials[d->material[s]].name, named->name)) ++d->material[s];
    for (int lane = 0; lane < SLICE; ++lane) p->density[s * SLICE + lane] = d->materials[d->material[s]].density;
  }
  return count_volumes(d, error);
}

static int create_forces(Domain *d, const DeckReader *reader, const DomainSpec *spec, Space space)
{
  ForcesBlock *blocks = memory_zeroed((size_t)d->body.block_count, sizeof *blocks, "forces", reader->error);
  if (!blocks) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    const Region *region = domain_region(d, s * SLICE);
    const FormerBonds bonds = region->type->former_bonds(region->formulation);
    blocks[d->particles->block[s]] =
        (ForcesBlock){material_young(&d->materials[d->material[s]]), bonds.share, bonds.alike};
  }
  const ForcesParts parts = {.body = &d->body,
                             .family = &d->family,
                             .space = space,
                             .clock = &d->clock,
                             .blocks = blocks,
                             .reader = reader,
                             .materials = d->materials,
                             .material_count = d->material_count};
  const int status = forces_create(&d->forces, spec->forces, &parts, reader->error);
  free(blocks);
  return status;
}

static void weigh_family(void *context, int64_t place)
{
  const Domain *d = context;
  d->family_volume[place] = family_volume(&d->family, (int32_t)place);
}

/** True if a horizon without a unit is a usual number of spacings, but no usual length. */
static bool forgets_spacings(const PeridynamicsSpec *spec, const Body *body)
{
  const Node *node = section_node(spec, "horizon");
  const double number = spec->horizon.value, spacings = number / body->largest_spacing;
  const bool plain = node->kind == NODE_SCALAR && node->text[strspn(node->text, "0123456789.")] == 0;
  if (isnan(number)) return false;
  const bool odd = spacings < 1 || (spacings > 20 && body->dimensions > 1);
  return !spec->horizon.in_spacings && plain && number >= 1.4 && number <= 8 && odd;
}

/** Adds what was told without a place, at the one of a node. @return the status */
static int tell_at(const DeckReader *reader, const Node *node, int status, Error **told)
{
  if (status == BRECCIA_USER_ERROR)
    node_error(reader->document, node, reader->error, "%s", breccia_error_text(*told));
  else if (status)
    error_add_all(reader->error, status, *told);
  breccia_error_destroy(told);
  return status;
}

/** Particles have rotations if a formulation of the body wants them. */
static int make_rotations(Domain *d, Error *error)
{
  bool turn = false;
  for (int r = 0; r < d->region_count; ++r) turn |= d->regions[r].type->gyration != NULL;
  if (!turn) return BRECCIA_OK;
  Particles *p = d->particles;
  if (d->region_count > 1 && !(p->unturned = memory_zeroed((size_t)p->slices, 1, "rotations", error)))
    return BRECCIA_FAILURE;
  for (int64_t s = 0; s < p->slices && p->unturned; ++s) p->unturned[s] = !domain_region(d, s * SLICE)->type->gyration;
  return particles_make_rotations(p, d->body.dimensions, error);
}

/** Rotational inertia; of places of formulations without rotations, which nothing turns, that of cubes of a spacing. */
static void fill_rotary(Domain *d)
{
  Particles *p = d->particles;
  const double usual = d->body.largest_spacing * d->body.largest_spacing / 6;
  for (int64_t i = 0; i < p->places && p->rotary; ++i) {
    const Region *region = domain_region(d, i);
    p->rotary[i] = p->density[i] * (region->type->gyration ? region->type->gyration(region->formulation, i) : usual);
  }
}

int domain_create(Domain *d, const DeckReader *reader, const DomainSpec *spec)
{
  Error *error = reader->error;
  const PeridynamicsSpec *pd = spec->peridynamics;
  const Influence *influence = influence_at(pd->influence);
  const Space space = peridynamics_space(pd);
  d->failed_place = -1;
  d->forces_spec = spec->forces;
  d->is_strained = spec->is_strained;
  d->begins_under_stress = spec->begins_under_stress;
  int status = body_create(&d->body, reader, spec->blocks, spec->cracks, spec->margins);
  if (!status) status = regions_create(d, reader, pd);
  if (status) return status;
  status = regions_take_fibres(d, reader, spec->materials);
  int bad = check_space(d, reader, spec);
  if (bad) status = bad;
  const Length wanted = peridynamics_horizon(pd);
  const double horizon = wanted.value * (wanted.in_spacings ? d->body.largest_spacing : 1);
  const BondLength of = {space, influence, horizon, d->body.largest_spacing};
  bad = domain_create_materials(d, reader, spec, &of);
  if (bad) status = bad;
  if (status) return status;
  d->particles = &d->body.particles;
  d->selections = spec->selections;
  if ((status = strength_field_create(d, reader, spec->fields))) return status;
  if ((status = fill_particles(d, spec, error)) || (status = make_rotations(d, error))) return status;

  if (forgets_spacings(pd, &d->body))
    return node_error(reader->document, section_node(pd, "horizon"), error,
                      "horizon: did you mean '%g spacings'? A plain number is a length, and this one is %.3g spacings "
                      "of %g",
                      horizon, horizon / d->body.largest_spacing, d->body.largest_spacing);
  if (horizon < d->body.largest_spacing)
    return node_error(reader->document, section_node(pd, "horizon"), error,
                      "horizon: %g is less than the spacing of %g, so that no particle has a neighbour", horizon,
                      d->body.largest_spacing);
  const double reach = horizon / d->body.largest_spacing, across = pow(reach, d->body.dimensions);
  if (across > 1e6) /* family_create would go through all that many neighbours before it refuses them */
    return node_error(reader->document, section_node(pd, "horizon"), error,
                      "horizon: %g reaches over %.3g spacings of %g; 3 to 4 are usual", horizon, reach,
                      d->body.largest_spacing);
  FamilySpec family = {horizon, influence, (VolumeCorrection)pd->volume_correction, false};
  for (int r = 0; r < d->region_count; ++r) family.row_sums |= d->regions[r].type->row_sums;
  Error *told = breccia_error_create();
  status = family_create(&d->family, &d->body, &family, told);
  if (tell_at(reader, section_node(pd, "horizon"), status, &told)) return status;
  CHECK(family_is_valid(&d->family));
  if (d->family_volume) team_each(d->particles->places, weigh_family, d);

  const bool may_give_up = spec->failure && spec->failure->failed_laws == FAILED_LAWS_BREAK;
  if (may_give_up && d->region_count > 1)
    return node_error(reader->document, section_node(spec->failure, "failed laws"), error,
                      "failed laws: 'break' needs a body of one formulation; leave 'regions' out, or let the run stop");
  status = strength_field_check(d, reader, spec->fields);
  for (int r = 0; r < d->region_count && !status; ++r)
    status = region_create_points(d, &d->regions[r], space, may_give_up, &of, error);
  if (!status) status = share_out(d, error);
  if (!status) status = regions_find_borders(d, error);
  if (!status) status = joint_create(&d->joint, d, error);
  if (status) return status;
  for (int r = 0; r < d->region_count; ++r) {
    Region *region = &d->regions[r];
    CHECK(points_is_valid(&region->points));
    const FormulationParts parts = {.keys = region->keys,
                                    .space = space,
                                    .influence = influence,
                                    .body = &d->body,
                                    .particles = d->particles,
                                    .family = &d->family,
                                    .points = &region->points,
                                    .bonds = region->points.on_bonds ? &region->bonds : NULL,
                                    .materials = d->materials,
                                    .material_count = d->material_count,
                                    .material = d->material,
                                    .foreign = region->foreign,
                                    .stripe = region->stripe_slice,
                                    .stripe_count = region->stripe_count,
                                    .may_break = spec->failure != NULL};
    told = breccia_error_create();
    region->formulation = region->type->create(&parts, told);
    status = region->formulation ? BRECCIA_OK : BRECCIA_USER_ERROR;
    if (tell_at(reader, region->name ? region->node : section_node(pd, "formulation"), status, &told)) return status;
  }
  fill_rotary(d);
  if (domain_find_lengths(d, of.space, error)) return BRECCIA_FAILURE;
  if ((status = tensile_strength_set(d, reader, spec->materials))) return status;
  status = create_failure(d, reader, spec->failure, &of);
  for (int r = 0; r < d->region_count && !status; ++r) status = window_create(d, &d->regions[r], error);
  return status ? status : create_forces(d, reader, spec, space);
}

void domain_destroy(Domain *d)
{
  domain_leave_tensors(d, false);
  forces_destroy(&d->forces);
  if (d->region_count > 1 || (d->region_count && !points_on_particles(&d->regions[0].points))) {
    for (int k = 0; k < 6; ++k) {
      places_free(&d->strain[k]);
      places_free(&d->stress[k]);
    }
    free(d->gave_up);
  }
  for (int k = 0; k < 6; ++k) {
    places_free(&d->initial_strain[k]);
    for (int r = 0; r < d->region_count; ++r) places_free(&d->regions[r].initial[k]);
  }
  joint_destroy(&d->joint);
  domain_strains_destroy(d);
  regions_destroy(d);
  family_destroy(&d->family);
  if (d->particles && d->counted != d->particles->volume) places_free(&d->counted);
  body_destroy(&d->body);
  for (int k = 0; k < d->material_count; ++k) material_destroy(&d->materials[k]);
  free(d->materials);
  free(d->lengths);
  free(d->material);
  free(d->batches);
  free(d->lowest);
  free(d->batch_sum);
  free(d->batch_failed);
  free(d->family_volume);
  free(d->suspects);
  free(d->look_again);
  free(d->failure.limit);
  free(d->failure.regions);
  free(d->failure.weights);
  places_free(&d->failure.factor);
  places_free(&d->strength);
  free(d->failure.kept);
  free(d->broken);
  free(d->torn);
  free(d->breaking);
  free(d->is_torn);
  *d = (Domain){0};
}
