#include "results/result_view.h"

#include "base/folder_lock.h"
#include "base/memory.h"
#include "results/journal.h"
#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void attribute_read_text(hid_t where, const char *name, char *words, size_t size)
{
  *words = 0;
  if (H5Aexists(where, name) <= 0) return;
  hid_t attribute = H5Aopen(where, name, H5P_DEFAULT), type = H5Aget_type(attribute);
  size_t length = H5Tget_size(type);
  char *whole = memory_plain(1, length + 1);
  if (whole && !H5Tis_variable_str(type) && H5Aread(attribute, type, whole) >= 0) snprintf(words, size, "%s", whole);
  free(whole);
  H5Tclose(type);
  H5Aclose(attribute);
}

int result_view_say_damaged(const ResultView *view, const char *what, Error *error)
{
  char path[1024] = "";
  H5Fget_name(view->file.id, path, sizeof path);
  if (view->file.error)
    return error_add(error, BRECCIA_FAILURE, "%s: cannot be read: %s", path, strerror(view->file.error));
  return error_add(error, BRECCIA_USER_ERROR,
                   "%s: is damaged: %s cannot be read, or its bytes do not have the checksum written with them; put a "
                   "whole copy in its place, or run again",
                   path, what);
}

int result_view_lost(const ResultView *view)
{
  return view->file.error ? BRECCIA_FAILURE : BRECCIA_USER_ERROR;
}

void *result_view_numbers(const ResultView *view, const char *name, hid_t type, size_t size, int64_t *rows,
                          Error *error)
{
  hsize_t extent[2] = {0, 1};
  hid_t set = H5Dopen2(view->file.id, name, H5P_DEFAULT);
  if (set < 0) {
    result_view_say_damaged(view, name, error);
    return NULL;
  }
  hid_t space = H5Dget_space(set);
  H5Sget_simple_extent_dims(space, extent, NULL);
  H5Sclose(space);
  const size_t count = (size_t)(extent[0] * extent[1]);
  void *values = memory_plain(count ? count : 1, size);
  if (!values) error_add(error, BRECCIA_FAILURE, "out of memory: %s", name);
  if (values && count && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    result_view_say_damaged(view, name, error);
    free(values);
    values = NULL;
  }
  if (rows) *rows = (int64_t)extent[0];
  H5Dclose(set);
  return values;
}

void result_view_words(const ResultView *view, const char *dataset, const char *attribute, char *words, size_t size)
{
  const hid_t set = H5Dopen2(view->file.id, dataset, H5P_DEFAULT);
  *words = 0;
  if (set < 0) return;
  attribute_read_text(set, attribute, words, size);
  H5Dclose(set);
}

/** Reads the lattice of each particle, a number in a list of names. Files of earlier versions have none; their particles
 *  count as square, which is also what cells of cubic lattices look like. */
static int read_lattices(ResultView *view, Error *error)
{
  const LatticeType *square = lattice_find("square");
  for (int k = 0; k < MOST_LATTICES; ++k) view->lattice_types[k] = square;
  if (H5Lexists(view->file.id, "Breccia/Lattice", H5P_DEFAULT) <= 0) {
    view->lattice_numbers = memory_plain((size_t)view->particles + 1, 1);
    return view->lattice_numbers ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: Breccia/Lattice");
  }
  view->lattice_numbers = result_view_numbers(view, "Breccia/Lattice", H5T_NATIVE_UINT8, 1, NULL, error);
  if (!view->lattice_numbers) return result_view_lost(view);
  char names[512];
  result_view_words(view, "Breccia/Lattice", "names", names, sizeof names);
  int k = 0;
  for (char *rest = names, *name; k < MOST_LATTICES && (name = strtok_r(rest, ";", &rest)); ++k)
    if (lattice_find(name)) view->lattice_types[k] = lattice_find(name);
  return BRECCIA_OK;
}

