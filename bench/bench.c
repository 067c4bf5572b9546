/* What a bond costs: whole steps of cubes, a notched plate and scattered particles, on one thread and more, beside what the machine
 * allows and beside plain rows. A Markdown table goes to stdout, all numbers to a CSV file.
 *   breccia_bench [FILE.csv [WORD...]]     only rows that have each of the words in the name of formulation, law or body */
#include "measure.h"

#include "base/lane_kinds.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_THREADS = 12 }; /* numbers of threads that are tried: 1, 2, 4 ... all */

/** The least that forces take: vector operations a directed bond (fused ones counted once, and for scattered neighbours those that turn records round),
 *  as the text of the sweeps has them on small strains in space; sweeps over all bonds, and numbers that a place's part of the phases reads and writes,
 *  each counted once in each phase; bytes a bond that are no family's (of surroundings, through which scattered correspondence goes, twice: their
 *  lanes without a bond count as operations, too). Of hybrid bonds, links and the many-surface law operations are those
 *  that a run of 12³ particles on a lattice carries out a step, by an emulator (valgrind). */
typedef struct Least {
  double operations, sweeps, numbers, bytes;
} Least;

typedef struct Case {
  const char *formulation, *law, *words;
  void (*plain)(Plain *plain); /* NULL: not written */
  bool limit;                  /* the law has none: bonds get a critical stretch */
  const char *horizon;         /* in spacings */
  Least on_lattices, scattered;
} Case;

static const Case cases[] = {
    {"bond-based",
     "elastic-brittle",
     "model: elastic-brittle, Young modulus: 150 MPa, tensile strength: 7.5 MPa",
     plain_bonds,
     false,
     "3.015",
     {24, 1, 6, 0},
     {62, 1, 32, 4}},
    {"bond-based",
     "bilinear-softening",
     "model: bilinear-softening, Young modulus: 150 MPa, tensile strength: 75 kPa, fracture energy: 1 kN/m",
     plain_bonds,
     false,
     "3.015",
     {24, 2, 9, 13},
     {77, 2, 35, 16}},
    {"correspondence",
     "elastic",
     "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.25",
     plain_correspondence,
     true,
     "3.015",
     {9.7, 2, 99, 0},
     {52, 0, 107, 2.8}},
    {"correspondence",
     "multi-yield-j2",
     "model: multi-yield-j2, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30",
     plain_correspondence,
     true,
     "3.015",
     {10.9, 2, 111, 0},
     {53, 0, 119, 2.8}},
    {"ordinary",
     "elastic",
     "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.3",
     plain_ordinary,
     true,
     "3.015",
     {45, 2, 22, 0},
     {123, 2, 52, 8}},
    {"hybrid",
     "elastic",
     "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.25",
     NULL,
     true,
     "1.5",
     {142, 1, 12, 5},
     {0, 0, 0, 0}},
    {"hybrid",
     "elastic",
     "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.25",
     NULL,
     true,
     "2.015",
     {278, 1, 12, 5},
     {278, 1, 12, 66}},
    {"micropolar",
     "elastic",
     "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.2",
     plain_links,
     true,
     "1.5",
     {136, 1, 26, 0},
     {136, 1, 26, 4}},
    {"micropolar",
     "link-damage",
     "model: link-damage, Young modulus: 150 MPa, Poisson ratio: 0.2, tensile stretch: 1e-9, compressive stretch: "
     "1e-9, fracture energy: 1 kN/m",
     plain_links,
     false,
     "1.5",
     {184, 3, 33, 16},
     {184, 3, 33, 40}}, /* all links damaged a little */
};

typedef struct BenchBody {
  const char *name, *space, *block, *cracks;
  const char *only; /* formulation that it is for; NULL: all */
} BenchBody;

