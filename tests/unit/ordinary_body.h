/* What tests ask of a body of the ordinary formulation. */
#ifndef BRECCIA_TESTS_ORDINARY_BODY_H
#define BRECCIA_TESTS_ORDINARY_BODY_H

#include "formulation/ordinary.h"
#include "support.h"

static inline const Ordinary *ordinary_of(const breccia_model *m)
{
  return m->domain.regions[0].formulation;
}

static inline double weighted_volume(const breccia_model *m, int32_t place)
{
  return ordinary_of(m)->dimensions / ordinary_of(m)->inverse[place];
}

/** Particles nearer to the middle of the body than a share of its size each way. */
static inline bool is_inside(const Particles *p, const double size[3], int32_t place, double from_faces)
{
  bool inside = true;
  for (int k = 0; k < 3 && size[k] > 0; ++k)
    inside &= p->position[k][place] > from_faces && p->position[k][place] < size[k] - from_faces;
  return inside;
}

#endif
