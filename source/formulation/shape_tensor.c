#include "formulation/shape_tensor.h"

#include "base/tensor.h"

static double roundness(const double k[6], int dimensions)
{
  if (dimensions == 1) return k[XX] > 0;
  if (dimensions == 2) {
    double trace = (k[XX] + k[YY]) / 2;
    return trace > 0 ? (k[XX] * k[YY] - k[XY] * k[XY]) / (trace * trace) : 0;
  }
  double trace = (k[XX] + k[YY] + k[ZZ]) / 3;
  return trace > 0 ? tensor_determinant(k) / (trace * trace * trace) : 0;
}

/** Inverse on the directions whose eigenvalue is at least a thousandth of the largest; 0 on the others. */
static void pseudo_inverse(const double k[6], double inverse[6])
{
  double value[3], vector[9], largest = 0;
  tensor_eigen(k, value, vector);
  for (int e = 0; e < 3; ++e) largest = fmax(largest, value[e]);
  for (int c = 0; c < 6; ++c) inverse[c] = 0;
  for (int e = 0; e < 3; ++e) {
    if (value[e] < 1e-3 * largest) continue;
    for (int c = 0; c < 6; ++c)
      inverse[c] += vector[3 * symmetric_row[c] + e] * vector[3 * symmetric_column[c] + e] / value[e];
  }
}

/** The strain of a family is sum g_l u_l over its neighbours and itself, with g_l = w_l K^-1 xi_l and g_i = -sum g_l. Its energy adds a
 *  matrix to the body's stiffness over mass whose largest eigenvalue is at most V_i tr(sum g_l (x) g_l / m_l) times the modulus
 *  (docs/theory.md 4).
 *  @param[in] spread  sum of w^2 xi (x) xi / m over the neighbours */
static void find_demand(const Particles *p, int32_t place, const double spread[6], ShapeTensor *shape)
{
  const double *inverse = shape->inverse;
  double squares = 0, trace = 0;
  for (int i = 0; i < 3; ++i) {
    double moment = 0;
    for (int j = 0; j < 3; ++j) moment += inverse[symmetric_place[3 * i + j]] * shape->first_moment[j];
    squares += moment * moment;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        trace += inverse[symmetric_place[3 * i + j]] * spread[symmetric_place[3 * j + k]] *
                 inverse[symmetric_place[3 * k + i]];
  shape->alone = p->volume[place] * trace;
  shape->demand = shape->alone + squares / p->density[place];
}

ShapeTensor shape_tensor(const Family *family, int32_t place, int dimensions, double initial_roundness)
{
  ShapeTensor shape = {.mode = SHAPE_REGULAR};
  int64_t slice = place / SLICE;
  int lane = place % SLICE;
  double k[6] = {0}, spread[6] = {0}, volumes = 0;
  for (int64_t slot = family->first[slice]; slot < family->first[slice + 1]; ++slot) {
    if (!(family->intact[slot] >> lane & 1)) continue;
    Bond bond = family_bond(family, slice, slot, lane);
    for (int c = 0; c < 6; ++c) k[c] += bond.weight * bond.xi[symmetric_row[c]] * bond.xi[symmetric_column[c]];
    double mass = family->particles->density[bond.neighbour] * family->particles->volume[bond.neighbour];
    double square = bond.weight * bond.weight / mass;
    for (int c = 0; c < 6; ++c) spread[c] += square * bond.xi[symmetric_row[c]] * bond.xi[symmetric_column[c]];
    for (int i = 0; i < 3; ++i) shape.first_moment[i] += bond.weight * bond.xi[i];
    shape.weight_sum += bond.weight;
    volumes += family->particles->volume[bond.neighbour];
    ++shape.bonds;
  }
  shape.mean_influence = volumes > 0 ? shape.weight_sum / volumes : 0;
  shape.roundness = roundness(k, dimensions);
  if (!shape.bonds) {
    shape.mode = SHAPE_FREE;
  } else if (shape.bonds < dimensions + 1) {
    shape.mode = SHAPE_AXIAL;
  } else if (shape.roundness > 1e-4 * initial_roundness && shape.roundness > 1e-12) {
    if (dimensions == 1) {
      shape.inverse[XX] = 1 / k[XX];
    } else if (dimensions == 2) {
      double determinant = k[XX] * k[YY] - k[XY] * k[XY];
      shape.inverse[XX] = k[YY] / determinant;
      shape.inverse[YY] = k[XX] / determinant;
      shape.inverse[XY] = -k[XY] / determinant;
    } else
      tensor_inverse(k, shape.inverse);
  } else
    pseudo_inverse(k, shape.inverse);
  find_demand(family->particles, place, spread, &shape);
  return shape;
}

void shape_gradient(const Family *family, double *const *displacement, int32_t place, const double inverse[6],
                    double f[9])
{
  int64_t slice = place / SLICE;
  int lane = place % SLICE;
  double moved[9] = {0};
  for (int64_t slot = family->first[slice]; slot < family->first[slice + 1]; ++slot) {
    if (!(family->intact[slot] >> lane & 1)) continue;
    Bond bond = family_bond(family, slice, slot, lane);
    for (int k = 0; k < 9; ++k) {
      const double *u = displacement[k / 3];
      moved[k] += bond.weight * (u[bond.neighbour] - u[place]) * bond.xi[k % 3];
    }
  }
  for (int k = 0; k < 9; ++k) {
    f[k] = k % 4 == 0;
    for (int j = 0; j < 3; ++j) f[k] += moved[k / 3 * 3 + j] * inverse[symmetric_place[3 * j + k % 3]];
  }
}
