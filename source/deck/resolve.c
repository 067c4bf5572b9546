/* Expressions ${...} and the variables that they name. */
#include "deck/resolve.h"

#include "base/memory.h"
#include "deck/expression.h"
#include "deck/spelling.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 1000 };

typedef enum State { UNKNOWN, BEING_FOUND, FOUND, WRONG } State;

typedef struct Resolver {
  Document *document;
  const Units *units;
  Error *error;
  Node *variables; /* NULL: the deck has none */
  State *states;   /* of each variable */
} Resolver;

static int resolve_scalar(Resolver *r, Node *node);

static int variable_index(const Resolver *r, const char *name)
{
  const Node *found = node_get(r->variables, name);
  return found ? (int)(found - r->variables->items) : -1;
}

static bool knows(void *context, const char *name)
{
  return variable_index(context, name) >= 0;
}

static void say_no_variable(const Resolver *r, const char *name, Text *reason)
{
  const int count = r->variables ? r->variables->count : 0;
  const char **names = memory_plain((size_t)count + 1, sizeof *names);
  for (int k = 0; names && k < count; ++k) names[k] = r->variables->items[k].key;
  text_add(reason, "there is no variable '%s'; ", name);
  if (names && count)
    spelling_advice(reason, name, names, count, "the deck's variables are");
  else
    text_add(reason, "give it its value under 'variables', like 'variables: {%s: 5 mm}'", name);
  free(names);
}

/** The text of a variable, worked out. @return NULL with the reason, or without one where that was told at the variable itself */
static const char *variable_text(Resolver *r, const char *name, Text *reason)
{
  const int k = variable_index(r, name);
  if (k < 0) {
    say_no_variable(r, name, reason);
    return NULL;
  }
  Node *node = &r->variables->items[k];
  if (r->states[k] == BEING_FOUND) {
    text_add(reason, "the variable '%s' depends on itself", name);
    return NULL;
  }
  if (r->states[k] == UNKNOWN) {
    r->states[k] = BEING_FOUND;
    r->states[k] = resolve_scalar(r, node) ? WRONG : FOUND;
  }
  return r->states[k] == FOUND ? node->text : NULL;
}

static int find(void *context, const char *name, Measure *value, Text *reason)
{
  Resolver *r = context;
  const char *words = variable_text(r, name, reason);
  if (!words) return 1;
  Text why = {0};
  const int bad = measure_read(r->units, words, value, &why);
  if (bad) text_add(reason, "the variable '%s' cannot be reckoned with: %s", name, text_words(&why));
  text_free(&why);
  return bad;
}

/** Adds what an expression says. @return 0; 1 with the reason and where */
static int add_result(Resolver *r, const char *expression, Text *words, size_t *at, Text *reason)
{
  const char *first = expression + strspn(expression, " \t");
  size_t length = strlen(first);
  while (length && (first[length - 1] == ' ' || first[length - 1] == '\t')) --length;
  *at = (size_t)(first - expression);
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), first);
  if (expression_is_name(first, length) && length < sizeof name && !expression_is_taken(name)) { /* as it was written */
    const char *text = variable_text(r, name, reason);
    if (text) text_add(words, "%s", text);
    return !text;
  }
  const Names names = {find, knows, r};
  Measure value;
  if (expression_read(expression, r->units, &names, &value, at, reason)) return 1;
  return measure_write(&value, words, reason);
}

/** Finds the bracket that closes an expression, beyond others that it holds. @return NULL if there is none */
static const char *closing_bracket(const char *open)
{
  int depth = 0;
  for (const char *c = open; *c; ++c) {
    depth += c[0] == '$' && c[1] == '{';
    if (*c == '}' && --depth == 0) return c;
  }
  return NULL;
}

/** Returns true if an operator stands outside of expressions and behind the first character, as in "${width} * 2". */
static bool has_operator(const char *text)
{
  for (const char *c = text; *c; ++c) {
    const char *close = c[0] == '$' && c[1] == '{' ? closing_bracket(c) : NULL;
    if (close)
      c = close;
    else if (c > text && strchr("+-*/^", *c))
      return true;
  }
  return false;
}

/** Reads a whole scalar as one formula in which the expressions are its values: a quantity keeps its unit in
 *  "${width}^2".
 *  @param[in,out] words  the results in the places of the expressions; that of the formula if the scalar is one */
static void read_formula(Resolver *r, const char *text, Text *words)
{
  const Names names = {find, knows, r};
  Measure value;
  size_t at;
  Text ignored = {0}, result = {0};
  if (!expression_read(text, r->units, &names, &value, &at, &ignored) && !measure_write(&value, &result, &ignored)) {
    text_free(words);
    *words = result;
  } else {
    text_free(&result);
  }
  text_free(&ignored);
}

