#include "loading/history.h"

#include <math.h>

static const Field sine_fields[] = {
    {"frequency", FIELD_NUMBER, offsetof(SineSpec, frequency), "frequency", NULL, "(0, inf)", "cycles per time", NULL,
     NULL, 0},
    {"phase", FIELD_NUMBER, offsetof(SineSpec, phase), "angle", "0", NULL, "angle at time 0", NULL, NULL, 0},
};
static const Section sine_section = {
    "sine", "sin(2 pi frequency time + phase).", sizeof(SineSpec), FIELDS(sine_fields), NULL, NULL, NULL, 0};

static const Field history_fields[] = {
    {"ramp to", FIELD_NUMBER, offsetof(HistorySpec, ramp), "time", "", "(0, inf)",
     "from 0 to the full value at this time, then constant", NULL, NULL, 'A'},
    {"constant", FIELD_FLAG, offsetof(HistorySpec, constant), NULL, "", NULL, "the full value from the beginning", NULL,
     NULL, 'A'},
    {"table", FIELD_PAIRS, offsetof(HistorySpec, table), "1", "", NULL,
     "factors at times, straight lines between them, constant before and after", NULL, NULL, 'A'},
    {"sine", FIELD_SECTION, offsetof(HistorySpec, sine), NULL, "", NULL, "harmonic", &sine_section, NULL, 'A'},
};
const Section history_section = {"history",
                                 "How a load varies in time: a factor on its value.",
                                 sizeof(HistorySpec),
                                 FIELDS(history_fields),
                                 NULL,
                                 NULL,
                                 NULL,
                                 0};

double history_factor(const HistorySpec *spec, double time)
{
  if (!spec || spec->constant) return 1;
  if (!isnan(spec->ramp)) return fmax(0, fmin(1, time / spec->ramp));
  if (spec->sine) {
    const double pi = acos(-1);
    return sin(2 * pi * spec->sine->frequency * time + spec->sine->phase * pi / 180);
  }
  const double *row = spec->table.values;
  int count = spec->table.count;
  if (!count) return 1;
  if (time <= row[0]) return row[1];
  for (int k = 1; k < count; ++k)
    if (time <= row[2 * k]) {
      double share = (time - row[2 * k - 2]) / (row[2 * k] - row[2 * k - 2]);
      return row[2 * k - 1] + share * (row[2 * k + 1] - row[2 * k - 1]);
    }
  return row[2 * count - 1];
}
