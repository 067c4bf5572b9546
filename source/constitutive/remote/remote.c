#include "constitutive/remote/remote.h"

#include "base/clock.h"
#include "base/memory.h"
#include "constitutive/remote/channel.h"
#include "constitutive/remote/process.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { IDENTITY = 2, TRIAL_HEAD = 8 };
static const double START_SECONDS = 60, REACH_SECONDS = 3, ASK_AGAIN_SECONDS = 0.25, LEAVE_SECONDS = 2;

typedef struct RemoteServer {
  char *address;
  Process process;
  Channel *channel;
  uint32_t sequence, session;
  int64_t first, count, commits;
  bool commit_due; /* the last trial is to be committed with what is sent next */
  bool tried;      /* there is a trial that could be committed */
  bool waiting;    /* for the answer to a trial */
  bool greeted;    /* it notices that the line is closed */
  double waited, evaluations;
  const double *stresses; /* as of the last answer */
} RemoteServer;

struct Remote {
  breccia_law law;
  char *material, *command, *units[3], *folder;
  int stage, count;
  double timeout, stress_unit, length;
  RemoteServer *servers;
  int components, state;
  bool iterates, saves, begun;
  double bulk, shear, failure;
  Text problem; /* once set, no server is asked any more */
  pthread_mutex_t lock;
};

/* ---- what goes wrong ---- */

static void problem(Remote *r, const RemoteServer *s, const char *words)
{
  if (r->problem.length) return;
  text_add(&r->problem, "material '%s': server", r->material);
  if (r->count > 1) text_add(&r->problem, " %d of %d", (int)(s - r->servers) + 1, r->count);
  text_add(&r->problem, " at %s: %s", s->address, words);
}

/** Of a server that is gone: how its process ended, if it is ours. */
static void problem_of_channel(Remote *r, RemoteServer *s, ChannelStatus status, const Text *words)
{
  Text more = {0};
  text_add(&more, "%s", words->characters ? words->characters : "it is lost");
  if (status == CHANNEL_LATE) text_add(&more, " within %g s", r->timeout);
  if (status == CHANNEL_CLOSED && s->process.number) {
    Text end = {0};
    for (int n = 0; n < 200 && !process_ended(&s->process, &end); ++n)
      nanosleep(&(struct timespec){.tv_nsec = 5000000L}, NULL);
    if (end.length) text_add(&more, "; %s", end.characters);
    text_free(&end);
  }
  problem(r, s, more.characters);
  text_free(&more);
}

/* ---- asking ---- */

static int send_frame(Remote *r, RemoteServer *s, Frame *frame)
{
  Text words = {0};
  frame->version = FRAME_VERSION;
  frame->sequence = ++s->sequence;
  frame->session = s->session;
  const ChannelStatus status = channel_send(s->channel, frame, r->timeout, &words);
  if (status) problem_of_channel(r, s, status, &words);
  text_free(&words);
  return status != CHANNEL_OK;
}

/** The answer to the last frame. @param[out] bad  the point that could not be integrated, if that is what is wrong */
static int receive_answer(Remote *r, RemoteServer *s, const Frame *asked, Frame *frame, uint8_t **payload, int64_t *bad)
{
  const double end = clock_seconds() + r->timeout;
  Text words = {0};
  ChannelStatus status;
  do {
    text_free(&words);
    const double left = end - clock_seconds();
    const bool may_lose = channel_may_lose(s->channel);
    status = channel_receive(s->channel, frame, payload,
                             may_lose && left > ASK_AGAIN_SECONDS ? ASK_AGAIN_SECONDS : left, &words);
    if (status == CHANNEL_LATE && may_lose && clock_seconds() < end) {
      text_free(&words);
      status = channel_repeat(s->channel, r->timeout, &words);
      if (status == CHANNEL_OK) status = CHANNEL_LATE;
      continue;
    }
    if (status == CHANNEL_OK && may_lose && frame->sequence != s->sequence) status = CHANNEL_LATE; /* an old one */
  } while (status == CHANNEL_LATE && clock_seconds() < end);
  if (status) {
    problem_of_channel(r, s, status, &words);
    text_free(&words);
    return 1;
  }
  text_free(&words);
  if (frame->operation == OPERATION_ERROR) {
    if (frame->flags && bad) *bad = frame->count;
    text_add(&words, "%.*s", (int)frame->length, (const char *)*payload);
  } else if (frame->version != FRAME_VERSION)
    text_add(&words, "it speaks version %d of the protocol, this program version %d", frame->version, FRAME_VERSION);
  else if (frame->sequence != s->sequence || frame->operation != (asked->operation | OPERATION_ANSWER))
    text_add(&words, "it answered %d to frame %lu where %d to frame %lu was due", frame->operation,
             (unsigned long)frame->sequence, asked->operation | OPERATION_ANSWER, (unsigned long)s->sequence);
  if (!words.length) return 0;
  problem(r, s, words.characters);
  text_free(&words);
  return 1;
}

