/* An explicit step that has come to forces that are no numbers, or to no forces at all. */
#include "solver/explicit.h"

#include <math.h>
#include <stdio.h>

static int32_t first_bad_particle(const Particles *p)
{
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < p->space.rows; ++k)
      if (!isfinite(p->internal.row[k][p->place_of[n]])) return p->place_of[n];
  return p->place_of[0];
}

/** Which law could not be integrated, and at which strain. */
static const char *describe_failed_law(const Domain *d, int64_t place, char *words, size_t size)
{
  const Material *m = &d->materials[d->material[place / SLICE]];
  if (!points_on_particles(&domain_region(d, place)->points)) {
    snprintf(words, size, "the law %s of material '%s' could not be integrated in one of its bonds", m->law_name,
             m->name);
    return words;
  }
  double e[6];
  for (int k = 0; k < 6; ++k) e[k] = d->strain[k][place];
  snprintf(words, size,
           "the law %s of material '%s' could not be integrated at the strain xx %g, yy %g, zz %g, xy %g, yz %g, zx %g",
           m->law_name, m->name, e[0], e[1], e[2], e[3], e[4], e[5]);
  return words;
}

int explicit_retreat(Explicit *s, Error *error)
{
  Domain *d = s->domain;
  const Particles *p = d->particles;
  const double dt = s->clock->time_step;
  const int32_t failed = (int32_t)d->failed_place, bad = failed >= 0 ? failed : first_bad_particle(p);
  const int left = family_count(&d->family, bad);
  char words[320];
  const char *kind, *cause = "the deformation has grown beyond all bounds; look at the loads and at the last pictures";
  if (dt > s->clock->stable)
    cause = "the time step is above the stable one";
  else if (failed >= 0)
    cause = describe_failed_law(d, failed, words, sizeof words);
  else if (left < 4)
    cause = "it has lost nearly all its bonds";
  if (d->out_of_memory || forces_failed(&d->forces))
    error_add(error, BRECCIA_FAILURE, "step %lld (time %g %s): out of memory: %s", (long long)s->clock->step + 1,
              s->clock->time + dt, s->clock->time_unit, d->out_of_memory ? "broken bonds" : forces_failed(&d->forces));
  else if (*domain_server_problem(d))
    error_add(error, BRECCIA_FAILURE, "step %lld (time %g %s): %s", (long long)s->clock->step + 1, s->clock->time + dt,
              s->clock->time_unit, domain_server_problem(d));
  else if (forces_stuck(&d->forces, &kind))
    error_add(
        error, BRECCIA_FAILURE,
        "step %lld (time %g %s): no equilibrium of '%s' (%s) with its bond was found at the displacements of the body; "
        "likely cause: it moves too far in a step; choose a smaller 'safety', or a slower load",
        (long long)s->clock->step + 1, s->clock->time + dt, s->clock->time_unit, forces_stuck(&d->forces, NULL), kind);
  else
    error_add(
        error, BRECCIA_FAILURE,
        "step %lld (time %g %s): the force on particle %d at [%g, %g, %g] is not a number; likely cause: %s (time step "
        "%g %s, stable step %g %s, kinetic energy %g)",
        (long long)s->clock->step + 1, s->clock->time + dt, s->clock->time_unit, p->number[bad], p->position[0][bad],
        p->position[1][bad], p->position[2][bad], cause, dt, s->clock->time_unit, s->clock->stable, s->clock->time_unit,
        s->ledger->kinetic);
  if (s->kept == KEPT_BUT_MOTION) explicit_step_back(s);
  state_undo(&s->before);
  domain_put_stresses_by(d);
  domain_mend(d);
  domain_follow(d);
  return BRECCIA_FAILURE;
}
