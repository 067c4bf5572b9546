/* Strain increments of the multi-yield-surface law. Nested cylinders in deviatoric stress space; the active one moves by Mroz' rule
 * towards the next and never crosses it. The scheme is the explicit one of the OpenSees class PressureIndependMultiYield, so that
 * results can be compared to the last digits; it depends (weakly) on the size of the strain increments. The tangent is the
 * derivative of the whole scheme, carried along with it.
 *
 * Four points go side by side, each under its own mask: a point's numbers do not depend on the points beside it. One by one a flowing point
 * took 120 to 160 ns, most of it waiting for roots and quotients.
 *
 * A point loads for many steps on one surface, so only centres that an update moved are copied from the committed row to its
 * twin: copying all of them took 70 ns more. */
#include "constitutive/solid/multi_yield.h"

#include "base/lanes.h"
#include "base/tensor.h"

#include <stdbool.h>

/** Deviatoric tensors of four points; shear components as of a tensor. */
typedef struct Tensors {
  Lanes at[6];
} Tensors;

/** Derivatives to the six strains, of s and of the active centre. */
typedef struct Slopes {
  Tensors s[6], centre[6];
} Slopes;

/** Four points at work. */
typedef struct Four {
  const MultiYield *law;
  Lanes shear, scale; /* G; scale of the radii */
  Tensors s;
  double *centres[LANES]; /* of surface 1, in the trial rows */
  int active[LANES], low[LANES], high[LANES];
  Tensors centre, next; /* of the active surface and of the one around it */
  Lanes radius, larger; /* theirs */
  Slopes *d;            /* NULL: not wanted */
} Four;

static inline int lesser(double a, double b)
{
  return (int)(a < b ? a : b);
}
static inline int greater(double a, double b)
{
  return (int)(a > b ? a : b);
}

LANES_INLINE bool any(LaneMask mask)
{
  return mask[0] | mask[1] | mask[2] | mask[3];
}

LANES_INLINE Lanes product(const Tensors *a, const Tensors *b)
{
  return (a->at[0] * b->at[0] + a->at[1] * b->at[1] + a->at[2] * b->at[2]) +
         lanes_set(2) * (a->at[3] * b->at[3] + a->at[4] * b->at[4] + a->at[5] * b->at[5]);
}

/** a x + b y. */
LANES_INLINE Tensors combine(Lanes a, const Tensors *x, Lanes b, const Tensors *y)
{
  Tensors sum;
  for (int k = 0; k < 6; ++k) sum.at[k] = a * x->at[k] + b * y->at[k];
  return sum;
}

LANES_INLINE Tensors difference(const Tensors *x, const Tensors *y)
{
  Tensors d;
  for (int k = 0; k < 6; ++k) d.at[k] = x->at[k] - y->at[k];
  return d;
}

LANES_INLINE void assign(LaneMask where, Tensors *to, const Tensors *from)
{
  for (int k = 0; k < 6; ++k) to->at[k] = lanes_choose(where, from->at[k], to->at[k]);
}

/** Deviators of five numbers each, from four places. */
LANES_INLINE Tensors gather(const double *const from[LANES])
{
  Lanes out[LANES];
  lanes_turn(lanes_load(from[0]), lanes_load(from[1]), lanes_load(from[2]), lanes_load(from[3]), out);
  const Lanes last = {from[0][4], from[1][4], from[2][4], from[3][4]};
  return (Tensors){{out[0], out[1], -(out[0] + out[1]), out[2], out[3], last}};
}

LANES_INLINE void scatter_one(const Tensors *from, int lane, double *to)
{
  to[0] = from->at[XX][lane];
  to[1] = from->at[YY][lane];
  to[2] = from->at[XY][lane];
  to[3] = from->at[YZ][lane];
  to[4] = from->at[ZX][lane];
}

LANES_INLINE Lanes look_up(const double *table, const int at[LANES])
{
  return (Lanes){table[at[0]], table[at[1]], table[at[2]], table[at[3]]};
}

/** Lanes whose whole number is at least `least`. */
LANES_INLINE LaneMask at_least(const int number[LANES], int least)
{
  return (LaneMask){-(number[0] >= least), -(number[1] >= least), -(number[2] >= least), -(number[3] >= least)};
}

