/* What holds for every law of a point in space, whatever it is: properties, not paths. */
#include "sample_laws.h"

#include "base/random.h"
#include "base/tensor.h"
#include "results/fields.h"

static void steps_of_any_size_stay_finite_and_inside(void **state)
{
  (void)state;
  const int steps = under_sanitizers() ? 10000 : whole_walks() ? 1000000 : 200000;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    Point p = point_start(&m);
    uint64_t seed = 23;
    double strain[6] = {0};
    for (int step = 0; step < steps; ++step) {
      double s[6];
      /* Steps from 1e-12 to 1 in turn with such as a laboratory makes, and a fresh point now and then. */
      const double size = step / 1000 % 2 ? 3 * samples[n].strain : 1;
      sample_wander(&seed, size, size * pow(10, -12 * random_uniform(&seed)), strain);
      if (step % 50 == 49)
        for (int k = 0; k < 6; ++k) strain[k] *= 1e-3;
      if (step % 100 == 99) {
        point_stop(&p);
        p = point_start(&m);
      }
      if (!point_may_try(&p, strain, s, NULL, 0)) fail_msg("%s gave up in step %d", samples[n].name, step);
      for (int k = 0; k < 6; ++k)
        if (!isfinite(s[k])) fail_msg("%s: stress %g in step %d", samples[n].name, s[k], step);
      const double over = samples[n].over ? samples[n].over(&p, s) : 0;
      /* Stresses are differences of elastic ones, which carry rounding of their own size. */
      double most = 0;
      for (int k = 0; k < 6; ++k) most = larger_of(most, fabs(strain[k]));
      if (over > 1e-8 + 1e-13 * sample_stiffness(&m) * most / 10)
        fail_msg("%s: stress outside by %.2e of its strength in step %d", samples[n].name, over, step);
      point_commit(&p);
    }
    point_stop(&p);
    material_destroy(&m);
  }
}

static void turned(const double q[9], const double a[6], double shear, double b[6])
{
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], c = symmetric_column[k];
    b[k] = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        b[k] += q[3 * r + i] * a[symmetric_place[3 * i + j]] * (i == j ? 1 : shear) * q[3 * c + j];
    b[k] /= r == c ? 1 : shear;
  }
}

static void stress_turns_with_the_strain(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    Point a = point_start(&m), b = point_start(&m);
    uint64_t seed = 3;
    double some[6], value[3], q[9], strain[6] = {0}, turned_strain[6], s[6], t[6], expected[6], largest = 1;
    for (int k = 0; k < 6; ++k) some[k] = random_uniform(&seed);
    tensor_eigen(some, value, q); /* an orthonormal basis */
    for (int step = 0; step < (under_sanitizers() ? 500 : 2000); ++step) {
      sample_wander(&seed, samples[n].strain, samples[n].strain / 20, strain);
      turned(q, strain, 0.5, turned_strain);
      point_try(&a, strain, s, NULL, 0);
      point_try(&b, turned_strain, t, NULL, 0);
      turned(q, s, 1, expected);
      for (int k = 0; k < 6; ++k) largest = larger_of(largest, fabs(s[k]));
      for (int k = 0; k < 6; ++k)
        if (!(fabs(t[k] - expected[k]) <= 1e-8 * largest))
          fail_msg("%s: turned stress off by %.2e of %.2e in step %d", samples[n].name, fabs(t[k] - expected[k]),
                   largest, step);
      point_commit(&a);
      point_commit(&b);
    }
    point_stop(&a);
    point_stop(&b);
    material_destroy(&m);
  }
}

static void a_trial_can_be_repeated_and_leaves_the_committed_state_alone(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    Point tried = point_start(&m), plain = point_start(&m);
    uint64_t seed = 7;
    double strain[6] = {0}, a[6], b[6];
    const size_t bytes = sizeof(double) * (size_t)m.history_values;
    double *before = malloc(bytes + 1);
    for (int step = 0; step < 400; ++step) {
      sample_wander(&seed, samples[n].strain, samples[n].strain / 10, strain);
      memcpy(before, tried.committed, bytes);
      for (int wild = 0; wild < 3; ++wild) {
        double other[6];
        memcpy(other, strain, sizeof other);
        sample_wander(&seed, 1, samples[n].strain, other);
        point_try(&tried, other, a, NULL, wild == 1);
      }
      assert_memory_equal(before, tried.committed, bytes);
      point_try(&tried, strain, a, NULL, 0);
      point_try(&plain, strain, b, NULL, 0);
      assert_memory_equal(a, b, sizeof a);
      point_commit(&tried);
      point_commit(&plain);
    }
    free(before);
    point_stop(&tried);
    point_stop(&plain);
    material_destroy(&m);
  }
}

