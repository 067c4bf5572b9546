/* Elements of the coarse grid: boxes with bilinear or trilinear displacements. */
#ifndef BRECCIA_SOLVER_COARSE_ELEMENT_H
#define BRECCIA_SOLVER_COARSE_ELEMENT_H

#include "domain/domain.h"

enum { ELEMENT_SIZE = 24 };

/** For moduli of 1, [corner * axes + component] by the same. */
typedef struct ElementStiffness {
  double lame[ELEMENT_SIZE][ELEMENT_SIZE], shear[ELEMENT_SIZE][ELEMENT_SIZE];
} ElementStiffness;

/** Lame's constants of an isotropic solid: stress = lame trace(strain) 1 + 2 shear strain, in as many axes as the body has. */
typedef struct ElementModuli {
  double lame, shear;
} ElementModuli;

/** Integrals over a box by 2 points along each axis. */
void element_stiffness(int axes, const double size[3], ElementStiffness *stiffness);

/** Computes the moduli that a particle's family has left.
 *  @param[in] linearised  true: by the tangent of its point, at the state at which the domain was linearised; false: by
 *  the elastic moduli. Tangents outlive the stage that has linearised the domain, and a restart does not have them */
ElementModuli element_moduli(const Domain *domain, int32_t place, bool linearised);

#endif
