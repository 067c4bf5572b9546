/* Threads that work together: what they share out, what they cost while they wait, and that they leave nothing behind. Costs are in
 * time of processors, which does not depend on who else uses the machine. */
#define _GNU_SOURCE /* sched_setaffinity */
#include "support.h"

#include "base/cores.h"
#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/stat.h>
#include <time.h>

static double processor_seconds(clockid_t clock)
{
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

typedef struct Tally {
  int64_t count;
  int *visits;        /* [count] */
  int64_t sum, turns; /* of what TEAM_SINGLE finds */
  atomic_int callers, unmasked;
} Tally;

static void visit(void *context, int64_t k)
{
  ((Tally *)context)->visits[k] += 1;
}

static void tally(void *context)
{
  Tally *t = context;
  atomic_fetch_add(&t->callers, 1);
  sigset_t mask;
  pthread_sigmask(SIG_SETMASK, NULL, &mask);
  if (!sigismember(&mask, SIGINT)) atomic_fetch_add(&t->unmasked, 1);
  for (int round = 1; round <= 50; ++round) {
    TEAM_FOR (k, t->count) t->visits[k] = (int)k * round;
    TEAM_SINGLE
    {
      t->sum = 0;
      for (int64_t k = 0; k < t->count; ++k) t->sum += t->visits[k];
      t->turns += t->sum == t->count * (t->count - 1) / 2 * round;
    }
    TEAM_FOR (k, t->count) t->visits[k] = t->sum == t->count * (t->count - 1) / 2 * round ? 0 : -1;
  }
  for (int k = 0; k < 64; ++k)
    if (team_turn(k)) atomic_fetch_add(&t->callers, 100);
  TEAM_SINGLE team_each(t->count, visit, t); /* by one thread: whole */
}

static void loops_are_shared_out_and_waited_for(void **state)
{
  (void)state;
  for (int threads = 1; threads <= 9; ++threads) {
    Team *team = team_create(threads, NULL);
    assert_int_equal(team_threads(team), threads);
    assert_null(team_use(team));
    for (int64_t count = 0; count < 40; count += 3) {
      Tally t = {.count = count, .visits = calloc((size_t)count + 1, sizeof(int))};
      team_run(tally, &t);
      assert_int_equal(t.callers, threads + 6400);
      assert_int_equal(t.unmasked, 1); /* signals go to the thread that calls */
      assert_int_equal(t.turns, 50);
      for (int64_t k = 0; k < count; ++k) assert_int_equal(t.visits[k], 1);
      team_each(count, visit, &t);
      for (int64_t k = 0; k < count; ++k) assert_int_equal(t.visits[k], 2);
      free(t.visits);
    }
    assert_ptr_equal(team_use(NULL), team);
    team_destroy(&team);
    assert_null(team);
  }
}

static void without_a_team_one_thread_does_all(void **state)
{
  (void)state;
  Tally t = {.count = 7, .visits = calloc(7, sizeof(int))};
  team_run(tally, &t);
  assert_int_equal(t.callers, 6401);
  assert_int_equal(t.turns, 50);
  TEAM_FOR (k, t.count) visit(&t, k);
  TEAM_SINGLE t.sum = 77;
  assert_int_equal(t.sum, 77);
  for (int64_t k = 0; k < t.count; ++k) assert_int_equal(t.visits[k], 2);
  free(t.visits);
}

static void keep_one_busy(void *context)
{
  (void)context;
  TEAM_SINGLE
  {
    const double end = processor_seconds(CLOCK_THREAD_CPUTIME_ID) + 0.2;
    while (processor_seconds(CLOCK_THREAD_CPUTIME_ID) < end) continue;
  }
}

static void those_who_wait_sleep(void **state)
{
  (void)state;
  for (int threads = 2; threads <= 8; threads *= 2) {
    Team *team = team_create(threads, NULL);
    team_use(team);
    const double start = processor_seconds(CLOCK_PROCESS_CPUTIME_ID);
    team_run(keep_one_busy, NULL);
    const double cost = processor_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    if (cost > 0.25) fail_msg("%d threads took %.3f s while one of them worked for 0.2 s", threads, cost);
    team_use(NULL);
    team_destroy(&team);
  }
}

/** Lets all threads of this process run on the first `cores` of those in `allowed` only. */
static void confine(const cpu_set_t *allowed, int cores)
{
  cpu_set_t some;
  CPU_ZERO(&some);
  for (size_t k = 0; k < CPU_SETSIZE && CPU_COUNT(&some) < cores; ++k)
    if (CPU_ISSET(k, allowed)) CPU_SET(k, &some);
  DIR *tasks = opendir("/proc/self/task");
  for (struct dirent *task; tasks && (task = readdir(tasks));)
    if (*task->d_name != '.') sched_setaffinity(atoi(task->d_name), sizeof some, &some);
  if (tasks) closedir(tasks);
}

static int threads_of_process(void)
{
  DIR *tasks = opendir("/proc/self/task");
  int count = 0;
  while (tasks && readdir(tasks)) ++count;
  if (tasks) closedir(tasks);
  return count - 2;
}

static breccia_model *small_body(int threads)
{
  breccia_model *model = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {model: elastic, density: 2.4, Young modulus: "
      "3e7, Poisson ratio: 0.2}}\nbody: {b: {material: m, spacing: 0.1, shape: {box: {particles: [24, 24, "
      "20]}}}}\nloads: [{on: {face: x+, layers: 2}, velocity: [1, 0, 0]}]\nsolve: {explicit: {steps: 100000}}\n");
  model->threads = threads;
  breccia_model_step(model, 1, NULL);
  return model;
}

static double cost_of_steps(breccia_model *model)
{
  const double start = processor_seconds(CLOCK_PROCESS_CPUTIME_ID);
  breccia_model_step(model, 150, NULL);
  return processor_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
}

/** Two cores and eight threads; then two threads that were begun on two cores and must make do with one, as where somebody else has
 *  taken the other. Neighbours that use the machine make it dearer now and then: one good try of twelve is enough. Sanitizers, whose
 *  looks take many times as long and whose cost is nobody's, are not asked. */
static void steps_cost_little_more_where_cores_are_too_few(void **state)
{
  (void)state;
  if (under_sanitizers()) skip();
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed)) skip();
  confine(&allowed, 2);
  breccia_model *one = small_body(1), *many = small_body(4 * cores_available()), *two = small_body(2);
  const double most_many = 2.5,
               most_two = 1.5; /* threads that look for their turn all the time take ten times as long */
  double best_many = INFINITY, best_two = INFINITY;
  for (int k = 0; k < 40 && (best_many > most_many || best_two > most_two); ++k) {
    confine(&allowed, 2);
    best_many = fmin(best_many, cost_of_steps(many) / cost_of_steps(one));
    confine(&allowed, 1);
    best_two = fmin(best_two, cost_of_steps(two) / cost_of_steps(one));
  }
  breccia_model_destroy(&one);
  breccia_model_destroy(&many);
  breccia_model_destroy(&two);
  confine(&allowed, CPU_SETSIZE);
  if (best_many > most_many) fail_msg("eight threads on two cores took %.2f times what one does", best_many);
  if (best_two > most_two) fail_msg("two threads on one core took %.2f times what one does", best_two);
}

