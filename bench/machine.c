#include "measure.h"

#include "base/cores.h"
#include "base/lane_kinds.h"
#include "base/lanes.h"
#include "base/team.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

double busy_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int all_threads(void)
{
  return cores_available();
}

void use_threads(int threads)
{
  static Team *team;
  if (team && team_threads(team) == threads) return;
  team_use(NULL);
  team_destroy(&team);
  team = team_create(threads, NULL);
  team_use(team);
}

static int by_value(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

double median(double *values, int count)
{
  qsort(values, (size_t)count, sizeof *values, by_value);
  return values[count / 2];
}

typedef struct Triad {
  double *a, *b, *c;
  bool first; /* writes all three, so that each lies near the thread that works on it */
} Triad;

enum { TRIAD = 1 << 24 };

static void triad(void *context)
{
  const Triad *t = context;
  double *a = t->a, *b = t->b, *c = t->c;
  if (t->first)
    TEAM_FOR (i, TRIAD) a[i] = b[i] = c[i] = 1;
  else
    TEAM_FOR (i, TRIAD) a[i] = b[i] + 3 * c[i];
}

double stream_bandwidth(void)
{
  const size_t bytes = sizeof(double) * TRIAD;
  Triad t = {malloc(bytes), malloc(bytes), malloc(bytes), false};
  if (!t.a || !t.b || !t.c) return NAN;
  double seconds[REPEATS];
  for (int r = -1; r < REPEATS; ++r) {
    double start = clock_seconds();
    t.first = r < 0;
    team_run(triad, &t);
    if (r >= 0) seconds[r] = clock_seconds() - start;
  }
  double rate = 3 * (double)bytes / median(seconds, REPEATS) / 1e9 + 0 * t.a[TRIAD / 2];
  free(t.a);
  free(t.b);
  free(t.c);
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

double multiply_add_rate(void)
{
  const int64_t rounds = 20000000;
  double seconds[REPEATS], sink = 0;
  for (int r = 0; r < REPEATS; ++r) {
    double start = busy_seconds();
    sink += multiply_add(rounds);
    seconds[r] = busy_seconds() - start;
  }
  return 2.0 * 10 * LANES * (double)rounds / median(seconds, REPEATS) / 1e9 + 0 * sink;
}

/* As many chains as hide how long an operation takes and fit into the registers; in turn fused and plain ones, for which processors may have units of
 * their own. */
enum { FOUR_CHAINS = 6, EIGHT_CHAINS = 8 };
#define ARITHMETIC(name, lanes, CHAINS)                                                                                \
  double name(int64_t rounds)                                                                                          \
  {                                                                                                                    \
    typedef double Wide __attribute__((vector_size(8 * (lanes))));                                                     \
    Wide fused[CHAINS], plain[CHAINS], x = (Wide){0} + 1.000000001, y = (Wide){0} + 1e-9;                              \
    for (int k = 0; k < CHAINS; ++k) fused[k] = plain[k] = (Wide){0} + k;                                              \
    for (int64_t r = 0; r < rounds; ++r)                                                                               \
      for (int k = 0; k < CHAINS; ++k) {                                                                               \
        fused[k] = fused[k] * x + y;                                                                                   \
        plain[k] = plain[k] + y;                                                                                       \
      }                                                                                                                \
    double total = 0;                                                                                                  \
    for (int k = 0; k < CHAINS; ++k)                                                                                   \
      for (int l = 0; l < (lanes); ++l) total += fused[k][l] + plain[k][l];                                            \
    return total;                                                                                                      \
  }
#ifdef __x86_64__
#define OF_PROCESSORS(words) __attribute__((target(words)))
#else
#define OF_PROCESSORS(words)
#endif
OF_PROCESSORS("avx512f,fma") static ARITHMETIC(arithmetic_of_eight, 8, EIGHT_CHAINS);
OF_PROCESSORS("avx2,fma") static ARITHMETIC(arithmetic_of_four, 4, FOUR_CHAINS);

double arithmetic_rate(void)
{
  const int64_t rounds = 4000000;
  const bool eight = lane_kind() == LANES_OF_AVX512;
  double seconds[REPEATS], sink = 0;
  for (int r = 0; r < REPEATS; ++r) {
    double start = busy_seconds();
    sink += eight ? arithmetic_of_eight(rounds) : arithmetic_of_four(rounds);
    seconds[r] = busy_seconds() - start;
  }
  return 2.0 * (eight ? EIGHT_CHAINS * 8 : FOUR_CHAINS * 4) * (double)rounds / median(seconds, REPEATS) / 1e9 +
         0 * sink;
}

double last_cache(void)
{
  double kilobytes = 0;
  for (int level = 2; level < 4; ++level) { /* entries 0 and 1 are of the first level */
    char name[64], words[32] = "";
    snprintf(name, sizeof name, "/sys/devices/system/cpu/cpu0/cache/index%d/size", level);
    FILE *file = fopen(name, "r");
    if (file && fgets(words, sizeof words, file)) kilobytes = strtod(words, NULL);
    if (file) fclose(file);
  }
  return 1024 * kilobytes;
}