static inline const double *centre_of(const Four *f, int lane, int surface)
{
  static const double origin[DEVIATOR_VALUES];
  return surface < f->law->surfaces ? f->centres[lane] + DEVIATOR_VALUES * (surface - 1) : origin;
}

/** Where the active surfaces are; the first of points on none. */
LANES_INLINE void locate(Four *f)
{
  const double *from[LANES];
  int at[LANES];
  for (int l = 0; l < LANES; ++l) {
    at[l] = f->active[l] ? f->active[l] : 1;
    from[l] = centre_of(f, l, at[l]);
  }
  f->centre = gather(from);
  f->radius = f->scale * look_up(f->law->radius, at);
}

/** Where the surfaces around the active ones are; the outermost for points on it. */
LANES_INLINE void locate_next(Four *f)
{
  const double *from[LANES];
  int at[LANES];
  for (int l = 0; l < LANES; ++l) {
    at[l] = f->active[l] < f->law->surfaces ? f->active[l] + 1 : f->active[l];
    from[l] = centre_of(f, l, at[l]);
  }
  f->next = gather(from);
  f->larger = f->scale * look_up(f->law->radius, at);
}

static inline void moved(Four *f, int lane, int first, int last)
{
  if (first < f->low[lane] || f->low[lane] > f->high[lane]) f->low[lane] = first;
  if (last > f->high[lane]) f->high[lane] = last;
}

/** Translates the active surfaces of `where` towards the next ones so that they pass through s (Mroz' rule). */
LANES_INLINE void translate(Four *f, LaneMask where)
{
  const Lanes one = lanes_set(1), two = lanes_set(2), zero = lanes_set(0), ratio = look_up(f->law->ratio, f->active);
  const Tensors r = difference(&f->s, &f->centre), d = difference(&f->centre, &f->next);
  /* x >= 1: where the ray from the centre through s meets the next surface. */
  const Lanes A = product(&r, &r), B = two * product(&r, &d), C = product(&d, &d) - f->larger * f->larger;
  const Lanes ray = lanes_root(lanes_greatest(B * B - lanes_set(4) * A * C, zero)),
              far = (ray - B) / lanes_choose(A > zero, two * A, one);
  const LaneMask ahead = far > one;
  const Lanes x = lanes_choose(ahead, far, one), along = x * (one - ratio);
  const Tensors mu = combine(along, &r, -ratio, &d);
  /* y: the smaller non-negative root of |r - y mu| = radius; roundings count as on the surface. */
  const Lanes square = f->radius * f->radius, length = product(&mu, &mu), linear = -two * product(&r, &mu),
              gap = A - square;
  const Lanes tiny = lanes_set(1e-13) * square;
  const LaneMask still =
      (length <= lanes_set(1e-30) * square) | ((lanes_absolute(linear) < tiny) & (lanes_absolute(gap) < tiny));
  const Lanes root = lanes_root(lanes_greatest(linear * linear - lanes_set(4) * length * gap, zero)),
              half = lanes_set(0.5) / lanes_choose(length > zero, length, one), small = half * (-linear - root),
              large = half * (root - linear);
  const Lanes y = lanes_choose(small < zero, large, small);
  where &= ~still & (y >= zero);
  Tensors to = combine(one, &f->centre, y, &mu);
  to.at[ZZ] = -(to.at[XX] + to.at[YY]); /* as it is when it is read again, which other points may bring about */
  assign(where, &f->centre, &to);
  for (int l = 0; l < LANES; ++l) {
    if (!where[l]) continue;
    scatter_one(&to, l, f->centres[l] + DEVIATOR_VALUES * (f->active[l] - 1));
    moved(f, l, f->active[l], f->active[l]);
  }
  for (int j = 0; f->d && j < 6; ++j) {
    const Tensors *dd = &f->d->centre[j], dr = difference(&f->d->s[j], dd);
    const Lanes dA = two * product(&r, &dr), dB = two * (product(&dr, &d) + product(&r, dd)),
                dC = two * product(&d, dd);
    const Lanes dx = lanes_where(ahead, -(dA * x * x + dB * x + dC) / (two * A * x + B));
    Tensors dmu = combine(along, &dr, -ratio, dd);
    dmu = combine(one, &dmu, dx * (one - ratio), &r);
    const Lanes dlength = two * product(&mu, &dmu), dlinear = -two * (product(&dr, &mu) + product(&r, &dmu));
    const Lanes dy = -(dlength * y * y + dlinear * y + dA) / (two * length * y + linear);
    Tensors dto = combine(dy, &mu, y, &dmu);
    dto = combine(one, dd, one, &dto);
    assign(where, &f->d->centre[j], &dto);
  }
}

