#include "base/text.h"

#include "base/memory.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const int64_t largest = (int64_t)4 << 30; /* bytes of a file; more would only fill the memory */

void text_add_list(Text *text, const char *format, va_list arguments)
{
  if (text->failed) return;
  va_list again;
  va_copy(again, arguments);
  int needed = vsnprintf(NULL, 0, format, again);
  va_end(again);
  if (needed < 0) return;
  size_t wanted = text->length + (size_t)needed + 1;
  if (wanted > text->capacity) {
    size_t capacity = wanted > 2 * text->capacity ? wanted : 2 * text->capacity;
    char *grown = memory_grown(text->characters, capacity, 1);
    if (!grown) {
      text->failed = true;
      return;
    }
    text->characters = grown;
    text->capacity = capacity;
  }
  vsnprintf(text->characters + text->length, (size_t)needed + 1, format, arguments);
  text->length += (size_t)needed;
}

void text_add(Text *text, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  text_add_list(text, format, arguments);
  va_end(arguments);
}

void text_add_json(Text *text, const char *words)
{
  text_add(text, "\"");
  for (const unsigned char *c = (const unsigned char *)words; *c; ++c) {
    if (*c == '"' || *c == '\\')
      text_add(text, "\\%c", *c);
    else if (*c < 0x20)
      text_add(text, "\\u%04x", *c);
    else
      text_add(text, "%c", *c);
  }
  text_add(text, "\"");
}

void text_add_visible(Text *text, const char *words)
{
  size_t left = strlen(words);
  while (left) {
    const unsigned char *c = (const unsigned char *)words;
    size_t plain = 0;
    const size_t right = text_utf8(words, left);
    while (plain < right && c[plain] >= 0x20 && c[plain] != 0x7f && !(c[plain] == 0xc2 && c[plain + 1] < 0xa0)) ++plain;
    text_add(text, "%.*s", (int)plain, words);
    if (plain == left) return;
    if (c[plain] == '\n' || c[plain] == '\t')
      text_add(text, "\\%c", c[plain] == '\n' ? 'n' : 't');
    else
      text_add(text, "\\x%02x", c[plain]);
    words += plain + 1;
    left -= plain + 1;
  }
}

void text_add_warning(Text *warnings, const char *format, ...)
{
  Text words = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&words, format, arguments);
  va_end(arguments);
  text_add(warnings, "%swarning: ", warnings->length ? "\n" : "");
  text_add_visible(warnings, text_words(&words));
  warnings->failed |= words.failed;
  text_free(&words);
}

const char *text_words(const Text *text)
{
  return text->characters ? text->characters : "";
}

char *text_take(Text *text)
{
  char *taken = text->characters;
  if (text->failed) {
    free(taken);
    taken = NULL;
  }
  *text = (Text){0};
  return taken;
}

void text_free(Text *text)
{
  free(text->characters);
  *text = (Text){0};
}

char *text_format(const char *format, ...)
{
  Text text = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&text, format, arguments);
  va_end(arguments);
  return text_take(&text);
}

/** Letters without their case, and all signs that part words as a blank. */
static int folded(char c)
{
  return c == '_' || c == '-' ? ' ' : tolower((unsigned char)c);
}

int text_distance(const char *a, const char *b)
{
  enum { LONGEST = 64 };
  size_t na = strlen(a), nb = strlen(b);
  if (na >= LONGEST || nb >= LONGEST) return LONGEST;
  int rows[3][LONGEST + 1]; /* of the last two letters of `a` and this one */
  for (size_t j = 0; j <= nb; ++j) rows[0][j] = (int)j;
  for (size_t i = 1; i <= na; ++i) {
    int *row = rows[i % 3], *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
    row[0] = (int)i;
    for (size_t j = 1; j <= nb; ++j) {
      const int other = (above[j] < row[j - 1] ? above[j] : row[j - 1]) + 1;
      row[j] = above[j - 1] + (folded(a[i - 1]) != folded(b[j - 1]));
      if (other < row[j]) row[j] = other;
      const bool swapped =
          i > 1 && j > 1 && folded(a[i - 1]) == folded(b[j - 2]) && folded(a[i - 2]) == folded(b[j - 1]);
      if (swapped && two_above[j - 2] + 1 < row[j]) row[j] = two_above[j - 2] + 1;
    }
  }
  return rows[na % 3][nb];
}

