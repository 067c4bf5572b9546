/* Layers of little strength between blocks that cannot fail: their largest force, and warnings of too few rows. */
#include "model/run.h"
#include "solver/reactions.h"
#include "support.h"

#define LAYER_STRENGTH 3e6
#define LAYER_WIDTH 0.025
#define BRITTLE ", tensile strength: 3e6, fracture energy: 100"

/** A strip of three blocks, the middle one of some rows. @param[in] ratio  of Young's modulus of the outer blocks */
static breccia_model *strip_of(const char *elastic, const char *law, double ratio, int rows, const char *peridynamics,
                               double pull, const char *more)
{
  const double spacing = 0.005, left = 5 * spacing, right = (5 + rows) * spacing, end = (10 + rows) * spacing;
  return model_of(
      "units: {length: m, force: N, time: s}\n"
      "materials: {e: {density: 2400, Young modulus: %g, %s}, w: {density: 2400, Young modulus: 30e9, %s}}\n"
      "body:\n"
      "  l: {material: e, lattice: square, spacing: 0.005, thickness: 1, shape: {box: {from: [0, 0], to: [%g, %g]}}}\n"
      "  m: {material: w, lattice: square, spacing: 0.005, thickness: 1, shape: {box: {from: [%g, 0], to: [%g, %g]}}}\n"
      "  r: {material: e, lattice: square, spacing: 0.005, thickness: 1, shape: {box: {from: [%g, 0], to: [%g, %g]}}}\n"
      "peridynamics: {space: plane stress, %s}\n"
      "loads:\n"
      "  - {on: {face: x-, layers: 2}, displacement: [0, free]}\n"
      "  - {on: {nearest: [0.0025, 0.0125]}, displacement: [free, 0]}\n"
      "  - {name: pull, on: {face: x+, layers: 2}, displacement: [%g, free], history: {ramp to: 1}}\n"
      "solve: {static: {increments: 8}}\n%s",
      30e9 * ratio, elastic, law, left, LAYER_WIDTH, left, right, LAYER_WIDTH, right, end, LAYER_WIDTH, peridynamics,
      pull, more);
}

#define SOLID "model: elastic, Poisson ratio: 0.2"
#define MAZARS "model: mazars, Poisson ratio: 0.2" BRITTLE
#define LINE "model: elastic-1d"
#define SOFTENS "model: bilinear-softening" BRITTLE
#define YIELDS "model: j2, Poisson ratio: 0.2, yield stress: 3e6"
#define LINKS "model: link-damage, Poisson ratio: 0.2, tensile stretch: 1e-4, fracture energy: 100"
#define VISCOUS "model: viscoelastic, Poisson ratio: 0.2, relaxing share: 0.5, relaxation time: 1"

/** Runs a strip. @return its largest mean stress over the tensile strength */
static double strip_peak(breccia_model *m)
{
  double peak = 0;
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    Reactions reactions = {0};
    assert_int_equal(reactions_create(&reactions, m->domain.particles, NULL), 0);
    const Wrench sum = reactions_sum(&reactions, &m->solver, NULL, "pull", NULL);
    reactions_destroy(&reactions);
    peak = larger_of(peak, sum.force[0] / (LAYER_WIDTH * LAYER_STRENGTH));
  }
  return peak;
}

/** Two rows at a horizon of two spacings fail at their strength where bonds have points: a bond between both materials
 *  follows the one that fails. */
static void thin_layers_fail_at_their_strength(void **state)
{
  (void)state;
  static const char *const strips[][3] = {{SOLID, MAZARS, "formulation: hybrid"},
                                          {LINE, SOFTENS, "formulation: bond-based, horizon: 2.015 spacings"}};
  for (int k = 0; k < 4; ++k) { /* moduli within 1 % count as equal */
    const char *const *strip = strips[k % 2];
    breccia_model *m = strip_of(strip[0], strip[1], k < 2 ? 1 : 0.995, 2, strip[2], 40e-6, "");
    assert_string_equal(breccia_model_warnings(m), "");
    assert_near(strip_peak(m), 0.97, 0.08);
    assert_balanced(m, 1e-3);
    breccia_model_destroy(&m);
  }
}

