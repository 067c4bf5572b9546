#include "results/result_file.h"

#include "base/checksum.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/regular_file.h"
#include "base/team.h"
#include "base/whole_file.h"
#include "results/bar_states.h"
#include "results/broken_bonds.h"
#include "results/dataset.h"
#include "results/hdf5_file.h"
#include "results/journal.h"
#include "results/particle_columns.h"
#include "results/result_view.h"
#include "results/softened_bonds.h"
#include "results/xdmf.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Values go to the file by so many chunks at a time: large bodies have no memory for all of them. */
enum { CHUNK_BYTES = 1 << 18, CHUNKS_AT_ONCE = 16, ROWS_AT_ONCE = 1 << 16 };

static const char deck_checksum[] = "deck checksum", /* attribute of the group Breccia */
    stages_name[] = "Stages";                        /* [states] stage of each state, from 0 */

typedef struct Column {
  char name[64], unit[64];
  const OutputField *field; /* NULL: a history number */
  int components;
} Column;

struct ResultFile {
  char *path, *part, *xdmf;
  bool hidden; /* `part` holds states that `path` lacks */
  bool lost;   /* a write failed: `path` lacks states for good, and nothing is added to it */
  double copied_at, copy_seconds, list_seconds; /* list_seconds: of results.xdmf, the last time */
  int64_t particles, writes, broken_written;
  bool single;
  Column *columns;
  int column_count;
  double *times; /* of all writes */
  int64_t *steps;
  int64_t capacity;
  const char *title;
};

static const char *const cell_kinds[] = {"Vertices", "Lines", "Polygons", "Strips"};

/** A dataset of one number, or of the numbers from 0 on. */
static int write_numbers(hid_t group, const char *name, int64_t rows, const int64_t *one)
{
  enum { AT_ONCE = 4096 };
  int64_t numbers[AT_ONCE];
  int bad = dataset_create(group, name, H5T_STD_I64LE, 1, rows > AT_ONCE ? AT_ONCE : (hsize_t)rows);
  int64_t first = 0;
  do {
    const int64_t count = rows - first < AT_ONCE ? rows - first : AT_ONCE;
    for (int64_t i = 0; i < count; ++i) numbers[i] = one ? *one : first + i;
    bad |= dataset_write(group, name, H5T_NATIVE_INT64, 1, (hsize_t)first, (hsize_t)count, numbers);
    first += count;
  } while (first < rows);
  return bad;
}

static int write_cells(hid_t root, int64_t particles)
{
  int bad = 0;
  for (int k = 0; k < 4; ++k) {
    const int64_t cells = k ? 0 : particles;
    hid_t group = H5Gcreate2(root, cell_kinds[k], H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group < 0) return 1;
    bad |= write_numbers(group, "NumberOfCells", 1, &cells);
    bad |= write_numbers(group, "NumberOfConnectivityIds", 1, &cells);
    bad |= write_numbers(group, "Offsets", cells + 1, NULL);
    bad |= write_numbers(group, "Connectivity", cells, NULL);
    bad |= H5Gclose(group) < 0;
  }
  return bad;
}

/** A named history number of particles first .. last - 1; 0 where the material has none of that name. */
static void history_values(const Domain *d, const char *name, int64_t first, int64_t last, double *values)
{
  for (int m = 0; m < d->material_count; ++m) {
    const int k = history_field_index(&d->materials[m], name);
    for (int64_t n = first; n < last; ++n) {
      const int64_t place = d->particles->place_of[n];
      if (d->material[place / SLICE] == m) values[n - first] = k < 0 ? 0 : domain_history(d, place, k);
    }
  }
}

typedef struct Values {
  const Domain *domain;
  const Column *column;
  int64_t first;
  double *values;
} Values;

static void field_value(void *context, int64_t n)
{
  const Values *v = context;
  v->column->field->value(v->domain, v->domain->particles->place_of[v->first + n],
                          v->values + n * v->column->components);
}

