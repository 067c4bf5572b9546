/* What laws of plasticity and damage have to obey at the end of each step (law_steps.h): Hooke's law of the elastic strain, the yield condition, the
 * flow rule with multipliers that push, and the laws of what they remember. */
#include "law_steps.h"

#include "base/linear.h"

/* ---- J2: Y = 200 + 90 (1 - exp(-300 x)) + 4000 x, a centre that travels with 2/3 6000 ---- */

static void j2_obeys(const Step *s, void *data)
{
  double deviator[6], distance[6], flow = sqrt(dot(s->increment, s->increment));
  deviator_of(s->stress, deviator);
  for (int k = 0; k < 6; ++k) distance[k] = deviator[k] - s->after[7 + k];
  const double length = sqrt(dot(distance, distance)), x = s->after[6],
               radius = sqrt(2.0 / 3) * (200 + 90 * (1 - exp(-300 * x)) + 4000 * x);
  AT_MOST(s, "yield", length - radius, 200);
  SMALL(s, "equivalent plastic strain", x - s->before[6] - sqrt(2.0 / 3) * flow, 1e-3);
  if (flow > 0) SMALL(s, "consistency", length - radius, 200);
  for (int k = 0; k < 6; ++k) {
    SMALL(s, "flow", s->increment[k] - flow * distance[k] / fmax(length, 1e-300), 1e-3);
    SMALL(s, "centre", s->after[7 + k] - s->before[7 + k] - 2.0 / 3 * 6000 * s->increment[k], 200);
  }
  ++((Visits *)data)->count[flow > 0];
}

static void j2_flows_along_its_normal_and_hardens(void **state)
{
  (void)state;
  Material m =
      material_of("j2", "Young modulus=90000", "Poisson ratio=0.17", "yield stress=200", "saturation stress=290",
                  "saturation rate=300", "hardening modulus=4000", "kinematic modulus=6000", NULL);
  Visits v = {{0}};
  walk(&m, 4e-3, true, j2_obeys, &v);
  all_visited("j2", &v, 2);
  material_destroy(&m);
}

/* ---- Drucker and Prager: |s| + A I1 = sqrt(2/3) Y(x), flow along |s| + A' I1, I1 <= T ---- */

typedef struct Cone {
  double slope, dilation, first, gain, rate, modulus, cut;
  Visits visits;
} Cone;

static void cone_obeys(const Step *s, void *data)
{
  Cone *c = data;
  double deviator[6], flow[6];
  deviator_of(s->stress, deviator);
  deviator_of(s->increment, flow);
  const double length = sqrt(dot(deviator, deviator)), first = trace_of(s->stress), turned = sqrt(dot(flow, flow)),
               x = s->after[6], volume = trace_of(s->increment),
               radius = sqrt(2.0 / 3) * (c->first + c->gain * (1 - exp(-c->rate * x)) + c->modulus * x),
               outside = length + c->slope * first - radius, scale = c->first;
  AT_MOST(s, "yield", outside, scale);
  AT_MOST(s, "cut-off", first - c->cut, scale);
  SMALL(s, "equivalent plastic strain", x - s->before[6] - sqrt(2.0 / 3) * turned, 1e-3);
  const bool shears = turned > 1e-12, cut = fabs(first - c->cut) < 1e-9 * scale;
  if (shears) SMALL(s, "consistency", outside, scale);
  if (shears && length > 1e-9 * scale) /* at the tip all directions are normal */
    for (int k = 0; k < 6; ++k) SMALL(s, "flow", flow[k] - turned * deviator[k] / length, 1e-3);
  const double beyond = volume - 3 * c->dilation * turned;
  if (cut)
    AT_MOST(s, "contraction on the cut-off", -beyond, 1e-3);
  else
    SMALL(s, "dilation", beyond, 1e-3);
  ++c->visits.count[cut ? (shears ? 3 : 2) : shears];
}

