/* Which particles give a bond its strain, by which vectors, and how large its section is: of listed bonds, and for those who ask of any bond. */
#include "formulation/hybrid.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <stdlib.h>
#include <string.h>

/** Whether two places see each other, or are one. */
static bool sees(const Hybrid *h, int32_t a, int32_t b)
{
  if (a == b || (is_foreign(h->foreign, a) && is_foreign(h->foreign, b))) return true;
  if ((a == h->hidden[0] && b == h->hidden[1]) || (a == h->hidden[1] && b == h->hidden[0])) return false;
  return family_joins(h->family, a, b);
}

double hybrid_invert(const Hybrid *h, double m[6], double inverse[6])
{
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
  const double evenness = largest > 0 ? fmax(0, least / largest) : 0;
  if (evenness > FORMULATION_LEAST_EVENNESS) tensor_inverse(m, inverse);
  return evenness;
}

static void times(const double a[6], const double v[3], double to[3])
{
  for (int i = 0; i < 3; ++i) {
    to[i] = 0;
    for (int j = 0; j < 3; ++j) to[i] += a[symmetric_place[3 * i + j]] * v[j];
  }
}

double hybrid_fit(const Hybrid *h, int count, double moment[6], const double xi[3], double (*g)[3])
{
  double inverse[6], square = 0;
  const double evenness = hybrid_invert(h, moment, inverse);
  if (!(evenness > FORMULATION_LEAST_EVENNESS)) return evenness;
  for (int k = 0; k < 3; ++k) square += xi[k] * xi[k];
  for (int n = 0; n < count; ++n) {
    const double from[3] = {g[n][0], g[n][1], g[n][2]};
    double along = (n == 1) - (n == 0);
    times(inverse, from, g[n]);
    for (int k = 0; k < 3; ++k) along -= g[n][k] * xi[k];
    for (int k = 0; k < 3; ++k) g[n][k] += h->own * along * xi[k] / square;
  }
  return evenness;
}

/** Computes the vectors g of the members of a listed row for the bonds that are intact now.
 *  @param[out] laminate  laminate of the row; NULL: the row is no laminate
 *  @param[out] fit       NULL, or instead of g the inverse moment and the mean position less that of the owner
 *  @return evenness of the members (hybrid_invert); no vectors exist at FORMULATION_LEAST_EVENNESS and below, where the
 *          point carries nothing */
static double weigh(const Hybrid *h, int64_t number, double (*g)[3], HybridLaminate *laminate, double fit[9])
{
  const Particles *p = h->particles;
  const int32_t *member = h->member + h->first[number];
  const int count = (int)(h->first[number + 1] - h->first[number]);
  double *weight = h->tried_weight, (*from)[3] = h->tried_from;
  memset(g, 0, sizeof *g * (size_t)count);
  if (h->volume[number] == 0 || !sees(h, member[0], member[1])) return 0;
  double middle[3] = {0}, whole = 0, m[6] = {0}, xi[3];
  for (int n = 0; n < count; ++n) {
    const bool present = sees(h, member[n], member[0]) && sees(h, member[n], member[1]);
    weight[n] = present ? p->volume[member[n]] * hybrid_laminate_alike(h, member, n, laminate) : 0;
    whole += weight[n];
    for (int k = 0; k < 3; ++k) {
      from[n][k] = p->position[k][member[n]] - p->position[k][member[0]];
      middle[k] += weight[n] * from[n][k];
    }
  }
  for (int k = 0; k < 3; ++k) {
    xi[k] = from[1][k];
    middle[k] /= whole;
  }
  for (int n = 0; n < count; ++n) {
    double apart[3];
    for (int k = 0; k < 3; ++k) apart[k] = from[n][k] - middle[k];
    for (int k = 0; k < 6; ++k) m[k] += weight[n] * apart[symmetric_row[k]] * apart[symmetric_column[k]];
    for (int k = 0; k < 3; ++k) g[n][k] = weight[n] * apart[k];
  }
  if (fit) {
    memcpy(fit + 6, middle, sizeof middle);
    return hybrid_invert(h, m, fit);
  }
  const double evenness = hybrid_fit(h, count, m, xi, g);
  if (!(evenness > FORMULATION_LEAST_EVENNESS)) {
    memset(g, 0, sizeof *g * (size_t)count);
    return evenness;
  }
  const HybridMembers of = {count, member, weight, (const double(*)[3])from};
  if (laminate) hybrid_laminate_weigh(h, &of, laminate, g);
  return evenness;
}

