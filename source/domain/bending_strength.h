/* Bending strength of beams, and tensile strength of lattices of links over that of their deck. The bending strength is
 * the product of two factors: that of a beam with a cohesive crack over f_t, and that of the beam of particles over the
 * beam with the cohesive crack, measured with this program by formulation, law and number of particle rows. */
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

/** Bending strength of a beam with one cohesive crack, of the softening curve of a law, over the tensile strength f_t.
 *  @param[in] depth   depth of the beam over E G_F / f_t^2
 *  @return factor, interpolated in the logarithm of the depth between 0.3 and 1.2, and constant outside that range;
 *          NaN: not computed for the formulation and law */
double bending_cohesive(const char *formulation, const char *law, double depth);

/** Adds a line for each block that is at least twice as long as deep, with its bending strength over f_t, and a line
 *  for each block of links, with the measured factor of its tensile strength along its rows. */
void bending_strength_describe(const Domain *domain, Text *text);

#endif
