/* Steps of implicit dynamics (docs/theory.md 7). With g = internal + external forces - damping, all at times of steps, a step solves for displacements
 *   M a' = (1 + alpha) g' - alpha g                                                     (Hilber, Hughes and Taylor 1977; alpha = 0: Newmark 1959)
 *   u' = u + dt v + dt^2 [(1/2 - beta) a + beta a'],   v' = v + dt [(1 - gamma) a + gamma a'].
 * Damping is mass M v + stiffness K0 v, where K0 is what elastic laws make of the bonds that are left, as the body stands.
 *
 * Works are summed by the trapezium rule. What the kinetic energy of free particles lacks of theirs is the scheme's own
 * damping: nothing with the average acceleration. */
#include "solver/implicit.h"

#include "base/team.h"
#include "loading/constraint.h"
#include "loading/one_sided.h"
#include "loading/platen.h"
#include <math.h>
#include <string.h>

/* ---- motions ---- */

typedef struct Rates {
  const Constraint *constraint; /* whose velocity was found last */
  double rate, most;            /* it, and the largest of all */
  double time, step;
  const Vector *velocity;
} Rates;

static void prescribe_rate(const Constraint *c, int64_t n, void *context)
{
  Rates *r = context;
  if (c != r->constraint) {
    r->constraint = c;
    r->rate = constraint_velocity(c, r->time, r->step);
    if (!c->row) r->most = fmax(r->most, fabs(r->rate) * constraint_most(c));
  }
  const int32_t i = c->load->selection.places[n];
  const double wanted = r->rate * constraint_part(c, n) - constraint_along(c, r->velocity->row, i) +
                        constraint_followed(c, r->velocity->row, n);
  constraint_add(c, r->velocity->row, i, wanted);
}

/** Corrects the motions of the leaders of platens that close in the current step: the motion that the scheme gives the
 * centre becomes the prescribed motion.
 *  @param[in,out] v  [motions][places] velocities if `velocities`, otherwise accelerations */
static void implicit_still_leaders(const Implicit *s, double time, bool velocities, const Vector *v)
{
  for (int n = 0; n < s->loading->constraint_count; ++n) {
    const Constraint *c = &s->loading->constraints[n];
    if (!c->platen || !c->platen->closes || !load_acts(s->loading, c->load)) continue;
    const double change = velocities ? constraint_velocity(c, time, s->length) - c->platen->velocity
                                     : constraint_acceleration(c, time, s->length) - c->platen->acceleration;
    for (int m = 0; m < constraint_leaders(c); ++m) constraint_add(c, v->row, constraint_leader(c, m), change);
  }
}

/** Velocities at the end of the step: those of prescribed motions as prescribed, because the scheme makes them ring. */
static void find_velocities(Implicit *s, const Vector *moved, double time)
{
  const double dt = s->length, beta = s->spec->beta, gamma = s->spec->gamma;
  Rates r = {.time = time, .step = dt, .velocity = &s->velocity};
  vector_sum_terms(&s->velocity, &(VectorTerms){{gamma / (beta * dt), 1 - gamma / beta, dt * (1 - gamma / (2 * beta))},
                                                {moved, &s->domain->particles->velocity, &s->acceleration}});
  implicit_still_leaders(s, time, true, &s->velocity);
  unknowns_each_row(&s->newton.linear.unknowns, prescribe_rate, &r);
  s->ledger->given = fmax(s->ledger->given, r.most);
}

/** Accelerations at the end of the step by the scheme, into `result`. */
static void implicit_accelerate(Implicit *s, const Vector *moved)
{
  const double dt = s->length, beta = s->spec->beta;
  vector_sum_terms(&s->result, &(VectorTerms){{1 / (beta * dt * dt), -1 / (beta * dt), 1 - 1 / (2 * beta)},
                                              {moved, &s->domain->particles->velocity, &s->acceleration}});
}

