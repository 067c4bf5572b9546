#include "results/plot.h"

#include "base/program.h"
#include "base/regular_file.h"
#include "results/display_unit.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define LARGEST 1e290  /* that gnuplot can lay out on an axis, in any unit and with room beyond */
#define NARROWEST 1e-7 /* range, beside its ends, which are written with nine digits */

bool plot_is_logarithmic(const char *log_axes, char axis)
{
  return log_axes && strcmp(log_axes, "none") != 0 && strchr(log_axes, axis);
}

/** In single quotes, between which gnuplot reads no escapes and runs no commands. */
static void quote(Text *script, const char *words)
{
  text_add(script, "'");
  for (; *words; ++words) text_add(script, *words == '\'' ? "''" : "%c", *words == '\n' ? ' ' : *words);
  text_add(script, "'");
}

/** Whether a picture has its end. gnuplot does not look whether closing it succeeded. */
static bool is_whole(const char *picture, const char *path)
{
  char tail[65] = "";
  FILE *file = regular_file_stream(picture, "r");
  if (!file) return false;
  const char *ending = strrchr(path, '.');
  const char *last = !ending || !strcmp(ending, ".png") ? "IEND" : !strcmp(ending, ".svg") ? "</svg>" : "%%EOF";
  if (!fseek(file, 0, SEEK_END) && !fseek(file, ftell(file) > 64 ? -64 : -ftell(file), SEEK_END)) {
    const size_t bytes = fread(tail, 1, 64, file);
    for (size_t k = 0; k < bytes; ++k)
      if (!tail[k]) tail[k] = ' ';
  }
  fclose(file);
  return strstr(tail, last) != NULL;
}

/** Runs a script that draws into `part`, which becomes the picture once it is whole. */
static int run_gnuplot(const Text *script, const char *part, const char *path, bool *missing, Error *error)
{
  static const char *const words[] = {"gnuplot", NULL};
  Text reason = {0};
  struct stat empty;
  int status = BRECCIA_OK;
  const int cause = regular_file_make(part); /* gnuplot would not tell why it cannot */
  if (cause) return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, regular_file_problem(cause));
  const ProgramEnd end = program_run(words, script->characters, script->length, &reason);
  if (missing) *missing |= end == PROGRAM_MISSING;
  if (end == PROGRAM_MISSING)
    status = error_add(error, BRECCIA_FAILURE,
                       "curves are drawn by gnuplot, which is not installed: install it (Debian: apt install "
                       "gnuplot-nox) and draw again; all other files are written");
  else if (end == PROGRAM_FAILED)
    status = error_add(error, BRECCIA_FAILURE, "%s: not drawn: %s", path, reason.characters);
  else if (!stat(part, &empty) && !empty.st_size)
    status = error_add(error, BRECCIA_FAILURE, "%s: not drawn: gnuplot ended without a picture", path);
  else if (!is_whole(part, path))
    status = error_add(error, BRECCIA_FAILURE,
                       "%s: cannot be written: gnuplot ended with half a picture; is the disk full?", path);
  else if (rename(part, path))
    status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
  if (status) remove(part);
  text_free(&reason);
  return status;
}

typedef struct Extent {
  double least, most;
} Extent;

static double larger_end(Extent e)
{
  return e.least <= e.most ? fmax(fabs(e.least), fabs(e.most)) : 0;
}

static bool has_range(const PlotOptions *o)
{
  return isfinite(o->low) && isfinite(o->high);
}

/** Whether a point has a place on both axes. */
static bool is_drawn(const PlotOptions *o, double x, double y)
{
  return isfinite(x) && isfinite(y) && !(o->x.logarithmic && x <= 0) && !(o->y.logarithmic && y <= 0);
}

