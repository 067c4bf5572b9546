/* Factors of sparse matrices against dense elimination: positive definite, indefinite, unsymmetric and singular ones.
 * Their bits depend neither on earlier matrices nor on what another thread factors meanwhile; refused memory is an
 * error. */
#include "support.h"

#include "base/linear.h"
#include "base/random.h"
#include "solver/factors.h"
#include <pthread.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIZE = 90, BAND = 7 };

/** A matrix with entries near its diagonal and in two far columns, sparse and dense. */
typedef struct Sample {
  int64_t first[SIZE + 1], column[SIZE * SIZE];
  double value[SIZE * SIZE], dense[SIZE * SIZE];
} Sample;

typedef enum SampleKind { POSITIVE, NEGATIVE, INDEFINITE, UNSYMMETRIC, SINGULAR } SampleKind;

static bool has_entry(int row, int column)
{
  return abs(row - column) <= BAND || row % 31 == 5 || column % 31 == 5;
}

/** Makes a sample. POSITIVE: diagonally dominant. NEGATIVE: with every third diagonal entry negative. INDEFINITE: small
 *  diagonal entries, every third of which is zero. UNSYMMETRIC: other values beyond the diagonal. SINGULAR: the first
 *  row and column are zero. */
static Sample *sample_make(SampleKind kind, uint64_t seed)
{
  Sample *s = calloc(1, sizeof *s);
  for (int row = 0; row < SIZE; ++row)
    for (int column = 0; column <= row; ++column) {
      if (!has_entry(row, column)) continue;
      const double below = random_uniform(&seed) - 0.5, beyond = random_uniform(&seed) - 0.5;
      s->dense[row * SIZE + column] = below;
      s->dense[column * SIZE + row] = kind == UNSYMMETRIC ? beyond : below;
      if (row == column)
        s->dense[row * SIZE + row] = kind > NEGATIVE                    ? (row % 3 - 1) * 3.0
                                     : kind == NEGATIVE && row % 3 == 0 ? -SIZE
                                                                        : SIZE;
    }
  for (int k = 0; k < SIZE && kind == SINGULAR; ++k) s->dense[k] = s->dense[k * SIZE] = 0;
  int64_t count = 0;
  for (int row = 0; row < SIZE; ++row) {
    s->first[row] = count;
    for (int column = 0; column < SIZE; ++column) {
      if (!has_entry(row, column)) continue;
      s->column[count] = column;
      s->value[count++] = s->dense[row * SIZE + column];
    }
  }
  s->first[SIZE] = count;
  return s;
}

static SparseMatrix sparse(const Sample *s)
{
  return (SparseMatrix){SIZE, s->first, s->column, s->value};
}

static void right_side(double x[SIZE])
{
  for (int k = 0; k < SIZE; ++k) x[k] = sin(k + 1.0);
}

static bool solve_sample(Factors *f, const Sample *s, SampleKind kind, double x[SIZE])
{
  const SparseMatrix m = sparse(s);
  bool indefinite;
  right_side(x);
  assert_int_equal(factors_compute(f, &m, kind != UNSYMMETRIC, &indefinite, NULL), 0);
  assert_int_equal(factors_solve(f, x, NULL), 0);
  return indefinite;
}

static void solutions_are_those_of_dense_elimination(void **state)
{
  (void)state;
  for (SampleKind kind = POSITIVE; kind <= UNSYMMETRIC; ++kind)
    for (uint64_t seed = 1; seed < 6; ++seed) {
      Sample *s = sample_make(kind, seed);
      Factors *f = factors_create("test", NULL);
      double x[SIZE], wanted[SIZE];
      assert_int_equal(solve_sample(f, s, kind, x), kind == NEGATIVE || kind == INDEFINITE);
      assert_true(factors_bytes(f) > 0);
      right_side(wanted);
      assert_true(linear_solve(SIZE, s->dense, 1, wanted));
      for (int k = 0; k < SIZE; ++k) assert_near(x[k], wanted[k], 1e-9 * (1 + fabs(wanted[k])));
      factors_destroy(&f);
      free(s);
    }
}

