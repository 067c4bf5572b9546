/* Which particles give a bond its strain, by which vectors, and how large its section is. */
#include "formulation/hybrid.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <stdlib.h>
#include <string.h>

/** Whether two places see each other, or are one. */
static bool sees(const Hybrid *h, int32_t a, int32_t b)
{
  if (a == b) return true;
  if ((a == h->hidden[0] && b == h->hidden[1]) || (a == h->hidden[1] && b == h->hidden[0])) return false;
  return family_joins(h->family, a, b);
}

/** Inverse of a symmetric tensor of the body's space; rows and columns across the plane are those of 1.
 *  @return false where it is as flat as no strain can be found in */
static bool invert(const Hybrid *h, double m[6], double inverse[6])
{
  const double flat = 1e-6;
  double value[3], vector[9], largest = 0, least = INFINITY;
  if (h->dimensions == 2) {
    m[ZZ] = (m[XX] + m[YY]) / 2;
    m[YZ] = m[ZX] = 0;
  }
  tensor_eigen(m, value, vector);
  for (int k = 0; k < 3; ++k) {
    largest = fmax(largest, value[k]);
    least = fmin(least, value[k]);
  }
  if (!(least > flat * largest)) return false;
  tensor_inverse(m, inverse);
  return true;
}

static void times(const double a[6], const double v[3], double to[3])
{
  for (int i = 0; i < 3; ++i) {
    to[i] = 0;
    for (int j = 0; j < 3; ++j) to[i] += a[symmetric_place[3 * i + j]] * v[j];
  }
}

/** Adds what the bond itself says: g - own (g . xi) xi / L^2, and own xi / L^2 of its ends. */
static void correct(const Hybrid *h, int count, const double xi[3], double (*g)[3])
{
  double square = 0;
  for (int k = 0; k < 3; ++k) square += xi[k] * xi[k];
  for (int n = 0; n < count; ++n) {
    double along = (n == 1) - (n == 0);
    for (int k = 0; k < 3; ++k) along -= g[n][k] * xi[k];
    for (int k = 0; k < 3; ++k) g[n][k] += h->own * along * xi[k] / square;
  }
}

bool hybrid_weigh(const Hybrid *h, int64_t row, double (*g)[3])
{
  const Particles *p = h->particles;
  const int32_t *member = h->member + h->first[row];
  const int count = hybrid_members(h, row);
  memset(g, 0, sizeof *g * (size_t)count);
  if (h->volume[row] == 0 || !sees(h, member[0], member[1])) return false;
  double middle[3] = {0}, whole = 0, m[6] = {0}, inverse[6], xi[3];
  for (int n = 0; n < count; ++n) {
    if (!sees(h, member[n], member[0]) || !sees(h, member[n], member[1])) continue;
    const double volume = p->volume[member[n]];
    whole += volume;
    for (int k = 0; k < 3; ++k) {
      g[n][k] = p->position[k][member[n]] - p->position[k][member[0]];
      middle[k] += volume * g[n][k];
    }
  }
  for (int k = 0; k < 3; ++k) {
    xi[k] = g[1][k];
    middle[k] /= whole;
  }
  for (int n = 0; n < count; ++n) {
    const bool present = !n || g[n][0] != 0 || g[n][1] != 0 || g[n][2] != 0; /* the others stand elsewhere */
    const double volume = present ? p->volume[member[n]] : 0;
    double from[3];
    for (int k = 0; k < 3; ++k) from[k] = g[n][k] - middle[k];
    for (int k = 0; k < 6; ++k) m[k] += volume * from[symmetric_row[k]] * from[symmetric_column[k]];
    for (int k = 0; k < 3; ++k) g[n][k] = volume * from[k];
  }
  if (!invert(h, m, inverse)) {
    memset(g, 0, sizeof *g * (size_t)count);
    return false;
  }
  for (int n = 0; n < count; ++n) {
    const double from[3] = {g[n][0], g[n][1], g[n][2]};
    times(inverse, from, g[n]);
  }
  correct(h, count, xi, g);
  return true;
}

static void renew_row(Hybrid *h, int64_t row)
{
  h->idle[row] = !hybrid_weigh(h, row, h->g + h->first[row]);
}

void hybrid_renew(void *formulation, int64_t slice)
{
  Hybrid *h = formulation;
  for (int64_t place = slice * SLICE; place < (slice + 1) * SLICE; ++place)
    for (int64_t n = h->met_first[place]; n < h->met_first[place + 1]; ++n)
      if (h->pairwise || h->met[n].member < 2) renew_row(h, h->met[n].row);
}

