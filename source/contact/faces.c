/* Faces of particles in the reference, how families are deformed, and which face lies between two particles. */
#include "contact/contact_parts.h"

#include "base/tensor.h"
#include <string.h>

static const double least_offset = 0.25; /* of neighbours to one side, in spacings: less shows no face */
static const double least_cosine = 0.2;  /* between a pair and the normal of its face */
static const double least_shape =
    1e-3; /* determinant of a family's shape over that of a ball: flatter ones tell no gradient */

/* ---- frames ---- */

/** Inverse of sum of V xi (x) xi over the family, in the dimensions of the body. @return false if the bonds are too few or too flat */
static bool find_shape(const Contact *c, int32_t place, double shape[9])
{
  const Family *f = c->family;
  const Particles *p = f->particles;
  const int64_t slice = place / SLICE;
  const int dimensions = c->body->dimensions;
  double k[6] = {0}, inverse[6];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> (place % SLICE) & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, place % SLICE);
    for (int n = 0; n < 6; ++n)
      k[n] += p->volume[bond.neighbour] * bond.xi[symmetric_row[n]] * bond.xi[symmetric_column[n]];
  }
  memset(shape, 0, 9 * sizeof *shape);
  const double mean = (k[XX] + k[YY] + k[ZZ]) / dimensions;
  if (dimensions == 2) {
    k[ZZ] = mean;
    k[YZ] = k[ZX] = 0;
  }
  if (dimensions == 1 || !(tensor_determinant(k) > least_shape * mean * mean * mean)) return false;
  tensor_inverse(k, inverse);
  for (int n = 0; n < 9; ++n)
    if (n / 3 < dimensions && n % 3 < dimensions) shape[n] = inverse[symmetric_place[n]];
  return true;
}

static void find_cofactor(Frame *frame)
{
  const double *f = frame->gradient;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int m = (i + 1) % 3, n = (i + 2) % 3, k = (j + 1) % 3, l = (j + 2) % 3;
      frame->cofactor[3 * i + j] = frame->known ? f[3 * m + k] * f[3 * n + l] - f[3 * m + l] * f[3 * n + k] : 0;
    }
}

void contact_find_frame(const Contact *c, double *const *u, ContactRow *row)
{
  const Family *f = c->family;
  const Particles *p = f->particles;
  const int64_t slice = row->place / SLICE;
  const int lane = row->place % SLICE;
  if (row->stale) {
    row->frame.known = find_shape(c, row->place, row->shape) || c->body->dimensions == 1;
    row->stale = false;
  }
  double moment[9] = {0}, *gradient = row->frame.gradient;
  for (int n = 0; n < 9; ++n) gradient[n] = n % 4 == 0;
  if (!row->frame.known || c->body->dimensions == 1) {
    find_cofactor(&row->frame);
    return;
  }
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    for (int i = 0; i < 3; ++i) {
      const double eta = p->volume[bond.neighbour] * (u[i][bond.neighbour] - u[i][row->place]);
      for (int j = 0; j < 3; ++j) moment[3 * i + j] += eta * bond.xi[j];
    }
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) gradient[3 * i + j] += moment[3 * i + k] * row->shape[3 * k + j];
  find_cofactor(&row->frame);
}

/* ---- faces of one particle ---- */

static bool add_face(ContactRow *row, const double normal[3])
{
  if (row->faces == MOST_FACES) return false;
  memcpy(row->face[row->faces], normal, sizeof row->face[0]);
  if (!make_unit(row->face[row->faces])) return false;
  ++row->faces;
  return true;
}

void contact_add_cut(ContactRow *row, const double normal[3], double level, double tolerance)
{
  for (int n = 0; n < row->cuts; ++n)
    if (dot(row->face[n], normal) > 1 - 1e-9 && fabs(row->level[n] - level) < tolerance) return;
  row->faces = row->cuts; /* cuts come first */
  if (row->cuts == MOST_CUTS || !add_face(row, normal)) return;
  row->level[row->cuts++] = level;
  row->faceless = true;
}

/** Mean way to the bonded neighbours in the reference; 0 if they are too few to tell a face. */
static void mean_way(const Contact *c, int32_t place, double way[3])
{
  const Family *f = c->family;
  const int64_t slice = place / SLICE;
  double volume = 0;
  int count = 0;
  for (int k = 0; k < 3; ++k) way[k] = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> (place % SLICE) & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, place % SLICE);
    const double v = f->particles->volume[bond.neighbour];
    volume += v;
    ++count;
    for (int k = 0; k < 3; ++k) way[k] += v * bond.xi[k];
  }
  for (int k = 0; k < 3; ++k) way[k] = count > c->body->dimensions ? way[k] / volume : 0;
}

