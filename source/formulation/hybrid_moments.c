/* Listed rows by moments. The vectors g of a point with inverse moment M^-1, mean position m, and bond vector xi are
 *   g_C = V_C M^-1 (x_C - m) + own (d_C - V_C xi . M^-1 (x_C - m)) xi / xi^2,  d = -1 at the owner, 1 at the other end,
 * so that G follows from the sums of V u (x) [x, 1] over the members, and the force on a member is
 *   f_C = -V_C Q [x_C, 1] - d_C t
 * with a matrix Q and a vector t of the point. Members are named by their index among the places around their slice, so
 * that V u (x) [x, 1] is found once for all points of a slice, and Q is summed over the points of a member.
 * Positions and displacements are relative to the first place around the slice.
 * The forces of a stripe of slices are summed in arrays of the stripe, in the order of its slices. */
#include "formulation/hybrid.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <stdlib.h>
#include <string.h>

/* ---- setup ---- */

static int moments_compare(const void *a, const void *b)
{
  const int32_t one = *(const int32_t *)a, other = *(const int32_t *)b;
  return (one > other) - (one < other);
}

static void moments_sort(int32_t *place, int64_t count)
{
  if (count > 1) qsort(place, (size_t)count, sizeof *place, moments_compare);
}

/** Counts and lists the places around each slice. @param[in] mark  [places], zeros */
static int moments_list_around(const Hybrid *h, HybridMoments *m, int32_t *mark, Error *error)
{
  const int64_t slices = h->particles->slices;
  int64_t room = 0;
  for (int64_t slice = 0; slice < slices; ++slice) {
    const int64_t begin = m->first[slice];
    int64_t count = 0;
    for (int64_t n = h->first[h->listed_first[slice]]; n < h->first[h->listed_first[slice + 1]]; ++n) {
      if (mark[h->member[n]] == slice + 1) continue;
      mark[h->member[n]] = (int32_t)(slice + 1);
      if (begin + count == room) {
        int32_t *grown = memory_grown(m->place, (size_t)(room = 2 * room + 64), sizeof *grown);
        if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: members of bonds");
        m->place = grown;
      }
      m->place[begin + count++] = h->member[n];
    }
    if (count > HYBRID_AROUND) m->fits = false;
    m->first[slice + 1] = begin + count;
    moments_sort(m->place + begin, count);
  }
  return BRECCIA_OK;
}

/** Returns true if moments give the vectors g of all listed rows: their members count by volume alone. */
static bool moments_apply(const Hybrid *h)
{
  for (int64_t number = 0; number < h->listed; ++number) {
    const int64_t first = h->first[number], count = h->first[number + 1] - first;
    if (count > HYBRID_NEAR) return false;
    for (int n = 0; n < count; ++n)
      if (hybrid_laminate_alike(h, h->member + first, n, NULL) != 1) return false;
  }
  return !h->bonds->pairs_lattice;
}

int hybrid_moments_create(Hybrid *h, Error *error)
{
  const Particles *p = h->particles;
  if (!moments_apply(h)) return BRECCIA_OK;
  HybridMoments *m = h->moments = memory_zeroed(1, sizeof *m, "members of bonds", error);
  int32_t *mark = memory_zeroed((size_t)p->places, sizeof *mark, "members of bonds", error);
  if (!m || !mark) {
    free(mark);
    return BRECCIA_FAILURE;
  }
  m->fits = true;
  m->first = memory_zeroed((size_t)p->slices + 1, sizeof *m->first, "members of bonds", error);
  m->index = memory_zeroed((size_t)h->first[h->listed], sizeof *m->index, "members of bonds", error);
  m->present = memory_zeroed((size_t)h->listed, sizeof *m->present, "members of bonds", error);
  m->fit = memory_zeroed((size_t)h->listed, sizeof *m->fit, "members of bonds", error);
  m->record = places_array(HYBRID_RECORD * p->places, "displacements", error);
  const bool whole = m->first && m->index && m->present && m->fit && m->record;
  const int status = whole ? moments_list_around(h, m, mark, error) : BRECCIA_FAILURE;
  free(mark);
  if (status) return status;
  if (!m->fits) hybrid_moments_destroy(h);
  for (int64_t place = 0; place < p->places && h->moments; ++place)
    for (int k = 0; k < 4; ++k) m->record[HYBRID_RECORD * place + k] = k < 3 ? p->position[k][place] : p->volume[place];
  return BRECCIA_OK;
}

