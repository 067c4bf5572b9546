/* What a server says of itself: where it is, and what it cannot do. */
#include "support.h"

#include "constitutive/remote/channel.h"
#include "constitutive/remote/remote.h"

#include <pthread.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { PATIENCE = 30 }; /* seconds, for what comes at once */

static char folder[] = "/tmp/breccia-server-XXXXXX";

/** A server that saves nothing, at some commit of session 77 with three points. */
typedef struct Script {
  int listener, commits, commits_asked;
  bool iterates;
  struct sockaddr_un at;
  pthread_t player;
} Script;

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
    if (!strstr(told, "the server of material 'clay' cannot take a trial back"))
      fail_msg("%s: found '%s'", solvers[k], told);
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
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
