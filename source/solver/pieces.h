/* The pieces of which a body consists, and what holds each of them against moving as a whole.
 *
 * A piece is what intact bonds join, or bars, contact where it touches, ties, supports that mirror it, and springs between two parts. Where one of
 * these leaves a piece free to turn or slide all the same, this is not seen: they count as joints that nothing moves. */
#ifndef BRECCIA_SOLVER_PIECES_H
#define BRECCIA_SOLVER_PIECES_H

#include "solver/unknowns.h"

/** A piece that nothing holds. */
typedef struct LoosePiece {
  int64_t pieces;    /* that are loose; 0: none, and nothing else counts */
  int64_t particles; /* of the largest of them, and of two as large of the first, without images outside supports */
  bool whole;        /* it is all of the body */
  int32_t place;     /* of its particle of the lowest number */
  char motion[16];   /* the first motion as a whole that nothing holds: words like "along y" */
} LoosePiece;

/** How bodies are taken apart. */
typedef enum PiecesTaken {
  PIECES_ALL, /* every piece */
  PIECES_WORKED, /* those on which a load or a prescribed motion acts: where nothing acts on a piece it stays at rest where it is */
  PIECES_TOGETHER /* the body counts as one: of stages to come, before which parts may meet */
} PiecesTaken;

/** Finds what nothing holds in the stage under way, with the bonds that are intact, where particles are now. Particles that nothing joins to others
 *  are no pieces where no load acts on them, or anything holds them: solvers leave them where they are.
 *  @return BRECCIA_FAILURE: no memory */
int pieces_find_loose(const Unknowns *unknowns, PiecesTaken taken, LoosePiece *loose, Error *error);

/** Says which piece is loose: "nothing holds the body against moving along y as a whole", or the same of a piece of so many particles, and where.
 *  @return `words` */
const char *pieces_describe(const LoosePiece *loose, const Particles *particles, char *words, size_t size);

#endif
