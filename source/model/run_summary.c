/* What a run did: summary.json, and the same in words. */
#include "domain/softened.h"
#include "domain/tensile_strength.h"
#include "domain/toughness.h"
#include "model/ground_step.h"
#include "model/run.h"

#include "results/checkpoint.h"
#include "solver/distortion.h"
#include "solver/quasi_static.h"
#include "solver/reactions.h"
#include "solver/rest.h"
#include <float.h>
#include <math.h>
#include <string.h>

static double nanoseconds_per_bond(const breccia_model *model)
{
  double work = (double)model->run_steps * (double)model->domain.family.bonds;
  return work > 0 ? 1e9 * model->run_seconds / work : 0;
}

static void add_number(Text *text, const char *key, double value)
{
  if (isfinite(value))
    text_add(text, "\"%s\": %.10g", key, value);
  else
    text_add(text, "\"%s\": null", key);
}

/** What the deck was made of: its file, settings from outside, its variables with their values. */
static void add_origin(const breccia_model *model, Text *t)
{
  text_add(t, "  \"deck\": ");
  text_add_json(t, model->document->name);
  text_add(t, ",\n  \"settings\": [");
  for (int k = 0; k < model->setting_count; ++k) {
    text_add(t, "%s", k ? ", " : "");
    text_add_json(t, model->settings[k]);
  }
  text_add(t, "],\n  \"variables\": {");
  const Node *variables = node_get(model->document->root, "variables");
  for (int k = 0; variables && k < variables->count; ++k) {
    text_add(t, "%s", k ? ", " : "");
    text_add_json(t, variables->items[k].key);
    text_add(t, ": ");
    text_add_json(t, variables->items[k].text);
  }
  text_add(t, "},\n");
}

/** Returns the first broken bond of the body, layers outside of supports left out; NULL: none.
 *  @param[out] middle  midpoint of the bond inside the body */
static const BrokenBond *first_broken(const Domain *d, double middle[3])
{
  for (int64_t n = 0; n < d->broken_count; ++n) {
    const BrokenBond *bond = &d->broken[n];
    if (domain_bond_outside(d, bond)) continue;
    domain_bond_middle(d, (const int32_t[]){bond->a, bond->b}, middle);
    return bond;
  }
  return NULL;
}

/** Adds the first broken bond with its cause, or null. */
static void add_first_broken(const breccia_model *model, Text *text)
{
  const Domain *d = &model->domain;
  double x[3];
  char unit[64] = "";
  const BrokenBond *first = first_broken(d, x);
  if (!first) {
    text_add(text, "  \"first_broken_bond\": null,\n");
    return;
  }
  text_add(text,
           "  \"first_broken_bond\": {\"step\": %lld, \"time\": %.10g, \"particles\": [%d, %d], \"at\": [%.10g, "
           "%.10g, %.10g], \"cause\": \"%s\", ",
           (long long)first->step, first->time, first->a, first->b, x[0], x[1], x[2], break_causes[first->cause].word);
  const char *quantity = domain_break_quantity(d, first->cause, first->quantity);
  units_name(model->units, dimension_find(domain_break_dimension(d, first->cause)), unit, sizeof unit);
  text_add(text, "\"criterion\": \"%s\", \"material\": ", domain_break_criterion(d, first->cause));
  text_add_json(text, d->materials[first->material].name);
  text_add(text, ", \"quantity\": \"%s\", ", quantity ? quantity : "");
  add_number(text, "value", first->value);
  text_add(text, ", ");
  add_number(text, "limit", first->limit);
  text_add(text, ", \"unit\": \"%s\"},\n", unit);
}

/** Adds the number of broken bonds of the body by cause, and that of their images outside of supports. */
static void add_causes(const Domain *d, Text *text)
{
  int64_t counts[BREAK_CAUSES];
  const int64_t outside = domain_count_broken(d, counts);
  text_add(text, "  \"broken_bonds_by_cause\": {");
  for (int k = 0; k < BREAK_CAUSES; ++k) text_add(text, "\"%s\": %lld, ", break_causes[k].word, (long long)counts[k]);
  text_add(text, "\"images\": %lld},\n", (long long)outside);
}

