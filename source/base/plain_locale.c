#include "base/plain_locale.h"

#include <pthread.h>

static locale_t plain; /* a constant, as soon as it is there */

static void make(void)
{
  plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

locale_t locale_plain(void)
{
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, make);
  return plain ? uselocale(plain) : (locale_t)0;
}

void locale_return(locale_t before)
{
  if (before) uselocale(before);
}