static void bits_do_not_depend_on_earlier_matrices(void **state)
{
  (void)state;
  static const SampleKind order[] = {POSITIVE,    INDEFINITE, POSITIVE, NEGATIVE,
                                     UNSYMMETRIC, INDEFINITE, SINGULAR, POSITIVE};
  Factors *used = factors_create("test", NULL);
  for (size_t k = 0; k < sizeof order / sizeof *order; ++k) {
    Sample *s = sample_make(order[k], 10 + k % 3);
    Factors *fresh = factors_create("test", NULL);
    double x[SIZE], wanted[SIZE];
    solve_sample(used, s, order[k], x);
    solve_sample(fresh, s, order[k], wanted);
    assert_memory_equal(x, wanted, sizeof x);
    factors_destroy(&fresh);
    free(s);
  }
  factors_destroy(&used);
}

/** The first row is empty, and the right-hand side is not 0 there. */
static void singular_matrices_leave_a_residual(void **state)
{
  (void)state;
  Sample *s = sample_make(SINGULAR, 3);
  Factors *f = factors_create("test", NULL);
  double x[SIZE], residual = 0;
  assert_true(solve_sample(f, s, SINGULAR, x));
  for (int row = 0; row < SIZE; ++row) {
    double left = sin(row + 1.0);
    for (int column = 0; column < SIZE; ++column) left -= s->dense[row * SIZE + column] * x[column];
    residual += left * left;
  }
  assert_false(residual < 0.1);
  factors_destroy(&f);
  free(s);
}

/* ---- two models at once ---- */

#define PLATE                                                                                                          \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"                            \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [%d, 12]}}}}\n"     \
  "peridynamics: {formulation: correspondence, space: plane strain}\n"                                                 \
  "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}, {on: {face: x+, layers: 1}, traction: [1, 2]}]\n"        \
  "solve: {static: {equations: direct, increments: 3}}\n"

enum { RUNS = 3 };

typedef struct Run {
  int length;
  /** Where models that run together begin; NULL: alone. */
  pthread_barrier_t *begin;
  uint64_t bits;
  int failed;
} Run;

/** Runs a model several times. `bits` becomes a hash of all displacements. */
static void *run_models(void *context)
{
  Run *r = context;
  if (r->begin) pthread_barrier_wait(r->begin);
  for (int n = 0; n < RUNS && !r->failed; ++n) {
    breccia_error *error = breccia_error_create();
    breccia_model *model = NULL;
    char *deck = text_format(PLATE, r->length);
    r->failed |= breccia_model_load_string(deck, "deck", &(breccia_options){sizeof(breccia_options), .threads = 1},
                                           &model, error);
    if (!r->failed) r->failed |= breccia_model_step(model, 3, error);
    for (int k = 0; k < 2 && !r->failed; ++k) {
      const double *u = breccia_model_array(model, k ? "displacement y" : "displacement x");
      for (int64_t i = 0; i < breccia_model_places(model); ++i) {
        uint64_t word;
        memcpy(&word, &u[i], sizeof word);
        r->bits = (r->bits ^ word) * 1099511628211U;
      }
    }
    if (r->failed) fprintf(stderr, "%s\n", breccia_error_text(error));
    breccia_model_destroy(&model);
    breccia_error_destroy(&error);
    free(deck);
  }
  return NULL;
}

