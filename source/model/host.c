#include "model/host.h"

#include "base/memory.h"

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
