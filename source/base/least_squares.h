/* The least sum of squares within a box, by Levenberg's and Marquardt's damped Gauss-Newton steps. */
#ifndef BRECCIA_BASE_LEAST_SQUARES_H
#define BRECCIA_BASE_LEAST_SQUARES_H

#include "base/error.h"
#include <stdbool.h>

typedef struct LeastSquares {
  int parameters, count; /* places of parameters, residuals */
  /** Fills [count] residuals at a place. @return false: there are none there */
  bool (*residuals)(void *context, const double *at, double *residual);
  void *context;
  double *residual, *trial, *jacobian, *matrix, *step, *to; /* [count], [count], [parameters][count], ...; owned */
  int *movable;                                             /* [parameters], owned */
} LeastSquares;

/** @param[in,out] problem  its first four members are given */
int least_squares_create(LeastSquares *problem, Error *error);
void least_squares_destroy(LeastSquares *problem);

/** Goes down from a place in the box of [0, 1] in each parameter; derivatives are differences.
 *  @param[in,out] at  [parameters]
 *  @return the sum of squares there; infinite if there are no residuals where it begins */
double least_squares_descend(LeastSquares *problem, double *at);

/** Products of the derivatives of the residuals at a place, whose inverse is the covariance of the parameters but for the variance of the
 *  points. @param[out] matrix  [parameters][parameters] */
void least_squares_curvature(LeastSquares *problem, const double *at, double *matrix);

#endif
