/* Bond between a bar and the concrete around it: stress on the surface of the bar by the slip, as decks have it and as it is asked
 * (docs/theory.md 7.2). */
#ifndef BRECCIA_BARS_BOND_LAW_H
#define BRECCIA_BARS_BOND_LAW_H

#include "deck/section.h"

typedef enum BarBond { BOND_OF_FIB, BOND_LINEAR } BarBond;
typedef enum BarCondition { CONDITION_GOOD, CONDITION_OTHER } BarCondition;
typedef enum BarConfinement { CONFINED_BY_NOTHING, CONFINED_BY_STIRRUPS } BarConfinement;

typedef struct BondSpec {
  SectionHead head;
  int law, condition, confinement; /* BarBond, BarCondition, BarConfinement */
  double stiffness, strength, rib_spacing, splitting, unloading;
} BondSpec;

extern const Section bond_section;

/** Constants of a law, in the units of the deck. */
typedef struct BondLaw {
  double stiffness; /* stress per slip where nothing slides */
  bool linear;      /* nothing ever slides */
  double peak, plateau_from, plateau_to,
      friction_from; /* the largest stress; slips where it begins, ends, and where friction is left */
  double friction, exponent;
} BondLaw;

/** What a piece of surface remembers. */
typedef struct BondState {
  double slip, stress;      /* as committed */
  double forward, backward; /* largest slips so far, from 0 up and down */
} BondState;

BondLaw bond_law(const BondSpec *spec, const Units *units);

/** Adds what it bears at which slips, as words without an end. */
void bond_law_describe(const BondLaw *law, const Units *units, Text *text);

/** Stress that a slip would reach from where nothing has slipped yet, without the rise of the unloading branch. @param[in] slip  not negative
 *  @param[out] slope  of it; NULL: not wanted */
double bond_law_envelope(const BondLaw *law, double slip, double *slope);

/** Stress at a slip, from a committed state. @param[in] elastic  nothing slides @param[out] slope  of it */
double bond_law_stress(const BondLaw *law, const BondState *from, double slip, bool elastic, double *slope);

#endif
