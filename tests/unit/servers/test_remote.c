/* Material servers and their clients: who is served, what is committed, and what stays behind. */
#include "support.h"

#include "base/clock.h"
#include "constitutive/remote/channel.h"
#include "constitutive/remote/remote_parts.h"
#include "constitutive/remote/server.h"

#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

enum {
  PATIENCE = 30
}; /* seconds, for what comes at once; half of the minute for which a served client is waited for */

/* ---- a server of our laws in a thread, and lines to it ---- */

static char folder[] = "/tmp/breccia-remote-XXXXXX", where[160];
static atomic_bool listening;
static volatile int interrupted;
static pthread_t server;

static void note_address(const char *address)
{
  snprintf(where, sizeof where, "%s", address);
  listening = true;
}

static void *serve(void *spec)
{
  static int status;
  status = serve_materials(spec, NULL);
  return &status;
}

static ServeSpec spec;
static char wanted[160];

static bool serving;

static void begin_with(ServeSpec wishes)
{
  snprintf(wanted, sizeof wanted, "%s", wishes.address);
  spec = wishes;
  spec.address = wanted;
  spec.interrupted = &interrupted;
  spec.listening = note_address;
  listening = false;
  __atomic_store_n(&interrupted, 0, __ATOMIC_RELAXED);
  assert_int_equal(pthread_create(&server, NULL, serve, &spec), 0);
  serving = true;
  while (!listening) nanosleep(&(struct timespec){.tv_nsec = 1000000L}, NULL);
}

static void begin(const char *address, const char *secret)
{
  begin_with((ServeSpec){.address = address, .secret = secret});
}

static void begin_at_file(char path[128])
{
  snprintf(path, 128, "%s/socket", folder);
  char *address = text_format("unix:%s", path);
  begin(address, NULL);
  free(address);
}

static void end(void)
{
  void *status;
  __atomic_store_n(&interrupted, 1, __ATOMIC_RELAXED);
  pthread_join(server, &status);
  serving = false;
  assert_int_equal(*(int *)status, BRECCIA_OK);
}

/** After a test that failed: those that follow begin a server of their own. */
static int end_what_serves(void **state)
{
  (void)state;
  if (serving) end();
  return 0;
}

typedef struct Line {
  Channel *channel;
  uint32_t sequence, session;
  uint32_t operation, count; /* of the last answer */
  char text[2000];           /* its payload */
} Line;

static Line connect_to(const char *address)
{
  Text words = {0};
  Line line = {.channel = channel_connect(address, PATIENCE, NULL, NULL, &words)};
  if (!line.channel) fail_msg("%s: %s", address, text_words(&words));
  return line;
}

static void send_frame(Line *line, Operation operation, uint32_t flags, uint32_t count, const void *body, size_t size)
{
  Text words = {0};
  memcpy(channel_payload(line->channel, size), body, size);
  const Frame frame = {.version = FRAME_VERSION,
                       .operation = (uint16_t)operation,
                       .sequence = ++line->sequence,
                       .flags = flags,
                       .count = count,
                       .length = (uint32_t)size,
                       .session = line->session};
  assert_int_equal(channel_send(line->channel, &frame, PATIENCE, &words), CHANNEL_OK);
}

static void hear(Line *line)
{
  Text words = {0};
  Frame frame = {0};
  uint8_t *payload;
  const ChannelStatus status = channel_receive(line->channel, &frame, &payload, PATIENCE, &words);
  if (status) fail_msg("no answer: %s", text_words(&words));
  line->operation = frame.operation;
  line->count = frame.count;
  if (frame.session) line->session = frame.session;
  memcpy(line->text, payload, frame.length < sizeof line->text ? frame.length + 1 : sizeof line->text);
}

/** Asks, and fails the test unless the answer holds the words. */
static void ask(Line *line, Operation operation, uint32_t flags, uint32_t count, const void *body, size_t size,
                const char *words)
{
  send_frame(line, operation, flags, count, body, size);
  hear(line);
  if (!strstr(line->text, words)) fail_msg("expected '%s', found '%s'", words, line->text);
}

static void say(Line *line, Operation operation, uint32_t count, const char *body, const char *words)
{
  ask(line, operation, 0, count, body, strlen(body), words);
}

/** Waits until the other side has closed the line; what still comes is dropped. */
static void await_end(Line *line)
{
  char bytes[256];
  for (;;) {
    struct pollfd p = {.fd = channel_socket(line->channel), .events = POLLIN};
    if (poll(&p, 1, 1000 * PATIENCE) != 1) fail_msg("the line is still open after %d s", PATIENCE);
    if (recv(p.fd, bytes, sizeof bytes, 0) <= 0) break;
  }
  channel_close(&line->channel);
}