static void stress_and_history_do_not_hang_on_the_tangent(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    Point with = point_start(&m), without = point_start(&m);
    uint64_t seed = 37;
    double strain[6] = {0}, a[6], b[6], tangent[36], largest = 0;
    for (int step = 0; step < 3000; ++step) {
      sample_wander(&seed, samples[n].strain, samples[n].strain * pow(10, -2 * random_uniform(&seed)), strain);
      point_try(&with, strain, a, tangent, 0);
      memcpy(without.committed, with.committed, sizeof(double) * (size_t)m.history_values);
      point_try(&without, strain, b, NULL, 0);
      for (int k = 0; k < 6; ++k) {
        largest = larger_of(largest, fabs(a[k]));
        if (!(fabs(a[k] - b[k]) <= 1e-10 * largest))
          fail_msg("%s: stress %.17g with and %.17g without the tangent in step %d", samples[n].name, a[k], b[k], step);
      }
      for (int k = 0; k < m.history_values; ++k)
        assert_near(without.trial[k], with.trial[k], 1e-10 * fabs(with.trial[k]) + 1e-14);
      point_commit(&with);
    }
    point_stop(&with);
    point_stop(&without);
    material_destroy(&m);
  }
}

static void points_of_a_batch_do_not_know_of_each_other(void **state)
{
  (void)state;
  enum { POINTS = 37, STEPS = 40 };
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    const size_t values = (size_t)m.history_values;
    static double strain[6][POINTS], stress[6][POINTS];
    static double tangent[POINTS][36];
    double *committed = calloc(values * POINTS + 1, sizeof(double)),
           *trial = calloc(values * POINTS + 1, sizeof(double));
    Point alone[POINTS];
    uint64_t seed = 29;
    memset(strain, 0, sizeof strain);
    for (int i = 0; i < POINTS; ++i) {
      alone[i] = point_start(&m);
      memcpy(committed + values * (size_t)i, alone[i].committed, sizeof(double) * values);
      memcpy(trial + values * (size_t)i, alone[i].committed, sizeof(double) * values);
    }
    for (int step = 0; step < STEPS; ++step) {
      breccia_batch batch = {.size = sizeof(breccia_batch), .count = POINTS, .committed = committed, .trial = trial};
      if (step % 2) batch.tangent = tangent[0];
      for (int i = 0; i < POINTS; ++i) {
        double e[6];
        for (int k = 0; k < 6; ++k) e[k] = strain[k][i];
        sample_wander(&seed, samples[n].strain, samples[n].strain / 5, e);
        for (int k = 0; k < 6; ++k) strain[k][i] = e[k];
      }
      for (int k = 0; k < 6; ++k) {
        batch.strain[k] = strain[k];
        batch.stress[k] = stress[k];
      }
      assert_int_equal(m.law->update(m.constants, &batch), -1);
      for (int i = 0; i < POINTS; ++i) {
        double e[6], s[6], own[36];
        for (int k = 0; k < 6; ++k) e[k] = strain[k][i];
        point_try(&alone[i], e, s, batch.tangent ? own : NULL, 0);
        if (values) assert_memory_equal(alone[i].trial, trial + values * (size_t)i, sizeof(double) * values);
        for (int k = 0; k < 36 && batch.tangent; ++k)
          if (tangent[i][k] != own[k])
            fail_msg("%s: point %d has tangent %.17g in company and %.17g alone in step %d", samples[n].name, i,
                     tangent[i][k], own[k], step);
        for (int k = 0; k < 6; ++k)
          if (stress[k][i] != s[k])
            fail_msg("%s: point %d has stress %.17g in company and %.17g alone in step %d", samples[n].name, i,
                     stress[k][i], s[k], step);
        point_commit(&alone[i]);
      }
      double *other = committed;
      committed = trial;
      trial = other;
    }
    for (int i = 0; i < POINTS; ++i) point_stop(&alone[i]);
    free(committed);
    free(trial);
    material_destroy(&m);
  }
}