/** Layers of enough rows between blocks of their own or of a larger modulus carry their strength and no more. */
static void soft_layers_carry_their_strength_between_stiff_blocks(void **state)
{
  (void)state;
  static const struct {
    const char *elastic, *law, *formulation;
    int rows, contrasts; /* contrasts: number of ratios; perfectly plastic bonds find no equilibrium at the last one */
    double least, most;  /* peak over strength */
  } strips[] = {{LINE, SOFTENS, "bond-based", 6, 3, 0.85, 1},
                {LINE, "model: elastic-perfectly-plastic, yield stress: 3e6", "bond-based", 6, 2, 0.9, 1.41},
                {SOLID, YIELDS, "ordinary", 8, 3, 0.9, 1.15}};
  static const double ratios[] = {1, 10, 100};
  for (size_t k = 0; k < sizeof strips / sizeof *strips; ++k)
    for (int n = 0; n < strips[k].contrasts; ++n) {
      char *words = text_format("formulation: %s, horizon: 2.015 spacings", strips[k].formulation);
      breccia_model *m = strip_of(strips[k].elastic, strips[k].law, ratios[n], strips[k].rows, words, 16e-6, "");
      const double peak = strip_peak(m);
      print_message("%s, contrast %g: %.3f of the strength\n", strips[k].law, ratios[n], peak);
      if (!(peak >= strips[k].least && peak <= strips[k].most))
        fail_msg("%s, %s, contrast %g: %.3f of the strength", strips[k].formulation, strips[k].law, ratios[n], peak);
      breccia_model_destroy(&m);
      free(words);
    }
}

/** Warnings appear below the number of rows that a layer needs by formulation, and for no layer that needs none. */
static void layers_that_blocks_bridge_are_told(void **state)
{
  (void)state;
  static const struct {
    const char *elastic, *law, *peridynamics;
    double ratio;
    int wanted; /* rows; 0: none is told */
  } strips[] = {
      {SOLID, MAZARS, "formulation: hybrid", 1, 2},
      {SOLID, MAZARS, "formulation: hybrid, horizon: 3.015 spacings", 1, 4},
      {SOLID, MAZARS, "formulation: hybrid", 1.2, 4},
      {SOLID, MAZARS, "formulation: correspondence, horizon: 2.015 spacings", 1, 4},
      {SOLID, YIELDS, "formulation: correspondence, horizon: 2.015 spacings", 1, 8},
      {SOLID, YIELDS, "formulation: ordinary, horizon: 2.015 spacings", 1, 8},
      {SOLID, LINKS, "formulation: micropolar, horizon: 2.015 spacings", 1, 2},
      {LINE, SOFTENS, "formulation: bond-based", 1, 3},
      {LINE, SOFTENS, "formulation: bond-based", 1.2, 6},
      {SOLID, VISCOUS, "formulation: correspondence", 1, 0},
      {YIELDS, MAZARS, "formulation: correspondence", 1, 0},
  };
  for (size_t k = 0; k < sizeof strips / sizeof *strips; ++k)
    for (int rows = strips[k].wanted - 1; rows <= strips[k].wanted; ++rows) {
      if (rows < 1 && strips[k].wanted) continue;
      breccia_model *m = strip_of(strips[k].elastic, strips[k].law, strips[k].ratio, rows < 1 ? 2 : rows,
                                  strips[k].peridynamics, 1e-9, "");
      char words[128];
      snprintf(words, sizeof words,
               "block 'm' is a layer of %d row%s between blocks 'l' and 'r', which cannot fail, and %d rows are wanted",
               rows, rows == 1 ? "" : "s", strips[k].wanted);
      const bool told = strips[k].wanted && rows < strips[k].wanted;
      if ((strstr(breccia_model_warnings(m), words) != NULL) != told ||
          (strstr(breccia_model_warnings(m), "is a layer of") != NULL) != told)
        fail_msg("%zu, %d rows, wanted '%s': %s", k, rows, words, breccia_model_warnings(m));
      Text last = {0};
      run_tell_thin_layers(m, &last);
      assert_int_equal(strstr(text_words(&last), "its strength is OVERESTIMATED") != NULL, told);
      text_free(&last);
      breccia_model_destroy(&m);
    }
}

