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

enum { REPEATS = 5 };

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

/** Seconds of one force evaluation: correspondence, elastic, small strain, no control, constant influence. */
PLAIN static double plain_rows(const Domain *d)
{
  const Particles *p = d->particles;
  size_t n = (size_t)p->count;
  Rows rows = rows_of(d);
  double *x = malloc(sizeof(double) * 3 * n), *u = malloc(sizeof(double) * 3 * n), *f = malloc(sizeof(double) * 3 * n);
  double *q = malloc(sizeof(double) * 9 * n), *inverse = malloc(sizeof(double) * 6 * n);
  for (size_t i = 0; i < n; ++i) {
    double k[6] = {0};
    for (int c = 0; c < 3; ++c) {
      x[3 * i + (size_t)c] = p->position[c][p->place_of[i]];
      u[3 * i + (size_t)c] = p->displacement[c][p->place_of[i]];
    }
    for (int64_t b = rows.first[i]; b < rows.first[i + 1]; ++b)
      for (int c = 0; c < 6; ++c) {
        int32_t j = p->place_of[rows.neighbour[b]], here = p->place_of[i];
        k[c] += p->volume[j] * (p->position[symmetric_row[c]][j] - p->position[symmetric_row[c]][here]) *
                (p->position[symmetric_column[c]][j] - p->position[symmetric_column[c]][here]);
      }
    tensor_inverse(k, inverse + 6 * i);
  }
  const double lambda = 60000, shear = 60000, volume = p->volume[p->place_of[0]];
  double seconds[REPEATS];
  for (int r = 0; r < REPEATS; ++r) {
    double start = clock_seconds();
    for (size_t i = 0; i < n; ++i) {
      double g[9] = {0}, grad[9];
      const double *k = inverse + 6 * i;
      for (int64_t b = rows.first[i]; b < rows.first[i + 1]; ++b) {
        size_t j = (size_t)rows.neighbour[b];
        for (int c = 0; c < 3; ++c)
          for (int e = 0; e < 3; ++e)
            g[3 * c + e] +=
                volume * (u[3 * j + (size_t)c] - u[3 * i + (size_t)c]) * (x[3 * j + (size_t)e] - x[3 * i + (size_t)e]);
      }
      for (int c = 0; c < 3; ++c)
        for (int e = 0; e < 3; ++e)
          grad[3 * c + e] = g[3 * c] * k[symmetric_place[e]] + g[3 * c + 1] * k[symmetric_place[3 + e]] +
                            g[3 * c + 2] * k[symmetric_place[6 + e]];
      double trace = lambda * (grad[0] + grad[4] + grad[8]), s[9];
      for (int c = 0; c < 3; ++c)
        for (int e = 0; e < 3; ++e) s[3 * c + e] = shear * (grad[3 * c + e] + grad[3 * e + c]) + (c == e ? trace : 0);
      for (int c = 0; c < 3; ++c)
        for (int e = 0; e < 3; ++e)
          q[9 * i + (size_t)(3 * c + e)] = s[3 * c] * k[symmetric_place[e]] + s[3 * c + 1] * k[symmetric_place[3 + e]] +
                                           s[3 * c + 2] * k[symmetric_place[6 + e]];
    }
    for (size_t i = 0; i < n; ++i) {
      double force[3] = {0};
      for (int64_t b = rows.first[i]; b < rows.first[i + 1]; ++b) {
        size_t j = (size_t)rows.neighbour[b];
        double xi[3] = {x[3 * j] - x[3 * i], x[3 * j + 1] - x[3 * i + 1], x[3 * j + 2] - x[3 * i + 2]};
        for (int c = 0; c < 3; ++c)
          for (int e = 0; e < 3; ++e)
            force[c] += volume * (q[9 * i + (size_t)(3 * c + e)] + q[9 * j + (size_t)(3 * c + e)]) * xi[e];
      }
      for (int c = 0; c < 3; ++c) f[3 * i + (size_t)c] = force[c];
    }
    seconds[r] = clock_seconds() - start;
  }
  double sink = 0 * f[n];
  free(rows.first);
  free(rows.neighbour);
  free(x);
  free(u);
  free(f);
  free(q);
  free(inverse);
  return median(seconds, REPEATS) + sink;
}

/* ---- cubes ---- */

static breccia_model *cube(int n, const char *law)
{
  Text deck = {0};
  text_add(&deck,
           "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\n"
           "body: {b: {material: m, spacing: 0.03, shape: {box: {particles: [%d, %d, %d]}}}}\n"
           "failure: {critical stretch: 0.05}\nsolve: {explicit: {steps: 1000000}}\n"
           "loads: [{on: {face: x+, layers: 3}, body force: [2000, 0, 0]}, {on: {face: x-, layers: 3}, velocity: [0, "
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

static double step_seconds(breccia_model *model, int threads)
{
  double seconds[REPEATS], bonds = (double)breccia_model_bonds(model);
  int64_t steps = (int64_t)(2.5e8 / bonds) + 1;
  model->threads = threads;
  breccia_model_step(model, 2, NULL);
  for (int r = 0; r < REPEATS; ++r) {
    double start = clock_seconds();
    breccia_model_step(model, steps, NULL);
    seconds[r] = (clock_seconds() - start) / (double)steps;
  }
  return median(seconds, REPEATS);
}

static double force_seconds(breccia_model *model)
{
  double seconds[REPEATS];
  use_threads(1);
  for (int r = 0; r < REPEATS; ++r) {
    double start = clock_seconds();
    domain_forces(&model->domain);
    seconds[r] = clock_seconds() - start;
  }
  return median(seconds, REPEATS);
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
  printf("%-16s %10s %12s %8s %8s %8s %9s %9s %10s\n", "law", "particles", "bonds", "force/1", "step/1", "step/all",
         "GB/s all", "bytes/b.", "plain rows");
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
      double bonds = (double)breccia_model_bonds(model), single = step_seconds(model, 1),
             parallel = step_seconds(model, all);
      double force = force_seconds(model), plain = l == 0 ? plain_rows(&model->domain) : NAN;
      printf("%-16s %10lld %12.0f %8.2f %8.2f %8.2f %9.1f %9.2f", laws[l].name,
             (long long)breccia_model_particles(model), bonds, 1e9 * force / bonds, 1e9 * single / bonds,
             1e9 * parallel / bonds, bytes_moved(&model->domain) / parallel / 1e9,
             (double)family_bytes(&model->domain.family) / bonds);
      if (l == 0) printf(" %10.2f", 1e9 * plain / bonds);
      printf("\n");
      fflush(stdout);
      breccia_model_destroy(&model);
    }
  printf("\nforce, step, plain rows: ns per directed bond and step, medians of %d; /1 one thread, /all %d threads\n",
         REPEATS, all);
  printf("bytes/b.: bytes per directed bond beyond what is kept per particle\n");
  return 0;
}
