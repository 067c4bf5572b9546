#define _GNU_SOURCE /* feenableexcept, dladdr, registers of a context */
#include "base/trap.h"

#include "base/program.h"
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The handler sets a thread's traps back in the registers that it returns to, so that the instruction is done again without them. */
#if defined __linux__ && defined __x86_64__ && defined __GLIBC__
#include <dlfcn.h>
#include <execinfo.h>
#include <fenv.h>
#include <pthread.h>
#include <ucontext.h>

static _Thread_local struct {
  Trap *trap;
  fenv_t before;
  sigset_t mask;
} own;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int users; /* of the handler */
static struct sigaction before_us;

bool trap_is_possible(void)
{
  return true;
}

/* A trap comes from an instruction of its own thread, in the middle of arithmetic: no lock or memory of libraries is in use there. */
static void on_trap(int number, siginfo_t *info, void *context)
{
  Trap *trap = own.trap;
  if (!trap || info->si_code <= 0) { /* of others: who comes after us decides */
    sigaction(number, &before_us, NULL);
    raise(number);
    return;
  }
  int none = 0;
  if (atomic_compare_exchange_strong(&trap->kind, &none, info->si_code)) {
    trap->place = info->si_addr;
    trap->count = backtrace(trap->frames, TRAP_FRAMES);
  }
  ucontext_t *state = context;
  const unsigned kinds = FE_ALL_EXCEPT | 0x2; /* with the processor's own, of numbers too small */
  state->uc_mcontext.fpregs->mxcsr = (state->uc_mcontext.fpregs->mxcsr | kinds << 7) & ~kinds;
  state->uc_mcontext.fpregs->cwd |= (uint16_t)kinds;
  state->uc_mcontext.fpregs->swd &= (uint16_t) ~(kinds | 0x8080);
}

void trap_join(Trap *trap)
{
  sigset_t ours;
  sigemptyset(&ours);
  sigaddset(&ours, SIGFPE);
  pthread_sigmask(SIG_UNBLOCK, &ours, &own.mask); /* a trap that is blocked ends the process */
  own.trap = trap;
  feholdexcept(&own.before);
  feenableexcept(FE_DIVBYZERO | FE_OVERFLOW | FE_INVALID);
}

void trap_leave(void)
{
  fesetenv(&own.before);
  own.trap = NULL;
  pthread_sigmask(SIG_SETMASK, &own.mask, NULL);
}

void trap_begin(Trap *trap)
{
  *trap = (Trap){0};
  pthread_mutex_lock(&lock);
  if (users++ == 0) {
    struct sigaction action = {.sa_sigaction = on_trap, .sa_flags = SA_SIGINFO};
    void *frame;
    backtrace(&frame, 1); /* loads what it needs, which no handler may */
    sigaction(SIGFPE, &action, &before_us);
  }
  pthread_mutex_unlock(&lock);
  trap_join(trap);
}

void trap_end(void)
{
  trap_leave();
  pthread_mutex_lock(&lock);
  if (--users == 0) sigaction(SIGFPE, &before_us, NULL);
  pthread_mutex_unlock(&lock);
}

Trap *trap_of_thread(void)
{
  return own.trap;
}

static const char *kind_words(int kind)
{
  switch (kind) {
  case FPE_FLTDIV: return "division by zero";
  case FPE_FLTOVF: return "overflow";
  case FPE_INTDIV:
  case FPE_INTOVF: return "division of whole numbers";
  default: return "invalid operation";
  }
}

/** The function and line of an address, by the binutils if they are there and the program has its symbols. */
static void add_line(const Dl_info *module, uintptr_t address, Text *words)
{
  char offset[32], program[64];
  snprintf(offset, sizeof offset, "%#lx", (unsigned long)(address - (uintptr_t)module->dli_fbase));
  /* The program itself goes by the name that it was called by. */
  snprintf(program, sizeof program, "/proc/%ld/exe", (long)getpid());
  const char *file = strchr(module->dli_fname, '/') ? module->dli_fname : program;
  const char *const ask[] = {"addr2line", "-f", "-i", "-p", "-s", "-e", file, offset, NULL};
  Text answer = {0}, reason = {0};
  const bool known = program_ask(ask, &answer, &reason) == PROGRAM_DONE && *text_words(&answer) != '?';
  const char *name = strrchr(module->dli_fname, '/') ? strrchr(module->dli_fname, '/') + 1 : module->dli_fname;
  if (known)
    text_add(words, "%s", text_words(&answer));
  else
    text_add(words, "%s+%s", name, offset);
  text_free(&answer);
  text_free(&reason);
}

bool trap_tell(const Trap *trap, Text *words)
{
  if (!trap->kind) return false;
  text_add(words, "%s in ", kind_words(trap->kind));
  /* From the instruction outwards to the first function of ours: in the C library it says little. */
  Dl_info ours, there;
  int k = 0;
  while (k < trap->count && trap->frames[k] != trap->place) ++k;
  uintptr_t address = (uintptr_t)trap->place;
  const bool known = dladdr((void *)(uintptr_t)trap_tell, &ours);
  bool found = dladdr(trap->place, &there);
  while (found && known && there.dli_fbase != ours.dli_fbase && ++k < trap->count) {
    address = (uintptr_t)trap->frames[k] - 1; /* within the call: behind it the next line may begin */
    found = dladdr((void *)address, &there);
  }
  if (found)
    add_line(&there, address, words);
  else
    text_add(words, "%p", trap->place);
  return true;
}

#else

bool trap_is_possible(void)
{
  return false;
}
void trap_begin(Trap *trap)
{
  *trap = (Trap){0};
}
void trap_end(void)
{
}
bool trap_tell(const Trap *trap, Text *words)
{
  (void)trap, (void)words;
  return false;
}
Trap *trap_of_thread(void)
{
  return NULL;
}
void trap_join(Trap *trap)
{
  (void)trap;
}
void trap_leave(void)
{
}

#endif
