#include "constitutive/remote/server.h"

#include "base/clock.h"
#include "base/memory.h"
#include "constitutive/min_max.h"
#include "constitutive/remote/listener.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CHUNK = 128, MOST_PARAMETERS = 64 };
static const double POLL_SECONDS = 0.2, SEND_SECONDS = 60;

/** The points of a session. */
typedef struct Session {
  Material material;
  uint32_t number; /* 0: none */
  int64_t points, commits;
  int elastic; /* the elastic stage */
  double *committed, *trial;
  uint8_t *tried; /* of each point, whether it has a trial that could be committed */
  int64_t trials; /* how many have */
  double seconds;
  double evaluations;
} Session;

typedef struct Server {
  const ServeSpec *spec;
  Listener *listener;
  Session held;
  Units *units; /* of whoever named a law last, by these names */
  char *unit_names[3];
  uint32_t last; /* sequence number of the frame answered last */
  bool answered;
  bool leaving;
} Server;

/* ---- answers ---- */

/** @param[in] point  that could not be integrated, or -1 */
__attribute__((format(printf, 4, 5))) static ChannelStatus refuse(Server *s, const Frame *asked, int64_t point,
                                                                  const char *format, ...)
{
  Text text = {0}, words = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&text, format, arguments);
  va_end(arguments);
  Channel *channel = listener_channel(s->listener);
  uint8_t *payload = channel_payload(channel, text.length);
  ChannelStatus status = CHANNEL_BROKEN;
  if (payload) {
    if (text.length) memcpy(payload, text.characters, text.length);
    const Frame frame = {.version = FRAME_VERSION,
                         .operation = OPERATION_ERROR,
                         .sequence = asked->sequence,
                         .flags = point >= 0,
                         .count = point >= 0 ? (uint32_t)point : 0,
                         .length = (uint32_t)text.length,
                         .session = s->held.number};
    status = channel_send(channel, &frame, SEND_SECONDS, &words);
  }
  text_free(&text);
  text_free(&words);
  return status;
}

static ChannelStatus answer(Server *s, const Frame *asked, uint32_t count, uint32_t length)
{
  Text words = {0};
  if (length > channel_most_payload(listener_channel(s->listener)))
    return refuse(s, asked, -1, "the answer does not fit a datagram; use tcp:// or unix:");
  const Frame frame = {.version = FRAME_VERSION,
                       .operation = (uint16_t)(asked->operation | OPERATION_ANSWER),
                       .sequence = asked->sequence,
                       .count = count,
                       .length = length,
                       .session = s->held.number};
  const ChannelStatus status = channel_send(listener_channel(s->listener), &frame, SEND_SECONDS, &words);
  text_free(&words);
  return status;
}

static ChannelStatus answer_text(Server *s, const Frame *asked, Text *text)
{
  const uint32_t length = (uint32_t)text->length;
  uint8_t *payload = channel_payload(listener_channel(s->listener), length);
  if (!payload) return CHANNEL_BROKEN;
  if (length) memcpy(payload, text->characters, length);
  text_free(text);
  return answer(s, asked, 0, length);
}

/* ---- sessions ---- */

static void session_end(Session *h)
{
  if (h->material.law) material_destroy(&h->material);
  free(h->committed);
  free(h->trial);
  free(h->tried);
  *h = (Session){0};
}

static void forget_units(Server *s)
{
  units_destroy(&s->units);
  for (int k = 0; k < 3; ++k) {
    free(s->unit_names[k]);
    s->unit_names[k] = NULL;
  }
}

/** The client's units, kept for whoever has the same: reading the database of units takes a hundred times as long as
 *  all else that makes a point. @return NULL after adding a line to `error` */
static const Units *take_units(Server *s, const char *text, size_t length, Error *error)
{
  static const char *const keys[] = {"length unit", "force unit", "time unit"}, *const standard[] = {UNITS_LENGTH,
                                                                                                     UNITS_FORCE,
                                                                                                     UNITS_TIME};
  char *names[3];
  bool told = true, known = s->units != NULL;
  for (int k = 0; k < 3; ++k) {
    names[k] = frame_line(text, length, keys[k]);
    if (!names[k]) names[k] = text_format("%s", standard[k]);
    told = told && names[k];
    known = known && told && !strcmp(names[k], s->unit_names[k]);
  }
  if (known) {
    for (int k = 0; k < 3; ++k) free(names[k]);
    return s->units;
  }
  forget_units(s);
  memcpy(s->unit_names, names, sizeof names);
  if (!told) error_add(error, BRECCIA_FAILURE, "out of memory: units");
  return s->units = told ? units_create(names[0], names[1], names[2], error) : NULL;
}

