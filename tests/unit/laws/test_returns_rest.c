/* What damage by stretch and nested yield surfaces have to obey at the end of each step (law_steps.h). */
#include "law_steps.h"

/* ---- Damage by stretch: all of it follows from the strain and the damage so far ---- */

typedef struct Stretches {
  double tension, tension_end, compression, compression_end, recovery;
  bool linear_force;
  double first, kink; /* share of the energy below the first of two lines, and where the second begins; 0: one line */
  Visits visits;
  int held_back; /* steps in which closed cracks carry less than the strain alone would let them */
} Stretches;

/** What is left of the largest force by two lines over the opening, which is the strain less what is elastic. */
static double left_by_two_lines(const Stretches *c, double most)
{
  const double straight = c->tension_end, kink = (1 - c->kink) * c->first * straight,
               end = (straight - kink) / c->kink; /* as much as a triangle that ends at `straight` */
  double low = 0, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double force = (low + high) / 2, opening = most - c->tension * force,
                 carried = opening < kink ? 1 - (1 - c->kink) * opening / kink
                                          : fmax(0, c->kink * (end - opening) / (end - kink));
    *(force < carried ? &low : &high) = force;
  }
  return low;
}

/** Principal stresses of a material without tensile strength: of the eight choices of open directions the one whose
 * stresses are nowhere positive and whose openings are nowhere negative. */
static void find_closed(const Material *m, const double strain[3], double stress[3])
{
  const double lambda = m->bulk - 2 * m->shear / 3,
               noise = 1e-13 * (fabs(strain[0]) + fabs(strain[1]) + fabs(strain[2]));
  for (int open = 0; open < 8; ++open) {
    int count = 0;
    double sum = 0; /* of elastic strains: those of open directions are alike, -lambda / (2 shear) of the sum each */
    for (int k = 0; k < 3; ++k) {
      count += open >> k & 1;
      if (!(open >> k & 1)) sum += strain[k];
    }
    const double volume = sum / (1 + count * lambda / (2 * m->shear));
    bool right = true;
    for (int k = 0; k < 3; ++k) {
      const bool opens = open >> k & 1;
      stress[k] = opens ? 0 : lambda * volume + 2 * m->shear * strain[k];
      right &= opens ? strain[k] + lambda / (2 * m->shear) * volume >= -noise : stress[k] <= m->bulk * noise;
    }
    if (right) return;
  }
  fail_msg("no choice of open directions");
}

static void stretches_obey(const Step *s, void *data)
{
  Stretches *c = data;
  double tensor[6], whole[6], strain[3], stress[3], axes[9], pull = 0, push = 0;
  for (int k = 0; k < 6; ++k) tensor[k] = s->strain[k] * (k < 3 ? 1 : 0.5);
  tensor_eigen(tensor, strain, axes);
  hooke(s->m, tensor, whole);
  tensor_eigen(whole, stress, axes);
  const double most = fmax(strain[0], fmax(strain[1], strain[2])), least = fmin(strain[0], fmin(strain[1], strain[2]));
  for (int k = 0; k < 3; ++k) {
    pull += past(stress[k]);
    push += past(-stress[k]);
  }
  /* Of the end of the softening: a force that falls linearly is that share of the one at the peak, and the rest of the stiffness follows from it. */
  const double left = c->first > 0 && most > c->tension
                          ? left_by_two_lines(c, most)
                          : fmax(0, fmin(1, (c->tension_end - most) / (c->tension_end - c->tension))),
               torn = most <= c->tension ? 0
                      : c->linear_force  ? 1 - left * c->tension / most
                                         : 1 - left,
               crushed = fmax(0, fmin(1, (-least - c->compression) / (c->compression_end - c->compression))),
               in_tension = fmax(s->before[0], torn),
               in_compression = fmax(s->before[1], in_tension > 0 && isfinite(c->compression) ? crushed : 0),
               closed = pull + push > 0 ? past(push - pull) / (push + pull) : 0;
  SMALL(s, "tensile damage", s->after[0] - in_tension, 1);
  SMALL(s, "compressive damage", s->after[1] - in_compression, 1);
  double expected[6] = {0}, without_tension[3], work = 0;
  find_closed(s->m, strain, without_tension);
  for (int k = 0; k < 3; ++k) work += without_tension[k] * strain[k];
  const double young = 9 * s->m->bulk * s->m->shear / (3 * s->m->bulk + s->m->shear),
               size = sqrt(fmax(0, work) / young), before = s->before[2],
               offset = fmax(fmin(before, size), (1 - closed) * size),
               recovered = size > 0 ? c->recovery * in_tension * (size - offset) / size : 0;
  SMALL(s, "closing offset", s->after[2] - (in_tension > 0 ? offset : 0), c->tension);
  c->held_back += in_tension > 0 && offset > (1 - closed) * size + 1e-3 * c->tension;
  tensor_eigen(tensor, strain, axes);
  for (int k = 0; k < 3; ++k) {
    const double whole_stress = 2 * s->m->shear * strain[k] + (s->m->bulk - 2 * s->m->shear / 3) * trace_of(tensor),
                 carried = (1 - in_compression) * ((1 - in_tension) * whole_stress + recovered * without_tension[k]);
    for (int n = 0; n < 6; ++n)
      expected[n] += carried * axes[3 * symmetric_row[n] + k] * axes[3 * symmetric_column[n] + k];
  }
  for (int n = 0; n < 6; ++n) SMALL(s, "stress", s->stress[n] - expected[n], s->m->bulk * c->tension);
  const int kind = in_tension == 0 ? 0 : in_tension < 1 ? 1 : 2;
  ++c->visits.count[kind];
  ++c->visits.count[closed > 0 ? 3 : 4];
  if (in_compression > 0) ++c->visits.count[in_compression < 1 ? 5 : 6];
}

