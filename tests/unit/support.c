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

Material material_of(const char *name, ...)
{
  const breccia_law *law = law_find(NULL, name);
  assert_non_null(law);
  Error *error = breccia_error_create();
  Units *units = units_create("m", "kN", "s", error);
  assert_non_null(units);
  double values[64];
  Text reason = {0};
  for (int k = 0; k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    values[k] = NAN;
    if (p->standard && *p->standard) units_read(units, dimension_find(p->dimension), p->standard, &values[k], &reason);
  }
  va_list arguments;
  va_start(arguments, name);
  for (const char *word; (word = va_arg(arguments, const char *));) {
    const char *equals = strchr(word, '=');
    int found = 0;
    for (int k = 0; k < law->parameter_count; ++k) {
      const breccia_parameter *p = &law->parameters[k];
      if (strncmp(p->name, word, (size_t)(equals - word)) || p->name[equals - word]) continue;
      found = 1;
      assert_int_equal(units_read(units, dimension_find(p->dimension), equals + 1, &values[k], &reason), 0);
    }
    assert_true(found);
  }
  va_end(arguments);
  text_free(&reason);
  units_destroy(&units);
  breccia_error_destroy(&error);
  Material material;
  char words[512] = "";
  if (material_prepare(&material, law, values, words, sizeof words)) fail_msg("material refused: %s", words);
  return material;
}
