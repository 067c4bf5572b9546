#include "solver/newton_parts.h"
#include "solver/newton_stability.h"
#include "solver/pieces.h"

#include "base/team.h"
#include "loading/one_sided.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void newton_note_forces_held(Newton *n)
{
  const Particles *p = n->domain->particles;
  vector_weigh(&n->force, p->volume, &p->internal);
  const double sum = vector_inner(&n->force, &n->force, 0);
  if (isfinite(sum)) n->reference = fmax(n->reference, sqrt(sum));
}

/** The root of the sum over particles of the force by which a neighbour's displacement of 1 is answered, squared. */
static double stiffness_of(const Domain *d)
{
  const Particles *p = d->particles;
  double sum = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const Material *m = &d->materials[d->material[i / SLICE]];
    const double spacing = d->body.lattices[p->block[i / SLICE]].spacing;
    const double k = p->volume[i] * (m->bulk + 4 * m->shear / 3) / (spacing * spacing);
    sum += k * k;
  }
  return sqrt(sum);
}

int newton_create(Newton *n, Error *error)
{
  const Particles *p = n->domain->particles;
  n->linear.domain = n->domain;
  n->linear.loading = n->loading;
  n->linear.unknowns = unknowns_of(n->domain, n->loading);
  bool made = vector_create(&n->force, &p->space, "forces out of balance", error) &&
              vector_create(&n->change, &p->space, "corrections", error) &&
              vector_create(&n->moved, &p->space, "increments", error);
  if (made && n->control)
    made = vector_create(&n->unit_force, &p->space, "controlled loads", error) &&
           vector_create(&n->unit_motion, &p->space, "controlled loads", error);
  if (!made) return BRECCIA_FAILURE;
  if (n->domain->begins_under_stress) newton_note_forces_held(n);
  n->stiffness = stiffness_of(n->domain);
  return n->relaxes ? BRECCIA_OK : linear_solver_create(&n->linear, n->spec->linear, error);
}

void newton_destroy(Newton *n)
{
  vector_destroy(&n->force);
  vector_destroy(&n->change);
  vector_destroy(&n->moved);
  vector_destroy(&n->unit_force);
  vector_destroy(&n->unit_motion);
  vector_destroy(&n->change_forces);
  linear_solver_destroy(&n->linear);
}

typedef struct Loads {
  const Loading *loading;
  Particles *particles;
  double time;
} Loads;

static void apply_loads(void *context)
{
  const Loads *of = context;
  loading_apply_untied(of->loading, of->particles, of->time);
}

void newton_apply_loads(const Newton *n, double time)
{
  team_run(apply_loads, &(Loads){n->loading, n->domain->particles, time});
}

/** Forces come from differences of displacements, whose last digits are lost where these are large; those of inertia from the way since the step began. */
static void find_roundings(Newton *n)
{
  const Particles *p = n->domain->particles;
  const double digits = 16 * DBL_EPSILON;
  const Unknowns *of = &n->linear.unknowns;
  const Vector *u = &p->displacement;
  const double most = fmax(vector_largest(u), of->length * vector_largest_rotation(u));
  double inertia = 0;
  if (n->linear.mass_factor > 0) {
    vector_weigh_product(&n->force, p->volume, &p->inertia, &n->moved);
    inertia = n->linear.mass_factor * newton_size_of_forces(n, &n->force);
  }
  n->roundings = digits * (n->stiffness * most + inertia);
  n->rounding_work = n->roundings * newton_size_of_motions(n, u);
}

int newton_linearise(const Newton *n, Error *error)
{
  if (domain_linearise(n->domain, NULL, error)) return BRECCIA_FAILURE;
  forces_linearise(&n->domain->forces);
  const char *failed = forces_failed(&n->domain->forces);
  return failed ? error_add(error, BRECCIA_FAILURE, "out of memory: %s", failed) : BRECCIA_OK;
}

