/* Which bonds break in a step, what goes with them, and how a step that failed is taken back.
 *
 * Bonds that break are found at the displacements of the end of the step. What a bond had received until then: the energy stored with it,
 * less what is stored without it, less half of what its force would have done along the step, because the trapezium rule that sums the
 * works (solver/explicit.c) finds the bond gone at the end of the step. Where families share energies, as in correspondence, a place that
 * loses bonds stores another energy with those that are left; never more than before (docs/theory.md 4). */
#include "base/clock.h"
#include "base/memory.h"
#include "base/team.h"
#include "domain/domain.h"

#include "base/check.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CONSUMED = 2 }; /* of a mark that a law gave up: its bonds have been judged in the step under way */

/** Doubles the room of an array that is full. */
static bool make_room(void **array, size_t size, int64_t count, int64_t *capacity)
{
  if (count < *capacity) return true;
  const int64_t wanted = *capacity ? 2 * *capacity : 256;
  void *grown = memory_grown(*array, (size_t)wanted, size);
  if (!grown) return false;
  *array = grown;
  *capacity = wanted;
  return true;
}

const BreakCauseType break_causes[BREAK_CAUSES] = {
#define BREAK_CAUSE(NAME, ...) {__VA_ARGS__},
#include "domain/break_causes.h"
#undef BREAK_CAUSE
};

const char *domain_break_quantity(const Domain *d, BreakCause cause, int k)
{
  const Criterion *criterion = d->failure.criterion;
  if (break_causes[cause].quantity) return k ? NULL : break_causes[cause].quantity;
  return criterion && criterion->measure ? criterion->quantities[k] : NULL;
}

const char *domain_break_dimension(const Domain *d, BreakCause cause)
{
  const Criterion *criterion = d->failure.criterion;
  return !break_causes[cause].quantity && criterion && criterion->dimension ? criterion->dimension : "1";
}

const char *domain_break_criterion(const Domain *d, BreakCause cause)
{
  if (break_causes[cause].criterion) return break_causes[cause].criterion;
  return d->failure.criterion ? d->failure.criterion->name : "";
}

bool domain_bond_outside(const Domain *d, const BrokenBond *bond)
{
  return body_outside(&d->body, bond->a) && body_outside(&d->body, bond->b);
}

int64_t domain_count_broken(const Domain *d, int64_t counts[BREAK_CAUSES])
{
  int64_t outside = 0;
  memset(counts, 0, sizeof *counts * BREAK_CAUSES);
  for (int64_t n = 0; n < d->broken_count; ++n) {
    if (domain_bond_outside(d, &d->broken[n]))
      ++outside;
    else
      ++counts[d->broken[n].cause];
  }
  return outside;
}

void domain_bond_middle(const Domain *d, const int32_t bond[2], double middle[3])
{
  int64_t ends[2] = {bond[0], bond[1]};
  body_fold_bond(&d->body, ends);
  const bool outside[2] = {body_outside(&d->body, ends[0]), body_outside(&d->body, ends[1])};
  if (outside[0] != outside[1]) ends[outside[1]] = ends[outside[0]];
  for (int k = 0; k < 2; ++k) ends[k] = body_original(&d->body, ends[k]);
  const int32_t a = d->particles->place_of[ends[0]], b = d->particles->place_of[ends[1]];
  double *const *x = d->particles->position;
  for (int k = 0; k < 3; ++k) middle[k] = without_rounding((x[k][a] + x[k][b]) / 2, d->family.horizon);
}

int domain_record(Domain *d, const BrokenBond *bond)
{
  if (!make_room((void **)&d->broken, sizeof *d->broken, d->broken_count, &d->broken_capacity)) return BRECCIA_FAILURE;
  d->broken[d->broken_count++] = *bond;
  return BRECCIA_OK;
}

