/* Frames over sockets: TCP (tcp://host:port), a socket in the file system (unix:/path) or datagrams (udp://host:port). Every wait has
 * an end. What goes wrong is told in words: one line, without the address. */
#ifndef BRECCIA_REMOTE_CHANNEL_H
#define BRECCIA_REMOTE_CHANNEL_H

#include "constitutive/remote/frame.h"

typedef struct Channel Channel;

typedef enum ChannelStatus {
  CHANNEL_OK,
  CHANNEL_LATE,   /* nothing came in time */
  CHANNEL_CLOSED, /* the other side is gone */
  CHANNEL_BROKEN  /* what came makes no sense */
} ChannelStatus;

/** Reaches a server, trying again until `seconds` are over or `stop` says so.
 *  @return NULL with the reason */
Channel *channel_connect(const char *address, double seconds, int (*stop)(void *context), void *context, Text *reason);
void channel_close(Channel **channel);

/** Whether a sent frame may be lost, so that it is to be sent again when no answer comes. */
bool channel_may_lose(const Channel *channel);
/** Largest payload that a frame can have here. */
size_t channel_most_payload(const Channel *channel);

/** Room for the payload of the next frame to be sent; stays the same while `length` does not grow. @return NULL: out of memory */
uint8_t *channel_payload(Channel *channel, size_t length);
/** Sends a frame whose payload stands in channel_payload; channel_repeat sends the same once more. */
ChannelStatus channel_send(Channel *channel, const Frame *frame, double seconds, Text *reason);
ChannelStatus channel_repeat(Channel *channel, double seconds, Text *reason);
/** Receives one frame. @param[out] payload  borrowed until the next is received; a zero byte stands behind it */
ChannelStatus channel_receive(Channel *channel, Frame *frame, uint8_t **payload, double seconds, Text *reason);
/** A channel over a socket that is connected, or, with a `borrowed` one of datagrams, to whom channel_turn_to_sender says.
 *  @return NULL, with the socket closed unless it is borrowed: out of memory */
Channel *channel_over(int socket, bool datagrams, bool borrowed);
int channel_socket(const Channel *channel);
/** Waits end early, as if nothing had come in time, once *interrupted is not zero. */
void channel_interruptible(Channel *channel, const volatile int *interrupted);
/** Of a borrowed socket of datagrams: whether the last frame came from where frames go; makes its sender the one that they go to; or
 *  refuses it in words and goes on as before. */
bool channel_from_peer(const Channel *channel);
void channel_turn_to_sender(Channel *channel);
void channel_refuse_sender(Channel *channel, uint32_t sequence, const char *words);
/** Bytes sent and received so far. */
void channel_bytes(const Channel *channel, double bytes[2]);

#endif
