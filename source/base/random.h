/* Seeded randomness: the same numbers on every machine (splitmix64). */
#ifndef BRECCIA_BASE_RANDOM_H
#define BRECCIA_BASE_RANDOM_H

#include <stdint.h>

/** @return a number in [0, 1); advances the state */
static inline double random_uniform(uint64_t *state)
{
  uint64_t z = (*state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

#endif
