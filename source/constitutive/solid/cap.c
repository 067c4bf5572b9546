/* Cap model for concrete and soil (DiMaggio and Sandler 1971; return of Hofstetter, Simo and Taylor 1993; docs/theory.md 8.3).
 *
 * Inside, compression is positive: I = -tr stress. Failure envelope |s| = F(I) = alpha - lambda exp(-beta I) + theta I, elliptic cap
 * from I = k to X(k) = k + R F(k) with |s|^2 + ((I - k) / R)^2 = F(k)^2, tension cut-off I = T. All flow is associated, so that each
 * region returns along the trial deviator: the unknowns are I and |s|. Compaction W (1 - exp(-D X(k))) moves the cap. */
#include "constitutive/solid/cap.h"

enum {
  ALPHA = ELASTIC_PARAMETERS,
  LAMBDA,
  BETA,
  THETA,
  RATIO,
  POSITION,
  COMPACTION,
  RATE,
  CUT,
  STRICT,
};

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"envelope strength", "stress", NULL, "(0, inf)",
     "alpha of the failure envelope |s| = alpha - lambda exp(-beta I) + theta I"},
    {"envelope drop", "stress", "0", "[0, inf)", "lambda, by how much the envelope lies lower at I = 0"},
    {"envelope rate", "per stress", "0", "[0, inf)", "beta, how fast that fades with pressure"},
    {"envelope slope", "1", "0", "[0, inf)", "theta, at high pressure"},
    {"cap ratio", "1", NULL, "(0, inf)", "R, width of the elliptic cap over its height"},
    {"cap position", "stress", NULL, "(0, inf)",
     "X, I = -(sum of normal stresses) at which hydrostatic compaction begins"},
    {"largest compaction", "1", NULL, "(0, inf)", "W, plastic volume strain at infinite pressure"},
    {"compaction rate", "per stress", NULL, "(0, inf)", "D, of compaction with the cap's position"},
    {"tension cut-off", "stress", NULL, "(0, inf)", "largest sum of normal stresses in tension"},
    {"strict cap", "1", "0", "[0, 1]", "1: a dilating point never draws the cap back past itself"},
};

static inline double envelope(const Cap *c, double i, double *slope)
{
  const double fall = c->lambda > 0 ? c->lambda * exp(-c->beta * i) : 0;
  *slope = c->beta * fall + c->theta;
  return c->alpha - fall + c->theta * i;
}

/** k whose cap ends at X. X(k) grows and is concave, so that Newton's method from below never overshoots. */
static double cap_of_position(const Cap *c, double position, double k)
{
  for (int iteration = 0; iteration < 100; ++iteration) {
    double slope;
    const double step = (position - k - c->ratio * envelope(c, k, &slope)) / (1 + c->ratio * slope);
    k += step;
    if (fabs(step) <= 1e-15 * fabs(position)) break;
  }
  return k;
}

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Cap *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  c->alpha = v[ALPHA];
  c->lambda = v[LAMBDA];
  c->beta = v[BETA];
  c->theta = v[THETA];
  c->ratio = v[RATIO];
  c->compaction = v[COMPACTION];
  c->rate = v[RATE];
  c->cut = -v[CUT];
  c->strict = v[STRICT] > 0;
  c->at_cut = envelope(c, c->cut, &c->slope_at_cut);
  double slope;
  const double least = c->ratio * envelope(c, 0, &slope);
  if (!(c->at_cut > 0)) {
    snprintf(reason, size,
             "the failure envelope must be above 0 at the tension cut-off, it is %g there: lower 'tension cut-off' or "
             "'envelope drop'",
             c->at_cut);
    return 1;
  }
  if (v[POSITION] < least) {
    snprintf(reason, size,
             "'cap position' %g lies left of the failure envelope: the cap must end at 'cap ratio' times the envelope "
             "at I = 0, %g, or beyond",
             v[POSITION], least);
    return 1;
  }
  c->start = cap_of_position(c, v[POSITION], 0);
  return 0;
}

static int history_values(const void *constants)
{
  (void)constants;
  return CAP_HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == CAP_PARAMETER ? "cap parameter" : "");
}

static const char *history_dimension(const void *constants, int k)
{
  (void)constants;
  return k == CAP_PARAMETER ? "stress" : "";
}

static void begin(const void *constants, double *history)
{
  memset(history, 0, sizeof(double) * CAP_HISTORY);
  history[CAP_PARAMETER] = ((const Cap *)constants)->start;
}

/** Where the flow along the envelope ends: 9 K F'(I) (length - F(I)) / 2G + trial - I = 0, which falls from low to high.
 *  @param[out] returned  F there */