/** Returns the index of a place among those around a slice. */
static uint16_t moments_index(const HybridMoments *m, int64_t slice, int32_t place)
{
  int64_t low = m->first[slice], high = m->first[slice + 1];
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    if (m->place[middle] <= place)
      low = middle;
    else
      high = middle;
  }
  return (uint16_t)(low - m->first[slice]);
}

static void moments_origin(const Hybrid *h, int64_t slice, double origin[3])
{
  const HybridMoments *m = h->moments;
  for (int k = 0; k < 3; ++k) origin[k] = h->particles->position[k][m->place[m->first[slice]]];
}

void hybrid_moments_order(Hybrid *h, int64_t number)
{
  moments_sort(h->member + h->first[number] + 2, h->first[number + 1] - h->first[number] - 2);
}

void hybrid_moments_set(Hybrid *h, int64_t slice, int64_t number, const double fit[9], const double *weight)
{
  HybridMoments *m = h->moments;
  const int64_t first = h->first[number];
  const int count = (int)(h->first[number + 1] - first);
  int32_t *member = h->member + first, hidden[HYBRID_NEAR];
  int present = 0, others = 0;
  m->present[number] = 0;
  memset(&m->fit[number], 0, sizeof m->fit[number]);
  if (!fit) return;
  double origin[3];
  moments_origin(h, slice, origin);
  memcpy(m->fit[number].inverse, fit, sizeof m->fit[number].inverse);
  for (int k = 0; k < 3; ++k)
    m->fit[number].middle[k] = fit[6 + k] + (h->particles->position[k][member[0]] - origin[k]);
  m->fit[number].volume = h->volume[number];
  for (int n = 0; n < count; ++n)
    if (weight[n] > 0)
      member[present++] = member[n];
    else
      hidden[others++] = member[n];
  if (others) memcpy(member + present, hidden, sizeof *hidden * (size_t)others);
  for (int n = 0; n < present; ++n) m->index[first + n] = moments_index(m, slice, member[n]);
  m->present[number] = (uint16_t)present;
}

void hybrid_moments_vectors(const Hybrid *h, int64_t slice, int64_t number, double (*g)[3])
{
  const HybridFit *fit = &h->moments->fit[number];
  const Particles *p = h->particles;
  const int32_t *member = h->member + h->first[number];
  double origin[3], xi[3], square = 0;
  moments_origin(h, slice, origin);
  for (int k = 0; k < 3; ++k) {
    xi[k] = p->position[k][member[1]] - p->position[k][member[0]];
    square += xi[k] * xi[k];
  }
  for (int n = 0; n < h->moments->present[number]; ++n) {
    double along = (n == 1) - (n == 0);
    for (int i = 0; i < 3; ++i) {
      g[n][i] = 0;
      for (int j = 0; j < 3; ++j)
        g[n][i] += fit->inverse[symmetric_place[3 * i + j]] * (p->position[j][member[n]] - origin[j] - fit->middle[j]);
      g[n][i] *= p->volume[member[n]];
      along -= g[n][i] * xi[i];
    }
    for (int i = 0; i < 3; ++i) g[n][i] += h->own * along * xi[i] / square;
  }
}

/** Gives each place around the slices of a stripe a sum. @param[in,out] sum_of  [places] last sum of a place, or -1 */
static int64_t moments_number_sums(const Hybrid *h, const HybridStripe *stripe, int32_t *sum_of, int64_t from)
{
  HybridMoments *m = h->moments;
  int64_t sums = from;
  for (int64_t n = m->first[stripe->first]; n < m->first[stripe->last]; ++n) {
    int32_t *sum = &sum_of[m->place[n]];
    if (*sum < from) {
      *sum = (int32_t)sums++;
      ++m->reach_first[m->place[n] + 2];
    }
    m->sum[n] = *sum;
  }
  return sums;
}

