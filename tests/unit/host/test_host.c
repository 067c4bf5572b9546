/* What a process that embeds the library finds afterwards: everything of its own as it was; and structs of other versions of the header. */
#include "model/model.h"
#include "support.h"

#include <breccia/breccia.h>
#include <dirent.h>
#include <fenv.h>
#include <hdf5.h>
#include <locale.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char deck[] = "title: A pulled bar\n"
                           "units: {length: m, force: kN, time: s}\n"
                           "materials: {steel: {model: elastic, density: 7.85 t/m3, Young modulus: 210.5 GPa,\n"
                           "                    Poisson ratio: 0.25}}\n"
                           "body: {bar: {material: steel, spacing: 0.125 m, shape: {box: {particles: [4, 4, 12]}}}}\n"
                           "loads:\n"
                           "  - {on: {face: z+}, velocity: [free, free, 0.5 m/s]}\n"
                           "  - {on: {face: z-}, displacement: [0, 0, 0]}\n"
                           "solve: {explicit: {steps: 40}}\n"
                           "watch: {end: {displacement of: {nearest: [0, 0, 1.5]}}}\n";

static int entries(const char *folder)
{
  int count = 0;
  DIR *list = opendir(folder);
  if (!list) return 0;
  while (readdir(list)) ++count;
  closedir(list);
  return count;
}

static herr_t quiet(hid_t stack, void *context)
{
  (void)stack, (void)context;
  return 0;
}

/* Signals whose handling belongs to the host. */
static const int signals[] = {SIGINT, SIGTERM, SIGPIPE, SIGCHLD, SIGHUP, SIGUSR1};
enum { SIGNALS = sizeof signals / sizeof *signals };

typedef struct Own { /* what belongs to the process */
  struct sigaction actions[SIGNALS];
  sigset_t mask;
  locale_t locale;
  char point;
  H5E_auto2_t report;
  void *report_to;
  char folder[1000];
  mode_t mode;
  int threads, files, rounding;
} Own;

static Own look(void)
{
  Own own = {0};
  for (int k = 0; k < SIGNALS; ++k) sigaction(signals[k], NULL, &own.actions[k]);
  pthread_sigmask(SIG_SETMASK, NULL, &own.mask);
  own.locale = uselocale((locale_t)0);
  own.point = *localeconv()->decimal_point;
  H5Eget_auto2(H5E_DEFAULT, &own.report, &own.report_to);
  if (!getcwd(own.folder, sizeof own.folder)) *own.folder = 0;
  umask(own.mode = umask(0));
  own.threads = entries("/proc/self/task");
  own.files = entries("/proc/self/fd");
  own.rounding = fegetround();
  return own;
}

static void assert_same(const Own *a, const Own *b)
{
  for (int k = 0; k < SIGNALS; ++k) {
    assert_true(a->actions[k].sa_handler == b->actions[k].sa_handler);
    assert_int_equal(sigismember(&a->mask, signals[k]), sigismember(&b->mask, signals[k]));
  }
  assert_true(a->locale == b->locale);
  assert_int_equal(a->point, b->point);
  assert_true(a->report == b->report);
  assert_true(a->report_to == b->report_to);
  assert_string_equal(a->folder, b->folder);
  assert_int_equal(a->mode, b->mode);
  assert_int_equal(a->threads, b->threads);
  assert_int_equal(a->files, b->files);
  assert_int_equal(a->rounding, b->rounding);
}

