/* A step of Drucker-Prager plasticity, a point a lane, for each kind of vectors (drucker_prager.c tells the law). */
#include "constitutive/solid/drucker_prager.h"

/** Slopes of a return to the cone, or else to the cut-off and to where the cone meets it. */
LANES_INLINE ReturnSlopes slopes_of(const DruckerPrager *c, bool cone, double stiffness, double hard, bool shears)
{
  const double shear2 = 2 * c->elastic.shear, bulk9 = 9 * c->elastic.bulk, whole = stiffness + 2 * hard / 3;
  if (cone)
    return (ReturnSlopes){1 - bulk9 * c->dilation * c->slope / whole, -bulk9 * c->dilation / whole,
                          -shear2 * c->slope / whole, 1 - shear2 / whole};
  return (ReturnSlopes){0, 0, 0, shears ? 1 - shear2 / (shear2 + 2 * hard / 3) : 1};
}

LANES_INLINE void step(const void *constants, SolidLanes *p, bool tangents)
{
  const DruckerPrager *c = constants;
  const double shear2 = 2 * c->elastic.shear, bulk9 = 9 * c->elastic.bulk,
               stiffness = shear2 + bulk9 * c->slope * c->dilation;
  const Lanes zero = lanes_set(0), x = p->committed[CONE_EQUIVALENT], cut = lanes_set(c->cut);
  TrialLanes t;
  plastic_trial_lanes(&c->elastic, p, &t);
  const Lanes radius = lanes_product(lanes_set(root23), hardening_strength(&c->hardening, x)),
              excess = (t.length + lanes_set(c->slope) * t.invariant) - radius;
  const LaneMask flows = (excess > zero) | (t.invariant > cut);
  Lanes grown, hard, hard_at_cut;
  const Lanes on_cone = hardening_multiplier(&c->hardening, excess, stiffness, x, &grown, &hard),
              dilated = t.invariant - lanes_set(bulk9 * c->dilation) * on_cone,
              sheared = t.length - lanes_set(shear2) * on_cone;
  const LaneMask cone = (excess > zero) & (dilated <= cut) & (sheared >= zero);
  /* Otherwise the cut-off, or where the cone meets it. Without friction there may be none. */
  const Lanes rest = radius - lanes_set(isinf(c->cut) ? 0 : c->slope * c->cut), at_cut = lanes_where(rest > zero, rest),
              beyond = t.length - at_cut;
  const LaneMask shears = beyond > zero;
  const Lanes on_cut = hardening_multiplier(&c->hardening, beyond, shear2, x, &grown, &hard_at_cut),
              left = t.length - lanes_set(shear2) * on_cut;
  const Lanes invariant = lanes_choose(flows, lanes_choose(cone, dilated, cut), t.invariant),
              length = lanes_choose(flows, lanes_choose(cone, sheared, lanes_where(left > zero, left)), t.length),
              flow = lanes_where(flows, lanes_choose(cone, on_cone, on_cut));
  const LaneMask turned = t.length > zero;
  const Lanes shrink = lanes_where(turned, length / lanes_choose(turned, t.length, lanes_set(1))),
              mean = lanes_product(invariant, lanes_set(1.0 / 3));
  Lanes deviator[6], plastic[6];
  for (int k = 0; k < 6; ++k) {
    deviator[k] = lanes_choose(flows, lanes_product(t.s[k], shrink), t.s[k]);
    p->stress[k] = k < 3 ? deviator[k] + mean : deviator[k];
  }
  p->trial[CONE_EQUIVALENT] = x + lanes_set(root23) * flow;
  plastic_rest_lanes(&c->elastic, p->strain, invariant, deviator, plastic);
  for (int k = 0; k < 6; ++k) p->trial[k] = lanes_choose(flows, plastic[k], p->committed[k]);
  for (int l = 0; l < LANES && tangents; ++l) {
    double s[6];
    for (int k = 0; k < 6; ++k) s[k] = t.s[k][l];
    const ReturnSlopes slopes =
        slopes_of(c, cone[l] != 0, stiffness, cone[l] ? hard[l] : hard_at_cut[l], shears[l] != 0);
    if (flows[l])
      return_tangent(&c->elastic, &slopes, length[l], t.length[l], s, p->tangent[l]);
    else
      elastic_tangent(&c->elastic, p->tangent[l]);
  }
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, const Lanes *history, LaneMask *found)
{
  const DruckerPrager *c = constants;
  const Lanes radius = hardening_least(&c->hardening, history[CONE_EQUIVALENT]);
  *found = (t->length + lanes_set(c->slope) * t->invariant <= radius) & (t->invariant <= lanes_set(c->cut));
}

int LANES_NAMED(drucker_prager_update)(const void *constants, const breccia_batch *batch)
{
  const DruckerPrager *c = constants;
  return solid_update_lanes(constants, batch, CONE_HISTORY, &c->elastic, true, inside, step, NULL);
}
