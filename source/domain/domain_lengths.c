/* Lengths over which points spread a fracture energy where the formulation alone does not determine them
 * (constitutive/normal_lengths.h).
 * - Points on lattice bonds: the length depends on the crack normal. The length of a material is the mean of
 *   FormulationType.crack_length over its lattice blocks.
 * - Points on particles: the length depends on the brittleness of the material (FormulationType.softening_length). */
#include "base/memory.h"
#include "constitutive/normal_lengths.h"
#include "domain/regions.h"

#include <math.h>
#include <string.h>

struct MaterialLengths {
  const Domain *domain;
  int material;
  double fixed; /* length for all crack normals [length]; 0: the length depends on normal and lattice */
};

static double lengths_across(const void *context, const double normal[3])
{
  const struct MaterialLengths *l = context;
  const Domain *d = l->domain;
  double sum = 0;
  int blocks = 0;
  if (l->fixed > 0) return l->fixed;
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

/** Returns true if a region has points with six strain components, and its formulation finds lengths for them. */
static bool lengths_are_known(const Region *region)
{
  if (region->points.components != 6) return false;
  return region->points.on_bonds ? region->type->crack_length != NULL : region->type->softening_length != NULL;
}

/** Returns the length of a material with points on particles [length]; 0: points are on bonds. */
static double lengths_of_particles(const Domain *d, const Material *m, Space space)
{
  const Region *region = &d->regions[0];
  if (region->points.on_bonds) return 0;
  return region->type->softening_length(space, d->family.horizon, m->fracture_energy / (2 * m->softening_energy));
}

double domain_longest_crack_length(const Domain *d, int material)
{
  enum { NORMALS = 24 };
  const double half_turn = acos(-1);
  double longest = 0;
  if (!d->lengths || !d->lengths[material].domain) return 0;
  for (int k = 0; k < NORMALS; ++k) {
    const double angle = half_turn * k / NORMALS, normal[3] = {cos(angle), sin(angle), 0};
    longest = fmax(longest, lengths_across(&d->lengths[material], normal));
  }
  return d->body.dimensions == 3 ? fmax(longest, lengths_across(&d->lengths[material], (const double[]){0, 0, 1}))
                                 : longest;
}

int domain_find_lengths(Domain *d, Space space, Error *error)
{
  bool known = d->region_count > 0;
  for (int r = 0; r < d->region_count; ++r)
    known &= lengths_are_known(&d->regions[r]) && d->regions[r].points.on_bonds == d->regions[0].points.on_bonds &&
             (d->regions[r].points.on_bonds || d->regions[r].type == d->regions[0].type);
  if (!known) return BRECCIA_OK;
  d->lengths = memory_zeroed((size_t)d->material_count, sizeof *d->lengths, "lengths of cracks", error);
  if (!d->lengths) return BRECCIA_FAILURE;
  for (int k = 0; k < d->material_count; ++k) {
    const Material *m = &d->materials[k];
    if (!(m->fracture_energy > 0) || m->length_given || !(m->softening_energy > 0)) continue;
    d->lengths[k] = (struct MaterialLengths){d, k, lengths_of_particles(d, m, space)};
    if (d->lengths[k].fixed == m->length) continue;
    normal_lengths_give(m, &(NormalLengths){lengths_across, &d->lengths[k]});
  }
  return BRECCIA_OK;
}

int64_t domain_take_lengths(Domain *d)
{
  int64_t taken = 0;
  if (!d->lengths) return 0;
  for (int r = 0; r < d->region_count; ++r) taken += points_take_lengths(&d->regions[r].points);
  return taken;
}

void domain_drop_lengths(Domain *d)
{
  for (int r = 0; r < d->region_count && d->lengths; ++r) points_drop_lengths(&d->regions[r].points);
}
