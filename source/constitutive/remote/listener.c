#include "constitutive/remote/listener.h"

#include "base/clock.h"
#include "base/memory.h"
#include "constitutive/remote/address.h"
#include "constitutive/remote/guests.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

static const double FRAME_SECONDS = 60, SILENT_SECONDS = 60; /* the second where the specification names none */
static const char busy[] = "the server is busy with another client";

struct Listener {
  ListenerSpec spec;
  int socket;
  Transport transport;
  char *address, *file;
  dev_t device; /* of the socket file, by which it is known again */
  ino_t inode;
  Channel *client; /* of datagrams the channel is always there, and `tied` tells whether a client is */
  bool tied;
  double heard; /* on the clock, the last frame of a client of datagrams */
  Guest guests[GUESTS];
  uint8_t greeting[MOST_GREETING + 1];
};

/** A socket file that a server left behind when it was killed: nobody answers there. */
static void remove_stale(const char *path)
{
  struct stat status;
  struct sockaddr_un un = {.sun_family = AF_UNIX};
  if (strlen(path) >= sizeof un.sun_path || lstat(path, &status) || !S_ISSOCK(status.st_mode)) return;
  snprintf(un.sun_path, sizeof un.sun_path, "%s", path);
  const int s = socket(AF_UNIX, SOCK_STREAM, 0);
  if (s >= 0 && connect(s, (struct sockaddr *)&un, sizeof un) && errno == ECONNREFUSED) unlink(path);
  if (s >= 0) close(s);
}

/** Removes the socket file, unless another one has taken its place. */
static void remove_file(const Listener *l)
{
  struct stat status;
  if (l->file && !lstat(l->file, &status) && status.st_dev == l->device && status.st_ino == l->inode) unlink(l->file);
}

/** Begins to listen at a bound socket and finds out where that is. @return 0, or 1 with the reason */
static int settle(Listener *l, Text *reason)
{
  struct sockaddr_storage own = {0};
  socklen_t size = sizeof own;
  char host[256], port[32];
  if (l->transport == TRANSPORT_UNIX) {
    struct stat status = {0};
    l->file = text_format("%s", l->spec.address + strlen("unix:"));
    if (l->file && !lstat(l->file, &status)) {
      l->device = status.st_dev;
      l->inode = status.st_ino;
    }
    l->address = text_format("%s", l->spec.address);
  }
  if ((l->transport != TRANSPORT_UDP && (listen(l->socket, GUESTS) || fcntl(l->socket, F_SETFL, O_NONBLOCK))) ||
      getsockname(l->socket, (struct sockaddr *)&own, &size) ||
      (l->transport != TRANSPORT_UNIX && getnameinfo((struct sockaddr *)&own, size, host, sizeof host, port,
                                                     sizeof port, NI_NUMERICHOST | NI_NUMERICSERV))) {
    text_add(reason, "%s", strerror(errno));
    return 1;
  }
  if (l->transport != TRANSPORT_UNIX) {
    l->address = text_format(own.ss_family == AF_INET6 ? "%s://[%s]:%s" : "%s://%s:%s",
                             l->transport == TRANSPORT_TCP ? "tcp" : "udp", host, port);
  }
  if (l->transport == TRANSPORT_UDP && (l->client = channel_over(l->socket, true, true)))
    channel_interruptible(l->client, l->spec.interrupted);
  if (l->address && (l->transport != TRANSPORT_UNIX || l->file) && (l->transport != TRANSPORT_UDP || l->client))
    return 0;
  text_add(reason, "out of memory");
  return 1;
}

Listener *listener_open(const ListenerSpec *spec, Text *reason)
{
  Transport transport;
  if (!strncmp(spec->address, "unix:", 5)) remove_stale(spec->address + 5);
  const int s = address_open(spec->address, true, spec->open, &transport, reason);
  if (s < 0) return NULL;
  Listener *l = memory_plain(1, sizeof *l);
  if (!l) {
    text_add(reason, "out of memory");
    close(s);
    if (transport == TRANSPORT_UNIX) unlink(spec->address + 5);
    return NULL;
  }
  l->spec = *spec;
  l->socket = s;
  l->transport = transport;
  guests_clear(l->guests);
  if (settle(l, reason)) listener_close(&l);
  return l;
}

const char *listener_address(const Listener *listener)
{
  return listener->address ? listener->address : "";
}

Channel *listener_channel(Listener *listener)
{
  return listener->client;
}

void listener_drop(Listener *l)
{
  if (l->transport != TRANSPORT_UDP) channel_close(&l->client);
  l->tied = false;
}

void listener_close(Listener **listener)
{
  Listener *l = *listener;
  if (!l) return;
  channel_close(&l->client);
  guests_close(l->guests);
  close(l->socket);
  remove_file(l);
  free(l->file);
  free(l->address);
  free(l);
  *listener = NULL;
}

