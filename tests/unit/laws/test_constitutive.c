#include "constitutive/driver.h"
#include "point.h"

static void corners_of_the_backbone_lie_on_the_hyperbola(void **state)
{
  (void)state;
  /* docs/theory.md 8.2 and validation P1: corners at (gamma(tau_m) - 1.309e-6, tau_m). */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  const double reference = 0.1 * 30 / (60000 * 0.1 - 30);
  assert_near(reference, 5.0251e-4, 1e-8);
  double shift = 1.5 * reference / (60000 * reference - 1.5) - 1.5 / 60000;
  assert_near(shift, 1.309e-6, 1e-9);
  Point d = point_start(&m);
  for (int corner = 1; corner < 20; ++corner) {
    double tau = 30.0 * corner / 20, gamma = tau * reference / (60000 * reference - tau) - shift;
    double from =
        corner == 1 ? 0 : 30.0 * (corner - 1) / 20 * reference / (60000 * reference - 30.0 * (corner - 1) / 20) - shift;
    for (int k = 1; k <= 200; ++k) { /* in simple shear gamma_oct = sqrt(2/3) gamma, tau_oct = sqrt(2/3) tau */
      double strain[6] = {0, 0, 0, sqrt(1.5) * (from + (gamma - from) * k / 200)}, stress[6];
      point_try(&d, strain, stress, NULL, 0);
      point_commit(&d);
      if (k == 200) assert_near(sqrt(2.0 / 3) * stress[3], tau, 1e-6 * 30);
    }
  }
  point_stop(&d);
  material_destroy(&m);
}

static void uniaxial_strength_is_three_tau_over_root_two(void **state)
{
  (void)state;
  /* Uniaxial stress by iterating the lateral strain (validation P4: 63.640 kPa). */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  Point d = point_start(&m);
  double lateral = 0, stress[6];
  for (int k = 1; k <= 3000; ++k) {
    double axial = 0.3 * k / 3000;
    for (int i = 0; i < 60; ++i) {
      double strain[6] = {axial, lateral, lateral}, tangent[36];
      point_try(&d, strain, stress, tangent, 0);
      if (fabs(stress[1]) < 1e-9) break;
      lateral -= stress[1] / (100000 + 20000);
    }
    point_commit(&d);
  }
  assert_near(stress[0], 3 * 30 / sqrt(2), 1e-6 * 63.64);
  point_stop(&d);
  material_destroy(&m);
}

static void unloading_doubles_the_backbone(void **state)
{
  (void)state;
  /* Masing: after a reversal at (g, t) the stress at g - 2 x lies at t - 2 tau(x). */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  enum { STEPS = 4000 };
  static double loading[STEPS + 1];
  double top = 0.004, stress[6];
  Point d = point_start(&m);
  for (int k = 1; k <= STEPS; ++k) {
    double strain[6] = {0, 0, 0, top * k / STEPS};
    point_try(&d, strain, stress, NULL, 0);
    point_commit(&d);
    loading[k] = stress[3];
  }
  for (int k = 1; k <= STEPS; ++k) {
    double strain[6] = {0, 0, 0, top - 2 * top * k / STEPS};
    point_try(&d, strain, stress, NULL, 0);
    point_commit(&d);
    if (k % 500 == 0) assert_near(loading[STEPS] - stress[3], 2 * loading[k], 0.02 * loading[STEPS]);
  }
  point_stop(&d);
  material_destroy(&m);
}

