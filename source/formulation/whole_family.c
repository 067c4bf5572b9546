#include "formulation/whole_family.h"

#include <math.h>

double whole_family_volume(const Body *body, const Family *family, int block, double least)
{
  const double pi = acos(-1), horizon = family->horizon;
  const Particles *p = family->particles;
  const double full = body->dimensions == 3   ? 4 * pi / 3 * pow(horizon, 3)
                      : body->dimensions == 2 ? pi * horizon * horizon * body_section(body)
                                              : 2 * horizon * body_section(body);
  double largest = 0;
  for (int64_t place = 0; place < p->places; ++place)
    if (p->block[place / SLICE] == block && p->number[place] >= 0)
      largest = fmax(largest, p->volume[place] + family_volume(family, (int32_t)place));
  return largest < least * full ? INFINITY : WHOLE_FAMILY_SHARE * fmin(full, largest);
}

bool whole_family_at(const Family *family, int block, int64_t place, double volume)
{
  const Particles *p = family->particles;
  return p->block[place / SLICE] == block && p->number[place] >= 0 &&
         p->volume[place] + family_volume(family, (int32_t)place) >= volume;
}