/** Everything that a program may ask of a deck; the largest displacement at the end. */
static double use_all(const char *folder)
{
  breccia_error *error = breccia_error_create();
  const breccia_options options = {.size = sizeof options, .threads = 3};
  breccia_model *model;
  int status = breccia_model_load_string(deck, "bar", &options, &model, error);
  assert_string_equal(breccia_error_text(error), "");
  assert_int_equal(status, BRECCIA_OK);
  assert_non_null(strstr(breccia_model_overview(model), "192 particles"));
  assert_non_null(strstr(breccia_model_plausibility(model), "GPa"));
  assert_int_equal(breccia_model_step(model, 10, error), BRECCIA_OK);
  const breccia_run run = {.size = sizeof run, .folder = folder};
  status = breccia_model_run(model, &run, error);
  assert_string_equal(breccia_error_text(error), "");
  assert_int_equal(status, BRECCIA_OK);
  double most = 0;
  const double *u = breccia_model_array(model, "displacement z");
  for (int64_t i = 0; i < breccia_model_places(model); ++i) most = larger_of(most, u[i]);
  breccia_model_destroy(&model);
  breccia_plot plot;
  breccia_plot_begin(&plot, sizeof plot);
  plot.field = "displacement";
  assert_int_equal(breccia_plot_field(folder, &plot, error), BRECCIA_OK);
  assert_int_equal(breccia_plot_field("/nowhere", &plot, error), BRECCIA_USER_ERROR);
  breccia_text_free(breccia_page(BRECCIA_PAGE_SCHEMA));
  const breccia_test_words words = {.size = sizeof words,
                                    .law = "elastic",
                                    .parameters = (const char *const[]){"Young modulus=1.5 GPa", "Poisson ratio=0.25"},
                                    .parameter_count = 2,
                                    .kind = "uniaxial",
                                    .to = "0.0625"};
  breccia_test *test;
  status = breccia_test_make(&words, &test, error);
  assert_int_equal(status, BRECCIA_OK);
  assert_int_equal(breccia_test_run(test, 0, error), BRECCIA_OK);
  const int rows = breccia_test_rows(test);
  assert_near(breccia_test_column(test, 6)[rows - 1], 1.5e9 * 0.0625, 1);
  breccia_test_destroy(&test);
  breccia_error_destroy(&error);
  return most;
}

static void test_the_host_stays_as_it_was(void **state)
{
  (void)state;
  const char *folder = "host-results";
  const double plain = use_all(folder); /* what a process has once and for all, like the list of units, is there now */
  H5Eset_auto2(H5E_DEFAULT, quiet, NULL);
  const Own before = look();
  assert_true(use_all(folder) == plain);
  const Own after = look();
  assert_same(&before, &after);
}

/** Whether a file has a comma between two digits where a number stands. */
static bool has_comma_number(const char *path)
{
  char words[4000];
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  words[fread(words, 1, sizeof words - 1, file)] = 0;
  fclose(file);
  for (const char *c = words + 1; *c; ++c)
    if (*c == ',' && strchr("0123456789", c[-1]) && c[1] && strchr("0123456789", c[1]) && !strstr(path, ".csv"))
      return true;
  return !words[0];
}

static void test_numbers_have_points_in_every_country(void **state)
{
  (void)state;
  const char *folder = "host-results";
  const double plain = use_all(folder);
  if (!setlocale(LC_NUMERIC, "comma") &&
      !setlocale(LC_NUMERIC, "de_DE.UTF-8")) /* tests/CMakeLists.txt makes the first */
    fail_msg("there is no locale with a decimal comma; install the package 'locales' and configure again");
  assert_int_equal(*localeconv()->decimal_point, ',');
  const Own before = look();
  assert_true(use_all(folder) == plain);
  const Own after = look();
  assert_same(&before, &after);
  char path[80], number[32];
  snprintf(number, sizeof number, "%.1f", 2.5);
  assert_string_equal(number, "2,5"); /* the host's own numbers */
  snprintf(path, sizeof path, "%s/summary.json", folder);
  assert_false(has_comma_number(path));
  setlocale(LC_NUMERIC, "C");
}

/* ---- structs of other versions ---- */

static void test_a_struct_without_its_size_is_refused(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  const breccia_options options = {.threads = 1};
  breccia_model *model;
  assert_int_equal(breccia_model_load_string(deck, "bar", &options, &model, error), BRECCIA_USER_ERROR);
  assert_null(model);
  assert_non_null(strstr(breccia_error_text(error), "breccia_options: its size is not set"));
  breccia_error_destroy(&error);
}

