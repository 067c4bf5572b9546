/* Velocity Verlet (docs/theory.md 7):
 *   v+ = v + dt/2 (a - c v),  u' = u + dt v+,  a' = (f(u') + b - local damping) / rho,  v' = (v+ + dt/2 a') / (1 + c dt/2).
 * Works are summed by the trapezium rule over the step, so that their sum misses the kinetic energy by O(dt^2) only. */
#include "solver/explicit.h"

#include "base/team.h"
#include "solver/stable_step.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BOND_WORK, EXTERNAL_WORK, DAMPING_WORK, KINETIC, MOTION };

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
    {"end time", FIELD_NUMBER, offsetof(ExplicitSpec, end_time), "time", "", "(0, inf)", "steps until this time", NULL,
     NULL, 'A'},
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

int explicit_create(Explicit *s, Domain *domain, const Loading *loading, const ExplicitSpec *spec,
                    const DeckReader *reader, bool force, Text *warning)
{
  *s = (Explicit){.domain = domain, .loading = loading, .spec = spec};
  int failed = 0;
  for (int k = 0; k < 3; ++k)
    failed |= !(s->acceleration[k] = places_array(domain->particles->places, "accelerations", reader->error));
  s->sums = memory_zeroed((size_t)domain->block_count, sizeof *s->sums, "energy sums", reader->error);
  int64_t parts = 0;
  for (int n = 0; n < loading->constraint_count; ++n)
    if (parts_of(&loading->constraints[n]) > parts) parts = parts_of(&loading->constraints[n]);
  s->parts = memory_zeroed((size_t)parts, sizeof *s->parts, "energy sums", reader->error);
  if (failed || !s->sums || !s->parts) return BRECCIA_FAILURE;
  int status = stable_step(domain, &s->stable, reader->error);
  if (status) return status;
  s->time_step = isnan(spec->time_step) ? spec->safety * s->stable : spec->time_step;
  double share = s->time_step / s->stable;
  const Node *place = section_place(spec, "time step");
  if (share > 1 && !force)
    return node_error(
        reader->document, place, reader->error,
        "time step: %g is %.2f times the stable step of %.4g; choose a smaller one, leave it out, or run with "
        "--force",
        s->time_step, share, s->stable);
  if (share > 0.9 && !isnan(spec->time_step))
    text_add(warning, "%s:%d:%d: warning: time step: %g is %.2f times the stable step of %.4g", reader->document->name,
             place->line, place->column, s->time_step, share, s->stable);
  double steps = spec->steps >= 0 ? (double)spec->steps : ceil(spec->end_time / s->time_step - 1e-9);
  if (steps > 1e15)
    return node_error(reader->document, spec->head.node, reader->error, "explicit: %.3g steps are too many", steps);
  s->steps = (int64_t)steps;
  return BRECCIA_OK;
}

void explicit_destroy(Explicit *s)
{
  for (int k = 0; k < 3; ++k) places_free(&s->acceleration[k]);
  free(s->sums);
  free(s->parts);
  *s = (Explicit){0};
}

/** First half: velocities to the middle of the step, displacements to its end. */
BRECCIA_CLONES
static void kick_and_drift(Explicit *s, int64_t block)
{
  const Particles *p = s->domain->particles;
  const Lanes dt = lanes_set(s->time_step), c = lanes_set(s->spec->damping), one_half = lanes_set(0.5);
  Lanes bond = {0}, external = {0}, damping = {0}, still = {0};
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
      still = lanes_least(still, -lanes_absolute(du));
      lanes_store(p->displacement[k] + i, lanes_load(p->displacement[k] + i) + du);
      lanes_store(p->velocity[k] + i, half);
    }
  double *sums = s->sums[block];
  sums[BOND_WORK] = lanes_total(bond);
  sums[EXTERNAL_WORK] = lanes_total(external);
  sums[DAMPING_WORK] = lanes_total(damping);
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
  Lanes bond = {0}, external = {0}, damping = {0}, kinetic = {0};
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
      lanes_store(s->acceleration[k] + i, acceleration);
      lanes_store(p->velocity[k] + i, end);
    }
  double *sums = s->sums[block];
  sums[BOND_WORK] += lanes_total(bond);
  sums[EXTERNAL_WORK] += lanes_total(external);
  sums[DAMPING_WORK] += lanes_total(damping);
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

