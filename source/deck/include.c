/* Files that decks take in. A map with the key `include` has the keys of the named files too; what it says itself holds, and maps
 * under one key are joined in the same way, so that a deck can change one number of what it takes in. */
#include "base/text.h"
#include "deck/resolve.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { DEEPEST = 16, MOST_FILES = 200 };

typedef struct Files {
  Document *document;
  Error *error;
  struct stat open[DEEPEST]; /* the files that are being taken in, the outermost first */
  int depth, read;
} Files;

static int out_of_memory(const Files *files)
{
  return error_add(files->error, BRECCIA_FAILURE, "out of memory: deck");
}

static void drop(Node *map, int k)
{
  memmove(&map->items[k], &map->items[k + 1], sizeof(Node) * (size_t)(map->count - k - 1));
  --map->count;
  map->by_key = NULL;
}

/** Adds to a map what another has under keys that it lacks, and joins maps that both have. */
static int join(Files *files, Node *map, const Node *other)
{
  Node *items = arena_zeroed(files->document->arena, sizeof(Node) * (size_t)(map->count + other->count + 1));
  if (!items) return out_of_memory(files);
  if (map->count) memcpy(items, map->items, sizeof(Node) * (size_t)map->count);
  map->items = items;
  node_order(files->document, map);
  int count = map->count, status = BRECCIA_OK;
  for (int k = 0; k < other->count && !status; ++k) {
    const Node *theirs = &other->items[k], *known = node_get(map, theirs->key);
    Node *mine = known ? &items[known - items] : NULL;
    if (!mine)
      items[count++] = *theirs;
    else if (mine->kind == NODE_MAP && theirs->kind == NODE_MAP)
      status = join(files, mine, theirs);
  }
  map->by_key = NULL;
  map->count = count;
  return status;
}

static int take_in(Files *files, Node *map);

/** Reads a file named by a node and joins it to a map. */
static int take_file(Files *files, Node *map, const Node *name)
{
  Document *document = files->document;
  if (name->kind != NODE_SCALAR || !*name->text)
    return node_error(document, name, files->error, "include: expected the name of a file, or a list of names");
  if (strstr(name->text, "${"))
    return node_error(document, name, files->error, "include: '%s': names of files hold no expressions", name->text);
  char *path = text_beside(node_file(document, name), name->text);
  struct stat status;
  int bad = BRECCIA_OK;
  if (!path)
    bad = out_of_memory(files);
  else if (stat(path, &status))
    bad = node_error(document, name, files->error, "include: %s: %s", path, strerror(errno));
  else if (!S_ISREG(status.st_mode) || status.st_size > DOCUMENT_LARGEST)
    bad = node_error(document, name, files->error, "include: %s: is not a file of at most %d MB", path,
                     DOCUMENT_LARGEST >> 20);
  else if (files->depth == DEEPEST || files->read == MOST_FILES)
    bad = node_error(document, name, files->error, "include: %s: too many files include each other", path);
  for (int k = 0; k < files->depth && !bad; ++k)
    if (files->open[k].st_dev == status.st_dev && files->open[k].st_ino == status.st_ino)
      bad = node_error(document, name, files->error, "include: %s: includes itself%s", path,
                       k + 1 < files->depth ? " by way of other files" : "");
  size_t length;
  char *text = bad ? NULL : document_text(path, &length, files->error);
  Node *root = text ? document_parse_more(document, text, length, path, false, files->error) : NULL;
  if (!bad && !root) bad = BRECCIA_USER_ERROR;
  if (!bad && root->kind != NODE_MAP)
    bad = node_error(document, root, files->error, "an included file holds keys and values");
  if (!bad) {
    files->open[files->depth++] = status;
    ++files->read;
    bad = take_in(files, root);
    if (!bad) bad = join(files, map, root);
    --files->depth;
  }
  free(text);
  free(path);
  return bad;
}

/** Takes in what a node and the maps below it include. */
static int take_in(Files *files, Node *node)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < node->count; ++k) {
    const int bad = take_in(files, &node->items[k]);
    if (bad) status = bad;
  }
  for (int k = 0; node->kind == NODE_MAP && k < node->count; ++k) {
    if (strcmp(node->items[k].key, "include") != 0) continue;
    const Node names = node->items[k];
    drop(node, k--);
    for (int f = 0; f < (names.kind == NODE_LIST ? names.count : 1); ++f) {
      const int bad = take_file(files, node, names.kind == NODE_LIST ? &names.items[f] : &names);
      if (bad) return bad;
    }
  }
  return status;
}

int deck_include(Document *document, Error *error)
{
  Files files = {.document = document, .error = error};
  if (!stat(document->name, &files.open[0])) files.depth = 1; /* a text from a program has no file */
  return take_in(&files, document->root);
}