/** A material from "LAW; KEY=VALUE; KEY=VALUE" in the client's units. */
static int read_material(Server *s, Session *h, const char *text, size_t length, Error *error)
{
  const char *words[MOST_PARAMETERS];
  const Units *units;
  char *command = frame_line(text, length, "command");
  const double stage = frame_number(text, length, "stage", 1);
  int count = 0, status = BRECCIA_USER_ERROR;
  char *state = NULL, *name = command ? strtok_r(command, ";", &state) : NULL;
  for (char *word = NULL; name && (word = strtok_r(NULL, ";", &state)) && count < MOST_PARAMETERS;) {
    word += strspn(word, " ");
    for (size_t n = strlen(word); n && word[n - 1] == ' ';) word[--n] = 0;
    if (*word) words[count++] = word;
  }
  for (size_t n = name ? strlen(name) : 0; n && name[n - 1] == ' ';) name[--n] = 0;
  const breccia_law *law = name ? law_find(s->spec->laws, name + strspn(name, " ")) : NULL;
  if (!law) {
    Text names = {0};
    for (int k = 0; law_at(s->spec->laws, k); ++k)
      text_add(&names, "%s%s", k ? ", " : "", law_at(s->spec->laws, k)->name);
    error_add(error, BRECCIA_USER_ERROR, "there is no law '%s'; a command is 'LAW; KEY=VALUE; ...' with one of %s",
              name ? name : "", text_words(&names));
    text_free(&names);
  } else if (stage != 0 && stage != 1) {
    error_add(error, BRECCIA_USER_ERROR, "a stage is 0 (elastic) or 1 (plastic)");
  } else if ((units = take_units(s, text, length, error)))
    status = material_from_words(&h->material, law, words, count, units, "", error);
  h->elastic = stage == 0;
  free(command);
  return status;
}

static uint32_t new_number(void)
{
  uint32_t number = 0;
  const int file = open("/dev/urandom", O_RDONLY);
  if (file < 0 || read(file, &number, sizeof number) != sizeof number) number = (uint32_t)(1e6 * clock_seconds());
  if (file >= 0) close(file);
  return number ? number : 1;
}

/** Whether a frame is the greeting of a client that may be served. */
static int greets(const void *context, const Frame *asked, const uint8_t *payload, Text *reason)
{
  const Server *s = context;
  if (asked->version != FRAME_VERSION)
    text_add(reason, "this server speaks version %d of the protocol, the client version %d", FRAME_VERSION,
             asked->version);
  else if (asked->operation != OPERATION_HELLO)
    text_add(reason, "a client says HELLO first");
  if (reason->length) return 1;
  char *secret = frame_line((const char *)payload, asked->length, "secret");
  /* The same time for any wrong secret of a length. */
  unsigned differs = 0;
  const char *wanted = s->spec->secret ? s->spec->secret : "";
  const size_t given = secret ? strlen(secret) : 0;
  for (size_t k = 0; s->spec->secret && k < strlen(wanted); ++k)
    differs |= (unsigned char)(wanted[k] ^ (k < given ? secret[k] : 0));
  differs |= s->spec->secret && given != strlen(wanted);
  free(secret);
  if (differs) text_add(reason, "the secret is wrong");
  return differs != 0;
}

static ChannelStatus hello(Server *s, const Frame *asked, const uint8_t *payload)
{
  Text reply = {0};
  if (greets(s, asked, payload, &reply)) {
    s->leaving = true;
    const ChannelStatus status = refuse(s, asked, -1, "%s", text_words(&reply));
    text_free(&reply);
    return status;
  }
  text_add(&reply, "program: breccia serve\nversion: %s\nsession: %lu\npoints: %lld\ncommits: %lld\n", BRECCIA_VERSION,
           (unsigned long)s->held.number, (long long)s->held.points, (long long)s->held.commits);
  return answer_text(s, asked, &reply);
}

