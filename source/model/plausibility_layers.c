/* Layers of another stiffness than their neighbours: those that bonds reach across, and what formulations make of an
 * interface. */
#include "model/plausibility_parts.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double least_ratio = 1.5; /* of Young's moduli, or its inverse, that a warning asks for */

static const Material *layers_material(const Domain *d, int32_t place)
{
  return &d->materials[d->material[place / SLICE]];
}

/** Ratio of Young's modulus of a material to that of another one; 1 where one has none. */
static double layers_ratio(const Material *one, const Material *other)
{
  const double a = material_young(one), b = material_young(other);
  return a > 0 && b > 0 ? a / b : 1;
}

/** Of two ratios the one that is farther from 1. */
static double layers_farther(double one, double other)
{
  return fabs(log(one)) < fabs(log(other)) ? other : one;
}

/** A block that bonds bridge. */
typedef struct Bridged {
  bool is;
  int ends[2];  /* blocks of the ends of such a bond */
  double ratio; /* of Young's modulus of the block to that of an end */
} Bridged;

/** Block that the middle of a bond stands in, but for those of its ends; -1: none. */
static int layers_block_between(const Body *body, int32_t place, const Bond *bond, int own, int other)
{
  double middle[3];
  for (int k = 0; k < 3; ++k) middle[k] = body->particles.position[k][place] + bond->xi[k] / 2;
  for (int k = 0; k < body->block_count; ++k)
    if (k != own && k != other && body->blocks[k]->shape &&
        shape_contains(body->blocks[k]->shape, &body->lattices[k].unit, body->dimensions, middle, 0))
      return k;
  return -1;
}

/** Looks at the bonds of a slice beside other blocks. @param[in,out] bridged  [blocks] */
static void layers_look(const Domain *d, int64_t slice, const int32_t *first, Bridged *bridged)
{
  const Particles *p = d->particles;
  const Family *f = &d->family;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const int32_t place = (int32_t)(slice * SLICE + lane);
      const Bond bond = family_bond(f, slice, slot, lane);
      const int own = p->block[slice], other = p->block[bond.neighbour / SLICE];
      if (own > other || bond.length < 1.5 * d->body.lattices[own].spacing) continue;
      const int between = layers_block_between(&d->body, place, &bond, own, other);
      if (between < 0 || bridged[between].is || first[between] < 0) continue;
      const Material *m = layers_material(d, first[between]);
      const double ratio = layers_farther(layers_ratio(m, layers_material(d, place)),
                                          layers_ratio(m, layers_material(d, bond.neighbour)));
      if (fabs(log(ratio)) >= log(least_ratio)) bridged[between] = (Bridged){true, {own, other}, ratio};
    }
}

static void layers_say_bridged(breccia_model *model, int block, const Bridged *of)
{
  const Domain *d = &model->domain;
  const Body *body = &d->body;
  const double spacings = d->family.horizon / body->lattices[block].spacing;
  char ends[200];
  if (of->ends[0] == of->ends[1])
    snprintf(ends, sizeof ends, "'%s' on both sides", body->blocks[of->ends[0]]->head.name);
  else
    snprintf(ends, sizeof ends, "'%s' and '%s'", body->blocks[of->ends[0]]->head.name,
             body->blocks[of->ends[1]]->head.name);
  plausibility_say(model, body->blocks[block]->head.node,
                   "block '%s' is thinner than the horizon, and its Young's modulus is %.3g times another one: bonds "
                   "between %s reach across it and do not know its stiffness; give it %d rows of particles or more "
                   "across, or a shorter horizon (docs/choosing.md, layers)",
                   body->blocks[block]->head.name, of->ratio, ends, (int)floor(spacings * (1 + 1e-9)));
}

/** Warns of layers that bonds bridge. */
static void layers_check_bridged(breccia_model *model)
{
  const Domain *d = &model->domain;
  const int blocks = d->body.block_count;
  Bridged *bridged = memory_plain((size_t)blocks, sizeof *bridged);
  int32_t *first = memory_plain((size_t)blocks, sizeof *first); /* a particle of each block */
  for (int k = 0; bridged && first && k < blocks; ++k) {
    bridged[k] = (Bridged){0};
    first[k] = -1;
  }
  for (int64_t slice = 0; bridged && first && slice < d->particles->slices; ++slice)
    first[d->particles->block[slice]] = (int32_t)(slice * SLICE);
  for (int64_t slice = 0; bridged && first && slice < d->particles->slices; ++slice)
    if (d->family.stored[slice] < d->family.first[slice + 1]) layers_look(d, slice, first, bridged);
  for (int k = 0; bridged && first && k < blocks; ++k)
    if (bridged[k].is) layers_say_bridged(model, k, &bridged[k]);
  free(bridged);
  free(first);
}

void plausibility_warn_of_layers(breccia_model *model)
{
  if (model->domain.body.block_count > 1 && model->domain.material_count > 1) layers_check_bridged(model);
}

/** Two blocks of one region that meet with the farthest ratio of moduli. */
typedef struct Meeting {
  int soft, stiff; /* blocks */
  double ratio;    /* of the stiffer modulus to the softer one */
} Meeting;

static void layers_meet(const Domain *d, const Region *region, int64_t slice, Meeting *farthest)
{
  const Family *f = &d->family;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const int32_t place = (int32_t)(slice * SLICE + lane), other = family_bond(f, slice, slot, lane).neighbour;
      if (domain_region(d, place) != region || domain_region(d, other) != region) continue;
      const Material *one = layers_material(d, place), *there = layers_material(d, other);
      const double ratio = layers_ratio(one, there);
      if (!(ratio > farthest->ratio) || !region->type->shifts_interface(region->formulation, one, there)) continue;
      *farthest = (Meeting){d->particles->block[other / SLICE], d->particles->block[slice], ratio};
    }
}

/** Spacings by which the softer of two layers acts thinner across their interface: a fit to columns of layers at 3.015
 *  spacings, 0.6 to 1.0 at a ratio of 10 and 1.2 to 1.9 at 1000 (docs/choosing.md), in proportion to the horizon. */
static double layers_shift(double ratio, double horizon)
{
  return 2.15 * horizon / 3.015 * (1 - 1 / cbrt(ratio));
}

static void layers_describe(const Domain *d, const Region *region, const Meeting *of, Text *text)
{
  const double horizon = d->family.horizon / d->body.largest_spacing;
  text_add(text,
           "  blocks '%s' and '%s' meet, the first %.3g times softer: in '%s' the first of them acts up to %.2f "
           "spacings thinner across the interface\n",
           d->body.blocks[of->soft]->head.name, d->body.blocks[of->stiff]->head.name, of->ratio, region->type->name,
           layers_shift(of->ratio, horizon));
}

void plausibility_describe_layers(const breccia_model *model, Text *text)
{
  const Domain *d = &model->domain;
  for (int r = 0; r < d->region_count; ++r) {
    Meeting farthest = {.ratio = least_ratio};
    for (int64_t slice = 0; d->regions[r].type->shifts_interface && slice < d->particles->slices; ++slice)
      layers_meet(d, &d->regions[r], slice, &farthest);
    if (farthest.ratio > least_ratio) layers_describe(d, &d->regions[r], &farthest, text);
  }
}
