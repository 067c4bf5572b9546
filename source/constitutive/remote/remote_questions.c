/* Questions to one server of a remote material, and what is said when it does not answer as it should. */
#include "base/clock.h"
#include "constitutive/remote/remote_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double ASK_AGAIN_SECONDS = 0.25;

void remote_name_server(const Remote *r, const RemoteServer *s, Text *text)
{
  const bool own = s->process.address != NULL;
  if (*r->material) text_add(text, "material '%s': ", r->material);
  text_add(text, "%sserver", own ? "OpenSees " : "");
  if (r->count > 1) text_add(text, " %d of %d", (int)(s - r->servers) + 1, r->count);
  if (!own) text_add(text, " at %s", s->address);
}

void remote_complain(Remote *r, const RemoteServer *s, const char *words)
{
  if (r->problem.length) return;
  remote_name_server(r, s, &r->problem);
  text_add(&r->problem, ": %s", words);
}

/** Of a server that is gone: how its process ended, if it is ours. */
static void remote_lost(Remote *r, RemoteServer *s, ChannelStatus status, const Text *words)
{
  Text more = {0};
  text_add(&more, "%s", words->characters ? words->characters : "it is lost");
  if (status == CHANNEL_LATE) text_add(&more, " within %g s", r->timeout);
  if (status == CHANNEL_CLOSED && s->process.number) {
    Text end = {0};
    for (int n = 0; n < 200 && !process_ended(&s->process, &end); ++n)
      nanosleep(&(struct timespec){.tv_nsec = 5000000L}, NULL);
    if (end.length) text_add(&more, "; %s", text_words(&end));
    text_free(&end);
  }
  remote_complain(r, s, text_words(&more));
  text_free(&more);
}

/* ---- asking ---- */

static int remote_send(Remote *r, RemoteServer *s, Frame *frame)
{
  Text words = {0};
  frame->version = FRAME_VERSION;
  frame->sequence = ++s->sequence;
  frame->session = s->session;
  const ChannelStatus status = channel_send(s->channel, frame, r->timeout, &words);
  if (status) remote_lost(r, s, status, &words);
  text_free(&words);
  return status != CHANNEL_OK;
}

/** The answer to the last frame. @param[out] bad  the point that could not be integrated, if that is what is wrong */
static int remote_receive(Remote *r, RemoteServer *s, const Frame *asked, Frame *frame, uint8_t **payload, int64_t *bad)
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
    remote_lost(r, s, status, &words);
    text_free(&words);
    return 1;
  }
  text_free(&words);
  if (frame->operation == OPERATION_ERROR) {
    if (frame->flags && bad) *bad = frame->count;
    text_add(&words, "%.*s", (int)frame->length, (const char *)*payload);
    if (!words.length) {
      text_free(&words);
      text_add(&words, "it refused without a word");
    }
  } else if (frame->version != FRAME_VERSION)
    text_add(&words, "it speaks version %d of the protocol, this program version %d", frame->version, FRAME_VERSION);
  else if (frame->sequence != s->sequence || frame->operation != (asked->operation | OPERATION_ANSWER))
    text_add(&words, "it answered %d to frame %lu where %d to frame %lu was due", frame->operation,
             (unsigned long)frame->sequence, asked->operation | OPERATION_ANSWER, (unsigned long)s->sequence);
  if (!words.length) return 0;
  remote_complain(r, s, text_words(&words));
  text_free(&words);
  return 1;
}

/** Asks with a text and waits. @param[out] reply  borrowed */
int remote_ask(Remote *r, RemoteServer *s, Operation operation, uint32_t count, const Text *text, Frame *frame,
               uint8_t **reply)
{
  const size_t length = text ? text->length : 0;
  uint8_t *payload = channel_payload(s->channel, length);
  if (!payload) {
    remote_complain(r, s, "out of memory: frame");
    return 1;
  }
  if (length) memcpy(payload, text->characters, length);
  Frame asked = {.operation = (uint16_t)operation, .count = count, .length = (uint32_t)length};
  return remote_send(r, s, &asked) || remote_receive(r, s, &asked, frame, reply, NULL);
}

