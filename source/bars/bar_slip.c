/* Bars that slip (docs/theory.md 7.2). A bar moves in the concrete as in a tube: node k is ahead of the concrete by s_k along the bar, and an element
 * has the strain e = e_c + (s_(k+1) - s_k) / L, e_c that of the concrete along it. Slips are no unknowns of solvers: at any displacements of the
 * concrete they are those at which each node is in equilibrium between its two elements and the bond on its surface, so that the bar's own mass plays no
 * part. Of several equilibria it is the one to which the potential of bar and bond falls from the committed slips. */
#include "bars/bars.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool bar_slips(const Bars *b, int bar)
{
  return b->slips && b->slips->slips[bar];
}

void bar_slips_destroy(Bars *b)
{
  BarSlips *s = b->slips;
  if (!s) return;
  free(s->law);
  free(s->slips);
  free(s->fixed);
  free(s->surface);
  free(s->bonded);
  free(s->slip_held);
  free(s->stress_held);
  free(s->forward);
  free(s->backward);
  free(s->slip);
  free(s->stress);
  free(s->worked);
  free(s->pivot);
  free(s->factor);
  free(s->residual);
  free(s->change);
  free(s->stiffness);
  free(s->stuck);
  free(s);
  b->slips = NULL;
}

static bool is_anchored(const BarSpec *bar, const char *end)
{
  for (int n = 0; n < bar->anchored.count; ++n)
    if (!strcmp(bar->anchored.items[n], end)) return true;
  return false;
}

static double perimeter(const Bars *b, int n)
{
  const BarSpec *bar = b->specs->items[n];
  const double pi = acos(-1), diameter = isnan(bar->area) ? bar->diameter : sqrt(4 / pi * bar->area);
  return (double)bar->number * pi * diameter;
}

/** Finds how much of both halves of elements is bonded, and gives it to their nodes. @return surface that is bonded */
static double share_surface(Bars *b, int n)
{
  const BarSpec *bar = b->specs->items[n];
  const double around = perimeter(b, n);
  const bool all = !bar->bonded.count;
  double along = 0, sum = 0;
  for (int64_t e = b->first[n]; e < b->first[n + 1]; along += b->length[e++])
    for (int half = 0; half < 2; ++half) {
      const double from = along + half * b->length[e] / 2, to = from + b->length[e] / 2;
      const double least = all ? from : fmax(from, bar->bonded.values[0]),
                   most = all ? to : fmin(to, bar->bonded.values[1]);
      const double surface = around * fmax(0, most - least);
      b->slips->bonded[2 * e + half] = surface;
      b->slips->surface[e + n + half] += surface;
      sum += surface;
    }
  return sum;
}

static double length_of(const Bars *b, int n)
{
  double length = 0;
  for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) length += b->length[e];
  return length;
}

/** @return status of a bar whose bond goes on beyond it, or which nothing would hold */
static int check_bonded(const Bars *b, int n, double surface, const ForcesParts *parts)
{
  const double rounding = 1e-9;
  const BarSpec *bar = b->specs->items[n];
  const Node *node = section_node(bar, "bonded");
  if (!(surface > 0) && bar->anchored.count < 2)
    return node_error(
        parts->reader->document, node, parts->reader->error,
        "bonded: no part of bar '%s' lies between these lengths along it, and it is %s: nothing would hold it",
        bar->head.name, bar->anchored.count ? "anchored at one end only" : "not anchored");
  const double length = length_of(b, n);
  if (!bar->bonded.count ||
      (bar->bonded.values[0] >= -rounding * length && bar->bonded.values[1] <= (1 + rounding) * length))
    return BRECCIA_OK;
  char unit[64];
  units_name(parts->reader->units, dimension_find("length"), unit, sizeof unit);
  return node_error(parts->reader->document, node, parts->reader->error,
                    "bonded: bar '%s' is %.6g %s long, from 0 to there; give lengths along it", bar->head.name, length,
                    unit);
}

