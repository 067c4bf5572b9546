#include "body/shape.h"

#include <math.h>

static void check_box(const DeckReader *reader, void *section)
{
  const Box *box = section;
  bool corners = !isnan(box->from[0]) || !isnan(box->to[0]), counted = box->particles[0] >= 0;
  if (corners == counted || (corners && (isnan(box->from[0]) || isnan(box->to[0]))))
    node_error(reader->document, box->head.node, reader->error,
               "box: give either 'from' and 'to', or 'particles' (and 'first particle')");
  else if (corners && !(box->from[0] < box->to[0] && box->from[1] < box->to[1] && box->from[2] <= box->to[2]))
    node_error(reader->document, box->head.node, reader->error,
               "box: 'to' must lie beyond 'from' in every direction; found from [%g, %g, %g] to [%g, %g, %g]",
               box->from[0], box->from[1], box->from[2], box->to[0], box->to[1], box->to[2]);
}

static const Field box_fields[] = {
    {.key = "from",
     .kind = FIELD_POINT,
     .offset = offsetof(Box, from),
     .dimension = "length",
     .standard = "",
     .meaning = "lowest corner"},
    {.key = "to",
     .kind = FIELD_POINT,
     .offset = offsetof(Box, to),
     .dimension = "length",
     .standard = "",
     .meaning = "highest corner"},
    {.key = "particles",
     .kind = FIELD_COUNTS,
     .offset = offsetof(Box, particles),
     .standard = "",
     .range = "[1, 1e7]",
     .meaning = "size as numbers of particles along x, y, z, instead of corners (of rows and layers where these stand "
                "nearer than the spacing)"},
    {.key = "first particle",
     .kind = FIELD_POINT,
     .offset = offsetof(Box, first),
     .dimension = "length",
     .standard = "",
     .meaning = "centre of the first particle, with 'particles' (the low corner is at the origin when absent)"},
};
const Section box_section = {
    .name = "box", .about = "A box along the axes.", .size = sizeof(Box), FIELDS(box_fields), .check = check_box};

static const Field cylinder_fields[] = {
    {.key = "from",
     .kind = FIELD_POINT,
     .offset = offsetof(Cylinder, from),
     .dimension = "length",
     .meaning = "centre of one end"},
    {.key = "to",
     .kind = FIELD_POINT,
     .offset = offsetof(Cylinder, to),
     .dimension = "length",
     .meaning = "centre of the other end; a disc in the plane is a 'sphere'"},
    {.key = "radius",
     .kind = FIELD_NUMBER,
     .offset = offsetof(Cylinder, radius),
     .dimension = "length",
     .range = "(0, inf)",
     .meaning = "radius"},
};
static void check_cylinder(const DeckReader *reader, void *section)
{
  const Cylinder *c = section;
  if (c->from[0] == c->to[0] && c->from[1] == c->to[1] && c->from[2] == c->to[2])
    node_error(reader->document, c->head.node, reader->error, "cylinder: 'from' and 'to' are the same point");
}
static const Section cylinder_section = {.name = "cylinder",
                                         .about = "A round bar between two points (in the plane: a strip).",
                                         .size = sizeof(Cylinder),
                                         FIELDS(cylinder_fields),
                                         .check = check_cylinder};

static const Field sphere_fields[] = {
    {.key = "centre",
     .kind = FIELD_POINT,
     .offset = offsetof(Sphere, centre),
     .dimension = "length",
     .meaning = "centre"},
    {.key = "radius",
     .kind = FIELD_NUMBER,
     .offset = offsetof(Sphere, radius),
     .dimension = "length",
     .range = "(0, inf)",
     .meaning = "radius"},
};
static const Section sphere_section = {
    .name = "sphere", .about = "A ball (in the plane: a disc).", .size = sizeof(Sphere), FIELDS(sphere_fields)};