enum { CROWD = 37 };

typedef struct Crowd { /* points of a law that are handed to it together */
  Material m;
  double *committed, *trial, stress[6][CROWD], tangent[CROWD * 36];
} Crowd;

static Crowd crowd_of(const Sample *sample, double scale)
{
  scale_stresses(scale);
  Crowd c = {.m = sample->make()};
  scale_stresses(1);
  c.committed = calloc((size_t)c.m.history_values * CROWD + 1, sizeof(double));
  c.trial = calloc((size_t)c.m.history_values * CROWD + 1, sizeof(double));
  for (int i = 0; i < CROWD && c.m.law->begin; ++i) {
    c.m.law->begin(c.m.constants, c.committed + c.m.history_values * i);
    c.m.law->begin(c.m.constants, c.trial + c.m.history_values * i);
  }
  return c;
}

static void crowd_step(Crowd *c, double strain[6][CROWD])
{
  breccia_batch batch = {
      .size = sizeof batch, .count = CROWD, .committed = c->committed, .trial = c->trial, .tangent = c->tangent};
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = strain[k];
    batch.stress[k] = c->stress[k];
  }
  assert_int_equal(c->m.law->update(c->m.constants, &batch), -1);
  double *other = c->committed;
  c->committed = c->trial;
  c->trial = other;
}

static void crowd_leave(Crowd *c)
{
  free(c->committed);
  free(c->trial);
  material_destroy(&c->m);
}

/** A law of stresses that are all so many times as large answers with such stresses, whether they are counted in Pa or in GPa: to the bit where
 *  the factor is a power of 2. */
static void laws_know_no_unit_of_stress(void **state)
{
  (void)state;
  const double scales[] = {0x1p-40, 0x1p20};
  for (int n = 0; n < 2 * SAMPLES; ++n) {
    const Sample *sample = &samples[n / 2];
    const double scale = scales[n % 2];
    static Crowd a, b;
    a = crowd_of(sample, 1);
    b = crowd_of(sample, scale);
    uint64_t seed = 31;
    double strain[6][CROWD] = {{0}};
    for (int step = 0; step < 60; ++step) {
      for (int i = 0; i < CROWD; ++i) {
        double e[6];
        for (int k = 0; k < 6; ++k) e[k] = strain[k][i];
        sample_wander(&seed, sample->strain, sample->strain / 5, e);
        for (int k = 0; k < 6; ++k) strain[k][i] = e[k];
      }
      crowd_step(&a, strain);
      crowd_step(&b, strain);
      for (int i = 0; i < CROWD; ++i) {
        for (int k = 0; k < 6; ++k)
          if (b.stress[k][i] != scale * a.stress[k][i])
            fail_msg("%s: stress %g, and %g of %g times as large ones in step %d", sample->name, a.stress[k][i],
                     b.stress[k][i], scale, step);
        for (int k = 0; k < 36; ++k)
          if (b.tangent[36 * i + k] != scale * a.tangent[36 * i + k])
            fail_msg("%s: tangent %g, and %g of %g times as large stresses in step %d", sample->name,
                     a.tangent[36 * i + k], b.tangent[36 * i + k], scale, step);
      }
    }
    for (int k = 0; k < a.m.history_values && a.m.law->history_name; ++k) { /* what people read goes with its unit */
      const double factor = strcmp(history_field_dimension(&a.m, k), "stress") ? 1 : scale;
      char name[64] = "";
      a.m.law->history_name(a.m.constants, k, name, sizeof name);
      for (int i = 0; *name && i < CROWD; ++i) {
        const double value = a.committed[a.m.history_values * i + k], other = b.committed[b.m.history_values * i + k];
        if (other != factor * value)
          fail_msg("%s: %s %g, and %g of %g times as large stresses", sample->name, name, value, other, scale);
      }
    }
    crowd_leave(&a);
    crowd_leave(&b);
  }
}

