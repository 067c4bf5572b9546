/* Hybrid bonds and their particles one by one: operators, forces between two particles, energies, and what people see of particles. */
#include "formulation/hybrid.h"

#include "base/tensor.h"
#include "formulation/shape_tensor.h"
#include <string.h>

int64_t hybrid_point_count(const void *formulation)
{
  const Hybrid *h = formulation;
  return h->bonds->count;
}

int hybrid_point(const void *formulation, int64_t row, Operator *point, Error *error)
{
  const Hybrid *h = formulation;
  operator_clear(point);
  if (h->idle[row]) return BRECCIA_OK;
  const int count = hybrid_members(h, row);
  for (int n = 0; n < count; ++n) {
    const double *g = h->g[h->first[row] + n];
    if (n > 1 && g[0] == 0 && g[1] == 0 && g[2] == 0) continue; /* hidden */
    OperatorPlace *place = operator_add(point, h->member[h->first[row] + n], error);
    if (!place) return BRECCIA_FAILURE;
    for (int k = 0; k < 3; ++k) {
      place->g[k] = g[k];
      if (n < 2) place->act[k] = (n ? 1 : -1) * h->area[row][k] / h->volume[row];
    }
  }
  point->components = 6;
  point->finite = h->finite;
  point->acts_apart = h->pairwise;
  point->volume = h->volume[row];
  for (int k = 0; k < 6; ++k) point->stress[k] = h->points->stress[k][row];
  points_tangent(h->points, row, point->tangent);
  return BRECCIA_OK;
}

/* ---- forces between two particles ---- */

/** Force of a point on one of its members, of the state or step evaluated last. */
static void member_force(const Hybrid *h, int64_t row, int member, double force[3])
{
  const double *g = h->g[h->first[row] + member];
  for (int k = 0; k < 3; ++k) {
    force[k] = 0;
    if (h->pairwise && member < 2) force[k] = (member ? -1 : 1) * hybrid_force(h, row, k, 0);
    for (int j = 0; j < 3 && !h->pairwise; ++j) force[k] -= hybrid_force(h, row, k, j) * g[j];
  }
}

/** Half of what a member that is no end receives comes from each of the two ends; the rest passes between these. So shared out, forces come in pairs along
 *  the bonds that there are.
 *  @param[in] met    how a place has a part in a point
 *  @param[in] other  another place
 *  @param[in,out] force  on the place, from the other one */
static void add_pair(const Hybrid *h, const HybridMeeting *met, int32_t other, double force[3])
{
  const int64_t row = met->row, first = h->first[row];
  const int count = hybrid_members(h, row);
  int there = 0;
  double part[3];
  while (there < count && h->member[first + there] != other) ++there;
  if (there == count) return;
  if (met->member >= 2 && there >= 2) return;
  const int sole = met->member >= 2 ? met->member : there; /* the one that is no end */
  if (sole >= 2) {
    member_force(h, row, sole, part);
    for (int k = 0; k < 3; ++k) force[k] += (met->member >= 2 ? 0.5 : -0.5) * part[k];
    return;
  }
  member_force(h, row, met->member, part);
  for (int k = 0; k < 3; ++k) force[k] += part[k];
  for (int n = 2; n < count && !h->pairwise; ++n) {
    member_force(h, row, n, part);
    for (int k = 0; k < 3; ++k) force[k] += 0.5 * part[k];
  }
}

void hybrid_half_state(const void *formulation, double *const *at, int64_t slice, int64_t slot, int lane,
                       double state[3])
{
  (void)at;
  const Hybrid *h = formulation;
  const int64_t place = slice * SLICE + lane;
  const int32_t other = family_bond(h->family, slice, slot, lane).neighbour;
  double force[3] = {0};
  for (int64_t n = h->met_first[place]; n < h->met_first[place + 1]; ++n) add_pair(h, &h->met[n], other, force);
  const double volumes = h->particles->volume[place] * h->particles->volume[other];
  for (int k = 0; k < 3; ++k) state[k] = 0.5 * force[k] / volumes;
}

/** Gradient I + G of a bond's point. */
static void bond_gradient(const Hybrid *h, int64_t row, double f[9])
{
  memset(f, 0, 9 * sizeof *f);
  if (!h->idle[row]) hybrid_gradient(h, row, (const double(*)[3])(h->g + h->first[row]), h->particles->displacement, f);
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
  double *const *u = h->particles->displacement, f[9], turn[9];
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
  bond_gradient(h, rows[0], f);
  bond_turn(h, f, turn);
  for (int k = 0; k < 3; ++k) {
    change[k] = bond.xi[k] + u[k][bond.neighbour] - u[k][slice * SLICE + lane];
    for (int j = 0; j < 3; ++j) change[k] -= turn[3 * k + j] * bond.xi[j];
  }
}

