#include "contact/contact.h"

#include "base/team.h"
#include "family/cells.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Field contact_fields[] = {
    {"stiffness", FIELD_NUMBER, offsetof(ContactSpec, stiffness), "1", "1", "(0, inf)",
     "of faces that meet, over that of a layer of the body one spacing thick", NULL, NULL, 0},
    {"friction", FIELD_NUMBER, offsetof(ContactSpec, friction), "1", "0", "[0, inf)",
     "Coulomb's coefficient: faces stick until the force along them is this share of that across them, then slide",
     NULL, NULL, 0},
};
const Section contact_section = {
    "contact",
    "Particles that no bond joins repel each other where they come near: bodies that meet, and crack faces that close. "
    "The faces of a cut or of broken bonds carry pressure as soon as they are nearer than they were, as stiffly as the "
    "bonds; other faces meet where their outermost particles are half a spacing of each apart. Without this section "
    "they "
    "pass through each other. It costs a shorter time step.",
    sizeof(ContactSpec),
    FIELDS(contact_fields),
    NULL,
    NULL,
    NULL,
    0};

/* Weight of pairs of faces that meet, by their distance q along the face in spacings: the quadratic B-spline, whose sums over a row
 * of particles are 1, and weighted by their places 0, wherever the row is met: faces of particles are smooth so. */
static const double spline_reach = 1.5;
static double spline(double q)
{
  return q < 0.5 ? 0.75 - q * q : q < spline_reach ? 0.5 * (spline_reach - q) * (spline_reach - q) : 0;
}
/** Integral of the spline over a plane, in spacings squared. */
static const double spline_plane = 1.2762720155208536; /* 2 pi 13 / 64 */

static const double least_offset = 0.25; /* of neighbours to one side, in spacings: less shows no face */
static const double least_cosine = 0.2;  /* between a pair and the normal of its face */

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static const Lattice *lattice_of(const Contact *c, int32_t place)
{
  return &c->body->lattices[c->body->particles.block[place / SLICE]];
}

static double mean_spacing(const Contact *c, int32_t a, int32_t b)
{
  return (lattice_of(c, a)->spacing + lattice_of(c, b)->spacing) / 2;
}

static void reference_way(const Particles *p, int32_t a, int32_t b, double way[3])
{
  for (int k = 0; k < 3; ++k) way[k] = p->position[k][b] - p->position[k][a];
}

static void present_way(const Particles *p, int32_t a, int32_t b, double way[3])
{
  for (int k = 0; k < 3; ++k)
    way[k] = p->position[k][b] - p->position[k][a] + (p->displacement[k][b] - p->displacement[k][a]);
}

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
static void set_constants(Contact *c, Space space, bool whole, double bonds)
{
  const Body *body = c->body;
  const Particles *p = &body->particles;
  const double expansion[] = {6, 3.2, 3, 1}; /* of Space, in Young's moduli */
  const double share[] = {5.0 / 6, 8.0 / 9, 8.0 / 9,
                          1}; /* Young's modulus over that of bonds whose ends do not move sideways */
  for (int b = 0; b < body->block_count; ++b) {
    double first, inverse, density = INFINITY, across = 0;
    family_moments(c, b, whole, &first, &inverse);
    if (first > 0) c->constant[b] = bonds * share[space] * expansion[space] * c->young[b] / (first / 2);
    for (int64_t n = 0; n < p->count; ++n)
      if (p->block[p->place_of[n] / SLICE] == b) density = fmin(density, p->density[p->place_of[n]]);
    for (int o = 0; o < body->block_count; ++o) {
      const double spacing = body->lattices[b].spacing, mean = (spacing + body->lattices[o].spacing) / 2;
      across = fmax(across, 2 * c->young[b] * c->young[o] / (c->young[b] + c->young[o]) / (mean * spacing));
    }
    const double across_bonds = c->constant[b] * inverse / body->dimensions;
    c->stiffest = fmax(c->stiffest, fmax(1.2 * across_bonds, 3 * c->spec->stiffness * across) / density);
  }
}

static void add_cut_bonds(Contact *c);

