#include "results/display_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Products that have names of their own. */
static const struct {
  const char *unit, *name;
  double factor;
} named[] = {
    {"N/mm2", "MPa", 1}, {"kN/mm2", "GPa", 1}, {"MN/m2", "MPa", 1}, {"kN/m2", "kPa", 1}, {"N/m2", "Pa", 1},
    {"N*m", "J", 1},     {"kN*m", "kJ", 1},    {"MN*m", "MJ", 1},   {"N*mm", "J", 1e-3}, {"kN*mm", "J", 1},
};

static const struct {
  const char *name;
  int power;
} prefixes[] = {{"n", -9}, {"u", -6}, {"µ", -6}, {"m", -3}, {"c", -2}, {"", 0}, {"k", 3}, {"M", 6}, {"G", 9}};

/* Which prefixes a unit may get, smallest first: nobody writes kiloseconds or megametres. */
static const struct {
  const char *name;
  int powers[6];
  int count;
} bases[] = {{"m", {-9, -6, -3, 0}, 4},
             {"s", {-9, -6, -3, 0}, 4},
             {"Pa", {0, 3, 6, 9}, 4},
             {"N", {-3, 0, 3, 6}, 4},
             {"J", {-6, -3, 0, 3, 6, 9}, 6}};
enum { NAMED = sizeof named / sizeof *named, PREFIXES = sizeof prefixes / sizeof *prefixes };
enum { BASES = sizeof bases / sizeof *bases };

/** Splits "kPa" into the base "Pa" and the power 3. @return the base's index, or -1 */
static int read_head(const char *head, int *power)
{
  for (int b = 0; b < BASES; ++b)
    for (int p = 0; p < PREFIXES; ++p) {
      char word[16];
      snprintf(word, sizeof word, "%s%s", prefixes[p].name, bases[b].name);
      *power = prefixes[p].power;
      if (!strcmp(word, head)) return b;
    }
  return -1;
}

static const char *prefix_name(int power)
{
  const char *name = "";
  for (int p = 0; p < PREFIXES; ++p)
    if (prefixes[p].power == power) name = prefixes[p].name;
  return name;
}

/** Powers raised, and dots for products: "kN/m3" becomes "kN/m³". */
static void write_well(const char *unit, char *name, size_t size)
{
  static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  size_t n = 0;
  for (const char *c = unit; *c && n + 4 < size; ++c) {
    const bool power = isdigit((unsigned char)*c) && c > unit && isalpha((unsigned char)c[-1]);
    n += (size_t)snprintf(name + n, size - n, "%s", power ? raised[*c - '0'] : *c == '*' ? "·" : (char[2]){*c, 0});
  }
  name[n < size ? n : size - 1] = 0;
}

static DisplayUnit plain_number(double largest)
{
  if (!(largest > 0) || largest >= 0.1) return (DisplayUnit){"", 1};
  if (largest >= 2e-4) return (DisplayUnit){"%", 100};
  return (DisplayUnit){"10⁻⁶", 1e6};
}

DisplayUnit display_unit(const char *unit, double largest)
{
  if (!*unit || !strcmp(unit, "1")) return plain_number(largest);
  DisplayUnit shown = {"", 1};
  for (int k = 0; k < NAMED; ++k)
    if (!strcmp(named[k].unit, unit)) {
      unit = named[k].name;
      shown.factor = named[k].factor;
    }
  largest *= shown.factor;
  const size_t length = strcspn(unit, "*/");
  char head[16] = "", whole[48];
  int own = 0, base = -1;
  if (length < sizeof head) {
    snprintf(head, sizeof head, "%.*s", (int)length, unit);
    base = read_head(head, &own);
  }
  const bool reads_well = !(largest > 0) || !isfinite(largest) || (largest >= 0.2 && largest < 2000);
  if (base < 0 || reads_well) {
    write_well(unit, shown.name, sizeof shown.name);
    return shown;
  }
  int power = bases[base].powers[0];
  for (int k = 1; k < bases[base].count; ++k)
    if (largest * pow(10, own - bases[base].powers[k]) >= 1 - 1e-9) power = bases[base].powers[k];
  shown.factor *= pow(10, own - power);
  snprintf(whole, sizeof whole, "%s%s%s", prefix_name(power), bases[base].name, unit + length);
  write_well(whole, shown.name, sizeof shown.name);
  return shown;
}

void display_heading(const char *words, const char *unit, char *heading, size_t size)
{
  snprintf(heading, size, "%s%s%s%s", words, *unit ? " [" : "", unit, *unit ? "]" : "");
  *heading = (char)toupper((unsigned char)*heading);
}