int hybrid_moments_create_sums(Hybrid *h, Error *error)
{
  HybridMoments *m = h->moments;
  const int64_t places = h->particles->places, around = m->first[h->particles->slices];
  int32_t *sum_of = memory_zeroed((size_t)places, sizeof *sum_of, "sums of bonds", error);
  m->sum = memory_zeroed((size_t)around, sizeof *m->sum, "sums of bonds", error);
  m->stripe_sum = memory_zeroed((size_t)h->stripes + 1, sizeof *m->stripe_sum, "sums of bonds", error);
  m->reach_first = memory_zeroed((size_t)places + 2, sizeof *m->reach_first, "sums of bonds", error);
  if (sum_of && m->sum && m->stripe_sum && m->reach_first) {
    for (int64_t i = 0; i < places; ++i) sum_of[i] = -1;
    for (int64_t n = 0; n < h->stripes; ++n)
      m->stripe_sum[n + 1] = moments_number_sums(h, &h->stripe[n], sum_of, m->stripe_sum[n]);
    m->sums = places_array(QUAD * m->stripe_sum[h->stripes], "sums of bonds", error);
    m->reach = memory_zeroed((size_t)m->stripe_sum[h->stripes], sizeof *m->reach, "sums of bonds", error);
  }
  free(sum_of);
  if (!m->sums || !m->reach) return BRECCIA_FAILURE;
  for (int64_t i = 0; i < places; ++i) m->reach_first[i + 2] += m->reach_first[i + 1];
  int64_t next = 0;
  for (int64_t stripe = 0; stripe < h->stripes; ++stripe)
    for (int64_t n = m->first[h->stripe[stripe].first]; n < m->first[h->stripe[stripe].last]; ++n)
      if (m->sum[n] == next) {
        m->reach[m->reach_first[m->place[n] + 1]++] = m->sum[n];
        ++next;
      }
  return BRECCIA_OK;
}

void hybrid_moments_destroy(Hybrid *h)
{
  HybridMoments *m = h->moments;
  if (!m) return;
  free(m->first);
  free(m->place);
  free(m->sum);
  free(m->index);
  free(m->present);
  free(m->fit);
  free(m->stripe_sum);
  free(m->reach_first);
  free(m->reach);
  places_free(&m->record);
  places_free(&m->sums);
  free(m);
  h->moments = NULL;
}

size_t hybrid_moments_bytes(const Hybrid *h)
{
  const HybridMoments *m = h->moments;
  const size_t places = (size_t)h->particles->places, rows = (size_t)h->listed,
               around = (size_t)m->first[h->particles->slices], sums = (size_t)m->stripe_sum[h->stripes];
  return (size_t)(h->particles->slices + 1) * sizeof *m->first + around * (sizeof *m->place + sizeof *m->sum) +
         (size_t)h->first[rows] * sizeof *m->index + rows * (sizeof *m->present + sizeof *m->fit) +
         places * (HYBRID_RECORD * sizeof *m->record + sizeof *m->reach_first) +
         sums * (QUAD * sizeof *m->sums + sizeof *m->reach);
}

/* ---- sweeps ---- */

/** Displacements around a slice, relative to those of its first place. */
typedef struct MomentsField {
  double u[HYBRID_AROUND][QUAD];
  double product[HYBRID_AROUND][3][QUAD]; /* V u_k [x, 1] */
} MomentsField;

/** Places around a slice. */
typedef struct MomentsSlice {
  const Hybrid *h;
  const HybridMoments *m;
  int64_t first; /* of its places in the list of those around slices */
  int count;
  double x[HYBRID_AROUND][QUAD]; /* [x, 1] */
} MomentsSlice;

/** Sums of Q and t over the points of a slice, by member. */
typedef struct MomentsForces {
  double q[HYBRID_AROUND][3][QUAD], direct[HYBRID_AROUND][QUAD];
} MomentsForces;

/** Four listed rows of a slice; the last one is repeated where there are fewer. */
typedef struct MomentsRows {
  int count;
  int64_t number[LANES];
  Lanes inverse[6], middle[4], volume, xi[3]; /* as in HybridFit; middle[3] is the volume */
  LaneMask active;                            /* volume is not 0 */
} MomentsRows;

LANES_INLINE const double *moments_record(const MomentsSlice *s, int n)
{
  return s->m->record + HYBRID_RECORD * (int64_t)s->m->place[s->first + n];
}

LANES_INLINE void moments_find_slice(const Hybrid *h, int64_t slice, MomentsSlice *s)
{
  s->h = h;
  s->m = h->moments;
  s->first = s->m->first[slice];
  s->count = (int)(s->m->first[slice + 1] - s->first);
  if (!s->count) return;
  Quad origin = quad_load(moments_record(s, 0));
  origin[3] = 0;
  for (int n = 0; n < s->count; ++n) {
    Quad x = quad_load(moments_record(s, n)) - origin;
    x[3] = 1;
    quad_store(s->x[n], x);
  }
}

