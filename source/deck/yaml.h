/* From the text of a deck to its tree. */
#ifndef BRECCIA_DECK_YAML_H
#define BRECCIA_DECK_YAML_H

#include "deck/document.h"

/** Reads YAML text into a node, with aliases and merge keys (`<<`) followed. Problems become lines "name:line:column: ...".
 *  @param[in,out] root  an empty node, whose `file` all below it get
 *  @param[in] name     what stands before messages, with `setting` instead of a place
 *  @return 0, or not after saying what is wrong */
int yaml_parse(Document *document, Node *root, const char *text, size_t length, const char *name, bool setting,
               Error *error);

#endif
