/* What a bond costs: whole steps of cubes, one thread and all, beside what the machine allows and beside plain rows. */
#include "base/clock.h"
#include "base/tensor.h"
#include "model/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

enum { REPEATS = 9 };

#ifdef __clang__
#define PLAIN
#else
#define PLAIN __attribute__((optimize("no-tree-vectorize")))
#endif

static int all_threads(void)
{
#ifdef _OPENMP
  return omp_get_num_procs();
#else
  return 1;
#endif
}

static void use_threads(int threads)
{
#ifdef _OPENMP
  omp_set_num_threads(threads);
#else
  (void)threads;
#endif
}

static int by_value(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

static double median(double *values, int count)
{
  qsort(values, (size_t)count, sizeof *values, by_value);
  return values[count / 2];
}

/* ---- ceilings ---- */

static double stream_bandwidth(void)
{
  const int64_t n = 1 << 24;
  double *a = malloc(sizeof(double) * (size_t)n), *b = malloc(sizeof(double) * (size_t)n),
         *c = malloc(sizeof(double) * (size_t)n);
  if (!a || !b || !c) return NAN;
  double seconds[REPEATS];
  for (int r = -1; r < REPEATS; ++r) {
    double start = clock_seconds();
#pragma omp parallel for schedule(static)
    for (int64_t i = 0; i < n; ++i)
      if (r < 0)
        a[i] = b[i] = c[i] = 1;
      else
        a[i] = b[i] + 3 * c[i];
    if (r >= 0) seconds[r] = clock_seconds() - start;
  }
  double rate = 3 * sizeof(double) * (double)n / median(seconds, REPEATS) / 1e9 + 0 * a[n / 2];
  free(a);
  free(b);
  free(c);
  return rate;
}

BRECCIA_CLONES
static double multiply_add(int64_t rounds)
{
  enum { CHAINS = 10 };
  Lanes sum[CHAINS], x = lanes_set(1.000000001), y = lanes_set(1e-9);
  for (int k = 0; k < CHAINS; ++k) sum[k] = lanes_set(k);
  for (int64_t r = 0; r < rounds; ++r)
    for (int k = 0; k < CHAINS; ++k) sum[k] = sum[k] * x + y;
  double total = 0;
  for (int k = 0; k < CHAINS; ++k)
    for (int l = 0; l < LANES; ++l) total += sum[k][l];
  return total;
}

static double multiply_add_rate(void)
{
  const int64_t rounds = 20000000;
  double seconds[REPEATS], sink = 0;
  for (int r = 0; r < REPEATS; ++r) {
    double start = clock_seconds();
    sink += multiply_add(rounds);
    seconds[r] = clock_seconds() - start;
  }
  return 2.0 * 10 * LANES * (double)rounds / median(seconds, REPEATS) / 1e9 + 0 * sink;
}

/* ---- the yardstick: plain neighbour rows, scalar, as most codes walk them ---- */

typedef struct Rows {
  int64_t *first;
  int32_t *neighbour;
} Rows;

static Rows rows_of(const Domain *d)
{
  const Particles *p = d->particles;
  Rows rows = {malloc(sizeof(int64_t) * (size_t)(p->count + 1)), malloc(sizeof(int32_t) * (size_t)d->family.bonds)};
  int64_t n = 0;
  for (int64_t i = 0; i < p->count; ++i) {
    int32_t place = p->place_of[i];
    rows.first[i] = n;
    for (int64_t slot = d->family.first[place / SLICE]; slot < d->family.first[place / SLICE + 1]; ++slot)
      if (d->family.intact[slot] >> (place % SLICE) & 1)
        rows.neighbour[n++] = p->number[family_bond(&d->family, place / SLICE, slot, place % SLICE).neighbour];
  }
  rows.first[p->count] = n;
  return rows;
}

/** Correspondence, elastic, small strain, no control, constant influence: shape tensors first, then force evaluations. */
typedef struct Plain {
  size_t count;
  Rows rows;
  double *x, *u, *force, *state, *inverse, volume;
} Plain;

static Plain plain_create(const Domain *d)
{
  const Particles *p = d->particles;
  size_t n = (size_t)p->count;
  Plain plain = {n,
                 rows_of(d),
                 malloc(24 * n),
                 malloc(24 * n),
                 malloc(24 * n),
                 malloc(72 * n),
                 malloc(48 * n),
                 p->volume[p->place_of[0]]};
  for (size_t i = 0; i < n; ++i) {
    double k[6] = {0};
    int32_t here = p->place_of[i];
    for (int c = 0; c < 3; ++c) {
      plain.x[3 * i + (size_t)c] = p->position[c][here];
      plain.u[3 * i + (size_t)c] = 1e-6 * (double)(i % 7);
    }
    for (int64_t b = plain.rows.first[i]; b < plain.rows.first[i + 1]; ++b)
      for (int c = 0; c < 6; ++c) {
        int32_t j = p->place_of[plain.rows.neighbour[b]];
        k[c] += p->volume[j] * (p->position[symmetric_row[c]][j] - p->position[symmetric_row[c]][here]) *
                (p->position[symmetric_column[c]][j] - p->position[symmetric_column[c]][here]);
      }
    tensor_inverse(k, plain.inverse + 6 * i);
  }
  return plain;
}

static void plain_destroy(Plain *plain)
{
  free(plain->rows.first);
  free(plain->rows.neighbour);
  free(plain->x);
  free(plain->u);
  free(plain->force);
  free(plain->state);
  free(plain->inverse);
}

PLAIN static void plain_forces(Plain *plain)
{
  const double *x = plain->x, *u = plain->u, lambda = 60000, shear = 60000, volume = plain->volume;
  const Rows *rows = &plain->rows;
  double *q = plain->state;
  for (size_t i = 0; i < plain->count; ++i) {
    double g[9] = {0}, grad[9], s[9];
    const double *k = plain->inverse + 6 * i;
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      size_t j = (size_t)rows->neighbour[b];
      for (int c = 0; c < 3; ++c)
        for (int e = 0; e < 3; ++e)
          g[3 * c + e] +=
              volume * (u[3 * j + (size_t)c] - u[3 * i + (size_t)c]) * (x[3 * j + (size_t)e] - x[3 * i + (size_t)e]);
    }
    for (int c = 0; c < 3; ++c)
      for (int e = 0; e < 3; ++e)
        grad[3 * c + e] = g[3 * c] * k[symmetric_place[e]] + g[3 * c + 1] * k[symmetric_place[3 + e]] +
                          g[3 * c + 2] * k[symmetric_place[6 + e]];
    double trace = lambda * (grad[0] + grad[4] + grad[8]);
    for (int c = 0; c < 3; ++c)
      for (int e = 0; e < 3; ++e) s[3 * c + e] = shear * (grad[3 * c + e] + grad[3 * e + c]) + (c == e ? trace : 0);
    for (int c = 0; c < 3; ++c)
      for (int e = 0; e < 3; ++e)
        q[9 * i + (size_t)(3 * c + e)] = s[3 * c] * k[symmetric_place[e]] + s[3 * c + 1] * k[symmetric_place[3 + e]] +
                                         s[3 * c + 2] * k[symmetric_place[6 + e]];
  }
  for (size_t i = 0; i < plain->count; ++i) {
    double force[3] = {0};
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      size_t j = (size_t)rows->neighbour[b];
      double xi[3] = {x[3 * j] - x[3 * i], x[3 * j + 1] - x[3 * i + 1], x[3 * j + 2] - x[3 * i + 2]};
      for (int c = 0; c < 3; ++c)
        for (int e = 0; e < 3; ++e)
          force[c] += volume * (q[9 * i + (size_t)(3 * c + e)] + q[9 * j + (size_t)(3 * c + e)]) * xi[e];
    }
    for (int c = 0; c < 3; ++c) plain->force[3 * i + (size_t)c] = force[c];
  }
}

