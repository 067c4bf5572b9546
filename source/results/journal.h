/* Files that are written over in place, without a moment in which their old bytes are lost and the new ones are not there.
 *
 * Bytes behind the old end go into the file at once, where nobody looks for them yet. What is written over old bytes stays in memory, page by
 * page. To commit, the file is brought to the disk, then these pages in a journal beside it, <file>.journal; only then are they put into the
 * file, and the journal is removed. Whoever is killed before the journal has its name leaves the file as it was; afterwards journal_finish
 * puts the pages in. (The redo journal of databases.) */
#ifndef BRECCIA_RESULTS_JOURNAL_H
#define BRECCIA_RESULTS_JOURNAL_H

#include "base/error.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct Journal Journal;

/** @param[in] path  of the file that is written, which need not stay
 *  @param[in] kept  its first bytes, those to be kept until journal_commit
 *  @return to be ended by journal_destroy; NULL: out of memory */
Journal *journal_create(const char *path, int64_t kept);
/** Keeps fewer bytes: those behind are found to be rests of a write that was broken off. */
void journal_keep(Journal *journal, int64_t kept);
/** How many of `size` bytes at `from` are to be given to journal_write, the others being free. */
size_t journal_share(const Journal *journal, int64_t from, size_t size);
/** Takes what is written over old bytes. @return 0, or errno */
int journal_write(Journal *journal, int descriptor, int64_t from, size_t size, const void *bytes);
/** Puts what was written over old bytes into what was read of the file. */
void journal_overlay(const Journal *journal, int64_t from, size_t size, void *bytes);
/** Makes all that was written part of the file, which then ends at `end`.
 *  @return 0, or errno: the file is as it was, or a journal is left from which it can be made what it was to be */
int journal_commit(Journal *journal, int descriptor, int64_t end);
/** Gives up what was written. */
void journal_drop(Journal *journal, int descriptor);
void journal_destroy(Journal **journal);

/** Finishes what a killed process had begun to put into a file, if there is such a rest. Nobody else may write the file meanwhile.
 *  @return BRECCIA_OK, also where there is nothing to do; BRECCIA_FAILURE; BRECCIA_USER_ERROR where the journal is damaged or of another file */
int journal_finish(const char *path, Error *error);
/** Whether a journal lies beside a file. */
bool journal_is_there(const char *path);
/** Removes the journal of a file that is given up, whole or half written. @return 0, or errno */
int journal_forget(const char *path);

#endif
