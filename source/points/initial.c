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

int points_begin_under(Points *points, double *const stress[6], double *const strain[6], InitialMisfit *misfit,
                       Error *error)
{
  int status = BRECCIA_OK;
  misfit->row = -1;
  for (int64_t n = 0; n < points->run_count && !status; ++n) {
    const PointsRun *run = &points->runs[n];
    const Material *m = &points->materials[run->material];
    double last[6] = {0};
    Driver d = {0};
    for (int64_t row = run->first; row < run->first + run->count && !status; ++row) {
      double target[6], square = 0;
      for (int k = 0; k < 6; ++k) {
        target[k] = stress[k][row];
        square += target[k] * target[k];
      }
      if (square == 0) continue;
      if (!d.committed || memcmp(target, last, sizeof last)) { /* rows of a lattice often lie at one depth */
        driver_destroy(&d);
        status = driver_create(&d, m, error);
        if (!status && !lead(&d, m, target, error)) {
          misfit->row = row;
          memcpy(misfit->reached, d.stress, sizeof misfit->reached);
          status = BRECCIA_USER_ERROR;
        }
        memcpy(last, target, sizeof last);
      }
      for (int k = 0; k < 6 && !status; ++k) strain[k][row] = d.strain[k];
      if (!status)
        memcpy(points->committed + points->history_first[n] + (row - run->first) * m->history_values, d.committed,
               sizeof(double) * (size_t)m->history_values);
    }
    driver_destroy(&d);
  }
  if (status) return status;
  for (int k = 0; k < 6; ++k) points->initial[k] = strain[k];
  points_take_up(points);
  return BRECCIA_OK;
}
