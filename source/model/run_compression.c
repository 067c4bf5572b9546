/* The largest compression that materials have borne which fail in tension and in no compression: their laws go on
 * elastically where a real material crushes, so that a run tells what they came to, beside a compressive strength if
 * the deck has one. */
#include "model/run.h"

#include "bars/bars.h"
#include "bars/bond_law.h"
#include "base/memory.h"
#include "base/tensor.h"
#include <math.h>
#include <string.h>

/** True if bonds of a material break, and in tension only. */
static bool compression_leaves_bonds(const breccia_model *model, int k)
{
  const Failure *failure = &model->domain.failure;
  return failure->criterion && isfinite(failure->limit[k]) &&
         !node_get(model->spec->failure->head.node, "bond shear strength");
}

bool model_never_crushes(const breccia_model *model, int k)
{
  const Material *m = &model->domain.materials[k];
  const bool fails = isfinite(material_failure_strain(m)) || m->softening_energy > 0 || m->law->link ||
                     compression_leaves_bonds(model, k);
  return fails && m->law->never_crushes && m->law->never_crushes(m->constants);
}

int model_make_compressions(breccia_model *model, Error *error)
{
  bool any = false;
  for (int k = 0; k < model->domain.material_count; ++k) any |= model_never_crushes(model, k);
  if (!any) return BRECCIA_OK;
  Compressions *c = &model->compressions;
  const size_t count = (size_t)model->domain.material_count;
  c->stress = memory_zeroed(count, sizeof *c->stress, "compressions", error);
  c->at = memory_zeroed(count, sizeof *c->at, "compressions", error);
  return c->stress && c->at ? BRECCIA_OK : BRECCIA_FAILURE;
}

void model_forget_compressions(breccia_model *model)
{
  const Compressions *c = &model->compressions;
  const size_t count = (size_t)model->domain.material_count;
  if (!c->stress) return;
  memset(c->stress, 0, count * sizeof *c->stress);
  memset(c->at, 0, count * sizeof *c->at);
}

/** A bound below all principal stresses, without a decomposition. */
static double compression_bound(const double s[6])
{
  const double mean = (s[XX] + s[YY] + s[ZZ]) / 3;
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += (s[k] - mean) * (s[k] - mean) / 2 + s[k + 3] * s[k + 3];
  return mean - 2 * sqrt(squares / 3);
}

void model_note_compression(breccia_model *model, int32_t place, const double stress[6])
{
  const Domain *d = &model->domain;
  const Compressions *c = &model->compressions;
  const int32_t m = d->material[place / SLICE];
  if (!c->stress || !(compression_bound(stress) < c->stress[m]) || !model_never_crushes(model, m)) return;
  double value[3], vector[9];
  tensor_eigen(stress, value, vector);
  const double least = fmin(value[0], fmin(value[1], value[2]));
  if (!(least < c->stress[m])) return;
  c->stress[m] = least;
  for (int k = 0; k < 3; ++k) c->at[m][k] = d->particles->position[k][place];
}

/** The compressive strength that bond of bars has in the deck, that of the concrete around them; NaN: there is none. */
static double compression_strength(const breccia_model *model)
{
  const Bars *bars = bars_among(&model->domain.forces);
  double strength = NAN;
  for (int n = 0; bars && n < bars->lines.deck->count; ++n) {
    const BondSpec *bond = ((const BarSpec *)bars->lines.deck->items[n])->bond;
    if (bond) strength = fmin(strength, bond->strength);
  }
  return strength;
}

void run_add_compressions(const breccia_model *model, Text *t)
{
  const Domain *d = &model->domain;
  bool told = false;
  if (!model->compressions.stress) return;
  text_add(t, "  \"largest_compressions\": [");
  for (int k = 0; k < d->material_count; ++k) {
    const double *at = model->compressions.at[k];
    if (!model_never_crushes(model, k)) continue;
    text_add(t, "%s{\"material\": ", told ? ", " : "");
    text_add_json(t, d->materials[k].name);
    text_add(t, ", \"compression\": %.10g, \"at\": [%.10g, %.10g, %.10g]}", -model->compressions.stress[k], at[0],
             at[1], at[2]);
    told = true;
  }
  text_add(t, "],\n");
}

/** Adds the names of uniaxial laws that crush, as a remedy for a law that does not. */
static void compression_add_remedy(const breccia_law *law, Text *t)
{
  bool any = false;
  for (int k = 0; law->components == 1 && breccia_law_at(k); ++k) {
    const breccia_law *other = breccia_law_at(k);
    if (!other->compressive_strength || other->components != 1) continue;
    text_add(t, "%s'%s'", any ? ", " : "; a law that crushes: ", other->name);
    any = true;
  }
}

static void compression_tell(const breccia_model *model, int k, double strength, const char *length, Text *t)
{
  const Material *m = &model->domain.materials[k];
  const double largest = -model->compressions.stress[k], *at = model->compressions.at[k];
  const double in_si = units_in_si(model->units, dimension_find("stress"), 1);
  text_add(t, "material '%s' cannot crush ('%s' is elastic in compression): the largest compression is ", m->name,
           m->law_name);
  quantity_describe(in_si * largest, "Pa", t);
  text_add(t, ", at [%.4g, %.4g, %.4g] %s", at[0], at[1], at[2], length);
  if (!isnan(strength)) {
    text_add(t, "; bond of bars is given a compressive strength of ");
    quantity_describe(in_si * strength, "Pa", t);
    text_add(t, "%s", largest > strength ? ", at which the concrete would have CRUSHED" : "");
    if (largest > strength) compression_add_remedy(m->law, t);
  }
  text_add(t, "\n");
}

void run_tell_compressions(const breccia_model *model, Text *t)
{
  char length[64];
  units_name(model->units, dimension_find("length"), length, sizeof length);
  const double strength = compression_strength(model);
  for (int k = 0; model->compressions.stress && k < model->domain.material_count; ++k)
    if (model_never_crushes(model, k) && model->compressions.stress[k] < 0)
      compression_tell(model, k, strength, length, t);
}
