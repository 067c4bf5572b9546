#include "body/particles.h"

#include "base/team.h"
#include "body/nearer.h"
#include "body/orientation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Large blocks of memory begin at the same offset of a page, so that the same place of all arrays would fall into the same set
 * of the first-level cache: thirteen arrays into eight ways. Each array is therefore shifted by some lines of a page, chosen from its
 * address, and begins with a line, so that a slice is one; what has to be freed is kept before the spare entries. */
enum { LINE = 8, PAGE_LINES = 64, PAGE_NUMBERS = LINE * PAGE_LINES };

static void touch_page(void *array, int64_t page)
{
  ((double *)array)[page * PAGE_NUMBERS] = 0;
}

enum { SPARE = 2 * SLICE + 2 * LINE + PAGE_NUMBERS };

/** The array within zeroed memory that has SPARE numbers more. */
static double *staggered(double *memory)
{
  uint64_t page = (uint64_t)(uintptr_t)memory >> 12;
  uint64_t shift = page * 0x9e3779b97f4a7c15u >> 58; /* 0 to 63 lines */
  double *array = memory + LINE + LINE * shift + SLICE;
  array += (-(uintptr_t)array & 63) / sizeof(double);
  memcpy(array - SLICE - 1, &memory, sizeof memory);
  return array;
}

double *places_array(int64_t places, const char *label, Error *error)
{
  double *memory = memory_zeroed((size_t)places + SPARE, sizeof(double), label, error);
  if (!memory) return NULL;
  double *array = staggered(memory);
  /* A page lies near the processor that first writes to it: each thread writes to the part that it will work on. */
  team_each((places + PAGE_NUMBERS - 1) / PAGE_NUMBERS, touch_page, array);
  return array;
}

double *places_reserved(int64_t places, const char *label, Error *error)
{
  double *memory = memory_reserved((size_t)places + SPARE, sizeof(double), label, error);
  return memory ? staggered(memory) : NULL;
}

void places_free(double **array)
{
  if (*array) {
    double *memory;
    memcpy(&memory, *array - SLICE - 1, sizeof memory);
    free(memory);
  }
  *array = NULL;
}

int particles_create(Particles *particles, int64_t slices, int64_t count, Error *error)
{
  *particles = (Particles){.slices = slices, .count = count, .places = slices * SLICE};
  int failed = 0;
  VectorSpace *space = &particles->space;
  *space = (VectorSpace){.rows = 3, .rotation = 3, .places = particles->places};
  for (int k = 0; k < 3; ++k) {
    space->row[k] = (VectorRow){ROW_DISPLACEMENT, k};
    failed |= !(particles->position[k] = places_array(particles->places, "positions", error));
  }
  failed |= !vector_create(&particles->displacement, space, "displacements", error);
  failed |= !vector_create(&particles->velocity, space, "velocities", error);
  failed |= !vector_create(&particles->internal, space, "internal forces", error);
  failed |= !vector_reserve(&particles->external, space, "external forces", error);
  particles->inertia.space = space;
  failed |= !(particles->volume = places_array(particles->places, "volumes", error));
  failed |= !(particles->density = places_array(particles->places, "densities", error));
  failed |= !(particles->number = memory_zeroed((size_t)particles->places, sizeof(int32_t), "numbers", error));
  failed |= !(particles->place_of = memory_zeroed((size_t)count, sizeof(int32_t), "numbers", error));
  failed |= !(particles->block = memory_zeroed((size_t)slices, sizeof(int32_t), "block of each slice", error));
  for (int k = 0; k < 3; ++k) particles->inertia.row[k] = particles->density;
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void particles_destroy(Particles *particles)
{
  for (int k = 0; k < 3; ++k) {
    places_free(&particles->position[k]);
    places_free(&particles->zero[k]);
  }
  vector_destroy(&particles->displacement);
  vector_destroy(&particles->velocity);
  vector_destroy(&particles->internal);
  vector_destroy(&particles->external);
  for (int k = 0; k < 4; ++k) places_free(&particles->orientation[k]);
  places_free(&particles->rotary);
  free(particles->unturned);
  places_free(&particles->free_strain);
  places_free(&particles->volume);
  places_free(&particles->density);
  free(particles->number);
  free(particles->place_of);
  free(particles->block);
  *particles = (Particles){0};
}

int particles_make_rotations(Particles *p, int dimensions, Error *error)
{
  int failed = !(p->rotary = places_array(p->places, "rotational inertia", error));
  p->space.rows = dimensions == 3 ? 6 : 4;
  for (int k = p->space.rotation; k < p->space.rows; ++k) {
    p->space.row[k] = (VectorRow){ROW_ROTATION, dimensions == 3 ? k - p->space.rotation : 2};
    failed |= !(p->displacement.row[k] = places_array(p->places, "rotations", error));
    failed |= !(p->velocity.row[k] = places_array(p->places, "angular velocities", error));
    failed |= !(p->internal.row[k] = places_array(p->places, "internal moments", error));
    failed |= !(p->external.row[k] = places_array(p->places, "external moments", error));
    p->inertia.row[k] = p->rotary;
  }
  for (int k = 0; k < 4 && dimensions == 3; ++k)
    failed |= !(p->orientation[k] = places_array(p->places, "orientations", error));
  if (failed) return BRECCIA_FAILURE;
  for (int64_t i = 0; i < p->places && dimensions == 3; ++i) p->orientation[0][i] = 1;
  return BRECCIA_OK;
}

BRECCIA_CLONES
static void take_rotations(Particles *p, int64_t first, int64_t last)
{
  for (int64_t i = first; i < last; i += LANES) {
    Lanes q[4], square = lanes_set(0);
    LaneMask stays = ~(LaneMask){0}; /* those at rest, to the bit */
    turned_by(p->orientation, p->displacement.row + p->space.rotation, i, q);
    for (int k = 0; k < 4; ++k) square += q[k] * q[k];
    for (int k = 0; k < 3; ++k)
      stays &= (LaneMask)(lanes_load(p->displacement.row[p->space.rotation + k] + i) == lanes_set(0));
    const Lanes by_length = lanes_set(1) / lanes_root(square);
    for (int k = 0; k < 4; ++k)
      lanes_store(p->orientation[k] + i, lanes_choose(stays, lanes_load(p->orientation[k] + i), by_length * q[k]));
    for (int k = 0; k < 3; ++k) lanes_store(p->displacement.row[p->space.rotation + k] + i, lanes_set(0));
  }
}

void particles_take_rotations(Particles *p, int64_t first, int64_t last)
{
  if (p->orientation[0]) take_rotations(p, first, last);
}

void particles_rotation(const Particles *p, int32_t place, double rotation[3])
{
  for (int k = 0; k < 3; ++k) rotation[k] = 0;
  if (p->space.rows == 4) rotation[2] = p->displacement.row[p->space.rotation][place];
  if (p->space.rows < 6) return;
  double q[4];
  particles_orientation(p, p->displacement.row, place, q);
  const double size = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]), sign = q[0] < 0 ? -1 : 1;
  for (int k = 0; k < 3 && size > 0; ++k) rotation[k] = 2 * atan2(size, fabs(q[0])) * sign * q[1 + k] / size;
}

