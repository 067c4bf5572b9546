/* Ground that slides as strengths are reduced. A body that slides may come to rest elsewhere: control of zero-energy
 * modes or families that resist uneven motions hold slip lines that the law does not hold. Such a state of rest says
 * nothing of the ground. Displacement then grows much faster with the factor F than in an elastic body: the stage
 * judges by |du| / dln(F) over the displacement l sqrt(2 W int(dV / E)) / V, with which the volume V of ground whose
 * strength is reduced, of the length l along gravity, would store the energy W that is stored as the reduction begins.
 * Other materials do not count: one stiff bar or a support would make every displacement a slide. */
#include "solver/static.h"

#include "loading/load.h"
#include "solver/distortion.h"
#include <math.h>

/** Largest rate of displacement of a body that does not slide [-]. Vertical cuts and slopes of clay came to 3 to 15 in
 *  the last increments before they slid, and to 50 to 150 in those in which they slid. */
static const double most_rate = 30;

/** Returns true if no load but strength reductions changes between two times. */
static bool slide_others_stay(const Static *s, double begin, double end)
{
  for (int k = 0; k < s->loading->count; ++k) {
    const Load *load = &s->loading->loads[k];
    if (load->type == &strength_reduction_load || !load_acts(s->loading, load) || load_magnitude(load->spec) == 0)
      continue;
    if (load_factor(load, begin) != load_factor(load, end)) return false;
  }
  return true;
}

/** Returns log(F(end) / F(begin)) of the factor F by which the loads of the stage under way divide strengths. */
static double slide_growth(const Static *s, double begin, double end)
{
  const int64_t stage = s->loading->stage;
  return log(loading_strength_reduction(s->loading, stage, end) / loading_strength_reduction(s->loading, stage, begin));
}

bool static_finds_reduction(const Solver *run, double end)
{
  const Clock *clock = &run->clock;
  const Static *s = run->own;
  const double begin = run->records[clock->stage].begin;
  return clock->stage + 1 == clock->stages && !s->spec->control && slide_others_stay(s, begin, clock->time) &&
         slide_others_stay(s, begin, end) && slide_growth(s, begin, clock->time) > 0;
}

bool static_only_reduces(const Static *s, double end)
{
  return !s->spec->control && slide_growth(s, s->begin, end) > 0 && slide_others_stay(s, s->begin, end);
}

bool static_is_impossible(const Static *s, double end)
{
  return static_only_reduces(s, end) && distortion_first_impossible(s->domain) >= 0;
}

bool static_may_slide(const Static *s)
{
  for (int k = 0; k < s->loading->count; ++k)
    if (s->loading->loads[k].type == &strength_reduction_load) return true;
  return false;
}

/** Returns the length of the body along gravity; without gravity its shortest side between faces that do not repeat. */
static double slide_length(const Static *s)
{
  const Body *body = &s->domain->body;
  double sign = 1, shortest = INFINITY;
  const int up = loading_gravity_axis(s->loading, &sign);
  if (up >= 0 && up < body->dimensions) return body->high[up] - body->low[up];
  for (int k = 0; k < body->dimensions; ++k) {
    bool repeats = false;
    for (int m = 0; m < body->margins.count; ++m)
      repeats |= body->margins.items[m].repeats && body->margins.items[m].axis == k;
    if (!repeats) shortest = fmin(shortest, body->high[k] - body->low[k]);
  }
  return isfinite(shortest) ? shortest : 0;
}

/** Returns the displacement [length] with which the ground whose strength is reduced stores an energy. */
static double slide_elastic(const Static *s, double stored)
{
  const Domain *d = s->domain;
  double volume = 0, compliance = 0;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t i = d->particles->place_of[n];
    const Material *material = &d->materials[d->material[i / SLICE]];
    if (d->counted[i] <= 0 || !material_can_reduce(material)) continue;
    volume += d->particles->volume[i];
    compliance += d->particles->volume[i] / material_young(material);
  }
  return volume > 0 ? slide_length(s) * sqrt(2 * fmax(0, stored) * compliance) / volume : 0;
}

void static_begin_reduction(Solver *run)
{
  double *elastic = &run->records[run->clock.stage].elastic_displacement;
  const Static *s = run->own;
  if (*elastic == 0 && static_may_slide(s)) *elastic = slide_elastic(s, solver_energy(run).stored);
}

void static_note_motion(Static *s)
{
  const Particles *p = s->domain->particles;
  double largest = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double square = 0;
    for (int k = 0; k < 3 && s->newton.moved.row[k]; ++k)
      square += s->newton.moved.row[k][i] * s->newton.moved.row[k][i];
    largest = fmax(largest, square);
  }
  s->travelled += sqrt(largest);
}

bool static_slides(const Solver *run)
{
  const Static *s = run->own;
  const double elastic = run->records[run->clock.stage].elastic_displacement,
               growth = slide_growth(s, s->begin, run->clock.time);
  return elastic > 0 && growth > 0 && s->travelled > most_rate * growth * elastic;
}
