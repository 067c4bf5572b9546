/* Bending strength of beams over that of a cohesive crack, and tensile strength of lattices of links over that of their
 * deck: factors measured with this program, by formulation, law and number of particle rows. */
#ifndef BRECCIA_DOMAIN_BENDING_STRENGTH_H
#define BRECCIA_DOMAIN_BENDING_STRENGTH_H

#include "domain/domain.h"

/** Measured bending strength of a beam over that of a cohesive crack with the same strength, energy and softening
 *  curve.
 *  @param[in] rows    number of particle rows over the depth
 *  @param[in] depth   depth of the beam over E G_F / f_t^2
 *  @return factor, interpolated in the logarithms of rows and depth, and constant outside the measured range; NaN: the
 *          law was not measured */
double bending_factor(const char *formulation, const char *law, double rows, double depth);

/** Bending strength of a beam with one cohesive crack over the tensile strength.
 *  @param[in] depth   depth of the beam over E G_F / f_t^2
 *  @return interpolated in the logarithm of the depth between 0.3 and 1.2, and constant beyond; NaN: not computed for
 *          the law */
double bending_cohesive(const char *formulation, const char *law, double depth);

/** Adds a line for each block that is at least twice as long as deep, with its bending strength over the tensile one,
 *  and a line for each block of links, with the measured factor of its tensile strength along its rows. */
void bending_strength_describe(const Domain *domain, Text *text);

#endif
