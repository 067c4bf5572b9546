/* The tangent stiffness as a sparse matrix, assembled point by point from the operators of formulations and springs (formulation/operator.h).
 *
 * Rows and columns are unknowns by number. A displacement that is not free stands in no row, or is shared out to the unknowns that it follows. */
#ifndef BRECCIA_SOLVER_MATRIX_H
#define BRECCIA_SOLVER_MATRIX_H

#include "solver/follow.h"

typedef struct Matrix {
  int64_t size;   /* rows, columns */
  int64_t *first; /* [size + 1] of the entries of a row; columns ascend */
  int64_t *column;
  double *value;
  int64_t places;
  int motions;
  Follow *follow;  /* [places][motions] */
  int32_t *leader; /* [places] follow_leaders */
} Matrix;

/** Why there is no matrix, or NULL. */
const char *matrix_refusal(const Unknowns *unknowns);

/** Numbers the unknowns and finds which entries there are. Destroy it in any case. */
int matrix_create(Matrix *matrix, const Unknowns *unknowns, Error *error);
void matrix_destroy(Matrix *matrix);

/** Fills in the stiffness at the state at which the domain was linearised, and a factor times the masses. Bonds may have broken since the
 *  matrix was created. @param[in] stiffness_share  the stiffness counts 1 + this */
int matrix_fill(Matrix *matrix, const Unknowns *unknowns, double stiffness_share, double mass_factor, Error *error);

/** Largest difference of entries across the diagonal, over the largest entry. */
double matrix_asymmetry(const Matrix *matrix);

/** Between vectors of unknowns and columns of numbers. */
void matrix_pack(const Matrix *matrix, const Unknowns *unknowns, const Vector *v, double *x);
void matrix_unpack(const Matrix *matrix, const Unknowns *unknowns, const double *x, const Vector *v);

#endif
