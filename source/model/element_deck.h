/* A file that describes a test on one material point: units, material, test or stages, and measured points to hold against it. */
#ifndef BRECCIA_MODEL_ELEMENT_DECK_H
#define BRECCIA_MODEL_ELEMENT_DECK_H

#include "constitutive/element_test.h"
#include "model/deck_layout.h"

typedef struct FitSpec {
  SectionHead head; /* the name is the parameter's */
  const Node *from, *to;
} FitSpec;

typedef struct ElementDeckSpec {
  SectionHead head;
  const char *title, *against;
  UnitsSpec *units;
  MaterialSpec *material;
  TestSpec *test;
  SectionList stages, fit;
} ElementDeckSpec;

extern const Section element_deck_section, fit_section;

typedef struct ElementDeck {
  Document *document;
  Units *units;
  LawList laws;
  DeckReader reader;
  const ElementDeckSpec *spec;
  const breccia_law *law;
  Material material;
  ElementTest test;
  char *against; /* path of the measured points, or NULL */
} ElementDeck;

/** Reads such a file, prepares its material and its test. */
int element_deck_load(ElementDeck *deck, const char *path, Error *error);
void element_deck_destroy(ElementDeck *deck);

/** Says of a modulus or a density that no material has that its unit is likely another one than meant: one line each. */
void element_doubt_material(const Material *material, const Units *units, const char *where, Error *doubts);

#endif
