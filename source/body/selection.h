/* Parts of a body by name or on the spot: by block, group, face and layers, shape, or nearest to a point; what several have
 * together or in common, and what is left without others. */
#ifndef BRECCIA_BODY_SELECTION_H
#define BRECCIA_BODY_SELECTION_H

#include "body/body.h"

typedef struct SelectionSpec {
  SectionHead head;
  const char *block, *group;
  int face; /* 2 * axis, + 1 if its outward normal points along the axis; -1: none */
  int64_t layers;
  Shape *inside;
  double nearest[3];
  bool all, outside;
  ReferenceList any_of, all_of, except;
} SelectionSpec;

extern const Section selection_section;

/** Returns the axis of the face, from 0, if `face` is given. */
static inline int selection_axis(const SelectionSpec *spec)
{
  return spec->face / 2;
}

/** Returns the sign of the outward normal of the face along its axis, 1 or -1, if `face` is given. */
static inline int selection_side(const SelectionSpec *spec)
{
  return spec->face % 2 ? 1 : -1;
}

/** What a reference says: the named selection, or the one given on the spot; NULL where the name is that of a group. */
const SelectionSpec *selection_spec(const SectionList *named, const Reference *reference);

typedef struct Selection {
  int32_t *places; /* in order of the particles' numbers; owned */
  int64_t count;
} Selection;

/** Resolves a reference to a named selection, a group of a file, or a selection given on the spot. Every condition given must hold.
 *  Says so when nothing is selected, here or in a selection that this one is made of. */
int selection_create(Selection *selection, const Body *body, const DeckReader *reader, const SectionList *named,
                     const Reference *reference);
void selection_destroy(Selection *selection);

#endif
