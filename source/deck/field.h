/* One key of a section: its value read into its place. Only section.c needs this. */
#ifndef BRECCIA_DECK_FIELD_H
#define BRECCIA_DECK_FIELD_H

#include "deck/section.h"

/** Reads the value under a key, adding every problem to the reader's error.
 *  @param[out] target  the field's place in the section's struct */
void field_read(const DeckReader *reader, const Node *node, const char *label, const Field *field, void *target);

/** Writes what stands for "not given" into the field's place. */
void field_set_absent(const Field *field, void *target);

/** Memory of the document, zeroed; NULL after a message. */
void *field_room(const DeckReader *reader, size_t size);

/** What stands at a node, for messages. */
const char *field_found(const Node *node);

#endif
