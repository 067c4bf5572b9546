/* Forces per area on faces of lattices. */
#ifndef BRECCIA_LOADING_FACE_H
#define BRECCIA_LOADING_FACE_H

#include "loading/load.h"

typedef struct Face {
  int axis;
  double outwards;   /* 1 or -1: the normal along the axis */
  double *per_depth; /* [slices] what turns a force per area into one per volume: 1 / depth of the layers */
} Face;

/** Finds the face on which a load acts; with `area` of the deck that is shared among all its particles. @param[out] face  to be freed with
 *  face_destroy */
int face_create(Face *face, const Load *load, const LoadMaking *making);
void face_destroy(Face *face);

/** Area of the face. */
double face_area(const Face *face, const Load *load, const Particles *particles);

/** Adds a force per area to the external forces of a load's particles, by all threads. */
void face_push(const Face *face, const Load *load, Particles *particles, const double traction[3]);

#endif
