/* Parameters of the law 'link-damage' for a lattice of links, from what is known of a concrete: by the rules of ACI 318 and ACI 209R with the factors of Tuniki
 * 2012 (eqs. 4.1 to 4.6), or with a fracture energy. Plates of 15 by 51 rows are then pulled and pressed, as there, until they fail, and pulled along the rows of the lattice besides: the
 * stretches are set right by what they bear, where a fracture energy lets cracks grow, and the loads stand beside the strengths wanted. */
#include "base/memory.h"
#include "deck/quantity.h"
#include "model/host.h"
#include "model/model.h"
#include "model/sized.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double psi = 6894.757293168, pound_per_foot3 = 16.01846337, inch = 0.0254;

/** What is known or follows, in m, N, s, kg; NaN: not yet. */
typedef struct Concrete {
  double compression, tension, energy, aggregate, modulus, poisson, density, spacing, tensile_stretch,
      compressive_stretch;
  const char *rules[10]; /* where each comes from, in that order; NULL: it was given */
  bool us;               /* told in units of the US */
  double initial;        /* fracture energy below the first of two lines; NaN: there is one */
} Concrete;

enum { COMPRESSION, TENSION, ENERGY, AGGREGATE, MODULUS, POISSON, DENSITY, SPACING, TENSILE, COMPRESSIVE };

/** A number of the wish: what it is of, where it goes, and what concretes have, in m, N, s, kg and in words. */
typedef struct Given {
  const char *name, *words, *dimension;
  double *value, least, most;
  const char *range;
} Given;

static int read(const Units *units, const Given *g, Error *error)
{
  Text reason = {0};
  int status = BRECCIA_OK;
  if (!g->words) return BRECCIA_OK;
  if (units_read(units, dimension_find(g->dimension), g->words, g->value, &reason))
    status = error_add(error, BRECCIA_USER_ERROR, "%s: %s", g->name, text_words(&reason));
  else if (!(*g->value >= g->least && *g->value <= g->most))
    status = error_add(error, BRECCIA_USER_ERROR, "%s: '%s' is out of range for concrete; expected %s", g->name,
                       g->words, g->range);
  text_free(&reason);
  return status;
}

static int read_all(Concrete *c, const breccia_concrete *given, Error *error)
{
  Units *units = units_create(UNITS_LENGTH, UNITS_FORCE, UNITS_TIME, error);
  if (!units) return BRECCIA_FAILURE;
  *c = (Concrete){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, {0}, false, NAN};
  const Given rows[] = {
      {"fc", given->compression, "stress", &c->compression, 1e6, 250e6, "1 MPa to 250 MPa, like 4000psi"},
      {"ft", given->tension, "stress", &c->tension, 0.1e6, 25e6, "0.1 MPa to 25 MPa, like 250psi"},
      {"fracture-energy", given->fracture_energy, "fracture energy", &c->energy, 1, 1e5,
       "1 N/m to 100 kN/m, like '100 N/m'"},
      {"initial-fracture-energy", given->initial_fracture_energy, "fracture energy", &c->initial, 1, 1e5,
       "1 N/m to 100 kN/m, like '60 N/m'"},
      {"aggregate", given->aggregate, "length", &c->aggregate, 1e-3, 0.3, "1 mm to 300 mm, like 16mm"},
      {"modulus", given->modulus, "stress", &c->modulus, 1e9, 100e9, "1 GPa to 100 GPa, like 30GPa"},
      {"poisson", given->poisson, "1", &c->poisson, 0, 1.0 / 3, "0 to 1/3, which links in plane stress can have"},
      {"density", given->density, "density", &c->density, 300, 8000, "300 to 8000 kg/m3, like '145 lb/ft3'"},
      {"spacing", given->spacing, "length", &c->spacing, 1e-4, 10, "0.1 mm to 10 m, like 1in"},
  };
  int status = BRECCIA_OK;
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
    if (read(units, &rows[k], error)) status = BRECCIA_USER_ERROR;
  const char *strength = given->compression ? given->compression : given->tension;
  c->us = strength && (strstr(strength, "psi") || strstr(strength, "ksi"));
  units_destroy(&units);
  if (!status && !strength)
    status = error_add(error, BRECCIA_USER_ERROR,
                       "give the strength of the concrete: in compression, 'fc', or in tension, 'ft'");
  if (!status && c->tension >= c->compression)
    status = error_add(error, BRECCIA_USER_ERROR,
                       "ft: '%s' is not below the strength in compression, '%s'; concrete has some tenth of it",
                       given->tension, given->compression);
  return status;
}

