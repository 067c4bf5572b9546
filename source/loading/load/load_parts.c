#include "loading/load/load_parts.h"

#include "base/team.h"
#include <math.h>

const double *load_point(const LoadValue *value)
{
  return value->point;
}

double load_length(const LoadValue *value)
{
  double square = 0;
  for (int k = 0; k < 3; ++k)
    if (!isnan(value->point[k])) square += value->point[k] * value->point[k];
  return sqrt(square);
}

LoadWords load_force_in_all(double size, const double along[3])
{
  LoadWords told = {.words = "a force in all of", .value = size, .dimension = "force", .unit = "N"};
  const double length = sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
  for (int k = 0; k < 3 && length > 0; ++k) told.direction[k] = along[k] / length;
  return told;
}

void load_push(const Load *load, Particles *p, const double uniform[3], const double per_density[3])
{
  TEAM_FOR (n, load->selection.count) {
    const int32_t place = load->selection.places[n];
    for (int k = 0; k < 3; ++k)
      if (uniform[k] != 0 || per_density[k] != 0)
        p->external.row[k][place] += uniform[k] + per_density[k] * p->density[place];
  }
}

/** Prescribes a motion by rows from `row` on. */
static void constrain(Load *load, const LoadMaking *making, int row, const double d[3], double value, int order)
{
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  making->loading->constraints[making->loading->constraint_count++] =
      (Constraint){.load = load,
                   .row = row,
                   .direction = {d[0] / length, d[1] / length, d[2] / length},
                   .value = value,
                   .order = order};
}

void load_constrain(Load *load, const LoadMaking *making, const double d[3], double value, int order)
{
  constrain(load, making, 0, d, value, order);
}

void load_constrain_rotation(Load *load, const LoadMaking *making, int k, double value, int order)
{
  const double axis[3] = {k == 0, k == 1, k == 2};
  constrain(load, making, making->body->particles.space.rotation, axis, value, order);
}

int load_turning(const Particles *p, int axis[3])
{
  int count = 0;
  for (int k = 0; k < 3; ++k)
    if (p->space.rows == 6 || (p->space.rows == 4 && k == 2)) axis[count++] = k;
  return count;
}

int load_rotations(const Load *load, const LoadMaking *making, int axis[3])
{
  const Particles *p = &making->body->particles;
  if (!particles_have_rotations(p))
    return node_error(making->reader->document, load->node, making->reader->error,
                      "%s: the particles of this body have no rotations; those of `formulation: micropolar` do",
                      load->node->key),
           -1;
  for (int k = 0; k < 2 && p->space.rows == 4; ++k)
    if (!isnan(load->value->point[k]) && load->value->point[k] != 0)
      return node_error(making->reader->document, load->node, making->reader->error,
                        "%s: the body is plane and turns about z only: [0, 0, value]", load->node->key),
             -1;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t i = load->selection.places[n];
    if (!particles_turn(p, i))
      return node_error(
                 making->reader->document, load->node, making->reader->error,
                 "%s: particle %d at [%g, %g, %g] has no rotation, as its formulation has none; select particles "
                 "of `formulation: micropolar` only",
                 load->node->key, p->number[i], p->position[0][i], p->position[1][i], p->position[2][i]),
             -1;
  }
  return load_turning(p, axis);
}

int load_constrain_rotations(Load *load, const LoadMaking *making, int order)
{
  int of[3];
  const int count = load_rotations(load, making, of);
  const double degree = acos(-1) / 180;
  for (int k = 0; k < count; ++k)
    if (!isnan(load->value->point[of[k]]))
      load_constrain_rotation(load, making, k, degree * load->value->point[of[k]], order);
  return count < 0 ? BRECCIA_USER_ERROR : BRECCIA_OK;
}

void load_constrain_axes(Load *load, const LoadMaking *making, int order)
{
  for (int k = 0; k < 3; ++k) {
    double axis[3] = {0};
    axis[k] = 1;
    if (!isnan(load->value->point[k])) load_constrain(load, making, axis, load->value->point[k], order);
  }
}