NewtonOutcome newton_find_forces(Newton *n, double time, Error *error)
{
  Domain *d = n->domain;
  const Particles *p = d->particles;
  if (newton_is_interrupted(n)) return NEWTON_STOPPED;
  if (n->beside && n->beside->prepare(n->beside->context, &n->moved, time, error)) return NEWTON_FAILED;
  if (n->relaxes)
    domain_evaluate(d, NULL);
  else if (newton_linearise(n, error))
    return NEWTON_FAILED;
  if (*domain_server_problem(d)) {
    error_add(error, BRECCIA_FAILURE, "%s", domain_server_problem(d));
    return NEWTON_FAILED;
  }
  if (d->failed_place >= 0) return NEWTON_LAW;
  if (!isfinite(d->force_sum)) return NEWTON_DIVERGED;
  newton_apply_loads(n, time);
  find_roundings(n);
  vector_weigh(&n->force, p->volume, &p->external);
  double exerted = unknowns_product_of_forces(&n->linear.unknowns, &n->force, &n->force);
  vector_weigh_sum(&n->force, p->volume, &p->internal, &p->external);
  if (n->beside) exerted = fmax(exerted, n->beside->add(n->beside->context, &n->moved, &n->force));
  one_sided_find(n->loading, &n->force);
  const double all = unknowns_product_of_forces(&n->linear.unknowns, &n->force, &n->force);
  unknowns_gather(&n->linear.unknowns, &n->force);
  const double free = unknowns_product_of_forces(&n->linear.unknowns, &n->force, &n->force);
  if (d->strains.any && !n->iterations && isfinite(free))
    n->reference = fmax(n->reference, sqrt(free)); /* of strains */
  n->exerted = fmax(n->reference, sqrt(fmax(exerted, all - free)));
  return NEWTON_CONVERGED;
}

NewtonOutcome newton_take_lengths(Newton *n, double time, bool *again, Error *error)
{
  const int64_t points = domain_take_lengths(n->domain);
  *again = false;
  if (!points) return NEWTON_CONVERGED;
  const NewtonOutcome outcome = newton_find_forces(n, time, error);
  if (outcome != NEWTON_CONVERGED) return outcome;
  const double force = newton_size_of_forces(n, &n->force);
  n->unbalanced = n->exerted > 0 ? force / n->exerted : force > 0 ? INFINITY : 0;
  *again = !newton_is_balanced(n, force);
  if (*again && n->log)
    text_add(n->log, "    %lld points that begin to soften spread G_F by their crack normal: residual %.2e\n",
             (long long)points, n->unbalanced);
  return NEWTON_CONVERGED;
}

bool newton_add_motions(Newton *n, double time)
{
  const Particles *p = n->domain->particles;
  const Unknowns *u = &n->linear.unknowns;
  vector_clear(&n->change);
  unknowns_spread(u, time, &n->change);
  if (unknowns_product_of_motions(u, &n->change, &n->change) == 0) return false;
  /* Forces before they are gathered: those of the motions belong to the same sum. */
  domain_linear_step(n->domain, &n->change, &n->moved);
  domain_change_forces(n->domain, &n->change, &n->moved);
  loading_change(n->loading, p, n->change.row, n->moved.row);
  vector_weigh(&n->moved, p->volume, &n->moved);
  unknowns_gather(u, &n->moved);
  vector_combine(1, &n->force, 1, &n->moved);
  return true;
}

void newton_state(Newton *n, StateList *list)
{
  state_add_number(list, "exerted force", "force", STATE_COMMITTED, &n->reference);
  if (!n->relaxes) linear_solver_state(&n->linear, list);
  if (!n->beside) return;
  state_add_number(list, "stiffness factored", "1", STATE_LEARNED, &n->factored_share);
  state_add_number(list, "mass factored", "1", STATE_LEARNED, &n->factored_mass);
  state_add_count(list, "broken bonds when factored", STATE_LEARNED, &n->factored_broken);
  state_add_count(list, "stiffness follows", STATE_LEARNED, &n->follows);
  if (one_sided_count(n->loading)) state_add_count(list, "open when factored", STATE_LEARNED, &n->factored_open);
}

static bool keeps_factors(const Newton *n)
{
  const bool at_zero =
      !n->domain->particles->orientation[0];    /* those count rotations from where particles have turned to */
  const bool strained = n->domain->strains.any; /* the stiffness without displacements changes with free strains */
  return n->beside && !n->follows && at_zero && !strained && domain_is_elastic(n->domain) && !n->domain->forces.count;
}

