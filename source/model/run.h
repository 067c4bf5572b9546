/* A run under way: what the files of this room that write for it share. */
#ifndef BRECCIA_MODEL_RUN_H
#define BRECCIA_MODEL_RUN_H

#include "formulation/formulation.h"
#include "model/model.h"
#include "results/result_file.h"
#include <stdio.h>

typedef struct Run {
  breccia_model *model;
  const breccia_run *wish;
  const Host *host;
  ResultFile *results;
  int64_t steps;           /* where to stop */
  int64_t checkpoint_step; /* of the last one in the folder; -1: none, or not of this run */
  double started, last_checkpoint, last_progress;
  double paused;    /* seconds since the last progress that went into writing */
  int64_t told_at;  /* step of the last progress */
  bool unwritten;   /* a file lacks what was due: said, and no checkpoint may stand behind the gap */
  bool step_failed; /* the body could not be brought any further: no equilibrium, energy from nothing ... */
  TextList names;
  Text files;
  FILE *log; /* solution.txt; NULL: there was nothing to tell yet */
  Text logs; /* its line among the files that were written */
} Run;

/** Writes a small file whole, or not at all. */
int run_write_file(Run *run, const char *name, const Text *words, Error *error);

/** Adds what the solver tells of its last step to solution.txt. @param[in] done  the step was taken; else a restart forgets it */
int run_log_write(Run *run, bool done, Error *error);
/** What was told before the checkpoint that a run goes on from must be there: else BRECCIA_USER_ERROR. */
int run_log_check(const Run *run, Error *error);
/** Brings it to the disk: a checkpoint must not be ahead of it when the machine goes down. */
int run_log_settle(const Run *run, Error *error);
int run_log_close(Run *run, Error *error);

/** Pictures are made from the files, as `breccia plot` does.
 *  @return BRECCIA_OK, also after a warning about what cannot be drawn; BRECCIA_FAILURE after a line about each that could not be written */
int run_draw_pictures(Run *run, Error *error);

/** Writes summary.json. @param[in] problem  why the run ended early; may be empty */
int run_write_summary(Run *run, int status, const char *problem, Error *error);
/** Reinforcing bars in it: a list for summary.json, and lines for people. Nothing where there are none. */
void run_add_bars(const breccia_model *model, Text *text);
void run_tell_bars(const breccia_model *model, Text *text);
/** Strain from which on runs and `check` tell what the measure means: forces are then off by 2 %, true stresses by
 *  4 %. */
extern const double run_strain_told_from;
/** Returns true if a law has a history, or is in a server, and takes the Green-Lagrange strain in a region
 *  (run_strains.c). */
bool run_strain_matters(const Region *region, const Material *material);
/** Adds the state that is observed to the largest strains of such laws. */
void run_note_strains(breccia_model *model);
/** Warns where these strains were so large that stresses depend on the measure of strain. */
void run_tell_strains(const breccia_model *model, Text *text);

/** Adds the warnings of layers with fewer rows than their formulation needs (plausibility_thin.c). */
void run_tell_thin_layers(const breccia_model *model, Text *text);
/** The largest compression of materials that no compression crushes: a list for summary.json, and lines for people. */
void run_add_compressions(const breccia_model *model, Text *text);
void run_tell_compressions(const breccia_model *model, Text *text);
/** Loads and supports in it: a list for summary.json, and lines for people. */
void run_add_loads(const breccia_model *model, Text *text);
void run_tell_loads(const breccia_model *model, Text *text);
/** Share of the stored energy above which control of zero-energy modes carries too much where laws have yielded. */
extern const double run_most_control;
/** Sums of the energies of all places whose points have yielded. */
YieldedEnergy run_yielded_energy(const Domain *domain);
/** Share of the energy of yielded points (YieldedEnergy) above which control of zero-energy modes holds ground that
 *  would slide under a strength reduction [-]. */
extern const double run_most_sliding;
/** Records the first strength reduction at which the share of control exceeds run_most_sliding, and the last one before
 *  (Peaks). Does nothing in stages that do not end at rest.
 *  @return BRECCIA_OK; otherwise as domain_observe */
int run_note_reduction(breccia_model *model, Error *error);
/** Records the time of the first state at rest in which a bond or point has softened. Stages in motion have too many
 *  steps to look at each. */
void run_note_softening(breccia_model *model);
/** Adds the values that loads had at a time, in brackets; nothing where no load has changed. */
void run_tell_loads_at(const breccia_model *model, double time, Text *text);
/** Adds to summary.json by what measures a body bears its loads, beside forces out of balance and kinetic energy. */
void run_add_measures(const breccia_model *model, Text *text);
/** Puts what the run did into words, for breccia_model_outcome. */
void run_tell_outcome(Run *run, int status);

#endif