static void multi_yield_tangent_is_the_derivative_of_stress_while_loading_on(void **state)
{
  (void)state;
  /* The law's tangent is the continuum one: it is the derivative in the limit of small increments from the committed state,
   * for increments that load on. */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  Point d = point_start(&m);
  const double direction[6] = {1, -0.4, -0.2, 1.5, 0.7, -0.3};
  double strain[6], s[6], t[6], tangent[36], h = 1e-9;
  for (int step = 1; step <= 400; ++step) {
    for (int k = 0; k < 6; ++k) strain[k] = 1e-5 * step * direction[k];
    point_try(&d, strain, s, tangent, 0);
    point_commit(&d);
  }
  for (int k = 0; k < 6; ++k) strain[k] += h * direction[k];
  point_try(&d, strain, t, NULL, 0);
  for (int r = 0; r < 6; ++r) {
    double expected = 0;
    for (int k = 0; k < 6; ++k) expected += tangent[6 * r + k] * direction[k];
    assert_near((t[r] - s[r]) / h, expected, 2e-3 * 180000);
  }
  point_stop(&d);
  material_destroy(&m);
}

static void plane_stress_of_any_law_has_no_stress_across_the_plane(void **state)
{
  (void)state;
  Material materials[2] = {
      material_of("elastic", "Young modulus=150000", "Poisson ratio=0.25", NULL),
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL)};
  const PointsRun runs[2] = {{0, 0, SLICE}, {1, SLICE, SLICE}};
  Points points;
  assert_int_equal(points_create(&points,
                                 &(PointsSpec){.components = 6,
                                               .plane_stress = true,
                                               .runs = runs,
                                               .run_count = 2,
                                               .materials = materials,
                                               .material_count = 2,
                                               .length = NAN},
                                 NULL),
                   0);
  points_keep_tangents(&points, true, NULL);
  for (int step = 1; step <= 50; ++step) {
    for (int i = 0; i < 2 * SLICE; ++i) {
      points.strain[0][i] = 2e-5 * step;
      points.strain[1][i] = -1e-6 * step * (i % SLICE);
      points.strain[3][i] = 1e-5 * step;
    }
    for (int s = 0; s < 2; ++s) {
      double *strain[6], *stress[6];
      for (int k = 0; k < 6; ++k) {
        strain[k] = points.strain[k] + s * SLICE;
        stress[k] = points.stress[k] + s * SLICE;
      }
      assert_int_equal(points_update(&points, s * SLICE, SLICE, strain, stress), -1);
    }
    for (int i = 0; i < 2 * SLICE; ++i) assert_near(points.stress[2][i], 0, 1e-9 * fabs(points.stress[0][i]));
    points_commit(&points);
  }
  /* Elastic: E / (1 - nu^2) [1 nu; nu 1], shear G. */
  double e = 150000 / (1 - 0.0625), xx = 1e-3, yy = -5e-5 * 3;
  assert_near(points.stress[0][3], e * (xx + 0.25 * yy), 1e-9 * 150);
  assert_near(points.stress[1][3], e * (yy + 0.25 * xx), 1e-9 * 150);
  double tangent[36];
  points_tangent(&points, 0, tangent);
  assert_near(tangent[0], e, 1e-6 * e);
  assert_near(tangent[1], 0.25 * e, 1e-6 * e);
  assert_near(tangent[21], 60000, 1e-6 * e);
  assert_near(tangent[14], 0, 0);
  points_destroy(&points);
  for (int k = 0; k < 2; ++k) material_destroy(&materials[k]);
}

/* ---- closed forms of the other laws ---- */

/** Uniaxial stress to an axial strain in equal steps; calls `seen` after each with its context. */
static void pull(const Material *m, double to, int steps, double tolerance, void (*seen)(void *, const Driver *),
                 void *context)
{
  static const bool lateral[6] = {false, true, true};
  Driver d;
  assert_int_equal(driver_create(&d, m, NULL), 0);
  for (int k = 1; k <= steps; ++k) {
    const double target[6] = {to * k / steps};
    assert_true(driver_step(&d, lateral, target, tolerance));
    seen(context, &d);
  }
  driver_destroy(&d);
}

typedef struct Curve {
  double strain, stress, work, peak;
} Curve;