/** Forces of damping at the displacements held, against these velocities. Trial states and forces of bonds are lost. */
static int find_drag(Implicit *s, const Vector *velocity, const Vector *drag, Error *error)
{
  Domain *d = s->domain;
  const Particles *p = d->particles;
  const Rayleigh c = s->spec->damping;
  if (c.stiffness > 0) {
    const bool elastic = domain_in_elastic_stage(d);
    domain_set_elastic_stage(d, true);
    const int status = domain_linearise(d, NULL, error);
    if (!status) domain_linear_step(d, velocity, drag);
    domain_set_elastic_stage(d, elastic);
    if (status) return status;
  }
  if (c.stiffness > 0) vector_weigh(drag, p->volume, drag);
  vector_weigh_product(&s->result, p->volume, &p->inertia, velocity);
  vector_combine(-c.stiffness, drag, c.mass, &s->result);
  return BRECCIA_OK;
}

static void divide_by_masses(void *context, int64_t first, int64_t last)
{
  const Implicit *s = context;
  const Particles *p = s->domain->particles;
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = first; i < last; ++i)
      if (p->number[i] >= 0) s->acceleration.row[k][i] /= p->inertia.row[k][i] * p->volume[i];
}

/** Accelerations by the forces held, of tied particles by all of theirs; 0 where motions are prescribed. */
static void find_accelerations(Implicit *s)
{
  const Particles *p = s->domain->particles;
  const Unknowns *u = &s->newton.linear.unknowns;
  vector_weigh_sum(&s->acceleration, p->volume, &p->internal, &p->external);
  vector_combine(1, &s->acceleration, -1, &s->drag);
  unknowns_gather(u, &s->acceleration);
  vector_each_tile(&p->space, divide_by_masses, s);
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &s->loading->ties[k];
    for (int64_t g = 0; g < ties->count; ++g) {
      const int32_t one = ties->places[ties->first[g]];
      double mass = 0;
      for (int64_t n = ties->first[g]; n < ties->first[g + 1]; ++n)
        mass += p->density[ties->places[n]] * p->volume[ties->places[n]];
      s->acceleration.row[k][one] *= p->density[one] * p->volume[one] / mass;
    }
  }
  for (int c = 0; c < s->loading->constraint_count; ++c) {
    const Constraint *constraint = &s->loading->constraints[c];
    if (constraint->platen && load_acts(s->loading, constraint->load))
      platen_share_mass(constraint, p, &s->acceleration);
  }
  unknowns_spread(u, NAN, &s->acceleration);
}

/* ---- forces beside those of bonds and loads ---- */

static int prepare_forces(void *context, const Vector *moved, double time, Error *error)
{
  Implicit *s = context;
  s->then = time;
  find_velocities(s, moved, time);
  return find_drag(s, &s->velocity, &s->drag_then, error);
}

/** Gives a particle under a platen the acceleration of the plate: its mass is borne by the leaders, and the scheme
 * makes prescribed motions ring. */
static void accelerate_with_platen(const Constraint *c, int64_t n, void *context)
{
  Implicit *s = context;
  const int32_t i = c->load->selection.places[n];
  if (!c->platen) return;
  const double given = c->platen->closes ? c->platen->acceleration : constraint_acceleration(c, s->then, s->length);
  constraint_add(c, s->result.row, i,
                 constraint_part(c, n) * given + constraint_followed(c, s->result.row, n) -
                     constraint_along(c, s->result.row, i));
}

/** Operands of add_forces. */
typedef struct Balance {
  const Implicit *implicit;
  const Vector *force;
  double alpha, weight;
} Balance;

static void balance_tile(void *context, int64_t first, int64_t last)
{
  const Balance *of = context;
  const Implicit *s = of->implicit;
  const Particles *p = s->domain->particles;
  for (int k = 0; k < of->force->space->rows; ++k)
    for (int64_t i = first; i < last; ++i) {
      const double before =
          p->volume[i] * (s->increment.internal.row[k][i] + s->increment.external.row[k][i]) - s->drag.row[k][i];
      s->result.row[k][i] *= p->inertia.row[k][i] * p->volume[i];
      of->force->row[k][i] -= s->drag_then.row[k][i] + of->weight * (of->alpha * before + s->result.row[k][i]);
    }
}

