#include "solver/relaxation.h"

#include "base/random.h"
#include "base/tridiagonal.h"
#include <math.h>
#include <string.h>

enum { PROBES = 12, MOST_PREDICTING = 60, MOST_RENEWING = 150, LOOKED_AT_EVERY = 50, SLOW = 200 };
/* Highest eigenvalue of K over M in steps of 1: 4 is the limit. */
static const double highest = 4 / 1.1;

int relaxation_create(Relaxation *r, Newton *n, Error *error)
{
  const Particles *p = n->domain->particles;
  const bool any_pose = domain_bonds_may_soften(n->domain); /* several equilibria may be close (relaxation.h) */
  r->prepared = NAN;
  n->linear.elastic = &r->elastic;
  const bool failed = elastic_step_create(&r->elastic, n->domain, error) ||
                      preconditioner_create(&r->mass, n->domain, any_pose, error) ||
                      !vector_create(&r->velocity, &p->space, "dynamic relaxation", error) ||
                      !vector_create(&r->momentum, &p->space, "dynamic relaxation", error) ||
                      !vector_create(&r->product, &p->space, "dynamic relaxation", error);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

size_t relaxation_bytes(const Relaxation *r, const Particles *p)
{
  return 3 * vector_bytes(&p->space) + elastic_step_bytes(p) + preconditioner_bytes(&r->mass);
}

void relaxation_destroy(Relaxation *r)
{
  elastic_step_destroy(&r->elastic);
  preconditioner_destroy(&r->mass);
  vector_destroy(&r->velocity);
  vector_destroy(&r->momentum);
  vector_destroy(&r->product);
}

/** Conjugate gradients for the elastic body, with the mass as preconditioner.
 *  @param[in,out] f  right-hand side; then what is left of it
 *  @param[in,out] v  the answer is added; a vector of unknowns
 *  @return the largest eigenvalue of K over M that shows in the steps taken */
static double answer_elastically(Relaxation *r, Newton *n, const Vector *f, const Vector *v, int most, double tolerance)
{
  const Unknowns *u = &n->linear.unknowns;
  double alpha[MOST_RENEWING], beta[MOST_RENEWING] = {0}, slope = 0, share = 1;
  const double first = unknowns_product_of_forces(u, f, f);
  int k = 0;
  for (; k < most && unknowns_product_of_forces(u, f, f) > tolerance * tolerance * first; ++k) {
    preconditioner_apply(&r->mass, &n->linear, f, &r->product);
    const double next = vector_inner(f, &r->product, 1), again = k ? next / slope : 0;
    vector_combine(again, &r->velocity, 1, &r->product);
    slope = next;
    linear_solver_apply(&n->linear, &r->velocity, &r->product);
    ++n->products;
    unknowns_clear_rest(u, &r->velocity);
    const double curvature = vector_inner(&r->product, &r->velocity, 1);
    if (!(curvature > 0)) break;
    /* The matrix of Lanczos' method (Golub and Van Loan, Matrix Computations, 10.2). */
    alpha[k] = curvature / slope + (k ? again / share : 0);
    beta[k] = k ? sqrt(again) / share : 0;
    share = slope / curvature;
    vector_combine(1, v, share, &r->velocity);
    vector_combine(1, f, -share, &r->product);
  }
  return k ? tridiagonal_largest(alpha, beta, k) : 0;
}

/** The mass for the body as it is. */
static int prepare(Relaxation *r, Newton *n, Error *error)
{
  const Particles *p = n->domain->particles;
  uint64_t seed = 1;
  if (preconditioner_prepare(&r->mass, &n->linear, &r->velocity, &r->product, error)) return BRECCIA_FAILURE;
  vector_clear(&r->momentum);
  vector_clear(&n->change);
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->count; ++i)
      r->momentum.row[k][p->place_of[i]] =
          unknowns_length(&n->linear.unknowns, k) *
          (r->mass.any_pose ? preconditioner_probe(&r->mass, &n->linear, 1, k, p->place_of[i])
                            : random_uniform(&seed) - 0.5);
  unknowns_gather(&n->linear.unknowns, &r->momentum);
  r->scale = answer_elastically(r, n, &r->momentum, &n->change, PROBES, 0) / highest;
  return BRECCIA_OK;
}

/** Adds what the motions in `change` do to the forces of an elastic body by themselves. */
static void add_motions(Relaxation *r, Newton *n)
{
  const Particles *p = n->domain->particles;
  elastic_step_apply(&r->elastic, n->domain, &n->change, &r->product);
  loading_change(n->loading, p, n->change.row, r->product.row);
  vector_weigh(&r->product, p->volume, &r->product);
  unknowns_gather(&n->linear.unknowns, &r->product);
  vector_combine(1, &n->force, 1, &r->product);
  ++n->products;
}