static void follow_curve(void *context, const Driver *d)
{
  Curve *c = context;
  c->work += (d->stress[0] + c->stress) / 2 * (d->strain[0] - c->strain);
  c->strain = d->strain[0];
  c->stress = d->stress[0];
  if (fabs(c->stress) > fabs(c->peak)) c->peak = c->stress;
}

#define CONCRETE "Young modulus=30e6", "Poisson ratio=0.2", "tensile strength=3000", "fracture energy=0.1"

static void concrete_spends_its_fracture_energy_over_any_length(void **state)
{
  (void)state;
  const char *const lengths[] = {"length=0.01", "length=0.03", "length=0.1"};
  for (int law = 0; law < 3; law += under_sanitizers() ? 2 : 1)
    for (int k = 0; k < (under_sanitizers() ? 1 : 3); ++k) {
      Material m = law == 2 ? material_of("damage-plasticity", CONCRETE, "compressive strength=34000", lengths[k],
                                          "initial fracture energy=0.035", NULL)
                   : law == 1
                       ? material_of("damage-plasticity", CONCRETE, "compressive strength=34000", lengths[k], NULL)
                       : material_of("mazars", CONCRETE, lengths[k], NULL);
      Curve c = {0};
      const double length = atof(lengths[k] + strlen("length="));
      pull(&m, 30 * 0.1 / (length * 3000), 20000, 1e-7, follow_curve, &c);
      assert_near(c.peak, 3000, 2);
      assert_near(c.work * length, 0.1, 1e-3 * 0.1);
      assert_near(c.stress, 0, 1);
      material_destroy(&m);
    }
}

/** Area below the first tangent of stress over opening: length times strain less what unloading along E gives back. */
static double initial_energy(const Material *m, double length)
{
  static const bool lateral[6] = {false, true, true};
  const double yield = 3000 / 30e6;
  Driver d;
  double stress[2], opening[2];
  assert_int_equal(driver_create(&d, m, NULL), 0);
  for (int k = 0; k < 2; ++k) {
    const double target[6] = {yield + (k + 1) * 1e-8 / length};
    assert_true(driver_step(&d, lateral, target, 1e-9));
    stress[k] = d.stress[0];
    opening[k] = length * (d.strain[0] - d.stress[0] / 30e6);
  }
  driver_destroy(&d);
  return 3000.0 * 3000 / 2 * (opening[1] - opening[0]) / (stress[0] - stress[1]);
}

static void the_first_tangent_of_softening_has_its_own_energy(void **state)
{
  (void)state;
  static const struct {
    const char *energy, *length, *damage;
    double expected;
  } cases[] = {{"initial fracture energy=0.035", "length=0.03", "tension damage=0.75", 0.035},
               {"initial fracture energy=0.035", "length=0.1", "tension damage=0.2", 0.035},
               {"initial fracture energy=0.02", "length=0.05", "tension damage=0", 0.02},
               {NULL, "length=0.001", "tension damage=0.75", 0.05}}; /* one exponential, stored energy beside nothing */
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Material m = material_of("damage-plasticity", CONCRETE, "compressive strength=34000", cases[k].length,
                             cases[k].damage, cases[k].energy, NULL);
    const double found = initial_energy(&m, atof(cases[k].length + strlen("length=")));
    assert_near(found, cases[k].expected, 5e-3 * cases[k].expected);
    material_destroy(&m);
  }
}

static void concrete_reaches_its_compressive_and_biaxial_strength(void **state)
{
  (void)state;
  Material m = material_of("damage-plasticity", CONCRETE, "compressive strength=34000", "crushing energy=10",
                           "length=0.03", NULL);
  Curve c = {0};
  pull(&m, -0.01, 2000, 1e-6, follow_curve, &c);
  assert_near(c.peak, -34000, 34);
  static const bool one_free[6] = {false, false, true};
  Driver d;
  assert_int_equal(driver_create(&d, &m, NULL), 0);
  double peak = 0;
  for (int k = 1; k <= 2000; ++k) {
    const double target[6] = {-0.006 * k / 2000, -0.006 * k / 2000};
    assert_true(driver_step(&d, one_free, target, 1e-6));
    peak = fmin(peak, d.stress[0]);
    assert_near(d.stress[0], d.stress[1], 1e-6 * 34000);
  }
  /* 1.16 holds where yielding begins; both meridians harden by the larger plastic strain of the other. */
  assert_near(peak, -1.16 * 34000, 0.01 * 34000);
  driver_destroy(&d);
  material_destroy(&m);
}