static void a_model_takes_its_threads_along(void **state)
{
  (void)state;
  const int before = threads_of_process();
  if (before < 1) skip(); /* no Linux */
  breccia_model *model = small_body(3);
  assert_int_equal(threads_of_process(), before + 2);
  assert_null(team_use(NULL)); /* none of the model's threads is left to its caller */
  breccia_model_destroy(&model);
  assert_int_equal(threads_of_process(), before);
}

static void write_words(const char *path, const char *words)
{
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(words, file);
  fclose(file);
}

static void make_folders(const char *const *paths)
{
  for (; *paths; ++paths)
    if (mkdir(*paths, 0777)) assert_int_equal(errno, EEXIST);
}

static void a_share_of_the_processor_limits_the_cores(void **state)
{
  (void)state;
  make_folders(
      (const char *[]){"groups", "groups/a", "groups/a/b", "groups/cpu,cpuacct", "groups/cpu,cpuacct/c", NULL});
  for (const char *const *old =
           (const char *[]){"groups/a/b/cpu.max", "groups/a/cpu.max", "groups/cpu,cpuacct/c/cpu.cfs_period_us",
                            "groups/cpu,cpuacct/c/cpu.cfs_quota_us", NULL};
       *old; ++old)
    remove(*old);
  write_words("groups/none", "");
  write_words("groups/member", "0::/a/b\n");
  write_words("groups/old", "7:memory:/a\n4:cpu,cpuacct:/c\n0::/\n");
  write_words("groups/contained", "0::/of/the/host\n");
  assert_true(isinf(cores_of_groups("groups", "groups/none")));
  assert_true(isinf(cores_of_groups("groups", "groups/nowhere")));
  assert_true(isinf(cores_of_groups("groups", "groups/member")));
  write_words("groups/a/b/cpu.max", "max 100000\n");
  assert_true(isinf(cores_of_groups("groups", "groups/member")));
  write_words("groups/a/cpu.max", "250000 100000\n");
  assert_near(cores_of_groups("groups", "groups/member"), 2.5, 0);
  write_words("groups/a/b/cpu.max", "50000 100000\n");
  assert_near(cores_of_groups("groups", "groups/member"), 0.5, 0);
  assert_true(isinf(cores_of_groups("groups", "groups/contained")));
  write_words("groups/cpu.max", "30000 20000\n");
  assert_near(cores_of_groups("groups", "groups/contained"), 1.5, 0);
  assert_near(cores_of_groups("groups", "groups/member"), 0.5, 0);
  remove("groups/cpu.max");
  write_words("groups/cpu,cpuacct/c/cpu.cfs_period_us", "100000\n");
  write_words("groups/cpu,cpuacct/c/cpu.cfs_quota_us", "-1\n");
  assert_true(isinf(cores_of_groups("groups", "groups/old")));
  write_words("groups/cpu,cpuacct/c/cpu.cfs_quota_us", "400000\n");
  assert_near(cores_of_groups("groups", "groups/old"), 4, 0);
}

