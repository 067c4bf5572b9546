/* What stands around slices: each place that stored bonds join to particles of a slice once, with bits of those to whom it is joined. Eight particles side by
 * side share most of their neighbours. Sums that are linear in what is read of a neighbour go through them instead of through slots: its numbers are read
 * once and spread over all lanes, where a slot has to turn round eight records. On clouds half of the lanes have a bond there, and still such a sum takes two
 * thirds of the time; what needs a root and a quotient for each bond gains nothing. Made only where somebody asks for it.
 * Always true: an intact stored bond has its bit, and no other bond has; within a slice places ascend. */
#ifndef BRECCIA_FAMILY_SURROUNDINGS_H
#define BRECCIA_FAMILY_SURROUNDINGS_H

#include "family/family.h"

typedef struct Surroundings {
  int64_t *first; /* [slices + 1] */
  int32_t *place; /* [first[slices] + SURROUNDINGS_AHEAD]; place 0 behind the last */
  uint8_t *lanes; /* [first[slices]] */
  double
      *scale; /* [first[slices]][8] influence x volume correction, 0 where no bit is; NULL where a family has none: 1 */
} Surroundings;

/* So many places ahead sweeps ask for what they will read. */
enum { SURROUNDINGS_AHEAD = 64 };

int surroundings_create(Surroundings *s, const Family *family, Error *error);
void surroundings_destroy(Surroundings *s);

/** Bonds of a slice have broken or are whole again. */
void surroundings_renew(Surroundings *s, const Family *family, int64_t slice);

/** Bytes for bonds. */
size_t surroundings_bytes(const Surroundings *s, const Family *family);

/** Asks for what is read of a place further on. @param[in] shown  [places][length] */
LANES_INLINE void surroundings_fetch_ahead(const Surroundings *s, int64_t n, const double *shown, int length)
{
  const double *ahead = shown + (int64_t)s->place[n + SURROUNDINGS_AHEAD] * length;
  for (int k = 0; k < length; k += 8) __builtin_prefetch(ahead + k);
}

#endif
