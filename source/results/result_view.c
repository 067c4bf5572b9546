#include "results/result_view.h"

#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static void attribute_read_text(hid_t where, const char *name, char *words, size_t size)
{
  *words = 0;
  if (H5Aexists(where, name) <= 0) return;
  hid_t attribute = H5Aopen(where, name, H5P_DEFAULT), type = H5Aget_type(attribute);
  size_t length = H5Tget_size(type);
  char *whole = calloc(1, length + 1);
  if (whole && !H5Tis_variable_str(type) && H5Aread(attribute, type, whole) >= 0) snprintf(words, size, "%s", whole);
  free(whole);
  H5Tclose(type);
  H5Aclose(attribute);
}

static hsize_t dataset_rows(hid_t set)
{
  hsize_t size[2] = {0, 1};
  hid_t space = H5Dget_space(set);
  H5Sget_simple_extent_dims(space, size, NULL);
  H5Sclose(space);
  return size[0];
}

static void *read_all(hid_t where, const char *name, hid_t type, size_t size, hsize_t *rows)
{
  hid_t set = H5Dopen2(where, name, H5P_DEFAULT);
  if (set < 0) return NULL;
  hid_t space = H5Dget_space(set);
  hssize_t count = H5Sget_simple_extent_npoints(space);
  if (rows) *rows = dataset_rows(set);
  void *values = calloc((size_t)(count > 0 ? count : 1), size);
  if (values && count > 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    free(values);
    values = NULL;
  }
  H5Sclose(space);
  H5Dclose(set);
  return values;
}

/** Which lattice each particle stands on: numbers in a list of names. Files of earlier versions tell none: square, as cells of cubic ones are
 *  seen too. */
static void read_lattices(ResultView *view, hid_t own, int64_t particles)
{
  const LatticeType *square = lattice_find("square");
  for (int k = 0; k < MOST_LATTICES; ++k) view->lattice_types[k] = square;
  if (H5Lexists(own, "Lattice", H5P_DEFAULT) > 0) {
    char names[512];
    hsize_t rows = 0;
    hid_t set = H5Dopen2(own, "Lattice", H5P_DEFAULT);
    attribute_read_text(set, "names", names, sizeof names);
    H5Dclose(set);
    view->lattice_numbers = read_all(own, "Lattice", H5T_NATIVE_UINT8, 1, &rows);
    int k = 0;
    for (char *rest = names, *name; k < MOST_LATTICES && (name = strtok_r(rest, ";", &rest)); ++k)
      if (lattice_find(name)) view->lattice_types[k] = lattice_find(name);
    if ((int64_t)rows >= particles) return;
  }
  free(view->lattice_numbers);
  view->lattice_numbers = calloc((size_t)particles + 1, 1);
}

const LatticeType *result_view_lattice(const ResultView *view, int64_t particle)
{
  const int number = view->lattice_numbers[particle];
  return view->lattice_types[number < MOST_LATTICES ? number : 0];
}

int result_view_open(ResultView *view, const char *path, Error *error)
{
  *view = (ResultView){.file = -1};
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  view->file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (view->file < 0) {
    struct stat status;
    return error_add(error, BRECCIA_USER_ERROR, "%s: %s", path,
                     stat(path, &status) ? "there is no such file" : "is not a result file");
  }
  hid_t root = H5Gopen2(view->file, "VTKHDF", H5P_DEFAULT), own = H5Gopen2(view->file, "Breccia", H5P_DEFAULT);
  hsize_t steps = 0, particles = 0;
  if (root >= 0 && own >= 0) {
    view->positions = read_all(root, "Points", H5T_NATIVE_DOUBLE, sizeof(double), &particles);
    view->times = read_all(root, "Steps/Values", H5T_NATIVE_DOUBLE, sizeof(double), &steps);
    view->step_numbers = read_all(root, "Steps/StepNumbers", H5T_NATIVE_INT64, sizeof(int64_t), NULL);
    view->spacings = read_all(own, "Spacing", H5T_NATIVE_DOUBLE, sizeof(double), NULL);
    if (view->positions) read_lattices(view, own, (int64_t)particles);
    attribute_read_text(own, "title", view->title, sizeof view->title);
    attribute_read_text(own, "length unit", view->length_unit, sizeof view->length_unit);
    attribute_read_text(own, "time unit", view->time_unit, sizeof view->time_unit);
    int plane = 0;
    hid_t attribute = H5Aopen(own, "plane", H5P_DEFAULT);
    if (attribute >= 0) {
      H5Aread(attribute, H5T_NATIVE_INT, &plane);
      H5Aclose(attribute);
    }
    view->plane = plane;
  }
  if (root >= 0) H5Gclose(root);
  if (own >= 0) H5Gclose(own);
  if (!view->positions || !view->times || !view->step_numbers || !view->spacings || !view->lattice_numbers) {
    result_view_close(view);
    return error_add(error, BRECCIA_USER_ERROR, "%s: is not a result file of this program", path);
  }
  view->particles = (int64_t)particles;
  view->steps = (int)steps;
  for (int64_t n = 0; n < view->particles; ++n) view->spacing = fmax(view->spacing, view->spacings[n]);
  return BRECCIA_OK;
}