/** Adds the number of bonds that broke for causes other than the failure criterion, if there are any. */
static void add_other_causes(const Domain *d, const char *folder, Text *text)
{
  int64_t counts[BREAK_CAUSES], others = 0;
  domain_count_broken(d, counts);
  for (int k = 0; k < BREAK_CAUSES; ++k) {
    if (!break_causes[k].criterion || !counts[k]) continue;
    text_add(text, "%lld bonds broke %s\n", (long long)counts[k], break_causes[k].count);
    others += counts[k];
  }
  if (others) text_add(text, "'breccia why %s' lists them\n", folder);
}

/** Increments that are not followed, but jumped over. */
static void add_jumps(const Solver *s, Text *text)
{
  double descended = 0, relaxed = 0;
  for (int64_t k = 0; k <= s->clock.stage; ++k) {
    descended += s->records[k].descended;
    relaxed += s->records[k].relaxed;
  }
  if (descended > 0) text_add(text, "  \"increments_by_secants\": %.0f,\n", descended);
  if (relaxed > 0) text_add(text, "  \"increments_by_relaxation\": %.0f,\n", relaxed);
}

/** Whether a stage has ended with the body at rest, as far as that is known: because the body was, or by increments that are states of rest, unless
 *  it ended before its time where there was none. */
static bool ended_at_rest(const breccia_model *model, int64_t stage)
{
  const Solver *s = &model->solver;
  const StageRecord *r = &s->records[stage];
  const bool ended = stage < s->clock.stage || s->clock.ended;
  const bool early = r->end < r->begin + (1 - 1e-9) * model_stage_time(model, stage);
  return r->came_to_rest > 0 ||
         (ended && solver_stage_rests(s, stage) && !(early && model_stage_hands_over(model, stage)));
}

/** The stages that have begun, where there are several. */
static void add_stages(const breccia_model *model, Text *text)
{
  const Solver *s = &model->solver;
  if (s->clock.stages == 1) return;
  text_add(text, "  \"stages\": [");
  for (int64_t k = 0; k <= s->clock.stage; ++k) {
    const StageRecord *r = &s->records[k];
    char name[64];
    text_add(text, "%s{\"name\": ", k ? ", " : "");
    text_add_json(text, solver_stage_name(s, k, name, sizeof name));
    text_add(text, ", \"steps\": [%.0f, %.0f], ", r->first_step, r->last_step);
    const bool from_zero = k > 0 && ((const SolveSpec *)s->stages->items[k])->displacements == DISPLACEMENTS_FROM_ZERO;
    text_add(text, "\"times\": [%.10g, %.10g], \"at_rest\": %s%s}", r->begin, r->end,
             ended_at_rest(model, k) ? "true" : "false", from_zero ? ", \"displacements_from_zero\": true" : "");
  }
  text_add(text, "],\n");
}

static void tell_stages(const Solver *s, const char *time, Text *text)
{
  for (int64_t k = 0; s->clock.stages > 1 && k <= s->clock.stage; ++k) {
    const StageRecord *r = &s->records[k];
    char name[64];
    text_add(text, "stage '%s': steps %.0f to %.0f, time %.6g to %.6g %s%s\n",
             solver_stage_name(s, k, name, sizeof name), r->first_step, r->last_step, r->begin, r->end, time,
             r->came_to_rest > 0 ? ", came to rest" : "");
  }
}

/** What supports and loads exert in the end, with moments about the origin, and how far they are from balancing each other. */
typedef struct Balance {
  Wrench reactions, loads;
  double left; /* the largest component of their sum, over the sizes of all; or the most that they have been at rest */
} Balance;

static bool find_balance(const Solver *s, Balance *balance)
{
  const double origin[3] = {0};
  Reactions reactions = {0};
  double left = 0;
  const bool found = !reactions_create(&reactions, s->domain->particles, NULL);
  if (found) {
    balance->reactions = reactions_sum(&reactions, s, NULL, NULL, origin);
    balance->loads = reactions_of_loads(s, origin);
    for (int k = 0; k < 3; ++k) left = fmax(left, fabs(balance->reactions.force[k] + balance->loads.force[k]));
    double all = balance->reactions.size + balance->loads.size;
    if (s->type->exerted) all = fmax(all, s->type->exerted(s));
    balance->left = left > 0 ? left / all : 0;
  }
  reactions_destroy(&reactions);
  return found;
}