/** Returns true if words are a number with a unit. */
static bool is_quantity(const Resolver *r, const char *words)
{
  Measure value;
  Text ignored = {0};
  const bool quantity = !measure_read(r->units, words, &value, &ignored) && !measure_is_plain(&value);
  text_free(&ignored);
  return quantity;
}

/** Puts results for the expressions of a scalar. */
static int resolve_scalar(Resolver *r, Node *node)
{
  if (node->kind != NODE_SCALAR || !node->text || !strstr(node->text, "${")) return BRECCIA_OK;
  Text words = {0}, reason = {0};
  Node where = *node;
  int bad = 0;
  bool quantities = false;
  for (const char *next = node->text; *next && !bad;) {
    const char *open = strstr(next, "${"), *close = open ? closing_bracket(open) : NULL;
    text_add(&words, "%.*s", (int)(open ? (size_t)(open - next) : strlen(next)), next);
    if (!open) break;
    size_t at = 0;
    const size_t before = words.length;
    char *expression = close ? text_format("%.*s", (int)(close - open - 2), open + 2) : NULL;
    if (!close) text_add(&reason, "'%s' has no '}' on its line", open);
    bad = !expression || add_result(r, expression, &words, &at, &reason);
    if (where.line && bad) /* as far as one line of text says where */
      where.column += (int)(open - node->text) + (close ? 2 : 0) + (int)at;
    quantities |= !bad && words.length > before && is_quantity(r, text_words(&words) + before);
    if (!bad && words.length > LONGEST) {
      bad = 1;
      text_add(&reason, "the result is longer than %d letters", LONGEST);
    }
    free(expression);
    next = close ? close + 1 : "";
  }
  if (!bad && quantities && has_operator(node->text)) read_formula(r, node->text, &words);
  if (bad && reason.length)
    node_error(r->document, &where, r->error, "%s%s%s", node->key ? node->key : "", node->key ? ": " : "",
               text_words(&reason));
  if (!bad) {
    node->written = node->text;
    node->text = arena_copy(r->document->arena, text_words(&words), words.length);
    if (!node->text) bad = error_add(r->error, BRECCIA_FAILURE, "out of memory: deck");
  }
  text_free(&words);
  text_free(&reason);
  return bad ? BRECCIA_USER_ERROR : BRECCIA_OK;
}

static int resolve_all(Resolver *r, Node *node)
{
  int status = resolve_scalar(r, node);
  for (int k = 0; k < node->count; ++k)
    if (resolve_all(r, &node->items[k])) status = BRECCIA_USER_ERROR;
  return status;
}

/** Whether the variables are names with single values. */
static int check_variables(const Resolver *r)
{
  int status = BRECCIA_OK;
  if (r->variables->kind != NODE_MAP)
    return node_error(r->document, r->variables, r->error,
                      "variables: expected names and values, like 'variables: {width: 0.5 m, spacing: 5 mm}'");
  for (int k = 0; k < r->variables->count; ++k) {
    const Node *item = &r->variables->items[k];
    const Node where = node_of_key(item);
    if (!expression_is_name(item->key, strlen(item->key)) || strlen(item->key) > 63)
      status = node_error(
          r->document, &where, r->error,
          "variables: '%s' is no name for a variable: it begins with a letter, and letters, digits and _ follow",
          item->key);
    else if (expression_is_taken(item->key))
      status =
          node_error(r->document, &where, r->error, "variables: '%s' is a name of the expressions' own", item->key);
    else if (variable_index(r, item->key) != k)
      status = node_error(r->document, &where, r->error, "variables: '%s' is defined twice (first in line %d)",
                          item->key, r->variables->items[variable_index(r, item->key)].key_line);
    else if (item->kind != NODE_SCALAR)
      status =
          node_error(r->document, item, r->error,
                     "variables: '%s' is no single value; what is longer can be marked, '&%s', and used again, '*%s'",
                     item->key, item->key, item->key);
  }
  return status;
}

int deck_resolve(Document *document, const Section *section, const Units *units, const char *const *settings, int count,
                 Error *error)
{
  int status = deck_include(document, error);
  for (int k = 0; k < count && !status; ++k) status = deck_set(document, section, settings[k], error);
  if (status) return status;
  document_order(document);
  Resolver r = {document, units, error, (Node *)(uintptr_t)node_get(document->root, "variables"), NULL};
  if (r.variables && (status = check_variables(&r))) return status;
  r.states = memory_plain((size_t)(r.variables ? r.variables->count : 0) + 1, sizeof *r.states);
  if (!r.states) return error_add(error, BRECCIA_FAILURE, "out of memory: variables");
  for (int k = 0; r.variables && k < r.variables->count; ++k) {
    Text ignored = {0}; /* said where the variable stands */
    if (!variable_text(&r, r.variables->items[k].key, &ignored)) status = BRECCIA_USER_ERROR;
    text_free(&ignored);
  }
  /* A variable without a value would be missed at every place that names it. */
  if (!status) status = resolve_all(&r, document->root);
  free(r.states);
  return status;
}
