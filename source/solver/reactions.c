#include "solver/reactions.h"

#include "loading/constraint.h"
#include "loading/support.h"
#include "solver/unknowns.h"
#include <math.h>
#include <string.h>

int reactions_create(Reactions *r, const Particles *p, Error *error)
{
  bool failed = false;
  for (int k = 0; k < 3 && !failed; ++k) failed = !(r->force[k] = places_reserved(p->places, "reactions", error));
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void reactions_destroy(Reactions *r)
{
  for (int k = 0; k < 3; ++k) places_free(&r->force[k]);
}

static void add_force(Wrench *w, const Particles *p, int32_t i, const double force[3])
{
  double arm[3];
  for (int k = 0; k < 3; ++k) arm[k] = p->position[k][i] + p->displacement.row[k][i] - w->about[k];
  w->size += sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    w->force[k] += force[k];
    w->moment[k] += arm[next] * force[last] - arm[last] * force[next];
  }
}

/* ---- several supports that mirror ----
 *
 * Images of different supports exert forces on each other, which are nothing to the body: of each support counts what its images do to particles inside.
 * The force of an image in a corner, behind two or three faces, belongs along each axis to
 * 1. the face normal to that axis;
 * 2. else to the faces held in all directions, in equal parts: they continue beyond a plane of symmetry;
 * 3. else to the faces held across, in equal parts: by symmetry the sum over all images is 0.
 * A periodic face owns a force only if all faces of the image are periodic, because supports continue beyond periodic
 * faces. The result does not depend on the order of the loads. */

/** Returns the margin that contains an image. */
static const Margin *reactions_margin(const Body *body, int64_t n)
{
  return &body->margins.items[body->margin_of[n]];
}

/** Supports to which the force on an image belongs along one axis, in equal parts. */
typedef struct Owners {
  int count;
  const LoadSpec *support[3];
} Owners;

enum { OWNER_PERIODIC, OWNER_SLIDES, OWNER_HOLDS, OWNER_NORMAL }; /* ranks of faces along an axis */

static int owners_rank(const Margin *margin, int axis)
{
  if (margin->repeats) return OWNER_PERIODIC;
  if (margin->axis == axis) return OWNER_NORMAL;
  return support_slides(margin) ? OWNER_SLIDES : OWNER_HOLDS;
}

/** Finds the owners of an image along an axis: of the faces beyond which the image lies, those of the highest rank. */
static Owners owners_along(const Body *body, int64_t n, int axis)
{
  Owners owners = {0};
  int highest = -1;
  for (int64_t m = n; body_outside(body, m); m = body->image_of[m]) {
    const Margin *margin = reactions_margin(body, m);
    const int rank = owners_rank(margin, axis);
    if (rank > highest) owners.count = 0;
    if (rank >= highest) owners.support[owners.count++] = margin->owner;
    if (rank > highest) highest = rank;
  }
  return owners;
}

/** Returns the part of the force on an image along an axis that belongs to the supports of a name. */
static double owners_part(const Body *body, int64_t n, int axis, const char *load)
{
  const Owners owners = owners_along(body, n, axis);
  int named = 0;
  for (int o = 0; o < owners.count; ++o) named += owners.support[o]->name && !strcmp(owners.support[o]->name, load);
  return (double)named / owners.count;
}

/** Force on an image of the particles inside to which it has bonds. */
static void find_pull(const Domain *d, int32_t i, double pull[3])
{
  const Particles *p = d->particles;
  const int64_t slice = i / SLICE;
  const int lane = i % SLICE;
  for (int64_t slot = d->family.first[slice]; slot < d->family.first[slice + 1]; ++slot) {
    if (!(d->family.intact[slot] >> lane & 1)) continue;
    const int32_t other = family_bond(&d->family, slice, slot, lane).neighbour;
    if (body_outside(&d->body, p->number[other])) continue;
    double force[3];
    domain_bond_force(d, slice, slot, lane, force);
    for (int k = 0; k < 3; ++k) pull[k] += force[k] * p->volume[i] * p->volume[other];
  }
}

static void add_images(Wrench *sum, const Domain *d, const char *load)
{
  for (int64_t n = 0; n < d->particles->count; ++n) {
    if (!body_outside(&d->body, n)) continue;
    double part[3], pull[3] = {0};
    for (int k = 0; k < 3; ++k) part[k] = owners_part(&d->body, n, k, load);
    if (part[0] == 0 && part[1] == 0 && part[2] == 0) continue;
    find_pull(d, d->particles->place_of[n], pull);
    for (int k = 0; k < 3; ++k) pull[k] *= -part[k];
    add_force(sum, d->particles, d->particles->place_of[n], pull);
  }
}

