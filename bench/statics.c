/* What it costs to solve K v = f: cubes, a square and scattered particles, held at one face and pulled at the other, on one thread and two. A Markdown table
 * goes to stdout.
 *   breccia_bench_statics [WORDS [THREADS]]     WORDS: only rows that have them in "formulation, body"; from so many threads on */
#include "measure.h"

#include "solver/linear_solver.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef struct Case {
  const char *formulation, *law;
} Case;

static const Case cases[] = {
    {"bond-based", "model: elastic-1d, Young modulus: 150 MPa"},
    {"ordinary", "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.3"},
    {"correspondence", "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.25"},
};

typedef struct BenchBody {
  const char *name, *space, *block;
} BenchBody;

static const BenchBody bodies[] = {
    {"cube 24³", "3-D", "shape: {box: {particles: [24, 24, 24]}}"},
    {"cube 40³", "3-D", "shape: {box: {particles: [40, 40, 40]}}"},
    {"cube 80³", "3-D", "shape: {box: {particles: [80, 80, 80]}}"},
    {"bar 160×16×16", "3-D", "shape: {box: {particles: [160, 16, 16]}}"},
    {"square 256²", "plane strain", "lattice: square, thickness: 1, shape: {box: {particles: [256, 256]}}"},
    {"scattered 40³", "3-D", "file: scattered.csv"},
};

static breccia_model *load(const char *folder, const BenchBody *body, const Case *c)
{
  Text deck = {0};
  text_add(
      &deck,
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\n"
      "peridynamics: {formulation: %s, space: %s}\nbody: {b: {material: m, spacing: 0.03, %s}}\n"
      "solve: {explicit: {steps: 1, time step: 1e-6}}\n"
      "loads: [{on: {face: x+, layers: 3}, body force: [400, 100, 0]}, {on: {face: x-, layers: 3}, velocity: [0, 0, "
      "0]}]\n",
      c->law, c->formulation, body->space, body->block);
  char *name = text_format("%s/deck", folder);
  breccia_model *model = NULL;
  breccia_error *error = breccia_error_create();
  if (breccia_model_load_string(deck.characters, name, NULL, &model, error))
    fprintf(stderr, "%s\n", breccia_error_text(error));
  breccia_error_destroy(&error);
  text_free(&deck);
  free(name);
  return model;
}

typedef struct Vectors {
  double *force[3], *moved[3];
} Vectors;

static void make(const breccia_model *model, Vectors *v)
{
  const Particles *p = model->domain.particles;
  for (int k = 0; k < 3; ++k) {
    v->force[k] = places_array(p->places, "bench", NULL);
    v->moved[k] = places_array(p->places, "bench", NULL);
    if (!v->force[k] || !v->moved[k]) abort();
    for (int64_t i = 0; i < p->places; ++i) v->force[k][i] = p->volume[i] * p->external[k][i];
  }
}

static void drop(Vectors *v)
{
  for (int k = 0; k < 3; ++k) {
    places_free(&v->force[k]);
    places_free(&v->moved[k]);
  }
}

/** Resident memory of this process. */
static double resident(void)
{
  long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (!file || fscanf(file, "%*d %ld", &pages) != 1) abort();
  fclose(file);
  return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

/** Of all threads of this process. */
static double processor_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int measure(breccia_model *model, const char *formulation, const char *body, int threads)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  Vectors v;
  use_threads(threads);
  loading_apply_untied(&model->loading, d->particles, 0);
  make(model, &v);
  const double before = resident();
  LinearSolver solver = {.domain = d, .loading = &model->loading, .unknowns = unknowns_of(d, &model->loading)};
  LinearRecord record;
  double start = clock_seconds();
  if (domain_linearise(d, NULL)) return 1;
  const double linearised = clock_seconds();
  if (linear_solver_create(&solver, "conjugate gradients", NULL) || linear_solver_prepare(&solver, NULL)) return 1;
  const double prepared = clock_seconds();
  const double worked = processor_seconds();
  unknowns_gather(&solver.unknowns, v.force);
  if (linear_solver_solve(&solver, v.force, v.moved, 1e-8, &record, NULL)) return 1;
  const double solved = clock_seconds(), after = resident();
  const double work = processor_seconds() - worked;
  domain_linear_step(d, v.moved, v.force);
  const double begun = processor_seconds();
  domain_linear_step(d, v.moved, v.force);
  const double own = processor_seconds() - begun;
  printf("| %s | %s | %lld | %d | %lld | %.1e | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.0f |\n", formulation, body,
         (long long)p->count, threads, (long long)record.iterations, record.residual, linearised - start,
         prepared - linearised, solved - prepared, work, work / (double)record.iterations / own,
         1e9 * own / (double)d->family.bonds, (after - before) / (double)p->count);
  fflush(stdout);
  linear_solver_destroy(&solver);
  drop(&v);
  return 0;
}

int main(int count, char **words)
{
  char folder[] = "/tmp/breccia-bench-XXXXXX";
  const char *only = count > 1 ? words[1] : "";
  if (!mkdtemp(folder)) return 1;
  char *cloud = text_format("%s/scattered.csv", folder);
  write_scattered(cloud, NULL);
  printf("| formulation | body | particles | threads | products | residual | linearise s | prepare s | solve s | "
         "processor s | iteration / product | product, "
         "ns per bond | bytes per particle |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  int failed = 0;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c)
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b) {
      char name[80];
      snprintf(name, sizeof name, "%s, %s", cases[c].formulation, bodies[b].name);
      if (!strstr(name, only)) continue;
      for (int threads = count > 2 ? atoi(words[2]) : 1; threads <= all_threads(); ++threads) {
        use_threads(threads);
        breccia_model *model = load(folder, &bodies[b], &cases[c]);
        failed |= !model || measure(model, cases[c].formulation, bodies[b].name, threads);
        breccia_model_destroy(&model);
      }
    }
  remove(cloud);
  rmdir(folder);
  free(cloud);
  return failed;
}
