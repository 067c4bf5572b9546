/* Velocity Verlet (docs/theory.md 7), with g = a - c v, all forces over the mass:
 *   v+ = v + dt/2 g,  u' = u + dt v+,  a' = (f(u') + b - local damping) / rho,  v' = (v+ + dt/2 a') / (1 + c dt/2).
 * Works are summed by the trapezium rule over the step. The kinetic energy of v then grows by more than their sum, whatever the forces, by
 * exactly dt^2 / 8 sum m (g'^2 - g^2): the speeds at full steps are not those at which the works are done. */
#include "solver/explicit.h"

#include "base/team.h"
#include "solver/stable_step.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BOND_WORK, EXTERNAL_WORK, DAMPING_WORK, KINETIC, BETWEEN, MOTION };

static const Field damping_fields[] = {
    {"ratio", FIELD_NUMBER, offsetof(DampingSpec, ratio), "1", NULL, "[0, inf)",
     "share of critical damping; 1 comes to rest soonest", NULL, NULL, 0},
    {"at", FIELD_NUMBER, offsetof(DampingSpec, at), "frequency", NULL, "(0, inf)",
     "frequency of the vibration that has this ratio; slower ones are damped more, faster ones less", NULL, NULL, 0},
};
static const Section damping_section = {"damping",
                                        "Mass-proportional damping by its ratio: c = 4 pi ratio frequency.",
                                        sizeof(DampingSpec),
                                        FIELDS(damping_fields),
                                        NULL,
                                        NULL,
                                        NULL,
                                        0};

static void check_explicit(const DeckReader *reader, void *section)
{
  (void)reader;
  ExplicitSpec *spec = section;
  const DampingSpec *given = spec->damping_given.section;
  spec->damping = given ? 4 * acos(-1) * given->ratio * given->at : spec->damping_given.value;
}

static const Field explicit_fields[] = {
    {"time step", FIELD_NUMBER, offsetof(ExplicitSpec, time_step), "time", "", "(0, inf)",
     "when absent: 'safety' times the stable step, which is found by the program", NULL, NULL, 0},
    {"safety", FIELD_NUMBER, offsetof(ExplicitSpec, safety), "1", "0.8", "(0, 1]",
     "share of the stable step taken when 'time step' is absent", NULL, NULL, 0},
    {"steps", FIELD_COUNT, offsetof(ExplicitSpec, steps), NULL, "", "[0, 1e15]", "number of steps", NULL, NULL, 'A'},
    {"end time", FIELD_NUMBER, offsetof(ExplicitSpec, end_time), "time", "", "(0, inf)",
     "the run ends at this time, if need be with a shorter last step", NULL, NULL, 'A'},
    {"damping", FIELD_NUMBER_OR_SECTION, offsetof(ExplicitSpec, damping_given), "damping rate", "0", "[0, inf)",
     "mass-proportional damping: a rate c (force density - c rho v), or a ratio of critical damping at a frequency",
     &damping_section, NULL, 0},
    {"local damping", FIELD_NUMBER, offsetof(ExplicitSpec, local_damping), "1", "0", "[0, 1)",
     "Cundall's damping: a share of the force out of balance, against the velocity; 0.8 finds states of rest", NULL,
     NULL, 0},
};
const Section explicit_section = {"explicit",
                                  "Explicit dynamics by velocity Verlet.",
                                  sizeof(ExplicitSpec),
                                  FIELDS(explicit_fields),
                                  check_explicit,
                                  NULL,
                                  NULL,
                                  0};

enum { PART = 512 };

static int64_t parts_of(const Constraint *constraint)
{
  return (constraint->load->selection.count + PART - 1) / PART;
}

/** The longest step that the program takes by itself. */
static double longest_step(const Explicit *s)
{
  return s->spec->safety * s->stable;
}

/** Damping shortens the stable step: local damping by 1 / sqrt(1 + its share), as its force changes sign with the velocity;
 *  mass-proportional damping leaves it, but is followed only by steps of up to its own time (docs/theory.md 7). */
static int find_stable_step(Explicit *s, Error *error)
{
  const int status = stable_step(s->domain, &s->stable, error);
  s->stable /= sqrt(1 + s->spec->local_damping);
  if (s->spec->damping > 0) s->stable = fmin(s->stable, 1 / s->spec->damping);
  s->broken_at_estimate = s->domain->broken_count;
  s->step_at_estimate = s->step;
  return status;
}

