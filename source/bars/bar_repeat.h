/* Bars that a deck gives once and that lie side by side at a pitch: stirrups along a beam, meshes. */
#ifndef BRECCIA_BARS_BAR_REPEAT_H
#define BRECCIA_BARS_BAR_REPEAT_H

#include "deck/section.h"

/** Bars at a pitch along one direction. */
typedef struct RepeatSpec {
  SectionHead head;
  double along[3], pitch;
  int64_t number; /* number of lines, the first included; -1: 'over' is given */
  double over;    /* length from the first line to the end; NaN: 'number' is given */
  int last_gap;   /* index of its word: spacing of the last lines where `over` is no multiple of the pitch */
} RepeatSpec;

extern const Section repeat_section;

/** The bars of a deck as they lie: each as often as it is repeated, in the order of the deck. */
typedef struct BarLines {
  const SectionList *deck; /* borrowed */
  SectionList specs;       /* BarSpec; those of a bar that is repeated have names of their own, 'stirrups 3' */
  int *first;              /* [deck->count + 1] lines of a bar of the deck */
} BarLines;

/** How many lines a repetition makes: 1 more than gaps. */
int64_t repeat_lines(const RepeatSpec *repeat);
/** How far a line stands from the first, along the direction. @param[in] line  0: the first */
double repeat_offset(const RepeatSpec *repeat, int64_t line);

/** @return false: no memory */
bool bar_lines_create(BarLines *lines, const SectionList *deck);
void bar_lines_destroy(BarLines *lines);

#endif