int contact_create(Contact *c, const ContactSpec *spec, const Body *body, const Family *family, Space space, bool whole,
                   double bonds, const double *young, Error *error)
{
  const int64_t places = body->particles.places;
  *c = (Contact){.spec = spec, .body = body, .family = family, .margin = 0.3 * body->largest_spacing};
  if (!spec) return BRECCIA_OK;
  c->young = memory_zeroed((size_t)body->block_count, sizeof(double), "contact", error);
  c->constant = memory_zeroed((size_t)body->block_count, sizeof(double), "contact", error);
  c->touched = memory_zeroed((size_t)places, 1, "contact", error);
  c->row_of = memory_zeroed((size_t)places, sizeof(int32_t), "contact", error);
  if (!c->young || !c->constant || !c->touched || !c->row_of) return BRECCIA_FAILURE;
  memcpy(c->young, young, sizeof(double) * (size_t)body->block_count);
  for (int64_t i = 0; i < places; ++i) c->row_of[i] = -1;
  set_constants(c, space, whole, bonds);
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
  free(c->row_of);
  free(c->touched);
  free(c->young);
  free(c->constant);
  *c = (Contact){.spec = NULL};
}

/* ---- pairs ---- */

static ContactRow *row_for(Contact *c, int32_t place)
{
  if (c->row_of[place] >= 0) return &c->rows[c->row_of[place]];
  if (c->row_count == c->row_capacity) {
    int32_t capacity = c->row_capacity ? 2 * c->row_capacity : 64;
    ContactRow *grown = realloc(c->rows, sizeof *grown * (size_t)capacity);
    if (!grown) return NULL;
    c->rows = grown;
    c->row_capacity = capacity;
  }
  c->rows[c->row_count] = (ContactRow){.place = place, .stale = true, .turning = true};
  c->row_of[place] = c->row_count++;
  return &c->rows[c->row_of[place]];
}

static bool row_grows(const Contact *c, ContactRow *row)
{
  if (row->count < row->capacity) return true;
  const int32_t capacity = row->capacity ? 2 * row->capacity : 8;
  ContactPair *pairs = realloc(row->pairs, sizeof *pairs * (size_t)capacity);
  if (!pairs) return false;
  row->pairs = pairs;
  if (c->spec->friction > 0) {
    Grip *grips = realloc(row->grips, 2 * sizeof *grips * (size_t)capacity);
    if (!grips) return false;
    row->grips = grips;
  }
  row->capacity = capacity;
  return true;
}

/** The pair of a place with a neighbour, made if it is not there. @return NULL if memory is out */
static ContactPair *pair_for(Contact *c, int32_t place, int32_t neighbour)
{
  const int32_t *number = c->body->particles.number;
  ContactRow *row = row_for(c, place);
  int32_t at = row ? row->count : 0;
  while (row && at > 0 && number[row->pairs[at - 1].neighbour] > number[neighbour]) --at;
  if (row && at > 0 && row->pairs[at - 1].neighbour == neighbour) return &row->pairs[at - 1];
  if (!row || !row_grows(c, row)) {
    c->failed = true;
    return NULL;
  }
  const size_t behind = (size_t)(row->count - at);
  memmove(row->pairs + at + 1, row->pairs + at, sizeof *row->pairs * behind);
  if (row->grips) {
    memmove(row->grips + 2 * (at + 1), row->grips + 2 * at, 2 * sizeof *row->grips * behind);
    row->grips[2 * at] = row->grips[2 * at + 1] = (Grip){.touching = false};
  }
  row->pairs[at] = (ContactPair){.neighbour = neighbour, .rest = 1};
  ++row->count;
  return &row->pairs[at];
}

static void remove_pair(ContactRow *row, int32_t at)
{
  const size_t behind = (size_t)(row->count - at - 1);
  memmove(row->pairs + at, row->pairs + at + 1, sizeof *row->pairs * behind);
  if (row->grips) memmove(row->grips + 2 * at, row->grips + 2 * (at + 1), 2 * sizeof *row->grips * behind);
  --row->count;
}

static void add_bond(Contact *c, int32_t a, int32_t b, double rest)
{
  for (int end = 0; end < 2; ++end) {
    const int32_t place = end ? b : a;
    ContactPair *pair = pair_for(c, place, end ? a : b);
    if (!pair) return;
    pair->bond = true;
    pair->rest = rest;
    c->touched[place] = 1;
    c->rows[c->row_of[place]].stale = c->rows[c->row_of[place]].turning = true;
  }
}

void contact_bond_broke(Contact *c, int32_t a, int32_t b)
{
  if (!c->spec) return;
  double way[3];
  present_way(&c->body->particles, a, b, way);
  add_bond(c, a, b, fmin(1, sqrt(dot(way, way)) / particles_distance(&c->body->particles, a, b)));
}

