/* Ground that settles under its weight by an elastic stage and goes on by its own law, which begins at the stresses of that stage. */
#include "support.h"

#define SPACING 0.25
#define HEIGHT 4.0
#define WEIGHT (2 * 9.81)
#define STRENGTH 40.0 /* octahedral */
#define BULK 1.5e5
#define SHEAR 6e4

/** A wide column that nothing leaves sideways, of clay that hardens from the first on. */
static breccia_model *column(double strength, const char *first, const char *last)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials: {soil: {model: multi-yield-j2, density: 2, shear modulus: %g, bulk modulus: %g, "
                  "octahedral strength: %g, peak octahedral strain: 3e-3}}\n"
                  "body: {b: {material: soil, lattice: square, spacing: %g, thickness: 1, shape: {box: {from: [0, 0], "
                  "to: [3, %g]}}}}\n"
                  "peridynamics: {formulation: correspondence, space: plane strain}\n"
                  "loads:\n"
                  "  - {on: {face: x-}, support: {held: across}}\n"
                  "  - {on: {face: x+}, support: {held: across}}\n"
                  "  - {on: {face: y-}, support: {held: across}}\n"
                  "  - {gravity: [0, -9.81]}\n"
                  "solve:\n"
                  "  - {name: weight, %sstatic: {increments: 1}}\n%s",
                  SHEAR, BULK, strength, SPACING, HEIGHT, first, last);
}

/** Mean stress component of the particles inside whose depth below the top is about that of the middle. */
static double stress_at_middle(const breccia_model *m, int component)
{
  const Domain *d = &m->domain;
  double sum = 0;
  int count = 0;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t i = d->particles->place_of[n];
    if (body_outside(&d->body, n) || fabs(d->particles->position[1][i] - HEIGHT / 2) > 0.6 * SPACING) continue;
    sum += d->stress[component][i];
    ++count;
  }
  return sum / count;
}

/** A stage by the law that follows changes nothing where the law bears these stresses without yielding further: as in OpenSees, the yield surfaces
 *  are moved to where the stress is. With nothing to harden in, one that begins by the law alone has settled more. */
static void stresses_of_the_elastic_stage_stay(void **state)
{
  (void)state;
  breccia_model *m = column(STRENGTH, "laws: elastic, ", "  - {name: clay, static: {increments: 2}}\n");
  const Particles *p = m->domain.particles;
  step_surely(m, 1);
  double *settled = calloc((size_t)p->places, sizeof *settled), vertical = stress_at_middle(m, 1), most = 0;
  assert_non_null(settled);
  memcpy(settled, p->displacement.row[1], (size_t)p->places * sizeof *settled);
  assert_near(vertical, -WEIGHT * HEIGHT / 2, 0.01 * WEIGHT * HEIGHT / 2);
  const double poisson = (3 * BULK - 2 * SHEAR) / (2 * (3 * BULK + SHEAR));
  assert_near(stress_at_middle(m, 0), vertical * poisson / (1 - poisson), 0.01 * fabs(vertical));
  step_surely(m, INT64_MAX);
  for (int64_t i = 0; i < p->places; ++i) most = larger_of(most, fabs(settled[i]));
  for (int64_t i = 0; i < p->places; ++i) assert_near(p->displacement.row[1][i], settled[i], 1e-9 * most);
  assert_near(stress_at_middle(m, 1), vertical, 1e-9 * fabs(vertical));
  breccia_model *at_once = column(STRENGTH, "", "");
  step_surely(at_once, INT64_MAX);
  double more = 0;
  for (int64_t i = 0; i < p->places; ++i)
    more = larger_of(more, fabs(at_once->domain.particles->displacement.row[1][i]));
  print_message("settled by %.4g m elastically, by %.4g m by the law\n", most, more);
  assert_true(more > 1.02 * most);
  free(settled);
  breccia_model_destroy(&at_once);
  breccia_model_destroy(&m);
}

/** Pressed from above, the column flows where the law's strength is reached: its octahedral shear stress, sqrt(2) / 3 of the difference of the vertical
 *  and both horizontal stresses, stays there, whatever the stage before. */
static void the_law_goes_on_from_there_to_its_strength(void **state)
{
  (void)state;
  const double pressure = 800;
  breccia_model *m = column(STRENGTH, "laws: elastic, ",
                            "  - {name: press, displacements: zero, static: {increments: 20, iterations: 30},\n"
                            "     loads: [{on: {face: y+}, pressure: 800, history: {ramp to: 1}}]}\n");
  step_surely(m, INT64_MAX);
  double s[6], mean = 0, square = 0;
  for (int k = 0; k < 6; ++k) s[k] = stress_at_middle(m, k);
  for (int k = 0; k < 3; ++k) mean += s[k] / 3;
  for (int k = 0; k < 3; ++k) square += (s[k] - mean) * (s[k] - mean);
  print_message("vertical %.5g kPa, octahedral %.5g kPa\n", s[1], sqrt(square / 3));
  assert_near(s[1], -pressure - WEIGHT * HEIGHT / 2, 0.01 * pressure);
  assert_near(sqrt(square / 3), STRENGTH, 0.02 * STRENGTH);
  breccia_model_destroy(&m);
}

/** Where the law cannot bear the stresses of the elastic stage they are redistributed: none is beyond the strength, and the weight is borne. */
static void what_is_beyond_the_strength_is_redistributed(void **state)
{
  (void)state;
  const double strength = 8; /* half of what the elastic column has at its foot */
  breccia_model *m = column(strength, "laws: elastic, ", "  - {name: clay, static: {increments: 2, iterations: 30}}\n");
  const Domain *d = &m->domain;
  double most[2] = {0};
  for (int stage = 0; stage < 2; ++stage) {
    step_surely(m, stage ? INT64_MAX : 1);
    for (int64_t n = 0; n < d->particles->count; ++n) {
      const int32_t i = d->particles->place_of[n];
      const double *s[6] = {d->stress[0], d->stress[1], d->stress[2], d->stress[3], d->stress[4], d->stress[5]};
      const double mean = (s[0][i] + s[1][i] + s[2][i]) / 3;
      double square = 0;
      for (int k = 0; k < 3; ++k) square += (s[k][i] - mean) * (s[k][i] - mean) + 2 * s[k + 3][i] * s[k + 3][i];
      if (!body_outside(&d->body, n)) most[stage] = larger_of(most[stage], sqrt(square / 3));
    }
  }
  print_message("octahedral shear stress at most %.4g, then %.4g kPa\n", most[0], most[1]);
  assert_true(most[0] > 1.5 * strength);
  assert_true(most[1] <= strength * (1 + 1e-6));
  assert_near(stress_at_middle(m, 1), -WEIGHT * HEIGHT / 2, 0.01 * WEIGHT * HEIGHT / 2);
  assert_balanced(m, 0.02);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stresses_of_the_elastic_stage_stay),
      cmocka_unit_test(the_law_goes_on_from_there_to_its_strength),
      cmocka_unit_test(what_is_beyond_the_strength_is_redistributed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
