/* The state of a model as a list. */
#include "model/model.h"

/** A state that is put in place as a whole is no motion that a program has written. */
static int model_forget_motion(void *owner, const double *numbers, int64_t count, Error *error)
{
  (void)numbers, (void)count, (void)error;
  breccia_model *model = owner;
  model->motion_is_left = false;
  return BRECCIA_OK;
}

void model_state(breccia_model *model, StateList *list)
{
  static const StateCare care = {.resume = model_forget_motion};
  Peaks *peaks = &model->peaks;
  const struct {
    const char *name, *unit;
    double *value;
  } largest[] = {{"largest displacement", "length", &peaks->displacement},
                 {"largest velocity", "velocity", &peaks->velocity},
                 {"largest octahedral shear stress", "stress", &peaks->octahedral},
                 {"lowest mean stress", "stress", &peaks->mean_low},
                 {"highest mean stress", "stress", &peaks->mean_high},
                 {"largest damage", "1", &peaks->damage},
                 {"lowest finite strain", "1", &peaks->strain_low},
                 {"highest finite strain", "1", &peaks->strain_high},
                 {"strength reduction held by control", "1", &peaks->reduction_held},
                 {"strength reduction before", "1", &peaks->reduction_free},
                 {"time of the first softened point", "time", &peaks->softened_time}};
  domain_state(&model->domain, list);
  solver_state(&model->solver, list);
  for (size_t k = 0; k < sizeof largest / sizeof *largest; ++k)
    state_add_number(list, largest[k].name, largest[k].unit, STATE_COMMITTED, largest[k].value);
  const int64_t materials = model->domain.material_count;
  if (model->compressions.stress) {
    state_add(list,
              &(StateRow){
                  .unit = "stress", .role = STATE_COMMITTED, .count = materials, .values = model->compressions.stress},
              "largest compressions", NULL);
    state_add(list,
              &(StateRow){
                  .unit = "length", .role = STATE_COMMITTED, .count = 3 * materials, .values = model->compressions.at},
              "places of largest compressions", NULL);
  }
  state_add(list,
            &(StateRow){.unit = "1",
                        .kind = STATE_COUNTS,
                        .role = STATE_COMMITTED,
                        .count = 1,
                        .values = &model->next_due,
                        .care = &care,
                        .owner = model},
            "states of the stage written", NULL);
  state_add_count(list, "step of the last state written", STATE_COMMITTED, &model->last_due);
  state_add_count(list, "states written", STATE_COMMITTED, &model->states_due);
  state_add_count(list, "bytes of solution.txt", STATE_COMMITTED, &model->log_bytes);
  if (model->watches) watches_state(model->watches, list);
  if (model->profiles) profiles_state(model->profiles, list);
}