static ChannelStatus tell_law(Server *s, const Frame *asked, const Session *h)
{
  Text reply = {0};
  text_add(
      &reply,
      "components: %d\nbulk: %.17g\nshear: %.17g\nfailure: %.17g\nstate: %d\niterates: 1\nsaves: 1\nsession: %lu\n",
      h->material.law->components, h->material.bulk, h->material.shear, material_failure_strain(&h->material),
      h->material.history_values, (unsigned long)h->number);
  return answer_text(s, asked, &reply);
}

/** What a command makes, without touching the points held (PROBE); or new points (CREATE). */
static ChannelStatus create(Server *s, const Frame *asked, const char *text)
{
  Error *error = breccia_error_create();
  Session fresh = {0};
  ChannelStatus status;
  int bad = read_material(s, &fresh, text, asked->length, error);
  if (!bad && material_takes_lateral(&fresh.material))
    bad = error_add(error, BRECCIA_USER_ERROR,
                    "'%s' reads the pressure across bonds, which servers are not told; give it as 'model'",
                    fresh.material.law_name);
  fresh.points = asked->operation == OPERATION_CREATE ? (int64_t)asked->count : 0;
  if (!bad && fresh.points > FRAME_MOST_PAYLOAD / 64) /* all strains of a step must fit a frame */
    bad = error_add(error, BRECCIA_USER_ERROR, "%lld points are more than a server takes (%d)", (long long)fresh.points,
                    FRAME_MOST_PAYLOAD / 64);
  const size_t values = (size_t)fresh.material.history_values;
  if (!bad && fresh.points) {
    fresh.number = new_number();
    fresh.committed = memory_zeroed(values * (size_t)fresh.points, sizeof(double), "points", error);
    fresh.trial = memory_zeroed(values * (size_t)fresh.points, sizeof(double), "points", error);
    fresh.tried = memory_zeroed((size_t)fresh.points, 1, "points", error);
    bad = !fresh.committed || !fresh.trial || !fresh.tried;
    for (int64_t i = 0; !bad && fresh.material.law->begin && i < fresh.points; ++i) {
      fresh.material.law->begin(fresh.material.constants, fresh.committed + values * (size_t)i);
      fresh.material.law->begin(fresh.material.constants, fresh.trial + values * (size_t)i);
    }
  }
  if (bad) {
    status = refuse(s, asked, -1, "%s", breccia_error_text(error));
    session_end(&fresh);
  } else if (asked->operation == OPERATION_CREATE) {
    session_end(&s->held);
    s->held = fresh;
    status = tell_law(s, asked, &s->held);
  } else {
    status = tell_law(s, asked, &fresh);
    session_end(&fresh);
  }
  breccia_error_destroy(&error);
  return status;
}

static void forget_trials(Session *h)
{
  memset(h->tried, 0, (size_t)h->points);
  h->trials = 0;
}

/** Notes whether `count` points from `first` on have a trial. */
static void note_trials(Session *h, uint32_t first, uint32_t count, bool tried)
{
  for (uint32_t i = first; i < first + count; ++i) {
    h->trials += tried - h->tried[i];
    h->tried[i] = tried;
  }
}

/** Makes the last trial of each point its state; a point that has none keeps its state. */
static void commit(Session *h)
{
  if (h->trials == h->points) {
    double *trial = h->trial;
    h->trial = h->committed;
    h->committed = trial;
  } else {
    const size_t row = (size_t)h->material.history_values;
    for (size_t i = 0; i < (size_t)h->points; ++i)
      if (h->tried[i]) memcpy(h->committed + row * i, h->trial + row * i, sizeof(double) * row);
  }
  forget_trials(h);
  ++h->commits;
}

/** Strains point after point to stresses point after point. @return -1, or the point that could not be integrated */
static int64_t evaluate(Session *h, int64_t first, int64_t count, const uint8_t *strains, uint8_t *stresses,
                        uint8_t *tangents)
{
  const breccia_law *law = h->material.law;
  const int components = law->components, values = h->material.history_values;
  double e[6][CHUNK], s[6][CHUNK], row[6], tangent[36 * CHUNK];
  for (int64_t from = 0; from < count; from += CHUNK) {
    const int n = count - from < CHUNK ? (int)(count - from) : CHUNK;
    breccia_batch batch = {.size = sizeof(breccia_batch),
                           .count = n,
                           .committed = h->committed + values * (first + from),
                           .trial = h->trial + values * (first + from),
                           .tangent = tangents ? tangent : NULL,
                           .elastic_stage = h->elastic};
    for (int k = 0; k < components; ++k) {
      batch.strain[k] = e[k];
      batch.stress[k] = s[k];
    }
    const size_t size = sizeof(double) * (size_t)components;
    for (int i = 0; i < n; ++i) {
      memcpy(row, strains + size * (size_t)(from + i), size);
      for (int k = 0; k < components; ++k) e[k][i] = row[k];
    }
    const int bad = law->update(h->material.constants, &batch);
    if (bad >= 0) return from + bad;
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < components; ++k) row[k] = s[k][i];
      memcpy(stresses + size * (size_t)(from + i), row, size);
    }
    if (tangents)
      memcpy(tangents + size * (size_t)components * (size_t)from, tangent, size * (size_t)components * (size_t)n);
  }
  return -1;
}

