/* Processed records in the V2 formats of COSMOS (Consortium of Organizations for Strong-Motion Observation Systems,
 * "COSMOS Strong Motion Data Format", version 1.20, 2001) and of the California Strong Motion Instrumentation
 * Program, from which it comes (Shakal and Huang 1985, OSMS 85-03). A file holds channels, each with headers of text,
 * integers and reals and then blocks of values in fixed columns. The line before a block says what it holds:
 *   7200 acceleration pts, approx 36 secs, units=cm/sec2(04),Format=(8f10.6)     COSMOS; step: 62nd real, in ms
 *   7200 points of accel data equally spaced at .005 sec, in cm/sec2. (8f10.6)       CSMIP
 * Accelerations are read; blocks of velocities and displacements are left out. */
#include "loading/history/record_formats.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { COSMOS_STEP = 61, COSMOS_REALS = COSMOS_STEP + 1 };

/** Finds words whose case does not count. @return the character after them, or NULL */
static const char *cosmos_behind(const char *line, const char *words)
{
  for (const char *c = line; *c; ++c)
    if (!strncasecmp(c, words, strlen(words))) return c + strlen(words);
  return NULL;
}

/** Number and width of columns in a format of Fortran, like (8f10.6). @return false if the line has none */
static bool cosmos_columns(const char *line, int *columns, int *width)
{
  for (const char *open = line; (open = strchr(open, '(')); ++open) {
    char *end, *last;
    const char *digits = open + 1 + strspn(open + 1, " ");
    const long count = strtol(digits, &end, 10);
    if (end == digits || !*end || !strchr("fFeEgGiI", *end)) continue;
    const long size = strtol(end + 1, &last, 10);
    if (last == end + 1 || count < 1 || count > 100 || size < 1 || size > 40) continue;
    *columns = (int)count;
    *width = (int)size;
    return true;
  }
  return false;
}

/** True for the line before a block of accelerations. */
static bool cosmos_is_block(const char *line)
{
  const char *end, *c;
  record_number(line, &end);
  if (end == line) return false;
  c = end + strspn(end, " ");
  if (!strncasecmp(c, "points of ", 10))
    return !strncasecmp(c + 10, "accel", 5) && cosmos_behind(c, "equally spaced at");
  return !strncasecmp(c, "accel", 5) && cosmos_behind(c, " pts") && cosmos_behind(c, "units");
}

static bool cosmos_recognises(const RecordText *text)
{
  if (cosmos_behind(text->lines[0], "(Format v")) return true;
  for (int k = 0; k < text->count; ++k)
    if (cosmos_is_block(text->lines[k])) return true;
  return false;
}

/** Time step in s of a block, from its own line or from the reals of its channel. @return NaN if it is missing */
static double cosmos_step(const RecordText *text, int block)
{
  const char *end, *at = cosmos_behind(text->lines[block], "equally spaced at");
  if (at) return record_number(at, &end);
  double reals[COSMOS_REALS];
  int columns, width;
  for (int k = block - 1; k >= 0 && !cosmos_is_block(text->lines[k]); --k) {
    if (!cosmos_behind(text->lines[k], "real-header values")) continue;
    if (!cosmos_columns(text->lines[k], &columns, &width) ||
        !record_read_header(text, k + 1, width, columns, reals, COSMOS_REALS))
      return NAN;
    return reals[COSMOS_STEP] / 1000;
  }
  return NAN;
}

/** Size in g of the unit that the line of a block names. @return NaN if it names none of accelerations */
static double cosmos_unit(const char *line)
{
  static const char *const before[] = {"units=", "units:", "units of ", "sec, in ", "sec in "};
  const RecordQuantity *quantity = NULL;
  for (size_t k = 0; k < sizeof before / sizeof *before; ++k) {
    const char *at = cosmos_behind(line, before[k]);
    const double size = at ? record_unit(at + strspn(at, " "), &quantity, NULL) : NAN;
    if (!isnan(size) && quantity == &record_acceleration) return size;
  }
  return NAN;
}

static int cosmos_read_block(Record *record, const RecordText *text, int block, const Units *units, Error *error)
{
  const char *line = text->lines[block], *end;
  int columns;
  RecordSeries series = {
      .text = text, .first = block + 1, .step = cosmos_step(text, block), .factor = cosmos_unit(line)};
  series.count = record_number(line, &end);
  cosmos_columns(line, &columns, &series.width); /* else blanks part the numbers */
  if (isnan(series.factor))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s:%d: expected a unit of accelerations, cm/sec2 or g, found '%.80s'; counts of a recorder "
                     "(V0) are to be processed first",
                     text->path, block + 1, line);
  if (!(series.step > 0))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s:%d: expected a time step before these values: 'equally spaced at .005 sec', or that in ms as "
                     "real %d of the channel's header",
                     text->path, block + 1, COSMOS_STEP + 1);
  const char *approx = cosmos_behind(line, "approx");
  const double told = approx ? record_number(approx, &end) : NAN, length = series.count * series.step;
  if (fabs(told - length) > 1 + 0.02 * length)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s:%d: says approximately %g s, and %g values with the step of the header, %g s, make %g s; "
                     "expected both to be the same",
                     text->path, block + 1, told, series.count, series.step, length);
  return record_read_series(record, &series, units, error);
}

static int cosmos_read(Record *record, const RecordText *text, const RecordFile *file, char *label, Error *error)
{
  int count = 0, block = -1;
  for (int k = 0; k < text->count; ++k)
    if (cosmos_is_block(text->lines[k]) && (++count == file->channel || !file->channel)) block = k;
  if (!count)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: expected a block of accelerations, like '7200 acceleration pts, approx 36 secs, "
                     "units=cm/sec2(04),Format=(8f10.6)'; it holds none",
                     text->path);
  if (file->channel > count)
    return error_add(error, BRECCIA_USER_ERROR, "%s: holds %d channels of accelerations, and channel %d was asked for",
                     text->path, count, file->channel);
  if (!file->channel && count > 1)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: holds %d channels of accelerations; choose one with 'channel' (--channel of 'breccia "
                     "spectrum')",
                     text->path, count);
  record_label(&record_acceleration, label);
  return cosmos_read_block(record, text, block, file->units, error);
}

const RecordFormat record_cosmos = {.recognises = cosmos_recognises, .read = cosmos_read};
