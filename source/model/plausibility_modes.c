/* The lowest frequency of a body as it is held, where a deck asks how long loads, damping and steps should take. */
#include "model/plausibility_parts.h"
#include <math.h>

#include "solver/modes.h"

/** Where the stage under way comes to rest or follows motions by long steps, or a load takes its time. */
static bool is_wanted(const breccia_model *model)
{
  const Solver *s = &model->solver;
  bool wanted = s->type->few_steps || s->type->damps(s);
  for (int k = 0; k < model->loading.count; ++k) wanted |= history_rise(&model->loading.loads[k].history) > 0;
  return wanted;
}

/** About a second of a slow machine, by factors of the stiffness: 4000 particles in the plane, 400 in space, of a horizon of three spacings. */
static bool is_small(const Domain *d)
{
  const double particles = (double)d->particles->count, family = (double)d->family.bonds / particles;
  return particles <= (d->body.dimensions == 3 ? 400 : 4000) && particles * family * family <= 3.2e6;
}

/** In Hz, of what is bent; 0: not known. @param[out] loose  the body can move as a whole */
static double lowest_frequency(breccia_model *model, bool *loose)
{
  const int most_rigid = model->domain.body.dimensions == 3 ? 6 : 3, tries[] = {1, 1 + most_rigid};
  Entry entry;
  double found = 0;
  *loose = false;
  if (model_enter(model, &entry, NULL)) return 0;
  for (int k = 0; k < 2 && found == 0; ++k) {
    Modes modes = {0};
    if (!modes_find(&model->domain, &model->loading, tries[k], &modes, NULL)) {
      *loose = modes.rigid > 0;
      if (modes.rigid < modes.count) found = plausibility_in_si(model, "frequency", modes.modes[modes.rigid].frequency);
    }
    modes_destroy(&modes);
  }
  model_leave(&entry, BRECCIA_OK, NULL);
  return found;
}

static void advise(const breccia_model *model, double frequency, Text *text)
{
  const Solver *s = &model->solver;
  if (s->type->rests || !isnan(solver_stage_steady(s, s->clock.stage))) return; /* 'quasi-static' has chosen both */
  if (s->type->few_steps) {
    text_add(text, "; steps of ");
    quantity_describe(1 / (20 * frequency), "s", text);
    text_add(text, " follow it");
    return;
  }
  text_add(text, "; loads over ");
  quantity_describe(5 / frequency, "s", text);
  text_add(text, " to ");
  quantity_describe(10 / frequency, "s", text);
  text_add(text, " leave it at rest; damping: {ratio: 1, at: %.4g Hz} brings it to rest soonest", frequency);
}

bool plausibility_describe_mode(breccia_model *model, Text *text)
{
  if (!is_wanted(model) || !is_small(&model->domain) || domain_has_servers(&model->domain)) return false;
  bool loose;
  const double frequency = lowest_frequency(model, &loose);
  if (!(frequency > 0)) return false;
  text_add(text, "  lowest frequency as the body is held%s: ", loose ? ", apart from motion as a whole" : "");
  quantity_describe(frequency, "Hz", text);
  text_add(text, ", a period of ");
  quantity_describe(1 / frequency, "s", text);
  advise(model, frequency, text);
  text_add(text, "\n");
  return true;
}

void plausibility_warn_of_damping(breccia_model *model)
{
  const double most =
      20; /* times what is critical along the body, which is more than what is critical of its slowest vibration */
  const double frequency = plausibility_frequency_along(model), critical = 4 * acos(-1) * frequency;
  for (int64_t k = 0; k < model->solver.clock.stages; ++k) {
    const Node *node;
    const double rate = solver_stage_damping(&model->solver, k, &node) / plausibility_in_si(model, "time", 1);
    if (!(rate > most * critical)) continue;
    Text words[2] = {{0}, {0}};
    quantity_describe(frequency, "Hz", &words[0]);
    quantity_describe(rate / pow(2 * acos(-1) * frequency, 2), "s", &words[1]);
    plausibility_say(model, node,
                     "%s: it is %.3g times critical for the vibration along the body of about %s, so that the body "
                     "creeps: a deflection fades to a third in %s or longer; 'damping: {ratio: 1, at: ...}' with the "
                     "frequency that 'breccia modes' finds brings it to rest soonest",
                     node->key, rate / critical, text_words(&words[0]), text_words(&words[1]));
    text_free(&words[0]);
    text_free(&words[1]);
  }
}