static void add_vector(Text *text, const char *key, const double v[3])
{
  text_add(text, "\"%s\": [%.10g, %.10g, %.10g]", key, v[0], v[1], v[2]);
}

static void add_balance(const Solver *s, Text *text)
{
  Balance balance;
  Rest rest;
  if (!find_balance(s, &balance)) return;
  text_add(text, "  \"equilibrium\": {");
  add_vector(text, "reactions", balance.reactions.force);
  text_add(text, ", ");
  add_vector(text, "moment of reactions", balance.reactions.moment);
  text_add(text, ", ");
  add_vector(text, "loads", balance.loads.force);
  text_add(text, ", ");
  add_vector(text, "moment of loads", balance.loads.moment);
  if (!rest_find(s, &rest, NULL) && rest.meant && rest.reached) { /* what moves has inertia beside these */
    text_add(text, ", ");
    add_number(text, "left", balance.left);
  }
  text_add(text, "},\n");
}

/** How far a body is from rest that was meant to come to it. */
static void add_rest(const Solver *s, Text *text)
{
  Rest rest;
  if (rest_find(s, &rest, NULL) || !rest.meant) return;
  text_add(text, "  \"rest\": {");
  add_number(text, "unbalanced", rest.unbalanced);
  text_add(text, ", ");
  add_number(text, "kinetic", rest.kinetic);
  const double limit = solver_stage_steady(s, s->clock.stage);
  if (!isnan(limit)) text_add(text, ", \"limit\": %g", limit);
  const StageRecord *record = &s->records[s->clock.stage];
  if (record->steady != STEADY_UNASKED)
    text_add(text, ", \"quasi-static\": \"%s\", \"told\": %d", quasi_static_verdict(record),
             record->steady == STEADY || record->steady == STEADY_NOT);
  if (record->midway > 0)
    text_add(text, ", \"unbalanced midway\": %.6g, \"settles\": %d", record->midway,
             quasi_static_still_settles(record));
  text_add(text, "},\n");
}

