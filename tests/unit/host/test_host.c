/* What a process that embeds the library finds afterwards: everything of its own as it was; and structs of other versions of the header. */
#include "support.h"

#include <breccia/breccia.h>
#include <dirent.h>
#include <fenv.h>
#include <hdf5.h>
#include <locale.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
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
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