/** What is to vanish is g' - alpha / (1 + alpha) g - M a' / (1 + alpha), beside the inertia: nothing else acts on a body that flies. */
static double add_forces(void *context, const Vector *moved, const Vector *force)
{
  Implicit *s = context;
  const Unknowns *u = &s->newton.linear.unknowns;
  const double alpha = s->spec->alpha, weight = 1 / (1 + alpha);
  implicit_accelerate(s, moved);
  unknowns_each_row(u, accelerate_with_platen, s);
  vector_each_tile(force->space, balance_tile, &(Balance){s, force, alpha, weight});
  one_sided_add_pressed(s->loading, -weight * alpha, force);
  unknowns_gather(u, &s->result);
  return unknowns_product_of_forces(u, &s->result, &s->result);
}

NewtonForces implicit_forces(Implicit *s)
{
  return (NewtonForces){s, prepare_forces, add_forces};
}

/* ---- books ---- */

static double kinetic_energy(const Domain *d, const Vector *velocity)
{
  return 0.5 * vector_inner_mass(d->counted, &d->particles->inertia, velocity, velocity);
}

typedef struct HeldEnergy {
  const Domain *domain;
  const Vector *velocity;
  double energy;
} HeldEnergy;

static void add_held_at(HeldEnergy *h, const Constraint *c, int32_t i)
{
  const double rate = constraint_along(c, h->velocity->row, i);
  h->energy += 0.5 * h->domain->particles->inertia.row[c->row][i] * h->domain->counted[i] * rate * rate;
}

static void add_held(const Constraint *c, int64_t n, void *context)
{
  add_held_at(context, c, c->load->selection.places[n]);
}

/** Calls for each leader of the platens that act. */
static void each_leader(const Implicit *s, void (*one)(void *context, const Constraint *c, int32_t leader),
                        void *context)
{
  for (int n = 0; n < s->loading->constraint_count; ++n) {
    const Constraint *c = &s->loading->constraints[n];
    for (int m = 0; load_acts(s->loading, c->load) && m < constraint_leaders(c); ++m)
      one(context, c, constraint_leader(c, m));
  }
}

static void add_held_leader(void *context, const Constraint *c, int32_t leader)
{
  add_held_at(context, c, leader);
}

static void clear_leader(void *context, const Constraint *c, int32_t leader)
{
  double *const *f = ((const Vector *)context)->row;
  constraint_add(c, f, leader, -constraint_along(c, f, leader));
}

/** Kinetic energy of what moves as prescribed, and of particles under platens: their turning and their prescribed
 * motion share it. */
static double held_energy(const Implicit *s, const Vector *velocity)
{
  HeldEnergy h = {.domain = s->domain, .velocity = velocity};
  unknowns_each_row(&s->newton.linear.unknowns, add_held, &h);
  each_leader(s, add_held_leader, &h);
  return h.energy;
}

/** Leaves of forces those on motions that are wholly free. */
static void gather_free(Implicit *s, const Vector *force)
{
  unknowns_gather(&s->newton.linear.unknowns, force);
  each_leader(s, clear_leader, (void *)force);
}

/** In prescribed directions what changes the kinetic energy and the bonds is booked as external, whatever it is. */
static void book(Implicit *s)
{
  const Particles *p = s->domain->particles;
  const Vector *moved = &s->newton.moved;
  const double bonds = increment_bond_work(&s->increment, moved);
  vector_copy(&s->result, &s->drag);
  vector_combine(1, &s->result, 1, &s->drag_then);
  gather_free(s, &s->result);
  const double damping = 0.5 * vector_inner(&s->result, moved, 1);
  vector_sum_terms(&s->result,
                   &(VectorTerms){{1, 1, 1}, {&s->increment.internal, &s->increment.external, &p->internal}});
  vector_weigh_sum(&s->result, p->volume, &s->result, &p->external);
  vector_sum_terms(&s->result, &(VectorTerms){{1, -1, -1}, {&s->result, &s->drag, &s->drag_then}});
  one_sided_add_pressed(s->loading, 1, &s->result);
  gather_free(s, &s->result);
  const double freely = 0.5 * vector_inner(&s->result, moved, 1);
  const double kinetic = kinetic_energy(s->domain, &s->velocity), held = held_energy(s, &s->velocity);
  const double kinetic_before = kinetic_energy(s->domain, &p->velocity), held_before = held_energy(s, &p->velocity);
  s->ledger->bond_work += bonds;
  s->ledger->damping_work += damping + s->struck;
  s->ledger->damped |= s->struck > 0;
  s->ledger->external_work += bonds + damping + freely + held - held_before + s->struck;
  s->ledger->numerical += freely + held - held_before - (kinetic - kinetic_before);
  s->ledger->kinetic = kinetic;
}

