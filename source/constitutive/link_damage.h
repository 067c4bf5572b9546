/* Damage by stretch, of links and of points alike: the thesis of Tuniki 2012 (3.4) and its forms that spend a fracture energy (docs/theory.md 6.5). */
#ifndef BRECCIA_CONSTITUTIVE_LINK_DAMAGE_H
#define BRECCIA_CONSTITUTIVE_LINK_DAMAGE_H

#include "constitutive/law.h"

#include <stdbool.h>

/** How damage grows with a stretch, or with a shortening as a positive number: 0 up to `begin`, 1 from `end` on. In between it grows linearly with the
 *  stretch, or so that the force, `stretch` times what is left, falls linearly, as if it were to end at `first_end`. The second line, from the kink to
 *  `end`, leaves tail (end - stretch) / stretch of the stiffness; there is none where tail is 0. */
typedef struct LinkCurve {
  double begin, end, first_end, tail;
  bool linear_force;
} LinkCurve;

static inline LinkCurve link_in_tension(const breccia_link *l)
{
  LinkCurve c = {l->tension_begin, l->tension_end, l->tension_end, 0, l->linear_force};
  if (!(l->tension_first_end > 0)) return c;
  c.first_end = l->tension_first_end;
  c.tail = l->tension_kink * c.begin / (c.end - c.begin - (1 - l->tension_kink) * (c.first_end - c.begin));
  return c;
}

static inline LinkCurve link_in_compression(const breccia_link *l)
{
  return (LinkCurve){l->compression_begin, l->compression_end, l->compression_end, 0, false};
}

/** Sets where a force ends that falls in one line or in two, both of which spend the same. @param[in] straight  where one line would end */
static inline void link_find_ends(breccia_link *l, double straight)
{
  const double first = l->initial_fracture_energy / l->fracture_energy;
  const bool bends = l->initial_fracture_energy > 0;
  l->tension_first_end = bends ? first * straight : 0;
  l->tension_end = bends ? (1 - (1 - l->tension_kink) * first) / l->tension_kink * straight : straight;
}

/** Damage of a stretch, or of a shortening as a positive number. */
static inline double link_damage(double stretch, const LinkCurve *c)
{
  if (!(stretch > c->begin)) return 0;
  if (stretch >= c->end) return 1;
  const double share = (stretch - c->begin) / (c->first_end - c->begin),
               first = c->linear_force ? share * c->first_end / stretch : share,
               second = 1 + c->tail - c->tail * c->end / stretch;
  return first < second ? first : second;
}

/** Its derivative. */
static inline double link_damage_slope(double stretch, const LinkCurve *c)
{
  if (!(stretch > c->begin) || stretch >= c->end) return 0;
  const double slope = 1 / (c->first_end - c->begin), square = stretch * stretch;
  if (!c->linear_force) return slope;
  const bool first = (stretch - c->begin) * slope * c->first_end < (1 + c->tail) * stretch - c->tail * c->end;
  return (first ? slope * c->first_end * c->begin : c->tail * c->end) / square;
}

#endif
