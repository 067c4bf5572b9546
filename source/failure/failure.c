#include "failure/failure.h"

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

static const Field failure_fields[] = {
    {"critical stretch", FIELD_NUMBER, offsetof(FailureSpec, critical_stretch), "1", "", "(0, inf)",
     "a bond that is stretched by more than this share of its length breaks for good", NULL, NULL, 0},
    {"fracture energy", FIELD_NUMBER, offsetof(FailureSpec, fracture_energy), "fracture energy", "", "(0, inf)",
     "G_F, from which the critical stretch of bond-based peridynamics follows", NULL, NULL, 0},
    {"failed laws", FIELD_CHOICE, offsetof(FailureSpec, failed_laws), NULL, "stop", NULL,
     "what happens to a particle whose law cannot be integrated: the run stops there, or all its bonds break", NULL,
     failed_laws_word, 0},
    {"near grips", FIELD_CHOICE, offsetof(FailureSpec, near_grips), NULL, "", NULL,
     "bonds between particles that are moved by a load or stand within a horizon of such: they break as everywhere, or "
     "hold "
     "whatever their stretch; when absent they break, and `breccia check` warns",
     NULL, near_grips_word, 0},
};
const Section failure_section = {"failure",
                                 "When bonds break. Without this section, or with nothing in it, they never do.",
                                 sizeof(FailureSpec),
                                 FIELDS(failure_fields),
                                 NULL,
                                 NULL,
                                 NULL,
                                 0};