void contact_bond_mended(Contact *c, int32_t a, int32_t b)
{
  if (!c->spec) return;
  for (int end = 0; end < 2; ++end) {
    const int32_t at = c->row_of[end ? b : a];
    if (at < 0) continue; /* memory was out as it broke */
    ContactRow *row = &c->rows[at];
    row->stale = row->turning = true;
    for (int32_t n = row->count - 1; n >= 0; --n)
      if (row->pairs[n].neighbour == (end ? a : b)) remove_pair(row, n);
  }
}

/** Calls `visit` for all pairs of places nearer than `reach` at these positions, from both sides. */
static void visit_near(Contact *c, const double *const position[3], double reach,
                       void (*visit)(Contact *c, int32_t place, int32_t other))
{
  const Particles *p = &c->body->particles;
  Cells cells = {.width = 0};
  if (cells_create(&cells, p, position, reach, NULL)) c->failed = true;
  for (int64_t n = 0; n < p->count && !c->failed; ++n) {
    const int32_t place = p->place_of[n];
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
  double a[3], b[3], normal[3];
  if (bonded(c, place, other)) return;
  for (int k = 0; k < 3; ++k) {
    a[k] = c->body->particles.position[k][place];
    b[k] = c->body->particles.position[k][other];
  }
  if (!body_closed_cut(c->body, a, b, normal)) return;
  add_bond(c, place, other, 1);
  ContactPair *pair = pair_for(c, place, other);
  if (pair) memcpy(pair->normal, normal, sizeof pair->normal);
}

static void add_cut_bonds(Contact *c)
{
  visit_near(c, (const double *const *)c->body->particles.position, c->family->horizon * (1 + 1e-9), visit_cut);
}

static void visit_unbonded(Contact *c, int32_t place, int32_t other)
{
  if (bonded(c, place, other)) return;
  ContactPair *pair = pair_for(c, place, other);
  if (pair) pair->found = true;
}

/** How far apart two particles are at most whose faces touch. */
static double face_reach(double spacing)
{
  return spacing * sqrt(1 + spline_reach * spline_reach);
}

void contact_search(Contact *c)
{
  const Particles *p = &c->body->particles;
  double *now[3] = {0};
  for (int k = 0; k < 3; ++k) {
    if (!(now[k] = places_array(p->places, "contact", NULL))) c->failed = true;
    for (int64_t i = 0; now[k] && i < p->places; ++i) now[k][i] = p->position[k][i] + p->displacement[k][i];
  }
  for (int32_t r = 0; r < c->row_count; ++r)
    for (int32_t n = 0; n < c->rows[r].count; ++n) c->rows[r].pairs[n].found = c->rows[r].pairs[n].bond;
  if (!c->failed)
    visit_near(c, (const double *const *)now, face_reach(c->body->largest_spacing) + c->margin, visit_unbonded);
  for (int32_t r = 0; r < c->row_count; ++r)
    for (int32_t n = c->rows[r].count - 1; n >= 0; --n)
      if (!c->rows[r].pairs[n].found) remove_pair(&c->rows[r], n);
  for (int k = 0; k < 3; ++k) places_free(&now[k]);
  for (int32_t r = 0; r < c->row_count; ++r) c->rows[r].turning = true;
  c->travelled = 0;
}

void contact_follow(Contact *c, double motion)
{
  if (!c->spec) return;
  c->travelled += motion;
  if (c->travelled > c->margin / 2) contact_search(c);
}

/* ---- faces ---- */

/** Mean way to the bonded neighbours of a place; 0 if they are too few to tell a face. */
static void mean_way(const Contact *c, int32_t place, bool deformed, double way[3])
{
  const Family *f = c->family;
  const Particles *p = f->particles;
  const int64_t slice = place / SLICE;
  const int lane = place % SLICE;
  double volume = 0;
  int count = 0;
  for (int k = 0; k < 3; ++k) way[k] = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    const double v = p->volume[bond.neighbour];
    volume += v;
    ++count;
    for (int k = 0; k < 3; ++k)
      way[k] += v * (bond.xi[k] + (deformed ? p->displacement[k][bond.neighbour] - p->displacement[k][place] : 0));
  }
  for (int k = 0; k < 3; ++k) way[k] = count > c->body->dimensions ? way[k] / volume : 0;
}

static bool make_unit(double v[3])
{
  const double size = sqrt(dot(v, v));
  for (int k = 0; k < 3 && size > 0; ++k) v[k] /= size;
  return size > 0;
}

