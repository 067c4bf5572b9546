#include "constitutive/remote/address.h"

#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

enum { SEND_ROOM = 4 << 20 }; /* bytes */

enum { LARGEST_PORT = 65535 };

/** Whether the words are the number of a port. */
static bool is_port(const char *words, int smallest)
{
  const size_t digits = strspn(words, "0123456789");
  if (!digits || digits > 5 || words[digits]) return false;
  const long port = strtol(words, NULL, 10);
  return port >= smallest && port <= LARGEST_PORT;
}

/** @param[in] smallest_port  0 where any free one may be taken, otherwise 1 */
static int parse(const char *address, int smallest_port, Transport *transport, char *host, size_t host_size, char *port,
                 size_t port_size, Text *reason)
{
  static const char *const kinds[] = {"tcp://", "unix:", "udp://"};
  int kind = 0;
  while (kind < 3 && strncmp(address, kinds[kind], strlen(kinds[kind]))) ++kind;
  if (kind == 3) {
    text_add(reason, "an address is tcp://HOST:PORT, udp://HOST:PORT or unix:/PATH");
    return 1;
  }
  *transport = (Transport)kind;
  const char *rest = address + strlen(kinds[kind]);
  if (kind == TRANSPORT_UNIX) {
    const struct sockaddr_un *un = NULL;
    if (!*rest || strlen(rest) >= sizeof un->sun_path || strlen(rest) >= host_size) {
      text_add(reason, "the path of a socket must have 1 to %zu characters", sizeof un->sun_path - 1);
      return 1;
    }
    snprintf(host, host_size, "%s", rest);
    return 0;
  }
  const char *colon = strrchr(rest, ':');
  const char *first = rest, *last = colon;
  if (colon && *rest == '[' && colon > rest + 1 && colon[-1] == ']') { /* [::1]:port */
    ++first;
    --last;
  }
  if (!colon || first >= last || !colon[1] || (size_t)(last - first) >= host_size) {
    text_add(reason, "an address is %sHOST:PORT", kinds[kind]);
    return 1;
  }
  if (!is_port(colon + 1, smallest_port)) {
    text_add(reason, "'%.20s' is no port: expected a number from %d to %d", colon + 1, smallest_port, LARGEST_PORT);
    return 1;
  }
  snprintf(host, host_size, "%.*s", (int)(last - first), first);
  snprintf(port, port_size, "%s", colon + 1);
  return 0;
}

void address_tune(int s, Transport transport)
{
  const int on = 1, room = SEND_ROOM;
  if (transport == TRANSPORT_TCP) setsockopt(s, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (transport == TRANSPORT_UNIX) setsockopt(s, SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
}

int address_open(const char *address, bool listen_there, bool open, Transport *transport, Text *reason)
{
  char host[256], port[32] = "";
  if (parse(address, listen_there ? 0 : 1, transport, host, sizeof host, port, sizeof port, reason)) {
    errno = EINVAL;
    return -1;
  }
  if (*transport == TRANSPORT_UNIX) {
    struct sockaddr_un un = {.sun_family = AF_UNIX};
    memcpy(un.sun_path, host, strlen(host)); /* parse() has seen that it fits, with a zero behind it */
    const int s = socket(AF_UNIX, SOCK_STREAM, 0);
    const mode_t mask = listen_there ? umask(0177) : 0;
    const int bad = s < 0 || (listen_there ? bind(s, (struct sockaddr *)&un, sizeof un)
                                           : connect(s, (struct sockaddr *)&un, sizeof un));
    const int code = errno;
    if (listen_there) umask(mask);
    if (!bad) {
      address_tune(s, *transport);
      return s;
    }
    text_add(reason, "%s", strerror(code));
    if (s >= 0) close(s);
    errno = code;
    return -1;
  }
  struct addrinfo hints = {.ai_family = AF_UNSPEC,
                           .ai_socktype = *transport == TRANSPORT_TCP ? SOCK_STREAM : SOCK_DGRAM,
                           .ai_flags = listen_there ? AI_PASSIVE : 0},
                  *list = NULL;
  const int bad_name = getaddrinfo(host, port, &hints, &list);
  if (bad_name) {
    text_add(reason, "'%s': %s", host, gai_strerror(bad_name));
    errno = EINVAL;
    return -1;
  }
  int found = -1, code = 0;
  for (const struct addrinfo *a = list; a && found < 0; a = a->ai_next) {
    const bool loopback =
        a->ai_family == AF_INET
            ? (ntohl(((const struct sockaddr_in *)(const void *)a->ai_addr)->sin_addr.s_addr) >> 24) == 127
            : IN6_IS_ADDR_LOOPBACK(&((const struct sockaddr_in6 *)(const void *)a->ai_addr)->sin6_addr);
    if (listen_there && !open && !loopback) {
      code = EACCES;
      continue;
    }
    const int s = socket(a->ai_family, a->ai_socktype, a->ai_protocol), on = 1;
    if (s < 0) continue;
    address_tune(s, *transport);
    if (*transport == TRANSPORT_TCP && listen_there) setsockopt(s, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (!(listen_there ? bind(s, a->ai_addr, a->ai_addrlen) : connect(s, a->ai_addr, a->ai_addrlen))) {
      found = s;
      break;
    }
    code = errno;
    close(s);
  }
  freeaddrinfo(list);
  if (found < 0)
    text_add(reason, "%s",
             code == EACCES && listen_there && !open
                 ? "a server listens on this machine only, unless a secret guards it (--secret-file)"
                 : strerror(code));
  errno = code;
  return found;
}
