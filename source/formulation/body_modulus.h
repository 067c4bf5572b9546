/* Young's modulus that the families of a block show together. Families at surfaces lack bonds, so that thin blocks are
 * softer or stiffer than their material. */
#ifndef BRECCIA_FORMULATION_BODY_MODULUS_H
#define BRECCIA_FORMULATION_BODY_MODULUS_H

#include "family/family.h"

#include "base/text.h"

/** A formulation whose families at surfaces differ in stiffness from those inside. */
typedef struct BodyModulus {
  const void *formulation;
  /** Returns the modulus that all families of a block show in uniform tension along an axis, over that of the deck. */
  double (*young)(const void *formulation, int block, int axis);
  const Body *body;
  const Particles *particles;
  const char *wrong;  /* results of particles that are wrong by the same factor */
  const char *remedy; /* appended to the advice to take more rows; may be "" */
  double tolerance;   /* error of the modulus from which on a block is described */
} BodyModulus;

/** Adds a line with the smallest and the largest relative modulus of a block along its axes. If the modulus is more than 3 % off along an axis that is at least half as long as the longest one, the line has the error and the
 *  remedy: thin parts are stretched and bent along themselves. Adds nothing if all errors are within `tolerance`. */
void body_modulus_describe(const BodyModulus *of, int block, Text *text);

#endif