/** The smallest rotation that takes one unit vector to another, applied to a third vector. */
static void turn(const double from[3], const double to[3], double v[3])
{
  const double cosine = dot(from, to);
  double w[3], wv[3];
  if (cosine < -0.9) return; /* it has no axis */
  for (int k = 0; k < 3; ++k) w[k] = from[(k + 1) % 3] * to[(k + 2) % 3] - from[(k + 2) % 3] * to[(k + 1) % 3];
  for (int k = 0; k < 3; ++k) wv[k] = w[(k + 1) % 3] * v[(k + 2) % 3] - w[(k + 2) % 3] * v[(k + 1) % 3];
  for (int k = 0; k < 3; ++k) {
    const double twice = w[(k + 1) % 3] * wv[(k + 2) % 3] - w[(k + 2) % 3] * wv[(k + 1) % 3];
    v[k] += wv[k] + twice / (1 + cosine);
  }
}

static void add_face(ContactRow *row, const double normal[3])
{
  memcpy(row->face[row->faces], normal, sizeof row->face[0]);
  row->faces += make_unit(row->face[row->faces]);
}

/** Sides of a lattice cell on which no neighbour ever stood. */
static void add_sides(const Contact *c, ContactRow *row)
{
  const Particles *p = &c->body->particles;
  const Lattice *lattice = lattice_of(c, row->place);
  bool there[3][2] = {{false}};
  const int64_t slice = row->place / SLICE;
  const int lane = row->place % SLICE;
  for (int64_t slot = c->family->first[slice]; slot < c->family->stored[slice] + row->count; ++slot) {
    double xi[3];
    const int64_t former = slot - c->family->stored[slice];
    if (former < 0 && !(c->family->intact[slot] >> lane & 1)) continue;
    if (former >= 0 && !row->pairs[former].bond) continue;
    reference_way(p, row->place, former < 0 ? c->family->base[slot] + lane : row->pairs[former].neighbour, xi);
    for (int k = 0; k < 3; ++k)
      if (fabs(fabs(xi[k]) - lattice->spacing) < 1e-6 * lattice->spacing &&
          fabs(dot(xi, xi) - xi[k] * xi[k]) < 1e-6 * xi[k] * xi[k])
        there[k][xi[k] > 0] = true;
  }
  for (int k = 0; k < c->body->dimensions; ++k)
    for (int side = 0; side < 2; ++side) {
      double normal[3] = {0};
      normal[k] = side ? 1 : -1;
      if (!there[k][side]) add_face(row, normal);
    }
}

/** Faces of a place in the reference: of its cut bonds by the cuts' normals; of broken ones from those that are left to those that are
 *  lost; of a lattice its open sides; of others away from their neighbours. */
static void find_faces(const Contact *c, ContactRow *row)
{
  const Particles *p = &c->body->particles;
  const Lattice *lattice = lattice_of(c, row->place);
  double cut[3] = {0}, lost[3] = {0}, volume = 0;
  mean_way(c, row->place, false, row->inward);
  for (int32_t n = 0; n < row->count; ++n) {
    const ContactPair *pair = &row->pairs[n];
    double xi[3];
    if (!pair->bond) continue;
    reference_way(p, row->place, pair->neighbour, xi);
    for (int k = 0; k < 3; ++k) {
      cut[k] += pair->normal[k];
      lost[k] += p->volume[pair->neighbour] * xi[k];
    }
    volume += p->volume[pair->neighbour];
  }
  memcpy(row->from, row->inward, sizeof row->from);
  make_unit(row->from);
  row->faces = 0;
  for (int k = 0; k < 3 && volume > 0; ++k) lost[k] = lost[k] / volume - row->inward[k];
  if (dot(cut, cut) < 0.25 && sqrt(dot(lost, lost)) < least_offset * lattice->spacing) volume = 0;
  if (volume > 0) add_face(row, dot(cut, cut) < 0.25 ? lost : cut);
  memset(row->lost, 0, sizeof row->lost);
  if (volume > 0) memcpy(row->lost, row->face[0], sizeof row->lost);
  if (lattice->chunks) {
    add_sides(c, row);
  } else if (volume == 0 && sqrt(dot(row->inward, row->inward)) >= least_offset * lattice->spacing) {
    const double away[3] = {-row->inward[0], -row->inward[1], -row->inward[2]};
    add_face(row, away);
  }
}

/** Unit normal of the face that lost bonds have left between two places. @return false if none shows */
static bool lost_normal(const ContactRow *row, const ContactRow *other, double normal[3])
{
  for (int k = 0; k < 3; ++k) normal[k] = row->lost[k] - other->lost[k];
  return dot(normal, normal) >= 0.25 && make_unit(normal);
}

