/* A test on one material point, or a path of strains, from words. */
#include "base/memory.h"
#include "model/laboratory.h"

#include "base/csv.h"
#include "base/tensor.h"
#include "model/host.h"
#include "model/sized.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { USUAL_STEPS = 200 };

/** Times of the rows, if the file has them. */
static int read_times(breccia_test *test, const char *path, Error *error)
{
  CsvWords words;
  int status = csv_words(&words, path, "time", error), count;
  const bool given = words.cells != NULL;
  csv_words_destroy(&words);
  if (status || !given) return status;
  if (!(test->path_time = csv_column(path, "time", CSV_FINISHED, &count, NULL, error))) return BRECCIA_FAILURE;
  for (int i = 0; i < count; ++i)
    if (!(test->path_time[i] >= (i ? test->path_time[i - 1] : 0)))
      return error_add(error, BRECCIA_USER_ERROR, "%s: row %d: time must be a number that does not fall, from 0 on",
                       path, i + 1);
  return BRECCIA_OK;
}

int laboratory_read_path(breccia_test *test, const char *path, Error *error)
{
  const int components = test->deck.law->components;
  double *rows = NULL;
  int count = 0;
  for (int k = 0; k < components; ++k) {
    char name[32], label[128];
    int n;
    snprintf(name, sizeof name, "strain %s", component_names[k]);
    double *column = csv_column(path, name, CSV_FINISHED, &n, label, error);
    if (!column) {
      free(rows);
      return BRECCIA_USER_ERROR;
    }
    if (!k) rows = memory_plain(6 * (size_t)(n + 1), sizeof(double));
    int bad = 0;
    while (bad < n && isfinite(column[bad])) ++bad;
    for (int i = 0; rows && i < n && (!k || i < count); ++i) rows[6 * i + k] = column[i];
    count = n;
    free(column);
    if (bad == n) continue;
    free(rows);
    return error_add(error, BRECCIA_USER_ERROR, "%s: row %d: %s is not a number", path, bad + 1, name);
  }
  test->path = rows;
  test->path_rows = count;
  return rows && count ? read_times(test, path, error)
                       : error_add(error, BRECCIA_USER_ERROR, "%s: has no row of strains", path);
}

/** Returns the index of a word of the command line in a list of words; -1: the list lacks the word. */
static int number_of_word(const char *(*word)(int k), const char *given)
{
  for (int k = 0; word(k); ++k)
    if (!strcmp(word(k), given)) return k;
  return -1;
}

/** The kind of a test and its numbers. */
static int read_test(const breccia_test_words *words, const Units *units, TestSpec *spec, Error *error)
{
  const struct {
    const char *option, *words, *dimension;
    double *value;
  } numbers[] = {{"to", words->to, "1", &spec->strain},
                 {"return", words->back, "1", &spec->back},
                 {"confining", words->confining, "stress", &spec->confining},
                 {"duration", words->duration, "time", &spec->duration}};
  *spec = (TestSpec){.kind = number_of_word(test_kind_word, words->kind),
                     .zero = words->strain_zero ? number_of_word(test_zero_word, words->strain_zero) : 0,
                     .strain = NAN,
                     .back = NAN,
                     .duration = NAN,
                     .cycles = words->cycles,
                     .steps = words->steps ? words->steps : USUAL_STEPS};
  int status = BRECCIA_OK;
  if (spec->kind < 0) {
    Text known = {0};
    for (int k = 0; test_kind_word(k); ++k) text_add(&known, "%s'%s'", k ? ", " : "", test_kind_word(k));
    status = error_add(error, BRECCIA_USER_ERROR, "--test '%s' is not known; the tests are %s", words->kind,
                       text_words(&known));
    text_free(&known);
  }
  if (spec->zero < 0)
    status = error_add(error, BRECCIA_USER_ERROR, "--strain-zero '%s' is not known; choose '%s' or '%s'",
                       words->strain_zero, test_zero_word(0), test_zero_word(1));
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k) {
    Text reason = {0};
    if (numbers[k].words &&
        units_read(units, dimension_find(numbers[k].dimension), numbers[k].words, numbers[k].value, &reason))
      status =
          error_add(error, BRECCIA_USER_ERROR, "--%s %s: %s", numbers[k].option, numbers[k].words, text_words(&reason));
    text_free(&reason);
  }
  if (!words->to) status = error_add(error, BRECCIA_USER_ERROR, "--test needs --to STRAIN, what it goes to");
  if (spec->confining < 0)
    status = error_add(error, BRECCIA_USER_ERROR, "--confining: must not be negative: it is a pressure");
  if (spec->duration < 0) status = error_add(error, BRECCIA_USER_ERROR, "--duration: must not be negative");
  return status;
}

/** The units of words like 'm, kN, s', or the usual ones. */
static int read_units(const char *words, Units **units, Error *error)
{
  char name[3][32], tail;
  *units = NULL;
  if (!words)
    *units = units_create(UNITS_LENGTH, UNITS_FORCE, UNITS_TIME, error);
  else if (sscanf(words, " %31[^, ] , %31[^, ] , %31[^, ] %c", name[0], name[1], name[2], &tail) == 3)
    *units = units_create(name[0], name[1], name[2], error);
  else
    return error_add(error, BRECCIA_USER_ERROR, "--units '%s': give units of length, force and time, like 'm,kN,s'",
                     words);
  return *units ? BRECCIA_OK : words ? BRECCIA_USER_ERROR : BRECCIA_FAILURE;
}

static int make(breccia_test *test, const breccia_test_words *words, Error *error)
{
  ElementDeck *deck = &test->deck;
  test->where = "breccia material";
  test->elastic_rows = (int)words->elastic_rows;
  if (!words->law || !words->path == !words->kind)
    return error_add(error, BRECCIA_USER_ERROR, "a test in words needs a law, and a path or a kind of test");
  if (!(deck->law = law_find(NULL, words->law))) {
    Text advice = {0};
    law_advice(NULL, words->law, &advice);
    error_add(error, BRECCIA_USER_ERROR, "breccia material: there is no model '%s'; %s", words->law,
              text_words(&advice));
    text_free(&advice);
    return BRECCIA_USER_ERROR;
  }
  int status = read_units(words->units, &deck->units, error);
  if (status) return status;
  test->title = text_format("%s", deck->law->name);
  units_name(deck->units, dimension_find("stress"), test->unit, sizeof test->unit);
  status = material_from_words(&deck->material, deck->law, words->parameters, words->parameter_count, deck->units,
                               "--set ", error);
  if (status) return status;
  if (words->path) return laboratory_read_path(test, words->path, error);
  static const Node nowhere = {.kind = NODE_MAP, .line = 1, .column = 1};
  Document document = {.name = test->where};
  const DeckReader reader = {.document = &document, .units = deck->units, .error = error};
  TestSpec spec;
  status = read_test(words, deck->units, &spec, error);
  spec.head.node = &nowhere;
  return status ? status : element_test_create(&deck->test, &reader, &spec, NULL, deck->law->components == 1);
}

int breccia_test_make(const breccia_test_words *given, breccia_test **out, breccia_error *error)
{
  if (host_lacks(out, __func__, "the result", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_test_words words;
  int status = sized_take(&words, sizeof words, given, "breccia_test_words", error);
  breccia_test *test = status ? NULL : laboratory_begin(error);
  if (!status) status = test ? make(test, &words, error) : BRECCIA_FAILURE;
  status = host_leave(&host, status, error);
  if (status) breccia_test_destroy(&test);
  *out = test;
  return status;
}
