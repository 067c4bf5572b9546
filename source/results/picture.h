/* Pictures of particles: flat bodies as filled squares, others as shaded spheres with a depth buffer. */
#ifndef BRECCIA_RESULTS_PICTURE_H
#define BRECCIA_RESULTS_PICTURE_H

#include "deck/section.h"
#include "results/result_view.h"

typedef struct PictureSpec {
  SectionHead head;
  const char *field, *component, *curve;
  NumberList times;
  double deformed, view[3], range[3]; /* view: azimuth and elevation; range: lowest and highest value */
  bool broken_bonds;
} PictureSpec;

extern const Section picture_section;

typedef struct PictureOptions {
  const char *field, *component; /* component NULL: the only one, or the length of a vector */
  double deformed;               /* scale of displacements */
  double azimuth, elevation;     /* degrees; NaN: chosen from the body's shape */
  double low, high;              /* ends of the colour scale; NaN: from the data */
  bool broken_bonds;
  double size; /* largest width of the drawing in pixels; 0: 640 */
} PictureOptions;

/** Draws one step of a result file to a .png, .svg or .pdf file. */
int picture_draw(const ResultView *view, int step, const PictureOptions *options, const char *path, Error *error);

/** True if the ending of a file name is one that can be drawn to. */
bool picture_format(const char *path);

#endif
