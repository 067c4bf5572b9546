/* A face that is held where it is, and not in the middle of held layers: particles stand outside it as mirror images of those inside, and move
 * as these do, mirrored: the other way in the directions that are held, u = 2 g(t) - u of the particle inside, and the same way in the others. Between
 * two images the displacement is g(t) at the face; and families there find the strain going on beyond it.
 * Where the body is periodic along an axis, the layers outside both its faces are those inside the other one, and move as these do: forces inside are then
 * those of a body that goes on for ever, as every family within two horizons of a face is whole. */
#include "loading/support.h"
#include "base/memory.h"

#include "loading/load/load_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HELD_IN_ALL, HELD_ACROSS, HELD_PERIODIC };

typedef struct SupportSpec {
  SectionHead head;
  int held; /* index of its word */
  double displacement[3];
  int64_t layers;
} SupportSpec;

static const Field support_fields[] = {
    {.key = "held",
     .kind = FIELD_CHOICE,
     .offset = offsetof(SupportSpec, held),
     .meaning =
         "all: the face does not move; across: it slides along itself without friction, as in a plane of "
         "symmetry; periodic: it is not held, but the body goes on beyond it and the face opposite as it is, again "
         "and again: what leaves by one comes in by the other, of which nothing is said",
     .words =
         (const char *const[]){[HELD_IN_ALL] = "all", [HELD_ACROSS] = "across", [HELD_PERIODIC] = "periodic", NULL}},
    {.key = "displacement",
     .kind = FIELD_POINT,
     .offset = offsetof(SupportSpec, displacement),
     .dimension = "length",
     .standard = "",
     .meaning = "of the face, times the history, in the directions that are held; 0 when absent"},
    {.key = "layers",
     .kind = FIELD_COUNT,
     .offset = offsetof(SupportSpec, layers),
     .standard = "",
     .range = "[1, 1000]",
     .meaning = "how many stand outside; when absent two horizons, so that those next to the face have whole families "
                "of particles with whole families"},
};

const Section support_load_section = {.name = "support",
                                      .about =
                                          "Layers outside a face of a block on a square or cubic lattice, as mirror "
                                          "images of those inside, so that stresses are right up to the face.",
                                      .size = sizeof(SupportSpec),
                                      FIELDS(support_fields)};

typedef struct Support {
  int32_t *images; /* [particles of the load] places inside */
} Support;

/** The face of which `on` speaks, and nothing else. */
static const SelectionSpec *face_of(const LoadSpec *spec, const SectionList *selections)
{
  const SelectionSpec *on = selection_spec(selections, &spec->on);
  const bool whole = on && on->face >= 0 && !on->group && !on->inside && isnan(on->nearest[0]) && !on->any_of.count &&
                     !on->all_of.count && !on->except.count && !on->outside;
  return whole ? on : NULL;
}

static int find_block(const SelectionSpec *on, const SectionList *blocks)
{
  for (int b = 0; b < blocks->count; ++b)
    if (on->block ? !strcmp(((const SectionHead *)blocks->items[b])->name, on->block) : blocks->count == 1) return b;
  return -1;
}

static bool is_periodic(const SupportSpec *spec)
{
  return spec->held == HELD_PERIODIC;
}

/** One layer outside a face after the other. */
static int add_one(MarginList *list, const Margin *margin, const Node *node, const DeckReader *reader)
{
  for (int m = 0; m < list->count; ++m)
    if (list->items[m].block == margin->block && list->items[m].axis == margin->axis &&
        list->items[m].high == margin->high)
      return node_error(reader->document, node, reader->error, "support: this face has one already, of line %d",
                        ((const LoadSpec *)list->items[m].owner)->head.node->line);
  Margin *grown = memory_grown(list->items, (size_t)(list->count + 1), sizeof *grown);
  if (!grown) return error_add(reader->error, BRECCIA_FAILURE, "out of memory: supports");
  list->items = grown;
  list->items[list->count++] = *margin;
  return BRECCIA_OK;
}

static int add_margin(MarginList *list, const LoadSpec *spec, const SectionList *selections, const SectionList *blocks,
                      const Length *horizon, const DeckReader *reader)
{
  const SupportSpec *support = spec->of[LOAD_support].section;
  const SelectionSpec *on = face_of(spec, selections);
  const Node *node = support->head.node;
  const int b = on ? find_block(on, blocks) : -1;
  if (b < 0)
    return node_error(reader->document, node, reader->error,
                      "support: takes the whole face of a block: 'on' must be like {%sface: x-}",
                      blocks->count > 1 ? "block: NAME, " : "");
  const BlockSpec *block = blocks->items[b];
  if (block->file || !lattice_is_grid(lattice_at(block->lattice)))
    return node_error(
        reader->document, node, reader->error,
        "support: the lattice of block '%s' is not its own mirror image; take 'square' or 'cubic', or hold "
        "layers by 'displacement'",
        block->head.name);
  const int axis = selection_axis(on);
  const double reach = horizon->in_spacings ? horizon->value : horizon->value / block->spacing;
  const bool periodic = is_periodic(support);
  Margin margin = {.owner = spec,
                   .block = b,
                   .axis = axis,
                   .high = selection_side(on) > 0,
                   .layers = support->layers > 0 ? support->layers : 2 * (int64_t)fmin(floor(reach + 1e-6), 500),
                   .repeats = periodic};
  const int status = add_one(list, &margin, node, reader);
  if (status || !periodic) return status;
  margin.high = !margin.high;
  return add_one(list, &margin, node, reader);
}

