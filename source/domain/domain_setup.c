/* Everything that a step needs, built from the deck. */
#include "domain/domain.h"

#include "base/team.h"
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

/** Blocks whose laws run in one server, to be sent together. In plane stress each block finds its strain across the plane by itself. */
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

static int create_contact(Domain *d, const DomainSpec *spec, Space space, Error *error)
{
  double *young = memory_zeroed((size_t)d->body.block_count, sizeof(double), "contact", error);
  if (!young) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < d->particles->slices; ++s)
    young[d->particles->block[s]] = material_young(&d->materials[d->material[s]]);
  const bool whole = d->type->uniaxial && !strcmp(spec->peridynamics->surface_correction, "none");
  int status = contact_create(&d->contact, spec->contact, &d->body, &d->family, space, whole,
                              d->type->uniaxial ? 1 : 0.8, young, error);
  free(young);
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
  double length =
      d->type->characteristic_length ? d->type->characteristic_length(&(BondLength){space, influence, horizon}) : NAN;
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
  return status ? status : create_contact(d, spec, space, error);
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
  free(d->failure.near_grips);
  free(d->broken);
  free(d->torn);
  free(d->is_torn);
  *d = (Domain){0};
}
