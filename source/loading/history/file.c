/* Histories from files: records of agencies, tables with a heading, two plain columns, values alone. */
#include "loading/history/correction.h"

#include "base/memory.h"
#include "deck/named_file.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct BandSpec {
  SectionHead head;
  double from, to;
  int64_t order;
} BandSpec;

static void check_band(const DeckReader *reader, void *section)
{
  const BandSpec *band = section;
  if (isnan(band->from) && isnan(band->to))
    node_error(reader->document, band->head.node, reader->error,
               "band pass: give the lower corner 'from', the upper one 'to', or both");
  if (band->to <= band->from)
    node_error(reader->document, section_node(band, "to"), reader->error, "to: must be above 'from'");
}

static const Field band_fields[] = {
    {.key = "from",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BandSpec, from),
     .dimension = "frequency",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "the lower corner, at which half of the amplitude is left; nothing is taken out below when absent"},
    {.key = "to",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BandSpec, to),
     .dimension = "frequency",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "the upper corner, below half of one over the time step"},
    {.key = "order",
     .kind = FIELD_COUNT,
     .offset = offsetof(BandSpec, order),
     .standard = "4",
     .range = "[1, 8]",
     .meaning = "of Butterworth's filter, which goes over the record forwards and then backwards"},
};

static const Section band_section = {.name = "band pass",
                                     .about = "Frequencies of a record that stay, without a shift in time.",
                                     .size = sizeof(BandSpec),
                                     FIELDS(band_fields),
                                     .check = check_band};

typedef struct FileSpec {
  SectionHead head;
  const char *name, *column, *times;
  int baseline; /* index of its word: degree of the polynomial + 1; 0: no correction */
  double scale, step;
  int64_t channel;
  BandSpec *band;
  bool at_rest;
} FileSpec;

static const char *baseline_word(int k)
{
  static const char *const words[] = {"none", "constant", "linear", "quadratic", "cubic", NULL};
  return words[k];
}

static const Field file_fields[] = {
    {.key = "name",
     .kind = FIELD_TEXT,
     .offset = offsetof(FileSpec, name),
     .meaning =
         "of the file, relative to the deck's. Records with a header are recognised: those of PEER (`.AT2`, `.VT2`, "
         "`.DT2`), the USGS (`.smc`), COSMOS or CSMIP (`.V2`), and K-NET or KiK-net (`.EW`, `.NS`, `.UD`). Their "
         "first value is at time 0, and accelerations come out in g, velocities in cm/s, displacements in cm, "
         "whatever the unit of the header. Others have two columns, times and values, parted by blanks or "
         "commas; values alone, one a line, with the 'time step'; or a heading and the 'column' that it names"},
    {.key = "column",
     .kind = FIELD_TEXT,
     .offset = offsetof(FileSpec, column),
     .standard = "",
     .meaning = "of a CSV file with a heading: which one holds the values"},
    {.key = "times",
     .kind = FIELD_TEXT,
     .offset = offsetof(FileSpec, times),
     .standard = "time",
     .meaning = "of a CSV file with a heading: the column of times, in the unit that stands behind its name in "
                "parentheses, else in the deck's"},
    {.key = "channel",
     .kind = FIELD_COUNT,
     .offset = offsetof(FileSpec, channel),
     .standard = "",
     .range = "[1, 1000]",
     .meaning = "of a COSMOS file with several channels of accelerations: which one, in the order of the file"},
    {.key = "scale",
     .kind = FIELD_NUMBER,
     .offset = offsetof(FileSpec, scale),
     .dimension = "1",
     .standard = "1",
     .meaning = "factor on all values"},
    {.key = "time step",
     .kind = FIELD_NUMBER,
     .offset = offsetof(FileSpec, step),
     .dimension = "time",
     .standard = "",
     .range = "(0, inf)",
     .meaning =
         "values at equal steps from the first time of the file on, by straight lines between its own; no longer "
         "than the file's longest. What follows needs equal steps. Of a file of values alone: their step, from time 0 "
         "on"},
    {.key = "baseline correction",
     .kind = FIELD_CHOICE,
     .offset = offsetof(FileSpec, baseline),
     .standard = "none",
     .meaning = "the polynomial that is fitted to the values by least squares and taken off",
     .choice = baseline_word},
    {.key = "band pass",
     .kind = FIELD_SECTION,
     .offset = offsetof(FileSpec, band),
     .standard = "",
     .meaning = "a filter, after the baseline correction",
     .section = &band_section},
    {.key = "end at rest",
     .kind = FIELD_FLAG,
     .offset = offsetof(FileSpec, at_rest),
     .standard = "no",
     .meaning =
         "last of all a straight line is taken off, so that what integrates the values once (velocity) and twice "
         "(displacement) ends at zero: of accelerations with which a base is moved"},
};