static const char hello[] = "client: test\n";
/* A bar that yields at 1 ‰. */
static const char steel[] = "command: elastic-perfectly-plastic; Young modulus=2e8; yield stress=2e5\n";
static const double YIELD_STRAIN = 1e-3, YIELD_STRESS = 2e5;

/* ---- what is committed ---- */

/** The stress of one point, whose trial may be preceded by a commit. */
static double pull(Line *line, uint32_t point, double strain, uint32_t flags)
{
  uint8_t body[16];
  double stress;
  const uint32_t head[2] = {point, 0};
  memcpy(body, head, 8);
  memcpy(body + 8, &strain, 8);
  ask(line, OPERATION_TRIAL, flags, 1, body, sizeof body, "");
  if (line->operation != (OPERATION_TRIAL | OPERATION_ANSWER)) fail_msg("%s", line->text);
  memcpy(&stress, line->text, sizeof stress);
  return stress;
}

static void partial_trials_keep_the_state_of_the_others(void **state)
{
  (void)state;
  char path[128];
  begin_at_file(path);
  Line line = connect_to(where);
  say(&line, OPERATION_HELLO, 0, hello, "session: 0\n");
  say(&line, OPERATION_CREATE, 3, steel, "components: 1\n");
  /* Point 0 is drawn to three times its yield strain: two of them stay when it is unloaded. */
  assert_near(pull(&line, 0, 3 * YIELD_STRAIN, 0), YIELD_STRESS, 1e-6);
  say(&line, OPERATION_COMMIT, 0, "", "");
  for (int n = 0; n < 3; ++n) { /* others go on, with commits of either kind */
    assert_near(pull(&line, 1, 0.5 * YIELD_STRAIN, 0), 0.5 * YIELD_STRESS, 1e-6);
    if (n == 1) {
      assert_near(pull(&line, 2, 0.5 * YIELD_STRAIN, TRIAL_COMMITS_BEFORE), 0.5 * YIELD_STRESS, 1e-6);
    }
    say(&line, OPERATION_COMMIT, 0, "", "");
    assert_near(pull(&line, 0, 2 * YIELD_STRAIN, 0), 0, 1e-6);
    say(&line, OPERATION_REVERT, 0, "", "");
  }
  /* A trial that was reverted is not committed with those of others. */
  pull(&line, 0, -3 * YIELD_STRAIN, 0);
  say(&line, OPERATION_REVERT, 0, "", "");
  pull(&line, 1, 0, 0);
  say(&line, OPERATION_COMMIT, 0, "", "");
  assert_near(pull(&line, 0, 2 * YIELD_STRAIN, 0), 0, 1e-6);
  say(&line, OPERATION_REVERT, 0, "", "");
  say(&line, OPERATION_COMMIT, 0, "", "there is no trial to commit");
  /* All points together, twice: the last trial counts. */
  for (uint32_t k = 0; k < 3; ++k) pull(&line, k, 5 * YIELD_STRAIN, 0);
  for (uint32_t k = 0; k < 3; ++k) pull(&line, k, (2.0 + k) * YIELD_STRAIN, 0);
  say(&line, OPERATION_COMMIT, 0, "", "");
  assert_near(pull(&line, 0, YIELD_STRAIN, 0), -YIELD_STRESS, 1e-6);
  assert_near(pull(&line, 1, 2 * YIELD_STRAIN, 0), 0, 1e-6);
  assert_near(pull(&line, 2, 2.5 * YIELD_STRAIN, 0), -0.5 * YIELD_STRESS, 1e-6);
  channel_close(&line.channel);
  end();
}

/** Opens the servers of a bar that yields. */
static Remote *open_steel(Error *error)
{
  Remote *remote = NULL;
  const char *addresses[1] = {where};
  const RemoteSpec wishes = {.material = "steel",
                             .command = strchr(steel, ' ') + 1,
                             .stage = -1,
                             .servers = addresses,
                             .server_count = 1,
                             .timeout = PATIENCE,
                             .stress_unit = 1,
                             .units = {"m", "N", "s"},
                             .length = NAN};
  if (remote_open(&remote, &wishes, error)) fail_msg("%s", breccia_error_text(error));
  return remote;
}

/** Takes up the points of a session from a checkpoint at this commit, as of a server that saves nothing.
 *  @return what a client then is told of, or "" if it has them */
static const char *take_up(Remote **remote, uint32_t session, double commit)
{
  static char words[500];
  Error *error = breccia_error_create();
  const double identity[IDENTITY] = {session, commit};
  const int64_t starts[2] = {0, 2};
  *remote = open_steel(error);
  (*remote)->saves = false;
  (*remote)->state = 0;
  const int status = remote_resume(*remote, starts, NULL, identity, error);
  snprintf(words, sizeof words, "%s", status ? breccia_error_text(error) : "");
  breccia_error_destroy(&error);
  return words;
}

