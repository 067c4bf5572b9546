/* How long work takes of late, as a basis for how long the rest of it will take. Pure numbers: what took how long goes in, seconds per
 * unit come out. */
#ifndef BRECCIA_BASE_PACE_H
#define BRECCIA_BASE_PACE_H

typedef struct Pace {
  double units, seconds; /* of work done, what is long past counting less */
  double total;          /* seconds in all */
} Pace;

/** Begins with what is expected of a unit; half a second of real work counts as much. */
void pace_expect(Pace *pace, double seconds_per_unit);

/** Notes that so many units of work took so many seconds. What was noted ten seconds of work ago, or a tenth of all work if that is
 *  longer, counts for a third. */
void pace_note(Pace *pace, double units, double seconds);

/** @return seconds per unit, 0 if nothing is known */
double pace_of(const Pace *pace);

#endif
