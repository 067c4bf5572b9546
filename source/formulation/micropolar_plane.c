/* Links of lattices in the plane, as many at a time as vectors have lanes. With the cosine and sine of each particle's rotation a link needs no trigonometry: the sine of
 * an end rotation is the cross product of the chord with where the section points, and the angle a series of it. */
#include "formulation/micropolar_lanes.h"

/** Arc sine. */
LANES_INLINE Lanes angle_of(Lanes sine)
{
  return sine + sine * angle_excess(sine * sine);
}

/** Half a slice: what it has, and what acts on it. */
typedef struct HalfSlice {
  int64_t place;
  Lanes u[2], cosine, sine;
  Lanes force[2], moment;
  LanesWithin within; /* the series */
} HalfSlice;

LANES_INLINE void add_link(const Micropolar *m, int64_t slot, int half, const breccia_link *weak, HalfSlice *own)
{
  const Family *f = m->family;
  double *const *u = m->particles->displacement;
  const LinkRow *row = &m->rows[f->pattern[slot]];
  const int64_t there = f->base[slot] + LANES * half;
  const Lanes nx = lanes_set(row->n[0]), ny = lanes_set(row->n[1]), by_length = lanes_set(row->by_length);
  /* all over the reference length; the ends of broken links may be so far apart that the series would be none */
  const Lanes ex = lanes_intact(f->intact[slot], half, lanes_load(u[0] + there) - own->u[0]) * by_length,
              ey = lanes_intact(f->intact[slot], half, lanes_load(u[1] + there) - own->u[1]) * by_length, yx = nx + ex,
              yy = ny + ey;
  const Lanes d = ex * (nx + yx) + ey * (ny + yy), g = shortening_series(d), inverse = lanes_set(1) - g;
  const Lanes stretch = d * inverse - g - free_of(m, own->place, there), mx = yx * inverse, my = yy * inverse;
  const Lanes cosine = lanes_load(m->shown[0] + there), sine = lanes_load(m->shown[1] + there);
  const Lanes ax = own->cosine * nx - own->sine * ny, ay = own->sine * nx + own->cosine * ny;
  const Lanes bx = cosine * nx - sine * ny, by = sine * nx + cosine * ny;
  const Lanes here = mx * ay - my * ax, other = mx * by - my * bx;
  const Lanes a = angle_of(here), b = angle_of(other), sum = a + b;
  Lanes axial = lanes_intact(f->intact[slot], half, lanes_set(row->axial)),
        bending = lanes_intact(f->intact[slot], half, lanes_set(row->bending));
  if (weak) {
    Lanes left[2];
    find_left(m, slot, half, weak, stretch, &left[0], &left[1]);
    axial *= left[0];
    bending *= left[1];
  }
  const Lanes pull = axial * stretch, shear = lanes_set(6) * bending * by_length * inverse * sum;
  own->within = links_within(own->within, f->intact[slot], half, d, mx * ax + my * ay, mx * bx + my * by);
  own->force[0] += pull * mx;
  own->force[0] += shear * my;
  own->force[1] += pull * my;
  own->force[1] -= shear * mx;
  own->moment -= bending * (sum + sum + (a + a));
}

static bool resist(const Micropolar *m, int64_t slice)
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
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) add_link(m, slot, half, weak, &own);
    if (!lanes_are_within(own.within)) return false;
    lanes_store(p->internal[0] + place, own.force[0]);
    lanes_store(p->internal[1] + place, own.force[1]);
    lanes_store(p->internal[2] + place, lanes_set(0));
    lanes_store(p->internal[ROTATION] + place, own.moment);
  }
  return true;
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

const MicropolarSweeps LANES_NAMED(micropolar_plane) = {.resist = resist, .show = show};
