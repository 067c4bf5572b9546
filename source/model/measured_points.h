/* Points that a laboratory measured: read from a file, and held against a test before anything is concluded from them. */
#ifndef BRECCIA_MODEL_MEASURED_POINTS_H
#define BRECCIA_MODEL_MEASURED_POINTS_H

#include "constitutive/element_test.h"

typedef struct MeasuredPoints {
  char *path;    /* owned */
  double *x, *y; /* [count] strains and stresses; owned */
  int *line;     /* [count] of the file; owned */
  int count;
} MeasuredPoints;

/** Reads the first two columns of a CSV file, strain and stress. Units in parentheses in its heading, like 'axial strain (%),deviator (kPa)', are
 *  obeyed; without them strains are plain numbers and stresses in the given units.
 *  @param[in] least  how many points there must be */
int measured_points_read(MeasuredPoints *points, const char *path, const Units *units, int least, Error *error);
void measured_points_destroy(MeasuredPoints *points);

/** Points and curve that lie on opposite sides of zero strain: one of them counts compression as positive. Nothing can be concluded then. */
int measured_points_opposed(const MeasuredPoints *points, const ElementCurve *curve, Error *error);

/** What looks like a mistake of unit, order or test when the points are held against a computed curve: one line each. */
void measured_points_doubt(const MeasuredPoints *points, const ElementTest *test, const ElementCurve *curve,
                           const Units *units, Error *doubts);

#endif
