/* Elastic springs: from each particle to the ground, the stiffness shared by volume; or one between the mean displacements of two sets of
 * particles, on which it pulls like a force that is shared by volume. A spring that only presses has no force and no
 * stiffness where it would pull. */
#include "loading/load/load_parts.h"
#include "loading/one_sided.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>

typedef struct SpringSpec {
  SectionHead head;
  double stiffness, direction[3];
  Reference to;
} SpringSpec;

static void check_spring(const DeckReader *reader, void *section)
{
  const SpringSpec *s = section;
  if (s->direction[0] == 0 && s->direction[1] == 0 && s->direction[2] == 0)
    node_error(reader->document, section_node(section, "direction"), reader->error, "direction: must not be zero");
}

static const Field spring_fields[] = {
    {.key = "stiffness",
     .kind = FIELD_NUMBER,
     .offset = offsetof(SpringSpec, stiffness),
     .dimension = "force per length",
     .range = "(0, inf)",
     .meaning = "of all these particles together, shared by volume"},
    {.key = "direction",
     .kind = FIELD_POINT,
     .offset = offsetof(SpringSpec, direction),
     .dimension = "1",
     .standard = "",
     .meaning = "in which it acts, of any length. When absent: in all directions alike to the ground; to other "
                "particles along the line between the two centres"},
    {.key = "to",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(SpringSpec, to),
     .standard = "",
     .meaning = "particles at the other end, which move as their mean; the ground when absent",
     .section = &selection_section},
};

const Section spring_load_section = {
    .name = "spring",
    .about = "Springs without force when the load begins; force = stiffness times change of displacement.",
    .size = sizeof(SpringSpec),
    FIELDS(spring_fields),
    .check = check_spring};

typedef struct Spring {
  double stiffness, direction[3];
  bool directed;
  double presses;      /* 1 or -1: the spring only presses, along its direction or against it; 0: it also pulls */
  double other_volume; /* of the other end */
  double *from[3]; /* to the ground: [particles] displacements when it began; between two ends: [1] their difference */
  double pull[3];  /* between two ends: the force on the first, as of the last step */
} Spring;

static bool joins(const Load *load)
{
  return load->other.count > 0;
}

/** Mean of a vector over particles, by volume. */
static double mean(const Particles *p, const Selection *selection, double volume, double *const vector)
{
  double sum = 0;
  for (int64_t n = 0; n < selection->count; ++n) sum += p->volume[selection->places[n]] * vector[selection->places[n]];
  return sum / volume;
}

static int aim(Spring *spring, const Load *load, const LoadMaking *making)
{
  const SpringSpec *spec = load->value->section;
  const Particles *p = &making->body->particles;
  double *d = spring->direction;
  spring->directed = !isnan(spec->direction[0]) || joins(load);
  for (int k = 0; k < 3 && spring->directed; ++k)
    d[k] = !isnan(spec->direction[0]) ? spec->direction[k]
                                      : mean(p, &load->other, spring->other_volume, p->position[k]) -
                                            mean(p, &load->selection, load->volume, p->position[k]);
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  if (spring->directed && length < 1e-9 * making->body->largest_spacing)
    return node_error(making->reader->document, load->node, making->reader->error,
                      "spring: its ends have one centre; say its 'direction'");
  for (int k = 0; k < 3 && spring->directed; ++k) d[k] /= length;
  return BRECCIA_OK;
}

