/* Control of a body at rest by what it does: the common factor of some loads is found so that a measure of the displacements, like the opening of a
 * crack, grows as prescribed. The load may fall meanwhile, and what it acts on may go back: softening and snap-back can be followed as long as
 * the measure grows (de Borst 1987, Computers & Structures 25, 211-224: indirect displacement control). */
#ifndef BRECCIA_SOLVER_CONTROL_H
#define BRECCIA_SOLVER_CONTROL_H

#include "body/selection.h"
#include "solver/unknowns.h"

typedef struct ControlSpec {
  SectionHead head;
  NumberList opening;
  Reference displacement;
  double direction[3], to;
} ControlSpec;

extern const Section control_section;

/** A weighted sum of displacements. */
typedef struct Control {
  const ControlSpec *spec;
  int32_t *places;   /* [count]; owned */
  double *weight[3]; /* [count]; owned */
  int64_t count;
  double from; /* value at the begin of the stage */
} Control;

/** @param[in] spec  NULL: no control; `control` is zero then. Destroy it in any case. */
int control_create(Control *control, const ControlSpec *spec, const Domain *domain, const DeckReader *reader,
                   const SectionList *selections);
void control_destroy(Control *control);

/** Mistakes of the loads that act in the stage under way: none to be found, or one that cannot be. */
int control_check(const ControlSpec *spec, const Loading *loading, const DeckReader *reader, Error *error);

/** Its value at a vector over places. */
double control_value(const Control *control, double *const v[3]);

/** Its value as watched, from where displacements count as zero. */
double control_shown(const Control *control, const Particles *particles);

/** Adds to the factors of controlled loads in the stage under way. */
void control_add(const Loading *loading, double change);
/** Notes how far these have been: the body is at rest. */
void control_accept(const Loading *loading);

#endif
