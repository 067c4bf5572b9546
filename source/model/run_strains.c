/* Finite strain of laws that flow or soften: the largest strains of a run, and what they mean for its stresses.
 *
 * With `strain: green-lagrange` a law takes E = (F^T F - I) / 2 and answers the second Piola-Kirchhoff stress S. A
 * fibre of stretch l along a principal axis has E = (l^2 - 1) / 2. Where S is the strength s of a law that flows at
 * constant volume, the force per area of the undeformed body is l s, and the true stress is l^2 s = (1 + 2 E) s
 * (docs/theory.md 4). */
#include "model/run.h"

#include "base/tensor.h"
#include <math.h>

const double run_strain_told_from = 0.02;

bool run_strain_matters(const Region *region, const Material *material)
{
  const FormulationType *type = region->type;
  const bool finite =
      type->components == 6 && type->takes_small_strain && !type->takes_small_strain(region->formulation);
  return finite && (material->history_values > 0 || material->remote);
}

static double size_of_stress(const Domain *d, int32_t place)
{
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += (k < 3 ? 1 : 2) * d->stress[k][place] * d->stress[k][place];
  return sqrt(sum);
}

/** Returns true if a place is inside the body, is made of a material and takes finite strain. */
static bool is_of(const Domain *d, int32_t particle, int material)
{
  const int32_t place = d->particles->place_of[particle];
  return d->material[place / SLICE] == material && !body_outside(&d->body, particle) &&
         run_strain_matters(domain_region(d, place), &d->materials[material]);
}

/** Extends the range of principal strains by those of a place. */
static void note_place(const Domain *d, int32_t place, Peaks *peaks)
{
  double strain[6], principal[3], axes[9];
  for (int k = 0; k < 6; ++k) strain[k] = d->strain[k][place] / (k < 3 ? 1 : 2);
  tensor_eigen(strain, principal, axes);
  for (int k = 0; k < 3; ++k) {
    peaks->strain_low = fmin(peaks->strain_low, principal[k]);
    peaks->strain_high = fmax(peaks->strain_high, principal[k]);
  }
}

/** Extends the range of strains by those of a material. Strains where next to nothing is carried, as in open cracks,
 * mean nothing for stresses: places count that carry a tenth of the largest stress of their material, and more than
 * 1e-6 of its Young's modulus. */
static void note_material(breccia_model *model, int material)
{
  const double carried = 0.1, least = 1e-6;
  const Domain *d = &model->domain;
  double largest = least / carried * material_young(&d->materials[material]);
  for (int32_t n = 0; n < d->particles->count; ++n)
    if (is_of(d, n, material)) largest = fmax(largest, size_of_stress(d, d->particles->place_of[n]));
  for (int32_t n = 0; n < d->particles->count; ++n) {
    const int32_t place = d->particles->place_of[n];
    if (is_of(d, n, material) && size_of_stress(d, place) > carried * largest) note_place(d, place, &model->peaks);
  }
}

void run_note_strains(breccia_model *model)
{
  const Domain *d = &model->domain;
  for (int m = 0; m < d->material_count; ++m) {
    bool any = false;
    for (int r = 0; r < d->region_count; ++r) any |= run_strain_matters(&d->regions[r], &d->materials[m]);
    if (any) note_material(model, m);
  }
}

void run_tell_strains(const breccia_model *model, Text *t)
{
  const Peaks *p = &model->peaks;
  const double strain = p->strain_high > -p->strain_low ? p->strain_high : p->strain_low;
  if (!(fabs(strain) > run_strain_told_from)) return;
  const double stretch = sqrt(fmax(0, 1 + 2 * strain));
  text_add(t,
           "warning: laws that flow or soften have seen Green-Lagrange strains from %.3g to %.3g: forces on what flows "
           "are %.2g %% %s than with small strain, true stresses %.2g %%; take 'strain: small' where rotations are "
           "small\n",
           p->strain_low, p->strain_high, 100 * fabs(stretch - 1), strain > 0 ? "larger" : "smaller",
           200 * fabs(strain));
}