static void drucker_and_prager_flow_on_cone_cut_off_and_tip(void **state)
{
  (void)state;
  /* sin 27 deg, sin 8 deg; then a cone to its tip. */
  const double friction = sin(27 * acos(-1) / 180), dilation = sin(8 * acos(-1) / 180);
  Material m[] = {material_of("drucker-prager", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20",
                              "friction angle=27", "dilation angle=8", "tension cut-off=30", "hardening modulus=700",
                              "saturation gain=13", "saturation rate=400", NULL),
                  material_of("drucker-prager", "Young modulus=50e3", "Poisson ratio=0.12", "cone strength=24",
                              "cone slope=0.3", "dilation slope=0.1", NULL)};
  const Cone cones[] = {{.slope = sqrt(2.0 / 3) * 2 * friction / (3 - friction),
                         .dilation = sqrt(2.0 / 3) * 2 * dilation / (3 - dilation),
                         .first = 6 * 20 * cos(27 * acos(-1) / 180) / (3 - friction),
                         .gain = 13,
                         .rate = 400,
                         .modulus = 700,
                         .cut = 30},
                        {.slope = sqrt(2) * 0.3, .dilation = sqrt(2) * 0.1, .first = sqrt(3) * 24, .cut = 24 / 0.3}};
  for (int k = 0; k < 2; ++k) {
    Cone c = cones[k];
    walk(&m[k], 4e-3, true, cone_obeys, &c);
    all_visited(k ? "tip" : "cone", &c.visits, 2);
    assert_true(c.visits.count[3] > 50 && (k || c.visits.count[2] > 5));
    material_destroy(&m[k]);
  }
}

/* ---- Mohr and Coulomb ---- */

typedef struct Pyramid {
  double sine, dilation, limit, tensile;
  Visits visits;
} Pyramid;

/** The component of a tensor along two directions. */
static double along(const double a[6], const double *u, const double *v)
{
  return a[XX] * u[0] * v[0] + a[YY] * u[1] * v[1] + a[ZZ] * u[2] * v[2] + a[XY] * (u[0] * v[1] + u[1] * v[0]) +
         a[YZ] * (u[1] * v[2] + u[2] * v[1]) + a[ZX] * (u[2] * v[0] + u[0] * v[2]);
}

/** How far a vector is from all sums of up to three of the directions with weights of at least 0. */
static double outside_of_cone(const double target[3], double direction[][3], int count)
{
  double nearest = sqrt(target[0] * target[0] + target[1] * target[1] + target[2] * target[2]);
  for (int set = 1; set < 1 << count; ++set) {
    int of[8], n = 0;
    for (int k = 0; k < count; ++k)
      if (set >> k & 1) of[n++] = k;
    if (n > 3) continue;
    double system[9], right[3], rest = 0;
    for (int r = 0; r < n; ++r) {
      const double *a = direction[of[r]];
      right[r] = a[0] * target[0] + a[1] * target[1] + a[2] * target[2];
      for (int k = 0; k < n; ++k) {
        const double *b = direction[of[k]];
        system[n * r + k] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      }
    }
    if (!linear_solve(n, system, 1, right)) continue;
    bool pushes = true;
    for (int r = 0; r < n; ++r) pushes &= right[r] >= -1e-12;
    for (int k = 0; k < 3; ++k) {
      double left = target[k];
      for (int r = 0; r < n; ++r) left -= right[r] * direction[of[r]][k];
      rest += left * left;
    }
    if (pushes) nearest = fmin(nearest, sqrt(rest));
  }
  return nearest;
}

static void pyramid_obeys(const Step *s, void *data)
{
  Pyramid *c = data;
  /* The directions are those of the elastic trial, whose principal values are apart where those of the stress may be alike. */
  double trial[6], change[6], value[3], vector[9], axis[3][3], stress[3], flow[3];
  hooke(s->m, s->increment, change);
  for (int k = 0; k < 6; ++k) trial[k] = s->stress[k] + change[k];
  tensor_eigen(trial, value, vector);
  int order[3] = {0, 1, 2};
  for (int pass = 0; pass < 3; ++pass)
    for (int k = 0; k < 2; ++k)
      if (value[order[k]] < value[order[k + 1]]) {
        const int other = order[k];
        order[k] = order[k + 1];
        order[k + 1] = other;
      }
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < 3; ++r) axis[k][r] = vector[3 * r + order[k]];
  const double scale = c->limit;
  for (int k = 0; k < 3; ++k) {
    stress[k] = along(s->stress, axis[k], axis[k]);
    flow[k] = along(s->increment, axis[k], axis[k]);
    SMALL(s, "direction of stress", along(s->stress, axis[k], axis[(k + 1) % 3]), scale);
    SMALL(s, "direction of flow", along(s->increment, axis[k], axis[(k + 1) % 3]), 1e-3);
  }
  AT_MOST(s, "order", stress[1] - stress[0], scale);
  AT_MOST(s, "order", stress[2] - stress[1], scale);
  double direction[6][3];
  int active = 0, shears = 0, cuts = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a + 1; b < 3; ++b) {
      const double outside = stress[a] - stress[b] + (stress[a] + stress[b]) * c->sine - c->limit;
      AT_MOST(s, "yield", outside, scale);
      if (outside < -1e-9 * scale) continue;
      double *d = direction[active++];
      d[0] = d[1] = d[2] = 0;
      d[a] = 1 + c->dilation;
      d[b] = c->dilation - 1;
      ++shears;
    }
  for (int a = 0; a < 3; ++a) {
    AT_MOST(s, "cut-off", stress[a] - c->tensile, scale);
    if (stress[a] < c->tensile - 1e-9 * scale) continue;
    double *d = direction[active++];
    d[0] = d[1] = d[2] = 0;
    d[a] = 1;
    ++cuts;
  }
  SMALL(s, "flow", outside_of_cone(flow, direction, active), 1e-3);
  ++c->visits.count[shears + 3 * cuts];
}

