/* The energies of a run: what loads and motions have put in, and where it went. */
#ifndef BRECCIA_SOLVER_LEDGER_H
#define BRECCIA_SOLVER_LEDGER_H

#include "domain/domain.h"
#include "solver/clock.h"

/** What is summed over steps. */
typedef struct Ledger {
  double bond_work, external_work, damping_work;
  double kinetic;   /* as of now */
  double between;   /* kinetic energy at full steps exceeds what the works say by the sum of this (explicit.c) */
  double numerical; /* that schemes of implicit dynamics have taken out of vibrations */
  double kinetic_at_start;
  double stored_at_start; /* of points and of steel that began under stress */
  double strain_work;     /* of strains of loads, as booked so far among both works */
  double paid;            /* the most that loads, motions and speeds at the start have put in so far */
  double wave;            /* fastest waves of its materials, as they are unharmed */
  double mass;            /* of all particles */
  double given;           /* largest speed that the start and prescribed motions have given any particle so far */
  double fastest;         /* largest component of any velocity in the middle of the last step */
  double fast_from;       /* that some steps ago, where it is beyond its bound */
  int64_t fast_steps;     /* up to now, in each of which it was beyond */
  int64_t damped;         /* there has been damping: its work is more than roundings */
  int64_t unsound_steps;  /* up to now, in each of which energy has come from nothing */
  bool trapped;           /* a floating-point trap has sprung in the last step */
  bool blown_up;          /* particles have become faster than anything explains */
} Ledger;

/** Where the work went: external + kinetic and stored at the start + between = kinetic + stored + dissipated +
 *  fracture + shed + friction + damping + numerical + error. */
typedef struct Energy {
  double kinetic;
  double internal;   /* stored + dissipated: work on bonds, less what went with broken ones */
  double stored;     /* that unloading would give back */
  double dissipated; /* by laws: yielding and softening */
  double external;   /* work of loads and prescribed motions */
  double damping;
  double fracture;  /* work that broken bonds had received and not given back or dissipated */
  double shed;      /* the part of that work which bonds held beyond their limits at rest, not counted in `fracture` */
  double friction;  /* of contact */
  double numerical; /* taken out of vibrations by schemes of implicit dynamics */
  double
      between; /* what the kinetic energy of the speeds at full steps is above that of the works (explicit.c): short waves
                       that the step hardly follows */
  double
      imbalance; /* the error without it, over the most that loads, motions and the speeds at the start have put in */
} Energy;

Energy ledger_energy(const Ledger *ledger, Domain *domain);

/** Before the first step: what speeds are measured by. */
void ledger_begin(Ledger *ledger, const Domain *domain);

/** Speed of the fastest waves of the materials of a body, as they are unharmed. */
double ledger_wave_speed(const Domain *domain);

/** After a step: what loads have put in by strains of the body since. */
void ledger_note_strains(Ledger *ledger, const Domain *domain);
/** After a step: what loads and motions have put in so far. */
void ledger_note_paid(Ledger *ledger);

/** After a step, with what was paid noted: fails if energy has come from nothing for some steps: bonds gave back more than they had received, or no work explains
 *  the speeds; or if particles have become faster than anything explains (docs/theory.md 7). */
int ledger_watch(Ledger *ledger, const Domain *domain, const Clock *clock, const Units *units, Error *error);

/** Marks the state as one that nobody goes on from: no checkpoint is written of it. */
void ledger_give_up(Ledger *ledger);

/** Whether particles have become faster than anything explains, so that the state is no result. */
bool ledger_has_blown_up(const Ledger *ledger);

/** Whether the next few steps will show that the last one has gone wrong: of such a state no checkpoint is written. */
bool ledger_is_doubtful(const Ledger *ledger);

/** Rows of the sums. */
void ledger_state(Ledger *ledger, StateList *list);

#endif
