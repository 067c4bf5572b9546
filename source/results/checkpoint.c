#include "results/checkpoint.h"

#include "base/memory.h"
#include "base/regular_file.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "breccia/breccia.h"
#include "results/hdf5_file.h"
#include "results/seal.h"
#include <errno.h>
#include <fcntl.h>
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
  if (set >= 0 && H5Dclose(set) < 0) bad = 1;
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

static char *path_of(const char *folder, CheckpointWhich which)
{
  return text_format("%s/checkpoint%s.h5", folder, which == CHECKPOINT_BEFORE ? "-before" : "");
}

/** Writes everything into a new file, behind the room for the seal. @return 0, or 1 with the cause in errno */
static int save_all(const char *path, const StateList *state, const CheckpointOf *of)
{
  const hid_t way = H5Pcreate(H5P_FILE_CREATE);
  Hdf5File file = {.id = -1};
  int bad = way < 0 || H5Pset_userblock(way, SEAL_BYTES) < 0 || hdf5_file_create(&file, path, way);
  bad = bad || save(file.id, "particles", H5T_NATIVE_INT64, 1, &of->particles);
  bad = bad || save(file.id, "version", H5T_NATIVE_CHAR, strlen(BRECCIA_VERSION), BRECCIA_VERSION);
  bad = bad || save(file.id, "deck", H5T_NATIVE_CHAR, strlen(of->deck), of->deck);
  bad = bad || save(file.id, "files", H5T_NATIVE_CHAR, strlen(of->files), of->files);
  for (int k = 0; !bad && k < state->count; ++k) bad = save_row(file.id, &state->rows[k]);
  if (hdf5_file_close(&file)) bad = 1;
  if (way >= 0) H5Pclose(way);
  if (bad) errno = file.error;
  return bad;
}

/** Gives a new, whole file its name, and the one of that name the name of the one before. */
static int put_in_place(const char *folder, const char *part, const char *path, const char *before)
{
  int bad = access(path, F_OK) ? errno != ENOENT : (unlink(before) && errno != ENOENT) != 0;
  /* A second name first, so that there is no moment without a file at `path`; where files have one name only, there is a short one. */
  if (!bad && link(path, before) && errno != ENOENT) bad = rename(path, before) != 0;
  return bad || rename(part, path) || path_settle(folder);
}

int checkpoint_write(const char *folder, const StateList *state, const CheckpointOf *of, Error *error)
{
  if (state->failed) return error_add(error, BRECCIA_FAILURE, "out of memory: state");
  for (int k = 0; k < state->count; ++k) {
    const StateRow *row = &state->rows[k];
    const int status = row->care && row->care->ready ? row->care->ready(row->owner, error) : BRECCIA_OK;
    if (status) return status;
  }
  char *path = path_of(folder, CHECKPOINT_LAST), *before = path_of(folder, CHECKPOINT_BEFORE),
       *part = text_format("%s/checkpoint.h5.part", folder);
  int status = BRECCIA_OK;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  errno = 0;
  if (!path || !before || !part)
    status = error_add(error, BRECCIA_FAILURE, "out of memory: checkpoint");
  else if (save_all(part, state, of) || seal_file(part) || put_in_place(folder, part, path, before)) {
    status =
        error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, errno ? strerror(errno) : "HDF5 refused");
    remove(part);
  }
  free(path);
  free(before);
  free(part);
  return status;
}

static int same_text(hid_t file, const char *name, const char *words)
{
  int64_t count = load_count(file, name);
  if (count != (int64_t)strlen(words)) return 0;
  char *saved = memory_plain((size_t)count + 1, 1);
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
  if (listed && !(numbers = memory_plain((size_t)(count + 1), sizeof(double))))
    return error_add(error, BRECCIA_FAILURE, "out of memory: %s", row->name);
  int status =
      load(file, row->name, type_of(row), (size_t)count, listed ? numbers : row->values) ? STATE_MISFIT : BRECCIA_OK;
  if (!status && row->care && row->care->resume) status = row->care->resume(row->owner, numbers, count, error);
  free(numbers);
  return status;
}

/** Says why a checkpoint cannot be gone on from: what of it does not fit, or that the disk does not let it be read. */
static int refuse(const Checkpoint *c, Error *error, const char *problem)
{
  if (c->file.error)
    return error_add(error, BRECCIA_FAILURE, "%s: cannot be read: %s", c->path, strerror(c->file.error));
  return error_add(error, BRECCIA_USER_ERROR, "%s: %s", c->path, problem);
}

/** Whether the files that the deck names are as they were. Of the same deck they come in the same order. */
static int check_files(hid_t file, const char *path, const char *now, Error *error)
{
  const int64_t count = load_count(file, "files");
  if (count < 0) return STATE_MISFIT;
  char *saved = memory_plain((size_t)count + 1, 1);
  int status = !saved                                                       ? BRECCIA_FAILURE
               : load(file, "files", H5T_NATIVE_CHAR, (size_t)count, saved) ? STATE_MISFIT
                                                                            : BRECCIA_OK;
  for (const char *then = saved; !status && (*then || *now);) {
    const size_t length = strcspn(now, "\n");
    if (strncmp(then, now, length + 1) != 0) {
      int name = 0; /* behind checksum and bytes */
      sscanf(now, "%*s %*s %n", &name);
      status = error_add(error, BRECCIA_USER_ERROR,
                         "%.*s: has changed since %s was written; put it back as it was, or run without --restart",
                         (int)length - name, now + name, path);
    }
    now += length + (now[length] != 0);
    then += strcspn(then, "\n") + (strchr(then, '\n') != NULL);
  }
  free(saved);
  return status;
}

