/* What it costs to solve K v = f: cubes, squares and scattered particles, held at one face and pulled at the other, on one thread and two; bodies in the plane
 * and small ones both step by step and by factors. A Markdown table goes to stdout.
 *   breccia_bench_statics [WORDS [THREADS]]     WORDS: only rows that have them in "formulation, body, way"; from so many threads on */
#include "measure.h"

#include "solver/linear_solver.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
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
  bool factored; /* by the direct way too */
} BenchBody;

#define SQUARE "lattice: square, thickness: 1, shape: {box: {particles: "
static const BenchBody bodies[] = {
    {"cube 8³", "3-D", "shape: {box: {particles: [8, 8, 8]}}", true},
    {"cube 12³", "3-D", "shape: {box: {particles: [12, 12, 12]}}", true},
    {"cube 16³", "3-D", "shape: {box: {particles: [16, 16, 16]}}", true},
    {"cube 24³", "3-D", "shape: {box: {particles: [24, 24, 24]}}", false},
    {"cube 40³", "3-D", "shape: {box: {particles: [40, 40, 40]}}", false},
    {"cube 80³", "3-D", "shape: {box: {particles: [80, 80, 80]}}", false},
    {"bar 160×16×16", "3-D", "shape: {box: {particles: [160, 16, 16]}}", false},
    {"square 20²", "plane strain", SQUARE "[20, 20]}}", true},
    {"square 40²", "plane strain", SQUARE "[40, 40]}}", true},
    {"square 80²", "plane strain", SQUARE "[80, 80]}}", true},
    {"square 160²", "plane strain", SQUARE "[160, 160]}}", true},
    {"square 316²", "plane strain", SQUARE "[316, 316]}}", true},
    {"scattered 40³", "3-D", "file: scattered.csv", false},
};

static const int ways[] = {LINEAR_gradients, LINEAR_direct};

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
  Vector force[1], moved[1];
} Vectors;

static void make(const breccia_model *model, Vectors *v)
{
  const Particles *p = model->domain.particles;
  if (!vector_create(v->force, &p->space, "bench", NULL) || !vector_create(v->moved, &p->space, "bench", NULL)) abort();
  vector_weigh(v->force, p->volume, &p->external);
}

static void drop(Vectors *v)
{
  vector_destroy(v->force);
  vector_destroy(v->moved);
}

/** A line of what the system tells of this process, in bytes. */
static double resident(const char *line)
{
  char words[200];
  double kilobytes = 0;
  FILE *file = fopen("/proc/self/status", "r");
  while (file && fgets(words, sizeof words, file))
    if (!strncmp(words, line, strlen(line))) kilobytes = strtod(words + strlen(line), NULL);
  if (file) fclose(file);
  return 1024 * kilobytes;
}

/** Of all threads of this process. */
static double processor_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int measure(breccia_model *model, const char *formulation, const char *body, int way, int threads)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  Vectors v;
  use_threads(threads);
  loading_apply_untied(&model->loading, d->particles, 0);
  make(model, &v);
  const double before = resident("VmRSS:");
  LinearSolver solver = {.domain = d, .loading = &model->loading, .unknowns = unknowns_of(d, &model->loading)};
  LinearRecord record;
  if (domain_linearise(d, NULL, NULL)) return 1;
  double start = clock_seconds(), worked = processor_seconds();
  if (linear_solver_create(&solver, way, NULL) || linear_solver_prepare(&solver, NULL)) return 1;
  const double prepared = clock_seconds();
  unknowns_gather(&solver.unknowns, v.force);
  if (linear_solver_solve(&solver, v.force, v.moved, 1e-8, &record, NULL)) return 1;
  const double solved = clock_seconds(), most = resident("VmHWM:");
  const double work = processor_seconds() - worked;
  domain_linear_step(d, v.moved, v.force);
  const double begun = processor_seconds();
  domain_linear_step(d, v.moved, v.force);
  const double own = processor_seconds() - begun;
  printf("| %s | %s | %lld | %d | %s | %lld | %.1e | %.3f | %.3f | %.3f | %.0f | %.2f | %.0f | %.0f |\n", formulation,
         body, (long long)unknowns_count(&solver.unknowns, NULL), threads, linear_word(way),
         (long long)record.iterations, record.residual, prepared - start, solved - prepared, work, work / own,
         1e9 * own / (double)d->family.bonds, (most - before) / 1e6, (most - before) / (double)p->count);
  fflush(stdout);
  linear_solver_destroy(&solver);
  drop(&v);
  return 0;
}

/** In a process of its own, so that memory that others gave back is not counted. */
static int measure_apart(const char *folder, const BenchBody *body, const Case *c, int way, int threads)
{
  fflush(stdout);
  const pid_t child = fork();
  int status = 1;
  if (child == 0) {
    use_threads(threads);
    breccia_model *model = load(folder, body, c);
    _exit(!model || measure(model, c->formulation, body->name, way, threads));
  }
  return child < 0 || waitpid(child, &status, 0) < 0 || status != 0;
}

int main(int count, char **words)
{
  char folder[] = "/tmp/breccia-bench-XXXXXX";
  const char *only = count > 1 ? words[1] : "";
  if (!mkdtemp(folder)) return 1;
  char *cloud = text_format("%s/scattered.csv", folder);
  write_scattered(cloud, NULL);
  printf("| formulation | body | unknowns | threads | way | products | residual | prepare s | solve s | processor s | "
         "in products | product, ns per bond | MB | bytes per particle |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  int failed = 0;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c)
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b)
      for (int way = 0; way < 1 + bodies[b].factored; ++way) {
        char name[100];
        snprintf(name, sizeof name, "%s, %s, %s", cases[c].formulation, bodies[b].name, linear_word(ways[way]));
        if (!strstr(name, only)) continue;
        for (int threads = count > 2 ? atoi(words[2]) : 1; threads <= all_threads(); ++threads)
          failed |= measure_apart(folder, &bodies[b], &cases[c], ways[way], threads);
      }
  remove(cloud);
  rmdir(folder);
  free(cloud);
  return failed;
}
