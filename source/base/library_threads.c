#define _GNU_SOURCE /* RTLD_DEFAULT */
#include "base/library_threads.h"

#include <dlfcn.h>
#include <string.h>

/* Neither is among what the program is linked with: they come with a library, or do not. */
static void set(const char *function, int value)
{
  void (*call)(int);
  void *found = dlsym(RTLD_DEFAULT, function);
  memcpy(&call, &found, sizeof call); /* ISO C knows no cast from data to functions */
  if (found) call(value);
}

static int get(const char *function)
{
  int (*call)(void);
  void *found = dlsym(RTLD_DEFAULT, function);
  memcpy(&call, &found, sizeof call);
  return found ? call() : 1;
}

LibraryThreads library_threads_forbid(void)
{
  const LibraryThreads before = {get("omp_get_max_active_levels"), get("openblas_get_num_threads")};
  set("omp_set_max_active_levels", 0); /* no region is parallel */
  if (before.blas > 1) set("openblas_set_num_threads", 1);
  return before;
}

void library_threads_allow(LibraryThreads before)
{
  set("omp_set_max_active_levels", before.levels);
  if (before.blas > 1) set("openblas_set_num_threads", before.blas);
}
