#include "cli/verbs.h"
#include "model/deck_layout.h"
#include "results/fields.h"

#include <stdlib.h>

static const Option options[] = {{"markdown", NULL, "the deck reference as a page instead (docs/deck.md)"}, {0}};

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[1];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (first != argc) {
    fprintf(stderr, "breccia schema: '%s' is one argument too many\n", argv[first]);
    return 2;
  }
  int count;
  ParameterTable *tables = law_tables(NULL, &count);
  Text text = {0};
  if (values[0]) {
    describe_markdown(&deck_section, tables, count, &text);
    text_add(&text, "\n## Fields\n\nFor results and pictures; named histories of materials may stand there too.\n\n"
                    "| field | components | meaning |\n|---|---|---|\n");
    for (int k = 0; output_field_at(k); ++k) {
      const OutputField *f = output_field_at(k);
      text_add(&text, "| `%s` |", f->name);
      for (int c = 0; c < f->components; ++c) text_add(&text, " %s", f->component_names ? f->component_names[c] : "");
      text_add(&text, " | %s |\n", f->about);
    }
  } else
    describe_json_schema(&deck_section, tables, count, &text);
  fputs(text_words(&text), stdout);
  text_free(&text);
  free(tables);
  return 0;
}

const Verb verb_schema = {"schema",
                          "[--markdown]",
                          "print a JSON Schema of the deck, for completion in editors",
                          options,
                          "An editor with the YAML language server uses it after a first line like\n"
                          "  # yaml-language-server: $schema=breccia.schema.json",
                          run};
