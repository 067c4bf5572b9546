#include "results/curve.h"

#include "base/csv.h"
#include "base/text.h"
#include "results/plot.h"
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 16, WORDS = 160, AXIS_WORDS = 2 * WORDS + 4 };

typedef struct Name { /* of a column in a history */
  char watch[WORDS], column[WORDS];
} Name;

typedef struct Curve { /* what the words "watch.column : watch.column, watch.column" ask for */
  Name x, y[MOST_COLUMNS];
  int count;
} Curve;

/** Copies words without the blanks around them. */
static void copy_trimmed(const char *words, size_t length, char *copy)
{
  while (length && *words == ' ') ++words, --length;
  while (length && words[length - 1] == ' ') --length;
  snprintf(copy, WORDS, "%.*s", (int)length, words);
}

/** Splits "watch.column" at its last dot. */
static int read_name(const char *words, size_t length, Name *name, Error *error)
{
  char whole[WORDS];
  copy_trimmed(words, length, whole);
  const char *dot = strrchr(whole, '.');
  if (!dot || dot == whole)
    return error_add(error, BRECCIA_USER_ERROR, "curve: '%s' should be watch.column, like opening.distance", whole);
  copy_trimmed(whole, (size_t)(dot - whole), name->watch);
  copy_trimmed(dot + 1, strlen(dot + 1), name->column);
  return BRECCIA_OK;
}

static int read_curve(const char *words, Curve *curve, Error *error)
{
  const char *colon = strchr(words, ':');
  *curve = (Curve){.count = 0};
  if (!colon) return error_add(error, BRECCIA_USER_ERROR, "curve: '%s' should be 'watch.column : watch.column'", words);
  int status = read_name(words, (size_t)(colon - words), &curve->x, error);
  for (const char *rest = colon + 1; rest && !status;) {
    if (curve->count == MOST_COLUMNS)
      return error_add(error, BRECCIA_USER_ERROR, "curve: more than %d columns", MOST_COLUMNS);
    const char *comma = strchr(rest, ',');
    status = read_name(rest, comma ? (size_t)(comma - rest) : strlen(rest), &curve->y[curve->count++], error);
    rest = comma ? comma + 1 : NULL;
  }
  return status;
}

void curve_name(const char *words, char *name, size_t size)
{
  Curve curve;
  Error *ignored = breccia_error_create();
  char whole[2 * WORDS + 8];
  if (read_curve(words, &curve, ignored))
    snprintf(whole, sizeof whole, "curve");
  else if (!strcmp(curve.x.watch, curve.y[0].watch))
    snprintf(whole, sizeof whole, "%s", curve.x.watch);
  else
    snprintf(whole, sizeof whole, "%s-over-%s", curve.y[0].watch, curve.x.watch);
  breccia_error_destroy(&ignored);
  text_file_name(whole, name, size);
}

/** A column of a history, with the steps of its rows and its unit. */
static double *history_column(const char *folder, const Name *name, double **steps, int *count, char *unit,
                              Error *error)
{
  char watch[WORDS], label[128] = "", ignored[128];
  text_file_name(name->watch, watch, sizeof watch);
  char *path = text_format("%s/%s.csv", folder, watch);
  double *values = NULL;
  *steps = csv_column(path, "step", CSV_LIVING, count, ignored, error);
  if (*steps) values = csv_column(path, name->column, CSV_LIVING, count, label, error);
  free(path);
  const char *open = strrchr(label, '(');
  if (open && open > label && label[strlen(label) - 1] == ')')
    snprintf(unit, 64, "%.*s", (int)strcspn(open + 1, ")"), open + 1);
  else
    *unit = 0;
  return values;
}

typedef struct Columns { /* of one line: on rows of the same step */
  double *x, *y;
  int count;
  char x_unit[64], y_unit[64];
} Columns;

