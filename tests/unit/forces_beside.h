/* Forces beside those of bonds, in bodies whose particles stand anywhere. */
#ifndef BRECCIA_TESTS_FORCES_BESIDE_H
#define BRECCIA_TESTS_FORCES_BESIDE_H

#include "base/random.h"
#include "support.h"

/** Moves each particle by at most half of a length along each axis, always in the same way. */
static inline void shake(breccia_model *m, double by)
{
  Particles *p = m->domain.particles;
  uint64_t seed = 7;
  for (int k = 0; k < m->domain.body.dimensions; ++k)
    for (int64_t n = 0; n < p->count; ++n) p->displacement.row[k][p->place_of[n]] += by * (random_uniform(&seed) - 0.5);
}

/** @param[out] force  a vector, which `drop` gives back */
static inline void find_beside(breccia_model *m, Vector *force)
{
  assert_true(vector_create(force, &m->domain.particles->space, "test", NULL));
  domain_forces_beside(&m->domain, NULL, force);
}

static inline void drop(Vector *force)
{
  vector_destroy(force);
}

#endif
