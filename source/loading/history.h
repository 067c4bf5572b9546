/* How a load varies in time: a factor on its value. Histories are table entries (history/histories.h); what a motion by its velocity or
 * acceleration needs, integrals over time, follows from the factor alone where an entry does not know better. */
#ifndef BRECCIA_LOADING_HISTORY_H
#define BRECCIA_LOADING_HISTORY_H

#include "deck/section.h"

/** What stands under the key of a history. */
typedef union HistoryValue {
  double number;
  bool flag;
  NumberList rows;
  SectionList list; /* of HistorySpec */
  void *section;
} HistoryValue;

enum {
#define HISTORY(name, key, kind, dimension, range, meaning) HISTORY_##name,
#include "loading/history/histories.h"
  HISTORIES
};

typedef struct HistorySpec { /* exactly one is given */
  SectionHead head;
  HistoryValue of[HISTORIES];
} HistorySpec;

extern const Section history_section;

typedef struct HistoryType HistoryType;

/** Straight lines between points. */
typedef struct Polyline {
  const double *rows; /* [count] time, value: times ascend */
  double *sums;       /* [count] integral from time 0 to each of them; owned */
  int count;
  bool ends; /* 0 before and after; else the first and last value hold there */
} Polyline;

typedef struct Panel { /* integrals up to a time, kept so that they need not be found again */
  double time, once, twice;
} Panel;

typedef struct History {
  const HistoryType *type; /* NULL: 1, from `grown` on */
  const HistoryValue *value;
  const Node *value_node; /* where it stands */
  Polyline line;          /* of tables and files */
  double *rows;           /* of files; owned */
  struct History *parts;  /* [part_count] of products and sums */
  int part_count;
  double grown;       /* without a type: when a straight line from 0 has come to 1; 0: from the beginning */
  double found, most; /* factor of what is controlled, and the farthest from zero that it has been at rest */
  Panel *panels;
  int64_t panel_count, panel_capacity;
} History;

struct HistoryType {
  /** Makes ready; says what is wrong with the value. May be NULL. */
  int (*create)(History *history, const DeckReader *reader);
  double (*factor)(const History *history, double time);
  /** `scale` times the integral of the factor from 0 on; NaN: it knows none. May be NULL. */
  double (*integral)(const History *history, double scale, double time);
  /** The next time after this one up to which the factor is smooth: a polynomial of low degree, or as good as one. */
  double (*corner)(const History *history, double time);
  /** Time in which it reaches its largest value, 0: at once. */
  double (*rise)(const History *history);
};

/** @param[in] spec  NULL: constant 1 */
int history_create(History *history, const HistorySpec *spec, const DeckReader *reader);
void history_destroy(History *history);

double history_factor(const History *history, double time);

/** `scale` times the integral of the factor from 0 to a time, or with order 2 that of this integral. By one thread: what was found is kept. */
double history_integral(History *history, int order, double scale, double time);

/** Whether its factor is found by a solver: History.found. */
bool history_is_controlled(const History *history);

/** The factor that is farthest from zero from time 0 up to a time. */
double history_peak(const History *history, double time);

/** Returns the smallest value of `1 + change * factor` from time 0 up to a time.
 *  @param[out] factor  factor for which the value is smallest */
double history_least(const History *history, double change, double time, double *factor);

/** Returns the end of the smooth part of a history that follows a time; INFINITY: the history stays smooth. */
double history_corner(const History *history, double time);

/** Time that it takes to its largest value; 0: it is there at once. */
double history_rise(const History *history);

/** Sums for the points given; `rows` and `count` are set. */
int polyline_prepare(Polyline *line, Error *error);
double polyline_value(const Polyline *line, double time);
double polyline_integral(const Polyline *line, double time);
double polyline_corner(const Polyline *line, double time);
double polyline_rise(const Polyline *line);

#endif