/* A commit goes with the trial that follows it. A checkpoint that counts one more than the server has therefore asks for the trial that is
 * still there; one that counts less is older than what the server remembers, and no server goes back. */
static void a_checkpoint_may_be_one_commit_ahead_of_its_server_and_never_behind(void **state)
{
  (void)state;
  char path[128];
  begin_at_file(path);
  Line line = connect_to(where);
  say(&line, OPERATION_HELLO, 0, hello, "session: 0\n");
  say(&line, OPERATION_CREATE, 2, steel, "components: 1\n");
  const uint32_t session = line.session;
  pull(&line, 0, 3 * YIELD_STRAIN, 0);
  say(&line, OPERATION_COMMIT, 0, "", "");
  pull(&line, 0, 5 * YIELD_STRAIN, 0); /* to be committed with the next one, which never comes */
  channel_close(&line.channel);

  static const struct {
    double commit;
    const char *words;
  } table[] = {{0, "is at commit 1, the checkpoint at commit 0"}, /* the server is ahead */
               {3, "is at commit 1, the checkpoint at commit 3"},
               {2, ""}, /* one commit behind */
               {1, "is at commit 2, the checkpoint at commit 1"},
               {2, ""}};
  for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
    Remote *remote = NULL;
    const char *words = take_up(&remote, session, table[k].commit);
    if (table[k].words[0] ? !strstr(words, table[k].words) : words[0])
      fail_msg("checkpoint at commit %g: '%s'", table[k].commit, words);
    if (!words[0]) { /* four times the yield strain has stayed in point 0, nothing in point 1 */
      double *strains = remote_strains(remote, 0);
      int64_t bad;
      strains[0] = 4.5 * YIELD_STRAIN;
      strains[1] = 0.25 * YIELD_STRAIN;
      remote_post(remote, 0);
      assert_true(remote_collect(remote, 0, &bad));
      assert_near(remote_stresses(remote, 0)[0], 0.5 * YIELD_STRESS, 1e-6);
      assert_near(remote_stresses(remote, 0)[1], 0.25 * YIELD_STRESS, 1e-6);
    }
    remote_close(&remote);
  }
  end();
}

/** Plastic strain of a point: each has its own. */
static double plastic_strain(int point)
{
  return (1 + 1e-3 * point) * YIELD_STRAIN;
}

/** Draws each point to so many yield strains beyond its plastic strain. @return their stresses */
static const double *pull_all(Remote *remote, int count, double beyond)
{
  double *strains = remote_strains(remote, 0);
  int64_t bad;
  for (int i = 0; i < count; ++i) strains[i] = plastic_strain(i) + beyond * YIELD_STRAIN;
  remote_post(remote, 0);
  if (!remote_collect(remote, 0, &bad)) fail_msg("%s", remote_problem(remote));
  return remote_stresses(remote, 0);
}

/** Histories of more points than a datagram holds go out and come back in several frames, each point with its own. */
static void histories_that_fill_many_frames_are_restored(void **state)
{
  (void)state;
  enum { POINTS = 5000 }; /* three frames of a quarter of a datagram */
  const int64_t starts[2] = {0, POINTS};
  begin_with((ServeSpec){.address = "udp://127.0.0.1:0"});
  Error *error = breccia_error_create();
  double *saved = calloc(POINTS, sizeof *saved), identity[IDENTITY];
  Remote *remote = open_steel(error);
  assert_int_equal(remote_state_values(remote), 1);
  assert_int_equal(remote_begin(remote, starts, error), BRECCIA_OK);
  pull_all(remote, POINTS, 1);
  remote_commit(remote);
  assert_int_equal(remote_identify(remote, identity, error), BRECCIA_OK);
  assert_int_equal(remote_save(remote, saved, error), BRECCIA_OK);
  for (int i = 0; i < POINTS; ++i) assert_near(saved[i], plastic_strain(i), 1e-15);
  remote_close(&remote);
  remote = open_steel(error);
  if (remote_resume(remote, starts, saved, identity, error)) fail_msg("%s", breccia_error_text(error));
  const double *stresses = pull_all(remote, POINTS, -0.5);
  for (int i = 0; i < POINTS; ++i) assert_near(stresses[i], -0.5 * YIELD_STRESS, 1e-6);
  remote_close(&remote);
  free(saved);
  breccia_error_destroy(&error);
  end();
}

/** The bulk modulus that a law is said to have, in the client's units. */
static void bulk_is(Line *line, Operation operation, const char *units, double bulk)
{
  char body[200], *found;
  snprintf(body, sizeof body, "%scommand: elastic; Young modulus=1 MPa; Poisson ratio=0.2\n", units);
  say(line, operation, 1, body, "bulk: ");
  found = strstr(line->text, "bulk: ");
  assert_near(strtod(found + strlen("bulk: "), NULL), bulk, 1e-12 * bulk);
}

