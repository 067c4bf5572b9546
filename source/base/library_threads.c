#define _GNU_SOURCE /* RTLD_DEFAULT */
#include "base/library_threads.h"

#include <dlfcn.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/mman.h>

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

bool library_room(size_t bytes)
{
  void *room = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) return false;
  munmap(room, bytes);
  return true;
}

int library_memory(Error *error)
{
  const size_t buffer = (size_t)1 << 27; /* BUFFER_SIZE of most processors in OpenBLAS's common_x86_64.h and its like */
  static atomic_bool found;              /* room, once: from then on the library has it */
  if (atomic_load(&found) || !dlsym(RTLD_DEFAULT, "openblas_get_num_threads")) return BRECCIA_OK;
  if (!library_room(buffer))
    return error_add(error, BRECCIA_FAILURE,
                     "out of memory: OpenBLAS, which solves equations, needs %zu MB to work in; close other programs, "
                     "or raise the limit (ulimit -v)",
                     buffer >> 20);
  atomic_store(&found, true);
  return BRECCIA_OK;
}

void library_blas_add(Text *text)
{
  const char *(*configuration)(void);
  void *found = dlsym(RTLD_DEFAULT, "openblas_get_config");
  memcpy(&configuration, &found, sizeof configuration);
  if (!found) return;
  const char *words = configuration(); /* "OpenBLAS 0.3.21 NO_LAPACKE ...": name and version are two words */
  const size_t name = strcspn(words, " ");
  const size_t version = words[name] ? strcspn(words + name + 1, " ") + 1 : 0;
  text_add(text, ", %.*s", (int)(name + version), words);
}
