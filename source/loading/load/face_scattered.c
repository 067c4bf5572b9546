/* Forces on a plane face of particles from files.
 *
 * The outermost particles of a scattered body have different distances from the face, and one layer contains only some
 * of them. The force on the face is therefore spread over the particles behind the face, up to a depth of two horizons.
 * The first estimate w0 of their areas comes from the formulation: the forces of the bonds that the face cuts off in a
 * uniform stress (EvenStress). A uniform stress then extends up to the face. In bodies shorter than four horizons, w0
 * is the volume times
 *   q(z) = (1 - z^2 / D^2)^((d + 1) / 2),
 * the share of the bonds of a particle at the depth z < D that cross a plane; D is the horizon.
 *
 * Corrections make the resultant force and moment of the areas equal to those of the continuous traction. For water
 * pressures, which are linear, they also correct the second moments along the face:
 *   w_i = w0_i + V_i q(z_i) sum_k b_k f_k(x_i),  sum_i w_i f_k(x_i) = integral of f_k over the face,
 * with f = 1, the coordinates s, t along the face, the depth z, and s^2, s t, t^2. The face is a segment or a rectangle
 * of the given area. Its plane ends the volume behind the face, divided by the area. Its centre is the centre of that
 * volume unless the deck gives 'centre'. */
#include "loading/load/face.h"

#include "base/linear.h"
#include <math.h>
#include <stdlib.h>

extern const LoadType water_pressure_load;

enum { MOST_MOMENTS = 7 };

typedef struct Scattered {
  const Load *load;
  const LoadMaking *making;
  Face *face;
  double spacing, horizon, thickness; /* thickness: 1 in space */
  int along[2], tangents;             /* axes along the face */
  double low[3], high[3];             /* extents of the centres of particles that take forces */
  double plane;                       /* coordinate of the face along the outward normal */
  double centre[2], half[2];          /* centre and half sizes of the face */
  uint8_t *taking;                    /* [places] 1: the particle takes forces */
  double *area[3];                    /* [places] area vectors of the uniform stress; finally area[0] is the area */
} Scattered;

/** Returns the coordinate of a place along the outward normal. */
static double scattered_outwards(const Scattered *s, int64_t place)
{
  return s->face->outwards * s->making->body->particles.position[s->face->axis][place];
}

/* ---- the face ---- */

/** Returns true if all particles of a load are in one block from a file. */
static bool scattered_is_cloud(const Load *load, const Body *body)
{
  const Particles *p = &body->particles;
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int block = p->block[load->selection.places[n] / SLICE];
    if (!body->blocks[block]->file || block != p->block[load->selection.places[0] / SLICE]) return false;
  }
  return load->selection.count > 0;
}

/** Computes the extents of the particles of the block, or of the load's selection only. */
static void scattered_extents(const Scattered *s, bool selected, double low[3], double high[3])
{
  const Particles *p = &s->making->body->particles;
  const int block = p->block[s->load->selection.places[0] / SLICE];
  const int64_t count = selected ? s->load->selection.count : p->count;
  for (int k = 0; k < 3; ++k) {
    low[k] = INFINITY;
    high[k] = -INFINITY;
  }
  for (int64_t n = 0; n < count; ++n) {
    const int32_t place = selected ? s->load->selection.places[n] : p->place_of[n];
    if (p->block[place / SLICE] != block) continue;
    for (int k = 0; k < 3; ++k) {
      low[k] = fmin(low[k], p->position[k][place]);
      high[k] = fmax(high[k], p->position[k][place]);
    }
  }
}

/** Finds the axis and the direction of the face for selections that name no face: the only axis with all selected
 *  particles at one end. @return false: there are several such axes, or none */
static bool scattered_find_normal(const Scattered *s, const double low[3], const double high[3])
{
  double block_low[3], block_high[3];
  int found = 0;
  scattered_extents(s, false, block_low, block_high);
  for (int k = 0; k < s->making->body->dimensions; ++k) {
    const bool at_low = low[k]<block_low[k] + 1.5 * s->spacing, at_high = high[k]> block_high[k] - 1.5 * s->spacing;
    if (at_low == at_high) continue;
    s->face->axis = k;
    s->face->outwards = at_high ? 1 : -1;
    ++found;
  }
  return found == 1;
}

/** Finds the extents along the face of the particles that take forces: the extents of the selection, or the sides of
 *  the block that the selection reaches. @return false: the area does not fit these extents */