static void mohr_and_coulomb_flow_on_planes_edges_and_corners(void **state)
{
  (void)state;
  const double degree = acos(-1) / 180;
  Material m = material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.23", "cohesion=20",
                           "friction angle=33", "dilation angle=11", "tensile strength=13", NULL),
           tip = material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.23", "cohesion=20",
                             "friction angle=33", "dilation angle=33", "tensile strength=30.797299276291657", NULL);
  Pyramid c = {sin(33 * degree), sin(11 * degree), 40 * cos(33 * degree), 13, {{0}}},
          whole = {sin(33 * degree), sin(33 * degree), 40 * cos(33 * degree), 20 / tan(33 * degree), {{0}}};
  walk(&m, 3e-3, true, pyramid_obeys, &c);
  walk(&tip, 3e-3, true, pyramid_obeys, &whole);
  /* Shear; an edge; cut-off; both; two of one and one of the other; three cut off. */
  static const int wanted[] = {0, 1, 2, 3, 4, 5, 6, 8, 9};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; ++k)
    if (c.visits.count[wanted[k]] < 2) fail_msg("only %d steps of kind %d", c.visits.count[wanted[k]], wanted[k]);
  material_destroy(&m);
  material_destroy(&tip);
}

/** Trials beside those that end where planes meet: a multiplier that is all but none says which planes count. */
static void trials_beside_corners_flow_on_the_planes_that_push(void **state)
{
  (void)state;
  const double degree = acos(-1) / 180, sine = sin(33 * degree), tensile = 13, limit = 40 * cos(33 * degree),
               least = ((1 + sine) * tensile - limit) / (1 - sine), young = 50e3, nu = 0.23;
  Material m = material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.23", "cohesion=20",
                           "friction angle=33", "dilation angle=11", "tensile strength=13", NULL);
  Pyramid c = {sine, sin(11 * degree), limit, tensile, {{0}}};
  const double corners[][3] = {{tensile, least, least}, {tensile, tensile, least}, {tensile, tensile, tensile}};
  uint64_t seed = 77;
  for (int n = 0; n < 600; ++n) {
    const double *corner = corners[n % 3], size = pow(10, -5 - 3 * random_uniform(&seed));
    Point p = point_start(&m);
    Step s = {.m = &m, .before = p.committed, .number = n};
    for (int k = 0; k < 3; ++k) {
      const double others = corner[0] + corner[1] + corner[2] - corner[k];
      s.strain[k] = (corner[k] - nu * others) / young + size * (2 * random_uniform(&seed) - 1);
    }
    point_try(&p, s.strain, s.stress, NULL, 0);
    s.after = p.trial;
    for (int k = 0; k < 6; ++k) s.increment[k] = s.after[k];
    pyramid_obeys(&s, &c);
    point_stop(&p);
  }
  static const int wanted[] = {0, 1, 2, 3, 4, 5, 6, 8, 9};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; ++k)
    if (c.visits.count[wanted[k]] < 2) fail_msg("only %d trials of kind %d", c.visits.count[wanted[k]], wanted[k]);
  material_destroy(&m);
}

/* ---- The cap: compression positive ---- */

typedef struct CapNumbers {
  double alpha, lambda, beta, theta, ratio, compaction, rate, cut;
  bool strict;
  Visits visits;
} CapNumbers;

static double failure_envelope(const CapNumbers *c, double i)
{
  return c->alpha - c->lambda * exp(-c->beta * i) + c->theta * i;
}

