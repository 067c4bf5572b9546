#include "formulation/correspondence.h"

#include "family/slots.h"

/* ---- bonds slot by slot ---- */

/** A slot with its weights and weighted reference vectors, by halves of the slice. */
typedef struct Weighted {
  Slot slot;
  Lanes weight[2], xi[2][3];
} Weighted;

LANES_INLINE Weighted weighted_open(const Correspondence *c, int64_t slot, int64_t slice, bool lattice)
{
  const Family *f = c->family;
  Weighted s = {.slot = slot_open(f, slot, lattice)};
  if (lattice) {
    const Pattern *row = &f->patterns[f->pattern[slot]];
    s.weight[0] = s.weight[1] = lanes_set(row->weight);
    for (int k = 0; k < 3; ++k) s.xi[0][k] = s.xi[1][k] = lanes_set(row->weighted_xi[k]);
    return s;
  }
  for (int half = 0; half < 2; ++half) {
    s.weight[half] = lanes_load(f->weight + s.slot.at + LANES * half);
    slot_reference(&s.slot, c->particles, slice, half, s.xi[half]);
    for (int k = 0; k < 3; ++k) s.xi[half][k] *= s.weight[half];
  }
  return s;
}

/** Adds to moments [0..2] and weighted sum [3] of one component of the displacements. */
LANES_INLINE void deform_slot(const Weighted *s, bool gaps, unsigned bits, const double *u, Lanes sum[2][4])
{
  for (int half = 0; half < 2; ++half) {
    Lanes there = slot_read(&s->slot, half, u);
    if (gaps) there = lanes_where(half_mask(bits, half), there);
    for (int j = 0; j < 3; ++j) sum[half][j] += there * s->xi[half][j];
    sum[half][3] += there * s->weight[half];
  }
}

/** Slots of no whole row, on the lattice. Component by component: four sums for each half of a slice, and what they are made
 *  from, fit into 16 registers. */
LANES_INLINE void deform_lattice(const Correspondence *c, int64_t slice, bool gaps, Lanes sums[3][2][4])
{
  const Family *f = c->family;
  bool ragged = gaps && f->rows.condition[slice] & ROWS_RAGGED;
  int64_t last = ragged ? f->stored[slice] : f->rows.first[slice];
  for (int k = 0; k < 3; ++k) {
    const double *u = c->particles->displacement[k];
    Lanes sum[2][4] = {{{0}}};
    for (int64_t slot = f->first[slice]; slot < last; ++slot) {
      if (ragged && f->rows.skip[slot]) {
        slot += f->rows.skip[slot] - 1;
        continue;
      }
      Weighted s = weighted_open(c, slot, slice, true);
      deform_slot(&s, gaps, f->intact[slot], u, sum);
    }
    for (int half = 0; half < 2; ++half)
      for (int j = 0; j < 4; ++j) sums[k][half][j] += sum[half][j];
  }
}

LANES_INLINE void deform_stored(const Correspondence *c, int64_t from, int64_t to, int64_t slice, Lanes sums[3][2][4])
{
  for (int64_t slot = from; slot < to; ++slot) {
    Weighted s = weighted_open(c, slot, slice, false);
    for (int k = 0; k < 3; ++k) deform_slot(&s, true, c->family->intact[slot], c->particles->displacement[k], sums[k]);
  }
}

LANES_INLINE void resist_slot(const Correspondence *c, const Weighted *s, bool gaps, unsigned bits, Control control,
                              Lanes force[2][3], Lanes hold[2][6])
{
  for (int half = 0; half < 2; ++half) {
    LaneMask mask = {0};
    if (gaps) mask = half_mask(bits, half);
    for (int r = 0; r < 3; ++r) {
      Lanes f = slot_read(&s->slot, half, c->state[3 * r]) * s->xi[half][0];
      f += slot_read(&s->slot, half, c->state[3 * r + 1]) * s->xi[half][1];
      f += slot_read(&s->slot, half, c->state[3 * r + 2]) * s->xi[half][2];
      if (hold_is_read(control)) f += slot_read(&s->slot, half, c->held[r]) * s->weight[half];
      force[half][r] += gaps ? lanes_where(mask, f) : f;
    }
    for (int k = 0; hold_is_read(control) && k < hold_components(control); ++k) {
      Lanes h = slot_read(&s->slot, half, c->hold[k]) * s->weight[half];
      hold[half][k] += gaps ? lanes_where(mask, h) : h;
    }
  }
}

