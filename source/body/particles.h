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
#include "body/vector.h"
#include <stdint.h>

typedef struct Particles {
  int64_t count, places, slices;
  VectorSpace space; /* of motions: displacements, then rotations where there are any */
  double *position[3];
  /* Rotations are angles [rad] in the plane. In space they are rotation vectors from `orientation` on, which takes them in at the end of each
   * step, and velocities are angular velocities about the axes of space. */
  Vector displacement, velocity;
  Vector internal; /* force per volume from bonds, moment per volume */
  Vector external; /* force per volume from loads, moment per volume */
  double *zero[3]; /* displacements that are shown as none; NULL: 0 */
  double *volume;  /* 0 in unused places */
  double *density;
  double *
      free_strain; /* alike in all directions in which bonds lie, where nothing hinders it (domain/strains.c); NULL: none */
  const double *
      free_growth; /* while bonds break: by how much loads let free strains grow in the step; NULL: not at all. Not owned */
  double *rotary;         /* rotational inertia per volume; NULL without rotations */
  Vector inertia;         /* per volume: rows are `density` or `rotary`. Not owned */
  uint8_t *unturned;      /* [slices] of formulations without rotations, where others have them; NULL: none */
  double *orientation[4]; /* unit quaternions 1, x, y, z of places with rotations in space; else NULL */
  int32_t *number;        /* [places] global number or -1 */
  int32_t *place_of;      /* [count] place of a number */
  int32_t *block;         /* [slices] which block of the deck */
} Particles;

/** Zeroed array over places with the spare entries that Particles promises. Freed with places_free. */
double *places_array(int64_t places, const char *label, Error *error);
/** The same, and memory is taken only where something is written. */
double *places_reserved(int64_t places, const char *label, Error *error);
void places_free(double **array);

int particles_create(Particles *particles, int64_t slices, int64_t count, Error *error);
void particles_destroy(Particles *particles);

/** Gives all places rotations. Their inertia is 0 yet. @param[in] dimensions  of the body */
int particles_make_rotations(Particles *particles, int dimensions, Error *error);

/** Returns true if places have rotations. */
static inline bool particles_have_rotations(const Particles *p)
{
  return p->space.rotation < p->space.rows;
}

/** Returns true if a particle has a rotation. */
static inline bool particles_turn(const Particles *p, int64_t place)
{
  return particles_have_rotations(p) && !(p->unturned && p->unturned[place / SLICE]);
}

/** Strain at which a bond carries nothing: the mean of both ends'. */
static inline double particles_free_strain(const Particles *p, int64_t a, int64_t b)
{
  return p->free_strain ? 0.5 * (p->free_strain[a] + p->free_strain[b]) : 0;
}

/** At the end of a step that came out well: rotations in space of places first .. last - 1, whole slices, become part of their orientation. */
void particles_take_rotations(Particles *particles, int64_t first, int64_t last);

/** Unit quaternion of a place in space, with the rotation since `orientation` as it stands in some displacements. */
static inline void particles_orientation(const Particles *p, double *const *displacement, int64_t place, double q[4])
{
  double turn[3], square = 0, o[4];
  for (int k = 0; k < 4; ++k) o[k] = p->orientation[k][place];
  for (int k = 0; k < 3; ++k) {
    turn[k] = displacement[p->space.rotation + k][place];
    square += turn[k] * turn[k];
  }
  /* (cosine, half of sine over the angle, times the vector) of half the angle */
  const double half = 0.5 * __builtin_sqrt(square), c = __builtin_cos(half),
               s = half > 1e-4 ? 0.5 * __builtin_sin(half) / half : 0.5 - half * half / 12;
  for (int k = 0; k < 3; ++k) turn[k] *= s;
  q[0] = c * o[0] - turn[0] * o[1] - turn[1] * o[2] - turn[2] * o[3];
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    q[1 + k] = c * o[1 + k] + turn[k] * o[0] + turn[l] * o[1 + m] - turn[m] * o[1 + l];
  }
}

/** Rotation vector of a place since the beginning, in space of at most half a turn; 0 without rotations. */
void particles_rotation(const Particles *particles, int32_t place, double rotation[3]);

/** Room for `zero`. */
int particles_make_zero(Particles *particles, Error *error);

/** Displacement of a place as it is shown: from `zero` on. */
static inline double particles_moved(const Particles *particles, int k, int32_t place)
{
  return particles->zero[k] ? particles->displacement.row[k][place] - particles->zero[k][place]
                            : particles->displacement.row[k][place];
}

/** Rows of positions, motion, forces of loads, volumes and densities. */
void particles_state(Particles *particles, StateList *list);
/** Adds the rows of a vector that belong to rotations; none without them. */
void particles_state_rotations(const char *name, const char *unit, StateRole role, const Vector *vector,
                               StateList *list);

/** Largest extent of the present particles: low and high corner of their centres. */
void particles_bounds(const Particles *particles, double low[3], double high[3]);

/** Reference distance of two places. */
double particles_distance(const Particles *particles, int32_t a, int32_t b);

/** @return the place of the particle nearest to a point (the lowest number among equals), or -1 if there is none */
int32_t particles_nearest(const Particles *particles, const double point[3]);

#endif
