#include "solver/pressing.h"

#include "base/memory.h"
#include "loading/one_sided.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PATIENCE = 5, MAX_ROUNDS = 50 }; /* solutions without progress; solutions besides one for each entry */

typedef struct Wrong {
  int64_t entry;
  double size; /* pulling force or penetration of the entry, over the largest pulling force or penetration */
} Wrong;

int pressing_create(Pressing *q, const Loading *loading, Error *error)
{
  q->count = one_sided_count(loading);
  if (!q->count) return BRECCIA_OK;
  const size_t count = (size_t)q->count;
  q->begun = memory_zeroed(count, sizeof *q->begun, "one-sided supports", error);
  q->solved = memory_zeroed(count, sizeof *q->solved, "one-sided supports", error);
  q->wrong = memory_zeroed(count, sizeof *q->wrong, "one-sided supports", error);
  return q->begun && q->solved && q->wrong ? BRECCIA_OK : BRECCIA_FAILURE;
}

void pressing_destroy(Pressing *q)
{
  free(q->begun);
  free(q->solved);
  free(q->wrong);
  *q = (Pressing){0};
}

/** Calls `one` for each one-sided constraint that acts, with the index of its first entry. */
static void pressing_each(const Loading *loading,
                          void (*one)(void *context, const Constraint *constraint, int64_t first), void *context)
{
  int64_t first = 0;
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c) {
    if (!c->one_sided || !load_acts(loading, c->load)) continue;
    one(context, c, first);
    first += c->one_sided->count;
  }
}

static void pressing_copy(void *context, const Constraint *c, int64_t first)
{
  uint8_t *to = context;
  memcpy(to + first, c->one_sided->open, (size_t)c->one_sided->count);
}

static void pressing_paste(void *context, const Constraint *c, int64_t first)
{
  const uint8_t *from = context;
  memcpy(c->one_sided->open, from + first, (size_t)c->one_sided->count);
}

void pressing_begin(Pressing *q, const Newton *n)
{
  if (!q->count) return;
  pressing_each(n->loading, pressing_copy, q->begun);
  q->least = INT64_MAX;
  q->rounds = q->taken = q->wrong_count = 0;
  q->known = q->last_alone = false;
  q->reference = n->reference;
  q->loose = (LoosePiece){0};
}

/* ---- wrong entries ---- */

typedef struct Review {
  Pressing *pressing;
  const Particles *particles;
  double time, force, gap; /* time of the solution; tolerances of force and gap */
  double pulls, depth;     /* largest pulling force; largest penetration */
} Review;

static void pressing_review(void *context, const Constraint *c, int64_t first)
{
  Review *r = context;
  Pressing *q = r->pressing;
  const OneSided *o = c->one_sided;
  for (int64_t n = 0; n < o->count; ++n) {
    const double pull = -o->found[n], depth = o->open[n] ? -one_sided_gap(c, r->particles, n, r->time) : 0;
    if (o->open[n] ? !(depth > r->gap) : !(pull > r->force)) continue;
    q->wrong[q->wrong_count++] = (Wrong){first + n, o->open[n] ? depth : pull};
    *(o->open[n] ? &r->depth : &r->pulls) = fmax(o->open[n] ? r->depth : r->pulls, o->open[n] ? depth : pull);
  }
}

/** Orders wrong entries by decreasing size, and equal ones by index. */
static int pressing_compare(const void *a, const void *b)
{
  const Wrong *one = a, *other = b;
  if (one->size != other->size) return one->size < other->size ? 1 : -1;
  return (one->entry > other->entry) - (one->entry < other->entry);
}

static void pressing_find_wrong(Pressing *q, const Newton *n, double time)
{
  const Particles *p = n->domain->particles;
  Review r = {.pressing = q,
              .particles = p,
              .time = time,
              .force = fmax(n->spec->residual * n->exerted, n->roundings),
              .gap = n->spec->residual * vector_largest(&p->displacement)};
  q->wrong_count = 0;
  pressing_each(n->loading, pressing_review, &r);
  pressing_each(n->loading, pressing_copy, q->solved);
  for (int64_t k = 0; k < q->wrong_count; ++k) q->wrong[k].size /= q->solved[q->wrong[k].entry] ? r.depth : r.pulls;
  qsort(q->wrong, (size_t)q->wrong_count, sizeof *q->wrong, pressing_compare);
}

