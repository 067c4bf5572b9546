/* Threads, memory and version of the BLAS, and OpenMP threads of other libraries. CHOLMOD copies numbers by four
 * threads of OpenMP, and a BLAS may start as many threads as there are cores. Their threads wait actively and delay
 * those of the team; with threads of the BLAS the bits depend on their number. The sequential MUMPS has no threads but
 * those of its BLAS. */
#ifndef BRECCIA_BASE_LIBRARY_THREADS_H
#define BRECCIA_BASE_LIBRARY_THREADS_H

#include "base/error.h"
#include "base/text.h"

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

/** Returns true if the system would give so many bytes now. For libraries that crash where it refuses them. */
bool library_room(size_t bytes);

/** Adds ", " with name and version of OpenBLAS where it is the BLAS; otherwise nothing, as other ones do not tell
 * theirs. */
void library_blas_add(Text *text);

#endif
