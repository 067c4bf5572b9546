/* Damage in tension and in compression in one field: the larger of both, in compression with a minus. */
#include "support.h"

#include "results/fields.h"

static double value_at(const OutputField *field, const Domain *d, int32_t place)
{
  double value = NAN;
  field->value(d, place, &value);
  return value;
}

/** A plate that is pressed until it is crushed splits along its axis first; links of both kinds of damage stand side by side. */
static void a_crushed_plate_shows_both_kinds(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "materials: {concrete: {model: link-damage, density: 2400 kg/m3, Young modulus: 3.605e6 psi, Poisson ratio: 0.2, "
      "tensile stretch: 6.034e-5, tensile ductility: 2, compressive stretch: 6.1875e-4, compressive ductility: 2}}\n"
      "body: {plate: {material: concrete, lattice: hexagonal, spacing: 1 in, thickness: 1 in, shape: {box: {particles: "
      "[8, 25]}}}}\n"
      "peridynamics: {formulation: micropolar, space: plane stress}\n"
      "loads: [{on: {face: y-, layers: 3}, displacement: [free, 0]}, {on: {nearest: [0, 0]}, displacement: [0, free]},"
      " {on: {face: y+, layers: 3}, displacement: [free, -0.8 mm]}]\n"
      "solve: {explicit: {quasi-static: {}}}\n");
  m->threads = 1;
  step_surely(m, 400);
  const Domain *d = &m->domain;
  const OutputField *field = output_field_find("damage by sign");
  const int tensile = history_field_index(&d->materials[0], "tensile damage"),
            compressive = history_field_index(&d->materials[0], "compressive damage");
  int count[2] = {0};
  assert_true(field && field->has_sign && tensile >= 0 && compressive >= 0);
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t i = d->particles->place_of[n];
    const double value = value_at(field, d, i), t = domain_history(d, i, tensile),
                 c = domain_history(d, i, compressive);
    assert_near(fabs(value), fmax(t, c), 0);
    if (value != 0) assert_true((value > 0) == (t >= c));
    count[0] += value > 0;
    count[1] += value < 0;
  }
  print_message("%d particles beside links damaged in tension, %d in compression\n", count[0], count[1]);
  assert_true(count[0] > 5 && count[1] > 5);
  breccia_model_destroy(&m);
}

static void other_laws_show_none(void **state)
{
  (void)state;
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n" SOFT_SOLID
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                              "solve: {explicit: {steps: 1}}\n");
  assert_near(value_at(output_field_find("damage by sign"), &m->domain, m->domain.particles->place_of[7]), 0, 0);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_crushed_plate_shows_both_kinds),
      cmocka_unit_test(other_laws_show_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