static void two_models_at_once_give_the_bits_of_each_alone(void **state)
{
  (void)state;
  enum { MODELS = 2 };
  Run runs[MODELS];
  uint64_t alone[MODELS];
  pthread_barrier_t begin;
  pthread_t thread[MODELS];
  for (int k = 0; k < MODELS; ++k) {
    runs[k] = (Run){20 + 7 * k, NULL, 0, 0};
    run_models(&runs[k]);
    assert_int_equal(runs[k].failed, 0);
    alone[k] = runs[k].bits;
  }
  assert_int_equal(pthread_barrier_init(&begin, NULL, MODELS), 0);
  for (int k = 0; k < MODELS; ++k) {
    runs[k] = (Run){20 + 7 * k, &begin, 0, 0};
    assert_int_equal(pthread_create(&thread[k], NULL, run_models, &runs[k]), 0);
  }
  for (int k = 0; k < MODELS; ++k) pthread_join(thread[k], NULL);
  pthread_barrier_destroy(&begin);
  for (int k = 0; k < MODELS; ++k) {
    assert_int_equal(runs[k].failed, 0);
    assert_true(runs[k].bits == alone[k]);
  }
}

/* ---- refused memory ---- */

/** Returns the address space that this process has taken, in bytes. */
static size_t address_space(void)
{
  size_t pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (!file || fscanf(file, "%zu", &pages) != 1) pages = 0;
  if (file) fclose(file);
  return pages * (size_t)sysconf(_SC_PAGESIZE);
}

/** Factors a full matrix and solves with it. Factors of 700 rows take 2 to 12 MB.
 *  @param[in] more  memory left, in bytes; 0: all */
static int factor_full(int64_t size, size_t more, Error *error)
{
  int64_t *first = malloc(sizeof *first * (size_t)(size + 1)), *column = malloc(sizeof *column * (size_t)(size * size));
  double *value = malloc(sizeof *value * (size_t)(size * size)), *x = calloc((size_t)size, sizeof *x);
  bool indefinite;
  for (int64_t k = 0; k < size * size; ++k) {
    column[k] = k % size;
    value[k] = k % (size + 1) ? 1 : 2.0 * (double)size;
  }
  for (int64_t k = 0; k <= size; ++k) first[k] = k * size;
  Factors *f = factors_create("test", error);
  struct rlimit limit;
  if (more && !getrlimit(RLIMIT_AS, &limit)) {
    limit.rlim_cur = address_space() + more;
    if (setrlimit(RLIMIT_AS, &limit)) _exit(12);
  }
  int status = factors_compute(f, &(SparseMatrix){size, first, column, value}, true, &indefinite, error);
  if (!status) status = factors_solve(f, x, error);
  factors_destroy(&f);
  free(first), free(column), free(value), free(x);
  return status;
}

/** Where less and less memory is left, in a process of its own each.
 *  @return 0: solved; 1: told that memory is out, 2: by the library, too */
static int factor_with_less(size_t more)
{
  const pid_t child = fork();
  int status = -1;
  if (child == 0) {
    Error *error = breccia_error_create();
    if (factor_full(200, 0, NULL)) _exit(10); /* the BLAS has its memory from now on */
    if (!factor_full(700, more, error)) _exit(0);
    const char *words = breccia_error_text(error);
    _exit(!strstr(words, "out of memory: test") ? 11 : strstr(words, ", in ") ? 2 : 1);
  }
  assert_true(child > 0 && waitpid(child, &status, 0) == child);
  if (!WIFEXITED(status) || WEXITSTATUS(status) > 2) fail_msg("%zu bytes left: status %x", more, (unsigned)status);
  return WEXITSTATUS(status);
}

static void refused_memory_is_an_error(void **state)
{
  (void)state;
  int by_library = 0;
  if (under_sanitizers()) return; /* they take memory of their own */
  assert_int_equal(factor_with_less((size_t)1 << 28), 0);
  for (size_t more = 16 << 20; more > 0; more -= 1 << 20) by_library += factor_with_less(more) == 2;
  assert_true(by_library > 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(refused_memory_is_an_error), /* first: others leave free memory to this process */
      cmocka_unit_test(solutions_are_those_of_dense_elimination),
      cmocka_unit_test(bits_do_not_depend_on_earlier_matrices),
      cmocka_unit_test(singular_matrices_leave_a_residual),
      cmocka_unit_test(two_models_at_once_give_the_bits_of_each_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
