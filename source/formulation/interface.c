#include "formulation/interface.h"

#include "base/memory.h"
#include "base/team.h"
#include "base/tensor.h"

#include <math.h>
#include <stdlib.h>

static const Material *interface_material(const Interfaces *i, int64_t place)
{
  return &i->parts.materials[i->parts.material[place / SLICE]];
}

static bool interface_law_is_linear(const Material *m)
{
  return m->law->linear && material_is_unlimited(m);
}

bool interfaces_join(const Material *one, const Material *other)
{
  return interface_law_is_linear(one) && interface_law_is_linear(other) && !material_is_as_stiff(one, other);
}

/** Returns true if a place belongs to the formulation and its law is linear without a limit. */
static bool interface_is_linear(const Interfaces *i, int64_t place)
{
  return !is_foreign(i->parts.foreign, place) && interface_law_is_linear(interface_material(i, place));
}

/** Returns true if two places have linear laws of different stiffness. */
static bool interface_is_unlike(const Interfaces *i, int64_t one, int64_t other)
{
  const int32_t *material = i->parts.material;
  return material[one / SLICE] != material[other / SLICE] && !is_foreign(i->parts.foreign, one) &&
         !is_foreign(i->parts.foreign, other) &&
         interfaces_join(interface_material(i, one), interface_material(i, other));
}

static double interface_modulus(const Interfaces *i, int64_t place)
{
  return i->modulus[i->parts.particles->block[place / SLICE]];
}

/* ---- pieces of a bond ---- */

/** A walk along a bond through the cells of particles. The wall of two cells has equal differences of squared distance
 *  and squared radius, so that it touches both spheres. */
typedef struct InterfaceWalk {
  double from[3], xi[3]; /* position of the first end; vector to the second one */
  int64_t place;         /* particle of the present cell */
  double at;             /* share of the bond's length that lies behind */
} InterfaceWalk;

/** Returns the share of the bond's length at which the walk meets the wall of the cell of another particle, or
 *  INFINITY. @param[out] slope  speed at which the walk enters that cell */
static double interface_wall(const Interfaces *i, const InterfaceWalk *w, int64_t other, double *slope)
{
  double *const *x = i->parts.particles->position;
  double ahead = 0, apart = pow(i->radius[w->place], 2) - pow(i->radius[other], 2);
  for (int k = 0; k < 3; ++k) {
    const double own = x[k][w->place] - w->from[k], there = x[k][other] - w->from[k];
    ahead += 2 * (there - own) * w->xi[k];
    apart += there * there - own * own;
  }
  *slope = ahead;
  return ahead > 0 ? apart / ahead : INFINITY;
}

static const double interface_tie = 1e-9; /* shares of a bond's length that differ by less are alike */

/** Goes on to the next cell. @return share of the bond's length in the present one */
static double interface_step(const Interfaces *i, InterfaceWalk *w, int64_t low, int64_t high)
{
  const double tie = interface_tie;
  const Family *f = i->parts.family;
  const int64_t slice = low / SLICE;
  double least = INFINITY, steepest = 0, slope = 0;
  int64_t next = high;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> low % SLICE & 1)) continue;
    const int64_t other = family_bond(f, slice, slot, (int)(low % SLICE)).neighbour;
    const double wall = other == w->place ? INFINITY : interface_wall(i, w, other, &slope);
    if (!(wall > w->at - tie) || wall > least + tie || (wall > least - tie && slope <= steepest)) continue;
    least = wall;
    steepest = slope;
    next = other;
  }
  const double end = fmin(1, fmax(w->at, least)), piece = end - w->at;
  w->at = least < 1 ? end : 1;
  w->place = next;
  return piece;
}

/** Returns the stiffness of the pieces of a bond in series over the mean of both ends' stiffness; 1 if the bond lies in
 *  one material, if a law on its way is not linear, or if it passes through too many cells. */