/** Steps of one length from the present time on: as long as allowed, and as many as end with the stop. */
static void step_to(Explicit *s, double stop, double longest)
{
  const int64_t count = (int64_t)fmax(1, ceil((stop - s->time) / longest - 1e-9));
  s->plan.from = s->time;
  s->plan.to = stop;
  s->plan.first = s->step;
  s->plan.count = count;
  s->time_step = (stop - s->time) / (double)count;
}

/** True if steps of this length have become too long for the body. */
static bool is_too_long(const Explicit *s, double step)
{
  return !s->force && step > (isnan(s->spec->time_step) ? 1.1 * longest_step(s) : s->stable);
}

/** Plans steps up to the next time at which one has to end, and foresees how many there will be in all. */
static void plan_steps(Explicit *s)
{
  const double longest = isnan(s->fixed) || is_too_long(s, s->fixed) ? longest_step(s) : s->fixed,
               tiny = 1e-6 * longest;
  double stop = s->end_time, from;
  if (!isnan(s->fixed)) stop = fmin(stop, s->fixed * (floor(s->time / s->fixed + 1e-6) + 1));
  for (int64_t k = s->stop_count; isnan(s->fixed) && k-- > 0;)
    if (s->stops[k] > s->time + tiny && s->stops[k] < s->end_time - tiny) stop = s->stops[k];
  step_to(s, stop, longest);
  double later = 0;
  from = stop;
  for (int64_t k = 0; isnan(s->fixed) && k < s->stop_count; ++k)
    if (s->stops[k] > from + tiny && s->stops[k] < s->end_time - tiny) {
      later += ceil((s->stops[k] - from) / longest - 1e-9);
      from = s->stops[k];
    }
  if (s->end_time > from + tiny) later += ceil((s->end_time - from) / longest - 1e-9);
  s->steps = s->plan.first + s->plan.count + (int64_t)later;
}

/** Where bonds have broken the stable step may have fallen: finds it again, but only so often that it costs little. */
static int follow_stable_step(Explicit *s, Text *warning, Error *error)
{
  enum { SOON = 100, LATE = 1000, SHARE = 100 }; /* steps; one bond in so many */
  const int64_t broken = s->domain->broken_count - s->broken_at_estimate, since = s->step - s->step_at_estimate;
  if (s->domain->type->may_stiffen && broken && since >= (2 * broken * SHARE > s->domain->family.bonds ? SOON : LATE)) {
    const int status = find_stable_step(s, error);
    if (status) return status;
    if (is_too_long(s, s->time_step)) {
      if (!isnan(s->spec->time_step))
        text_add(warning,
                 "%swarning: step %lld: broken bonds have lowered the stable step to %.4g; the time step of %g is "
                 "divided from here on",
                 warning->length ? "\n" : "", (long long)s->step, s->stable, s->fixed);
      plan_steps(s);
    }
  }
  if (s->step == s->plan.first + s->plan.count) plan_steps(s);
  return BRECCIA_OK;
}

static double time_after_step(const Explicit *s)
{
  const int64_t taken = s->step + 1 - s->plan.first;
  return taken == s->plan.count ? s->plan.to : s->plan.from + (double)taken * s->time_step;
}

void explicit_stop_at(Explicit *s, const double *times, int64_t count)
{
  s->stops = times;
  s->stop_count = count;
  if (isnan(s->fixed)) plan_steps(s);
}

void explicit_state(Explicit *s, StateList *list)
{
  Ledger *l = &s->ledger;
  state_add_vector(list, "acceleration", "acceleration", STATE_COMMITTED, s->acceleration,
                   s->domain->particles->places);
  const struct {
    const char *name, *unit;
    double *value;
  } numbers[] = {{"time", "time", &s->time},
                 {"work on bonds", "energy", &l->bond_work},
                 {"external work", "energy", &l->external_work},
                 {"work of damping", "energy", &l->damping_work},
                 {"kinetic energy", "energy", &l->kinetic},
                 {"energy between steps", "energy", &l->between},
                 {"kinetic energy at the start", "energy", &s->kinetic_at_start},
                 {"paid energy", "energy", &s->paid},
                 {"stable step", "time", &s->stable},
                 {"time step", "time", &s->time_step},
                 {"plan from", "time", &s->plan.from},
                 {"plan to", "time", &s->plan.to}};
  const struct {
    const char *name;
    int64_t *value;
  } counts[] = {{"step", &s->step},
                {"steps", &s->steps},
                {"first step of the plan", &s->plan.first},
                {"steps of the plan", &s->plan.count},
                {"broken at the stable step", &s->broken_at_estimate},
                {"step of the stable step", &s->step_at_estimate},
                {"unsound steps", &s->unsound_steps}};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k)
    state_add_number(list, numbers[k].name, numbers[k].unit, STATE_TRIED, numbers[k].value);
  for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k)
    state_add_count(list, counts[k].name, STATE_TRIED, counts[k].value);
}

