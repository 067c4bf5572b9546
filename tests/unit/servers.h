/* Material servers of the program's own laws, in threads of a test. */
#ifndef BRECCIA_TESTS_SERVERS_H
#define BRECCIA_TESTS_SERVERS_H

#include "support.h"

#include "constitutive/remote/server.h"

#include <pthread.h>
#include <time.h>
#include <unistd.h>

enum { MOST_SERVERS = 2 };

typedef struct Servers {
  char folder[32], address[MOST_SERVERS][64];
  pthread_t thread[MOST_SERVERS];
  ServeSpec spec[MOST_SERVERS];
  int count;
} Servers;

static volatile int servers_listening, servers_interrupted;

static inline void servers_count(const char *address)
{
  (void)address;
  __atomic_fetch_add(&servers_listening, 1, __ATOMIC_SEQ_CST);
}

static inline void *servers_serve(void *spec)
{
  static int bad = 1;
  return serve_materials(spec, NULL) ? &bad : NULL;
}

static inline void servers_start(Servers *s, int count)
{
  *s = (Servers){.folder = "/tmp/breccia-served-XXXXXX", .count = count};
  assert_non_null(mkdtemp(s->folder));
  servers_listening = servers_interrupted = 0;
  for (int k = 0; k < count; ++k) {
    snprintf(s->address[k], sizeof s->address[k], "unix:%s/%d", s->folder, k);
    s->spec[k] = (ServeSpec){.address = s->address[k], .interrupted = &servers_interrupted, .listening = servers_count};
    assert_int_equal(pthread_create(&s->thread[k], NULL, servers_serve, &s->spec[k]), 0);
  }
  while (servers_listening < count) nanosleep(&(struct timespec){.tv_nsec = 1000000L}, NULL);
}

/** When nobody is served any more. */
static inline void servers_stop(Servers *s)
{
  servers_interrupted = 1;
  for (int k = 0; k < s->count; ++k) {
    void *bad;
    pthread_join(s->thread[k], &bad);
    assert_null(bad);
  }
  rmdir(s->folder);
}

#endif
