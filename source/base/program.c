#include "base/program.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

extern char **environ;

enum { LAST_WORDS = 400 };

/** The last line with letters in it that was written to a file. */
static void add_last_line(FILE *file, Text *reason)
{
  char words[LAST_WORDS + 1];
  fseek(file, 0, SEEK_END);
  const long size = ftell(file);
  fseek(file, size > LAST_WORDS ? size - LAST_WORDS : 0, SEEK_SET);
  words[fread(words, 1, LAST_WORDS, file)] = 0;
  char *last = NULL, *rest = NULL;
  for (char *line = strtok_r(words, "\r\n", &rest); line; line = strtok_r(NULL, "\r\n", &rest)) {
    line += strspn(line, " \t");
    bool words_only = true; /* and not a picture, which gnuplot pours out where it cannot write its file */
    for (const char *c = line; *c; ++c) words_only &= (unsigned char)*c >= ' ' || *c == '\t';
    if (words_only && strcspn(line, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ") < strlen(line)) last = line;
  }
  if (last) text_add(reason, ": %.*s", (int)(strlen(last) - (last[strlen(last) - 1] == ' ')), last);
}

static int start(const char *const *words, FILE *in, FILE *out, pid_t *number)
{
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t usual;
  sigemptyset(&usual);
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(in), 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(out), 1);
  posix_spawn_file_actions_adddup2(&actions, fileno(out), 2);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &usual);
  sigaddset(&usual, SIGPIPE); /* which this command ignores */
  sigaddset(&usual, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  const int code = posix_spawnp(number, words[0], &actions, &attributes, (char *const *)words, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return code;
}

/** All lines of a file, joined by blanks. */
static void add_lines(FILE *file, Text *answer)
{
  char words[LAST_WORDS];
  rewind(file);
  while (fgets(words, sizeof words, file)) {
    words[strcspn(words, "\r\n")] = 0;
    text_add(answer, "%s%s", answer->length ? " " : "", words + strspn(words, " \t"));
  }
}

/** @param[out] answer  what it printed, in one line; NULL: nobody asks */
static ProgramEnd feed(const char *const *words, FILE *in, Text *answer, Text *reason)
{
  ProgramEnd end = PROGRAM_FAILED;
  FILE *out = tmpfile();
  pid_t number = 0;
  int status = 0, code = 0;
  if (!out || fflush(in) || fseek(in, 0, SEEK_SET)) {
    text_add(reason, "a temporary file could not be written: %s", strerror(errno));
  } else if ((code = start(words, in, out, &number))) {
    end = code == ENOENT ? PROGRAM_MISSING : PROGRAM_FAILED;
    text_add(reason, "%s cannot be started: %s", words[0], strerror(code));
  } else {
    pid_t ended;
    while ((ended = waitpid(number, &status, 0)) < 0 && errno == EINTR) continue;
    if (ended < 0) status = 0; /* a host that ignores its children is not told how they end */
    if (WIFSIGNALED(status))
      text_add(reason, "%s was ended by signal %d", words[0], WTERMSIG(status));
    else if (WEXITSTATUS(status) == 127)
      end = PROGRAM_MISSING;
    else if (WEXITSTATUS(status))
      text_add(reason, "%s ended with status %d", words[0], WEXITSTATUS(status));
    else
      end = PROGRAM_DONE;
    if (end == PROGRAM_FAILED) add_last_line(out, reason);
    if (end == PROGRAM_DONE && answer) add_lines(out, answer);
  }
  if (out) fclose(out);
  return end;
}

ProgramEnd program_feed(const char *const *words, FILE *in, Text *reason)
{
  return feed(words, in, NULL, reason);
}

ProgramEnd program_ask(const char *const *words, Text *answer, Text *reason)
{
  FILE *nothing = fopen("/dev/null", "rb");
  if (!nothing) return PROGRAM_FAILED;
  const ProgramEnd end = feed(words, nothing, answer, reason);
  fclose(nothing);
  return end;
}

ProgramEnd program_run(const char *const *words, const char *script, size_t length, Text *reason)
{
  ProgramEnd end = PROGRAM_FAILED;
  FILE *in = tmpfile();
  if (in && fwrite(script, 1, length, in) == length)
    end = program_feed(words, in, reason);
  else
    text_add(reason, "a temporary file could not be written: %s", strerror(errno));
  if (in) fclose(in);
  return end;
}
