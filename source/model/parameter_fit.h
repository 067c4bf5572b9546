/* Parameters of a law fitted to measured points. */
#ifndef BRECCIA_MODEL_PARAMETER_FIT_H
#define BRECCIA_MODEL_PARAMETER_FIT_H

#include "model/element_deck.h"

typedef struct FittedParameter {
  int index;     /* in the law's table */
  bool by_ratio; /* searched on a logarithmic scale */
  double from, to, start, value;
  /* How well the points tell it, from the curvature of the misfit; in the parameter's unit, infinite beyond its range. */
  double deviation;       /* standard deviation, if what is left scatters at random */
  double margin;          /* change that moves the curve by FIT_MARGIN, the others following to hold it */
  double margin_alone;    /* the same with the others held */
  int partner;            /* which other of the fit compensates it best, or -1 */
  double correlation;     /* with that one */
  double lowest, highest; /* among the starts that ended as near to the points */
} FittedParameter;

/** Mean distance in parts of the points' range by which a margin moves the curve. */
static const double FIT_MARGIN = 0.001;

typedef struct ParameterFit {
  FittedParameter *parameters;
  int count, runs;      /* of parameters, of the test */
  int starts, agreeing; /* descents, and those among them that ended as near to the points as the best */
  double next;          /* misfit of the best of the others; infinite: there is none */
  double before, after,
      most; /* misfit: mean distance of the points from the curve before and after, and the largest after
                                 (element_curve_compare) */
} ParameterFit;

/** Chooses the parameters under `fit` such that the points lie nearest to the curve of the test: tries places all over the ranges, goes down from
 *  the best of them that lie apart and from the deck's values by least squares, and keeps the best end. Leaves the deck's material with it.
 *  The same points give the same fit.
 *  @param[in] x, y  [count] measured points */
int parameter_fit_run(ElementDeck *deck, const double *x, const double *y, int count, ParameterFit *fit, Error *error);
void parameter_fit_destroy(ParameterFit *fit);

#endif
