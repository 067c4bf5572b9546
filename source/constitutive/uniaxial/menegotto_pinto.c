/* Steel along curves that bend from one asymptote into the other (Menegotto and Pinto 1973, Filippou, Popov and Bertero 1983;
 * docs/theory.md 8.8): with x = (e - e_r) / (e_0 - e_r), (s - s_r) / (s_0 - s_r) = b x + (1 - b) x / (1 + |x|^R)^(1/R). */
#include "constitutive/uniaxial/steel.h"

typedef struct Pinto {
  Steel steel;
  double roundness, fall, fall_range, initial;
} Pinto;

enum { ROUNDNESS = STEEL_PARAMETERS, FALL, FALL_RANGE, INITIAL };
/* History: last strain and stress, extremes, where the curve comes from and where its asymptotes cross, the last extreme on the side now
 * loaded, direction (0: not yet loaded). */
enum { LAST, LAST_STRESS, LEAST, MOST, FROM, FROM_STRESS, CROSS, CROSS_STRESS, EXTREME, DIRECTION, HISTORY };

static const breccia_parameter parameters[] = {
    STEEL_PARAMETER_ROWS,
    {"roundness", "1", "15", "(0, inf)", "R0, large for a sharp bend"},
    {"roundness fall", "1", "0.925", "[0, 1)", "cR1, share of R0 that large plastic strains take"},
    {"roundness range", "1", "0.15", "(0, inf)", "cR2, how soon they do"},
    {"initial stress", "stress", "0", NULL, "at no strain"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Pinto *c = constants;
  steel_prepare(&c->steel, v);
  c->roundness = v[ROUNDNESS];
  c->fall = v[FALL];
  c->fall_range = v[FALL_RANGE];
  c->initial = v[INITIAL];
  if (fabs(c->initial) <= (1 + 1e-9) * c->steel.yield) return 0;
  snprintf(reason, size,
           "'initial stress' is beyond the yield stress, and the first strain would lead back to the curve below it; "
           "take one within it");
  return 1;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Pinto *)constants)->steel.young, bulk, shear);
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == LEAST ? "least strain" : k == MOST ? "largest strain" : "");
}

static void begin(const void *constants, double *history)
{
  const Pinto *c = constants;
  memset(history, 0, sizeof(double) * HISTORY);
  history[LAST_STRESS] = c->initial;
  history[MOST] = c->steel.yield / c->steel.young;
  history[LEAST] = -history[MOST];
}

/** Where the line of slope E through the reversal meets the shifted yield line. */
static void cross(const Steel *s, double shift, int sign, double *h)
{
  const double hard = s->ratio * s->young, yield = sign * s->yield * shift, strain = yield / s->young;
  h[CROSS] = (yield - hard * strain - h[FROM_STRESS] + s->young * h[FROM]) / (s->young - hard);
  h[CROSS_STRESS] = yield + hard * (h[CROSS] - strain);
}

static void update_point(const void *constants, UniaxialPoint *p)
{
  const Pinto *c = constants;
  const Steel *s = &c->steel;
  const double first = s->yield / s->young, strain = p->strain + c->initial / s->young,
               last = p->committed[LAST] + c->initial / s->young, step = strain - last;
  double *h = p->trial;
  if (h[DIRECTION] == 0) {
    if (step == 0) {
      p->stress = h[LAST_STRESS];
      p->tangent = s->young;
      return;
    }
    h[DIRECTION] = step > 0 ? 1 : -1;
    h[CROSS] = h[EXTREME] = h[DIRECTION] * first;
    h[CROSS_STRESS] = h[DIRECTION] * s->yield;
  } else if (h[DIRECTION] * step < 0) {
    const bool tension = step > 0;
    h[DIRECTION] = tension ? 1 : -1;
    h[FROM] = last;
    h[FROM_STRESS] = h[LAST_STRESS];
    if (tension)
      h[LEAST] = fmin(h[LEAST], last);
    else
      h[MOST] = fmax(h[MOST], last);
    cross(s, steel_shift(s, tension, h[LEAST], h[MOST]), tension ? 1 : -1, h);
    h[EXTREME] = tension ? h[MOST] : h[LEAST];
  }
  const double past = fabs(h[EXTREME] - h[CROSS]) / first,
               R = c->roundness * (1 - c->fall * past / (c->fall_range + past)), wide = h[CROSS] - h[FROM],
               high = h[CROSS_STRESS] - h[FROM_STRESS], x = (strain - h[FROM]) / wide, size = fabs(x);
  /* x / (1 + |x|^R)^(1/R) and its slope (1 + |x|^R)^(-1 - 1/R), without overflow for large x. */
  const double power = size > 1 ? pow(size, -R) : pow(size, R), root = pow(1 + power, -1 / R);
  const double bent = size > 1 ? (x > 0 ? root : -root) : x * root,
               slope = size > 1 ? root / (1 + power) * power / size : root / (1 + power);
  p->stress = h[FROM_STRESS] + high * (s->ratio * x + (1 - s->ratio) * bent);
  p->tangent = high / wide * (s->ratio + (1 - s->ratio) * slope);
}

static int update(const void *constants, const breccia_batch *batch)
{
  const Pinto *c = constants;
  return uniaxial_update(c, batch, HISTORY, c->steel.young, -c->initial / c->steel.young, true, update_point);
}

const breccia_law law_menegotto_pinto = {
    .size = sizeof(breccia_law),
    .name = "menegotto-pinto",
    .about = "steel with rounded cycles, kinematic and optional isotropic hardening (Steel02)",
    .source = "Menegotto and Pinto 1973; Filippou, Popov and Bertero 1983",
    .maturity = "verified against OpenSees Steel02",
    .equations =
        "σ* = b ε* + (1 − b) ε*/(1 + |ε*|ᴿ)^(1/R) between the last reversal and the crossing of the asymptotes\n"
        "R = R₀ (1 − c₁ ξ/(c₂ + ξ)), ξ the last plastic excursion over f_y/E\n"
        "the published curves overshoot in small cycles within a large one, which give up to 2 % of what is put into "
        "them",
    .opensees = "uniaxialMaterial Steel02",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Pinto),
    .components = 1,
    .prepare = prepare,
    .moduli = moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};
