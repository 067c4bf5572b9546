/* Shape tensors K = sum w xi (x) xi and what to do when they cannot be inverted (docs/theory.md 4). */
#ifndef BRECCIA_FORMULATION_SHAPE_TENSOR_H
#define BRECCIA_FORMULATION_SHAPE_TENSOR_H

#include "family/family.h"

typedef enum ShapeMode {
  SHAPE_REGULAR, /* K was inverted, but for directions in which the family is flat: no strain there */
  SHAPE_AXIAL,   /* too few bonds for a strain: they act as springs */
  SHAPE_FREE,    /* no bonds */
} ShapeMode;

typedef struct ShapeTensor {
  double inverse[6];      /* of K, or of its part that can be inverted, or 0 */
  double first_moment[3]; /* sum of w xi */
  double weight_sum;      /* sum of w */
  double mean_influence;  /* sum of w / sum of volumes */
  double demand;    /* largest eigenvalue of its strain's stiffness over mass at modulus 1, from above (find_demand) */
  double alone;     /* the part of it that comes from its neighbours */
  double roundness; /* det K / (tr K / d)^d: 1 for a full family, 0 for a flat one */
  int bonds;
  ShapeMode mode;
} ShapeTensor;

/** Shape tensor of a place from its intact bonds.
 *  @param[in] dimensions         of the body
 *  @param[in] initial_roundness  what it was with all bonds; 0 while it is first asked for */
ShapeTensor shape_tensor(const Family *family, int32_t place, int dimensions, double initial_roundness);

/** Deformation gradient F = I + (sum w eta (x) xi) K^-1 at a place, row by row. */
void shape_gradient(const Family *family, double *const *displacement, int32_t place, const double inverse[6],
                    double f[9]);

#endif