static int read_line(const char *folder, const Name *x, const Name *y, Columns *line, Error *error)
{
  int nx = 0, ny = 0;
  double *sx = NULL, *sy = NULL;
  line->x = history_column(folder, x, &sx, &nx, line->x_unit, error);
  line->y = line->x ? history_column(folder, y, &sy, &ny, line->y_unit, error) : NULL;
  for (int i = 0, j = 0; line->y && i < nx && j < ny;) {
    if (sx[i] < sy[j])
      ++i;
    else if (sx[i] > sy[j])
      ++j;
    else { /* never further than what was read of either */
      line->x[line->count] = line->x[i++];
      line->y[line->count++] = line->y[j++];
    }
  }
  free(sx);
  free(sy);
  return line->y ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

/** The last part of a path. */
static void last_part(const char *path, char *name)
{
  size_t n = strlen(path);
  while (n > 1 && path[n - 1] == '/') --n;
  size_t from = n;
  while (from && path[from - 1] != '/') --from;
  const size_t length = n - from < WORDS ? n - from : WORDS - 1;
  memcpy(name, path + from, length);
  name[length] = 0;
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

static void name_column(const Name *name, char *words)
{
  if (!strcmp(name->column, "time") || !strcmp(name->column, "step") || !strcmp(name->column, name->watch))
    snprintf(words, AXIS_WORDS, "%s", name->column);
  else if (!strcmp(name->column, "value")) /* of a load */
    snprintf(words, AXIS_WORDS, "%s", name->watch);
  else
    snprintf(words, AXIS_WORDS, "%s, %s", name->watch, name->column);
}

/** What the vertical axis shows: its column, or the watch that all its columns are of. */
static void name_vertical(const Curve *curve, char *words)
{
  if (curve->count == 1)
    name_column(&curve->y[0], words);
  else {
    snprintf(words, AXIS_WORDS, "%s", curve->y[0].watch);
    for (int c = 1; c < curve->count; ++c)
      if (strcmp(curve->y[c].watch, curve->y[0].watch)) *words = 0;
  }
}

/** Titles of the lines: the folder, the column, or both, whatever tells them apart. */
static char *title_of(const Curve *curve, int column, const char *const *folders, int folder_count, int folder)
{
  char here[WORDS], column_words[AXIS_WORDS];
  last_part(folders[folder], here);
  for (int k = 0; k < folder_count; ++k) { /* two folders of one name: their paths */
    char there[WORDS];
    last_part(folders[k], there);
    if (k != folder && !strcmp(here, there)) snprintf(here, sizeof here, "%s", folders[folder]);
  }
  const bool one_watch = !strcmp(curve->y[0].watch, curve->y[curve->count - 1].watch);
  if (one_watch)
    snprintf(column_words, sizeof column_words, "%s", curve->y[column].column);
  else
    name_column(&curve->y[column], column_words);
  if (curve->count == 1) return text_format("%s", here);
  if (folder_count == 1) return text_format("%s", column_words);
  return text_format("%s: %s", here, column_words);
}

int curve_draw(const char *const *folders, int folder_count, const char *words, const CurveOptions *o, const char *path,
               Error *error)
{
  Curve curve;
  int status = read_curve(words, &curve, error), count = 0;
  if (status) return status;
  const int most = folder_count * curve.count + 1;
  PlotLine *lines = calloc((size_t)most, sizeof *lines);
  Columns *columns = calloc((size_t)most, sizeof *columns);
  char **titles = calloc((size_t)most, sizeof *titles);
  if (!lines || !columns || !titles) status = error_add(error, BRECCIA_FAILURE, "out of memory: curves");
  for (int k = 0; k < folder_count && !status; ++k)
    for (int c = 0; c < curve.count && !status; ++c, ++count) {
      Columns *line = &columns[count];
      status = read_line(folders[k], &curve.x, &curve.y[c], line, error);
      titles[count] = title_of(&curve, c, folders, folder_count, k);
      lines[count] = (PlotLine){titles[count] ? titles[count] : "",
                                line->x,
                                line->y,
                                line->count,
                                false,
                                curve.count > 1 ? c : k,
                                curve.count > 1 ? k : 0}; /* dashes tell folders apart */
      if (!status && (strcmp(line->x_unit, columns->x_unit) || strcmp(line->y_unit, columns->y_unit)))
        status = error_add(
            error, BRECCIA_USER_ERROR, "%s: %s.%s is in %s and %s.%s in %s: they cannot share an axis", folders[k],
            curve.x.watch, strcmp(line->x_unit, columns->x_unit) ? curve.x.column : curve.y[c].column,
            strcmp(line->x_unit, columns->x_unit) ? line->x_unit : line->y_unit, curve.y[0].watch, curve.y[0].column,
            strcmp(line->x_unit, columns->x_unit) ? columns->x_unit : columns->y_unit);
    }
  if (o->overlay && !status) {
    char name[WORDS];
    Columns *line = &columns[count];
    last_part(o->overlay, name);
    status = curve_points(o->overlay, &line->x, &line->y, &line->count, error);
    titles[count] = text_format("%s", name);
    lines[count] = (PlotLine){titles[count] ? titles[count] : "", line->x, line->y, line->count, true, 0, 0};
    ++count;
  }
  if (!status) {
    char x_words[AXIS_WORDS], y_words[AXIS_WORDS];
    name_column(&curve.x, x_words);
    name_vertical(&curve, y_words);
    const char *logarithmic = o->log_axes && strcmp(o->log_axes, "none") ? o->log_axes : "";
    const PlotOptions plot = {.title = o->title,
                              .x = {x_words, columns->x_unit, o->x_label, strchr(logarithmic, 'x') != NULL},
                              .y = {y_words, columns->y_unit, o->y_label, strchr(logarithmic, 'y') != NULL},
                              .low = o->low,
                              .high = o->high};
    status = plot_draw(lines, count, &plot, path, error);
  }
  for (int k = 0; columns && titles && k < most; ++k) {
    free(columns[k].x);
    free(columns[k].y);
    free(titles[k]);
  }
  free(titles);
  free(columns);
  free(lines);
  return status;
}

/* ---- energies ---- */

/** The heading of a history of energies, to be freed; NULL if the file is something else. */
static char *energy_heading(const char *path)
{
  char *text = text_read_file(path, NULL), *end = text ? strchr(text, '\n') : NULL;
  if (end) *end = 0;
  if (end && !strncmp(text, "step,time", 9) && strstr(text, ",kinetic (") && strstr(text, ",external (")) return text;
  free(text);
  return NULL;
}

static bool all_zero(const char *path, const char *column)
{
  int count = 0;
  char label[128];
  Error *ignored = breccia_error_create();
  double *values = csv_column(path, column, CSV_LIVING, &count, label, ignored);
  bool zero = values != NULL;
  for (int i = 0; zero && i < count; ++i) zero = values[i] == 0;
  free(values);
  breccia_error_destroy(&ignored);
  return zero;
}

char *curve_of_energies(const char *folder, Error *error)
{
  DIR *entries = opendir(folder);
  char found[256] = "", *heading = NULL, *path = NULL;
  if (!entries) {
    error_add(error, BRECCIA_USER_ERROR, "%s: %s", folder, strerror(errno));
    return NULL;
  }
  for (struct dirent *entry; (entry = readdir(entries));) {
    const char *dot = strrchr(entry->d_name, '.');
    if (!dot || strcmp(dot, ".csv") || (*found && strcmp(entry->d_name, found) > 0)) continue;
    char *candidate = text_format("%s/%s", folder, entry->d_name),
         *words = candidate ? energy_heading(candidate) : NULL;
    if (words) { /* of several the first by name */
      free(heading);
      free(path);
      heading = words;
      path = candidate;
      snprintf(found, sizeof found, "%s", entry->d_name);
    } else
      free(candidate);
  }
  closedir(entries);
  if (!heading) {
    error_add(error, BRECCIA_USER_ERROR,
              "%s: holds no history of energies; give the deck one: watch: {energy: {energy: yes}}", folder);
    return NULL;
  }
  *strrchr(found, '.') = 0;
  char *unit = text_format("%s", strchr(strstr(heading, ",kinetic ("), '('));
  if (unit) unit[strcspn(unit, ",")] = 0;
  Text curve = {0};
  text_add(&curve, "%s.time : ", found);
  int count = 0;
  char *rest = NULL;
  for (char *cell = strtok_r(heading, ",", &rest); cell && unit; cell = strtok_r(NULL, ",", &rest)) {
    char *open = strstr(cell, " (");
    if (!open || strcmp(open + 1, unit)) continue;
    *open = 0;
    if (!all_zero(path, cell)) text_add(&curve, "%s%s.%s", count++ ? ", " : "", found, cell);
  }
  if (!count) text_add(&curve, "%s.kinetic", found);
  free(unit);
  free(heading);
  free(path);
  return curve.characters;
}
