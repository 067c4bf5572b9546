#include "solver/ledger.h"

#include <math.h>
#include <stdio.h>

/* Steps: when a load sets in, all energies are next to nothing. */
enum { LASTING = 3, LASTING_FAST = 10 };
/* Times the speed that can be explained. Fragments leave a blow at up to twice its speed, and waves add up where they meet. */
static const double most_of_speed = 10, beyond_all = 1000;

double ledger_wave_speed(const Domain *d)
{
  double fastest = 0;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    fastest = fmax(fastest, sqrt((m->bulk + 4 * m->shear / 3) / m->density));
  }
  return fastest;
}

void ledger_begin(Ledger *l, const Domain *d)
{
  const Particles *p = d->particles;
  l->wave = ledger_wave_speed(d);
  l->mass = 0;
  for (int64_t n = 0; n < p->count; ++n) l->mass += p->density[p->place_of[n]] * p->volume[p->place_of[n]];
}

/** The place that moves the fastest in any of some rows of motion. @param[out] most  how fast */
static int64_t fastest_place(const Particles *p, int row, int rows, double *most)
{
  int64_t place = 0;
  *most = -1;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    for (int k = row; k < rows; ++k) {
      if (fabs(p->velocity.row[k][i]) <= *most) continue;
      *most = fabs(p->velocity.row[k][i]);
      place = i;
    }
  }
  return place;
}

/** Whether particles have become too fast: beyond the bound, and twice as fast within LASTING_FAST steps, which no steady load makes a free
 *  fragment; or beyond all bounds. */
static bool is_too_fast(Ledger *l)
{
  const double explained = l->wave + l->given;
  if (!(l->fastest > most_of_speed * explained)) {
    l->fast_steps = 0;
    return false;
  }
  if (l->fast_steps++ % LASTING_FAST == 0) l->fast_from = l->fastest;
  return l->fastest > 2 * l->fast_from || l->fastest > beyond_all * explained;
}

/** Whether there is more kinetic energy than if every component of every velocity were beyond all bounds: rotations have blown up, or the end of the step. */
static bool holds_too_much(const Ledger *l)
{
  return !(l->kinetic <= 1.5 * l->mass * pow(beyond_all * (l->wave + l->given), 2));
}

/** Writes the time step, and the stable time step if the solver has one, with their unit. */
static void describe_step(const Clock *clock, char *words, size_t size)
{
  const int count = snprintf(words, size, "%.4g %s", clock->time_step, clock->time_unit);
  if (isfinite(clock->stable))
    snprintf(words + count, size - (size_t)count, " (stable step %.4g %s)", clock->stable, clock->time_unit);
}

static int tell_too_fast(const Ledger *l, const Domain *d, const Clock *clock, const Units *units, Error *error)
{
  const Particles *p = d->particles;
  double speed, turning;
  int64_t i = fastest_place(p, 0, p->space.rotation, &speed);
  char place[120], what[300], unit[32], step[120];
  describe_step(clock, step, sizeof step);
  units_name(units, dimension_find("velocity"), unit, sizeof unit);
  if (l->fast_steps > 0) speed = l->fastest; /* in the middle of the step */
  const bool moves = speed > most_of_speed * (l->wave + l->given) || !particles_have_rotations(p);
  if (!moves) i = fastest_place(p, p->space.rotation, p->space.rows, &turning);
  snprintf(place, sizeof place, "particle %d at [%g, %g, %g]", p->number[i], p->position[0][i], p->position[1][i],
           p->position[2][i]);
  if (moves)
    snprintf(what, sizeof what, "%s moves at %.3g %s", place, speed, unit);
  else
    snprintf(what, sizeof what, "%s turns at %.3g 1/%s, so that kinetic energy is as if all mass moved at %.3g %s",
             place, turning, clock->time_unit, sqrt(2 * l->kinetic / l->mass), unit);
  return error_add(
      error, BRECCIA_FAILURE,
      "step %lld (time %g %s): the computation has blown up: %s, more than %g "
      "times the waves of the materials (%.4g %s) and the speeds at the start and prescribed (%.4g %s) together; the "
      "time step of %s is too long for what happens, or bonds that break or close give more than they got: choose a "
      "smaller 'safety' or 'time step', more zero-energy control, or leave contact out",
      (long long)clock->step, clock->time, clock->time_unit, what, most_of_speed, l->wave, unit, l->given, unit, step);
}

void ledger_give_up(Ledger *l)
{
  l->unsound_steps = LASTING;
}

bool ledger_has_blown_up(const Ledger *l)
{
  return l->blown_up;
}