static void cracks_of_concrete_close(void **state)
{
  (void)state;
  Material m = material_of("damage-plasticity", CONCRETE, "compressive strength=34000", "length=0.03", NULL);
  static const bool lateral[6] = {false, true, true};
  Driver d;
  assert_int_equal(driver_create(&d, &m, NULL), 0);
  const double path[] = {1e-4, 5e-4, 2e-3};
  for (int k = 0; k < 3; ++k) {
    const double target[6] = {path[k]};
    assert_true(driver_step(&d, lateral, target, 1e-7));
  }
  assert_true(d.stress[0] < 600);
  double back = 0;
  for (int k = 1; k <= 200; ++k) { /* back through the plastic strain: in compression the stiffness returns */
    const double target[6] = {2e-3 - 2.4e-3 * k / 200};
    const double before = d.stress[0];
    assert_true(driver_step(&d, lateral, target, 1e-7));
    back = (d.stress[0] - before) / (-2.4e-3 / 200);
    if (d.stress[0] < -2000) break;
  }
  assert_near(back, 30e6, 1e-3 * 30e6);
  driver_destroy(&d);
  material_destroy(&m);
}

static void mazars_is_strong_in_compression(void **state)
{
  (void)state;
  /* docs/theory.md 8.7: A_c = 1.2, B_c = 1500, E = 30 GPa, nu = 0.2, k0 = 1e-4: 34 MPa. */
  Material m = material_of("mazars", CONCRETE, "length=0.03", NULL);
  Curve c = {0};
  pull(&m, -0.006, 3000, 1e-6, follow_curve, &c);
  assert_near(c.peak, -34000, 500);
  material_destroy(&m);
}

static double triaxial_strength(const Material *m, double confining)
{
  static const bool lateral[6] = {false, true, true}, all[6] = {true, true, true};
  Driver d;
  double peak = 0;
  assert_int_equal(driver_create(&d, m, NULL), 0);
  const double start[6] = {-confining, -confining, -confining};
  assert_true(driver_step(&d, all, start, 1e-9));
  const double first = d.strain[0];
  for (int k = 1; k <= 400; ++k) {
    const double target[6] = {first - 0.02 * k / 400, -confining, -confining};
    assert_true(driver_step(&d, lateral, target, 1e-7));
    peak = fmin(peak, d.stress[0]);
  }
  driver_destroy(&d);
  return -peak;
}

static void triaxial_compression_fails_on_the_coulomb_line(void **state)
{
  (void)state;
  /* s1 = s3 (1 + sin) / (1 - sin) + 2 c cos / (1 - sin), with 30 degrees: 3 s3 + 2 sqrt(3) c. The cone that touches the compressive edges
   * fails there too. */
  const char *const dilation[] = {"dilation angle=0", "dilation angle=30"};
  for (int k = 0; k < 4; ++k) {
    Material m = material_of(k < 2 ? "mohr-coulomb" : "drucker-prager", "Young modulus=50e3", "Poisson ratio=0.3",
                             "cohesion=20", "friction angle=30", dilation[k % 2], NULL);
    for (int confining = 0; confining <= 200; confining += 50)
      assert_near(triaxial_strength(&m, confining), 3 * confining + 2 * sqrt(3) * 20, 1e-6 * 700);
    material_destroy(&m);
  }
}

