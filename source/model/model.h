/* A model: a deck put to work. */
#ifndef BRECCIA_MODEL_MODEL_H
#define BRECCIA_MODEL_MODEL_H

#include "base/team.h"
#include "model/deck_layout.h"
#include "model/host.h"
#include "model/outlook.h"
#include "solver/solver.h"

typedef struct Peaks { /* over all states written; infinite mean stresses: none was */
  double displacement, velocity, octahedral, mean_low, mean_high, damage;
  /** Principal Green-Lagrange strains of laws that flow or soften under this measure (run_strains.c); 0: none. */
  double strain_low, strain_high;
  /** Strength reductions of states at rest (run_note_reduction): the first in which control of zero-energy modes held
   *  more than run_most_sliding, 0: none; the last before that, 0: none. */
  double reduction_held, reduction_free;
  /** Time of the first state at rest in which a bond or point had softened [time] (run_note_softening); 0: none. */
  double softened_time;
} Peaks;

/** The largest compressions that materials without a limit to it have reached, in the states written and at the end. */
typedef struct Compressions {
  double *stress;  /* [materials] the smallest principal stress; NULL: all materials have a limit */
  double (*at)[3]; /* [materials] where its particle stood at first */
} Compressions;

struct breccia_model {
  Text deck;                   /* as it is run: nothing in it is left to work out */
  const char *const *settings; /* with which it was loaded */
  int setting_count;
  Text files;            /* that it names, as they were when they were read */
  breccia_law *own_laws; /* those that the program brought along, as this version of the header has them */
  const breccia_law **own_law_list;
  Document *document;
  Units *units;
  LawList laws;
  DeckReader reader; /* its error is only set while loading */
  const DeckSpec *spec;
  Domain domain;
  Loading loading;
  Solver solver;
  Watches *watches;
  Profiles *profiles;
  Text warnings, overview, plausibility, outcome, stage;
  Outlook outlook;
  double solver_bytes; /* that the solver takes, once that is expected */
  bool begun;
  int threads; /* wanted; 0: as many as the machine has to spare */
  Team *team;
  double *schedule; /* ascending times of the stage at which results are written, besides every so many steps */
  double *stops;    /* those of them that steps of the program's own choice meet exactly */
  int64_t schedule_count;
  int64_t next_due;      /* the first of the schedule that is not written yet */
  int64_t last_due;      /* step of the last state that was due; -1: none */
  int64_t states_due;    /* how many were due since the run began */
  int64_t log_bytes;     /* of solution.txt, with what was told of all steps so far */
  int64_t states_before; /* that were due in earlier stages */
  Peaks peaks;
  Compressions compressions;
  Text thin_layers; /* warnings of thin layers for the last words of a run (plausibility_thin.c) */
  double run_seconds;
  int64_t run_steps;
  const volatile int *interrupted; /* of breccia_options */
  bool motion_is_left;             /* breccia_model_step has left a motion, which the program may have changed since: */
  Vector left_displacement, left_velocity;
};

typedef struct Entry { /* what a public function that computes gives back at its end */
  Host host;
  Team *team;
} Entry;

/** Takes over what the program has written into displacements and velocities since breccia_model_step
 * (solver_take_motion). */
int model_take_motion(breccia_model *model, Error *error);

/** Lets team_run of this thread use the model's threads. @return BRECCIA_OK, and then model_leave is due */
int model_enter(breccia_model *model, Entry *entry, Error *error);
/** @return host_status of the function that ends here */
int model_leave(const Entry *entry, int status, Error *error);

/** Prepares forces and accelerations of the first state, once. */
int model_begin(breccia_model *model, Error *error);

/** One step; before it the next stage begins if one has ended. Nothing after the last. */
int model_advance(breccia_model *model, Error *error);

/** Times at which results of the stage under way are written: evenly, and where pictures and the deck ask for them. Does not depend on how
 *  far a run goes, so that a restarted run writes the same.
 *  @param[in] again  plan steps to end with them; not where a plan has been taken up from a file */
int model_make_schedule(breccia_model *model, bool again, Error *error);

/** Time that the deck gives a stage; INFINITY of an explicit one, whose length may show only in it. */
double model_stage_time(const breccia_model *model, int64_t stage);
/** Whether the next stage goes on where a stage finds no equilibrium, before its time. */
bool model_stage_hands_over(const breccia_model *model, int64_t stage);
/** The most that a step of an implicit stage may err by; INFINITY of others. */
double model_stage_error(const breccia_model *model, int64_t stage);

/** Rows of the whole state: of the domain, the solver, the largest values so far and how far results are written. */
void model_state(breccia_model *model, StateList *list);

/** Whether a material fails in tension and in no compression, however large. */
bool model_never_crushes(const breccia_model *model, int material);
/** Makes room for the largest compressions of materials. */
int model_make_compressions(breccia_model *model, Error *error);
/** Takes them back to those of a model that has written no state. */
void model_forget_compressions(breccia_model *model);
/** Notes the stress of a particle at a place. */
void model_note_compression(breccia_model *model, int32_t place, const double stress[6]);

/** Holds the names of fields, components, histories and columns that the deck asks for against what there is. */
int model_check_results(breccia_model *model);

/** Names of the fields that results are written of, without doubles: those of the deck, those of its pictures, and displacement.
 *  @param[out] names  its items are to be freed */
int model_field_names(const breccia_model *model, TextList *names, Error *error);

/** What there is to do from a step to another, when so many states have been written. */
Task model_task(const breccia_model *model, int64_t first, int64_t last, int64_t states_written);
/** Measures how long steps will take, unless that is known already. A model that has begun is left alone. */
int model_expect(breccia_model *model, Error *error);

/** True if the step that ends at a time is the first at or behind the k-th of the times at which results are written, to half a step. */
bool model_has_passed(const breccia_model *model, int64_t k, double time);

#endif
