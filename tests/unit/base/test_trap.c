/* Floating-point traps: what they note, that the computation stays as it is without them, and that nothing of them is left behind. */
#define _GNU_SOURCE /* fegetexcept */
#include "base/trap.h"
#include "support.h"

#include <fenv.h>
#include <float.h>
#include <signal.h>
#include <stdatomic.h>

static volatile double zero, large = DBL_MAX, small = DBL_MIN;
static _Thread_local volatile double sink;

static __attribute__((noinline)) void do_what_is_wrong(int what)
{
  switch (what) {
  case 0: sink = 1 / zero; return;
  case 1: sink = large * 10; return;
  case 2: sink = zero / zero; return;
  case 3: sink = small / 3 + 1 / 3.0; return;
  default: sink = NAN; sink = sink + 1;
  }
}

static void each_kind_is_noted_with_its_place(void **state)
{
  (void)state;
  if (!trap_is_possible()) skip();
  static const char *const words[] = {"division by zero in ", "overflow in ", "invalid operation in "};
  for (int what = 0; what < 5; ++what) {
    Trap trap;
    Text told = {0};
    trap_begin(&trap);
    for (int k = 0; k < 3; ++k) do_what_is_wrong(what); /* the first is noted, all go on */
    trap_end();
    assert_int_equal(trap_tell(&trap, &told), what < 3);
    if (what < 3) {
      assert_ptr_equal(strstr(told.characters, words[what]), told.characters);
      if (!strstr(told.characters, "do_what_is_wrong at test_trap.c:") && !strstr(told.characters, "test_trap+0x"))
        fail_msg("%s", told.characters);
    }
    assert_true(what == 0 || what == 1 ? isinf(sink) : what == 3 ? sink > 0 : isnan(sink));
    text_free(&told);
  }
}

/** In the C library the place is the line of ours that called it. */
static void a_function_of_the_c_library_is_told_by_its_caller(void **state)
{
  (void)state;
  if (!trap_is_possible()) skip();
  Trap trap;
  Text told = {0};
  trap_begin(&trap);
  sink = exp(large);
  const int line = __LINE__ - 1;
  trap_end();
  assert_true(trap_tell(&trap, &told));
  char place[64];
  snprintf(place, sizeof place, "test_trap.c:%d", line);
  if (!strstr(told.characters, place) && !strstr(told.characters, "test_trap+0x")) fail_msg("%s", told.characters);
  text_free(&told);
}

typedef struct Wrong {
  atomic_int done;
  bool last_only;
} Wrong;

static void do_wrong_on_threads(void *context)
{
  Wrong *w = context;
  TEAM_FOR (k, 600)
    if (!w->last_only || k >= 500) {
      do_what_is_wrong((int)k % 3);
      atomic_fetch_add(&w->done, !isfinite(sink));
    }
}

static void all_threads_of_a_team_are_under_the_trap_of_their_caller(void **state)
{
  (void)state;
  if (!trap_is_possible()) skip();
  Team *team = team_create(4, NULL);
  team_use(team);
  for (int k = 0; k < 2; ++k) {
    Trap trap;
    Text told = {0};
    Wrong wrong = {.last_only = k};
    trap_begin(&trap);
    team_run(do_wrong_on_threads, &wrong);
    trap_end();
    assert_int_equal(wrong.done, k ? 100 : 600);
    assert_true(trap_tell(&trap, &told));
    text_free(&told);
    wrong.done = 0;
    team_run(do_wrong_on_threads, &wrong); /* and afterwards under none */
    assert_int_equal(wrong.done, k ? 100 : 600);
  }
  team_use(NULL);
  team_destroy(&team);
}

static void overflow_on_threads(void *context)
{
  (void)context;
  do_what_is_wrong(1);
}

static void the_first_trap_is_told_and_not_the_last(void **state)
{
  (void)state;
  if (!trap_is_possible()) skip();
  Team *team = team_create(3, NULL);
  Trap trap;
  Text told = {0};
  team_use(team);
  trap_begin(&trap);
  do_what_is_wrong(0);
  team_run(overflow_on_threads, NULL);
  trap_end();
  team_use(NULL);
  team_destroy(&team);
  assert_true(trap_tell(&trap, &told));
  assert_ptr_equal(strstr(told.characters, "division by zero in "), told.characters);
  text_free(&told);
}

static volatile sig_atomic_t host_called;

static void handle_in_host(int number)
{
  (void)number;
  ++host_called;
}

