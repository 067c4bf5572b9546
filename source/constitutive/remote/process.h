/* Server processes of a run's own. */
#ifndef BRECCIA_REMOTE_PROCESS_H
#define BRECCIA_REMOTE_PROCESS_H

#include "base/text.h"

#include <sys/types.h>

typedef struct Process {
  pid_t number; /* 0: none */
  char *log;    /* what it says */
  char *address;
} Process;

/** A folder that only this user can enter. @return its path, to be freed, or NULL */
char *process_folder(void);

/** Starts the OpenSees server on a socket in the folder: what BRECCIA_OPENSEES names, or 'breccia-opensees' beside the program or in PATH.
 *  @return 0, or 1 with the reason */
int process_start(Process *process, const char *folder, int number, Text *reason);
/** Whether it has ended; that can be asked again and again. */
bool process_gone(const Process *process);
/** Whether it has ended; `reason`, if given, tells how and its last words. */
bool process_ended(Process *process, Text *reason);
/** Waits a moment for its end, kills it otherwise, and removes its files. @param[in] told  it knows already that it shall end */
void process_stop(Process *process, bool told);

#endif
