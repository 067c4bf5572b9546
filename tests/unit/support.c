#include "support.h"

bool under_sanitizers(void)
{
  return getenv("BRECCIA_SANITIZED") != NULL;
}

bool whole_walks(void)
{
  return getenv("BRECCIA_WHOLE") != NULL && !under_sanitizers();
}

void assert_same_numbers(double *const *a, double *const *b, int rows, int64_t places, const char *name)
{
  for (int k = 0; k < rows; ++k)
    if (memcmp(a[k], b[k], sizeof(double) * (size_t)places)) fail_msg("%s, row %d: not the same bits", name, k);
}

static breccia_model *model_from(const breccia_options *options, const char *format, va_list arguments)
{
  Text deck = {0};
  text_add_list(&deck, format, arguments);
  breccia_error *error = breccia_error_create();
  breccia_model *model;
  int status = breccia_model_load_string(deck.characters, "deck", options, &model, error);
  text_free(&deck);
  if (status) fail_msg("the deck was refused: %s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return model;
}

breccia_model *model_of(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  breccia_model *model = model_from(NULL, format, arguments);
  va_end(arguments);
  return model;
}

breccia_model *model_on(int threads, const char *format, ...)
{
  const breccia_options options = {.size = sizeof options, .threads = threads};
  va_list arguments;
  va_start(arguments, format);
  breccia_model *model = model_from(&options, format, arguments);
  va_end(arguments);
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
      p->displacement.row[k][i] = 0;
      for (int j = 0; j < 3; ++j) p->displacement.row[k][i] += (f[3 * k + j] - (k == j)) * p->position[j][i];
    }
  }
}

void compute_forces(breccia_model *model)
{
  Team *before = team_use(model->team);
  domain_evaluate(&model->domain, NULL);
  team_use(before);
}

enum { MOST_WORDS = 64 };

static double stress_scale = 1;

void scale_stresses(double scale)
{
  stress_scale = scale;
}

/** "key=value" with a value of stress times the scale, to be freed. */
static char *scaled_word(const breccia_law *law, const char *word)
{
  const char *value = strchr(word, '=');
  double scale = 1;
  for (int k = 0; value && k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    if (strlen(p->name) != (size_t)(value - word) || strncmp(p->name, word, strlen(p->name))) continue;
    if (!strcmp(p->dimension, "stress") || !strcmp(p->dimension, "fracture energy")) scale = stress_scale;
    if (!strcmp(p->dimension, "per stress")) scale = 1 / stress_scale;
  }
  if (scale == 1) return text_format("%s", word);
  return text_format("%.*s=%.17g", (int)(value - word), word, scale * strtod(value + 1, NULL));
}

static int material_of_words(Material *material, const char *name, const char *const *words, int count, Error *error)
{
  const breccia_law *law = law_find(NULL, name);
  assert_non_null(law);
  Units *units = units_create("m", "kN", "s", error);
  assert_non_null(units);
  char *scaled[MOST_WORDS];
  for (int k = 0; k < count; ++k) scaled[k] = scaled_word(law, words[k]);
  int status = material_from_words(material, law, (const char *const *)scaled, count, units, "", error);
  for (int k = 0; k < count; ++k) free(scaled[k]);
  units_destroy(&units);
  return status;
}

