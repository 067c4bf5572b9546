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
  Lanes u[3], q[4], turned[3][3]; /* quaternion, and its matrix */
  Lanes force[3], moment[3];
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

/** @param[in] any  of any end rotations, or within the series @param[out] cosine  of both end rotations */
LANES_INLINE Spins spins_of(const HalfSlice *own, const Lanes q[4], const Lanes n[3], const Lanes chord[3],
                            const StiffnessLanes *stiffness, bool any, Lanes cosine[2])
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
  const Lanes twice = stiffness->bending + stiffness->bending, by_f = twice * f, by_g = twice * g;
  /* this end by b and d, then the other by d and b */
  const Lanes bs = by_f + by_f + bend * by_g * bd, ds = by_g * (one - bend * bb);
  const Lanes db = by_g + by_g + other * by_f * bd, bo = by_f * (one - other * dd);
  for (int k = 0; k < 3; ++k) {
    s.own[k] = bs * b[k] + ds * d[k];
    s.both[k] = (bs + bo) * b[k] + (ds + db) * d[k];
  }
  Lanes along = by_f * g * dot_lanes(a, d);
  if (stiffness->twists) {
    Lanes r[4], across[3];
    twist_of(own->q, q, r);
    const Lanes psi = dot_lanes(chord, r + 1), torque = stiffness->twist * (psi + psi);
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

/** Takes in some lanes what holds of any end rotations. Out of line, as few links need it. @param[in] far  where ends have turned too far for the series */
static __attribute__((noinline)) void take_far_spins(const HalfSlice *own, const Lanes q[4], const Lanes n[3],
                                                     const Lanes chord[3], const StiffnessLanes *stiffness,
                                                     const LaneMask *far, Spins *s)
{
  Lanes cosine[2];
  const Spins any = spins_of(own, q, n, chord, stiffness, true, cosine);
  for (int k = 0; k < 3; ++k) {
    s->own[k] = lanes_choose(*far, any.own[k], s->own[k]);
    s->both[k] = lanes_choose(*far, any.both[k], s->both[k]);
  }
}

LANES_INLINE void add_link(const Micropolar *m, const LinkLanes *l, StiffnessLanes stiffness, const breccia_link *weak,
                           HalfSlice *own)
{
  const ChordLanes chord = chords_of(m, l, 3);
  weaken(m, weak, l, chord.stretch, &stiffness);
  const Lanes pull = stiffness.axial * chord.stretch;
  for (int k = 0; k < 3; ++k) own->force[k] += pull * chord.m[k];
  if (!stiffness.bends) return;
  Lanes q[4], across[3], cosine[2];
  turns_of_others(m, l, 4, q);
  Spins s = spins_of(own, q, l->n, chord.m, &stiffness, false, cosine);
  const LaneMask far = turned_far(stiffness.bending, cosine[0], cosine[1]);
  if (lanes_any(far)) { /* copies, so that what is summed stays in registers */
    const HalfSlice end = *own;
    const ChordLanes present = chord;
    const StiffnessLanes left = stiffness;
    const LaneMask where = far;
    Lanes n[3];
    Spins any = s;
    for (int k = 0; k < 3; ++k) n[k] = l->n[k];
    take_far_spins(&end, q, n, present.m, &left, &where, &any);
    s = any;
  }
  const Lanes by_present = l->by_length * chord.inverse;
  cross_lanes(chord.m, s.both, across);
  for (int k = 0; k < 3; ++k) {
    own->force[k] += by_present * across[k];
    own->moment[k] -= s.own[k];
  }
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

/** Both kinds of slots have a loop of their own, as in the plane (micropolar_plane.c). */
static void resist(const Micropolar *m, const Sweep *sweep, int64_t slice)
{
  const Family *f = m->family;
  double *const *u = sweep->displacement;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    HalfSlice own;
    for (int k = 0; k < 3; ++k) {
      own.u[k] = lanes_load(u[k] + place);
      own.force[k] = own.moment[k] = lanes_set(0);
    }
    for (int k = 0; k < 4; ++k) own.q[k] = lanes_load(m->shown[k] + place);
    find_matrix(&own);
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
      const LinkLanes l = lattice_links(m, u, place, slot, half, 3, own.u);
      add_link(m, &l, lattice_stiffness(m, &l), weak, &own);
    }
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = stored_links(m, place, slot, half, own_bits(m, slice, slot), 3, own.u);
      add_link(m, &l, stored_stiffness(m, &l), weak, &own);
    }
    for (int k = 0; k < 3; ++k) {
      lanes_store(sweep->internal[k] + place, own.force[k]);
      lanes_store(sweep->internal[micropolar_rotation(m) + k] + place, own.moment[k]);
    }
  }
}

/* ---- energies ---- */