/** Asks with a text and waits. @param[out] reply  borrowed */
static int ask(Remote *r, RemoteServer *s, Operation operation, uint32_t count, const Text *text, Frame *frame,
               uint8_t **reply)
{
  const size_t length = text ? text->length : 0;
  uint8_t *payload = channel_payload(s->channel, length);
  if (!payload) {
    problem(r, s, "out of memory: frame");
    return 1;
  }
  if (length) memcpy(payload, text->characters, length);
  Frame asked = {.operation = (uint16_t)operation, .count = count, .length = (uint32_t)length};
  return send_frame(r, s, &asked) || receive_answer(r, s, &asked, frame, reply, NULL);
}

static int tell(const Remote *r, Error *error)
{
  return error_add(error, BRECCIA_FAILURE, "%s", remote_problem(r));
}

/** PROBE or CREATE. */
static int ask_for_points(Remote *r, RemoteServer *s, Operation operation, int64_t count, Frame *frame, uint8_t **reply)
{
  static const char *const keys[] = {"length unit", "force unit", "time unit"};
  Text text = {0};
  text_add(&text, "command: %s\n", r->command);
  if (r->stage >= 0) text_add(&text, "stage: %d\n", r->stage);
  if (!isnan(r->length)) text_add(&text, "length: %.17g\n", r->length);
  for (int k = 0; k < 3; ++k) text_add(&text, "%s: %s\n", keys[k], r->units[k]);
  const int bad = ask(r, s, operation, (uint32_t)count, &text, frame, reply);
  text_free(&text);
  return bad;
}

/* ---- the law ---- */

static void law_moduli(const void *constants, double *bulk, double *shear)
{
  const Remote *r = *(Remote *const *)constants;
  *bulk = r->bulk;
  *shear = r->shear;
}

static double law_failure_strain(const void *constants)
{
  return (*(Remote *const *)constants)->failure;
}

static int law_history_values(const void *constants)
{
  const Remote *r = *(Remote *const *)constants;
  return remote_state_at(r) + r->state;
}

static void law_begin(const void *constants, double *history)
{
  const Remote *r = *(Remote *const *)constants;
  memset(history, 0, sizeof(double) * (size_t)(remote_state_at(r) + r->state));
  history[0] = -1;
}

static void answer_elastically(const Remote *r, const breccia_batch *batch)
{
  const double lambda = r->bulk - 2 * r->shear / 3, young = 9 * r->bulk * r->shear / (3 * r->bulk + r->shear);
  for (int i = 0; i < batch->count; ++i) {
    if (r->components == 1) {
      batch->stress[0][i] = young * batch->strain[0][i];
      if (batch->tangent) batch->tangent[i] = young;
      continue;
    }
    const double volume = batch->strain[0][i] + batch->strain[1][i] + batch->strain[2][i];
    for (int k = 0; k < 6; ++k)
      batch->stress[k][i] = r->shear * batch->strain[k][i] * (k < 3 ? 2 : 1) + (k < 3 ? lambda * volume : 0);
    for (int k = 0; batch->tangent && k < 6; ++k)
      for (int n = 0; n < 6; ++n)
        batch->tangent[36 * i + 6 * k + n] = (k < 3 && n < 3 ? lambda : 0) + (k == n ? r->shear * (k < 3 ? 2 : 1) : 0);
  }
}

static size_t trial_size(const Remote *r, int64_t count)
{
  return TRIAL_HEAD + sizeof(double) * (size_t)r->components * (size_t)count;
}

