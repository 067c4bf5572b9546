/* What a server says of itself: where it is, and what it cannot do. */
#include "support.h"

#include "base/checksum.h"
#include "constitutive/remote/channel.h"
#include "constitutive/remote/remote.h"

#include <pthread.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { PATIENCE = 30 }; /* seconds, for what comes at once */

static char folder[] = "/tmp/breccia-server-XXXXXX";

/** What a server does wrong when it is asked for a trial. */
typedef enum Wrong {
  NOTHING_WRONG,
  STRESS_OF_NONE,
  TANGENT_OF_NONE,
  ONE_POINT_LESS,
  ONE_NUMBER_LESS,
  OTHER_OPERATION,
  OTHER_FRAME,
  OTHER_VERSION,
  REFUSAL,
  REFUSAL_OF_A_POINT,
  REFUSAL_WITHOUT_WORDS,
  NO_FRAME,
  CLOSED_LINE,
  LATENESS,
  WRONGS
} Wrong;

/** A server that saves nothing, at some commit of session 77 with three points. */
typedef struct Script {
  int listener, commits, commits_asked;
  bool iterates;
  Wrong wrong;
  uint32_t flags, first, count; /* of the last trial */
  double strain[18];
  struct sockaddr_un at;
  pthread_t player;
} Script;

/** The answer to a trial: stress k of point i is 10 i + k, tangent k, j of it 100 i + 10 k + j. */
static void answer_trial(Script *script, Channel *c, const Frame *asked, const uint8_t *payload)
{
  const uint32_t n = asked->count;
  double numbers[3 * 42];
  memcpy(&script->first, payload, sizeof script->first);
  memcpy(script->strain, payload + 8, sizeof(double) * 6 * n);
  script->flags = asked->flags;
  script->count = n;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t k = 0; k < 6; ++k) numbers[6 * i + k] = 10 * i + k;
    for (uint32_t k = 0; k < 36; ++k) numbers[6 * n + 36 * i + k] = 100 * i + 10 * (k / 6) + k % 6;
  }
  if (script->wrong == STRESS_OF_NONE) numbers[6 * n - 1] = NAN;
  if (script->wrong == TANGENT_OF_NONE) numbers[6 * n + 1] = INFINITY;
  const bool refuses =
      script->wrong == REFUSAL || script->wrong == REFUSAL_OF_A_POINT || script->wrong == REFUSAL_WITHOUT_WORDS;
  const char *words = script->wrong == REFUSAL_WITHOUT_WORDS ? "" : "not today";
  const uint32_t size = (uint32_t)sizeof(double) * (6 * n + (asked->flags & TRIAL_WANTS_TANGENT ? 36 * n : 0));
  const Frame answer = {.version = script->wrong == OTHER_VERSION ? 9 : FRAME_VERSION,
                        .operation = refuses                            ? OPERATION_ERROR
                                     : script->wrong == OTHER_OPERATION ? OPERATION_SAVE | OPERATION_ANSWER
                                                                        : OPERATION_TRIAL | OPERATION_ANSWER,
                        .sequence = asked->sequence + (script->wrong == OTHER_FRAME),
                        .flags = script->wrong == REFUSAL_OF_A_POINT,
                        .count = script->wrong == REFUSAL_OF_A_POINT ? 1 : n - (script->wrong == ONE_POINT_LESS),
                        .length = refuses ? (uint32_t)strlen(words) : size - (script->wrong == ONE_NUMBER_LESS ? 8 : 0),
                        .session = 77};
  Text reason = {0};
  memcpy(channel_payload(c, size), refuses ? (const void *)words : numbers, answer.length);
  if (script->wrong == NO_FRAME)
    assert_int_equal(write(channel_socket(c), "HTTP/1.1 200 OK and whatever else a server of pages says", 56), 56);
  else if (script->wrong != LATENESS)
    channel_send(c, &answer, PATIENCE, &reason);
  text_free(&reason);
}