/** @param[in] at  displacements; NULL: those that were shown */
LANES_INLINE void moments_find_field(const MomentsSlice *s, double *const *at, MomentsField *field)
{
  Quad origin = {0};
  for (int n = 0; n < s->count; ++n) {
    const double *record = moments_record(s, n);
    const int32_t place = s->m->place[s->first + n];
    const Quad u = (at ? (Quad){at[0][place], at[1][place], at[2][place], 0} : quad_load(record + QUAD)) - origin;
    if (!n) {
      origin = u;
      quad_store(field->u[n], u - u);
      for (int k = 0; k < 3; ++k) quad_store(field->product[n][k], u - u);
      continue;
    }
    const Quad x = quad_load(s->x[n]) * lanes_set(record[3]);
    quad_store(field->u[n], u);
    for (int k = 0; k < 3; ++k) quad_store(field->product[n][k], x * lanes_set(u[k]));
  }
}

/** Members of a row, the owner and the other end first. Of a row that carries nothing both ends are one place. */
LANES_INLINE const uint16_t *moments_members(const MomentsSlice *s, int64_t number)
{
  static const uint16_t none[2] = {0};
  return s->m->present[number] ? s->m->index + s->h->first[number] : none;
}

/** Finds up to four rows from `from` on. */
LANES_INLINE void moments_find_rows(const MomentsSlice *s, int64_t from, int64_t end, MomentsRows *rows)
{
  Lanes turned[LANES], part[4][LANES];
  rows->count = end - from < LANES ? (int)(end - from) : LANES;
  for (int i = 0; i < LANES; ++i) {
    rows->number[i] = from + (i < rows->count ? i : rows->count - 1);
    const double *fit = s->m->fit[rows->number[i]].inverse;
    const uint16_t *member = moments_members(s, rows->number[i]);
    part[0][i] = quad_load(fit);
    part[1][i] = quad_load(fit + 2);
    part[2][i] = quad_load(fit + 6);
    part[3][i] = quad_load(s->x[member[1]]) - quad_load(s->x[member[0]]);
  }
  lanes_turn(part[1][0], part[1][1], part[1][2], part[1][3], rows->inverse + 2);
  lanes_turn(part[0][0], part[0][1], part[0][2], part[0][3], rows->inverse);
  lanes_turn(part[2][0], part[2][1], part[2][2], part[2][3], rows->middle);
  lanes_turn(part[3][0], part[3][1], part[3][2], part[3][3], turned);
  for (int k = 0; k < 3; ++k) rows->xi[k] = turned[k];
  rows->volume = rows->middle[3];
  rows->active = (LaneMask)(rows->volume != lanes_set(0));
}

/** own / xi^2 of rows that carry something, else 0. */
LANES_INLINE Lanes moments_own(const MomentsSlice *s, const MomentsRows *rows)
{
  const Lanes square = lanes_square(rows->xi[0], rows->xi[1], rows->xi[2]);
  return lanes_where(rows->active, lanes_set(s->h->own) / lanes_choose(rows->active, square, lanes_set(1)));
}

/** G of four rows. */
LANES_INLINE void moments_gradient(const MomentsSlice *s, const MomentsField *field, const MomentsRows *rows,
                                   Lanes g[9])
{
  Quad sum[3][LANES], apart[LANES];
  Lanes turned[LANES], ends[LANES];
  for (int i = 0; i < LANES; ++i) {
    const uint16_t *member = moments_members(s, rows->number[i]);
    const int count = s->m->present[rows->number[i]];
    Quad even[3] = {{0}}, odd[3] = {{0}};
    int n = 0;
    for (; n + 1 < count; n += 2)
      for (int k = 0; k < 3; ++k) {
        even[k] += quad_load(field->product[member[n]][k]);
        odd[k] += quad_load(field->product[member[n + 1]][k]);
      }
    for (int k = 0; k < 3 && n < count; ++k) even[k] += quad_load(field->product[member[n]][k]);
    for (int k = 0; k < 3; ++k) sum[k][i] = even[k] + odd[k];
    apart[i] = quad_load(field->u[member[1]]) - quad_load(field->u[member[0]]);
  }
  lanes_turn(apart[0], apart[1], apart[2], apart[3], ends);
  const Lanes own = moments_own(s, rows);
  for (int k = 0; k < 3; ++k) {
    lanes_turn(sum[k][0], sum[k][1], sum[k][2], sum[k][3], turned);
    for (int j = 0; j < 3; ++j) turned[j] -= turned[3] * rows->middle[j];
    Lanes along = ends[k];
    for (int j = 0; j < 3; ++j) {
      Lanes value = turned[0] * rows->inverse[symmetric_place[j]];
      value += turned[1] * rows->inverse[symmetric_place[3 + j]];
      value += turned[2] * rows->inverse[symmetric_place[6 + j]];
      g[3 * k + j] = value;
      along -= value * rows->xi[j];
    }
    for (int j = 0; j < 3; ++j) g[3 * k + j] += along * own * rows->xi[j];
  }
}

