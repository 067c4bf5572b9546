#include "constitutive/normal_lengths.h"

#include "constitutive/material.h"
#include "constitutive/solid/damage_plasticity.h"
#include "constitutive/solid/link_law.h"
#include "constitutive/solid/mazars.h"

extern const breccia_law law_mazars, law_link_damage, law_damage_plasticity;

static const struct {
  const breccia_law *law;
  void (*take)(void *constants, const NormalLengths *lengths);
  double (*longest)(const void *constants); /* NULL: no bound */
} normal_lengths_laws[] = {{&law_mazars, mazars_take_lengths, NULL},
                           {&law_link_damage, link_damage_take_lengths, NULL},
                           {&law_damage_plasticity, damage_plasticity_take_lengths, damage_plasticity_longest}};

bool normal_lengths_give(const Material *material, const NormalLengths *lengths)
{
  for (size_t k = 0; k < sizeof normal_lengths_laws / sizeof *normal_lengths_laws; ++k) {
    if (normal_lengths_laws[k].law != material->law) continue;
    if (lengths) normal_lengths_laws[k].take(material->constants, lengths);
    return true;
  }
  return false;
}

double normal_lengths_longest(const Material *material)
{
  for (size_t k = 0; k < sizeof normal_lengths_laws / sizeof *normal_lengths_laws; ++k)
    if (normal_lengths_laws[k].law == material->law && normal_lengths_laws[k].longest)
      return normal_lengths_laws[k].longest(material->constants);
  return INFINITY;
}
