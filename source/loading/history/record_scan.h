/* Reading of records as agencies write them: lines, numbers of Fortran in free or fixed columns, and units in words.
 * Fortran writes exponents as 1.00D-02, and as 1.0-100 where three digits leave no room for the letter; its fixed
 * columns touch each other where numbers fill them. Values come out in one unit for each quantity, whatever the unit
 * of the file: accelerations in g, velocities in cm/s, displacements in cm. */
#ifndef BRECCIA_LOADING_HISTORY_RECORD_SCAN_H
#define BRECCIA_LOADING_HISTORY_RECORD_SCAN_H

#include "loading/history/record.h"

typedef struct RecordText {
  const char *path;
  /* Lines without their ends [count]; owned, and the characters that they point into are the caller's. */
  char **lines;
  int count;
} RecordText;

/** Splits a text into its lines, in place.
 *  @return BRECCIA_OK, or BRECCIA_FAILURE without memory */
int record_split(RecordText *out, const char *path, char *text, Error *error);

/** Reads a number as C or Fortran writes it.
 *  @param[out] end  the character after the number; `from` if there is none
 *  @return the number, or NaN */
double record_number(const char *from, const char **end);

/** Returns true if a line holds numbers, parted by blanks or commas, and nothing else. */
bool record_all_numbers(const char *line);

/** Finds a word, whose case does not count and which no letter or digit touches.
 *  @return the character after it, or NULL */
const char *record_word(const char *line, const char *word);

/** A quantity of records, and the unit in which it comes out. */
typedef struct RecordQuantity {
  const char *name, *unit;
  double size; /* of the unit in m and s */
} RecordQuantity;

extern const RecordQuantity record_acceleration, record_velocity, record_displacement;

/** Reads a unit such as G, cm/sec/sec, CM/SEC**2 or gal.
 *  @param[out] quantity  the one that is measured in this unit
 *  @param[out] length  number of characters of the unit; may be NULL
 *  @return its size in the unit in which the quantity comes out; NaN if the words are no such unit */
double record_unit(const char *words, const RecordQuantity **quantity, int *length);

/** Writes the name of a quantity with its unit in parentheses. @param[out] label  RECORD_LABEL bytes; may be NULL */
void record_label(const RecordQuantity *quantity, char *label);

/** Values at equal steps from time 0 on. */
typedef struct RecordSeries {
  const RecordText *text;
  int first;     /* index of the line with the first value */
  double count;  /* of values, as the heading has it */
  int width;     /* of columns; 0: blanks or commas part the numbers */
  double step;   /* s */
  double factor; /* on each value */
  bool last;     /* nothing may follow the values */
} RecordSeries;

/** Reads the values of a series. Errors name the file, the line and what was expected.
 *  @param[in] units  in whose unit of time the times come out
 *  @return BRECCIA_OK, BRECCIA_USER_ERROR or BRECCIA_FAILURE */
int record_read_series(Record *record, const RecordSeries *series, const Units *units, Error *error);

/** Reads numbers of a header from lines of equal columns.
 *  @param[out] values  [count]
 *  @return false if a number is missing */
bool record_read_header(const RecordText *text, int first, int width, int per_line, double *values, int count);

#endif
