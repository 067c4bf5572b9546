#include "failure/failure.h"

static const Field failure_fields[] = {
    {"critical stretch", FIELD_NUMBER, offsetof(FailureSpec, critical_stretch), "1", "", "(0, inf)",
     "a bond that is stretched by more than this share of its length breaks for good", NULL, NULL, 0},
    {"fracture energy", FIELD_NUMBER, offsetof(FailureSpec, fracture_energy), "fracture energy", "", "(0, inf)",
     "G_F, from which the critical stretch of bond-based peridynamics follows", NULL, NULL, 0},
};
const Section failure_section = {"failure",
                                 "When bonds break. Without this section, or with nothing in it, they never do.",
                                 sizeof(FailureSpec),
                                 FIELDS(failure_fields),
                                 NULL,
                                 NULL,
                                 NULL,
                                 0};
