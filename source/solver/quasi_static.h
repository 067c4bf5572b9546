/* Loads that grow slowly beside the body's slowest vibration, whose damping the stage chooses, and what is told of the body in the end (Tuniki 2012). */
#ifndef BRECCIA_SOLVER_QUASI_STATIC_H
#define BRECCIA_SOLVER_QUASI_STATIC_H

#include "solver/rest.h"
#include "solver/solver.h"

typedef struct QuasiStaticSpec {
  SectionHead head;
  double ramp, hold; /* in periods */
  double ratio;      /* of critical damping */
  double period;     /* NaN: found */
  double steady;
} QuasiStaticSpec;

extern const Section quasi_static_section;

/** Rate of damping in proportion to mass. */
double quasi_static_damping(const QuasiStaticSpec *spec, double period);

/** Share of its load by which a single vibration with this period is out of balance at the end of the stage, or its kinetic energy's of the work, whichever
 *  is more: a body that bears its loads is no nearer to rest. */
double quasi_static_left(const QuasiStaticSpec *spec);

/** Time of the stage at which half of the hold is over. */
double quasi_static_midway(const QuasiStaticSpec *spec, double period);
/** Then: notes how far the body is from rest. */
void quasi_static_look(Solver *run, const Rest *rest);
/** Notes whether the body bears the loads of the stage under way, which ends with this question. */
void quasi_static_judge(Solver *run, const QuasiStaticSpec *spec, const Rest *rest);

/** Whether a body that counts as failed was still coming to rest at the end: a longer hold may find that it bears its loads. */
bool quasi_static_still_settles(const StageRecord *record);
/** What was noted of a stage, in a word: steady, failed, not told. */
const char *quasi_static_verdict(const StageRecord *record);
/** The same in a sentence. */
void quasi_static_tell(const StageRecord *record, double limit, Text *text);

#endif