/* K = E/(3(1 - 2ν)) = 5/9 MPa, however often clients change their units, and after units that there are not. */
static void units_are_those_of_who_asks(void **state)
{
  (void)state;
  char path[128];
  static const char millimetres[] = "length unit: mm\n", both[] = "length unit: mm\nforce unit: kN\n";
  begin_at_file(path);
  for (int client = 0; client < 2; ++client) {
    Line line = connect_to(where);
    say(&line, OPERATION_HELLO, 0, hello, "program: breccia serve\n");
    bulk_is(&line, OPERATION_CREATE, "", 5e6 / 9);
    bulk_is(&line, OPERATION_PROBE, "", 5e6 / 9);
    bulk_is(&line, OPERATION_PROBE, millimetres, 5.0 / 9);
    bulk_is(&line, OPERATION_CREATE, both, 5e-3 / 9);
    say(&line, OPERATION_PROBE, 1, "length unit: kN\ncommand: elastic; Young modulus=1; Poisson ratio=0\n",
        "unit 'kN' is not a unit of length");
    bulk_is(&line, OPERATION_CREATE, millimetres, 5.0 / 9);
    say(&line, OPERATION_BYE, 0, "", "");
    await_end(&line);
  }
  end();
}

/** A trial of some points, as many strains as bytes are sent of. */
static void try_points(Line *line, uint32_t flags, uint32_t first, uint32_t count, size_t bytes, const char *words)
{
  uint8_t body[400] = {0};
  memcpy(body, &first, sizeof first);
  ask(line, OPERATION_TRIAL, flags, count, body, bytes, words);
}

static void what_a_server_cannot_do_is_said_and_changes_nothing(void **state)
{
  (void)state;
  char path[128];
  begin_at_file(path);
  Line line = connect_to(where);
  say(&line, OPERATION_HELLO, 0, hello, "session: 0\npoints: 0\ncommits: 0\n");
  say(&line, OPERATION_COMMIT, 0, "", "session 0 is not held here");
  say(&line, OPERATION_CREATE, 4194305, steel, "4194305 points are more than a server takes (4194304)");
  say(&line, OPERATION_CREATE, 2, "command: steel; Young modulus=1\n",
      "there is no law 'steel'; a command is 'LAW; KEY=VALUE; ...' with one of ");
  say(&line, OPERATION_CREATE, 2, "command: elastic-1d; Young modulus=1\nstage: 2\n",
      "a stage is 0 (elastic) or 1 (plastic)");
  say(&line, OPERATION_CREATE, 2, "command: elastic-1d\n", "missing 'Young modulus=...'");
  say(&line, OPERATION_CREATE, 2, steel, "components: 1\n");
  const uint32_t session = line.session;
  assert_true(session != 0);
  pull(&line, 0, 3 * YIELD_STRAIN, 0);
  line.session = session + 1;
  say(&line, OPERATION_COMMIT, 0, "", "session ");
  assert_non_null(strstr(line.text, " is not held here"));
  line.session = session;
  say(&line, (Operation)77, 0, "", "operation 77 is unknown");
  try_points(&line, 0, 0, 1, 4, "1 strains were announced, and 4 bytes came");
  try_points(&line, 0, 0, 2, 16, "2 strains were announced, and 16 bytes came");
  try_points(&line, 0, 1, 2, 24, "points 1 to 2 were asked for; there are 2");
  try_points(&line, 0, 2, 1, 16, "points 2 to 2 were asked for; there are 2");
  ask(&line, OPERATION_SAVE, 0, 3, (uint32_t[2]){0}, 8,
      "histories of 3 points from 0 on were asked for; there are 2 points");
  ask(&line, OPERATION_SAVE, 0, 2, (uint32_t[2]){1}, 8,
      "histories of 2 points from 1 on were asked for; there are 2 points");
  ask(&line, OPERATION_RESTORE, 0, 1, (uint32_t[2]){0}, 8, "histories of 1 points from 0 on");
  /* Of another version it takes nothing, whoever speaks. */
  Text words = {0};
  channel_payload(line.channel, 0);
  const Frame frame = {
      .version = FRAME_VERSION + 1, .operation = OPERATION_COMMIT, .sequence = ++line.sequence, .session = session};
  assert_int_equal(channel_send(line.channel, &frame, PATIENCE, &words), CHANNEL_OK);
  hear(&line);
  assert_string_equal(line.text, "this server speaks version 1 of the protocol, the client version 2");
  assert_int_equal(line.operation, OPERATION_ERROR);
  /* The trial of before is there still, and the other point has none. */
  say(&line, OPERATION_COMMIT, 0, "", "");
  assert_near(pull(&line, 0, 2 * YIELD_STRAIN, 0), 0, 1e-6);
  assert_near(pull(&line, 1, 0.5 * YIELD_STRAIN, 0), 0.5 * YIELD_STRESS, 1e-6);
  say(&line, OPERATION_STATISTICS, 0, "", "evaluations: 3\ncommits: 1\n");
  static const Operation nothing[] = {OPERATION_COMMIT, OPERATION_REVERT, OPERATION_BYE};
  for (int k = 0; k < 3; ++k) { /* answered with nothing */
    say(&line, nothing[k], 0, "", "");
    assert_int_equal(line.operation, nothing[k] | OPERATION_ANSWER);
    assert_int_equal(line.count, 0);
    assert_string_equal(line.text, "");
  }
  channel_close(&line.channel);
  end();
}

