/* Bodies of links, for tests of what damages them. */
#ifndef BRECCIA_TESTS_LINK_BODIES_H
#define BRECCIA_TESTS_LINK_BODIES_H

#include "formulation/micropolar.h"

#include "base/random.h"
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"

static inline const Micropolar *formulation_of(const breccia_model *model)
{
  return model->domain.regions[0].formulation;
}

/** A block of links. @param[in] law  its keys */
static inline breccia_model *block(const char *law, const char *lattice, const char *particles, const char *space)
{
  breccia_model *model =
      model_of(UNITS "materials: {m: {model: link-damage, density: 2, Young modulus: 1e7, Poisson ratio: 0.2, %s}}\n"
                     "body: {b: {material: m, lattice: %s, spacing: 0.1, %s shape: {box: {particles: %s}}}}\n"
                     "peridynamics: {formulation: micropolar, space: %s}\nsolve: {explicit: {steps: 1}}\n",
               law, lattice, *space == 'p' ? "thickness: 0.3," : "", particles, space);
  model->threads = 1; /* of bodies so small more only wait */
  return model;
}

/** Displacements and rotations at random. */
static inline void disturb(const breccia_model *model, double size, uint64_t seed)
{
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < p->space.rows; ++k)
      if (k >= p->space.rotation || k < model->domain.body.dimensions)
        p->displacement.row[k][p->place_of[n]] =
            2 * (random_uniform(&seed) - 0.5) * size * (k < p->space.rotation ? 0.1 : 1);
}

#endif
