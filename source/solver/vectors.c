#include "solver/vectors.h"

#include "base/team.h"
#include <math.h>
#include <string.h>

bool vectors_make(double *vector[3], int64_t places, const char *label, Error *error)
{
  for (int k = 0; k < 3; ++k)
    if (!(vector[k] = places_array(places, label, error))) return false;
  return true;
}

void vectors_free(double *vector[3])
{
  for (int k = 0; k < 3; ++k) places_free(&vector[k]);
}

void vectors_clear(double *const vector[3], int64_t places)
{
  for (int k = 0; k < 3; ++k) memset(vector[k], 0, sizeof(double) * (size_t)places);
}

typedef struct Sum {
  const Domain *domain;
  double *const *a, *const *b;
  double own, factor;
} Sum;

BRECCIA_CLONES
static void combine(const Sum *s, int64_t first, int64_t last)
{
  const Lanes own = lanes_set(s->own), factor = lanes_set(s->factor);
  for (int k = 0; k < 3; ++k)
    for (int64_t i = first; i < last; i += LANES) {
      Lanes sum = factor * lanes_load(s->b[k] + i);
      if (s->own != 0) sum += own * lanes_load(s->a[k] + i);
      lanes_store(s->a[k] + i, sum);
    }
}

static void combine_batch(void *context, int64_t b)
{
  const Sum *s = context;
  const Batch *batch = &s->domain->batches[b];
  combine(s, batch->first * SLICE, batch->last * SLICE);
}

void vectors_combine(const Domain *d, double own, double *const a[3], double factor, double *const b[3])
{
  team_each(d->batch_count, combine_batch, &(Sum){d, a, b, own, factor});
}

double vectors_apart(const Particles *p, double *const vector[3])
{
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    double least = INFINITY, most = -INFINITY;
    for (int64_t i = 0; i < p->places; ++i) {
      if (p->number[i] < 0) continue;
      least = fmin(least, vector[k][i]);
      most = fmax(most, vector[k][i]);
    }
    square += (most - least) * (most - least);
  }
  return sqrt(square);
}