/** Room for what steps try. */
static int keep_state(Explicit *s, Error *error)
{
  StateList list = {0};
  domain_state(s->domain, &list);
  explicit_state(s, &list);
  const int status = state_keep(&s->before, &list, error);
  state_list_destroy(&list);
  return status;
}

/** How many steps of the deck's length there are until the end; 0 without such a length. */
static int64_t whole_steps(const Explicit *s)
{
  return isnan(s->fixed) ? 0 : (int64_t)floor(s->end_time / s->fixed + 1e-6);
}

int explicit_create(Explicit *s, Domain *domain, const Loading *loading, const ExplicitSpec *spec,
                    const DeckReader *reader, bool force, Text *warning)
{
  *s = (Explicit){.domain = domain, .loading = loading, .spec = spec, .force = force};
  int failed = 0;
  for (int k = 0; k < 3; ++k)
    failed |= !(s->acceleration[k] = places_array(domain->particles->places, "accelerations", reader->error));
  s->sums = memory_zeroed((size_t)domain->block_count, sizeof *s->sums, "energy sums", reader->error);
  int64_t parts = 0;
  for (int n = 0; n < loading->constraint_count; ++n)
    if (parts_of(&loading->constraints[n]) > parts) parts = parts_of(&loading->constraints[n]);
  s->parts = memory_zeroed((size_t)parts, sizeof *s->parts, "energy sums", reader->error);
  if (failed || !s->sums || !s->parts || keep_state(s, reader->error)) return BRECCIA_FAILURE;
  int status = find_stable_step(s, reader->error);
  if (status) return status;
  s->fixed = spec->steps >= 0 && isnan(spec->time_step) ? longest_step(s) : spec->time_step;
  const double share = spec->time_step / s->stable;
  const Node *place = section_place(spec, "time step");
  if (share > 1 && !force)
    return node_error(
        reader->document, place, reader->error,
        "time step: %g is %.2f times the stable step of %.4g; choose a smaller one, leave it out, or run with "
        "--force",
        spec->time_step, share, s->stable);
  if (share > 0.9) {
    char where[PLACE];
    node_place(reader->document, place, where, sizeof where);
    text_add(warning, "%s: warning: time step: %g is %.2f times the stable step of %.4g", where, spec->time_step, share,
             s->stable);
  }
  const double step = isnan(s->fixed) ? longest_step(s) : s->fixed;
  const double steps = spec->steps >= 0 ? (double)spec->steps : ceil(spec->end_time / step - 1e-6);
  if (steps > 1e15)
    return node_error(reader->document, spec->head.node, reader->error, "explicit: %.3g steps are too many", steps);
  s->end_time = spec->steps >= 0 ? steps * s->fixed : spec->end_time;
  const int64_t whole = whole_steps(s);
  if (!whole && spec->steps != 0) {
    plan_steps(s);
    return BRECCIA_OK;
  }
  /* Fixed steps are planned at once; what is left of the end time after them becomes a shorter last one. */
  s->time_step = s->fixed;
  s->steps = (int64_t)steps;
  s->plan.count = whole;
  s->plan.to = whole == s->steps ? s->end_time : (double)whole * s->fixed;
  return BRECCIA_OK;
}

double explicit_last_step(const Explicit *s)
{
  const double left = s->end_time - (double)whole_steps(s) * s->fixed;
  return left > 1e-6 * s->fixed ? left : NAN;
}

void explicit_destroy(Explicit *s)
{
  for (int k = 0; k < 3; ++k) places_free(&s->acceleration[k]);
  free(s->sums);
  free(s->parts);
  state_copy_destroy(&s->before);
  *s = (Explicit){0};
}

