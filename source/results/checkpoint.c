#include "results/checkpoint.h"

#include "base/text.h"
#include "breccia/breccia.h"
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static hid_t type_of(const StateRow *row)
{
  return row->kind == STATE_BYTES ? H5T_NATIVE_UINT8 : row->kind == STATE_COUNTS ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
}

static int save(hid_t file, const char *name, hid_t type, size_t count, const void *values)
{
  hsize_t size = count;
  hid_t space = H5Screate_simple(1, &size, NULL);
  hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  int bad = set < 0 || (count && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0);
  if (set >= 0) H5Dclose(set);
  H5Sclose(space);
  return bad;
}

/** Reads a dataset that must hold exactly `count` numbers. */
static int load(hid_t file, const char *name, hid_t type, size_t count, void *values)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set < 0) return 1;
  hid_t space = H5Dget_space(set);
  int bad = H5Sget_simple_extent_npoints(space) != (hssize_t)count;
  bad = bad || (count && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0);
  H5Sclose(space);
  H5Dclose(set);
  return bad;
}

static int64_t load_count(hid_t file, const char *name)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set < 0) return -1;
  hid_t space = H5Dget_space(set);
  int64_t count = H5Sget_simple_extent_npoints(space);
  H5Sclose(space);
  H5Dclose(set);
  return count;
}

static int save_row(hid_t file, const StateRow *row)
{
  if (row->role == STATE_SHOWN) return 0;
  if (row->values) return save(file, row->name, type_of(row), (size_t)row->count, row->values);
  double *numbers = NULL;
  const int64_t count = row->care->save(row->owner, &numbers);
  const int bad = count < 0 || save(file, row->name, type_of(row), (size_t)count, numbers);
  free(numbers);
  return bad;
}

int checkpoint_write(const char *folder, const StateList *state, const CheckpointOf *of, Error *error)
{
  if (state->failed) return error_add(error, BRECCIA_FAILURE, "out of memory: state");
  for (int k = 0; k < state->count; ++k) {
    const StateRow *row = &state->rows[k];
    const int status = row->care && row->care->ready ? row->care->ready(row->owner, error) : BRECCIA_OK;
    if (status) return status;
  }
  char *path = text_format("%s/checkpoint.h5", folder), *temporary = text_format("%s/checkpoint.h5.part", folder);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  errno = 0;
  hid_t file = path && temporary ? H5Fcreate(temporary, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT) : -1;
  int bad = file < 0;
  if (!bad) {
    bad |= save(file, "particles", H5T_NATIVE_INT64, 1, &of->particles);
    bad |= save(file, "version", H5T_NATIVE_CHAR, strlen(BRECCIA_VERSION), BRECCIA_VERSION);
    bad |= save(file, "deck", H5T_NATIVE_CHAR, strlen(of->deck), of->deck);
    for (int k = 0; !bad && k < state->count; ++k) bad = save_row(file, &state->rows[k]);
    bad |= H5Fclose(file) < 0;
  }
  if (!bad) {
    int descriptor = open(temporary, O_RDONLY);
    bad = descriptor < 0 || fsync(descriptor);
    if (descriptor >= 0) close(descriptor);
  }
  bad = bad || rename(temporary, path);
  if (bad) {
    error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, errno ? strerror(errno) : "HDF5 refused");
    if (temporary) remove(temporary);
  }
  free(path);
  free(temporary);
  return bad ? BRECCIA_FAILURE : BRECCIA_OK;
}

static int same_text(hid_t file, const char *name, const char *words)
{
  int64_t count = load_count(file, name);
  if (count != (int64_t)strlen(words)) return 0;
  char *saved = malloc((size_t)count + 1);
  int same = saved && !load(file, name, H5T_NATIVE_CHAR, (size_t)count, saved) && !memcmp(saved, words, (size_t)count);
  free(saved);
  return same;
}

/** @return status after a message, or STATE_MISFIT without one */
static int load_row(hid_t file, const StateRow *row, Error *error)
{
  if (row->role == STATE_SHOWN) return BRECCIA_OK;
  const bool listed = !row->values;
  const int64_t count = listed ? load_count(file, row->name) : row->count;
  double *numbers = NULL;
  if (count < 0) return STATE_MISFIT;
  if (listed && !(numbers = malloc(sizeof(double) * (size_t)(count + 1))))
    return error_add(error, BRECCIA_FAILURE, "out of memory: %s", row->name);
  int status =
      load(file, row->name, type_of(row), (size_t)count, listed ? numbers : row->values) ? STATE_MISFIT : BRECCIA_OK;
  if (!status && row->care && row->care->resume) status = row->care->resume(row->owner, numbers, count, error);
  free(numbers);
  return status;
}

/** Whether the file is one of this body and deck. */
static int check_file(hid_t file, const char *path, const CheckpointOf *of, Error *error)
{
  int64_t particles;
  if (!same_text(file, "version", BRECCIA_VERSION))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: was written by another version of the program than %s; run without --restart", path,
                     BRECCIA_VERSION);
  if (load(file, "particles", H5T_NATIVE_INT64, 1, &particles)) return STATE_MISFIT;
  if (particles != of->particles)
    return error_add(error, BRECCIA_USER_ERROR, "%s: holds %lld particles, the deck makes %lld; run without --restart",
                     path, (long long)particles, (long long)of->particles);
  if (!same_text(file, "deck", of->deck))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: was written with another deck; put the deck back as it was, or run without --restart", path);
  return BRECCIA_OK;
}

int checkpoint_read(const char *folder, const StateList *state, const CheckpointOf *of, Error *error)
{
  char *path = text_format("%s/checkpoint.h5", folder);
  if (!path || state->failed) {
    free(path);
    return error_add(error, BRECCIA_FAILURE, "out of memory: state");
  }
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  int status = file < 0 ? error_add(error, BRECCIA_USER_ERROR,
                                    "%s: there is no checkpoint to restart from; run without --restart", path)
                        : check_file(file, path, of, error);
  for (int k = 0; !status && k < state->count; ++k) status = load_row(file, &state->rows[k], error);
  if (status == STATE_MISFIT)
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s: is damaged, or of another build of the program; run without --restart", path);
  if (file >= 0) H5Fclose(file);
  free(path);
  return status;
}

int64_t checkpoint_count(const char *folder, const char *name)
{
  char *path = text_format("%s/checkpoint.h5", folder);
  int64_t count = -1;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  hid_t file = path ? H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  if (file < 0 || load(file, name, H5T_NATIVE_INT64, 1, &count)) count = -1;
  if (file >= 0) H5Fclose(file);
  free(path);
  return count;
}
