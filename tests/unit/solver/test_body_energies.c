/* Energies are those of the body itself: halves and quarters on planes of symmetry have a half and a quarter of the whole's, and one period of a body
 * half of two. */
#include "support.h"

#define ELASTIC "model: elastic, Young modulus: 1e4, Poisson ratio: 0.25, density: 2"
#define FIBRES "model: elastic-1d, Young modulus: 1e4, density: 2"
#define PLASTIC "model: j2, Young modulus: 1e4, Poisson ratio: 0.25, density: 2, yield stress: 20"

static breccia_model *plate(const char *material, double left, double low, const char *peridynamics, const char *loads,
                            const char *solver)
{
  breccia_model *m =
      model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {%s}}\n"
               "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {from: [%g, %g], to: "
               "[0.8, 0.5]}}}}\n"
               "peridynamics: {space: plane stress, horizon: 2.015 spacings, %s}\n"
               "loads: [%s]\nsolve: {%s}\n",
               material, left, low, peridynamics, loads, solver);
  return m;
}

static Energy energy_at_end(breccia_model *m, double tolerance)
{
  while (!solver_is_done(&m->solver)) step_surely(m, 1);
  assert_balanced(m, tolerance);
  const Energy e = solver_energy(&m->solver);
  breccia_model_destroy(&m);
  return e;
}

/** Fails unless all energies of the one are a share of the other's. */
static void assert_share(const Energy *part, const Energy *whole, double share, double tolerance)
{
  const struct {
    const char *name;
    double part, whole;
  } all[] = {
      {"kinetic", part->kinetic, whole->kinetic},       {"internal", part->internal, whole->internal},
      {"stored", part->stored, whole->stored},          {"dissipated", part->dissipated, whole->dissipated},
      {"external", part->external, whole->external},    {"damping", part->damping, whole->damping},
      {"fracture", part->fracture, whole->fracture},    {"friction", part->friction, whole->friction},
      {"numerical", part->numerical, whole->numerical}, {"between", part->between, whole->between},
  };
  const double most = fmax(fabs(whole->external), fabs(whole->internal) + fabs(whole->kinetic));
  assert_true(most > 1e-6);
  for (size_t k = 0; k < sizeof all / sizeof *all; ++k)
    assert_near_at(all[k].part / most, share * all[k].whole / most, tolerance, all[k].name, __FILE__, __LINE__);
}

#define LEFT "{on: {face: x-}, support: {held: across}}, "
#define LOW "{on: {face: y-}, support: {held: across}}, "

static void halves_and_quarters_in_motion_have_their_share(void **state)
{
  (void)state;
  static const struct {
    const char *material, *peridynamics, *solver;
  } cases[] = {
      {ELASTIC, "formulation: hybrid", "explicit: {end time: 0.03, time step: 2e-4, damping: 5}"},
      {PLASTIC, "formulation: hybrid, strain: small", "explicit: {end time: 0.03, time step: 2e-4}"},
      {ELASTIC, "formulation: correspondence", "explicit: {end time: 0.03, time step: 2e-4, damping: 5}"},
      {ELASTIC, "formulation: ordinary", "explicit: {end time: 0.03, time step: 2e-4, stiffness damping: 1e-4}"},
      {FIBRES, "formulation: bond-based", "explicit: {end time: 0.03, time step: 2e-4, damping: 5}"},
      {FIBRES, "formulation: bond-based, surface correction: energy", "explicit: {end time: 0.03, time step: 2e-4}"},
      {PLASTIC, "formulation: correspondence, strain: small", "explicit: {end time: 0.03, time step: 2e-4}"},
      {ELASTIC, "formulation: correspondence",
       "implicit: {end time: 0.03, time step: 1e-3, local error: 1, residual: 1e-12, damping: 5, stiffness damping: "
       "1e-4, scheme: HHT, alpha: -0.1}"},
  };
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    const char *pull = "{on: {face: x+}, traction: [30, 0]}, {on: {face: y+}, traction: [0, 10]}";
    const char *pull_all = "{on: {face: x+}, traction: [30, 0]}, {on: {face: y+}, traction: [0, 10]}, {on: {face: x-}, "
                           "traction: [-30, 0]}, {on: {face: y-}, traction: [0, -10]}";
    char half[400], quarter[400];
    snprintf(half, sizeof half, LEFT "%s, {on: {face: y-}, traction: [0, -10]}", pull);
    snprintf(quarter, sizeof quarter, LEFT LOW "%s", pull);
    const Energy whole =
        energy_at_end(plate(cases[c].material, -0.8, -0.5, cases[c].peridynamics, pull_all, cases[c].solver), 2e-3);
    Energy part = energy_at_end(plate(cases[c].material, 0, -0.5, cases[c].peridynamics, half, cases[c].solver), 2e-3);
    assert_share(&part, &whole, 0.5, 1e-9);
    part = energy_at_end(plate(cases[c].material, 0, 0, cases[c].peridynamics, quarter, cases[c].solver), 2e-3);
    assert_share(&part, &whole, 0.25, 1e-9);
  }
}

