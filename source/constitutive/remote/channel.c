#include "constitutive/remote/channel.h"

#include "base/clock.h"

#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

enum { MOST_DATAGRAM = 65507, CONNECT_EVERY_MS = 20 };
static const double KNOCK_SECONDS = 0.2;

typedef enum Transport { TRANSPORT_TCP, TRANSPORT_UNIX, TRANSPORT_UDP } Transport;

typedef struct Buffer {
  uint8_t *bytes; /* a header, a payload and a zero byte */
  size_t size;
} Buffer;

struct Channel {
  int socket;
  bool datagrams, borrowed; /* borrowed: the socket is the listener's, and `peer` is where frames go */
  struct sockaddr_storage peer;
  socklen_t peer_size;
  Buffer out, in;
  size_t out_size;
  double bytes[2];
};

struct Listener {
  int socket;
  Transport transport;
  char *address, *file;
  Channel *client;
  bool heard; /* something came from this client */
};

/* ---- addresses ---- */

static int parse(const char *address, Transport *transport, char *host, size_t host_size, char *port, size_t port_size,
                 Text *reason)
{
  static const char *const kinds[] = {"tcp://", "unix:", "udp://"};
  int kind = 0;
  while (kind < 3 && strncmp(address, kinds[kind], strlen(kinds[kind]))) ++kind;
  if (kind == 3) {
    text_add(reason, "an address is tcp://HOST:PORT, udp://HOST:PORT or unix:/PATH");
    return 1;
  }
  *transport = (Transport)kind;
  const char *rest = address + strlen(kinds[kind]);
  if (kind == TRANSPORT_UNIX) {
    const struct sockaddr_un *un = NULL;
    if (!*rest || strlen(rest) >= sizeof un->sun_path || strlen(rest) >= host_size) {
      text_add(reason, "the path of a socket must have 1 to %zu characters", sizeof un->sun_path - 1);
      return 1;
    }
    snprintf(host, host_size, "%s", rest);
    return 0;
  }
  const char *colon = strrchr(rest, ':');
  const char *first = rest, *last = colon;
  if (colon && *rest == '[' && colon > rest + 1 && colon[-1] == ']') { /* [::1]:port */
    ++first;
    --last;
  }
  if (!colon || first >= last || !colon[1] || (size_t)(last - first) >= host_size || strlen(colon + 1) >= port_size) {
    text_add(reason, "an address is %sHOST:PORT", kinds[kind]);
    return 1;
  }
  snprintf(host, host_size, "%.*s", (int)(last - first), first);
  snprintf(port, port_size, "%s", colon + 1);
  return 0;
}

