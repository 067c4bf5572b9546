/* What people read of a run says what happened: one known state, no two of whose numbers are alike, through histories, fields, summary and
 * pictures. */
#include "support.h"

#include "base/csv.h"
#include "base/tensor.h"
#include "results/fields.h"
#include "results/picture.h"
#include <hdf5.h>
#include <unistd.h>

static char folder[] = "/tmp/breccia-XXXXXX";

static int make_folder(void **state)
{
  (void)state;
  return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state)
{
  (void)state;
  char command[80];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

/** A body of 5 x 4 x 6 with small strains; lambda = G = 4 kPa. */
static breccia_model *body(const char *rest)
{
  return model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: elastic, density: 2, Young modulus: 10, Poisson ratio: 0.25}}\n"
      "peridynamics: {strain: small}\nbody: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 6]}}}}\n"
      "solve: {explicit: {time step: 1e-9, steps: 1}}\n%s",
      rest);
}

static void run_into(breccia_model *m, const char *name, char *path, size_t size)
{
  breccia_error *error = breccia_error_create();
  snprintf(path, size, "%s/%s", folder, name);
  breccia_run run = {.size = sizeof(breccia_run), .folder = path};
  if (breccia_model_run(m, &run, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

/** A number of the first row of a history. @param[out] heading  with its unit; NULL: not wanted */
static double first_of(const char *path, const char *watch, const char *column, char *heading)
{
  char file[128], label[128];
  int count = 0;
  snprintf(file, sizeof file, "%s/%s.csv", path, watch);
  double *values = csv_column(file, column, CSV_FINISHED, &count, label, NULL);
  if (!values || !count) fail_msg("%s has no column '%s'", file, column);
  const double first = values[0];
  free(values);
  if (heading) strcpy(heading, label);
  return first;
}

/** A number of summary.json. */
static double told(const char *path, const char *key)
{
  char file[128], quoted[64];
  snprintf(file, sizeof file, "%s/summary.json", path);
  snprintf(quoted, sizeof quoted, "\"%s\": ", key);
  char *text = text_read_file(file, NULL), *at = text ? strstr(text, quoted) : NULL;
  if (!at) fail_msg("%s does not tell '%s'", file, key);
  const double value = strtod(at + strlen(quoted), NULL);
  free(text);
  return value;
}

/** Octahedral shear of six components of a tensor, by the differences of its normal ones. */
static double octahedral(const double t[6])
{
  return sqrt(pow(t[0] - t[1], 2) + pow(t[1] - t[2], 2) + pow(t[2] - t[0], 2) +
              6 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5])) /
         3;
}

static double field(const breccia_model *m, const char *name, int component)
{
  double value[9];
  const OutputField *f = output_field_find(name);
  assert_non_null(f);
  f->value(&m->domain, m->domain.particles->place_of[57], value);
  return value[component];
}

/** What results.xdmf points to for a field at the last write must be these numbers of particle 57. */
static void assert_pointed_to(const char *path, const char *name, const double *expected, int components, double off)
{
  char file[128], words[128], set_name[128], shape[32];
  snprintf(file, sizeof file, "%s/results.xdmf", path);
  snprintf(words, sizeof words, "<Attribute Name=\"%s\"", name);
  char *text = text_read_file(file, NULL), *at = text, *last = NULL;
  while (at && (at = strstr(at, words))) last = at++;
  if (!last) fail_msg("%s does not name '%s'", file, name);
  snprintf(shape, sizeof shape,
           components == 1   ? "Dimensions=\"120\""
           : components == 3 ? "Dimensions=\"120 %d\""
                             : "Dimensions=\"120 1 %d\"",
           components);
  at = strstr(last, "results.vtkhdf:");
  assert_true(strstr(last, shape) && strstr(last, shape) < at);
  snprintf(set_name, sizeof set_name, "%.*s", (int)strcspn(strchr(at, ':') + 1, "<"), strchr(at, ':') + 1);
  free(text);
  snprintf(file, sizeof file, "%s/results.vtkhdf", path);
  const hid_t h5 = H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT), set = H5Dopen2(h5, set_name, H5P_DEFAULT);
  double values[9 * 120];
  assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  for (int k = 0; k < components; ++k) assert_near(values[57 * components + k], expected[k], off);
  H5Dclose(set);
  H5Fclose(h5);
}

