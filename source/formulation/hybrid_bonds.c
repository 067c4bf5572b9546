/* Hybrid bonds and their particles one by one: operators, forces between two particles, and what people see of particles. */
#include "formulation/hybrid.h"

#include "base/tensor.h"
#include "formulation/shape_tensor.h"
#include <string.h>

int64_t hybrid_point_count(const void *formulation)
{
  const Hybrid *h = formulation;
  return h->bonds->count;
}

int hybrid_point(const void *formulation, double *const *displacement, int64_t row, Operator *point, Error *error)
{
  const Hybrid *h = formulation;
  HybridView view;
  operator_clear(point);
  hybrid_view(h, row, &view);
  if (view.idle) return BRECCIA_OK;
  for (int n = 0; n < view.count; ++n) {
    const double *g = view.g[n];
    if (n > 1 && g[0] == 0 && g[1] == 0 && g[2] == 0) continue; /* hidden */
    OperatorPlace *place = operator_add(point, view.member[n], error);
    if (!place) return BRECCIA_FAILURE;
    for (int k = 0; k < 3; ++k) {
      place->g[k] = g[k];
      if (n < 2) place->act[k] = (n ? 1 : -1) * view.area[k] / view.volume;
    }
  }
  point->components = 6;
  point->finite = h->finite;
  point->acts_apart = h->pairwise;
  point->volume = view.volume;
  double strain[6];
  hybrid_tensors(h, row, &view, displacement, 0, strain, point->stress);
  points_tangent(h->points, row, point->tangent);
  hybrid_laminate_stress(h, view.laminate, point->stress);
  hybrid_laminate_tangent(h, view.laminate, point->tangent);
  return BRECCIA_OK;
}

/* ---- forces between two particles ---- */

/** Finds the stress of a part in the state at which a step is linearised, and its increment in the step. */
static void find_change(const Hybrid *h, int64_t row, const HybridView *view, const double g0[9], const double g[9],
                        double held[6], double stress[6])
{
  double strain[6], tangent[36];
  if (h->hooke) {
    hybrid_strain(h, g0, strain);
    hybrid_laminate_strain(h, view->laminate, 0, strain);
    hybrid_hooke_stress(&h->hooke[points_material(h->points, row) - h->materials], strain, held);
  }
  hybrid_strain_change(h, g0, g, strain);
  hybrid_laminate_strain(h, view->laminate, 0, strain);
  points_tangent(h->points, row, tangent);
  for (int k = 0; k < 6; ++k) {
    stress[k] = 0;
    for (int j = 0; j < 6; ++j) stress[k] += tangent[6 * k + j] * strain[j];
  }
}

/** F S of a row times its volume, of the state evaluated last; in a linearised step its change. */
static void find_stress(const Hybrid *h, int64_t row, const HybridView *view, double *const *u, double *const *at,
                        double p[9])
{
  double g[9], g0[9], strain[6], stress[6], held[6];
  hybrid_gradient(view, u, g);
  if (!at || !h->hooke) hybrid_tensors(h, row, view, u, 0, strain, stress);
  memcpy(held, stress, sizeof held);
  if (at) {
    hybrid_gradient(view, at, g0);
    find_change(h, row, view, g0, g, held, stress);
  }
  hybrid_laminate_stress(h, view->laminate, stress);
  hybrid_laminate_stress(h, view->laminate, held);
  hybrid_first_stress(h, g, stress, at ? g0 : NULL, held, p);
  for (int k = 0; k < 9; ++k) p[k] *= view->idle ? 0 : view->volume;
}

/** Force of a point on one of its members. */
static void member_force(const Hybrid *h, const HybridView *view, const double p[9], int member, double force[3])
{
  for (int k = 0; k < 3; ++k) {
    force[k] = 0;
    for (int j = 0; j < 3 && !h->pairwise; ++j) force[k] -= p[3 * k + j] * view->g[member][j];
    for (int j = 0; j < 3 && h->pairwise && member < 2 && !view->idle; ++j)
      force[k] += (member ? -1 : 1) * p[3 * k + j] * view->area[j] / view->volume;
  }
}

