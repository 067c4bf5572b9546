/* The XDMF file beside the result file: tells readers without VTKHDF where in results.vtkhdf the numbers of each step are. */
#ifndef BRECCIA_RESULTS_XDMF_H
#define BRECCIA_RESULTS_XDMF_H

#include "base/error.h"
#include <stdint.h>

typedef struct XdmfField {
  const char *name; /* of its dataset in Breccia/States/<step> */
  int components;
} XdmfField;

typedef struct XdmfSeries {
  int64_t particles, writes;
  const double *times;  /* [writes] */
  const int64_t *steps; /* [writes] */
  const XdmfField *fields;
  int count, bytes; /* of fields; of each of their numbers */
} XdmfSeries;

/** Writes the whole series to `path` at once. @return BRECCIA_OK, or BRECCIA_FAILURE after a line with the cause */
int xdmf_write(const char *path, const XdmfSeries *series, Error *error);

#endif
