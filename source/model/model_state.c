/* The state of a model as a list. */
#include "model/model.h"

void model_state(breccia_model *model, StateList *list)
{
  Peaks *peaks = &model->peaks;
  const struct {
    const char *name, *unit;
    double *value;
  } largest[] = {{"largest displacement", "length", &peaks->displacement},
                 {"largest velocity", "velocity", &peaks->velocity},
                 {"largest octahedral shear stress", "stress", &peaks->octahedral},
                 {"lowest mean stress", "stress", &peaks->mean_low},
                 {"highest mean stress", "stress", &peaks->mean_high},
                 {"largest damage", "1", &peaks->damage}};
  domain_state(&model->domain, list);
  solver_state(&model->solver, list);
  for (size_t k = 0; k < sizeof largest / sizeof *largest; ++k)
    state_add_number(list, largest[k].name, largest[k].unit, STATE_COMMITTED, largest[k].value);
  state_add_count(list, "states of the stage written", STATE_COMMITTED, &model->next_due);
  state_add_count(list, "step of the last state written", STATE_COMMITTED, &model->last_due);
  state_add_count(list, "states written", STATE_COMMITTED, &model->states_due);
  state_add_count(list, "bytes of solution.txt", STATE_COMMITTED, &model->log_bytes);
  if (model->watches) watches_state(model->watches, list);
  if (model->profiles) profiles_state(model->profiles, list);
}