static void *play(void *context)
{
  Script *script = context;
  Channel *c = channel_over(accept(script->listener, NULL, NULL), false, false);
  Frame frame = {0};
  uint8_t *payload;
  Text words = {0};
  while (frame.operation != OPERATION_BYE && channel_receive(c, &frame, &payload, PATIENCE, &words) == CHANNEL_OK) {
    Text reply = {0};
    if (frame.operation == OPERATION_HELLO) text_add(&reply, "session: 77\npoints: 3\ncommits: %d\n", script->commits);
    if (frame.operation == OPERATION_PROBE)
      text_add(&reply, "components: 6\nbulk: 2\nshear: 1\nstate: 0\niterates: %d\nsaves: 0\n", script->iterates);
    script->commits_asked += frame.operation == OPERATION_COMMIT;
    if (frame.operation == OPERATION_TRIAL) {
      if (script->wrong == CLOSED_LINE) break;
      answer_trial(script, c, &frame, payload);
      continue;
    }
    memcpy(channel_payload(c, reply.length), text_words(&reply), reply.length);
    const Frame answer = {.version = FRAME_VERSION,
                          .operation = frame.operation | OPERATION_ANSWER,
                          .sequence = frame.sequence,
                          .length = (uint32_t)reply.length,
                          .session = 77};
    channel_send(c, &answer, PATIENCE, &words);
    text_free(&reply);
  }
  text_free(&words);
  channel_close(&c);
  return NULL;
}

static void begin(Script *script)
{
  script->at = (struct sockaddr_un){.sun_family = AF_UNIX};
  snprintf(script->at.sun_path, sizeof script->at.sun_path, "%s/script", folder);
  script->listener = socket(AF_UNIX, SOCK_STREAM, 0);
  assert_int_equal(bind(script->listener, (struct sockaddr *)&script->at, sizeof script->at), 0);
  assert_int_equal(listen(script->listener, 1), 0);
  assert_int_equal(pthread_create(&script->player, NULL, play, script), 0);
}

/** When its client has gone. */
static void end(Script *script)
{
  pthread_join(script->player, NULL);
  close(script->listener);
  unlink(script->at.sun_path);
}

/** Takes up a run at commit 5 with a server at another. @return the status; *asked tells how often the server was to commit */
static int take_up(int commits, int *asked, char *told, size_t size)
{
  Script script = {.commits = commits, .iterates = true};
  begin(&script);
  char *address = text_format("unix:%s", script.at.sun_path);
  const RemoteSpec remote_spec = {.material = "clay",
                                  .command = "nDMaterial Any $tag",
                                  .stage = -1,
                                  .servers = (const char *const[]){address},
                                  .server_count = 1,
                                  .timeout = PATIENCE,
                                  .stress_unit = 1,
                                  .units = {"m", "kN", "s"},
                                  .length = NAN};
  Error *error = breccia_error_create();
  Remote *remote = NULL;
  assert_int_equal(remote_open(&remote, &remote_spec, error), BRECCIA_OK);
  const int status = remote_resume(remote, (const int64_t[]){0, 3}, NULL, (const double[]){77, 5}, error);
  snprintf(told, size, "%s", breccia_error_text(error));
  remote_close(&remote);
  end(&script);
  breccia_error_destroy(&error);
  free(address);
  *asked = script.commits_asked;
  return status;
}

static void a_server_is_taken_up_where_the_checkpoint_is(void **state)
{
  (void)state;
  char told[400];
  int asked;
  assert_int_equal(take_up(5, &asked, told, sizeof told), BRECCIA_OK);
  assert_int_equal(asked, 0);
  /* The commit goes with the trial that follows, which never came: it is made up for. */
  assert_int_equal(take_up(4, &asked, told, sizeof told), BRECCIA_OK);
  assert_int_equal(asked, 1);
  static const int elsewhere[] = {6, 7, 3, 0};
  for (int k = 0; k < 4; ++k) {
    assert_int_equal(take_up(elsewhere[k], &asked, told, sizeof told), BRECCIA_USER_ERROR);
    assert_int_equal(asked, 0);
    char words[100];
    snprintf(words, sizeof words, " is at commit %d, the checkpoint at commit 5", elsewhere[k]);
    if (!strstr(told, words)) fail_msg("expected '%s', found '%s'", words, told);
  }
}

