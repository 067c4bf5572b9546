/* Serves the program's own laws to others over the protocol of docs/material-server.md. */
#ifndef BRECCIA_REMOTE_SERVER_H
#define BRECCIA_REMOTE_SERVER_H

#include "constitutive/material.h"

typedef struct ServeSpec {
  const char *address;
  const char *secret; /* that clients must know; NULL: none, and only this machine is listened to */
  const LawList *laws;
  bool once;      /* end when the first client has gone */
  bool zeros;     /* answer with zeros instead of stresses: what the protocol itself costs */
  double silence; /* s, of a client of datagrams, after which another may take its place; 0: a minute */
  const volatile int *interrupted;
  void (*listening)(const char *address); /* once it does; may be NULL */
} ServeSpec;

/** Serves until it is told to end. One client at a time; between clients its points stay as they are. */
int serve_materials(const ServeSpec *spec, Error *error);

#endif
