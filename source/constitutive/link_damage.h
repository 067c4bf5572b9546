/* Damage by stretch, of links and of points alike: the thesis of Tuniki 2012 (3.4) and its form that spends a fracture energy (docs/theory.md 6.5). */
#ifndef BRECCIA_CONSTITUTIVE_LINK_DAMAGE_H
#define BRECCIA_CONSTITUTIVE_LINK_DAMAGE_H

#include <stdbool.h>

/** Damage of a stretch, or of a shortening as a positive number: 0 up to `begin`, 1 from `end` on. In between it grows linearly with the stretch, or
 *  so that the force, `stretch` times what is left, falls linearly. */
static inline double link_damage(double stretch, double begin, double end, bool linear_force)
{
  if (!(stretch > begin)) return 0;
  if (stretch >= end) return 1;
  const double share = (stretch - begin) / (end - begin);
  return linear_force ? share * end / stretch : share;
}

/** Its derivative. */
static inline double link_damage_slope(double stretch, double begin, double end, bool linear_force)
{
  if (!(stretch > begin) || stretch >= end) return 0;
  const double slope = 1 / (end - begin);
  return linear_force ? slope * end * begin / (stretch * stretch) : slope;
}

#endif
