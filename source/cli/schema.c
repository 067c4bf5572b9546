#include "verbs.h"

static const Option options[] = {{"markdown", NULL, "the deck reference as a page instead (docs/deck.md)"}, {0}};

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[1];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (refuse_more(argc, argv, verb, first, 0)) return 2;
  char *page = breccia_page(values[0] ? BRECCIA_PAGE_DECK : BRECCIA_PAGE_SCHEMA);
  const int status = print_page(page);
  breccia_text_free(page);
  return status;
}

const Verb verb_schema = {.name = "schema",
                          .arguments = "[--markdown]",
                          .about = "print a JSON Schema of the deck, for completion in editors",
                          .options = options,
                          .more = "An editor with the YAML language server uses it after a first line like\n"
                                  "  # yaml-language-server: $schema=breccia.schema.json",
                          .run = run};
