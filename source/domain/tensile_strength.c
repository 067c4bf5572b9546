/* Tensile strength of bodies whose bonds soften (docs/theory.md 2). If bonds have the share x of the tensile strength
 * of the deck, a body carries F(x) times the strength of its bonds in its strongest direction. F exceeds 1 because the
 * stress of slanted bonds still increases when bonds along the pull have begun to soften. The body carries the tensile
 * strength of the deck for the share with x F(x) = 1. F varies slowly, so that the fixed-point iteration x = 1 / F(x)
 * converges. */
#include "domain/tensile_strength.h"

#include "formulation/whole_family.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* STRENGTH_TURNS: iterations of x = 1 / F(x); each reduces the error to a fifth or less. Their number is fixed, so that
 * round-off cannot change it. STRENGTH_LOOKS: largest number of searches for the strongest direction. */
enum { STRENGTH_TURNS = 10, STRENGTH_LOOKS = 3, PLANE_DIRECTIONS = 24 };

/* Directions in space: vectors with components of -REACH to REACH, without opposite ones. */
enum { REACH = 2, WIDTH = 2 * REACH + 1, SPACE_DIRECTIONS = WIDTH * WIDTH * WIDTH / 2 };

/** Smallest and largest strength of a block over all directions, over the strength of its bonds. */
typedef struct StrengthBand {
  double least, most;
  double strongest[3]; /* direction of the largest strength */
} StrengthBand;

/** Computes direction k of a body. @return false if direction k is a multiple of another direction */
static bool strength_direction(int dimensions, int k, double n[3])
{
  if (dimensions == 2) {
    const double angle = acos(-1) * k / PLANE_DIRECTIONS;
    n[0] = cos(angle);
    n[1] = sin(angle);
    n[2] = 0;
    return k < PLANE_DIRECTIONS;
  }
  const int v[3] = {k / (WIDTH * WIDTH) - REACH, k / WIDTH % WIDTH - REACH, k % WIDTH - REACH};
  const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  bool even = true;
  for (int c = 0; c < 3; ++c) {
    n[c] = v[c] / length;
    even &= v[c] % 2 == 0;
  }
  return !even;
}

static double strength_along(const Region *region, int block, const double n[3])
{
  return region->type->uniaxial_strength(region->formulation, block, n);
}

/** Adds the strength along a direction to the band. @return false if bonds do not soften */
static bool strength_take(const Region *region, int block, const double n[3], StrengthBand *band)
{
  const double strength = strength_along(region, block, n);
  if (isnan(strength)) return false;
  band->least = fmin(band->least, strength);
  if (!(strength > band->most)) return true;
  band->most = strength;
  memcpy(band->strongest, n, sizeof band->strongest);
  return true;
}

/** Adds the directions of the bonds of one particle inside a block of particles from a file, and in the plane the
 *  directions across these bonds: a lattice in a file may be turned. */
static bool strength_take_bonds(const Domain *d, const Region *region, int block, StrengthBand *band)
{
  const Family *f = &d->family;
  int64_t place;
  if (!whole_families_in_the_middle(&d->body, f, block, WHOLE_FAMILY_SHARE, 1, &place)) return false;
  const int64_t slice = place / SLICE;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    const double n[3] = {bond.xi[0] / bond.length, bond.xi[1] / bond.length, bond.xi[2] / bond.length},
                 across[3] = {-n[1], n[0], 0};
    if (!strength_take(region, block, n, band)) return false;
    if (d->body.dimensions == 2 && !strength_take(region, block, across, band)) return false;
  }
  return true;
}

/** Finds the strength band of a block. @return false if bonds of the block do not soften */
static bool strength_band(const Domain *d, const Region *region, int block, StrengthBand *band)
{
  const int directions = d->body.dimensions == 2 ? PLANE_DIRECTIONS : SPACE_DIRECTIONS;
  *band = (StrengthBand){.least = INFINITY};
  if (!region->type->uniaxial_strength) return false;
  if (!d->body.lattices[block].chunks) return strength_take_bonds(d, region, block, band);
  for (int k = 0; k < directions; ++k) {
    double n[3];
    if (strength_direction(d->body.dimensions, k, n) && !strength_take(region, block, n, band)) return false;
  }
  return true;
}

