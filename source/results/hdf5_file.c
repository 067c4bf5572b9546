#include "results/hdf5_file.h"

#include "base/file_bytes.h"
#include "base/memory.h"
#include "base/regular_file.h"
#include "base/text.h"
#include "results/global_heap.h"
#include "results/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct Driver {
  H5FD_t shared;      /* first: HDF5's own part */
  haddr_t end, there; /* of what HDF5 has allocated, and of the file as HDF5 believes it to be */
  int descriptor;
  int *error;       /* of the Hdf5File */
  Journal *journal; /* NULL: what is written goes into the file at once */
  dev_t device;
  ino_t inode;
} Driver;

typedef struct Info { /* what the access properties carry to driver_open */
  int *error;
  bool whole; /* with a journal */
} Info;

static void note(const Driver *driver)
{
  if (!*driver->error) *driver->error = errno ? errno : EIO;
}

static H5FD_t *driver_open(const char *path, unsigned flags, hid_t properties, haddr_t most)
{
  (void)most;
  const Info *info = H5Pget_driver_info(properties);
  Driver *driver = info ? memory_plain(1, sizeof *driver) : NULL;
  if (!driver) return NULL;
  int way = flags & H5F_ACC_RDWR ? O_RDWR : O_RDONLY;
  if (flags & H5F_ACC_CREAT) way |= O_CREAT;
  if (flags & H5F_ACC_TRUNC) way |= O_TRUNC;
  if (flags & H5F_ACC_EXCL) way |= O_EXCL;
  struct stat status;
  driver->error = info->error;
  driver->descriptor = way == O_RDONLY ? text_open_file(path) : regular_file_open(path, way);
  *info->error = 0; /* HDF5 tries first whether the file is there */
  if (driver->descriptor < 0 || fstat(driver->descriptor, &status)) {
    note(driver);
    if (driver->descriptor >= 0) close(driver->descriptor);
    free(driver);
    return NULL;
  }
  driver->there = (haddr_t)status.st_size;
  if (info->whole && way != O_RDONLY && !(driver->journal = journal_create(path, status.st_size))) {
    *info->error = ENOMEM;
    close(driver->descriptor);
    free(driver);
    return NULL;
  }
  driver->device = status.st_dev;
  driver->inode = status.st_ino;
  return &driver->shared;
}

static herr_t driver_close(H5FD_t *shared)
{
  Driver *driver = (Driver *)shared;
  if (driver->journal && *driver->error) journal_drop(driver->journal, driver->descriptor);
  if (driver->journal && !*driver->error)
    *driver->error = journal_commit(driver->journal, driver->descriptor, (int64_t)driver->end);
  journal_destroy(&driver->journal);
  if (close(driver->descriptor)) note(driver);
  free(driver);
  return 0;
}

static int driver_compare(const H5FD_t *a, const H5FD_t *b)
{
  const Driver *one = (const Driver *)a, *other = (const Driver *)b;
  if (one->device != other->device) return one->device < other->device ? -1 : 1;
  if (one->inode != other->inode) return one->inode < other->inode ? -1 : 1;
  return 0;
}