/** Of places whose bonds share energies. */
static void note_torn(Domain *d, int32_t place)
{
  if (d->is_torn[place] || domain_region(d, place)->type->bond_energy) return;
  if (!make_room((void **)&d->torn, sizeof *d->torn, d->torn_count, &d->torn_capacity)) {
    d->out_of_memory = true;
    return;
  }
  d->is_torn[place] = 1;
  d->torn[d->torn_count++] = (Torn){.place = place};
}

/** Half of the work that two stresses do together along a change of strain. */
static double half_work(const double a[6], const double b[6], const double from[6], const double to[6])
{
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += 0.5 * (a[k] + b[k]) * (to[k] - from[k]);
  return sum;
}

static const double nothing[6];

/** Begins the strains of a place's point where they begin for its law: what the free strain grows by in the step does not strain it. */
static void take_growth_off(const Domain *d, int32_t place, double from[6])
{
  for (int k = 0; k < 3 && d->particles->free_growth; ++k) from[k] += d->particles->free_growth[place];
}

/** What a place that will be torn has received so far. */
static void find_received(const Domain *d, Torn *torn)
{
  const Region *region = domain_region(d, torn->place);
  const Points *points = &region->points;
  StoredEnergy energy;
  region->type->stored_energy(region->formulation, torn->place, d->clock.time_step, &energy);
  for (int k = 0; k < 6 && points_on_particles(points); ++k) {
    torn->strain[k] = points->strain[k][torn->place];
    torn->stress[k] = points->stress[k][torn->place];
  }
  torn->elastic = points_on_particles(points) ? points_elastic_energy(points, torn->place) : 0;
  take_growth_off(d, torn->place, energy.was);
  torn->received = energy.received + energy.control +
                   energy.weight * (torn->elastic + half_work(torn->stress, nothing, energy.was, energy.strain));
  torn->share = region->type->shares(region->formulation)[torn->place];
}

/** Notes a place that loses its first bond of the step because of others that broke in it. */
static void note_late(Domain *d, int32_t place)
{
  const int64_t before = d->torn_count;
  note_torn(d, place);
  if (d->torn_count > before) find_received(d, &d->torn[before]);
}

/** Finds value, limit and quantity by which the criterion judges a bond, without the temporary raise of limits that
 *  orders the breaking of bonds. Value and limit are NaN for criteria without a value. */
static void breaking_measure(Domain *d, BreakingBond *b)
{
  b->value = b->limit = NAN;
  b->quantity = 0;
  if (!d->failure.criterion || !d->failure.criterion->measure) return;
  const Bond bond = family_bond(&d->family, b->slice, b->slot, b->lane);
  const double beyond = d->failure.beyond;
  d->failure.beyond = 0;
  b->value = d->failure.criterion->measure(&d->failure, &d->family, b->slice, b->slot, &bond, b->lane, &b->limit,
                                           &b->quantity);
  d->failure.beyond = beyond;
}

/** Replaces value, limit and quantity of a criterion by those of another cause of a broken bond. */
static void breaking_measure_cause(const Domain *d, const BreakingBond *b, BrokenBond *broken)
{
  const Region *own = domain_region(d, b->slice * SLICE);
  if (b->cause == BREAK_LIMIT) return;
  broken->quantity = 0;
  broken->limit = NAN;
  if (b->cause == BREAK_LAW) {
    const Bond bond = family_bond(&d->family, b->slice, b->slot, b->lane);
    broken->value = failure_stretch(&d->family, b->slice * SLICE + b->lane, &bond);
  } else {
    broken->value = own->type->evenness(own->formulation, b->slice, b->slot, b->lane);
    broken->limit = FORMULATION_LEAST_EVENNESS;
  }
}

/** Returns the material whose limit or law decides on a bond: that of the place, or of the neighbour if its limit is
 *  smaller. */
