/* Control of zero-energy modes that fades where the law of a point softens (docs/theory.md 8.7): it would hold cracks together for good. Or where it
 * yields, too, if it is asked to: it would carry ever more beside what flows.
 *
 * Of what C is in families with all their bonds a point keeps the factor
 *   f = least so far of  s : e / e : C_0 : e  times  min(1, w_most / w),
 * the stiffness that the point has left (C_0 the law's first moduli), and what the control may store: w = sum weight z . C z / 2, z = eta - G xi,
 * is what it would store as it was, w_most a share of the energy with which the law begins to soften. The second factor
 * is for points that a crack's far edge passes, whose strain is small where few of their bonds bridge a wide crack. It
 * applies only to points whose factor, or that of a neighbour or of a neighbour's neighbour, was below 1 in an earlier
 * step.
 *
 * If control fades with yielding, a point whose law yields without softening takes the smallest of s : e / e : C_0 : e,
 * of the stiffness left in shear,
 *   s_d : e_d / (2 G e_d : e_d)  with the deviators s_d and e_d,
 * because the energy of a pressure does not change as ground slides, and, if the influence decreases with distance, of
 *   most_resisted q / (G sqrt(2 w / G)),  q = sqrt(J_2).
 * Slip lines are narrower than families. The strain of a family contains a part of the motion of a slip line; control
 * would resist the other part in addition to the strength of the law. The last bound applies to points near those
 * whose laws have yielded, too (two families wide): their laws stay elastic beside a slip line, and their control would hold it.
 *
 * Each point has its own factor for all its bonds, so that z stays what is left by the best fit, and forces follow from an energy. A step takes the
 * factors that were committed with the one before: forces are then linear in what they were, and the tangent symmetric. */
#include "formulation/correspondence.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double most_stored = 0.125;  /* share of the energy at the onset of softening that control may store */
static const double most_resisted = 0.03; /* share of the shear stress of a yielding law that control may carry */
static const double roundings = 1e-6;     /* loss of stiffness below which a point counts as intact */

/** Marks of slices (`mark`) and of places (`near`). */
enum {
  TRIED = 1,    /* of slices: a factor was below 1 in some trial */
  SOFTENED = 2, /* a committed factor is below 1 */
  BESIDE = 4,   /* of places: the factor of a neighbour is below 1; of slices: some place has BESIDE or NEAR */
  NEAR = 8,     /* of places: the factor of a neighbour's neighbour is below 1 */
  SPREAD = 16   /* of places: neighbours have been marked */
};

struct Fading {
  double *used,
      *next;        /* [places] factors in the forces of the committed state, and in those of the step that follows */
  double *found;    /* [places] that step's own, for the one after it */
  double *whole[6]; /* C where nothing has faded; NULL of a uniform control */
  uint8_t *mark;    /* [slices] where it is 0, all factors are 1 */
  uint8_t *near;    /* [places] SOFTENED, BESIDE, NEAR and SPREAD; 0: the stored energy of control is not bounded */
  uint8_t *yields,
      *yielded;  /* [places] 1: the law has lost stiffness, in the step that is tried; in a committed step */
  bool softened; /* some are below 1 */
};

static bool fades_in(const Correspondence *c, const Material *m)
{
  return c->fades == FADES_WITH_YIELDING ? !m->law->linear
                                         : c->fades == FADES_WITH_SOFTENING && m->softening_energy > 0;
}

static bool fading_influence_falls(const void *formulation)
{
  return ((const Correspondence *)formulation)->influence_falls;
}

static bool fading_control_lasts(const void *formulation, const Material *material)
{
  const Correspondence *c = formulation;
  return c->control != CONTROL_NONE && !material->law->linear && !fades_in(c, material);
}

static bool fading_control_acts(const void *formulation)
{
  return ((const Correspondence *)formulation)->control != CONTROL_NONE;
}

static double fading_held(const void *formulation, int64_t place)
{
  StoredEnergy energy;
  correspondence_stored_energy(formulation, place, 0, &energy);
  return energy.held;
}

/** Returns true if the secant stiffness of a point from the unstrained state, that of all strains or that in shear, is
 *  less than 0.7 of the first stiffness of its law. */
