/* Materials of a deck that no block is made of change nothing; and hybrid bonds of laws of one strain refuse what only others have. */
#include "support.h"

#define SPARE "spare: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.3, yield stress: 1}"
#define FIBRE "{model: elastic-1d, density: 2, Young modulus: 1e4}"
#define SOLID "{model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.3}"

static breccia_model *plate(const char *formulation, const char *materials)
{
  return model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {%s}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: [9, 7]}}}}\n"
      "peridynamics: {formulation: %s, space: plane stress, horizon: 2.015 spacings}\nsolve: {explicit: {steps: 1}}\n",
      materials, formulation);
}

static void other_laws_stay_outside(void **state)
{
  (void)state;
  static const struct {
    const char *formulation, *materials, *name;
  } of[] = {
      {"hybrid", "m: " FIBRE ", " SPARE, "bond-based"},

      {"hybrid", "m: " SOLID ", " SPARE, "hybrid"},
      {"hybrid", "m: " SOLID ", f: " FIBRE, "hybrid"},
  };
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    breccia_model *m = plate(of[k].formulation, of[k].materials);
    assert_string_equal(m->domain.regions[0].type->name, of[k].name);
    assert_true(!points_keep_tensors(&m->domain.regions[0].points));
    deform_uniformly(m, (double[9]){1.001, 0, 0, 0, 1, 0, 0, 0, 1});
    compute_forces(m);
    breccia_model_destroy(&m);
  }
}

static void keys_of_bonds_in_space_are_refused_of_fibres(void **state)
{
  (void)state;
  static const char *const keys[] = {"form: pairwise", "strain: small", "own bond: 0.5"};
  for (int k = 0; k < 3; ++k) {
    char deck[1024], words[100];
    snprintf(
        deck, sizeof deck,
        "units: {length: m, force: kN, time: s}\nmaterials: {m: " FIBRE "}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: [9, 7]}}}}\n"
        "peridynamics: {formulation: hybrid, space: plane stress, %s}\nsolve: {explicit: {steps: 1}}\n",
        keys[k]);
    char *said = refusal_of(deck);
    snprintf(words, sizeof words, "%.*s: belongs to hybrid bonds with laws of strain in space",
             (int)strcspn(keys[k], ":"), keys[k]);
    if (!strstr(said, words) || !strstr(said, "deck:4:")) fail_msg("expected '%s', found '%s'", words, said);
    free(said);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(other_laws_stay_outside),
                                     cmocka_unit_test(keys_of_bonds_in_space_are_refused_of_fibres)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