/** Of particles first .. last - 1. */
static void field_values(const Domain *d, const Column *column, int64_t first, int64_t last, double *values)
{
  if (!column->field) {
    history_values(d, column->name, first, last, values);
    return;
  }
  Values all = {d, column, first, values};
  team_each(last - first, field_value, &all);
}

/** Rows of a column that make a chunk. */
static int64_t chunk_rows(const ResultFile *file, const Column *column)
{
  const int64_t rows = CHUNK_BYTES / (column->components * (file->single ? 4 : 8));
  return rows < file->particles ? rows : file->particles;
}

/** Adds the present values of a column, whole chunks at a time. */
static int write_column(hid_t data, const ResultFile *file, const Domain *d, const Column *column, double *values)
{
  const int64_t rows = chunk_rows(file, column), begin = (file->writes - 1) * file->particles,
                end = begin + file->particles;
  int bad = 0;
  for (int64_t first = begin, last; first < end && !bad; first = last) {
    last = (first / rows + CHUNKS_AT_ONCE) * rows;
    if (last > end) last = end;
    field_values(d, column, first - begin, last - begin, values);
    bad = dataset_write(data, column->name, H5T_NATIVE_DOUBLE, column->components, (hsize_t)first,
                        (hsize_t)(last - first), values);
  }
  return bad;
}

static int create_sets(hid_t root, const ResultFile *file)
{
  int bad = 0;
  hid_t data = H5Gcreate2(root, "PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  hid_t steps = H5Gcreate2(root, "Steps", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  hid_t offsets = H5Gcreate2(steps, "PointDataOffsets", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const char *const lists[] = {"Values",      "PartOffsets",           "NumberOfParts", "PointOffsets",
                               "CellOffsets", "ConnectivityIdOffsets", "StepNumbers"};
  for (int k = 0; k < 7; ++k)
    bad |= dataset_create(steps, lists[k], k ? H5T_STD_I64LE : H5T_IEEE_F64LE, k == 4 || k == 5 ? 4 : 1, 64);
  for (int c = 0; c < file->column_count; ++c) {
    const Column *column = &file->columns[c];
    bad |= dataset_create(data, column->name, file->single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, column->components,
                          (hsize_t)chunk_rows(file, column));
    bad |= attribute_text(data, column->name, "unit", column->unit);
    if (column->components > 1) {
      char names[64] = "";
      for (int k = 0; k < column->components; ++k)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", k ? " " : "",
                 column->field->component_names[k]);
      bad |= attribute_text(data, column->name, "components", names);
    }
    bad |= dataset_create(offsets, column->name, H5T_STD_I64LE, 1, 64);
  }
  int64_t none = 0;
  bad |= attribute_numbers(steps, "NSteps", H5T_NATIVE_INT64, 1, &none);
  return bad | (H5Gclose(offsets) < 0) | (H5Gclose(steps) < 0) | (H5Gclose(data) < 0);
}

/** Writes reference positions. */
static int write_positions(hid_t root, const Particles *p)
{
  double(*position)[3] = memory_plain(ROWS_AT_ONCE, sizeof *position);
  int bad = !position || dataset_create(root, "Points", H5T_IEEE_F64LE, 3, 4096);
  for (int64_t first = 0; first < p->count && !bad; first += ROWS_AT_ONCE) {
    const int64_t rows = p->count - first < ROWS_AT_ONCE ? p->count - first : ROWS_AT_ONCE;
    for (int64_t i = 0; i < rows; ++i)
      for (int k = 0; k < 3; ++k) position[i][k] = p->position[k][p->place_of[first + i]];
    bad = dataset_write(root, "Points", H5T_NATIVE_DOUBLE, 3, (hsize_t)first, (hsize_t)rows, position);
  }
  free(position);
  return bad;
}

