/* Where a run stands: all that loads, histories, results and checkpoints see of a solver. */
#ifndef BRECCIA_SOLVER_CLOCK_H
#define BRECCIA_SOLVER_CLOCK_H

#include <stdint.h>

typedef struct Clock {
  int64_t step, steps;   /* done; in all, as far as it can be foreseen */
  double time, end_time; /* likewise */
  double time_step;      /* of the step to come */
  double stable; /* longest stable step of the body as it is, with its damping; INFINITY where there is no such limit */
  int64_t stage, stages; /* under way, from 0; in all */
  int64_t stage_step;    /* done when the stage began */
  double stage_time;
  int64_t stage_last; /* step and time at which it ends, as far as that can be foreseen */
  double stage_end;
  int64_t ended;      /* the stage has come to its end */
  char time_unit[32]; /* of all times, for messages */
} Clock;

#endif
