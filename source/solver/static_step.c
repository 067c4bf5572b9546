/* Increments of statics, and the tries that make them. */
#include "solver/pieces.h"
#include "solver/static.h"

#include "loading/one_sided.h"
#include "loading/support.h"
#include "solver/resultants.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/** Works by the trapezium rule. Forces out of balance at the beginning, of a load that was there already or of bonds that have broken, do work that the
 *  body gives off on its way to rest.
 *  @param[in] moved  on the whole way */
static void book(Static *s, const Vector *moved)
{
  const Particles *p = s->domain->particles;
  const Increment *begin = &s->increment;
  const Vector *before = &s->newton.change; /* forces out of balance: of corrections nothing is wanted any more */
  const double bonds = increment_bond_work(&s->increment, moved);
  vector_weigh_sum(before, p->volume, &begin->internal, &begin->external);
  one_sided_add_pressed(s->loading, 1, before);
  unknowns_gather(&s->newton.linear.unknowns, before);
  const double given_off = 0.5 * (vector_inner(before, moved, 1) + vector_inner(&s->newton.force, moved, 1));
  s->ledger->bond_work += bonds - s->way.bonds;
  s->ledger->damping_work += given_off - s->way.given_off;
  s->ledger->external_work += bonds + given_off - s->way.bonds - s->way.given_off;
  s->ledger->paid =
      fmax(s->ledger->paid, s->newton.rounding_work); /* less says nothing of a body that moves as a whole */
  s->way.bonds = bonds;
  s->way.given_off = given_off;
}

static void book_sudden(Static *s, const Vector *moved)
{
  const double sudden = increment_sudden_work(&s->increment, moved);
  s->ledger->bond_work += sudden - s->way.sudden;
  s->ledger->external_work += sudden - s->way.sudden;
  s->way.sudden = sudden;
}

/** Returns true if the body softens within an increment that ended in equilibrium. The increment may then have passed a
 *  peak. It may also have found another equilibrium than shorter increments: cracking beams have several at one
 *  opening, and long increments find those with lower loads. The predicted work of the increment, less its work by the
 *  trapezium rule, bounds twice the error of that rule.
 *  @param[in] length  length of the increment */
static bool is_coarse(const Static *s, double length)
{
  const double most = 0.02, least = 1.0 / 16; /* of the largest work so far; of the increment of the deck */
  const Particles *p = s->domain->particles;
  if (!s->newton.change_forces.row[0] || s->takes_coarse || length / 2 < least * static_whole_increment(s->spec))
    return false;
  const double work =
      -0.5 * vector_inner_weighted(s->domain->counted, &s->increment.internal, &p->internal, &s->newton.moved);
  const double held = s->ledger->bond_work; /* an unloaded body gives it all back */
  return 0.5 * (s->newton.foreseen - work) > most * fmax(fabs(held), fabs(held + work));
}

bool static_may_relax(const Static *s)
{
  return !s->spec->control && !s->newton.relaxes;
}

static NewtonOutcome relax(Static *s, double end, Error *error)
{
  Newton *n = &s->newton;
  const bool always = n->relaxes;
  n->relaxes = true;
  if (!s->relaxation.velocity.row[0] && relaxation_create(&s->relaxation, n, error)) return NEWTON_FAILED;
  n->linear.elastic = &s->relaxation.elastic;
  if (n->log && !always) text_add(n->log, "  by dynamic relaxation\n");
  const NewtonOutcome outcome = relaxation_solve(&s->relaxation, n, end, s->spec->relaxation_iterations, error);
  n->relaxes = always;
  if (!always) n->linear.elastic = NULL;
  return outcome;
}

static NewtonOutcome descend(Static *s, double end, Error *error)
{
  enum { LONGER = 10 }; /* than by tangents */
  Newton *n = &s->newton;
  if (!s->descent.room.row[0] && descent_create(&s->descent, n, error)) return NEWTON_FAILED;
  if (n->log) text_add(n->log, "  by secants\n");
  return descent_solve(&s->descent, n, end, LONGER * s->spec->newton.iterations, error);
}

/** Solves the current increment with the current set of one-sided supports. */
static NewtonOutcome static_solve(Static *s, double end, Try how, Error *error)
{
  domain_tell_time(s->domain, end, end - s->clock->time);
  if (s->spec->control) {
    const double begin = s->clock->stage_time, whole = s->clock->stage_end - begin;
    s->newton.target = control_target(&s->control, (s->clock->time - begin) / whole, (end - begin) / whole);
  }
  if (how.by == BY_RELAXATION || s->newton.relaxes) return relax(s, end, error);
  return how.by == BY_SECANTS ? descend(s, end, error) : newton_solve(&s->newton, end, error);
}

