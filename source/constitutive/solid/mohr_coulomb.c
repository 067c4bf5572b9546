/* Mohr-Coulomb plasticity with a Rankine tension cut-off (de Souza Neto, Peric and Owen 2008, ch. 8; docs/theory.md 8.5), tension
 * positive, perfectly plastic: (s1 - s3) + (s1 + s3) sin(phi) <= 2 c cos(phi), s1 <= f_t; flow with the dilation angle.
 *
 * In principal stresses all surfaces are planes and the law does not harden, so that the return to any set of planes is one linear
 * system. The sets that a sorted stress can end on are few: they are tried in turn, and the first whose multipliers and
 * stress are admissible is it. */
#include "constitutive/solid/mohr_coulomb.h"

#include "base/linear.h"

enum { COHESION = ELASTIC_PARAMETERS, FRICTION, DILATION, TENSILE };

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"cohesion", "stress", NULL, "(0, inf)", "c"},
    {"friction angle", "angle", NULL, "[0, 80]", "phi"},
    {"dilation angle", "angle", "0", "[0, 80]",
     "psi; that of most soil is far below the friction angle, with which the volume would grow without end as it "
     "flows, and confined soil bear too much"},
    {"tensile strength", "stress", "0", "[0, inf)",
     "largest principal stress, c cot(phi) at most, the tip of the pyramid; soil bears next to none, as a cohesion of "
     "shear is none of tension. At least a thousandth of the cohesion, by which equations keep a tangent"},
};

/* Tensile strength at least, in cohesions: bodies whose sides are free would stand at the corner of pyramid and cut-off
 * from the first increment on, where tangents say nothing. */
static const double least_tension = 1e-3;

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

/** What all trial stresses share that return to a set of planes. */
static CoulombReturn return_to(const MohrCoulomb *c, const PlaneSet *set)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  double system[9], normals[9], right[3][6] = {{0}}; /* normals through the elasticity; the inverse */
  CoulombReturn out = {.exists = false};
  for (int r = 0; r < set->count; ++r) {
    double normal[3], flow[3];
    normal_of(set->plane[r], c->sine, normal);
    normal_of(set->plane[r], c->dilation, flow);
    right[r][3 + r] = 1;
    out.corner[r] = set->plane[r] >= TENSION1 ? c->tensile : c->limit;
    for (int k = 0; k < 3; ++k) {
      normals[3 * r + k] = normal[k];
      out.stiff_flow[r][k] = lambda * (flow[0] + flow[1] + flow[2]) + twice * flow[k];
      right[r][k] = lambda * (normal[0] + normal[1] + normal[2]) + twice * normal[k];
    }
  }
  for (int r = 0; r < set->count; ++r) {
    double normal[3];
    normal_of(set->plane[r], c->sine, normal);
    for (int k = 0; k < set->count; ++k)
      system[set->count * r + k] =
          normal[0] * out.stiff_flow[k][0] + normal[1] * out.stiff_flow[k][1] + normal[2] * out.stiff_flow[k][2];
  }
  if (!linear_solve(set->count, system, 6, &right[0][0])) return out;
  if (set->count == 3 && !linear_solve(3, normals, 1, out.corner)) return out;
  out.exists = true;
  for (int r = 0; r < set->count; ++r)
    for (int k = 0; k < set->count; ++k) out.inverse[r][k] = twice * right[r][3 + k];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3 && set->count < 3; ++k) {
      out.slopes[3 * i + k] = lambda + (i == k ? twice : 0);
      for (int r = 0; r < set->count; ++r) out.slopes[3 * i + k] -= out.stiff_flow[r][i] * right[r][k];
    }
  for (int r = 0; r < set->count; ++r)
    for (int k = 0; k < 3; ++k) out.stiff_flow[r][k] /= twice;
  return out;
}

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  MohrCoulomb *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  const double degree = acos(-1) / 180, tip = v[FRICTION] > 0 ? v[COHESION] / tan(v[FRICTION] * degree) : INFINITY;
  c->sine = sin(v[FRICTION] * degree);
  c->dilation = sin(v[DILATION] * degree);
  c->limit = 2 * v[COHESION] * cos(v[FRICTION] * degree);
  c->tensile = fmax(v[TENSILE], least_tension * v[COHESION]);
  c->update = mohr_coulomb_update_chosen();
  for (int k = 0; k < COULOMB_SETS; ++k) c->returns[k] = return_to(c, &coulomb_sets[k]);
  if (c->dilation > c->sine) {
    snprintf(reason, size, "'dilation angle' must not be larger than 'friction angle': the law would make energy");
    return 1;
  }
  if (c->tensile <= tip * (1 + 1e-12)) return 0;
  snprintf(reason, size, "'tensile strength' lies beyond the tip of the pyramid, c cot(phi) = %g", tip);
  return 1;
}

/** The tip of the pyramid stays where it is, and the dilation angle until friction is less. */
static void reduce_strength(double *v, double factor)
{
  const double degree = acos(-1) / 180;
  v[COHESION] /= factor;
  v[FRICTION] = atan(tan(v[FRICTION] * degree) / factor) / degree;
  v[DILATION] = isnan(v[DILATION]) ? NAN : fmin(v[DILATION], v[FRICTION]);
  v[TENSILE] /= factor;
}

static int history_values(const void *constants)
{
  (void)constants;
  return COULOMB_HISTORY;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return ((const MohrCoulomb *)constants)->update(constants, batch);
}

const breccia_law law_mohr_coulomb = {
    .size = sizeof(breccia_law),
    .name = "mohr-coulomb",
    .about = "soil and rock: the hexagonal pyramid with a tension cut-off, associated or not, perfectly plastic",
    .source = "de Souza Neto, Peric and Owen 2008, ch. 8",
    .maturity = "verified against its closed forms",
    .equations =
        "σ₁ − σ₃ + (σ₁ + σ₃) sin φ ≤ 2 c cos φ, σ₁ ≤ f_t, tension positive, σ₁ ≥ σ₂ ≥ σ₃\n"
        "flow with ψ instead of φ on the pyramid, normal to the cut-off; no hardening\n"
        "ψ and f_t are 0 unless given: dilation by φ would not end and make confined soil too strong, and soil "
        "bears next to no tension",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(MohrCoulomb),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .update = update,
    .reduce_strength = reduce_strength,
};
