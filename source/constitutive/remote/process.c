#include "constitutive/remote/process.h"

#include "base/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

enum { LAST_WORDS = 400 };
static const double STOP_SECONDS = 3;

char *process_folder(void)
{
  const char *base = getenv("TMPDIR");
  char *path = text_format("%s/breccia-XXXXXX", base && *base ? base : "/tmp");
  if (path && mkdtemp(path)) return path;
  free(path);
  return NULL;
}

/** The server that stands beside this program. */
static bool find_beside(char *path, size_t size)
{
  static const char name[] = "breccia-opensees";
  const ssize_t length = readlink("/proc/self/exe", path, size - sizeof name);
  if (length <= 0) return false;
  path[length] = 0;
  char *slash = strrchr(path, '/');
  if (!slash) return false;
  memcpy(slash + 1, name, sizeof name);
  return !access(path, X_OK);
}

int process_start(Process *process, const char *folder, int number, Text *reason)
{
  const char *named = getenv("BRECCIA_OPENSEES");
  char beside[1024];
  const char *program = named && *named ? named : find_beside(beside, sizeof beside) ? beside : "breccia-opensees";
  *process = (Process){.log = text_format("%s/%d.log", folder, number),
                       .address = text_format("unix:%s/%d.socket", folder, number)};
  if (!process->log || !process->address) {
    text_add(reason, "out of memory: server");
    return 1;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, process->log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  /* In a group of its own: what the terminal sends to stop the run must not end the servers before the last state is saved. */
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE); /* which the command ignores, and a server need not */
  sigaddset(&usual, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  char *words[] = {(char *)program, "--listen", process->address, "--once", NULL};
  const int code = posix_spawnp(&process->number, program, &actions, &attributes, words, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (!code) return 0;
  process->number = 0;
  text_add(reason,
           "'%s' cannot be started: %s; `make demo-opensees` sets one up, and BRECCIA_OPENSEES can "
           "name it",
           program, strerror(code));
  return 1;
}

static void tell_last_words(const Process *process, Text *reason)
{
  char words[LAST_WORDS + 1] = "";
  FILE *file = fopen(process->log, "r");
  if (!file) return;
  fseek(file, 0, SEEK_END);
  const long size = ftell(file);
  fseek(file, size > LAST_WORDS ? size - LAST_WORDS : 0, SEEK_SET);
  words[fread(words, 1, LAST_WORDS, file)] = 0;
  fclose(file);
  size_t length = 0; /* one line */
  for (const char *c = words; *c; ++c) {
    const bool blank = *c == '\n' || *c == '\r' || *c == '\t' || *c == ' ';
    if (!blank || (length && words[length - 1] != ' ')) words[length++] = blank ? ' ' : *c;
  }
  while (length && words[length - 1] == ' ') --length;
  words[length] = 0;
  if (length) text_add(reason, "; its last words: %s", words);
}

bool process_gone(const Process *process)
{
  siginfo_t info = {0};
  return process->number && !waitid(P_PID, (id_t)process->number, &info, WEXITED | WNOHANG | WNOWAIT) && info.si_pid;
}

bool process_ended(Process *process, Text *reason)
{
  int status;
  if (!process->number) return false;
  if (waitpid(process->number, &status, WNOHANG) != process->number) return false;
  process->number = 0;
  if (!reason) return true;
  if (WIFSIGNALED(status))
    text_add(reason, "its process was ended by signal %d", WTERMSIG(status));
  else
    text_add(reason, "its process has ended with status %d", WEXITSTATUS(status));
  tell_last_words(process, reason);
  return true;
}

void process_stop(Process *process, bool told)
{
  if (process->number && !told) kill(process->number, SIGTERM);
  const double end = clock_seconds() + STOP_SECONDS;
  while (process->number && !process_ended(process, NULL)) {
    if (clock_seconds() > end) {
      kill(process->number, SIGKILL);
      waitpid(process->number, NULL, 0);
      process->number = 0;
      break;
    }
    nanosleep(&(struct timespec){.tv_nsec = 5000000L}, NULL);
  }
  if (process->log) unlink(process->log);
  if (process->address) unlink(process->address + strlen("unix:"));
  free(process->log);
  free(process->address);
  *process = (Process){0};
}