static void closed_cycles_of_strain_take_work(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    if (!samples[n].associated) continue;
    Material m = samples[n].make();
    uint64_t seed = 31;
    for (int cycle = 0; cycle < 20; ++cycle) {
      enum { CORNERS = 6, PARTS = 400 };
      Point p = point_start(&m);
      double corner[CORNERS + 1][6] = {{0}}, s[6] = {0}, before[6] = {0}, strain[6] = {0}, work = 0, flow = 0;
      for (int c = 1; c < CORNERS; ++c) sample_wander(&seed, samples[n].strain, samples[n].strain, corner[c]);
      for (int c = 0; c < CORNERS; ++c)
        for (int part = 1; part <= PARTS; ++part) {
          double next[6];
          for (int k = 0; k < 6; ++k) next[k] = corner[c][k] + (corner[c + 1][k] - corner[c][k]) * part / PARTS;
          point_try(&p, next, s, NULL, 0);
          for (int k = 0; k < 6; ++k) {
            const double done = (s[k] + before[k]) / 2 * (next[k] - strain[k]);
            work += done;
            flow += fabs(done);
          }
          memcpy(before, s, sizeof s);
          memcpy(strain, next, sizeof strain);
          point_commit(&p);
        }
      if (work < -1e-3 * flow) fail_msg("%s: cycle %d makes %.3e of %.3e", samples[n].name, cycle, -work, flow);
      point_stop(&p);
    }
    material_destroy(&m);
  }
}

static void smaller_steps_change_little(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    uint64_t seed = 41;
    for (int path = 0; path < 10; ++path) {
      enum { CORNERS = 4, MOST = 1600 };
      const int parts[3] = {100, 400, MOST};
      double corner[CORNERS + 1][6] = {{0}}, end[3][6], largest = 0;
      for (int c = 1; c <= CORNERS; ++c) {
        memcpy(corner[c], corner[c - 1], sizeof corner[c]);
        sample_wander(&seed, samples[n].strain, samples[n].strain / 2, corner[c]);
      }
      for (int way = 0; way < 3; ++way) {
        Point p = point_start(&m);
        for (int c = 0; c < CORNERS; ++c)
          for (int part = 1; part <= parts[way]; ++part) {
            double strain[6];
            for (int k = 0; k < 6; ++k)
              strain[k] = corner[c][k] + (corner[c + 1][k] - corner[c][k]) * part / parts[way];
            point_try(&p, strain, end[way], NULL, 0);
            for (int k = 0; k < 6; ++k) largest = larger_of(largest, fabs(end[way][k]));
            point_commit(&p);
          }
        point_stop(&p);
      }
      double coarse = 0, fine = 0;
      for (int k = 0; k < 6; ++k) {
        coarse = larger_of(coarse, fabs(end[0][k] - end[2][k]));
        fine = larger_of(fine, fabs(end[1][k] - end[2][k]));
      }
      if (fine > 0.01 * largest || fine > 0.6 * coarse + 1e-6 * largest)
        fail_msg("%s: 100, 400 and 1600 parts differ by %.2e and %.2e of %.2e", samples[n].name, coarse, fine, largest);
    }
    material_destroy(&m);
  }
}

/** A slice of points of one material in plane stress. */
static Points plane_stress_points(Material *m)
{
  static const PointsRun run = {0, 0, SLICE};
  Points points;
  const PointsSpec spec = {.components = 6,
                           .plane_stress = true,
                           .runs = &run,
                           .run_count = 1,
                           .materials = m,
                           .material_count = 1,
                           .length = 0.07};
  assert_int_equal(points_create(&points, &spec, NULL), 0);
  return points;
}

static void plane_stress_holds_whatever_the_path(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    Points points = plane_stress_points(&m);
    uint64_t seed[SLICE];
    for (int i = 0; i < SLICE; ++i) seed[i] = 50 + (uint64_t)i;
    for (int step = 0; step < 2000; ++step) {
      for (int i = 0; i < SLICE; ++i) {
        double e[6];
        for (int k = 0; k < 6; ++k) e[k] = points.strain[k][i];
        sample_wander(&seed[i], samples[n].strain, samples[n].strain / 10, e);
        points.strain[XX][i] = e[XX];
        points.strain[YY][i] = e[YY];
        points.strain[XY][i] = e[XY];
      }
      points_keep_tangents(&points, step % 2, NULL);
      const int64_t bad = points_update(&points, 0, SLICE, points.strain, points.stress);
      if (bad >= 0) fail_msg("%s: plane stress fails in step %d", samples[n].name, step);
      for (int i = 0; i < SLICE; ++i) {
        double most = 0;
        for (int k = 0; k < 6; ++k) most = larger_of(most, fabs(points.stress[k][i]));
        const double part = samples[n].jumps ? 0.1 : 1e-9;
        if (!(fabs(points.stress[ZZ][i]) <= part * (most + sample_stiffness(&m) * fabs(points.strain[ZZ][i]))))
          fail_msg("%s: stress zz %g of %g in step %d", samples[n].name, points.stress[ZZ][i], most, step);
      }
      points_commit(&points);
    }
    points_destroy(&points);
    material_destroy(&m);
  }
}

