/* What concrete laws along one direction share: the compressive envelope of Kent, Scott and Park (1971, 1982), and where unloading from it
 * ends (Karsan and Jirsa 1969). Inside these functions compression is positive. */
#ifndef BRECCIA_CONSTITUTIVE_UNIAXIAL_CONCRETE_H
#define BRECCIA_CONSTITUTIVE_UNIAXIAL_CONCRETE_H

#include "constitutive/uniaxial/uniaxial_law.h"

enum { CONCRETE_STRENGTH, CONCRETE_STRAIN, CONCRETE_REST, CONCRETE_CRUSHED, CONCRETE_PARAMETERS };

#define CONCRETE_PARAMETER_ROWS                                                                                        \
  {"compressive strength", "stress", NULL, "(0, inf)", "f_c, at the top of the parabola"},                             \
      {"peak strain", "1", "0.002", "(0, inf)", "compressive strain at the strength"},                                 \
      {"residual strength", "stress", "0", "[0, inf)", "that crushed concrete keeps"},                                 \
  {                                                                                                                    \
    "crushing strain", "1", "0.006", "(0, inf)", "compressive strain from which only the residual strength is left"    \
  }

typedef struct ConcreteEnvelope {
  double strength, strain, rest, crushed;
} ConcreteEnvelope;

static inline int concrete_prepare(ConcreteEnvelope *e, const double *v, char *reason, size_t size)
{
  *e = (ConcreteEnvelope){v[CONCRETE_STRENGTH], v[CONCRETE_STRAIN], v[CONCRETE_REST], v[CONCRETE_CRUSHED]};
  if (e->rest > e->strength)
    snprintf(reason, size, "'residual strength' must not be larger than 'compressive strength'");
  else if (e->crushed <= e->strain)
    snprintf(reason, size, "'crushing strain' must be larger than 'peak strain'");
  else
    return 0;
  return 1;
}

static inline double concrete_young(const ConcreteEnvelope *e)
{
  return 2 * e->strength / e->strain;
}

/** A parabola to the strength, a line to the crushing strain, what is left beyond. */
static inline double concrete_envelope(const ConcreteEnvelope *e, double strain, double *slope)
{
  const double x = strain / e->strain;
  if (x < 1) {
    *slope = concrete_young(e) * (1 - x);
    return e->strength * x * (2 - x);
  }
  if (strain < e->crushed) {
    *slope = (e->rest - e->strength) / (e->crushed - e->strain);
    return e->strength + *slope * (strain - e->strain);
  }
  *slope = 0;
  return e->rest;
}

/** Strain without stress after unloading from a strain, for a strain at the peak. */
static inline double concrete_plastic_strain(double strain, double peak)
{
  const double x = strain / peak;
  return peak * (x < 2 ? 0.145 * x * x + 0.13 * x : 0.707 * (x - 2) + 0.834);
}

/** A memory of compression without tension: unloads from the envelope along a line and loads along it again.
 *  History: last strain, last stress, largest compressive strain, where its line ends, slope of that line; tension positive, as everywhere
 *  outside. */
enum { CONCRETE_LAST, CONCRETE_LAST_STRESS, CONCRETE_LARGEST, CONCRETE_END, CONCRETE_SLOPE, CONCRETE_HISTORY };

typedef double (*CompressionCurve)(const void *constants, double strain, double *slope);

__attribute__((always_inline)) static inline void concrete_without_tension(const void *constants, UniaxialPoint *p,
                                                                           CompressionCurve curve, double young,
                                                                           double peak, double most)
{
  const double strain = p->strain, slope = p->committed[CONCRETE_SLOPE],
               along = p->committed[CONCRETE_LAST_STRESS] + slope * (strain - p->committed[CONCRETE_LAST]);
  p->stress = p->tangent = 0;
  if (strain > 0) return;
  if (strain > p->committed[CONCRETE_LAST]) { /* towards tension */
    if (along > 0) return;
    p->stress = along;
    p->tangent = slope;
    return;
  }
  if (strain <= p->committed[CONCRETE_LARGEST]) {
    double tangent;
    p->stress = -curve(constants, -strain, &tangent);
    p->tangent = tangent;
    const double back = concrete_plastic_strain(fmin(-strain, most), peak), wide = -strain - back,
                 elastic = -p->stress / young;
    p->trial[CONCRETE_LARGEST] = strain;
    p->trial[CONCRETE_END] = wide >= elastic ? -back : strain + elastic;
    p->trial[CONCRETE_SLOPE] = wide >= elastic && wide > 0 ? -p->stress / wide : young;
  } else if (strain <= p->committed[CONCRETE_END]) {
    p->tangent = slope;
    p->stress = slope * (strain - p->committed[CONCRETE_END]);
  }
  if (along > p->stress + 1e-13 * fabs(p->stress)) { /* not yet there on the line along which it unloaded */
    p->stress = along;
    p->tangent = slope;
  }
}

static inline void concrete_begin(double young, double *history)
{
  memset(history, 0, sizeof(double) * CONCRETE_HISTORY);
  history[CONCRETE_SLOPE] = young;
}

#endif