/** Solves the current increment until no closed entry pulls and no open entry is passed. */
static NewtonOutcome static_press(Static *s, double end, Try how, Error *error)
{
  pressing_begin(&s->pressing, &s->newton);
  for (;;) {
    NewtonOutcome outcome = static_solve(s, end, how, error);
    if (!pressing_is_wrong(&s->pressing, &s->newton, end, &outcome)) return outcome;
    increment_retreat(&s->increment);
    s->relaxation.prepared = NAN;
    if (!pressing_choose(&s->pressing, &s->newton)) return NEWTON_SINGULAR;
  }
}

NewtonOutcome static_try(Static *s, double end, Try how, Error *error)
{
  if (how.again) {
    increment_begin_again(&s->increment);
  } else {
    increment_begin(&s->increment);
    s->way.bonds = s->way.given_off = s->way.sudden = 0;
  }
  NewtonOutcome outcome = static_press(s, end, how, error);
  if (outcome == NEWTON_CONVERGED && !s->newton.relaxes && !how.again && is_coarse(s, end - s->clock->time))
    outcome = NEWTON_COARSE;
  if (outcome == NEWTON_CONVERGED && static_is_impossible(s, end)) outcome = NEWTON_INVERTED;
  if (outcome != NEWTON_CONVERGED) {
    increment_retreat(&s->increment);
    if (how.again) newton_apply_loads(&s->newton, s->clock->time);
    return outcome;
  }
  if (how.again) vector_combine(1, &s->way.moved, 1, &s->newton.moved);
  if (static_may_slide(s)) static_note_motion(s);
  book(s, how.again ? &s->way.moved : &s->newton.moved);
  one_sided_accept(s->loading);
  if (s->spec->control) control_accept(&s->control, s->loading, s->newton.moved.row);
  increment_accept(&s->increment, &s->newton.moved);
  book_sudden(s, how.again ? &s->way.moved : &s->newton.moved);
  return outcome;
}

/** The stage ends now, before its time. */
static void end_now(Clock *clock)
{
  clock->ended = 1;
  clock->stage_last = clock->step;
  clock->stage_end = clock->time;
}

/** Counts an increment of zero length as the last one of the stage. */
static void static_count_empty_increment(Clock *clock)
{
  ++clock->step;
  clock->stage_last = clock->step;
}

/** Says why an increment is not taken as it is. */
static void tell_refused(const Static *s, NewtonOutcome outcome, bool settled, bool slides)
{
  char words[320];
  if (slides)
    text_add(s->newton.log, "    given back: the body slides by %.3g\n", s->travelled);
  else if (!settled)
    text_add(s->newton.log,
             "    given back: the control of zero-energy modes as it is leaves %.2g of the forces out of balance\n",
             s->lag);
  else
    text_add(s->newton.log, "    %s: %s\n",
             outcome == NEWTON_COARSE                               ? "cut"
             : outcome == NEWTON_LEFT || outcome == NEWTON_UNSTABLE ? "left to other ways"
                                                                    : "no equilibrium",
             newton_describe(&s->newton, outcome, words, sizeof words));
}

static const char static_slid[] = "with strengths divided further the body slides until it comes to rest elsewhere";

/** Why the body finds no equilibrium, for a message that ends the run: where a crack has cut a piece off that is loaded, this is why, whatever the
 *  equations say. @return `words` */
static const char *describe_failure(const Static *s, NewtonOutcome outcome, char *words, size_t size)
{
  LoosePiece loose = {0};
  char piece[256];
  if (outcome == NEWTON_SINGULAR && s->pressing.loose.pieces) {
    snprintf(words, size, "supports that only press would have to pull: once they let go, %s",
             pieces_describe(&s->pressing.loose, s->domain->particles, piece, sizeof piece));
    return words;
  }
  const bool known = outcome == NEWTON_LAW || outcome == NEWTON_FAR || !s->domain->broken_count;
  if (known || pieces_find_loose(&s->newton.linear.unknowns, PIECES_WORKED, &loose, NULL) || !loose.pieces)
    return newton_describe(&s->newton, outcome, words, size);
  snprintf(words, size, "broken bonds have cut the body, and %s",
           pieces_describe(&loose, s->domain->particles, piece, sizeof piece));
  return words;
}

