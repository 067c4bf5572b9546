/* Files that are written in place with a journal: they hold the old bytes or the new ones, and no damaged journal is believed. */
#include "support.h"

#include "results/dataset.h"
#include "results/hdf5_file.h"
#include "results/journal.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OLD = 50000, NEW = 61234, PIECES = 40 };

static char folder[] = "/tmp/breccia-journal-XXXXXX", path[64], beside[96];

static int begin(void **state)
{
  (void)state;
  if (!mkdtemp(folder)) return 1;
  snprintf(path, sizeof path, "%s/numbers", folder);
  snprintf(beside, sizeof beside, "%s.journal", path);
  return 0;
}

static int end(void **state)
{
  (void)state;
  unlink(path);
  return rmdir(folder); /* nothing else is left there */
}

static void put(const char *name, const void *bytes, size_t size)
{
  FILE *file = fopen(name, "wb");
  assert_true(file && fwrite(bytes, 1, size, file) == size && !fclose(file));
}

static void assert_file_is(const char *name, const void *bytes, size_t size)
{
  size_t found;
  char *all = text_read_file(name, &found);
  assert_int_equal(found, size);
  assert_memory_equal(all, bytes, size);
  free(all);
}

/** Bytes of a file before and after, and a journal that leads from one to the other, left beside a file to which nothing can be written. */
static void leave_journal(unsigned char *before, unsigned char *after)
{
  for (int k = 0; k < OLD; ++k) before[k] = (unsigned char)(k * 7 + k / 256);
  memcpy(after, before, OLD);
  memset(after + OLD, 'n', NEW - OLD);
  put(path, before, OLD);
  Journal *journal = journal_create(path, OLD);
  const int file = open(path, O_RDWR);
  assert_int_equal(pwrite(file, after + OLD, NEW - OLD, OLD), NEW - OLD);
  for (int k = 0; k < PIECES; ++k) { /* some within a page, some across, one over another, the last up to the end */
    const int64_t from = k < PIECES - 1 ? (k * 7919) % (OLD - 6000) : OLD - 77;
    const size_t size = k < PIECES - 1 ? (size_t)(k * k * 3 + 1) : 77;
    memset(after + from, 'A' + k, size);
    assert_int_equal(journal_share(journal, from, size + 1000000), OLD - from);
    assert_int_equal(journal_write(journal, file, from, size, after + from), 0);
  }
  unsigned char *read = malloc(OLD);
  assert_int_equal(pread(file, read, OLD, 0), OLD);
  assert_memory_equal(read, before, OLD);
  journal_overlay(journal, 0, OLD, read);
  assert_memory_equal(read, after, OLD);
  assert_int_equal(pread(file, read, OLD, 0), OLD);
  journal_overlay(journal, 12345, 20000, read + 12345);
  assert_memory_equal(read + 12345, after + 12345, 20000);
  free(read);
  close(file);
  const int locked = open(path, O_RDONLY);
  assert_int_equal(journal_commit(journal, locked, NEW), EBADF);
  close(locked);
  journal_destroy(&journal);
  assert_true(journal_is_there(path));
}

static void a_journal_is_put_in_whole_however_far_it_had_come(void **state)
{
  (void)state;
  static unsigned char before[OLD], after[NEW];
  Error *error = breccia_error_create();
  for (int way = 0; way < 3; ++way) { /* nothing of it was put in, half of it, all of it */
    leave_journal(before, after);
    const int file = open(path, O_WRONLY);
    const int come = way == 0 ? 0 : way == 1 ? OLD / 2 : NEW;
    assert_int_equal(pwrite(file, after, (size_t)come, 0), come);
    close(file);
    assert_int_equal(journal_finish(path, error), 0);
    assert_file_is(path, after, NEW);
    assert_false(journal_is_there(path));
    assert_int_equal(journal_finish(path, error), 0);
    assert_file_is(path, after, NEW);
  }
  breccia_error_destroy(&error);
}

