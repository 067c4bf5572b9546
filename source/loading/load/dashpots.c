/* Dashpots on a face, through which waves leave the body (Lysmer and Kuhlemeyer 1969, J. Eng. Mech. Div. ASCE 95(EM4), 859): tractions against velocities,
 * rho c_p across the face and rho c_s along it, absorb plane waves that meet it squarely. With the motion v that the ground beyond would
 * have at an outcrop, twice its incident wave, the traction is rho c (v - velocity) (Joyner and Chen 1975, Bull. Seism. Soc. Am. 65, 1315). */
#include "loading/load/face.h"
#include "loading/load/load_parts.h"

#include "base/team.h"
#include "constitutive/material.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct DashpotsSpec {
  SectionHead head;
  double density, shear_speed, pressure_speed, velocity[3], acceleration[3];
} DashpotsSpec;

static void check_dashpots(const DeckReader *reader, void *section)
{
  const DashpotsSpec *s = section;
  if (!isnan(s->velocity[0]) && !isnan(s->acceleration[0]))
    node_error(reader->document, section_node(section, "outcrop acceleration"), reader->error,
               "outcrop acceleration: 'outcrop velocity' says the motion already; leave one of them out");
}

static const Field dashpots_fields[] = {
    {.key = "density",
     .kind = FIELD_NUMBER,
     .offset = offsetof(DashpotsSpec, density),
     .dimension = "density",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "of the ground beyond the face; that of the particles when absent"},
    {.key = "shear wave speed",
     .kind = FIELD_NUMBER,
     .offset = offsetof(DashpotsSpec, shear_speed),
     .dimension = "velocity",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "of the ground beyond; sqrt(G / density) of the particles' material when absent. 0: nothing acts along "
                "the face"},
    {.key = "compression wave speed",
     .kind = FIELD_NUMBER,
     .offset = offsetof(DashpotsSpec, pressure_speed),
     .dimension = "velocity",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "of the ground beyond; of the particles' material when absent: sqrt((K + 4/3 G) / density), of a bar "
                "sqrt(E / density). 0: nothing acts across the face"},
    {.key = "outcrop velocity",
     .kind = FIELD_POINT,
     .offset = offsetof(DashpotsSpec, velocity),
     .dimension = "velocity",
     .standard = "",
     .meaning = "times 'history': what the ground beyond would do at an outcrop, where nothing lies on it, twice the "
                "wave that comes up; the ground is still when absent"},
    {.key = "outcrop acceleration",
     .kind = FIELD_POINT,
     .offset = offsetof(DashpotsSpec, acceleration),
     .dimension = "acceleration",
     .standard = "",
     .meaning = "the same by its acceleration, from rest; its history is integrated over time"},
};

const Section dashpots_load_section = {
    .name = "dashpots",
    .about =
        "Dashpots of Lysmer and Kuhlemeyer, which let waves pass through a face into ground that goes on beyond it: "
        "all of a plane wave that meets the face squarely. One layer of particles serves best. They hold nothing at "
        "rest: in 'static' stages they do nothing; a load 'reaction of' goes on with what held the body then.",
    .size = sizeof(DashpotsSpec),
    FIELDS(dashpots_fields),
    .check = check_dashpots};

typedef struct Dashpots {
  Face face;
  double *across, *along; /* [particles] force per volume over velocity */
  double *drag[3];        /* [particles] force per volume against velocities at the end of the last step */
  double *trial[3];       /* the same as it was found last */
  double outcrop[3];      /* its velocity then */
  double taken;           /* energy */
} Dashpots;

/** Whether the ground beyond moves, and what multiplies its velocity. */
static bool is_moved(const DashpotsSpec *s)
{
  return !isnan(s->velocity[0]) || !isnan(s->acceleration[0]);
}

