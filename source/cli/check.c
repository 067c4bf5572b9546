#include "verbs.h"

#include <stdlib.h>

enum { SET, FORCE, COUNT };

static const Option options[] = {SET_OPTION, {"force", NULL, "accept a time step above the stable one"}, {0}};

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  DeckSettings settings;
  if (settings_begin(&settings, SET, argc)) return BRECCIA_FAILURE;
  int first = read_options(argc, argv, verb, values, settings_note, &settings);
  if (first >= 0 && argc - first != 1) {
    fprintf(stderr, "breccia check: give one deck; see 'breccia check --help'\n");
    first = -1;
  }
  if (first < 0) {
    free(settings.items);
    return first == -2 ? 0 : 2;
  }
  breccia_error *error = breccia_error_create();
  const breccia_options wishes = {.size = sizeof wishes,
                                  .force = values[FORCE] != NULL,
                                  .settings = settings.items,
                                  .setting_count = settings.count};
  breccia_model *model;
  int status = breccia_model_load_file(argv[first], &wishes, &model, error);
  if (!status) {
    if (*breccia_model_warnings(model)) fprintf(stderr, "%s\n", breccia_model_warnings(model));
    status = show(breccia_model_overview(model), stdout);
    if (!status) status = show(breccia_model_plausibility(model), stdout);
    breccia_model_destroy(&model);
  }
  free(settings.items);
  return fail(error, status);
}

const Verb verb_check = {.name = "check",
                         .arguments = "DECK [options]",
                         .about = "check a deck and tell what it would run; write nothing",
                         .options = options,
                         .run = run};
