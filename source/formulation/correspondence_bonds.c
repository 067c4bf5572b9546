#include "formulation/correspondence.h"

#include <math.h>

/** Length at which a lone bond carries nothing. */
static double natural_length(const Correspondence *c, int64_t place, const Bond *bond)
{
  return bond->length * (1 + particles_free_strain(c->particles, place, bond->neighbour));
}

void correspondence_axial_spring(const Correspondence *c, double *const u[3], int64_t place, const Bond *bond,
                                 double pull[3], double spring[6])
{
  const Material *m = points_material(c->points, place);
  const double stiffness = c->shapes.kept[place] * micromodulus(c->body, material_young(m), c->family->horizon) / 2;
  double y[3], square = 0;
  for (int k = 0; k < 3; ++k) {
    y[k] = bond->xi[k] + u[k][bond->neighbour] - u[k][place];
    square += y[k] * y[k];
  }
  const double length = sqrt(square), natural = natural_length(c, place, bond),
               across = length > 0 ? stiffness * (length - natural) / (bond->length * length) : 0;
  for (int k = 0; k < 3; ++k) pull[k] = across * y[k];
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], s = symmetric_column[k];
    spring[k] = (r == s ? across : 0) + (square > 0 ? (stiffness / bond->length - across) * y[r] * y[s] / square : 0);
  }
}

/** Force state of a lone bond, less the control that the sweeps have added for this particle.
 *  @param[in] u, at  rows as `displacement` and `linearised_at` of Sweep */
static void axial_state(const Correspondence *c, double *const *u, double *const *at, int64_t place, const Bond *bond,
                        double t[3])
{
  const double omega = bond->weight / c->particles->volume[bond->neighbour];
  double pull[3], spring[6], eta[3];
  correspondence_axial_spring(c, at ? at : u, place, bond, pull, spring);
  for (int k = 0; k < 3; ++k) eta[k] = u[k][bond->neighbour] - u[k][place];
  for (int k = 0; k < 3; ++k) {
    t[k] = at ? 0 : pull[k];
    for (int j = 0; j < 3; ++j) {
      const int kj = symmetric_place[3 * k + j];
      t[k] += ((at ? spring[kj] : 0) - omega * hold_component(c, place, kj)) * eta[j];
    }
  }
}

int64_t correspondence_finish(void *formulation, const Sweep *sweep)
{
  const Correspondence *c = formulation;
  for (int64_t n = 0; n < c->axial_count; ++n) {
    int32_t place = c->axial[n];
    int64_t slice = place / SLICE;
    int lane = place % SLICE;
    if (c->shapes.mode[place] != SHAPE_AXIAL) continue;
    for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
      if (!(c->family->intact[slot] >> lane & 1)) continue;
      Bond bond = family_bond(c->family, slice, slot, lane);
      double t[3];
      axial_state(c, sweep->displacement, sweep->linearised_at, place, &bond, t);
      for (int k = 0; k < 3; ++k) {
        sweep->internal[k][place] += t[k] * c->particles->volume[bond.neighbour];
        if (!is_foreign(c->foreign, bond.neighbour))
          sweep->internal[k][bond.neighbour] -= t[k] * c->particles->volume[place];
      }
    }
  }
  return -1;
}

void correspondence_half_state(const void *formulation, double *const *u, double *const *at, int64_t slice,
                               int64_t slot, int lane, double state[3])
{
  const Correspondence *c = formulation;
  const Bond bond = family_bond(c->family, slice, slot, lane);
  const int64_t place = slice * SLICE + lane;
  const double omega = bond.weight / c->particles->volume[bond.neighbour];
  for (int k = 0; k < 3; ++k) {
    state[k] = 0;
    for (int j = 0; j < 3; ++j) {
      const double eta = u[j][bond.neighbour] - u[j][place];
      state[k] += omega * (c->state[3 * k + j][place] * bond.xi[j] +
                           hold_component(c, place, symmetric_place[3 * k + j]) * eta);
    }
  }
  if (c->shapes.mode[place] != SHAPE_AXIAL) return;
  double t[3];
  axial_state(c, u, at, place, &bond, t);
  for (int k = 0; k < 3; ++k) state[k] += t[k];
}

