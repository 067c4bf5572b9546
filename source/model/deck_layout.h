/* The whole deck: which sections it has. */
#ifndef BRECCIA_MODEL_DECK_LAYOUT_H
#define BRECCIA_MODEL_DECK_LAYOUT_H

#include "constitutive/law.h"
#include "deck/describe.h"
#include "domain/initial_stress.h"
#include "results/picture.h"
#include "results/profile.h"
#include "results/results_spec.h"
#include "results/watch.h"
#include "solver/solver.h"

typedef struct UnitsSpec {
  SectionHead head;
  const char *length, *force, *time;
} UnitsSpec;

typedef struct DeckSpec {
  SectionHead head;
  const char *title;
  UnitsSpec *units;
  SectionList materials, body, selections, cracks, initial_stress, loads, solve, watches, profiles,
      pictures; /* solve: stages of SolveSpec */
  PeridynamicsSpec *peridynamics;
  FailureSpec *failure;
  FieldsSpec *fields;
  void *forces[FORCES_KINDS];             /* of those by name their SectionList */
  SectionList named_forces[FORCES_KINDS]; /* as read */
  ResultsSpec *results;
} DeckSpec;

extern const Section deck_section, units_section;

/** Whether a run draws the usual pictures: the deck says nothing of pictures. */
bool deck_usual_pictures(const DeckSpec *spec);

/** Parameter tables of all laws, for the descriptions; to be freed. */
ParameterTable *law_tables(const LawList *laws, int *count);

typedef struct DeckText {
  const char *words, *name;    /* of a file: its path */
  const char *const *settings; /* "key.path=value" each, for values other than those written; may be NULL */
  int setting_count;
} DeckText;

/** From text to a document in which nothing is left to work out, and what its plain numbers mean. Both are the caller's to destroy, also
 *  after a failure. */
int deck_open(const DeckText *text, const Section *section, const LawList *laws, Document **document, Units **units,
              Error *error);

/** A section as if it stood in the deck with nothing in it, so that all its defaults hold. */
void *section_standard(const DeckReader *reader, const Section *section, const Node *node);

#endif
