/* What servers remember: commits, saved states, and how a restart finds them again. */
#include "base/memory.h"
#include "constitutive/remote/remote_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double RESCUE_SECONDS = 5;

/** Commits what is due with a frame of its own. */
static int remote_flush(Remote *r, RemoteServer *s)
{
  Frame frame;
  uint8_t *reply;
  if (!s->commit_due) return 0;
  if (remote_ask(r, s, OPERATION_COMMIT, 0, NULL, &frame, &reply)) return 1;
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
    if (!r->problem.length && remote_flush(r, &r->servers[k])) return remote_tell(r, error);
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
    Text piece = {.characters = memory_plain(TRIAL_HEAD + size, 1)}; /* bytes, not words */
    Frame frame;
    uint8_t *reply;
    if (!piece.characters) {
      remote_complain(r, s, "out of memory: histories");
      return 1;
    }
    piece.length = TRIAL_HEAD + (operation == OPERATION_RESTORE ? size : 0);
    memcpy(piece.characters, from, TRIAL_HEAD);
    if (operation == OPERATION_RESTORE) memcpy(piece.characters + TRIAL_HEAD, state + r->state * first, size);
    const int bad = remote_ask(r, s, operation, (uint32_t)count, &piece, &frame, &reply);
    free(piece.characters);
    if (bad) return 1;
    if (operation == OPERATION_SAVE) {
      if (frame.length != size) {
        remote_complain(r, s, "it saved less or more than it had told");
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
    if (remote_flush(r, s) || move_states(r, s, OPERATION_SAVE, state + r->state * s->first))
      return remote_tell(r, error);
  }
  return BRECCIA_OK;
}

/** What a server holds, as it says in answer to HELLO. */
typedef struct Held {
  double session, points, commits;
} Held;

static int ask_what_is_held(Remote *r, RemoteServer *s, Held *held)
{
  Frame frame;
  uint8_t *reply;
  if (remote_say_hello(r, s, &frame, &reply)) return 1;
  const char *text = (const char *)reply;
  *held = (Held){.session = frame_number(text, frame.length, "session", 0),
                 .points = frame_number(text, frame.length, "points", 0),
                 .commits = frame_number(text, frame.length, "commits", 0)};
  return 0;
}

/** Whether a server is at the commit wanted, or one before: a commit goes with the trial that follows, which may have been lost. */
static bool is_within_reach(const Held *held, double wanted)
{
  return held->commits == wanted || held->commits == wanted - 1;
}

/** Brings a server within reach to the commit wanted. */
static int catch_up(Remote *r, RemoteServer *s, const Held *held, double wanted)
{
  Frame frame;
  uint8_t *reply;
  s->session = (uint32_t)held->session;
  if (held->commits != wanted && remote_ask(r, s, OPERATION_COMMIT, 0, NULL, &frame, &reply)) return 1;
  s->commits = (int64_t)wanted;
  s->commit_due = false;
  return 0;
}

bool remote_rescue(Remote *r)
{
  r->timeout = fmin(r->timeout, RESCUE_SECONDS);
  for (int k = 0; k < r->count; ++k) {
    RemoteServer *s = &r->servers[k];
    Text words = {0};
    Held held;
    remote_count_bytes(s, s->bytes);
    remote_hang_up(s);
    s->channel = channel_connect(s->address, r->timeout, NULL, NULL, &words);
    text_free(&words);
    s->waiting = s->tried = false;
    if (!s->channel || ask_what_is_held(r, s, &held) || held.session != s->session) return false;
    const double committed = (double)(s->commits + s->commit_due);
    if (!is_within_reach(&held, committed) || catch_up(r, s, &held, committed)) return false;
  }
  return true;
}

/** A server that saves nothing: it must hold the session still, as it was. */
static int take_up(Remote *r, RemoteServer *s, const double identity[IDENTITY], Error *error)
{
  Frame frame;
  uint8_t *reply;
  Held held;
  if (ask_what_is_held(r, s, &held)) return remote_tell(r, error);
  if (held.session != identity[0] || held.points != (double)s->count)
    return error_add(error, BRECCIA_USER_ERROR,
                     "material '%s': the server at %s does not hold the points of the checkpoint any more, and it "
                     "cannot restore them; run without --restart",
                     r->material, s->address);
  if (!is_within_reach(&held, identity[1]))
    return error_add(
        error, BRECCIA_USER_ERROR,
        "material '%s': the server at %s is at commit %.0f, the checkpoint at commit %.0f, and the server cannot be "
        "brought there; run without --restart",
        r->material, s->address, held.commits, identity[1]);
  if (catch_up(r, s, &held, identity[1])) return remote_tell(r, error);
  return remote_ask(r, s, OPERATION_ATTACH, 0, NULL, &frame, &reply) ? remote_tell(r, error) : BRECCIA_OK;
}

int remote_resume(Remote *r, const int64_t *starts, double *state, const double *identity, Error *error)
{
  if (!r->saves) {
    remote_divide(r, starts);
    for (int k = 0; k < r->count; ++k) {
      const int status = take_up(r, &r->servers[k], identity + IDENTITY * k, error);
      if (status) return status;
    }
    return remote_make_room(r, error);
  }
  const int status = remote_begin(r, starts, error);
  if (status) return status;
  for (int k = 0; k < r->count && r->state; ++k)
    if (move_states(r, &r->servers[k], OPERATION_RESTORE, state + r->state * r->servers[k].first))
      return remote_tell(r, error);
  return BRECCIA_OK;
}
