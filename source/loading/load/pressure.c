#include "loading/load/face.h"
#include "loading/load/load_parts.h"

#include <math.h>
#include <stdlib.h>

static int create(Load *load, const LoadMaking *making)
{
  load->own = memory_zeroed(1, sizeof(Face), "face", making->reader->error);
  if (!load->own) return BRECCIA_FAILURE;
  const int status = face_create(load->own, load, making);
  return status ? status : face_spread(load->own, load, making);
}

static void destroy(Load *load)
{
  face_destroy(load->own);
  free(load->own);
}

static void force(const Load *load, Particles *p, double factor)
{
  const Face *face = load->own;
  double traction[3] = {0};
  traction[face->axis] = -face->outwards * factor * load->value->number;
  face_push(face, p, traction);
}

static double magnitude(const LoadValue *value)
{
  return value->number;
}

static LoadWords tell(const Load *load, const Particles *p)
{
  const Face *face = load->own;
  double along[3] = {0};
  along[face->axis] = -face->outwards * load->value->number;
  return load_force_in_all(fabs(load->value->number) * face_area(face, load, p), along);
}

const LoadType pressure_load = {
    .create = create, .destroy = destroy, .force = force, .tell = tell, .magnitude = magnitude};
