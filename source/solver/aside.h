/* Forces at other displacements than those held, without a trace in what a step goes on from: arrays that stand in for the domain's own meanwhile.
 * Trial histories of points are touched, committed ones are not; and what particles show their neighbours is of there (domain_show_states). */
#ifndef BRECCIA_SOLVER_ASIDE_H
#define BRECCIA_SOLVER_ASIDE_H

#include "domain/domain.h"

/** Of the points of a region with strain in space. */
typedef struct AsideTensors {
  int shares; /* the first region that has the same arrays: those on particles have one set for all of them */
  double *strain[6], *stress[6];
} AsideTensors;

typedef struct Aside {
  double *displacement[MOTIONS]; /* at which forces are found */
  double *internal[MOTIONS];     /* those */
  AsideTensors *tensors;         /* [region_count] */
  int region_count;
} Aside;

/** @param[in] label  what it is for, in words. @return BRECCIA_OK or BRECCIA_FAILURE; destroy it in any case */
int aside_create(Aside *aside, const Domain *domain, const char *label, Error *error);
void aside_destroy(Aside *aside);
/** Memory of its arrays; 0 of one that was not made. */
size_t aside_bytes(const Aside *aside, const Domain *domain);

/** Puts these arrays in the place of the domain's, and back. By one thread. */
void aside_exchange(Aside *aside, Domain *domain);

#endif
