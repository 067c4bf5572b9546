/* What bodies do does not depend on the units in which their decks count: neither how far, nor in how many steps, nor by what way. */
#include "support.h"

/** Units of a deck, and one of each in SI. */
static const struct {
  const char *words;
  double length, force, time;
} units[] = {{"length: m, force: kN, time: s", 1, 1e3, 1},
             {"length: mm, force: N, time: ms", 1e-3, 1, 1e-3},
             {"length: km, force: GN, time: h", 1e3, 1e9, 3600}};
enum { UNITS = sizeof units / sizeof *units };

#define SOFT "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 10 MPa, Poisson ratio: 0.25}}\n"
#define CONCRETE "density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2"
#define PLATE(particles, spacing)                                                                                      \
  "body: {b: {material: m, lattice: square, spacing: " spacing ", thickness: 0.2 m, shape: {box: {particles: "         \
  "[" particles "]}}}}\n"

static const struct Case {
  const char *name, *deck;
  double tolerance; /* of what is compared: looser where iterations end by a tolerance */
} cases[] = {
    {"struck plate of ordinary bonds",
     SOFT PLATE(
         "16, 10",
         "0.1 m") "peridynamics: {formulation: ordinary, space: plane strain}\n"
                  "cracks: [{cut: {line: [[-1 m, 0.5 m], [0.4 m, 0.5 m]]}}]\nfailure: {fracture energy: 300 J/m2}\n"
                  "loads: [{on: {face: y+, layers: 2}, velocity: [free, 0.5 m/s], history: {ramp to: 2 ms}},\n"
                  "        {on: {face: y-, layers: 2}, velocity: [free, -0.3 m/s], history: {ramp to: 2 ms}}]\n"
                  "solve: {explicit: {end time: 0.05 s, damping: {ratio: 0.02, at: 20 Hz}}}\n",
     1e-6},
    {"ordinary bonds that yield, damped by stiffness",
     "materials: {m: {model: j2, density: 2 t/m3, Young modulus: 10 MPa, Poisson ratio: 0.25, yield stress: 20 "
     "kPa}}\n" PLATE("12, 8",
                     "0.1 m") "peridynamics: {formulation: ordinary, space: plane strain, horizon: 2.015 spacings}\n"
                              "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+}, traction: "
                              "[18 kPa, 9 kPa], history: "
                              "{sine: {frequency: 11 Hz, phase: 30 deg}}}]\n"
                              "solve: {explicit: {end time: 0.1 s, stiffness damping: 0.2 ms}}\n",
     1e-6},
    {"fibres with critical energies, in steps by their error",
     "materials: {m: {model: elastic-1d, density: 2 t/m3, Young modulus: 10 MPa}}\n" PLATE(
         "12, 8",
         "0.1 m") "peridynamics: {formulation: bond-based, space: plane stress, horizon: 2.015 spacings, surface "
                  "correction: "
                  "energy}\n"
                  "failure: {criterion: critical bond energy, fracture energy: 500 J/m2}\n"
                  "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 2}, velocity: "
                  "[0.4 m/s, "
                  "free], history: {ramp to: 50 ms}}]\n"
                  "solve: {implicit: {end time: 0.12 s, time step: 10 ms, local error: 1e-3, residual: 1e-10}}\n",
     1e-5},
    {"a block that swings, in steps by their error",
     SOFT "body: {b: {material: m, spacing: 0.1 m, shape: {box: {particles: [5, 4, 6]}}}}\n"
          "peridynamics: {horizon: 1.5 spacings}\n"
          "loads: [{on: {face: z-}, displacement: [0, 0, 0]}, {on: {face: z+}, force: [100 N, 0, 0], history: {sine: "
          "{frequency: 7 Hz}}}]\n"
          "solve: {implicit: {end time: 0.2 s, local error: 2e-3, scheme: HHT, residual: 1e-10, Rayleigh damping: "
          "{ratio: 0.03, from: 4 Hz, to: 20 Hz}}}\n",
     1e-6},
    {"concrete whose control of zero-energy modes fades, at rest",
     "materials: {m: {model: mazars, " CONCRETE ", tensile strength: 3 MPa, fracture energy: 100 N/m}}\n" PLATE(
         "12, 5", "0.01 m") "peridynamics: {space: plane strain}\n"
                            "cracks: [{cut: {line: [[60 mm, -1 m], [60 mm, 11 mm]]}}]\n"
                            "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {on: {face: x+, layers: 3}, "
                            "displacement: [0.05 mm, 0], history: {ramp to: 1 s}}]\n"
                            "solve: {static: {end time: 1 s, increments: 8}}\n",
     1e-4},
    {"links that are damaged, at rest",
     "materials: {m: {model: link-damage, " CONCRETE ", tensile stretch: 1e-4, fracture energy: 100 N/m}}\n" PLATE(
         "10, 6", "0.02 m") "peridynamics: {formulation: micropolar, space: plane stress}\n"
                            "loads: [{on: {face: x-}, displacement: [0, 0]}, {on: {face: x-}, rotation: [0, 0, 0]}, "
                            "{on: {face: x+}, "
                            "displacement: [free, -0.2 mm], history: {ramp to: 1 s}}]\n"
                            "solve: {static: {end time: 1 s, increments: 10, residual: 1e-9}}\n",
     1e-4},
    {"links that swing",
     "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 10 MPa, Poisson ratio: 0.2}}\n"
     "body: {b: {material: m, spacing: 0.1 m, shape: {box: {particles: [7, 3, 2]}}}}\n"
     "peridynamics: {formulation: micropolar}\n"
     "loads: [{on: {face: x-}, displacement: [0, 0, 0]}, {on: {face: x-}, rotation: [0, 0, 0]}, {on: {face: x+}, "
     "moment: [2 N*m, 0, 5 N*m]}]\n"
     "solve: {implicit: {end time: 0.2 s, local error: 2e-3, residual: 1e-10}}\n",
     1e-6},
    {"hybrid bonds that yield, with springs, ties and a roller",
     "materials: {m: {model: drucker-prager, density: 2 t/m3, Young modulus: 10 MPa, Poisson ratio: 0.3, cohesion: 10 "
     "kPa, friction angle: 20 deg}}\n" PLATE(
         "9, 7", "0.1 m") "peridynamics: {formulation: hybrid, space: plane strain}\n"
                          "loads: [{on: {face: y-}, spring: {stiffness: 3 MN/m}}, {on: {face: x-}, roller: [1, 0]}, "
                          "{on: {face: x+}, tie: "
                          "{directions: x}}, {gravity: [0, -9.81 m/s2]},\n"
                          "        {on: {inside: {box: {from: [0, 0.6 m], to: [0.35 m, 1 m]}}}, displacement: [free, "
                          "-6 mm], history: {ramp "
                          "to: 1 s}}]\n"
                          "solve: {static: {end time: 1 s, increments: 4, residual: 1e-9}}\n",
     1e-5},
    {"rest by relaxation",
     SOFT PLATE("9, 6", "0.1 m") "peridynamics: {space: plane stress}\n"
                                 "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {gravity: [0, -9.81 "
                                 "m/s2]}]\nsolve: {static: {end time: 1 s, increments: 2, method: relaxation}}\n",
     1e-5},
    {"rest by damped motion",
     SOFT PLATE("9, 6",
                "0.1 m") "peridynamics: {formulation: ordinary, space: plane stress}\n"
                         "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {gravity: [0, -9.81 m/s2]}]\n"
                         "solve: {explicit: {end time: 3 s, damping: {ratio: 1, at: 8 Hz}, rest: 1e-3}}\n",
     1e-6},
    {"bonds that break at rest, in turn",
     SOFT PLATE(
         "12, 8",
         "0.1 m") "peridynamics: {space: plane stress, horizon: 2.015 spacings}\nfailure: {critical stretch: 0.004}\n"
                  "cracks: [{cut: {line: [[0.6 m, -1 m], [0.6 m, 0.3 m]]}}]\n"
                  "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 2}, "
                  "displacement: [2 mm, 0.5 "
                  "mm], history: {ramp to: 1 s}}]\n"
                  "solve: {static: {end time: 1 s, increments: 4, residual: 1e-10, bonds at once: 3}}\n",
     1e-5},
    {"a controlled opening",
     "materials: {m: {model: bilinear-softening, density: 2.4 t/m3, Young modulus: 30 GPa, tensile strength: 3 MPa, "
     "fracture energy: 100 N/m}}\n" PLATE(
         "9, 5", "0.01 m") "peridynamics: {formulation: bond-based, space: plane stress, strength of: bonds}\n"
                           "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {on: "
                           "{face: x+}, traction: [1 MPa, 0], history: "
                           "{controlled: yes}}]\n"
                           "solve: {static: {end time: 1 s, increments: 6, control: {opening "
                           "between: [[5 mm, 25 mm], [85 mm, 25 mm]], to: "
                           "0.004 mm}}}\n",
     1e-4},
    {"blocks that meet with friction",
     "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 10 MPa, Poisson ratio: 0.25}}\n"
     "body:\n"
     "  a: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {from: [0, 0], to: [0.8 m, "
     "0.6 m]}}}\n"
     "  b: {material: m, lattice: square, spacing: 0.08 m, thickness: 0.2 m, shape: {box: {from: [0.83 m, 0.13 m], "
     "to: [1.47 m, 0.61 m]}}}\n"
     "peridynamics: {formulation: ordinary, space: plane stress, horizon: 0.21 m}\ncontact: {friction: 0.3}\n"
     "loads: [{on: {block: a}, initial velocity: {translation: [2 m/s, 0.6 m/s]}}]\n"
     "solve: {explicit: {end time: 0.05 s}}\n",
     1e-6},
    {"waves between dashpots",
     SOFT "body: {b: {material: m, lattice: square, spacing: 0.1 m, thickness: 0.2 m, shape: {box: {particles: [4, "
          "20]}}}}\n"
          "peridynamics: {space: plane strain, horizon: 2.015 spacings}\n"
          "loads: [{on: {face: y-}, dashpots: {outcrop velocity: [0.3 m/s, 0]}, history: {sine: {frequency: 9 Hz, "
          "until: 0.1 s}}}, {on: {face: x-}, support: {held: periodic}}, {on: {face: y+}, pressure: 2 kPa}]\n"
          "solve: {explicit: {end time: 0.15 s}}\n",
     1e-6},
    {"concrete with plastic damage, hit",
     "materials: {m: {model: damage-plasticity, " CONCRETE
     ", tensile strength: 3 MPa, compressive strength: 30 MPa, fracture energy: 100 N/m}}\n" PLATE(
         "12, 5", "0.01 m") "peridynamics: {space: plane stress}\n"
                            "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {on: {face: x+, layers: 3}, "
                            "velocity: [0.1 m/s, "
                            "free], history: {ramp to: 0.2 ms}}]\n"
                            "solve: {explicit: {end time: 1 ms}}\n",
     1e-5},
};

