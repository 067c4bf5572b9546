/* The only file that knows libfyaml. Aliases and merge keys are refused: a deck should read from top to bottom, and
 * they would let a small file unfold into a huge one. */
#include "deck/document.h"

#include "base/text.h"
#include <errno.h>
#include <libfyaml.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 40 };

typedef struct Builder {
  Document *document;
  Error *error;
  int failed;
} Builder;

static void refuse(Builder *builder, const Node *node, const char *what)
{
  builder->failed = 1;
  node_error(builder->document, node, builder->error, "%s", what);
}

static void place_at(Node *node, struct fy_node *from)
{
  struct fy_token *token = from ? fy_node_get_scalar_token(from) : NULL;
  const struct fy_mark *mark = token ? fy_token_start_mark(token) : NULL;
  if (!mark) return;
  node->line = mark->line + 1;
  node->column = mark->column + 1;
}

static void build(Builder *builder, struct fy_node *from, Node *node, int depth)
{
  Arena *arena = builder->document->arena;
  place_at(node, from);
  if (depth > DEEPEST) {
    refuse(builder, node, "nested too deeply");
    return;
  }
  if (from && fy_node_is_alias(from)) {
    refuse(builder, node, "aliases (*name) are not understood; write the value out");
    return;
  }
  if (!from || fy_node_is_scalar(from)) {
    size_t length = 0;
    const char *text = from ? fy_node_get_scalar(from, &length) : "";
    node->kind = NODE_SCALAR;
    node->text = arena_copy(arena, text ? text : "", text ? length : 0);
    enum fy_node_style style = from ? fy_node_get_style(from) : FYNS_PLAIN;
    node->quoted = style == FYNS_SINGLE_QUOTED || style == FYNS_DOUBLE_QUOTED;
    if (node->text && memchr(node->text, 0, length)) refuse(builder, node, "a zero byte in the text");
    if (!node->text) builder->failed = 1;
    return;
  }
  bool map = fy_node_is_mapping(from);
  node->kind = map ? NODE_MAP : NODE_LIST;
  node->count = map ? fy_node_mapping_item_count(from) : fy_node_sequence_item_count(from);
  node->items = arena_zeroed(arena, sizeof(Node) * (size_t)(node->count > 0 ? node->count : 1));
  if (!node->items) {
    builder->failed = 1;
    return;
  }
  void *iterator = NULL;
  for (int k = 0; k < node->count; ++k) {
    Node *item = &node->items[k];
    item->line = node->line;
    item->column = node->column;
    if (!map) {
      build(builder, fy_node_sequence_iterate(from, &iterator), item, depth + 1);
    } else {
      struct fy_node_pair *pair = fy_node_mapping_iterate(from, &iterator);
      struct fy_node *key = pair ? fy_node_pair_key(pair) : NULL;
      Node place = *item;
      build(builder, key, &place, depth + 1);
      item->key = place.kind == NODE_SCALAR && place.text ? place.text : "?";
      item->line = item->key_line = place.line;
      item->column = item->key_column = place.column;
      if (place.kind != NODE_SCALAR) refuse(builder, item, "a key must be words");
      build(builder, pair ? fy_node_pair_value(pair) : NULL, item, depth + 1);
    }
    if (k == 0 && (!node->line || !node->key)) { /* a list or map stands where its first item stands */
      node->line = map ? item->key_line : item->line;
      node->column = map ? item->key_column : item->column;
    }
  }
}

/** Line of the first directive (% at the start of a line), or 0. The library scans some of them for ever, and a deck has no
 *  use for any. */
static int directive_line(const char *text, size_t length)
{
  int line = 1;
  bool start = true;
  for (size_t k = 0; k < length; ++k) {
    if (start && text[k] == '%') return line;
    bool mark = line == 1 && k < 3 && (unsigned char)text[k] >= 0xbb; /* of byte order */
    if (!mark) start = text[k] == '\n' || text[k] == '\r';
    line += text[k] == '\n';
  }
  return 0;
}

