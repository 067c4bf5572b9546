/* The only file that knows libfyaml: it makes the tree of a text. Aliases and merge keys are followed here and not by the library, so that a small file cannot
 * unfold into a huge one. An expression ${...} holds characters that mean something in YAML, above all inside { } and [ ]; they
 * are hidden before the library reads the text, each by one character, so that columns stay. */
#include "deck/yaml.h"

#include "base/memory.h"
#include "base/text.h"
#include <libfyaml.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 40, MOST_COPIES = 100000, MOST_KEYS = 100000 };

typedef struct Builder {
  Document *document;
  const char *file; /* NULL: the document's own */
  bool setting;
  Error *error;
  const char *text; /* that the library reads, with expressions hidden */
  int failed;
  int aliases; /* being followed */
} Builder;

/* ---- expressions ---- */

static const char hidden[] = "{}[],:#"; /* characters of expressions; the k-th is hidden as U+F0A0 + k */

/** The text with the characters of expressions hidden. To be freed. @return NULL when memory is out */
static char *hide_expressions(const char *text, size_t length, size_t *hidden_length)
{
  char *copy = memory_plain(3 * length + 1, 1);
  size_t n = 0;
  for (size_t k = 0; copy && k < length;) {
    const char *end = text[k] == '$' && k + 1 < length && text[k + 1] == '{' ? text + k + 1 : NULL;
    while (end && end < text + length && *end != '}' && *end != '\n') ++end;
    copy[n++] = text[k++];
    if (!end || end == text + length || *end != '}') continue;
    for (; text + k <= end; ++k) {
      const char *found = strchr(hidden, text[k]);
      if (!found || !text[k]) {
        copy[n++] = text[k];
        continue;
      }
      copy[n++] = '\xef';
      copy[n++] = '\x82';
      copy[n++] = (char)(0xa0 + (found - hidden));
    }
  }
  if (copy) copy[n] = 0;
  *hidden_length = n;
  return copy;
}

static void show_expressions(char *text)
{
  char *to = text;
  for (const char *from = text; *from;) {
    const int k = from[0] == '\xef' && from[1] == '\x82' ? (unsigned char)from[2] - 0xa0 : -1;
    if (k >= 0 && k < (int)sizeof hidden - 1) {
      *to++ = hidden[k];
      from += 3;
    } else
      *to++ = *from++;
  }
  *to = 0;
}

/* ---- the tree ---- */

static void refuse(Builder *builder, const Node *node, const char *what)
{
  builder->failed = 1;
  node_error(builder->document, node, builder->error, "%s", what);
}

/** Returns the token of a scalar; NULL if the text has none, as for a missing value. For that, libfyaml 0.7 returns no
 *  token, and libfyaml 0.8 an empty one. */
static struct fy_token *yaml_written_token(struct fy_node *from)
{
  struct fy_token *token = from ? fy_node_get_scalar_token(from) : NULL;
  const bool empty = token && fy_node_get_style(from) == FYNS_PLAIN && !fy_token_get_text_length(token);
  return empty ? NULL : token;
}

static void place_at(const Builder *builder, Node *node, struct fy_node *from)
{
  struct fy_token *token = yaml_written_token(from);
  const struct fy_mark *mark = token ? fy_token_start_mark(token) : NULL;
  if (!mark || builder->setting) return;
  node->line = mark->line + 1;
  node->column = mark->column + 1;
}

/** What stands between single quotation marks: two of them mean one, a line's end with the blanks around it a blank, and each empty line
 *  below it a line's end (YAML 1.2, 7.3.2). libfyaml 0.7 loses characters where quotation marks follow each other. */
static char *single_quoted(Arena *arena, const char *text, size_t length)
{
  char *copy = arena_copy(arena, text, length);
  size_t n = 0;
  for (size_t k = 0; copy && k < length;) {
    if (text[k] != '\n' && text[k] != '\r') {
      k += text[k] == '\'';
      copy[n++] = text[k++];
      continue;
    }
    size_t ends = 0;
    while (n && (copy[n - 1] == ' ' || copy[n - 1] == '\t')) --n;
    for (; k < length && strchr(" \t\r\n", text[k]); ++k) ends += text[k] == '\n';
    if (ends < 2) copy[n++] = ' ';
    for (; ends > 1; --ends) copy[n++] = '\n';
  }
  if (copy) copy[n] = 0;
  return copy;
}

