/* Pre-existing cracks: particles taken out, and surfaces that cut bonds. Layers outside the body, which stand for what it is the image of, are cut as
 * the body is: bonds with an end there are carried back into it, and what they cross outside it does not count. */
#include "body/body.h"

#include <math.h>

/* A particle that lies on a cut belongs to its positive side, so that a cut through a row of particles parts the body beside
 * the row instead of cutting the row off from both sides. A bond that only touches the end of a cut does not cross it: ends that
 * lie half-way between two rows of particles would else reach half a spacing further for slanting bonds. An end counts where
 * the cut goes on or leaves the body: at the next piece of a line, at a cut that begins there, and at or beyond the
 * outermost particles. */

static const double nearly = 1e-9, at_end = 1e-6; /* shares of a bond's length: a place on the surface, on its end */

/** Where a segment that goes from signed distance `from` to `to` crosses zero, as a share of it; -1 if it stays on one side.
 *  @param[in] length  of the segment, for the size of roundings */
static double crossing(double from, double to, double length)
{
  double rounding = -nearly * length;
  if ((from >= rounding) == (to >= rounding)) return -1;
  return fmax(0, fmin(1, from / (from - to)));
}

static double distance(const double a[3], const double b[3], int dimensions)
{
  double square = 0;
  for (int k = 0; k < dimensions; ++k) square += (b[k] - a[k]) * (b[k] - a[k]);
  return sqrt(square);
}

/** Where crossings count: inside the faces beyond which a bond has an end, in a margin; beyond them only its images do. */
typedef struct Window {
  const Body *body;
  double face[3][2]; /* along each axis: low, high */
  bool closed[3][2]; /* the bond has an end beyond it */
  bool repeats[3];   /* images are moved along, by the distance of the two faces, and not mirrored */
} Window;

/** Whether a place is inside. */
static bool within(const Window *w, const double x[3], double tolerance)
{
  for (int k = 0; k < 3; ++k)
    if ((w->closed[k][0] && x[k] < w->face[k][0] - tolerance) || (w->closed[k][1] && x[k] > w->face[k][1] + tolerance))
      return false;
  return true;
}

/** Whether both points lie at a face, or beyond. */
static bool at_face(const Window *w, int k, int side, const double a[3], const double b[3], double tolerance)
{
  if (!w->closed[k][side]) return false;
  return side ? fmin(a[k], b[k]) >= w->face[k][1] - tolerance : fmax(a[k], b[k]) <= w->face[k][0] + tolerance;
}

/** True if both points lie at or beyond the outermost particles of one side of the body. */
static bool outermost(const Body *body, const double a[3], const double b[3], int dimensions, double tolerance)
{
  for (int k = 0; k < dimensions; ++k)
    if (fmax(a[k], b[k]) <= body->low[k] + tolerance || fmin(a[k], b[k]) >= body->high[k] - tolerance) return true;
  return false;
}

/** Cross product in the plane of the way from c to d and that from d to x, over the length of the first: distance of x to the left. */
static double leftward(const double c[3], const double d[3], const double x[3])
{
  double sx = d[0] - c[0], sy = d[1] - c[1];
  return (sx * (x[1] - d[1]) - sy * (x[0] - d[0])) / sqrt(sx * sx + sy * sy);
}

/** On which side of a line that bends at d a point lies, seen from d; d itself on the positive one. */
static bool left_of_bend(const double c[3], const double d[3], const double e[3], const double x[3], double tolerance)
{
  bool first = leftward(c, d, x) >= -tolerance, second = leftward(d, e, x) >= -tolerance;
  if (distance(d, x, 2) <= tolerance) return true;
  return leftward(c, d, e) >= 0 ? first && second : first || second;
}

/** True if a segment that meets corner `at` of a line crosses the line there. */
static bool corner_crossed(const Window *w, const NumberList *line, int at, const double a[3], const double b[3],
                           double tolerance)
{
  const Body *body = w->body;
  const double *p = line->values, *here = p + 3 * at;
  const int last = line->count - 1;
  const bool ring = last > 2 && distance(p, p + 3 * last, 2) <= tolerance;
  if (ring || (at > 0 && at < last)) {
    const double *before = p + 3 * (at > 0 ? at - 1 : last - 1), *after = p + 3 * (at < last ? at + 1 : 1);
    return left_of_bend(before, here, after, a, tolerance) != left_of_bend(before, here, after, b, tolerance);
  }
  if (outermost(body, here, here, 2, tolerance)) return true;
  for (int c = 0; c < body->crack_count; ++c) {
    const NumberList *other = body->cracks[c]->cut ? &body->cracks[c]->cut->line : NULL;
    for (int end = 0; other && other != line && other->count && end < 2; ++end)
      if (distance(here, other->values + (end ? 3 * (other->count - 1) : 0), 2) <= tolerance) return true;
  }
  return false;
}

