/* What laws do where no parameter is given, under confinement, after an elastic stage, and when a point gives up: in closed form. And what their
 * histories keep. */
#include "sample_laws.h"

#include "base/tensor.h"
#include "constitutive/driver.h"
#include "constitutive/normal_lengths.h"
#include "points/points.h"

static const bool lateral[6] = {false, true, true};

/** Triaxial compression in equal steps to an axial strain, after an isotropic one; calls `seen` after each with its context. */
static void compress(const Material *m, double confining, double strain, int steps,
                     void (*seen)(void *, const Driver *), void *context)
{
  static const bool all[6] = {true, true, true};
  const double start[6] = {-confining, -confining, -confining};
  Driver d;
  assert_int_equal(driver_create(&d, m, NULL), 0);
  if (confining > 0) assert_true(driver_step(&d, all, start, 1e-9));
  const double first = d.strain[0];
  for (int k = 1; k <= steps; ++k) {
    const double target[6] = {first - strain * k / steps, -confining, -confining};
    assert_true(driver_step(&d, lateral, target, 1e-6));
    seen(context, &d);
  }
  driver_destroy(&d);
}

static void keep_peak(void *context, const Driver *d)
{
  double *peak = context;
  *peak = larger_of(*peak, -d->stress[0]);
}

#define CONCRETE                                                                                                       \
  "Young modulus=30e6", "Poisson ratio=0.2", "tensile strength=3000", "fracture energy=0.1",                           \
      "compressive strength=34000", "crushing energy=10", "length=0.03"

static void confined_concrete_follows_its_compressive_meridian(void **state)
{
  (void)state;
  /* Lubliner's surface with all stresses compressive: q - alpha (3 p + q) - gamma p = (1 - alpha) f_c, homogeneous in the stresses, so that
   * it holds for nominal ones too; alpha = (b - 1) / (2 b - 1), gamma = 3 (1 - K) / (2 K - 1). */
  const double alpha = 0.2 / 1.4, ratio[] = {0.6, 0.75, 1};
  const char *const meridian[] = {"meridian ratio=0.6", "meridian ratio=0.75", "meridian ratio=1"};
  for (int k = 0; k < 3; ++k) {
    Material m = material_of("damage-plasticity", CONCRETE, "biaxial ratio=1.2", meridian[k], NULL);
    const double gamma = 3 * (1 - ratio[k]) / (2 * ratio[k] - 1);
    for (double confining = 0; confining <= 10000; confining += 5000) {
      double peak = 0;
      compress(&m, confining, 0.02, 800, keep_peak, &peak);
      const double expected = confining + 34000 + (3 * alpha + gamma) / (1 - alpha) * confining;
      assert_near(peak, expected, 1e-3 * expected);
    }
    material_destroy(&m);
  }
}

/** Plastic change of volume over the plastic axial strain; laws whose history begins with the plastic strain. */
static void keep_dilatancy(void *context, const Driver *d)
{
  const double *plastic = d->committed;
  *(double *)context = (plastic[0] + plastic[1] + plastic[2]) / plastic[0];
}

static double length_of_context(const void *context, const double normal[3])
{
  assert_near(fabs(normal[0]), 1, 1e-9);
  return *(const double *)context;
}

static void points_spread_the_fracture_energy_over_the_length_of_their_first_strain(void **state)
{
  (void)state;
  /* A point with a length of 0.05 m by its crack normal follows the curve of a law whose own length is 0.05 m. */
  static const char *const laws[] = {"mazars", "damage-plasticity", "damage-plasticity"};
  const double length = 0.05, peak = 1e-4;
  for (int k = 0; k < 3; ++k) {
    const bool tail = k == 2;
    double stress[3][6];
    for (int turn = 0; turn < 3; ++turn) { /* the length of the law, that of the direction, the same as a parameter */
      const char *over = turn == 2 ? "length=0.05" : "length=0.03",
                 *initial = tail ? "initial fracture energy=0.04" : NULL;
      Material m = k ? material_of(laws[k], "Young modulus=30e6", "Poisson ratio=0", "tensile strength=3000",
                                   "fracture energy=0.1", "compressive strength=34000", over, initial, NULL)
                     : material_of(laws[k], "Young modulus=30e6", "Poisson ratio=0", "tensile strength=3000",
                                   "fracture energy=0.1", over, NULL);
      if (turn == 1)
        assert_true(normal_lengths_give(&m, &(NormalLengths){.across = length_of_context, .context = &length}));
      Point p = point_start(&m);
      double strain[6] = {0};
      for (int n = 0; n < 400; ++n) {
        strain[0] = peak * (1 + 1e-6 + 0.02 * n);
        point_try(&p, strain, stress[turn], NULL, 0);
        point_commit(&p);
      }
      point_stop(&p);
      material_destroy(&m);
    }
    assert_true(stress[0][0] > 1.1 * stress[2][0]);
    assert_near(stress[1][0], stress[2][0], 1e-4 * stress[2][0]);
  }
}

