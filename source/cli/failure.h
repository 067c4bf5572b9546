/* The verb 'failure' in parts: the search for the load (failure.c), the verdict on each run (failure_verdict.c), and
 * what is printed and written (failure_report.c). A trial is one run under one load; with seeds a load has several. */
#ifndef BRECCIA_CLI_FAILURE_H
#define BRECCIA_CLI_FAILURE_H

#include "cases.h"
#include "verbs.h"

/** Verdict on a run. DOUBTFUL: it came to rest in a way that says nothing of a real body. */
typedef enum Verdict { BEARS, FAILS, DOUBTFUL, UNKNOWN } Verdict;

/** What decided. */
typedef enum Reason {
  NO_REASON,
  BY_EQUILIBRIUM, /* the run ended before its time */
  BY_FORCES,      /* forces out of balance are too large at the end */
  BY_MOTION,      /* kinetic energy is */
  BY_RATE,        /* displacement grows too fast with the load */
  BY_CONTROL,     /* control of zero-energy modes carries load */
  BY_INVERSION,   /* particles are turned inside out */
  BY_DISTANCE,    /* the body has moved by more than its size */
  BY_ENERGY,      /* energies do not balance */
  REASONS
} Reason;

/** Numbers of summary.json that a trial is judged by and that the table shows; NaN where there is none. */
enum {
  UNBALANCED,   /* forces out of balance over those that act */
  KINETIC,      /* kinetic energy over the work */
  DISPLACEMENT, /* largest, in the deck's unit */
  SIZE,         /* longest side of the body */
  PLASTIC,      /* energy spent over stored and spent */
  CONTROL,      /* of the energy in yielded families, by control of zero-energy modes */
  LASTING,      /* of all stored energy, by control that does not fade, in yielded families */
  HELD,         /* time for which loads have been steady */
  INVERTED,     /* particles */
  IMBALANCE,    /* of energies, over the work */
  REDUCTION,    /* factor by which strengths are divided */
  LOST,         /* strength reduction at which a static run found no equilibrium; NaN: it found all */
  STEP,         /* height of the step in the surface of ground, in spacings */
  EXCESS,       /* estimate of the share by which its factor of safety comes out too high */
  MEASURES
};

typedef struct Trial {
  double load;
  double measure[MEASURES];
  double rate; /* displacement over load, from the next lower load that the body bears, over that of the lowest one */
  Verdict verdict;
  Reason reason;
  bool done;    /* the run came to its end; otherwise why not has been said */
  bool settles; /* it counts as failing, but still came to rest at the end */
  char name[200];
} Trial;

enum { MOST_TRIALS = 512 };

typedef struct Search {
  const char *deck, *folder;
  char key[160], unit[64];
  const char *seed; /* KEY=A, B, ... of seeds; NULL: there are none */
  int seeds;        /* runs under one load */
  double within, rest, rate;
  long long jobs, threads, samples;
  bool again, quiet, rest_given;
  const DeckSettings *settings;
  Trial trials[MOST_TRIALS];
  int count;
} Search;

/** Judges case k of a study by its measures. */
Trial failure_judge(Search *search, const breccia_study *study, int k, double load);
/** Sorts trials by load and compares those that came to rest: where displacement begins to grow too fast with the load,
 * the body gives way. */
void failure_compare(Search *search);
/** Finds the largest load that the body bears below all under which it fails or there is no verdict, and the least of
 * these; INFINITY: none. */
void failure_bracket(const Search *search, double *bears, double *fails);
/** Finds the two adjacent loads between which displacement grows most with the load, and faster than at first.
 * @return false if there are none */
bool failure_steepest(const Search *search, double *low, double *high);
/** Returns the share of the runs under a load that fail or have no verdict. */
double failure_share(const Search *search, double load);
/** Returns what decided, in words for a sentence. */
const char *failure_reason(Reason reason);

/** Prints the table. */
void failure_print(const Search *search);
/** Writes failure.csv, and failure.svg where pictures can be drawn. @return status, after a message */
int failure_write(const Search *search);
/** Prints between which loads the body fails, and what to think of it. */
void failure_tell(const Search *search, double sign);

#endif
