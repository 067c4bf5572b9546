/* Non-ordinary state-based peridynamics by correspondence (Silling et al. 2007; docs/theory.md 4).
 *
 * With w = omega beta V_j and G = F - I, particle i has
 *   G_i = (sum w eta (x) xi) K_i^-1,  E = (G + G^T + G^T G) / 2,  P = (I + G) S(E),
 * and the force on it per volume is sum w [P_i K_i^-1 + P_j K_j^-1] xi + sum w [C_i (eta - G_i xi) + C_j (eta - G_j xi)], the
 * second sum being the control of zero-energy modes: C = G_s c_b / (delta omega_mean) I (Silling 2017) or a factor times
 * C : K^-1 (Wan et al. 2019). Both sums are arranged as one state Q = P K^-1 - C G per particle:
 *   f_i = Q_i (sum w xi) + C_i (sum w eta) + sum w [Q_j xi + C_j eta],
 * so that the second sweep over bonds reads the neighbour's Q and C only. */
#include "base/tensor.h"
#include "formulation/formulation.h"
#include "formulation/shape_tensor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Uniform: the scalar control of a body of one material with constant influence, where C is the same everywhere; sum w C_j eta
 * is then known from the first sweep and the second needs a third fewer numbers. */
typedef enum Control { CONTROL_NONE, CONTROL_UNIFORM, CONTROL_SCALAR, CONTROL_TENSOR } Control;

typedef struct Correspondence {
  const Particles *particles;
  const Family *family;
  Points *points;
  const Body *body;
  bool plane, finite;
  Control control;
  double strength;
  double *inverse[6];      /* K^-1 */
  double *first_moment[3]; /* sum w xi */
  double *gradient[9];     /* G */
  double *state[9];        /* Q */
  double *stretch[3];      /* sum w eta */
  double *hold[6];         /* C: one component, or six, or none */
  float *roundness;        /* of K with all bonds */
  uint8_t *mode;           /* ShapeMode of each place */
  int32_t *axial;          /* places whose bonds act as springs, ascending (some may have become free since) */
  int64_t axial_count;
} Correspondence;

static int hold_components(Control control)
{
  return control == CONTROL_NONE ? 0 : control == CONTROL_TENSOR ? 6 : 1;
}

static void destroy(void *formulation)
{
  Correspondence *c = formulation;
  if (!c) return;
  for (int k = 0; k < 9; ++k) {
    places_free(&c->gradient[k]);
    places_free(&c->state[k]);
  }
  for (int k = 0; k < 6; ++k) {
    places_free(&c->inverse[k]);
    places_free(&c->hold[k]);
  }
  for (int k = 0; k < 3; ++k) {
    places_free(&c->first_moment[k]);
    places_free(&c->stretch[k]);
  }
  free(c->roundness);
  free(c->mode);
  free(c->axial);
  free(c);
}

static void set_shape(Correspondence *c, int32_t place, const ShapeTensor *shape)
{
  for (int k = 0; k < 6; ++k) c->inverse[k][place] = shape->inverse[k];
  for (int k = 0; k < 3; ++k) c->first_moment[k][place] = shape->first_moment[k];
  bool strained = shape->mode == SHAPE_REGULAR || shape->mode == SHAPE_REDUCED;
  const Material *m = &c->points->materials[c->points->material[place / SLICE]];
  if (c->control == CONTROL_SCALAR || c->control == CONTROL_UNIFORM) {
    double scale = c->strength * micromodulus(c->body, material_young(m), c->family->horizon) / c->family->horizon;
    c->hold[0][place] = shape->mean_influence > 0 ? scale / shape->mean_influence : scale;
  } else if (c->control == CONTROL_TENSOR) {
    double lambda = m->bulk - 2 * m->shear / 3;
    double trace = shape->inverse[XX] + shape->inverse[YY] + shape->inverse[ZZ];
    for (int k = 0; k < 6; ++k)
      c->hold[k][place] =
          strained ? c->strength * (2 * m->shear * shape->inverse[k] + (k < 3 ? lambda * trace : 0)) : 0;
  }
}