int run_write_summary(Run *run, int status, const char *problem, Error *error)
{
  breccia_model *model = run->model;
  const Domain *d = &model->domain;
  const Solver *s = &model->solver;
  Energy e = solver_energy(s);
  Text t = {0};
  text_add(&t, "{\n  \"title\": ");
  text_add_json(&t, model->spec->title);
  text_add(&t, ",\n  \"version\": \"%s\",\n  \"completed\": %s,\n", BRECCIA_VERSION,
           !status && solver_is_done(s) ? "true" : "false");
  add_origin(model, &t);
  if (run->step_failed) text_add(&t, "  \"failed_step\": %.0f,\n", (double)(s->clock.step + 1));
  const bool blown_up = ledger_has_blown_up(&s->ledger); /* then energies and forces mean nothing any more */
  if (blown_up) text_add(&t, "  \"blown_up\": true,\n");
  if (problem && *problem) {
    text_add(&t, "  \"problem\": ");
    text_add_json(&t, problem);
    text_add(&t, ",\n");
  }
  text_add(&t, "  \"particles\": %lld,\n  \"bonds\": %lld,\n  \"steps\": %lld,\n", (long long)d->particles->count,
           (long long)d->family.bonds / 2, (long long)s->clock.step);
  text_add(&t, "  \"time\": %.10g,\n  \"time_step\": %.10g,\n", s->clock.time, s->clock.time_step);
  if (isfinite(s->clock.stable)) text_add(&t, "  \"stable_time_step\": %.10g,\n", s->clock.stable);
  add_stages(model, &t);
  add_jumps(s, &t);
  text_add(&t, "  \"wall_seconds\": %.3f,\n  \"ns_per_directed_bond_step\": %.4f,\n  \"threads\": %d,\n",
           model->run_seconds, nanoseconds_per_bond(model), model->threads);
  add_first_broken(model, &t);
  text_add(&t, "  \"broken_bonds\": %lld,\n", (long long)d->broken_count);
  add_causes(d, &t);
  text_add(&t, "  \"energy\": {");
  const struct {
    const char *key;
    double value;
  } energies[] = {{"kinetic", e.kinetic},       {"internal", e.internal},   {"stored", e.stored},
                  {"dissipated", e.dissipated}, {"external", e.external},   {"damping", e.damping},
                  {"fracture", e.fracture},     {"friction", e.friction},   {"numerical", e.numerical},
                  {"between", e.between},       {"imbalance", e.imbalance}, {"shed", e.shed}};
  for (int k = 0; k < (int)(sizeof energies / sizeof *energies); ++k) {
    if (k) text_add(&t, ", ");
    add_number(&t, energies[k].key, blown_up ? NAN : energies[k].value);
  }
  if (domain_is_controlled(d)) {
    text_add(&t, ", ");
    add_number(&t, "zero_energy_control", blown_up ? NAN : domain_control_energy(d));
  }
  text_add(&t, "},\n");
  if (!blown_up) {
    run_add_bars(model, &t);
    add_balance(s, &t);
    add_rest(s, &t);
    run_add_measures(model, &t);
  }
  text_add(&t, "  \"peaks\": {");
  const Peaks *p = &model->peaks;
  const struct {
    const char *key;
    double value;
  } peaks[] = {{"displacement", p->displacement},          {"velocity", p->velocity},
               {"octahedral_shear_stress", p->octahedral}, {"mean_stress_lowest", p->mean_low},
               {"mean_stress_highest", p->mean_high},      {"damage", p->damage}};
  for (int k = 0; k < 6; ++k) {
    if (k) text_add(&t, ", ");
    add_number(&t, peaks[k].key, peaks[k].value);
  }
  text_add(&t, "},\n");
  run_add_compressions(model, &t);
  run_add_loads(model, &t);
  text_add(&t, "  \"units\": {");
  static const char *const units[][2] = {{"times", "time"},          {"positions and displacements", "length"},
                                         {"velocities", "velocity"}, {"stresses", "stress"},
                                         {"energies", "energy"},     {"forces", "force"},
                                         {"moments", "energy"},      {"areas", "area"}}; /* shares have none */
  for (size_t k = 0; k < sizeof units / sizeof *units; ++k) {
    char unit[64];
    units_name(model->units, dimension_find(units[k][1]), unit, sizeof unit);
    text_add(&t, "%s\"%s\": ", k ? ", " : "", units[k][0]);
    text_add_json(&t, unit);
  }
  text_add(&t, "}");
  Text servers = {0};
  domain_report_servers(d, model->run_seconds, true, &servers);
  if (servers.length) text_add(&t, ",\n  \"servers\": [%s]", text_words(&servers));
  text_free(&servers);
  text_add(&t, "\n}\n");
  const int status_written = run_write_file(run, "summary.json", &t, error);
  if (!status_written) text_add(&run->files, "  %s/summary.json\n", run->wish->folder);
  text_free(&t);
  return status_written;
}

/** Says whether the body has borne the loads of stages that ask for it. */
static void tell_verdicts(const Solver *s, Text *t)
{
  for (int64_t k = 0; k <= s->clock.stage; ++k) {
    const StageRecord *r = &s->records[k];
    const double limit = solver_stage_steady(s, k);
    char name[64];
    if (r->steady == STEADY_UNASKED) continue;
    text_add(t, "quasi-static");
    if (s->clock.stages > 1) text_add(t, ", stage '%s'", solver_stage_name(s, k, name, sizeof name));
    text_add(t, ": ");
    quasi_static_tell(r, limit, t);
    text_add(t, "\n");
  }
}

/** Says whether a body that was meant to come to rest has done so.
 *  @param failed  the run has ended by a failure, whose error says what to do */
