#include "bars/bars.h"

#include "base/text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void check_bar(const DeckReader *reader, void *section)
{
  const BarSpec *bar = section;
  const Node *node = section_node(section, "points");
  if (bar->points.count < 2) {
    node_error(reader->document, node, reader->error, "points: a bar needs two or more");
    return;
  }
  for (int n = 1; n < bar->points.count; ++n)
    if (!memcmp(bar->points.values + 3 * n, bar->points.values + 3 * (n - 1), 3 * sizeof(double)))
      node_error(reader->document, node, reader->error, "points: points %d and %d are the same; leave one out", n,
                 n + 1);
}

static const Field bar_fields[] = {
    {.key = "points",
     .kind = FIELD_POINTS,
     .offset = offsetof(BarSpec, points),
     .dimension = "length",
     .meaning = "two or more, which straight lines join; of a stirrup the last is the first again"},
    {.key = "diameter",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BarSpec, diameter),
     .dimension = "length",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "of one bar",
     .group = 'a'},
    {.key = "area",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BarSpec, area),
     .dimension = "area",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "cross-section of one bar, instead of 'diameter'",
     .group = 'a'},
    {.key = "number",
     .kind = FIELD_COUNT,
     .offset = offsetof(BarSpec, number),
     .standard = "1",
     .range = "[1, inf)",
     .meaning = "of parallel bars on this line; in the plane of those in the whole thickness"},
    {.key = "material",
     .kind = FIELD_NAME,
     .offset = offsetof(BarSpec, material),
     .dimension = "material",
     .meaning = "name of one of the materials: of a law of one strain, or 'elastic', of which Young's modulus counts"},
    {.key = "snap",
     .kind = FIELD_FLAG,
     .offset = offsetof(BarSpec, snap),
     .standard = "no",
     .meaning = "ends of elements are moved to the nearest particles, and pull on those only"},
};

const Section bars_section = {
    .name = "bar",
    .about =
        "Reinforcing bars in perfect bond, in any formulation: straight elements about a spacing long, whose ends "
        "move as the particles around them and pull on them. The body goes on where bars are, nothing is taken out "
        "of it, and bars have no mass of their own.",
    .size = sizeof(BarSpec),
    FIELDS(bar_fields),
    .check = check_bar};

/* ---- lines ---- */

/** How far a point in a body can be from the nearest particle, in spacings, with some room. */
static double farthest(const Body *body)
{
  return 0.55 * sqrt(body->dimensions);
}

static double distance(const Body *body, int32_t place, const double point[3])
{
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = body->particles.position[k][place] - point[k];
    square += d * d;
  }
  return sqrt(square);
}

static double spacing_at(const Body *body, const double point[3])
{
  return body->lattices[body->particles.block[body_nearest(body, point) / SLICE]].spacing;
}

int64_t bar_nodes(const BarSpec *bar, const Body *body, double **out)
{
  int64_t count = 0, capacity = 0;
  double *nodes = NULL;
  for (int s = 1; s < bar->points.count; ++s) {
    const double *a = bar->points.values + 3 * (s - 1), *b = a + 3;
    const double length =
        sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
    const double middle[3] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    const int64_t parts = (int64_t)fmax(1, round(length / spacing_at(body, middle)));
    if (count + parts + 1 > capacity) {
      capacity = 2 * (count + parts + 1);
      double *grown = memory_grown(nodes, (size_t)capacity, 3 * sizeof *nodes);
      if (!grown) {
        free(nodes);
        return -1;
      }
      nodes = grown;
    }
    for (int64_t n = s > 1; n <= parts; ++n, ++count)
      for (int k = 0; k < 3; ++k)
        nodes[3 * count + k] = n == parts ? b[k] : a[k] + (b[k] - a[k]) * (double)n / (double)parts;
  }
  *out = nodes;
  return count;
}

/** Moves nodes to the nearest particles; what becomes of no length is left out. @return how many are left */
static int64_t snap(const Body *body, double *nodes, int64_t count)
{
  int64_t kept = 0;
  int32_t before = -1;
  for (int64_t n = 0; n < count; ++n) {
    const int32_t near = body_nearest(body, nodes + 3 * n);
    if (near == before) continue;
    before = near;
    for (int k = 0; k < 3; ++k) nodes[3 * kept + k] = body->particles.position[k][near];
    ++kept;
  }
  return kept;
}

