/* Solid shapes: boxes, cylinders, spheres, extruded polygons, their unions and differences. */
#ifndef BRECCIA_BODY_SHAPE_H
#define BRECCIA_BODY_SHAPE_H

#include "deck/section.h"

/** The brick that a particle of a lattice takes along x, y, z, and where in it the first particle of all stands. */
typedef struct UnitCell {
  double size[3], first[3];
} UnitCell;

typedef struct Box {
  SectionHead head;
  double from[3], to[3]; /* NaN when given by particles */
  int64_t particles[3];  /* -1 when given by corners */
  double first[3];       /* centre of the first particle */
} Box;

typedef struct Cylinder {
  SectionHead head;
  double from[3], to[3], radius;
} Cylinder;

typedef struct Sphere {
  SectionHead head;
  double centre[3], radius;
} Sphere;

typedef struct Polygon {
  SectionHead head;
  NumberList corners;
  double bottom, top;
} Polygon;

typedef struct Shape {
  SectionHead head;
  Box *box;
  Cylinder *cylinder;
  Sphere *sphere;
  Polygon *polygon;
  SectionList together, difference; /* of Shape */
} Shape;

extern const Section shape_section, box_section;

/** Corners of a box; `unit` is needed where it is given by numbers of particles. */
void box_corners(const Box *box, const UnitCell *unit, double low[3], double high[3]);

/** True if a point lies inside; a surface belongs to the shape within `tolerance`.
 *  @param[in] dimensions  further coordinates do not count */
bool shape_contains(const Shape *shape, const UnitCell *unit, int dimensions, const double point[3], double tolerance);

/** Whether it has a box that is given by numbers of particles, which has no size without a lattice. */
bool shape_counts_particles(const Shape *shape);

/** Corners of a box that holds the shape. */
void shape_bounds(const Shape *shape, const UnitCell *unit, double low[3], double high[3]);

/** True if a point of the plane lies inside a polygon of `count` corners, three numbers each, seen along z. */
bool polygon_contains(const double *corners, int count, double x, double y);

#endif
