#include "results/bar_states.h"

#include "base/memory.h"
#include "results/bar_columns.h"
#include "results/dataset.h"
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 1 << 15 }; /* of a chunk */

static int64_t nodes_of(const Bars *b)
{
  return b->count + b->specs->count;
}

static int write_names(hid_t group, const Bars *b)
{
  size_t length = 0, at = 0;
  for (int n = 0; n < b->specs->count; ++n) length += strlen(bar_name(b, n)) + 1;
  char *names = memory_plain(length + 1, 1);
  if (!names) return 1;
  for (int n = 0; n < b->specs->count; at += strlen(bar_name(b, n++)) + 1) strcpy(names + at, bar_name(b, n));
  const int bad = dataset_create(group, "Names", H5T_STD_U8LE, 1, 4096) ||
                  dataset_write(group, "Names", H5T_NATIVE_UINT8, 1, 0, (hsize_t)length, names);
  free(names);
  return bad;
}

static int write_places(hid_t group, const Bars *b)
{
  const hsize_t lines = (hsize_t)b->specs->count + 1, nodes = (hsize_t)nodes_of(b);
  int64_t *first = memory_plain((size_t)lines, sizeof(int64_t));
  if (!first) return 1;
  for (hsize_t n = 0; n < lines; ++n) first[n] = b->first[n] + (int64_t)n;
  first[lines - 1] = (int64_t)nodes;
  const int bad = dataset_create(group, "Points", H5T_IEEE_F64LE, 3, 4096) ||
                  dataset_write(group, "Points", H5T_NATIVE_DOUBLE, 3, 0, nodes, b->node) ||
                  dataset_create(group, "Lines", H5T_STD_I64LE, 1, 1024) ||
                  dataset_write(group, "Lines", H5T_NATIVE_INT64, 1, 0, lines, first);
  free(first);
  return bad;
}

int bar_states_create(hid_t breccia, const Domain *d, const Units *units, bool single)
{
  const Bars *b = bars_among(&d->forces);
  if (!b) return 0;
  const hid_t group = H5Gcreate2(breccia, "Bars", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
              type = single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  if (group < 0) return 1;
  char unit[64];
  int bad = write_names(group, b) || write_places(group, b);
  const hsize_t rows = b->count < MOST_ROWS ? (hsize_t)b->count : MOST_ROWS;
  const BarColumn *c;
  bad = bad || dataset_create(group, "displacement", type, 3, rows);
  units_name(units, dimension_find("length"), unit, sizeof unit);
  bad = bad || attribute_text(group, "displacement", "unit", unit);
  for (int k = 0; !bad && (c = bar_column_at(k)); ++k) {
    if (!bar_column_is_there(c, b)) continue;
    units_name(units, dimension_find(c->dimension), unit, sizeof unit);
    bad = dataset_create(group, c->name, type, 1, rows) || attribute_text(group, c->name, "unit", unit);
  }
  return (H5Gclose(group) < 0) | bad;
}

int bar_states_write(hid_t breccia, const Domain *d, int64_t state)
{
  const Bars *b = bars_among(&d->forces);
  if (!b || H5Lexists(breccia, "Bars", H5P_DEFAULT) <= 0) return 0;
  const int64_t nodes = nodes_of(b);
  const hid_t group = H5Gopen2(breccia, "Bars", H5P_DEFAULT);
  double *values = memory_plain(3 * (size_t)nodes, sizeof(double));
  int bad = group < 0 || !values;
  for (int64_t k = 0; !bad && k < nodes; ++k) bar_node_displacement(b, k, values + 3 * k);
  bad = bad ||
        dataset_write(group, "displacement", H5T_NATIVE_DOUBLE, 3, (hsize_t)(state * nodes), (hsize_t)nodes, values);
  const BarColumn *c;
  for (int k = 0; !bad && (c = bar_column_at(k)); ++k) {
    if (!bar_column_is_there(c, b)) continue;
    for (int n = 0; n < b->specs->count; ++n)
      for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) values[e] = c->value(b, n, e);
    bad = dataset_write(group, c->name, H5T_NATIVE_DOUBLE, 1, (hsize_t)(state * b->count), (hsize_t)b->count, values);
  }
  free(values);
  return (group >= 0 && H5Gclose(group) < 0) | bad;
}

int bar_states_cut(hid_t breccia, const Domain *d, int64_t states)
{
  const Bars *b = bars_among(&d->forces);
  if (!b || H5Lexists(breccia, "Bars", H5P_DEFAULT) <= 0) return 0;
  const hid_t group = H5Gopen2(breccia, "Bars", H5P_DEFAULT);
  const BarColumn *c;
  int bad =
      group < 0 || dataset_write(group, "displacement", H5T_NATIVE_DOUBLE, 3, (hsize_t)(states * nodes_of(b)), 0, NULL);
  for (int k = 0; !bad && (c = bar_column_at(k)); ++k)
    if (bar_column_is_there(c, b))
      bad = dataset_write(group, c->name, H5T_NATIVE_DOUBLE, 1, (hsize_t)(states * b->count), 0, NULL);
  return (group >= 0 && H5Gclose(group) < 0) | bad;
}

int64_t bar_states_numbers(const Domain *d)
{
  const Bars *b = bars_among(&d->forces);
  int columns = 0;
  for (int k = 0; b && bar_column_at(k); ++k) columns += bar_column_is_there(bar_column_at(k), b);
  return b ? 3 * nodes_of(b) + columns * b->count : 0;
}
