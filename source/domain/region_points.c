/* Points of a region: on its particles or on its bonds, in runs of one material. */
#include "base/memory.h"
#include "constitutive/min_max.h"
#include "domain/regions.h"

#include <math.h>
#include <stdlib.h>

/** Runs of points, one after another: a row joins the last run if it is of the same material. */
typedef struct Runs {
  PointsRun *runs;
  int64_t count, rows, capacity;
} Runs;

static int add_rows(Runs *r, int material, int64_t rows, Error *error)
{
  if (!rows) return BRECCIA_OK;
  const PointsRun *last = r->count ? &r->runs[r->count - 1] : NULL;
  if (!last || last->material != material || last->first + last->count != r->rows) {
    if (r->count == r->capacity) {
      r->capacity = 2 * r->capacity + 16;
      PointsRun *grown = memory_grown(r->runs, (size_t)r->capacity, sizeof *grown);
      if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: runs of points");
      r->runs = grown;
    }
    r->runs[r->count++] = (PointsRun){material, r->rows, 0};
  }
  r->runs[r->count - 1].count += rows;
  r->rows += rows;
  return BRECCIA_OK;
}

/** Adds the rows of the bonds of a slice: first those of the slice's material, then second rows of other materials. */
static int add_bonds(const Domain *d, const BondList *l, int64_t slice, Runs *r, Error *error)
{
  int64_t own = SLICE * (l->owned_first[slice + 1] - l->owned_first[slice]), n = l->single_first[slice];
  for (; n < l->single_first[slice + 1] && l->single[n] >= 0; ++n) ++own;
  int status = add_rows(r, d->material[slice], own, error);
  for (; n < l->single_first[slice + 1] && !status; ++n) status = add_rows(r, l->single_material[n], 1, error);
  return status;
}

/** Whether no law of a region dissipates or remembers. */
static bool is_linear(const Domain *d, const Region *region)
{
  bool linear = true;
  for (int k = 0; k < d->material_count; ++k)
    if (region_is_made_of(d, region, d->materials[k].name)) linear &= d->materials[k].law->linear != 0;
  return linear;
}

/** Returns true if a law of a region reads the elongation of bonds by the pressure across them. */
static bool takes_lateral(const Domain *d, const Region *region)
{
  bool any = false;
  for (int k = 0; k < d->material_count; ++k)
    if (region_is_made_of(d, region, d->materials[k].name)) any |= material_takes_lateral(&d->materials[k]);
  return any;
}

bool domain_is_hookean(const Domain *d, const Region *region)
{
  bool hookean = true;
  for (int k = 0; k < d->material_count; ++k)
    if (!region || region_is_made_of(d, region, d->materials[k].name)) hookean &= material_is_hookean(&d->materials[k]);
  return hookean;
}

