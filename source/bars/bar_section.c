/* Bars as decks have them: their keys, the nodes of their lines, and what a body does not take. */
#include "bars/bars.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Mistakes in what only bars that slip have. */
static void check_slip(const DeckReader *reader, const BarSpec *bar)
{
  for (int n = 0; n < bar->anchored.count; ++n)
    if (strcmp(bar->anchored.items[n], "start") != 0 && strcmp(bar->anchored.items[n], "end") != 0)
      node_error(reader->document, section_node(bar, "anchored"), reader->error,
                 "anchored: '%s' is no end of a bar; take 'start' (its first point) or 'end' (its last)",
                 bar->anchored.items[n]);
  if (bar->anchored.count == 2 && !strcmp(bar->anchored.items[0], bar->anchored.items[1]))
    node_error(reader->document, section_node(bar, "anchored"), reader->error,
               "anchored: '%s' stands here twice; take [start, end], or leave one out", bar->anchored.items[0]);
  if (bar->bonded.count && (bar->bonded.count != 2 || !(bar->bonded.values[0] <= bar->bonded.values[1])))
    node_error(reader->document, section_node(bar, "bonded"), reader->error,
               "bonded: two lengths along the bar, from its first point; the second is not the smaller one");
  if (bar->bond) return;
  if (bar->anchored.count)
    node_error(reader->document, section_node(bar, "anchored"), reader->error,
               "anchored: a bar in perfect bond slips nowhere; add 'bond', or leave this out");
  if (bar->bonded.count)
    node_error(reader->document, section_node(bar, "bonded"), reader->error,
               "bonded: says where a bar with 'bond' has it; add 'bond', or leave this out");
}

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
  if (bar->bending && bar->snap)
    node_error(reader->document, section_node(section, "bending"), reader->error,
               "bending: a line that is moved to particles has a corner at each of them, where no moment is handed on; "
               "leave 'snap' out, or this");
  check_slip(reader, bar);
  bar_check_repeat(reader, bar);
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
     .meaning = "name of one of the materials: of a law of one strain, of this program or in a server, or 'elastic', "
                "of which Young's modulus counts"},
    {.key = "snap",
     .kind = FIELD_FLAG,
     .offset = offsetof(BarSpec, snap),
     .standard = "no",
     .meaning = "ends of elements are moved to the nearest particles, and pull on those only"},
    {.key = "bending",
     .kind = FIELD_FLAG,
     .offset = offsetof(BarSpec, bending),
     .standard = "no",
     .meaning = "whether it resists bending too, as a dowel does across a crack: by Young's modulus times the second "
                "moment of its round section, at any stress; corners hand on no moment"},
    {.key = "bond",
     .kind = FIELD_SECTION,
     .offset = offsetof(BarSpec, bond),
     .standard = "",
     .section = &bond_section,
     .meaning = "how stress on the surface of the bar grows with its slip; when absent it does not slip"},
    {.key = "bonded",
     .kind = FIELD_NUMBERS,
     .offset = offsetof(BarSpec, bonded),
     .dimension = "length",
     .standard = "",
     .meaning =
         "where a bar that slips has bond: [from, to] along it, from its first point; elsewhere it runs free, as in a "
         "sleeve; all of it when absent"},
    {.key = "anchored",
     .kind = FIELD_TEXTS,
     .offset = offsetof(BarSpec, anchored),
     .standard = "",
     .meaning = "ends of a bar that slips which do not, by a hook or a plate: of 'start' and 'end'"},
    {.key = "repeat",
     .kind = FIELD_ONE_OR_SECTIONS,
     .offset = offsetof(BarSpec, repeat),
     .standard = "",
     .section = &repeat_section,
     .meaning = "lines like this one at a pitch, as of stirrups and meshes; loads and histories that name the bar are "
                "about all of them, and with 'at' about the nearest. One line when absent"},
};

