/* Hybrid bodies at rest: relaxation beside Newton's method for both forms, stresses kept from a first stage, and limits of bonds in closed form. */
#include "base/tensor.h"
#include "formulation/hybrid.h"
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"

/** A cantilever in both forms, elastic and yielding: pairwise stiffness is not symmetric, and relaxation finds the same rest all the same. */
static void relaxation_finds_the_rest_that_newton_finds(void **state)
{
  (void)state;
  static const char *const laws[] = {"model: elastic", "model: j2, yield stress: 20, hardening modulus: 300"};
  for (int pairwise = 0; pairwise < 2; ++pairwise)
    for (int longer = 0; longer < 2; ++longer)
      for (int k = 0; k < 2; ++k) {
        breccia_model *m[2];
        for (int way = 0; way < 2; ++way) {
          m[way] = model_of(UNITS "materials: {m: {%s, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                                  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: "
                                  "{particles: [20, 6]}}}}\n"
                                  "peridynamics: {space: plane stress, formulation: hybrid, form: %s, horizon: %s "
                                  "spacings, strain: small}\n"
                                  "loads: [{on: {face: x-}, support: {held: all}}, {on: {face: x+}, traction: [2, "
                                  "-1.2]}]\n"
                                  "solve: {static: {increments: 4, residual: 1e-8, method: %s}}\n",
                            laws[k], pairwise ? "pairwise" : "variational", longer ? "2.015" : "1.5",
                            way ? "relaxation" : "newton");
          step_surely(m[way], 4);
        }
        const Particles *a = m[0]->domain.particles, *b = m[1]->domain.particles;
        double most = 0, apart = 0;
        for (int64_t i = 0; i < a->places; ++i) {
          most = larger_of(most, fabs(a->displacement.row[1][i]));
          apart = larger_of(apart, fabs(a->displacement.row[1][i] - b->displacement.row[1][i]));
        }
        assert_true(most > 5e-3); /* 1.2 (2^3 / 3) / (E 0.6^3 / 12) = 0.018 is 1.8e-2 */
        assert_true(apart < 1e-5 * most);
        breccia_model_destroy(&m[0]);
        breccia_model_destroy(&m[1]);
      }
}

/** Ground of hybrid bonds gets its stresses in an elastic first stage under its weight: gamma d nu / (1 - nu) to the sides, gamma d / M of strain, exact away from
 *  rows next to the base, whose image strains the other way. From there displacements count from zero, nothing moves any more, and what is put on top settles by p H / M. */
