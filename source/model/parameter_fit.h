/* Parameters of a law fitted to measured points. */
#ifndef BRECCIA_MODEL_PARAMETER_FIT_H
#define BRECCIA_MODEL_PARAMETER_FIT_H

#include "model/element_deck.h"

typedef struct FittedParameter {
  int index; /* in the law's table */
  double from, to, start, value;
  double
      sensitivity; /* growth of the mean distance for a change of the value by one per cent of its range, in range of the points */
} FittedParameter;

typedef struct ParameterFit {
  FittedParameter *parameters;
  int count, runs; /* runs of the test */
  double before, after,
      most; /* mean distance of the points from the curve before and after, and the largest after (element_curve_compare) */
} ParameterFit;

/** Chooses the parameters under `fit` such that the points lie nearest to the curve of the test, with NLopt's Subplex from the deck's values
 *  and from four more places in the ranges; leaves the deck's material with them.
 *  @param[in] x, y  [count] measured points */
int parameter_fit_run(ElementDeck *deck, const double *x, const double *y, int count, ParameterFit *fit, Error *error);
void parameter_fit_destroy(ParameterFit *fit);

#endif
