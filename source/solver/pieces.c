#include "solver/pieces.h"

#include "base/memory.h"
#include "loading/constraint.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RIGID = 6 };

/** How a piece is held against motions as a whole: moment[a][b] = sum over rows of what a and b do to them. */
typedef struct Hold {
  int64_t particles, inside; /* all, and without images outside supports */
  int32_t place;             /* of its particle of the lowest number inside */
  bool loaded, worked;       /* a load acts on it; a load or a prescribed motion */
  double low[3], high[3], centre[3], size;
  double moment[RIGID][RIGID];
} Hold;

/** Places that belong together, each with one nearer to the first of its piece: the first is its own. */
typedef struct Pieces {
  const Unknowns *unknowns;
  const Particles *particles;
  int32_t *nearer; /* [places] */
  int64_t count;
  Hold *holds;      /* [count] in the order of the first places */
  int32_t *hold_of; /* [places] of first places */
} Pieces;

/* ---- who belongs together ---- */

static int32_t first_of(const Pieces *q, int32_t i)
{
  int32_t *nearer = q->nearer;
  while (nearer[i] != i) i = nearer[i] = nearer[nearer[i]];
  return i;
}

static void join(void *context, int32_t a, int32_t b)
{
  Pieces *q = context;
  const int32_t i = first_of(q, a), j = first_of(q, b);
  if (i == j) return;
  q->nearer[i < j ? j : i] = i < j ? i : j;
  --q->count;
}

/** Slot by slot of all slices: most bodies are one piece after the first few. */
static void join_bonds(Pieces *q)
{
  const Family *f = &q->unknowns->domain->family;
  const int64_t slices = q->particles->places / SLICE;
  bool more = true;
  for (int64_t k = 0; more && q->count > 1; ++k) {
    more = false;
    for (int64_t s = 0; s < slices; ++s) {
      const int64_t slot = f->first[s] + k;
      if (slot >= f->first[s + 1]) continue;
      more = true;
      for (int lane = 0; lane < SLICE; ++lane)
        if (f->intact[slot] >> lane & 1) join(q, (int32_t)(s * SLICE + lane), family_bond(f, s, slot, lane).neighbour);
    }
  }
}

static void join_images(const Constraint *c, int64_t n, void *context)
{
  if (c->images) join(context, c->load->selection.places[n], c->images[n]);
  for (int m = 0; m < constraint_leaders(c); ++m) join(context, c->load->selection.places[n], constraint_leader(c, m));
}

static void join_selection(Pieces *q, int32_t first, const Selection *selection)
{
  for (int64_t n = 0; n < selection->count; ++n) join(q, first, selection->places[n]);
}

static bool is_spring(const Pieces *q, const Load *load)
{
  return load->type->eigenvalue && load_acts(q->unknowns->loading, load) &&
         load->type->eigenvalue(load, q->particles) > 0;
}

static void join_loads(Pieces *q)
{
  const Loading *loading = q->unknowns->loading;
  unknowns_each_row(q->unknowns, join_images, q);
  for (int k = 0; k < 3; ++k)
    for (int64_t g = 0; g < loading->ties[k].count; ++g)
      for (int64_t n = loading->ties[k].first[g] + 1; n < loading->ties[k].first[g + 1]; ++n)
        join(q, loading->ties[k].places[loading->ties[k].first[g]], loading->ties[k].places[n]);
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (!is_spring(q, load) || !load->other.count) continue;
    join_selection(q, load->selection.places[0], &load->selection);
    join_selection(q, load->selection.places[0], &load->other);
  }
}