static void tension_ends_at_the_cut_off(void **state)
{
  (void)state;
  const double far[6] = {0.02, 0.01, 0.015, 0.001};
  const struct {
    const char *law, *cut;
    double each;
  } cases[] = {{"mohr-coulomb", "tensile strength=15", 15}, {"drucker-prager", "tension cut-off=30", 10}};
  for (int k = 0; k < 2; ++k) {
    Material m = material_of(cases[k].law, "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20",
                             "friction angle=30", cases[k].cut, NULL);
    Point p = point_start(&m);
    double s[6];
    point_try(&p, far, s, NULL, 0);
    if (k == 0)
      for (int n = 0; n < 3; ++n) assert_near(s[n], cases[k].each, 1e-9);
    else
      assert_near(s[0] + s[1] + s[2], 3 * cases[k].each, 1e-9);
    point_stop(&p);
    material_destroy(&m);
  }
}

static void steel_that_hardened_by_travelling_yields_early_in_return(void **state)
{
  (void)state;
  /* Prager's rule: after a stress s in uniaxial tension, yield in return comes at s - 2 Y; the slope is E H / (E + H). */
  Material m =
      material_of("j2", "Young modulus=2e8", "Poisson ratio=0.3", "yield stress=2e5", "kinematic modulus=1e7", NULL);
  static const bool lateral[6] = {false, true, true};
  Driver d;
  assert_int_equal(driver_create(&d, &m, NULL), 0);
  double top = 0, slope = 2e8 * 1e7 / 2.1e8;
  for (int k = 1; k <= 100; ++k) {
    const double target[6] = {0.01 * k / 100};
    assert_true(driver_step(&d, lateral, target, 1e-6));
  }
  top = d.stress[0];
  assert_near(top, 2e5 + slope * (0.01 - 1e-3), 1e-6 * top);
  for (int k = 1; k <= 100; ++k) {
    const double target[6] = {0.01 - 0.004 * k / 100};
    assert_true(driver_step(&d, lateral, target, 1e-6));
  }
  assert_near(d.stress[0], top - 4e5 - slope * (0.004 - 2e-3), 1e-6 * top);
  driver_destroy(&d);
  material_destroy(&m);
}

static void bounding_surface_follows_its_rate_equations(void **state)
{
  (void)state;
  /* ds = 2G / (1 + 3 G / H(k)) de with k from |s + k (s - s0)| = R, integrated by Heun's method in simple shear with a reversal. */
  const double shear = 60000, radius = sqrt(8.0 / 3) * 30, h = 60000;
  Material m = material_of("bounding-surface-clay", "shear modulus=60000", "bulk modulus=100000",
                           "undrained strength=30", "hardening modulus=60000", NULL);
  Point p = point_start(&m);
  enum { STEPS = 400, FINE = 500 };
  double s = 0, start = 0, strain = 0; /* of shear: |s| = sqrt(2) s, |e| = strain / sqrt(2) */
  for (int leg = 0; leg < 2; ++leg) {
    const double to = leg ? -0.004 : 0.004, from = strain, first = s;
    start = s;
    for (int k = 1; k <= STEPS; ++k) {
      for (int n = 0; n < FINE; ++n) {
        const double dg = (to - from) / STEPS / FINE;
        double rate[2], at = s;
        for (int stage = 0; stage < 2; ++stage) {
          const double moved = fabs(at - start), sign = dg > 0 ? 1 : -1;
          /* s + k (s - s0) = +-R / sqrt(2) */
          const double distance = moved > 0 ? (radius / sqrt(2) - sign * at) / moved : 1e10;
          rate[stage] = shear / (1 + 3 * shear / (h * distance));
          at = s + rate[0] * dg;
        }
        s += (rate[0] + rate[1]) / 2 * dg;
      }
      const double g[6] = {0, 0, 0, from + (to - from) * k / STEPS};
      double stress[6];
      point_try(&p, g, stress, NULL, 0);
      point_commit(&p);
      assert_near(stress[3], s, 0.004 * radius);
    }
    strain = to;
    assert_true(fabs(s - first) > 30);
  }
  point_stop(&p);
  material_destroy(&m);
}

