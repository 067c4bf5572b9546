/* Particles as arrays, side by side in slices of eight.
 *
 * A slice holds eight neighbouring places of one lattice row, so that the same bond of its particles leads to eight places
 * side by side again. A place that no particle uses (beyond the end of a row, in a hole) has number -1 and volume 0.
 * Always true: places = 8 slices; every array has eight spare entries before and after, so that a vector load that begins
 *   up to seven places outside stays inside memory; numbers run along x, then y, then z, block by block. */
#ifndef BRECCIA_BODY_PARTICLES_H
#define BRECCIA_BODY_PARTICLES_H

#include "base/lanes.h"
#include "base/memory.h"
#include "base/state.h"
#include <stdint.h>

typedef struct Particles {
  int64_t count, places, slices;
  double *position[3], *displacement[3], *velocity[3];
  double *internal[3]; /* force per volume from bonds */
  double *external[3]; /* force per volume from loads */
  double *zero[3];     /* displacements that are shown as none; NULL: 0 */
  double *volume;      /* 0 in unused places */
  double *density;
  int32_t *number;   /* [places] global number or -1 */
  int32_t *place_of; /* [count] place of a number */
  int32_t *block;    /* [slices] which block of the deck */
} Particles;

/** Zeroed array over places with the spare entries that Particles promises. Freed with places_free. */
double *places_array(int64_t places, const char *label, Error *error);
void places_free(double **array);

int particles_create(Particles *particles, int64_t slices, int64_t count, Error *error);
void particles_destroy(Particles *particles);

/** Room for `zero`. */
int particles_make_zero(Particles *particles, Error *error);

/** Displacement of a place as it is shown: from `zero` on. */
static inline double particles_moved(const Particles *particles, int k, int32_t place)
{
  return particles->zero[k] ? particles->displacement[k][place] - particles->zero[k][place]
                            : particles->displacement[k][place];
}

/** Rows of positions, motion, forces of loads, volumes and densities. */
void particles_state(Particles *particles, StateList *list);

/** Largest extent of the present particles: low and high corner of their centres. */
void particles_bounds(const Particles *particles, double low[3], double high[3]);

/** Reference distance of two places. */
double particles_distance(const Particles *particles, int32_t a, int32_t b);

/** @return the place of the particle nearest to a point (the lowest number among equals), or -1 if there is none */
int32_t particles_nearest(const Particles *particles, const double point[3]);

#endif