static bool has_yielded(const Points *points, const Material *m, int64_t place)
{
  const double yielded = 0.7;
  double work = 0, deviators = 0, pressure = 0, strain[6];
  if (m->law->linear) return false;
  for (int k = 0; k < 6; ++k) {
    strain[k] = points->strain[k][place] + (points->initial[k] ? points->initial[k][place] : 0);
    work += points->stress[k][place] * strain[k];
    if (k < 3) pressure += points->stress[k][place];
  }
  const double volume = strain[XX] + strain[YY] + strain[ZZ];
  for (int k = 0; k < 3; ++k) deviators += 2 * pow(strain[k] - volume / 3, 2) + strain[k + 3] * strain[k + 3];
  const double shear = m->shear * deviators, elastic = m->bulk * volume * volume + shear;
  return work < yielded * elastic || work - pressure * volume / 3 < yielded * shear - roundings * elastic;
}

static void fading_yielded_energy(const void *formulation, int64_t place, YieldedEnergy *energy)
{
  const Correspondence *c = formulation;
  const Material *m = points_material(c->points, place);
  *energy = (YieldedEnergy){0};
  if (c->control == CONTROL_NONE || !has_yielded(c->points, m, place)) return;
  StoredEnergy stored;
  correspondence_stored_energy(c, place, 0, &stored);
  *energy = (YieldedEnergy){.stored = stored.stored, .held = stored.held};
  if (fading_control_lasts(c, m)) energy->lasting = stored.held;
}

const ControlType correspondence_control = {.is_active = fading_control_acts,
                                            .keeps_stiffness = fading_control_lasts,
                                            .influence_decreases = fading_influence_falls,
                                            .energy = fading_held,
                                            .yielded_energy = fading_yielded_energy};

bool correspondence_may_fade(const Correspondence *c, const FormulationParts *parts)
{
  bool may = false;
  for (int64_t slice = 0; slice < c->particles->slices; ++slice)
    may |= !is_foreign(c->foreign, slice * SLICE) && fades_in(c, &parts->materials[parts->material[slice]]);
  return may && c->control != CONTROL_NONE;
}

