/* Cap model for concrete and soil (DiMaggio and Sandler 1971; return of Hofstetter, Simo and Taylor 1993; docs/theory.md 8.3).
 *
 * Inside, compression is positive: I = -tr stress. Failure envelope |s| = F(I) = alpha - lambda exp(-beta I) + theta I, elliptic cap
 * from I = k to X(k) = k + R F(k) with |s|^2 + ((I - k) / R)^2 = F(k)^2, tension cut-off I = T. All flow is associated, so that each
 * region returns along the trial deviator: the unknowns are I and |s|. Compaction W (1 - exp(-D X(k))) moves the cap. */
#include "constitutive/solid/solid_law.h"

typedef struct Cap {
  Elasticity elastic;
  double alpha, lambda, beta, theta;   /* of the envelope */
  double ratio, compaction, rate, cut; /* R, W, D, T */
  double start, at_cut, slope_at_cut;  /* first k; F(T), F'(T) */
  bool strict;
} Cap;

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
/* History: plastic strain, k. */
enum { PLASTIC = 0, CAP = 6, HISTORY };

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"envelope strength", "stress", NULL, "(0, inf)", "alpha of the failure envelope |s| = alpha - lambda exp(-beta I) + theta I"},
    {"envelope drop", "stress", "0", "[0, inf)", "lambda, by how much the envelope lies lower at I = 0"},
    {"envelope rate", "per stress", "0", "[0, inf)", "beta, how fast that fades with pressure"},
    {"envelope slope", "1", "0", "[0, inf)", "theta, at high pressure"},
    {"cap ratio", "1", NULL, "(0, inf)", "R, width of the elliptic cap over its height"},
    {"cap position", "stress", NULL, "(0, inf)", "X, I = -(sum of normal stresses) at which hydrostatic compaction begins"},
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
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == CAP ? "cap parameter" : "");
}

static void begin(const void *constants, double *history)
{
  memset(history, 0, sizeof(double) * HISTORY);
  history[CAP] = ((const Cap *)constants)->start;
}

/** Where the flow along the envelope ends: 9 K F'(I) (length - F(I)) / 2G + trial - I = 0, which falls from low to high. */
static double return_to_envelope(const Cap *c, double trial, double length, double low, double high,
                                 ReturnSlopes *slopes)
{
  const double stiff = 9 * c->elastic.bulk / (2 * c->elastic.shear);
  double i = fmin(fmax(trial, low), high), slope = 0, bend = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double f = envelope(c, i, &slope);
    bend = -c->beta * (slope - c->theta);
    const double residual = stiff * slope * (length - f) + trial - i,
                 fall = stiff * (bend * (length - f) - slope * slope) - 1;
    if (residual > 0)
      low = i;
    else
      high = i;
    double next = i - residual / fall;
    if (!(next > low && next < high)) next = (low + high) / 2;
    const double step = next - i;
    i = next;
    if (fabs(step) <= 4e-16 * (fabs(i) + c->alpha) || high - low <= 4e-16 * (fabs(i) + c->alpha)) break;
  }
  const double f = envelope(c, i, &slope);
  bend = -c->beta * (slope - c->theta);
  const double fall = stiff * (bend * (length - f) - slope * slope) - 1;
  slopes->invariant_invariant = -1 / fall;
  slopes->invariant_length = -stiff * slope / fall;
  slopes->length_invariant = slope * slopes->invariant_invariant;
  slopes->length_length = slope * slopes->invariant_length;
  return i;
}

/** Flow on the cap: finds the new k, and from it I and |s| (docs/theory.md 8.3, region 3). With g = dgamma / F(k):
 *  |s| = length / (1 + 2 G g), I = trial - 3 K H(k), g = R^2 H / (3 (I - k)). */
