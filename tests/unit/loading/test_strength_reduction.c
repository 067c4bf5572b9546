/* Strengths that loads divide: laws against the same laws with divided parameters, and slopes without end against their
 * closed form. */
#include "support.h"

#include "base/tensor.h"
#include "loading/load.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"

typedef struct Law {
  const char *given, *divided; /* by 1.6: c = 8 -> 5, tan(phi) = 0.8 -> 0.5 */

} Law;

/* Angles of friction are atan(0.8) and atan(0.5); the first dilation angle lies between these. */
#define COULOMB "model: mohr-coulomb, density: 2, Young modulus: 1e4, Poisson ratio: 0.3, "
#define CONE "model: drucker-prager, density: 2, Young modulus: 1e4, Poisson ratio: 0.3, "
#define J2 "model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.3, "
#define NESTED "model: multi-yield-j2, density: 2, shear modulus: 4e3, bulk modulus: 8e3, "
static const Law laws[] = {
    {COULOMB "cohesion: 8, friction angle: \"${atan(0.8)}\", dilation angle: 0",
     COULOMB "cohesion: 5, friction angle: \"${atan(0.5)}\", dilation angle: 0"},
    {COULOMB "cohesion: 8, friction angle: \"${atan(0.8)}\", dilation angle: \"${atan(0.7)}\", tensile strength: 3.2",
     COULOMB "cohesion: 5, friction angle: \"${atan(0.5)}\", dilation angle: \"${atan(0.5)}\", tensile strength: 2"},
    {COULOMB "cohesion: 8, friction angle: \"${atan(0.8)}\"", COULOMB "cohesion: 5, friction angle: \"${atan(0.5)}\""},
    {CONE "cohesion: 8, friction angle: \"${atan(0.8)}\", dilation angle: 0",
     CONE "cohesion: 5, friction angle: \"${atan(0.5)}\", dilation angle: 0"},
    {CONE "cone strength: 8, cone slope: 0.16, dilation slope: 0.12, tension cut-off: 16, hardening modulus: 160",
     CONE "cone strength: 5, cone slope: 0.1, dilation slope: 0.1, tension cut-off: 10, hardening modulus: 100"},
    {J2 "yield stress: 16, saturation stress: 24, saturation rate: 100, hardening modulus: 160",
     J2 "yield stress: 10, saturation stress: 15, saturation rate: 100, hardening modulus: 100"},
    {NESTED "cohesion: 16", NESTED "cohesion: 10"},
    {NESTED "octahedral strength: 16", NESTED "octahedral strength: 10"},
};
enum { LAWS = sizeof laws / sizeof *laws };

/** Ground that is pushed down by a footing, all motions prescribed at its top. */
static breccia_model *ground_of(const char *law, const char *loads)
{
  breccia_model *m = model_of(
      UNITS "materials: {m: {%s}}\n"
            "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [8, 6]}}}}\n"
            "peridynamics: {formulation: correspondence, space: plane strain, horizon: 2.015 spacings}\n"
            "loads: [{on: {face: y-, layers: 2}, displacement: [0, 0]}, {on: {face: y+, layers: 2}, displacement: "
            "[4e-3, -2e-3], history: {ramp to: 1}}%s]\n"
            "solve: {static: {increments: 3, method: relaxation, residual: 1e-6, relaxation iterations: 20000}}\n"
            "pictures: []\n",
      law, loads);
  m->threads = 1;
  return m;
}

/** Strengths that are divided from the beginning on are those of a deck that gives them so. */
static void divided_strengths_are_those_of_divided_parameters(void **state)
{
  (void)state;
  for (int k = 0; k < LAWS; ++k) {
    breccia_model *m[2] = {ground_of(laws[k].given, ", {strength reduction: 1.6}"), ground_of(laws[k].divided, "")};
    double apart = 0, largest = 0;
    for (int s = 0; s < 2; ++s)
      while (!solver_is_done(&m[s]->solver)) step_surely(m[s], 1);
    const Particles *p = m[0]->domain.particles;
    for (int c = 0; c < 6; ++c)
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        apart = larger_of(apart, fabs(m[0]->domain.stress[c][i] - m[1]->domain.stress[c][i]));
        largest = larger_of(largest, fabs(m[1]->domain.stress[c][i]));
      }
    if (!(apart <= 1e-8 * largest) || !(largest > 1))
      fail_msg("law %d: stresses are %g of %g apart", k, apart, largest);
    assert_near(m[0]->domain.materials[0].reduction, 1.6, 0);
    for (int s = 0; s < 2; ++s) breccia_model_destroy(&m[s]);
  }
}