static void dilation_that_is_not_given_is_what_the_manual_says(void **state)
{
  (void)state;
  /* In triaxial compression: of Mohr and Coulomb and of the cone at their compressive edges -2 sin / (1 - sin), of a cone of slope a
   * 3 a / (a - 1 / sqrt(3)), of concrete tan / (tan / 3 - 1) but for the rounding of the tip. */
  const double a = 0.2, tangent = tan(35 * acos(-1) / 180);
  struct {
    Material m;
    double dilatancy, tolerance;
  } cases[] = {
      {material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30", NULL),
       0, 1e-6},
      {material_of("mohr-coulomb", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30",
                   "dilation angle=30", NULL),
       -2, 1e-6},
      {material_of("drucker-prager", "Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30",
                   NULL),
       -2, 1e-6},
      {material_of("drucker-prager", "Young modulus=50e3", "Poisson ratio=0.3", "cone strength=20", "cone slope=0.2",
                   NULL),
       3 * a / (a - 1 / sqrt(3)), 1e-6},
      {material_of("damage-plasticity", CONCRETE, NULL), tangent / (tangent / 3 - 1), 1e-3},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    double dilatancy = NAN;
    compress(&cases[k].m, 50, 0.01, 100, keep_dilatancy, &dilatancy);
    assert_near(dilatancy, cases[k].dilatancy, cases[k].tolerance);
    material_destroy(&cases[k].m);
  }
}

static void clay_that_was_loaded_elastically_starts_from_there(void **state)
{
  (void)state;
  /* What an elastic stage leaves is where the bounding surface measures from: ds = 2G / (1 + 3 G / H(k)) de with k from
   * |s + k (s - s0)| = R and s0 the stress at the stage's end; loading on, and unloading. In simple shear |s| = sqrt(2) s. */
  const double shear = 60000, strength = sqrt(4.0 / 3) * 30, h = 60000;
  Material m = material_of("bounding-surface-clay", "shear modulus=60000", "bulk modulus=100000",
                           "undrained strength=30", "hardening modulus=60000", NULL);
  for (int sign = -1; sign <= 1; sign += 2) {
    enum { STEPS = 200, FINE = 500 };
    Point p = point_start(&m);
    double strain[6] = {0}, stress[6];
    for (int k = 1; k <= 5; ++k) {
      strain[3] = 5e-5 * k;
      point_try(&p, strain, stress, NULL, 1);
      point_commit(&p);
      assert_near(stress[3], shear * strain[3], 1e-9);
    }
    const double start = stress[3], from = strain[3], step = sign * 1e-3 / STEPS;
    double s = start;
    for (int k = 1; k <= STEPS; ++k) {
      for (int n = 0; n < FINE; ++n) {
        double rate[2], at = s;
        for (int stage = 0; stage < 2; ++stage) {
          const double moved = fabs(at - start), distance = moved > 0 ? (strength - sign * at) / moved : 1e10;
          rate[stage] = shear / (1 + 3 * shear / (h * distance));
          at = s + rate[0] * step / FINE;
        }
        s += (rate[0] + rate[1]) / 2 * step / FINE;
      }
      strain[3] = from + step * k;
      point_try(&p, strain, stress, NULL, 0);
      point_commit(&p);
      assert_near(stress[3], s, 1e-3 * strength);
    }
    assert_true(fabs(s - start) > 8);
    point_stop(&p);
  }
  material_destroy(&m);
}

