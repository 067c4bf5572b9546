/* A face's forces over the particles that take them. An even stress s reaches up to a face with normal n if every particle takes what bonds cut off by the
 * face would bring it: s a, with a from the formulation (EvenStress), which behind a flat face is a share of its area along n. Shares of one column of
 * particles behind the face add up to its area, and their resultant stands at the face and not at the centres of the last layer. */
#include "loading/load/face.h"

#include <math.h>
#include <stdlib.h>

enum { DEEPEST = 16 };

/** Particles one behind the other, from the face inwards. */
typedef struct Column {
  int32_t place[DEEPEST];
  int count;
} Column;

typedef struct Spreading {
  const Load *load;
  const LoadMaking *making;
  Face *face;
  uint8_t *at_face, *taking; /* [places] of the load; of any column */
  double *area[3];           /* [places] */
} Spreading;

/** How deep a face may be felt: particles see each other within a horizon, and the weights of their bonds follow from what they see in turn. */
static int layers_of(const Spreading *s, int32_t place)
{
  const Particles *p = &s->making->body->particles;
  const Lattice *lattice = &s->making->body->lattices[p->block[place / SLICE]];
  if (!lattice->type || !lattice_is_grid(lattice->type)) return 0;
  const double layers = 2 * floor(s->making->family->horizon / lattice->spacing * (1 + 1e-9));
  return layers <= DEEPEST ? (int)layers : 0;
}

/** @return the next place straight inwards, or -1 */
static int32_t behind(const Spreading *s, int32_t place)
{
  const Family *f = s->making->family;
  const int64_t slice = place / SLICE;
  const double spacing = s->making->body->lattices[f->particles->block[slice]].spacing;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, place % SLICE);
    const double inwards = -s->face->outwards * bond.xi[s->face->axis];
    if (inwards > (1 - 1e-9) * bond.length && bond.length < 1.01 * spacing) return bond.neighbour;
  }
  return -1;
}

/** What stands behind a particle of the face, as deep as the face is felt; nothing where the opposite face is felt there, too. */
static Column find_column(const Spreading *s, int32_t place)
{
  const Particles *p = &s->making->body->particles;
  const int deep = layers_of(s, place);
  int32_t at = place;
  int layers = 0;
  Column column = {.count = 0};
  while (at >= 0 && layers < 2 * deep && !body_outside(s->making->body, p->number[at])) {
    if (layers && s->at_face[at]) break;
    if (layers < deep) column.place[layers] = at;
    ++layers;
    at = behind(s, at);
  }
  const bool goes_on = at >= 0 && body_outside(s->making->body, p->number[at]);
  if (layers == 2 * deep || goes_on) column.count = layers < deep ? layers : deep;
  return column;
}

/** Shares of a column's particles, and their sum; NAN where it is nothing like the part of the face that the column stands for. At corners it is half
 *  of that or one and a half, at edges in space less or more by up to that, and the sum over the face is right. */
static double find_shares(const Spreading *s, int32_t place, double share[DEEPEST], const Column *column)
{
  double sum = 0;
  for (int k = 0; k < column->count; ++k) {
    share[k] = -s->face->outwards * s->area[s->face->axis][column->place[k]];
    sum += share[k];
  }
  const double whole = s->making->body->particles.volume[place] * s->face->per_depth[place / SLICE];
  return sum > 0.2 * whole && sum < 1.8 * whole ? sum : NAN;
}

static void add(Face *face, const Particles *p, int32_t place, int64_t at, double area)
{
  face->place[face->count] = place;
  face->at[face->count] = (int32_t)at;
  face->per_volume[face->count++] = area / p->volume[place];
}

/** Shares of all particles. Where no column of them makes about its own part of the face, as next to another block or in thin bodies, and where
 *  bonds do not tell, the layer at the face takes all of it. @return whether any are from bonds */
static bool share_out(Spreading *s)
{
  const Particles *p = &s->making->body->particles;
  const Selection *on = &s->load->selection;
  Face *face = s->face;
  double whole = 0, shared = 0;
  bool any = false;
  for (int64_t n = 0; n < on->count; ++n) {
    const int32_t place = on->places[n];
    const Column column = find_column(s, place);
    double share[DEEPEST];
    const double own = p->volume[place] * face->per_depth[place / SLICE], sum = find_shares(s, place, share, &column);
    whole += own;
    if (isnan(sum)) {
      shared += own;
      add(face, p, place, n, own);
      continue;
    }
    any = true;
    shared += sum;
    for (int k = 0; k < column.count; ++k) add(face, p, column.place[k], n, share[k]);
  }
  for (int64_t n = 0; n < face->count; ++n) face->per_volume[n] *= whole / shared;
  return any;
}

