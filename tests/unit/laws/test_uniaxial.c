/* Laws of one strain. */
#include "point.h"

#include "base/random.h"
#include "points/points.h"

typedef struct Fibre {
  Material material;
  double committed[8], trial[8];
} Fibre;

static Fibre fibre(Material material)
{
  Fibre f = {.material = material};
  assert_true(material.history_values <= 8);
  return f;
}

static double stress_at(Fibre *f, double strain, double *tangent, int elastic)
{
  double stress;
  breccia_batch batch = {.size = sizeof(breccia_batch),
                         .count = 1,
                         .strain = {&strain},
                         .stress = {&stress},
                         .committed = f->committed,
                         .trial = f->trial,
                         .tangent = tangent,
                         .elastic_stage = elastic};
  assert_int_equal(f->material.law->update(f->material.constants, &batch), -1);
  return stress;
}

static double pull(Fibre *f, double strain)
{
  double stress = stress_at(f, strain, NULL, 0);
  memcpy(f->committed, f->trial, sizeof f->committed);
  return stress;
}

/* Concrete: f_t^2 / E = 400 N/m3 x ..., with a length of 30 mm: E in kPa, G_F in kN/m. */
#define CONCRETE "Young modulus=30e6", "fracture energy=0.1", "length=0.03"
#define STRONG CONCRETE, "tensile strength=3000"

static Material softening(int k)
{
  switch (k) {
  case 0: return material_of("bilinear-softening", STRONG, NULL);
  case 1: return material_of("exponential-softening", STRONG, NULL);
  case 2: return material_of("trilinear-softening", STRONG, NULL);
  default: return material_of("elastic-brittle", CONCRETE, NULL);
  }
}

static void pulling_apart_spends_the_fracture_energy_over_the_length(void **state)
{
  (void)state;
  for (int k = 0; k < 4; ++k) {
    Fibre f = fibre(softening(k));
    const double end = material_failure_strain(&f.material);
    const int steps = 400000;
    double work = 0, before = 0;
    for (int n = 1; n <= steps; ++n) {
      double stress = pull(&f, end * n / steps);
      work += (stress + before) / 2 * end / steps;
      before = stress;
    }
    assert_near(work, 0.1 / 0.03, 1e-5 * work);
    assert_near(pull(&f, end * 1.0001), 0, 0);
    assert_near(f.committed[0], 1, 0);
    material_destroy(&f.material);
  }
}

static void softening_curves_go_through_their_points(void **state)
{
  (void)state;
  const double peak = 3000 / 30e6;
  Fibre f = fibre(softening(0));
  double end = 2 * 0.1 / 0.03 / 3000; /* f_t end / 2 = G_F / length */
  assert_near(material_failure_strain(&f.material), end, 1e-12);
  assert_near(pull(&f, peak), 3000, 1e-9);
  assert_near(pull(&f, peak + (end - peak) / 4), 2250, 1e-9);
  material_destroy(&f.material);
  f = fibre(softening(1));
  end = material_failure_strain(&f.material);
  for (int n = 0; n < 20; ++n) {
    double x = (n + 0.5) / 20;
    double expected = 3000 * (1 - (1 - exp(-25 * x)) / (1 - exp(-25)) + 0.25 * (1 - x)) / 1.25;
    assert_near(pull(&f, peak + x * (end - peak)), expected, 1e-9);
  }
  material_destroy(&f.material);
  f = fibre(material_of("elastic-brittle", "Young modulus=30e6", "tensile strength=3000", NULL));
  assert_near(pull(&f, peak * (1 - 1e-12)), 3000, 1e-8);
  assert_near(pull(&f, peak * (1 + 1e-12)), 0, 0);
  assert_near(pull(&f, -peak), 0, 0); /* broken for good */
  material_destroy(&f.material);
}

static void softened_fibres_unload_to_the_origin_and_close_stiff(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Fibre f = fibre(softening(k));
    const double strain = 3e-4, stress = pull(&f, strain);
    assert_true(stress < 3000 && stress > 0);
    for (int n = 9; n >= 0; --n) assert_near(pull(&f, strain * n / 10), stress * n / 10, 1e-9 * stress);
    assert_near(pull(&f, -1e-4), -3000, 1e-9);
    assert_near(pull(&f, strain / 2), stress / 2, 1e-9 * stress);
    assert_near(pull(&f, strain), stress, 1e-9 * stress);
    Fibre fresh = fibre(f.material); /* the way there does not matter */
    assert_near(pull(&f, 2 * strain), pull(&fresh, 2 * strain), 1e-9 * stress);
    assert_near(stress_at(&fresh, 3 * strain, NULL, 1), 30e6 * 3 * strain, 1e-6); /* the elastic stage */
    material_destroy(&f.material);
  }
}

