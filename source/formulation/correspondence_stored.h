/* Sweeps of correspondence over bonds one by one, where neighbours stand anywhere; part of correspondence_sweep.c.
 *
 * What is read of a neighbour lies together. Four lanes run over components, particle by particle: neighbours that lie scattered cost less to read so
 * (measured: 14 ns a bond with numbers gathered one by one, 6 with records turned round in registers, 5 so). Eight take a whole slot, whose records are
 * turned round in registers. Each particle adds up its bonds in the order of slots both ways. */
#ifndef BRECCIA_FORMULATION_CORRESPONDENCE_STORED_H
#define BRECCIA_FORMULATION_CORRESPONDENCE_STORED_H

#include "formulation/correspondence.h"

/** Position, and displacement and volume as sums read them, of the places of some slices. */
static inline void correspondence_show_places(const Correspondence *c, int64_t first, int64_t last)
{
  const Particles *p = c->particles;
  for (int64_t place = first * SLICE; place < last * SLICE; ++place) {
    double *shown = c->shown + CORRESPONDENCE_SHOWN * place;
    for (int k = 0; k < 3; ++k) {
      shown[k] = p->position[k][place];
      shown[4 + k] = p->volume[place] * p->displacement[k][place];
    }
    shown[7] = p->volume[place];
  }
}

LANES_INLINE Quad quad_set(double value)
{
  return (Quad){value, value, value, value};
}

/** As correspondence_deform_stored, particle by particle. */
LANES_INLINE void deform_one_by_one(const Correspondence *c, int64_t slice, bool scaled, Lanes sums[3][HALVES][4])
{
  const Family *f = c->family;
  const int64_t first = f->stored[slice], count = f->first[slice + 1] - first;
  const uint8_t *intact = f->intact + first;
  const double *shown = c->shown;
  for (int lane = 0; lane < SLICE; ++lane) {
    Quad own[3], sum[4] = {{0}};
    const int64_t begin = (int64_t)f->base[first] * SLICE + lane;
    const int32_t *neighbour = f->neighbour + begin;
    const double *scale = scaled ? f->scale + begin : NULL;
    for (int k = 0; k < 3; ++k) own[k] = quad_set(c->particles->position[k][slice * SLICE + lane]);
    for (int64_t n = 0; n < count; ++n) {
      if (!(intact[n] & 1u << lane)) continue;
      const double *there = shown + (int64_t)neighbour[n * SLICE] * CORRESPONDENCE_SHOWN;
      Quad u = quad_load(there + QUAD);
      if (scaled) u *= quad_set(scale[n * SLICE]);
      for (int k = 0; k < 3; ++k) sum[k] += u * (quad_set(there[k]) - own[k]);
      sum[3] += u;
    }
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 4; ++j) sums[k][lane / LANES][j][lane % LANES] += sum[j][k];
  }
}

LANES_INLINE void deform_together(const Correspondence *c, int64_t slice, bool scaled, Lanes sums[3][HALVES][4])
{
  const Family *f = c->family;
  for (int half = 0; half < HALVES; ++half) {
    Lanes own[3], sum[3][4] = {{{0}}};
    for (int k = 0; k < 3; ++k) own[k] = lanes_load(c->particles->position[k] + slice * SLICE + LANES * half);
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const int64_t at = (int64_t)f->base[slot] * SLICE + LANES * half;
      Lanes x[QUAD], u[QUAD];
      family_fetch_ahead(f, at, c->shown, CORRESPONDENCE_SHOWN);
      lanes_gather_rows(c->shown, CORRESPONDENCE_SHOWN, f->neighbour + at, x);
      lanes_gather_rows(c->shown + QUAD, CORRESPONDENCE_SHOWN, f->neighbour + at, u);
      for (int r = 0; r < 3; ++r) {
        if (scaled) u[r] *= lanes_load(f->scale + at);
        u[r] = lanes_intact(f->intact[slot], half, u[r]);
        for (int k = 0; k < 3; ++k) sum[r][k] += u[r] * (x[k] - own[k]);
        sum[r][3] += u[r];
      }
    }
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 4; ++k) sums[r][half][k] += sum[r][k];
  }
}

/** Adds a slice's stored bonds to sums of V u times xi, and of V u. @param[in] scaled  parts of volumes count */
LANES_INLINE void correspondence_deform_stored(const Correspondence *c, int64_t slice, bool scaled,
                                               Lanes sums[3][HALVES][4])
{
  if (HALVES == 1)
    deform_together(c, slice, scaled, sums);
  else
    deform_one_by_one(c, slice, scaled, sums);
}

