/* Records of the PEER ground motion database and of programs that write like it: lines of heading, among them the
 * unit (UNITS OF G), the number of values and the time step (NPTS= 4000, DT= .005 SEC, or 4000 .005 NPTS, DT), then
 * the values. The first value is of time 0. Files of the database have four lines of heading, the last with number
 * and step (https://ngawest2.berkeley.edu); those of rotated components and of other programs have more, in another
 * order. The heading ends at the first line of numbers alone behind these two. */
#include "loading/history/record_formats.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const struct {
  const char *ending;
  const RecordQuantity *quantity;
} peer_endings[] = {{".at2", &record_acceleration}, {".vt2", &record_velocity}, {".dt2", &record_displacement}};

/** The quantity that the ending of a file stands for; NULL: the ending is none of the database. */
static const RecordQuantity *peer_quantity(const char *path)
{
  const char *ending = strrchr(path, '.');
  for (size_t k = 0; ending && k < sizeof peer_endings / sizeof *peer_endings; ++k)
    if (!strcasecmp(ending, peer_endings[k].ending)) return peer_endings[k].quantity;
  return NULL;
}

static bool peer_recognises(const RecordText *text)
{
  bool count = false, step = false;
  if (record_all_numbers(text->lines[0])) return false;
  if (peer_quantity(text->path)) return true;
  for (int k = 0; k < text->count && !record_all_numbers(text->lines[k]); ++k) {
    count |= record_word(text->lines[k], "NPTS") != NULL;
    step |= record_word(text->lines[k], "DT") != NULL;
  }
  return count && step;
}

/** The number behind a word, like 0.01 in "DT (SEC) = 1.00D-02".
 *  @param[out] unit  what follows the word in parentheses or, without these, the number
 *  @return NaN if there is none */
static double peer_number(const char *line, const char *word, const char **unit)
{
  const char *c = record_word(line, word), *end;
  *unit = "";
  if (!c) return NAN;
  c += strspn(c, " \t");
  const char *close = *c == '(' ? strchr(c, ')') : NULL;
  *unit = close ? c + 1 : NULL;
  if (close) c = close + 1;
  const double value = record_number(c + strspn(c, " \t=:"), &end);
  if (!*unit) *unit = end;
  return value;
}

/** A time step in s. @param[in] unit  ms or another one, which is taken for s */
static double peer_seconds(double step, const char *unit)
{
  unit += strspn(unit, " \t");
  return record_word(unit, "msec") == unit + 4 || record_word(unit, "ms") == unit + 2 ? step / 1000 : step;
}

/** Takes number of values and time step from a line, as far as it has them. */
static void peer_take(const char *line, double *count, double *step)
{
  const char *end, *next;
  const double values = peer_number(line, "NPTS", &end), seconds = peer_number(line, "DT", &next);
  if (!isnan(values)) *count = values;
  if (!isnan(seconds)) *step = peer_seconds(seconds, next);
  if (!isnan(values) || !isnan(seconds) || !record_word(line, "NPTS") || !record_word(line, "DT")) return;
  *count = record_number(line, &end); /* both stand before their names */
  *step = record_number(end + strspn(end, " \t,"), &next);
}

/** Finds number of values and time step. @return index of the line behind them; -1 if they are missing */
static int peer_heading(const RecordText *text, double *count, double *step)
{
  const char *end, *next;
  *count = *step = NAN;
  for (int k = 0; k < text->count; ++k) {
    peer_take(text->lines[k], count, step);
    if (!isnan(*count) && !isnan(*step)) return k + 1;
  }
  if (text->count < 4) return -1;
  *count = record_number(text->lines[3], &end);
  *step = record_number(end, &next);
  return end > text->lines[3] && next > end ? 4 : -1;
}

/** The unit behind "units of", "units:" and the like, or behind "units" alone if it is one that is known.
 *  @return its first character; NULL if the line names none so */
