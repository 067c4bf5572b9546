/* A constitutive driver: one material point, each component of which follows a prescribed strain or a prescribed stress. */
#ifndef BRECCIA_CONSTITUTIVE_DRIVER_H
#define BRECCIA_CONSTITUTIVE_DRIVER_H

#include "constitutive/material.h"

typedef struct Driver {
  const Material *material;
  int components; /* 6, or 1 of uniaxial laws */
  double *committed, *trial;
  double strain[6], stress[6], tangent[36]; /* of the last step; tangent [components][components] */
  bool elastic;                             /* respond elastically (gravity stage) */
  double time, time_step;                   /* of the committed state; of the step to come, 0: at once */
} Driver;

int driver_create(Driver *driver, const Material *material, Error *error);
void driver_destroy(Driver *driver);

/** Tries a strain without committing it. @return false if the law could not be integrated */
bool driver_try(Driver *driver, const double *strain);
/** Makes the last trial state the committed one. */
void driver_commit(Driver *driver);

/** One step, in `time_step`, to targets, which are stresses where `by_stress` says so and strains otherwise, and commits it. The strains
 *  that belong to stresses are found by Newton's method; a step that fails is cut into up to 1024 parts.
 *  @param[in] tolerance  of stresses
 *  @return false, with the state of the last part that went well, if the targets cannot be reached */
bool driver_step(Driver *driver, const bool *by_stress, const double *target, double tolerance);

#endif
