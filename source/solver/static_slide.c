/* Ground that slides as strengths are reduced. A body that slides may come to rest elsewhere: control of zero-energy
 * modes or families that resist uneven motions hold slip lines that the law does not hold. Such a state of rest says
 * nothing of the ground. Displacement then grows much faster with the factor F than in an elastic body: the stage
 * judges by |du| / dln(F) over the displacement l sqrt(2 W / (E V)), with which a body of the shortest side l and the
 * volume V would store the energy W that is stored as the reduction begins. */
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

bool static_is_impossible(const Static *s, double begin, double end)
{
  return slide_growth(s, begin, end) > 0 && slide_others_stay(s, begin, end) &&
         distortion_first_impossible(s->domain) >= 0;
}

bool static_may_slide(const Static *s)
{
  for (int k = 0; k < s->loading->count; ++k)
    if (s->loading->loads[k].type == &strength_reduction_load) return true;
  return false;
}

/** Returns the displacement [length] with which a body of the size and volume of the domain stores an energy. */
static double slide_elastic(const Domain *d, double stored)
{
  double side = INFINITY, volume = 0, stiffest = 0;
  for (int k = 0; k < d->body.dimensions; ++k) side = fmin(side, d->body.high[k] - d->body.low[k]);
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t i = d->particles->place_of[n];
    if (d->counted[i] > 0) volume += d->particles->volume[i];
  }
  for (int k = 0; k < d->material_count; ++k) stiffest = fmax(stiffest, material_young(&d->materials[k]));
  return volume > 0 && stiffest > 0 ? side * sqrt(2 * fmax(0, stored) / (stiffest * volume)) : 0;
}

void static_begin_reduction(Solver *run)
{
  double *elastic = &run->records[run->clock.stage].elastic_displacement;
  const Static *s = run->own;
  if (*elastic == 0 && static_may_slide(s)) *elastic = slide_elastic(s->domain, solver_energy(run).stored);
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

bool static_slides(const Solver *run, double begin)
{
  const Static *s = run->own;
  const double elastic = run->records[run->clock.stage].elastic_displacement,
               growth = slide_growth(s, begin, run->clock.time);
  return elastic > 0 && growth > 0 && s->travelled > most_rate * growth * elastic;
}