/* ---- cubes ---- */

static breccia_model *cube(int n, const char *law)
{
  Text deck = {0};
  text_add(&deck,
           "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\n"
           "body: {b: {material: m, spacing: 0.03, shape: {box: {particles: [%d, %d, %d]}}}}\n"
           "failure: {critical stretch: 0.05}\nsolve: {explicit: {steps: 1000000}}\n"
           "loads: [{on: {face: x+, layers: 3}, body force: [400, 0, 0], history: {ramp to: 0.02}}, {on: {face: x-, "
           "layers: 3}, velocity: [0, "
           "0, 0]}]\n",
           law, n, n, n);
  breccia_model *model = NULL;
  breccia_error *error = breccia_error_create();
  if (breccia_model_load_string(deck.characters, "bench", NULL, &model, error))
    fprintf(stderr, "%s\n", breccia_error_text(error));
  breccia_error_destroy(&error);
  text_free(&deck);
  return model;
}

/** What is measured of a cube, in seconds; one of each in turn, so that a slow spell of the machine meets all alike. */
typedef struct Times {
  double plain[REPEATS], force[REPEATS], law[REPEATS], one[REPEATS], all[REPEATS];
} Times;

static double steps_seconds(breccia_model *model, int threads, int64_t steps)
{
  model->threads = threads;
  double start = clock_seconds();
  breccia_model_step(model, steps, NULL);
  return (clock_seconds() - start) / (double)steps;
}

