#include "results/curve.h"

#include "base/csv.h"
#include "base/memory.h"
#include "base/text.h"
#include "deck/document.h"
#include "results/curve_names.h"
#include "results/plot.h"
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AXIS_WORDS = 2 * CURVE_NAME + 8 };

static int read_curve(const char *words, CurveNames *names, Error *error)
{
  if (!curve_names(words, names)) return BRECCIA_OK;
  Text advice = {0};
  curve_advise(words, &advice);
  const int status = error_add(error, BRECCIA_USER_ERROR, "%s", text_words(&advice));
  text_free(&advice);
  return status;
}

void curve_name(const char *words, char *name, size_t size)
{
  CurveNames names;
  char whole[AXIS_WORDS + 4];
  if (curve_names(words, &names))
    snprintf(whole, sizeof whole, "curve");
  else if (!strcmp(names.watch[0], names.watch[1]))
    snprintf(whole, sizeof whole, "%s", names.watch[0]);
  else
    snprintf(whole, sizeof whole, "%s-over-%s", names.watch[1], names.watch[0]);
  text_file_name(whole, name, size);
}

/** A column of a history, with the steps of its rows and its unit. */
static double *history_column(const char *folder, const CurveNames *names, int k, double **steps, int *count,
                              char *unit, Error *error)
{
  char file[CURVE_NAME], label[128] = "", ignored[128];
  text_file_name(names->watch[k], file, sizeof file);
  char *path = text_format("%s/%s.csv", folder, file);
  double *values = NULL;
  *steps = csv_column(path, "step", CSV_LIVING, count, ignored, error);
  if (*steps) values = csv_column(path, names->column[k], CSV_LIVING, count, label, error);
  free(path);
  for (int i = 0; values && names->minus[k] && i < *count; ++i) values[i] = -values[i];
  const char *open = strrchr(label, '(');
  if (open && open > label && label[strlen(label) - 1] == ')')
    snprintf(unit, 64, "%.*s", (int)strcspn(open + 1, ")"), open + 1);
  else
    *unit = 0;
  return values;
}

typedef struct Columns { /* of one line: on rows of the same step */
  double *x, *y;
  bool *apart; /* as in PlotLine */
  int count;
  char x_unit[64], y_unit[64];
} Columns;

static const char *words_of(const Node *map, const char *key)
{
  const Node *node = map && map->kind == NODE_MAP ? node_get(map, key) : NULL;
  return node && node->kind == NODE_SCALAR ? node->text : "";
}

/** Lengths between places do not count from where these were. */
static bool counts_from_places(const char *column)
{
  return strcmp(column, "distance") != 0 && !strstr(column, "slip");
}

/** Finds where lengths jump, because displacements count from zero again in a stage, as the summary of the run tells it.
 *  @param[in] step  of the points of a line, which is the k-th column over the first */
static void find_jumps(const char *folder, const CurveNames *names, int k, const double *step, Columns *line)
{
  char *path = text_format("%s/summary.json", folder), *text = path ? text_read_file(path, NULL) : NULL;
  Document *document = text ? document_parse(text, strlen(text), path, NULL) : NULL;
  const Node *root = document ? document->root : NULL,
             *stages = root && root->kind == NODE_MAP ? node_get(root, "stages") : NULL;
  const char *length = stages ? words_of(node_get(root, "units"), "positions and displacements") : "";
  const bool moves = *length && ((!strcmp(line->x_unit, length) && counts_from_places(names->column[0])) ||
                                 (!strcmp(line->y_unit, length) && counts_from_places(names->column[k])));
  for (int s = 0; moves && stages->kind == NODE_LIST && s < stages->count; ++s) {
    const Node *steps = stages->items[s].kind == NODE_MAP ? node_get(&stages->items[s], "steps") : NULL;
    if (strcmp(words_of(&stages->items[s], "displacements_from_zero"), "true") != 0) continue;
    if (!steps || steps->kind != NODE_LIST || !steps->count || steps->items[0].kind != NODE_SCALAR) continue;
    const double end = strtod(steps->items[0].text, NULL); /* of the stage before, which has the row */
    for (int i = 1; i < line->count; ++i) line->apart[i] |= step[i - 1] <= end && step[i] > end;
  }
  document_destroy(&document);
  free(text);
  free(path);
}

