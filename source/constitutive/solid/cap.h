/* The cap model: what one point and many points at once share (cap.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_CAP_H
#define BRECCIA_CONSTITUTIVE_CAP_H

#include "constitutive/solid/solid_law.h"

typedef struct Cap {
  Elasticity elastic;
  double alpha, lambda, beta, theta;   /* of the envelope */
  double ratio, compaction, rate, cut; /* R, W, D, T */
  double start, at_cut, slope_at_cut;  /* first k; F(T), F'(T) */
  bool strict;
} Cap;

/* History: plastic strain, k. */
enum { CAP_PLASTIC = 0, CAP_PARAMETER = 6, CAP_HISTORY };

/** Where a trial state, elastic trial I and |s| with the cap at k, returns to. */
typedef struct CapReturn {
  bool plastic, on_cap; /* on_cap: left to the iteration on the cap */
  double invariant, length, cap;
  ReturnSlopes slopes;
} CapReturn;

/** All regions but the cap. @param[in] at  the envelope at the lesser of trial and k */
CapReturn cap_return_off_cap(const Cap *c, double trial, double length, double k, double at);

/** `update` of many points without tangents: the same returns, side by side, the same bits whatever their company. */
int cap_update_many(const Cap *c, const breccia_batch *batch);

#endif