/** Rotation of an end from the chord. */
LANES_INLINE void find_rotation(const Lanes q[4], const Lanes n[3], const Lanes chord[3], Lanes rotation[3])
{
  Lanes a[3];
  turn_lanes(q, n, a);
  cross_lanes(chord, a, rotation);
  const Lanes factor = end_rotation(dot_lanes(rotation, rotation), dot_lanes(chord, a), true).factor;
  for (int k = 0; k < 3; ++k) rotation[k] *= factor;
}

/** Energy of links per volume of this end, times the weights of the bonds. */
LANES_INLINE Lanes energy_of(const Micropolar *m, const LinkLanes *l, StiffnessLanes stiffness,
                             const breccia_link *weak, const Lanes own[4])
{
  const ChordLanes chord = chords_of(m, l, 3);
  weaken(m, weak, l, chord.stretch, &stiffness);
  const Lanes energy = lanes_set(0.5) * stiffness.axial * chord.stretch * chord.stretch / l->by_length;
  if (!stiffness.bends) return energy;
  Lanes q[4], a[3], b[3], r[4];
  turns_of_others(m, l, 4, q);
  find_rotation(own, l->n, chord.m, a);
  find_rotation(q, l->n, chord.m, b);
  twist_of(own, q, r);
  const Lanes psi = lanes_set(2) * dot_lanes(chord.m, r + 1);
  return energy + lanes_set(2) * stiffness.bending * (dot_lanes(a, a) + dot_lanes(a, b) + dot_lanes(b, b)) +
         lanes_set(0.5) * stiffness.twist * psi * psi;
}

static void store(const Micropolar *m, int64_t slice, double energies[SLICE])
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    Lanes u[3], q[4], sum = lanes_set(0);
    for (int k = 0; k < 3; ++k) u[k] = lanes_load(p->displacement.row[k] + place);
    for (int k = 0; k < 4; ++k) q[k] = lanes_load(m->shown[k] + place);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = links_of(m, p->displacement.row, slice, slot, half, own_bits(m, slice, slot), 3, u);
      sum += energy_of(m, &l, stiffness_of_links(m, &l), weak, q);
    }
    lanes_store(energies + LANES * half,
                lanes_set(0.5) * lanes_load(p->volume + place) * sum); /* half is the other end's */
  }
}

/* ---- changes: as micropolar_linear.c does for a link ---- */

/** Half a slice: what it has, its changes, and how what acts on it changes. */
typedef struct HalfChange {
  Lanes u[3], q[4], v[3], spin[3];
  Lanes force[3], moment[3];
} HalfChange;

/** An end as LinkEnd, and its change. */
typedef struct EndChange {
  Lanes a[3], b[3], cosine, rotation[3], factor, bend;
  Lanes a_change[3], b_change[3], cosine_change, rotation_change[3], factor_change, bend_change;
} EndChange;

LANES_INLINE EndChange change_end(const Lanes q[4], const Lanes n[3], const Lanes chord[3], const Lanes chord_change[3],
                                  const Lanes spin[3])
{
  EndChange e;
  Lanes turned[3], carried[3];
  turn_lanes(q, n, e.a);
  cross_lanes(chord, e.a, e.b);
  e.cosine = dot_lanes(chord, e.a);
  const Lanes x = dot_lanes(e.b, e.b), zero = lanes_set(0), two = lanes_set(2);
  const EndLanes of = end_rotation(x, e.cosine, true);
  e.factor = of.factor;
  e.bend = of.bend;
  cross_lanes(spin, e.a, e.a_change);
  cross_lanes(chord_change, e.a, turned);
  cross_lanes(chord, e.a_change, carried);
  e.cosine_change = dot_lanes(chord_change, e.a) + dot_lanes(chord, e.a_change);
  e.factor_change = -e.bend * e.cosine_change;
  const LaneMask small = (LaneMask)(x < lanes_set(1e-3)) & ~(LaneMask)(e.cosine < zero);
  const Lanes series = lanes_set(16.0 / 105) * x + lanes_set(16.0 / 105),
              near = -two * e.cosine * (lanes_set(2.0 / 15) + x * series),
              far = (lanes_set(3) * e.cosine * e.bend - e.factor) / lanes_choose(small, lanes_set(1), x);
  e.bend_change = e.cosine_change * lanes_choose(small, near, far);
  for (int k = 0; k < 3; ++k) {
    e.b_change[k] = turned[k] + carried[k];
    e.rotation[k] = e.factor * e.b[k];
    e.rotation_change[k] = e.factor_change * e.b[k] + e.factor * e.b_change[k];
  }
  return e;
}