static double return_to_envelope(const Cap *c, double trial, double length, double low, double high, double *returned,
                                 ReturnSlopes *slopes)
{
  const double stiff = 9 * c->elastic.bulk / (2 * c->elastic.shear);
  double i = fmin(fmax(trial, low), high), slope = 0, fall = -1;
  for (int iteration = 0; iteration < 200; ++iteration) {
    *returned = envelope(c, i, &slope);
    const double bend = -c->beta * (slope - c->theta), residual = stiff * slope * (length - *returned) + trial - i;
    fall = stiff * (bend * (length - *returned) - slope * slope) - 1;
    if (residual > 0)
      low = i;
    else
      high = i;
    double next = i - residual / fall;
    if (!(next > low && next < high)) next = (low + high) / 2;
    const double least = 4e-16 * (fabs(i) + c->alpha);
    if (fabs(next - i) <= least || high - low <= least) break;
    i = next;
  }
  slopes->invariant_invariant = -1 / fall;
  slopes->invariant_length = -stiff * slope / fall;
  slopes->length_invariant = slope * slopes->invariant_invariant;
  slopes->length_length = slope * slopes->invariant_length;
  return i;
}

/** Flow on the cap: finds by how much k moves, d, and from it I and |s| (docs/theory.md 8.3, region 3). With g = dgamma / F(k):
 *  |s| = length / (1 + 2 G g), I = trial - 3 K H, g = R^2 H / (3 (I - k)). F and H are written by their changes, because both move little. */
static double return_to_cap(const Cap *c, double trial, double length, double k, double *invariant, double *returned,
                            ReturnSlopes *slopes)
{
  const double bulk3 = 3 * c->elastic.bulk, shear2 = 2 * c->elastic.shear, R = c->ratio, square3 = R * R / 3;
  const double past = trial - k;
  double slope;
  const double first = envelope(c, k, &slope), bent = slope - c->theta, before = exp(-c->rate * (k + R * first));
  double low = 0, high = past, d = 0, f = 0, H = 0, H1 = 0, m = 0, g = 0, a = 0, a1 = 0, b = 0, dilute = 1, narrow = 1,
         S = 0, residual_slope = 0;
  for (int iteration = 0;; ++iteration) {
    const double fade = c->beta > 0 ? expm1(-c->beta * d) : 0,
                 rise = (c->beta > 0 ? -bent / c->beta * fade : 0) + c->theta * d;
    const double f1 = bent * (1 + fade) + c->theta, pressed = expm1(-c->rate * (d + R * rise));
    f = first + rise;
    H = -c->compaction * before * pressed;
    H1 = c->compaction * c->rate * (1 + R * f1) * before * (1 + pressed);
    m = past - bulk3 * H - d;
    double next = 0, step = INFINITY;
    if (m > 0) {
      g = square3 * H / m;
      const double g1 = (square3 * H1 + g * (bulk3 * H1 + 1)) / m;
      dilute = 1 / (1 + shear2 * g);
      narrow = 1 / (R + 3 * bulk3 * g / R);
      a = length * dilute;
      a1 = -a * dilute * shear2 * g1;
      b = (past - d) * narrow;
      S = sqrt(a * a + b * b);
      residual_slope = (a * a1 - b * (1 + b * 3 * bulk3 * g1 / R) * narrow) / S - f1;
      step = (f - S) / residual_slope;
      if (fabs(S - f) <= 1e-13 * f || iteration > 200) break;
      if (S > f)
        low = d;
      else
        high = d;
      next = d + step;
    } else { /* beyond the top: the flow would be infinite */
      high = d;
    }
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (m > 0 && (fabs(next - d) <= 1e-15 * d || high - low <= 1e-15 * high)) break;
    if (iteration > 2000) return NAN;
    d = next;
  }
  /* Near the top of the ellipse after great compaction g depends on the last digits of d: what is left goes radially. */
  const double radial = fabs(S - f) > 1e-12 * f ? f / S : 1;
  *invariant = radial == 1 ? trial - bulk3 * H : k + d + R * b * radial;
  *returned = a * radial;
  const double g_trial = -g / m, a_trial = -a * dilute * shear2 * g_trial,
               b_trial = narrow * (1 - b * 3 * bulk3 * g_trial / R);
  const double d_trial = -(a * a_trial + b * b_trial) / S / residual_slope, d_length = -a * dilute / S / residual_slope;
  *slopes =
      (ReturnSlopes){1 - bulk3 * H1 * d_trial, -bulk3 * H1 * d_length, a_trial + a1 * d_trial, dilute + a1 * d_length};
  return k + d;
}

