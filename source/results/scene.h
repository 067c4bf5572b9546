/* A body as a picture shows it: where its particles lie on the plane of the picture, their colours, and the page around them.
 * Inside of the pictures only. */
#ifndef BRECCIA_RESULTS_SCENE_H
#define BRECCIA_RESULTS_SCENE_H

#include "results/bar_view.h"
#include "results/display_unit.h"
#include "results/picture.h"
#include "results/scale.h"
#include <cairo.h>

/** Bars over the body; without lines: none. */
typedef struct SceneBars {
  BarView view;
  double *x, *y, *depth; /* of nodes, as of particles */
  double *value;         /* of elements */
  bool *hidden;          /* elements that are not asked for */
  double near;           /* depths that differ by less count as one */
} SceneBars;

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
  SceneBars bars;        /* colours are theirs then, and the body is pale */
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

/** Colour of a value; grey where it is no number. */
void scene_colour(const Scene *scene, double value, double rgb[3]);

Page page_lay_out(const Scene *scene, const ResultView *view, int step, const PictureOptions *options);
/** Words, axes, colour bar: all but the particles. */
void page_draw(cairo_t *cr, const Page *page, const Scene *scene, const PictureOptions *options);

/* picture_bars.c: nothing where no bars are asked for. */

/** Takes up the bars of the results. @return status */
int scene_bars_create(Scene *scene, const ResultView *view, const PictureOptions *options, Error *error);
void scene_bars_destroy(Scene *scene);
/** What their colours stand for at a step. @param[out] unit  64 bytes @return status */
int scene_bars_read(Scene *scene, const ResultView *view, int step, const PictureOptions *options, char *unit,
                    Error *error);
/** Takes their values into a range. */
void scene_bars_survey(const Scene *scene, PictureSurvey *survey);
/** Puts them on the plane of the picture, and makes what it shows reach around them. @return status */
int scene_bars_place(Scene *scene, const ResultView *view, int step, double deformed, Error *error);
/** @return 0, or 1 when memory is out */
int scene_bars_draw(cairo_t *cr, const Page *page, const Scene *scene);

/** The particles, bars, and bonds that broke if they are wanted. @return 0, or 1 when memory is out */
int body_draw(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view, int step,
              const PictureOptions *options);

#endif