static void test_an_older_and_a_newer_program_are_understood(void **state)
{
  (void)state;
  struct {
    breccia_options known;
    const char *more;
  } newer = {.known = {.size = sizeof newer, .threads = 1}};
  const breccia_options older = {.size = offsetof(breccia_options, settings),
                                 .threads = 1,
                                 .settings = (const char *const[]){"no.such=key"},
                                 .setting_count = 1}; /* lies behind what it knows of, and is not looked at */
  breccia_error *error = breccia_error_create();
  breccia_model *model;
  assert_int_equal(breccia_model_load_string(deck, "bar", &older, &model, error), BRECCIA_OK);
  breccia_model_destroy(&model);
  assert_int_equal(breccia_model_load_string(deck, "bar", &newer.known, &model, error), BRECCIA_OK);
  breccia_model_destroy(&model);
  newer.more = "something";
  assert_int_equal(breccia_model_load_string(deck, "bar", &newer.known, &model, error), BRECCIA_USER_ERROR);
  assert_non_null(strstr(breccia_error_text(error), "does not know"));
  breccia_error_destroy(&error);
}

/** Each struct that a program hands over is read by its size: none, or one with more behind it than is known. */
static void test_every_struct_is_read_by_its_size(void **state)
{
  (void)state;
  struct {
    size_t size;
    unsigned char rest[4096];
  } none = {.size = 0}, more = {.size = sizeof more};
  more.rest[sizeof more.rest - 1] = 1;
  const void *const given[] = {&none, &more};
  const char *const told[] = {"its size is not set; begin with {.size = sizeof(%s)",
                              "asks for something that this library"};
  for (int k = 0; k < 2; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_model *model, *refused;
    assert_int_equal(breccia_model_load_string(deck, "bar", NULL, &model, error), BRECCIA_OK);
    const breccia_law *law = given[k];
    const breccia_options with_law = {.size = sizeof with_law, .laws = &law, .law_count = 1};
    breccia_study *study = NULL;
    breccia_test *test = NULL;
    breccia_motion *motion = NULL;
    const struct {
      int status;
      const char *name;
    } cases[] = {{breccia_model_load_string(deck, "bar", given[k], &refused, error), "breccia_options"},
                 {breccia_model_load_string(deck, "bar", &with_law, &refused, error), "breccia_law"},
                 {breccia_study_create(given[k], &study, error), "breccia_study_plan"},
                 {breccia_serve(given[k], error), "breccia_service"},
                 {breccia_plot_movie("results", given[k], error), "breccia_plot"},
                 {breccia_test_make(given[k], &test, error), "breccia_test_words"},
                 {breccia_motion_load(given[k], &motion, error), "breccia_motion_file"},
                 {breccia_model_run(model, given[k], error), "breccia_run"},
                 {breccia_model_modes(model, given[k], error), "breccia_modes"}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; ++n) {
      char words[160], end[120];
      snprintf(end, sizeof end, told[k], cases[n].name);
      snprintf(words, sizeof words, "%s: %s", cases[n].name, end);
      assert_int_equal(cases[n].status, BRECCIA_USER_ERROR);
      if (!strstr(breccia_error_text(error), words)) fail_msg("no '%s' in: %s", words, breccia_error_text(error));
    }
    assert_null(study);
    assert_null(test);
    assert_null(motion);
    breccia_array array = {.size = k ? sizeof(size_t) + sizeof(char *) : 0}; /* of an old program: it knows of a name */
    array.components = 77;
    assert_int_equal(breccia_model_array_at(model, 0, &array), k);
    assert_int_equal(array.components, 77);
    if (k) assert_string_equal(array.name, "position");
    breccia_model_destroy(&model);
    breccia_error_destroy(&error);
  }
}

/* ---- arrays ---- */

