/* Expressions of the coordinates x, y and z: values that differ from place to place. */
#ifndef BRECCIA_DECK_COORDINATES_H
#define BRECCIA_DECK_COORDINATES_H

#include "deck/measure.h"
#include "deck/quantity.h"

/** Evaluates an expression at a position. A plain number counts in the units of the deck.
 *  @param[in] position   [length]
 *  @param[in] dimension  expected of the value
 *  @param[out] value     in the units of the deck
 *  @param[out] reason    what is wrong, in words that can follow a place
 *  @return 0, or 1 after a reason */
int coordinates_evaluate(const char *words, const Units *units, const double position[3], const Dimension *dimension,
                         double *value, Text *reason);

#endif