/** Whether images that do not slide stand for a support: what cracks beside them loses its way behind the peak, as images hand no force on
 *  (docs/choosing.md). */
static bool has_fixed_images(const Domain *d)
{
  bool found = false;
  for (int k = 0; k < d->body.margins.count; ++k)
    found |= !d->body.margins.items[k].repeats && !support_slides(&d->body.margins.items[k]);
  return found;
}

/** No increment leads on from here, however short. */
static int fail(const Static *s, NewtonOutcome outcome, bool settled, bool slides, Error *error)
{
  char words[320];
  const char *tried = "",
             *advice = "the body may fail at this load: go on with a stage of 'explicit', or look at the loads and at "
                       "the last pictures";
  if (slides) {
    snprintf(words, sizeof words, "%s", static_slid);
    advice = "divide strengths by less in this stage, or make it the last one to find the factor of safety";
  } else if (!settled) {
    snprintf(words, sizeof words,
             "the control of zero-energy modes as far as it fades leaves %.2g of the forces out of balance", s->lag);
    advice = s->spec->control ? "prescribe displacements with 'method: relaxation' instead of 'control'"
             : s->newton.relaxes
                 ? "the body may fail at this load: allow more 'relaxation iterations', or go on with a "
                   "stage of 'explicit'"
                 : "the body may fail at this load: take 'method: relaxation' with more 'relaxation "
                   "iterations', or go on with a stage of 'explicit'";
  } else {
    describe_failure(s, outcome, words, sizeof words);
    if (outcome == NEWTON_SINGULAR && s->pressing.loose.pieces)
      advice = "look at the direction of the loads, hold the body there by another support or a soft spring, or go on "
               "with a stage of 'explicit'";
    else if (outcome == NEWTON_SLOW && s->newton.unbalanced <= s->spec->newton.residual)
      advice = "take a larger 'displacement tolerance' or 'energy tolerance'";
    else if (outcome == NEWTON_SLOW && domain_is_elastic(s->domain) && !s->newton.indefinite)
      advice = s->newton.relaxes ? "allow more 'relaxation iterations', or take a larger 'residual'"
                                 : "allow more 'iterations', or take a larger 'residual'";
    else if (domain_may_soften(s->domain) && static_may_relax(s)) {
      tried = "by Newton's method, descent by secants and dynamic relaxation; at last ";
      advice = "the body may fail at this load: take 'method: relaxation' with more 'relaxation iterations', "
               "go on with a stage of 'explicit', as by 'quasi-static', or look at the loads and at the last pictures";
    } else if (s->spec->control && domain_may_soften(s->domain) && has_fixed_images(s->domain)) {
      advice = "the body may fail at this load; where it cracks along a support 'held: all', hold layers by "
               "'displacement' instead, beside which the branch behind the peak can be followed";
    }
  }
  return error_add(error, BRECCIA_FAILURE,
                   "static: no equilibrium beyond time %g %s, with increments cut to %.2g %s: %s%s; %s", s->clock->time,
                   s->clock->time_unit, s->next, s->clock->time_unit, tried, words, advice);
}

/** Returns true if forces act in the stage, and no prescribed motion changes in it. */
static bool static_is_driven_by_forces(const Static *s)
{
  const Loading *loading = s->loading;
  const double begin = s->clock->stage_time, end = s->clock->stage_end;
  bool forces = false;
  for (int k = 0; k < loading->count; ++k) {
    const Load *load = &loading->loads[k];
    forces |= load_acts(loading, load) && load->type->force && !load->type->brake && !load->type->energy &&
              load_magnitude(load->spec) != 0 && load_factor(load, end) != 0;
  }
  for (int n = 0; n < loading->constraint_count; ++n) {
    const Constraint *c = &loading->constraints[n];
    if (load_acts(loading, c->load) && c->value != 0 && load_factor(c->load, end) != load_factor(c->load, begin))
      return false;
  }
  return forces;
}

