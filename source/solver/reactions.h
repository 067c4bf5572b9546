/* What supports and prescribed motions exert on a body: in each direction in which a particle's motion is prescribed, the force that must act on it beside bonds, loads
 * and damping so that it moves as it does. Particles outside a support, mirror images of others, stand for the support: what bonds with them exert on the
 * body is its reaction, and no loads act on them. */
#ifndef BRECCIA_SOLVER_REACTIONS_H
#define BRECCIA_SOLVER_REACTIONS_H

#include "solver/solver.h"

typedef struct Reactions {
  double
      *force[3]; /* [places] on held particles, what is left of it while they are gone through; untouched elsewhere */
} Reactions;

/** A sum of forces, and its moment about a point. */
typedef struct Wrench {
  double force[3], moment[3], about[3];
  double size; /* sum of the sizes of the forces */
} Wrench;

/** `reactions` is zero; destroy it in any case. */
int reactions_create(Reactions *reactions, const Particles *particles, Error *error);
void reactions_destroy(Reactions *reactions);

/** Sum of the reactions in the state held.
 *  @param[in] on     [places] 1: on these particles; NULL: on all
 *  @param[in] load   name of the load whose motions count; NULL: all motions that act. Of several supports that mirror, what the bonds of its images
 *                    with particles inside exert
 *  @param[in] about  point of the moment, forces acting where particles are now; NULL: the middle of the particles, as they are
 *                    now; of supports that mirror, of their faces */
Wrench reactions_sum(const Reactions *reactions, const Solver *solver, const uint8_t *on, const char *load,
                     const double *about);

/** Returns true if reactions_of_each sums bond forces because several supports mirror, which takes longer than a
 *  step. */
bool reactions_of_each_ask_bonds(const Loading *loading);

/** Finds what the motions of each load exert in the state held, as reactions_sum does.
 *  @param[out] force  [loads]; 0 of loads that prescribe no motion or do not act */
void reactions_of_each(const Reactions *reactions, const Solver *solver, double (*force)[3]);

/** Sum of the forces of loads on the particles of the body, springs and gravity among them. */
Wrench reactions_of_loads(const Solver *solver, const double about[3]);

#endif
