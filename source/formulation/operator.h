/* One material point and the places that it joins: how their displacements make its strain, and how its stress makes forces on them.
 *
 * With six components, G = sum u_l (x) g_l, the strain is E = (G + G^T + G^T G) / 2 (or its linear part), so that
 *   delta E = sym F^T sum delta u_l (x) g_l,   F = I + G,
 * and the force on place l is -V F S g_l. With one component (bonds, states of a family) delta E = sum delta u_l . g_l with vectors g_l that turn
 * with the deformation: delta g_l = turn_l (I - n n)(delta u_l - delta u_0), n = g_l / |g_l|; the force is -V S g_l. With two components the second one has
 * vectors of its own and a stress of 0, but a part in the tangent (families that flow). The g_l add up to nothing. Where the stress acts by other vectors
 * than those of the strain (`acts_apart`), the force on place l is -V F S a_l, and the stiffness is not symmetric. Beside the point may stand springs between the first place and the others, and what they lack of a uniform
 * deformation: the control of zero-energy modes has the energy V/2 (sum w_l C : eta_l (x) eta_l - C : G K G^T).
 * A link between two places with rotations has no components: its forces and moments, and their derivatives, stand there as they are. */
#ifndef BRECCIA_FORMULATION_OPERATOR_H
#define BRECCIA_FORMULATION_OPERATOR_H

#include "body/particles.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct OperatorPlace {
  int32_t place;
  double g[3], second[3], turn; /* second: of the second of two components */
  double act[3];                /* by which the stress of six components acts, where that is not g */
  double pull[3];               /* force on the first place from a spring to this one */
  double spring[6]; /* its stiffness: change of the pull with this place's displacement less the first one's */
} OperatorPlace;

typedef struct Operator {
  int components; /* 6, 2, 1, or 0: there is no point, but maybe springs */
  bool finite;    /* strain of finite deformation */
  bool acts_apart;
  int count, capacity;
  OperatorPlace *places;         /* [count], owned; the first is the one to which the point belongs */
  double volume;                 /* for which the point stands */
  double stress[6], tangent[36]; /* tangent: [components][components] */
  double hold[6], shape[6];      /* C and K of the control; C = 0: none */
  int motions;                   /* rows of motion of its places: 3, or all of a link with rotations */
  /** Of a link, first of the one place, then of the other: forces and moments, and how they change with displacements and rotations. */
  double force[2 * MAX_ROWS], stiffness[4 * MAX_ROWS * MAX_ROWS];
} Operator;

/** Empties an operator for another point; its memory is kept. */
void operator_clear(Operator *point);
void operator_destroy(Operator *point);
/** @return the new place, all 0, or NULL: no memory */
OperatorPlace *operator_add(Operator *point, int64_t place, Error *error);
/** Makes the g of the first place such that all add up to nothing. */
void operator_close(Operator *point);

/** G = sum u_l (x) g_l at displacements u, row by row. */
void operator_gradient(const Operator *point, double *const u[3], double g[9]);
/** Change of the strain with changes v of the displacements, at displacements u. Of six components in engineering shear strains. */
void operator_strain(const Operator *point, double *const u[3], double *const v[3], double strain[6]);
/** Adds the forces of the point and its springs on all its places to arrays over places. */
void operator_add_forces(const Operator *point, double *const u[3], double *const force[3]);
/** Change of the force on place a with the displacement of place b (both 0 .. count - 1), row by row: motions x motions numbers of minus the
 *  tangent stiffness, from the tangent of the law, its stress and the springs. */
void operator_stiffness(const Operator *point, double *const u[3], int a, int b, double *k);

/** The same of all its places at once, which is quicker. @param[out] k  [count][count][motions x motions] */
int operator_matrix(const Operator *point, double *const u[3], double *k, Error *error);

#endif
