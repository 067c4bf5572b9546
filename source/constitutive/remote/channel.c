#include "constitutive/remote/channel.h"

#include "base/clock.h"
#include "base/memory.h"
#include "constitutive/remote/address.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { MOST_DATAGRAM = 65507, CONNECT_EVERY_MS = 20, LOOK_UP_EVERY_MS = 200 };

typedef struct Buffer {
  uint8_t *bytes; /* a header, a payload and a zero byte */
  size_t size;
} Buffer;

struct Channel {
  int socket;
  bool datagrams, borrowed;             /* borrowed: the socket is the listener's, and `peer` is where frames go */
  struct sockaddr_storage peer, sender; /* sender: of the last frame */
  socklen_t peer_size, sender_size;
  const volatile int *interrupted; /* may be NULL */
  Buffer out, in;
  size_t out_size;
  double bytes[2];
};

Channel *channel_over(int s, bool datagrams, bool borrowed)
{
  Channel *c = memory_plain(1, sizeof *c);
  if (!c) {
    if (!borrowed) close(s);
    return NULL;
  }
  c->socket = s;
  c->datagrams = datagrams;
  c->borrowed = borrowed;
  return c;
}

int channel_socket(const Channel *channel)
{
  return channel->socket;
}

void channel_interruptible(Channel *channel, const volatile int *interrupted)
{
  channel->interrupted = interrupted;
}

bool channel_from_peer(const Channel *c)
{
  return c->peer_size == c->sender_size && !memcmp(&c->peer, &c->sender, c->peer_size);
}

void channel_turn_to_sender(Channel *c)
{
  c->peer = c->sender;
  c->peer_size = c->sender_size;
}

void channel_refuse_sender(Channel *c, uint32_t sequence, const char *words)
{
  uint8_t bytes[FRAME_HEADER + MOST_REFUSAL];
  const size_t size = frame_refuse(bytes, sequence, words);
  sendto(c->socket, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT, (struct sockaddr *)&c->sender, c->sender_size);
}

Channel *channel_connect(const char *address, double seconds, int (*stop)(void *context), void *context, Text *reason)
{
  const double end = clock_seconds() + seconds;
  for (;;) {
    Text words = {0};
    Transport transport;
    const int s = address_open(address, false, true, &transport, &words);
    if (s >= 0) {
      text_free(&words);
      return channel_over(s, transport == TRANSPORT_UDP, false);
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
  uint8_t *bytes = memory_grown(b->bytes, size, 1);
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
static ChannelStatus await(const Channel *c, short events, double end, Text *reason)
{
  for (;;) {
    const double left = end - clock_seconds();
    const bool look_up = c->interrupted && 1000 * left > LOOK_UP_EVERY_MS;
    struct pollfd p = {.fd = c->socket, .events = events};
    const int n = poll(&p, 1, look_up ? LOOK_UP_EVERY_MS : left > 0 ? (left < 1e6 ? (int)(1000 * left) + 1 : -1) : 0);
    if (n > 0) return CHANNEL_OK;
    if (c->interrupted && __atomic_load_n(c->interrupted, __ATOMIC_RELAXED)) return CHANNEL_LATE;
    if (look_up || (n < 0 && errno == EINTR)) continue;
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
    const ChannelStatus status = await(c, POLLOUT, end, reason);
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
    const ChannelStatus status = await(c, POLLIN, end, reason);
    if (status) return status;
  }
  return CHANNEL_OK;
}

/** One datagram that is a whole frame; others are dropped, as if they had been lost. */
static ChannelStatus receive_datagram(Channel *c, Frame *frame, uint8_t **payload, double end, Text *reason)
{
  for (;;) {
    struct sockaddr_storage from = {0};
    socklen_t size = sizeof from;
    const ssize_t n = recvfrom(c->socket, c->in.bytes, MOST_DATAGRAM, MSG_DONTWAIT, (struct sockaddr *)&from, &size);
    if (n < 0) {
      if (errno == EINTR) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK) return lost(reason, errno);
      const ChannelStatus status = await(c, POLLIN, end, reason);
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
    c->sender = from;
    c->sender_size = size;
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