static void tell_rest(const Solver *s, const Units *units, bool failed, Text *t)
{
  Balance balance;
  Rest rest;
  if (rest_find(s, &rest, NULL) || !rest.meant) return;
  if (s->records[s->clock.stage].steady != STEADY_UNASKED)
    ; /* it is told by what it was judged */
  else if (rest.reached)
    text_add(t, "%s: forces out of balance are %.2g of those that act, kinetic energy %.2g of the work\n",
             failed ? "at rest in the last state that it came to" : "at rest", rest.unbalanced, rest.kinetic);
  else
    text_add(
        t,
        "not at rest: forces out of balance are %.2g of those that act, kinetic energy %.2g of the work (at rest both "
        "are below %g): %s\n",
        rest.unbalanced, rest.kinetic, rest_limit,
        failed           ? "the run failed on the way"
        : s->type->rests ? "take a smaller 'residual' for its stages"
                         : "run longer, with local damping, or load more slowly; what slides or falls does not come to "
                           "rest");
  if (!s->loading->constraint_count || !find_balance(s, &balance)) return;
  const double *r = balance.reactions.force, *l = balance.loads.force;
  char force[64];
  units_name(units, dimension_find("force"), force, sizeof force);
  const double all = balance.reactions.size + balance.loads.size;
  text_add(t, "supports and prescribed motions exert [%.6g, %.6g, %.6g] %s, loads [%.6g, %.6g, %.6g]; ",
           without_rounding(r[0], all), without_rounding(r[1], all), without_rounding(r[2], all), force,
           without_rounding(l[0], all), without_rounding(l[1], all), without_rounding(l[2], all));
  text_add(t, "of all these forces %.2g is left\n", balance.left);
}

/** Warns of particles that are turned inside out, where a run ends before distortion_watch has looked at them, or does
 * not mind them. */
static void tell_inverted(const Domain *d, const char *length, Text *t)
{
  const Particles *p = d->particles;
  int32_t first = 0;
  const int64_t count = distortion_inverted(d, &first);
  if (count)
    text_add(t,
             "warning: %lld particle%s turned inside out, the first at [%.4g, %.4g, %.4g] %s: no body can be moved so; "
             "look at motions, loads and their units\n",
             (long long)count, count == 1 ? " is" : "s are", p->position[0][first], p->position[1][first],
             p->position[2][first], length);
}

/** Warns where control that keeps its stiffness carries load beside laws that have yielded. */
static void tell_control(const Domain *d, double stored, Text *t)
{
  const YieldedEnergy yielded = run_yielded_energy(d);
  if (yielded.lasting > run_most_control * stored)
    text_add(t,
             "warning: where laws have yielded, control of zero-energy modes holds %.2g %% of the stored energy: it "
             "carries load beside them, and limit loads come out too high; take 'zero-energy control: {silling: ..., "
             "fades: yielding}'\n",
             100 * yielded.lasting / stored);
}

/** Warns of the strength reduction from which on control of zero-energy modes held ground that would slide. */
static void tell_held(const breccia_model *model, Text *t)
{
  const Peaks *p = &model->peaks;
  bool constant = false; /* the influence of a region with control does not decrease with distance */
  if (!(p->reduction_held > 0)) return;
  for (const Region *r = model->domain.regions; r < model->domain.regions + model->domain.region_count; ++r) {
    const ControlType *control = r->type->control;
    constant |= control && control->is_active(r->formulation) && !control->influence_decreases(r->formulation);
  }
  text_add(
      t,
      "warning: from a factor of %.4g on, control of zero-energy modes holds more than %.0f %% of the energy that is "
      "stored where laws have yielded: ground that slides comes to rest by it",
      p->reduction_held, 100 * run_most_sliding);
  if (p->reduction_free > 0) text_add(t, "; take no factor of safety above %.4g", p->reduction_free);
  if (constant)
    text_add(t, ", or take 'influence: conical' and 'horizon: 2.015 spacings' with 'zero-energy control: {silling: "
                "0.2, fades: yielding}'");
  text_add(t, "\n");
}

/** Says by what factor loads divide strengths in the end, which is the last one with an equilibrium where the run has
 * failed. */
