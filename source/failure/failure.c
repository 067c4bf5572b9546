#include "failure/failure.h"

#include <string.h>

#define CRITERION(name) extern const Criterion criterion_##name;
#include "failure/criteria.h"
#undef CRITERION

static const Criterion *const criteria[] = {
#define CRITERION(name) &criterion_##name,
#include "failure/criteria.h"
#undef CRITERION
};
enum { COUNT = sizeof criteria / sizeof *criteria };

const Criterion *criterion_at(int k)
{
  return k < COUNT ? criteria[k] : NULL;
}

const Criterion *criterion_of(const FailureSpec *spec)
{
  for (int k = 0; spec && k < COUNT; ++k)
    if (!strcmp(criteria[k]->name, spec->criterion)) return criteria[k];
  return criteria[0];
}

static const char *criterion_word(int k)
{
  return k < COUNT ? criteria[k]->name : NULL;
}
static const Section *criterion_keys(int k)
{
  return criteria[k]->section;
}
static const SectionChoice criterion_choice = {
    .section = {.name = "criterion"}, .chosen = criterion_keys, .word = criterion_word};

static const char *failed_laws_word(int k)
{
  static const char *const words[] = {"stop", "break", NULL};
  return words[k];
}

static const char *near_grips_word(int k)
{
  static const char *const words[] = {"break", "hold", NULL};
  return words[k];
}

static const Field no_failure_fields[] = {
    {"of", FIELD_REFERENCE, offsetof(NoFailureSpec, of), NULL, "", NULL,
     "these particles; when absent those whose motion loads prescribe", &selection_section, NULL, 0},
    {"distance", FIELD_LENGTH, offsetof(NoFailureSpec, distance), "length", "0", "[0, inf)",
     "and all particles that stood no further from one of them", NULL, NULL, 0},
};
static const Section no_failure_section = {"no failure within",
                                           "Particles among which no bond breaks, whatever its stretch. Laws that "
                                           "soften still do.",
                                           sizeof(NoFailureSpec),
                                           FIELDS(no_failure_fields),
                                           NULL,
                                           NULL,
                                           NULL,
                                           0};

static const Field failure_fields[] = {
    {"criterion", FIELD_CHOICE, offsetof(FailureSpec, criterion), NULL, "critical stretch", NULL, "when a bond breaks",
     NULL, criterion_word, 0},
    {"criterion", FIELD_CHOSEN, offsetof(FailureSpec, keys), NULL, "", NULL, "keys of the criterion",
     &criterion_choice.section, NULL, 0},
    {"failed laws", FIELD_CHOICE, offsetof(FailureSpec, failed_laws), NULL, "stop", NULL,
     "what happens to a particle whose law cannot be integrated: the run stops there, or all its bonds break", NULL,
     failed_laws_word, 0},
    {"near grips", FIELD_CHOICE, offsetof(FailureSpec, near_grips), NULL, "", NULL,
     "bonds between particles that are moved by a load or stand within a horizon of such: they break as everywhere, or "
     "hold "
     "whatever their stretch; when absent they break, and `breccia check` warns",
     NULL, near_grips_word, 0},
    {"no failure within", FIELD_ONE_OR_SECTIONS, offsetof(FailureSpec, nowhere), NULL, "", NULL,
     "particles among which no bond breaks", &no_failure_section, NULL, 0},
};
const Section failure_section = {"failure",
                                 "When bonds break. Without this section, or with nothing in it, they never do.",
                                 sizeof(FailureSpec),
                                 FIELDS(failure_fields),
                                 NULL,
                                 NULL,
                                 NULL,
                                 0};