/** What to do about a message of the library, for people who know no YAML; "" if nothing is known. */
static const char *yaml_advice(const char *message)
{
  static const char *const advice[][2] = {
      {"tab", "indent with blanks, not with tabs"},
      {"invalid indentation", "keys that belong together must begin in the same column"},
      {"multiline plain key", "this line and the one before are read as one: look whether both begin in the right "
                              "column, and whether a ':' or "
                              "a quotation mark is missing"},
      {"expected ':'", "a key ends with a colon and a blank, like 'spacing: 10'"},
      {"nested block mapping", "words that hold ': ' must stand in quotation marks"},
      {"missing comma",
       "inside { } and [ ] a comma parts items, each bracket is closed, and words that hold ': ' stand in quotation "
       "marks"},
      {"unterminated", "a quotation mark or bracket is not closed"},
  };
  for (size_t k = 0; k < sizeof advice / sizeof *advice; ++k)
    if (strstr(message, advice[k][0])) return advice[k][1];
  return "";
}

Document *document_parse(const char *text, size_t length, const char *name, Error *error)
{
  int directive = directive_line(text, length);
  if (directive) {
    error_add(error, BRECCIA_USER_ERROR, "%s:%d:1: not valid YAML for a deck: a line must not begin with %%", name,
              directive);
    return NULL;
  }
  Document *document = calloc(1, sizeof *document);
  Arena *arena = arena_create();
  if (!document || !arena || !(document->root = arena_zeroed(arena, sizeof(Node)))) {
    error_add(error, BRECCIA_FAILURE, "out of memory: deck");
    free(document);
    arena_destroy(&arena);
    return NULL;
  }
  document->arena = arena;
  document->name = arena_copy(arena, name, strlen(name));
  struct fy_diag_cfg quiet;
  fy_diag_cfg_default(&quiet);
  quiet.fp = NULL;
  quiet.colorize = false;
  struct fy_diag *diagnostics = fy_diag_create(&quiet);
  fy_diag_set_collect_errors(diagnostics, true);
  struct fy_parse_cfg configuration = {.flags = FYPCF_QUIET | FYPCF_ALLOW_DUPLICATE_KEYS, .diag = diagnostics};
  struct fy_document *yaml = fy_document_build_from_string(&configuration, text, length);
  int failed = !yaml;
  if (!yaml) {
    void *iterator = NULL;
    struct fy_diag_error *problem = diagnostics ? fy_diag_errors_iterate(diagnostics, &iterator) : NULL;
    if (problem) {
      const char *message = problem->msg ? problem->msg : "it cannot be read", *advice = yaml_advice(message);
      error_add(error, BRECCIA_USER_ERROR, "%s:%d:%d: not valid YAML: %s%s%s%s", name, problem->line, problem->column,
                advice, *advice ? " (" : "", message, *advice ? ")" : "");
    } else
      error_add(error, BRECCIA_USER_ERROR, "%s:1:1: the deck is empty; 'breccia new' writes one to start from", name);
  } else {
    Builder builder = {document, error, 0};
    document->root->line = document->root->column = 1;
    build(&builder, fy_document_root(yaml), document->root, 0);
    failed = builder.failed;
    if (failed && !error_count(error)) error_add(error, BRECCIA_FAILURE, "out of memory: deck");
    fy_document_destroy(yaml);
  }
  fy_diag_destroy(diagnostics);
  if (failed) document_destroy(&document);
  return document;
}

void document_destroy(Document **document)
{
  if (!document || !*document) return;
  arena_destroy(&(*document)->arena);
  free(*document);
  *document = NULL;
}

const Node *node_get(const Node *map, const char *key)
{
  if (!map || map->kind != NODE_MAP) return NULL;
  for (int k = 0; k < map->count; ++k)
    if (!strcmp(map->items[k].key, key)) return &map->items[k];
  return NULL;
}

int node_error(const Document *document, const Node *node, Error *error, const char *format, ...)
{
  Text words = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&words, format, arguments);
  va_end(arguments);
  error_add(error, BRECCIA_USER_ERROR, "%s:%d:%d: %s", document->name, node->line, node->column, text_words(&words));
  text_free(&words);
  return BRECCIA_USER_ERROR;
}

char *document_text(const char *path, size_t *length, Error *error)
{
  char *text = text_read_file(path, length);
  if (!text) {
    error_add(error, BRECCIA_USER_ERROR, "%s: cannot be read: %s", path, strerror(errno));
  } else if (strlen(text) != *length) {
    error_add(error, BRECCIA_USER_ERROR, "%s:1:1: is not text: it holds a zero byte", path);
    free(text);
    text = NULL;
  }
  return text;
}