static int fail_with_broken(const Static *s, NewtonOutcome outcome, Error *error)
{
  char words[320];
  const bool slow = outcome == NEWTON_SLOW && s->newton.relaxes;
  return error_add(
      error, BRECCIA_FAILURE,
      "static: with %lld broken bonds the body finds no equilibrium any more at time %g %s: %s; it has "
      "failed at this load%s go on with "
      "a stage of 'explicit'%s",
      (long long)s->domain->broken_count, s->clock->time, s->clock->time_unit,
      describe_failure(s, outcome, words, sizeof words),
      slow ? ", or few bonds hold it together and it comes to rest slowly: allow more 'relaxation iterations'," : ":",
      static_is_driven_by_forces(s) ? ", or prescribe displacements instead of forces" : "");
}

/** The next stage goes on from where the body is: at the last state of rest, without the bonds that have broken since. */
static void hand_over(Solver *run, NewtonOutcome outcome, bool settled, bool slides, Text *warning)
{
  const Static *s = run->own;
  char words[320], name[64];
  Clock *clock = &run->clock;
  text_add_warning(warning, "static: no equilibrium beyond time %g %s: %s; stage '%s' goes on from there", clock->time,
                   clock->time_unit,
                   slides    ? static_slid
                   : settled ? describe_failure(s, outcome, words, sizeof words)
                             : "the control of zero-energy modes fades",
                   solver_stage_name(run, clock->stage + 1, name, sizeof name));
  end_now(clock);
}

/** Notes that the body jumped in the increment that the clock has just counted.
 *  @param[in] begin  time at the beginning of the increment */
static void note_jump(const Solver *run, double begin)
{
  Static *s = run->own;
  Jumps *j = &s->jumps;
  const int64_t step = s->clock->step;
  const int load = resultants_largest_at(run, begin);
  if (j->ranges && j->last[j->ranges - 1] == step - 1 && !j->omitted) {
    j->last[j->ranges - 1] = step;
  } else if (j->ranges < JUMP_RANGES) {
    j->first[j->ranges] = j->last[j->ranges] = step;
    ++j->ranges;
  } else {
    ++j->omitted;
  }
  if (load < 0) return;
  j->peak_step = step;
  j->peak_load = load;
  j->peak_begin = begin;
  j->peak_end = s->clock->time;
}

/** Adds the numbers of the increments in which the body jumped. */
static void tell_jump_numbers(const Jumps *j, Text *warning)
{
  text_add(warning, " (");
  for (int64_t k = 0; k < j->ranges; ++k) {
    text_add(warning, "%s%lld", k ? ", " : "", (long long)j->first[k]);
    if (j->last[k] > j->first[k]) text_add(warning, " to %lld", (long long)j->last[k]);
  }
  if (j->omitted) text_add(warning, " and %lld more", (long long)j->omitted);
  text_add(warning, ")");
}

/** Adds the jump at whose beginning a load or support has its largest force, and the remedy: the peak may lie within
 *  that jump. Adds nothing for a jump of no length, and in stages that reduce strengths. */
static void tell_peak_in_jump(const Solver *run, Text *warning)
{
  const double least = 1e-6; /* of the time: shorter increments end where they begin, as a message tells times */
  const Static *s = run->own;
  const Jumps *j = &s->jumps;
  if (loading_strength_reduction(run->loading, s->clock->stage, s->clock->time) !=
      loading_strength_reduction(run->loading, s->clock->stage, run->records[s->clock->stage].begin))
    return; /* forces of supports do not grow towards a peak */
  if (j->peak_step && !(j->peak_end - j->peak_begin > least * j->peak_end)) return;
  if (!j->peak_step || resultants_largest_at(run, j->peak_begin) < 0) {
    text_add(warning, "; no load or support had its largest force at the beginning of any of these increments");
    return;
  }
  const Load *load = &run->loading->loads[j->peak_load];
  text_add(warning, "; the largest force of ");
  if (load->spec->name)
    text_add(warning, "load '%s'", load->spec->name);
  else
    text_add(warning, "the load in line %d", load->spec->head.node->line);
  text_add(warning,
           " is that at the beginning of increment %lld, so that the peak may lie between %.6g %s and %.6g %s; compare "
           "with 'increments: %lld'",
           (long long)j->peak_step, j->peak_begin, s->clock->time_unit, j->peak_end, s->clock->time_unit,
           (long long)(2 * s->spec->increments));
}