enum { NUMBERS = 24 };

/** What a body has done, in SI: energies, where it is and how fast it moves, over how many steps. */
static int numbers_of(breccia_model *m, int unit, double numbers[NUMBERS], int64_t counts[3])
{
  const double length = units[unit].length, energy = length * units[unit].force, time = units[unit].time;
  const Energy e = solver_energy(&m->solver);
  const Sums sums = sums_of(m);
  const double energies[] = {e.kinetic, e.internal, e.stored,    e.dissipated, e.external,
                             e.damping, e.fracture, e.numerical, e.between,    e.friction};
  int n = 0;
  for (size_t k = 0; k < sizeof energies / sizeof *energies; ++k) numbers[n++] = energies[k] * energy;
  for (int k = 0; k < 3; ++k) numbers[n++] = sums.moved[k] * length;
  for (int k = 0; k < 3; ++k) numbers[n++] = sums.momentum[k] * units[unit].force * time;
  for (int k = 0; k < 3; ++k) numbers[n++] = sums.turn[k] * energy * time;
  numbers[n++] = m->solver.clock.time * time;
  counts[0] = m->solver.clock.step;
  counts[1] = m->domain.broken_count;
  return n;
}

/** Numbers of one kind are compared as shares of the largest of the kind. */
static double largest_of(const double *numbers, int first, int last)
{
  double most = 0;
  for (int k = first; k < last; ++k) most = larger_of(most, fabs(numbers[k]));
  return most;
}

