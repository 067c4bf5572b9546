#include "base/folder_lock.h"

#include "base/regular_file.h"
#include "base/text.h"
#include "breccia/breccia.h"
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/** Writes down who holds the lock. Where that fails, others are told less. */
static void sign(int descriptor)
{
  char host[128] = "an unknown computer", when[64] = "";
  if (!gethostname(host, sizeof host)) host[sizeof host - 1] = 0;
  struct tm parts;
  const time_t now = time(NULL);
  if (gmtime_r(&now, &parts)) strftime(when, sizeof when, "%Y-%m-%d %H:%M:%S UTC", &parts);
  char *words = text_format("process %ld on %s since %s", (long)getpid(), host, when);
  if (words && !ftruncate(descriptor, 0)) (void)!pwrite(descriptor, words, strlen(words), 0);
  free(words);
}

/** Whether the file that is locked is still the one of that name: its holder removes it before unlocking it. */
static bool is_named(int descriptor, const char *path)
{
  struct stat held, named;
  return !fstat(descriptor, &held) && !stat(path, &named) && held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

int folder_lock_take(FolderLock *lock, const char *folder, Error *error)
{
  *lock = (FolderLock){.path = text_format("%s/run.lock", folder), .descriptor = -1};
  if (!lock->path) return error_add(error, BRECCIA_FAILURE, "out of memory: lock of %s", folder);
  for (;;) {
    /* Closed in programs that are started: what outlives us must not hold it. A link is not followed: the file it leads to is somebody's. */
    lock->descriptor = regular_file_open(lock->path, O_RDWR | O_CREAT);
    if (lock->descriptor < 0)
      return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", lock->path, regular_file_problem(errno));
    int held;
    do held = flock(lock->descriptor, LOCK_EX | LOCK_NB);
    while (held && errno == EINTR);
    if (held && errno == EWOULDBLOCK) break;
    if (held || is_named(lock->descriptor, lock->path)) { /* file systems without locks leave it to people */
      sign(lock->descriptor);
      return BRECCIA_OK;
    }
    close(lock->descriptor);
  }
  char holder[256] = "";
  const ssize_t n = pread(lock->descriptor, holder, sizeof holder - 1, 0);
  close(lock->descriptor);
  lock->descriptor = -1;
  return error_add(
      error, BRECCIA_USER_ERROR,
      "%s: another run writes into this folder (%s); wait for its end, or give this one a folder of its own", folder,
      n > 0 ? holder : "it does not say which");
}

void folder_lock_return(FolderLock *lock)
{
  if (lock->descriptor >= 0) {
    if (is_named(lock->descriptor, lock->path)) unlink(lock->path);
    close(lock->descriptor);
  }
  free(lock->path);
  *lock = (FolderLock){.descriptor = -1};
}