#define NOTCH "cracks: [{remove: {box: {from: [2.4, 0, -1], to: [2.43, 1.2, 1]}}, cut faces: yes}]\n"
static const BenchBody bodies[] = {
    {"cube 32³", "3-D", "shape: {box: {particles: [32, 32, 32]}}", "", NULL},
    {"cube 40³", "3-D", "shape: {box: {particles: [40, 40, 40]}}", "", NULL},
    {"cube 80³", "3-D", "shape: {box: {particles: [80, 80, 80]}}", "", NULL},
    {"face-centred 40³", "3-D", "lattice: face-centred cubic, shape: {box: {particles: [40, 40, 40]}}", "", NULL},
    {"square 256²", "plane strain", "lattice: square, thickness: 1, shape: {box: {particles: [256, 256]}}", "", NULL},
    {"hexagonal 256²", "plane strain", "lattice: hexagonal, thickness: 1, shape: {box: {particles: [256, 256]}}", "",
     NULL},
    {"notched plate", "3-D", "shape: {box: {particles: [160, 120, 6]}}", NOTCH, NULL},
    {"scattered", "3-D", "file: scattered.csv", "", NULL},
    {"face-centred 100³", "3-D", "lattice: face-centred cubic, shape: {box: {particles: [100, 100, 100]}}", "",
     "micropolar"},
};