static void add_parts(Explicit *s, const Constraint *constraint)
{
  for (int64_t part = 0; part < parts_of(constraint); ++part) {
    const double *sums = s->parts[part];
    s->bond_work += sums[BOND_WORK];
    s->external_work += sums[EXTERNAL_WORK];
    s->damping_work += sums[DAMPING_WORK];
    s->kinetic += sums[KINETIC];
    s->motion = fmax(s->motion, sums[MOTION]);
  }
}

static void move_part(Explicit *s, const Constraint *constraint, double target, int64_t part)
{
  const Particles *p = s->domain->particles;
  const double *d = constraint->direction;
  double dt = s->time_step, c = s->spec->damping, bond = 0, external = 0, damping = 0, largest = 0;
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
  double c = s->spec->damping, external = 0, damping = 0, kinetic = 0;
  for (int64_t k = part * PART; k < part_end(constraint, part); ++k) {
    int32_t i = constraint->load->selection.places[k];
    double mass = p->density[i] * p->volume[i], v = along(p->velocity, d, i), a = along(s->acceleration, d, i);
    double fi = along(p->internal, d, i), fe = along(p->external, d, i), work = 0.5 * moved * p->volume[i];
    kinetic += 0.5 * mass * (rate * rate - v * v);
    damping -= (fi + fe - p->density[i] * (a - c * v)) * work;
    external += 0.5 * mass * rate * rate - fe * work - fi * work;
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
  s->kinetic = 0;
  for (int64_t b = 0; b < s->domain->block_count; ++b) {
    s->bond_work += s->sums[b][BOND_WORK];
    s->external_work += s->sums[b][EXTERNAL_WORK];
    s->damping_work += s->sums[b][DAMPING_WORK];
    s->kinetic += s->sums[b][KINETIC];
  }
}

void explicit_begin(Explicit *s)
{
  Domain *d = s->domain;
  loading_apply(s->loading, d->particles, s->time);
  domain_evaluate(d);
  const Particles *p = d->particles;
  s->kinetic = 0;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i) {
      s->acceleration[k][i] = (p->internal[k][i] + p->external[k][i]) / p->density[i];
      s->kinetic += 0.5 * p->density[i] * p->volume[i] * p->velocity[k][i] * p->velocity[k][i];
    }
  s->kinetic_at_start = s->kinetic;
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
  if (d->points.where != POINTS_ON_PARTICLES) {
    snprintf(words, size, "the law %s of material '%s' could not be integrated in one of its bonds", m->law->name,
             m->name);
    return words;
  }
  double e[6];
  for (int k = 0; k < 6; ++k) e[k] = d->points.strain[k][place];
  snprintf(words, size,
           "the law %s of material '%s' could not be integrated at the strain xx %g, yy %g, zz %g, xy %g, yz %g, zx %g",
           m->law->name, m->name, e[0], e[1], e[2], e[3], e[4], e[5]);
  return words;
}

