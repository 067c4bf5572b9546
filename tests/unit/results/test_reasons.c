/* Reasons of broken bonds and constant numbers of particles in result files, in summaries and in `breccia why`. */
#include "sample_laws.h"
#include "support.h"

#include "results/broken_bonds.h"
#include "results/particle_columns.h"
#include <unistd.h>

static char folder[] = "/tmp/breccia-reasons-XXXXXX";

#define UNITS "title: Reasons\nunits: {length: m, force: kN, time: s}\n"
#define TORN                                                                                                           \
  "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [16, 9]}}}}\n"        \
  "cracks: [{cut: {line: [[0.8, 0.45], [0.8, 1]]}}]\n"                                                                 \
  "peridynamics: {formulation: hybrid, space: plane strain, horizon: 1.5 spacings}\n"                                  \
  "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 2}, displacement: [0.03, "       \
  "0.002], history: {ramp to: 1}}]\n"                                                                                  \
  "solve: {explicit: {end time: 0.6, time step: 2e-4}}\nresults: {number: 3}\npictures: []\n"

/** Decks in which bonds break from each cause. */
static const char *const decks[BREAK_CAUSES] = {
    [BREAK_LIMIT] = UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                          "failure: {criterion: critical bond stress, bond tensile strength: 20, bond shear strength: "
                          "8}\n" TORN,
    [BREAK_LAW] = UNITS "materials: {m: {model: glass, density: 2}}\n"
                        "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [12, 4, 4]}}}}\n"
                        "failure: {failed laws: break}\n"
                        "loads: [{on: {face: x-, layers: 3}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 3}, "
                        "velocity: [0.5, 0, 0]}]\n"
                        "solve: {explicit: {steps: 400}}\nresults: {number: 3}\npictures: []\n",
    [BREAK_ISOLATED] = UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                             "failure: {critical stretch: 1e-3}\n" TORN,
};