static void clay_that_was_loaded_elastically_forgets_what_came_before(void **state)
{
  (void)state;
  /* Sheared by its law, then elastically, then by its law: as a clay that was only sheared elastically to the same stress. Of the way before nothing may be
   * left, neither the reversal nor the distance to the surface. */
  Material m = material_of("bounding-surface-clay", "shear modulus=60000", "bulk modulus=100000",
                           "undrained strength=30", "hardening modulus=60000", NULL);
  for (int sign = -1; sign <= 1; sign += 2) {
    Point one = point_start(&m), other = point_start(&m);
    double strain[6] = {0}, beside[6] = {0}, stress[6], same[6];
    for (int k = 1; k <= 10; ++k) {
      strain[3] = 1e-4 * k;
      point_try(&one, strain, stress, NULL, 0);
      point_commit(&one);
    }
    strain[3] += 1e-5;
    point_try(&one, strain, stress, NULL, 1);
    point_commit(&one);
    assert_true(stress[3] > 12 && stress[3] < 25);
    assert_true(one.committed[18] >
                1e9); /* the distance that results tell (test_laws): the stress stands at its reversal */
    beside[3] = stress[3] / m.shear;
    point_try(&other, beside, same, NULL, 1);
    point_commit(&other);
    assert_near(same[3], stress[3], 1e-9);
    for (int k = 1; k <= 10; ++k) {
      strain[3] += sign * 5e-5;
      beside[3] += sign * 5e-5;
      point_try(&one, strain, stress, NULL, 0);
      point_try(&other, beside, same, NULL, 0);
      point_commit(&one);
      point_commit(&other);
      assert_near(stress[3], same[3], 1e-9);
    }
    point_stop(&one);
    point_stop(&other);
  }
  material_destroy(&m);
}

static void clay_that_stands_still_is_as_stiff_as_in_its_last_step(void **state)
{
  (void)state;
  Material m = material_of("bounding-surface-clay", "shear modulus=60000", "bulk modulus=100000",
                           "undrained strength=30", "hardening modulus=60000", NULL);
  Point p = point_start(&m);
  double strain[6] = {0}, stress[6], tangent[36], before = 0;
  for (int k = 1; k <= 20; ++k) {
    strain[3] = 5e-5 * k;
    point_try(&p, strain, stress, NULL, 0);
    point_commit(&p);
    const double secant = (stress[3] - before) / 5e-5;
    before = stress[3];
    for (int again = 0; again < 2; ++again) { /* and goes on standing still */
      point_try(&p, strain, stress, tangent, 0);
      point_commit(&p);
      assert_near(stress[3], before, 1e-12);
      assert_near(tangent[21], secant, 1e-6 * m.shear);
      assert_near(tangent[0], m.bulk + 4 * secant / 3, 1e-6 * m.shear);
    }
    assert_true(k < 10 || secant < 0.8 * m.shear);
  }
  point_stop(&p);
  material_destroy(&m);
}

/* "chalk": elastic up to a strain xx of 1e-3, where it gives up; it remembers its last strain xx, and notes it before it gives up. */
static int chalk_prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)values, (void)constants, (void)reason, (void)size;
  return 0;
}
static void chalk_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = 1e5;
  *shear = 6e4;
}
static int chalk_values(const void *constants)
{
  (void)constants;
  return 1;
}
static int chalk_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    batch->trial[i] = batch->strain[0][i];
    for (int k = 0; k < 6; ++k) batch->stress[k][i] = 6e4 * batch->strain[k][i];
    if (batch->strain[0][i] > 1e-3) return i;
  }
  return -1;
}
static const breccia_law law_of_chalk = {.size = sizeof(breccia_law),
                                         .name = "chalk",
                                         .about = "gives up",
                                         .source = "the tests",
                                         .maturity = "experimental",
                                         .constants_size = 1,
                                         .components = 6,
                                         .prepare = chalk_prepare,
                                         .moduli = chalk_moduli,
                                         .history_values = chalk_values,
                                         .update = chalk_update};

static void a_point_that_gives_up_carries_nothing_and_keeps_its_history(void **state)
{
  (void)state;
  enum { LOST = 3, FAILS = 3, STEPS = 6 };
  Material m;
  char reason[128];
  assert_int_equal(material_prepare(&m, &law_of_chalk, NULL, reason, sizeof reason), 0);
  const PointsRun run = {0, 0, SLICE};
  Points points;
  const PointsSpec spec = {.components = 6,
                           .runs = &run,
                           .run_count = 1,
                           .materials = &m,
                           .material_count = 1,
                           .may_give_up = true,
                           .length = NAN};
  assert_int_equal(points_create(&points, &spec, NULL), 0);
  for (int step = 1; step <= STEPS; ++step) {
    for (int i = 0; i < SLICE; ++i) points.strain[XX][i] = i == LOST && step >= FAILS ? 2e-3 : 1e-5 * step * (i + 1);
    assert_int_equal(points_update(&points, 0, SLICE, points.strain, points.stress), -1);
    points_commit(&points);
    for (int i = 0; i < SLICE; ++i) {
      const bool lost = i == LOST && step >= FAILS;
      assert_near(points_history(&points, i)[0], 1e-5 * (lost ? FAILS - 1 : step) * (i + 1), 1e-18);
      assert_near(points.stress[XX][i], lost ? 0 : 0.6 * step * (i + 1), 1e-12);
      assert_int_equal(points.gave_up[i] != 0, lost);
    }
  }
  points_destroy(&points);
  material_destroy(&m);
}

