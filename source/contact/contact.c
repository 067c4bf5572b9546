#include "base/memory.h"
#include "contact/contact_parts.h"

#include "base/team.h"
#include "family/cells.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Field contact_fields[] = {
    {.key = "stiffness",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ContactSpec, stiffness),
     .dimension = "1",
     .standard = "1",
     .range = "(0, inf)",
     .meaning = "of faces that meet, over that of a layer of the body one spacing thick"},
    {.key = "friction",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ContactSpec, friction),
     .dimension = "1",
     .standard = "0",
     .range = "[0, inf)",
     .meaning = "Coulomb's coefficient, on faces of cuts and of different bodies: they stick until the force along "
                "them is this "
                "share of that across them, then slide. Faces of broken bonds interlock, whatever it is"},
};

const Section contact_section = {
    .name = "contact",
    .about = "Particles that no bond joins repel each other where they come near: bodies that meet, and crack faces "
             "that close. The faces of a cut or of broken bonds carry pressure as soon as they are nearer than they "
             "were, as stiffly as the bonds; other faces meet where their outermost particles are half a spacing of "
             "each apart. Without this section they pass through each other. It costs a shorter time step.",
    .size = sizeof(ContactSpec),
    FIELDS(contact_fields)};

/* ---- making ---- */

/** Moments of the fullest family of a block, or of that of its lattice: sums of V L and of V / L. */
static void family_moments(const Contact *c, int block, bool whole, double *first, double *inverse)
{
  const Family *f = c->family;
  const Particles *p = f->particles;
  *first = *inverse = 0;
  for (int n = f->pattern_begin[block]; n < f->pattern_begin[block + 1] && whole; ++n) {
    *first += c->body->lattices[block].volume * f->patterns[n].length;
    *inverse += c->body->lattices[block].volume / f->patterns[n].length;
  }
  if (*first > 0) return;
  for (int64_t slice = 0; slice < p->slices; ++slice)
    for (int lane = 0; p->block[slice] == block && lane < SLICE; ++lane) {
      double sum = 0, over = 0;
      for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        Bond bond = family_bond(f, slice, slot, lane);
        sum += p->volume[bond.neighbour] * bond.length;
        over += p->volume[bond.neighbour] / bond.length;
      }
      if (sum > *first) {
        *first = sum;
        *inverse = over;
      }
    }
}

/** Constants of bonds that are as stiff across a face as a column of the body, whose sides are free: bonds calibrated in uniform expansion, less
 *  what their own movement sideways would take; and bounds of eigenvalues: of half a family of them
 *  across a face, and of faces that meet. */
static void set_constants(Contact *c, Space space, const ForcesBlock *blocks)
{
  const Body *body = c->body;
  const Particles *p = &body->particles;
  const double expansion[] = {6, 3.2, 3, 1}; /* of Space, in Young's moduli */
  const double share[] = {5.0 / 6, 8.0 / 9, 8.0 / 9,
                          1}; /* Young's modulus over that of bonds whose ends do not move sideways */
  for (int b = 0; b < body->block_count; ++b) {
    double first, inverse, density = INFINITY, across = 0;
    family_moments(c, b, blocks[b].alike, &first, &inverse);
    if (first > 0) c->constant[b] = blocks[b].bonds * share[space] * expansion[space] * c->young[b] / (first / 2);
    for (int64_t n = 0; n < p->count; ++n)
      if (p->block[p->place_of[n] / SLICE] == b) density = fmin(density, p->density[p->place_of[n]]);
    for (int o = 0; o < body->block_count; ++o) {
      const double spacing = body->lattices[b].spacing, mean = (spacing + body->lattices[o].spacing) / 2;
      across = fmax(across, 2 * c->young[b] * c->young[o] / (c->young[b] + c->young[o]) / (mean * spacing));
    }
    const double across_bonds = c->constant[b] * inverse / body->dimensions;
    c->smoothed[b] = contact_smoothed(c, b);
    c->stiffest = fmax(c->stiffest, fmax(1.2 * across_bonds, 3 * c->spec->stiffness * across) / density);
  }
}

static void add_cut_bonds(Contact *c);