/** First half: velocities to the middle of the step, displacements to its end. */
BRECCIA_CLONES
static void kick_and_drift(Explicit *s, int64_t block)
{
  const Particles *p = s->domain->particles;
  const Lanes dt = lanes_set(s->time_step), c = lanes_set(s->spec->damping), one_half = lanes_set(0.5);
  Lanes bond = {0}, external = {0}, damping = {0}, between = {0}, still = {0};
  int64_t first = s->domain->blocks[block].first * SLICE, last = s->domain->blocks[block].last * SLICE;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = first; i < last; i += LANES) {
      Lanes v = lanes_load(p->velocity[k] + i), fi = lanes_load(p->internal[k] + i);
      Lanes fe = lanes_load(p->external[k] + i);
      Lanes gain = lanes_load(s->acceleration[k] + i) - c * v, drag = fi + fe - lanes_load(p->density + i) * gain;
      Lanes half = v + one_half * dt * gain, du = dt * half, work = one_half * du * lanes_load(p->volume + i);
      bond -= fi * work;
      external += fe * work;
      damping += drag * work;
      between -= lanes_load(p->density + i) * lanes_load(p->volume + i) * gain * gain;
      still = lanes_least(still, -lanes_absolute(du));
      lanes_store(p->displacement[k] + i, lanes_load(p->displacement[k] + i) + du);
      lanes_store(p->velocity[k] + i, half);
    }
  double *sums = s->sums[block];
  sums[BOND_WORK] = lanes_total(bond);
  sums[EXTERNAL_WORK] = lanes_total(external);
  sums[DAMPING_WORK] = lanes_total(damping);
  sums[BETWEEN] = s->time_step * s->time_step / 8 * lanes_total(between);
  sums[MOTION] = fmax(fmax(-still[0], -still[1]), fmax(-still[2], -still[3]));
}

/** Second half: accelerations and velocities at the end of the step. */
BRECCIA_CLONES
static void kick(Explicit *s, int64_t block)
{
  const Particles *p = s->domain->particles;
  double c = s->spec->damping;
  const Lanes dt = lanes_set(s->time_step), one_half = lanes_set(0.5), local = lanes_set(s->spec->local_damping);
  const Lanes slow = lanes_set(1 / (1 + 0.5 * c * s->time_step)), viscous = lanes_set(c);
  Lanes bond = {0}, external = {0}, damping = {0}, kinetic = {0}, between = {0};
  int64_t first = s->domain->blocks[block].first * SLICE, last = s->domain->blocks[block].last * SLICE;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = first; i < last; i += LANES) {
      Lanes half = lanes_load(p->velocity[k] + i), fi = lanes_load(p->internal[k] + i);
      Lanes fe = lanes_load(p->external[k] + i), density = lanes_load(p->density + i);
      Lanes volume = lanes_load(p->volume + i), force = fi + fe, size = local * lanes_absolute(force);
      Lanes drag = lanes_where(half > lanes_set(0), size) - lanes_where(half < lanes_set(0), size);
      Lanes acceleration = (force - drag) / density, end = (half + one_half * dt * acceleration) * slow;
      Lanes work = one_half * dt * half * volume;
      bond -= fi * work;
      external += fe * work;
      damping += (drag + viscous * density * end) * work;
      kinetic += one_half * density * volume * end * end;
      Lanes gain = acceleration - viscous * end;
      between += density * volume * gain * gain;
      lanes_store(s->acceleration[k] + i, acceleration);
      lanes_store(p->velocity[k] + i, end);
    }
  double *sums = s->sums[block];
  sums[BOND_WORK] += lanes_total(bond);
  sums[EXTERNAL_WORK] += lanes_total(external);
  sums[DAMPING_WORK] += lanes_total(damping);
  sums[BETWEEN] += s->time_step * s->time_step / 8 * lanes_total(between);
  sums[KINETIC] = lanes_total(kinetic);
}

static double along(double *const vector[3], const double direction[3], int32_t i)
{
  return vector[0][i] * direction[0] + vector[1][i] * direction[1] + vector[2][i] * direction[2];
}

/* Prescribed motions. In a prescribed direction loads, reaction and damping together do whatever work the change of
 * kinetic energy and the bonds ask for; that sum is booked as external. The loops above have booked the free motion, which is
 * taken back here. Particles are shared out in parts whose sums are added in order; held faces are large enough for one thread
 * alone to hold up all others. */
static int64_t part_end(const Constraint *constraint, int64_t part)
{
  int64_t end = (part + 1) * PART;
  return end < constraint->load->selection.count ? end : constraint->load->selection.count;
}

