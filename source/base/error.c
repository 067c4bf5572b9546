#include "base/error.h"

#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LINES = 30, LONGEST_LINE = 4000, END_KEPT = 400 };

struct breccia_error {
  Text text;
  int count, told; /* lines; and with those that were told again, of a mistake that stands at several places */
};

breccia_error *breccia_error_create(void)
{
  return memory_plain(1, sizeof(breccia_error));
}

void breccia_error_destroy(breccia_error **error)
{
  if (!error || !*error) return;
  text_free(&(*error)->text);
  free(*error);
  *error = NULL;
}

const char *breccia_error_text(const breccia_error *error)
{
  if (error && error->text.failed) return "out of memory: not even the message about it could be written";
  return error && error->text.characters ? error->text.characters : "";
}

static bool holds_line(const Error *error, const char *line)
{
  size_t n = strlen(line);
  for (const char *at = error->text.characters; at; at = strchr(at, '\n')) {
    if (*at == '\n') ++at;
    if (!strncmp(at, line, n) && (at[n] == '\n' || !at[n])) return true;
  }
  return false;
}

/** Takes out the middle of a line that nobody would read, between two letters. */
static void cut_line(Text *line)
{
  char *words = line->characters;
  size_t from = LONGEST_LINE - END_KEPT, to = line->length - END_KEPT;
  if (line->length <= LONGEST_LINE) return;
  while (((unsigned char)words[from] & 0xc0) == 0x80) --from;
  while (((unsigned char)words[to] & 0xc0) == 0x80) ++to;
  memcpy(words + from, " ... ", 5);
  memmove(words + from + 5, words + to, line->length - to + 1);
  line->length = from + 5 + line->length - to;
}

static void add_line(Error *error, const char *line)
{
  ++error->told;
  if (holds_line(error, line)) return;
  if (error->count < MOST_LINES)
    text_add(&error->text, "%s%s", error->count ? "\n" : "", line);
  else if (error->count == MOST_LINES)
    text_add(&error->text, "\nand more, which are told when these are mended");
  ++error->count;
}

int error_add(Error *error, int status, const char *format, ...)
{
  CHECK(*format);
  if (!error) return status;
  Text said = {0}, line = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&said, format, arguments);
  va_end(arguments);
  text_add_visible(&line, text_words(&said));
  if (said.failed || line.failed || !line.characters) {
    text_free(&line);
    add_line(error, format);
  } else {
    cut_line(&line);
    add_line(error, line.characters);
  }
  text_free(&said);
  text_free(&line);
  return status;
}

int error_add_all(Error *error, int status, const Error *other)
{
  for (const char *line = breccia_error_text(other); *line;) {
    const int length = (int)strcspn(line, "\n");
    error_add(error, status, "%.*s", length, line);
    line += length + (line[length] != 0);
  }
  return status;
}

int error_out_of_memory(Error *error)
{
  if (!error || error->text.failed) return BRECCIA_FAILURE;
  Text *text = &error->text;
  char *told = text->characters ? strstr(text->characters, "out of memory") : NULL;
  if (told) { /* its line alone */
    while (told > text->characters && told[-1] != '\n') --told;
    text->length = strcspn(told, "\n");
    memmove(text->characters, told, text->length);
    text->characters[text->length] = 0;
    error->count = error->told = 1;
    return BRECCIA_FAILURE;
  }
  text_free(text);
  error->count = error->told = 0;
  return error_add(error, BRECCIA_FAILURE, "out of memory: close other programs, or take fewer particles or threads");
}

bool error_is_full(const Error *error)
{
  return error && error->count > MOST_LINES;
}

int error_count(const Error *error)
{
  return error ? error->told : 0;
}