static void cap_obeys(const Step *s, void *data)
{
  CapNumbers *c = data;
  double deviator[6], flow[6];
  deviator_of(s->stress, deviator);
  deviator_of(s->increment, flow);
  const double length = sqrt(dot(deviator, deviator)), i = -trace_of(s->stress), sheared = sqrt(dot(flow, flow)),
               compacted = -trace_of(s->increment), old = s->before[6], k = s->after[6], scale = c->alpha,
               steep = c->beta * c->lambda * exp(-c->beta * i) + c->theta,
               round = sqrt(length * length + pow(past(i - old) / c->ratio, 2));
  enum { INSIDE, CUT, CUT_CORNER, ENVELOPE, CORNER, CAP } where = INSIDE;
  const double near = 1e-9 * scale, tiny = 1e-9 * 1e-3;
  if (sheared < tiny && fabs(compacted) < tiny)
    where = INSIDE;
  else if (fabs(i + c->cut) < near)
    where = fabs(length - failure_envelope(c, i)) < near ? CUT_CORNER : CUT;
  else if (i > old + near || compacted > tiny)
    where = CAP;
  else if (fabs(i - k) < near || fabs(i - old) < near)
    where = CORNER;
  else
    where = ENVELOPE;
  ++c->visits.count[where];
  AT_MOST(s, "cut-off", -c->cut - i, scale);
  if (i <= k) AT_MOST(s, "envelope", length - failure_envelope(c, i), scale);
  if (sheared > tiny)
    for (int n = 0; n < 6; ++n) SMALL(s, "flow", flow[n] - sheared * deviator[n] / fmax(length, 1e-300), 1e-3);
  const double position[2] = {old + c->ratio * failure_envelope(c, old), k + c->ratio * failure_envelope(c, k)},
               moved = c->compaction * (exp(-c->rate * position[0]) - exp(-c->rate * position[1]));
  switch (where) {
  case INSIDE:
    AT_MOST(s, "cap", round - failure_envelope(c, fmin(i, old)), scale);
    SMALL(s, "cap parameter", k - old, scale);
    return;
  case CUT:
    SMALL(s, "shear on the cut-off", sheared, 1e-3);
    AT_MOST(s, "compaction on the cut-off", compacted, 1e-3);
    break;
  case CUT_CORNER: AT_MOST(s, "compaction in the corner", compacted + 3 * steep * sheared, 1e-3); break;
  case ENVELOPE:
    SMALL(s, "consistency on the envelope", length - failure_envelope(c, i), scale);
    SMALL(s, "dilation on the envelope", compacted + 3 * steep * sheared, 1e-3);
    break;
  case CORNER:
    SMALL(s, "consistency in the corner of the cap", length - failure_envelope(c, i), scale);
    AT_MOST(s, "compaction in the corner of the cap", compacted, 1e-3);
    AT_MOST(s, "dilation in the corner of the cap", -compacted - 3 * steep * sheared, 1e-3);
    SMALL(s, "cap parameter in the corner", k - old, scale);
    return;
  case CAP:
    SMALL(s, "consistency on the cap", hypot(length, (i - k) / c->ratio) - failure_envelope(c, k), scale);
    SMALL(s, "direction on the cap", compacted * c->ratio * c->ratio * length - 3 * sheared * (i - k), 1e-3 * scale);
    SMALL(s, "compaction", moved - compacted, 1e-3);
    return;
  }
  /* Dilation draws the cap back by the same law, but not to where it would end left of the envelope at I = 0, nor, if it is strict, behind the
   * stress. */
  const double wanted = exp(-c->rate * position[0]) - compacted / c->compaction;
  if (k != old)
    SMALL(s, "dilation of the cap", moved - compacted, 1e-3);
  else if (compacted < -tiny) {
    const double back = -log(wanted) / c->rate;
    double low = -1e6, high = old; /* k of that position */
    for (int n = 0; n < 200; ++n) {
      const double middle = (low + high) / 2;
      if (middle + c->ratio * failure_envelope(c, middle) > back)
        high = middle;
      else
        low = middle;
    }
    assert_true(back < c->ratio * failure_envelope(c, 0) || low < 0 || (c->strict && low < fmax(i, 0) + near));
  }
  if (c->strict) AT_MOST(s, "strict cap", fmax(i, 0) - k, scale);
}

static void the_cap_model_flows_on_all_its_surfaces(void **state)
{
  (void)state;
  for (int strict = 0; strict < 2; ++strict) {
    Material m =
        material_of("cap", "bulk modulus=14478996", "shear modulus=11721092", "cap position=110320",
                    "compaction rate=4.6412e-7", "largest compaction=0.42", "cap ratio=4.43", "envelope drop=7997.9",
                    "envelope slope=0.11", "envelope rate=6.3816e-5", "envelope strength=2.6614e4",
                    "tension cut-off=2068.4", strict ? "strict cap=1" : NULL, NULL);
    CapNumbers c = {2.6614e4, 7997.9, 6.3816e-5, 0.11, 4.43, 0.42, 4.6412e-7, 2068.4, strict, {{0}}};
    walk(&m, 5e-3, true, cap_obeys, &c);
    all_visited("cap", &c.visits, 6);
    material_destroy(&m);
  }
}

