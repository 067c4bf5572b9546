/* Loads that are hardly meant, and ground that begins out of balance. */
#include "model/plausibility_parts.h"

#include "base/memory.h"
#include "base/tensor.h"
#include "body/nearer.h"
#include "failure/critical_stretch.h"
#include "loading/load/water_pressure.h"
#include "solver/explicit.h"
#include "solver/implicit.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- loads ---- */

/** A prescribed displacement that is there at once gives its particles a speed of one displacement per step, and no increment of statics can be cut
 *  to less of it; at rest an elastic body has nothing against it. */
static void check_jump(breccia_model *model, const Load *load)
{
  const LoadSpec *l = load->spec;
  const double start = fabs(load_magnitude(l) * history_factor(&load->history, 0));
  if ((!plausibility_is_kind(l, "displacement") && !plausibility_is_kind(l, "support")) || start == 0) return;
  if (model->solver.type->rests && model->solver.stages->count == 1 && domain_is_elastic(&model->domain)) return;
  char length[32];
  units_name(model->units, dimension_find("length"), length, sizeof length);
  plausibility_say(
      model, load->node,
      "displacement: the particles jump by %.4g %s in the first step; let it grow, like 'history: {ramp to: ...}'",
      start, length);
}

/** Earthquakes stay below 3 g; a record in g acts on a load of 1 g, one in cm/s2 on one of 1 cm/s2. */
static void check_shaking(breccia_model *model, const Load *load)
{
  static const double most = 30, gravity = 9.81; /* m/s2 */
  if (!plausibility_is_kind(load->spec, "base acceleration") && !plausibility_is_kind(load->spec, "acceleration") &&
      !plausibility_is_kind(load->spec, "outcrop acceleration"))
    return;
  const double peak = fabs(plausibility_in_si(model, "acceleration", load_magnitude(load->spec)) *
                           history_peak(&load->history, model->solver.clock.end_time - load->begin));
  if (peak > most)
    plausibility_say(
        model, load->node,
        "%s: its peak is %.3g m/s2, %.3g times gravity; earthquakes stay below 3: look at the unit of the record, the "
        "load's value is what 1 in it means",
        load->node->key, peak, peak / gravity);
}

/** Adds a line where several particles are equally near to a point that a load acts at. */
static void loads_describe_point(const breccia_model *model, const Load *load, const SelectionSpec *on, Text *text)
{
  const Body *body = &model->domain.body;
  const Particles *p = &body->particles;
  const int32_t taken = body_nearest(body, on->nearest);
  int count = 0;
  double least = 0;
  for (int k = 0; k < 3; ++k)
    least += (p->position[k][taken] - on->nearest[k]) * (p->position[k][taken] - on->nearest[k]);
  for (int64_t n = 0; n < p->count; ++n) {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double away = p->position[k][p->place_of[n]] - on->nearest[k];
      square += away * away;
    }
    count += !body_outside(body, n) && !is_nearer(least, square);
  }
  if (count < 2) return;
  text_add(text,
           "  load in line %d: %d particles are equally near to its point; it acts on that of the lowest number, at "
           "[%g, %g, %g]\n",
           load->spec->head.node->line, count, p->position[0][taken], p->position[1][taken], p->position[2][taken]);
}

/** Goes through a selection and those that it is made of. */
static void loads_describe_points(const breccia_model *model, const Load *load, const SelectionSpec *on, Text *text)
{
  if (!on) return;
  if (!isnan(on->nearest[0])) loads_describe_point(model, load, on, text);
  for (int k = 0; k < on->any_of.count; ++k)
    loads_describe_points(model, load, selection_spec(&model->spec->selections, &on->any_of.items[k]), text);
  for (int k = 0; k < on->all_of.count; ++k)
    loads_describe_points(model, load, selection_spec(&model->spec->selections, &on->all_of.items[k]), text);
}

