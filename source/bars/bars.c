/* Bars as they are made for a body, and their table entry. */
#include "bars/bars.h"

#include "base/text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void destroy(void *forces)
{
  Bars *b = forces;
  if (b->has_points) points_destroy(&b->points);
  bar_slips_destroy(b);
  bar_lines_destroy(&b->lines);
  free(b->first);
  free(b->served);
  free(b->slope);
  free(b->bar_area);
  free(b->node);
  free(b->node_begin);
  free(b->held.place);
  free(b->held.weight);
  free(b->rest);
  free(b->length);
  free(b->area);
  free(b->young);
  free(b->begin);
  free(b->joined.place);
  free(b->joined.weight);
  free(b->touched);
  free(b->touching_begin);
  free(b->touching);
  free(b->touching_weight);
  free(b->along);
  free(b->line_strain);
  free(b->longer);
  free(b->strain);
  free(b->stress);
  free(b->slack);
  free(b->strain_held);
  free(b->stress_held);
  free(b->pull);
  free(b->prestrain);
  free(b->prestrain_held);
  free(b->tangent);
  free(b->across);
  free(b->chunk);
  free(b->chunk_bar);
  free(b->bend);
  free(b->bent);
  free(b->turn);
  free(b->worked);
  free(b->yielded);
  free(b->torn);
  free(b->lowest);
  free(b->highest);
  free(b);
}

/** Adds the weights of a point, times a sign, to those of an element: a place that is there already gets the sum. */
static bool join(Bars *b, int64_t e, const BarWeights *of, double sign)
{
  bool whole = true;
  for (int64_t n = 0; n < of->count && whole; ++n) {
    int64_t at = b->begin[e];
    while (at < b->joined.count && b->joined.place[at] != of->place[n]) ++at;
    if (at < b->joined.count)
      b->joined.weight[at] += sign * of->weight[n];
    else
      whole = bar_weights_add(&b->joined, of->place[n], sign * of->weight[n]);
  }
  return whole;
}

static bool weigh(const Bars *b, const BarSpec *bar, const Cells *cells, const double point[3], BarWeights *weights)
{
  weights->count = 0;
  if (bar->snap) return bar_weights_add(weights, body_nearest(b->body, point), 1);
  return bar_weigh(weights, b->body, cells, point);
}

/** Keeps the weights of the next node. */
static bool hold(Bars *b, int64_t node, const BarWeights *of)
{
  bool whole = true;
  for (int64_t n = 0; n < of->count && whole; ++n) whole = bar_weights_add(&b->held, of->place[n], of->weight[n]);
  b->node_begin[node + 1] = b->held.count;
  return whole;
}

/** Elements of a bar whose nodes are known. @return false: no memory */
static bool add_elements(Bars *b, int number, const Cells *cells, const double *nodes, int64_t count)
{
  const BarSpec *bar = b->specs->items[number];
  BarWeights ends[2] = {{0}};
  memcpy(b->node[b->count + number], nodes, 3 * (size_t)count * sizeof *nodes);
  bool whole = weigh(b, bar, cells, nodes, &ends[0]) && hold(b, b->count + number, &ends[0]);
  for (int64_t n = 1; n < count && whole; ++n) {
    const int64_t e = b->count++;
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      b->rest[e][k] = nodes[3 * n + k] - nodes[3 * (n - 1) + k];
      square += b->rest[e][k] * b->rest[e][k];
    }
    b->length[e] = sqrt(square);
    b->begin[e] = b->joined.count;
    whole = weigh(b, bar, cells, nodes + 3 * n, &ends[n % 2]) && join(b, e, &ends[(n - 1) % 2], -1) &&
            join(b, e, &ends[n % 2], 1) && hold(b, e + number + 1, &ends[n % 2]);
    b->begin[e + 1] = b->joined.count;
  }
  for (int k = 0; k < 2; ++k) {
    free(ends[k].place);
    free(ends[k].weight);
  }
  return whole;
}

