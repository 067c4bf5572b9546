/* Warnings of thin layers: layers of materials that yield, soften or break, between blocks of unlimited materials
 * (material_is_unlimited) whose bonds do not break.
 *
 * Bonds of the blocks on both sides that reach across all gaps between the rows of a layer carry on when the layer has
 * failed, so that the force on the layer grows without a limit.
 * The thickness of a layer is measured along the normal of the interface, from the particles of one block to the next
 * unlimited block. The number of rows that a layer needs was measured (docs/choosing.md, "Layers of little
 * strength"). */
#include "model/plausibility_parts.h"

#include "base/memory.h"
#include "model/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { THIN_STEPS = 10 }; /* number of steps per spacing along the normal */

/** Horizon in whole spacings up to which a layer of hybrid bonds needs no additional row behind the peak. */
static const int thin_few_rows = 2;

/** A thin layer: index of its block, indices of the blocks on both sides, number of rows that it has and that it
 *  needs. */
typedef struct ThinLayer {
  int block, ends[2];
  int rows, wanted;
} ThinLayer;

/** Returns true if neither the law of a material nor a failure criterion limits its stress. */
static bool thin_is_unlimited(const Domain *d, int32_t material)
{
  return material_is_unlimited(&d->materials[material]) &&
         !(d->failure.criterion && isfinite(d->failure.limit[material]));
}

/** Returns the spacing of the block of a particle [length]. */
static double thin_spacing(const Domain *d, int32_t place)
{
  return d->body.lattices[d->particles->block[place / SLICE]].spacing;
}

/** Returns the number of rows that a layer needs between unlimited blocks (table of docs/choosing.md).
 *  @param[in] place, other  local indices of a particle of the unlimited block and of one of the layer */
static int thin_wanted(const Domain *d, int32_t place, int32_t other)
{
  const Region *region = domain_region(d, place);
  const Material *own = &d->materials[d->material[place / SLICE]], *layer = &d->materials[d->material[other / SLICE]];
  const int reach = (int)floor(d->family.horizon / thin_spacing(d, other) * (1 + 1e-9));
  const bool one_region = domain_region(d, other) == region, links = region->type->bond_damage != NULL;
  if (one_region && links) return reach; /* damage by the law of either end acts on the whole link */
  const bool on_particles = !region->type->on_bonds && !links;
  if (on_particles && !(layer->softening_energy > 0)) return 4 * reach; /* the whole layer yields */
  if (!one_region || !region->type->on_bonds || !(material_share_of_bond(layer, own) > 0.5)) return 2 * reach;
  return region->type->laminates && reach > thin_few_rows ? reach + 1 : reach;
}

/** Returns the square of the distance of a particle from a point [length^2]. */
static double thin_square(const Domain *d, int32_t place, const double point[3])
{
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double apart = d->particles->position[k][place] - point[k];
    sum += apart * apart;
  }
  return sum;
}

/** Returns the index of the block of the particle nearest to a point, if that block was read from a file.
 *  @param[in,out] near  local index of a particle within about a spacing of the point; the nearest particle, found by
 *                       descent through families
 *  @return -1: another block, or no particle within a spacing */
static int thin_block_of_particles(const Domain *d, const double point[3], int32_t *near)
{
  const Family *f = &d->family;
  for (int32_t from = -1; from != *near;) {
    from = *near;
    const int64_t slice = from / SLICE;
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      if (!(f->intact[slot] >> from % SLICE & 1)) continue;
      const int32_t other = family_bond(f, slice, slot, from % SLICE).neighbour;
      if (!body_outside(&d->body, d->particles->number[other]) &&
          thin_square(d, other, point) < thin_square(d, *near, point))
        *near = other;
    }
  }
  const double spacing = thin_spacing(d, *near);
  const int block = d->particles->block[*near / SLICE];
  return !d->body.blocks[block]->shape && thin_square(d, *near, point) < spacing * spacing ? block : -1;
}