static void test_arrays_are_all_named_and_what_is_written_to_them_counts(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_model *model;
  assert_int_equal(breccia_model_load_string(deck, "bar", NULL, &model, error), BRECCIA_OK);
  breccia_array array = {.size = sizeof array};
  int count = 0, writable = 0;
  assert_int_equal(breccia_model_array_at(model, -1, &array), 0);
  for (; breccia_model_array_at(model, count, &array); ++count) {
    writable += array.writable;
    assert_true(array.components == 1 || array.components == 3 || array.components == 6);
    for (int c = 0; c < array.components; ++c) {
      char name[80];
      snprintf(name, sizeof name, "%s%s%s", array.name, array.components > 1 ? " " : "",
               array.components > 1 ? array.component_names[c] : "");
      assert_ptr_equal(breccia_model_array(model, name), array.values[c]);
    }
    if (!strcmp(array.name, "stress")) assert_string_equal(array.unit, "kPa");
    if (!strcmp(array.name, "velocity")) assert_string_equal(array.unit, "m/s");
  }
  assert_true(count >= 9);
  assert_int_equal(writable, 2);
  /* All free particles at one speed: after a step they have gone speed times step. */
  double *v = breccia_model_array(model, "velocity x"), *u = breccia_model_array(model, "displacement x");
  for (int64_t i = 0; i < breccia_model_places(model); ++i) v[i] = 3;
  assert_int_equal(breccia_model_step(model, 1, error), BRECCIA_OK);
  double most = 0;
  for (int64_t i = 0; i < breccia_model_places(model); ++i) most = larger_of(most, u[i]);
  assert_near(most, 3 * breccia_model_time(model), 1e-12);
  for (int k = 0; k < 3; ++k) { /* after one step, two, and the last, when room is given up */
    assert_int_equal(breccia_model_step(model, k < 2 ? 1 + k : INT64_MAX, error), BRECCIA_OK);
    assert_ptr_equal(breccia_model_array(model, "velocity x"), v);
    assert_ptr_equal(breccia_model_array(model, "displacement x"), u);
  }
  assert_null(breccia_model_array(model, "no such"));
  breccia_model_destroy(&model);
  breccia_error_destroy(&error);
}

