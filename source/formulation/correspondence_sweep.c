/* Sweeps of correspondence over bonds (formulation/correspondence.h), for each kind of vectors. */
#include "formulation/correspondence_stored.h"

#include <stddef.h>

/* ---- bonds slot by slot, on lattices ---- */

/** Steps over the slots of a whole row. @return the row's last slot, or slot - 1 if there begins no whole row
 *  @param[in,out] whole  the next whole row of the slice */
LANES_INLINE int64_t step_over_row(const Family *f, int64_t slice, int64_t slot, const uint16_t **whole,
                                   const uint16_t *end)
{
  if (*whole == end || family_row(f, slice, slot) != family_row(f, slice, f->first[slice] + **whole)) return slot - 1;
  const int row = family_row(f, slice, slot);
  while (slot < f->stored[slice] && family_row(f, slice, slot) == row) ++slot;
  ++*whole;
  return slot - 1;
}

/** Slots of no whole row, on the lattice. Component by component: four sums for each half of a slice, and what they are made
 *  from, fit into 16 registers. */
LANES_INLINE void deform_lattice(const Correspondence *c, double *const *displacement, int64_t slice, bool gaps,
                                 Lanes sums[3][HALVES][4])
{
  const Family *f = c->family;
  bool ragged = gaps && f->rows.condition[slice] & ROWS_RAGGED;
  int64_t last = ragged ? f->stored[slice] : f->rows.first[slice];
  for (int k = 0; k < 3; ++k) {
    const double *u = displacement[k];
    const uint16_t *whole = f->rows.whole + f->rows.begin[slice], *end = whole + f->rows.count[slice];
    Lanes sum[HALVES][4] = {{{0}}};
    for (int64_t slot = f->first[slice]; slot < last; ++slot) {
      if (ragged) {
        int64_t over = step_over_row(f, slice, slot, &whole, end);
        if (over >= slot) {
          slot = over;
          continue;
        }
      }
      const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
      for (int half = 0; half < HALVES; ++half) {
        Lanes there = lanes_load(u + family_base(f, slice, slot) + LANES * half);
        if (gaps) there = lanes_intact(f->intact[slot], half, there);
        for (int j = 0; j < 3; ++j) sum[half][j] += there * lanes_set(row->weighted_xi[j]);
        sum[half][3] += there * lanes_set(row->weight);
      }
    }
    for (int half = 0; half < HALVES; ++half)
      for (int j = 0; j < 4; ++j) sums[k][half][j] += sum[half][j];
  }
}

/** Adds one slot to forces and to sums of C. */
LANES_INLINE void resist_slot(const Correspondence *c, int64_t slice, int64_t slot, bool gaps, Control control,
                              Lanes force[HALVES][3], Lanes hold[HALVES][6])
{
  const Family *f = c->family;
  const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
  for (int half = 0; half < HALVES; ++half) {
    const int64_t there = family_base(f, slice, slot) + LANES * half;
    for (int r = 0; r < 3; ++r) {
      Lanes sum = lanes_load(c->state[3 * r] + there) * lanes_set(row->weighted_xi[0]);
      sum += lanes_load(c->state[3 * r + 1] + there) * lanes_set(row->weighted_xi[1]);
      sum += lanes_load(c->state[3 * r + 2] + there) * lanes_set(row->weighted_xi[2]);
      if (hold_is_read(control)) sum += lanes_load(c->held[r] + there) * lanes_set(row->weight);
      force[half][r] += gaps ? lanes_intact(f->intact[slot], half, sum) : sum;
    }
    for (int k = 0; hold_is_read(control) && k < hold_components(control); ++k) {
      Lanes sum = lanes_load(c->hold[k] + there) * lanes_set(row->weight);
      hold[half][k] += gaps ? lanes_intact(f->intact[slot], half, sum) : sum;
    }
  }
}

LANES_INLINE void resist_lattice(const Correspondence *c, int64_t slice, bool gaps, Control control,
                                 Lanes force[HALVES][3], Lanes hold[HALVES][6])
{
  const Family *f = c->family;
  bool ragged = gaps && f->rows.condition[slice] & ROWS_RAGGED;
  int64_t last = ragged ? f->stored[slice] : f->rows.first[slice];
  const uint16_t *whole = f->rows.whole + f->rows.begin[slice], *end = whole + f->rows.count[slice];
  for (int64_t slot = f->first[slice]; slot < last; ++slot) {
    if (ragged) {
      int64_t over = step_over_row(f, slice, slot, &whole, end);
      if (over >= slot) {
        slot = over;
        continue;
      }
    }
    resist_slot(c, slice, slot, gaps, control, force, hold);
  }
}

