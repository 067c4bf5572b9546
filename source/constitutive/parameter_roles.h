/* Parameters of laws that have a role outside of their law, as ROLE(C name, name of the parameter). A law whose
 * parameter has one of these names gets the advice, the checks and the defaults of the role. */
ROLE(YOUNG_MODULUS, "Young modulus")
ROLE(POISSON_RATIO, "Poisson ratio")
ROLE(BULK_MODULUS, "bulk modulus")
ROLE(SHEAR_MODULUS, "shear modulus")
ROLE(FRACTURE_ENERGY, "fracture energy")
ROLE(LENGTH, "length")         /* over which a fracture energy is spread; that of the formulation where absent */
ROLE(DIMENSIONS, "dimensions") /* of the body where absent */
/* Strengths, from FIRST_STRENGTH to LAST_STRENGTH of material.h, compared with the stiffness: */
ROLE(TENSILE_STRENGTH, "tensile strength")
ROLE(COMPRESSIVE_STRENGTH, "compressive strength")
ROLE(YIELD_STRESS, "yield stress")
ROLE(UNDRAINED_STRENGTH, "undrained strength")
ROLE(COMPRESSIVE_YIELD_STRESS, "compressive yield stress")
ROLE(OCTAHEDRAL_STRENGTH, "octahedral strength")
/* Cones of soil and rock: */
ROLE(COHESION, "cohesion")
ROLE(FRICTION_ANGLE, "friction angle")
ROLE(DILATION_ANGLE, "dilation angle")
ROLE(CONE_STRENGTH, "cone strength")
ROLE(CONE_SLOPE, "cone slope")
ROLE(DILATION_SLOPE, "dilation slope")
ROLE(TENSION_CUT_OFF, "tension cut-off")
