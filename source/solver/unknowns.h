/* Which displacements are free in a stage, for solvers that solve for them.
 *
 * Vectors are arrays over places, a row of each motion, as displacements are. Prescribed motions, ties and the space of
 * the body make rows that say how some changes of displacements follow from others: v = T q + g. T is never made:
 * `unknowns_spread` is T and `unknowns_gather` its transpose, both in place. A vector of unknowns q is 0 wherever a
 * displacement is not free. Of a particle that is held in a direction along no axis what is left of the vector in the
 * plane across it is free. Where forces are compared with forces or motions with motions, a rotation counts as the
 * displacement that it makes at the particle's radius of gyration, so that nothing depends on the unit of length. Ties
 * have their unknown at the first particle of each group, platens at their leaders (loading/platen.h). Mirror images
 * outside a support move with particles inside and take no part in their equilibrium: by symmetry it is that of one
 * half, and their forces are dropped, not handed on. */
#ifndef BRECCIA_SOLVER_UNKNOWNS_H
#define BRECCIA_SOLVER_UNKNOWNS_H

#include "domain/domain.h"
#include "loading/load.h"

typedef struct Unknowns {
  const Domain *domain;
  const Loading *loading;
  bool flat[3]; /* the body does not extend along this axis and nothing moves along it */
  double
      length; /* by which a rotation counts as a displacement: the radius of gyration of the first particle; 1 without rotations */
} Unknowns;

/** Those of the stage under way. Nothing is kept but what is pointed to. */
Unknowns unknowns_of(const Domain *domain, const Loading *loading);

/** Calls `one` for the n-th particle of each active motion, except for particles that the motion has let go. Particles
 *  that follow images come last. If two motions prescribe one particle, the later one counts. */
void unknowns_each_row(const Unknowns *unknowns, void (*one)(const Constraint *constraint, int64_t n, void *context),
                       void *context);

/** How many there are. */
int64_t unknowns_count(const Unknowns *unknowns, Error *error);

/** Gives a change of displacements its values where it is not free, by those that are: T. By one thread.
 *  @param[in] time  displacements held and change together are then as prescribed at this time of the run; NaN: nothing prescribed moves */
void unknowns_spread(const Unknowns *unknowns, double time, const Vector *v);

/** The same with what motions of controlled loads do where their factor grows by 1, and nothing else that is prescribed. By one thread. */
void unknowns_spread_controlled(const Unknowns *unknowns, const Vector *v);

/** Forces on all displacements to forces on the free ones: those on tied ones are handed on, all others taken off.
 *  @param[in,out] f  forces, not forces per volume */
void unknowns_gather(const Unknowns *unknowns, const Vector *f);

/** Sets what is not free to 0: the projection on vectors of unknowns. */
void unknowns_clear_rest(const Unknowns *unknowns, const Vector *v);

/** Weight of a row of motions beside others, as a length: 1 of displacements. */
static inline double unknowns_length(const Unknowns *unknowns, int row)
{
  return unknowns->domain->particles->space.row[row].kind == ROW_DISPLACEMENT ? 1 : unknowns->length;
}

/** Sums of products, the same bits for any number of threads: of forces with forces; of motions with motions. */
double unknowns_product_of_forces(const Unknowns *unknowns, const Vector *a, const Vector *b);
double unknowns_product_of_motions(const Unknowns *unknowns, const Vector *a, const Vector *b);

#endif
