/* Bonds near interfaces of elastic materials (docs/theory.md 1, "Interfaces of two materials").
 *
 * A bond that passes through several materials consists of pieces in series: with the shares a_k of its length, it has
 * the stiffness h of 1 / h = sum a_k / c_k. A strain across an interface and a shear along it are then in equilibrium.
 * In a strain along the interface these bonds carry too much on the softer side and too little on the stiffer side.
 * Bonds along the interface within one horizon of it, which carry nothing in the other two states, make up for the
 * difference in each particle. Bonds keep the mean of both ends' stiffness if a law on their way is not linear. */
#ifndef BRECCIA_FORMULATION_INTERFACE_H
#define BRECCIA_FORMULATION_INTERFACE_H

#include "formulation/formulation.h"

/** Bonds near interfaces. */
typedef struct Interfaces {
  FormulationParts parts;
  const double *modulus; /* [blocks] modulus of bonds inside a block; borrowed */
  uint8_t *near;         /* [places] 1: the family has members of another stiffness */
  float **series;        /* [slices] h over the mean modulus of both ends, [slot from the slice's first one][8]; NULL:
                          * no place of the slice is near */
  float *all;            /* [count] which lie here */
  size_t count;
  double *radius;      /* [places] half of the spacing of the particles around a place, from its volume */
  double (*normal)[3]; /* [places] unit normal of the nearest interface; 0 where there is none */
} Interfaces;

/** Finds the bonds that pass through several materials and the normals of interfaces. Without interfaces of linear laws,
 *  or with a failure criterion, `series` stays NULL.
 *  @param[in] modulus  [blocks] */
int interfaces_create(Interfaces *interfaces, const FormulationParts *parts, const double *modulus, Error *error);
void interfaces_destroy(Interfaces *interfaces);

/** Returns true if bonds between two materials can be pieces in series: both laws are linear without a limit, and their
 *  moduli differ. */
bool interfaces_join(const Material *one, const Material *other);

/** Returns the stiffness of a bond over the mean of both ends' stiffness [-]. */
static inline double interfaces_series(const Interfaces *i, int64_t slice, int64_t slot, int lane)
{
  return i->series && i->series[slice] ? (double)i->series[slice][(slot - i->parts.family->first[slice]) * SLICE + lane]
                                       : 1;
}

/** Weight of a bond in a sum over a family, and share of what it carries in a bond inside the material of the place. */
typedef struct InterfaceShare {
  double weight, share;
} InterfaceShare;
typedef InterfaceShare InterfaceMeasure(const void *formulation, int64_t slice, int64_t slot, int lane,
                                        const Bond *bond);

/** Sum over a family in a strain along the interface without stress across it. */
typedef struct InterfaceSum {
  InterfaceMeasure *measure;
  const void *formulation;
  int power;      /* of elongations: 2 for energies, 1 for dilatations */
  double poisson; /* contraction across the interface over the strain along it; NAN: as the bonds of the family have */
} InterfaceSum;

/** Returns what is missing in the sum of a place, over the part of bonds along the interface in it [-]; 0 far from
 *  interfaces and where no bonds lie along them. */
double interfaces_lack(const Interfaces *interfaces, int64_t place, const InterfaceSum *sum);

/** Returns true if interfaces cross rows of particles: at more than a tenth of the places that have a normal, no bond lies
 *  along the interface. */
bool interfaces_cross_rows(const Interfaces *interfaces);
/** Adds what `check` says of interfaces that cross rows. */
void interfaces_describe(Text *text);

/** Returns how far a bond lies along the interface of both of its ends: from 0 to 1. */
double interfaces_along(const Interfaces *interfaces, int64_t place, const Bond *bond);

#endif
