/* Many points of the cap model at once, with vectors wherever points go the same way (measured: 130 ns a point on the cap instead of 320). */
#include "constitutive/solid/cap.h"

#include "base/lanes.h"

enum { CHUNK = 64 };

typedef struct Chunk {
  double s[6][CHUNK], trial[CHUNK], length[CHUNK], at[CHUNK], fall[CHUNK]; /* elastic trial; F and its falling part */
  double invariant[CHUNK], shrink[CHUNK], cap[CHUNK];                      /* where they return to */
  bool flows[CHUNK];
  double on_trial[CHUNK], on_length[CHUNK], on_k[CHUNK], on_at[CHUNK], on_fall[CHUNK],
      returned[CHUNK]; /* of those on the cap, side by side */
  int which[CHUNK];
} Chunk;

/** Number `at` of four rows of history. */
LANES_INLINE Lanes column(const double *rows, int at)
{
  return (Lanes){rows[at], rows[CAP_HISTORY + at], rows[2 * CAP_HISTORY + at], rows[3 * CAP_HISTORY + at]};
}

BRECCIA_CLONES
static void try_chunk(const Cap *c, const double *rows, const double *const strain[6], double *const stress[6],
                      Chunk *chunk)
{
  const Lanes bulk = lanes_set(c->elastic.bulk), twice = lanes_set(2 * c->elastic.shear), third = lanes_set(1.0 / 3),
              half = lanes_set(0.5);
  for (int p = 0; p < CHUNK; p += LANES, rows += LANES * CAP_HISTORY) {
    Lanes e[6], volume, square;
    for (int n = 0; n < 3; ++n) e[n] = lanes_load(strain[n] + p) - column(rows, n);
    for (int n = 3; n < 6; ++n) e[n] = half * lanes_load(strain[n] + p) - column(rows, n);
    volume = e[0] + e[1] + e[2];
    for (int n = 0; n < 3; ++n) e[n] -= volume * third;
    for (int n = 0; n < 6; ++n) {
      e[n] *= twice;
      lanes_store(chunk->s[n] + p, e[n]);
      lanes_store(stress[n] + p, n < 3 ? e[n] + bulk * volume : e[n]);
    }
    square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + lanes_set(2) * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    const Lanes trial = lanes_set(-3 * c->elastic.bulk) * volume, k = column(rows, CAP_PARAMETER);
    const Lanes length = lanes_root(square), i = lanes_least(trial, k),
                fall = lanes_set(c->lambda) * (lanes_set(1) + lanes_exponential_less_one(lanes_set(-c->beta) * i)),
                at = lanes_set(c->alpha) - fall + lanes_set(c->theta) * i;
    const Lanes past = (trial - k) * lanes_set(1 / c->ratio),
                along = lanes_choose(past > lanes_set(0), past, lanes_set(0));
    const LaneMask outside =
        (trial < lanes_set(c->cut)) | (length * length + along * along > at * at * lanes_set(1 + 1e-12));
    lanes_store(chunk->trial + p, trial);
    lanes_store(chunk->length + p, length);
    lanes_store(chunk->fall + p, fall);
    lanes_store(chunk->at + p, at);
    lanes_store(chunk->invariant + p, trial);
    lanes_store(chunk->shrink + p, lanes_set(1));
    for (int l = 0; l < LANES; ++l) chunk->flows[p + l] = outside[l] != 0;
  }
}

/** The iteration of return_to_cap for four points; each stops where it would alone. */
typedef struct CapLanes {
  Lanes past, length, first, bent, before, d, low, high, shift, returned; /* shift: I - k */
  LaneMask ended;
} CapLanes;