int particles_make_zero(Particles *p, Error *error)
{
  int failed = 0;
  for (int k = 0; k < 3; ++k) failed |= !(p->zero[k] = places_array(p->places, "displacements", error));
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void particles_state_rotations(const char *name, const char *unit, StateRole role, const Vector *vector,
                               StateList *list)
{
  static const char *const parts[] = {"x", "y", "z"};
  for (int k = vector->space->rotation; k < vector->space->rows; ++k)
    state_add(list,
              &(StateRow){.unit = unit,
                          .kind = STATE_NUMBERS,
                          .entity = STATE_OF_PLACE,
                          .role = role,
                          .count = vector->space->places,
                          .values = vector->row[k]},
              name, parts[vector->space->row[k].axis]);
}

static void state_rotations(Particles *p, StateList *list)
{
  static const char *const parts[] = {"1", "x", "y", "z"};
  particles_state_rotations(p->space.rows == 4 ? "rotation" : "rotation of the step", "1", STATE_TRIED,
                            &p->displacement, list);
  particles_state_rotations("angular velocity", "angular velocity", STATE_TRIED, &p->velocity, list);
  particles_state_rotations("external moment", "stress", STATE_COMMITTED, &p->external, list);
  for (int k = 0; k < 4 && p->orientation[0]; ++k)
    state_add(list,
              &(StateRow){.unit = "1",
                          .kind = STATE_NUMBERS,
                          .entity = STATE_OF_PLACE,
                          .role = STATE_COMMITTED,
                          .count = p->places,
                          .values = p->orientation[k]},
              "orientation", parts[k]);
}

void particles_state(Particles *p, StateList *list)
{
  state_add_vector(list, "position", "length", STATE_SHOWN, p->position, p->places);
  state_add_vector(list, "displacement", "length", STATE_TRIED, p->displacement.row, p->places);
  state_add_vector(list, "velocity", "velocity", STATE_TRIED, p->velocity.row, p->places);
  if (p->zero[0]) state_add_vector(list, "displacement at zero", "length", STATE_COMMITTED, p->zero, p->places);
  state_add_vector(list, "external force", "force per volume", STATE_COMMITTED, p->external.row, p->places);
  state_rotations(p, list);
  const StateRow row = {.kind = STATE_NUMBERS, .entity = STATE_OF_PLACE, .role = STATE_SHOWN, .count = p->places};
  StateRow volume = row, density = row;
  volume.unit = "volume";
  volume.values = p->volume;
  density.unit = "density";
  density.values = p->density;
  state_add(list, &volume, "volume", NULL);
  state_add(list, &density, "density", NULL);
}

void particles_bounds(const Particles *particles, double low[3], double high[3])
{
  for (int k = 0; k < 3; ++k) {
    low[k] = INFINITY;
    high[k] = -INFINITY;
    for (int64_t n = 0; n < particles->count; ++n) {
      double x = particles->position[k][particles->place_of[n]];
      low[k] = fmin(low[k], x);
      high[k] = fmax(high[k], x);
    }
  }
}

double particles_distance(const Particles *p, int32_t a, int32_t b)
{
  double square = 0;
  for (int k = 0; k < 3; ++k)
    square += (p->position[k][b] - p->position[k][a]) * (p->position[k][b] - p->position[k][a]);
  return sqrt(square);
}

int32_t particles_nearest(const Particles *particles, const double point[3])
{
  int32_t nearest = -1;
  double best = INFINITY;
  for (int64_t n = 0; n < particles->count; ++n) {
    int32_t place = particles->place_of[n];
    double distance = 0;
    for (int k = 0; k < 3; ++k) {
      double d = particles->position[k][place] - point[k];
      distance += d * d;
    }
    if (is_nearer(distance, best)) {
      best = distance;
      nearest = place;
    }
  }
  return nearest;
}
