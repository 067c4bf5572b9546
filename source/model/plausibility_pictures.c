/* Pictures that can show nothing of what is meant. */
#include "model/plausibility_parts.h"

#include "results/fields.h"
#include "results/picture.h"
#include <string.h>

/** The first part of a law's history that is called damage. @return whether there is one */
static bool find_damage_of_law(const Material *m, char *word, size_t size)
{
  for (int k = 0; m->law->history_name && k < m->history_values; ++k) {
    *word = 0;
    m->law->history_name(m->constants, k, word, size);
    if (strstr(word, "damage")) return true;
  }
  return false;
}

/** 'damage' is the share of bonds that are broken: nothing where laws soften and no bond breaks. */
static void check_damage(breccia_model *model, const PictureSpec *picture)
{
  const Domain *d = &model->domain;
  char word[64];
  if (!picture->field || strcmp(picture->field, "damage") || d->failure.criterion) return;
  for (int k = 0; k < d->material_count; ++k)
    if (d->materials[k].law->components == 6 && find_damage_of_law(&d->materials[k], word, sizeof word)) {
      plausibility_say(
          model, section_node(picture, "field"),
          "field: 'damage' is the broken share of bonds, and no bond breaks here; take '%s', that of material '%s'",
          word, d->materials[k].name);
      return;
    }
}

void plausibility_warn_of_pictures(breccia_model *model)
{
  const SectionList *pictures = &model->spec->pictures;
  for (int k = 0; k < pictures->count; ++k) check_damage(model, pictures->items[k]);
}
