#include "results/bar_lines.h"

#include "bars/bars.h"
#include "base/folder.h"
#include "base/memory.h"
#include "base/whole_file.h"
#include "results/plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add_heading(const Units *units, bool slips, Text *t)
{
  static const char *const columns[][2] = {{"along", "length"},    {"x", "length"},          {"y", "length"},
                                           {"z", "length"},        {"strain", "1"},          {"stress", "stress"},
                                           {"force", "force"},     {"dissipated", "energy"}, {"yielded since", "time"},
                                           {"torn since", "time"}, {"slip", "length"},       {"bond stress", "stress"}};
  const size_t count = sizeof columns / sizeof *columns;
  text_add(t, "bar");
  for (size_t c = 0; c < (slips ? count : count - 2); ++c) {
    char unit[64];
    units_name(units, dimension_find(columns[c][1]), unit, sizeof unit);
    text_add(t, *unit ? ",%s (%s)" : ",%s", columns[c][0], unit);
  }
  text_add(t, "\n");
}

static void add_quoted(Text *t, const char *name)
{
  text_add(t, "\"");
  for (; *name; ++name) text_add(t, *name == '"' ? "\"\"" : "%c", *name);
  text_add(t, "\"");
}

/** Of what has not happened the column is empty. */
static void add_time(Text *t, double when)
{
  if (when < 0)
    text_add(t, ",");
  else
    text_add(t, ",%.10g", when);
}

static void add_table(const Bars *b, const Units *units, Text *t)
{
  add_heading(units, b->slips != NULL, t);
  for (int n = 0; n < b->specs->count; ++n) {
    double along = 0;
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      double x[3];
      bar_middle(b, e, x);
      add_quoted(t, bar_name(b, n));
      text_add(t, ",%.10g,%.10g,%.10g,%.10g,%.17g,%.17g,%.17g,%.10g", along + b->length[e] / 2, x[0], x[1], x[2],
               b->strain_held[e], b->stress_held[e], b->area[e] * b->stress_held[e], bar_dissipated_in(b, e));
      add_time(t, b->yielded[e]);
      add_time(t, b->torn[e]);
      if (b->slips) text_add(t, ",%.17g,%.17g", bar_slip_in(b, n, e), bar_bond_stress_in(b, n, e));
      text_add(t, "\n");
      along += b->length[e];
    }
  }
}

/* ---- lines for ParaView: the reference shape, with displacements beside it as in the results of particles ---- */

static void open_array(Text *t, const char *name, int components, const char *type)
{
  text_add(t, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"ascii\">\n", type, name,
           components);
}

static void add_of_elements(Text *t, const Bars *b, const char *name, const double *values, const double *factors)
{
  open_array(t, name, 1, "Float64");
  for (int64_t e = 0; e < b->count; ++e) text_add(t, "%.17g\n", values[e] * (factors ? factors[e] : 1));
  text_add(t, "</DataArray>\n");
}

static void add_of_nodes(Text *t, const Bars *b, const char *name, const double *values)
{
  open_array(t, name, 1, "Float64");
  for (int64_t k = 0; k < b->count + b->specs->count; ++k) text_add(t, "%.17g\n", values[k]);
  text_add(t, "</DataArray>\n");
}

static void add_lines(const Bars *b, Text *t)
{
  const int64_t nodes = b->count + b->specs->count;
  text_add(t,
           "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
           "<PolyData>\n<Piece NumberOfPoints=\"%lld\" NumberOfLines=\"%lld\">\n<Points>\n",
           (long long)nodes, (long long)b->count);
  open_array(t, "Points", 3, "Float64");
  for (int64_t k = 0; k < nodes; ++k) text_add(t, "%.10g %.10g %.10g\n", b->node[k][0], b->node[k][1], b->node[k][2]);
  text_add(t, "</DataArray>\n</Points>\n<PointData>\n");
  open_array(t, "displacement", 3, "Float64");
  for (int64_t k = 0; k < nodes; ++k) {
    double u[3];
    bar_node_displacement(b, k, u);
    text_add(t, "%.17g %.17g %.17g\n", u[0], u[1], u[2]);
  }
  text_add(t, "</DataArray>\n");
  if (b->slips) add_of_nodes(t, b, "slip", b->slips->slip_held);
  if (b->slips) add_of_nodes(t, b, "bond stress", b->slips->stress_held);
  text_add(t, "</PointData>\n<Lines>\n");
  open_array(t, "connectivity", 1, "Int64");
  for (int n = 0; n < b->specs->count; ++n)
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e)
      text_add(t, "%lld %lld\n", (long long)(e + n), (long long)(e + n + 1));
  text_add(t, "</DataArray>\n");
  open_array(t, "offsets", 1, "Int64");
  for (int64_t e = 0; e < b->count; ++e) text_add(t, "%lld\n", (long long)(2 * e + 2));
  text_add(t, "</DataArray>\n</Lines>\n<CellData>\n");
  open_array(t, "bar", 1, "Int64");
  for (int n = 0; n < b->specs->count; ++n)
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) text_add(t, "%d\n", n + 1);
  text_add(t, "</DataArray>\n");
  add_of_elements(t, b, "strain", b->strain_held, NULL);
  add_of_elements(t, b, "stress", b->stress_held, NULL);
  add_of_elements(t, b, "force", b->stress_held, b->area);
  add_of_elements(t, b, "yielded since", b->yielded, NULL);
  add_of_elements(t, b, "torn since", b->torn, NULL);
  text_add(t, "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n");
}