/** Where a piece of a line comes to a face with images beyond, it goes on there as its own image.
 *  @param[in] here  where the segment meets the piece
 *  @return 1: the segment crosses them there, 0: it does not, -1: they do not meet there */
static int face_crossed(const Window *w, const double c[3], const double d[3], const double here[3], const double a[3],
                        const double b[3], double tolerance)
{
  for (int k = 0; k < 2; ++k)
    for (int side = 0; side < 2; ++side) {
      const double face = w->face[k][side], inwards = side ? -1 : 1;
      if (!at_face(w, k, side, here, here, tolerance) || fabs(c[k] - d[k]) <= tolerance) continue;
      const bool begins = inwards * (c[k] - d[k]) > 0; /* inside */
      const double *inside = begins ? c : d;
      if (inwards * (inside[k] - face) <= tolerance) return 0;
      if (w->repeats[k]) return 1;
      double image[3] = {inside[0], inside[1], inside[2]};
      image[k] = 2 * face - inside[k];
      const double *before = begins ? inside : image, *after = begins ? image : inside;
      return left_of_bend(before, here, after, a, tolerance) != left_of_bend(before, here, after, b, tolerance);
    }
  return -1;
}

/** True if segment ab crosses piece n of a line, seen along z. */
static bool line_crossed(const Window *w, const NumberList *line, int n, const double a[3], const double b[3])
{
  const double *c = line->values + 3 * n, *d = c + 3, length = distance(a, b, 3), end = at_end * length;
  double sx = d[0] - c[0], sy = d[1] - c[1], size = sqrt(sx * sx + sy * sy), meeting[3];
  if (size == 0) return false;
  double t = crossing(leftward(c, d, a), leftward(c, d, b), length);
  if (t < 0) return false;
  for (int k = 0; k < 3; ++k) meeting[k] = a[k] + t * (b[k] - a[k]);
  const double along = ((meeting[0] - c[0]) * sx + (meeting[1] - c[1]) * sy) / size;
  if (along < -end || along > size + end || !within(w, meeting, end)) return false;
  const int at = face_crossed(w, c, d, meeting, a, b, end);
  if (at >= 0) return at > 0;
  if (along <= end) return corner_crossed(w, line, n, a, b, end);
  if (along >= size - end) return corner_crossed(w, line, n + 1, a, b, end);
  return true;
}

static double distance_to_edge(const double c[3], const double d[3], const double x[3])
{
  double size = 0, along = 0, nearest[3];
  for (int k = 0; k < 3; ++k) {
    size += (d[k] - c[k]) * (d[k] - c[k]);
    along += (d[k] - c[k]) * (x[k] - c[k]);
  }
  along = size > 0 ? fmax(0, fmin(1, along / size)) : 0;
  for (int k = 0; k < 3; ++k) nearest[k] = c[k] + along * (d[k] - c[k]);
  return distance(nearest, x, 3);
}

/** True if another polygon goes on beyond this edge. */
static bool edge_is_joined(const Body *body, const NumberList *own, const double c[3], const double d[3],
                           double tolerance)
{
  for (int k = 0; k < body->crack_count; ++k) {
    const NumberList *other = body->cracks[k]->cut ? &body->cracks[k]->cut->polygon : NULL;
    for (int m = 0; other && other != own && m < other->count; ++m) {
      const double *p = other->values + 3 * m, *q = other->values + 3 * ((m + 1) % other->count);
      if ((distance(p, c, 3) <= tolerance && distance(q, d, 3) <= tolerance) ||
          (distance(p, d, 3) <= tolerance && distance(q, c, 3) <= tolerance))
        return true;
    }
  }
  return false;
}

/** Whether an edge of a polygon lies in a face with images beyond, or outside it, where the polygon goes on as its own image. */
static bool ends_at_face(const Window *w, const double c[3], const double d[3], const double normal[3],
                         double tolerance)
{
  const double size = fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2]);
  for (int k = 0; k < 3; ++k) {
    const bool lies_in_it = fabs(normal[k]) >= size * (1 - nearly);
    if (!lies_in_it && (at_face(w, k, 0, c, d, tolerance) || at_face(w, k, 1, c, d, tolerance))) return true;
  }
  return false;
}

