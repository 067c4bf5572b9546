/* Motions for programs: read, measured, held against each other. */
#include "model/motion.h"

#include "base/fourier.h"
#include "base/memory.h"
#include "loading/history/correction.h"
#include "model/host.h"
#include "model/sized.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- reading ---- */

/** Size of a unit of accelerations or velocities in m and s. @param[out] velocity  whether it is one of these
 *  @return NaN where it is neither */
static double size_of_unit(const char *unit, const Units *units, bool *velocity)
{
  *velocity = false;
  if (!strcmp(unit, "g")) return motion_gravity;
  char *words = text_format("1 %s", unit);
  Text ignored = {0};
  double size = NAN;
  if (!words || units_read(units, dimension_find("acceleration"), words, &size, &ignored)) {
    *velocity = true;
    if (!words || units_read(units, dimension_find("velocity"), words, &size, &ignored)) size = NAN;
  }
  text_free(&ignored);
  free(words);
  return size;
}

/** Central differences, one-sided at the ends. */
static int differentiate(Record *record, Error *error)
{
  const double *old = record->rows;
  double *rows = memory_zeroed(2 * (size_t)record->count, sizeof *rows, "motion", error);
  if (!rows) return BRECCIA_FAILURE;
  for (int k = 0; k < record->count; ++k) {
    const int a = k ? k - 1 : 0, b = k < record->count - 1 ? k + 1 : k;
    rows[2 * k] = old[2 * k];
    rows[2 * k + 1] = (old[2 * b + 1] - old[2 * a + 1]) / (old[2 * b] - old[2 * a]);
  }
  free(record->rows);
  record->rows = rows;
  return BRECCIA_OK;
}

/** Accelerations in m/s2 out of what the file has. */
static int convert(Record *record, const breccia_motion_file *file, const char *label, const Units *units, Error *error)
{
  char unit[RECORD_LABEL] = "";
  const char *open = strrchr(label, '(');
  if (open && strchr(open, ')')) snprintf(unit, sizeof unit, "%.*s", (int)strcspn(open + 1, ")"), open + 1);
  bool velocity;
  if (file->unit && isnan(size_of_unit(file->unit, units, &velocity)))
    return error_add(error, BRECCIA_USER_ERROR,
                     "'%s', which was given, is no unit of an acceleration (g, m/s2) or a velocity (m/s)", file->unit);
  if (!*unit) snprintf(unit, sizeof unit, "%s", file->unit ? file->unit : "");
  if (!*unit)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: does not say in which unit its values are; give it: g, m/s2, or m/s of velocities",
                     file->path);
  const double size = size_of_unit(unit, units, &velocity);
  if (isnan(size))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: its values are in '%s', which is no unit of an acceleration (g, m/s2) or a velocity (m/s)",
                     file->path, unit);
  for (int k = 0; k < record->count; ++k) record->rows[2 * k + 1] *= size;
  return velocity ? differentiate(record, error) : BRECCIA_OK;
}

static char *name_of(const char *path)
{
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
  return dot && dot > name ? text_format("%.*s", (int)(dot - name), name) : text_format("%s", name);
}

static int read_motion(breccia_motion *motion, const breccia_motion_file *file, Error *error)
{
  char label[RECORD_LABEL];
  Record record = {0};
  Units *units = units_create(UNITS_LENGTH, UNITS_FORCE, UNITS_TIME, error);
  if (!units) return BRECCIA_FAILURE;
  const RecordFile from = {.path = file->path,
                           .column = file->column,
                           .times = file->times ? file->times : "time",
                           .step = file->step > 0 ? file->step : NAN,
                           .channel = file->channel,
                           .units = units};
  int status = record_read(&record, &from, label, error);
  if (!status) status = convert(&record, file, label, units, error);
  motion->rows = record.rows;
  motion->count = record.count;
  motion->name = name_of(file->path);
  units_destroy(&units);
  return status;
}

