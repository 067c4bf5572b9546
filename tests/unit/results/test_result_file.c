/* Result files: what is read back is what was written, or is refused. */
#include "support.h"

#include "results/bar_view.h"
#include "results/picture.h"
#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/breccia-results-XXXXXX", path[64], whole[64];

/** A bar that is being torn, written six times. */
static void write_results(void)
{
  breccia_model *model = model_of(
      "title: A bar is torn\nunits: {length: m, force: kN, time: s}\n"
      "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}\n"
      "  steel: {model: steel-bilinear, density: 7, Young modulus: 1e4, yield stress: 10, hardening ratio: 0.01}\n"
      "bars: {bar: {points: [[1, 1, 1], [10, 1, 1]], area: 0.01, material: steel}}\nbody:\n"
      "  a: {material: m, spacing: 1, shape: {box: {particles: [12, 4, 3]}}}\n"
      "  b: {material: m, lattice: face-centred cubic, spacing: 1, shape: {box: {particles: [4, 4, 4], first particle: "
      "[20, 0, 0]}}}\n"
      "failure: {critical stretch: 0.01}\n"
      "loads: [{on: {face: x-, layers: 2}, velocity: [-3, 0, 0]}, {on: {face: x+, layers: 2}, velocity: [3, 0, 0]}]\n"
      "solve: {explicit: {steps: 200}}\n"
      "results: {number: 5, fields: [displacement, stress, damage]}\n"
      "pictures: []\n");
  Error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof run, .folder = folder};
  if (breccia_model_run(model, &run, error)) fail_msg("%s", breccia_error_text(error));
  assert_true(breccia_model_broken_bonds(model) > 0);
  breccia_error_destroy(&error);
  breccia_model_destroy(&model);
}

/** A number that other bytes are unlikely to have (Fowler, Noll and Vo's hash). */
static void add_bits(Text *all, const char *what, const void *values, size_t bytes)
{
  uint64_t sum = 14695981039346656037u;
  for (size_t k = 0; k < bytes; ++k) sum = (sum ^ ((const unsigned char *)values)[k]) * 1099511628211u;
  text_add(all, "%s %zu bytes %016llx\n", what, bytes, (unsigned long long)sum);
}

static int add_fields(const ResultView *view, Text *all, Error *error)
{
  Text names = {0};
  result_view_fields(view, &names);
  text_add(all, "fields %s\n", text_words(&names));
  if (!names.length) { /* their list is damaged: that is told of a field that is asked for */
    int components;
    assert_null(result_view_read(view, "damage", 0, &components, NULL, error));
    return BRECCIA_USER_ERROR;
  }
  for (char *rest = names.characters, *name; (name = strtok_r(rest, ",", &rest));) {
    name += *name == ' '; /* "bond damage" is one name */
    for (int k = 0; k < view->steps; ++k) {
      char unit[64] = "";
      int components;
      double *values = result_view_read(view, name, k, &components, unit, error);
      if (!values) {
        text_free(&names);
        return BRECCIA_USER_ERROR;
      }
      add_bits(all, unit, values, sizeof(double) * (size_t)(view->particles * components));
      free(values);
    }
  }
  text_free(&names);
  return BRECCIA_OK;
}

static int add_bars(const ResultView *view, Text *all, Error *error)
{
  static const char *const columns[] = {"strain", "stress", "force", "dissipated"};
  BarView bars;
  int status = bar_view_open(&bars, view, error);
  if (status) return status;
  text_add(all, "bar %s\n", bars.name[0]);
  add_bits(all, "nodes", bars.points, 3 * sizeof(double) * (size_t)bars.nodes);
  for (int k = 0; k < 5 * view->steps && !status; ++k) {
    char unit[64] = "displacement";
    const int step = k / 5;
    double *values = k % 5 ? bar_view_read(&bars, view, columns[k % 5 - 1], step, unit, error)
                           : bar_view_displacements(&bars, view, step, error);
    if (values)
      add_bits(all, unit, values, sizeof(double) * (size_t)(k % 5 ? bars.elements : 3 * bars.nodes));
    else
      status = result_view_lost(view);
    free(values);
  }
  bar_view_close(&bars);
  return status;
}

