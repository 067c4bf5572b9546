#include "domain/bending_strength.h"

#include <math.h>
#include <string.h>

/* Depths of the measured beams over E G_F / f_t^2. */
enum { BENDING_DEPTHS = 3 };
static const double bending_depths[BENDING_DEPTHS] = {0.3, 0.6, 1.2};

/** Bending strengths of beams of one formulation and law. */
typedef struct BendingRow {
  const char *formulation, *law;
  double rows; /* number of particle rows over the depth; 0: the beam with a cohesive crack */
  /** By depth [-]. Of particles: bending strength over that of the cohesive crack. Of the crack: that over f_t. */
  double factor[BENDING_DEPTHS];
} BendingRow;

/* Copy of the table "Bending strength" of docs/choosing.md, which bench/bending.py writes: default horizon of each
 * formulation, plane stress, square lattices, bonds with `surface correction: energy`. The entries of a law are in
 * ascending order of `rows`. The numbers in brackets of that table are in cohesive_beams. */
static const BendingRow bending_rows[] = {
    {"bond-based", "exponential-softening", 10, {1.09, 1.03, 0.99}},
    {"bond-based", "exponential-softening", 20, {1.19, 1.20, 1.03}},
    {"bond-based", "bilinear-softening", 10, {1.04, 1.06, 1.01}},
    {"bond-based", "bilinear-softening", 20, {1.13, 1.13, 1.18}},
    {"bond-based", "trilinear-softening", 10, {1.05, 1.07, 0.97}},
    {"bond-based", "trilinear-softening", 20, {1.11, 1.16, 1.21}},
    {"hybrid", "mazars", 10, {0.95, 0.95, 0.96}},
    {"hybrid", "mazars", 20, {0.98, 0.98, 0.99}},
};
static const BendingRow cohesive_beams[] = {
    {"bond-based", "exponential-softening", 0, {1.35, 1.22, 1.14}},
    {"bond-based", "bilinear-softening", 0, {1.75, 1.56, 1.38}},
    {"bond-based", "trilinear-softening", 0, {1.61, 1.42, 1.28}},
    {"hybrid", "mazars", 0, {1.59, 1.41, 1.26}},
};

/* Laws with the curve of a measured law in tension; what bends cracks there long before it crushes. */
static const struct {
  const char *law, *measured;
} same_curves[] = {{"fib-concrete", "exponential-softening"}};

enum {
  BENDING_ROWS = sizeof bending_rows / sizeof *bending_rows,
  COHESIVE_BEAMS = sizeof cohesive_beams / sizeof *cohesive_beams
};

/** Tensile strength of a strip of links, pulled along the rows of its lattice, over E times the `tensile stretch`. */
typedef struct LinkRow {
  const char *lattice;
  double factor;
} LinkRow;

/* Measured on strips of 12 rows whose ends have 1.5 times the strength. */
static const LinkRow link_rows[] = {{"square", 1.19}, {"hexagonal", 1.29}};

/** Returns the factor of a table entry at a depth over E G_F / f_t^2, linear in the logarithm of the depth. */
static double bending_at_depth(const BendingRow *row, double depth)
{
  if (!(depth > bending_depths[0])) return row->factor[0];
  for (int k = 1; k < BENDING_DEPTHS; ++k) {
    if (depth > bending_depths[k]) continue;
    const double part = log(depth / bending_depths[k - 1]) / log(bending_depths[k] / bending_depths[k - 1]);
    return row->factor[k - 1] + part * (row->factor[k] - row->factor[k - 1]);
  }
  return row->factor[BENDING_DEPTHS - 1];
}

/** Returns the measured law that softens in tension along the curve of a law. */
static const char *bending_curve(const char *law)
{
  for (size_t k = 0; k < sizeof same_curves / sizeof *same_curves; ++k)
    if (!strcmp(same_curves[k].law, law)) return same_curves[k].measured;
  return law;
}

double bending_factor(const char *formulation, const char *law, double rows, double depth)
{
  const char *curve = bending_curve(law);
  const BendingRow *below = NULL;
  for (int k = 0; k < BENDING_ROWS; ++k) {
    const BendingRow *row = &bending_rows[k];
    if (strcmp(row->formulation, formulation) != 0 || strcmp(row->law, curve) != 0) continue;
    const double factor = bending_at_depth(row, depth);
    if (rows <= row->rows) {
      if (!below) return factor;
      const double part = log(rows / below->rows) / log(row->rows / below->rows),
                   before = bending_at_depth(below, depth);
      return before + part * (factor - before);
    }
    below = row;
  }
  return below ? bending_at_depth(below, depth) : NAN;
}