static void a_law_is_told_whole_and_saved_and_restored(void **state)
{
  (void)state;
  char path[128];
  begin_at_file(path);
  Line line = connect_to(where);
  say(&line, OPERATION_HELLO, 0, hello, "program: breccia serve\nversion: ");
  say(&line, OPERATION_PROBE, 0, " command: \ncommand: elastic-brittle ; Young modulus=5 ; tensile strength=10;\n",
      "components: 1\nbulk: 3.3333333333333335\nshear: 2\nfailure: 2\nstate: 1\niterates: 1\nsaves: 1\nsession: 0\n");
  say(&line, OPERATION_PROBE, 0, "command: elastic; bulk modulus=5; shear modulus=3\n",
      "components: 6\nbulk: 5\nshear: 3\nfailure: inf\nstate: 0\niterates: 1\nsaves: 1\nsession: 0\n");
  say(&line, OPERATION_LAWS, 0, "", "space: elastic ");
  const char *uniaxial = strstr(line.text, "\nuniaxial: elastic-1d ");
  assert_non_null(uniaxial);
  for (int k = 0; breccia_law_at(k); ++k) {
    char name[64];
    snprintf(name, sizeof name, " %s", breccia_law_at(k)->name);
    const char *found = line.text;
    while ((found = strstr(found, name)) && !strchr(" \n", found[strlen(name)])) ++found;
    if (!found || (found > uniaxial) != (breccia_law_at(k)->components == 1)) fail_msg("%s: %s", name, line.text);
  }
  /* What is saved of one point is restored into the other; a trial that was under way is forgotten. */
  double saved, body[2];
  say(&line, OPERATION_CREATE, 2, steel, "components: 1\n");
  pull(&line, 1, 3 * YIELD_STRAIN, 0);
  say(&line, OPERATION_COMMIT, 0, "", "");
  ask(&line, OPERATION_SAVE, 0, 1, (uint32_t[2]){1}, 8, "");
  assert_int_equal(line.count, 1);
  memcpy(&saved, line.text, sizeof saved);
  assert_near(saved, 2 * YIELD_STRAIN, 1e-15);
  pull(&line, 1, 9 * YIELD_STRAIN, 0);
  memset(body, 0, sizeof body);
  body[1] = saved;
  ask(&line, OPERATION_RESTORE, 0, 1, body, sizeof body, "");
  assert_int_equal(line.operation, OPERATION_RESTORE | OPERATION_ANSWER);
  say(&line, OPERATION_COMMIT, 0, "", "there is no trial to commit");
  for (uint32_t k = 0; k < 2; ++k) assert_near(pull(&line, k, 2.5 * YIELD_STRAIN, 0), 0.5 * YIELD_STRESS, 1e-6);
  channel_close(&line.channel);
  end();
}

/** A datagram with one wrong bit is dropped as if it had been lost, and the next whole one is received. */
static void a_damaged_datagram_counts_as_lost(void **state)
{
  (void)state;
  static const char words[] = "words";
  int ends[2];
  uint8_t bytes[FRAME_HEADER + sizeof words], *payload;
  Frame frame = {.operation = OPERATION_LAWS, .length = sizeof words};
  Text reason = {0};
  assert_int_equal(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends), 0);
  Channel *channel = channel_over(ends[1], true, false);
  assert_non_null(channel);
  memcpy(bytes + FRAME_HEADER, words, sizeof words);
  frame_seal(&frame, bytes);
  for (size_t k = 0; k < sizeof words; ++k) {
    bytes[FRAME_HEADER + k] ^= 1;
    assert_int_equal(send(ends[0], bytes, sizeof bytes, 0), sizeof bytes);
    bytes[FRAME_HEADER + k] ^= 1;
  }
  assert_int_equal(channel_receive(channel, &frame, &payload, 0.01, &reason), CHANNEL_LATE);
  assert_int_equal(send(ends[0], bytes, sizeof bytes, 0), sizeof bytes);
  assert_int_equal(channel_receive(channel, &frame, &payload, PATIENCE, &reason), CHANNEL_OK);
  assert_memory_equal(payload, words, sizeof words);
  text_free(&reason);
  channel_close(&channel);
  close(ends[0]);
}

