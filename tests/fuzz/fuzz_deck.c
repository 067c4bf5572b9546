/* Random decks through YAML, reader and checks, for libFuzzer. */
#include "breccia/breccia.h"
#include "model/deck_layout.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char *deck = malloc(size + 1);
  if (!deck) return 0;
  memcpy(deck, data, size);
  deck[size] = 0;
  Error *error = breccia_error_create();
  Document *document = document_parse(deck, strlen(deck), "deck", error);
  if (document) {
    static Units *units; /* reading the unit database takes longer than a thousand decks */
    if (!units) units = units_create("m", "kN", "s", error);
    const LawList laws = {0};
    const DeckReader reader = {document, units, &laws, error};
    if (units) section_read(&reader, document->root, &deck_section);
    document_destroy(&document);
  }
  breccia_error_destroy(&error);
  free(deck);
  return 0;
}