/** Writes the row numbers of the particles of each named selection that selects any. */
static int write_selections(hid_t own, const ResultNames *names, const Body *body)
{
  hid_t group = H5Gcreate2(own, "Selections", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  int bad = group < 0;
  for (int k = 0; names->selections && k < names->selections->count && !bad; ++k) {
    const SectionHead *head = names->selections->items[k];
    const Reference reference = {.name = head->name, .node = head->node};
    Selection selection;
    if (strchr(head->name, '/') || selection_create(&selection, body, names->reader, names->selections, &reference))
      continue;
    int64_t *rows = memory_plain((size_t)selection.count + 1, sizeof *rows);
    for (int64_t n = 0; rows && n < selection.count; ++n) rows[n] = body->particles.number[selection.places[n]];
    bad = !rows || dataset_create(group, head->name, H5T_STD_I64LE, 1, 1024) ||
          dataset_write(group, head->name, H5T_NATIVE_INT64, 1, 0, (hsize_t)selection.count, rows);
    free(rows);
    selection_destroy(&selection);
  }
  return bad | (group >= 0 && H5Gclose(group) < 0);
}

static int write_geometry(hid_t root, const Domain *d, const Units *units, const ResultNames *names)
{
  const Particles *p = d->particles;
  int bad = write_positions(root, p);
  bad |= dataset_create(root, "NumberOfPoints", H5T_STD_I64LE, 1, 1);
  bad |= dataset_write(root, "NumberOfPoints", H5T_NATIVE_INT64, 1, 0, 1, &p->count);
  hid_t file = H5Iget_file_id(root), own = H5Gcreate2(file, "Breccia", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  int plane = d->body.dimensions < 3;
  bad |= attribute_text(own, ".", "version", BRECCIA_VERSION);
  bad |= attribute_numbers(own, "plane", H5T_NATIVE_INT, 1, &plane);
  bad |= broken_bonds_create(own, d, units);
  bad |= particle_columns_write(own, d, units);
  bad |= write_selections(own, names, &d->body);
  bad |= dataset_create(own, stages_name, H5T_STD_I64LE, 1, 64);
  bad |= attribute_text(own, stages_name, "names", names->stages ? names->stages : "");
  bad |= H5Gclose(own) < 0;
  bad |= H5Fclose(file) < 0;
  return bad;
}

/** Takes away what did not become whole, and says why. */
static int give_up(ResultFile *file, const char *reason, Error *error)
{
  remove(file->part);
  file->lost = true;
  return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", file->path, reason);
}

/** Puts the copy in the place of the file that others read. */
static int put_in_place(ResultFile *file, Error *error)
{
  if (path_settle(file->part) || rename(file->part, file->path)) return give_up(file, strerror(errno), error);
  file->hidden = false;
  return BRECCIA_OK;
}

/** Of a named history that of the first material that has it: one name means one thing. */
static const char *dimension_of(const Domain *d, const Column *column)
{
  if (column->field) return column->field->dimension;
  for (int m = 0; m < d->material_count; ++m) {
    const int k = history_field_index(&d->materials[m], column->name);
    if (k >= 0) return history_field_dimension(&d->materials[m], k);
  }
  return "1";
}

static ResultFile *prepare(const char *folder, const Domain *d, const Units *units, const char *title,
                           const ResultNames *names, Error *error)
{
  ResultFile *file = memory_plain(1, sizeof *file);
  if (!file) return NULL;
  file->path = text_format("%s/results.vtkhdf", folder);
  file->part = text_format("%s/results.vtkhdf.part", folder);
  file->xdmf = text_format("%s/results.xdmf", folder);
  file->particles = d->particles->count;
  file->single = names->single;
  file->title = title;
  file->columns = memory_plain((size_t)names->count + 1, sizeof(Column));
  if (!file->path || !file->part || !file->xdmf || !file->columns) {
    result_file_destroy(&file);
    error_add(error, BRECCIA_FAILURE, "out of memory: result file");
    return NULL;
  }
  for (int k = 0; k < names->count; ++k) {
    Column *column = &file->columns[file->column_count++];
    snprintf(column->name, sizeof column->name, "%s", names->fields[k]);
    column->field = output_field_find(names->fields[k]);
    column->components = column->field ? column->field->components : 1;
    units_name(units, dimension_find(dimension_of(d, column)), column->unit, sizeof column->unit);
  }
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return file;
}

int result_file_create(ResultFile **out, const char *folder, const Domain *d, const Units *units, const char *title,
                       const ResultNames *names, Error *error)
{
  ResultFile *file = *out = prepare(folder, d, units, title, names, error);
  if (!file) return BRECCIA_FAILURE;
  Hdf5File h5;
  int bad = hdf5_file_create(&h5, file->part, H5P_DEFAULT);
  if (h5.id >= 0) {
    hid_t root = H5Gcreate2(h5.id, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    int64_t version[2] = {2, 0};
    bad |= attribute_numbers(root, "Version", H5T_NATIVE_INT64, 2, version);
    bad |= attribute_text(root, ".", "Type", "PolyData");
    bad |= write_geometry(root, d, units, names);
    bad |= write_cells(root, file->particles);
    const hsize_t column[2] = {(hsize_t)file->particles, 1};
    bad |= dataset_view(h5.id, "/Breccia/Particles", h5.id, "/VTKHDF/Vertices/Connectivity", 0, 2, column);
    bad |= create_sets(root, file);
    bad |= H5Gclose(root) < 0;
    hid_t own = H5Gopen2(h5.id, "Breccia", H5P_DEFAULT);
    char unit[64];
    units_name(units, dimension_find("length"), unit, sizeof unit);
    bad |= attribute_text(own, ".", "title", title) | attribute_text(own, ".", "length unit", unit);
    units_name(units, dimension_find("time"), unit, sizeof unit);
    bad |= attribute_text(own, ".", "time unit", unit);
    if (names->deck) {
      const int64_t sum = checksum_of(names->deck, strlen(names->deck));
      bad |= attribute_numbers(own, deck_checksum, H5T_NATIVE_INT64, 1, &sum);
    }
    if (names->frequencies) {
      bad |= dataset_create(own, "Frequencies", H5T_IEEE_F64LE, 1, 64);
      bad |= dataset_write(own, "Frequencies", H5T_NATIVE_DOUBLE, 1, 0, (hsize_t)names->frequency_count,
                           names->frequencies);
    }
    if (!names->frequencies) bad |= bar_states_create(own, d, units, names->single); /* modes strain nothing */
    if (!names->frequencies) bad |= softened_bonds_create(own, d);
    hid_t states = H5Gcreate2(own, "States", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bad |= states < 0 || H5Gclose(states) < 0;
    bad |= H5Gclose(own) < 0;
  }
  bad |= hdf5_file_close(&h5);
  if (bad) return give_up(file, hdf5_file_reason(&h5), error);
  const int cause = journal_forget(file->path); /* of the file that is replaced */
  return cause ? give_up(file, regular_file_problem(cause), error) : put_in_place(file, error);
}

static int grow_times(ResultFile *file, Error *error)
{
  if (file->writes < file->capacity) return BRECCIA_OK;
  int64_t capacity = file->capacity ? 2 * file->capacity : 64;
  double *times = memory_grown(file->times, (size_t)capacity, sizeof(double));
  if (times) file->times = times;
  int64_t *steps = memory_grown(file->steps, (size_t)capacity, sizeof(int64_t));
  if (steps) file->steps = steps;
  if (times && steps) file->capacity = capacity;
  return times && steps ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: result file");
}

static int write_xdmf(const ResultFile *file, Error *error)
{
  XdmfField *fields = memory_plain((size_t)file->column_count + 1, sizeof *fields);
  if (!fields) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", file->xdmf);
  for (int c = 0; c < file->column_count; ++c)
    fields[c] = (XdmfField){file->columns[c].name, file->columns[c].components};
  const XdmfSeries series = {.particles = file->particles,
                             .writes = file->writes,
                             .times = file->times,
                             .steps = file->steps,
                             .fields = fields,
                             .count = file->column_count,
                             .bytes = file->single ? 4 : 8};
  const int status = xdmf_write(file->xdmf, &series, error);
  free(fields);
  return status;
}

/** Cuts the lists of steps to those of `file`, or extends them. @param[in] from  the first that is not in them */
static int write_steps(hid_t root, const ResultFile *file, int64_t from)
{
  hid_t steps = H5Gopen2(root, "Steps", H5P_DEFAULT), offsets = H5Gopen2(steps, "PointDataOffsets", H5P_DEFAULT);
  const hsize_t first = (hsize_t)from, n = (hsize_t)(file->writes - from);
  int64_t *zeros = memory_plain((size_t)n * 4 + 4, sizeof(int64_t)),
          *ones = memory_plain((size_t)n + 1, sizeof(int64_t));
  int64_t *starts = memory_plain((size_t)n + 1, sizeof(int64_t));
  int bad = !zeros || !ones || !starts || steps < 0 || offsets < 0;
  for (hsize_t k = 0; !bad && k < n; ++k) {
    ones[k] = 1;
    starts[k] = (from + (int64_t)k) * file->particles;
  }
  if (!bad) {
    bad |= dataset_write(steps, "Values", H5T_NATIVE_DOUBLE, 1, first, n, file->times + from);
    bad |= dataset_write(steps, "StepNumbers", H5T_NATIVE_INT64, 1, first, n, file->steps + from);
    bad |= dataset_write(steps, "PartOffsets", H5T_NATIVE_INT64, 1, first, n, zeros);
    bad |= dataset_write(steps, "NumberOfParts", H5T_NATIVE_INT64, 1, first, n, ones);
    bad |= dataset_write(steps, "PointOffsets", H5T_NATIVE_INT64, 1, first, n, zeros);
    bad |= dataset_write(steps, "CellOffsets", H5T_NATIVE_INT64, 4, first, n, zeros);
    bad |= dataset_write(steps, "ConnectivityIdOffsets", H5T_NATIVE_INT64, 4, first, n, zeros);
    for (int c = 0; c < file->column_count; ++c)
      bad |= dataset_write(offsets, file->columns[c].name, H5T_NATIVE_INT64, 1, first, n, starts);
    bad |= attribute_numbers(steps, "NSteps", H5T_NATIVE_INT64, 1, &file->writes);
  }
  free(zeros);
  free(ones);
  free(starts);
  if (offsets >= 0 && H5Gclose(offsets) < 0) bad = 1;
  if (steps >= 0 && H5Gclose(steps) < 0) bad = 1;
  return bad;
}

/** Views of every field at the k-th write: Breccia/States/<step>/<field>. */
static int create_state(hid_t h5, const ResultFile *file, int64_t k)
{
  char name[48];
  snprintf(name, sizeof name, "/Breccia/States/%lld", (long long)file->steps[k]);
  hid_t state = H5Gcreate2(h5, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  int bad = state < 0;
  for (int c = 0; c < file->column_count && !bad; ++c) {
    const Column *column = &file->columns[c];
    const hsize_t shape[2] = {(hsize_t)file->particles, (hsize_t)column->components};
    char source[128];
    snprintf(source, sizeof source, "/VTKHDF/PointData/%s", column->name);
    bad = dataset_view(state, column->name, h5, source, (hsize_t)(k * file->particles), column->components > 1 ? 2 : 1,
                       shape);
  }
  if (state >= 0 && H5Gclose(state) < 0) bad = 1;
  return bad;
}

/** Adds the present state to the file that is open. */
static int append(ResultFile *file, Hdf5File *h5, const Domain *d, int64_t stage)
{
  hid_t root = H5Gopen2(h5->id, "VTKHDF", H5P_DEFAULT), data = H5Gopen2(root, "PointData", H5P_DEFAULT);
  double *values = memory_plain(2 * CHUNKS_AT_ONCE * CHUNK_BYTES, 1); /* twice: where chunks have single precision */
  int bad = !values || root < 0 || data < 0;
  for (int c = 0; c < file->column_count && !bad; ++c) bad = write_column(data, file, d, &file->columns[c], values);
  if (!values) h5->error = ENOMEM;
  hid_t own = H5Gopen2(h5->id, "Breccia", H5P_DEFAULT);
  bad = bad || broken_bonds_write(own, d, file->broken_written);
  bad = bad || dataset_write(own, stages_name, H5T_NATIVE_INT64, 1, (hsize_t)file->writes - 1, 1, &stage);
  bad = bad || bar_states_write(own, d, file->writes - 1);
  bad = bad || softened_bonds_write(own, d, file->writes - 1);
  bad = bad || create_state(h5->id, file, file->writes - 1);
  bad = bad || H5Fflush(h5->id, H5F_SCOPE_GLOBAL) < 0 || write_steps(root, file, file->writes - 1);
  if (own >= 0 && H5Gclose(own) < 0) bad = 1;
  if (data >= 0 && H5Gclose(data) < 0) bad = 1;
  if (root >= 0 && H5Gclose(root) < 0) bad = 1;
  free(values);
  return bad;
}

double result_file_state_bytes(const Domain *d, const ResultNames *names)
{
  int numbers = 0;
  for (int k = 0; k < names->count; ++k) {
    const OutputField *field = output_field_find(names->fields[k]);
    numbers += field ? field->components : 1;
  }
  return ((double)d->particles->count * numbers + (double)bar_states_numbers(d)) * (names->single ? 4 : 8);
}

/** Moves the copy into place, and lists its states for older readers, which takes as long as copying where states are small. */
static int show(ResultFile *file, Error *error)
{
  const double start = clock_seconds();
  int status = file->hidden ? put_in_place(file, error) : BRECCIA_OK;
  if (!status) status = write_xdmf(file, error);
  if (status) {
    file->lost = true;
    return status;
  }
  file->list_seconds = clock_seconds() - start;
  return BRECCIA_OK;
}

int result_file_write(ResultFile *file, const Domain *d, const ResultMoment *moment, Error *error)
{
  if (file->lost) return BRECCIA_FAILURE; /* said when it was lost */
  if (file->writes && file->steps[file->writes - 1] == moment->step) return BRECCIA_OK;
  if (grow_times(file, error)) return BRECCIA_FAILURE;
  struct stat status;
  if (!file->hidden && stat(file->path, &status)) return give_up(file, strerror(errno), error);
  const bool in_place = !file->hidden && status.st_size >= COPY_LIMIT;
  if (!file->hidden && !in_place) {
    file->copied_at = clock_seconds();
    const int cause = whole_file_copy(file->path, file->part);
    if (cause) return give_up(file, regular_file_problem(cause), error);
    file->copy_seconds = clock_seconds() - file->copied_at;
  }
  file->times[file->writes] = moment->time;
  file->steps[file->writes++] = moment->step;
  Hdf5File h5;
  int bad = in_place ? hdf5_file_extend_in_place(&h5, file->path) : hdf5_file_extend(&h5, file->part);
  bad = bad || append(file, &h5, d, moment->stage);
  bad |= hdf5_file_close(&h5);
  if (bad) return give_up(file, hdf5_file_reason(&h5), error);
  file->broken_written = d->broken_count;
  file->hidden = !in_place;
  const bool soon = clock_seconds() - file->copied_at < SELDOM * (file->copy_seconds + file->list_seconds);
  return file->hidden && soon ? BRECCIA_OK : show(file, error);
}

int result_file_show(ResultFile *file, Error *error)
{
  if (file->lost) return BRECCIA_FAILURE; /* said when it was lost */
  return file->hidden ? show(file, error) : BRECCIA_OK;
}

/** Cuts what the file that is open holds to the states and broken bonds of `file`. */
static int cut(ResultFile *file, Hdf5File *h5, const Domain *d)
{
  hid_t root = H5Gopen2(h5->id, "VTKHDF", H5P_DEFAULT), data = H5Gopen2(root, "PointData", H5P_DEFAULT);
  int bad = 0;
  for (int c = 0; c < file->column_count; ++c)
    bad |= dataset_write(data, file->columns[c].name, H5T_NATIVE_DOUBLE, file->columns[c].components,
                         (hsize_t)(file->writes * file->particles), 0, NULL);
  hid_t own = H5Gopen2(h5->id, "Breccia", H5P_DEFAULT);
  bad |= broken_bonds_cut(own, file->broken_written);
  bad |= dataset_write(own, stages_name, H5T_NATIVE_INT64, 1, (hsize_t)file->writes, 0, NULL);
  bad |= bar_states_cut(own, d, file->writes);
  bad |= softened_bonds_cut(own, file->writes);
  if (H5Lexists(own, "States", H5P_DEFAULT) > 0) bad |= H5Ldelete(own, "States", H5P_DEFAULT) < 0;
  hid_t states = H5Gcreate2(own, "States", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  for (int64_t k = 0; k < file->writes && !bad; ++k) bad = create_state(h5->id, file, k);
  bad |= H5Gclose(states) < 0;
  bad |= write_steps(root, file, file->writes);
  return bad | (H5Gclose(own) < 0) | (H5Gclose(data) < 0) | (H5Gclose(root) < 0);
}

/** Whether results that are to be taken up are of this deck: of the same one they have the same bits. */
static bool is_of_deck(const ResultView *view, const char *deck)
{
  int64_t sum = -1;
  const hid_t attribute = H5Aopen_by_name(view->file.id, "Breccia", deck_checksum, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute < 0) return false;
  const bool read = H5Aread(attribute, H5T_NATIVE_INT64, &sum) >= 0;
  H5Aclose(attribute);
  return read && sum == (int64_t)checksum_of(deck, strlen(deck));
}

int result_file_resume(ResultFile **out, const char *folder, const Domain *d, const Units *units, const char *title,
                       const ResultNames *names, int64_t last, Error *error)
{
  ResultFile *file = *out = prepare(folder, d, units, title, names, error);
  if (!file) return BRECCIA_FAILURE;
  ResultView view;
  int status = result_view_open(&view, file->path, error);
  if (status) return status;
  for (int k = 0; k < view.steps && view.step_numbers[k] <= last; ++k) {
    if ((status = grow_times(file, error))) break;
    file->times[file->writes] = view.times[k];
    file->steps[file->writes++] = view.step_numbers[k];
  }
  const int64_t kept = file->writes ? file->steps[file->writes - 1] : -1;
  while (file->broken_written < d->broken_count && d->broken[file->broken_written].step <= kept) ++file->broken_written;
  bool same = view.rows == file->particles;
  const bool own = !names->deck || is_of_deck(&view, names->deck);
  result_view_close(&view);
  if (status) return status;
  if (!same)
    return error_add(error, BRECCIA_USER_ERROR, "%s: holds another number of particles than the deck", file->path);
  if (!own)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: holds results of another deck; put the file back as it was, or run without --restart",
                     file->path);
  const int cause = whole_file_copy(file->path, file->part);
  if (cause) return give_up(file, regular_file_problem(cause), error);
  Hdf5File h5;
  int bad = hdf5_file_extend(&h5, file->part) || cut(file, &h5, d);
  bad |= hdf5_file_close(&h5);
  if (bad) return give_up(file, hdf5_file_reason(&h5), error);
  status = put_in_place(file, error);
  return status ? status : write_xdmf(file, error);
}

void result_file_destroy(ResultFile **file)
{
  if (!file || !*file) return;
  free((*file)->path);
  free((*file)->part);
  free((*file)->xdmf);
  free((*file)->columns);
  free((*file)->times);
  free((*file)->steps);
  free(*file);
  *file = NULL;
}
