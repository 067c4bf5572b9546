/* Points of laws in space side by side, a point a lane: those that are surely elastic are done with at once, the others are lined up, so that all lanes have
 * work, and go through the law's own step together. A point's numbers do not depend on the points beside it, nor on how many lanes there are. */
#ifndef BRECCIA_CONSTITUTIVE_SOLID_LANES_H
#define BRECCIA_CONSTITUTIVE_SOLID_LANES_H

#include "base/lane_kinds.h"
#include "base/lanes.h"
#include "constitutive/solid/solid_law.h"

/* Long parts of a step that one call does for many points: within each of their callers they take long to compile. */
#define LANES_OUTLINE static __attribute__((noinline))

enum { MOST_HISTORY = 13, SOLID_CHUNK = 128, SOLID_GROUPS = 4 };

/** `update` of a law that is compiled for each kind of vectors, and how it is chosen: LANES_CHOICE(SolidUpdate, name). */
typedef int SolidUpdate(const void *constants, const breccia_batch *batch);

/** Elastic trial of points: first invariant, deviator and its norm. */
typedef struct TrialLanes {
  Lanes invariant, s[6], length;
} TrialLanes;

/** Bound of principal stresses, for points so far inside that no decomposition is needed: none is larger than a third of the invariant and
 *  2 r, the largest less the smallest no more than 2 sqrt(3) r. @return r = sqrt(J2 / 3) */
LANES_INLINE Lanes trial_radius(const TrialLanes *t)
{
  return t->length * lanes_set(1 / sqrt(6));
}

/** @return the sum of squares of all components of the elastic strain, which is at least that of the principal ones that stretch */
LANES_INLINE Lanes trial_strain_square(const Elasticity *e, const TrialLanes *t)
{
  const Lanes deviator = t->length * lanes_set(1 / (2 * e->shear)),
              mean = t->invariant * lanes_set(sqrt(3) / (9 * e->bulk));
  return lanes_square(deviator, mean, lanes_set(0));
}

/** @param[in] history  committed
 *  @param[out] found  the points that are inside their yield surface for sure; a point's answer must not depend on the points beside it */
typedef void (*SolidInside)(const void *constants, const TrialLanes *trial, const Lanes *history, LaneMask *found);

/** Points that the sieve leaves. */
typedef struct SolidLanes {
  Lanes strain[6], committed[MOST_HISTORY];
  /* Out: all of them; a stress that is no number tells that a point could not be integrated. Tangents of points that are wanted, [6][6] to engineering shear
   * strains. */
  Lanes stress[6], trial[MOST_HISTORY];
  double *tangent[LANES];
} SolidLanes;

/** @param[in] tangents  whether they are wanted: a constant where it is asked */
typedef void (*SolidStep)(const void *constants, SolidLanes *points, bool tangents);
/** The same of some groups of points, so that a processor that waits for one has others to work on. */
typedef void (*SolidSteps)(const void *constants, SolidLanes *points, int groups, bool tangents);

LANES_INLINE Lanes lanes_trace(const Lanes a[6])
{
  return a[XX] + a[YY] + a[ZZ];
}

LANES_INLINE Lanes lanes_norm(const Lanes a[6])
{
  return lanes_root(lanes_square(a[0], a[1], a[2]) + lanes_set(2) * lanes_square(a[3], a[4], a[5]));
}

/** Stress of an elastic strain: first invariant, deviator and its norm. */
LANES_INLINE void elastic_trial_lanes(const Elasticity *e, const Lanes strain[6], TrialLanes *t)
{
  const Lanes twice = lanes_set(2 * e->shear), volume = lanes_trace(strain),
              mean = lanes_product(volume, lanes_set(1.0 / 3));
  for (int k = 0; k < 6; ++k) t->s[k] = lanes_product(twice, k < 3 ? strain[k] - mean : strain[k]);
  t->invariant = lanes_product(lanes_set(3 * e->bulk), volume);
  t->length = lanes_norm(t->s);
}

/** The elastic trial of points whose history begins with the plastic strain. */
LANES_INLINE void plastic_trial_lanes(const Elasticity *e, const SolidLanes *p, TrialLanes *t)
{
  Lanes elastic[6];
  for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[k];
  elastic_trial_lanes(e, elastic, t);
}

LANES_INLINE void elastic_stress_lanes(const Elasticity *e, const Lanes strain[6], Lanes stress[6])
{
  const Lanes twice = lanes_set(2 * e->shear),
              volume = lanes_product(lanes_set(e->bulk - 2 * e->shear / 3), lanes_trace(strain));
  for (int k = 0; k < 6; ++k) stress[k] = k < 3 ? twice * strain[k] + volume : twice * strain[k];
}

