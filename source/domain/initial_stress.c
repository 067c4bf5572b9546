#include "domain/initial_stress.h"

#include "base/tensor.h"
#include "loading/support.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void check_initial_stress(const DeckReader *reader, void *section)
{
  const InitialStressSpec *s = section;
  static const char *const of_ground[] = {"K0", "unit weight", "surcharge"};
  const double *values = s->stress.values;
  if (!values && isnan(s->k0))
    node_error(
        reader->document, s->head.node, reader->error,
        "initial stress: missing key 'K0': horizontal stress over vertical stress, often 1 - sin(friction angle)");
  for (int k = 0; k < 3 && values; ++k)
    if (node_get(s->head.node, of_ground[k]))
      node_error(reader->document, section_node(s, of_ground[k]), reader->error,
                 "%s: belongs to 'surface', not to 'stress'; leave it out", of_ground[k]);
  if (values && s->stress.count != 6)
    node_error(reader->document, section_node(s, "stress"), reader->error,
               "stress: expected six numbers, xx, yy, zz, xy, yz, zx; found %d", s->stress.count);
}

static const Field initial_stress_fields[] = {
    {.key = "on",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(InitialStressSpec, on),
     .standard = "",
     .meaning = "name of a selection, or a selection; the whole body when absent. Each particle is in one item at most",
     .section = &selection_section},
    {.key = "stress",
     .kind = FIELD_NUMBERS,
     .offset = offsetof(InitialStressSpec, stress),
     .dimension = "stress",
     .standard = "",
     .meaning = "the same everywhere: [xx, yy, zz, xy, yz, zx], tension positive",
     .group = 'A'},
    {.key = "surface",
     .kind = FIELD_NUMBER,
     .offset = offsetof(InitialStressSpec, surface),
     .dimension = "length",
     .standard = "",
     .meaning = "ground at rest below a level surface of this height, along z in space and y in the plane (against "
                "gravity, where that has another direction): vertical stress -(surcharge + unit weight times depth)",
     .group = 'A'},
    {.key = "K0",
     .kind = FIELD_NUMBER,
     .offset = offsetof(InitialStressSpec, k0),
     .dimension = "1",
     .standard = "",
     .range = "[0, 10]",
     .meaning = "of ground at rest: horizontal stress over vertical stress, in plane strain also across the plane"},
    {.key = "unit weight",
     .kind = FIELD_NUMBER,
     .offset = offsetof(InitialStressSpec, unit_weight),
     .dimension = "force per volume",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "of the ground; when absent its density times the gravity that acts when the run begins"},
    {.key = "surcharge",
     .kind = FIELD_NUMBER,
     .offset = offsetof(InitialStressSpec, surcharge),
     .dimension = "stress",
     .standard = "0",
     .range = "[0, inf)",
     .meaning = "pressure on the surface, also of layers above that have items of their own"},
};

const Section initial_stress_section = {
    .name = "initial stress",
    .about = "Stresses with which particles begin, without displacements. Laws begin at them; strains in results count "
             "from there. With correspondence and hybrid, whose bonds begin under the mean of both ends'.",
    .size = sizeof(InitialStressSpec),
    FIELDS(initial_stress_fields),
    .check = check_initial_stress};

/** What the particles of an item begin under. */
typedef struct Item {
  const InitialStressSpec *spec;
  double weight; /* per volume */
} Item;

typedef struct Work {
  Domain *domain;
  const DeckReader *reader;
  const SectionList *items;
  int32_t *item_of; /* [particles] by number; -1: none */
  double up[3], gravity;
  Item *item;        /* [items] */
  double *stress[6]; /* [places] */
} Work;

/** Gravity on the whole body when the run begins. */
static void find_gravity(Work *w, const Loading *loading)
{
  double sum[3] = {0};
  for (int n = 0; n < loading->count; ++n) {
    const Load *load = &loading->loads[n];
    const double *vector = load->spec->of[LOAD_gravity].point;
    if (load->first > 0 || load->spec->on.node || !node_get(load->spec->head.node, "gravity")) continue;
    for (int k = 0; k < 3; ++k) sum[k] += history_factor(&load->history, 0) * vector[k];
  }
  w->gravity = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  for (int k = 0; k < 3; ++k) w->up[k] = w->gravity > 0 ? -sum[k] / w->gravity : k == w->domain->body.dimensions - 1;
}

