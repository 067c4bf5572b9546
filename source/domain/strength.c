/* Strength reduction: the factor by which loads divide the strengths of laws at a time
 * (loading/load/strength_reduction.c). The constants of a law are made again from its parameters whenever the factor
 * has changed, so that they depend on the time alone and not on the way to it. */
#include "domain/domain.h"

#include "loading/load.h"
#include <math.h>

/** Reports that the law of a material rejects its reduced strengths. @return BRECCIA_USER_ERROR */
static int refuse_strength(const DeckReader *reader, const Load *load, const char *material, const char *reason)
{
  return node_error(reader->document, load->node, reader->error, "strength reduction: material '%s': %s", material,
                    reason);
}

int domain_check_strength(const Domain *d, const Loading *loading, const DeckReader *reader)
{
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    bool any = false;
    if (load->type != &strength_reduction_load) continue;
    for (int k = 0; k < d->material_count; ++k) {
      char reason[512] = "";
      Material *m = &d->materials[k];
      if (!material_can_reduce(m)) continue;
      any = true;
      if (material_reduce(m, load->value->number, reason, sizeof reason) ||
          material_reduce(m, 1, reason, sizeof reason))
        return refuse_strength(reader, load, m->name, reason);
    }
    if (!any)
      return node_error(reader->document, load->node, reader->error,
                        "strength reduction: no material has a law that tells how to divide its strengths; expected "
                        "one of mohr-coulomb, drucker-prager, j2 or multi-yield-j2");
  }
  return BRECCIA_OK;
}

int domain_check_reduction(const Load *load, double time, const DeckReader *reader)
{
  const double change = load->value->number - 1;
  double factor;
  if (load->type != &strength_reduction_load || history_least(&load->history, change, time, &factor) > 0)
    return BRECCIA_OK;
  return node_error(
      reader->document, load->history.value_node, reader->error,
      "%s: the history comes to %.4g, where the factor 1 + (%g - 1) %.4g is not above 0; strengths are divided by it",
      load->history.value_node->key, factor, load->value->number, factor);
}

void domain_tell_strength(Domain *d, double time)
{
  const double least = 1e-6;
  if (!d->strains.loading) return;
  const double factor = fmax(least, loading_strength_reduction(d->strains.loading, d->strains.loading->stage, time));
  bool changed = false;
  for (int k = 0; k < d->material_count; ++k) {
    Material *m = &d->materials[k];
    char reason[512];
    if (!material_can_reduce(m) || m->reduction == factor) continue;
    changed |= !material_reduce(m, factor, reason, sizeof reason); /* between factors that were tried */
  }
  for (int r = 0; changed && r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    if (region->type->take_strengths) region->type->take_strengths(region->formulation);
  }
}
