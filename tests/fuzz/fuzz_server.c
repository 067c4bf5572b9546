/* Random frames to a material server, random bytes to one before the greeting, and to a client, for libFuzzer. The
 * server must answer a HELLO after anything. */
#include "constitutive/remote/channel.h"
#include "constitutive/remote/server.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

static char address[64], other[64];
static volatile int ready;
static long conversations, frames, lines;

static void is_ready(const char *where)
{
  (void)where;
  ready = 1;
}

static void *serve(void *context)
{
  (void)context;
  const ServeSpec spec = {.address = address, .listening = is_ready};
  serve_materials(&spec, NULL);
  return NULL;
}

static void remove_sockets(void)
{
  unlink(address + 5);
  unlink(other + 5);
}

static void tell_counts(void)
{
  remove_sockets();
  fprintf(stderr, "server: %ld frames in %ld conversations, %ld lines of bytes\n", frames, conversations, lines);
}

static Channel *connect_to(const char *where)
{
  Text words = {0};
  Channel *channel = channel_connect(where, 5, NULL, NULL, &words);
  text_free(&words);
  if (!channel) abort();
  return channel;
}

/** @return the operation of the answer, 0 if the line is closed */
static int ask(Channel *channel, Frame frame, const uint8_t *payload, uint32_t *session)
{
  Text words = {0};
  Frame reply = {0};
  uint8_t *bytes, *to = channel_payload(channel, frame.length);
  if (!to) abort();
  if (frame.length) memcpy(to, payload, frame.length);
  ++frames;
  if (channel_send(channel, &frame, 5, &words) == CHANNEL_OK) {
    const ChannelStatus status = channel_receive(channel, &reply, &bytes, 5, &words);
    if (status == CHANNEL_LATE || status == CHANNEL_BROKEN) abort(); /* a server always answers, in frames */
    if (status) reply.operation = 0;
  }
  if (session && reply.session) *session = reply.session;
  text_free(&words);
  return reply.operation;
}

/** Bytes to the receiving side of a client. */
static void tell_client(int listener, const uint8_t *data, size_t size)
{
  Channel *channel = connect_to(other);
  const int line = accept(listener, NULL, NULL);
  Frame frame;
  uint8_t *payload;
  Text words = {0};
  if (send(line, data, size, MSG_NOSIGNAL) < 0) abort();
  close(line);
  while (channel_receive(channel, &frame, &payload, 1, &words) == CHANNEL_OK) {
    free(frame_line((const char *)payload, frame.length, "bulk"));
    frame_number((const char *)payload, frame.length, "components", 0);
  }
  text_free(&words);
  channel_close(&channel);
}

/** Bytes instead of a greeting. */
static void tell_server(const uint8_t *data, size_t size)
{
  Channel *channel = connect_to(address);
  if (send(channel_socket(channel), data, size, MSG_NOSIGNAL) < 0) abort();
  channel_close(&channel);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static int listener = -1;
  static const char hello[] = "client: fuzz\n";
  if (listener < 0) {
    pthread_t thread;
    struct sockaddr_un un = {.sun_family = AF_UNIX};
    snprintf(address, sizeof address, "unix:/tmp/breccia-fuzz-%d", (int)getpid());
    snprintf(other, sizeof other, "%s-client", address);
    snprintf(un.sun_path, sizeof un.sun_path, "%s", other + 5);
    listener = socket(AF_UNIX, SOCK_STREAM, 0);
    if (bind(listener, (struct sockaddr *)&un, sizeof un) || listen(listener, 4)) abort();
    atexit(tell_counts);
    if (pthread_create(&thread, NULL, serve, NULL)) abort();
    while (!ready) nanosleep(&(struct timespec){.tv_nsec = 1000000L}, NULL);
  }
  if (!size) return 0;
  lines += data[0] % 2 == 0;
  if (data[0] % 4 == 0) {
    tell_client(listener, data + 1, size - 1);
    return 0;
  }
  if (data[0] % 4 == 2) {
    tell_server(data + 1, size - 1);
    size = 1; /* whoever greets next is served */
  }
  /* Frames: operation, flags, count, length of the payload; of whole checksums, or what follows would never be seen. */
  ++conversations;
  Channel *channel = connect_to(address);
  uint32_t session = 0, sequence = 1;
  Frame frame = {.version = FRAME_VERSION, .operation = OPERATION_HELLO, .sequence = 1, .length = sizeof hello - 1};
  if (ask(channel, frame, (const uint8_t *)hello, &session) != (OPERATION_HELLO | OPERATION_ANSWER)) abort();
  for (const uint8_t *at = data + 1, *end = data + size; end - at >= 5;) {
    const uint32_t length = at[3] < end - at - 5 ? at[3] : (uint32_t)(end - at - 5);
    frame = (Frame){.version = at[4] % 16 ? FRAME_VERSION : at[4],
                    .operation = at[0] % 14,
                    .sequence = at[4] % 8 ? ++sequence : sequence,
                    .flags = at[1] % 4,
                    .count = at[2] == 255 ? 0xffffffffu : at[2] % 32,
                    .length = length,
                    .session = session};
    if (!ask(channel, frame, at + 5, &session)) break;
    at += 5 + length;
  }
  channel_close(&channel);
  return 0;
}
