/* Reinforced sections in bending: moments over curvatures beside the integral over fibres, whose stresses are closed forms of the laws. */
#include "support.h"

#include <math.h>
#include <stdlib.h>

#define HEIGHT 0.4
#define WIDTH 0.2
#define YOUNG 30e6
#define POISSON 0.2
#define STRENGTH 2.5e3
#define LENGTH 0.1      /* over which a fracture energy is spread */
#define FRACTURE 0.1    /* kN/m */
#define STEEL_AREA 9e-4 /* 0.16 m below the middle, and a third of it as far above */
#define STEEL_AT 0.16
#define YIELD 5e5
#define YOUNG_STEEL 2e8
#define HARDENING 0.01
enum { FIBRES = 4000 };

typedef double Stress(double strain);

/** Softer than concrete, so that much of the moment is that of bars. */
static double soft(double strain)
{
  return YOUNG / 10 * strain;
}

/** Mazars' law under a single stress: of a tensile strain e the equivalent strain is e, of a compressive one that of both strains across it. */
static double mazars(double strain)
{
  const double first = STRENGTH / YOUNG, largest = strain > 0 ? strain : -sqrt(2) * POISSON * strain;
  if (largest <= first) return YOUNG * strain;
  const double steep = 1 / (FRACTURE / (LENGTH * STRENGTH) - first / 2), pressed = 1.2, fast = 1500,
               left = strain > 0 ? first / largest * exp(-steep * (largest - first))
                                 : first * (1 - pressed) / largest + pressed * exp(-fast * (largest - first));
  return left * YOUNG * strain;
}

static double steel(double strain)
{
  const double elastic_stress = YOUNG_STEEL * strain, size = fabs(elastic_stress);
  return size <= YIELD ? elastic_stress : copysign(YIELD + HARDENING * (size - YIELD), strain);
}

typedef struct Resultant {
  double force, moment, tension; /* tension: all that is drawn, to measure errors by */
} Resultant;

/** Of strains middle - curvature y, over the height. */
static Resultant of_fibres(Stress *concrete, double middle, double curvature)
{
  Resultant s = {0};
  for (int k = 0; k < FIBRES; ++k) {
    const double y = HEIGHT * ((k + 0.5) / FIBRES - 0.5),
                 f = concrete(middle - curvature * y) * WIDTH * HEIGHT / FIBRES;
    s.force += f;
    s.moment -= y * f;
    s.tension += fmax(f, 0);
  }
  for (int bar = 0; bar < 2; ++bar) {
    const double y = bar ? STEEL_AT : -STEEL_AT,
                 f = (bar ? STEEL_AREA / 3 : STEEL_AREA) * steel(middle - curvature * y);
    s.force += f;
    s.moment -= y * f;
    s.tension += fmax(f, 0);
  }
  return s;
}

/** The strain in the middle of the height with which no force is left. */
static double balanced(Stress *concrete, double curvature)
{
  double low = -curvature * HEIGHT, high = curvature * HEIGHT;
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    *(of_fibres(concrete, middle, curvature).force > 0 ? &high : &low) = middle;
  }
  return (low + high) / 2;
}

/** What the left half of the body does to the right one. */
static Resultant carried(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  Resultant s = {0};
  for (int64_t i = 0; i < p->places; ++i) {
    const double x = p->position[0][i], y = p->position[1][i], volume = p->volume[i];
    if (volume == 0 || x < 0) continue;
    s.force -= p->internal.row[0][i] * volume;
    s.moment += (y * p->internal.row[0][i] - x * p->internal.row[1][i]) * volume;
    if (p->space.rows > 3) s.moment -= p->internal.row[p->space.rotation][i] * volume; /* of links that are bent */
  }
  return s;
}

/** A piece of a beam in the plane, twice `half` long. */
static breccia_model *bent(const char *concrete, double young, const char *peridynamics, int rows, double half,
                           const char *loads)
{
  const double spacing = HEIGHT / rows;
  return model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n  concrete: {%s, density: 2.4, Young modulus: %g}\n"
      "  steel: {model: steel-bilinear, density: 7.85, Young modulus: %g, yield stress: %g, hardening "
      "ratio: %g}\n"
      "body: {beam: {material: concrete, lattice: square, spacing: %.17g, thickness: %g, shape: {box: {from: "
      "[%.17g, %g], to: [%.17g, %g]}}}}\n"
      "bars: {low: {points: [[%.17g, %g], [%.17g, %g]], area: %g, material: steel},\n"
      "       high: {points: [[%.17g, %g], [%.17g, %g]], area: %g, material: steel}}\n"
      "peridynamics: {%s, space: plane stress}\n"
      "loads: [%s]\n"
      "solve: {static: {increments: 2, end time: 1}}\npictures: []\n",
      concrete, young, YOUNG_STEEL, YIELD, HARDENING, spacing, WIDTH, -half, -HEIGHT / 2, half, HEIGHT / 2, -half,
      -STEEL_AT, half, -STEEL_AT, STEEL_AREA, -half, STEEL_AT, half, STEEL_AT, STEEL_AREA / 3, peridynamics, loads);
}