/* ---- bonds by whole rows ---- */

/** With the thread's window in the place of sums of all slices, `numbers` of a place and kind. */
LANES_INLINE Correspondence in_window(const Correspondence *c, const Sweep *sweep, int numbers)
{
  Correspondence own = *c;
  if (!sweep->window) return own;
  own.round = sweep->window_slices * SLICE - 1;
  for (int kind = 0; kind < c->family->rows.kinds; ++kind)
    own.row_displacement[kind] = own.row_pull[kind] = sweep->window + kind * sweep->window_slices * SLICE * numbers;
  return own;
}

static int64_t show_displacements(const Correspondence *correspondence, const Sweep *sweep)
{
  const Correspondence local = in_window(correspondence, sweep, 6), *c = &local;
  const int64_t first = sweep->first, last = sweep->last;
  const LatticeRows *rows = &c->family->rows;
  if (c->shown) correspondence_show_places(c, sweep->displacement, first, last);
  for (int64_t slice = first; slice < last; ++slice)
    for (int kind = 0; kind < rows->kinds; ++kind) {
      const RowKind *row = &rows->kind[c->particles->block[slice] * ROW_KINDS + kind];
      double *out = c->row_displacement[kind] + (slice * SLICE & c->round) * 6;
      for (int k = 0; k < 3; ++k)
        lattice_row_sums(rows, row, slice, sweep->displacement[k], out + (2 * k + 1) * SLICE, out + 2 * k * SLICE);
    }
  return -1;
}

LANES_INLINE void deform_rows(const Correspondence *c, int64_t slice, Lanes sums[3][HALVES][4])
{
  const LatticeRows *rows = &c->family->rows;
  const Lattice *lattice = &c->family->lattices[c->particles->block[slice]];
  const uint16_t *begin = rows->whole + rows->begin[slice], *end = begin + rows->count[slice];
  const int64_t entry = c->family->first[slice] + c->family->entry[slice];
  const uint16_t *patterns = c->family->pattern + entry;
  const int32_t *bases = c->family->base + entry;
  for (int half = 0; half < HALVES; ++half) {
    Lanes sum[3][4] = {{{0}}};
    for (const uint16_t *row = begin; row < end; ++row) {
      const Pattern *pattern = &c->family->patterns[patterns[*row]];
      const double *there =
          c->row_displacement[pattern->kind] + ((bases[*row] + slice * SLICE) & c->round) * 6 + LANES * half;
      for (int k = 0; k < 6 / HALVES; ++k)
        __builtin_prefetch(there + (6 + 3 * half + k) * SLICE); /* for the next slice: 5 to 10 % */
      Lanes across[2] = {lanes_set(pattern->xi[lattice->across[0]]), lanes_set(pattern->xi[lattice->across[1]])};
      for (int k = 0; k < 3; ++k) {
        Lanes u = lanes_load(there + (2 * k + 1) * SLICE);
        sum[k][0] += lanes_load(there + 2 * k * SLICE);
        sum[k][1] += u * across[0];
        sum[k][2] += u * across[1];
        sum[k][3] += u;
      }
    }
    for (int k = 0; k < 3; ++k) {
      sums[k][half][lattice->axis] += sum[k][0];
      sums[k][half][lattice->across[0]] += sum[k][1];
      sums[k][half][lattice->across[1]] += sum[k][2];
      sums[k][half][3] += sum[k][3];
    }
  }
}

static int64_t sum_states(const Correspondence *correspondence, const Sweep *sweep)
{
  const Correspondence local = in_window(correspondence, sweep, correspondence->pulls), *c = &local;
  const LatticeRows *rows = &c->family->rows;
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice) {
    int block = c->particles->block[slice];
    const Lattice *lattice = &c->family->lattices[block];
    for (int kind = 0; kind < rows->kinds; ++kind) {
      const RowKind *row = &rows->kind[block * ROW_KINDS + kind];
      double *out = c->row_pull[kind] + (slice * SLICE & c->round) * c->pulls;
      for (int r = 0; r < 3; ++r) {
        lattice_row_sums(rows, row, slice, c->state[3 * r + lattice->axis], NULL, out + 3 * r * SLICE);
        for (int k = 0; k < 2; ++k)
          lattice_row_sums(rows, row, slice, c->state[3 * r + lattice->across[k]], out + (3 * r + 1 + k) * SLICE, NULL);
      }
      for (int k = 9; k < c->pulls; ++k)
        lattice_row_sums(rows, row, slice, k < 12 ? c->held[k - 9] : c->hold[k - 12], out + k * SLICE, NULL);
    }
  }
  return -1;
}

