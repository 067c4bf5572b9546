/* Loads: forces on particles, and motions prescribed to them. */
#ifndef BRECCIA_LOADING_LOAD_H
#define BRECCIA_LOADING_LOAD_H

#include "body/selection.h"
#include "loading/history.h"

typedef struct AlongSpec { /* a motion prescribed in one direction; the others stay free */
  SectionHead head;
  double direction[3], displacement, velocity;
} AlongSpec;

typedef struct LoadSpec {
  SectionHead head;
  const char *name;
  Reference on;
  double body_force[3], force[3], gravity[3], displacement[3], velocity[3];
  AlongSpec *along;
  HistorySpec *history;
} LoadSpec;

extern const Section load_section;

typedef struct Load {
  const LoadSpec *spec;
  Selection selection;
  double volume;         /* of the selected particles */
  int64_t first, behind; /* acts in the stages first .. behind - 1 */
  double begin;          /* time of the run from which its history counts */
} Load;

/** A motion prescribed to the particles of a load in one direction. */
typedef struct Constraint {
  const Load *load;
  double direction[3]; /* unit vector */
  double value;
  bool is_velocity;
  double *from; /* [particles of the load] displacement in that direction when the load began; NULL: 0 */
} Constraint;

/** What a stage of the run changes in the loads. */
typedef struct LoadStage {
  const SectionList *loads; /* that begin with it; one of the name of an earlier load takes its place */
  const TextList *without;  /* names of earlier loads that end */
  const void *section;      /* of the deck, for messages */
} LoadStage;

typedef struct Loading {
  int64_t stage; /* under way */
  int count;
  Load *loads;
  Constraint *constraints;
  int constraint_count;
} Loading;

/** Resolves the loads of a deck on a body; says where a selection is empty or motions of one stage contradict each other.
 *  @param[in] loads  those of the deck, from the first stage on */
int loading_create(Loading *loading, const Body *body, const DeckReader *reader, const SectionList *loads,
                   const LoadStage *stages, int stage_count, const SectionList *selections);
void loading_destroy(Loading *loading);

/** Lets the loads of a stage act, those of other stages not. */
void loading_enter(Loading *loading, int64_t stage);
/** Begins with the loads that are new in the stage under way: their histories count from this time, their motions from where the particles
 *  are. Forces of loads that have ended are taken off. */
void loading_begin(Loading *loading, Particles *particles, double time);
/** Rows of when and where loads began that are not there from the start. */
void loading_state(Loading *loading, StateList *list);

/** Whether a load acts in the stage under way. */
static inline bool load_acts(const Loading *loading, const Load *load)
{
  return load->first <= loading->stage && loading->stage < load->behind;
}
/** Factor of a load at a time of the run. */
double load_factor(const Load *load, double time);

/** Sets the external force per volume of all particles to what the loads say at a time. */
void loading_apply(const Loading *loading, Particles *particles, double time);

/** Marks the particles whose motion is prescribed. @param[out] held  [places], zeros before */
void loading_mark_held(const Loading *loading, uint8_t *held);

/** What a load prescribes, as its key in the deck. @param[out] dimension  of its value */
const char *load_kind(const LoadSpec *load, const char **dimension);

/** Length of the vector that a load prescribes at factor 1. */
double load_magnitude(const LoadSpec *load);

/** Displacement along its direction that a constraint prescribes at a time of the run, from where its load began. */
double constraint_displacement(const Constraint *constraint, double time);

#endif