static void set(Concrete *c, int which, double *value, double rule, const char *words)
{
  if (!isnan(*value)) return;
  *value = rule;
  c->rules[which] = words;
}

/** Fills in by rules what was not given. */
static void apply_rules(Concrete *c)
{
  set(c, DENSITY, &c->density, c->us ? 145 * pound_per_foot3 : 2400, "of normal weight");
  set(c, POISSON, &c->poisson, 0.2, "usual");
  const double weight = c->density / pound_per_foot3; /* lb/ft3 */
  set(c, TENSION, &c->tension, 0.33 * sqrt(weight * c->compression / psi) * psi,
      "0.33 sqrt(w f_c), in lb/ft3 and psi (ACI 209R)");
  set(c, COMPRESSION, &c->compression, pow(c->tension / psi / 0.33, 2) / weight * psi,
      "from f_t = 0.33 sqrt(w f_c), in lb/ft3 and psi (ACI 209R)");
  set(c, MODULUS, &c->modulus, 57000 * sqrt(c->compression / psi) * psi, "57000 sqrt(f_c), in psi (ACI 318)");
  if (!isnan(c->aggregate)) {
    const double d = c->aggregate * 1e3;
    set(c, SPACING, &c->spacing, c->aggregate, "the size of the aggregate");
    set(c, ENERGY, &c->energy, (0.0469 * d * d - 0.5 * d + 26) * pow(c->compression / 10e6, 0.7),
        "(0.0469 d^2 - 0.5 d + 26) (f_c / 10 MPa)^0.7 N/m, d in mm (CEB-FIP 1990)");
  }
  set(c, SPACING, &c->spacing, c->us ? inch : 0.025, "that of Tuniki 2012");
  if (isnan(c->energy))
    set(c, TENSILE, &c->tensile_stretch, 0.87 * c->tension / c->modulus, "0.87 f_t / E (Tuniki 2012, eq. 4.3)");
  else
    set(c, TENSILE, &c->tensile_stretch, (0.75 - 0.25 * c->poisson) * c->tension / c->modulus,
        "set so that plates bear f_t");
  set(c, COMPRESSIVE, &c->compressive_stretch, 0.88 * c->compression / c->modulus,
      "0.88 f_c / E (Tuniki 2012, eq. 4.6)");
}

/** A number with its unit as a deck reads it. */
static void say(Text *t, double value, const char *unit)
{
  text_add(t, "%.4g%s%s", value, *unit ? " " : "", unit);
}

static void add_block(const Concrete *c, Text *t)
{
  const double stress = c->us ? psi : 1e6;
  const char *unit = c->us ? "psi" : "MPa";
  text_add(t, "materials:\n  concrete:\n    model: link-damage\n    density: ");
  say(t, c->us ? c->density / pound_per_foot3 : c->density, c->us ? "lb/ft3" : "kg/m3");
  text_add(t, "\n    Young modulus: ");
  say(t, c->modulus / stress, unit);
  text_add(t, "\n    Poisson ratio: %.4g\n    tensile stretch: %.4g\n", c->poisson, c->tensile_stretch);
  if (isnan(c->energy))
    text_add(t, "    tensile ductility: 2\n");
  else
    text_add(t, "    fracture energy: %.4g N/m\n", c->energy);
  if (!isnan(c->initial)) text_add(t, "    initial fracture energy: %.4g N/m\n", c->initial);
  text_add(t, "    compressive stretch: %.4g\n    compressive ductility: 2\n", c->compressive_stretch);
}

static void add_spacing(const Concrete *c, Text *t)
{
  say(t, c->us ? c->spacing / inch : c->spacing * 1e3, c->us ? "in" : "mm");
}

/* ---- plates ---- */

enum { WIDE = 15, ROWS = 51 };

/** Which way a plate is loaded, where the rows of its lattice run along x. */
typedef enum Way { ACROSS_ROWS, ALONG_ROWS } Way;

/** A body and its loads: 15 spacings wide, with straight sides, 51 rows high, and loaded across them. */
static void add_upright(const Concrete *c, double load, Text *t)
{
  text_add(t,
           "body: {plate: {material: concrete, lattice: hexagonal, spacing: %.17g m, thickness: %.17g m, shape: {box: "
           "{particles: [%d, %d], first particle: [0, 0]}}}}\n",
           c->spacing, c->spacing, WIDE + 1, ROWS);
  text_add(t, "cracks: [{remove: {box: {from: [%.17g, -1e3], to: [%.17g, 1e6]}}}]\n", (WIDE + 0.25) * c->spacing,
           (WIDE + 1) * c->spacing);
  text_add(t,
           "loads: [{on: {face: y+, layers: 3}, force: [0, %.17g]}, {on: {face: y-, layers: 3}, force: [0, %.17g]}]\n",
           load, -load);
}

