/* Strains that a body would take where nothing hindered it, as loads say them: shrinkage, warming (docs/theory.md 7.3).
 *
 * Each place has one, alike in all directions. Laws of six strains are given what is left of the strain of displacements. Where formulations see
 * bonds along the plane only, in plane strain, bonds are free of stress at a strain larger by Poisson's ratio, as what cannot go across the plane goes
 * along it. A bond has the mean of both ends'.
 *
 * As a free strain changes, stresses do work on it, which is neither that of displacements nor of loads: minus the sum over places of what a stress
 * counts for there (`tension`) times the change, by the trapezium rule. It is looked at only while free strains change. */
#include "domain/domain.h"

#include "bars/bars.h"
#include "base/team.h"
#include "base/tensor.h"
#include "loading/load.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Strain of bonds along the plane at which they are free of stress, over the free strain. */
static double in_plane(const Domain *d, int64_t place)
{
  const Region *region = domain_region(d, place);
  const bool plane_strain = d->body.dimensions == 2 && !region->points.plane_stress;
  if (!plane_strain) return 1;
  return 1 + (region->type->components == 1 ? 0.25 : material_poisson(&d->materials[d->material[place / SLICE]]));
}

/** Rows of the points of a region: what stands beside the strain of displacements, without free strains and with them. */
static void share_rows(Domain *d, Region *region, int64_t slice)
{
  const double *given = d->strains.given, *natural = d->particles->free_strain;
  Points *points = &region->points;
  if (points_on_particles(points)) {
    for (int64_t i = slice * SLICE; i < (slice + 1) * SLICE; ++i)
      for (int k = 0; k < (d->initial_strain[0] ? 3 : 1); ++k)
        region->beside[k][i] = (d->initial_strain[k] ? d->initial_strain[k][i] : 0) - given[i];
    return;
  }
  const double *of = points->components == 6 ? given : natural;
  for (int64_t row = region->bonds.first[slice]; row < region->bonds.first[slice + 1]; ++row) {
    int64_t slot;
    int lane;
    bond_list_bond(&region->bonds, &d->family, slice, row, &slot, &lane);
    const int64_t other = family_bond(&d->family, slice, slot, lane).neighbour;
    const double mean = 0.5 * (of[slice * SLICE + lane] + of[other]);
    for (int k = 0; k < (region->initial[0] ? 3 : 1); ++k)
      region->beside[k][row] = (region->initial[k] ? region->initial[k][row] : 0) - mean;
  }
}

/** What formulations and points read of free strains. */
static void share(Domain *d)
{
  Particles *p = d->particles;
  double *given = d->strains.given;
  for (int32_t n = 0; n < p->count; ++n)
    if (body_outside(&d->body, n)) given[p->place_of[n]] = given[p->place_of[body_original(&d->body, n)]];
  for (int64_t i = 0; i < p->places; ++i) p->free_strain[i] = p->number[i] < 0 ? 0 : in_plane(d, i) * given[i];
  for (int r = 0; r < d->region_count; ++r) {
    Region *region = &d->regions[r];
    if (!region->beside[0]) continue;
    for (int64_t slice = 0; slice < p->slices; ++slice)
      if (!is_foreign(region->foreign, slice * SLICE)) share_rows(d, region, slice);
  }
}

static int make_rows(Domain *d, Region *region, Error *error)
{
  Points *points = &region->points;
  if (!points->components) return BRECCIA_OK;
  const bool under_stress = points->initial[0] != NULL;
  for (int k = 0; k < (under_stress ? 3 : 1); ++k)
    if (!(region->beside[k] = places_array(points->count, "free strains", error))) return BRECCIA_FAILURE;
  for (int k = 0; k < (points->components == 6 ? 3 : 1); ++k) points->initial[k] = region->beside[under_stress ? k : 0];
  (void)d;
  return BRECCIA_OK;
}

static LoadStrains of_loads(const Domain *d)
{
  const Bars *bars = bars_among(&d->forces);
  return (LoadStrains){.of_places = d->strains.given,
                       .places = d->particles->places,
                       .of_bars = bars ? bars->prestrain : NULL,
                       .bar_count = bars ? bars->specs->count : 0};
}

