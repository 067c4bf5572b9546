/* Scales of axes and colour bars: their ends, their ticks, and the words at these. */
#ifndef BRECCIA_RESULTS_SCALE_H
#define BRECCIA_RESULTS_SCALE_H

#include <stdbool.h>
#include <stddef.h>

/** Distance of ticks: 1, 2 or 5 times a power of ten, about `number` of them in a range. */
double scale_ticks(double range, double number);

/** A tick's number, with as many decimals as its distance to the next asks for. */
void scale_words(double value, double distance, char *words, size_t size);

typedef struct ColourRange {
  double low, high; /* ends of the colour bar; low < high */
  bool diverging;   /* two colours that meet at zero, equal amounts equally dark */
} ColourRange;

/** Ends of a colour bar for values between `least` and `most` (least > most: there are none).
 *  Values of both signs get a diverging scale, whole if both matter and else one side of it; so do values that could have
 *  either sign (`has_sign`) and come near zero. Magnitudes begin at zero unless all are far from it. The ends are ticks, except
 *  those that are given: `low` and `high` not NaN. */
ColourRange scale_colours(double least, double most, bool has_sign, double low, double high);

#endif