LANES_INLINE void resist_lattice(const Correspondence *c, int64_t slice, bool gaps, Control control, Lanes force[2][3],
                                 Lanes hold[2][6])
{
  const Family *f = c->family;
  bool ragged = gaps && f->rows.condition[slice] & ROWS_RAGGED;
  int64_t last = ragged ? f->stored[slice] : f->rows.first[slice];
  for (int64_t slot = f->first[slice]; slot < last; ++slot) {
    if (ragged && f->rows.skip[slot]) {
      slot += f->rows.skip[slot] - 1;
      continue;
    }
    Weighted s = weighted_open(c, slot, slice, true);
    resist_slot(c, &s, gaps, f->intact[slot], control, force, hold);
  }
}

/* ---- bonds by whole rows ---- */

BRECCIA_CLONES
static void sum_displacements(void *formulation, int64_t first, int64_t last)
{
  const Correspondence *c = formulation;
  const LatticeRows *rows = &c->family->rows;
  for (int64_t slice = first; slice < last; ++slice)
    for (int kind = 0; kind < rows->kinds; ++kind) {
      const RowKind *row = &rows->kind[c->particles->block[slice] * ROW_KINDS + kind];
      double *out = c->row_displacement[kind] + slice * (6 * SLICE);
      for (int k = 0; k < 3; ++k)
        lattice_row_sums(rows, row, slice, c->particles->displacement[k], out + (2 * k + 1) * SLICE,
                         out + 2 * k * SLICE);
    }
}