static void move(Newton *n, const Vector *v)
{
  vector_combine(1, &n->domain->particles->displacement, 1, v);
  vector_combine(1, &n->moved, 1, v);
}

/** Moves all particles as an elastic body would answer to loads and motions; `change` is how. The momentum is lost.
 *  @param[in] most   products
 *  @param[out] work  of the forces out of balance, as they were before, on this way */
static int predict(Relaxation *r, Newton *n, double time, bool moves, int most, double *work, Error *error)
{
  const Unknowns *u = &n->linear.unknowns;
  elastic_step_prepare(&r->elastic, n->domain);
  if (r->prepared != time && prepare(r, n, error)) return BRECCIA_FAILURE;
  r->prepared = time;
  vector_clear(&n->change);
  unknowns_spread(u, time, &n->change);
  if (moves) add_motions(r, n);
  vector_clear(&n->change);
  const double before = unknowns_product_of_forces(u, &n->force, &n->force);
  vector_copy(&r->momentum, &n->force);
  answer_elastically(r, n, &n->force, &n->change, most, 1e-2);
  /* Where elastic stiffness is not symmetric, gradients may raise what is left. */
  if (!(unknowns_product_of_forces(u, &n->force, &n->force) <= before)) vector_clear(&n->change);
  *work = vector_inner(&r->momentum, &n->change, 1);
  vector_clear(&r->momentum);
  unknowns_spread(u, time, &n->change);
  move(n, &n->change);
  if (n->log) text_add(n->log, "    elastic prediction: %lld evaluations\n", (long long)n->products);
  return BRECCIA_OK;
}

/** One step of the motion. @param[in,out] damping  c; then that of the next step */
static NewtonOutcome take_step(Relaxation *r, Newton *n, double time, double *damping, Error *error)
{
  const Unknowns *u = &n->linear.unknowns;
  vector_combine((2 - *damping) / (2 + *damping), &r->momentum, 2 / (2 + *damping), &n->force);
  preconditioner_apply(&r->mass, &n->linear, &r->momentum, &r->velocity);
  vector_combine(1 / r->scale, &r->velocity, 0, &r->velocity);
  const double twice_kinetic = vector_inner(&r->momentum, &r->velocity, 1);
  const double before = vector_inner(&n->force, &r->velocity, 1);
  unknowns_spread(u, NAN, &r->velocity);
  move(n, &r->velocity);
  const NewtonOutcome outcome = newton_find_forces(n, time, error);
  if (outcome != NEWTON_CONVERGED) return outcome;
  const double fall = before - vector_inner(&n->force, &r->velocity, 1);
  const double quotient = twice_kinetic > 0 ? fall / twice_kinetic : 0;
  if (quotient > highest) { /* stiffer than the elastic body: steps of 1 must not become unstable */
    r->scale *= 1.5 * quotient / highest;
    vector_clear(&r->momentum);
  }
  *damping = 2 * sqrt(fmin(fmax(quotient, 0), 0.9));
  return NEWTON_CONVERGED;
}

/** Forces out of balance over those that are exerted; 0 of roundings. */
static double find_unbalanced(const Newton *n)
{
  const double force = sqrt(unknowns_product_of_forces(&n->linear.unknowns, &n->force, &n->force));
  if (force <= n->roundings) return 0;
  return n->exerted > 0 ? force / n->exerted : force > 0 ? INFINITY : 0;
}

/** Moves all particles as an elastic body would answer to what is still out of balance, with a mass for the bonds that are left; back, if forces do half
 *  as much work on the way that is found then, or more. Forces may grow on a long way, across which they are not linear: those are of stiff motions, which
 *  come to rest at once. @param[out] helped */
static NewtonOutcome renew(Relaxation *r, Newton *n, double time, bool *helped, Error *error)
{
  double before;
  r->prepared = NAN;
  if (predict(r, n, time, false, MOST_RENEWING, &before, error)) return NEWTON_FAILED;
  NewtonOutcome outcome = newton_find_forces(n, time, error);
  if (outcome == NEWTON_FAILED) return outcome;
  const double after = outcome == NEWTON_CONVERGED ? vector_inner(&n->force, &n->change, 1) : INFINITY;
  *helped = fabs(after) < 0.5 * before;
  if (!*helped) {
    vector_combine(-1, &n->change, 0, &n->change);
    move(n, &n->change);
    outcome = newton_find_forces(n, time, error);
    if (n->log) text_add(n->log, "    given back: it is not what the body answers\n");
  }
  return outcome;
}

