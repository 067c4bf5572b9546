#include "results/plot.h"

#include "base/program.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** In single quotes, between which gnuplot reads no escapes and runs no commands. */
static void quote(Text *script, const char *words)
{
  text_add(script, "'");
  for (; *words; ++words) text_add(script, *words == '\'' ? "''" : "%c", *words == '\n' ? ' ' : *words);
  text_add(script, "'");
}

/** Runs a script that draws into `part`, which becomes the picture once it is whole. */
static int run_gnuplot(const Text *script, const char *part, const char *path, Error *error)
{
  static const char *const words[] = {"gnuplot", NULL};
  Text reason = {0};
  int status = BRECCIA_OK;
  const ProgramEnd end = program_run(words, script->characters, script->length, &reason);
  if (end == PROGRAM_MISSING)
    status = error_add(error, BRECCIA_FAILURE,
                       "curves are drawn by gnuplot, which is not installed: install it (Debian: apt install "
                       "gnuplot-nox) and draw again; all other files are written");
  else if (end == PROGRAM_FAILED)
    status = error_add(error, BRECCIA_FAILURE, "%s: not drawn: %s", path, reason.characters);
  else if (rename(part, path))
    status = error_add(error, BRECCIA_FAILURE, "%s: not drawn: %s", path,
                       errno == ENOENT ? "gnuplot ended without a picture" : strerror(errno));
  if (status) remove(part);
  text_free(&reason);
  return status;
}

int plot_draw(const PlotLine *lines, int count, const PlotOptions *o, const char *path, Error *error)
{
  static const char *const colours[] = {"#3b3f87", "#c8501e", "#21918c", "#8a2f7d", "#7a7a1e"};
  const char *dot = strrchr(path, '.');
  char *part = text_format("%s.part", path);
  Text script = {0};
  if (!part) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
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
  quote(&script, part);
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
  int status = run_gnuplot(&script, part, path, error);
  text_free(&script);
  free(part);
  return status;
}
