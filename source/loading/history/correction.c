#include "loading/history/correction.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

void record_steps(const Record *record, double *shortest, double *longest)
{
  *shortest = INFINITY;
  *longest = 0;
  for (int k = 1; k < record->count; ++k) {
    const double step = record->rows[2 * k] - record->rows[2 * k - 2];
    *shortest = fmin(*shortest, step);
    *longest = fmax(*longest, step);
  }
}

int record_resample(Record *record, double step, Error *error)
{
  const double *old = record->rows, first = old[0], last = old[2 * record->count - 2];
  const double count = floor((last - first) / step + 1e-6) + 1;
  double *rows = memory_zeroed((size_t)count * 2, sizeof *rows, "record", error);
  if (!rows) return BRECCIA_FAILURE;
  const Polyline line = {.rows = old, .count = record->count};
  for (int k = 0; k < (int)count; ++k) {
    rows[2 * k] = first + k * step;
    rows[2 * k + 1] = polyline_value(&line, rows[2 * k]);
  }
  free(record->rows);
  *record = (Record){.rows = rows, .count = (int)count};
  return BRECCIA_OK;
}

static double *values_of(const Record *record, Error *error)
{
  double *values = memory_zeroed((size_t)record->count, sizeof *values, "record", error);
  for (int k = 0; values && k < record->count; ++k) values[k] = record->rows[2 * k + 1];
  return values;
}

static void put_back(Record *record, double *values)
{
  for (int k = 0; k < record->count; ++k) record->rows[2 * k + 1] = values[k];
  free(values);
}

int record_take_off(Record *record, int degree, Error *error)
{
  double *values = values_of(record, error);
  if (!values) return BRECCIA_FAILURE;
  signal_take_off(values, record->count, degree);
  put_back(record, values);
  return BRECCIA_OK;
}

int record_band_pass(Record *record, const Band *band, Error *error)
{
  const double whole = record->rows[2 * record->count - 2] - record->rows[0];
  double *values = values_of(record, error);
  if (!values) return BRECCIA_FAILURE;
  const int status = signal_band_pass(values, record->count, whole / (record->count - 1), band, error);
  put_back(record, values);
  return status;
}

void record_end_at_rest(Record *record)
{
  double *row = record->rows, velocity = 0, displacement = 0;
  const double begin = row[0], whole = row[2 * record->count - 2] - begin;
  for (int k = 1; k < record->count; ++k) { /* a step from a to b adds h a / 2 + h b / 2, and h^2 (2 a + b) / 6 */
    const double h = row[2 * k] - row[2 * k - 2], a = row[2 * k - 1], b = row[2 * k + 1];
    displacement += h * velocity + h * h * (2 * a + b) / 6;
    velocity += h * (a + b) / 2;
  }
  /* The line alone comes to a T + b T^2 / 2, and to a T^2 / 2 + b T^3 / 6. */
  const double slope = 6 * (velocity * whole - 2 * displacement) / (whole * whole * whole);
  const double constant = velocity / whole - slope * whole / 2;
  for (int k = 0; k < record->count; ++k) row[2 * k + 1] -= constant + slope * (row[2 * k] - begin);
}