static bool scattered_find_sides(Scattered *s, double area)
{
  double low[3], high[3], size = s->thickness;
  scattered_extents(s, false, s->low, s->high);
  scattered_extents(s, true, low, high);
  for (int t = 0; t < s->tangents; ++t) {
    const int k = s->along[t];
    const bool to_low = low[k]<s->low[k] + 1.5 * s->spacing, to_high = high[k]> s->high[k] - 1.5 * s->spacing;
    if (!to_low) s->low[k] = low[k];
    if (!to_high) s->high[k] = high[k];
    s->half[t] = (s->high[k] - s->low[k] + s->spacing) / 2;
    size *= 2 * s->half[t];
    s->low[k] = to_low ? -INFINITY : s->low[k] - s->spacing / 2;
    s->high[k] = to_high ? INFINITY : s->high[k] + s->spacing / 2;
  }
  for (int t = 0; t < s->tangents; ++t) s->half[t] *= pow(area / size, 1.0 / s->tangents);
  return area > 0.75 * size && area < 1.33 * size;
}

/** Returns true if a place is in the block of the load and within the sides of the face. */
static bool scattered_is_behind(const Scattered *s, int64_t place)
{
  const Particles *p = &s->making->body->particles;
  if (p->number[place] < 0 || p->block[place / SLICE] != p->block[s->load->selection.places[0] / SLICE]) return false;
  for (int t = 0; t < s->tangents; ++t) {
    const double x = p->position[s->along[t]][place];
    if (x < s->low[s->along[t]] || x > s->high[s->along[t]]) return false;
  }
  return true;
}

/** Finds the plane of the face, at which the volume of a stretch of the block equals length times area, and the centre
 *  of that volume. The inner end of the stretch is averaged over a horizon, because particles are few. */
static void scattered_find_plane(Scattered *s, double area)
{
  const Particles *p = &s->making->body->particles;
  const double last = s->face->outwards > 0 ? s->high[s->face->axis] : -s->low[s->face->axis],
               length = s->high[s->face->axis] - s->low[s->face->axis],
               reach = fmin(2 * s->horizon, fmax(length / 2, s->spacing)), from = last - reach, to = from + reach / 2;
  double volume = 0, moment[2] = {0};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t place = p->place_of[n];
    if (!scattered_is_behind(s, place)) continue;
    const double share = fmax(0, fmin(1, (scattered_outwards(s, place) - from) / (to - from)));
    volume += share * p->volume[place];
    for (int t = 0; t < s->tangents; ++t) moment[t] += share * p->volume[place] * p->position[s->along[t]][place];
  }
  s->plane = (from + to) / 2 + volume / area;
  if (!(s->plane >= last && s->plane <= last + 1.5 * s->spacing)) s->plane = last + s->spacing / 2;
  for (int t = 0; t < s->tangents; ++t) s->centre[t] = moment[t] / volume;
}

/** Sets the centre of the face from the deck; refuses a centre far from the selected particles' face. */
static int scattered_take_centre(Scattered *s)
{
  const double *given = s->load->spec->centre, near = 2 * s->spacing;
  const DeckReader *reader = s->making->reader;
  double found[3] = {NAN, NAN, NAN}, room[3];
  for (int t = 0; t < s->tangents; ++t) {
    found[s->along[t]] = s->centre[t];
    room[s->along[t]] = fmax(near, s->half[t] / 4);
    if (!isnan(given[s->along[t]])) s->centre[t] = given[s->along[t]];
  }
  found[s->face->axis] = s->face->outwards * s->plane;
  room[s->face->axis] = near;
  if (!isnan(given[s->face->axis])) s->plane = s->face->outwards * given[s->face->axis];
  for (int k = 0; k < s->making->body->dimensions; ++k)
    if (fabs(given[k] - found[k]) > room[k])
      return node_error(reader->document, section_node(s->load->spec, "centre"), reader->error,
                        "centre: its %c is %g, but the face of the selected particles has its centre near %g", "xyz"[k],
                        given[k], found[k]);
  return BRECCIA_OK;
}

/* ---- areas ---- */

static double scattered_depth(const Scattered *s, int64_t place)
{
  return fmax(0, s->plane - scattered_outwards(s, place));
}

/** Returns the volume of a particle times the share of its bonds that cross the face. */
static double scattered_profile(const Scattered *s, int64_t place)
{
  const double z = scattered_depth(s, place) / s->horizon;
  return z < 1 ? s->making->body->particles.volume[place] * pow(1 - z * z, 0.5 * (s->tangents + 2)) : 0;
}