/** Finds the side from which a spring that only presses pushes; a spring between two ends pushes the ends apart. */
static int spring_find_side(Spring *spring, const Load *load, const LoadMaking *making)
{
  const Particles *p = &making->body->particles;
  const Node *node = section_node(load->spec, "only presses");
  double apart = 0;
  if (!load->spec->only_presses) return BRECCIA_OK;
  if (!spring->directed)
    return node_error(making->reader->document, node, making->reader->error,
                      "only presses: a spring that acts in all directions alike has no side from which it pushes; give "
                      "its 'direction'");
  for (int k = 0; k < 3 && joins(load); ++k)
    apart += spring->direction[k] * (mean(p, &load->other, spring->other_volume, p->position[k]) -
                                     mean(p, &load->selection, load->volume, p->position[k]));
  if (joins(load))
    spring->presses = apart > 0 ? -1 : apart < 0 ? 1 : 0;
  else
    spring->presses = one_sided_find_side(load, making, spring->direction);
  if (spring->presses != 0) return BRECCIA_OK;
  return node_error(making->reader->document, node, making->reader->error,
                    joins(load)
                        ? "only presses: the ends of the spring are at one position along its direction, so that the "
                          "side from which it pushes is unknown; give another 'direction'"
                        : "only presses: the body lies on both sides of these particles along the spring; "
                          "select only particles at the face that it touches");
}

static int create(Load *load, const LoadMaking *making)
{
  const SpringSpec *spec = load->value->section;
  Error *error = making->reader->error;
  Spring *spring = load->own = memory_zeroed(1, sizeof *spring, "spring", error);
  if (!spring) return BRECCIA_FAILURE;
  spring->stiffness = spec->stiffness;
  if (spec->to.node) {
    const int status = selection_create(&load->other, making->body, making->reader, making->selections, &spec->to);
    if (status) return status;
  }
  for (int64_t n = 0; n < load->other.count; ++n)
    spring->other_volume += making->body->particles.volume[load->other.places[n]];
  const size_t count = joins(load) ? 1 : (size_t)load->selection.count;
  for (int k = 0; k < 3; ++k)
    if (!(spring->from[k] = memory_zeroed(count, sizeof(double), "spring", error))) return BRECCIA_FAILURE;
  const int status = aim(spring, load, making);
  return status ? status : spring_find_side(spring, load, making);
}

static void destroy(Load *load)
{
  Spring *spring = load->own;
  for (int k = 0; k < 3; ++k) free(spring->from[k]);
  free(spring);
}

/** Projects a change of displacements on the spring's direction, if there is one. @return size along it, or 0 */
static double project(const Spring *spring, double change[3])
{
  if (!spring->directed) return 0;
  double along = 0;
  for (int k = 0; k < 3; ++k) along += change[k] * spring->direction[k];
  for (int k = 0; k < 3; ++k) change[k] = along * spring->direction[k];
  return along;
}

/** Projects a change of displacements on the direction of the spring, and clears the change where the spring has let
 * go. @return false if the spring has let go */
static bool spring_keep(const Spring *spring, double change[3])
{
  const bool open = project(spring, change) * spring->presses > 0;
  for (int k = 0; k < 3 && open; ++k) change[k] = 0;
  return !open;
}

/** Computes the relative displacement of both ends. @return false if the spring has let go */
static bool change_between(const Load *load, const Particles *p, double change[3])
{
  const Spring *spring = load->own;
  for (int k = 0; k < 3; ++k)
    change[k] = mean(p, &load->selection, load->volume, p->displacement.row[k]) -
                mean(p, &load->other, spring->other_volume, p->displacement.row[k]) - spring->from[k][0];
  return spring_keep(spring, change);
}

/** Computes the displacement of the n-th particle. @return false if the spring has let go */
static bool change_at(const Load *load, const Particles *p, int64_t n, double change[3])
{
  const Spring *spring = load->own;
  for (int k = 0; k < 3; ++k) change[k] = p->displacement.row[k][load->selection.places[n]] - spring->from[k][n];
  return spring_keep(spring, change);
}

static void push_evenly(const Selection *selection, Particles *p, const double force[3], double volume)
{
  TEAM_FOR (n, selection->count)
    for (int k = 0; k < 3; ++k) p->external.row[k][selection->places[n]] += force[k] / volume;
}