static int breaking_material(const Domain *d, int64_t place, int64_t neighbour, BreakCause cause)
{
  const int own = d->material[place / SLICE], other = d->material[neighbour / SLICE];
  const bool has_limits = cause == BREAK_LIMIT && d->failure.limit;
  return has_limits && d->failure.limit[other] < d->failure.limit[own] ? other : own;
}

/** Returns E_c / E, the energy of a bond at its limit over its present energy. In equilibrium E exceeds E_c where an
 *  increment or a running crack has carried the bond beyond its limit; the difference is added to the shed energy.
 *  Returns 1 in motion. */
static double find_share(Domain *d, const BreakingBond *b, const Moment *moment)
{
  if (!moment->most || !d->failure.criterion) return 1;
  const Bond bond = family_bond(&d->family, b->slice, b->slot, b->lane);
  const double ratio = b->limit / b->value;
  const double share = !(b->value > b->limit) ? 1 : d->failure.criterion->power == 2 ? ratio * ratio : ratio;
  const double weight = d->failure.influence->value(fmin(1, bond.length / d->family.horizon), bond.length) *
                        bond.length * bond.length * d->particles->volume[b->slice * SLICE + b->lane] *
                        d->particles->volume[bond.neighbour];
  d->energy_at_limit += weight;
  d->energy_held += weight / share;
  return share;
}

/** Adds energy that broken bonds held. */
static void book(Domain *d, double energy, double share)
{
  d->fracture_energy += share * energy;
  d->shed_energy += (1 - share) * energy;
}

/** Returns the mean of the shares of the bonds that break in the step under way. */
static double mean_share(const Domain *d)
{
  return d->energy_held > 0 ? d->energy_at_limit / d->energy_held : 1;
}

/** Returns the energy of a stranded bond at its limit, of which the part inside the body counts. A stranded bond lost
 *  its members to other broken bonds; its points lost the energy with these members. */
static double stranded_energy(const Domain *d, int64_t slice, int64_t slot, int lane, int32_t neighbour)
{
  const Criterion *criterion = d->failure.criterion;
  if (!criterion || !criterion->energy_at_limit) return 0;
  const double inside = ((d->counted[slice * SLICE + lane] > 0) + (d->counted[neighbour] > 0)) / 2.0;
  return inside * criterion->energy_at_limit(&d->failure, &d->family, slice, slot, lane) / (1 + d->failure.beyond);
}

/** Breaks a bond. @return the energy that it held where the share of the limit in it is that of all bonds of the step:
 *  where bonds share points, what each takes depends on their order, and only the sum does not */
static double break_bond(Domain *d, const BreakingBond *b, const Moment *moment)
{
  const int32_t place = (int32_t)(b->slice * SLICE + b->lane), neighbour = b->neighbour, *number = d->particles->number;
  const int32_t one = number[place], other = number[neighbour];
  const Region *own = domain_region(d, place), *their = domain_region(d, neighbour);
  StoredEnergy energy;
  const double inside = d->counted[place] > 0, beyond = d->counted[neighbour] > 0; /* each end holds half */
  BrokenBond bond = {.step = moment->step,
                     .time = moment->time,
                     .a = one < other ? one : other,
                     .b = one < other ? other : one,
                     .cause = b->cause,
                     .value = b->value,
                     .limit = b->limit,
                     .quantity = b->quantity,
                     .material = breaking_material(d, place, neighbour, b->cause)};
  const double share = b->cause == BREAK_ISOLATED ? 1 : find_share(d, b, moment);
  double shared = 0;
  breaking_measure_cause(d, b, &bond);
  if (own->type->bond_energy) {
    own->type->bond_energy(own->formulation, b->slice, b->slot, b->lane, moment->time_step, &energy);
    if (own->type->face_force)
      shared += energy.inside;
    else
      book(d, (their == own ? (inside + beyond) / 2 : inside) * energy.received, share);
  }
  if (their != own && their->type->bond_energy) {
    their->type->bond_energy(their->formulation, neighbour / SLICE, family_slot(&d->family, neighbour, place),
                             neighbour % SLICE, moment->time_step, &energy);
    if (their->type->face_force)
      shared += energy.inside;
    else
      book(d, beyond * energy.received, share);
  }
  if (domain_record(d, &bond)) {
    d->out_of_memory = true;
    return shared;
  }
  family_break(&d->family, place, neighbour);
  forces_bond_broke(&d->forces, place, neighbour);
  d->suspects[neighbour / SLICE] = 1;   /* so that its family is renewed */
  d->look_again[neighbour / SLICE] = 0; /* families that lose a bond may pull more at others */
  return shared;
}