/** 15 rows of 51, loaded along them at the three outermost particles of each. */
static void add_lying(const Concrete *c, double load, Text *t)
{
  text_add(t,
           "body: {plate: {material: concrete, lattice: hexagonal, spacing: %.17g m, thickness: %.17g m, shape: {box: "
           "{particles: [%d, %d], first particle: [0, 0]}}}}\n",
           c->spacing, c->spacing, ROWS, WIDE);
  text_add(t,
           "loads: [{on: {inside: {box: {from: [%.17g, -1e3], to: [1e6, 1e6]}}}, force: [%.17g, 0]}, "
           "{on: {inside: {box: {from: [-1e3, -1e3], to: [%.17g, 1e6]}}}, force: [%.17g, 0]}]\n",
           (ROWS - 3.25) * c->spacing, load, 2.75 * c->spacing, -load);
}

/** The deck of a plate one spacing thick under a stress at its ends. Its period is that of a bar. */
static void add_plate(const Concrete *c, Way way, double stress, Text *t)
{
  const double row = sqrt(0.75) * c->spacing, length = ROWS * (way == ALONG_ROWS ? c->spacing : row),
               width = WIDE * (way == ALONG_ROWS ? row : c->spacing);
  add_block(c, t);
  (way == ALONG_ROWS ? add_lying : add_upright)(c, stress * width * c->spacing, t);
  text_add(t,
           "peridynamics: {formulation: micropolar, space: plane stress}\n"
           "solve: {explicit: {quasi-static: {period: %.17g s%s}}}\n",
           2 * length / sqrt(c->modulus / c->density), way == ALONG_ROWS ? ", hold: 10" : "");
}

static const char place_in_deck[] = " block 'plate': ";

/** @param[in] stress  over the width, tension positive @param[out] bears  whether the plate is steady in the end */
static int try_plate(const Concrete *c, Way way, double stress, bool *bears, Error *error)
{
  Text deck = {0};
  const breccia_options wishes = {.size = sizeof wishes, .threads = 1};
  breccia_model *model = NULL;
  add_plate(c, way, stress, &deck);
  Error *refused = breccia_error_create();
  int status = deck.failed || !refused
                   ? error_add(error, BRECCIA_FAILURE, "out of memory: plates")
                   : breccia_model_load_string(text_words(&deck), "plate", &wishes, &model, refused);
  if (status) { /* without the place in a deck that nobody has seen */
    const char *words = breccia_error_text(refused), *block = strstr(words, place_in_deck);
    if (*words) error_add(error, status, "plates of this concrete: %s", block ? block + strlen(place_in_deck) : words);
  }
  breccia_error_destroy(&refused);
  while (!status && !solver_is_done(&model->solver)) status = breccia_model_step(model, 1000000, error);
  if (!status) *bears = model->solver.records[0].steady == STEADY;
  breccia_model_destroy(&model);
  text_free(&deck);
  return status;
}

/** Stresses of one sign between which the plate fails, a hundredth apart; looked for from the wanted one. */
static int find_strength(const Concrete *c, Way way, double wanted, double *low, double *high, Error *error)
{
  const double stride = 1.25, most = 16, near = 0.01;
  double bears = 0, fails = INFINITY, stress = fabs(wanted);
  int status = BRECCIA_OK;
  while (!status && (isinf(fails) || fails - bears > near * fails)) {
    bool held = false;
    status = try_plate(c, way, wanted > 0 ? stress : -stress, &held, error);
    *(held ? &bears : &fails) = stress;
    stress = isinf(fails) ? bears * stride : bears > 0 ? sqrt(bears * fails) : fails / stride;
    if (!status && !(stress < most * fabs(wanted) && stress * most > fabs(wanted)))
      status = error_add(error, BRECCIA_USER_ERROR,
                         "plates of this concrete %s in %s, so that it cannot be set right; look at 'fc', 'ft', the "
                         "fracture energy and the spacing",
                         held ? "bear 16 times their strength" : "do not bear a 16th of their strength",
                         wanted > 0 ? "tension" : "compression");
  }
  *low = bears;
  *high = fails;
  return status;
}

