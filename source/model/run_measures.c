/* Measures of a body at the end of a run, by which 'breccia failure' judges whether it bears its loads: displacement,
 * the share of energy that is spent, what control of zero-energy modes holds, and how long loads have been steady.
 * solver/rest.h has forces out of balance and kinetic energy. */
#include "domain/softened.h"
#include "model/ground_step.h"
#include "model/run.h"

#include "solver/distortion.h"
#include <math.h>
#include <string.h>

const double run_most_control = 0.05;
const double run_most_sliding = 0.25; /* fading control has held slopes beyond their limit with twice that share */

YieldedEnergy run_yielded_energy(const Domain *d)
{
  const Particles *p = d->particles;
  YieldedEnergy sum = {0};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const Region *region = domain_region(d, i);
    YieldedEnergy one;
    if (!region->type->control || !(d->counted[i] > 0)) continue;
    region->type->control->yielded_energy(region->formulation, i, &one);
    sum.stored += one.stored;
    sum.held += one.held;
    sum.lasting += one.lasting;
  }
  return sum;
}

void run_note_softening(breccia_model *model)
{
  const Solver *s = &model->solver;
  if (s->type->rests && !(model->peaks.softened_time > 0) && domain_has_softened(&model->domain))
    model->peaks.softened_time = s->clock.time;
}

int run_note_reduction(breccia_model *model, Error *error)
{
  const Solver *s = &model->solver;
  Peaks *p = &model->peaks;
  const double factor = solver_strength_reduction(s);
  if (!s->type->rests || !(factor > 1) || p->reduction_held > 0) return BRECCIA_OK;
  const int status = domain_observe(&model->domain, error);
  const YieldedEnergy yielded = status ? (YieldedEnergy){0} : run_yielded_energy(&model->domain);
  domain_stop_observing(&model->domain);
  if (yielded.held > run_most_sliding * yielded.stored)
    p->reduction_held = factor;
  else
    p->reduction_free = factor;
  return status;
}

/** Largest displacement [length] of any particle. */
static double largest_displacement(const Particles *p)
{
  double largest = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double square = 0;
    for (int k = 0; k < 3; ++k) square += p->displacement.row[k][i] * p->displacement.row[k][i];
    largest = fmax(largest, square);
  }
  return sqrt(largest);
}

/** Longest side of the body [length]. */
static double longest_side(const Body *body)
{
  double longest = 0;
  for (int k = 0; k < body->dimensions; ++k) longest = fmax(longest, body->high[k] - body->low[k]);
  return longest;
}

/** Time [time] for which all loads have been as they are at the end, to a 1000th of the stage. */
static double time_held(const Solver *s)
{
  enum { PARTS = 1000 };
  const double length = s->clock.time - s->clock.stage_time;
  for (int n = 1; n <= PARTS; ++n)
    for (int k = 0; k < s->loading->count; ++k) {
      const Load *load = &s->loading->loads[k];
      const double now = load_factor(load, s->clock.time), then = load_factor(load, s->clock.time - length * n / PARTS);
      if (load_acts(s->loading, load) && fabs(now - then) > 1e-9 * fmax(fabs(now), 1)) return length * (n - 1) / PARTS;
    }
  return length;
}

static void run_add_measure(Text *text, const char *key, double value)
{
  if (isfinite(value))
    text_add(text, ", \"%s\": %.6g", key, value);
  else
    text_add(text, ", \"%s\": null", key);
}

void run_add_measures(const breccia_model *model, Text *text)
{
  const Domain *d = &model->domain;
  const Solver *s = &model->solver;
  const Energy e = solver_energy(s);
  const YieldedEnergy yielded = run_yielded_energy(d);
  const double spent = e.dissipated + e.fracture + e.shed + e.friction, all = e.stored + spent;
  const double step = ground_step_spacings(&d->body, s->loading);
  int32_t first;
  text_add(text, "  \"measures\": {\"displacement\": %.10g", largest_displacement(d->particles));
  run_add_measure(text, "strength reduction", solver_strength_reduction(s));
  const double lost = s->records[s->clock.stage].lost_reduction;
  run_add_measure(text, "lost reduction", lost > 0 ? lost : NAN);
  run_add_measure(text, "step", step);
  run_add_measure(text, "excess", step > 0 ? ground_step_excess(d, step) : 0);
  run_add_measure(text, "size", longest_side(&d->body));
  run_add_measure(text, "plastic", all > 0 ? spent / all : 0);
  run_add_measure(text, "control", yielded.stored > 0 ? yielded.held / yielded.stored : 0);
  run_add_measure(text, "lasting control", e.stored > 0 ? yielded.lasting / e.stored : 0);
  run_add_measure(text, "held", s->type->rests ? NAN : time_held(s));
  run_add_measure(text, "inverted", (double)distortion_inverted(d, &first));
  text_add(text, "},\n");
}