/** Points of `where` go along their rays from a centre to a distance. */
LANES_INLINE void pull_to(Four *f, LaneMask where, const Tensors *centre, Lanes distance)
{
  const Tensors u = difference(&f->s, centre);
  const Lanes length = lanes_root(product(&u, &u)), one = lanes_set(1);
  const Tensors to = combine(one, centre, distance / lanes_choose(length > lanes_set(0), length, one), &u);
  assign(where, &f->s, &to);
}

/** Points of `where` end on the outermost surface, which never moves. */
LANES_INLINE void pull_to_outermost(Four *f, LaneMask where)
{
  const Lanes zero = lanes_set(0), own = product(&f->s, &f->s), square = lanes_choose(own > zero, own, lanes_set(1)),
              factor = f->radius / lanes_root(square);
  for (int j = 0; f->d && j < 6; ++j) {
    const Tensors *ds = &f->d->s[j], to = combine(factor, ds, -factor * product(&f->s, ds) / square, &f->s);
    assign(where, &f->d->s[j], &to);
  }
  pull_to(f, where, &(Tensors){{zero, zero, zero, zero, zero, zero}}, f->radius);
}

/** Adds the derivatives of an elastic deviator to those of s. */
LANES_INLINE void add_elastic_slopes(Four *f, LaneMask where, Lanes twice)
{
  for (int j = 0; j < 6; ++j)
    for (int k = j < 3 ? 0 : j; k < (j < 3 ? 3 : j + 1); ++k)
      f->d->s[j].at[k] += lanes_where(where, twice * lanes_set(j < 3 ? (j == k) - 1.0 / 3 : 0.5));
}

/** One part of an increment of the points of `run`: from s by the elastic trial `step` = `twice` x the strain deviator's share. */
LANES_INLINE void advance(Four *f, const Tensors *step, Lanes twice, LaneMask run)
{
  const int last = f->law->surfaces;
  const Lanes zero = lanes_set(0), one = lanes_set(1);
  const Tensors trial = combine(one, &f->s, one, step);
  assign(run, &f->s, &trial);
  if (f->d) add_elastic_slopes(f, run, twice);
  const LaneMask free = run & ~at_least(f->active, 1);
  if (any(free)) {
    const Tensors d = difference(&trial, &f->centre);
    const LaneMask yields = free & (product(&d, &d) > f->radius * f->radius);
    run &= ~free | yields;
    for (int l = 0; l < LANES; ++l)
      if (yields[l]) f->active[l] = 1;
  }
  LaneMask ends = run;
  for (int pass = 0; any(run); ++pass) {
    const Tensors d = difference(&f->s, &f->centre);
    const Lanes length = lanes_root(product(&d, &d));
    const Lanes inverse = lanes_where(length > zero, one / lanes_choose(length > zero, length, one));
    Lanes flow = look_up(f->law->flow, f->active);
    if (pass) flow *= look_up(f->law->step_down, f->active);
    const Lanes back = (length - f->radius) * flow * inverse;
    const Tensors returned = combine(one, &f->s, -back, &d);
    assign(run, &f->s, &returned);
    for (int j = 0; f->d && j < 6; ++j) {
      const Tensors dd = difference(&f->d->s[j], &f->d->centre[j]);
      const Lanes turned = flow * f->radius * inverse * inverse * inverse * product(&d, &dd);
      Tensors to = combine(one, &f->d->s[j], -back, &dd);
      to = combine(one, &to, -turned, &d);
      assign(run, &f->d->s[j], &to);
    }
    const LaneMask outermost = run & at_least(f->active, last);
    if (any(outermost)) {
      pull_to_outermost(f, outermost);
      run &= ~outermost;
      ends &= ~outermost;
    }
    for (int guard = 0; guard < 100; ++guard) { /* roundings may leave s inside: push it back out */
      const Tensors u = difference(&f->s, &f->centre);
      const Lanes square = product(&u, &u);
      const LaneMask inside = run & (square < f->radius * f->radius) & (square > zero);
      if (!any(inside)) break;
      pull_to(f, inside, &f->centre, f->radius * lanes_set(guard ? 1 + 1e-13 : 1));
    }
    locate_next(f);
    const Tensors past = difference(&f->s, &f->next);
    run &= product(&past, &past) > f->larger * f->larger;
    if (!any(run)) break;
    for (int l = 0; l < LANES; ++l)
      if (run[l]) ++f->active[l];
    locate(f);
    for (int j = 0; f->d && j < 6; ++j)
      for (int k = 0; k < 6; ++k) f->d->centre[j].at[k] = lanes_where(~run, f->d->centre[j].at[k]);
  }
  if (any(ends)) translate(f, ends);
}