/** A point finds the same strain across the plane beside others that need more iterations, or fewer. */
static void plane_stress_depends_on_no_other_point(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    Points together = plane_stress_points(&m), alone = plane_stress_points(&m);
    uint64_t seed[SLICE];
    for (int i = 0; i < SLICE; ++i) seed[i] = 90 + (uint64_t)i;
    for (int step = 0; step < 200; ++step) {
      for (int i = 0; i < SLICE; ++i) {
        double e[6];
        for (int k = 0; k < 6; ++k) e[k] = together.strain[k][i];
        sample_wander(&seed[i], samples[n].strain, samples[n].strain / (i % 3 ? 1e4 : 10), e);
        for (int k = 0; k < 6; ++k)
          if (k == XX || k == YY || k == XY) together.strain[k][i] = alone.strain[k][i] = e[k];
      }
      points_keep_tangents(&together, step % 2, NULL);
      points_keep_tangents(&alone, step % 2, NULL);
      assert_int_equal(points_update(&together, 0, SLICE, together.strain, together.stress), -1);
      for (int i = 0; i < SLICE; ++i) {
        double *strain[6], *stress[6];
        for (int k = 0; k < 6; ++k) {
          strain[k] = alone.strain[k] + i;
          stress[k] = alone.stress[k] + i;
        }
        assert_int_equal(points_update(&alone, i, 1, strain, stress), -1);
      }
      for (int k = 0; k < 6; ++k) {
        if (memcmp(together.strain[k], alone.strain[k], sizeof(double) * SLICE))
          fail_msg("%s: strain %d in step %d", samples[n].name, k, step);
        if (memcmp(together.stress[k], alone.stress[k], sizeof(double) * SLICE))
          fail_msg("%s: stress %d in step %d", samples[n].name, k, step);
      }
      for (int i = 0; i < SLICE && step % 2; ++i) {
        double tangents[2][36];
        points_tangent(&together, i, tangents[0]);
        points_tangent(&alone, i, tangents[1]);
        if (memcmp(tangents[0], tangents[1], sizeof *tangents))
          fail_msg("%s: tangent of point %d in step %d", samples[n].name, i, step);
      }
      points_commit(&together);
      points_commit(&alone);
      for (int i = 0; i < SLICE; ++i)
        if (memcmp(points_history(&together, i), points_history(&alone, i), sizeof(double) * (size_t)m.history_values))
          fail_msg("%s: history of point %d in step %d", samples[n].name, i, step);
    }
    points_destroy(&together);
    points_destroy(&alone);
    material_destroy(&m);
  }
}

static int relying_values(const void *constants)
{
  (void)constants;
  return 2;
}
static void relying_begin(const void *constants, double *history)
{
  (void)constants;
  history[0] = 5;
  history[1] = 0;
}
/** A law that softens with its strain over the length and hardens across the plane, writes the second of its numbers only, and gives up where the first is not there. */
static int relying_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    double e[6], size = 0;
    if (batch->committed[2 * i] != 5 || batch->trial[2 * i] != 5) return i;
    for (int k = 0; k < 6; ++k) size += fabs(e[k] = batch->strain[k][i]);
    batch->trial[2 * i + 1] = size;
    const double left = 1 / (1 + size / batch->length[i]), volumetric = 6e4 * (e[XX] + e[YY] + e[ZZ]);
    for (int k = 0; k < 6; ++k) batch->stress[k][i] = left * ((k < 3 ? volumetric : 0) + (k < 3 ? 12e4 : 6e4) * e[k]);
    batch->stress[ZZ][i] += left * 1e9 * pow(e[ZZ], 3);
    for (int k = 0; k < 36 && batch->tangent; ++k)
      batch->tangent[36 * i + k] = left * ((k % 7 ? 0 : k / 7 < 3 ? 12e4 : 6e4) + (k / 6 < 3 && k % 6 < 3 ? 6e4 : 0));
  }
  return -1;
}

