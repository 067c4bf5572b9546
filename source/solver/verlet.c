/* Passes of explicit steps over all particles, batch by batch. They wait for memory: what counts is how many numbers are read and written, and of the rows
 * that nothing moves none is. */
#include "solver/explicit.h"

#include <math.h>

void explicit_step_back(Explicit *s)
{
  const Particles *p = s->domain->particles;
  const double dt = s->clock->time_step, c = explicit_mass_damping(s);
  const double back = 1 / (1 - 0.5 * c * dt);
  vector_combine(1, &p->displacement, -dt, &p->velocity);
  vector_combine(back, &p->velocity, -0.5 * dt * back, &s->acceleration);
}

BRECCIA_CLONES
static void kick_and_drift(Explicit *s, int64_t batch)
{
  const Particles *p = s->domain->particles;
  const Lanes dt = lanes_set(s->clock->time_step), c = lanes_set(explicit_mass_damping(s)), one_half = lanes_set(0.5);
  Lanes bond = {0}, external = {0}, damping = {0}, between = {0}, still = {0};
  const double *counted = s->domain->counted;
  int64_t first = s->domain->batches[batch].first * SLICE, last = s->domain->batches[batch].last * SLICE;
  for (int r = 0; r < s->row_count; ++r) {
    const int k = s->rows[r];
    for (int64_t i = first; i < last; i += LANES) {
      Lanes v = lanes_load(p->velocity.row[k] + i), fi = lanes_load(p->internal.row[k] + i);
      Lanes fe = lanes_load(p->external.row[k] + i);
      Lanes gain = lanes_load(s->acceleration.row[k] + i) - c * v,
            drag = fi + fe - lanes_load(p->inertia.row[k] + i) * gain;
      Lanes half = v + one_half * dt * gain, du = dt * half, work = one_half * du * lanes_load(counted + i);
      bond -= fi * work;
      external += fe * work;
      damping += drag * work;
      between -= lanes_load(p->inertia.row[k] + i) * lanes_load(counted + i) * gain * gain;
      if (k < p->space.rotation) still = lanes_least(still, -lanes_absolute(du));
      lanes_store(p->displacement.row[k] + i, lanes_load(p->displacement.row[k] + i) + du);
      lanes_store(p->velocity.row[k] + i, half);
    }
  }
  double *sums = s->sums[batch];
  sums[BOND_WORK] = lanes_total(bond);
  sums[EXTERNAL_WORK] = lanes_total(external);
  sums[DAMPING_WORK] = lanes_total(damping);
  sums[BETWEEN] = s->clock->time_step * s->clock->time_step / 8 * lanes_total(between);
  sums[MOTION] = fmax(fmax(-still[0], -still[1]), fmax(-still[2], -still[3]));
}

BRECCIA_CLONES
static void kick(Explicit *s, int64_t batch)
{
  const Particles *p = s->domain->particles;
  const double c = explicit_mass_damping(s);
  const bool stiff = s->viscous.time > 0;
  const Lanes dt = lanes_set(s->clock->time_step), one_half = lanes_set(0.5), local = lanes_set(s->spec->local_damping);
  const Lanes slow = lanes_set(1 / (1 + 0.5 * c * s->clock->time_step)), viscous = lanes_set(c);
  Lanes bond = {0}, external = {0}, damping = {0}, kinetic = {0}, between = {0};
  const double *counted = s->domain->counted;
  int64_t first = s->domain->batches[batch].first * SLICE, last = s->domain->batches[batch].last * SLICE;
  for (int r = 0; r < s->row_count; ++r) {
    const int k = s->rows[r];
    for (int64_t i = first; i < last; i += LANES) {
      Lanes half = lanes_load(p->velocity.row[k] + i), fi = lanes_load(p->internal.row[k] + i);
      Lanes fe = lanes_load(p->external.row[k] + i), density = lanes_load(p->inertia.row[k] + i);
      Lanes volume = lanes_load(counted + i), force = fi + fe, size = local * lanes_absolute(force);
      Lanes drag = lanes_where(half > lanes_set(0), size) - lanes_where(half < lanes_set(0), size);
      if (stiff) drag += lanes_load(s->viscous.drag.row[k] + i);
      Lanes acceleration = (force - drag) / density, end = (half + one_half * dt * acceleration) * slow;
      Lanes work = one_half * dt * half * volume;
      bond -= fi * work;
      external += fe * work;
      damping += (drag + viscous * density * end) * work;
      kinetic += one_half * density * volume * end * end;
      Lanes gain = acceleration - viscous * end;
      between += density * volume * gain * gain;
      lanes_store(s->acceleration.row[k] + i, acceleration);
      lanes_store(p->velocity.row[k] + i, end);
    }
  }
  double *sums = s->sums[batch];
  sums[BOND_WORK] += lanes_total(bond);
  sums[EXTERNAL_WORK] += lanes_total(external);
  sums[DAMPING_WORK] += lanes_total(damping);
  sums[BETWEEN] += s->clock->time_step * s->clock->time_step / 8 * lanes_total(between);
  sums[KINETIC] = lanes_total(kinetic);
}

/* Clones of functions that other files see would be among the names that the library exports. */

void explicit_kick_and_drift(Explicit *s, int64_t batch)
{
  kick_and_drift(s, batch);
}

void explicit_kick(Explicit *s, int64_t batch)
{
  kick(s, batch);
}