static void tell_row(const Concrete *c, const char *name, int which, double value, const char *unit, Text *t)
{
  if (isnan(value)) return;
  text_add(t, "#   %-8s ", name);
  say(t, value, unit);
  text_add(t, "%s%s\n", c->rules[which] ? ": " : "", c->rules[which] ? c->rules[which] : "");
}

static void tell(const Concrete *c, Text *t)
{
  const double stress = c->us ? psi : 1e6, length = c->us ? inch : 1e-3;
  const char *unit = c->us ? "psi" : "MPa";
  text_add(t, "# Concrete as a lattice of links:\n");
  tell_row(c, "f_c", COMPRESSION, c->compression / stress, unit, t);
  tell_row(c, "f_t", TENSION, c->tension / stress, unit, t);
  tell_row(c, "E", MODULUS, c->modulus / stress, unit, t);
  tell_row(c, "nu", POISSON, c->poisson, "", t);
  tell_row(c, "w", DENSITY, c->us ? c->density / pound_per_foot3 : c->density, c->us ? "lb/ft3" : "kg/m3", t);
  tell_row(c, "spacing", SPACING, c->spacing / length, c->us ? "in" : "mm", t);
  tell_row(c, "G_F", ENERGY, c->energy, "N/m", t);
  tell_row(c, "S_t", TENSILE, c->tensile_stretch, "", t);
  tell_row(c, "S_c", COMPRESSIVE, c->compressive_stretch, "", t);
}

static void tell_strength(const Concrete *c, const char *name, double low, double high, double wanted, Text *t)
{
  const double stress = c->us ? psi : 1e6;
  text_add(t, "#   in %s between %.4g and %.4g %s, %.3f to %.3f of the strength wanted\n", name, low / stress,
           high / stress, c->us ? "psi" : "MPa", low / wanted, high / wanted);
}

/** Runs plates; with a fracture energy the stretch in tension is set by what they bear first. */
static int verify(Concrete *c, Text *words, Error *error)
{
  double low, high;
  int status = BRECCIA_OK;
  for (int turn = 0; turn < 2 && !isnan(c->energy) && !status; ++turn) {
    status = find_strength(c, ACROSS_ROWS, c->tension, &low, &high, error);
    if (!status) c->tensile_stretch *= 2 * c->tension / (low + high);
  }
  text_add(words, "# Plates %d spacings wide and %d rows high, loaded by three rows at each end, fail\n", WIDE, ROWS);
  if (!status) status = find_strength(c, ACROSS_ROWS, c->tension, &low, &high, error);
  if (!status) tell_strength(c, "tension", low, high, c->tension, words);
  if (!status) status = find_strength(c, ALONG_ROWS, c->tension, &low, &high, error);
  if (!status) tell_strength(c, "tension along the rows of the lattice", low, high, c->tension, words);
  if (!status) status = find_strength(c, ACROSS_ROWS, -c->compression, &low, &high, error);
  if (!status) tell_strength(c, "compression", low, high, c->compression, words);
  return status;
}

int breccia_concrete_calibrate(const breccia_concrete *given, char **words, breccia_error *error)
{
  if (host_lacks(words, __func__, "words", error)) return BRECCIA_USER_ERROR;
  breccia_concrete wish;
  Concrete c;
  Text t = {0}, found = {0};
  const Host host = host_enter();
  int status = sized_take(&wish, sizeof wish, given, "breccia_concrete", error);
  if (!status) status = read_all(&c, &wish, error);
  if (!status) apply_rules(&c);
  if (!status && !isnan(c.initial) && !(c.initial < c.energy))
    status = error_add(error, BRECCIA_USER_ERROR,
                       "initial-fracture-energy: '%s' is a part of the fracture energy, which %s; give more by "
                       "'fracture-energy' or 'aggregate'",
                       wish.initial_fracture_energy, isnan(c.energy) ? "is not given" : "is no larger");
  if (!status && !wish.unverified) status = verify(&c, &found, error);
  if (!status) {
    tell(&c, &t);
    text_add(&t, "%s# Blocks of the body: {lattice: hexagonal, spacing: ", text_words(&found));
    add_spacing(&c, &t);
    text_add(&t, "}\nperidynamics: {formulation: micropolar, space: plane stress}\n");
    add_block(&c, &t);
  }
  if (!status && (t.failed || found.failed)) status = error_add(error, BRECCIA_FAILURE, "out of memory: calibration");
  text_free(&found);
  status = host_leave(&host, status, error);
  *words = status ? NULL : text_take(&t);
  text_free(&t);
  return status;
}
