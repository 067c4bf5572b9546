/* The shape tensors of all families, slice by slice. Slices inside a lattice look alike and share one entry: they would take 80 bytes
 * of every particle through the memory at each step otherwise. */
#ifndef BRECCIA_FORMULATION_SHAPE_TABLE_H
#define BRECCIA_FORMULATION_SHAPE_TABLE_H

#include "formulation/shape_tensor.h"

typedef struct SliceShape { /* what ShapeTensor says, for the eight places of a slice; unused places: 0, share 1 */
  double inverse[6][SLICE], first_moment[3][SLICE], weight_sum[SLICE], mean_influence[SLICE];
  double share[SLICE]; /* of its stress that a family carries: below 1 when it has become poor */
} SliceShape;

typedef struct ShapeTable {
  bool plane;
  SliceShape *entries;
  int64_t count;     /* of entries in use */
  int32_t *entry_of; /* [slices] */
  uint8_t *shared;   /* [entries] 1: several slices have it */
  float *roundness;  /* [places] of the families with all their bonds */
  double *allowed;   /* [places] demand up to which a family carries its whole stress */
  double *kept;      /* [places] share of that which it has kept as bonds broke */
  uint8_t *mode;     /* [places] ShapeMode */
} ShapeTable;

/** @return status; the family must have been built, with all bonds that the body starts with */
int shape_table_create(ShapeTable *table, const Family *family, bool plane, Error *error);
void shape_table_destroy(ShapeTable *table);

/** Finds the shapes of a slice again after bonds have broken. */
void shape_table_renew(ShapeTable *table, const Family *family, int64_t slice);

static inline const SliceShape *shape_of_slice(const ShapeTable *table, int64_t slice)
{
  return &table->entries[table->entry_of[slice]];
}

/** Bytes in use. */
size_t shape_table_bytes(const ShapeTable *table, const Family *family);

#endif
