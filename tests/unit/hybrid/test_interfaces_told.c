/* What `check` tells of layers of hybrid bodies that are stretched along their interface, beside the energy that they
 * store. */
#include "support.h"

#include "model/plausibility.h"
#include <string.h>

static void the_stiffer_layer_acts_as_much_thinner_as_is_told(void **state)
{
  (void)state;
  enum { ROWS = 6, COLUMNS = 24 };
  static const struct {
    double spacings, contrast;
  } of[] = {{2.015, 3}, {2.015, 100}, {3.015, 30}};
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                                "materials: {s: {model: elastic, density: 2, Young modulus: 1e6, Poisson ratio: 0.2},\n"
                                "            w: {model: elastic, density: 2, Young modulus: %g, Poisson ratio: 0.2}}\n"
                                "body:\n  a: {material: s, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: "
                                "{from: [0, 0], to: [2.4, 0.6]}}}\n"
                                "  b: {material: w, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: {from: "
                                "[0, 0.6], to: [2.4, 1.2]}}}\n"
                                "peridynamics: {space: plane stress, formulation: hybrid, horizon: %g spacings}\n"
                                "loads: [{on: {all: yes}, field: {displacement: ['1e-6 * x', free]}}, {on: {nearest: "
                                "[1.25, 0.05]}, displacement: "
                                "[free, 0]}]\nsolve: {static: {increments: 1}}\n",
                                1e6 / of[k].contrast, of[k].spacings);
    step_surely(m, 1);
    const double exact = 0.5e-12 * (1e6 + 1e6 / of[k].contrast) * COLUMNS * ROWS * 1e-3,
                 share = solver_energy(&m->solver).stored / exact,
                 missing = (1 - share) * ROWS * (1 + 1 / of[k].contrast);
    Text text = {0};
    plausibility_describe(m, false, &text);
    const char *told = strstr(text_words(&text), "acts up to ");
    assert_non_null(told);
    holds_words(told, "spacings thinner along the interface");
    assert_near(strtod(told + strlen("acts up to "), NULL), missing, 0.1 * missing);
    text_free(&text);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_stiffer_layer_acts_as_much_thinner_as_is_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
