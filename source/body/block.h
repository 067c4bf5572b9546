/* A block of the deck: a part of the body with its own material and lattice, and where that lattice stands. */
#ifndef BRECCIA_BODY_BLOCK_H
#define BRECCIA_BODY_BLOCK_H

#include "body/lattice.h"
#include "body/margin.h"

typedef struct BlockSpec {
  SectionHead head;
  const char *material;
  int lattice; /* index of its type (lattice_at) */
  double spacing, thickness, area;
  Shape *shape; /* NULL: particles come from a file */
  const char *file;
} BlockSpec;

extern const Section block_section;

/** Lays the lattice of block b: origin, cells with those of its margins, rows, and the volume of a particle. Of a block whose particles
 *  come from a file: the measures of its lattice only.
 *  @return BRECCIA_OK, or BRECCIA_USER_ERROR after saying why it does not fit the block's shape */
int block_place_lattice(const BlockSpec *block, int b, const MarginList *margins, const DeckReader *reader,
                        Lattice *lattice);

#endif
