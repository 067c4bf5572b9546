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

void load_push(const Load *load, Particles *p, const double uniform[3], const double per_density[3])
{
  TEAM_FOR (n, load->selection.count) {
    const int32_t place = load->selection.places[n];
    for (int k = 0; k < 3; ++k) p->external[k][place] += uniform[k] + per_density[k] * p->density[place];
  }
}

void load_constrain(Load *load, const LoadMaking *making, const double d[3], double value, int order)
{
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  making->loading->constraints[making->loading->constraint_count++] = (Constraint){
      .load = load, .direction = {d[0] / length, d[1] / length, d[2] / length}, .value = value, .order = order};
}

void load_constrain_axes(Load *load, const LoadMaking *making, int order)
{
  for (int k = 0; k < 3; ++k) {
    double axis[3] = {0};
    axis[k] = 1;
    if (!isnan(load->value->point[k])) load_constrain(load, making, axis, load->value->point[k], order);
  }
}