/** Runs a body to its end and compares what its middle carries. */
static void assert_carries_what_fibres_do(breccia_model *m, const char *way, Stress *concrete, double middle,
                                          double curvature)
{
  step_surely(m, INT64_MAX);
  const Resultant found = carried(m), right = of_fibres(concrete, middle, curvature);
  print_message("%s, curvature %g 1/m: moment %.4g kN m, %+.2f %% beside fibres; force %+.2f %% of the tension\n", way,
                curvature, found.moment, 100 * (found.moment / right.moment - 1), 100 * found.force / right.tension);
  assert_near(found.moment, right.moment, 0.03 * right.moment);
  assert_near(found.force, 0, 0.04 * right.tension); /* what is pressed in the end is a few rows deep */
  breccia_model_destroy(&m);
}

/** Concrete that cracks and is crushed, bars that yield: whole, cracked, with bars that are about to yield, and far beyond. */
static void moments_of_cracked_sections_are_those_of_fibres(void **state)
{
  (void)state;
  static const char *const ways[] = {"formulation: correspondence, horizon: 2.015 spacings",
                                     "formulation: hybrid, horizon: 1.5 spacings"};
  static const double curvatures[] = {4e-4, 3e-3, 8e-3, 3e-2, 6e-2};
  for (int way = 0; way < 2; ++way)
    for (int k = 0; k < 5; ++k) {
      const double c = curvatures[k], middle = balanced(mazars, c);
      char loads[400];
      snprintf(loads, sizeof loads,
               "{on: {all: yes}, field: {displacement: ['%.12g*x - %.12g*x*y/1 m', '-0.2*(%.12g*y - %.12g*y*y/2 m) + "
               "%.12g*x*x/2 m']}, history: {ramp to: 1}}",
               middle, c, middle, c, c);
      assert_carries_what_fibres_do(
          bent("model: mazars, Poisson ratio: 0.2, tensile strength: 2500, fracture energy: 0.1, length: 0.1", YOUNG,
               ways[way], 32, 0.15, loads),
          ways[way], mazars, middle, c);
    }
}

/** Bars in a soft elastic body, as they are elastic and as they yield, moved at both ends only. */
static void moments_of_bodies_bent_by_their_ends_are_those_of_fibres(void **state)
{
  (void)state;
  static const struct {
    const char *concrete, *way;
    int rows;
  } cases[] = {{"model: elastic-1d", "formulation: bond-based, surface correction: energy", 24},
               {"model: elastic, Poisson ratio: 0.2", "formulation: micropolar", 16},
               {"model: elastic, Poisson ratio: 0.2", "formulation: correspondence, horizon: 2.015 spacings", 16},
               {"model: elastic, Poisson ratio: 0.2", "formulation: hybrid, horizon: 1.5 spacings", 16}};
  static const double curvatures[] = {8e-3, 4e-2};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
    for (int n = 0; n < 2; ++n) {
      const double c = curvatures[n], middle = balanced(soft, c);
      char field[200], loads[800];
      snprintf(field, sizeof field, "field: {displacement: ['%.12g*x - %.12g*x*y/1 m', free]}, history: {ramp to: 1}",
               middle, c);
      snprintf(
          loads, sizeof loads,
          "{on: {face: x-, layers: 3}, %s}, {on: {face: x+, layers: 3}, %s}, "
          "{on: {nearest: [-0.4, 0]}, displacement: [free, 0]}, {on: {nearest: [0.4, 0]}, displacement: [free, 0]}",
          field, field);
      assert_carries_what_fibres_do(bent(cases[k].concrete, YOUNG / 10, cases[k].way, cases[k].rows, 0.4, loads),
                                    cases[k].way, soft, middle, c);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(moments_of_cracked_sections_are_those_of_fibres),
                                     cmocka_unit_test(moments_of_bodies_bent_by_their_ends_are_those_of_fibres)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