/** True if a bond was squeezed at the beginning of the step. It has then done more work in this step than it had received, and would
 *  give it if it broke now; it waits for the next step. */
static bool was_squeezed(const Domain *d, const Moment *moment, const Bond *bond, int32_t place)
{
  const Particles *p = d->particles;
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double moved = moment->time_step * (p->velocity.row[k][bond->neighbour] - p->velocity.row[k][place]);
    const double y = bond->xi[k] + p->displacement.row[k][bond->neighbour] - p->displacement.row[k][place] - moved;
    square += y * y;
  }
  const double natural = (1 + particles_free_strain(p, place, bond->neighbour)) * bond->length;
  return square < (1 - 1e-9) * natural * natural;
}

/** Adds a bond to those that break in the step under way, with its value and limit before any of them breaks. */
static void take_breaking(Domain *d, BreakingBond *b)
{
  if (!make_room((void **)&d->breaking, sizeof *d->breaking, d->breaking_count, &d->breaking_capacity)) {
    d->out_of_memory = true;
    return;
  }
  breaking_measure(d, b);
  d->breaking[d->breaking_count++] = *b;
}

/** Goes through the bonds of the suspect slices in order and judges them while all are intact.
 *  @param[in] takes  whether the bonds that break are put into d->breaking
 *  @return how many break; each may be met from both its ends, of which those outside the body's supports do not count:
 *  what breaks there is the image of what breaks inside */
static int64_t judge(Domain *d, const Moment *moment, bool takes)
{
  const Family *f = &d->family;
  const uint8_t *gave_up = d->gave_up;
  int64_t count = 0;
  d->breaking_count = 0;
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    if (!d->suspects[s]) continue;
    for (int64_t slot = f->first[s]; slot < f->first[s + 1] && !d->out_of_memory; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        const Bond bond = family_bond(f, s, slot, lane);
        const int32_t place = (int32_t)(s * SLICE + lane);
        const bool law = gave_up && gave_up[place];
        if (!law && !(d->failure.criterion && d->failure.criterion->exceeds(&d->failure, f, s, slot, &bond, lane) &&
                      !was_squeezed(d, moment, &bond, place)))
          continue;
        count += !body_outside(&d->body, d->particles->number[place]);
        BreakingBond b = {s, slot, lane, bond.neighbour, law ? BREAK_LAW : BREAK_LIMIT, NAN, NAN, 0};
        if (takes) take_breaking(d, &b);
      }
  }
  return count;
}

/** Raises all limits such that no more bonds than wanted are beyond them; bonds that are loaded alike break together. */
static void raise_limits(Domain *d, const Moment *moment)
{
  const double close = 1e-6;
  const int64_t most = 2 * moment->most; /* each bond may count twice */
  double *beyond = &d->failure.beyond, low = 0, high = 0.5;
  int64_t above;
  if (!moment->most || !d->failure.criterion || judge(d, moment, false) <= most) return;
  const double endless = 1e30; /* bonds of laws that gave up count whatever the limits are */
  while (*beyond = high, (above = judge(d, moment, false)) > most && high < endless) {
    low = high;
    high *= 2;
  }
  while (high - low > close * (1 + high)) {
    *beyond = (low + high) / 2;
    const int64_t count = judge(d, moment, false);
    if (count > most) {
      low = *beyond;
      continue;
    }
    high = *beyond;
    above = count;
  }
  *beyond = above ? high : low;
}