/** Points that need more iterations than others are handed to the law with all that it is promised: lengths, and trial histories that are twins of the committed ones. */
static void plane_stress_hands_over_lengths_and_twins(void **state)
{
  (void)state;
  static const double length = 0.07; /* of plane_stress_points */
  Material m = samples[0].make();
  breccia_law law = *m.law;
  law.history_values = relying_values;
  law.begin = relying_begin;
  law.update = relying_update;
  m.law = &law;
  m.bulk = 1e5;
  m.shear = 6e4;
  m.history_values = 2;
  Points points = plane_stress_points(&m);
  for (int i = 0; i < SLICE; ++i) points.strain[XX][i] = i % 2 ? 1e-9 : 1e-2 * (i + 1);
  for (int keep = 0; keep < 2; ++keep) {
    points_keep_tangents(&points, keep, NULL);
    assert_int_equal(points_update(&points, 0, SLICE, points.strain, points.stress), -1);
    for (int i = 0; i < SLICE; ++i) {
      const double xx = points.strain[XX][i], zz = points.strain[ZZ][i];
      const double expected = (18e4 * xx + 6e4 * zz) / (1 + (xx + fabs(zz)) / length);
      assert_near(6e4 * xx + 18e4 * zz + 1e9 * pow(zz, 3), 0, 1e-9 * 6e4 * xx);
      assert_near(points.stress[XX][i], expected, 1e-12 * expected);
      points.strain[ZZ][i] = 0; /* and once more, with tangents */
    }
  }
  points_destroy(&points);
  material_destroy(&m);
}

/** Cracked through, a point dilates however far it is strained across the plane, without coming to a stress of exactly nothing there, and Newton's method leads
 *  anywhere. The second one has come to the plane without a strain in it; the last two came to strains of a hundred. */
static void plane_stress_holds_where_cracks_stand_open(void **state)
{
  (void)state;
  static const struct {
    double strain[6], committed[11];
  } cases[] = {
      {{-0.000243212, 0.108388517, 0.244462189, 0.108423694},
       {-0.000217573, 0.108569, 0.244460699, 0.0543345459, 0, 0, 0.0186700, 0.0494696, 0.999142441993}},
      {{0}, {-0.000217573, 0.108569, 0.244460699, 0.0543345459, 0, 0, 0.0186700, 0.0494696, 0.999142441993}},
      {{-0.00382287, -0.00381022, 0.0955402591, 0.00282345},
       {-0.002819105, -0.004368463, 0.095538610719, 0.001430025, 0, 0, 0.01194458, 0.048642412, 0.9990343504991}},
      {{-0.0053164962, 0.0006116253, 0.127767026, 0.0005285770},
       {-0.004796140, -0.0003873536, 0.127765948504, -0.0001812539, 0, 0, 0.01292817642, 0.0499358101,
        0.9991971283471}}};
  Material m = material_of("damage-plasticity", "Young modulus=33.01e6", "Poisson ratio=0.2", "tensile strength=3283",
                           "compressive strength=36.2e3", "fracture energy=0.1393", "length=0.0682413", NULL);
  assert_int_equal(m.history_values, sizeof cases->committed / sizeof *cases->committed);
  for (size_t n = 0; n < sizeof cases / sizeof *cases; ++n) {
    Points points = plane_stress_points(&m);
    for (int i = 0; i < SLICE; ++i) {
      memcpy(points.committed + m.history_values * i, cases[n].committed, sizeof cases[n].committed);
      for (int k = 0; k < 6; ++k) points.strain[k][i] = cases[n].strain[k] * (1 + 1e-3 * i);
    }
    points_take_up(&points);
    for (int keep = 0; keep < 2; ++keep) {
      points_keep_tangents(&points, keep, NULL);
      assert_int_equal(points_update(&points, 0, SLICE, points.strain, points.stress), -1);
      for (int i = 0; i < SLICE; ++i) {
        if (!(fabs(points.strain[ZZ][i]) < 10 * cases[n].committed[ZZ]))
          fail_msg("case %zu: strain zz %g", n, points.strain[ZZ][i]);
        assert_true(fabs(points.stress[ZZ][i]) <= 1e-9 * sample_stiffness(&m) * cases[n].committed[ZZ]);
      }
    }
    points_destroy(&points);
  }
  material_destroy(&m);
}