/** The sum of the squares of bond lengths of a place, by volume. */
static double squares_of_bonds(const Domain *d, int64_t place)
{
  const Family *f = &d->family;
  const int64_t slice = place / SLICE;
  double squares = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    squares += d->particles->volume[bond.neighbour] * bond.length * bond.length;
  }
  return squares;
}

int domain_take_loads(Domain *d, Loading *loading, const DeckReader *reader)
{
  Error *error = reader->error;
  Strains *s = &d->strains;
  s->loading = loading;
  if (domain_check_strength(d, loading, reader)) return BRECCIA_USER_ERROR;
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    s->any |= load->type->strain != NULL;
    for (int r = 0; load->type == &initial_strain_load && r < d->region_count; ++r) {
      const Region *region = &d->regions[r];
      const char *reason = region->type->strain_free ? region->type->strain_free(region->formulation) : NULL;
      if (reason) return node_error(reader->document, load->node, error, "initial strain: %s", reason);
    }
  }
  if (!d->is_strained) return BRECCIA_OK;
  double **const arrays[] = {&s->given, &s->held, &s->growth, &s->tension, &s->tension_now, &d->particles->free_strain};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
    if (!(*arrays[k] = places_array(d->particles->places, "free strains", error))) return BRECCIA_FAILURE;
  for (int r = 0; r < d->region_count; ++r)
    if (make_rows(d, &d->regions[r], error)) return BRECCIA_FAILURE;
  share(d);
  s->known = !d->begins_under_stress; /* else laws are led to their stress first */
  for (int64_t n = 0; n < d->particles->count; ++n)
    s->whole = fmax(s->whole, squares_of_bonds(d, d->particles->place_of[n]));
  return BRECCIA_OK;
}

void domain_strains_destroy(Domain *d)
{
  Strains *s = &d->strains;
  double **const arrays[] = {&s->given, &s->held, &s->growth, &s->tension, &s->tension_now};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k) places_free(arrays[k]);
  for (int r = 0; r < d->region_count; ++r)
    for (int k = 0; k < 3; ++k) places_free(&d->regions[r].beside[k]);
}

/* ---- work ---- */

/** What the free strain of a place would take by growing by 1. */
static double tension_at(const Domain *d, int64_t place)
{
  const Region *region = domain_region(d, place);
  const Family *f = &d->family;
  const Particles *p = d->particles;
  const int64_t slice = place / SLICE;
  double sum = 0;
  if (!(d->counted[place] > 0)) return 0;
  if (region->type->free_tension) return region->type->free_tension(region->formulation, place);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    double state[3], along = 0, square = 0;
    region->type->half_state(region->formulation, p->displacement.row, NULL, slice, slot, (int)(place % SLICE), state);
    for (int k = 0; k < 3; ++k) {
      const double y = bond.xi[k] + p->displacement.row[k][bond.neighbour] - p->displacement.row[k][place];
      along += state[k] * y;
      square += y * y;
    }
    if (square > 0) sum += p->volume[bond.neighbour] * along / sqrt(square) * bond.length;
  }
  return d->counted[place] * in_plane(d, place) * sum;
}

typedef struct Looked {
  Domain *domain;
  double *tension;
} Looked;

static void look_at_batch(void *context, int64_t b)
{
  const Looked *of = context;
  for (int64_t i = of->domain->batches[b].first * SLICE; i < of->domain->batches[b].last * SLICE; ++i)
    of->tension[i] = of->domain->particles->number[i] < 0 ? 0 : tension_at(of->domain, i);
}

void domain_tell_strains(Domain *d, double time)
{
  Strains *s = &d->strains;
  if (!s->loading) return;
  d->particles->free_growth = NULL;
  const LoadStrains strains = of_loads(d);
  if (!loading_strain(s->loading, &strains, time) || !s->given) return;
  Looked of = {d, s->tension};
  for (int64_t b = 0; b < d->batch_count && !s->known; ++b) look_at_batch(&of, b); /* with stresses as they were */
  s->known = 1;
  share(d);
}

void domain_halve_strains(Domain *d)
{
  Strains *s = &d->strains;
  const int64_t places = d->particles->places;
  if (!s->given || !memcmp(s->given, s->held, sizeof(double) * (size_t)places)) return;
  for (int64_t i = 0; i < places; ++i) {
    s->growth[i] = s->given[i] - s->held[i];
    s->given[i] -= s->growth[i] / 2;
  }
  d->particles->free_growth = s->growth;
  share(d);
  loading_forget_strains(s->loading);
}