/** What is left out of a wish and has no default is asked for in words. */
static void test_what_is_missing_is_asked_for(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_model *model;
  assert_int_equal(breccia_model_load_string(deck, "bar", NULL, &model, error), BRECCIA_OK);
  breccia_plot plot;
  breccia_plot_begin(&plot, sizeof plot);
  const breccia_service nowhere = {.size = sizeof nowhere}, secret = {.size = sizeof secret,
                                                                      .address = "udp://127.0.0.1:0",
                                                                      .secret_file = "/no such file"};
  const breccia_run run = {.size = sizeof run};
  const breccia_study_plan plan = {.size = sizeof plan};
  const breccia_test_words words = {.size = sizeof words};
  breccia_study *study = NULL;
  breccia_test *test = NULL;
  const struct {
    int status;
    const char *words;
  } cases[] = {{breccia_serve(&nowhere, error), "a service needs an address"},
               {breccia_serve(&secret, error), "/no such file: no secret can be read there"},
               {breccia_model_run(model, &run, error), "a run needs a folder"},
               {breccia_study_create(&plan, &study, error), "a study needs a deck and a folder"},
               {breccia_test_make(&words, &test, error), "a test in words needs a law, and a path or a kind of test"},
               {breccia_plot_curve(NULL, 0, &plot, error), "a curve needs a folder with histories"},
               {breccia_plot_movie("results", &plot, error), "a movie needs the path of an .mp4 file"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    assert_int_equal(cases[k].status, BRECCIA_USER_ERROR);
    if (!strstr(breccia_error_text(error), cases[k].words))
      fail_msg("no '%s' in: %s", cases[k].words, breccia_error_text(error));
  }
  assert_null(study);
  assert_null(test);
  breccia_model_destroy(&model);
  breccia_error_destroy(&error);
}

/* ---- misuse: errors, never a crash or a hang ---- */

static void test_null_pointers_are_refused(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_model *model;
  breccia_plot plot;
  double number;
  char *words = NULL;
  breccia_plot_begin(&plot, sizeof plot);
  const breccia_run run = {.size = sizeof run, .folder = "unused"};
  const breccia_modes modes = {.size = sizeof modes, .count = 1};
  const int refused[] = {breccia_model_load_string(NULL, "deck", NULL, &model, error),
                         breccia_model_load_string(deck, "deck", NULL, NULL, error),
                         breccia_model_load_file(NULL, NULL, &model, error),
                         breccia_model_load_file("deck", NULL, NULL, error),
                         breccia_model_step(NULL, 1, error),
                         breccia_model_run(NULL, &run, error),
                         breccia_model_modes(NULL, &modes, error),
                         breccia_plot_field(NULL, &plot, error),
                         breccia_plot_movie(NULL, &plot, error),
                         breccia_plot_over_length(NULL, &plot, error),
                         breccia_plot_curve(NULL, 1, &plot, error),
                         breccia_test_load(NULL, NULL, error),
                         breccia_test_make(NULL, NULL, error),
                         breccia_test_run(NULL, 0, error),
                         breccia_test_compare(NULL, NULL, NULL, error),
                         breccia_test_draw(NULL, "a.png", error),
                         breccia_test_fit(NULL, NULL, NULL, error),
                         breccia_concrete_calibrate(NULL, NULL, error),
                         breccia_study_create(NULL, NULL, error),
                         breccia_study_report(NULL, error),
                         breccia_motion_load(NULL, NULL, error),
                         breccia_motion_analyse(NULL, NULL, NULL, error),
                         breccia_motion_write(NULL, "folder", error),
                         breccia_describe_opensees(NULL, error)};
  for (size_t k = 0; k < sizeof refused / sizeof *refused; ++k)
    if (refused[k] != BRECCIA_USER_ERROR) fail_msg("call %d: status %d", (int)k, refused[k]);
  assert_non_null(strstr(breccia_error_text(error), "breccia_model_step: model is NULL"));
  const int64_t none[] = {breccia_model_particles(NULL),
                          breccia_model_bonds(NULL),
                          breccia_model_broken_bonds(NULL),
                          breccia_model_steps_done(NULL),
                          breccia_model_places(NULL),
                          breccia_model_array_at(NULL, 0, NULL),
                          breccia_test_rows(NULL),
                          breccia_test_fitted_at(NULL, 0, NULL),
                          breccia_study_case_at(NULL, 0, NULL),
                          breccia_study_figure(NULL, 0, "steps", &number),
                          breccia_motion_intensity(NULL, NULL),
                          breccia_motion_rows(NULL, 0),
                          breccia_can_draw(NULL)};
  for (size_t k = 0; k < sizeof none / sizeof *none; ++k) assert_int_equal(none[k], 0);
  assert_true(isnan(breccia_model_time(NULL)) && isnan(breccia_model_time_step(NULL)) &&
              isnan(breccia_model_stable_time_step(NULL)));
  const void *const absent[] = {
      breccia_model_numbers(NULL),        breccia_model_array(NULL, "velocity x"), breccia_model_overview(NULL),
      breccia_model_plausibility(NULL),   breccia_test_heading(NULL, 0),           breccia_test_column(NULL, 0),
      breccia_motion_heading(NULL, 0, 0), breccia_motion_column(NULL, 0, 0),       breccia_visible_text(NULL),
      breccia_deck_title(NULL, NULL),     breccia_nearest_word(NULL, NULL, 3),     breccia_law_at(-1)};
  for (size_t k = 0; k < sizeof absent / sizeof *absent; ++k) assert_null(absent[k]);
  const char *const empty[] = {breccia_model_deck(NULL),  breccia_model_warnings(NULL), breccia_model_outcome(NULL),
                               breccia_model_stage(NULL), breccia_model_event(NULL),    breccia_test_doubts(NULL),
                               breccia_study_table(NULL), breccia_study_files(NULL),    breccia_motion_words(NULL),
                               breccia_motion_files(NULL)};
  for (size_t k = 0; k < sizeof empty / sizeof *empty; ++k) assert_string_equal(empty[k], "");
  breccia_plot_begin(NULL, sizeof plot);
  breccia_text_free(words);
  breccia_error_destroy(&error);
}

static void test_lists_without_items_are_refused(void **state)
{
  (void)state;
  const char *const one[] = {NULL};
  const breccia_law *const law[] = {NULL};
  const breccia_options cases[] = {{.size = sizeof *cases, .setting_count = 2},
                                   {.size = sizeof *cases, .settings = one, .setting_count = 1},
                                   {.size = sizeof *cases, .setting_count = -3},
                                   {.size = sizeof *cases, .law_count = 1},
                                   {.size = sizeof *cases, .laws = law, .law_count = 1},
                                   {.size = sizeof *cases, .law_count = -1},
                                   {.size = sizeof *cases, .threads = -5}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_model *model;
    assert_int_equal(breccia_model_load_string(deck, "bar", &cases[k], &model, error), BRECCIA_USER_ERROR);
    assert_null(model);
    assert_non_null(strstr(breccia_error_text(error), "breccia_options: "));
    breccia_error_destroy(&error);
  }
}

/* ---- laws of a program that are not whole ---- */

static breccia_parameter own_parameters[] = {{"Young modulus", "stress", NULL, "(0, inf)", "E"}};
static int own_answer;     /* what `update` returns */
static double own_stress;  /* what it writes, over E times the strain, or instead of it where that is no number */
static double own_history; /* what `begin` writes; then that grows by own_growth */
static double own_growth;

static int own_prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)reason, (void)size;
  *(double *)constants = values[0];
  return 0;
}
static int own_refuse(const double *values, void *constants, char *reason, size_t size)
{
  (void)values, (void)constants, (void)reason, (void)size;
  return 1;
}
static void own_moduli(const void *constants, double *bulk, double *shear)
{
  *bulk = *(const double *)constants / 1.5;
  *shear = *(const double *)constants / 2.5;
}
static void own_no_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = *shear = 0;
}
static int own_update(const void *constants, const breccia_batch *batch)
{
  for (int i = 0; i < batch->count; ++i) {
    batch->stress[0][i] = own_stress * *(const double *)constants * batch->strain[0][i];
    if (batch->tangent) batch->tangent[i] = *(const double *)constants;
    if (batch->trial) batch->trial[i] = batch->committed[i];
  }
  return own_answer;
}
static int own_silent(const void *constants, const breccia_batch *batch)
{
  (void)constants, (void)batch;
  return -1;
}
static int own_values(const void *constants)
{
  (void)constants;
  return 1;
}
static int own_minus_values(const void *constants)
{
  (void)constants;
  return -5;
}
static void own_begin(const void *constants, double *history)
{
  (void)constants;
  *history = own_history;
  own_history += own_growth;
}

