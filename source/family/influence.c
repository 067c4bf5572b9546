#include "family/influence.h"

#include <math.h>
#include <string.h>

static double constant(double q, double length)
{
  (void)q, (void)length;
  return 1;
}
static double conical(double q, double length)
{
  (void)length;
  return 1 - q;
}
static double inverse(double q, double length)
{
  (void)q;
  return 1 / length;
}
static double inverse_square(double q, double length)
{
  (void)q;
  return 1 / (length * length);
}
static double gaussian(double q, double length)
{
  (void)length;
  return exp(-4 * q * q);
}
static double quartic(double q, double length)
{
  (void)length;
  return (1 - q * q) * (1 - q * q);
}
static double cubic_spline(double q, double length)
{
  (void)length;
  return q <= 0.5 ? 2.0 / 3 - 4 * q * q + 4 * q * q * q : 4.0 / 3 * (1 - q) * (1 - q) * (1 - q);
}

static const Influence influences[] = {
    [INFLUENCE_CONSTANT] = {"constant", constant},
    [INFLUENCE_CONICAL] = {"conical", conical},
    [INFLUENCE_INVERSE] = {"inverse", inverse},
    [INFLUENCE_INVERSE_SQUARE] = {"inverse-square", inverse_square},
    [INFLUENCE_GAUSSIAN] = {"gaussian", gaussian},
    [INFLUENCE_QUARTIC] = {"quartic", quartic},
    [INFLUENCE_CUBIC_SPLINE] = {"cubic-spline", cubic_spline},
};
enum { COUNT = sizeof influences / sizeof *influences };

const Influence *influence_at(int k)
{
  return &influences[k];
}

const char *influence_word(int k)
{
  return k < COUNT ? influences[k].name : 0;
}