/** Sends `count` strains of points from `first` of the server's own on. */
static int send_trial(Remote *r, RemoteServer *s, int64_t first, int64_t count, bool tangent)
{
  const uint32_t from[2] = {(uint32_t)first, 0};
  uint8_t *payload = channel_payload(s->channel, 0);
  memcpy(payload, from, sizeof from);
  Frame asked = {.operation = OPERATION_TRIAL,
                 .flags = (s->commit_due ? TRIAL_COMMITS_BEFORE : 0) | (tangent ? TRIAL_WANTS_TANGENT : 0),
                 .count = (uint32_t)count,
                 .length = (uint32_t)trial_size(r, count)};
  s->waiting = !send_frame(r, s, &asked);
  return !s->waiting;
}

/** Its stresses and, if wanted, tangents, in the deck's unit. */
static double *receive_trial(Remote *r, RemoteServer *s, int64_t count, bool tangent, int64_t *bad)
{
  const size_t per_point = sizeof(double) * (size_t)r->components * (size_t)(1 + (tangent ? r->components : 0));
  const Frame asked = {.operation = OPERATION_TRIAL};
  const double start = clock_seconds();
  Frame frame;
  uint8_t *payload;
  *bad = 0;
  s->waiting = false;
  const int wrong = receive_answer(r, s, &asked, &frame, &payload, bad);
  s->waited += clock_seconds() - start;
  s->evaluations += (double)count;
  if (wrong) return NULL;
  if (frame.count != count || frame.length != per_point * (size_t)count) {
    Text words = {0};
    text_add(&words, "it answered with %lu points in %lu bytes where %lld points in %zu bytes were due",
             (unsigned long)frame.count, (unsigned long)frame.length, (long long)count, per_point * (size_t)count);
    problem(r, s, words.characters);
    text_free(&words);
    return NULL;
  }
  if (s->commit_due) ++s->commits;
  s->commit_due = false;
  s->tried = true;
  double *values = (double *)(void *)payload;
  const int64_t numbers = (int64_t)(per_point / sizeof(double)) * count, stresses = (int64_t)r->components * count;
  double sum = 0;
  for (int64_t k = 0; k < numbers; ++k) {
    values[k] *= r->stress_unit;
    sum += values[k] - values[k]; /* not a number if one is none */
  }
  if (sum == 0) return values;
  int64_t k = 0;
  while (k < stresses && isfinite(values[k])) ++k;
  if (k < stresses) *bad = k / r->components;
  Text words = {0};
  text_add(&words, "it returned a %s that is not a number for its point %lld", k < stresses ? "stress" : "tangent",
           (long long)*bad);
  problem(r, s, words.characters);
  text_free(&words);
  return NULL;
}

/** Points of a batch from its index `first` on that belong to one server. @return the index in the batch of a point that failed, or -1 */
static int update_range(Remote *r, const breccia_batch *batch, int first, int count, RemoteServer *s)
{
  const int row = law_history_values(&(Remote *){r}), n = r->components;
  const int64_t id = (int64_t)batch->committed[(ptrdiff_t)row * first];
  uint8_t *payload = channel_payload(s->channel, trial_size(r, count));
  if (!payload) {
    problem(r, s, "out of memory: strains");
    return first;
  }
  double *strains = (double *)(void *)(payload + TRIAL_HEAD);
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < n; ++k) strains[n * i + k] = batch->strain[k][first + i];
  int64_t bad;
  if (send_trial(r, s, id - s->first, count, batch->tangent != NULL)) return first;
  const double *stresses = receive_trial(r, s, count, batch->tangent != NULL, &bad);
  if (!stresses) return first + (int)(bad < count ? bad : 0);
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < n; ++k) batch->stress[k][first + i] = stresses[n * i + k];
  if (batch->tangent)
    memcpy(batch->tangent + n * n * first, stresses + n * count, sizeof(double) * (size_t)(n * n) * (size_t)count);
  return -1;
}