static double interface_series_of(const Interfaces *i, int64_t one, int64_t other)
{
  enum { MOST_CELLS = 100 };
  const int64_t low = one < other ? one : other, high = one < other ? other : one;
  double *const *x = i->parts.particles->position;
  InterfaceWalk w = {.place = low};
  for (int k = 0; k < 3; ++k) {
    w.from[k] = x[k][low];
    w.xi[k] = x[k][high] - x[k][low];
  }
  bool unlike = interface_is_unlike(i, low, high);
  double compliance = 0;
  for (int n = 0; n < MOST_CELLS && w.at < 1; ++n) {
    const int64_t place = w.place;
    const double piece = interface_step(i, &w, low, high);
    compliance += piece / interface_modulus(i, place);
    if (piece <= interface_tie) continue;
    unlike |= interface_is_unlike(i, low, place);
    if (!interface_is_linear(i, place)) return 1;
  }
  if (w.at < 1) return 1;
  return unlike ? 2 / (compliance * (interface_modulus(i, low) + interface_modulus(i, high))) : 1;
}

static void interface_find_near(void *context, int64_t place)
{
  const Interfaces *i = context;
  const Family *f = i->parts.family;
  const int64_t slice = place / SLICE;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1] && !i->near[place]; ++slot)
    if (f->intact[slot] >> place % SLICE & 1)
      i->near[place] = interface_is_unlike(i, place, family_bond(f, slice, slot, (int)(place % SLICE)).neighbour);
}

static void interface_find_radius(void *context, int64_t place)
{
  const Interfaces *i = context;
  const double volume = i->parts.particles->volume[place] / body_section(i->parts.body);
  const int dimensions = i->parts.body->dimensions;
  i->radius[place] = (dimensions == 3 ? cbrt(volume) : dimensions == 2 ? sqrt(volume) : volume) / 2;
}

static void interface_find_series(void *context, int64_t slice)
{
  const Interfaces *i = context;
  const Family *f = i->parts.family;
  if (!i->series[slice]) return;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t place = slice * SLICE + lane;
      float *series = &i->series[slice][(slot - f->first[slice]) * SLICE + lane];
      *series = 1;
      if (!(f->intact[slot] >> lane & 1) || !i->near[place]) continue;
      const int32_t other = family_bond(f, slice, slot, lane).neighbour;
      if (i->near[other]) *series = (float)interface_series_of(i, place, other);
    }
}

/* ---- normals ---- */

/** Returns a smooth step from 0 at `low` to 1 at `high`. */
static double interface_smooth(double low, double high, double x)
{
  const double t = fmin(1, fmax(0, (x - low) / (high - low)));
  return t * t * (3 - 2 * t);
}

/** Computes the sum of the vectors from a place to its nearest neighbours of another stiffness. */
static void interface_contact(const Interfaces *i, int64_t place, double contact[3])
{
  const double nearest = 1.15, far = 1.4; /* [spacings] between nearest neighbours and diagonals of a square lattice */
  const Family *f = i->parts.family;
  const int64_t slice = place / SLICE;
  for (int k = 0; k < 3; ++k) contact[k] = 0;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    if (!interface_is_unlike(i, place, bond.neighbour)) continue;
    const double spacing = i->radius[place] + i->radius[bond.neighbour],
                 weight = 1 - interface_smooth(nearest, far, bond.length / spacing);
    for (int k = 0; k < 3; ++k) contact[k] += weight * bond.xi[k];
  }
}

/** Adds v v of a place to a symmetric tensor. */
static void interface_add_contact(const Interfaces *i, int64_t place, double tensor[9])
{
  double v[3];
  if (!i->near[place]) return;
  interface_contact(i, place, v);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) tensor[3 * r + c] += v[r] * v[c];
}

/** Squares a symmetric tensor and divides the result by its trace. */
static void interface_square(double tensor[9])
{
  double square[9] = {0}, trace = 0;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) square[3 * r + c] += tensor[3 * r + k] * tensor[3 * k + c];
  for (int k = 0; k < 3; ++k) trace += square[4 * k];
  for (int k = 0; k < 9; ++k) tensor[k] = square[k] / trace;
}

/** Finds the normal of the interface at a place: the direction that most contacts in the family have. Where contacts
 *  have many directions there is no normal. */
