/* What belongs to the process that embeds the library: taken into use at the beginning of a public function, given back at its end. */
#ifndef BRECCIA_MODEL_HOST_H
#define BRECCIA_MODEL_HOST_H

#include "base/plain_locale.h"
#include <hdf5.h>

typedef struct Host {
  locale_t locale;    /* of this thread */
  H5E_auto2_t report; /* what HDF5 does with its errors: prints them, unless somebody says otherwise */
  void *report_to;
} Host;

Host host_enter(void);
void host_leave(const Host *host);

#endif
