#include "body/vector.h"

#include "base/team.h"
#include "body/particles.h"
#include <math.h>
#include <string.h>

static bool vector_make(Vector *v, const VectorSpace *space, double *(*array)(int64_t, const char *, Error *),
                        const char *label, Error *error)
{
  *v = (Vector){.space = space};
  for (int k = 0; k < space->rows; ++k)
    if (!(v->row[k] = array(space->places, label, error))) return false;
  return true;
}

bool vector_create(Vector *v, const VectorSpace *space, const char *label, Error *error)
{
  return vector_make(v, space, places_array, label, error);
}

bool vector_reserve(Vector *v, const VectorSpace *space, const char *label, Error *error)
{
  return vector_make(v, space, places_reserved, label, error);
}

void vector_destroy(Vector *v)
{
  for (int k = 0; k < MAX_ROWS; ++k) places_free(&v->row[k]);
}

size_t vector_bytes(const VectorSpace *space)
{
  return sizeof(double) * (size_t)space->rows * (size_t)space->places;
}

/* ---- passes over all places ---- */

typedef struct Pass {
  const VectorSpace *space;
  TileWork work;
  TileSums part;
  void *context;
  int count;
} Pass;

static void pass_work(void *context, int64_t n)
{
  const Pass *pass = context;
  const Batch *tile = &pass->space->tiles[n];
  pass->work(pass->context, tile->first * SLICE, tile->last * SLICE);
}

void vector_each_tile(const VectorSpace *space, TileWork work, void *context)
{
  team_each(space->tile_count, pass_work, &(Pass){.space = space, .work = work, .context = context});
}

static void pass_sums(void *context, int64_t n)
{
  const Pass *pass = context;
  const Batch *tile = &pass->space->tiles[n];
  double *sums = pass->space->sums + n * pass->count;
  for (int k = 0; k < pass->count; ++k) sums[k] = 0;
  pass->part(pass->context, tile->first * SLICE, tile->last * SLICE, sums);
}

void vector_sum_tiles(const VectorSpace *space, TileSums part, void *context, int count, double *sums)
{
  team_each(space->tile_count, pass_sums, &(Pass){.space = space, .part = part, .context = context, .count = count});
  for (int k = 0; k < count; ++k) sums[k] = 0;
  for (int64_t n = 0; n < space->tile_count; ++n)
    for (int k = 0; k < count; ++k) sums[k] += space->sums[n * count + k];
}

double vector_largest_of_tiles(const VectorSpace *space, TileSums part, void *context)
{
  double largest = 0;
  team_each(space->tile_count, pass_sums, &(Pass){.space = space, .part = part, .context = context, .count = 1});
  for (int64_t n = 0; n < space->tile_count; ++n) largest = fmax(largest, space->sums[n]);
  return largest;
}

/* ---- elementwise ---- */

/** Operands of a pass, and the rows that it takes. */
typedef struct Operands {
  const Vector *a, *b, *c, *mass;
  const double *weight;
  double own, factor;
  int from, to;
} Operands;

static void vector_clear_tile(void *context, int64_t first, int64_t last)
{
  const Operands *o = context;
  for (int k = 0; k < o->a->space->rows; ++k) memset(o->a->row[k] + first, 0, sizeof(double) * (size_t)(last - first));
}

void vector_clear(const Vector *v)
{
  vector_each_tile(v->space, vector_clear_tile, &(Operands){.a = v});
}

static void vector_copy_tile(void *context, int64_t first, int64_t last)
{
  const Operands *o = context;
  for (int k = 0; k < o->a->space->rows; ++k)
    memcpy(o->a->row[k] + first, o->b->row[k] + first, sizeof(double) * (size_t)(last - first));
}

void vector_copy(const Vector *to, const Vector *from)
{
  vector_each_tile(to->space, vector_copy_tile, &(Operands){.a = to, .b = from});
}