static void add_to_ledger(Explicit *s, const double *sums)
{
  s->ledger.bond_work += sums[BOND_WORK];
  s->ledger.external_work += sums[EXTERNAL_WORK];
  s->ledger.damping_work += sums[DAMPING_WORK];
  s->ledger.kinetic += sums[KINETIC];
  s->ledger.between += sums[BETWEEN];
}

static void add_parts(Explicit *s, const Constraint *constraint)
{
  for (int64_t part = 0; part < parts_of(constraint); ++part) {
    const double *sums = s->parts[part];
    add_to_ledger(s, sums);
    s->motion = fmax(s->motion, sums[MOTION]);
  }
}

static void move_part(Explicit *s, const Constraint *constraint, double target, int64_t part)
{
  const Particles *p = s->domain->particles;
  const double *d = constraint->direction;
  double dt = s->time_step, c = s->spec->damping, bond = 0, external = 0, damping = 0, between = 0, largest = 0;
  for (int64_t k = part * PART; k < part_end(constraint, part); ++k) {
    int32_t i = constraint->load->selection.places[k];
    double half = along(p->velocity, d, i), a = along(s->acceleration, d, i), drifted = dt * half;
    double fi = along(p->internal, d, i), fe = along(p->external, d, i);
    double v = (half - 0.5 * dt * a) / (1 - 0.5 * c * dt), off = target - along(p->displacement, d, i);
    largest = fmax(largest, fabs(drifted + off));
    double moved = drifted + off, free_work = 0.5 * drifted * p->volume[i], work = 0.5 * moved * p->volume[i];
    bond -= fi * (work - free_work);
    damping -= (fi + fe - p->density[i] * (a - c * v)) * free_work;
    external += -fe * free_work - fi * work - 0.5 * p->density[i] * p->volume[i] * v * v;
    between += dt * dt / 8 * p->density[i] * p->volume[i] * (a - c * v) * (a - c * v);
    for (int j = 0; j < 3; ++j) {
      p->displacement[j][i] += off * d[j];
      p->velocity[j][i] += off / dt * d[j];
    }
  }
  double *sums = s->parts[part];
  sums[BOND_WORK] = bond;
  sums[EXTERNAL_WORK] = external;
  sums[DAMPING_WORK] = damping;
  sums[KINETIC] = 0;
  sums[BETWEEN] = between;
  sums[MOTION] = largest;
}

/** After the drift: displacements at the end of the step, velocities in its middle. Called by all threads. */
static void prescribe_displacements(Explicit *s)
{
  TEAM_SINGLE
  {
    s->motion = 0;
    for (int64_t b = 0; b < s->domain->block_count; ++b) s->motion = fmax(s->motion, s->sums[b][MOTION]);
  }
  for (int n = 0; n < s->loading->constraint_count; ++n) { /* one after the other: they may share particles */
    const Constraint *constraint = &s->loading->constraints[n];
    double target = constraint_displacement(constraint, s->time + s->time_step);
    TEAM_FOR (part, parts_of(constraint)) move_part(s, constraint, target, part);
    TEAM_SINGLE add_parts(s, constraint);
  }
}

static void speed_part(Explicit *s, const Constraint *constraint, double moved, double rate, int64_t part)
{
  const Particles *p = s->domain->particles;
  const double *d = constraint->direction;
  double dt = s->time_step, c = s->spec->damping, external = 0, damping = 0, kinetic = 0, between = 0;
  for (int64_t k = part * PART; k < part_end(constraint, part); ++k) {
    int32_t i = constraint->load->selection.places[k];
    double mass = p->density[i] * p->volume[i], v = along(p->velocity, d, i), a = along(s->acceleration, d, i);
    double fi = along(p->internal, d, i), fe = along(p->external, d, i), work = 0.5 * moved * p->volume[i];
    kinetic += 0.5 * mass * (rate * rate - v * v);
    damping -= (fi + fe - p->density[i] * (a - c * v)) * work;
    external += 0.5 * mass * rate * rate - fe * work - fi * work;
    between -= dt * dt / 8 * mass * (a - c * v) * (a - c * v);
    for (int j = 0; j < 3; ++j) {
      p->velocity[j][i] += (rate - v) * d[j];
      s->acceleration[j][i] -= a * d[j];
    }
  }
  double *sums = s->parts[part];
  sums[BOND_WORK] = sums[MOTION] = 0;
  sums[EXTERNAL_WORK] = external;
  sums[DAMPING_WORK] = damping;
  sums[KINETIC] = kinetic;
  sums[BETWEEN] = between;
}