static void damage_by_stretch_follows_its_lines(void **state)
{
  (void)state;
#define MODULI "Young modulus=30e6", "Poisson ratio=0.2", "tensile stretch=1e-4"
  Material m[] = {
      material_of("link-damage", MODULI, "compressive stretch=4e-4", NULL),
      material_of("link-damage", MODULI, "tensile ductility=7", "stiffness recovery=0.4", "compressive stretch=2e-4",
                  "compressive ductility=5", NULL),
      material_of("link-damage", MODULI, "fracture energy=0.1", "length=0.04", "stiffness recovery=0", NULL),
      material_of("link-damage", MODULI, "fracture energy=0.1", "initial fracture energy=0.04", "kink stress=0.25",
                  "length=0.2", "stiffness recovery=0", NULL)};
  /* 2 G_F / (E S_t l): a triangle of stress over strain. */
  const Stretches cases[] = {{1e-4, 2e-4, 4e-4, 8e-4, 1, false, 0, 0, {{0}}, 0},
                             {1e-4, 7e-4, 2e-4, 1e-3, 0.4, false, 0, 0, {{0}}, 0},
                             {1e-4, 2 * 0.1 / (30e6 * 1e-4 * 0.04), INFINITY, INFINITY, 0, true, 0, 0, {{0}}, 0},
                             {1e-4, 2 * 0.1 / (30e6 * 1e-4 * 0.2), INFINITY, INFINITY, 0, true, 0.4, 0.25, {{0}}, 0}};
  static const double sizes[] = {6e-5, 3e-4, 1.5e-3};
  for (int k = 0; k < 4; ++k) {
    Stretches c = cases[k];
    for (int n = 0; n < 3; ++n) walk(&m[k], sizes[n], false, stretches_obey, &c);
    all_visited("link-damage", &c.visits, k < 2 ? 7 : 5);
    assert_true(k >= 2 || c.held_back > 100);
    material_destroy(&m[k]);
  }
}

/* ---- Nested surfaces: the rules of docs/theory.md 8.2, one point and one part of a step after the other ---- */

enum { NESTED = 12 };
static const double shear = 60000, bulk = 100000, strength = 30, peak = 0.08;

typedef struct Nest {
  double radius[NESTED + 1], hardening[NESTED + 1]; /* H' */
  double centre[NESTED + 1][6], s[6],
      e[6]; /* as the rules have them; the strain of the last step is a tensor's deviator */
  int active;
  Visits visits;
} Nest;

static Nest nest_of(void)
{
  Nest c = {.active = 0};
  const double reference = peak * strength / (shear * peak - strength);
  for (int m = 1; m <= NESTED; ++m) c.radius[m] = sqrt(2.0 / 3) * 3 * (strength * m / NESTED) / sqrt(2);
  for (int m = 1; m < NESTED; ++m) {
    const double low = strength * m / NESTED, high = strength * (m + 1) / NESTED,
                 chord = 2 * (high - low) /
                         (high * reference / (shear * reference - high) - low * reference / (shear * reference - low));
    c.hardening[m] = 2 * shear * chord / (2 * shear - chord);
  }
  return c;
}

static double apart(const double a[6], const double b[6])
{
  double d[6];
  for (int k = 0; k < 6; ++k) d[k] = a[k] - b[k];
  return sqrt(dot(d, d));
}

/** Length x, at least 0, of |r x + d| = radius, the smaller or the larger one. */
static double root_of(const double r[6], const double d[6], double radius, bool larger)
{
  const double a = dot(r, r), b = dot(r, d), c = dot(d, d) - radius * radius, root = sqrt(past(b * b - a * c));
  return (larger ? root - b : -root - b) / a;
}

/** Moves the active surface as Mroz has it: as far as it must go to hold s. */
static void follow(Nest *c)
{
  const int m = c->active;
  double r[6], d[6], way[6], to[6];
  for (int k = 0; k < 6; ++k) {
    r[k] = c->s[k] - c->centre[m][k];
    d[k] = c->centre[m][k] - c->centre[m + 1][k];
  }
  if (sqrt(dot(r, r)) < c->radius[m] * (1 + 1e-12)) return;
  const double x = root_of(r, d, c->radius[m + 1], true), smaller = c->radius[m] / c->radius[m + 1];
  for (int k = 0; k < 6; ++k) {
    way[k] = x * r[k] - smaller * (x * r[k] + d[k]); /* between the places of one normal on both surfaces */
    to[k] = -r[k];
  }
  const double y = root_of(way, to, c->radius[m], false);
  for (int k = 0; k < 6; ++k) c->centre[m][k] += y * way[k];
}

