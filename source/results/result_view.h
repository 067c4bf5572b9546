/* Result files read back, for pictures and for runs that are taken up again. Particles are those of the body: layers that supports put outside
 * it are left out, and the others counted without them. */
#ifndef BRECCIA_RESULTS_RESULT_VIEW_H
#define BRECCIA_RESULTS_RESULT_VIEW_H

#include "base/error.h"
#include "base/text.h"
#include "body/lattice.h"
#include "results/hdf5_file.h"
#include <stdint.h>

enum { MOST_LATTICES = 32 };

typedef struct ResultView {
  Hdf5File file;           /* stays where it is while it is open */
  int64_t particles, rows; /* of the body; of the file, with those outside it */
  int64_t *row_of;         /* [particles] in the file; NULL: all rows are of the body */
  int steps;
  int64_t *step_numbers;
  double *times, *positions; /* [particles][3] */
  double spacing;
  double *spacings; /* [particles] */
  int64_t *broken;  /* [broken_count][3]: step, and both particles, of bonds of the body as they broke */
  int64_t broken_count;
  double *frequencies; /* [frequency_count] Hz: the steps are modes of vibration; NULL: states of a run */
  int64_t frequency_count;
  uint8_t *lattice_numbers; /* [particles] of lattice_types */
  const LatticeType *lattice_types[MOST_LATTICES];
  bool plane;
  char title[256], length_unit[64], time_unit[64];
} ResultView;

/** Returns the path of a result file, given as a file or as its folder; owned by the caller. NULL: out of memory. */
char *result_view_path(const char *result);
/** @return BRECCIA_OK; BRECCIA_USER_ERROR after a line that tells what of the file is missing or damaged, BRECCIA_FAILURE where the disk fails */
int result_view_open(ResultView *view, const char *path, Error *error);
/** Reads every dataset once. @return as above, after a line that names one that is not as it was written */
int result_view_verify(const ResultView *view, const char *path, Error *error);
void result_view_close(ResultView *view);
/** The file is ours, but what stands in it is not what was written, or the disk does not let it be read.
 *  @param[in] what  of the file @return status, as result_view_lost() */
int result_view_say_damaged(const ResultView *view, const char *what, Error *error);
/** The status where something of the file could not be had, which was said. */
int result_view_lost(const ResultView *view);

/** The written step nearest to a time; -1: the run did not write so early or so late, by more than roundings. */
int result_view_nearest(const ResultView *view, double time);
/** The lattice that a particle stands on. */
const LatticeType *result_view_lattice(const ResultView *view, int64_t particle);
/** Names of the fields, comma separated. */
void result_view_fields(const ResultView *view, Text *names);
/** Whether the file holds a field of this name, be it damaged. */
bool result_view_has(const ResultView *view, const char *field);
/** Reads an attribute of a dataset as text; "" if there is none. */
void result_view_words(const ResultView *view, const char *dataset, const char *attribute, char *words, size_t size);
/** One step of a field: [particles][components], to be freed; NULL with a message if there is no such field or it is damaged.
 *  @param[out] unit  64 bytes */
double *result_view_read(const ResultView *view, const char *field, int step, int *components, char *unit,
                         Error *error);
/** All numbers of a dataset, to be freed; NULL after a line as above. @param[out] rows  how many it has; may be NULL */
void *result_view_numbers(const ResultView *view, const char *name, hid_t type, size_t size, int64_t *rows,
                          Error *error);
/** Numbers of one step in a dataset that has `rows` of them at each step: [rows][components], to be freed; NULL after a line as above.
 *  @param[out] unit  64 bytes, or NULL */
double *result_view_state(const ResultView *view, const char *name, int step, int64_t rows, int components, char *unit,
                          Error *error);
/** Pairs of numbers of the bonds broken up to a step: [count][2], to be freed; NULL: out of memory. */
int64_t *result_view_broken(const ResultView *view, int step, int64_t *count);

#endif
