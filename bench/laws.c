/* What a point costs: updates of each constitutive law on one thread, with all, half and no points plastic, beside what moving their
 * numbers through the memory would take. A Markdown table goes to stdout. */
#include "measure.h"

#include "base/random.h"
#include "points/points.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 1 << 17, FEW = 1 << 11, STEPS = 8, MOST_WORDS = 12 };

typedef struct Sample {
  const char *law, *words[MOST_WORDS]; /* m, kN */
  double strain;                       /* at which the law begins to yield, about */
} Sample;

#define CONCRETE                                                                                                       \
  "Young modulus=30e6", "Poisson ratio=0.2", "tensile strength=3000", "fracture energy=0.1", "length=0.03"
static const Sample samples[] = {
    {"elastic", {"Young modulus=30e6", "Poisson ratio=0.2"}, 1e-4},
    {"j2", {"Young modulus=2e8", "Poisson ratio=0.3", "yield stress=2e5", "hardening modulus=1e6"}, 1e-3},
    {"viscoelastic", {"Young modulus=2e8", "Poisson ratio=0.3", "relaxing share=0.6", "relaxation time=1"}, 1e-3},
    {"multi-yield-j2", {"shear modulus=60000", "bulk modulus=100000", "octahedral strength=30"}, 2e-5},
    {"cap",
     {"bulk modulus=14478996", "shear modulus=11721092", "cap position=110320", "compaction rate=4.6412e-7",
      "largest compaction=0.42", "cap ratio=4.43", "envelope drop=7997.9", "envelope slope=0.11",
      "envelope rate=6.3816e-5", "envelope strength=2.6614e4", "tension cut-off=2068.4"},
     1e-3},
    {"drucker-prager", {"Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30"}, 1e-3},
    {"mohr-coulomb",
     {"Young modulus=50e3", "Poisson ratio=0.3", "cohesion=20", "friction angle=30", "dilation angle=30",
      "tensile strength=34.64"},
     1e-3},
    {"bounding-surface-clay",
     {"shear modulus=60000", "bulk modulus=100000", "undrained strength=30", "hardening modulus=60000"},
     1e-4},
    {"damage-plasticity", {CONCRETE, "compressive strength=34000"}, 1e-4},
    {"mazars", {CONCRETE}, 1e-4},
    {"link-damage",
     {"Young modulus=30e6", "Poisson ratio=0.2", "tensile stretch=1e-4", "fracture energy=0.1", "length=0.03"},
     1e-4},
    {"elastic-1d", {"Young modulus=30e6"}, 1e-4},
    {"bilinear-softening", {"Young modulus=30e6", "tensile strength=3000", "fracture energy=0.1", "length=0.03"}, 1e-4},
    {"trilinear-softening",
     {"Young modulus=30e6", "tensile strength=3000", "fracture energy=0.1", "length=0.03"},
     1e-4},
    {"exponential-softening",
     {"Young modulus=30e6", "tensile strength=3000", "fracture energy=0.1", "length=0.03"},
     1e-4},
    {"fib-concrete",
     {"Young modulus=30e6", "tensile strength=3000", "fracture energy=0.1", "length=0.03", "compressive strength=30e3"},
     1e-4},
    {"elastic-brittle", {"Young modulus=30e6", "tensile strength=3000"}, 1e-4},
    {"kent-scott-park", {"compressive strength=30e3"}, 1e-4},
    {"concrete02", {"compressive strength=30e3"}, 1e-4},
    {"mander", {"compressive strength=30e3", "Young modulus=32e6"}, 1e-4},
    {"elastic-perfectly-plastic", {"Young modulus=2e8", "yield stress=4e5"}, 2e-3},
    {"steel-bilinear", {"Young modulus=2e8", "yield stress=4e5"}, 2e-3},
    {"menegotto-pinto", {"Young modulus=2e8", "yield stress=4e5"}, 2e-3},
};

typedef struct LawPoints {
  Material material;
  int components, count;
  double *strain[6], *stress[6], *committed, *trial, *direction[6];
  uint8_t *plastic;
} LawPoints;

static double *numbers(size_t count)
{
  double *values = calloc(count + 1, sizeof(double));
  if (!values) abort();
  return values;
}

/** Half of the directions are compression with shear, so that laws with pressure see both their cones and their caps. */
static void prepare(LawPoints *b, const Sample *sample, const Units *units, double share, int points)
{
  breccia_error *error = breccia_error_create();
  int count = 0;
  while (count < MOST_WORDS && sample->words[count]) ++count;
  if (material_from_words(&b->material, law_find(NULL, sample->law), sample->words, count, units, "", error)) {
    fprintf(stderr, "%s\n", breccia_error_text(error));
    abort();
  }
  breccia_error_destroy(&error);
  b->count = points;
  const size_t values = (size_t)b->material.history_values;
  b->components = b->material.law->components;
  b->committed = numbers(values * (size_t)points);
  b->trial = numbers(values * (size_t)points);
  b->plastic = malloc((size_t)points);
  uint64_t seed = 5;
  for (int k = 0; k < b->components; ++k) {
    b->strain[k] = numbers((size_t)points);
    b->stress[k] = numbers((size_t)points);
    b->direction[k] = numbers((size_t)points);
  }
  for (int i = 0; i < points; ++i) {
    const double pressed = random_uniform(&seed) < 0.5 ? -0.7 : 0;
    for (int k = 0; k < b->components; ++k)
      b->direction[k][i] = 2 * (random_uniform(&seed) - 0.5) + (k < 3 && b->components > 1 ? pressed : 0);
    b->plastic[i] = random_uniform(&seed) < share;
    if (!b->material.law->begin) continue;
    b->material.law->begin(b->material.constants, b->committed + values * (size_t)i);
    b->material.law->begin(b->material.constants, b->trial + values * (size_t)i);
  }
}