void remote_count_bytes(const RemoteServer *s, double bytes[2])
{
  double now[2] = {0};
  if (s->channel) channel_bytes(s->channel, now);
  for (int k = 0; k < 2; ++k) bytes[k] = s->bytes[k] + now[k];
}

int remote_say_hello(Remote *r, RemoteServer *s, Frame *frame, uint8_t **reply)
{
  const char *secret = getenv("BRECCIA_SECRET");
  Text hello = {0};
  text_add(&hello, "client: breccia\nversion: %s\n", BRECCIA_VERSION);
  if (secret && *secret) text_add(&hello, "secret: %s\n", secret);
  const int bad = remote_ask(r, s, OPERATION_HELLO, 0, &hello, frame, reply);
  text_free(&hello);
  return bad;
}

void remote_hang_up(RemoteServer *s)
{
  if (s->channel && channel_may_lose(s->channel)) {
    Text words = {0};
    const Frame bye = {.version = FRAME_VERSION, .operation = OPERATION_BYE, .sequence = ++s->sequence};
    channel_send(s->channel, &bye, 0, &words);
    text_free(&words);
  }
  channel_close(&s->channel);
}

int remote_tell(const Remote *r, Error *error)
{
  return error_add(error, BRECCIA_FAILURE, "%s", remote_problem(r));
}

/** PROBE or CREATE. */
int remote_ask_points(Remote *r, RemoteServer *s, Operation operation, int64_t count, Frame *frame, uint8_t **reply)
{
  static const char *const keys[] = {"length unit", "force unit", "time unit"};
  Text text = {0};
  text_add(&text, "command: %s\n", r->command);
  if (r->stage >= 0) text_add(&text, "stage: %d\n", r->stage);
  if (!isnan(r->length)) text_add(&text, "length: %.17g\n", r->length);
  for (int k = 0; k < 3; ++k) text_add(&text, "%s: %s\n", keys[k], r->units[k]);
  const int bad = remote_ask(r, s, operation, (uint32_t)count, &text, frame, reply);
  text_free(&text);
  return bad;
}

size_t remote_trial_size(const Remote *r, int64_t count)
{
  return TRIAL_HEAD + sizeof(double) * (size_t)r->components * (size_t)count;
}

/** Sends `count` strains of points from `first` of the server's own on. */
int remote_send_trial(Remote *r, RemoteServer *s, int64_t first, int64_t count, bool tangent)
{
  const uint32_t from[2] = {(uint32_t)first, 0};
  uint8_t *payload = channel_payload(s->channel, 0);
  memcpy(payload, from, sizeof from);
  Frame asked = {.operation = OPERATION_TRIAL,
                 .flags = (s->commit_due ? TRIAL_COMMITS_BEFORE : 0) | (tangent ? TRIAL_WANTS_TANGENT : 0),
                 .count = (uint32_t)count,
                 .length = (uint32_t)remote_trial_size(r, count)};
  s->waiting = !remote_send(r, s, &asked);
  return !s->waiting;
}

/** Its stresses and, if wanted, tangents, in the deck's unit. */
double *remote_receive_trial(Remote *r, RemoteServer *s, int64_t count, bool tangent, int64_t *bad)
{
  const size_t per_point = sizeof(double) * (size_t)r->components * (size_t)(1 + (tangent ? r->components : 0));
  const Frame asked = {.operation = OPERATION_TRIAL};
  const double start = clock_seconds();
  Frame frame;
  uint8_t *payload;
  *bad = 0;
  s->waiting = false;
  const int wrong = remote_receive(r, s, &asked, &frame, &payload, bad);
  s->waited += clock_seconds() - start;
  s->evaluations += (double)count;
  if (wrong) return NULL;
  if (frame.count != count || frame.length != per_point * (size_t)count) {
    Text words = {0};
    text_add(&words, "it answered with %lu points in %lu bytes where %lld points in %zu bytes were due",
             (unsigned long)frame.count, (unsigned long)frame.length, (long long)count, per_point * (size_t)count);
    remote_complain(r, s, text_words(&words));
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
  remote_complain(r, s, text_words(&words));
  text_free(&words);
  return NULL;
}
