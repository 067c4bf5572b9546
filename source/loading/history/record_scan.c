/* Lines, numbers and units of record files. */
#include "loading/history/record_scan.h"

#include "base/memory.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_COLUMN = 63, MAX_UNIT = 31 };
static const double max_values = 1e8;

/* ---- lines ---- */

int record_split(RecordText *out, const char *path, char *text, Error *error)
{
  size_t count = 1;
  for (const char *c = text; *c; ++c) count += *c == '\n';
  *out = (RecordText){.path = path, .lines = memory_zeroed(count, sizeof *out->lines, "record", error)};
  if (!out->lines) return BRECCIA_FAILURE;
  for (char *line = text, *next; line; line = next) {
    next = strchr(line, '\n');
    if (next) *next++ = 0;
    const size_t length = strlen(line);
    if (length && line[length - 1] == '\r') line[length - 1] = 0;
    out->lines[out->count++] = line;
  }
  return BRECCIA_OK;
}

const char *record_word(const char *line, const char *word)
{
  const size_t length = strlen(word);
  for (const char *c = line; *c; ++c) {
    if (strncasecmp(c, word, length) != 0 || isalnum((unsigned char)c[length])) continue;
    if (c == line || !isalnum((unsigned char)c[-1])) return c + length;
  }
  return NULL;
}

/* ---- numbers ---- */

/** Exponent that Fortran wrote with a D or Q, or without a letter where it has three digits. @return 0 if there is
 *  none */
static int record_exponent(const char *from, const char **end)
{
  const bool letter = *from && strchr("dDqQ", *from);
  const char *sign = letter ? from + 1 : from;
  const char *digits = *sign == '+' || *sign == '-' ? sign + 1 : sign;
  const size_t count = strspn(digits, "0123456789");
  *end = from;
  if (letter ? !count || count > 3 : digits == from || count != 3 || digits[count] == '.') return 0;
  *end = digits + count;
  return (int)strtol(sign, NULL, 10);
}

double record_number(const char *from, const char **end)
{
  char *behind;
  const char *mantissa = from + strspn(from, " \t");
  *end = from;
  if (!*mantissa || !strchr("+-.0123456789", *mantissa)) return NAN;
  double value = strtod(mantissa, &behind);
  if (behind == mantissa || !isfinite(value)) return NAN;
  const char *after;
  const int exponent = record_exponent(behind, &after);
  if (after != behind) {
    char words[MAX_COLUMN + 1];
    const int length = (int)(behind - mantissa);
    if (length > MAX_COLUMN - 8) return NAN;
    snprintf(words, sizeof words, "%.*se%d", length, mantissa, exponent);
    value = strtod(words, NULL);
  }
  *end = after;
  return value;
}

static const char *record_skip(const char *c)
{
  return c + strspn(c, " \t,");
}

bool record_all_numbers(const char *line)
{
  const char *c = record_skip(line), *end;
  if (!*c) return false;
  for (; *c; c = record_skip(end)) {
    record_number(c, &end);
    if (end == c || (*end && !strchr(" \t,+-", *end))) return false;
  }
  return true;
}

/** The number in a column of a line. @return false if the column holds anything but one number */
static bool record_column(const char *column, size_t width, double *value)
{
  char words[MAX_COLUMN + 1];
  const char *end;
  snprintf(words, sizeof words, "%.*s", (int)width, column);
  *value = record_number(words, &end);
  return end != words && !*record_skip(end);
}

/** Reads the next number of a line. @param[in,out] at  moves past the number; at the end of the line afterwards if
 *  there is none
 *  @return false if something else stands there */
static bool record_next(const char **at, int width, double *value)
{
  const char *end;
  if (!width) {
    *value = record_number(*at, &end);
    const bool whole = end != *at && (!*end || strchr(" \t,+-", *end));
    *at = record_skip(end);
    return whole;
  }
  const size_t left = strlen(*at), size = left < (size_t)width ? left : (size_t)width;
  const bool whole = record_column(*at, size, value);
  *at += size;
  if (!*record_skip(*at)) *at += strlen(*at);
  return whole;
}

bool record_read_header(const RecordText *text, int first, int width, int per_line, double *values, int count)
{
  const char *at = "";
  for (int k = 0; k < count; ++k) {
    const int line = first + k / per_line;
    if (line >= text->count) return false;
    if (k % per_line == 0) at = text->lines[line];
    if (!*at || !record_next(&at, width, &values[k])) return false;
  }
  return true;
}

/** Refuses numbers behind the last one of a series, and words where nothing may follow. */
static int record_check_end(const RecordSeries *series, int line, const char *at, Error *error)
{
  const RecordText *text = series->text;
  while (!*record_skip(at) && ++line < text->count) at = text->lines[line];
  if (line >= text->count) return BRECCIA_OK;
  if (record_all_numbers(at))
    return error_add(error, BRECCIA_USER_ERROR, "%s:%d: its heading says %g values, but it holds more numbers",
                     text->path, line + 1, series->count);
  if (series->last)
    return error_add(error, BRECCIA_USER_ERROR, "%s:%d: expected the end of the file after %g values, found '%.40s'",
                     text->path, line + 1, series->count, record_skip(at));
  return BRECCIA_OK;
}

