#include "solver/follow.h"

#include "base/memory.h"
#include "loading/constraint.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Directions in which a particle is held, and, behind them, those in which it is free, over its rows of motion. */
typedef struct Held {
  int32_t place;
  int held, free;
  double direction[MAX_ROWS][MAX_ROWS];
} Held;

typedef struct Numbering {
  Follow *follow;
  int64_t count; /* unknowns */
  const Unknowns *unknowns;
  int motions;
  int64_t *which; /* [places] index of a particle that is held anywhere, plus 1 */
  Held *held;
  int64_t held_count;
  bool out_of_memory;
} Numbering;

static void mark(Numbering *of, int32_t i)
{
  if (!of->which[i]) of->which[i] = ++of->held_count;
}

/** Gives each particle that is held its entry. */
static void place_held(Numbering *of)
{
  const Particles *p = of->unknowns->domain->particles;
  for (int64_t i = 0; i < p->places; ++i)
    if (of->which[i]) of->held[of->which[i] - 1].place = (int32_t)i;
}

static double product(const double a[MAX_ROWS], const double b[MAX_ROWS])
{
  double sum = 0;
  for (int k = 0; k < MAX_ROWS; ++k) sum += a[k] * b[k];
  return sum;
}

/** @param[in] row  of motion from which the direction counts */
static void hold(Numbering *of, int32_t i, int row, const double direction[3])
{
  Held *h = &of->held[of->which[i] - 1];
  double whole[MAX_ROWS] = {0};
  for (int k = 0; k < 3; ++k)
    if (direction[k] != 0) whole[row + k] = direction[k];
  for (int m = 0; m < h->held; ++m)
    if (fabs(product(h->direction[m], whole)) > 0.5) return; /* twice the same way */
  memcpy(h->direction[h->held++], whole, sizeof whole);
}

static void mark_row(const Constraint *c, int64_t n, void *context)
{
  mark(context, c->load->selection.places[n]);
}

static void hold_row(const Constraint *c, int64_t n, void *context)
{
  hold(context, c->load->selection.places[n], c->row, c->direction);
}

/** Calls for each particle that follows another one along an axis. */
static void each_tie(Numbering *of, void (*one)(Numbering *of, int32_t follower, int32_t leader, int axis))
{
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &of->unknowns->loading->ties[k];
    for (int64_t g = 0; g < ties->count; ++g)
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n)
        one(of, ties->places[n], ties->places[ties->first[g]], k);
  }
}

static void mark_tie(Numbering *of, int32_t follower, int32_t leader, int axis)
{
  (void)leader, (void)axis;
  mark(of, follower);
}

static void hold_tie(Numbering *of, int32_t follower, int32_t leader, int axis)
{
  (void)leader;
  hold(of, follower, 0, (const double[]){axis == 0, axis == 1, axis == 2});
}

static void follow_tie(Numbering *of, int32_t follower, int32_t leader, int axis)
{
  of->follow[of->motions * (int64_t)follower + axis] =
      of->follow[of->motions * (int64_t)leader + axis]; /* of its own: few terms */
}

/** Whether a row is no motion of a particle: out of a plane or line, or a rotation where there is none. */
static bool is_flat(const Numbering *of, int32_t place, int row)
{
  const Particles *p = of->unknowns->domain->particles;
  return p->space.row[row].kind == ROW_DISPLACEMENT ? of->unknowns->flat[row] : !particles_turn(p, place);
}

/** Directions across those that are held, of the axes along which the body extends: those that differ from them most come first. */
static void find_free(const Numbering *of, Held *h)
{
  int left = -h->held;
  for (int k = 0; k < of->motions; ++k) left += !is_flat(of, h->place, k);
  for (; h->free < left; ++h->free) {
    double best = 0, chosen[MAX_ROWS] = {0};
    for (int k = 0; k < of->motions; ++k) {
      double v[MAX_ROWS] = {0};
      v[k] = 1;
      for (int m = 0; m < h->held + h->free; ++m) {
        const double *d = h->direction[m], along = product(v, d);
        for (int j = 0; j < MAX_ROWS; ++j) v[j] -= along * d[j];
      }
      const double square = product(v, v);
      if (is_flat(of, h->place, k) || square < best + 1e-6) continue;
      best = square;
      for (int j = 0; j < MAX_ROWS; ++j) chosen[j] = v[j] / sqrt(square);
    }
    memcpy(h->direction[h->held + h->free], chosen, sizeof chosen);
  }
}

/** Adds to what there is of an unknown, or puts it behind the others. */
static void add_term(Numbering *of, Follow *f, int64_t unknown, double factor)
{
  Term *terms = f->count > FEW_TERMS ? f->many : f->few;
  for (int t = 0; t < f->count; ++t)
    if (terms[t].unknown == unknown) {
      terms[t].factor += factor;
      return;
    }
  if (factor == 0) return;
  if (f->count >= FEW_TERMS) {
    Term *grown = memory_grown(f->many, (size_t)f->count + 1, sizeof *grown);
    if (!grown) {
      of->out_of_memory = true;
      return;
    }
    if (f->count == FEW_TERMS) memcpy(grown, f->few, sizeof f->few);
    f->many = terms = grown;
  }
  terms[f->count++] = (Term){unknown, factor};
}

/** Unknowns of a particle of its own. */
static void follow_own(Numbering *of, int32_t i)
{
  Follow *own = &of->follow[of->motions * (int64_t)i];
  const Held *h = of->which[i] ? &of->held[of->which[i] - 1] : NULL;
  for (int k = 0; k < of->motions && !h; ++k)
    if (!is_flat(of, i, k)) add_term(of, &own[k], of->count++, 1 / unknowns_length(of->unknowns, k));
  for (int f = 0; h && f < h->free; ++f, ++of->count)
    for (int k = 0; k < of->motions; ++k)
      add_term(of, &own[k], of->count, h->direction[h->held + f][k] / unknowns_length(of->unknowns, k));
}