int contact_create(Contact *c, const ContactSpec *spec, const Body *body, const Family *family, Space space,
                   const ForcesBlock *blocks, Error *error)
{
  const int64_t places = body->particles.places;
  *c = (Contact){.spec = spec, .body = body, .family = family, .margin = 0.3 * body->largest_spacing, .free_act = -1};
  if (!spec) return BRECCIA_OK;
  c->young = memory_zeroed((size_t)body->block_count, sizeof(double), "contact", error);
  c->smoothed = memory_zeroed((size_t)body->block_count, sizeof(double), "contact", error);
  c->marked = memory_zeroed((size_t)body->particles.slices, 1, "contact", error);
  c->constant = memory_zeroed((size_t)body->block_count, sizeof(double), "contact", error);
  c->touched = memory_zeroed((size_t)places, 1, "contact", error);
  c->row_of = memory_zeroed((size_t)places, sizeof(int32_t), "contact", error);
  if (!c->young || !c->smoothed || !c->marked || !c->constant || !c->touched || !c->row_of) return BRECCIA_FAILURE;
  for (int b = 0; b < body->block_count; ++b) c->young[b] = blocks[b].young;
  for (int64_t i = 0; i < places; ++i) c->row_of[i] = -1;
  set_constants(c, space, blocks);
  if (body->crack_count) {
    memset(c->touched, 1, (size_t)places);
    add_cut_bonds(c);
  }
  contact_search(c);
  return c->failed ? error_add(error, BRECCIA_FAILURE, "out of memory: contact") : BRECCIA_OK;
}

void contact_destroy(Contact *c)
{
  for (int32_t r = 0; r < c->row_count; ++r) {
    free(c->rows[r].pairs);
    free(c->rows[r].grips);
  }
  free(c->rows);
  free(c->acts);
  free(c->joints);
  free(c->steps);
  free(c->row_of);
  free(c->touched);
  free(c->young);
  free(c->smoothed);
  free(c->kept);
  free(c->marked);
  free(c->constant);
  *c = (Contact){.spec = NULL};
}

/* ---- pairs ---- */

ContactRow *contact_row_for(Contact *c, int32_t place)
{
  if (c->row_of[place] >= 0) return &c->rows[c->row_of[place]];
  if (c->row_count == c->row_capacity) {
    int32_t capacity = c->row_capacity ? 2 * c->row_capacity : 64;
    ContactRow *grown = memory_grown(c->rows, (size_t)capacity, sizeof *grown);
    if (!grown) return NULL;
    c->rows = grown;
    c->row_capacity = capacity;
  }
  c->rows[c->row_count] = (ContactRow){.place = place, .stale = true, .faceless = true};
  c->row_of[place] = c->row_count++;
  return &c->rows[c->row_of[place]];
}

static bool row_grows(const Contact *c, ContactRow *row)
{
  if (row->count < row->capacity) return true;
  const int32_t capacity = row->capacity ? 2 * row->capacity : 8;
  ContactPair *pairs = memory_grown(row->pairs, (size_t)capacity, sizeof *pairs);
  if (!pairs) return false;
  row->pairs = pairs;
  if (c->spec->friction > 0) {
    Grip *grips = memory_grown(row->grips, 2 * (size_t)capacity, sizeof *grips);
    if (!grips) return false;
    row->grips = grips;
  }
  row->capacity = capacity;
  return true;
}

