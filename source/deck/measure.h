/* A number that carries its own unit: what expressions reckon with, before anybody knows for which key. */
#ifndef BRECCIA_DECK_MEASURE_H
#define BRECCIA_DECK_MEASURE_H

#include "deck/quantity.h"

enum { MEASURE_LENGTH, MEASURE_FORCE, MEASURE_TIME, MEASURE_ANGLE, MEASURE_POWERS };

typedef struct Measure {
  double value;                 /* in m, N, s, radians and what follows from them */
  double power[MEASURE_POWERS]; /* of length, force, time, angle; all 0: a plain number, whose unit its key will give */
  bool cycles;                  /* a frequency, like Hz, and not a rate of 1/s */
} Measure;

bool measure_is_plain(const Measure *measure);
/** True if two may be added. */
bool measure_alike(const Measure *a, const Measure *b);

/** Measures one of a unit, like "kN/m2".
 *  @param[out] reason  why it is none, in words
 *  @return 0, or 1 */
int measure_unit(const Units *units, const char *words, Measure *measure, Text *reason);

/** Reads "30 kPa" or "30" whatever its dimension. @return 0; 1 if it is no number with a known unit, with the reason */
int measure_read(const Units *units, const char *words, Measure *measure, Text *reason);

/** Writes it as it may stand in a deck, with 15 digits: "0.25 m".
 *  @return 0; 1 with the reason if no unit has its powers or it is not finite */
int measure_write(const Measure *measure, Text *words, Text *reason);

/** What it is, with its article: "a length", "a plain number", "a quantity in N2/m". */
void measure_describe(const Measure *measure, Text *words);

/** Adds what a quantity has more or less than one of another dimension, if that is a power of one dimension with a
 *  name: "; a length is left over", "; a time is missing". */
void measure_describe_difference(const Measure *given, const Measure *wanted, Text *words);

#endif