static void tangents_are_derivatives(void **state)
{
  (void)state;
  for (int k = 0; k < 4; ++k) {
    Fibre f = fibre(softening(k));
    const double ways[] = {-1e-4, 5e-5, 1.3e-4, 3e-4, 1e-4, 9e-4, 2e-3, 0.02};
    for (size_t n = 0; n < sizeof ways / sizeof *ways; ++n) {
      double tangent, ignored, h = 1e-9;
      double here = stress_at(&f, ways[n], &tangent, 0), there = stress_at(&f, ways[n] + h, &ignored, 0);
      assert_near(tangent, (there - here) / h, 1e-4 * 30e6);
      pull(&f, ways[n]);
    }
    material_destroy(&f.material);
  }
}

static void walks_of_chance_never_make_energy_or_leave_the_curve(void **state)
{
  (void)state;
  for (int k = 0; k < 4; ++k) {
    Fibre f = fibre(softening(k));
    const double strength = k < 3 ? 3000 : 30e6 * material_failure_strain(&f.material);
    uint64_t seed = 5;
    double strain = 0, stress = 0, work = 0, damage = 0;
    for (int n = 0; n < 200000; ++n) {
      double next = strain + pow(10, -9 + 6 * random_uniform(&seed)) * (random_uniform(&seed) - 0.5);
      double now = pull(&f, next);
      assert_true(isfinite(now) && now <= strength * (1 + 1e-12));
      assert_true(f.committed[0] >= damage && f.committed[0] <= 1);
      damage = f.committed[0];
      work += (stress + now) / 2 * (next - strain);
      strain = next;
      stress = now;
    }
    assert_true(work - stress * strain / 2 >= -1e-3 * strength * material_failure_strain(&f.material));
    material_destroy(&f.material);
  }
}

static void curves_that_would_snap_back_are_refused(void **state)
{
  (void)state;
  const double values[] = {30e6, 3000, 0.1, 0.7}, neither[] = {30e6, NAN, NAN, 0.03},
               nowhere[] = {30e6, 3000, 0.1, NAN};
  char reason[512];
  Material m;
  assert_int_equal(material_prepare(&m, law_find(NULL, "bilinear-softening"), values, reason, sizeof reason),
                   BRECCIA_USER_ERROR);
  assert_non_null(strstr(reason, "it must be less than 2 E G_F / f_t^2 = 0.666667"));
  assert_int_equal(material_prepare(&m, law_find(NULL, "bilinear-softening"), nowhere, reason, sizeof reason),
                   BRECCIA_USER_ERROR);
  assert_non_null(strstr(reason, "needs the 'length'"));
  assert_int_equal(material_prepare(&m, law_find(NULL, "elastic-brittle"), neither, reason, sizeof reason),
                   BRECCIA_USER_ERROR);
  assert_non_null(strstr(reason, "give either 'tensile strength' or 'fracture energy'"));
}

/* ---- laws of concrete and steel ---- */

static Material any(int k)
{
  switch (k) {
  case 0: return material_of("kent-scott-park", "compressive strength=30e3", "residual strength=6e3", NULL);
  case 1: return material_of("concrete02", "compressive strength=30e3", "residual strength=6e3", NULL);
  case 2:
    return material_of("mander", "compressive strength=30e3", "Young modulus=27e6", "confining pressure=2e3", NULL);
  case 3: return material_of("elastic-perfectly-plastic", "Young modulus=2e8", "yield stress=4e5", NULL);
  case 4: return material_of("steel-bilinear", "Young modulus=2e8", "yield stress=4e5", NULL);
  case 5:
    return material_of("steel-bilinear", "Young modulus=2e8", "yield stress=4e5", "compression shift=0.1",
                       "tension shift=0.2", NULL);
  case 6: return material_of("menegotto-pinto", "Young modulus=2e8", "yield stress=4e5", NULL);
  case 7:
    return material_of("menegotto-pinto", "Young modulus=2e8", "yield stress=4e5", "smallest strain=-0.02",
                       "largest strain=0.01", NULL);
  case 12: return material_of("fib-concrete", STRONG, "compressive strength=30e3", NULL);
  default: return softening(k - 8);
  }
}
enum { LAWS = 13 };

