/* What belongs to the process that embeds the library: taken into use at the beginning of a public function, given back at its end. */
#ifndef BRECCIA_MODEL_HOST_H
#define BRECCIA_MODEL_HOST_H

#include "base/error.h"
#include "base/plain_locale.h"
#include <hdf5.h>
#include <stdbool.h>

typedef struct Host {
  locale_t locale;    /* of this thread */
  H5E_auto2_t report; /* what HDF5 does with its errors: prints them, unless somebody says otherwise */
  void *report_to;
  long refusals; /* of memory to this thread, until now */
} Host;

/** Refuses a NULL pointer where a function of the public interface needs an object.
 *  @param[in] function, name  of the function and of its argument, for the message
 *  @return true after a message; false: the pointer is not NULL */
bool host_lacks(const void *given, const char *function, const char *name, Error *error);

/** Refuses a list of a public struct that has no items where its count says that there are some.
 *  @param[in] items  [count] words
 *  @return true after a message; false: the list can be read */
bool host_lacks_items(const char *const *items, int count, const char *owner, const char *name, Error *error);

Host host_enter(void);

/** Whether all went well since the function began. @return `status`, or BRECCIA_FAILURE with a line that says so if memory was out meanwhile:
 *  then what was made may lack a part, and what was found wrong may be wrong only for that */
int host_status(const Host *host, int status, Error *error);

/** @return host_status of the function that ends here */
int host_leave(const Host *host, int status, Error *error);

#endif
