#include "support.h"

breccia_model *model_of(const char *format, ...)
{
  Text deck = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&deck, format, arguments);
  va_end(arguments);
  breccia_error *error = breccia_error_create();
  breccia_model *model;
  int status = breccia_model_load_string(deck.characters, "deck", NULL, &model, error);
  text_free(&deck);
  if (status) fail_msg("the deck was refused: %s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return model;
}

char *refusal_of(const char *deck)
{
  breccia_error *error = breccia_error_create();
  breccia_model *model;
  int status = breccia_model_load_string(deck, "deck", NULL, &model, error);
  if (!status) fail_msg("the deck was accepted: %s", deck);
  char *words = text_format("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return words;
}

void assert_near_at(double a, double b, double tolerance, const char *what, const char *file, int line)
{
  if (fabs(a - b) <= tolerance) return;
  print_error("%s:%d: %s is %.17g, expected %.17g within %g\n", file, line, what, a, b, tolerance);
  _fail(file, line);
}

void deform_uniformly(breccia_model *model, const double f[9])
{
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    int32_t i = p->place_of[n];
    for (int k = 0; k < 3; ++k) {
      p->displacement[k][i] = 0;
      for (int j = 0; j < 3; ++j) p->displacement[k][i] += (f[3 * k + j] - (k == j)) * p->position[j][i];
    }
  }
}

void compute_forces(breccia_model *model)
{
#pragma omp parallel
  domain_forces(&model->domain);
}

/** Values of a law's parameters from "name=value" words and its defaults; units m, kN, s. */
static void read_words(const breccia_law *law, const char *const *words, int count, double *values)
{
  Error *error = breccia_error_create();
  Units *units = units_create("m", "kN", "s", error);
  assert_non_null(units);
  Text reason = {0};
  for (int k = 0; k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    values[k] = NAN;
    if (p->standard && *p->standard) units_read(units, dimension_find(p->dimension), p->standard, &values[k], &reason);
  }
  for (int w = 0; w < count; ++w) {
    const char *equals = strchr(words[w], '=');
    int found = 0;
    for (int k = 0; k < law->parameter_count; ++k) {
      const breccia_parameter *p = &law->parameters[k];
      if (strncmp(p->name, words[w], (size_t)(equals - words[w])) || p->name[equals - words[w]]) continue;
      found = 1;
      assert_int_equal(units_read(units, dimension_find(p->dimension), equals + 1, &values[k], &reason), 0);
    }
    if (!found) fail_msg("%s has no parameter for '%s'", law->name, words[w]);
  }
  text_free(&reason);
  units_destroy(&units);
  breccia_error_destroy(&error);
}

enum { MOST_WORDS = 64 };

Material material_of(const char *name, ...)
{
  const breccia_law *law = law_find(NULL, name);
  assert_non_null(law);
  const char *words[MOST_WORDS];
  int count = 0;
  va_list arguments;
  va_start(arguments, name);
  while (count < MOST_WORDS && (words[count] = va_arg(arguments, const char *))) ++count;
  va_end(arguments);
  double values[MOST_WORDS];
  read_words(law, words, count, values);
  Material material;
  char reason[512] = "";
  if (material_prepare(&material, law, values, reason, sizeof reason)) fail_msg("material refused: %s", reason);
  return material;
}

int material_refusal(const char *name, const char *commas, char *reason, size_t size)
{
  const breccia_law *law = law_find(NULL, name);
  assert_non_null(law);
  char line[1024], *words[MOST_WORDS];
  int count = 0;
  snprintf(line, sizeof line, "%s", commas);
  for (char *word = strtok(line, ","); word && count < MOST_WORDS; word = strtok(NULL, ",")) words[count++] = word;
  double values[MOST_WORDS];
  read_words(law, (const char *const *)words, count, values);
  Material material;
  int status = material_prepare(&material, law, values, reason, size);
  if (!status) material_destroy(&material);
  return status;
}