static bool make_room(Bars *b, int64_t count, Error *error)
{
  const size_t n = (size_t)count;
  const size_t bars = (size_t)b->specs->count;
  b->node = memory_zeroed(n + bars, sizeof *b->node, "bars", error);
  b->node_begin = memory_zeroed(n + bars + 1, sizeof *b->node_begin, "bars", error);
  b->lowest = memory_zeroed(bars, sizeof *b->lowest, "bars", error);
  b->highest = memory_zeroed(bars, sizeof *b->highest, "bars", error);
  b->prestrain = memory_zeroed(bars, sizeof *b->prestrain, "bars", error);
  b->prestrain_held = memory_zeroed(bars, sizeof *b->prestrain_held, "bars", error);
  b->rest = memory_zeroed(n, sizeof *b->rest, "bars", error);
  b->along = memory_zeroed(n, sizeof *b->along, "bars", error);
  b->pull = memory_zeroed(n, sizeof *b->pull, "bars", error);
  b->begin = memory_zeroed(n + 1, sizeof *b->begin, "bars", error);
  b->chunk = memory_zeroed(n + 1, sizeof *b->chunk, "bars", error);
  b->chunk_bar = memory_zeroed(n + 1, sizeof *b->chunk_bar, "bars", error);
  bool made = b->node && b->node_begin && b->lowest && b->highest && b->prestrain && b->prestrain_held && b->rest &&
              b->along && b->pull && b->begin && b->chunk && b->chunk_bar;
  double **const numbers[] = {&b->length,      &b->area,    &b->young,  &b->strain, &b->stress,  &b->strain_held,
                              &b->stress_held, &b->tangent, &b->across, &b->worked, &b->yielded, &b->torn,
                              &b->line_strain, &b->longer,  &b->slack,  &b->slope};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k)
    made &= (*numbers[k] = memory_zeroed(n, sizeof(double), "bars", error)) != NULL;
  for (size_t e = 0; e < n && made; ++e) b->yielded[e] = b->torn[e] = -1;
  return made;
}

static double area_of(const BarSpec *bar)
{
  return (double)bar->number * (isnan(bar->area) ? acos(-1) / 4 * bar->diameter * bar->diameter : bar->area);
}

/** All elements. @param[in] nodes, counts  of every bar */
static int make_elements(Bars *b, const ForcesParts *parts, double *const *nodes, const int64_t *counts, Error *error)
{
  int64_t all = 0;
  for (int n = 0; n < b->specs->count; ++n) all += counts[n] - 1;
  if (!make_room(b, all, error)) return BRECCIA_FAILURE;
  const Particles *p = &b->body->particles;
  const double *const position[3] = {p->position[0], p->position[1], p->position[2]};
  Cells cells;
  bool whole = !cells_create(&cells, p, position, 3 * b->body->largest_spacing, error);
  for (int n = 0; n < b->specs->count && whole; ++n) {
    const BarSpec *bar = b->specs->items[n];
    const Material *m = bar_material(bar, parts);
    b->first[n] = b->count;
    b->bar_area[n] = area_of(bar);
    b->served[n] = m->remote != NULL;
    whole = add_elements(b, n, &cells, nodes[n], counts[n]);
    b->first[n + 1] = b->count;
    for (int64_t e = b->first[n]; e < b->count; ++e) {
      b->area[e] = b->bar_area[n];
      b->young[e] = m->law->components == 1 ? 0 : material_young(m);
      b->slope[e] = material_young(m);
      if ((e - b->first[n]) % BATCH == 0) {
        b->chunk_bar[b->chunk_count] = n;
        b->chunk[b->chunk_count++] = e;
      }
    }
    b->chunk[b->chunk_count] = b->count;
  }
  cells_destroy(&cells);
  return whole ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: bars");
}

/** The weights the other way round: of every place the elements that pull on it. */
static int make_touching(Bars *b, Error *error)
{
  const int64_t places = b->body->particles.places, all = b->joined.count;
  int64_t *number = memory_zeroed((size_t)places, sizeof *number, "bars", error);
  if (!number) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < all; ++n) ++number[b->joined.place[n]];
  for (int64_t i = 0; i < places; ++i) b->touched_count += number[i] > 0;
  b->touched = memory_zeroed((size_t)b->touched_count, sizeof *b->touched, "bars", error);
  b->touching_begin = memory_zeroed((size_t)b->touched_count + 1, sizeof *b->touching_begin, "bars", error);
  b->touching = memory_zeroed((size_t)all, sizeof *b->touching, "bars", error);
  b->touching_weight = memory_zeroed((size_t)all, sizeof *b->touching_weight, "bars", error);
  const bool made = b->touched && b->touching_begin && b->touching && b->touching_weight;
  for (int64_t i = 0, t = 0, at = 0; i < places && made; ++i) {
    if (!number[i]) continue;
    b->touched[t] = (int32_t)i;
    b->touching_begin[t++] = at;
    at += number[i];
    number[i] = at - number[i]; /* where its next element goes */
    b->touching_begin[t] = at;
  }
  for (int64_t e = 0; e < b->count && made; ++e)
    for (int64_t n = b->begin[e]; n < b->begin[e + 1]; ++n) {
      const int64_t at = number[b->joined.place[n]]++;
      b->touching[at] = e;
      b->touching_weight[at] = b->joined.weight[n];
    }
  free(number);
  return made ? BRECCIA_OK : BRECCIA_FAILURE;
}

