#include "results/fields.h"

#include "base/tensor.h"
#include "deck/quantity.h"
#include <string.h>

#define OUTPUT_FIELD(name) extern const OutputField field_##name;
#include "results/field_list.h"
#undef OUTPUT_FIELD

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
  vector_at(d->particles->velocity.row, place, value);
}
static void internal_force(const Domain *d, int32_t place, double *value)
{
  vector_at(d->particles->internal.row, place, value);
}
static void rotation(const Domain *d, int32_t place, double *value)
{
  particles_rotation(d->particles, place, value);
  for (int k = 0; k < 3; ++k) value[k] *= 180 / acos(-1);
}
/** Rows of rotations of a vector, about x, y, z; 0 where there are none. */
static void rotations_at(const Vector *from, int32_t place, double *value)
{
  for (int k = 0; k < 3; ++k) value[k] = 0;
  for (int k = from->space->rotation; k < from->space->rows; ++k) value[from->space->row[k].axis] = from->row[k][place];
}
static void angular_velocity(const Domain *d, int32_t place, double *value)
{
  rotations_at(&d->particles->velocity, place, value);
}
static void internal_moment(const Domain *d, int32_t place, double *value)
{
  rotations_at(&d->particles->internal, place, value);
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
  const Region *region = domain_region(d, place);
  region->type->gradient(region->formulation, place, value);
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

const OutputField field_displacement = {.name = "displacement",
                                        .dimension = "length",
                                        .about = "displacement from the reference position",
                                        .components = 3,
                                        .component_names = xyz,
                                        .value = displacement};
const OutputField field_velocity = {.name = "velocity",
                                    .dimension = "velocity",
                                    .about = "velocity",
                                    .components = 3,
                                    .component_names = xyz,
                                    .value = velocity};
const OutputField field_stress = {
    .name = "stress",
    .dimension = "stress",
    .about = "stress as the law gives it (second Piola-Kirchhoff with green-lagrange strain); of bonds: virial stress",
    .components = 6,
    .component_names = voigt,
    .value = stress};
const OutputField field_strain = {.name = "strain",
                                  .dimension = "1",
                                  .about = "strain as the law takes it, engineering shear; with bonds: Green-Lagrange "
                                           "of the family, zz in plane stress by nu = 1/3",
                                  .components = 6,
                                  .component_names = voigt,
                                  .value = strain};
const OutputField field_gradient = {.name = "deformation gradient",
                                    .dimension = "1",
                                    .about = "F, row by row",
                                    .components = 9,
                                    .component_names = full,
                                    .value = gradient};
const OutputField field_octahedral = {.name = "octahedral shear stress",
                                      .dimension = "stress",
                                      .about = "sqrt(2 J2 / 3)",
                                      .components = 1,
                                      .value = octahedral};
const OutputField field_octahedral_strain = {.name = "octahedral shear strain",
                                             .dimension = "1",
                                             .about =
                                                 "twice the octahedral measure of the strain deviator: 2 / sqrt(3) |e|",
                                             .components = 1,
                                             .value = octahedral_strain};
const OutputField field_von_mises = {
    .name = "von Mises stress", .dimension = "stress", .about = "sqrt(3 J2)", .components = 1, .value = von_mises};
const OutputField field_deviator_norm = {.name = "deviator norm",
                                         .dimension = "stress",
                                         .about = "|s| = sqrt(2 J2)",
                                         .components = 1,
                                         .value = deviator_norm};
const OutputField field_mean_stress = {.name = "mean stress",
                                       .dimension = "stress",
                                       .about = "a third of the trace, tension positive",
                                       .components = 1,
                                       .value = mean_stress,
                                       .has_sign = true};
const OutputField field_damage = {.name = "damage",
                                  .dimension = "1",
                                  .about = "broken share of the family, 0 to 1",
                                  .components = 1,
                                  .value = damage};
const OutputField field_internal_force = {.name = "internal force",
                                          .dimension = "force per volume",
                                          .about = "force per volume from bonds",
                                          .components = 3,
                                          .component_names = xyz,
                                          .value = internal_force};
const OutputField field_rotation = {.name = "rotation",
                                    .dimension = "angle",
                                    .about = "rotation vector of particles that have rotations, in space of at most "
                                             "half a turn; of others 0",
                                    .components = 3,
                                    .component_names = xyz,
                                    .value = rotation};
const OutputField field_angular_velocity = {.name = "angular velocity",
                                            .dimension = "angular velocity",
                                            .about = "of particles that have rotations",
                                            .components = 3,
                                            .component_names = xyz,
                                            .value = angular_velocity};
const OutputField field_internal_moment = {.name = "internal moment",
                                           .dimension = "stress",
                                           .about = "moment per volume from bonds, on particles that have rotations",
                                           .components = 3,
                                           .component_names = xyz,
                                           .value = internal_moment};
const OutputField field_block = {
    .name = "block", .dimension = "1", .about = "which block of the deck, from 0", .components = 1, .value = block};

static const OutputField *const fields[] = {
#define OUTPUT_FIELD(name) &field_##name,
#include "results/field_list.h"
#undef OUTPUT_FIELD
};
enum { COUNT = sizeof fields / sizeof *fields };

const OutputField *output_field_at(int k)
{
  return k < COUNT ? fields[k] : NULL;
}

const OutputField *output_field_find(const char *name)
{
  for (int k = 0; k < COUNT; ++k)
    if (!strcmp(fields[k]->name, name)) return fields[k];
  return NULL;
}

const char *history_field_dimension(const Material *m, int k)
{
  const char *dimension = m->law->history_dimension ? m->law->history_dimension(m->constants, k) : "";
  return *dimension && dimension_find(dimension) ? dimension : "1";
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