/** The same of all loads at once.
 *  @param[in,out] force  [loads] */
static void add_images_of_each(const Domain *d, const Loading *loading, double (*force)[3])
{
  for (int64_t n = 0; n < d->particles->count; ++n) {
    if (!body_outside(&d->body, n)) continue;
    double pull[3] = {0};
    find_pull(d, d->particles->place_of[n], pull);
    for (int k = 0; k < 3; ++k) {
      const Owners owners = owners_along(&d->body, n, k);
      for (int o = 0; o < owners.count; ++o)
        for (int l = 0; l < loading->count; ++l)
          if (loading->loads[l].spec == owners.support[o]) force[l][k] -= pull[k] / owners.count;
    }
  }
}

/** Whether several loads are supports that mirror. */
static bool several_mirror(const Loading *loading)
{
  const Load *first = NULL;
  bool several = false;
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    if (!constraint->images) continue;
    several |= first && constraint->load != first;
    first = constraint->load;
  }
  return several;
}

/** Whether a load of a name is a support that mirrors, and another load is one, too. */
static bool is_one_of_several(const Loading *loading, const char *load)
{
  bool own = false, others = false;
  for (int c = 0; load && c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    if (!constraint->images) continue;
    const char *name = constraint->load->spec->name;
    const bool named = name && !strcmp(name, load);
    own |= named;
    others |= !named;
  }
  return own && others;
}

typedef struct Summing {
  double *const *force;
  const Solver *solver;
  const uint8_t *on;
  const char *load;
  int64_t rows;
  double middle[3];
  Wrench sum;
} Summing;

static bool counts(const Summing *s, const Constraint *c, int32_t i)
{
  if (s->on && !s->on[i]) return false;
  return !s->load || (c->load->spec->name && !strcmp(c->load->spec->name, s->load));
}

/** Adds a row at a particle and what it mirrors, half way between which its force acts, to the middle of all. */
static void note_middle(Summing *s, int32_t i, int32_t other)
{
  const Particles *p = s->solver->domain->particles;
  ++s->rows;
  for (int k = 0; k < 3; ++k)
    s->middle[k] +=
        (p->position[k][i] + p->displacement.row[k][i] + p->position[k][other] + p->displacement.row[k][other]) / 2;
}

static void note_row(const Constraint *c, int64_t n, void *context)
{
  Summing *s = context;
  const Particles *p = s->solver->domain->particles;
  const int32_t i = c->load->selection.places[n];
  if (c->row) return;
  for (int k = 0; k < 3; ++k) s->force[k][i] = p->volume[i] * (p->internal.row[k][i] + p->external.row[k][i]);
  if (!counts(s, c, i)) return;
  const int32_t other = c->images ? c->images[n] : i; /* the face is half way to what is mirrored */
  if (other != i && body_outside(&s->solver->domain->body, p->number[other])) return; /* in a corner */
  note_middle(s, i, other);
}

/** Notes the leaders of platens, which have no row of their own. */
static void note_leaders(Summing *s)
{
  const Loading *loading = s->solver->loading;
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c)
    for (int m = 0; load_acts(loading, c->load) && m < constraint_leaders(c); ++m) {
      const int32_t leader = constraint_leader(c, m);
      if (counts(s, c, leader)) note_middle(s, leader, leader);
    }
}

/** What holds a rotation adds to the moment only. */
static void add_turning(Summing *s, const Constraint *c, int64_t n)
{
  const Particles *p = s->solver->domain->particles;
  const int32_t i = c->load->selection.places[n];
  for (int k = 0; k < 3 && counts(s, c, i); ++k) {
    if (c->direction[k] == 0) continue;
    double moment = -p->volume[i] * (p->internal.row[c->row + k][i] + p->external.row[c->row + k][i]);
    if (s->solver->type->inertia && !c->images) moment += s->solver->type->inertia(s->solver, c, n);
    s->sum.moment[p->space.rows == 4 ? 2 : k] += moment;
  }
}

/** Adds a force along the direction of a constraint, if its particle counts. */
static void add_along(Summing *s, const Constraint *c, int32_t i, double along)
{
  double force[3];
  if (!counts(s, c, i)) return;
  for (int k = 0; k < 3; ++k) force[k] = along * c->direction[k];
  add_force(&s->sum, s->solver->domain->particles, i, force);
}