LANES_INLINE void resist_rows(const Correspondence *c, int64_t slice, Control control, Lanes force[HALVES][3],
                              Lanes hold[HALVES][6])
{
  const LatticeRows *rows = &c->family->rows;
  const Lattice *lattice = &c->family->lattices[c->particles->block[slice]];
  const uint16_t *begin = rows->whole + rows->begin[slice], *end = begin + rows->count[slice];
  const int64_t entry = c->family->first[slice] + c->family->entry[slice];
  const uint16_t *patterns = c->family->pattern + entry;
  const int32_t *bases = c->family->base + entry;
  for (const uint16_t *row = begin; row < end; ++row) {
    const Pattern *pattern = &c->family->patterns[patterns[*row]];
    const double *there = c->row_pull[pattern->kind] + ((bases[*row] + slice * SLICE) & c->round) * c->pulls;
    for (int k = 0; k < 9; ++k) __builtin_prefetch(there + (9 + k) * SLICE); /* as above */
    Lanes across[2] = {lanes_set(pattern->xi[lattice->across[0]]), lanes_set(pattern->xi[lattice->across[1]])};
    for (int half = 0; half < HALVES; ++half)
      for (int r = 0; r < 3; ++r) {
        const double *pull = there + LANES * half;
        force[half][r] += lanes_load(pull + 3 * r * SLICE);
        for (int k = 0; k < 2; ++k) force[half][r] += lanes_load(pull + (3 * r + 1 + k) * SLICE) * across[k];
        if (hold_is_read(control)) force[half][r] += lanes_load(pull + (9 + r) * SLICE);
      }
    for (int half = 0; half < HALVES && hold_is_read(control); ++half)
      for (int k = 0; k < hold_components(control); ++k)
        hold[half][k] += lanes_load(there + LANES * half + (12 + k) * SLICE);
  }
}

/* ---- the three sweeps ---- */

/* In a linearised step displacements are changes v, G their gradient; at is then the gradient of the displacements held, G0, of these
 * lanes, and delta E = sym (F^T G), F = I + G0. */
LANES_INLINE void strain_half(const Correspondence *c, const SliceShape *shape, int lane, Lanes sums[3][4],
                              double *gradients, const double *at, double *const strains[6], int64_t here)
{
  Lanes inverse[6], g[9], g0[9];
  for (int k = 0; k < 6; ++k) inverse[k] = lanes_load(shape->inverse[k] + lane);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k)
      g[3 * r + k] = sums[r][0] * inverse[symmetric_place[k]] + sums[r][1] * inverse[symmetric_place[3 + k]] +
                     sums[r][2] * inverse[symmetric_place[6 + k]];
  for (int k = 0; k < 9; ++k) lanes_store(gradients + k * BATCH, g[k]);
  for (int k = 0; k < 9 && at; ++k) g0[k] = lanes_load(at + k * SLICE);
  for (int k = 0; k < 6; ++k) {
    if (k == ZZ && c->points->plane_stress) continue; /* that strain is the law's affair */
    int r = symmetric_row[k], col = symmetric_column[k];
    Lanes strain = g[3 * r + col] + g[3 * col + r];
    if (c->finite && !at) strain += g[r] * g[col] + g[3 + r] * g[3 + col] + g[6 + r] * g[6 + col];
    for (int j = 0; j < 3 && c->finite && at; ++j)
      strain += g0[3 * j + r] * g[3 * j + col] + g[3 * j + r] * g0[3 * j + col];
    lanes_store(strains[k] + here, k < 3 ? strain * lanes_set(0.5) : strain);
  }
}