LANES_INLINE void advance_cap_lanes(const Cap *c, CapLanes *x)
{
  const Lanes bulk3 = lanes_set(3 * c->elastic.bulk), shear2 = lanes_set(2 * c->elastic.shear), R = lanes_set(c->ratio),
              square3 = lanes_set(c->ratio * c->ratio / 3), one = lanes_set(1),
              bulk9 = lanes_set(9 * c->elastic.bulk / c->ratio);
  const Lanes d = x->d, fade = lanes_exponential_less_one(lanes_set(-c->beta) * d),
              rise = lanes_set(c->beta > 0 ? -1 / c->beta : 0) * x->bent * fade + lanes_set(c->theta) * d,
              f = x->first + rise, f1 = x->bent * (one + fade) + lanes_set(c->theta),
              pressed = lanes_exponential_less_one(lanes_set(-c->rate) * (d + R * rise)),
              H = lanes_set(-c->compaction) * x->before * pressed,
              H1 = lanes_set(c->compaction * c->rate) * (one + R * f1) * x->before * (one + pressed),
              gap = x->past - bulk3 * H - d;
  const LaneMask inside = gap > lanes_set(0);
  const Lanes inverse = one / lanes_choose(inside, gap, one), g = square3 * H * inverse,
              g1 = (square3 * H1 + g * (bulk3 * H1 + one)) * inverse;
  const Lanes dilute = one / (one + shear2 * g), narrow = one / (R + bulk9 * g);
  const Lanes a = x->length * dilute, a1 = -a * dilute * shear2 * g1, b = (x->past - d) * narrow,
              S = lanes_root(a * a + b * b), slope = (a * a1 - b * (one + b * bulk9 * g1) * narrow) / S - f1;
  const LaneMask above = inside & (S > f);
  const Lanes low = lanes_choose(above, d, x->low), high = lanes_choose(above, x->high, d);
  const Lanes newton = d - (S - f) / slope;
  const LaneMask good = inside & (newton > low) & (newton < high);
  const Lanes next = lanes_choose(good, newton, (low + high) * lanes_set(0.5));
  const LaneMask ended = x->ended | (inside & ((lanes_absolute(S - f) <= lanes_set(1e-13) * f) |
                                               (lanes_absolute(next - d) <= lanes_set(1e-15) * d) |
                                               (high - low <= lanes_set(1e-15) * high)));
  /* Near the top of the ellipse what is left goes radially, as in return_to_cap. */
  const LaneMask off = lanes_absolute(S - f) > lanes_set(1e-12) * f;
  const Lanes radial = lanes_choose(off, f / S, one);
  x->returned = a * radial;
  x->shift = lanes_choose(off, d + R * b * radial, x->past - bulk3 * H);
  x->d = lanes_choose(ended, d, next);
  x->low = lanes_choose(ended, x->low, low);
  x->high = lanes_choose(ended, x->high, high);
  x->ended = ended;
}

LANES_INLINE bool all_ended(const CapLanes *x)
{
  return x->ended[0] & x->ended[1] & x->ended[2] & x->ended[3];
}

/** Returns `count` points, which fill lanes two vectors at a time. What does not end has a NaN for k. */
BRECCIA_CLONES
static void return_chunk_to_cap(const Cap *c, Chunk *chunk, int count)
{
  enum { MOST_ITERATIONS = 100 };
  for (int first = 0; first < count; first += 2 * LANES) {
    CapLanes x[2]; /* two, because one waits for itself */
    for (int v = 0; v < 2; ++v) {
      const int at = first + v * LANES;
      const Lanes k = lanes_load(chunk->on_k + at), past = lanes_load(chunk->on_trial + at) - k,
                  first_value = lanes_load(chunk->on_at + at), none = lanes_set(0);
      x[v] = (CapLanes){.past = past,
                        .length = lanes_load(chunk->on_length + at),
                        .first = first_value,
                        .bent = lanes_set(c->beta) * lanes_load(chunk->on_fall + at),
                        .before = lanes_set(1) + lanes_exponential_less_one(lanes_set(-c->rate) *
                                                                            (k + lanes_set(c->ratio) * first_value)),
                        .d = none,
                        .low = none,
                        .high = past,
                        .ended = (LaneMask){0}};
    }
    for (int iteration = 0; iteration < MOST_ITERATIONS; ++iteration) {
      for (int v = 0; v < 2; ++v) advance_cap_lanes(c, &x[v]);
      if (all_ended(&x[0]) && all_ended(&x[1])) break;
    }
    for (int v = 0; v < 2; ++v) {
      const int at = first + v * LANES;
      const Lanes k = lanes_load(chunk->on_k + at);
      lanes_store(chunk->on_k + at, lanes_choose(x[v].ended, k + x[v].d, lanes_set(NAN)));
      lanes_store(chunk->on_trial + at, k + x[v].shift);
      lanes_store(chunk->returned + at, x[v].returned);
    }
  }
}

/** Stresses and histories of what flows. */
BRECCIA_CLONES
static void finish_chunk(const Cap *c, const breccia_batch *batch, int first, int count, const Chunk *chunk)
{
  const double half = 1 / (2 * c->elastic.shear), ninth = 1 / (9 * c->elastic.bulk);
  double *out = batch->trial + (ptrdiff_t)CAP_HISTORY * first;
  for (int p = 0; p < count; ++p) {
    if (!chunk->flows[p]) continue;
    for (int n = 0; n < 6; ++n) {
      const double s = chunk->s[n][p] * chunk->shrink[p], i = n < 3 ? chunk->invariant[p] : 0;
      batch->stress[n][first + p] = s - i / 3;
      out[CAP_HISTORY * p + n] = batch->strain[n][first + p] * (n < 3 ? 1 : 0.5) - s * half + i * ninth;
    }
    out[CAP_HISTORY * p + CAP_PARAMETER] = chunk->cap[p];
  }
}

