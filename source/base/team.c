#include "base/team.h"

#include "base/clock.h"
#include "base/cores.h"
#include "base/memory.h"
#include "base/plain_locale.h"
#include "base/trap.h"
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A thread looks for about as long as it takes to wake one that sleeps: then it never loses more than twice what the better of the two
 * would have cost. Where looking was in vain the next look is shorter. */
#define LONGEST_LOOK 5e-5
#define SHORTEST_LOOK 2e-6
enum { LOOKS = 32 }; /* between two readings of the clock */

struct Team {
  int threads; /* with the one that calls team_run */
  int started;
  bool patient; /* there is a core for each: looking takes nothing from anybody */
  void (*work)(void *context);
  void *context;
  Trap *trap; /* that work is done under; NULL: none */
  bool ends;
  pid_t process; /* that has the threads */
  pthread_mutex_t lock;
  pthread_cond_t changed;
  _Alignas(64) atomic_uint round;   /* of work given out */
  _Alignas(64) atomic_uint turn;    /* of waiting for each other */
  _Alignas(64) atomic_int arrived;  /* in this turn */
  _Alignas(64) atomic_int sleepers; /* of which the lock is held or waited for */
  pthread_t *thread;
  struct Place {
    Team *team;
    int rank;
  } * places;
};

/* What a thread knows of itself. */
static _Thread_local struct {
  Team *team;  /* that team_run uses */
  bool inside; /* of a team_run */
  int rank, size;
  double look;
} own = {.size = 1, .look = LONGEST_LOOK};

static void relax(void)
{
#if defined __x86_64__ || defined __i386__
  __builtin_ia32_pause();
#elif defined __aarch64__
  __asm__ volatile("yield");
#endif
}

/** @return true if `word` is no longer `old` */
static bool look(atomic_uint *word, unsigned old)
{
  double begin = 0;
  for (;;) {
    for (int k = 0; k < LOOKS; ++k) {
      if (atomic_load_explicit(word, memory_order_acquire) != old) return true;
      relax();
    }
    const double now = clock_seconds();
    if (begin == 0) begin = now;
    if (now - begin > own.look) return false;
  }
}

static void wait_for_change(Team *team, atomic_uint *word, unsigned old)
{
  if (team->patient && look(word, old)) {
    own.look = fmin(2 * own.look, LONGEST_LOOK);
    return;
  }
  own.look = fmax(own.look / 2, SHORTEST_LOOK);
  pthread_mutex_lock(&team->lock);
  /* Either this thread sees the change, or who makes it sees a sleeper and must wait for the lock to wake it. */
  atomic_fetch_add(&team->sleepers, 1);
  while (atomic_load(word) == old) pthread_cond_wait(&team->changed, &team->lock);
  atomic_fetch_sub(&team->sleepers, 1);
  pthread_mutex_unlock(&team->lock);
}

static void change(Team *team, atomic_uint *word)
{
  atomic_fetch_add(word, 1);
  if (!atomic_load(&team->sleepers)) return;
  pthread_mutex_lock(&team->lock); /* until all sleepers do sleep */
  pthread_mutex_unlock(&team->lock);
  pthread_cond_broadcast(&team->changed);
}

void team_wait(void)
{
  if (own.size == 1) return;
  Team *team = own.team;
  const unsigned turn = atomic_load_explicit(&team->turn, memory_order_relaxed);
  if (atomic_fetch_add(&team->arrived, 1) + 1 < own.size) {
    wait_for_change(team, &team->turn, turn);
    return;
  }
  atomic_store_explicit(&team->arrived, 0, memory_order_relaxed);
  change(team, &team->turn);
}

static void *serve(void *given)
{
  const struct Place *place = given;
  Team *team = place->team;
  locale_plain();
  own.team = team;
  own.inside = true;
  own.rank = place->rank;
  own.size = team->threads;
  for (unsigned round = 0;; ++round) {
    wait_for_change(team, &team->round, round);
    if (team->ends) return NULL;
    if (team->trap) trap_join(team->trap);
    team->work(team->context);
    if (team->trap) trap_leave();
    team_wait();
  }
}