static void tell_strength(const breccia_model *model, bool failed, Text *t)
{
  const Solver *s = &model->solver;
  bool any = false;
  for (int k = 0; k < model->loading.count; ++k)
    any |= model->loading.loads[k].type == &strength_reduction_load && load_acts(s->loading, &model->loading.loads[k]);
  const double factor = solver_strength_reduction(s), lost = s->records[s->clock.stage].lost_reduction;
  if (any && lost > 0)
    text_add(t, "factor of safety %.4g: the body is at rest with strengths divided by it; divided by %.4g they %s\n",
             factor, lost,
             s->records[s->clock.stage].slides > 0 ? "let it slide until it came to rest elsewhere"
                                                   : "gave no equilibrium");
  else if (any)
    text_add(t, "strengths are divided by %.4g%s\n", factor,
             failed              ? " in the last state that the run came to"
             : solver_is_done(s) ? " in the end; no larger factor was tried"
                                 : "");
  const double step = any ? ground_step_spacings(&model->domain.body, &model->loading) : 0;
  if (step > 0)
    text_add(t, "at %.0f spacings across the height of the ground's step the factor may be some %.0f %% too high\n",
             step, 100 * ground_step_excess(&model->domain, step));
  if (step > 0) ground_step_tell_low(&model->domain, &model->loading, "", t);
  if (any && step == 0) ground_step_tell_level(&model->domain, "", "", t);
  tell_held(model, t);
}

/** Energy of strains that are roundings: what is less says nothing. */
static double rounding_energy(const Domain *d)
{
  double stiffest = 0, volume = 0;
  for (int k = 0; k < d->material_count; ++k) stiffest = fmax(stiffest, material_young(&d->materials[k]));
  for (int64_t n = 0; n < d->particles->count; ++n) volume += d->particles->volume[d->particles->place_of[n]];
  return DBL_EPSILON * DBL_EPSILON * stiffest * volume;
}

/** Explains where energy went that does not come back, and tells the share of the stored energy that no law stores.
 *  @param[in] rounding  what is less is none */
static void tell_energies(const Domain *d, const Energy *e, double rounding, Text *t)
{
  const double least = 5e-4; /* of the stored energy */
  if (e->dissipated > rounding)
    text_add(t, "dissipated: by laws that yield or soften; the work of cracks in softening laws is here\n");
  if (e->fracture > rounding)
    text_add(t, "fracture: energy of broken bonds at their limits%s\n",
             e->dissipated > rounding ? ", beside what laws had dissipated in them before" : "");
  const double held = domain_is_controlled(d) && e->stored > rounding ? domain_control_energy(d) / e->stored : 0;
  if (held > least)
    text_add(t, "of the stored energy %.2g %% is held by the control of zero-energy modes\n", 100 * held);
}

