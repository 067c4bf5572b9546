/* Elongation of bonds by the pressure across them, for laws whose damage depends on the strain beyond this elongation.
 * The strain of a bond is the mean over the families of both ends: the Green-Lagrange strain of their deformation
 * gradients less the free strain. An elastic solid of bonds has at this strain the stress
 *   sigma / E = s (strain + tr(strain) / 2 I),   s = 3/4 in plane stress (nu = 1/3), 4/5 else (nu = 1/4).
 * The elongation by Poisson's effect is -nu times the sum of the two stresses across the bond over E, if that sum is
 * negative. */
#include "base/memory.h"
#include "base/tensor.h"
#include "formulation/bond_based.h"
#include "formulation/shape_tensor.h"

#include <string.h>

/** Numbers stored for a place: inverse of its shape tensor, and strain of its family. */
enum { LATERAL_INVERSE = 0, LATERAL_STRAIN = 6, LATERAL_NUMBERS = 12 };

void bond_lateral_renew(const BondBased *b, int64_t slice)
{
  if (!b->around) return;
  for (int lane = 0; lane < SLICE; ++lane) {
    const int64_t place = slice * SLICE + lane;
    if (b->particles->number[place] < 0) continue;
    const ShapeTensor shape = shape_tensor(b->family, (int32_t)place, b->body->dimensions, 0);
    double *row = b->around + LATERAL_NUMBERS * place;
    /* Families without a regular shape tensor have no strain, and so no pressure across their bonds. */
    if (shape.mode == SHAPE_REGULAR)
      memcpy(row + LATERAL_INVERSE, shape.inverse, sizeof shape.inverse);
    else
      memset(row + LATERAL_INVERSE, 0, sizeof shape.inverse);
  }
}

int bond_lateral_create(BondBased *b, Error *error)
{
  if (!b->points->takes_lateral) return BRECCIA_OK;
  b->around =
      memory_zeroed((size_t)(LATERAL_NUMBERS * b->particles->places), sizeof(double), "strains around bonds", error);
  if (!b->around) return BRECCIA_FAILURE;
  for (int64_t slice = 0; slice < b->particles->slices; ++slice) bond_lateral_renew(b, slice);
  return BRECCIA_OK;
}

size_t bond_lateral_bytes(const BondBased *b)
{
  return b->around ? LATERAL_NUMBERS * sizeof(double) * (size_t)b->particles->places : 0;
}

int64_t bond_lateral_strains(void *formulation, const Sweep *sweep)
{
  const BondBased *b = formulation;
  const Particles *p = b->particles;
  if (!b->around || sweep->linearised_at) return -1;
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; ++place) {
    if (p->number[place] < 0) continue;
    double f[9], *row = b->around + LATERAL_NUMBERS * place, *strain = row + LATERAL_STRAIN;
    shape_gradient(b->family, sweep->displacement, (int32_t)place, row + LATERAL_INVERSE, f);
    const double freely = p->free_strain ? p->free_strain[place] : 0;
    for (int k = 0; k < 6; ++k) {
      const int i = symmetric_row[k], j = symmetric_column[k];
      double product = 0;
      for (int c = 0; c < 3; ++c) product += f[3 * c + i] * f[3 * c + j];
      strain[k] = (product - (i == j)) / 2 - (i == j && i < b->body->dimensions ? freely : 0);
    }
  }
  return -1;
}

const double *bond_family_strain(const BondBased *b, int64_t place)
{
  return b->around + LATERAL_NUMBERS * place + LATERAL_STRAIN;
}

double bond_elongation_of_pressure(Space space, const double strain[6], const double n[3])
{
  const double poisson = space == SPACE_PLANE_STRESS ? 1.0 / 3 : 1.0 / 4,
               stiffness = space == SPACE_PLANE_STRESS ? 3.0 / 4 : 4.0 / 5,
               trace = strain[XX] + strain[YY] + (space == SPACE_3D ? strain[ZZ] : 0);
  double along = trace / 2, sum = trace * (space == SPACE_3D ? 2.5 : 2);
  for (int k = 0; k < 6; ++k) along += strain[k] * n[symmetric_row[k]] * n[symmetric_column[k]] * (k < 3 ? 1 : 2);
  if (space == SPACE_PLANE_STRAIN) sum += sum / 4; /* stress across the plane */
  const double across = stiffness * (sum - along);
  return across < 0 ? -poisson * across : 0;
}

double bond_lateral(const BondBased *b, int64_t place, const Bond *bond)
{
  if (!b->around) return 0;
  const double *here = b->around + LATERAL_NUMBERS * place + LATERAL_STRAIN,
               *there = b->around + LATERAL_NUMBERS * bond->neighbour + LATERAL_STRAIN;
  double strain[6], n[3];
  for (int k = 0; k < 6; ++k) strain[k] = (here[k] + there[k]) / 2;
  for (int k = 0; k < 3; ++k) n[k] = bond->xi[k] / bond->length;
  return bond_elongation_of_pressure(b->space, strain, n);
}

void bond_lateral_rows(const BondBased *b, const Sweep *sweep)
{
  const Family *f = b->family;
  for (int i = 0; b->around && i < sweep->rows; ++i) {
    int64_t slot;
    int lane;
    bond_list_bond(b->bonds, f, sweep->first, sweep->row + i, &slot, &lane);
    const Bond bond = family_bond(f, sweep->first, slot, lane);
    const bool intact = f->intact[slot] >> lane & 1;
    sweep->strain[1][i] = intact ? bond_lateral(b, sweep->first * SLICE + lane, &bond) : 0;
  }
}
