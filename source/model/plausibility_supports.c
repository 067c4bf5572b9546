/* Supports whose images outside the body are too few, or not what their material takes. */
#include "model/plausibility_parts.h"

#include "loading/support.h"
#include "model/ground_step.h"
#include <string.h>

/** Two faces of a block that are held one opposite the other: beyond as many layers as stand between them a mirror would show its own image in the
 *  other one, which is not there. */
static void check_pair(breccia_model *model, const Margin *low, const Margin *high)
{
  const Lattice *lattice = &model->domain.body.lattices[low->block];
  const int k = low->axis;
  const int64_t between = lattice->cells[k] - lattice->margin[k][0] - lattice->margin[k][1],
                wanted = low->layers > high->layers ? low->layers : high->layers;
  if (between >= wanted) return;
  const LoadSpec *of = (high->owner == low->owner ? low : high)->owner;
  plausibility_say(
      model, of->head.node,
      "support: %lld layer%s between the faces %c- and %c+, which are both held, and %lld outside each are wanted: "
      "families there are not whole, and stresses are off by some per cent with one layer less, by half with half of "
      "them; take a finer spacing or a shorter horizon, or hold one face by 'displacement'",
      (long long)between, between == 1 ? " stands" : "s stand", "xyz"[k], "xyz"[k], (long long)wanted);
}

/** Images turned back in all directions have the strain across the face of those inside and not that along it: in nearly incompressible materials they
 *  would change their volume, against a bulk modulus that is large beyond all else. */
static void check_held(breccia_model *model, const Margin *margin)
{
  const double most = 0.499;
  const Domain *d = &model->domain;
  const char *name = d->body.blocks[margin->block]->material;
  const LoadSpec *of = margin->owner;
  const bool plane_stress = peridynamics_space(model->spec->peridynamics) == SPACE_PLANE_STRESS;
  if (margin->repeats || support_slides(margin) || plane_stress || d->body.dimensions < 2) return;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    const double ratio = material_poisson(m);
    if (strcmp(m->name, name) || !m->law || m->law->components != 6 || !(ratio > most)) continue;
    plausibility_say(
        model, of->head.node,
        "support: held in all directions beside material '%s' of Poisson ratio %.6g: images outside would "
        "have to change their volume, and the body moves wrongly (by 1.3 times the right way at 0.4999, 30 "
        "times at 0.49999); hold layers by 'displacement' here, or stay below %g",
        name, ratio, most);
  }
}

/** Images turned back in all directions do not yield as the ground inside does: factors of safety come out too low. */
static void check_held_base(breccia_model *model)
{
  const LoadSpec *base = ground_step_held_base(&model->domain, &model->loading);
  if (!base || !ground_step_is_weakened(&model->loading)) return;
  plausibility_say(
      model, base->head.node,
      "support: the base is held in all directions below ground that yields, and a factor of safety comes out too low "
      "where the ground slides along it: measured 8 to 22 %% with clay, 3 %% on held layers; let the block begin two "
      "spacings lower, and hold these layers by {on: {face: ..., layers: 2}, displacement: ...} instead");
}

void plausibility_warn_of_supports(breccia_model *model)
{
  const MarginList *list = &model->domain.body.margins;
  check_held_base(model);
  for (int a = 0; a < list->count; ++a) check_held(model, &list->items[a]);
  for (int a = 0; a < list->count; ++a)
    for (int b = 0; b < list->count; ++b) {
      const Margin *low = &list->items[a], *high = &list->items[b];
      if (low->block == high->block && low->axis == high->axis && !low->high && high->high && !low->repeats)
        check_pair(model, low, high);
    }
}