static const breccia_law own_law = {.size = sizeof own_law,
                                    .name = "own",
                                    .about = "a bar",
                                    .source = "a test",
                                    .maturity = "experimental",
                                    .parameters = own_parameters,
                                    .parameter_count = 1,
                                    .constants_size = sizeof(double),
                                    .components = 1,
                                    .prepare = own_prepare,
                                    .moduli = own_moduli,
                                    .history_values = own_values,
                                    .begin = own_begin,
                                    .update = own_update};

/** Loads a plate of a law and takes some steps. @param[out] words  of the error, if there is one */
static int own_steps(const breccia_law *law, char *words, size_t size)
{
  char plate[700];
  snprintf(plate, sizeof plate,
           "units: {length: mm, force: N, time: s}\n"
           "materials: {rock: {model: %s, density: 2600 kg/m3, Young modulus: 50 GPa}}\n"
           "body: {b: {material: rock, lattice: square, spacing: 1 mm, thickness: 10 mm, shape: {box: {particles: [8, "
           "5]}}}}\n"
           "peridynamics: {formulation: bond-based, space: plane stress}\n"
           "loads: [{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, velocity: [1, 0]}]\n"
           "solve: {explicit: {steps: 5}}\n",
           law->name);
  breccia_error *error = breccia_error_create();
  const breccia_options options = {.size = sizeof options, .laws = &law, .law_count = 1, .threads = 1};
  breccia_model *model;
  int status = breccia_model_load_string(plate, "plate", &options, &model, error);
  if (!status) status = breccia_model_step(model, 5, error);
  snprintf(words, size, "%s", breccia_error_text(error));
  breccia_model_destroy(&model);
  breccia_error_destroy(&error);
  return status;
}

