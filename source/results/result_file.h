/* The result file: VTKHDF 2.0 (HDF5), one cloud of points with time steps, and a small XDMF file beside it for older readers.
 *
 * Components of tensors stand in VTK's order, xx yy zz xy yz xz. Breccia/States/<step>/<field> shows one step of one field, for readers that
 * cannot take a part of a dataset (meshio). Positions are the reference positions, written once; every write adds one step of each field.
 * Small files are copied, extended and renamed into place, so that a run killed at any moment leaves a whole one; above COPY_LIMIT bytes
 * they are extended in place, with a journal (journal.h) that keeps them whole too. A copy takes further states until the time since it was made is SELDOM times what copying took: else a
 * thousand states would cost a thousand copies, each longer than the one before. */
#ifndef BRECCIA_RESULTS_RESULT_FILE_H
#define BRECCIA_RESULTS_RESULT_FILE_H

#include "body/selection.h"
#include "results/fields.h"

enum { COPY_LIMIT = 256 << 20, SELDOM = 10 };

typedef struct ResultFile ResultFile;

typedef struct ResultNames {
  const char *const *fields; /* of fields.c, or named history numbers */
  int count;
  bool single;
  const char *deck;              /* what is run; NULL where nothing will be taken up */
  const char *stages;            /* names of the stages of the run with ";" between them; NULL: none */
  const SectionList *selections; /* named selections of the deck; NULL: none */
  const DeckReader *reader;      /* of the deck; needed with selections */
  const double *
      frequencies; /* [frequency_count] in Hz, of modes of vibration that stand in place of states: the n-th at time and step n; NULL: of a run */
  int frequency_count;
} ResultNames;

/** Step, time and stage of a state. */
typedef struct ResultMoment {
  int64_t step;
  double time;
  int64_t stage; /* from 0 */
} ResultMoment;

/** Begins a result file in `folder` (results.vtkhdf and results.xdmf), replacing an older one. */
int result_file_create(ResultFile **file, const char *folder, const Domain *domain, const Units *units,
                       const char *title, const ResultNames *names, Error *error);
/** Takes up the file of a run that stopped, keeping the states up to a step: the last that was due. What stands behind was written because the
 *  run ended there, or after its checkpoint. */
int result_file_resume(ResultFile **file, const char *folder, const Domain *domain, const Units *units,
                       const char *title, const ResultNames *names, int64_t last, Error *error);
/** Bytes that one state takes in a file with these fields. */
double result_file_state_bytes(const Domain *domain, const ResultNames *names);
/** Adds the present state. It may stand only in the copy at first; result_file_show shows it.
 *  @return BRECCIA_OK; BRECCIA_FAILURE after a line with the cause, and from then on without one: states are lost, and no more are added */
int result_file_write(ResultFile *file, const Domain *domain, const ResultMoment *moment, Error *error);
/** Puts all states into the file that others read. */
int result_file_show(ResultFile *file, Error *error);
void result_file_destroy(ResultFile **file);

#endif
