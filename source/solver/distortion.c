#include "solver/distortion.h"

#include <math.h>

static const double most_apart = 100; /* sizes of the body */

static double distortion_determinant(const Domain *d, int32_t place)
{
  double f[9];
  const Region *region = domain_region(d, place);
  region->type->gradient(region->formulation, place, f);
  return f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) + f[2] * (f[3] * f[7] - f[4] * f[6]);
}

/** Returns true if a particle of a complete family is turned inside out. Fewer bonds than six are those of a truss,
 * whose joints may snap through. */
static bool distortion_is_inverted(const Domain *d, int64_t n)
{
  const int few = 6;
  const int32_t place = d->particles->place_of[n];
  return !body_outside(&d->body, n) && domain_damage(d, place) == 0 && family_count(&d->family, place) >= few &&
         !(distortion_determinant(d, place) > 0);
}

int64_t distortion_inverted(const Domain *d, int32_t *first)
{
  int64_t count = 0;
  for (int64_t n = 0; n < d->particles->count; ++n)
    if (distortion_is_inverted(d, n) && !count++) *first = d->particles->place_of[n];
  return count;
}

/** Returns true if a particle has lost so much stiffness that it can invert without resistance. The stiffness is
 * that of the particle's law, or the mean over the laws of its bonds. Laws that flow keep their stiffness. */
static bool distortion_may_be_spent(const Domain *d, int32_t place)
{
  const double damage = 0.5, mean_damage = 0.1; /* thresholds: of a point; mean over all bonds of a family */
  const Points *points = &domain_region(d, place)->points;
  const Material *m = &d->materials[d->material[place / SLICE]];
  const double most = points_on_particles(points) ? damage : mean_damage;
  if (d->gave_up && d->gave_up[place]) return true;
  for (int k = 0; k < m->history_values && m->law->history_is_damage; ++k)
    if (m->law->history_is_damage(m->constants, k) && domain_history(d, place, k) > most) return true;
  return false;
}

/** Returns the largest difference of displacements along one axis between particles with bonds. */
static double distortion_apart(const Domain *d)
{
  const Particles *p = d->particles;
  double most = 0;
  for (int k = 0; k < 3; ++k) {
    double low = INFINITY, high = -INFINITY;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      if (!family_count(&d->family, i)) continue;
      low = fmin(low, p->displacement.row[k][i]);
      high = fmax(high, p->displacement.row[k][i]);
    }
    most = fmax(most, high - low);
  }
  return most;
}

static double distortion_size(const Domain *d)
{
  double low[3], high[3], size = d->body.largest_spacing;
  particles_bounds(d->particles, low, high);
  for (int k = 0; k < 3; ++k) size = fmax(size, high[k] - low[k]);
  return size;
}

int32_t distortion_first_impossible(const Domain *d)
{
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t i = d->particles->place_of[n];
    if (distortion_is_inverted(d, n) && !distortion_may_be_spent(d, i)) return i;
  }
  return -1;
}

int distortion_watch(const Domain *d, const Clock *clock, bool rests, const char *loads, Error *error)
{
  const Particles *p = d->particles;
  const double apart = distortion_apart(d), size = distortion_size(d);
  if (d->broken_count == 0 && apart > most_apart * size) /* pieces that have broken off may fly as far as they like */
    return error_add(
        error, BRECCIA_FAILURE,
        "step %lld (time %g %s): particles have moved apart by %.3g, %.3g sizes of the body, and more than "
        "%g are taken for a mistake; look at motions, loads and their units%s",
        (long long)clock->step, clock->time, clock->time_unit, apart, apart / size, most_apart, loads);
  const int32_t i = distortion_first_impossible(d);
  if (i < 0) return BRECCIA_OK;
  return error_add(error, BRECCIA_FAILURE,
                   "step %lld (time %g %s): particle %d at [%.4g, %.4g, %.4g] is turned inside out (det F = %.3g), "
                   "and no body can be deformed so; %s%s",
                   (long long)clock->step, clock->time, clock->time_unit, p->number[i], p->position[0][i],
                   p->position[1][i], p->position[2][i], distortion_determinant(d, i),
                   rests ? "the body has failed before: take smaller 'increments' to find the load that it bears, or "
                           "look at motions, loads and their units"
                         : "look at motions, loads and their units, or take smaller steps",
                   loads);
}
