/* Mohr-Coulomb plasticity with a Rankine tension cut-off (de Souza Neto, Peric and Owen 2008, ch. 8; docs/theory.md 8.5), tension
 * positive, perfectly plastic: (s1 - s3) + (s1 + s3) sin(phi) <= 2 c cos(phi), s1 <= f_t; flow with the dilation angle.
 *
 * In principal stresses all surfaces are planes and the law does not harden, so that the return to any set of planes is one linear
 * system. The sets that a sorted stress can end on are few: they are tried in turn, and the first whose multipliers and
 * stress are admissible is it. */
#include "constitutive/solid/elastic_first.h"
#include "constitutive/solid/spectral.h"

#include "base/linear.h"

typedef struct MohrCoulomb {
  Elasticity elastic;
  double sine, dilation, limit; /* sin(phi), sin(psi), 2 c cos(phi) */
  double tensile;               /* infinite: no cut-off */
} MohrCoulomb;

enum { COHESION = ELASTIC_PARAMETERS, FRICTION, DILATION, TENSILE };
enum { PLASTIC = 0, HISTORY = 6 };

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"cohesion", "stress", NULL, "(0, inf)", "c"},
    {"friction angle", "angle", NULL, "[0, 80]", "phi"},
    {"dilation angle", "angle", "", "[0, 80]", "psi; the friction angle when absent"},
    {"tensile strength", "stress", "", "(0, inf)", "largest principal stress; the tip of the pyramid when absent"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  MohrCoulomb *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  const double degree = acos(-1) / 180, tip = v[FRICTION] > 0 ? v[COHESION] / tan(v[FRICTION] * degree) : INFINITY;
  c->sine = sin(v[FRICTION] * degree);
  c->dilation = isnan(v[DILATION]) ? c->sine : sin(v[DILATION] * degree);
  c->limit = 2 * v[COHESION] * cos(v[FRICTION] * degree);
  c->tensile = isnan(v[TENSILE]) ? tip : v[TENSILE];
  if (c->dilation > c->sine) {
    snprintf(reason, size, "'dilation angle' must not be larger than 'friction angle': the law would make energy");
    return 1;
  }
  if (c->tensile <= tip * (1 + 1e-12)) return 0;
  snprintf(reason, size, "'tensile strength' lies beyond the tip of the pyramid, c cot(phi) = %g", tip);
  return 1;
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

/* Planes: shear between principal directions 1 and 3, 1 and 2, 2 and 3; tension in 1, 2, 3. */
enum { SHEAR13, SHEAR12, SHEAR23, TENSION1, TENSION2, TENSION3, PLANES };

/** Normal of a plane, or with the dilation angle's sine its direction of flow; the cut-off's are one. */
static void normal_of(int plane, double sine, double normal[3])
{
  static const int larger[3] = {0, 0, 1}, smaller[3] = {2, 1, 2};
  normal[0] = normal[1] = normal[2] = 0;
  if (plane >= TENSION1) {
    normal[plane - TENSION1] = 1;
    return;
  }
  normal[larger[plane]] = 1 + sine;
  normal[smaller[plane]] = -(1 - sine);
}

static double excess_of(const MohrCoulomb *c, int plane, const double stress[3])
{
  double normal[3];
  normal_of(plane, c->sine, normal);
  return normal[0] * stress[0] + normal[1] * stress[1] + normal[2] * stress[2] -
         (plane < TENSION1 ? c->limit : c->tensile);
}

typedef struct PlaneSet {
  int count, plane[3];
} PlaneSet;

/* The tip of the pyramid is a corner of the cut-off, which never lies beyond it. */
static const PlaneSet sets[] = {
    {1, {SHEAR13}},
    {1, {TENSION1}},
    {2, {SHEAR13, TENSION1}},
    {2, {SHEAR13, SHEAR12}},
    {2, {SHEAR13, SHEAR23}},
    {2, {TENSION1, TENSION2}},
    {3, {SHEAR13, SHEAR12, TENSION1}},
    {3, {SHEAR13, TENSION1, TENSION2}},
    {3, {TENSION1, TENSION2, TENSION3}},
};

/** Returns a sorted trial stress to a set of planes.
 *  @param[out] slopes  [3][3] d stress / d principal strain, or NULL
 *  @return the least multiplier, scaled as a strain; NaN: the set has no return */
static double return_to(const MohrCoulomb *c, const PlaneSet *set, const double trial[3], double stress[3],
                        double slopes[9])
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  double system[9], right[3][4], stiff_flow[3][3], stiff_normal[3][3];
  for (int r = 0; r < set->count; ++r) {
    double normal[3], flow[3];
    normal_of(set->plane[r], c->sine, normal);
    normal_of(set->plane[r], c->dilation, flow);
    for (int k = 0; k < 3; ++k) {
      stiff_flow[r][k] = lambda * (flow[0] + flow[1] + flow[2]) + twice * flow[k];
      stiff_normal[r][k] = lambda * (normal[0] + normal[1] + normal[2]) + twice * normal[k];
      right[r][k] = stiff_normal[r][k];
    }
    right[r][3] = excess_of(c, set->plane[r], trial);
  }
  for (int r = 0; r < set->count; ++r) {
    double normal[3];
    normal_of(set->plane[r], c->sine, normal);
    for (int k = 0; k < set->count; ++k)
      system[set->count * r + k] =
          normal[0] * stiff_flow[k][0] + normal[1] * stiff_flow[k][1] + normal[2] * stiff_flow[k][2];
  }
  if (!linear_solve(set->count, system, 4, &right[0][0])) return NAN;
  double least = INFINITY;
  for (int k = 0; k < 3; ++k) stress[k] = trial[k];
  for (int r = 0; r < set->count; ++r) {
    least = fmin(least, right[r][3]);
    for (int k = 0; k < 3; ++k) stress[k] -= right[r][3] * stiff_flow[r][k];
  }
  for (int i = 0; slopes && i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      slopes[3 * i + k] = lambda + (i == k ? twice : 0);
      for (int r = 0; r < set->count; ++r) slopes[3 * i + k] -= stiff_flow[r][i] * right[r][k];
      if (set->count == 3) slopes[3 * i + k] = 0;
    }
  return least;
}

