#include "base/memory.h"
#include "constitutive/remote/remote_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_TOLD = 10000 }; /* numbers that a server saves of each point */
static const double START_SECONDS = 60, REACH_SECONDS = 3, LEAVE_SECONDS = 2, LIST_SECONDS = 300;

const breccia_law *remote_law(const Remote *remote)
{
  return &remote->law;
}
int remote_servers(const Remote *remote)
{
  return remote->count;
}
bool remote_begun(const Remote *remote)
{
  return remote->begun;
}
bool remote_iterates(const Remote *remote)
{
  return remote->iterates;
}
int remote_state_at(const Remote *remote)
{
  return 1 + 2 * remote->components;
}
int remote_state_values(const Remote *remote)
{
  return remote->state;
}
const char *remote_problem(const Remote *remote)
{
  return text_words(&remote->problem);
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
    text_add(&more, "it cannot be reached: %s", text_words(&words));
    if (own) {
      Text end = {0};
      if (process_ended(&s->process, &end)) {
        text_free(&more);
        text_add(&more, "%s", text_words(&end));
      }
      text_free(&end);
    }
    remote_complain(r, s, text_words(&more));
    text_free(&more);
    text_free(&words);
    return 1;
  }
  text_free(&words);
  Frame frame;
  uint8_t *reply;
  return remote_say_hello(r, s, &frame, &reply);
}

/** A count that a server tells; -1 if it is none. */
static int count_told(const char *text, size_t length, const char *key, double otherwise)
{
  const double told = frame_number(text, length, key, otherwise);
  return told >= 0 && told <= MOST_TOLD && told == floor(told) ? (int)told : -1;
}

static int probe(Remote *r, RemoteServer *s)
{
  Frame frame;
  uint8_t *reply;
  if (remote_ask_points(r, s, OPERATION_PROBE, 0, &frame, &reply)) return 1;
  const char *text = (const char *)reply;
  r->components = count_told(text, frame.length, "components", 0);
  r->bulk = r->stress_unit * frame_number(text, frame.length, "bulk", NAN);
  r->shear = r->stress_unit * frame_number(text, frame.length, "shear", NAN);
  r->failure = frame_number(text, frame.length, "failure", INFINITY);
  r->iterates = frame_number(text, frame.length, "iterates", 0) != 0;
  r->saves = frame_number(text, frame.length, "saves", 0) != 0;
  r->state = r->saves ? count_told(text, frame.length, "state", 0) : 0;
  if ((r->components == 1 || r->components == 6) && r->bulk > 0 && r->shear > 0 && isfinite(r->bulk + r->shear) &&
      r->state >= 0)
    return 0;
  remote_complain(r, s,
                  "it did not tell components (1 or 6), bulk and shear modulus and numbers to be saved of the command");
  return 1;
}

/** The kind that a command of OpenSees makes, or what stands before the first semicolon. To be freed. */
static char *name_law(const char *command)
{
  const char *kind = strchr(command, ' ');
  if (kind && (!strncmp(command, "nDMaterial ", 11) || !strncmp(command, "uniaxialMaterial ", 17)))
    return text_format("%.*s of OpenSees", (int)strcspn(kind + 1, " "), kind + 1);
  return text_format("%.*s of a server", (int)strcspn(command, ";"), command);
}

/** Starts or reaches the servers. */
static int reach(Remote **out, const RemoteSpec *spec, Error *error)
{
  const bool own = spec->server_count == 0;
  Remote *r = *out = memory_plain(1, sizeof *r);
  if (!r) return error_add(error, BRECCIA_FAILURE, "out of memory: material server");
  pthread_mutex_init(&r->lock, NULL);
  r->count = own ? spec->processes : spec->server_count;
  r->servers = memory_plain((size_t)r->count, sizeof *r->servers);
  r->material = text_format("%s", spec->material);
  r->command = text_format("%s", spec->command);
  r->name = name_law(spec->command);
  for (int k = 0; k < 3; ++k) r->units[k] = text_format("%s", spec->units[k]);
  r->stage = spec->stage;
  r->timeout = spec->timeout;
  r->stress_unit = spec->stress_unit;
  r->length = spec->length;
  if (!r->servers || !r->material || !r->command || !r->name || !r->units[0] || !r->units[1] || !r->units[2])
    return error_add(error, BRECCIA_FAILURE, "out of memory: material server");
  if (own && !(r->folder = process_folder()))
    return error_add(error, BRECCIA_FAILURE, "no folder for the sockets of material servers can be made");
  for (int k = 0; k < r->count; ++k) { /* all start at once */
    RemoteServer *s = &r->servers[k];
    Text words = {0};
    int bad = own && process_start(&s->process, r->folder, k + 1, &words);
    s->address = text_format("%s", own ? s->process.address : spec->servers[k]);
    if (bad || !s->address) {
      remote_complain(r, s, words.length ? words.characters : "out of memory");
      text_free(&words);
      return error_add(error, BRECCIA_USER_ERROR, "%s", remote_problem(r));
    }
  }
  for (int k = 0; k < r->count; ++k)
    if (greet(r, &r->servers[k])) return error_add(error, BRECCIA_USER_ERROR, "%s", remote_problem(r));
  return BRECCIA_OK;
}

