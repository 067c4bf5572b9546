/* Multi-yield-surface J2 plasticity for clay (Iwan 1967, Mroz 1967, Prevost 1977; docs/theory.md 8.2).
 *
 * Nested cylinders in deviatoric stress space stand for the hyperbolic backbone; the active one moves by Mroz' rule towards
 * the next and never crosses it. The scheme is the explicit one of the OpenSees class PressureIndependMultiYield, so that results can
 * be compared to the last digits; it depends (weakly) on the size of the strain increments.
 *
 * History of a point: a head of HEAD numbers, then the centres of surfaces 1 .. N-1, six numbers each (the outermost never moves).
 * A point loads for many steps on one surface, so only centres that an update moved are copied from the committed row to its
 * twin: copying all of them (1 kB a point) took 70 ns more, on top of 110 ns for a point that stays elastic. */
#include "constitutive/law.h"

#include "base/tensor.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MOST_SURFACES = 60 };

typedef struct MultiYield {
  double shear, bulk;
  int surfaces;
  double size[MOST_SURFACES + 1];    /* radius sqrt(3/2 s:s); surface 1 is the innermost */
  double plastic[MOST_SURFACES + 1]; /* plastic modulus H' */
  double residual_pressure, reference_pressure, exponent;
  int frictional;
} MultiYield;

/* The head of a history row. `low` and `high`: surfaces whose centres this row holds otherwise than the row it came from. */
enum { DEVIATOR = 0, PRESSURE = 6, STRAIN = 7, ACTIVE = 13, LOW, HIGH, BEGUN, MODULUS_SCALE, SIZE_SCALE, HEAD };

enum { P_SHEAR, P_BULK, P_OCTAHEDRAL, P_COHESION, P_PEAK, P_SURFACES, P_FRICTION, P_REFERENCE, P_EXPONENT };

static const breccia_parameter parameters[] = {
    {"shear modulus", "stress", NULL, "(0, inf)", "G at small strain"},
    {"bulk modulus", "stress", NULL, "(0, inf)", "K"},
    {"octahedral strength", "stress", "", "(0, inf)", "largest octahedral shear stress; or give the cohesion"},
    {"cohesion", "stress", "", "(0, inf)",
     "c as OpenSees reads it: octahedral strength = 2 sqrt(2) c / 3 without friction"},
    {"peak octahedral strain", "1", "0.1", "(0, inf)", "octahedral shear strain at which the strength is reached"},
    {"surfaces", "1", "20", "[1, 60]", "number of yield surfaces"},
    {"friction angle", "angle", "0", "[0, 60]", "strength grows with the pressure at the end of the elastic stage"},
    {"reference pressure", "stress", "100 kPa", "(0, inf)", "pressure at which the moduli hold (with friction)"},
    {"pressure exponent", "1", "0", "[0, 2]", "growth of the moduli with pressure (with friction)"},
};

static int prepare(const double *v, void *constants, char *reason, size_t reason_size)
{
  MultiYield *c = constants;
  memset(c, 0, sizeof *c);
  c->shear = v[P_SHEAR];
  c->bulk = v[P_BULK];
  c->surfaces = (int)v[P_SURFACES];
  c->frictional = v[P_FRICTION] > 0;
  c->reference_pressure = v[P_REFERENCE];
  c->exponent = v[P_EXPONENT];
  if (isnan(v[P_OCTAHEDRAL]) == isnan(v[P_COHESION])) {
    snprintf(reason, reason_size, "give either 'octahedral strength' or 'cohesion'");
    return 1;
  }
  if (v[P_SURFACES] != c->surfaces) {
    snprintf(reason, reason_size, "'surfaces' must be a whole number");
    return 1;
  }
  double strength = isnan(v[P_OCTAHEDRAL]) ? 2 * sqrt(2) / 3 * v[P_COHESION] : v[P_OCTAHEDRAL];
  double height = 1;
  if (c->frictional) {
    if (isnan(v[P_COHESION])) {
      snprintf(reason, reason_size, "with a friction angle the strength is given by 'cohesion'");
      return 1;
    }
    double sine = sin(v[P_FRICTION] * acos(-1) / 180), slope = 6 * sine / (3 - sine);
    c->residual_pressure = 3 * v[P_COHESION] / (sqrt(2) * slope);
    height = c->reference_pressure + c->residual_pressure;
    strength = sqrt(2) * height * slope / 3;
  }
  double peak = v[P_PEAK], shear = c->shear;
  if (shear * peak <= strength) {
    snprintf(
        reason, reason_size,
        "the strength, %g (octahedral), must lie below shear modulus times peak strain, %g: a hyperbola cannot pass "
        "through both",
        strength, shear * peak);
    return 1;
  }
  double reference_strain = peak * strength / (shear * peak - strength);
  for (int i = 1; i <= c->surfaces; ++i) {
    double tau = strength * i / c->surfaces, next = strength * (i + 1) / c->surfaces;
    c->size[i] = 3 * tau / sqrt(2);
    if (i == c->surfaces) break;
    double strain = tau * reference_strain / (shear * reference_strain - tau);
    double further = next * reference_strain / (shear * reference_strain - next);
    double chord = 2 * (next - tau) / (further - strain);
    double plastic = 2 * shear * chord / (2 * shear - chord);
    c->plastic[i] = plastic < 0 ? 0 : plastic > 1e30 ? 1e30 : plastic;
  }
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  const MultiYield *c = constants;
  *bulk = c->bulk;
  *shear = c->shear;
}