static void renew(void *formulation, int64_t slice)
{
  Correspondence *c = formulation;
  for (int lane = 0; lane < SLICE; ++lane) {
    int32_t place = (int32_t)(slice * SLICE + lane);
    if (c->particles->number[place] < 0) continue;
    ShapeTensor shape = shape_tensor(c->family, place, c->plane, (double)c->roundness[place]);
    if (shape.mode == SHAPE_AXIAL && c->mode[place] != SHAPE_AXIAL) { /* kept in order, so that a restart sums alike */
      int64_t n = c->axial_count++;
      for (; n > 0 && c->axial[n - 1] > place; --n) c->axial[n] = c->axial[n - 1];
      c->axial[n] = place;
    }
    c->mode[place] = (uint8_t)shape.mode;
    set_shape(c, place, &shape);
  }
}

/** True if all particles have one and the same scalar C, and will keep it whatever breaks. */
static bool is_uniform(const Correspondence *c)
{
  const Particles *p = c->particles;
  if (c->control != CONTROL_SCALAR) return false;
  double first = c->hold[0][p->place_of[0]];
  for (int64_t n = 1; n < p->count; ++n)
    if (c->hold[0][p->place_of[n]] != first) return false;
  for (int k = 0; k < c->family->pattern_count; ++k)
    if (c->family->patterns[k].weight != c->family->patterns[0].weight) return false;
  return true;
}

static int set_all_shapes(Correspondence *c, Error *error)
{
  const Particles *p = c->particles;
  int32_t worst = INT32_MAX;
#pragma omp parallel for schedule(static) reduction(min : worst)
  for (int32_t place = 0; place < p->places; ++place) {
    if (p->number[place] < 0) continue;
    ShapeTensor shape = shape_tensor(c->family, place, c->plane, 0);
    c->roundness[place] = (float)shape.roundness;
    c->mode[place] = (uint8_t)shape.mode;
    if ((shape.mode != SHAPE_REGULAR || shape.roundness < 1e-6) && p->number[place] < worst) worst = p->number[place];
    set_shape(c, place, &shape);
  }
  if (worst == INT32_MAX) return BRECCIA_OK;
  int32_t place = p->place_of[worst];
  return error_add(
      error, BRECCIA_USER_ERROR,
      "particle %d at [%g, %g, %g] has %d bonds that do not span %s, so that it has no strain; the horizon is "
      "%g: give the body at least two layers in every direction, a longer horizon, or a square lattice in the "
      "plane",
      worst, p->position[0][place], p->position[1][place], p->position[2][place], family_count(c->family, place),
      c->plane ? "the plane" : "space", c->family->horizon);
}

static void *create(const FormulationParts *parts, Error *error)
{
  Correspondence *c = calloc(1, sizeof *c);
  if (!c) {
    error_add(error, BRECCIA_FAILURE, "out of memory: correspondence");
    return NULL;
  }
  c->particles = parts->particles;
  c->family = parts->family;
  c->points = parts->points;
  c->body = parts->body;
  c->plane = parts->body->plane;
  c->finite = !strcmp(parts->spec->strain, "green-lagrange");
  const ControlSpec *control = parts->spec->control;
  c->control = CONTROL_SCALAR;
  c->strength = c->plane ? 0.2 : 0.1;
  if (control && !isnan(control->silling)) c->strength = control->silling;
  if (control && !isnan(control->wan)) {
    c->control = CONTROL_TENSOR;
    c->strength = control->wan;
  }
  if ((control && control->none) || c->strength == 0) c->control = CONTROL_NONE;

  int64_t places = parts->particles->places;
  int failed = 0;
  for (int k = 0; k < 9; ++k) {
    failed |= !(c->gradient[k] = places_array(places, "deformation gradients", error));
    failed |= !(c->state[k] = places_array(places, "force states", error));
  }
  for (int k = 0; k < 6; ++k) failed |= !(c->inverse[k] = places_array(places, "shape tensors", error));
  for (int k = 0; k < hold_components(c->control); ++k)
    failed |= !(c->hold[k] = places_array(places, "zero-energy control", error));
  for (int k = 0; k < 3; ++k) {
    failed |= !(c->first_moment[k] = places_array(places, "shape tensors", error));
    failed |= !(c->stretch[k] = places_array(places, "deformation", error));
  }
  failed |= !(c->roundness = memory_zeroed((size_t)places, sizeof *c->roundness, "shape tensors", error));
  failed |= !(c->mode = memory_zeroed((size_t)places, sizeof *c->mode, "shape tensors", error));
  failed |= !(c->axial = memory_zeroed((size_t)parts->particles->count, sizeof *c->axial, "axial particles", error));
  if (failed || set_all_shapes(c, error)) {
    destroy(c);
    return NULL;
  }
  if (is_uniform(c)) c->control = CONTROL_UNIFORM;
  return c;
}