BRECCIA_CLONES
static void vector_combine_tile(void *context, int64_t first, int64_t last)
{
  const Operands *o = context;
  const Lanes own = lanes_set(o->own), factor = lanes_set(o->factor);
  for (int k = 0; k < o->a->space->rows; ++k)
    for (int64_t i = first; i < last; i += LANES) {
      Lanes sum = factor * lanes_load(o->b->row[k] + i);
      if (o->own != 0) sum += own * lanes_load(o->a->row[k] + i);
      lanes_store(o->a->row[k] + i, sum);
    }
}

void vector_combine(double own, const Vector *a, double factor, const Vector *b)
{
  vector_each_tile(a->space, vector_combine_tile, &(Operands){.a = a, .b = b, .own = own, .factor = factor});
}

typedef struct TermsPass {
  const Vector *to;
  const VectorTerms *terms;
} TermsPass;

BRECCIA_CLONES
static void vector_sum_terms_tile(void *context, int64_t first, int64_t last)
{
  const TermsPass *pass = context;
  const VectorTerms *t = pass->terms;
  for (int k = 0; k < pass->to->space->rows; ++k)
    for (int64_t i = first; i < last; i += LANES) {
      Lanes sum = lanes_set(t->factor[0]) * lanes_load(t->of[0]->row[k] + i);
      for (int n = 1; n < 3; ++n) sum += lanes_set(t->factor[n]) * lanes_load(t->of[n]->row[k] + i);
      lanes_store(pass->to->row[k] + i, sum);
    }
}

void vector_sum_terms(const Vector *a, const VectorTerms *terms)
{
  vector_each_tile(a->space, vector_sum_terms_tile, &(TermsPass){a, terms});
}

void vector_scale(const Vector *a, double factor)
{
  vector_combine(0, a, factor, a);
}

/* Numbers of the operands at the place of a pass. */
#define A lanes_load(o->a->row[k] + i)
#define B lanes_load(o->b->row[k] + i)
#define C lanes_load(o->c->row[k] + i)
#define W lanes_load(o->weight + i)

/** Defines a pass that sets a to `value`, place by place. */
#define ELEMENTWISE(name, value)                                                                                       \
  BRECCIA_CLONES                                                                                                       \
  static void name(void *context, int64_t first, int64_t last)                                                         \
  {                                                                                                                    \
    const Operands *o = context;                                                                                       \
    for (int k = 0; k < o->a->space->rows; ++k)                                                                        \
      for (int64_t i = first; i < last; i += LANES) lanes_store(o->a->row[k] + i, value);                              \
  }

ELEMENTWISE(vector_weigh_tile, W *B)
ELEMENTWISE(vector_add_weighted_tile, A + W * B)
ELEMENTWISE(vector_weigh_sum_tile, W *(B + C))
ELEMENTWISE(vector_weigh_product_tile, B *W *C)

void vector_weigh(const Vector *a, const double *weight, const Vector *b)
{
  vector_each_tile(a->space, vector_weigh_tile, &(Operands){.a = a, .b = b, .weight = weight});
}

void vector_add_weighted(const Vector *a, const double *weight, const Vector *b)
{
  vector_each_tile(a->space, vector_add_weighted_tile, &(Operands){.a = a, .b = b, .weight = weight});
}

void vector_weigh_sum(const Vector *a, const double *weight, const Vector *b, const Vector *c)
{
  vector_each_tile(a->space, vector_weigh_sum_tile, &(Operands){.a = a, .b = b, .c = c, .weight = weight});
}

void vector_weigh_product(const Vector *a, const double *weight, const Vector *b, const Vector *c)
{
  vector_each_tile(a->space, vector_weigh_product_tile, &(Operands){.a = a, .b = b, .c = c, .weight = weight});
}

/* ---- sums and extremes ---- */

