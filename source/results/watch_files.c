/* Histories as CSV files: headings, rows, and how they are taken up again. */
#include "results/watch_parts.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void write_header(FILE *file, const Kind *kind, const Units *units)
{
  char time[64], columns[1024], *rest = columns;
  units_name(units, dimension_find("time"), time, sizeof time);
  snprintf(columns, sizeof columns, "%s", kind->columns);
  fprintf(file, "step,time (%s)", time);
  while (*rest) {
    char *colon = strchr(rest, ':'), *comma = strchr(colon, ','), unit[64];
    *colon = 0;
    if (comma) *comma = 0;
    units_name(units, dimension_find(colon + 1), unit, sizeof unit);
    if (*unit)
      fprintf(file, ",%s (%s)", rest, unit);
    else
      fprintf(file, ",%s", rest);
    rest = comma ? comma + 1 : colon + 1 + strlen(colon + 1);
  }
  fprintf(file, "\n");
}

/** Whether a text begins with the whole row of a step, with so many columns. */
static bool is_row_of(const char *text, int64_t step, int columns)
{
  char *end;
  const size_t length = strcspn(text, "\n");
  if (!text[length] || strtoll(text, &end, 10) != step || *end != ',') return false;
  int commas = 0;
  for (size_t k = 0; k < length; ++k) commas += text[k] == ',';
  return commas == columns + 1;
}

/** Whether there is a row of a step that is done. */
static bool is_due(const Watch *w, const Solver *solver, int64_t step)
{
  enum { USUAL = 10 };
  if (w->spec->every > 0) return step % w->spec->every == 0;
  return step % USUAL == 0 || solver_step_was_long(solver, step);
}

/** Cuts a history file behind the last row that is due and not beyond the step from which the run goes on. All rows since the run began must
 *  be there. */
static int take_up_rows(Watch *w, const Solver *solver, int64_t began, Error *error)
{
  const int64_t step = solver->clock.step;
  size_t length;
  char *text = text_read_file(w->path, &length), *row = text ? strchr(text, '\n') : NULL;
  if (!text)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: %s; the run goes on from step %lld and needs its rows up to there: put the file back, or run "
                     "without --restart",
                     w->path, strerror(errno), (long long)step);
  const int columns = watch_columns(w->kind);
  int64_t line = 2, missing = -1;
  row = row ? row + 1 : text + length;
  for (int64_t due = began; due <= step && missing < 0; ++due) {
    if (!is_due(w, solver, due)) continue;
    if (is_row_of(row, due, columns)) {
      w->last_step = due;
      row = strchr(row, '\n') + 1;
      ++line;
    } else
      missing = due;
  }
  int status = BRECCIA_OK;
  if (missing >= 0)
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s:%lld: expected the row of step %lld; the run goes on from step %lld and needs all rows up "
                       "to there: put the file back as it was, or run without --restart",
                       w->path, (long long)line, (long long)missing, (long long)step);
  else if (truncate(w->path, row - text))
    status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
  free(text);
  return status;
}

int watches_open(Watches *watches, const char *folder, const Units *units, const Solver *solver, int64_t began,
                 bool resume, Error *error)
{
  for (int k = 0; k < watches->count; ++k) {
    Watch *w = &watches->items[k];
    char name[160];
    text_file_name(w->spec->head.name, name, sizeof name);
    free(w->path);
    w->path = text_format("%s/%s.csv", folder, name);
    if (!w->path) return error_add(error, BRECCIA_FAILURE, "out of memory: watches");
    const int status = resume ? take_up_rows(w, solver, began, error) : BRECCIA_OK;
    if (status) return status;
    w->file = fopen(w->path, resume ? "a" : "w");
    if (!w->file) return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
    if (!resume) write_header(w->file, w->kind, units);
  }
  return BRECCIA_OK;
}

int watches_settle(const Watches *watches, Error *error)
{
  for (int k = 0; k < watches->count; ++k) {
    const Watch *w = &watches->items[k];
    if (fflush(w->file) || (fsync(fileno(w->file)) && errno != EINVAL))
      return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
  }
  return BRECCIA_OK;
}

int watches_write(Watches *watches, const Solver *solver, bool last, Error *error)
{
  for (int k = 0; k < watches->count; ++k) {
    Watch *w = &watches->items[k];
    if (w->last_step == solver->clock.step || (!last && !is_due(w, solver, solver->clock.step))) continue;
    double values[MOST_COLUMNS];
    const int columns = watch_columns(w->kind);
    w->kind->row(w, solver, values);
    fprintf(w->file, "%lld,%.10g", (long long)solver->clock.step, solver->clock.time);
    for (int c = 0; c < columns; ++c) fprintf(w->file, ",%.17g", values[c]);
    fprintf(w->file, "\n");
    if (fflush(w->file))
      return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
    w->last_step = solver->clock.step;
  }
  return BRECCIA_OK;
}

int watches_close(Watches *watches, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < watches->count; ++k) {
    Watch *w = &watches->items[k];
    if (w->file && fclose(w->file) && !status)
      status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
    w->file = NULL;
  }
  return status;
}

const char *watches_path(const Watches *watches, int k)
{
  return watches->items[k].path;
}