/** All that can be read from the file, in words. @param[out] words  of a refusal, 512 bytes @return status */
static int read_everything(Text *all, char *words)
{
  Error *error = breccia_error_create();
  ResultView view;
  int status = result_view_open(&view, path, error);
  if (!status) {
    const size_t n = (size_t)view.particles;
    text_add(all, "%s %s %s %d %d %lld\n", view.title, view.length_unit, view.time_unit, view.plane, view.steps,
             (long long)view.particles);
    add_bits(all, "steps", view.step_numbers, sizeof(int64_t) * (size_t)view.steps);
    add_bits(all, "times", view.times, sizeof(double) * (size_t)view.steps);
    add_bits(all, "positions", view.positions, 3 * sizeof(double) * n);
    add_bits(all, "spacings", view.spacings, sizeof(double) * n);
    for (size_t k = 0; k < n; ++k) text_add(all, "%s ", result_view_lattice(&view, (int64_t)k)->name);
    for (int k = 0; k < view.steps; ++k) {
      int64_t count, *pairs = result_view_broken(&view, k, &count);
      add_bits(all, "broken", pairs, 2 * sizeof(int64_t) * (size_t)count);
      free(pairs);
    }
    status = add_fields(&view, all, error);
    if (!status) status = add_bars(&view, all, error);
    result_view_close(&view);
  }
  assert_int_equal(error_count(error), status != 0);
  snprintf(words, 512, "%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return status;
}

/** Whether a restart would go on from the file. */
static bool is_whole(void)
{
  Error *error = breccia_error_create();
  ResultView view;
  int status = result_view_open(&view, path, error);
  if (!status) {
    status = result_view_verify(&view, path, error);
    result_view_close(&view);
  }
  assert_int_equal(error_count(error), status != 0);
  breccia_error_destroy(&error);
  return !status;
}

static int begin(void **state)
{
  (void)state;
  if (!mkdtemp(folder)) return 1;
  snprintf(path, sizeof path, "%s/results.vtkhdf", folder);
  snprintf(whole, sizeof whole, "%s/whole", folder);
  write_results();
  return 0;
}

static int end(void **state)
{
  (void)state;
  static const char *const files[] = {"results.vtkhdf", "results.xdmf",  "checkpoint.h5", "summary.json",
                                      "deck.yaml",      "bars/bars.csv", "bars/bars.vtp"};
  for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
    char name[96];
    snprintf(name, sizeof name, "%s/%s", folder, files[k]);
    unlink(name);
  }
  char bars[96];
  snprintf(bars, sizeof bars, "%s/bars", folder);
  return rmdir(bars) || rmdir(folder); /* nothing else is left there */
}

/** Flips a bit, or flips it back. */
static void flip(int64_t at, int bit)
{
  const int file = open(path, O_RDWR);
  unsigned char byte;
  assert_int_equal(pread(file, &byte, 1, at), 1);
  byte ^= (unsigned char)(1 << bit);
  assert_int_equal(pwrite(file, &byte, 1, at), 1);
  close(file);
}

/** Any bit of any byte: either the numbers are those that were written, or the file is refused in a line that names what is damaged. */
static void no_flipped_byte_is_believed(void **state)
{
  (void)state;
  struct stat status;
  assert_int_equal(stat(path, &status), 0);
  const char *flips = getenv("BRECCIA_FLIPS");
  const int64_t count = flips ? atoll(flips) : 120, bytes = status.st_size;
  char words[512];
  Text right = {0};
  int64_t refused = 0;
  assert_int_equal(read_everything(&right, words), 0);
  assert_true(strstr(text_words(&right), "face-centred cubic"));
  assert_true(is_whole());
  for (int64_t k = 0; k < count; ++k) {
    const int64_t at = k * bytes / count + (k * 97) % (bytes / count);
    Text found = {0};
    flip(at, (int)(k % 8));
    if (!read_everything(&found, words)) {
      if (strcmp(text_words(&found), text_words(&right)))
        fail_msg("byte %lld of %lld flipped and believed", (long long)at, (long long)bytes);
    } else {
      ++refused;
      if (is_whole()) fail_msg("byte %lld of %lld flipped, and a restart goes on", (long long)at, (long long)bytes);
      if (strncmp(words, path, strlen(path)) ||
          (!strstr(words, "is damaged: ") && !strstr(words, "is not a result file")))
        fail_msg("byte %lld of %lld: %s", (long long)at, (long long)bytes, words);
    }
    flip(at, (int)(k % 8));
    text_free(&found);
  }
  print_message("results: %lld of %lld flipped bytes were refused, the others changed nothing\n", (long long)refused,
                (long long)count);
  assert_true(refused > count / 2);
  text_free(&right);
}

