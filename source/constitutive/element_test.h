/* Laboratory tests on one material point: which strains and stresses are driven, and the curve that comes out. */
#ifndef BRECCIA_CONSTITUTIVE_ELEMENT_TEST_H
#define BRECCIA_CONSTITUTIVE_ELEMENT_TEST_H

#include "constitutive/driver.h"

typedef struct StageSpec {
  SectionHead head;
  double strain[6], stress[6]; /* NaN: not given */
  bool consolidation;
  int64_t steps;
  double duration; /* NaN: at once */
} StageSpec;

typedef struct TestSpec {
  SectionHead head;
  int kind, zero;                           /* indices of test_kind_word and test_zero_word */
  double strain, back, confining, duration; /* duration: NaN: at once */
  int64_t cycles, steps;
} TestSpec;

extern const Section stage_section, test_section;

/** k-th kind of test, for the deck; NULL after the last. */
const char *test_kind_word(int k);
/** k-th place where strain may be zero; the first is the default; NULL after the last. */
const char *test_zero_word(int k);

/** A straight part of a path. Components that are neither given keep their strain. */
typedef struct Stage {
  bool by_stress[6], by_strain[6];
  bool relative; /* strains count from the stage's beginning */
  double target[6], duration;
  int steps;
} Stage;

typedef struct ElementTest {
  Stage *stages;
  int count;
  int consolidation; /* so many stages come before the state whose strain counts as zero, with which curves begin */
  int turns;         /* how often the driven strain turns back; -1: the test does not say */
  double x_weight[6], y_weight[6]; /* the curve: sums of strains against sums of stresses */
  const char *x_label, *y_label;
} ElementTest;

/** Makes a test from a kind with its numbers, or from stages (one of them is NULL).
 *  @param[in] uniaxial  of the law: such laws know the uniaxial test and stages along xx only */
int element_test_create(ElementTest *test, const DeckReader *reader, const TestSpec *spec, const SectionList *stages,
                        bool uniaxial);
void element_test_destroy(ElementTest *test);

/** What a point went through, the state of zero strain first: the consolidated one, or the unstrained one if nothing is consolidated. */
typedef struct ElementCurve {
  int count, components;
  double *strain, *stress, *tangent; /* [count][6], [count][6] total, [count][components^2] */
  double *x, *y;                     /* [count] the curve */
} ElementCurve;

/** Runs a test. What came before a failure is kept in the curve; of a failing consolidation, its states. */
int element_test_run(const ElementTest *test, const Material *material, ElementCurve *curve, Error *error);
void element_curve_destroy(ElementCurve *curve);

/** How far measured points lie from a curve: from its nearest piece, both axes in parts of the range of the points.
 *  @param[out] offset  [count][2] along both axes; may be NULL
 *  @param[out] most    the largest distance
 *  @return the root mean square of the distances */
double element_curve_compare(const ElementCurve *curve, const double *x, const double *y, int count, double *offset,
                             double *most);

#endif
