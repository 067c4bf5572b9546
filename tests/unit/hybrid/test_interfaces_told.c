/* Text of `check` on interfaces of two materials. `check` prints nothing for interfaces along rows of particles in hybrid
 * and ordinary bodies of elastic materials, which are right. */
#include "support.h"

#include "model/plausibility.h"
#include <string.h>
#include <unistd.h>

#define FILES "test_interfaces_told"

/** Writes the particles of a square lattice on one side of a line through its middle. */
static void write_side(const char *name, double slope, bool above)
{
  enum { LENGTH = 16 };
  FILE *file = fopen(name, "w");
  assert_non_null(file);
  fprintf(file, "x,y,volume\n");
  for (int i = 0; i < LENGTH; ++i)
    for (int j = 0; j < LENGTH; ++j)
      if ((j + 0.5 > LENGTH / 2. + slope * (i + 0.4 - LENGTH / 2.)) == above)
        fprintf(file, "%.1f,%.1f,1\n", i + 0.5, j + 0.5);
  fclose(file);
}

/** Returns the text of `check` on a body whose upper half is ten times stiffer; owned by the caller. */
static char *told_of(const char *formulation, double slope)
{
  write_side(FILES "_0.csv", slope, false);
  write_side(FILES "_1.csv", slope, true);
  breccia_model *m =
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials: {s: {model: elastic, density: 2, Young modulus: 1e6, Poisson ratio: 0.25},\n"
               "            w: {model: elastic, density: 2, Young modulus: 1e5, Poisson ratio: 0.25}}\n"
               "body:\n  a: {material: w, lattice: square, spacing: 1, thickness: 1, file: " FILES "_0.csv}\n"
               "  b: {material: s, lattice: square, spacing: 1, thickness: 1, file: " FILES "_1.csv}\n"
               "peridynamics: {space: plane strain, formulation: %s, horizon: 2.015 spacings}\n"
               "solve: {explicit: {time step: 1e-6, steps: 1}}\n",
               formulation);
  Text text = {0};
  const Region *region = &m->domain.regions[0];
  plausibility_describe(m, false, &text);
  if (region->type->describe) region->type->describe(region->formulation, m->units, &text);
  char *words = strdup(text_words(&text));
  text_free(&text);
  breccia_model_destroy(&m);
  unlink(FILES "_0.csv");
  unlink(FILES "_1.csv");
  return words;
}

static void only_interfaces_that_are_off_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *formulation;
    double slope;
    const char *told;
  } of[] = {{"hybrid", 0, NULL},
            {"hybrid", 0.5, "cross rows of particles"},
            {"ordinary", 0, NULL},
            {"ordinary", 0.5, "cross rows of particles, where bonds along them are missing"},
            {"correspondence", 0, "spacings thinner across the interface"}};
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    char *told = told_of(of[k].formulation, of[k].slope);
    if (of[k].told)
      holds_words(told, of[k].told);
    else if (strstr(told, "thinner") || strstr(told, "cross rows"))
      fail_msg("%s, slope %g: %s", of[k].formulation, of[k].slope, told);
    free(told);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(only_interfaces_that_are_off_are_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