/* ---- who is served ---- */

static void strangers_cannot_speak_for_a_client(void **state)
{
  (void)state;
  begin("udp://127.0.0.1:0", NULL);
  Line client = connect_to(where), stranger = connect_to(where);
  say(&stranger, OPERATION_CREATE, 1, steel, "a client says HELLO first");
  say(&client, OPERATION_HELLO, 0, hello, "points: 0\n");
  say(&client, OPERATION_CREATE, 2, steel, "components: 1\n");
  pull(&client, 0, 3 * YIELD_STRAIN, 0);
  /* It even knows the session and the number of the next frame. */
  stranger.session = client.session;
  stranger.sequence = client.sequence;
  say(&stranger, OPERATION_COMMIT, 0, "", "a client says HELLO first");
  say(&stranger, OPERATION_CREATE, 1, steel, "a client says HELLO first");
  say(&stranger, OPERATION_BYE, 0, "", "a client says HELLO first");
  say(&stranger, OPERATION_HELLO, 0, hello, "the server is busy with another client");
  /* What was answered before is answered once more, and points and trial are as they were. */
  --client.sequence;
  assert_near(pull(&client, 0, 3 * YIELD_STRAIN, 0), YIELD_STRESS, 1e-6);
  say(&client, OPERATION_STATISTICS, 0, "", "evaluations: 1\n");
  say(&client, OPERATION_COMMIT, 0, "", "");
  say(&client, OPERATION_HELLO, 0, hello, "points: 2\ncommits: 1\n");
  say(&client, OPERATION_BYE, 0, "", "");
  say(&client, OPERATION_COMMIT, 0, "", "a client says HELLO first");
  say(&stranger, OPERATION_HELLO, 0, hello, "points: 2\ncommits: 1\n");
  channel_close(&client.channel);
  channel_close(&stranger.channel);
  end();
}

static void a_silent_client_of_datagrams_makes_room(void **state)
{
  (void)state;
  begin_with((ServeSpec){.address = "udp://127.0.0.1:0", .silence = 0.2});
  Line client = connect_to(where), next = connect_to(where);
  say(&client, OPERATION_HELLO, 0, hello, "points: 0\n");
  say(&client, OPERATION_CREATE, 2, steel, "components: 1\n");
  pull(&client, 0, 3 * YIELD_STRAIN, 0);
  say(&client, OPERATION_COMMIT, 0, "", "");
  const double begun = clock_seconds();
  for (;;) { /* until the silence has lasted long enough */
    say(&next, OPERATION_HELLO, 0, hello, "");
    if (next.operation == (OPERATION_HELLO | OPERATION_ANSWER)) break;
    if (!strstr(next.text, "the server is busy with another client")) fail_msg("%s", next.text);
    if (clock_seconds() - begun > PATIENCE) fail_msg("still busy after %d s", PATIENCE);
    nanosleep(&(struct timespec){.tv_nsec = 20000000L}, NULL);
  }
  assert_true(clock_seconds() - begun >= 0.2);
  /* The points are as they were; who was silent is a stranger now. */
  if (!strstr(next.text, "points: 2\ncommits: 1\n")) fail_msg("%s", next.text);
  say(&client, OPERATION_COMMIT, 0, "", "a client says HELLO first");
  assert_near(pull(&next, 0, 2 * YIELD_STRAIN, 0), 0, 1e-6);
  channel_close(&client.channel);
  channel_close(&next.channel);
  end();
}

static void who_does_not_know_the_secret_holds_nothing(void **state)
{
  (void)state;
  static const char *const addresses[] = {"tcp://127.0.0.1:0", "udp://127.0.0.1:0"};
  for (int k = 0; k < 2; ++k) {
    begin(addresses[k], "sesame");
    Line stranger = connect_to(where), client = connect_to(where);
    say(&stranger, OPERATION_HELLO, 0, "secret: sesam\n", "the secret is wrong");
    say(&client, OPERATION_HELLO, 0, "secret: sesame\n", "points: 0\n");
    if (k) say(&stranger, OPERATION_HELLO, 0, "secret: sesam\n", "the secret is wrong");
    say(&client, OPERATION_CREATE, 1, steel, "components: 1\n");
    channel_close(&client.channel);
    channel_close(&stranger.channel);
    end();
  }
}

