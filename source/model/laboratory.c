/* Tests on one material point for programs: run, looked at, held against measured points, drawn. */
#include "model/laboratory.h"

#include "base/memory.h"
#include "base/tensor.h"
#include "model/host.h"
#include "model/sized.h"
#include "results/plot.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

breccia_test *laboratory_begin(Error *error)
{
  breccia_test *test = memory_plain(1, sizeof *test);
  if (test) test->doubts = breccia_error_create();
  if (test && test->doubts) return test;
  error_add(error, BRECCIA_FAILURE, "out of memory: test");
  free(test);
  return NULL;
}

int breccia_test_load(const char *path, breccia_test **out, breccia_error *error)
{
  if (host_lacks(path, __func__, "path", error) || host_lacks(out, __func__, "the result", error))
    return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_test *test = laboratory_begin(error);
  int status = test ? element_deck_load(&test->deck, path, error) : BRECCIA_FAILURE;
  if (!status) {
    test->where = test->deck.document->name;
    test->title = text_format("%s", test->deck.spec->title ? test->deck.spec->title : test->deck.law->name);
    units_name(test->deck.units, dimension_find("stress"), test->unit, sizeof test->unit);
  }
  status = host_leave(&host, status, error);
  if (status) breccia_test_destroy(&test);
  *out = test;
  return status;
}

static void forget_columns(breccia_test *test)
{
  for (int k = 0; k < test->column_count; ++k) {
    free(test->headings[k]);
    free(test->columns[k]);
  }
  free(test->headings);
  free(test->columns);
  test->headings = NULL;
  test->columns = NULL;
  test->column_count = 0;
}

void breccia_test_destroy(breccia_test **out)
{
  if (!out || !*out) return;
  breccia_test *test = *out;
  forget_columns(test);
  element_curve_destroy(&test->curve);
  measured_points_destroy(&test->points);
  parameter_fit_destroy(&test->fit);
  element_deck_destroy(&test->deck);
  breccia_error_destroy(&test->doubts);
  text_free(&test->judgement);
  free(test->title);
  free(test->path);
  free(test->path_time);
  free(test);
  *out = NULL;
}

/* ---- running ---- */

/** Follows strains row by row; the curve keeps what came before a row at which the law gives up. */
static int follow_path(const breccia_test *test, ElementCurve *curve, Error *error)
{
  Driver d;
  int status = driver_create(&d, &test->deck.material, error);
  if (status) return status;
  const int n = d.components, rows = test->path_rows;
  *curve = (ElementCurve){.components = n};
  curve->strain = memory_plain(6 * (size_t)rows, sizeof(double));
  curve->stress = memory_plain(6 * (size_t)rows, sizeof(double));
  curve->tangent = memory_plain((size_t)(n * n) * (size_t)rows, sizeof(double));
  if (!curve->strain || !curve->stress || !curve->tangent)
    status = error_add(error, BRECCIA_FAILURE, "out of memory: strain path");
  for (int i = 0; i < rows && !status; ++i) {
    d.elastic = i < test->elastic_rows;
    d.time_step = test->path_time ? test->path_time[i] - d.time : 0;
    if (!driver_try(&d, test->path + 6 * i)) {
      status = error_add(error, BRECCIA_FAILURE, "row %d: the law could not be integrated at this strain", i + 1);
      break;
    }
    memcpy(curve->strain + 6 * i, d.strain, sizeof(double) * (size_t)n);
    memcpy(curve->stress + 6 * i, d.stress, sizeof(double) * (size_t)n);
    memcpy(curve->tangent + (ptrdiff_t)(n * n) * i, d.tangent, sizeof(double) * (size_t)(n * n));
    curve->count = i + 1;
    driver_commit(&d);
  }
  driver_destroy(&d);
  return status;
}

/** A column of the curve under its heading. @param[in] values  the first row's; `stride` numbers to that of the next; NULL: none yet */
static int add_column(breccia_test *test, char *heading, const double *values, int stride)
{
  const int k = test->column_count, rows = test->curve.count;
  test->headings[k] = heading;
  test->columns[k] = memory_plain((size_t)rows + 1, sizeof(double));
  ++test->column_count;
  if (!heading || !test->columns[k]) return BRECCIA_FAILURE;
  for (int i = 0; values && i < rows; ++i) test->columns[k][i] = values[(ptrdiff_t)stride * i];
  return BRECCIA_OK;
}

