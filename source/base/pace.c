#include "base/pace.h"

#include <math.h>

#define MEMORY 10.0      /* seconds */
#define EXPECTATION 0.5  /* seconds of work that an expectation counts for */
#define MEMORY_SHARE 0.1 /* of all work */

void pace_expect(Pace *pace, double seconds_per_unit)
{
  *pace = (Pace){0};
  if (!(seconds_per_unit > 0)) return;
  pace->seconds = EXPECTATION;
  pace->units = EXPECTATION / seconds_per_unit;
}

void pace_note(Pace *pace, double units, double seconds)
{
  pace->total += seconds;
  const double fade = exp(-seconds / fmax(MEMORY, MEMORY_SHARE * pace->total));
  pace->units = fade * pace->units + units;
  pace->seconds = fade * pace->seconds + seconds;
}

double pace_of(const Pace *pace)
{
  return pace->units > 0 ? pace->seconds / pace->units : 0;
}