static const Region *strength_region(const Domain *d, int block, int *material)
{
  int64_t slice = 0;
  while (slice < d->particles->slices && d->particles->block[slice] != block) ++slice;
  if (slice == d->particles->slices) return NULL;
  *material = d->material[slice];
  return domain_region(d, slice * SLICE);
}

/** Returns true if an earlier block has the same material and the same lattice. */
static bool strength_is_known(const Domain *d, int block)
{
  const Lattice *own = &d->body.lattices[block];
  for (int b = 0; b < block; ++b) {
    const Lattice *lattice = &d->body.lattices[b];
    if (own->chunks && lattice->chunks && lattice->type == own->type && lattice->spacing == own->spacing &&
        !strcmp(d->body.blocks[b]->material, d->body.blocks[block]->material))
      return true;
  }
  return false;
}

/** Finds the share with which a block carries the tensile strength of the deck in its strongest direction.
 *  @return status of the law, with the reason */
static int strength_find_share(const Domain *d, const Region *region, int block, Material *m, double *share,
                               char *reason, size_t size)
{
  StrengthBand band;
  int status = BRECCIA_OK;
  *share = 1;
  if ((status = material_share_strength(m, 1, reason, size))) return status;
  for (int look = 0; look < STRENGTH_LOOKS && strength_band(d, region, block, &band) && !status; ++look) {
    if (band.most * *share <= 1 + 1e-6) break;
    for (int turn = 0; turn < STRENGTH_TURNS && !status; ++turn) {
      *share = fmin(1, 1 / strength_along(region, block, band.strongest));
      status = material_share_strength(m, *share, reason, size);
    }
  }
  return status;
}

int tensile_strength_set(Domain *d, const DeckReader *reader, const SectionList *materials)
{
  double *shares = memory_zeroed((size_t)d->material_count + 1, sizeof *shares, "tensile strengths", reader->error);
  int status = shares ? BRECCIA_OK : BRECCIA_FAILURE;
  char reason[512] = "";
  for (int block = 0; block < d->body.block_count && !status; ++block) {
    int k = 0;
    const Region *region = strength_region(d, block, &k);
    if (!region || !region->type->strength_of_body || !region->type->strength_of_body(region->formulation) ||
        !material_can_share(&d->materials[k]) || strength_is_known(d, block))
      continue;
    double share;
    status = strength_find_share(d, region, block, &d->materials[k], &share, reason, sizeof reason);
    if (!(shares[k] > 0) || share < shares[k]) shares[k] = share;
    if (!status) status = material_share_strength(&d->materials[k], shares[k], reason, sizeof reason);
    if (status)
      status = node_error(reader->document, ((const SectionHead *)section_find(materials, d->materials[k].name))->node,
                          reader->error, "material '%s': %s", d->materials[k].name, reason);
  }
  free(shares);
  return status;
}

void tensile_strength_describe(const Domain *d, Text *text)
{
  const double tolerated = 1.05; /* strength of a body whose bonds yield, over that of its bonds */
  for (int block = 0; block < d->body.block_count; ++block) {
    int k = 0;
    const Region *region = strength_region(d, block, &k);
    StrengthBand band;
    if (!d->body.lattices[block].chunks && d->broken_count) continue; /* families inside may have broken bonds */
    if (!region || strength_is_known(d, block) || !strength_band(d, region, block, &band)) continue;
    const char *const name = d->body.blocks[block]->head.name;
    const Material *m = &d->materials[k];
    if (!(m->softening_energy > 0)) {
      if (band.most > tolerated)
        text_add(text,
                 "%s: a body of bonds that yield, pulled one way, carries %.3g to %.3g times the stress of its "
                 "bonds by the direction, as slanted bonds yield later; give the yield stress over %.3g to have the "
                 "largest\n",
                 name, band.least, band.most, band.most);
    } else if (region->type->strength_of_body && region->type->strength_of_body(region->formulation) &&
               material_can_share(m))
      text_add(text,
               "%s: bonds carry %.3g of the tensile strength, so that a body pulled one way carries %.3g to %.3g of it "
               "by the direction\n",
               name, m->strength_share, m->strength_share * band.least, m->strength_share * band.most);
    else
      text_add(text,
               "%s: bonds carry the tensile strength, so that a body pulled one way carries %.3g to %.3g of it by the "
               "direction; 'strength of: body' makes the largest of these 1\n",
               name, band.least, band.most);
  }
}
