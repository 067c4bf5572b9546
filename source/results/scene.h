/* A body as a picture shows it: where its particles lie on the plane of the picture, their colours, and the page around them.
 * Inside of the pictures only. */
#ifndef BRECCIA_RESULTS_SCENE_H
#define BRECCIA_RESULTS_SCENE_H

#include "results/display_unit.h"
#include "results/picture.h"
#include "results/scale.h"
#include <cairo.h>

typedef struct Scene {
  int64_t count;
  double *x, *y, *depth; /* on the picture plane, and towards the eye */
  double *value;         /* in the deck's unit */
  bool *hidden;          /* particles that are not asked for; they have no place on the plane */
  ColourRange range;
  DisplayUnit unit, length;
  char heading[160]; /* "Octahedral shear stress [kPa]" */
  double right[3], up[3], eye[3];
  bool flat;             /* seen along z: the axes of the picture are x and y */
  double x0, x1, y0, y1; /* what the picture shows, with half a spacing around the particles */
  int64_t outside;       /* particles beyond it */
  int64_t missing;       /* particles whose value is no number */
} Scene;

typedef struct Page {
  double width, height;         /* of the page in points */
  double left, top, wide, high; /* of the drawing */
  double scale;                 /* points per length */
  double thick;                 /* least height of a particle, for bodies that are a line */
  bool bar_below;               /* the colour bar lies under the drawing: wide bodies */
  char title[256], subtitle[320], notes[256];
} Page;

#define BALL 0.62 /* radius of a sphere in spacings: they overlap a little, without gaps along rows */

/** Colour of a particle; grey where its value is no number. */
void scene_colour(const Scene *scene, double value, double rgb[3]);

Page page_lay_out(const Scene *scene, const ResultView *view, int step, const PictureOptions *options);
/** Words, axes, colour bar: all but the particles. */
void page_draw(cairo_t *cr, const Page *page, const Scene *scene, const PictureOptions *options);

/** The particles, and bonds that broke if they are wanted. @return 0, or 1 when memory is out */
int body_draw(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view, int step,
              const PictureOptions *options);

#endif
