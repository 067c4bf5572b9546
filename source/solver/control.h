/* Control of a body at rest by what it does: the common factor of some loads is found so that a measure of the displacements, like the opening of a
 * crack, grows as prescribed. The load may fall meanwhile, and what it acts on may go back: softening and snap-back can be followed as long as
 * the measure grows (de Borst 1987, Computers & Structures 25, 211-224: indirect displacement control).
 *
 * What is measured may be found, too: in each increment the bond that stretches the fastest, wherever a crack runs (after Chen and Schreyer 1990,
 * Computer Methods in Applied Mechanics and Engineering 90, 869-884, who take elements); or the way that the body went last, by a length of it (arc
 * length, on the plane across that way: Ramm 1981, Nonlinear Finite Element Analysis in Structural Mechanics, 63-89). */
#ifndef BRECCIA_SOLVER_CONTROL_H
#define BRECCIA_SOLVER_CONTROL_H

#include "base/state.h"
#include "body/selection.h"
#include "solver/clock.h"
#include "solver/unknowns.h"

typedef struct ControlSpec {
  SectionHead head;
  NumberList opening;
  Reference displacement, bond, path;
  const Node *end;
  double direction[3], to; /* to: from `end` */
} ControlSpec;

extern const Section control_section;

/** A weighted sum of displacements. */
typedef struct Control {
  const ControlSpec *spec;
  const Domain *domain;
  const DeckReader *reader;
  int32_t *places;   /* [count]; owned */
  double *weight[3]; /* [count]; owned; zeros as long as it is to be found */
  int64_t count;
  uint8_t *belongs; /* [places] whose bonds are looked at; owned; NULL: another measure */
  double from;      /* value at the begin of the stage */
  double step;      /* by how much it changes in the increment */
  bool open;        /* what is measured is yet to be found in the increment; while bonds break in it, it stays */
  int64_t on_way;   /* increments that the path has taken */
  double exerted,
      exerted_most; /* by the controlled loads, with a crack that is followed by its stretch: now, and the most so far */
} Control;

/** @param[in] spec  NULL: no control; `control` is zero then. Destroy it in any case. */
int control_create(Control *control, const ControlSpec *spec, const Domain *domain, const DeckReader *reader,
                   const SectionList *selections);
void control_destroy(Control *control);

/** Mistakes of the loads that act in the stage under way: none to be found, or one that cannot be. */
int control_check(const ControlSpec *spec, const Loading *loading, const DeckReader *reader, Error *error);

/** The stage begins: values are told from those of now. */
void control_begin(Control *control);
/** What its value is to be after an increment; of one that is yet to be found, as if it was zero before.
 *  @param[in] before, after  parts of the stage that have gone at its begin and at its end */
double control_target(Control *control, double before, double after);
/** What is measured is yet to be found, where it is not given: as in an increment, before the first one. */
void control_open(Control *control);
/** Finds what is measured, if it is yet to be found.
 *  @param[in] motion  displacements where the factor of controlled loads grows by 1
 *  @return by how much the value, and so its target, is another now */
double control_aim(Control *control, const Vector *motion);

/** Says so where the controlled loads do not change what is measured. @param[in] motion  as above */
int control_check_answer(const Control *control, const Vector *motion, Error *error);

/** Its value at a vector over places. */
double control_value(const Control *control, double *const v[3]);

/** Its value as watched, from where displacements count as zero. */
double control_shown(const Control *control);

/** Adds to the factors of controlled loads in the stage under way. */
void control_add(const Loading *loading, double change);
/** The body is at rest: notes how far these have been, and the way of a path.
 *  @param[in] moved  changes of displacements in the increment */
void control_accept(Control *control, const Loading *loading, double *const moved[3]);

/** Notes what the controlled loads exert at the end of an increment. */
void control_note_exerted(Control *control, double force);
/** Whether a crack that is followed by its stretch has torn the body: next to nothing is left of what they exerted. */
bool control_is_spent(const Control *control);
/** That the stage ends because of this. */
void control_tell_torn(const Control *control, const Clock *clock, Text *warning);

/** Rows of what it keeps from one increment to the next. */
void control_state(Control *control, StateList *list);

#endif