/* ---- Mazars: all of it follows from the strain and the largest equivalent strain so far ---- */

static void mazars_obeys(const Step *s, void *data)
{
  const double *v = data; /* E, nu, k0, 1 / rate, A, B */
  const double young = v[0], nu = v[1], k0 = v[2], rate = 1 / v[3];
  double tensor[6], whole[6], value[3], vector[9], square = 0, tension = 0, share = 0, effective[3];
  for (int k = 0; k < 6; ++k) tensor[k] = s->strain[k] * (k < 3 ? 1 : 0.5);
  tensor_eigen(tensor, value, vector);
  hooke(s->m, tensor, whole);
  for (int k = 0; k < 3; ++k) {
    square += past(value[k]) * past(value[k]);
    effective[k] = young / (1 + nu) * (value[k] + nu / (1 - 2 * nu) * trace_of(tensor));
    tension += past(effective[k]);
  }
  for (int k = 0; k < 3 && square > 0; ++k)
    share += past(value[k]) * ((1 + nu) * past(effective[k]) - nu * tension) / young / square;
  share = fmin(share, 1);
  const double largest = fmax(s->before[0], sqrt(square));
  double damage = s->before[1];
  if (largest > k0) {
    const double in_tension = 1 - k0 / largest * exp(-rate * (largest - k0)),
                 in_compression = 1 - k0 * (1 - v[4]) / largest - v[4] * exp(-v[5] * (largest - k0));
    damage = larger_of(damage, share * in_tension + (1 - share) * fmin(past(in_compression), 1));
  }
  SMALL(s, "equivalent strain", s->after[0] - largest, k0);
  SMALL(s, "damage", s->after[1] - damage, 1);
  for (int k = 0; k < 6; ++k) SMALL(s, "stress", s->stress[k] - (1 - damage) * whole[k], young * k0);
}

static void damage_of_mazars_follows_its_curves(void **state)
{
  (void)state;
  /* Near the threshold, where the one or the other curve rules, far beyond, where the curve of compression would pass 1, and with a negative Poisson ratio,
   * where tensile stresses would make more strain than there is. */
  const struct {
    double size, nu, share, rate;
  } cases[] = {{4e-4, 0.2, 1.2, 1500},
               {1.5e-3, 0.2, 0.7, 900},
               {6e-5, 0.2, 1.2, 1500},
               {8e-3, 0.2, 1.2, 1500},
               {4e-4, -0.4, 1.2, 1500}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; ++n) {
    char nu[40], share[40], rate[40];
    snprintf(nu, sizeof nu, "Poisson ratio=%g", cases[n].nu);
    snprintf(share, sizeof share, "compression share=%g", cases[n].share);
    snprintf(rate, sizeof rate, "compression rate=%g", cases[n].rate);
    const bool standard = cases[n].share == 1.2; /* then they are left out */
    Material m = material_of("mazars", "Young modulus=30e6", nu, "tensile strength=2400", "fracture energy=0.1",
                             "length=0.04", standard ? NULL : share, standard ? NULL : rate, NULL);
    const double k0 = 2400 / 30e6;
    double v[] = {30e6, cases[n].nu, k0, 0.1 / (0.04 * 2400) - k0 / 2, cases[n].share, cases[n].rate};
    walk(&m, cases[n].size, false, mazars_obeys, v);
    material_destroy(&m);
  }
}

/* ---- Plastic damage of concrete: what holds in the effective stress ---- */

typedef struct Concrete {
  double alpha, gamma, dilation, rounding;
  double tension, tension_rate, tension_share, tail, steep; /* c(x) = t exp(-b x) + (1 - t) exp(-steep b x) */
  double compression, hump, compression_rate, compression_share;
  bool by_share; /* closed cracks carry by the share of tension alone */
  Visits visits;
  int held_back; /* steps in which they carry less */
} Concrete;