static void interface_find_normal(void *context, int64_t place)
{
  enum { SQUARINGS = 8 };
  const double least = 0.75; /* share of the contacts, by their squares, along the normal */
  const Interfaces *i = context;
  const Family *f = i->parts.family;
  const int64_t slice = place / SLICE;
  double tensor[9] = {0}, power[9], trace = 0, along = 0, *normal = i->normal[place];
  if (!i->near[place]) return;
  interface_add_contact(i, place, tensor);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    if (f->intact[slot] >> place % SLICE & 1)
      interface_add_contact(i, family_bond(f, slice, slot, (int)(place % SLICE)).neighbour, tensor);
  for (int k = 0; k < 3; ++k) trace += tensor[4 * k];
  if (!(trace > 0)) return;
  for (int k = 0; k < 9; ++k) power[k] = tensor[k] / trace;
  for (int n = 0; n < SQUARINGS; ++n) interface_square(power);
  int row = 0; /* of the projection on the normal, whose largest row is the best */
  for (int k = 1; k < 3; ++k)
    if (power[4 * k] > power[4 * row]) row = k;
  const double length = sqrt(power[4 * row]);
  for (int k = 0; k < 3; ++k) normal[k] = power[3 * row + k] / length;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) along += normal[r] * tensor[3 * r + c] * normal[c];
  if (along < least * trace)
    for (int k = 0; k < 3; ++k) normal[k] = 0;
}

/* ---- making ---- */

/** Returns true if two linear laws of the body have different stiffness. */
static bool interface_is_possible(const FormulationParts *parts)
{
  for (int a = 0; a < parts->material_count; ++a)
    for (int b = 0; b < a; ++b)
      if (interfaces_join(&parts->materials[a], &parts->materials[b])) return !parts->may_break;
  return false;
}

static int interface_make_series(Interfaces *i, Error *error)
{
  const Family *f = i->parts.family;
  const int64_t slices = i->parts.particles->slices;
  for (int64_t pass = 0; pass < 2; ++pass) {
    size_t count = 0;
    for (int64_t slice = 0; slice < slices; ++slice) {
      bool any = false;
      for (int lane = 0; lane < SLICE; ++lane) any |= i->near[slice * SLICE + lane] != 0;
      if (!any) continue;
      if (pass) i->series[slice] = i->all + count;
      count += (size_t)(f->first[slice + 1] - f->first[slice]) * SLICE;
    }
    i->count = count;
    if (pass || !count) continue;
    i->all = memory_zeroed(count, sizeof *i->all, "interfaces of bonds", error);
    i->series = memory_zeroed((size_t)slices, sizeof *i->series, "interfaces of bonds", error);
    if (!i->all || !i->series) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

int interfaces_create(Interfaces *i, const FormulationParts *parts, const double *modulus, Error *error)
{
  const int64_t places = parts->particles->places;
  *i = (Interfaces){.parts = *parts, .modulus = modulus};
  if (!interface_is_possible(parts)) return BRECCIA_OK;
  i->near = memory_zeroed((size_t)places, sizeof *i->near, "interfaces of bonds", error);
  if (!i->near) return BRECCIA_FAILURE;
  team_each(places, interface_find_near, i);
  if (interface_make_series(i, error)) return BRECCIA_FAILURE;
  if (!i->series) return BRECCIA_OK;
  i->normal = memory_zeroed((size_t)places, sizeof *i->normal, "interfaces of bonds", error);
  i->radius = memory_zeroed((size_t)places, sizeof *i->radius, "interfaces of bonds", error);
  if (!i->normal || !i->radius) return BRECCIA_FAILURE;
  team_each(places, interface_find_radius, i);
  team_each(parts->particles->slices, interface_find_series, i);
  team_each(places, interface_find_normal, i);
  return BRECCIA_OK;
}

void interfaces_destroy(Interfaces *i)
{
  free(i->near);
  free(i->series);
  free(i->all);
  free(i->radius);
  free(i->normal);
  *i = (Interfaces){0};
}

/* ---- bonds along interfaces ---- */

/** Returns the square of the component of a bond's direction along the normal at a place; 1 without a normal. */
static double interface_across(const Interfaces *i, int64_t place, const Bond *bond)
{
  const double *n = i->normal[place];
  double along = 0, square = 0;
  for (int k = 0; k < 3; ++k) {
    along += n[k] * bond->xi[k] / bond->length;
    square += n[k] * n[k];
  }
  return square > 0 ? along * along : 1;
}

double interfaces_along(const Interfaces *i, int64_t place, const Bond *bond)
{
  const double most = 0.1; /* sine of the angle with the interface */
  const double across = fmax(interface_across(i, place, bond), interface_across(i, bond->neighbour, bond));
  const bool inside = interface_is_linear(i, bond->neighbour) && !interface_is_unlike(i, place, bond->neighbour);
  return inside ? 1 - interface_smooth(0, most, sqrt(across)) : 0;
}

bool interfaces_cross_rows(const Interfaces *i)
{
  const Family *f = i->parts.family;
  int64_t places = 0, without = 0;
  for (int64_t place = 0; i->normal && place < i->parts.particles->places; ++place) {
    const double *n = i->normal[place];
    if (!i->near[place] || n[0] * n[0] + n[1] * n[1] + n[2] * n[2] == 0) continue;
    const int64_t slice = place / SLICE;
    bool along = false;
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1] && !along; ++slot) {
      if (!(f->intact[slot] >> place % SLICE & 1)) continue;
      const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
      along = interfaces_along(i, place, &bond) > 0;
    }
    ++places;
    without += !along;
  }
  return 10 * without > places;
}

