#include "base/error.h"

#include "base/text.h"
#include <stdarg.h>
#include <stdlib.h>

struct breccia_error {
  Text text;
  int count;
};

breccia_error *breccia_error_create(void)
{
  return calloc(1, sizeof(breccia_error));
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
  return error && error->text.characters ? error->text.characters : "";
}

int error_add(Error *error, int status, const char *format, ...)
{
  if (!error) return status;
  if (error->count++) text_add(&error->text, "\n");
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&error->text, format, arguments);
  va_end(arguments);
  return status;
}

int error_count(const Error *error)
{
  return error ? error->count : 0;
}

void error_clear(Error *error)
{
  if (!error) return;
  text_free(&error->text);
  error->count = 0;
}