static void rows_that_take_turns_remember_what_whole_copies_do(void **state)
{
  (void)state;
  /* A law writes of its new row what differs from the committed one only, because both rows take turns. The same walk with the whole row
   * copied before each step, gently and so far that every surface is reached and slid along, must leave the same bits. */
  for (int n = 0; n < SAMPLES; ++n)
    for (int far = 0; far < 2; ++far) {
      Material m = samples[n].make();
      Point turns = point_start(&m), copied = point_start(&m);
      const size_t bytes = sizeof(double) * (size_t)m.history_values;
      uint64_t seed = 53;
      double strain[6] = {0}, a[6], b[6];
      for (int step = 0; step < 600; ++step) {
        const double size = samples[n].strain * (far ? 40 : 1);
        sample_wander(&seed, size, size / 5, strain);
        memcpy(copied.trial, copied.committed, bytes);
        point_try(&turns, strain, a, NULL, 0);
        point_try(&copied, strain, b, NULL, 0);
        assert_memory_equal(a, b, sizeof a);
        point_commit(&turns);
        point_commit(&copied);
      }
      point_stop(&turns);
      point_stop(&copied);
      material_destroy(&m);
    }
}

static void the_tangent_of_a_law_that_relaxes_is_that_of_its_step(void **state)
{
  (void)state;
  /* 2 G (1 - lambda (1 - (1 - e^-x) / x)) for a deviator that grows evenly in a step of x relaxation times; K for the volume. */
  Material m = material_of("viscoelastic", "Young modulus=2e8", "Poisson ratio=0.3", "relaxing share=0.6",
                           "relaxation time=2", NULL);
  const double steps[] = {0, 1e-3, 0.3, 1.7, 40};
  for (int n = 0; n < 5; ++n) {
    const double x = steps[n] / 2, held = x > 0 ? 1 - 0.6 * (1 - (1 - exp(-x)) / x) : 1,
                 expected[3] = {m.bulk + 4 * m.shear * held / 3, m.bulk - 2 * m.shear * held / 3, m.shear * held};
    double committed[12] = {0}, trial[12], strain[6] = {3e-4, -1e-4, 2e-4, 5e-4, -7e-4, 1e-4}, stress[6], tangent[36];
    breccia_batch batch = {.size = sizeof(breccia_batch),
                           .count = 1,
                           .committed = committed,
                           .trial = trial,
                           .tangent = tangent,
                           .time_step = steps[n]};
    for (int k = 0; k < 6; ++k) {
      batch.strain[k] = strain + k;
      batch.stress[k] = stress + k;
    }
    assert_int_equal(m.law->update(m.constants, &batch), -1);
    assert_near(tangent[0], expected[0], 1e-12 * expected[0]);
    assert_near(tangent[1], expected[1], 1e-12 * expected[0]);
    assert_near(tangent[21], expected[2], 1e-12 * expected[0]);
    assert_near(stress[3], expected[2] * strain[3], 1e-12 * expected[0]); /* from rest the step is proportional */
  }
  material_destroy(&m);
}

static void damage_of_mazars_never_heals(void **state)
{
  (void)state;
  /* Pulled until a known share is gone, E k0 (1 - D) e; then pressed so little that compression would damage less: what was lost stays
   * lost, and so it does when it is pulled again. */
  Material m = material_of("mazars", "Young modulus=30e6", "Poisson ratio=0", "tensile strength=3000",
                           "fracture energy=0.1", "length=0.03", NULL);
  const double k0 = 1e-4, pulled = 5e-4, rate = 1 / (0.1 / (0.03 * 3000) - k0 / 2),
               whole = k0 / pulled * exp(-rate * (pulled - k0)), to[] = {pulled, -3e-4, 2e-4, -1e-5, pulled};
  Point p = point_start(&m);
  for (int k = 0; k < 5; ++k) {
    double strain[6] = {to[k]}, stress[6];
    point_try(&p, strain, stress, NULL, 0);
    point_commit(&p);
    assert_near(stress[0], whole * 30e6 * to[k], 1e-9 * 3000);
  }
  assert_true(whole < 0.2);
  point_stop(&p);
  material_destroy(&m);
}

