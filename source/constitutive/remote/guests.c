#include "constitutive/remote/guests.h"

#include "base/clock.h"

#include <errno.h>
#include <sys/socket.h>
#include <unistd.h>

/* A client greets as soon as it is connected. */
static const double GREETING_SECONDS = 5;

static void let_go(Guest *g)
{
  if (g->socket >= 0) close(g->socket);
  g->socket = -1;
}

void guests_clear(Guest guests[GUESTS])
{
  for (int k = 0; k < GUESTS; ++k) guests[k].socket = -1;
}

void guest_enter(Guest guests[GUESTS], int socket)
{
  Guest *place = guests;
  for (Guest *g = guests; g < guests + GUESTS && place->socket >= 0; ++g)
    if (g->socket < 0 || g->end < place->end) place = g;
  let_go(place);
  place->socket = socket;
  place->got = 0;
  place->end = clock_seconds() + GREETING_SECONDS;
  place->dismissed = false;
}

int guests_await(const Guest guests[GUESTS], struct pollfd polls[GUESTS], int most)
{
  const double now = clock_seconds();
  for (int k = 0; k < GUESTS; ++k) {
    polls[k] = (struct pollfd){.fd = guests[k].socket, .events = POLLIN};
    if (guests[k].socket < 0) continue;
    const double left = guests[k].end - now;
    if (1000 * left < most) most = left > 0 ? (int)(1000 * left) + 1 : 0;
  }
  return most;
}

/** Reads up to `wanted` bytes in all. @return whether they are there */
static bool collect(Guest *g, size_t wanted)
{
  while (g->got < wanted) {
    const ssize_t n = recv(g->socket, g->bytes + g->got, wanted - g->got, MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK)) let_go(g);
    if (n <= 0) return false;
    g->got += (size_t)n;
  }
  return true;
}

GuestStatus guest_hear(Guest *g, Frame *frame, uint8_t **payload, Text *reason)
{
  if (g->dismissed) {
    g->got = 0;
    collect(g, sizeof g->bytes);
    return GUEST_SILENT;
  }
  if (!collect(g, FRAME_HEADER)) return GUEST_SILENT;
  if (frame_read(frame, g->bytes, reason)) return GUEST_ODD;
  if (frame->length > MOST_GREETING) {
    text_add(reason, "a first frame of %lu bytes was announced; a greeting has at most %d",
             (unsigned long)frame->length, MOST_GREETING);
    return GUEST_ODD;
  }
  if (!collect(g, FRAME_HEADER + frame->length)) return GUEST_SILENT;
  *payload = g->bytes + FRAME_HEADER;
  (*payload)[frame->length] = 0;
  return frame_check(frame, g->bytes, *payload, reason) ? GUEST_ODD : GUEST_SPEAKS;
}

void guest_dismiss(Guest *g, uint32_t sequence, const char *words)
{
  uint8_t bytes[FRAME_HEADER + MOST_REFUSAL];
  const size_t size = frame_refuse(bytes, sequence, words);
  const bool told = send(g->socket, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT) == (ssize_t)size;
  if (told && !shutdown(g->socket, SHUT_WR))
    g->dismissed = true;
  else
    let_go(g);
}

int guest_promote(Guest *g)
{
  const int socket = g->socket;
  g->socket = -1;
  return socket;
}

void guests_expire(Guest guests[GUESTS])
{
  const double now = clock_seconds();
  for (int k = 0; k < GUESTS; ++k)
    if (guests[k].socket >= 0 && guests[k].end <= now) let_go(&guests[k]);
}

void guests_close(Guest guests[GUESTS])
{
  for (int k = 0; k < GUESTS; ++k) let_go(&guests[k]);
}
