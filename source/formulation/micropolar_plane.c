/* Links of lattices in the plane, as many at a time as vectors have lanes. With the cosine and sine of each particle's rotation a link needs no trigonometry: the sine of
 * an end rotation is the cross product of the chord with where the section points, and the angle a series of it. */
#include "formulation/micropolar_lanes.h"

/** End rotations from the chord. */
typedef struct AngleLanes {
  Lanes here, other;
} AngleLanes;

/** @param[in] cosine, sine  of the rotation of this end @param[in] bending  stiffness of the links */
LANES_INLINE AngleLanes angles_of(const Micropolar *m, const LinkLanes *l, const ChordLanes *chord, Lanes cosine,
                                  Lanes sine, Lanes bending)
{
  const Lanes nx = l->n[0], ny = l->n[1], mx = chord->m[0], my = chord->m[1];
  Lanes far[QUAD];
  turns_of_others(m, l, 2, far);
  const Lanes far_cosine = far[0], far_sine = far[1];
  const Lanes ax = cosine * nx - sine * ny, ay = sine * nx + cosine * ny;
  const Lanes bx = far_cosine * nx - far_sine * ny, by = far_sine * nx + far_cosine * ny;
  const Lanes here = mx * ay - my * ax, other = mx * by - my * bx;
  const Lanes here_cosine = mx * ax + my * ay, other_cosine = mx * bx + my * by;
  Lanes factor = end_rotation(here * here, here_cosine, false).factor,
        other_factor = end_rotation(other * other, other_cosine, false).factor;
  const LaneMask beyond = turned_far(bending, here_cosine, other_cosine);
  if (lanes_any(beyond)) {
    factor = lanes_choose(beyond, end_rotation(here * here, here_cosine, true).factor, factor);
    other_factor = lanes_choose(beyond, end_rotation(other * other, other_cosine, true).factor, other_factor);
  }
  return (AngleLanes){here * factor, other * other_factor};
}

/** Half a slice: what it has, and what acts on it. */
typedef struct HalfSlice {
  Lanes u[2], cosine, sine;
  Lanes force[2], moment;
} HalfSlice;

LANES_INLINE void add_link(const Micropolar *m, const LinkLanes *l, StiffnessLanes stiffness, const breccia_link *weak,
                           HalfSlice *own)
{
  const ChordLanes chord = chords_of(m, l, 2);
  weaken(m, weak, l, chord.stretch, &stiffness);
  const AngleLanes angles = angles_of(m, l, &chord, own->cosine, own->sine, stiffness.bending);
  const Lanes sum = angles.here + angles.other, pull = stiffness.axial * chord.stretch,
              shear = lanes_set(6) * stiffness.bending * l->by_length * chord.inverse * sum;
  own->force[0] += pull * chord.m[0];
  own->force[0] += shear * chord.m[1];
  own->force[1] += pull * chord.m[1];
  own->force[1] -= shear * chord.m[0];
  own->moment -= stiffness.bending * (sum + sum + (angles.here + angles.here));
}

/** Both kinds of slots have a loop of their own: in one loop for both, forces take 1.5 to 2 times as long, as vectors of it go through memory. */
static void resist(const Micropolar *m, const Sweep *sweep, int64_t slice)
{
  const Family *f = m->family;
  double *const *u = sweep->displacement;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    HalfSlice own = {.u = {lanes_load(u[0] + place), lanes_load(u[1] + place)},
                     .cosine = lanes_load(m->shown[0] + place),
                     .sine = lanes_load(m->shown[1] + place),
                     .moment = {0}};
    own.force[0] = own.force[1] = lanes_set(0);
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
      const LinkLanes l = lattice_links(m, u, place, slot, half, 2, own.u);
      add_link(m, &l, lattice_stiffness(m, &l), weak, &own);
    }
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = stored_links(m, place, slot, half, own_bits(m, slice, slot), 2, own.u);
      add_link(m, &l, stored_stiffness(m, &l), weak, &own);
    }
    lanes_store(sweep->internal[0] + place, own.force[0]);
    lanes_store(sweep->internal[1] + place, own.force[1]);
    lanes_store(sweep->internal[2] + place, lanes_set(0));
    lanes_store(sweep->internal[micropolar_rotation(m)] + place, own.moment);
  }
}

/* ---- energies ---- */

