/* A law of one strain around another: outside a range of strains a point fails for good (the MinMax material of OpenSees). */
#ifndef BRECCIA_CONSTITUTIVE_MIN_MAX_H
#define BRECCIA_CONSTITUTIVE_MIN_MAX_H

#include "constitutive/material.h"

extern const breccia_law law_min_max;

/** Returns the base material to whose law limits of strain are added, or NULL if a material has no such limits. */
Material *material_within_limits(const Material *material);

/** Whether a point has failed by the limits of its strain. */
bool material_is_beyond_limits(const Material *material, const double *history);

/** Returns true if the law of a material, or the law inside its limits of strain, reads the pressure across bonds. */
bool material_takes_lateral(const Material *material);
/** Returns true if the law of a material, or the law that it limits, asks where points stand. */
bool material_takes_places(const Material *material);
/** Returns breccia_law.confined_history of the law of a material, or of the law inside its limits of strain; 0 for laws
 *  in servers. */
int material_confined_history(const Material *material);
/** Returns the compressive strength of the law of a material, or of the law inside its limits of strain; NaN: none. */
double material_compressive_strength(const Material *material);

#endif
