#include "results/bar_lines.h"

#include "base/folder.h"
#include "base/whole_file.h"
#include "results/bar_columns.h"
#include <stdlib.h>

static void add_head(const Units *units, const char *name, const char *dimension, Text *t)
{
  char unit[64];
  units_name(units, dimension_find(dimension), unit, sizeof unit);
  text_add(t, *unit ? ",%s (%s)" : ",%s", name, unit);
}

static void add_heading(const Bars *b, const Units *units, Text *t)
{
  static const char *const places[] = {"along", "x", "y", "z"}, *const events[] = {"yielded since", "torn since"};
  const BarColumn *c;
  text_add(t, "bar");
  for (int k = 0; k < 4; ++k) add_head(units, places[k], "length", t);
  for (int slip = 0; slip < 2; ++slip) {
    for (int k = 0; (c = bar_column_at(k)); ++k)
      if (c->of_slip == slip && bar_column_is_there(c, b)) add_head(units, c->name, c->dimension, t);
    for (int k = 0; k < 2 && !slip; ++k) add_head(units, events[k], "time", t);
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

static void add_row(const Bars *b, int n, int64_t e, Text *t)
{
  const BarColumn *c;
  for (int slip = 0; slip < 2; ++slip) {
    for (int k = 0; (c = bar_column_at(k)); ++k)
      if (c->of_slip == slip && bar_column_is_there(c, b)) text_add(t, ",%.17g", c->value(b, n, e));
    if (slip) continue;
    add_time(t, b->yielded[e]);
    add_time(t, b->torn[e]);
  }
  text_add(t, "\n");
}

static void add_table(const Bars *b, const Units *units, Text *t)
{
  add_heading(b, units, t);
  for (int n = 0; n < b->specs->count; ++n) {
    double along = 0;
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      double x[3];
      bar_middle(b, e, x);
      add_quoted(t, bar_name(b, n));
      text_add(t, ",%.10g,%.10g,%.10g,%.10g", along + b->length[e] / 2, x[0], x[1], x[2]);
      add_row(b, n, e, t);
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
  int status = folder_make_inside(inside, error);
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