static breccia_model *load(const char *folder, const BenchBody *body, const Case *c)
{
  Text deck = {0};
  text_add(&deck,
           "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\n"
           "peridynamics: {formulation: %s, space: %s, horizon: %s spacings}\nbody: {b: {material: m, spacing: 0.03, "
           "%s}}\n%s"
           "%ssolve: {explicit: {steps: 1000000}}\n"
           "loads: [{on: {face: x+, layers: 3}, body force: [400, 0, 0], history: {ramp to: 0.02}}, {on: {face: x-, "
           "layers: 3}, velocity: [0, 0, 0]}]\n",
           c->words, c->formulation, body->space, c->horizon, body->block, body->cracks,
           c->limit ? "failure: {critical stretch: 0.05}\n" : "");
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

/** What is measured, in seconds; one of each in turn, so that a slow spell of the machine meets all alike. */
typedef struct Times {
  double plain[REPEATS], force[REPEATS], law[REPEATS], step[MOST_THREADS][REPEATS], ratio[REPEATS], share[REPEATS],
      speedup[REPEATS], search;
} Times;

/** @param[out] busy  processor time, of all threads */
static double step_seconds(breccia_model *model, int threads, int64_t steps, double *busy)
{
  model->threads = threads;
  double start = clock_seconds(), busy_start = busy_seconds();
  breccia_model_step(model, steps, NULL);
  *busy = (busy_seconds() - busy_start) / (double)steps;
  return (clock_seconds() - start) / (double)steps;
}

static double force_seconds(Domain *d, int threads)
{
  use_threads(threads);
  double start = busy_seconds();
  domain_evaluate(d, NULL);
  return busy_seconds() - start;
}

/** Stresses of all points on particles once more; of points on bonds the law is part of the forces. */
static double law_seconds(Domain *d)
{
  if (!points_on_particles(&d->regions[0].points)) return 0;
  double start = busy_seconds();
  for (int64_t b = 0; b < d->batch_count; ++b) {
    const int64_t first = d->batches[b].first * SLICE;
    double *strain[6], *stress[6];
    for (int k = 0; k < 6; ++k) {
      strain[k] = d->regions[0].points.strain[k] + first;
      stress[k] = d->regions[0].points.stress[k] + first;
    }
    points_update(&d->regions[0].points, first, (int)(d->batches[b].last * SLICE - first), strain, stress);
  }
  return busy_seconds() - start;
}

static double search_seconds(const Domain *d)
{
  Family family;
  use_threads(1);
  FamilySpec spec = {d->family.horizon, influence_at(INFLUENCE_CONSTANT), VOLUME_WHOLE, d->regions[0].type->row_sums};
  double start = busy_seconds();
  family_create(&family, &d->body, &spec, NULL);
  double seconds = busy_seconds() - start;
  family_destroy(&family);
  return seconds;
}

static void measure(breccia_model *model, const Case *c, const int *threads, int threads_count, Times *t)
{
  Domain *d = &model->domain;
  Plain *plain = c->plain ? plain_create(d) : NULL;
  const int64_t steps = (int64_t)(2e7 / (double)d->family.bonds) + 1;
  for (int r = -1; r < REPEATS; ++r) {
    int at = r < 0 ? 0 : r;
    double busy = 0, waited = 0;
    for (int k = threads_count - 1; k >= 0; --k)
      t->step[k][at] = waited = step_seconds(model, threads[k], steps, &busy);
    t->speedup[at] = waited / t->step[threads_count - 1][at];
    t->step[0][at] = busy; /* of one thread */
    t->force[at] = force_seconds(d, 1);
    t->law[at] = law_seconds(d);
    double start = busy_seconds();
    if (plain) c->plain(plain);
    t->plain[at] = plain ? busy_seconds() - start : 0; /* none: exactly nothing, which is told as such */
    t->ratio[at] = t->plain[at] / (t->force[at] - (strcmp(c->law, "elastic") ? t->law[at] : 0));
    t->share[at] = t->step[0][at] / t->force[at];
  }
  t->search = search_seconds(d);
  if (plain) plain_destroy(plain);
}

/** What a machine allows at most. */
typedef struct Ceilings {
  double arithmetic, stream, cache; /* thousand million numbers and bytes a second; bytes */
} Ceilings;

/** Least time of a force evaluation by arithmetic, and by bytes where these do not stay in the caches, in ns a bond. */
typedef struct Floor {
  double arithmetic, bytes;
} Floor;

static Floor floor_of(const Domain *d, const Least *least, const Ceilings *machine)
{
  const double bonds = (double)d->family.bonds, bytes = least->sweeps * (double)family_bytes(&d->family) +
                                                        least->bytes * bonds +
                                                        8 * least->numbers * (double)d->particles->places;
  return (Floor){least->operations / machine->arithmetic, bytes > machine->cache ? bytes / bonds / machine->stream : 0};
}

static size_t formulation_bytes(const Domain *d)
{
  return d->regions[0].type->bytes ? d->regions[0].type->bytes(d->regions[0].formulation) : 0;
}

/** True if forces have the same bits for all numbers of threads. */
static bool same_bits(Domain *d, const int *threads, int threads_count)
{
  const Particles *p = d->particles;
  const size_t bytes = sizeof(double) * (size_t)p->places;
  double *reference = malloc(3 * bytes);
  bool same = reference != NULL;
  for (int k = 0; same && k < threads_count; ++k) {
    force_seconds(d, threads[k]);
    for (int c = 0; c < 3; ++c)
      if (!k)
        memcpy(reference + (int64_t)c * p->places, p->internal.row[c], bytes);
      else
        same &= !memcmp(reference + (int64_t)c * p->places, p->internal.row[c], bytes);
  }
  free(reference);
  return same;
}

static bool is_wanted(const Case *c, const BenchBody *body, char *const *words, int count)
{
  for (int n = 0; n < count; ++n)
    if (!strstr(c->formulation, words[n]) && !strstr(c->law, words[n]) && !strstr(body->name, words[n])) return false;
  return true;
}

int main(int count, char **words)
{
  const int all = all_threads();
  int threads[MOST_THREADS], threads_count = 0;
  for (int t = 1; t < all && threads_count < MOST_THREADS - 1; t *= 2) threads[threads_count++] = t;
  threads[threads_count++] = all;
  const int lanes = lane_kind() == LANES_OF_AVX512 ? 8 : 4;
  const char *path = count > 1 ? words[1] : "bench.csv";
  FILE *csv = fopen(path, "w");
  char folder[] = "/tmp/breccia-bench-XXXXXX";
  if (!csv || !mkdtemp(folder)) {
    fprintf(stderr, "cannot write %s\n", csv ? folder : path);
    return 1;
  }
  char *cloud = text_format("%s/scattered.csv", folder);
  write_scattered(cloud, NULL);
  use_threads(1);
  double flops = multiply_add_rate(), one = stream_bandwidth();
  const Ceilings machine = {arithmetic_rate(), one, last_cache()};
  use_threads(all);
  double many = stream_bandwidth();
  printf("Ceilings of the machine: %.1f GFLOP/s fused multiply-add on one thread, on four lanes; %.1f thousand million "
         "numbers a second by vectors of %s, "
         "which the program takes, half of them fused; triad %.1f GB/s on one thread, %.1f GB/s on %d; %.0f MB in the "
         "last cache.\n\n",
         flops, machine.arithmetic, lanes == 8 ? "eight" : "four", one, many, all, machine.cache / 1e6);
  printf(
      "| formulation, law | horizon / spacing | body | particles | bytes | search | plain | force | floor, arithmetic "
      "| floor, bytes | share | plain / ours | "
      "step | step / force "
      "| step, %d "
      "threads | speed-up | law | bits |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      all);
  fprintf(csv, "lanes,formulation,law,horizon,body,particles,bonds,bytes per bond,search ns per bond,plain ns per "
               "bond,force ns per "
               "bond,floor by arithmetic,floor by bytes,ratio,law ns per point,same bits,speed-up");
  for (int k = 0; k < threads_count; ++k) fprintf(csv, ",step ns per bond on %d threads", threads[k]);
  fprintf(csv, "\n");
  int failed = 0;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c)
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b) {
      if (!is_wanted(&cases[c], &bodies[b], words + 2, count - 2)) continue;
      if (bodies[b].only && strcmp(bodies[b].only, cases[c].formulation)) continue;
      use_threads(all);
      breccia_model *model = load(folder, &bodies[b], &cases[c]);
      if (!model) continue; /* refused, and said: bonds of 1.5 spacings span no space on every lattice */
      static Times t;
      measure(model, &cases[c], threads, threads_count, &t);
      Domain *d = &model->domain;
      const bool bits = same_bits(d, threads, threads_count);
      failed |= !bits;
      const double bonds = (double)d->family.bonds, unit = 1e9 / bonds,
                   bytes = (double)(family_bytes(&d->family) + formulation_bytes(d)) / bonds;
      double step[MOST_THREADS];
      for (int k = 0; k < threads_count; ++k) step[k] = unit * median(t.step[k], REPEATS);
      const double plain = unit * median(t.plain, REPEATS), force = unit * median(t.force, REPEATS),
                   ratio = median(t.ratio, REPEATS), law = 1e9 * median(t.law, REPEATS) / (double)d->particles->count;
      const double speedup = median(t.speedup, REPEATS);
      const bool scattered = !strcmp(bodies[b].name, "scattered");
      const Floor least = floor_of(d, scattered ? &cases[c].scattered : &cases[c].on_lattices, &machine);
      char floors[80] = "– | – | –";
      if (least.arithmetic > 0)
        snprintf(floors, sizeof floors, "%.2f | %.2f | %.0f %%", least.arithmetic, least.bytes,
                 100 * fmax(least.arithmetic, least.bytes) / force);
      printf("| %s, %s | %s | %s | %lld | %.2f | %.0f | %.1f | %.2f | %s | %.1f | %.2f | %.2f | %.2f | %.2f | %.0f | "
             "%s |\n",
             cases[c].formulation, cases[c].law, cases[c].horizon, bodies[b].name, (long long)d->particles->count,
             bytes, unit * t.search, plain, force, floors, ratio, step[0], median(t.share, REPEATS),
             step[threads_count - 1], speedup, law, bits ? "equal" : "DIFFER");
      fprintf(csv, "%d,%s,%s,%s,%s,%lld,%.0f,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%d,%.4g", lanes,
              cases[c].formulation, cases[c].law, cases[c].horizon, bodies[b].name, (long long)d->particles->count,
              bonds, bytes, unit * t.search, plain, force, least.arithmetic, least.bytes, ratio, law, bits, speedup);
      for (int k = 0; k < threads_count; ++k) fprintf(csv, ",%.4g", step[k]);
      fprintf(csv, "\n");
      fflush(stdout);
      breccia_model_destroy(&model);
    }
  fclose(csv);
  remove(cloud);
  rmdir(folder);
  free(cloud);
  printf(
      "\nbytes: per directed bond, beyond what is kept per particle; search: ns per bond to find all families on one "
      "thread; "
      "plain, force, step: ns of processor time per directed bond and step on one thread (plain: scalar neighbour "
      "rows; of "
      "correspondence "
      "elastic and without control); floor: what arithmetic takes at least, and bytes at the bandwidth of one thread "
      "where they do not fit into the last "
      "cache; share: of the time that the greater of them is; plain / ours: the clay's law left out; law: ns per "
      "point; bits: of forces for all "
      "numbers of threads. Medians of %d, taken in turn.\n",
      REPEATS);
  return failed;
}