/** Returns the index of the block that contains a point; -1: none.
 *  @param[in,out] near  local index of a particle near the point, as in thin_block_of_particles */
static int thin_block(const Domain *d, const double point[3], int32_t *near)
{
  const Body *body = &d->body;
  bool of_particles = false;
  for (int k = 0; k < body->block_count; ++k) {
    const Shape *shape = body->blocks[k]->shape;
    if (shape && shape_contains(shape, &body->lattices[k].unit, body->dimensions, point, 0)) return k;
    of_particles |= !shape;
  }
  return of_particles ? thin_block_of_particles(d, point, near) : -1;
}

/** Returns the index of the material of each block, -1 for a block without particles; NULL: out of memory. */
static int32_t *thin_materials(const Domain *d)
{
  int32_t *material = memory_plain((size_t)d->body.block_count, sizeof *material);
  for (int k = 0; material && k < d->body.block_count; ++k) material[k] = -1;
  for (int64_t s = 0; material && s < d->particles->slices; ++s) material[d->particles->block[s]] = d->material[s];
  return material;
}

/** Computes the mean direction from a particle to its nearest neighbours of limited materials.
 *  @param[out] normal  unit vector; zero if there are no such neighbours
 *  @return local index of one of these neighbours; -1: none, or their directions cancel */
static int32_t thin_normal(const Domain *d, int32_t place, double normal[3])
{
  const double near = 1.5; /* [spacings] */
  const Family *f = &d->family;
  const int64_t slice = place / SLICE;
  int32_t found = -1;
  for (int k = 0; k < 3; ++k) normal[k] = 0;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, place % SLICE);
    if (bond.length > near * d->body.lattices[d->particles->block[slice]].spacing ||
        body_outside(&d->body, d->particles->number[bond.neighbour]) ||
        thin_is_unlimited(d, d->material[bond.neighbour / SLICE]))
      continue;
    found = bond.neighbour;
    for (int k = 0; k < 3; ++k) normal[k] += bond.xi[k] / bond.length;
  }
  const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  for (int k = 0; k < 3 && length > 0; ++k) normal[k] /= length;
  return length > 0.5 ? found : -1;
}

/** Returns true if a block goes on beyond its face across a normal as its image, or as the body once more. */
static bool thin_goes_on(const Body *body, int block, const double normal[3])
{
  const double along = 0.9; /* least component of the normal along the axis of the face */
  for (int k = 0; k < body->margins.count; ++k) {
    const Margin *margin = &body->margins.items[k];
    if (margin->block == block && (margin->high ? 1 : -1) * normal[margin->axis] > along) return true;
  }
  return false;
}

/** Searches along a normal, from a particle through the layer beside it, for the unlimited block beyond the layer.
 *  @param[in] spacing  spacing of the layer [length]
 *  @param[in,out] layer  `wanted` is given; sets the block of the layer, the block beyond and the number of rows
 *  @return false if the search ends within the layer or at a free face */
static bool thin_cross(const Domain *d, const int32_t *material, int32_t place, const double normal[3], double spacing,
                       ThinLayer *layer)
{
  const Particles *p = d->particles;
  const double step = spacing / THIN_STEPS, before = 2 * d->body.largest_spacing;
  int inside = 0;
  int32_t near = place;
  for (int n = 0; (n - layer->wanted * THIN_STEPS) * step < before; ++n) {
    double point[3];
    for (int k = 0; k < 3; ++k) point[k] = p->position[k][place] + n * step * normal[k];
    const int block = thin_block(d, point, &near);
    if (block < 0 && inside && thin_goes_on(&d->body, layer->block, normal)) { /* its image, and that of the place */
      layer->ends[1] = layer->ends[0];
      layer->rows = (2 * inside + THIN_STEPS / 2) / THIN_STEPS;
      return true;
    }
    if (block < 0 || material[block] < 0) return false;
    const bool limited = !thin_is_unlimited(d, material[block]);
    if (limited && !inside++) layer->block = block;
    if (limited || !inside) continue;
    layer->ends[1] = block;
    layer->rows = (inside + THIN_STEPS / 2) / THIN_STEPS;
    return true;
  }
  return false;
}

