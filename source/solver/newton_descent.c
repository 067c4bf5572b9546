#include "solver/newton_descent.h"
#include "solver/newton_parts.h"
#include "solver/newton_stability.h"

#include <math.h>

int descent_create(Descent *d, const Newton *n, Error *error)
{
  const Particles *p = n->domain->particles;
  bool made =
      vector_create(&d->before, &p->space, "descent", error) && vector_create(&d->room, &p->space, "descent", error);
  for (int k = 0; k < DESCENT_PAIRS && made; ++k)
    made = vector_create(&d->step[k], &p->space, "descent", error) &&
           vector_create(&d->fall[k], &p->space, "descent", error);
  return made ? preconditioner_create(&d->preconditioner, n->domain, false, error) : BRECCIA_FAILURE;
}

size_t descent_bytes(const Descent *d, const Particles *p)
{
  return (2 * DESCENT_PAIRS + 2) * vector_bytes(&p->space) + preconditioner_bytes(&d->preconditioner);
}

void descent_destroy(Descent *d)
{
  for (int k = 0; k < DESCENT_PAIRS; ++k) {
    vector_destroy(&d->step[k]);
    vector_destroy(&d->fall[k]);
  }
  vector_destroy(&d->before);
  vector_destroy(&d->room);
  preconditioner_destroy(&d->preconditioner);
}

/** What the linearised equations answer to the forces out of balance, corrected by the pairs.
 *  @param[in] accuracy  of the equations */
static int find_direction(Descent *d, Newton *n, double accuracy, LinearRecord *linear, Error *error)
{
  const int64_t oldest = d->count > DESCENT_PAIRS ? d->count - DESCENT_PAIRS : 0;
  double taken[DESCENT_PAIRS];
  if (newton_prepare(n, error)) return BRECCIA_FAILURE;
  vector_copy(&d->room, &n->force);
  for (int64_t k = d->count - 1; k >= oldest; --k) {
    const int64_t at = k % DESCENT_PAIRS;
    taken[at] = vector_inner(&d->room, &d->step[at], 1) / d->work[at];
    vector_combine(1, &d->room, -taken[at], &d->fall[at]);
  }
  if (newton_size_of_forces(n, &d->room) > 0 &&
      linear_solver_solve(&n->linear, &d->room, &n->change, accuracy, linear, error))
    return BRECCIA_FAILURE;
  for (int64_t k = oldest; k < d->count; ++k) {
    const int64_t at = k % DESCENT_PAIRS;
    const double again = vector_inner(&d->fall[at], &n->change, 1) / d->work[at];
    vector_combine(1, &n->change, taken[at] - again, &d->step[at]);
  }
  n->products += linear->iterations;
  return BRECCIA_OK;
}

/** Keeps the step, if forces have fallen along it. */
static void keep_pair(Descent *d, const Newton *n, double share)
{
  const int64_t at = d->count % DESCENT_PAIRS;
  const Unknowns *u = &n->linear.unknowns;
  vector_combine(0, &d->room, share, &n->change);
  unknowns_clear_rest(u, &d->room);
  vector_combine(1, &d->before, -1, &n->force);
  const double work = vector_inner(&d->before, &d->room, 1);
  if (!(work > 0)) return;
  vector_copy(&d->step[at], &d->room);
  vector_copy(&d->fall[at], &d->before);
  d->work[at] = work;
  ++d->count;
}

/** Goes along the change to where the forces out of balance do much less work along it, or beyond.
 *  @param[out] work  of theirs there; @param[out] share  of the change that has been taken */
static NewtonOutcome search(Newton *n, double time, double start, double *work, double *share, Error *error)
{
  enum { MOST = 10 };
  const double enough = 0.5, farther = 4;
  double low = 0, low_work = start, high = INFINITY, high_work = NAN;
  *share = 1;
  newton_move(n, 1);
  for (int k = 0;; ++k) {
    const NewtonOutcome outcome = newton_find_forces(n, time, error);
    const bool bad = outcome == NEWTON_LAW || outcome == NEWTON_DIVERGED;
    *work = bad ? NAN : vector_inner(&n->force, &n->change, 1);
    if ((outcome != NEWTON_CONVERGED && !bad) || (!bad && fabs(*work) <= enough * start) || k == MOST) return outcome;
    if (bad || *work < 0) {
      high = *share;
      high_work = *work;
    } else {
      low = *share;
      low_work = *work;
    }
    double wanted = 0.5 * (low + high);
    if (!isfinite(high))
      wanted = low * (low_work < start ? fmin(farther, start / (start - low_work)) : farther);
    else if (high_work < 0)
      wanted = low + (high - low) * fmin(0.9, fmax(0.1, low_work / (low_work - high_work)));
    newton_move(n, wanted - *share);
    *share = wanted;
  }
}

