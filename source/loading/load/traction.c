#include "loading/load/face.h"
#include "loading/load/load_parts.h"

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
  double traction[3];
  for (int k = 0; k < 3; ++k) traction[k] = factor * load->value->point[k];
  face_push(load->own, p, traction);
}

static LoadWords tell(const Load *load, const Particles *p)
{
  return load_force_in_all(load_length(load->value) * face_area(load->own, load, p), load->value->point);
}

const LoadType traction_load = {
    .create = create, .destroy = destroy, .vector = load_point, .force = force, .tell = tell, .magnitude = load_length};
