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
  bool (*damaged)(const void *constants, const double *history);
  int length; /* index of l in the history */
} normal_lengths_laws[] = {{&law_mazars, mazars_take_lengths, NULL, mazars_is_damaged, MAZARS_LENGTH},
                           {&law_link_damage, link_damage_take_lengths, NULL, link_damage_is_damaged, LINK_LENGTH},
                           {&law_damage_plasticity, damage_plasticity_take_lengths, damage_plasticity_longest,
                            damage_plasticity_is_damaged, PLASTIC_LENGTH}};

/** Returns the index of the law of a material in normal_lengths_laws; -1 if the law accepts no lengths. */
static int normal_lengths_find(const Material *material)
{
  for (size_t k = 0; k < sizeof normal_lengths_laws / sizeof *normal_lengths_laws; ++k)
    if (normal_lengths_laws[k].law == material->law) return (int)k;
  return -1;
}

bool normal_lengths_give(const Material *material, const NormalLengths *lengths)
{
  const int k = normal_lengths_find(material);
  if (k >= 0 && lengths) normal_lengths_laws[k].take(material->constants, lengths);
  return k >= 0;
}

double normal_lengths_longest(const Material *material)
{
  const int k = normal_lengths_find(material);
  return k >= 0 && normal_lengths_laws[k].longest ? normal_lengths_laws[k].longest(material->constants) : INFINITY;
}

bool normal_lengths_take(const Material *material, const double *trial, double *committed)
{
  const int length = normal_lengths_laws[normal_lengths_find(material)].length;
  if (committed[length] > 0 || !(trial[length] > 0)) return false;
  committed[length] = trial[length];
  return true;
}

void normal_lengths_drop(const Material *material, double *committed)
{
  const int k = normal_lengths_find(material);
  double *length = &committed[normal_lengths_laws[k].length];
  /* A length of 0 is not written: pages of zeros that nobody has written occupy no memory. */
  if (*length > 0 && !normal_lengths_laws[k].damaged(material->constants, committed)) *length = 0;
}
