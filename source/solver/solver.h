/* What takes a body from one state to the next. A solver is a table entry; nobody outside of this room knows which one it is: they see the
 * clock, the ledger of energies and the rows of its state. */
#ifndef BRECCIA_SOLVER_SOLVER_H
#define BRECCIA_SOLVER_SOLVER_H

#include "loading/load.h"
#include "solver/ledger.h"

enum {
#define SOLVER(name, about) SOLVER_##name,
#include "solver/solvers.h"
#undef SOLVER
  SOLVERS
};

typedef enum StageLaws { LAWS_AS_GIVEN, LAWS_ELASTIC } StageLaws;
typedef enum StageDisplacements { DISPLACEMENTS_KEPT, DISPLACEMENTS_FROM_ZERO } StageDisplacements;

/** Keys of a stage of a run: its solver, its loads, the laws and the zero of displacements. */
typedef struct SolveSpec {
  SectionHead head;
  const char *name;
  int laws, displacements; /* StageLaws, StageDisplacements */
  SectionList loads;       /* loads that begin with the stage */
  TextList without;        /* names of loads that end when the stage begins */
  void *of[SOLVERS];       /* the section of the solver that is given; NULL: not this one */
} SolveSpec;

extern const Section solve_section;

typedef struct SolverType SolverType;
typedef struct Resultants Resultants; /* solver/resultants.h */

/** What a step takes, about. */
typedef struct StepCost {
  double evaluations, seconds; /* evaluations of forces, and what it takes beside them */
  double bytes;                /* beside the body and its formulations */
  bool least;                  /* how much more nothing tells beforehand */
} StepCost;

/** What stages judge of the body at their end: it bears its loads; it does not; a load or motion still changes; the stage is too short to tell. */
enum { STEADY_UNASKED = 0, STEADY = 1, STEADY_NOT = -1, STEADY_CHANGES = 2, STEADY_TOO_SHORT = 3 };

/** How a stage went. */
typedef struct StageRecord {
  double first_step, last_step, begin, end; /* steps done and times at its begin and end */
  double came_to_rest;                      /* 1: it ended because the body was at rest */
  double steady;                            /* one of STEADY_... */
  double unbalanced, kinetic;               /* by which it was judged (solver/rest.h) */
  double midway;                            /* unbalanced, half a hold before it was judged; 0: not looked at */
  double last_unbalanced;                   /* at the last look of the hold; 0: there was none */
  double last_kinetic;                      /* at the last look */
  double growing;                           /* number of looks in a row by which the body has come no nearer to rest */
  double descended,
      relaxed; /* increments in which Newton's method did not come to rest, and whose ends descent by secants, and dynamic relaxation found */
  double lost_reduction; /* strength reduction whose increment ended the stage without equilibrium [-]; 0: none did */
  double slides;         /* 1: the body came to rest elsewhere in that increment; 0: there was no equilibrium */
  double elastic_displacement; /* by which static stages judge whether the body slides (static_slide.c) [length] */
} StageRecord;
enum { STAGE_NUMBERS = sizeof(StageRecord) / sizeof(double) };

/** A run: stages one after another, each by one of the solvers. What is pointed to is borrowed. */
typedef struct Solver {
  Domain *domain;
  Loading *loading;
  const SectionList *stages;     /* of SolveSpec, one at least */
  const SectionList *selections; /* those of the deck that have names */
  const DeckReader *reader;      /* for messages that point into the deck */
  const volatile int
      *interrupted; /* non-zero: a step that takes many iterations ends before its time; NULL: none does */
  bool force;       /* accept a chosen step above the stable one */
  bool loose;       /* what nothing holds is told when a stage of statics begins, not before */
  bool trap;        /* fail where a step divides by zero, overflows or does what is not defined */
  bool unbegun;     /* the stage under way has failed to begin: no step can go on from what is there */
  Clock clock;
  Ledger ledger;
  const double *stops; /* ascending times at which steps of the program's own shall end; may be NULL */
  int64_t stop_count;
  StageRecord *records;   /* [stages] */
  Resultants *resultants; /* NULL: no motion is prescribed, and nothing follows displacements */
  Text log;               /* how the equations of the last step were solved, a line each; empty where there were none */
  const SolverType *type; /* of the stage under way */
  const SolveSpec *stage;
  const void *spec; /* the type's section */
  void *own;        /* what the type keeps */
} Solver;