static int history_values(const void *constants)
{
  return HEAD + 6 * (((const MultiYield *)constants)->surfaces - 1);
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == ACTIVE ? "active surface" : "");
}

static void begin(const void *constants, double *history)
{
  memset(history, 0, sizeof(double) * (size_t)history_values(constants));
  history[LOW] = 1; /* an empty range */
  history[MODULUS_SCALE] = history[SIZE_SCALE] = 1;
}

/* ---- deviatoric tensors: xx yy zz xy yz zx, shear as tensor components ---- */

static inline double product(const double a[6], const double b[6])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

/** sqrt(3/2 d:d) of d = a - b, the measure in which sizes of surfaces are given. */
static inline double distance(const double a[6], const double b[6])
{
  double d[6];
  for (int k = 0; k < 6; ++k) d[k] = a[k] - b[k];
  return sqrt(1.5 * product(d, d));
}

/** Whether d = a - b is longer than a size in that measure. */
static inline bool beyond(const double a[6], const double b[6], double size)
{
  double d[6];
  for (int k = 0; k < 6; ++k) d[k] = a[k] - b[k];
  return 1.5 * product(d, d) > size * size;
}

/** What one point works on: constants scaled for it, and its surfaces. */
typedef struct Point {
  const MultiYield *law;
  double shear, modulus_scale, size_scale; /* scaled G; scales of plastic moduli and sizes */
  double *centre;                          /* of surface 1, in the trial row */
  int active, low, high;                   /* surfaces moved: low .. high */
} Point;

static const double origin[6];

static inline double size_of(const Point *p, int m)
{
  return p->size_scale * p->law->size[m];
}
static inline double plastic_of(const Point *p, int m)
{
  return p->modulus_scale * p->law->plastic[m];
}
static inline const double *centre_of(const Point *p, int m)
{
  return m == p->law->surfaces ? origin : p->centre + 6 * (m - 1);
}
static inline void moved(Point *p, int first, int last)
{
  if (first < p->low || p->low > p->high) p->low = first;
  if (last > p->high) p->high = last;
}

/** Translates the active surface towards the next one so that it passes through s (Mroz' rule). */
static void translate(Point *p, const double s[6])
{
  int m = p->active;
  if (m >= p->law->surfaces) return;
  double *a = p->centre + 6 * (m - 1);
  const double *next = centre_of(p, m + 1);
  double size = size_of(p, m), larger = size_of(p, m + 1), ratio = size / larger;
  double r[6], d[6], mu[6];
  for (int k = 0; k < 6; ++k) {
    r[k] = s[k] - a[k];
    d[k] = a[k] - next[k];
  }
  /* X >= 1: where the ray from the centre through s meets the next surface. */
  double A = product(r, r), B = 2 * product(r, d), C = product(d, d) - 2.0 / 3 * larger * larger;
  double x = (-B + sqrt(fmax(0, B * B - 4 * A * C))) / (2 * A);
  if (x < 1) x = 1;
  double third = 0;
  for (int k = 0; k < 6; ++k) mu[k] = (a[k] + x * r[k]) * (1 - ratio) - (a[k] - next[k] * ratio);
  for (int k = 0; k < 3; ++k) third += mu[k] / 3;
  for (int k = 0; k < 3; ++k) mu[k] -= third;
  /* Y: the smaller non-negative root of |s - a - Y mu|^2 = 2/3 size^2; roundings count as on the surface. */
  double norm = product(mu, mu), linear = -2 * product(r, mu), gap = A - 2.0 / 3 * size * size;
  double tiny = 1e-13 * size * size;
  if (norm <= 1e-30 * size * size || (fabs(linear) < tiny && fabs(gap) < tiny)) return;
  double root = sqrt(fmax(0, linear * linear - 4 * norm * gap));
  double y = (-linear - root) / (2 * norm), other = (-linear + root) / (2 * norm);
  if (y < 0) y = other;
  if (y < 0) return;
  for (int k = 0; k < 6; ++k) a[k] += y * mu[k];
  moved(p, m, m);
}

