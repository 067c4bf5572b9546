/* Damping in proportion to the stiffness K0 of laws before they yield or soften, in explicit steps: b times the change of elastic forces in a step over its
 * length, so with the velocity in its middle. From u to u' an elastic body gives up b / dt (f(u) - f(u')) (u' - u), never less than nothing. */
#ifndef BRECCIA_SOLVER_STIFFNESS_DAMPING_H
#define BRECCIA_SOLVER_STIFFNESS_DAMPING_H

#include "domain/tensor_copy.h"

typedef struct StiffnessDamping {
  double time;        /* b; 0: there is none, and no array */
  TensorCopy tensors; /* of the step, which evaluations of elastic forces overwrite */
  Vector was;         /* displacements before the step */
  Vector force;       /* elastic forces per volume */
  Vector drag;        /* [places] force per volume against the motion, as found last */
  Vector left;        /* internal forces, while the drag is subtracted from those of the particles */
} StiffnessDamping;

/** `damping` is zero; destroy it in any case. */
int stiffness_damping_create(StiffnessDamping *damping, double time, const Domain *domain, Error *error);
void stiffness_damping_destroy(StiffnessDamping *damping);
/** Memory that it takes. */
size_t stiffness_damping_bytes(const StiffnessDamping *damping, const Domain *domain);

/** Copies the displacements before a step. */
void stiffness_damping_note(StiffnessDamping *damping, const Domain *domain);
/** Finds the drag. Call it when displacements are those at the end of the step, before its forces are evaluated, by one
 *  thread; it runs on the team in use.
 *  @param[in] step  its length */
void stiffness_damping_find(StiffnessDamping *damping, Domain *domain, double step);

/** Subtracts the drag from the internal forces, for loads that look at all forces, and restores them: by all
 *  threads. */
void stiffness_damping_take_off(StiffnessDamping *damping, Domain *domain);
void stiffness_damping_put_back(StiffnessDamping *damping, Domain *domain);

/** The longest stable step with it, of a body whose longest is `stable` without (docs/theory.md 7). */
double stiffness_damping_step(double time, double stable);

#endif
