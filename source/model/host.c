#include "model/host.h"

Host host_enter(void)
{
  Host host = {.locale = locale_plain()};
  H5Eget_auto2(H5E_DEFAULT, &host.report, &host.report_to);
  return host;
}

void host_leave(const Host *host)
{
  H5Eset_auto2(H5E_DEFAULT, host->report, host->report_to);
  locale_return(host->locale);
}