/** Which of the faces of a place looks most along a way. @return how far the way leads out of it; -INFINITY without faces */
static double best_face(const ContactRow *row, double sign, const double y[3], double normal[3])
{
  double most = -INFINITY;
  for (int n = 0; n < row->faces; ++n) {
    const double out = sign * dot(row->turned[n], y);
    if (out <= most) continue;
    most = out;
    for (int k = 0; k < 3; ++k) normal[k] = sign * row->turned[n][k];
  }
  return most;
}

/** Unit normal of the face between two places as they stand: of all their faces the one across which they are farthest apart, as convex
 *  bodies are; where both have nearly the same, the mean. @return false if none shows */
static bool present_normal(const ContactRow *row, const ContactRow *other, const double y[3], double normal[3])
{
  double own[3] = {0}, their[3] = {0};
  const double mine = best_face(row, 1, y, own), yours = best_face(other, -1, y, their);
  if (mine == -INFINITY && yours == -INFINITY) return false;
  const bool alike = mine != -INFINITY && yours != -INFINITY && dot(own, their) > 0.85;
  for (int k = 0; k < 3; ++k) normal[k] = alike ? own[k] + their[k] : mine > yours ? own[k] : their[k];
  return make_unit(normal);
}

/** Distance of a former bond across its face in the reference; its length where no face shows. @param[out] normal  of the face */
static double reference_gap(const Contact *c, const ContactRow *row, const ContactRow *other, const ContactPair *pair,
                            bool *face, double normal[3])
{
  double xi[3];
  reference_way(&c->body->particles, row->place, other->place, xi);
  const double length = sqrt(dot(xi, xi));
  memcpy(normal, pair->normal, sizeof pair->normal);
  *face = (dot(normal, normal) > 0 || lost_normal(row, other, normal)) && dot(xi, normal) >= least_cosine * length;
  return *face ? dot(xi, normal) : length;
}

/** Where a place lies, if a pair of its row may touch. */
static void look_around(const Contact *c, ContactRow *row)
{
  row->near = false;
  for (int32_t n = 0; n < row->count && !row->near; ++n) {
    const ContactPair *pair = &row->pairs[n];
    double y[3], reach = face_reach(c->body->largest_spacing);
    present_way(&c->body->particles, row->place, pair->neighbour, y);
    if (pair->bond)
      reach = fmax(reach, particles_distance(&c->body->particles, row->place, pair->neighbour) +
                              mean_spacing(c, row->place, pair->neighbour));
    row->near = dot(y, y) < reach * reach;
  }
  if (!row->stale && !row->turning) return;
  if (row->stale) find_faces(c, row);
  if (row->turning) {
    mean_way(c, row->place, true, row->to);
    make_unit(row->to);
  }
  for (int n = 0; n < row->faces; ++n) {
    memcpy(row->turned[n], row->face[n], sizeof row->turned[n]);
    turn(row->from, row->to, row->turned[n]);
  }
  row->stale = row->turning = false;
}

/** Depth below the face: half a spacing, or less where a former bond says that the face is nearer. */
static void find_depth(const Contact *c, ContactRow *row)
{
  row->depth = lattice_of(c, row->place)->spacing / 2;
  for (int32_t n = 0; n < row->count && row->near; ++n) {
    const ContactPair *pair = &row->pairs[n];
    const ContactRow *other = &c->rows[c->row_of[pair->neighbour]];
    double normal[3];
    bool face;
    if (pair->bond) row->depth = fmin(row->depth, pair->rest / 2 * reference_gap(c, row, other, pair, &face, normal));
  }
}

/* ---- forces ---- */

/** Takes from a vector what it has along a normal. */
static void flatten(const double normal[3], double v[3])
{
  const double along = dot(normal, v);
  for (int k = 0; k < 3; ++k) v[k] -= along * normal[k];
}

/** How a pair stands to the face between its ends. */
typedef struct Meeting {
  bool face;        /* it shows; else the pair itself is the normal */
  double y[3];      /* way to the neighbour */
  double normal[3]; /* towards it */
  double across;    /* distance along the normal */
} Meeting;

