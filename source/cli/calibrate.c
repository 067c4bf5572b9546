/* Parameters of a law from measured curves, or of concrete as a lattice of links from its strengths. */
#include "verbs.h"

#include <math.h>
#include <string.h>

enum { AGAINST, PICTURE, FC, FT, ENERGY, AGGREGATE, MODULUS, POISSON, DENSITY, SPACING, UNVERIFIED, INITIAL, COUNT };

static const Option options[] = {
    {"against", "DATA.csv", "measured points, instead of those that the file names"},
    {"picture", "FILE", "draw the fitted curve with the points (.png, .svg, .pdf)"},
    {"fc", "STRESS", "of concrete: strength in compression, like 4000psi or '30 MPa'"},
    {"ft", "STRESS", "of concrete: strength in tension (0.33 sqrt(w f_c), ACI 209R)"},
    {"fracture-energy", "ENERGY",
     "of concrete, per area, like '100 N/m' (by --aggregate; without either links tear at twice their tensile "
     "stretch)"},
    {"aggregate", "SIZE", "of concrete: largest grains; fracture energy by CEB-FIP 1990, and spacing of the lattice"},
    {"modulus", "STRESS", "of concrete: Young's (57000 sqrt(f_c) in psi, ACI 318)"},
    {"poisson", "RATIO", "of concrete: Poisson's (0.2)"},
    {"density", "DENSITY", "of concrete (145 lb/ft3, or 2400 kg/m3)"},
    {"spacing", "LENGTH", "of the lattice (--aggregate, or 1 in, 25 mm)"},
    {"unverified", NULL, "of concrete: run no plates"},
    {"initial-fracture-energy", "ENERGY",
     "of concrete, below the first of two lines by which links soften, like '60 N/m' (one line)"},
    {0},
};

/** @return a status */
static int print_fit(breccia_test *test, const breccia_fit *f)
{
  printf("%d points lie %.2f %% of their range from the curve (rms) and %.2f %% at most; with the file's values it was "
         "%.2f %%.\n",
         f->points, 100 * f->after, 100 * f->most, 100 * f->before);
  printf("%d of %d starts came as near", f->agreeing, f->starts);
  if (isfinite(f->next)) printf("; the others ended at %.2f %% or more", 100 * f->next);
  if (2 * f->agreeing < f->starts) printf(": there are several minima; hold the values against what else you know");
  printf(". %d runs of the test.\n", f->runs);
  breccia_fitted p = {.size = sizeof p};
  int more = 0;
  for (int k = 0; (more = breccia_test_fitted_at(test, k, &p)) > 0; ++k)
    printf("  %s: %.6g%s%s   (between %g and %g; %s)\n", p.name, p.value, *p.unit ? " " : "", p.unit, p.from, p.to,
           p.judgement);
  return more < 0 ? show(NULL, stderr) : BRECCIA_OK;
}

static int draw(breccia_test *test, const char *path, breccia_error *error)
{
  int status = breccia_test_run(test, 0, error);
  if (!status) status = breccia_test_draw(test, path, error);
  if (!status) printf("%s\n", path);
  return status;
}

static int calibrate_concrete(const char **values)
{
  for (int k = AGAINST; k <= PICTURE; ++k)
    if (values[k]) {
      complain("breccia calibrate: --%s is for measured curves, and not for 'concrete'", options[k].name);
      return 2;
    }
  breccia_error *error = breccia_error_create();
  const breccia_concrete wish = {.size = sizeof wish,
                                 .compression = values[FC],
                                 .tension = values[FT],
                                 .fracture_energy = values[ENERGY],
                                 .aggregate = values[AGGREGATE],
                                 .modulus = values[MODULUS],
                                 .poisson = values[POISSON],
                                 .density = values[DENSITY],
                                 .spacing = values[SPACING],
                                 .unverified = values[UNVERIFIED] != NULL,
                                 .initial_fracture_energy = values[INITIAL]};
  char *words;
  int status = breccia_concrete_calibrate(&wish, &words, error);
  if (words && fputs(words, stdout) < 0) status = BRECCIA_FAILURE;
  breccia_text_free(words);
  return fail(error, status);
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (argc - first != 1) {
    fprintf(stderr, "breccia calibrate: give one file TEST.yaml, or 'concrete'; see 'breccia calibrate --help'\n");
    return 2;
  }
  if (!strcmp(argv[first], "concrete")) return calibrate_concrete(values);
  for (int k = FC; k < COUNT; ++k)
    if (values[k]) {
      complain("breccia calibrate: --%s is for 'breccia calibrate concrete', and not for a file", options[k].name);
      return 2;
    }
  if (values[PICTURE] && !breccia_can_draw(values[PICTURE])) {
    complain("breccia calibrate: --picture: '%s' should end in .png, .svg or .pdf", values[PICTURE]);
    return 2;
  }
  breccia_error *error = breccia_error_create();
  breccia_test *test;
  breccia_fit fit = {.size = sizeof fit};
  int status = breccia_test_load(argv[first], &test, error);
  if (!status) status = breccia_test_fit(test, values[AGAINST], &fit, error);
  if (test) warn(breccia_test_doubts(test));
  if (!status) status = print_fit(test, &fit);
  if (!status && values[PICTURE]) status = draw(test, values[PICTURE], error);
  breccia_test_destroy(&test);
  return fail(error, status);
}

const Verb verb_calibrate = {
    .name = "calibrate",
    .arguments = "TEST.yaml [options], or breccia calibrate concrete --fc STRESS [options]",
    .about = "fit parameters of a law to a measured curve, or make concrete of links by its strengths",
    .options = options,
    .more =
        "TEST.yaml is a file as for 'breccia material', with the measured points under 'against' and under 'fit'\n"
        "the parameters to choose with their ranges: fit: {cohesion: {from: 5, to: 50}}.\n"
        "'concrete' prints a block for a deck, of the law 'link-damage', by ACI's rules with the factors of Tuniki\n"
        "2012, and says between which stresses plates of it fail in tension and in compression.",
    .run = run};