/** Takes displacements and velocities back to the start of the step, and says what happened. */
static int retreat(Explicit *s, Error *error)
{
  const Particles *p = s->domain->particles;
  double dt = s->time_step, c = s->spec->damping;
  int32_t failed = (int32_t)s->domain->failed_place, bad = failed >= 0 ? failed : first_bad_particle(p);
  double energy = s->kinetic;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i) {
      double half = p->velocity[k][i];
      p->displacement[k][i] -= dt * half;
      p->velocity[k][i] = (half - 0.5 * dt * s->acceleration[k][i]) / (1 - 0.5 * c * dt);
    }
  if (s->domain->contact.failed) return error_add(error, BRECCIA_FAILURE, "out of memory: contact");
  if (*points_problem(&s->domain->points))
    return error_add(error, BRECCIA_FAILURE, "step %lld (time %g): %s", (long long)s->step + 1, s->time + dt,
                     points_problem(&s->domain->points));
  char words[320];
  const char *cause = "the deformation has grown beyond all bounds; look at the loads and at the last pictures";
  if (dt > s->stable)
    cause = "the time step is above the stable one";
  else if (failed >= 0)
    cause = describe_failed_law(s->domain, failed, words, sizeof words);
  else if (family_count(&s->domain->family, bad) < 4)
    cause = "it has lost nearly all its bonds";
  error_add(
      error, BRECCIA_FAILURE,
      "step %lld (time %g): the force on particle %d at [%g, %g, %g] is not a number; likely cause: %s (time step "
      "%g, stable step %g, kinetic energy %g)",
      (long long)s->step + 1, s->time + dt, p->number[bad], p->position[0][bad], p->position[1][bad],
      p->position[2][bad], cause, dt, s->stable, energy);
  domain_evaluate(s->domain); /* strains and stresses of the state that is left */
  return BRECCIA_FAILURE;
}

/** Whether a step that has come to its forces may go on. */
static bool is_sound(const Explicit *s)
{
  const Domain *d = s->domain;
  return isfinite(d->force_sum) && d->failed_place < 0 && !d->contact.failed;
}

static void advance(void *context)
{
  Explicit *s = context;
  Domain *d = s->domain;
  TEAM_FOR (b, d->block_count) kick_and_drift(s, b);
  prescribe_displacements(s);
  domain_break(d, s->step + 1, s->time + s->time_step, sqrt(3) * s->motion);
  domain_forces(d);
  if (!is_sound(s)) return;
  loading_apply(s->loading, d->particles, s->time + s->time_step);
  TEAM_FOR (b, d->block_count) kick(s, b);
  TEAM_SINGLE
  {
    add_sums(s);
    ++s->step;
    s->time = (double)s->step * s->time_step;
  }
  prescribe_velocities(s);
}

int explicit_advance(Explicit *s, Error *error)
{
  team_run(advance, s);
  if (!is_sound(s)) return retreat(s, error);
  points_commit(&s->domain->points);
  contact_commit(&s->domain->contact);
  return BRECCIA_OK;
}

int explicit_renew_stable_step(Explicit *s, Text *warning, Error *error)
{
  if (s->domain->broken_count == s->broken_at_estimate) return BRECCIA_OK;
  s->broken_at_estimate = s->domain->broken_count;
  int status = stable_step(s->domain, &s->stable, error);
  if (!status && s->time_step > s->stable)
    text_add(warning,
             "warning: step %lld: broken bonds have lowered the stable step to %.4g, below the time step of %.4g",
             (long long)s->step, s->stable, s->time_step);
  return status;
}

Energy explicit_energy(const Explicit *s)
{
  Energy e = {.kinetic = s->kinetic,
              .internal = s->bond_work - s->domain->fracture_energy - s->domain->contact.friction_work,
              .external = s->external_work,
              .damping = s->spec->damping > 0 || s->spec->local_damping > 0 ? s->damping_work : 0, /* else roundings */
              .fracture = s->domain->fracture_energy,
              .friction = s->domain->contact.friction_work};
  double error = e.external + s->kinetic_at_start - e.kinetic - e.internal - e.damping - e.fracture - e.friction;
  double largest = fmax(fmax(fabs(e.kinetic), fabs(s->bond_work)), fmax(fabs(e.external), fabs(e.damping)));
  e.imbalance = largest > 0 ? fabs(error) / largest : 0;
  return e;
}
