#include "verbs.h"

#include <string.h>

enum { MARKDOWN, OPENSEES };
static const Option options[] = {{"markdown", NULL, "the page of models instead (docs/models.md)"},
                                 {"opensees", NULL, "the laws that the installed OpenSees offers to a deck"},
                                 {0}};

static bool is_law(const char *name)
{
  for (int k = 0; breccia_law_at(k); ++k)
    if (!strcmp(breccia_law_at(k)->name, name)) return true;
  return false;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[sizeof options / sizeof *options];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (refuse_more(argc, argv, verb, first, 1)) return 2;
  breccia_error *error = breccia_error_create();
  const char *name = first < argc ? argv[first] : NULL;
  char *text = NULL;
  int status = BRECCIA_OK;
  if (values[OPENSEES])
    status = breccia_describe_opensees(&text, error);
  else if (values[MARKDOWN])
    text = breccia_page(BRECCIA_PAGE_LAWS);
  else if (!(text = breccia_describe_law(name, error)))
    status = name && !is_law(name) ? BRECCIA_USER_ERROR : BRECCIA_FAILURE;
  if (!status) status = text || error ? print_page(text) : BRECCIA_FAILURE; /* told once */
  breccia_text_free(text);
  return fail(error, status);
}

const Verb verb_models = {.name = "models",
                          .arguments = "[MODEL]",
                          .about = "list constitutive models and formulations with their parameters",
                          .options = options,
                          .run = run};