/** Half of a layer at a plane of symmetry counts with its image. */
static void half_a_layer_counts_with_its_image(void **state)
{
  (void)state;
  for (int rows = 1; rows <= 2; ++rows) {
    breccia_model *m = model_of(
        "units: {length: m, force: N, time: s}\n"
        "materials: {e: {density: 2400, Young modulus: 30e9, " SOLID
        "}, w: {density: 2400, Young modulus: 30e9, " MAZARS "}}\nbody:\n"
        "  l: {material: e, lattice: square, spacing: 0.005, thickness: 1, shape: {box: {particles: [5, 5]}}}\n"
        "  m: {material: w, lattice: square, spacing: 0.005, thickness: 1, shape: {box: {from: [0.025, 0], to: [%g, "
        "0.025]}}}\n"
        "peridynamics: {space: plane stress, formulation: hybrid, horizon: 3.015 spacings}\n"
        "loads: [{on: {block: m, face: x+}, support: {held: across}}, {on: {block: l, face: x-}, displacement: [-1e-9, "
        "0], history: {ramp to: 1}}]\nsolve: {static: {increments: 1}}\n",
        0.025 + 0.005 * rows);
    const bool told = strstr(breccia_model_warnings(m), "block 'm' is a layer of 2 rows between both sides") != NULL;
    if (told != (rows == 1)) fail_msg("%d rows: %s", rows, breccia_model_warnings(m));
    breccia_model_destroy(&m);
  }
}

/** Writes columns of five particles to a CSV file.
 *  @param[in] first, behind  numbers of the first column and of the one behind the last */
static void write_columns(const char *name, int first, int behind)
{
  const double spacing = 0.005;
  FILE *table = fopen(name, "w");
  assert_non_null(table);
  fputs("x,y,volume\n", table);
  for (int column = first; column < behind; ++column)
    for (int row = 0; row < 5; ++row) fprintf(table, "%g,%g,25e-6\n", (column + 0.5) * spacing, (row + 0.5) * spacing);
  fclose(table);
}

/** Layers of blocks from files are told as those of blocks with shapes, whichever of the blocks are from files. */
static void layers_from_files_are_told(void **state)
{
  (void)state;
  static const char *const files[] = {"test_thin_left.csv", "test_thin_layer.csv", "test_thin_right.csv"};
  for (int rows = 2; rows <= 4; ++rows)
    for (int from_file = 1; from_file < 8; ++from_file) { /* a bit for each block */
      const int ends[] = {0, 5, 5 + rows, 10 + rows};
      char body[3][128];
      for (int k = 0; k < 3; ++k) {
        write_columns(files[k], ends[k], ends[k + 1]);
        if (from_file >> k & 1)
          snprintf(body[k], sizeof body[k], "file: %s", files[k]);
        else
          snprintf(body[k], sizeof body[k], "shape: {box: {from: [%g, 0], to: [%g, 0.025]}}", ends[k] * 0.005,
                   ends[k + 1] * 0.005);
      }
      breccia_model *m = model_of(
          "units: {length: m, force: N, time: s}\n"
          "materials: {e: {density: 2400, Young modulus: 30e9, " SOLID
          "}, w: {density: 2400, Young modulus: 30e9, " MAZARS "}}\nbody:\n"
          "  l: {material: e, lattice: square, spacing: 0.005, thickness: 1, %s}\n"
          "  m: {material: w, lattice: square, spacing: 0.005, thickness: 1, %s}\n"
          "  r: {material: e, lattice: square, spacing: 0.005, thickness: 1, %s}\n"
          "peridynamics: {space: plane stress, formulation: hybrid, horizon: 3.015 spacings}\n"
          "loads: [{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [1e-9, 0], history: {ramp "
          "to: 1}}]\nsolve: {static: {increments: 1}}\n",
          body[0], body[1], body[2]);
      char words[64];
      snprintf(words, sizeof words, "block 'm' is a layer of %d rows between blocks 'l' and 'r'", rows);
      if ((strstr(breccia_model_warnings(m), words) != NULL) != (rows < 4))
        fail_msg("%d rows, files %d: %s", rows, from_file, breccia_model_warnings(m));
      breccia_model_destroy(&m);
    }
  for (int k = 0; k < 3; ++k) remove(files[k]);
}

/** There is no warning of layers between blocks whose bonds break. */
static void blocks_that_break_bridge_nothing(void **state)
{
  (void)state;
  breccia_model *m = strip_of(SOLID, MAZARS, 1, 3, "formulation: correspondence, horizon: 2.015 spacings", 1e-9,
                              "failure: {critical stretch: 1e-3, near grips: hold}\n");
  assert_null(strstr(breccia_model_warnings(m), "is a layer of"));
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(thin_layers_fail_at_their_strength),
      cmocka_unit_test(soft_layers_carry_their_strength_between_stiff_blocks),
      cmocka_unit_test(layers_that_blocks_bridge_are_told),
      cmocka_unit_test(half_a_layer_counts_with_its_image),
      cmocka_unit_test(layers_from_files_are_told),
      cmocka_unit_test(blocks_that_break_bridge_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