/** Those on which forces act beside the load's own particles. */
static int list_others(const Spreading *s, Selection *others, Error *error)
{
  const Particles *p = &s->making->body->particles;
  for (int64_t i = 0; i < p->places; ++i) s->taking[i] = 0;
  int64_t count = 0;
  for (int64_t n = 0; n < s->face->count; ++n) {
    const int32_t place = s->face->place[n];
    count += !s->at_face[place];
    s->taking[place] = !s->at_face[place];
  }
  if (!count) return BRECCIA_OK;
  others->places = memory_zeroed((size_t)count, sizeof *others->places, "face", error);
  for (int64_t n = 0; n < p->count && others->places; ++n)
    if (s->taking[p->place_of[n]]) others->places[others->count++] = p->place_of[n];
  return others->places ? BRECCIA_OK : BRECCIA_FAILURE;
}

static int make_room(Face *face, const Spreading *s, int64_t most, Error *error)
{
  face->place = memory_zeroed((size_t)most, sizeof *face->place, "face", error);
  face->at = memory_zeroed((size_t)most, sizeof *face->at, "face", error);
  face->per_volume = memory_zeroed((size_t)most, sizeof *face->per_volume, "face", error);
  return face->place && face->at && face->per_volume && s->at_face && s->taking && s->area[0] && s->area[1] &&
                 s->area[2]
             ? BRECCIA_OK
             : BRECCIA_FAILURE;
}

/** Spreads by bonds. @param[out] any  whether any of it is */
static int spread_by_bonds(Face *face, Load *load, const LoadMaking *making, bool *any)
{
  const Particles *p = &making->body->particles;
  const size_t places = (size_t)p->places;
  Error *error = making->reader->error;
  Spreading s = {.load = load, .making = making, .face = face};
  s.at_face = memory_zeroed(places, 1, "face", error);
  s.taking = memory_zeroed(places, 1, "face", error);
  for (int k = 0; k < 3; ++k) s.area[k] = memory_zeroed(places, sizeof(double), "face", error);
  int64_t most = load->selection.count;
  for (int64_t n = 0; n < load->selection.count && s.at_face; ++n) s.at_face[load->selection.places[n]] = 1;
  for (int64_t n = 0; n < load->selection.count && s.at_face && s.taking; ++n) {
    const Column column = find_column(&s, load->selection.places[n]);
    for (int k = 0; k < column.count; ++k) s.taking[column.place[k]] = 1;
    most += column.count;
  }
  int status = make_room(face, &s, most, error);
  if (!status) {
    making->even_stress.find(making->even_stress.domain, s.taking, s.area);
    *any = share_out(&s);
    status = list_others(&s, &load->other, error);
  }
  free(s.at_face);
  free(s.taking);
  for (int k = 0; k < 3; ++k) free(s.area[k]);
  return status;
}

/** Spreads over the load's own particles. */
static int spread_over_layers(Face *face, const Load *load, const LoadMaking *making)
{
  const size_t count = (size_t)load->selection.count;
  Error *error = making->reader->error;
  face->place = memory_zeroed(count, sizeof *face->place, "face", error);
  face->at = memory_zeroed(count, sizeof *face->at, "face", error);
  face->per_volume = memory_zeroed(count, sizeof *face->per_volume, "face", error);
  if (!face->place || !face->at || !face->per_volume) return BRECCIA_FAILURE;
  face->count = load->selection.count;
  for (int64_t n = 0; n < face->count; ++n) {
    face->place[n] = load->selection.places[n];
    face->at[n] = (int32_t)n;
    face->per_volume[n] = face->per_depth[face->place[n] / SLICE];
  }
  return BRECCIA_OK;
}

int face_spread(Face *face, Load *load, const LoadMaking *making)
{
  const bool told = load->spec->spread >= 0;
  const DeckReader *reader = making->reader;
  const SelectionSpec *on = selection_spec(making->selections, &load->spec->on);
  const bool can = on && on->face >= 0 && on->layers == 1 && isnan(load->spec->area) && making->family->first;
  bool done = false;
  const int failed = told ? BRECCIA_OK : face_spread_scattered(face, load, making, &done);
  if (failed || done) return failed;
  if (told ? load->spec->spread == SPREAD_OVER_LAYERS : !can) return spread_over_layers(face, load, making);
  const int status = can ? spread_by_bonds(face, load, making, &done) : BRECCIA_OK;
  if (status || done || !told) return status;
  return node_error(
      reader->document, section_node(load->spec, "spread"), reader->error,
      "spread: bonds tell where forces act behind one layer of a face of a square or cubic lattice with "
      "'formulation: hybrid' or correspondence, no nearer to another block than that; take 'spread: layers'");
}