int bar_slips_create(Bars *b, const ForcesParts *parts, Error *error)
{
  const int bars = b->specs->count;
  const size_t nodes = (size_t)(b->count + bars);
  bool any = false;
  for (int n = 0; n < bars; ++n) any |= ((const BarSpec *)b->specs->items[n])->bond != NULL;
  if (!any) return BRECCIA_OK;
  BarSlips *s = b->slips = memory_zeroed(1, sizeof *s, "bars", error);
  if (!s) return BRECCIA_FAILURE;
  s->law = memory_zeroed((size_t)bars, sizeof *s->law, "bars", error);
  s->slips = memory_zeroed((size_t)bars, sizeof *s->slips, "bars", error);
  s->stuck = memory_zeroed((size_t)bars, sizeof *s->stuck, "bars", error);
  s->fixed = memory_zeroed(nodes, sizeof *s->fixed, "bars", error);
  s->bonded = memory_zeroed(2 * (size_t)b->count, sizeof *s->bonded, "bars", error);
  bool made = s->law && s->slips && s->stuck && s->fixed && s->bonded;
  double **const numbers[] = {&s->surface,  &s->slip,     &s->stress,   &s->slip_held, &s->stress_held,
                              &s->forward,  &s->backward, &s->worked,   &s->pivot,     &s->factor,
                              &s->residual, &s->change,   &s->stiffness};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k)
    made &= (*numbers[k] = memory_zeroed(nodes, sizeof(double), "bars", error)) != NULL;
  if (!made) return BRECCIA_FAILURE;
  for (int n = 0; n < bars; ++n) {
    const BarSpec *bar = b->specs->items[n];
    if (!(s->slips[n] = bar->bond != NULL)) continue;
    s->law[n] = bond_law(bar->bond, parts->reader->units);
    s->fixed[b->first[n] + n] = is_anchored(bar, "start");
    s->fixed[b->first[n + 1] + n] = is_anchored(bar, "end");
    const int status = check_bonded(b, n, share_surface(b, n), parts);
    if (status) return status;
  }
  return BRECCIA_OK;
}

/* ---- equilibrium ---- */

/** Stress and stiffness of the bond at a node, at its slip; none where nothing of its surface is bonded. */
static double bond_stress(const Bars *b, int n, int64_t k, double *slope)
{
  const BarSlips *s = b->slips;
  *slope = 0;
  if (!(s->surface[k] > 0)) return 0;
  const BondState held = {s->slip_held[k], s->stress_held[k], s->forward[k], s->backward[k]};
  return bond_law_stress(&s->law[n], &held, s->slip[k], b->clock->elastic_stage, slope);
}

/** Residuals of nodes at their slips: the slope of the potential; and stiffnesses of elements (`tangent`) and of bond. Strains and stresses follow. */
static void evaluate(Bars *b, int n)
{
  BarSlips *s = b->slips;
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) {
    s->stress[k] = bond_stress(b, n, k, &s->stiffness[k]);
    s->stiffness[k] *= s->surface[k];
    s->residual[k] = s->surface[k] * s->stress[k];
  }
  for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
    const int64_t k = e + n;
    b->strain[e] = b->line_strain[e] + b->prestrain[n] + (s->slip[k + 1] - s->slip[k]) / b->length[e];
  }
  bar_try_stresses(b, n);
  for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
    const int64_t k = e + n;
    b->tangent[e] *= b->area[e] / b->length[e];
    s->residual[k] -= b->area[e] * b->stress[e];
    s->residual[k + 1] += b->area[e] * b->stress[e];
  }
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k)
    if (s->fixed[k]) s->residual[k] = 0;
}

static double young(const Bars *b, int64_t e)
{
  return b->young[e] > 0 ? b->young[e] : material_young(points_material(&b->points, e));
}

static double at_least(double stiffness, double share, double first)
{
  return share > 0 ? fmax(stiffness, share * first) : stiffness;
}

/** L D L^T of the equations of nodes. @param[in] least  share of stiffnesses at first below which none is taken; 0: as they are
 *  @return whether all pivots are positive */
static bool factor(Bars *b, int n, double least)
{
  BarSlips *s = b->slips;
  const int64_t first = b->first[n] + n, last = b->first[n + 1] + n;
  bool positive = true;
  for (int64_t k = first; k <= last; ++k) {
    double diagonal = at_least(s->stiffness[k], least, s->law[n].stiffness * s->surface[k]), beside = 0;
    for (int64_t e = k - n - 1; e <= k - n; ++e) {
      if (e < b->first[n] || e >= b->first[n + 1]) continue;
      const double stiff = at_least(b->tangent[e], least, b->area[e] / b->length[e] * young(b, e));
      diagonal += stiff;
      if (e < k - n) beside = -stiff;
    }
    s->factor[k] = 0;
    s->pivot[k] = diagonal;
    if (k > first && !s->fixed[k] && !s->fixed[k - 1]) {
      s->factor[k] = beside / s->pivot[k - 1];
      s->pivot[k] -= s->factor[k] * beside;
    }
    if (!s->fixed[k] && !(s->pivot[k] > 1e-14 * fabs(diagonal))) positive = false;
  }
  return positive;
}

