/* Concrete along bonds that softens in tension and crushes. Tension follows exponential-softening (Hobbs 2021).
 * Compression follows the curve of fib Model Code 2010, eq. 5.1-26; beyond the peak stress falls exponentially and
 * spends a crushing energy:
 *   sigma_c / f = (k eta - eta^2) / (1 + (k - 2) eta),   eta = strain / peak strain, k = E peak strain / f,
 *   sigma_c / f = exp(-(strain - peak strain) f l / G_fc).
 * A point is elastic with damage in tension and a plastic strain in compression. Both only grow, so that no cycle of
 * strain generates energy, for any history of the pressure across the bond. Two quantities belong to the body, not to
 * one bond:
 * - Pressure across a bond elongates the bond without stress in the body. Only strain beyond this elongation damages
 *   the bond.
 * - The stress of slanted bonds still increases when bonds along the pressure have begun to crush. The law
 *   therefore chooses f and the peak strain of bonds such that a body has the given strength. The body has bonds in all
 *   directions and free sides.
 * Pressure in a second direction of the plane raises the strength as Kupfer and Gerstle (1973) measured:
 *   sigma_1 / f_c = (1 + 3.65 alpha) / (1 + alpha)^2,   alpha = sigma_2 / sigma_1. */
#include "constitutive/uniaxial/softening.h"
#include "constitutive/uniaxial/uniaxial_law.h"

enum { FIB_DIRECTIONS = 24, FIB_TURNS = 16, FIB_HALVINGS = 36 };

typedef struct FibConcrete {
  Softening tension;
  double decay, tail;             /* parameters of tension beyond the peak */
  double body;                    /* compressive strength of the body, as given */
  double strength, strain, width; /* of bonds in compression: f, peak strain, G_fc / (f l) */
  double most_lateral;            /* upper bound of the elongation by pressure across the bond */
} FibConcrete;

enum { FIB_STRENGTH = SOFTENING_PARAMETERS, FIB_STRAIN, FIB_ENERGY, FIB_DECAY, FIB_TAIL, FIB_DIMENSIONS };
enum { FIB_DAMAGE, FIB_CRUSHED, FIB_CONFINEMENT, FIB_HISTORY };

static const breccia_parameter fib_parameters[] = {
    SOFTENING_PARAMETER_ROWS,
    {"compressive strength", "stress", NULL, "(0, inf)", "f_c of a body that is pressed one way"},
    {"peak strain", "1", "0.0022", "(0, inf)", "compressive strain at the strength, 0.0019 to 0.003 by fib"},
    {"crushing energy", "fracture energy", "", "(0, inf)",
     "G_fc per area, spent beyond the peak in compression; 250 G_F when absent (Nakamura and Higai 2001)"},
    {"decay", "1", "25", "(0, inf)", "k, how steeply tension falls at first"},
    {"tail", "1", "0.25", "[0, inf)", "alpha, weight of the straight tail in tension"},
    {"dimensions", "1", "", "[1, 3]",
     "2 or 3: strengths in compression are those of a body of bonds in all directions of the plane or of space, 1: "
     "those of a single bond; those of the body when absent"},
};

/* Share of the strength at which strains are compared; step and end of curves in peak strains; smallest k. */
static const double fib_near = 0.95, fib_step = 0.05, fib_reach = 8, fib_least_ratio = 1.02;

/* Share of alpha by which a body of bonds in the plane exceeds its uniaxial strength with bonds that know no pressure. */
static const double fib_of_bonds = 0.2;

static double fib_envelope(const void *constants, double x, double *slope)
{
  const FibConcrete *c = constants;
  const double fall = exp(-c->decay * x), whole = -expm1(-c->decay);
  *slope = -(c->decay * fall / whole + c->tail) / (1 + c->tail);
  return (1 - (1 - fall) / whole + c->tail * (1 - x)) / (1 + c->tail);
}

/** Returns the envelope stress of bonds at a monotonic compressive strain and its slope; compression is positive. */
static double fib_compression(const FibConcrete *c, double strain, double *slope)
{
  if (strain >= c->strain) {
    const double stress = c->strength * exp(-(strain - c->strain) / c->width);
    *slope = -stress / c->width;
    return stress;
  }
  const double k = c->tension.young * c->strain / c->strength, eta = strain / c->strain, below = 1 + (k - 2) * eta,
               above = k * eta - eta * eta;
  *slope = c->strength / c->strain * ((k - 2 * eta) * below - above * (k - 2)) / (below * below);
  return c->strength * above / below;
}

