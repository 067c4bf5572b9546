/* What solvers that iterate try at a time: an increment that is accepted whole or taken back whole, and bonds that break between two. */
#ifndef BRECCIA_SOLVER_INCREMENT_H
#define BRECCIA_SOLVER_INCREMENT_H

#include "solver/face_work.h"
#include "solver/newton.h"

typedef struct Increment {
  Domain *domain;
  StateCopy before;
  FaceWork face_work;
  Vector internal, external; /* forces per volume of bonds and of loads at its beginning */
  bool apart;                /* parts have moved against each other since forces between them were looked for */
  /* Of forces beside those of bonds, where there are any: at its beginning, with the energy that they held or had dissipated; and now. */
  Vector beside, beside_now;
  double held;
  double
      moved; /* sum over the increments since bonds were judged of the largest component of any displacement in each */
} Increment;

/** Refuses what solvers that iterate have no place for.
 *  @param[in] section   of the solver's keys, to be named
 *  @param[in] newton    of one that needs to know how stresses change with strains; NULL: it does not
 *  @param[in] instead   what to do without the solver */
int increment_check(const Solver *solver, const void *section, const NewtonSpec *newton, const char *instead,
                    Error *error);

/** `increment` is zero; destroy it in any case. */
int increment_create(Increment *increment, Domain *domain, const Loading *loading, Error *error);
void increment_destroy(Increment *increment);

/** Room for what an increment tries; only while steps are taken, as pictures and the like need room afterwards. */
int increment_keep(Increment *increment, Solver *solver, Error *error);
void increment_forget(Increment *increment);

/** Bytes of what it keeps, and of what increment_keep makes room for. */
size_t increment_bytes(const Increment *increment, Solver *solver);

/** Where an increment of a length ends: at a time that is asked for, if it comes before its end or hardly behind it. */
double increment_end(const Solver *solver, double length);

/** At the begin of a stage, when forces have been evaluated: where faces stand to each other counts from there. */
void increment_start(Increment *increment);

/** Notes the state, so that it can be had back. */
void increment_begin(Increment *increment);
/** The same where an increment is solved again: forces stay noted as they were at its beginning. */
void increment_begin_again(Increment *increment);
/** The state as it was noted; of loads, what they exerted when forces were noted. */
void increment_retreat(Increment *increment);
/** What laws, forces and orientations remember of the increment is so from now on.
 *  @param[in] moved  changes of displacements in it */
void increment_accept(Increment *increment, const Vector *moved);

/** What faces that meet within an increment have taken beyond the mean of their forces at both ends of it, when it has been accepted: they may have come
 *  a long way before they met. @param[in] moved  changes of displacements since increment_begin */
double increment_sudden_work(Increment *increment, const Vector *moved);

/** Work on the bonds of the body along a way, by the trapezium rule of the forces at its beginning and now. */
double increment_bond_work(Increment *increment, const Vector *moved);

/** Breaks the most loaded bonds that are beyond their limit, at the displacements held, and commits what is left of the body, with its forces.
 *  @param[in] most  as in Moment
 *  @return how many */
int64_t increment_break(Increment *increment, const Clock *clock, int64_t most);

#endif