/** Why a first frame is not served, in words; none if it is the greeting of the next client. */
static void examine(const Listener *l, const Frame *frame, const uint8_t *payload, bool occupied, Text *words)
{
  if (!l->spec.greets(l->spec.context, frame, payload, words) && occupied) text_add(words, "%s", busy);
}

/** Listens to a guest. @return whether it has become the client, with its greeting */
static bool listen_to(Listener *l, Guest *guest, Frame *frame, uint8_t **payload)
{
  uint8_t *greeting = NULL;
  Text words = {0};
  const GuestStatus status = guest_hear(guest, frame, &greeting, &words);
  if (status == GUEST_SPEAKS) examine(l, frame, greeting, l->client != NULL, &words);
  if (status != GUEST_SILENT && words.length)
    guest_dismiss(guest, status == GUEST_SPEAKS ? frame->sequence : 0, words.characters);
  const bool welcome = status == GUEST_SPEAKS && !words.length;
  text_free(&words);
  if (!welcome) return false;
  memcpy(l->greeting, greeting, (size_t)frame->length + 1);
  *payload = l->greeting;
  l->client = channel_over(guest_promote(guest), false, false);
  if (l->client) channel_interruptible(l->client, l->spec.interrupted);
  return l->client != NULL;
}

/** Waits for a frame of the client, a greeting or someone who knocks.
 *  @return CHANNEL_OK when a greeting or something of the client (then *greeted is false) has come */
static ChannelStatus attend(Listener *l, Frame *frame, uint8_t **payload, bool *greeted, double seconds, Text *reason)
{
  const double end = clock_seconds() + seconds;
  for (double left = seconds; left > 0; left = end - clock_seconds()) {
    struct pollfd p[GUESTS + 2];
    const int most = guests_await(l->guests, p, (int)(1000 * left) + 1);
    p[GUESTS] = (struct pollfd){.fd = l->client ? channel_socket(l->client) : -1, .events = POLLIN};
    p[GUESTS + 1] = (struct pollfd){.fd = l->socket, .events = POLLIN};
    const int n = poll(p, GUESTS + 2, most);
    if (n < 0 && errno == EINTR) break; /* the server looks whether it must end */
    if (n < 0) {
      text_add(reason, "%s", strerror(errno));
      return CHANNEL_CLOSED;
    }
    /* First the client: if it has just left, whoever knocks is the next one. */
    if (p[GUESTS].revents) return CHANNEL_OK;
    for (int k = 0; k < GUESTS; ++k)
      if (p[k].revents && listen_to(l, &l->guests[k], frame, payload)) {
        *greeted = true;
        return CHANNEL_OK;
      }
    guests_expire(l->guests);
    const int s = p[GUESTS + 1].revents ? accept(l->socket, NULL, NULL) : -1;
    if (s < 0) continue;
    address_tune(s, l->transport);
    guest_enter(l->guests, s);
  }
  return CHANNEL_LATE;
}

/** Frames of the client of datagrams, and greetings; others are refused. */
static ChannelStatus receive_datagrams(Listener *l, Frame *frame, uint8_t **payload, bool *fresh, double seconds,
                                       Text *reason)
{
  const double end = clock_seconds() + seconds, silence = l->spec.silence > 0 ? l->spec.silence : SILENT_SECONDS;
  for (double left = seconds; left > 0; left = end - clock_seconds()) {
    const ChannelStatus status = channel_receive(l->client, frame, payload, left, reason);
    if (status) return status;
    const double now = clock_seconds();
    Text words = {0};
    *fresh = !l->tied || !channel_from_peer(l->client);
    if (*fresh) examine(l, frame, *payload, l->tied && now - l->heard < silence, &words);
    if (words.length)
      channel_refuse_sender(l->client, frame->sequence, words.characters);
    else if (*fresh)
      channel_turn_to_sender(l->client);
    const bool served = !words.length;
    text_free(&words);
    if (!served) continue;
    l->tied = true;
    l->heard = now;
    return CHANNEL_OK;
  }
  return CHANNEL_LATE;
}

ChannelStatus listener_receive(Listener *l, Frame *frame, uint8_t **payload, bool *fresh, double seconds, Text *reason)
{
  *fresh = false;
  if (l->transport == TRANSPORT_UDP) return receive_datagrams(l, frame, payload, fresh, seconds, reason);
  ChannelStatus status = attend(l, frame, payload, fresh, seconds, reason);
  if (status || *fresh) return status;
  status = channel_receive(l->client, frame, payload, FRAME_SECONDS, reason);
  if (status != CHANNEL_LATE) return status;
  text_free(reason);
  text_add(reason, "a frame did not come whole within %g s", FRAME_SECONDS);
  return CHANNEL_BROKEN;
}