static void isotropic_compression_moves_the_cap_alone(void **state)
{
  (void)state;
  /* Plastic volume is W (exp(-D X0) - exp(-D X)) with X the pressure's first invariant; exactly isotropic strain is where the class of
   * OpenSees divides nothing by nothing. */
  Material m =
      material_of("cap", "bulk modulus=50000", "shear modulus=30000", "cap position=300", "compaction rate=6.0e-4",
                  "largest compaction=0.10", "cap ratio=2.5", "envelope drop=60", "envelope slope=0.12",
                  "envelope rate=2.0e-3", "envelope strength=80", "tension cut-off=10", NULL);
  Point p = point_start(&m);
  for (int k = 1; k <= 100; ++k) {
    const double e = -5e-4 * k, strain[6] = {e, e, e};
    double s[6];
    point_try(&p, strain, s, NULL, 0);
    point_commit(&p);
    const double x = -3 * s[0], plastic = x > 300 ? 0.1 * (exp(-6e-4 * 300) - exp(-6e-4 * x)) : 0;
    assert_near(-3 * e, x / (3 * 50000) + plastic, 1e-12);
  }
  point_stop(&p);
  material_destroy(&m);
}

static void shear_at_the_critical_state_goes_on_for_ever(void **state)
{
  (void)state;
  /* Where envelope and cap meet, volume and strength stay: |s| = F(k) at I1 = k. There the class of OpenSees divides nothing by nothing. */
  Material m =
      material_of("cap", "bulk modulus=50000", "shear modulus=30000", "cap position=300", "compaction rate=6.0e-4",
                  "largest compaction=0.10", "cap ratio=2.5", "envelope drop=60", "envelope slope=0.12",
                  "envelope rate=2.0e-3", "envelope strength=80", "tension cut-off=10", NULL);
  const double hairs[] = {0, 1e-15, 1e-12, 1e-9, 1e-6}; /* how far beyond it begins */
  for (int way = 0; way < 2; ++way)                     /* with the tangent, and without */
    for (int hair = 0; hair < 5; ++hair) {
      Point p = point_start(&m);
      const double k = p.committed[6], volume = -k / (9 * 50000) * (1 + hairs[hair]);
      for (int step = 0; step <= 400; ++step) {
        const double strain[6] = {volume, volume, volume, 2e-4 * step};
        double s[6], tangent[36];
        point_try(&p, strain, s, way ? tangent : NULL, 0);
        point_commit(&p);
        if (step < 50) continue;
        assert_near(-(s[0] + s[1] + s[2]), k, 3e-6 * k);
        assert_near(s[3] * sqrt(2), 80 - 60 * exp(-2e-3 * k) + 0.12 * k, 3e-6 * 80);
      }
      point_stop(&p);
    }
  material_destroy(&m);
}

