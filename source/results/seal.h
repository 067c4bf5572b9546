/* A file that knows whether it is still as it was written: its first bytes tell how many follow, and their checksum.
 * HDF5 leaves room for them (a user block), and programs that read the file look behind it. The sum is of all bytes, so that what is damaged
 * never comes before HDF5, which trusts the sizes and places that it finds. */
#ifndef BRECCIA_RESULTS_SEAL_H
#define BRECCIA_RESULTS_SEAL_H

enum { SEAL_BYTES = 512 }; /* the smallest user block */

/** Fills the first SEAL_BYTES of a file and brings all of it to the disk. @return 0, or 1 with errno set */
int seal_file(const char *path);

/** @return 0 if no byte has changed since; 1 if the file is damaged or was never sealed; -1 with errno set if it cannot be read */
int seal_is_broken(const char *path);

#endif
