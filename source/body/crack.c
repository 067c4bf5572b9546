/* Pre-existing cracks: particles taken out, and surfaces that cut bonds. */
#include "body/body.h"

#include <math.h>

static void check_cut(const DeckReader *reader, void *section)
{
  const CutSpec *cut = section;
  if (cut->line.count == 1)
    node_error(reader->document, section_place(section, "line"), reader->error, "line: needs at least two points");
  if (cut->polygon.count == 1 || cut->polygon.count == 2)
    node_error(reader->document, section_place(section, "polygon"), reader->error,
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
      node_error(reader->document, section_place(section, "polygon"), reader->error,
                 "polygon: corner %d does not lie in the plane of the first three", n + 1);
      break;
    }
  }
}

static const Field cut_fields[] = {
    {"line", FIELD_POINTS, offsetof(CutSpec, line), "length", "", NULL,
     "points [x, y] of a line; in space the cut runs through the whole height along z", NULL, NULL, 'A'},
    {"polygon", FIELD_POINTS, offsetof(CutSpec, polygon), "length", "", NULL, "corners [x, y, z] of a flat polygon",
     NULL, NULL, 'A'},
};
static const Section cut_section = {"cut",
                                    "A surface without thickness that no bond crosses.",
                                    sizeof(CutSpec),
                                    FIELDS(cut_fields),
                                    check_cut,
                                    NULL,
                                    NULL,
                                    0};

static void check_crack(const DeckReader *reader, void *section)
{
  const CrackSpec *crack = section;
  if (crack->remove && crack->cut_faces && !crack->remove->box)
    node_error(reader->document, section_place(section, "cut faces"), reader->error,
               "cut faces: works for a box only; give the cut as a line or polygon of its own");
  else if (!crack->remove && crack->cut_faces)
    node_error(reader->document, section_place(section, "cut faces"), reader->error, "cut faces: goes with 'remove'");
}

static const Field crack_fields[] = {
    {"remove", FIELD_SECTION, offsetof(CrackSpec, remove), NULL, "", NULL, "particles inside this shape are taken out",
     &shape_section, NULL, 'A'},
    {"cut", FIELD_SECTION, offsetof(CrackSpec, cut), NULL, "", NULL, "bonds across this surface are cut", &cut_section,
     NULL, 'A'},
    {"cut faces", FIELD_FLAG, offsetof(CrackSpec, cut_faces), NULL, "no", NULL,
     "with 'remove' of a box: bonds across the middle plane of the box (across its thinnest direction) are cut too, so "
     "that "
     "its faces do not hold together",
     NULL, NULL, 0},
};
const Section crack_section = {"crack",
                               "A notch or crack that is there from the beginning.",
                               sizeof(CrackSpec),
                               FIELDS(crack_fields),
                               check_crack,
                               NULL,
                               NULL,
                               0};

/* A particle that lies on a cut belongs to its positive side, so that a cut through a row of particles parts the body beside
 * the row instead of cutting the row off from both sides. */

/** Where a segment that goes from signed distance `from` to `to` crosses zero, as a share of it; -1 if it stays on one side.
 *  @param[in] length  of the segment, for the size of roundings */
static double crossing(double from, double to, double length)
{
  double rounding = -1e-9 * length;
  if ((from >= rounding) == (to >= rounding)) return -1;
  return fmax(0, fmin(1, from / (from - to)));
}

static double length_of(const double a[3], const double b[3])
{
  return sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
}

/** True if segment ab crosses the line from c to d, seen along z; meeting the very end of the line counts. */
static bool line_crossed(const double c[3], const double d[3], const double a[3], const double b[3])
{
  double sx = d[0] - c[0], sy = d[1] - c[1], size = sqrt(sx * sx + sy * sy);
  if (size == 0) return false;
  double from = (sx * (a[1] - c[1]) - sy * (a[0] - c[0])) / size, to = (sx * (b[1] - c[1]) - sy * (b[0] - c[0])) / size;
  double t = crossing(from, to, length_of(a, b));
  if (t < 0) return false;
  double x = a[0] + t * (b[0] - a[0]) - c[0], y = a[1] + t * (b[1] - a[1]) - c[1], along = (x * sx + y * sy) / size;
  double end = 1e-9 * length_of(a, b);
  return along >= -end && along <= size + end;
}

static bool polygon_crossed(const double *corners, int count, const double a[3], const double b[3])
{
  double u[3], v[3], normal[3], size = 0, from = 0, to = 0;
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
  double t = crossing(from / sqrt(size), to / sqrt(size), length_of(a, b));
  if (t < 0) return false;
  /* Seen along the largest component of the normal the polygon keeps its shape. */
  int drop = 0;
  for (int k = 1; k < 3; ++k)
    if (fabs(normal[k]) > fabs(normal[drop])) drop = k;
  int ix = (drop + 1) % 3, iy = (drop + 2) % 3;
  double x = a[ix] + t * (b[ix] - a[ix]), y = a[iy] + t * (b[iy] - a[iy]);
  bool inside = false;
  for (int m = 0, n = count - 1; m < count; n = m++) {
    const double *p = corners + 3 * m, *q = corners + 3 * n;
    if ((p[iy] > y) != (q[iy] > y) && x < (q[ix] - p[ix]) * (y - p[iy]) / (q[iy] - p[iy]) + p[ix]) inside = !inside;
  }
  return inside;
}

/** True if a segment crosses the middle plane of a box inside the box. Whole boxes would cut more: slanting bonds that pass the
 *  end of a notch through its corner, which lengthens the crack by half a spacing. */
static bool crosses_middle(const Box *box, const Body *body, const double a[3], const double b[3])
{
  double low[3], high[3];
  box_corners(box, body->largest_spacing, low, high);
  const int dimensions = body->dimensions;
  int thin = 0;
  for (int k = 1; k < dimensions; ++k)
    if (high[k] - low[k] < high[thin] - low[thin]) thin = k;
  double middle = (low[thin] + high[thin]) / 2, t = crossing(a[thin] - middle, b[thin] - middle, length_of(a, b));
  if (t < 0) return false;
  for (int k = 0; k < dimensions; ++k) {
    double x = a[k] + t * (b[k] - a[k]), tolerance = 1e-9 * (high[k] - low[k]);
    if (k != thin && (x < low[k] - tolerance || x > high[k] + tolerance)) return false;
  }
  return true;
}

bool body_cuts(const Body *body, const double a[3], const double b[3])
{
  for (int c = 0; c < body->crack_count; ++c) {
    const CrackSpec *crack = body->cracks[c];
    if (crack->cut_faces && crack->remove && crosses_middle(crack->remove->box, body, a, b)) return true;
    if (!crack->cut) continue;
    const NumberList *line = &crack->cut->line, *polygon = &crack->cut->polygon;
    for (int n = 0; n + 1 < line->count; ++n)
      if (line_crossed(line->values + 3 * n, line->values + 3 * (n + 1), a, b)) return true;
    if (polygon->count && polygon_crossed(polygon->values, polygon->count, a, b)) return true;
  }
  return false;
}