/** Plastic strain that leaves a stress of first invariant I and deviator s at a strain. */
LANES_INLINE void plastic_rest_lanes(const Elasticity *e, const Lanes strain[6], Lanes invariant, const Lanes s[6],
                                     Lanes plastic[6])
{
  const Lanes half = lanes_set(1 / (2 * e->shear)), share = lanes_product(invariant, lanes_set(1 / (9 * e->bulk)));
  for (int k = 0; k < 6; ++k) {
    plastic[k] = strain[k] - s[k] * half;
    if (k < 3) plastic[k] -= share;
  }
}

/** Plastic strain that leaves a stress at a strain. */
LANES_INLINE void plastic_strain_lanes(const Elasticity *e, const Lanes strain[6], const Lanes stress[6],
                                       Lanes plastic[6])
{
  const Lanes half = lanes_set(1 / (2 * e->shear)),
              share = lanes_product(lanes_set(1 / (9 * e->bulk) - 1 / (6 * e->shear)), lanes_trace(stress));
  for (int k = 0; k < 6; ++k) {
    plastic[k] = strain[k] - stress[k] * half;
    if (k < 3) plastic[k] -= share;
  }
}

/** Tangents to where they are wanted. */
LANES_INLINE void store_tangents(const Lanes tangent[36], double *const to[LANES])
{
  double numbers[36][LANES];
  for (int k = 0; k < 36; ++k) lanes_store(numbers[k], tangent[k]);
  for (int l = 0; l < LANES; ++l)
    for (int k = 0; k < 36; ++k) to[l][k] = numbers[k][l];
}

/** Some points of a batch, and those of them that are left after the sieve. */
typedef struct SolidChunk {
  const breccia_batch *batch;
  int first, count, values;
  /* Of those that are left: tensors of strain, committed history, then stress in the place of strain; which point it is, and bits of them for each vector of
   * the chunk. */
  double strain[6][SOLID_CHUNK + LANES], history[MOST_HISTORY][SOLID_CHUNK + LANES];
  int32_t at[SOLID_CHUNK + LANES];
  uint8_t bits[SOLID_CHUNK / LANES];
  int left;
} SolidChunk;

/** Rows of history, turned round. @param[in] values  of a row, two or more: a constant */
LANES_INLINE void load_rows(const double *from, int values, const int32_t *at, Lanes *out)
{
  if (values == 2) lanes_gather_pairs(from, at, out);
  for (int k = 0; values == 3 && k < 3; ++k) {
    double column[LANES];
    for (int l = 0; l < LANES; ++l) column[l] = from[3 * (ptrdiff_t)at[l] + k];
    out[k] = lanes_load(column);
  }
  for (int k = 0; k + QUAD <= values; k += QUAD) lanes_gather_rows(from + k, values, at, out + k);
  if (values > QUAD && values % QUAD) lanes_gather_rows(from + values - QUAD, values, at, out + values - QUAD);
}

/** Loads rows of three numbers that follow each other, turned round. */
LANES_INLINE void load_triples(const double *from, Lanes *out)
{
  double columns[3][LANES];
  for (int first = 0; first < LANES; first += QUAD, from += 3 * QUAD) {
    const Quad a = quad_load(from), b = quad_load(from + QUAD), c = quad_load(from + 2 * QUAD);
    const Quad leading = __builtin_shufflevector(a, b, 0, 3, 6, 6), middle = __builtin_shufflevector(a, b, 1, 4, 7, 7),
               last = __builtin_shufflevector(a, b, 2, 5, 5, 5);
    quad_store(columns[0] + first, __builtin_shufflevector(leading, c, 0, 1, 2, 5));
    quad_store(columns[1] + first, __builtin_shufflevector(middle, c, 0, 1, 2, 6));
    quad_store(columns[2] + first, __builtin_shufflevector(last, c, 0, 1, 4, 7));
  }
  for (int k = 0; k < 3; ++k) out[k] = lanes_load(columns[k]);
}

/** The reverse, of four numbers of rows that are all different. */
LANES_INLINE void store_quads(const double turned[QUAD][LANES], int values, const int32_t *at, double *to)
{
  for (int first = 0; first < LANES; first += QUAD) {
    const Quad a = quad_load(turned[0] + first), b = quad_load(turned[1] + first), c = quad_load(turned[2] + first),
               d = quad_load(turned[3] + first);
    const Quad even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7),
               even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6), odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    quad_store(to + (ptrdiff_t)values * at[first], __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5));
    quad_store(to + (ptrdiff_t)values * at[first + 1], __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5));
    quad_store(to + (ptrdiff_t)values * at[first + 2], __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7));
    quad_store(to + (ptrdiff_t)values * at[first + 3], __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7));
  }
}