/** Defines the sum of `value` over the rows o->from to o->to - 1 of a tile. */
#define SUMMED(name, value)                                                                                            \
  BRECCIA_CLONES                                                                                                       \
  static double name(const Operands *o, int64_t first, int64_t last)                                                   \
  {                                                                                                                    \
    Lanes sum = {0};                                                                                                   \
    for (int k = o->from; k < o->to; ++k)                                                                              \
      for (int64_t i = first; i < last; i += LANES) sum += value;                                                      \
    return lanes_total(sum);                                                                                           \
  }

SUMMED(vector_inner_rows, A *B)
SUMMED(vector_inner_weighted_rows, W *A *C)
SUMMED(vector_inner_both_rows, W *(A + B) * C)
SUMMED(vector_inner_mass_rows, lanes_load(o->mass->row[k] + i) * W * A * B)

static void vector_inner_tile(void *context, int64_t first, int64_t last, double *sum)
{
  const Operands *o = context;
  Operands turning = *o;
  turning.from = o->to;
  turning.to = o->a->space->rows;
  *sum = vector_inner_rows(o, first, last);
  if (turning.from < turning.to) *sum += o->factor * vector_inner_rows(&turning, first, last);
}

double vector_inner(const Vector *a, const Vector *b, double turning)
{
  double sum;
  vector_sum_tiles(a->space, vector_inner_tile,
                   &(Operands){.a = a, .b = b, .factor = turning, .to = a->space->rotation}, 1, &sum);
  return sum;
}

static void vector_inner_weighted_tile(void *context, int64_t first, int64_t last, double *sum)
{
  const Operands *o = context;
  *sum = o->b ? vector_inner_both_rows(o, first, last) : vector_inner_weighted_rows(o, first, last);
}

double vector_inner_weighted(const double *weight, const Vector *a, const Vector *b, const Vector *c)
{
  double sum;
  vector_sum_tiles(a->space, vector_inner_weighted_tile,
                   &(Operands){.a = a, .b = b, .c = c, .weight = weight, .to = a->space->rows}, 1, &sum);
  return sum;
}

static void vector_inner_mass_tile(void *context, int64_t first, int64_t last, double *sum)
{
  *sum = vector_inner_mass_rows(context, first, last);
}

double vector_inner_mass(const double *weight, const Vector *mass, const Vector *a, const Vector *b)
{
  double sum;
  vector_sum_tiles(a->space, vector_inner_mass_tile,
                   &(Operands){.a = a, .b = b, .mass = mass, .weight = weight, .to = a->space->rows}, 1, &sum);
  return sum;
}

static void vector_largest_tile(void *context, int64_t first, int64_t last, double *largest)
{
  const Operands *o = context;
  for (int k = o->from; k < o->to; ++k)
    for (int64_t i = first; i < last; ++i) *largest = fmax(*largest, fabs(o->a->row[k][i]));
}

double vector_largest(const Vector *v)
{
  return vector_largest_of_tiles(v->space, vector_largest_tile, &(Operands){.a = v, .to = v->space->rotation});
}

double vector_largest_rotation(const Vector *v)
{
  return vector_largest_of_tiles(v->space, vector_largest_tile,
                                 &(Operands){.a = v, .from = v->space->rotation, .to = v->space->rows});
}

static void vector_count_tile(void *context, int64_t first, int64_t last, double *count)
{
  const Operands *o = context;
  for (int k = 0; k < o->a->space->rows; ++k)
    for (int64_t i = first; i < last && *count == 0; ++i) *count = o->a->row[k][i] != 0;
}

bool vector_is_zero(const Vector *v)
{
  double count;
  vector_sum_tiles(v->space, vector_count_tile, &(Operands){.a = v}, 1, &count);
  return count == 0;
}

double vector_spread(const Vector *v, const int32_t *number)
{
  double square = 0;
  for (int k = 0; k < v->space->rotation; ++k) {
    double least = INFINITY, most = -INFINITY;
    for (int64_t i = 0; i < v->space->places; ++i) {
      if (number[i] < 0) continue;
      least = fmin(least, v->row[k][i]);
      most = fmax(most, v->row[k][i]);
    }
    square += (most - least) * (most - least);
  }
  return sqrt(square);
}
