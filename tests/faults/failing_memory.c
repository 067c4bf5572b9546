/* Preloaded before the command: makes one of its calls for memory fail, or all from that one on.
 * BRECCIA_FAIL_AT=N      the N-th call from 1; 0 only counts
 * BRECCIA_FAIL_ON=1      and all that come after it
 * BRECCIA_FAIL_WHOSE=all calls of the libraries too; otherwise those of the program itself, by the address they return to
 * BRECCIA_FAIL_COUNT=F   file that takes a line for each call: its number, and one made of its innermost callers in the program
 * At the end of the program a line tells what the program itself was given and has not given back; after a crash, or when there is no end, in
 * whose code that was. What the program starts in its turn is left alone. For glibc, whose own names for the functions are used, so that
 * nothing must be looked up while memory is being given. */
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

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *memory);

enum { LONGEST = 10 }; /* s that the processor may work; a run takes a tenth of one */

static uintptr_t first_byte, last_byte; /* of the program */
static atomic_long calls;
static long fail_at;
static bool counting, all_from_there, everybody;
static FILE *count_file;

static bool is_program(const void *caller)
{
  return (uintptr_t)caller >= first_byte && (uintptr_t)caller < last_byte;
}

/* ---- what the program was given and has not given back ---- */

enum { PLACES = 1 << 18, DEPTH = 6, NEAREST = 3 };

static struct {
  const void *memory; /* NULL: free for ever; &gone: was given back */
  void *callers[DEPTH];
} given[PLACES];
static const char gone;
static long noted;
static atomic_flag busy = ATOMIC_FLAG_INIT;

/** Where a piece stands, or the first free place. */
static size_t place_of(const void *memory)
{
  size_t at = ((uintptr_t)memory >> 4) * 0x9e3779b97f4a7c15u >> 48;
  while (given[at].memory && given[at].memory != memory) at = (at + 1) % PLACES;
  return at;
}

static void *note(void *memory, const void *caller)
{
  if (!counting || everybody || !memory || !is_program(caller)) return memory;
  void *callers[DEPTH + 2] = {NULL};
  backtrace(callers, DEPTH + 2);
  while (atomic_flag_test_and_set(&busy)) {
  }
  if (++noted > PLACES / 2) abort();
  const size_t at = place_of(memory);
  given[at].memory = memory;
  memcpy(given[at].callers, callers + 2, sizeof given[at].callers);
  atomic_flag_clear(&busy);
  return memory;
}

static void forget(const void *memory)
{
  if (!counting || everybody || !memory) return;
  while (atomic_flag_test_and_set(&busy)) {
  }
  const size_t at = place_of(memory);
  if (given[at].memory) given[at].memory = &gone;
  atomic_flag_clear(&busy);
}

static void tell_kept(void)
{
  int kept = 0;
  char words[256];
  for (size_t at = 0; at < PLACES; ++at) {
    if (!given[at].memory || given[at].memory == &gone || kept++) continue;
    int n = snprintf(words, sizeof words, "kept: a piece asked for at");
    for (int k = 0; k < DEPTH && is_program(given[at].callers[k]); ++k)
      n += snprintf(words + n, sizeof words - (size_t)n, " %lx",
                    (unsigned long)((uintptr_t)given[at].callers[k] - first_byte));
  }
  if (kept) fprintf(stderr, "%s, of %d pieces\n", words, kept);
}

/* ---- beginning and end ---- */

/** The program is the first of all that is loaded, and its own code a library where there is one of all rooms (BRECCIA_ONE_LIBRARY). */
static int find_program(struct dl_phdr_info *info, size_t size, void *context)
{
  int *objects = context;
  (void)size;
  if ((*objects)++ && !strstr(info->dlpi_name, "libbreccia_objects")) return 0;
  first_byte = UINTPTR_MAX;
  last_byte = 0;
  for (int k = 0; k < info->dlpi_phnum; ++k) {
    if (info->dlpi_phdr[k].p_type != PT_LOAD) continue;
    const uintptr_t from = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr, to = from + info->dlpi_phdr[k].p_memsz;
    if (from < first_byte) first_byte = from;
    if (to > last_byte) last_byte = to;
  }
  return *objects > 1;
}

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