/** The same of rows of two. */
LANES_INLINE void store_pairs(const double turned[2][LANES], const int32_t *at, double *to)
{
  typedef double Pair __attribute__((vector_size(16)));
  for (int first = 0; first < LANES; first += QUAD) {
    const Quad a = quad_load(turned[0] + first), b = quad_load(turned[1] + first);
    const Pair pairs[QUAD] = {__builtin_shufflevector(a, b, 0, 4), __builtin_shufflevector(a, b, 1, 5),
                              __builtin_shufflevector(a, b, 2, 6), __builtin_shufflevector(a, b, 3, 7)};
    for (int l = 0; l < QUAD; ++l) memcpy(to + 2 * (ptrdiff_t)at[first + l], &pairs[l], sizeof pairs[l]);
  }
}

/** The reverse, of the first `count` rows. */
LANES_INLINE void store_rows(const Lanes *numbers, int values, const int32_t *at, int count, double *to)
{
  double turned[MOST_HISTORY][LANES];
  for (int k = 0; k < values; ++k) lanes_store(turned[k], numbers[k]);
  if (count == LANES && values == 2) {
    store_pairs(turned, at, to);
    return;
  }
  if (count == LANES && values >= QUAD) {
    for (int k = 0; k + QUAD <= values; k += QUAD) store_quads(turned + k, values, at, to + k);
    if (values % QUAD) store_quads(turned + values - QUAD, values, at, to + values - QUAD);
    return;
  }
  for (int l = 0; l < count; ++l)
    for (int k = 0; k < values; ++k) to[values * at[l] + k] = turned[k][l];
}

/** Lines up the points of some lanes behind those that are left. */
LANES_INLINE void keep_left(SolidChunk *chunk, unsigned bits, int first, const Lanes strain[6], const Lanes *history)
{
  for (int k = 0; k < 6; ++k) lanes_store_some(chunk->strain[k] + chunk->left, bits, 0, strain[k]);
  for (int k = 0; k < chunk->values; ++k) lanes_store_some(chunk->history[k] + chunk->left, bits, 0, history[k]);
  for (int l = 0; l < LANES; ++l) {
    chunk->at[chunk->left] = first + l;
    chunk->left += (bits & 1u << l) != 0;
  }
}

/* Where whole vectors can be written no lane is asked whether it is done: of a mixture of points no processor could guess it. What is written for the others
 * the step writes again. */
LANES_INLINE void sieve_chunk(const void *constants, SolidChunk *chunk, const Elasticity *e, bool plastic,
                              SolidInside inside)
{
  const breccia_batch *batch = chunk->batch;
  const int values = chunk->values, last = chunk->first + chunk->count - 1;
  double tangent[36];
  if (batch->tangent) elastic_tangent(e, tangent);
  chunk->left = 0;
  for (int first = chunk->first; first <= last; first += LANES) {
    const int count = last + 1 - first < LANES ? last + 1 - first : LANES;
    const bool all = count == LANES;
    const double *from = batch->committed + (ptrdiff_t)values * first;
    TrialLanes trial;
    Lanes strain[6], elastic[6], history[MOST_HISTORY];
    static const int32_t each[SLICE] = {0, 1, 2, 3, 4, 5, 6, 7};
    if (all) {
      if (values == 3)
        load_triples(from, history);
      else
        load_rows(from, values, each, history);
      for (int k = 0; k < 6; ++k) strain[k] = lanes_load(batch->strain[k] + first);
    } else { /* beyond the end the last point stands in */
      int32_t at[LANES];
      for (int l = 0; l < LANES; ++l) at[l] = l < count ? l : count - 1;
      load_rows(from, values, at, history);
      for (int k = 0; k < 6; ++k) strain[k] = lanes_gather(batch->strain[k] + first, at);
    }
    for (int k = 0; k < 6; ++k) {
      if (k >= 3) strain[k] = lanes_product(strain[k], lanes_set(0.5));
      elastic[k] = plastic ? strain[k] - history[k] : strain[k];
    }
    elastic_trial_lanes(e, elastic, &trial);
    const Lanes size = trial.length + trial.invariant;
    LaneMask done = size - size == lanes_set(0); /* finite */
    if (!batch->elastic_stage) {
      LaneMask found;
      inside(constants, &trial, history, &found);
      done &= found;
    }
    const unsigned here = (1u << count) - 1, left = lanes_bits(~done) & here;
    chunk->bits[(first - chunk->first) / LANES] = (uint8_t)left;
    if (left) keep_left(chunk, left, first, strain, history);
    if (left == here) continue;
    const Lanes pressure = lanes_product(lanes_set(e->bulk), lanes_trace(elastic));
    for (int k = 0; k < 6; ++k) {
      const Lanes stress = k < 3 ? trial.s[k] + pressure : trial.s[k];
      if (all)
        lanes_store(batch->stress[k] + first, stress);
      else
        for (int l = 0; l < count; ++l) batch->stress[k][first + l] = stress[l];
    }
    double *to = batch->trial + (ptrdiff_t)values * first;
    for (int k = 0; k < values && all; ++k) lanes_store(to + LANES * k, lanes_load(from + LANES * k));
    for (int k = 0; k < values * count && !all; ++k) to[k] = from[k];
    for (int l = 0; l < count && batch->tangent; ++l)
      if (!(left & 1u << l)) memcpy(batch->tangent + 36 * (first + l), tangent, sizeof tangent);
  }
}

