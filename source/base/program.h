/* Another program, run to its end on a script. */
#ifndef BRECCIA_BASE_PROGRAM_H
#define BRECCIA_BASE_PROGRAM_H

#include "base/error.h"
#include "base/text.h"
#include <stdio.h>

typedef enum ProgramEnd {
  PROGRAM_DONE,    /* exit status 0 */
  PROGRAM_MISSING, /* no such program in PATH */
  PROGRAM_FAILED,  /* another exit status, a signal, or it could not be started: the reason says which */
} ProgramEnd;

/** Runs a program of PATH with a script as its standard input and waits for its end. The script lies in a file without a name, not in a
 *  pipe: a program that stops reading half way costs nothing, and the host's signals stay as they are.
 *  @param[in]  words   its name and arguments, then NULL
 *  @param[out] reason  of PROGRAM_FAILED: how it ended, and its last line of errors */
ProgramEnd program_run(const char *const *words, const char *script, size_t length, Text *reason);

/** The same with a file as standard input, read from its beginning. */
ProgramEnd program_feed(const char *const *words, FILE *in, Text *reason);

/** The same without input. @param[out] answer  what it printed, its lines joined by blanks; only of PROGRAM_DONE */
ProgramEnd program_ask(const char *const *words, Text *answer, Text *reason);

#endif