/** Share of what a member that is no end receives that comes from an end: half, and of bonds to places of other formulations all from the own end. So
 *  shared out, forces come in pairs along the bonds that there are, of which one end at least is an own place. The rest passes between the two ends. */
static double share_of_end(const Hybrid *h, const HybridView *view, int end)
{
  if (is_foreign(h->foreign, view->member[end])) return 0;
  return is_foreign(h->foreign, view->member[!end]) ? 1 : 0.5;
}

/** @param[in,out] force  on a place, from another one, by one point */
static void add_pair(const Hybrid *h, int64_t row, const HybridView *view, double *const *u, double *const *at,
                     const int32_t places[2], double force[3])
{
  const int here = hybrid_member_of(view, places[0]), there = hybrid_member_of(view, places[1]);
  double part[3], p[9];
  if (view->idle || here == view->count || there == view->count) return;
  find_stress(h, row, view, u, at, p);
  const int sole = here >= 2 ? here : there; /* the one that is no end */
  if (sole >= 2) {
    const double share = share_of_end(h, view, here >= 2 ? there : here);
    member_force(h, view, p, sole, part);
    for (int k = 0; k < 3; ++k) force[k] += (here >= 2 ? share : -share) * part[k];
    return;
  }
  const double share = share_of_end(h, view, here);
  member_force(h, view, p, here, part);
  for (int k = 0; k < 3; ++k) force[k] += part[k];
  for (int n = 2; n < view->count && !h->pairwise; ++n) {
    member_force(h, view, p, n, part);
    for (int k = 0; k < 3; ++k) force[k] += share * part[k];
  }
}

void hybrid_half_state(const void *formulation, double *const *u, double *const *at, int64_t slice, int64_t slot,
                       int lane, double state[3])
{
  const Hybrid *h = formulation;
  const int32_t places[2] = {(int32_t)(slice * SLICE + lane), family_bond(h->family, slice, slot, lane).neighbour};
  double force[3] = {0};
  for (int end = 0; end < 2; ++end) {
    HybridRow row;
    HybridView view;
    for (HybridRows rows = hybrid_rows(h, places[end]); hybrid_rows_next(h, &rows, &row);) {
      if (!hybrid_rows_near(h, &rows, places[!end])) continue;
      hybrid_view_at(h, &row, &view);
      if (!end || hybrid_member_of(&view, places[0]) >= 2) add_pair(h, rows.row, &view, u, at, places, force);
    }
  }
  const double share = is_foreign(h->foreign, places[1]) ? 1 : 0.5; /* others give what is theirs */
  const double volumes = h->particles->volume[places[0]] * h->particles->volume[places[1]];
  for (int k = 0; k < 3; ++k) state[k] = share * force[k] / volumes;
}

/* ---- what the body itself has of its points ---- */

double hybrid_share_inside(const Hybrid *h, const HybridView *view)
{
  int ends = 0, inside = 0;
  for (int end = 0; end < 2; ++end) {
    if (is_foreign(h->foreign, view->member[end])) continue;
    ++ends;
    inside += !body_outside(h->body, h->particles->number[view->member[end]]);
  }
  return (double)inside / ends;
}

