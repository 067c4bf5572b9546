#include "formulation/body_modulus.h"

#include <math.h>

/** Computes the extents of a block between its outermost particles [length].
 *  @return the largest extent */
static double block_extents(const BodyModulus *of, int block, double size[3])
{
  const Particles *p = of->particles;
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    double low = INFINITY, high = -INFINITY;
    for (int64_t place = 0; place < p->places; ++place) {
      if (p->block[place / SLICE] != block || p->number[place] < 0) continue;
      low = fmin(low, p->position[k][place]);
      high = fmax(high, p->position[k][place]);
    }
    size[k] = high - low;
    longest = fmax(longest, size[k]);
  }
  return longest;
}

void body_modulus_describe(const BodyModulus *of, int block, Text *text)
{
  const double most = 0.03, not_short = 0.5;
  double size[3], furthest = 0, least = INFINITY, largest = 0;
  const double longest = block_extents(of, block, size);
  for (int axis = 0; axis < of->body->dimensions; ++axis) {
    const double shown = of->young(of->formulation, block, axis);
    least = fmin(least, shown);
    largest = fmax(largest, shown);
    if (fabs(shown - 1) > fabs(furthest) && size[axis] >= not_short * longest) furthest = shown - 1;
  }
  if (fabs(furthest) < of->tolerance) return;
  text_add(text,
           "%s: stretched evenly, all families of the body together show %.3f to %.3f of the wanted Young's modulus "
           "along its axes",
           of->body->blocks[block]->head.name, least, largest);
  if (fabs(furthest) > most)
    text_add(text,
             "; in tension along its length the body is %.0f %% %s than asked, and %s of particles under given loads "
             "are as much too %s; take more rows of particles across%s",
             100 * fabs(furthest), furthest > 0 ? "stiffer" : "softer", of->wrong, furthest > 0 ? "small" : "large",
             of->remedy);
  text_add(text, "\n");
}
