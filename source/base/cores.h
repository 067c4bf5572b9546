/* How many threads can run at once. */
#ifndef BRECCIA_BASE_CORES_H
#define BRECCIA_BASE_CORES_H

#include "base/text.h"
#include <stdbool.h>

/** Cores that this process may use: those that the system lets it run on, and no more than its control groups give it time for. */
int cores_available(void);

/** Cores' worth of time that the control groups of Linux, and with them containers, give a process; INFINITY where nothing limits it.
 *  @param[in] mount       where groups are found, "/sys/fs/cgroup"
 *  @param[in] membership  file that tells the groups of the process, "/proc/self/cgroup" */
double cores_of_groups(const char *mount, const char *membership);

/** Threads of the whole machine that run or wait for a core at this moment; 0 where that is not known.
 *  @param[in] path  where Linux tells it, "/proc/loadavg" */
int threads_running(const char *path);
/** True if they are more than the machine has cores. */
bool cores_are_short(void);

/** How many threads may be asked for: more would only wait for each other. Never fewer than 64. */
int threads_most(void);

/** What OMP_NUM_THREADS says, else one per core.
 *  @param[out] warning  gets a line where OMP_NUM_THREADS is no number of threads */
int threads_by_default(Text *warning);

#endif