/** How a motion comes to rest. */
typedef struct Pace {
  int64_t look, looked,
      patience; /* iterations: at which it is looked at, was last, and for how many it is left alone after help that was none */
  double last; /* out of balance when it was looked at */
} Pace;

/** Iterations that are left at the pace since it was looked at last. */
static double iterations_left(const Pace *pace, const Newton *n)
{
  const double fall = log(pace->last / n->unbalanced) / (double)(n->iterations - pace->looked);
  return fall > 0 ? log(n->unbalanced / n->spec->residual) / fall : INFINITY;
}

/** Where few bonds hold parts of the body together, motions are slow for which the mass is far too large. What softens answers so unlike an elastic body that
 *  hardly anything would come of it.
 *  @param[in,out] damping  of the next step */
static NewtonOutcome keep_pace(Relaxation *r, Newton *n, Pace *pace, double time, double *damping, Error *error)
{
  pace->look = n->iterations + LOOKED_AT_EVERY;
  if (isfinite(pace->last) && !domain_may_soften(n->domain) && iterations_left(pace, n) > SLOW) {
    bool helped;
    const NewtonOutcome outcome = renew(r, n, time, &helped, error);
    if (outcome != NEWTON_CONVERGED) return outcome;
    n->unbalanced = find_unbalanced(n);
    *damping = 0;
    if (!helped) {
      pace->look += pace->patience;
      pace->patience *= 2;
    }
  }
  pace->last = n->unbalanced;
  pace->looked = n->iterations;
  return NEWTON_CONVERGED;
}

/** Takes steps of the motion until the residual is below its tolerance.
 *  @param[in] most         number of iterations, from those already taken on
 *  @param[in,out] damping  damping coefficient of the next step [-] */
static NewtonOutcome relaxation_come_to_rest(Relaxation *r, Newton *n, Pace *pace, double time, int64_t most,
                                             double *damping, Error *error)
{
  const int64_t last = n->iterations + most;
  NewtonOutcome outcome;
  while (n->unbalanced > n->spec->residual) {
    if (++n->iterations > last) return NEWTON_SLOW;
    if ((outcome = take_step(r, n, time, damping, error)) != NEWTON_CONVERGED) return outcome;
    n->unbalanced = find_unbalanced(n);
    if (!isfinite(n->unbalanced) && n->exerted > 0) return NEWTON_DIVERGED;
    if (n->log && (n->iterations % LOOKED_AT_EVERY == 0 || n->unbalanced <= n->spec->residual))
      text_add(n->log, "    iteration %lld: residual %.2e, damping %.2g\n", (long long)n->iterations, n->unbalanced,
               *damping);
    if (n->iterations == pace->look && n->unbalanced > n->spec->residual &&
        (outcome = keep_pace(r, n, pace, time, damping, error)) != NEWTON_CONVERGED)
      return outcome;
  }
  n->reference = n->exerted;
  return NEWTON_CONVERGED;
}

NewtonOutcome relaxation_solve(Relaxation *r, Newton *n, double time, int64_t most, Error *error)
{
  const Unknowns *u = &n->linear.unknowns;
  n->iterations = n->products = 0;
  n->indefinite = false;
  vector_clear(&n->moved);
  NewtonOutcome outcome = newton_find_forces(n, time, error);
  if (outcome != NEWTON_CONVERGED) return outcome;
  vector_clear(&n->change);
  unknowns_spread(u, time, &n->change);
  const bool moves = unknowns_product_of_motions(u, &n->change, &n->change) > 0;
  n->unbalanced_before = n->unbalanced = find_unbalanced(n);
  if (moves || n->unbalanced > n->spec->residual) {
    double work;
    if (predict(r, n, time, moves, MOST_PREDICTING, &work, error)) return NEWTON_FAILED;
    if ((outcome = newton_find_forces(n, time, error)) != NEWTON_CONVERGED) return outcome;
    n->unbalanced = find_unbalanced(n);
  }
  double damping = 0;
  Pace pace = {.look = LOOKED_AT_EVERY, .patience = LOOKED_AT_EVERY, .last = INFINITY};
  vector_clear(&r->momentum);
  for (bool again = true; again;) {
    if ((outcome = relaxation_come_to_rest(r, n, &pace, time, most, &damping, error)) != NEWTON_CONVERGED)
      return outcome;
    if ((outcome = newton_take_lengths(n, time, &again, error)) != NEWTON_CONVERGED) return outcome;
    if (!again) break;
    n->unbalanced = find_unbalanced(n);
    vector_clear(&r->momentum);
    damping = 0;
    pace.look = n->iterations + LOOKED_AT_EVERY;
    pace.last = INFINITY;
  }
  return newton_has_gone_far(n) ? NEWTON_FAR : outcome;
}