void hybrid_section_stress(const void *formulation, int64_t slice, int64_t slot, int lane, double *tension,
                           double *shear)
{
  const Hybrid *h = formulation;
  int64_t rows[2];
  bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
  double stress[6], normal[3], square = 0, traction = 0;
  for (int k = 0; k < 6; ++k) stress[k] = (h->points->stress[k][rows[0]] + h->points->stress[k][rows[1]]) / 2;
  for (int k = 0; k < 3; ++k) square += h->area[rows[0]][k] * h->area[rows[0]][k];
  for (int k = 0; k < 3; ++k) normal[k] = h->area[rows[0]][k] / sqrt(square);
  *tension = 0;
  for (int k = 0; k < 3; ++k) {
    double t = 0;
    for (int j = 0; j < 3; ++j) t += stress[symmetric_place[3 * k + j]] * normal[j];
    traction += t * t;
    *tension += t * normal[k];
  }
  *shear = sqrt(fmax(0, traction - *tension * *tension));
}

/* ---- energies ---- */

static bool counts(const Hybrid *h, int k)
{
  return k != ZZ || !h->points->plane_stress; /* across plane stress nothing does work */
}

/** Energy per volume of a point's stress, as it would give it back. */
static double density(const Hybrid *h, int64_t row)
{
  return points_elastic_energy(h->points, row) * points_softness(h->points, row);
}

static double work(const Hybrid *h, const double stress[6], const double from[6], const double to[6])
{
  double sum = 0;
  for (int k = 0; k < 6; ++k)
    if (counts(h, k)) sum += stress[k] * (to[k] - from[k]);
  return sum;
}

/** Stress after a change of strain, if the point went on as it would unload. */
static void foresee_stress(const Hybrid *h, int64_t row, const double was[6], const double from[6], const double to[6],
                           double stress[6])
{
  const Material *m = points_material(h->points, row);
  const double soft = points_softness(h->points, row), lame = m->bulk - 2 * m->shear / 3;
  const double mean = h->points->plane_stress ? 2 * m->shear * lame / (lame + 2 * m->shear) : lame;
  double trace = 0;
  for (int k = 0; k < 3; ++k)
    if (counts(h, k)) trace += to[k] - from[k];
  for (int k = 0; k < 6; ++k)
    stress[k] =
        !counts(h, k)
            ? 0
            : was[k] +
                  ((k < 3 ? 2 * m->shear * (to[k] - from[k]) + mean * trace : m->shear * (to[k] - from[k]))) / soft;
}

/** A point in the step under way, whose strain and stress are those of its beginning. */
typedef struct PointInStep {
  double stress[6], was[6]; /* at the beginning of the step */
  double now[6];            /* strain at its end, by the members that it began with */
} PointInStep;

static PointInStep look(const Hybrid *h, int64_t row)
{
  PointInStep point;
  double g[9];
  for (int k = 0; k < 6; ++k) {
    point.stress[k] = h->points->stress[k][row];
    point.was[k] = h->points->strain[k][row];
  }
  hybrid_gradient(h, row, (const double(*)[3])(h->g + h->first[row]), h->particles->displacement, g);
  hybrid_strain(h, g, point.now);
  return point;
}

/** Energy that a point had received until the end of the step under way: works summed by the trapezium rule find it gone there. */
static double received(const Hybrid *h, int64_t row)
{
  const PointInStep point = look(h, row);
  return h->volume[row] * (density(h, row) + work(h, point.stress, point.was, point.now) / 2);
}

/** Energy that a point has lost in the step under way by the bonds that are broken, beyond what its law will see: works go by the strain with all members
 *  to the end of the step and then without, the law goes straight (docs/theory.md 4, "What a breaking bond takes with it").
 *  @param[in] time  of the step */