static void every_law_that_remembers_is_among_these(void **state)
{
  (void)state;
  for (int k = 0; breccia_law_at(k); ++k) {
    bool known = breccia_law_at(k)->components != 1 || breccia_law_at(k)->linear;
    for (int n = 0; n < LAWS && !known; ++n) {
      Material m = any(n);
      known = m.law == breccia_law_at(k);
      material_destroy(&m);
    }
    if (!known) fail_msg("law '%s' is not in the list of this file, so that nobody tests it", breccia_law_at(k)->name);
  }
}

/** Laws that say so carry E strain however far they are pressed; those that do not carry far less than that, or
 * nothing. */
static void what_never_crushes_says_so(void **state)
{
  (void)state;
  int never = 0;
  for (int k = 0; k < LAWS; ++k) {
    Material m = any(k);
    Point p = point_start(&m);
    double stress = 0;
    for (int n = 1; n <= 500; ++n) {
      point_try(&p, (const double[]){-1e-4 * n}, &stress, NULL, 0);
      point_commit(&p);
    }
    const bool elastic = fabs(stress / (material_young(&m) * -0.05) - 1) < 1e-9,
               says = m.law->never_crushes && m.law->never_crushes(m.constants);
    if (says != elastic) fail_msg("'%s' carries %g at -0.05", m.law_name, stress);
    never += says;
    point_stop(&p);
    material_destroy(&m);
  }
  assert_int_equal(never, 4);
  /* a smallest strain ends it; links are crushed beyond a compressive stretch */
  const struct {
    Material m;
    bool never;
  } others[] = {
      {material_of("elastic-1d", "Young modulus=30e6", NULL), true},
      {material_of("elastic-1d", "Young modulus=30e6", "largest strain=1e-3", NULL), true},
      {material_of("elastic-1d", "Young modulus=30e6", "smallest strain=-1e-3", NULL), false},
      {material_of("link-damage", "Young modulus=30e6", "Poisson ratio=0.2", "tensile stretch=1e-4", NULL), true},
      {material_of("link-damage", "Young modulus=30e6", "Poisson ratio=0.2", "tensile stretch=1e-4",
                   "compressive stretch=1e-3", NULL),
       false}};
  for (size_t k = 0; k < sizeof others / sizeof *others; ++k) {
    Material m = others[k].m;
    assert_int_equal(m.law->never_crushes(m.constants) != 0, others[k].never);
    material_destroy(&m);
  }
}

/** Whatever the strain and however many points: E strain, and nothing is remembered but where the point was. */
static void the_elastic_stage_is_elastic(void **state)
{
  (void)state;
  enum { MOST = 9 };
  const double young[LAWS] = {3e7, 3e7, 27e6, 2e8, 2e8, 2e8, 2e8, 2e8, 30e6, 30e6, 30e6, 30e6, 30e6};
  for (int k = 0; k < LAWS; ++k) {
    Material m = any(k);
    assert_near(material_young(&m), young[k], 1e-12 * young[k]);
    const int values = m.history_values;
    const bool remembers = k < 8 && k != 3; /* its last strain and stress */
    for (int count = 1; count <= MOST; ++count) {
      double strain[MOST], stress[MOST], tangent[MOST], *committed = calloc((size_t)(values * count), sizeof(double)),
                                                        *trial = calloc((size_t)(values * count), sizeof(double));
      for (int i = 0; i < count; ++i) {
        strain[i] = 0.02 * (i % 2 ? -1 : 1) * (1 + i);
        if (m.law->begin) m.law->begin(m.constants, committed + values * i);
        for (int v = 0; v < values; ++v) trial[values * i + v] = 77;
        if (m.law->begin) memcpy(trial + values * i, committed + values * i, sizeof(double) * (size_t)values);
      }
      const breccia_batch batch = {.size = sizeof batch,
                                   .count = count,
                                   .strain = {strain},
                                   .stress = {stress},
                                   .committed = committed,
                                   .trial = trial,
                                   .tangent = tangent,
                                   .elastic_stage = 1};
      assert_int_equal(m.law->update(m.constants, &batch), -1);
      for (int i = 0; i < count; ++i) {
        if (!(fabs(stress[i] - young[k] * strain[i]) <= 1e-12 * young[k]) ||
            !(fabs(tangent[i] - young[k]) <= 1e-12 * young[k]))
          fail_msg("%s: %g at a strain of %g, tangent %g", m.law->name, stress[i], strain[i], tangent[i]);
        for (int v = remembers ? 2 : 0; v < values; ++v)
          assert_near(trial[values * i + v], committed[values * i + v], 0);
        if (!remembers) continue;
        assert_near(trial[values * i], strain[i], 0);
        assert_near(trial[values * i + 1], stress[i], 0);
      }
      free(committed);
      free(trial);
    }
    material_destroy(&m);
  }
}

