/* The step in the surface of ground: the height of a slope, a cut or a pit, in spacings. By this number alone a bound
 * is told for how far the factor of safety of a step comes out too high; it is what was measured (docs/choosing.md). */
#include "model/ground_step.h"

#include "base/memory.h"
#include "loading/load.h"
#include "loading/support.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

double ground_step_spacings(const Body *body, const Loading *loading)
{
  double sign = 1;
  const int up = loading_gravity_axis(loading, &sign);
  const Particles *p = &body->particles;
  const double spacing = body->largest_spacing;
  if (up < 0 || up >= body->dimensions || !(spacing > 0)) return 0;
  int64_t columns = 1, counts[3] = {1, 1, 1};
  for (int k = 0; k < body->dimensions; ++k) {
    if (k == up) continue;
    counts[k] = (int64_t)floor((body->high[k] - body->low[k]) / spacing + 1e-6) + 1;
    columns *= counts[k];
  }
  double *top = memory_plain((size_t)columns, sizeof *top), lowest = INFINITY, highest = -INFINITY;
  for (int64_t c = 0; top && c < columns; ++c) top[c] = -INFINITY;
  for (int64_t n = 0; top && n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    int64_t column = 0;
    bool inside = !body_outside(body, n);
    for (int k = 0; k < body->dimensions; ++k) {
      if (k == up) continue;
      const int64_t at = (int64_t)floor((p->position[k][i] - body->low[k]) / spacing + 0.5);
      inside &= at >= 0 && at < counts[k];
      column = column * counts[k] + at;
    }
    if (inside) top[column] = fmax(top[column], sign * p->position[up][i]);
  }
  for (int64_t c = 0; top && c < columns; ++c) {
    if (isinf(top[c])) continue;
    lowest = fmin(lowest, top[c]);
    highest = fmax(highest, top[c]);
  }
  free(top);
  return highest > lowest ? (highest - lowest) / spacing : 0;
}

/** Returns true if only the strength of laws resists slip lines: control of zero-energy modes fades with yielding in
 * all families. */
static bool ground_step_slips_freely(const Domain *d)
{
  bool freely = true;
  for (int r = 0; r < d->region_count; ++r)
    for (int m = 0; m < d->material_count; ++m) {
      const Region *region = &d->regions[r];
      if (!region_is_made_of(d, region, d->materials[m].name)) continue;
      const ControlType *control = region->type->control;
      freely &= control && control->influence_decreases(region->formulation) &&
                !control->keeps_stiffness(region->formulation, &d->materials[m]);
    }
  return freely;
}

double ground_step_excess(const Domain *d, double spacings)
{
  /* Measured factors over closed forms (docs/choosing.md) for vertical cuts:
   *   ordinary families            8 spacings           1.14
   *   control with full stiffness  16 spacings          1.29 or more
   *   control that fades           8, 12, 24 spacings   1.04, 1.03, 0.995 (8, 12 with friction 1.075, 1.055)
   * The first two excesses decrease with the square root of the number of spacings at best, and have one bound. */
  const double most = 0.35, few = 16, freely_most = 0.1, freely_spacings = 0.7;
  if (ground_step_slips_freely(d)) return fmin(freely_most, freely_spacings / spacings);
  return most * fmin(1, sqrt(few / spacings));
}

void ground_step_tell_level(const Domain *d, const char *before, const char *advice, Text *text)
{
  bool controlled = false;
  for (int r = 0; r < d->region_count; ++r)
    controlled |= d->regions[r].type->control && d->regions[r].type->control->is_active(d->regions[r].formulation);
  if (controlled && !ground_step_slips_freely(d))
    text_add(text,
             "%scontrol of zero-energy modes may hold ground that slides: slopes without end came out up to 16 %% too "
             "high, and ground under footings found no limit; halve the spacing and compare%s\n",
             before, advice);
}

bool ground_step_is_weakened(const Loading *loading)
{
  bool any = false;
  for (int k = 0; k < loading->count; ++k) any |= loading->loads[k].type == &strength_reduction_load;
  return any;
}

const LoadSpec *ground_step_held_base(const Domain *d, const Loading *loading)
{
  double sign = 1;
  const int up = loading_gravity_axis(loading, &sign);
  for (int k = 0; k < d->body.margins.count; ++k) {
    const Margin *margin = &d->body.margins.items[k];
    if (margin->repeats || support_slides(margin) || margin->axis != up || margin->high != (sign < 0)) continue;
    for (int m = 0; m < d->material_count; ++m)
      if (material_can_reduce(&d->materials[m]) &&
          !strcmp(d->materials[m].name, d->body.blocks[margin->block]->material))
        return margin->owner;
  }
  return NULL;
}

void ground_step_tell_low(const Domain *d, const Loading *loading, const char *before, Text *text)
{
  /* Measured factors over limit analysis and slip circles (docs/choosing.md), slopes of clay of 45 degrees and 2 : 1. */
  const LoadSpec *base = ground_step_held_base(d, loading);
  const char *yields_by_bonds = NULL;
  for (int r = 0; r < d->region_count; ++r)
    if (d->regions[r].type->take_strengths) yields_by_bonds = d->regions[r].type->name;
  if (base)
    text_add(text,
             "%sthe base is held in all directions by the support in line %d, beside which ground that yields carries "
             "too little: factors of clay whose slip circle touches such a base came out 8 to 22 %% too low, and 3 %% "
             "on two layers of ground below the base, held by 'displacement'\n",
             before, base->head.node->line);
  if (yields_by_bonds)
    text_add(text, "%sfactors of gentle slopes of clay came out 4 to 16 %% too low in '%s'\n", before, yields_by_bonds);
}
