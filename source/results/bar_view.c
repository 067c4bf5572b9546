#include "results/bar_view.h"

#include "base/memory.h"
#include "results/bar_columns.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool has(const ResultView *view, const char *column)
{
  char path[128];
  snprintf(path, sizeof path, "Breccia/Bars/%s", column);
  return *column && !strchr(column, '/') && H5Lexists(view->file.id, path, H5P_DEFAULT) > 0;
}

/** Finds the names in their list. @return whether there is one for each line */
static bool find_names(BarView *b, int64_t bytes)
{
  int64_t at = 0;
  for (int n = 0; n < b->lines; ++n) {
    const char *end = at < bytes ? memchr(b->names + at, 0, (size_t)(bytes - at)) : NULL;
    if (!end) return false;
    b->name[n] = b->names + at;
    at = end - b->names + 1;
  }
  return at == bytes;
}

/** Nodes of each line, two at least, one line after the other. */
static bool lines_make_sense(const BarView *b)
{
  for (int n = 0; n < b->lines; ++n)
    if (b->first[n + 1] - b->first[n] < 2) return false;
  return b->lines > 0 && b->first[0] == 0 && b->first[b->lines] == b->nodes;
}

int bar_view_open(BarView *b, const ResultView *view, Error *error)
{
  *b = (BarView){.lines = 0};
  if (view->frequency_count)
    return error_add(error, BRECCIA_USER_ERROR,
                     "modes of vibration are written without bars; draw a field, like displacement, or bars of a run");
  if (H5Lexists(view->file.id, "Breccia/Bars", H5P_DEFAULT) <= 0)
    return error_add(error, BRECCIA_USER_ERROR,
                     "the result file holds no bars: the deck has none ('bars'), or it was written by a version "
                     "without them; run it again");
  int64_t rows = 0, bytes = 0;
  b->points = result_view_numbers(view, "Breccia/Bars/Points", H5T_NATIVE_DOUBLE, sizeof(double), &b->nodes, error);
  if (b->points)
    b->first = result_view_numbers(view, "Breccia/Bars/Lines", H5T_NATIVE_INT64, sizeof(int64_t), &rows, error);
  if (b->first) b->names = result_view_numbers(view, "Breccia/Bars/Names", H5T_NATIVE_UINT8, 1, &bytes, error);
  int status = b->names ? BRECCIA_OK : result_view_lost(view);
  if (!status) {
    b->lines = (int)rows - 1;
    b->name = memory_plain((size_t)(rows + 1), sizeof *b->name);
    if (!b->name)
      status = error_add(error, BRECCIA_FAILURE, "out of memory: bars");
    else if (view->file.error || !lines_make_sense(b) || !find_names(b, bytes))
      status = result_view_say_damaged(view, "Breccia/Bars", error);
  }
  if (status) {
    bar_view_close(b);
    return status;
  }
  b->elements = b->nodes - b->lines;
  for (int n = 0; n <= b->lines; ++n) b->first[n] -= n;
  return BRECCIA_OK;
}

void bar_view_close(BarView *b)
{
  free(b->first);
  free(b->points);
  free(b->name);
  free(b->names);
  *b = (BarView){.lines = 0};
}

double *bar_view_read(const BarView *b, const ResultView *view, const char *column, int step, char *unit, Error *error)
{
  if (!bar_column_find(column) || !has(view, column)) {
    Text names = {0};
    for (int k = 0; bar_column_at(k); ++k)
      if (has(view, bar_column_at(k)->name)) text_add(&names, "%s%s", names.length ? ", " : "", bar_column_at(k)->name);
    error_add(error, BRECCIA_USER_ERROR, "bars have no '%s' in the result file; it holds %s of them", column,
              names.length ? text_words(&names) : "nothing");
    text_free(&names);
    return NULL;
  }
  char path[128];
  snprintf(path, sizeof path, "Breccia/Bars/%s", column);
  return result_view_state(view, path, step, b->elements, 1, unit, error);
}

double *bar_view_displacements(const BarView *b, const ResultView *view, int step, Error *error)
{
  return result_view_state(view, "Breccia/Bars/displacement", step, b->nodes, 3, NULL, error);
}

double *bar_view_along(const BarView *b, Error *error)
{
  double *along = memory_zeroed((size_t)b->elements + 1, sizeof *along, "bars", error);
  for (int n = 0; along && n < b->lines; ++n) {
    double before = 0;
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      const double *p = b->points + 3 * (e + n),
                   length = sqrt(pow(p[3] - p[0], 2) + pow(p[4] - p[1], 2) + pow(p[5] - p[2], 2));
      along[e] = before + length / 2;
      before += length;
    }
  }
  return along;
}