/** Takes the force that balances a particle in the direction of a constraint off there, so that another row of that
 *  direction finds nothing any more.
 *  @return that force */
static double take_row(const Summing *s, const Constraint *c, int32_t i)
{
  double along = 0;
  for (int k = 0; k < 3; ++k) along -= s->force[k][i] * c->direction[k];
  for (int k = 0; k < 3; ++k) s->force[k][i] += along * c->direction[k];
  return along;
}

/** Returns the force along the direction, or 0 if a one-sided support would have to pull to exert it. */
static double reactions_pressing(const Constraint *c, double along)
{
  const OneSided *q = c->one_sided;
  return q && !c->platen ? q->pushes * fmax(0, q->pushes * along) : along;
}

static void add_row(const Constraint *c, int64_t n, void *context)
{
  Summing *s = context;
  const int32_t i = c->load->selection.places[n];
  if (c->row) {
    add_turning(s, c, n);
    return;
  }
  double along = take_row(s, c, i);
  if (!c->platen && !counts(s, c, i)) return;
  if (s->solver->type->inertia && !c->images) along += s->solver->type->inertia(s->solver, c, n);
  along = reactions_pressing(c, along);
  add_along(s, c, i, along);
  for (int m = 0; m < constraint_leaders(c); ++m) /* a platen carries no moment about its centre */
    add_along(s, c, constraint_leader(c, m), -constraint_share(c, m, n) * along);
}

Wrench reactions_sum(const Reactions *r, const Solver *solver, const uint8_t *on, const char *load, const double *about)
{
  const Unknowns u = unknowns_of(solver->domain, solver->loading);
  Summing s = {.force = r->force, .solver = solver, .on = on, .load = load};
  unknowns_each_row(&u, note_row, &s);
  note_leaders(&s);
  for (int k = 0; k < 3; ++k) s.sum.about[k] = about ? about[k] : s.rows ? s.middle[k] / (double)s.rows : 0;
  if (is_one_of_several(solver->loading, load))
    add_images(&s.sum, solver->domain, load);
  else
    unknowns_each_row(&u, add_row, &s);
  return s.sum;
}

typedef struct Each { /* sums of each load */
  Summing summing;
  bool several; /* supports that mirror: what images do is found by bonds */
  double (*force)[3];
} Each;

static void add_row_of_each(const Constraint *c, int64_t n, void *context)
{
  const Each *each = context;
  const Solver *s = each->summing.solver;
  if (c->row) return;
  double along = take_row(&each->summing, c, c->load->selection.places[n]);
  if (each->several && c->images) return;
  if (s->type->inertia && !c->images) along += s->type->inertia(s, c, n);
  along = reactions_pressing(c, along);
  double share = 1;
  for (int m = 0; m < constraint_leaders(c); ++m) share -= constraint_share(c, m, n);
  along *= share; /* the centre of a platen takes what its leaders leave */
  for (int k = 0; k < 3; ++k) each->force[c->load - s->loading->loads][k] += along * c->direction[k];
}

bool reactions_of_each_ask_bonds(const Loading *loading)
{
  return several_mirror(loading);
}

void reactions_of_each(const Reactions *r, const Solver *solver, double (*force)[3])
{
  const Unknowns u = unknowns_of(solver->domain, solver->loading);
  Each each = {{.force = r->force, .solver = solver}, several_mirror(solver->loading), force};
  for (int l = 0; l < solver->loading->count; ++l)
    for (int k = 0; k < 3; ++k) force[l][k] = 0;
  unknowns_each_row(&u, note_row, &each.summing);
  unknowns_each_row(&u, add_row_of_each, &each);
  if (each.several) add_images_of_each(solver->domain, solver->loading, force);
}

Wrench reactions_of_loads(const Solver *solver, const double about[3])
{
  const Particles *p = solver->domain->particles;
  Wrench sum = {.about = {about[0], about[1], about[2]}};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double force[3];
    for (int k = 0; k < 3; ++k) force[k] = p->volume[i] * p->external.row[k][i];
    add_force(&sum, p, i, force);
    for (int k = p->space.rotation; k < p->space.rows; ++k)
      sum.moment[p->space.row[k].axis] += p->volume[i] * p->external.row[k][i];
  }
  return sum;
}