static int find_rates(Dashpots *own, const Load *load, const LoadMaking *making)
{
  const DashpotsSpec *spec = load->value->section;
  const Particles *p = &making->body->particles;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int64_t slice = load->selection.places[n] / SLICE;
    const Material *m = &making->materials[making->material[slice]];
    const double stiffness = making->body->dimensions == 1 ? material_young(m) : m->bulk + 4 * m->shear / 3;
    const double density = isnan(spec->density) ? p->density[load->selection.places[n]] : spec->density;
    const double shear = isnan(spec->shear_speed) ? sqrt(m->shear / m->density) : spec->shear_speed;
    const double pressure = isnan(spec->pressure_speed) ? sqrt(stiffness / m->density) : spec->pressure_speed;
    own->across[n] = density * pressure * own->face.per_depth[slice];
    own->along[n] = density * shear * own->face.per_depth[slice];
  }
  return BRECCIA_OK;
}

static int create(Load *load, const LoadMaking *making)
{
  const DeckReader *reader = making->reader;
  Error *error = reader->error;
  if (load->spec->history && !is_moved(load->value->section))
    return node_error(
        reader->document, section_node(load->spec, "history"), error,
        "history: of dashpots only 'outcrop velocity' and 'outcrop acceleration' vary in time; give one of "
        "them, or leave 'history' out");
  Dashpots *own = load->own = memory_zeroed(1, sizeof *own, "dashpots", error);
  if (!own) return BRECCIA_FAILURE;
  const int status = face_create(&own->face, load, making);
  if (status) return status;
  const size_t count = (size_t)load->selection.count;
  bool failed = !(load->held = memory_zeroed(count, 1, "dashpots", error));
  failed |= !(own->across = memory_zeroed(count, sizeof(double), "dashpots", error));
  failed |= !(own->along = memory_zeroed(count, sizeof(double), "dashpots", error));
  for (int k = 0; k < 3; ++k) {
    failed |= !(own->drag[k] = memory_zeroed(count, sizeof(double), "dashpots", error));
    failed |= !(own->trial[k] = memory_zeroed(count, sizeof(double), "dashpots", error));
  }
  return failed ? BRECCIA_FAILURE : find_rates(own, load, making);
}

static void destroy(Load *load)
{
  Dashpots *own = load->own;
  face_destroy(&own->face);
  free(own->across);
  free(own->along);
  for (int k = 0; k < 3; ++k) {
    free(own->drag[k]);
    free(own->trial[k]);
  }
  free(own);
}

/** Velocity of the outcrop at a time since the load began. By one thread. */
static void find_outcrop(Load *load, double time)
{
  const DashpotsSpec *spec = load->value->section;
  Dashpots *own = load->own;
  const bool accelerates = !isnan(spec->acceleration[0]);
  const double *value = accelerates ? spec->acceleration : spec->velocity;
  const double factor = !is_moved(spec) ? 0
                        : accelerates   ? history_integral(&load->history, 1, 1, time)
                                        : history_factor(&load->history, time);
  for (int k = 0; k < 3; ++k) own->outcrop[k] = factor == 0 ? 0 : factor * value[k];
}

static double rate_of(const Dashpots *own, int k, int64_t n)
{
  return k == own->face.axis ? own->across[n] : own->along[n];
}

/** Velocities that lag by half a step are those at its end once all forces have acted for that time, those of dashpots at the end too:
 *  v' = (v + lag a) / (1 + lag (c + rate / density)). So dashpots do not shorten the stable step. */
static void brake(Load *load, Particles *p, const LoadMotion *motion, double time)
{
  Dashpots *own = load->own;
  const double lag = motion->lag;
  TEAM_SINGLE find_outcrop(load, time);
  TEAM_FOR (n, load->selection.count) {
    const int32_t i = load->selection.places[n];
    for (int k = 0; k < 3; ++k) {
      const double rate = rate_of(own, k, n), density = p->density[i];
      const double given = rate * own->outcrop[k], force = p->internal.row[k][i] + p->external.row[k][i] + given;
      double v = motion->velocity[k][i];
      if (!(load->held[n] & 1 << k)) v = (v + lag * force / density) / (1 + lag * (motion->damping + rate / density));
      own->trial[k][n] = -rate * v;
      p->external.row[k][i] += given - rate * v;
    }
  }
}