/* ---- the sweeps over bonds ---- */

/** The bonds of half a slice in one slot: where the four neighbours are, and their reference vectors. */
typedef struct Slot {
  bool lattice;
  int64_t base;         /* lattice: place of the first neighbour */
  const int32_t *index; /* stored: their places */
  LaneMask mask;
  Lanes weight, weighted_xi[3];
} Slot;

/** @return false if none of the four bonds is intact */
LANES_INLINE bool slot_open(const Correspondence *c, int64_t slot, int64_t place, int half, bool lattice, Slot *s)
{
  const Family *f = c->family;
  unsigned bits = (unsigned)f->intact[slot] >> (LANES * half) & 15u;
  if (!bits) return false;
  s->lattice = lattice;
  s->mask = lanes_mask(bits);
  if (lattice) {
    const Pattern *row = &f->patterns[f->pattern[slot]];
    s->base = f->base[slot] + LANES * half;
    s->weight = lanes_set(row->weight);
    for (int k = 0; k < 3; ++k) s->weighted_xi[k] = lanes_set(row->weighted_xi[k]);
  } else {
    int64_t at = (int64_t)f->base[slot] * SLICE + LANES * half;
    s->index = f->neighbour + at;
    s->weight = lanes_load(f->weight + at);
    for (int k = 0; k < 3; ++k) {
      const double *x = c->particles->position[k];
      s->weighted_xi[k] = s->weight * (lanes_gather(x, s->index) - lanes_load(x + place));
    }
  }
  return true;
}

LANES_INLINE Lanes slot_read(const Slot *s, const double *array)
{
  return s->lattice ? lanes_load(array + s->base) : lanes_gather(array, s->index);
}

LANES_INLINE Lanes slot_intact(const Slot *s, Lanes value)
{
  return lanes_where(s->mask, value);
}

/* Nine sums and what they are made from just fit 16 registers. The three further sums of the control go in a loop of their
 * own: in this one they were kept in memory, and waiting for them took as long as all the rest. */
LANES_INLINE void deform_slots(const Correspondence *c, int64_t from, int64_t to, int64_t place, int half, bool lattice,
                               Lanes tensor[9])
{
  double *const *u = c->particles->displacement;
  const Lanes own[3] = {lanes_load(u[0] + place), lanes_load(u[1] + place), lanes_load(u[2] + place)};
  for (int64_t slot = from; slot < to; ++slot) {
    Slot s;
    if (!slot_open(c, slot, place, half, lattice, &s)) continue;
    for (int k = 0; k < 3; ++k) {
      Lanes eta = slot_intact(&s, slot_read(&s, u[k]) - own[k]);
      for (int j = 0; j < 3; ++j) tensor[3 * k + j] += eta * s.weighted_xi[j];
    }
  }
}

LANES_INLINE void stretch_slots(const Correspondence *c, int64_t from, int64_t to, int64_t place, bool lattice,
                                Lanes stretch[2][3])
{
  double *const *u = c->particles->displacement;
  Lanes own[2][3];
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(u[k] + place + LANES * half);
  for (int64_t slot = from; slot < to; ++slot)
    for (int half = 0; half < 2; ++half) {
      Slot s;
      if (!slot_open(c, slot, place + LANES * half, half, lattice, &s)) continue;
      for (int k = 0; k < 3; ++k) stretch[half][k] += slot_intact(&s, slot_read(&s, u[k]) - own[half][k]) * s.weight;
    }
}