bool hybrid_can_carry(const void *formulation, int64_t slice, int64_t slot, int lane)
{
  const Hybrid *h = formulation;
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
  return h->volume[rows[0]] == 0 || hybrid_weigh(h, rows[0], h->tried);
}

/* ---- as the body begins ---- */

/** K of a place with the weights of areas: w xi (x) xi / L. */
static bool find_shape(const Hybrid *h, int32_t place, double inverse[6])
{
  const Family *f = h->family;
  const int64_t slice = place / SLICE;
  const int lane = place % SLICE;
  double k[6] = {0};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    for (int c = 0; c < 6; ++c)
      k[c] += bond.weight / bond.length * bond.xi[symmetric_row[c]] * bond.xi[symmetric_column[c]];
  }
  return invert(h, k, inverse);
}

typedef struct Neighbours {
  int32_t of;     /* whose neighbours are marked, + 1 */
  int32_t *mark;  /* [places] the same number */
  int32_t *found; /* places that both ends see */
  int count, capacity;
} Neighbours;

static void mark_neighbours(const Hybrid *h, int32_t place, Neighbours *n)
{
  const Family *f = h->family;
  if (n->of == place + 1) return;
  n->of = place + 1;
  for (int64_t slot = f->first[place / SLICE]; slot < f->first[place / SLICE + 1]; ++slot)
    if (f->intact[slot] >> place % SLICE & 1)
      n->mark[family_bond(f, place / SLICE, slot, place % SLICE).neighbour] = n->of;
}

/** Marked places that are neighbours of another one, in the order of its bonds. */
static int find_common(const Hybrid *h, int32_t other, Neighbours *n, Error *error)
{
  const Family *f = h->family;
  n->count = 0;
  for (int64_t slot = f->first[other / SLICE]; slot < f->first[other / SLICE + 1]; ++slot) {
    if (!(f->intact[slot] >> other % SLICE & 1)) continue;
    const int32_t there = family_bond(f, other / SLICE, slot, other % SLICE).neighbour;
    if (n->mark[there] != n->of) continue;
    if (n->count == n->capacity) {
      n->capacity = 2 * n->capacity + 64;
      int32_t *grown = memory_grown(n->found, (size_t)n->capacity, sizeof *grown);
      if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: members of bonds");
      n->found = grown;
    }
    n->found[n->count++] = there;
  }
  return BRECCIA_OK;
}

/** Owner and neighbour of a row; -1: it has no bond. */
static int32_t owner_of(const Hybrid *h, int64_t slice, int64_t row, Bond *bond)
{
  int64_t slot;
  int lane;
  bond_list_bond(h->bonds, h->family, slice, row, &slot, &lane);
  if (!(h->family->intact[slot] >> lane & 1)) return -1;
  *bond = family_bond(h->family, slice, slot, lane);
  return (int32_t)(slice * SLICE + lane);
}

/** Members of all rows: counted, or written. */
static int list_members(Hybrid *h, Neighbours *n, bool write, Error *error)
{
  int status = BRECCIA_OK;
  n->of = 0;
  memset(n->mark, 0, sizeof *n->mark * (size_t)h->particles->places);
  for (int64_t slice = 0; slice < h->particles->slices; ++slice)
    for (int64_t row = h->bonds->first[slice]; row < h->bonds->first[slice + 1] && !status; ++row) {
      Bond bond;
      const int32_t owner = owner_of(h, slice, row, &bond);
      if (owner < 0) continue;
      mark_neighbours(h, owner, n);
      status = find_common(h, bond.neighbour, n, error);
      if (!write) {
        h->first[row + 1] = n->count + 2;
        continue;
      }
      int32_t *to = h->member + h->first[row];
      to[0] = owner;
      to[1] = bond.neighbour;
      memcpy(to + 2, n->found, sizeof *to * (size_t)n->count);
    }
  for (int64_t row = 0; row < h->bonds->count && !write; ++row) h->first[row + 1] += h->first[row];
  return status;
}

static int create_members(Hybrid *h, Error *error)
{
  const size_t rows = (size_t)h->bonds->count, places = (size_t)h->particles->places;
  Neighbours n = {.mark = memory_zeroed(places, sizeof(int32_t), "members of bonds", error)};
  h->first = memory_zeroed(rows + 1, sizeof *h->first, "members of bonds", error);
  int status = n.mark && h->first ? list_members(h, &n, false, error) : BRECCIA_FAILURE;
  if (!status) {
    const size_t members = (size_t)h->first[rows];
    h->member = memory_zeroed(members, sizeof *h->member, "members of bonds", error);
    h->g = memory_zeroed(members, sizeof *h->g, "members of bonds", error);
    status = h->member && h->g ? list_members(h, &n, true, error) : BRECCIA_FAILURE;
  }
  int most = 0;
  for (size_t row = 0; row < rows && !status; ++row)
    if (hybrid_members(h, (int64_t)row) > most) most = hybrid_members(h, (int64_t)row);
  if (!status && !(h->tried = memory_zeroed((size_t)most, sizeof *h->tried, "members of bonds", error)))
    status = BRECCIA_FAILURE;
  free(n.mark);
  free(n.found);
  return status;
}

