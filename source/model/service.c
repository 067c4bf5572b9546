/* The library's own laws for other programs. */
#include "constitutive/remote/server.h"
#include "model/host.h"
#include "model/sized.h"
#include <stdlib.h>
#include <string.h>

/** The first line of a file. To be freed; NULL after a message. */
static char *read_secret(const char *path, Error *error)
{
  char *secret = text_read_file(path, NULL);
  if (secret) secret[strcspn(secret, "\r\n")] = 0;
  if (secret && *secret) return secret;
  free(secret);
  error_add(error, BRECCIA_USER_ERROR, "%s: no secret can be read there", path);
  return NULL;
}

int breccia_serve(const breccia_service *given, breccia_error *error)
{
  const Host host = host_enter();
  breccia_service service;
  char *secret = NULL;
  int status = sized_take(&service, sizeof service, given, "breccia_service", error);
  if (!status && !service.address) status = error_add(error, BRECCIA_USER_ERROR, "a service needs an address");
  if (!status && service.secret_file && !(secret = read_secret(service.secret_file, error)))
    status = BRECCIA_USER_ERROR;
  const ServeSpec spec = {.address = service.address,
                          .secret = secret,
                          .once = service.once != 0,
                          .zeros = service.zeros != 0,
                          .interrupted = service.interrupted,
                          .listening = service.listening};
  if (!status) status = serve_materials(&spec, error);
  free(secret);
  return host_leave(&host, status, error);
}