/* Assembling and factoring the matrix of a plate takes tens of times as long as a step with factors that are there. */
int newton_prepare(Newton *n, Error *error)
{
  LinearSolver *l = &n->linear;
  const Domain *d = n->domain;
  vector_clear(&n->change);
  if (!keeps_factors(n)) {
    n->factored = false;
    return linear_solver_prepare(l, error);
  }
  const double share = l->stiffness_share, mass = l->mass_factor;
  const int64_t open = one_sided_key(n->loading);
  const bool same = fabs(mass - n->factored_mass) <= 1e-9 * mass &&
                    fabs(share - n->factored_share) <= 1e-9 * (1 + share) && n->factored_broken == d->broken_count &&
                    n->factored_open == open;
  if (same && n->factored && n->open_in_factors == open) return BRECCIA_OK;
  if (!same) {
    n->factored_share = share;
    n->factored_mass = mass;
    n->factored_broken = d->broken_count;
    n->factored_open = open;
  }
  l->stiffness_share = n->factored_share;
  l->mass_factor = n->factored_mass;
  int status = domain_linearise(n->domain, &n->change, error); /* at zero displacements */
  if (!status) status = linear_solver_prepare(l, error);
  l->stiffness_share = share;
  l->mass_factor = mass;
  n->factored = !status;
  n->open_in_factors = open;
  return status ? status : domain_linearise(n->domain, NULL, error);
}

void newton_move(Newton *n, double share)
{
  vector_combine(1, &n->domain->particles->displacement, share, &n->change);
  vector_combine(1, &n->moved, share, &n->change);
  if (n->control) control_add(n->loading, share * n->factor_change);
}

double newton_wanted_accuracy(const Newton *n, double force, double before)
{
  const double enough = 0.3 * n->spec->residual * n->exerted / force;
  double worth = 1e-3;
  if (before > 0) worth = fmin(1e-2, force / before * force / before);
  if (domain_is_elastic(n->domain)) worth = 0;
  return fmin(0.1, fmax(fmax(enough, worth), 1e-12));
}

void newton_tell(const Newton *n, double correction, double work, double share, const LinearRecord *linear)
{
  if (!n->log) return;
  text_add(n->log, "    iteration %lld: residual %.2e, correction %.2e, energy %.2e", (long long)n->iterations,
           n->unbalanced, correction, work);
  if (share != 1) text_add(n->log, ", %.2g of it taken", share);
  if (linear->iterations) text_add(n->log, "; %lld products", (long long)linear->iterations);
  if (linear->indefinite) text_add(n->log, ", the body does not resist some motion");
  text_add(n->log, "\n");
}

double newton_size_of_forces(const Newton *n, const Vector *f)
{
  return sqrt(unknowns_product_of_forces(&n->linear.unknowns, f, f));
}

double newton_size_of_motions(const Newton *n, const Vector *v)
{
  return sqrt(unknowns_product_of_motions(&n->linear.unknowns, v, v));
}

/** Goes on along the change, or back, to where the forces out of balance do no work along it any more, if they still do much.
 *  @param[in] whole      prescribed motions are part of the change: it must be taken whole
 *  @param[in,out] share  of the change that has been taken */
static NewtonOutcome search_line(Newton *n, double time, bool whole, double first_work, double *work, double *share,
                                 Error *error)
{
  enum { MOST = 6 };
  const double enough = 0.8;
  NewtonOutcome outcome = newton_find_forces(n, time, error);
  *work = vector_inner(&n->force, &n->change, 1);
  for (int k = 0; k < MOST && !whole; ++k) {
    const bool bad = outcome == NEWTON_LAW || outcome == NEWTON_DIVERGED;
    if (outcome == NEWTON_FAILED || (!bad && fabs(*work) <= enough * fabs(first_work))) break;
    double wanted = *share / 2;
    if (!bad && (*work < 0) != (first_work < 0)) wanted = *share * fmax(0.1, first_work / (first_work - *work));
    if (!bad && (*work < 0) == (first_work < 0)) break; /* it goes on down: the next iteration will see to that */
    newton_move(n, wanted - *share);
    *share = wanted;
    outcome = newton_find_forces(n, time, error);
    *work = vector_inner(&n->force, &n->change, 1);
  }
  return outcome;
}

bool newton_has_gone_far(const Newton *n)
{
  const double room = forces_room(&n->domain->forces);
  return isfinite(room) && vector_spread(&n->moved, n->domain->particles->number) > room;
}