/** Changes of slips that take residuals away, from the factors. Both may be the same row. */
static void solve(const Bars *b, int n, const double *residual, double *change)
{
  const BarSlips *s = b->slips;
  const int64_t first = b->first[n] + n, last = b->first[n + 1] + n;
  for (int64_t k = first; k <= last; ++k)
    change[k] = s->fixed[k] ? 0 : -residual[k] - (k > first ? s->factor[k] * change[k - 1] : 0);
  for (int64_t k = last; k >= first; --k)
    change[k] = s->fixed[k] ? 0 : change[k] / s->pivot[k] - (k < last ? s->factor[k + 1] * change[k + 1] : 0);
}

/** Slope of the potential along the changes. */
static double descent(const Bars *b, int n)
{
  double sum = 0;
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) sum += b->slips->residual[k] * b->slips->change[k];
  return sum;
}

static void move(Bars *b, int n, double by)
{
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) b->slips->slip[k] += by * b->slips->change[k];
}

/** Goes along the changes until the potential rises no more: all the way, or to a place between where it is nearly level. @return the largest residual over
 *  the largest force */
static void go_down(Bars *b, int n)
{
  enum { TRIES = 60 };
  const double enough = 0.5, begun = descent(b, n);
  double low = 0, high = 1, at = 1;
  move(b, n, 1);
  evaluate(b, n);
  for (int t = 0; t < TRIES; ++t) {
    const double now = descent(b, n);
    if (!(now > 0) || now <= -enough * begun) {
      if (!(now < enough * begun) || high == 1) return;
      low = at;
    } else {
      high = at;
    }
    const double next = (low + high) / 2;
    move(b, n, next - at);
    at = next;
    evaluate(b, n);
  }
}

/** The largest residual over the largest force, or where that is as good as nothing over what differences of such displacements leave of their digits. */
static double misfit(const Bars *b, int n)
{
  const double digits = 1e-5;
  double residual = 0, force = 0;
  for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
    const double moved = fmax(fabs(b->slips->slip[e + n]) / b->length[e], fabs(b->line_strain[e] + b->prestrain[n]));
    force = fmax(force, b->area[e] * fmax(fabs(b->stress[e]), digits * young(b, e) * moved));
  }
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) {
    residual = fmax(residual, fabs(b->slips->residual[k]));
    force = fmax(force, fabs(b->slips->surface[k] * b->slips->stress[k]));
  }
  return force > 0 ? residual / force : residual;
}

void bar_find_slips(Bars *b, int n)
{
  enum { MOST = 200, MORE = 3 };
  const double wanted = 1e-13, enough = 1e-9, soft = 1e-6; /* of the largest force; of stiffnesses at first */
  BarSlips *s = b->slips;
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) s->slip[k] = s->fixed[k] ? 0 : s->slip_held[k];
  evaluate(b, n);
  double left = misfit(b, n);
  int idle = 0; /* a solution to the last digits is not always to be had */
  for (int t = 0; t < MOST && left > wanted && idle < MORE; ++t) {
    if (!factor(b, n, 0)) factor(b, n, soft);
    solve(b, n, s->residual, s->change);
    go_down(b, n);
    const double now = misfit(b, n);
    idle = left < enough && now > 0.5 * left ? idle + 1 : 0;
    left = now;
  }
  s->stuck[n] = !(left <= enough);
}

/* ---- changes ---- */

void bar_factor_slips(Bars *b, int n)
{
  BarSlips *s = b->slips;
  const double share = b->points.elastic_weight, none = 1e-9;
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) {
    double slope;
    bond_stress(b, n, k, &slope);
    s->stiffness[k] = s->surface[k] * ((1 - share) * slope + share * s->law[n].stiffness);
  }
  if (!factor(b, n, 0)) factor(b, n, none);
}

