/* Equilibrium by Newton's method: displacements at which forces of bonds and loads cancel on all unknowns (docs/theory.md 7).
 *
 * Every iteration starts at the committed state of the points: laws are asked for the whole way from there, so that what they remember does not
 * depend on how the iteration came to its end. */
#ifndef BRECCIA_SOLVER_NEWTON_H
#define BRECCIA_SOLVER_NEWTON_H

#include "solver/control.h"
#include "solver/linear_solver.h"
#include "solver/solver.h"

/** Keys of solvers that iterate, to be put among theirs; each begins where the struct begins in theirs. */
typedef struct NewtonSpec {
  double residual, displacement, energy; /* tolerances; NaN: not asked */
  int64_t iterations;
  int linear; /* index of linear_word */
} NewtonSpec;

#define NEWTON_FIELDS(type, member)                                                                                    \
  {.key = "residual",                                                                                                  \
   .kind = FIELD_NUMBER,                                                                                               \
   .offset = offsetof(type, member.residual),                                                                          \
   .dimension = "1",                                                                                                   \
   .standard = "1e-8",                                                                                                 \
   .range = "[1e-14, 0.1]",                                                                                            \
   .meaning = "equilibrium: forces out of balance are below this share of those that loads and supports exert"},       \
      {.key = "displacement tolerance",                                                                                \
       .kind = FIELD_NUMBER,                                                                                           \
       .offset = offsetof(type, member.displacement),                                                                  \
       .dimension = "1",                                                                                               \
       .standard = "",                                                                                                 \
       .range = "(0, 1)",                                                                                              \
       .meaning = "besides, the last correction of displacements is below this share of what they have changed by"},   \
      {.key = "energy tolerance",                                                                                      \
       .kind = FIELD_NUMBER,                                                                                           \
       .offset = offsetof(type, member.energy),                                                                        \
       .dimension = "1",                                                                                               \
       .standard = "",                                                                                                 \
       .range = "(0, 1)",                                                                                              \
       .meaning = "besides, the work of forces out of balance along it is below this share of that of the first one"}, \
      {.key = "iterations",                                                                                            \
       .kind = FIELD_COUNT,                                                                                            \
       .offset = offsetof(type, member.iterations),                                                                    \
       .standard = "20",                                                                                               \
       .range = "[1, 1000]",                                                                                           \
       .meaning = "an increment that takes more is tried again with half of its length"},                              \
  {                                                                                                                    \
    .key = "equations", .kind = FIELD_CHOICE, .offset = offsetof(type, member.linear), .standard = "automatic",        \
    .meaning = "how linearised equations are solved", .choice = linear_word                                            \
  }

typedef enum NewtonOutcome {
  NEWTON_CONVERGED,
  NEWTON_SLOW,     /* too many iterations */
  NEWTON_LEFT,     /* it hardly comes on, and other ways to rest are at hand */
  NEWTON_UNSTABLE, /* the body does not resist some motion, and the next stable equilibrium is wanted */
  NEWTON_DIVERGED, /* forces that are no numbers, or grow beyond all bounds */
  NEWTON_LAW,      /* a law could not be integrated: domain->failed_place */
  NEWTON_SINGULAR, /* the linearised equations have no solution */
  NEWTON_COARSE, /* there is equilibrium, but the body softens on a way to it that the increment skips: said by who asks for it */
  NEWTON_ASTRAY, /* an iteration has led so far away that what is found from there would not be the next equilibrium */
  NEWTON_FAR,    /* there is equilibrium, but farther away than forces beside those of bonds look ahead */
  NEWTON_INVERTED, /* there is equilibrium, but with particles turned inside out: said by who asks for it */
  NEWTON_STOPPED,  /* on request */
  NEWTON_FAILED,   /* the reason is in the error */
} NewtonOutcome;

/** Forces beside those of bonds and loads that are to be balanced too: of inertia and damping. The tangent has theirs by `mass_factor` and
 *  `stiffness_share` of the linear solver. */
typedef struct NewtonForces {
  void *context;
  /** Before forces of bonds are found at the displacements held, for what needs linearised steps of its own.
   *  @param[in] moved  changes of displacements since the increment began; @param[in] time  at its end */
  int (*prepare)(void *context, const Vector *moved, double time, Error *error);
  /** Adds the forces on all places.
   *  @return the square of the size of forces beside which those out of balance are small, if these are more than loads and reactions */
  double (*add)(void *context, const Vector *moved, const Vector *force);
} NewtonForces;

