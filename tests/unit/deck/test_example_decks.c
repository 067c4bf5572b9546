/* Decks of the examples: every one makes a model. Decks with laws of OpenSees need its server, and those without a body are laboratory tests;
 * tests/command/documents.sh tries these. */
#include "support.h"

#include <glob.h>

static char *read_deck(const char *path)
{
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("%s cannot be opened", path);
  char *deck = calloc(1, 1 << 17);
  const size_t length = deck ? fread(deck, 1, (1 << 17) - 1, file) : 0;
  fclose(file);
  assert_true(length > 0);
  return deck;
}

static void every_deck_makes_a_model(void **state)
{
  (void)state;
  glob_t found;
  int loaded = 0;
  assert_int_equal(glob(EXAMPLES "/*/*.yaml", 0, NULL, &found), 0);
  for (size_t k = 0; k < found.gl_pathc; ++k) {
    if (under_sanitizers() && k % 5) continue;
    char *deck = read_deck(found.gl_pathv[k]);
    const bool of_a_body = strstr(deck, "\nbody:") || strstr(deck, "\ninclude:");
    if (of_a_body && !strstr(deck, " opensees: ")) {
      breccia_error *error = breccia_error_create();
      breccia_model *model;
      if (breccia_model_load_file(found.gl_pathv[k], NULL, &model, error))
        fail_msg("%s is refused: %s", found.gl_pathv[k], breccia_error_text(error));
      breccia_error_destroy(&error);
      breccia_model_destroy(&model);
      ++loaded;
    }
    free(deck);
  }
  globfree(&found);
  assert_true(loaded > (under_sanitizers() ? 6 : 30));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_deck_makes_a_model)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