/** Returns the factor on the compressive strength of bonds under a confining pressure. The biaxial strength is inverted
 *  for sigma_2 = pressure:
 *    x = pressure / f_c = alpha (1 + 3.65 alpha) / (1 + alpha)^2,   sigma_1 / f_c = x / alpha.
 *  A body of bonds carries 1 + 0.2 alpha of this without the factor. */
static double fib_gain(const FibConcrete *c, double pressure)
{
  const double x = pressure / c->body;
  if (!(x > 0)) return 1;
  const double a = 3.65 - x, half = (1 - 2 * x) / 2, alpha = (sqrt(half * half + a * x) - half) / a;
  return alpha < 1 ? fmax(1, x / alpha / (1 + fib_of_bonds * alpha)) : 1;
}

/** Returns the law under a confining pressure. The peak strain grows with the square of the strength, as by Eurocode 2,
 *  eq. 3.26. */
static FibConcrete fib_confined(const FibConcrete *c, double pressure)
{
  FibConcrete confined = *c;
  const double gain = fib_gain(c, pressure);
  confined.strength *= gain;
  confined.strain *= gain * gain;
  return confined;
}

/** Returns the stress of a bond under monotonic strain; compression is negative. */
static double fib_once(const FibConcrete *c, double strain)
{
  double slope;
  return strain >= 0 ? c->tension.young * strain : -fib_compression(c, -strain, &slope);
}

/** Directions of bonds: squares of direction cosines with the pressure, and weights for which a body has the modulus of
 *  its bonds. */
typedef struct FibBody {
  double along[FIB_DIRECTIONS], weight[FIB_DIRECTIONS];
} FibBody;

static FibBody fib_body(int dimensions)
{
  FibBody body;
  double sum = 0;
  for (int k = 0; k < FIB_DIRECTIONS; ++k) {
    const double part = (k + 0.5) / FIB_DIRECTIONS, angle = part * acos(0);
    body.along[k] = dimensions == 3 ? part * part : cos(angle) * cos(angle); /* evenly over a sphere, over a circle */
    body.weight[k] = 1.0 / FIB_DIRECTIONS;
  }
  /* A compressive strain e makes the sides grow by Poisson's ratio times e: 1/4 in space, 1/3 in the plane. */
  const double poisson = dimensions == 3 ? 0.25 : 1.0 / 3;
  for (int k = 0; k < FIB_DIRECTIONS; ++k)
    sum += body.weight[k] * body.along[k] * (body.along[k] - poisson * (1 - body.along[k]));
  for (int k = 0; k < FIB_DIRECTIONS; ++k) body.weight[k] /= sum;
  return body;
}

/** Returns the stress of a body in uniaxial compression with free sides at a strain; compression is positive. */
static double fib_pressed(const FibConcrete *c, const FibBody *body, double strain)
{
  double low = 0, high = strain, along = 0;
  for (int n = 0; n < FIB_HALVINGS; ++n) {
    const double side = (low + high) / 2;
    double across = 0;
    along = 0;
    for (int k = 0; k < FIB_DIRECTIONS; ++k) {
      const double part = body->along[k], stress = body->weight[k] * fib_once(c, side * (1 - part) - strain * part);
      across += stress * (1 - part);
      along -= stress * part;
    }
    if (across > 0)
      high = side;
    else
      low = side;
  }
  return along;
}

/** Returns the strength of a body, and finds the strain at which the body first carries 0.95 of the given strength. */
static double fib_peak(const FibConcrete *c, const FibBody *body, double *near)
{
  double most = 0, before = 0;
  *near = INFINITY;
  for (double part = fib_step; part < fib_reach; part += fib_step) {
    const double strain = part * c->strain, stress = fib_pressed(c, body, strain), wanted = fib_near * c->body;
    if (isinf(*near) && stress >= wanted) *near = strain - fib_step * c->strain * (stress - wanted) / (stress - before);
    if (stress < fib_near * most) break;
    most = fmax(most, stress);
    before = stress;
  }
  return most;
}

/** Finds f and the peak strain of bonds such that the body has the given strength, and carries 0.95 of that strength at
 *  the strain of the curve. `crushing` is G_fc / l. */