void plausibility_describe_middle(const breccia_model *model, const Load *load, Text *text)
{
  loads_describe_points(model, load, selection_spec(&model->spec->selections, &load->spec->on), text);
}

/** Whoever lets the ground settle first must hold it by something else. */
static void check_dashpots(breccia_model *model, const Load *load)
{
  if (load->type->brake && solver_stage_rests(&model->solver, load->first))
    plausibility_say(model, load->node,
                     "%s: they hold nothing in a stage at rest; let a support or a prescribed motion hold the body "
                     "there, and dashpots begin with the stage that shakes",
                     load->node->key);
}

/** Fluids that press on faces are lighter than lava and heavier than petrol; and dams do not stand at the bottom of seas. */
static void check_water(breccia_model *model, const Load *load)
{
  static const UnitMeant weights[] = {{"N/m3", 1}, {"kN/m3", 1e3}, {"MN/m3", 1e6}};
  const double most = 20; /* of the body's height */
  if (load->type != &water_pressure_load) return;
  const WaterPressureSpec *water = load->value->section;
  plausibility_beyond(model, section_node(water, "unit weight"), "unit weight", "force per volume", water->unit_weight,
                      5e3, 30e3, "N/m3", weights, 3, 9e3, 12e3);
  const Body *body = &model->domain.body;
  const int up = body->dimensions - 1;
  const double *height = body->particles.position[up];
  double top = -INFINITY;
  for (int64_t n = 0; n < load->selection.count; ++n) top = fmax(top, height[load->selection.places[n]]);
  const double tall = body->high[up] - body->low[up] + body->coarsest->plane[up], above = water->surface - top;
  if (above <= most * tall) return;
  char length[64];
  units_name(model->units, dimension_find("length"), length, sizeof length);
  plausibility_say(model, section_node(water, "surface"),
                   "surface: the water stands %.4g %s above the face, %.3g times the height of the body: look at its "
                   "unit; it is a height, not a depth",
                   above, length, above / tall);
}

double plausibility_time_of_load(const breccia_model *model, const Load *load)
{
  const Solver *s = &model->solver;
  double time = 0;
  for (int64_t k = load->first; k < s->clock.stages && k < load->behind; ++k)
    time += k == s->clock.stage ? s->clock.stage_end - s->clock.stage_time : model_stage_time(model, k);
  return time;
}

/** A load that is to grow for longer than it acts never comes to its full value. */
static void check_growth(breccia_model *model, const Load *load)
{
  const History *h = &load->history;
  const bool table = h->value_node && !strcmp(h->value_node->key, "table");
  if (!table && !(h->value_node && !strcmp(h->value_node->key, "ramp to"))) return;
  const double time = plausibility_time_of_load(model, load),
               grown = table ? h->line.rows[2 * (h->line.count - 1)] : h->value->number;
  const double largest = history_peak(h, grown);
  if (!(time < (1 - 1e-9) * grown) || fabs(history_peak(h, time)) >= (1 - 1e-9) * fabs(largest)) return;
  char unit[64];
  units_name(model->units, dimension_find("time"), unit, sizeof unit);
  plausibility_say(model, h->value_node,
                   "%s: the load ends at %.3g of its value and never comes to %.3g: it acts for %.4g %s, and its "
                   "history goes on to %.4g %s; let it grow sooner, or the last stage end later",
                   h->value_node->key, history_factor(h, time), largest, time, unit, grown, unit);
}

/** Whether a load takes the place of one of its name that acted in the stage before. */
static bool goes_on_by_name(const breccia_model *model, const Load *load)
{
  for (int k = 0; k < model->loading.count; ++k)
    if (load->first > 0 && model->loading.loads[k].behind == load->first && load->spec->name &&
        model->loading.loads[k].spec->name && !strcmp(model->loading.loads[k].spec->name, load->spec->name))
      return true;
  return false;
}