void domain_book_strains(Domain *d)
{
  Strains *s = &d->strains;
  const size_t size = sizeof(double) * (size_t)d->particles->places;
  if (!s->given) return;
  if (!memcmp(s->given, s->held, size)) {
    s->known = 0;
    return;
  }
  team_each(d->batch_count, look_at_batch, &(Looked){d, s->tension_now});
  for (int64_t b = 0; b < d->batch_count; ++b) {
    double part = 0;
    for (int64_t i = d->batches[b].first * SLICE; i < d->batches[b].last * SLICE; ++i)
      part += 0.5 * (s->tension[i] + s->tension_now[i]) * (s->given[i] - s->held[i]);
    s->work -= part;
  }
  memcpy(s->held, s->given, size);
  memcpy(s->tension, s->tension_now, size);
  s->known = 1;
}

double domain_strain_work(const Domain *d)
{
  return d->strains.work + forces_given(&d->forces);
}

/* ---- forces ---- */

/** Forces elastically, at displacements and strains as they stand, by a factor. */
static int add_elastic_forces(Domain *d, double factor, const Vector *force, Error *error)
{
  domain_evaluate(d, NULL);
  if (!isfinite(d->force_sum)) {
    const char *stuck = forces_stuck(&d->forces, NULL);
    if (stuck)
      return error_add(error, BRECCIA_USER_ERROR,
                       "quasi-static: the period by which loads should grow is not known, as bar '%s' finds no "
                       "equilibrium under all of their strains at once; give a 'period'",
                       stuck);
    return error_add(error, BRECCIA_USER_ERROR,
                     "quasi-static: the period by which loads should grow is not known, as forces are no numbers under "
                     "all of their strains at once; give a 'period'");
  }
  vector_combine(1, force, factor, &d->particles->internal);
  return BRECCIA_OK;
}

/** Room for as many strains as loads put, zero; `free_strains_of` in any case. */
static int make_strains(const Domain *d, LoadStrains *strains, Error *error)
{
  const LoadStrains put = of_loads(d);
  *strains = (LoadStrains){.places = put.places, .bar_count = put.bar_count};
  if (put.of_places) strains->of_places = memory_zeroed((size_t)put.places, sizeof(double), "free strains", error);
  if (put.of_bars) strains->of_bars = memory_zeroed((size_t)put.bar_count, sizeof(double), "free strains", error);
  return (put.of_places && !strains->of_places) || (put.of_bars && !strains->of_bars) ? BRECCIA_FAILURE : BRECCIA_OK;
}

static void free_strains_of(LoadStrains *strains)
{
  free(strains->of_places);
  free(strains->of_bars);
}

/** Copies strains; true if they were others. */
static bool copy_strains(const LoadStrains *from, const LoadStrains *to)
{
  const size_t of_places = sizeof(double) * (size_t)to->places, of_bars = sizeof(double) * (size_t)to->bar_count;
  const bool others = (to->of_places && memcmp(to->of_places, from->of_places, of_places) != 0) ||
                      (to->of_bars && memcmp(to->of_bars, from->of_bars, of_bars) != 0);
  if (to->of_places) memcpy(to->of_places, from->of_places, of_places);
  if (to->of_bars) memcpy(to->of_bars, from->of_bars, of_bars);
  return others;
}

int domain_add_grown_strains(Domain *d, double time, const Vector *force, Error *error)
{
  Strains *s = &d->strains;
  const LoadStrains put = of_loads(d);
  LoadStrains now = {0}, grown = {0};
  if (!s->loading || !s->any) return BRECCIA_OK;
  int status = make_strains(d, &now, error);
  if (!status) status = make_strains(d, &grown, error);
  if (!status) {
    loading_grown_strains(s->loading, &grown, time);
    copy_strains(&put, &now);
  }
  if (!status && copy_strains(&grown, &put)) {
    const bool elastic = domain_in_elastic_stage(d);
    domain_set_elastic_stage(d, true);
    if (s->given) share(d);
    status = add_elastic_forces(d, 1, force, error);
    copy_strains(&now, &put);
    if (s->given) share(d);
    if (!status) status = add_elastic_forces(d, -1, force, error);
    domain_set_elastic_stage(d, elastic);
  }
  free_strains_of(&now);
  free_strains_of(&grown);
  return status;
}

