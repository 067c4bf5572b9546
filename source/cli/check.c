#include "verbs.h"

enum { SET, FORCE };

static const Option options[] = {SET_OPTION, {"force", NULL, "accept a time step above the stable one"}, {0}};

static int check(const char *deck, const char **values, const DeckSettings *settings)
{
  breccia_error *error = breccia_error_create();
  const breccia_options wishes = {.size = sizeof wishes,
                                  .force = values[FORCE] != NULL,
                                  .settings = settings->items,
                                  .setting_count = settings->count};
  breccia_model *model;
  int status = breccia_model_load_file(deck, &wishes, &model, error);
  if (!status) {
    if (*breccia_model_warnings(model)) show(breccia_model_warnings(model), stderr);
    status = show(breccia_model_overview(model), stdout);
    if (!status) status = show(breccia_model_plausibility(model), stdout);
    breccia_model_destroy(&model);
  }
  return fail(error, status);
}

static int run(int argc, char **argv, const Verb *verb)
{
  return act_on_deck(argc, argv, verb, SET, check);
}

const Verb verb_check = {.name = "check",
                         .arguments = "DECK [options]",
                         .about = "check a deck and tell what it would run; write nothing",
                         .options = options,
                         .run = run};