/** One sub-increment: from s by the elastic trial de2g = 2 G de. */
static void advance(Point *p, double s[6], const double de2g[6])
{
  int last = p->law->surfaces;
  double trial[6];
  for (int k = 0; k < 6; ++k) trial[k] = s[k] + de2g[k];
  if (p->active == 0) {
    if (!beyond(trial, centre_of(p, 1), size_of(p, 1))) {
      memcpy(s, trial, sizeof trial);
      return;
    }
    p->active = 1;
  }
  for (int pass = 0;; ++pass) {
    int m = p->active;
    const double *a = centre_of(p, m);
    double size = size_of(p, m), normal[6], radius = distance(trial, a), excess = 0;
    /* normal = r / |r|; the contact point lies where r leaves the surface. */
    double norm = radius / sqrt(1.5), contact = size / sqrt(1.5), inverse = norm > 0 ? 1 / norm : 0;
    for (int k = 0; k < 6; ++k) normal[k] = (trial[k] - a[k]) * inverse;
    excess = norm - contact;
    double loading = excess / (2 * p->shear + plastic_of(p, m));
    if (pass) loading *= (plastic_of(p, m - 1) - plastic_of(p, m)) / plastic_of(p, m - 1);
    for (int k = 0; k < 6; ++k) s[k] = trial[k] - 2 * p->shear * loading * normal[k];
    if (m == last) {
      double radial = size / distance(s, origin);
      for (int k = 0; k < 6; ++k) s[k] *= radial;
      return;
    }
    for (int guard = 0; guard < 100 && !beyond(s, a, size);
         ++guard) { /* roundings and coarse steps may leave s inside: push it back out */
      double d = distance(s, a);
      if (d >= size || d == 0) break;
      double factor = 1 + fmax((size - d) / d, 1e-13);
      for (int k = 0; k < 6; ++k) s[k] = a[k] + factor * (s[k] - a[k]);
    }
    if (!beyond(s, centre_of(p, m + 1), size_of(p, m + 1))) break;
    p->active = m + 1;
    memcpy(trial, s, sizeof trial);
  }
  translate(p, s);
}

/** First stress evaluation after the elastic stage: strength from the pressure, surfaces fitted to the stress. */
static void leave_elastic_stage(Point *p, double s[6], double pressure)
{
  const MultiYield *c = p->law;
  if (c->frictional) {
    double height = c->residual_pressure - fmin(pressure, 0);
    double relative = height / (c->reference_pressure + c->residual_pressure);
    p->modulus_scale = pow(relative, c->exponent);
    p->size_scale = relative;
    p->shear = c->shear * p->modulus_scale;
  }
  double q = distance(s, origin), outer = size_of(p, c->surfaces);
  if (q == 0) return;
  if (q > outer) {
    for (int k = 0; k < 6; ++k) s[k] *= outer / q;
    q = outer;
  }
  while (p->active < c->surfaces && q > size_of(p, p->active + 1)) ++p->active;
  for (int i = 1; i <= p->active && i < c->surfaces; ++i) {
    for (int k = 0; k < 6; ++k) p->centre[6 * (i - 1) + k] = s[k] * (1 - size_of(p, i) / q);
    moved(p, i, i);
  }
}

static void integrate(Point *p, double s[6], const double de[6])
{
  int last = p->law->surfaces, m = p->active;
  double twice = 2 * p->shear, de2g[6];
  for (int k = 0; k < 6; ++k) de2g[k] = twice * de[k];
  if (m > 0) {
    const double *a = centre_of(p, m);
    double r[6];
    for (int k = 0; k < 6; ++k) r[k] = s[k] - a[k];
    if (product(de2g, r) < 0) { /* reversal: all inner surfaces touch at s, and the response is elastic again */
      for (int i = 1; i < m; ++i)
        for (int k = 0; k < 6; ++k) p->centre[6 * (i - 1) + k] = s[k] - r[k] * (size_of(p, i) / size_of(p, m));
      if (m > 1) moved(p, 1, m - 1);
      p->active = m = 0;
    }
  }
  double stiffness = m ? plastic_of(p, m) / (twice + plastic_of(p, m)) : 1; /* of 2 G */
  double square = 1.5 * product(de2g, de2g), whole = size_of(p, last) / last;
  if (square == 0) return;
  int parts = 1;
  if (stiffness * stiffness * square >= whole * whole) {
    double count = floor(stiffness * sqrt(square) / whole + 1);
    parts = count < last ? (int)count : last;
    for (int k = 0; k < 6; ++k) de2g[k] /= parts;
  }
  for (int part = 0; part < parts; ++part) advance(p, s, de2g);
}