LANES_INLINE void stretch_slice(const Correspondence *c, int64_t slice)
{
  const Family *f = c->family;
  Lanes stretch[2][3] = {{{0}}};
  stretch_slots(c, f->first[slice], f->stored[slice], slice * SLICE, true, stretch);
  if (f->stored[slice] < f->first[slice + 1])
    stretch_slots(c, f->stored[slice], f->first[slice + 1], slice * SLICE, false, stretch);
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) lanes_store(c->stretch[k] + slice * SLICE + LANES * half, stretch[half][k]);
}

LANES_INLINE void deform_half(const Correspondence *c, int64_t slice, int half)
{
  const Family *f = c->family;
  int64_t place = slice * SLICE + LANES * half, first = f->first[slice], stored = f->stored[slice];
  int64_t last = f->first[slice + 1];
  Lanes tensor[9] = {{0}};
  deform_slots(c, first, stored, place, half, true, tensor);
  if (stored < last) deform_slots(c, stored, last, place, half, false, tensor);

  Lanes inverse[6], g[9];
  for (int k = 0; k < 6; ++k) inverse[k] = lanes_load(c->inverse[k] + place);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k)
      g[3 * r + k] = tensor[3 * r] * inverse[symmetric_place[k]] + tensor[3 * r + 1] * inverse[symmetric_place[3 + k]] +
                     tensor[3 * r + 2] * inverse[symmetric_place[6 + k]];
  for (int k = 0; k < 9; ++k) lanes_store(c->gradient[k] + place, g[k]);
  for (int k = 0; k < 6; ++k) {
    if (k == ZZ && c->points->space == SPACE_PLANE_STRESS) continue; /* that strain is the law's affair */
    int r = symmetric_row[k], col = symmetric_column[k];
    Lanes strain = g[3 * r + col] + g[3 * col + r];
    if (c->finite) strain += g[r] * g[col] + g[3 + r] * g[3 + col] + g[6 + r] * g[6 + col];
    lanes_store(c->points->strain[k] + place, k < 3 ? strain * lanes_set(0.5) : strain);
  }
}

BRECCIA_CLONES
static void deform(void *formulation, int64_t first, int64_t last)
{
  const Correspondence local = *(const Correspondence *)formulation,
                       *c = &local; /* so that stores are seen not to change it */
  for (int64_t slice = first; slice < last; ++slice) {
    for (int half = 0; half < SLICE / LANES; ++half) deform_half(c, slice, half);
    if (c->control != CONTROL_NONE) stretch_slice(c, slice);
  }
}

LANES_INLINE void respond_lanes(const Correspondence *c, int64_t place)
{
  Lanes s[6], g[9], p[9], inverse[6], hold[6];
  for (int k = 0; k < 6; ++k) {
    s[k] = lanes_load(c->points->stress[k] + place);
    inverse[k] = lanes_load(c->inverse[k] + place);
  }
  for (int k = 0; k < hold_components(c->control); ++k) hold[k] = lanes_load(c->hold[k] + place);
  for (int k = 0; k < 9; ++k) g[k] = lanes_load(c->gradient[k] + place);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      p[3 * r + k] = s[symmetric_place[3 * r + k]];
      for (int j = 0; c->finite && j < 3; ++j) p[3 * r + k] += g[3 * r + j] * s[symmetric_place[3 * j + k]];
    }
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      Lanes q = p[3 * r] * inverse[symmetric_place[k]] + p[3 * r + 1] * inverse[symmetric_place[3 + k]] +
                p[3 * r + 2] * inverse[symmetric_place[6 + k]];
      if (c->control == CONTROL_SCALAR || c->control == CONTROL_UNIFORM) q -= hold[0] * g[3 * r + k];
      for (int j = 0; c->control == CONTROL_TENSOR && j < 3; ++j) q -= hold[symmetric_place[3 * r + j]] * g[3 * j + k];
      lanes_store(c->state[3 * r + k] + place, q);
    }
}

BRECCIA_CLONES
static void respond(void *formulation, int64_t first, int64_t last)
{
  for (int64_t place = first * SLICE; place < last * SLICE; place += LANES) respond_lanes(formulation, place);
}