LANES_INLINE void deform_slice(const Correspondence *c, int64_t slice, const Sweep *sweep, bool linear)
{
  const Family *f = c->family;
  const SliceShape *shape = shape_of_slice(&c->shapes, slice);
  const int64_t here = (slice - sweep->first) * SLICE;
  Lanes sums[3][HALVES][4] = {{{{0}}}};
  deform_rows(c, slice, sums);
  if (f->rows.condition[slice] & ROWS_GAPS)
    deform_lattice(c, sweep->displacement, slice, true, sums);
  else
    deform_lattice(c, sweep->displacement, slice, false, sums);
  if (f->stored[slice] < f->first[slice + 1]) {
    if (f->scale)
      correspondence_deform_stored(c, slice, true, sums);
    else
      correspondence_deform_stored(c, slice, false, sums);
  }
  for (int half = 0; half < HALVES; ++half) {
    const int lane = LANES * half;
    int64_t place = slice * SLICE + lane;
    Lanes moved[3][4];
    for (int k = 0; k < 3; ++k) {
      Lanes u = lanes_load(sweep->displacement[k] + place);
      for (int j = 0; j < 3; ++j) moved[k][j] = sums[k][half][j] - u * lanes_load(shape->first_moment[j] + lane);
      lanes_store(c->relative[k] + place, sums[k][half][3] - u * lanes_load(shape->weight_sum + lane));
    }
    strain_half(c, shape, lane, moved, sweep->carry + here + lane,
                linear ? c->gradients + slice * (9 * SLICE) + lane : NULL, sweep->strain, here + lane);
  }
}

static int64_t deform(const Correspondence *correspondence, const Sweep *sweep)
{
  const Correspondence local = in_window(correspondence, sweep, 6),
                       *c = &local; /* so that stores are seen not to change it */
  const Sweep own = *sweep;
  for (int64_t slice = own.first; slice < own.last; ++slice)
    if (own.linearised_at)
      deform_slice(c, slice, &own, true);
    else
      deform_slice(c, slice, &own, false);
  return -1;
}

/** P = (I + G) S, or its change G S0 + (I + G0) S, with G and S the changes. */
LANES_INLINE void first_stress(const Correspondence *c, const Lanes g[9], const Lanes s[6], const Lanes g0[9],
                               const Lanes s0[6], bool linear, Lanes p[9])
{
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      p[3 * r + k] = s[symmetric_place[3 * r + k]];
      for (int j = 0; c->finite && j < 3; ++j)
        p[3 * r + k] += g[3 * r + j] * (linear ? s0 : s)[symmetric_place[3 * j + k]];
      for (int j = 0; c->finite && linear && j < 3; ++j) p[3 * r + k] += g0[3 * r + j] * s[symmetric_place[3 * j + k]];
    }
}

LANES_INLINE void respond_lanes(const Correspondence *c, const Sweep *sweep, int64_t place, bool linear)
{
  const SliceShape *shape = shape_of_slice(&c->shapes, place / SLICE);
  const int64_t here = place - sweep->first * SLICE;
  Lanes s[6], s0[6], g[9], g0[9], p[9], inverse[6], hold[6];
  for (int k = 0; k < 6; ++k) {
    const Lanes share = lanes_load(shape->share + place % SLICE);
    s[k] = lanes_load(sweep->stress[k] + here) * share;
    if (linear) s0[k] = lanes_load(c->points->stress[k] + place) * share;
    inverse[k] = lanes_load(shape->inverse[k] + place % SLICE);
  }
  hold[0] = lanes_set(c->uniform);
  for (int k = 0; k < hold_components(c->control); ++k) hold[k] = lanes_load(c->hold[k] + place);
  for (int k = 0; k < 9; ++k) g[k] = lanes_load(sweep->carry + here + k * BATCH);
  for (int k = 0; k < 9 && linear; ++k)
    g0[k] = lanes_load(c->gradients + place / SLICE * (9 * SLICE) + k * SLICE + place % SLICE);
  for (int k = 0; k < LANES && c->turns && !linear; k += QUAD)
    correspondence_keep_turn(c, place + k, sweep->carry + here + k);
  first_stress(c, g, s, g0, s0, linear, p);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      Lanes q = p[3 * r] * inverse[symmetric_place[k]] + p[3 * r + 1] * inverse[symmetric_place[3 + k]] +
                p[3 * r + 2] * inverse[symmetric_place[6 + k]];
      if (c->control == CONTROL_SCALAR || c->control == CONTROL_UNIFORM) q -= hold[0] * g[3 * r + k];
      for (int j = 0; c->control == CONTROL_TENSOR && j < 3; ++j) q -= hold[symmetric_place[3 * r + j]] * g[3 * j + k];
      lanes_store(c->state[3 * r + k] + place, q);
    }
  if (!hold_is_read(c->control)) return;
  Lanes u[3];
  for (int k = 0; k < 3; ++k) u[k] = lanes_load(sweep->displacement[k] + place);
  for (int r = 0; r < 3; ++r) {
    Lanes held = hold[0] * u[r];
    if (c->control == CONTROL_TENSOR)
      held = hold[symmetric_place[3 * r]] * u[0] + hold[symmetric_place[3 * r + 1]] * u[1] +
             hold[symmetric_place[3 * r + 2]] * u[2];
    lanes_store(c->held[r] + place, held);
  }
}