/** The k-th column of a curve over its first. */
static int read_line(const char *folder, const CurveNames *names, int k, Columns *line, Error *error)
{
  int nx = 0, ny = 0;
  double *sx = NULL, *sy = NULL;
  line->x = history_column(folder, names, 0, &sx, &nx, line->x_unit, error);
  line->y = line->x ? history_column(folder, names, k, &sy, &ny, line->y_unit, error) : NULL;
  for (int i = 0, j = 0; line->y && i < nx && j < ny;) {
    if (sx[i] < sy[j])
      ++i;
    else if (sx[i] > sy[j])
      ++j;
    else { /* never further than what was read of either */
      sx[line->count] = sx[i];
      line->x[line->count] = line->x[i++];
      line->y[line->count++] = line->y[j++];
    }
  }
  int status = line->y ? BRECCIA_OK : BRECCIA_USER_ERROR;
  if (!status && !(line->apart = memory_zeroed((size_t)line->count, sizeof(bool), "curves", error)))
    status = BRECCIA_FAILURE;
  if (!status) find_jumps(folder, names, k, sx, line);
  free(sx);
  free(sy);
  return status;
}

/** The last part of a path. */
static void last_part(const char *path, char *name)
{
  size_t n = strlen(path);
  while (n > 1 && path[n - 1] == '/') --n;
  size_t from = n;
  while (from && path[from - 1] != '/') --from;
  const size_t length = n - from < CURVE_NAME ? n - from : CURVE_NAME - 1;
  memcpy(name, path + from, length);
  name[length] = 0;
}

/** @return whether a row begins with two numbers and a comma between; @param[out] first  whether it begins with a number at all */
static bool read_point(const char *row, double *x, double *y, bool *first)
{
  char *end, *last;
  *x = strtod(row, &end);
  *first = end != row;
  end += strspn(end, " \t");
  if (!*first || *end != ',') return false;
  *y = strtod(end + 1, &last);
  const bool two = last != end + 1;
  last += strspn(last, " \t\r");
  return two && (*last == ',' || !*last);
}

int curve_points(const char *path, double **x, double **y, int *count, Error *error)
{
  char *text = text_read_file(path, NULL);
  *x = *y = NULL;
  *count = 0;
  if (!text) return error_add(error, BRECCIA_USER_ERROR, "%s: %s", path, text_why_unread(errno));
  size_t rows = 1;
  for (const char *c = text; *c; ++c) rows += *c == '\n';
  *x = memory_plain(rows, sizeof(double));
  *y = memory_plain(rows, sizeof(double));
  int status = *x && *y ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: %s", path), line = 0;
  for (char *row = text, *next; row && !status; row = next) {
    next = strchr(row, '\n');
    if (next) *next++ = 0;
    ++line;
    row += strspn(row, " \t\r");
    bool number = false;
    if (!*row || *row == '#') continue;
    if (read_point(row, &(*x)[*count], &(*y)[*count], &number))
      ++*count;
    else if (number || *count) /* before the first point there may be a heading */
      status = error_add(error, BRECCIA_USER_ERROR,
                         "%s:%d: expected x and y with a comma between, and points in the numbers; found '%.60s'", path,
                         line, row);
  }
  free(text);
  if (status || *count) return status;
  return error_add(error, BRECCIA_USER_ERROR, "%s: no row begins with two numbers, x and y with a comma between", path);
}

static void name_column(const CurveNames *names, int k, char *words)
{
  const char *watch = names->watch[k], *column = names->column[k], *sign = names->minus[k] ? "-" : "";
  if (!strcmp(column, "time") || !strcmp(column, "step") || !strcmp(column, watch))
    snprintf(words, AXIS_WORDS, "%s%s", sign, column);
  else if (!strcmp(column, "value")) /* of a load */
    snprintf(words, AXIS_WORDS, "%s%s", sign, watch);
  else
    snprintf(words, AXIS_WORDS, "%s%s, %s", sign, watch, column);
}

static bool of_one_watch(const CurveNames *names)
{
  for (int k = 2; k < names->count; ++k)
    if (strcmp(names->watch[k], names->watch[1])) return false;
  return true;
}