/** Sum of V w (K^-1 + K^-1 of the neighbour) xi over the bonds of a place: control does nothing in even strain. */
static void add_even_stress(const Correspondence *c, int64_t place, double *const area[3])
{
  const Family *f = c->family;
  const int64_t slice = place / SLICE;
  const double volume = c->particles->volume[place];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    const int64_t there = bond.neighbour;
    const bool known = !is_foreign(c->foreign, there) && c->shapes.mode[place] == SHAPE_REGULAR &&
                       c->shapes.mode[there] == SHAPE_REGULAR;
    const SliceShape *own = shape_of_slice(&c->shapes, slice), *their = shape_of_slice(&c->shapes, there / SLICE);
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) {
        const int kj = symmetric_place[3 * k + j];
        const double both = own->inverse[kj][place % SLICE] + their->inverse[kj][there % SLICE];
        area[k][place] += known ? volume * bond.weight * both * bond.xi[j] : NAN;
      }
  }
}

void correspondence_even_stress(const void *formulation, const uint8_t *marked, double *const area[3])
{
  const Correspondence *c = formulation;
  for (int64_t place = 0; place < c->particles->places; ++place)
    if (marked[place] && !is_foreign(c->foreign, place)) add_even_stress(c, place, area);
}

/* ---- energy ---- */

/** Sums over the bonds of a place, of elongations eta and of those before the last step. */
typedef struct Sums {
  double now[9], before[9];    /* sum w eta (x) xi */
  double square[9], across[9]; /* sum w eta (x) eta, sum w eta (x) eta before */
} Sums;

static void sum_bonds(const Correspondence *c, int64_t place, double time, Sums *sums)
{
  const Particles *p = c->particles;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  *sums = (Sums){.now = {0}};
  for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
    if (!(c->family->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(c->family, slice, slot, lane);
    double eta[3], before[3];
    for (int k = 0; k < 3; ++k) {
      eta[k] = p->displacement.row[k][bond.neighbour] - p->displacement.row[k][place];
      before[k] = eta[k] - time * (p->velocity.row[k][bond.neighbour] - p->velocity.row[k][place]);
    }
    for (int k = 0; k < 9; ++k) {
      sums->now[k] += bond.weight * eta[k / 3] * bond.xi[k % 3];
      sums->before[k] += bond.weight * before[k / 3] * bond.xi[k % 3];
      sums->square[k] += bond.weight * eta[k / 3] * eta[k % 3];
      sums->across[k] += bond.weight * eta[k / 3] * before[k % 3];
    }
  }
}

/** G = (sum w eta (x) xi) K^-1, and the strain that follows from it. */
static void strain_of(const Correspondence *c, int64_t place, const double moved[9], double g[9], double strain[6])
{
  const SliceShape *shape = shape_of_slice(&c->shapes, place / SLICE);
  for (int k = 0; k < 9; ++k) {
    g[k] = 0;
    for (int j = 0; j < 3; ++j)
      g[k] += moved[k / 3 * 3 + j] * shape->inverse[symmetric_place[3 * j + k % 3]][place % SLICE];
  }
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], s = symmetric_column[k];
    strain[k] = g[3 * r + s] + g[3 * s + r];
    if (c->finite) strain[k] += g[r] * g[s] + g[3 + r] * g[3 + s] + g[6 + r] * g[6 + s];
    if (k < 3) strain[k] /= 2;
  }
}