bool ledger_is_doubtful(const Ledger *l)
{
  return l->trapped || l->unsound_steps > 0 || (l->fast_steps > 0 && l->fast_steps <= LASTING_FAST);
}

void ledger_note_strains(Ledger *l, const Domain *d)
{
  const double work = domain_strain_work(d), more = work - l->strain_work;
  l->bond_work += more;
  l->external_work += more;
  l->strain_work = work;
}

void ledger_note_paid(Ledger *l)
{
  l->paid = fmax(l->paid, l->kinetic_at_start + l->stored_at_start + fabs(l->external_work));
}

/** Stops a run whose energy comes from nothing: bonds that gave back more than they had received, or speeds that no work explains.
 *  The second bound is wide, because a step close to the stable one hardly follows the shortest waves. Works that have grown beyond all numbers
 *  say nothing, and speeds explode long before; so they are looked at by themselves. */
int ledger_watch(Ledger *l, const Domain *d, const Clock *clock, const Units *units, Error *error)
{
  const double most_given = forces_strike(&d->forces) ? 0.15 : 0.1, most_unexplained = 1000;
  const double fracture = d->fracture_energy + d->shed_energy,
               internal = l->bond_work - fracture - forces_friction(&d->forces);
  const double lost = forces_dissipated(&d->forces) - forces_friction(&d->forces); /* cannot be given back */
  const bool sound = isfinite(l->paid) && internal - lost >= -most_given * l->paid &&
                     fracture >= -most_given * l->paid && l->between <= most_unexplained * l->paid;
  l->unsound_steps = sound ? 0 : l->unsound_steps + 1;
  if (is_too_fast(l) || holds_too_much(l)) {
    l->unsound_steps = LASTING;
    l->blown_up = true;
    return tell_too_fast(l, d, clock, units, error);
  }
  if (l->unsound_steps < LASTING) return BRECCIA_OK;
  char step[120];
  describe_step(clock, step, sizeof step);
  return error_add(
      error, BRECCIA_FAILURE,
      "step %lld (time %g %s): energy from nothing: kinetic %.4g, internal %.4g, fracture %.4g, while loads and "
      "motions have put in %.4g at most; the time step of %s is too long for what happens, or bonds that break or "
      "close give more than they got: choose %s, more zero-energy control, or leave contact out",
      (long long)clock->step, clock->time, clock->time_unit, l->kinetic, internal, fracture, l->paid, step,
      isfinite(clock->stable) ? "a smaller 'safety' or 'time step'" : "a smaller 'time step' or more 'increments'");
}

Energy ledger_energy(const Ledger *l, Domain *d)
{
  Energy e = {.kinetic = fmax(0, l->kinetic), /* what prescribed motions take back may leave a rounding */
              .internal = l->bond_work - d->fracture_energy - d->shed_energy - forces_friction(&d->forces),
              .external = l->external_work,
              .damping = l->damped ? l->damping_work : 0, /* else roundings */
              .fracture = d->fracture_energy,
              .shed = d->shed_energy,
              .friction = forces_friction(&d->forces),
              .numerical = l->numerical,
              .between = l->between};
  const bool elastic = domain_is_elastic(d);
  e.stored = domain_stored_energy(d) + forces_energy(&d->forces);
  e.dissipated = forces_dissipated(&d->forces) - e.friction;
  if (!elastic) e.dissipated = fmax(e.dissipated, e.internal - e.stored);
  const double error = l->external_work + l->kinetic_at_start + l->stored_at_start + l->between - l->kinetic -
                       l->damping_work - l->numerical - e.stored - e.dissipated - e.fracture - e.shed - e.friction;
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
              {"numerical damping", &l->numerical},
              {"kinetic energy at the start", &l->kinetic_at_start},
              {"energy stored at the start", &l->stored_at_start},
              {"work of strains", &l->strain_work},
              {"paid energy", &l->paid}};
  state_add_number(list, "largest speed given", "velocity", STATE_TRIED, &l->given);
  state_add_number(list, "speed beyond the bound", "velocity", STATE_TRIED, &l->fast_from);
  state_add_count(list, "steps beyond the bound of speeds", STATE_TRIED, &l->fast_steps);
  for (size_t k = 0; k < sizeof sums / sizeof *sums; ++k)
    state_add_number(list, sums[k].name, "energy", STATE_TRIED, sums[k].value);
  state_add_count(list, "damped", STATE_TRIED, &l->damped);
  state_add_count(list, "unsound steps", STATE_TRIED, &l->unsound_steps);
}
