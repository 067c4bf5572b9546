/* Toughness by direction: what plane cracks take of the lattice of a block, over the fracture energy that the deck asks
 * for (failure/crack_planes.h, docs/theory.md 4). Where bonds break at once cracks jump, and loads feel more than what
 * bonds take; how much more was measured (make bench-toughness) and is stored in one table here. */
#include "domain/toughness.h"

#include "failure/crack_planes.h"
#include "failure/critical_energy.h"
#include "failure/critical_stretch.h"

#include <math.h>
#include <string.h>

/* Work of the loads over the fracture energy asked for, in the notched strip of bench/toughness.py: lattices of the
 * plane, three directions, default horizon. */
static const struct {
  const char *formulation, *criterion;
  double least, most;
} toughness_felt[] = {
    {"bond-based", "critical stretch", 1.4, 1.5},         {"bond-based", "critical bond energy", 1.4, 1.7},
    {"ordinary", "critical stretch", 1.5, 1.7},           {"ordinary", "critical bond energy", 1.5, 1.7},
    {"correspondence", "critical bond energy", 1.3, 1.4},
};

/** What makes a quantity of plane cracks through a block a share of its fracture energy. */
typedef struct ToughnessBlock {
  CrackBlock block;
  const Criterion *criterion; /* NULL: a law that softens */
  const Material *material;
  double limit, unit; /* of bonds; what counts 1 */
} ToughnessBlock;

static double toughness_across(const void *context, const double normal[3])
{
  const ToughnessBlock *t = context;
  if (t->criterion) return t->criterion->crack_energy(&t->block, t->material, t->limit, normal) / t->unit;
  return crack_length_across(&t->block, normal) / t->unit;
}

/** Returns the fracture energy that the deck asks for; NaN where it gives a limit of bonds itself. */
static double toughness_asked(const FailureSpec *failure, const Material *material)
{
  const CriticalStretchSpec *stretch = critical_stretch_spec(failure);
  const CriticalEnergySpec *energy = critical_energy_spec(failure);
  if (energy) return energy->fracture_energy;
  if (stretch && !isnan(stretch->fracture_energy)) return stretch->fracture_energy;
  return stretch && !isnan(stretch->stretch) ? NAN : material->fracture_energy;
}

static void toughness_add_felt(const ToughnessBlock *t, Text *text)
{
  for (size_t k = 0; t->criterion && k < sizeof toughness_felt / sizeof *toughness_felt; ++k)
    if (!strcmp(toughness_felt[k].formulation, t->block.type->name) &&
        !strcmp(toughness_felt[k].criterion, t->criterion->name))
      text_add(text, "; loads feel %.3g to %.3g of it where cracks jump from bond to bond (lattice trapping)",
               toughness_felt[k].least, toughness_felt[k].most);
}

/** Adds the line of a block. */
static void toughness_add(const Domain *d, const ToughnessBlock *t, bool asked, const Units *units, Text *text)
{
  const int dimensions = d->body.dimensions;
  const CrackBand band = crack_band(dimensions, toughness_across, t);
  if (isnan(band.mean)) return;
  char unit[64] = "";
  if (!asked) units_name(units, dimension_find("fracture energy"), unit + 1, sizeof unit - 1);
  if (!asked) unit[0] = ' ';
  const char *const of = asked ? " of the fracture energy" : unit;
  text_add(text, "%s: %s a crack take ", d->body.blocks[t->block.block]->head.name,
           t->criterion ? "bonds across" : "points across");
  if (dimensions > 1)
    text_add(text, "%.3g to %.3g%s by its direction (mean %.3g%s", band.least, band.most, of, band.mean, unit);
  else
    text_add(text, "%.3g%s (", band.mean, of);
  for (int k = 0; k < dimensions; ++k)
    text_add(text, "%s%.3g%s across %c", k || dimensions > 1 ? ", " : "", band.across[k], unit, "xyz"[k]);
  text_add(text, ")");
  if (asked) toughness_add_felt(t, text);
  text_add(text, "\n");
}

