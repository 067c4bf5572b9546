/* Files of numbers that a deck names (particles, records), as they were when they were read: a restart has to find them so. */
#ifndef BRECCIA_DECK_NAMED_FILE_H
#define BRECCIA_DECK_NAMED_FILE_H

#include "deck/section.h"

/** Adds a line to the reader's list of files: checksum, bytes, and the name as it stands in the deck. Once for each file.
 *  @param[in] path  where it is; one that cannot be read is left to whoever reads it */
void named_file_note(const DeckReader *reader, const char *name, const char *path);

#endif