struct SolverType {
  const char *name;
  /** Memory only. */
  int (*create)(Solver *solver, Error *error);
  void (*destroy)(Solver *solver);
  /** Looks at the body as it is: how long the steps are, how many there will be, and so when the stage ends. Says which keys do not fit it.
   *  @param[out] warning  remarks for the user are added */
  int (*plan)(Solver *solver, Text *warning, Error *error);
  /** Mistakes of a later stage with this section that can be seen before the run. */
  int (*check)(Solver *solver, const void *spec, Error *error);
  /** Whether a stage with this section finds the factors of controlled loads. May be NULL: it does not. */
  bool (*controls)(const void *spec);
  /** Whether a stage with this section asks for linearised steps. NULL: it does. */
  bool (*linearises)(const void *spec);
  /** Other times are asked for. */
  void (*plan_again)(Solver *solver);
  /** Forces and accelerations of the state held, before the first step. */
  int (*begin)(Solver *solver, Error *error);
  /** One step, of the clock too, and whether the stage has ended; solver_advance says what holds after a failure. BRECCIA_INTERRUPTED: on request there
   *  was none, and the state is as it was. */
  int (*advance)(Solver *solver, Text *warning, Error *error);
  /** Rows of what it keeps. */
  void (*state)(Solver *solver, StateList *list);
  /** Whether something takes energy out of motions, so that a body may come to rest. */
  bool (*damps)(const Solver *solver);
  /** The rate at which a stage with this section damps motions in proportion to mass. NULL: not at all, or by what it finds itself. */
  double (*damping)(const void *spec);
  /** Whether its steps are few and long, so that histories have a row for each. */
  bool few_steps;
  /** Below which forces out of balance and kinetic energy count as none where a stage with this section judges, when it ends, whether the body bears its
   *  loads; NaN: it does not judge. May be NULL. */
  double (*steady)(const void *spec);
  /** Whether every step ends in equilibrium at rest. */
  bool rests;
  /** The most that loads and supports have exerted at rest in the stage: forces out of balance are small beside it. NULL: what they exert now counts. */
  double (*exerted)(const Solver *solver);
  /** Force of inertia and damping of the n-th particle of a motion along its direction, in the state held. NULL: there is none, at rest. */
  double (*inertia)(const Solver *solver, const Constraint *constraint, int64_t n);
  /** Steps and time that a stage with this section will take at most, by the stable step of the body as it is. */
  void (*foresee)(const void *spec, const Clock *clock, double *steps, double *time);
  /** Tries what a step of the stage under way takes, at the displacements held. NULL: little beside an evaluation of the forces. */
  int (*measure)(Solver *solver, StepCost *cost, Error *error);
  /** Memory beside the body and its formulations, of solvers without `measure`. NULL: next to none. */
  size_t (*bytes)(Solver *solver);
  /** The steps to come of the stage under way, in words. @param[in] time  unit of time */
  void (*describe)(const Solver *solver, const char *time, Text *text);
  /** How a stage with this section goes and ends, in words. */
  void (*describe_stage)(const void *spec, const char *time, Text *text);
};

/** Sets up the first stage and plans its steps. `solver` has domain, loading, stages, reader, force and trap, and is zero beyond; destroy it in any
 *  case. Mistakes in later stages are told as far as they can be seen beforehand. */
int solver_create(Solver *solver, Text *warning, Error *error);
void solver_destroy(Solver *solver);

/** Returns the factor by which loads divide strengths in the current state. The loads of a stage in which no time has
 *  passed do not count: the state is then that of the stage before. */
double solver_strength_reduction(const Solver *solver);

/** Name of a stage: as in the deck, or its number from 1. @return `name` */
const char *solver_stage_name(const Solver *solver, int64_t stage, char *name, size_t size);

