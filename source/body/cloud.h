/* Particles that stand anywhere: their positions and volumes come from a file. */
#ifndef BRECCIA_BODY_CLOUD_H
#define BRECCIA_BODY_CLOUD_H

#include "base/csv.h"
#include "body/particles.h"
#include "deck/section.h"

typedef struct Cloud {
  int64_t count;
  double *position[3]; /* [count] in the file's order; those beyond the body's dimensions are NULL */
  double *volume;
  CsvWords groups; /* [count] names; no cells if the file tells none */
  int32_t *order;  /* [count] along a curve that fills space, so that neighbours come near each other */
} Cloud;

/** A kind of files of particles. */
typedef struct BodyReader {
  const char *ending; /* of their names, with the point */
  const char *about;
  /** Reads positions, as many coordinates as the body has dimensions, volumes and, where the file tells them, groups.
   *  @param[in]  path    of the file
   *  @param[in]  units   of the deck, in which the numbers are given
   *  @param[out] cloud   zeros before; destroyed by the caller in any case
   *  @param[out] reason  what is wrong, in words that follow the file's place in the deck
   *  @return status */
  int (*read)(Cloud *cloud, const char *path, int dimensions, const Units *units, Error *reason);
} BodyReader;

/** @return the k-th kind, or NULL after the last */
const BodyReader *body_reader_at(int k);

/** Reads a file of particles of the kind that its ending says; its place is relative to the deck.
 *  @param[in] node  where the deck names the file */
int cloud_read(Cloud *cloud, const DeckReader *reader, const Node *node, const char *file, int dimensions);
void cloud_destroy(Cloud *cloud);

/** Leaves out the particles whose entry in `gone` [count] is set. */
void cloud_thin(Cloud *cloud, const uint8_t *gone);

/** Finds the order; the particles are complete. */
int cloud_sort(Cloud *cloud, Error *error);

/** Slices that the particles need. */
int64_t cloud_slices(const Cloud *cloud);

/** Puts the sorted particles into slices from `slice` on and numbers them from *number on in the file's order. */
void cloud_fill(const Cloud *cloud, Particles *particles, int64_t slice, int block, int32_t *number);

#endif
