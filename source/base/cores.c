#define _GNU_SOURCE /* sched_getaffinity */
#include "base/cores.h"

#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

int cores_available(void)
{
#ifdef __linux__
  cpu_set_t set;
  if (!sched_getaffinity(0, sizeof set, &set)) return CPU_COUNT(&set);
#endif
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count > 0 ? (int)count : 1;
}

int threads_by_default(void)
{
  const char *words = getenv("OMP_NUM_THREADS");
  const long wanted = words ? strtol(words, NULL, 10) : 0;
  return wanted > 0 && wanted <= 4096 ? (int)wanted : cores_available();
}
