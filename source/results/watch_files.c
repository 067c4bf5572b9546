/* Histories as CSV files: headings, rows, and how they are taken up again. */
#include "results/watch_parts.h"

#include "base/checksum.h"
#include "base/regular_file.h"
#include "base/whole_file.h"
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void add_header(Text *text, const Kind *kind, const Units *units)
{
  char time[64], columns[1024], *rest = columns;
  units_name(units, dimension_find("time"), time, sizeof time);
  snprintf(columns, sizeof columns, "%s", kind->columns);
  text_add(text, "step,time (%s)", time);
  while (*rest) {
    char *colon = strchr(rest, ':'), *comma = strchr(colon, ','), unit[64];
    *colon = 0;
    if (comma) *comma = 0;
    units_name(units, dimension_find(colon + 1), unit, sizeof unit);
    if (*unit)
      text_add(text, ",%s (%s)", rest, unit);
    else
      text_add(text, ",%s", rest);
    rest = comma ? comma + 1 : colon + 1 + strlen(colon + 1);
  }
  text_add(text, "\n");
}

bool watch_is_due(int64_t every, const Solver *solver, int64_t step)
{
  enum { USUAL = 10 };
  if (every > 0) return step % every == 0;
  return step % USUAL == 0 || solver_step_was_long(solver, step);
}

/** Adds words to a history's file. @param[in] kept  whether they stay when the run is taken up again
 *  @return 0, or 1 with errno set */
static int put(Watch *w, const Text *words, bool kept)
{
  errno = ENOMEM;
  if (words->failed) return 1;
  w->bytes += (int64_t)words->length;
  if (kept) {
    w->kept_bytes = w->bytes;
    w->kept_sum = checksum_with((uint32_t)w->kept_sum, text_words(words), words->length);
  }
  return fwrite(text_words(words), 1, words->length, w->file) != words->length;
}

static char *path_in(const char *folder, const Watch *w)
{
  char name[WATCH_FILE];
  text_file_name(w->spec->head.name, name, sizeof name);
  return text_format("%s/%s.csv", folder, name);
}

/** The disk fails: the file may be whole. */
static int say_unread(const char *path, Error *error)
{
  return error_add(error, BRECCIA_FAILURE, "%s: cannot be read: %s", path, strerror(EIO));
}

/** Computes the checksum of at most so many bytes of a history, which must be a regular file.
 *  @return 0, or 1 with the cause in errno */
static int checksum_of_history(const char *path, int64_t most, uint32_t *sum, int64_t *count)
{
  const int file = regular_file_open(path, O_RDONLY);
  if (file < 0) return 1;
  const int bad = checksum_of_descriptor(file, 0, most, sum, count), cause = errno;
  close(file);
  errno = cause;
  return bad;
}

static int check_rows(const Watch *w, const char *path, int64_t step, Error *error)
{
  uint32_t sum;
  int64_t count;
  const bool unread = checksum_of_history(path, w->kept_bytes, &sum, &count) != 0;
  if (unread && errno == EIO) return say_unread(path, error);
  if (unread)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: %s; the run goes on from step %lld and needs its rows up to there: put the file back, or "
                     "run without --restart",
                     path, regular_file_problem(errno), (long long)step);
  if (count < w->kept_bytes || sum != (uint32_t)w->kept_sum)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: its rows up to step %lld, from which the run goes on, are not all as they were written; put "
                     "the file back as it was, or run without --restart",
                     path, (long long)step);
  return BRECCIA_OK;
}

int watches_check(const Watches *watches, const char *folder, int64_t step, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < watches->count && !status; ++k) {
    char *path = path_in(folder, &watches->items[k]);
    status = path ? check_rows(&watches->items[k], path, step, error)
                  : error_add(error, BRECCIA_FAILURE, "out of memory: watches");
    free(path);
  }
  return status;
}

int watches_refuse_links(const Watches *watches, const char *folder, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < watches->count && !status; ++k) {
    char *path = path_in(folder, &watches->items[k]);
    const int cause = path ? regular_file_look(path) : ENOMEM;
    if (!path)
      status = error_add(error, BRECCIA_FAILURE, "out of memory: watches");
    else if (cause == ELOOP || cause == ESPIPE)
      status = error_add(error, BRECCIA_USER_ERROR, "%s: cannot be written: %s", path, regular_file_problem(cause));
    free(path);
  }
  return status;
}