/** Notes whose particles are an item's. */
static int mark(Work *w, int n, const SectionList *selections)
{
  static const Node everywhere = {.kind = NODE_MAP};
  SelectionSpec all = {.head = {NULL, &everywhere}, .face = -1, .layers = 1, .nearest = {NAN, NAN, NAN}, .all = true};
  const InitialStressSpec *spec = w->items->items[n];
  const Body *body = &w->domain->body;
  Reference on = spec->on;
  if (!on.node) on = (Reference){NULL, &all, &everywhere};
  Selection selection = {0};
  int status = selection_create(&selection, body, w->reader, selections, &on);
  for (int64_t k = 0; k < selection.count && !status; ++k) {
    const Particles *p = &body->particles;
    const int32_t place = selection.places[k], number = p->number[place];
    const Region *region = domain_region(w->domain, place);
    const Material *m = &w->domain->materials[w->domain->material[place / SLICE]];
    const int before = w->item_of[number];
    if (region->points.components != 6)
      status =
          node_error(w->reader->document, spec->head.node, w->reader->error,
                     "initial stress: '%s' has no law for stress in space, as at particle %d at [%g, %g, %g]; expected "
                     "'formulation: correspondence' or 'hybrid', or a first stage 'laws: elastic' under the weight and "
                     "'displacements: zero' in the next one",
                     region->type->name, number, p->position[0][place], p->position[1][place], p->position[2][place]);
    else if (m->remote)
      status = node_error(w->reader->document, spec->head.node, w->reader->error,
                          "initial stress: the law of material '%s' runs in a server, which cannot be led to it; take "
                          "a law of this program, or a first stage under the weight",
                          m->name);
    else if (body_outside(body, number))
      status = node_error(w->reader->document, spec->head.node, w->reader->error,
                          "initial stress: layers outside a support follow the body inside; leave 'outside' out");
    else if (before >= 0)
      status = node_error(w->reader->document, spec->head.node, w->reader->error,
                          "initial stress: particle %d at [%g, %g, %g] has one already, of line %d; let the selections "
                          "under 'on' have no particle in common",
                          number, p->position[0][place], p->position[1][place], p->position[2][place],
                          ((const InitialStressSpec *)w->items->items[before])->head.node->line);
    w->item_of[number] = n;
  }
  selection_destroy(&selection);
  return status;
}

/** Components that a plane body cannot have. */
static int check_space(const Work *w, const InitialStressSpec *spec)
{
  const bool plane = w->domain->body.dimensions == 2, plane_stress = w->domain->regions[0].points.plane_stress;
  for (int k = 0; k < 6 && spec->stress.values; ++k) {
    const bool never = plane && (k == YZ || k == ZX), not_here = plane_stress && k == ZZ;
    if ((never || not_here) && spec->stress.values[k] != 0)
      return node_error(w->reader->document, section_node(spec, "stress"), w->reader->error,
                        "stress: %s is %g; expected 0 in %s", component_names[k], spec->stress.values[k],
                        plane_stress ? "plane stress" : "the plane");
  }
  return BRECCIA_OK;
}

/** Weight of the ground of an item, which has one density if nothing else tells it. */
static int find_weight(Work *w, int n)
{
  const InitialStressSpec *spec = w->items->items[n];
  const Particles *p = &w->domain->body.particles;
  Item *item = &w->item[n];
  *item = (Item){spec, spec->unit_weight};
  if (spec->stress.values || !isnan(spec->unit_weight)) return BRECCIA_OK;
  if (w->gravity == 0)
    return node_error(w->reader->document, section_node(spec, "surface"), w->reader->error,
                      "surface: no gravity acts on the whole body when the run begins, from which the weight would "
                      "follow; add 'gravity' to the loads, without a ramp, or say 'unit weight'");
  for (int32_t k = 0; k < p->count; ++k) {
    const int32_t place = p->place_of[k];
    if (w->item_of[k] != n) continue;
    const double weight = p->density[place] * w->gravity;
    if (!isnan(item->weight) && weight != item->weight)
      return node_error(w->reader->document, spec->head.node, w->reader->error,
                        "initial stress: its particles have unit weights of %g and %g; give each layer an item with "
                        "its own surface and what stands above as 'surcharge', or say 'unit weight'",
                        item->weight, weight);
    item->weight = weight;
  }
  return BRECCIA_OK;
}