/** Titles of the lines: the folder, the column, or both, whatever tells them apart. */
static char *title_of(const CurveNames *names, int column, const char *const *folders, int folder_count, int folder)
{
  char here[CURVE_NAME], words[AXIS_WORDS];
  last_part(folders[folder], here);
  for (int k = 0; k < folder_count; ++k) { /* two folders of one name: their paths */
    char there[CURVE_NAME];
    last_part(folders[k], there);
    if (k != folder && !strcmp(here, there)) snprintf(here, sizeof here, "%s", folders[folder]);
  }
  if (of_one_watch(names))
    snprintf(words, sizeof words, "%s%s", names->minus[column] ? "-" : "", names->column[column]);
  else
    name_column(names, column, words);
  if (names->count == 2) return text_format("%s", here);
  if (folder_count == 1) return text_format("%s", words);
  return text_format("%s: %s", here, words);
}

int curve_draw(const char *const *folders, int folder_count, const char *words, const CurveOptions *o, const char *path,
               Error *error)
{
  CurveNames names;
  int status = read_curve(words, &names, error), count = 0;
  if (status) return status;
  const int columns_each = names.count - 1, most = folder_count * columns_each + 1;
  PlotLine *lines = memory_plain((size_t)most, sizeof *lines);
  Columns *columns = memory_plain((size_t)most, sizeof *columns);
  char **titles = memory_plain((size_t)most, sizeof *titles);
  if (!lines || !columns || !titles) status = error_add(error, BRECCIA_FAILURE, "out of memory: curves");
  for (int k = 0; k < folder_count && !status; ++k)
    for (int c = 1; c < names.count && !status; ++c, ++count) {
      Columns *line = &columns[count];
      status = read_line(folders[k], &names, c, line, error);
      titles[count] = title_of(&names, c, folders, folder_count, k);
      lines[count] = (PlotLine){titles[count] ? titles[count] : "",
                                line->x,
                                line->y,
                                line->count,
                                false,
                                columns_each > 1 ? c - 1 : k,
                                columns_each > 1 ? k : 0, /* dashes tell folders apart */
                                line->apart};
      const bool other_x = strcmp(line->x_unit, columns->x_unit) != 0;
      if (!status && (other_x || strcmp(line->y_unit, columns->y_unit)))
        status = error_add(error, BRECCIA_USER_ERROR,
                           "%s: %s.%s has the unit '%s' and %s.%s the unit '%s': they cannot "
                           "share an axis",
                           folders[k], names.watch[other_x ? 0 : c], names.column[other_x ? 0 : c],
                           other_x ? line->x_unit : line->y_unit, names.watch[other_x ? 0 : 1],
                           names.column[other_x ? 0 : 1], other_x ? columns->x_unit : columns->y_unit);
    }
  if (o->overlay && !status) {
    char name[CURVE_NAME];
    Columns *line = &columns[count];
    last_part(o->overlay, name);
    char *ending = strrchr(name, '.');
    if (ending && ending > name) *ending = 0;
    status = curve_points(o->overlay, &line->x, &line->y, &line->count, error);
    titles[count] = text_format("%s", name);
    lines[count] = (PlotLine){titles[count] ? titles[count] : "", line->x, line->y, line->count, true, 0, 0, NULL};
    ++count;
  }
  if (!status) {
    char x_words[AXIS_WORDS], y_words[AXIS_WORDS];
    name_column(&names, 0, x_words);
    if (columns_each == 1)
      name_column(&names, 1, y_words);
    else
      snprintf(y_words, sizeof y_words, "%s", of_one_watch(&names) ? names.watch[1] : "");
    const PlotOptions plot = {.title = o->title,
                              .x = {x_words, columns->x_unit, o->x_label, plot_is_logarithmic(o->log_axes, 'x')},
                              .y = {y_words, columns->y_unit, o->y_label, plot_is_logarithmic(o->log_axes, 'y')},
                              .low = o->low,
                              .high = o->high,
                              .no_gnuplot = o->no_gnuplot};
    status = plot_draw(lines, count, &plot, path, error);
  }
  for (int k = 0; columns && titles && k < most; ++k) {
    free(columns[k].x);
    free(columns[k].y);
    free(columns[k].apart);
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
