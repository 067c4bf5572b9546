/* A growing piece of text, and the few things done with words: nearest spelling, file names, JSON quoting. */
#ifndef BRECCIA_BASE_TEXT_H
#define BRECCIA_BASE_TEXT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct Text {
  char *characters; /* ends in a zero byte once something was added; owned */
  size_t length, capacity;
  bool failed; /* memory was out: something is missing, and nothing is appended any more */
} Text;

/** Appends formatted text. When memory is out the text has failed, and stays as it is from then on. */
void text_add(Text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_add_list(Text *text, const char *format, va_list arguments);

/** Appends `words` so that they stay in their line and leave a terminal as it is: control characters and bytes that are no UTF-8 as \n, \t, \xNN. */
void text_add_visible(Text *text, const char *words);

/** Appends a line that begins with "warning: ", whose words stay in it as by text_add_visible. */
void text_add_warning(Text *warnings, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** Appends `words` as a JSON string, quotes included. */
void text_add_json(Text *text, const char *words);

/** @return what was added so far, "" if nothing was. Whoever keeps or shows it looks at `failed` */
const char *text_words(const Text *text);

/** Gives the characters away, to be freed. @return NULL if the text has failed, or nothing was added */
char *text_take(Text *text);

void text_free(Text *text);

/** @return a copy of formatted text that the caller frees, or NULL when memory is out */
char *text_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** @return the edit distance (insertions, deletions, substitutions, neighbours swapped) between two words, at most 64. Case does not
 *  count, nor does it matter whether words are parted by blanks, - or _. */
int text_distance(const char *a, const char *b);

/** @return true if `candidate` is close enough to `word` to be suggested for it */
bool text_resembles(const char *word, const char *candidate, int distance);

/** Copies `words` into `name` (size bytes) with everything but letters, digits, - and . replaced by -; so is a . at the
 *  beginning, behind which shells and browsers of files would hide the file. Words without a letter give -. */
void text_file_name(const char *words, char *name, size_t size);

/** @return how many bytes from the beginning are UTF-8 text (RFC 3629, section 4): `length` if all are */
size_t text_utf8(const char *text, size_t length);

/** Path of a file whose name, unless it begins at the root, is relative to the folder of another. To be freed. */
char *text_beside(const char *path, const char *file);

/** Opens a file for reading, but no pipe, device or folder: those may never end. @return -1, with the reason in errno */
int text_open_file(const char *path);

/** Reads a whole file, no pipe or device; as words, without a zero byte, where no `length` is asked for. @return it, to be freed; NULL with errno */
char *text_read_file(const char *path, size_t *length);

/** Why text_read_file has read nothing. @param[in] number  what it left in errno */
const char *text_why_unread(int number);

#endif
