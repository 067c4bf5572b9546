/* What kinds of loads share. */
#ifndef BRECCIA_LOADING_LOAD_PARTS_H
#define BRECCIA_LOADING_LOAD_PARTS_H

#include "loading/load.h"

/** What a force comes to on the body, in all and in which direction. @param[in] along  of any length; 0: none to tell */
LoadWords load_force_in_all(double size, const double along[3]);

/** The vector of a value that is one. */
const double *load_point(const LoadValue *value);
/** Its length, without components that are free. */
double load_length(const LoadValue *value);

/** Adds uniform + density x per_density to the external forces per volume of its particles, by all threads. */
void load_push(const Load *load, Particles *particles, const double uniform[3], const double per_density[3]);

/** Prescribes a motion along a direction of any length. @param[in] order  0 displacement, 1 velocity, 2 acceleration */
void load_constrain(Load *load, const LoadMaking *making, const double direction[3], double value, int order);
/** Prescribes a rotation about an axis that `load_rotations` found: the k-th of them. */
void load_constrain_rotation(Load *load, const LoadMaking *making, int k, double value, int order);
/** Axes about which particles turn. @return how many */
int load_turning(const Particles *particles, int axis[3]);
/** The same, of those of the body of a load. @return how many; -1 after a message where there are none, or where its vector has a part about another */
int load_rotations(const Load *load, const LoadMaking *making, int axis[3]);
/** Prescribes the components of its vector that are not free as rotations. */
int load_constrain_rotations(Load *load, const LoadMaking *making, int order);
/** Prescribes the components of its vector that are not free. */
void load_constrain_axes(Load *load, const LoadMaking *making, int order);

#endif
