/* Areas of loaded faces that do not fit the particles on which the load acts.
 *
 * The volume V of the particles of a load is about their area times their depth. The depth is the distance of their
 * outermost centres along the normal of the face, and up to one spacing more: a whole spacing on lattices, about half
 * of one for scattered particles. The normal is that of the face that the deck names, the direction from the axis of a
 * round surface, or the axis along which the particles are thinnest by far. If there is no such axis, the areas of
 * their faces lie between V over their greatest depth and 1.5 V over a spacing. */
#include "model/plausibility_parts.h"

#include "loading/load/radial_pressure.h"

#include <math.h>
#include <string.h>

static const double area_factor = 1.5; /* smallest reported ratio of an area to that of the particles, or its inverse */

/** Range of areas of the faces that the particles of a load may represent. */
typedef struct AreaRange {
  double low, high;
} AreaRange;

/** Returns the largest spacing among the particles of a load [length]. */
static double area_spacing(const Domain *d, const Load *load)
{
  double spacing = 0;
  for (int64_t n = 0; n < load->selection.count; ++n)
    spacing = fmax(spacing, d->body.lattices[d->particles->block[load->selection.places[n] / SLICE]].spacing);
  return spacing;
}

/** Returns the distance of the outermost particles of a load along an axis [length]. */
static double area_extent(const Particles *p, const Load *load, int axis)
{
  double low = INFINITY, high = -INFINITY;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    low = fmin(low, p->position[axis][load->selection.places[n]]);
    high = fmax(high, p->position[axis][load->selection.places[n]]);
  }
  return high - low;
}

/** Returns the range of areas of particles by their volume and the distance of their outermost centres along the
 *  normal. */
static AreaRange area_across(double volume, double extent, double spacing)
{
  const double least = 0.7; /* [spacings] depth of one layer of the densest lattices or of scattered particles */
  return (AreaRange){volume / (extent + spacing), volume / fmax(extent, least * spacing)};
}

/** Returns the range of areas of the particles of a load on a face whose normal is unknown. */
static AreaRange area_of_patch(const Domain *d, const Load *load, double spacing)
{
  const double flat = 0.5, steep = 1.5; /* depth of a flat patch over its next extent; area of steps over a layer's */
  double extent[3] = {INFINITY, INFINITY, INFINITY};
  for (int k = 0; k < d->body.dimensions; ++k) { /* in ascending order */
    double next = area_extent(d->particles, load, k);
    for (int m = 0; m < 3; ++m)
      if (next < extent[m]) {
        const double larger = extent[m];
        extent[m] = next;
        next = larger;
      }
  }
  if (extent[0] + spacing <= flat * (extent[1] + spacing) || load->selection.count == 1)
    return area_across(load->volume, extent[0], spacing);
  return (AreaRange){area_across(load->volume, extent[d->body.dimensions - 1], spacing).low,
                     steep * load->volume / spacing};
}

/** Returns the range of areas of the particles of a load on a round surface. */
static AreaRange area_of_round(const Domain *d, const Load *load, double spacing)
{
  double low = INFINITY, high = -INFINITY;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    double outwards[3], distance;
    radial_pressure_outwards(load->value->section, d->particles, load->selection.places[n], outwards, &distance);
    low = fmin(low, distance);
    high = fmax(high, distance);
  }
  return area_across(load->volume, high - low, spacing);
}

/** Warns of an area outside a range. */
static void area_say(breccia_model *model, const Node *node, double area, AreaRange of)
{
  const double there = area < of.low ? of.low : of.high;
  char unit[64];
  units_name(model->units, dimension_find("area"), unit, sizeof unit);
  plausibility_say(
      model, node,
      "area: %.4g %s, but the volumes of the particles on which the load acts make a face of %.4g %s, %s by a "
      "factor of %.3g; give the area of the face, or select the particles behind all of it",
      area, unit, there, unit, area < there ? "larger" : "smaller", area < there ? there / area : area / there);
}

void plausibility_warn_of_area(breccia_model *model, const Load *load)
{
  const Domain *d = &model->domain;
  const bool round = load->type == &radial_pressure_load;
  const RadialPressureSpec *radial = round ? load->value->section : NULL;
  const double area = round ? radial->area : load->spec->area;
  if (isnan(area) || !load->selection.count || d->body.dimensions < 2) return;
  const SelectionSpec *on = selection_spec(&model->spec->selections, &load->spec->on);
  const double spacing = area_spacing(d, load);
  const AreaRange of = round ? area_of_round(d, load, spacing)
                       : on && on->face >= 0
                           ? area_across(load->volume, area_extent(d->particles, load, selection_axis(on)), spacing)
                           : area_of_patch(d, load, spacing);
  const Node *node = round ? section_node(radial, "area") : section_node(load->spec, "area");
  if (area * area_factor < of.low || area > area_factor * of.high) area_say(model, node, area, of);
}