/** A displacement along a direction, term by term, before anything of it changes. */
static Term *terms_along(Numbering *of, const Follow *from, const double direction[3], int *count)
{
  *count = 0;
  int most = 1;
  for (int k = 0; k < 3; ++k)
    if (direction[k] != 0) most += from[k].count;
  Term *terms = memory_plain((size_t)most, sizeof *terms);
  if (!terms) of->out_of_memory = true;
  for (int k = 0; k < 3 && terms; ++k)
    for (int t = 0; direction[k] != 0 && t < from[k].count; ++t) {
      terms[*count] = follow_terms(&from[k])[t];
      terms[(*count)++].factor *= direction[k];
    }
  return terms;
}

/** Adds what a displacement of `from` along a direction is, times a share, to that of `own` along it. */
static void add_along(Numbering *of, Follow *own, const Follow *from, const double direction[3], double share)
{
  int count;
  Term *terms = terms_along(of, from, direction, &count);
  for (int k = 0; k < 3; ++k)
    for (int t = 0; direction[k] != 0 && t < count; ++t)
      add_term(of, &own[k], terms[t].unknown, share * direction[k] * terms[t].factor);
  free(terms);
}

static void follow_row(const Constraint *c, int64_t n, void *context)
{
  Numbering *of = context;
  Follow *own = &of->follow[of->motions * (int64_t)c->load->selection.places[n] + c->row];
  add_along(of, own, own, c->direction, -1);
  if (c->images) add_along(of, own, &of->follow[of->motions * (int64_t)c->images[n] + c->row], c->direction, c->share);
  for (int m = 0; m < constraint_leaders(c); ++m)
    add_along(of, own, &of->follow[of->motions * (int64_t)constraint_leader(c, m)], c->direction,
              constraint_share(c, m, n));
  for (int k = 0; c->platen && k < 3; ++k)
    if (c->direction[k] != 0) own[k].own = own[k].count;
}

Follow *follow_create(const Unknowns *u, int64_t *count, Error *error)
{
  const Particles *p = u->domain->particles;
  Numbering of = {.unknowns = u, .motions = p->space.rows};
  const int64_t all = p->space.rows * p->places;
  of.follow = memory_zeroed((size_t)all, sizeof *of.follow, "unknowns", error);
  of.which = memory_zeroed((size_t)p->places, sizeof *of.which, "unknowns", error);
  bool failed = !of.follow || !of.which;
  if (!failed) {
    unknowns_each_row(u, mark_row, &of);
    each_tie(&of, mark_tie);
    of.held = memory_zeroed((size_t)of.held_count + 1, sizeof *of.held, "unknowns", error);
    failed = !of.held;
  }
  if (!failed) {
    place_held(&of);
    unknowns_each_row(u, hold_row, &of);
    each_tie(&of, hold_tie);
    for (int64_t n = 0; n < of.held_count; ++n) find_free(&of, &of.held[n]);
    for (int64_t n = 0; n < p->count; ++n) follow_own(&of, p->place_of[n]);
    each_tie(&of, follow_tie);
    for (int64_t i = 0; i < all; ++i) of.follow[i].own = of.follow[i].count;
    unknowns_each_row(u, follow_row, &of);
    if (of.out_of_memory) error_add(error, BRECCIA_FAILURE, "out of memory: unknowns");
    failed = of.out_of_memory;
  }
  free(of.which);
  free(of.held);
  *count = of.count;
  if (failed && of.follow) follow_destroy(&of.follow, all);
  return of.follow;
}

/* ---- places that move alike ---- */

bool follow_is_whole(const Follow *follow, int motions, int64_t place)
{
  bool whole = true;
  for (int k = 0; k < motions; ++k) whole &= follow[motions * place + k].own == follow[motions * place + k].count;
  return whole;
}

static bool move_alike(const Follow *a, const Follow *b, int motions)
{
  for (int k = 0; k < motions; ++k) {
    if (a[k].count != b[k].count) return false;
    for (int t = 0; t < a[k].count; ++t) {
      const Term *of = &follow_terms(&a[k])[t], *other = &follow_terms(&b[k])[t];
      if (of->unknown != other->unknown || of->factor != other->factor) return false;
    }
  }
  return true;
}

int32_t *follow_leaders(const Follow *follow, int motions, int64_t places, int64_t count, Error *error)
{
  int32_t *leader = memory_zeroed((size_t)places, sizeof *leader, "unknowns", error);
  int32_t *first = memory_zeroed((size_t)count + 1, sizeof *first, "unknowns", error); /* plus 1, that has an unknown */
  for (int turn = 0; turn < 2 && leader && first; ++turn)
    for (int64_t i = 0; i < places; ++i) {
      const Follow *own = &follow[motions * i];
      if (follow_is_whole(follow, motions, i) != !turn) continue;
      leader[i] = (int32_t)i;
      int k = 0;
      while (k < motions && !own[k].count) ++k;
      if (k == motions) {
        leader[i] = -1;
        continue;
      }
      int32_t *known = &first[follow_terms(&own[k])[0].unknown];
      if (!turn && !*known) *known = (int32_t)i + 1;
      if (*known && move_alike(own, &follow[motions * (int64_t)(*known - 1)], motions)) leader[i] = *known - 1;
    }
  free(first);
  return leader;
}

void follow_destroy(Follow **follow, int64_t count)
{
  for (int64_t i = 0; *follow && i < count; ++i) free((*follow)[i].many);
  free(*follow);
  *follow = NULL;
}
