#include "cli/verbs.h"

#include <errno.h>
#include <string.h>

static const Option options[] = {{0}};

static const char starter[] =
    "# A deck of Breccia. 'breccia check' tells what it would run, 'breccia run' runs it; docs/deck.md lists every "
    "key.\n"
    "title: Plate with an edge crack\n"
    "units: {length: m, force: kN, time: s}      # plain numbers are in these; \"30 MPa\" works anywhere\n"
    "\n"
    "materials:\n"
    "  rock:\n"
    "    model: elastic                          # 'breccia models' lists them\n"
    "    density: 2.4 t/m3\n"
    "    Young modulus: 30 GPa\n"
    "    Poisson ratio: 0.2\n"
    "\n"
    "body:\n"
    "  plate:\n"
    "    material: rock\n"
    "    lattice: square                         # square in the plane, cubic in space\n"
    "    spacing: 0.01 m\n"
    "    thickness: 0.1 m\n"
    "    shape: {box: {from: [0, 0], to: [0.5 m, 0.5 m]}}\n"
    "\n"
    "cracks:\n"
    "  - {cut: {line: [[0, 0.25], [0.15, 0.25]]}}\n"
    "\n"
    "peridynamics: {space: plane stress, horizon: 3.015 spacings}\n"
    "failure: {critical stretch: 0.0005}\n"
    "\n"
    "loads:\n"
    "  - {name: pull, on: {face: y+, layers: 3}, velocity: [free, 0.1 m/s]}\n"
    "  - {on: {face: y-, layers: 3}, velocity: [free, -0.1 m/s]}\n"
    "\n"
    "solve: {explicit: {end time: 2.0e-3 s}}     # the time step is found by the program\n"
    "\n"
    "watch:\n"
    "  opening: {opening between: [[0, 0.245], [0, 0.255]]}\n"
    "  grip: {force on: {face: y+, layers: 3}}\n"
    "  energy: {energy: yes}\n"
    "\n"
    "pictures:\n"
    "  - {field: damage}\n"
    "  - {field: stress, component: yy, deformed: 100}\n"
    "  - {curve: 'opening.opening : grip.y'}\n";

static int run(int argc, char **argv, const Verb *verb)
{
  int first = read_options(argc, argv, verb, NULL, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (argc - first != 1) {
    fprintf(stderr, "breccia new: give the name of the deck to write, like plate.yaml\n");
    return 2;
  }
  FILE *file = fopen(argv[first], "wx");
  if (!file) {
    fprintf(stderr, "%s: %s\n", argv[first], errno == EEXIST ? "exists already; choose another name" : strerror(errno));
    return 2;
  }
  int bad = fputs(starter, file) < 0;
  if (fclose(file) || bad) {
    fprintf(stderr, "%s: cannot be written: %s\n", argv[first], strerror(errno));
    return 1;
  }
  printf("%s is written; 'breccia run %s' runs it\n", argv[first], argv[first]);
  return 0;
}

const Verb verb_new = {"new", "DECK", "write a commented deck to start from", options, NULL, run};