static int make_columns(breccia_test *test, bool tangents, Error *error)
{
  const ElementCurve *c = &test->curve;
  const int n = c->components, most = 2 * n + 1 + n * n;
  int bad = BRECCIA_OK;
  forget_columns(test);
  test->headings = memory_plain((size_t)most, sizeof *test->headings);
  test->columns = memory_plain((size_t)most, sizeof *test->columns);
  bad = !test->headings || !test->columns;
  for (int k = 0; k < n && !bad; ++k)
    bad = add_column(test, text_format("strain %s", component_names[k]), c->strain + k, 6);
  for (int k = 0; k < n && !bad; ++k)
    bad = add_column(test, text_format("stress %s (%s)", component_names[k], test->unit), c->stress + k, 6);
  if (n == 6 && !bad) {
    bad = add_column(test, text_format("volumetric strain"), NULL, 0);
    for (int i = 0; i < c->count && !bad; ++i) {
      const double *strain = c->strain + 6 * i;
      test->columns[test->column_count - 1][i] = strain[XX] + strain[YY] + strain[ZZ];
    }
  }
  for (int k = 0; tangents && k < n * n && !bad; ++k)
    bad =
        add_column(test, text_format("tangent %s %s (%s)", component_names[k / n], component_names[k % n], test->unit),
                   c->tangent + k, n * n);
  if (!bad) return BRECCIA_OK;
  forget_columns(test);
  return error_add(error, BRECCIA_FAILURE, "out of memory: columns");
}

/** Laws that take time answer a test without any by their stiffness of the first moment. */
static void doubt_time(const breccia_test *test)
{
  double time = test->path_time ? test->path_time[test->path_rows - 1] : 0;
  for (int n = 0; n < test->deck.test.count; ++n) time += test->deck.test.stages[n].duration;
  if (test->deck.law->takes_time && time == 0)
    error_add(test->doubts, BRECCIA_USER_ERROR,
              "%s: %s depends on time, of which this test takes none: this is its answer of the first moment; give a "
              "'duration' (--duration), or a column 'time' in a path of strains",
              test->where, test->deck.law->name);
}

int breccia_test_run(breccia_test *test, int tangents, breccia_error *error)
{
  if (host_lacks(test, __func__, "test", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  element_curve_destroy(&test->curve);
  test->curve = (ElementCurve){0};
  if (!test->path && !test->fit.count)
    element_doubt_material(&test->deck.material, test->deck.units, test->where, test->doubts);
  doubt_time(test);
  int status = test->path ? follow_path(test, &test->curve, error)
                          : element_test_run(&test->deck.test, &test->deck.material, &test->curve, error);
  const int bad = make_columns(test, tangents != 0, error);
  return host_leave(&host, status ? status : bad, error);
}

const char *breccia_test_doubts(const breccia_test *test)
{
  if (!test) return "";
  return breccia_error_text(test->doubts);
}

const char *breccia_test_heading(const breccia_test *test, int column)
{
  if (!test) return NULL;
  return column >= 0 && column < test->column_count ? test->headings[column] : NULL;
}

const double *breccia_test_column(const breccia_test *test, int column)
{
  if (!test) return NULL;
  return column >= 0 && column < test->column_count ? test->columns[column] : NULL;
}

int breccia_test_rows(const breccia_test *test)
{
  if (!test) return 0;
  return test->curve.count;
}

/* ---- beside measured points ---- */

static int compare(breccia_test *test, const char *path, breccia_comparison *found, Error *error)
{
  if (test->path || test->curve.count < 2)
    return error_add(error, BRECCIA_USER_ERROR, "%s: there is no curve to compare with", test->where);
  const ElementTest *kind = &test->deck.test;
  *found = (breccia_comparison){.x_label = kind->x_label, .y_label = kind->y_label, .unit = test->unit};
  if (!path) path = test->deck.against;
  if (!path) return BRECCIA_OK;
  measured_points_destroy(&test->points);
  int status = measured_points_read(&test->points, path, test->deck.units, 1, error);
  if (status || !test->points.count) return status;
  found->points = test->points.count;
  found->mean = element_curve_compare(&test->curve, test->points.x, test->points.y, found->points, NULL, &found->most);
  if (!measured_points_opposed(&test->points, &test->curve, test->doubts))
    measured_points_doubt(&test->points, kind, &test->curve, test->deck.units, test->doubts);
  return BRECCIA_OK;
}

int breccia_test_compare(breccia_test *test, const char *path, breccia_comparison *comparison, breccia_error *error)
{
  if (host_lacks(test, __func__, "test", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_comparison found = {0};
  const int status = compare(test, path, &found, error);
  if (comparison) sized_give(comparison, &found, sizeof found);
  return host_leave(&host, status, error);
}

int breccia_test_draw(const breccia_test *test, const char *path, breccia_error *error)
{
  if (host_lacks(test, __func__, "test", error) || host_lacks(path, __func__, "path", error)) return BRECCIA_USER_ERROR;
  const ElementCurve *c = &test->curve;
  if (test->path || c->count < 2)
    return error_add(error, BRECCIA_USER_ERROR, "%s: there is no curve to draw", test->where);
  const Host host = host_enter();
  const MeasuredPoints *points = &test->points;
  const PlotLine lines[2] = {{test->fit.count ? "fitted" : "computed", c->x, c->y, c->count, false, 0, 0, NULL},
                             {"measured", points->x, points->y, points->count, true, 0, 0, NULL}};
  const PlotOptions plot = {.title = test->title,
                            .x = {.words = test->deck.test.x_label, .unit = ""},
                            .y = {.words = test->deck.test.y_label, .unit = test->unit},
                            .low = NAN,
                            .high = NAN};
  const int status = plot_draw(lines, points->count ? 2 : 1, &plot, path, error);
  return host_leave(&host, status, error);
}