static HybridLaminate *laminate_of(Hybrid *h, int64_t number)
{
  return h->layer && h->layer[number] >= 0 ? &h->laminate[h->layer[number]] : NULL;
}

/** Computes what a listed row's strain follows from, for the bonds that are intact now. @return false: it carries nothing */
static bool measure_row(Hybrid *h, int64_t slice, int64_t number)
{
  double fit[9];
  if (!h->moments)
    return weigh(h, number, h->g + h->first[number], laminate_of(h, number), NULL) > FORMULATION_LEAST_EVENNESS;
  if (h->volume[number] != 0) hybrid_moments_order(h, number);
  const bool carries = weigh(h, number, h->tried, NULL, fit) > FORMULATION_LEAST_EVENNESS;
  hybrid_moments_set(h, slice, number, carries ? fit : NULL, h->tried_weight);
  return carries;
}

void hybrid_renew(void *formulation, int64_t slice)
{
  Hybrid *h = formulation;
  for (int64_t place = slice * SLICE; place < (slice + 1) * SLICE && h->met_first; ++place)
    for (int64_t n = h->met_first[place]; n < h->met_first[place + 1]; ++n) {
      const int64_t number = h->met[n].number;
      const bool to_others =
          is_foreign(h->foreign, h->member[h->first[number] + 1]); /* whose breaks are not told here */
      if (h->met[n].member < 2 || to_others)
        h->idle[number] = !measure_row(h, h->member[h->first[number]] / SLICE, number);
    }
  hybrid_groups_renew(h, slice);
}

/* ---- by the bonds that are intact now ---- */

double hybrid_view_anew(const Hybrid *h, const HybridRow *at, HybridView *view)
{
  hybrid_view_at(h, at, view);
  if (at->listed < 0) return at->geometry >= 0 ? hybrid_group_weigh(h, at, view) : 0;
  view->g = (const double(*)[3])h->tried;
  view->count = (int)(h->first[at->listed + 1] - h->first[at->listed]);
  if (view->laminate) {
    view->tried_laminate = *view->laminate;
    view->laminate = &view->tried_laminate;
  }
  return weigh(h, at->listed, h->tried, view->laminate ? &view->tried_laminate : NULL, NULL);
}

double hybrid_evenness(const void *formulation, int64_t slice, int64_t slot, int lane)
{
  const Hybrid *h = formulation;
  int64_t rows[2];
  HybridView view;
  bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
  const HybridRow at = hybrid_row(h, rows[0]);
  const double evenness = hybrid_view_anew(h, &at, &view);
  return view.volume == 0 ? 1 : evenness;
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
  return hybrid_invert(h, k, inverse) > FORMULATION_LEAST_EVENNESS;
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

/** Whether both ends of a lattice bond see a place that stands elsewhere. */
static bool see_beyond(const Hybrid *h, int64_t slice, int lane, int32_t other)
{
  const Family *f = h->family;
  if (f->stored[other / SLICE] == f->first[other / SLICE + 1]) return false;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    if (f->intact[slot] >> lane & 1 && family_joins(f, other, family_bond(f, slice, slot, lane).neighbour)) return true;
  return false;
}

static int make_list_room(Hybrid *h, int64_t more, int64_t *room, Error *error)
{
  if (h->listed + more <= *room) return BRECCIA_OK;
  int64_t *grown = memory_grown(h->row, (size_t)(*room = 2 * *room + more + 64), sizeof *grown);
  if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: members of bonds");
  h->row = grown;
  return BRECCIA_OK;
}

/** Lists the bonds of a slice that lie along a lattice but have no place in the table. */
static int list_slice(Hybrid *h, int64_t slice, int64_t *room, Error *error)
{
  const Family *f = h->family;
  const BondList *l = h->bonds;
  const bool whole = h->lattice[h->particles->block[slice]].count > 0;
  if (whole && f->stored[slice] == f->first[slice + 1]) return BRECCIA_OK;
  for (int64_t group = l->owned_first[slice]; group < l->owned_first[slice + 1]; ++group)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t slot = f->first[slice] + l->owned[group];
      if (!(f->intact[slot] >> lane & 1) || (whole && !see_beyond(h, slice, lane, family_base(f, slice, slot) + lane)))
        continue;
      if (make_list_room(h, 1, room, error)) return BRECCIA_FAILURE;
      h->row[h->listed] = l->first[slice] + SLICE * (group - l->owned_first[slice]) + lane;
      if (hybrid_group_list(h, group, lane, h->listed++))
        return error_add(error, BRECCIA_FAILURE, "out of memory: members of bonds");
    }
  return BRECCIA_OK;
}