static int make_points(Bars *b, const ForcesParts *parts, Error *error)
{
  PointsRun *runs = memory_zeroed((size_t)b->specs->count, sizeof *runs, "bars", error);
  PointsSpec spec = {.components = 1,
                     .clock = parts->clock,
                     .runs = runs,
                     .materials = parts->materials,
                     .material_count = parts->material_count,
                     .may_give_up = true, /* a bar that is torn carries nothing */
                     .length = NAN};
  for (int n = 0; runs && n < b->specs->count; ++n) {
    const Material *m = bar_material(b->specs->items[n], parts);
    if (m->law->components != 1) continue;
    runs[spec.run_count++] = (PointsRun){(int)(m - parts->materials), b->first[n], b->first[n + 1] - b->first[n]};
  }
  b->has_points = runs && spec.run_count > 0;
  const int status = !runs ? BRECCIA_FAILURE : b->has_points ? points_create(&b->points, &spec, error) : BRECCIA_OK;
  free(runs);
  return status;
}

/** Steel that begins under stress, by its law, holds energy from the beginning.
 *  @param[in] served  of those whose law runs in a server, or of the others */
static void begin_under_stress(Bars *b, bool served)
{
  for (int n = 0; n < b->specs->count && b->has_points; ++n)
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      if (b->young[e] > 0 || b->served[n] != served) continue;
      const double stress = points_try(&b->points, e, 0, 0, NULL);
      b->slack[e] = -stress / material_young(points_material(&b->points, e));
      b->stress_held[e] = b->lowest[n] = b->highest[n] = stress;
      b->worked[e] = bars_stored(b, e, e + 1, false);
    }
}

static int make(Bars *b, const ForcesParts *parts, Error *error)
{
  const int bars = b->specs->count;
  int status = BRECCIA_OK;
  b->first = memory_zeroed((size_t)bars + 1, sizeof *b->first, "bars", error);
  b->bar_area = memory_zeroed((size_t)bars, sizeof *b->bar_area, "bars", error);
  b->served = memory_zeroed((size_t)bars, sizeof *b->served, "bars", error);
  double **nodes = memory_zeroed((size_t)bars, sizeof *nodes, "bars", error);
  int64_t *counts = memory_zeroed((size_t)bars, sizeof *counts, "bars", error);
  if (!b->first || !b->bar_area || !b->served || !nodes || !counts) status = BRECCIA_FAILURE;
  for (int n = 0; n < bars && !status; ++n) {
    const BarSpec *bar = b->specs->items[n];
    counts[n] = bar_nodes(bar, b->body, &nodes[n]);
    if (counts[n] < 0) status = error_add(error, BRECCIA_FAILURE, "out of memory: bars");
    if (!status && bar->snap) counts[n] = bar_snap(b->body, nodes[n], counts[n]);
  }
  if (!status) status = make_elements(b, parts, nodes, counts, error);
  for (int n = 0; nodes && n < bars; ++n) free(nodes[n]);
  free(nodes);
  free(counts);
  if (!status) status = make_touching(b, error);
  if (!status) status = bar_slips_create(b, parts, error);
  if (!status) status = make_points(b, parts, error);
  if (!status) begin_under_stress(b, false);
  if (!status) status = bar_bending_create(b, parts, error);
  return status;
}

static int create(const void *spec, const ForcesParts *parts, void **forces, Error *error)
{
  Bars *b = *forces = memory_zeroed(1, sizeof *b, "bars", error);
  if (!b) return BRECCIA_FAILURE;
  b->body = parts->body;
  b->clock = parts->clock;
  b->materials = parts->materials;
  b->specs = &b->lines.specs;
  if (!bar_lines_create(&b->lines, spec)) return error_add(error, BRECCIA_FAILURE, "out of memory: bars");
  return make(b, parts, error);
}

/* ---- the rest of the table ---- */

static int begin(void *forces, Error *error)
{
  Bars *b = forces;
  if (!b->has_points) return BRECCIA_OK;
  const int status = points_ask_first_stresses(&b->points, error);
  if (!status) begin_under_stress(b, true);
  return status;
}

static bool any_served(const Bars *b)
{
  bool any = false;
  for (int n = 0; n < b->specs->count; ++n) any |= b->served[n];
  return any;
}

/** Where there are none they are told the stage and the tangents wanted all the same, for bond. */
static Points *points(void *forces)
{
  Bars *b = forces;
  return b->has_points || b->slips ? &b->points : NULL;
}

