/* Makes one of a command's calls for memory fail, or all from that one on. Either preloaded before the command, or, where a sanitizer has
 * functions for memory of its own, linked into it with WRAPPED defined and --wrap for each of the functions: then only calls of the program
 * itself come here.
 * BRECCIA_FAIL_AT=N      the N-th call from 1; 0 only counts
 * BRECCIA_FAIL_ON=1      and all that come after it
 * BRECCIA_FAIL_WHOSE=all calls of the libraries too; otherwise those of the program itself, by the address they return to
 * BRECCIA_FAIL_COUNT=F   file that takes the number of calls when the program ends
 * A preloaded one ends a command that does not come to an end, and says in whose code that was, or a crash. What the program starts in its turn is left alone. For glibc, whose own names for
 * the functions are used, so that nothing must be looked up while memory is being given. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#ifdef WRAPPED
#define OURS(name) __wrap_##name
#define GIVE_MALLOC __real_malloc
#define GIVE_CALLOC __real_calloc
#define GIVE_REALLOC __real_realloc
#define GIVE_ALIGNED __real_aligned_alloc
#else
#define OURS(name) name
#define GIVE_MALLOC __libc_malloc
#define GIVE_CALLOC __libc_calloc
#define GIVE_REALLOC __libc_realloc
#define GIVE_ALIGNED __libc_memalign
#endif

void *GIVE_MALLOC(size_t size);
void *GIVE_CALLOC(size_t count, size_t size);
void *GIVE_REALLOC(void *memory, size_t size);
void *GIVE_ALIGNED(size_t alignment, size_t size);

static uintptr_t first_byte, last_byte; /* of the program */
static atomic_long calls;
static long fail_at;
static bool counting, all_from_there, everybody;
static char count_file[4096];

/** The program is the first of all that is loaded. */
static int find_program(struct dl_phdr_info *info, size_t size, void *context)
{
  (void)size, (void)context;
  first_byte = UINTPTR_MAX;
  for (int k = 0; k < info->dlpi_phnum; ++k) {
    if (info->dlpi_phdr[k].p_type != PT_LOAD) continue;
    const uintptr_t from = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr, to = from + info->dlpi_phdr[k].p_memsz;
    if (from < first_byte) first_byte = from;
    if (to > last_byte) last_byte = to;
  }
  return 1;
}

#ifndef WRAPPED
enum { LONGEST = 30 }; /* s that the processor may work; a run takes a tenth of one */

/** Says in whose code the program crashes or stays: the innermost that is neither the system's nor here. */
static void tell_end(int number)
{
  void *frames[64];
  Dl_info here, at;
  const int count = backtrace(frames, 64);
  const char *whose = "unknown";
  dladdr((void *)tell_end, &here);
  for (int k = 0; k < count; ++k) {
    if (!dladdr(frames[k], &at) || !at.dli_fname || at.dli_fbase == here.dli_fbase) continue;
    const char *slash = strrchr(at.dli_fname, '/'), *name = slash ? slash + 1 : at.dli_fname;
    if (!strncmp(name, "libc.", 5) || !strncmp(name, "ld-", 3)) continue;
    whose = name;
    break;
  }
  char words[256];
  const int length = snprintf(words, sizeof words, "%s in %s\n", number == SIGVTALRM ? "no end" : "crash", whose);
  if (write(STDERR_FILENO, words, (size_t)length) != length) _exit(1);
  signal(number, SIG_DFL);
  raise(number);
}

static void watch(void)
{
  void *frame;
  backtrace(&frame, 1); /* loads what it needs */
  for (int k = 0; k < 5; ++k) signal((const int[]){SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGVTALRM}[k], tell_end);
  setitimer(ITIMER_VIRTUAL, &(struct itimerval){.it_value.tv_sec = LONGEST}, NULL);
}
#else
static void watch(void)
{
}
#endif

__attribute__((constructor)) static void begin(void)
{
  const char *at = getenv("BRECCIA_FAIL_AT"), *on = getenv("BRECCIA_FAIL_ON"), *whose = getenv("BRECCIA_FAIL_WHOSE"),
             *file = getenv("BRECCIA_FAIL_COUNT");
  if (!at) return;
  dl_iterate_phdr(find_program, NULL);
  fail_at = atol(at);
  all_from_there = on && *on == '1';
  everybody = whose && !strcmp(whose, "all");
  if (file) snprintf(count_file, sizeof count_file, "%s", file);
  unsetenv("LD_PRELOAD");
  watch();
  counting = true;
}

/** The number of calls, for those who walk them. */
__attribute__((destructor)) static void end(void)
{
  char words[32];
  if (!*count_file) return;
  const int file = open(count_file, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int length = snprintf(words, sizeof words, "%ld\n", atomic_load(&calls));
  if (file < 0 || write(file, words, (size_t)length) != length) abort();
  close(file);
}

static bool refuses(const void *caller)
{
  if (!counting || (!everybody && ((uintptr_t)caller < first_byte || (uintptr_t)caller >= last_byte))) return false;
  const long call = atomic_fetch_add(&calls, 1) + 1;
  if (!fail_at || call < fail_at || (call > fail_at && !all_from_there)) return false;
  errno = ENOMEM;
  return true;
}

void *OURS(malloc)(size_t size)
{
  return refuses(__builtin_return_address(0)) ? NULL : GIVE_MALLOC(size);
}

void *OURS(calloc)(size_t count, size_t size)
{
  return refuses(__builtin_return_address(0)) ? NULL : GIVE_CALLOC(count, size);
}

void *OURS(realloc)(void *memory, size_t size)
{
  return refuses(__builtin_return_address(0)) ? NULL : GIVE_REALLOC(memory, size);
}

void *OURS(aligned_alloc)(size_t alignment, size_t size)
{
  return refuses(__builtin_return_address(0)) ? NULL : GIVE_ALIGNED(alignment, size);
}

#ifndef WRAPPED

int posix_memalign(void **memory, size_t alignment, size_t size)
{
  if (refuses(__builtin_return_address(0))) return ENOMEM;
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}

char *strndup(const char *words, size_t most)
{
  const size_t length = strnlen(words, most);
  char *copy = refuses(__builtin_return_address(0)) ? NULL : __libc_malloc(length + 1);
  if (!copy) return NULL;
  memcpy(copy, words, length);
  copy[length] = 0;
  return copy;
}

char *strdup(const char *words)
{
  const size_t length = strlen(words) + 1;
  char *copy = refuses(__builtin_return_address(0)) ? NULL : __libc_malloc(length);
  return copy ? memcpy(copy, words, length) : NULL;
}

#endif