static double lost(const Hybrid *h, int64_t row, double time)
{
  const Particles *p = h->particles;
  if (h->idle[row]) return 0;
  if (!hybrid_weigh(h, row, h->tried)) return received(h, row);
  const PointInStep point = look(h, row);
  const double(*g)[3] = (const double(*)[3])h->tried;
  double after[9] = {0}, before[9] = {0}, strain[6], first[6], stress[6];
  const int32_t *member = h->member + h->first[row];
  hybrid_gradient(h, row, g, p->displacement, after);
  for (int n = 0; n < hybrid_members(h, row); ++n)
    for (int k = 0; k < 9; ++k)
      before[k] += (p->displacement[k / 3][member[n]] - time * p->velocity[k / 3][member[n]]) * g[n][k % 3];
  hybrid_strain(h, after, strain);
  hybrid_strain(h, before, first);
  foresee_stress(h, row, point.stress, point.was, strain, stress);
  return h->volume[row] / 2 *
         (work(h, point.stress, point.was, point.now) + work(h, stress, first, strain) -
          work(h, point.stress, point.was, strain) - work(h, stress, point.was, strain));
}

/** Number of a place among the members of a row, or -1. */
static int member_of(const Hybrid *h, int64_t row, int32_t place)
{
  for (int n = 0; n < hybrid_members(h, row); ++n)
    if (h->member[h->first[row] + n] == place) return n;
  return -1;
}

/** What the points of which both ends of a bond are members, one of them as an end, have lost; those are all that its break changes. Of pairwise bonds places
 *  know only the points of which they are an end. */
static double lost_by_all(const Hybrid *h, int32_t a, int32_t b, double time)
{
  double sum = 0;
  for (int64_t n = h->met_first[a]; n < h->met_first[a + 1]; ++n) {
    const int there = member_of(h, h->met[n].row, b);
    if (there >= 0 && (h->met[n].member < 2 || there < 2)) sum += lost(h, h->met[n].row, time);
  }
  for (int64_t n = h->met_first[b]; n < h->met_first[b + 1] && h->pairwise; ++n)
    if (member_of(h, h->met[n].row, a) >= 2) sum += lost(h, h->met[n].row, time);
  return sum;
}

/** Rows of a bond, one or two. */
static int rows_of(const Hybrid *h, int64_t slice, int64_t slot, int lane, int64_t rows[2])
{
  bond_list_rows(h->bonds, h->family, slice, slot, lane, rows);
  return rows[0] == rows[1] ? 1 : 2;
}

void hybrid_bond_energy(const void *formulation, int64_t slice, int64_t slot, int lane, double time,
                        StoredEnergy *energy)
{
  Hybrid *h = (Hybrid *)(uintptr_t)formulation; /* its bond counts as broken meanwhile */
  const int32_t place = (int32_t)(slice * SLICE + lane), other = family_bond(h->family, slice, slot, lane).neighbour;
  int64_t rows[2];
  *energy = (StoredEnergy){0};
  for (int n = 0; n < rows_of(h, slice, slot, lane, rows); ++n)
    if (!h->idle[rows[n]]) energy->stored += h->volume[rows[n]] * density(h, rows[n]);
  const double before = lost_by_all(h, place, other, time);
  h->hidden[0] = place;
  h->hidden[1] = other;
  energy->received = lost_by_all(h, place, other, time) - before;
  h->hidden[0] = h->hidden[1] = -1;
}

void hybrid_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy)
{
  (void)time;
  const Hybrid *h = formulation;
  *energy = (StoredEnergy){0};
  for (int64_t n = h->met_first[place]; n < h->met_first[place + 1]; ++n)
    if (h->met[n].member < 2 && !h->idle[h->met[n].row])
      energy->stored += 0.5 * h->volume[h->met[n].row] * density(h, h->met[n].row);
}

/* ---- what people see of particles ---- */

/** Mean of numbers of the points on a place's bonds, by their volumes. */
static double mean_of(const Hybrid *h, int64_t place, const double *numbers)
{
  double sum = 0, whole = 0;
  for (int64_t n = h->met_first[place]; n < h->met_first[place + 1]; ++n) {
    const int64_t row = h->met[n].row;
    if (h->met[n].member >= 2 || h->idle[row]) continue;
    sum += h->volume[row] * numbers[row];
    whole += h->volume[row];
  }
  return whole > 0 ? sum / whole : 0;
}

void hybrid_place_gradient(const void *formulation, int64_t place, double f[9])
{
  const Hybrid *h = formulation;
  const ShapeTensor shape = shape_tensor(h->family, (int32_t)place, h->dimensions, 0);
  shape_gradient(h->family, (int32_t)place, shape.inverse, f);
  if (h->points->plane_stress) f[8] = sqrt(fmax(0, 1 + 2 * mean_of(h, place, h->points->strain[ZZ])));
}

void hybrid_stress(const void *formulation, int64_t place, double stress[6])
{
  const Hybrid *h = formulation;
  for (int k = 0; k < 6; ++k) stress[k] = mean_of(h, place, h->points->stress[k]);
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
