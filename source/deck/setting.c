/* One value of a deck changed from outside: "body.beam.spacing=2 mm". */
#include "base/memory.h"
#include "deck/resolve.h"
#include "deck/spelling.h"

#include <stdlib.h>
#include <string.h>

typedef struct Path {
  Document *document;
  const char *name; /* before messages: what was asked for */
  Error *error;
} Path;

/** The entry whose key the path begins with, the longest of them: keys may hold points. @param[out] length  of the key */
static Node *entry_of(const Node *map, const char *path, size_t *length)
{
  Node *found = NULL;
  *length = strcspn(path, ".");
  for (int k = 0; k < map->count; ++k) {
    const size_t n = strlen(map->items[k].key);
    if (strncmp(path, map->items[k].key, n) != 0 || (path[n] && path[n] != '.') || (found && n <= *length)) continue;
    found = &map->items[k];
    *length = n;
  }
  return found;
}

static int refuse(const Path *path, const char *format, ...) __attribute__((format(printf, 2, 3)));
static int refuse(const Path *path, const char *format, ...)
{
  Text words = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&words, format, arguments);
  va_end(arguments);
  error_add(path->error, BRECCIA_USER_ERROR, "%s: %s", path->name, text_words(&words));
  text_free(&words);
  return BRECCIA_USER_ERROR;
}

/** Says that a map has no such key, with the one meant or all that there are. */
static int refuse_key(const Path *path, const Node *map, const Section *section, const char *key, size_t length)
{
  const int most = map->count + (section ? section->field_count : 0);
  const char **names = memory_plain((size_t)most + 1, sizeof *names);
  char *given = text_format("%.*s", (int)length, key);
  if (!names || !given) {
    free(names);
    free(given);
    return error_add(path->error, BRECCIA_FAILURE, "out of memory: setting");
  }
  int count = 0;
  for (int k = 0; k < map->count; ++k) names[count++] = map->items[k].key;
  for (int f = 0; section && f < section->field_count; ++f)
    if (section->fields[f].kind != FIELD_CHOSEN && !node_get(map, section->fields[f].key))
      names[count++] = section->fields[f].key;
  Text advice = {0};
  if (count)
    spelling_advice(&advice, given, names, count, "the keys here are");
  else
    text_add(&advice, "nothing stands there");
  refuse(path, "there is no '%s'; %s", given, text_words(&advice));
  text_free(&advice);
  free(given);
  free(names);
  return BRECCIA_USER_ERROR;
}

/** The item of a list that a path begins with: its number from 1, or its name. NULL after a message. */
static Node *item_of(const Path *path, const Node *list, const char *key, size_t *length)
{
  *length = strcspn(key, ".");
  char *end;
  const long number = strtol(key, &end, 10);
  if (end == key + *length && end > key && number >= 1 && number <= list->count) return &list->items[number - 1];
  Text names = {0};
  for (int k = 0; k < list->count; ++k) {
    const Node *name = node_get(&list->items[k], "name");
    if (!name || name->kind != NODE_SCALAR) continue;
    const size_t n = strlen(name->text);
    if (!strncmp(key, name->text, n) && (!key[n] || key[n] == '.')) {
      *length = n;
      text_free(&names);
      return &list->items[k];
    }
    text_add(&names, "%s'%s'", names.length ? ", " : "", name->text);
  }
  refuse(path, "there is no item '%.*s' in a list of %d; items go by their numbers from 1%s%s", (int)*length, key,
         list->count, names.length ? ", or by name: " : "", text_words(&names));
  text_free(&names);
  return NULL;
}

/** Adds an empty entry to a map. */
static Node *add_entry(const Path *path, Node *map, const char *key, size_t length)
{
  Arena *arena = path->document->arena;
  Node *items = arena_zeroed(arena, sizeof(Node) * (size_t)(map->count + 1));
  const char *name = arena_copy(arena, key, length);
  if (!items || !name) {
    error_add(path->error, BRECCIA_FAILURE, "out of memory: setting");
    return NULL;
  }
  if (map->count) memcpy(items, map->items, sizeof(Node) * (size_t)map->count);
  map->items = items;
  map->by_key = NULL;
  Node *item = &items[map->count++];
  *item = (Node){.kind = NODE_MAP, .file = path->name, .key = name};
  return item;
}

