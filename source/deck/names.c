#include "deck/names.h"

#include "base/memory.h"
#include "deck/spelling.h"
#include <stdlib.h>
#include <string.h>

/** Where a deck defines them: as keys of a map, or in a list whose items have a name; and of the stages of a run under the same key. */
static const struct {
  const char *what, *key, *stages;
} definitions[] = {{"material", "materials", NULL},
                   {"block", "body", NULL},
                   {"selection", "selections", NULL},
                   {"bar", "bars", NULL},
                   {"load", "loads", "solve"}};

static const char *name_of(const Node *item)
{
  if (item->key) return item->key;
  const Node *name = item->kind == NODE_MAP ? node_get(item, "name") : NULL;
  return name && name->kind == NODE_SCALAR ? name->text : NULL;
}

static bool has_files(const Node *blocks)
{
  for (int k = 0; blocks && k < blocks->count; ++k)
    if (blocks->items[k].kind == NODE_MAP && node_get(&blocks->items[k], "file")) return true;
  return false;
}

/** Whether a map has a key in the place of this one that is probably it, wrongly written: that is told where it stands. */
static bool misspells(const Node *map, const char *key)
{
  if (!map || map->kind != NODE_MAP || node_get(map, key)) return false;
  for (int n = 0; n < map->count; ++n)
    if (map->items[n].key && spelling_nearest(map->items[n].key, &key, 1)) return true;
  return false;
}

/** Whether definitions are there whose key, or whose names' key, is wrongly written. */
static bool are_misspelled(const Node *map, const char *key)
{
  const Node *all = map && map->kind == NODE_MAP ? node_get(map, key) : NULL;
  for (int n = 0; all && all->kind == NODE_LIST && n < all->count; ++n)
    if (misspells(&all->items[n], "name")) return true;
  return misspells(map, key);
}

/** Whether any definitions of a kind are. */
static bool any_misspelled(const Node *root, const char *key, const char *in_stages)
{
  const Node *stages = in_stages ? node_get(root, in_stages) : NULL;
  if (are_misspelled(root, key) || (in_stages && misspells(root, in_stages)) || are_misspelled(stages, key))
    return true;
  for (int n = 0; stages && stages->kind == NODE_LIST && n < stages->count; ++n)
    if (are_misspelled(&stages->items[n], key)) return true;
  return false;
}

/** Adds the names that a node defines. @return how many there are; `names` may be NULL */
static int add_names(const Node *all, const char **names, int count)
{
  for (int n = 0; all && n < all->count; ++n) {
    const char *one = name_of(&all->items[n]);
    if (one && names) names[count] = one;
    count += one != NULL;
  }
  return count;
}

/** The same of all stages, which stand in a list if there are several. */
static int add_names_of_stages(const Node *stages, const char *key, const char **names, int count)
{
  if (stages && stages->kind == NODE_MAP) return add_names(node_get(stages, key), names, count);
  for (int n = 0; stages && n < stages->count; ++n)
    if (stages->items[n].kind == NODE_MAP) count = add_names(node_get(&stages->items[n], key), names, count);
  return count;
}

void name_check(const DeckReader *reader, const Node *node, const char *what, const char *name)
{
  const Node *root = reader->document->root;
  int k = 0;
  while (strcmp(definitions[k].what, what)) ++k;
  const Node *all = node_get(root, definitions[k].key);
  const Node *stages = definitions[k].stages ? node_get(root, definitions[k].stages) : NULL;
  if (all && all->kind == NODE_SCALAR) return;
  if (!strcmp(what, "selection") && has_files(node_get(root, "body"))) return;
  if (all && all->kind == NODE_MAP && node_get(all, name)) return;
  const int most = add_names_of_stages(stages, definitions[k].key, NULL, add_names(all, NULL, 0));
  const char **names = memory_plain((size_t)most + 1, sizeof(char *));
  if (!names) {
    error_add(reader->error, BRECCIA_FAILURE, "out of memory: names of the deck");
    return;
  }
  const int count = add_names_of_stages(stages, definitions[k].key, names, add_names(all, names, 0));
  bool known = false;
  for (int n = 0; n < count; ++n) known |= !strcmp(names[n], name);
  if (!known && (error_is_full(reader->error) || !any_misspelled(root, definitions[k].key, definitions[k].stages)))
    name_unknown(reader, node, what, name, names, count);
  free(names);
}

void name_unknown(const DeckReader *reader, const Node *node, const char *what, const char *name,
                  const char *const *names, int count)
{
  if (error_is_full(reader->error)) { /* thousands of names, each looked for among thousands, would take minutes */
    node_error(reader->document, node, reader->error, "there is no %s '%s'", what, name);
    return;
  }
  Text words = {0};
  for (int k = 0; k < count; ++k) text_add(&words, "%s'%s'", k ? ", " : "", names[k]);
  const char *nearest = spelling_nearest(name, names, count);
  node_error(reader->document, node, reader->error, "there is no %s '%s'; %s%s%sthe deck defines %s%s", what, name,
             nearest ? "did you mean '" : "", nearest ? nearest : "", nearest ? "'? (" : "",
             words.length ? words.characters : "none", nearest ? ")" : "");
  text_free(&words);
}
