/* Points that begin under stress: the strain at which a law has it is found once, and added from then on to the strains that the law is given. */
#include "constitutive/driver.h"
#include "points/points.h"

#include <math.h>
#include <string.h>

static const bool all_by_stress[6] = {true, true, true, true, true, true};

/** Whether a law that responds as given has the stress to which it was led; nothing is committed. */
static bool keeps(Driver *d, const double target[6], double tolerance)
{
  d->elastic = false;
  double square = driver_try(d, d->strain) ? 0 : NAN;
  for (int k = 0; k < 6; ++k) square += (d->stress[k] - target[k]) * (d->stress[k] - target[k]);
  return sqrt(square) <= tolerance;
}

/** Elastically, as weight builds up in an elastic stage; where that leads beyond yielding, along the law's own path, by which it hardens.
 *  @param[in,out] d  just made; then of the way that went well, or of the law's own */
static bool lead(Driver *d, const Material *m, const double target[6], Error *error)
{
  double square = 0;
  for (int k = 0; k < 6; ++k) square += target[k] * target[k];
  const double tolerance = 1e-9 * sqrt(square);
  d->elastic = true;
  if (driver_step(d, all_by_stress, target, tolerance) && keeps(d, target, tolerance)) return true;
  driver_destroy(d);
  return driver_create(d, m, error) == BRECCIA_OK && driver_step(d, all_by_stress, target, tolerance) &&
         keeps(d, target, tolerance);
}

bool points_law_keeps(const Material *m, const double stress[6])
{
  double square = 0;
  Driver d = {0};
  for (int k = 0; k < 6; ++k) square += stress[k] * stress[k];
  const double tolerance = 1e-9 * sqrt(square);
  const bool made = driver_create(&d, m, NULL) == BRECCIA_OK;
  d.elastic = true;
  const bool kept = !made || !driver_step(&d, all_by_stress, stress, tolerance) || keeps(&d, stress, tolerance);
  driver_destroy(&d);
  return kept;
}

/** Laws that were led to a stress, of the material that is worked on: rows of a lattice often lie at few depths. */
enum { LED = 16 };
typedef struct Led {
  double target[LED][6];
  Driver driver[LED];
  int count, next;
} Led;

static void forget_led(Led *led)
{
  for (int k = 0; k < led->count; ++k) driver_destroy(&led->driver[k]);
  led->count = led->next = 0;
}

/** @param[out] found  that of the stress; where the law does not bear it, as far as it came. NULL without memory
 *  @return BRECCIA_USER_ERROR where it does not */
static int lead_to(Led *led, const Material *m, const double target[6], const Driver **found, Error *error)
{
  *found = NULL;
  for (int k = 0; k < led->count && !*found; ++k)
    if (!memcmp(led->target[k], target, sizeof led->target[k])) *found = &led->driver[k];
  if (*found) return BRECCIA_OK;
  const int at = led->next;
  if (at < led->count)
    driver_destroy(&led->driver[at]);
  else
    ++led->count;
  led->next = (at + 1) % LED;
  memcpy(led->target[at], target, sizeof led->target[at]);
  led->driver[at] = (Driver){0};
  if (driver_create(&led->driver[at], m, error)) return BRECCIA_FAILURE;
  *found = &led->driver[at];
  return lead(&led->driver[at], m, target, error) ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

int points_begin_under(Points *points, double *const stress[6], double *const strain[6], InitialMisfit *misfit,
                       Error *error)
{
  int status = BRECCIA_OK;
  Led led = {0};
  misfit->row = -1;
  for (int64_t n = 0; n < points->run_count && !status; ++n) {
    const PointsRun *run = &points->runs[n];
    const Material *m = &points->materials[run->material];
    if (n && run->material != points->runs[n - 1].material) forget_led(&led);
    for (int64_t row = run->first; row < run->first + run->count && !status; ++row) {
      double target[6], square = 0;
      for (int k = 0; k < 6; ++k) {
        target[k] = stress[k][row];
        square += target[k] * target[k];
      }
      if (square == 0) continue;
      const Driver *d;
      status = lead_to(&led, m, target, &d, error);
      if (status == BRECCIA_USER_ERROR) {
        misfit->row = row;
        memcpy(misfit->reached, d->stress, sizeof misfit->reached);
      }
      for (int k = 0; k < 6 && !status; ++k) strain[k][row] = d->strain[k];
      if (!status)
        memcpy(points->committed + points->history_first[n] + (row - run->first) * m->history_values, d->committed,
               sizeof(double) * (size_t)m->history_values);
    }
  }
  forget_led(&led);
  if (status) return status;
  for (int k = 0; k < 6; ++k) points->initial[k] = strain[k];
  points_take_up(points);
  return BRECCIA_OK;
}
