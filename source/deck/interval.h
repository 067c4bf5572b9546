/* Admissible ranges of parameters, written as "(0, inf)" or "[0, 1)". */
#ifndef BRECCIA_DECK_INTERVAL_H
#define BRECCIA_DECK_INTERVAL_H

#include <stdbool.h>
#include <stddef.h>

/** True if `value` lies in an interval like "(0, inf)" or "[0, 1)"; NULL holds everything. */
bool interval_contains(const char *interval, double value);
/** Returns true if an interval is written as interval_contains reads it, with ends in order. */
bool interval_is_valid(const char *interval);
/** "greater than 0", "at least 0 and less than 1", ... */
void interval_describe(const char *interval, char *words, size_t size);

#endif
