/* What bars are like and have gone through: for histories, results and people. */
#include "bars/bars.h"

#include "body/nearer.h"
#include "constitutive/min_max.h"
#include <math.h>
#include <string.h>

const Bars *bars_among(const Forces *forces)
{
  for (int k = 0; k < forces->count; ++k)
    if (forces->type[k] == &bars_forces) return forces->own[k];
  return NULL;
}

const char *bar_name(const Bars *b, int bar)
{
  return ((const BarSpec *)b->specs->items[bar])->head.name;
}

const char *deck_bar_name(const Bars *b, int deck_bar)
{
  return ((const BarSpec *)b->lines.deck->items[deck_bar])->head.name;
}

int deck_bar_lines(const Bars *b, int deck_bar)
{
  return b->lines.first[deck_bar + 1] - b->lines.first[deck_bar];
}

double bar_young(const Bars *b, int bar)
{
  const int64_t e = b->first[bar];
  return b->young[e] > 0 ? b->young[e] : material_young(points_material(&b->points, e));
}

bool bars_were_refused(const Bars *bars, const DeckReader *reader)
{
  const Node *given = node_get(reader->document->root, "bars");
  return !bars && given && given->count;
}

int bars_find(const Bars *b, const char *name)
{
  for (int n = 0; b && n < b->lines.deck->count; ++n)
    if (!strcmp(deck_bar_name(b, n), name)) return n;
  return -1;
}

int bar_of(const Bars *b, int64_t e)
{
  int low = 0, high = b->specs->count;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if (b->first[middle] <= e)
      low = middle;
    else
      high = middle;
  }
  return low;
}

void bar_middle(const Bars *b, int64_t e, double middle[3])
{
  const int bar = bar_of(b, e);
  for (int k = 0; k < 3; ++k) middle[k] = (b->node[e + bar][k] + b->node[e + bar + 1][k]) / 2;
}

void bar_node_displacement(const Bars *b, int64_t node, double u[3])
{
  for (int k = 0; k < 3; ++k) {
    u[k] = 0;
    for (int64_t n = b->node_begin[node]; n < b->node_begin[node + 1]; ++n)
      u[k] += b->held.weight[n] * particles_moved(&b->body->particles, k, b->held.place[n]);
  }
}

int64_t bar_nearest(const Bars *b, int deck_bar, const double point[3])
{
  const int64_t from = b->first[b->lines.first[deck_bar]], to = b->first[b->lines.first[deck_bar + 1]];
  int64_t nearest = from;
  double least = INFINITY;
  for (int64_t e = from; e < to; ++e) {
    double middle[3], square = 0;
    bar_middle(b, e, middle);
    for (int k = 0; k < 3; ++k) square += (middle[k] - point[k]) * (middle[k] - point[k]);
    if (!is_nearer(square, least)) continue;
    least = square;
    nearest = e;
  }
  return nearest;
}

/** Strain that an element whose law is not Hooke's would give back. On its first straight line it holds all of its stress: laws with rounded corners
 *  leave the stress that they began with, or that an elastic stage gave them, by a jump, which is no flow. Laws in servers, which are not asked, are taken
 *  to unload by their first modulus. */
static double elastic_strain(const Bars *b, int64_t e)
{
  const Material *m = points_material(&b->points, e);
  const double straight = b->stress_held[e] / material_young(m), rounding = 1e-12;
  if (m->remote || fabs(b->strain_held[e] - b->slack[e] - straight) <= rounding * fabs(straight)) return straight;
  return points_elastic_strain(&b->points, e, b->strain_held[e], 0, b->slack[e]);
}

double bars_stored(const Bars *b, int64_t from, int64_t to, bool hookean)
{
  double sum = 0;
  for (int64_t e = from; e < to; ++e) {
    if ((b->young[e] > 0) != hookean) continue;
    const double elastic = hookean ? b->strain_held[e] : elastic_strain(b, e);
    sum += b->area[e] * b->length[e] * b->stress_held[e] * elastic / 2;
  }
  return sum;
}