/** Scales the areas to the area of the face. @return false: there are none, or their sum is far from the area */
static bool scattered_scale(const Scattered *s, double area)
{
  const int64_t places = s->making->body->particles.places;
  double *own = s->area[s->face->axis], sum = 0;
  for (int64_t place = 0; place < places; ++place)
    if (s->taking[place]) sum -= s->face->outwards * own[place];
  if (!(sum > 0.5 * area && sum < 2 * area)) return false;
  for (int64_t place = 0; place < places; ++place) own[place] *= area / sum;
  return true;
}

/** Queries the formulation for the areas, by its uniform stress or by the forces of a uniform pull.
 *  @param[out] told  false: neither gives areas */
static int scattered_ask(const Scattered *s, double area, bool *told)
{
  const EvenStress *even = &s->making->even_stress;
  const Particles *p = &s->making->body->particles;
  double *own = s->area[s->face->axis];
  even->find(even->domain, s->taking, s->area);
  *told = scattered_scale(s, area);
  if (*told) return BRECCIA_OK;
  const int status = even->pull(even->model, s->face->axis, own, s->making->reader->error);
  for (int64_t place = 0; place < p->places; ++place) own[place] *= p->volume[place];
  *told = !status && scattered_scale(s, area);
  return status;
}

/** Computes first estimates of areas in area[0].
 *  @param[out] count  number of particles with an area */
static int scattered_estimate(Scattered *s, double area, int64_t *count)
{
  const Particles *p = &s->making->body->particles;
  const double length = s->high[s->face->axis] - s->low[s->face->axis];
  bool told = false;
  for (int64_t place = 0; place < p->places; ++place)
    s->taking[place] = scattered_is_behind(s, place) && scattered_depth(s, place) < 2 * s->horizon;
  if (length > 4 * s->horizon && scattered_ask(s, area, &told)) return BRECCIA_FAILURE;
  *count = 0;
  for (int64_t place = 0; place < p->places; ++place) {
    if (!told) s->taking[place] &= scattered_depth(s, place) < s->horizon;
    const double own = -s->face->outwards * s->area[s->face->axis][place];
    s->area[0][place] = !s->taking[place] ? 0 : told ? own : scattered_profile(s, place);
    *count += s->taking[place];
  }
  return BRECCIA_OK;
}

/* ---- moments ---- */

/** Evaluates the functions f at a particle, in half sizes of the face and horizons of depth. @return their number */
static int scattered_functions(const Scattered *s, int64_t place, double f[MOST_MOMENTS])
{
  const Particles *p = &s->making->body->particles;
  double x[2] = {0};
  int count = 0;
  for (int t = 0; t < s->tangents; ++t) x[t] = (p->position[s->along[t]][place] - s->centre[t]) / s->half[t];
  f[count++] = 1;
  for (int t = 0; t < s->tangents; ++t) f[count++] = x[t];
  f[count++] = scattered_depth(s, place) / s->horizon;
  for (int t = 0; t < s->tangents; ++t)
    for (int r = t; r < s->tangents; ++r) f[count++] = x[t] * x[r];
  return count;
}

/** Computes the integrals of the functions f over the face, a segment or a rectangle. */
static void scattered_integrals(const Scattered *s, double area, double wanted[MOST_MOMENTS])
{
  const int first = 2 + s->tangents;
  for (int k = 0; k < MOST_MOMENTS; ++k) wanted[k] = 0;
  wanted[0] = area;
  wanted[first] = area / 3;
  if (s->tangents == 2) wanted[first + 2] = area / 3;
}

/** Corrects areas so that the sums of the first functions are exact. @return false: there are too few particles */
static bool scattered_correct(const Scattered *s, int functions, const double wanted[MOST_MOMENTS])
{
  const Particles *p = &s->making->body->particles;
  double matrix[MOST_MOMENTS * MOST_MOMENTS] = {0}, x[MOST_MOMENTS], f[MOST_MOMENTS], largest = 0;
  int begin[MOST_MOMENTS];
  for (int k = 0; k < functions; ++k) x[k] = wanted[k];
  for (int64_t place = 0; place < p->places; ++place) {
    if (!s->taking[place]) continue;
    const double weight = scattered_profile(s, place);
    scattered_functions(s, place, f);
    for (int k = 0; k < functions; ++k) {
      x[k] -= s->area[0][place] * f[k];
      for (int l = 0; l <= k; ++l) matrix[k * functions + l] += weight * f[k] * f[l];
    }
  }
  for (int k = 0; k < functions; ++k) largest = fmax(largest, matrix[k * functions + k]);
  if (!linear_factor(functions, matrix, begin)) return false;
  for (int k = 0; k < functions; ++k) /* squares of pivots */
    if (matrix[k * functions + k] * matrix[k * functions + k] < 1e-6 * largest) return false;
  linear_factor_solve(functions, matrix, begin, x);
  for (int64_t place = 0; place < p->places; ++place) {
    if (!s->taking[place]) continue;
    const double weight = scattered_profile(s, place);
    scattered_functions(s, place, f);
    for (int k = 0; k < functions; ++k) s->area[0][place] += weight * x[k] * f[k];
  }
  return true;
}

