/* What families that yield or relax remember, as rows of the state, and their commit. */
#include "formulation/ordinary.h"

#include "base/team.h"
#include <string.h>

/** As laws name it. */
static const char equivalent_name[] = "equivalent plastic strain";

typedef struct Commit {
  const Ordinary *ordinary;
  int from, to; /* of both states */
} Commit;

static void copy_slice(void *context, int64_t slice)
{
  const Commit *c = context;
  const Flow *flow = c->ordinary->flow;
  const int64_t *slots = c->ordinary->family->first + slice, first = slots[0] * SLICE;
  const size_t bytes = sizeof(double) * (size_t)(slots[1] - slots[0]) * SLICE;
  memcpy(flow->shift[c->to] + first, flow->shift[c->from] + first, bytes);
  if (flow->last[0]) memcpy(flow->last[c->to] + first, flow->last[c->from] + first, bytes);
  double *const *const of_places[] = {flow->across, flow->across_last, flow->equivalent};
  for (int k = 0; k < 3; ++k)
    memcpy(of_places[k][c->to] + slice * SLICE, of_places[k][c->from] + slice * SLICE, SLICE * sizeof(double));
}

void ordinary_commit(void *formulation, bool well)
{
  Commit commit = {formulation, well, !well};
  if (commit.ordinary->flow) team_each(commit.ordinary->particles->slices, copy_slice, &commit);
}

/** The committed state was put in place from outside. */
static int take_up(void *owner, const double *numbers, int64_t count, Error *error)
{
  (void)numbers;
  (void)count;
  (void)error;
  ordinary_commit(owner, false);
  return BRECCIA_OK;
}

void ordinary_state(void *formulation, const char *part, StateList *list)
{
  static const StateCare care = {.resume = take_up};
  Ordinary *o = formulation;
  if (!o->flow) return;
  const struct {
    const char *name, *unit;
    StateEntity entity;
    double *values;
  } rows[] = {
      {"inelastic elongation", "length", STATE_OF_SLOT, o->flow->shift[0]},
      {"deviatoric elongation", "length", STATE_OF_SLOT, o->flow->last[0]},
      {"inelastic dilatation of the plane", "1", STATE_OF_PLACE, o->flow->across[0]},
      {"deviatoric strain across", "1", STATE_OF_PLACE, o->flow->across_last[0]},
      {equivalent_name, "1", STATE_OF_PLACE, o->flow->equivalent[0]},
  };
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    const bool of_slot = rows[k].entity == STATE_OF_SLOT;
    const StateRow row = {.unit = rows[k].unit,
                          .kind = STATE_NUMBERS,
                          .entity = rows[k].entity,
                          .role = STATE_COMMITTED,
                          .count = of_slot ? o->family->slots * SLICE : o->particles->places,
                          .values = rows[k].values,
                          .care = &care,
                          .owner = o};
    if (row.values) state_add(list, &row, rows[k].name, part);
  }
}

double ordinary_history(const void *formulation, int64_t place, int k)
{
  const Ordinary *o = formulation;
  const Material *m = ordinary_material(o, place);
  char name[64] = "";
  if (m->law->history_name) m->law->history_name(m->constants, k, name, sizeof name);
  return o->flow && !strcmp(name, equivalent_name) ? o->flow->equivalent[0][place] : 0;
}

size_t ordinary_flow_bytes(const Ordinary *o)
{
  if (!o->flow) return 0;
  const size_t of_slot = (o->flow->last[0] ? 4 : 2) * sizeof(double) + sizeof *o->flow->back,
               of_place = 6 * sizeof(double) + sizeof *o->flow->returned;
  return (size_t)o->family->slots * SLICE * of_slot + (size_t)o->particles->places * of_place;
}