void hybrid_face_force(const void *formulation, int64_t place, double force[3])
{
  const Hybrid *h = formulation;
  const Family *f = h->family;
  const int inside = !body_outside(h->body, h->particles->number[place]);
  for (int k = 0; k < 3; ++k) force[k] = 0;
  for (int64_t slot = f->first[place / SLICE] - 1; slot < f->first[place / SLICE + 1]; ++slot) {
    const bool own = slot < f->first[place / SLICE]; /* the place's own bonds first, then those of its neighbours */
    if (!own && !(f->intact[slot] >> place % SLICE & 1)) continue;
    const int64_t from = own ? place : family_bond(f, place / SLICE, slot, (int)(place % SLICE)).neighbour;
    HybridRow row;
    HybridView view;
    for (HybridRows rows = hybrid_rows(h, from); hybrid_rows_next(h, &rows, &row);) {
      hybrid_view_at(h, &row, &view);
      const int member = hybrid_member_of(&view, (int32_t)place);
      if (view.idle || member == view.count || (own ? member >= 2 : member < 2 || view.member[0] != from)) continue;
      double p[9], part[3];
      find_stress(h, rows.row, &view, h->particles->displacement.row, NULL, p);
      member_force(h, &view, p, member, part);
      for (int k = 0; k < 3; ++k) force[k] -= (hybrid_share_inside(h, &view) - inside) * part[k];
    }
  }
}

/** Gradient I + G of a bond's point. */
static void bond_gradient(const Hybrid *h, int64_t row, double f[9])
{
  HybridView view;
  hybrid_view(h, row, &view);
  hybrid_gradient(&view, h->particles->displacement.row, f);
  for (int k = 0; k < 3; ++k) f[4 * k] += 1;
}

/** Its rotation but for the square of the stretches, (F + F^-T) / 2; of small strain I and the skew part of G. */
static void bond_turn(const Hybrid *h, const double f[9], double turn[9])
{
  double cofactor[9], determinant = 0;
  for (int k = 0; k < 9; ++k) {
    const int r = k / 3, s = k % 3, a = (r + 1) % 3, b = (r + 2) % 3, c = (s + 1) % 3, e = (s + 2) % 3;
    cofactor[k] = f[3 * a + c] * f[3 * b + e] - f[3 * a + e] * f[3 * b + c];
    if (!r) determinant += f[k] * cofactor[k];
  }
  for (int k = 0; k < 9; ++k) {
    const double skew = (f[k] - f[3 * (k % 3) + k / 3]) / 2 + (k % 4 == 0);
    turn[k] = h->finite && determinant > 0 ? (f[k] + cofactor[k] / determinant) / 2 : skew;
  }
}

void hybrid_elongation(const void *formulation, int64_t slice, int64_t slot, int lane, double change[3])
{
  const Hybrid *h = formulation;
  const Bond bond = family_bond(h->family, slice, slot, lane);
  double *const *u = h->particles->displacement.row, f[9], turn[9];
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
  bond_gradient(h, rows[0], f);
  bond_turn(h, f, turn);
  const double natural = 1 + particles_free_strain(h->particles, slice * SLICE + lane, bond.neighbour);
  for (int k = 0; k < 3; ++k) {
    change[k] = bond.xi[k] + u[k][bond.neighbour] - u[k][slice * SLICE + lane];
    for (int j = 0; j < 3; ++j) change[k] -= natural * turn[3 * k + j] * bond.xi[j];
  }
}

void hybrid_section_stress(const void *formulation, int64_t slice, int64_t slot, int lane, double *tension,
                           double *shear)
{
  const Hybrid *h = formulation;
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
  double strain[6], stress[6] = {0}, of[6], normal[3], square = 0, traction = 0, area[3] = {0}, volume = 0;
  for (int n = 0; n < (rows[0] == rows[1] ? 1 : 2); ++n) {
    HybridView view;
    hybrid_view(h, rows[n], &view);
    hybrid_tensors(h, rows[n], &view, h->particles->displacement.row, 0, strain, of);
    for (int k = 0; k < 6; ++k) stress[k] += view.volume * of[k];
    for (int k = 0; k < 3; ++k) area[k] += view.area[k];
    volume += view.volume;
  }
  for (int k = 0; k < 6; ++k) stress[k] /= volume;
  for (int k = 0; k < 3; ++k) square += area[k] * area[k];
  for (int k = 0; k < 3; ++k) normal[k] = area[k] / sqrt(square);
  *tension = 0;
  for (int k = 0; k < 3; ++k) {
    double t = 0;
    for (int j = 0; j < 3; ++j) t += stress[symmetric_place[3 * k + j]] * normal[j];
    traction += t * t;
    *tension += t * normal[k];
  }
  *shear = sqrt(fmax(0, traction - *tension * *tension));
}

