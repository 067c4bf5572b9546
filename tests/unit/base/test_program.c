/* Programs that are run on a script: how they end, and that the host's signals stay as they are. */
#include "base/program.h"
#include "support.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>

/** More than any pipe holds. */
static char *long_script(size_t length)
{
  char *script = malloc(length + 1);
  assert_non_null(script);
  memset(script, '\n', length);
  script[length] = 0;
  return script;
}

static void a_script_is_read_to_its_end(void **state)
{
  (void)state;
  static const char *const words[] = {"sh", "-c", "[ $(wc -c) = 300000 ]", NULL};
  char *script = long_script(300000);
  Text reason = {0};
  assert_int_equal(program_run(words, script, 300000, &reason), PROGRAM_DONE);
  assert_int_equal(reason.length, 0);
  free(script);
}

static void a_program_that_reads_nothing_does_not_end_its_host(void **state)
{
  (void)state;
  static const char *const words[] = {"sh", "-c", "echo 'first line' >&2; echo '  last line' >&2; exit 3", NULL};
  struct sigaction action = {.sa_handler = SIG_DFL}, after;
  assert_int_equal(sigaction(SIGPIPE, &action, NULL), 0);
  char *script = long_script(300000);
  Text reason = {0};
  assert_int_equal(program_run(words, script, 300000, &reason), PROGRAM_FAILED);
  assert_string_equal(reason.characters, "sh ended with status 3: last line");
  assert_int_equal(sigaction(SIGPIPE, NULL, &after), 0);
  assert_true(after.sa_handler == SIG_DFL);
  text_free(&reason);
  free(script);
}

static void a_program_that_is_not_there_is_told_from_one_that_fails(void **state)
{
  (void)state;
  static const char *const none[] = {"no-such-program-anywhere", NULL}, *const killed[] = {"sh", "-c", "kill -9 $$",
                                                                                           NULL};
  Text reason = {0};
  assert_int_equal(program_run(none, "", 0, &reason), PROGRAM_MISSING);
  text_free(&reason);
  assert_int_equal(program_run(killed, "", 0, &reason), PROGRAM_FAILED);
  assert_string_equal(reason.characters, "sh was ended by signal 9");
  text_free(&reason);
}

/** A program started by a host that ignores SIGPIPE, as this command does, still ends quietly when its own reader goes. */
static void a_program_has_the_usual_signals(void **state)
{
  (void)state;
  static const char *const words[] = {"sh", "-c", "kill -13 $$; exit 0", NULL};
  struct sigaction action = {.sa_handler = SIG_IGN}, before;
  assert_int_equal(sigaction(SIGPIPE, &action, &before), 0);
  Text reason = {0};
  assert_int_equal(program_run(words, "", 0, &reason), PROGRAM_FAILED);
  assert_string_equal(reason.characters, "sh was ended by signal 13");
  assert_int_equal(sigaction(SIGPIPE, &before, NULL), 0);
  text_free(&reason);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_script_is_read_to_its_end),
      cmocka_unit_test(a_program_that_reads_nothing_does_not_end_its_host),
      cmocka_unit_test(a_program_that_is_not_there_is_told_from_one_that_fails),
      cmocka_unit_test(a_program_has_the_usual_signals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
