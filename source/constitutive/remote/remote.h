/* A constitutive law that runs in other processes: material servers, each of which holds some of the points. Neither formulations nor
 * solvers know of it: it is a law like others, except that whole parts of a body go out at once (post, collect).
 *
 * Points are numbered 0 .. n-1; a row of history begins with the number (or -1: no point), then strain and stress as of the last
 * answer, then what the server can save. Until remote_begin, and in the elastic stage, no server is asked: points answer elastically,
 * from the last answer on. */
#ifndef BRECCIA_REMOTE_REMOTE_H
#define BRECCIA_REMOTE_REMOTE_H

#include "base/error.h"
#include "base/text.h"

#include <stdint.h>

typedef struct Remote Remote;

typedef struct RemoteSpec {
  const char *material;       /* its name, for messages */
  const char *command;        /* what the server makes of each point */
  int stage;                  /* 0: elastic, 1: plastic, -1: not said */
  const char *const *servers; /* addresses of servers that run already */
  int server_count;           /* 0: start `processes` of the OpenSees server */
  int processes;
  double timeout;       /* seconds that an answer may take */
  double stress_unit;   /* the command's unit of stress, in the deck's */
  const char *units[3]; /* of length, force and time, in words */
  double length;        /* characteristic, or NaN */
} RemoteSpec;

/** Starts or reaches the servers and asks what the command makes. Points come with remote_begin. */
int remote_open(Remote **remote, const RemoteSpec *spec, Error *error);
/** Takes leave of the servers and ends those that it started. */
void remote_close(Remote **remote);

/** What the OpenSees server that the program would start offers: the text of its answer to LAWS (docs/material-server.md). */
int remote_list_laws(Text *lines, Error *error);

/** The law as others see it. Its constants are a Remote *. */
const breccia_law *remote_law(const Remote *remote);
int remote_servers(const Remote *remote);
/** Whether the servers have their points. */
bool remote_begun(const Remote *remote);
/** Whether a trial can be repeated from the committed state. */
bool remote_iterates(const Remote *remote);
/** Notes strain and stress of the last answer in a row. */
void remote_note(const Remote *remote, double *row, const double *strain, const double *stress);
/** Where the server's own numbers begin in a row of history, and how many there are. */
int remote_state_at(const Remote *remote);
int remote_state_values(const Remote *remote);

/** Makes the points: those from starts[k] to starts[k + 1] - 1 in server k. */
int remote_begin(Remote *remote, const int64_t *starts, Error *error);
/** The same after a restart. `state` are all points' saved numbers, [points][remote_state_values], or NULL where servers save none:
 *  then servers that still hold the sessions of `identity` are taken up again, and others are told of. */
int remote_resume(Remote *remote, const int64_t *starts, double *state, const double *identity, Error *error);
/** Numbers by which servers are found again: session and count of commits of each, [servers][2]. Commits what is due. */
int remote_identify(Remote *remote, double *identity, Error *error);
/** After something went wrong: reaches the servers again, as what is said on their lines may be out of step.
 *  @return whether all of them hold the state that was committed last, so that it can be saved */
bool remote_rescue(Remote *remote);
/** Fetches what servers save of all points, [points][remote_state_values]. */
int remote_save(Remote *remote, double *state, Error *error);

/** Room for the strains of all points of a server, point after point; NULL: there is no memory, or the server is lost. */
double *remote_strains(Remote *remote, int server);
/** Sends them; the server computes while others are served. */
void remote_post(Remote *remote, int server);
/** Waits for its stresses. @return false if something went wrong; *bad is then a point of this server, counted from 0 */
bool remote_collect(Remote *remote, int server, int64_t *bad);
/** What was collected, point after point; NULL if nothing was. */
const double *remote_stresses(const Remote *remote, int server);
/** Makes the last trials the committed state, with the next trial. */
void remote_commit(Remote *remote);

/** What went wrong, one line; "" if nothing did. */
const char *remote_problem(const Remote *remote);
/** A line per server for a run's outcome: points per second, waiting, bytes. As objects of a JSON list if `json`. */
void remote_report(Remote *remote, double run_seconds, bool json, Text *text);

#endif