/** Returns the points of a chunk. @return -1, or the first that could not be integrated */
static int return_chunk(const Cap *c, const breccia_batch *batch, int first, int count, Chunk *chunk)
{
  const double *rows = batch->committed + (ptrdiff_t)CAP_HISTORY * first;
  int on_cap = 0;
  for (int p = 0; p < count; ++p) {
    if (!isfinite(chunk->trial[p]) || !isfinite(chunk->length[p])) return first + p;
    if (!chunk->flows[p]) continue;
    const double k = rows[CAP_HISTORY * p + CAP_PARAMETER], trial = chunk->trial[p], length = chunk->length[p];
    if (batch->elastic_stage) {
      chunk->flows[p] = false;
      continue;
    }
    CapReturn r = cap_return_off_cap(c, trial, length, k, chunk->at[p]);
    chunk->flows[p] = r.plastic;
    if (!r.plastic) continue;
    if (r.on_cap) {
      chunk->on_trial[on_cap] = trial;
      chunk->on_length[on_cap] = length;
      chunk->on_k[on_cap] = k;
      chunk->on_at[on_cap] = chunk->at[p];
      chunk->on_fall[on_cap] = chunk->fall[p];
      chunk->which[on_cap++] = p;
      continue;
    }
    if (!isfinite(r.cap)) return first + p;
    chunk->invariant[p] = r.invariant;
    chunk->shrink[p] = length > 0 ? r.length / length : 1;
    chunk->cap[p] = r.cap;
  }
  if (!on_cap) return -1;
  for (int n = on_cap; n % SLICE; ++n) { /* spare lanes repeat the last */
    chunk->on_trial[n] = chunk->on_trial[on_cap - 1];
    chunk->on_length[n] = chunk->on_length[on_cap - 1];
    chunk->on_k[n] = chunk->on_k[on_cap - 1];
    chunk->on_at[n] = chunk->on_at[on_cap - 1];
    chunk->on_fall[n] = chunk->on_fall[on_cap - 1];
  }
  return_chunk_to_cap(c, chunk, on_cap);
  for (int n = 0; n < on_cap; ++n) {
    const int p = chunk->which[n];
    const double length = chunk->length[p];
    if (!isfinite(chunk->on_k[n])) return first + p;
    chunk->cap[p] = chunk->on_k[n];
    chunk->invariant[p] = chunk->on_trial[n];
    chunk->shrink[p] = length > 0 ? chunk->returned[n] / length : 1;
  }
  return -1;
}

int cap_update_many(const Cap *c, const breccia_batch *batch)
{
  Chunk chunk;
  double padded[6][CHUNK], padded_stress[6][CHUNK], rows[CHUNK * CAP_HISTORY];
  for (int first = 0; first < batch->count; first += CHUNK) {
    const int count = batch->count - first < CHUNK ? batch->count - first : CHUNK;
    const double *history = batch->committed + (ptrdiff_t)CAP_HISTORY * first, *strain[6];
    double *stress[6];
    for (int n = 0; n < 6; ++n) {
      strain[n] = batch->strain[n] + first;
      stress[n] = count < CHUNK ? padded_stress[n] : batch->stress[n] + first;
    }
    memcpy(batch->trial + (ptrdiff_t)CAP_HISTORY * first, history, sizeof(double) * CAP_HISTORY * (size_t)count);
    if (count < CHUNK) {
      memset(rows, 0, sizeof rows);
      memset(padded, 0, sizeof padded);
      memcpy(rows, history, sizeof(double) * CAP_HISTORY * (size_t)count);
      history = rows;
      for (int n = 0; n < 6; ++n) {
        memcpy(padded[n], strain[n], sizeof(double) * (size_t)count);
        strain[n] = padded[n];
      }
    }
    try_chunk(c, history, strain, stress, &chunk);
    for (int n = 0; count < CHUNK && n < 6; ++n)
      memcpy(batch->stress[n] + first, stress[n], sizeof(double) * (size_t)count);
    const int bad = return_chunk(c, batch, first, count, &chunk);
    if (bad >= 0) return bad;
    finish_chunk(c, batch, first, count, &chunk);
  }
  return -1;
}
