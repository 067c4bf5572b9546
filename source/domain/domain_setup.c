/* Everything that a step needs, built from the deck. */
#include "domain/domain.h"

#include "base/team.h"
#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool takes(const FormulationType *type, const breccia_law *law)
{
  return law->components == type->components && (!type->takes || type->takes(law));
}

/** Laws take one strain or six; formulations offer one or the other, and some take few laws only. */
static int check_law(const Domain *d, const DeckReader *reader, const MaterialSpec *spec, const breccia_law *made)
{
  const LawList *laws = reader->context;
  const breccia_law *law = spec->model ? law_find(laws, spec->model) : made;
  if (takes(d->type, law)) return BRECCIA_OK;
  Text words = {0};
  for (int k = 0; law_at(laws, k); ++k)
    if (takes(d->type, law_at(laws, k))) text_add(&words, "%s%s", words.length ? ", " : "", law_at(laws, k)->name);
  const Node *place = section_place(spec, spec->model ? "model" : spec->opensees ? "opensees" : "remote");
  const char *name = spec->model ? law->name : law->source;
  if (law->components == d->type->components)
    node_error(reader->document, place, reader->error,
               "material '%s': '%s' needs a strain, which %s does not have; it takes %s", spec->head.name, name,
               d->type->name, text_words(&words));
  else
    node_error(reader->document, place, reader->error, "material '%s': '%s' is a law of %s; %s takes %s",
               spec->head.name, name, law->components == 1 ? "one strain" : "strain in space", d->type->name,
               text_words(&words));
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
    if (!bad && (bad = material_create(new, reader, material, length)))
      material_destroy(new);
    else if (!bad)
      ++d->material_count;
    if (!bad && new->remote) bad = check_law(d, reader, material, new->law);
    if (bad) status = bad;
  }
  for (int b = 0; b < spec->blocks->count; ++b) {
    const BlockSpec *block = spec->blocks->items[b];
    if (!section_find(spec->materials, block->material)) status = BRECCIA_USER_ERROR; /* said when the deck was read */
  }
  return status;
}

static int check_space(const Domain *d, const DeckReader *reader, const DomainSpec *spec)
{
  Space space = peridynamics_space(spec->peridynamics);
  const int status = d->type->check ? d->type->check(spec->peridynamics->keys, &d->body, reader) : BRECCIA_OK;
  if (status) return status;
  if (d->body.dimensions == (space == SPACE_3D ? 3 : space == SPACE_BAR ? 1 : 2)) return BRECCIA_OK;
  return node_error(reader->document, section_place(spec->peridynamics, "space"), reader->error,
                    d->body.dimensions == 1 ? "space: a line needs '1-D'"
                    : d->body.dimensions == 2
                        ? "space: a lattice of the plane needs 'plane strain' or 'plane stress'"
                        : "space: '%s' needs a square or hexagonal lattice; this body's is one of space",
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
    if (fabs(step - (k == lattice->axis) * SLICE * lattice->unit.size[k]) > 0.25 * lattice->spacing) return false;
  }
  return true;
}

static int create_failure(Domain *d, const DeckReader *reader, const FailureSpec *spec, const BondLength *lengths)
{
  const Criterion *criterion = criterion_of(spec);
  d->failure.limit = memory_zeroed((size_t)d->material_count, sizeof(double), "failure", reader->error);
  d->failure.material = d->material;
  if (!d->failure.limit) return BRECCIA_FAILURE;
  const LimitsOf of = {reader, d->type, lengths, d->materials, d->material_count};
  const int status = criterion->limits(spec, &of, d->failure.limit);
  for (int k = 0; k < d->material_count && !status; ++k)
    if (isfinite(d->failure.limit[k])) d->failure.criterion = criterion;
  return status;
}