static void measure(breccia_model *model, Times *times)
{
  Domain *d = &model->domain;
  Plain plain = plain_create(d);
  int64_t steps = (int64_t)(5e7 / (double)d->family.bonds) + 1;
  for (int r = -1; r < REPEATS; ++r) {
    int at = r < 0 ? 0 : r;
    times->all[at] = steps_seconds(model, all_threads(), steps);
    times->one[at] = steps_seconds(model, 1, steps);
    double start = clock_seconds();
    domain_forces(d);
    times->force[at] = clock_seconds() - start;
    start = clock_seconds();
    for (int64_t b = 0; b < d->block_count; ++b) points_update(&d->points, d->blocks[b].first, d->blocks[b].last, NULL);
    times->law[at] = clock_seconds() - start;
    start = clock_seconds();
    plain_forces(&plain);
    times->plain[at] = clock_seconds() - start;
  }
  plain_destroy(&plain);
}

/** Bytes that a step has to move at the least: slots twice, what is kept per particle once. */
static double bytes_moved(const Domain *d)
{
  return 2.0 * (double)family_bytes(&d->family) + (double)(domain_bytes(d) - family_bytes(&d->family)) -
         2.0 * (double)d->points.history_size * sizeof(double);
}

int main(void)
{
  int all = all_threads();
  use_threads(1);
  double flops = multiply_add_rate(), one = stream_bandwidth();
  use_threads(all);
  double many = stream_bandwidth();
  printf("ceilings: %.1f GFLOP/s fused multiply-add on one thread; triad %.1f GB/s on one thread, %.1f GB/s on %d\n\n",
         flops, one, many, all);
  printf("%-15s %9s %10s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "law", "particles", "bonds", "plain", "force", "ratio",
         "step", "GB/s", "step all", "GB/s all", "law", "bytes");
  const struct {
    const char *name, *words;
  } laws[] = {{"elastic", "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.25"},
              {"multi-yield-j2",
               "model: multi-yield-j2, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30"}};
  const int sizes[] = {40, 80};
  for (int l = 0; l < 2; ++l)
    for (int k = 0; k < 2; ++k) {
      use_threads(all);
      breccia_model *model = cube(sizes[k], laws[l].words);
      if (!model) return 1;
      Times times;
      measure(model, &times);
      const Domain *d = &model->domain;
      double bonds = (double)d->family.bonds, ratio[REPEATS], parallel, single;
      for (int r = 0; r < REPEATS; ++r) ratio[r] = times.plain[r] / (times.force[r] - times.law[r] * (l == 1));
      parallel = median(times.all, REPEATS);
      single = median(times.one, REPEATS);
      printf("%-15s %9lld %10.0f %8.2f %8.2f %8.2f %8.2f %8.1f %8.2f %8.1f %8.1f %8.2f\n", laws[l].name,
             (long long)d->particles->count, bonds, 1e9 * median(times.plain, REPEATS) / bonds,
             1e9 * median(times.force, REPEATS) / bonds, median(ratio, REPEATS), 1e9 * single / bonds,
             bytes_moved(d) / single / 1e9, 1e9 * parallel / bonds, bytes_moved(d) / parallel / 1e9,
             1e9 * median(times.law, REPEATS) / (double)d->particles->count, (double)family_bytes(&d->family) / bonds);
      fflush(stdout);
      breccia_model_destroy(&model);
    }
  printf("\nplain, force, step: ns per directed bond and step on one thread (plain: scalar neighbour rows, elastic, "
         "without\n"
         "control), step all: on %d threads; ratio: plain over force, the clay's law left out; law: ns per point; "
         "bytes: per\n"
         "directed bond beyond what is kept per particle. Medians of %d, taken in turn.\n",
         all, REPEATS);
  return 0;
}
