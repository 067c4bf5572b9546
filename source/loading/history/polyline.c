/* Straight lines between points of time, for tables, records and envelopes. */
#include "base/memory.h"
#include "loading/history.h"

#include <math.h>

/** How many of the points lie before a time, or at it. */
static int points_until(const Polyline *line, double time)
{
  int low = 0, high = line->count;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (line->rows[2 * middle] <= time)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

double polyline_value(const Polyline *line, double time)
{
  const double *row = line->rows;
  const int count = line->count;
  if (line->ends && (time < row[0] || time > row[2 * count - 2])) return 0;
  if (time <= row[0]) return row[1];
  if (time > row[2 * count - 2]) return row[2 * count - 1];
  int k = points_until(line, time);
  if (row[2 * k - 2] == time) --k; /* the piece that ends here */
  const double share = (time - row[2 * k - 2]) / (row[2 * k] - row[2 * k - 2]);
  return row[2 * k - 1] + share * (row[2 * k + 1] - row[2 * k - 1]);
}

/** The integral over a piece without corners. */
static double piece(const Polyline *line, double begin, double end)
{
  return (end - begin) * (polyline_value(line, begin) + polyline_value(line, end)) / 2;
}

int polyline_prepare(Polyline *line, Error *error)
{
  line->sums = memory_zeroed((size_t)line->count, sizeof(double), "history", error);
  if (!line->sums) return BRECCIA_FAILURE;
  double begin = 0, sum = 0;
  for (int k = 0; k < line->count; ++k) {
    const double end = fmax(begin, line->rows[2 * k]);
    if (!line->ends || k || begin == end) sum += piece(line, begin, end);
    line->sums[k] = sum;
    begin = end;
  }
  return BRECCIA_OK;
}

double polyline_integral(const Polyline *line, double time)
{
  const int k = points_until(line, time);
  if (line->ends && (!k || k == line->count)) return k ? line->sums[k - 1] : 0;
  return k ? line->sums[k - 1] + piece(line, fmax(0, line->rows[2 * k - 2]), time) : piece(line, 0, time);
}

double polyline_corner(const Polyline *line, double time)
{
  const int k = points_until(line, time);
  return k < line->count ? line->rows[2 * k] : INFINITY;
}

/** What the whole would take at the steepest pace, if it is not there at once. */
double polyline_rise(const Polyline *line)
{
  const double *row = line->rows;
  double largest = 0, steepest = 0;
  for (int k = 0; k < line->count; ++k) {
    largest = fmax(largest, fabs(row[2 * k + 1]));
    if (k) steepest = fmax(steepest, fabs(row[2 * k + 1] - row[2 * k - 1]) / (row[2 * k] - row[2 * k - 2]));
  }
  return line->count && fabs(row[1]) < largest ? largest / steepest : 0;
}