/* ---- a step ---- */

int implicit_begin(Solver *run, Error *error)
{
  Implicit *s = run->own;
  const Particles *p = s->domain->particles;
  domain_tell_time(s->domain, run->clock.time, 0);
  if (find_drag(s, &p->velocity, &s->drag, error)) return BRECCIA_FAILURE;
  domain_evaluate(s->domain, NULL);
  increment_start(&s->increment);
  loading_move(s->loading, &(LoadMotion){.velocity = p->velocity.row});
  newton_apply_loads(&s->newton, run->clock.time);
  loading_settle(s->loading, p, p->velocity.row, 0);
  pressing_take_up(&s->newton, &s->drag);
  find_accelerations(s);
  s->ledger->kinetic = kinetic_energy(s->domain, &p->velocity);
  s->ledger->given = fmax(s->ledger->given, vector_largest(&p->velocity));
  return BRECCIA_OK;
}

/** Accelerations at the end of a step that has converged, and its error as a share of the largest displacements so far: what Newmark's displacements
 *  lack of those of a linearly changing acceleration (Zienkiewicz and Xie 1991, Earthq. Eng. Struct. Dyn. 20, 871). */
static double find_error(Implicit *s)
{
  const Particles *p = s->domain->particles;
  const Unknowns *u = &s->newton.linear.unknowns;
  implicit_accelerate(s, &s->newton.moved);
  implicit_still_leaders(s, s->then, false, &s->result);
  unknowns_clear_rest(u, &s->result);
  unknowns_spread(u, NAN, &s->result);
  const Vector *change = &s->newton.change; /* of accelerations; corrections have been made */
  vector_copy(change, &s->result);
  vector_combine(1, change, -1, &s->acceleration);
  const double shift = fmax(s->shift, sqrt(unknowns_product_of_motions(u, &p->displacement, &p->displacement)));
  const double error =
      fabs(s->spec->beta - 1.0 / 6) * s->length * s->length * sqrt(unknowns_product_of_motions(u, change, change));
  return shift > 0 ? error / shift : 0;
}

/** Lengths by which a step has to change for an error of third order in it to be the one allowed. */
static double wanted_change(const Implicit *s, double found)
{
  return found > 0 ? 0.9 * cbrt(s->spec->local_error / found) : INFINITY;
}

static void finish_step(Implicit *s)
{
  const Particles *p = s->domain->particles;
  const Unknowns *u = &s->newton.linear.unknowns;
  book(s);
  loading_settle(s->loading, p, s->newton.moved.row, 1);
  find_error(s);
  increment_accept(&s->increment, &s->newton.moved);
  one_sided_accept(s->loading);
  s->ledger->fastest = vector_largest(&s->newton.moved) / s->length;
  vector_copy(&p->velocity, &s->velocity);
  vector_copy(&s->acceleration, &s->result);
  vector_copy(&s->drag, &s->drag_then);
  s->shift = fmax(s->shift, sqrt(unknowns_product_of_motions(u, &p->displacement, &p->displacement)));
}

/** Adds the energy that a closing entry dissipates in a plastic impact. For a platen the function also stores the
 * velocity and acceleration with which the scheme moves the centre to its prescribed position. */
