/* Records in the SMC format of the United States Geological Survey (National Strong-Motion Program, "SMC- and
 * BBF-format data files", https://escweb.wr.usgs.gov/nsmp-data/smcfmt.html): 11 lines of text, the first with the
 * kind of file and the last beginning with an asterisk; 6 lines of eight integers in columns of 10, the 16th the
 * number of comments, the 17th that of values; 10 lines of five reals in columns of 15, the second the samples a
 * second; comments behind bars; then values, eight in columns of 10, in cm and s. */
#include "loading/history/record_formats.h"

#include <math.h>
#include <string.h>
#include <strings.h>

enum { SMC_TEXT = 11, SMC_INTEGERS = 6, SMC_REALS = 10, SMC_COMMENTS = 15, SMC_VALUES = 16, SMC_COLUMN = 10 };

static const struct {
  const char *kind; /* as the first line of the file says it */
  const RecordQuantity *quantity;
  const char *unit;
} smc_kinds[] = {
    {"ACCELEROGRAM", &record_acceleration, "cm/s2"},
    {"VELOCITY", &record_velocity, "cm/s"},
    {"DISPLACEMENT", &record_displacement, "cm"},
};

static bool smc_recognises(const RecordText *text)
{
  const char *ending = strrchr(text->path, '.');
  return (ending && !strcasecmp(ending, ".smc")) || record_word(text->lines[0], "CORRECTED ACCELEROGRAM") ||
         record_word(text->lines[0], "UNCORRECTED ACCELEROGRAM");
}

static int smc_read(Record *record, const RecordText *text, const RecordFile *file, char *label, Error *error)
{
  const int reals_at = SMC_TEXT + SMC_INTEGERS;
  double integers[8 * SMC_INTEGERS], reals[2];
  size_t kind = 0;
  while (kind < sizeof smc_kinds / sizeof *smc_kinds && !record_word(text->lines[0], smc_kinds[kind].kind)) ++kind;
  if (kind == sizeof smc_kinds / sizeof *smc_kinds)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s:1: expected the kind of an SMC file, CORRECTED ACCELEROGRAM, VELOCITY or DISPLACEMENT, found "
                     "'%.40s'",
                     text->path, text->lines[0]);
  if (text->count <= reals_at + SMC_REALS || text->lines[SMC_TEXT - 1][0] != '*')
    return error_add(error, BRECCIA_USER_ERROR, "%s:%d: expected '*', with which the text of an SMC file ends",
                     text->path, SMC_TEXT);
  if (!record_read_header(text, SMC_TEXT, SMC_COLUMN, 8, integers, 8 * SMC_INTEGERS) || !(integers[SMC_COMMENTS] >= 0))
    return error_add(error, BRECCIA_USER_ERROR, "%s:%d: expected %d lines of eight integers in columns of %d",
                     text->path, SMC_TEXT + 1, SMC_INTEGERS, SMC_COLUMN);
  if (!record_read_header(text, reals_at, 15, 5, reals, 2) || !(reals[1] > 0) || reals[1] == reals[0] ||
      reals[1] >= 1e5)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s:%d: expected the samples a second as the second of five reals in columns of 15; records "
                     "without equal steps are to be written as two columns, times and values",
                     text->path, reals_at + 1);
  RecordSeries series = {.text = text,
                         .first = reals_at + SMC_REALS + (int)fmin(integers[SMC_COMMENTS], text->count),
                         .count = integers[SMC_VALUES],
                         .width = SMC_COLUMN,
                         .step = 1 / reals[1],
                         .last = true};
  const RecordQuantity *quantity;
  series.factor = record_unit(smc_kinds[kind].unit, &quantity, NULL);
  record_label(quantity, label);
  return record_read_series(record, &series, file->units, error);
}

const RecordFormat record_smc = {.recognises = smc_recognises, .read = smc_read};
