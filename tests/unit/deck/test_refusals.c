/* Decks that cannot be meant: each is a good one with one line in place of another, and is refused in that line with words that say why. */
#include "support.h"

typedef struct Parts {
  const char *material, *body, *horizon, *loads, *solve, *more;
} Parts;

static const Parts good = {
    "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}",
    "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}",
    "peridynamics: {space: 3-D}",
    "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}]",
    "solve: {explicit: {steps: 1}}",
    "title: Good",
};

#define PLATE "material: m, lattice: square, thickness: 0.2, spacing: 0.1, shape: {box: {particles: [9, 7]}}"
#define DISC "material: m, lattice: square, thickness: 0.2, spacing: 0.1, shape: "
#define CONTROLLED "{on: {face: x+, layers: 1}, traction: [1, 0, 0], history: {controlled: yes}}"
#define HELD "{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}"

static const struct Case {
  Parts parts; /* those that differ from the good deck */
  int line;
  const char *words;
} cases[] = {
    /* what is not there */
    {{.body = "body: {}"}, 2, "body: no block is given"},
    {{.material = "materials: {m: {model: , density: 2}}"}, 1, "model: expected words"},
    {{.loads = "loads: [{displacement: [0, 0, 0]}]"}, 4, "missing key 'on'"},
    /* what is of another kind */
    {{.more = "title: [Good]"}, 6, "title: expected words"},
    {{.more = "title: ''"}, 6, "title: expected words"},
    {{.body = "body: {b: {material: [m], spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}"}, 2, "expected a name"},
    {{.more = "watch: {e: {energy: perhaps}}"}, 6, "energy: expected yes or no, found perhaps"},
    {{.more = "watch: {e: {energy: [yes]}}"}, 6, "energy: expected yes or no"},
    {{.body = "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: 6}}}}"}, 2, "particles: expected"},
    {{.body = "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4, 3]}}}}"},
     2,
     "particles: expected"},
    {{.more = "results: {fields: damage}"}, 6, "fields: expected"},
    {{.more = "results: {fields: [[damage]]}"}, 6, "fields: expected words"},
    {{.more = "results: {fields: [bond damage]}"}, 6, "there is no field 'bond damage'; the fields are"},
    {{.material =
          "materials: {m: {model: mazars, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, tensile strength: "
          "1, fracture energy: 1e-4}}",
      .more = "results: {fields: [bond damage]}"},
     6,
     "there is no field 'bond damage'; the laws of this deck do not have it; the damage of material 'm' is 'material "
     "damage'"},
    {{.loads = "loads: [{on: {all: yes}, body force: [1, 0, 0], history: {table: [[0, 1], 2]}}]"},
     4,
     "table: expected"},
    {{.more = "variables: {dx: [1, 2]}"}, 6, "variables: 'dx' is no single value"},
    /* bodies */
    {{.body = "body: {b: {material: m, lattice: line, spacing: 0.1, shape: {box: {particles: [6, 1]}}}}"},
     2,
     "a line needs the 'area'"},
    {{.body = "body: {b: {material: m, area: 1, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}"},
     2,
     "'area' goes with 'lattice: line'"},
    {{.body = "body: {b: {material: m, thickness: 1, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}"},
     2,
     "'thickness' goes with a square or hexagonal lattice"},
    {{.body = "body: {b: {material: m, lattice: square, spacing: 0.1, shape: {box: {particles: [6, 5]}}}}"},
     2,
     "a square lattice needs the 'thickness'"},
    {{.body = "body: {a: {" PLATE "}, b: {material: m, spacing: 0.1, shape: {box: {from: [3, 0, 0], to: [4, 1, 1]}}}}",
      .horizon = "peridynamics: {space: plane strain}"},
     2,
     "lattices of space, of the plane and lines cannot stand in one body"},
    {{.body = "body: {b: {material: m, spacing: 0.1, shape: {cylinder: {from: [1, 1, 1], to: [1, 1, 1], radius: 1}}}}"},
     2,
     "'from' and 'to' are the same point"},
    {{.body = "body: {b: {" DISC "{cylinder: {from: [1, 1], radius: 1}}}}",
      .horizon = "peridynamics: {space: plane strain}"},
     2,
     "cylinder: missing key 'to' (centre of the other end; a disc in the plane is a 'sphere')"},
    {{.body = "body: {b: {material: m, spacing: 0.1, shape: {polygon: {corners: [[0, 0], [1, 1]]}}}}"},
     2,
     "polygon: needs at least 3 corners"},
    {{.body = "body: {b: {material: m, spacing: 0.1, shape: {polygon: {corners: [[0, 0], [1, 0], [1, 1]], bottom: 1, "
              "top: 1}}}}"},
     2,
     "polygon: 'top' must be above 'bottom'"},
    {{.body = "body: {b: {material: m, spacing: 0.1, shape: {difference: [{box: {from: [0, 0, 0], to: [1, 1, 1]}}]}}}"},
     2,
     "difference: needs at least two shapes"},
    {{.more = "cracks: [{cut: {line: [[0, 0]]}}]"}, 6, "line: needs at least two points"},
    {{.more = "cracks: [{cut: {polygon: [[0, 0, 0], [1, 0, 0]]}}]"}, 6, "polygon: needs at least three corners"},
    {{.more = "cracks: [{cut: {polygon: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.1]]}}]"},
     6,
     "polygon: corner 4 does not lie in the plane of the first three"},
    {{.more = "cracks: [{remove: {sphere: {centre: [0, 0, 0], radius: 0.1}}, cut faces: yes}]"},
     6,
     "cut faces: works for a box only"},
    {{.more = "cracks: [{cut: {line: [[0, 0], [1, 1]]}, cut faces: yes}]"}, 6, "cut faces: goes with 'remove'"},
    /* loads */
    {{.loads = "loads: [{on: {all: yes}, spring: {stiffness: 1, direction: [0, 0, 0]}}]"},
     4,
     "direction: must not be zero"},
    {{.loads = "loads: [{on: {all: yes}, body force: [1, 0, 0], area: 1}]"}, 4, "area: only a 'traction' has one"},
    {{.loads = "loads: [" CONTROLLED "]"}, 4, "no stage in which the load acts finds its factor"},
    {{.body = "body: {b: {material: m, lattice: hexagonal, thickness: 0.2, spacing: 0.1, shape: {box: {from: [0, 0], "
              "to: [1, 1]}}}}",
      .horizon = "peridynamics: {space: plane strain}",
      .loads = "loads: [{on: {face: x-}, support: {held: all}}]"},
     4,
     "is not its own mirror image"},
    {{.loads = "loads: [{on: {all: yes}, body force: [1, 0, 0], history: {product: []}}]"},
     4,
     "product: the list is empty"},
    {{.loads = "loads: [{on: {all: yes}, body force: [1, 0, 0], history: {sum: [{controlled: yes}, {ramp to: 1}]}}]"},
     4,
     "a factor that is found by control has no place in it"},
    {{.loads = "loads: [" HELD ", {on: {face: x-, layers: 1}, along: {direction: [1, 1, 0], displacement: 1}}]"},
     4,
     "already moves as the load in line 4 says, in a direction that is not at right angles to this one"},
    {{.body = "body: {b: {" PLATE "}}",
      .horizon = "peridynamics: {space: plane strain}",
      .loads = "loads: [{initial velocity: {rotation: [0, 1, 0]}, on: {all: yes}}]"},
     4,
     "initial velocity: the body is plane and turns about z only, this motion leads out of it"},
    {{.body = "body: {b: {" PLATE "}}",
      .horizon = "peridynamics: {space: plane strain}",
      .loads = "loads: [{initial velocity: {translation: [0, 0, 1]}, on: {all: yes}}]"},
     4,
     "this motion leads out of it"},
    {{.material = "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}",
      .body = "body: {b: {material: m, lattice: line, area: 1, spacing: 0.1, shape: {box: {particles: [9, 1]}}}}",
      .horizon = "peridynamics: {formulation: bond-based, space: 1-D}",
      .loads = "loads: [{initial velocity: {rotation: [0, 0, 1]}, on: {all: yes}}]"},
     4,
     "initial velocity: the body is a bar along x, this motion leads out of it"},
    {{.loads = "loads: [{on: {all: yes}, tie: {to: {face: x-}}}]"}, 4, "is among 'on' and among 'to'"},
    {{.loads = "loads: [" HELD ", {on: {face: x+}, tie: {to: {face: x-}}}]"},
     4,
     "is moved or held by the load in line 4, and the one it is tied to is not"},
    {{.solve = "solve: [{explicit: {steps: 1}}, {explicit: {steps: 1}, without: [pull]}]"},
     5,
     "without: no load that acts before this stage has the name 'pull'"},
    {{.more = "initial stress: {surface: 0.25, K0: 0.5, unit weight: 20}"},
     6,
     "stands 0.1 above it; select the particles below with 'on', or raise the surface"},
    /* formulations and breaking */
    {{.body = "body: {b: {material: m, lattice: line, area: 1, spacing: 0.1, shape: {box: {particles: [9, 1]}}}}",
      .horizon = "peridynamics: {formulation: micropolar, space: 1-D}",
      .loads = "loads: []"},
     3,
     "micropolar has no shear along a line; bars take bond-based"},
    {{.horizon = "peridynamics: {formulation: micropolar, kinematics: thesis}"},
     3,
     "kinematics: thesis is of plane bodies; leave it out"},
    {{.horizon = "peridynamics: {formulation: correspondence, regions: {r: {blocks: [b], formulation: micropolar}}}",
      .body = "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}, c: {material: m, spacing: "
              "0.1, shape: {box: {from: [0.4, 0, 0], to: [0.8, 0.4, 0.4]}}}}",
      .loads = "loads: [{on: {face: x+}, rotation: [0, 0, 1]}]"},
     4,
     "has no rotation, as its formulation has none; select particles of `formulation: micropolar` only"},
    {{.horizon = "peridynamics: {formulation: correspondence, space: plane stress, regions: {r: {blocks: [b], "
                 "formulation: micropolar, kinematics: thesis}}}",
      .body =
          "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [4, 4]}}}, "
          "c: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {from: [0.4, 0], to: [0.8, "
          "0.4]}}}}",
      .loads = "loads: []"},
     3,
     "kinematics: links of 'thesis' cannot stand beside other formulations; leave 'kinematics' out"},
    {{.horizon = "peridynamics: {formulation: micropolar, regions: {r: {blocks: [b], formulation: micropolar}}}",
      .body = "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}, c: {material: m, spacing: "
              "0.1, shape: {box: {from: [0.4, 0, 0], to: [0.8, 0.4, 0.4]}}}}",
      .loads = "loads: []"},
     3,
     "formulation: two regions of micropolar, whose particles turn, cannot stand beside each other; give their blocks"},
    {{.more = "failure: {criterion: critical bond stress, bond tensile strength: 1}"},
     6,
     "criterion: bonds of correspondence have no stress on a section"},
    {{.material = "materials: {m: {model: j2, density: 2, Young modulus: 3e7, Poisson ratio: 0.2, yield stress: 3e3}}",
      .body = "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}, c: {material: m, spacing: "
              "0.1, shape: {box: {from: [0.4, 0, 0], to: [0.8, 0.4, 0.4]}}}}",
      .horizon = "peridynamics: {formulation: correspondence, regions: {r: {blocks: [c], formulation: ordinary}}}"},
     1,
     "which spread a fracture energy over different lengths; give each a material of its own"},
    /* watches and solvers */
    {{.more = "watch: {a b: {energy: yes}, a/b: {energy: yes}}"}, 6, "give it another name"},
    {{.loads = "loads: [{name: pull, on: {face: x-}, body force: [1, 0, 0]}]",
      .more = "watch: {r: {reaction of: pull}}"},
     6,
     "reaction of: the load 'pull' prescribes no motion; what forces come to is told by 'load'"},
    {{.solve = "solve: {implicit: {end time: 1e17, time step: 1}}"}, 5, "time step: 1e+17 steps are too many"},
    {{.solve = "solve: {explicit: {time step: 1, steps: 3}}"}, 5, "times the stable step of"},
    /* solution and results */
    {{.solve = "solve: {static: {increments: 2, control: {opening between: [[0, 0, 0]], to: 1}}}",
      .loads = "loads: [" HELD ", " CONTROLLED "]"},
     5,
     "opening between: expected two points, found 1"},
    {{.solve = "solve: {static: {increments: 2, control: {opening between: [[0, 0, 0], [0, 0, 0]], to: 1}}}",
      .loads = "loads: [" HELD ", " CONTROLLED "]"},
     5,
     "the same particle is nearest to both points"},
    {{.solve = "solve: {static: {increments: 2, control: {displacement of: {face: x+}, to: 1}}}",
      .loads = "loads: [" HELD ", " CONTROLLED "]"},
     5,
     "missing key 'direction'"},
    {{.solve = "solve: {static: {increments: 2, control: {displacement of: {face: x+}, direction: [0, 0, 0], to: 1}}}",
      .loads = "loads: [" HELD ", " CONTROLLED "]"},
     5,
     "direction: has no length"},
    {{.solve = "solve: {static: {increments: 2, control: {opening between: [[0, 0, 0], [1, 0, 0]], direction: [1, 0, "
               "0], to: 1}}}",
      .loads = "loads: [" HELD ", " CONTROLLED "]"},
     5,
     "direction: only of 'displacement of'"},
    {{.solve = "solve: {static: {increments: 2, control: {displacement of: {face: x+}, direction: [1, 0, 0], to: 1}}}"},
     5,
     "no load of this stage has a factor to be found"},
    {{.solve = "solve: {static: {method: relaxation, increments: 2, control: {displacement of: {face: x+}, direction: "
               "[1, 0, 0], to: 1}}}",
      .loads = "loads: [" HELD ", " CONTROLLED "]"},
     5,
     "dynamic relaxation cannot find factors of loads"},
    {{.solve = "solve: {explicit: {steps: 20000000}}", .more = "results: {every: 1}"},
     6,
     "states are too many to write"},
    {{.more = "pictures: [{field: damage, range: [1, 1]}]"},
     6,
     "range: the lowest value 1 is not below the highest, 1"},
    {{.more = "watch: {e: {opening between: [[0, 0, 0]]}}"}, 6, "expected two points, found 1"},
    {{.more = "units: {length: m, force: kN, time: furlong}"}, 6, "furlong"},
    /* what no body and no law can be made of */
    {{.body = "body: {b: {material: m, spacing: 0.001, shape: {box: {from: [0, 0, 0], to: [2, 2, 2]}}}}"},
     2,
     "8e+09 lattice cells are more than the 2e9 that can be numbered"},
    {{.material = "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}",
      .horizon = "peridynamics: {space: 3-D, formulation: correspondence}"},
     1,
     "'elastic-1d' is a law of one strain; correspondence takes elastic, j2, viscoelastic,"},
    {{.horizon = "peridynamics: {space: 3-D, formulation: bond-based}"},
     1,
     "'elastic' is a law of strain in space; bond-based takes elastic-1d, elastic-brittle,"},
    {{.material =
          "materials: {m: {model: multi-yield-j2, density: 2, shear modulus: 1e4, bulk modulus: 2e4, octahedral "
          "strength: 30, surfaces: 7.5}}"},
     1,
     "'surfaces' must be a whole number"},
    {{.material =
          "materials: {m: {model: multi-yield-j2, density: 2, shear modulus: 1e4, bulk modulus: 2e4, octahedral "
          "strength: 30, friction angle: 20 deg}}"},
     1,
     "with a friction angle the strength is given by 'cohesion'"},
    {{.material = "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 3, "
                  "hardening modulus: 10}}",
      .horizon = "peridynamics: {space: 3-D, formulation: ordinary}"},
     1,
     "families yield without hardening"},
    {{.more = "pictures: [{field: pressur, component: xx}]"}, 6, "there is no field 'pressur'"},
    {{.more = "watch: {e: {bond between: [[0, 0, 0], [0.6, 0.5, 0.4]]}}"},
     6,
     "no bond joins the particles nearest to these points"},
    {{.more = "watch: {e: {bond between: [[0.31, 0, 0], [0.32, 0, 0]]}}"},
     6,
     "the same particle is nearest to both points"},
    {{.loads = "loads: [" HELD ", {on: {face: x+, layers: 1}, velocity: [1, 0, 0], history: {controlled: yes}}]",
      .solve = "solve: {static: {increments: 2, control: {displacement of: {face: x+}, direction: [1, 0, 0], to: 1}}}"},
     4,
     "its factor cannot be found by control; prescribe a displacement instead"},
};