/** The features of HDF5's own driver for ordinary files that change what it writes, or how fast. */
static herr_t driver_query(const H5FD_t *shared, unsigned long *features)
{
  (void)shared;
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

static haddr_t driver_allocated(const H5FD_t *shared, H5FD_mem_t type)
{
  (void)type;
  return ((const Driver *)shared)->end;
}

static herr_t driver_allocate(H5FD_t *shared, H5FD_mem_t type, haddr_t end)
{
  (void)type;
  ((Driver *)shared)->end = end;
  return 0;
}

static haddr_t driver_size(const H5FD_t *shared, H5FD_mem_t type)
{
  (void)type;
  return ((const Driver *)shared)->there;
}

static herr_t driver_read(H5FD_t *shared, H5FD_mem_t type, hid_t transfer, haddr_t from, size_t size, void *buffer)
{
  (void)type, (void)transfer;
  const Driver *driver = (const Driver *)shared;
  const int64_t n = file_read_at(driver->descriptor, buffer, size, (int64_t)from);
  if (n < 0) note(driver);
  const size_t there = n < 0 ? 0 : (size_t)n;
  memset((char *)buffer + there, 0, size - there); /* behind the end of the file there are zeros */
  if (driver->journal) journal_overlay(driver->journal, (int64_t)from, size, buffer);
  if (global_heap_is_damaged(buffer, size)) memset(buffer, 0, size); /* zeros are no heap, and HDF5 refuses them */
  return 0;
}

static herr_t driver_write(H5FD_t *shared, H5FD_mem_t type, hid_t transfer, haddr_t from, size_t size,
                           const void *buffer)
{
  (void)type, (void)transfer;
  Driver *driver = (Driver *)shared;
  if (from + size > driver->there) driver->there = from + size;
  const size_t old = driver->journal ? journal_share(driver->journal, (int64_t)from, size) : 0;
  if (old && !*driver->error)
    *driver->error = journal_write(driver->journal, driver->descriptor, (int64_t)from, old, buffer);
  if (!*driver->error)
    *driver->error = file_write_at(driver->descriptor, (const char *)buffer + old, size - old, (int64_t)(from + old));
  return 0;
}

static herr_t driver_truncate(H5FD_t *shared, hid_t transfer, hbool_t closing)
{
  (void)transfer, (void)closing;
  Driver *driver = (Driver *)shared;
  if (driver->end == driver->there) return 0;
  if (!driver->journal && !*driver->error && ftruncate(driver->descriptor, (off_t)driver->end)) note(driver);
  driver->there = driver->end;
  return 0;
}

/** The driver itself: for open_file only. */
static herr_t driver_handle(H5FD_t *shared, hid_t properties, void **handle)
{
  (void)properties;
  *handle = shared;
  return 0;
}

static const H5FD_class_t driver_class = {
#if H5_VERSION_GE(1, 13, 0)
    .version = H5FD_CLASS_VERSION,
    .value = 511, /* of those that need no registration */
#endif
    .name = "breccia",
    .maxaddr = ((haddr_t)1 << 62) - 1,
    .fc_degree = H5F_CLOSE_STRONG,
    .fapl_size = sizeof(Info),
    .open = driver_open,
    .close = driver_close,
    .cmp = driver_compare,
    .query = driver_query,
    .get_eoa = driver_allocated,
    .set_eoa = driver_allocate,
    .get_eof = driver_size,
    .read = driver_read,
    .get_handle = driver_handle,
    .write = driver_write,
    .truncate = driver_truncate,
    .fl_map = H5FD_FLMAP_DICHOTOMY,
};

static void forget_driver(Hdf5File *file)
{
  if (file->driver >= 0) H5FDunregister(file->driver);
  file->driver = -1;
}

/** @param[in] flags  H5F_ACC_...; TRUNC: of a new file with these properties */
static int open_file(Hdf5File *file, const char *path, unsigned flags, bool whole, hid_t creation)
{
  *file = (Hdf5File){.id = -1, .driver = -1};
  const Info info = {&file->error, whole};
  /* Registered again for each file: H5close of a host forgets it. HDF5 1.10 gives up what it holds of a driver before it asks that to close, so that the
   * file's own share would not be enough: what it calls then would be gone. */
  const hid_t driver = file->driver = H5FDregister(&driver_class), properties = H5Pcreate(H5P_FILE_ACCESS);
  if (driver >= 0 && properties >= 0 && H5Pset_driver(properties, driver, &info) >= 0 &&
      H5Pset_libver_bounds(properties, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0)
    file->id = flags == H5F_ACC_TRUNC ? H5Fcreate(path, flags, creation, properties) : H5Fopen(path, flags, properties);
  Driver *own = NULL;
  if (whole && file->id >= 0 && H5Fget_vfd_handle(file->id, properties, (void **)&own) >= 0)
    journal_keep(own->journal, (int64_t)own->end); /* only now it is known where HDF5's own bytes end */
  if (properties >= 0) H5Pclose(properties);
  if (file->id < 0) forget_driver(file);
  return file->id < 0 || file->error;
}

int hdf5_file_create(Hdf5File *file, const char *path, hid_t creation)
{
  return open_file(file, path, H5F_ACC_TRUNC, false, creation);
}

int hdf5_file_open(Hdf5File *file, const char *path)
{
  return open_file(file, path, H5F_ACC_RDONLY, false, H5P_DEFAULT);
}

int hdf5_file_extend(Hdf5File *file, const char *path)
{
  return open_file(file, path, H5F_ACC_RDWR, false, H5P_DEFAULT);
}

int hdf5_file_extend_in_place(Hdf5File *file, const char *path)
{
  return open_file(file, path, H5F_ACC_RDWR, true, H5P_DEFAULT);
}

int hdf5_file_close(Hdf5File *file)
{
  const int bad = file->id >= 0 && H5Fclose(file->id) < 0;
  if (file->id >= 0) forget_driver(file);
  file->id = -1;
  return bad || file->error;
}

const char *hdf5_file_reason(const Hdf5File *file)
{
  return file->error ? regular_file_problem(file->error) : "HDF5 refused";
}