static int find_pieces(Pieces *q, bool together, Error *error)
{
  const Particles *p = q->particles;
  const size_t places = (size_t)p->places + 1;
  q->nearer = memory_zeroed(places, sizeof *q->nearer, "pieces of the body", error);
  q->hold_of = memory_zeroed(places, sizeof *q->hold_of, "pieces of the body", error);
  if (!q->nearer || !q->hold_of) return BRECCIA_FAILURE;
  q->count = p->count;
  for (int64_t i = 0; i < p->places; ++i) q->nearer[i] = (int32_t)i;
  for (int64_t n = 1; together && n < p->count; ++n) join(q, p->place_of[0], p->place_of[n]);
  join_bonds(q);
  join_loads(q);
  forces_join(&q->unknowns->domain->forces, join, q);
  if (!(q->holds = memory_zeroed((size_t)q->count + 1, sizeof *q->holds, "pieces of the body", error)))
    return BRECCIA_FAILURE;
  int32_t next = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n], first = first_of(q, i);
    if (!q->hold_of[first]) { /* counted from 1 */
      q->hold_of[first] = ++next;
      Hold *new = &q->holds[next - 1];
      for (int k = 0; k < 3; ++k) new->low[k] = new->high[k] = p->position[k][i];
    }
    Hold *h = &q->holds[q->hold_of[first] - 1];
    ++h->particles;
    if (q->unknowns->domain->counted[i] > 0 && !h->inside++) h->place = i;
    for (int k = 0; k < 3; ++k) {
      h->low[k] = fmin(h->low[k], p->position[k][i]);
      h->high[k] = fmax(h->high[k], p->position[k][i]);
    }
  }
  for (int64_t n = 0; n < q->count; ++n) {
    Hold *h = &q->holds[n];
    for (int k = 0; k < 3; ++k) {
      h->centre[k] = (h->low[k] + h->high[k]) / 2;
      h->size = fmax(h->size, (h->high[k] - h->low[k]) / 2);
    }
    if (!(h->size > 0)) h->size = 1;
  }
  return BRECCIA_OK;
}

static Hold *hold_at(const Pieces *q, int32_t place)
{
  return &q->holds[q->hold_of[first_of(q, place)] - 1];
}

/* ---- what holds them ---- */

/** Displacements of a particle in the motions as a whole, along a direction: three shifts, and three turns of the edge of the piece by 1. */
static void rigid(const Pieces *q, const Hold *h, const double direction[3], int32_t i, double share,
                  double moved[RIGID])
{
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const double y = (q->particles->position[next][i] - h->centre[next]) / h->size;
    const double z = (q->particles->position[last][i] - h->centre[last]) / h->size;
    moved[k] += share * direction[k];
    moved[3 + k] += share * (direction[last] * y - direction[next] * z);
  }
}

static void add_row(Hold *h, const double moved[RIGID])
{
  for (int a = 0; a < RIGID; ++a)
    for (int b = 0; b < RIGID; ++b) h->moment[a][b] += moved[a] * moved[b];
}

static void hold_row(const Constraint *c, int64_t n, void *context)
{
  double moved[RIGID] = {0};
  const Pieces *q = context;
  const int32_t i = c->load->selection.places[n];
  Hold *h = hold_at(q, i);
  h->worked = true;
  if (c->row) { /* a particle that cannot turn */
    for (int k = 0; k < 3; ++k)
      if (c->direction[k] != 0) moved[q->particles->space.rows == 4 ? RIGID - 1 : 3 + k] = c->direction[k];
    add_row(h, moved);
    return;
  }
  rigid(q, h, c->direction, i, 1, moved);
  if (c->images) rigid(q, h, c->direction, c->images[n], -c->share, moved);
  for (int m = 0; m < constraint_leaders(c); ++m)
    rigid(q, h, c->direction, constraint_leader(c, m), -constraint_share(c, m, n), moved);
  add_row(h, moved);
}

static void hold_ties(const Pieces *q)
{
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &q->unknowns->loading->ties[k];
    const double axis[3] = {k == 0, k == 1, k == 2};
    for (int64_t g = 0; g < ties->count; ++g)
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n) {
        double moved[RIGID] = {0};
        Hold *h = hold_at(q, ties->places[n]);
        rigid(q, h, axis, ties->places[n], 1, moved);
        rigid(q, h, axis, ties->places[ties->first[g]], -1, moved);
        add_row(h, moved);
      }
  }
}

/** A spring to the ground, in its direction or in all. */
static void hold_spring(const Pieces *q, const Load *load)
{
  static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double *given = load->type->vector(load->value),
               length = sqrt(given[0] * given[0] + given[1] * given[1] + given[2] * given[2]),
               along[3] = {given[0] / length, given[1] / length, given[2] / length};
  for (int64_t n = 0; n < load->selection.count; ++n)
    for (int k = 0; k < (isnan(along[0]) ? 3 : 1); ++k) {
      double moved[RIGID] = {0};
      const int32_t i = load->selection.places[n];
      rigid(q, hold_at(q, i), isnan(along[0]) ? axes[k] : along, i, 1, moved);
      add_row(hold_at(q, i), moved);
    }
}

