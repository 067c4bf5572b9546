#include "results/plot.h"

#include "base/text.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

static void quote(Text *script, const char *words)
{
  text_add(script, "\"");
  for (; *words; ++words) text_add(script, *words == '"' || *words == '\\' ? "\\%c" : "%c", *words);
  text_add(script, "\"");
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

int plot_draw(const PlotLine *lines, int count, const PlotOptions *o, const char *path, Error *error)
{
  static const char *const colours[] = {"#3b3f87", "#c8501e", "#21918c", "#8a2f7d", "#7a7a1e"};
  const char *dot = strrchr(path, '.');
  Text script = {0};
  for (int k = 0; k < count; ++k) {
    text_add(&script, "$data%d << END\n", k);
    for (int i = 0; i < lines[k].count; ++i)
      if (isfinite(lines[k].x[i]) && isfinite(lines[k].y[i]))
        text_add(&script, "%.9g %.9g\n", lines[k].x[i], lines[k].y[i]);
    text_add(&script, "END\n");
  }
  const char *terminal = !dot || !strcmp(dot, ".png") ? "pngcairo size 760,520 font \"sans,12\""
                         : !strcmp(dot, ".svg")       ? "svg size 760,520 font \"sans,12\""
                                                      : "pdfcairo size 16cm,11cm font \"sans,11\"";
  text_add(&script, "set terminal %s\nset output ", terminal);
  quote(&script, path);
  text_add(&script, "\nset title ");
  quote(&script, o->title);
  text_add(&script, " noenhanced\nset xlabel ");
  quote(&script, o->x_label);
  text_add(&script, " noenhanced\nset ylabel ");
  quote(&script, o->y_label);
  text_add(&script, " noenhanced\nset grid lc rgb \"#dddddd\"\nset border lc rgb \"#333333\"\n");
  text_add(&script, count > 1 ? "set key bottom right opaque\n" : "unset key\n");
  text_add(&script, "set datafile separator whitespace\nset offsets 0, 0, graph 0.04, graph 0.04\n");
  if (isfinite(o->low) && isfinite(o->high)) text_add(&script, "set xrange [%.9g:%.9g]\n", o->low, o->high);
  text_add(&script, "plot ");
  for (int k = 0; k < count; ++k) {
    text_add(&script, "%s$data%d using 1:2 with ", k ? ", " : "", k);
    if (lines[k].points)
      text_add(&script, "points pt 6 ps 1.3 lc rgb \"#000000\" title ");
    else
      text_add(&script, "lines lw 2 lc rgb \"%s\" title ", colours[k % 5]);
    quote(&script, lines[k].title);
    text_add(&script, " noenhanced");
  }
  text_add(&script, "\n");
  int status = run_gnuplot(&script, path, error);
  text_free(&script);
  return status;
}
