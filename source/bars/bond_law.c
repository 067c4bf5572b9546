/* fib Model Code 2010 (fib 2013), 6.1.1, table 6.1-1: tau = tau_max (s / s1)^alpha up to s1, constant up to s2, falling to tau_f at s3. Its slope at
 * the beginning is infinite and it says nothing here of slip that goes back; so it bounds a stress that rises and falls by a steep line. */
#include "bars/bond_law.h"

#include <math.h>
#include <string.h>

static bool is_linear(const BondSpec *bond)
{
  return bond->law == BOND_LINEAR;
}

static bool splits_unconfined(const BondSpec *bond)
{
  return !isnan(bond->splitting) && bond->confinement == CONFINED_BY_NOTHING;
}

static void check_bond(const DeckReader *reader, void *section)
{
  const BondSpec *bond = section;
  const struct {
    const char *key;
    double value;
    bool linear;
  } keys[] = {{"stiffness", bond->stiffness, true},
              {"compressive strength", bond->strength, false},
              {"rib spacing", bond->rib_spacing, false},
              {"splitting stress", bond->splitting, false}};
  for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k)
    if (!isnan(keys[k].value) && keys[k].linear != is_linear(bond))
      node_error(reader->document, section_node(section, keys[k].key), reader->error,
                 "%s: is for law '%s'; leave it out", keys[k].key, keys[k].linear ? "linear" : "fib");
  if (is_linear(bond)) {
    if (isnan(bond->stiffness))
      node_error(reader->document, bond->head.node, reader->error,
                 "stiffness: law 'linear' needs it, the stress on the surface of the bar per slip, like 100 MPa/mm");
    return;
  }
  if (isnan(bond->splitting) && bond->confinement == CONFINED_BY_STIRRUPS)
    node_error(reader->document, section_node(section, "confinement"), reader->error,
               "confinement: counts where concrete splits; give 'splitting stress', or leave this out");
  if (isnan(bond->strength))
    node_error(reader->document, bond->head.node, reader->error,
               "compressive strength: law 'fib' needs it, the mean strength f_cm of cylinders");
  if (isnan(bond->rib_spacing) && !splits_unconfined(bond))
    node_error(
        reader->document, bond->head.node, reader->error,
        "rib spacing: law 'fib' needs it, the clear distance between the ribs of the bar, over which bond falls to "
        "friction");
}

static const Field bond_fields[] = {
    {.key = "law",
     .kind = FIELD_CHOICE,
     .offset = offsetof(BondSpec, law),
     .standard = "fib",
     .words = (const char *const[]){[BOND_OF_FIB] = "fib", [BOND_LINEAR] = "linear", NULL},
     .meaning = "'fib': that of fib Model Code 2010, table 6.1-1; 'linear': stress in proportion to slip, without end"},
    {.key = "stiffness",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BondSpec, stiffness),
     .dimension = "force per volume",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "of 'linear': stress on the surface of the bar per slip"},
    {.key = "condition",
     .kind = FIELD_CHOICE,
     .offset = offsetof(BondSpec, condition),
     .standard = "good",
     .words = (const char *const[]){[CONDITION_GOOD] = "good", [CONDITION_OTHER] = "other", NULL},
     .meaning =
         "of 'fib': good bond (tau_max = 2.5 sqrt(f_cm / MPa) MPa, s1 = 1 mm, s2 = 2 mm), or all other conditions "
         "(1.25 sqrt(f_cm / MPa) MPa, 1.8 mm, 3.6 mm)"},
    {.key = "compressive strength",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BondSpec, strength),
     .dimension = "stress",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "of 'fib': f_cm, the mean of cylinders"},
    {.key = "rib spacing",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BondSpec, rib_spacing),
     .dimension = "length",
     .standard = "",
     .range = "(0, inf)",
     .meaning =
         "of 'fib': clear distance between ribs, the slip at which friction is left (half of it, where concrete splits "
         "within stirrups)"},
    {.key = "splitting stress",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BondSpec, splitting),
     .dimension = "stress",
     .standard = "",
     .range = "(0, inf)",
     .meaning =
         "of 'fib': bond stress at which the concrete splits (tau_bu,split of equation 6.1-5); bars are pulled out "
         "where it is absent or above tau_max"},
    {.key = "confinement",
     .kind = FIELD_CHOICE,
     .offset = offsetof(BondSpec, confinement),
     .standard = "none",
     .words = (const char *const[]){[CONFINED_BY_NOTHING] = "none", [CONFINED_BY_STIRRUPS] = "stirrups", NULL},
     .meaning = "of 'fib' where concrete splits: with stirrups 0.4 of the stress is left as friction, else nothing"},
    {.key = "unloading stiffness",
     .kind = FIELD_NUMBER,
     .offset = offsetof(BondSpec, unloading),
     .dimension = "force per volume",
     .standard = "200 MPa/mm",
     .range = "(0, inf)",
     .meaning = "of 'fib': by which bond stress rises from nothing, and falls when the slip goes back"},
};