static double return_to_cap(const Cap *c, double trial, double length, double k, double *invariant, double *returned,
                            ReturnSlopes *slopes)
{
  const double bulk3 = 3 * c->elastic.bulk, shear2 = 2 * c->elastic.shear, R = c->ratio, square3 = R * R / 3;
  double slope;
  const double before = exp(-c->rate * (k + R * envelope(c, k, &slope)));
  double low = k, high = trial, residual_slope = 0, past = trial - k;
  if (past <= 1e-9 * (fabs(k) + c->at_cut)) { /* the ellipse's top: H and I - k vanish together */
    const double f = envelope(c, k, &slope), g = (length / f - 1) / shear2;
    const double grows = c->compaction * c->rate * (1 + R * slope) * before;
    const double follows = g / (square3 * grows + g * (1 + bulk3 * grows));
    *slopes = (ReturnSlopes){1 - bulk3 * grows * follows, 0, slope * follows, 0};
    *invariant = trial - bulk3 * grows * follows * past;
    *returned = envelope(c, k + follows * past, &slope);
    return k + follows * past;
  }
  double f, f1, gone, H, H1, m, g, a, b, dilute, narrow, g1, a1, S;
  for (int iteration = 0;; ++iteration) {
    f = envelope(c, k, &f1);
    gone = exp(-c->rate * (k + R * f));
    H = c->compaction * (before - gone);
    H1 = c->compaction * c->rate * (1 + R * f1) * gone;
    m = trial - bulk3 * H - k;
    if (!(m > 0)) { /* beyond the top: the flow would be infinite */
      high = k;
      k = (low + high) / 2;
      if (iteration > 300) return NAN;
      continue;
    }
    const double m1 = -bulk3 * H1 - 1;
    g = square3 * H / m;
    g1 = square3 * (H1 * m - H * m1) / (m * m);
    dilute = 1 / (1 + shear2 * g);
    narrow = 1 / (R + 3 * bulk3 * g / R);
    a = length * dilute;
    a1 = -a * dilute * shear2 * g1;
    b = (trial - k) * narrow;
    const double b1 = -(1 + b * 3 * bulk3 * g1 / R) * narrow;
    S = sqrt(a * a + b * b);
    const double residual = S - f;
    residual_slope = (a * a1 + b * b1) / S - f1;
    if (residual > 0)
      low = k;
    else
      high = k;
    const double step = residual / residual_slope;
    if (fabs(residual) <= 2e-16 * f || fabs(step) <= 1e-16 * k || iteration > 300) break;
    double next = k - step;
    if (!(next > low && next < high)) {
      if (next >= high && high - low <= 1e-15 * high) break;
      next = fabs(step) <= 1e-15 * k ? k : (low + high) / 2;
      if (next == k || next == low || next == high) break;
    }
    k = next;
  }
  /* Near the top of the ellipse after great compaction g hangs on the last digits of k: what is left goes radially. */
  const double radial = fabs(S - f) > 1e-12 * f ? f / S : 1;
  *invariant = radial == 1 ? trial - bulk3 * H : k + R * b * radial;
  *returned = a * radial;
  const double g_trial = -g / m, a_trial = -a * dilute * shear2 * g_trial,
               b_trial = narrow * (1 - b * 3 * bulk3 * g_trial / R);
  const double k_trial = -(a * a_trial + b * b_trial) / S / residual_slope, k_length = -a * dilute / S / residual_slope;
  *slopes = (ReturnSlopes){1 - bulk3 * H1 * k_trial, -bulk3 * H1 * k_length, a_trial + a1 * k_trial,
                           dilute + a1 * k_length};
  return k;
}

/** The cap after dilation by `grown` (trace of the plastic strain increment, compaction positive, so `grown` < 0). */
static double draw_cap_back(const Cap *c, double k, double grown, double invariant)
{
  double slope;
  const double rest = exp(-c->rate * (k + c->ratio * envelope(c, k, &slope))) - grown / c->compaction;
  const double position = -log(rest) / c->rate;
  if (position < c->ratio * envelope(c, 0, &slope)) return k; /* k would be negative */
  const double back = cap_of_position(c, position, 0);
  return back < 0 || (c->strict && back < fmax(invariant, 0)) ? k : back;
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const Cap *c = constants;
  const double bulk = c->elastic.bulk, ratio = 2 * c->elastic.shear / (9 * bulk);
  double s[6], length, slope;
  const double trial = -elastic_trial(&c->elastic, p->strain, p->committed + PLASTIC, s, &length);
  double k = p->committed[CAP], i = trial, returned = length;
  ReturnSlopes slopes = {0};
  bool plastic = !p->elastic;
  if (!plastic) {
  } else if (trial <= c->cut && length <= c->at_cut) {
    i = c->cut;
    slopes.length_length = 1;
  } else if (trial <= c->cut && length <= c->at_cut + ratio * (c->cut - trial) / c->slope_at_cut) {
    i = c->cut;
    returned = c->at_cut;
  } else {
    const double f = envelope(c, trial <= k ? trial : k, &slope);
    if (trial > k) {
      const double along = (trial - k) / c->ratio;
      if (length * length + along * along <= f * f * (1 + 1e-12)) /* roundings count as on the cap */
        plastic = false;
      else
        k = return_to_cap(c, trial, length, k, &i, &returned, &slopes);
    } else if (length <= f && trial >= c->cut) {
      plastic = false;
    } else {
      const double at_cap = envelope(c, k, &slope);
      if (length >= at_cap + ratio * (k - trial) / slope) {
        i = k;
        returned = at_cap;
      } else {
        i = return_to_envelope(c, trial, length, fmax(trial, c->cut), k, &slopes);
        returned = envelope(c, i, &slope);
      }
    }
  }
  if (!isfinite(k)) return false;
  if (plastic && i != k && trial < i) k = draw_cap_back(c, k, (trial - i) / (3 * bulk), i);
  const double shrink = length > 0 ? returned / length : 1;
  for (int n = 0; n < 6; ++n) s[n] *= shrink;
  for (int n = 0; n < 6; ++n) p->stress[n] = s[n] - (n < 3 ? i / 3 : 0);
  if (plastic)
    plastic_rest(&c->elastic, p->strain, -i, s, p->trial + PLASTIC);
  else
    memcpy(p->trial, p->committed, sizeof(double) * CAP);
  p->trial[CAP] = k;
  if (!p->tangent) return true;
  if (!plastic) {
    elastic_tangent(&c->elastic, p->tangent);
    return true;
  }
  slopes.invariant_length = -slopes.invariant_length; /* to tension positive */
  slopes.length_invariant = -slopes.length_invariant;
  for (int n = 0; n < 6; ++n) s[n] *= shrink > 0 ? 1 / shrink : 0;
  return_tangent(&c->elastic, &slopes, returned, length, s, p->tangent);
  return true;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return solid_update(constants, batch, HISTORY, update_point);
}

const breccia_law law_cap = {
    .name = "cap",
    .about = "concrete and soil: failure envelope, tension cut-off and a cap that compaction moves",
    .source = "DiMaggio and Sandler 1971; Hofstetter, Simo and Taylor 1993",
    .maturity = "verified against OpenSees CapPlasticity",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Cap),
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};
