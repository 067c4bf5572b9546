/* Threads that libraries start by themselves. CHOLMOD has four of OpenMP's copy numbers about, however many cores there are, and a BLAS may have as many as
 * there are cores; both wait by looking, again and again, in the way of the team's threads, and with BLAS the bits depend on how many there are. */
#ifndef BRECCIA_BASE_LIBRARY_THREADS_H
#define BRECCIA_BASE_LIBRARY_THREADS_H

#include "base/error.h"

/** What was set before. */
typedef struct LibraryThreads {
  int levels, blas;
} LibraryThreads;

/** From now on libraries that this thread calls work by this thread alone: OpenMP of gcc or clang, OpenBLAS. Others are not known of. */
LibraryThreads library_threads_forbid(void);
/** As before. By the same thread. */
void library_threads_allow(LibraryThreads before);

/** Whether there is room for what OpenBLAS works in. It takes that at the first call and keeps it; where it is refused it asks for it again and
 *  again, without an end (0.3.21, blas_memory_alloc). To be asked before anything that calls a BLAS. @return BRECCIA_FAILURE after adding a line */
int library_memory(Error *error);

#endif