static int law_update(const void *constants, const breccia_batch *batch)
{
  Remote *r = *(Remote *const *)constants;
  const int row = law_history_values(constants);
  for (int i = 0; i < batch->count; ++i) {
    double *new = batch->trial + (ptrdiff_t)row *i;
    new[0] = batch->committed[(ptrdiff_t)row * i];
    for (int k = 1; k < remote_state_at(r); ++k) new[k] = batch->committed[(ptrdiff_t)row * i + k];
  }
  if (batch->elastic_stage || !r->begun) {
    answer_elastically(r, batch);
    return -1;
  }
  int bad = -1;
  pthread_mutex_lock(&r->lock);
  for (int i = 0; i < batch->count && bad < 0;) {
    const int64_t id = (int64_t)batch->committed[(ptrdiff_t)row * i];
    if (r->problem.length) {
      bad = i;
      break;
    }
    if (id < 0) { /* a place that no point uses */
      for (int k = 0; k < r->components; ++k) batch->stress[k][i] = 0;
      for (int k = 0; batch->tangent && k < r->components * r->components; ++k)
        batch->tangent[r->components * r->components * i + k] = 0;
      ++i;
      continue;
    }
    RemoteServer *s = r->servers;
    while (id >= s->first + s->count) ++s;
    int end = i + 1;
    while (end < batch->count && (int64_t)batch->committed[(ptrdiff_t)row * end] == id + end - i &&
           id + end - i < s->first + s->count)
      ++end;
    bad = update_range(r, batch, i, end - i, s);
    i = end;
  }
  pthread_mutex_unlock(&r->lock);
  for (int i = 0; r->components == 1 && bad < 0 && i < batch->count; ++i) {
    batch->trial[(ptrdiff_t)row * i + 1] = batch->strain[0][i];
    batch->trial[(ptrdiff_t)row * i + 2] = batch->stress[0][i];
  }
  return bad;
}

const breccia_law *remote_law(const Remote *remote)
{
  return &remote->law;
}
int remote_servers(const Remote *remote)
{
  return remote->count;
}
int remote_processes(const Remote *remote)
{
  return remote->folder ? remote->count : 0;
}
bool remote_iterates(const Remote *remote)
{
  return remote->iterates;
}
int remote_state_at(const Remote *remote)
{
  return remote->components == 1 ? 3 : 1;
}
int remote_state_values(const Remote *remote)
{
  return remote->state;
}
const char *remote_problem(const Remote *remote)
{
  return remote->problem.characters ? remote->problem.characters : "";
}

/* ---- opening and closing ---- */

static int child_is_gone(void *context)
{
  return process_gone(context);
}

static int greet(Remote *r, RemoteServer *s)
{
  Text words = {0};
  const bool own = s->process.address != NULL;
  s->channel = channel_connect(s->address, own ? START_SECONDS : fmin(r->timeout, REACH_SECONDS),
                               own ? child_is_gone : NULL, &s->process, &words);
  if (!s->channel) {
    Text more = {0};
    text_add(&more, "it cannot be reached: %s", words.characters);
    if (own) {
      Text end = {0};
      if (process_ended(&s->process, &end)) {
        text_free(&more);
        text_add(&more, "%s", end.characters);
      }
      text_free(&end);
    }
    problem(r, s, more.characters);
    text_free(&more);
    text_free(&words);
    return 1;
  }
  text_free(&words);
  const char *secret = getenv("BRECCIA_SECRET");
  Text hello = {0};
  Frame frame;
  uint8_t *reply;
  text_add(&hello, "client: breccia\nversion: %s\n", BRECCIA_VERSION);
  if (secret && *secret) text_add(&hello, "secret: %s\n", secret);
  const int bad = ask(r, s, OPERATION_HELLO, 0, &hello, &frame, &reply);
  text_free(&hello);
  return bad;
}

static int probe(Remote *r, RemoteServer *s)
{
  Frame frame;
  uint8_t *reply;
  if (ask_for_points(r, s, OPERATION_PROBE, 0, &frame, &reply)) return 1;
  const char *text = (const char *)reply;
  r->components = (int)frame_number(text, frame.length, "components", 0);
  r->bulk = r->stress_unit * frame_number(text, frame.length, "bulk", NAN);
  r->shear = r->stress_unit * frame_number(text, frame.length, "shear", NAN);
  r->failure = frame_number(text, frame.length, "failure", INFINITY);
  r->iterates = frame_number(text, frame.length, "iterates", 0) != 0;
  r->saves = frame_number(text, frame.length, "saves", 0) != 0;
  r->state = r->saves ? (int)frame_number(text, frame.length, "state", 0) : 0;
  if ((r->components == 1 || r->components == 6) && r->bulk > 0 && r->shear > 0 && isfinite(r->bulk + r->shear) &&
      r->state >= 0)
    return 0;
  problem(r, s, "it did not tell components (1 or 6), bulk and shear modulus of the command");
  return 1;
}

