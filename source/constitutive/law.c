#include "constitutive/law.h"

#include "deck/spelling.h"

#include <string.h>

#define LAW(name) extern const breccia_law law_##name;
#include "constitutive/laws.h"
#undef LAW

static const breccia_law *const laws[] = {
#define LAW(name) &law_##name,
#include "constitutive/laws.h"
#undef LAW
};
enum { COUNT = sizeof laws / sizeof *laws };

const breccia_law *law_at(const LawList *list, int k)
{
  if (k < COUNT) return laws[k];
  return list && k - COUNT < list->own_count ? list->own[k - COUNT] : NULL;
}

const breccia_law *law_find(const LawList *list, const char *name)
{
  for (int k = 0; law_at(list, k); ++k)
    if (!strcmp(law_at(list, k)->name, name)) return law_at(list, k);
  return NULL;
}

void law_advice(const LawList *list, const char *given, Text *text)
{
  enum { MOST = 128 };
  const char *names[MOST];
  int count = 0;
  for (const breccia_law *law; count < MOST && (law = law_at(list, count)); ++count) names[count] = law->name;
  spelling_advice(text, given, names, count, "the models are");
  if (spelling_nearest(given, names, count)) text_add(text, "; 'breccia models' lists all");
}