static void a_strain_that_is_no_number_is_reported(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    if (samples[n].passes_on) continue;
    Material m = samples[n].make();
    Point p = point_start(&m);
    const double values[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 6; ++k)
      for (int v = 0; v < 3; ++v) {
        double strain[6] = {0}, s[6], tangent[36];
        strain[k] = values[v];
        if (point_may_try(&p, strain, s, NULL, 0) || point_may_try(&p, strain, s, tangent, 0))
          fail_msg("%s takes a strain of %g", samples[n].name, values[v]);
      }
    point_stop(&p);
    material_destroy(&m);
  }
}

/** Strains far beyond any strength, of one point and of so many that lanes are left over: Hooke's law, and its tangent. */
/** An elastic stage does not age a viscoelastic law: the strain at its end counts as grown in the first step after
 *  it. */
static void a_viscoelastic_law_relaxes_from_an_elastic_stage_on(void **state)
{
  (void)state;
  Material m = material_of("viscoelastic", "Young modulus=1000", "Poisson ratio=0.25", "relaxing share=0.4",
                           "relaxation time=2", NULL);
  double strain[6] = {0, 0, 0, 1e-3, 0, 0}, stress[6] = {0}, histories[2][32] = {{0}};
  assert_true(m.history_values <= 32);
  breccia_batch batch = {.size = sizeof batch, .count = 1, .time_step = 0.5};
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = &strain[k];
    batch.stress[k] = &stress[k];
  }
  for (int step = 0; step < 3; ++step) {
    batch.elastic_stage = step < 2;
    batch.committed = histories[step % 2];
    batch.trial = histories[(step + 1) % 2];
    assert_int_equal(m.law->update(m.constants, &batch), -1);
    const double x = 0.5 / 2, late = 1 - (1 - exp(-x)) / x;
    assert_near(stress[3], m.shear * 1e-3 * (step < 2 ? 1 : 1 - 0.4 * late), 1e-12);
  }
  material_destroy(&m);
}

static void the_elastic_stage_is_elastic(void **state)
{
  (void)state;
  enum { MOST = 6 };
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    const double lambda = m.bulk - 2 * m.shear / 3;
    const size_t values = (size_t)m.history_values;
    for (int count = 1; count <= MOST; ++count) {
      double strain[6][MOST], stress[6][MOST], tangent[36 * MOST];
      double *committed = calloc(values * MOST + 1, sizeof(double)), *trial = calloc(values * MOST + 1, sizeof(double));
      breccia_batch batch = {.size = sizeof batch,
                             .count = count,
                             .committed = committed,
                             .trial = trial,
                             .tangent = tangent,
                             .elastic_stage = 1};
      for (int i = 0; i < count; ++i) {
        static const double some[6] = {2e-2, -1e-2, 5e-3, 1e-2, 3e-2, -2e-2};
        for (int k = 0; k < 6; ++k) strain[k][i] = some[(k + i) % 6] * (i % 2 ? -1 : 1);
        if (m.law->begin) {
          m.law->begin(m.constants, committed + values * (size_t)i);
          m.law->begin(m.constants, trial + values * (size_t)i);
        }
      }
      for (int k = 0; k < 6; ++k) {
        batch.strain[k] = strain[k];
        batch.stress[k] = stress[k];
      }
      assert_int_equal(m.law->update(m.constants, &batch), -1);
      for (int i = 0; i < count; ++i) {
        const double volume = strain[0][i] + strain[1][i] + strain[2][i];
        for (int k = 0; k < 6; ++k) {
          const double expected = (k < 3 ? 2 : 1) * m.shear * strain[k][i] + (k < 3 ? lambda * volume : 0);
          assert_near(stress[k][i], expected, 1e-12 * m.bulk);
          for (int c = 0; c < 6; ++c)
            assert_near(tangent[36 * i + 6 * k + c],
                        (k < 3 && c < 3 ? lambda : 0) + (k == c ? (k < 3 ? 2 : 1) * m.shear : 0), 1e-10 * m.bulk);
        }
      }
      free(committed);
      free(trial);
    }
    material_destroy(&m);
  }
}

