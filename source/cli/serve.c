#include "verbs.h"

#include <signal.h>

enum { LISTEN, SECRET, ONCE, ZEROS };
static const Option options[] = {
    {"listen", "ADDRESS", "tcp://127.0.0.1:PORT (0: any free port), unix:/PATH or udp://127.0.0.1:PORT"},
    {"secret-file", "FILE", "clients must know the words in this file; then any interface may be listened to"},
    {"once", NULL, "end when the first client has gone"},
    {"zeros", NULL, "answer with zeros instead of stresses, to time the protocol itself"},
    {0}};

static volatile int interrupted;

static void interrupt(int signal_number)
{
  (void)signal_number;
  interrupted = 1;
}

static void tell(const char *address)
{
  printf("listening at %s\n", address);
  fflush(stdout);
}

static int serve_verb(int argc, char **argv, const Verb *verb)
{
  const char *values[sizeof options / sizeof *options];
  const int next = read_options(argc, argv, verb, values, NULL, NULL);
  if (next < 0) return next == -2 ? 0 : 2;
  if (next < argc || !values[LISTEN]) {
    fprintf(stderr, "usage: breccia serve %s\n", verb->arguments);
    return 2;
  }
  const struct sigaction action = {.sa_handler = interrupt};
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  struct sigaction before;
  if (!sigaction(SIGHUP, NULL, &before) && before.sa_handler != SIG_IGN) /* nohup keeps it running */
    sigaction(SIGHUP, &action, NULL);
  const breccia_service service = {.size = sizeof service,
                                   .address = values[LISTEN],
                                   .secret_file = values[SECRET],
                                   .once = values[ONCE] != NULL,
                                   .zeros = values[ZEROS] != NULL,
                                   .interrupted = &interrupted,
                                   .listening = tell};
  breccia_error *error = breccia_error_create();
  const int status = breccia_serve(&service, error);
  return fail(error, status);
}

const Verb verb_serve = {
    .name = "serve",
    .arguments = "--listen ADDRESS [options]",
    .about = "offer the program's own laws to other programs over a socket",
    .options = options,
    .more = "A client names a law as 'LAW; KEY=VALUE; ...'. The protocol stands in docs/material-server.md. Without a "
            "secret only this machine is listened to; the line is not encrypted.",
    .run = serve_verb};