static ChannelStatus trial(Server *s, const Frame *asked, const uint8_t *payload)
{
  Session *h = &s->held;
  const uint32_t components = (uint32_t)h->material.law->components;
  const bool tangent = asked->flags & TRIAL_WANTS_TANGENT;
  const uint32_t per_point = (uint32_t)sizeof(double) * components * (1 + (tangent ? components : 0));
  uint32_t first = 0;
  if (asked->length < 8 || asked->count > FRAME_MOST_PAYLOAD / 512 ||
      asked->length != 8 + asked->count * components * sizeof(double))
    return refuse(s, asked, -1, "%lu strains were announced, and %lu bytes came", (unsigned long)asked->count,
                  (unsigned long)asked->length);
  memcpy(&first, payload, sizeof first);
  if ((int64_t)first + asked->count > h->points)
    return refuse(s, asked, -1, "points %lu to %lu were asked for; there are %lld", (unsigned long)first,
                  (unsigned long)first + asked->count - 1, (long long)h->points);
  if (asked->flags & TRIAL_COMMITS_BEFORE) {
    if (!h->trials) return refuse(s, asked, -1, "there is no trial to commit");
    commit(h);
  }
  Channel *channel = listener_channel(s->listener);
  uint8_t *out = channel_payload(channel, (size_t)asked->count * per_point);
  if (!out) return refuse(s, asked, -1, "out of memory: answer");
  const double start = clock_seconds();
  int64_t bad = -1;
  note_trials(h, first, asked->count, false); /* one that fails leaves the points without */
  if (s->spec->zeros)
    memset(out, 0, (size_t)asked->count * per_point);
  else
    bad = evaluate(h, first, asked->count, payload + 8, out,
                   tangent ? out + sizeof(double) * components * asked->count : NULL);
  h->seconds += clock_seconds() - start;
  h->evaluations += asked->count;
  if (bad >= 0) return refuse(s, asked, bad, "%s could not integrate this strain", h->material.law->name);
  note_trials(h, first, asked->count, true);
  return answer(s, asked, asked->count, asked->count * per_point);
}

/** SAVE: committed histories of a range of points out. RESTORE: in. */
static ChannelStatus move_state(Server *s, const Frame *asked, const uint8_t *payload)
{
  Session *h = &s->held;
  const size_t row = sizeof(double) * (size_t)h->material.history_values, size = row * asked->count;
  const bool restore = asked->operation == OPERATION_RESTORE;
  uint32_t first = 0;
  if (asked->length >= 8) memcpy(&first, payload, sizeof first);
  if ((int64_t)first + asked->count > h->points || size > FRAME_MOST_PAYLOAD ||
      asked->length != 8 + (restore ? size : 0))
    return refuse(s, asked, -1, "histories of %lu points from %lu on were asked for; there are %lld points",
                  (unsigned long)asked->count, (unsigned long)first, (long long)h->points);
  if (restore) {
    if (size) {
      memcpy((uint8_t *)h->committed + row * first, payload + 8, size);
      memcpy((uint8_t *)h->trial + row * first, payload + 8, size);
    }
    forget_trials(h);
    return answer(s, asked, 0, 0);
  }
  uint8_t *out = channel_payload(listener_channel(s->listener), size);
  if (!out) return refuse(s, asked, -1, "out of memory: histories");
  if (size) memcpy(out, (const uint8_t *)h->committed + row * first, size);
  return answer(s, asked, asked->count, (uint32_t)size);
}

static ChannelStatus statistics(Server *s, const Frame *asked)
{
  Text reply = {0};
  text_add(&reply, "seconds: %.6f\nevaluations: %.0f\ncommits: %lld\n", s->held.seconds, s->held.evaluations,
           (long long)s->held.commits);
  return answer_text(s, asked, &reply);
}