int correspondence_create_fading(Correspondence *c, Error *error)
{
  const int64_t places = c->particles->places;
  Fading *f = c->fading = memory_zeroed(1, sizeof *f, "zero-energy control", error);
  if (!f) return BRECCIA_FAILURE;
  f->used = places_array(places, "zero-energy control", error);
  f->next = places_array(places, "zero-energy control", error);
  f->found = places_array(places, "zero-energy control", error);
  f->mark = memory_zeroed((size_t)c->particles->slices, 1, "zero-energy control", error);
  f->near = memory_zeroed((size_t)places, 1, "zero-energy control", error);
  f->yields = memory_zeroed((size_t)places, 1, "zero-energy control", error);
  f->yielded = memory_zeroed((size_t)places, 1, "zero-energy control", error);
  bool failed = !f->used || !f->next || !f->found || !f->mark || !f->near || !f->yields || !f->yielded;
  for (int k = 0; k < hold_components(c->control); ++k) {
    failed |= !(f->whole[k] = places_array(places, "zero-energy control", error));
    if (f->whole[k]) memcpy(f->whole[k], c->hold[k], sizeof(double) * (size_t)places);
  }
  for (int64_t i = 0; i < places && !failed; ++i) f->used[i] = f->next[i] = f->found[i] = 1;
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void correspondence_destroy_fading(Correspondence *c)
{
  Fading *f = c->fading;
  if (!f) return;
  places_free(&f->used);
  places_free(&f->next);
  places_free(&f->found);
  for (int k = 0; k < 6; ++k) places_free(&f->whole[k]);
  free(f->mark);
  free(f->near);
  free(f->yields);
  free(f->yielded);
  free(f);
  c->fading = NULL;
}

size_t correspondence_fading_bytes(const Correspondence *c)
{
  if (!c->fading) return 0;
  const size_t numbers = 3 + (c->fading->whole[0] ? (size_t)hold_components(c->widest) : 0);
  return (size_t)c->particles->places * (numbers * sizeof(double) + 3) + (size_t)c->particles->slices;
}

/** C of a slice's places, by factors. */
static void set_hold(const Correspondence *c, int64_t slice, const double *factor)
{
  const Fading *f = c->fading;
  for (int k = 0; k < hold_components(c->control); ++k)
    for (int64_t i = slice * SLICE; i < (slice + 1) * SLICE; ++i)
      c->hold[k][i] = (f->whole[k] ? f->whole[k][i] : c->uniform) * factor[i];
}

/* ---- what a step finds ---- */

/** Returns the secant stiffness of four points over the first stiffness of their law [0 to 1]. If control fades with
 *  yielding and the law does not soften, the secant stiffness in shear if that is less: the energy of a pressure does
 *  not change as ground slides. */
LANES_INLINE Lanes stiffness_left(const Correspondence *c, const Material *m, const Sweep *sweep, int64_t here)
{
  Lanes strain[6], work = {0}, deviators = {0}, pressure = {0};
  for (int k = 0; k < 6; ++k) {
    strain[k] = lanes_load(sweep->strain[k] + here);
    if (c->points->initial[k]) strain[k] += lanes_load(c->points->initial[k] + sweep->first * SLICE + here);
    work += lanes_load(sweep->stress[k] + here) * strain[k];
    if (k < 3) pressure += lanes_load(sweep->stress[k] + here);
  }
  const Lanes volume = strain[XX] + strain[YY] + strain[ZZ], mean = volume * lanes_set(1.0 / 3);
  for (int k = 0; k < 3; ++k) {
    const Lanes deviator = strain[k] - mean;
    deviators += lanes_set(2) * deviator * deviator + strain[k + 3] * strain[k + 3];
  }
  const Lanes elastic = lanes_set(m->bulk) * volume * volume + lanes_set(m->shear) * deviators;
  const LaneMask lost = work < lanes_set(1 - roundings) * elastic;
  const Lanes share = work / lanes_choose(lost, elastic, lanes_set(1)); /* a point without strain has 0 of 0 */
  const Lanes left = lanes_choose(lost, lanes_greatest(lanes_set(0), share), lanes_set(1));
  if (c->fades != FADES_WITH_YIELDING || m->softening_energy > 0) return left;
  const Lanes shear = lanes_set(m->shear) * deviators, sheared = work - pressure * mean;
  const LaneMask slid = sheared < shear - lanes_set(roundings) * elastic;
  const Lanes of_shear = lanes_greatest(lanes_set(0), sheared) / lanes_choose(slid, shear, lanes_set(1));
  return lanes_choose(slid, lanes_least(left, of_shear), left);
}

/** What the control of four places would store per volume if nothing of it had faded. @param[in] g  [9][BATCH] G */
LANES_INLINE Lanes stored_whole(const Correspondence *c, double *const *u, int64_t place, const double *g)
{
  const Family *f = c->family;
  const int64_t slice = place / SLICE;
  const int half = (int)(place % SLICE / LANES);
  Lanes own[3], gradient[9], whole[6], sum = {0};
  for (int k = 0; k < 3; ++k) own[k] = lanes_load(u[k] + place);
  for (int k = 0; k < 9; ++k) gradient[k] = lanes_load(g + k * BATCH);
  for (int k = 0; k < hold_components(c->widest); ++k)
    whole[k] = c->fading->whole[k] ? lanes_load(c->fading->whole[k] + place) : lanes_set(c->uniform);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    Lanes xi[3] = {{0}}, z[3] = {{0}}, weight = {0}, square = {0};
    if (slot < f->stored[slice]) {
      const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
      const int64_t there = family_base(f, slice, slot) + LANES * half;
      weight = lanes_set(row->weight);
      for (int k = 0; k < 3; ++k) {
        xi[k] = lanes_set(row->xi[k]);
        z[k] = lanes_load(u[k] + there) - own[k];
      }
    } else {
      for (int lane = 0; lane < LANES; ++lane) {
        if (!(f->intact[slot] >> (LANES * half + lane) & 1)) continue;
        const Bond bond = family_bond(f, slice, slot, LANES * half + lane);
        weight[lane] = bond.weight;
        for (int k = 0; k < 3; ++k) {
          xi[k][lane] = bond.xi[k];
          z[k][lane] = u[k][bond.neighbour] - u[k][place + lane];
        }
      }
    }
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k) z[r] -= gradient[3 * r + k] * xi[k];
    for (int r = 0; r < 3; ++r) {
      if (c->widest == CONTROL_SCALAR) square += whole[0] * z[r] * z[r];
      for (int k = 0; c->widest == CONTROL_TENSOR && k < 3; ++k)
        square += whole[symmetric_place[3 * r + k]] * z[r] * z[k];
    }
    sum += lanes_where(lanes_half(f->intact[slot], half), weight * square);
  }
  return lanes_set(0.5) * sum;
}

/** Returns the shares of control for four points whose laws, or those of points near, have yielded. Control then resists motions outside of the
 * strain with at most `most_resisted` of the shear stress q = sqrt(J_2):
 *   f G sqrt(2 w / G) = most_resisted q,
 * where sqrt(2 w / G) is the shear strain that would store the energy w.
 * @param[in] stored  [4] w, energy per volume that the unreduced control would store */
