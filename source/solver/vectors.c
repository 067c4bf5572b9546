#include "solver/vectors.h"

#include "base/team.h"
#include <math.h>
#include <string.h>

bool vectors_make(double *vector[MOTIONS], const Particles *p, const char *label, Error *error)
{
  for (int k = 0; k < MOTIONS; ++k) vector[k] = NULL;
  for (int k = 0; k < p->motions; ++k)
    if (!(vector[k] = places_array(p->places, label, error))) return false;
  return true;
}

void vectors_free(double *vector[MOTIONS])
{
  for (int k = 0; k < MOTIONS; ++k) places_free(&vector[k]);
}

size_t vectors_bytes(const Particles *p)
{
  return sizeof(double) * (size_t)p->motions * (size_t)p->places;
}

void vectors_clear(double *const vector[MOTIONS], const Particles *p)
{
  for (int k = 0; k < p->motions; ++k) memset(vector[k], 0, sizeof(double) * (size_t)p->places);
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
  for (int k = 0; k < s->domain->particles->motions; ++k)
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

void vectors_combine(const Domain *d, double own, double *const a[MOTIONS], double factor, double *const b[MOTIONS])
{
  team_each(d->batch_count, combine_batch, &(Sum){d, a, b, own, factor});
}

double vectors_apart(const Particles *p, double *const vector[MOTIONS])
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