static void test_laws_that_are_not_whole_are_refused(void **state)
{
  (void)state;
  static const struct {
    const char *name, *words;
    const char *dimension, *range;
    int answer;
    double stress, growth;
    int (*prepare)(const double *, void *, char *, size_t);
    void (*moduli)(const void *, double *, double *);
    int (*values)(const void *);
    int (*update)(const void *, const breccia_batch *);
    int count;
  } cases[] = {
      {.name = "own"}, /* it is whole */
      {.name = "elastic-1d", .words = "law 'elastic-1d': there is a law of this name already"},
      {.dimension = "pressure", .words = "parameter 1, 'Young modulus', has a dimension that is none of those"},
      {.range = "0..inf", .words = "parameter 1, 'Young modulus', has a range that is no interval"},
      {.count = -1, .words = "it has -1 parameters"},
      {.answer = 1000000000, .words = "its 'update' returned 1000000000 for a batch of one point"},
      {.answer = -7, .words = "its 'update' returned -7 for a batch of one point"},
      {.answer = 1, .words = "its 'update' returned 1 for a batch of one point"},
      {.stress = NAN, .words = "its 'update' writes no finite stress for a point without strain"},
      {.update = own_silent, .words = "its 'update' writes no finite stress for a point without strain"},
      {.growth = 1, .words = "its 'begin' writes another history when it is called again"},
      {.prepare = own_refuse, .words = "its 'prepare' refuses the parameters and gives no reason"},
      {.moduli = own_no_moduli, .words = "its 'moduli' are 0 and 0; expected two numbers above 0"},
      {.values = own_minus_values, .words = "its 'history_values' is -5"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char words[1000];
    breccia_law law = own_law;
    if (cases[k].name) law.name = cases[k].name;
    if (cases[k].prepare) law.prepare = cases[k].prepare;
    if (cases[k].moduli) law.moduli = cases[k].moduli;
    if (cases[k].values) law.history_values = cases[k].values;
    if (cases[k].update) law.update = cases[k].update;
    if (cases[k].count) law.parameter_count = cases[k].count;
    own_parameters[0].dimension = cases[k].dimension ? cases[k].dimension : "stress";
    own_parameters[0].range = cases[k].range ? cases[k].range : "(0, inf)";
    own_answer = cases[k].answer ? cases[k].answer : -1;
    own_stress = isnan(cases[k].stress) ? NAN : 1;
    own_growth = cases[k].growth;
    const int status = own_steps(&law, words, sizeof words);
    if (status != (cases[k].words ? BRECCIA_USER_ERROR : BRECCIA_OK))
      fail_msg("case %d: %d: %s", (int)k, status, words);
    if (cases[k].words && !strstr(words, cases[k].words)) fail_msg("no '%s' in: %s", cases[k].words, words);
  }
  own_parameters[0].dimension = "stress";
  own_parameters[0].range = "(0, inf)";
}

/** An index outside of the batch, in a step: the step fails, and nothing beside the batch is read. */
static int own_astray(const void *constants, const breccia_batch *batch)
{
  own_update(constants, batch);
  return batch->time > 0 ? 1 << 30 : -1;
}

static void test_an_index_outside_of_a_batch_fails_the_step(void **state)
{
  (void)state;
  char words[1000];
  breccia_law law = own_law;
  law.update = own_astray;
  own_answer = -1;
  own_stress = 1;
  own_growth = 0;
  assert_int_equal(own_steps(&law, words, sizeof words), BRECCIA_FAILURE);
  assert_non_null(strstr(words, "the law own of material 'rock' could not be integrated"));
}

/* ---- processes, interrupts, motions of a program ---- */

static void test_a_child_of_a_fork_is_told_that_it_has_no_threads(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* the thread sanitizer ends children of processes with threads */
  breccia_error *error = breccia_error_create();
  const breccia_options options = {.size = sizeof options, .threads = 2};
  breccia_model *model;
  assert_int_equal(breccia_model_load_string(deck, "bar", &options, &model, error), BRECCIA_OK);
  assert_int_equal(breccia_model_step(model, 2, error), BRECCIA_OK);
  const pid_t child = fork();
  if (!child) {
    alarm(20);
    const int status = breccia_model_step(model, 2, error);
    const bool told = strstr(breccia_error_text(error), "the model was made by another process") != NULL;
    breccia_model_destroy(&model);
    _exit(status == BRECCIA_USER_ERROR && told ? 0 : 1);
  }
  int end;
  assert_int_equal(waitpid(child, &end, 0), child);
  if (!WIFEXITED(end) || WEXITSTATUS(end)) fail_msg("the child ended with %d", end);
  assert_int_equal(breccia_model_step(model, 2, error), BRECCIA_OK); /* the parent goes on */
  breccia_model_destroy(&model);
  breccia_error_destroy(&error);
}

static void test_steps_can_be_interrupted(void **state)
{
  (void)state;
  static volatile int stop;
  breccia_error *error = breccia_error_create();
  const breccia_options options = {.size = sizeof options, .threads = 1, .interrupted = &stop};
  breccia_model *model;
  stop = 0;
  assert_int_equal(breccia_model_load_string(deck, "bar", &options, &model, error), BRECCIA_OK);
  assert_int_equal(breccia_model_step(model, 3, error), BRECCIA_OK);
  stop = 1;
  assert_int_equal(breccia_model_step(model, 3, error), BRECCIA_INTERRUPTED);
  assert_int_equal(breccia_model_steps_done(model), 3);
  stop = 0;
  assert_int_equal(breccia_model_step(model, INT64_MAX, error), BRECCIA_OK);
  assert_int_equal(breccia_model_steps_done(model), 40);
  breccia_model_destroy(&model);
  breccia_error_destroy(&error);
}

/** A grip that a program moves by what it writes takes as much work as one that the deck moves: energies balance, as
 * the work is booked. */
static void test_the_work_of_a_program_is_booked(void **state)
{
  (void)state;
  static const char free_bar[] =
      "units: {length: m, force: kN, time: s}\n"
      "materials: {steel: {model: elastic, density: 7.85 t/m3, Young modulus: 210 GPa, Poisson ratio: 0.25}}\n"
      "body: {bar: {material: steel, spacing: 0.125 m, shape: {box: {particles: [10, 3, 3]}}}}\n"
      "solve: {explicit: {steps: 60}}\n";
  for (int how = 0; how < 3; ++how) { /* velocities, displacements, both */
    breccia_error *error = breccia_error_create();
    breccia_model *model;
    assert_int_equal(breccia_model_load_string(free_bar, "bar", NULL, &model, error), BRECCIA_OK);
    const double *x = breccia_model_array(model, "position x");
    double *u = breccia_model_array(model, "displacement x"), *v = breccia_model_array(model, "velocity x");
    const int32_t *number = breccia_model_numbers(model);
    const double dt = breccia_model_time_step(model);
    for (int step = 1; step <= 60; ++step) {
      assert_int_equal(breccia_model_step(model, 1, error), BRECCIA_OK);
      for (int64_t i = 0; i < breccia_model_places(model); ++i) {
        if (number[i] < 0 || x[i] < 1.1) continue;
        if (how != 1) v[i] = 0.5;
        if (how != 0) u[i] = 0.5 * dt * step;
      }
    }
    const Energy e = solver_energy(&model->solver);
    assert_true(e.external > 0 && e.kinetic > 0.01 * e.external);
    if (!(e.imbalance < 0.02)) fail_msg("way %d: imbalance %g of %g", how, e.imbalance, e.external);
    breccia_model_destroy(&model);
    breccia_error_destroy(&error);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_the_host_stays_as_it_was),
      cmocka_unit_test(test_numbers_have_points_in_every_country),
      cmocka_unit_test(test_a_struct_without_its_size_is_refused),
      cmocka_unit_test(test_an_older_and_a_newer_program_are_understood),
      cmocka_unit_test(test_every_struct_is_read_by_its_size),
      cmocka_unit_test(test_arrays_are_all_named_and_what_is_written_to_them_counts),
      cmocka_unit_test(test_what_is_missing_is_asked_for),
      cmocka_unit_test(test_null_pointers_are_refused),
      cmocka_unit_test(test_lists_without_items_are_refused),
      cmocka_unit_test(test_laws_that_are_not_whole_are_refused),
      cmocka_unit_test(test_an_index_outside_of_a_batch_fails_the_step),
      cmocka_unit_test(test_a_child_of_a_fork_is_told_that_it_has_no_threads),
      cmocka_unit_test(test_steps_can_be_interrupted),
      cmocka_unit_test(test_the_work_of_a_program_is_booked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
