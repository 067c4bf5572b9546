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
  double volume; /* of the selected particles */
} Load;

/** A motion prescribed to the particles of a load in one direction. */
typedef struct Constraint {
  const Load *load;
  double direction[3]; /* unit vector */
  double value;
  bool is_velocity;
} Constraint;

typedef struct Loading {
  int count;
  Load *loads;
  Constraint *constraints;
  int constraint_count;
} Loading;

/** Resolves the loads of a deck on a body; says where a selection is empty or motions contradict each other. */
int loading_create(Loading *loading, const Body *body, const DeckReader *reader, const SectionList *loads,
                   const SectionList *selections);
void loading_destroy(Loading *loading);

/** Sets the external force per volume of all particles to what the loads say at a time. */
void loading_apply(const Loading *loading, Particles *particles, double time);

/** Marks the particles whose motion is prescribed. @param[out] held  [places], zeros before */
void loading_mark_held(const Loading *loading, uint8_t *held);

/** What a load prescribes, as its key in the deck. @param[out] dimension  of its value */
const char *load_kind(const LoadSpec *load, const char **dimension);

/** Length of the vector that a load prescribes at factor 1. */
double load_magnitude(const LoadSpec *load);

/** Displacement along its direction that a constraint prescribes at a time, from the start at time 0. */
double constraint_displacement(const Constraint *constraint, double time);

#endif
