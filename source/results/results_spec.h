/* The section "results" of a deck. */
#ifndef BRECCIA_RESULTS_RESULTS_SPEC_H
#define BRECCIA_RESULTS_RESULTS_SPEC_H

#include "deck/section.h"

typedef struct ResultsSpec {
  SectionHead head;
  TextList fields;
  const char *precision; /* "single" or "double" */
  int64_t number, every;
  NumberList times;
  int64_t checkpoint_steps;
  double checkpoint_seconds;
} ResultsSpec;

extern const Section results_section;

/** Fields written when the deck names none. */
extern const char *const standard_fields[];

#endif
