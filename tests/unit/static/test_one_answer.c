/* What a softening body bears at rest does not depend on how its problem is posed: in which units, as which of two
 * mirror images, in which direction, and in which order its particles stand in a file. */
#include "support.h"

#include "base/random.h"
#include "solver/reactions.h"

#define FILE_NAME "test_one_answer.csv"

/** Poses of one problem. */
static const struct Pose {
  const char *name, *units;
  /* Unit of length (m) and of force (N). */
  double length, force;
  /* Rotation (degrees), after a mirror if that is -1. */
  double angle, mirror;
  /* Seed of the order of particles; 0: row by row. */
  uint64_t order;
} poses[] = {{"as it is", "length: m, force: N, time: s", 1, 1, 0, 1, 0},
             {"in other units", "length: in, force: lbf, time: min", 0.0254, 4.4482216152605, 0, 1, 0},
             {"mirrored", "length: m, force: N, time: s", 1, 1, 0, -1, 0},
             {"turned by 37 degrees", "length: m, force: N, time: s", 1, 1, 37, 1, 0},
             {"in another order", "length: m, force: N, time: s", 1, 1, 0, 1, 7},
             {"all at once", "length: mm, force: kN, time: ms", 1e-3, 1e3, 37, -1, 11}};
enum { POSES = sizeof poses / sizeof *poses, TURNED = 3 };

#define CONCRETE "density: 2400 kg/m3, Young modulus: 30 GPa"
#define TENSION ", tensile strength: 3 MPa, fracture energy: 100 N/m"
#define PLASTIC "model: damage-plasticity, " CONCRETE TENSION ", Poisson ratio: 0.2, compressive strength: 30 MPa"

/** Formulations with laws that soften. */
static const struct Softening {
  const char *formulation, *law;
  /* Displacement of the grip over that of the first body. */
  double drawn;
  /* Columns and rows of particles; 0: COLUMNS and ROWS. */
  int columns, rows;
} bodies[] = {
    {"bond-based, space: plane stress", "model: bilinear-softening, " CONCRETE TENSION, 1, 0, 0},
    {"bond-based, space: plane stress", "model: exponential-softening, " CONCRETE TENSION, 1, 0, 0},
    {"bond-based, space: plane stress", "model: trilinear-softening, " CONCRETE TENSION, 1, 0, 0},
    {"correspondence, space: plane strain", "model: mazars, " CONCRETE TENSION ", Poisson ratio: 0.2", 1, 0, 0},
    {"correspondence, space: plane stress", PLASTIC, 1, 0, 0},
    {"hybrid, space: plane strain", "model: mazars, " CONCRETE TENSION ", Poisson ratio: 0.2", 1, 0, 0},
    {"hybrid, space: plane strain", PLASTIC, 1, 0, 0},
    {"hybrid, space: plane stress", "model: exponential-softening, " CONCRETE TENSION, 1, 0, 0},
    {"micropolar, space: plane stress",
     "model: link-damage, " CONCRETE ", Poisson ratio: 0.2, tensile stretch: 1e-4, fracture energy: 100 N/m", 2, 0, 0},
    {"bond-based, space: plane stress", "model: exponential-softening, " CONCRETE TENSION, 2, 15, 20},
};
enum { BODIES = sizeof bodies / sizeof *bodies };

/** Size of the plate and of its grips in particles, and sizes of arrays. The plate is notched on one side over a quarter
 * of its width. */
enum { COLUMNS = 7, ROWS = 9, GRIP = 2, MOST_STEPS = 400, MOST_ROWS = 20 };
static const double spacing = 0.02;

/** Returns the unit of time of a pose (s). */
static double pose_second(const struct Pose *pose)
{
  return strstr(pose->units, "min") ? 60 : strstr(pose->units, "ms") ? 1e-3 : 1;
}

/** Turns a vector (m) as a pose has it. @param[out] v  (unit of the pose) */
static void turn(const struct Pose *pose, double x, double y, double v[2])
{
  const double angle = pose->angle * acos(-1) / 180, c = cos(angle), s = sin(angle);
  x *= pose->mirror;
  v[0] = (c * x - s * y) / pose->length;
  v[1] = (s * x + c * y) / pose->length;
}

static void write_particles(const struct Pose *pose, int columns, int rows)
{
  int order[MOST_ROWS * MOST_ROWS];
  uint64_t seed = pose->order;
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  for (int n = 0; n < columns * rows; ++n) order[n] = n;
  for (int n = columns * rows - 1; n > 0 && pose->order; --n) {
    const int other = (int)(random_uniform(&seed) * (n + 1)), held = order[n];
    order[n] = order[other];
    order[other] = held;
  }
  fprintf(file, "x,y,volume,group\n");
  for (int n = 0; n < columns * rows; ++n) {
    const int column = order[n] % columns, row = order[n] / columns;
    double at[2];
    turn(pose, spacing * column, spacing * row, at);
    fprintf(file, "%.17g,%.17g,%.17g,%s\n", at[0], at[1], spacing * spacing * 0.1 / pow(pose->length, 3),
            row < GRIP           ? "low"
            : row >= rows - GRIP ? "high"
                                 : "between");
  }
  fclose(file);
}