/** Adds derivatives of the energy by the chord, and their changes. */
LANES_INLINE void add_by_chord(const EndChange *e, const Lanes moment[3], const Lanes moment_change[3],
                               Lanes by_chord[2][3])
{
  const Lanes along = dot_lanes(e->b, moment),
              along_change = dot_lanes(e->b_change, moment) + dot_lanes(e->b, moment_change);
  Lanes arm[3], turned[3], carried[3];
  cross_lanes(e->a, moment, arm);
  cross_lanes(e->a_change, moment, turned);
  cross_lanes(e->a, moment_change, carried);
  for (int k = 0; k < 3; ++k) {
    by_chord[0][k] += e->factor * arm[k] - e->bend * along * e->a[k];
    by_chord[1][k] += e->factor_change * arm[k] + e->factor * (turned[k] + carried[k]) -
                      (e->bend_change * along + e->bend * along_change) * e->a[k] - e->bend * along * e->a_change[k];
  }
}

/** Adds how the derivative by the spin of an end changes. */
LANES_INLINE void add_by_spin(const EndChange *e, const Lanes chord[3], const Lanes chord_change[3],
                              const Lanes moment[3], const Lanes moment_change[3], Lanes by_spin[3])
{
  const Lanes along = dot_lanes(e->b, moment), off = dot_lanes(e->a, moment),
              along_change = dot_lanes(e->b_change, moment) + dot_lanes(e->b, moment_change),
              off_change = dot_lanes(e->a_change, moment) + dot_lanes(e->a, moment_change);
  const Lanes of_b = e->bend_change * along + e->bend * along_change, of_b_change = e->bend * along,
              of_moment = e->factor_change * e->cosine + e->factor * e->cosine_change,
              of_moment_change = e->factor * e->cosine, of_chord = e->factor_change * off + e->factor * off_change,
              of_chord_change = e->factor * off;
  for (int k = 0; k < 3; ++k)
    by_spin[k] += of_b * e->b[k] + of_b_change * e->b_change[k] + of_moment * moment[k] +
                  of_moment_change * moment_change[k] - of_chord * chord[k] - of_chord_change * chord_change[k];
}

/** @param[in] spins  of this end and the other */
LANES_INLINE void add_twist_change(const Lanes own[4], const Lanes q[4], const Lanes chord[3],
                                   const Lanes chord_change[3], const Lanes spins[2][3], Lanes twist,
                                   Lanes by_chord[2][3], Lanes by_spin[3])
{
  Lanes r[4], apart[3], sum[3], turned[3], change[4], across[3], first[3], second[3];
  const Lanes half = lanes_set(0.5), twice = twist + twist;
  twist_of(own, q, r);
  for (int k = 0; k < 3; ++k) {
    apart[k] = spins[1][k] - spins[0][k];
    sum[k] = spins[1][k] + spins[0][k];
  }
  cross_lanes(sum, r + 1, turned);
  change[0] = -half * dot_lanes(apart, r + 1);
  for (int k = 0; k < 3; ++k) change[1 + k] = half * (r[0] * apart[k] + turned[k]);
  const Lanes torque = twice * dot_lanes(chord, r + 1),
              torque_change = twice * (dot_lanes(chord_change, r + 1) + dot_lanes(chord, change + 1));
  cross_lanes(r + 1, chord, across);
  cross_lanes(change + 1, chord, first);
  cross_lanes(r + 1, chord_change, second);
  for (int k = 0; k < 3; ++k) {
    const Lanes along = r[0] * chord[k], along_change = change[0] * chord[k] + r[0] * chord_change[k];
    by_chord[0][k] += (torque + torque) * r[1 + k];
    by_chord[1][k] += lanes_set(2) * (torque_change * r[1 + k] + torque * change[1 + k]);
    by_spin[k] += torque_change * (across[k] - along) + torque * (first[k] + second[k] - along_change);
  }
}