double bar_dissipated_in(const Bars *b, int64_t e)
{
  return b->young[e] > 0 ? 0 : b->worked[e] - bars_stored(b, e, e + 1, false);
}

/** Beyond where its law is straight: laws of steel with rounded corners leave the line from the beginning, but by little. Roundings of a bar that is
 *  loose again are none.
 *  @param largest  stress of the bar so far */
static bool has_yielded(const Bars *b, int64_t e, double largest)
{
  const double beyond = 1.02,
               elastic = material_young(points_material(&b->points, e)) * fabs(b->strain_held[e] - b->slack[e]);
  return elastic > beyond * fabs(b->stress_held[e]) && elastic > 1e-9 * largest;
}

static bool is_torn(const Bars *b, int64_t e)
{
  if (b->points.gave_up && b->points.gave_up[e]) return true;
  return material_is_beyond_limits(points_material(&b->points, e), points_history(&b->points, e));
}

void bars_note(Bars *b)
{
  for (int n = 0; n < b->specs->count; ++n)
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      b->lowest[n] = fmin(b->lowest[n], b->stress_held[e]);
      b->highest[n] = fmax(b->highest[n], b->stress_held[e]);
      if (b->young[e] > 0) continue;
      if (b->yielded[e] < 0 && has_yielded(b, e, fmax(-b->lowest[n], b->highest[n]))) b->yielded[e] = b->clock->time;
      if (b->torn[e] < 0 && is_torn(b, e)) b->torn[e] = b->clock->time;
    }
}

/** Notes which element was first. */
static void note_first(const double *when, int64_t e, int64_t *first)
{
  if (when[e] >= 0 && (*first < 0 || when[e] < when[*first])) *first = e;
}

BarReport bar_report(const Bars *b, int deck_bar)
{
  const int first = b->lines.first[deck_bar], behind = b->lines.first[deck_bar + 1];
  const int64_t from = b->first[first], to = b->first[behind];
  BarReport r = {.least_strain = INFINITY,
                 .largest_strain = -INFINITY,
                 .least_stress = INFINITY,
                 .largest_stress = -INFINITY,
                 .lowest_stress = b->lowest[first],
                 .highest_stress = b->highest[first],
                 .first_yielded = -1,
                 .first_torn = -1};
  double length = 0;
  for (int64_t e = from; e < to; ++e) {
    r.least_strain = fmin(r.least_strain, b->strain_held[e]);
    r.largest_strain = fmax(r.largest_strain, b->strain_held[e]);
    r.least_stress = fmin(r.least_stress, b->stress_held[e]);
    r.largest_stress = fmax(r.largest_stress, b->stress_held[e]);
    r.dissipated += b->worked[e];
    length += b->length[e];
    if (b->yielded[e] >= 0) r.yielded += b->length[e];
    if (b->torn[e] >= 0) r.torn += b->length[e];
    note_first(b->yielded, e, &r.first_yielded);
    note_first(b->torn, e, &r.first_torn);
  }
  const double of_points = b->has_points ? bars_stored(b, from, to, false) : 0;
  r.stored = bars_stored(b, from, to, true) + of_points + bars_bent(b, from, to);
  r.dissipated -= of_points;
  for (int n = first; n < behind; ++n) {
    r.lowest_stress = fmin(r.lowest_stress, b->lowest[n]);
    r.highest_stress = fmax(r.highest_stress, b->highest[n]);
    r.stored += bar_bond_stored(b, n);
    r.dissipated += bar_bond_dissipated(b, n);
    for (int64_t k = b->first[n] + n; k <= b->first[n + 1] + n && bar_slips(b, n); ++k) {
      r.least_slip = fmin(r.least_slip, b->slips->slip_held[k]);
      r.largest_slip = fmax(r.largest_slip, b->slips->slip_held[k]);
    }
  }
  r.yielded /= length;
  r.torn /= length;
  return r;
}