/** Strain of a gradient, or its change with the change g of a gradient. @param[in] at  NULL: the strain */
LANES_INLINE void moments_strain(bool finite, const Lanes g[9], const Lanes *at, Lanes strain[6])
{
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], c = symmetric_column[k];
    Lanes sum = g[3 * r + c] + g[3 * c + r];
    for (int j = 0; j < 3 && finite && !at; ++j) sum += g[3 * j + r] * g[3 * j + c];
    for (int j = 0; j < 3 && finite && at; ++j) {
      sum += at[3 * j + r] * g[3 * j + c];
      sum += g[3 * j + r] * at[3 * j + c];
    }
    strain[k] = k < 3 ? sum * lanes_set(0.5) : sum;
  }
}

LANES_INLINE void moments_add_turned(const Lanes g[9], const Lanes stress[6], Lanes p[9])
{
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) p[3 * r + k] += g[3 * r + j] * stress[symmetric_place[3 * j + k]];
}

/** F S, or its change F dS + dG S. @param[in] at, held  gradient and stress that change, or NULL */
LANES_INLINE void moments_first_stress(bool finite, const Lanes g[9], const Lanes stress[6], const Lanes *at,
                                       const Lanes *held, Lanes p[9])
{
  for (int k = 0; k < 9; ++k) p[k] = stress[symmetric_place[k]];
  if (!finite) return;
  moments_add_turned(at ? at : g, stress, p);
  if (at) moments_add_turned(g, held, p);
}

/** Adds what four rows exert on their members, by F S. */
LANES_INLINE void moments_exert(const MomentsSlice *s, const MomentsRows *rows, Lanes p[9], MomentsForces *forces)
{
  const bool pairwise = s->h->pairwise;
  const Lanes own = moments_own(s, rows), zero = lanes_set(0);
  Lanes q[3][LANES], t[3];
  for (int k = 0; k < 3; ++k) {
    if (pairwise) {
      t[k] = zero;
      for (int i = 0; i < rows->count; ++i)
        for (int j = 0; j < 3; ++j) t[k][i] += p[3 * k + j][i] * s->h->area[rows->number[i]][j];
      t[k] = lanes_where(rows->active, t[k]);
      continue;
    }
    for (int j = 0; j < 3; ++j) p[3 * k + j] *= rows->volume;
    t[k] = (p[3 * k] * rows->xi[0] + p[3 * k + 1] * rows->xi[1] + p[3 * k + 2] * rows->xi[2]) * own;
    for (int j = 0; j < 3; ++j) p[3 * k + j] -= t[k] * rows->xi[j];
    Lanes q3 = zero, turned[LANES];
    for (int j = 0; j < 3; ++j) {
      Lanes value = p[3 * k] * rows->inverse[symmetric_place[j]];
      value += p[3 * k + 1] * rows->inverse[symmetric_place[3 + j]];
      value += p[3 * k + 2] * rows->inverse[symmetric_place[6 + j]];
      q3 -= value * rows->middle[j];
      turned[j] = value;
    }
    lanes_turn(turned[0], turned[1], turned[2], q3, q[k]);
  }
  Lanes direct[LANES];
  lanes_turn(t[0], t[1], t[2], zero, direct);
  for (int i = 0; i < rows->count; ++i) {
    const uint16_t *member = moments_members(s, rows->number[i]);
    const int count = s->m->present[rows->number[i]];
    if (!count) continue;
    double *owner = forces->direct[member[0]], *other = forces->direct[member[1]];
    quad_store(owner, quad_load(owner) + direct[i]);
    quad_store(other, quad_load(other) - direct[i]);
    const Quad column[3] = {q[0][i], q[1][i], q[2][i]};
    for (int n = 0; n < count && !pairwise; ++n)
      for (int k = 0; k < 3; ++k) {
        double *to = forces->q[member[n]][k];
        quad_store(to, quad_load(to) + column[k]);
      }
  }
}