static void one_state_reads_alike_wherever_it_is_told(void **state)
{
  (void)state;
  static const char *const names[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  for (int sign = -1; sign <= 1; sign += 2) { /* pressed from all sides, and drawn */
    breccia_model *m = body(
        "watch: {all: {stress and strain of: {all: yes}, every: 1}, ends: {displacement of: {nearest: "
        "[0.45, 0.05, 0.55]}, every: 1}}\nresults: {every: 1, precision: double, fields: [stress, strain, deformation "
        "gradient, octahedral shear stress, octahedral shear strain, deviator norm, mean stress, displacement]}\n");
    const double a = sign * 1e-3,
                 gradient[9] = {3 * a, 0.5 * a, -0.2 * a, 1.1 * a, 5 * a, 0.9 * a, 0.4 * a, -2.1 * a, 11 * a};
    double f[9], strain[6], stress[6], tensor[6], volume = 0;
    char path[80];
    for (int k = 0; k < 9; ++k) f[k] = gradient[k] + (k % 4 == 0);
    for (int k = 0; k < 6; ++k) {
      tensor[k] = (gradient[3 * symmetric_row[k] + symmetric_column[k]] +
                   gradient[3 * symmetric_column[k] + symmetric_row[k]]) /
                  2;
      strain[k] = k < 3 ? tensor[k] : 2 * tensor[k];
      volume += k < 3 ? tensor[k] : 0;
    }
    for (int k = 0; k < 6; ++k) stress[k] = 8 * tensor[k] + (k < 3 ? 4 * volume : 0);
    const double mean = (stress[0] + stress[1] + stress[2]) / 3, tau = octahedral(stress), off = 1e-6 * 1e-2 * 10;
    deform_uniformly(m, f);
    run_into(m, sign < 0 ? "pressed" : "drawn", path, sizeof path);
    for (int k = 0; k < 6; ++k) {
      char column[32];
      snprintf(column, sizeof column, "strain %s", names[k]);
      assert_near(first_of(path, "all", column, NULL), strain[k], off);
      assert_near(field(m, "strain", k), strain[k], off);
      snprintf(column, sizeof column, "stress %s", names[k]);
      assert_near(first_of(path, "all", column, NULL), stress[k], off);
      assert_near(field(m, "stress", k), stress[k], off);
    }
    assert_near(first_of(path, "all", "octahedral shear strain", NULL), 2 * octahedral(tensor), off);
    assert_near(field(m, "octahedral shear strain", 0), 2 * octahedral(tensor), off);
    assert_near(first_of(path, "all", "octahedral shear stress", NULL), tau, off);
    assert_near(field(m, "octahedral shear stress", 0), tau, off);
    assert_near(field(m, "deviator norm", 0), sqrt(3) * tau, off);
    assert_near(field(m, "von Mises stress", 0), 3 / sqrt(2) * tau, off);
    assert_near(first_of(path, "all", "mean stress", NULL), mean, off);
    assert_near(field(m, "mean stress", 0), mean, off);
    const double corner[3] = {0.45, 0.05, 0.55};
    for (int k = 0; k < 3; ++k) {
      double moved = 0;
      for (int j = 0; j < 3; ++j) moved += gradient[3 * k + j] * corner[j];
      assert_near(first_of(path, "ends", (const char *[]){"x", "y", "z"}[k], NULL), moved, off);
    }
    for (int k = 0; k < 9; ++k) assert_near(field(m, "deformation gradient", k), f[k], off);
    /* Tensors stand in files as VTK and ParaView read them: xx yy zz xy yz xz, and row by row. */
    assert_pointed_to(path, "stress", stress, 6, off);
    assert_pointed_to(path, "strain", strain, 6, off);
    assert_pointed_to(path, "deformation gradient", f, 9, off);
    assert_pointed_to(path, "octahedral shear stress", &tau, 1, off);
    assert_pointed_to(path, "octahedral shear strain", (const double[]){2 * octahedral(tensor)}, 1, off);
    assert_pointed_to(path, "deviator norm", (const double[]){sqrt(3) * tau}, 1, off);
    assert_pointed_to(path, "mean stress", &mean, 1, off);
    const Particles *p = m->domain.particles;
    double there[3] = {0};
    for (int k = 0; k < 9; ++k) there[k / 3] += gradient[k] * p->position[k % 3][p->place_of[57]];
    assert_pointed_to(path, "displacement", there, 3, off);
    assert_near(told(path, "octahedral_shear_stress"), tau, off);
    assert_near(told(path, "mean_stress_lowest"), mean, off);
    assert_near(told(path, "mean_stress_highest"), mean, off);
    breccia_model_destroy(&m);
  }
}

/** Least and largest value of a field over all particles and written states; of vectors their length. */
static void survey_field(const ResultView *view, const char *name, double *least, double *largest)
{
  *least = INFINITY;
  *largest = -INFINITY;
  for (int step = 0; step < view->steps; ++step) {
    int components;
    double *values = result_view_read(view, name, step, &components, NULL, NULL);
    assert_non_null(values);
    for (int64_t n = 0; n < view->particles; ++n) {
      double square = 0;
      for (int k = 0; k < components; ++k) square += pow(values[n * components + k], 2);
      const double value = components > 1 ? sqrt(square) : values[n];
      *least = fmin(*least, value);
      *largest = fmax(*largest, value);
    }
    free(values);
  }
}

/** A layer whose strain along z goes from tension at its foot to the same compression at its top: its mean stresses are
 * of both signs, and no two layers of particles have the same. */
/** Arrays that a program asks for by name hold the strain and stress of the particles as they stand. */
static void arrays_by_name_are_those_of_now(void **state)
{
  (void)state;
  static const char *const parts[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  for (int of = 0; of < 2; ++of) { /* what is asked for first brings both up to date */
    breccia_model *m = body("loads: [{on: {face: x+}, traction: [0.5, 0.2, 0.1]}]\n");
    const Particles *p = m->domain.particles;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      for (int k = 0; k < 3; ++k) p->displacement.row[k][i] = 1e-3 * p->position[0][i] * (k + 1);
    }
    for (int k = 0; k < 6; ++k) {
      char name[16];
      snprintf(name, sizeof name, "%s %s", of ? "stress" : "strain", parts[k]);
      const double *values = breccia_model_array(m, name);
      assert_non_null(values);
      for (int64_t n = 0; n < p->count; ++n) {
        double look[2][6];
        domain_look(&m->domain, p->place_of[n], look[0], look[1]);
        assert_near(values[p->place_of[n]], look[of][k], 1e-9);
      }
    }
    const double *stress = breccia_model_array(m, "stress xx");
    assert_near(stress[p->place_of[p->count / 2]], 12e-3, 1e-4); /* (lambda + 2 G) e */
    breccia_model_destroy(&m);
  }
}

static void the_peaks_of_a_summary_are_extremes_over_all_particles(void **state)
{
  (void)state;
  breccia_model *m = body("results: {every: 1, precision: double, fields: [mean stress, octahedral shear stress, "
                          "displacement]}\n");
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const double z = p->position[2][p->place_of[n]];
    p->displacement.row[2][p->place_of[n]] = 1e-3 * z * (0.6 - z);
  }
  char path[80], file[112];
  run_into(m, "peaks", path, sizeof path);
  snprintf(file, sizeof file, "%s/results.vtkhdf", path);
  ResultView view;
  assert_int_equal(result_view_open(&view, file, NULL), 0);
  double least, largest;
  survey_field(&view, "mean stress", &least, &largest);
  assert_true(largest > 1e-3); /* kPa: K = 20 / 3 kPa times a strain of some 4e-4 */
  assert_near(least, -largest, 1e-9 * largest);
  assert_near(told(path, "mean_stress_lowest"), least, 1e-9 * largest);
  assert_near(told(path, "mean_stress_highest"), largest, 1e-9 * largest);
  survey_field(&view, "octahedral shear stress", &least, &largest);
  assert_near(told(path, "octahedral_shear_stress"), largest, 1e-9 * largest);
  survey_field(&view, "displacement", &least, &largest);
  assert_near(told(path, "displacement"), largest, 1e-9 * largest);
  result_view_close(&view);
  breccia_model_destroy(&m);
}