bool newton_is_balanced(const Newton *n, double force)
{
  return force <= fmax(n->spec->residual * n->exerted, n->roundings);
}

bool newton_has_converged(const Newton *n, double force, double correction, double work, double first_work)
{
  if (!newton_is_balanced(n, force)) return false;
  const double off = n->control ? fabs(n->target - control_shown(n->control)) : 0;
  if (n->control && !(off <= n->spec->residual * fmax(fabs(n->target), fabs(n->control->step))))
    return false; /* only a part of the last change was taken */
  if (!isnan(n->spec->displacement) && !(correction <= n->spec->displacement)) return false;
  return isnan(n->spec->energy) || fabs(work) <= n->spec->energy * fabs(first_work);
}

bool newton_is_carried_away(const Domain *d)
{
  const double most = 1e3; /* sizes of the body */
  const Particles *p = d->particles;
  double low[3], high[3], size = d->body.largest_spacing; /* a body may be one particle */
  particles_bounds(p, low, high);
  for (int k = 0; k < 3; ++k) size = fmax(size, high[k] - low[k]);
  return vector_largest(&p->displacement) > most * size;
}

/** Work on bonds along the first change of an increment, by the forces at its beginning and tangents; 0 where the body already softens along it, or
 *  does not resist some change. */
static double foresee_work(const Newton *n)
{
  const double *counted = n->domain->counted;
  domain_linear_step(n->domain, &n->change, &n->change_forces);
  const double now = -vector_inner_weighted(counted, &n->domain->particles->internal, NULL, &n->change),
               more = -vector_inner_weighted(counted, &n->change_forces, NULL, &n->change);
  return more > 0 && !n->indefinite ? now + 0.5 * more : 0;
}

enum { LONGER = 10 }; /* secants come on by a fifth of what is left in an iteration */

int64_t newton_most_iterations(const Newton *n)
{
  return n->spec->iterations * (domain_has_secants(n->domain) ? LONGER : 1);
}

/** Whether a piece on which loads act is held by nothing any more, inertia neither: no equations have a solution then. */
static bool is_cut(const Newton *n)
{
  LoosePiece loose;
  return !n->beside && !pieces_find_loose(&n->linear.unknowns, PIECES_WORKED, &loose, NULL) && loose.pieces > 0;
}

/** Answer of the linearised equations to the forces out of balance. Where they have none, because parts of a body are torn so far that nothing holds them,
 *  a trace of the first moduli holds those where they are, from then on in this search.
 *  @param[out] start  work of the forces along it; no number where there is none */
static int find_change(Newton *n, double force, double accuracy, LinearRecord *linear, double *start, Error *error)
{
  const double trace = 1e-8;
  for (bool again = false;; again = true) {
    if (newton_prepare(n, error)) return BRECCIA_FAILURE;
    if (force > 0 && linear_solver_solve(&n->linear, &n->force, &n->change, accuracy, linear, error))
      return BRECCIA_FAILURE;
    *start = vector_inner(&n->force, &n->change, 1);
    if (isfinite(*start) || again || n->beside || !domain_may_soften(n->domain)) return BRECCIA_OK;
    domain_mix_tangents(n->domain, trace);
    if (newton_linearise(n, error)) return BRECCIA_FAILURE;
  }
}

/** Whether an iteration has led a body that softens far away: where parts are held by next to nothing, equilibrium may be found in which bars are folded and
 *  have yielded a hundred times over, which no path leads to. Work along the first change is next to nothing where a bond has just broken and where a branch
 *  snaps back, and says nothing there by itself.
 *  @param[in] energy  work after the iteration over that of the first one
 *  @param[in] way     size of all changes over that of the first one */
static bool is_astray(const Newton *n, double energy, double way)
{
  const double most = 1e3, far = 10;
  return energy > most && way > far && !n->beside && domain_may_soften(n->domain);
}

