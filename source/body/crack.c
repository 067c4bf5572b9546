/* Pre-existing cracks: particles taken out, and surfaces that cut bonds. */
#include "body/body.h"

#include <math.h>

static void check_cut(const DeckReader *reader, void *section)
{
  const CutSpec *cut = section;
  if (cut->line.count == 1)
    node_error(reader->document, section_node(section, "line"), reader->error, "line: needs at least two points");
  if (cut->polygon.count == 1 || cut->polygon.count == 2)
    node_error(reader->document, section_node(section, "polygon"), reader->error,
               "polygon: needs at least three corners");
  for (int n = 3; n < cut->polygon.count; ++n) {
    const double *p = cut->polygon.values;
    double a[3], b[3], c[3], size = 0;
    for (int k = 0; k < 3; ++k) {
      a[k] = p[3 + k] - p[k];
      b[k] = p[6 + k] - p[k];
      c[k] = p[3 * n + k] - p[k];
      size += a[k] * a[k] + b[k] * b[k] + c[k] * c[k];
    }
    double volume =
        c[0] * (a[1] * b[2] - a[2] * b[1]) + c[1] * (a[2] * b[0] - a[0] * b[2]) + c[2] * (a[0] * b[1] - a[1] * b[0]);
    if (fabs(volume) > 1e-9 * pow(size, 1.5)) {
      node_error(reader->document, section_node(section, "polygon"), reader->error,
                 "polygon: corner %d does not lie in the plane of the first three", n + 1);
      break;
    }
  }
}

static const Field cut_fields[] = {
    {.key = "line",
     .kind = FIELD_POINTS,
     .offset = offsetof(CutSpec, line),
     .dimension = "length",
     .standard = "",
     .meaning = "points [x, y] of a line; in space the cut runs through the whole height along z",
     .group = 'A'},
    {.key = "polygon",
     .kind = FIELD_POINTS,
     .offset = offsetof(CutSpec, polygon),
     .dimension = "length",
     .standard = "",
     .meaning = "corners [x, y, z] of a flat polygon",
     .group = 'A'},
};
static const Section cut_section = {
    .name = "cut",
    .about =
        "A surface without thickness that no bond crosses. A bond that only touches its end or edge is left whole, "
        "unless the cut leaves the body there (at or beyond the outermost particles) or another begins. A particle on "
        "it belongs to the side at the left of a line, or where a polygon's corners run anticlockwise.",
    .size = sizeof(CutSpec),
    FIELDS(cut_fields),
    .check = check_cut};

static void check_crack(const DeckReader *reader, void *section)
{
  const CrackSpec *crack = section;
  if (crack->remove && crack->cut_faces && !crack->remove->box)
    node_error(reader->document, section_node(section, "cut faces"), reader->error,
               "cut faces: works for a box only; give the cut as a line or polygon of its own");
  else if (!crack->remove && crack->cut_faces)
    node_error(reader->document, section_node(section, "cut faces"), reader->error, "cut faces: goes with 'remove'");
}