/** Of a beginning compressive strength, biaxial and meridian ratios, dilation angle, shares of damage and energies over a length. */
static Concrete concrete_of(double young, double tensile, double compressive, double first, double energy,
                            double crushing, double initial, double length, double biaxial, double meridian,
                            double angle, double eccentricity, double share_t, double share_c)
{
  Concrete c = {.alpha = (biaxial - 1) / (2 * biaxial - 1),
                .gamma = 3 * (1 - meridian) / (2 * meridian - 1),
                .dilation = tan(angle * acos(-1) / 180),
                .tension = tensile,
                .tension_share = share_t,
                .compression_share = share_c,
                .compression = first * compressive,
                .tail = 1};
  c.rounding = eccentricity * tensile * c.dilation;
  /* f_c = f_c0 (1 + a)^2 / (4 a): a second-degree equation in a, of whose roots the larger has a hump. */
  const double over = 1 / first;
  c.hump = (4 * over - 2 + sqrt(pow(4 * over - 2, 2) - 4)) / 2;
  c.compression_rate = c.compression * (1 + c.hump / 2) * length / crushing;
  /* Below f_t exp(-b x) over the inelastic strain, x and what damage makes elastic: f_t / b + f_t^2 m / (2 (2 - m) E) less the elastic part. */
  const double area = (energy / length - tensile * tensile / young * share_t / (2 * (2 - share_t))) / tensile;
  c.tension_rate = 1 / area;
  if (initial > 0) {
    /* The first tangent of stress over inelastic strain, f_t / (2 G_f / l), is that of c: 1 / |c'(0)| + m f_t / E. */
    const double slope = 1 / (2 * initial / (length * tensile) - share_t * tensile / young), t = 0.25;
    double low = 1, high = 1e6; /* k: area below c is (t + (1 - t) / k) / b, its slope b (t + (1 - t) k) */
    for (int n = 0; n < 200; ++n) {
      const double k = (low + high) / 2, b = (t + (1 - t) / k) / area;
      if (b * (t + (1 - t) * k) > slope)
        high = k;
      else
        low = k;
    }
    c.tail = t;
    c.steep = low;
    c.tension_rate = (t + (1 - t) / low) / area;
  }
  return c;
}

static void concrete_obeys(const Step *s, void *data)
{
  Concrete *c = data;
  double elastic[6], effective[6], deviator[6], value[3], vector[9], flow[6];
  for (int k = 0; k < 6; ++k) elastic[k] = s->strain[k] * (k < 3 ? 1 : 0.5) - s->after[k];
  hooke(s->m, elastic, effective);
  deviator_of(effective, deviator);
  deviator_of(s->increment, flow);
  tensor_eigen(effective, value, vector);
  const double q = sqrt(1.5 * dot(deviator, deviator)), first = trace_of(effective),
               most = fmax(value[0], fmax(value[1], value[2]));
  double positive = 0, all = 0;
  for (int k = 0; k < 3; ++k) {
    positive += past(value[k]);
    all += fabs(value[k]);
  }
  const double share = all > 0 ? positive / all : 0, in_tension = s->after[6], in_compression = s->after[7],
               b = c->tension_rate,
               curve = c->tail * exp(-b * in_tension) + (1 - c->tail) * exp(-c->steep * b * in_tension),
               bc = c->compression_rate;
  double strength = c->tension * pow(curve, 1 - c->tension_share),
         cohesion = c->compression *
                    ((1 + c->hump) * exp(-bc * in_compression) - c->hump * exp(-2 * bc * in_compression)) /
                    exp(-c->compression_share * bc * in_compression);
  strength = larger_of(strength, 1e-9 * c->tension);
  cohesion = larger_of(cohesion, 1e-9 * c->compression);
  const double beta = cohesion / strength * (1 - c->alpha) - (1 + c->alpha),
               yield = (q + c->alpha * first + beta * past(most) - c->gamma * past(-most)) / (1 - c->alpha) - cohesion;
  /* beta grows as tension goes, and with it what roundings of a stress count. */
  const double scale = c->compression * (1 + 1e-3 * beta), root = sqrt(c->rounding * c->rounding + q * q);
  AT_MOST(s, "yield", yield, scale);
  const double size = sqrt(dot(s->increment, s->increment)),
               multiplier = sqrt(dot(flow, flow)) > 1e-14 ? sqrt(dot(flow, flow)) * root / (sqrt(1.5) * q)
                                                          : trace_of(s->increment) / c->dilation;
  double grown[2] = {0}, increment[3], axes[9];
  if (size > 0) {
    SMALL(s, "consistency", yield, scale);
    for (int k = 0; k < 6; ++k)
      SMALL(s, "flow", s->increment[k] - multiplier * (1.5 * deviator[k] / root + (k < 3 ? c->dilation / 3 : 0)), 1e-3);
    tensor_eigen(s->increment, increment, axes);
    grown[0] = share * past(fmax(increment[0], fmax(increment[1], increment[2])));
    grown[1] = (1 - share) * past(-fmin(increment[0], fmin(increment[1], increment[2])));
  }
  SMALL(s, "plastic strain in tension", in_tension - s->before[6] - grown[0], 1e-3);
  SMALL(s, "plastic strain in compression", in_compression - s->before[7] - grown[1], 1e-3);
  /* Stress that damage has taken comes back with the size of the elastic strain beyond the offset, and never more of it
   * than is not tension. */
  const double young = 9 * s->m->bulk * s->m->shear / (3 * s->m->bulk + s->m->shear),
               strain_size = sqrt(fmax(0, dot(elastic, effective)) / young), before = s->before[9],
               counted = c->by_share ? share : fmax(share, strain_size > before ? before / strain_size : 1);
  const double whole =
      exp(-c->compression_share * bc * in_compression) * (1 - counted * (1 - pow(curve, c->tension_share)));
  if (!c->by_share) SMALL(s, "closing offset", s->after[9] - (in_tension > 0 ? counted * strain_size : 0), 1e-4);
  c->held_back += in_tension > 0 && counted > share + 1e-3;
  SMALL(s, "damage", 1 - s->after[8] - whole, 1);
  for (int k = 0; k < 6; ++k) SMALL(s, "stress", s->stress[k] - whole * effective[k], c->compression);
  ++c->visits.count[size == 0 ? 0 : grown[1] < 1e-6 * grown[0] ? 1 : grown[0] < 1e-6 * grown[1] ? 2 : 3];
}

