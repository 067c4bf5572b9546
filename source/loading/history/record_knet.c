/* Records of K-NET and KiK-net, Japan (National Research Institute for Earth Science and Disaster Resilience, "About
 * K-NET ASCII format", https://www.kyoshin.bosai.go.jp/kyoshin/man/knetform_en.html): 17 lines of names and values,
 * "Origin Time" first and "Memo." last, then counts of the recorder. An acceleration is the count times the scale
 * factor, like 3920(gal)/6182761. Counts have an offset that is no acceleration; as the networks do for the largest
 * acceleration that they tell, the mean of the whole record is subtracted. */
#include "loading/history/record_formats.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/** The line that begins with a name. @return its index, or -1 */
static int knet_line(const RecordText *text, const char *name)
{
  for (int k = 0; k < text->count; ++k)
    if (!strncasecmp(text->lines[k], name, strlen(name))) return k;
  return -1;
}

/** The number behind the name of a line. @param[out] end  the character after it @return NaN if there is none */
static double knet_number(const RecordText *text, const char *name, const char **end)
{
  const int line = knet_line(text, name);
  *end = "";
  return line < 0 ? NAN : record_number(text->lines[line] + strlen(name), end);
}

static bool knet_recognises(const RecordText *text)
{
  return !strncasecmp(text->lines[0], "Origin Time", strlen("Origin Time"));
}

/** The acceleration of one count, in g. @return NaN if the header does not have it */
static double knet_scale(const RecordText *text)
{
  const char *end;
  const RecordQuantity *quantity = NULL;
  int length;
  const double above = knet_number(text, "Scale Factor", &end);
  if (isnan(above) || *end != '(') return NAN;
  const double unit = record_unit(end + 1, &quantity, &length);
  if (quantity != &record_acceleration || end[1 + length] != ')' || end[2 + length] != '/') return NAN;
  const double below = record_number(end + 3 + length, &end);
  return above * unit / below;
}

static int knet_count(const RecordText *text, int first)
{
  int count = 0;
  const char *end;
  for (int k = first; k < text->count; ++k)
    for (const char *c = text->lines[k]; record_number(c, &end), end != c; c = end) ++count;
  return count;
}

static int knet_read(Record *record, const RecordText *text, const RecordFile *file, char *label, Error *error)
{
  const char *ignored;
  const int memo = knet_line(text, "Memo.");
  const double rate = knet_number(text, "Sampling Freq(Hz)", &ignored),
               duration = knet_number(text, "Duration Time(s)", &ignored), scale = knet_scale(text);
  if (!(rate > 0) || memo < 0)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: expected the lines 'Sampling Freq(Hz)', with a positive number, and 'Memo.' of a K-NET file",
                     text->path);
  if (!isfinite(scale) || scale == 0)
    return error_add(error, BRECCIA_USER_ERROR, "%s:%d: expected a scale factor, like 'Scale Factor 3920(gal)/6182761'",
                     text->path, knet_line(text, "Scale Factor") + 1);
  const int count = knet_count(text, memo + 1);
  if (!isnan(duration) && fabs(count / rate - duration) > 1)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: holds %d values at %g Hz, and its header says a duration of %g s; expected %.0f values",
                     text->path, count, rate, duration, duration * rate);
  const RecordSeries series = {
      .text = text, .first = memo + 1, .count = count, .step = 1 / rate, .factor = scale, .last = true};
  record_label(&record_acceleration, label);
  const int status = record_read_series(record, &series, file->units, error);
  double mean = 0;
  for (int k = 0; !status && k < count; ++k) mean += record->rows[2 * k + 1] / count;
  for (int k = 0; !status && k < count; ++k) record->rows[2 * k + 1] -= mean;
  return status;
}

const RecordFormat record_knet = {.recognises = knet_recognises, .read = knet_read};
