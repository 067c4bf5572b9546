/* Influence functions omega(q), q = bond length / horizon: how much a bond counts (docs/theory.md 1). */
#ifndef BRECCIA_FAMILY_INFLUENCE_H
#define BRECCIA_FAMILY_INFLUENCE_H

typedef struct Influence {
  const char *name;
  double (*value)(double q, double length);
} Influence;

/** Indices of the influence functions, in the order of influence_word. */
enum {
  INFLUENCE_CONSTANT,
  INFLUENCE_CONICAL,
  INFLUENCE_INVERSE,
  INFLUENCE_INVERSE_SQUARE,
  INFLUENCE_GAUSSIAN,
  INFLUENCE_QUARTIC,
  INFLUENCE_CUBIC_SPLINE
};
/** Returns the influence function of an index. */
const Influence *influence_at(int k);
/** k-th name, for the deck. */
const char *influence_word(int k);

#endif
