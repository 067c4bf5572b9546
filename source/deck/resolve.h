/* From what people wrote to the deck that is run: included files taken in, settings applied, expressions worked out. */
#ifndef BRECCIA_DECK_RESOLVE_H
#define BRECCIA_DECK_RESOLVE_H

#include "deck/section.h"

/** Resolves a document in place. The map `variables` of its root stays, with every value worked out.
 *  @param[in] section   what its root is: tells which keys a setting may add
 *  @param[in] units     any: only their names are used, not what plain numbers mean
 *  @param[in] settings  "key.path=value", from the command line, say; the last of two for one key holds
 *  @return BRECCIA_OK, or an error with a line for every problem */
int deck_resolve(Document *document, const Section *section, const Units *units, const char *const *settings, int count,
                 Error *error);

/** Takes in the file that maps name under `include`, and those that they name. Part of deck_resolve. */
int deck_include(Document *document, Error *error);

/** Applies a setting "key.path=value". Part of deck_resolve. */
int deck_set(Document *document, const Section *section, const char *setting, Error *error);

/** Writes a resolved document as YAML that reads as the same tree. */
void deck_write(const Document *document, Text *text);

#endif