static void ground_keeps_the_stresses_of_its_first_stage(void **state)
{
  (void)state;
  static const char *const second[] = {"static: {increments: 2}", "static: {increments: 2, method: relaxation}",
                                       "explicit: {steps: 300%s}", "implicit: {end time: 0.05, time step: 0.01%s}"};
  const double weight = 20, height = 4, modulus = 1e4 * 0.6 / (1.4 * 0.2), share = 0.4 / 0.6, load = 5;
  for (int pairwise = 0; pairwise < 2; ++pairwise)
    for (size_t k = 0; k < sizeof second / sizeof *second; ++k)
      for (int loaded = 0; loaded < (k ? 1 : 2); ++loaded) {
        char stage[120];
        snprintf(stage, sizeof stage, second[k], pairwise ? ", stiffness damping: 1e-4" : "");
        breccia_model *m = model_of(
            UNITS "materials: {m: {model: drucker-prager, cohesion: 20, friction angle: 30 deg, density: 2, Young "
                  "modulus: 1e4, Poisson ratio: 0.4}}\n"
                  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [6, "
                  "40]}}}}\n"
                  "peridynamics: {space: plane strain, formulation: hybrid, form: %s, strain: small, horizon: 1.5 "
                  "spacings}\n"
                  "loads: [{gravity: [0, -10]}, {on: {face: x-}, support: {held: periodic}}, {on: {face: y-}, support: "
                  "{held: all}}]\n"
                  "solve: [{laws: elastic, static: {increments: 1, residual: 1e-12}},\n"
                  "        {displacements: zero%s, %s}]\n",
            pairwise ? "pairwise" : "variational", loaded ? ", loads: [{on: {face: y+}, pressure: 5}]" : "", stage);
        const Domain *d = &m->domain;
        const Particles *p = d->particles;
        step_surely(m, 1);
        const Energy begun = solver_energy(&m->solver);
        assert_near(begun.external, begun.stored,
                    (pairwise ? 1e-3 : 1e-9) * begun.stored); /* pairwise forces have no energy */
        while (!solver_is_done(&m->solver)) step_surely(m, 1);
        double moved = 0;
        for (int64_t n = 0; n < p->count; ++n) {
          const int32_t i = p->place_of[n];
          if (body_outside(&d->body, n)) continue;
          const double depth = height - p->position[1][i], settled = loaded ? load * p->position[1][i] / modulus : 0;
          moved = larger_of(moved, fabs(particles_moved(p, 1, i) + settled));
          moved = larger_of(moved, fabs(particles_moved(p, 0, i)));
          if (depth < 1.3 || depth > height - 1.3) continue; /* beside faces bonds see other depths */
          const double within = (loaded ? 1e-6 : 1e-8) * weight * height,
                       vertical = -weight * depth - (loaded ? load : 0);
          double strain[6], stress[6];
          domain_look(d, i, strain, stress);
          assert_near(stress[YY], vertical, within);
          assert_near(stress[XX], share * vertical, within);
          assert_near(stress[ZZ], share * vertical, within);
        }
        assert_true(moved < (loaded ? 1e-6 : 1e-8) * weight * height * height / (2 * modulus));
        const Energy e = solver_energy(&m->solver);
        assert_near(e.external, e.stored, (pairwise ? 1e-3 : 1e-6) * e.stored);
        assert_true(e.kinetic < 1e-12 * e.stored);
        breccia_model_destroy(&m);
      }
}

/** A bond inside of the lattice from a particle by this many columns and rows. */
static bool exceeds(breccia_model *m, int columns, int rows)
{
  const Domain *d = &m->domain;
  const Particles *p = d->particles;
  const int32_t a = particles_nearest(p, (const double[3]){0.55, 0.55, 0}),
                b = particles_nearest(p, (const double[3]){0.55 + 0.1 * columns, 0.55 + 0.1 * rows, 0});
  const int64_t slot = family_slot(&d->family, a, b);
  const Bond bond = family_bond(&d->family, a / SLICE, slot, a % SLICE);
  return d->failure.criterion->exceeds(&d->failure, &d->family, a / SLICE, slot, &bond, a % SLICE);
}

/** Even strain without a Poisson ratio, at 0.99 and 1.01 of what theory gives for one bond: its stretch is eps cos^2 + gamma sin cos, across its section are E eps cos^2
 *  and along it E eps sin cos, and with it goes the energy of its point, sigma : eps over two times V_b: V_b is V / (2
 *  + 2 sqrt 2) along an axis and sqrt 2 times that on the diagonal. Bonds that have not become longer never break. */
static void bonds_have_the_limits_of_closed_forms(void **state)
{
  (void)state;
  enum { PULL, SHEAR };
  const double young = 1e4, limit = 1e-5, part = 1 / (2 + 2 * sqrt(2)), volume = 0.01 * 0.3;
  static const struct {
    const char *criterion;
    int columns, rows, way;
    double strain; /* at which it breaks, over the limit; energies: over its root */
  } of[] = {{"critical stretch: 1e-5", 1, 0, PULL, 1},
            {"critical stretch: 1e-5", 1, 1, PULL, 2},
            {"critical stretch: 1e-5", 1, 1, SHEAR, 2},
            {"criterion: critical bond stress, bond tensile strength: 0.1", 1, 0, PULL, 1},
            {"criterion: critical bond stress, bond tensile strength: 0.1", 1, 1, PULL, 2},
            {"criterion: critical bond stress, bond tensile strength: 0.1", 1, 1, SHEAR, 2},
            {"criterion: critical bond stress, bond tensile strength: 9, bond shear strength: 0.1", 1, 1, PULL, 2},
            {"criterion: critical bond energy, bond energy: %g", 1, 0, PULL, 0},
            {"criterion: critical bond energy, bond energy: %g", 1, 1, PULL, 0}};
  for (int pairwise = 0; pairwise < 2; ++pairwise)
    for (size_t k = 0; k < sizeof of / sizeof *of; ++k)
      for (int above = 0; above < 2; ++above) {
        const bool by_energy = of[k].strain == 0;
        if (by_energy && !pairwise) continue; /* other points lose a member with it */
        /* w_c V^2 is (1/2) E limit^2 V_b of a bond along an axis */
        const double held = young * limit * limit * part / 2 / volume;
        char criterion[160];
        snprintf(criterion, sizeof criterion, of[k].criterion, held);
        breccia_model *m = model_of(
            UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0}}\n"
                  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: "
                  "[12, 12]}}}}\n"
                  "peridynamics: {formulation: hybrid, form: %s, space: plane strain, horizon: 1.5 spacings}\n"
                  "failure: {%s}\n"
                  "solve: {%s}\n",
            pairwise ? "pairwise" : "variational", criterion,
            pairwise ? "static: {increments: 1}}\nloads: [{on: {face: x-}, displacement: [0, 0]}]\nwatch: {"
                     : "explicit: {steps: 1, time step: 1e-9}");
        const double strain =
            (above ? 1.01 : 0.99) * limit * (by_energy ? of[k].rows ? sqrt(sqrt(0.5)) : 1 : of[k].strain);
        const double f[9] = {of[k].way == PULL ? 1 + strain : 1, of[k].way == SHEAR ? strain : 0, 0, 0, 1, 0, 0, 0, 1};
        deform_uniformly(m, f);
        compute_forces(m);
        if (exceeds(m, of[k].columns, of[k].rows) != (above == 1))
          fail_msg("%s, %s, bond [%d, %d]: %s at %g", pairwise ? "pairwise" : "variational", criterion, of[k].columns,
                   of[k].rows, above ? "holds" : "breaks", strain);
        breccia_model_destroy(&m);
      }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(relaxation_finds_the_rest_that_newton_finds),
      cmocka_unit_test(ground_keeps_the_stresses_of_its_first_stage),
      cmocka_unit_test(bonds_have_the_limits_of_closed_forms),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