static Meeting meet(const Contact *c, const ContactRow *row, const ContactRow *other, const ContactPair *pair)
{
  Meeting m;
  present_way(&c->body->particles, row->place, other->place, m.y);
  const double length = sqrt(dot(m.y, m.y));
  double known[3] = {pair->normal[0], pair->normal[1], pair->normal[2]};
  if (pair->bond &&
      dot(known, known) == 0) { /* broken: along itself, so that nothing is gained when families change around it */
    m.face = false;
  } else if (dot(known, known) > 0) { /* turned as both sides have turned */
    double own[3], their[3];
    memcpy(own, known, sizeof own);
    memcpy(their, known, sizeof their);
    turn(row->from, row->to, own);
    turn(other->from, other->to, their);
    for (int k = 0; k < 3; ++k) m.normal[k] = own[k] + their[k];
    m.face = make_unit(m.normal);
  } else {
    m.face = present_normal(row, other, m.y, m.normal);
  }
  m.face = m.face && dot(m.y, m.normal) >= least_cosine * length;
  for (int k = 0; k < 3 && !m.face; ++k) m.normal[k] = length > 0 ? m.y[k] / length : 0;
  m.across = m.face ? dot(m.y, m.normal) : length;
  return m;
}

/** How much of a former bond is left when its ends have slid along their face: 1, to 0 at a spacing. */
static double left_after_slip(const Contact *c, const ContactRow *row, const ContactRow *other, const Meeting *m,
                              const double normal[3])
{
  if (dot(normal, m->normal) < -0.9) return 0;
  double slip[3];
  reference_way(&c->body->particles, row->place, other->place, slip);
  turn(normal, m->normal, slip);
  for (int k = 0; k < 3; ++k) slip[k] = m->y[k] - slip[k];
  flatten(m->normal, slip);
  const double spacing = mean_spacing(c, row->place, other->place), q = dot(slip, slip) / (spacing * spacing);
  return q < 1 ? (1 - q) * (1 - q) : 0;
}

/** Stiffness per volume of the neighbour, and what it carries across. */
typedef struct Press {
  double stiffness, pressure;
} Press;

/** A former bond that has closed: as stiff as it was. Where no face shows it resists along itself, which `m` is changed to.
 *  @param[out] left  the share of it that slip has left */
static Press press_bond(const Contact *c, const ContactRow *row, const ContactRow *other, const ContactPair *pair,
                        Meeting *m, double *left)
{
  const Particles *p = &c->body->particles;
  const double length = particles_distance(p, row->place, other->place);
  double normal[3], gap;
  bool face;
  gap = reference_gap(c, row, other, pair, &face, normal);
  if (!face || !m->face) {
    gap = length;
    m->face = false;
    m->across = sqrt(dot(m->y, m->y));
    for (int k = 0; k < 3; ++k) m->normal[k] = m->across > 0 ? m->y[k] / m->across : 0;
  }
  *left = m->face ? left_after_slip(c, row, other, m, normal) : 1;
  const double closing = pair->rest * gap - m->across;
  if (!(closing > 0)) return (Press){0, 0};
  const double mean = (c->constant[p->block[row->place / SLICE]] + c->constant[p->block[other->place / SLICE]]) / 2;
  const double stiffness = *left * mean * (gap / length) * (gap / length) / length;
  return (Press){stiffness, stiffness * closing};
}

/** Faces that meet: as stiff as a layer of both bodies between the outermost particles, spread over those that stand opposite. */
static Press press_faces(const Contact *c, const ContactRow *row, const ContactRow *other, const Meeting *m)
{
  const int one = c->body->particles.block[row->place / SLICE], two = c->body->particles.block[other->place / SLICE];
  const double da = c->body->lattices[one].spacing, db = c->body->lattices[two].spacing, wide = fmax(da, db);
  const double closing = row->depth + other->depth - m->across;
  if (!(closing > 0)) return (Press){0, 0};
  double along[3] = {m->y[0], m->y[1], m->y[2]};
  flatten(m->normal, along);
  const double weight = spline(sqrt(dot(along, along)) / wide);
  if (weight == 0) return (Press){0, 0};
  const BlockSpec *block = c->body->blocks[0];
  const double plane = c->body->dimensions == 3   ? spline_plane * wide * wide
                       : c->body->dimensions == 2 ? wide * block->thickness
                                                  : 0.75 * block->area;
  const double young = 2 * c->young[one] * c->young[two] / (c->young[one] + c->young[two]);
  const double stiffness = c->spec->stiffness * young / ((da + db) / 2 * da * db) * weight / plane;
  return (Press){stiffness, stiffness * closing};
}

