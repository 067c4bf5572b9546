/* A test on one material point, from its file or from words: what the files of this room that offer it to programs share. */
#ifndef BRECCIA_MODEL_LABORATORY_H
#define BRECCIA_MODEL_LABORATORY_H

#include "model/measured_points.h"
#include "model/parameter_fit.h"

struct breccia_test {
  ElementDeck deck;  /* of a test in words: its units, law, material and test only */
  const char *where; /* for messages: the file */
  char *title;
  double *path;      /* [path_rows][6] strains, instead of a test; NULL: a test */
  double *path_time; /* [path_rows] NULL: all of it happens at once */
  int path_rows, elastic_rows;
  ElementCurve curve;
  MeasuredPoints points; /* last compared with, or fitted to */
  ParameterFit fit;
  Error *doubts;
  char **headings; /* [columns] */
  double **columns;
  int column_count;
  char unit[64]; /* of stresses */
  Text judgement;
  char parameter_unit[64];
};

/** A test without contents; NULL with a message when memory is out. */
breccia_test *laboratory_begin(Error *error);

/** Reads the strains of a path from a CSV file. */
int laboratory_read_path(breccia_test *test, const char *path, Error *error);

#endif
