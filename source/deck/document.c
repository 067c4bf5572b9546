/* The tree of a deck: who holds it, how its nodes are found, and where they stand. */
#include "deck/document.h"

#include "base/memory.h"
#include "base/text.h"
#include "deck/yaml.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { LONGEST_VALUE = 60 };

Document *document_parse(const char *text, size_t length, const char *name, Error *error)
{
  Document *document = memory_plain(1, sizeof *document);
  Arena *arena = arena_create();
  if (!document || !arena || !(document->root = arena_zeroed(arena, sizeof(Node)))) {
    error_add(error, BRECCIA_FAILURE, "out of memory: deck");
    free(document);
    arena_destroy(&arena);
    return NULL;
  }
  document->arena = arena;
  document->name = arena_copy(arena, name, strlen(name));
  if (!document->name || yaml_parse(document, document->root, text, length, name, false, error))
    document_destroy(&document);
  return document;
}

Node *document_parse_more(Document *document, const char *text, size_t length, const char *name, bool setting,
                          Error *error)
{
  const char *file = arena_copy(document->arena, name, strlen(name));
  Node *root = arena_zeroed(document->arena, sizeof(Node));
  if (!file || !root) {
    error_add(error, BRECCIA_FAILURE, "out of memory: deck");
    return NULL;
  }
  root->file = file;
  return yaml_parse(document, root, text, length, name, setting, error) ? NULL : root;
}

void document_destroy(Document **document)
{
  if (!document || !*document) return;
  arena_destroy(&(*document)->arena);
  free(*document);
  *document = NULL;
}

/** In the order of their keys; where these are the same, in the order of the deck. */
static int compare_keys(const void *a, const void *b)
{
  const Node *one = *(const Node *const *)a, *other = *(const Node *const *)b;
  const int order = strcmp(one->key, other->key);
  return order ? order : one < other ? -1 : one > other;
}

void node_order(const Document *document, Node *map)
{
  enum { FEW = 16 };
  map->by_key = NULL;
  if (map->kind != NODE_MAP || map->count <= FEW) return;
  const Node **order = arena_zeroed(document->arena, sizeof(Node *) * (size_t)map->count);
  if (!order) return;
  for (int k = 0; k < map->count; ++k) order[k] = &map->items[k];
  qsort(order, (size_t)map->count, sizeof(Node *), compare_keys);
  map->by_key = order;
}

static void order_all(const Document *document, Node *node)
{
  node_order(document, node);
  for (int k = 0; k < node->count; ++k) order_all(document, &node->items[k]);
}

void document_order(Document *document)
{
  order_all(document, document->root);
}

/** The first of a map's items, in order, whose key does not come before another. */
static const Node *find_key(const Node *map, const char *key)
{
  int first = 0, behind = map->count;
  while (first < behind) {
    const int middle = first + (behind - first) / 2;
    if (strcmp(map->by_key[middle]->key, key) < 0)
      first = middle + 1;
    else
      behind = middle;
  }
  return first < map->count ? map->by_key[first] : NULL;
}

const Node *node_get(const Node *map, const char *key)
{
  if (!map || map->kind != NODE_MAP) return NULL;
  if (map->by_key) {
    const Node *found = find_key(map, key);
    return found && !strcmp(found->key, key) ? found : NULL;
  }
  for (int k = 0; k < map->count; ++k)
    if (!strcmp(map->items[k].key, key)) return &map->items[k];
  return NULL;
}

void node_where(const Document *document, const Node *node, char *words, size_t size)
{
  if (node->line)
    snprintf(words, size, "%s:%d:%d", node->file ? node->file : document->name, node->line, node->column);
  else
    snprintf(words, size, "%s", node->file ? node->file : document->name);
}

const char *node_file(const Document *document, const Node *node)
{
  return node->file && node->line ? node->file : document->name;
}

Node node_of_key(const Node *item)
{
  Node where = *item;
  where.line = item->key_line;
  where.column = item->key_column;
  where.written = NULL;
  return where;
}

/** Cuts a long value of the deck wherever a message says it. */
static void cut_value(Text *words, const char *value)
{
  size_t length = value ? strlen(value) : 0, kept = LONGEST_VALUE;
  if (length <= 2 * LONGEST_VALUE) return;
  while (kept > 0 && ((unsigned char)value[kept] & 0xc0) == 0x80) --kept; /* no half of a letter */
  for (char *at = words->characters; at && (at = strstr(at, value)); at += kept) {
    memcpy(at + kept, "...", 3);
    memmove(at + kept + 3, at + length, words->length - (size_t)(at + length - words->characters) + 1);
    words->length -= length - kept - 3;
  }
}

int node_error(const Document *document, const Node *node, Error *error, const char *format, ...)
{
  Text words = {0};
  char where[WHERE_SIZE];
  node_where(document, node, where, sizeof where);
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&words, format, arguments);
  va_end(arguments);
  text_add(&words, "%s%s%s", node->written ? " (written '" : "", node->written ? node->written : "",
           node->written ? "')" : "");
  cut_value(&words, node->text);
  cut_value(&words, node->written);
  cut_value(&words, node->key);
  error_add(error, BRECCIA_USER_ERROR, "%s: %s", where, text_words(&words));
  text_free(&words);
  return BRECCIA_USER_ERROR;
}

char *document_text(const char *path, size_t *length, Error *error)
{
  struct stat status;
  if (!stat(path, &status) && S_ISREG(status.st_mode) && status.st_size > DOCUMENT_LARGEST) {
    error_add(error, BRECCIA_USER_ERROR, "%s: is larger than %d MB, which no deck is", path, DOCUMENT_LARGEST >> 20);
    return NULL;
  }
  char *text = text_read_file(path, length);
  if (!text) {
    error_add(error, BRECCIA_USER_ERROR, "%s: cannot be read: %s", path, text_why_unread(errno));
  } else if (strlen(text) != *length) {
    error_add(error, BRECCIA_USER_ERROR, "%s:1:1: is not text: it holds a zero byte", path);
    free(text);
    text = NULL;
  }
  return text;
}
