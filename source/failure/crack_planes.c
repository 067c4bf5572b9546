#include "failure/crack_planes.h"

#include <math.h>
#include <string.h>

enum {
  ANGLES = 360,
  AROUND = 64,
  UP = 16
}; /* normals of the half circle; of the half sphere around its axis and along it, of equal areas */

static void crack_take(CrackBand *band, double value)
{
  band->least = fmin(band->least, value);
  band->most = fmax(band->most, value);
}

/** Takes the directions between neighbours of a cube: G(n) has its cusps at the normals of lattice planes. */
static void crack_take_diagonals(CrackBand *band, CrackQuantity *quantity, const void *context)
{
  for (int k = 0; k < 27; ++k) {
    const double v[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (length > 0) crack_take(band, quantity(context, (double[3]){v[0] / length, v[1] / length, v[2] / length}));
  }
}

CrackBand crack_band(int dimensions, CrackQuantity *quantity, const void *context)
{
  const double pi = acos(-1);
  CrackBand band = {.least = INFINITY, .most = -INFINITY};
  for (int k = 0; k < 3; ++k)
    band.across[k] = k < dimensions ? quantity(context, (double[3]){k == 0, k == 1, k == 2}) : NAN;
  if (isnan(band.across[0])) return (CrackBand){NAN, NAN, NAN, {NAN, NAN, NAN}};
  const int around = dimensions == 3 ? AROUND : dimensions == 2 ? ANGLES : 1, up = dimensions == 3 ? UP : 1;
  for (int j = 0; j < up; ++j)
    for (int k = 0; k < around; ++k) {
      const double z = dimensions == 3 ? (j + 0.5) / UP : 0, angle = (dimensions == 3 ? 2 : 1) * pi * k / around;
      const double flat = sqrt(1 - z * z), normal[3] = {flat * cos(angle), flat * sin(angle), z};
      const double value = quantity(context, normal);
      band.mean += value / (around * up);
      crack_take(&band, value);
    }
  if (dimensions == 3) crack_take_diagonals(&band, quantity, context);
  return band;
}

double crack_length_across(const void *crack_block, const double normal[3])
{
  const CrackBlock *c = crack_block;
  return c->type->crack_length ? c->type->crack_length(c->formulation, c->block, normal) : NAN;
}

double crack_bonds_across(const void *crack_block, const double normal[3])
{
  const CrackBlock *c = crack_block;
  const Family *f = c->family;
  double sum = 0;
  for (int k = f->pattern_begin[c->block]; k < f->pattern_begin[c->block + 1]; ++k) {
    const Pattern *p = &f->patterns[k];
    const double influence = c->influence->value(fmin(1, p->length / f->horizon), p->length);
    const double along = p->xi[0] * normal[0] + p->xi[1] * normal[1] + p->xi[2] * normal[2];
    if (influence > 0) sum += fabs(along) / 2 * p->weight / influence;
  }
  return sum;
}

double crack_mean(const LimitsOf *of, int material, CrackQuantity *quantity)
{
  double sum = 0;
  int blocks = 0;
  for (int b = 0; b < of->body->block_count; ++b) {
    const CrackBlock block = {of->type, of->formulation, of->family, of->lengths->influence, b, &of->body->lattices[b]};
    if (!of->body->lattices[b].chunks || strcmp(of->body->blocks[b]->material, of->materials[material].name) != 0)
      continue;
    const double mean = crack_band(of->body->dimensions, quantity, &block).mean;
    if (isnan(mean)) continue;
    sum += mean;
    ++blocks;
  }
  return blocks ? sum / blocks : NAN;
}
