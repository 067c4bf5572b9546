#include "constitutive/driver.h"

#include "base/linear.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** The one point is in the first server; others have none. */
static int begin_in_server(Driver *d, Error *error)
{
  Remote *r = d->material->remote;
  int64_t *starts = memory_zeroed((size_t)remote_servers(r) + 1, sizeof *starts, "servers", error);
  if (!starts) return BRECCIA_FAILURE;
  for (int k = 1; k <= remote_servers(r); ++k) starts[k] = 1;
  const int status = remote_begin(r, starts, error);
  free(starts);
  d->committed[0] = d->trial[0] = 0;
  return status;
}

int driver_create(Driver *d, const Material *material, Error *error)
{
  const size_t values = (size_t)material->history_values + 1;
  *d = (Driver){.material = material, .components = material->law->components};
  d->committed = memory_zeroed(values, sizeof(double), "history", error);
  d->trial = memory_zeroed(values, sizeof(double), "history", error);
  int status = d->committed && d->trial ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status && material->law->begin) {
    material->law->begin(material->constants, d->committed);
    material->law->begin(material->constants, d->trial);
  }
  if (!status && material->remote) status = begin_in_server(d, error);
  if (status) driver_destroy(d);
  return status;
}

void driver_destroy(Driver *d)
{
  free(d->committed);
  free(d->trial);
  *d = (Driver){0};
}

bool driver_try(Driver *d, const double *strain)
{
  breccia_batch batch = {.size = sizeof(breccia_batch),
                         .count = 1,
                         .committed = d->committed,
                         .trial = d->trial,
                         .tangent = d->tangent,
                         .time = d->time + d->time_step,
                         .time_step = d->time_step,
                         .elastic_stage = d->elastic};
  if (strain != d->strain) memcpy(d->strain, strain, sizeof(double) * (size_t)d->components);
  for (int k = 0; k < d->components; ++k) {
    batch.strain[k] = &d->strain[k];
    batch.stress[k] = &d->stress[k];
  }
  return material_update(d->material, &batch) < 0;
}

void driver_commit(Driver *d)
{
  double *other = d->committed;
  d->committed = d->trial;
  d->trial = other;
  d->time += d->time_step;
  if (d->material->remote) remote_commit(d->material->remote);
}

/** Stress residual of the unknown strains; NaN if the law gives up. */
static double residual(Driver *d, const double *strain, const int *unknown, int count, const double *target, double *r)
{
  double sum = 0;
  if (!driver_try(d, strain)) return NAN;
  for (int k = 0; k < count; ++k) {
    r[k] = target[unknown[k]] - d->stress[unknown[k]];
    sum += r[k] * r[k];
  }
  return sqrt(sum);
}

static bool balance(Driver *d, const bool *by_stress, const double *target, double tolerance)
{
  enum { MOST_ITERATIONS = 60 };
  int unknown[6], count = 0;
  double strain[6], r[6];
  for (int k = 0; k < d->components; ++k) {
    strain[k] = by_stress[k] ? d->strain[k] : target[k];
    if (by_stress[k]) unknown[count++] = k;
  }
  double size = residual(d, strain, unknown, count, target, r);
  for (int iteration = 0; size > tolerance && iteration < MOST_ITERATIONS; ++iteration) {
    /* Where flow leaves a strain free (perfect plasticity at an edge) a touch of stiffness picks the least change. */
    const double touch = 1e-8 * (d->material->bulk + d->material->shear);
    double matrix[36], step[6];
    for (int i = 0; i < count; ++i) {
      step[i] = r[i];
      for (int k = 0; k < count; ++k)
        matrix[count * i + k] = d->tangent[d->components * unknown[i] + unknown[k]] + (i == k ? touch : 0);
    }
    if (!linear_solve(count, matrix, 1, step)) return false;
    for (int k = 0; k < count; ++k) strain[unknown[k]] += step[k];
    size = residual(d, strain, unknown, count, target, r);
  }
  return size <= tolerance;
}

bool driver_step(Driver *d, const bool *by_stress, const double *target, double tolerance)
{
  enum { MOST_PARTS = 1024 };
  const double whole = d->time_step;
  double from[6], before[6];
  memcpy(before, d->strain, sizeof before);
  for (int k = 0; k < d->components; ++k) from[k] = by_stress[k] ? d->stress[k] : d->strain[k];
  int done = 0, part = MOST_PARTS; /* in 1 / MOST_PARTS of the step */
  while (done < MOST_PARTS) {
    double aim[6];
    if (part > MOST_PARTS - done) part = MOST_PARTS - done;
    const double share = (double)(done + part) / MOST_PARTS;
    d->time_step = whole * part / MOST_PARTS;
    for (int k = 0; k < d->components; ++k)
      aim[k] = done + part == MOST_PARTS ? target[k] : from[k] + share * (target[k] - from[k]);
    if (balance(d, by_stress, aim, tolerance)) {
      driver_commit(d);
      memcpy(before, d->strain, sizeof before);
      done += part;
      continue;
    }
    driver_try(d, before);
    if (part == 1) break;
    part = part > 3 ? part / 4 : 1;
    memcpy(d->strain, before, sizeof before);
  }
  d->time_step = whole;
  return done == MOST_PARTS;
}