static int check_line(const BarSpec *bar, const ForcesParts *parts)
{
  const Body *body = parts->body;
  double *nodes;
  const int64_t count = bar_nodes(bar, body, &nodes);
  int status = count < 0 ? error_add(parts->reader->error, BRECCIA_FAILURE, "out of memory: bars") : BRECCIA_OK;
  for (int64_t n = 0; n < count && !status; ++n) {
    const double *x = nodes + 3 * n, away = distance(body, body_nearest(body, x), x) / spacing_at(body, x);
    if (body->dimensions < 3 && fabs(x[2] - body->particles.position[2][body_nearest(body, x)]) > 0)
      status = node_error(parts->reader->document, section_node(bar, "points"), parts->reader->error,
                          "points: bar '%s' has z = %g, and the body lies in the plane z = 0; give x and y only",
                          bar->head.name, x[2]);
    else if (away > farthest(body))
      status =
          node_error(parts->reader->document, section_node(bar, "points"), parts->reader->error,
                     "points: bar '%s' is outside the body at [%g, %g, %g], %.3g spacings from the nearest particle; "
                     "keep its line within the body",
                     bar->head.name, x[0], x[1], x[2], away);
  }
  if (!status && bar->snap && snap(body, nodes, count) < 2)
    status = node_error(parts->reader->document, section_node(bar, "snap"), parts->reader->error,
                        "snap: all of bar '%s' comes to one particle; leave 'snap' out", bar->head.name);
  if (count >= 0) free(nodes);
  return status;
}

static const Material *material_of(const BarSpec *bar, const ForcesParts *parts)
{
  for (int k = 0; k < parts->material_count; ++k)
    if (!strcmp(parts->materials[k].name, bar->material)) return &parts->materials[k];
  return NULL;
}

static bool uses(const void *spec, const char *material)
{
  const SectionList *list = spec;
  for (int n = 0; n < list->count; ++n)
    if (!strcmp(((const BarSpec *)list->items[n])->material, material)) return true;
  return false;
}

static int check(const void *spec, const ForcesParts *parts)
{
  const SectionList *list = spec;
  int status = BRECCIA_OK;
  for (int n = 0; n < list->count; ++n) {
    const BarSpec *bar = list->items[n];
    const Material *m = material_of(bar, parts);
    int bad = check_line(bar, parts);
    if (m && m->remote)
      bad =
          node_error(parts->reader->document, section_node(bar, "material"), parts->reader->error,
                     "material: '%s' runs in a material server, which bars do not ask yet; take a law of this program",
                     bar->material);
    else if (m && m->law->components != 1 && !material_is_hookean(m))
      bad = node_error(parts->reader->document, section_node(bar, "material"), parts->reader->error,
                       "material: '%s' is '%s', a law of strain in space; bars take laws of one strain, like "
                       "'steel-bilinear', and 'elastic'",
                       bar->material, m->law_name);
    if (bad) status = bad;
  }
  return status;
}

/* ---- making ---- */

static void destroy(void *forces)
{
  Bars *b = forces;
  if (b->has_points) points_destroy(&b->points);
  free(b->first);
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
  free(b->strain);
  free(b->stress);
  free(b->strain_held);
  free(b->stress_held);
  free(b->pull);
  free(b->tangent);
  free(b->across);
  free(b->chunk);
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
  b->rest = memory_zeroed(n, sizeof *b->rest, "bars", error);
  b->along = memory_zeroed(n, sizeof *b->along, "bars", error);
  b->pull = memory_zeroed(n, sizeof *b->pull, "bars", error);
  b->begin = memory_zeroed(n + 1, sizeof *b->begin, "bars", error);
  b->chunk = memory_zeroed(n + 1, sizeof *b->chunk, "bars", error);
  bool made =
      b->node && b->node_begin && b->lowest && b->highest && b->rest && b->along && b->pull && b->begin && b->chunk;
  double **const numbers[] = {&b->length,      &b->area,    &b->young,  &b->strain, &b->stress,  &b->strain_held,
                              &b->stress_held, &b->tangent, &b->across, &b->worked, &b->yielded, &b->torn};
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
    const Material *m = material_of(bar, parts);
    b->first[n] = b->count;
    b->bar_area[n] = area_of(bar);
    whole = add_elements(b, n, &cells, nodes[n], counts[n]);
    b->first[n + 1] = b->count;
    for (int64_t e = b->first[n]; e < b->count; ++e) {
      b->area[e] = b->bar_area[n];
      b->young[e] = m->law->components == 1 ? 0 : material_young(m);
      if ((e - b->first[n]) % BATCH == 0) b->chunk[b->chunk_count++] = e;
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
                     .runs = runs,
                     .materials = parts->materials,
                     .material_count = parts->material_count,
                     .may_give_up = true, /* a bar that is torn carries nothing */
                     .length = NAN};
  for (int n = 0; runs && n < b->specs->count; ++n) {
    const Material *m = material_of(b->specs->items[n], parts);
    if (m->law->components != 1) continue;
    runs[spec.run_count++] = (PointsRun){(int)(m - parts->materials), b->first[n], b->first[n + 1] - b->first[n]};
  }
  b->has_points = runs && spec.run_count > 0;
  const int status = !runs ? BRECCIA_FAILURE : b->has_points ? points_create(&b->points, &spec, error) : BRECCIA_OK;
  free(runs);
  return status;
}