static breccia_model *loaded(const char *deck, int threads)
{
  const breccia_law *const laws[] = {&law_of_glass};
  const breccia_options options = {.size = sizeof options, .laws = laws, .law_count = 1, .threads = threads};
  Error *error = breccia_error_create();
  breccia_model *m = NULL;
  if (breccia_model_load_string(deck, "deck", &options, &m, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return m;
}

/** Runs a deck into a subfolder, with a restart after `stop` steps; 0: in one piece. */
static void run_deck(const char *deck, int threads, int64_t stop, const char *name)
{
  char *path = text_format("%s/%s", folder, name);
  for (int part = stop ? 0 : 1; part < 2; ++part) {
    breccia_model *m = loaded(deck, threads);
    Error *error = breccia_error_create();
    const breccia_run run = {.size = sizeof run,
                             .folder = path,
                             .steps = part ? 0 : stop,
                             .restart = stop && part ? BRECCIA_RESTART_LAST : BRECCIA_RESTART_NO};
    if (breccia_model_run(m, &run, error)) fail_msg("%s", breccia_error_text(error));
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
  free(path);
}

static void open_view(ResultView *view, const char *name)
{
  char *path = text_format("%s/%s/results.vtkhdf", folder, name);
  Error *error = breccia_error_create();
  if (result_view_open(view, path, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  free(path);
}

/** What `breccia why` prints of a subfolder, to be freed by breccia_text_free. */
static char *why_of(const char *name)
{
  char *path = text_format("%s/%s", folder, name), *words = NULL;
  const breccia_why wish = {.size = sizeof wish, .first = 1000000};
  Error *error = breccia_error_create();
  if (breccia_explain_breaks(path, &wish, &words, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  free(path);
  return words;
}

static char *summary_of(const char *name)
{
  char *path = text_format("%s/%s/summary.json", folder, name);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  char *words = calloc(1, 65536);
  assert_true(fread(words, 1, 65535, file) > 0);
  fclose(file);
  free(path);
  return words;
}

/** Every row names criterion, material and quantity; value and limit are there as the table of causes says, and the
 *  value is beyond the limit. @return number of bonds that broke from a cause */
static int64_t check_reasons(const char *name, BreakCause cause)
{
  ResultView view;
  BondReasons of;
  int64_t count = 0, inside = 0;
  open_view(&view, name);
  assert_int_equal(broken_bonds_read(&view, &of, NULL), 0);
  for (int64_t n = 0; n < of.count; ++n) {
    const BondReason *bond = &of.bonds[n];
    if (bond->cause == cause) ++count;
    inside += !bond->is_outside;
    assert_true(*bond->criterion && *bond->quantity);
    assert_string_equal(bond->material, "m");
    assert_true(bond->value == bond->value);
    assert_true(isnan(bond->limit) != break_causes[bond->cause].has_limit);
    if (bond->cause == BREAK_LIMIT) assert_true(bond->value > bond->limit);
    if (bond->cause == BREAK_ISOLATED) assert_true(bond->value <= bond->limit);
    for (int k = 0; k < 2; ++k) assert_true(bond->position[k] >= 0 && bond->position[k] <= 1.6);
  }
  char *words = why_of(name), *line = words;
  int64_t lines = 0;
  for (; (line = strstr(line, "\nstep ")); ++line) ++lines;
  assert_int_equal(lines, inside);
  if (count) holds_words(words, break_causes[cause].count);
  breccia_text_free(words);
  broken_bonds_destroy(&of);
  result_view_close(&view);
  return count;
}

static void every_cause_is_told_with_value_limit_and_criterion(void **state)
{
  (void)state;
  for (int k = 0; k < BREAK_CAUSES; ++k) {
    const BreakCauseType *cause = &break_causes[k];
    if (!decks[k]) fail_msg("no deck breaks bonds by the cause '%s'", cause->word);
    run_deck(decks[k], 1, 0, cause->word);
    const int64_t count = check_reasons(cause->word, (BreakCause)k);
    print_message("%s: %lld bonds\n", cause->word, (long long)count);
    assert_true(count > 0);
    char *summary = summary_of(cause->word);
    char *said = text_format("\"%s\": %lld, ", cause->word, (long long)count);
    holds_words(strstr(summary, "\"broken_bonds_by_cause\""), said);
    free(said);
    free(summary);

    /* The same words on three threads and after a restart. */
    char *once = why_of(cause->word);
    run_deck(decks[k], 3, 150, "again");
    char *again = why_of("again");
    assert_string_equal(once, again);
    breccia_text_free(once);
    breccia_text_free(again);
  }
}

/** Tension and shear are named apart, each with its own strength. */
static void shear_is_told_as_shear(void **state)
{
  (void)state;
  ResultView view;
  BondReasons of;
  int64_t counts[2] = {0};
  open_view(&view, break_causes[BREAK_LIMIT].word);
  assert_int_equal(broken_bonds_read(&view, &of, NULL), 0);
  for (int64_t n = 0; n < of.count; ++n) {
    const BondReason *bond = &of.bonds[n];
    if (bond->cause != BREAK_LIMIT) continue;
    const bool shear = !strcmp(bond->quantity, "shear");
    if (!shear) assert_string_equal(bond->quantity, "tension");
    assert_near(bond->limit, shear ? 8 : 20, 1e-12);
    assert_string_equal(bond->unit, "kPa");
    ++counts[shear];
  }
  assert_true(counts[0] > 0 && counts[1] > 0);
  broken_bonds_destroy(&of);
  result_view_close(&view);
}

/** The half of a strip on a support breaks like the whole strip. Bonds in the layers outside of the support are marked
 *  as images and are neither listed nor counted; no place lies in these layers. */
static void images_of_broken_bonds_are_not_listed(void **state)
{
  (void)state;
  static const char *const kinds[] = {"bond-based, horizon: 3.015 spacings", "ordinary, horizon: 3.015 spacings",
                                      "correspondence, horizon: 2.015 spacings", "hybrid, horizon: 1.5 spacings",
                                      "micropolar, horizon: 1.5 spacings"};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
    char *deck = text_format(
        UNITS "materials: {m: {model: %s, density: 2, Young modulus: 1e4%s}}\n"
              "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [16, "
              "5]}}}}\n"
              "cracks: [{cut: {line: [[0.8, 0.2], [0.8, 1]]}}]\n"
              "peridynamics: {space: plane strain, formulation: %s}\nfailure: {critical stretch: 2e-3}\n"
              "loads: [{on: {face: y-}, support: {held: across}}, {on: {face: x-, layers: 2}, displacement: [0, free]},"
              " {on: {face: x+, layers: 2}, displacement: [0.03, free], history: {ramp to: 1}}]\n"
              "solve: {explicit: {end time: 0.3, time step: 2e-4}}\nresults: {number: 3}\npictures: []\n",
        k ? "elastic" : "elastic-1d", k ? ", Poisson ratio: 0.25" : "", kinds[k]);
    run_deck(deck, 2, 0, "half");
    ResultView view;
    BondReasons of;
    int64_t inside = 0, outside = 0;
    open_view(&view, "half");
    assert_int_equal(broken_bonds_read(&view, &of, NULL), 0);
    for (int64_t n = 0; n < of.count; ++n) {
      const BondReason *bond = &of.bonds[n];
      assert_true(bond->position[1] >= 0 && bond->position[1] <= 0.5);
      inside += !bond->is_outside;
      outside += bond->is_outside;
    }
    print_message("%s: %lld bonds of the body and %lld images\n", kinds[k], (long long)inside, (long long)outside);
    assert_true(outside > 0 && outside <= inside);
    char *words = why_of("half"), *summary = summary_of("half");
    char *said = text_format("%lld bonds broke|%lld images of them", (long long)inside, (long long)outside),
         *counts = text_format("\"limit\": %lld|\"images\": %lld}", (long long)inside, (long long)outside);
    holds_words(words, said);
    if (k != 3) holds_words(summary, counts); /* some hybrid bonds are isolated */
    holds_words(strstr(summary, "\"first_broken_bond\""), "\"criterion\": \"critical stretch\"|\"material\": \"m\"");
    int ends[2];
    assert_int_equal(sscanf(strstr(summary, "\"particles\": ["), "\"particles\": [%d, %d]", &ends[0], &ends[1]), 2);
    breccia_model *m = loaded(deck, 1);
    assert_false(body_outside(&m->domain.body, ends[0]) && body_outside(&m->domain.body, ends[1]));
    breccia_model_destroy(&m);
    free(said);
    free(counts);
    free(summary);
    breccia_text_free(words);
    broken_bonds_destroy(&of);
    result_view_close(&view);
    free(deck);
  }
}

/** A body of two blocks, materials, regions and stages: who is what, as the file tells it. */
static void files_tell_volume_material_block_selection_and_stage(void **state)
{
  (void)state;
  static const char deck[] =
      UNITS "materials:\n  soft: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}\n"
            "  hard: {model: elastic, density: 2, Young modulus: 3e4, Poisson ratio: 0.25}\n"
            "body:\n  left: {material: hard, lattice: square, thickness: 2, spacing: 0.1, shape: {box: {particles: [6, "
            "4]}}}\n  right: {material: soft, lattice: square, thickness: 2, spacing: 0.1, shape: {box: {particles: "
            "[8, 4], first particle: [0.65, 0.05]}}}\n"
            "selections: {grip: {face: x+, layers: 2}}\n"
            "peridynamics: {space: plane strain, horizon: 1.5 spacings, formulation: hybrid, regions: {r: {blocks: "
            "[right], formulation: correspondence}}}\nfailure: {critical stretch: 5e-3}\n"
            "loads: [{on: {block: left, face: x-}, support: {held: across}}, {on: grip, displacement: [0.01, free], "
            "history: {ramp "
            "to: 0.1}}]\n"
            "solve:\n  - {name: pull, explicit: {end time: 0.05, time step: 2e-4}}\n"
            "  - {name: tear, explicit: {end time: 0.05, time step: 2e-4}}\n"
            "results: {number: 2}\npictures: []\n";
  run_deck(deck, 2, 300, "parts");
  breccia_model *m = loaded(deck, 1);
  const Domain *d = &m->domain;
  ResultView view;
  int64_t rows;
  open_view(&view, "parts");
  for (int k = 0; particle_column_at(k); ++k) {
    const ParticleColumn *column = particle_column_at(k);
    if (column->is_needed && !column->is_needed(d)) continue;
    char *path = text_format("Breccia/%s", column->name), words[128], names[128] = "";
    double *values = result_view_numbers(&view, path, H5T_NATIVE_DOUBLE, sizeof *values, &rows, NULL);
    assert_int_equal(rows, d->particles->count);
    for (int64_t n = 0; n < rows; ++n) assert_true(values[n] == column->value(d, n));
    if (!strcmp(column->name, "Volume")) {
      double sum = 0;
      for (int64_t n = 0; n < rows; ++n) sum += body_outside(&d->body, n) ? 0 : values[n];
      assert_near(sum, 2 * 1.4 * 0.4, 1e-12);
      result_view_words(&view, path, "unit", words, sizeof words);
      assert_string_equal(words, "m3");
    }
    if (!strcmp(column->name, "Material")) assert_true(values[0] != values[rows - 1]);
    for (int w = 0; column->word && column->word(d, w); ++w)
      snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", w ? ";" : "", column->word(d, w));
    result_view_words(&view, path, "names", words, sizeof words);
    assert_string_equal(words, names);
    free(values);
    free(path);
  }
  char words[64];
  result_view_words(&view, "Breccia/Material", "names", words, sizeof words);
  assert_string_equal(words, "soft;hard");
  result_view_words(&view, "Breccia/Block", "names", words, sizeof words);
  assert_string_equal(words, "left;right");
  int64_t *stages = result_view_numbers(&view, "Breccia/Stages", H5T_NATIVE_INT64, sizeof *stages, &rows, NULL);
  assert_int_equal(rows, view.steps);
  assert_int_equal(rows, 5);
  for (int64_t n = 0; n < rows; ++n) assert_true(stages[n] == (view.times[n] > 0.0501));
  result_view_words(&view, "Breccia/Stages", "names", words, sizeof words);
  assert_string_equal(words, "pull;tear");
  int64_t *grip = result_view_numbers(&view, "Breccia/Selections/grip", H5T_NATIVE_INT64, sizeof *grip, &rows, NULL);
  assert_int_equal(rows, 8);
  for (int64_t n = 0; n < rows; ++n) assert_true(d->particles->position[0][d->particles->place_of[grip[n]]] > 1.2);
  free(grip);
  free(stages);
  result_view_close(&view);
  breccia_model_destroy(&m);
}

/** The reference of decks describes all columns and causes. */
static void the_reference_describes_all_columns_and_causes(void **state)
{
  (void)state;
  char *page = breccia_page(BRECCIA_PAGE_DECK);
  for (int k = 0; particle_column_at(k); ++k) holds_words(page, particle_column_at(k)->about);
  for (int k = 0; reason_column_at(k)->name; ++k) holds_words(page, reason_column_at(k)->about);
  for (int k = 0; k < BREAK_CAUSES; ++k) holds_words(page, break_causes[k].about);
  breccia_text_free(page);
}

int main(void)
{
  if (!mkdtemp(folder)) return 1;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_cause_is_told_with_value_limit_and_criterion),
      cmocka_unit_test(shear_is_told_as_shear),
      cmocka_unit_test(images_of_broken_bonds_are_not_listed),
      cmocka_unit_test(files_tell_volume_material_block_selection_and_stage),
      cmocka_unit_test(the_reference_describes_all_columns_and_causes),
  };
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  char *command = text_format("rm -rf %s", folder);
  const int removed = system(command);
  free(command);
  return failed || removed;
}
