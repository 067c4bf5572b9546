/* Names that a deck defines at one place and uses at others: of materials, blocks, selections and loads. */
#ifndef BRECCIA_DECK_NAMES_H
#define BRECCIA_DECK_NAMES_H

#include "deck/section.h"

/** Says so if the deck defines nothing of this kind and name. Nothing is said where definitions cannot be read at all, or their keys are
 *  wrongly written, which is told elsewhere, nor of selections where a block comes from a file, which may hold groups of that name.
 *  @param[in] node  where the name is used
 *  @param[in] what  "material", "block", "selection" or "load" */
void name_check(const DeckReader *reader, const Node *node, const char *what, const char *name);

/** Says that `name` is none of `names`. */
void name_unknown(const DeckReader *reader, const Node *node, const char *what, const char *name,
                  const char *const *names, int count);

#endif
