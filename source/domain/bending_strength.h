/* Bending strength of beams, and tensile strength of lattices of links, over what their deck asks for: factors measured
 * with this program, for the material and lattice of each block. */
#ifndef BRECCIA_DOMAIN_BENDING_STRENGTH_H
#define BRECCIA_DOMAIN_BENDING_STRENGTH_H

#include "domain/domain.h"

/** Measured bending strength of a beam over that of a cohesive crack with the same strength, energy and softening curve.
 *  @param[in] rows    particles over the depth
 *  @param[in] depth   depth of the beam over E G_F / f_t^2
 *  @return factor between measured rows and depths, the nearest one beyond them; NaN: not measured */
double bending_factor(const char *formulation, const char *law, double rows, double depth);

/** Adds a line for each block that is at least twice as long as deep, with the measured factor of its bending strength,
 *  and a line for each block of links, with the measured factor of its tensile strength along its rows. */
void bending_strength_describe(const Domain *domain, Text *text);

#endif