void result_view_close(ResultView *view)
{
  if (view->file >= 0) H5Fclose(view->file);
  free(view->positions);
  free(view->times);
  free(view->step_numbers);
  free(view->spacings);
  free(view->lattice_numbers);
  *view = (ResultView){.file = -1};
}

static herr_t add_name(hid_t group, const char *name, const H5L_info_t *info, void *names)
{
  (void)group, (void)info;
  Text *text = names;
  text_add(text, "%s%s", text->length ? ", " : "", name);
  return 0;
}

void result_view_fields(const ResultView *view, Text *names)
{
  hid_t data = H5Gopen2(view->file, "VTKHDF/PointData", H5P_DEFAULT);
  if (data < 0) return;
  H5Literate(data, H5_INDEX_NAME, H5_ITER_INC, NULL, add_name, names);
  H5Gclose(data);
}

double *result_view_read(const ResultView *view, const char *field, int step, int *components, char *unit, Error *error)
{
  char path[256];
  snprintf(path, sizeof path, "VTKHDF/PointData/%s", field);
  hid_t data = H5Gopen2(view->file, "VTKHDF/PointData", H5P_DEFAULT);
  hid_t set = data >= 0 && !strchr(field, '/') && H5Lexists(data, field, H5P_DEFAULT) > 0
                  ? H5Dopen2(view->file, path, H5P_DEFAULT)
                  : -1;
  if (data >= 0) H5Gclose(data);
  if (set < 0) {
    Text names = {0};
    result_view_fields(view, &names);
    error_add(error, BRECCIA_USER_ERROR, "there is no field '%s' in the result file; it holds %s", field,
              names.length ? names.characters : "none");
    text_free(&names);
    return NULL;
  }
  hsize_t size[2] = {0, 1};
  hid_t space = H5Dget_space(set);
  int rank = H5Sget_simple_extent_dims(space, size, NULL);
  *components = rank > 1 ? (int)size[1] : 1;
  hsize_t start[2] = {(hsize_t)step * (hsize_t)view->particles, 0}, count[2] = {(hsize_t)view->particles, size[1]};
  double *values = calloc((size_t)view->particles * (size_t)*components, sizeof(double));
  hid_t memory = H5Screate_simple(rank, count, NULL);
  int bad = !values || start[0] + count[0] > size[0] ||
            H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) < 0 ||
            H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values) < 0;
  if (unit) attribute_read_text(set, "unit", unit, 64);
  H5Sclose(memory);
  H5Sclose(space);
  H5Dclose(set);
  if (bad) {
    free(values);
    error_add(error, BRECCIA_FAILURE, "field '%s' cannot be read for step %d", field, step);
    return NULL;
  }
  return values;
}

int64_t *result_view_broken(const ResultView *view, int step, int64_t *count)
{
  hsize_t rows = 0;
  hid_t own = H5Gopen2(view->file, "Breccia", H5P_DEFAULT);
  int64_t *all = own >= 0 ? read_all(own, "BrokenBonds", H5T_NATIVE_INT64, sizeof(int64_t), &rows) : NULL;
  if (own >= 0) H5Gclose(own);
  *count = 0;
  for (hsize_t k = 0; all && k < rows && all[3 * k] <= view->step_numbers[step]; ++k) {
    all[2 * *count] = all[3 * k + 1];
    all[2 * *count + 1] = all[3 * k + 2];
    ++*count;
  }
  return all;
}
