/* Arithmetic in decks: what stands between ${ and }. */
#ifndef BRECCIA_DECK_EXPRESSION_H
#define BRECCIA_DECK_EXPRESSION_H

#include "deck/measure.h"

typedef struct Names { /* what an expression may name */
  /** Finds a variable's value. @return 0; 1 with the reason if there is none or it is no number */
  int (*find)(void *context, const char *name, Measure *value, Text *reason);
  /** True if there is a variable of that name. */
  bool (*knows)(void *context, const char *name);
  void *context;
} Names;

/** Reckons an expression: numbers with or without units, variables, + - * / ^ ( ), and the functions of expression_functions.
 *  @param[out] at      of a mistake: where, in bytes from the beginning
 *  @param[out] reason  what is wrong, in words that can follow a place
 *  @return 0, or 1 */
int expression_read(const char *words, const Units *units, const Names *names, Measure *value, size_t *at,
                    Text *reason);

/** True if words are a name that a variable may have: a letter, then letters, digits and _. */
bool expression_is_name(const char *words, size_t length);
/** True if a name belongs to expressions themselves: a function, or pi. */
bool expression_is_taken(const char *name);

/** All functions in words, for messages and pages: "min max sqrt ...". */
void expression_functions(Text *words);

#endif