/** What is told of a law: what its histories are called, and the strain at which nothing is left. */
static void laws_tell_what_they_remember_and_when_they_fail(void **state)
{
  (void)state;
  const double length = 0.03, peak = 1e-4, energy = 0.1 / length / 3000; /* of a softening law: G_F / l f_t */
  /* Areas below the curves beyond the peak; of the exponential one by its parameters k = 25, alpha = 0.25. */
  const double area = (0.25 / 2 + 1 + 1 / expm1(-25) + 1. / 25) / 1.25;
  const struct {
    const char *names; /* with their places */
    double failure;
  } wanted[LAWS] = {
      {"2 largest compressive strain;", INFINITY},
      {"2 largest compressive strain;3 largest tensile strain;", INFINITY},
      {"2 largest compressive strain;", INFINITY},
      {"0 plastic strain;", INFINITY},
      {"2 least strain;3 largest strain;", INFINITY},
      {"2 least strain;3 largest strain;", INFINITY},
      {"2 least strain;3 largest strain;", INFINITY},
      {"2 least strain;3 largest strain;10 failed;", 0.01},
      {"0 bond damage;", peak + (energy - peak / 2) / 0.5},
      {"0 bond damage;", peak + (energy - peak / 2) / area},
      {"0 bond damage;", NAN}, /* test below */
      {"0 bond damage;", sqrt(2 * 0.1 / (30e6 * length))},
      {"0 bond damage;1 crushing strain;2 confining pressure;", peak + (energy - peak / 2) / area + 0.0022 / 2},
  };
  for (int k = 0; k < LAWS; ++k) {
    Material m = any(k);
    Text names = {0};
    for (int v = 0; v < m.history_values; ++v) {
      char name[64] = "?";
      m.law->history_name(m.constants, v, name, sizeof name);
      if (*name) text_add(&names, "%d %s;", v, name);
    }
    assert_string_equal(text_words(&names), wanted[k].names);
    if (isinf(wanted[k].failure))
      assert_true(isinf(material_failure_strain(&m)));
    else if (!isnan(wanted[k].failure))
      assert_near(material_failure_strain(&m), wanted[k].failure, 1e-12);
    text_free(&names);
    material_destroy(&m);
  }
}

static void a_million_steps_of_any_size_stay_finite(void **state)
{
  (void)state;
#ifdef __SANITIZE_ADDRESS__
  enum { WALK = 100000 };
#else
  enum { WALK = 1000000 };
#endif
  for (int k = 0; k < LAWS; ++k) {
    Material m = any(k);
    Point p = point_start(&m);
    uint64_t seed = 13;
    double strain = 0, stress, tangent;
    for (int n = 0; n < WALK; ++n) {
      strain += pow(10, -12 * random_uniform(&seed)) * 2 * (random_uniform(&seed) - 0.5);
      if (fabs(strain) > 2) strain *= 0.1;
      if (n % 500 == 499) strain *= 1e-3;
      point_try(&p, &strain, &stress, &tangent, 0);
      if (!isfinite(stress) || !isfinite(tangent)) fail_msg("%s: %g, %g in step %d", m.law->name, stress, tangent, n);
      if (k < 3 && stress < -50e3) fail_msg("%s: %g kPa in step %d", m.law->name, stress, n);
      if (k == 3 && fabs(stress) > 4e5) fail_msg("%s: %g kPa in step %d", m.law->name, stress, n);
      point_commit(&p);
    }
    point_stop(&p);
    material_destroy(&m);
  }
}