static void a_watched_load_has_the_unit_and_value_of_what_it_prescribes(void **state)
{
  (void)state;
  const struct {
    const char *load, *heading;
    double value;
  } cases[] = {{"along: {direction: [0, 3, -4], displacement: 0.0025}", "value (m)", 0.0025},
               {"along: {direction: [0, 3, -4], velocity: 2}", "value (m/s)", 2},
               {"along: {direction: [0, 3, -4], acceleration: 7}", "value (m/s2)", 7},
               {"displacement: [0, 0.003, 0.004]", "value (m)", 0.005},
               {"velocity: [0, 3, 4]", "value (m/s)", 5},
               {"acceleration: [0, 3, 4]", "value (m/s2)", 5},
               {"force: [0, 3, 4]", "value (kN)", 5},
               {"body force: [0, 3, 4]", "value (kN/m3)", 5},
               {"pressure: 6", "value (kPa)", 6}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char rest[400], path[80], name[16], heading[128];
    snprintf(name, sizeof name, "load%d", (int)k);
    snprintf(rest, sizeof rest,
             "loads: [{name: it, on: {face: x+}, %s, history: {constant: yes}}]\nwatch: {it: {load: it, every: 1}}\n",
             cases[k].load);
    breccia_model *m = body(rest);
    run_into(m, name, path, sizeof path);
    assert_near(first_of(path, "it", "value", heading), cases[k].value, 1e-12);
    if (strcmp(heading, cases[k].heading) != 0)
      fail_msg("%s is told as '%s' and not as '%s'", cases[k].load, heading, cases[k].heading);
    breccia_model_destroy(&m);
  }
}