/** Stress, alike in all directions that the body has, that takes away a free strain. */
static double stress_against(const Domain *d, int64_t place, double strain)
{
  const Material *m = &d->materials[d->material[place / SLICE]];
  const Region *region = domain_region(d, place);
  if (d->body.dimensions == 1) return material_young(m) * strain;
  if (!region->points.plane_stress) return 3 * m->bulk * strain;
  return material_young(m) / (1 - (region->type->components == 1 ? 1.0 / 3 : material_poisson(m))) * strain;
}

typedef struct Slope {
  Domain *domain;
  const double *stress; /* [places] */
} Slope;

/** Size of the force on a place. */
static double force_of_slope(const Slope *of, int64_t place)
{
  const Family *f = &of->domain->family;
  const int64_t slice = place / SLICE;
  double force[3] = {0};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    const double both =
        of->domain->particles->volume[bond.neighbour] * (of->stress[place] + of->stress[bond.neighbour]);
    for (int k = 0; k < 3; ++k) force[k] += both * bond.xi[k];
  }
  return of->domain->counted[place] * sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

static void add_forces_of_batch(void *context, int64_t b)
{
  const Slope *of = context;
  Domain *d = of->domain;
  d->batch_sum[b] = 0;
  for (int64_t i = d->batches[b].first * SLICE; i < d->batches[b].last * SLICE; ++i)
    if (d->counted[i] > 0) d->batch_sum[b] += force_of_slope(of, i);
}

/** By the slope of the stress against them, as whole families see it (of linear stresses exactly): nothing within an evenly shrinking body on a lattice, and at its
 *  faces that stress. Within bodies whose particles stand anywhere neighbours do not quite balance each other, which adds up over the volume.
 *  @param[in,out] strain  [places], that stress in the end */
static double forces_of_free_strains(Domain *d, double *strain)
{
  double sum = 0;
  bool any = false;
  for (int64_t i = 0; i < d->particles->places; ++i) {
    any |= strain[i] != 0;
    if (strain[i] != 0) strain[i] = stress_against(d, i, strain[i]);
  }
  if (!any || !(d->strains.whole > 0)) return 0;
  team_each(d->batch_count, add_forces_of_batch, &(Slope){d, strain});
  for (int64_t b = 0; b < d->batch_count; ++b) sum += d->batch_sum[b];
  return sum * d->body.dimensions / d->strains.whole;
}

int domain_forces_of_strains(Domain *d, double begin, double time, double *sum, Error *error)
{
  LoadStrains strains = {0};
  *sum = 0;
  if (!d->strains.loading || !d->strains.any) return BRECCIA_OK;
  const int status = make_strains(d, &strains, error);
  if (!status) {
    loading_changed_strains(d->strains.loading, &strains, begin, time);
    if (strains.of_places) *sum += forces_of_free_strains(d, strains.of_places);
    if (strains.of_bars) *sum += bars_prestress_forces(bars_among(&d->forces), strains.of_bars);
  }
  free_strains_of(&strains);
  return status;
}

/* ---- state ---- */

void domain_follow_strains(Domain *d)
{
  if (d->strains.loading) loading_forget_strains(d->strains.loading);
  if (!d->strains.given) return;
  memcpy(d->strains.held, d->strains.given, sizeof(double) * (size_t)d->particles->places);
  share(d);
}

static int resume(void *owner, const double *numbers, int64_t count, Error *error)
{
  (void)numbers, (void)count, (void)error;
  domain_follow_strains(owner);
  return BRECCIA_OK;
}

void domain_strains_state(Domain *d, StateList *list)
{
  static const StateCare care = {.resume = resume};
  Strains *s = &d->strains;
  if (!s->given) return;
  StateRow row = {.unit = "energy",
                  .kind = STATE_NUMBERS,
                  .entity = STATE_OF_PLACE,
                  .role = STATE_COMMITTED,
                  .count = d->particles->places,
                  .values = s->tension};
  state_add(list, &row, "tension of free strains", NULL);
  state_add_count(list, "tension is known", STATE_COMMITTED, &s->known);
  state_add_number(list, "work on free strains", "energy", STATE_COMMITTED, &s->work);
  row.unit = "1";
  row.role = STATE_TRIED;
  row.values = s->given;
  row.care = &care;
  row.owner = d;
  state_add(list, &row, "free strain", NULL);
}
