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

/** Where the work went. external + kinetic at the start = kinetic + internal + fracture + friction + damping + error. */
typedef struct Energy {
  double kinetic;
  double internal; /* work on bonds, less what broken bonds released: stored, or dissipated by the law */
  double external; /* work of loads and prescribed motions */
  double damping;
  double fracture;  /* half force times elongation of bonds as they broke */
  double friction;  /* of contact */
  double imbalance; /* the error, over the largest of them */
} Energy;

typedef struct Explicit {
  Domain *domain;
  const Loading *loading;
  const ExplicitSpec *spec;
  double *acceleration[3];
  double time_step, stable, time;
  int64_t step, steps;        /* done, and wanted in all */
  int64_t broken_at_estimate; /* broken bonds when `stable` was found */
  double bond_work, external_work, damping_work, kinetic, kinetic_at_start;
  double motion;      /* largest component of any displacement increment in the step under way */
  double (*sums)[5];  /* [blocks] of the five above */
  double (*parts)[5]; /* the same for parts of prescribed selections */
} Explicit;

/** Sets up; finds the stable step and checks a chosen one against it.
 *  @param[in]  force    accept a chosen step above the stable one
 *  @param[out] warning  a remark for the user, or empty */
int explicit_create(Explicit *solver, Domain *domain, const Loading *loading, const ExplicitSpec *spec,
                    const DeckReader *reader, bool force, Text *warning);
void explicit_destroy(Explicit *solver);

/** Forces, accelerations and kinetic energy of the state held: before the first step, or after a restart. */
void explicit_begin(Explicit *solver);

/** One step. After a failure the state is that of the step before, with the reason in `error`. */
int explicit_advance(Explicit *solver, Error *error);

/** Finds the stable step again when bonds have broken since, and warns when the time step has come above it. */
int explicit_renew_stable_step(Explicit *solver, Text *warning, Error *error);

Energy explicit_energy(const Explicit *solver);

#endif