const LatticeType *result_view_lattice(const ResultView *view, int64_t particle)
{
  const int number = view->lattice_numbers[particle];
  return view->lattice_types[number < MOST_LATTICES ? number : 0];
}

/** Title, units and shape. */
static int read_heading(ResultView *view, Error *error)
{
  hid_t own = H5Gopen2(view->file.id, "Breccia", H5P_DEFAULT);
  if (own < 0) return result_view_say_damaged(view, "the group Breccia", error);
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
  H5Gclose(own);
  return BRECCIA_OK;
}

/** Keeps the rows of the body's particles of what is there for each row of the file. */
static void keep_rows(const ResultView *view, double *values, int components)
{
  for (int64_t n = 0; view->row_of && n < view->particles; ++n)
    for (int k = 0; k < components; ++k) values[n * components + k] = values[view->row_of[n] * components + k];
}

/** Finds which rows are of the body, and leaves the others out of all that was read. Files of bodies without such layers, and of earlier
 *  versions, say nothing. */
static int leave_outside(ResultView *view, Error *error)
{
  if (H5Lexists(view->file.id, "Breccia/Outside", H5P_DEFAULT) <= 0) return BRECCIA_OK;
  uint8_t *outside = result_view_numbers(view, "Breccia/Outside", H5T_NATIVE_UINT8, 1, NULL, error);
  if (!outside) return result_view_lost(view);
  int64_t *number = memory_plain((size_t)view->rows + 1, sizeof(int64_t)); /* among the body's particles; -1: outside */
  view->row_of = memory_plain((size_t)view->rows + 1, sizeof(int64_t));
  int status =
      number && view->row_of ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: Breccia/Outside");
  if (!status) {
    view->particles = 0;
    for (int64_t row = 0; row < view->rows; ++row) {
      number[row] = outside[row] ? -1 : view->particles;
      if (!outside[row]) view->row_of[view->particles++] = row;
    }
    keep_rows(view, view->positions, 3);
    keep_rows(view, view->spacings, 1);
    for (int64_t n = 0; n < view->particles; ++n) view->lattice_numbers[n] = view->lattice_numbers[view->row_of[n]];
    int64_t kept = 0;
    for (int64_t k = 0; k < view->broken_count; ++k) {
      const int64_t *bond = &view->broken[3 * k], a = bond[1], b = bond[2];
      if (a < 0 || a >= view->rows || b < 0 || b >= view->rows || number[a] < 0 || number[b] < 0) continue;
      memmove(&view->broken[3 * kept], (const int64_t[]){bond[0], number[a], number[b]}, 3 * sizeof(int64_t));
      ++kept;
    }
    view->broken_count = kept;
  }
  free(outside);
  free(number);
  return status;
}

static int read_numbers(ResultView *view, Error *error)
{
  int64_t steps = 0;
  view->positions = result_view_numbers(view, "VTKHDF/Points", H5T_NATIVE_DOUBLE, sizeof(double), &view->rows, error);
  if (!view->positions) return result_view_lost(view);
  view->particles = view->rows;
  view->times = result_view_numbers(view, "VTKHDF/Steps/Values", H5T_NATIVE_DOUBLE, sizeof(double), &steps, error);
  if (!view->times) return result_view_lost(view);
  view->steps = (int)steps;
  view->step_numbers =
      result_view_numbers(view, "VTKHDF/Steps/StepNumbers", H5T_NATIVE_INT64, sizeof(int64_t), NULL, error);
  if (!view->step_numbers) return result_view_lost(view);
  view->spacings = result_view_numbers(view, "Breccia/Spacing", H5T_NATIVE_DOUBLE, sizeof(double), NULL, error);
  if (!view->spacings) return result_view_lost(view);
  for (int64_t n = 0; n < view->particles; ++n) view->spacing = fmax(view->spacing, view->spacings[n]);
  view->broken =
      result_view_numbers(view, "Breccia/BrokenBonds", H5T_NATIVE_INT64, sizeof(int64_t), &view->broken_count, error);
  if (!view->broken) return result_view_lost(view);
  if (H5Lexists(view->file.id, "Breccia/Frequencies", H5P_DEFAULT) > 0) {
    view->frequencies = result_view_numbers(view, "Breccia/Frequencies", H5T_NATIVE_DOUBLE, sizeof(double),
                                            &view->frequency_count, error);
    if (!view->frequencies) return result_view_lost(view);
  }
  const int status = read_lattices(view, error);
  return status ? status : leave_outside(view, error);
}

