/* Threads that work together. A team runs a function on all its threads (`team_run`); within it loops are shared out (TEAM_FOR), parts
 * are done by one thread (TEAM_SINGLE), and all wait for each other at the end of both:
 *
 *   static void advance(void *context)
 *   {
 *     Domain *d = context;
 *     TEAM_FOR (b, d->batch_count) resist(d, b);
 *     TEAM_SINGLE add_sums(d);
 *   }
 *   ...
 *   team_run(advance, d);
 *
 * A thread that waits looks for some microseconds and then sleeps, so that it takes no core from those it waits for.
 * Outside team_run, and in a team_run within another, loops are done whole by the thread that meets them. */
#ifndef BRECCIA_BASE_TEAM_H
#define BRECCIA_BASE_TEAM_H

#include "base/error.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct Team Team;

/** Starts threads - 1 threads, which sleep until there is work; the caller of team_run is the last of the team. They take no signals. */
Team *team_create(int threads, Error *error);
void team_destroy(Team **team);
int team_threads(const Team *team);
/** Returns true in a process that has come about by a fork since: it does not have the threads of the team. False for a
 * team without threads of its own. */
bool team_is_foreign(const Team *team);

/** Makes `team` the one that team_run of this thread uses; NULL: none, this thread alone. @return the one before */
Team *team_use(Team *team);

/** Calls `work` on every thread of the team in use, and returns when all are through. A trap of this thread (base/trap.h) is theirs too. */
void team_run(void (*work)(void *context), void *context);
/** Threads that team_run of this thread calls. */
int team_called(void);
/** Calls `work` for 0 .. count - 1, shared out among the team in use. */
void team_each(int64_t count, void (*work)(void *context, int64_t index), void *context);

/** By all threads: waits for the others; what they wrote before can then be read. */
void team_wait(void);

typedef struct TeamShare {
  int64_t first, last;
  bool open;
} TeamShare;

/** This thread's part of 0 .. count - 1: runs of equal length, the same ones every time. */
TeamShare team_share(int64_t count);
/** Threads that work together here, which of them this one is, and the part of one of them: 0 .. team_size() - 1. */
int team_size(void);
int team_rank(void);
TeamShare team_share_of(int64_t count, int thread);
/** True on one thread of the team, on another one for the next number. */
bool team_turn(int64_t number);

/** By all threads: a loop over 0 .. count - 1, each thread over its own share, then all wait. `break` ends the share of its
 *  thread; nothing else may leave the loop. */
#define TEAM_FOR(index, count)                                                                                         \
  for (TeamShare share_ = team_share(count); share_.open; share_.open = false, team_wait())                            \
    for (int64_t index = share_.first; index < share_.last; ++index)

/** By all threads: what follows is done by the first of them, while the others wait. Nothing may jump out of it. */
#define TEAM_SINGLE                                                                                                    \
  for (bool open_ = true; open_; open_ = false, team_wait())                                                           \
    if (team_turn(0))

#endif