/** Whether a stage looks for a state of rest, or lets nothing swing, or nothing yield by it. */
static bool settles(const breccia_model *model, int64_t number)
{
  const double strong = 0.5; /* of critical: 0.16 beyond the state of rest */
  const SolveSpec *stage = model->solver.stages->items[number];
  const ExplicitSpec *steps = stage->of[SOLVER_explicit];
  const ImplicitSpec *implicit = stage->of[SOLVER_implicit];
  if (solver_stage_rests(&model->solver, number) || stage->laws == LAWS_ELASTIC) return true;
  if (steps && (!isnan(steps->rest) || steps->local_damping > 0)) return true;
  const DampingKeys *keys = steps ? &steps->damping_given : implicit ? &implicit->damping_given : NULL;
  return keys && damping_ratio(keys) >= strong;
}

/** Strains that a body in motion begins from at once: nobody means the waves and the swinging of tendons that are let go in no time, or of shrinkage. */
static void check_sudden_strain(breccia_model *model, const Load *load)
{
  const Solver *s = &model->solver;
  const bool grows = !isnan(solver_stage_steady(s, load->first)) && !load->spec->history; /* by 'quasi-static' */
  if (!load->type->strain || settles(model, load->first) || grows || goes_on_by_name(model, load)) return;
  if (load_magnitude(load->spec) * history_factor(&load->history, 0) == 0) return;
  plausibility_say(model, load->node,
                   "%s: it acts at once: without much damping displacements first reach about twice those at rest; let "
                   "it grow over some periods, like 'history: {ramp to: ...}', or take 'quasi-static', or a stage of "
                   "'static'",
                   load->node->key);
}

/** Implicit steps follow the waves that a jump of a force sets off, as errors of steps are measured by displacements that have not grown yet. */
static void check_sudden(breccia_model *model, const Load *load)
{
  const double all = 1; /* the share by which the first step after a jump errs, whatever its length */
  const LoadType *type = load->type;
  if (model_stage_error(model, load->first) > all || !type->force || type->brake || type->energy || type->goes_on)
    return;
  if (goes_on_by_name(model, load)) return;
  if (load_magnitude(load->spec) * history_factor(&load->history, 0) == 0) return;
  if (load->first == 0 && model->spec->initial_stress.count) return; /* which it may balance from the beginning */
  plausibility_say(model, load->node,
                   "%s: it acts at once, so that 'local error' cuts the first implicit steps to a hundredth and less, "
                   "to follow the waves of the jump; let it grow over some steps, like 'history: {ramp to: ...}', or "
                   "take 'local error: 10', which leaves steps as long as they are and these waves out",
                   load->node->key);
}

/** Concrete shrinks by less than 1e-3; steel warms by as much in 80 K. */
static void check_initial_strain(breccia_model *model, const Load *load)
{
  const double most = 0.01;
  if (!plausibility_is_kind(load->spec, "initial strain")) return;
  const double peak =
      load_magnitude(load->spec) * history_peak(&load->history, model->solver.clock.end_time - load->begin);
  if (fabs(peak) > most)
    plausibility_say(
        model, load->node,
        "initial strain: %.3g of all lengths; concrete shrinks by some 5e-4, and a kelvin is 1e-5: give the "
        "strain as a plain number, like -3e-4",
        peak);
}

/** Bonds near particles that are moved carry most, and break there first. */
static void check_grips(breccia_model *model)
{
  const Domain *d = &model->domain;
  const FailureSpec *failure = model->spec->failure; /* laws that soften are not held by it */
  const CriticalStretchSpec *stretch = critical_stretch_spec(failure);
  if (!failure || failure->near_grips >= 0 || failure->nowhere.count ||
      (stretch && isnan(stretch->stretch) && isnan(stretch->fracture_energy)))
    return;
  for (int k = 0; k < model->loading.count; ++k) {
    const LoadSpec *l = model->loading.loads[k].spec;
    if (!(plausibility_is_kind(l, "displacement") || plausibility_is_kind(l, "velocity") ||
          plausibility_is_kind(l, "acceleration")) ||
        load_magnitude(l) == 0)
      continue;
    const Selection *held = &model->loading.loads[k].selection;
    bool breaks = false;
    for (int64_t n = 0; n < held->count; ++n)
      breaks |= isfinite(d->failure.limit[d->material[held->places[n] / SLICE]]);
    if (!breaks) continue;
    plausibility_say(
        model, l->head.node,
        "load: bonds may break at the grips, within a horizon of the particles that it moves, and let the body go; "
        "'failure: {..., near grips: hold}' keeps them, 'near grips: break' says that it is meant");
    return;
  }
}

