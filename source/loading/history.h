/* How a load varies in time: a factor on its value. */
#ifndef BRECCIA_LOADING_HISTORY_H
#define BRECCIA_LOADING_HISTORY_H

#include "deck/section.h"

typedef struct SineSpec {
  SectionHead head;
  double frequency, phase;
} SineSpec;

typedef struct HistorySpec { /* exactly one is given */
  SectionHead head;
  double ramp;
  bool constant;
  NumberList table;
  SineSpec *sine;
} HistorySpec;

extern const Section history_section;

/** Factor at a time; `spec` NULL is constant 1. */
double history_factor(const HistorySpec *spec, double time);

#endif