/** Chooses the number of wrong entries that change after a set has come to equilibrium. */
static void pressing_take(Pressing *q)
{
  q->last_alone = false;
  q->taken = q->wrong_count;
  if (q->wrong_count < q->least) {
    q->least = q->wrong_count;
    q->patience = PATIENCE;
  } else if (q->patience > 0) {
    --q->patience;
  } else {
    q->last_alone = true;
    q->taken = 1;
  }
}

bool pressing_is_wrong(Pressing *q, const Newton *n, double time, NewtonOutcome *outcome)
{
  if (!q->count || *outcome >= NEWTON_STOPPED) return false;
  if (*outcome != NEWTON_CONVERGED) {
    if (!q->known || q->taken <= 1) return false;
    q->taken = (q->taken + 1) / 2;
    return true;
  }
  pressing_find_wrong(q, n, time);
  q->known = true;
  if (!q->wrong_count) return false;
  if (++q->rounds > MAX_ROUNDS + q->count) {
    *outcome = NEWTON_SLOW;
    return false;
  }
  pressing_take(q);
  return true;
}

/* ---- the next set ---- */

static int64_t pressing_last_wrong(const Pressing *q)
{
  int64_t last = 0;
  for (int64_t k = 1; k < q->wrong_count; ++k)
    if (q->wrong[k].entry > q->wrong[last].entry) last = k;
  return last;
}

/** Opens and closes the entries that change. @return number of opened entries */
static int64_t pressing_change(Pressing *q, const Loading *loading)
{
  int64_t opened = 0;
  const int64_t first = q->last_alone ? pressing_last_wrong(q) : 0;
  for (int64_t k = first; k < first + q->taken; ++k) {
    opened += !q->solved[q->wrong[k].entry];
    q->solved[q->wrong[k].entry] ^= 1;
  }
  pressing_each(loading, pressing_paste, q->solved);
  for (int64_t k = first; k < first + q->taken; ++k) q->solved[q->wrong[k].entry] ^= 1;
  return opened;
}

/** Returns true if the set leaves no piece of a body in equilibrium unsupported; stores the first such piece. */
static bool pressing_holds(Pressing *q, const Newton *n)
{
  LoosePiece loose;
  if (n->beside || pieces_find_loose(&n->linear.unknowns, PIECES_WORKED, &loose, NULL) || !loose.pieces) return true;
  if (!q->loose.pieces) q->loose = loose;
  return false;
}

bool pressing_choose(Pressing *q, Newton *n)
{
  for (;; q->taken = (q->taken + 1) / 2) {
    const int64_t opened = pressing_change(q, n->loading);
    const bool holds = !opened || pressing_holds(q, n);
    if (holds && n->log)
      text_add(n->log, "  supports that only press let go of %lld particles and close at %lld\n", (long long)opened,
               (long long)(q->taken - opened));
    if (holds || q->taken == 1) {
      n->reference = q->reference;
      return holds;
    }
  }
}

void pressing_take_up(const Newton *n, const Vector *drag)
{
  const Particles *p = n->domain->particles;
  if (!one_sided_count(n->loading)) return;
  vector_weigh_sum(&n->force, p->volume, &p->internal, &p->external);
  if (drag) vector_combine(1, &n->force, -1, drag);
  one_sided_find(n->loading, &n->force);
  one_sided_accept(n->loading);
}

typedef struct Closing {
  const Pressing *pressing;
  void (*one)(void *context, const Constraint *constraint, int64_t entry);
  void *context;
} Closing;

static void pressing_find_closing(void *context, const Constraint *c, int64_t first)
{
  const Closing *closing = context;
  for (int64_t n = 0; n < c->one_sided->count; ++n)
    if (closing->pressing->begun[first + n] && !c->one_sided->open[n]) closing->one(closing->context, c, n);
}

void pressing_each_closing(const Pressing *q, const Loading *loading,
                           void (*one)(void *context, const Constraint *constraint, int64_t entry), void *context)
{
  if (q->count) pressing_each(loading, pressing_find_closing, &(Closing){q, one, context});
}