__attribute__((constructor)) static void begin(void)
{
  const char *at = getenv("BRECCIA_FAIL_AT"), *on = getenv("BRECCIA_FAIL_ON"), *whose = getenv("BRECCIA_FAIL_WHOSE"),
             *file = getenv("BRECCIA_FAIL_COUNT");
  void *frame;
  if (!at) return;
  int objects = 0;
  dl_iterate_phdr(find_program, &objects);
  fail_at = atol(at);
  all_from_there = on && *on == '1';
  everybody = whose && !strcmp(whose, "all");
  /* Without a buffer of its own the file would ask for one within the first call that is counted, without end. */
  static char buffer[BUFSIZ];
  if (file && *file && !((count_file = fopen(file, "w")) && !setvbuf(count_file, buffer, _IOLBF, sizeof buffer)))
    abort();
  unsetenv("LD_PRELOAD");
  backtrace(&frame, 1);       /* loads what it needs */
  static char stack[1 << 16]; /* for libraries that call themselves until theirs is full */
  sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, NULL);
  for (int k = 0; k < 5; ++k)
    sigaction((const int[]){SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGVTALRM}[k],
              &(struct sigaction){.sa_handler = tell_end, .sa_flags = SA_ONSTACK}, NULL);
  setitimer(ITIMER_VIRTUAL, &(struct itimerval){.it_value.tv_sec = LONGEST}, NULL);
  counting = true;
}

__attribute__((destructor)) static void end(void)
{
  if (counting) tell_kept();
  counting = false;
  if (count_file && fclose(count_file)) abort();
}

/* ---- the functions ---- */

/** Children of the program write to the same file, line by line, and count on from where they began. */
static void tell_place(long call)
{
  void *callers[NEAREST + 8];
  const int count = backtrace(callers, NEAREST + 8);
  uint64_t place = 0;
  for (int k = 2, told = 0; k < count && told < NEAREST; ++k) {
    if (!is_program(callers[k])) continue;
    place = (place ^ ((uintptr_t)callers[k] - first_byte)) * 0x9e3779b97f4a7c15u;
    ++told;
  }
  fprintf(count_file, "%ld %016lx\n", call, (unsigned long)place);
}

static bool refuses(const void *caller)
{
  if (!counting || (!everybody && !is_program(caller))) return false;
  const long call = atomic_fetch_add(&calls, 1) + 1;
  if (count_file) tell_place(call);
  if (!fail_at || call < fail_at || (call > fail_at && !all_from_there)) return false;
  errno = ENOMEM;
  return true;
}

void *malloc(size_t size)
{
  const void *caller = __builtin_return_address(0);
  return refuses(caller) ? NULL : note(__libc_malloc(size), caller);
}

void *calloc(size_t count, size_t size)
{
  const void *caller = __builtin_return_address(0);
  return refuses(caller) ? NULL : note(__libc_calloc(count, size), caller);
}

void *realloc(void *memory, size_t size)
{
  const void *caller = __builtin_return_address(0);
  if (refuses(caller)) return NULL;
  forget(memory);
  return note(__libc_realloc(memory, size), caller);
}

void *aligned_alloc(size_t alignment, size_t size)
{
  const void *caller = __builtin_return_address(0);
  return refuses(caller) ? NULL : note(__libc_memalign(alignment, size), caller);
}

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

void free(void *memory)
{
  forget(memory);
  __libc_free(memory);
}

/** A library that ends the program is told as one that crashes: HDF5 does so where it finds no place for a number of its own. */
void exit(int status)
{
  if (counting && status < 0 && !is_program(__builtin_return_address(0))) abort();
  union {
    void *found;
    void (*call)(int) __attribute__((noreturn));
  } libc = {dlsym(RTLD_NEXT, "exit")};
  libc.call(status);
}
