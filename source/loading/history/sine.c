#include "loading/history.h"

#include <math.h>

typedef struct SineSpec {
  SectionHead head;
  double frequency, phase, from, until;
  NumberList envelope;
} SineSpec;

static void check_sine(const DeckReader *reader, void *section)
{
  const SineSpec *s = section;
  if (s->until <= s->from)
    node_error(reader->document, section_node(s, "until"), reader->error, "until: must be later than 'from'");
}

static const Field sine_fields[] = {
    {.key = "frequency",
     .kind = FIELD_NUMBER,
     .offset = offsetof(SineSpec, frequency),
     .dimension = "frequency",
     .range = "(0, inf)",
     .meaning = "cycles per time"},
    {.key = "phase",
     .kind = FIELD_NUMBER,
     .offset = offsetof(SineSpec, phase),
     .dimension = "angle",
     .standard = "0",
     .meaning = "angle at its beginning"},
    {.key = "from",
     .kind = FIELD_NUMBER,
     .offset = offsetof(SineSpec, from),
     .dimension = "time",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "begins at this time, with the angle 'phase'; 0 before. When absent: at time 0"},
    {.key = "until",
     .kind = FIELD_NUMBER,
     .offset = offsetof(SineSpec, until),
     .dimension = "time",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "ends at this time; 0 afterwards"},
    {.key = "envelope",
     .kind = FIELD_PAIRS,
     .offset = offsetof(SineSpec, envelope),
     .dimension = "1",
     .standard = "",
     .meaning = "amplitudes at times, straight lines between them, constant before and after; 1 when absent"},
};

const Section sine_history_section = {.name = "sine",
                                      .about = "sin(2 pi frequency time + phase), time from 'from' on.",
                                      .size = sizeof(SineSpec),
                                      FIELDS(sine_fields),
                                      .check = check_sine};

static double begin_of(const SineSpec *s)
{
  return isnan(s->from) ? 0 : s->from;
}

static int create(History *h, const DeckReader *reader)
{
  const SineSpec *s = h->value->section;
  h->line = (Polyline){.rows = s->envelope.values, .count = s->envelope.count};
  return s->envelope.count ? polyline_prepare(&h->line, reader->error) : BRECCIA_OK;
}

static double factor(const History *h, double time)
{
  const SineSpec *s = h->value->section;
  const double pi = acos(-1);
  if (isless(time, s->from) || isgreater(time, s->until)) return 0; /* also where they are not given */
  const double wave = sin(2 * pi * s->frequency * (time - begin_of(s)) + s->phase * pi / 180);
  return h->line.count ? wave * polyline_value(&h->line, time) : wave;
}

static double integral(const History *h, double scale, double time)
{
  const SineSpec *s = h->value->section;
  if (!isnan(s->from) || !isnan(s->until) || h->line.count) return NAN;
  const double pi = acos(-1), omega = 2 * pi * s->frequency, phase = s->phase * pi / 180;
  return scale * (cos(phase) - cos(omega * time + phase)) / omega;
}

/** Eighths of a period, over which a sine is a polynomial to all digits that count. */
static double corner(const History *h, double time)
{
  const SineSpec *s = h->value->section;
  const double begin = begin_of(s), eighth = 0.125 / s->frequency;
  if (time < begin) return begin;
  if (time >= s->until) return INFINITY;
  double next = begin + eighth * (floor((time - begin) / eighth) + 1);
  if (next <= time) next += eighth;
  if (h->line.count) next = fmin(next, polyline_corner(&h->line, time));
  return fmin(next, isnan(s->until) ? INFINITY : s->until);
}

static double rise(const History *h)
{
  const SineSpec *s = h->value->section;
  return fmax(0.25 / s->frequency, h->line.count ? polyline_rise(&h->line) : 0);
}

const HistoryType sine_history = {
    .create = create, .factor = factor, .integral = integral, .corner = corner, .rise = rise};