static void check_polygon(const DeckReader *reader, void *section)
{
  const Polygon *polygon = section;
  if (polygon->corners.count < 3)
    node_error(reader->document, section_node(section, "corners"), reader->error, "polygon: needs at least 3 corners");
  else if (polygon->top <= polygon->bottom)
    node_error(reader->document, polygon->head.node, reader->error, "polygon: 'top' must be above 'bottom'");
}
static const Field polygon_fields[] = {
    {.key = "corners",
     .kind = FIELD_POINTS,
     .offset = offsetof(Polygon, corners),
     .dimension = "length",
     .meaning = "corners [x, y] in order"},
    {.key = "bottom",
     .kind = FIELD_NUMBER,
     .offset = offsetof(Polygon, bottom),
     .dimension = "length",
     .standard = "0",
     .meaning = "where the extrusion along z begins"},
    {.key = "top",
     .kind = FIELD_NUMBER,
     .offset = offsetof(Polygon, top),
     .dimension = "length",
     .standard = "1",
     .meaning = "where it ends (no meaning in the plane)"},
};
static const Section polygon_section = {.name = "polygon",
                                        .about = "A polygon in the x-y plane, extruded along z.",
                                        .size = sizeof(Polygon),
                                        FIELDS(polygon_fields),
                                        .check = check_polygon};

static void check_shape(const DeckReader *reader, void *section)
{
  const Shape *shape = section;
  const Node *difference = node_get(shape->head.node, "difference");
  if (difference && shape->difference.count < 2)
    node_error(reader->document, difference, reader->error,
               "difference: needs at least two shapes, the first minus the others");
}
static const Field shape_fields[] = {
    {.key = "box",
     .kind = FIELD_SECTION,
     .offset = offsetof(Shape, box),
     .standard = "",
     .meaning = "a box",
     .section = &box_section,
     .group = 'A'},
    {.key = "cylinder",
     .kind = FIELD_SECTION,
     .offset = offsetof(Shape, cylinder),
     .standard = "",
     .meaning = "a round bar",
     .section = &cylinder_section,
     .group = 'A'},
    {.key = "sphere",
     .kind = FIELD_SECTION,
     .offset = offsetof(Shape, sphere),
     .standard = "",
     .meaning = "a ball",
     .section = &sphere_section,
     .group = 'A'},
    {.key = "polygon",
     .kind = FIELD_SECTION,
     .offset = offsetof(Shape, polygon),
     .standard = "",
     .meaning = "an extruded polygon",
     .section = &polygon_section,
     .group = 'A'},
    {.key = "union",
     .kind = FIELD_SECTIONS,
     .offset = offsetof(Shape, together),
     .standard = "",
     .meaning = "all of several shapes",
     .section = &shape_section,
     .group = 'A'},
    {.key = "difference",
     .kind = FIELD_SECTIONS,
     .offset = offsetof(Shape, difference),
     .standard = "",
     .meaning = "the first shape minus the others",
     .section = &shape_section,
     .group = 'A'},
};
const Section shape_section = {.name = "shape",
                               .about = "What a block fills. Shapes nest: a union may hold differences.",
                               .size = sizeof(Shape),
                               FIELDS(shape_fields),
                               .check = check_shape};

void box_corners(const Box *box, const UnitCell *unit, double low[3], double high[3])
{
  for (int k = 0; k < 3; ++k) {
    if (box->particles[0] < 0) {
      low[k] = box->from[k];
      high[k] = box->to[k];
    } else {
      low[k] = isnan(box->first[k]) ? 0 : box->first[k] - unit->first[k];
      high[k] = low[k] + unit->size[k] * (double)box->particles[k];
    }
  }
}

bool polygon_contains(const double *corners, int count, double x, double y)
{
  bool inside = false;
  for (int a = 0, b = count - 1; a < count; b = a++) {
    const double *p = corners + 3 * a, *q = corners + 3 * b;
    if ((p[1] > y) != (q[1] > y) && x < (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1]) + p[0]) inside = !inside;
  }
  return inside;
}

