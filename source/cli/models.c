#include "cli/verbs.h"
#include "constitutive/law.h"
#include "deck/section.h"
#include "formulation/formulation.h"

#include <string.h>

static const Option options[] = {{0}};

static void print_law(const breccia_law *law)
{
  printf("%s: %s\n  source: %s\n  %s\n", law->name, law->about, law->source, law->maturity);
  for (int k = 0; k < law->parameter_count; ++k) {
    const breccia_parameter *p = &law->parameters[k];
    const Dimension *dimension = dimension_find(p->dimension);
    char range[128] = "";
    if (p->range) interval_describe(p->range, range, sizeof range);
    printf("  %-24s %-10s %-10s %s%s%s%s\n", p->name, *dimension->example ? dimension->example : "-",
           !p->standard   ? "required"
           : *p->standard ? p->standard
                          : "optional",
           p->meaning, *range ? "; " : "", range, "");
  }
}

static int run(int argc, char **argv, const Verb *verb)
{
  int first = read_options(argc, argv, verb, NULL, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (first < argc) {
    const breccia_law *law = law_find(NULL, argv[first]);
    if (!law) {
      fprintf(stderr, "breccia models: there is no model '%s'; 'breccia models' lists them\n", argv[first]);
      return 2;
    }
    print_law(law);
    return 0;
  }
  printf("Constitutive models (parameter, unit, default, meaning):\n\n");
  for (int k = 0; law_at(NULL, k); ++k) {
    print_law(law_at(NULL, k));
    printf("\n");
  }
  printf("Formulations:\n\n");
  for (int k = 0; formulation_at(k); ++k) {
    const FormulationType *f = formulation_at(k);
    printf("%s: %s\n  source: %s\n  %s\n", f->name, f->about, f->source, f->maturity);
  }
  return 0;
}

const Verb verb_models = {"models", "[MODEL]", "list constitutive models and formulations with their parameters",
                          options,  NULL,      run};