static int make(Bars *b, const ForcesParts *parts, Error *error)
{
  const int bars = b->specs->count;
  int status = BRECCIA_OK;
  b->first = memory_zeroed((size_t)bars + 1, sizeof *b->first, "bars", error);
  b->bar_area = memory_zeroed((size_t)bars, sizeof *b->bar_area, "bars", error);
  double **nodes = memory_zeroed((size_t)bars, sizeof *nodes, "bars", error);
  int64_t *counts = memory_zeroed((size_t)bars, sizeof *counts, "bars", error);
  if (!b->first || !b->bar_area || !nodes || !counts) status = BRECCIA_FAILURE;
  for (int n = 0; n < bars && !status; ++n) {
    const BarSpec *bar = b->specs->items[n];
    counts[n] = bar_nodes(bar, b->body, &nodes[n]);
    if (counts[n] < 0) status = error_add(error, BRECCIA_FAILURE, "out of memory: bars");
    if (!status && bar->snap) counts[n] = snap(b->body, nodes[n], counts[n]);
  }
  if (!status) status = make_elements(b, parts, nodes, counts, error);
  for (int n = 0; nodes && n < bars; ++n) free(nodes[n]);
  free(nodes);
  free(counts);
  if (!status) status = make_touching(b, error);
  return status ? status : make_points(b, parts, error);
}

static void *create(const void *spec, const ForcesParts *parts, Error *error)
{
  Bars *b = memory_zeroed(1, sizeof *b, "bars", error);
  if (!b) return NULL;
  b->specs = spec;
  b->body = parts->body;
  b->materials = parts->materials;
  if (!make(b, parts, error)) return b;
  destroy(b);
  return NULL;
}

/* ---- the rest of the table ---- */

static Points *points(void *forces)
{
  Bars *b = forces;
  return b->has_points ? &b->points : NULL;
}

static void state(void *forces, StateList *list)
{
  Bars *b = forces;
  StateRow row = {
      .unit = "1", .kind = STATE_NUMBERS, .entity = STATE_OF_ALL, .role = STATE_COMMITTED, .count = b->count};
  row.values = b->strain_held;
  state_add(list, &row, "bar strain", NULL);
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
  if (b->has_points) points_state(&b->points, "bars", list);
}

static void describe(const void *forces, const Units *units, Text *text)
{
  const Bars *b = forces;
  int64_t bars = 0;
  double volume = 0;
  char unit[64];
  for (int n = 0; n < b->specs->count; ++n) bars += ((const BarSpec *)b->specs->items[n])->number;
  for (int64_t e = 0; e < b->count; ++e) volume += b->area[e] * b->length[e];
  units_name(units, dimension_find("area"), unit, sizeof unit);
  text_add(text, "bars:");
  for (int n = 0; n < b->specs->count && n < 6; ++n)
    text_add(text, "%s %lld '%s' of %.4g %s", n ? "," : "", (long long)((const BarSpec *)b->specs->items[n])->number,
             ((const BarSpec *)b->specs->items[n])->head.name, b->bar_area[n], unit);
  if (b->specs->count > 6) text_add(text, " and others, %lld in all", (long long)bars);
  units_name(units, dimension_find("volume"), unit, sizeof unit);
  text_add(text, "; %lld elements, %.4g %s of steel\n", (long long)b->count, volume, unit);
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
                                .uses = uses,
                                .check = check,
                                .create = create,
                                .destroy = destroy,
                                .points = points,
                                .accept = bars_accept,
                                .resist = bars_resist,
                                .linearise = bars_linearise,
                                .change = bars_change,
                                .join = join_places,
                                .point_count = bars_point_count,
                                .point = bars_point,
                                .energy = bars_energy,
                                .dissipated = bars_dissipated,
                                .state = state,
                                .describe = describe};