/** Mean of x and of y, down from the top, of the body's pixels that are darker or lighter than the middle of the colours; words and the bar
 *  at the right are no part of it. */
static void find_halves(const unsigned char *pixels, int wide, int high, double dark[2], double light[2])
{
  double sum[2][3] = {{0}};
  for (int y = 0; y < high; ++y)
    for (int x = 0; x < wide - 110; ++x) {
      const unsigned char *p = pixels + 4 * (y * wide + x);
      const int most = p[0] > p[1] ? (p[0] > p[2] ? p[0] : p[2]) : (p[1] > p[2] ? p[1] : p[2]),
                least = p[0] < p[1] ? (p[0] < p[2] ? p[0] : p[2]) : (p[1] < p[2] ? p[1] : p[2]);
      if (most - least < 40) continue;
      double *half = sum[p[0] + p[1] + p[2] > 300];
      half[0] += x;
      half[1] += y;
      half[2] += 1;
    }
  assert_true(sum[0][2] > 1000 && sum[1][2] > 1000);
  for (int k = 0; k < 2; ++k) {
    dark[k] = sum[0][k] / sum[0][2];
    light[k] = sum[1][k] / sum[1][2];
  }
}

static void bodies_in_space_stand_upright_in_pictures(void **state)
{
  (void)state;
  /* What moves more is lighter: once what is above, once what lies along x, which the eye at -60 degrees sees at the right. */
  for (int axis = 0; axis < 3; axis += 2) {
    breccia_model *m = body("results: {every: 1}\n");
    const Particles *p = m->domain.particles;
    for (int64_t n = 0; n < p->count; ++n)
      p->displacement.row[2][p->place_of[n]] = 1e-3 * p->position[axis][p->place_of[n]];
    char path[80], file[112];
    run_into(m, axis ? "up" : "right", path, sizeof path);
    snprintf(file, sizeof file, "%s/results.vtkhdf", path);
    ResultView view;
    assert_int_equal(result_view_open(&view, file, NULL), 0);
    const PictureOptions o = {
        .field = "displacement", .deformed = 0, .azimuth = NAN, .elevation = NAN, .low = NAN, .high = NAN};
    PictureSurvey survey;
    assert_int_equal(picture_survey(&view, 0, 0, true, &o, &survey, NULL), 0);
    int wide, high;
    unsigned char *pixels = picture_pixels(&view, 0, &o, &survey, &wide, &high, NULL);
    assert_non_null(pixels);
    double dark[2], light[2];
    find_halves(pixels, wide, high, dark, light);
    if (axis)
      assert_true(light[1] < dark[1] - 50);
    else
      assert_true(light[0] > dark[0] + 50);
    free(pixels);
    result_view_close(&view);
    breccia_model_destroy(&m);
  }
}