/** Sides of a lattice cell on which no neighbour ever stood. */
static void add_sides(const Contact *c, ContactRow *row)
{
  const Particles *p = &c->body->particles;
  const Lattice *lattice = contact_lattice(c, row->place);
  bool there[3][2] = {{false}};
  const int64_t slice = row->place / SLICE;
  const int lane = row->place % SLICE;
  for (int64_t slot = c->family->first[slice]; slot < c->family->stored[slice] + row->count; ++slot) {
    double xi[3];
    const int64_t former = slot - c->family->stored[slice];
    if (former < 0 && !(c->family->intact[slot] >> lane & 1)) continue;
    if (former >= 0 && !row->pairs[former].bond) continue;
    reference_way(p, row->place, former < 0 ? family_base(c->family, slice, slot) + lane : row->pairs[former].neighbour,
                  xi);
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

void contact_find_faces(const Contact *c, ContactRow *row)
{
  const Particles *p = &c->body->particles;
  const Lattice *lattice = contact_lattice(c, row->place);
  double inward[3], lost[3] = {0}, volume = 0;
  row->faces = row->cuts;
  row->depth = lattice->spacing / 2;
  mean_way(c, row->place, inward);
  for (int32_t n = 0; n < row->count; ++n) {
    const ContactPair *pair = &row->pairs[n];
    double xi[3];
    if (!pair->bond) continue;
    reference_way(p, row->place, pair->neighbour, xi);
    row->depth = fmin(row->depth, (pair->kind == PAIR_CUT ? fabs(dot(xi, pair->normal[0])) : pair->rest) / 2);
    if (pair->kind == PAIR_CUT) continue;
    for (int k = 0; k < 3; ++k) lost[k] += p->volume[pair->neighbour] * xi[k];
    volume += p->volume[pair->neighbour];
  }
  for (int k = 0; k < 3 && volume > 0; ++k) lost[k] = lost[k] / volume - inward[k];
  if (volume > 0 && sqrt(dot(lost, lost)) >= least_offset * lattice->spacing) add_face(row, lost);
  if (lattice->chunks && lattice_is_grid(lattice->type)) {
    add_sides(c, row);
  } else if (row->faces == 0 && sqrt(dot(inward, inward)) >= least_offset * lattice->spacing) {
    const double away[3] = {-inward[0], -inward[1], -inward[2]};
    add_face(row, away);
    /* Where rows are shifted: half the way to the next particles across, so that bodies that touch do not press on each other. */
    double across = 0;
    for (int k = 0; k < 3 && row->faces; ++k) across += fabs(row->face[0][k]) * lattice->plane[k];
    if (lattice->chunks && row->faces) row->depth = fmin(row->depth, across / 2);
  }
}

/* ---- the face between two ---- */

int contact_common_cut(const Contact *c, const ContactRow *row, const ContactRow *other)
{
  const double tolerance = 1e-6 * c->body->largest_spacing;
  for (int m = 0; m < row->cuts; ++m)
    for (int n = 0; n < other->cuts; ++n)
      if (dot(row->face[m], other->face[n]) < -1 + 1e-9 && fabs(row->level[m] + other->level[n]) < tolerance) return m;
  return -1;
}

/** How a normal of the reference stands now, times a sign; unit. @return false if that is not known */
static bool present_face(const ContactRow *row, const double normal[3], double sign, double now[3])
{
  for (int i = 0; i < 3; ++i) now[i] = sign * dot(row->frame.cofactor + 3 * i, normal);
  return row->frame.known && make_unit(now);
}

/** The faces that lie against each other, or else the one face, across which two rows are farthest apart, as convex bodies are. */
static void choose_met(const Contact *c, double *const *u, const ContactRow *low, const ContactRow *high,
                       ContactPair *pair)
{
  double way[3], most = -INFINITY;
  present_way(&c->body->particles, u, low->place, high->place, way);
  const double least = least_cosine * sqrt(dot(way, way));
  memset(pair->normal, 0, sizeof pair->normal);
  for (int both = 1; both >= 0 && most == -INFINITY; --both)
    for (int m = both ? 0 : -1; m < low->faces; ++m)
      for (int n = both ? 0 : -1; n < high->faces; ++n) {
        double one[3] = {0}, two[3] = {0}, normal[3];
        if (!both && (m < 0) == (n < 0)) continue;
        if (m >= 0 && !present_face(low, low->face[m], 1, one)) continue;
        if (n >= 0 && !present_face(high, high->face[n], -1, two)) continue;
        if (both && dot(one, two) < 0.85) continue;
        for (int k = 0; k < 3; ++k) normal[k] = one[k] + two[k];
        make_unit(normal);
        const double apart = dot(way, normal);
        if (apart <= most || apart < least) continue;
        most = apart;
        for (int k = 0; k < 3; ++k) {
          pair->normal[0][k] = m >= 0 ? low->face[m][k] : 0;
          pair->normal[1][k] = n >= 0 ? -high->face[n][k] : 0;
        }
      }
  pair->kind = PAIR_MET;
  pair->depth = low->depth + high->depth;
}

void contact_choose(const Contact *c, double *const *u, const ContactRow *row, const ContactRow *other,
                    ContactPair *pair)
{
  const ContactRow *low = pair->low ? row : other, *high = pair->low ? other : row;
  Press press;
  if (pair->kind == PAIR_BROKEN || (pair->kind != PAIR_NEW && contact_press(c, u, low, high, pair, false, &press)))
    return;
  const int cut = pair->bond ? -1 : contact_common_cut(c, low, high);
  if (cut >= 0) {
    pair->kind = PAIR_CUT;
    for (int k = 0; k < 3; ++k) pair->normal[0][k] = pair->normal[1][k] = low->face[cut][k];
  } else if (!pair->bond) {
    choose_met(c, u, low, high, pair);
  }
  if (pair->kind == PAIR_CUT) {
    /* To the last bit as contact_press measures it in the reference, where nothing must press. */
    double xi[3], normal[3];
    reference_way(&c->body->particles, low->place, high->place, xi);
    for (int k = 0; k < 3; ++k) {
      normal[k] = 0;
      if (low->frame.known) normal[k] += pair->normal[0][k];
      if (high->frame.known) normal[k] += pair->normal[1][k];
    }
    pair->depth = make_unit(normal) ? dot(xi, normal) : sqrt(dot(xi, xi));
  }
  pair->rest = pair->depth;
  if (contact_press(c, u, low, high, pair, false, &press)) pair->rest = press.across;
}
