/* Links of lattices in space, as many at a time as vectors have lanes (docs/theory.md 6.4). With the quaternion of each particle a link needs no trigonometry: squares of the sines of
 * end rotations are b . b, and the angles series of them. Derivatives by the spins of the ends are written in b_i = m x a_i; with f = t / sin t,
 * k = (1 - t cot t) / sin^2 t and t cot t = 1 - k b . b, that of bending by the spin of the first end is
 *   S_1 = B ((4 f_1 + 2 k_1 f_2 b_1 . b_2) b_1 + 2 f_2 (1 - k_1 b_1 . b_1) b_2 - 2 f_1 f_2 (a_1 . b_2) m),
 * and as nothing changes when all turn together, the force across the chord is m x (S_1 + S_2) / |y|: 200 operations for a vector of links instead of
 * calls for each. */
#include "body/orientation.h"
#include "formulation/micropolar_lanes.h"

/** Half a slice: what it has, and what acts on it. */
typedef struct HalfSlice {
  int64_t place;
  Lanes u[3], q[4], turned[3][3]; /* quaternion, and its matrix */
  Lanes force[3], moment[3];
  LanesWithin within; /* the series */
} HalfSlice;

/** R n. */
LANES_INLINE void turn_lanes(const Lanes q[4], const Lanes n[3], Lanes a[3])
{
  Lanes once[3], twice[3];
  cross_lanes(q + 1, n, once);
  cross_lanes(q + 1, once, twice);
  for (int k = 0; k < 3; ++k) {
    const Lanes half = q[0] * once[k] + twice[k];
    a[k] = n[k] + (half + half);
  }
}

/** Quaternion of the rotation from this end to the other, by the shorter way. */
LANES_INLINE void twist_of(const Lanes a[4], const Lanes b[4], Lanes r[4])
{
  r[0] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  cross_lanes(a + 1, b + 1, r + 1);
  const LaneMask sign = (LaneMask)r[0] & (LaneMask)lanes_set(-0.0);
  for (int k = 1; k < 4; ++k) r[k] = (Lanes)((LaneMask)(r[k] + (a[0] * b[k] - b[0] * a[k])) ^ sign);
  r[0] = lanes_absolute(r[0]);
}

/** Derivatives of the energy of bending and torsion: by the spin of this end, and by both together but for what is along the chord. */
typedef struct Spins {
  Lanes own[3], both[3];
} Spins;

LANES_INLINE Spins spins_of(const HalfSlice *own, const Lanes q[4], const Lanes n[3], const Lanes chord[3],
                            Lanes bending, Lanes twist, bool twists, bool any, Lanes cosine[2])
{
  Lanes a[3], c[3], b[3], d[3]; /* where the sections of this end and the other point, and the chord x these */
  Spins s;
  for (int k = 0; k < 3; ++k) a[k] = own->turned[k][0] * n[0] + own->turned[k][1] * n[1] + own->turned[k][2] * n[2];
  turn_lanes(q, n, c);
  cross_lanes(chord, a, b);
  cross_lanes(chord, c, d);
  const Lanes bb = dot_lanes(b, b), dd = dot_lanes(d, d), bd = dot_lanes(b, d), one = lanes_set(1);
  cosine[0] = dot_lanes(chord, a);
  cosine[1] = dot_lanes(chord, c);
  const EndLanes ends[2] = {end_rotation(bb, cosine[0], any), end_rotation(dd, cosine[1], any)};
  const Lanes f = ends[0].factor, g = ends[1].factor, bend = ends[0].bend, other = ends[1].bend;
  const Lanes twice = bending + bending, by_f = twice * f, by_g = twice * g;
  /* this end by b and d, then the other by d and b */
  const Lanes bs = by_f + by_f + bend * by_g * bd, ds = by_g * (one - bend * bb);
  const Lanes db = by_g + by_g + other * by_f * bd, bo = by_f * (one - other * dd);
  for (int k = 0; k < 3; ++k) {
    s.own[k] = bs * b[k] + ds * d[k];
    s.both[k] = (bs + bo) * b[k] + (ds + db) * d[k];
  }
  Lanes along = by_f * g * dot_lanes(a, d);
  if (twists) {
    Lanes r[4], across[3];
    twist_of(own->q, q, r);
    const Lanes psi = dot_lanes(chord, r + 1), torque = twist * (psi + psi);
    cross_lanes(r + 1, chord, across);
    for (int k = 0; k < 3; ++k) {
      const Lanes part = torque * across[k];
      s.own[k] += part;
      s.both[k] += part + part;
    }
    along += torque * r[0];
  }
  for (int k = 0; k < 3; ++k) s.own[k] -= along * chord[k];
  return s;
}

