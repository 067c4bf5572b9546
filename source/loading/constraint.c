#include "loading/constraint.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Says so if two constraints move a particle in directions that are not at right angles.
 *  @param[in] marked  [places] 1 where the first one does */
static int check_pair(const Constraint *first, const Constraint *second, const uint8_t *marked, const Particles *p,
                      const DeckReader *reader)
{
  double cosine = 0;
  for (int k = 0; k < 3; ++k) cosine += first->direction[k] * second->direction[k];
  if (first->row != second->row) return BRECCIA_OK;
  if (first->load->behind <= second->load->first || second->load->behind <= first->load->first || fabs(cosine) < 1e-9)
    return BRECCIA_OK;
  for (int64_t n = 0; n < second->load->selection.count; ++n) {
    const int32_t place = second->load->selection.places[n];
    if (!marked[place]) continue;
    return node_error(reader->document, second->load->spec->head.node, reader->error,
                      "load: particle %d at [%g, %g, %g] already moves as the load in line %d says, in a direction "
                      "that is not at right angles to this one",
                      p->number[place], p->position[0][place], p->position[1][place], p->position[2][place],
                      first->load->spec->head.node->line);
  }
  return BRECCIA_OK;
}

int constraints_check(const Loading *loading, const Particles *particles, const DeckReader *reader)
{
  int status = BRECCIA_OK;
  uint8_t *marked = memory_zeroed((size_t)particles->places, 1, "prescribed motions", reader->error);
  if (!marked) return BRECCIA_FAILURE;
  for (int a = 0; a < loading->constraint_count; ++a) {
    const Constraint *first = &loading->constraints[a];
    memset(marked, 0, (size_t)particles->places);
    for (int64_t n = 0; n < first->load->selection.count; ++n) marked[first->load->selection.places[n]] = 1;
    for (int b = a + 1; b < loading->constraint_count; ++b)
      if (check_pair(first, &loading->constraints[b], marked, particles, reader)) status = BRECCIA_USER_ERROR;
  }
  free(marked);
  return status;
}

double constraint_displacement(const Constraint *constraint, double run_time)
{
  Load *load = constraint->load;
  const double time = run_time - load->begin;
  if (constraint->order) return history_integral(&load->history, constraint->order, constraint->value, time);
  return constraint->value * history_factor(&load->history, time);
}

double constraint_change(const Constraint *constraint, double from, double to)
{
  const double begin = constraint->load->begin, little = 1e-9 * (to - begin);
  return constraint_displacement(constraint, to) -
         (from <= begin + little ? 0 : constraint_displacement(constraint, from)); /* at first 0, whatever is told */
}

double constraint_velocity(const Constraint *constraint, double run_time, double step)
{
  Load *load = constraint->load;
  const double time = run_time - load->begin, little = 1e-3 * step, before = fmax(run_time - little, load->begin);
  if (constraint->order == 1) return constraint->value * history_factor(&load->history, time);
  if (constraint->order == 2) return history_integral(&load->history, 1, constraint->value, time);
  return (constraint_displacement(constraint, run_time + little) - constraint_displacement(constraint, before)) /
         (run_time + little - before);
}

double constraint_acceleration(const Constraint *constraint, double run_time, double step)
{
  Load *load = constraint->load;
  const double time = run_time - load->begin;
  if (time <= 0) return 0;
  if (constraint->order == 2) return constraint->value * history_factor(&load->history, time);
  return (constraint_displacement(constraint, run_time + step) - 2 * constraint_displacement(constraint, run_time) +
          constraint_displacement(constraint, run_time - step)) /
         (step * step);
}
