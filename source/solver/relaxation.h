/* Equilibrium by dynamic relaxation: forces alone, no tangents and no linearised equations (docs/theory.md 7; Underwood 1983, in Belytschko and Hughes,
 * Computational Methods for Transient Analysis; Kilic and Madenci 2010, Theor. Appl. Fract. Mech. 53, 194).
 *
 * The unknowns move in a time of its own, in steps of 1, with a mass that is no body's: M v' + c M v = forces out of balance. M is the stiffness of the
 * elastic body as the preconditioner of conjugate gradients knows it (preconditioner.h), times a number for which steps of 1 are stable. So all modes of an
 * elastic body have nearly one frequency, and c is taken from that of the motion under way, by its Rayleigh quotient v K v / v M v, where K v is the
 * difference of forces that follow each other. Momentum M v is what is kept: v follows from it, and M itself is not needed.
 *
 * Laws are asked for the whole way from the committed state in every step, as Newton's method does it: forces are a function of displacements, and what is
 * found does not remember how the body swung. What is prescribed moves at once, and all particles with it as in an elastic body; put in at once without
 * them, it strained what is near it ten times as much, and took twice as many steps.
 *
 * Where bonds soften, several equilibria may be close to each other, and the path of the relaxation decides which of
 * them is found. The mass, and with it the path, is then the same for each pose of the body (coarse_frame.h).
 *
 * Where few bonds hold the body together its slowest motion is far slower than those for which the mass is right, and comes to rest in thousands of steps. There the
 * body is moved once more as an elastic one would answer, with a mass for the bonds that are left.
 *
 * Tried on a bar of 7840 particles that yields, for a residual of 1e-8 in four increments: 195 steps so; 2598 with the diagonal of the stiffness alone as mass,
 * which is the usual way; 417 with the quotient of the displacements of the whole increment; without end with velocities put to 0 at peaks of the kinetic
 * energy, which wants steps well below the stable one. */
#ifndef BRECCIA_SOLVER_RELAXATION_H
#define BRECCIA_SOLVER_RELAXATION_H

#include "solver/newton.h"
#include "solver/preconditioner.h"

typedef struct Relaxation {
  ElasticStep elastic;
  Preconditioner mass; /* its inverse, but for the scale */
  double scale;        /* of M, for which steps of 1 are stable */
  double prepared;     /* time of the run for which the mass was made; NAN: none yet */
  Vector velocity;     /* displacements of a step */
  Vector momentum;     /* a vector of unknowns */
  Vector product;      /* to work with */
} Relaxation;

/** For the same domain, loads, tolerances and vectors as `newton`, which relaxes and has been created. `relaxation` is zero; destroy it in any case. */
int relaxation_create(Relaxation *relaxation, Newton *newton, Error *error);
/** Bytes that it takes. */
size_t relaxation_bytes(const Relaxation *relaxation, const Particles *particles);
void relaxation_destroy(Relaxation *relaxation);

/** As newton_solve. Where equilibrium is sought again for the same time the mass is that of the first search, until
 *  the body comes to rest slowly. @param[in] most  iterations */
NewtonOutcome relaxation_solve(Relaxation *relaxation, Newton *newton, double time, int64_t most, Error *error);

#endif