/** Strengths are divided in all regions. */
static void strengths_of_all_regions_are_divided(void **state)
{
  (void)state;
  breccia_model *m[2];
  double apart = 0, largest = 0;
  for (int s = 0; s < 2; ++s) {
    m[s] = model_of(
        UNITS "materials: {m: {" J2 "yield stress: %g}, n: {" J2 "yield stress: %g}}\n"
              "body:\n"
              "  b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [8, 5]}}}\n"
              "  c: {material: n, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [8, 5], first "
              "particle: [0.05, 0.55]}}}\n"
              "peridynamics: {space: plane strain, horizon: 2.015 spacings, regions: {far: {blocks: [c], formulation: "
              "ordinary}}}\n"
              "loads: [{on: {block: b, face: y-, layers: 2}, displacement: [0, 0]}, {on: {block: c, face: y+, layers: "
              "2}, displacement: [8e-3, -4e-3], history: {ramp to: 1}}%s]\n"
              "solve: {static: {increments: 3, method: relaxation, residual: 1e-6, relaxation iterations: 20000}}\n"
              "pictures: []\n",
        s ? 10. : 16., s ? 5. : 8., s ? "" : ", {strength reduction: 1.6}");
    m[s]->threads = 1;
    while (!solver_is_done(&m[s]->solver)) step_surely(m[s], 1);
  }
  const Particles *p = m[0]->domain.particles, *q = m[1]->domain.particles;
  for (int c = 0; c < 2; ++c)
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      apart = larger_of(apart, fabs(p->internal.row[c][i] - q->internal.row[c][i]));
      largest = larger_of(largest, fabs(q->internal.row[c][i]));
    }
  if (!(apart <= 1e-4 * largest)) fail_msg("forces are %g of %g apart", apart, largest);
  for (int s = 0; s < 2; ++s) breccia_model_destroy(&m[s]);
}

/** Ground on a slope without end, of height 10 m along its normal, whose gravity leans by atan(0.5); periodic along the
 * slope. */
static breccia_model *slope_of(const char *formulation, const char *law, int layers, const char *load,
                               const char *stage)
{
  breccia_model *m = model_of(
      UNITS
      "variables: {g: 10, lean: \"${atan(0.5)}\"}\n"
      "materials: {m: {%s}}\n"
      "body: {b: {material: m, lattice: square, spacing: %.17g, thickness: 1, shape: {box: {from: [0, 0], to: [%.17g, "
      "10]}}}}\n"
      "peridynamics: {%s, space: plane strain, horizon: 2.015 spacings}\n"
      "loads: [{gravity: [\"${g*sin(lean)}\", \"${-g*cos(lean)}\"]}, {on: {face: y-}, support: {held: all}}, "
      "{on: {face: x+}, support: {held: periodic}}]\n"
      "solve: [{name: at rest, laws: elastic, static: {increments: 1}}, {name: weaken, displacements: zero, "
      "loads: [{strength reduction: 2, history: {ramp to: 1}}%s], static: {increments: 20, smallest increment: "
      "0.05}}%s]\n"
      "pictures: []\n",
      law, 10.0 / layers, 40.0 / layers, formulation, load, stage);
  m->threads = 1;
  return m;
}

/** The largest factor with an equilibrium: c / (gamma H sin(b)) + tan(phi) / tan(b), as shear and pressure at the base
 * are gamma H times sin(b) and cos(b). The lowest particle stands half a spacing above the base, where both are less by
 * its share of the height. */
