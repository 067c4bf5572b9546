#include "loading/one_sided.h"

#include "base/memory.h"
#include "body/body.h"
#include "loading/constraint.h"
#include "loading/platen.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- creation ---- */

/** Adds the bonds of a particle to other particles of the body: the sum of V_i V_j xi along a direction, and the sum of
 * the absolute values of these products. */
static void one_sided_add_bonds(const LoadMaking *making, int32_t i, const double direction[3], double *along,
                                double *size)
{
  const Body *body = making->body;
  const Family *f = making->family;
  const Particles *p = &body->particles;
  for (int64_t slot = f->first[i / SLICE]; slot < f->first[i / SLICE + 1]; ++slot) {
    if (!(f->intact[slot] >> i % SLICE & 1)) continue;
    const Bond bond = family_bond(f, i / SLICE, slot, i % SLICE);
    const double volumes = p->volume[i] * p->volume[bond.neighbour];
    if (body_outside(body, p->number[bond.neighbour])) continue;
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach += volumes * bond.xi[k] * direction[k];
    *along += reach;
    *size += fabs(reach);
  }
}

int one_sided_find_side(const Load *load, const LoadMaking *making, const double direction[3])
{
  const double least = 0.6; /* bonds of the outermost layer have a ratio of 1, of two layers 0.75, of three 0.45 */
  double along = 0, size = 0;
  for (int64_t n = 0; n < load->selection.count; ++n)
    one_sided_add_bonds(making, load->selection.places[n], direction, &along, &size);
  if (!(fabs(along) > least * size)) return 0;
  return along > 0 ? 1 : -1;
}

/** Returns the only motion that a load prescribes, or NULL after a message if there are several. */
static Constraint *one_sided_find_constraint(const LoadMaking *making, const Load *load)
{
  Loading *loading = making->loading;
  Constraint *found = NULL;
  int count = 0;
  for (int c = 0; c < loading->constraint_count; ++c) {
    if (loading->constraints[c].load != load) continue;
    found = &loading->constraints[c];
    ++count;
  }
  if (count == 1) return found;
  node_error(making->reader->document, section_node(load->spec, "only presses"), making->reader->error,
             "only presses: its motion is to be prescribed in one direction, and here it is in %d; give the others as "
             "'free', and prescribe them by a load of their own",
             count);
  return NULL;
}

static int one_sided_make(Constraint *c, const LoadMaking *making)
{
  const DeckReader *reader = making->reader;
  const Node *node = section_node(c->load->spec, "only presses");
  const int side = one_sided_find_side(c->load, making, c->direction);
  if (!side)
    return node_error(reader->document, node, reader->error,
                      "only presses: the body lies on both sides of these particles along [%g, %g, %g], so that the "
                      "side from which the support pushes is unknown; select only the outermost layer at the face that "
                      "it touches",
                      c->direction[0], c->direction[1], c->direction[2]);
  if (history_is_controlled(&c->load->history))
    return node_error(reader->document, node, reader->error,
                      "only presses: the factor of this load is found by control, which it could not be once the load "
                      "has let go; leave 'only presses' out, or give it a 'ramp' or a 'table'");
  OneSided *q = c->one_sided = memory_zeroed(1, sizeof *q, "one-sided supports", reader->error);
  if (!q) return BRECCIA_FAILURE;
  q->pushes = side;
  q->count = c->platen ? 1 : c->load->selection.count;
  q->open = memory_zeroed((size_t)q->count, sizeof *q->open, "one-sided supports", reader->error);
  q->presses = memory_zeroed((size_t)q->count, sizeof(double), "one-sided supports", reader->error);
  q->found = memory_zeroed((size_t)q->count, sizeof(double), "one-sided supports", reader->error);
  if (!q->open || !q->presses || !q->found) return BRECCIA_FAILURE;
  return c->platen ? platen_loosen(c, reader->error) : BRECCIA_OK;
}