static int list_rows(Hybrid *h, Error *error)
{
  const BondList *l = h->bonds;
  const int64_t slices = h->particles->slices;
  int64_t room = l->single_first[slices];
  h->row = memory_zeroed((size_t)room, sizeof *h->row, "members of bonds", error);
  h->listed_first = memory_zeroed((size_t)slices + 1, sizeof *h->listed_first, "members of bonds", error);
  if (!h->row || !h->listed_first) return BRECCIA_FAILURE;
  for (int64_t slice = 0; slice < slices; ++slice) {
    const int64_t single = l->single_first[slice + 1] - l->single_first[slice];
    if (list_slice(h, slice, &room, error) || make_list_room(h, single, &room, error)) return BRECCIA_FAILURE;
    for (int64_t n = single; n > 0; --n) h->row[h->listed++] = l->first[slice + 1] - n;
    h->listed_first[slice + 1] = h->listed;
  }
  return BRECCIA_OK;
}

/** Members of listed rows: counted, or written. */
static int list_members(Hybrid *h, Neighbours *n, bool write, Error *error)
{
  int status = BRECCIA_OK;
  n->of = 0;
  memset(n->mark, 0, sizeof *n->mark * (size_t)h->particles->places);
  for (int64_t number = 0; number < h->listed && !status; ++number) {
    const HybridRow at = hybrid_row(h, h->row[number]);
    if (!(h->family->intact[at.slot] >> at.lane & 1)) continue;
    const int32_t owner = (int32_t)(at.slice * SLICE + at.lane),
                  other = family_bond(h->family, at.slice, at.slot, at.lane).neighbour;
    mark_neighbours(h, owner, n);
    status = find_common(h, other, n, error);
    if (!write) {
      h->first[number + 1] = n->count + 2;
      continue;
    }
    int32_t *to = h->member + h->first[number];
    to[0] = owner;
    to[1] = other;
    if (n->count) memcpy(to + 2, n->found, sizeof *to * (size_t)n->count);
  }
  for (int64_t number = 0; number < h->listed && !write; ++number) h->first[number + 1] += h->first[number];
  return status;
}

static int create_members(Hybrid *h, Error *error)
{
  const size_t rows = (size_t)h->listed, places = (size_t)h->particles->places;
  Neighbours n = {.mark = memory_zeroed(places, sizeof(int32_t), "members of bonds", error)};
  h->first = memory_zeroed(rows + 1, sizeof *h->first, "members of bonds", error);
  int status = n.mark && h->first ? list_members(h, &n, false, error) : BRECCIA_FAILURE;
  if (!status) {
    const size_t members = (size_t)h->first[rows];
    h->member = memory_zeroed(members, sizeof *h->member, "members of bonds", error);
    status = h->member ? list_members(h, &n, true, error) : BRECCIA_FAILURE;
    if (!status) status = hybrid_moments_create(h, error);
    if (!status && !h->moments && !(h->g = memory_zeroed(members, sizeof *h->g, "members of bonds", error)))
      status = BRECCIA_FAILURE;
  }
  int64_t most = 0;
  for (size_t k = 0; k < rows && !status; ++k)
    if (h->first[k + 1] - h->first[k] > most) most = h->first[k + 1] - h->first[k];
  if (!status && (!(h->tried = memory_zeroed((size_t)most, sizeof *h->tried, "members of bonds", error)) ||
                  !(h->tried_from = memory_zeroed((size_t)most, sizeof *h->tried_from, "members of bonds", error)) ||
                  !(h->tried_weight = memory_zeroed((size_t)most, sizeof *h->tried_weight, "members of bonds", error))))
    status = BRECCIA_FAILURE;
  free(n.mark);
  free(n.found);
  return status;
}

/** Of each place the listed rows that it is a member of; where forces are not found by them, and all breaks are told to
 *  both ends, of which it is an end. */