/** The first `size` bytes of a greeting that announces a payload of `length` bytes. */
static Line begin_to_greet(size_t size, uint32_t length)
{
  Line line = connect_to(where);
  uint8_t bytes[FRAME_HEADER + sizeof hello];
  memcpy(bytes + FRAME_HEADER, hello, sizeof hello - 1);
  frame_seal(&(Frame){.version = FRAME_VERSION, .operation = OPERATION_HELLO, .length = sizeof hello - 1}, bytes);
  memcpy(bytes + 20, &length, sizeof length);
  assert_int_equal(send(channel_socket(line.channel), bytes, size, MSG_NOSIGNAL), size);
  return line;
}

static void silent_and_slow_clients_hold_nobody_up(void **state)
{
  (void)state;
  char path[128];
  begin_at_file(path);
  enum { MANY = 12 }; /* more than a server listens to at a time */
  Line idle[MANY];
  for (int k = 0; k < MANY; ++k) idle[k] = begin_to_greet((size_t)(k % 3) * 20, sizeof hello - 1);
  Line client = connect_to(where);
  say(&client, OPERATION_HELLO, 0, hello, "points: 0\n");
  say(&client, OPERATION_CREATE, 1, steel, "components: 1\n");
  Line late = connect_to(where);
  say(&late, OPERATION_HELLO, 0, hello, "the server is busy with another client");
  await_end(&late);
  assert_near(pull(&client, 0, YIELD_STRAIN, 0), YIELD_STRESS, 1e-6);
  for (int k = 0; k < MANY; ++k) await_end(&idle[k]); /* they are let go after some seconds */
  say(&client, OPERATION_STATISTICS, 0, "", "evaluations: 1\n");
  channel_close(&client.channel);
  end();
}

static void first_frames_are_bounded(void **state)
{
  (void)state;
  char path[128];
  begin_at_file(path);
  Line line = begin_to_greet(FRAME_HEADER, 1 << 28);
  hear(&line);
  assert_string_equal(line.text, "a first frame of 268435456 bytes was announced; a greeting has at most 4096");
  await_end(&line);
  line = begin_to_greet(FRAME_HEADER, 0xffffffffu);
  hear(&line);
  assert_string_equal(line.text, "a frame of 4294967295 bytes was announced; the most is 268435456");
  await_end(&line);
  line = connect_to(where);
  say(&line, OPERATION_TRIAL, 0, "", "a client says HELLO first");
  await_end(&line);
  line = connect_to(where);
  assert_int_equal(send(channel_socket(line.channel), "GET / HTTP/1.0\r\nHost: example\r\n\r\n", 33, MSG_NOSIGNAL), 33);
  hear(&line);
  assert_int_equal(line.operation, OPERATION_ERROR);
  assert_non_null(strstr(line.text, "no frame of a material server"));
  await_end(&line);
  line = connect_to(where);
  say(&line, OPERATION_HELLO, 0, hello, "points: 0\n");
  say(&line, OPERATION_CREATE, 1, "command: elastic-1d; Young modulus=1\nstage: 2\n",
      "a stage is 0 (elastic) or 1 (plastic)");
  channel_close(&line.channel);
  end();
}

/* ---- addresses and socket files ---- */

static void addresses_are_refused_in_words(void **state)
{
  (void)state;
  static const struct {
    const char *address, *words;
  } table[] = {
      {"tcp://127.0.0.1:65536", "'65536' is no port: expected a number from "},
      {"tcp://127.0.0.1:99999", "'99999' is no port: expected a number from "},
      {"udp://127.0.0.1:4294967376", "'4294967376' is no port: expected a number from "},
      {"tcp://127.0.0.1:-1", "'-1' is no port: expected a number from "},
      {"tcp://127.0.0.1:80x", "'80x' is no port: expected a number from "},
      {"tcp://127.0.0.1:", "an address is tcp://HOST:PORT"},
      {"tcp://:80", "an address is tcp://HOST:PORT"},
      {"tcp://[]:80", "an address is tcp://HOST:PORT"},
      {"unix:", "the path of a socket must have 1 to 107 characters"},
  };
  for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
    Error *error = breccia_error_create();
    assert_int_equal(serve_materials(&(ServeSpec){.address = table[k].address}, error), BRECCIA_USER_ERROR);
    assert_non_null(strstr(breccia_error_text(error), table[k].words));
    breccia_error_destroy(&error);
    Text words = {0};
    assert_null(channel_connect(table[k].address, 0, NULL, NULL, &words));
    assert_non_null(strstr(text_words(&words), table[k].words));
    text_free(&words);
  }
  Text words = {0};
  assert_null(channel_connect("tcp://127.0.0.1:0", 0, NULL, NULL, &words));
  assert_string_equal(text_words(&words), "'0' is no port: expected a number from 1 to 65535");
  text_free(&words);
}

static int count_call(void *context)
{
  ++*(int *)context;
  return 0;
}