/** Q, x, C u and C of a place, times its volume where sums need that, for its neighbours to read. */
LANES_INLINE void correspondence_show_state(const Correspondence *c, int64_t place)
{
  double *row = c->row + place * state_length(c->control), volume = c->particles->volume[place];
  for (int k = 0; k < 3; ++k) {
    for (int r = 0; r < 3; ++r) row[4 * k + r] = volume * c->state[3 * r + k][place];
    row[4 * k + 3] = c->particles->position[k][place];
  }
  for (int k = 0; k < 3 && hold_is_read(c->control); ++k) row[12 + k] = volume * c->held[k][place];
  for (int k = 0; k < hold_components(c->control); ++k) row[15 + k] = volume * c->hold[k][place];
}

/** As correspondence_resist_stored, particle by particle. */
LANES_INLINE void resist_one_by_one(const Correspondence *c, int64_t slice, bool scaled, Control control,
                                    Lanes force[HALVES][3], Lanes hold[HALVES][6])
{
  const Family *f = c->family;
  const int64_t first = f->stored[slice], count = f->first[slice + 1] - first;
  const uint8_t *intact = f->intact + first;
  const double *rows = c->row;
  const int numbers = hold_is_read(control) ? 3 + hold_components(control) : 0, length = state_length(control);
  for (int lane = 0; lane < SLICE; ++lane) {
    Quad own[3], sum[3] = {{0}}, held[3] = {{0}}; /* three sums, so that additions need not wait */
    const int64_t begin = (int64_t)f->base[first] * SLICE + lane;
    const int32_t *neighbour = f->neighbour + begin;
    const double *scale = scaled ? f->scale + begin : NULL;
    for (int k = 0; k < 3; ++k) own[k] = quad_set(c->particles->position[k][slice * SLICE + lane]);
    for (int64_t n = 0; n < count; ++n) {
      if (!(intact[n] & 1u << lane)) continue;
      const double *there = rows + (int64_t)neighbour[n * SLICE] * length;
      Quad factor = scaled ? quad_set(scale[n * SLICE]) : quad_set(1);
      for (int k = 0; k < 3; ++k) {
        Quad xi = quad_set(there[4 * k + 3]) - own[k];
        sum[k] += quad_load(there + 4 * k) * (scaled ? xi * factor : xi);
      }
      for (int k = 0; k < numbers; k += QUAD)
        held[k / QUAD] += scaled ? quad_load(there + 12 + k) * factor : quad_load(there + 12 + k);
    }
    for (int r = 0; r < 3; ++r) force[lane / LANES][r][lane % LANES] += sum[0][r] + sum[1][r] + sum[2][r] + held[0][r];
    for (int k = 0; k < numbers - 3; ++k) hold[lane / LANES][k][lane % LANES] += held[(3 + k) / QUAD][(3 + k) % QUAD];
  }
}

LANES_INLINE void resist_together(const Correspondence *c, int64_t slice, bool scaled, Control control,
                                  Lanes force[HALVES][3], Lanes hold[HALVES][6])
{
  const Family *f = c->family;
  const int numbers = hold_is_read(control) ? 3 + hold_components(control) : 0, length = state_length(control);
  for (int half = 0; half < HALVES; ++half) {
    Lanes own[3], sum[3][3] = {{{0}}}, held[3 * QUAD] = {{0}};
    for (int k = 0; k < 3; ++k) own[k] = lanes_load(c->particles->position[k] + slice * SLICE + LANES * half);
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      const int64_t at = (int64_t)f->base[slot] * SLICE + LANES * half;
      const Lanes factor = scaled ? lanes_load(f->scale + at) : lanes_set(1);
      family_fetch_ahead(f, at, c->row, length);
      for (int k = 0; k < 3; ++k) {
        Lanes q[QUAD];
        lanes_gather_rows(c->row + 4 * k, length, f->neighbour + at, q);
        Lanes xi = lanes_intact(f->intact[slot], half, q[3] - own[k]);
        if (scaled) xi *= factor;
        for (int r = 0; r < 3; ++r) sum[k][r] += q[r] * xi;
      }
      for (int k = 0; k < numbers; k += QUAD) {
        Lanes q[QUAD];
        lanes_gather_rows(c->row + 12 + k, length, f->neighbour + at, q);
        for (int r = 0; r < QUAD; ++r) {
          q[r] = lanes_intact(f->intact[slot], half, q[r]);
          held[k + r] += scaled ? q[r] * factor : q[r];
        }
      }
    }
    for (int r = 0; r < 3; ++r) force[half][r] += sum[0][r] + sum[1][r] + sum[2][r] + held[r];
    for (int k = 0; k < numbers - 3; ++k) hold[half][k] += held[3 + k];
  }
}

/** Adds a slice's stored bonds to forces and to sums of C. */
LANES_INLINE void correspondence_resist_stored(const Correspondence *c, int64_t slice, bool scaled, Control control,
                                               Lanes force[HALVES][3], Lanes hold[HALVES][6])
{
  if (HALVES == 1)
    resist_together(c, slice, scaled, control, force, hold);
  else
    resist_one_by_one(c, slice, scaled, control, force, hold);
}

#endif