/** Breaks intact bonds that can carry nothing any more, since others around them broke: what counts bonds, and contact,
 *  should know. Slices beside broken bonds are among the suspects. What they still held is fracture energy.
 *  @param[in,out] limits  grows by their energies at their limits
 *  @return whether there were any */
static bool break_stranded(Domain *d, const Moment *moment, double *limits)
{
  const Family *f = &d->family;
  const int64_t before = d->broken_count;
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    const Region *region = domain_region(d, s * SLICE);
    if (!d->suspects[s] || !region->type->evenness) continue;
    for (int64_t slot = f->first[s]; slot < f->first[s + 1] && !d->out_of_memory; ++slot)
      for (int lane = 0; lane < SLICE; ++lane)
        if (f->intact[slot] >> lane & 1 &&
            !(region->type->evenness(region->formulation, s, slot, lane) > FORMULATION_LEAST_EVENNESS)) {
          const int32_t neighbour = family_bond(f, s, slot, lane).neighbour;
          const uint8_t *kept = d->failure.kept;
          if (kept && kept[s * SLICE + lane] & kept[neighbour]) continue;
          note_late(d, (int32_t)(s * SLICE + lane));
          note_late(d, neighbour);
          *limits += stranded_energy(d, s, slot, lane, neighbour);
          const BreakingBond bond = {s, slot, lane, neighbour, BREAK_ISOLATED, NAN, NAN, 0};
          book(d, break_bond(d, &bond, moment), 1);
        }
  }
  return d->broken_count > before;
}

static void break_suspects(Domain *d, const Moment *moment)
{
  double shared = 0, stranded = 0;
  for (int64_t n = 0; n < d->breaking_count && !d->out_of_memory; ++n) {
    const BreakingBond *b = &d->breaking[n];
    if (d->family.intact[b->slot] >> b->lane & 1) shared += break_bond(d, b, moment); /* not yet from its other end */
  }
  while (d->broken_count > d->broken_before && !d->out_of_memory && break_stranded(d, moment, &stranded)) continue;
  /* Energy at the limits of stranded bonds is fracture energy, as far as the others shed so much. */
  const double at_limits = mean_share(d) * shared, fracture = fmin(at_limits + stranded, fmax(at_limits, shared));
  d->fracture_energy += fracture;
  d->shed_energy += shared - fracture;
  uint8_t *gave_up = d->gave_up;
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    if (!d->suspects[s]) continue;
    const Region *region = domain_region(d, s * SLICE);
    if (d->broken_count > d->broken_before && region->type->renew) region->type->renew(region->formulation, s);
    for (int lane = 0; gave_up && lane < SLICE; ++lane)
      if (gave_up[s * SLICE + lane]) gave_up[s * SLICE + lane] = CONSUMED;
  }
}

/** What the same places would have received with the bonds that are left. The law of a point goes from its strain at the beginning of the step
 *  with all bonds to that at its end without the broken ones: the work along that way, less what forces do of it in this step. */
static void find_left(Domain *d, const Region *region)
{
  const Points *points = &region->points;
  TEAM_FOR (n, d->torn_count) {
    Torn *torn = &d->torn[n];
    if (domain_region(d, torn->place) != region) continue;
    StoredEnergy energy;
    double strain[6] = {0}, stress[6] = {0};
    region->type->stored_energy(region->formulation, torn->place, d->clock.time_step, &energy);
    for (int k = 0; k < 6 && points_on_particles(points); ++k) {
      strain[k] = points->strain[k][torn->place];
      stress[k] = points->stress[k][torn->place];
    }
    torn->control = energy.control;
    take_growth_off(d, torn->place, energy.was);
    take_growth_off(d, torn->place, torn->strain);
    const double density = torn->elastic + half_work(torn->stress, stress, torn->strain, strain);
    /* of points not as their laws unload, which laws in servers are not asked */
    torn->stored = points_on_particles(points) ? energy.weight * density : energy.stored;
    torn->carried = energy.received + energy.weight * (density - half_work(stress, nothing, energy.was, energy.strain));
  }
}

