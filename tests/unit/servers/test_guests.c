/* Connections that have not greeted yet: who makes room for whom. */
#include "support.h"

#include "constitutive/remote/guests.h"

#include <errno.h>
#include <sys/socket.h>
#include <unistd.h>

static void who_has_waited_longest_makes_room(void **state)
{
  (void)state;
  enum { GONE = 3 };
  Guest guests[GUESTS];
  int line[GUESTS + GONE][2];
  char byte;
  guests_clear(guests);
  for (int k = 0; k < GUESTS + GONE; ++k) {
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, line[k]), 0);
    guest_enter(guests, line[k][0]);
  }
  for (int k = 0; k < GUESTS + GONE; ++k) { /* of the line to one that has gone nothing comes any more */
    const ssize_t heard = recv(line[k][1], &byte, 1, MSG_DONTWAIT);
    if (k < GONE)
      assert_int_equal(heard, 0);
    else
      assert_true(heard == -1 && errno == EAGAIN);
  }
  guests_close(guests);
  for (int k = 0; k < GUESTS + GONE; ++k) {
    assert_int_equal(recv(line[k][1], &byte, 1, MSG_DONTWAIT), 0);
    close(line[k][1]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(who_has_waited_longest_makes_room),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