static void tangents_of_all_laws_are_derivatives(void **state)
{
  (void)state;
  for (int k = 0; k < LAWS; ++k) {
    Material m = any(k);
    Point p = point_start(&m);
    uint64_t seed = 19;
    double strain = 0, young = material_young(&m);
    int smooth = 0;
    for (int n = 0; n < 3000; ++n) {
      strain += 1e-3 * (random_uniform(&seed) - 0.52);
      if (fabs(strain) > 6e-3) strain *= 0.5;
      const double h = 1e-8;
      double stress, tangent, at[2], ignored;
      for (int side = 0; side < 2; ++side) {
        const double aside = strain + (side ? h : -h);
        point_try(&p, &aside, &at[side], &ignored, 0);
      }
      point_try(&p, &strain, &stress, &tangent, 0);
      const double left = (stress - at[0]) / h, right = (at[1] - stress) / h;
      if (fabs(left - right) < 1e-4 * young) {
        ++smooth;
        if (!(fabs((left + right) / 2 - tangent) <= 2e-6 * young))
          fail_msg("%s: tangent %g, derivative %g at strain %g", m.law->name, tangent, (left + right) / 2, strain);
      }
      point_commit(&p);
    }
    assert_true(smooth > 2900);
    point_stop(&p);
    material_destroy(&m);
  }
}

static void a_trial_can_be_repeated(void **state)
{
  (void)state;
  for (int k = 0; k < LAWS; ++k) {
    Material m = any(k);
    Point tried = point_start(&m), plain = point_start(&m);
    uint64_t seed = 7;
    double strain = 0, a, b, before[16];
    for (int n = 0; n < 1000; ++n) {
      strain += 2e-3 * (random_uniform(&seed) - 0.5);
      memcpy(before, tried.committed, sizeof(double) * (size_t)m.history_values);
      for (int wild = 0; wild < 3; ++wild) {
        const double other = strain + 1e-2 * (random_uniform(&seed) - 0.5);
        point_try(&tried, &other, &a, NULL, wild == 1);
      }
      assert_memory_equal(before, tried.committed, sizeof(double) * (size_t)m.history_values);
      point_try(&tried, &strain, &a, NULL, 0);
      point_try(&plain, &strain, &b, NULL, 0);
      assert_memory_equal(&a, &b, sizeof a);
      point_commit(&tried);
      point_commit(&plain);
    }
    point_stop(&tried);
    point_stop(&plain);
    material_destroy(&m);
  }
}

static void confined_concrete_follows_manders_curve(void **state)
{
  (void)state;
  /* f_l / f_co = 1/15: f_cc = f_co (2.254 sqrt(1 + 7.94 / 15) - 2 / 15 - 1.254), e_cc = 0.002 (1 + 5 (f_cc / f_co - 1)). */
  Material m = any(2);
  Point p = point_start(&m);
  const double gain = 2.254 * sqrt(1 + 7.94 / 15) - 2.0 / 15 - 1.254, peak = 0.002 * (1 + 5 * (gain - 1)),
               r = 27e6 / (27e6 - gain * 30e3 / peak);
  for (int k = 1; k <= 40; ++k) {
    const double x = k / 10.0, strain = -x * peak, expected = k < 40 ? -gain * 30e3 * x * r / (r - 1 + pow(x, r)) : 0;
    double stress;
    point_try(&p, &strain, &stress, NULL, 0);
    if (k < 40) assert_near(stress, expected, 1e-9 * 30e3);
    point_commit(&p);
  }
  const double beyond = -4.001 * peak;
  double stress;
  point_try(&p, &beyond, &stress, NULL, 0);
  assert_near(stress, 0, 0);
  point_stop(&p);
  material_destroy(&m);
}

