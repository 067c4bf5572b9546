/* Layers of particles outside a face of a block, beyond what its shape fills: mirror images of the layers inside, or the layers at the other face once
 * more. Who asked for them moves them so that families at the face find what they would find if the body went on. */
#ifndef BRECCIA_BODY_MARGIN_H
#define BRECCIA_BODY_MARGIN_H

#include <stdbool.h>
#include <stdint.h>

typedef struct Margin {
  const void *owner; /* who asked for it */
  int block, axis;
  bool high; /* beyond the highest particles along the axis; else below the lowest */
  int64_t layers;
  bool repeats; /* those at the other face, which has a margin of this kind too; else mirror images */
} Margin;

typedef struct MarginList {
  Margin *items;
  int count;
} MarginList;

#endif