/** First stress evaluation after the elastic stage: strength from the pressure, surfaces fitted to the stress. */
static void leave_elastic_stage(Four *f, int lane, double pressure, double scales[2])
{
  const MultiYield *c = f->law;
  if (c->frictional) {
    const double height = c->residual_pressure - fmin(pressure, 0);
    scales[1] = height / (c->reference_pressure + c->residual_pressure);
    scales[0] = pow(scales[1], c->exponent);
    f->scale[lane] = scales[1];
    f->shear[lane] = c->shear * scales[0];
  }
  double square = 0;
  for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * f->s.at[k][lane] * f->s.at[k][lane];
  double length = sqrt(square);
  const double scale = f->scale[lane], outer = scale * c->radius[c->surfaces];
  if (length == 0) return;
  if (length > outer) {
    for (int k = 0; k < 6; ++k) f->s.at[k][lane] *= outer / length;
    length = outer;
  }
  int active = 0;
  while (active < c->surfaces && length > scale * c->radius[active + 1]) ++active;
  f->active[lane] = active;
  for (int i = 1; i <= active && i < c->surfaces; ++i) {
    double s[DEVIATOR_VALUES];
    scatter_one(&f->s, lane, s);
    for (int k = 0; k < DEVIATOR_VALUES; ++k)
      f->centres[lane][DEVIATOR_VALUES * (i - 1) + k] = s[k] * (1 - scale * c->radius[i] / length);
    moved(f, lane, i, i);
  }
}

/** Reversal: all surfaces within the active one touch it at s, and the response is elastic again. */
static void reverse(Four *f, int lane, const Tensors *ray)
{
  const int m = f->active[lane];
  double s[DEVIATOR_VALUES], r[DEVIATOR_VALUES];
  scatter_one(&f->s, lane, s);
  scatter_one(ray, lane, r);
  for (int i = 1; i < m; ++i)
    for (int k = 0; k < DEVIATOR_VALUES; ++k)
      f->centres[lane][DEVIATOR_VALUES * (i - 1) + k] = s[k] - r[k] * (f->law->radius[i] / f->law->radius[m]);
  if (m > 1) moved(f, lane, 1, m - 1);
  f->active[lane] = 0;
}