/** Between two tries to reach a server that is not there yet, 20 ms pass in sleep. */
static void who_waits_for_a_server_sleeps_between_tries(void **state)
{
  (void)state;
  const double seconds = 0.2, begin = clock_seconds();
  Text words = {0};
  int tries = 0;
  assert_null(channel_connect("unix:/there is no such folder/socket", seconds, count_call, &tries, &words));
  assert_true(clock_seconds() - begin >= seconds);
  assert_true(tries <= 2 + seconds / 0.02);
  assert_true(text_words(&words)[0]);
  text_free(&words);
}

static void hosts_with_colons_stand_in_brackets(void **state)
{
  (void)state;
  const int s = socket(AF_INET6, SOCK_STREAM, 0);
  const struct sockaddr_in6 loop = {.sin6_family = AF_INET6, .sin6_addr = IN6ADDR_LOOPBACK_INIT};
  const bool there = s >= 0 && !bind(s, (const struct sockaddr *)(const void *)&loop, sizeof loop);
  if (s >= 0) close(s);
  if (!there) skip(); /* a machine without such addresses */
  begin("tcp://[::1]:0", NULL);
  Line client = connect_to(where);
  say(&client, OPERATION_HELLO, 0, hello, "points: 0\n");
  channel_close(&client.channel);
  end();
}

static void write_file(const char *path)
{
  FILE *file = fopen(path, "w");
  fputs("results", file);
  fclose(file);
}

static bool is_ordinary(const char *path)
{
  struct stat status;
  return !stat(path, &status) && S_ISREG(status.st_mode) && status.st_size == 7;
}

static void only_sockets_of_their_own_are_removed(void **state)
{
  (void)state;
  char path[128];
  snprintf(path, sizeof path, "%s/socket", folder);
  char *address = text_format("unix:%s", path);
  write_file(path);
  Error *error = breccia_error_create();
  assert_int_equal(serve_materials(&(ServeSpec){.address = address}, error), BRECCIA_USER_ERROR);
  breccia_error_destroy(&error);
  assert_true(is_ordinary(path));
  unlink(path);

  begin_at_file(path);
  end();
  assert_int_not_equal(access(path, F_OK), 0);

  begin_at_file(path);
  unlink(path);
  write_file(path);
  end();
  assert_true(is_ordinary(path));
  unlink(path);
  free(address);
}

static void a_server_ends_while_a_client_is_slow(void **state)
{
  (void)state;
  char path[128];
  begin_at_file(path);
  Line line = connect_to(where);
  say(&line, OPERATION_HELLO, 0, hello, "points: 0\n");
  assert_int_equal(send(channel_socket(line.channel), "BRMS", 4, MSG_NOSIGNAL), 4);
  const double start = clock_seconds();
  end();
  assert_true(clock_seconds() - start <
              PATIENCE); /* it does not wait for the rest of the frame, which would take a minute */
  assert_int_not_equal(access(path, F_OK), 0);
  channel_close(&line.channel);
}

static int make_folder(void **state)
{
  (void)state;
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
  (void)state;
  return rmdir(folder); /* nothing has stayed behind */
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_teardown(partial_trials_keep_the_state_of_the_others, end_what_serves),
      cmocka_unit_test_teardown(a_checkpoint_may_be_one_commit_ahead_of_its_server_and_never_behind, end_what_serves),
      cmocka_unit_test_teardown(histories_that_fill_many_frames_are_restored, end_what_serves),
      cmocka_unit_test_teardown(units_are_those_of_who_asks, end_what_serves),
      cmocka_unit_test_teardown(what_a_server_cannot_do_is_said_and_changes_nothing, end_what_serves),
      cmocka_unit_test_teardown(a_law_is_told_whole_and_saved_and_restored, end_what_serves),
      cmocka_unit_test(a_damaged_datagram_counts_as_lost),
      cmocka_unit_test_teardown(strangers_cannot_speak_for_a_client, end_what_serves),
      cmocka_unit_test_teardown(a_silent_client_of_datagrams_makes_room, end_what_serves),
      cmocka_unit_test_teardown(who_does_not_know_the_secret_holds_nothing, end_what_serves),
      cmocka_unit_test_teardown(silent_and_slow_clients_hold_nobody_up, end_what_serves),
      cmocka_unit_test_teardown(first_frames_are_bounded, end_what_serves),
      cmocka_unit_test_teardown(addresses_are_refused_in_words, end_what_serves),
      cmocka_unit_test_teardown(who_waits_for_a_server_sleeps_between_tries, end_what_serves),
      cmocka_unit_test_teardown(hosts_with_colons_stand_in_brackets, end_what_serves),
      cmocka_unit_test_teardown(only_sockets_of_their_own_are_removed, end_what_serves),
      cmocka_unit_test_teardown(a_server_ends_while_a_client_is_slow, end_what_serves),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
