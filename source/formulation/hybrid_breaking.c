/* Energies of hybrid bonds, and what one that breaks takes with it: its own point's, and what the points lose that its ends are members of. */
#include "formulation/hybrid.h"

#include "base/tensor.h"
#include <math.h>

static bool counts(const Hybrid *h, int k)
{
  return k != ZZ || !h->points->plane_stress; /* across plane stress nothing does work */
}

/** Energy per volume of a point's stress, as it would give it back. @param[in] time, view  as in hybrid_tensors */
static double density(const Hybrid *h, int64_t row, const HybridView *view, double time)
{
  double strain[6], stress[6];
  hybrid_tensors(h, row, view, h->particles->displacement.row, time, strain, stress);
  return points_energy_at(points_material(h->points, row), stress) * points_softness(h->points, row);
}

static double work(const Hybrid *h, const double stress[6], const double from[6], const double to[6])
{
  double sum = 0;
  for (int k = 0; k < 6; ++k)
    if (counts(h, k)) sum += stress[k] * (to[k] - from[k]);
  return sum;
}

/** Stress after a change of strain: what the law will say, or where it cannot be asked, if the point went on as it would unload. */
static void foresee_stress(const Hybrid *h, int64_t row, const double was[6], const double from[6], const double to[6],
                           double stress[6])
{
  if (points_try_stress(h->points, row, to, stress)) return;
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

/** Returns the increment of the free strain of a point in the step. */
static double growth_of(const Hybrid *h, const HybridView *view)
{
  const double *growth = h->particles->free_growth;
  return growth ? (growth[view->member[0]] + growth[view->member[1]]) / 2 : 0;
}

/** Begins strains of a point where they begin for its law: what the free strain grows by in the step does not strain it. */
static void take_growth_off(const Hybrid *h, const HybridView *view, double from[6])
{
  for (int k = 0; k < 3; ++k) from[k] += growth_of(h, view);
}

static PointInStep look(const Hybrid *h, int64_t row, const HybridView *view, double time)
{
  PointInStep point;
  double g[9];
  hybrid_tensors(h, row, view, h->particles->displacement.row, time, point.was, point.stress);
  take_growth_off(h, view, point.was);
  hybrid_gradient(view, h->particles->displacement.row, g);
  hybrid_strain(h, g, point.now);
  hybrid_laminate_strain(h, view->laminate, hybrid_laminate_free(h, view->member), point.now);
  return point;
}

/** Energy that a point has lost in the step under way by the bonds that are broken, beyond what its law will see: works go by the strain with all members
 *  to the end of the step and then without, the law goes straight (docs/theory.md 4, "What a breaking bond takes with it").
 *  @param[in] time  of the step */
static double lost(const Hybrid *h, int64_t row, const HybridRow *at, double time)
{
  const Particles *p = h->particles;
  HybridView view, left;
  hybrid_view_at(h, at, &view);
  if (view.idle) return 0;
  const PointInStep point = look(h, row, &view, time);
  /* What it had received until the end of the step: works summed by the trapezium rule find it gone there. */
  if (!(hybrid_view_anew(h, at, &left) > FORMULATION_LEAST_EVENNESS))
    return view.volume * (density(h, row, &view, time) + work(h, point.stress, point.was, point.now) / 2);
  double after[9], before[9] = {0}, strain[6], first[6], stress[6];
  hybrid_gradient(&left, p->displacement.row, after);
  for (int n = 0; n < left.count; ++n)
    for (int k = 0; k < 9; ++k)
      before[k] += (p->displacement.row[k / 3][left.member[n]] - time * p->velocity.row[k / 3][left.member[n]]) *
                   left.g[n][k % 3];
  hybrid_strain(h, after, strain);
  hybrid_strain(h, before, first);
  hybrid_laminate_strain(h, left.laminate, hybrid_laminate_free(h, view.member), strain);
  hybrid_laminate_strain(h, left.laminate, hybrid_laminate_free(h, view.member) - growth_of(h, &view), first);
  take_growth_off(h, &view, first);
  foresee_stress(h, row, point.stress, point.was, strain, stress);
  return view.volume / 2 *
         (work(h, point.stress, point.was, point.now) + work(h, stress, first, strain) -
          work(h, point.stress, point.was, strain) - work(h, stress, point.was, strain));
}

/** What the points of which both ends of a bond are members have lost; those are all that its break changes. Of points that an earlier break of the step has
 *  taken from a place this one takes nothing more. @param[out] inside  of that, what the body itself has lost */
static double lost_by_all(const Hybrid *h, const int32_t places[2], double time, double *inside)
{
  double sum = 0;
  *inside = 0;
  for (int end = 0; end < 2; ++end) {
    HybridRow row;
    HybridView view;
    for (HybridRows rows = hybrid_rows(h, places[end]); hybrid_rows_next(h, &rows, &row);) {
      if (!hybrid_rows_near(h, &rows, places[!end])) continue;
      hybrid_view_at(h, &row, &view);
      const int other = hybrid_member_of(&view, places[!end]);
      if (other == view.count || (end && other < 2)) continue;
      const double energy = lost(h, rows.row, &row, time);
      sum += energy;
      *inside += hybrid_share_inside(h, &view) * energy;
    }
  }
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
  const int32_t places[2] = {(int32_t)(slice * SLICE + lane), family_bond(h->family, slice, slot, lane).neighbour};
  int64_t rows[2];
  *energy = (StoredEnergy){0};
  for (int n = 0; n < rows_of(h, slice, slot, lane, rows); ++n) {
    HybridView view;
    hybrid_view(h, rows[n], &view);
    if (!view.idle) energy->stored += view.volume * density(h, rows[n], &view, time);
  }
  double inside, inside_before;
  const double before = lost_by_all(h, places, time, &inside_before);
  h->hidden[0] = places[0];
  h->hidden[1] = places[1];
  energy->received = lost_by_all(h, places, time, &inside) - before;
  energy->inside = inside - inside_before;
  h->hidden[0] = h->hidden[1] = -1;
}

/** What the body would lose without the bond at the displacements held: the energy of its own point, and what points
 * around it lose that have its ends among their members. */
double hybrid_held_energy(const void *formulation, int64_t slice, int64_t slot, int lane)
{
  StoredEnergy energy;
  hybrid_bond_energy(formulation, slice, slot, lane, 0, &energy);
  return energy.received;
}

double hybrid_free_tension(const void *formulation, int64_t place)
{
  const Hybrid *h = formulation;
  double sum = 0;
  HybridRow at;
  for (HybridRows rows = hybrid_rows(h, place); hybrid_rows_next(h, &rows, &at);) {
    const double volume = hybrid_volume(h, &at);
    double strain[6], stress[6];
    HybridView view;
    if (!(volume > 0)) continue;
    if (h->hooke) hybrid_view_at(h, &at, &view);
    hybrid_tensors(h, rows.row, &view, h->particles->displacement.row, 0, strain, stress);
    sum += (rows.alone ? 1 : 0.5) * volume * (stress[XX] + stress[YY] + (counts(h, ZZ) ? stress[ZZ] : 0));
  }
  return sum;
}

void hybrid_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy)
{
  (void)time;
  const Hybrid *h = formulation;
  *energy = (StoredEnergy){0};
  HybridRow at;
  for (HybridRows rows = hybrid_rows(h, place); hybrid_rows_next(h, &rows, &at);) {
    const double volume = hybrid_volume(h, &at);
    HybridView view;
    if (!(volume > 0)) continue;
    if (h->hooke) hybrid_view_at(h, &at, &view);
    energy->stored += (rows.alone ? 1 : 0.5) * volume * density(h, rows.row, &view, 0);
  }
}