static void every_body_does_the_same_in_other_units(void **state)
{
  (void)state;
  static const int kinds[] = {0, 10, 13, 16, 19, 20}; /* where numbers of another kind begin */
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c += under_sanitizers() ? 4 : 1) {
    double numbers[UNITS][NUMBERS];
    int64_t counts[UNITS][3];
    for (int u = 0; u < UNITS; ++u) {
      if (u == 1 + (int)c % 2 && !whole_walks()) continue; /* against the first units, the other two in turn */
      breccia_model *m = model_of("units: {%s}\n%s", units[u].words, cases[c].deck);
      m->threads = 1; /* of bodies so small more only wait */
      step_surely(m, INT64_MAX);
      const int count = numbers_of(m, u, numbers[u], counts[u]);
      assert_int_equal(count, kinds[5]);
      if (u == 0)
        print_message("%s: %lld steps, %lld bonds, external %g J\n", cases[c].name, (long long)counts[0][0],
                      (long long)counts[0][1], numbers[0][4]);
      for (int k = 0; k < 2; ++k)
        if (counts[u][k] != counts[0][k])
          fail_msg("%s, %s: %lld steps and %lld bonds, not %lld and %lld", cases[c].name, units[u].words,
                   (long long)counts[u][0], (long long)counts[u][1], (long long)counts[0][0], (long long)counts[0][1]);
      for (int kind = 0; kind < 5; ++kind) {
        const double most = largest_of(numbers[0], kinds[kind], kinds[kind + 1]);
        for (int k = kinds[kind]; k < kinds[kind + 1]; ++k)
          if (!(fabs(numbers[u][k] - numbers[0][k]) <= cases[c].tolerance * most))
            fail_msg("%s, %s: number %d is %.10g, not %.10g", cases[c].name, units[u].words, k, numbers[u][k],
                     numbers[0][k]);
      }
      breccia_model_destroy(&m);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_body_does_the_same_in_other_units)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
