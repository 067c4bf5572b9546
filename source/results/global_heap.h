/* Global heaps of HDF5 files: the only metadata in the format of HDF5 1.10 that have no checksum of their own.
 *
 * HDF5 trusts the sizes in a heap: a size of zero lets it walk on the spot for ever, and a size too large lets it read
 * beyond the heap. The heaps of our files hold the mappings of virtual datasets only, and each of these ends with its
 * checksum. So a heap is checked as a whole before HDF5 sees its bytes. (HDF5 File Format Specification, Version 3.0,
 * III.E and VI.A.4.) */
#ifndef BRECCIA_RESULTS_GLOBAL_HEAP_H
#define BRECCIA_RESULTS_GLOBAL_HEAP_H

#include <stdbool.h>
#include <stddef.h>

/** Returns true if bytes are those of a whole global heap whose objects do not fill it in order, or lack their
 * checksums. Bytes that are no heap, or only the beginning of one, are not judged: false. */
bool global_heap_is_damaged(const void *bytes, size_t size);

#endif
