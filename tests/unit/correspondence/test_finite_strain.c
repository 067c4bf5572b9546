/* What the Green-Lagrange strain means for laws that flow: a strip of stretch l, whose law answers its strength s,
 * exerts l s per undeformed area and stands under a true stress of l^2 s, where small strain gives s. Runs and `check`
 * say so. */
#include "support.h"

#define J2 "model: j2, density: 2, Young modulus: 1e6, Poisson ratio: 0.3, yield stress: 100"
#define HOOKE "model: elastic, density: 2, Young modulus: 1e6, Poisson ratio: 0.3"
#define FINITE "formulation: correspondence"
#define SMALL "formulation: correspondence, strain: small"

/** A strip in plane stress, eight particles by six, stretched evenly along x and free across. */
static breccia_model *strip(const char *law, const char *formulation, double strain)
{
  return model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {%s}}\n"
                  "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: "
                  "[8, 6]}}}}\nperidynamics: {space: plane stress, %s}\n"
                  "loads: [{on: {all: yes}, field: {displacement: ['%.17g * x', free]}, history: {ramp to: 1}},\n"
                  "        {on: {nearest: [0.035, 0.025]}, displacement: [free, 0]}]\n"
                  "solve: {static: {increments: 20}}\nresults: {number: 1}\npictures: []\n",
                  law, formulation, strain);
}

/** Runs a strip to its end. @return the last words of the run */
static const char *run_strip(breccia_model *m)
{
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  breccia_error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof run, .folder = folder};
  if (breccia_model_run(m, &run, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
  return breccia_model_outcome(m);
}

/** Force along x that one half of a strip exerts on the other. */
static double force_between_halves(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  double force = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[0][i] < 0.04) force += p->internal.row[0][i] * p->volume[i];
  }
  return force;
}

static void forces_on_what_flows_grow_with_the_stretch(void **state)
{
  (void)state;
  const double strains[] = {0.008, 0.05, 0.1, -0.05};
  for (size_t k = 0; k < sizeof strains / sizeof *strains; ++k) {
    breccia_model *small = strip(J2, SMALL, strains[k]), *finite = strip(J2, FINITE, strains[k]);
    run_strip(small);
    run_strip(finite);
    const int32_t middle = small->domain.particles->place_of[20];
    assert_near(small->domain.stress[0][middle], strains[k] > 0 ? 100 : -100, 1e-6);
    assert_near(finite->domain.stress[0][middle], strains[k] > 0 ? 100 : -100, 1e-6);
    assert_near(force_between_halves(finite) / force_between_halves(small), 1 + strains[k], 1e-6);
    breccia_model_destroy(&small);
    breccia_model_destroy(&finite);
  }
}

static void runs_say_what_the_measure_means(void **state)
{
  (void)state;
  const struct {
    const char *law, *formulation;
    double strain;
    const char *words; /* NULL: there is no warning */
  } cases[] = {
      {J2, FINITE, 0.06,
       "Green-Lagrange strains from -0.0|to 0.0618: forces on what flows are 6 % larger than with small strain, true "
       "stresses 12 %; take 'strain: small'"},
      {J2, FINITE, -0.06, "strains from -0.0582 to 0.0|forces on what flows are 6 % smaller|true stresses 12 %"},
      {J2, "formulation: hybrid", 0.06, "to 0.0618: forces on what flows are 6 % larger"},
      {J2, FINITE, 0.021, "to 0.0212: forces on what flows are 2.1 % larger|true stresses 4.2 %"},
      {J2, FINITE, 0.019, NULL},
      {J2, SMALL, 0.05, NULL},
      {J2, "formulation: hybrid, strain: small", 0.05, NULL},
      {J2, "formulation: ordinary", 0.05, NULL}, /* its bonds are longer or shorter, whatever the rotation */
      {HOOKE, FINITE, 0.05, NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = strip(cases[k].law, cases[k].formulation, cases[k].strain);
    const char *words = run_strip(m);
    if (cases[k].words)
      holds_words(words, cases[k].words);
    else if (strstr(words, "Green-Lagrange"))
      fail_msg("%s, %g: %s", cases[k].formulation, cases[k].strain, words);
    breccia_model_destroy(&m);
  }
}

/** Strains of what carries next to nothing, as in a crack that is open, are left out. */
static void open_cracks_are_not_told(void **state)
{
  (void)state;
  breccia_model *m = strip("model: mazars, density: 2.4, Young modulus: 30e6, Poisson ratio: 0.2, tensile strength: "
                           "3e3, fracture energy: 0.1",
                           FINITE, 0.05);
  const char *words = run_strip(m);
  if (strstr(words, "Green-Lagrange")) fail_msg("%s", words);
  breccia_model_destroy(&m);
}

/** A strip between two grips, before anything is computed. */
static void checks_say_what_the_measure_means(void **state)
{
  (void)state;
  const struct {
    const char *law, *formulation, *loads, *words;
  } cases[] = {
      {J2, FINITE, "{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [4.2 mm, free]}",
       "displacement: prescribed motions strain the body by 6 % in the mean, and material 'm' flows or softens: with "
       "'strain: green-lagrange' forces on what flows are 6 % larger than with small strain, true stresses 12 %"},
      {J2, FINITE, "{on: {face: x-}, displacement: [4.2 mm, 0]}, {on: {face: x+}, displacement: [0, free]}",
       "strain the body by 6 %|forces on what flows are 6 % smaller|true stresses 12 %"},
      {J2, FINITE, "{on: {face: y-}, displacement: [0, 0]}, {on: {face: y+}, displacement: [5 mm, 0]}", "by 5 % in"},
      {J2, FINITE, "{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [1.3 mm, free]}", NULL},
      {J2, FINITE, "{on: {face: x-}, displacement: [9 mm, 0]}, {on: {face: x+}, displacement: [9 mm, free]}", NULL},
      {J2, FINITE, "{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [free, 9 mm]}",
       "by 6.4 % in"},
      {J2, FINITE,
       "{on: {nearest: [0.045, 0.035]}, displacement: [0, 0]}, {on: {nearest: [0.055, 0.035]}, "
       "displacement: [1 mm, 0]}",
       NULL},
      {J2, SMALL, "{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [4.2 mm, free]}", NULL},
      {HOOKE, FINITE, "{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [4.2 mm, free]}", NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {%s}}\n"
                                "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: "
                                "{particles: [8, 6]}}}}\nperidynamics: {space: plane strain, %s}\nloads: [%s]\n"
                                "solve: {static: {increments: 2}}\n",
                                cases[k].law, cases[k].formulation, cases[k].loads);
    const char *words = breccia_model_warnings(m);
    if (cases[k].words)
      holds_words(words, cases[k].words);
    else if (strstr(words, "strain the body"))
      fail_msg("%s: %s", cases[k].loads, words);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_on_what_flows_grow_with_the_stretch), cmocka_unit_test(runs_say_what_the_measure_means),
      cmocka_unit_test(open_cracks_are_not_told), cmocka_unit_test(checks_say_what_the_measure_means)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
