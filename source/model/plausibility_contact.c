/* Blocks that overlap or that a gap parts, and contact: what a deck says of them, and what comes of it. */
#include "base/memory.h"
#include "model/plausibility_parts.h"

#include "contact/contact.h"
#include "family/cells.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shares of a spacing: blocks are apart, and not only met at particles that stand askew, beyond the first; they overlap where particles of
 * one stand deeper than the second inside the other. */
static const double gap_share = 0.75, overlap_share = 0.25;
static const double most_friction = 2, most_stiffness = 2;
static const double most_step = 0.55; /* of the stable one, for contact stiffer than that */

static const ContactSpec *contact_of(const breccia_model *model)
{
  return model->spec->forces[FORCES_contact];
}

static void place_point(const Particles *p, int32_t place, double point[3])
{
  for (int k = 0; k < 3; ++k) point[k] = p->position[k][place];
}

static bool fills_lattice(const Body *body, int block)
{
  return body->blocks[block]->shape != NULL;
}

static double mean_spacing(const Body *body, int one, int two)
{
  return (body->lattices[one].spacing + body->lattices[two].spacing) / 2;
}

static void length_words(const breccia_model *model, double length, Text *words)
{
  quantity_describe(plausibility_in_si(model, "length", length), "m", words);
}

/* ---- blocks ---- */

/** Whether the middle of a bond stands in another block than those of its ends: it does not reach across a gap then. */
static bool is_filled(const Body *body, int32_t place, const Bond *bond, int own, int other)
{
  double middle[3];
  place_point(&body->particles, place, middle);
  for (int k = 0; k < 3; ++k) middle[k] += bond->xi[k] / 2;
  for (int k = 0; k < body->block_count; ++k)
    if (k != own && k != other && fills_lattice(body, k) &&
        shape_contains(body->blocks[k]->shape, &body->lattices[k].unit, body->dimensions, middle, 0))
      return true;
  return false;
}

/** Least length of the bonds that join each two blocks, but through others; INFINITY where none does.
 *  @param[out] least  [blocks][blocks], of the lower block first */
static void find_joints(const Domain *d, double *least)
{
  const Particles *p = d->particles;
  const Family *f = &d->family;
  const int blocks = d->body.block_count;
  for (int k = 0; k < blocks * blocks; ++k) least[k] = INFINITY;
  for (int64_t slice = 0; slice < p->slices; ++slice)
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        const Bond bond = family_bond(f, slice, slot, lane);
        const int own = p->block[slice], other = p->block[bond.neighbour / SLICE];
        if (own < other && bond.length < least[own * blocks + other] &&
            !is_filled(&d->body, (int32_t)(slice * SLICE + lane), &bond, own, other))
          least[own * blocks + other] = bond.length;
      }
}

/** How many particles of one block stand inside another's shape. */
static int64_t count_inside(const Body *body, int one, int other)
{
  const Particles *p = &body->particles;
  const Lattice *lattice = &body->lattices[other];
  const double depth = overlap_share * fmin(body->lattices[one].spacing, lattice->spacing);
  int64_t inside = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t place = p->place_of[n];
    double point[3];
    if (p->block[place / SLICE] != one || body_outside(body, n)) continue;
    place_point(p, place, point);
    inside += shape_contains(body->blocks[other]->shape, &lattice->unit, body->dimensions, point, -depth);
  }
  return inside;
}

static void check_blocks(breccia_model *model, int one, int two, double nearest)
{
  const Domain *d = &model->domain;
  const Body *body = &d->body;
  const char *first = body->blocks[one]->head.name, *second = body->blocks[two]->head.name;
  const double mean = mean_spacing(body, one, two);
  const int64_t in_second = count_inside(body, one, two), in_first = count_inside(body, two, one);
  if (in_second + in_first > 0) {
    plausibility_say(model, body->blocks[two]->head.node,
                     "blocks '%s' and '%s' overlap: %lld particles of the first stand inside the second, %lld of the "
                     "second inside the first, and their masses count twice; take the shape of one out of the other "
                     "with 'difference'",
                     first, second, (long long)in_second, (long long)in_first);
    return;
  }
  if (!(isfinite(nearest) && nearest - mean > gap_share * mean)) return;
  Text gap = {0}, horizon = {0};
  length_words(model, nearest - mean, &gap);
  length_words(model, d->family.horizon, &horizon);
  plausibility_say(model, body->blocks[two]->head.node,
                   "blocks '%s' and '%s' are %s apart, within the horizon of %s: bonded across the gap; to part them, "
                   "add to the cracks '{remove: {box: ...}, cut faces: yes}' with the box in the gap",
                   first, second, text_words(&gap), text_words(&horizon));
  text_free(&gap);
  text_free(&horizon);
}

void plausibility_warn_of_blocks(breccia_model *model)
{
  const Body *body = &model->domain.body;
  const int blocks = body->block_count;
  double *least = blocks > 1 ? memory_plain((size_t)blocks * (size_t)blocks, sizeof *least) : NULL;
  if (!least) return;
  find_joints(&model->domain, least);
  for (int one = 0; one < blocks; ++one)
    for (int two = one + 1; two < blocks; ++two)
      if (fills_lattice(body, one) && fills_lattice(body, two))
        check_blocks(model, one, two, least[one * blocks + two]);
  free(least);
}

