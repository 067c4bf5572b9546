/* Explicit dynamics by velocity Verlet, inside of this room: one file for the keys and a whole step (explicit.c), one for its passes over all particles
 * (verlet.c), one for how long steps are (step_plan.c), one for prescribed motions (prescribed.c), one for steps that fail (retreat.c). */
#ifndef BRECCIA_SOLVER_EXPLICIT_H
#define BRECCIA_SOLVER_EXPLICIT_H

#include "solver/damping.h"
#include "solver/face_work.h"
#include "solver/quasi_static.h"
#include "solver/solver.h"
#include "solver/stiffness_damping.h"

typedef struct ExplicitSpec {
  SectionHead head;
  double time_step, safety, end_time, local_damping, rest;
  QuasiStaticSpec *quasi_static; /* NULL: not this way */
  DampingKeys damping_given;
  Rayleigh damping; /* from these */
  int64_t steps;
} ExplicitSpec;

/** What is summed over a step; MOTION is the largest component of any displacement increment. */
enum { BOND_WORK, EXTERNAL_WORK, DAMPING_WORK, KINETIC, BETWEEN, MOTION, SUMS };

typedef struct Explicit {
  Domain *domain;
  const Loading *loading;
  const ExplicitSpec *spec;
  Clock *clock;
  Ledger *ledger;
  bool force;    /* accept a chosen step above the stable one */
  double period; /* of `quasi_static`: of the slowest vibration that loads set off; else 0 */
  Vector acceleration;
  int rows[MAX_ROWS], row_count; /* of motion, that something can move */
  StiffnessDamping viscous;      /* with damping.stiffness only */
  /* Steps of one length, from a time to a time. */
  struct {
    double from, to;
    int64_t first, count;
  } plan;
  double fixed; /* the step that the deck says, or the program's where the deck counts steps; NaN: free to follow */
  int64_t broken_at_estimate, step_at_estimate; /* when the stable step was found */
  StateCopy before;                             /* rows as they were before the step under way */
  Kept kept;                                    /* which rows `before` holds */
  struct Motion {                               /* of each constraint in the step under way */
    double target;                              /* displacement at its end */
    double moved;                               /* in the step */
    double rate;                                /* velocity at its end */
  } * motions;
  FaceWork face_work;
  double motion;         /* largest component of any displacement increment in the step under way */
  double (*sums)[SUMS];  /* [batches] */
  double (*parts)[SUMS]; /* the same for parts of prescribed selections */
} Explicit;

/** Rate of damping in proportion to mass: of the deck, or for the period of `quasi_static`. */
double explicit_mass_damping(const Explicit *solver);

/** Length, number and end of the steps to come, for the body as it is. */
int explicit_plan(Solver *solver, Text *warning, Error *error);
void explicit_plan_again(Solver *solver);
/** Length of the last step where it is shorter than the `time step` of the deck, so that the stage ends at its `end time`; else NaN. */
double explicit_last_step(const Explicit *solver);
int explicit_check(Solver *solver, const void *spec, Error *error);
/** Before a step: where bonds have broken the stable step is found again now and then, and the steps follow. */
int explicit_follow(Solver *solver, Text *warning, Error *error);
double explicit_time_after_step(const Explicit *solver);

/** Steps and time of a stage with this section, for the stable step on the clock. */
void explicit_foresee(const void *spec, const Clock *clock, double *steps, double *time);

/** Motion before a step that has come to its forces, from that in its middle, where its rows were not copied: but for
 *  roundings, and for velocities of what is moved, which are the mean of the step. By one thread. */
void explicit_step_back(Explicit *s);

/** First half of a step of a batch: velocities to the middle of the step, displacements to its end. */
void explicit_kick_and_drift(Explicit *solver, int64_t batch);
/** Second half: accelerations and velocities at the end of the step. */
void explicit_kick(Explicit *solver, int64_t batch);

/** Parts into which the particles of a constraint are shared out among threads. */
int64_t explicit_parts_of(const Constraint *constraint);
void explicit_add_to_ledger(Explicit *solver, const double *sums);
/** What constraints prescribe in the step to come. By one thread. */
void explicit_foresee_motions(Explicit *solver);
/** After the drift: displacements at the end of the step, velocities in its middle. By all threads. */
void explicit_prescribe_displacements(Explicit *solver);
/** Registers platens that let go in the step, after loads have been applied at its end. One more particle under each
 * moves freely from the middle of the step on. Serial. */
void explicit_note_open_platens(Explicit *solver);
/** After the second kick: velocities at the end of the step, by central difference of the prescribed motion. By all threads. */
void explicit_prescribe_velocities(Explicit *solver);

/** Force of inertia and damping of the n-th particle of a motion along its direction, by central difference of what is prescribed. */
double explicit_inertia(const Solver *solver, const Constraint *constraint, int64_t n);

/** Takes the state back to the start of the step, and says what happened. @return BRECCIA_FAILURE */
int explicit_retreat(Explicit *solver, Error *error);

#endif