static void no_damaged_journal_is_believed(void **state)
{
  (void)state;
  static unsigned char before[OLD], after[NEW], there[NEW];
  leave_journal(before, after);
  memcpy(there, before, OLD);
  memcpy(there + OLD, after + OLD, NEW - OLD);
  size_t size;
  unsigned char *whole = (unsigned char *)text_read_file(beside, &size);
  for (int k = 0; k < 200; ++k) {
    const size_t at = (size_t)k * size / 200;
    Error *error = breccia_error_create();
    if (k % 2)
      put(beside, whole, at); /* cut */
    else {
      whole[at] ^= (unsigned char)(1 << k / 2 % 8);
      put(beside, whole, size);
      whole[at] ^= (unsigned char)(1 << k / 2 % 8);
    }
    assert_int_equal(journal_finish(path, error), BRECCIA_USER_ERROR);
    assert_non_null(strstr(breccia_error_text(error), "numbers.journal: is damaged, or not of the numbers beside it"));
    breccia_error_destroy(&error);
    assert_file_is(path, there, NEW);
  }
  /* Of another file. */
  put(beside, whole, size);
  put(path, there, NEW - 1);
  Error *error = breccia_error_create();
  assert_int_equal(journal_finish(path, error), BRECCIA_USER_ERROR);
  assert_file_is(path, there, NEW - 1);
  char part[128];
  snprintf(part, sizeof part, "%s.part", beside);
  put(part, whole, size / 2); /* of a run that was killed */
  assert_int_equal(journal_forget(path), 0);
  assert_int_equal(access(part, F_OK), -1);
  assert_int_equal(journal_forget(path), 0);
  breccia_error_destroy(&error);
  free(whole);
}

/** Numbers of a dataset of the file, from 0 on. */
static void write_numbers(Hdf5File *file, int first, int count)
{
  int64_t numbers[3000];
  for (int k = 0; k < count; ++k) numbers[k] = first + k;
  assert_int_equal(dataset_write(file->id, "numbers", H5T_NATIVE_INT64, 1, (hsize_t)first, (hsize_t)count, numbers), 0);
}

static void extending_in_place_keeps_the_old_file_until_it_is_closed(void **state)
{
  (void)state;
  Hdf5File file;
  size_t size;
  assert_int_equal(hdf5_file_create(&file, path, H5P_DEFAULT), 0);
  assert_int_equal(dataset_create(file.id, "numbers", H5T_STD_I64LE, 1, 512), 0);
  write_numbers(&file, 0, 1000);
  assert_int_equal(hdf5_file_close(&file), 0);
  char *old = text_read_file(path, &size);
  for (int lost = 1; lost >= 0; --lost) { /* first with an error, after which nothing must have happened */
    assert_int_equal(hdf5_file_extend_in_place(&file, path), 0);
    write_numbers(&file, 500, 2500);
    hid_t more = H5Gcreate2(file.id, "more", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(more >= 0 && H5Gclose(more) >= 0 && H5Fflush(file.id, H5F_SCOPE_GLOBAL) >= 0);
    size_t now;
    char *bytes = text_read_file(path, &now);
    assert_true(now > size);
    assert_memory_equal(bytes, old, size);
    free(bytes);
    if (lost) file.error = EIO;
    assert_int_equal(hdf5_file_close(&file), lost);
    if (lost) assert_file_is(path, old, size);
  }
  free(old);
  hid_t plain = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), set = H5Dopen2(plain, "numbers", H5P_DEFAULT);
  int64_t numbers[3000];
  assert_true(H5Dread(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0);
  for (int k = 0; k < 3000; ++k) assert_int_equal(numbers[k], k);
  H5Dclose(set);
  H5Fclose(plain);
  assert_false(journal_is_there(path));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_journal_is_put_in_whole_however_far_it_had_come),
                                     cmocka_unit_test(no_damaged_journal_is_believed),
                                     cmocka_unit_test(extending_in_place_keeps_the_old_file_until_it_is_closed)};
  return cmocka_run_group_tests(tests, begin, end);
}