bool text_resembles(const char *word, const char *candidate, int distance)
{
  size_t longer = strlen(word) > strlen(candidate) ? strlen(word) : strlen(candidate);
  return distance < (int)longer && distance <= (longer < 6 ? 1 : (int)longer / 3);
}

void text_file_name(const char *words, char *name, size_t size)
{
  size_t n = 0;
  for (; *words && n + 1 < size; ++words) {
    unsigned char c = (unsigned char)*words;
    name[n] = (char)(isalnum(c) || c == '-' || (c == '.' && n) ? c : '-');
    ++n;
  }
  if (!n && size > 1) name[n++] = '-';
  name[n] = 0;
}

size_t text_utf8(const char *text, size_t length)
{
  const unsigned char *bytes = (const unsigned char *)text;
  size_t k = 0;
  while (k < length) {
    const unsigned first = bytes[k];
    const size_t more = first < 0x80   ? 0
                        : first < 0xc2 ? 4
                        : first < 0xe0 ? 1
                        : first < 0xf0 ? 2
                        : first < 0xf5 ? 3
                                       : 4;
    if (more > 3 || more >= length - k) return k;
    /* the second byte tells what is longer than it need be, half of a pair of UTF-16, or behind the last character */
    const unsigned least = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned most = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (more && (bytes[k + 1] < least || bytes[k + 1] > most)) return k;
    for (size_t n = 2; n <= more; ++n)
      if ((bytes[k + n] & 0xc0) != 0x80) return k;
    k += more + 1;
  }
  return length;
}

char *text_beside(const char *path, const char *file)
{
  const char *slash = path ? strrchr(path, '/') : NULL;
  if (*file == '/' || !slash) return text_format("%s", file);
  return text_format("%.*s/%s", (int)(slash - path), path, file);
}

int text_open_file(const char *path)
{
  const int number = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a pipe without a writer would wait for one */
  struct stat status;
  if (number < 0) return -1;
  const int bad = fstat(number, &status)    ? errno
                  : S_ISDIR(status.st_mode) ? EISDIR
                  : S_ISREG(status.st_mode) ? 0
                                            : ESPIPE;
  if (!bad) return number;
  close(number);
  errno = bad;
  return -1;
}

/** Opens a file that is small enough to be read whole. @return NULL, with the reason in errno */
static FILE *open_whole(const char *path)
{
  const int number = text_open_file(path);
  struct stat status;
  if (number < 0) return NULL;
  int bad = fstat(number, &status) ? errno : status.st_size > largest ? EFBIG : 0;
  FILE *file = bad ? NULL : fdopen(number, "rb");
  if (file) return file;
  if (!bad) bad = errno;
  close(number);
  errno = bad;
  return NULL;
}

const char *text_why_unread(int number)
{
  if (number == ESPIPE) return "it is a pipe or a device; expected a file";
  if (number == EFBIG) return "it is larger than 4 GB";
  if (number == EILSEQ) return "it is not text: it holds a zero byte";
  return strerror(number);
}

char *text_read_file(const char *path, size_t *length)
{
  FILE *file = open_whole(path);
  if (!file) return NULL;
  size_t capacity = 1 << 16, n = 0;
  char *content = memory_plain(capacity, 1);
  while (content) {
    n += fread(content + n, 1, capacity - 1 - n, file);
    if (n < capacity - 1) break;
    char *grown = memory_grown(content, capacity *= 2, 1);
    if (!grown) free(content);
    content = grown;
  }
  if (content && ferror(file)) {
    free(content);
    content = NULL;
  }
  fclose(file);
  if (content && !length &&
      memchr(content, 0, n)) { /* what stands behind it would be lost on whoever takes it as words */
    free(content);
    content = NULL;
    errno = EILSEQ;
  }
  if (content) content[n] = 0;
  if (length) *length = n;
  return content;
}
