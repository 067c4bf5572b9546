/* The state of a run as named rows: everything that the steps to come depend on. Each room tells its own rows (x_state); whoever saves,
 * copies, gives back, shows or compares a state goes through the list, so that nothing is listed twice.
 *
 * A list is made when it is wanted, because arrays may change places between steps. Rows stand in the order in which they are given back:
 * a row that is taken up with the help of others comes behind them. */
#ifndef BRECCIA_BASE_STATE_H
#define BRECCIA_BASE_STATE_H

#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum StateKind { STATE_NUMBERS, STATE_COUNTS, STATE_BYTES } StateKind; /* double, int64_t, uint8_t */

typedef enum StateEntity { STATE_OF_ALL, STATE_OF_PLACE, STATE_OF_SLOT, STATE_OF_POINT } StateEntity;

typedef enum StateRole {
  STATE_SHOWN,     /* given with the body, or found when somebody looks: there is nothing to save */
  STATE_COMMITTED, /* changes only where a step has come out well, or its owner takes the changes back */
  STATE_TRIED,     /* changes before that is known, and comes back by copy */
  STATE_LEARNED, /* how the next try is best made: changes in tries and stays so, as the body does not depend on it but for roundings */
  STATE_FOLLOWS, /* follows from the others; saved all the same, because a law may not give the same bits twice */
} StateRole;

enum { STATE_MISFIT = -1 };

/** What some rows ask for besides their values; each may be NULL. */
typedef struct StateCare {
  /** Brings the values up to date before they are saved or copied. */
  int (*ready)(void *owner, Error *error);
  /** The numbers of a row of no fixed length, to be freed. @return how many, or -1 if memory is out */
  int64_t (*save)(const void *owner, double **numbers);
  /** Takes the row up, when its values and all rows before it are back. `numbers` are those of `save`, else NULL.
   *  @return status, after a message; or STATE_MISFIT without one, if these are no numbers of this body */
  int (*resume)(void *owner, const double *numbers, int64_t count, Error *error);
} StateCare;

typedef struct StateRow {
  char name[40];
  const char *unit; /* dimension, as in the tables of decks */
  StateKind kind;
  StateEntity entity;
  StateRole role;
  int64_t count;
  void *values; /* [count]; NULL where `care` saves */
  const StateCare *care;
  void *owner; /* for `care` */
} StateRow;

typedef struct StateList {
  StateRow *rows;
  int count, capacity;
  bool failed; /* memory was out: rows are missing */
} StateList;

/** Adds a row. @param[in] part  of a vector or tensor, put behind the name; NULL: none */
void state_add(StateList *list, const StateRow *row, const char *name, const char *part);
/** Adds three rows, name x, name y, name z, of numbers of each place. */
void state_add_vector(StateList *list, const char *name, const char *unit, StateRole role, double *const values[3],
                      int64_t places);
/** Adds one number, or one count. */
void state_add_number(StateList *list, const char *name, const char *unit, StateRole role, double *value);
void state_add_count(StateList *list, const char *name, StateRole role, int64_t *value);

/** @return the row of a name, or NULL */
StateRow *state_find(const StateList *list, const char *name);
/** Bytes of one value. */
size_t state_size(const StateRow *row);
void state_list_destroy(StateList *list);

/** Rows of a list as they were. */
typedef struct StateCopy {
  StateRow *rows; /* as listed; `count` of those of no fixed length as saved */
  void **values;
  int count;
} StateCopy;

/** Copies a whole state. @param[out] copy  to be destroyed in any case */
int state_copy(StateCopy *copy, const StateList *list, Error *error);
/** Gives it back to the same body; `list` is made from it again.
 *  @return status; after a failure the state is neither the one nor the other */
int state_return(const StateCopy *copy, const StateList *list, Error *error);
void state_copy_destroy(StateCopy *copy);

/** Makes room for the rows that are tried in a step; their arrays must stay where they are. */
int state_keep(StateCopy *copy, const StateList *list, Error *error);
/** Bytes of values that state_copy or, with `only_tried`, state_keep makes room for; without rows of no fixed length. */
size_t state_bytes(const StateList *list, bool only_tried);
/** Notes them: those of places first .. last - 1, by any thread; and all others. */
void state_note_places(const StateCopy *copy, int64_t first, int64_t last);
void state_note_others(const StateCopy *copy);
/** Writes back what was noted. */
void state_undo(const StateCopy *copy);

#endif
