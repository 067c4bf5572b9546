/* Clay within a bounding surface: stress moves between the point of the last reversal and a sphere |s| = R without a purely elastic
 * range (Borja and Amies 1994; docs/theory.md 8.6). R = sqrt(8/3) s_u; k from |s + k (s - s0)| = R tells how far away
 * the surface is; hardening H = h k^m + H0; ds = psi de with 2G = psi (1 + 3G ((1 - b) / H_n + b / H_n+1)).
 *
 * With t = k / (1 + k) the two equations become one, |s_n + psi(t) de - t s0| = (1 - t) R, whose left side is below at t = 0 and
 * above at t = 1, so that it can be solved whatever the increment. */
#include "constitutive/solid/solid_law.h"

typedef struct Bounding {
  Elasticity elastic;
  double radius, modulus, exponent, least, share;
  bool compatible;
} Bounding;

enum { STRENGTH = ELASTIC_PARAMETERS, MODULUS, EXPONENT, LEAST, SHARE, COMPATIBLE };
/* History: deviator, strain deviator, stress at the last reversal, k (0: none yet, or infinite), psi. */
enum { DEVIATOR = 0, STRAIN = 6, REVERSAL = 12, DISTANCE = 18, STIFFNESS, HISTORY };

static const double far_away = 1e10; /* k when stress stands at the point of reversal */

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"undrained strength", "stress", NULL, "(0, inf)", "s_u, half the uniaxial strength"},
    {"hardening modulus", "stress", NULL, "(0, inf)", "h of H = h k^m + H0; often the shear modulus"},
    {"hardening exponent", "1", "1", "(0, inf)", "m"},
    {"least hardening", "stress", "0", "[0, inf)", "H0"},
    {"implicit share", "1", "0.5", "[0, 1]", "weight of the step's end in its mean hardening"},
    {"opensees steps", "1", "0", "[0, 1]",
     "1: stop Newton's method where the OpenSees class J2CyclicBoundingSurface does, to compare with it; its first "
     "step after a "
     "reversal is a tenth off"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Bounding *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  c->radius = sqrt(8.0 / 3) * v[STRENGTH];
  c->modulus = v[MODULUS];
  c->exponent = v[EXPONENT];
  c->least = v[LEAST];
  c->share = v[SHARE];
  c->compatible = v[COMPATIBLE] > 0;
  return 0;
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == DISTANCE ? "distance to the bounding surface" : "");
}

static void begin(const void *constants, double *history)
{
  memset(history, 0, sizeof(double) * HISTORY);
  history[DISTANCE] = far_away;
  history[STIFFNESS] = 2 * ((const Bounding *)constants)->elastic.shear;
}

static double hardening(const Bounding *c, double k, double *slope)
{
  const double h = c->modulus * pow(k, c->exponent);
  *slope = k > 0 ? c->exponent * h / k : 0;
  return h + c->least;
}

/** A step from s by de: what all residuals need. */
typedef struct Step {
  const double *s, *reversal;
  double de[6], before; /* before: (1 - b) / H_n, nothing after a reversal */
} Step;

/** psi at t = k / (1 + k), and its derivative to t. */
static double stiffness_at(const Bounding *c, const Step *step, double t, double *slope)
{
  const double twice = 2 * c->elastic.shear, triple = 3 * c->elastic.shear;
  if (t >= 1) {
    *slope = 0;
    return twice / (1 + triple * step->before);
  }
  const double k = t / (1 - t);
  double rise;
  const double h = hardening(c, k, &rise);
  if (!(h > 0)) {
    *slope = 0;
    return c->share > 0 ? 0 : twice / (1 + triple * step->before);
  }
  const double whole = 1 + triple * (step->before + c->share / h), psi = twice / whole;
  *slope = psi / whole * triple * c->share / (h * h) * rise / ((1 - t) * (1 - t));
  return psi;
}

/** |s + psi de - t s0| - (1 - t) R and its derivative. */
static double gap_at(const Bounding *c, const Step *step, double t, double *slope, double *psi)
{
  double psi_slope, a[6], rate[6];
  *psi = stiffness_at(c, step, t, &psi_slope);
  for (int k = 0; k < 6; ++k) {
    a[k] = step->s[k] + *psi * step->de[k] - t * step->reversal[k];
    rate[k] = psi_slope * step->de[k] - step->reversal[k];
  }
  const double length = norm(a);
  *slope = (length > 0 ? contract(a, rate) / length : 0) + c->radius;
  return length - (1 - t) * c->radius;
}

/** Solves for t in a bracket by Newton's method with bisection. The start suits a step much as the last. */
static double solve_gap(const Bounding *c, const Step *step, double start, double *psi)
{
  double low = 0, high = 1, t = fmin(fmax(start, 1e-6), 1 - 1e-9), slope;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double gap = gap_at(c, step, t, &slope, psi);
    if (fabs(gap) <= 1e-15 * c->radius) break;
    if (gap > 0)
      high = t;
    else
      low = t;
    double next = slope > 0 ? t - gap / slope : -1;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (next == t || high - low <= 1e-16) break;
    t = next;
  }
  gap_at(c, step, t, &slope, psi);
  return t;
}