int support_margins(MarginList *list, const SectionList *loads, const SectionList *selections,
                    const SectionList *blocks, const Length *horizon, const DeckReader *reader)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < loads->count; ++k) {
    const LoadSpec *spec = loads->items[k];
    if (!spec->of[LOAD_support].section) continue;
    const int bad = add_margin(list, spec, selections, blocks, horizon, reader);
    if (bad) status = bad;
  }
  return status;
}

bool support_slides(const Margin *margin)
{
  const SupportSpec *support = ((const LoadSpec *)margin->owner)->of[LOAD_support].section;
  return support->held == HELD_ACROSS;
}

/** Whether a particle stands in a margin that this support asked for. */
static bool is_own(const Body *body, int64_t n, const LoadSpec *spec)
{
  return body_outside(body, n) && body->margins.items[body->margin_of[n]].owner == spec;
}

/** The particles outside, and those that they follow. */
static int list_images(Load *load, const LoadMaking *making)
{
  const Body *body = making->body;
  Error *error = making->reader->error;
  Support *support = load->own;
  int64_t count = 0;
  for (int64_t n = 0; n < body->particles.count; ++n) count += is_own(body, n, load->spec);
  selection_destroy(&load->selection);
  load->selection.places = memory_zeroed((size_t)count, sizeof(int32_t), "supports", error);
  support->images = memory_zeroed((size_t)count, sizeof(int32_t), "supports", error);
  if (!load->selection.places || !support->images) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < body->particles.count; ++n) {
    if (!is_own(body, n, load->spec)) continue;
    support->images[load->selection.count] = body->particles.place_of[body->image_of[n]];
    load->selection.places[load->selection.count++] = body->particles.place_of[n];
  }
  return BRECCIA_OK;
}

/** Lets the images follow in the motion that was prescribed last. */
static int follow_images(Load *load, const LoadMaking *making, double share)
{
  Constraint *constraint = &making->loading->constraints[making->loading->constraint_count - 1];
  constraint->images = ((Support *)load->own)->images;
  constraint->share = share;
  constraint->moved = memory_zeroed((size_t)load->selection.count, sizeof(double), "supports", making->reader->error);
  return constraint->moved ? BRECCIA_OK : BRECCIA_FAILURE;
}

/** A mirror turns rotations about axes along it the other way, and not those about the axis across. */
static int turn_images(Load *load, const LoadMaking *making, int axis)
{
  const bool periodic = is_periodic(load->value->section);
  int of[3];
  const int count = load_turning(&making->body->particles, of);
  for (int k = 0; k < count; ++k) {
    load_constrain_rotation(load, making, k, 0, 0);
    if (follow_images(load, making, periodic || of[k] == axis ? 1 : -1)) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

static int create(Load *load, const LoadMaking *making)
{
  const SupportSpec *spec = load->value->section;
  const Body *body = making->body;
  Error *error = making->reader->error;
  int margin = 0;
  while (margin < body->margins.count && body->margins.items[margin].owner != load->spec) ++margin;
  if (margin == body->margins.count) return BRECCIA_USER_ERROR; /* said when the margins were found */
  const int axis = body->margins.items[margin].axis;
  if (particles_have_rotations(&body->particles) && spec->held == HELD_IN_ALL)
    return node_error(
        making->reader->document, load->node, error,
        "support: held in all directions its images are no mirror images, and what they do to particles that have "
        "rotations, as in this body, would be missing in the energies; hold layers by 'displacement' and 'rotation', "
        "or take 'across' or 'periodic'");
  if (!(load->own = memory_zeroed(1, sizeof(Support), "supports", error))) return BRECCIA_FAILURE;
  const int status = list_images(load, making);
  if (status) return status;
  if (!load->selection.count)
    return node_error(
        making->reader->document, load->node, error,
        "support: block '%s' has no particles at its face %c%c, where the box around its shape ends; let the "
        "first shape of a 'difference' end at the face",
        body->blocks[body->margins.items[margin].block]->head.name, "xyz"[axis],
        body -> margins.items[margin].high ? '+' : '-');
  for (int k = 0; k < body->dimensions; ++k) {
    const bool periodic = is_periodic(spec), held = !periodic && (spec->held == HELD_IN_ALL || k == axis);
    const double moved = isnan(spec->displacement[k]) ? 0 : spec->displacement[k];
    double direction[3] = {0};
    direction[k] = 1;
    if (!held && moved != 0)
      return node_error(making->reader->document, load->node, making->reader->error,
                        periodic ? "support: faces of a periodic body are not held; leave 'displacement' out"
                                 : "support: a face that is held across slides along itself; its displacement along "
                                   "%c must be 0",
                        "xyz"[k]);
    load_constrain(load, making, direction, 2 * moved, 0);
    if (follow_images(load, making, held ? -1 : 1)) return BRECCIA_FAILURE;
  }
  return particles_have_rotations(&body->particles) ? turn_images(load, making, axis) : BRECCIA_OK;
}

static void destroy(Load *load)
{
  free(((Support *)load->own)->images);
  free(load->own);
}

static const double *vector(const LoadValue *value)
{
  return ((const SupportSpec *)value->section)->displacement;
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  (void)value;
  *dimension = "length";
  return "support";
}

static double magnitude(const LoadValue *value)
{
  const double *u = vector(value);
  return isnan(u[0]) ? 0 : sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
}

const LoadType support_load = {
    .lasting = true, .create = create, .destroy = destroy, .vector = vector, .kind = kind, .magnitude = magnitude};
