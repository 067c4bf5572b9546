#include "base/folder.h"

#include "base/text.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/** Makes one folder in one that is there. */
static int make_one(const char *path, Error *error)
{
  struct stat found;
  if (!mkdir(path, 0777)) return BRECCIA_OK;
  const int cause = errno;
  if (cause == EEXIST && !stat(path, &found)) {
    if (S_ISDIR(found.st_mode)) return BRECCIA_OK;
    return error_add(error, BRECCIA_USER_ERROR, "%s: it is a file; expected a folder, or a name that is not there yet",
                     path);
  }
  const bool machine = cause == ENOSPC || cause == EDQUOT || cause == EIO || cause == ENOMEM || cause == EMLINK;
  return error_add(error, machine ? BRECCIA_FAILURE : BRECCIA_USER_ERROR, "%s: the folder cannot be made: %s", path,
                   cause == EEXIST ? "it is a link that leads nowhere" : strerror(cause));
}

int folder_make_inside(const char *path, Error *error)
{
  struct stat found;
  if (!lstat(path, &found) && S_ISLNK(found.st_mode))
    return error_add(error, BRECCIA_USER_ERROR, "%s: the folder cannot be made: it is a link; remove it", path);
  return folder_make(path, error);
}

int folder_make(const char *path, Error *error)
{
  char *part = text_format("%s", path);
  if (!part) return error_add(error, BRECCIA_FAILURE, "out of memory: folder");
  int status = BRECCIA_OK;
  for (char *slash = strchr(part + (*part != 0), '/'); slash && !status; slash = strchr(slash + 1, '/')) {
    *slash = 0;
    status = make_one(part, error);
    *slash = '/';
  }
  if (!status) status = make_one(part, error);
  free(part);
  return status;
}