void bar_change_slips(Bars *b, int n)
{
  BarSlips *s = b->slips;
  const int64_t first = b->first[n] + n, last = b->first[n + 1] + n;
  memset(s->change + first, 0, sizeof(double) * (size_t)(last - first + 1));
  for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
    s->change[e + n] -= b->tangent[e] * b->longer[e];
    s->change[e + n + 1] += b->tangent[e] * b->longer[e];
  }
  solve(b, n, s->change, s->change);
  for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) b->longer[e] += s->change[e + n + 1] - s->change[e + n];
}

/* ---- what was done ---- */

void bar_accept_slips(Bars *b)
{
  BarSlips *s = b->slips;
  for (int n = 0; n < b->specs->count; ++n) {
    if (!bar_slips(b, n)) continue;
    for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) {
      s->worked[k] += s->surface[k] * (s->stress[k] + s->stress_held[k]) / 2 * (s->slip[k] - s->slip_held[k]);
      s->slip_held[k] = s->slip[k];
      s->stress_held[k] = s->stress[k];
      s->forward[k] = fmax(s->forward[k], s->slip[k]);
      s->backward[k] = fmin(s->backward[k], s->slip[k]);
    }
  }
}

double bar_bond_stored(const Bars *b, int n)
{
  double sum = 0;
  if (!bar_slips(b, n)) return 0;
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) {
    const double stress = b->slips->stress_held[k];
    sum += b->slips->surface[k] * stress * stress / (2 * b->slips->law[n].stiffness);
  }
  return sum;
}

double bar_bond_dissipated(const Bars *b, int n)
{
  double sum = 0;
  if (!bar_slips(b, n) || b->slips->law[n].linear) return 0;
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) sum += b->slips->worked[k];
  return sum - bar_bond_stored(b, n);
}

void bar_slips_describe(const Bars *b, int n, const Units *units, Text *text)
{
  const BarSpec *bar = b->specs->items[n];
  const BondLaw *law = &b->slips->law[n];
  const bool start = is_anchored(bar, "start"), end = is_anchored(bar, "end");
  const double metre = units_in_si(units, dimension_find("length"), 1),
               newton = units_in_si(units, dimension_find("force"), 1);
  double surface = 0;
  for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n; ++k) surface += b->slips->surface[k];
  text_add(text, "bars: '%s' slips: ", bar->head.name);
  bond_law_describe(law, units, text);
  text_add(text, ", along ");
  if (bar->bonded.count) {
    quantity_describe(metre * surface / perimeter(b, n), "m", text);
    text_add(text, " of ");
    quantity_describe(metre * length_of(b, n), "m", text);
  } else {
    text_add(text, "all of it");
  }
  if (!law->linear) {
    text_add(text, ", ");
    quantity_describe(newton * law->peak * surface, "N", text);
    text_add(text, " in all");
  }
  text_add(text, "; anchored at %s\n",
           start && end ? "both ends"
           : start      ? "its start"
           : end        ? "its end"
                        : "neither end");
}

double bar_slip_in(const Bars *b, int n, int64_t e)
{
  return bar_slips(b, n) ? (b->slips->slip_held[e + n] + b->slips->slip_held[e + n + 1]) / 2 : 0;
}

double bar_bond_stress_in(const Bars *b, int n, int64_t e)
{
  const BarSlips *s = b->slips;
  if (!bar_slips(b, n)) return 0;
  return (s->bonded[2 * e] * s->stress_held[e + n] + s->bonded[2 * e + 1] * s->stress_held[e + n + 1]) /
         (perimeter(b, n) * b->length[e]);
}

void bar_slips_state(Bars *b, StateList *list)
{
  const struct {
    const char *name, *unit;
    double *values;
  } rows[] = {{"bar slip", "length", b->slips->slip_held},
              {"bond stress", "stress", b->slips->stress_held},
              {"largest bar slip", "length", b->slips->forward},
              {"least bar slip", "length", b->slips->backward},
              {"work on bond", "energy", b->slips->worked}};
  for (size_t r = 0; r < sizeof rows / sizeof *rows; ++r) {
    const StateRow row = {.unit = rows[r].unit,
                          .kind = STATE_NUMBERS,
                          .entity = STATE_OF_ALL,
                          .role = STATE_COMMITTED,
                          .count = b->count + b->specs->count,
                          .values = rows[r].values};
    state_add(list, &row, rows[r].name, NULL);
  }
}