LANES_INLINE Lanes resisting_share(const Material *m, const Sweep *sweep, int64_t here, Lanes stored)
{
  Lanes stress[6], squares = {0};
  for (int k = 0; k < 6; ++k) stress[k] = lanes_load(sweep->stress[k] + here);
  const Lanes mean = (stress[XX] + stress[YY] + stress[ZZ]) * lanes_set(1.0 / 3);
  for (int k = 0; k < 3; ++k) {
    const Lanes deviator = stress[k] - mean;
    squares += lanes_set(0.5) * deviator * deviator + stress[k + 3] * stress[k + 3];
  }
  const Lanes most = lanes_set(most_resisted * most_resisted) * squares, held = lanes_set(2 * m->shear) * stored;
  const LaneMask bound = held > most;
  return lanes_choose(bound, lanes_root(most / lanes_choose(bound, held, lanes_set(1))), lanes_set(1));
}

/** Returns the places whose factor, or that of a neighbour or of a neighbour's neighbour, was below 1 before. */
LANES_INLINE LaneMask fading_is_near(const Fading *f, int64_t place)
{
  LaneMask near = {0};
  for (int lane = 0; lane < LANES; ++lane) near[lane] = f->near[place + lane] ? -1 : 0;
  return near;
}

BRECCIA_CLONES
static void fade(const Correspondence *c, const Sweep *sweep)
{
  const Fading *f = c->fading;
  const Material *m = points_material(c->points, sweep->first * SLICE);
  const bool may = fades_in(c, m) && !c->points->clock->elastic_stage, softens = may && m->softening_energy > 0;
  const bool yields = c->fades == FADES_WITH_YIELDING && c->influence_falls;
  const double *strength = c->points->strength;
  const Lanes one = lanes_set(1), whole = lanes_set(most_stored * m->softening_energy);
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice) {
    if (f->mark[slice]) set_hold(c, slice, f->next);
    for (int64_t place = slice * SLICE; place < (slice + 1) * SLICE; place += LANES) {
      const int64_t here = place - sweep->first * SLICE;
      const Lanes factor = strength ? lanes_load(strength + place) : one, most = whole * factor * factor;
      Lanes left = may ? stiffness_left(c, m, sweep, here) : one;
      if (!f->mark[slice]) {
        const LaneMask lost = left < one;
        if (!(lost[0] | lost[1] | lost[2] | lost[3])) continue;
        f->mark[slice] = TRIED;
      }
      for (int lane = 0; lane < LANES; ++lane) f->yields[place + lane] = f->yielded[place + lane] || left[lane] < 1;
      const bool cracked = softens && f->mark[slice] & (SOFTENED | BESIDE), flows = may && yields && !softens;
      if (cracked || flows) {
        const Lanes stored = stored_whole(c, sweep->displacement, place, sweep->carry + here);
        const LaneMask near = fading_is_near(f, place);
        if (flows)
          left = lanes_choose((left < one) | near, lanes_least(left, resisting_share(m, sweep, here, stored)), left);
        if (cracked) left *= lanes_choose((stored > most) & near, most / stored, one);
      }
      lanes_store(f->found + place, lanes_least(lanes_load(f->next + place), left));
    }
  }
}

void correspondence_fade(const Correspondence *c, const Sweep *sweep)
{
  fade(c, sweep); /* clones would be seen outside the library */
}

/* ---- the committed state ---- */

/** From the first factor below 1 on C is no longer the same everywhere. */
static void set_control(Correspondence *c, bool softened)
{
  c->fading->softened = softened;
  const bool uniform = c->widest == CONTROL_SCALAR && !c->fading->whole[0];
  if (!uniform || softened == (c->control == CONTROL_SCALAR)) return;
  c->control = softened ? CONTROL_SCALAR : CONTROL_UNIFORM;
  c->pulls = pull_count(c->control);
  for (int64_t slice = 0; slice < c->particles->slices; ++slice) set_hold(c, slice, c->fading->used);
}

/** Marks the neighbours of a place. Broken bonds count as intact ones, so that a restart makes the same marks.
 *  @param[in] rings  1: neighbours, as NEAR; 2: neighbours, as BESIDE, and their neighbours, as NEAR */
