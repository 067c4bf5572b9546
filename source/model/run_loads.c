/* What loads and supports did in a run, for summary.json and in words: what they prescribed at the most, and the
 * force in all that each exerted on the body, the largest and at the end (solver/resultants.h). */
#include "model/run.h"

#include "solver/resultants.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** The farthest from zero that a load has been; 0 before its stage. */
static double run_loads_peak(const breccia_model *model, const Load *load)
{
  return load_value(load->spec, resultants_peak_factor(&model->solver, load));
}

/** Resultants of all loads, to be freed; NULL if they are not to be told: of a computation that has blown up, or
 * memory is out. */
static Resultant *run_loads_resultants(const breccia_model *model)
{
  if (ledger_has_blown_up(&model->solver.ledger)) return NULL;
  Resultant *list = memory_plain((size_t)model->loading.count + 1, sizeof *list);
  if (list && !resultants_find(&model->solver, list, NULL)) return list;
  free(list);
  return NULL;
}

/* ---- for summary.json ---- */

static void run_loads_add_number(Text *t, const char *key, double value)
{
  if (isfinite(value))
    text_add(t, ", \"%s\": %.10g", key, value);
  else
    text_add(t, ", \"%s\": null", key);
}

static void run_loads_add_vector(Text *t, const char *key, const double v[3])
{
  text_add(t, ", \"%s\": [%.10g, %.10g, %.10g]", key, v[0], v[1], v[2]);
}

static void run_loads_add(const breccia_model *model, const Load *load, const Resultant *resultant, Text *t)
{
  const char *dimension, *kind = load_kind(load->spec, &dimension);
  char unit[64];
  units_name(model->units, dimension_find(dimension), unit, sizeof unit);
  text_add(t, "{\"name\": ");
  text_add_json(t, load->spec->name ? load->spec->name : "");
  text_add(t, ", \"line\": %d, \"kind\": \"%s\"", load->spec->head.node->line, kind);
  run_loads_add_number(t, "peak", run_loads_peak(model, load));
  text_add(t, ", \"unit\": ");
  text_add_json(t, unit);
  if (resultant && resultant->exerts) {
    run_loads_add_vector(t, "largest_force", resultant->largest);
    if (!isnan(resultant->time)) run_loads_add_number(t, "time_of_largest_force", resultant->time);
    run_loads_add_vector(t, "force_at_end", resultant->now);
  }
  text_add(t, "}");
}

void run_add_loads(const breccia_model *model, Text *t)
{
  Resultant *resultants = run_loads_resultants(model);
  text_add(t, "  \"loads\": [");
  for (int k = 0; k < model->loading.count; ++k) {
    if (k) text_add(t, ", ");
    run_loads_add(model, &model->loading.loads[k], resultants ? &resultants[k] : NULL, t);
  }
  text_add(t, "],\n");
  free(resultants);
}

/* ---- in words ---- */

/** Adds the name of a load, or where it stands in the deck if it has none; loads of one name are told apart by their
 * stages. */
static void run_loads_name(const breccia_model *model, const Load *load, Text *t)
{
  const char *name = load->spec->name;
  int alike = 0; /* loads of one name, which take each other's place */
  char stage[64];
  if (!name) {
    text_add(t, "load in line %d", load->spec->head.node->line);
    return;
  }
  for (int k = 0; k < model->loading.count; ++k) {
    const char *other = model->loading.loads[k].spec->name;
    alike += other && !strcmp(other, name);
  }
  text_add(t, "load '%s'", name);
  if (alike > 1) text_add(t, " of stage '%s'", solver_stage_name(&model->solver, load->first, stage, sizeof stage));
}

void run_tell_loads_at(const breccia_model *model, double time, Text *t)
{
  enum { FEW = 3 };
  const Solver *s = &model->solver;
  int told = 0;
  for (int k = 0; k < model->loading.count && told < FEW; ++k) {
    const Load *load = &model->loading.loads[k];
    const bool begun = load->first <= s->clock.stage && time > load->begin,
               ended = load->behind <= s->clock.stage && time > s->records[load->behind - 1].end;
    const char *dimension, *kind = load_kind(load->spec, &dimension);
    if (!begun || ended || load_magnitude(load->spec) == 0 || load->type->timeless ||
        history_is_controlled(&load->history) || load_factor(load, time) == load_factor(load, load->begin))
      continue;
    char unit[64];
    units_name(model->units, dimension_find(dimension), unit, sizeof unit);
    text_add(t, "%s", told++ ? ", " : " (");
    run_loads_name(model, load, t);
    text_add(t, ": %s %.4g%s%s", kind, load_value(load->spec, load_factor(load, time)), *unit ? " " : "", unit);
  }
  if (told) text_add(t, ")");
}

static void run_loads_tell(const breccia_model *model, const Load *load, Text *t)
{
  const char *dimension, *kind = load_kind(load->spec, &dimension);
  run_loads_name(model, load, t);
  text_add(t, ": %s", kind);
  if (load->first > model->solver.clock.stage)
    text_add(t, ", has not begun");
  else if (load_magnitude(load->spec) != 0) { /* else a support, which has no size */
    char unit[64];
    units_name(model->units, dimension_find(dimension), unit, sizeof unit);
    text_add(t, ", peak %.6g%s%s", run_loads_peak(model, load), *unit ? " " : "", unit);
  }
  text_add(t, "\n");
}