static void tangent_of(const Point *p, const double s[6], double *tangent)
{
  double bulk = p->law->bulk * p->modulus_scale, lambda = bulk - 2 * p->shear / 3, coefficient = 0, r[6] = {0};
  if (p->active) {
    int m = p->active;
    const double *a = centre_of(p, m);
    for (int k = 0; k < 6; ++k) r[k] = s[k] - a[k];
    coefficient = 6 * p->shear * p->shear / ((2 * p->shear + plastic_of(p, m)) * size_of(p, m) * size_of(p, m));
  }
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k)
      tangent[6 * i + k] =
          (i < 3 && k < 3 ? lambda : 0) + (i == k ? (i < 3 ? 2 : 1) * p->shear : 0) - coefficient * r[i] * r[k];
}

static int update(const void *constants, const breccia_batch *batch)
{
  const MultiYield *c = constants;
  int row = history_values(constants);
  for (int i = 0; i < batch->count; ++i) {
    const double *old = batch->committed + (size_t)row * (size_t)i;
    double *new = batch->trial + (size_t)row *(size_t)i;
    if (i + 4 < batch->count) /* rows lie a kilobyte apart, and a point reads few places of its own */
      for (int line = 0; line < 3; ++line) {
        __builtin_prefetch(old + 4 * row + 8 * line);
        __builtin_prefetch(new + 4 * row + 8 * line, 1);
      }
    if (i + 2 < batch->count) {
      const double *centre = old + 2 * row + HEAD + 6 * (int)fmax(old[2 * row + ACTIVE] - 1, 0);
      __builtin_prefetch(centre);
      __builtin_prefetch(centre + 8);
      __builtin_prefetch(new + (centre - old), 1);
      __builtin_prefetch(new + (centre - old) + 8, 1);
    }
    int low = (int)fmin(old[LOW], new[LOW]), high = (int)fmax(old[HIGH], new[HIGH]);
    if (low <= high)
      memcpy(new + HEAD + 6 * (low - 1), old + HEAD + 6 * (low - 1), sizeof(double) * 6 * (size_t)(high - low + 1));

    Point p = {c,
               c->shear * old[MODULUS_SCALE],
               old[MODULUS_SCALE],
               old[SIZE_SCALE],
               new + HEAD,
               (int)old[ACTIVE],
               MOST_SURFACES,
               0};
    double s[6], de[6], volumetric = 0, pressure = old[PRESSURE];
    for (int k = 0; k < 6; ++k) {
      s[k] = old[DEVIATOR + k];
      de[k] = batch->strain[k][i] - old[STRAIN + k];
      new[STRAIN + k] = batch->strain[k][i];
    }
    for (int k = 0; k < 3; ++k) volumetric += de[k];
    for (int k = 0; k < 3; ++k) de[k] -= volumetric / 3;
    for (int k = 3; k < 6; ++k) de[k] /= 2;
    bool begun = old[BEGUN] > 0;
    if (batch->elastic_stage) {
      for (int k = 0; k < 6; ++k) s[k] += 2 * p.shear * de[k];
    } else {
      if (!begun) leave_elastic_stage(&p, s, pressure);
      begun = true;
      integrate(&p, s, de);
    }
    pressure += c->bulk * p.modulus_scale * volumetric;
    for (int k = 0; k < 6; ++k) {
      new[DEVIATOR + k] = s[k];
      batch->stress[k][i] = s[k] + (k < 3 ? pressure : 0);
    }
    new[PRESSURE] = pressure;
    new[ACTIVE] = p.active;
    new[LOW] = p.low;
    new[HIGH] = p.high;
    new[BEGUN] = begun;
    new[MODULUS_SCALE] = p.modulus_scale;
    new[SIZE_SCALE] = p.size_scale;
    if (batch->tangent) {
      if (batch->elastic_stage) p.active = 0;
      tangent_of(&p, s, batch->tangent + 36 * i);
    }
  }
  return -1;
}

const breccia_law law_multi_yield_j2 = {
    .name = "multi-yield-j2",
    .about = "clay: nested yield surfaces on a hyperbolic backbone, kinematic hardening by Mroz' rule",
    .source = "Iwan 1967, Mroz 1967, Prevost 1977; scheme of OpenSees PressureIndependMultiYield",
    .maturity = "verified against OpenSees PressureIndependMultiYield",
    .equations =
        "backbone τ = G γ / (1 + γ/γᵣ) of octahedral stress and strain, through the strength at the peak strain\n"
        "N nested surfaces √(3/2) ‖s − αₘ‖ = Kₘ, Kₘ = 3 m τ_max / (√2 N), with plastic moduli from the backbone's "
        "chords; the active one moves towards the next (Mroz)\n"
        "pressure: dp = K tr dε, elastic",
    .opensees = "nDMaterial PressureIndependMultiYield",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(MultiYield),
    .prepare = prepare,
    .moduli = moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};