/** What histories are called, where people may want to see them. */
static void laws_tell_what_they_remember(void **state)
{
  (void)state;
  static const struct {
    const char *law, *names; /* with their places */
  } wanted[] = {
      {"viscoelastic", ""},
      {"elastic", ""},
      {"j2", "6 equivalent plastic strain;"},
      {"multi-yield-j2", "12 active surface;"},
      {"cap", "6 cap parameter;"},
      {"drucker-prager", "6 equivalent plastic strain;"},
      {"mohr-coulomb", ""},
      {"bounding-surface-clay", "18 distance to the bounding surface;"},
      {"damage-plasticity", "6 plastic strain in tension;7 plastic strain in compression;8 material damage;"},
      {"mazars", "0 equivalent strain;1 material damage;"},
      {"link-damage", "0 tensile damage;1 compressive damage;"},
  };
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    size_t which = 0;
    while (which < sizeof wanted / sizeof *wanted && strcmp(wanted[which].law, m.law->name)) ++which;
    if (which == sizeof wanted / sizeof *wanted) fail_msg("nobody says what '%s' remembers", m.law->name);
    Text names = {0};
    for (int k = 0; k < m.history_values && m.law->history_name; ++k) {
      char name[64] = "?";
      m.law->history_name(m.constants, k, name, sizeof name);
      if (*name) text_add(&names, "%d %s;", k, name);
    }
    if (strcmp(text_words(&names), wanted[which].names)) fail_msg("%s: %s", m.law->name, text_words(&names));
    assert_true(isinf(material_failure_strain(&m)));
    text_free(&names);
    material_destroy(&m);
  }
}

static void every_law_in_space_is_among_the_samples(void **state)
{
  (void)state;
  for (int k = 0; breccia_law_at(k); ++k) {
    bool sampled = breccia_law_at(k)->components != 6;
    for (int n = 0; n < SAMPLES && !sampled; ++n) {
      Material m = samples[n].make();
      sampled = m.law == breccia_law_at(k);
      material_destroy(&m);
    }
    if (!sampled) fail_msg("law '%s' is not in sample_laws.c, so that nobody tests it", breccia_law_at(k)->name);
  }
}

/** What programs read of the laws that they are offered. */
static void every_law_says_what_it_is(void **state)
{
  (void)state;
  for (int k = 0; breccia_law_at(k); ++k) {
    const breccia_law *law = breccia_law_at(k);
    assert_true(law->name && *law->name);
    if (law->size != sizeof(breccia_law)) fail_msg("%s: its size is %d", law->name, (int)law->size);
    const char *const words[] = {law->about, law->source, law->maturity};
    for (int w = 0; w < 3; ++w)
      if (!words[w] || !*words[w]) fail_msg("%s: it lacks words", law->name);
    for (int p = 0; p < law->parameter_count; ++p)
      if (!law->parameters[p].name || !law->parameters[p].dimension || !law->parameters[p].meaning)
        fail_msg("%s: its parameter %d lacks words", law->name, p + 1);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_law_in_space_is_among_the_samples),
      cmocka_unit_test(every_law_says_what_it_is),
      cmocka_unit_test(steps_of_any_size_stay_finite_and_inside),
      cmocka_unit_test(stress_turns_with_the_strain),
      cmocka_unit_test(a_trial_can_be_repeated_and_leaves_the_committed_state_alone),
      cmocka_unit_test(stress_and_history_do_not_hang_on_the_tangent),
      cmocka_unit_test(points_of_a_batch_do_not_know_of_each_other),
      cmocka_unit_test(laws_know_no_unit_of_stress),
      cmocka_unit_test(closed_cycles_of_strain_take_work),
      cmocka_unit_test(smaller_steps_change_little),
      cmocka_unit_test(plane_stress_holds_whatever_the_path),
      cmocka_unit_test(plane_stress_depends_on_no_other_point),
      cmocka_unit_test(plane_stress_hands_over_lengths_and_twins),
      cmocka_unit_test(plane_stress_holds_where_cracks_stand_open),
      cmocka_unit_test(a_strain_that_is_no_number_is_reported),
      cmocka_unit_test(a_viscoelastic_law_relaxes_from_an_elastic_stage_on),
      cmocka_unit_test(the_elastic_stage_is_elastic),
      cmocka_unit_test(laws_tell_what_they_remember),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
