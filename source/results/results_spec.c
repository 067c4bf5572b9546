#include "results/results_spec.h"

static const char *precision_word(int k)
{
  static const char *const words[] = {"single", "double", NULL};
  return words[k];
}

static const Field results_fields[] = {
    {"fields", FIELD_TEXTS, offsetof(ResultsSpec, fields), NULL, "", NULL,
     "what is written of each particle (see the list of fields); when absent: displacement, velocity, stress, "
     "octahedral shear stress, mean stress, damage",
     NULL, NULL, 0},
    {"precision", FIELD_CHOICE, offsetof(ResultsSpec, precision), NULL, "single", NULL, "of numbers in the result file",
     NULL, precision_word, 0},
    {"number", FIELD_COUNT, offsetof(ResultsSpec, number), NULL, "20", "[0, 1e6]",
     "how many states are written, evenly over the run, besides the first and those that pictures ask for", NULL, NULL,
     0},
    {"every", FIELD_COUNT, offsetof(ResultsSpec, every), NULL, "", "[1, inf)", "instead: one in so many steps", NULL,
     NULL, 0},
    {"times", FIELD_NUMBERS, offsetof(ResultsSpec, times), "time", "", "[0, inf)", "further times to write", NULL, NULL,
     0},
    {"checkpoint steps", FIELD_COUNT, offsetof(ResultsSpec, checkpoint_steps), NULL, "", "[1, inf)",
     "a checkpoint every so many steps", NULL, NULL, 0},
    {"checkpoint seconds", FIELD_NUMBER, offsetof(ResultsSpec, checkpoint_seconds), "1", "300", "(0, inf)",
     "a checkpoint every so many seconds of computing", NULL, NULL, 0},
};
const Section results_section = {
    "results", "What is kept of a run, and how often.", sizeof(ResultsSpec), FIELDS(results_fields), NULL, NULL, NULL,
    0};

const char *const standard_fields[] = {"displacement", "velocity", "stress", "octahedral shear stress",
                                       "mean stress",  "damage",   NULL};