/** @param[in] size  of the largest; components far below are round-off and what a residual leaves */
static void run_loads_tell_force(const double force[3], double size, const char *unit, Text *t)
{
  double v[3];
  for (int k = 0; k < 3; ++k) v[k] = fabs(force[k]) < 1e-6 * size ? 0 : force[k];
  text_add(t, "[%.4g, %.4g, %.4g]%s%s", v[0], v[1], v[2], *unit ? " " : "", unit);
}

/** Adds the number of particles that a one-sided support has let go at the end. */
static void run_loads_tell_open(const Loading *loading, const Load *load, Text *t)
{
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c) {
    const OneSided *q = c->one_sided;
    int64_t open = 0;
    if (c->load != load || !q || !load_acts(loading, load)) continue;
    for (int64_t n = 0; n < q->count; ++n) open += q->open[n];
    if (c->platen)
      text_add(t, ", only presses%s", open ? ": has let go" : "");
    else
      text_add(t, ", only presses: has let go of %lld of its %lld particles", (long long)open, (long long)q->count);
  }
}

static void run_loads_tell_resultant(const breccia_model *model, const Load *load, const Resultant *r, Text *t)
{
  char force[64], time[64];
  units_name(model->units, dimension_find("force"), force, sizeof force);
  units_name(model->units, dimension_find("time"), time, sizeof time);
  const double *f = r->largest, size = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
  text_add(t, "  ");
  run_loads_name(model, load, t);
  text_add(t, ": ");
  run_loads_tell_force(f, size, force, t);
  if (!isnan(r->time) && size > 0) text_add(t, " at time %.6g %s", r->time, time);
  text_add(t, ", ");
  run_loads_tell_force(r->now, size, force, t);
  run_loads_tell_open(&model->loading, load, t);
  text_add(t, "\n");
}

/** Returns true if a load that only presses prescribes a motion other than 0 and exerted no force in any state that was
 *  evaluated. */
static bool run_loads_missed(const breccia_model *model, const Load *load, const Resultant *r)
{
  const Loading *loading = &model->loading;
  bool only_presses = false;
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c)
    only_presses |= c->load == load && c->one_sided;
  return only_presses && r->exerts && r->largest[0] == 0 && r->largest[1] == 0 && r->largest[2] == 0 &&
         run_loads_peak(model, load) != 0;
}

/** Adds a warning for each load that only presses and never pressed. */
static void run_loads_tell_missed(const breccia_model *model, const Resultant *resultants, Text *t)
{
  for (int k = 0; k < model->loading.count; ++k) {
    const Load *load = &model->loading.loads[k];
    if (!run_loads_missed(model, load, &resultants[k])) continue;
    text_add(t, "warning: ");
    run_loads_name(model, load, t);
    text_add(t, " only presses and never pressed: it moves away from the body; look at the sign of its motion\n");
  }
}

/** Returns true if a stage up to the current one has short steps of which only some are evaluated. */
static bool run_loads_have_gaps(const Solver *s)
{
  bool gaps = false;
  for (int64_t k = 0; k <= s->clock.stage; ++k) gaps |= !solver_step_was_long(s, (int64_t)s->records[k].last_step);
  return gaps && resultants_interval(s) > 1;
}

/** Returns true if a load is a spring between two parts of the body, whose forces on the body sum to zero. */
static bool run_loads_is_between(const Load *load)
{
  return load->type->exerts && load->other.count > 0;
}

/** Adds lines with the resultants of loads.
 *  @param[in] between  true: only springs between two parts of the body; false: all other loads
 *  @return number of loads without a line */
static int run_loads_tell_resultants(const breccia_model *model, const Resultant *resultants, bool between, Text *t)
{
  enum { FEW = 12 }; /* of more loads only those with names */
  const Load *loads = model->loading.loads;
  const char *gaps = run_loads_have_gaps(&model->solver) ? " (of explicit steps every tenth)" : "";
  int told = 0, quiet = 0;
  for (int k = 0; k < model->loading.count; ++k) {
    const Resultant *r = &resultants[k];
    if (!r->exerts || loads[k].first > model->solver.clock.stage || run_loads_is_between(&loads[k]) != between)
      continue;
    if (model->loading.count > FEW && !loads[k].spec->name) {
      ++quiet;
      continue;
    }
    if (!told++)
      text_add(t, "force in all on %s, the largest%s and at the end:\n",
               between ? "the first end of springs between two parts of the body" : "the body", gaps);
    run_loads_tell_resultant(model, &loads[k], r, t);
  }
  return quiet;
}

void run_tell_loads(const breccia_model *model, Text *t)
{
  Resultant *resultants = run_loads_resultants(model);
  int quiet = 0;
  for (int k = 0; k < model->loading.count; ++k)
    if (model->loading.loads[k].spec->name) run_loads_tell(model, &model->loading.loads[k], t);
  for (int between = 0; between < 2 && resultants; ++between)
    quiet += run_loads_tell_resultants(model, resultants, between, t);
  if (quiet) text_add(t, "  %d loads without names: summary.json tells each\n", quiet);
  if (resultants) run_loads_tell_missed(model, resultants, t);
  free(resultants);
}