static void implicit_strike_one(void *context, const Constraint *c, int64_t entry)
{
  Implicit *s = context;
  const Particles *p = s->domain->particles;
  const Selection *on = &c->load->selection;
  const double dt = s->length, beta = s->spec->beta, gamma = s->spec->gamma,
               rate = constraint_velocity(c, s->clock->time, dt);
  if (!c->platen) {
    const int32_t i = on->places[entry];
    const double change = rate * constraint_part(c, entry) - constraint_along(c, p->velocity.row, i);
    s->struck += 0.5 * p->inertia.row[c->row][i] * s->domain->counted[i] * change * change;
    return;
  }
  const double moved =
                   constraint_displacement(c, s->clock->time + dt) - platen_centre_displacement(c, p->displacement.row),
               v = platen_centre_rate(c, p->velocity.row), a = platen_centre_rate(c, s->acceleration.row);
  c->platen->closes = true;
  c->platen->acceleration = (moved / dt - v) / (beta * dt) - (1 / (2 * beta) - 1) * a;
  c->platen->velocity = gamma / (beta * dt) * moved + (1 - gamma / beta) * v + dt * (1 - gamma / (2 * beta)) * a;
  for (int64_t n = 0; n < on->count; ++n)
    s->struck += 0.5 * p->density[on->places[n]] * s->domain->counted[on->places[n]] * (rate - v) * (rate - v);
}

static void implicit_strike(Implicit *s)
{
  s->struck = 0;
  for (int c = 0; c < s->loading->constraint_count; ++c)
    if (s->loading->constraints[c].platen) s->loading->constraints[c].platen->closes = false;
  pressing_each_closing(&s->pressing, s->loading, implicit_strike_one, s);
}

/** Solves the current step until no closed entry pulls and no open entry is passed. */
static NewtonOutcome implicit_press(Implicit *s, double end, Error *error)
{
  pressing_begin(&s->pressing, &s->newton);
  for (;;) {
    domain_tell_time(s->domain, end, s->length);
    implicit_strike(s);
    NewtonOutcome outcome = newton_solve(&s->newton, end, error);
    if (!pressing_is_wrong(&s->pressing, &s->newton, end, &outcome)) return outcome;
    increment_retreat(&s->increment);
    pressing_choose(&s->pressing, &s->newton);
  }
}

/** One try to come to a time of the run; the state is that of before if it fails.
 *  @param[out] found  the error of the step, if it has converged */
static NewtonOutcome try_step(Implicit *s, double end, double *found, Error *error)
{
  const ImplicitSpec *spec = s->spec;
  const double dt = s->length = end - s->clock->time, rate = spec->gamma / (spec->beta * dt);
  LinearSolver *linear = &s->newton.linear;
  linear->stiffness_share = spec->damping.stiffness * rate;
  linear->mass_factor = 1 / ((1 + spec->alpha) * spec->beta * dt * dt) + spec->damping.mass * rate;
  increment_begin(&s->increment);
  loading_move(s->loading, &(LoadMotion){.velocity = s->velocity.row, .rate = rate});
  domain_mix_tangents(s->domain, linear->stiffness_share / (1 + linear->stiffness_share));
  const NewtonOutcome outcome = implicit_press(s, end, error);
  domain_mix_tangents(s->domain, 0);
  *found = outcome == NEWTON_CONVERGED ? find_error(s) : 0;
  if (outcome != NEWTON_CONVERGED) increment_retreat(&s->increment);
  return outcome;
}

/** Bonds that are beyond their limit break all at once: waves carry on what follows. Steps become shorter as long as bonds break, but not
 *  shorter than waves take across a horizon, faster than which no crack runs. */
static int break_bonds(Solver *run, Error *error)
{
  Implicit *s = run->own;
  const int64_t broken = increment_break(&s->increment, s->clock, 0);
  if (s->domain->out_of_memory) return error_add(error, BRECCIA_FAILURE, "out of memory: broken bonds");
  if (!broken) return BRECCIA_OK;
  text_add(&run->log, "  %lld bonds break\n", (long long)broken);
  find_accelerations(s);
  s->next = fmax(s->next / 2, fmin(s->next, s->domain->family.horizon / s->ledger->wave));
  return BRECCIA_OK;
}

void implicit_count_steps(const Solver *run)
{
  const Implicit *s = run->own;
  Clock *clock = (Clock *)&run->clock;
  const double left = ceil((clock->stage_end - clock->time) / s->next - 1e-6);
  clock->stage_last = clock->step + (int64_t)fmin(left, 1e15);
}

