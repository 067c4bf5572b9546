/* Forces per area on faces of lattices. */
#ifndef BRECCIA_LOADING_FACE_H
#define BRECCIA_LOADING_FACE_H

#include "loading/load.h"

typedef struct Face {
  int axis;
  double outwards;   /* 1 or -1: the normal along the axis */
  double *per_depth; /* [slices] what turns a force per area into one per volume: 1 / depth of the layers */
  /* On which particles forces of the face act, once they are spread. */
  int64_t count;
  int32_t *place, *at; /* [count] at: which of the load's particles stands over it at the face */
  double *per_volume;  /* [count] force per volume by a force of 1 per area */
  bool scattered;      /* particles from a file: each entry takes the forces of all columns; `at` is its own index */
  double plane;        /* coordinate of the face along its axis, if `scattered` */
} Face;

/** Finds the face on which a load acts; with `area` of the deck that is shared among all its particles. @param[out] face  to be freed with
 *  face_destroy */
int face_create(Face *face, const Load *load, const LoadMaking *making);
/** Spreads it over the particles on which forces act: those of the load, or as the bonds would that the face has cut off (docs/theory.md 5.5), with
 *  those behind them, which become the load's `other`. */
int face_spread(Face *face, Load *load, const LoadMaking *making);
/** Spreads the forces on a plane face of particles from a file, so that resultant force and moment are exact
 *  (face_scattered.c). The deck gives the area of the face.
 *  @param[out] done  false: the face is not a plane of one block from a file, or the area does not fit the face */
int face_spread_scattered(Face *face, Load *load, const LoadMaking *making, bool *done);
/** Scales what columns take that stand for other areas than their own, near corners, so that the force of an uneven load in all is the one over the face.
 *  @param[in] value  [particles of the load] force per area */
int face_balance(Face *face, const Load *load, const Particles *particles, const double *value, Error *error);
void face_destroy(Face *face);

/** Area of the face; with `value`, [particles of the load] force per area, the force on it. */
double face_area(const Face *face, const Load *load, const Particles *particles);
double face_force(const Face *face, const Load *load, const Particles *particles, const double *value);

/** Adds a force per area to the external forces, by all threads. */
void face_push(const Face *face, Particles *particles, const double traction[3]);

#endif
