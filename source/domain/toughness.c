/* Toughness by direction: fracture energy of plane cracks through the lattice of a block, over the fracture energy of
 * the deck (failure/crack_planes.h, docs/theory.md 4). If bonds break at once, running cracks dissipate more than plane
 * cracks, and loads do more work than bonds dissipate: failure/crack_wake.c has measured values. */
#include "domain/toughness.h"

#include "constitutive/min_max.h"
#include "constitutive/normal_lengths.h"
#include "failure/crack_wake.h"
#include "failure/critical_energy.h"
#include "failure/critical_stretch.h"

#include <math.h>
#include <string.h>

/** What makes a quantity of plane cracks through a block a share of its fracture energy. */
typedef struct ToughnessBlock {
  CrackBlock block;
  const Criterion *criterion; /* NULL: a law that softens */
  const Material *material;
  double limit, unit; /* limit of bonds; value of the quantity that counts as a share of 1 */
  CrackWake wake;     /* measured shares for the criterion */
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

/** Adds the measured dissipation of running cracks and the measured work of loads, over the fracture energy.
 *  @param[in] planes  mean dissipation of plane cracks over the fracture energy */
static void toughness_add_measured(const ToughnessBlock *t, double planes, Text *text)
{
  const CrackWake *w = &t->wake;
  if (!t->criterion) return;
  if (!w->is_known) {
    text_add(text, "; the energy that running cracks take has not been measured");
    return;
  }
  text_add(text,
           "; bonds of running cracks took %.3g to %.3g of it, and loads felt %.3g to %.3g where "
           "cracks jump from bond to bond (lattice trapping)",
           planes * w->taken[0], planes * w->taken[1], planes * w->felt[0], planes * w->felt[1]);
  if (!w->is_measured)
    text_add(text, ", on a %s lattice at %.4g spacings, the nearest to yours that was measured", w->lattice,
             w->spacings);
}

/** Adds the line of a block. */
static void toughness_add(const Domain *d, const ToughnessBlock *t, bool asked, const Units *units, Text *text)
{
  const int dimensions = d->body.dimensions;
  const CrackBand band = crack_band(dimensions, toughness_across, t);
  if (isnan(band.mean)) return;
  if (!t->criterion && d->lengths && normal_lengths_give(t->material, NULL)) {
    text_add(
        text,
        "%s: points across a crack take the fracture energy whatever its direction: each spreads it over the length "
        "of its first principal strain, %.3g to %.3g of that across x\n",
        d->body.blocks[t->block.block]->head.name, band.least / band.across[0], band.most / band.across[0]);
    return;
  }
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
  if (asked && dimensions > 1) toughness_add_measured(t, band.mean, text);
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

enum { TOUGHNESS_DIRECTIONS = 7 };

/** Computes axis or diagonal number k. @return false if the direction is not in the plane of the body */
static bool toughness_direction(int k, int dimensions, double n[3])
{
  static const double directions[TOUGHNESS_DIRECTIONS][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0},
                                                             {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
  const double *v = directions[k], length = sqrt(v[0] + v[1] + v[2]);
  for (int i = 0; i < 3; ++i) n[i] = v[i] / length;
  return dimensions == 3 || v[2] == 0;
}

/** Adds the dissipation of links across axes and diagonals. The damage law of links is set for the planes of lowest
 *  dissipation (formulation/micropolar_damage_laws.c). */
static void toughness_add_links(const Domain *d, const ToughnessBlock *t, Text *text)
{
  const int dimensions = d->body.dimensions;
  double least = INFINITY, most = 0, n[3];
  for (int k = 0; k < TOUGHNESS_DIRECTIONS; ++k) {
    if (!toughness_direction(k, dimensions, n)) continue;
    const double length = crack_length_across(&t->block, n);
    if (isnan(length)) return;
    least = fmin(least, length);
    most = fmax(most, length);
  }
  text_add(text,
           "%s: links across a crack take the fracture energy along the planes that cost least, and up to %.3g of it "
           "across axes and diagonals of the lattice; cracks elsewhere step from plane to plane and take more\n",
           d->body.blocks[t->block.block]->head.name, most / least);
}

/* Ratio of Young's moduli from which a block acts as a stiff inclusion on a block that crushes. */
static const double toughness_stiff = 2;

/** Adds a warning if a stiff block that cannot crush may press on a block of crushing bonds: both are bonded over a
 *  horizon, so that the block that crushes does so beside the stiff one first (docs/choosing.md). */
static void toughness_add_plates(const Domain *d, int block, const Material *m, Text *text)
{
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    const int other = d->particles->block[s];
    const Material *plate = &d->materials[d->material[s]];
    if (other == block || plate->law->components != 1 || !isnan(material_compressive_strength(plate)) ||
        !(material_young(plate) >= toughness_stiff * material_young(m)))
      continue;
    text_add(
        text,
        "%s: if '%s' is a plate under a jack or on a support, a beam that crushes carries about 15 %% less than its "
        "section: both are bonded over a horizon; let the load act on particles of '%s' by 'platen: turning'\n",
        d->body.blocks[block]->head.name, d->body.blocks[other]->head.name, d->body.blocks[block]->head.name);
    return;
  }
}

/** Adds the band of compressive strengths of a lattice of crushing bonds along its axes and diagonals. */
static void toughness_add_crushing(const Domain *d, const Region *region, int block, const Material *m,
                                   const Units *units, Text *text)
{
  const int dimensions = d->body.dimensions;
  double least = INFINITY, most = 0, n[3];
  if (!region->type->uniaxial_crushing || dimensions < 2) return;
  for (int k = 0; k < TOUGHNESS_DIRECTIONS; ++k) {
    if (!toughness_direction(k, dimensions, n)) continue;
    const double found = region->type->uniaxial_crushing(region->formulation, block, n);
    if (isnan(found)) return;
    least = fmin(least, found);
    most = fmax(most, found);
  }
  text_add(text,
           "%s: pressed one way a body carries %.3g to %.3g of its compressive strength by the direction; its "
           "crushing energy is spread over ",
           d->body.blocks[block]->head.name, least, most);
  quantity_describe(units_in_si(units, dimension_find("length"), m->length), "m", text);
  text_add(text, "\n");
  if (dimensions == 2) toughness_add_plates(d, block, m, text);
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
    ToughnessBlock t = {
        .block = {region->type, region->formulation, &d->family, d->failure.influence, block, &d->body.lattices[block]},
        .material = m,
        .limit = limit};
    if (m->softening_energy > 0 && m->fracture_energy > 0) {
      if (!(m->length > 0) || m->length_given) continue;
      t.unit = m->length;
    } else if (d->failure.criterion && d->failure.criterion->crack_energy && isfinite(limit)) {
      t.criterion = d->failure.criterion;
      t.unit = isnan(energy) ? 1 : energy;
      t.wake = crack_wake(&t.block, t.criterion->name);
    } else {
      continue;
    }
    if (!t.criterion && isinf(t.unit)) {
      toughness_add_links(d, &t, text);
      continue;
    }
    toughness_add(d, &t, !t.criterion || !isnan(energy), units, text);
    toughness_add_crushing(d, region, block, m, units, text);
  }
}