/** The eye takes light to fall from above, and from the left: a ball that is lit from elsewhere looks like a hollow. */
static void a_ball_is_lit_from_above_and_from_the_left(void **state)
{
  (void)state;
  breccia_model *m = body("results: {every: 1}\n");
  const Particles *p = m->domain.particles;
  Sphere around = {.radius = 0.01};
  for (int k = 0; k < 3; ++k) around.centre[k] = p->position[k][p->place_of[57]];
  const Shape ball = {.sphere = &around};
  for (int64_t n = 0; n < p->count; ++n) p->displacement.row[2][p->place_of[n]] = 1e-3; /* all of one colour */
  char path[80], file[112];
  run_into(m, "ball", path, sizeof path);
  snprintf(file, sizeof file, "%s/results.vtkhdf", path);
  ResultView view;
  assert_int_equal(result_view_open(&view, file, NULL), 0);
  const PictureOptions o = {
      .field = "displacement", .azimuth = -60, .elevation = 25, .low = 0, .high = 2e-3, .inside = &ball};
  PictureSurvey survey;
  assert_int_equal(picture_survey(&view, 0, 0, true, &o, &survey, NULL), 0);
  int wide, high;
  unsigned char *pixels = picture_pixels(&view, 0, &o, &survey, &wide, &high, NULL);
  assert_non_null(pixels);
  double place[2] = {0}, lit[2] = {0}, count = 0, light = 0;
  for (int y = 0; y < high; ++y)
    for (int x = 0; x < wide - 110; ++x) { /* the bar of colours is at the right */
      const unsigned char *c = pixels + 4 * (y * wide + x);
      if (abs(c[0] - c[1]) + abs(c[1] - c[2]) < 40) continue; /* paper and words */
      const double bright = c[0] + c[1] + c[2];
      count += 1;
      light += bright;
      place[0] += x;
      place[1] += y;
      lit[0] += bright * x;
      lit[1] += bright * y;
    }
  assert_true(count > 10000);
  const double across = 2 * sqrt(count / acos(-1));
  for (int k = 0; k < 2; ++k) assert_true(lit[k] / light < place[k] / count - 0.01 * across);
  free(pixels);
  result_view_close(&view);
  breccia_model_destroy(&m);
}

/** What summary.json tells as the peak of a load. */
static double told_peak(const char *path, const char *load)
{
  char file[128], quoted[64];
  snprintf(file, sizeof file, "%s/summary.json", path);
  snprintf(quoted, sizeof quoted, "{\"name\": \"%s\"", load);
  char *text = text_read_file(file, NULL), *at = text ? strstr(text, quoted) : NULL,
       *peak = at ? strstr(at, "\"peak\": ") : NULL;
  if (!peak) fail_msg("%s does not tell the peak of '%s'", file, load);
  const double value = strtod(peak + strlen("\"peak\": "), NULL);
  free(text);
  return value;
}

static void loads_of_stages_peak_within_them(void **state)
{
  (void)state;
  /* All grow by 1 in a microsecond. The first stage lasts 3, the second 5: what ends with the first has come to 3, what begins with the second to 5,
   * and what is there all the while to 8. */
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: elastic, density: 2, Young modulus: 10, Poisson ratio: 0.25}}\n"
      "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 6]}}}}\n"
      "loads: [{name: short, on: {face: x+}, body force: [2, 0, 0], history: {table: [[0, 0], [1, 1e6]]}},\n"
      "        {name: long, on: {face: x+}, body force: [3, 0, 0], history: {table: [[0, 0], [1, 1e6]]}}]\n"
      "solve:\n  - {explicit: {time step: 1e-6, steps: 3}}\n"
      "  - {explicit: {time step: 1e-6, steps: 5}, without: [short], loads: [{name: late, on: {face: x+}, body force: "
      "[7, 0, 0], history: {table: [[0, 0], [1, 1e6]]}}]}\n"
      "results: {number: 4}\nwatch: {all: {displacement of: {all: yes}, every: 1}}\n");
  char path[80], file[112];
  run_into(m, "stages", path, sizeof path);
  assert_near(told_peak(path, "short"), 2 * 3, 1e-6);
  assert_near(told_peak(path, "long"), 3 * 8, 1e-6);
  assert_near(told_peak(path, "late"), 7 * 5, 1e-6);
  /* four states in each stage, evenly, besides the first */
  snprintf(file, sizeof file, "%s/results.vtkhdf", path);
  ResultView view;
  assert_int_equal(result_view_open(&view, file, NULL), 0);
  static const int64_t steps[] = {0, 1, 2, 3, 4, 6, 7, 8};
  assert_int_equal(view.steps, 8);
  for (int k = 0; k < 8; ++k) assert_int_equal(view.step_numbers[k], steps[k]);
  result_view_close(&view);
  breccia_model_destroy(&m);
}

