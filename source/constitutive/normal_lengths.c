#include "constitutive/normal_lengths.h"

#include "constitutive/material.h"
#include "constitutive/solid/damage_plasticity.h"
#include "constitutive/solid/link_law.h"
#include "constitutive/solid/mazars.h"

extern const breccia_law law_mazars, law_link_damage, law_damage_plasticity;

static const struct {
  const breccia_law *law;
  void (*take)(void *constants, const NormalLengths *lengths);
} normal_lengths_laws[] = {{&law_mazars, mazars_take_lengths},
                           {&law_link_damage, link_damage_take_lengths},
                           {&law_damage_plasticity, damage_plasticity_take_lengths}};

bool normal_lengths_give(const Material *material, const NormalLengths *lengths)
{
  for (size_t k = 0; k < sizeof normal_lengths_laws / sizeof *normal_lengths_laws; ++k) {
    if (normal_lengths_laws[k].law != material->law) continue;
    if (lengths) normal_lengths_laws[k].take(material->constants, lengths);
    return true;
  }
  return false;
}
