/* Report on broken and softened bonds of a result: counts by cause, a line for each requested broken bond, and lines
 * for the most damaged bonds or material points. */
#include "model/host.h"
#include "model/sized.h"
#include "results/broken_bonds.h"
#include "results/softened_bonds.h"
#include <math.h>
#include <stdlib.h>

/** Adds the number of bonds of the body that broke from each cause, and that of their images. */
static void why_count(const BondReasons *of, Text *text)
{
  int64_t counts[BREAK_CAUSES] = {0}, outside = 0;
  const char *criterion[BREAK_CAUSES] = {NULL}, *before = ": ";
  for (int64_t k = 0; k < of->count; ++k) {
    const BondReason *bond = &of->bonds[k];
    outside += bond->is_outside;
    counts[bond->cause] += !bond->is_outside;
    criterion[bond->cause] = bond->criterion;
  }
  const int64_t inside = of->count - outside;
  text_add(text, "%lld bond%s broke", (long long)inside, inside == 1 ? "" : "s");
  for (int k = 0; k < BREAK_CAUSES; ++k) {
    if (!counts[k]) continue;
    text_add(text, "%s%lld %s", before, (long long)counts[k], break_causes[k].count);
    if (!break_causes[k].criterion) text_add(text, " '%s'", criterion[k]);
    before = ", ";
  }
  text_add(text, "\n");
  if (outside)
    text_add(text, "%lld images of them broke in the layers outside of supports and are not listed\n",
             (long long)outside);
}

/** Adds the coordinates of a position with their unit. */
static void why_position(const ResultView *view, const double position[3], Text *text)
{
  text_add(text, " at [");
  for (int k = 0; k < (view->plane ? 2 : 3); ++k) text_add(text, "%s%.6g", k ? ", " : "", position[k]);
  text_add(text, "] %s: ", view->length_unit);
}

/** Adds a line for one bond with its particles, position and reason. */
static void why_bond(const ResultView *view, const BondReason *bond, Text *text)
{
  text_add(text, "step %lld, time %.6g %s, particles %lld and %lld", (long long)bond->step, bond->time, view->time_unit,
           (long long)bond->particles[0], (long long)bond->particles[1]);
  why_position(view, bond->position, text);
  const char *space = *bond->unit ? " " : "";
  if (!isnan(bond->value)) text_add(text, "%s %.6g%s%s", bond->quantity, bond->value, space, bond->unit);
  if (!isnan(bond->limit)) text_add(text, ", limit %.6g%s%s", bond->limit, space, bond->unit);
  text_add(text, "%s(%s, material '%s')\n", isnan(bond->value) ? "" : " ", bond->criterion, bond->material);
}

/** Adds a line for a damaged bond or material point. */
static void why_softened_point(const ResultView *view, const SoftenedPoint *point, Text *text)
{
  const bool bond = point->particles[0] != point->particles[1];
  text_add(text, "%s %lld", bond ? "particles" : "particle", (long long)point->particles[0]);
  if (bond) text_add(text, " and %lld", (long long)point->particles[1]);
  why_position(view, point->position, text);
  text_add(text, "damage %.6g", point->damage);
  if (bond) text_add(text, ", opened by %.6g %s", point->opening, view->length_unit);
  text_add(text, "\n");
}

/** Adds the number of bonds or points past their peak at the last written state, and a line for each of the most
 *  damaged ones. @param[in] most  maximum number of these lines */
static void why_softened(const ResultView *view, const SoftenedView *softened, long long most, Text *text)
{
  const SoftenedPoints *points = &softened->points;
  if (!*softened->noun || !points->total) return;
  text_add(text, "%lld of %lld softening %s are past their peak at time %.6g %s, %lld of them carry nothing\n",
           (long long)points->softened, (long long)points->total, softened->noun, view->times[view->steps - 1],
           view->time_unit, (long long)points->spent);
  for (int k = 0; k < points->listed && k < most; ++k) why_softened_point(view, &points->worst[k], text);
}

/** Adds a line for the bond between two particles. @return BRECCIA_USER_ERROR after a message if it did not break */
static int why_one(const ResultView *view, const BondReasons *of, const long long ends[2], Text *text, Error *error)
{
  for (int64_t k = 0; k < of->count; ++k) {
    const int64_t *particles = of->bonds[k].particles;
    if ((particles[0] != ends[0] || particles[1] != ends[1]) && (particles[0] != ends[1] || particles[1] != ends[0]))
      continue;
    why_bond(view, &of->bonds[k], text);
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
  SoftenedView softened = {.noun = ""};
  Text text = {0};
  char *path = result_view_path(result);
  int status = sized_take(&wish, sizeof wish, given, "breccia_why", error);
  if (!status) status = path ? result_view_open(&view, path, error) : BRECCIA_FAILURE;
  if (!status) {
    status = broken_bonds_read(&view, &of, error);
    if (!status) status = softened_bonds_read(&view, &softened, error);
    if (!status && wish.one_bond) status = why_one(&view, &of, wish.bond, &text, error);
    if (!status && !wish.one_bond) {
      why_count(&of, &text);
      int64_t listed = 0;
      for (int64_t k = 0; k < of.count && listed < wish.first; ++k) {
        if (of.bonds[k].is_outside) continue;
        why_bond(&view, &of.bonds[k], &text);
        ++listed;
      }
      why_softened(&view, &softened, wish.first, &text);
    }
    broken_bonds_destroy(&of);
    result_view_close(&view);
  }
  free(path);
  if (!status) *words = text_take(&text);
  text_free(&text);
  return host_leave(&host, status, error);
}