/** Finishes what a killed run had begun to put into the file; where another run is at it now, it says so. */
static int finish_rest(const char *path, Error *error)
{
  if (!journal_is_there(path)) return BRECCIA_OK;
  const char *slash = strrchr(path, '/');
  char *folder = slash ? text_format("%.*s", (int)(slash - path) + 1, path) : text_format(".");
  if (!folder) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  Error *ignored = breccia_error_create();
  FolderLock lock;
  const int status = !folder_lock_take(&lock, folder, ignored)
                         ? journal_finish(path, error)
                         : error_add(error, BRECCIA_USER_ERROR,
                                     "%s: its last state is only in the journal beside it; a run that writes now puts "
                                     "it in at once: try again; else let this folder be written to",
                                     path);
  folder_lock_return(&lock);
  breccia_error_destroy(&ignored);
  free(folder);
  return status;
}

char *result_view_path(const char *result)
{
  struct stat status;
  const bool folder = !stat(result, &status) && S_ISDIR(status.st_mode);
  return text_format(folder ? "%s/results.vtkhdf" : "%s", result);
}

int result_view_open(ResultView *view, const char *path, Error *error)
{
  *view = (ResultView){.file = {.id = -1}};
  int status = finish_rest(path, error);
  if (status) return status;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  const int there = text_open_file(path); /* HDF5 would wait for a pipe, and does not tell why it cannot open a file */
  if (there < 0)
    return error_add(error, BRECCIA_USER_ERROR, "%s: %s", path,
                     errno == ENOENT || errno == ENOTDIR ? "there is no such file" : text_why_unread(errno));
  close(there);
  if (hdf5_file_open(&view->file, path) && view->file.error)
    return error_add(error, BRECCIA_FAILURE, "%s: cannot be read: %s", path, hdf5_file_reason(&view->file));
  if (view->file.id < 0) {
    if (H5Fis_hdf5(path) <= 0) return error_add(error, BRECCIA_USER_ERROR, "%s: is not a result file", path);
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: is damaged: it is shorter than it was, or its beginning does not have the checksum written "
                     "with it; put a whole copy in its place, or run again",
                     path);
  }
  const htri_t vtk = H5Lexists(view->file.id, "VTKHDF", H5P_DEFAULT),
               own = H5Lexists(view->file.id, "Breccia", H5P_DEFAULT);
  status = vtk < 0 || own < 0 ? result_view_say_damaged(view, "its list of groups", error)
           : vtk && own       ? read_heading(view, error)
                              : error_add(error, BRECCIA_USER_ERROR, "%s: is not a result file of this program", path);
  if (!status) status = read_numbers(view, error);
  if (!status && view->file.error) status = result_view_say_damaged(view, "", error);
  if (status) result_view_close(view);
  return status;
}

void result_view_close(ResultView *view)
{
  hdf5_file_close(&view->file);
  free(view->positions);
  free(view->times);
  free(view->step_numbers);
  free(view->spacings);
  free(view->lattice_numbers);
  free(view->broken);
  free(view->frequencies);
  free(view->row_of);
  *view = (ResultView){.file = {.id = -1}};
}

