/* The state of a model as a list, and its arrays by name. */
#include "model/model.h"

#include <string.h>

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
}

double *breccia_model_array(breccia_model *model, const char *name)
{
  if (!strncmp(name, "strain ", 7) || !strncmp(name, "stress ", 7)) {
    Team *before = team_use(model->team);
    const int bad = domain_observe(&model->domain, NULL);
    team_use(before);
    if (bad) return NULL;
  }
  StateList list = {0};
  model_state(model, &list);
  const StateRow *row = state_find(&list, name);
  double *values = row && row->entity == STATE_OF_PLACE && row->kind == STATE_NUMBERS ? row->values : NULL;
  state_list_destroy(&list);
  return values;
}