static int find_lowest(Domain *d, Error *error)
{
  const Family *f = &d->family;
  int32_t *block_of = memory_zeroed((size_t)d->particles->slices, sizeof *block_of, "blocks", error);
  d->lowest = memory_zeroed((size_t)d->block_count, sizeof *d->lowest, "blocks", error);
  if (!block_of || !d->lowest) {
    free(block_of);
    return BRECCIA_FAILURE;
  }
  for (int64_t b = 0; b < d->block_count; ++b)
    for (int64_t s = d->blocks[b].first; s < d->blocks[b].last; ++s) block_of[s] = (int32_t)b;
  for (int64_t b = 0; b < d->block_count; ++b) {
    d->lowest[b] = b;
    for (int64_t s = d->blocks[b].first; s < d->blocks[b].last; ++s)
      for (int64_t slot = f->first[s]; slot < f->first[s + 1]; ++slot)
        for (int lane = 0; lane < SLICE; ++lane) {
          if (!(f->intact[slot] >> lane & 1)) continue;
          const int32_t there =
              slot < f->stored[s] ? f->base[slot] + lane : f->neighbour[(int64_t)f->base[slot] * SLICE + lane];
          if (block_of[there / SLICE] < d->lowest[b]) d->lowest[b] = block_of[there / SLICE];
        }
  }
  free(block_of);
  return BRECCIA_OK;
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
  if (!d->block_sum || !d->block_failed) return BRECCIA_FAILURE;
  for (int64_t b = 0; b < d->block_count; ++b) d->block_failed[b] = -1;
  return find_lowest(d, error);
}

static int fill_particles(Domain *d, const DomainSpec *spec, Error *error)
{
  Particles *p = d->particles;
  d->material = memory_zeroed((size_t)p->slices, sizeof(int32_t), "materials of slices", error);
  d->family_volume = memory_zeroed((size_t)p->places, sizeof(double), "family volumes", error);
  d->is_torn = memory_zeroed((size_t)p->places, 1, "torn families", error);
  d->suspects = memory_zeroed((size_t)p->slices, 1, "suspect slices", error);
  d->look_again = memory_zeroed((size_t)p->slices, sizeof(double), "suspect slices", error);
  if (!d->material || !d->family_volume || !d->is_torn || !d->suspects || !d->look_again) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < p->slices; ++s) {
    const SectionHead *named = section_find(spec->materials, d->body.blocks[p->block[s]]->material);
    while (strcmp(d->materials[d->material[s]].name, named->name)) ++d->material[s];
    for (int lane = 0; lane < SLICE; ++lane) p->density[s * SLICE + lane] = d->materials[d->material[s]].density;
  }
  return BRECCIA_OK;
}

static int create_forces(Domain *d, const DomainSpec *spec, Space space, Error *error)
{
  ForcesBlock *blocks = memory_zeroed((size_t)d->body.block_count, sizeof *blocks, "forces", error);
  if (!blocks) return BRECCIA_FAILURE;
  const FormerBonds bonds = d->type->former_bonds(d->formulation);
  for (int64_t s = 0; s < d->particles->slices; ++s)
    blocks[d->particles->block[s]] =
        (ForcesBlock){material_young(&d->materials[d->material[s]]), bonds.share, bonds.alike};
  const ForcesParts parts = {&d->body, &d->family, space, blocks};
  const int status = forces_create(&d->forces, spec->forces, &parts, error);
  free(blocks);
  return status;
}

/** Runs of points, one after another: a row joins the last run if it is of the same material. */
typedef struct Runs {
  PointsRun *runs;
  int64_t count, rows, capacity;
} Runs;

static int add_rows(Runs *r, int material, int64_t rows, Error *error)
{
  if (!rows) return BRECCIA_OK;
  if (!r->count || r->runs[r->count - 1].material != material) {
    if (r->count == r->capacity) {
      r->capacity = 2 * r->capacity + 16;
      PointsRun *grown = realloc(r->runs, sizeof *grown * (size_t)r->capacity);
      if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: runs of points");
      r->runs = grown;
    }
    r->runs[r->count++] = (PointsRun){material, r->rows, 0};
  }
  r->runs[r->count - 1].count += rows;
  r->rows += rows;
  return BRECCIA_OK;
}