/** Returns true if an earlier block has the same material and the same lattice. */
static bool toughness_is_told(const Domain *d, int block)
{
  const Lattice *own = &d->body.lattices[block];
  for (int b = 0; b < block; ++b) {
    const Lattice *lattice = &d->body.lattices[b];
    if (lattice->chunks && lattice->type == own->type && lattice->spacing == own->spacing &&
        !strcmp(d->body.blocks[b]->material, d->body.blocks[block]->material))
      return true;
  }
  return false;
}

/** Finds the band of a strength along the axes and diagonals of the lattice of a block.
 *  @return false if none is known */
static bool toughness_strength_band(const Region *region, int block, int dimensions,
                                    double (*strength)(const void *formulation, int block, const double direction[3]),
                                    double *least, double *most)
{
  static const double directions[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
  *least = INFINITY;
  *most = 0;
  if (!strength || dimensions < 2) return false;
  for (size_t k = 0; k < sizeof directions / sizeof *directions; ++k) {
    const double *v = directions[k], length = sqrt(v[0] + v[1] + v[2]),
                 n[3] = {v[0] / length, v[1] / length, v[2] / length};
    if (dimensions == 2 && v[2] != 0) continue;
    const double found = strength(region->formulation, block, n);
    if (isnan(found)) return false;
    *least = fmin(*least, found);
    *most = fmax(*most, found);
  }
  return true;
}

/** Adds what a lattice of softening bonds carries in uniaxial tension, and which strength to give for the one wanted:
 * the largest counts, as too much strength is unsafe. And what it carries in uniaxial compression. */
static void toughness_add_strength(const Domain *d, const Region *region, int block, const Material *m,
                                   const Units *units, Text *text)
{
  const int dimensions = d->body.dimensions;
  double least, most;
  if (toughness_strength_band(region, block, dimensions, region->type->uniaxial_crushing, &least, &most)) {
    text_add(text,
             "%s: pressed one way a body carries %.3g to %.3g of its compressive strength by the direction; its "
             "crushing energy is spread over ",
             d->body.blocks[block]->head.name, least, most);
    quantity_describe(units_in_si(units, dimension_find("length"), m->length), "m", text);
    text_add(text, "\n");
  }
  if (!toughness_strength_band(region, block, dimensions, region->type->uniaxial_strength, &least, &most)) return;
  text_add(
      text,
      "%s: pulled one way a body carries %.3g to %.3g of the tensile strength of its bonds by the direction; for a "
      "body of some strength give the bonds at most %.3g of it\n",
      d->body.blocks[block]->head.name, least, most, 1 / most);
}

void toughness_describe(const Domain *d, const FailureSpec *failure, const Units *units, Text *text)
{
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    const int block = d->particles->block[s];
    if ((s && d->particles->block[s - 1] == block) || !d->body.lattices[block].chunks || toughness_is_told(d, block))
      continue;
    const Region *region = domain_region(d, s * SLICE);
    const Material *m = &d->materials[d->material[s]];
    const double limit = d->failure.limit[d->material[s]], energy = toughness_asked(failure, m);
    ToughnessBlock t = {.block = {region->type, region->formulation, &d->family, d->failure.influence, block},
                        .material = m,
                        .limit = limit};
    if (m->softening_energy > 0 && m->fracture_energy > 0) {
      if (!(m->length > 0) || !isfinite(m->length) || m->length_given) continue;
      t.unit = m->length;
    } else if (d->failure.criterion && d->failure.criterion->crack_energy && isfinite(limit)) {
      t.criterion = d->failure.criterion;
      t.unit = isnan(energy) ? 1 : energy;
    } else {
      continue;
    }
    toughness_add(d, &t, !t.criterion || !isnan(energy), units, text);
    toughness_add_strength(d, region, block, m, units, text);
  }
}