static void fib_calibrate(FibConcrete *c, double peak_strain, double crushing, int dimensions)
{
  const FibBody body = fib_body(dimensions);
  const double k = c->tension.young * peak_strain / c->body, half = (k - fib_near * (k - 2)) / 2,
               wanted = peak_strain * (half - sqrt(fmax(0, half * half - fib_near)));
  for (int turn = 0; turn < FIB_TURNS; ++turn) {
    double near;
    const double peak = fib_peak(c, &body, &near);
    c->strength *= c->body / peak;
    if (isfinite(near)) c->strain *= wanted / near;
    c->strain = fmax(c->strain, fib_least_ratio * c->strength / c->tension.young);
    c->width = crushing / c->strength;
  }
}

static int fib_prepare(const double *v, void *constants, char *reason, size_t size)
{
  FibConcrete *c = constants;
  const double k = v[FIB_DECAY], alpha = v[FIB_TAIL], area = (alpha / 2 + 1 + 1 / expm1(-k) + 1 / k) / (1 + alpha);
  const double energy = isnan(v[FIB_ENERGY]) ? 250 * v[SOFTENING_ENERGY] : v[FIB_ENERGY];
  c->decay = k;
  c->tail = alpha;
  if (softening_prepare(&c->tension, v, area, reason, size)) return 1;
  const double crushing = energy / v[SOFTENING_LENGTH], young = c->tension.young;
  c->body = c->strength = v[FIB_STRENGTH];
  c->strain = v[FIB_STRAIN];
  c->width = crushing / c->strength;
  c->most_lateral = c->strain / 2;
  if (v[FIB_DIMENSIONS] != floor(v[FIB_DIMENSIONS]) && !isnan(v[FIB_DIMENSIONS]))
    snprintf(reason, size, "'dimensions' is %g; give 1, 2 or 3", v[FIB_DIMENSIONS]);
  else if (young * c->strain < fib_least_ratio * c->strength)
    snprintf(reason, size, "'peak strain' must be at least %g times strength over Young's modulus, %g", fib_least_ratio,
             fib_least_ratio * c->strength / young);
  else if (c->strength < c->tension.strength)
    snprintf(reason, size, "'compressive strength' must not be smaller than 'tensile strength'");
  else if (c->width < c->strength / young)
    snprintf(reason, size,
             "a length of %g stores more at the peak than the crushing energy, so that the curve would snap back; it "
             "must be less than E G_fc / f_c^2 = %g: take a finer spacing, if the units of these numbers are right",
             v[SOFTENING_LENGTH], young * energy / (c->strength * c->strength));
  else {
    if (v[FIB_DIMENSIONS] > 1.5) fib_calibrate(c, v[FIB_STRAIN], crushing, v[FIB_DIMENSIONS] > 2.5 ? 3 : 2);
    return 0;
  }
  return 1;
}

static void fib_moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const FibConcrete *)constants)->tension.young, bulk, shear);
}

/** Returns the strain at which a bond has lost all stress: the end of its curve plus the largest lateral elongation. */
static double fib_failure_strain(const void *constants)
{
  const FibConcrete *c = constants;
  return c->tension.end + c->most_lateral;
}

static double fib_compressive_strength(const void *constants)
{
  return ((const FibConcrete *)constants)->body;
}

static int fib_history_values(const void *constants)
{
  (void)constants;
  return FIB_HISTORY;
}

static void fib_history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s",
           k == FIB_DAMAGE    ? "bond damage"
           : k == FIB_CRUSHED ? "crushing strain"
                              : "confining pressure");
}

static const char *fib_history_dimension(const void *constants, int k)
{
  (void)constants;
  return k == FIB_CONFINEMENT ? "stress" : "";
}

/** Updates a point whose elastic strain is compressive. Where the loading and unloading branches agree up to round-off
 *  the tangent is the loading tangent, as in softening_beyond. */
static void fib_press(const FibConcrete *c, UniaxialPoint *p, double elastic)
{
  double slope;
  const double young = c->tension.young, limit = -fib_compression(c, -p->strain, &slope), tie = SOFTENING_TIE;
  p->stress = young * elastic;
  p->tangent = young;
  if (!(p->stress < limit + tie * young * -p->strain)) return;
  p->tangent = slope;
  if (!(p->stress < limit)) return;
  p->stress = limit;
  p->trial[FIB_CRUSHED] = -p->strain + limit / young;
}