static void fading_mark_family(const Correspondence *c, int64_t place, int rings)
{
  const Family *f = c->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    const int64_t there = slot < f->stored[slice] ? family_base(f, slice, slot) + lane
                                                  : f->neighbour[(int64_t)f->base[slot] * SLICE + lane];
    if (there < 0 || there >= c->particles->places) continue; /* lanes without a bond may lead beyond the lattice */
    const uint8_t ring = rings > 1 ? BESIDE : NEAR;
    const bool known = c->fading->near[there] & ring;
    c->fading->near[there] |= ring;
    c->fading->mark[there / SLICE] |= BESIDE;
    if (rings > 1 && !known) fading_mark_family(c, there, rings - 1);
  }
}

/** Marks a place whose factor is below 1 and its surroundings. Where laws yield without softening, a place that only the
 *  bound on control has reached marks no others: the bound would spread over the whole body. */
static void fading_mark_softened(const Correspondence *c, int64_t place)
{
  uint8_t *near = &c->fading->near[place];
  const bool softens = points_material(c->points, place)->softening_energy > 0;
  *near |= SOFTENED;
  c->fading->mark[place / SLICE] |= SOFTENED;
  if (!softens && !c->fading->yielded[place]) return;
  *near |= SPREAD;
  fading_mark_family(c, place, 2);
}

/** Marks the places whose factors have fallen below 1, and their surroundings.
 *  @return true if the factor of any place is below 1 */
static bool find_softened(const Correspondence *c)
{
  const Fading *f = c->fading;
  bool softened = false;
  for (int64_t slice = 0; slice < c->particles->slices; ++slice) {
    for (int64_t i = slice * SLICE; f->mark[slice] && i < (slice + 1) * SLICE; ++i)
      if (f->next[i] < 1 && !(f->near[i] & SPREAD)) fading_mark_softened(c, i);
    softened |= (f->mark[slice] & SOFTENED) != 0;
  }
  return softened;
}

void correspondence_commit(void *formulation, bool well)
{
  Correspondence *c = formulation;
  const Fading *f = c->fading;
  if (!f) return;
  const size_t bytes = sizeof(double) * SLICE;
  for (int64_t slice = 0; slice < c->particles->slices; ++slice) {
    const int64_t first = slice * SLICE;
    if (!f->mark[slice]) continue;
    if (well) memcpy(f->used + first, f->next + first, bytes);
    if (well) memcpy(f->next + first, f->found + first, bytes);
    if (well) memcpy(f->yielded + first, f->yields + first, SLICE);
    if (!well) set_hold(c, slice, f->used);
  }
  if (well) set_control(c, find_softened(c));
}

bool correspondence_lags(const void *formulation)
{
  const Correspondence *c = formulation;
  return c->fading && c->fading->softened;
}

/* Where soil yields, the hundredth that softening bodies may leave would carry a slope that slides: a tenth of its factor of safety came of it
 * (docs/theory.md 8.7). */
double correspondence_lag_allowed(const void *formulation)
{
  const Correspondence *c = formulation;
  if (!c->fading) return INFINITY;
  return c->fades == FADES_WITH_YIELDING ? 1e-3 : 1e-2;
}

/** Factors were put in place from outside. */
static int take_up(void *owner, const double *numbers, int64_t count, Error *error)
{
  (void)numbers, (void)count, (void)error;
  Correspondence *c = owner;
  memset(c->fading->mark, TRIED, (size_t)c->particles->slices);
  memset(c->fading->near, 0, (size_t)c->particles->places);
  const bool softened = find_softened(c);
  set_control(c, softened);
  for (int64_t slice = 0; slice < c->particles->slices; ++slice) {
    c->fading->mark[slice] &= (uint8_t)~TRIED;
    set_hold(c, slice, c->fading->used);
  }
  return BRECCIA_OK;
}

void correspondence_state(void *formulation, const char *part, StateList *list)
{
  static const StateCare care = {.resume = take_up};
  Correspondence *c = formulation;
  if (!c->fading) return;
  StateRow row = {.unit = "1",
                  .kind = STATE_NUMBERS,
                  .entity = STATE_OF_PLACE,
                  .role = STATE_COMMITTED,
                  .count = c->particles->places,
                  .values = c->fading->used};
  state_add(list, &row, "zero-energy control", part);
  row.values = c->fading->yielded;
  row.kind = STATE_BYTES;
  state_add(list, &row, "yielded, zero-energy control", part);
  row.kind = STATE_NUMBERS;
  row.values = c->fading->next;
  row.care = &care;
  row.owner = c;
  state_add(list, &row, "zero-energy control to come", part);
}
