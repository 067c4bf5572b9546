/* How long a run will still take: its steps, the states and checkpoints that it writes, its pictures. Before it begins that follows from
 * a few evaluations of the forces and from what computers usually write in a second; later from how long each took of late. */
#ifndef BRECCIA_MODEL_OUTLOOK_H
#define BRECCIA_MODEL_OUTLOOK_H

#include "base/pace.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct Outlook {
  Pace steps, bytes, checkpoints; /* `bytes`: of states that are written */
  double state_bytes;             /* of one state */
  double picture_seconds;         /* of one picture */
  bool least;                     /* what was expected beforehand is the least that steps take */
} Outlook;

typedef struct Task { /* what is still to be done */
  int64_t steps;
  int64_t states_written, states; /* in the result file: so far, at the end */
  int64_t checkpoints;            /* due at certain steps */
  double checkpoint_seconds;      /* between those that are due because of the time; INFINITY: none */
  int64_t pictures;
} Task;

/** What is expected beforehand. */
void outlook_expect(Outlook *outlook, double step_seconds, double state_bytes, double checkpoint_bytes,
                    int64_t particles);

/** @return seconds */
double outlook_left(const Outlook *outlook, const Task *task);

#endif