/** Nothing solid is thrown or moved faster than waves run in it, but in impacts of meteorites. */
static void check_speed(breccia_model *model, const Load *load)
{
  const bool initial = plausibility_is_kind(load->spec, "initial velocity");
  if (!initial && !plausibility_is_kind(load->spec, "velocity")) return;
  const char *dimension;
  load_kind(load->spec, &dimension);
  if (strcmp(dimension, "velocity") != 0 || solver_stage_rests(&model->solver, load->first)) return;
  const double peak = initial ? 1 : history_peak(&load->history, model->solver.clock.end_time - load->begin);
  const double speed = fabs(plausibility_in_si(model, "velocity", load_magnitude(load->spec) * peak)),
               waves = plausibility_wave_speed(model);
  if (!(speed > waves)) return;
  Text words = {0}, limit = {0};
  quantity_describe(speed, "m/s", &words);
  quantity_describe(waves, "m/s", &limit);
  plausibility_say(
      model, load->node,
      "%s: %s is more than the speed of waves in the body, %s, with which nothing solid stays whole; look at "
      "its unit",
      load->node->key, text_words(&words), text_words(&limit));
  text_free(&words);
  text_free(&limit);
}

/** Returns true if two values of the deck are written in the same words. */
static bool loads_same_node(const Node *a, const Node *b)
{
  if (!a || !b) return a == b;
  if (a->kind != b->kind || a->count != b->count) return false;
  if (a->kind == NODE_SCALAR) return !strcmp(a->text ? a->text : "", b->text ? b->text : "");
  for (int k = 0; k < a->count; ++k)
    if (!loads_same_node(a->kind == NODE_MAP ? node_get(b, a->items[k].key) : &b->items[k], &a->items[k])) return false;
  return true;
}

/** Returns true if two loads are the same but for their names and the words that select their particles. */
static bool loads_are_one(const Load *a, const Load *b)
{
  const Node *one = a->spec->head.node, *other = b->spec->head.node;
  if (a->type != b->type || a->first >= b->behind || b->first >= a->behind || a->selection.count != b->selection.count)
    return false;
  if (memcmp(a->selection.places, b->selection.places, sizeof(int32_t) * (size_t)a->selection.count) != 0) return false;
  static const char *const keys[] = {"history", "area", "centre", "spread"};
  for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k)
    if (!loads_same_node(node_get(one, keys[k]), node_get(other, keys[k]))) return false;
  return a->node && b->node && !strcmp(a->node->key, b->node->key) && loads_same_node(a->node, b->node);
}

/** Orders loads so that those on the same particles stand side by side. */
static int loads_compare(const void *first, const void *second)
{
  const Load *a = *(const Load *const *)first, *b = *(const Load *const *)second;
  if (a->type != b->type) return a->type < b->type ? -1 : 1;
  if (a->selection.count != b->selection.count) return a->selection.count < b->selection.count ? -1 : 1;
  const int32_t from_a = a->selection.count ? a->selection.places[0] : -1,
                from_b = b->selection.count ? b->selection.places[0] : -1;
  if (from_a != from_b) return from_a < from_b ? -1 : 1;
  return a < b ? -1 : a > b;
}

/** Returns true if two loads act on the particles nearest to different points, of which plausibility_warn_of_places
 *  speaks. */