static int create_meetings(Hybrid *h, Error *error)
{
  const int64_t places = h->particles->places;
  const bool all = h->foreign || (!h->pairwise && !h->moments);
  h->met_first = memory_zeroed((size_t)places + 2, sizeof *h->met_first, "members of bonds", error);
  if (!h->met_first) return BRECCIA_FAILURE;
  for (int turn = 0; turn < 2; ++turn) {
    for (int64_t number = 0; number < h->listed; ++number)
      for (int n = 0; n < h->first[number + 1] - h->first[number] && (all || n < 2); ++n) {
        const int32_t place = h->member[h->first[number] + n];
        if (turn)
          h->met[h->met_first[place + 1]++] = (struct HybridMet){(int32_t)number, n};
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

static int refuse(const Hybrid *h, int64_t place, const char *what, Error *error)
{
  const Particles *p = h->particles;
  return error_add(
      error, BRECCIA_USER_ERROR,
      "particle %d at [%g, %g, %g] %s that span no %s, so that there is no strain; the horizon is %g: give "
      "a longer horizon, or the body at least two layers in every direction",
      p->number[place], p->position[0][place], p->position[1][place], p->position[2][place], what,
      h->dimensions == 2 ? "plane" : "space", h->family->horizon);
}

bool hybrid_is_beyond(const Hybrid *h, int64_t place, int64_t other)
{
  return body_outside(h->body, h->particles->number[place]) && body_outside(h->body, h->particles->number[other]);
}

/* Section a = w V (K_A^-1 + K_B^-1) xi / L and volume a . xi / d of each bond: the volumes add up to that of the body, and a uniform stress passes
 * through it exactly, whatever its shape (docs/theory.md 5.3). */
void hybrid_section_of(const Hybrid *h, const HybridShape *shape, const HybridRow *at, double area[3], double *volume)
{
  const int64_t owner = at->slice * SLICE + at->lane;
  const Bond bond = family_bond(h->family, at->slice, at->slot, at->lane);
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, at->slice, at->slot, at->lane, rows);
  const bool halves = is_foreign(h->foreign, bond.neighbour) ||
                      (rows[0] != rows[1] &&
                       material_is_as_stiff(points_material(h->points, rows[0]), points_material(h->points, rows[1])));
  const double share = halves ? 0.5 : 1; /* laminates are divided later (take_part) */
  double own[3], their[3];
  times(shape[owner][XX] > 0 ? shape[owner] : shape[bond.neighbour], bond.xi, own);
  times(shape[bond.neighbour][XX] > 0 ? shape[bond.neighbour] : shape[owner], bond.xi, their);
  *volume = 0;
  for (int k = 0; k < 3; ++k) {
    area[k] = share * h->particles->volume[owner] * bond.weight / bond.length * (own[k] + their[k]);
    *volume += area[k] * bond.xi[k] / h->dimensions;
  }
}

/** Returns the factor of section and volume of a listed point that is no laminate: twice its share of the bond
 *  (material_share_of_bond) if the other end has a point of its own, or 1. */
static double part_of(const Hybrid *h, const HybridRow *at, int64_t number)
{
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, at->slice, at->slot, at->lane, rows);
  const int64_t own = h->row[number], other = rows[rows[0] == own];
  return other == own ? 1
                      : 2 * material_share_of_bond(points_material(h->points, own), points_material(h->points, other));
}

/** Multiplies section and volume of a point by a factor. @return false if the factor is 0 */
static bool take_part(Hybrid *h, int64_t number, double part)
{
  h->volume[number] *= part;
  for (int k = 0; k < 3; ++k) h->area[number][k] *= part;
  return part > 0;
}

static int measure_listed(Hybrid *h, const HybridShape *shape, Error *error)
{
  h->area = memory_zeroed((size_t)h->listed, sizeof *h->area, "areas of bonds", error);
  h->volume = memory_zeroed((size_t)h->listed, sizeof *h->volume, "areas of bonds", error);
  h->idle = memory_zeroed((size_t)h->listed, 1, "areas of bonds", error);
  if (!h->area || !h->volume || !h->idle) return BRECCIA_FAILURE;
  for (int64_t number = 0; number < h->listed; ++number) {
    const HybridRow at = hybrid_row(h, h->row[number]);
    h->idle[number] = !(h->family->intact[at.slot] >> at.lane & 1);
    if (h->idle[number]) continue;
    hybrid_section_of(h, shape, &at, h->area[number], &h->volume[number]);
    if (hybrid_laminate_create(h, number, error)) return BRECCIA_FAILURE;
    HybridLaminate *laminate = laminate_of(h, number);
    const bool has_part = laminate || take_part(h, number, part_of(h, &at, number));
    if (h->volume[number] != 0 && has_part && measure_row(h, at.slice, number) &&
        (!laminate || take_part(h, number, laminate->fraction)))
      continue;
    h->idle[number] = 1; /* also where influence ends at the horizon */
    const int64_t owner = at.slice * SLICE + at.lane;
    if (h->volume[number] != 0 &&
        !hybrid_is_beyond(h, owner, family_bond(h->family, at.slice, at.slot, at.lane).neighbour))
      return refuse(h, owner, "has a bond whose two ends see particles", error);
    h->volume[number] = 0;
    memset(h->area[number], 0, sizeof h->area[number]);
  }
  return BRECCIA_OK;
}

static int measure_lattices(Hybrid *h, const HybridShape *shape, Error *error)
{
  const BondList *l = h->bonds;
  for (int64_t slice = 0; slice < h->particles->slices; ++slice)
    for (int64_t group = l->owned_first[slice]; group < l->owned_first[slice + 1]; ++group) {
      const int bad = hybrid_group_create(h, shape, slice, h->family->first[slice] + l->owned[group], group);
      if (bad < -1) return error_add(error, BRECCIA_FAILURE, "out of memory: geometries of bonds");
      if (bad >= 0) return refuse(h, slice * SLICE + bad, "has a bond whose two ends see particles", error);
    }
  return BRECCIA_OK;
}

int hybrid_measure(Hybrid *h, const FormulationParts *parts, Error *error)
{
  const Particles *p = h->particles;
  HybridShape *shape = memory_zeroed((size_t)p->places, sizeof *shape, "areas of bonds", error);
  int status = shape ? hybrid_lattices_create(h, error) : BRECCIA_FAILURE;
  if (!status) status = list_rows(h, error);
  if (!status && h->listed) status = create_members(h, error);
  if (!status && h->listed) status = create_meetings(h, error);
  if (!status && h->listed) status = hybrid_laminate_contacts(h, error);
  for (int32_t n = 0; n < p->count && !status; ++n)
    if (!find_shape(h, p->place_of[n], shape[p->place_of[n]]) && !is_foreign(h->foreign, p->place_of[n]) &&
        !body_outside(h->body, n))
      status = refuse(h, p->place_of[n], "has bonds", error);
  if (!status) status = measure_listed(h, (const HybridShape *)shape, error);
  if (!status) status = measure_lattices(h, (const HybridShape *)shape, error);
  free(shape);
  free(h->contact);
  h->contact = NULL;
  h->stripes = parts->stripe_count;
  if (!status) status = hybrid_stripes_create(h, parts->stripe, error);
  if (!status && h->moments) status = hybrid_moments_create_sums(h, error);
  return status;
}

void hybrid_forget(Hybrid *h)
{
  hybrid_lattices_destroy(h);
  hybrid_moments_destroy(h);
  free(h->row);
  free(h->listed_first);
  free(h->first);
  free(h->member);
  free(h->g);
  free(h->area);
  free(h->volume);
  free(h->idle);
  free(h->met_first);
  free(h->met);
  free(h->tried);
  free(h->tried_from);
  free(h->tried_weight);
  free(h->layer);
  free(h->laminate);
  free(h->contact);
  places_free(&h->force);
  places_free(&h->shown);
}

size_t hybrid_bytes(const void *formulation)
{
  const Hybrid *h = formulation;
  const size_t rows = (size_t)h->listed, places = (size_t)h->particles->places;
  const size_t each = sizeof *h->row + sizeof *h->first + sizeof *h->area + sizeof *h->volume + 1;
  const size_t listed = rows ? rows * each + (size_t)h->first[rows] * sizeof *h->member +
                                   places * sizeof *h->met_first + (size_t)h->met_first[places] * sizeof *h->met
                             : 0;
  const size_t vectors = !rows        ? 0
                         : h->moments ? hybrid_moments_bytes(h)
                                      : rows * HYBRID_FORCE * sizeof *h->force + places * LANES * sizeof *h->shown +
                                            (size_t)h->first[rows] * sizeof *h->g;
  const size_t laminates = h->layer ? rows * sizeof *h->layer + (size_t)h->laminates * sizeof *h->laminate : 0;
  return laminates + listed + vectors + hybrid_lattices_bytes(h);
}
