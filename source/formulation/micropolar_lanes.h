/* What sweeps over links of lattices in the plane and in space share, vectors of links at a time. */
#ifndef BRECCIA_FORMULATION_MICROPOLAR_LANES_H
#define BRECCIA_FORMULATION_MICROPOLAR_LANES_H

#include "formulation/micropolar.h"

/* Largest |sine| of an end rotation for which the series are good to double precision, as the cosine's distance from 1: 1 - (1 - 2^-10)^1/2. */
static const double largest_cosine_loss = 0x1.001002005p-11;

/** Angle over sine, less 1, of the square of the sine: of the series of the arc sine. */
LANES_INLINE Lanes angle_excess(Lanes square)
{
  Lanes sum = lanes_set(63.0 / 2816) * square + lanes_set(35.0 / 1152);
  sum = sum * square + lanes_set(5.0 / 112);
  sum = sum * square + lanes_set(3.0 / 40);
  sum = sum * square + lanes_set(1.0 / 6);
  return square * sum;
}

/** What is left of a link's axial stiffness, and of the others. */
LANES_INLINE void find_left(const Micropolar *m, int64_t slot, int half, const breccia_link *law, Lanes stretch,
                            Lanes *axial, Lanes *other)
{
  const int64_t at = slot * SLICE + LANES * half;
  const Lanes tension = lanes_load(m->damage->tension[1] + at),
              rest = lanes_set(1) - lanes_load(m->damage->compression[1] + at);
  const Lanes closed = lanes_choose((LaneMask)(stretch < lanes_set(0)), lanes_set(1 - law->recovery), lanes_set(1));
  *axial = (lanes_set(1) - tension * closed) * rest;
  *other = (lanes_set(1) - tension) * rest;
}

/** Stretch at which links between places and those from others on carry nothing. */
LANES_INLINE Lanes free_of(const Micropolar *m, int64_t here, int64_t there)
{
  const double *free = m->particles->free_strain;
  return free ? lanes_set(0.5) * (lanes_load(free + here) + lanes_load(free + there)) : lanes_set(0);
}

/** The law by which links of a slice are weakened now; NULL: none is. */
LANES_INLINE const breccia_link *weakened_by(const Micropolar *m, int64_t slice)
{
  return micropolar_is_weak(m, slice) ? &m->damage->laws[m->particles->block[slice]] : NULL;
}

/** Whether the series of intact links of half a slot hold too: of their lengths, by d, and of both end rotations, by their cosines. */
LANES_INLINE LanesWithin links_within(LanesWithin so_far, unsigned bits, int half, Lanes d, Lanes cosine, Lanes other)
{
  const Lanes limit = lanes_set(largest_cosine_loss), one = lanes_set(1);
  so_far = lanes_within_where(so_far, bits, half, d, lanes_set(range_limit[RANGE_SERIES]));
  so_far = lanes_within_where(so_far, bits, half, one - cosine, limit);
  return lanes_within_where(so_far, bits, half, one - other, limit);
}

#endif