/** The socket of an address, bound or connected. @return -1 with the reason, and errno */
static int make_socket(const char *address, bool listen_there, bool open, Transport *transport, Text *reason)
{
  char host[256], port[32] = "";
  if (parse(address, transport, host, sizeof host, port, sizeof port, reason)) {
    errno = EINVAL;
    return -1;
  }
  if (*transport == TRANSPORT_UNIX) {
    struct sockaddr_un un = {.sun_family = AF_UNIX};
    memcpy(un.sun_path, host, strlen(host)); /* parse() has seen that it fits, with a zero behind it */
    const int s = socket(AF_UNIX, SOCK_STREAM, 0);
    const mode_t mask = listen_there ? umask(0177) : 0;
    const int bad = s < 0 || (listen_there ? bind(s, (struct sockaddr *)&un, sizeof un)
                                           : connect(s, (struct sockaddr *)&un, sizeof un));
    const int code = errno;
    if (listen_there) umask(mask);
    if (!bad) return s;
    text_add(reason, "%s", strerror(code));
    if (s >= 0) close(s);
    errno = code;
    return -1;
  }
  struct addrinfo hints = {.ai_family = AF_UNSPEC,
                           .ai_socktype = *transport == TRANSPORT_TCP ? SOCK_STREAM : SOCK_DGRAM,
                           .ai_flags = listen_there ? AI_PASSIVE : 0},
                  *list = NULL;
  const int bad_name = getaddrinfo(host, port, &hints, &list);
  if (bad_name) {
    text_add(reason, "'%s': %s", host, gai_strerror(bad_name));
    errno = EINVAL;
    return -1;
  }
  int found = -1, code = 0;
  for (const struct addrinfo *a = list; a && found < 0; a = a->ai_next) {
    const bool loopback =
        a->ai_family == AF_INET
            ? (ntohl(((const struct sockaddr_in *)(const void *)a->ai_addr)->sin_addr.s_addr) >> 24) == 127
            : IN6_IS_ADDR_LOOPBACK(&((const struct sockaddr_in6 *)(const void *)a->ai_addr)->sin6_addr);
    if (listen_there && !open && !loopback) {
      code = EACCES;
      continue;
    }
    const int s = socket(a->ai_family, a->ai_socktype, a->ai_protocol), on = 1;
    if (s < 0) continue;
    if (*transport == TRANSPORT_TCP) {
      setsockopt(s, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      if (listen_there) setsockopt(s, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    }
    if (!(listen_there ? bind(s, a->ai_addr, a->ai_addrlen) : connect(s, a->ai_addr, a->ai_addrlen))) {
      found = s;
      break;
    }
    code = errno;
    close(s);
  }
  freeaddrinfo(list);
  if (found < 0)
    text_add(reason, "%s",
             code == EACCES && listen_there && !open
                 ? "a server listens on this machine only, unless a secret guards it (--secret-file)"
                 : strerror(code));
  errno = code;
  return found;
}

/* ---- channels ---- */

static Channel *channel_of(int s, bool datagrams)
{
  Channel *c = calloc(1, sizeof *c);
  if (!c) {
    close(s);
    return NULL;
  }
  c->socket = s;
  c->datagrams = datagrams;
  return c;
}

Channel *channel_connect(const char *address, double seconds, int (*stop)(void *context), void *context, Text *reason)
{
  const double end = clock_seconds() + seconds;
  for (;;) {
    Text words = {0};
    Transport transport;
    const int s = make_socket(address, false, true, &transport, &words);
    if (s >= 0) {
      text_free(&words);
      return channel_of(s, transport == TRANSPORT_UDP);
    }
    const int code = errno;
    const bool hopeless = code == EINVAL, over = clock_seconds() > end || (stop && stop(context));
    if (hopeless || over) {
      text_add(reason, "%s", words.characters ? words.characters : "no answer");
      text_free(&words);
      return NULL;
    }
    text_free(&words);
    nanosleep(&(struct timespec){.tv_nsec = CONNECT_EVERY_MS * 1000000L}, NULL);
  }
}

void channel_close(Channel **channel)
{
  Channel *c = *channel;
  if (!c) return;
  if (!c->borrowed) close(c->socket);
  free(c->out.bytes);
  free(c->in.bytes);
  free(c);
  *channel = NULL;
}

bool channel_may_lose(const Channel *channel)
{
  return channel->datagrams;
}

size_t channel_most_payload(const Channel *channel)
{
  return channel->datagrams ? MOST_DATAGRAM - FRAME_HEADER : FRAME_MOST_PAYLOAD;
}

void channel_bytes(const Channel *channel, double bytes[2])
{
  memcpy(bytes, channel->bytes, sizeof channel->bytes);
}

static int reserve(Buffer *b, size_t size)
{
  if (size <= b->size) return 0;
  uint8_t *bytes = realloc(b->bytes, size);
  if (!bytes) return 1;
  b->bytes = bytes;
  b->size = size;
  return 0;
}

uint8_t *channel_payload(Channel *channel, size_t length)
{
  return reserve(&channel->out, FRAME_HEADER + length + 1) ? NULL : channel->out.bytes + FRAME_HEADER;
}

/** Waits for the socket. @return CHANNEL_OK or CHANNEL_LATE */
static ChannelStatus await(int s, short events, double end, Text *reason)
{
  for (;;) {
    const double left = end - clock_seconds();
    struct pollfd p = {.fd = s, .events = events};
    const int n = poll(&p, 1, left > 0 ? (left < 1e6 ? (int)(1000 * left) + 1 : -1) : 0);
    if (n > 0) return CHANNEL_OK;
    if (n < 0 && errno == EINTR) continue;
    text_add(reason, "it does not answer");
    return CHANNEL_LATE;
  }
}

static ChannelStatus lost(Text *reason, int code)
{
  const bool closed = !code || code == ECONNRESET || code == EPIPE;
  text_add(reason, "%s", closed ? "it has closed the connection" : strerror(code));
  return CHANNEL_CLOSED;
}

static ChannelStatus send_all(Channel *c, double seconds, Text *reason)
{
  const double end = clock_seconds() + seconds;
  for (size_t done = 0; done < c->out_size;) {
    const ssize_t n = c->borrowed && c->datagrams
                          ? sendto(c->socket, c->out.bytes, c->out_size, MSG_NOSIGNAL | MSG_DONTWAIT,
                                   (struct sockaddr *)&c->peer, c->peer_size)
                          : send(c->socket, c->out.bytes + done, c->out_size - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n >= 0) {
      done += (size_t)n;
      c->bytes[0] += (double)n;
      continue;
    }
    if (errno == EINTR) continue;
    if (c->datagrams && errno == ECONNREFUSED) return lost(reason, errno);
    if (errno != EAGAIN && errno != EWOULDBLOCK) return lost(reason, errno);
    const ChannelStatus status = await(c->socket, POLLOUT, end, reason);
    if (status) return status;
  }
  return CHANNEL_OK;
}

ChannelStatus channel_send(Channel *c, const Frame *frame, double seconds, Text *reason)
{
  if (!channel_payload(c, frame->length)) {
    text_add(reason, "out of memory: frame");
    return CHANNEL_BROKEN;
  }
  if (frame->length > channel_most_payload(c)) {
    text_add(reason,
             "a frame of %lu bytes does not fit a datagram of %d; use tcp:// or unix:", (unsigned long)frame->length,
             MOST_DATAGRAM);
    return CHANNEL_BROKEN;
  }
  frame_seal(frame, c->out.bytes);
  c->out_size = FRAME_HEADER + frame->length;
  return send_all(c, seconds, reason);
}

ChannelStatus channel_repeat(Channel *c, double seconds, Text *reason)
{
  return send_all(c, seconds, reason);
}

static ChannelStatus receive_bytes(Channel *c, uint8_t *to, size_t size, double end, Text *reason)
{
  for (size_t done = 0; done < size;) {
    const ssize_t n = recv(c->socket, to + done, size - done, MSG_DONTWAIT);
    if (n > 0) {
      done += (size_t)n;
      c->bytes[1] += (double)n;
      continue;
    }
    if (n == 0) return lost(reason, 0);
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return lost(reason, errno);
    const ChannelStatus status = await(c->socket, POLLIN, end, reason);
    if (status) return status;
  }
  return CHANNEL_OK;
}

/** One datagram that is a whole frame; others are dropped, as if they had been lost. */
static ChannelStatus receive_datagram(Channel *c, Frame *frame, uint8_t **payload, double end, Text *reason)
{
  for (;;) {
    struct sockaddr_storage from;
    socklen_t size = sizeof from;
    const ssize_t n = recvfrom(c->socket, c->in.bytes, MOST_DATAGRAM, MSG_DONTWAIT, (struct sockaddr *)&from, &size);
    if (n < 0) {
      if (errno == EINTR) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK) return lost(reason, errno);
      const ChannelStatus status = await(c->socket, POLLIN, end, reason);
      if (status) return status;
      continue;
    }
    c->bytes[1] += (double)n;
    Text words = {0};
    const bool whole = n >= FRAME_HEADER && !frame_read(frame, c->in.bytes, &words) &&
                       (size_t)n == FRAME_HEADER + frame->length &&
                       !frame_check(frame, c->in.bytes, c->in.bytes + FRAME_HEADER, &words);
    text_free(&words);
    if (!whole) continue;
    if (c->borrowed) {
      c->peer = from;
      c->peer_size = size;
    }
    *payload = c->in.bytes + FRAME_HEADER;
    (*payload)[frame->length] = 0;
    return CHANNEL_OK;
  }
}

ChannelStatus channel_receive(Channel *c, Frame *frame, uint8_t **payload, double seconds, Text *reason)
{
  const double end = clock_seconds() + seconds;
  if (reserve(&c->in, c->datagrams ? MOST_DATAGRAM + 1 : FRAME_HEADER + 4096)) {
    text_add(reason, "out of memory: frame");
    return CHANNEL_BROKEN;
  }
  if (c->datagrams) return receive_datagram(c, frame, payload, end, reason);
  ChannelStatus status = receive_bytes(c, c->in.bytes, FRAME_HEADER, end, reason);
  if (status) return status;
  if (frame_read(frame, c->in.bytes, reason)) return CHANNEL_BROKEN;
  if (reserve(&c->in, FRAME_HEADER + (size_t)frame->length + 1)) {
    text_add(reason, "out of memory: a frame of %lu bytes", (unsigned long)frame->length);
    return CHANNEL_BROKEN;
  }
  *payload = c->in.bytes + FRAME_HEADER;
  status = receive_bytes(c, *payload, frame->length, end, reason);
  if (status) return status;
  (*payload)[frame->length] = 0;
  return frame_check(frame, c->in.bytes, *payload, reason) ? CHANNEL_BROKEN : CHANNEL_OK;
}

/* ---- listeners ---- */

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
  const int s = make_socket(address, true, open, &transport, reason);
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
  if (transport == TRANSPORT_UDP && (l->client = channel_of(s, true))) l->client->borrowed = true;
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
  const int s = accept(l->socket, NULL, NULL), on = 1;
  if (s < 0) return;
  if (l->transport == TRANSPORT_TCP) setsockopt(s, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  Channel *c = channel_of(s, false);
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
                          {.fd = l->client ? l->client->socket : -1, .events = POLLIN}};
    const double left = end - clock_seconds();
    const int n = poll(p, l->client ? 2 : 1, left > 0 ? (int)(1000 * left) + 1 : 0);
    if (n < 0 && errno != EINTR) return lost(reason, errno);
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