/** The names of all laws, those in space and those of one strain. */
static ChannelStatus laws(Server *s, const Frame *asked)
{
  Text reply = {0};
  for (int uniaxial = 0; uniaxial < 2; ++uniaxial) {
    text_add(&reply, "%s", uniaxial ? "uniaxial:" : "space:");
    for (int k = 0; law_at(s->spec->laws, k); ++k)
      if ((law_at(s->spec->laws, k)->components == 1) == uniaxial)
        text_add(&reply, " %s", law_at(s->spec->laws, k)->name);
    text_add(&reply, "\n");
  }
  return answer_text(s, asked, &reply);
}

/* ---- the conversation ---- */

static ChannelStatus obey(Server *s, const Frame *asked, const uint8_t *payload)
{
  Session *h = &s->held;
  const char *text = (const char *)payload;
  if (asked->version != FRAME_VERSION)
    return refuse(s, asked, -1, "this server speaks version %d of the protocol, the client version %d", FRAME_VERSION,
                  asked->version);
  if (asked->operation == OPERATION_HELLO) return hello(s, asked, payload);
  switch (asked->operation) {
  case OPERATION_PROBE:
  case OPERATION_CREATE: return create(s, asked, text);
  case OPERATION_STATISTICS: return statistics(s, asked);
  case OPERATION_LAWS: return laws(s, asked);
  case OPERATION_BYE: s->leaving = true; return answer(s, asked, 0, 0);
  default: break;
  }
  if (!h->number || asked->session != h->number)
    return refuse(s, asked, -1, "session %lu is not held here", (unsigned long)asked->session);
  switch (asked->operation) {
  case OPERATION_ATTACH: return tell_law(s, asked, h);
  case OPERATION_TRIAL: return trial(s, asked, payload);
  case OPERATION_COMMIT:
    if (!h->trials) return refuse(s, asked, -1, "there is no trial to commit");
    commit(h);
    return answer(s, asked, 0, 0);
  case OPERATION_REVERT: forget_trials(h); return answer(s, asked, 0, 0);
  case OPERATION_SAVE:
  case OPERATION_RESTORE: return move_state(s, asked, payload);
  default: return refuse(s, asked, -1, "operation %d is unknown", asked->operation);
  }
}

int serve_materials(const ServeSpec *spec, Error *error)
{
  Server s = {.spec = spec};
  Text words = {0};
  s.listener = listener_open(&(ListenerSpec){.address = spec->address,
                                             .open = spec->secret != NULL,
                                             .greets = greets,
                                             .context = &s,
                                             .silence = spec->silence,
                                             .interrupted = spec->interrupted},
                             &words);
  if (!s.listener) {
    error_add(error, BRECCIA_USER_ERROR, "%s: cannot be listened to: %s", spec->address, text_words(&words));
    text_free(&words);
    return BRECCIA_USER_ERROR;
  }
  if (spec->listening) spec->listening(listener_address(s.listener));
  while (!(spec->interrupted && __atomic_load_n(spec->interrupted, __ATOMIC_RELAXED))) {
    Frame asked;
    uint8_t *payload;
    bool fresh = false;
    text_free(&words);
    ChannelStatus status = listener_receive(s.listener, &asked, &payload, &fresh, POLL_SECONDS, &words);
    if (status == CHANNEL_LATE) continue;
    if (fresh) s.answered = false;
    s.leaving = false;
    if (status == CHANNEL_OK) {
      /* An answer that was lost is given once more; nothing is computed or committed twice. */
      const bool again = s.answered && asked.sequence == s.last && asked.operation != OPERATION_HELLO;
      status = again ? channel_repeat(listener_channel(s.listener), SEND_SECONDS, &words) : obey(&s, &asked, payload);
      s.answered = true;
      s.last = asked.sequence;
    } else if (status == CHANNEL_BROKEN) {
      asked = (Frame){0};
      refuse(&s, &asked, -1, "%s", words.characters ? words.characters : "out of memory");
    }
    if (status == CHANNEL_OK && !s.leaving) continue;
    listener_drop(s.listener);
    if (spec->once) break;
  }
  text_free(&words);
  session_end(&s.held);
  forget_units(&s);
  listener_close(&s.listener);
  return BRECCIA_OK;
}