void interfaces_describe(Text *text)
{
  text_add(text,
           "  elastic interfaces cross rows of particles, where bonds along them are missing: a block with such an "
           "interface, of contrast 10, came out 7 %% off in stretch and 10 %% off in shear; turn the block, so that "
           "rows lie along the interface\n");
}

/** Returns the elongation of a unit bond, or its square, averaged over the directions of a unit strain along the
 *  interface. @param[in] across  square of the component of the bond's direction along the normal */
static double interface_elongation(const InterfaceSum *sum, int dimensions, double poisson, double across)
{
  const double along = 1 - across, contracted = poisson * across;
  if (dimensions == 2) return sum->power == 2 ? pow(along - contracted, 2) : along - contracted;
  return sum->power == 2 ? 3.0 / 8 * along * along - along * contracted + contracted * contracted
                         : along / 2 - contracted;
}

/** Returns the contraction across the interface per strain along it of the bonds of a family. */
static double interface_contraction(const Interfaces *i, int64_t place, const InterfaceSum *sum)
{
  const Family *f = i->parts.family;
  const int64_t slice = place / SLICE;
  double mixed = 0, square = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    const double weight = sum->measure(sum->formulation, slice, slot, (int)(place % SLICE), &bond).weight,
                 across = interface_across(i, place, &bond);
    mixed += weight * across * (1 - across) / (i->parts.body->dimensions - 1);
    square += weight * across * across;
  }
  return square > 0 ? mixed / square : 0;
}

double interfaces_lack(const Interfaces *i, int64_t place, const InterfaceSum *sum)
{
  const double least = -0.9, most = 10;
  const Family *f = i->parts.family;
  const int64_t slice = place / SLICE;
  const int dimensions = i->parts.body->dimensions;
  double missing = 0, rows = 0;
  if (!i->near[place] || dimensions < 2 || !interface_is_linear(i, place)) return 0;
  const double poisson = isnan(sum->poisson) ? interface_contraction(i, place, sum) : sum->poisson;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    const InterfaceShare of = sum->measure(sum->formulation, slice, slot, (int)(place % SLICE), &bond);
    const double across = interface_across(i, place, &bond);
    missing += of.weight * (1 - of.share) * interface_elongation(sum, dimensions, poisson, across);
    rows += of.weight * interfaces_along(i, place, &bond) * interface_elongation(sum, dimensions, poisson, 0);
  }
  return rows > 0 ? fmax(least, fmin(most, missing / rows)) : 0;
}
