#include "formulation/correspondence.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void correspondence_destroy(void *formulation)
{
  Correspondence *c = formulation;
  if (!c) return;
  for (int k = 0; k < 9; ++k) places_free(&c->state[k]);
  for (int k = 0; k < 6; ++k) {
    places_free(&c->inverse[k]);
    places_free(&c->hold[k]);
  }
  for (int k = 0; k < 3; ++k) {
    places_free(&c->first_moment[k]);
    places_free(&c->stretch[k]);
    places_free(&c->held[k]);
  }
  places_free(&c->weight_sum);
  for (int kind = 0; kind < ROW_KINDS; ++kind) {
    places_free(&c->row_displacement[kind]);
    places_free(&c->row_pull[kind]);
  }
  free(c->roundness);
  free(c->mode);
  free(c->axial);
  free(c);
}

static void set_shape(Correspondence *c, int32_t place, const ShapeTensor *shape)
{
  for (int k = 0; k < 6; ++k) c->inverse[k][place] = shape->inverse[k];
  for (int k = 0; k < 3; ++k) c->first_moment[k][place] = shape->first_moment[k];
  c->weight_sum[place] = shape->weight_sum;
  bool strained = shape->mode == SHAPE_REGULAR || shape->mode == SHAPE_REDUCED;
  const Material *m = &c->points->materials[c->points->material[place / SLICE]];
  if (c->control == CONTROL_SCALAR) {
    double scale = c->strength * micromodulus(c->body, material_young(m), c->family->horizon) / c->family->horizon;
    c->hold[0][place] = shape->mean_influence > 0 ? scale / shape->mean_influence : scale;
  } else if (c->control == CONTROL_TENSOR) {
    double lambda = m->bulk - 2 * m->shear / 3;
    double trace = shape->inverse[XX] + shape->inverse[YY] + shape->inverse[ZZ];
    for (int k = 0; k < 6; ++k)
      c->hold[k][place] =
          strained ? c->strength * (2 * m->shear * shape->inverse[k] + (k < 3 ? lambda * trace : 0)) : 0;
  }
}

void correspondence_renew(void *formulation, int64_t slice)
{
  Correspondence *c = formulation;
  for (int lane = 0; lane < SLICE; ++lane) {
    int32_t place = (int32_t)(slice * SLICE + lane);
    if (c->particles->number[place] < 0) continue;
    ShapeTensor shape = shape_tensor(c->family, place, c->plane, (double)c->roundness[place]);
    if (shape.mode == SHAPE_AXIAL && c->mode[place] != SHAPE_AXIAL) { /* kept in order, so that a restart sums alike */
      int64_t n = c->axial_count++;
      for (; n > 0 && c->axial[n - 1] > place; --n) c->axial[n] = c->axial[n - 1];
      c->axial[n] = place;
    }
    c->mode[place] = (uint8_t)shape.mode;
    set_shape(c, place, &shape);
  }
}

/** True if all particles have one and the same scalar C, and will keep it whatever breaks. */
static bool is_uniform(const Correspondence *c)
{
  const Particles *p = c->particles;
  if (c->control != CONTROL_SCALAR) return false;
  double first = c->hold[0][p->place_of[0]];
  for (int64_t n = 1; n < p->count; ++n)
    if (c->hold[0][p->place_of[n]] != first) return false;
  for (int k = 0; k < c->family->pattern_count; ++k)
    if (c->family->patterns[k].weight != c->family->patterns[0].weight) return false;
  return true;
}

static int set_all_shapes(Correspondence *c, Error *error)
{
  const Particles *p = c->particles;
  int32_t worst = INT32_MAX;
#pragma omp parallel for schedule(static) reduction(min : worst)
  for (int32_t place = 0; place < p->places; ++place) {
    if (p->number[place] < 0) continue;
    ShapeTensor shape = shape_tensor(c->family, place, c->plane, 0);
    c->roundness[place] = (float)shape.roundness;
    c->mode[place] = (uint8_t)shape.mode;
    if ((shape.mode != SHAPE_REGULAR || shape.roundness < 1e-6) && p->number[place] < worst) worst = p->number[place];
    set_shape(c, place, &shape);
  }
  if (worst == INT32_MAX) return BRECCIA_OK;
  int32_t place = p->place_of[worst];
  return error_add(
      error, BRECCIA_USER_ERROR,
      "particle %d at [%g, %g, %g] has %d bonds that do not span %s, so that it has no strain; the horizon is "
      "%g: give the body at least two layers in every direction, a longer horizon, or a square lattice in the "
      "plane",
      worst, p->position[0][place], p->position[1][place], p->position[2][place], family_count(c->family, place),
      c->plane ? "the plane" : "space", c->family->horizon);
}

