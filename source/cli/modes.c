/* How a body vibrates by itself. */
#include "verbs.h"

#include <stdlib.h>

enum { MODES, OUTPUT, SET };

static const Option options[] = {{"count", "N", "how many modes, the slowest first (6)"},
                                 {"output", "FOLDER", "for the files (DECK-modes beside the deck)"},
                                 SET_OPTION,
                                 {0}};

static int find(const char *deck, const char **values, const DeckSettings *settings)
{
  long long count = 6;
  if (values[MODES] && read_whole(values[MODES], "count", 1, 1000000, &count)) return 2;
  breccia_error *error = breccia_error_create();
  const breccia_options wishes = {
      .size = sizeof wishes, .settings = settings->items, .setting_count = settings->count, .loose = 1};
  breccia_model *model;
  int status = breccia_model_load_file(deck, &wishes, &model, error);
  if (status) return fail(error, status);
  if (*breccia_model_warnings(model)) show(breccia_model_warnings(model), stderr);
  char *folder = output_folder(values[OUTPUT], deck, "-modes");
  const breccia_modes wish = {.size = sizeof wish, .folder = folder, .count = (int)count};
  status = folder ? breccia_model_modes(model, &wish, error) : BRECCIA_FAILURE;
  if (!status) status = show(breccia_model_outcome(model), stdout);
  free(folder);
  breccia_model_destroy(&model);
  return fail(error, status);
}

static int run(int argc, char **argv, const Verb *verb)
{
  return act_on_deck(argc, argv, verb, SET, find);
}

const Verb verb_modes = {
    .name = "modes",
    .arguments = "DECK [options]",
    .about = "frequencies and modes of the body as its first stage holds it, and what follows for loading and damping",
    .options = options,
    .more = "Bonds are whole, laws elastic. Modes are written as displacements, each as a step of a result file whose\n"
            "time is the number of the mode; pictures are drawn of all.",
    .run = run};