static void store(const Micropolar *m, int64_t slice, double energies[SLICE])
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    const Lanes u[2] = {lanes_load(p->displacement.row[0] + place), lanes_load(p->displacement.row[1] + place)},
                cosine = lanes_load(m->shown[0] + place), sine = lanes_load(m->shown[1] + place);
    Lanes sum = lanes_set(0); /* per volume of this end, times the weights of the bonds */
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = links_of(m, p->displacement.row, slice, slot, half, own_bits(m, slice, slot), 2, u);
      const ChordLanes chord = chords_of(m, &l, 2);
      StiffnessLanes stiffness = stiffness_of_links(m, &l);
      weaken(m, weak, &l, chord.stretch, &stiffness);
      const AngleLanes angles = angles_of(m, &l, &chord, cosine, sine, stiffness.bending);
      const Lanes a = angles.here, b = angles.other;
      sum += lanes_set(0.5) * stiffness.axial * chord.stretch * chord.stretch / l.by_length +
             lanes_set(2) * stiffness.bending * (a * a + a * b + b * b);
    }
    lanes_store(energies + LANES * half,
                lanes_set(0.5) * lanes_load(p->volume + place) * sum); /* half is the other end's */
  }
}

/* ---- changes ---- */

/** Half a slice: what it has, its changes, and how what acts on it changes. */
typedef struct HalfChange {
  Lanes u[2], cosine, sine, v[2], spin;
  Lanes force[2], moment;
} HalfChange;

/** As the chord turns by t, end rotations change by the spins of the ends less t. */
LANES_INLINE void add_change(const Micropolar *m, double *const *v, const LinkLanes *l, StiffnessLanes stiffness,
                             const breccia_link *weak, HalfChange *own)
{
  const ChordLanes chord = chords_of(m, l, 2);
  weaken(m, weak, l, chord.stretch, &stiffness);
  const AngleLanes angles = angles_of(m, l, &chord, own->cosine, own->sine, stiffness.bending);
  const Lanes mx = chord.m[0], my = chord.m[1], over_length = l->by_length * chord.inverse;
  const Lanes dx = lanes_intact(l->intact, l->half, of_others(l, v[0]) - own->v[0]),
              dy = lanes_intact(l->intact, l->half, of_others(l, v[1]) - own->v[1]);
  const Lanes along = mx * dx + my * dy, turn = (mx * dy - my * dx) * over_length;
  const Lanes a = own->spin - turn, b = of_others(l, v[micropolar_rotation(m)]) - turn;
  const Lanes six = lanes_set(6) * stiffness.bending * over_length, shear = six * (angles.here + angles.other),
              shear_change = six * (a + b) - shear * along * over_length;
  const Lanes pull = stiffness.axial * chord.stretch, pull_change = stiffness.axial * along * l->by_length;
  /* the chord changes by (-my, mx) turn */
  own->force[0] += (pull_change + shear * turn) * mx + (shear_change - pull * turn) * my;
  own->force[1] += (pull_change + shear * turn) * my - (shear_change - pull * turn) * mx;
  own->moment -= stiffness.bending * (lanes_set(4) * a + lanes_set(2) * b);
}

static void resist_changes(const Micropolar *m, const Sweep *sweep, int64_t slice)
{
  const Family *f = m->family;
  double *const *at = sweep->linearised_at, *const *v = sweep->displacement;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    HalfChange own = {.cosine = lanes_load(m->shown[0] + place),
                      .sine = lanes_load(m->shown[1] + place),
                      .spin = lanes_load(v[micropolar_rotation(m)] + place),
                      .moment = {0}};
    for (int k = 0; k < 2; ++k) {
      own.u[k] = lanes_load(at[k] + place);
      own.v[k] = lanes_load(v[k] + place);
      own.force[k] = lanes_set(0);
    }
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = links_of(m, at, slice, slot, half, own_bits(m, slice, slot), 2, own.u);
      add_change(m, v, &l, stiffness_of_links(m, &l), weak, &own);
    }
    lanes_store(sweep->internal[0] + place, own.force[0]);
    lanes_store(sweep->internal[1] + place, own.force[1]);
    lanes_store(sweep->internal[2] + place, lanes_set(0));
    lanes_store(sweep->internal[micropolar_rotation(m)] + place, own.moment);
  }
}

static void show(const Micropolar *m, double *const *at, int64_t first, int64_t last)
{
  const double *angle = at[micropolar_rotation(m)];
  for (int64_t place = first * SLICE; place < last * SLICE; place += LANES) {
    Lanes sine, cosine;
    lanes_sine_cosine(lanes_load(angle + place), &sine, &cosine);
    lanes_store(m->shown[0] + place, cosine);
    lanes_store(m->shown[1] + place, sine);
  }
  for (int64_t place = first * SLICE; place < last * SLICE && m->record; ++place) show_record(m, at, place);
}

const MicropolarSweeps LANES_NAMED(micropolar_plane) = {
    .resist = resist, .resist_changes = resist_changes, .store = store, .show = show};
