/* Regions: which formulation has which blocks of the body. */
#include "domain/regions.h"

#include "deck/names.h"

#include <stdlib.h>
#include <string.h>

/** Number of the region of each block, from 0 for what no region names. @return nonzero after a message */
static int name_blocks(const Domain *d, const DeckReader *reader, const PeridynamicsSpec *spec, int *region_of)
{
  int status = BRECCIA_OK;
  for (int r = 0; r < spec->regions.count; ++r) {
    const RegionSpec *region = spec->regions.items[r];
    const Node *list = section_node(region, "blocks");
    if (!region->blocks.count)
      status = node_error(reader->document, list, reader->error, "blocks: region '%s' names none", region->head.name);
    for (int k = 0; k < region->blocks.count; ++k) {
      const Node *node = list->kind == NODE_LIST ? &list->items[k] : list;
      const char *names[64];
      int found = -1, count = 0;
      for (int b = 0; b < d->body.block_count; ++b) {
        if (!strcmp(d->body.blocks[b]->head.name, region->blocks.items[k])) found = b;
        if (count < 64) names[count++] = d->body.blocks[b]->head.name;
      }
      if (found < 0) {
        name_unknown(reader, node, "block", region->blocks.items[k], names, count);
        status = BRECCIA_USER_ERROR;
      } else if (region_of[found])
        status = node_error(reader->document, node, reader->error, "blocks: '%s' is in region '%s' already",
                            region->blocks.items[k],
                            ((const RegionSpec *)spec->regions.items[region_of[found] - 1])->head.name);
      else
        region_of[found] = r + 1;
    }
  }
  return status;
}

static Region region_of_spec(const PeridynamicsSpec *spec, int r)
{
  if (!r) return (Region){.type = formulation_at(spec->formulation), .keys = spec->keys, .node = spec->head.node};
  const RegionSpec *region = spec->regions.items[r - 1];
  return (Region){.name = region->head.name,
                  .type = formulation_at(region->formulation),
                  .keys = region->keys,
                  .node = region->head.node};
}

int regions_create(Domain *d, const DeckReader *reader, const PeridynamicsSpec *spec)
{
  const Particles *p = &d->body.particles;
  int *region_of = memory_zeroed((size_t)d->body.block_count, sizeof *region_of, "regions", reader->error);
  d->regions = memory_zeroed((size_t)spec->regions.count + 1, sizeof *d->regions, "regions", reader->error);
  d->region = memory_zeroed((size_t)p->slices, sizeof *d->region, "regions", reader->error);
  int status = region_of && d->regions && d->region ? name_blocks(d, reader, spec, region_of) : BRECCIA_FAILURE;
  for (int r = 0; r <= spec->regions.count && !status; ++r) {
    Region *region = &d->regions[d->region_count];
    *region = region_of_spec(spec, r);
    for (int64_t s = 0; s < p->slices; ++s) {
      if (region_of[p->block[s]] != r) continue;
      d->region[s] = d->region_count;
      for (int lane = 0; lane < SLICE; ++lane) region->particles += p->number[s * SLICE + lane] >= 0;
    }
    d->region_count += region->particles > 0;
  }
  free(region_of);
  for (int r = 0; r < d->region_count && d->region_count > 1 && !status; ++r) {
    for (int before = 0; before < r; ++before)
      if (d->regions[r].type->gyration && d->regions[before].type->gyration)
        return node_error(reader->document, d->regions[r].node, reader->error,
                          "formulation: two regions of %s, whose particles turn, cannot stand beside each other; give "
                          "their blocks one region",
                          d->regions[r].type->name);
    d->regions[r].foreign = memory_zeroed((size_t)p->slices, 1, "regions", reader->error);
    if (!d->regions[r].foreign) return BRECCIA_FAILURE;
    for (int64_t s = 0; s < p->slices; ++s) d->regions[r].foreign[s] = d->region[s] != r;
  }
  return status;
}