static void slopes_without_end_slide_at_their_closed_form(void **state)
{
  (void)state;
  const double gamma = 20, height = 10, sine = sin(atan(0.5));
  static const struct {
    const char *formulation, *law;
    double cohesion, friction; /* c, tan(phi) */
  } slopes[] = {
      {"formulation: ordinary", J2 "yield stress: \"${sqrt(3)*130}\"", 130, 0},
      {"formulation: ordinary", J2 "yield stress: \"${sqrt(3)*110}\"", 110, 0},
  };
  for (size_t k = 0; k < sizeof slopes / sizeof *slopes; ++k) {
    const int layers = 10;
    breccia_model *m = slope_of(slopes[k].formulation, slopes[k].law, layers, "", "");
    Error *error = breccia_error_create();
    int status = 0;
    while (!status && !solver_is_done(&m->solver)) status = breccia_model_step(m, 1, error);
    const double factor = solver_strength_reduction(&m->solver),
                 right = slopes[k].cohesion / (gamma * height * sine) + slopes[k].friction / 0.5;
    const double lost = m->solver.records[m->solver.clock.stage].lost_reduction;
    if (status) fail_msg("slope %zu: %s", k, breccia_error_text(error));
    if (!(m->solver.clock.time < 1.99)) fail_msg("slope %zu finds equilibrium at all factors", k);
    if (!(lost > factor && lost < factor + 0.06)) fail_msg("slope %zu: lost at %g, found at %g", k, lost, factor);
    if (!(factor > 0.97 * right && factor < 1.07 * right)) fail_msg("slope %zu: %g in place of %g", k, factor, right);
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
}

/** A slope without end of clay on two held layers, six particles high, whose right factor is 1.3, and the layers along
 * which it slides. @param[in] last  stages after the reduction */
static breccia_model *shallow_slope(const char *more, const char *last)
{
  breccia_model *m = model_of(
      UNITS
      "variables: {lean: \"${atan(0.5)}\"}\n"
      "materials: {m: {" J2 "yield stress: \"${1.3*sqrt(3)*2*6*sin(lean)}\"}}\n"
      "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {from: [0, -2], to: [6, 6]}}}}\n"
      "peridynamics: {space: plane strain, horizon: 2.015 spacings, %s}\n"
      "loads: [{gravity: [\"${sin(lean)}\", \"${-cos(lean)}\"], history: {ramp to: 1}}, {on: {face: y-, layers: 2}, "
      "displacement: [0, 0]}, {on: {face: x+}, support: {held: periodic}}]\n"
      "solve: [{static: {increments: 2}}, {displacements: zero, loads: [{strength reduction: 2, history: {ramp to: "
      "1}}], static: {increments: 20, smallest increment: 0.1}}%s]\n"
      "pictures: []\n",
      more, last);
  m->threads = 1;
  return m;
}

/** Correspondence finds the factor of a slope without end within 5 % with six particles over its height, at small strain,
 * too. The stage ends before the ground slides, and says so. Beside slip lines, where the law is elastic, control of
 * zero-energy modes held such slopes up to a factor of 2 and more at small strain. */
static void ground_that_slides_has_lost_its_equilibrium(void **state)
{
  (void)state;
  static const char *const strains[] = {"small", "green-lagrange"};
  for (int k = 0; k < 2; ++k) {
    char more[200];
    snprintf(more, sizeof more,
             "formulation: correspondence, strain: %s, influence: conical, zero-energy control: {silling: 0.2, fades: "
             "yielding}",
             strains[k]);
    breccia_model *m = shallow_slope(more, "");
    Error *error = breccia_error_create();
    int status = 0;
    while (!status && !solver_is_done(&m->solver)) status = breccia_model_step(m, 1, error);
    const StageRecord *record = &m->solver.records[m->solver.clock.stage];
    const double factor = solver_strength_reduction(&m->solver);
    const Particles *p = m->domain.particles;
    double moved = 0;
    for (int64_t n = 0; n < p->count; ++n) moved = larger_of(moved, fabs(p->displacement.row[0][p->place_of[n]]));
    print_message("%s strain: %g, lost at %g, slides: %g, moved %g of %g\n", strains[k], factor, record->lost_reduction,
                  record->slides, moved, record->elastic_displacement);
    if (status) fail_msg("%s strain: %s", strains[k], breccia_error_text(error));
    assert_true(factor > 0.97 * 1.3 && factor < 1.05 * 1.3);
    assert_true(record->lost_reduction > factor && record->lost_reduction < factor + 0.051);
    assert_true(moved < 10 * record->elastic_displacement); /* the state before the slide */
    if (k == 0) assert_true(record->slides == 1);
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
}

/** Materials that are not weakened, such as stiff bars or a slab, and the width of a periodic strip say nothing of the
 *  displacement at which ground slides: the factor of the slope without end stays. The modulus of an unused steel ended
 *  the reduction long before the slope slid. */
static void stiff_materials_and_narrow_periods_leave_the_factor(void **state)
{
  (void)state;
  static const struct {
    const char *materials;
    int columns;
  } runs[] = {{"", 6}, {", steel: {model: elastic, density: 7.8, Young modulus: 2e8, Poisson ratio: 0.3}", 6}, {"", 3}};
  double factors[3];
  for (int k = 0; k < 3; ++k) {
    breccia_model *m = model_of(
        UNITS
        "variables: {lean: \"${atan(0.5)}\"}\n"
        "materials: {m: {" J2 "yield stress: \"${1.3*sqrt(3)*2*6*sin(lean)}\"}%s}\n"
        "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {from: [0, -2], to: [%d, "
        "6]}}}%s}\n"
        "peridynamics: {space: plane strain, horizon: 2.015 spacings, formulation: correspondence, strain: small, "
        "influence: conical, zero-energy control: {silling: 0.2, fades: yielding}}\n"
        "loads: [{gravity: [\"${sin(lean)}\", \"${-cos(lean)}\"], history: {ramp to: 1}}, {on: {block: b, face: y-, "
        "layers: 2}, displacement: [0, 0]}, {on: {block: b, face: x+}, support: {held: periodic}}%s]\n"
        "solve: [{static: {increments: 2}}, {displacements: zero, loads: [{strength reduction: 2, history: {ramp to: "
        "1}}], static: {increments: 20, smallest increment: 0.1}}]\n"
        "pictures: []\n",
        runs[k].materials, runs[k].columns,
        k == 1 ? ", s: {material: steel, lattice: square, spacing: 1, thickness: 1, shape: {box: {from: [20, 0], to: "
                 "[24, 2]}}}"
               : "",
        k == 1 ? ", {on: {block: s}, displacement: [0, 0]}" : "");
    m->threads = 1;
    step_surely(m, INT64_MAX);
    factors[k] = solver_strength_reduction(&m->solver);
    print_message("%d columns%s: %g\n", runs[k].columns, runs[k].materials, factors[k]);
    breccia_model_destroy(&m);
  }
  assert_near(factors[1], factors[0], 1e-9);
  assert_near(factors[2], factors[0], 0.026);
}

/** Ground that slides in a stage before the last one is told, too: the stage fails at the factor. It went on from the far side of the slide, with strengths divided by 2. */
static void a_slide_before_the_last_stage_is_told(void **state)
{
  (void)state;
  breccia_model *m =
      shallow_slope("formulation: correspondence, strain: small, influence: conical, zero-energy control: "
                    "{silling: 0.2, fades: yielding}",
                    ", {static: {increments: 1}}");
  Error *error = breccia_error_create();
  int status = 0;
  while (!status && !solver_is_done(&m->solver)) status = breccia_model_step(m, 1, error);
  print_message("%s\n", breccia_error_text(error));
  assert_int_equal(status, BRECCIA_FAILURE);
  holds_words(breccia_error_text(error), "slides until it comes to rest elsewhere; divide strengths by less");
  assert_near(solver_strength_reduction(&m->solver), 1.3, 0.05 * 1.3);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
}

/** Loss of equilibrium is a factor of safety if a strength reduction alone has grown in the last stage. It is a failure
 *  if another load grows, too, or if another stage follows. */
static void a_factor_is_found_by_a_reduction_alone(void **state)
{
  (void)state;
  static const struct {
    const char *load, *stage;
  } others[] = {{", {gravity: [1e-3, 0], history: {ramp to: 1}}", ""},
                {"", ", {name: after, static: {increments: 1}}"},
                {", {gravity: [1e-3, 0]}", ""},
                /* which comes within the increment that finds no equilibrium */
                {", {gravity: [12, 0], history: {table: [[0, 0], [0.06, 0], [0.0601, 1]]}}", ""}};
  for (int k = 0; k < 4; ++k) {
    const bool found = k == 2; /* a load that stays */
    breccia_model *m =
        slope_of("formulation: ordinary", J2 "yield stress: \"${sqrt(3)*110}\"", 5, others[k].load, others[k].stage);
    Error *error = breccia_error_create();
    int status = 0;
    while (!status && !solver_is_done(&m->solver)) status = breccia_model_step(m, 1, error);
    const char *words = breccia_error_text(error);
    if (found ? status != 0 : !status || !strstr(words, "no equilibrium"))
      fail_msg("slope %d: %d, %s", k, status, words);
    assert_true((m->solver.records[m->solver.clock.stage].lost_reduction > 1) == found);
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
}

/** The loads of a stage do not count before its first increment has found equilibrium: a stage that fails at once leaves
 *  the factor of the state in which the body is. */
static void a_stage_that_fails_at_once_leaves_the_factor_before(void **state)
{
  (void)state;
  static const struct {
    const char *first, *second;
    double factor;
  } runs[] = {{"laws: elastic, static: {increments: 1}", "{strength reduction: 4}", 1},
              {"static: {increments: 2}, loads: [{strength reduction: 1.02}]",
               "{strength reduction: 2, history: {table: [[0, 2], [1, 3]]}}", 1.02}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        UNITS "materials: {m: {" J2 "yield stress: \"${sqrt(3)*110}\"}}\n"
              "body: {b: {material: m, lattice: square, spacing: 2, thickness: 1, shape: {box: {from: [0, 0], to: [8, "
              "10]}}}}\n"
              "peridynamics: {formulation: ordinary, space: plane strain, horizon: 2.015 spacings}\n"
              "loads: [{gravity: [4.472, -8.944]}, {on: {face: y-}, support: {held: all}}, {on: {face: x+}, support: "
              "{held: periodic}}]\n"
              "solve: [{%s}, {loads: [%s], static: {increments: 2, smallest increment: 0.5}}]\n",
        runs[k].first, runs[k].second);
    Error *error = breccia_error_create();
    int status = 0;
    while (!status && !solver_is_done(&m->solver)) status = breccia_model_step(m, 1, error);
    if (!status || m->solver.clock.stage != 1) fail_msg("run %d: %s", k, breccia_error_text(error));
    assert_near(solver_strength_reduction(&m->solver), runs[k].factor, 1e-12);
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
}

/** Ground that slides far may find rest with particles turned inside out. Such a state is no factor of safety: the
 *  increment is taken back, and the stage looks for a smaller factor. */
static void ground_turned_inside_out_has_no_factor(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS "materials: {m: {model: j2, density: 2, Young modulus: 1e5, Poisson ratio: 0.3, yield stress: 54.3}}\n"
            "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {polygon: {corners: [[0, 0], "
            "[18, 0], [18, 3], [12, 3], [6, 9], [0, 9]]}}}}\n"
            "peridynamics: {space: plane strain, influence: conical, zero-energy control: {silling: 0.2, fades: "
            "yielding}}\n"
            "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: x+}, support: {held: across}}, {on: {face: "
            "y-}, support: {held: all}}, {gravity: [0, -10]}, {strength reduction: 3, history: {ramp to: 1}}]\n"
            "solve: {static: {increments: 10, smallest increment: 1}}\n");
  Error *error = breccia_error_create();
  assert_int_equal(breccia_model_step(m, 1, error), BRECCIA_FAILURE);
  const char *words = breccia_error_text(error);
  if (!strstr(words, "no equilibrium beyond time 0 ") || strstr(words, "inside out (det F")) fail_msg("%s", words);
  assert_near(solver_strength_reduction(&m->solver), 1, 0);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
}

static void wrong_reductions_are_refused(void **state)
{
  (void)state;
  static const struct {
    const char *law, *load, *words;
  } wrong[] = {
      {J2 "yield stress: 3", "{strength reduction: 0}", "expected a number above 0 by which strengths are divided"},
      {J2 "yield stress: 3", "{on: {face: x-}, strength reduction: 2}",
       "acts on all materials whose laws tell how; leave it out"},
      {"model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.3", "{strength reduction: 2}",
       "no material has a law that tells how|mohr-coulomb"},
      {NESTED "octahedral strength: 300, peak octahedral strain: 0.1", "{strength reduction: 0.5}",
       "material 'm'|must lie below shear modulus times peak strain"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1024];
    snprintf(
        deck, sizeof deck,
        UNITS
        "materials: {m: {%s}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [6, 6]}}}}\n"
        "peridynamics: {formulation: correspondence, space: plane strain}\n"
        "loads: [{on: {face: y-, layers: 2}, displacement: [0, 0]}, %s]\nsolve: {static: {increments: 1}}\n",
        wrong[k].law, wrong[k].load);
    char *words = refusal_of(deck);
    holds_words(words, wrong[k].words);
    free(words);
  }
}

/** Soil without tension whose sides are free stands at the edge of the cut-off from the first increment on. */
static void a_column_of_soil_without_tension_stands(void **state)
{
  (void)state;
  static const char *const formulations[] = {"hybrid, horizon: 1.5 spacings",
                                             "correspondence, horizon: 2.015 spacings"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {soil: {model: mohr-coulomb, density: 2, Young modulus: 1e5, Poisson ratio: 0.3, cohesion: 10, "
        "friction "
        "angle: 30 deg}}\n"
        "body: {b: {material: soil, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [8, 8]}}}}\n"
        "peridynamics: {formulation: %s, space: plane strain}\n"
        "loads: [{on: {face: y-}, support: {held: across}}, {on: {face: x-}, support: {held: across}},\n"
        "        {gravity: [0, -1], history: {ramp to: 1}}]\nsolve: {static: {increments: 2}}\n",
        formulations[k]);
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    const double top = p->displacement.row[1][particles_nearest(p, (double[]){0.35, 0.75, 0})];
    assert_near(top, -2.0 * 0.8 * 0.8 / 2 * (1 - 0.09) / 1e5, 0.15e-6 * 2);
    breccia_model_destroy(&m);
  }
}

static void factors_that_come_to_nothing_are_refused(void **state)
{
  (void)state;
  static const char *const histories[] = {"{table: [[0, 0], [1, -1]]}", "{sine: {frequency: 1 Hz, phase: 0}}",
                                          "{product: [{ramp to: 1}, {table: [[0, -1], [1, -1]]}]}",
                                          "{sum: [{ramp to: 1}, {table: [[0, 0], [1, -3]]}]}"};
  for (size_t k = 0; k < sizeof histories / sizeof *histories; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck,
             "units: {length: m, force: kN, time: s}\n"
             "materials: {m: {model: j2, density: 2, Young modulus: 1e3, Poisson ratio: 0.25, yield stress: 1}}\n"
             "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"
             "loads: [{on: {face: z-, layers: 3}, displacement: [0, 0, 0]}, {strength reduction: 2, history: "
             "%s}]\nsolve: {static: {increments: 1}}\n",
             histories[k]);
    char *words = refusal_of(deck);
    holds_words(words, "is not above 0|strengths are divided by it");
    free(words);
  }
}

/** Ground that is pulled apart far beyond its tensile strength of 3.2 kPa, divided by 1.6, bears 2 kPa in its middle
 * and no principal stress above 2 kPa anywhere. */
static void the_cut_off_of_tension_is_divided(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS
      "materials: {m: {" COULOMB "cohesion: 8, friction angle: \"${atan(0.8)}\", tensile strength: 3.2}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [5, 10]}}}}\n"
      "peridynamics: {formulation: correspondence, space: plane strain, horizon: 2.015 spacings}\n"
      "loads: [{on: {face: y-, layers: 2}, displacement: [0, 0]}, {on: {face: y+, layers: 2}, displacement: [0, 6e-4], "
      "history: {ramp to: 1}}, {strength reduction: 1.6}]\n"
      "solve: {static: {increments: 3, method: relaxation, residual: 1e-6, relaxation iterations: 20000}}\n"
      "pictures: []\n");
  m->threads = 1;
  while (!solver_is_done(&m->solver)) step_surely(m, 1);
  const Particles *p = m->domain.particles;
  double *const *s = m->domain.stress, largest = 0, pull = 0;
  int middle = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double mean = (s[XX][i] + s[YY][i]) / 2, half = (s[XX][i] - s[YY][i]) / 2;
    largest = larger_of(largest, mean + hypot(half, s[XY][i]));
    if (fabs(p->position[1][i] - 0.5) > 0.06) continue;
    pull += s[YY][i];
    ++middle;
  }
  assert_int_equal(middle, 10);
  assert_near(largest, 2, 1e-9);
  assert_near(pull / middle, 2, 0.02);
  breccia_model_destroy(&m);
}

