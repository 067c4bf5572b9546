/* Frames of the material server's protocol, byte by byte as docs/material-server.md tells. */
#ifndef BRECCIA_REMOTE_FRAME_H
#define BRECCIA_REMOTE_FRAME_H

#include "base/text.h"

#include <stdint.h>

enum { FRAME_HEADER = 32, FRAME_VERSION = 1, FRAME_MOST_PAYLOAD = 1 << 28, MOST_REFUSAL = 1000 /* bytes */ };

typedef enum Operation {
  OPERATION_HELLO = 1,
  OPERATION_PROBE,
  OPERATION_CREATE,
  OPERATION_ATTACH,
  OPERATION_TRIAL,
  OPERATION_COMMIT,
  OPERATION_REVERT,
  OPERATION_SAVE,
  OPERATION_RESTORE,
  OPERATION_STATISTICS,
  OPERATION_BYE,
  OPERATION_LAWS,
  OPERATION_ERROR = 0x7f,
  OPERATION_ANSWER = 0x80 /* added to the operation that is answered */
} Operation;

/** Flags of TRIAL. */
enum { TRIAL_COMMITS_BEFORE = 1, TRIAL_WANTS_TANGENT = 2 };

typedef struct Frame {
  uint16_t version, operation;
  uint32_t sequence, flags, count, length, session;
  uint32_t checksum; /* as it came */
} Frame;

/** Writes header and checksum in front of `length` bytes of payload that stand at bytes + FRAME_HEADER. */
void frame_seal(const Frame *frame, uint8_t *bytes);

/** Writes a whole frame that refuses another in words, which are cut after MOST_REFUSAL. @return its size */
size_t frame_refuse(uint8_t bytes[FRAME_HEADER + MOST_REFUSAL], uint32_t sequence, const char *words);

/** Reads a header. @return 0, or 1 with the reason why these bytes are no frame */
int frame_read(Frame *frame, const uint8_t header[FRAME_HEADER], Text *reason);

/** @return 0 if the checksum holds for header and payload, or 1 with the reason */
int frame_check(const Frame *frame, const uint8_t *header, const uint8_t *payload, Text *reason);

/** Value of a line "key: value" in the text of a frame. @return a copy to be freed, or NULL if there is no such line */
char *frame_line(const char *text, size_t length, const char *key);
/** The same as a number; `otherwise` if there is none. */
double frame_number(const char *text, size_t length, const char *key, double otherwise);

#endif
