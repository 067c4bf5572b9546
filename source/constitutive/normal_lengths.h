/* Characteristic length of a point with a fracture energy, as a function of the crack normal. A plane crack with the
 * normal n strains the points with members on both sides of the crack, over a length l(n) that depends on the lattice
 * (after Oliver 1989, Int. J. Numer. Methods Eng. 28, 461, who derives this length for finite elements). When damage
 * begins, a law evaluates l for the first principal strain and stores l in its trial history. Stresses follow the
 * committed l, or the length of the law while the committed l is 0. Stresses do not depend on the trial l, so that
 * tangents are consistent. A solver that has found equilibrium commits l (normal_lengths_take) and continues until
 * equilibrium holds with l. */
#ifndef BRECCIA_CONSTITUTIVE_NORMAL_LENGTHS_H
#define BRECCIA_CONSTITUTIVE_NORMAL_LENGTHS_H

#include "base/lanes.h"
#include "constitutive/solid/spectral.h"

#include <math.h>
#include <stdbool.h>

typedef struct NormalLengths {
  /** Returns l(n); 0 or less if the lattice has no length for n. NULL: one length for all normals.
   *  @param[in] normal  unit vector */
  double (*across)(const void *context, const double normal[3]);
  const void *context;
} NormalLengths;

struct Material;

/** Sets the lengths by crack normal in the law of a material.
 *  @param[in] lengths  NULL: only query whether the law accepts lengths
 *  @return true if the law accepts lengths */
bool normal_lengths_give(const struct Material *material, const NormalLengths *lengths);

/** Returns the length over which points of a material can spread its fracture energy at the most [length]; INFINITY:
 *  the law has no such bound. */
double normal_lengths_longest(const struct Material *material);

/** Commits the trial length of a point that has no committed length; all other history values stay as committed. The
 *  law of the material must accept lengths.
 *  @param[in] trial          history of the point, [history_values]
 *  @param[in,out] committed  history of the point, [history_values]
 *  @return true if a length was committed */
bool normal_lengths_take(const struct Material *material, const double *trial, double *committed);

/** Clears the committed length of a point whose committed history has no damage. The law of the material must accept
 *  lengths.
 *  @param[in,out] committed  history of the point, [history_values] */
void normal_lengths_drop(const struct Material *material, double *committed);

/** Returns the trial lengths of points [length]. Points that are neither damaged nor strained beyond their threshold
 *  have 0. All others keep their committed length. Without a committed length they take l of their first principal
 *  strain, or 0 where the first two principal strains are equal.
 *  @param[in] begins     points strained beyond their damage threshold
 *  @param[in] damaged    points with damage in their committed history
 *  @param[in] committed  committed lengths of the last step, or of this step (normal_lengths_take) [length]; 0: none */
LANES_INLINE Lanes normal_lengths_choose(const NormalLengths *lengths, const SpectrumApart *apart, LaneMask begins,
                                         LaneMask damaged, Lanes committed)
{
  const double alike = 1e-6; /* relative difference of principal strains below which directions are round-off */
  const LaneMask wanted = begins & (committed <= lanes_set(0));
  if (!lengths->across) return committed;
  committed = lanes_where(begins | damaged, committed);
  if (!lanes_any(wanted)) return committed;
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