/** Writes over some bytes, or puts back what was there. */
static void exchange_bytes(int64_t at, void *bytes, size_t size)
{
  char *there = malloc(size);
  const int file = open(path, O_RDWR);
  assert_int_equal(pread(file, there, size, at), (ssize_t)size);
  assert_int_equal(pwrite(file, bytes, size, at), (ssize_t)size);
  close(file);
  memcpy(bytes, there, size);
  free(there);
}

/** Global heaps are metadata without a checksum, in which zeros would let HDF5 walk on the spot for ever, and large
 * sizes read beyond them. */
static void damaged_heaps_are_refused(void **state)
{
  (void)state;
  size_t size;
  int heaps = 0;
  char *all = text_read_file(path, &size), words[512];
  assert_non_null(all);
  alarm(60);
  for (size_t at = 0; at + 4096 <= size; ++at) {
    if (memcmp(all + at, "GCOL\1\0\0\0", 8)) continue;
    ++heaps;
    for (int kind = 0; kind < 4; ++kind) { /* objects, their sizes, their numbers, a byte in a mapping */
      unsigned char bytes[512] = {0};
      const size_t count[] = {sizeof bytes, 8, 2, 1}, offset[] = {16, 24, 16, 40};
      if (kind == 1) memset(bytes, 0xff, 8);
      if (kind == 3) bytes[0] = (unsigned char)~all[at + 40];
      exchange_bytes((int64_t)(at + offset[kind]), bytes, count[kind]);
      Text found = {0};
      if (is_whole()) fail_msg("heap at %zu, damage %d: believed", at, kind);
      (void)read_everything(&found, words); /* comes to an end */
      text_free(&found);
      exchange_bytes((int64_t)(at + offset[kind]), bytes, count[kind]);
    }
  }
  alarm(0);
  free(all);
  assert_true(heaps > 0);
  assert_true(is_whole());
}

/** Returns the middle of the last chunk of a dataset as its offset in the file. */
static int64_t middle_of_last_chunk(const char *name, hsize_t *bytes)
{
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), set = H5Dopen(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(set), type = H5Dget_type(set);
  hsize_t chunks = 0, offset[H5S_MAX_RANK], size = 0;
  haddr_t at = HADDR_UNDEF;
  unsigned skipped;
  assert_true(file >= 0 && set >= 0);
  assert_true(H5Dget_num_chunks(set, space, &chunks) >= 0 && chunks > 0);
  assert_true(H5Dget_chunk_info(set, space, chunks - 1, offset, &skipped, &at, &size) >= 0 && at != HADDR_UNDEF);
  *bytes = (hsize_t)H5Sget_simple_extent_npoints(space) * H5Tget_size(type);
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return (int64_t)(at + size / 2);
}