static int write_one(const char *folder, const char *name, Text *words, Text *files, Error *error)
{
  char *path = text_format("%s/%s", folder, name);
  const int status = path ? whole_file_write(path, words, error)
                          : error_add(error, BRECCIA_FAILURE, "%s: cannot be written: out of memory", name);
  if (!status) text_add(files, "  %s\n", path);
  free(path);
  text_free(words);
  return status;
}

int bar_lines_write(const Domain *domain, const char *folder, const Units *units, Text *files, Error *error)
{
  const Bars *b = bars_among(&domain->forces);
  if (!b) return BRECCIA_OK;
  char *inside = text_format("%s/bars", folder);
  if (!inside) return error_add(error, BRECCIA_FAILURE, "out of memory: bars");
  int status = folder_make(inside, error);
  Text words = {0};
  if (!status) {
    add_table(b, units, &words);
    status = write_one(inside, "bars.csv", &words, files, error);
  }
  if (!status) {
    add_lines(b, &words);
    status = write_one(inside, "bars.vtp", &words, files, error);
  }
  free(inside);
  return status;
}

/* ---- a picture ---- */

static double most_in(const Bars *b, int bar)
{
  double most = 0;
  for (int64_t e = b->first[bar]; e < b->first[bar + 1]; ++e) most = fmax(most, fabs(b->stress_held[e]));
  return most;
}

int bar_lines_draw(const Domain *domain, const char *folder, const Units *units, Text *files, bool *no_gnuplot,
                   Error *error)
{
  enum { MOST = 6 };
  const Bars *b = bars_among(&domain->forces);
  if (!b) return BRECCIA_OK;
  const int bars = b->specs->count;
  char stress[64], length[64], *path = text_format("%s/bar-stress.png", folder);
  double *along = memory_zeroed((size_t)b->count, sizeof *along, "bars", error);
  bool *taken = memory_zeroed((size_t)bars, sizeof *taken, "bars", error);
  int count = 0, status = path && along && taken ? BRECCIA_OK : BRECCIA_FAILURE;
  PlotLine lines[MOST];
  for (; !status && count < bars && count < MOST; ++count) {
    int next = -1;
    for (int n = 0; n < bars; ++n)
      if (!taken[n] && (next < 0 || most_in(b, n) > most_in(b, next))) next = n;
    taken[next] = true;
    const int64_t from = b->first[next];
    double before = 0;
    for (int64_t e = from; e < b->first[next + 1]; before += b->length[e++]) along[e] = before + b->length[e] / 2;
    lines[count] = (PlotLine){.title = bar_name(b, next),
                              .x = along + from,
                              .y = b->stress_held + from,
                              .count = (int)(b->first[next + 1] - from),
                              .colour = count};
  }
  units_name(units, dimension_find("stress"), stress, sizeof stress);
  units_name(units, dimension_find("length"), length, sizeof length);
  char title[96] = "Stress along bars";
  if (count == 1) snprintf(title, sizeof title, "Stress along bar '%.60s'", lines[0].title);
  if (count < bars) snprintf(title, sizeof title, "Stress along bars: %d of %d, those with the largest", count, bars);
  const PlotOptions options = {.title = title,
                               .x = {.words = "along the bar", .unit = length},
                               .y = {.words = "stress", .unit = stress},
                               .low = NAN,
                               .high = NAN,
                               .no_gnuplot = no_gnuplot};
  if (!status) status = plot_draw(lines, count, &options, path, error);
  if (!status) text_add(files, "  %s\n", path);
  free(path);
  free(along);
  free(taken);
  return status;
}