/** Smallest and largest number of an axis, of points that are drawn; `within`: that lie within the range that was asked for. */
static Extent extent_of(const PlotLine *lines, int count, const PlotOptions *o, bool vertical, bool within)
{
  Extent e = {INFINITY, -INFINITY};
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < lines[k].count; ++i) {
      const double x = lines[k].x[i], y = lines[k].y[i];
      if (!is_drawn(o, x, y) || (within && has_range(o) && !(x >= o->low && x <= o->high))) continue;
      e.least = fmin(e.least, vertical ? y : x);
      e.most = fmax(e.most, vertical ? y : x);
    }
  return e;
}

/** Ends of an axis: with a little room beyond the numbers, but none beyond zero. */
static void add_range(Text *script, const char *axis, Extent e, double factor, double room)
{
  if (!(e.least <= e.most)) return;
  double wide = e.most - e.least;
  if (!(wide > 1e-9 * larger_end(e))) wide = larger_end(e) > 0 ? larger_end(e) : 1;
  const double low = e.least - room * wide, high = e.most + room * wide;
  text_add(script, "set %srange [%.9g:%.9g]\n", axis, factor * (e.least >= 0 && low < 0 ? 0 : low),
           factor * (e.most <= 0 && high > 0 && e.least < e.most ? 0 : high));
}

static bool has_positive(const PlotLine *lines, int count, bool vertical)
{
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < lines[k].count; ++i)
      if ((vertical ? lines[k].y[i] : lines[k].x[i]) > 0) return true;
  return false;
}

/** Words of an axis; those that were asked for stand as they are. */
static void add_label(Text *script, const char *axis, const PlotAxis *a, const DisplayUnit *unit)
{
  char heading[200];
  display_heading(a->words, unit->name, heading, sizeof heading);
  text_add(script, "set %slabel ", axis);
  quote(script, a->label ? a->label : heading);
  text_add(script, " noenhanced\n");
  if (a->logarithmic) text_add(script, "set logscale %s\n", axis);
}

/** The legend stands beside the lines, or under them where its words are long. */
static void add_key(Text *script, const PlotLine *lines, int count)
{
  size_t longest = 0;
  for (int k = 0; k < count; ++k) longest = strlen(lines[k].title) > longest ? strlen(lines[k].title) : longest;
  text_add(script, "%s\n",
           count < 2       ? "unset key"
           : longest <= 22 ? "set key outside right top Left reverse samplen 2.5"
                           : "set key outside below center Left reverse maxcols 2 samplen 2.5\nset rmargin 4");
}

/** Looks for what gnuplot would end with words of its own about. */
static int check_axes(const PlotLine *lines, int count, const PlotOptions *o, const char *path, Error *error)
{
  for (int v = 0; v < 2; ++v)
    if ((v ? o->y : o->x).logarithmic && !has_positive(lines, count, v))
      return error_add(error, BRECCIA_USER_ERROR, "%s: its %s axis cannot be logarithmic: no value is above 0", path,
                       v ? "vertical" : "horizontal");
  if (has_range(o) && o->x.logarithmic && o->low <= 0)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: the range from %g to %g does not fit a logarithmic axis; expected one above 0", path, o->low,
                     o->high);
  const Extent all = extent_of(lines, count, o, false, false), within = extent_of(lines, count, o, false, true);
  if (!(all.least <= all.most))
    return error_add(error, BRECCIA_USER_ERROR, "%s: not drawn: there is no point yet, or none that is a number%s",
                     path, o->x.logarithmic || o->y.logarithmic ? " above 0" : "");
  if (!(within.least <= within.most))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: not drawn: no point lies in the range from %g to %g; points lie from %g to %g", path, o->low,
                     o->high, all.least, all.most);
  const Extent ends[2] = {has_range(o) ? (Extent){o->low, o->high} : all, extent_of(lines, count, o, true, true)};
  for (int v = 0; v < 2; ++v)
    if (!(larger_end(ends[v]) < LARGEST))
      return error_add(error, BRECCIA_USER_ERROR,
                       "%s: not drawn: its %s axis would go from %g to %g; expected less than %g", path,
                       v ? "vertical" : "horizontal", ends[v].least, ends[v].most, LARGEST);
  if (has_range(o) && !(o->high - o->low > NARROWEST * larger_end(*ends)))
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: not drawn: the range from %.12g to %.12g is too narrow; expected more than %g of its ends",
                     path, o->low, o->high, NARROWEST);
  return BRECCIA_OK;
}