/** A law in a server that is asked for the last two of three points, after a trial that was committed. */
static void what_servers_answer_wrongly_is_told(void **state)
{
  (void)state;
  static const struct {
    const char *words;
    int bad;
  } told[WRONGS] = {
      [STRESS_OF_NONE] = {"it returned a stress that is not a number for its point 1", 1},
      [TANGENT_OF_NONE] = {"it returned a tangent that is not a number for its point 0", 0},
      [ONE_POINT_LESS] = {"it answered with 1 points in 672 bytes where 2 points in 672 bytes were due", 0},
      [ONE_NUMBER_LESS] = {"it answered with 2 points in 664 bytes where 2 points in 672 bytes were due", 0},
      [OTHER_OPERATION] = {"it answered 136 to frame 5 where 133 to frame 5 was due", 0},
      [OTHER_FRAME] = {"it answered 133 to frame 6 where 133 to frame 5 was due", 0},
      [OTHER_VERSION] = {"it speaks version 9 of the protocol, this program version 1", 0},
      [REFUSAL] = {"not today", 0},
      [REFUSAL_OF_A_POINT] = {"not today", 1},
      [REFUSAL_WITHOUT_WORDS] = {"it refused without a word", 0},
      [NO_FRAME] = {"what came is no frame of a material server (it begins with 48 54 54 50)", 0},
      [CLOSED_LINE] = {"it has closed the connection", 0},
      [LATENESS] = {"it does not answer within 0.2 s", 0},
  };
  for (Wrong wrong = NOTHING_WRONG; wrong < WRONGS; ++wrong) {
    Script script = {.iterates = true};
    begin(&script);
    char *address = text_format("unix:%s", script.at.sun_path);
    const RemoteSpec wishes = {.material = "clay",
                               .command = "nDMaterial Any $tag",
                               .stage = 1,
                               .servers = (const char *const[]){address},
                               .server_count = 1,
                               .timeout = wrong == LATENESS ? 0.2 : PATIENCE,
                               .stress_unit = 1000,
                               .units = {"m", "kN", "s"},
                               .length = 0.5};
    Remote *remote = NULL;
    assert_int_equal(remote_open(&remote, &wishes, NULL), BRECCIA_OK);
    const breccia_law *law = remote_law(remote);
    assert_string_equal(law->name, "Any of OpenSees");
    double bulk, shear;
    law->moduli(&remote, &bulk, &shear);
    assert_near(bulk, 2000, 0); /* the command counts in thousands of what the deck does */
    assert_near(shear, 1000, 0);
    assert_int_equal(law->history_values(&remote), 13);
    double rows[2][3][13], strain[6][2], stress[6][2], tangent[72];
    for (int i = 0; i < 3; ++i) {
      law->begin(&remote, rows[0][i]);
      assert_near(rows[0][i][0], -1, 0);
      rows[0][i][0] = i;
    }
    breccia_batch batch = {
        .size = sizeof batch, .count = 2, .committed = rows[0][1], .trial = rows[1][1], .tangent = tangent};
    for (int k = 0; k < 6; ++k) {
      for (int i = 0; i < 2; ++i) strain[k][i] = 1e-3 * (1 + k + 6 * i);
      batch.strain[k] = strain[k];
      batch.stress[k] = stress[k];
    }
    /* Before it has points nobody is asked: Hooke's law. */
    assert_int_equal(law->update(&remote, &batch), -1);
    const double lambda = bulk - 2 * shear / 3, volume = strain[0][1] + strain[1][1] + strain[2][1];
    assert_near(stress[1][1], 2 * shear * strain[1][1] + lambda * volume, 1e-9);
    assert_near(stress[4][1], shear * strain[4][1], 1e-9);
    assert_near(tangent[36 + 1], lambda, 1e-9);
    assert_near(tangent[36 + 7], lambda + 2 * shear, 1e-9);
    assert_near(tangent[36 + 21], shear, 1e-9);
    assert_int_equal(remote_begin(remote, (const int64_t[]){0, 3}, NULL), BRECCIA_OK);
    assert_int_equal(law->update(&remote, &batch), -1);
    assert_int_equal(script.flags, TRIAL_WANTS_TANGENT);
    assert_int_equal(script.first, 1);
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 6; ++k) {
        assert_near(script.strain[6 * i + k], strain[k][i], 0);
        assert_near(stress[k][i], 1000 * (10 * i + k), 0);
        assert_near(rows[1][1 + i][1 + k], strain[k][i], 0);
        assert_near(rows[1][1 + i][7 + k], stress[k][i], 0);
      }
      for (int k = 0; k < 36; ++k) assert_near(tangent[36 * i + k], 1000 * (100 * i + 10 * (k / 6) + k % 6), 0);
    }
    remote_commit(remote);
    batch.committed = rows[1][1];
    batch.trial = rows[0][1];
    /* In an elastic stage it goes on from the last answer. */
    batch.elastic_stage = 1;
    strain[4][1] += 1e-3;
    assert_int_equal(law->update(&remote, &batch), -1);
    assert_near(stress[4][1], 14000 + 1e-3 * shear, 1e-9);
    assert_near(stress[1][1], 11000, 1e-9);
    batch.elastic_stage = 0;
    script.wrong = wrong;
    const int bad = law->update(&remote, &batch);
    if (wrong == NOTHING_WRONG) {
      assert_int_equal(bad, -1);
      assert_int_equal(script.flags, TRIAL_WANTS_TANGENT | TRIAL_COMMITS_BEFORE);
      Text text = {0};
      remote_report(remote, 2, false, &text);
      const char *points = "material 'clay': server at unix:";
      assert_memory_equal(text_words(&text), points, strlen(points));
      if (!strstr(text_words(&text), ": 3 points, 2 points/s, ")) fail_msg("%s", text_words(&text));
      text_free(&text);
    } else {
      char *wanted = text_format("material 'clay': server at %s: %s", address, told[wrong].words);
      assert_string_equal(remote_problem(remote), wanted);
      assert_int_equal(bad, told[wrong].bad);
      assert_int_equal(law->update(&remote, &batch), 0); /* it is asked no more */
      free(wanted);
    }
    remote_close(&remote);
    end(&script);
    free(address);
  }
}

