/* What the unit tests share: models from decks in the text, and comparisons that say what was found. */
#ifndef BRECCIA_TESTS_SUPPORT_H
#define BRECCIA_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "model/model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Whether this runs under the sanitizers, which make it five to ten times slower: what holds for any body, law or spacing is then tried on fewer. */
bool under_sanitizers(void);
/** Returns true if BRECCIA_WHOLE=1 asks for all bodies and laws (.ci/nightly) instead of the sample that runs with every change. */
bool whole_walks(void);

/** A model from a deck given as text with %-directives; fails the test with the reader's words if it is refused. */
breccia_model *model_of(const char *format, ...) __attribute__((format(printf, 1, 2)));
/** The same on so many threads. */
breccia_model *model_on(int threads, const char *format, ...) __attribute__((format(printf, 2, 3)));
/** The words with which a deck is refused, to be freed; fails the test if it is accepted. */
char *refusal_of(const char *deck);

/** Of a deck: a soft elastic material m in m, kN, s, whose waves run at 77 m/s. */
#define SOFT_SOLID "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"

/** Fails unless rows of numbers are the same to the bit. */
void assert_same_numbers(double *const *a, double *const *b, int rows, int64_t places, const char *name);
/** Fails unless |a - b| <= tolerance. */
#define assert_near(a, b, tolerance) assert_near_at((a), (b), (tolerance), #a, __FILE__, __LINE__)
void assert_near_at(double a, double b, double tolerance, const char *what, const char *file, int line);
/** Of errors that are collected: where one is no number it is that one. fmax() would pass over it, and the test with it. */
static inline double larger_of(double a, double b)
{
  return isnan(a) || b <= a ? a : b;
}

/** Sets displacements u = (F - I) X of all particles; F row by row. */
void deform_uniformly(breccia_model *model, const double f[9]);
/** Internal forces of the displacements held. */
void compute_forces(breccia_model *model);
/** Steps a model; fails the test with the error's words if a step fails. */
void step_surely(breccia_model *model, int64_t steps);
/** Fails unless a text holds all phrases between bars: "no equilibrium|take 'explicit'". */
void holds_words(const char *text, const char *words);
/** Steps a model to its end; fails the test unless a step fails with these words (holds_words). */
void step_must_fail(breccia_model *model, const char *words);
/** Masses, volumes, momentum and moment of momentum about the origin (with that of spins), external force, and the mean displacement, of all particles. */
typedef struct Sums {
  double mass, volume, momentum[3], turn[3], external[3], moved[3];
} Sums;
Sums sums_of(const breccia_model *model);
/** Fails unless the ledger of energies balances, as a share of the largest of them. */
void assert_balanced(const breccia_model *model, double tolerance);
/** What a checkpoint would hold; state_copy_destroy frees it. */
StateCopy state_of(breccia_model *model);
/** Fails unless a body that `make` makes for a number of threads has the same bits at step `last` with 1, 2 and 5
 * threads (3 too with BRECCIA_WHOLE), and when what it was at step `half` is given back to another one. Its run must
 * not end before. */
void assert_same_bits_by_threads_and_restart(breccia_model *(*make)(int threads), int64_t half, int64_t last);
/** Compares every family with all pairs of the body tried one by one. */
void assert_families_are_all_pairs(const breccia_model *model);
/** A material of a law with parameters given as "name=value" words, ending in NULL; units m, kN, s. */
Material material_of(const char *law, ...);
/** From here on numbers of stress that material_of and material_refusal are given count so many times; a scale of 1 ends it. */
void scale_stresses(double scale);
/** Tries to prepare a material of "name=value" words with commas between. @return its status; `reason` tells why it is refused */
int material_refusal(const char *law, const char *words, char *reason, size_t size);

#endif