/** Warns at the end of a stage of the increments in which the body jumped. */
static void tell_jumps(const Solver *run, Text *warning)
{
  const Static *s = run->own;
  text_add_warning(warning, "static: in %lld of %lld increments the body gave way",
                   (long long)(s->descended + s->relaxed), (long long)(s->clock->step - s->clock->stage_step));
  tell_jump_numbers(&s->jumps, warning);
  text_add(warning, ": Newton's method hardly came on, or found no equilibrium near, and ");
  if (s->descended) text_add(warning, "descent by secants%s", s->relaxed ? "" : " the state of rest at their ends");
  if (s->descended && s->relaxed) text_add(warning, " (in %lld) or ", (long long)s->descended);
  if (s->relaxed) text_add(warning, "dynamic relaxation the state of rest at their ends");
  text_add(warning, "; what is between is not followed");
  tell_peak_in_jump(run, warning);
}

/** Whether Newton's method is not asked alone any more, after it has failed: it hardly comes on, or there is no equilibrium near.
 *  @param[in] length  of the increment */
static bool is_stuck(const Static *s, NewtonOutcome outcome, double length)
{
  const double least = 1.0 / 16; /* of an increment as asked for */
  return outcome == NEWTON_LEFT || outcome == NEWTON_UNSTABLE ||
         s->newton.iterations > s->spec->newton.iterations + 1 ||
         length / 2 < fmax(least, s->spec->smallest) * static_whole_increment(s->spec);
}

static bool came_to_equilibrium(NewtonOutcome outcome)
{
  return outcome == NEWTON_CONVERGED || outcome == NEWTON_COARSE;
}

NewtonOutcome static_try_others(Static *s, NewtonOutcome outcome, double end, bool *may_relax, TryBy *way, Error *error)
{
  const bool bonds = domain_bonds_may_soften(s->domain);
  const TryBy ways[] = {bonds ? BY_RELAXATION : BY_SECANTS, bonds ? BY_SECANTS : BY_RELAXATION};
  for (int k = 0; k < 2 && outcome < NEWTON_STOPPED && !came_to_equilibrium(outcome); ++k) {
    if (ways[k] == BY_RELAXATION && !*may_relax) continue;
    tell_refused(s, outcome, true, false);
    outcome = static_try(s, end, (Try){.by = ways[k]}, error);
    if (outcome == NEWTON_CONVERGED && ways[k] > *way) *way = ways[k];
    if (ways[k] == BY_RELAXATION) *may_relax = came_to_equilibrium(outcome);
  }
  return outcome;
}

/** Tries an increment by Newton's method, and by other ways where the method is stuck or leads to an equilibrium in
 * which the body does not stay: the body jumps to another equilibrium. Under control a failed try is repeated with
 * secants of softened bonds in the first iteration, because tangents of loading cannot show which bonds unload.
 *  @param[in,out] may_relax  until that was tried in vain; @param[out] way  what found equilibrium */
static NewtonOutcome try_first(Static *s, double end, bool *may_relax, TryBy *way, Error *error)
{
  const bool others = domain_may_soften(s->domain) && static_may_relax(s);
  s->newton.has_others = others && domain_bonds_may_soften(s->domain) && *may_relax;
  s->newton.wants_stable = others && domain_bonds_may_soften(s->domain);
  NewtonOutcome outcome = static_try(s, end, (Try){0}, error);
  s->newton.has_others = s->newton.wants_stable = false;
  if (s->spec->control && domain_bonds_may_soften(s->domain) && outcome < NEWTON_STOPPED &&
      !came_to_equilibrium(outcome)) {
    tell_refused(s, outcome, true, false);
    s->newton.begins_by_secants = true;
    outcome = static_try(s, end, (Try){0}, error);
    s->newton.begins_by_secants = false;
  }
  if (outcome >= NEWTON_STOPPED || came_to_equilibrium(outcome) || !others ||
      !is_stuck(s, outcome, end - s->clock->time))
    return outcome;
  return static_try_others(s, outcome, end, may_relax, way, error);
}

/** What tries have learned for those to come. */
typedef struct Learned {
  double next;
  int64_t cuts, given_up;
} Learned;

/** A step that has failed for good before anything came of it, or was stopped. */
static int give_up(Static *s, const Learned *before, int status)
{
  s->next = before->next;
  s->cuts = before->cuts;
  if (status != BRECCIA_INTERRUPTED) return status;
  s->newton.linear.given_up = before->given_up; /* a restart comes to the same bits */
  s->relaxation.prepared = NAN;
  return status;
}

