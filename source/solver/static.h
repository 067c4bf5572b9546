/* Statics, inside of this room: one file for the keys and words (static.c), one for increments and the tries that make them (static_step.c), one for what an
 * increment leads to besides and must be in balance with (static_settle.c). */
#ifndef BRECCIA_SOLVER_STATIC_H
#define BRECCIA_SOLVER_STATIC_H

#include "solver/increment.h"
#include "solver/newton_descent.h"
#include "solver/pressing.h"
#include "solver/relaxation.h"

#include <stdbool.h>
#include <string.h>

typedef enum StaticMethod { METHOD_NEWTON, METHOD_RELAXATION } StaticMethod;
typedef enum NoEquilibrium { NO_EQUILIBRIUM_STOPS, NO_EQUILIBRIUM_GOES_ON } NoEquilibrium;

typedef struct StaticSpec {
  SectionHead head;
  double end_time, smallest;
  int64_t increments, bonds_at_once, relaxation_iterations;
  int method, no_equilibrium; /* StaticMethod, NoEquilibrium */
  const ControlSpec *control;
  NewtonSpec newton;
} StaticSpec;

/** Whether the next stage goes on where no equilibrium is found. */
static inline bool static_hands_over(const StaticSpec *spec)
{
  return spec->no_equilibrium == NO_EQUILIBRIUM_GOES_ON;
}

/** From equilibrium at the begin of an increment, or with bonds that have broken in it, to the one that was found last: works are those between these
 *  two, whatever was tried on the way. */
typedef struct Way {
  Vector moved; /* made where an increment is solved again; else what Newton's method has moved is all */
  double bonds, given_off, sudden; /* works booked of it */
} Way;

/** Maximum number of listed ranges of increments. */
enum { JUMP_RANGES = 6 };

/** Increments of a stage in which the body jumped: descent by secants or dynamic relaxation found their equilibrium. */
typedef struct Jumps {
  int64_t ranges, omitted;                       /* number of listed ranges; number of increments beyond them */
  int64_t first[JUMP_RANGES], last[JUMP_RANGES]; /* numbers of increments of each range */
  /** The last jump at whose beginning a load or support had its largest force so far: number of the increment (0:
   *  none), index of the load, times of the beginning and of the end of the increment. */
  int64_t peak_step, peak_load;
  double peak_begin, peak_end;
} Jumps;

typedef struct Static {
  Domain *domain;
  const Loading *loading;
  const StaticSpec *spec;
  Clock *clock;
  Ledger *ledger;
  Newton newton;
  Descent descent; /* these two are made when the first try asks for them */
  Relaxation relaxation;
  Control control;
  Increment increment;
  Pressing pressing;
  StateCopy
      whole; /* the state at the begin of the increment, where what follows from it may leave no equilibrium near; else empty */
  Way way;
  double next;  /* length of the increment to be tried next */
  int64_t cuts; /* in the stage */
  int64_t descended,
      relaxed; /* increments in which descent by secants, and dynamic relaxation found what Newton's method did not */
  Jumps jumps;
  /** True if all shorter attempts of the increment found no equilibrium: a long attempt is accepted although the body
   *  softens within it. */
  bool takes_coarse;
  double begin; /* time at which the increment under way begins */
  /** Sum over the tries of the increment of the largest displacement in each [length]. */
  double travelled;
  double
      lag; /* forces out of balance over the reference, with what the last increment that was given back had led to */
} Static;

/** Length of an increment as asked for. */
double static_whole_increment(const StaticSpec *spec);
/** Foresees how many increments there will be. */
void static_count_steps(const Solver *solver);

int static_advance(Solver *solver, Text *warning, Error *error);

/** By the method of the stage, or by another one, whatever that is. */
typedef enum TryBy { BY_METHOD, BY_SECANTS, BY_RELAXATION } TryBy;

/** How a try to come to equilibrium goes. */
typedef struct Try {
  bool again; /* on with the way of the try before, which came to equilibrium at the same time */
  TryBy by;
} Try;

/** One try to come to equilibrium at a time of the run; if there is none the state is that before the try. */
NewtonOutcome static_try(Static *s, double end, Try how, Error *error);

/** Whether other ways may be tried where Newton's method finds no equilibrium. */
bool static_may_relax(const Static *s);
/** Tries of an increment by these: where bonds soften relaxation first, which takes a fifth of the time of secants there; where points do it may not come to
 *  rest, and secants go first.
 *  @param[in] outcome  of Newton's method; @param[in,out] may_relax  until that was tried in vain; @param[in,out] way  raised to what found equilibrium */
NewtonOutcome static_try_others(Static *s, NewtonOutcome outcome, double end, bool *may_relax, TryBy *way,
                                Error *error);

/** Whether an increment may be solved again with what has come of it, and be given back when it has been accepted. */
bool static_may_go_on_again(const Static *s);
/** Notes the whole state, if it may be wanted back when an increment has been accepted. */
int static_keep(Solver *solver, Error *error);
/** The state as it was noted. */
int static_give_back(Solver *solver, Error *error);

/** Returns true if the stage determines a factor of safety: the stage is the last one, a strength reduction has grown
 *  since its beginning, and no other load has changed. The loss of equilibrium is then the result, not a failure.
 *  @param[in] end  time of the increment */
bool static_finds_reduction(const Solver *solver, double end);
/** Returns true if nothing but strength reductions changes in the increment under way, and these grow. The body is then
 *  judged by static_slides. @param[in] end  time of the increment */
bool static_only_reduces(const Static *s, double end);
/** Returns true if an increment that only divides strengths further ended in an equilibrium that the body cannot have:
 *  ground that slides may find rest with particles turned inside out, far away.
 *  @param[in] end  time of the increment */
bool static_is_impossible(const Static *s, double end);
/** Returns true if a load reduces strengths, so that an increment may be given back because the body slides. */
bool static_may_slide(const Static *s);
/** Records the elastic displacement of the body (StageRecord) in the first increment of a stage. */
void static_begin_reduction(Solver *solver);
/** Adds the largest displacement of the last try. */
void static_note_motion(Static *s);
/** Returns true if the body has moved in the increment as no body at rest does. */
bool static_slides(const Solver *solver);

/** Equilibrium with what has come of the increment: bonds that it has overloaded, and what forces are found with as the step before left it, like
 *  the control of zero-energy modes that fades in correspondence. Where increments are few, what that holds besides would be spent as fracture energy.
 *  @param[out] outcome  why there is no equilibrium with the bonds that are left
 *  @param[out] settled  false: there is none with the control as far as it has faded, and the increment is to be given back
 *  @param[in,out] way  the last that was asked: secants before dynamic relaxation */
int static_settle(Solver *solver, NewtonOutcome *outcome, bool *settled, TryBy *way, Error *error);

#endif
