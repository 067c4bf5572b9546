/* Where a material server waits for its clients, and serves one at a time. */
#ifndef BRECCIA_REMOTE_LISTENER_H
#define BRECCIA_REMOTE_LISTENER_H

#include "constitutive/remote/channel.h"

typedef struct Listener Listener;

typedef struct ListenerSpec {
  const char
      *address; /* loopback or a socket file that only its owner reaches; tcp://127.0.0.1:0 takes any free port */
  bool open;    /* any interface may be listened to */
  /** Whether a first frame greets as it should; 0, or 1 with the reason why its sender is not served. */
  int (*greets)(const void *context, const Frame *frame, const uint8_t *payload, Text *reason);
  const void *context;
  const volatile int *interrupted; /* ends waits early once it is not zero; may be NULL */
  double silence; /* s, of a client of datagrams, after which another may take its place; 0: a minute */
} ListenerSpec;

/** Waits for clients at an address. @return NULL with the reason */
Listener *listener_open(const ListenerSpec *spec, Text *reason);
/** Where it listens, with the port that it got. */
const char *listener_address(const Listener *listener);
/** Next frame of the one client that is served. Whoever has not greeted yet is listened to beside it and never waited for; who greets while
 *  a client is there is told that the server is busy. A client that sends datagrams says not when it leaves: another may take its place
 *  when it has been silent for as long as the specification says.
 *  @param[out] fresh  the frame is the greeting of a new client
 *  @return CHANNEL_CLOSED when a client has gone, CHANNEL_LATE after `seconds` without a frame, CHANNEL_BROKEN, with the reason, after bytes
 *          that are no frame or one that did not come whole within a minute */
ChannelStatus listener_receive(Listener *listener, Frame *frame, uint8_t **payload, bool *fresh, double seconds,
                               Text *reason);
/** The channel to the client that is served. */
Channel *listener_channel(Listener *listener);
/** Lets the client go. */
void listener_drop(Listener *listener);
void listener_close(Listener **listener);

#endif
