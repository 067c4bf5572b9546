#include "results/journal.h"

#include "base/checksum.h"
#include "base/file_bytes.h"
#include "base/memory.h"
#include "base/regular_file.h"
#include "base/text.h"
#include "base/whole_file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PAGE = 4096 };

struct Journal {
  char *path, *part; /* of the journal itself */
  int64_t kept, pages;
  unsigned char **page; /* [pages]; NULL: as in the file */
};

/* A journal is a heading; for each page its place, its size and its bytes; and the CRC-32 of all that. */
typedef struct Heading {
  char words[16];
  int64_t before, end; /* bytes of the file when the journal was written, and when it has been put in */
  int64_t count;
} Heading;

static const char heading_words[16] = "Breccia journal";

Journal *journal_create(const char *path, int64_t kept)
{
  Journal *journal = memory_plain(1, sizeof *journal);
  if (!journal) return NULL;
  journal->kept = kept;
  journal->pages = kept / PAGE + 1;
  journal->path = text_format("%s.journal", path);
  journal->part = text_format("%s.journal.part", path);
  journal->page = memory_plain((size_t)journal->pages, sizeof *journal->page);
  if (!journal->path || !journal->part || !journal->page) journal_destroy(&journal);
  return journal;
}

void journal_destroy(Journal **journal)
{
  Journal *j = *journal;
  if (!j) return;
  for (int64_t k = 0; j->page && k < j->pages; ++k) free(j->page[k]);
  free(j->page);
  free(j->path);
  free(j->part);
  free(j);
  *journal = NULL;
}

void journal_keep(Journal *journal, int64_t kept)
{
  if (kept < journal->kept) journal->kept = kept;
}

/** Bytes of the k-th page that are kept. */
static size_t page_size(const Journal *journal, int64_t k)
{
  const int64_t left = journal->kept - k * PAGE;
  return left > PAGE ? PAGE : left > 0 ? (size_t)left : 0;
}

/** Reads bytes that are all there. @return 0, or errno of what failed */
static int read_at(int descriptor, void *bytes, size_t size, int64_t from)
{
  const int64_t n = file_read_at(descriptor, bytes, size, from);
  return n < 0 ? errno : n < (int64_t)size ? EIO : 0;
}

size_t journal_share(const Journal *journal, int64_t from, size_t size)
{
  const int64_t most = journal->kept - from;
  return most <= 0 ? 0 : most < (int64_t)size ? (size_t)most : size;
}

int journal_write(Journal *j, int descriptor, int64_t from, size_t size, const void *bytes)
{
  for (const char *at = bytes; size;) {
    const int64_t k = from / PAGE;
    const size_t inside = (size_t)(from % PAGE), n = size < PAGE - inside ? size : PAGE - inside;
    if (!j->page[k]) {
      j->page[k] = memory_plain(1, PAGE);
      const int cause = j->page[k] ? read_at(descriptor, j->page[k], page_size(j, k), k * PAGE) : ENOMEM;
      if (cause) return cause;
    }
    memcpy(j->page[k] + inside, at, n);
    at += n;
    from += (int64_t)n;
    size -= n;
  }
  return 0;
}

void journal_overlay(const Journal *j, int64_t from, size_t size, void *bytes)
{
  size = journal_share(j, from, size);
  for (char *at = bytes; size;) {
    const int64_t k = from / PAGE;
    const size_t inside = (size_t)(from % PAGE), n = size < PAGE - inside ? size : PAGE - inside;
    if (j->page[k]) memcpy(at, j->page[k] + inside, n);
    at += n;
    from += (int64_t)n;
    size -= n;
  }
}

void journal_drop(Journal *journal, int descriptor)
{
  (void)!ftruncate(descriptor, (off_t)journal->kept); /* what stays behind the end harms nobody */
}

/** The journal of what is held, to be freed; NULL: out of memory. */
static unsigned char *compose(const Journal *j, int64_t before, int64_t end, size_t *size)
{
  Heading heading = {.before = before, .end = end};
  memcpy(heading.words, heading_words, sizeof heading.words);
  for (int64_t k = 0; k < j->pages; ++k) heading.count += j->page[k] && page_size(j, k);
  unsigned char *all = memory_plain((size_t)heading.count + 1, 2 * sizeof(int64_t) + PAGE + sizeof heading), *at = all;
  if (!all) return NULL;
  memcpy(at, &heading, sizeof heading);
  at += sizeof heading;
  for (int64_t k = 0; k < j->pages; ++k) {
    const int64_t place[2] = {k * PAGE, (int64_t)page_size(j, k)};
    if (!j->page[k] || !place[1]) continue;
    memcpy(at, place, sizeof place);
    memcpy(at + sizeof place, j->page[k], (size_t)place[1]);
    at += sizeof place + (size_t)place[1];
  }
  const uint32_t sum = checksum_of(all, (size_t)(at - all));
  memcpy(at, &sum, sizeof sum);
  *size = (size_t)(at - all) + sizeof sum;
  return all;
}

