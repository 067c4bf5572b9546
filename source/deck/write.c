/* A document as YAML again. */
#include "deck/resolve.h"

#include <ctype.h>
#include <string.h>

/** True if words read as themselves without quotation marks, in braces and brackets too. */
static bool is_plain(const char *words)
{
  const size_t n = strlen(words);
  if (!n || !(isalnum((unsigned char)*words) || strchr("-+.", *words)) || words[n - 1] == ' ') return false;
  if ((*words == '-' || *words == '.') && !isdigit((unsigned char)words[1]) && words[1] != '.') return false;
  for (const char *c = words; *c; ++c)
    if (!isalnum((unsigned char)*c) && !strchr(" -+.*/%^_()", *c)) return false;
  return true;
}

static void write_words(const char *words, Text *text)
{
  if (is_plain(words))
    text_add(text, "%s", words);
  else
    text_add_json(text, words);
}

static bool holds_maps(const Node *node)
{
  for (int k = 0; k < node->count; ++k)
    if (node->items[k].kind == NODE_MAP || holds_maps(&node->items[k])) return true;
  return false;
}

/** In one line, with braces and brackets. */
static void write_flow(const Node *node, Text *text)
{
  if (node->kind == NODE_SCALAR) {
    write_words(node->text, text);
    return;
  }
  text_add(text, node->kind == NODE_MAP ? "{" : "[");
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    text_add(text, "%s", k ? ", " : "");
    if (node->kind == NODE_MAP) {
      write_words(item->key, text);
      text_add(text, ": ");
    }
    write_flow(item, text);
  }
  text_add(text, node->kind == NODE_MAP ? "}" : "]");
}

static void write_block(const Node *node, int indent, Text *text)
{
  for (int k = 0; k < node->count; ++k) {
    const Node *item = &node->items[k];
    text_add(text, "%*s", indent, "");
    if (node->kind == NODE_MAP) {
      write_words(item->key, text);
      text_add(text, ":");
    } else
      text_add(text, "-");
    if (item->count && node->kind == NODE_MAP && (item->kind == NODE_MAP || holds_maps(item))) {
      text_add(text, "\n");
      write_block(item, indent + 2, text);
    } else {
      text_add(text, " ");
      write_flow(item, text);
      text_add(text, "\n");
    }
  }
}

void deck_write(const Document *document, Text *text)
{
  const Node *root = document->root;
  if (root->kind == NODE_SCALAR || !root->count) {
    write_flow(root, text);
    text_add(text, "\n");
  } else
    write_block(root, 0, text);
}