/** Corrects as many moments as the number of particles allows; the resultant force at least. */
static void scattered_balance(const Scattered *s, double area)
{
  const bool linear = s->load->type == &water_pressure_load;
  const int all = !linear ? 2 + s->tangents : s->tangents == 2 ? 7 : 4;
  const int tries[] = {all, 2 + s->tangents, 1 + s->tangents, 1};
  double wanted[MOST_MOMENTS];
  scattered_integrals(s, area, wanted);
  for (int k = 0; k < 4; ++k) {
    if (!scattered_correct(s, tries[k], wanted)) continue;
    scattered_correct(s, tries[k], wanted); /* removes round-off */
    return;
  }
}

/* ---- making ---- */

/** Stores the areas in the face, and lists the particles outside of the load's selection. */
static int scattered_store(const Scattered *s, Load *load, int64_t count, Error *error)
{
  const Particles *p = &s->making->body->particles;
  Face *face = s->face;
  face->scattered = true;
  face->plane = face->outwards * s->plane;
  face->place = memory_zeroed((size_t)count, sizeof *face->place, "face", error);
  face->at = memory_zeroed((size_t)count, sizeof *face->at, "face", error);
  face->per_volume = memory_zeroed((size_t)count, sizeof *face->per_volume, "face", error);
  load->other.places = memory_zeroed((size_t)count, sizeof *load->other.places, "face", error);
  if (!face->place || !face->at || !face->per_volume || !load->other.places) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t place = p->place_of[n];
    if (!s->taking[place]) continue;
    face->place[face->count] = load->other.places[face->count] = place;
    face->at[face->count] = (int32_t)face->count;
    face->per_volume[face->count++] = s->area[0][place] / p->volume[place];
  }
  for (int64_t n = 0; n < load->selection.count; ++n) s->taking[load->selection.places[n]] = 0;
  for (int64_t n = 0; n < face->count; ++n)
    if (s->taking[face->place[n]]) load->other.places[load->other.count++] = face->place[n];
  return BRECCIA_OK;
}

static void scattered_find_tangents(Scattered *s)
{
  s->tangents = 0;
  for (int k = 0; k < s->making->body->dimensions; ++k)
    if (k != s->face->axis) s->along[s->tangents++] = k;
}

int face_spread_scattered(Face *face, Load *load, const LoadMaking *making, bool *done)
{
  const Body *body = making->body;
  const double area = load->spec->area;
  const SelectionSpec *on = selection_spec(making->selections, &load->spec->on);
  double low[3], high[3];
  *done = false;
  if (isnan(area) || body->dimensions < 2 || body->margin_of || !making->family->first ||
      !scattered_is_cloud(load, body))
    return BRECCIA_OK;
  const int block = body->particles.block[load->selection.places[0] / SLICE];
  Scattered s = {.load = load,
                 .making = making,
                 .face = face,
                 .spacing = body->lattices[block].spacing,
                 .horizon = making->family->horizon,
                 .thickness = body->dimensions == 2 ? body_section(body) : 1};
  scattered_extents(&s, true, low, high);
  if (!(on && on->face >= 0) && !scattered_find_normal(&s, low, high)) return BRECCIA_OK;
  scattered_find_tangents(&s);
  if (!scattered_find_sides(&s, area)) return BRECCIA_OK;
  scattered_find_plane(&s, area);
  if (scattered_take_centre(&s)) return BRECCIA_USER_ERROR;
  const size_t places = (size_t)body->particles.places;
  Error *error = making->reader->error;
  s.taking = memory_zeroed(places, 1, "face", error);
  for (int k = 0; k < 3; ++k) s.area[k] = memory_zeroed(places, sizeof(double), "face", error);
  int status = s.taking && s.area[0] && s.area[1] && s.area[2] ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status) {
    int64_t count = 0;
    status = scattered_estimate(&s, area, &count);
    *done = !status && count > 0;
    if (*done) {
      scattered_balance(&s, area);
      status = scattered_store(&s, load, count, error);
    }
  }
  free(s.taking);
  for (int k = 0; k < 3; ++k) free(s.area[k]);
  return status;
}