int static_advance(Solver *run, Text *warning, Error *error)
{
  Static *s = run->own;
  Clock *clock = &run->clock;
  const Learned before = {s->next, s->cuts, s->newton.linear.given_up};
  const bool was_spent = control_is_spent(&s->control);
  const int64_t broken = s->domain->broken_count;
  const double began = clock->time;
  s->takes_coarse = false;
  int64_t iterations = 0;
  bool may_relax = true;
  TryBy way;
  static_begin_reduction(run);
  if (increment_keep(&s->increment, run, error) || static_keep(run, error)) return BRECCIA_FAILURE;
  s->newton.log = &run->log;
  s->newton.interrupted = run->interrupted;
  for (int64_t cut = 0;; s->cuts = before.cuts + ++cut) {
    const double begin = clock->time, end = increment_end(run, s->next);
    text_add(&run->log, "increment %lld, from time %.6g to %.6g %s\n", (long long)clock->step + 1, begin, end,
             clock->time_unit);
    const bool finds = static_finds_reduction(run, end);
    bool settled = true, slides = false;
    way = BY_METHOD;
    s->begin = begin;
    s->travelled = 0;
    NewtonOutcome outcome = try_first(s, end, &may_relax, &way, error);
    if (outcome == NEWTON_FAILED) return give_up(s, &before, BRECCIA_FAILURE);
    if (outcome == NEWTON_STOPPED) return give_up(s, &before, BRECCIA_INTERRUPTED);
    if (outcome == NEWTON_CONVERGED) {
      clock->time_step = end - begin;
      clock->time = end;
      iterations = s->newton.iterations;
      const int status = static_settle(run, &outcome, &settled, &way, error);
      slides = static_only_reduces(s, end) && settled && outcome == NEWTON_CONVERGED && !status && static_slides(run);
      if (settled && !slides) ++clock->step; /* what was found in it is committed, whatever has become of the rest */
      if (status) return BRECCIA_FAILURE;
      if (settled && outcome == NEWTON_CONVERGED && !slides) break;
      if (settled && !slides && static_hands_over(s->spec)) {
        hand_over(run, outcome, true, false, warning);
        break;
      }
      if (settled && !slides) return fail_with_broken(s, outcome, error);
      if (static_give_back(run, error)) return BRECCIA_FAILURE;
      if (newton_is_interrupted(&s->newton)) return give_up(s, &before, BRECCIA_INTERRUPTED);
    }
    tell_refused(s, outcome, settled, slides);
    s->next = (end - begin) / 2;
    if (s->next < s->spec->smallest * static_whole_increment(s->spec)) {
      if (s->spec->control && s->newton.change_forces.row[0] && !s->takes_coarse) { /* try a long increment */
        s->takes_coarse = true;
        s->next = static_whole_increment(s->spec);
        continue;
      }
      if (static_hands_over(s->spec)) {
        hand_over(run, outcome, settled, slides, warning);
        static_count_empty_increment(clock);
        break;
      }
      if (finds) {
        run->records[clock->stage].lost_reduction = loading_strength_reduction(run->loading, clock->stage, end);
        run->records[clock->stage].slides = slides;
        end_now(clock);
        static_count_empty_increment(clock);
        break;
      }
      fail(s, outcome, settled, slides, error);
      return give_up(s, &before, BRECCIA_FAILURE);
    }
  }
  const int64_t most = s->newton.relaxes ? s->spec->relaxation_iterations : newton_most_iterations(&s->newton);
  if (way != BY_METHOD || iterations <= (most + 1) / 2) s->next = fmin(2 * s->next, static_whole_increment(s->spec));
  if (way == BY_SECANTS) run->records[clock->stage].descended = (double)++s->descended;
  if (way == BY_RELAXATION) run->records[clock->stage].relaxed = (double)++s->relaxed;
  if (way != BY_METHOD) note_jump(run, began);
  clock->ended = clock->time >= clock->stage_end - 1e-9 * static_whole_increment(s->spec);
  static_count_steps(run);
  if (s->spec->control) control_note_exerted(&s->control, newton_controlled_force(&s->newton));
  /* Once without broken bonds it may be a load that changes its sign. */
  const bool again = was_spent || s->domain->broken_count > broken;
  if (!clock->ended && again && control_is_spent(&s->control)) {
    control_tell_torn(&s->control, clock, warning);
    end_now(clock);
  }
  if (clock->ended) {
    if (s->descended || s->relaxed) tell_jumps(run, warning);
    increment_forget(&s->increment);
    state_copy_destroy(&s->whole);
  }
  return BRECCIA_OK;
}