/** Measures the layer beside a particle of an unlimited block.
 *  @param[in,out] thin  [blocks] thinnest layer of each block; 0 rows: none */
static void thin_look(const Domain *d, const int32_t *material, int32_t place, ThinLayer *thin)
{
  double normal[3];
  ThinLayer layer = {.ends = {d->particles->block[place / SLICE], 0}};
  const int32_t other = thin_normal(d, place, normal);
  if (other < 0) return;
  layer.wanted = thin_wanted(d, place, other);
  if (!thin_cross(d, material, place, normal, thin_spacing(d, other), &layer) || layer.rows >= layer.wanted) return;
  ThinLayer *known = &thin[layer.block];
  if (!known->rows || layer.rows < known->rows) *known = layer;
}

/** Finds the thin layers of a body.
 *  @return [blocks] layers, owned by the caller; 0 rows: the block is none; NULL: out of memory */
static ThinLayer *thin_find(const Domain *d)
{
  const Particles *p = d->particles;
  const Family *f = &d->family;
  ThinLayer *thin = memory_zeroed((size_t)d->body.block_count, sizeof *thin, "layers", NULL);
  int32_t *material = thin_materials(d);
  for (int64_t s = 0; thin && material && s < p->slices; ++s) {
    if (f->stored[s] == f->first[s + 1] || !thin_is_unlimited(d, d->material[s])) continue;
    for (int lane = 0; lane < SLICE; ++lane) {
      const int32_t place = (int32_t)(s * SLICE + lane);
      if (p->number[place] >= 0 && !body_outside(&d->body, p->number[place])) thin_look(d, material, place, thin);
    }
  }
  free(material);
  return thin;
}

/** Warns of a thin layer, and stores the warning for the last words of the run. */
static void thin_say(breccia_model *model, const ThinLayer *thin)
{
  const Body *body = &model->domain.body;
  const char *name = body->blocks[thin->block]->head.name;
  Text ends = {0};
  if (thin->ends[0] == thin->ends[1])
    text_add(&ends, "both sides of '%s'", body->blocks[thin->ends[0]]->head.name);
  else
    text_add(&ends, "blocks '%s' and '%s'", body->blocks[thin->ends[0]]->head.name,
             body->blocks[thin->ends[1]]->head.name);
  plausibility_say(
      model, body->blocks[thin->block]->head.node,
      "block '%s' is a layer of %d row%s between %s, which cannot fail, and %d rows are wanted: bonds of "
      "these blocks reach across it and carry on when it has failed, so that the layer carries more "
      "than its strength, without a limit; give it %d rows or more, or a shorter horizon (docs/choosing.md, "
      "layers of little strength)",
      name, thin->rows, thin->rows == 1 ? "" : "s", text_words(&ends), thin->wanted, thin->wanted);
  text_add(&model->thin_layers,
           "warning: layer '%s' has %d row%s, and %d are wanted: its strength is OVERESTIMATED, and the more so the "
           "larger its strain, because bonds between the blocks on both sides of it do not fail\n",
           name, thin->rows, thin->rows == 1 ? "" : "s", thin->wanted);
  text_free(&ends);
}

void plausibility_warn_of_thin_layers(breccia_model *model)
{
  const Domain *d = &model->domain;
  bool limited = false, unlimited = false;
  for (int k = 0; k < d->material_count; ++k) {
    const bool is = thin_is_unlimited(d, k);
    unlimited |= is;
    limited |= !is;
  }
  if (d->body.block_count < 2 || !limited || !unlimited) return;
  ThinLayer *thin = thin_find(d);
  for (int k = 0; thin && k < d->body.block_count; ++k)
    if (thin[k].rows) thin_say(model, &thin[k]);
  free(thin);
}

void run_tell_thin_layers(const breccia_model *model, Text *t)
{
  text_add(t, "%s", text_words(&model->thin_layers));
}
