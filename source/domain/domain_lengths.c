/* Characteristic lengths of points on lattice bonds as a function of the crack normal (constitutive/normal_lengths.h).
 * The length of a material is the mean over its lattice blocks of the lengths that FormulationType.crack_length
 * finds. */
#include "base/memory.h"
#include "constitutive/normal_lengths.h"
#include "domain/regions.h"

#include <math.h>
#include <string.h>

struct MaterialLengths {
  const Domain *domain;
  int material;
};

static double lengths_across(const void *context, const double normal[3])
{
  const struct MaterialLengths *l = context;
  const Domain *d = l->domain;
  double sum = 0;
  int blocks = 0;
  for (int r = 0; r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    for (int b = 0; b < d->body.block_count && region->points.on_bonds; ++b) {
      if (!d->body.lattices[b].chunks || strcmp(d->body.blocks[b]->material, d->materials[l->material].name) != 0)
        continue;
      const double length = region->type->crack_length(region->formulation, b, normal);
      if (!(length > 0)) continue;
      sum += length;
      ++blocks;
    }
  }
  return blocks ? sum / blocks : 0;
}

/** Returns true if a region has points on bonds with six strain components, and its formulation finds lengths. */
static bool lengths_are_known(const Region *region)
{
  return region->points.on_bonds && region->points.components == 6 && region->type->crack_length;
}

int domain_find_lengths(Domain *d, Error *error)
{
  bool known = d->region_count > 0;
  for (int r = 0; r < d->region_count; ++r) known &= lengths_are_known(&d->regions[r]);
  if (!known) return BRECCIA_OK;
  d->lengths = memory_zeroed((size_t)d->material_count, sizeof *d->lengths, "lengths of cracks", error);
  if (!d->lengths) return BRECCIA_FAILURE;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    d->lengths[k] = (struct MaterialLengths){d, k};
    if (!(m->fracture_energy > 0) || m->length_given) continue;
    normal_lengths_give(m, &(NormalLengths){lengths_across, &d->lengths[k]});
  }
  return BRECCIA_OK;
}