LANES_INLINE void integrate(Four *f, const Tensors *de)
{
  const int last = f->law->surfaces;
  const Lanes one = lanes_set(1), twice = lanes_set(2) * f->shear;
  Tensors step = *de;
  for (int k = 0; k < 6; ++k) step.at[k] *= twice;
  locate(f);
  const Tensors r = difference(&f->s, &f->centre);
  const LaneMask reversal = at_least(f->active, 1) & (product(&step, &r) < lanes_set(0));
  if (any(reversal)) {
    for (int l = 0; l < LANES; ++l)
      if (reversal[l]) reverse(f, l, &r);
    locate(f);
  }
  const Lanes stiffness = one - look_up(f->law->flow, f->active), square = product(&step, &step),
              whole = f->scale * lanes_set(f->law->radius[last] / last);
  const LaneMask coarse = stiffness * stiffness * square >= whole * whole;
  int parts[LANES] = {1, 1, 1, 1}, most = 1;
  Lanes share = one;
  if (any(coarse)) {
    for (int l = 0; l < LANES; ++l) {
      if (!coarse[l]) continue;
      const double count = floor(stiffness[l] * sqrt(square[l]) / whole[l] + 1);
      parts[l] = count < last ? (int)count : last;
      if (parts[l] > most) most = parts[l];
      share[l] = 1.0 / parts[l];
    }
    for (int k = 0; k < 6; ++k) step.at[k] *= share;
  }
  for (int part = 0; part < most; ++part) advance(f, &step, twice * share, at_least(parts, part + 1));
}

/** Heads of four rows of history, turned round. */
typedef struct Heads {
  Lanes at[HEAD];
} Heads;

/** Points first .. first + 3 of a batch; beyond its end the last one stands in.
 *  @return the first that is not a number, or -1 */
LANES_INLINE int update_four(const MultiYield *c, const breccia_batch *batch, int first, bool with_tangent)
{
  const int row = multi_yield_history_values(c), scales = multi_yield_scales(c);
  const bool all = first + LANES <= batch->count;
  const double *old[LANES];
  double *new[LANES], scale[LANES][2];
  int at[LANES];
  Slopes slopes;
  Heads head;
  Four f; /* no initializer: clearing the whole took a fifth of an elastic update */
  f.law = c;
  f.d = with_tangent ? &slopes : NULL;
  if (with_tangent) memset(&slopes, 0, sizeof slopes);
  for (int l = 0; l < LANES; ++l) {
    at[l] = all || first + l < batch->count ? first + l : batch->count - 1;
    old[l] = batch->committed + (ptrdiff_t)row * at[l];
    new[l] = batch->trial + (ptrdiff_t)row *at[l];
  }
  for (int k = 0; k < HEAD; k += LANES)
    lanes_turn(lanes_load(old[0] + k), lanes_load(old[1] + k), lanes_load(old[2] + k), lanes_load(old[3] + k),
               head.at + k);
  f.shear = lanes_set(c->shear);
  f.scale = lanes_set(1);
  for (int l = 0; l < LANES; ++l) {
    const int low = lesser(head.at[LOW][l], new[l][LOW]), high = greater(head.at[HIGH][l], new[l][HIGH]),
              from = HEAD + scales + DEVIATOR_VALUES * (low - 1);
    if (low <= high) memcpy(new[l] + from, old[l] + from, sizeof(double) * DEVIATOR_VALUES * (size_t)(high - low + 1));
    for (int k = 0; k < scales; ++k) scale[l][k] = old[l][HEAD + k];
    f.active[l] = (int)head.at[ACTIVE][l];
    f.low[l] = MOST_SURFACES; /* an empty range */
    f.high[l] = 0;
    f.centres[l] = new[l] + HEAD + scales;
  }
  for (int l = 0; scales && l < LANES; ++l) {
    f.shear[l] *= scale[l][0];
    f.scale[l] *= scale[l][1];
  }
  f.s = (Tensors){{head.at[0], head.at[1], -(head.at[0] + head.at[1]), head.at[2], head.at[3], head.at[4]}};
  Tensors de = f.s;
  for (int k = 0; k < 6; ++k) {
    const double *e = batch->strain[k];
    const Lanes strain = all ? lanes_load(e + first) : (Lanes){e[at[0]], e[at[1]], e[at[2]], e[at[3]]};
    de.at[k] = strain - head.at[STRAIN + k];
    head.at[STRAIN + k] = strain;
  }
  const Lanes volumetric = de.at[XX] + de.at[YY] + de.at[ZZ], zero = lanes_set(0);
  for (int k = 0; k < 3; ++k) de.at[k] -= volumetric / lanes_set(3);
  for (int k = 3; k < 6; ++k) de.at[k] *= lanes_set(0.5);
  if (batch->elastic_stage) {
    const Lanes twice = lanes_set(2) * f.shear;
    f.s = combine(lanes_set(1), &f.s, twice, &de);
    if (with_tangent) add_elastic_slopes(&f, zero == zero, twice);
  } else {
    for (int l = 0; l < LANES; ++l)
      if (head.at[BEGUN][l] == 0) leave_elastic_stage(&f, l, head.at[PRESSURE][l], scale[l]);
    integrate(&f, &de);
  }
  Lanes bulk = lanes_set(c->bulk);
  for (int l = 0; scales && l < LANES; ++l) bulk[l] *= scale[l][0];
  head.at[PRESSURE] += bulk * volumetric;
  head.at[DEVIATOR] = f.s.at[XX];
  head.at[DEVIATOR + 1] = f.s.at[YY];
  for (int k = XY; k <= ZX; ++k) head.at[DEVIATOR + k - 1] = f.s.at[k];
  head.at[ACTIVE] = (Lanes){f.active[0], f.active[1], f.active[2], f.active[3]};
  head.at[LOW] = (Lanes){f.low[0], f.low[1], f.low[2], f.low[3]};
  head.at[HIGH] = (Lanes){f.high[0], f.high[1], f.high[2], f.high[3]};
  if (!batch->elastic_stage) head.at[BEGUN] = lanes_set(1);
  Lanes sum = zero;
  for (int k = 0; k < 6; ++k) {
    const Lanes stress = k < 3 ? f.s.at[k] + head.at[PRESSURE] : f.s.at[k];
    sum += stress;
    if (all)
      lanes_store(batch->stress[k] + first, stress);
    else
      for (int l = 0; l < LANES; ++l) batch->stress[k][at[l]] = stress[l];
  }
  for (int k = 0; k < HEAD; k += LANES) {
    Lanes rows[LANES];
    lanes_turn(head.at[k], head.at[k + 1], head.at[k + 2], head.at[k + 3], rows);
    for (int l = 0; l < LANES; ++l) lanes_store(new[l] + k, rows[l]);
  }
  for (int l = 0; l < LANES; ++l) {
    for (int k = 0; k < scales; ++k) new[l][HEAD + k] = scale[l][k];
    for (int i = 0; with_tangent && i < 6; ++i)
      for (int k = 0; k < 6; ++k)
        batch->tangent[36 * at[l] + 6 * i + k] = slopes.s[k].at[i][l] + (i < 3 && k < 3 ? bulk[l] : 0);
  }
  for (int l = 0; l < LANES; ++l)
    if (!isfinite(sum[l])) return at[l];
  return -1;
}

