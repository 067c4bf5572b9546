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

int whole_families_in_the_middle(const Body *body, const Family *family, int block, double least, int most,
                                 int64_t *places)
{
  const Particles *p = family->particles;
  const double volume = whole_family_volume(body, family, block, least);
  double middle[3] = {0}, inside = 0;
  int count = 0;
  for (int64_t place = 0; place < p->places; ++place) {
    if (!whole_family_at(family, block, place, volume)) continue;
    for (int k = 0; k < 3; ++k) middle[k] += p->position[k][place];
    ++inside;
  }
  for (int64_t place = 0; place < p->places; ++place) {
    if (!whole_family_at(family, block, place, volume)) continue;
    int at = count < most ? count++ : most;
    double away[2] = {0};
    for (; at > 0; --at) { /* moves the place before all places that are farther from the middle */
      for (int n = 0; n < 2; ++n) away[n] = 0;
      for (int k = 0; k < 3; ++k) {
        away[0] += pow(p->position[k][place] - middle[k] / inside, 2);
        away[1] += pow(p->position[k][places[at - 1]] - middle[k] / inside, 2);
      }
      if (!(away[0] < away[1])) break;
      if (at < most) places[at] = places[at - 1];
    }
    if (at < most) places[at] = place;
  }
  return count;
}