static const Field crack_fields[] = {
    {.key = "remove",
     .kind = FIELD_SECTION,
     .offset = offsetof(CrackSpec, remove),
     .standard = "",
     .meaning = "particles inside this shape are taken out",
     .section = &shape_section,
     .group = 'A'},
    {.key = "cut",
     .kind = FIELD_SECTION,
     .offset = offsetof(CrackSpec, cut),
     .standard = "",
     .meaning = "bonds across this surface are cut",
     .section = &cut_section,
     .group = 'A'},
    {.key = "cut faces",
     .kind = FIELD_FLAG,
     .offset = offsetof(CrackSpec, cut_faces),
     .standard = "no",
     .meaning = "with 'remove' of a box: bonds across the middle plane of the box (across its thinnest direction) are "
                "cut too, so that its faces do not hold together; bonds that only touch the end of the plane are not, "
                "unless particles were taken out there"},
};
const Section crack_section = {.name = "crack",
                               .about = "A notch or crack that is there from the beginning.",
                               .size = sizeof(CrackSpec),
                               FIELDS(crack_fields),
                               .check = check_crack};

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
static bool corner_crossed(const Body *body, const NumberList *line, int at, const double a[3], const double b[3],
                           double tolerance)
{
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

/** True if segment ab crosses piece n of a line, seen along z. */
static bool line_crossed(const Body *body, const NumberList *line, int n, const double a[3], const double b[3])
{
  const double *c = line->values + 3 * n, *d = c + 3, length = distance(a, b, 3), end = at_end * length;
  double sx = d[0] - c[0], sy = d[1] - c[1], size = sqrt(sx * sx + sy * sy);
  if (size == 0) return false;
  double t = crossing(leftward(c, d, a), leftward(c, d, b), length);
  if (t < 0) return false;
  double x = a[0] + t * (b[0] - a[0]) - c[0], y = a[1] + t * (b[1] - a[1]) - c[1], along = (x * sx + y * sy) / size;
  if (along < -end || along > size + end) return false;
  if (along <= end) return corner_crossed(body, line, n, a, b, end);
  if (along >= size - end) return corner_crossed(body, line, n + 1, a, b, end);
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

static bool polygon_crossed(const Body *body, const NumberList *polygon, const double a[3], const double b[3])
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
  bool on_edge = false;
  for (int m = 0; m < count; ++m) {
    const double *c = corners + 3 * m, *d = corners + 3 * ((m + 1) % count);
    if (distance_to_edge(c, d, meeting) > end) continue;
    if (!outermost(body, c, d, 3, end) && !edge_is_joined(body, polygon, c, d, end)) return false;
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
static bool crosses_middle(const Box *box, const Body *body, const double a[3], const double b[3])
{
  double low[3], high[3], length = distance(a, b, 3), end = at_end * length;
  box_corners(box, &body->coarsest->unit, low, high);
  const int dimensions = body->dimensions;
  int thin = 0;
  for (int k = 1; k < dimensions; ++k)
    if (high[k] - low[k] < high[thin] - low[thin]) thin = k;
  double middle = (low[thin] + high[thin]) / 2, t = crossing(a[thin] - middle, b[thin] - middle, length);
  if (t < 0) return false;
  for (int k = 0; k < dimensions; ++k) {
    double x = a[k] + t * (b[k] - a[k]);
    if (k == thin || (x > low[k] + end && x < high[k] - end)) continue;
    if (x < low[k] - end || x > high[k] + end) return false;
    const double side = x < (low[k] + high[k]) / 2 ? low[k] : high[k];
    const bool leaves = side == low[k] ? side <= body->low[k] + end : side >= body->high[k] - end;
    if (!leaves && !row_at(body, k, side, end)) return false;
  }
  return true;
}

/** Which of two points comes first: a bond is judged alike from both ends, to the last rounding. */
static bool comes_first(const double a[3], const double b[3])
{
  for (int k = 0; k < 3; ++k)
    if (a[k] != b[k]) return a[k] < b[k];
  return true;
}

/** The line piece or polygon of a crack that a segment crosses.
 *  @param[out] normal  of any length and side; may be NULL
 *  @return a corner of it, or NULL if none is crossed */
static const double *cut_crossed(const Body *body, const CutSpec *cut, const double a[3], const double b[3],
                                 double normal[3])
{
  const NumberList *line = &cut->line, *polygon = &cut->polygon;
  const double *p = polygon->values;
  if (polygon->count && polygon_crossed(body, polygon, a, b)) {
    for (int k = 0; k < 3 && normal; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      normal[k] = (p[3 + i] - p[i]) * (p[6 + j] - p[j]) - (p[3 + j] - p[j]) * (p[6 + i] - p[i]);
    }
    return p;
  }
  for (int n = 0; n + 1 < line->count; ++n) {
    if (!line_crossed(body, line, n, a, b)) continue;
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

bool body_cuts(const Body *body, const double a[3], const double b[3])
{
  if (!comes_first(a, b)) return body_cuts(body, b, a);
  bool cuts = false;
  for (int c = 0; c < body->crack_count; ++c) {
    const CrackSpec *crack = body->cracks[c];
    if (!(crack->cut_faces && crack->remove && crosses_middle(crack->remove->box, body, a, b)) &&
        !(crack->cut && cut_crossed(body, crack->cut, a, b, NULL)))
      continue;
    __atomic_store_n(&body->crack_met[c], 1, __ATOMIC_RELAXED);
    cuts = true;
  }
  return cuts;
}

static bool runs_through_notch(const Body *body, const double a[3], const double b[3])
{
  enum { PARTS = 8 };
  for (int c = 0; c < body->crack_count; ++c) {
    const CrackSpec *crack = body->cracks[c];
    if (!crack->remove) continue;
    if (crack->cut_faces && crosses_middle(crack->remove->box, body, a, b)) return true;
    for (int n = 1; n < PARTS; ++n) {
      double point[3];
      for (int k = 0; k < 3; ++k) point[k] = a[k] + (b[k] - a[k]) * n / PARTS;
      if (shape_contains(crack->remove, &body->coarsest->unit, body->dimensions, point, 0)) return true;
    }
  }
  return false;
}

bool body_closed_cut(const Body *body, const double a[3], const double b[3], double normal[3], double *level)
{
  if (!comes_first(a, b)) {
    bool closed = body_closed_cut(body, b, a, normal, level);
    for (int k = 0; k < 3 && closed; ++k) normal[k] = -normal[k];
    if (closed) *level = -*level;
    return closed;
  }
  const double *corner = NULL;
  for (int c = 0; c < body->crack_count && !corner; ++c)
    if (body->cracks[c]->cut) corner = cut_crossed(body, body->cracks[c]->cut, a, b, normal);
  if (!corner || runs_through_notch(body, a, b)) return false;
  double size = 0, along = 0;
  for (int k = 0; k < 3; ++k) {
    size += normal[k] * normal[k];
    along += normal[k] * (b[k] - a[k]);
  }
  size = along < 0 ? -sqrt(size) : sqrt(size);
  *level = 0;
  for (int k = 0; k < 3; ++k) {
    normal[k] /= size;
    *level += normal[k] * corner[k];
  }
  return true;
}