int breccia_motion_load(const breccia_motion_file *given, breccia_motion **out, breccia_error *error)
{
  if (host_lacks(out, __func__, "the result", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_motion_file file;
  breccia_motion *motion = NULL;
  int status = sized_take(&file, sizeof file, given, "breccia_motion_file", error);
  if (!status && !file.path) status = error_add(error, BRECCIA_USER_ERROR, "a motion needs the path of its file");
  if (!status && (!(file.step >= 0) || !isfinite(file.step) || file.channel < 0))
    status = error_add(error, BRECCIA_USER_ERROR,
                       "a motion's step of %g s or channel %d is wrong; expected positive numbers, or 0 where the file "
                       "tells",
                       file.step, file.channel);
  if (!status && !(motion = memory_zeroed(1, sizeof *motion, "motion", error))) status = BRECCIA_FAILURE;
  if (!status) status = read_motion(motion, &file, error);
  status = host_leave(&host, status, error);
  if (status) breccia_motion_destroy(&motion);
  *out = motion;
  return status;
}

static void forget_tables(breccia_motion *motion)
{
  for (int t = 0; t < MOTION_TABLES; ++t)
    for (int c = 0; c < MOTION_COLUMNS; ++c) free(motion->tables[t].columns[c]);
  memset(motion->tables, 0, sizeof motion->tables);
  free(motion->over_response);
  free(motion->over_name);
  motion->over_response = NULL;
  motion->over_name = NULL;
  text_free(&motion->words);
  text_free(&motion->files);
}

void breccia_motion_destroy(breccia_motion **out)
{
  if (!out || !*out) return;
  forget_tables(*out);
  free((*out)->rows);
  free((*out)->name);
  free(*out);
  *out = NULL;
}

/* ---- finding ---- */

static int make_table(MotionTable *table, const char *const *headings, int count, double rows, Error *error)
{
  *table = (MotionTable){.headings = headings, .count = count, .rows = (int)rows};
  for (int c = 0; c < count; ++c)
    if (!(table->columns[c] = memory_zeroed((size_t)rows, sizeof(double), "motion", error))) return BRECCIA_FAILURE;
  return BRECCIA_OK;
}

static double largest_of(const double *values, int count)
{
  double largest = 0;
  for (int k = 0; k < count; ++k) largest = fmax(largest, fabs(values[k]));
  return largest;
}

static int find_history(breccia_motion *motion, Error *error)
{
  static const char *const headings[] = {"time (s)", "acceleration (m/s2)", "velocity (m/s)", "displacement (m)",
                                         "Husid"};
  MotionTable *table = &motion->tables[BRECCIA_MOTION_HISTORY];
  const int count = motion->count;
  if (make_table(table, headings, 5, count, error)) return BRECCIA_FAILURE;
  double *const *column = table->columns;
  for (int k = 0; k < count; ++k) {
    column[0][k] = motion->rows[2 * k];
    column[1][k] = motion->rows[2 * k + 1];
  }
  const Shaking shaking = {column[0], column[1], count};
  shaking_integrate(&shaking, column[2], column[3]);
  shaking_squares(&shaking, column[4]);
  const double all = column[4][count - 1];
  motion->intensity = (breccia_intensity){.size = sizeof motion->intensity,
                                          .acceleration = largest_of(column[1], count),
                                          .velocity = largest_of(column[2], count),
                                          .displacement = largest_of(column[3], count),
                                          .arias = acos(-1) / (2 * motion_gravity) * all,
                                          .from = shaking_time_of(column[0], column[4], count, 0.05),
                                          .to = shaking_time_of(column[0], column[4], count, 0.95)};
  for (int k = 0; k < count && all > 0; ++k) column[4][k] /= all;
  return BRECCIA_OK;
}

static Shaking shaking_of(const breccia_motion *motion)
{
  const MotionTable *history = &motion->tables[BRECCIA_MOTION_HISTORY];
  return (Shaking){history->columns[0], history->columns[1], history->rows};
}

double motion_pseudo(double displacement, double period, int times_omega)
{
  return displacement * pow(2 * acos(-1) / period, times_omega);
}

/** @param[in] over  a motion whose history is known, or NULL */
static int find_response(breccia_motion *motion, const breccia_motion *over, Error *error)
{
  static const char *const headings[] = {"period (s)", "displacement (m)", "pseudo-velocity (m/s)",
                                         "pseudo-acceleration (m/s2)", "acceleration (m/s2)"};
  const breccia_motion_wish *wish = &motion->wish;
  MotionTable *table = &motion->tables[BRECCIA_MOTION_RESPONSE];
  if (make_table(table, headings, 5, wish->periods, error)) return BRECCIA_FAILURE;
  if (over && !(motion->over_response = memory_zeroed((size_t)table->rows, sizeof(double), "motion", error)))
    return BRECCIA_FAILURE;
  const Shaking own = shaking_of(motion);
  for (int k = 0; k < table->rows; ++k) {
    const double share = table->rows > 1 ? (double)k / (table->rows - 1) : 0;
    const double period = wish->shortest * pow(wish->longest / wish->shortest, share);
    const Response response = shaking_response(&own, period, wish->damping);
    table->columns[0][k] = period;
    table->columns[1][k] = response.displacement;
    for (int n = 1; n <= 2; ++n) table->columns[1 + n][k] = motion_pseudo(response.displacement, period, n);
    table->columns[4][k] = response.acceleration;
    if (!over) continue;
    const Shaking below = shaking_of(over);
    motion->over_response[k] = motion_pseudo(shaking_response(&below, period, wish->damping).displacement, period, 2);
  }
  return BRECCIA_OK;
}

typedef struct Amplitudes {
  double *values, spacing; /* [count] at multiples of the spacing */
  int count;
} Amplitudes;

/** Room for amplitudes, and those of values at equal steps. */
static int transform(const breccia_motion *motion, double step, int size, Amplitudes *out, Error *error)
{
  Record record = {.rows = memory_zeroed(2 * (size_t)motion->count, sizeof(double), "motion", error),
                   .count = motion->count};
  *out = (Amplitudes){.spacing = 1 / (step * size), .count = size / 2 + 1};
  if (!record.rows) return BRECCIA_FAILURE;
  memcpy(record.rows, motion->rows, 2 * sizeof(double) * (size_t)motion->count);
  int status = record_resample(&record, step, error);
  double *values = status ? NULL : memory_zeroed((size_t)record.count, sizeof *values, "motion", error);
  for (int k = 0; values && k < record.count; ++k) values[k] = record.rows[2 * k + 1];
  out->values = values ? memory_zeroed((size_t)out->count, sizeof(double), "motion", error) : NULL;
  status = out->values
               ? fourier_amplitudes(values, record.count < size ? record.count : size, step, size, out->values, error)
               : BRECCIA_FAILURE;
  free(values);
  free(record.rows);
  return status;
}

/** Mean step, and how many of a length the whole has. */
static double step_of(const breccia_motion *motion)
{
  return (motion->rows[2 * motion->count - 2] - motion->rows[0]) / (motion->count - 1);
}

static double steps_in(const breccia_motion *motion, double step)
{
  return floor((motion->rows[2 * motion->count - 2] - motion->rows[0]) / step + 1e-6) + 1;
}

/** Of the largest amplitude below: where there is less, what stands above it is roundings or noise, and no ratio is given. */
static const double least_over = 1e-3;

static double look(const Amplitudes *a, int k, double frequency, double smoothing)
{
  return smoothing > 0 ? fourier_smooth(a->values, a->count, a->spacing, frequency, smoothing) : a->values[k];
}

static int find_fourier(breccia_motion *motion, const breccia_motion *over, Error *error)
{
  static const char *const headings[] = {"frequency (Hz)", "amplitude (m/s)", "amplitude below (m/s)", "ratio"};
  enum { TENFOLD = 100 };
  const double step = over ? fmin(step_of(motion), step_of(over)) : step_of(motion), smoothing = motion->wish.smoothing;
  const double most = over ? fmax(steps_in(motion, step), steps_in(over, step)) : steps_in(motion, step);
  if (most > 1e8)
    return error_add(error, BRECCIA_USER_ERROR,
                     "motions of %g values at equal steps of %g s are too long for a transform; take fewer", most,
                     step);
  const int size = fourier_size((int)most);
  Amplitudes own = {0}, below = {0};
  int status = transform(motion, step, size, &own, error);
  if (!status && over) status = transform(over, step, size, &below, error);
  /* From one swing in the whole to two values in a swing. */
  const double lowest = 1 / (step * most), highest = 0.5 / step;
  const double rows = smoothing > 0 ? ceil(TENFOLD * log10(highest / lowest)) + 1 : size / 2;
  const double least = over ? least_over * largest_of(below.values, below.values ? below.count : 0) : 0;
  MotionTable *table = &motion->tables[BRECCIA_MOTION_FOURIER];
  if (!status) status = make_table(table, headings, over ? 4 : 2, rows, error);
  for (int k = 0; !status && k < table->rows; ++k) {
    double *const *column = table->columns;
    const double f = smoothing > 0 ? lowest * pow(highest / lowest, k / (rows - 1)) : (k + 1) * own.spacing;
    column[0][k] = f;
    column[1][k] = look(&own, k + 1, f, smoothing);
    if (!over) continue;
    column[2][k] = look(&below, k + 1, f, smoothing);
    column[3][k] = column[2][k] > least ? column[1][k] / column[2][k] : NAN;
  }
  free(own.values);
  free(below.values);
  return status;
}

/** What is wished, with all that it leaves open. */
static int take_wish(breccia_motion_wish *wish, const breccia_motion_wish *given, Error *error)
{
  const breccia_motion_wish usual = {
      .size = sizeof usual, .damping = NAN, .shortest = NAN, .longest = NAN, .smoothing = NAN};
  const int status = sized_take(wish, sizeof *wish, given ? given : &usual, "breccia_motion_wish", error);
  if (status) return status;
  if (isnan(wish->damping)) wish->damping = 0.05;
  if (isnan(wish->shortest)) wish->shortest = 0.01;
  if (isnan(wish->longest)) wish->longest = 10;
  if (isnan(wish->smoothing)) wish->smoothing = 40;
  if (!(wish->damping >= 0 && wish->damping < 1))
    return error_add(error, BRECCIA_USER_ERROR, "damping: %g is no share of the critical one, 0 to below 1",
                     wish->damping);
  if (!(wish->shortest > 0 && wish->longest >= wish->shortest && wish->longest < INFINITY))
    return error_add(error, BRECCIA_USER_ERROR, "periods: from %g to %g s: expected two above 0, the shorter one first",
                     wish->shortest, wish->longest);
  if (!(wish->smoothing == 0 || (wish->smoothing >= 5 && wish->smoothing <= 1e4)))
    return error_add(error, BRECCIA_USER_ERROR,
                     "smoothing: %g is not 0 (none), or from 5 (much) to 1e4 (little); 40 is usual", wish->smoothing);
  if (wish->periods < 0 || wish->periods > 100000)
    return error_add(error, BRECCIA_USER_ERROR, "periods: %d of them; ask for 1 to 100000", wish->periods);
  if (!wish->periods) wish->periods = 1 + (int)ceil(60 * log10(wish->longest / wish->shortest) - 1e-9);
  return BRECCIA_OK;
}

#define SHORTEST_MOTION 1e-9

/** Where what oscillators do would take too long: they are looked at so many times a period. */
static int check_length(const breccia_motion *motion, const breccia_motion_wish *wish, Error *error)
{
  const double whole = motion->rows[2 * motion->count - 2] - motion->rows[0];
  if (!(whole > SHORTEST_MOTION))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s is over after %g s; expected more than %g s: in which unit are its times?", motion->name,
                     whole, SHORTEST_MOTION);
  if (whole / wish->shortest < 1e7) return BRECCIA_OK;
  return error_add(error, BRECCIA_USER_ERROR,
                   "periods: the shortest, %g s, goes more than 1e7 times into the %g s of %s; choose a longer one",
                   wish->shortest, whole, motion->name);
}

int breccia_motion_analyse(breccia_motion *motion, const breccia_motion *over, const breccia_motion_wish *given,
                           breccia_error *error)
{
  if (host_lacks(motion, __func__, "motion", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_motion below = {0}; /* a history of its own, so that the other motion is only read */
  forget_tables(motion);
  int status = take_wish(&motion->wish, given, error);
  if (!status) status = check_length(motion, &motion->wish, error);
  if (!status && over) status = check_length(over, &motion->wish, error);
  if (!status) status = find_history(motion, error);
  if (!status && over) {
    below = (breccia_motion){.rows = over->rows, .count = over->count};
    status = find_history(&below, error);
    motion->over = below.intensity;
    motion->over_name = text_format("%s", over->name);
  }
  if (!status) status = find_response(motion, over ? &below : NULL, error);
  if (!status) status = find_fourier(motion, over ? &below : NULL, error);
  if (!status) motion_tell(motion);
  forget_tables(&below);
  return host_leave(&host, status, error);
}

/* ---- looking ---- */

int breccia_motion_intensity(const breccia_motion *motion, breccia_intensity *intensity)
{
  if (!motion || !intensity) return 0;
  return sized_give(intensity, &motion->intensity, sizeof motion->intensity);
}

static const MotionTable *table_at(const breccia_motion *motion, int table)
{
  return table >= 0 && table < MOTION_TABLES ? &motion->tables[table] : NULL;
}

const char *breccia_motion_heading(const breccia_motion *motion, int table, int column)
{
  if (!motion) return NULL;
  const MotionTable *t = table_at(motion, table);
  return t && column >= 0 && column < t->count ? t->headings[column] : NULL;
}

const double *breccia_motion_column(const breccia_motion *motion, int table, int column)
{
  if (!motion) return NULL;
  return breccia_motion_heading(motion, table, column) ? motion->tables[table].columns[column] : NULL;
}

int breccia_motion_rows(const breccia_motion *motion, int table)
{
  if (!motion) return 0;
  const MotionTable *t = table_at(motion, table);
  return t ? t->rows : 0;
}

const char *breccia_motion_words(const breccia_motion *motion)
{
  if (!motion) return "";
  return text_words(&motion->words);
}

const char *breccia_motion_files(const breccia_motion *motion)
{
  if (!motion) return "";
  return text_words(&motion->files);
}
