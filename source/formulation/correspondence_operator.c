/* Points of correspondence one by one, and what a linearised step keeps. */
#include "base/team.h"
#include "formulation/correspondence.h"

#include <stdlib.h>
#include <string.h>

int64_t correspondence_point_count(const void *formulation)
{
  const Correspondence *c = formulation;
  return c->particles->places;
}

/** Springs of a particle that has no strain. */
static int add_axial(const Correspondence *c, double *const *u, int64_t place, const Bond *bond, Operator *point,
                     Error *error)
{
  OperatorPlace *p = operator_add(point, bond->neighbour, error);
  if (!p) return BRECCIA_FAILURE;
  const double volumes = c->particles->volume[place] * c->particles->volume[bond->neighbour];
  correspondence_axial_spring(c, u, place, bond, p->pull, p->spring);
  for (int k = 0; k < 3; ++k) p->pull[k] *= volumes;
  for (int k = 0; k < 6; ++k) p->spring[k] *= volumes;
  return BRECCIA_OK;
}

/** A neighbour of a particle with a strain: g = w K^-1 xi, and the spring C of the control. */
static int add_neighbour(const Correspondence *c, double *const *u, int64_t place, const Bond *bond, Operator *point,
                         Error *error)
{
  OperatorPlace *p = operator_add(point, bond->neighbour, error);
  if (!p) return BRECCIA_FAILURE;
  const SliceShape *shape = shape_of_slice(&c->shapes, place / SLICE);
  const double volume = c->particles->volume[place];
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) {
      const double eta = u[j][bond->neighbour] - u[j][place];
      p->g[k] += bond->weight * shape->inverse[symmetric_place[3 * k + j]][place % SLICE] * bond->xi[j];
      p->pull[k] += volume * bond->weight * point->hold[symmetric_place[3 * k + j]] * eta;
    }
  for (int k = 0; k < 6; ++k) {
    p->spring[k] = volume * bond->weight * point->hold[k];
    point->shape[k] += bond->weight * bond->xi[symmetric_row[k]] * bond->xi[symmetric_column[k]];
  }
  return BRECCIA_OK;
}

int correspondence_point(const void *formulation, double *const *u, int64_t place, Operator *point, Error *error)
{
  const Correspondence *c = formulation;
  const Family *f = c->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  const double share = shape_of_slice(&c->shapes, slice)->share[lane];
  operator_clear(point);
  if (c->particles->number[place] < 0 || is_foreign(c->foreign, place) || c->shapes.mode[place] == SHAPE_FREE)
    return BRECCIA_OK;
  if (!operator_add(point, place, error)) return BRECCIA_FAILURE;
  const bool axial = c->shapes.mode[place] == SHAPE_AXIAL;
  point->components = axial ? 0 : 6;
  point->finite = c->finite;
  point->volume = c->particles->volume[place];
  for (int k = 0; k < 6; ++k) {
    point->stress[k] = share * c->points->stress[k][place];
    point->hold[k] = axial ? 0 : hold_component(c, place, k);
  }
  points_tangent(c->points, place, point->tangent);
  for (int k = 0; k < 36; ++k) point->tangent[k] *= share;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    if ((axial ? add_axial : add_neighbour)(c, u, place, &bond, point, error)) return BRECCIA_FAILURE;
  }
  operator_close(point);
  return BRECCIA_OK;
}

/** Families at the displacements at which they are linearised. */
typedef struct FamiliesAt {
  const Correspondence *families;
  double *const *displacement;
} FamiliesAt;

static void keep_gradients(void *context, int64_t slice)
{
  const FamiliesAt *at = context;
  const Correspondence *c = at->families;
  for (int lane = 0; lane < SLICE; ++lane) {
    double f[9];
    correspondence_gradient_at(c, at->displacement, slice * SLICE + lane, f);
    for (int k = 0; k < 9; ++k) c->gradients[slice * (9 * SLICE) + k * SLICE + lane] = f[k] - (k % 4 == 0);
  }
}

int correspondence_linearise(void *formulation, double *const *displacement, Error *error)
{
  Correspondence *c = formulation;
  if (!c->gradients && !(c->gradients = places_array(9 * c->particles->places, "linearised step", error)))
    return BRECCIA_FAILURE;
  FamiliesAt at = {c, displacement};
  if (c->finite) team_each(c->particles->slices, keep_gradients, &at);
  return BRECCIA_OK;
}