static void halves_at_rest_have_half(void **state)
{
  (void)state;
  static const struct {
    const char *material, *peridynamics, *solver;
  } cases[] = {
      {ELASTIC, "formulation: correspondence, strain: small", "static: {increments: 2, residual: 1e-12}"},
      {ELASTIC, "formulation: hybrid, strain: small", "static: {increments: 2, residual: 1e-12}"},
      {PLASTIC, "formulation: correspondence, strain: small", "static: {increments: 4, residual: 1e-11}"},
      {ELASTIC, "formulation: ordinary",
       "static: {increments: 2, method: relaxation, residual: 1e-11, relaxation iterations: 20000}"},
  };
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    const Energy whole =
        energy_at_end(plate(cases[c].material, -0.8, 0, cases[c].peridynamics,
                            LOW "{on: {face: x+}, displacement: [4e-3, 0]}, {on: {face: x-}, displacement: [-4e-3, 0]}",
                            cases[c].solver),
                      1e-3);
    Energy half = energy_at_end(plate(cases[c].material, 0, 0, cases[c].peridynamics,
                                      LEFT LOW "{on: {face: x+}, displacement: [4e-3, 0]}", cases[c].solver),
                                1e-3);
    assert_share(&half, &whole, 0.5, 1e-8);
    /* the other way round: the plane of symmetry moves, and the end rests */
    half = energy_at_end(plate(cases[c].material, 0, 0, cases[c].peridynamics,
                               "{on: {face: x-}, support: {held: across, displacement: [-4e-3, 0]}}, " LOW
                               "{on: {face: x+}, displacement: [0, 0]}",
                               cases[c].solver),
                         1e-3);
    assert_share(&half, &whole, 0.5, 1e-8);
  }
}

/** Bonds across the plane of symmetry break with others; at rest half as many at once. */
static void half_of_what_breaks_is_released_by_a_half(void **state)
{
  (void)state;
  static const struct {
    const char *material, *peridynamics, *solver;
    double tolerance;
  } cases[] = {
      {ELASTIC, "formulation: hybrid", "explicit: {end time: 0.05, time step: 2e-4}", 1e-9},
      {FIBRES, "formulation: bond-based", "explicit: {end time: 0.05, time step: 2e-4}", 1e-9},
      {ELASTIC, "formulation: correspondence", "explicit: {end time: 0.05, time step: 2e-4}", 1e-9},
      {FIBRES, "formulation: bond-based", "static: {increments: 8, residual: 1e-12, bonds at once: ${count}}", 1e-8},
  };
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    Energy e[2];
    for (int k = 0; k < 2; ++k) {
      char loads[500];
      snprintf(loads, sizeof loads,
               "%s {on: {face: x+, layers: 2}, displacement: [8e-3, 0], history: {ramp to: 0.05}}%s",
               k ? LEFT LOW : LOW,
               k ? "" : ", {on: {face: x-, layers: 2}, displacement: [-8e-3, 0], history: {ramp to: 0.05}}");
      char solver[300]; /* a weak place in the middle */
      snprintf(solver, sizeof solver,
               "%s}\nvariables: {count: %d}\ncracks: [{cut: {line: [[0, 0.3], [0, 0.7]]}}]\nfailure: {critical "
               "stretch: 8e-3",
               cases[c].solver, k ? 5 : 10);
      e[k] = energy_at_end(plate(cases[c].material, k ? 0 : -0.8, 0, cases[c].peridynamics, loads, solver), 0.05);
    }
    assert_true(e[0].fracture > 1e-3 * e[0].external);
    assert_share(&e[1], &e[0], 0.5, cases[c].tolerance);
  }
}