static void concrete_yields_and_loses_stiffness_as_it_says(void **state)
{
  (void)state;
  Material m[] = {material_of("damage-plasticity", "Young modulus=30e6", "Poisson ratio=0.2", "tensile strength=3000",
                              "compressive strength=34000", "fracture energy=0.1", "length=0.03", NULL),
                  material_of("damage-plasticity", "Young modulus=34e6", "Poisson ratio=0.16", "tensile strength=2500",
                              "compressive strength=38000", "first yield=0.4", "fracture energy=0.12",
                              "crushing energy=14", "initial fracture energy=0.05", "length=0.05", "biaxial ratio=1.2",
                              "meridian ratio=0.7", "dilation angle=28", "eccentricity=0.2", "tension damage=0.6",
                              "compression damage=0.3", "recovery by share=1", NULL)};
  Concrete numbers[] = {
      concrete_of(30e6, 3000, 34000, 0.5, 0.1, pow(34.0 / 3, 2) * 0.1, 0, 0.03, 1.16, 0.6667, 35, 0.1, 0.75, 0.5),
      concrete_of(34e6, 2500, 38000, 0.4, 0.12, 14, 0.05, 0.05, 1.2, 0.7, 28, 0.2, 0.6, 0.3)};
  for (int k = 0; k < 2; ++k)
    for (int far = 0; far < 2; ++far) {
      Concrete c = numbers[k];
      c.by_share = k;
      walk(&m[k], far ? 2e-3 : 3e-4, true, concrete_obeys, &c);
      assert_true(k || c.held_back > 100);
      assert_true(c.visits.count[0] > 5 && c.visits.count[1] > 5 && c.visits.count[3] > 5);
    }
  for (int k = 0; k < 2; ++k) material_destroy(&m[k]);
}

/* ---- Clay within a bounding surface ---- */

typedef struct Clay {
  double strength, modulus, exponent, least, share;
  double strain[6]; /* deviator of the last step, as a tensor */
  Visits visits;
} Clay;

static void clay_obeys(const Step *s, void *data)
{
  Clay *c = data;
  const double *s0 = s->before, *reversal = s->after + 12, k = s->after[18], psi = s->after[19], old = s->before[18],
               R = sqrt(8.0 / 3) * c->strength;
  if (s->number % FRESH == 0) memset(c->strain, 0, sizeof c->strain);
  double tensor[6], e[6], de[6], deviator[6], toward[6], pointing[6], apart = 0;
  for (int n = 0; n < 6; ++n) tensor[n] = s->strain[n] * (n < 3 ? 1 : 0.5);
  deviator_of(tensor, e);
  deviator_of(s->stress, deviator);
  for (int n = 0; n < 6; ++n) {
    de[n] = e[n] - c->strain[n];
    c->strain[n] = e[n];
    toward[n] = old / (1 + old) * s->before[12 + n] - s0[n];
  }
  SMALL(s, "pressure", trace_of(s->stress) / 3 - s->m->bulk * trace_of(tensor), R);
  const bool turned = dot(toward, de) > 0;
  for (int n = 0; n < 6; ++n) {
    SMALL(s, "stress", deviator[n] - s0[n] - psi * de[n], R);
    SMALL(s, "reversal", reversal[n] - (turned ? s0[n] : s->before[12 + n]), R);
    pointing[n] = deviator[n] - reversal[n];
    apart += fabs(s0[n] - reversal[n]);
  }
  const double before =
                   apart == 0 ? 0 : (1 - c->share) / (c->modulus * pow(turned ? 1e10 : old, c->exponent) + c->least),
               after = c->share / (c->modulus * pow(k, c->exponent) + c->least);
  SMALL(s, "stiffness", psi * (1 + 3 * s->m->shear * (before + after)) / (2 * s->m->shear) - 1, 1);
  double to[6]; /* the surface, as seen from the reversal through the stress: over 1 + k, which may be large */
  for (int n = 0; n < 6; ++n) to[n] = (deviator[n] + k * pointing[n]) / (1 + k);
  SMALL(s, "bounding surface", sqrt(dot(to, to)) - R / (1 + k), R);
  ++c->visits.count[turned ? 1 : 0];
}