/** Stress of an item at a place, which may lie outside the body. */
static int find_stress(const Work *w, const Item *item, int32_t place, bool outside, double stress[6])
{
  const InitialStressSpec *spec = item->spec;
  const Particles *p = &w->domain->body.particles;
  double height = 0;
  for (int k = 0; k < 6 && spec->stress.values; ++k) stress[k] = spec->stress.values[k];
  if (spec->stress.values) return BRECCIA_OK;
  for (int k = 0; k < 3; ++k) height += w->up[k] * p->position[k][place];
  const double depth = spec->surface - height;
  if (depth < -1e-6 * w->domain->body.largest_spacing && !outside)
    return node_error(w->reader->document, section_node(spec, "surface"), w->reader->error,
                      "surface: particle %d at [%g, %g, %g] stands %g above it; select the particles below with 'on', "
                      "or raise the surface",
                      p->number[place], p->position[0][place], p->position[1][place], p->position[2][place], -depth);
  const double vertical = -spec->surcharge - item->weight * fmax(0, depth), across = spec->k0 * vertical;
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], s = symmetric_column[k];
    stress[k] = (r == s ? across : 0) + (vertical - across) * w->up[r] * w->up[s];
  }
  if (w->domain->regions[0].points.plane_stress) stress[ZZ] = 0;
  return BRECCIA_OK;
}

static int fill(const Work *w)
{
  const Body *body = &w->domain->body;
  for (int32_t n = 0; n < body->particles.count; ++n) {
    const int32_t place = body->particles.place_of[n];
    bool slides[3] = {false};
    int32_t inside = n;
    for (; body_outside(body, inside); inside = body->image_of[inside]) {
      const Margin *margin = &body->margins.items[body->margin_of[inside]];
      slides[margin->axis] |= support_slides(margin);
    }
    if (w->item_of[inside] < 0) continue;
    double stress[6] = {0};
    if (find_stress(w, &w->item[w->item_of[inside]], place, inside != n, stress)) return BRECCIA_USER_ERROR;
    for (int k = 0; k < 6; ++k) {
      const int r = symmetric_row[k], s = symmetric_column[k];
      w->stress[k][place] = r != s && slides[r] != slides[s] ? 0 - stress[k] : stress[k]; /* no -0 in messages */
    }
  }
  return BRECCIA_OK;
}

/** @param[in] place, stress  of the point whose law does not bear it */
static void tell_misfit(const Work *w, int64_t place, const double stress[6], const InitialMisfit *misfit)
{
  const Particles *p = &w->domain->body.particles;
  const int64_t inside = body_original(&w->domain->body, p->number[place]);
  const InitialStressSpec *spec = w->items->items[w->item_of[inside]];
  const Material *m = points_material(&domain_region(w->domain, place)->points, misfit->row);
  Text words[2] = {{0}, {0}};
  for (int k = 0; k < 6; ++k) {
    text_add(&words[0], "%s%g", k ? ", " : "", stress[k]);
    text_add(&words[1], "%s%g", k ? ", " : "", misfit->reached[k]);
  }
  node_error(
      w->reader->document, spec->head.node, w->reader->error,
      "initial stress: the law %s of material '%s' does not bear [%s] of particle %d at [%g, %g, %g]%s, it comes to "
      "[%s]; give a stress within its strength",
      m->law_name, m->name, text_words(&words[0]), p->number[place], p->position[0][place], p->position[1][place],
      p->position[2][place],
      inside == p->number[place] ? "" : ", outside a support, where the ground goes on with its depth",
      text_words(&words[1]));
  text_free(&words[0]);
  text_free(&words[1]);
}

static int begin_on_particles(Work *w, Region *region)
{
  Domain *d = w->domain;
  Error *error = w->reader->error;
  InitialMisfit misfit;
  double stress[6];
  for (int k = 0; k < 6 && !d->initial_strain[k]; ++k)
    if (!(d->initial_strain[k] = places_array(d->particles->places, "initial stress", error))) return BRECCIA_FAILURE;
  const int status = points_begin_under(&region->points, w->stress, d->initial_strain, &misfit, error);
  if (misfit.row < 0) return status;
  for (int k = 0; k < 6; ++k) stress[k] = w->stress[k][misfit.row];
  tell_misfit(w, misfit.row, stress, &misfit);
  return status;
}

/** The ends of the bond of a row. */
static void find_ends(const Domain *d, const Region *region, int64_t slice, int64_t row, int64_t ends[2])
{
  int64_t slot;
  int lane;
  bond_list_bond(&region->bonds, &d->family, slice, row, &slot, &lane);
  ends[0] = slice * SLICE + lane;
  ends[1] = family_bond(&d->family, slice, slot, lane).neighbour;
}

/** Points on bonds, which stand in their middles.
 *  @param[out] stress  [6][rows]. @param[in] present  [rows] */