/** Byte by byte as docs/material-server.md tells; programs of others are written by that page. */
static void frames_are_laid_out_as_the_protocol_says(void **state)
{
  (void)state;
  uint8_t bytes[FRAME_HEADER + MOST_REFUSAL];
  memcpy(bytes + FRAME_HEADER, "abc", 3);
  const Frame frame = {1, 0x0305, 0x11121314, 0x21222324, 0x31323334, 3, 0x51525354, 0};
  frame_seal(&frame, bytes);
  static const uint8_t expected[28] = {'B',  'R',  'M',  'S',  1,    0,    5, 3, 0x14, 0x13, 0x12, 0x11, 0x24, 0x23,
                                       0x22, 0x21, 0x34, 0x33, 0x32, 0x31, 3, 0, 0,    0,    0x54, 0x53, 0x52, 0x51};
  assert_memory_equal(bytes, expected, sizeof expected);
  uint8_t joined[31];
  memcpy(joined, expected, 28);
  memcpy(joined + 28, "abc", 3);
  const uint32_t sum = checksum_of(joined, sizeof joined);
  for (int k = 0; k < 4; ++k) assert_int_equal(bytes[28 + k], sum >> 8 * k & 0xff);
  Frame found;
  Text reason = {0};
  assert_int_equal(frame_read(&found, bytes, &reason), 0);
  assert_int_equal(frame_check(&found, bytes, bytes + FRAME_HEADER, &reason), 0);
  assert_int_equal(found.version, 1);
  assert_int_equal(found.operation, 0x0305);
  assert_int_equal(found.sequence, 0x11121314);
  assert_int_equal(found.flags, 0x21222324);
  assert_int_equal(found.count, 0x31323334);
  assert_int_equal(found.length, 3);
  assert_int_equal(found.session, 0x51525354);
  static const int damaged[] = {9, 27, 30, 34};
  for (int k = 0; k < 4; ++k) {
    bytes[damaged[k]] ^= 4;
    frame_read(&found, bytes, &reason);
    text_free(&reason);
    assert_int_equal(frame_check(&found, bytes, bytes + FRAME_HEADER, &reason), 1);
    assert_string_equal(text_words(&reason), "a frame came damaged (its checksum does not hold)");
    text_free(&reason);
    bytes[damaged[k]] ^= 4;
  }
  bytes[23] = 0x10; /* 2^28 and three bytes */
  assert_int_equal(frame_read(&found, bytes, &reason), 1);
  assert_string_equal(text_words(&reason), "a frame of 268435459 bytes was announced; the most is 268435456");
  text_free(&reason);
  static const int numbers[] = {OPERATION_HELLO,   OPERATION_PROBE,      OPERATION_CREATE, OPERATION_ATTACH,
                                OPERATION_TRIAL,   OPERATION_COMMIT,     OPERATION_REVERT, OPERATION_SAVE,
                                OPERATION_RESTORE, OPERATION_STATISTICS, OPERATION_BYE,    OPERATION_LAWS};
  for (int k = 0; k < 12; ++k) assert_int_equal(numbers[k], k + 1);
  assert_int_equal(OPERATION_ERROR, 127);
  assert_int_equal(OPERATION_ANSWER, 128);
  /* Texts. */
  static const char text[] = "session:12\npoints: 3 \ncommits:   x\ncommand: a: b\nlast: 7";
  assert_near(frame_number(text, sizeof text - 1, "session", -1), 12, 0);
  assert_near(frame_number(text, sizeof text - 1, "points", -1), 3, 0);
  assert_near(frame_number(text, sizeof text - 1, "commits", -1), -1, 0);
  assert_near(frame_number(text, sizeof text - 1, "point", -1), -1, 0);
  assert_near(frame_number(text, sizeof text - 1, "last", -1), 7, 0);
  assert_near(frame_number(text, sizeof text - 3, "last", -1), -1, 0); /* cut behind the colon */
  char *line = frame_line(text, sizeof text - 1, "command");
  assert_string_equal(line, "a: b");
  free(line);
  assert_null(frame_line(text, sizeof text - 1, "a"));
  /* Refusals. */
  char words[MOST_REFUSAL + 10] = "";
  memset(words, 'q', MOST_REFUSAL + 5);
  assert_int_equal(frame_refuse(bytes, 9, words), FRAME_HEADER + MOST_REFUSAL);
  assert_int_equal(frame_refuse(bytes, 9, "no"), FRAME_HEADER + 2);
  assert_int_equal(frame_read(&found, bytes, &reason), 0);
  assert_int_equal(frame_check(&found, bytes, bytes + FRAME_HEADER, &reason), 0);
  assert_int_equal(found.operation, OPERATION_ERROR);
  assert_int_equal(found.sequence, 9);
  assert_int_equal(found.version, 1);
  assert_memory_equal(bytes + FRAME_HEADER, "no", 2);
}

