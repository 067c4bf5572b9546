#include "results/bar_columns.h"

#include <string.h>

static double strain(const Bars *b, int bar, int64_t e)
{
  (void)bar;
  return b->strain_held[e];
}
static double stress(const Bars *b, int bar, int64_t e)
{
  (void)bar;
  return b->stress_held[e];
}
static double force(const Bars *b, int bar, int64_t e)
{
  (void)bar;
  return b->area[e] * b->stress_held[e];
}
static double dissipated(const Bars *b, int bar, int64_t e)
{
  (void)bar;
  return bar_dissipated_in(b, e);
}

static const BarColumn columns[] = {
    [BAR_STRAIN] = {.name = "strain", .dimension = "1", .value = strain, .has_sign = true},
    [BAR_STRESS] = {.name = "stress", .dimension = "stress", .value = stress, .has_sign = true},
    {.name = "force", .dimension = "force", .value = force, .has_sign = true},
    {.name = "dissipated", .dimension = "energy", .value = dissipated},
    {.name = "slip", .dimension = "length", .value = bar_slip_in, .of_slip = true, .has_sign = true},
    {.name = "bond stress", .dimension = "stress", .value = bar_bond_stress_in, .of_slip = true, .has_sign = true},
};
enum { COUNT = sizeof columns / sizeof *columns };

const BarColumn *bar_column_at(int k)
{
  return k < COUNT ? &columns[k] : NULL;
}

const BarColumn *bar_column_find(const char *name)
{
  for (int k = 0; k < COUNT; ++k)
    if (!strcmp(columns[k].name, name)) return &columns[k];
  return NULL;
}

const char *bar_column_name(int k)
{
  return k < COUNT ? columns[k].name : NULL;
}

bool bar_column_is_there(const BarColumn *column, const Bars *b)
{
  return !column->of_slip || b->slips;
}
