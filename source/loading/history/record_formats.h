/* Formats of strong-motion records that have a header, one a file of this folder. */
#ifndef BRECCIA_LOADING_HISTORY_RECORD_FORMATS_H
#define BRECCIA_LOADING_HISTORY_RECORD_FORMATS_H

#include "loading/history/record_scan.h"

typedef struct RecordFormat {
  /* Returns true for files of this format, by what they hold, or by the ending of their names. */
  bool (*recognises)(const RecordText *text);
  /* Reads the values; `label` is as record_read has it. */
  int (*read)(Record *record, const RecordText *text, const RecordFile *file, char *label, Error *error);
} RecordFormat;

extern const RecordFormat record_cosmos, record_knet, record_peer, record_smc;

#endif