void run_tell_outcome(Run *run, int status)
{
  breccia_model *model = run->model;
  const Domain *d = &model->domain;
  const Solver *s = &model->solver;
  Energy e = solver_energy(s);
  Text *t = &model->outcome;
  char time[64], length[64];
  units_name(model->units, dimension_find("time"), time, sizeof time);
  units_name(model->units, dimension_find("length"), length, sizeof length);
  text_free(t);
  text_add(t, "%s at step %lld of %lld, time %.6g %s; %.1f s for %lld step%s",
           status == BRECCIA_INTERRUPTED ? "stopped on request"
           : status                      ? "stopped by a failure"
                                         : "finished",
           (long long)s->clock.step, (long long)s->clock.steps, s->clock.time, time, model->run_seconds,
           (long long)model->run_steps, model->run_steps == 1 ? "" : "s");
  if (!s->type->few_steps) text_add(t, ", %.2f ns per directed bond and step", nanoseconds_per_bond(model));
  text_add(t, "\n");
  if (status && run->unwritten)
    text_add(t, "once files can be written again, %s\n",
             checkpoint_exists(run->wish->folder) ? "--restart goes on from the last checkpoint"
                                                  : "begin it again: there is no checkpoint yet");
  tell_stages(s, time, t);
  run_tell_loads(model, t);
  tell_strength(model, status == BRECCIA_FAILURE, t);
  double x[3];
  const BrokenBond *first = first_broken(d, x);
  if (model->peaks.softened_time > 0) {
    text_add(t, "%s: the first softened by time %.6g %s", domain_softening_noun(d), model->peaks.softened_time, time);
    run_tell_loads_at(model, model->peaks.softened_time, t);
    text_add(t, "\n");
  }
  if (first) {
    text_add(t, "first broken bond at step %lld, time %.6g %s", (long long)first->step, first->time, time);
    run_tell_loads_at(model, first->time, t);
    text_add(t, ", near [%.4g, %.4g, %.4g] %s; %lld of %lld bonds broken in all\n", x[0], x[1], x[2], length,
             (long long)d->broken_count, (long long)d->family.bonds / 2);
    if (run->wish->folder) add_other_causes(d, run->wish->folder, t);
    toughness_describe(d, model->spec->failure, model->units, t);
    tensile_strength_describe(d, t);
  } else if (d->failure.criterion) {
    text_add(t, "no bond broke\n");
  }
  /* Of bodies at rest: what forces within the tolerance of equilibrium do is of either sign. */
  const double rounding = 1e-6 * s->ledger.paid;
  const struct {
    const char *words;
    double value;
    bool told;
  } energies[] = {{"energy: external ", e.external, true},
                  {" = kinetic ", e.kinetic, true},
                  {" + stored ", e.stored, true},
                  {" + dissipated ", e.dissipated, true},
                  {" + fracture ", e.fracture, true},
                  {" + shed in unstable jumps ", e.shed, fabs(e.shed) > rounding},
                  {" + friction ", e.friction, e.friction != 0},
                  {" + damping ", e.damping, fabs(e.damping) > rounding},
                  {" + numerical damping ", e.numerical, fabs(e.numerical) > 1e-9 * s->ledger.paid},
                  {" - kinetic at the start ", s->ledger.kinetic_at_start, s->ledger.kinetic_at_start > 0},
                  {" - stored at the start ", s->ledger.stored_at_start, s->ledger.stored_at_start > 0},
                  {" - short waves between steps ", e.between, fabs(e.between) > 1e-3 * s->ledger.paid}};
  const bool blown_up = ledger_has_blown_up(&s->ledger);
  if (blown_up) text_add(t, "energies, places and forces mean nothing after the computation has blown up\n");
  for (size_t k = 0; k < sizeof energies / sizeof *energies && !blown_up; ++k) {
    if (!energies[k].told) continue;
    text_add(t, "%s", energies[k].words);
    quantity_describe(units_in_si(model->units, dimension_find("energy"), energies[k].value), "J", t);
  }
  const bool tiny = s->ledger.paid > 0 && s->ledger.paid < rounding_energy(d);
  if (!blown_up && tiny)
    text_add(t, ", less than roundings of strains hold: nothing balances them\n");
  else if (!blown_up)
    text_add(t, ", imbalance %.2g %%\n", 100 * e.imbalance);
  if (!blown_up && !tiny && e.imbalance > 1e-3 && domain_flutters(d))
    text_add(t, "the imbalance is not that of steps alone: %s\n", domain_flutters(d));
  if (!blown_up && !tiny) tell_energies(d, &e, rounding, t);
  if (!blown_up) tell_inverted(d, length, t);
  const Peaks *peaks = &model->peaks;
  const double stress = units_in_si(model->units, dimension_find("stress"), 1);
  if (peaks->mean_low <= peaks->mean_high) { /* a state was written */
    text_add(t, "largest in the states written and at the end: displacement ");
    quantity_describe(units_in_si(model->units, dimension_find("length"), peaks->displacement), "m", t);
    text_add(t, ", octahedral shear stress ");
    quantity_describe(stress * peaks->octahedral, "Pa", t);
    text_add(t, ", mean stress ");
    quantity_describe(stress * peaks->mean_low, "Pa", t);
    text_add(t, " to ");
    quantity_describe(stress * peaks->mean_high, "Pa", t);
    if (d->failure.criterion || peaks->damage > 0) text_add(t, ", damage %.3g", peaks->damage);
    text_add(t, "\n");
  }
  if (!blown_up) run_tell_compressions(model, t);
  if (!blown_up) tell_control(d, e.stored, t);
  if (!blown_up) run_tell_thin_layers(model, t);
  if (!blown_up) run_tell_strains(model, t);
  if (!blown_up) run_tell_bars(model, t);
  tell_verdicts(s, t);
  if (!blown_up) tell_rest(s, model->units, status == BRECCIA_FAILURE, t);
  domain_report_servers(d, model->run_seconds, false, t);
  text_add(t, "written:\n%s", text_words(&run->files));
  if (t->length && t->characters[t->length - 1] == '\n') t->characters[--t->length] = 0;
}