/** Puts a whole journal into the file. @return 0, or errno */
static int put_in(int descriptor, const unsigned char *all)
{
  Heading heading;
  memcpy(&heading, all, sizeof heading);
  all += sizeof heading;
  for (int64_t n = 0; n < heading.count; ++n) {
    int64_t place[2];
    memcpy(place, all, sizeof place);
    all += sizeof place;
    const int cause = file_write_at(descriptor, all, (size_t)place[1], place[0]);
    if (cause) return cause;
    all += place[1];
  }
  return ftruncate(descriptor, (off_t)heading.end) || file_settle(descriptor) ? errno : 0;
}

/** Writes the journal beside the file. @return 0, or errno: then it is not there */
static int write_journal(const Journal *j, const unsigned char *all, size_t size)
{
  const int file = regular_file_open(j->part, O_WRONLY | O_CREAT | O_TRUNC);
  int cause = file < 0 ? errno : file_write_at(file, all, size, 0);
  if (!cause && file_settle(file)) cause = errno;
  if (file >= 0 && close(file) && !cause) cause = errno;
  if (!cause && rename(j->part, j->path)) cause = errno;
  if (!cause && folder_of_file_settle(j->path)) {
    cause = errno;
    unlink(j->path);
  }
  if (cause) unlink(j->part);
  return cause;
}

int journal_commit(Journal *j, int descriptor, int64_t end)
{
  struct stat status;
  size_t size;
  if (file_settle(descriptor) || fstat(descriptor, &status)) return errno;
  unsigned char *all = compose(j, status.st_size, end, &size);
  int cause = all ? write_journal(j, all, size) : ENOMEM;
  if (cause)
    journal_drop(j, descriptor);
  else if (!(cause = put_in(descriptor, all)) && unlink(j->path))
    cause = errno;
  free(all);
  return cause;
}

/** Whether the bytes are a whole journal of a file of so many bytes. */
static bool fits(const char *all, size_t size, int64_t bytes)
{
  Heading heading;
  uint32_t sum;
  if (size < sizeof heading + sizeof sum) return false;
  memcpy(&heading, all, sizeof heading);
  memcpy(&sum, all + size - sizeof sum, sizeof sum);
  return !memcmp(heading.words, heading_words, sizeof heading.words) && sum == checksum_of(all, size - sizeof sum) &&
         (bytes == heading.before || bytes == heading.end);
}

int journal_finish(const char *path, Error *error)
{
  char *beside = text_format("%s.journal", path), *part = text_format("%s.journal.part", path);
  int status = beside && part ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  if (part) unlink(part);
  struct stat now;
  size_t size = 0;
  char *all = status || access(beside, F_OK) ? NULL : text_read_file(beside, &size);
  const int file = all ? regular_file_open(path, O_WRONLY) : -1;
  if (!all) {
    if (!status && errno != ENOENT) status = error_add(error, BRECCIA_FAILURE, "%s: %s", beside, strerror(errno));
  } else if (file < 0 || fstat(file, &now)) {
    status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, regular_file_problem(errno));
  } else if (!fits(all, size, now.st_size)) {
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s: is damaged, or not of the %s beside it; put back both as they were, or run again", beside,
                       strrchr(path, '/') ? strrchr(path, '/') + 1 : path);
  } else {
    int cause = put_in(file, (unsigned char *)all);
    if (!cause && unlink(beside)) cause = errno;
    if (cause) status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, strerror(cause));
  }
  if (file >= 0) close(file); /* settled */
  free(all);
  free(part);
  free(beside);
  return status;
}

bool journal_is_there(const char *path)
{
  char *beside = text_format("%s.journal", path);
  const bool there = beside && !access(beside, F_OK);
  free(beside);
  return there;
}

int journal_forget(const char *path)
{
  char *beside = text_format("%s.journal", path), *part = text_format("%s.journal.part", path);
  int cause = beside && part ? 0 : ENOMEM;
  if (!cause && ((unlink(beside) && errno != ENOENT) || (unlink(part) && errno != ENOENT))) cause = errno;
  free(part);
  free(beside);
  return cause;
}
