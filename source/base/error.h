/* What went wrong, in words for the person at the keyboard.
 * Library code adds one line per problem and returns the status; it never prints and never exits. */
#ifndef BRECCIA_BASE_ERROR_H
#define BRECCIA_BASE_ERROR_H

#include "breccia/breccia.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct breccia_error Error;

/** Adds one line to the error (NULL: the line is dropped; a line that stands there already is not said twice;
 *  of very many the first are kept). What would begin another line or move a terminal's cursor, in names of files say, becomes \n, \xNN.
 *  @return `status`, so that a caller can write `return error_add(error, BRECCIA_USER_ERROR, "...")` */
int error_add(Error *error, int status, const char *format, ...) __attribute__((format(printf, 3, 4)));

/** Adds all lines of another error. @return `status` */
int error_add_all(Error *error, int status, const Error *other);

/** Leaves of all lines the first that says that memory was out, or says so itself: what else was found may be only for the lack of it.
 *  @return BRECCIA_FAILURE */
int error_out_of_memory(Error *error);

/** @return how many lines were added so far, those that stood there already too: whether something went wrong since tells their difference */
int error_count(const Error *error);

/** Whether further lines are only counted: more are no help, the first are to be mended first. */
bool error_is_full(const Error *error);

#endif
