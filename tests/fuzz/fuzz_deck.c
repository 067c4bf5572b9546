/* Random decks through YAML, expressions, reader and checks, for libFuzzer. A first line "--set ..." is a setting. */
#include "breccia/breccia.h"
#include "deck/resolve.h"
#include "model/deck_layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool same(const Node *a, const Node *b)
{
  if (a->kind != b->kind || a->count != b->count) return false;
  if (a->kind == NODE_SCALAR && strcmp(a->text, b->text) != 0) return false;
  for (int k = 0; k < a->count; ++k)
    if ((a->kind == NODE_MAP && strcmp(a->items[k].key, b->items[k].key) != 0) || !same(&a->items[k], &b->items[k]))
      return false;
  return true;
}

/** A deck that is written and read again is the same. */
static void check_written(const Document *document)
{
  Text words = {0};
  Error *error = breccia_error_create();
  deck_write(document, &words);
  Document *again = document_parse(text_words(&words), words.length, "written", error);
  if (!again || !same(document->root, again->root)) {
    fprintf(stderr, "%s\n%s\n", breccia_error_text(error), text_words(&words));
    abort();
  }
  document_destroy(&again);
  breccia_error_destroy(&error);
  text_free(&words);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char *deck = malloc(size + 1);
  if (!deck) return 0;
  memcpy(deck, data, size);
  deck[size] = 0;
  Error *error = breccia_error_create();
  char *text = deck, *setting = NULL;
  if (!strncmp(deck, "--set ", 6) && (text = strchr(deck, '\n'))) {
    setting = deck + 6;
    *text++ = 0;
  } else
    text = deck;
  Document *document = document_parse(text, strlen(text), "deck", error);
  if (document) {
    static Units *units; /* reading the unit database takes longer than a thousand decks */
    if (!units) units = units_create("m", "kN", "s", error);
    const LawList laws = {0};
    const DeckReader reader = {.document = document, .units = units, .context = &laws, .error = error};
    const char *const settings[] = {setting};
    if (units && !deck_resolve(document, &deck_section, units, settings, setting != NULL, error)) {
      section_read(&reader, document->root, &deck_section);
      check_written(document);
    }
    document_destroy(&document);
  }
  breccia_error_destroy(&error);
  free(deck);
  return 0;
}
