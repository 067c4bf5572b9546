/* Parts of a body by name or on the spot: by box, block, face and layers, or nearest to a point. */
#ifndef BRECCIA_BODY_SELECTION_H
#define BRECCIA_BODY_SELECTION_H

#include "body/body.h"

typedef struct SelectionSpec {
  SectionHead head;
  const char *block, *face;
  int64_t layers;
  Shape *inside;
  double nearest[3];
  bool all;
} SelectionSpec;

extern const Section selection_section;

typedef struct Selection {
  int32_t *places; /* in order of the particles' numbers; owned */
  int64_t count;
} Selection;

/** Resolves a reference to a named selection or one given on the spot. Every condition given must hold.
 *  Says so when nothing is selected. */
int selection_create(Selection *selection, const Body *body, const DeckReader *reader, const SectionList *named,
                     const Reference *reference);
void selection_destroy(Selection *selection);

#endif
