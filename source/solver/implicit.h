/* Implicit dynamics, inside of this room: one file for the keys and words (implicit.c), one for a step (implicit_step.c). */
#ifndef BRECCIA_SOLVER_IMPLICIT_H
#define BRECCIA_SOLVER_IMPLICIT_H

#include "solver/damping.h"
#include "solver/increment.h"
#include "solver/newton.h"
#include "solver/pressing.h"

typedef enum ImplicitScheme { SCHEME_NEWMARK, SCHEME_HHT } ImplicitScheme;

typedef struct ImplicitSpec {
  SectionHead head;
  double end_time, time_step, smallest, local_error, beta, gamma, alpha;
  int scheme; /* ImplicitScheme */
  DampingKeys damping_given;
  Rayleigh damping; /* from these */
  NewtonSpec newton;
} ImplicitSpec;

typedef struct Implicit {
  Domain *domain;
  const Loading *loading;
  const ImplicitSpec *spec;
  Clock *clock;
  Ledger *ledger;
  Newton newton;
  NewtonForces beside;
  Increment increment;
  Pressing pressing;
  Vector acceleration;
  Vector drag; /* forces of damping, against velocities */
  /* At the end of the step under way, as far as it has been iterated; `result` is whatever is worked out. */
  Vector velocity, drag_then, result;
  double length; /* of the step under way */
  double struck; /* energy that impacts on one-sided supports dissipate in the current step */
  double then;   /* time of the run at its end */
  double next;   /* of the step to be tried next */
  double shift;  /* size of the largest displacements so far, by which errors are measured */
  double stable; /* longest step of explicit dynamics at the begin of the stage */
  int64_t cuts;  /* in the stage */
  bool coarse;   /* a smallest step erred by more than asked for, and this was told */
} Implicit;

/** The longest step that the stage may take. */
double implicit_longest(const ImplicitSpec *spec);

/** Inertia and damping, for Newton's method. */
NewtonForces implicit_forces(Implicit *solver);

/** Velocities, accelerations and damping of the state held. */
int implicit_begin(Solver *solver, Error *error);
int implicit_advance(Solver *solver, Text *warning, Error *error);
/** Foresees how many steps there will be. */
void implicit_count_steps(const Solver *solver);

#endif
