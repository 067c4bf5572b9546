#include "model/outlook.h"

#include <math.h>

#define BYTE_SECONDS 2e-9 /* 500 MB/s */
#define PICTURE_SECONDS 0.1
#define PARTICLE_SECONDS 5e-6 /* in a picture */

void outlook_expect(Outlook *o, double step_seconds, double state_bytes, double checkpoint_bytes, int64_t particles)
{
  pace_expect(&o->steps, step_seconds);
  pace_expect(&o->bytes, BYTE_SECONDS);
  pace_expect(&o->checkpoints, checkpoint_bytes * BYTE_SECONDS);
  o->state_bytes = state_bytes;
  o->picture_seconds = PICTURE_SECONDS + PARTICLE_SECONDS * (double)particles;
}

double outlook_left(const Outlook *o, const Task *t)
{
  const double bytes = o->state_bytes * (double)(t->states - t->states_written);
  const double work = (double)t->steps * pace_of(&o->steps) + bytes * pace_of(&o->bytes);
  const double checkpoints = fmax((double)t->checkpoints, floor(work / t->checkpoint_seconds)) + 1; /* one at the end */
  return work + checkpoints * pace_of(&o->checkpoints) + (double)t->pictures * o->picture_seconds;
}
