#include "bars/bars.h"
#include "loading/load.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct PrestressSpec {
  SectionHead head;
  TextList bars;
  double stress, strain;
} PrestressSpec;

static const Field prestress_fields[] = {
    {.key = "bars", .kind = FIELD_TEXTS, .offset = offsetof(PrestressSpec, bars), .meaning = "names of bars"},
    {.key = "stress",
     .kind = FIELD_NUMBER,
     .offset = offsetof(PrestressSpec, stress),
     .dimension = "stress",
     .standard = "",
     .meaning =
         "in the bar while the body around it is not strained yet, by Young's modulus at first; tension positive",
     .group = 'A'},
    {.key = "strain",
     .kind = FIELD_NUMBER,
     .offset = offsetof(PrestressSpec, strain),
     .dimension = "1",
     .standard = "",
     .meaning = "instead: of the bar then",
     .group = 'A'},
};

const Section prestress_load_section = {
    .name = "prestress",
    .about =
        "Tension of bars. A bar that is shorter than its place in the body is strained by so much before the body is; "
        "what is left of it once the body gives way follows from equilibrium.",
    .size = sizeof(PrestressSpec),
    FIELDS(prestress_fields)};

/** What a load keeps: bars of the deck that it acts on, and their strains. */
typedef struct Prestress {
  const Bars *bars;
  int count, *bar;
  double *strain;
} Prestress;

/** Young's modulus of a bar of the deck. */
static double young(const Bars *bars, int deck_bar)
{
  return bar_young(bars, bars->lines.first[deck_bar]);
}

static int create(Load *load, const LoadMaking *making)
{
  const PrestressSpec *spec = load->value->section;
  const DeckReader *reader = making->reader;
  if (load->spec->on.node)
    return node_error(reader->document, section_node(load->spec, "on"), reader->error,
                      "on: a prestress acts on the bars that it names; leave it out");
  if (!spec->bars.count)
    return node_error(reader->document, section_node(spec, "bars"), reader->error,
                      "bars: name those that are under tension, as under 'bars' of the deck");
  for (int n = 0; n < spec->bars.count; ++n)
    for (int k = 0; k < n; ++k)
      if (!strcmp(spec->bars.items[k], spec->bars.items[n]))
        return node_error(reader->document, section_node(spec, "bars"), reader->error,
                          "bars: '%s' stands here twice; leave one out", spec->bars.items[n]);
  Prestress *p = load->own = memory_zeroed(1, sizeof *p, "loads", reader->error);
  if (!p) return BRECCIA_FAILURE;
  p->bars = making->forces ? bars_among(making->forces) : NULL;
  if (bars_were_refused(p->bars, reader)) return BRECCIA_USER_ERROR;
  p->bar = memory_zeroed((size_t)spec->bars.count, sizeof *p->bar, "loads", reader->error);
  p->strain = memory_zeroed((size_t)spec->bars.count, sizeof *p->strain, "loads", reader->error);
  if (!p->bar || !p->strain) return BRECCIA_FAILURE;
  for (int n = 0; n < spec->bars.count; ++n) {
    const int bar = bars_find(p->bars, spec->bars.items[n]);
    if (bar < 0)
      return node_error(reader->document, section_node(spec, "bars"), reader->error,
                        "bars: there is no bar '%s'; expected names of those under 'bars' of the deck",
                        spec->bars.items[n]);
    p->bar[p->count] = bar;
    p->strain[p->count++] = isnan(spec->stress) ? spec->strain : spec->stress / young(p->bars, bar);
  }
  return load_is_known(load, making, "prestress");
}

static void destroy(Load *load)
{
  Prestress *p = load->own;
  free(p->bar);
  free(p->strain);
  free(p);
}

static void strain(const Load *load, const LoadStrains *strains, double factor)
{
  const Prestress *p = load->own;
  const BarLines *lines = &p->bars->lines;
  for (int n = 0; n < p->count; ++n)
    for (int line = lines->first[p->bar[n]]; line < lines->first[p->bar[n] + 1]; ++line)
      strains->of_bars[line] += factor * p->strain[n];
}

static LoadWords tell(const Load *load, const Particles *particles)
{
  const Prestress *p = load->own;
  double force = 0;
  (void)particles;
  for (int n = 0; n < p->count; ++n)
    force += p->strain[n] * young(p->bars, p->bar[n]) * p->bars->bar_area[p->bars->lines.first[p->bar[n]]] *
             deck_bar_lines(p->bars, p->bar[n]);
  return (LoadWords){
      .words = "before the body gives way, a force in all of", .value = force, .dimension = "force", .unit = "N"};
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  const PrestressSpec *spec = value->section;
  *dimension = isnan(spec->stress) ? "1" : "stress";
  return "prestress";
}

static double magnitude(const LoadValue *value)
{
  const PrestressSpec *spec = value->section;
  return isnan(spec->stress) ? spec->strain : spec->stress;
}

const LoadType prestress_load = {.everywhere = true,
                                 .create = create,
                                 .destroy = destroy,
                                 .strain = strain,
                                 .tell = tell,
                                 .kind = kind,
                                 .magnitude = magnitude};