/** Sum of C_rs (a_rs - sum_k g_rk moved_sk): of C z . z over the bonds, with z = eta - G xi. */
static double held(const Correspondence *c, int64_t place, const double a[9], const double g[9], const double moved[9])
{
  double sum = 0;
  for (int k = 0; k < 9; ++k) {
    double z = a[k];
    for (int j = 0; j < 3; ++j) z -= g[k / 3 * 3 + j] * moved[k % 3 * 3 + j];
    sum += hold_component(c, place, symmetric_place[k]) * z;
  }
  return sum;
}

static void sum_axial_energy(const Correspondence *c, int64_t place, double time, StoredEnergy *energy)
{
  const Particles *p = c->particles;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
    if (!(c->family->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(c->family, slice, slot, lane);
    const double volumes = p->volume[place] * p->volume[bond.neighbour];
    double pull[3], spring[6], square = 0, force = 0, along = 0;
    correspondence_axial_spring(c, p->displacement.row, place, &bond, pull, spring);
    for (int k = 0; k < 3; ++k) {
      const double y = bond.xi[k] + p->displacement.row[k][bond.neighbour] - p->displacement.row[k][place];
      square += y * y;
      force += pull[k] * y; /* times |y| */
      along += pull[k] * time * (p->velocity.row[k][bond.neighbour] - p->velocity.row[k][place]);
    }
    const double natural = natural_length(c, place, &bond),
                 stored = square > 0 ? 0.5 * volumes * force / sqrt(square) * (sqrt(square) - natural) : 0;
    energy->stored += stored;
    energy->received += stored - 0.5 * volumes * along;
  }
}

void correspondence_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy)
{
  const Correspondence *c = formulation;
  const Points *points = c->points;
  const int64_t slice = place / SLICE;
  *energy = (StoredEnergy){0};
  if (c->shapes.mode[place] == SHAPE_AXIAL) sum_axial_energy(c, place, time, energy);
  if (c->shapes.mode[place] == SHAPE_AXIAL || c->shapes.mode[place] == SHAPE_FREE) return;
  const double volume = c->particles->volume[place];
  Sums sums;
  double g[9], g_before[9];
  sum_bonds(c, place, time, &sums);
  strain_of(c, place, sums.now, g, energy->strain);
  strain_of(c, place, sums.before, g_before, energy->was);
  energy->weight = volume * shape_of_slice(&c->shapes, slice)->share[place % SLICE];
  energy->held = volume * 0.5 * held(c, place, sums.square, g, sums.now);
  energy->stored =
      energy->weight * points_elastic_energy(points, place) * points_softness(points, place) + energy->held;
  energy->control = volume * 0.5 * held(c, place, sums.across, g, sums.before);
}

double correspondence_free_tension(const void *formulation, int64_t place)
{
  const Correspondence *c = formulation;
  const Particles *p = c->particles;
  const int64_t slice = place / SLICE;
  double sum = 0;
  if (c->shapes.mode[place] == SHAPE_FREE) return 0;
  if (c->shapes.mode[place] != SHAPE_AXIAL) {
    for (int k = 0; k < 3; ++k) sum += c->points->stress[k][place];
    return p->volume[place] * shape_of_slice(&c->shapes, slice)->share[place % SLICE] * sum;
  }
  for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
    if (!(c->family->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(c->family, slice, slot, (int)(place % SLICE));
    double pull[3], spring[6], along = 0, square = 0;
    correspondence_axial_spring(c, p->displacement.row, place, &bond, pull, spring);
    for (int k = 0; k < 3; ++k) {
      const double y = bond.xi[k] + p->displacement.row[k][bond.neighbour] - p->displacement.row[k][place];
      along += pull[k] * y;
      square += y * y;
    }
    if (square > 0) sum += p->volume[place] * p->volume[bond.neighbour] * along / sqrt(square) * bond.length;
  }
  const bool plane_strain = c->body->dimensions == 2 && !c->points->plane_stress;
  return plane_strain ? (1 + material_poisson(points_material(c->points, place))) * sum : sum;
}
