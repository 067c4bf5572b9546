/* Loads that grow slowly beside the body's slowest vibration, whose damping the stage chooses, and what is told of the body in the end (Tuniki 2012). */
#ifndef BRECCIA_SOLVER_QUASI_STATIC_H
#define BRECCIA_SOLVER_QUASI_STATIC_H

#include "solver/rest.h"
#include "solver/solver.h"

typedef struct QuasiStaticSpec {
  SectionHead head;
  double ramp, hold; /* in periods */
  double longest;    /* hold of a body that still comes to rest, in periods; NaN: longest_holds times `hold` */
  double ratio;      /* of critical damping */
  double period;     /* NaN: found */
  double steady;
} QuasiStaticSpec;

extern const Section quasi_static_section;

/** Rate of damping in proportion to mass. */
double quasi_static_damping(const QuasiStaticSpec *spec, double period);

/** Largest hold of a stage, in periods. */
double quasi_static_longest(const QuasiStaticSpec *spec);

/** Share of its load by which a single vibration with this period is out of balance at the end of a hold, or its
 * kinetic energy's of the work, whichever is more: a body that bears its loads is no nearer to rest. @param[in] hold in
 * periods */
double quasi_static_left(const QuasiStaticSpec *spec, double hold);

/** What a stage does after a step at which it was looked at. */
typedef enum QuasiStaticNext { QUASI_STATIC_GOES_ON, QUASI_STATIC_HOLDS_LONGER, QUASI_STATIC_ENDS } QuasiStaticNext;

/** Returns true if the body is to be looked at after a step: each half of the hold, each half period of it, and at the
 * end.
 *  @param[in] last  the step ends the stage */
bool quasi_static_is_due(const Solver *run, const QuasiStaticSpec *spec, double period, bool last);
/** Notes how far the body is from rest, and whether it bears the loads of the stage under way. A body that clearly
 * fails ends the stage early; one that still comes to rest when the hold is over is held longer. */
QuasiStaticNext quasi_static_look(Solver *run, const QuasiStaticSpec *spec, double period, const Rest *rest, bool last);

/** Whether a body that counts as failed was still coming to rest at the end: a longer hold may find that it bears its loads. */
bool quasi_static_still_settles(const StageRecord *record);
/** What was noted of a stage, in a word: steady, failed, not told. */
const char *quasi_static_verdict(const StageRecord *record);
/** The same in a sentence. */
void quasi_static_tell(const StageRecord *record, double limit, Text *text);

#endif