static char *deck_of(const Parts *p)
{
  return text_format("%s\n%s\n%s\n%s\n%s\n%s\n", p->material ? p->material : good.material,
                     p->body ? p->body : good.body, p->horizon ? p->horizon : good.horizon,
                     p->loads ? p->loads : good.loads, p->solve ? p->solve : good.solve, p->more ? p->more : good.more);
}

static void what_cannot_be_meant_is_refused_in_its_line(void **state)
{
  (void)state;
  int bad = 0;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *deck = deck_of(&cases[k].parts), *words = refusal_of(deck), *place = text_format("deck:%d:", cases[k].line);
    if (strncmp(words, place, strlen(place)) || !strstr(words, cases[k].words) || strchr(words, '\n')) {
      print_error("expected '%s ... %s' in one line, found '%s'\n", place, cases[k].words, words);
      ++bad;
    }
    free(deck), free(words), free(place);
  }
  assert_int_equal(bad, 0);
}

static void the_deck_that_they_differ_from_is_good(void **state)
{
  (void)state;
  char *deck = deck_of(&(Parts){0});
  breccia_model *model = model_of("%s", deck);
  breccia_model_destroy(&model);
  free(deck);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_deck_that_they_differ_from_is_good),
      cmocka_unit_test(what_cannot_be_meant_is_refused_in_its_line),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
