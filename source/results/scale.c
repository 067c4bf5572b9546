#include "results/scale.h"

#include <math.h>
#include <stdio.h>

double scale_ticks(double range, double number)
{
  double power = pow(10, floor(log10(range / number))), part = range / number / power;
  return power * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10);
}

void scale_words(double value, double distance, char *words, size_t size)
{
  if (fabs(value) < 1e-9 * distance) value = 0;
  int decimals = (int)fmax(0, -floor(log10(distance) + 1e-9));
  if (decimals > 6 || fabs(value) >= 1e7)
    snprintf(words, size, "%.6g", value);
  else
    snprintf(words, size, "%.*f", decimals, value);
}

ColourRange scale_colours(double least, double most, bool has_sign, double low, double high)
{
  if (!(least <= most)) least = most = 0;
  const double big = fmax(fabs(least), fabs(most)), small = least < 0 && most > 0 ? fmin(-least, most) : 0;
  ColourRange r = {least, most, has_sign || least < 0};
  const bool near_zero = small > 0 || fmin(fabs(least), fabs(most)) <= 0.5 * big || most - least <= 1e-9 * big;
  if (big == 0) { /* nothing but zeros */
    r.high = 1;
    if (r.diverging) r.low = -1;
  } else if (near_zero) {
    r.low = fmin(r.low, 0);
    r.high = fmax(r.high, 0);
    if (small > 0.05 * big) {
      r.low = -big;
      r.high = big;
    } else if (r.diverging) /* the few beyond zero are as good as grey */
      *(most > -least ? &r.low : &r.high) = 0;
  } else
    r.diverging = false;
  const double distance = scale_ticks(r.high - r.low, 5);
  r.low = distance * floor(r.low / distance + 1e-9);
  r.high = distance * ceil(r.high / distance - 1e-9);
  if (!isnan(low)) r.low = low;
  if (!isnan(high)) r.high = high;
  if (!isnan(low) || !isnan(high)) {
    if (!(r.high > r.low)) { /* the end that was given lies beyond the data */
      if (isnan(high))
        r.high = r.low + fmax(1, fabs(r.low));
      else
        r.low = r.high - fmax(1, fabs(r.high));
    }
    r.diverging = (has_sign || least < 0 || r.low < 0) && r.low <= 0 && r.high >= 0;
  }
  return r;
}