/** Of each place the rows that it is a member of; where stress acts on ends only, of which it is an end. */
static int create_meetings(Hybrid *h, Error *error)
{
  const int64_t places = h->particles->places, rows = h->bonds->count;
  h->met_first = memory_zeroed((size_t)places + 2, sizeof *h->met_first, "members of bonds", error);
  if (!h->met_first) return BRECCIA_FAILURE;
  for (int turn = 0; turn < 2; ++turn) {
    for (int64_t row = 0; row < rows; ++row)
      for (int n = 0; n < hybrid_members(h, row) && (!h->pairwise || n < 2); ++n) {
        const int32_t place = h->member[h->first[row] + n];
        if (turn)
          h->met[h->met_first[place + 1]++] = (HybridMeeting){(int32_t)row, n};
        else
          ++h->met_first[place + 2];
      }
    if (turn) break;
    for (int64_t i = 0; i < places; ++i) h->met_first[i + 2] += h->met_first[i + 1];
    h->met = memory_zeroed((size_t)h->met_first[places + 1], sizeof *h->met, "members of bonds", error);
    if (!h->met) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

static int refuse(const Hybrid *h, int32_t place, const char *what, Error *error)
{
  const Particles *p = h->particles;
  return error_add(
      error, BRECCIA_USER_ERROR,
      "particle %d at [%g, %g, %g] %s that span no %s, so that there is no strain; the horizon is %g: give "
      "a longer horizon, or the body at least two layers in every direction",
      p->number[place], p->position[0][place], p->position[1][place], p->position[2][place], what,
      h->dimensions == 2 ? "plane" : "space", h->family->horizon);
}

/** Section a = w V (K_A^-1 + K_B^-1) xi / L and volume a . xi / d of each bond: the volumes add up to that of the body, and a uniform stress passes
 *  through it exactly, whatever its shape (docs/theory.md 5.3). */
static int create_areas(Hybrid *h, Error *error)
{
  const Particles *p = h->particles;
  double(*shape)[6] = memory_zeroed((size_t)p->places, sizeof *shape, "areas of bonds", error);
  h->area = memory_zeroed((size_t)h->bonds->count, sizeof *h->area, "areas of bonds", error);
  h->volume = memory_zeroed((size_t)h->bonds->count, sizeof *h->volume, "areas of bonds", error);
  h->idle = memory_zeroed((size_t)h->bonds->count, 1, "areas of bonds", error);
  int status = shape && h->area && h->volume && h->idle ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int32_t n = 0; n < p->count && !status; ++n)
    if (!find_shape(h, p->place_of[n], shape[p->place_of[n]])) status = refuse(h, p->place_of[n], "has bonds", error);
  for (int64_t slice = 0; slice < p->slices && !status; ++slice)
    for (int64_t row = h->bonds->first[slice]; row < h->bonds->first[slice + 1] && !status; ++row) {
      Bond bond;
      const int32_t owner = owner_of(h, slice, row, &bond);
      h->idle[row] = owner < 0;
      if (owner < 0) continue;
      int64_t slot, rows[2];
      int lane;
      bond_list_bond(h->bonds, h->family, slice, row, &slot, &lane);
      bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
      const double share = rows[0] == rows[1] ? 1 : 0.5;
      double own[3], their[3];
      times(shape[owner], bond.xi, own);
      times(shape[bond.neighbour], bond.xi, their);
      for (int k = 0; k < 3; ++k) {
        h->area[row][k] = share * p->volume[owner] * bond.weight / bond.length * (own[k] + their[k]);
        h->volume[row] += h->area[row][k] * bond.xi[k] / h->dimensions;
      }
      h->idle[row] = h->volume[row] == 0; /* influence may end at the horizon */
      if (!h->idle[row] && !hybrid_weigh(h, row, h->g + h->first[row]))
        status = refuse(h, owner, "has a bond whose two ends see particles", error);
    }
  free(shape);
  return status;
}

int hybrid_measure(Hybrid *h, Error *error)
{
  int status = create_members(h, error);
  if (!status) status = create_meetings(h, error);
  return status ? status : create_areas(h, error);
}
