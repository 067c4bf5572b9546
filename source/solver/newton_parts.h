/* Steps of an iteration that Newton's method (newton.c) and the descent by secants (newton_descent.c) share, inside of this room. */
#ifndef BRECCIA_SOLVER_NEWTON_PARTS_H
#define BRECCIA_SOLVER_NEWTON_PARTS_H

#include "solver/newton.h"

/** Adds to the forces out of balance what motions that are prescribed up to a time do to them by themselves. `change` and `moved` are lost.
 *  @return whether anything moves */
bool newton_add_motions(Newton *newton, double time);

/** Factors or a preconditioner for the next linear equations; the changes are 0 afterwards. */
int newton_prepare(Newton *newton, Error *error);

/** Adds a share of the change to the displacements. */
void newton_move(Newton *newton, double share);

/** How closely the next linear equations are to be solved: no closer than what their linearity is worth, but for bodies that are elastic.
 *  @param[in] force, before  forces out of balance now and an iteration before; 0: there was none */
double newton_wanted_accuracy(const Newton *newton, double force, double before);

/** Adds a line on the iteration to the log. @param[in] work  over that of the first iteration */
void newton_tell(const Newton *newton, double correction, double work, double share, const LinearRecord *linear);

/** Sizes of vectors over places: of forces, and of motions. */
double newton_size_of_forces(const Newton *newton, const Vector *f);
double newton_size_of_motions(const Newton *newton, const Vector *v);

/** Whether so much force is none: where a body only moves as a whole nothing is exerted but roundings. */
bool newton_is_balanced(const Newton *newton, double force);

/** Whether the tolerances of the deck hold. @param[in] work, first_work  of forces out of balance along the last and the first correction */
bool newton_has_converged(const Newton *newton, double force, double correction, double work, double first_work);

/** Whether displacements are beyond all reason: factors of a stiffness that is singular but for rounding give such ones, in balance. */
bool newton_is_carried_away(const Domain *domain);

/** How an increment comes on (newton_pace.c). */
typedef struct Pace {
  double least;     /* forces out of balance so far */
  int64_t since;    /* iterations by tangents that have not halved them */
  bool by_secants;  /* of bonds that soften */
  double enough;    /* with these forces out of balance tangents are tried again; 0: secants were never taken */
  int64_t products; /* that the equations of the first iteration have taken */
} Pace;

/** Where bonds soften and unload in turn corrections by tangents go round in circles, or to a state that the body does not stay in. Secants, which are
 *  nearly the same in both, lead to one in which it does, if slowly; near to it tangents are tried again.
 *  @return whether the slopes to be taken are others from now on */
bool pace_choose_slopes(Pace *pace, const Newton *newton, double force);

/** Products that the equations of the next iteration are allowed; 0: as many as they take. */
int64_t pace_allowed_products(const Pace *pace, const Newton *newton);

/** Whether an increment that has not converged yet is left to other ways. */
bool pace_leaves(const Pace *pace, const Newton *newton);

#endif
