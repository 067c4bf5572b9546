/* Links of lattices in the plane, as many at a time as vectors have lanes. With the cosine and sine of each particle's rotation a link needs no trigonometry: the sine of
 * an end rotation is the cross product of the chord with where the section points, and the angle a series of it. */
#include "formulation/micropolar_lanes.h"

/** Half a slice: what it has, and what acts on it. */
typedef struct HalfSlice {
  int64_t place;
  Lanes u[2], cosine, sine;
  Lanes force[2], moment;
  LanesWithin within; /* the series */
} HalfSlice;

LANES_INLINE void add_link(const Micropolar *m, const LinkLanes *l, StiffnessLanes stiffness, const breccia_link *weak,
                           bool any, HalfSlice *own)
{
  const Lanes nx = l->n[0], ny = l->n[1], ex = l->e[0], ey = l->e[1], yx = nx + ex, yy = ny + ey;
  const Lanes d = ex * (nx + yx) + ey * (ny + yy), g = shortening(d, any ? RANGE_ANY : RANGE_SERIES),
              inverse = lanes_set(1) - g;
  const Lanes stretch = d * inverse - g - free_of(m, own->place, l), mx = yx * inverse, my = yy * inverse;
  const Lanes cosine = of_others(l, m->shown[0]), sine = of_others(l, m->shown[1]);
  const Lanes ax = own->cosine * nx - own->sine * ny, ay = own->sine * nx + own->cosine * ny;
  const Lanes bx = cosine * nx - sine * ny, by = sine * nx + cosine * ny;
  const Lanes here = mx * ay - my * ax, other = mx * by - my * bx, along = mx * ax + my * ay,
              along_other = mx * bx + my * by;
  const Lanes a = here * end_rotation(here * here, along, any).factor,
              b = other * end_rotation(other * other, along_other, any).factor, sum = a + b;
  Lanes axial = stiffness.axial, bending = stiffness.bending;
  if (weak) {
    Lanes left[2];
    find_left(m, weak, own->place, l, stretch, &left[0], &left[1]);
    axial *= left[0];
    bending *= left[1];
  }
  const Lanes pull = axial * stretch, shear = lanes_set(6) * bending * l->by_length * inverse * sum;
  if (!any) own->within = links_within(own->within, l, d, along, along_other);
  own->force[0] += pull * mx;
  own->force[0] += shear * my;
  own->force[1] += pull * my;
  own->force[1] -= shear * mx;
  own->moment -= bending * (sum + sum + (a + a));
}

/** @param[in] any  of any stretches and rotations, or within the series @return whether they were within them */
LANES_INLINE bool sweep(const Micropolar *m, int64_t slice, bool any)
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    HalfSlice own = {.place = place,
                     .u = {lanes_load(p->displacement[0] + place), lanes_load(p->displacement[1] + place)},
                     .cosine = lanes_load(m->shown[0] + place),
                     .sine = lanes_load(m->shown[1] + place),
                     .moment = {0},
                     .within = lanes_all_within()};
    own.force[0] = own.force[1] = lanes_set(0);
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
      const LinkLanes l = lattice_links(m, p->displacement, slot, half, 2, own.u);
      add_link(m, &l, lattice_stiffness(m, &l), weak, any, &own);
    }
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = stored_links(m, p->displacement, place, slot, half, own_bits(m, slot), 2, own.u);
      add_link(m, &l, stored_stiffness(m, place, &l), weak, any, &own);
    }
    if (!any && !lanes_are_within(own.within)) return false;
    lanes_store(p->internal[0] + place, own.force[0]);
    lanes_store(p->internal[1] + place, own.force[1]);
    lanes_store(p->internal[2] + place, lanes_set(0));
    lanes_store(p->internal[ROTATION] + place, own.moment);
  }
  return true;
}

static void resist(const Micropolar *m, int64_t slice)
{
  if (!sweep(m, slice, false)) sweep(m, slice, true);
}

/* ---- energies ---- */

/** Energy of links per volume of this end, times the weights of the bonds. */
LANES_INLINE Lanes energy_of(const Micropolar *m, int64_t place, const LinkLanes *l, StiffnessLanes stiffness,
                             const breccia_link *weak, Lanes own_cosine, Lanes own_sine)
{
  const Lanes nx = l->n[0], ny = l->n[1], ex = l->e[0], ey = l->e[1], yx = nx + ex, yy = ny + ey;
  const Lanes d = ex * (nx + yx) + ey * (ny + yy), g = shortening(d, RANGE_ANY), inverse = lanes_set(1) - g;
  const Lanes stretch = d * inverse - g - free_of(m, place, l), mx = yx * inverse, my = yy * inverse;
  const Lanes cosine = of_others(l, m->shown[0]), sine = of_others(l, m->shown[1]);
  const Lanes ax = own_cosine * nx - own_sine * ny, ay = own_sine * nx + own_cosine * ny;
  const Lanes bx = cosine * nx - sine * ny, by = sine * nx + cosine * ny;
  const Lanes here = mx * ay - my * ax, other = mx * by - my * bx;
  const Lanes a = here * end_rotation(here * here, mx * ax + my * ay, true).factor,
              b = other * end_rotation(other * other, mx * bx + my * by, true).factor;
  Lanes left[2] = {lanes_set(1), lanes_set(1)};
  if (weak) find_left(m, weak, place, l, stretch, &left[0], &left[1]);
  return lanes_set(0.5) * left[0] * stiffness.axial * stretch * stretch / l->by_length +
         lanes_set(2) * left[1] * stiffness.bending * (a * a + a * b + b * b);
}