/** Whether the file is one of this body and deck. */
static int check_file(const Checkpoint *c, const CheckpointOf *of, Error *error)
{
  const hid_t file = c->file.id;
  int64_t particles;
  if (!same_text(file, "version", BRECCIA_VERSION))
    return refuse(c, error,
                  "was written by another version of the program than " BRECCIA_VERSION "; run without --restart");
  if (!same_text(file, "deck", of->deck))
    return refuse(c, error, "was written with another deck; put the deck back as it was, or run without --restart");
  const int status = check_files(file, c->path, of->files, error);
  if (status) return status;
  if (load(file, "particles", H5T_NATIVE_INT64, 1, &particles)) return STATE_MISFIT;
  if (c->file.error) return refuse(c, error, NULL);
  if (particles != of->particles)
    return error_add(error, BRECCIA_USER_ERROR, "%s: holds %lld particles, the deck makes %lld; run without --restart",
                     c->path, (long long)particles, (long long)of->particles);
  return BRECCIA_OK;
}

/** What to do instead of going on from a checkpoint that is not there or is damaged. */
static int say_way_out(const Checkpoint *c, const char *folder, CheckpointWhich which, const char *problem,
                       Error *error)
{
  if (c->file.error) return refuse(c, error, problem);
  Checkpoint before = {.file = {.id = -1}};
  int64_t step = -1;
  if (which == CHECKPOINT_LAST && (before.path = path_of(folder, CHECKPOINT_BEFORE)) && !seal_is_broken(before.path)) {
    hdf5_file_open(&before.file, before.path);
    step = checkpoint_count(&before, "step");
  }
  checkpoint_close(&before);
  if (step < 0) return error_add(error, BRECCIA_USER_ERROR, "%s: %s; run without --restart", c->path, problem);
  return error_add(error, BRECCIA_USER_ERROR,
                   "%s: %s; the checkpoint before it, of step %lld, is whole: --restart-before goes on from that",
                   c->path, problem, (long long)step);
}

int checkpoint_open(Checkpoint *c, const char *folder, CheckpointWhich which, const CheckpointOf *of, Error *error)
{
  *c = (Checkpoint){.path = path_of(folder, which), .file = {.id = -1}};
  if (!c->path) return error_add(error, BRECCIA_FAILURE, "out of memory: checkpoint");
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  if (access(c->path, F_OK)) return say_way_out(c, folder, which, "there is no checkpoint to restart from", error);
  const int broken = seal_is_broken(c->path);
  if (broken < 0)
    return error_add(error, errno == EIO ? BRECCIA_FAILURE : BRECCIA_USER_ERROR, "%s: cannot be read: %s", c->path,
                     regular_file_problem(errno));
  const bool whole = !broken;
  if (whole) hdf5_file_open(&c->file, c->path);
  const int status = c->file.id >= 0 ? check_file(c, of, error) : STATE_MISFIT;
  if (status != STATE_MISFIT) return status;
  return say_way_out(c, folder, which,
                     whole ? "is of another build of the program"
                           : "is damaged: its bytes do not have the checksum written with them",
                     error);
}

int checkpoint_read(const Checkpoint *c, const StateList *state, Error *error)
{
  if (state->failed) return error_add(error, BRECCIA_FAILURE, "out of memory: state");
  int status = BRECCIA_OK;
  for (int k = 0; !status && k < state->count; ++k) status = load_row(c->file.id, &state->rows[k], error);
  if (status == STATE_MISFIT || (!status && c->file.error))
    status = refuse(c, error, "is of another build of the program; run without --restart");
  return status;
}

int64_t checkpoint_count(const Checkpoint *c, const char *name)
{
  int64_t count = -1;
  return c->file.id < 0 || load(c->file.id, name, H5T_NATIVE_INT64, 1, &count) ? -1 : count;
}

void checkpoint_close(Checkpoint *c)
{
  hdf5_file_close(&c->file);
  free(c->path);
  *c = (Checkpoint){.file = {.id = -1}};
}

int checkpoint_return_to_before(const char *folder, Error *error)
{
  char *last = path_of(folder, CHECKPOINT_LAST), *before = path_of(folder, CHECKPOINT_BEFORE);
  int status = BRECCIA_OK;
  if (!last || !before || rename(before, last) || path_settle(folder))
    status = error_add(error, BRECCIA_FAILURE, "%s: cannot be renamed: %s", before ? before : folder, strerror(errno));
  free(last);
  free(before);
  return status;
}

bool checkpoint_exists(const char *folder)
{
  bool found = false;
  for (int which = CHECKPOINT_LAST; which <= CHECKPOINT_BEFORE; ++which) {
    char *path = path_of(folder, (CheckpointWhich)which);
    found |= path && !access(path, F_OK);
    free(path);
  }
  return found;
}

int checkpoint_forget(const char *folder, Error *error)
{
  static const char *const names[] = {"checkpoint.h5", "checkpoint-before.h5", "checkpoint.h5.part"};
  int status = BRECCIA_OK;
  for (int k = 0; k < 3; ++k) {
    char *path = text_format("%s/%s", folder, names[k]);
    if (!path || (unlink(path) && errno != ENOENT))
      status = error_add(error, BRECCIA_FAILURE, "%s: cannot be removed: %s", path ? path : names[k], strerror(errno));
    free(path);
  }
  return status;
}