/** A step that has failed for good: what its tries have changed is as it was. */
static int give_up(Implicit *s, double next, int64_t cuts)
{
  s->next = next;
  s->cuts = cuts;
  return BRECCIA_FAILURE;
}

/** Says once in a stage that steps are no longer cut though they err by more than was asked for. */
static void tell_coarse(Implicit *s, double found, Text *warning)
{
  if (!s->coarse)
    text_add_warning(
        warning,
        "implicit: from time %.6g %s on steps cut to the 'smallest time step' (%.3g %s) err by %.2g of the "
        "largest displacements, more than the 'local error' of %g; make it smaller, or go on with a stage of "
        "'explicit'",
        s->clock->time, s->clock->time_unit, s->length, s->clock->time_unit, found, s->spec->local_error);
  s->coarse = true;
}

int implicit_advance(Solver *run, Text *warning, Error *error)
{
  Implicit *s = run->own;
  const double first = s->next;
  const int64_t cuts = s->cuts;
  Clock *clock = &run->clock;
  const double longest = implicit_longest(s->spec), shortest = s->spec->smallest * longest;
  double end, found, erred = INFINITY, tried = INFINITY;
  char words[320];
  if (increment_keep(&s->increment, run, error)) return BRECCIA_FAILURE;
  s->newton.log = &run->log;
  for (;; ++s->cuts) {
    end = increment_end(run, s->next);
    text_add(&run->log, "step %lld, from time %.6g to %.6g %s\n", (long long)clock->step + 1, clock->time, end,
             clock->time_unit);
    const NewtonOutcome outcome = try_step(s, end, &found, error);
    if (outcome == NEWTON_FAILED) return give_up(s, first, cuts);
    const double change = wanted_change(s, found);
    /* What is left of forces when equilibrium is taken for found makes accelerations err too, by a share of displacements that shorter steps do not
     * lessen: third order, and even the second of loads that jump, would be far below the root. */
    const bool helps = isfinite(erred) && s->length < tried && found <= erred * sqrt(s->length / tried);
    if (outcome == NEWTON_CONVERGED && (change >= 0.9 || s->length <= shortest || (isfinite(erred) && !helps))) {
      if (change < 0.9) {
        text_add(&run->log, "    kept: it errs by %.2g of the largest displacements\n", found);
        if (s->length <= shortest) tell_coarse(s, found, warning);
      }
      finish_step(s);
      const bool easy = s->newton.iterations <= (newton_most_iterations(&s->newton) + 1) / 2;
      if (easy && s->length >= 0.999 * s->next)
        s->next = fmin(longest, fmax(shortest, fmin(2, fmax(change, 0.5)) * s->next));
      break;
    }
    if (outcome == NEWTON_CONVERGED) {
      increment_retreat(&s->increment);
      text_add(&run->log, "    cut: the step errs by %.2g of the largest displacements\n", found);
      erred = found;
      tried = s->length;
      s->next = fmax(shortest, s->length * fmax(0.2, change));
      continue;
    }
    text_add(&run->log, "    cut: no equilibrium: %s\n", newton_describe(&s->newton, outcome, words, sizeof words));
    s->next = s->length / 2;
    if (s->next < shortest) {
      error_add(error, BRECCIA_FAILURE,
                "implicit: no equilibrium with inertia beyond time %g %s, with steps cut to %.2g %s: %s; go on with a "
                "stage of 'explicit', or look at the loads and at the last pictures",
                clock->time, clock->time_unit, s->length, clock->time_unit, words);
      return give_up(s, first, cuts);
    }
  }
  clock->time_step = end - clock->time;
  clock->time = end;
  const int status = break_bonds(run, error);
  ++clock->step; /* what was found in it is committed */
  if (status) return BRECCIA_FAILURE;
  clock->ended = clock->time >= clock->stage_end - 1e-9 * longest;
  implicit_count_steps(run);
  if (clock->ended) increment_forget(&s->increment);
  return BRECCIA_OK;
}