/** After the second kick: velocities at the end of the step, by central difference of the prescribed motion. Called by all
 *  threads. */
static void prescribe_velocities(Explicit *s)
{
  double dt = s->time_step;
  for (int n = 0; n < s->loading->constraint_count; ++n) {
    const Constraint *constraint = &s->loading->constraints[n];
    double before = constraint_displacement(constraint, s->time - dt);
    double moved = constraint_displacement(constraint, s->time) - before;
    double rate = (constraint_displacement(constraint, s->time + dt) - before) / (2 * dt);
    TEAM_FOR (part, parts_of(constraint)) speed_part(s, constraint, moved, rate, part);
    TEAM_SINGLE add_parts(s, constraint);
  }
}

static void add_sums(Explicit *s)
{
  s->ledger.kinetic = 0;
  for (int64_t b = 0; b < s->domain->block_count; ++b) add_to_ledger(s, s->sums[b]);
}

void explicit_begin(Explicit *s)
{
  Domain *d = s->domain;
  loading_apply(s->loading, d->particles, s->time);
  domain_evaluate(d);
  const Particles *p = d->particles;
  s->ledger.kinetic = 0;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i) {
      s->acceleration[k][i] = (p->internal[k][i] + p->external[k][i]) / p->density[i];
      s->ledger.kinetic += 0.5 * p->density[i] * p->volume[i] * p->velocity[k][i] * p->velocity[k][i];
    }
  s->kinetic_at_start = s->ledger.kinetic;
  s->paid = s->kinetic_at_start;
}

static int32_t first_bad_particle(const Particles *p)
{
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k)
      if (!isfinite(p->internal[k][p->place_of[n]])) return p->place_of[n];
  return p->place_of[0];
}

/** Which law could not be integrated, and at which strain. */
static const char *describe_failed_law(const Domain *d, int64_t place, char *words, size_t size)
{
  const Material *m = &d->materials[d->material[place / SLICE]];
  if (d->points.components != 6) {
    snprintf(words, size, "the law %s of material '%s' could not be integrated in one of its bonds", m->law->name,
             m->name);
    return words;
  }
  double e[6];
  for (int k = 0; k < 6; ++k) e[k] = d->strain[k][place];
  snprintf(words, size,
           "the law %s of material '%s' could not be integrated at the strain xx %g, yy %g, zz %g, xy %g, yz %g, zx %g",
           m->law->name, m->name, e[0], e[1], e[2], e[3], e[4], e[5]);
  return words;
}

/** Takes the state back to the start of the step, and says what happened. */
static int retreat(Explicit *s, Error *error)
{
  Domain *d = s->domain;
  const Particles *p = d->particles;
  const double dt = s->time_step;
  const int32_t failed = (int32_t)d->failed_place, bad = failed >= 0 ? failed : first_bad_particle(p);
  const int left = family_count(&d->family, bad);
  char words[320];
  const char *cause = "the deformation has grown beyond all bounds; look at the loads and at the last pictures";
  if (dt > s->stable)
    cause = "the time step is above the stable one";
  else if (failed >= 0)
    cause = describe_failed_law(d, failed, words, sizeof words);
  else if (left < 4)
    cause = "it has lost nearly all its bonds";
  if (d->out_of_memory || d->contact.failed)
    error_add(error, BRECCIA_FAILURE, "step %lld (time %g): out of memory: %s", (long long)s->step + 1, s->time + dt,
              d->out_of_memory ? "broken bonds" : "contact");
  else if (*points_problem(&d->points))
    error_add(error, BRECCIA_FAILURE, "step %lld (time %g): %s", (long long)s->step + 1, s->time + dt,
              points_problem(&d->points));
  else
    error_add(
        error, BRECCIA_FAILURE,
        "step %lld (time %g): the force on particle %d at [%g, %g, %g] is not a number; likely cause: %s (time step "
        "%g, stable step %g, kinetic energy %g)",
        (long long)s->step + 1, s->time + dt, p->number[bad], p->position[0][bad], p->position[1][bad],
        p->position[2][bad], cause, dt, s->stable, s->ledger.kinetic);
  state_undo(&s->before);
  domain_mend(d);
  domain_follow(d);
  return BRECCIA_FAILURE;
}

