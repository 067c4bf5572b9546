/* Young's modulus of thin bodies that `check` prints, against the strain of these bodies under a given tension. */
#include "support.h"

static const double young = 150, traction = 1e-3;

/** Returns the modulus of a bar five times as long as thick under tension, over that of the deck. */
static double bar_modulus(breccia_model *m, double length)
{
  const Particles *p = m->domain.particles;
  double moved[2] = {0}, distance[2] = {0}, count[2] = {0};
  step_surely(m, 1);
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double x = p->position[0][i] / length;
    const int end = x > 0.3 && x < 0.4 ? 0 : x > 0.6 && x < 0.7 ? 1 : -1;
    if (end < 0) continue;
    moved[end] += p->displacement.row[0][i];
    distance[end] += p->position[0][i];
    ++count[end];
  }
  assert_true(count[0] > 0 && count[1] > 0);
  return traction / young * (distance[1] / count[1] - distance[0] / count[0]) /
         (moved[1] / count[1] - moved[0] / count[0]);
}

/** Bonds and links are missing at surfaces: bars of few rows stretch by up to twice as much as asked. */
static void check_tells_how_soft_bodies_of_bonds_and_links_are(void **state)
{
  (void)state;
  static const struct {
    const char *law, *words;
    int rows, layers; /* layers: 0 in the plane */
  } cases[] = {
      {"elastic-1d", "bond-based", 3, 3},
      {"elastic-1d", "bond-based, calibration: uniaxial", 4, 4},
      {"elastic-1d", "bond-based, space: plane stress", 3, 0},
      {"elastic, Poisson ratio: 0.2", "micropolar", 3, 3},
      {"elastic, Poisson ratio: 0.2", "micropolar, space: plane stress", 2, 0},
      {"elastic, Poisson ratio: 0.1", "micropolar, space: plane strain, horizon: 2.015 spacings", 3, 0},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const int rows = cases[k].rows, layers = cases[k].layers;
    const double length = 10 * rows;
    char *shape =
        layers ? text_format("shape: {box: {particles: [%d, %d, %d]}}", 10 * rows, rows, layers)
               : text_format("lattice: square, thickness: 1, shape: {box: {particles: [%d, %d]}}", 10 * rows, rows);
    const char *zero = layers ? ", 0" : "";
    breccia_model *m =
        model_of("materials: {m: {model: %s, density: 1, Young modulus: %g}}\nperidynamics: {formulation: %s}\n"
                 "body: {b: {material: m, spacing: 1, %s}}\n"
                 "loads:\n  - {on: {face: x-}, support: {held: across}}\n"
                 "  - {on: {nearest: [0, 0%s]}, displacement: [free, 0%s]}\n"
                 "%s  - {on: {face: x+, layers: 2}, traction: [%g, 0%s]}\nsolve: {static: {increments: 1}}\n",
                 cases[k].law, young, cases[k].words, shape, zero, zero,
                 layers ? "  - {on: {nearest: [0, 100, 0]}, displacement: [free, free, 0]}\n" : "", traction, zero);
    free(shape);
    const char *told = strstr(breccia_model_overview(m), "in tension along its length the body is ");
    double percent;
    char which[16];
    if (!told) fail_msg("%s: nothing is told:\n%s", cases[k].words, breccia_model_overview(m));
    assert_int_equal(sscanf(told, "in tension along its length the body is %lf %% %15s than asked", &percent, which),
                     2);
    const double modulus = 1 + (strcmp(which, "softer") ? percent : -percent) / 100, found = bar_modulus(m, length);
    print_message("%s, %d rows: told %.2f, found %.3f\n", cases[k].words, rows, modulus, found);
    assert_true(fabs(found - 1) > 0.03);
    assert_near(modulus / found, 1, 0.05);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(check_tells_how_soft_bodies_of_bonds_and_links_are),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
