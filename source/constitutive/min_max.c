#include "constitutive/min_max.h"

#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct MinMax {
  Material base; /* owned by the material around it */
  double smallest, largest;
} MinMax;

/* A row of history is that of the law inside and, last, 1 for a point that failed. */

static void release(void *constants)
{
  material_destroy(&((MinMax *)constants)->base);
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  const MinMax *c = constants;
  *bulk = c->base.bulk;
  *shear = c->base.shear;
}

static double failure_strain(const void *constants)
{
  const MinMax *c = constants;
  return fmin(c->largest, material_failure_strain(&c->base));
}

static int history_values(const void *constants)
{
  return ((const MinMax *)constants)->base.history_values + 1;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  const MinMax *c = constants;
  if (k == c->base.history_values)
    snprintf(name, size, "failed");
  else if (c->base.law->history_name)
    c->base.law->history_name(c->base.constants, k, name, size);
  else
    *name = 0;
}

static const char *history_dimension(const void *constants, int k)
{
  const MinMax *c = constants;
  const bool own = k == c->base.history_values;
  return own || !c->base.law->history_dimension ? "" : c->base.law->history_dimension(c->base.constants, k);
}

static int history_is_damage(const void *constants, int k)
{
  const MinMax *c = constants;
  if (k == c->base.history_values) return 1;
  return c->base.law->history_is_damage && c->base.law->history_is_damage(c->base.constants, k);
}

static int never_crushes(const void *constants)
{
  const MinMax *c = constants;
  return isinf(c->smallest) && c->base.law->never_crushes && c->base.law->never_crushes(c->base.constants);
}

static void begin(const void *constants, double *history)
{
  const MinMax *c = constants;
  history[c->base.history_values] = 0;
  if (c->base.law->begin) c->base.law->begin(c->base.constants, history);
}

static void begin_point(const void *constants, const breccia_place *place, double *history)
{
  const MinMax *c = constants;
  history[c->base.history_values] = 0;
  if (c->base.law->begin_point)
    c->base.law->begin_point(c->base.constants, place, history);
  else if (c->base.law->begin)
    c->base.law->begin(c->base.constants, history);
}

static int update(const void *constants, const breccia_batch *batch)
{
  const MinMax *c = constants;
  const int last = c->base.history_values;
  for (int i = 0; i < batch->count; ++i) {
    const double *old = batch->committed + (ptrdiff_t)(last + 1) * i, strain = batch->strain[0][i];
    double *new = batch->trial + (ptrdiff_t)(last + 1) * i;
    const bool failed = old[last] > 0 || (!batch->elastic_stage && (strain < c->smallest || strain > c->largest));
    new[last] = failed;
    if (failed) {
      memcpy(new, old, sizeof(double) * (size_t)last);
      batch->stress[0][i] = 0;
      if (batch->tangent) batch->tangent[i] = 0;
      continue;
    }
    breccia_batch one = *batch;
    batch_places_from(&one, i);
    one.count = 1;
    one.strain[0] += i;
    one.stress[0] += i;
    one.committed = old;
    one.trial = new;
    if (one.tangent) one.tangent += i;
    if (one.length) one.length += i;
    if (one.lateral) one.lateral += i;
    if (material_update(&c->base, &one) >= 0) return i;
  }
  return -1;
}

const breccia_law law_min_max = {
    .size = sizeof(breccia_law),
    .name = "min-max",
    .about = "another law of one strain, whose points fail for good outside a range of strains",
    .source = "MinMax of OpenSees",
    .maturity = "verified against its definition",
    .constants_size = sizeof(MinMax),
    .release = release,
    .components = 1,
    .moduli = moduli,
    .failure_strain = failure_strain,
    .history_values = history_values,
    .history_name = history_name,
    .history_dimension = history_dimension,
    .history_is_damage = history_is_damage,
    .never_crushes = never_crushes,
    .begin = begin,
    .begin_point = begin_point,
    .update = update,
};

bool material_is_beyond_limits(const Material *material, const double *history)
{
  return material->law == &law_min_max && history[material->history_values - 1] > 0;
}

/** Returns the material without its limits of strain. */
static const Material *min_max_base(const Material *material)
{
  return material->law == &law_min_max ? &((const MinMax *)material->constants)->base : material;
}

bool material_takes_lateral(const Material *material)
{
  return min_max_base(material)->law->takes_lateral != 0;
}

bool material_takes_places(const Material *material)
{
  const breccia_law *law = min_max_base(material)->law;
  return !material->remote && (law->takes_places || law->begin_point);
}

int material_confined_history(const Material *material)
{
  return material->remote ? 0 : min_max_base(material)->law->confined_history;
}

double material_compressive_strength(const Material *material)
{
  const Material *base = min_max_base(material);
  return base->law->compressive_strength ? base->law->compressive_strength(base->constants) : NAN;
}

int material_limit(Material *material, double smallest, double largest, char *reason, size_t size)
{
  if (isnan(smallest) && isnan(largest)) return BRECCIA_OK;
  const bool uniaxial = material->law->components == 1;
  MinMax *c = uniaxial ? memory_plain(1, sizeof *c) : NULL;
  if (!c) {
    snprintf(reason, size, "%s",
             uniaxial ? "out of memory" : "'smallest strain' and 'largest strain' are for laws of one strain");
    material_destroy(material);
    return uniaxial ? BRECCIA_FAILURE : BRECCIA_USER_ERROR;
  }
  c->base = *material;
  material->values = NULL; /* owned by the base material */
  c->smallest = isnan(smallest) ? -INFINITY : smallest;
  c->largest = isnan(largest) ? INFINITY : largest;
  material->law = &law_min_max;
  material->constants = c;
  material->history_values = law_min_max.history_values(c);
  return BRECCIA_OK;
}

Material *material_within_limits(const Material *material)
{
  return material->law == &law_min_max ? &((MinMax *)material->constants)->base : NULL;
}