static void build_scalar(Builder *builder, struct fy_node *from, Node *node)
{
  Arena *arena = builder->document->arena;
  struct fy_token *token =
      from && fy_node_get_style(from) == FYNS_SINGLE_QUOTED ? fy_node_get_scalar_token(from) : NULL;
  const struct fy_mark *start = token ? fy_token_start_mark(token) : NULL,
                       *end = token ? fy_token_end_mark(token) : NULL;
  size_t length = start && end ? end->input_pos - start->input_pos : 0;
  const char *text = start && end ? builder->text + start->input_pos : from ? fy_node_get_scalar(from, &length) : NULL;
  if (!text) text = "", length = 0;
  char *copy = (start && end ? single_quoted : arena_copy)(arena, text, length);
  node->kind = NODE_SCALAR;
  node->text = copy;
  if (!copy) {
    builder->failed = 1;
    return;
  }
  if (memchr(text, 0, length)) refuse(builder, node, "a zero byte in the text");
  if (strchr(copy, '$')) show_expressions(copy);
}

static void build(Builder *builder, struct fy_node *from, Node *node, int depth);

static void build_alias(Builder *builder, struct fy_node *from, Node *node, int depth)
{
  size_t length = 0;
  const char *name = fy_node_get_scalar(from, &length);
  struct fy_node *target = fy_node_resolve_alias(from);
  node->column -= node->line > 0; /* the library means the name behind the star */
  if (!target) {
    builder->failed = 1;
    node_error(
        builder->document, node, builder->error,
        "there is no anchor '&%.*s' before the alias '*%.*s'; mark the value to be used again, like '&%.*s 5 mm'",
        (int)length, name, (int)length, name, (int)length, name);
    return;
  }
  ++builder->aliases;
  const Node where = *node;
  build(builder, target, node, depth);
  --builder->aliases;
  if (node->line) return;
  node->line = where.line; /* an empty value stands nowhere */
  node->column = where.column;
}

static bool is_merge(const Node *key, struct fy_node *from)
{
  return key->kind == NODE_SCALAR && key->text && !strcmp(key->text, "<<") && fy_node_get_style(from) == FYNS_PLAIN;
}

/** Adds the entries of a map that merge keys name: what the map says itself comes first, and then what was merged before. */
static void merge_into(Builder *builder, Node *node, const Node *merged)
{
  if (merged->kind == NODE_LIST) {
    for (int k = 0; k < merged->count; ++k) merge_into(builder, node, &merged->items[k]);
    return;
  }
  if (merged->kind != NODE_MAP) {
    refuse(builder, merged, "'<<' takes in the keys of a map, like '<<: *common', where '&common' marks the map");
    return;
  }
  Node *items = arena_zeroed(builder->document->arena, sizeof(Node) * (size_t)(node->count + merged->count + 1));
  if (!items) {
    builder->failed = 1;
    return;
  }
  if (node->count) memcpy(items, node->items, sizeof(Node) * (size_t)node->count);
  int count = node->count;
  node_order(builder->document, node);
  for (int k = 0; k < merged->count; ++k)
    if (!node_get(node, merged->items[k].key)) items[count++] = merged->items[k];
  node->by_key = NULL;
  node->items = items;
  node->count = count;
}