/** Why a body of one brick is refused, with a server that can repeat trials or not; "" if it is not. */
static void solve_by(const char *solver, bool iterates, char *told, size_t size)
{
  Script script = {.iterates = iterates};
  begin(&script);
  char *deck =
      text_format("units: {length: m, force: kN, time: s}\n"
                  "materials: {clay: {opensees: nDMaterial Any $tag, server: ['unix:%s'], density: 2}}\n"
                  "body: {b: {material: clay, lattice: cubic, spacing: 1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                  "peridynamics: {formulation: correspondence}\n"
                  "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}]\n"
                  "solve: %s\n",
                  script.at.sun_path, solver);
  Error *error = breccia_error_create();
  breccia_model *model;
  const int status = breccia_model_load_string(deck, "deck", NULL, &model, error);
  snprintf(told, size, "%s", status ? breccia_error_text(error) : "");
  if (!status) breccia_model_destroy(&model);
  breccia_error_destroy(&error);
  end(&script);
  free(deck);
}

/** Equilibrium is found by trying: a server whose every trial counts would remember strains that never were. */
static void what_iterates_wants_trials_that_can_be_taken_back(void **state)
{
  static const char *const solvers[] = {"{static: {}}", "{static: {method: relaxation}}",
                                        "{implicit: {time step: 1 s, end time: 2 s}}",
                                        "[{explicit: {end time: 1 ms}}, {static: {}}]"};
  char told[600];
  (void)state;
  for (int k = 0; k < 4; ++k) {
    solve_by(solvers[k], true, told, sizeof told);
    assert_string_equal(told, "");
    solve_by(solvers[k], false, told, sizeof told);
    char words[400];
    snprintf(words, sizeof words,
             "%s: it tries strains several times, and the server of material 'clay' cannot take a trial back; take "
             "'explicit', a server that can (docs/material-server.md), or a law of this program",
             k == 2 ? "implicit" : "static");
    if (!strstr(told, words)) fail_msg("%s: found '%s'", solvers[k], told);
  }
  solve_by("{explicit: {end time: 1 ms}}", false, told, sizeof told);
  assert_string_equal(told, "");
}

