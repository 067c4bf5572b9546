/* Influence functions omega(q), q = bond length / horizon: how much a bond counts (docs/theory.md 1). */
#ifndef BRECCIA_FAMILY_INFLUENCE_H
#define BRECCIA_FAMILY_INFLUENCE_H

typedef struct Influence {
  const char *name;
  double (*value)(double q, double length);
} Influence;

const Influence *influence_find(const char *name);
/** k-th name, for the deck. */
const char *influence_word(int k);

#endif
