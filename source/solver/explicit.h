/* Explicit dynamics by velocity Verlet, with its energy ledger. */
#ifndef BRECCIA_SOLVER_EXPLICIT_H
#define BRECCIA_SOLVER_EXPLICIT_H

#include "domain/domain.h"
#include "loading/load.h"

typedef struct DampingSpec {
  SectionHead head;
  double ratio, at; /* of critical damping, at a frequency */
} DampingSpec;

typedef struct ExplicitSpec {
  SectionHead head;
  double time_step, safety, end_time, local_damping;
  NumberOrSection damping_given;
  double damping; /* the rate c */
  int64_t steps;
} ExplicitSpec;

extern const Section explicit_section;

/** Where the work went: external + kinetic at the start + between = kinetic + stored + dissipated + fracture + friction + damping + error. */
typedef struct Energy {
  double kinetic;
  double internal;   /* stored + dissipated: work on bonds, less what went with broken ones */
  double stored;     /* that unloading would give back */
  double dissipated; /* by laws: yielding and softening */
  double external;   /* work of loads and prescribed motions */
  double damping;
  double fracture; /* work that broken bonds had received and not given back or dissipated */
  double friction; /* of contact */
  double
      between; /* what the kinetic energy of the speeds at full steps is above that of the works (explicit.c): short waves
                       that the step hardly follows */
  double
      imbalance; /* the error without it, over the most that loads, motions and the speeds at the start have put in */
} Energy;

/** Enough to take a step back: what is summed over steps. */
typedef struct Ledger {
  double bond_work, external_work, damping_work, kinetic;
  double between; /* kinetic energy at full steps exceeds what the works say by the sum of this (explicit.c) */
} Ledger;

typedef struct Explicit {
  Domain *domain;
  const Loading *loading;
  const ExplicitSpec *spec;
  bool force;
  double *acceleration[3];
  double time_step; /* of the step to come */
  double stable;    /* stable step of the body as it is, with its damping */
  double time;
  int64_t step, steps; /* done; in all, as far as it can be foreseen */
  double end_time;
  /* Steps of one length, from a time to a time. */
  struct {
    double from, to;
    int64_t first, count;
  } plan;
  double fixed; /* the step that the deck says, or the program's where the deck counts steps; NaN: free to follow */
  const double *stops; /* ascending times at which steps of the program's own end; the caller's, may be NULL */
  int64_t stop_count;
  int64_t broken_at_estimate, step_at_estimate; /* when `stable` was found */
  Ledger ledger;
  double kinetic_at_start;
  int64_t unsound_steps; /* up to now, in each of which energy has come from nothing */
  double paid;           /* the most that loads, motions and speeds at the start have put in so far */
  StateCopy before;      /* what the step under way has tried, as it was */
  double motion;         /* largest component of any displacement increment in the step under way */
  double (*sums)[6];     /* [blocks] of BOND_WORK ... (explicit.c) */
  double (*parts)[6];    /* the same for parts of prescribed selections */
} Explicit;

/** Sets up; finds the stable step and checks a chosen one against it.
 *  @param[in]  force    accept a chosen step above the stable one
 *  @param[out] warning  a remark for the user, or empty */
int explicit_create(Explicit *solver, Domain *domain, const Loading *loading, const ExplicitSpec *spec,
                    const DeckReader *reader, bool force, Text *warning);
void explicit_destroy(Explicit *solver);

/** Rows of the clock, of what is summed over steps and of the plan of steps, and of the accelerations. */
void explicit_state(Explicit *solver, StateList *list);
/** Length of the last step where it is shorter than the `time step` of the deck, so that the run ends at its `end time`; else NaN. */
double explicit_last_step(const Explicit *solver);

/** Tells times, ascending, at which steps shall end if the program chooses them; borrowed. Before the first step. */
void explicit_stop_at(Explicit *solver, const double *times, int64_t count);

/** Forces, accelerations and kinetic energy of the state held: before the first step, or after a restart. */
void explicit_begin(Explicit *solver);

/** One step. After a failure the reason is in `error`, and the state that of the step before; where energies give the reason the step has been taken. Where bonds have broken the stable step
 *  is found again now and then, and the steps follow.
 *  @param[out] warning  a remark for the user is added, if there is one */
int explicit_advance(Explicit *solver, Text *warning, Error *error);

Energy explicit_energy(const Explicit *solver);

#endif
