/* Prescribed motions that strain a body so far that the measure of strain matters to its laws (run_strains.c). */
#include "model/plausibility_parts.h"

#include "model/run.h"
#include <math.h>

/** A prescribed motion along an axis: the mean place of its particles, and the displacement at its largest. */
typedef struct MeanMotion {
  const Constraint *constraint;
  int axis;
  double displacement, place[3];
} MeanMotion;

/** Finds the motion of a constraint. @return false: along no axis, not the same for all particles, or of unknown size
 */
static bool find_motion(const breccia_model *model, const Constraint *c, MeanMotion *motion)
{
  const double straight = 1 - 1e-9, time = plausibility_time_of_load(model, c->load);
  const Particles *p = model->domain.particles;
  const Selection *on = &c->load->selection;
  *motion = (MeanMotion){.constraint = c, .axis = -1};
  for (int k = 0; k < 3; ++k)
    if (fabs(c->direction[k]) > straight) motion->axis = k;
  if (motion->axis < 0 || c->row || c->order || c->part || c->images || !on->count || !isfinite(time)) return false;
  if (history_is_controlled(&c->load->history)) return false;
  motion->displacement = c->direction[motion->axis] * c->value * history_peak(&c->load->history, time);
  for (int64_t n = 0; n < on->count; ++n)
    for (int k = 0; k < 3; ++k) motion->place[k] += p->position[k][on->places[n]] / (double)on->count;
  return true;
}

/** Mean strain, tensile above 0, by which two motions strain what stands between them, where that is most of the body;
 * of shear the largest principal one. */
static double strain_between(const Body *body, const MeanMotion *a, const MeanMotion *b)
{
  const double most_of_it = 0.5, moved = a->displacement - b->displacement;
  double strain = 0;
  if (a->axis != b->axis || a->constraint->load->first != b->constraint->load->first) return 0;
  for (int k = 0; k < body->dimensions; ++k) {
    const double apart = a->place[k] - b->place[k];
    if (fabs(apart) < most_of_it * (body->high[k] - body->low[k]) || apart == 0) continue;
    const double here = k == a->axis ? moved / apart : fabs(moved / apart) / 2;
    if (fabs(here) > fabs(strain)) strain = here;
  }
  return strain;
}

/** The first material whose law flows or softens and takes finite strain; NULL: none. */
static const Material *find_material(const Domain *d)
{
  for (int r = 0; r < d->region_count; ++r)
    for (int m = 0; m < d->material_count; ++m)
      if (region_is_made_of(d, &d->regions[r], d->materials[m].name) &&
          run_strain_matters(&d->regions[r], &d->materials[m]))
        return &d->materials[m];
  return NULL;
}

void plausibility_warn_of_strains(breccia_model *model)
{
  const Material *material = find_material(&model->domain);
  const Loading *loading = &model->loading;
  const Load *load = NULL;
  double largest = 0;
  MeanMotion a, b;
  for (int i = 0; material && i < loading->constraint_count; ++i)
    for (int k = 0; find_motion(model, &loading->constraints[i], &a) && k < i; ++k) {
      if (!find_motion(model, &loading->constraints[k], &b)) continue;
      const double strain = strain_between(&model->domain.body, &a, &b);
      if (!(fabs(strain) > fmax(run_strain_told_from, fabs(largest)))) continue;
      largest = strain;
      load = (fabs(a.displacement) > fabs(b.displacement) ? &a : &b)->constraint->load;
    }
  if (!load) return;
  plausibility_say(model, load->node,
                   "%s: prescribed motions strain the body by %.2g %% in the mean, and material '%s' flows or softens: "
                   "with 'strain: green-lagrange' forces on what flows are %.2g %% %s than with small strain, true "
                   "stresses %.2g %%; take 'strain: small' where rotations are small",
                   load->node->key, 100 * fabs(largest), material->name, 100 * fabs(largest),
                   largest > 0 ? "larger" : "smaller", 100 * fabs(largest * (2 + largest)));
}