typedef struct Position { /* while a path is followed */
  Node *node;
  const Section *section; /* of the node, where it is a section; else NULL */
  const Section *items; /* of what stands in the node, where that is a map of names or a list of sections; else NULL */
} Position;

/** One step down a map: to an entry that is there, or may be. Advances `key` behind the part that it used.
 *  @return 0, or 1 after a message */
static int step_into(const Path *path, Position *position, const char **key)
{
  size_t length;
  Node *map = position->node, *item = entry_of(map, *key, &length);
  const Field *field = section_field(position->section, *key, length);
  const bool last = !(*key)[length];
  /* Keys that depend on another, like the parameters of a material, are judged when the deck is read. */
  const bool judged_later = last && position->section && position->section->parameters;
  if (!item && !field && !judged_later) return refuse_key(path, map, position->section, *key, length);
  const bool listed = item && item->kind == NODE_LIST;
  const bool section = field && (field->kind == FIELD_SECTION || field->kind == FIELD_NUMBER_OR_SECTION ||
                                 field->kind == FIELD_REFERENCE || (field->kind == FIELD_ONE_OR_SECTIONS && !listed));
  if (!item && !last && !section)
    return refuse(path, "the deck has no '%s' yet, which its items would have to be written into", field->key);
  if (!item && !(item = add_entry(path, map, *key, length))) return 1;
  const Section *below = field ? field->section : NULL;
  *position = (Position){item, position->items ? position->items : section ? below : NULL, section ? NULL : below};
  *key += length + !last;
  return 0;
}

/** The value that a path leads to. NULL after a message. */
static Node *follow(const Path *path, Node *root, const Section *section, const char *key)
{
  Position position = {root, section, NULL};
  while (*key) {
    size_t length;
    if (position.node->kind == NODE_MAP) {
      if (step_into(path, &position, &key)) return NULL;
    } else if (position.node->kind == NODE_LIST) {
      if (!(position.node = item_of(path, position.node, key, &length))) return NULL;
      key += length + (key[length] == '.');
      position.section = position.items;
      position.items = NULL;
    } else {
      refuse(path, "'%s' would stand below the single value '%s'", key, position.node->text);
      return NULL;
    }
  }
  return position.node;
}

int deck_set(Document *document, const Section *section, const char *setting, Error *error)
{
  const char *equal = strchr(setting, '=');
  char *name = text_format("--set %s", setting);
  const char *kept = name ? arena_copy(document->arena, name, strlen(name)) : NULL;
  free(name);
  if (!kept) return error_add(error, BRECCIA_FAILURE, "out of memory: setting");
  const Path path = {document, kept, error};
  if (!equal || equal == setting) return refuse(&path, "expected key.path=value, like 'solve.explicit.end time=5 ms'");
  if (document->root->kind != NODE_MAP) return refuse(&path, "the deck has no keys");
  const char *key = arena_copy(document->arena, setting, (size_t)(equal - setting));
  if (!key) return error_add(error, BRECCIA_FAILURE, "out of memory: setting");
  if (*key == '.' || equal[-1] == '.' || strstr(key, "..")) return refuse(&path, "'%s' has an empty part", key);
  if (!equal[1 + strspn(equal + 1, " ")]) return refuse(&path, "no value is given behind '='");
  Node *value = document_parse_more(document, equal + 1, strlen(equal + 1), kept, true, error);
  Node *node = value ? follow(&path, document->root, section, key) : NULL;
  if (!node) return BRECCIA_USER_ERROR;
  value->key = node->key;
  value->key_line = value->key_column = 0;
  *node = *value;
  return BRECCIA_OK;
}
