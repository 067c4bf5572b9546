/* The deck's geometry turned into particles: blocks filled with lattices, notches taken out, cuts remembered. */
#ifndef BRECCIA_BODY_BODY_H
#define BRECCIA_BODY_BODY_H

#include "body/block.h"
#include "body/particles.h"

typedef enum Space { SPACE_3D, SPACE_PLANE_STRAIN, SPACE_PLANE_STRESS, SPACE_BAR } Space;

typedef struct CutSpec { /* a surface that no bond crosses */
  SectionHead head;
  NumberList line;    /* in the plane, or through the whole height along z */
  NumberList polygon; /* a flat polygon in space */
} CutSpec;

typedef struct CrackSpec {
  SectionHead head;
  Shape *remove; /* particles inside are taken out */
  bool cut_faces;
  CutSpec *cut;
} CrackSpec;

extern const Section crack_section;

typedef struct Body {
  Particles particles;
  int block_count;
  const BlockSpec **blocks;
  Lattice *lattices; /* one per block */
  int crack_count;
  const CrackSpec **cracks;
  uint8_t *crack_met; /* [cracks] 1: it has taken out particles, or parted some within a horizon of each other */
  double largest_spacing;
  const Lattice *coarsest; /* the one with that spacing */
  double low[3], high[3];  /* outermost particles */
  int dimensions;          /* of all lattices */
  int group_count;         /* groups that files name */
  char **groups;           /* [group_count] their names */
  int32_t *group_of;       /* [particles] by number; -1: in none. NULL if no file names any */
  MarginList margins;      /* owned */
  int32_t *margin_of;      /* [particles] by number: which margin it belongs to, -1: none. NULL if there are none */
  int32_t *image_of;       /* [particles] by number: of a margin the particle whose image it is */
} Body;

/** The particle nearest to a point, those in margins left out. @return its place */
int32_t body_nearest(const Body *body, const double point[3]);

/** Whether the particle of a number stands in a margin. */
static inline bool body_outside(const Body *body, int64_t number)
{
  return body->margin_of && body->margin_of[number] >= 0;
}

/** Returns true if row k of motion can differ from 0: displacements along the axes of the body, and rotations. */
static inline bool body_moves_along(const Body *body, int k)
{
  return k < body->dimensions || k >= body->particles.space.rotation;
}

/** The particle inside of which the particle of a number is an image, or the image of an image; itself, where it stands inside. By numbers. */
static inline int64_t body_original(const Body *body, int64_t number)
{
  while (body_outside(body, number)) number = body->image_of[number];
  return number;
}

/** Replaces the ends of a bond by the particles whose images they are, as long as both are images of one support. The
 *  bond then has the length of before. @param[in,out] ends  numbers of two particles */
static inline void body_fold_bond(const Body *body, int64_t ends[2])
{
  while (body_outside(body, ends[0]) && body->margin_of[ends[0]] == body->margin_of[ends[1]])
    for (int k = 0; k < 2; ++k) ends[k] = body->image_of[ends[k]];
}

/** Thickness of a plane body, cross-section of a bar, else 1. */
static inline double body_section(const Body *body)
{
  return body->dimensions == 3 ? 1 : body->dimensions == 2 ? body->blocks[0]->thickness : body->blocks[0]->area;
}

/** Builds particles from the deck's blocks and cracks (sections read before, borrowed for the body's life). */
int body_create(Body *body, const DeckReader *reader, const SectionList *blocks, const SectionList *cracks,
                const MarginList *margins);
void body_destroy(Body *body);

/** True if the segment between two points crosses one of the body's cuts; alike from both ends. Notes which are crossed in `crack_met`. */
bool body_cuts(const Body *body, const double a[3], const double b[3]);
/** The same of the bond of two places. Images of the body outside it have its cuts, too, as far as these lie inside, and only those. */
bool body_cuts_bond(const Body *body, int32_t a, int32_t b);
/** True if a cut without thickness parts the two points, and no notch, whose faces stand apart.
 *  @param[out] normal  unit normal of the cut, towards b
 *  @param[out] level   of the plane of the cut along it: normal . x of its points */
bool body_closed_cut(const Body *body, const double a[3], const double b[3], double normal[3], double *level);
/** The same of two places, images among them. */
bool body_closed_bond(const Body *body, int32_t a, int32_t b, double normal[3], double *level);

#endif