/** The cap after dilation by `grown` (trace of the plastic strain increment, compaction positive, so `grown` < 0). */
static double draw_cap_back(const Cap *c, double k, double grown, double invariant)
{
  double slope;
  const double rest = exp(-c->rate * (k + c->ratio * envelope(c, k, &slope))) - grown / c->compaction;
  const double position = -log(rest) / c->rate;
  if (position < c->ratio * envelope(c, 0, &slope)) return k; /* k would be negative */
  const double back = cap_of_position(c, position, k);
  return back < 0 || (c->strict && back < fmax(invariant, 0)) ? k : back;
}

CapReturn cap_return_off_cap(const Cap *c, double trial, double length, double k, double at)
{
  const double ratio = 2 * c->elastic.shear / (9 * c->elastic.bulk);
  CapReturn r = {.plastic = true, .invariant = trial, .length = length, .cap = k};
  if (trial > k) {
    const double along = (trial - k) / c->ratio;
    r.on_cap = r.plastic = length * length + along * along > at * at * (1 + 1e-12); /* roundings count as on the cap */
    return r;
  }
  if (trial >= c->cut && length <= at) {
    r.plastic = false;
    return r;
  }
  if (trial <= c->cut && length <= c->at_cut) {
    r.invariant = c->cut;
    r.slopes.length_length = 1;
  } else if (trial <= c->cut && length <= c->at_cut + ratio * (c->cut - trial) / c->slope_at_cut) {
    r.invariant = c->cut;
    r.length = c->at_cut;
  } else {
    double slope;
    const double at_cap = envelope(c, k, &slope);
    if (length >= at_cap + ratio * (k - trial) / slope) {
      r.invariant = k;
      r.length = at_cap;
      return r;
    }
    r.invariant = return_to_envelope(c, trial, length, fmax(trial, c->cut), k, &r.length, &r.slopes);
  }
  if (trial < r.invariant) r.cap = draw_cap_back(c, k, (trial - r.invariant) / (3 * c->elastic.bulk), r.invariant);
  return r;
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const Cap *c = constants;
  double s[6], length, slope;
  const double trial = -elastic_trial(&c->elastic, p->strain, p->committed + CAP_PLASTIC, s, &length),
               k = p->committed[CAP_PARAMETER];
  CapReturn r = cap_return_off_cap(c, trial, length, k, envelope(c, fmin(trial, k), &slope));
  if (p->elastic) r = (CapReturn){.invariant = trial, .length = length, .cap = k};
  if (r.on_cap) r.cap = return_to_cap(c, trial, length, k, &r.invariant, &r.length, &r.slopes);
  if (!isfinite(r.cap)) return false;
  const double shrink = length > 0 ? r.length / length : 1;
  double returned[6];
  for (int n = 0; n < 6; ++n) {
    returned[n] = s[n] * shrink;
    p->stress[n] = returned[n] - (n < 3 ? r.invariant / 3 : 0);
  }
  if (r.plastic)
    plastic_rest(&c->elastic, p->strain, -r.invariant, returned, p->trial + CAP_PLASTIC);
  else
    memcpy(p->trial, p->committed, sizeof(double) * CAP_PARAMETER);
  p->trial[CAP_PARAMETER] = r.cap;
  if (p->tangent && !r.plastic) elastic_tangent(&c->elastic, p->tangent);
  if (p->tangent && r.plastic) {
    r.slopes.invariant_length = -r.slopes.invariant_length; /* to tension positive */
    r.slopes.length_invariant = -r.slopes.length_invariant;
    return_tangent(&c->elastic, &r.slopes, r.length, length, s, p->tangent);
  }
  return true;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return batch->tangent ? solid_update(constants, batch, CAP_HISTORY, update_point) : cap_update_many(constants, batch);
}

const breccia_law law_cap = {
    .size = sizeof(breccia_law),
    .name = "cap",
    .about = "concrete and soil: failure envelope, tension cut-off and a cap that compaction moves",
    .source = "DiMaggio and Sandler 1971; Hofstetter, Simo and Taylor 1993",
    .maturity = "verified against OpenSees CapPlasticity",
    .equations = "compression positive here: I = −tr σ; envelope ‖s‖ = F(I) = α − λ exp(−β I) + θ I; cut-off I = T\n"
                 "cap ‖s‖² + ((I − k)/R)² = F(k)² for I ≥ k, ending at X(k) = k + R F(k)\n"
                 "compaction tr εᵖ = W (1 − exp(−D X)) moves the cap; flow is associated on all surfaces",
    .opensees = "nDMaterial CapPlasticity",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Cap),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .history_name = history_name,
    .history_dimension = history_dimension,
    .begin = begin,
    .update = update,
};
