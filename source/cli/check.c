#include "cli/verbs.h"

static const Option options[] = {{"force", NULL, "accept a time step above the stable one"}, {0}};

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[1];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (argc - first != 1) {
    fprintf(stderr, "breccia check: give one deck; see 'breccia check --help'\n");
    return 2;
  }
  breccia_error *error = breccia_error_create();
  const breccia_options wishes = {.force = values[0] != NULL};
  breccia_model *model;
  int status = breccia_model_load_file(argv[first], &wishes, &model, error);
  if (!status) {
    if (*breccia_model_warnings(model)) fprintf(stderr, "%s\n", breccia_model_warnings(model));
    printf("%s\n%s\n", breccia_model_overview(model), breccia_model_plausibility(model));
    breccia_model_destroy(&model);
  }
  return fail(error, status);
}

const Verb verb_check = {"check", "DECK", "check a deck and tell what it would run; write nothing", options, NULL, run};