static bool admissible(const MohrCoulomb *c, const double stress[3], double tolerance)
{
  if (stress[0] < stress[1] - tolerance || stress[1] < stress[2] - tolerance) return false;
  return excess_of(c, SHEAR13, stress) <= tolerance && excess_of(c, TENSION1, stress) <= tolerance;
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const MohrCoulomb *c = constants;
  double elastic[6];
  for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[PLASTIC + k];
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  const double volume = lambda * trace(elastic);
  double trial[3], stress[3], slopes[9];
  const Spectrum strain = spectrum_of(elastic);
  for (int k = 0; k < 3; ++k) trial[k] = stress[k] = volume + twice * strain.value[k];
  if (excess_of(c, SHEAR13, trial) <= 0 && excess_of(c, TENSION1, trial) <= 0) {
    elastic_stress(&c->elastic, elastic, p->stress);
    memcpy(p->trial, p->committed, sizeof(double) * HISTORY);
    if (p->tangent) elastic_tangent(&c->elastic, p->tangent);
    return true;
  }
  const double scale = fabs(trial[0]) + fabs(trial[2]) + c->limit, tolerance = 1e-13 * scale;
  const PlaneSet *best = NULL;
  double nearest = INFINITY;
  for (size_t k = 0; k < sizeof sets / sizeof *sets; ++k) {
    double tried[3];
    const double least = return_to(c, &sets[k], trial, tried, NULL);
    if (isnan(least) || !admissible(c, tried, tolerance)) continue;
    if (least >= -1e-13 * scale / twice) {
      best = &sets[k];
      break;
    }
    /* Corners where more planes meet than a set names: the nearest admissible stress. */
    double distance = 0, sum = 0;
    for (int n = 0; n < 3; ++n) {
      distance += (trial[n] - tried[n]) * (trial[n] - tried[n]) / twice;
      sum += trial[n] - tried[n];
    }
    distance -= lambda / (twice * (3 * lambda + twice)) * sum * sum;
    if (sets[k].count == 3 && distance < nearest) {
      nearest = distance;
      best = &sets[k];
    }
  }
  if (!best) return false;
  return_to(c, best, trial, stress, slopes);
  spectral_tensor(&strain, stress, p->stress);
  plastic_strain(&c->elastic, p->strain, p->stress, p->trial + PLASTIC);
  if (p->tangent) spectral_tangent(&strain, stress, slopes, p->tangent);
  return true;
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, LaneMask *found)
{
  const MohrCoulomb *c = constants;
  const Lanes radius = trial_radius(t), mean = t->invariant / lanes_set(3), two = lanes_set(2);
  *found = (two * (radius * lanes_set(sqrt(3) + c->sine) + mean * lanes_set(c->sine)) <= lanes_set(c->limit)) &
           (mean + two * radius <= lanes_set(c->tensile));
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  const MohrCoulomb *c = constants;
  return solid_update_elastic_first(constants, batch, HISTORY, &c->elastic, true, inside, update_point);
}

const breccia_law law_mohr_coulomb = {
    .size = sizeof(breccia_law),
    .name = "mohr-coulomb",
    .about = "soil and rock: the hexagonal pyramid with a tension cut-off, associated or not, perfectly plastic",
    .source = "de Souza Neto, Peric and Owen 2008, ch. 8",
    .maturity = "verified against its closed forms",
    .equations = "σ₁ − σ₃ + (σ₁ + σ₃) sin φ ≤ 2 c cos φ, σ₁ ≤ f_t, tension positive, σ₁ ≥ σ₂ ≥ σ₃\n"
                 "flow with ψ instead of φ on the pyramid, normal to the cut-off; no hardening",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(MohrCoulomb),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .update = update,
};
