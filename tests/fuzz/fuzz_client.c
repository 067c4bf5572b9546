/* A server that answers by chance, for libFuzzer: whatever it says, the client must say in one line what is wrong, or
 * use it. */
#include "constitutive/law.h"
#include "constitutive/remote/frame.h"
#include "constitutive/remote/remote.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { POINTS = 3, MOST_STATE = 1 << 16 };

static char address[64];
static int listener = -1;

/** Answers that are still to be given. */
typedef struct Script {
  const uint8_t *at, *end;
} Script;

/** What a good server would say. */
static size_t answer_well(const Frame *asked, uint8_t *payload)
{
  static const char law[] = "components: 6\nbulk: 1\nshear: 1\nstate: 2\nsaves: 1\niterates: 1\n";
  static const char held[] = "session: 5\npoints: 3\ncommits: 1\n";
  switch (asked->operation) {
  case OPERATION_HELLO: memcpy(payload, held, sizeof held - 1); return sizeof held - 1;
  case OPERATION_PROBE:
  case OPERATION_CREATE: memcpy(payload, law, sizeof law - 1); return sizeof law - 1;
  case OPERATION_TRIAL: memset(payload, 0, 48 * POINTS); return 48 * POINTS;
  case OPERATION_SAVE: memset(payload, 0, 16 * POINTS); return 16 * POINTS;
  default: return 0;
  }
}

/** An answer as the script has it: how to answer, what to spoil, count, length of the payload. */
static size_t answer(Script *script, const Frame *asked, uint8_t *bytes)
{
  const uint8_t *at = script->at;
  if (script->end - at < 4) return 0;
  const size_t left = (size_t)(script->end - at - 4);
  size_t length = at[3] < left ? at[3] : left;
  memcpy(bytes + FRAME_HEADER, at + 4, length);
  script->at += 4 + length;
  if (at[0] & 1) length = answer_well(asked, bytes + FRAME_HEADER);
  const Frame frame = {.version = at[1] & 32 ? at[2] : FRAME_VERSION,
                       .operation = (uint16_t)(at[1] & 64   ? OPERATION_ERROR
                                               : at[1] & 16 ? at[2]
                                                            : asked->operation | OPERATION_ANSWER),
                       .sequence = asked->sequence + (at[1] & 8 ? 1 : 0),
                       .flags = at[1] & 4 ? 1 : 0,
                       .count = at[1] & 2 ? at[2] : asked->count,
                       .length = (uint32_t)length,
                       .session = 5};
  frame_seal(&frame, bytes);
  if (at[1] & 128) bytes[at[2] % FRAME_HEADER] ^= 1;
  return FRAME_HEADER + length;
}

static void *serve(void *context)
{
  Script *script = context;
  static uint8_t asked_bytes[1 << 20], bytes[FRAME_HEADER + 4096];
  for (int line; (line = accept(listener, NULL, NULL)) >= 0; close(line)) {
    Frame asked;
    Text words = {0};
    while (recv(line, asked_bytes, FRAME_HEADER, MSG_WAITALL) == FRAME_HEADER &&
           !frame_read(&asked, asked_bytes, &words) && asked.length < sizeof asked_bytes &&
           (!asked.length || recv(line, asked_bytes, asked.length, MSG_WAITALL) == (ssize_t)asked.length)) {
      const size_t size = answer(script, &asked, bytes);
      if (!size || send(line, bytes, size, MSG_NOSIGNAL) < 0) break;
    }
    text_free(&words);
  }
  return NULL;
}

/** One line of words, if something went wrong. */
static void check_problem(const Remote *r, bool wrong)
{
  const char *words = remote_problem(r);
  if (wrong && (!*words || strlen(words) < 10)) abort();
}

static void use(Remote *r, Error *error)
{
  const int64_t starts[2] = {0, POINTS};
  double identity[2], *state = NULL;
  if (remote_begin(r, starts, error)) {
    check_problem(r, true);
    return;
  }
  const breccia_law *law = remote_law(r);
  double strain[6][POINTS] = {{0}}, stress[6][POINTS], tangent[36 * POINTS];
  const int row = law->history_values(&r);
  double *committed = calloc((size_t)row * POINTS, sizeof(double)),
         *trial = calloc((size_t)row * POINTS, sizeof(double));
  if (!committed || !trial || remote_state_values(r) > MOST_STATE) abort();
  breccia_batch batch = {
      .size = sizeof(breccia_batch), .count = POINTS, .committed = committed, .trial = trial, .tangent = tangent};
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = strain[k];
    batch.stress[k] = stress[k];
  }
  for (int i = 0; i < POINTS; ++i) committed[row * i] = i;
  for (int step = 0; step < 2; ++step) {
    int64_t bad;
    double *to = remote_strains(r, 0);
    for (int k = 0; to && k < POINTS * (law->components); ++k) to[k] = 1e-3 * k;
    if (to) remote_post(r, 0);
    if (!remote_collect(r, 0, &bad)) check_problem(r, true);
    remote_commit(r);
    if (law->update(&r, &batch) >= 0) check_problem(r, true);
    remote_commit(r);
  }
  const bool trouble = *remote_problem(r);
  state = calloc((size_t)remote_state_values(r) * POINTS + 1, sizeof(double));
  if (!state) abort();
  if ((!trouble || remote_rescue(r)) && !remote_identify(r, identity, error)) remote_save(r, state, error);
  free(state);
  free(committed);
  free(trial);
  Text report = {0};
  remote_report(r, 1, false, &report);
  text_free(&report);
}

static void remove_socket(void)
{
  unlink(address + 5);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static Script script;
  if (listener < 0) {
    struct sockaddr_un un = {.sun_family = AF_UNIX};
    pthread_t thread;
    snprintf(address, sizeof address, "unix:/tmp/breccia-fuzz-%d-answers", (int)getpid());
    snprintf(un.sun_path, sizeof un.sun_path, "%s", address + 5);
    listener = socket(AF_UNIX, SOCK_STREAM, 0);
    if (bind(listener, (struct sockaddr *)&un, sizeof un) || listen(listener, 4)) abort();
    atexit(remove_socket);
    if (pthread_create(&thread, NULL, serve, &script)) abort();
  }
  script = (Script){data, data + size};
  const char *servers[] = {address};
  const RemoteSpec spec = {.material = "clay",
                           .command = "elastic",
                           .stage = -1,
                           .servers = servers,
                           .server_count = 1,
                           .timeout = 0.1,
                           .stress_unit = 1,
                           .units = {"m", "N", "s"},
                           .length = NAN};
  Error *error = breccia_error_create();
  Remote *r = NULL;
  if (!remote_open(&r, &spec, error)) use(r, error);
  remote_close(&r);
  breccia_error_destroy(&error);
  return 0;
}