int remote_open(Remote **out, const RemoteSpec *spec, Error *error)
{
  const bool own = spec->server_count == 0;
  Remote *r = *out = calloc(1, sizeof *r);
  if (!r) return error_add(error, BRECCIA_FAILURE, "out of memory: material server");
  pthread_mutex_init(&r->lock, NULL);
  r->count = own ? spec->processes : spec->server_count;
  r->servers = calloc((size_t)r->count, sizeof *r->servers);
  r->material = text_format("%s", spec->material);
  r->command = text_format("%s", spec->command);
  for (int k = 0; k < 3; ++k) r->units[k] = text_format("%s", spec->units[k]);
  r->stage = spec->stage;
  r->timeout = spec->timeout;
  r->stress_unit = spec->stress_unit;
  r->length = spec->length;
  if (!r->servers || !r->material || !r->command || !r->units[0] || !r->units[1] || !r->units[2])
    return error_add(error, BRECCIA_FAILURE, "out of memory: material server");
  if (own && !(r->folder = process_folder()))
    return error_add(error, BRECCIA_FAILURE, "material '%s': no folder for its servers' sockets can be made",
                     spec->material);
  for (int k = 0; k < r->count; ++k) { /* all start at once */
    RemoteServer *s = &r->servers[k];
    Text words = {0};
    int bad = own && process_start(&s->process, r->folder, k + 1, &words);
    s->address = text_format("%s", own ? s->process.address : spec->servers[k]);
    if (bad || !s->address) {
      error_add(error, BRECCIA_USER_ERROR, "material '%s': %s", spec->material,
                words.length ? words.characters : "out of memory");
      text_free(&words);
      return BRECCIA_USER_ERROR;
    }
  }
  for (int k = 0; k < r->count; ++k)
    if (greet(r, &r->servers[k]) || (k == 0 && probe(r, &r->servers[k]))) {
      error_add(error, BRECCIA_USER_ERROR, "%s", remote_problem(r));
      return BRECCIA_USER_ERROR;
    }
  r->law = (breccia_law){.name = "remote",
                         .about = "lives in a material server",
                         .source = r->command,
                         .maturity = "experimental",
                         .constants_size = sizeof(Remote *),
                         .uniaxial = r->components == 1,
                         .moduli = law_moduli,
                         .failure_strain = law_failure_strain,
                         .history_values = law_history_values,
                         .begin = law_begin,
                         .update = law_update};
  return BRECCIA_OK;
}

void remote_close(Remote **remote)
{
  Remote *r = *remote;
  if (!r) return;
  for (int k = 0; k < r->count && r->servers; ++k) {
    RemoteServer *s = &r->servers[k];
    if (s->channel && !r->problem.length) {
      Frame frame;
      uint8_t *reply;
      r->timeout = LEAVE_SECONDS;
      ask(r, s, OPERATION_BYE, 0, NULL, &frame, &reply);
    }
    s->greeted = s->channel != NULL;
    channel_close(&s->channel);
  }
  for (int k = 0; k < r->count && r->servers; ++k) {
    process_stop(&r->servers[k].process, r->servers[k].greeted);
    free(r->servers[k].address);
  }
  if (r->folder) rmdir(r->folder);
  free(r->folder);
  free(r->servers);
  free(r->material);
  free(r->command);
  for (int k = 0; k < 3; ++k) free(r->units[k]);
  text_free(&r->problem);
  pthread_mutex_destroy(&r->lock);
  free(r);
  *remote = NULL;
}

/** Makes room for the strains of all points of a server, so that threads can fill it in together. */
static int make_room(Remote *r, Error *error)
{
  for (int k = 0; k < r->count; ++k) {
    RemoteServer *s = &r->servers[k];
    if (trial_size(r, s->count) > channel_most_payload(s->channel))
      problem(r, s, "its points do not fit one frame: use more servers, or tcp:// or unix: instead of udp://");
    else if (!channel_payload(s->channel, trial_size(r, s->count)))
      problem(r, s, "out of memory: strains");
    if (r->problem.length) return tell(r, error);
  }
  return BRECCIA_OK;
}