static void settle(Load *load, const Particles *p, double *const moved[3], double factor)
{
  Dashpots *own = load->own;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t i = load->selection.places[n];
    for (int k = 0; k < 3; ++k) {
      own->taken -= 0.5 * (own->drag[k][n] + own->trial[k][n]) * factor * moved[k][i] * p->volume[i];
      own->drag[k][n] = own->trial[k][n];
    }
  }
}

/** Adds what stands at the end of the last step (settle), and what the motion of the outcrop asks for then. */
static void exerts(Load *load, const Particles *p, double time, double sum[3])
{
  Dashpots *own = load->own;
  find_outcrop(load, time);
  for (int64_t n = 0; n < load->selection.count; ++n)
    for (int k = 0; k < 3; ++k)
      sum[k] += p->volume[load->selection.places[n]] * (rate_of(own, k, n) * own->outcrop[k] + own->drag[k][n]);
}

static void add_change(const Load *load, const Particles *p, double *const v[3], double *const change[3])
{
  (void)p;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t i = load->selection.places[n];
    for (int k = 0; k < 3; ++k) change[k][i] -= load->motion.rate * rate_of(load->own, k, n) * v[k][i];
  }
}

static int64_t point_count(const Load *load)
{
  return 3 * load->selection.count;
}

/** The displacement of one particle times its volume as the strain. */
static int find_point(const Load *load, const Particles *p, int64_t number, Operator *point, Error *error)
{
  const int32_t i = load->selection.places[number / 3];
  const int axis = (int)(number % 3);
  operator_clear(point);
  point->components = 1;
  point->volume = 1;
  point->tangent[0] = load->motion.rate * rate_of(load->own, axis, number / 3) / p->volume[i];
  OperatorPlace *end = operator_add(point, i, error);
  for (int k = 0; k < 3 && end; ++k) end->g[k] = k == axis ? p->volume[i] : 0;
  return end ? BRECCIA_OK : BRECCIA_FAILURE;
}

static double dissipated(const Load *load)
{
  return ((const Dashpots *)load->own)->taken;
}

static bool begin(Load *load, Particles *p)
{
  (void)p;
  Dashpots *own = load->own;
  for (int64_t n = 0; n < load->selection.count; ++n)
    for (int k = 0; k < 3; ++k) own->drag[k][n] = own->trial[k][n] = 0;
  return false;
}

static void state(Load *load, const char *name, StateList *list)
{
  Dashpots *own = load->own;
  static const char *const parts[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    state_add(list,
              &(StateRow){.unit = "force per volume",
                          .kind = STATE_NUMBERS,
                          .role = STATE_TRIED,
                          .count = load->selection.count,
                          .values = own->drag[k]},
              name, parts[k]);
  char taken[64];
  snprintf(taken, sizeof taken, "%s taken", name);
  state_add_number(list, taken, "energy", STATE_TRIED, &own->taken);
}

static const double *vector(const LoadValue *value)
{
  const DashpotsSpec *spec = value->section;
  return isnan(spec->velocity[0]) ? spec->acceleration : spec->velocity;
}

static double magnitude(const LoadValue *value)
{
  const double *v = vector(value);
  return isnan(v[0]) ? 0 : sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  const DashpotsSpec *spec = value->section;
  *dimension = isnan(spec->acceleration[0]) ? "velocity" : "acceleration";
  return !is_moved(spec) ? "dashpots" : isnan(spec->acceleration[0]) ? "outcrop velocity" : "outcrop acceleration";
}

static LoadWords tell(const Load *load, const Particles *p)
{
  return (LoadWords){.words = "waves leave through",
                     .value = face_area(&((const Dashpots *)load->own)->face, load, p),
                     .dimension = "area",
                     .unit = "m2"};
}

const LoadType dashpots_load = {.create = create,
                                .destroy = destroy,
                                .vector = vector,
                                .begin = begin,
                                .brake = brake,
                                .settle = settle,
                                .exerts = exerts,
                                .change = add_change,
                                .point_count = point_count,
                                .point = find_point,
                                .dissipated = dissipated,
                                .tell = tell,
                                .state = state,
                                .kind = kind,
                                .magnitude = magnitude};