LANES_INLINE void deform_rows(const Correspondence *c, int64_t slice, Lanes sums[3][2][4])
{
  const LatticeRows *rows = &c->family->rows;
  const Lattice *lattice = &c->family->lattices[c->particles->block[slice]];
  const WholeRow *begin = rows->whole + rows->begin[slice], *end = begin + rows->count[slice];
  for (int half = 0; half < 2; ++half) {
    Lanes sum[3][4] = {{{0}}};
    for (const WholeRow *row = begin; row < end; ++row) {
      const Pattern *pattern = &c->family->patterns[row->pattern];
      const double *there = c->row_displacement[pattern->kind] + (int64_t)row->middle * (6 * SLICE) + LANES * half;
      for (int k = 0; k < 3; ++k)
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

BRECCIA_CLONES
static void sum_states(void *formulation, int64_t first, int64_t last)
{
  const Correspondence *c = formulation;
  const LatticeRows *rows = &c->family->rows;
  for (int64_t slice = first; slice < last; ++slice) {
    int block = c->particles->block[slice];
    const Lattice *lattice = &c->family->lattices[block];
    for (int kind = 0; kind < rows->kinds; ++kind) {
      const RowKind *row = &rows->kind[block * ROW_KINDS + kind];
      double *out = c->row_pull[kind] + slice * (c->pulls * SLICE);
      for (int r = 0; r < 3; ++r) {
        lattice_row_sums(rows, row, slice, c->state[3 * r + lattice->axis], NULL, out + 3 * r * SLICE);
        for (int k = 0; k < 2; ++k)
          lattice_row_sums(rows, row, slice, c->state[3 * r + lattice->across[k]], out + (3 * r + 1 + k) * SLICE, NULL);
      }
      for (int k = 9; k < c->pulls; ++k)
        lattice_row_sums(rows, row, slice, k < 12 ? c->held[k - 9] : c->hold[k - 12], out + k * SLICE, NULL);
    }
  }
}

LANES_INLINE void resist_rows(const Correspondence *c, int64_t slice, Control control, Lanes force[2][3],
                              Lanes hold[2][6])
{
  const LatticeRows *rows = &c->family->rows;
  const Lattice *lattice = &c->family->lattices[c->particles->block[slice]];
  const WholeRow *begin = rows->whole + rows->begin[slice], *end = begin + rows->count[slice];
  for (const WholeRow *row = begin; row < end; ++row) {
    const Pattern *pattern = &c->family->patterns[row->pattern];
    const double *there = c->row_pull[pattern->kind] + (int64_t)row->middle * (c->pulls * SLICE);
    for (int k = 0; k < 9; ++k) __builtin_prefetch(there + (9 + k) * SLICE); /* as above */
    Lanes across[2] = {lanes_set(pattern->xi[lattice->across[0]]), lanes_set(pattern->xi[lattice->across[1]])};
    for (int half = 0; half < 2; ++half)
      for (int r = 0; r < 3; ++r) {
        const double *pull = there + LANES * half;
        force[half][r] += lanes_load(pull + 3 * r * SLICE);
        for (int k = 0; k < 2; ++k) force[half][r] += lanes_load(pull + (3 * r + 1 + k) * SLICE) * across[k];
        if (hold_is_read(control)) force[half][r] += lanes_load(pull + (9 + r) * SLICE);
      }
    for (int half = 0; half < 2 && hold_is_read(control); ++half)
      for (int k = 0; k < hold_components(control); ++k)
        hold[half][k] += lanes_load(there + LANES * half + (12 + k) * SLICE);
  }
}

/* ---- the three sweeps ---- */

LANES_INLINE void strain_half(const Correspondence *c, const SliceShape *shape, int64_t place, Lanes sums[3][4],
                              double *gradients)
{
  Lanes inverse[6], g[9];
  for (int k = 0; k < 6; ++k) inverse[k] = lanes_load(shape->inverse[k] + place % SLICE);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k)
      g[3 * r + k] = sums[r][0] * inverse[symmetric_place[k]] + sums[r][1] * inverse[symmetric_place[3 + k]] +
                     sums[r][2] * inverse[symmetric_place[6 + k]];
  for (int k = 0; k < 9; ++k) lanes_store(gradients + k * BLOCK, g[k]);
  for (int k = 0; k < 6; ++k) {
    if (k == ZZ && c->points->space == SPACE_PLANE_STRESS) continue; /* that strain is the law's affair */
    int r = symmetric_row[k], col = symmetric_column[k];
    Lanes strain = g[3 * r + col] + g[3 * col + r];
    if (c->finite) strain += g[r] * g[col] + g[3 + r] * g[3 + col] + g[6 + r] * g[6 + col];
    lanes_store(c->points->strain[k] + place, k < 3 ? strain * lanes_set(0.5) : strain);
  }
}

LANES_INLINE void deform_slice(const Correspondence *c, int64_t slice, double *gradients)
{
  const Family *f = c->family;
  const SliceShape *shape = shape_of_slice(&c->shapes, slice);
  Lanes sums[3][2][4] = {{{{0}}}};
  deform_rows(c, slice, sums);
  if (f->rows.condition[slice] & ROWS_GAPS)
    deform_lattice(c, slice, true, sums);
  else
    deform_lattice(c, slice, false, sums);
  if (f->stored[slice] < f->first[slice + 1]) deform_stored(c, f->stored[slice], f->first[slice + 1], slice, sums);
  for (int half = 0; half < 2; ++half) {
    int64_t place = slice * SLICE + LANES * half;
    Lanes moved[3][4];
    for (int k = 0; k < 3; ++k) {
      Lanes u = lanes_load(c->particles->displacement[k] + place);
      for (int j = 0; j < 3; ++j)
        moved[k][j] = sums[k][half][j] - u * lanes_load(shape->first_moment[j] + LANES * half);
      lanes_store(c->stretch[k] + place, sums[k][half][3] - u * lanes_load(shape->weight_sum + LANES * half));
    }
    strain_half(c, shape, place, moved, gradients + LANES * half);
  }
}

BRECCIA_CLONES
static void deform(void *formulation, int64_t first, int64_t last, double *gradients)
{
  const Correspondence local = *(const Correspondence *)formulation,
                       *c = &local; /* so that stores are seen not to change it */
  for (int64_t slice = first; slice < last; ++slice) deform_slice(c, slice, gradients + (slice - first) * SLICE);
}

LANES_INLINE void respond_lanes(const Correspondence *c, int64_t place, const double *gradients)
{
  const SliceShape *shape = shape_of_slice(&c->shapes, place / SLICE);
  Lanes s[6], g[9], p[9], inverse[6], hold[6];
  for (int k = 0; k < 6; ++k) {
    s[k] = lanes_load(c->points->stress[k] + place);
    inverse[k] = lanes_load(shape->inverse[k] + place % SLICE);
  }
  hold[0] = lanes_set(c->uniform);
  for (int k = 0; k < hold_components(c->control); ++k) hold[k] = lanes_load(c->hold[k] + place);
  for (int k = 0; k < 9; ++k) g[k] = lanes_load(gradients + k * BLOCK);
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
  if (!hold_is_read(c->control)) return;
  Lanes u[3];
  for (int k = 0; k < 3; ++k) u[k] = lanes_load(c->particles->displacement[k] + place);
  for (int r = 0; r < 3; ++r) {
    Lanes held = hold[0] * u[r];
    if (c->control == CONTROL_TENSOR)
      held = hold[symmetric_place[3 * r]] * u[0] + hold[symmetric_place[3 * r + 1]] * u[1] +
             hold[symmetric_place[3 * r + 2]] * u[2];
    lanes_store(c->held[r] + place, held);
  }
}

BRECCIA_CLONES
static void respond(void *formulation, int64_t first, int64_t last, const double *gradients)
{
  for (int64_t place = first * SLICE; place < last * SLICE; place += LANES)
    respond_lanes(formulation, place, gradients + place - first * SLICE);
}

LANES_INLINE void resist_slice(const Correspondence *c, int64_t slice, Control control)
{
  const Family *f = c->family;
  const SliceShape *shape = shape_of_slice(&c->shapes, slice);
  Lanes force[2][3] = {{{0}}}, hold[2][6] = {{{0}}};
  resist_rows(c, slice, control, force, hold);
  if (f->rows.condition[slice] & ROWS_GAPS)
    resist_lattice(c, slice, true, control, force, hold);
  else
    resist_lattice(c, slice, false, control, force, hold);
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
    Weighted s = weighted_open(c, slot, slice, false);
    resist_slot(c, &s, true, f->intact[slot], control, force, hold);
  }
  unsigned lanes = lattice_rows_lanes(&f->rows, slice);
  for (int half = 0; half < 2; ++half) {
    int64_t place = slice * SLICE + LANES * half;
    Lanes u[3], stretch[3];
    for (int k = 0; k < 3; ++k) {
      u[k] = lanes_load(c->particles->displacement[k] + place);
      stretch[k] = lanes_load(c->stretch[k] + place);
    }
    for (int r = 0; r < 3; ++r) {
      Lanes sum = force[half][r];
      for (int j = 0; j < 3; ++j)
        sum += lanes_load(c->state[3 * r + j] + place) * lanes_load(shape->first_moment[j] + LANES * half);
      if (control == CONTROL_UNIFORM) sum += lanes_set(2 * c->uniform) * stretch[r];
      if (control == CONTROL_SCALAR) sum += lanes_load(c->hold[0] + place) * stretch[r] - hold[half][0] * u[r];
      for (int j = 0; control == CONTROL_TENSOR && j < 3; ++j) {
        int k = symmetric_place[3 * r + j];
        sum += lanes_load(c->hold[k] + place) * stretch[j] - hold[half][k] * u[j];
      }
      lanes_store(c->particles->internal[r] + place, lanes_where(half_mask(lanes, half), sum));
    }
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

const FormulationType formulation_correspondence = {
    .name = "correspondence",
    .about = "non-ordinary state-based: one strain per particle from its family, with control of zero-energy modes",
    .source = "Silling et al. 2007; Silling 2017 and Wan et al. 2019 for the control",
    .maturity = "verified against patch tests and finite elements",
    .row_sums = true,
    .create = correspondence_create,
    .destroy = correspondence_destroy,
    .renew = correspondence_renew,
    .sum_displacements = sum_displacements,
    .deform = deform,
    .respond = respond,
    .sum_states = sum_states,
    .resist = resist,
    .finish = correspondence_finish,
    .bond_force = correspondence_bond_force,
    .gradient = correspondence_gradient,
    .bytes = correspondence_bytes,
};
