/* Numbers are read and written with a point, whatever the country of the user. */
#ifndef BRECCIA_BASE_PLAIN_LOCALE_H
#define BRECCIA_BASE_PLAIN_LOCALE_H

#include <locale.h>

/** Gives this thread the locale "C". @return the one that it had, for `locale_return` */
locale_t locale_plain(void);
void locale_return(locale_t before);

#endif