static void force(const Load *load, Particles *p, double factor)
{
  (void)factor;
  Spring *spring = load->own;
  if (joins(load)) {
    TEAM_SINGLE
    {
      change_between(load, p, spring->pull);
      for (int k = 0; k < 3; ++k) spring->pull[k] *= -spring->stiffness;
    }
    push_evenly(&load->selection, p, spring->pull, load->volume);
    push_evenly(&load->other, p, spring->pull, -spring->other_volume);
    return;
  }
  TEAM_FOR (n, load->selection.count) {
    double change[3];
    change_at(load, p, n, change);
    for (int k = 0; k < 3; ++k)
      p->external.row[k][load->selection.places[n]] -= spring->stiffness / load->volume * change[k];
  }
}

/** Adds the force on the particles themselves; those at the other end take the opposite one. */
static void exerts(Load *load, const Particles *p, double time, double sum[3])
{
  (void)time;
  const Spring *spring = load->own;
  double change[3];
  for (int64_t n = 0; !joins(load) && n < load->selection.count; ++n) {
    change_at(load, p, n, change);
    const double share = p->volume[load->selection.places[n]] / load->volume;
    for (int k = 0; k < 3; ++k) sum[k] -= spring->stiffness * share * change[k];
  }
  if (!joins(load)) return;
  change_between(load, p, change);
  for (int k = 0; k < 3; ++k) sum[k] -= spring->stiffness * change[k];
}

static void add_change(const Load *load, const Particles *p, double *const v[3], double *const change[3])
{
  const Spring *spring = load->own;
  double moved[3];
  for (int64_t n = 0; !joins(load) && n < load->selection.count; ++n) {
    const int32_t i = load->selection.places[n];
    if (!change_at(load, p, n, moved)) continue;
    for (int k = 0; k < 3; ++k) moved[k] = v[k][i];
    project(spring, moved);
    for (int k = 0; k < 3; ++k) change[k][i] -= spring->stiffness / load->volume * moved[k];
  }
  if (!joins(load) || !change_between(load, p, moved)) return;
  for (int k = 0; k < 3; ++k)
    moved[k] = mean(p, &load->selection, load->volume, v[k]) - mean(p, &load->other, spring->other_volume, v[k]);
  project(spring, moved);
  for (int k = 0; k < 3; ++k) {
    for (int64_t n = 0; n < load->selection.count; ++n)
      change[k][load->selection.places[n]] -= spring->stiffness / load->volume * moved[k];
    for (int64_t n = 0; n < load->other.count; ++n)
      change[k][load->other.places[n]] += spring->stiffness / spring->other_volume * moved[k];
  }
}

/** One for each end on the ground and direction; one for each direction of a spring that joins. */
static int64_t point_count(const Load *load)
{
  const Spring *spring = load->own;
  return (joins(load) ? 1 : load->selection.count) * (spring->directed ? 1 : 3);
}

static int add_end(Operator *point, const Particles *p, int32_t place, const double direction[3], double share,
                   Error *error)
{
  OperatorPlace *end = operator_add(point, place, error);
  for (int k = 0; k < 3 && end; ++k) end->g[k] = share * p->volume[place] * direction[k];
  return end ? BRECCIA_OK : BRECCIA_FAILURE;
}

/** The elongation as the strain, the stiffness as the tangent. Of springs to the ground the elongation is that of one particle times its volume. */
static int find_point(const Load *load, const Particles *p, int64_t number, Operator *point, Error *error)
{
  const Spring *spring = load->own;
  const int axis = (int)(number % 3);
  const double axes[3] = {axis == 0, axis == 1, axis == 2}, *direction = spring->directed ? spring->direction : axes;
  const int64_t n = spring->directed ? number : number / 3;
  operator_clear(point);
  point->components = 1;
  point->volume = 1;
  double change[3];
  const bool presses = joins(load) ? change_between(load, p, change) : change_at(load, p, n, change);
  point->tangent[0] = presses ? spring->stiffness : 0;
  if (!joins(load)) {
    const int32_t place = load->selection.places[n];
    point->tangent[0] /= load->volume * p->volume[place];
    return add_end(point, p, place, direction, 1, error);
  }
  int status = BRECCIA_OK;
  for (int64_t k = 0; k < load->selection.count && !status; ++k)
    status = add_end(point, p, load->selection.places[k], direction, 1 / load->volume, error);
  for (int64_t k = 0; k < load->other.count && !status; ++k)
    status = add_end(point, p, load->other.places[k], direction, -1 / spring->other_volume, error);
  return status;
}

