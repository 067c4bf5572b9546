/* What the files that reckon with units share; only they know UDUNITS-2. */
#ifndef BRECCIA_DECK_UNITS_H
#define BRECCIA_DECK_UNITS_H

#include "deck/quantity.h"
#include <udunits2.h>

/** A unit from words, strictly. To be freed with ut_free; NULL after saying why it is none. */
ut_unit *units_parse(const Units *units, const char *words, Text *reason);

/** True if a unit counts cycles, like Hz: a rate of 1/s is something else, though their dimensions are the same. */
bool units_count_cycles(const char *unit);

#endif