static void concrete_unloads_to_karsan_and_jirsas_strain(void **state)
{
  (void)state;
  /* From strain 0.003 (1.5 times the peak's): 0.002 (0.145 1.5^2 + 0.13 1.5). */
  Material m = any(0);
  Point p = point_start(&m);
  const double end = -0.002 * (0.145 * 2.25 + 0.13 * 1.5), top = -0.003;
  double stress, first, half = (top + end) / 2;
  point_try(&p, &top, &first, NULL, 0);
  point_commit(&p);
  assert_near(first, -(30e3 - 24e3 * 0.25), 1e-8);
  point_try(&p, &half, &stress, NULL, 0);
  point_commit(&p);
  assert_near(stress, first / 2, 1e-8 * 30e3);
  point_try(&p, &end, &stress, NULL, 0);
  assert_near(stress, 0, 1e-8 * 30e3);
  point_stop(&p);
  material_destroy(&m);
}

static void trilinear_softening_goes_through_its_kink(void **state)
{
  (void)state;
  /* Petersson: a third of f_t at the opening 0.8 G_F / f_t, nothing at 3.6 G_F / f_t, if the elastic strain is small. */
  Material m = material_of("trilinear-softening", "Young modulus=30e9", "fracture energy=0.1", "length=0.03",
                           "tensile strength=3000", NULL);
  Point p = point_start(&m);
  const double kink = 0.8 * 0.1 / 3000 / 0.03;
  double stress;
  point_try(&p, &kink, &stress, NULL, 0);
  assert_near(stress, 1000, 2);
  assert_near(material_failure_strain(&m), 3.6 * 0.1 / 3000 / 0.03, 1e-5);
  point_stop(&p);
  material_destroy(&m);
}