static void divide(Remote *r, const int64_t *starts)
{
  for (int k = 0; k < r->count; ++k) {
    r->servers[k].first = starts[k];
    r->servers[k].count = starts[k + 1] - starts[k];
  }
  r->begun = true;
}

int remote_begin(Remote *r, const int64_t *starts, Error *error)
{
  divide(r, starts);
  for (int k = 0; k < r->count; ++k) {
    RemoteServer *s = &r->servers[k];
    Frame frame;
    uint8_t *reply;
    if (ask_for_points(r, s, OPERATION_CREATE, s->count, &frame, &reply)) return tell(r, error);
    s->session = frame.session;
    s->commits = 0;
    s->commit_due = s->tried = false;
  }
  return make_room(r, error);
}

/* ---- states ---- */

/** Commits what is due with a frame of its own. */
static int flush(Remote *r, RemoteServer *s)
{
  Frame frame;
  uint8_t *reply;
  if (!s->commit_due) return 0;
  if (ask(r, s, OPERATION_COMMIT, 0, NULL, &frame, &reply)) return 1;
  s->commit_due = s->tried = false;
  ++s->commits;
  return 0;
}

int remote_identify(Remote *r, double *identity, Error *error)
{
  for (int k = 0; k < r->count; ++k) {
    identity[IDENTITY * k] = identity[IDENTITY * k + 1] = 0;
    if (!r->begun) continue;
    /* A server that is lost cannot commit any more; what it holds is as of its last commit. */
    if (!r->problem.length && flush(r, &r->servers[k])) return tell(r, error);
    identity[IDENTITY * k] = r->servers[k].session;
    identity[IDENTITY * k + 1] = (double)(r->servers[k].commits + r->servers[k].commit_due);
  }
  return BRECCIA_OK;
}

/** SAVE or RESTORE of all points of a server, in pieces that fit its frames. */
static int move_states(Remote *r, RemoteServer *s, Operation operation, double *state)
{
  const size_t row = sizeof(double) * (size_t)r->state;
  const int64_t most = (int64_t)((channel_most_payload(s->channel) / 4 - TRIAL_HEAD) / row);
  for (int64_t first = 0; first < s->count;) {
    const int64_t count = s->count - first < most ? s->count - first : most;
    const size_t size = row * (size_t)count;
    const uint32_t from[2] = {(uint32_t)first, 0};
    Text piece = {.characters = malloc(TRIAL_HEAD + size)}; /* bytes, not words */
    Frame frame;
    uint8_t *reply;
    if (!piece.characters) {
      problem(r, s, "out of memory: histories");
      return 1;
    }
    piece.length = TRIAL_HEAD + (operation == OPERATION_RESTORE ? size : 0);
    memcpy(piece.characters, from, TRIAL_HEAD);
    if (operation == OPERATION_RESTORE) memcpy(piece.characters + TRIAL_HEAD, state + r->state * first, size);
    const int bad = ask(r, s, operation, (uint32_t)count, &piece, &frame, &reply);
    free(piece.characters);
    if (bad) return 1;
    if (operation == OPERATION_SAVE) {
      if (frame.length != size) {
        problem(r, s, "it saved less or more than it had told");
        return 1;
      }
      memcpy(state + r->state * first, reply, size);
    }
    first += count;
  }
  return 0;
}

int remote_save(Remote *r, double *state, Error *error)
{
  for (int k = 0; k < r->count && r->state; ++k) {
    RemoteServer *s = &r->servers[k];
    if (r->problem.length || flush(r, s) || move_states(r, s, OPERATION_SAVE, state + r->state * s->first))
      return tell(r, error);
  }
  return BRECCIA_OK;
}