/** Work over that of the first step, of which prescribed motions are a part. */
static double energy_of(const Descent *d, double work)
{
  return d->first_work != 0 ? fabs(work / d->first_work) : 0;
}

/** A step by tangents, taken back where it does not halve the forces out of balance. */
static NewtonOutcome try_tangents(const Descent *d, Newton *n, double time, double force, bool *kept,
                                  double *correction, double *energy, Error *error)
{
  LinearRecord linear = {0};
  *kept = false;
  domain_take_secants(n->domain, SECANTS_OF_NONE);
  if (newton_linearise(n, error) || newton_prepare(n, error) ||
      linear_solver_solve(&n->linear, &n->force, &n->change, newton_wanted_accuracy(n, force, 0), &linear, error))
    return NEWTON_FAILED;
  n->products += linear.iterations;
  NewtonOutcome outcome = NEWTON_CONVERGED;
  if (!linear.indefinite && isfinite(vector_inner(&n->force, &n->change, 1))) {
    unknowns_spread(&n->linear.unknowns, NAN, &n->change);
    newton_move(n, 1);
    outcome = newton_find_forces(n, time, error);
    const double now = newton_size_of_forces(n, &n->force), all = newton_size_of_motions(n, &n->moved);
    *kept = outcome == NEWTON_CONVERGED && now < 0.5 * force;
    *correction = all > 0 ? newton_size_of_motions(n, &n->change) / all : 0;
    *energy = energy_of(d, vector_inner(&n->force, &n->change, 1));
    if (!*kept) newton_move(n, -1);
  }
  domain_take_secants(n->domain, SECANTS_OF_ALL);
  if (outcome == NEWTON_FAILED) return outcome;
  return *kept ? NEWTON_CONVERGED : newton_find_forces(n, time, error);
}

/** A step by secants. @param[in] motions  time up to which prescribed motions are part of it; NAN: none is; @param[out] share  of it that was taken */
static NewtonOutcome step(Descent *d, Newton *n, double time, double motions, double force, double *share,
                          double *correction, double *energy, Error *error)
{
  const Unknowns *u = &n->linear.unknowns;
  LinearRecord linear = {0};
  double work;
  const double accuracy = n->exerted > 0 ? newton_wanted_accuracy(n, force, 0) : n->spec->residual / 10;
  if (find_direction(d, n, accuracy, &linear, error)) return NEWTON_FAILED;
  double start = vector_inner(&n->force, &n->change, 1);
  if (!(start > 0) && d->count) { /* the pairs lead astray */
    d->count = 0;
    if (find_direction(d, n, accuracy, &linear, error)) return NEWTON_FAILED;
    start = vector_inner(&n->force, &n->change, 1);
  }
  if (!isfinite(start)) return NEWTON_SINGULAR;
  NewtonOutcome outcome;
  unknowns_spread(u, motions, &n->change);
  if (isnan(motions)) {
    vector_copy(&d->before, &n->force);
    outcome = search(n, time, start, &work, share, error);
  } else {
    newton_move(n, 1);
    outcome = newton_find_forces(n, time, error);
    work = vector_inner(&n->force, &n->change, 1);
  }
  if (outcome != NEWTON_CONVERGED) return outcome;
  if (isnan(motions)) keep_pair(d, n, *share);
  const double all = newton_size_of_motions(n, &n->moved);
  if (d->first_work == 0) d->first_work = start;
  *correction = all > 0 ? *share * newton_size_of_motions(n, &n->change) / all : 0;
  *energy = energy_of(d, work);
  n->unbalanced = n->exerted > 0 ? newton_size_of_forces(n, &n->force) / n->exerted : INFINITY;
  newton_tell(n, *correction, *energy, *share, &linear);
  return NEWTON_CONVERGED;
}

