/* Which of two particles or elements is nearer to a point: round-off must not decide between equals. */
#ifndef BRECCIA_BODY_NEARER_H
#define BRECCIA_BODY_NEARER_H

#include <stdbool.h>

/** Whether a square of a distance is less than the least so far. */
static inline bool is_nearer(double square, double least)
{
  return square < least * (1 - 1e-9);
}

#endif