/** @param[in] bends, twists  whether some of the links do */
LANES_INLINE void add_link(const Micropolar *m, const LinkLanes *l, StiffnessLanes stiffness, const breccia_link *weak,
                           bool bends, bool twists, bool any, HalfSlice *own)
{
  Lanes chord[3], d = lanes_set(0);
  for (int k = 0; k < 3; ++k) {
    chord[k] = l->n[k] + l->e[k];
    d += l->e[k] * (l->n[k] + chord[k]);
  }
  const Lanes g = shortening(d, any ? RANGE_ANY : RANGE_SERIES), inverse = lanes_set(1) - g,
              stretch = d * inverse - g - free_of(m, own->place, l);
  for (int k = 0; k < 3; ++k) chord[k] *= inverse;
  Lanes cosine[2] = {lanes_set(1), lanes_set(1)};
  Lanes left[2] = {lanes_set(1), lanes_set(1)};
  if (weak) find_left(m, weak, own->place, l, stretch, &left[0], &left[1]);
  const Lanes pull = stiffness.axial * left[0] * stretch;
  for (int k = 0; k < 3; ++k) own->force[k] += pull * chord[k];
  if (bends) {
    const Lanes q[4] = {of_others(l, m->shown[0]), of_others(l, m->shown[1]), of_others(l, m->shown[2]),
                        of_others(l, m->shown[3])};
    const Spins s =
        spins_of(own, q, l->n, chord, stiffness.bending * left[1], stiffness.twist * left[1], twists, any, cosine);
    const Lanes by_present = l->by_length * inverse;
    Lanes across[3];
    cross_lanes(chord, s.both, across);
    for (int k = 0; k < 3; ++k) {
      own->force[k] += by_present * across[k];
      own->moment[k] -= s.own[k];
    }
  }
  if (!any) own->within = links_within(own->within, l, d, cosine[0], cosine[1]);
}

/** The matrix of the own quaternion, as every link of the half slice turns its direction by it. */
LANES_INLINE void find_matrix(HalfSlice *own)
{
  for (int c = 0; c < 3; ++c) {
    Lanes axis[3] = {lanes_set(c == 0), lanes_set(c == 1), lanes_set(c == 2)}, column[3];
    turn_lanes(own->q, axis, column);
    for (int k = 0; k < 3; ++k) own->turned[k][c] = column[k];
  }
}

/** @param[in] any  of any stretches and rotations, or within the series @return whether they were within them */
LANES_INLINE bool sweep(const Micropolar *m, int64_t slice, bool any)
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    HalfSlice own = {.place = place, .within = lanes_all_within()};
    for (int k = 0; k < 3; ++k) {
      own.u[k] = lanes_load(p->displacement[k] + place);
      own.force[k] = own.moment[k] = lanes_set(0);
    }
    for (int k = 0; k < 4; ++k) own.q[k] = lanes_load(m->shown[k] + place);
    find_matrix(&own);
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
      const LinkRow *row = &m->rows[f->pattern[slot]];
      const LinkLanes l = lattice_links(m, slot, half, 3, own.u);
      add_link(m, &l, lattice_stiffness(m, &l), weak, row->bending > 0, row->twist > 0, any, &own);
    }
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = stored_links(m, place, slot, half, own_bits(m, slot), 3, own.u);
      add_link(m, &l, stored_stiffness(m, place, &l), weak, true, true, any, &own);
    }
    if (!any && !lanes_are_within(own.within)) return false;
    for (int k = 0; k < 3; ++k) {
      lanes_store(p->internal[k] + place, own.force[k]);
      lanes_store(p->internal[ROTATION + k] + place, own.moment[k]);
    }
  }
  return true;
}

static void resist(const Micropolar *m, int64_t slice)
{
  if (!sweep(m, slice, false)) sweep(m, slice, true);
}

static void show(const Micropolar *m, double *const *at, int64_t first, int64_t last)
{
  Lanes q[4];
  for (int64_t place = first * SLICE; place < last * SLICE; place += LANES) {
    turned_by(m->particles->orientation, at, place, q);
    for (int k = 0; k < 4; ++k) lanes_store(m->shown[k] + place, q[k]);
  }
}

const MicropolarSweeps LANES_NAMED(micropolar_space) = {.resist = resist, .show = show};
