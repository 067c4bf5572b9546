/* The whole deck: which sections it has. */
#ifndef BRECCIA_MODEL_DECK_LAYOUT_H
#define BRECCIA_MODEL_DECK_LAYOUT_H

#include "constitutive/law.h"
#include "deck/describe.h"
#include "results/picture.h"
#include "results/results_spec.h"
#include "results/watch.h"

typedef struct UnitsSpec {
  SectionHead head;
  const char *length, *force, *time;
} UnitsSpec;

typedef struct SolveSpec {
  SectionHead head;
  ExplicitSpec *explicit_dynamics;
} SolveSpec;

typedef struct DeckSpec {
  SectionHead head;
  const char *title;
  UnitsSpec *units;
  SectionList materials, body, selections, cracks, loads, watches, pictures;
  PeridynamicsSpec *peridynamics;
  FailureSpec *failure;
  ContactSpec *contact;
  SolveSpec *solve;
  ResultsSpec *results;
} DeckSpec;

extern const Section deck_section, units_section;

/** Parameter tables of all laws, for the descriptions; to be freed. */
ParameterTable *law_tables(const LawList *laws, int *count);

/** What plain numbers mean in a file. It comes first: nothing else can be read without it. */
int deck_units(const Document *document, const LawList *laws, Units **units, Error *error);

/** A section as if it stood in the deck with nothing in it, so that all its defaults hold. */
void *section_standard(const DeckReader *reader, const Section *section, const Node *place);

#endif
