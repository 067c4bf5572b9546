/* Material points whose law softens: the number of points past their peak, the number of points that carry nothing, and
 * the most damaged points. A point is damaged if a history number that its law marks as damage exceeds round-off.
 * Points belong to particles, to bonds, or to links of a formulation that stores their damage itself. */
#ifndef BRECCIA_DOMAIN_SOFTENED_H
#define BRECCIA_DOMAIN_SOFTENED_H

#include "domain/domain.h"

enum { SOFTENED_LISTED = 10 };

/** One damaged point. */
typedef struct SoftenedPoint {
  /** Numbers of both ends of a bond, the lower one first; for a point on a particle, its number twice. */
  int64_t particles[2];
  double damage;
  /** Elongation of the bond [length]; NaN for a point on a particle. */
  double opening;
  /** Midpoint of the bond inside the body, or position of the particle [length]. */
  double position[3];
} SoftenedPoint;

/** Damaged points of a body at its committed state. */
typedef struct SoftenedPoints {
  int64_t total, softened, spent;       /* number of points that may be damaged, are damaged, carry nothing */
  int listed;                           /* number of entries of `worst` */
  SoftenedPoint worst[SOFTENED_LISTED]; /* by damage, then by opening, the largest first */
} SoftenedPoints;

/** Returns the plural noun of the points that may be damaged: "bonds", "links" or "material points"; NULL if there are
 *  none. */
const char *domain_softening_noun(const Domain *domain);

/** Returns true if a point is damaged, by the points that domain_find_softened counts. */
bool domain_has_softened(const Domain *domain);

/** Counts the damaged points and lists the most damaged ones. Broken bonds, image particles outside of supports and
 *  bonds between two images do not count. */
void domain_find_softened(const Domain *domain, SoftenedPoints *found);

#endif