static void one_period_has_half_of_two(void **state)
{
  (void)state;
  static const char *const solvers[] = {
      "explicit: {end time: 0.03, time step: 2e-4, damping: 3}",
      "implicit: {end time: 0.03, time step: 1e-3, local error: 1, residual: 1e-12, damping: 3}"};
  for (int s = 0; s < 2; ++s) {
    Energy e[2];
    for (int k = 0; k < 2; ++k) {
      breccia_model *m =
          plate(ELASTIC, k ? -0.8 : 0, 0, "formulation: correspondence",
                "{on: {face: x-}, support: {held: periodic}}, {on: {face: y-}, support: {held: all}}", solvers[s]);
      const Particles *p = m->domain.particles;
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        const double angle = 2 * acos(-1) * p->position[0][i] / 0.8, y = p->position[1][i];
        p->velocity.row[0][i] = 0.3 * sin(angle + 0.4) * y;
        p->velocity.row[1][i] = 0.2 * cos(2 * angle) * y;
      }
      e[k] = energy_at_end(m, 2e-3);
    }
    assert_share(&e[0], &e[1], 0.5, 1e-8);
  }
}

/** Images of faces that are held in all directions are no half of a whole: the ledger balances all the same, and so where the face moves. */
static void ledgers_balance_beside_faces_that_are_held(void **state)
{
  (void)state;
  static const char *const faces[] = {"held: all", "held: all, displacement: [-2e-3, 1e-3]",
                                      "held: across, displacement: [-2e-3, 0]"};
  static const char *const formulations[] = {"correspondence, strain: small", "ordinary", "hybrid, strain: small"};
  static const char *const solvers[] = {
      "static: {increments: 2, residual: 1e-12}", "explicit: {end time: 0.03, time step: 2e-4, damping: 3}",
      "implicit: {end time: 0.03, time step: 1e-3, local error: 1, residual: 1e-12, damping: 3}"};
  for (int f = 0; f < 3; ++f)
    for (int k = 0; k < 3; ++k)
      for (int s = 0; s < 3; ++s) {
        char loads[300], formulation[100];
        snprintf(loads, sizeof loads,
                 "{on: {face: x-}, support: {%s}}, " LOW "{on: {face: x+}, traction: [10, 5]}, {on: {face: y+}, "
                 "traction: [0, 8]}",
                 faces[k]);
        snprintf(formulation, sizeof formulation, "formulation: %s", formulations[f]);
        breccia_model *m = plate(ELASTIC, 0, 0, formulation, loads, solvers[s]);
        while (!solver_is_done(&m->solver)) step_surely(m, 1);
        const Energy e = solver_energy(&m->solver); /* ordinary bonds turn, so that works by the trapezium rule err */
        if (!(e.imbalance < (f == 1 ? 5e-3 : 1e-8)))
          fail_msg("%s, %s, %s: imbalance %g", formulation, faces[k], solvers[s], e.imbalance);
        breccia_model_destroy(&m);
      }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(halves_and_quarters_in_motion_have_their_share), cmocka_unit_test(halves_at_rest_have_half),
      cmocka_unit_test(half_of_what_breaks_is_released_by_a_half),      cmocka_unit_test(one_period_has_half_of_two),
      cmocka_unit_test(ledgers_balance_beside_faces_that_are_held),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