int remote_open(Remote **remote, const RemoteSpec *spec, Error *error)
{
  const int status = reach(remote, spec, error);
  if (status) return status;
  if (probe(*remote, (*remote)->servers)) return error_add(error, BRECCIA_USER_ERROR, "%s", remote_problem(*remote));
  remote_make_law(*remote);
  return BRECCIA_OK;
}

int remote_list_laws(Text *lines, Error *error)
{
  Remote *r = NULL;
  const RemoteSpec spec = {
      .material = "", .command = "", .processes = 1, .timeout = LIST_SECONDS, .units = {"", "", ""}};
  int status = reach(&r, &spec, error);
  Frame frame;
  uint8_t *reply;
  if (!status && remote_ask(r, r->servers, OPERATION_LAWS, 0, NULL, &frame, &reply))
    status = error_add(error, BRECCIA_FAILURE, "%s", remote_problem(r));
  if (!status) text_add(lines, "%.*s", (int)frame.length, (const char *)reply);
  remote_close(&r);
  return status;
}

void remote_close(Remote **remote)
{
  Remote *r = *remote;
  if (!r) return;
  for (int k = 0; k < r->count && r->servers; ++k) {
    RemoteServer *s = &r->servers[k];
    const bool told = s->channel && !r->problem.length;
    if (told) {
      Frame frame;
      uint8_t *reply;
      r->timeout = LEAVE_SECONDS;
      remote_ask(r, s, OPERATION_BYE, 0, NULL, &frame, &reply);
    }
    s->greeted = s->channel != NULL;
    if (told)
      channel_close(&s->channel);
    else
      remote_hang_up(s);
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
  free(r->name);
  for (int k = 0; k < 3; ++k) free(r->units[k]);
  text_free(&r->problem);
  pthread_mutex_destroy(&r->lock);
  free(r);
  *remote = NULL;
}

/** Makes room for the strains of all points of a server, so that threads can fill it in together. */
int remote_make_room(Remote *r, Error *error)
{
  for (int k = 0; k < r->count; ++k) {
    RemoteServer *s = &r->servers[k];
    if (remote_trial_size(r, s->count) > channel_most_payload(s->channel))
      remote_complain(r, s, "its points do not fit one frame: use more servers, or tcp:// or unix: instead of udp://");
    else if (!channel_payload(s->channel, remote_trial_size(r, s->count)))
      remote_complain(r, s, "out of memory: strains");
    if (r->problem.length) return remote_tell(r, error);
  }
  return BRECCIA_OK;
}

void remote_divide(Remote *r, const int64_t *starts)
{
  for (int k = 0; k < r->count; ++k) {
    r->servers[k].first = starts[k];
    r->servers[k].count = starts[k + 1] - starts[k];
  }
  r->begun = true;
}

int remote_begin(Remote *r, const int64_t *starts, Error *error)
{
  remote_divide(r, starts);
  for (int k = 0; k < r->count; ++k) {
    RemoteServer *s = &r->servers[k];
    Frame frame;
    uint8_t *reply;
    if (remote_ask_points(r, s, OPERATION_CREATE, s->count, &frame, &reply)) return remote_tell(r, error);
    s->session = frame.session;
    s->commits = 0;
    s->commit_due = s->tried = false;
  }
  return remote_make_room(r, error);
}

/* ---- steps ---- */

double *remote_strains(Remote *r, int server)
{
  RemoteServer *s = &r->servers[server];
  if (r->problem.length) return NULL;
  return (double *)(void *)(channel_payload(s->channel, remote_trial_size(r, s->count)) + TRIAL_HEAD);
}

void remote_post(Remote *r, int server)
{
  if (!r->problem.length) remote_send_trial(r, &r->servers[server], 0, r->servers[server].count, false);
}

bool remote_collect(Remote *r, int server, int64_t *bad)
{
  RemoteServer *s = &r->servers[server];
  *bad = 0;
  s->stresses = s->waiting ? remote_receive_trial(r, s, s->count, false, bad) : NULL;
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
    remote_count_bytes(s, bytes);
    if (!r->problem.length && !remote_ask(r, s, OPERATION_STATISTICS, 0, NULL, &frame, &reply))
      inside = frame_number((const char *)reply, frame.length, "seconds", NAN);
    const double rate = run_seconds > 0 ? s->evaluations / run_seconds : 0,
                 share = run_seconds > 0 ? s->waited / run_seconds : 0;
    if (!json) {
      remote_name_server(r, s, text);
      text_add(text, ": %lld points, %.3g points/s, %.0f %% of the time waited for", (long long)s->count, rate,
               100 * share);
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