/* Of the energy that a family stores. Both what it had received and what it would have received are products of the strains at the beginning
 * and the end of a step. Where it was hardly strained at the beginning they are small and of either sign, from the turning of its bonds, and
 * their ratio, which would stay with it for good, says nothing. What it may gain there is less than this share. */
static const double SMALL_SHARE = 0.02;

/** A family whose strain grows as it loses bonds would have received what nobody has put in: it carries less from here on. */
static void carry_less(Domain *d, Torn *torn)
{
  if (torn->carried + torn->control <= torn->received || torn->carried <= SMALL_SHARE * torn->stored) return;
  const double factor = fmax(0, torn->received - torn->control) / torn->carried;
  const Region *region = domain_region(d, torn->place);
  region->type->shares(region->formulation)[torn->place] *= factor;
  region->type->renew(region->formulation, torn->place / SLICE);
  d->is_torn[torn->place] = 2;
  torn->carried *= factor;
}

void domain_settle(Domain *d, const Region *region)
{
  TEAM_SINGLE if (d->torn_count > 0) domain_halve_strains(d);
  find_left(d, region);
  TEAM_SINGLE if (d->particles->free_growth) domain_tell_strains(d, d->clock.time);
  TEAM_SINGLE
  for (int64_t n = 0; n < d->torn_count; ++n) {
    if (domain_region(d, d->torn[n].place) != region) continue;
    carry_less(d, &d->torn[n]);
    if (d->counted[d->torn[n].place] > 0)
      book(d, d->torn[n].received - d->torn[n].carried - d->torn[n].control, mean_share(d));
  }
}

static void forget_torn(Domain *d)
{
  for (int64_t n = 0; n < d->torn_count; ++n) d->is_torn[d->torn[n].place] = 0;
  d->torn_count = 0;
}

void domain_break(Domain *d, const Moment *moment)
{
  const bool judges = (d->failure.criterion || d->gave_up) && !domain_in_elastic_stage(d);
  TEAM_SINGLE
  {
    d->broken_before = d->broken_count;
    d->energy_at_limit = d->energy_held = 0;
    d->motion += moment->motion;
    d->failure.moved = moment->motion;
    domain_tell_time(d, moment->time, moment->time_step);
  }
  if (d->forces.count) {
    TEAM_SINGLE forces_follow(&d->forces, moment->motion);
  }
  if (!judges) return;
  TEAM_FOR (b, d->batch_count)
    for (int64_t s = d->batches[b].first; s < d->batches[b].last; ++s) {
      d->suspects[s] = 0;
      if (d->failure.criterion && d->motion >= d->look_again[s])
        d->look_again[s] = d->motion + d->failure.criterion->suspect(&d->failure, &d->family, s, &d->suspects[s]);
      for (int lane = 0; d->gave_up && lane < SLICE; ++lane)
        if (d->gave_up[s * SLICE + lane]) d->suspects[s] = 1;
    }
  TEAM_SINGLE
  {
    d->any_suspect = memchr(d->suspects, 1, (size_t)d->particles->slices) != NULL;
    if (d->any_suspect) domain_halve_strains(d);
    if (d->any_suspect) raise_limits(d, moment);
    if (d->any_suspect) judge(d, moment, true);
    for (int64_t n = 0; d->any_suspect && n < d->breaking_count; ++n) {
      note_torn(d, (int32_t)(d->breaking[n].slice * SLICE + d->breaking[n].lane));
      note_torn(d, d->breaking[n].neighbour);
    }
  }
  if (!d->any_suspect) return;
  TEAM_FOR (n, d->torn_count) find_received(d, &d->torn[n]);
  forces_remember(&d->forces);
  TEAM_SINGLE
  {
    break_suspects(d, moment);
    d->failure.beyond = 0;
    if (d->particles->free_growth) domain_tell_strains(d, moment->time);
    CHECK(family_is_valid(&d->family));
  }
}