/** Rows of the bonds of a slice: its own material's, then those of the materials at other ends. */
static int add_bonds(const Domain *d, int64_t slice, Runs *r, Error *error)
{
  const BondList *l = &d->bonds;
  int64_t own = SLICE * (l->owned_first[slice + 1] - l->owned_first[slice]), n = l->single_first[slice];
  for (; n < l->single_first[slice + 1] && l->single[n] >= 0; ++n) ++own;
  int status = add_rows(r, d->material[slice], own, error);
  for (; n < l->single_first[slice + 1] && !status; ++n) {
    int64_t slot;
    int lane;
    bond_list_bond(l, &d->family, slice, r->rows, &slot, &lane);
    status = add_rows(r, d->material[family_bond(&d->family, slice, slot, lane).neighbour / SLICE], 1, error);
  }
  return status;
}

/** Points on particles where laws take six strains; on bonds where they take one, unless all are linear. */
static int create_points(Domain *d, Space space, bool may_give_up, double length, Error *error)
{
  const Particles *p = d->particles;
  PointsSpec spec = {.components = d->type->components,
                     .plane_stress = space == SPACE_PLANE_STRESS,
                     .materials = d->materials,
                     .material_count = d->material_count,
                     .may_give_up = may_give_up,
                     .length = length};
  bool linear = d->type->components == 1 || d->type->keeps_no_points;
  for (int k = 0; k < d->material_count; ++k)
    linear = linear && (d->materials[k].law->linear || d->type->keeps_no_points);
  if (linear) spec.components = 0;
  if (spec.components == 1 && bond_list_create(&d->bonds, &d->family, d->material, error)) return BRECCIA_FAILURE;
  Runs runs = {0};
  int status = BRECCIA_OK;
  for (int64_t s = 0; s < p->slices && !status && spec.components; ++s)
    status = spec.components == 6 ? add_rows(&runs, d->material[s], SLICE, error) : add_bonds(d, s, &runs, error);
  uint8_t *present = status ? NULL : memory_zeroed((size_t)runs.rows, 1, "points", error);
  if (!present) status = BRECCIA_FAILURE;
  for (int64_t i = 0; i < runs.rows && !status && spec.components == 6; ++i) present[i] = p->number[i] >= 0;
  if (spec.components == 1 && !status) bond_list_mark(&d->bonds, &d->family, present);
  spec.runs = runs.runs;
  spec.run_count = runs.count;
  spec.present = present;
  if (!status) status = points_create(&d->points, &spec, error);
  for (int k = 0; k < 6 && spec.components == 6; ++k) {
    d->strain[k] = d->points.strain[k];
    d->stress[k] = d->points.stress[k];
  }
  free(runs.runs);
  free(present);
  if (status || !may_give_up) return status;
  d->gave_up = spec.components == 6 ? d->points.gave_up : memory_zeroed((size_t)p->places, 1, "failed laws", error);
  return d->gave_up ? BRECCIA_OK : BRECCIA_FAILURE;
}

static void weigh_family(void *context, int64_t place)
{
  const Domain *d = context;
  d->family_volume[place] = family_volume(&d->family, (int32_t)place);
}

