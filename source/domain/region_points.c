/* Points of a region: on its particles or on its bonds, in runs of one material. */
#include "base/memory.h"
#include "constitutive/min_max.h"
#include "domain/regions.h"

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