int record_read_series(Record *record, const RecordSeries *series, const Units *units, Error *error)
{
  const RecordText *text = series->text;
  double second = 1;
  Text ignored = {0};
  if (!(series->count >= 2) || series->count > max_values || series->count != floor(series->count))
    return error_add(error, BRECCIA_USER_ERROR, "%s: its heading says %g values; expected a whole number from 2 to %g",
                     text->path, series->count, max_values);
  if (!(series->step > 0) || !isfinite(series->step))
    return error_add(error, BRECCIA_USER_ERROR, "%s: its heading says a time step of %g s; expected a positive one",
                     text->path, series->step);
  units_read(units, dimension_find("time"), "1 s", &second, &ignored);
  text_free(&ignored);
  const int count = (int)series->count;
  record->rows = memory_zeroed((size_t)count * 2, sizeof(double), "record", error);
  if (!record->rows) return BRECCIA_FAILURE;
  int line = series->first;
  const char *at = line < text->count ? text->lines[line] : "";
  if (!series->width) at = record_skip(at);
  while (record->count < count) {
    if (!*at) {
      if (++line >= text->count)
        return error_add(error, BRECCIA_USER_ERROR, "%s: its heading says %d values, but it holds fewer numbers: %d",
                         text->path, count, record->count);
      at = text->lines[line];
      if (!series->width || !*record_skip(at)) at = record_skip(at);
      continue;
    }
    const char *from = at;
    double value;
    if (!record_next(&at, series->width, &value))
      return error_add(error, BRECCIA_USER_ERROR, "%s:%d: expected value %d of %d, a number%s, found '%.40s'",
                       text->path, line + 1, record->count + 1, count,
                       series->width ? " in columns as the heading says" : "", from);
    record->rows[2 * record->count] = record->count * series->step * second;
    record->rows[2 * record->count++ + 1] = value * series->factor;
  }
  return record_check_end(series, line, at, error);
}

/* ---- units ---- */

const RecordQuantity record_acceleration = {"acceleration", "g", 9.80665};
const RecordQuantity record_velocity = {"velocity", "cm/s", 0.01};
const RecordQuantity record_displacement = {"displacement", "cm", 0.01};

static const struct {
  const char *unit;
  const RecordQuantity *quantity;
  double size; /* in m and s */
} record_units[] = {
    {"g", &record_acceleration, 9.80665},
    {"gal", &record_acceleration, 0.01},
    {"gals", &record_acceleration, 0.01},
    {"m/s2", &record_acceleration, 1},
    {"cm/s2", &record_acceleration, 0.01},
    {"mm/s2", &record_acceleration, 0.001},
    {"in/s2", &record_acceleration, 0.0254},
    {"ft/s2", &record_acceleration, 0.3048},
    {"m/s", &record_velocity, 1},
    {"cm/s", &record_velocity, 0.01},
    {"mm/s", &record_velocity, 0.001},
    {"in/s", &record_velocity, 0.0254},
    {"ft/s", &record_velocity, 0.3048},
    {"m", &record_displacement, 1},
    {"cm", &record_displacement, 0.01},
    {"mm", &record_displacement, 0.001},
    {"in", &record_displacement, 0.0254},
    {"ft", &record_displacement, 0.3048},
};

/** Replaces every occurrence of a piece of a word by a shorter one, in place. */
static void record_shorten(char *word, const char *piece, const char *by)
{
  for (char *c; (c = strstr(word, piece));) {
    memcpy(c, by, strlen(by));
    memmove(c + strlen(by), c + strlen(piece), strlen(c + strlen(piece)) + 1);
  }
}

/** Copies the word of a unit in small letters, without blanks beside its operators.
 *  @return number of characters of `words` that it takes */
static int record_unit_word(const char *words, char word[MAX_UNIT + 1])
{
  int length = 0, used = 0;
  for (const char *c = words; *c && length < MAX_UNIT; ++c) {
    const char *next = c + strspn(c, " \t");
    if (next != c) { /* a blank ends the word, except beside an operator */
      if (!length || !*next || (!strchr("/*^", *next) && !strchr("/*^", word[length - 1]))) break;
      c = next;
    }
    if (!isalnum((unsigned char)*c) && !strchr("/*^-%'", *c)) break;
    word[length++] = (char)tolower((unsigned char)*c);
    used = (int)(c - words) + 1;
  }
  word[length] = 0;
  return used;
}

double record_unit(const char *words, const RecordQuantity **quantity, int *length)
{
  char word[MAX_UNIT + 1];
  const int used = record_unit_word(words, word);
  static const char *const spellings[][2] = {{"seconds", "s"}, {"second", "s"}, {"sec", "s"}, {"inches", "in"},
                                             {"inch", "in"},   {"**", ""},      {"^", ""},    {"/s/s", "/s2"},
                                             {"/s*s", "/s2"},  {"g's", "g"},    {"gs", "g"}};
  for (size_t k = 0; k < sizeof spellings / sizeof *spellings; ++k)
    record_shorten(word, spellings[k][0], spellings[k][1]);
  if (length) *length = used;
  for (size_t k = 0; k < sizeof record_units / sizeof *record_units; ++k) {
    if (strcmp(word, record_units[k].unit) != 0) continue;
    *quantity = record_units[k].quantity;
    return record_units[k].size / record_units[k].quantity->size;
  }
  return NAN;
}

void record_label(const RecordQuantity *quantity, char *label)
{
  if (label) snprintf(label, RECORD_LABEL, "%s (%s)", quantity->name, quantity->unit);
}
