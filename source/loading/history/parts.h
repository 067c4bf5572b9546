/* Histories made of others. */
#ifndef BRECCIA_LOADING_HISTORY_PARTS_H
#define BRECCIA_LOADING_HISTORY_PARTS_H

#include "loading/history.h"

int parts_create(History *history, const DeckReader *reader);
/** The first corner of any of them. */
double parts_corner(const History *history, double time);
/** The longest rise of any of them. */
double parts_rise(const History *history);

#endif