/** Strains and stresses of all places, where several regions share them. */
static int create_tensors(Domain *d, Error *error)
{
  for (int k = 0; k < 6; ++k) {
    if (!d->strain[k]) d->strain[k] = places_array(d->particles->places, "strains", error);
    if (!d->stress[k]) d->stress[k] = places_array(d->particles->places, "stresses", error);
    if (!d->strain[k] || !d->stress[k]) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

/** Lists the bonds of a region, with second rows where its formulation laminates points. */
static int region_list_bonds(Domain *d, Region *region, Error *error)
{
  BondListOf of = {.material = d->material, .foreign = region->foreign};
  int32_t *stiffness = NULL;
  if (region->type->laminates) {
    stiffness = memory_zeroed((size_t)d->particles->slices, sizeof *stiffness, "list of bonds", error);
    if (!stiffness) return BRECCIA_FAILURE;
    for (int64_t s = 0; s < d->particles->slices; ++s)
      while (!material_is_as_stiff(&d->materials[stiffness[s]], &d->materials[d->material[s]])) ++stiffness[s];
    of.stiffness = stiffness;
  }
  const int status = bond_list_create(&region->bonds, &d->family, &of, error);
  free(stiffness);
  return status;
}

/** Sets place and strength of a row of points.
 *  @param[in] ends  places of both ends of a bond; twice that of a particle */
static void region_set_row(const Domain *d, Region *region, int64_t row, const int32_t ends[2])
{
  const Particles *p = d->particles;
  PointPlaces *at = &region->places;
  int64_t numbers[2] = {p->number[ends[0]], p->number[ends[1]]};
  if (region->row_strength) region->row_strength[row] = fmin(d->strength[ends[0]], d->strength[ends[1]]);
  if (!at->position[0]) return;
  double middle[3], along[3], square = 0;
  domain_bond_middle(d, (const int32_t[]){(int32_t)numbers[0], (int32_t)numbers[1]}, middle);
  body_fold_bond(&d->body, numbers);
  for (int k = 0; k < 3; ++k) {
    along[k] = p->position[k][p->place_of[numbers[1]]] - p->position[k][p->place_of[numbers[0]]];
    square += along[k] * along[k];
    at->position[k][row] = middle[k];
  }
  for (int k = 0; k < 3 && at->direction[0]; ++k) at->direction[k][row] = along[k] / sqrt(square);
  for (int k = 0; k < 2; ++k) at->particle[k][row] = (int32_t)body_original(&d->body, numbers[k]);
}

/** Finds places and strengths of the rows of points, as far as laws or fields ask for them. @param[in] present  [rows] */
static int region_place_rows(Domain *d, Region *region, int64_t rows, const uint8_t *present, Error *error)
{
  const bool on_bonds = region->bonds.first != NULL;
  bool asks = false;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    if (!region_is_made_of(d, region, m->name)) continue;
    asks |= material_takes_places(m);
    if (d->begins_under_stress && m->law->components == 6 && m->law->begin_point)
      return error_add(
          error, BRECCIA_USER_ERROR,
          "initial stress: histories of the law '%s' of material '%s' begin by the places of points, which "
          "points that begin under stress do not take; leave 'initial stress' out, or take another law",
          m->law_name, m->name);
  }
  const size_t room = (size_t)rows + 1;
  bool is_lost = false;
  if (on_bonds && d->strength)
    is_lost |= !(region->row_strength = memory_zeroed(room, sizeof(double), "strengths", error));
  for (int k = 0; k < 2 && asks; ++k)
    is_lost |= !(region->places.particle[k] = memory_zeroed(room, sizeof(int32_t), "places of points", error));
  for (int k = 0; k < 3 && asks; ++k) {
    is_lost |= !(region->places.position[k] = memory_zeroed(room, sizeof(double), "places of points", error));
    if (on_bonds)
      is_lost |= !(region->places.direction[k] = memory_zeroed(room, sizeof(double), "places of points", error));
  }
  if (is_lost) return BRECCIA_FAILURE;
  for (int64_t row = 0; row < rows && region->row_strength; ++row) region->row_strength[row] = 1;
  for (int64_t row = 0; row < rows && asks && !on_bonds; ++row)
    if (present[row]) region_set_row(d, region, row, (const int32_t[]){(int32_t)row, (int32_t)row});
  for (int64_t s = 0; s < d->particles->slices && on_bonds && (asks || region->row_strength); ++s)
    for (int64_t row = region->bonds.first[s]; row < region->bonds.first[s + 1]; ++row) {
      int64_t slot;
      int lane;
      if (!present[row]) continue;
      bond_list_bond(&region->bonds, &d->family, s, row, &slot, &lane);
      const int32_t ends[2] = {(int32_t)(s * SLICE + lane), family_bond(&d->family, s, slot, lane).neighbour};
      region_set_row(d, region, row, ends);
    }
  return BRECCIA_OK;
}

int region_create_points(Domain *d, Region *region, Space space, bool may_give_up, const BondLength *of, Error *error)
{
  const Particles *p = d->particles;
  PointsSpec spec = {.components = region->type->components,
                     .on_bonds = region->type->on_bonds,
                     .plane_stress = space == SPACE_PLANE_STRESS,
                     .clock = &d->clock,
                     .materials = d->materials,
                     .material_count = d->material_count,
                     .may_give_up = may_give_up,
                     .length = region_length(region->type, of)};
  region->is_linear = is_linear(d, region);
  spec.takes_lateral = space != SPACE_BAR && spec.components == 1 && spec.on_bonds && takes_lateral(d, region);
  if (region->type->keeps_no_points || (region->type->components == 1 && region->is_linear && !d->is_strained))
    spec.components = 0;
  if (!spec.components) spec.on_bonds = false;
  spec.no_tensors = region->type->knows_hooke && spec.on_bonds && domain_is_hookean(d, region) && !d->is_strained &&
                    !d->begins_under_stress;
  const bool on_particles = spec.components == 6 && !spec.on_bonds;
  if (spec.on_bonds && region_list_bonds(d, region, error)) return BRECCIA_FAILURE;
  if (on_particles && d->region_count > 1) {
    if (create_tensors(d, error)) return BRECCIA_FAILURE;
    spec.strain = d->strain;
    spec.stress = d->stress;
  }
  Runs runs = {0};
  int status = BRECCIA_OK;
  for (int64_t s = 0; s < p->slices && !status && spec.components; ++s) {
    if (is_foreign(region->foreign, s * SLICE)) continue;
    if (on_particles) runs.rows = s * SLICE;
    status =
        on_particles ? add_rows(&runs, d->material[s], SLICE, error) : add_bonds(d, &region->bonds, s, &runs, error);
  }
  uint8_t *present = status ? NULL : memory_zeroed((size_t)runs.rows, 1, "points", error);
  if (!present) status = BRECCIA_FAILURE;
  for (int64_t i = 0; i < runs.rows && !status && on_particles; ++i)
    present[i] = p->number[i] >= 0 && !is_foreign(region->foreign, i);
  if (spec.on_bonds && !status) bond_list_mark(&region->bonds, &d->family, present);
  spec.runs = runs.runs;
  spec.run_count = runs.count;
  spec.present = present;
  if (!status && spec.components) status = region_place_rows(d, region, runs.rows, present, error);
  spec.places = region->places;
  spec.strength = on_particles ? d->strength : region->row_strength;
  if (!status) status = points_create(&region->points, &spec, error);
  for (int k = 0; k < 6 && on_particles; ++k) {
    d->strain[k] = region->points.strain[k];
    d->stress[k] = region->points.stress[k];
  }
  free(runs.runs);
  free(present);
  if (status || !may_give_up) return status;
  d->gave_up = on_particles ? region->points.gave_up : memory_zeroed((size_t)p->places, 1, "failed laws", error);
  return d->gave_up ? BRECCIA_OK : BRECCIA_FAILURE;
}