static void a_bonds_stretch_does_not_count_from_zero_as_its_opening_does(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: elastic, density: 2, Young modulus: 10, Poisson ratio: 0.25}}\n"
      "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 6]}}}}\n"
      "solve: [{explicit: {time step: 1e-9, steps: 1}}, {displacements: zero, explicit: {time step: 1e-9, steps: 1}}]\n"
      "watch: {bond: {every: 1, bond between: [[0.05, 0.05, 0.05], [0.25, 0.05, 0.05]]}, gap: {every: 1, opening "
      "between: [[0.05, 0.05, "
      "0.05], [0.25, 0.05, 0.05]]}}\n");
  const double f[9] = {1.03, 0, 0, 0, 1, 0, 0, 0, 1};
  char path[80], file[112];
  int count = 0;
  deform_uniformly(m, f);
  run_into(m, "zero", path, sizeof path);
  snprintf(file, sizeof file, "%s/bond.csv", path);
  double *stretch = csv_column(file, "stretch", CSV_FINISHED, &count, NULL, NULL);
  for (int k = 0; k < count; ++k) assert_near(stretch[k], 0.03, 1e-9);
  free(stretch);
  assert_int_equal(count, 3);
  snprintf(file, sizeof file, "%s/gap.csv", path);
  double *opening = csv_column(file, "opening", CSV_FINISHED, &count, NULL, NULL);
  for (int k = 0; k < count; ++k) assert_near(opening[k], k < count - 1 ? 0.006 : 0, 1e-9);
  free(opening);
  breccia_model_destroy(&m);
}

static void a_run_that_began_between_two_rows_goes_on(void **state)
{
  (void)state;
  /* Five steps are taken before it: of every third row the first is that of step 6. */
  breccia_error *error = breccia_error_create();
  char path[80], file[112];
  snprintf(path, sizeof path, "%s/between", folder);
  snprintf(file, sizeof file, "%s/all.csv", path);
  for (int again = 0; again < 2; ++again) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {model: elastic, density: 2, Young modulus: 10, Poisson ratio: 0.25}}\n"
        "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 6]}}}}\n"
        "solve: {explicit: {time step: 1e-6, steps: 12}}\nwatch: {all: {displacement of: {all: yes}, every: 3}}\n");
    breccia_run run = {.size = sizeof(breccia_run),
                       .folder = path,
                       .steps = again ? 0 : 10,
                       .restart = again ? BRECCIA_RESTART_LAST : BRECCIA_RESTART_NO};
    if (!again) step_surely(m, 5);
    const int status = breccia_model_run(m, &run, error);
    if (status && status != BRECCIA_INTERRUPTED) fail_msg("%s", breccia_error_text(error));
    breccia_model_destroy(&m);
  }
  int count;
  double *steps = csv_column(file, "step", CSV_FINISHED, &count, NULL, NULL);
  assert_int_equal(count, 3);
  for (int k = 0; k < count; ++k) assert_near(steps[k], 6 + 3 * k, 0);
  free(steps);
  breccia_error_destroy(&error);
}

/** A body runs against a wall, and what damping leaves of it springs back: it is pressed most before the stop. A force
 * does work in every step. */
