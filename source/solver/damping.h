/* How decks say mass-proportional damping. */
#ifndef BRECCIA_SOLVER_DAMPING_H
#define BRECCIA_SOLVER_DAMPING_H

#include "deck/section.h"

extern const Section damping_section;

/** The rate c of a number or a section [1/time]. */
double damping_rate(const NumberOrSection *given);

#endif