static void clay_is_as_stiff_as_its_distance_to_the_surface_says(void **state)
{
  (void)state;
  Material m = material_of("bounding-surface-clay", "shear modulus=45000", "bulk modulus=110000",
                           "undrained strength=30", "hardening modulus=25000", "hardening exponent=0.8",
                           "least hardening=300", "implicit share=0.7", NULL);
  Clay c = {.strength = 30, .modulus = 25000, .exponent = 0.8, .least = 300, .share = 0.7};
  walk(&m, 1e-3, false, clay_obeys, &c);
  all_visited("clay", &c.visits, 2);
  material_destroy(&m);
}

/* ---- Viscoelastic: s = 2 G (e - lambda int (1 - exp(-(t - t') / tau)) de(t')), over all steps so far ---- */

static void what_relaxes_remembers_all_steps(void **state)
{
  (void)state;
  enum { TURNS = 40 };
  Material m = material_of("viscoelastic", "Young modulus=9e4", "Poisson ratio=0.31", "relaxing share=0.7",
                           "relaxation time=0.8", NULL);
  double row[2][12] = {{0}}, path[TURNS + 1][6] = {{0}}, time[TURNS + 1] = {0}, stress[6];
  uint64_t seed = 91;
  for (int n = 1; n <= TURNS; ++n) {
    const double step = n % 9 == 4 ? 0 : 0.5 * pow(10, -2 * random_uniform(&seed)); /* also at once */
    memcpy(path[n], path[n - 1], sizeof path[n]);
    sample_wander(&seed, 1e-3, 3e-4, path[n]);
    time[n] = time[n - 1] + step;
    breccia_batch batch = {
        .size = sizeof(breccia_batch), .count = 1, .committed = row[n % 2], .trial = row[1 - n % 2], .time_step = step};
    for (int k = 0; k < 6; ++k) {
      batch.strain[k] = path[n] + k;
      batch.stress[k] = stress + k;
    }
    assert_int_equal(m.law->update(m.constants, &batch), -1);
    double expected[6] = {0}, tensor[6];
    for (int j = 1; j <= n; ++j) {
      double de[6], e[6];
      for (int k = 0; k < 6; ++k) de[k] = (path[j][k] - path[j - 1][k]) * (k < 3 ? 1 : 0.5);
      deviator_of(de, e);
      /* The mean of exp(-(t - t') / tau) over the step. */
      const double width = (time[j] - time[j - 1]) / 0.8, late = (time[n] - time[j]) / 0.8,
                   left = width > 0 ? exp(-late) * -expm1(-width) / width : exp(-late);
      for (int k = 0; k < 6; ++k) expected[k] += 2 * m.shear * (1 - 0.7 * (1 - left)) * e[k];
    }
    for (int k = 0; k < 6; ++k) tensor[k] = path[n][k];
    for (int k = 0; k < 6; ++k)
      assert_near(stress[k], expected[k] + (k < 3 ? m.bulk * trace_of(tensor) : 0), 1e-11 * 9e4 * 1e-3);
  }
  material_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(j2_flows_along_its_normal_and_hardens),
      cmocka_unit_test(drucker_and_prager_flow_on_cone_cut_off_and_tip),
      cmocka_unit_test(mohr_and_coulomb_flow_on_planes_edges_and_corners),
      cmocka_unit_test(trials_beside_corners_flow_on_the_planes_that_push),
      cmocka_unit_test(the_cap_model_flows_on_all_its_surfaces),
      cmocka_unit_test(damage_of_mazars_follows_its_curves),
      cmocka_unit_test(concrete_yields_and_loses_stiffness_as_it_says),
      cmocka_unit_test(clay_is_as_stiff_as_its_distance_to_the_surface_says),
      cmocka_unit_test(what_relaxes_remembers_all_steps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