int plot_draw(const PlotLine *lines, int count, const PlotOptions *o, const char *path, Error *error)
{
  static const char *const colours[] = {"#3b3f87", "#c8501e", "#21918c", "#8a2f7d", "#7a7a1e", "#4f9bd9", "#555555"};
  enum { COLOURS = sizeof colours / sizeof *colours };
  if (check_axes(lines, count, o, path, error)) return BRECCIA_USER_ERROR;
  const char *dot = strrchr(path, '.');
  char *part = text_format("%s.part", path);
  Text script = {0};
  if (!part) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  const bool given = has_range(o);
  const Extent ex = given ? (Extent){o->low, o->high} : extent_of(lines, count, o, false, true);
  const Extent ey = extent_of(lines, count, o, true, true);
  const DisplayUnit ux = display_unit(o->x.unit, larger_end(ex)), uy = display_unit(o->y.unit, larger_end(ey));
  for (int k = 0; k < count; ++k) {
    text_add(&script, "$data%d << END\n", k);
    for (int i = 0; i < lines[k].count; ++i) {
      if (lines[k].apart && lines[k].apart[i]) text_add(&script, "\n");
      if (isfinite(lines[k].x[i]) && isfinite(lines[k].y[i]))
        text_add(&script, "%.9g %.9g\n", ux.factor * lines[k].x[i], uy.factor * lines[k].y[i]);
    }
    text_add(&script, "END\n");
  }
  const char *terminal = !dot || !strcmp(dot, ".png") ? "pngcairo size 800,520 font \"sans,12\""
                         : !strcmp(dot, ".svg")       ? "svg size 800,520 font \"sans,12\""
                                                      : "pdfcairo size 16.5cm,10.7cm font \"sans,11\"";
  text_add(&script, "set terminal %s\nset output ", terminal);
  quote(&script, part);
  text_add(&script, "\nset title ");
  quote(&script, o->title);
  text_add(&script, " noenhanced\n");
  add_label(&script, "x", &o->x, &ux);
  add_label(&script, "y", &o->y, &uy);
  text_add(&script, "set format \"%%.10g\"\nset grid lc rgb \"#dddddd\" lw 1 lt 1\nset border lc rgb \"#333333\"\n"
                    "set zeroaxis lc rgb \"#777777\" lw 1.2 lt 1\n");
  add_key(&script, lines, count);
  text_add(&script, "set datafile separator whitespace\n");
  if (!o->x.logarithmic || given) add_range(&script, "x", ex, ux.factor, given ? 0 : 0.02);
  if (!o->y.logarithmic) add_range(&script, "y", ey, uy.factor, 0.05);
  text_add(&script, "plot ");
  for (int k = 0; k < count; ++k) {
    text_add(&script, "%s$data%d using 1:2 with ", k ? ", " : "", k);
    if (lines[k].points)
      text_add(&script, "points pt 6 ps 1.3 lw 1.5 lc rgb \"#000000\" title ");
    else
      text_add(&script, "lines lw 2 dt %d lc rgb \"%s\" title ", 1 + lines[k].dash + lines[k].colour / COLOURS,
               colours[lines[k].colour % COLOURS]);
    quote(&script, lines[k].title);
    text_add(&script, " noenhanced");
  }
  text_add(&script, "\n");
  int status = script.failed ? error_add(error, BRECCIA_FAILURE, "out of memory: %s", path)
                             : run_gnuplot(&script, part, path, o->no_gnuplot, error);
  text_free(&script);
  free(part);
  return status;
}