bool region_is_made_of(const Domain *d, const Region *region, const char *material)
{
  const Particles *p = &d->body.particles;
  for (int64_t s = 0; s < p->slices; ++s)
    if (&d->regions[d->region[s]] == region && !strcmp(d->body.blocks[p->block[s]]->material, material)) return true;
  return false;
}

bool region_has_material(const Domain *d, const Region *region, const char *material)
{
  /* What nothing is made of is looked at as if the body were, but beside bars: it may be meant for those, or a bar's name for it be mistaken. */
  const bool spare = d->region_count == 1 && !forces_use_materials(d->forces_spec);
  return spare || region_is_made_of(d, region, material);
}

/** Components of the law of a material that the deck names; commands of OpenSees say it by their first word. */
static int components_of(const DeckReader *reader, const MaterialSpec *spec)
{
  const breccia_law *law = spec->model ? law_find(reader->context, spec->model) : NULL;
  if (law) return law->components;
  return spec->opensees && !strncmp(spec->opensees, "uniaxialMaterial", strlen("uniaxialMaterial")) ? 1 : 6;
}

/** Bonds of laws of one strain have no use for the keys of others. */
static int check_keys(const Region *region, const DeckReader *reader)
{
  const Section *section = region->type->section;
  int status = BRECCIA_OK;
  for (int k = 0; section && k < section->field_count; ++k) {
    const char *key = section->fields[k].key;
    if (node_get(region->node, key))
      status =
          node_error(reader->document, node_get(region->node, key), reader->error,
                     "%s: belongs to %s bonds with laws of strain in space; those of laws of one strain are those of "
                     "%s: leave it out",
                     key, region->type->name, region->type->fibres->name);
  }
  return status;
}

int regions_take_fibres(Domain *d, const DeckReader *reader, const SectionList *materials)
{
  int status = BRECCIA_OK;
  for (int r = 0; r < d->region_count; ++r) {
    Region *region = &d->regions[r];
    bool any = false, fibres = region->takes_both = region->type->fibres != NULL;
    for (int k = 0; k < materials->count && fibres; ++k) {
      const MaterialSpec *spec = materials->items[k];
      if (!region_is_made_of(d, region, spec->head.name)) continue;
      any = true;
      fibres &= components_of(reader, spec) == 1;
    }
    if (!fibres || !any) continue;
    const int bad = check_keys(region, reader);
    if (bad) status = bad;
    region->type = region->type->fibres;
    region->keys = NULL;
  }
  return status;
}

int regions_find_borders(Domain *d, Error *error)
{
  const Family *f = &d->family;
  const int64_t slices = d->particles->slices;
  for (int r = 0; r < d->region_count && d->region_count > 1; ++r) {
    Region *region = &d->regions[r];
    region->border = memory_zeroed((size_t)slices, sizeof *region->border, "regions", error);
    if (!region->border) return BRECCIA_FAILURE;
    for (int64_t s = 0; s < slices; ++s) {
      bool reached = false;
      for (int64_t slot = f->stored[s]; slot < f->first[s + 1] && region->foreign[s]; ++slot)
        for (int lane = 0; lane < SLICE; ++lane)
          reached |= f->intact[slot] >> lane & 1 && d->region[family_bond(f, s, slot, lane).neighbour / SLICE] == r;
      if (reached) region->border[region->border_count++] = s;
    }
  }
  return BRECCIA_OK;
}

void regions_destroy(Domain *d)
{
  for (int r = 0; r < d->region_count; ++r) {
    Region *region = &d->regions[r];
    if (region->formulation) region->type->destroy(region->formulation);
    points_destroy(&region->points);
    bond_list_destroy(&region->bonds);
    free(region->row_strength);
    for (int k = 0; k < 2; ++k) free(region->places.particle[k]);
    for (int k = 0; k < 3; ++k) free(region->places.position[k]);
    for (int k = 0; k < 3; ++k) free(region->places.direction[k]);
    free(region->foreign);
    free(region->border);
    free(region->stripe);
    free(region->stripe_slice);
    window_destroy(&region->window);
  }
  free(d->regions);
  free(d->region);
}