/* ---- an even stress ---- */

/** Whether a slice or a neighbour of it is marked: points on its bonds have no other members. */
static bool is_near(const Family *f, const uint8_t *marked, int64_t slice)
{
  for (int lane = 0; lane < SLICE; ++lane) {
    if (marked[slice * SLICE + lane]) return true;
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
      if (f->intact[slot] >> lane & 1 && marked[family_bond(f, slice, slot, lane).neighbour]) return true;
  }
  return false;
}

/** Adds what a point does to its marked members. Those of bonds to other formulations are not known, as these have their part in them. */
static void add_even_stress(const Hybrid *h, const HybridView *view, const uint8_t *marked, double *const area[3])
{
  bool known = true;
  for (int n = 0; n < view->count; ++n) known &= !is_foreign(h->foreign, view->member[n]);
  for (int n = 0; n < view->count; ++n) {
    const int32_t place = view->member[n];
    for (int k = 0; k < 3 && marked[place]; ++k) {
      const double pairwise = n == 0 ? view->area[k] : n == 1 ? -view->area[k] : 0;
      area[k][place] += !known ? NAN : h->pairwise ? pairwise : -view->volume * view->g[n][k];
    }
  }
}

void hybrid_even_stress(const void *formulation, const uint8_t *marked, double *const area[3])
{
  const Hybrid *h = formulation;
  HybridView view;
  for (int64_t slice = 0; slice < h->particles->slices; ++slice) {
    if (h->bonds->first[slice] == h->bonds->first[slice + 1] || !is_near(h->family, marked, slice)) continue;
    for (int64_t row = h->bonds->first[slice]; row < h->bonds->first[slice + 1]; ++row) {
      hybrid_view(h, row, &view);
      if (!view.idle) add_even_stress(h, &view, marked, area);
    }
  }
}

/* ---- what people see of particles ---- */

/** Returns true if a row is the part of a laminate whose material differs from the material of a place. */
static bool is_other_part(const Hybrid *h, const HybridRow *at, int64_t place)
{
  const HybridLaminate *laminate = at->listed >= 0 ? hybrid_laminate(h, at->listed) : NULL;
  return laminate && laminate->share > 0 && laminate->own != h->material[place / SLICE];
}

/** Computes the means of strain and stress over the points on a place's bonds, weighted by volume. A laminate
 *  contributes the part of the place's own material. */
static void find_means(const Hybrid *h, int64_t place, double strain[6], double stress[6])
{
  double whole = 0;
  HybridRow at;
  for (int k = 0; k < 6; ++k) strain[k] = stress[k] = 0;
  for (HybridRows rows = hybrid_rows(h, place); hybrid_rows_next(h, &rows, &at);) {
    const double volume = hybrid_volume(h, &at);
    double here[6], held[6];
    HybridView view;
    if (!(volume > 0) || is_other_part(h, &at, place)) continue;
    if (h->hooke) hybrid_view_at(h, &at, &view);
    hybrid_tensors(h, rows.row, &view, h->particles->displacement.row, 0, here, held);
    for (int k = 0; k < 6; ++k) {
      strain[k] += volume * here[k];
      stress[k] += volume * held[k];
    }
    whole += volume;
  }
  for (int k = 0; k < 6 && whole > 0; ++k) {
    strain[k] /= whole;
    stress[k] /= whole;
  }
}

void hybrid_place_gradient(const void *formulation, int64_t place, double f[9])
{
  const Hybrid *h = formulation;
  double strain[6], stress[6];
  const ShapeTensor shape = shape_tensor(h->family, (int32_t)place, h->dimensions, 0);
  shape_gradient(h->family, h->particles->displacement.row, (int32_t)place, shape.inverse, f);
  if (!h->points->plane_stress) return;
  find_means(h, place, strain, stress);
  f[8] = h->finite ? sqrt(fmax(0, 1 + 2 * strain[ZZ])) : 1 + strain[ZZ];
}