BRECCIA_CLONES
static int update_plain(const MultiYield *c, const breccia_batch *batch)
{
  const int row = multi_yield_history_values(c), centres = HEAD + multi_yield_scales(c);
  for (int i = 0; i < batch->count; i += LANES) {
    for (int ahead = i + LANES; ahead < i + 3 * LANES && ahead < batch->count;
         ++ahead) { /* rows lie a kilobyte apart */
      const double *old = batch->committed + (ptrdiff_t)row * ahead, *new = batch->trial + (ptrdiff_t)row *ahead;
      if (ahead >= i + 2 * LANES) {
        for (int k = 0; k < 3; ++k) {
          __builtin_prefetch(old + 8 * k);
          __builtin_prefetch(new + 8 * k, 1);
        }
      } else if (old[ACTIVE] > 1) {
        const int centre = centres + DEVIATOR_VALUES * ((int)old[ACTIVE] - 1);
        __builtin_prefetch(old + centre);
        __builtin_prefetch(new + centre, 1);
        __builtin_prefetch(new + centre + 8, 1);
      }
    }
    const int bad = update_four(c, batch, i, false);
    if (bad >= 0) return bad;
  }
  return -1;
}

BRECCIA_CLONES
static int update_with_tangent(const MultiYield *c, const breccia_batch *batch)
{
  for (int i = 0; i < batch->count; i += LANES) {
    const int bad = update_four(c, batch, i, true);
    if (bad >= 0) return bad;
  }
  return -1;
}

int multi_yield_update(const void *constants, const breccia_batch *batch)
{
  return (batch->tangent ? update_with_tangent : update_plain)(constants, batch);
}
