#include "loading/load/load_parts.h"

#include "base/team.h"
#include <math.h>

static int create(Load *load, const LoadMaking *making)
{
  int axis[3];
  return load_rotations(load, making, axis) < 0 ? BRECCIA_USER_ERROR : BRECCIA_OK;
}

static void force(const Load *load, Particles *p, double factor)
{
  TEAM_FOR (n, load->selection.count) {
    const int32_t place = load->selection.places[n];
    for (int k = p->space.rotation; k < p->space.rows; ++k)
      p->external.row[k][place] += factor * load->value->point[p->space.row[k].axis] / load->volume;
  }
}

const LoadType moment_load = {.create = create, .force = force, .magnitude = load_length};
