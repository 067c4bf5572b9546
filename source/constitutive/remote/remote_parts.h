/* What the files of the client share: the servers of a remote material, and questions to one of them. */
#ifndef BRECCIA_REMOTE_REMOTE_PARTS_H
#define BRECCIA_REMOTE_REMOTE_PARTS_H

#include "constitutive/remote/channel.h"
#include "constitutive/remote/process.h"
#include "constitutive/remote/remote.h"

#include <pthread.h>

enum { IDENTITY = 2, TRIAL_HEAD = 8 };

typedef struct RemoteServer {
  char *address;
  Process process;
  Channel *channel;
  uint32_t sequence, session;
  int64_t first, count, commits;
  bool commit_due; /* the last trial is to be committed with what is sent next */
  bool tried;      /* there is a trial that could be committed */
  bool waiting;    /* for the answer to a trial */
  bool greeted;    /* it notices that the line is closed */
  double waited, evaluations;
  double bytes[2];        /* sent and received by lines that were given up */
  const double *stresses; /* as of the last answer */
} RemoteServer;

struct Remote {
  breccia_law law;
  char *material, *command, *units[3], *folder;
  char *name; /* of the law, for people: "Concrete01 of OpenSees" */
  int stage, count;
  double timeout, stress_unit, length;
  RemoteServer *servers;
  int components, state;
  bool iterates, saves, begun;
  double bulk, shear, failure;
  Text problem; /* once set, no server is asked any more */
  pthread_mutex_t lock;
};

/* ---- questions to one server (remote_questions.c); all return 0, or 1 after remote_complain ---- */

/** "material 'clay': server 1 of 2 at ..." */
void remote_name_server(const Remote *r, const RemoteServer *s, Text *text);
/** Says what went wrong with a server; the first to be said stays. */
void remote_complain(Remote *r, const RemoteServer *s, const char *words);
/** Adds what went wrong to an error. @return BRECCIA_FAILURE */
int remote_tell(const Remote *r, Error *error);
/** Asks with a text or bytes and waits. @param[out] reply  borrowed until the next question */
int remote_ask(Remote *r, RemoteServer *s, Operation operation, uint32_t count, const Text *text, Frame *frame,
               uint8_t **reply);
/** Bytes sent and received, on this line and those before. */
void remote_count_bytes(const RemoteServer *s, double bytes[2]);
/** HELLO, with the secret. The answer tells what the server holds. */
int remote_say_hello(Remote *r, RemoteServer *s, Frame *frame, uint8_t **reply);
/** Closes the line to a server. A server of datagrams does not see that, and is told. */
void remote_hang_up(RemoteServer *s);
/** PROBE or CREATE. */
int remote_ask_points(Remote *r, RemoteServer *s, Operation operation, int64_t count, Frame *frame, uint8_t **reply);
/** Bytes of a trial of so many points. */
size_t remote_trial_size(const Remote *r, int64_t count);
/** Sends `count` strains, which stand in the channel's payload, of points from `first` of the server's own on. */
int remote_send_trial(Remote *r, RemoteServer *s, int64_t first, int64_t count, bool tangent);
/** Its stresses and, if wanted, tangents, in the deck's unit. @return NULL if something went wrong, with *bad the point, or 0 */
double *remote_receive_trial(Remote *r, RemoteServer *s, int64_t count, bool tangent, int64_t *bad);

/* ---- others ---- */

/** The law that others see, of a remote that knows components and moduli (remote_law.c). */
void remote_make_law(Remote *r);
/** Tells servers which points are theirs (remote.c). */
void remote_divide(Remote *r, const int64_t *starts);
/** Makes room for the strains of all points of a server, so that threads can fill it in together (remote.c). */
int remote_make_room(Remote *r, Error *error);

#endif