/** A server that saves nothing: it must hold the session still, as it was. */
static int take_up(Remote *r, RemoteServer *s, const double identity[IDENTITY], Error *error)
{
  Frame frame;
  uint8_t *reply;
  if (ask(r, s, OPERATION_HELLO, 0, NULL, &frame, &reply)) return tell(r, error);
  const char *text = (const char *)reply;
  const double session = frame_number(text, frame.length, "session", 0),
               points = frame_number(text, frame.length, "points", 0),
               commits = frame_number(text, frame.length, "commits", 0);
  if (session != identity[0] || points != (double)s->count)
    return error_add(error, BRECCIA_USER_ERROR,
                     "material '%s': the server at %s does not hold the points of the checkpoint any more, and it "
                     "cannot restore them; run without --restart",
                     r->material, s->address);
  /* The checkpoint may count a commit that was to go with the trial which was never answered. */
  if (commits == identity[1] - 1) {
    s->session = (uint32_t)session;
    if (ask(r, s, OPERATION_COMMIT, 0, NULL, &frame, &reply)) return tell(r, error);
  } else if (commits != identity[1])
    return error_add(
        error, BRECCIA_USER_ERROR,
        "material '%s': the server at %s has gone on to commit %.0f, the checkpoint is of commit %.0f, and "
        "it cannot go back; run without --restart",
        r->material, s->address, commits, identity[1]);
  s->session = (uint32_t)session;
  s->commits = (int64_t)identity[1];
  return ask(r, s, OPERATION_ATTACH, 0, NULL, &frame, &reply) ? tell(r, error) : BRECCIA_OK;
}

int remote_resume(Remote *r, const int64_t *starts, double *state, const double *identity, Error *error)
{
  if (!r->saves) {
    divide(r, starts);
    for (int k = 0; k < r->count; ++k) {
      const int status = take_up(r, &r->servers[k], identity + IDENTITY * k, error);
      if (status) return status;
    }
    return make_room(r, error);
  }
  const int status = remote_begin(r, starts, error);
  if (status) return status;
  for (int k = 0; k < r->count && r->state; ++k)
    if (move_states(r, &r->servers[k], OPERATION_RESTORE, state + r->state * r->servers[k].first))
      return tell(r, error);
  return BRECCIA_OK;
}

/* ---- steps ---- */

double *remote_strains(Remote *r, int server)
{
  RemoteServer *s = &r->servers[server];
  if (r->problem.length) return NULL;
  return (double *)(void *)(channel_payload(s->channel, trial_size(r, s->count)) + TRIAL_HEAD);
}

void remote_post(Remote *r, int server)
{
  if (!r->problem.length) send_trial(r, &r->servers[server], 0, r->servers[server].count, false);
}

bool remote_collect(Remote *r, int server, int64_t *bad)
{
  RemoteServer *s = &r->servers[server];
  *bad = 0;
  s->stresses = s->waiting ? receive_trial(r, s, s->count, false, bad) : NULL;
  return s->stresses != NULL;
}

const double *remote_stresses(const Remote *r, int server)
{
  return r->servers[server].stresses;
}

void remote_commit(Remote *r)
{
  for (int k = 0; k < r->count; ++k) {
    r->servers[k].commit_due = r->servers[k].tried;
    r->servers[k].tried = false;
  }
}

void remote_report(Remote *r, double run_seconds, bool json, Text *text)
{
  for (int k = 0; k < r->count && r->begun; ++k) {
    RemoteServer *s = &r->servers[k];
    double bytes[2], inside = NAN;
    Frame frame;
    uint8_t *reply;
    channel_bytes(s->channel, bytes);
    if (!r->problem.length && !ask(r, s, OPERATION_STATISTICS, 0, NULL, &frame, &reply))
      inside = frame_number((const char *)reply, frame.length, "seconds", NAN);
    const double rate = run_seconds > 0 ? s->evaluations / run_seconds : 0,
                 share = run_seconds > 0 ? s->waited / run_seconds : 0;
    if (!json) {
      text_add(text, "material '%s', server %d at %s: %lld points, %.3g points/s, %.0f %% of the time waited for",
               r->material, k + 1, s->address, (long long)s->count, rate, 100 * share);
      if (isfinite(inside)) text_add(text, ", %.1f s in the law", inside);
      text_add(text, ", %.3g MB sent, %.3g MB received\n", bytes[0] / 1e6, bytes[1] / 1e6);
      continue;
    }
    text_add(text, "%s{\"material\": ", text->length ? ", " : "");
    text_add_json(text, r->material);
    text_add(text, ", \"server\": ");
    text_add_json(text, s->address);
    text_add(text,
             ", \"points\": %lld, \"points_per_second\": %.6g, \"waiting_share\": %.4g, \"bytes_sent\": %.0f, "
             "\"bytes_received\": %.0f}",
             (long long)s->count, rate, share, bytes[0], bytes[1]);
  }
}
