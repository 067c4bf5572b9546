#include "loading/load/radial_pressure.h"

#include "base/team.h"
#include "loading/load/load_parts.h"
#include <math.h>

static void check_radial_pressure(const DeckReader *reader, void *section)
{
  const RadialPressureSpec *s = section;
  if (s->axis[0] == 0 && s->axis[1] == 0 && s->axis[2] == 0)
    node_error(reader->document, section_node(section, "axis"), reader->error, "axis: must not be zero");
}

static const Field radial_pressure_fields[] = {
    {.key = "pressure",
     .kind = FIELD_NUMBER,
     .offset = offsetof(RadialPressureSpec, pressure),
     .dimension = "stress",
     .meaning = "away from the axis, as in a hole; below zero towards it, as around a column"},
    {.key = "area",
     .kind = FIELD_NUMBER,
     .offset = offsetof(RadialPressureSpec, area),
     .dimension = "area",
     .range = "(0, inf)",
     .meaning = "of the round surface, of which the particles take shares by volume"},
    {.key = "centre",
     .kind = FIELD_POINT,
     .offset = offsetof(RadialPressureSpec, centre),
     .dimension = "length",
     .meaning = "a point of the axis"},
    {.key = "axis",
     .kind = FIELD_POINT,
     .offset = offsetof(RadialPressureSpec, axis),
     .dimension = "1",
     .standard = "",
     .meaning = "its direction, of any length; z when absent"},
};

const Section radial_pressure_load_section = {.name = "radial pressure",
                                              .about = "Pressure on a round surface, like that of a pipe, a tunnel or "
                                                       "a column, whose direction stays as the body moves.",
                                              .size = sizeof(RadialPressureSpec),
                                              FIELDS(radial_pressure_fields),
                                              .check = check_radial_pressure};

bool radial_pressure_outwards(const RadialPressureSpec *s, const Particles *p, int32_t place, double n[3],
                              double *distance)
{
  const double along[3] = {isnan(s->axis[0]) ? 0 : s->axis[0], isnan(s->axis[1]) ? 0 : s->axis[1],
                           isnan(s->axis[2]) ? isnan(s->axis[0]) : s->axis[2]};
  double dot = 0, square = 0, length = 0;
  for (int k = 0; k < 3; ++k) {
    n[k] = p->position[k][place] - (isnan(s->centre[k]) ? 0 : s->centre[k]);
    dot += n[k] * along[k];
    square += along[k] * along[k];
  }
  for (int k = 0; k < 3; ++k) {
    n[k] -= dot / square * along[k];
    length += n[k] * n[k];
  }
  length = sqrt(length);
  *distance = length;
  for (int k = 0; k < 3; ++k) n[k] /= length;
  return length > 0;
}

static int create(Load *load, const LoadMaking *making)
{
  const RadialPressureSpec *s = load->value->section;
  const Particles *p = &making->body->particles;
  double n[3], distance;
  if (making->body->dimensions == 1 ||
      (making->body->dimensions == 2 && !isnan(s->axis[0]) && (s->axis[0] != 0 || s->axis[1] != 0)))
    return node_error(making->reader->document, load->node, making->reader->error, "radial pressure: the body is %s",
                      making->body->dimensions == 1 ? "a bar along x" : "plane; leave out 'axis', it is z");
  for (int64_t k = 0; k < load->selection.count; ++k)
    if (!radial_pressure_outwards(s, p, load->selection.places[k], n, &distance))
      return node_error(making->reader->document, load->node, making->reader->error,
                        "radial pressure: a particle stands on the axis; select those next to the round surface");
  return BRECCIA_OK;
}

static void force(const Load *load, Particles *p, double factor)
{
  const RadialPressureSpec *s = load->value->section;
  const double per_volume = factor * s->pressure * s->area / load->volume;
  TEAM_FOR (k, load->selection.count) {
    const int32_t place = load->selection.places[k];
    double n[3], distance;
    radial_pressure_outwards(s, p, place, n, &distance);
    for (int c = 0; c < 3; ++c) p->external.row[c][place] += per_volume * n[c];
  }
}

static double magnitude(const LoadValue *value)
{
  return ((const RadialPressureSpec *)value->section)->pressure;
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  (void)value;
  *dimension = "stress";
  return "radial pressure";
}

static LoadWords tell(const Load *load, const Particles *p)
{
  (void)p;
  const RadialPressureSpec *s = load->value->section;
  return load_force_in_all(fabs(s->pressure) * s->area, (const double[3]){0});
}

const LoadType radial_pressure_load = {
    .create = create, .force = force, .tell = tell, .magnitude = magnitude, .kind = kind};
