/* Which name was meant: for messages about words that a deck does not know. */
#ifndef BRECCIA_DECK_SPELLING_H
#define BRECCIA_DECK_SPELLING_H

#include "base/text.h"

/** The name that was probably meant: one that goes by this other word in engineers' notes or other programs ("E", "nu"), one
 *  that begins with it ("ramp" of "ramp to"), or the one spelt most alike.
 *  @return one of `names`, or NULL if none is near */
const char *spelling_nearest(const char *given, const char *const *names, int count);

/** True if `name` goes by the word `given` elsewhere, or begins with it. */
bool spelling_same(const char *given, const char *name);

/** A remark about what a word is called here, in brackets, to stand after the question; "" if there is nothing to say. */
const char *spelling_remark(const char *given, const char *name);

/** Adds "did you mean 'a'?" or, where no name is near, "WHAT are a, b, c". */
void spelling_advice(Text *text, const char *given, const char *const *names, int count, const char *what);

#endif