/* Both halves of a slice in one pass: three sums each fit the registers, and what belongs to the slot is read once. */
LANES_INLINE void resist_slots(const Correspondence *c, int64_t from, int64_t to, int64_t place, bool lattice,
                               Control control, Lanes force[2][3])
{
  double *const *u = c->particles->displacement;
  bool displaced = control == CONTROL_SCALAR || control == CONTROL_TENSOR;
  Lanes own[2][3];
  for (int half = 0; displaced && half < 2; ++half)
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(u[k] + place + LANES * half);
  for (int64_t slot = from; slot < to; ++slot)
    for (int half = 0; half < 2; ++half) {
      Slot s;
      if (!slot_open(c, slot, place + LANES * half, half, lattice, &s)) continue;
      Lanes eta[3], hold;
      for (int k = 0; displaced && k < 3; ++k) eta[k] = slot_read(&s, u[k]) - own[half][k];
      if (control == CONTROL_SCALAR) hold = slot_read(&s, c->hold[0]) * s.weight;
      for (int k = 0; k < 3; ++k) {
        Lanes f = slot_read(&s, c->state[3 * k]) * s.weighted_xi[0] +
                  slot_read(&s, c->state[3 * k + 1]) * s.weighted_xi[1] +
                  slot_read(&s, c->state[3 * k + 2]) * s.weighted_xi[2];
        if (control == CONTROL_SCALAR) f += hold * eta[k];
        if (control == CONTROL_TENSOR)
          for (int j = 0; j < 3; ++j) f += slot_read(&s, c->hold[symmetric_place[3 * k + j]]) * (s.weight * eta[j]);
        force[half][k] += slot_intact(&s, f);
      }
    }
}

LANES_INLINE void resist_slice(const Correspondence *c, int64_t slice, Control control)
{
  const Family *f = c->family;
  Lanes force[2][3] = {{{0}}};
  resist_slots(c, f->first[slice], f->stored[slice], slice * SLICE, true, control, force);
  if (f->stored[slice] < f->first[slice + 1])
    resist_slots(c, f->stored[slice], f->first[slice + 1], slice * SLICE, false, control, force);
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) {
      int64_t place = slice * SLICE + LANES * half;
      Lanes sum = force[half][k];
      for (int j = 0; j < 3; ++j)
        sum += lanes_load(c->state[3 * k + j] + place) * lanes_load(c->first_moment[j] + place);
      if (control == CONTROL_SCALAR) sum += lanes_load(c->hold[0] + place) * lanes_load(c->stretch[k] + place);
      if (control == CONTROL_UNIFORM)
        sum += lanes_set(2) * lanes_load(c->hold[0] + place) * lanes_load(c->stretch[k] + place);
      for (int j = 0; control == CONTROL_TENSOR && j < 3; ++j)
        sum += lanes_load(c->hold[symmetric_place[3 * k + j]] + place) * lanes_load(c->stretch[j] + place);
      lanes_store(c->particles->internal[k] + place, sum);
    }
}

BRECCIA_CLONES
static void resist(void *formulation, int64_t first, int64_t last)
{
  const Correspondence local = *(const Correspondence *)formulation,
                       *c = &local; /* so that stores are seen not to change it */
  for (int64_t slice = first; slice < last; ++slice)
    if (c->control == CONTROL_UNIFORM)
      resist_slice(c, slice, CONTROL_UNIFORM);
    else if (c->control == CONTROL_SCALAR)
      resist_slice(c, slice, CONTROL_SCALAR);
    else if (c->control == CONTROL_NONE)
      resist_slice(c, slice, CONTROL_NONE);
    else
      resist_slice(c, slice, CONTROL_TENSOR);
}

/* ---- particles with too few bonds, and single bonds ---- */

/** What a particle without a strain exerts through one of its bonds: half of a bond-based spring, instead of the control that
 *  the sweeps have added for it. */