/** Which of the first `count` points of a group could not be integrated: the first of them, or -1. */
LANES_INLINE int find_bad(const SolidLanes *p, const int32_t *at, int count)
{
  Lanes size = lanes_set(0);
  for (int k = 0; k < 6; ++k) size += lanes_absolute(p->stress[k]);
  const LaneMask finite = size - size == lanes_set(0);
  for (int l = 0; l < count && lanes_any(~finite); ++l)
    if (!finite[l]) return at[l];
  return -1;
}

/** Stresses of those that are left to where they belong. */
LANES_INLINE void spread_stresses(const SolidChunk *chunk)
{
  int from = 0;
  for (int n = 0; LANES * n < chunk->count; ++n) {
    const unsigned bits = chunk->bits[n];
    if (!bits) continue;
    for (int k = 0; k < 6; ++k)
      lanes_spread_some(chunk->batch->stress[k] + chunk->first + LANES * n, bits, chunk->strain[k] + from);
    from += __builtin_popcount(bits);
  }
}

/** @param[in] steps  or NULL: `step`, group by group. @return the first of the points that are left which could not be integrated, or -1 */
LANES_INLINE int step_chunk(const void *constants, SolidChunk *chunk, SolidStep step, SolidSteps steps, bool tangents)
{
  const breccia_batch *batch = chunk->batch;
  const int values = chunk->values;
  int bad = -1;
  for (int l = 0; l < LANES && chunk->left; ++l) { /* beyond the end the last point stands in */
    for (int k = 0; k < 6; ++k) chunk->strain[k][chunk->left + l] = chunk->strain[k][chunk->left - 1];
    for (int k = 0; k < values; ++k) chunk->history[k][chunk->left + l] = chunk->history[k][chunk->left - 1];
    chunk->at[chunk->left + l] = chunk->at[chunk->left - 1];
  }
  SolidLanes points[SOLID_GROUPS];
  for (int first = 0; first < chunk->left; first += SOLID_GROUPS * LANES) {
    int groups = 0;
    for (; groups < SOLID_GROUPS && first + LANES * groups < chunk->left; ++groups) {
      const int from = first + LANES * groups;
      SolidLanes *p = &points[groups];
      for (int k = 0; k < 6; ++k) p->strain[k] = lanes_load(chunk->strain[k] + from);
      for (int k = 0; k < values; ++k) p->committed[k] = lanes_load(chunk->history[k] + from);
      for (int l = 0; l < LANES && tangents; ++l) p->tangent[l] = batch->tangent + 36 * chunk->at[from + l];
    }
    if (steps) steps(constants, points, groups, tangents);
    for (int g = 0; g < groups; ++g) {
      const int from = first + LANES * g, rest = chunk->left - from, count = rest < LANES ? rest : LANES;
      if (!steps) step(constants, &points[g], tangents);
      for (int k = 0; k < 6; ++k) lanes_store(chunk->strain[k] + from, points[g].stress[k]);
      store_rows(points[g].trial, values, chunk->at + from, count, batch->trial);
      if (bad < 0) bad = find_bad(&points[g], chunk->at + from, count);
    }
  }
  spread_stresses(chunk);
  return bad;
}

/** `update` of a law.
 *  @param[in] history_values  a constant
 *  @param[in] plastic  whether history begins with the plastic strain; otherwise all strain is elastic
 *  @param[in] step, steps  one of them, the other NULL: constants */
LANES_INLINE int solid_update_lanes(const void *constants, const breccia_batch *batch, int history_values,
                                    const Elasticity *e, bool plastic, SolidInside inside, SolidStep step,
                                    SolidSteps steps)
{
  for (int first = 0; first < batch->count; first += SOLID_CHUNK) {
    const int rest = batch->count - first;
    SolidChunk chunk; /* field by field: all of it would be cleared */
    chunk.batch = batch;
    chunk.first = first;
    chunk.count = rest < SOLID_CHUNK ? rest : SOLID_CHUNK;
    chunk.values = history_values;
    sieve_chunk(constants, &chunk, e, plastic, inside);
    const int bad = batch->tangent ? step_chunk(constants, &chunk, step, steps, true)
                                   : step_chunk(constants, &chunk, step, steps, false);
    if (bad >= 0) return bad;
  }
  return -1;
}

#endif