static void store(const Micropolar *m, int64_t slice, double energies[SLICE])
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    const Lanes u[2] = {lanes_load(p->displacement[0] + place), lanes_load(p->displacement[1] + place)},
                cosine = lanes_load(m->shown[0] + place), sine = lanes_load(m->shown[1] + place);
    Lanes sum = lanes_set(0);
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
      const LinkLanes l = lattice_links(m, p->displacement, slot, half, 2, u);
      sum += energy_of(m, place, &l, lattice_stiffness(m, &l), weak, cosine, sine);
    }
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = stored_links(m, p->displacement, place, slot, half, own_bits(m, slot), 2, u);
      sum += energy_of(m, place, &l, stored_stiffness(m, place, &l), weak, cosine, sine);
    }
    lanes_store(energies + LANES * half,
                lanes_set(0.5) * lanes_load(p->volume + place) * sum); /* half is the other end's */
  }
}

/* ---- changes ---- */

/** Half a slice: what it has, its changes, and how what acts on it changes. */
typedef struct HalfChange {
  int64_t place;
  Lanes u[2], cosine, sine, v[2], spin;
  Lanes force[2], moment;
} HalfChange;

/** As the chord turns by t, end rotations change by the spins of the ends less t. */
LANES_INLINE void add_change(const Micropolar *m, const LinkLanes *l, StiffnessLanes stiffness,
                             const breccia_link *weak, HalfChange *own)
{
  double *const *v = m->particles->displacement;
  const Lanes nx = l->n[0], ny = l->n[1], ex = l->e[0], ey = l->e[1], yx = nx + ex, yy = ny + ey;
  const Lanes d = ex * (nx + yx) + ey * (ny + yy), g = shortening(d, RANGE_ANY), inverse = lanes_set(1) - g;
  const Lanes stretch = d * inverse - g - free_of(m, own->place, l), mx = yx * inverse, my = yy * inverse,
              over_length = l->by_length * inverse;
  const Lanes cosine = of_others(l, m->shown[0]), sine = of_others(l, m->shown[1]);
  const Lanes ax = own->cosine * nx - own->sine * ny, ay = own->sine * nx + own->cosine * ny;
  const Lanes bx = cosine * nx - sine * ny, by = sine * nx + cosine * ny;
  const Lanes here = mx * ay - my * ax, other = mx * by - my * bx;
  const Lanes sum = here * end_rotation(here * here, mx * ax + my * ay, true).factor +
                    other * end_rotation(other * other, mx * bx + my * by, true).factor;
  Lanes axial = stiffness.axial, bending = stiffness.bending;
  if (weak) {
    Lanes left[2];
    find_left(m, weak, own->place, l, stretch, &left[0], &left[1]);
    axial *= left[0];
    bending *= left[1];
  }
  const Lanes dx = lanes_intact(l->intact, l->half, of_others(l, v[0]) - own->v[0]),
              dy = lanes_intact(l->intact, l->half, of_others(l, v[1]) - own->v[1]);
  const Lanes along = mx * dx + my * dy, turn = (mx * dy - my * dx) * over_length;
  const Lanes a = own->spin - turn, b = of_others(l, v[ROTATION]) - turn;
  const Lanes six = lanes_set(6) * bending * over_length, shear = six * sum,
              shear_change = six * (a + b) - shear * along * over_length;
  const Lanes pull = axial * stretch, pull_change = axial * along * l->by_length;
  /* the chord changes by (-my, mx) turn */
  own->force[0] += (pull_change + shear * turn) * mx + (shear_change - pull * turn) * my;
  own->force[1] += (pull_change + shear * turn) * my - (shear_change - pull * turn) * mx;
  own->moment -= bending * (lanes_set(4) * a + lanes_set(2) * b);
}

static void resist_changes(const Micropolar *m, double *const *at, int64_t slice)
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    HalfChange own = {.place = place,
                      .cosine = lanes_load(m->shown[0] + place),
                      .sine = lanes_load(m->shown[1] + place),
                      .spin = lanes_load(p->displacement[ROTATION] + place),
                      .moment = {0}};
    for (int k = 0; k < 2; ++k) {
      own.u[k] = lanes_load(at[k] + place);
      own.v[k] = lanes_load(p->displacement[k] + place);
      own.force[k] = lanes_set(0);
    }
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
      const LinkLanes l = lattice_links(m, at, slot, half, 2, own.u);
      add_change(m, &l, lattice_stiffness(m, &l), weak, &own);
    }
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = stored_links(m, at, place, slot, half, own_bits(m, slot), 2, own.u);
      add_change(m, &l, stored_stiffness(m, place, &l), weak, &own);
    }
    lanes_store(p->internal[0] + place, own.force[0]);
    lanes_store(p->internal[1] + place, own.force[1]);
    lanes_store(p->internal[2] + place, lanes_set(0));
    lanes_store(p->internal[ROTATION] + place, own.moment);
  }
}

static void show(const Micropolar *m, double *const *at, int64_t first, int64_t last)
{
  const double *angle = at[ROTATION];
  for (int64_t place = first * SLICE; place < last * SLICE; place += LANES) {
    Lanes sine, cosine;
    lanes_sine_cosine(lanes_load(angle + place), &sine, &cosine);
    lanes_store(m->shown[0] + place, cosine);
    lanes_store(m->shown[1] + place, sine);
  }
}

const MicropolarSweeps LANES_NAMED(micropolar_plane) = {
    .resist = resist, .resist_changes = resist_changes, .store = store, .show = show};
