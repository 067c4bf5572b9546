#include "deck/names.h"

#include "base/memory.h"
#include "deck/spelling.h"
#include <stdlib.h>
#include <string.h>

/** Where a deck defines them: as keys of a map, or in a list whose items have a name. */
static const struct {
  const char *what, *key;
} definitions[] = {{"material", "materials"}, {"block", "body"}, {"selection", "selections"}, {"load", "loads"}};

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

void name_check(const DeckReader *reader, const Node *node, const char *what, const char *name)
{
  const Node *root = reader->document->root;
  int k = 0, count = 0;
  while (strcmp(definitions[k].what, what)) ++k;
  const Node *all = node_get(root, definitions[k].key);
  if (all && all->kind == NODE_SCALAR) return;
  if (!strcmp(what, "selection") && has_files(node_get(root, "body"))) return;
  if (all && all->kind == NODE_MAP && node_get(all, name)) return;
  const char **names = memory_plain((size_t)((all ? all->count : 0) + 1), sizeof(char *));
  if (!names) {
    error_add(reader->error, BRECCIA_FAILURE, "out of memory: names of the deck");
    return;
  }
  bool known = false;
  for (int n = 0; all && n < all->count; ++n) {
    const char *one = name_of(&all->items[n]);
    if (!one) continue;
    known |= !strcmp(one, name);
    names[count++] = one;
  }
  if (!known) name_unknown(reader, node, what, name, names, count);
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