bool shape_contains(const Shape *shape, const UnitCell *unit, int dimensions, const double p[3], double tolerance)
{
  if (shape->box) {
    double low[3], high[3];
    box_corners(shape->box, unit, low, high);
    for (int k = 0; k < dimensions; ++k)
      if (p[k] < low[k] - tolerance || p[k] > high[k] + tolerance) return false;
    return true;
  }
  if (shape->sphere) {
    double distance = 0;
    for (int k = 0; k < dimensions; ++k) {
      double d = p[k] - shape->sphere->centre[k];
      distance += d * d;
    }
    return sqrt(distance) <= shape->sphere->radius + tolerance;
  }
  if (shape->cylinder) {
    const Cylinder *c = shape->cylinder;
    double axis = 0, along = 0, square = 0;
    for (int k = 0; k < dimensions; ++k) {
      double a = c->to[k] - c->from[k], d = p[k] - c->from[k];
      axis += a * a;
      along += a * d;
      square += d * d;
    }
    double length = sqrt(axis), x = along / length;
    return x >= -tolerance && x <= length + tolerance && sqrt(fmax(0, square - x * x)) <= c->radius + tolerance;
  }
  if (shape->polygon) {
    const Polygon *polygon = shape->polygon;
    bool level = dimensions < 3 || (p[2] >= polygon->bottom - tolerance && p[2] <= polygon->top + tolerance);
    return level && polygon_contains(polygon->corners.values, polygon->corners.count, p[0], p[1]);
  }
  for (int k = 0; k < shape->together.count; ++k)
    if (shape_contains(shape->together.items[k], unit, dimensions, p, tolerance)) return true;
  if (!shape->difference.count || !shape_contains(shape->difference.items[0], unit, dimensions, p, tolerance))
    return false;
  for (int k = 1; k < shape->difference.count; ++k)
    if (shape_contains(shape->difference.items[k], unit, dimensions, p, -tolerance)) return false;
  return true;
}

bool shape_counts_particles(const Shape *shape)
{
  if (shape->box) return shape->box->particles[0] >= 0;
  for (int k = 0; k < shape->together.count; ++k)
    if (shape_counts_particles(shape->together.items[k])) return true;
  for (int k = 0; k < shape->difference.count; ++k)
    if (shape_counts_particles(shape->difference.items[k])) return true;
  return false;
}

void shape_bounds(const Shape *shape, const UnitCell *unit, double low[3], double high[3])
{
  for (int k = 0; k < 3; ++k) {
    low[k] = INFINITY;
    high[k] = -INFINITY;
  }
  if (shape->box)
    box_corners(shape->box, unit, low, high);
  else if (shape->sphere) {
    for (int k = 0; k < 3; ++k) {
      low[k] = shape->sphere->centre[k] - shape->sphere->radius;
      high[k] = shape->sphere->centre[k] + shape->sphere->radius;
    }
  } else if (shape->cylinder) {
    const Cylinder *c = shape->cylinder;
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (c->to[k] - c->from[k]) * (c->to[k] - c->from[k]);
    for (int k = 0; k < 3; ++k) {
      double a = c->to[k] - c->from[k], reach = c->radius * sqrt(fmax(0, 1 - a * a / square));
      low[k] = fmin(c->from[k], c->to[k]) - reach;
      high[k] = fmax(c->from[k], c->to[k]) + reach;
    }
  } else if (shape->polygon) {
    const Polygon *polygon = shape->polygon;
    for (int n = 0; n < polygon->corners.count; ++n)
      for (int k = 0; k < 2; ++k) {
        low[k] = fmin(low[k], polygon->corners.values[3 * n + k]);
        high[k] = fmax(high[k], polygon->corners.values[3 * n + k]);
      }
    low[2] = polygon->bottom;
    high[2] = polygon->top;
  } else if (shape->difference.count)
    shape_bounds(shape->difference.items[0], unit, low, high);
  for (int n = 0; n < shape->together.count; ++n) {
    double a[3], b[3];
    shape_bounds(shape->together.items[n], unit, a, b);
    for (int k = 0; k < 3; ++k) {
      low[k] = fmin(low[k], a[k]);
      high[k] = fmax(high[k], b[k]);
    }
  }
}