void hybrid_stress(const void *formulation, int64_t place, double stress[6])
{
  double strain[6];
  find_means(formulation, place, strain, stress);
}

static double hybrid_along(const double xi[3], const double normal[3])
{
  return xi[0] * normal[0] + xi[1] * normal[1] + xi[2] * normal[2];
}

/** Returns the mean extent of the points of a lattice along a normal, by their volumes. A plane crack strains all
 * points whose members stand on both of its sides, and they follow their law to its end. */
double hybrid_crack_length(const void *formulation, int block, const double normal[3])
{
  const Hybrid *h = formulation;
  const Family *f = h->family;
  const double square = pow(f->horizon * (1 + 1e-9), 2);
  if (!h->body->lattices[block].chunks || block_is_foreign(h->foreign, h->particles, block)) return NAN;
  double sum = 0, whole = 0;
  for (int k = f->pattern_begin[block]; k < f->pattern_begin[block + 1]; ++k) {
    const Pattern *bond = &f->patterns[k];
    double low = fmin(0, hybrid_along(bond->xi, normal)), high = fmax(0, hybrid_along(bond->xi, normal));
    for (int j = f->pattern_begin[block]; j < f->pattern_begin[block + 1]; ++j) {
      const double *xi = f->patterns[j].xi;
      double apart = 0;
      for (int n = 0; n < 3; ++n) apart += (xi[n] - bond->xi[n]) * (xi[n] - bond->xi[n]);
      if (apart > square) continue;
      low = fmin(low, hybrid_along(xi, normal));
      high = fmax(high, hybrid_along(xi, normal));
    }
    sum += bond->length * bond->weight * (high - low);
    whole += bond->length * bond->weight;
  }
  return whole > 0 ? sum / whole : NAN;
}

/** How far members of a bond's point stand apart along the first axis, over all bonds of a square or cubic lattice by their volumes: a crack across that axis
 *  strains all points whose members stand on both of its sides, and they follow their law to its end. */
double hybrid_characteristic_length(const BondLength *of)
{
  const int axes = of->space == SPACE_3D ? 3 : 2;
  const double most =
      axes == 3 ? 10 : 40; /* spacings, beyond which bodies are refused, or nobody would wait for this */
  if (!(of->horizon <= most * of->spacing)) return NAN;
  const int reach = (int)(of->horizon / of->spacing * (1 + 1e-9));
  const double square = pow(of->horizon / of->spacing * (1 + 1e-9), 2);
  double sum = 0, whole = 0;
  int from[3], c[3];
  for (from[2] = axes == 3 ? -reach : 0; from[2] <= (axes == 3 ? reach : 0); ++from[2])
    for (from[1] = -reach; from[1] <= reach; ++from[1])
      for (from[0] = -reach; from[0] <= reach; ++from[0]) {
        const double length = sqrt(from[0] * from[0] + from[1] * from[1] + from[2] * from[2]);
        if (length == 0 || length * length > square) continue;
        int low = 0, high = 0; /* the bond from 0 to `from` */
        for (c[2] = -reach; c[2] <= reach; ++c[2])
          for (c[1] = -reach; c[1] <= reach; ++c[1])
            for (c[0] = -reach; c[0] <= reach; ++c[0]) {
              double own = 0, their = 0;
              for (int k = 0; k < axes; ++k) {
                own += c[k] * c[k];
                their += (c[k] - from[k]) * (c[k] - from[k]);
              }
              if (own > square || their > square || (axes == 2 && c[2])) continue;
              if (c[0] < low) low = c[0];
              if (c[0] > high) high = c[0];
            }
        const double volume =
            length * of->influence->value(fmin(1, length * of->spacing / of->horizon), length * of->spacing);
        sum += volume * (high - low) * of->spacing;
        whole += volume;
      }
  return whole > 0 ? sum / whole : NAN;
}
