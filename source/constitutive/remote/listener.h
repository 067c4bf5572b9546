/* Where a material server waits for its clients, and serves one at a time. */
#ifndef BRECCIA_REMOTE_LISTENER_H
#define BRECCIA_REMOTE_LISTENER_H

#include "constitutive/remote/channel.h"

typedef struct Listener Listener;

/** Waits for clients at an address: loopback or a socket file that only its owner reaches, unless `open` allows any interface.
 *  tcp://127.0.0.1:0 takes any free port. @return NULL with the reason */
Listener *listener_open(const char *address, bool open, Text *reason);
/** Where it listens, with the port that it got. */
const char *listener_address(const Listener *listener);
/** Next frame of the one client that is served; new clients are told that it is busy while one is there. Between clients
 *  `*frame` may be the first of a new one.
 *  @param[out] fresh  the frame is the first of a client
 *  @return CHANNEL_CLOSED when a client has gone, CHANNEL_LATE after `seconds` without a frame */
ChannelStatus listener_receive(Listener *listener, Frame *frame, uint8_t **payload, bool *fresh, double seconds,
                               Text *reason);
/** The channel to the client that is served. */
Channel *listener_channel(Listener *listener);
/** Lets the client go. */
void listener_drop(Listener *listener);
void listener_close(Listener **listener);

#endif