/** Elastic slip of a pair under its limit, and the work of what it slides beyond. @param[out] pull  along the face, per volume squared */
static double grip(const Grip *before, Grip *after, const Meeting *m, double stiffness, double limit, double pull[3])
{
  *after = (Grip){.touching = true};
  for (int k = 0; k < 3; ++k) {
    after->way[k] = m->y[k];
    after->normal[k] = m->normal[k];
  }
  if (before->touching && dot(before->normal, m->normal) > 0.9) {
    double spring[3], way[3];
    memcpy(spring, before->spring, sizeof spring);
    memcpy(way, before->way, sizeof way);
    turn(before->normal, m->normal, spring);
    turn(before->normal, m->normal, way);
    for (int k = 0; k < 3; ++k) after->spring[k] = spring[k] + m->y[k] - way[k];
    flatten(m->normal, after->spring);
  }
  const double size = sqrt(dot(after->spring, after->spring)), held = fmin(size, limit / stiffness);
  for (int k = 0; k < 3; ++k) {
    if (held < size) after->spring[k] *= held / size;
    pull[k] = stiffness * after->spring[k];
  }
  return stiffness * held * (size - held);
}

static void resist_row(Contact *c, ContactRow *row)
{
  const Particles *p = &c->body->particles;
  const double friction = c->spec->friction;
  double force[3] = {0};
  row->slid = 0;
  for (int32_t n = 0; n < row->count; ++n) {
    const ContactPair *pair = &row->pairs[n];
    const ContactRow *other = &c->rows[c->row_of[pair->neighbour]];
    if (row->grips) row->grips[2 * n + !c->committed].touching = false;
    if (!row->near || !other->near) continue;
    Meeting m = meet(c, row, other, pair);
    double left = 0, pull[3] = {0};
    Press bond = {0, 0};
    if (pair->bond) bond = press_bond(c, row, other, pair, &m, &left);
    Press faces = {0, 0};
    if (left < 1) faces = press_faces(c, row, other, &m);
    faces.stiffness *= 1 - left;
    faces.pressure *= 1 - left;
    if (bond.pressure + faces.pressure <= 0) continue;
    if (friction > 0)
      row->slid += p->volume[row->place] * p->volume[other->place] *
                   grip(&row->grips[2 * n + c->committed], &row->grips[2 * n + !c->committed], &m,
                        bond.stiffness + faces.stiffness, friction * (bond.pressure + faces.pressure), pull);
    /* Faces press along the pair, which keeps the angular momentum: what slants to one side has its like on the other. */
    const double slant = fmax(m.across, (row->depth + other->depth) / 2);
    for (int k = 0; k < 3; ++k)
      force[k] += p->volume[other->place] *
                  (pull[k] - bond.pressure * m.normal[k] - (slant > 0 ? faces.pressure * m.y[k] / slant : 0));
  }
  for (int k = 0; k < 3; ++k) p->internal[k][row->place] += force[k];
}

void contact_resist(Contact *c)
{
  if (!c->spec) return;
  TEAM_FOR (r, c->row_count) look_around(c, &c->rows[r]);
  TEAM_FOR (r, c->row_count) find_depth(c, &c->rows[r]);
  TEAM_FOR (r, c->row_count) resist_row(c, &c->rows[r]);
}

void contact_commit(Contact *c)
{
  if (!c->spec || !(c->spec->friction > 0)) return;
  c->committed = !c->committed;
  double slid = 0;
  for (int64_t place = 0; place < c->body->particles.places;
       ++place) /* rows stand in the order of events, which a restart does not know */
    if (c->row_of[place] >= 0) slid += c->rows[c->row_of[place]].slid / 2;
  c->friction_work += slid;
}

double contact_eigenvalue(const Contact *c)
{
  return c->stiffest;
}

/* ---- saving ---- */

enum { SAVED_START = 3, SAVED_ROW = 4, SAVED_PAIR = 13 };

static int32_t rows_with_pairs(const Contact *c)
{
  int32_t count = 0;
  for (int32_t r = 0; r < c->row_count; ++r) count += c->rows[r].count > 0;
  return count;
}

/** Writes the state, or counts its numbers if `out` is NULL: work of friction, travel, and how many rows have pairs; of each its number and how it
 *  has turned; of each pair with a state both numbers, rest, whether friction holds it, spring, way and normal. */