static void a_run_taken_up_again_tells_what_one_without_a_stop_does(void **state)
{
  (void)state;
  static const char *const keys[] = {"external",
                                     "kinetic",
                                     "stored",
                                     "imbalance",
                                     "displacement",
                                     "velocity",
                                     "mean_stress_lowest",
                                     "mean_stress_highest",
                                     "octahedral_shear_stress"};
  breccia_error *error = breccia_error_create();
  double first[sizeof keys / sizeof *keys];
  for (int stops = 0; stops < 2; ++stops) {
    char path[80];
    snprintf(path, sizeof path, "%s/%s", folder, stops ? "stopped" : "whole");
    for (int part = 0; part <= stops; ++part) {
      breccia_model *m = model_of(
          "units: {length: m, force: kN, time: s}\n"
          "materials: {m: {model: elastic, density: 2, Young modulus: 10, Poisson ratio: 0.25}}\n"
          "peridynamics: {strain: small}\n"
          "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 6]}}}}\n"
          "loads: [{on: {face: x-}, displacement: [0, 0, 0]}, {initial velocity: {translation: [-0.01, 0, 0]}},\n"
          "        {on: {face: x+}, body force: [0.01, 0.02, 0]}]\n"
          "solve: {explicit: {time step: 0.02, steps: 40, damping: 3}}\nresults: {every: 5}\n");
      breccia_run run = {.size = sizeof(breccia_run),
                         .folder = path,
                         .steps = stops && !part ? 20 : 0,
                         .restart = part ? BRECCIA_RESTART_LAST : BRECCIA_RESTART_NO};
      const int status = breccia_model_run(m, &run, error);
      if (status && status != BRECCIA_INTERRUPTED) fail_msg("%s", breccia_error_text(error));
      breccia_model_destroy(&m);
    }
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
      if (stops && told(path, keys[k]) != first[k])
        fail_msg("%s: %.17g without a stop, %.17g with one", keys[k], first[k], told(path, keys[k]));
      first[k] = told(path, keys[k]);
    }
  }
  assert_true(first[0] != 0 && first[6] < -1.5 * first[7]);
  breccia_error_destroy(&error);
}

static void results_hold_every_broken_bond_in_its_order(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n" SOFT_SOLID
      "body: {b: {material: m, spacing: 1, shape: {box: {particles: [12, 4, 3]}}}}\nfailure: {critical stretch: "
      "0.01}\nloads: [{on: {face: x-, layers: 2}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 2}, velocity: [3, "
      "0, 0]}]\nsolve: {explicit: {steps: 100}}\nresults: {every: 1}\nwatch: {worn: {damage of: {all: yes}, every: "
      "100}}\n");
  char path[80], file[112];
  run_into(m, "broken", path, sizeof path);
  /* and histories the mean and the largest share of broken bonds */
  const Particles *p = m->domain.particles;
  int rows;
  double mean = 0, most = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const double damage = domain_damage(&m->domain, p->place_of[n]);
    mean += damage / (double)p->count;
    most = larger_of(most, damage);
  }
  assert_true(most > 3 * mean && mean > 0 && domain_damage(&m->domain, p->place_of[p->count - 1]) < most);
  snprintf(file, sizeof file, "%s/worn.csv", path);
  double *means = csv_column(file, "mean", CSV_FINISHED, &rows, NULL, NULL),
         *largest = csv_column(file, "largest", CSV_FINISHED, &rows, NULL, NULL);
  assert_near(means[rows - 1], mean, 1e-14);
  assert_near(largest[rows - 1], most, 1e-14);
  free(means);
  free(largest);
  snprintf(file, sizeof file, "%s/results.vtkhdf", path);
  ResultView view;
  assert_int_equal(result_view_open(&view, file, NULL), 0);
  int growing = 0;
  int64_t before = 0;
  for (int k = 0; k < view.steps; ++k) {
    int64_t count, expected = 0, *pairs = result_view_broken(&view, k, &count);
    while (expected < m->domain.broken_count && m->domain.broken[expected].step <= view.step_numbers[k]) ++expected;
    assert_int_equal(count, expected);
    for (int64_t n = 0; n < count; ++n) {
      assert_int_equal(pairs[2 * n], m->domain.broken[n].a);
      assert_int_equal(pairs[2 * n + 1], m->domain.broken[n].b);
    }
    free(pairs);
    growing += count > before;
    before = count;
  }
  assert_true(growing > 1);
  result_view_close(&view);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loads_of_stages_peak_within_them),
      cmocka_unit_test(a_bonds_stretch_does_not_count_from_zero_as_its_opening_does),
      cmocka_unit_test(a_run_that_began_between_two_rows_goes_on),
      cmocka_unit_test(a_run_taken_up_again_tells_what_one_without_a_stop_does),
      cmocka_unit_test(results_hold_every_broken_bond_in_its_order),
      cmocka_unit_test(one_state_reads_alike_wherever_it_is_told),
      cmocka_unit_test(arrays_by_name_are_those_of_now),
      cmocka_unit_test(the_peaks_of_a_summary_are_extremes_over_all_particles),
      cmocka_unit_test(a_watched_load_has_the_unit_and_value_of_what_it_prescribes),
      cmocka_unit_test(a_ball_is_lit_from_above_and_from_the_left),
      cmocka_unit_test(bodies_in_space_stand_upright_in_pictures),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