static const char *peer_unit_word(const char *line)
{
  const char *c = record_word(line, "units");
  if (!c) c = record_word(line, "unit");
  if (!c) return NULL;
  const RecordQuantity *ignored;
  c += strspn(c, " \t");
  const char *word = record_word(c, "of") == c + 2 ? c + 2 : c;
  const bool announced = word != c || (*c && strchr(":=([", *c));
  word += strspn(word, " \t:=([");
  return *word && (announced || !isnan(record_unit(word, &ignored, NULL))) ? word : NULL;
}

/** The unit of a line such as "Acceleration in g" or "ACCELERATION (CM/S2)". @return NaN if it names none so */
static double peer_loose_unit(const char *line, const RecordQuantity **quantity)
{
  static const char *const names[] = {"acc", "accel", "acceleration", "vel", "velocity", "disp", "displacement"};
  bool named = false;
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k) named |= record_word(line, names[k]) != NULL;
  if (!named) return NAN;
  double factor = NAN;
  for (const char *c = line; isnan(factor) && (c = record_word(c, "in"));)
    factor = record_unit(c + strspn(c, " \t"), quantity, NULL);
  for (const char *c = line; isnan(factor) && (c = strchr(c, '('));) {
    ++c;
    factor = record_unit(c + strspn(c, " \t"), quantity, NULL);
  }
  return factor;
}

/** Finds the unit in the lines of the heading: one that is named, or that of the database. @param[in,out] quantity
 *  of the ending of the file
 *  @param[out] factor  size of the unit in that in which the values come out */
static int peer_unit(const RecordText *text, int lines, const RecordQuantity **quantity, double *factor, Error *error)
{
  const RecordQuantity *wanted = *quantity, *found = wanted;
  *factor = 1;
  for (int k = 0; k < lines; ++k) {
    const char *word = peer_unit_word(text->lines[k]);
    const double size = word ? record_unit(word, &found, NULL) : peer_loose_unit(text->lines[k], &found);
    if (word && isnan(size))
      return error_add(error, BRECCIA_USER_ERROR,
                       "%s:%d: the unit '%.20s' is unknown; expected g, cm/s2, m/s2, mm/s2, in/s2, ft/s2 or gal of "
                       "accelerations, cm/s or m/s of velocities, cm or m of displacements: write one of them there, "
                       "and the factor under 'scale'",
                       text->path, k + 1, word);
    if (isnan(size)) continue;
    if (wanted && found != wanted)
      return error_add(error, BRECCIA_USER_ERROR,
                       "%s:%d: its values are of %s, and the ending of its name stands for %s; expected one of "
                       "%s: mend the unit, or name the file by what it holds (.AT2, .VT2, .DT2)",
                       text->path, k + 1, found->name, wanted->name, wanted->name);
    *quantity = found;
    *factor = size;
    return BRECCIA_OK;
  }
  if (!wanted)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: its heading names no unit; expected a line like 'ACCELERATION TIME SERIES IN UNITS OF G'",
                     text->path);
  return BRECCIA_OK;
}

static int peer_read(Record *record, const RecordText *text, const RecordFile *file, char *label, Error *error)
{
  RecordSeries series = {.text = text, .last = true};
  const RecordQuantity *quantity = peer_quantity(text->path);
  series.first = peer_heading(text, &series.count, &series.step);
  if (series.first < 0 || !(series.count >= 2) || !(series.step > 0))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s:%d: expected the number of values and the time step, like 'NPTS= 4000, DT= .005 SEC'; values "
                     "alone belong in a file without heading whose name does not end in .AT2",
                     text->path, series.first < 0 ? 4 : series.first);
  while (series.first < text->count && !record_all_numbers(text->lines[series.first])) ++series.first;
  const int status = peer_unit(text, series.first, &quantity, &series.factor, error);
  if (status) return status;
  record_label(quantity, label);
  return record_read_series(record, &series, file->units, error);
}

const RecordFormat record_peer = {.recognises = peer_recognises, .read = peer_read};