/** Damage in compression begins later than damage in tension where its rate is low; until then it takes nothing off the latter. */
static void compression_of_mazars_mends_nothing(void **state)
{
  (void)state;
  static const char *const compression[][2] = {{"compression share=1.2", "compression rate=1"},
                                               {"compression share=1", "compression rate=1e-6"}};
  static const double strains[][6] = {
      {3e-4, -6e-4, 0}, {2e-4, 1e-4, -4e-4}, {0, 0, -2e-4, 5e-4}, {1.5e-4, -2e-4, 0, 0, 2e-4, 0}};
  for (size_t n = 0; n < sizeof strains / sizeof *strains; ++n) {
    double stress[2][6], whole[6];
    for (int k = 0; k < 2; ++k) {
      Material m = material_of("mazars", "Young modulus=30e6", "Poisson ratio=0.2", "tensile strength=3000",
                               "fracture energy=0.1", "length=0.03", compression[k][0], compression[k][1], NULL);
      Point p = point_start(&m);
      point_try(&p, strains[n], stress[k], NULL, 0);
      point_try(&p, strains[n], whole, NULL, 1);
      point_stop(&p);
      material_destroy(&m);
    }
    for (int k = 0; k < 6; ++k) {
      assert_near(stress[0][k], stress[1][k], 1e-6 * 3000);
      if (fabs(whole[k]) > 1000) assert_true(fabs(stress[0][k]) < 0.95 * fabs(whole[k]));
    }
  }
}

/* "hourglass": elastic; it remembers the time and the time step that it was told. */
static int hourglass_values(const void *constants)
{
  (void)constants;
  return 2;
}
static int hourglass_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    batch->trial[2 * i] = batch->time;
    batch->trial[2 * i + 1] = batch->time_step;
    for (int k = 0; k < 6; ++k) batch->stress[k][i] = 6e4 * batch->strain[k][i];
  }
  return -1;
}
static const breccia_law law_of_hourglass = {.size = sizeof(breccia_law),
                                             .name = "hourglass",
                                             .about = "tells the time",
                                             .source = "the tests",
                                             .maturity = "experimental",
                                             .constants_size = 1,
                                             .components = 6,
                                             .prepare = chalk_prepare,
                                             .moduli = chalk_moduli,
                                             .history_values = hourglass_values,
                                             .update = hourglass_update};

static void laws_are_told_the_time_of_the_end_of_their_step(void **state)
{
  (void)state;
  const breccia_law *const laws[] = {&law_of_hourglass};
  const breccia_options options = {.size = sizeof(breccia_options), .laws = laws, .law_count = 1};
  breccia_model *m;
  assert_int_equal(
      breccia_model_load_string("units: {length: m, force: kN, time: s}\n"
                                "materials: {h: {model: hourglass, density: 2}}\n"
                                "body: {b: {material: h, spacing: 0.1, shape: {box: {particles: [5, 4, 3]}}}}\n"
                                "solve: {explicit: {time step: 1e-5, end time: 7.4e-5}}\n",
                                "deck", &options, &m, NULL),
      0);
  for (int step = 1; step <= 8; ++step) { /* the last one is shorter */
    step_surely(m, 1);
    for (int64_t n = 0; n < m->domain.particles->count; ++n) {
      const double *told = points_history(&m->domain.regions[0].points, m->domain.particles->place_of[n]);
      assert_near(told[0], step < 8 ? 1e-5 * step : 7.4e-5, 1e-18);
      assert_near(told[1], step < 8 ? 1e-5 : 4e-6, 1e-18);
    }
  }
  breccia_model_destroy(&m);
}

/** Roundings of a strain that is held are no reversal, however often they come; a small reversal that is none of them is one: the clay is then as stiff
 *  as at first, 2 G but for its hardening from far away. */
