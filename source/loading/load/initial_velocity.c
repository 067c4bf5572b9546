#include "loading/load.h"

#include <math.h>

typedef struct InitialVelocitySpec {
  SectionHead head;
  double translation[3], rotation[3], about[3];
} InitialVelocitySpec;

static void check_initial_velocity(const DeckReader *reader, void *section)
{
  const InitialVelocitySpec *s = section;
  if (isnan(s->translation[0]) && isnan(s->rotation[0]))
    node_error(reader->document, s->head.node, reader->error,
               "initial velocity: say how: 'translation', 'rotation' or both");
}

static const Field initial_velocity_fields[] = {
    {.key = "translation",
     .kind = FIELD_POINT,
     .offset = offsetof(InitialVelocitySpec, translation),
     .dimension = "velocity",
     .standard = "",
     .meaning = "of all these particles"},
    {.key = "rotation",
     .kind = FIELD_POINT,
     .offset = offsetof(InitialVelocitySpec, rotation),
     .dimension = "angular velocity",
     .standard = "",
     .meaning = "angular velocity about the three axes, anticlockwise; in the plane [0, 0, w]"},
    {.key = "about",
     .kind = FIELD_POINT,
     .offset = offsetof(InitialVelocitySpec, about),
     .dimension = "length",
     .standard = "",
     .meaning = "a point that the axis goes through; when absent the centre of mass of these particles"},
};

const Section initial_velocity_load_section = {
    .name = "initial velocity",
    .about = "The motion of a rigid body, which particles have at first. It takes the place of what they had.",
    .size = sizeof(InitialVelocitySpec),
    FIELDS(initial_velocity_fields),
    .check = check_initial_velocity};

static double or_none(double value)
{
  return isnan(value) ? 0 : value;
}

static int create(Load *load, const LoadMaking *making)
{
  const InitialVelocitySpec *s = load->value->section;
  const int dimensions = making->body->dimensions;
  for (int k = 0; k < 3; ++k)
    if ((dimensions < 3 && k >= dimensions && or_none(s->translation[k]) != 0) ||
        (dimensions < 3 && (k < 2 || dimensions == 1) && or_none(s->rotation[k]) != 0))
      return node_error(making->reader->document, load->node, making->reader->error,
                        "initial velocity: the body is %s, this motion leads out of it",
                        dimensions == 2 ? "plane and turns about z only" : "a bar along x");
  return BRECCIA_OK;
}

typedef struct Motion {
  double translation[3], rotation[3], centre[3];
} Motion;

static Motion motion_of(const Load *load, const Particles *p)
{
  const InitialVelocitySpec *s = load->value->section;
  Motion m;
  double moment[3] = {0}, mass = 0;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t i = load->selection.places[n];
    for (int k = 0; k < 3; ++k)
      moment[k] += p->density[i] * p->volume[i] * (p->position[k][i] + p->displacement.row[k][i]);
    mass += p->density[i] * p->volume[i];
  }
  for (int k = 0; k < 3; ++k) {
    m.translation[k] = or_none(s->translation[k]);
    m.rotation[k] = or_none(s->rotation[k]);
    m.centre[k] = isnan(s->about[0]) ? moment[k] / mass : s->about[k];
  }
  return m;
}

static void velocity_at(const Motion *m, const Particles *p, int32_t i, double velocity[3])
{
  double arm[3];
  for (int k = 0; k < 3; ++k) arm[k] = p->position[k][i] + p->displacement.row[k][i] - m->centre[k];
  for (int k = 0; k < 3; ++k)
    velocity[k] =
        m->translation[k] + m->rotation[(k + 1) % 3] * arm[(k + 2) % 3] - m->rotation[(k + 2) % 3] * arm[(k + 1) % 3];
}

static bool begin(Load *load, Particles *p)
{
  const Motion m = motion_of(load, p);
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t i = load->selection.places[n];
    double v[3];
    velocity_at(&m, p, i, v);
    for (int k = 0; k < 3; ++k) p->velocity.row[k][i] = v[k];
    for (int k = p->space.rotation; k < p->space.rows && particles_turn(p, i); ++k)
      p->velocity.row[k][i] = m.rotation[p->space.row[k].axis];
  }
  return true;
}

static LoadWords tell(const Load *load, const Particles *p)
{
  const Motion m = motion_of(load, p);
  double kinetic = 0;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t i = load->selection.places[n];
    double v[3];
    velocity_at(&m, p, i, v);
    kinetic += 0.5 * p->density[i] * p->volume[i] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3 && particles_turn(p, i); ++k)
      kinetic += 0.5 * p->rotary[i] * p->volume[i] * m.rotation[k] * m.rotation[k];
  }
  return (LoadWords){
      .words = "its particles begin with a kinetic energy of", .value = kinetic, .dimension = "energy", .unit = "J"};
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  const InitialVelocitySpec *s = value->section;
  *dimension = isnan(s->translation[0]) ? "angular velocity" : "velocity";
  return "initial velocity";
}

static double magnitude(const LoadValue *value)
{
  const InitialVelocitySpec *s = value->section;
  const double *given = isnan(s->translation[0]) ? s->rotation : s->translation;
  return sqrt(given[0] * given[0] + given[1] * given[1] + given[2] * given[2]);
}

const LoadType initial_velocity_load = {.everywhere = true,
                                        .timeless = true,
                                        .create = create,
                                        .begin = begin,
                                        .tell = tell,
                                        .kind = kind,
                                        .magnitude = magnitude};