static void note_loads(const Pieces *q)
{
  const Loading *loading = q->unknowns->loading;
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (!load_acts(loading, load)) continue;
    const Selection *of[] = {&load->selection, &load->other};
    for (int k = 0; k < 2; ++k)
      for (int64_t n = 0; n < of[k]->count; ++n) {
        Hold *h = hold_at(q, of[k]->places[n]);
        h->worked = h->loaded = true;
      }
    if (is_spring(q, load) && !load->other.count) hold_spring(q, load);
  }
}

/** Takes from the others what one motion shares with them, the most held first; shifts before turns, so that a piece that is held at one point is told to
 *  turn about it. @return the first that nothing holds, or -1 */
static int find_free_motion(Hold *h, const bool wanted[RIGID])
{
  bool done[RIGID];
  double largest = 0;
  for (int a = 0; a < RIGID; ++a) {
    done[a] = !wanted[a];
    largest = fmax(largest, h->moment[a][a]);
  }
  for (;;) {
    int pivot = -1;
    for (int a = 0; a < RIGID && !(a == 3 && pivot >= 0); ++a)
      if (!done[a] && (pivot < 0 || h->moment[a][a] > h->moment[pivot][pivot])) pivot = a;
    if (pivot < 0) return -1;
    if (!(h->moment[pivot][pivot] > 1e-10 * largest)) return pivot;
    done[pivot] = true;
    for (int a = 0; a < RIGID; ++a)
      for (int b = 0; b < RIGID && !done[a]; ++b)
        if (!done[b]) h->moment[a][b] -= h->moment[a][pivot] * h->moment[pivot][b] / h->moment[pivot][pivot];
  }
}

/** Whether a single particle that nothing joins to others is let be: nothing acts on it, or something holds it. */
static bool is_let_be(const Hold *h)
{
  bool held = false;
  for (int a = 0; a < RIGID; ++a) held |= h->moment[a][a] > 0;
  return held || !h->loaded;
}

static void judge(Pieces *q, PiecesTaken taken, LoosePiece *loose)
{
  const int dimensions = q->unknowns->domain->body.dimensions;
  unknowns_each_row(q->unknowns, hold_row, q);
  hold_ties(q);
  note_loads(q);
  for (int64_t n = 0; n < q->count; ++n) {
    Hold *h = &q->holds[n];
    const bool turns = h->particles > 1 || q->particles->space.rows > 3;
    const bool wanted[RIGID] = {true,
                                dimensions > 1,
                                dimensions > 2,
                                turns && dimensions > 2,
                                turns && dimensions > 2,
                                turns && dimensions > 1};
    if (!h->inside || (h->particles == 1 && q->count > 1 && is_let_be(h)) || (taken == PIECES_WORKED && !h->worked))
      continue;
    const int motion = find_free_motion(h, wanted);
    if (motion < 0) continue;
    ++loose->pieces;
    if (h->inside <= loose->particles) continue;
    loose->particles = h->inside;
    loose->whole = h->particles == q->particles->count;
    loose->place = h->place;
    snprintf(loose->motion, sizeof loose->motion, "%s %c", motion < 3 ? "along" : "about", "xyz"[motion % 3]);
  }
}

int pieces_find_loose(const Unknowns *unknowns, PiecesTaken taken, LoosePiece *loose, Error *error)
{
  Pieces q = {.unknowns = unknowns, .particles = unknowns->domain->particles};
  *loose = (LoosePiece){0};
  const int status = find_pieces(&q, taken == PIECES_TOGETHER, error);
  if (!status) judge(&q, taken, loose);
  free(q.nearer);
  free(q.hold_of);
  free(q.holds);
  return status;
}

const char *pieces_describe(const LoosePiece *loose, const Particles *particles, char *words, size_t size)
{
  if (loose->whole) {
    snprintf(words, size, "nothing holds the body against moving %s as a whole", loose->motion);
    return words;
  }
  double at[3];
  for (int k = 0; k < 3; ++k) at[k] = particles->position[k][loose->place];
  char others[64] = "";
  if (loose->pieces > 1) snprintf(others, sizeof others, ", nor %lld smaller ones", (long long)loose->pieces - 1);
  snprintf(words, size,
           "nothing holds a piece of %lld particle%s, with particle %d at [%g, %g, %g], against moving %s as a whole%s",
           (long long)loose->particles, loose->particles == 1 ? "" : "s", particles->number[loose->place], at[0], at[1],
           at[2], loose->motion, others);
  return words;
}