/* ---- cuts in a gap ---- */

/** Whether a point stands nearer than `reach` to the box around a cut's corners; lines run through the whole height. */
static bool near_cut(const CutSpec *cut, const double point[3], double reach)
{
  const NumberList *corners = cut->polygon.count ? &cut->polygon : &cut->line;
  for (int k = 0; k < (cut->polygon.count ? 3 : 2); ++k) {
    double low = INFINITY, high = -INFINITY;
    for (int n = 0; n < corners->count; ++n) {
      low = fmin(low, corners->values[3 * n + k]);
      high = fmax(high, corners->values[3 * n + k]);
    }
    if (point[k] < low - reach || point[k] > high + reach) return false;
  }
  return true;
}

/** The gap between the faces of the nearest particles that a cut parts, looked for until one is that is none.
 *  @return in spacings; INFINITY if the cut parts none
 *  @param[out] gap  the same as a length */
static double gap_of_cut(const Domain *d, const Cells *cells, int crack, double *gap)
{
  const Particles *p = d->particles;
  const double horizon = d->family.horizon;
  uint8_t met = 0;
  Body alone = d->body; /* with this cut only, to know which one parts two particles */
  alone.cracks += crack;
  alone.crack_count = 1;
  alone.crack_met = &met;
  double least = INFINITY;
  for (int64_t n = 0; n < p->count && least > gap_share; ++n) {
    const int32_t place = p->place_of[n];
    const int block = p->block[place / SLICE];
    double a[3], normal[3], level;
    place_point(p, place, a);
    if (!fills_lattice(&d->body, block) || !near_cut(alone.cracks[0]->cut, a, horizon)) continue;
    int64_t rows[9][2];
    const int count = cells_around(cells, a, rows);
    for (int r = 0; r < count; ++r)
      for (int64_t k = rows[r][0]; k < rows[r][1]; ++k) {
        const int32_t other = cells->places[k];
        const int theirs = p->block[other / SLICE];
        const double distance = particles_distance(p, place, other), mean = mean_spacing(&d->body, block, theirs);
        if (other == place || !fills_lattice(&d->body, theirs) || distance > horizon ||
            (distance - mean) / mean >= least || family_joins(&d->family, place, other))
          continue;
        if (!body_cuts_bond(&alone, place, other) || !body_closed_bond(&d->body, place, other, normal, &level))
          continue;
        least = (distance - mean) / mean;
        *gap = distance - mean;
      }
  }
  return least;
}

/** A cut without thickness is taken as closed, so that what it parts presses from the first step, however far apart it is. */
static void check_cuts(breccia_model *model)
{
  const Domain *d = &model->domain;
  Cells cells = {.width = 0};
  bool any = false;
  for (int c = 0; c < d->body.crack_count; ++c) any |= d->body.cracks[c]->cut && d->body.crack_met[c];
  if (!any ||
      cells_create(&cells, d->particles, (const double *const *)d->particles->position, d->family.horizon, NULL))
    return;
  for (int c = 0; c < d->body.crack_count; ++c) {
    double gap = 0;
    if (!d->body.cracks[c]->cut || !d->body.crack_met[c]) continue;
    const double spacings = gap_of_cut(d, &cells, c, &gap);
    if (!(isfinite(spacings) && spacings > gap_share)) continue;
    Text words = {0};
    length_words(model, gap, &words);
    plausibility_say(model, d->body.cracks[c]->head.node,
                     "crack: the cut lies in a gap of %s, and contact takes cuts as closed: it carries pressure from "
                     "the first step; take '{remove: {box: ...}, cut faces: yes}' with the box in the gap, or leave it "
                     "out and place the blocks more than a horizon apart",
                     text_words(&words));
    text_free(&words);
  }
  cells_destroy(&cells);
}

void plausibility_warn_of_contact(breccia_model *model)
{
  const ContactSpec *contact = contact_of(model);
  if (!contact) return;
  if (contact->friction > most_friction)
    plausibility_say(model, section_node(contact, "friction"),
                     "friction: %g is more than faces of anything have; it is a number, not per cent: 0.6 between "
                     "smooth faces of concrete",
                     contact->friction);
  const Clock *clock = &model->solver.clock;
  if (contact->stiffness > most_stiffness && clock->time_step > most_step * clock->stable)
    plausibility_say(model, section_node(contact, "stiffness"),
                     "stiffness: faces %g times as stiff as the body meet within a step or two: in impacts the energy "
                     "was up to 5 %% off at a stiffness of 5, 8 %% at 10, 11 %% at 100, and within 1 %% at half the "
                     "stable step: take 'safety: 0.5'",
                     contact->stiffness);
  check_cuts(model);
}

void plausibility_describe_contact(const breccia_model *model, Text *text)
{
  const ContactSpec *contact = contact_of(model);
  if (!contact) return;
  text_add(text, "contact: %g times as stiff as the body, ", contact->stiffness);
  if (contact->friction > 0)
    text_add(text, "friction %g on faces of cuts and of different bodies", contact->friction);
  else
    text_add(text, "no friction");
  if (model->domain.failure.criterion) text_add(text, "; faces of broken bonds interlock");
  text_add(text, "\n");
}