double bending_cohesive(const char *formulation, const char *law, double depth)
{
  for (int k = 0; k < COHESIVE_BEAMS; ++k)
    if (!strcmp(cohesive_beams[k].formulation, formulation) && !strcmp(cohesive_beams[k].law, bending_curve(law)))
      return bending_at_depth(&cohesive_beams[k], depth);
  return NAN;
}

/** Finds the shortest and the longest side of a block [length]: the distance of its outermost particles and one
 *  spacing.
 *  @return index of the first SIMD block of the block; -1: it has no particles */
static int64_t bending_sides(const Domain *d, int block, double *shortest, double *longest)
{
  const Particles *p = d->particles;
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  int64_t first = -1;
  for (int64_t n = 0; n < p->count; ++n) {
    const int64_t place = p->place_of[n];
    if (p->block[place / SLICE] != block || body_outside(&d->body, (int32_t)n)) continue;
    if (first < 0) first = place / SLICE;
    for (int k = 0; k < d->body.dimensions; ++k) {
      low[k] = fmin(low[k], p->position[k][place]);
      high[k] = fmax(high[k], p->position[k][place]);
    }
  }
  *shortest = INFINITY;
  *longest = 0;
  for (int k = 0; k < d->body.dimensions && first >= 0; ++k) {
    const double side = high[k] - low[k] + d->body.lattices[block].spacing;
    *shortest = fmin(*shortest, side);
    *longest = fmax(*longest, side);
  }
  return first;
}

/** Adds the line on the bending strength of a block. */
static void bending_describe_block(const Domain *d, int block, const Region *region, const Material *m, double depth,
                                   Text *text)
{
  const FormulationType *type = region->type;
  if (type->strength_of_body && !type->strength_of_body(region->formulation)) return;
  const double young = material_young(m), strength = sqrt(2 * young * m->softening_energy) / m->strength_share,
               length = young * m->fracture_energy / (strength * strength),
               rows = depth / d->body.lattices[block].spacing,
               factor = bending_factor(type->name, m->law_name, rows, depth / length);
  if (isnan(factor) || !isfinite(length)) return;
  const double relative = depth / length;
  double least = INFINITY, most = 0;
  for (int k = 0; k < BENDING_ROWS; ++k) {
    least = fmin(least, bending_rows[k].rows);
    most = fmax(most, bending_rows[k].rows);
  }
  const bool measured = rows > least - 0.5 && rows < most + 0.5 && relative >= bending_depths[0] &&
                        relative <= bending_depths[BENDING_DEPTHS - 1];
  const double cohesive = bending_cohesive(type->name, m->law_name, relative);
  text_add(text,
           "%s: a beam of %.0f rows, %.2g E G_F/f_t^2 deep, has a bending strength of %.2f f_t, %.2f times that of a "
           "cohesive crack of the same f_t, G_F and softening curve (%.2f f_t; ",
           d->body.blocks[block]->head.name, rows, relative, factor * cohesive, factor, cohesive);
  if (!measured)
    text_add(text, "value of the nearest beam of the measured %g to %g rows and %g to %g E G_F/f_t^2; ", least, most,
             bending_depths[0], bending_depths[BENDING_DEPTHS - 1]);
  text_add(text, "measured at the default horizon in plane stress on square lattices)\n");
}

/** Adds the line on the tensile strength of a block of links. */
static void link_describe_block(const Domain *d, int block, Text *text)
{
  for (size_t k = 0; k < sizeof link_rows / sizeof *link_rows; ++k)
    if (!strcmp(link_rows[k].lattice, d->body.lattices[block].type->name))
      text_add(text,
               "%s: a strip of these links pulled along its rows carries %.2f times E times the 'tensile stretch' "
               "(measured); divide the stretch of the deck by this factor\n",
               d->body.blocks[block]->head.name, link_rows[k].factor);
}

void bending_strength_describe(const Domain *d, Text *text)
{
  const double slender = 2;
  for (int block = 0; block < d->body.block_count; ++block) {
    double depth, longest;
    if (!d->body.lattices[block].chunks || d->body.dimensions < 2) continue;
    const int64_t slice = bending_sides(d, block, &depth, &longest);
    if (slice < 0) continue;
    const Material *m = &d->materials[d->material[slice]];
    const Region *region = domain_region(d, slice * SLICE);
    if (m->law->link && region->type->bond_damage) link_describe_block(d, block, text);
    if (longest >= slender * depth && m->softening_energy > 0) bending_describe_block(d, block, region, m, depth, text);
  }
}