static void release(LawPoints *b)
{
  for (int k = 0; k < b->components; ++k) {
    free(b->strain[k]);
    free(b->stress[k]);
    free(b->direction[k]);
  }
  free(b->committed);
  free(b->trial);
  free(b->plastic);
  material_destroy(&b->material);
}

/** Plastic points are strained on from step to step, the others go up and down within a twentieth of the yield strain. */
static double step(LawPoints *b, double yield, int number)
{
  for (int i = 0; i < b->count; ++i) {
    const double size = yield * (b->plastic[i] ? 4 + 0.02 * number : number % 2 ? 0.05 : 0.02);
    for (int k = 0; k < b->components; ++k) b->strain[k][i] = size * b->direction[k][i];
  }
  const ptrdiff_t values = b->material.history_values;
  const double start = busy_seconds();
  for (int first = 0; first < b->count; first += BATCH) {
    breccia_batch batch = {.size = sizeof(breccia_batch),
                           .count = BATCH,
                           .committed = b->committed + values * first,
                           .trial = b->trial + values * first};
    for (int k = 0; k < b->components; ++k) {
      batch.strain[k] = b->strain[k] + first;
      batch.stress[k] = b->stress[k] + first;
    }
    b->material.law->update(b->material.constants, &batch);
  }
  const double seconds = busy_seconds() - start;
  double *other = b->committed;
  b->committed = b->trial;
  b->trial = other;
  return seconds;
}

/** Names a law that is not measured; NULL: all are. */
static const char *forgotten(void)
{
  for (int k = 0; breccia_law_at(k); ++k) {
    bool known = false;
    for (size_t s = 0; s < sizeof samples / sizeof *samples; ++s)
      known |= !strcmp(samples[s].law, breccia_law_at(k)->name);
    if (!known) return breccia_law_at(k)->name;
  }
  return NULL;
}

int main(void)
{
  breccia_error *error = breccia_error_create();
  if (forgotten()) {
    fprintf(stderr, "the law '%s' has no row here\n", forgotten());
    return 1;
  }
  Units *units = units_create("m", "kN", "s", error);
  use_threads(1);
  const double bandwidth = stream_bandwidth();
  printf("| law | elastic | half plastic | all plastic | few, elastic | few, plastic | memory "
         "|\n|---|---|---|---|---|---|---|\n");
  for (size_t s = 0; s < sizeof samples / sizeof *samples; ++s) {
    enum { WAYS = 5 };
    static const double shares[WAYS] = {0, 0.5, 1, 0, 1};
    double seconds[WAYS][REPEATS], nanoseconds[WAYS], memory = 0;
    LawPoints batch[WAYS];
    for (int way = 0; way < WAYS; ++way) {
      prepare(&batch[way], &samples[s], units, shares[way], way < 3 ? POINTS : FEW);
      for (int n = 0; n < STEPS; ++n) step(&batch[way], samples[s].strain, n);
    }
    for (int r = 0; r < REPEATS; ++r)
      for (int way = 0; way < WAYS; ++way) {
        const int runs = batch[way].count == FEW ? 4 : 1; /* the first bring few points back into the caches */
        for (int run = 0; run < runs; ++run)
          seconds[way][r] = step(&batch[way], samples[s].strain, STEPS + runs * r + run);
      }
    memory = 1e-9 * 8 * (2 * batch[0].components + 2 * batch[0].material.history_values) / bandwidth;
    for (int way = 0; way < WAYS; ++way) {
      nanoseconds[way] = 1e9 * median(seconds[way], REPEATS) / batch[way].count;
      release(&batch[way]);
    }
    printf("| %s | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f |\n", samples[s].law, nanoseconds[0], nanoseconds[1],
           nanoseconds[2], nanoseconds[3], nanoseconds[4], 1e9 * memory);
    fflush(stdout);
  }
  printf("\nns of processor time per point on one thread, medians of %d: points that stay elastic, half of them and "
         "all of them "
         "straining on beyond "
         "yield, of %d points; the same of %d points, whose numbers stay in the caches; memory: what moving strain, "
         "stress and both "
         "histories takes at %.1f GB/s (triad).\n",
         REPEATS, POINTS, FEW, bandwidth);
  units_destroy(&units);
  breccia_error_destroy(&error);
  return 0;
}