/** The iteration of the OpenSees class, in psi and k. @return false where it does not end or ends beyond the surface */
static bool solve_as_opensees(const Bounding *c, const Step *step, bool fresh, double *k, double *psi)
{
  const double shear = c->elastic.shear, share = c->share;
  double first = 0, x = fresh ? 2 * shear : *psi, y = fresh ? far_away : *k;
  for (int iteration = 0; iteration <= 50; ++iteration) {
    double rise, a[6], to_psi = 0, to_k = 0;
    const double h = y < 0 ? 1e-10 : hardening(c, y, &rise), term = 3 * shear * (step->before + share / h);
    if (y < 0) rise = 0;
    for (int n = 0; n < 6; ++n) a[n] = step->s[n] + (1 + y) * x * step->de[n] + y * (step->s[n] - step->reversal[n]);
    const double length = norm(a), r1 = x * (1 + term) / (2 * shear) - 1, r2 = length / c->radius - 1;
    const double size = sqrt(r1 * r1 + r2 * r2);
    if (!iteration) first = size;
    if (size < 1e-10 * first + 1e-10) {
      *k = y;
      *psi = x;
      return y > 0 && x > 0;
    }
    for (int n = 0; n < 6; ++n) {
      const double weight = (n < 3 ? 1 : 2) * a[n] / (length * c->radius);
      to_psi += weight * (1 + y) * step->de[n];
      to_k += weight * (x * step->de[n] + step->s[n] - step->reversal[n]);
    }
    const double a11 = (1 + term) / (2 * shear), a12 = -1.5 * x * share * rise / (h * h);
    const double determinant = a11 * to_k - a12 * to_psi;
    x -= (to_k * r1 - a12 * r2) / determinant;
    y -= (a11 * r2 - to_psi * r1) / determinant;
  }
  return false;
}

static void tangent_of(const Bounding *c, const Step *step, double t, double psi, double tangent[36])
{
  /* ds = psi de + de_n dpsi, dpsi = psi' dt, dt = -(a : psi de) / (|a| gap'). */
  double slope, psi_slope, a[6];
  stiffness_at(c, step, t, &psi_slope);
  double same;
  gap_at(c, step, t, &slope, &same);
  for (int k = 0; k < 6; ++k) a[k] = step->s[k] + psi * step->de[k] - t * step->reversal[k];
  const double length = norm(a), factor = length > 0 ? -psi_slope * psi / (length * slope) : 0;
  static const double none[6];
  solid_tangent(c->elastic.bulk, 0, 0, 0, psi, none, tangent);
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) tangent[6 * i + k] += factor * step->de[i] * a[k];
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const Bounding *c = constants;
  const double *old = p->committed, pressure = c->elastic.bulk * trace(p->strain);
  double *new = p->trial, reversal[6], strain[6];
  Step step = {.s = old + DEVIATOR, .reversal = reversal};
  deviator(p->strain, strain);
  memcpy(new, old, sizeof(double) * HISTORY);
  memcpy(reversal, old + REVERSAL, sizeof reversal);
  double k = old[DISTANCE], psi = old[STIFFNESS], t = 1;
  for (int n = 0; n < 6; ++n) step.de[n] = strain[n] - old[STRAIN + n];
  /* What is no more than rounding of the strain must not count as a reversal; it is kept for the next step. */
  const double noise = c->compatible ? 1e-10 : 1e-14 * (norm(p->strain) + norm(old + STRAIN));
  const bool still = norm(step.de) <= noise;
  bool curved = false;
  if (p->elastic) {
    psi = 2 * c->elastic.shear;
  } else if (!still) {
    double toward[6], apart = 0;
    for (int n = 0; n < 6; ++n) toward[n] = k / (1 + k) * reversal[n] - step.s[n];
    if (contract(toward, step.de) > 0) {
      memcpy(reversal, step.s, sizeof reversal);
      k = far_away;
    }
    for (int n = 0; n < 6; ++n) apart += fabs(step.s[n] - reversal[n]);
    const bool fresh = apart == 0;
    double rise;
    step.before = fresh ? 0 : (1 - c->share) / hardening(c, k, &rise);
    if (!c->compatible || !solve_as_opensees(c, &step, fresh, &k, &psi)) {
      t = solve_gap(c, &step, k / (1 + k), &psi);
      k = t < 1 ? fmin(t / (1 - t), far_away) : far_away;
      curved = true;
    }
  }
  for (int n = 0; n < 6; ++n) {
    const double s = step.s[n] + psi * step.de[n];
    p->stress[n] = s + (n < 3 ? pressure : 0);
    if (still && !p->elastic && !c->compatible) continue;
    new[DEVIATOR + n] = s;
    new[STRAIN + n] = strain[n];
    new[REVERSAL + n] = p->elastic ? s : reversal[n];
  }
  new[DISTANCE] = p->elastic ? far_away : k;
  new[STIFFNESS] = psi;
  if (!p->tangent) return true;
  static const double none[6];
  if (curved)
    tangent_of(c, &step, t, psi, p->tangent);
  else
    solid_tangent(c->elastic.bulk, 0, 0, 0, psi, none, p->tangent);
  return true;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return solid_update(constants, batch, HISTORY, update_point);
}

const breccia_law law_bounding_surface_clay = {
    .size = sizeof(breccia_law),
    .name = "bounding-surface-clay",
    .about = "clay under cycles: stiffness falls from the last reversal towards a bounding surface, without an elastic "
             "range",
    .source = "Borja and Amies 1994",
    .maturity = "verified against OpenSees J2CyclicBoundingSurface",
    .equations = "bounding surface ‖s‖ = R = √(8/3) s_u; the last reversal at s₀; k from ‖s + k (s − s₀)‖ = R\n"
                 "ds = 2G / (1 + 3G/H) de, H = h kᵐ + H₀; a new reversal when (k/(1+k) s₀ − s) : de > 0; dp = K tr dε",
    .opensees = "nDMaterial J2CyclicBoundingSurface",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Bounding),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};
