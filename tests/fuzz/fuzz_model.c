/* Random decks through model building and a few steps, for libFuzzer. Bodies are kept small, and no law runs in another
 * process. Most mutations exchange words and numbers, so that many a mutant of a good deck is still one. */
#include "breccia/breccia.h"
#include "deck/resolve.h"
#include "model/deck_layout.h"
#include "model/plausibility.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);

enum { STEPS = 3, MOST_CELLS = 4000, MOST_SPACINGS = 10 };

/** What the command tells of a deck. The lowest mode is looked for in bodies of few particles only: it takes as long as hundreds of steps. */
static void tell(breccia_model *model)
{
  enum { MOST_SEARCHED = 100 };
  Text words = {0};
  breccia_model_overview(model);
  if (breccia_model_particles(model) <= MOST_SEARCHED)
    breccia_model_plausibility(model);
  else
    plausibility_describe(model, false, &words);
  text_free(&words);
}

/** Cells of a block with the widest margin that supports can add; infinite if its lattice does not fit. */
static double cells_of(const BlockSpec *block, int b, const PeridynamicsSpec *peridynamics, const DeckReader *reader)
{
  Lattice lattice = {0};
  const MarginList none = {0};
  const Length *horizon = peridynamics ? &peridynamics->horizon : NULL;
  const double reach = !horizon ? 3 : horizon->in_spacings ? horizon->value : horizon->value / block->spacing;
  double cells = 1;
  if (!(reach <= MOST_SPACINGS) || block_place_lattice(block, b, &none, reader, &lattice)) return INFINITY;
  for (int k = 0; k < lattice.dimensions; ++k) cells *= (double)lattice.cells[k] + 2 * ceil(reach);
  return cells;
}

/** Whether the model of a deck would be small and alone in its process. */
static bool is_harmless(const DeckSpec *spec, const DeckReader *reader)
{
  double cells = 0;
  for (int k = 0; k < spec->materials.count; ++k) {
    const MaterialSpec *material = spec->materials.items[k];
    if (material->opensees || material->remote || material->servers.count) return false;
  }
  for (int k = 0; k < spec->body.count; ++k) cells += cells_of(spec->body.items[k], k, spec->peridynamics, reader);
  return cells <= MOST_CELLS;
}

/** A deck that the reader takes, or NULL. @param[out] document  in which it lies */
static const DeckSpec *read_deck(const char *deck, DeckReader *reader, Document **document)
{
  static Units *units; /* reading the unit database takes longer than a thousand decks */
  static const LawList laws;
  if (!units) units = units_create("m", "kN", "s", reader->error);
  reader->document = *document = document_parse(deck, strlen(deck), "deck", reader->error);
  reader->units = units;
  reader->context = &laws;
  if (!reader->document || !units || deck_resolve(*document, &deck_section, units, NULL, 0, reader->error)) return NULL;
  const DeckSpec *spec = section_read(reader, reader->document->root, &deck_section);
  return error_count(reader->error) ? NULL : spec;
}

static struct {
  long tried, read, built, steps, failed;
} counts;

static void tell_counts(void)
{
  fprintf(
      stderr,
      "decks: %ld tried, %ld taken by the reader and small, %ld models built, %ld steps, of which %ld failed with a "
      "reason\n",
      counts.tried, counts.read, counts.built, counts.steps, counts.failed);
}

static void run_deck(const char *deck)
{
  breccia_model *model;
  Error *error = breccia_error_create();
  const breccia_options options = {.size = sizeof options, .threads = 1};
  const int status = breccia_model_load_string(deck, "deck", &options, &model, error);
  if (status) {
    if (status != BRECCIA_USER_ERROR || !error_count(error)) {
      fprintf(stderr, "status %d: %s\n", status, breccia_error_text(error));
      abort();
    }
  } else {
    ++counts.built;
    tell(model);
    for (int k = 0; k < STEPS; ++k)
      if (++counts.steps && breccia_model_step(model, 1, error)) {
        ++counts.failed;
        if (!error_count(error)) abort(); /* a failure without a word */
        break;
      }
  }
  breccia_model_destroy(&model);
  breccia_error_destroy(&error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char *deck = malloc(size + 1);
  if (!deck) return 0;
  memcpy(deck, data, size);
  deck[size] = 0;
  if (!counts.tried++) atexit(tell_counts);
  Document *document;
  DeckReader reader = {.error = breccia_error_create()};
  const DeckSpec *spec = read_deck(deck, &reader, &document);
  const bool harmless = spec && is_harmless(spec, &reader);
  document_destroy(&document);
  breccia_error_destroy(&reader.error);
  counts.read += harmless;
  if (harmless) run_deck(deck);
  free(deck);
  return 0;
}

/* ---- mutations ---- */

static const char *const words[] = {"0",    "-0.0", "1",     "-1",   "2",    "3",     "0.5",       "1e-3", "1e3",
                                    "1e-9", "1e9",  "1e-30", "1e30", "1e50", "-1e50", "1e-50",     "0.49", "0.4999999",
                                    "yes",  "no",   "all",   "free", "1e15", "7",     "[0, 0, 0]", "{}",   "[]"};

/** Where the k-th word of a deck begins, and how long it is; words are what stands between marks of YAML. */
static size_t find_word(const char *deck, size_t size, size_t k, size_t *length)
{
  size_t at = 0, first = size;
  *length = 0;
  for (size_t n = 0; n <= k && at < size; ++n) {
    while (at < size && strchr("{}[],:\n\" ", deck[at])) ++at;
    first = at;
    while (at < size && !strchr("{}[],:\n\"", deck[at])) ++at;
    if (at > first) *length = at - first;
  }
  return first;
}

static size_t count_words(const char *deck, size_t size)
{
  size_t count = 0;
  for (size_t k = 0; k < size; ++k)
    count += !strchr("{}[],:\n\" ", deck[k]) && (k == 0 || strchr("{}[],:\n\"", deck[k - 1]) || deck[k - 1] == ' ');
  return count;
}

/** One word becomes another of the deck, or one of the list. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
  char *deck = (char *)data, word[256];
  const size_t count = count_words(deck, size);
  size_t length, other;
  if (seed % 4 == 0 || !count) return LLVMFuzzerMutate(data, size, most);
  seed /= 4;
  const size_t at = find_word(deck, size, seed % count, &length);
  seed = seed / (unsigned)count + seed * 2654435761u;
  if (seed % 2) {
    snprintf(word, sizeof word, "%s", words[seed / 2 % (sizeof words / sizeof *words)]);
  } else {
    const size_t from = find_word(deck, size, seed / 2 % count, &other);
    snprintf(word, sizeof word, "%.*s", (int)(other < sizeof word ? other : sizeof word - 1), deck + from);
  }
  other = strlen(word);
  if (!length || at + length > size || size - length + other > most) return LLVMFuzzerMutate(data, size, most);
  memmove(deck + at + other, deck + at + length, size - at - length);
  memcpy(deck + at, word, other);
  return size - length + other;
}
