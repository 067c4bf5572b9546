/* Copies of the strains and stresses that points keep. Evaluations of forces overwrite these; callers that evaluate
 * forces at other displacements than those of a step copy them before and restore them afterwards. */
#ifndef BRECCIA_DOMAIN_TENSOR_COPY_H
#define BRECCIA_DOMAIN_TENSOR_COPY_H

#include "domain/domain.h"

/** Strains and stresses of the points of one region. */
typedef struct TensorRows {
  int64_t count; /* points; 0: the region keeps no tensors, or shares those of a region before it */
  double *strain[6], *stress[6];
} TensorRows;

typedef struct TensorCopy {
  TensorRows *regions; /* [region_count] */
  int region_count;
} TensorCopy;

/** Allocates memory for a copy; destroy it in any case.
 *  @param[in] label  purpose, for messages
 *  @return BRECCIA_OK or BRECCIA_FAILURE */
int tensor_copy_create(TensorCopy *copy, const Domain *domain, const char *label, Error *error);
void tensor_copy_destroy(TensorCopy *copy);
/** Returns the bytes of a copy; 0: it was not created. */
size_t tensor_copy_bytes(const TensorCopy *copy);

/** Copies strains and stresses of all points of a domain. */
void tensor_copy_save(const TensorCopy *copy, const Domain *domain);
/** Restores the strains and stresses of the last tensor_copy_save. */
void tensor_copy_restore(const TensorCopy *copy, const Domain *domain);

#endif