void domain_accept(Domain *d)
{
  TEAM_SINGLE
  {
    forget_torn(d);
    uint8_t *gave_up = d->gave_up;
    for (int64_t i = 0; gave_up && d->any_suspect && i < d->particles->places; ++i) gave_up[i] &= (uint8_t)~CONSUMED;
  }
}

void domain_mend(Domain *d)
{
  for (int64_t n = 0; n < d->torn_count; ++n) {
    const Region *region = domain_region(d, d->torn[n].place);
    region->type->shares(region->formulation)[d->torn[n].place] = d->torn[n].share;
  }
  for (int64_t n = d->broken_before; n < d->broken_count; ++n) {
    const int32_t a = d->particles->place_of[d->broken[n].a], b = d->particles->place_of[d->broken[n].b];
    family_mend(&d->family, a, b);
    forces_bond_mended(&d->forces, a, b);
    for (int end = 0; end < 2; ++end) {
      const Region *region = domain_region(d, end ? b : a);
      if (region->type->renew) region->type->renew(region->formulation, (end ? b : a) / SLICE);
    }
  }
  for (int64_t n = 0; n < d->torn_count; ++n) { /* where memory was out, bonds did not break that were to */
    const Region *region = domain_region(d, d->torn[n].place);
    if (region->type->renew) region->type->renew(region->formulation, d->torn[n].place / SLICE);
  }
  forget_torn(d);
  d->broken_count = d->broken_before;
  d->out_of_memory = false;
  memset(d->look_again, 0, sizeof *d->look_again * (size_t)d->particles->slices);
  forces_undo(&d->forces);
}

/** Scratch state of a timed pass of the criterion: slices to test, and whether every step tests all of them. */
typedef struct CriterionPass {
  Domain *domain;
  int64_t slices;
  bool every_step;
} CriterionPass;

static void breaking_test_slice(void *context, int64_t index)
{
  CriterionPass *pass = context;
  const Failure *failure = &pass->domain->failure;
  uint8_t suspect = 0;
  const double motion = failure->criterion->suspect(failure, &pass->domain->family, index, &suspect);
  if (index == 0) pass->every_step = motion == 0;
}

double domain_criterion_seconds(Domain *d, double enough)
{
  enum { FIRST = 64 };
  const double stretch = 1e-12; /* criteria skip bonds that are not longer than in the reference configuration */
  Particles *p = d->particles;
  const size_t bytes = sizeof(double) * (size_t)p->places;
  double *kept =
      d->failure.criterion && d->failure.criterion->suspect ? memory_plain(3 * (size_t)p->places, sizeof *kept) : NULL;
  if (!kept) return 0;
  for (int k = 0; k < 3; ++k) {
    memcpy(kept + (size_t)k * (size_t)p->places, p->displacement.row[k], bytes);
    for (int64_t i = 0; i < p->places; ++i) p->displacement.row[k][i] = stretch * p->position[k][i];
  }
  CriterionPass pass = {.domain = d};
  double seconds = 0;
  for (int64_t slices = FIRST; pass.slices < p->slices && seconds < enough; slices *= 2) {
    const double begin = clock_seconds();
    pass.slices = slices < p->slices ? slices : p->slices;
    team_each(pass.slices, breaking_test_slice, &pass);
    seconds = clock_seconds() - begin;
  }
  for (int k = 0; k < 3; ++k) memcpy(p->displacement.row[k], kept + (size_t)k * (size_t)p->places, bytes);
  free(kept);
  return pass.every_step ? seconds * (double)p->slices / (double)pass.slices : 0;
}
