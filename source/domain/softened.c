#include "domain/softened.h"

#include <math.h>
#include <string.h>

/* Round-off of damage: a point is damaged above this value, and carries nothing above 1 less this value. */
static const double softened_round_off = 1e-9;

/** Returns true if a history number of a material is a damage. */
static bool softened_has_damage(const Material *m)
{
  for (int k = 0; k < m->history_values && m->law->history_is_damage; ++k)
    if (m->law->history_is_damage(m->constants, k)) return true;
  return false;
}

/** Returns the largest damage among the history numbers of a row of points; NaN if none is a damage. */
static double softened_of_row(const Points *points, int64_t row)
{
  const Material *m = points_material(points, row);
  const double *history = points_history(points, row);
  double damage = NAN;
  for (int k = 0; k < m->history_values && m->law->history_is_damage; ++k)
    if (m->law->history_is_damage(m->constants, k)) damage = fmax(damage, history[k]);
  return damage;
}

/** Returns true if the first of two points is to be listed before the second. */
static bool softened_is_worse(const SoftenedPoint *a, const SoftenedPoint *b)
{
  if (a->damage != b->damage) return a->damage > b->damage;
  if (a->opening != b->opening && !isnan(a->opening) && !isnan(b->opening)) return a->opening > b->opening;
  return a->particles[0] != b->particles[0] ? a->particles[0] < b->particles[0] : a->particles[1] < b->particles[1];
}

/** Counts a point, and inserts it into the list of the most damaged ones if it belongs there. */
static void softened_take(SoftenedPoints *found, const SoftenedPoint *point)
{
  ++found->total;
  if (!(point->damage > softened_round_off)) return;
  ++found->softened;
  found->spent += point->damage >= 1 - softened_round_off;
  int at = found->listed;
  while (at > 0 && softened_is_worse(point, &found->worst[at - 1])) --at;
  if (at == SOFTENED_LISTED) return;
  if (found->listed < SOFTENED_LISTED) ++found->listed;
  memmove(found->worst + at + 1, found->worst + at, sizeof *found->worst * (size_t)(found->listed - at - 1));
  found->worst[at] = *point;
}

/** Returns the elongation of a bond [length]. */
static double softened_opening(const Particles *p, int64_t place, const Bond *bond)
{
  double length = 0;
  for (int k = 0; k < 3; ++k) {
    const double y = bond->xi[k] + p->displacement.row[k][bond->neighbour] - p->displacement.row[k][place];
    length += y * y;
  }
  return sqrt(length) - bond->length;
}

/** Returns the damage of an intact bond: the larger damage of its one or two points, or the damage that a formulation
 *  without points stores; NaN if the bond has neither. */
static double softened_of_bond(const Domain *d, const Region *region, int64_t slice, int64_t slot, int lane)
{
  if (!region->points.components)
    return region->type->bond_damage ? region->type->bond_damage(region->formulation, slice, slot, lane) : NAN;
  int64_t rows[2];
  bond_list_rows(&region->bonds, &d->family, slice, slot, lane, rows);
  const double first = softened_of_row(&region->points, rows[0]);
  return rows[1] == rows[0] ? first : fmax(first, softened_of_row(&region->points, rows[1]));
}

/** Counts the intact bonds of a particle to particles with higher numbers. */
static void softened_take_bonds(const Domain *d, const Region *region, int64_t place, SoftenedPoints *found)
{
  const Particles *p = d->particles;
  const Family *f = &d->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    const int32_t ends[2] = {(int32_t)p->number[place], (int32_t)p->number[bond.neighbour]};
    if (ends[1] < ends[0] || (body_outside(&d->body, ends[0]) && body_outside(&d->body, ends[1]))) continue;
    const double damage = softened_of_bond(d, region, slice, slot, lane);
    if (isnan(damage)) continue;
    SoftenedPoint point = {
        .particles = {ends[0], ends[1]}, .damage = damage, .opening = softened_opening(p, place, &bond)};
    domain_bond_middle(d, ends, point.position);
    softened_take(found, &point);
  }
}

/** Counts the material point of a particle. */
static void softened_take_particle(const Domain *d, const Region *region, int64_t place, SoftenedPoints *found)
{
  const Particles *p = d->particles;
  const int32_t number = (int32_t)p->number[place];
  const double damage = softened_of_row(&region->points, place);
  if (isnan(damage) || body_outside(&d->body, number)) return;
  SoftenedPoint point = {.particles = {number, number}, .damage = damage, .opening = NAN};
  for (int k = 0; k < 3; ++k) point.position[k] = p->position[k][place];
  softened_take(found, &point);
}

/** Returns true if a law of the body has a damage among its history numbers. */
static bool softened_may_be(const Domain *d)
{
  for (int k = 0; k < d->material_count; ++k)
    if (softened_has_damage(&d->materials[k])) return true;
  return false;
}

const char *domain_softening_noun(const Domain *d)
{
  if (!softened_may_be(d)) return NULL;
  int particles = 0, links = 0;
  for (int r = 0; r < d->region_count; ++r) {
    particles += points_on_particles(&d->regions[r].points);
    links += d->regions[r].type->bond_damage != NULL;
  }
  return particles ? "material points" : links == d->region_count ? "links" : "bonds";
}

/** Goes through all points, or only until one is damaged. */
static void softened_go_through(const Domain *d, bool only_first, SoftenedPoints *found)
{
  *found = (SoftenedPoints){0};
  if (!softened_may_be(d)) return;
  for (int64_t n = 0; n < d->particles->count && !(only_first && found->softened); ++n) {
    const int64_t place = d->particles->place_of[n];
    const Region *region = domain_region(d, place);
    if (points_on_particles(&region->points))
      softened_take_particle(d, region, place, found);
    else
      softened_take_bonds(d, region, place, found);
  }
}

void domain_find_softened(const Domain *d, SoftenedPoints *found)
{
  softened_go_through(d, false, found);
}

bool domain_has_softened(const Domain *d)
{
  SoftenedPoints found;
  softened_go_through(d, true, &found);
  return found.softened > 0;
}