void *correspondence_create(const FormulationParts *parts, Error *error)
{
  Correspondence *c = calloc(1, sizeof *c);
  if (!c) {
    error_add(error, BRECCIA_FAILURE, "out of memory: correspondence");
    return NULL;
  }
  c->particles = parts->particles;
  c->family = parts->family;
  c->points = parts->points;
  c->body = parts->body;
  c->plane = parts->body->plane;
  c->finite = !strcmp(parts->spec->strain, "green-lagrange");
  const ControlSpec *control = parts->spec->control;
  c->control = CONTROL_SCALAR;
  c->strength = c->plane ? 0.2 : 0.1;
  if (control && !isnan(control->silling)) c->strength = control->silling;
  if (control && !isnan(control->wan)) {
    c->control = CONTROL_TENSOR;
    c->strength = control->wan;
  }
  if ((control && control->none) || c->strength == 0) c->control = CONTROL_NONE;

  int64_t places = parts->particles->places;
  int failed = 0;
  for (int k = 0; k < 9; ++k) failed |= !(c->state[k] = places_array(places, "force states", error));
  for (int k = 0; k < 6; ++k) failed |= !(c->inverse[k] = places_array(places, "shape tensors", error));
  for (int k = 0; k < hold_components(c->control); ++k)
    failed |= !(c->hold[k] = places_array(places, "zero-energy control", error));
  for (int k = 0; k < 3; ++k) {
    failed |= !(c->first_moment[k] = places_array(places, "shape tensors", error));
    failed |= !(c->stretch[k] = places_array(places, "deformation", error));
  }
  failed |= !(c->weight_sum = places_array(places, "shape tensors", error));
  failed |= !(c->roundness = memory_zeroed((size_t)places, sizeof *c->roundness, "shape tensors", error));
  failed |= !(c->mode = memory_zeroed((size_t)places, sizeof *c->mode, "shape tensors", error));
  failed |= !(c->axial = memory_zeroed((size_t)parts->particles->count, sizeof *c->axial, "axial particles", error));
  if (failed || set_all_shapes(c, error)) {
    correspondence_destroy(c);
    return NULL;
  }
  if (is_uniform(c)) {
    c->control = CONTROL_UNIFORM;
    c->uniform = c->hold[0][c->particles->place_of[0]];
    places_free(&c->hold[0]);
  }
  c->pulls = 9 + (hold_is_read(c->control) ? 3 + hold_components(c->control) : 0);
  for (int kind = 0; kind < c->family->rows.kinds; ++kind) {
    failed |= !(c->row_displacement[kind] = places_array(6 * places, "row sums", error));
    failed |= !(c->row_pull[kind] = places_array(c->pulls * places, "row sums", error));
  }
  for (int k = 0; k < 3 && hold_is_read(c->control); ++k)
    failed |= !(c->held[k] = places_array(places, "zero-energy control", error));
  if (failed) {
    correspondence_destroy(c);
    return NULL;
  }
  return c;
}

void correspondence_gradient(const void *formulation, int64_t place, double f[9])
{
  const Correspondence *c = formulation;
  int64_t slice = place / SLICE;
  double moved[9] = {0};
  for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
    if (!(c->family->intact[slot] >> (place % SLICE) & 1)) continue;
    Bond bond = family_bond(c->family, slice, slot, (int)(place % SLICE));
    for (int k = 0; k < 9; ++k) {
      const double *u = c->particles->displacement[k / 3];
      moved[k] += bond.weight * (u[bond.neighbour] - u[place]) * bond.xi[k % 3];
    }
  }
  for (int k = 0; k < 9; ++k) {
    f[k] = k % 4 == 0;
    for (int j = 0; j < 3; ++j) f[k] += moved[k / 3 * 3 + j] * c->inverse[symmetric_place[3 * j + k % 3]][place];
  }
}

size_t correspondence_bytes(const void *formulation)
{
  const Correspondence *c = formulation;
  size_t numbers = 9 + 6 + 3 + 3 + 1 + (size_t)hold_components(c->control) + (hold_is_read(c->control) ? 3 : 0);
  numbers += (size_t)(c->family->rows.kinds * (6 + c->pulls));
  return (size_t)c->particles->places * (numbers * sizeof(double) + sizeof(float) + 1) +
         (size_t)c->particles->count * sizeof(int32_t);
}
