#include "model/host.h"

#include "base/memory.h"

bool host_lacks(const void *given, const char *function, const char *name, Error *error)
{
  if (!given) error_add(error, BRECCIA_USER_ERROR, "%s: %s is NULL", function, name);
  return !given;
}

bool host_lacks_items(const char *const *items, int count, const char *owner, const char *name, Error *error)
{
  int missing = -1;
  if (count < 0 || (count > 0 && !items)) {
    error_add(error, BRECCIA_USER_ERROR, "%s: %s has %d items%s; expected a count of 0 or more, and as many items",
              owner, name, count, items ? "" : " and is NULL");
    return true;
  }
  for (int k = 0; k < count && missing < 0; ++k)
    if (!items[k]) missing = k;
  if (missing >= 0) error_add(error, BRECCIA_USER_ERROR, "%s: item %d of %s is NULL", owner, missing, name);
  return missing >= 0;
}

Host host_enter(void)
{
  Host host = {.locale = locale_plain(), .refusals = memory_refusals()};
  H5Eget_auto2(H5E_DEFAULT, &host.report, &host.report_to);
  return host;
}

int host_status(const Host *host, int status, Error *error)
{
  return memory_refusals() == host->refusals ? status : error_out_of_memory(error);
}

int host_leave(const Host *host, int status, Error *error)
{
  H5Eset_auto2(H5E_DEFAULT, host->report, host->report_to);
  locale_return(host->locale);
  return host_status(host, status, error);
}
