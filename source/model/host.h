/* What belongs to the process that embeds the library: taken into use at the beginning of a public function, given back at its end. */
#ifndef BRECCIA_MODEL_HOST_H
#define BRECCIA_MODEL_HOST_H

#include "base/error.h"
#include "base/plain_locale.h"
#include <hdf5.h>

typedef struct Host {
  locale_t locale;    /* of this thread */
  H5E_auto2_t report; /* what HDF5 does with its errors: prints them, unless somebody says otherwise */
  void *report_to;
  long refusals; /* of memory to this thread, until now */
} Host;

Host host_enter(void);

/** Whether all went well since the function began. @return `status`, or BRECCIA_FAILURE with a line that says so if memory was out meanwhile:
 *  then what was made may lack a part, and what was found wrong may be wrong only for that */
int host_status(const Host *host, int status, Error *error);

/** @return host_status of the function that ends here */
int host_leave(const Host *host, int status, Error *error);

#endif
