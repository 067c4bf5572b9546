/* Walks of a material point, and what has to hold at the end of each step, written as equations of their own: how far they are off. Strains walk at
 * random in all six components, turn back and come again, so that no two of them are alike. */
#ifndef BRECCIA_TESTS_LAW_STEPS_H
#define BRECCIA_TESTS_LAW_STEPS_H

#include "sample_laws.h"

#include "base/random.h"
#include "base/tensor.h"

enum { STEPS = 1500, FRESH = 25 };

/** A step of a point: plastic strains are tensors, as histories keep them; strain has engineering shear. */
typedef struct Step {
  const Material *m;
  const double *before, *after; /* histories */
  double strain[6], stress[6];
  double increment[6]; /* of the plastic strain */
  int number;
} Step;

static inline void deviator_of(const double a[6], double d[6])
{
  const double mean = (a[0] + a[1] + a[2]) / 3;
  for (int k = 0; k < 6; ++k) d[k] = a[k] - (k < 3 ? mean : 0);
}
static inline double dot(const double a[6], const double b[6])
{
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += (k < 3 ? 1 : 2) * a[k] * b[k];
  return sum;
}
static inline double trace_of(const double a[6])
{
  return a[0] + a[1] + a[2];
}
static inline double past(double x)
{
  return x > 0 ? x : 0;
}
/** Hooke's law for a strain tensor. */
static inline void hooke(const Material *m, const double e[6], double s[6])
{
  for (int k = 0; k < 6; ++k) s[k] = 2 * m->shear * e[k] + (k < 3 ? (m->bulk - 2 * m->shear / 3) * trace_of(e) : 0);
}

#define SMALL(s, what, value, scale)                                                                                   \
  do {                                                                                                                 \
    const double off_ = (value) / (scale);                                                                             \
    if (!(fabs(off_) < 1e-9)) fail_msg("%s, step %d: %s is off by %.2e", (s)->m->law->name, (s)->number, what, off_);  \
  } while (0)
#define AT_MOST(s, what, value, scale)                                                                                 \
  do {                                                                                                                 \
    const double over_ = (value) / (scale);                                                                            \
    if (!(over_ < 1e-9)) fail_msg("%s, step %d: %s is beyond by %.2e", (s)->m->law->name, (s)->number, what, over_);   \
  } while (0)

/** Drives a point; every second step is asked for its tangent too, which other functions of a law answer. Now and then the strain turns back to where
 *  it was two steps ago, and the point starts again from nothing. */
static inline void walk(const Material *m, double size, bool plastic, void (*obeys)(const Step *s, void *data),
                        void *data)
{
  Point p = point_start(m);
  uint64_t seed = 4711;
  double strain[6] = {0}, earlier[2][6] = {{0}}, tangent[36];
  for (int n = 0; n < STEPS; ++n) {
    if (n % FRESH == 0) {
      point_stop(&p);
      p = point_start(m);
      memset(strain, 0, sizeof strain);
    }
    memcpy(earlier[n % 2], strain, sizeof strain);
    if (n % 7 == 5)
      memcpy(strain, earlier[(n + 1) % 2], sizeof strain);
    else
      sample_wander(&seed, size, size * pow(10, -1.5 * random_uniform(&seed)), strain);
    Step s = {.m = m, .before = p.committed, .number = n};
    memcpy(s.strain, strain, sizeof strain);
    point_try(&p, strain, s.stress, n % 2 ? tangent : NULL, 0);
    s.after = p.trial;
    for (int k = 0; plastic && k < 6; ++k) s.increment[k] = s.after[k] - s.before[k];
    if (plastic && strcmp(m->law->name, "damage-plasticity")) {
      double elastic[6], expected[6];
      for (int k = 0; k < 6; ++k) elastic[k] = strain[k] * (k < 3 ? 1 : 0.5) - s.after[k];
      hooke(m, elastic, expected);
      for (int k = 0; k < 6; ++k) SMALL(&s, "stress", s.stress[k] - expected[k], m->bulk * size);
    }
    obeys(&s, data);
    point_commit(&p);
  }
  point_stop(&p);
}

typedef struct Visits {
  int count[16];
} Visits;
static inline void all_visited(const char *what, const Visits *v, int kinds)
{
  for (int k = 0; k < kinds; ++k)
    if (v->count[k] < 5) fail_msg("%s: only %d steps of kind %d", what, v->count[k], k);
}

#endif