LANES_INLINE void moments_clear_forces(const MomentsSlice *s, MomentsForces *forces)
{
  const size_t count = s->count > 0 ? (size_t)s->count : 0;
  memset(forces->q, 0, sizeof *forces->q * count);
  memset(forces->direct, 0, sizeof *forces->direct * count);
}

/** Adds the forces on the places around a slice to the sums of its stripe. */
LANES_INLINE void moments_add_forces(const MomentsSlice *s, const MomentsForces *forces)
{
  for (int n = 0; n < s->count; ++n) {
    const Quad x = quad_load(s->x[n]);
    Lanes turned[LANES];
    lanes_turn(quad_load(forces->q[n][0]) * x, quad_load(forces->q[n][1]) * x, quad_load(forces->q[n][2]) * x,
               lanes_set(0), turned);
    const Quad sum = (turned[0] + turned[1]) + (turned[2] + turned[3]);
    double *to = s->m->sums + QUAD * (int64_t)s->m->sum[s->first + n];
    quad_store(to, quad_load(to) + (quad_load(forces->direct[n]) - sum * lanes_set(moments_record(s, n)[3])));
  }
}

void hybrid_moments_show(const Hybrid *h, const Sweep *sweep)
{
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; ++place)
    for (int k = 0; k < 3; ++k) h->moments->record[HYBRID_RECORD * place + QUAD + k] = sweep->displacement[k][place];
}

void hybrid_moments_clear(const Hybrid *h, const HybridStripe *stripe)
{
  const HybridMoments *m = h->moments;
  const int64_t n = stripe - h->stripe, first = m->stripe_sum[n];
  memset(m->sums + QUAD * first, 0, sizeof *m->sums * (size_t)(QUAD * (m->stripe_sum[n + 1] - first)));
}

/** Returns Lame's constant and the shear modulus of four rows. */
LANES_INLINE void moments_moduli(const Hybrid *h, int64_t slice, const MomentsRows *rows, Lanes *lame, Lanes *shear)
{
  for (int i = 0; i < LANES; ++i) {
    const int64_t single = hybrid_single(h, slice, rows->number[i]);
    const HybridHooke *hooke = &h->hooke[single < 0 ? h->material[slice] : h->bonds->single_material[single]];
    (*lame)[i] = hooke->lame;
    (*shear)[i] = hooke->shear;
  }
}

LANES_INLINE void moments_hooke(Lanes lame, Lanes shear, const Lanes strain[6], Lanes stress[6])
{
  const Lanes trace = strain[0] + strain[1] + strain[2];
  for (int k = 0; k < 6; ++k) stress[k] = k < 3 ? lanes_set(2) * shear * strain[k] + lame * trace : shear * strain[k];
}

/** All rows of a slice whose law is Hooke's. */
LANES_INLINE void moments_hooke_slice(const Hybrid *h, const Sweep *sweep, int64_t slice, bool finite, bool linear)
{
  _Alignas(64) MomentsSlice s;
  _Alignas(64) MomentsField field, at_field;
  _Alignas(64) MomentsForces forces;
  moments_find_slice(h, slice, &s);
  if (!s.count) return;
  moments_find_field(&s, NULL, &field);
  if (linear && finite) moments_find_field(&s, sweep->linearised_at, &at_field);
  moments_clear_forces(&s, &forces);
  for (int64_t from = h->listed_first[slice]; from < h->listed_first[slice + 1]; from += LANES) {
    MomentsRows rows;
    Lanes g[9], at[9], strain[6], stress[6], held[6], p[9], lame, shear;
    moments_find_rows(&s, from, h->listed_first[slice + 1], &rows);
    moments_moduli(h, slice, &rows, &lame, &shear);
    moments_gradient(&s, &field, &rows, g);
    const bool both = linear && finite;
    if (both) {
      moments_gradient(&s, &at_field, &rows, at);
      moments_strain(finite, at, NULL, strain);
      moments_hooke(lame, shear, strain, held);
    }
    moments_strain(finite, g, both ? at : NULL, strain);
    moments_hooke(lame, shear, strain, stress);
    moments_first_stress(finite, g, stress, both ? at : NULL, held, p);
    moments_exert(&s, &rows, p, &forces);
  }
  moments_add_forces(&s, &forces);
}

