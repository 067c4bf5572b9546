#include "results/curve.h"

#include "base/csv.h"
#include "base/text.h"
#include "results/plot.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Splits "watch.column" at its last dot and reads that column, with the steps of its rows. */
static double *history_column(const char *folder, const char *name, double **steps, int *count, char *label,
                              Error *error)
{
  char watch[160];
  const char *dot = strrchr(name, '.');
  if (!dot || dot == name) {
    error_add(error, BRECCIA_USER_ERROR, "curve: '%s' should be watch.column, like opening.distance", name);
    return NULL;
  }
  char words[160];
  snprintf(words, sizeof words, "%.*s", (int)(dot - name), name);
  text_file_name(words, watch, sizeof watch);
  char *path = text_format("%s/%s.csv", folder, watch), ignored[128];
  double *values = NULL;
  *steps = csv_column(path, "step", CSV_LIVING, count, ignored, error);
  if (*steps) values = csv_column(path, dot + 1, CSV_LIVING, count, label, error);
  free(path);
  char whole[300];
  snprintf(whole, sizeof whole, "%s: %s", words, label);
  snprintf(label, 128, "%.127s", whole);
  return values;
}

static void trim(char *words)
{
  size_t n = strlen(words);
  while (n && words[n - 1] == ' ') words[--n] = 0;
  size_t lead = strspn(words, " ");
  memmove(words, words + lead, n - lead + 1);
}

typedef struct Axes {
  char x[160], y[160], x_label[128], y_label[128];
} Axes;

/** The two columns of a folder's histories, on rows of the same step, into `x` and `y` (to be freed). @return their number, or -1 */
static int read_line(const char *folder, Axes *axes, double **x, double **y, Error *error)
{
  int nx = 0, ny = 0, count = -1;
  double *sx = NULL, *sy = NULL;
  *x = history_column(folder, axes->x, &sx, &nx, axes->x_label, error);
  *y = *x ? history_column(folder, axes->y, &sy, &ny, axes->y_label, error) : NULL;
  if (*x && *y) {
    count = 0;
    for (int i = 0, j = 0; i < nx && j < ny;) {
      if (sx[i] < sy[j])
        ++i;
      else if (sx[i] > sy[j])
        ++j;
      else { /* never further than what was read of either */
        (*x)[count] = (*x)[i++];
        (*y)[count++] = (*y)[j++];
      }
    }
  }
  free(sx);
  free(sy);
  return count;
}

static const char *name_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash && slash[1] ? slash + 1 : path;
}

int curve_points(const char *path, double **x, double **y, int *count, Error *error)
{
  char *text = text_read_file(path, NULL);
  *x = *y = NULL;
  *count = 0;
  if (!text) return error_add(error, BRECCIA_USER_ERROR, "%s: %s", path, strerror(errno));
  size_t rows = 1;
  for (const char *c = text; *c; ++c) rows += *c == '\n';
  *x = malloc(sizeof(double) * rows);
  *y = malloc(sizeof(double) * rows);
  char *rest = NULL;
  for (char *row = strtok_r(text, "\n", &rest); *x && *y && row; row = strtok_r(NULL, "\n", &rest))
    if (sscanf(row, "%lf ,%lf", &(*x)[*count], &(*y)[*count]) == 2) ++*count;
  free(text);
  if (*count) return BRECCIA_OK;
  return error_add(error, BRECCIA_USER_ERROR, "%s: no row begins with two numbers, x and y with a comma between", path);
}

int curve_draw(const char *const *folders, int folder_count, const char *curve, const CurveOptions *o, const char *path,
               Error *error)
{
  Axes axes = {0};
  const char *colon = strchr(curve, ':');
  if (!colon) return error_add(error, BRECCIA_USER_ERROR, "curve: '%s' should be 'watch.column : watch.column'", curve);
  snprintf(axes.x, sizeof axes.x, "%.*s", (int)(colon - curve), curve);
  snprintf(axes.y, sizeof axes.y, "%s", colon + 1);
  trim(axes.x);
  trim(axes.y);
  const int most = folder_count + 1;
  PlotLine *lines = calloc((size_t)most, sizeof *lines);
  double **values = calloc((size_t)most * 2, sizeof *values);
  int status = lines && values ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: curves"), count = 0;
  for (int k = 0; k < folder_count && !status; ++k) {
    int rows = read_line(folders[k], &axes, &values[2 * k], &values[2 * k + 1], error);
    if (rows < 0) status = BRECCIA_USER_ERROR;
    lines[count++] = (PlotLine){name_of(folders[k]), values[2 * k], values[2 * k + 1], rows, false};
  }
  if (o->overlay && !status) {
    int rows;
    status = curve_points(o->overlay, &values[2 * count], &values[2 * count + 1], &rows, error);
    lines[count] = (PlotLine){name_of(o->overlay), values[2 * count], values[2 * count + 1], rows, true};
    ++count;
  }
  const PlotOptions plot = {o->title, axes.x_label, axes.y_label, o->low, o->high};
  if (!status) status = plot_draw(lines, count, &plot, path, error);
  for (int k = 0; values && k < 2 * most; ++k) free(values[k]);
  free(values);
  free(lines);
  return status;
}
