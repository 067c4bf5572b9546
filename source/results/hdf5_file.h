/* HDF5 files, written and read through a file driver of our own: HDF5 never learns that a call of the system failed.
 *
 * HDF5 keeps what is to be written until a file is closed. Where that fails, the file cannot be closed, and HDF5 1.10 crashes when the process
 * ends: ours, or that of a program that embeds the library. Here the first failure is noted with its cause, what follows is dropped, HDF5 closes
 * in peace, and the caller is told. The bytes of a file are those that HDF5's own driver would have written, in the format of HDF5 1.10: the
 * first in which all that HDF5 notes about datasets has checksums. A flipped bit there led to other numbers before. What cannot be read comes as zeros,
 * which have no checksum: a caller to whom anything seems damaged looks first whether the disk failed (`error`). */
#ifndef BRECCIA_RESULTS_HDF5_FILE_H
#define BRECCIA_RESULTS_HDF5_FILE_H

#include <hdf5.h>

typedef struct Hdf5File {
  hid_t id;     /* negative: not open */
  hid_t driver; /* registered as long as the file is open */
  int error; /* errno of the first call that failed, or 0; `id` can be used all the same, but the file is worth nothing */
} Hdf5File;

/** Opens a file that is not there yet, or empties the one that is. `file` must stay where it is until the file is closed.
 *  @param[in] creation  HDF5's properties of a new file, or H5P_DEFAULT
 *  @return 0, or 1 */
int hdf5_file_create(Hdf5File *file, const char *path, hid_t creation);
/** Opens a file to read it. @return 0, or 1 */
int hdf5_file_open(Hdf5File *file, const char *path);
/** Opens a file to extend it. @return 0, or 1 */
int hdf5_file_extend(Hdf5File *file, const char *path);
/** The same, but the file keeps its old bytes until hdf5_file_close, and then has all that was written, or nothing of it; also where the process is
 *  killed (journal.h: journal_finish is to be called before the file is read or extended). */
int hdf5_file_extend_in_place(Hdf5File *file, const char *path);
/** Closes it with all that is still open in it. Accepts one that is not open.
 *  @return 0, or 1 where any call since it was opened failed, or closing itself */
int hdf5_file_close(Hdf5File *file);
/** Why the last of these functions failed, in words. */
const char *hdf5_file_reason(const Hdf5File *file);

#endif
