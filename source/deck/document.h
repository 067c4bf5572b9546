/* YAML text as a tree of nodes that know where they stand in which file. */
#ifndef BRECCIA_DECK_DOCUMENT_H
#define BRECCIA_DECK_DOCUMENT_H

#include "base/error.h"
#include "base/memory.h"
#include <stdbool.h>

typedef enum NodeKind { NODE_SCALAR, NODE_LIST, NODE_MAP } NodeKind;

typedef struct Node {
  NodeKind kind;
  int line, column;    /* of the value, from 1; line 0: it stands in no file but in a setting, which `file` names */
  const char *file;    /* NULL: the document's own */
  const char *text;    /* scalar: its characters */
  const char *written; /* scalar: what stood there before expressions were worked out; NULL: the same */
  const char *key;     /* if it is the value of a map entry: the key */
  int key_line, key_column;
  int count; /* of a list or a map */
  struct Node *items;
  const struct Node *
      *by_key; /* the items of a large map in the order of their keys, for node_get; NULL: look through them. Whoever
                                 changes the items takes it away */
} Node;

typedef struct Document {
  const char *name; /* file name for messages */
  Arena *arena;
  Node *root;
  int copies; /* nodes made by following aliases */
} Document;

/** Reads YAML text, with aliases and merge keys (`<<`) followed. Problems of syntax become lines "name:line:column: ...".
 *  @return NULL if the text is not one YAML document */
Document *document_parse(const char *text, size_t length, const char *name, Error *error);
/** Reads another text into the same document's memory.
 *  @param[in] name  its file for messages, kept; with `setting` what stands before its messages instead of a place
 *  @return its root, or NULL after saying what is wrong */
Node *document_parse_more(Document *document, const char *text, size_t length, const char *name, bool setting,
                          Error *error);
enum { DOCUMENT_LARGEST = 64 << 20 }; /* bytes of a deck's file, or of one that it includes */

/** The characters of a deck's file, to be freed; NULL with a message if it cannot be read or is not text. */
char *document_text(const char *path, size_t *length, Error *error);
void document_destroy(Document **document);

/** @return the value of the first entry with that key, or NULL */
const Node *node_get(const Node *map, const char *key);

/** Lets node_get find a key of a map quickly, if the map is large. */
void node_order(const Document *document, Node *map);
/** The same for all maps of a document that nobody changes any more. */
void document_order(Document *document);

enum { WHERE_SIZE = 4200 }; /* room for a path and its line and column */

/** Where a node stands, as messages begin: "name:line:column". */
void node_where(const Document *document, const Node *node, char *words, size_t size);
/** The file in which a node stands: what it says of other files is relative to that. */
const char *node_file(const Document *document, const Node *node);
/** A node that points at the key of another, for messages. */
Node node_of_key(const Node *item);

/** Adds "name:line:column: ..." for a node. @return BRECCIA_USER_ERROR */
int node_error(const Document *document, const Node *node, Error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#endif
