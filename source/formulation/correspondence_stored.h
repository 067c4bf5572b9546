/* Sweeps of correspondence over bonds one by one, where neighbours stand anywhere; part of correspondence_sweep.c. Place by place around a slice
 * (family/surroundings.h): what is read of a place lies together, and each number of it goes to all lanes. Each particle adds up its bonds in the order
 * of places. */
#ifndef BRECCIA_FORMULATION_CORRESPONDENCE_STORED_H
#define BRECCIA_FORMULATION_CORRESPONDENCE_STORED_H

#include "formulation/correspondence.h"

/** Position, and displacement and volume as sums read them, of the places of some slices. */
static inline void correspondence_show_places(const Correspondence *c, double *const *u, int64_t first, int64_t last)
{
  const Particles *p = c->particles;
  for (int64_t place = first * SLICE; place < last * SLICE; ++place) {
    double *shown = c->shown + CORRESPONDENCE_SHOWN * place;
    for (int k = 0; k < 3; ++k) {
      shown[k] = p->position[k][place];
      shown[4 + k] = p->volume[place] * u[k][place];
    }
    shown[7] = p->volume[place];
  }
}

/** Adds a slice's stored bonds to sums of V u times xi, and of V u. @param[in] scaled  parts of volumes count */
LANES_INLINE void correspondence_deform_stored(const Correspondence *c, int64_t slice, bool scaled,
                                               Lanes sums[3][HALVES][4])
{
  const Surroundings *around = &c->around;
  for (int half = 0; half < HALVES; ++half) {
    Lanes own[3], sum[3][4] = {{{0}}};
    for (int k = 0; k < 3; ++k) own[k] = lanes_load(c->particles->position[k] + slice * SLICE + LANES * half);
    for (int64_t n = around->first[slice]; n < around->first[slice + 1]; ++n) {
      const double *there = c->shown + (int64_t)around->place[n] * CORRESPONDENCE_SHOWN;
      Lanes xi[3];
      surroundings_fetch_ahead(around, n, c->shown, CORRESPONDENCE_SHOWN);
      for (int k = 0; k < 3; ++k) xi[k] = lanes_set(there[k]) - own[k];
      for (int r = 0; r < 3; ++r) {
        const Lanes u = scaled ? lanes_set(there[4 + r]) * lanes_load(around->scale + n * SLICE + LANES * half)
                               : lanes_intact(around->lanes[n], half, lanes_set(there[4 + r]));
        for (int k = 0; k < 3; ++k) sum[r][k] += u * xi[k];
        sum[r][3] += u;
      }
    }
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 4; ++k) sums[r][half][k] += sum[r][k];
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
                                               Lanes force[HALVES][3], Lanes hold[HALVES][6])
{
  const Surroundings *around = &c->around;
  const int numbers = hold_is_read(control) ? 3 + hold_components(control) : 0, length = state_length(control);
  for (int half = 0; half < HALVES; ++half) {
    Lanes own[3], sum[3][3] = {{{0}}}, held[3 + 6] = {{0}};
    for (int k = 0; k < 3; ++k) own[k] = lanes_load(c->particles->position[k] + slice * SLICE + LANES * half);
    for (int64_t n = around->first[slice]; n < around->first[slice + 1]; ++n) {
      const double *there = c->row + (int64_t)around->place[n] * length;
      const unsigned intact = around->lanes[n];
      const Lanes factor = scaled ? lanes_load(around->scale + n * SLICE + LANES * half) : lanes_set(1);
      surroundings_fetch_ahead(around, n, c->row, length);
      for (int k = 0; k < 3; ++k) {
        Lanes xi = lanes_set(there[4 * k + 3]) - own[k];
        xi = scaled ? xi * factor : lanes_intact(intact, half, xi);
        for (int r = 0; r < 3; ++r) sum[k][r] += lanes_set(there[4 * k + r]) * xi;
      }
      for (int k = 0; k < numbers; ++k)
        held[k] += scaled ? lanes_set(there[12 + k]) * factor : lanes_intact(intact, half, lanes_set(there[12 + k]));
    }
    for (int r = 0; r < 3; ++r) force[half][r] += sum[0][r] + sum[1][r] + sum[2][r] + held[r];
    for (int k = 0; k < numbers - 3; ++k) hold[half][k] += held[3 + k];
  }
}

#endif