/** A restart reads large datasets in pieces of 4 MiB: a flipped bit in the last piece of 5.8 MB is found, too. */
static void damage_behind_the_first_pieces_is_found(void **state)
{
  (void)state;
  char usual[sizeof path], other[] = "/tmp/breccia-pieces-XXXXXX";
  memcpy(usual, path, sizeof path);
  assert_non_null(mkdtemp(other));
  breccia_model *model =
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
               "body: {b: {material: m, spacing: 1, shape: {box: {particles: [20, 10, 10]}}}}\n"
               "loads: [{on: {face: x+, layers: 2}, velocity: [3, 0, 0]}]\nsolve: {explicit: {steps: 80}}\n"
               "results: {number: 80, fields: [deformation gradient]}\npictures: []\n");
  Error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof run, .folder = other};
  if (breccia_model_run(model, &run, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  breccia_model_destroy(&model);
  snprintf(path, sizeof path, "%s/results.vtkhdf", other);
  hsize_t bytes;
  const int64_t at = middle_of_last_chunk("VTKHDF/PointData/deformation gradient", &bytes);
  const bool before = is_whole();
  flip(at, 3);
  const bool damaged = is_whole();
  flip(at, 3);
  const bool after = is_whole();
  static const char *const files[] = {"results.vtkhdf", "results.xdmf", "checkpoint.h5", "summary.json", "deck.yaml"};
  for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
    char name[96];
    snprintf(name, sizeof name, "%s/%s", other, files[k]);
    unlink(name);
  }
  memcpy(path, usual, sizeof path);
  assert_int_equal(rmdir(other), 0);
  assert_true(bytes > (hsize_t)5 << 20);
  assert_true(before && !damaged && after);
}

/** A picture of another field shows displacements too: damaged ones do not turn into the shape at the start. */
static void what_was_written_of_the_run_is_read_back(void **state)
{
  (void)state;
  ResultView view;
  assert_int_equal(result_view_open(&view, path, NULL), 0);
  assert_string_equal(view.title, "A bar is torn");
  assert_string_equal(view.length_unit, "m");
  assert_string_equal(view.time_unit, "s");
  assert_int_equal(view.plane, 0);
  assert_int_equal(view.steps, 6);
  assert_int_equal(view.particles, 12 * 4 * 3 + 4 * 4 * 4);
  assert_int_equal(view.step_numbers[0], 0);
  for (int k = 1; k < view.steps; ++k)
    assert_true(view.step_numbers[k] > view.step_numbers[k - 1] && view.times[k] > view.times[k - 1]);
  for (int64_t n = 0; n < view.particles; ++n) assert_true(view.spacings[n] == 1);
  result_view_close(&view);
}

static void a_picture_does_not_leave_out_a_damaged_displacement(void **state)
{
  (void)state;
  struct stat status;
  assert_int_equal(stat(path, &status), 0);
  char words[512] = "", picture[96];
  snprintf(picture, sizeof picture, "%s/damage.png", folder);
  int64_t at = 0;
  for (; at < status.st_size; at += 1000) {
    Text found = {0};
    flip(at, 0);
    read_everything(&found, words);
    text_free(&found);
    if (strstr(words, "is damaged: VTKHDF/PointData/displacement at step 0 ")) break;
    flip(at, 0);
  }
  assert_true(at < status.st_size);
  ResultView view;
  Error *error = breccia_error_create();
  assert_int_equal(result_view_open(&view, path, error), 0);
  const PictureOptions damage = {
      .field = "damage", .deformed = 1, .azimuth = NAN, .elevation = NAN, .low = NAN, .high = NAN};
  assert_int_equal(picture_draw(&view, 0, &damage, NULL, picture, error), BRECCIA_USER_ERROR);
  assert_non_null(strstr(breccia_error_text(error), "is damaged: VTKHDF/PointData/displacement at step 0 "));
  assert_int_equal(access(picture, F_OK), -1);
  flip(at, 0);
  breccia_error_destroy(&error);
  error = breccia_error_create();
  assert_int_equal(picture_draw(&view, 0, &damage, NULL, picture, error), 0);
  unlink(picture);
  result_view_close(&view);
  breccia_error_destroy(&error);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_was_written_of_the_run_is_read_back), cmocka_unit_test(no_flipped_byte_is_believed),
      cmocka_unit_test(damaged_heaps_are_refused), cmocka_unit_test(damage_behind_the_first_pieces_is_found),
      cmocka_unit_test(a_picture_does_not_leave_out_a_damaged_displacement)};
  return cmocka_run_group_tests(tests, begin, end);
}
