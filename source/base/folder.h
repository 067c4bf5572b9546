/* Folders that files are written into. */
#ifndef BRECCIA_BASE_FOLDER_H
#define BRECCIA_BASE_FOLDER_H

#include "base/error.h"

/** Makes a folder and those above it that are missing; one that is there is good.
 *  @return BRECCIA_USER_ERROR where the path cannot be one; BRECCIA_FAILURE where the disk or the machine cannot make it */
int folder_make(const char *path, Error *error);
/** Makes a folder inside of a results folder. A link of that name is refused: the run writes nothing outside of its
 * folder. */
int folder_make_inside(const char *path, Error *error);

#endif