/** Where the pair with a neighbour of this number is among those of a row, or would be. */
static int32_t find_pair(const ContactRow *row, const int32_t *number, int32_t neighbour)
{
  int32_t first = 0, last = row->count;
  while (first < last) {
    const int32_t middle = (first + last) / 2;
    if (number[row->pairs[middle].neighbour] < number[neighbour])
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

static bool is_pair(const ContactRow *row, int32_t at, int32_t neighbour)
{
  return at < row->count && row->pairs[at].neighbour == neighbour;
}

/** The act that the other end of a pair has already, or a new one. @return -1 if memory is out */
static int32_t act_for(Contact *c, int32_t place, int32_t neighbour)
{
  const ContactRow *other = c->row_of[neighbour] < 0 ? NULL : &c->rows[c->row_of[neighbour]];
  const int32_t at = other ? find_pair(other, c->body->particles.number, place) : 0;
  int32_t act = c->free_act;
  if (other && is_pair(other, at, place)) {
    ++c->acts[other->pairs[at].act].ends;
    return other->pairs[at].act;
  }
  if (act >= 0) {
    c->free_act = c->acts[act].next;
  } else {
    if (c->act_count == c->act_capacity) {
      const int32_t capacity = c->act_capacity ? 2 * c->act_capacity : 256;
      PairAct *grown = memory_grown(c->acts, (size_t)capacity, sizeof *grown);
      if (!grown) return -1;
      c->acts = grown;
      c->act_capacity = capacity;
    }
    act = c->act_count++;
  }
  c->acts[act] = (PairAct){.ends = 1, .next = -1};
  return act;
}

ContactPair *contact_pair_for(Contact *c, int32_t place, int32_t neighbour)
{
  const int32_t *number = c->body->particles.number;
  ContactRow *row = contact_row_for(c, place);
  const int32_t at = row ? find_pair(row, number, neighbour) : 0;
  if (row && is_pair(row, at, neighbour)) return &row->pairs[at];
  const int32_t act = row && row_grows(c, row) ? act_for(c, place, neighbour) : -1;
  if (act < 0) {
    c->failed = true;
    return NULL;
  }
  const size_t behind = (size_t)(row->count - at);
  memmove(row->pairs + at + 1, row->pairs + at, sizeof *row->pairs * behind);
  if (row->grips) {
    memmove(row->grips + 2 * (at + 1), row->grips + 2 * at, 2 * sizeof *row->grips * behind);
    row->grips[2 * at] = row->grips[2 * at + 1] = (Grip){.known = false};
  }
  row->pairs[at] = (ContactPair){.neighbour = neighbour, .low = number[place] < number[neighbour], .act = act};
  ++row->count;
  return &row->pairs[at];
}

static void remove_pair(Contact *c, ContactRow *row, int32_t at)
{
  const size_t behind = (size_t)(row->count - at - 1);
  PairAct *act = &c->acts[row->pairs[at].act];
  if (--act->ends == 0) {
    act->next = c->free_act;
    c->free_act = row->pairs[at].act;
  }
  memmove(row->pairs + at, row->pairs + at + 1, sizeof *row->pairs * behind);
  if (row->grips) memmove(row->grips + 2 * at, row->grips + 2 * (at + 1), 2 * sizeof *row->grips * behind);
  --row->count;
}

static void lose_bond(Contact *c, int32_t place)
{
  ContactRow *row = &c->rows[c->row_of[place]];
  row->stale = row->faceless = row->torn = c->torn = true;
  c->touched[place] = 1;
}

void contact_bond_broke(Contact *c, int32_t a, int32_t b)
{
  if (!c->spec) return;
  double way[3];
  present_way(&c->body->particles, c->body->particles.displacement.row, a, b, way);
  const double rest = fmin(particles_distance(&c->body->particles, a, b), sqrt(dot(way, way)));
  for (int end = 0; end < 2; ++end) {
    ContactPair *pair = contact_pair_for(c, end ? b : a, end ? a : b);
    if (!pair) return;
    *pair = (ContactPair){.neighbour = pair->neighbour,
                          .kind = PAIR_BROKEN,
                          .low = pair->low,
                          .bond = true,
                          .act = pair->act,
                          .rest = rest};
    lose_bond(c, end ? b : a);
  }
}

void contact_bond_mended(Contact *c, int32_t a, int32_t b)
{
  if (!c->spec) return;
  for (int end = 0; end < 2; ++end) {
    const int32_t at = c->row_of[end ? b : a];
    if (at < 0) continue; /* memory was out as it broke */
    ContactRow *row = &c->rows[at];
    row->stale = row->faceless = true;
    row->torn = false;
    const int32_t n = find_pair(row, c->body->particles.number, end ? a : b);
    if (is_pair(row, n, end ? a : b)) remove_pair(c, row, n);
  }
}

/** Calls `visit` for all pairs of places nearer than `reach` at these positions, from both sides.
 *  @param[in] cut  only for places with the face of a cut */
static void visit_near(Contact *c, const double *const position[3], double reach, bool cut,
                       void (*visit)(Contact *c, int32_t place, int32_t other))
{
  const Particles *p = &c->body->particles;
  Cells cells = {.width = 0};
  if (cells_create(&cells, p, position, reach, NULL)) c->failed = true;
  for (int64_t n = 0; n < p->count && !c->failed; ++n) {
    const int32_t place = p->place_of[n];
    if (cut && (c->row_of[place] < 0 || !c->rows[c->row_of[place]].cuts)) continue;
    const double here[3] = {position[0][place], position[1][place], position[2][place]};
    int64_t rows[9][2];
    const int count = cells_around(&cells, here, rows);
    for (int r = 0; r < count; ++r)
      for (int64_t k = rows[r][0]; k < rows[r][1]; ++k) {
        double square = 0;
        for (int j = 0; j < 3; ++j)
          square += (cells.position[3 * k + j] - here[j]) * (cells.position[3 * k + j] - here[j]);
        if (square < reach * reach && cells.places[k] != place) visit(c, place, cells.places[k]);
      }
  }
  cells_destroy(&cells);
}

static bool bonded(const Contact *c, int32_t a, int32_t b)
{
  if (particles_distance(&c->body->particles, a, b) > c->family->horizon * (1 + 1e-9)) return false;
  return !c->touched[a] || family_joins(c->family, a, b);
}

/** A pair that a cut without a gap parts; the other side of it has its own visit. */
static void visit_cut(Contact *c, int32_t place, int32_t other)
{
  const Particles *p = &c->body->particles;
  double normal[3], level;
  if (bonded(c, place, other) || !body_closed_bond(c->body, place, other, normal, &level)) return;
  ContactPair *pair = contact_pair_for(c, place, other);
  if (!pair) return;
  const double way = p->number[place] < p->number[other] ? 1 : -1;
  pair->bond = true;
  pair->kind = PAIR_CUT;
  for (int k = 0; k < 3; ++k) pair->normal[0][k] = pair->normal[1][k] = way * normal[k];
  contact_add_cut(&c->rows[c->row_of[place]], normal, level, 1e-6 * contact_lattice(c, place)->spacing);
  c->cuts = true;
}

static void add_cut_bonds(Contact *c)
{
  visit_near(c, (const double *const *)c->body->particles.position, c->family->horizon * (1 + 1e-9), false, visit_cut);
}

static void visit_unbonded(Contact *c, int32_t place, int32_t other)
{
  if (bonded(c, place, other)) return;
  ContactPair *pair = contact_pair_for(c, place, other);
  if (pair) pair->found = true;
}

/** A pair on both sides of one cut, be it a former bond or not. */
static void visit_across(Contact *c, int32_t place, int32_t other)
{
  if (c->row_of[other] < 0) return;
  const ContactRow *row = &c->rows[c->row_of[place]], *their = &c->rows[c->row_of[other]];
  if (contact_common_cut(c, row, their) >= 0) visit_unbonded(c, place, other);
}

void contact_join(const Contact *c, void (*one)(void *context, int32_t a, int32_t b), void *context)
{
  const Particles *p = &c->body->particles;
  for (int32_t r = 0; r < c->row_count; ++r)
    for (int32_t n = 0; n < c->rows[r].count; ++n) {
      const ContactPair *pair = &c->rows[r].pairs[n];
      double way[3], most = contact_met_reach(c->body->largest_spacing);
      if (!pair->low) continue;
      if (pair->kind == PAIR_BROKEN) most = pair->rest;
      if (pair->kind == PAIR_CUT) most = contact_cut_reach(c);
      present_way(p, p->displacement.row, c->rows[r].place, pair->neighbour, way);
      if (sqrt(dot(way, way)) <= most * (1 + 1e-6)) one(context, c->rows[r].place, pair->neighbour);
    }
}

void contact_search(Contact *c)
{
  const Particles *p = &c->body->particles;
  double *now[3] = {0};
  for (int k = 0; k < 3; ++k) {
    if (!(now[k] = places_array(p->places, "contact", NULL))) c->failed = true;
    for (int64_t i = 0; now[k] && i < p->places; ++i) now[k][i] = p->position[k][i] + p->displacement.row[k][i];
  }
  for (int32_t r = 0; r < c->row_count; ++r)
    for (int32_t n = 0; n < c->rows[r].count; ++n) c->rows[r].pairs[n].found = c->rows[r].pairs[n].bond;
  const double *const *here = (const double *const *)now;
  if (!c->failed) visit_near(c, here, contact_met_reach(c->body->largest_spacing) + c->margin, false, visit_unbonded);
  if (!c->failed && c->cuts) visit_near(c, here, contact_cut_reach(c) + c->margin, true, visit_across);
  for (int32_t r = 0; r < c->row_count; ++r)
    for (int32_t n = c->rows[r].count - 1; n >= 0; --n)
      if (!c->rows[r].pairs[n].found) remove_pair(c, &c->rows[r], n);
  for (int k = 0; k < 3; ++k) places_free(&now[k]);
  c->choosing = true;
  c->travelled = 0;
}

void contact_forget_pairs(Contact *c)
{
  for (int32_t r = 0; r < c->row_count; ++r)
    for (int32_t n = c->rows[r].count - 1; n >= 0; --n)
      if (!c->rows[r].pairs[n].bond) remove_pair(c, &c->rows[r], n);
}

void contact_follow(Contact *c, double motion)
{
  if (!c->spec) return;
  c->travelled_before = c->travelled;
  c->travelled += motion;
  if (!(c->travelled > c->margin / 2)) return;
  contact_keep(c);
  contact_search(c);
}
