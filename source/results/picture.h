/* Pictures of particles: flat bodies as filled squares, others as shaded spheres with a depth buffer. */
#ifndef BRECCIA_RESULTS_PICTURE_H
#define BRECCIA_RESULTS_PICTURE_H

#include "body/shape.h"
#include "deck/section.h"
#include "results/result_view.h"

typedef struct PictureSpec {
  SectionHead head;
  const char *field, *component, *curve, *title, *x_label, *y_label, *name;
  int bars, log_axes; /* indices of bar_column_name (-1: none) and of picture_log_axes */
  NumberList times;
  TextList of_bars;
  double deformed, view[3], range[3]; /* view: azimuth and elevation; range: lowest and highest value */
  Shape *inside;                      /* or NULL: the whole body */
  bool broken_bonds, same_range, energy, over_length;
} PictureSpec;

extern const Section picture_section;

/** Words of `log axes`, NULL after the last. */
const char *picture_log_axes(int k);

typedef struct PictureOptions {
  const char *field, *component; /* component NULL: the only one, or the length of a vector */
  const char *bars;              /* a column of theirs instead (bar_columns.h), over a pale body; NULL: a field */
  const char *title, *x_label, *y_label; /* NULL: the deck's title; the coordinates */
  double deformed;                       /* scale of displacements */
  double azimuth, elevation;             /* degrees; NaN: chosen from the body's shape */
  const Shape *inside;                   /* only particles that stand in it, undeformed; NULL: all */
  double low, high;                      /* ends of the colour scale; NaN: from the data */
  bool broken_bonds;
  bool one_of_many; /* a frame of a movie: times with all their digits, all frames of one size */
  double size;      /* largest width of the drawing in pixels; 0: 640, of bodies in space 460 */
} PictureOptions;

/** What pictures of several steps have in common. */
typedef struct PictureSurvey {
  double least, most;    /* of the field; least > most: no number at all */
  double x0, x1, y0, y1; /* of the body on the plane of the picture; NaN: each step its own */
} PictureSurvey;

/** Looks through the steps `first` to `last`: the range of the field and, if `framing`, the room that the body takes. */
int picture_survey(const ResultView *view, int first, int last, bool framing, const PictureOptions *options,
                   PictureSurvey *survey, Error *error);

/** Draws one step of a result file to a .png, .svg or .pdf file, whole or not at all. */
int picture_draw(const ResultView *view, int step, const PictureOptions *options, const PictureSurvey *survey,
                 const char *path, Error *error);

/** Draws one step into memory: rows of `*wide` pixels of four bytes (blue, green, red, unused), to be freed. */
unsigned char *picture_pixels(const ResultView *view, int step, const PictureOptions *options,
                              const PictureSurvey *survey, int *wide, int *high, Error *error);

/** True if the ending of a file name is one that can be drawn to. */
bool picture_format(const char *path);

/** Whether a step is a mode of vibration. */
bool picture_of_mode(const ResultView *view, int step);

/** The time of a step in a unit that suits all times of the file: "79.2 ms"; with `all_digits` as many as every other step has. Of a mode its number and
 *  frequency: "mode 2, 45.6 Hz". */
void picture_time(const ResultView *view, int step, bool all_digits, char *words, size_t size);

/** A short file name without ending: the field, and of several times the time: "damage-79.2ms", or "displacement-mode-2". */
void picture_name(const ResultView *view, int step, const char *field, const char *component, bool with_time,
                  char *name, size_t size);

#endif
