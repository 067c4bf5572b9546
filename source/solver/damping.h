/* How decks say mass-proportional damping. */
#ifndef BRECCIA_SOLVER_DAMPING_H
#define BRECCIA_SOLVER_DAMPING_H

#include "deck/section.h"

extern const Section damping_section;

/** Rayleigh damping by one ratio of critical damping at two frequencies. */
typedef struct RayleighSpec {
  SectionHead head;
  double ratio, from, to;
} RayleighSpec;
extern const Section rayleigh_section;

/** C = mass M + stiffness K0 [1/time, time]. */
typedef struct Rayleigh {
  double mass, stiffness;
} Rayleigh;
Rayleigh rayleigh_of(const RayleighSpec *spec);

/** The rate c of a number or a section [1/time]. */
double damping_rate(const NumberOrSection *given);

#endif
