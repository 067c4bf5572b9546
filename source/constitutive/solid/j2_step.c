/* A step of J2 plasticity, a point a lane, for each kind of vectors (j2.c tells the law). */
#include "constitutive/solid/j2.h"

/** @param[in] travels  whether the back stress can move: a constant */
LANES_INLINE void step_of(const J2 *c, SolidLanes *p, bool travels, bool tangents)
{
  const double shear = c->elastic.shear, straight = 2 * shear + 2 * c->kinematic / 3;
  const Lanes *back = p->committed + J2_BACK, x = p->committed[J2_EQUIVALENT];
  TrialLanes t;
  Lanes distance[6], deviator[6], plastic[6], grown, slope;
  plastic_trial_lanes(&c->elastic, p, &t);
  for (int k = 0; k < 6; ++k) distance[k] = travels ? t.s[k] - back[k] : t.s[k];
  const Lanes length = travels ? lanes_norm(distance) : t.length, strength = hardening_strength(&c->hardening, x),
              excess = length - lanes_set(root23) * strength;
  const LaneMask flows = excess > lanes_set(0);
  const Lanes flow = hardening_multiplier(&c->hardening, excess, straight, x, &grown, &slope),
              radius = lanes_product(lanes_set(root23), strength + grown),
              inverse = lanes_set(1) / lanes_choose(flows, length, lanes_set(1)),
              mean = lanes_product(t.invariant, lanes_set(1.0 / 3)),
              moved = lanes_product(lanes_set(2 * c->kinematic / 3), flow);
  for (int k = 0; k < 6; ++k) {
    distance[k] = lanes_product(distance[k], inverse);
    const Lanes centre = travels ? back[k] + moved * distance[k] : lanes_set(0);
    deviator[k] = lanes_choose(flows, centre + radius * distance[k], t.s[k]);
    if (travels) p->trial[J2_BACK + k] = lanes_choose(flows, centre, back[k]);
    p->stress[k] = k < 3 ? deviator[k] + mean : deviator[k];
  }
  p->trial[J2_EQUIVALENT] = x + lanes_set(root23) * flow;
  plastic_rest_lanes(&c->elastic, p->strain, t.invariant, deviator, plastic);
  for (int k = 0; k < 6; ++k) p->trial[k] = lanes_choose(flows, plastic[k], p->committed[k]);
  for (int l = 0; l < LANES && tangents; ++l) {
    double n[6];
    for (int k = 0; k < 6; ++k) n[k] = distance[k][l];
    const double turned = 1 - 2 * shear * flow[l] * inverse[l], along = 2 * shear / (straight + 2 * slope[l] / 3);
    if (flows[l])
      solid_tangent(c->elastic.bulk, 0, 0, 2 * shear * (1 - along - turned), 2 * shear * turned, n, p->tangent[l]);
    else
      elastic_tangent(&c->elastic, p->tangent[l]);
  }
}

LANES_INLINE void step(const void *constants, SolidLanes *p, bool tangents)
{
  step_of(constants, p, false, tangents);
}

LANES_INLINE void step_that_travels(const void *constants, SolidLanes *p, bool tangents)
{
  step_of(constants, p, true, tangents);
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, const Lanes *history, LaneMask *found)
{
  const J2 *c = constants;
  *found = t->length <= hardening_least(&c->hardening, history[J2_EQUIVALENT]);
}

LANES_INLINE void inside_that_travels(const void *constants, const TrialLanes *t, const Lanes *history, LaneMask *found)
{
  const J2 *c = constants;
  Lanes distance[6];
  for (int k = 0; k < 6; ++k) distance[k] = t->s[k] - history[J2_BACK + k];
  *found = lanes_norm(distance) <= hardening_least(&c->hardening, history[J2_EQUIVALENT]);
}

int LANES_NAMED(j2_update)(const void *constants, const breccia_batch *batch)
{
  const J2 *c = constants;
  if (c->kinematic > 0)
    return solid_update_lanes(constants, batch, J2_HISTORY, &c->elastic, true, inside_that_travels, step_that_travels,
                              NULL);
  return solid_update_lanes(constants, batch, J2_BACK, &c->elastic, true, inside, step, NULL);
}
