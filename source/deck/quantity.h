/* Numbers with units, where a deck is read: "30 kPa" becomes a number in the deck's own units, and nothing past the deck knows. */
#ifndef BRECCIA_DECK_QUANTITY_H
#define BRECCIA_DECK_QUANTITY_H

#include "base/error.h"
#include "base/text.h"

/** A physical dimension as powers of length, force and time. */
typedef struct Dimension {
  const char *name;
  int length, force, time;
  const char *example; /* a unit that an engineer would write */
} Dimension;

/** @return the dimension called so, or NULL */
const Dimension *dimension_find(const char *name);
/** All dimensions, ending in one whose name is NULL. */
const Dimension *dimension_list(void);

typedef struct Units Units;

/* What plain numbers mean where no units are named: in decks, in files of tests, on the command line and to servers. */
#define UNITS_LENGTH "m"
#define UNITS_FORCE "N"
#define UNITS_TIME "s"
#define UNITS_WORDS UNITS_LENGTH ", " UNITS_FORCE ", " UNITS_TIME

/** Units with which plain numbers of a deck are read.
 *  @param[in] length, force, time  unit names, like "m", "kN", "s" */
Units *units_create(const char *length, const char *force, const char *time, Error *error);
void units_destroy(Units **units);

/** The deck's unit for a dimension in words, like "kN/m2"; "" for a plain number. */
void units_name(const Units *units, const Dimension *dimension, char *name, size_t size);

/** A value of the deck's units in m, N, s and what follows from them. */
double units_in_si(const Units *units, const Dimension *dimension, double value);

/** Adds a number of an SI unit as people say it, with a prefix: 2e-5 s is "20 µs", 0.031 m "31 mm", 2400 kg "2.4 t". */
void quantity_describe(double value, const char *unit, Text *text);

/** Reads "30 kPa" or "30".
 *  @param[out] reason  what is wrong, in words that can follow "file:line:column: key: "
 *  @return 0 and the value in the deck's units, or 1 */
int units_read(const Units *units, const Dimension *dimension, const char *words, double *value, Text *reason);

#endif
