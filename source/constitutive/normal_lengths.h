/* Length over which a point spreads its fracture energy, by the normal of its crack. A plane crack with the normal n
 * strains the points that stand on both of its sides, over a length l(n) that depends on the lattice (after Oliver 1989,
 * Int. J. Numer. Methods Eng. 28, 461, who finds it for elements). Laws take l of the first principal strain when their
 * damage begins, and keep it in their history: 0 before. */
#ifndef BRECCIA_CONSTITUTIVE_NORMAL_LENGTHS_H
#define BRECCIA_CONSTITUTIVE_NORMAL_LENGTHS_H

#include "base/lanes.h"
#include "constitutive/solid/spectral.h"

#include <math.h>
#include <stdbool.h>

typedef struct NormalLengths {
  /** Returns l(n), or a number that is not above 0 where the lattice has none for n. NULL: one length for all normals.
   *  @param[in] normal  unit vector */
  double (*across)(const void *context, const double normal[3]);
  const void *context;
} NormalLengths;

struct Material;

/** Gives lengths by normals to the law of a material.
 *  @param[in] lengths  NULL: nothing is given
 *  @return true if the law takes lengths */
bool normal_lengths_give(const struct Material *material, const NormalLengths *lengths);

/** Returns the lengths of points [length]: as committed; of points whose damage begins, l of their first principal
 *  strain; 0 of all others, and where the first two principal strains are alike.
 *  @param[in] begins  points that are strained beyond what damages */
LANES_INLINE Lanes normal_lengths_choose(const NormalLengths *lengths, const SpectrumApart *apart, LaneMask begins,
                                         Lanes committed)
{
  const double alike = 1e-6; /* relative difference of principal strains below which directions are round-off */
  const LaneMask wanted = begins & (committed <= lanes_set(0));
  if (!lengths->across || !lanes_any(wanted)) return committed;
  const Spectrum s = spectrum_with_vectors(apart);
  double chosen[LANES], value[2][LANES], normal[3][LANES];
  lanes_store(chosen, committed);
  for (int k = 0; k < 2; ++k) lanes_store(value[k], s.value[k]);
  for (int k = 0; k < 3; ++k) lanes_store(normal[k], s.vector[0][k]);
  for (int l = 0; l < LANES; ++l) {
    if (!wanted[l] || !(value[0][l] - value[1][l] > alike * value[0][l])) continue;
    const double found = lengths->across(lengths->context, (double[3]){normal[0][l], normal[1][l], normal[2][l]});
    chosen[l] = found > 0 ? found : 0;
  }
  return lanes_load(chosen);
}

#endif