static int64_t write_state(const Contact *c, double *out)
{
  const Particles *p = &c->body->particles;
  int64_t count = SAVED_START;
  if (out)
    memcpy(out, (const double[]){c->friction_work, c->travelled, (double)rows_with_pairs(c)},
           SAVED_START * sizeof *out);
  for (int64_t i = 0; i < p->count;
       ++i) { /* by number: rows stand in the order of events, which a restart does not know */
    const ContactRow *row = c->row_of[p->place_of[i]] < 0 ? NULL : &c->rows[c->row_of[p->place_of[i]]];
    if (!row || !row->count) continue;
    const double state[SAVED_ROW] = {(double)i, row->to[0], row->to[1], row->to[2]};
    if (out) memcpy(out + count, state, sizeof state);
    count += SAVED_ROW;
  }
  for (int64_t i = 0; i < p->count; ++i) {
    const ContactRow *row = c->row_of[p->place_of[i]] < 0 ? NULL : &c->rows[c->row_of[p->place_of[i]]];
    for (int32_t n = 0; row && n < row->count; ++n) {
      const ContactPair *pair = &row->pairs[n];
      const Grip *held = row->grips ? &row->grips[2 * n + c->committed] : NULL;
      if (pair->rest == 1 && !(held && held->touching)) continue;
      double state[SAVED_PAIR] = {(double)i, p->number[pair->neighbour], pair->rest, held && held->touching};
      for (int k = 0; held && held->touching && k < 3; ++k) {
        state[4 + k] = held->spring[k];
        state[7 + k] = held->way[k];
        state[10 + k] = held->normal[k];
      }
      if (out) memcpy(out + count, state, sizeof state);
      count += SAVED_PAIR;
    }
  }
  return count;
}

int64_t contact_save(const Contact *c, double **out)
{
  *out = NULL;
  if (!c->spec) return 0;
  const int64_t count = write_state(c, NULL);
  if (!(*out = malloc(sizeof(double) * (size_t)count))) return -1;
  return write_state(c, *out);
}

/** The place of a saved particle number, or -1. */
static int32_t saved_place(const Contact *c, double number)
{
  const Particles *p = &c->body->particles;
  return number >= 0 && number < (double)p->count ? p->place_of[(int64_t)number] : -1;
}

int contact_resume(Contact *c, const double *numbers, int64_t count)
{
  if (!c->spec) return count != 0;
  if (count < SAVED_START || !(numbers[2] >= 0 && numbers[2] <= (double)(count / SAVED_ROW))) return 1;
  const double *pairs = numbers + SAVED_START + SAVED_ROW * (int64_t)numbers[2], *end = numbers + count;
  if (pairs > end || (end - pairs) % SAVED_PAIR) return 1;
  c->friction_work = numbers[0];
  c->travelled = numbers[1];
  for (const double *state = numbers + SAVED_START; state < pairs; state += SAVED_ROW) {
    const int32_t place = saved_place(c, state[0]);
    ContactRow *row = place < 0 ? NULL : row_for(c, place);
    if (!row) return 1;
    memcpy(row->to, state + 1, sizeof row->to);
    row->turning = false;
  }
  for (int32_t r = 0; r < c->row_count; ++r)
    for (int32_t n = 0; n < c->rows[r].count; ++n) {
      c->rows[r].pairs[n].rest = 1;
      if (c->rows[r].grips) c->rows[r].grips[2 * n + c->committed].touching = false;
    }
  for (const double *state = pairs; state < end; state += SAVED_PAIR) {
    const int32_t place = saved_place(c, state[0]), other = saved_place(c, state[1]);
    ContactPair *pair = place < 0 || other < 0 ? NULL : pair_for(c, place, other);
    if (!pair) return 1;
    pair->rest = state[2];
    const ContactRow *row = &c->rows[c->row_of[place]];
    if (!row->grips) continue;
    Grip *held = &row->grips[2 * (pair - row->pairs) + c->committed];
    held->touching = state[3] != 0;
    for (int k = 0; k < 3; ++k) {
      held->spring[k] = state[4 + k];
      held->way[k] = state[7 + k];
      held->normal[k] = state[10 + k];
    }
  }
  return 0;
}

static int64_t save_row(const void *owner, double **numbers)
{
  return contact_save(owner, numbers);
}

static int resume_row(void *owner, const double *numbers, int64_t count, Error *error)
{
  (void)error;
  return contact_resume(owner, numbers, count) ? STATE_MISFIT : BRECCIA_OK;
}

void contact_state(Contact *c, StateList *list)
{
  static const StateCare care = {.save = save_row, .resume = resume_row};
  if (c->spec)
    state_add(list, &(StateRow){.unit = "1", .role = STATE_COMMITTED, .care = &care, .owner = c}, "contact", NULL);
}
