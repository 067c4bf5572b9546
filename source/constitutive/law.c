#include "constitutive/law.h"

#include "deck/interval.h"
#include "deck/quantity.h"
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
  if (k < 0) return NULL;
  if (k < COUNT) return laws[k];
  return list && k - COUNT < list->own_count ? list->own[k - COUNT] : NULL;
}

const breccia_law *law_find(const LawList *list, const char *name)
{
  for (int k = 0; law_at(list, k); ++k)
    if (!strcmp(law_at(list, k)->name, name)) return law_at(list, k);
  return NULL;
}

/** Describes what is wrong with a parameter of a law. @return NULL: nothing */
static const char *law_parameter_problem(const breccia_parameter *p)
{
  if (!p->name || !*p->name) return "has no name";
  if (!p->meaning) return "has no meaning";
  if (!p->dimension || !dimension_find(p->dimension)) return "has a dimension that is none of those of docs/deck.md";
  if (p->range && !interval_is_valid(p->range)) return "has a range that is no interval like '(0, inf)' or '[0, 1)'";
  return NULL;
}

bool law_refuse(const breccia_law *law, Error *error)
{
  enum { MOST_PARAMETERS = 100 };
  const char *name = law->name ? law->name : "";
  if (!*name || !law->about || !law->source || !law->maturity || !law->prepare || !law->moduli || !law->update ||
      (law->components != 1 && law->components != 6)) {
    error_add(error, BRECCIA_USER_ERROR,
              "law '%s' needs name, about, source, maturity, components (1 or 6), prepare, moduli and update", name);
    return true;
  }
  if (law->parameter_count < 0 || law->parameter_count > MOST_PARAMETERS ||
      (law->parameter_count > 0 && !law->parameters)) {
    error_add(error, BRECCIA_USER_ERROR, "law '%s': it has %d parameters%s; expected 0 to %d, and a table of them",
              name, law->parameter_count, law->parameters ? "" : ", and their table is NULL", MOST_PARAMETERS);
    return true;
  }
  for (int k = 0; k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    const char *problem = law_parameter_problem(p);
    if (!problem) continue;
    error_add(error, BRECCIA_USER_ERROR, "law '%s': parameter %d, '%s', %s", name, k + 1, p->name ? p->name : "",
              problem);
    return true;
  }
  return false;
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
