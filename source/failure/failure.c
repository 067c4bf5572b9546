#include "failure/failure.h"

#include <math.h>
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
  return criteria[spec ? spec->criterion : 0];
}

bool failure_is_longer(const Family *f, int64_t place, const Bond *bond)
{
  const double natural = particles_free_strain(f->particles, place, bond->neighbour);
  double along = 0;
  for (int k = 0; k < 3; ++k) {
    const double *u = f->particles->displacement.row[k], eta = u[bond->neighbour] - u[place];
    along += eta * (2 * bond->xi[k] + eta);
  }
  return along > natural * (2 + natural) * bond->length * bond->length;
}

double failure_stretch(const Family *f, int64_t place, const Bond *bond)
{
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double *u = f->particles->displacement.row[k], y = bond->xi[k] + u[bond->neighbour] - u[place];
    square += y * y;
  }
  return sqrt(square) / bond->length - 1 - particles_free_strain(f->particles, place, bond->neighbour);
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

static const Field no_failure_fields[] = {
    {.key = "of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(NoFailureSpec, of),
     .standard = "",
     .meaning = "these particles; when absent those whose motion loads prescribe",
     .section = &selection_section},
    {.key = "distance",
     .kind = FIELD_LENGTH,
     .offset = offsetof(NoFailureSpec, distance),
     .dimension = "length",
     .standard = "0",
     .range = "[0, inf)",
     .meaning = "and all particles that stood no further from one of them"},
};

static const Section no_failure_section = {
    .name = "no failure within",
    .about = "Particles among which no bond breaks, whatever its stretch. Laws that soften still do.",
    .size = sizeof(NoFailureSpec),
    FIELDS(no_failure_fields)};

static const Field failure_fields[] = {
    {.key = "criterion",
     .kind = FIELD_CHOICE,
     .offset = offsetof(FailureSpec, criterion),
     .standard = "critical stretch",
     .meaning = "when a bond breaks",
     .choice = criterion_word},
    {.key = "criterion",
     .kind = FIELD_CHOSEN,
     .offset = offsetof(FailureSpec, keys),
     .standard = "",
     .meaning = "keys of the criterion",
     .section = &criterion_choice.section},
    {.key = "failed laws",
     .kind = FIELD_CHOICE,
     .offset = offsetof(FailureSpec, failed_laws),
     .standard = "stop",
     .meaning =
         "what happens to a particle whose law cannot be integrated: the run stops there, or all its bonds break",
     .words = (const char *const[]){[FAILED_LAWS_STOP] = "stop", [FAILED_LAWS_BREAK] = "break", NULL}},
    {.key = "near grips",
     .kind = FIELD_CHOICE,
     .offset = offsetof(FailureSpec, near_grips),
     .standard = "",
     .meaning = "bonds between particles that are moved by a load or stand within a horizon of such: they break as "
                "everywhere, or hold whatever their stretch; when absent they break, and `breccia check` warns",
     .words = (const char *const[]){[NEAR_GRIPS_BREAK] = "break", [NEAR_GRIPS_HOLD] = "hold", NULL}},
    {.key = "no failure within",
     .kind = FIELD_ONE_OR_SECTIONS,
     .offset = offsetof(FailureSpec, nowhere),
     .standard = "",
     .meaning = "particles among which no bond breaks",
     .section = &no_failure_section},
};

const Section failure_section = {.name = "failure",
                                 .about =
                                     "When bonds break. Without this section, or with nothing in it, they never do.",
                                 .size = sizeof(FailureSpec),
                                 FIELDS(failure_fields)};
