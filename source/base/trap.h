/* Floating-point traps, for who looks for a fault: the first division by zero, overflow or invalid operation is noted, with its place in the
 * program, and the computation goes on as it does without traps. */
#ifndef BRECCIA_BASE_TRAP_H
#define BRECCIA_BASE_TRAP_H

#include "base/text.h"
#include <stdatomic.h>
#include <stdbool.h>

enum { TRAP_FRAMES = 24 };

typedef struct Trap {
  atomic_int kind;           /* as the system names it; 0: nothing has happened */
  void *frames[TRAP_FRAMES]; /* who called whom, from the handler outwards */
  int count;
  void *place; /* of the instruction */
} Trap;

/** Whether this processor, system and C library have traps. */
bool trap_is_possible(void);

/** What this thread, and all of its team_run, do from here on is noted in `trap`, until trap_end. Only where they are possible. Meanwhile the
 *  process has a handler of ours for SIGFPE, which hands on what is not of such threads. */
void trap_begin(Trap *trap);
/** Floating-point state and handler are as they were before trap_begin. */
void trap_end(void);

/** What it is that happened and where, in words. @return false if nothing has happened */
bool trap_tell(const Trap *trap, Text *words);

/* For base/team: the trap of this thread, or NULL; and one that another thread has begun. */
Trap *trap_of_thread(void);
void trap_join(Trap *trap);
void trap_leave(void);

#endif