static bool loads_meet_by_chance(const breccia_model *model, const Load *a, const Load *b)
{
  const SelectionSpec *one = selection_spec(&model->spec->selections, &a->spec->on),
                      *other = selection_spec(&model->spec->selections, &b->spec->on);
  return one && other && one != other && !isnan(one->nearest[0]) && !isnan(other->nearest[0]) &&
         memcmp(one->nearest, other->nearest, sizeof one->nearest) != 0;
}

/** A force that stands in the deck twice acts twice. Each load is compared with those just before it on the same
 *  particles. */
static void check_twice(breccia_model *model)
{
  enum { COMPARED = 16 };
  const int count = model->loading.count;
  const Load **sorted = memory_zeroed((size_t)count + 1, sizeof *sorted, "loads", NULL);
  for (int k = 0; sorted && k < count; ++k) sorted[k] = &model->loading.loads[k];
  if (sorted) qsort(sorted, (size_t)count, sizeof *sorted, loads_compare);
  for (int k = 1; sorted && k < count; ++k) {
    int same = k - 1;
    if (!sorted[k]->type->force) continue;
    while (same >= 0 && k - same <= COMPARED && !loads_are_one(sorted[same], sorted[k])) --same;
    if (same < 0 || k - same > COMPARED || loads_meet_by_chance(model, sorted[same], sorted[k])) continue;
    plausibility_say(
        model, sorted[k]->node,
        "%s: the load in line %d says the same of the same particles, and both act; leave one out, or give "
        "one load the sum",
        sorted[k]->node->key, sorted[same]->spec->head.node->line);
  }
  free(sorted);
}

/** Returns the mean height of the particles that are held along the last axis; NaN: none are. */
static double loads_held_height(const breccia_model *model, int up)
{
  const Loading *loading = &model->loading;
  double sum = 0, count = 0;
  for (int k = 0; k < loading->constraint_count; ++k) {
    const Constraint *c = &loading->constraints[k];
    const Selection *on = &c->load->selection;
    const bool goes_on = c->images && c->share > 0; /* a face that nothing holds */
    if (c->value != 0 || c->order || c->row || goes_on || fabs(c->direction[up]) < 0.5) continue;
    for (int64_t n = 0; n < on->count; ++n) sum += model->domain.particles->position[up][on->places[n]];
    count += (double)on->count;
  }
  return count > 0 ? sum / count : NAN;
}

/** Warns of gravity that points up the last axis, away from what holds the body. */
static void check_upwards(breccia_model *model, const Load *load)
{
  const Body *body = &model->domain.body;
  const int up = body->dimensions - 1;
  if (!plausibility_is_kind(load->spec, "gravity") || body->dimensions < 2) return;
  const double *pull = load->spec->of[LOAD_gravity].point;
  const double size = sqrt(pull[0] * pull[0] + pull[1] * pull[1] + pull[2] * pull[2]);
  if (!(pull[up] > 0.5 * size) || !(loads_held_height(model, up) < (body->low[up] + body->high[up]) / 2)) return;
  plausibility_say(model, load->node,
                   "gravity: it points upwards, along +%c, away from what holds the body; give a negative number if "
                   "%c counts upwards",
                   "xyz"[up], "xyz"[up]);
}

/** Warns of strengths that are divided where nothing acts that could exceed them. */
static void check_reduction(breccia_model *model)
{
  const Loading *loading = &model->loading;
  const Node *reduction = NULL;
  bool acts = model->spec->initial_stress.count > 0;
  for (int k = 0; k < loading->count; ++k) {
    const Load *load = &loading->loads[k];
    if (load->type == &strength_reduction_load) reduction = load->node;
    acts |= load->type->strain || (load->type->force && load_magnitude(load->spec) != 0);
  }
  for (int k = 0; k < loading->constraint_count; ++k) acts |= loading->constraints[k].value != 0;
  if (reduction && !acts)
    plausibility_say(
        model, reduction,
        "strength reduction: no load acts, so that strengths can be divided by any number; let 'gravity' or "
        "another load act from the stage before");
}