static int64_t respond(const Correspondence *c, const Sweep *sweep)
{
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; place += LANES)
    if (sweep->linearised_at)
      respond_lanes(c, sweep, place, true);
    else
      respond_lanes(c, sweep, place, false);
  for (int64_t place = sweep->first * SLICE; c->row && place < sweep->last * SLICE; ++place)
    correspondence_show_state(c, place);
  return -1;
}

LANES_INLINE void resist_slice(const Correspondence *c, const Sweep *sweep, int64_t slice, Control control)
{
  const Family *f = c->family;
  const SliceShape *shape = shape_of_slice(&c->shapes, slice);
  Lanes force[HALVES][3] = {{{0}}}, hold[HALVES][6] = {{{0}}};
  resist_rows(c, slice, control, force, hold);
  if (f->rows.condition[slice] & ROWS_GAPS)
    resist_lattice(c, slice, true, control, force, hold);
  else
    resist_lattice(c, slice, false, control, force, hold);
  if (f->stored[slice] < f->first[slice + 1]) {
    if (f->scale)
      correspondence_resist_stored(c, slice, true, control, force, hold);
    else
      correspondence_resist_stored(c, slice, false, control, force, hold);
  }
  unsigned lanes = lattice_rows_lanes(&f->rows, slice);
  for (int half = 0; half < HALVES; ++half) {
    int64_t place = slice * SLICE + LANES * half;
    Lanes u[3], relative[3];
    for (int k = 0; k < 3; ++k) {
      u[k] = lanes_load(sweep->displacement[k] + place);
      relative[k] = lanes_load(c->relative[k] + place);
    }
    for (int r = 0; r < 3; ++r) {
      Lanes sum = force[half][r];
      for (int j = 0; j < 3; ++j)
        sum += lanes_load(c->state[3 * r + j] + place) * lanes_load(shape->first_moment[j] + LANES * half);
      if (control == CONTROL_UNIFORM) sum += lanes_set(2 * c->uniform) * relative[r];
      if (control == CONTROL_SCALAR) sum += lanes_load(c->hold[0] + place) * relative[r] - hold[half][0] * u[r];
      for (int j = 0; control == CONTROL_TENSOR && j < 3; ++j) {
        int k = symmetric_place[3 * r + j];
        sum += lanes_load(c->hold[k] + place) * relative[j] - hold[half][k] * u[j];
      }
      lanes_store(sweep->internal[r] + place, lanes_intact(lanes, half, sum));
    }
  }
}

static int64_t resist(const Correspondence *correspondence, const Sweep *sweep)
{
  const Correspondence local = in_window(correspondence, sweep, correspondence->pulls),
                       *c = &local; /* so that stores are seen not to change it */
  const int64_t last = sweep->last;
  for (int64_t slice = sweep->first; slice < last; ++slice)
    if (c->control == CONTROL_UNIFORM)
      resist_slice(c, sweep, slice, CONTROL_UNIFORM);
    else if (c->control == CONTROL_SCALAR)
      resist_slice(c, sweep, slice, CONTROL_SCALAR);
    else if (c->control == CONTROL_NONE)
      resist_slice(c, sweep, slice, CONTROL_NONE);
    else
      resist_slice(c, sweep, slice, CONTROL_TENSOR);
  return -1;
}

const CorrespondenceSweeps LANES_NAMED(correspondence_sweeps) = {.show_displacements = show_displacements,
                                                                 .deform = deform,
                                                                 .respond = respond,
                                                                 .sum_states = sum_states,
                                                                 .resist = resist};