int watches_spare(const Watches *watches, const char *folder, const char *files, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < watches->count && *files && !status; ++k) {
    char *path = path_in(folder, &watches->items[k]), *bytes = NULL;
    uint32_t sum;
    int64_t count;
    if (path && !checksum_of_history(path, INT64_MAX, &sum, &count))
      bytes = text_format("%08" PRIx32 " %" PRId64 " ", sum, count);
    else if (path && errno == EIO)
      status = say_unread(path, error);
    for (const char *line = files; bytes && *line && !status; line += strcspn(line, "\n") + 1)
      if (!strncmp(line, bytes, strlen(bytes)))
        status = error_add(error, BRECCIA_USER_ERROR,
                           "%s: is what the deck reads as '%.*s', and a history would be written over it: give the "
                           "history another name, or the results a folder of their own by --output",
                           path, (int)(strcspn(line, "\n") - strlen(bytes)), line + strlen(bytes));
    free(bytes);
    free(path);
  }
  return status;
}

int watches_open(Watches *watches, const char *folder, const Units *units, bool resume, Error *error)
{
  for (int k = 0; k < watches->count; ++k) {
    Watch *w = &watches->items[k];
    free(w->path);
    w->path = path_in(folder, w);
    if (!w->path) return error_add(error, BRECCIA_FAILURE, "out of memory: watches");
    w->file = regular_file_stream(w->path, resume ? "a" : "w");
    if (!w->file || (resume && ftruncate(fileno(w->file), (off_t)w->kept_bytes)))
      return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, regular_file_problem(errno));
    if (resume) {
      w->bytes = w->kept_bytes;
      w->last_step = w->kept_step;
      continue;
    }
    fcntl(fileno(w->file), F_SETFL, O_APPEND); /* what somebody else cuts off is missed then, and leaves no hole */
    w->bytes = w->kept_sum = 0;
    w->last_step = w->kept_step = -1;
    Text heading = {0};
    add_header(&heading, w->kind, units);
    const int bad = put(w, &heading, true);
    text_free(&heading);
    if (bad) return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
  }
  return BRECCIA_OK;
}

void watches_state(Watches *watches, StateList *list)
{
  for (int k = 0; k < watches->count; ++k) {
    Watch *w = &watches->items[k];
    const struct {
      const char *what;
      int64_t *value;
    } rows[] = {{"bytes", &w->kept_bytes}, {"checksum", &w->kept_sum}, {"last step", &w->kept_step}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; ++r) {
      char name[40];
      snprintf(name, sizeof name, "history %d: %s", k + 1, rows[r].what);
      state_add_count(list, name, STATE_COMMITTED, rows[r].value);
    }
  }
}

int watches_settle(const Watches *watches, Error *error)
{
  for (int k = 0; k < watches->count; ++k) {
    const Watch *w = &watches->items[k];
    if (fflush(w->file) || file_settle(fileno(w->file)))
      return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
  }
  return BRECCIA_OK;
}

int watches_write(Watches *watches, const Solver *solver, bool last, Error *error)
{
  for (int k = 0; k < watches->count; ++k) {
    Watch *w = &watches->items[k];
    if (w->last_step == solver->clock.step || (!last && !watch_is_due(w->spec->every, solver, solver->clock.step)))
      continue;
    double values[MOST_COLUMNS];
    const int columns = watch_columns(w->kind);
    Text row = {0};
    w->kind->row(w, solver, values);
    text_add(&row, "%lld,%.10g", (long long)solver->clock.step, solver->clock.time);
    for (int c = 0; c < columns; ++c) text_add(&row, ",%.17g", values[c]);
    text_add(&row, "\n");
    const bool due = watch_is_due(w->spec->every, solver, solver->clock.step),
               bad = put(w, &row, due) || fflush(w->file);
    text_free(&row);
    if (bad) return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
    w->last_step = solver->clock.step;
    if (due) w->kept_step = w->last_step;
  }
  return BRECCIA_OK;
}

/** Whether what was written into a history's file is in the file of that name. */
static bool is_in_place(const Watch *w)
{
  struct stat own, named;
  return !fstat(fileno(w->file), &own) && !lstat(w->path, &named) && own.st_ino == named.st_ino &&
         own.st_dev == named.st_dev && own.st_size == w->bytes;
}

int watches_close(Watches *watches, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < watches->count; ++k) {
    Watch *w = &watches->items[k];
    const bool lost = w->file && !fflush(w->file) && !is_in_place(w);
    if (w->file && fclose(w->file) && !status)
      status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
    if (lost && !status)
      status = error_add(error, BRECCIA_FAILURE,
                         "%s: was removed, replaced or changed while the run wrote it, and lacks rows; run again for "
                         "them",
                         w->path);
    w->file = NULL;
  }
  return status;
}

const char *watches_path(const Watches *watches, int k)
{
  return watches->items[k].path;
}
