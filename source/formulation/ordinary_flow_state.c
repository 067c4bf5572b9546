/* What families that yield or relax remember, as rows of the state, and their commit. */
#include "formulation/ordinary.h"

#include "base/team.h"
#include <string.h>

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
      {"equivalent plastic strain", "1", STATE_OF_PLACE, o->flow->equivalent[0]},
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