typedef struct Newton {
  Domain *domain;
  const Loading *loading;
  const NewtonSpec *spec;
  const NewtonForces *beside; /* NULL: none, as at rest */
  bool
      has_others; /* other ways to rest are at hand, to which an increment is left where Newton's method hardly comes on */
  /* Newton's method ends with NEWTON_UNSTABLE where the tangent stiffness has a negative eigenvalue. */
  bool wants_stable;
  bool begins_by_secants;          /* the first iteration takes secants of bonds that soften: each as if it unloaded */
  const volatile int *interrupted; /* non-zero: what is under way ends at once; NULL: it never is */
  bool relaxes; /* by dynamic relaxation (relaxation.h): no equations are solved, and no tangents asked for */
  LinearSolver linear;
  Control *control; /* NULL: all factors of loads are given */
  double target;    /* what it is to be at the end of the increment */
  Vector force;     /* out of balance, on the unknowns */
  Vector change;    /* of displacements in an iteration */
  Vector moved;     /* in all iterations of an increment */
  /* With control only: */
  double factor_change;           /* of controlled loads, in an iteration */
  Vector unit_force, unit_motion; /* where that factor grows by 1: forces, and displacements from them */
  double reference;               /* the most that has acted in the stage so far, bonds at its begin among it */
  double exerted;                 /* the same, or what they exert now if that is more */
  double stiffness;               /* of the body at first, by which displacements make roundings of forces */
  double roundings,
      rounding_work; /* no closer than this are forces in balance; and the work of so much along all displacements */
  /* In dynamics of elastic bodies factors and preconditioners of their stiffness at the start, without displacements, serve for all steps of one length,
   * until bonds break. Of which these are is state, so that a restart makes the same; whether they are there is not. */
  double factored_share, factored_mass; /* stiffness_share and mass_factor */
  int64_t factored_broken;              /* bonds */
  int64_t factored_open;                /* key of one-sided supports at factorisation (loading/one_sided.h) */
  bool factored;
  int64_t open_in_factors; /* key of one-sided supports in the current factors; not part of the state */
  int64_t follows;      /* 1: the body has turned or stretched too much for them, and every iteration makes its own */
  Vector change_forces; /* room to foresee works; NULL: nobody wants them */
  /* of the last increment */
  double foreseen; /* work on bonds, had it gone on as it began, by tangents */
  int64_t iterations, products;
  double unbalanced_before, unbalanced; /* forces out of balance over the reference, at its begin and at its end */
  bool indefinite;                      /* the body did not resist some change of displacements */
  Text *log;                            /* a line per iteration is added; NULL: nobody wants it */
} Newton;

/** `newton` has domain, loading, spec and `beside`, and is zero beyond; destroy it in any case. */
int newton_create(Newton *newton, Error *error);
void newton_destroy(Newton *newton);

/** Measures equilibrium by no less than the forces of bonds on all places as they are: where the last load is taken away, or a body springs from stresses
 *  at which it began, nothing need act on it in the end. */
void newton_note_forces_held(Newton *newton);

/** Whether what is under way is to end at once. */
static inline bool newton_is_interrupted(const Newton *newton)
{
  return newton->interrupted && __atomic_load_n(newton->interrupted, __ATOMIC_RELAXED);
}

/** Forces at the displacements held, and what linearised steps need of them. */
int newton_linearise(const Newton *newton, Error *error);

/** Whether parts of the body have moved so far against each other in an increment that forces between them may have been missed. */
bool newton_has_gone_far(const Newton *newton);

/** Forces out of balance on the unknowns, with loads as they are at a time of the run, and the most that supports and loads exert.
 *  @return that the laws could be asked, or that the solution is to stop */
NewtonOutcome newton_find_forces(Newton *newton, double time, Error *error);

/** Commits the lengths by crack normal of points whose damage begins (domain_take_lengths) and evaluates forces with
 *  these lengths. Called at an equilibrium that was found without them.
 *  @param[out] again  true if forces are out of balance with these lengths, so that the iteration must continue
 *  @return as newton_find_forces */
NewtonOutcome newton_take_lengths(Newton *newton, double time, bool *again, Error *error);

/** From the displacements held, which are those of the committed state, to equilibrium with loads and motions as they are at a time of the run. */
NewtonOutcome newton_solve(Newton *newton, double time, Error *error);

/** Iterations after which an increment is given up: those of the deck, and more where linearised steps are secants from the first on. */
int64_t newton_most_iterations(const Newton *newton);

/** Adds to the change that brings forces into balance what takes the measure of the control to its target, and finds the factor of the loads for it
 *  (newton_control.c). @param[out] work  of the forces out of balance along the change */
NewtonOutcome newton_follow_control(Newton *newton, double accuracy, double *work, Error *error);

/** Force that controlled loads exert on the body as it is: the sum of the sizes of their forces, and of what their motions take, each as a whole. */
double newton_controlled_force(Newton *newton);

/** Before the first step: says so where the controlled loads do nothing to what is measured (newton_control.c). */
int newton_check_control(Newton *newton, Error *error);

/** Tries what an increment will take (newton_cost.c). @param[out] cost  of one, and memory */
int newton_measure(Newton *newton, StepCost *cost, Error *error);

/** Rows of what it keeps from one increment to the next. */
void newton_state(Newton *newton, StateList *list);

/** Sets external forces to what loads say at a time of the run. */
void newton_apply_loads(const Newton *newton, double time);

/** Why it did not converge. @return `words` */
const char *newton_describe(const Newton *newton, NewtonOutcome outcome, char *words, size_t size);

#endif