static NewtonOutcome solve(Newton *n, double time, Error *error)
{
  n->iterations = n->products = 0;
  n->foreseen = 0;
  n->indefinite = false;
  vector_clear(&n->moved);
  NewtonOutcome outcome = newton_find_forces(n, time, error);
  if (outcome != NEWTON_CONVERGED) return outcome;
  const bool moves = newton_add_motions(n, time) || (n->control && control_shown(n->control) != n->target);
  const double enough = 0.2; /* of the forces out of balance is left by an iteration with factors that serve */
  double before = 0, first_work = 0, first_way = 0;
  vector_clear(&n->moved);
  double force = newton_size_of_forces(n, &n->force);
  n->unbalanced_before = n->exerted > 0 ? force / n->exerted : 0;
  if (!moves && newton_is_balanced(n, force)) {
    n->unbalanced = n->unbalanced_before;
    n->reference = n->exerted;
    return NEWTON_CONVERGED;
  }
  Pace pace = {.least = INFINITY};
  const bool secants = n->begins_by_secants && domain_take_secants(n->domain, SECANTS_OF_BONDS);
  if (secants && newton_linearise(n, error)) return NEWTON_FAILED;
  const int64_t most = newton_most_iterations(n);
  for (n->iterations = 1; n->iterations <= (pace.enough > 0 ? LONGER * n->spec->iterations : most); ++n->iterations) {
    LinearRecord linear = {0};
    const double accuracy = n->exerted > 0 ? newton_wanted_accuracy(n, force, before) : n->spec->residual / 10;
    double start;
    n->linear.allowed = pace_allowed_products(&pace, n);
    if (find_change(n, force, accuracy, &linear, &start, error)) return NEWTON_FAILED;
    if (linear.unsuited && !linear.stopped && !linear.indefinite && !n->linear.is_free) {
      if (is_cut(n)) return NEWTON_SINGULAR;
      error_add(error, BRECCIA_FAILURE,
                "equations: '%s' cannot solve these: the stiffness is not symmetric, as where a law flows in another "
                "direction than its yield surface says, or particles turn in space; take %s'direct', or leave "
                "'equations' out",
                linear_solver_name(&n->linear), n->linear.type->any_stiffness ? "" : "'minimal residuals' or ");
      return NEWTON_FAILED;
    }
    n->products += linear.iterations;
    if (n->iterations == 1) pace.products = linear.iterations;
    n->indefinite |= linear.indefinite;
    if (linear.stopped) return NEWTON_LEFT;
    if (n->wants_stable && linear.indefinite) return NEWTON_UNSTABLE;
    if (!isfinite(start)) return NEWTON_SINGULAR;
    unknowns_spread(&n->linear.unknowns, n->iterations == 1 ? time : NAN, &n->change);
    if (n->control && (outcome = newton_follow_control(n, accuracy, &start, error)) != NEWTON_CONVERGED) return outcome;
    if (n->change_forces.row[0] && n->iterations == 1) n->foreseen = foresee_work(n);
    double share = 1, work;
    newton_move(n, 1);
    outcome = search_line(n, time, n->control || (moves && n->iterations == 1), start, &work, &share, error);
    if (outcome != NEWTON_CONVERGED) return outcome;
    before = force;
    force = newton_size_of_forces(n, &n->force);
    n->unbalanced = n->exerted > 0 ? force / n->exerted : force > 0 ? INFINITY : 0;
    const double all = newton_size_of_motions(n, &n->moved),
                 correction = all > 0 ? share * newton_size_of_motions(n, &n->change) / all : 0;
    if (n->iterations == 1) {
      first_work = start;
      first_way = all;
    }
    const double energy = first_work != 0 ? fabs(work / first_work) : 0;
    newton_tell(n, correction, energy, share, &linear);
    if (newton_has_converged(n, force, correction, work, first_work)) {
      bool again;
      outcome = newton_take_lengths(n, time, &again, error);
      if (outcome != NEWTON_CONVERGED) return outcome;
      if (again) { /* continue with the pace of the beginning of an increment */
        force = newton_size_of_forces(n, &n->force);
        pace.least = INFINITY;
        pace.since = 0;
        before = 0;
        continue;
      }
      if (!n->beside && newton_is_carried_away(n->domain)) return NEWTON_SINGULAR; /* bodies with inertia may fly far */
      n->reference = n->exerted;
      return NEWTON_CONVERGED;
    }
    if (!isfinite(force)) return NEWTON_DIVERGED;
    if (is_astray(n, energy, all / first_way)) return NEWTON_ASTRAY;
    bool others = pace_choose_slopes(&pace, n, force);
    if (secants && n->iterations == 1) {
      domain_take_secants(n->domain, SECANTS_OF_NONE);
      others = true;
    }
    if (pace_leaves(&pace, n)) {
      ++n->iterations; /* this one is over */
      return NEWTON_LEFT;
    }
    if (others && domain_linearise(n->domain, NULL, error)) return NEWTON_FAILED;
    if (keeps_factors(n) && force > enough * before) n->follows = 1;
  }
  return NEWTON_SLOW;
}