static void inadmissible_concrete_is_refused(void **state)
{
  (void)state;
  const struct {
    const char *law, *words, *reason;
  } cases[] = {
      {"kent-scott-park", "compressive strength=30,residual strength=31",
       "must not be larger than 'compressive strength'"},
      {"kent-scott-park", "compressive strength=30,crushing strain=0.001", "must be larger than 'peak strain'"},
      {"mander", "compressive strength=30,Young modulus=14000", "must be larger than strength over strain"},
      {"mander", "compressive strength=30,Young modulus=30000,crushing strain=0.001", "confined peak strain"},
      {"trilinear-softening",
       "Young modulus=30e6,tensile strength=3000,fracture energy=0.1,length=0.03,kink stress=0.9",
       "below the straight line"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char reason[512] = "";
    assert_int_equal(material_refusal(cases[k].law, cases[k].words, reason, sizeof reason), BRECCIA_USER_ERROR);
    if (!strstr(reason, cases[k].reason)) fail_msg("%s: says '%s'", cases[k].law, reason);
  }
}

static void steel_fails_for_good_outside_its_range_of_strains(void **state)
{
  (void)state;
  Material limited = any(7), plain = any(6);
  const double paths[][7] = {{0.002, 0.009, -0.01, 0.0099, 0.0101, 0.005, -0.001},
                             {0.002, -0.009, 0.0099, -0.0199, -0.0201, -0.005, 0.001}};
  assert_near(material_failure_strain(&limited), 0.01, 0);
  assert_near(material_young(&limited), material_young(&plain), 0);
  for (int n = 0; n < 2; ++n) {
    Point a = point_start(&limited), b = point_start(&plain);
    for (int k = 0; k < 7; ++k) {
      double s, t;
      point_try(&a, &paths[n][k], &s, NULL, 0);
      point_try(&b, &paths[n][k], &t, NULL, 0);
      assert_near(s, k < 4 ? t : 0, 0);
      point_commit(&a);
      point_commit(&b);
    }
    point_stop(&a);
    point_stop(&b);
  }
  material_destroy(&limited);
  material_destroy(&plain);
  char reason[512];
  assert_int_equal(material_refusal("elastic-1d", "Young modulus=1,largest strain=-1", reason, sizeof reason), 2);
  assert_non_null(strstr(reason, "must be a number above 0"));
}

/* ---- rows of points ---- */

enum { ROWS = 300, TAKEN = 12 }; /* rows are taken by so many, so that groups of them overlap */

/** Updates all rows and compares each with its fibre, to the bit. */
static void update_and_compare(Points *points, Fibre *fibres, const double *strains, bool commit)
{
  double strain[TAKEN], stress[TAKEN], *at[6] = {strain}, *to[6] = {stress};
  for (int64_t n = 0; n < points->run_count; ++n) {
    const PointsRun *run = &points->runs[n];
    for (int64_t first = run->first; first < run->first + run->count; first += TAKEN) {
      const int64_t left = run->first + run->count - first;
      const int count = left < TAKEN ? (int)left : TAKEN;
      memcpy(strain, strains + first, sizeof *strain * (size_t)count);
      assert_int_equal(points_update(points, first, count, at, to), -1);
      for (int i = 0; i < count; ++i)
        assert_true(stress[i] == stress_at(&fibres[first + i], strains[first + i], NULL, 0));
    }
  }
  if (!commit) return;
  points_commit(points);
  for (int i = 0; i < ROWS; ++i) {
    Fibre *f = &fibres[i];
    memcpy(f->committed, f->trial, sizeof f->committed);
    assert_memory_equal(points_history(points, i), f->committed, sizeof(double) * (size_t)f->material.history_values);
  }
}

/* Few points are strained so far that their law remembers it, at some time; others are never; steps are tried and given up; and the state is
 * taken up once by new points. Histories that begin as zeros, and ones that do not. */
static void rows_of_points_remember_what_their_laws_do(void **state)
{
  (void)state;
  Material materials[2] = {softening(0), material_of("elastic-perfectly-plastic", "Young modulus=2e8",
                                                     "yield stress=4e5", "initial strain=1e-4", NULL)};
  const PointsRun runs[2] = {{0, 0, ROWS / 2}, {1, ROWS / 2, ROWS / 2}};
  const PointsSpec spec = {
      .components = 1, .runs = runs, .run_count = 2, .materials = materials, .material_count = 2, .length = NAN};
  Points points;
  assert_int_equal(points_create(&points, &spec, NULL), 0);
  Fibre fibres[ROWS];
  for (int i = 0; i < ROWS; ++i) {
    fibres[i] = fibre(materials[2 * i / ROWS]);
    memcpy(fibres[i].committed, points_history(&points, i), sizeof(double) * (size_t)fibres[i].material.history_values);
  }
  const double range[2] = {1e-3, 1e-2}; /* strength at 1e-4, yield at 2e-3 */
  double strains[ROWS];
  uint64_t random = 7;
  for (int step = 0; step < 40; ++step) {
    for (int i = 0; i < ROWS; ++i) {
      const bool far = i % 37 == step / 2; /* one row or none of what is taken at once */
      strains[i] = (far ? 1 : 0.05) * range[2 * i / ROWS] * (2 * random_uniform(&random) - 1);
    }
    update_and_compare(&points, fibres, strains, step % 3 != 1);
    if (step != 30) continue;
    points_destroy(&points); /* a restart */
    assert_int_equal(points_create(&points, &spec, NULL), 0);
    double *rows = points.committed;
    for (int i = 0; i < ROWS; ++i) {
      memcpy(rows, fibres[i].committed, sizeof(double) * (size_t)fibres[i].material.history_values);
      rows += fibres[i].material.history_values;
    }
    points_take_up(&points);
  }
  points_destroy(&points);
  for (int k = 0; k < 2; ++k) material_destroy(&materials[k]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_law_that_remembers_is_among_these),
      cmocka_unit_test(what_never_crushes_says_so),
      cmocka_unit_test(pulling_apart_spends_the_fracture_energy_over_the_length),
      cmocka_unit_test(softening_curves_go_through_their_points),
      cmocka_unit_test(softened_fibres_unload_to_the_origin_and_close_stiff),
      cmocka_unit_test(tangents_are_derivatives),
      cmocka_unit_test(walks_of_chance_never_make_energy_or_leave_the_curve),
      cmocka_unit_test(curves_that_would_snap_back_are_refused),
      cmocka_unit_test(the_elastic_stage_is_elastic),
      cmocka_unit_test(laws_tell_what_they_remember_and_when_they_fail),
      cmocka_unit_test(a_million_steps_of_any_size_stay_finite),
      cmocka_unit_test(tangents_of_all_laws_are_derivatives),
      cmocka_unit_test(a_trial_can_be_repeated),
      cmocka_unit_test(confined_concrete_follows_manders_curve),
      cmocka_unit_test(concrete_unloads_to_karsan_and_jirsas_strain),
      cmocka_unit_test(trilinear_softening_goes_through_its_kink),
      cmocka_unit_test(inadmissible_concrete_is_refused),
      cmocka_unit_test(steel_fails_for_good_outside_its_range_of_strains),
      cmocka_unit_test(rows_of_points_remember_what_their_laws_do),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
