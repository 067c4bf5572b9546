/* Columns of numbers from CSV files: comments (#) and a heading first, then rows. */
#ifndef BRECCIA_BASE_CSV_H
#define BRECCIA_BASE_CSV_H

#include "base/error.h"

typedef enum CsvState {
  CSV_FINISHED, /* somebody's file: its last row may lack the line's end */
  CSV_LIVING,   /* a run may be writing it or may have been killed: a last row without a line's end is left out */
} CsvState;

/** A column by name (a unit in parentheses after it need not be given); cells that are no number become NaN.
 *  @param[out] count  rows
 *  @param[out] label  the column's whole heading, 128 bytes; may be NULL
 *  @return its values, to be freed, or NULL with a message */
double *csv_column(const char *path, const char *column, CsvState state, int *count, char *label, Error *error);

/** A column of words: blanks and quotation marks around them do not count. */
typedef struct CsvWords {
  char **cells; /* [count]; "" where a row has none */
  int count;
  char *text; /* what they point into */
} CsvWords;

/** @return 0 (cells is NULL if the file has no such column), BRECCIA_USER_ERROR if it cannot be read, BRECCIA_FAILURE */
int csv_words(CsvWords *words, const char *path, const char *column, Error *error);
void csv_words_destroy(CsvWords *words);

#endif
