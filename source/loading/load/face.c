#include "loading/load/face.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>

/** Depth of the layers of a face, of which a particle's volume is that times its share of the face; NaN where there is no lattice. */
static double depth_of(const Lattice *lattice, const BlockSpec *block, int axis, int64_t layers)
{
  return block->file ? NAN : lattice->unit.size[axis] * lattice->filled[axis] * (double)layers;
}

int face_create(Face *face, const Load *load, const LoadMaking *making)
{
  const Body *body = making->body;
  const Particles *p = &body->particles;
  const DeckReader *reader = making->reader;
  const SelectionSpec *on = selection_spec(making->selections, &load->spec->on);
  const double area = load->spec->area;
  *face = (Face){0};
  if ((!on || on->face < 0) && (isnan(area) || load->node->key[0] != 't'))
    return node_error(reader->document, load->node, reader->error,
                      "%s: acts on a face: 'on' must say which, like {face: x+}%s", load->node->key,
                      load->node->key[0] == 't' ? ", or 'area' how large it is" : "");
  face->axis = on && on->face >= 0 ? selection_axis(on) : 0;
  face->outwards = on && on->face >= 0 ? selection_side(on) : 1;
  face->per_depth = memory_zeroed((size_t)p->slices, sizeof(double), "face", reader->error);
  if (!face->per_depth) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int64_t slice = load->selection.places[n] / SLICE;
    const int b = p->block[slice];
    if (!isnan(area) && load->node->key[0] != 't' && !body->blocks[b]->file)
      return node_error(reader->document, section_node(load->spec, "area"), reader->error,
                        "area: only a 'traction' has one, and a pressure on particles from a file; block '%s' is a "
                        "lattice, of which the area is known",
                        body->blocks[b]->head.name);
    face->per_depth[slice] =
        !isnan(area) ? area / load->volume : 1 / depth_of(&body->lattices[b], body->blocks[b], face->axis, on->layers);
    if (isnan(face->per_depth[slice]))
      return node_error(reader->document, load->node, reader->error,
                        "%s: the particles of block '%s' come from a file, so that the area of its face is not known; "
                        "give its 'area'",
                        load->node->key, body->blocks[b]->head.name);
  }
  return BRECCIA_OK;
}

void face_destroy(Face *face)
{
  free(face->per_depth);
  free(face->place);
  free(face->at);
  free(face->per_volume);
  *face = (Face){0};
}

double face_force(const Face *face, const Load *load, const Particles *p, const double *value)
{
  double sum = 0;
  for (int64_t n = 0; face->scattered && n < face->count; ++n)
    sum += (value ? value[n] : 1) * p->volume[face->place[n]] * face->per_volume[n];
  if (face->scattered) return sum;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t place = load->selection.places[n];
    sum += (value ? value[n] : 1) * p->volume[place] * face->per_depth[place / SLICE];
  }
  return sum;
}

double face_area(const Face *face, const Load *load, const Particles *p)
{
  return face_force(face, load, p, NULL);
}

int face_balance(Face *face, const Load *load, const Particles *p, const double *value, Error *error)
{
  double *area = memory_zeroed((size_t)load->selection.count, sizeof *area, "face", error); /* that columns stand for */
  if (!area) return BRECCIA_FAILURE;
  double missing = face_force(face, load, p, value), at_corners = 0;
  for (int64_t n = 0; n < face->count; ++n) area[face->at[n]] += face->per_volume[n] * p->volume[face->place[n]];
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t place = load->selection.places[n];
    const double own = p->volume[place] * face->per_depth[place / SLICE];
    missing -= value[n] * area[n];
    if (fabs(area[n] - own) <= 1e-9 * own)
      area[n] = 0;
    else
      at_corners += value[n] * area[n];
  }
  for (int64_t n = 0; n < face->count && at_corners > 0; ++n)
    if (area[face->at[n]] != 0) face->per_volume[n] *= 1 + missing / at_corners;
  free(area);
  return BRECCIA_OK;
}

void face_push(const Face *face, Particles *p, const double traction[3])
{
  TEAM_FOR (n, face->count)
    for (int k = 0; k < 3; ++k)
      if (traction[k] != 0) p->external.row[k][face->place[n]] += traction[k] * face->per_volume[n];
}
