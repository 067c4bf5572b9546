/* Products K v with the stiffness that a body would have if its laws answered elastically from the displacements held, by differences of forces: one
 * evaluation each, for every formulation and law, and no tangent is kept. What softens or yields is not stiffer than that. */
#ifndef BRECCIA_SOLVER_ELASTIC_STEP_H
#define BRECCIA_SOLVER_ELASTIC_STEP_H

#include "domain/domain.h"

typedef struct ElasticStep {
  Vector force; /* internal forces per volume at the displacements held */
  Vector tried; /* displacements beside those */
} ElasticStep;

/** `step` is zero; destroy it in any case. */
int elastic_step_create(ElasticStep *step, const Domain *domain, Error *error);
/** Bytes that it takes. */
size_t elastic_step_bytes(const Particles *particles);
void elastic_step_destroy(ElasticStep *step);

/** Displacements have changed, or bonds have broken. Trial states are touched, committed ones are not. */
void elastic_step_prepare(ElasticStep *step, Domain *domain);

/** Changes of internal forces per volume with changes v of displacements; touches trial states. */
void elastic_step_apply(const ElasticStep *step, Domain *domain, const Vector *v, const Vector *change);

#endif
