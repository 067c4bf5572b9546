#include "loading/tie.h"

#include "body/nearer.h"
#include "loading/load.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct TieSpec {
  SectionHead head;
  Reference to;
  int directions; /* index of its word */
} TieSpec;

static const char *const tie_directions[] = {"xyz", "x", "y", "z", "xy", "yz", "xz", NULL};

static const Field tie_fields[] = {
    {.key = "to",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(TieSpec, to),
     .standard = "",
     .meaning = "each particle moves as that one of these which was nearest to it at the start; when absent all "
                "particles of the load move as one, without turning",
     .section = &selection_section},
    {.key = "directions",
     .kind = FIELD_CHOICE,
     .offset = offsetof(TieSpec, directions),
     .standard = "xyz",
     .meaning = "in which the motions are one; in the others they stay apart",
     .words = tie_directions},
};

const Section tie_load_section = {.name = "tie",
                                  .about = "Particles that have the same motion from when the load begins, and share "
                                           "their forces and masses: momentum and energy stay.",
                                  .size = sizeof(TieSpec),
                                  FIELDS(tie_fields)};

static int32_t nearest(const Particles *p, int32_t place, const Selection *to)
{
  double least = INFINITY;
  int32_t found = -1;
  for (int64_t n = 0; n < to->count; ++n) {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += pow(p->position[k][to->places[n]] - p->position[k][place], 2);
    if (is_nearer(square, least)) {
      least = square;
      found = to->places[n];
    }
  }
  return found;
}

double tie_reach(const Load *load, const Particles *p)
{
  const Tie *tie = load->own;
  double most = 0;
  for (int64_t n = 0; n < load->selection.count; ++n)
    most = fmax(most, particles_distance(p, load->selection.places[n], tie->masters[n]));
  return most;
}

static int create(Load *load, const LoadMaking *making)
{
  const TieSpec *spec = load->value->section;
  const Particles *p = &making->body->particles;
  const DeckReader *reader = making->reader;
  Tie *tie = load->own = memory_zeroed(1, sizeof *tie, "tie", reader->error);
  if (!tie) return BRECCIA_FAILURE;
  bool any = false;
  for (int k = 0; k < 3; ++k) {
    tie->along[k] = strchr(tie_directions[spec->directions], "xyz"[k]) && k < making->body->dimensions;
    any |= tie->along[k];
  }
  if (!any)
    return node_error(reader->document, section_node(spec, "directions"), reader->error,
                      "directions: '%s' leads out of the body, which is %s", tie_directions[spec->directions],
                      making->body->dimensions == 2 ? "plane" : "a bar along x");
  tie->masters = memory_zeroed((size_t)load->selection.count, sizeof *tie->masters, "tie", reader->error);
  if (!tie->masters) return BRECCIA_FAILURE;
  if (spec->to.node) {
    const int status = selection_create(&load->other, making->body, reader, making->selections, &spec->to);
    if (status) return status;
  }
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t place = load->selection.places[n];
    tie->masters[n] = spec->to.node ? nearest(p, place, &load->other) : load->selection.places[0];
    if (spec->to.node && tie->masters[n] == place)
      return node_error(reader->document, load->node, reader->error,
                        "tie: particle %d at [%g, %g, %g] is among 'on' and among 'to'", p->number[place],
                        p->position[0][place], p->position[1][place], p->position[2][place]);
  }
  return BRECCIA_OK;
}

static void destroy(Load *load)
{
  Tie *tie = load->own;
  free(tie->masters);
  free(tie);
}

static double magnitude(const LoadValue *value)
{
  (void)value;
  return 0;
}

static LoadWords tell(const Load *load, const Particles *p)
{
  return (LoadWords){
      .words = "particles tied over at most", .value = tie_reach(load, p), .dimension = "length", .unit = "m"};
}

const LoadType tie_load = {
    .timeless = true, .create = create, .destroy = destroy, .tell = tell, .magnitude = magnitude};
