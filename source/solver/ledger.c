#include "solver/ledger.h"

#include <math.h>

/** Stops a run whose energy comes from nothing: bonds that gave back more than they had received, or speeds that no work explains.
 *  The second bound is wide, because a step close to the stable one hardly follows the shortest waves. */
int ledger_watch(Ledger *l, const Domain *d, const Clock *clock, Error *error)
{
  /* Steps: when a load sets in, all energies are next to nothing. */
  const int64_t lasting = 3;
  const double most_given = forces_strike(&d->forces) ? 0.15 : 0.1, most_unexplained = 1000;
  const double fracture = d->fracture_energy, internal = l->bond_work - fracture - forces_dissipated(&d->forces);
  l->paid = fmax(l->paid, l->kinetic_at_start + fabs(l->external_work));
  const bool sound = fmin(internal, fracture) >= -most_given * l->paid && l->between <= most_unexplained * l->paid;
  l->unsound_steps = sound ? 0 : l->unsound_steps + 1;
  if (l->unsound_steps < lasting) return BRECCIA_OK;
  return error_add(
      error, BRECCIA_FAILURE,
      "step %lld (time %g): energy from nothing: kinetic %.4g, internal %.4g, fracture %.4g, while loads and "
      "motions have put in %.4g at most; the time step of %.4g (stable step %.4g) is too long for what "
      "happens, or bonds that break or close give more than they got: choose a smaller 'safety' or 'time step', more "
      "zero-energy control, or leave contact out",
      (long long)clock->step, clock->time, l->kinetic, internal, fracture, l->paid, clock->time_step, clock->stable);
}

Energy ledger_energy(const Ledger *l, Domain *d)
{
  Energy e = {.kinetic = fmax(0, l->kinetic), /* what prescribed motions take back may leave a rounding */
              .internal = l->bond_work - d->fracture_energy - forces_dissipated(&d->forces),
              .external = l->external_work,
              .damping = l->damped ? l->damping_work : 0, /* else roundings */
              .fracture = d->fracture_energy,
              .friction = forces_dissipated(&d->forces),
              .between = l->between};
  const bool elastic = domain_is_elastic(d);
  e.stored = domain_stored_energy(d) + forces_energy(&d->forces);
  if (!elastic) e.dissipated = fmax(0, e.internal - e.stored);
  const double error = l->external_work + l->kinetic_at_start + l->between - l->kinetic - l->damping_work - e.stored -
                       e.dissipated - e.fracture - e.friction;
  const double largest = l->paid > 0 ? l->paid : fmax(fmax(l->kinetic, fabs(l->bond_work)), fabs(e.fracture));
  e.imbalance = largest > 0 ? fabs(error) / largest : 0;
  return e;
}

void ledger_state(Ledger *l, StateList *list)
{
  const struct {
    const char *name;
    double *value;
  } sums[] = {{"work on bonds", &l->bond_work},
              {"external work", &l->external_work},
              {"work of damping", &l->damping_work},
              {"kinetic energy", &l->kinetic},
              {"energy between steps", &l->between},
              {"kinetic energy at the start", &l->kinetic_at_start},
              {"paid energy", &l->paid}};
  for (size_t k = 0; k < sizeof sums / sizeof *sums; ++k)
    state_add_number(list, sums[k].name, "energy", STATE_TRIED, sums[k].value);
  state_add_count(list, "damped", STATE_TRIED, &l->damped);
  state_add_count(list, "unsound steps", STATE_TRIED, &l->unsound_steps);
}
