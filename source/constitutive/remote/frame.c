#include "constitutive/remote/frame.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "frames are little-endian, and are copied as they are");

static const char magic[4] = {'B', 'R', 'M', 'S'};

static uint32_t checksum_of(const uint8_t *header, const uint8_t *payload, uint32_t length)
{
  const uLong sum = crc32(crc32(0, Z_NULL, 0), header, FRAME_HEADER - 4);
  return (uint32_t)(length ? crc32(sum, payload, length) : sum);
}

void frame_seal(const Frame *frame, uint8_t *bytes)
{
  const uint32_t numbers[5] = {frame->sequence, frame->flags, frame->count, frame->length, frame->session};
  memcpy(bytes, magic, 4);
  memcpy(bytes + 4, &frame->version, 2);
  memcpy(bytes + 6, &frame->operation, 2);
  memcpy(bytes + 8, numbers, sizeof numbers);
  const uint32_t sum = checksum_of(bytes, bytes + FRAME_HEADER, frame->length);
  memcpy(bytes + 28, &sum, 4);
}

size_t frame_refuse(uint8_t bytes[FRAME_HEADER + MOST_REFUSAL], uint32_t sequence, const char *words)
{
  const size_t length = strnlen(words, MOST_REFUSAL);
  const Frame frame = {
      .version = FRAME_VERSION, .operation = OPERATION_ERROR, .sequence = sequence, .length = (uint32_t)length};
  memcpy(bytes + FRAME_HEADER, words, length);
  frame_seal(&frame, bytes);
  return FRAME_HEADER + length;
}

int frame_read(Frame *frame, const uint8_t header[FRAME_HEADER], Text *reason)
{
  uint32_t numbers[6];
  memcpy(&frame->version, header + 4, 2);
  memcpy(&frame->operation, header + 6, 2);
  memcpy(numbers, header + 8, sizeof numbers);
  frame->sequence = numbers[0];
  frame->flags = numbers[1];
  frame->count = numbers[2];
  frame->length = numbers[3];
  frame->session = numbers[4];
  frame->checksum = numbers[5];
  if (memcmp(header, magic, 4)) {
    text_add(reason, "what came is no frame of a material server (it begins with %02x %02x %02x %02x)", header[0],
             header[1], header[2], header[3]);
    return 1;
  }
  if (frame->length <= FRAME_MOST_PAYLOAD) return 0;
  text_add(reason, "a frame of %lu bytes was announced; the most is %d", (unsigned long)frame->length,
           FRAME_MOST_PAYLOAD);
  return 1;
}

int frame_check(const Frame *frame, const uint8_t *header, const uint8_t *payload, Text *reason)
{
  if (checksum_of(header, payload, frame->length) == frame->checksum) return 0;
  text_add(reason, "a frame came damaged (its checksum does not hold)");
  return 1;
}

char *frame_line(const char *text, size_t length, const char *key)
{
  const size_t size = strlen(key);
  for (const char *line = text, *end = text + length; line < end;) {
    const char *stop = memchr(line, '\n', (size_t)(end - line));
    if (!stop) stop = end;
    if ((size_t)(stop - line) > size && !memcmp(line, key, size) && line[size] == ':') {
      const char *value = line + size + 1;
      while (value < stop && *value == ' ') ++value;
      return text_format("%.*s", (int)(stop - value), value);
    }
    line = stop + 1;
  }
  return NULL;
}

double frame_number(const char *text, size_t length, const char *key, double otherwise)
{
  char *value = frame_line(text, length, key), *end = value;
  double number = value ? strtod(value, &end) : otherwise;
  if (end == value) number = otherwise;
  free(value);
  return number;
}