static int begin_on_bonds(Work *w, Region *region, double *const stress[6], const uint8_t *present)
{
  const Domain *d = w->domain;
  const int64_t *first = region->bonds.first;
  int64_t ends[2], slice = 0;
  InitialMisfit misfit;
  for (; slice < d->particles->slices; ++slice)
    for (int64_t row = first[slice]; row < first[slice + 1]; ++row) {
      if (!present[row]) continue;
      find_ends(d, region, slice, row, ends);
      for (int k = 0; k < 6; ++k) stress[k][row] = 0.5 * (w->stress[k][ends[0]] + w->stress[k][ends[1]]);
    }
  const int status = points_begin_under(&region->points, stress, region->initial, &misfit, w->reader->error);
  if (misfit.row < 0) return status;
  double given[6];
  for (slice = 0; first[slice + 1] <= misfit.row;) ++slice;
  find_ends(d, region, slice, misfit.row, ends);
  for (int k = 0; k < 6; ++k) given[k] = stress[k][misfit.row];
  const bool told = w->item_of[body_original(&d->body, d->particles->number[ends[0]])] >= 0;
  tell_misfit(w, ends[!told], given, &misfit);
  return status;
}

static int begin_region(Work *w, Region *region)
{
  Error *error = w->reader->error;
  double *stress[6] = {NULL};
  if (region->points.components != 6) return BRECCIA_OK;
  if (points_on_particles(&region->points)) return begin_on_particles(w, region);
  uint8_t *present = memory_zeroed((size_t)region->points.count, 1, "initial stress", error);
  int status = present ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int k = 0; k < 6 && !status; ++k) {
    stress[k] = places_array(region->points.count, "initial stress", error);
    region->initial[k] = places_array(region->points.count, "initial stress", error);
    if (!stress[k] || !region->initial[k]) status = BRECCIA_FAILURE;
  }
  if (!status) {
    bond_list_mark(&region->bonds, &w->domain->family, present);
    status = begin_on_bonds(w, region, stress, present);
  }
  for (int k = 0; k < 6; ++k) places_free(&stress[k]);
  free(present);
  return status;
}

/** How many particles of the body begin under stress, and between which means. */
static void count_stressed(const Work *w)
{
  Domain *d = w->domain;
  d->least_mean = INFINITY;
  d->largest_mean = -INFINITY;
  for (int32_t n = 0; n < d->particles->count; ++n) {
    const int32_t place = d->particles->place_of[n];
    bool any = false;
    for (int k = 0; k < 6; ++k) any |= w->stress[k][place] != 0;
    if (!any || body_outside(&d->body, n)) continue;
    const double mean = (w->stress[XX][place] + w->stress[YY][place] + w->stress[ZZ][place]) / 3;
    d->least_mean = fmin(d->least_mean, mean);
    d->largest_mean = fmax(d->largest_mean, mean);
    ++d->stressed;
  }
}

static int begin(Work *w, const Loading *loading, const SectionList *selections)
{
  Domain *d = w->domain;
  Error *error = w->reader->error;
  const Particles *p = d->particles;
  w->item_of = memory_zeroed((size_t)p->count, sizeof *w->item_of, "initial stress", error);
  w->item = memory_zeroed((size_t)w->items->count, sizeof *w->item, "initial stress", error);
  for (int k = 0; k < 6; ++k)
    if (!(w->stress[k] = places_array(p->places, "initial stress", error))) return BRECCIA_FAILURE;
  if (!w->item_of || !w->item) return BRECCIA_FAILURE;
  for (int32_t n = 0; n < p->count; ++n) w->item_of[n] = -1;
  find_gravity(w, loading);
  int status = BRECCIA_OK;
  for (int n = 0; n < w->items->count && !status; ++n) {
    status = mark(w, n, selections);
    if (!status) status = check_space(w, w->items->items[n]);
    if (!status) status = find_weight(w, n);
  }
  if (!status) status = fill(w);
  for (int r = 0; r < d->region_count && !status; ++r) status = begin_region(w, &d->regions[r]);
  if (status) return status;
  count_stressed(w);
  domain_evaluate(d, NULL);
  d->initial_energy = domain_stored_energy(d);
  return BRECCIA_OK;
}

/** Sets the energy stored at the start: uniaxial laws may have stress at zero strain. */
static int store_by_laws(Domain *d)
{
  bool may = false;
  for (int r = 0; r < d->region_count; ++r) may |= d->regions[r].points.components == 1;
  if (!may) return BRECCIA_OK;
  domain_evaluate(d, NULL);
  d->initial_energy = domain_stored_energy(d);
  return BRECCIA_OK;
}

int domain_begin_under(Domain *d, const Loading *loading, const DeckReader *reader, const SectionList *items,
                       const SectionList *selections)
{
  if (!items->count) return store_by_laws(d);
  Work work = {.domain = d, .reader = reader, .items = items};
  const int status = begin(&work, loading, selections);
  for (int k = 0; k < 6; ++k) places_free(&work.stress[k]);
  free(work.item_of);
  free(work.item);
  return status;
}