static void build_entry(Builder *builder, struct fy_node_pair *pair, Node *item, bool *merges, int depth)
{
  struct fy_node *key = pair ? fy_node_pair_key(pair) : NULL;
  Node where = *item;
  build(builder, key, &where, depth + 1);
  item->key = where.kind == NODE_SCALAR && where.text ? where.text : "?";
  item->line = item->key_line = where.line;
  item->column = item->key_column = where.column;
  *merges = key && is_merge(&where, key);
  const bool nothing = !key || (fy_node_is_scalar(key) && !yaml_written_token(key)); /* which stands nowhere */
  if (where.kind != NODE_SCALAR) refuse(builder, item, "a key must be words");
  if (strstr(item->key, "${")) refuse(builder, item, "a key cannot hold an expression: ${...} stands in values");
  if (nothing) item->line = 0; /* so that a list or map finds where it stands itself */
  build(builder, pair ? fy_node_pair_value(pair) : NULL, item, depth + 1);
  if (!nothing) return;
  if (!item->line) item->line = where.line, item->column = where.column;
  item->key_line = item->line;
  item->key_column = item->column;
  refuse(builder, item, "no key stands before this value; a key is words with a colon behind");
}

static void build(Builder *builder, struct fy_node *from, Node *node, int depth)
{
  Arena *arena = builder->document->arena;
  node->file = builder->file;
  place_at(builder, node, from);
  if (depth > DEEPEST) {
    refuse(builder, node,
           builder->aliases ? "nested too deeply; does an alias stand inside the value that it names?"
                            : "nested too deeply");
    return;
  }
  if (builder->aliases && ++builder->document->copies > MOST_COPIES) {
    if (builder->document->copies == MOST_COPIES + 1)
      refuse(builder, node,
             "aliases unfold into more than 100000 values; does one stand inside the value that it names?");
    return;
  }
  if (from && fy_node_is_alias(from)) {
    build_alias(builder, from, node, depth + 1);
    return;
  }
  if (!from || fy_node_is_scalar(from)) {
    build_scalar(builder, from, node);
    return;
  }
  const bool map = fy_node_is_mapping(from);
  const int count = map ? fy_node_mapping_item_count(from) : fy_node_sequence_item_count(from);
  node->kind = map ? NODE_MAP : NODE_LIST;
  if (map && count > MOST_KEYS) {
    char words[80];
    snprintf(words, sizeof words, "%d keys in one map are too many; it may hold %d", count, MOST_KEYS);
    refuse(builder, node, words);
    return;
  }
  node->items = arena_zeroed(arena, sizeof(Node) * (size_t)(count > 0 ? count : 1));
  Node *merged = map ? arena_zeroed(arena, sizeof(Node) * (size_t)(count > 0 ? count : 1)) : NULL;
  if (!node->items || (map && !merged)) {
    builder->failed = 1;
    return;
  }
  void *iterator = NULL;
  int merged_count = 0;
  for (int k = 0; k < count; ++k) {
    Node *item = &node->items[node->count];
    bool merges = false;
    item->file = node->file;
    item->line = node->line;
    item->column = node->column;
    if (map)
      build_entry(builder, fy_node_mapping_iterate(from, &iterator), item, &merges, depth);
    else
      build(builder, fy_node_sequence_iterate(from, &iterator), item, depth + 1);
    if (k == 0 && (!node->line || !node->key)) { /* a list or map stands where its first item stands */
      node->line = map ? item->key_line : item->line;
      node->column = map ? item->key_column : item->column;
    }
    if (merges) {
      merged[merged_count++] = *item;
      *item = (Node){0};
    } else
      ++node->count;
  }
  for (int k = 0; k < merged_count; ++k) merge_into(builder, node, &merged[k]);
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

/** Line at which a second document begins, or text behind the end of the first; 0 if there is none. The library reads the first and no more. */
static int second_line(const char *text, size_t length)
{
  int line = 1;
  bool something = false, ended = false;
  for (size_t k = 0; k < length; ++line) {
    const char *row = text + k, *end = memchr(row, '\n', length - k);
    const size_t size = end ? (size_t)(end - row) : length - k;
    const bool mark = size >= 3 && (size == 3 || strchr(" \t\r", row[3]));
    size_t blanks = 0;
    while (blanks < size && strchr(" \t\r", row[blanks])) ++blanks;
    const bool empty = blanks == size || row[blanks] == '#';
    if (!empty && ended) return line;
    if (mark && !memcmp(row, "...", 3))
      ended = true;
    else if (mark && something && !memcmp(row, "---", 3))
      return line;
    else
      something |= !empty;
    k += size + 1;
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
      {"mismatched flow", "a bracket is opened and not closed, or closed and not opened"},
      {"in sequence while in mapping", "each item of this list begins with '- ', and all in the same column"},
      {"unterminated", "a quotation mark or bracket is not closed"},
  };
  for (size_t k = 0; k < sizeof advice / sizeof *advice; ++k)
    if (strstr(message, advice[k][0])) return advice[k][1];
  return "";
}

/** Says what the library found wrong. */
static void tell_problem(const char *name, bool setting, struct fy_diag *diagnostics, Error *error)
{
  void *iterator = NULL;
  struct fy_diag_error *problem = diagnostics ? fy_diag_errors_iterate(diagnostics, &iterator) : NULL;
  char where[32] = "";
  if (problem && !setting) snprintf(where, sizeof where, ":%d:%d", problem->line, problem->column);
  if (problem) {
    const char *message = problem->msg ? problem->msg : "it cannot be read", *advice = yaml_advice(message);
    error_add(error, BRECCIA_USER_ERROR, "%s%s: not valid YAML: %s%s%s%s", name, where, advice, *advice ? " (" : "",
              message, *advice ? ")" : "");
  } else
    error_add(error, BRECCIA_USER_ERROR, "%s:1:1: the deck is empty; 'breccia new' writes one to start from", name);
}

/** Says where the first byte stands that is no UTF-8, if there is one: the library looks at most of a text, but not at all of it. */
static int refuse_no_utf8(const char *text, size_t length, const char *name, bool setting, Error *error)
{
  const size_t right = text_utf8(text, length);
  if (right == length) return 0;
  const int byte = (unsigned char)text[right];
  if (setting) return error_add(error, BRECCIA_USER_ERROR, "%s: byte 0x%02x is no UTF-8 text", name, byte);
  int line = 1, column = 1;
  for (size_t k = 0; k < right; ++k) {
    line += text[k] == '\n';
    column = text[k] == '\n' ? 1 : column + (((unsigned char)text[k] & 0xc0) != 0x80);
  }
  return error_add(error, BRECCIA_USER_ERROR, "%s:%d:%d: byte 0x%02x is no UTF-8 text: save the file as UTF-8", name,
                   line, column, byte);
}

int yaml_parse(Document *document, Node *root, const char *text, size_t length, const char *name, bool setting,
               Error *error)
{
  if (refuse_no_utf8(text, length, name, setting, error)) return BRECCIA_USER_ERROR;
  const int directive = directive_line(text, length);
  if (directive)
    return error_add(error, BRECCIA_USER_ERROR, "%s:%d:1: not valid YAML for a deck: a line must not begin with %%",
                     name, directive);
  const int second = second_line(text, length);
  if (second)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s:%d:1: a file holds one deck, and what stands here would not be read: leave out the line '---' "
                     "or '...', or put it into a file of its own",
                     name, second);
  char *plain = hide_expressions(text, length, &length);
  if (!plain) return error_add(error, BRECCIA_FAILURE, "out of memory: deck");
  struct fy_diag_cfg quiet;
  fy_diag_cfg_default(&quiet);
  quiet.fp = NULL;
  quiet.colorize = false;
  struct fy_diag *diagnostics = fy_diag_create(&quiet);
  fy_diag_set_collect_errors(diagnostics, true);
  struct fy_parse_cfg configuration = {.flags = FYPCF_QUIET | FYPCF_ALLOW_DUPLICATE_KEYS, .diag = diagnostics};
  struct fy_document *yaml = fy_document_build_from_string(&configuration, plain, length);
  int failed = !yaml;
  if (!yaml) {
    tell_problem(name, setting, diagnostics, error);
  } else {
    const int before = error_count(error);
    Builder builder = {.document = document, .file = root->file, .setting = setting, .error = error, .text = plain};
    root->line = root->column = setting ? 0 : 1;
    build(&builder, fy_document_root(yaml), root, 0);
    failed = builder.failed;
    if (failed && error_count(error) == before) error_add(error, BRECCIA_FAILURE, "out of memory: deck");
    fy_document_destroy(yaml);
  }
  fy_diag_destroy(diagnostics);
  free(plain);
  return failed;
}
