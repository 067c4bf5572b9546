#include "results/fields.h"

#include "base/tensor.h"
#include <string.h>

static void vector_at(double *const from[3], int32_t place, double *value)
{
  for (int k = 0; k < 3; ++k) value[k] = from[k][place];
}
static void displacement(const Domain *d, int32_t place, double *value)
{
  for (int k = 0; k < 3; ++k) value[k] = particles_moved(d->particles, k, place);
}
static void velocity(const Domain *d, int32_t place, double *value)
{
  vector_at(d->particles->velocity, place, value);
}
static void internal_force(const Domain *d, int32_t place, double *value)
{
  vector_at(d->particles->internal, place, value);
}
static void stress(const Domain *d, int32_t place, double *value)
{
  for (int k = 0; k < 6; ++k) value[k] = d->stress[k][place];
}
static void strain(const Domain *d, int32_t place, double *value)
{
  for (int k = 0; k < 6; ++k) value[k] = d->strain[k][place];
}
static void gradient(const Domain *d, int32_t place, double *value)
{
  d->type->gradient(d->formulation, place, value);
}
static void octahedral(const Domain *d, int32_t place, double *value)
{
  double s[6];
  stress(d, place, s);
  *value = tensor_octahedral_shear(s);
}
static void deviator_norm(const Domain *d, int32_t place, double *value)
{
  octahedral(d, place, value);
  *value *= sqrt(3);
}
static void von_mises(const Domain *d, int32_t place, double *value)
{
  octahedral(d, place, value);
  *value *= 3 / sqrt(2);
}
static void octahedral_strain(const Domain *d, int32_t place, double *value)
{
  double e[6];
  strain(d, place, e);
  for (int k = 3; k < 6; ++k) e[k] /= 2;
  *value = 2 * tensor_octahedral_shear(e);
}
static void mean_stress(const Domain *d, int32_t place, double *value)
{
  double s[6];
  stress(d, place, s);
  *value = (s[XX] + s[YY] + s[ZZ]) / 3;
}
static void damage(const Domain *d, int32_t place, double *value)
{
  *value = domain_damage(d, place);
}
static void block(const Domain *d, int32_t place, double *value)
{
  *value = d->particles->block[place / SLICE];
}

static const char *const xyz[] = {"x", "y", "z"}, *const voigt[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
static const char *const full[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};

static const OutputField fields[] = {
    {"displacement", "length", "displacement from the reference position", 3, xyz, displacement, false},
    {"velocity", "velocity", "velocity", 3, xyz, velocity, false},
    {"stress", "stress",
     "stress as the law gives it (second Piola-Kirchhoff with green-lagrange strain); of bonds: virial stress", 6,
     voigt, stress, false},
    {"strain", "1",
     "strain as the law takes it, engineering shear; with bonds: Green-Lagrange of the family, zz in plane stress by "
     "nu = 1/3",
     6, voigt, strain, false},
    {"deformation gradient", "1", "F, row by row", 9, full, gradient, false},
    {"octahedral shear stress", "stress", "sqrt(2 J2 / 3)", 1, NULL, octahedral, false},
    {"octahedral shear strain", "1", "twice the octahedral measure of the strain deviator: 2 / sqrt(3) |e|", 1, NULL,
     octahedral_strain, false},
    {"von Mises stress", "stress", "sqrt(3 J2)", 1, NULL, von_mises, false},
    {"deviator norm", "stress", "|s| = sqrt(2 J2)", 1, NULL, deviator_norm, false},
    {"mean stress", "stress", "a third of the trace, tension positive", 1, NULL, mean_stress, true},
    {"damage", "1", "broken share of the family, 0 to 1", 1, NULL, damage, false},
    {"internal force", "force per volume", "force per volume from bonds", 3, xyz, internal_force, false},
    {"block", "1", "which block of the deck, from 0", 1, NULL, block, false},
};
enum { COUNT = sizeof fields / sizeof *fields };

const OutputField *output_field_at(int k)
{
  return k < COUNT ? &fields[k] : NULL;
}

const OutputField *output_field_find(const char *name)
{
  for (int k = 0; k < COUNT; ++k)
    if (!strcmp(fields[k].name, name)) return &fields[k];
  return NULL;
}

int history_field_index(const Material *m, const char *name)
{
  char word[64];
  for (int k = 0; m->law->history_name && k < m->history_values; ++k) {
    *word = 0;
    m->law->history_name(m->constants, k, word, sizeof word);
    if (*word && !strcmp(word, name)) return k;
  }
  return -1;
}
