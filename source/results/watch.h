/* Histories: what is written of a few particles, bonds, loads or the whole body at many steps, one CSV file each. */
#ifndef BRECCIA_RESULTS_WATCH_H
#define BRECCIA_RESULTS_WATCH_H

#include "solver/solver.h"

typedef struct WatchSpec {
  SectionHead head;
  int64_t every;
  Reference displacement, velocity, force, reaction, stress, history, damage;
  NumberList opening, bond;
  const char *load, *reaction_of, *bar;
  double at[3];
  bool energy;
} WatchSpec;

extern const Section watch_section;

typedef struct Watches Watches;

/** Resolves the watches of a deck on a body. */
int watches_create(Watches **watches, const Domain *domain, const Loading *loading, const DeckReader *reader,
                   const SectionList *specs, const SectionList *selections);
/** Refuses links, pipes and the like that have the name of a history's file. */
int watches_refuse_links(const Watches *watches, const char *folder, Error *error);
/** Looks whether a history would be written over a table that the deck reads.
 *  @param[in] files  what the deck reads, a line each (DeckReader) */
int watches_spare(const Watches *watches, const char *folder, const char *files, Error *error);
/** Looks whether all that histories had at a checkpoint that has been taken up is there as it was. Nothing is changed.
 *  @param[in] step  of the checkpoint */
int watches_check(const Watches *watches, const char *folder, int64_t step, Error *error);
/** Opens <folder>/<name>.csv for each.
 *  @param[in] resume  a checkpoint has been taken up: rows behind it are cut off, and the files continued; else they begin */
int watches_open(Watches *watches, const char *folder, const Units *units, bool resume, Error *error);
/** How far the files have been written. */
void watches_state(Watches *watches, StateList *list);
/** Brings all rows to the disk: a checkpoint must not be ahead of them when the machine goes down. */
int watches_settle(const Watches *watches, Error *error);
/** Writes a row to each file that is due at the solver's step; `last` makes all due. */
int watches_write(Watches *watches, const Solver *solver, bool last, Error *error);
/** Whether something that is looked at every so many steps (as the key of histories says; -1: as is usual) is due at a step that is done. */
bool watch_is_due(int64_t every, const Solver *solver, int64_t step);
/** Closes the files. @return BRECCIA_OK, or BRECCIA_FAILURE after a line about the first that could not be written to its end, or that somebody
 *  else has removed or changed meanwhile */
int watches_close(Watches *watches, Error *error);
/** Names the c-th column of the k-th history; of one that could not be resolved only step and time are known.
 *  @return 0, or 1 after the last */
int watches_column(const Watches *watches, int k, int c, char *name, size_t size);
/** Name of the k-th history. */
const char *watches_name(const Watches *watches, int k);
int watches_count(const Watches *watches);
/** Whether one of them tells strains and stresses. */
bool watches_look_at_tensors(const Watches *watches);
/** Path of the k-th file. */
const char *watches_path(const Watches *watches, int k);
void watches_destroy(Watches **watches);

#endif
