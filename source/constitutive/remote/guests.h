/* Connections that have not greeted yet. Nothing of them is waited for, and little is kept: none can hold a server. */
#ifndef BRECCIA_REMOTE_GUESTS_H
#define BRECCIA_REMOTE_GUESTS_H

#include "constitutive/remote/frame.h"

#include <poll.h>

enum { GUESTS = 8, MOST_GREETING = 4096 /* bytes of a greeting's payload */ };

typedef struct Guest {
  int socket; /* -1: nobody */
  size_t got;
  double end; /* on the clock, when it is let go */
  bool
      dismissed; /* it has been told why not; what else it sends is read and dropped, or closing would take the words away again */
  uint8_t bytes[FRAME_HEADER + MOST_GREETING + 1];
} Guest;

typedef enum GuestStatus {
  GUEST_SILENT, /* nothing whole came yet */
  GUEST_SPEAKS, /* its first frame is there */
  GUEST_ODD     /* what came is no frame, or too long for a greeting */
} GuestStatus;

/** Makes room for none. */
void guests_clear(Guest guests[GUESTS]);
/** Takes a connection in. Where there is no room the one that has been here longest goes. */
void guest_enter(Guest guests[GUESTS], int socket);
/** Adds what is to be waited for, one entry per guest. @return milliseconds until the first must go, at most `most` */
int guests_await(const Guest guests[GUESTS], struct pollfd polls[GUESTS], int most);
/** Reads what has come, without waiting; lets a guest go that has left.
 *  @param[out] payload  of the frame of one that speaks, with a zero byte behind it: valid while the guest is there
 *  @param[out] reason  of one that is odd */
GuestStatus guest_hear(Guest *guest, Frame *frame, uint8_t **payload, Text *reason);
/** Tells a guest why it is not served. */
void guest_dismiss(Guest *guest, uint32_t sequence, const char *words);
/** @return its socket, which is the caller's from now on */
int guest_promote(Guest *guest);
/** Lets those go whose time is over. */
void guests_expire(Guest guests[GUESTS]);
/** Lets all go. */
void guests_close(Guest guests[GUESTS]);

#endif
