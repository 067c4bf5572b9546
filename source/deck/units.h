/* What the files that reckon with units share; only they know UDUNITS-2. */
#ifndef BRECCIA_DECK_UNITS_H
#define BRECCIA_DECK_UNITS_H

#include "deck/quantity.h"
#include <udunits2.h>

/** Lets one thread at a time into UDUNITS-2, which is not safe for threads. A thread that holds the lock may take it
 * again. */
void units_lock(void);
void units_unlock(void);

/** The units that most decks use. @return to be freed with ut_free_system; NULL without memory */
ut_system *unit_system_usual(void);
/** The words that it knows. @return NULL behind the last one */
const char *unit_usual(size_t k);

/** All units of the library's database, and ours. @return the same; NULL after saying why there are none */
ut_system *unit_system_whole(Text *reason);

/** A unit from words, strictly: of the usual system, if that knows it, else of the whole one. To be freed with ut_free; NULL after saying why it is none. */
ut_unit *units_parse(const Units *units, const char *words, Text *reason);

/** True if a unit counts cycles, like Hz: a rate of 1/s is something else, though their dimensions are the same. */
bool units_count_cycles(const char *unit);

#endif
