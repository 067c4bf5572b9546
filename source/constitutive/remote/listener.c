#include "constitutive/remote/listener.h"

#include "base/clock.h"
#include "constitutive/remote/address.h"

#include <errno.h>
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

static const double KNOCK_SECONDS = 0.2;

struct Listener {
  int socket;
  Transport transport;
  char *address, *file;
  Channel *client;
  bool heard; /* something came from this client */
};

/** A socket file that a server left behind when it was killed: nobody answers there. */
static void remove_stale(const char *path)
{
  struct stat status;
  if (lstat(path, &status) || !S_ISSOCK(status.st_mode)) return;
  struct sockaddr_un un = {.sun_family = AF_UNIX};
  snprintf(un.sun_path, sizeof un.sun_path, "%s", path);
  const int s = socket(AF_UNIX, SOCK_STREAM, 0);
  if (s >= 0 && connect(s, (struct sockaddr *)&un, sizeof un) && errno == ECONNREFUSED) unlink(path);
  if (s >= 0) close(s);
}

Listener *listener_open(const char *address, bool open, Text *reason)
{
  Transport transport;
  if (!strncmp(address, "unix:", 5)) remove_stale(address + 5);
  const int s = address_open(address, true, open, &transport, reason);
  if (s < 0) return NULL;
  Listener *l = calloc(1, sizeof *l);
  struct sockaddr_storage own;
  socklen_t size = sizeof own;
  char host[256], port[32];
  if (!l || (transport != TRANSPORT_UDP && listen(s, 8)) || getsockname(s, (struct sockaddr *)&own, &size)) {
    text_add(reason, "%s", l ? strerror(errno) : "out of memory");
    close(s);
    free(l);
    return NULL;
  }
  l->socket = s;
  l->transport = transport;
  if (transport == TRANSPORT_UNIX) {
    l->file = text_format("%s", address + 5);
    l->address = text_format("%s", address);
  } else {
    getnameinfo((struct sockaddr *)&own, size, host, sizeof host, port, sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
    l->address = text_format(own.ss_family == AF_INET6 ? "%s://[%s]:%s" : "%s://%s:%s",
                             transport == TRANSPORT_TCP ? "tcp" : "udp", host, port);
  }
  if (transport == TRANSPORT_UDP) l->client = channel_over(s, true, true);
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
  l->heard = false;
}

void listener_close(Listener **listener)
{
  Listener *l = *listener;
  if (!l) return;
  channel_close(&l->client);
  close(l->socket);
  if (l->file) unlink(l->file);
  free(l->file);
  free(l->address);
  free(l);
  *listener = NULL;
}

/** Takes a client that knocks, or tells it that another one is being served. */
static void answer_knock(Listener *l)
{
  const int s = accept(l->socket, NULL, NULL);
  if (s < 0) return;
  address_tune(s, l->transport);
  Channel *c = channel_over(s, false, false);
  if (!c) return;
  if (!l->client) {
    l->client = c;
    l->heard = false;
    return;
  }
  /* Its first frame is read before it is answered: closing with unread bytes would take the answer away again. */
  static const char busy[] = "the server is busy with another client";
  Frame frame;
  uint8_t *asked, *payload = channel_payload(c, sizeof busy);
  Text words = {0};
  if (payload && channel_receive(c, &frame, &asked, KNOCK_SECONDS, &words) == CHANNEL_OK) {
    memcpy(payload, busy, sizeof busy - 1);
    channel_send(c,
                 &(Frame){.version = FRAME_VERSION,
                          .operation = OPERATION_ERROR,
                          .sequence = frame.sequence,
                          .length = sizeof busy - 1},
                 KNOCK_SECONDS, &words);
  }
  text_free(&words);
  channel_close(&c);
}

ChannelStatus listener_receive(Listener *l, Frame *frame, uint8_t **payload, bool *fresh, double seconds, Text *reason)
{
  const double end = clock_seconds() + seconds;
  while (l->transport != TRANSPORT_UDP) {
    struct pollfd p[2] = {{.fd = l->socket, .events = POLLIN},
                          {.fd = l->client ? channel_socket(l->client) : -1, .events = POLLIN}};
    const double left = end - clock_seconds();
    const int n = poll(p, l->client ? 2 : 1, left > 0 ? (int)(1000 * left) + 1 : 0);
    if (n < 0 && errno != EINTR) {
      text_add(reason, "%s", strerror(errno));
      return CHANNEL_CLOSED;
    }
    if (n == 0) return CHANNEL_LATE;
    /* First the client: if it has just left, whoever knocks is the next one. */
    if (n > 0 && l->client && p[1].revents) break;
    if (n > 0 && p[0].revents) answer_knock(l);
  }
  if (!l->client) return CHANNEL_BROKEN;
  const ChannelStatus status =
      channel_receive(l->client, frame, payload, l->transport == TRANSPORT_UDP ? seconds : 60, reason);
  *fresh = !l->heard;
  l->heard |= status == CHANNEL_OK;
  return status;
}