void plausibility_warn_of_loads(breccia_model *model)
{
  for (int k = 0; k < model->loading.count; ++k) {
    check_jump(model, &model->loading.loads[k]);
    check_shaking(model, &model->loading.loads[k]);
    check_dashpots(model, &model->loading.loads[k]);
    check_initial_strain(model, &model->loading.loads[k]);
    check_water(model, &model->loading.loads[k]);
    check_growth(model, &model->loading.loads[k]);
    check_sudden(model, &model->loading.loads[k]);
    check_sudden_strain(model, &model->loading.loads[k]);
    check_speed(model, &model->loading.loads[k]);
    check_upwards(model, &model->loading.loads[k]);
    plausibility_warn_of_area(model, &model->loading.loads[k]);
  }
  check_reduction(model);
  check_twice(model);
  check_grips(model);
}

/* ---- ground ---- */

/** The particle of the body on which most acts when the run begins, of those that no load moves; and how much per volume. */
static int32_t least_balanced(breccia_model *model, double *most)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  int32_t found = -1;
  uint8_t *held = memory_zeroed((size_t)p->places, 1, "balance", NULL);
  if (!held) return -1;
  loading_mark_held(&model->loading, held);
  domain_evaluate(d, NULL);
  loading_apply(&model->loading, d->particles, 0);
  *most = 0;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double square = 0;
    for (int k = 0; k < 3; ++k)
      square += (p->internal.row[k][i] + p->external.row[k][i]) * (p->internal.row[k][i] + p->external.row[k][i]);
    if (held[i] || body_outside(&d->body, n) || square <= *most * *most) continue;
    *most = sqrt(square);
    found = i;
  }
  free(held);
  return found;
}

/** Warns where ground that begins under its weight is far from balance. At a free surface, where families are not whole, a third of the weight is
 *  left; beside faces that are held in few layers, or not at all, several times of it. */
static void check_balance(breccia_model *model, const InitialStressSpec *item)
{
  const double usual = 0.75; /* of the largest load */
  const Particles *p = model->domain.particles;
  double most, load = 0;
  const int32_t at = least_balanced(model, &most);
  if (at < 0) return;
  for (int32_t n = 0; n < p->count; ++n) {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += p->external.row[k][p->place_of[n]] * p->external.row[k][p->place_of[n]];
    load = fmax(load, sqrt(square));
  }
  if (most <= usual * load) return;
  char unit[64];
  units_name(model->units, dimension_find("force per volume"), unit, sizeof unit);
  plausibility_say(model, section_node(item, "surface"),
                   "surface: the ground begins out of balance: on particle %d at [%g, %g, %g] acts %.3g %s, "
                   "beside loads of %.3g at most; hold its faces by 'support', or in layers two horizons deep, and "
                   "expect a free face to move",
                   p->number[at], p->position[0][at], p->position[1][at], p->position[2][at], most, unit, load);
}

/** Gravity on the whole body as the first stage leaves it, of length 0 if there is none. */
static void find_gravity(const breccia_model *model, double gravity[3])
{
  for (int k = 0; k < 3; ++k) gravity[k] = 0;
  for (int n = 0; n < model->loading.count; ++n) {
    const Load *load = &model->loading.loads[n];
    if (load->first > 0 || load->spec->on.node || !node_get(load->spec->head.node, "gravity")) continue;
    for (int k = 0; k < 3; ++k)
      gravity[k] +=
          history_factor(&load->history, model->solver.clock.stage_end) * load->spec->of[LOAD_gravity].point[k];
  }
}

/** Stress of ground at a depth between walls that do not give way, as an elastic stage finds it. @param[in] pull  density times gravity */
static void stress_at_depth(const Material *m, const double pull[3], double depth, double stress[6])
{
  const double nu = material_poisson(m), k0 = nu / (1 - nu);
  const double size = sqrt(pull[0] * pull[0] + pull[1] * pull[1] + pull[2] * pull[2]);
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], s = symmetric_column[k];
    stress[k] = -depth * ((r == s ? k0 * size : 0) + (1 - k0) * pull[r] * pull[s] / size);
  }
}