/** Of a material in a server that is wrongly written one line is told, and nobody is asked for anything. */
static void what_no_server_can_be_asked_for_is_said(void **state)
{
  (void)state;
  static const char kinds[] =
      "opensees: expected 'nDMaterial KIND $tag ...' or 'uniaxialMaterial KIND $tag ...', plain words",
                    unit[] = "stress unit: '1 m' has the wrong dimension";
  static const struct {
    const char *keys, *words;
  } cases[] = {
      {"opensees: 'nDMaterial Any 1 2'", kinds},
      {"opensees: 'nDMaterial Any $tags 2'", kinds},
      {"opensees: 'nDMaterial $tag'", kinds},
      {"opensees: 'section Any $tag 2'", kinds},
      {"opensees: 'uniaxialMaterial Any $tag [exit]'", kinds},
      {"opensees: 'uniaxialMaterial Any $tag; exit'", kinds},
      {"opensees: 'nDMaterial Any $tag', server: ['unix:/no/such/socket'], stress unit: m", unit},
      {"remote: elastic", "remote: give the addresses of its servers under 'server'"},
      {"opensees: 'nDMaterial Any $tag', server: ['unix:/no/such/socket'], timeout: 1",
       "material 'clay': server at unix:/no/such/socket: it cannot be reached: No such file or directory"},
      {"opensees: 'uniaxialMaterial Any $tag', server: ['file:/no/such/socket'], timeout: 1",
       "it cannot be reached: an address is tcp://HOST:PORT, udp://HOST:PORT or unix:/PATH"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *deck = text_format("materials: {clay: {%s, density: 2}}\n"
                             "body: {b: {material: clay, spacing: 1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                             "solve: {explicit: {steps: 1}}\n",
                             cases[k].keys),
         *words = refusal_of(deck);
    if (!strstr(words, cases[k].words) || strncmp(words, "deck:1:", 7) || strchr(words, '\n'))
      fail_msg("%s: found '%s'", cases[k].keys, words);
    free(words);
    free(deck);
  }
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
      cmocka_unit_test(a_server_is_taken_up_where_the_checkpoint_is),
      cmocka_unit_test(what_iterates_wants_trials_that_can_be_taken_back),
      cmocka_unit_test(what_no_server_can_be_asked_for_is_said),
      cmocka_unit_test(what_servers_answer_wrongly_is_told),
      cmocka_unit_test(frames_are_laid_out_as_the_protocol_says),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
