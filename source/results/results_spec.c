#include "results/results_spec.h"

static const char *precision_word(int k)
{
  static const char *const words[] = {"single", "double", NULL};
  return words[k];
}

static const Field results_fields[] = {
    {.key = "fields",
     .kind = FIELD_TEXTS,
     .offset = offsetof(ResultsSpec, fields),
     .standard = "",
     .meaning =
         "what is written of each particle (see the list of fields); when absent: displacement, velocity, stress, "
         "octahedral shear stress, mean stress, damage"},
    {.key = "precision",
     .kind = FIELD_CHOICE,
     .offset = offsetof(ResultsSpec, precision),
     .standard = "single",
     .meaning = "of numbers in the result file",
     .choice = precision_word},
    {.key = "number",
     .kind = FIELD_COUNT,
     .offset = offsetof(ResultsSpec, number),
     .standard = "20",
     .range = "[0, 1e6]",
     .meaning = "how many states are written, evenly over the run, besides the first and those that pictures ask for"},
    {.key = "every",
     .kind = FIELD_COUNT,
     .offset = offsetof(ResultsSpec, every),
     .standard = "",
     .range = "[1, inf)",
     .meaning = "instead: one in so many steps"},
    {.key = "times",
     .kind = FIELD_NUMBERS,
     .offset = offsetof(ResultsSpec, times),
     .dimension = "time",
     .standard = "",
     .range = "[0, inf)",
     .meaning = "further times to write"},
    {.key = "checkpoint steps",
     .kind = FIELD_COUNT,
     .offset = offsetof(ResultsSpec, checkpoint_steps),
     .standard = "",
     .range = "[1, inf)",
     .meaning = "a checkpoint every so many steps"},
    {.key = "checkpoint seconds",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ResultsSpec, checkpoint_seconds),
     .dimension = "1",
     .standard = "300",
     .range = "(0, inf)",
     .meaning = "a checkpoint every so many seconds of computing"},
};
const Section results_section = {.name = "results",
                                 .about = "What is kept of a run, and how often.",
                                 .size = sizeof(ResultsSpec),
                                 FIELDS(results_fields)};

const char *const standard_fields[] = {"displacement", "velocity", "stress", "octahedral shear stress",
                                       "mean stress",  "damage",   NULL};