const Section file_history_section = {.name = "file history",
                                      .about = "Numbers from a file as factors on the load's value: straight lines "
                                               "between them, 0 before the first and after the last.",
                                      .size = sizeof(FileSpec),
                                      FIELDS(file_fields)};

/** Says it where the steps of a record are not as what follows needs them. */
static int check_steps(const Record *record, const FileSpec *spec, const char *key, const DeckReader *reader)
{
  double shortest, longest;
  record_steps(record, &shortest, &longest);
  if (longest - shortest <= 0.01 * longest) return BRECCIA_OK;
  return node_error(reader->document, section_node(spec, key), reader->error,
                    "%s: the steps of the file are not equal (%g to %g); give 'time step' too", key, shortest, longest);
}

/** What the deck wants to be made of a record, in the order of its keys. */
static int correct(Record *record, const FileSpec *spec, const DeckReader *reader)
{
  double shortest, longest;
  const int degree = spec->baseline;
  int status = BRECCIA_OK;
  record_steps(record, &shortest, &longest);
  if (spec->step > longest * (1 + 1e-9))
    status = node_error(reader->document, section_node(spec, "time step"), reader->error,
                        "time step: %g would leave out values of the file, whose longest step is %g; take this or less",
                        spec->step, longest);
  else if (record->rows[2 * record->count - 2] - record->rows[0] > 1e8 * spec->step)
    status = node_error(reader->document, section_node(spec, "time step"), reader->error,
                        "time step: %g makes more than 1e8 values of the file; choose a longer one", spec->step);
  else if (!isnan(spec->step) && !record->stepped)
    status = record_resample(record, spec->step, reader->error);
  if (!status && degree) status = check_steps(record, spec, "baseline correction", reader);
  if (!status && degree && record->count < 2 * degree)
    status = node_error(reader->document, section_node(spec, "baseline correction"), reader->error,
                        "baseline correction: %d values are too few for a %s one; take 'none'", record->count,
                        baseline_word(degree));
  if (!status && degree) status = record_take_off(record, degree - 1, reader->error);
  if (!status && spec->band) status = check_steps(record, spec, "band pass", reader);
  if (!status && spec->band) {
    record_steps(record, &shortest, &longest);
    if (spec->band->to >= 0.5 / longest)
      return node_error(reader->document, section_node(spec->band, "to"), reader->error,
                        "to: steps of %g hold frequencies below %g only; choose a lower one, or leave 'to' out",
                        longest, 0.5 / longest);
    const Band band = {spec->band->from, spec->band->to, (int)spec->band->order};
    status = record_band_pass(record, &band, reader->error);
  }
  if (!status && spec->at_rest) record_end_at_rest(record);
  return status;
}

static int create(History *h, const DeckReader *reader)
{
  const FileSpec *spec = h->value->section;
  if (!spec) return BRECCIA_USER_ERROR; /* said when it was read */
  const Node *node = section_node(spec, "name");
  char *path = text_beside(node_file(reader->document, node), spec->name);
  if (path) named_file_note(reader, spec->name, path);
  Error *words = breccia_error_create();
  Record record = {0};
  int status = path && words ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status) {
    const RecordFile file = {.path = path,
                             .column = spec->column,
                             .times = spec->times,
                             .step = spec->step,
                             .channel = spec->channel > 0 ? (int)spec->channel : 0,
                             .units = reader->units};
    status = record_read(&record, &file, NULL, words);
  }
  if (status)
    node_error(reader->document, node, reader->error, "file: %s", words ? breccia_error_text(words) : "out of memory");
  else
    status = correct(&record, spec, reader);
  h->rows = record.rows;
  for (int k = 0; !status && k < record.count; ++k) h->rows[2 * k + 1] *= spec->scale;
  h->line = (Polyline){.rows = h->rows, .count = record.count, .ends = true};
  if (!status) status = polyline_prepare(&h->line, reader->error);
  breccia_error_destroy(&words);
  free(path);
  return status;
}

static double factor(const History *h, double time)
{
  return polyline_value(&h->line, time);
}

static double integral(const History *h, double scale, double time)
{
  return scale * polyline_integral(&h->line, time);
}

static double corner(const History *h, double time)
{
  return polyline_corner(&h->line, time);
}

static double rise(const History *h)
{
  return polyline_rise(&h->line);
}

const HistoryType file_history = {
    .create = create, .factor = factor, .integral = integral, .corner = corner, .rise = rise};