/** A part of a step, from s by an elastic trial. */
static void flow_by(Nest *c, const double trial[6])
{
  for (int k = 0; k < 6; ++k) c->s[k] += trial[k];
  if (c->active == 0 && apart(c->s, c->centre[1]) <= c->radius[1]) return;
  if (c->active == 0) c->active = 1;
  for (double share = 1;; share = 1 - c->hardening[c->active] / c->hardening[c->active - 1]) {
    const int m = c->active;
    const double length = apart(c->s, c->centre[m]),
                 multiplier = share * (length - c->radius[m]) / (2 * shear + c->hardening[m]);
    for (int k = 0; k < 6; ++k) c->s[k] -= 2 * shear * multiplier * (c->s[k] - c->centre[m][k]) / length;
    if (m == NESTED) {
      const double far = sqrt(dot(c->s, c->s));
      for (int k = 0; k < 6; ++k) c->s[k] *= c->radius[NESTED] / far;
      return;
    }
    if (apart(c->s, c->centre[m + 1]) <= c->radius[m + 1]) break;
    ++c->active;
  }
  follow(c);
}

static void nest_obeys(const Step *s, void *data)
{
  Nest *c = data;
  double tensor[6], e[6], trial[6], ray[6], deviator[6];
  if (s->number % FRESH == 0) {
    const Visits visits = c->visits;
    *c = nest_of();
    c->visits = visits;
  }
  for (int k = 0; k < 6; ++k) tensor[k] = s->strain[k] * (k < 3 ? 1 : 0.5);
  deviator_of(tensor, e);
  for (int k = 0; k < 6; ++k) {
    trial[k] = 2 * shear * (e[k] - c->e[k]);
    c->e[k] = e[k];
    ray[k] = c->s[k] - c->centre[c->active][k];
  }
  const int before = c->active;
  const bool turns = before && dot(trial, ray) < 0;
  for (int m = 1; turns && m < before; ++m)
    for (int k = 0; k < 6; ++k) c->centre[m][k] = c->s[k] - c->radius[m] / c->radius[before] * ray[k];
  if (turns) c->active = 0;
  const double soft = c->active ? c->hardening[c->active] / (2 * shear + c->hardening[c->active]) : 1,
               size = sqrt(dot(trial, trial));
  const int parts = (int)fmin(floor(soft * size / (c->radius[NESTED] / NESTED)) + 1, NESTED);
  for (int k = 0; k < 6; ++k) trial[k] /= parts;
  for (int n = 0; n < parts; ++n) flow_by(c, trial);
  deviator_of(s->stress, deviator);
  const double scale = c->radius[NESTED];
  SMALL(s, "pressure", trace_of(s->stress) / 3 - bulk * trace_of(tensor), scale);
  for (int k = 0; k < 6; ++k) SMALL(s, "stress", deviator[k] - c->s[k], scale);
  /* What holds whatever the rules of a step: s is on the active surface, and no surface around it crosses the next. */
  double centre[NESTED + 1][6] = {{0}};
  for (int m = 1; m < NESTED; ++m) {
    const double *five = s->after + 16 + 5 * (m - 1),
                 six[6] = {five[0], five[1], -five[0] - five[1], five[2], five[3], five[4]};
    for (int k = 0; k < 6; ++k) {
      centre[m][k] = six[k];
      SMALL(s, "centre", six[k] - c->centre[m][k], scale);
    }
  }
  /* A strain that comes back to a reversal ends where many surfaces touch, and roundings say on which. */
  const int active = (int)s->after[12], inner = active < c->active ? active : c->active,
            outer = active < c->active ? c->active : active;
  for (int m = inner ? inner : 1; m <= outer; ++m)
    SMALL(s, "consistency", apart(deviator, centre[m]) - c->radius[m], scale);
  if (active == 0) AT_MOST(s, "yield", apart(deviator, centre[1]) - c->radius[1], scale);
  for (int m = active ? active : 1; m < NESTED; ++m)
    AT_MOST(s, "nesting", apart(centre[m], centre[m + 1]) - (c->radius[m + 1] - c->radius[m]), scale);
  ++c->visits.count[active == NESTED ? 2 : turns ? (active ? 0 : 1) : active > before ? 3 : 4];
  c->active = active;
  ++c->visits.count[parts == 1 ? 5 : parts < NESTED ? 6 : 7];
}

static void nested_surfaces_flow_turn_and_follow(void **state)
{
  (void)state;
  Material m = material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30",
                           "peak octahedral strain=0.08", "surfaces=12", NULL);
  Nest c = nest_of();
  static const double sizes[] = {3e-4, 1.5e-3, 8e-3, 6e-2};
  for (int n = 0; n < 4; ++n) walk(&m, sizes[n], false, nest_obeys, &c);
  all_visited("multi-yield-j2", &c.visits, 8);
  material_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damage_by_stretch_follows_its_lines),
      cmocka_unit_test(nested_surfaces_flow_turn_and_follow),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