static void state(void *forces, StateList *list)
{
  Bars *b = forces;
  StateRow row = {
      .unit = "1", .kind = STATE_NUMBERS, .entity = STATE_OF_ALL, .role = STATE_COMMITTED, .count = b->count};
  row.values = b->strain_held;
  state_add(list, &row, "bar strain", NULL);
  row.values = b->slack;
  if (any_served(b)) state_add(list, &row, "strain of slack bars", NULL); /* of others it is made again */
  row.unit = "stress";
  row.values = b->stress_held;
  state_add(list, &row, "bar stress", NULL);
  row.unit = "energy";
  row.values = b->worked;
  state_add(list, &row, "work on bars", NULL);
  row.unit = "time";
  row.values = b->yielded;
  state_add(list, &row, "bar yielded", NULL);
  row.values = b->torn;
  state_add(list, &row, "bar torn", NULL);
  row.unit = "stress";
  row.count = b->specs->count;
  row.values = b->lowest;
  state_add(list, &row, "lowest bar stress", NULL);
  row.values = b->highest;
  state_add(list, &row, "highest bar stress", NULL);
  row.unit = "1";
  row.role = STATE_TRIED;
  row.values = b->prestrain;
  state_add(list, &row, "prestrain", NULL);
  row.role = STATE_COMMITTED;
  row.values = b->prestrain_held;
  state_add(list, &row, "prestrain before", NULL);
  state_add_number(list, "work of prestrains", "energy", STATE_COMMITTED, &b->given);
  if (b->has_points) points_state(&b->points, "bars", list);
  if (b->slips) bar_slips_state(b, list);
  if (b->bends) bar_bending_state(b, list);
}

static const Dimension stiffness_in_bending = {.name = "stiffness in bending", .length = 2, .force = 1};

static void describe(const void *forces, const Units *units, Text *text)
{
  const Bars *b = forces;
  int64_t bars = 0;
  double volume = 0;
  char unit[64], bending[64];
  for (int n = 0; n < b->specs->count; ++n) bars += ((const BarSpec *)b->specs->items[n])->number;
  for (int64_t e = 0; e < b->count; ++e) volume += b->area[e] * b->length[e];
  units_name(units, dimension_find("area"), unit, sizeof unit);
  units_name(units, &stiffness_in_bending, bending, sizeof bending);
  text_add(text, "bars:");
  const int of_deck = b->lines.deck->count;
  for (int n = 0; n < of_deck && n < 6; ++n) {
    const BarSpec *bar = b->lines.deck->items[n];
    const int lines = deck_bar_lines(b, n);
    text_add(text, "%s ", n ? "," : "");
    if (lines > 1) text_add(text, "%d times ", lines);
    text_add(text, "%lld '%s' of %.4g %s%s", (long long)bar->number, bar->head.name, b->bar_area[b->lines.first[n]],
             unit, bar->number > 1 ? " together" : "");
    if (!bar->bending) continue;
    const int line = b->lines.first[n];
    const int64_t joints = bar_joints(b, line), most = b->first[line + 1] - b->first[line] - 1;
    text_add(text, " (EI %.4g %s", bar_bending_stiffness(b, line), bending);
    if (joints < most) text_add(text, " at %lld of %lld joints; none at corners", (long long)joints, (long long)most);
    text_add(text, ")");
  }
  if (of_deck > 6) text_add(text, " and others, %lld in all", (long long)bars);
  units_name(units, dimension_find("volume"), unit, sizeof unit);
  text_add(text, "; %lld elements, %.4g %s of steel\n", (long long)b->count, volume, unit);
  int told = 0;
  for (int n = 0; n < of_deck && told < 6; ++n) {
    const int line = b->lines.first[n];
    if (!bar_slips(b, line)) continue;
    bar_slips_describe(b, line, units, text);
    ++told;
  }
}

static void join_places(const void *forces, void (*one)(void *context, int32_t a, int32_t b), void *context)
{
  const Bars *b = forces;
  for (int64_t e = 0; e < b->count; ++e) {
    if (b->torn[e] >= 0) continue;
    for (int64_t n = b->begin[e] + 1; n < b->begin[e + 1]; ++n)
      one(context, b->joined.place[b->begin[e]], b->joined.place[n]);
  }
}

const ForcesType bars_forces = {.name = "bars",
                                .uses = bars_use,
                                .check = bars_check,
                                .create = create,
                                .destroy = destroy,
                                .points = points,
                                .begin = begin,
                                .accept = bars_accept,
                                .resist = bars_resist,
                                .linearise = bars_linearise,
                                .change = bars_change,
                                .join = join_places,
                                .unassembled = bars_unassembled,
                                .stuck = bars_stuck,
                                .point_count = bars_point_count,
                                .point = bars_point,
                                .energy = bars_energy,
                                .given = bars_given,
                                .dissipated = bars_dissipated,
                                .state = state,
                                .describe = describe};
