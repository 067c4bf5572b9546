/* Sweeps of correspondence over bonds one by one, where neighbours stand anywhere; correspondence.c compiles them into its clones.
 *
 * Vectors run over components here, not over particles: neighbours that lie scattered cost less to read so, and what is read of one
 * lies together (measured: 14 ns a bond with numbers gathered one by one, 6 with records turned round in registers, 5 so). */
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

/** Adds a slice's stored bonds to sums of V u times xi, and of V u, component by component. @param[in] scaled  parts of volumes count */
LANES_INLINE void correspondence_deform_stored(const Correspondence *c, int64_t slice, bool scaled, Lanes sums[3][2][4])
{
  const Family *f = c->family;
  const int64_t first = f->stored[slice], count = f->first[slice + 1] - first;
  const uint8_t *intact = f->intact + first;
  const double *shown = c->shown;
  for (int lane = 0; lane < SLICE; ++lane) {
    Lanes own[3], sum[4] = {{0}};
    const int64_t begin = (int64_t)f->base[first] * SLICE + lane;
    const int32_t *neighbour = f->neighbour + begin;
    const double *scale = scaled ? f->scale + begin : NULL;
    for (int k = 0; k < 3; ++k) own[k] = lanes_set(c->particles->position[k][slice * SLICE + lane]);
    for (int64_t n = 0; n < count; ++n) {
      if (!(intact[n] & 1u << lane)) continue;
      const double *there = shown + (int64_t)neighbour[n * SLICE] * CORRESPONDENCE_SHOWN;
      Lanes u = lanes_load(there + LANES);
      if (scaled) u *= lanes_set(scale[n * SLICE]);
      for (int k = 0; k < 3; ++k) sum[k] += u * (lanes_set(there[k]) - own[k]);
      sum[3] += u;
    }
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 4; ++j) sums[k][lane / LANES][j][lane % LANES] += sum[j][k];
  }
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

/** Adds a slice's stored bonds to forces and to sums of C. */
LANES_INLINE void correspondence_resist_stored(const Correspondence *c, int64_t slice, bool scaled, Control control,
                                               Lanes force[2][3], Lanes hold[2][6])
{
  const Family *f = c->family;
  const int64_t first = f->stored[slice], count = f->first[slice + 1] - first;
  const uint8_t *intact = f->intact + first;
  const double *rows = c->row;
  const int numbers = hold_is_read(control) ? 3 + hold_components(control) : 0, length = state_length(control);
  for (int lane = 0; lane < SLICE; ++lane) {
    Lanes own[3], sum[3] = {{0}}, held[3] = {{0}}; /* three sums, so that additions need not wait */
    const int64_t begin = (int64_t)f->base[first] * SLICE + lane;
    const int32_t *neighbour = f->neighbour + begin;
    const double *scale = scaled ? f->scale + begin : NULL;
    for (int k = 0; k < 3; ++k) own[k] = lanes_set(c->particles->position[k][slice * SLICE + lane]);
    for (int64_t n = 0; n < count; ++n) {
      if (!(intact[n] & 1u << lane)) continue;
      const double *there = rows + (int64_t)neighbour[n * SLICE] * length;
      Lanes factor = scaled ? lanes_set(scale[n * SLICE]) : lanes_set(1);
      for (int k = 0; k < 3; ++k) {
        Lanes xi = lanes_set(there[4 * k + 3]) - own[k];
        sum[k] += lanes_load(there + 4 * k) * (scaled ? xi * factor : xi);
      }
      for (int k = 0; k < numbers; k += LANES)
        held[k / LANES] += scaled ? lanes_load(there + 12 + k) * factor : lanes_load(there + 12 + k);
    }
    for (int r = 0; r < 3; ++r) force[lane / LANES][r][lane % LANES] += sum[0][r] + sum[1][r] + sum[2][r] + held[0][r];
    for (int k = 0; k < numbers - 3; ++k) hold[lane / LANES][k][lane % LANES] += held[(3 + k) / LANES][(3 + k) % LANES];
  }
}

#endif
