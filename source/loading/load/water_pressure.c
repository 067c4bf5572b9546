#include "loading/load/water_pressure.h"

#include "loading/load/face.h"
#include "loading/load/load_parts.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>

static const Field water_pressure_fields[] = {
    {.key = "surface",
     .kind = FIELD_NUMBER,
     .offset = offsetof(WaterPressureSpec, surface),
     .dimension = "length",
     .meaning = "height of the surface of the water, along z in space and y in the plane; nothing acts above"},
    {.key = "unit weight",
     .kind = FIELD_NUMBER,
     .offset = offsetof(WaterPressureSpec, unit_weight),
     .dimension = "force per volume",
     .standard = "9.81 kN/m3",
     .range = "(0, inf)",
     .meaning = "of the water, or of what else stands there"},
};

const Section water_pressure_load_section = {
    .name = "water pressure",
    .about =
        "Pressure of water at rest on a face, inwards: its unit weight times the depth of each particle's centre "
        "as the body stands at first. It is spread as 'spread' says, and its force in all is the sum over the face.",
    .size = sizeof(WaterPressureSpec),
    FIELDS(water_pressure_fields)};

typedef struct WaterPressure {
  Face face;
  double *pressure; /* [particles] at factor 1 */
} WaterPressure;

static int create(Load *load, const LoadMaking *making)
{
  const WaterPressureSpec *s = load->value->section;
  const DeckReader *reader = making->reader;
  const Particles *p = &making->body->particles;
  if (making->body->dimensions == 1)
    return node_error(reader->document, load->node, reader->error, "water pressure: the body is a bar along x");
  WaterPressure *own = load->own = memory_zeroed(1, sizeof *own, "water pressure", reader->error);
  if (!own) return BRECCIA_FAILURE;
  int status = face_create(&own->face, load, making);
  if (!status) status = face_spread(&own->face, load, making);
  if (status) return status;
  const Face *face = &own->face;
  const int64_t count = face->scattered ? face->count : load->selection.count;
  own->pressure = memory_zeroed((size_t)count, sizeof(double), "water pressure", reader->error);
  if (!own->pressure) return BRECCIA_FAILURE;
  const int up = making->body->dimensions - 1;
  double deepest = 0;
  for (int64_t n = 0; n < count; ++n) {
    const int32_t place = face->scattered ? face->place[n] : load->selection.places[n];
    const double height = face->scattered && face->axis == up ? face->plane : p->position[up][place];
    own->pressure[n] = s->unit_weight * fmax(0, s->surface - height);
    deepest = fmax(deepest, own->pressure[n]);
  }
  if (deepest == 0)
    return node_error(reader->document, section_node(s, "surface"), reader->error,
                      "surface: all particles of the face stand above it");
  return face->scattered ? BRECCIA_OK : face_balance(&own->face, load, p, own->pressure, reader->error);
}

static void destroy(Load *load)
{
  WaterPressure *own = load->own;
  face_destroy(&own->face);
  free(own->pressure);
  free(own);
}

static void force(const Load *load, Particles *p, double factor)
{
  const WaterPressure *own = load->own;
  const Face *face = &own->face;
  double *external = p->external.row[face->axis];
  TEAM_FOR (n, face->count)
    external[face->place[n]] -= face->outwards * factor * own->pressure[face->at[n]] * face->per_volume[n];
}

static double magnitude(const LoadValue *value)
{
  return ((const WaterPressureSpec *)value->section)->unit_weight;
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  (void)value;
  *dimension = "force per volume";
  return "water pressure";
}

static LoadWords tell(const Load *load, const Particles *p)
{
  const WaterPressure *own = load->own;
  double along[3] = {0};
  along[own->face.axis] = -own->face.outwards;
  return load_force_in_all(face_force(&own->face, load, p, own->pressure), along);
}

const LoadType water_pressure_load = {
    .create = create, .destroy = destroy, .force = force, .tell = tell, .magnitude = magnitude, .kind = kind};