static void inadmissible_parameters_are_refused_with_the_reason(void **state)
{
  (void)state;
  const struct {
    const char *law, *words, *reason;
  } cases[] = {
      {"cap",
       "bulk modulus=5e4,shear modulus=3e4,envelope strength=80,cap ratio=2.5,cap position=100,largest "
       "compaction=0.1,compaction rate=6e-4,tension cut-off=10",
       "lies left of the failure envelope"},
      {"cap",
       "bulk modulus=5e4,shear modulus=3e4,envelope strength=80,envelope slope=0.1,cap ratio=2.5,cap "
       "position=300,largest compaction=0.1,compaction rate=6e-4,tension cut-off=900",
       "must be above 0 at the tension cut-off"},
      {"j2", "bulk modulus=5e4,shear modulus=3e4,yield stress=100,saturation stress=90", "does not soften"},
      {"j2", "bulk modulus=5e4,Young modulus=3e4,yield stress=100", "give 'Young modulus' and 'Poisson ratio'"},
      {"drucker-prager", "bulk modulus=5e4,shear modulus=3e4,cohesion=10", "give 'cohesion' and 'friction angle'"},
      {"drucker-prager", "bulk modulus=5e4,shear modulus=3e4,cohesion=10,friction angle=20,dilation angle=30",
       "would make energy"},
      {"drucker-prager", "bulk modulus=5e4,shear modulus=3e4,cohesion=10,friction angle=20,tension cut-off=1000",
       "beyond the tip of the cone"},
      {"mohr-coulomb", "bulk modulus=5e4,shear modulus=3e4,cohesion=10,friction angle=20,tensile strength=50",
       "beyond the tip of the pyramid"},
      {"mohr-coulomb", "bulk modulus=5e4,shear modulus=3e4,cohesion=10,friction angle=20,dilation angle=21",
       "would make energy"},
      {"mazars", "Young modulus=3e7,Poisson ratio=0.2,tensile strength=3000,fracture energy=0.1,length=1",
       "it must be less than 2 E G_F / f_t^2 = 0.666667"},
      {"mazars", "Young modulus=3e7,Poisson ratio=0.2,tensile strength=3000,fracture energy=0.1", "needs the 'length'"},
      {"damage-plasticity",
       "Young modulus=3e7,Poisson ratio=0.2,tensile strength=3000,compressive strength=3e4,fracture "
       "energy=0.1,length=1",
       "snap back"},
      {"damage-plasticity",
       "Young modulus=3e7,Poisson ratio=0.2,tensile strength=3000,compressive strength=5e3,fracture "
       "energy=0.1,length=0.01",
       "must be larger than 'tensile strength'"},
      {"damage-plasticity",
       "Young modulus=3e7,Poisson ratio=0.2,tensile strength=3000,compressive strength=3e4,fracture "
       "energy=0.1,length=0.3,initial fracture energy=0.04",
       "it must be less than 0.266667"},
      {"damage-plasticity",
       "Young modulus=3e7,Poisson ratio=0.2,tensile strength=3000,compressive strength=3e4,fracture "
       "energy=0.1,length=0.001,initial fracture energy=0.06",
       "must be at most 0.0500"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char reason[512] = "";
    assert_int_equal(material_refusal(cases[k].law, cases[k].words, reason, sizeof reason), BRECCIA_USER_ERROR);
    if (!strstr(reason, cases[k].reason)) fail_msg("%s: says '%s'", cases[k].law, reason);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corners_of_the_backbone_lie_on_the_hyperbola),
      cmocka_unit_test(uniaxial_strength_is_three_tau_over_root_two),
      cmocka_unit_test(unloading_doubles_the_backbone),
      cmocka_unit_test(multi_yield_tangent_is_the_derivative_of_stress_while_loading_on),
      cmocka_unit_test(plane_stress_of_any_law_has_no_stress_across_the_plane),
      cmocka_unit_test(concrete_spends_its_fracture_energy_over_any_length),
      cmocka_unit_test(the_first_tangent_of_softening_has_its_own_energy),
      cmocka_unit_test(concrete_reaches_its_compressive_and_biaxial_strength),
      cmocka_unit_test(cracks_of_concrete_close),
      cmocka_unit_test(mazars_is_strong_in_compression),
      cmocka_unit_test(triaxial_compression_fails_on_the_coulomb_line),
      cmocka_unit_test(tension_ends_at_the_cut_off),
      cmocka_unit_test(steel_that_hardened_by_travelling_yields_early_in_return),
      cmocka_unit_test(bounding_surface_follows_its_rate_equations),
      cmocka_unit_test(isotropic_compression_moves_the_cap_alone),
      cmocka_unit_test(shear_at_the_critical_state_goes_on_for_ever),
      cmocka_unit_test(inadmissible_parameters_are_refused_with_the_reason),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