BRECCIA_CLONES
static void moments_elastic(const Hybrid *h, const Sweep *sweep, int64_t slice)
{
  const bool linear = sweep->linearised_at != NULL;
  if (h->finite && linear)
    moments_hooke_slice(h, sweep, slice, true, true);
  else if (h->finite)
    moments_hooke_slice(h, sweep, slice, true, false);
  else
    moments_hooke_slice(h, sweep, slice, false, false);
}

void hybrid_moments_hooke(const Hybrid *h, const Sweep *sweep, int64_t slice)
{
  moments_elastic(h, sweep, slice);
}

/** Finds the listed rows of a batch of rows. */
static void moments_range(const Hybrid *h, const Sweep *sweep, int64_t *from, int64_t *end)
{
  *from = h->listed_first[sweep->first];
  while (*from < h->listed_first[sweep->first + 1] && h->row[*from] < sweep->row) ++*from;
  *end = *from;
  while (*end < h->listed_first[sweep->first + 1] && h->row[*end] < sweep->row + sweep->rows) ++*end;
}

BRECCIA_CLONES
static void moments_deform(const Hybrid *h, const Sweep *sweep)
{
  int64_t from, end;
  moments_range(h, sweep, &from, &end);
  if (from == end) return;
  _Alignas(64) MomentsSlice s;
  _Alignas(64) MomentsField field, at_field;
  const bool both = sweep->linearised_at && h->finite;
  moments_find_slice(h, sweep->first, &s);
  moments_find_field(&s, NULL, &field);
  if (both) moments_find_field(&s, sweep->linearised_at, &at_field);
  for (; from < end; from += LANES) {
    MomentsRows rows;
    Lanes g[9], at[9], strain[6];
    moments_find_rows(&s, from, end, &rows);
    moments_gradient(&s, &field, &rows, g);
    if (both) moments_gradient(&s, &at_field, &rows, at);
    moments_strain(h->finite, g, both ? at : NULL, strain);
    for (int i = 0; i < rows.count; ++i) {
      const int64_t to = h->row[rows.number[i]] - sweep->row;
      const bool stays = h->idle[rows.number[i]] && !sweep->linearised_at; /* as of broken bonds along lattices */
      for (int k = 0; k < 9; ++k) sweep->carry[k * BATCH + to] = g[k][i];
      for (int k = 0; k < 6 && !stays; ++k)
        if (k != ZZ || !h->points->plane_stress) sweep->strain[k][to] = strain[k][i];
    }
  }
}

void hybrid_moments_deform(const Hybrid *h, const Sweep *sweep)
{
  moments_deform(h, sweep);
}

BRECCIA_CLONES
static void moments_respond(const Hybrid *h, const Sweep *sweep)
{
  int64_t from, end;
  moments_range(h, sweep, &from, &end);
  if (from == end) return;
  _Alignas(64) MomentsSlice s;
  _Alignas(64) MomentsField at_field;
  _Alignas(64) MomentsForces forces;
  const bool both = sweep->linearised_at && h->finite;
  moments_find_slice(h, sweep->first, &s);
  if (both) moments_find_field(&s, sweep->linearised_at, &at_field);
  moments_clear_forces(&s, &forces);
  for (; from < end; from += LANES) {
    MomentsRows rows;
    Lanes g[9], at[9], stress[6], held[6], p[9];
    moments_find_rows(&s, from, end, &rows);
    for (int i = 0; i < LANES; ++i) {
      const int64_t row = h->row[rows.number[i]], n = row - sweep->row;
      for (int k = 0; k < 6; ++k) stress[k][i] = sweep->stress[k][n];
      for (int k = 0; k < 6 && both; ++k) held[k][i] = h->points->stress[k][row];
      for (int k = 0; k < 9; ++k) g[k][i] = sweep->carry[k * BATCH + n];
    }
    if (both) moments_gradient(&s, &at_field, &rows, at);
    moments_first_stress(h->finite, g, stress, both ? at : NULL, held, p);
    moments_exert(&s, &rows, p, &forces);
  }
  moments_add_forces(&s, &forces);
}

void hybrid_moments_respond(const Hybrid *h, const Sweep *sweep)
{
  moments_respond(h, sweep);
}