/** Down to the next equilibrium. @param[in] moves  up to the time prescribed motions are part of the first step, and of the forces out of balance */
static NewtonOutcome go_down(Descent *d, Newton *n, double time, bool moves, int64_t most, Error *error)
{
  enum { MOST_IDLE = 20 };
  const double nearer = 0.1,
               hardly =
                   1e-3; /* of a step; where it leads nowhere laws jump, as where ground flows that finds no rest */
  int idle = 0;
  const int64_t begin = n->iterations;
  double force = newton_size_of_forces(n, &n->force), near = nearer * force;
  bool balanced = !moves && newton_is_balanced(n, force);
  d->count = 0;
  while (!balanced) {
    double correction = 0, energy = 0, share = 1;
    bool kept = false;
    NewtonOutcome outcome = NEWTON_CONVERGED;
    if (++n->iterations - begin > most || idle == MOST_IDLE) return NEWTON_SLOW;
    if (force < near) {
      outcome = try_tangents(d, n, time, force, &kept, &correction, &energy, error);
      near = nearer * force;
      if (outcome == NEWTON_CONVERGED && kept) {
        near = INFINITY;
        n->unbalanced = newton_size_of_forces(n, &n->force) / n->exerted;
        newton_tell(n, correction, energy, 1, &(LinearRecord){0});
      }
    }
    if (outcome == NEWTON_CONVERGED && !kept)
      outcome = step(d, n, time, moves && n->iterations == 1 ? time : NAN, force, &share, &correction, &energy, error);
    if (outcome != NEWTON_CONVERGED) return outcome;
    idle = share < hardly ? idle + 1 : 0;
    force = newton_size_of_forces(n, &n->force);
    if (!isfinite(force)) return NEWTON_DIVERGED;
    if (!kept && isinf(near)) near = nearer * force;
    balanced = newton_has_converged(n, force, correction, energy, 1);
    if (!balanced) continue;
    bool again;
    outcome = newton_take_lengths(n, time, &again, error);
    if (outcome != NEWTON_CONVERGED) return outcome;
    balanced = !again;
    force = newton_size_of_forces(n, &n->force);
    near = nearer * force;
    d->count = again ? 0 : d->count;
  }
  return NEWTON_CONVERGED;
}

/** Pushes the body out of an equilibrium in which it does not stay. @param[out] pushed  whether it was such a one */
static NewtonOutcome leave_saddle(Descent *d, Newton *n, double time, bool *pushed, Error *error)
{
  const double share = 1e-2; /* of what the increment has moved */
  const Unknowns *u = &n->linear.unknowns;
  domain_take_secants(n->domain, SECANTS_OF_NONE);
  const int status = newton_seek_fall(n, &d->preconditioner, &n->change, &d->before, &d->room, pushed, error);
  domain_take_secants(n->domain, SECANTS_OF_ALL);
  if (status) return NEWTON_FAILED;
  if (!*pushed) return NEWTON_CONVERGED;
  if (n->log) text_add(n->log, "    the body does not stay in this equilibrium\n");
  const double size = newton_size_of_motions(n, &n->change), way = vector_inner(&n->force, &n->change, 1) < 0 ? -1 : 1;
  unknowns_spread(u, NAN, &n->change);
  newton_move(n, way * share * newton_size_of_motions(n, &n->moved) / size);
  return newton_find_forces(n, time, error);
}

static NewtonOutcome solve(Descent *d, Newton *n, double time, int64_t most, Error *error)
{
  enum { MOST_SADDLES = 5 };
  n->iterations = n->products = 0;
  n->foreseen = 0;
  n->indefinite = false;
  d->first_work = 0;
  vector_clear(&n->moved);
  NewtonOutcome outcome = newton_find_forces(n, time, error);
  if (outcome != NEWTON_CONVERGED) return outcome;
  const bool moves = newton_add_motions(n, time);
  vector_clear(&n->moved);
  const double force = newton_size_of_forces(n, &n->force);
  n->unbalanced_before = n->unbalanced = n->exerted > 0 ? force / n->exerted : 0;
  outcome = go_down(d, n, time, moves, most, error);
  bool pushed = true;
  for (int k = 0; k < MOST_SADDLES && pushed && outcome == NEWTON_CONVERGED; ++k) {
    outcome = leave_saddle(d, n, time, &pushed, error);
    if (outcome == NEWTON_CONVERGED && pushed) outcome = go_down(d, n, time, false, most, error);
  }
  if (outcome != NEWTON_CONVERGED) return outcome;
  if (newton_is_carried_away(n->domain)) return NEWTON_SINGULAR;
  n->reference = n->exerted;
  return NEWTON_CONVERGED;
}

NewtonOutcome descent_solve(Descent *d, Newton *n, double time, int64_t most, Error *error)
{
  domain_take_secants(n->domain, SECANTS_OF_ALL);
  const NewtonOutcome outcome = solve(d, n, time, most, error);
  domain_take_secants(n->domain, SECANTS_OF_NONE);
  return outcome == NEWTON_CONVERGED && newton_has_gone_far(n) ? NEWTON_FAR : outcome;
}