static bool polygon_crossed(const Window *w, const NumberList *polygon, const double a[3], const double b[3])
{
  const double *corners = polygon->values, length = distance(a, b, 3), end = at_end * length;
  const int count = polygon->count;
  double u[3], v[3], normal[3], size = 0, from = 0, to = 0, meeting[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = corners[3 + k] - corners[k];
    v[k] = corners[6 + k] - corners[k];
  }
  for (int k = 0; k < 3; ++k) {
    normal[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    size += normal[k] * normal[k];
    from += normal[k] * (a[k] - corners[k]);
    to += normal[k] * (b[k] - corners[k]);
  }
  if (size == 0) return false;
  double t = crossing(from / sqrt(size), to / sqrt(size), length);
  if (t < 0) return false;
  for (int k = 0; k < 3; ++k) meeting[k] = a[k] + t * (b[k] - a[k]);
  if (!within(w, meeting, end)) return false;
  bool on_edge = false;
  for (int m = 0; m < count; ++m) {
    const double *c = corners + 3 * m, *d = corners + 3 * ((m + 1) % count);
    if (distance_to_edge(c, d, meeting) > end) continue;
    if (!outermost(w->body, c, d, 3, end) && !ends_at_face(w, c, d, normal, end) &&
        !edge_is_joined(w->body, polygon, c, d, end))
      return false;
    on_edge = true;
  }
  if (on_edge) return true;
  /* Seen along the largest component of the normal the polygon keeps its shape. */
  int drop = 0;
  for (int k = 1; k < 3; ++k)
    if (fabs(normal[k]) > fabs(normal[drop])) drop = k;
  int ix = (drop + 1) % 3, iy = (drop + 2) % 3;
  double x = meeting[ix], y = meeting[iy];
  bool inside = false;
  for (int m = 0, n = count - 1; m < count; n = m++) {
    const double *p = corners + 3 * m, *q = corners + 3 * n;
    if ((p[iy] > y) != (q[iy] > y) && x < (q[ix] - p[ix]) * (y - p[iy]) / (q[iy] - p[iy]) + p[ix]) inside = !inside;
  }
  return inside;
}

/** True if particles would stand at this coordinate: those on the surface of a notch are taken out with it. */
static bool row_at(const Body *body, int axis, double x, double tolerance)
{
  for (int n = 0; n < body->block_count; ++n) {
    const Lattice *lattice = &body->lattices[n];
    double off = (x - lattice->origin[axis]) / lattice->plane[axis];
    if (lattice->chunks && fabs(off - round(off)) * lattice->plane[axis] <= tolerance) return true;
  }
  return false;
}

/** True if a segment crosses the middle plane of a box inside the box. Whole boxes would cut more: slanting bonds that pass the
 *  end of a notch through its corner, which lengthens the crack by half a spacing. */
static bool crosses_middle(const Box *box, const Window *w, const double a[3], const double b[3])
{
  const Body *body = w->body;
  double low[3], high[3], meeting[3], length = distance(a, b, 3), end = at_end * length;
  box_corners(box, &body->coarsest->unit, low, high);
  const int dimensions = body->dimensions;
  int thin = 0;
  for (int k = 1; k < dimensions; ++k)
    if (high[k] - low[k] < high[thin] - low[thin]) thin = k;
  double middle = (low[thin] + high[thin]) / 2, t = crossing(a[thin] - middle, b[thin] - middle, length);
  if (t < 0) return false;
  for (int k = 0; k < 3; ++k) meeting[k] = a[k] + t * (b[k] - a[k]);
  if (!within(w, meeting, end)) return false;
  for (int k = 0; k < dimensions; ++k) {
    const double x = meeting[k];
    if (k == thin || (x > low[k] + end && x < high[k] - end)) continue;
    if (x < low[k] - end || x > high[k] + end) return false;
    const bool upper = x >= (low[k] + high[k]) / 2;
    const double *corner = upper ? high : low, side = corner[k];
    const bool leaves = upper ? side >= body->high[k] - end : side <= body->low[k] + end;
    if (!leaves && !at_face(w, k, upper, corner, corner, end) && !row_at(body, k, side, end)) return false;
  }
  return true;
}

/** The line piece or polygon of a crack that a segment crosses.
 *  @param[out] normal  of any length and side; may be NULL
 *  @return a corner of it, or NULL if none is crossed */
static const double *cut_crossed(const Window *w, const CutSpec *cut, const double a[3], const double b[3],
                                 double normal[3])
{
  const NumberList *line = &cut->line, *polygon = &cut->polygon;
  const double *p = polygon->values;
  if (polygon->count && polygon_crossed(w, polygon, a, b)) {
    for (int k = 0; k < 3 && normal; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      normal[k] = (p[3 + i] - p[i]) * (p[6 + j] - p[j]) - (p[3 + j] - p[j]) * (p[6 + i] - p[i]);
    }
    return p;
  }
  for (int n = 0; n + 1 < line->count; ++n) {
    if (!line_crossed(w, line, n, a, b)) continue;
    const double *c = line->values + 3 * n;
    if (normal) {
      normal[0] = c[1] - c[4];
      normal[1] = c[3] - c[0];
      normal[2] = 0;
    }
    return c;
  }
  return NULL;
}

/** One way to carry a bond into the body: along each axis left as it is, or through the low or the high face. */
typedef struct Passage {
  bool through[3][2];
  double a[3], b[3]; /* the bond there */
} Passage;

enum { PASSAGES = 27 };

/** Closes the faces beyond which an end of a bond stands in a margin. */
static void close_faces(Window *w, int32_t place)
{
  const Particles *p = &w->body->particles;
  const int block = p->block[place / SLICE];
  const Lattice *lattice = &w->body->lattices[block];
  for (int m = 0; m < w->body->margins.count; ++m) {
    const Margin *margin = &w->body->margins.items[m];
    const int k = margin->axis;
    if (margin->block != block) continue;
    const double inside = (double)(lattice->margin[k][0]) - 0.5, low = lattice->origin[k] + inside * lattice->plane[k],
                 behind = (double)(lattice->cells[k] - lattice->margin[k][1]) - 0.5,
                 high = lattice->origin[k] + behind * lattice->plane[k], x = p->position[k][place];
    if (margin->high ? x <= high : x >= low) continue;
    w->closed[k][margin->high] = true;
    w->face[k][0] = low;
    w->face[k][1] = high;
    w->repeats[k] = margin->repeats;
  }
}

/** Where a coordinate is carried through a face. */
static double carried(const Window *w, int k, int side, double x)
{
  const double *face = w->face[k];
  if (w->repeats[k]) return x + (side ? face[0] - face[1] : face[1] - face[0]);
  return 2 * face[side] - x;
}

/** All ways to carry a bond into the body by which some of it comes to lie there. @return how many */
static int find_passages(Window *w, int32_t one, int32_t other, Passage passages[PASSAGES])
{
  const Particles *p = &w->body->particles;
  int count = 1;
  passages[0] = (Passage){.a = {0}};
  for (int k = 0; k < 3; ++k) {
    passages[0].a[k] = p->position[k][one];
    passages[0].b[k] = p->position[k][other];
  }
  if (!w->body->margin_of) return count;
  if (body_outside(w->body, p->number[one])) close_faces(w, one);
  if (body_outside(w->body, p->number[other])) close_faces(w, other);
  for (int k = 0; k < 3; ++k) {
    const int before = count;
    for (int side = 0; side < 2; ++side)
      for (int n = 0; n < before && w->closed[k][side]; ++n) {
        Passage *way = &passages[count++];
        *way = passages[n];
        way->through[k][side] = true;
        way->a[k] = carried(w, k, side, way->a[k]);
        way->b[k] = carried(w, k, side, way->b[k]);
      }
  }
  return count;
}

/** Which of two points comes first: a bond is judged alike from both ends, to the last rounding. */
static bool comes_first(const double a[3], const double b[3])
{
  for (int k = 0; k < 3; ++k)
    if (a[k] != b[k]) return a[k] < b[k];
  return true;
}

static void swap_ends(Passage *way)
{
  for (int k = 0; k < 3; ++k) {
    const double kept = way->a[k];
    way->a[k] = way->b[k];
    way->b[k] = kept;
  }
}

/** The ways of a bond between two places, from the end that comes first. @param[out] swapped  that is the other one */
static int bond_passages(Window *w, int32_t one, int32_t other, Passage passages[PASSAGES], bool *swapped)
{
  const int count = find_passages(w, one, other, passages);
  *swapped = !comes_first(passages[0].a, passages[0].b);
  for (int n = 0; n < count && *swapped; ++n) swap_ends(&passages[n]);
  return count;
}

/** The way of a segment where no image is. */
static Passage straight(const double a[3], const double b[3])
{
  Passage way = {.a = {a[0], a[1], a[2]}, .b = {b[0], b[1], b[2]}};
  if (!comes_first(a, b)) swap_ends(&way);
  return way;
}

static bool cut_on(const Window *w, const Passage *passages, int count)
{
  const Body *body = w->body;
  bool cuts = false;
  for (int c = 0; c < body->crack_count; ++c) {
    const CrackSpec *crack = body->cracks[c];
    bool met = false;
    for (int n = 0; n < count && !met; ++n) {
      const double *a = passages[n].a, *b = passages[n].b;
      met = (crack->cut_faces && crack->remove && crosses_middle(crack->remove->box, w, a, b)) ||
            (crack->cut && cut_crossed(w, crack->cut, a, b, NULL));
    }
    if (!met) continue;
    __atomic_store_n(&body->crack_met[c], 1, __ATOMIC_RELAXED);
    cuts = true;
  }
  return cuts;
}

bool body_cuts(const Body *body, const double a[3], const double b[3])
{
  const Window w = {.body = body};
  const Passage way = straight(a, b);
  return cut_on(&w, &way, 1);
}

bool body_cuts_bond(const Body *body, int32_t one, int32_t other)
{
  Window w = {.body = body};
  Passage passages[PASSAGES];
  bool swapped;
  const int count = bond_passages(&w, one, other, passages, &swapped);
  return cut_on(&w, passages, count);
}

static bool runs_through_notch(const Window *w, const double a[3], const double b[3])
{
  enum { PARTS = 8 };
  const Body *body = w->body;
  for (int c = 0; c < body->crack_count; ++c) {
    const CrackSpec *crack = body->cracks[c];
    if (!crack->remove) continue;
    if (crack->cut_faces && crosses_middle(crack->remove->box, w, a, b)) return true;
    for (int n = 1; n < PARTS; ++n) {
      double point[3];
      for (int k = 0; k < 3; ++k) point[k] = a[k] + (b[k] - a[k]) * n / PARTS;
      if (within(w, point, 0) && shape_contains(crack->remove, &body->coarsest->unit, body->dimensions, point, 0))
        return true;
    }
  }
  return false;
}

/** @param[in] swapped  the normal is to point to the first end */
static bool closed_on(const Window *w, const Passage *passages, int count, bool swapped, double normal[3],
                      double *level)
{
  const Body *body = w->body;
  const double *corner = NULL;
  const Passage *way = passages;
  for (int c = 0; c < body->crack_count && !corner; ++c)
    for (int n = 0; n < count && !corner && body->cracks[c]->cut; ++n) {
      way = &passages[n];
      corner = cut_crossed(w, body->cracks[c]->cut, way->a, way->b, normal);
    }
  if (!corner) return false;
  for (int n = 0; n < count; ++n)
    if (runs_through_notch(w, passages[n].a, passages[n].b)) return false;
  double size = 0, along = 0, at[3] = {corner[0], corner[1], corner[2]};
  for (int k = 0; k < 3; ++k) {
    size += normal[k] * normal[k];
    along += normal[k] * (way->b[k] - way->a[k]);
  }
  size = (along < 0) != swapped ? -sqrt(size) : sqrt(size);
  *level = 0;
  for (int k = 0; k < 3; ++k) {
    normal[k] /= size;
    for (int side = 0; side < 2; ++side) {
      if (!way->through[k][side]) continue; /* back to where the bond is */
      at[k] = carried(w, k, w->repeats[k] ? !side : side, at[k]);
      if (!w->repeats[k]) normal[k] = -normal[k];
    }
    *level += normal[k] * at[k];
  }
  return true;
}

bool body_closed_cut(const Body *body, const double a[3], const double b[3], double normal[3], double *level)
{
  const Window w = {.body = body};
  const Passage way = straight(a, b);
  return closed_on(&w, &way, 1, !comes_first(a, b), normal, level);
}

bool body_closed_bond(const Body *body, int32_t one, int32_t other, double normal[3], double *level)
{
  Window w = {.body = body};
  Passage passages[PASSAGES];
  bool swapped;
  const int count = bond_passages(&w, one, other, passages, &swapped);
  return closed_on(&w, passages, count, swapped, normal, level);
}