static void a_machine_tells_how_many_threads_want_to_run(void **state)
{
  (void)state;
  write_words("loadavg", "0.85 1.04 0.97 11/423 30512\n");
  assert_int_equal(threads_running("loadavg"), 11);
  write_words("loadavg", "nothing of use\n");
  assert_int_equal(threads_running("loadavg"), 0);
  assert_int_equal(threads_running("no such file"), 0);
  remove("loadavg");
}

static void the_environment_says_how_many_threads(void **state)
{
  (void)state;
  Text warning = {0};
  const struct {
    const char *words;
    int threads; /* 0: one per core, and a warning */
  } cases[] = {{"3", 3}, {"5,2", 5}, {"0", 0}, {"many", 0}, {"2 threads", 0}, {"-1", 0}, {"99999", 0}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    setenv("OMP_NUM_THREADS", cases[k].words, 1);
    const int threads = threads_by_default(&warning);
    assert_int_equal(threads, cases[k].threads ? cases[k].threads : cores_available());
    assert_int_equal(warning.length > 0, cases[k].threads == 0);
    text_free(&warning);
  }
  unsetenv("OMP_NUM_THREADS");
  assert_int_equal(threads_by_default(&warning), cores_available());
  assert_int_equal(warning.length, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loops_are_shared_out_and_waited_for),
      cmocka_unit_test(without_a_team_one_thread_does_all),
      cmocka_unit_test(those_who_wait_sleep),
      cmocka_unit_test(steps_cost_little_more_where_cores_are_too_few),
      cmocka_unit_test(a_model_takes_its_threads_along),
      cmocka_unit_test(a_share_of_the_processor_limits_the_cores),
      cmocka_unit_test(a_machine_tells_how_many_threads_want_to_run),
      cmocka_unit_test(the_environment_says_how_many_threads),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