static void clay_that_is_held_goes_on_as_if_it_had_not_been(void **state)
{
  (void)state;
  Material m = material_of("bounding-surface-clay", "shear modulus=60000", "bulk modulus=100000",
                           "undrained strength=30", "hardening modulus=60000", NULL);
  double shear[3][2];
  for (int way = 0; way < 3; ++way) { /* straight on; held between; turned back a little between */
    Point point = point_start(&m);
    double strain[6] = {1e-4, -5e-5, -5e-5, 0, 0, 0}, stress[6];
    for (int step = 1; step <= 40; ++step) {
      strain[XY] = 1e-5 * step;
      point_try(&point, strain, stress, NULL, 0);
      point_commit(&point);
    }
    const double held = strain[XY];
    for (int turn = 0; turn < 6 && way == 1; ++turn) {
      strain[XY] = held * (1 + (turn % 2 ? 1 : -1) * 2e-16);
      point_try(&point, strain, stress, NULL, 0);
      point_commit(&point);
    }
    if (way == 2) {
      strain[XY] = held * (1 - 1e-9);
      point_try(&point, strain, stress, NULL, 0);
      point_commit(&point);
    }
    shear[way][0] = stress[XY];
    strain[XY] = held + (way == 2 ? -1e-7 : 1e-7);
    point_try(&point, strain, stress, NULL, 0);
    shear[way][1] = stress[XY];
    point_stop(&point);
  }
  const double slope = (shear[0][1] - shear[0][0]) / 1e-7, back = (shear[2][0] - shear[2][1]) / 1e-7;
  assert_near(shear[1][0], shear[0][0], 1e-9 * shear[0][0]);
  assert_near(shear[1][1] - shear[1][0], shear[0][1] - shear[0][0], 1e-6 * (shear[0][1] - shear[0][0]));
  assert_true(slope < 0.7 * back && back > 0.98 * 60000 && back < 1.001 * 60000);
  material_destroy(&m);
}

/** Soil with friction keeps its Poisson's ratio at any pressure p at the end of the elastic stage: both moduli grow by
 * ((p + p_r) / (p_ref + p_r))^n. The cone has its apex at p_r = 3 c / (sqrt(2) M), M = 6 sin(phi) / (3 - sin(phi)). */
static void both_moduli_of_soil_grow_with_its_pressure(void **state)
{
  (void)state;
  const double sine = sin(25 * acos(-1) / 180), apex = 3 * 10 / (sqrt(2) * 6 * sine / (3 - sine));
  Material m = material_of("multi-yield-j2", "shear modulus=40000", "bulk modulus=90000", "cohesion=10",
                           "friction angle=25", "reference pressure=80", "pressure exponent=0.5", NULL);
  for (double pressure = 20; pressure < 500; pressure *= 4) {
    const double even = -pressure / (3 * 90000.0), more = -1e-6;
    const double first[6] = {even, even, even}, second[6] = {even + more, even + more, even + more};
    Driver d;
    assert_int_equal(driver_create(&d, &m, NULL), 0);
    d.elastic = true;
    assert_true(driver_try(&d, first));
    driver_commit(&d);
    assert_near(d.stress[0], -pressure, 1e-9 * pressure);
    d.elastic = false;
    assert_true(driver_try(&d, second));
    const double grown = sqrt((pressure + apex) / (80 + apex)), bulk = 90000 * grown, shear = 40000 * grown;
    assert_near(d.stress[0], -pressure + 3 * bulk * more, 1e-9 * pressure);
    assert_near(d.tangent[0], bulk + 4 * shear / 3, 1e-9 * bulk);
    assert_near(d.tangent[1], bulk - 2 * shear / 3, 1e-9 * bulk);
    assert_near(d.tangent[7 * XY], shear, 1e-9 * shear);
    driver_destroy(&d);
  }
  material_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(both_moduli_of_soil_grow_with_its_pressure),
      cmocka_unit_test(rows_that_take_turns_remember_what_whole_copies_do),
      cmocka_unit_test(the_tangent_of_a_law_that_relaxes_is_that_of_its_step),
      cmocka_unit_test(laws_are_told_the_time_of_the_end_of_their_step),
      cmocka_unit_test(damage_of_mazars_never_heals),
      cmocka_unit_test(compression_of_mazars_mends_nothing),
      cmocka_unit_test(confined_concrete_follows_its_compressive_meridian),
      cmocka_unit_test(points_spread_the_fracture_energy_over_the_length_of_their_first_strain),
      cmocka_unit_test(dilation_that_is_not_given_is_what_the_manual_says),
      cmocka_unit_test(clay_that_was_loaded_elastically_starts_from_there),
      cmocka_unit_test(clay_that_was_loaded_elastically_forgets_what_came_before),
      cmocka_unit_test(clay_that_is_held_goes_on_as_if_it_had_not_been),
      cmocka_unit_test(clay_that_stands_still_is_as_stiff_as_in_its_last_step),
      cmocka_unit_test(a_point_that_gives_up_carries_nothing_and_keeps_its_history),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