/** Updates a point whose elastic strain `elastic` is tensile and includes the elongation `lateral` by pressure across.
 *  The pressure changes with the strain of the family, a derivative that the tangent of one bond does not contain. */
static void fib_pull(const FibConcrete *c, UniaxialPoint *p, double elastic, double lateral)
{
  const Softening *t = &c->tension;
  const double own = elastic - lateral, damage = p->committed[FIB_DAMAGE], young = t->young;
  p->stress = young * elastic * (1 - damage);
  p->tangent = young * (1 - damage);
  if (!(own > t->peak)) return;
  double slope = 0;
  const double x = (own - t->peak) / (t->end - t->peak), carried = x < 1 ? t->strength * fib_envelope(c, x, &slope) : 0,
               grown = 1 - carried / (young * own);
  if (!(grown > damage - SOFTENING_TIE)) return;
  slope = x < 1 ? t->strength * slope / (t->end - t->peak) : 0;
  /* Under pressure across the bond damage grows by less than under the strain alone: the tangent is then the secant. */
  p->tangent = young * (1 - grown) + (lateral > 0 ? 0 : elastic * (slope - carried / own) / own);
  if (!(grown > damage)) return;
  p->trial[FIB_DAMAGE] = grown;
  p->stress = young * elastic * (1 - grown);
}

static int fib_update(const void *constants, const breccia_batch *batch)
{
  const FibConcrete *c = constants;
  for (int i = 0; i < batch->count; ++i) {
    UniaxialPoint p = {.strain = batch->strain[0][i],
                       .committed = batch->committed + FIB_HISTORY * i,
                       .trial = batch->trial + FIB_HISTORY * i};
    const double lateral = batch->lateral ? uniaxial_between(0, batch->lateral[i], c->most_lateral) : 0,
                 elastic = p.strain + p.committed[FIB_CRUSHED];
    p.trial[FIB_DAMAGE] = p.committed[FIB_DAMAGE];
    p.trial[FIB_CRUSHED] = p.committed[FIB_CRUSHED];
    p.trial[FIB_CONFINEMENT] = p.committed[FIB_CONFINEMENT];
    if (batch->elastic_stage) {
      p.stress = c->tension.young * elastic;
      p.tangent = c->tension.young;
    } else if (elastic < 0) {
      const FibConcrete confined = fib_confined(c, p.committed[FIB_CONFINEMENT]);
      fib_press(&confined, &p, elastic);
    } else {
      fib_pull(c, &p, elastic, lateral);
    }
    if (!isfinite(p.stress)) return i;
    batch->stress[0][i] = p.stress;
    if (batch->tangent) batch->tangent[i] = p.tangent;
  }
  return -1;
}

const breccia_law law_fib_concrete = {
    .size = sizeof(breccia_law),
    .name = "fib-concrete",
    .about = "concrete that cracks as exponential-softening and crushes: the compressive curve of fib Model Code 2010, "
             "then a fall that spends a crushing energy; strengths in compression are those of the body",
    .source = "fib Model Code 2010, eq. 5.1-26; Kupfer and Gerstle 1973; Nakamura and Higai 2001; Hobbs 2021; "
              "docs/theory.md 2",
    .maturity = "verified against its closed form, and bodies of it against section equilibrium",
    .equations =
        "compression positive: f (k η − η²)/(1 + (k − 2) η), η = ε/ε_p, k = E ε_p/f; beyond ε_p "
        "f e^(−(ε − ε_p) f l/G_fc); unloading along E\n"
        "tension: that of exponential-softening, of the strain beyond the plastic one and beyond the "
        "elongation by Poisson's effect of the pressure across the bond\n"
        "confined in the plane by q: f and ε_p times g and g², g = K/(1 + 0.2 α) ≥ 1, K = (1 + 3.65 α)/(1 + α)², "
        "α K = q/f_c",
    LAW_PARAMETERS(fib_parameters),
    .constants_size = sizeof(FibConcrete),
    .components = 1,
    .prepare = fib_prepare,
    .moduli = fib_moduli,
    .failure_strain = fib_failure_strain,
    .softening_energy = softening_start,
    .history_values = fib_history_values,
    .history_name = fib_history_name,
    .history_dimension = fib_history_dimension,
    .history_is_damage = softening_history_is_damage,
    .update = fib_update,
    .takes_lateral = 1,
    .compressive_strength = fib_compressive_strength,
    .confined_history = FIB_CONFINEMENT + 1,
};