/** True if a horizon without a unit is a usual number of spacings, but no usual length. */
static bool forgets_spacings(const PeridynamicsSpec *spec, const Body *body)
{
  const Node *node = section_place(spec, "horizon");
  const double number = spec->horizon.value, spacings = number / body->largest_spacing;
  const bool plain = node->kind == NODE_SCALAR && node->text[strspn(node->text, "0123456789.")] == 0;
  const bool odd = spacings < 1 || (spacings > 20 && body->dimensions > 1);
  return !spec->horizon.in_spacings && plain && number >= 1.4 && number <= 8 && odd;
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
  const BondLength of = {space, influence, horizon};
  double length = d->type->characteristic_length ? d->type->characteristic_length(&of) : NAN;
  int bad = create_materials(d, reader, spec, length);
  if (bad) status = bad;
  if (status) return status;
  d->particles = &d->body.particles;
  if ((status = fill_particles(d, spec, error))) return status;

  if (forgets_spacings(pd, &d->body))
    return node_error(reader->document, section_place(pd, "horizon"), error,
                      "horizon: did you mean '%g spacings'? A plain number is a length, and this one is %.3g spacings "
                      "of %g",
                      horizon, horizon / d->body.largest_spacing, d->body.largest_spacing);
  if (horizon < d->body.largest_spacing)
    return node_error(reader->document, section_place(pd, "horizon"), error,
                      "horizon: %g is less than the spacing of %g, so that no particle has a neighbour", horizon,
                      d->body.largest_spacing);
  const double reach = horizon / d->body.largest_spacing, across = pow(reach, d->body.dimensions);
  if (across > 1e6) /* family_create would go through all that many neighbours before it refuses them */
    return node_error(reader->document, section_place(pd, "horizon"), error,
                      "horizon: %g reaches over %.3g spacings of %g; 3 to 4 are usual", horizon, reach,
                      d->body.largest_spacing);
  int correction = 0;
  while (strcmp(volume_correction_word(correction), pd->volume_correction)) ++correction;
  const FamilySpec family = {horizon, influence, (VolumeCorrection)correction, d->type->row_sums,
                             d->type->bond_lengths};
  if ((status = family_create(&d->family, &d->body, &family, error))) return status;
  team_each(d->particles->places, weigh_family, d);

  const bool may_give_up = spec->failure && !strcmp(spec->failure->failed_laws, "break");
  if ((status = create_points(d, space, may_give_up, length, error)) || (status = share_out(d, error))) return status;
  const FormulationParts parts = {.keys = pd->keys,
                                  .space = space,
                                  .influence = influence,
                                  .body = &d->body,
                                  .particles = d->particles,
                                  .family = &d->family,
                                  .points = &d->points,
                                  .bonds = d->points.components == 1 ? &d->bonds : NULL,
                                  .materials = d->materials,
                                  .material = d->material};
  d->formulation = d->type->create(&parts, error);
  if (!d->formulation) return BRECCIA_USER_ERROR;
  status = create_failure(d, reader, spec->failure, &of);
  return status ? status : create_forces(d, spec, space, error);
}

int domain_hold_grips(Domain *d, const uint8_t *held, Error *error)
{
  const Particles *p = d->particles;
  const Family *f = &d->family;
  uint8_t *near = d->failure.near_grips = memory_zeroed((size_t)p->places, 1, "grips", error);
  if (!near) return BRECCIA_FAILURE;
  for (int64_t slice = 0; slice < p->slices; ++slice)
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane)
        if (held[slice * SLICE + lane] && (f->intact[slot] >> lane & 1))
          near[family_bond(f, slice, slot, lane).neighbour] = 1;
  for (int64_t place = 0; place < p->places; ++place) near[place] |= held[place];
  return BRECCIA_OK;
}

void domain_destroy(Domain *d)
{
  if (d->formulation) d->type->destroy(d->formulation);
  forces_destroy(&d->forces);
  if (d->points.components != 6) {
    for (int k = 0; k < 6; ++k) {
      places_free(&d->strain[k]);
      places_free(&d->stress[k]);
    }
    free(d->gave_up);
  }
  points_destroy(&d->points);
  bond_list_destroy(&d->bonds);
  family_destroy(&d->family);
  body_destroy(&d->body);
  for (int k = 0; k < d->material_count; ++k) material_destroy(&d->materials[k]);
  free(d->materials);
  free(d->material);
  free(d->blocks);
  free(d->lowest);
  free(d->block_sum);
  free(d->block_failed);
  free(d->family_volume);
  free(d->suspects);
  free(d->look_again);
  free(d->failure.limit);
  free(d->failure.near_grips);
  free(d->broken);
  free(d->torn);
  free(d->is_torn);
  *d = (Domain){0};
}