/** Stops a run whose energy comes from nothing: bonds that gave back more than they had received, or speeds that no work explains.
 *  The second bound is wide, because a step close to the stable one hardly follows the shortest waves. */
static int watch_energy(Explicit *s, Error *error)
{
  /* Steps: when a load sets in, all energies are next to nothing, and what presses at first may come from faces that settle. */
  const int64_t lasting = s->domain->contact.spec ? 100 : 3;
  const double most_given = s->domain->contact.spec        ? 1
                            : domain_is_elastic(s->domain) ? 0.1
                                                           : 0.5,
               most_unexplained = 1000;
  const Ledger *l = &s->ledger;
  const double fracture = s->domain->fracture_energy,
               internal = l->bond_work - fracture - s->domain->contact.friction_work;
  s->paid = fmax(s->paid, s->kinetic_at_start + fabs(l->external_work));
  const bool sound = fmin(internal, fracture) >= -most_given * s->paid && l->between <= most_unexplained * s->paid;
  s->unsound_steps = sound ? 0 : s->unsound_steps + 1;
  if (s->unsound_steps < lasting) return BRECCIA_OK;
  return error_add(
      error, BRECCIA_FAILURE,
      "step %lld (time %g): energy from nothing: kinetic %.4g, internal %.4g, fracture %.4g, while loads and "
      "motions have put in %.4g at most; the time step of %.4g (stable step %.4g) is too long for what "
      "happens, or bonds that break or close give more than they got: choose a smaller 'safety' or 'time step', more "
      "zero-energy control, or leave contact out",
      (long long)s->step, s->time, l->kinetic, internal, fracture, s->paid, s->time_step, s->stable);
}

/** Whether a step that has come to its forces may go on. */
static bool is_sound(const Explicit *s)
{
  const Domain *d = s->domain;
  return isfinite(d->force_sum) && d->failed_place < 0 && !d->contact.failed && !d->out_of_memory;
}

static void advance(void *context)
{
  Explicit *s = context;
  Domain *d = s->domain;
  const double end = time_after_step(s);
  TEAM_FOR (b, d->block_count) {
    state_note_places(&s->before, d->blocks[b].first * SLICE, d->blocks[b].last * SLICE);
    kick_and_drift(s, b);
  }
  prescribe_displacements(s);
  domain_break(d, &(Moment){s->step + 1, end, s->time_step, sqrt(3) * s->motion});
  domain_forces(d);
  if (!is_sound(s)) return;
  domain_book(d, s->time_step);
  loading_apply(s->loading, d->particles, end);
  TEAM_FOR (b, d->block_count) kick(s, b);
  TEAM_SINGLE
  {
    add_sums(s);
    s->time = end;
    ++s->step;
  }
  prescribe_velocities(s);
}

int explicit_advance(Explicit *s, Text *warning, Error *error)
{
  const int status = follow_stable_step(s, warning, error);
  if (status) return status;
  state_note_others(&s->before);
  team_run(advance, s);
  if (!is_sound(s)) return retreat(s, error);
  points_commit(&s->domain->points);
  contact_commit(&s->domain->contact);
  return watch_energy(s, error);
}

Energy explicit_energy(const Explicit *s)
{
  Domain *d = s->domain;
  const Ledger *l = &s->ledger;
  Energy e = {.kinetic = fmax(0, l->kinetic), /* what prescribed motions take back may leave a rounding */
              .internal = l->bond_work - d->fracture_energy - d->contact.friction_work,
              .external = l->external_work,
              .damping = s->spec->damping > 0 || s->spec->local_damping > 0 ? l->damping_work : 0, /* else roundings */
              .fracture = d->fracture_energy,
              .friction = d->contact.friction_work,
              .between = l->between};
  const bool elastic = domain_is_elastic(d);
  e.stored = domain_stored_energy(d) + contact_energy(&d->contact);
  if (!elastic) e.dissipated = fmax(0, e.internal - e.stored);
  const double error = l->external_work + s->kinetic_at_start + l->between - l->kinetic - l->damping_work - e.stored -
                       e.dissipated - e.fracture - e.friction;
  const double largest = s->paid > 0 ? s->paid : fmax(fmax(l->kinetic, fabs(l->bond_work)), fabs(e.fracture));
  e.imbalance = largest > 0 ? fabs(error) / largest : 0;
  return e;
}