/** The watched value of a strength reduction is the number by which strengths are divided: 1 before its stage, and
 *  1 + (F - 1) h under a history h. The last words tell the same number as its peak. */
static void the_watched_value_divides_strengths(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", path[64], command[64], line[256];
  assert_non_null(mkdtemp(folder));
  breccia_model *m = model_of(
      UNITS "materials: {m: {" J2 "yield stress: 10}}\n"
            "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [6, 6]}}}}\n"
            "peridynamics: {formulation: correspondence, space: plane strain, horizon: 2.015 spacings}\n"
            "loads: [{on: {face: y-, layers: 2}, displacement: [0, 0]}, {gravity: [0, -1], history: {ramp to: 1}}]\n"
            "solve: [{static: {increments: 1}}, {loads: [{name: weakening, strength reduction: 2.5, history: {table: "
            "[[0, 0], [1, 0.4]]}}], static: {increments: 2}}]\n"
            "watch: {w: {load: weakening, every: 1}}\npictures: []\n");
  Error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof run, .folder = folder};
  if (breccia_model_run(m, &run, error)) fail_msg("%s", breccia_error_text(error));
  holds_words(breccia_model_outcome(m), "load 'weakening': strength reduction, peak 1.6\n");
  snprintf(path, sizeof path, "%s/w.csv", folder);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  assert_non_null(fgets(line, sizeof line, file));
  static const double factors[] = {0, 0, 0.2, 0.4}, values[] = {1, 1, 1.3, 1.6};
  for (int k = 0; k < 4; ++k) {
    double factor, value;
    assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(sscanf(line, "%*[^,],%*[^,],%lf,%lf", &factor, &value), 2);
    assert_near(factor, factors[k], 1e-12);
    assert_near(value, values[k], 1e-12);
  }
  fclose(file);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_column_of_soil_without_tension_stands),
      cmocka_unit_test(the_cut_off_of_tension_is_divided),
      cmocka_unit_test(factors_that_come_to_nothing_are_refused),
      cmocka_unit_test(divided_strengths_are_those_of_divided_parameters),
      cmocka_unit_test(strengths_of_all_regions_are_divided),
      cmocka_unit_test(slopes_without_end_slide_at_their_closed_form),
      cmocka_unit_test(ground_that_slides_has_lost_its_equilibrium),
      cmocka_unit_test(stiff_materials_and_narrow_periods_leave_the_factor),
      cmocka_unit_test(a_slide_before_the_last_stage_is_told),
      cmocka_unit_test(a_factor_is_found_by_a_reduction_alone),
      cmocka_unit_test(a_stage_that_fails_at_once_leaves_the_factor_before),
      cmocka_unit_test(ground_turned_inside_out_has_no_factor),
      cmocka_unit_test(wrong_reductions_are_refused),
      cmocka_unit_test(the_watched_value_divides_strengths),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