static void the_host_keeps_its_handler_its_flags_and_its_traps(void **state)
{
  (void)state;
  if (!trap_is_possible()) skip();
  struct sigaction action = {.sa_handler = handle_in_host}, usual, after;
  sigaction(SIGFPE, &action, &usual);
  feclearexcept(FE_ALL_EXCEPT);
  feraiseexcept(FE_UNDERFLOW);
  sigset_t blocked, mask;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGFPE);
  pthread_sigmask(SIG_BLOCK, &blocked, NULL);
  Trap trap;
  trap_begin(&trap);
  do_what_is_wrong(0); /* also where the host blocks the signal */
  trap_end();
  assert_true(trap.kind != 0);
  pthread_sigmask(SIG_UNBLOCK, &blocked, &mask);
  assert_int_equal(sigismember(&mask, SIGFPE), 1);
  assert_int_equal(fetestexcept(FE_ALL_EXCEPT), FE_UNDERFLOW);
  assert_int_equal(fegetexcept(), 0);
  assert_int_equal(sigaction(SIGFPE, NULL, &after), 0);
  assert_ptr_equal(after.sa_handler, handle_in_host);
  trap_begin(&trap);
  raise(SIGFPE); /* from elsewhere */
  assert_int_equal(host_called, 1);
  trap_end();
  assert_int_equal(trap.kind, 0);
  sigaction(SIGFPE, &usual, NULL);
  feclearexcept(FE_ALL_EXCEPT);
}

/* ---- runs ---- */

static int prepare(const double *values, void *constants, char *reason, size_t reason_size)
{
  (void)values, (void)constants, (void)reason, (void)reason_size;
  return 0;
}

static void give_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = *shear = 1e4;
}

/** Linear elastic; where it has come to 2 % strain it divides by zero to no effect, as careless code does. */
static int update(const void *constants, const breccia_batch *b)
{
  (void)constants;
  for (int i = 0; i < b->count; ++i) {
    const double *const *e = b->strain;
    const double trace = e[0][i] + e[1][i] + e[2][i];
    for (int k = 0; k < 3; ++k) b->stress[k][i] = 1e4 * trace + 2e4 * (e[k][i] - trace / 3);
    for (int k = 3; k < 6; ++k) b->stress[k][i] = 1e4 * e[k][i];
    if (e[0][i] > 0.02) do_what_is_wrong(0);
  }
  return -1;
}

static const breccia_law careless = {.size = sizeof careless,
                                     .name = "careless",
                                     .about = "divides by zero",
                                     .source = "none",
                                     .maturity = "experimental",
                                     .components = 6,
                                     .prepare = prepare,
                                     .moduli = give_moduli,
                                     .update = update};

static breccia_model *pulled(int threads, int trap)
{
  static const breccia_law *const laws[] = {&careless};
  const breccia_options options = {
      .size = sizeof(breccia_options), .laws = laws, .law_count = 1, .threads = threads, .trap = trap};
  breccia_error *error = breccia_error_create();
  breccia_model *m = NULL;
  const char *deck = "materials: {c: {model: careless, density: 2}}\n"
                     "body: {b: {material: c, spacing: 0.1, shape: {box: {particles: [12, 4, 4]}}}}\n"
                     "loads: [{on: {face: x-, layers: 3}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 3}, velocity: "
                     "[2, 0, 0]}]\nsolve: {explicit: {steps: 100}}\n";
  if (breccia_model_load_string(deck, "deck", &options, &m, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return m;
}

static void a_run_stops_at_the_first_trap_and_is_the_same_up_to_it(void **state)
{
  (void)state;
  if (!trap_is_possible()) skip();
  for (int threads = 1; threads <= 3; threads += 2) {
    breccia_model *plain = pulled(threads, 0), *trapped = pulled(threads, 1);
    breccia_error *error = breccia_error_create();
    int status = 0;
    while (!status && breccia_model_steps_done(plain) < 100) {
      assert_int_equal(breccia_model_step(plain, 1, NULL), 0);
      status = breccia_model_step(trapped, 1, error);
      const size_t bytes = sizeof(double) * (size_t)breccia_model_places(plain);
      for (int k = 0; k < 3; ++k)
        assert_memory_equal(plain->domain.particles->velocity.row[k], trapped->domain.particles->velocity.row[k],
                            bytes);
    }
    assert_int_equal(status, BRECCIA_FAILURE);
    double strain = 0;
    for (int64_t k = 0; k < breccia_model_places(plain); ++k) strain = larger_of(strain, plain->domain.strain[0][k]);
    assert_true(strain > 0.02 && strain < 0.03); /* the very step */
    char words[128];
    snprintf(words, sizeof words, "step %lld (time %g s): floating-point trap: division by zero in ",
             (long long)breccia_model_steps_done(plain), breccia_model_time(plain));
    if (!strstr(breccia_error_text(error), words)) fail_msg("%s", breccia_error_text(error));
    assert_true(ledger_is_doubtful(&trapped->solver.ledger)); /* so that the checkpoint before stays */
    breccia_error_destroy(&error);
    breccia_model_destroy(&plain);
    breccia_model_destroy(&trapped);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_kind_is_noted_with_its_place),
      cmocka_unit_test(a_function_of_the_c_library_is_told_by_its_caller),
      cmocka_unit_test(all_threads_of_a_team_are_under_the_trap_of_their_caller),
      cmocka_unit_test(the_first_trap_is_told_and_not_the_last),
      cmocka_unit_test(the_host_keeps_its_handler_its_flags_and_its_traps),
      cmocka_unit_test(a_run_stops_at_the_first_trap_and_is_the_same_up_to_it),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