const Section bond_section = {
    .name = "bond",
    .about = "Bond of a bar that slips in the concrete: stress on its surface by the slip. Slip that "
             "goes back unloads steeply, down to friction the other way.",
    .size = sizeof(BondSpec),
    FIELDS(bond_fields),
    .check = check_bond};

/** A number of a unit of SI in the units of the deck. */
static double of_si(double value, const Units *units, const char *dimension)
{
  return value / units_in_si(units, dimension_find(dimension), 1);
}

BondLaw bond_law(const BondSpec *spec, const Units *units)
{
  if (is_linear(spec)) return (BondLaw){.linear = true, .stiffness = spec->stiffness};
  const bool good = spec->condition == CONDITION_GOOD;
  const double megapascal = of_si(1e6, units, "stress"), millimetre = of_si(1e-3, units, "length");
  BondLaw law = {.stiffness = spec->unloading,
                 .exponent = 0.4,
                 .peak = (good ? 2.5 : 1.25) * sqrt(spec->strength / megapascal) * megapascal,
                 .plateau_from = (good ? 1 : 1.8) * millimetre,
                 .plateau_to = (good ? 2 : 3.6) * millimetre,
                 .friction_from = spec->rib_spacing};
  law.friction = 0.4 * law.peak;
  if (spec->splitting < law.peak) {
    const bool alone = splits_unconfined(spec);
    law.friction_from = alone ? 1.2 * law.plateau_from : 0.5 * spec->rib_spacing;
    law.plateau_from *= pow(spec->splitting / law.peak, 1 / law.exponent);
    law.plateau_to = law.plateau_from;
    law.peak = spec->splitting;
    law.friction = alone ? 0 : 0.4 * law.peak;
  }
  law.friction_from = fmax(law.friction_from, 1.01 * law.plateau_to); /* ribs so near that nothing would be between */
  return law;
}

static void add_quantity(double value, const Units *units, const char *dimension, Text *text)
{
  quantity_describe(value * units_in_si(units, dimension_find(dimension), 1), !strcmp(dimension, "length") ? "m" : "Pa",
                    text);
}

void bond_law_describe(const BondLaw *law, const Units *units, Text *text)
{
  text_add(text, "bond of ");
  if (law->linear) {
    add_quantity(law->stiffness * of_si(1e-3, units, "length"), units, "stress", text);
    text_add(text, " per mm of slip");
    return;
  }
  const bool level = law->plateau_to > law->plateau_from;
  add_quantity(law->peak, units, "stress", text);
  text_add(text, level ? " between slips of " : " at a slip of ");
  add_quantity(law->plateau_from, units, "length", text);
  text_add(text, level ? " and " : ", ");
  if (level) add_quantity(law->plateau_to, units, "length", text);
  text_add(text, level ? ", " : "");
  if (law->friction > 0)
    add_quantity(law->friction, units, "stress", text);
  else
    text_add(text, "none");
  text_add(text, " beyond ");
  add_quantity(law->friction_from, units, "length", text);
}

double bond_law_envelope(const BondLaw *law, double slip, double *slope)
{
  double stress = law->friction, rise = 0;
  if (slip < law->plateau_from) {
    stress = law->peak * pow(slip / law->plateau_from, law->exponent);
    rise = slip > 0 ? law->exponent * stress / slip : INFINITY;
  } else if (slip <= law->plateau_to) {
    stress = law->peak;
  } else if (slip < law->friction_from) {
    rise = (law->friction - law->peak) / (law->friction_from - law->plateau_to);
    stress = law->peak + rise * (slip - law->plateau_to);
  }
  if (slope) *slope = rise;
  return stress;
}

/** The most that is carried forward at a slip: beyond the largest one so far the envelope, before it what is left of it by the unloading line, or the
 *  friction of ribs that move in their own tracks. */
static double bound(const BondLaw *law, double slip, double forward, double friction, double *slope)
{
  double line;
  if (slip >= forward) {
    line = bond_law_envelope(law, slip, slope);
  } else {
    line = bond_law_envelope(law, forward, NULL) - law->stiffness * (forward - slip);
    *slope = law->stiffness;
  }
  if (line > friction) return line;
  *slope = 0;
  return friction;
}

double bond_law_stress(const BondLaw *law, const BondState *from, double slip, bool elastic, double *slope)
{
  *slope = law->stiffness;
  if (law->linear) return law->stiffness * slip;
  const double stress = from->stress + law->stiffness * (slip - from->slip);
  if (elastic) return stress;
  const double farthest = fmin(law->plateau_from, fmax(from->forward, -from->backward)),
               friction = law->friction / law->peak * bond_law_envelope(law, farthest, NULL);
  double up, down;
  const double most = bound(law, slip, from->forward, friction, &up),
               least = -bound(law, -slip, -from->backward, friction, &down);
  if (stress > most) {
    *slope = up;
    return most;
  }
  if (stress < least) {
    *slope = down;
    return least;
  }
  return stress;
}