static breccia_model *posed(const struct Softening *body, const struct Pose *pose)
{
  const int columns = body->columns ? body->columns : COLUMNS, rows = body->rows ? body->rows : ROWS;
  double from[2], to[2], pull[2];
  write_particles(pose, columns, rows);
  turn(pose, -spacing, (rows - 1) / 2.0 * spacing + spacing / 3, from);
  turn(pose, (columns - 0.6) / 4 * spacing, (rows - 1) / 2.0 * spacing + spacing / 3, to);
  turn(pose, 1e-5 * body->drawn, 4e-5 * body->drawn, pull);
  breccia_model *m =
      model_of("units: {%s}\nmaterials: {m: {%s}}\n"
               "body: {b: {material: m, lattice: square, spacing: %.17g, thickness: %.17g, file: " FILE_NAME "}}\n"
               "peridynamics: {formulation: %s}\ncracks: [{cut: {line: [[%.17g, %.17g], [%.17g, %.17g]]}}]\n"
               "loads: [{on: {group: low}, displacement: [0, 0]},\n"
               "        {name: pull, on: {group: high}, displacement: [%.17g, %.17g], history: {ramp to: 1 s}}]\n"
               "solve: {static: {end time: 1 s}}\n",
               pose->units, body->law, spacing / pose->length, 0.1 / pose->length, body->formulation, from[0], from[1],
               to[0], to[1], pull[0], pull[1]);
  m->threads = 1; /* of bodies so small more only wait */
  return m;
}

/** Force that moves the grip (N). */
static double pull_of(const breccia_model *m, const struct Pose *pose)
{
  Reactions reactions = {0};
  assert_int_equal(reactions_create(&reactions, m->domain.particles, NULL), 0);
  const Wrench sum = reactions_sum(&reactions, &m->solver, NULL, "pull", NULL);
  reactions_destroy(&reactions);
  return hypot(sum.force[0], sum.force[1]) * pose->force;
}

/** Forces that move the grip. */
typedef struct Answer {
  double peak, last;       /* (N) */
  double at[MOST_STEPS];   /* [steps] force after each step (N) */
  double time[MOST_STEPS]; /* [steps] end of each step (s) */
  int steps;
} Answer;

static Answer answer_of(const struct Softening *body, const struct Pose *pose)
{
  breccia_model *m = posed(body, pose);
  Answer answer = {0};
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    answer.last = pull_of(m, pose);
    answer.peak = larger_of(answer.peak, answer.last);
    assert_true(answer.steps < MOST_STEPS);
    answer.time[answer.steps] = m->solver.clock.time * pose_second(pose);
    answer.at[answer.steps++] = answer.last;
  }
  breccia_model_destroy(&m);
  return answer;
}

/** Returns the largest difference of two answers over the peak, at all times at which both have a step. The times of
 * steps may differ: round-off can decide whether an increment takes so many iterations that the next is shortened. */
static double difference_of(const Answer *a, const Answer *b)
{
  double most = fabs(a->peak - b->peak);
  int common = 0;
  for (int k = 0; k < a->steps; ++k)
    for (int l = 0; l < b->steps; ++l) {
      if (fabs(a->time[k] - b->time[l]) > 1e-9) continue;
      most = larger_of(most, fabs(a->at[k] - b->at[l]));
      ++common;
    }
  assert_true(3 * common > 2 * a->steps);
  return most / a->peak;
}

/** Compares the first pose of each body with the turned one and with all changes at once. Bodies of softening bonds,
 * which jump, are compared in one more pose. */
static void what_a_body_bears_does_not_depend_on_how_it_is_posed(void **state)
{
  (void)state;
  int differ = 0;
  for (int b = 0; b < BODIES; b += under_sanitizers() ? 4 : 1) {
    const Answer first = answer_of(&bodies[b], &poses[0]);
    print_message("%s, %.30s: peak %.9g N, last %.9g N\n", bodies[b].formulation, bodies[b].law, first.peak,
                  first.last);
    assert_true(first.peak > 0 && first.last < 0.8 * first.peak); /* it has given way */
    for (int k = 1; k < POSES; ++k) {
      const bool bonds = strstr(bodies[b].law, "-softening") != NULL, turn_of = k == 1 + (b + 3) % (POSES - 2);
      if (k < POSES - 1 && k != TURNED && !(bonds && turn_of) && !whole_walks()) continue;
      const Answer answer = answer_of(&bodies[b], &poses[k]);
      const double difference = difference_of(&first, &answer);
      if (difference <= 1e-6) continue;
      ++differ;
      print_message("  %s: peak %.9g N, last %.9g N, apart by %g of the peak\n", poses[k].name, answer.peak,
                    answer.last, difference);
    }
  }
  remove(FILE_NAME);
  assert_int_equal(differ, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_a_body_bears_does_not_depend_on_how_it_is_posed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