/** Sweeps keep up to 2 MB in their frames; some systems, and limits of shells, give threads less. @return 0, or what is wrong */
static int set_stack(pthread_attr_t *attributes)
{
  const size_t enough = (size_t)8 << 20;
  size_t size = 0;
  const int bad = pthread_attr_getstacksize(attributes, &size);
  return bad || size >= enough ? bad : pthread_attr_setstacksize(attributes, enough);
}

static int start(Team *team, Error *error)
{
  pthread_attr_t attributes;
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  int bad = pthread_attr_init(&attributes);
  if (!bad) bad = set_stack(&attributes);
  while (!bad && team->started < team->threads - 1) {
    struct Place *place = &team->places[team->started];
    *place = (struct Place){team, team->started + 1};
    bad = pthread_create(&team->thread[team->started], &attributes, serve, place);
    if (!bad) ++team->started;
  }
  pthread_attr_destroy(&attributes);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  if (bad)
    error_add(error, BRECCIA_FAILURE, "only %d of %d threads could be started: %s; ask for fewer", team->started + 1,
              team->threads, strerror(bad));
  return bad;
}

Team *team_create(int threads, Error *error)
{
  Team *team = memory_zeroed(1, sizeof *team, "threads", error);
  if (!team) return NULL;
  pthread_mutex_init(&team->lock, NULL);
  pthread_cond_init(&team->changed, NULL);
  team->threads = threads;
  team->process = getpid();
  team->patient = threads <= cores_available();
  team->thread = memory_zeroed((size_t)threads, sizeof *team->thread, "threads", error);
  team->places = memory_zeroed((size_t)threads, sizeof *team->places, "threads", error);
  if (!team->thread || !team->places || start(team, error)) team_destroy(&team);
  return team;
}

void team_destroy(Team **out)
{
  Team *team = *out;
  *out = NULL;
  if (!team) return;
  if (!team_is_foreign(team)) { /* after a fork nobody is there to be waited for, and the lock may be held for ever */
    team->ends = true;
    change(team, &team->round);
    for (int k = 0; k < team->started; ++k) pthread_join(team->thread[k], NULL);
    pthread_cond_destroy(&team->changed);
    pthread_mutex_destroy(&team->lock);
  }
  free(team->thread);
  free(team->places);
  free(team);
}

int team_threads(const Team *team)
{
  return team ? team->threads : 1;
}

bool team_is_foreign(const Team *team)
{
  return team && team->started > 0 && team->process != getpid();
}

Team *team_use(Team *team)
{
  Team *before = own.team;
  own.team = team;
  return before;
}

void team_run(void (*work)(void *context), void *context)
{
  Team *team = own.team;
  const bool inside = own.inside;
  const int rank = own.rank, size = own.size;
  const bool alone = inside || team_threads(team) == 1;
  own.inside = true;
  own.rank = 0;
  own.size = alone ? 1 : team->threads;
  if (!alone) {
    team->work = work;
    team->context = context;
    team->trap = trap_of_thread();
    change(team, &team->round);
  }
  work(context);
  team_wait();
  own.inside = inside;
  own.rank = rank;
  own.size = size;
}

typedef struct Each {
  int64_t count;
  void (*work)(void *context, int64_t index);
  void *context;
} Each;

static void work_each(void *context)
{
  const Each *each = context;
  TEAM_FOR (k, each->count) each->work(each->context, k);
}

void team_each(int64_t count, void (*work)(void *context, int64_t index), void *context)
{
  Each each = {count, work, context};
  team_run(work_each, &each);
}

int team_size(void)
{
  return own.size;
}

int team_rank(void)
{
  return own.rank;
}

int team_called(void)
{
  return own.inside ? 1 : team_threads(own.team);
}

TeamShare team_share_of(int64_t count, int thread)
{
  const int64_t part = count / own.size, more = count % own.size;
  const int64_t first = thread * part + (thread < more ? thread : more);
  return (TeamShare){first, first + part + (thread < more), true};
}

TeamShare team_share(int64_t count)
{
  return team_share_of(count, own.rank);
}

bool team_turn(int64_t number)
{
  return number % own.size == own.rank;
}
