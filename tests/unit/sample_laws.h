/* One of every law of a point in space, with numbers as they are used, and how far a stress is outside of what each may carry. */
#ifndef BRECCIA_TESTS_SAMPLE_LAWS_H
#define BRECCIA_TESTS_SAMPLE_LAWS_H

#include "point.h"

enum { SAMPLES = 17 };

typedef struct Sample {
  const char *name;
  Material (*make)(void);
  double strain;   /* at which the law is well beyond its elastic range */
  bool associated; /* closed cycles of strain take work */
  /** How far the stress is outside, over a strength; NULL: no such test. */
  double (*over)(const Point *p, const double stress[6]);
  bool jumps;     /* where its number of parts changes, or a step becomes a reversal */
  bool passes_on; /* answers a strain that is no number with such a stress, which the forces tell */
} Sample;

extern const Sample samples[SAMPLES];

/** The samples "cap" and "mohr-coulomb", and the failure envelope of the first at a pressure -I1. */
Material sample_cap(void);
Material sample_coulomb(void);
double sample_cap_envelope(double pressure);

/** "glass": elastic up to a strain xx of 1e-3, where it gives up. */
extern const breccia_law law_of_glass;
/** "giver": twice as stiff while it is unloaded as while it is loaded. */
extern const breccia_law law_of_giver;

/** Of pressure waves, K + 4 G / 3. */
double sample_stiffness(const Material *m);
/** The next of strains that walk at random and return: they keep within a few times `size`. */
void sample_wander(uint64_t *seed, double size, double step, double strain[6]);

/** First invariant, and length of the deviator. */
void stress_invariants(const double stress[6], double *first, double *length);

#endif