static void axial_state(const Correspondence *c, int64_t slice, const Bond *bond, int lane, double t[3])
{
  int64_t place = slice * SLICE + lane;
  const Material *m = &c->points->materials[c->points->material[slice]];
  double y[3], length = 0;
  for (int k = 0; k < 3; ++k) {
    y[k] = bond->xi[k] + c->particles->displacement[k][bond->neighbour] - c->particles->displacement[k][place];
    length += y[k] * y[k];
  }
  length = sqrt(length);
  double stiffness = micromodulus(c->body, material_young(m), c->family->horizon) / 2;
  double pull = length > 0 ? stiffness * (length - bond->length) / (bond->length * length) : 0;
  double omega = bond->weight / c->particles->volume[bond->neighbour];
  double hold = c->control == CONTROL_SCALAR || c->control == CONTROL_UNIFORM ? c->hold[0][place] : 0;
  for (int k = 0; k < 3; ++k) t[k] = pull * y[k] - omega * hold * (y[k] - bond->xi[k]);
}

static void finish(void *formulation)
{
  const Correspondence *c = formulation;
  for (int64_t n = 0; n < c->axial_count; ++n) {
    int32_t place = c->axial[n];
    int64_t slice = place / SLICE;
    int lane = place % SLICE;
    if (c->mode[place] != SHAPE_AXIAL) continue;
    for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
      if (!(c->family->intact[slot] >> lane & 1)) continue;
      Bond bond = family_bond(c->family, slice, slot, lane);
      double t[3];
      axial_state(c, slice, &bond, lane, t);
      for (int k = 0; k < 3; ++k) {
        c->particles->internal[k][place] += t[k] * c->particles->volume[bond.neighbour];
        c->particles->internal[k][bond.neighbour] -= t[k] * c->particles->volume[place];
      }
    }
  }
}

static void bond_force(const void *formulation, int64_t slice, int64_t slot, int lane, double force[3])
{
  const Correspondence *c = formulation;
  Bond bond = family_bond(c->family, slice, slot, lane);
  int64_t place = slice * SLICE + lane, ends[2] = {place, bond.neighbour};
  double omega = bond.weight / c->particles->volume[bond.neighbour];
  for (int k = 0; k < 3; ++k) force[k] = 0;
  for (int e = 0; e < 2; ++e)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) {
        double eta = c->particles->displacement[j][bond.neighbour] - c->particles->displacement[j][place];
        double hold = c->control == CONTROL_NONE     ? 0
                      : c->control != CONTROL_TENSOR ? (j == k ? c->hold[0][ends[e]] : 0)
                                                     : c->hold[symmetric_place[3 * k + j]][ends[e]];
        force[k] += omega * (c->state[3 * k + j][ends[e]] * bond.xi[j] + hold * eta);
      }
  for (int e = 0; e < 2; ++e) { /* a spring pulls its two ends alike */
    if (c->mode[ends[e]] != SHAPE_AXIAL) continue;
    Bond seen = bond; /* from that end */
    double t[3];
    if (e) {
      seen.neighbour = (int32_t)place;
      for (int k = 0; k < 3; ++k) seen.xi[k] = -bond.xi[k];
      seen.weight = bond.weight * c->particles->volume[place] / c->particles->volume[bond.neighbour];
    }
    axial_state(c, ends[e] / SLICE, &seen, (int)(ends[e] % SLICE), t);
    for (int k = 0; k < 3; ++k) force[k] += e ? -t[k] : t[k];
  }
}

static void gradient(const void *formulation, int64_t place, double f[9])
{
  const Correspondence *c = formulation;
  for (int k = 0; k < 9; ++k) f[k] = c->gradient[k][place] + (k % 4 == 0);
}

static size_t bytes(const void *formulation)
{
  const Correspondence *c = formulation;
  size_t numbers = 9 + 9 + 6 + 3 + 3 + (size_t)hold_components(c->control);
  return (size_t)c->particles->places * (numbers * sizeof(double) + sizeof(float) + 1) +
         (size_t)c->particles->count * sizeof(int32_t);
}

const FormulationType formulation_correspondence = {
    .name = "correspondence",
    .about = "non-ordinary state-based: one strain per particle from its family, with control of zero-energy modes",
    .source = "Silling et al. 2007; Silling 2017 and Wan et al. 2019 for the control",
    .maturity = "verified against patch tests and finite elements",
    .create = create,
    .destroy = destroy,
    .renew = renew,
    .deform = deform,
    .respond = respond,
    .resist = resist,
    .finish = finish,
    .bond_force = bond_force,
    .gradient = gradient,
    .bytes = bytes,
};