Material material_of(const char *name, ...)
{
  const char *words[MOST_WORDS];
  int count = 0;
  va_list arguments;
  va_start(arguments, name);
  while (count < MOST_WORDS && (words[count] = va_arg(arguments, const char *))) ++count;
  va_end(arguments);
  Error *error = breccia_error_create();
  Material material;
  if (material_of_words(&material, name, words, count, error))
    fail_msg("material refused: %s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return material;
}

int material_refusal(const char *name, const char *commas, char *reason, size_t size)
{
  char line[1024], *words[MOST_WORDS];
  int count = 0;
  snprintf(line, sizeof line, "%s", commas);
  for (char *word = strtok(line, ","); word && count < MOST_WORDS; word = strtok(NULL, ",")) words[count++] = word;
  Error *error = breccia_error_create();
  Material material;
  int status = material_of_words(&material, name, (const char *const *)words, count, error);
  if (!status) material_destroy(&material);
  snprintf(reason, size, "%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return status;
}

void assert_families_are_all_pairs(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  const Family *f = &model->domain.family;
  double reach = f->horizon * (1 + 1e-9);
  int64_t bonds = 0;
  for (int64_t a = 0; a < p->count; ++a) {
    int32_t i = p->place_of[a];
    int expected = 0;
    for (int64_t b = 0; b < p->count; ++b) {
      int32_t j = p->place_of[b];
      double x[3], y[3], square = 0;
      for (int k = 0; k < 3; ++k) {
        x[k] = p->position[k][i];
        y[k] = p->position[k][j];
        square += (y[k] - x[k]) * (y[k] - x[k]);
      }
      bool near = a != b && sqrt(square) <= reach && !body_cuts(&model->domain.body, x, y);
      expected += near;
      if (near != family_joins(f, i, j)) fail_msg("pair %d %d: all pairs say %d", (int)a, (int)b, near);
    }
    assert_int_equal(family_count(f, i), expected);
    bonds += expected;
  }
  assert_int_equal(f->bonds, bonds);
}

void step_surely(breccia_model *model, int64_t steps)
{
  breccia_error *error = breccia_error_create();
  breccia_model_step(model, steps, error);
  assert_string_equal(breccia_error_text(error), "");
  breccia_error_destroy(&error);
}

void holds_words(const char *text, const char *words)
{
  char phrase[512];
  for (const char *at = words; at; at = strchr(at, '|')) {
    at += *at == '|';
    snprintf(phrase, sizeof phrase, "%.*s", (int)strcspn(at, "|"), at);
    if (!strstr(text, phrase)) fail_msg("no '%s' in: %s", phrase, text);
  }
}

void step_must_fail(breccia_model *model, const char *words)
{
  breccia_error *error = breccia_error_create();
  assert_int_equal(breccia_model_step(model, INT64_MAX, error), BRECCIA_FAILURE);
  holds_words(breccia_error_text(error), words);
  breccia_error_destroy(&error);
}

Sums sums_of(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  Sums s = {0};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double mass = p->density[i] * p->volume[i];
    s.mass += mass;
    s.volume += p->volume[i];
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      s.momentum[k] += mass * p->velocity.row[k][i];
      s.external[k] += p->volume[i] * p->external.row[k][i];
      s.moved[k] += p->volume[i] * p->displacement.row[k][i];
      s.turn[k] += mass * ((p->position[a][i] + p->displacement.row[a][i]) * p->velocity.row[b][i] -
                           (p->position[b][i] + p->displacement.row[b][i]) * p->velocity.row[a][i]);
    }
    for (int k = p->space.rotation; k < p->space.rows; ++k)
      s.turn[p->space.row[k].axis] += p->rotary[i] * p->volume[i] * p->velocity.row[k][i];
  }
  for (int k = 0; k < 3; ++k) s.moved[k] /= s.volume;
  return s;
}

void assert_balanced(const breccia_model *m, double tolerance)
{
  const Energy e = solver_energy(&m->solver);
  if (!(e.imbalance < tolerance)) fail_msg("imbalance %g", e.imbalance);
}

StateCopy state_of(breccia_model *m)
{
  StateCopy copy;
  StateList list = {0};
  model_state(m, &list);
  assert_int_equal(state_copy(&copy, &list, NULL), 0);
  state_list_destroy(&list);
  return copy;
}

static void assert_same_state(breccia_model *one, breccia_model *other, const char *what)
{
  StateCopy a = state_of(one), b = state_of(other);
  assert_int_equal(a.count, b.count);
  for (int k = 0; k < a.count; ++k) {
    assert_int_equal(a.rows[k].count, b.rows[k].count);
    if (memcmp(a.values[k], b.values[k], state_size(&a.rows[k]) * (size_t)a.rows[k].count))
      fail_msg("%s: %s differs", what, a.rows[k].name);
  }
  state_copy_destroy(&a);
  state_copy_destroy(&b);
}

void assert_same_bits_by_threads_and_restart(breccia_model *(*make)(int threads), int64_t half, int64_t last)
{
  static const int threads[] = {5, 3};
  breccia_model *whole = make(1), *other = make(2);
  step_surely(other, half);
  StateCopy kept = state_of(other);
  step_surely(other, last - half);
  step_surely(whole, last);
  assert_int_equal(whole->solver.clock.step, last);
  assert_same_state(whole, other, "two threads");
  breccia_model_destroy(&other);
  for (int k = 0; k < (whole_walks() ? 2 : 1) && !under_sanitizers(); ++k) {
    char words[32];
    snprintf(words, sizeof words, "%d threads", threads[k]);
    other = make(threads[k]);
    step_surely(other, last);
    assert_same_state(whole, other, words);
    breccia_model_destroy(&other);
  }
  other = make(1);
  step_surely(other, 1);
  StateList list = {0};
  model_state(other, &list);
  assert_int_equal(state_return(&kept, &list, NULL), 0);
  state_list_destroy(&list);
  step_surely(other, last - half);
  assert_same_state(whole, other, "restart");
  state_copy_destroy(&kept);
  breccia_model_destroy(&whole);
  breccia_model_destroy(&other);
}