static bool begin(Load *load, Particles *p)
{
  Spring *spring = load->own;
  for (int k = 0; k < 3; ++k) {
    if (joins(load))
      spring->from[k][0] = mean(p, &load->selection, load->volume, p->displacement.row[k]) -
                           mean(p, &load->other, spring->other_volume, p->displacement.row[k]);
    for (int64_t n = 0; !joins(load) && n < load->selection.count; ++n)
      spring->from[k][n] = p->displacement.row[k][load->selection.places[n]];
  }
  return false;
}

static double energy(const Load *load, const Particles *p)
{
  const Spring *spring = load->own;
  double sum = 0, change[3];
  if (joins(load)) {
    change_between(load, p, change);
    return spring->stiffness * (change[0] * change[0] + change[1] * change[1] + change[2] * change[2]) / 2;
  }
  for (int64_t n = 0; n < load->selection.count; ++n) {
    change_at(load, p, n, change);
    sum +=
        p->volume[load->selection.places[n]] * (change[0] * change[0] + change[1] * change[1] + change[2] * change[2]);
  }
  return spring->stiffness / load->volume * sum / 2;
}

static double lightest(const Particles *p, const Selection *selection)
{
  double least = INFINITY;
  for (int64_t n = 0; n < selection->count; ++n) least = fmin(least, p->density[selection->places[n]]);
  return least;
}

static double eigenvalue(const Load *load, const Particles *p)
{
  const Spring *spring = load->own;
  double sum = spring->stiffness / (load->volume * lightest(p, &load->selection));
  if (joins(load)) sum += spring->stiffness / (spring->other_volume * lightest(p, &load->other));
  return sum;
}

static void state(Load *load, const char *name, StateList *list)
{
  Spring *spring = load->own;
  const StateRow row = {.unit = "length",
                        .kind = STATE_NUMBERS,
                        .role = STATE_COMMITTED,
                        .count = joins(load) ? 1 : load->selection.count};
  static const char *const parts[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    StateRow one = row;
    one.values = spring->from[k];
    state_add(list, &one, name, parts[k]);
  }
}

static LoadWords tell(const Load *load, const Particles *p)
{
  const Spring *spring = load->own;
  double mass[2] = {0};
  for (int64_t n = 0; n < load->selection.count; ++n)
    mass[0] += p->density[load->selection.places[n]] * p->volume[load->selection.places[n]];
  for (int64_t n = 0; n < load->other.count; ++n)
    mass[1] += p->density[load->other.places[n]] * p->volume[load->other.places[n]];
  const double swings = joins(load) ? mass[0] * mass[1] / (mass[0] + mass[1]) : mass[0];
  return (LoadWords){.words = "its particles alone on it swing with a period of",
                     .value = 2 * acos(-1) * sqrt(swings / spring->stiffness),
                     .dimension = "time",
                     .unit = "s"};
}

static const double *vector(const LoadValue *value)
{
  return ((const SpringSpec *)value->section)->direction;
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  (void)value;
  *dimension = "force per length";
  return "spring";
}

static double magnitude(const LoadValue *value)
{
  return ((const SpringSpec *)value->section)->stiffness;
}

const LoadType spring_load = {.timeless = true,
                              .may_press = true,
                              .create = create,
                              .destroy = destroy,
                              .vector = vector,
                              .force = force,
                              .exerts = exerts,
                              .begin = begin,
                              .change = add_change,
                              .point_count = point_count,
                              .point = find_point,
                              .energy = energy,
                              .tell = tell,
                              .eigenvalue = eigenvalue,
                              .state = state,
                              .kind = kind,
                              .magnitude = magnitude};
