/* Addresses of material servers: tcp://HOST:PORT, udp://HOST:PORT, unix:/PATH. */
#ifndef BRECCIA_REMOTE_ADDRESS_H
#define BRECCIA_REMOTE_ADDRESS_H

#include "base/text.h"

typedef enum Transport { TRANSPORT_TCP, TRANSPORT_UNIX, TRANSPORT_UDP } Transport;

/** The socket of an address, bound or connected.
 *  @param[in] open  any interface may be listened to, not only this machine's own
 *  @return -1 with the reason, and errno */
int address_open(const char *address, bool listen_there, bool open, Transport *transport, Text *reason);
/** Sets a connected socket up for batches: TCP sends at once; Unix sockets take in as much as the system allows, so that both ends need not
 *  take turns over one batch. */
void address_tune(int socket, Transport transport);

#endif