/** Whether a step, one that is done, was among few and long ones. */
bool solver_step_was_long(const Solver *solver, int64_t step);

/** Whether it can be foreseen how many steps later stages take at most: not of explicit ones where no stable step has been measured. */
bool solver_foresees_steps(const Solver *solver);

/** Whether every step of a stage ends in equilibrium at rest, so that its time is none of a clock. */
bool solver_stage_rests(const Solver *solver, int64_t stage);

/** Time of the stage under way and of later ones in which the body may move, as far as it can be foreseen. */
double solver_time_in_motion(const Solver *solver);

/** SolverType.damping of a stage, or 0. @param[out] node  of the deck, where it is said */
double solver_stage_damping(const Solver *solver, int64_t stage, const Node **node);

/** Whether some of the stages asks for linearised steps, or there are no stages yet of which it is known. @param[in] stages  of SolveSpec */
bool solver_linearises(const SectionList *stages);

/** SolverType.steady of a stage. */
double solver_stage_steady(const Solver *solver, int64_t stage);

/** How a stage goes and ends, in words. @param[in] time  unit of time */
void solver_describe_stage(const Solver *solver, int64_t stage, const char *time, Text *text);

/** Makes ready for the state of a stage, which is to be taken up from a file. */
int solver_enter(Solver *solver, int64_t stage, Error *error);

/** Begins with the next stage, when one has ended: its loads, its laws, its displacements from zero if so wished. If its steps cannot be planned,
 *  everything is as it was at the end of the stage before. */
int solver_next_stage(Solver *solver, Text *warning, Error *error);

/** Whether the last stage has ended. */
bool solver_is_done(const Solver *solver);

/** Tells times of the run, ascending, at which steps of the stage under way shall end if the program chooses them; borrowed.
 *  @param[in] again  plan the steps to come with them; not where a plan has been taken up from a file */
void solver_stop_at(Solver *solver, const double *times, int64_t count, bool again);

/** Before the first step. */
int solver_begin(Solver *solver, Error *error);

/** What a step takes, on the average over those of the stage under way and of later ones, and the memory of the stage under way. Later stages are
 *  counted by the forces that they evaluate at least, or as steps of the stage under way, where the same solver takes them. Before the run; forces
 *  are to be evaluated again. */
int solver_measure(Solver *solver, StepCost *cost, Error *error);

/** One step of the stage under way. After a failure the reason is in `error`, and the state is that of the step before, to the bit, but for how its
 *  equations are best solved, and for round-off where explicit steps reconstruct the motion. Where energies or a trap
 *  give the reason the step has been taken, and counts; so too at rest, where bonds have broken in it and no
 *  equilibrium was found without them: the state is then one with these bonds broken that is not in equilibrium.
 *  @param[out] warning  a remark for the user is added, if there is one */
int solver_advance(Solver *solver, Text *warning, Error *error);
/** Takes over displacements and velocities that a program has written between steps: forces and accelerations follow,
 * and the work that the program has done is booked as external work.
 *  @param[in,out] displacement, velocity  as the last step left them; the former hold its changes afterwards */
int solver_take_motion(Solver *solver, const Vector *displacement, const Vector *velocity, Error *error);

Energy solver_energy(const Solver *solver);

/** What is copied: the whole state; what steps try, of the body and of what the solver keeps, by which one that fails is given back; or that without
 *  displacements and velocities, which the solver reconstructs. */
typedef enum Kept { KEPT_ALL, KEPT_TRIED, KEPT_BUT_MOTION } Kept;

/** Bytes of a copy. */
size_t solver_kept_bytes(Solver *solver, Kept kept);

/** Makes room for a copy of what steps try, if there is none yet; only while steps are taken, as pictures and the like need room afterwards. */
int solver_keep(Solver *solver, Kept kept, StateCopy *before, Error *error);
/** Frees the copy. */
void solver_forget(Domain *domain, StateCopy *before);

/** Rows of the clock, the ledger and what the solver keeps. */
void solver_state(Solver *solver, StateList *list);

#endif