LANES_INLINE void add_change(const Micropolar *m, double *const *v, const LinkLanes *l, StiffnessLanes stiffness,
                             const breccia_link *weak, HalfChange *own)
{
  const ChordLanes links = chords_of(m, l, 3);
  const Lanes *chord = links.m, stretch = links.stretch, over_length = l->by_length * links.inverse;
  Lanes chord_change[3], apart[3];
  for (int k = 0; k < 3; ++k) apart[k] = lanes_intact(l->intact, l->half, of_others(l, v[k]) - own->v[k]);
  const Lanes grown = dot_lanes(chord, apart);
  for (int k = 0; k < 3; ++k) chord_change[k] = (apart[k] - grown * chord[k]) * over_length;
  weaken(m, weak, l, stretch, &stiffness);
  for (int k = 0; k < 3; ++k)
    own->force[k] += stiffness.axial * (grown * l->by_length * chord[k] + stretch * chord_change[k]);
  if (!stiffness.bends) return;
  Lanes q[4], spins[2][3], by_chord[2][3], by_spin[3];
  turns_of_others(m, l, 4, q);
  for (int k = 0; k < 3; ++k) {
    spins[0][k] = own->spin[k];
    spins[1][k] = of_others(l, m->spin[k]);
    by_chord[0][k] = by_chord[1][k] = by_spin[k] = lanes_set(0);
  }
  const EndChange ends[2] = {change_end(own->q, l->n, chord, chord_change, spins[0]),
                             change_end(q, l->n, chord, chord_change, spins[1])};
  const Lanes twice = stiffness.bending + stiffness.bending;
  for (int e = 0; e < 2; ++e) {
    Lanes moment[3], moment_change[3];
    for (int k = 0; k < 3; ++k) {
      const EndChange *here = &ends[e], *other = &ends[1 - e];
      moment[k] = twice * (here->rotation[k] + here->rotation[k] + other->rotation[k]);
      moment_change[k] = twice * (here->rotation_change[k] + here->rotation_change[k] + other->rotation_change[k]);
    }
    add_by_chord(&ends[e], moment, moment_change, by_chord);
    if (e == 0) add_by_spin(&ends[e], chord, chord_change, moment, moment_change, by_spin);
  }
  if (stiffness.twists) add_twist_change(own->q, q, chord, chord_change, spins, stiffness.twist, by_chord, by_spin);
  const Lanes along = dot_lanes(chord, by_chord[0]),
              along_change = dot_lanes(chord_change, by_chord[0]) + dot_lanes(chord, by_chord[1]);
  for (int k = 0; k < 3; ++k) {
    const Lanes across = by_chord[0][k] - along * chord[k],
                across_change = by_chord[1][k] - along * chord_change[k] - along_change * chord[k];
    own->force[k] += (across_change - across * grown * over_length) * over_length;
    own->moment[k] -= by_spin[k];
  }
}

static void resist_changes(const Micropolar *m, const Sweep *sweep, int64_t slice)
{
  const Family *f = m->family;
  double *const *at = sweep->linearised_at, *const *v = sweep->displacement;
  const breccia_link *weak = weakened_by(m, slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    HalfChange own;
    for (int k = 0; k < 3; ++k) {
      own.u[k] = lanes_load(at[k] + place);
      own.v[k] = lanes_load(v[k] + place);
      own.spin[k] = lanes_load(m->spin[k] + place);
      own.force[k] = own.moment[k] = lanes_set(0);
    }
    for (int k = 0; k < 4; ++k) own.q[k] = lanes_load(m->shown[k] + place);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = links_of(m, at, slice, slot, half, own_bits(m, slice, slot), 3, own.u);
      add_change(m, v, &l, stiffness_of_links(m, &l), weak, &own);
    }
    for (int k = 0; k < 3; ++k) {
      lanes_store(sweep->internal[k] + place, own.force[k]);
      lanes_store(sweep->internal[micropolar_rotation(m) + k] + place, own.moment[k]);
    }
  }
}

/** As find_spin of micropolar_linear.c. */
static void show_spins(const Micropolar *m, const Sweep *sweep)
{
  double *const *at = sweep->linearised_at, *const *v = sweep->displacement;
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; place += LANES) {
    Lanes held[3], spin[3], once[3], twice[3], sine, cosine;
    for (int k = 0; k < 3; ++k) {
      held[k] = lanes_load(at[micropolar_rotation(m) + k] + place);
      spin[k] = lanes_load(v[micropolar_rotation(m) + k] + place);
    }
    const Lanes square = dot_lanes(held, held), angle = lanes_root(square), one = lanes_set(1);
    const LaneMask small = (LaneMask)(angle < lanes_set(1e-3));
    const Lanes safe = lanes_choose(small, one, square), safe_angle = lanes_choose(small, one, angle);
    lanes_sine_cosine(angle, &sine, &cosine);
    cross_lanes(held, spin, once);
    cross_lanes(held, once, twice);
    const Lanes a = lanes_choose(small, lanes_set(0.5) - square * lanes_set(1.0 / 24), (one - cosine) / safe),
                b = lanes_choose(small, lanes_set(1.0 / 6) - square * lanes_set(1.0 / 120),
                                 (angle - sine) / (safe * safe_angle));
    for (int k = 0; k < 3; ++k) lanes_store(m->spin[k] + place, spin[k] + a * once[k] + b * twice[k]);
  }
}

static void show(const Micropolar *m, double *const *at, int64_t first, int64_t last)
{
  Lanes q[4];
  for (int64_t place = first * SLICE; place < last * SLICE; place += LANES) {
    turned_by(m->particles->orientation, at + micropolar_rotation(m), place, q);
    for (int k = 0; k < 4; ++k) lanes_store(m->shown[k] + place, q[k]);
  }
  for (int64_t place = first * SLICE; place < last * SLICE && m->record; ++place) show_record(m, at, place);
}

const MicropolarSweeps LANES_NAMED(micropolar_space) = {
    .resist = resist, .resist_changes = resist_changes, .store = store, .show_spins = show_spins, .show = show};