int result_view_nearest(const ResultView *view, double time)
{
  const double begin = view->times[0], end = view->times[view->steps - 1], rounding = 1e-6 * fabs(end);
  int nearest = view->steps - 1;
  if (!(time >= begin - rounding && time <= end + rounding)) return -1;
  for (int k = 0; k < view->steps; ++k)
    if (fabs(view->times[k] - time) < fabs(view->times[nearest] - time)) nearest = k;
  return nearest;
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
  hid_t data = H5Gopen2(view->file.id, "VTKHDF/PointData", H5P_DEFAULT);
  if (data < 0) return;
  H5Literate(data, H5_INDEX_NAME, H5_ITER_INC, NULL, add_name, names);
  H5Gclose(data);
}

bool result_view_has(const ResultView *view, const char *field)
{
  char path[256];
  snprintf(path, sizeof path, "VTKHDF/PointData/%s", field);
  return *field && !strchr(field, '/') && H5Lexists(view->file.id, path, H5P_DEFAULT) != 0;
}

double *result_view_state(const ResultView *view, const char *name, int step, int64_t rows, int components, char *unit,
                          Error *error)
{
  const hid_t set = H5Dopen2(view->file.id, name, H5P_DEFAULT);
  if (set < 0) {
    result_view_say_damaged(view, name, error);
    return NULL;
  }
  hsize_t size[2] = {0, 1};
  const hid_t space = H5Dget_space(set);
  const int rank = H5Sget_simple_extent_dims(space, size, NULL);
  const hsize_t start[2] = {(hsize_t)step * (hsize_t)rows, 0}, count[2] = {(hsize_t)rows, size[1]};
  double *values = memory_plain((size_t)rows * (size_t)components, sizeof(double));
  const hid_t memory = H5Screate_simple(rank, count, NULL);
  int bad = !values || (rank > 1 ? size[1] : 1) != (hsize_t)components || start[0] + count[0] > size[0] ||
            H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) < 0 ||
            H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values) < 0;
  if (unit) attribute_read_text(set, "unit", unit, 64);
  bad |= view->file.error;
  H5Sclose(memory);
  H5Sclose(space);
  H5Dclose(set);
  if (!bad) return values;
  char what[320];
  snprintf(what, sizeof what, "%s at step %lld", name, (long long)view->step_numbers[step]);
  if (values)
    result_view_say_damaged(view, what, error);
  else
    error_add(error, BRECCIA_FAILURE, "out of memory: %s", what);
  free(values);
  return NULL;
}

/** Numbers of a field that each particle has; 0 where that cannot be read. */
static int count_components(const ResultView *view, const char *path)
{
  const hid_t set = H5Dopen2(view->file.id, path, H5P_DEFAULT);
  if (set < 0) return 0;
  hsize_t size[2] = {0, 1};
  const hid_t space = H5Dget_space(set);
  const int rank = H5Sget_simple_extent_dims(space, size, NULL);
  H5Sclose(space);
  H5Dclose(set);
  return rank > 1 ? (int)size[1] : 1;
}

double *result_view_read(const ResultView *view, const char *field, int step, int *components, char *unit, Error *error)
{
  char path[256];
  snprintf(path, sizeof path, "VTKHDF/PointData/%s", field);
  if (!result_view_has(view, field)) {
    Text names = {0};
    result_view_fields(view, &names);
    error_add(error, BRECCIA_USER_ERROR, "there is no field '%s' in the result file; it holds %s", field,
              names.length ? names.characters : "none");
    text_free(&names);
    return NULL;
  }
  *components = count_components(view, path);
  double *values = result_view_state(view, path, step, view->rows, *components, unit, error);
  if (values) keep_rows(view, values, *components);
  return values;
}

int64_t *result_view_broken(const ResultView *view, int step, int64_t *count)
{
  int64_t *pairs = memory_plain((size_t)view->broken_count * 2 + 1, sizeof(int64_t));
  *count = 0;
  for (int64_t k = 0; pairs && k < view->broken_count && view->broken[3 * k] <= view->step_numbers[step]; ++k) {
    pairs[2 * k] = view->broken[3 * k + 1];
    pairs[2 * k + 1] = view->broken[3 * k + 2];
    ++*count;
  }
  return pairs;
}