const Section bars_section = {
    .name = "bar",
    .about =
        "Reinforcing bars, in perfect bond or with slip, in any formulation: straight elements about a spacing long, "
        "whose ends "
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
  if (body->block_count == 1) return body->lattices[0].spacing;
  return body->lattices[body->particles.block[body_nearest(body, point) / SLICE]].spacing;
}

static double apart(const double a[3], const double b[3])
{
  return sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
}

int64_t bar_nodes(const BarSpec *bar, const Body *body, double **out)
{
  int64_t count = 0, capacity = 0;
  double *nodes = NULL;
  for (int s = 1; s < bar->points.count; ++s) {
    const double *a = bar->points.values + 3 * (s - 1), *b = a + 3;
    const double length = apart(a, b);
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

int64_t bar_snap(const Body *body, double *nodes, int64_t count)
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

/** Points nearer than roundings of a drawing would make an element that stands for nothing. */
static int check_points(const BarSpec *bar, const ForcesParts *parts)
{
  const double least = 1e-6; /* spacings */
  for (int n = 1; n < bar->points.count; ++n) {
    const double *a = bar->points.values + 3 * (n - 1), length = apart(a, a + 3), spacing = spacing_at(parts->body, a);
    if (length < least * spacing)
      return node_error(parts->reader->document, section_node(bar, "points"), parts->reader->error,
                        "points: points %d and %d of bar '%s' are %.3g apart, which is nothing beside the spacing of "
                        "%.4g; leave one out",
                        n, n + 1, bar->head.name, length, spacing);
  }
  return BRECCIA_OK;
}

/** @param[in] key  to which what is wrong is due */
static int check_line(const BarSpec *bar, const ForcesParts *parts, const char *key)
{
  const Body *body = parts->body;
  double *nodes;
  const int64_t count = bar_nodes(bar, body, &nodes);
  int status = count < 0 ? error_add(parts->reader->error, BRECCIA_FAILURE, "out of memory: bars") : BRECCIA_OK;
  for (int64_t n = 0; n < count && !status; ++n) {
    const double *x = nodes + 3 * n;
    const int32_t near = body_nearest(body, x);
    const double away = distance(body, near, x) / body->lattices[body->particles.block[near / SLICE]].spacing;
    if (body->dimensions < 3 && fabs(x[2] - body->particles.position[2][near]) > 0)
      status = node_error(parts->reader->document, section_node(bar, key), parts->reader->error,
                          "%s: bar '%s' has z = %g, and the body lies in the plane z = 0; give x and y only", key,
                          bar->head.name, x[2]);
    else if (away > farthest(body))
      status = node_error(parts->reader->document, section_node(bar, key), parts->reader->error,
                          "%s: bar '%s' is outside the body at [%g, %g, %g], %.3g spacings from the nearest particle; "
                          "keep its line within the body",
                          key, bar->head.name, x[0], x[1], x[2], away);
  }
  if (!status && bar->bending && body->dimensions == 1)
    status = node_error(parts->reader->document, section_node(bar, "bending"), parts->reader->error,
                        "bending: nothing bends in one dimension; leave it out");
  if (!status && bar->snap && bar_snap(body, nodes, count) < 2)
    status = node_error(parts->reader->document, section_node(bar, "snap"), parts->reader->error,
                        "snap: all of bar '%s' comes to one particle; leave 'snap' out", bar->head.name);
  if (count >= 0) free(nodes);
  return status;
}

/** All lines of a bar of the deck, up to the first that is wrong. */
static int check_lines(const BarLines *lines, int deck_bar, const ForcesParts *parts)
{
  int status = check_points(lines->deck->items[deck_bar], parts);
  for (int n = lines->first[deck_bar]; n < lines->first[deck_bar + 1] && !status; ++n)
    status = check_line(lines->specs.items[n], parts, n > lines->first[deck_bar] ? "repeat" : "points");
  return status;
}

const Material *bar_material(const BarSpec *bar, const ForcesParts *parts)
{
  for (int k = 0; k < parts->material_count; ++k)
    if (!strcmp(parts->materials[k].name, bar->material)) return &parts->materials[k];
  return NULL;
}

bool bars_use(const void *spec, const char *material)
{
  const SectionList *list = spec;
  for (int n = 0; n < list->count; ++n)
    if (!strcmp(((const BarSpec *)list->items[n])->material, material)) return true;
  return false;
}

/** Servers hold the points of bars apart from those of blocks, and slips are found by trials. */
static int check_served(const BarSpec *bar, const Material *m, const ForcesParts *parts)
{
  for (int k = 0; k < parts->body->block_count; ++k)
    if (!strcmp(parts->body->blocks[k]->material, bar->material))
      return node_error(parts->reader->document, section_node(bar, "material"), parts->reader->error,
                        "material: '%s' runs in a server, which holds the points of block '%s' with it; give bars a "
                        "material of their own",
                        bar->material, parts->body->blocks[k]->head.name);
  if (bar->bond && !remote_iterates(m->remote))
    return node_error(parts->reader->document, section_node(bar, "bond"), parts->reader->error,
                      "bond: slips are found by trying strains several times, and the server of material '%s' cannot "
                      "take a trial back; leave 'bond' out, take a server that can (docs/material-server.md), or a law "
                      "of this program",
                      bar->material);
  return BRECCIA_OK;
}

/** Names of the lines of bars with 'repeat', in alphabetical order. */
typedef struct RepeatedNames {
  const char **items; /* [count] owned, the names borrowed */
  size_t count;
} RepeatedNames;

static int compare_names(const void *a, const void *b)
{
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/** Lists the names of repeated lines. @return false: memory is out */
static bool repeated_names_create(RepeatedNames *names, const BarLines *lines)
{
  *names = (RepeatedNames){.items = memory_plain((size_t)lines->specs.count + 1, sizeof *names->items)};
  if (!names->items) return false;
  for (int n = 0; n < lines->specs.count; ++n) {
    const BarSpec *bar = lines->specs.items[n];
    if (bar->repeat.count) names->items[names->count++] = bar->head.name;
  }
  qsort(names->items, names->count, sizeof *names->items, compare_names);
  return true;
}

/** Lines of a bar that is repeated are told apart by a number behind its name; a bar of such a name could not be told
 * from them. */
static int check_name(const RepeatedNames *names, const BarSpec *bar, const ForcesParts *parts)
{
  if (!bsearch(&bar->head.name, names->items, names->count, sizeof *names->items, compare_names)) return BRECCIA_OK;
  return node_error(parts->reader->document, bar->head.node, parts->reader->error,
                    "bars: '%s' is also the name of a line of a bar with 'repeat'; call it otherwise", bar->head.name);
}

int bars_check(const void *spec, const ForcesParts *parts)
{
  const SectionList *list = spec;
  BarLines lines;
  RepeatedNames names;
  int status = BRECCIA_OK;
  if (!bar_lines_create(&lines, list)) return error_add(parts->reader->error, BRECCIA_FAILURE, "out of memory: bars");
  if (!repeated_names_create(&names, &lines)) {
    bar_lines_destroy(&lines);
    return error_add(parts->reader->error, BRECCIA_FAILURE, "out of memory: bars");
  }
  for (int n = 0; n < list->count; ++n) {
    const BarSpec *bar = list->items[n];
    const Material *m = bar_material(bar, parts);
    int bad = check_name(&names, bar, parts);
    if (!bad) bad = check_lines(&lines, n, parts);
    if (m && m->remote && !bad) bad = check_served(bar, m, parts);
    if (m && m->law->components != 1 && !material_is_hookean(m))
      bad = node_error(parts->reader->document, section_node(bar, "material"), parts->reader->error,
                       "material: '%s' is '%s', a law of strain in space; bars take laws of one strain, like "
                       "'steel-bilinear', and 'elastic'",
                       bar->material, m->law_name);
    if (bad) status = bad;
  }
  free(names.items);
  bar_lines_destroy(&lines);
  return status;
}
