#include "results/curve.h"

#include "base/csv.h"
#include "base/text.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

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

static void quote(Text *script, const char *words)
{
  text_add(script, "\"");
  for (; *words; ++words) text_add(script, *words == '"' || *words == '\\' ? "\\%c" : "%c", *words);
  text_add(script, "\"");
}

typedef struct Axes {
  char x[160], y[160], x_label[128], y_label[128];
} Axes;

static int add_data(Text *script, const char *folder, int number, Axes *axes, Error *error)
{
  int nx = 0, ny = 0;
  double *sx = NULL, *sy = NULL, *x = history_column(folder, axes->x, &sx, &nx, axes->x_label, error), *y = NULL;
  if (x) y = history_column(folder, axes->y, &sy, &ny, axes->y_label, error);
  if (x && y) {
    text_add(script, "$data%d << END\n", number);
    for (int i = 0, j = 0; i < nx && j < ny;) { /* rows of the same step */
      if (sx[i] < sy[j])
        ++i;
      else if (sx[i] > sy[j])
        ++j;
      else {
        if (isfinite(x[i]) && isfinite(y[j])) text_add(script, "%.9g %.9g\n", x[i], y[j]);
        ++i;
        ++j;
      }
    }
    text_add(script, "END\n");
  }
  int failed = !x || !y;
  free(x);
  free(y);
  free(sx);
  free(sy);
  return failed ? BRECCIA_USER_ERROR : BRECCIA_OK;
}

/** The first two columns of a CSV file; rows that do not begin with a number are headings. */
static int add_overlay(Text *script, const char *path, Error *error)
{
  char *text = text_read_file(path, NULL);
  if (!text) return error_add(error, BRECCIA_USER_ERROR, "%s: %s", path, strerror(errno));
  text_add(script, "$overlay << END\n");
  char *rest = NULL;
  for (char *row = strtok_r(text, "\n", &rest); row; row = strtok_r(NULL, "\n", &rest)) {
    double x, y;
    if (sscanf(row, "%lf ,%lf", &x, &y) == 2) text_add(script, "%.9g %.9g\n", x, y);
  }
  text_add(script, "END\n");
  free(text);
  return BRECCIA_OK;
}

static int run_gnuplot(const Text *script, const char *path, Error *error)
{
  fflush(NULL);
  FILE *pipe = popen("gnuplot 2>/dev/null", "w");
  if (!pipe) return error_add(error, BRECCIA_FAILURE, "gnuplot cannot be started: %s", strerror(errno));
  fwrite(script->characters, 1, script->length, pipe);
  int status = pclose(pipe);
  if (status == 0) return BRECCIA_OK;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    return error_add(error, BRECCIA_FAILURE, "%s: curves are drawn by gnuplot, which is not installed (gnuplot-nox)",
                     path);
  return error_add(error, BRECCIA_FAILURE, "%s: gnuplot could not draw it", path);
}

int curve_draw(const char *const *folders, int folder_count, const char *curve, const CurveOptions *o, const char *path,
               Error *error)
{
  Axes axes = {0};
  const char *colon = strchr(curve, ':'), *dot = strrchr(path, '.');
  if (!colon) return error_add(error, BRECCIA_USER_ERROR, "curve: '%s' should be 'watch.column : watch.column'", curve);
  snprintf(axes.x, sizeof axes.x, "%.*s", (int)(colon - curve), curve);
  snprintf(axes.y, sizeof axes.y, "%s", colon + 1);
  trim(axes.x);
  trim(axes.y);
  Text script = {0};
  int status = BRECCIA_OK;
  for (int k = 0; k < folder_count && !status; ++k) status = add_data(&script, folders[k], k, &axes, error);
  const char *overlay = o->overlay;
  if (overlay && !status) status = add_overlay(&script, overlay, error);
  if (!status) {
    const char *terminal = !dot || !strcmp(dot, ".png") ? "pngcairo size 760,520 font \"sans,12\""
                           : !strcmp(dot, ".svg")       ? "svg size 760,520 font \"sans,12\""
                                                        : "pdfcairo size 16cm,11cm font \"sans,11\"";
    text_add(&script, "set terminal %s\nset output ", terminal);
    quote(&script, path);
    text_add(&script, "\nset title ");
    quote(&script, o->title);
    text_add(&script, " noenhanced\nset xlabel ");
    quote(&script, axes.x_label);
    text_add(&script, " noenhanced\nset ylabel ");
    quote(&script, axes.y_label);
    text_add(&script, " noenhanced\nset grid lc rgb \"#dddddd\"\nset border lc rgb \"#333333\"\n");
    text_add(&script, folder_count > 1 || overlay ? "set key bottom right opaque\n" : "unset key\n");
    text_add(&script, "set datafile separator whitespace\n");
    if (isfinite(o->low) && isfinite(o->high)) text_add(&script, "set xrange [%.9g:%.9g]\n", o->low, o->high);
    text_add(&script, "plot ");
    for (int k = 0; k < folder_count; ++k) {
      static const char *const colours[] = {"#3b3f87", "#c8501e", "#21918c", "#8a2f7d", "#7a7a1e"};
      const char *slash = strrchr(folders[k], '/');
      text_add(&script, "%s$data%d using 1:2 with lines lw 2 lc rgb \"%s\" title ", k ? ", " : "", k, colours[k % 5]);
      quote(&script, slash && slash[1] ? slash + 1 : folders[k]);
      text_add(&script, " noenhanced");
    }
    if (overlay) {
      text_add(&script, ", $overlay using 1:2 with points pt 6 ps 1.3 lc rgb \"#000000\" title ");
      const char *slash = strrchr(overlay, '/');
      quote(&script, slash ? slash + 1 : overlay);
      text_add(&script, " noenhanced");
    }
    text_add(&script, "\n");
    status = run_gnuplot(&script, path, error);
  }
  text_free(&script);
  return status;
}