/** Warns where an elastic first stage leads ground under its weight beyond its strength, by walls that do not give way: with other sides it is
 *  led further. */
static void check_strength(breccia_model *model, int material, const double gravity[3])
{
  const Domain *d = &model->domain;
  const Particles *p = d->particles;
  const Material *m = &d->materials[material];
  const double size = sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1] + gravity[2] * gravity[2]);
  double top = -INFINITY, low = INFINITY, pull[3], stress[6];
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double height = 0;
    if (body_outside(&d->body, n)) continue;
    for (int k = 0; k < 3; ++k) height -= gravity[k] / size * p->position[k][i];
    top = fmax(top, height);
    if (d->material[i / SLICE] == material) low = fmin(low, height);
  }
  for (int k = 0; k < 3; ++k) pull[k] = m->density * gravity[k];
  double kept = 0, lost = top - low;
  stress_at_depth(m, pull, lost, stress);
  if (!(lost > 0) || points_law_keeps(m, stress)) return;
  for (int k = 0; k < 10; ++k) {
    const double middle = (kept + lost) / 2;
    stress_at_depth(m, pull, middle, stress);
    *(points_law_keeps(m, stress) ? &kept : &lost) = middle;
  }
  char length[64];
  units_name(model->units, dimension_find("length"), length, sizeof length);
  plausibility_say(model, section_node(model->solver.stages->items[0], "laws"),
                   "laws: elastic: under its weight alone material '%s' is beyond its strength from a depth of %.2g %s "
                   "on, with the horizontal stress of its Poisson ratio %.4g, %.3g of the vertical one; it yields at "
                   "once when laws answer as given: 'initial stress' with a larger K0, or a Poisson ratio nearer to "
                   "0.5, keeps it within",
                   m->name, (kept + lost) / 2, length, material_poisson(m),
                   material_poisson(m) / (1 - material_poisson(m)));
}

static void check_elastic_stage(breccia_model *model)
{
  const Domain *d = &model->domain;
  const SectionList *stages = model->solver.stages;
  double gravity[3];
  bool yields = false;
  if (((const SolveSpec *)stages->items[0])->laws != LAWS_ELASTIC || d->begins_under_stress) return;
  for (int k = 1; k < stages->count; ++k) yields |= ((const SolveSpec *)stages->items[k])->laws != LAWS_ELASTIC;
  find_gravity(model, gravity);
  if (!yields || (gravity[0] == 0 && gravity[1] == 0 && gravity[2] == 0)) return;
  for (int k = 0; k < d->material_count; ++k) {
    bool in_space = false;
    for (int r = 0; r < d->region_count; ++r)
      in_space |= d->regions[r].points.components == 6 && !d->regions[r].points.plane_stress &&
                  region_is_made_of(d, &d->regions[r], d->materials[k].name);
    if (in_space && !d->materials[k].remote) check_strength(model, k, gravity);
  }
}

/* Only weight balances stresses that grow with depth. */
void plausibility_warn_of_ground(breccia_model *model)
{
  bool weight = false;
  check_elastic_stage(model);
  for (int k = 0; k < model->loading.count; ++k)
    weight |= model->loading.loads[k].first == 0 && plausibility_is_kind(model->loading.loads[k].spec, "gravity");
  for (int n = 0; n < model->spec->initial_stress.count; ++n) {
    const InitialStressSpec *item = model->spec->initial_stress.items[n];
    if (item->stress.values) continue;
    if (weight) {
      check_balance(model, item);
      return;
    }
    plausibility_say(model, section_node(item, "surface"),
                     "surface: no gravity acts when the run begins, so that the ground heaves; add 'gravity' to the "
                     "loads");
  }
}