/** Checks the stability of the state found by one more linearisation; not after a few iterations, in which the body
 *  answers all but linearly. */
static NewtonOutcome check_stability(Newton *n, double time, Error *error)
{
  enum { FEW = 2 }; /* iterations, in which the body answers all but linearly */
  bool stays = true;
  if (n->iterations <= FEW) return NEWTON_CONVERGED;
  n->linear.allowed = 0;
  domain_take_secants(n->domain, SECANTS_OF_NONE);
  if (newton_find_stability(n, &stays, error)) return NEWTON_FAILED;
  const NewtonOutcome outcome = newton_find_forces(n, time, error);
  return outcome == NEWTON_CONVERGED && !stays ? NEWTON_UNSTABLE : outcome;
}

NewtonOutcome newton_solve(Newton *n, double time, Error *error)
{
  n->linear.definite = n->wants_stable;
  NewtonOutcome outcome = solve(n, time, error);
  if (n->wants_stable && outcome == NEWTON_CONVERGED) outcome = check_stability(n, time, error);
  n->linear.definite = false;
  n->linear.allowed = 0;
  domain_take_secants(n->domain, SECANTS_OF_NONE);
  if (!n->beside) domain_mix_tangents(n->domain, 0);
  return outcome == NEWTON_CONVERGED && newton_has_gone_far(n) ? NEWTON_FAR : outcome;
}

const char *newton_describe(const Newton *n, NewtonOutcome outcome, char *words, size_t size)
{
  enum { FEW = 10 }; /* bodies that yield take as many */
  const Domain *d = n->domain;
  const Particles *p = d->particles;
  const char *parts =
      d->forces.count ? " (parts that only contact holds must touch at first, and not slide freely)" : "";
  switch (outcome) {
  case NEWTON_SLOW:
    snprintf(words, size, "%lld iteration%s left %.2g of the forces out of balance%s%s%s%s",
             (long long)n->iterations - 1, n->iterations == 2 ? "" : "s", n->unbalanced,
             n->unbalanced <= n->spec->residual ? ", which is enough, but the last correction is larger than "
                                                  "'displacement tolerance' or 'energy tolerance' allows"
                                                : "",
             n->spec->iterations < FEW ? ": allow more 'iterations'" : "",
             n->indefinite ? ", and the body does not resist some motion any more" : "", n->indefinite ? parts : "");
    break;
  case NEWTON_LEFT:
    snprintf(words, size, "it hardly comes on: %lld iterations left %.2g of the forces out of balance",
             (long long)n->iterations - 1, n->unbalanced);
    break;
  case NEWTON_UNSTABLE:
    snprintf(words, size, "after %lld iteration%s the body does not resist some motion", (long long)n->iterations,
             n->iterations == 1 ? "" : "s");
    break;
  case NEWTON_LAW: {
    const int64_t i = d->failed_place;
    const Material *m = &d->materials[d->material[i / SLICE]];
    snprintf(words, size, "the law %s of material '%s' could not be integrated at particle %d at [%g, %g, %g]",
             m->law_name, m->name, p->number[i], p->position[0][i], p->position[1][i], p->position[2][i]);
    break;
  }
  case NEWTON_SINGULAR: snprintf(words, size, "the body does not resist some motion at all%s", parts); break;
  case NEWTON_STOPPED: snprintf(words, size, "stopped on request"); break;
  case NEWTON_ASTRAY: snprintf(words, size, "an iteration led far away from the body as it was"); break;
  case NEWTON_COARSE: snprintf(words, size, "the body softens on the way, which is gone in smaller parts"); break;
  case NEWTON_INVERTED: snprintf(words, size, "particles are turned inside out in the equilibrium found"); break;
  case NEWTON_FAR:
    snprintf(words, size, "particles have moved by more than %.3g against each other, farther than contact looks ahead",
             forces_room(&d->forces));
    break;
  default: snprintf(words, size, "the forces have grown beyond all bounds");
  }
  return words;
}
