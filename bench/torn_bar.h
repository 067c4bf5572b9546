/* A bar of concrete that is pulled apart at rest: what its crack takes beside its fracture energy, by formulation, law and space. */
#ifndef BRECCIA_BENCH_TORN_BAR_H
#define BRECCIA_BENCH_TORN_BAR_H

#include "breccia/breccia.h"

#include <stdbool.h>

/** Where the bar is weaker, so that it opens there. */
typedef enum TornBarWeak {
  WEAK_COLUMN,  /* one column by a tenth: both gaps beside it are alike */
  WEAK_LEANING, /* and the next one by a twentieth: one gap is the weakest */
  WEAK_MIDDLE,  /* five columns by a tenth */
} TornBarWeak;

typedef struct TornBar {
  const char *peridynamics; /* `formulation: ...` and what goes with it */
  const char *law;          /* model and what it takes beside moduli, strength and fracture energy */
  const char *space;
  TornBarWeak weak;
  int rows, increments;
  double pull; /* how far the ends move apart, m */
  bool split;  /* both halves are held, so that a flat crack opens between them and nothing else moves */
} TornBar;

typedef struct TornBarEnd {
  double spent; /* work of the ends over fracture energy and section */
  double left;  /* of the largest load, at the end: mean of the last increment */
  int64_t cuts; /* steps beyond the increments asked for */
} TornBarEnd;

enum { TORN_COLUMNS = 21 };

/** @param[out] opening  of each column and the next one, TORN_COLUMNS - 1 numbers, m; or NULL  @return 0; not 0: `error` tells */
int torn_bar_pull(const TornBar *bar, TornBarEnd *end, double *opening, breccia_error *error);

#endif
