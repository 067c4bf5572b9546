/* The section "results" of a deck. */
#ifndef BRECCIA_RESULTS_RESULTS_SPEC_H
#define BRECCIA_RESULTS_RESULTS_SPEC_H

#include "deck/section.h"

typedef enum Precision { PRECISION_SINGLE, PRECISION_DOUBLE } Precision;

typedef struct ResultsSpec {
  SectionHead head;
  TextList fields;
  int precision; /* Precision */
  int64_t number, every;
  NumberList times;
  int64_t checkpoint_steps;
  double checkpoint_seconds;
} ResultsSpec;

extern const Section results_section;

/** Fields written when the deck names none. */
extern const char *const standard_fields[];

#endif
