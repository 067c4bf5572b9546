/* Report on broken bonds of a result: counts by cause, and a line for each requested bond. */
#include "model/host.h"
#include "model/sized.h"
#include "results/broken_bonds.h"
#include <math.h>
#include <stdlib.h>

/** Adds the number of bonds that broke from each cause. */
static void why_count(const BondReasons *of, Text *text)
{
  int64_t counts[BREAK_CAUSES] = {0};
  for (int64_t k = 0; k < of->count; ++k) ++counts[of->bonds[k].cause];
  text_add(text, "%lld bond%s broke", (long long)of->count, of->count == 1 ? "" : "s");
  const char *before = ": ";
  if (counts[BREAK_LIMIT]) {
    text_add(text, "%s%lld exceeded the limit of '%s'", before, (long long)counts[BREAK_LIMIT], of->criterion);
    before = ", ";
  }
  if (counts[BREAK_LAW]) {
    text_add(text, "%s%lld lost a material point whose law found no stress", before, (long long)counts[BREAK_LAW]);
    before = ", ";
  }
  if (counts[BREAK_ISOLATED])
    text_add(text, "%s%lld belonged to a particle with too few bonds left", before, (long long)counts[BREAK_ISOLATED]);
  text_add(text, "\n");
}

/** Adds a line for one bond with its particles, position and reason. */
static void why_bond(const ResultView *view, const BondReasons *of, const BondReason *bond, Text *text)
{
  text_add(text, "step %lld, time %.6g %s, particles %lld and %lld at [", (long long)bond->step, bond->time,
           view->time_unit, (long long)bond->particles[0], (long long)bond->particles[1]);
  for (int k = 0; k < (view->plane ? 2 : 3); ++k) text_add(text, "%s%.6g", k ? ", " : "", bond->position[k]);
  text_add(text, "] %s: ", view->length_unit);
  const char *space = *of->unit ? " " : "";
  if (bond->cause == BREAK_LIMIT && isnan(bond->value))
    text_add(text, "'%s'\n", of->criterion);
  else if (bond->cause == BREAK_LIMIT)
    text_add(text, "%s %.6g%s%s, limit %.6g%s%s\n", of->quantity, bond->value, space, of->unit, bond->limit, space,
             of->unit);
  else
    text_add(text, "%s\n",
             bond->cause == BREAK_LAW ? "the law of its point, or of an end, found no stress"
                                      : "too few bonds were left at one of its ends");
}

/** Adds a line for the bond between two particles. @return BRECCIA_USER_ERROR after a message if it did not break */
static int why_one(const ResultView *view, const BondReasons *of, const long long ends[2], Text *text, Error *error)
{
  for (int64_t k = 0; k < of->count; ++k) {
    const int64_t *particles = of->bonds[k].particles;
    if ((particles[0] != ends[0] || particles[1] != ends[1]) && (particles[0] != ends[1] || particles[1] != ends[0]))
      continue;
    why_bond(view, of, &of->bonds[k], text);
    return BRECCIA_OK;
  }
  return error_add(error, BRECCIA_USER_ERROR,
                   "no bond between particles %lld and %lld broke; particles are numbered by their rows in the result "
                   "file, from 0",
                   ends[0], ends[1]);
}

int breccia_explain_breaks(const char *result, const breccia_why *given, char **words, breccia_error *error)
{
  if (words) *words = NULL;
  if (host_lacks(result, __func__, "result", error) || host_lacks(words, __func__, "text", error))
    return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_why wish;
  ResultView view;
  BondReasons of = {0};
  Text text = {0};
  char *path = result_view_path(result);
  int status = sized_take(&wish, sizeof wish, given, "breccia_why", error);
  if (!status) status = path ? result_view_open(&view, path, error) : BRECCIA_FAILURE;
  if (!status) {
    status = broken_bonds_read(&view, &of, error);
    if (!status && wish.one_bond) status = why_one(&view, &of, wish.bond, &text, error);
    if (!status && !wish.one_bond) {
      why_count(&of, &text);
      for (int64_t k = 0; k < of.count && k < wish.first; ++k) why_bond(&view, &of, &of.bonds[k], &text);
    }
    broken_bonds_destroy(&of);
    result_view_close(&view);
  }
  free(path);
  if (!status) *words = text_take(&text);
  text_free(&text);
  return host_leave(&host, status, error);
}