int one_sided_create(const LoadMaking *making)
{
  int status = BRECCIA_OK;
  for (int l = 0; l < making->loading->count && status != BRECCIA_FAILURE; ++l) {
    const Load *load = &making->loading->loads[l];
    if (!load->spec || !load->spec->only_presses || load->type->force) continue; /* springs implement it themselves */
    Constraint *c = one_sided_find_constraint(making, load);
    const int bad = c ? one_sided_make(c, making) : BRECCIA_USER_ERROR;
    if (bad) status = bad;
  }
  return status;
}

void one_sided_destroy(OneSided *q)
{
  if (!q) return;
  free(q->open);
  free(q->presses);
  free(q->found);
  free(q);
}

void one_sided_close(const Constraint *c)
{
  const OneSided *q = c->one_sided;
  for (int64_t n = 0; q && n < q->count; ++n) {
    q->open[n] = 0;
    q->presses[n] = q->found[n] = 0;
  }
}

/* ---- entries of a stage ---- */

static bool one_sided_acts(const Loading *loading, const Constraint *c)
{
  return c->one_sided && load_acts(loading, c->load);
}

int64_t one_sided_count(const Loading *loading)
{
  int64_t count = 0;
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c)
    if (one_sided_acts(loading, c)) count += c->one_sided->count;
  return count;
}

/** The hash function FNV-1a (Fowler, Noll and Vo), of 64 bits. */
int64_t one_sided_key(const Loading *loading)
{
  uint64_t hash = 0xcbf29ce484222325;
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c)
    for (int64_t n = 0; one_sided_acts(loading, c) && n < c->one_sided->count; ++n)
      hash = (hash ^ c->one_sided->open[n]) * 0x100000001b3;
  return (int64_t)hash;
}

/* ---- gaps and forces ---- */

double one_sided_gap(const Constraint *c, const Particles *p, int64_t entry, double time)
{
  const double prescribed = constraint_displacement(c, time), pushes = c->one_sided->pushes;
  if (c->platen) return pushes * (platen_centre_displacement(c, p->displacement.row) - prescribed);
  const int32_t i = c->load->selection.places[entry];
  return pushes * (constraint_along(c, p->displacement.row, i) - prescribed * constraint_part(c, entry) -
                   constraint_from(c, entry));
}

void one_sided_find(const Loading *loading, const Vector *f)
{
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c) {
    const OneSided *q = c->one_sided;
    if (!one_sided_acts(loading, c)) continue;
    for (int64_t n = 0; n < q->count; ++n)
      q->found[n] = q->open[n]  ? 0
                    : c->platen ? -q->pushes * platen_centre_force(c, f->row)
                                : -q->pushes * constraint_along(c, f->row, c->load->selection.places[n]);
  }
}

void one_sided_accept(const Loading *loading)
{
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c)
    for (int64_t n = 0; one_sided_acts(loading, c) && n < c->one_sided->count; ++n)
      c->one_sided->presses[n] = fmax(0, c->one_sided->found[n]);
}

void one_sided_add_pressed(const Loading *loading, double factor, const Vector *f)
{
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c) {
    const OneSided *q = c->one_sided;
    for (int64_t n = 0; one_sided_acts(loading, c) && n < q->count; ++n) {
      const double force = factor * q->pushes * q->presses[n];
      if (c->platen)
        platen_add_centre_force(c, f->row, force);
      else
        constraint_add(c, f->row, c->load->selection.places[n], force);
    }
  }
}

void one_sided_state(const Constraint *c, const char *name, StateList *list)
{
  const OneSided *q = c->one_sided;
  if (!q) return;
  state_add(list,
            &(StateRow){.unit = "1", .kind = STATE_BYTES, .role = STATE_TRIED, .count = q->count, .values = q->open},
            name, "has let go");
  state_add(
      list,
      &(StateRow){
          .unit = "force", .kind = STATE_NUMBERS, .role = STATE_COMMITTED, .count = q->count, .values = q->presses},
      name, "presses");
}
