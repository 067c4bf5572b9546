/* How the links of each block are damaged, and the room for it. A law may leave open at which stretch links carry nothing any more, and say what a crack takes
 * per area instead (docs/theory.md 6.5): a link whose force falls linearly from S_t to that stretch S_e spends EA L S_t S_e / 2 along itself, and across itself
 * 12 EI / (EA L^2) tan^2 of that where the faces of a crack move apart along the normal n, at the angle between n and the link. A plane crosses |xi . n| / V links of
 * each pattern per area. Cracks follow the planes that cost least, and these are to cost the fracture energy. */
#include "formulation/micropolar.h"

#include "base/memory.h"
#include "constitutive/link_damage.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/** Sum over links of a block of axial L |xi . n| (1 + 12 EI / (EA L^2) tan^2), axial being their force per volume and stretch. */
static double crossing(const Micropolar *m, int block, const double n[3])
{
  double sum = 0;
  for (int k = m->family->pattern_begin[block]; k < m->family->pattern_begin[block + 1]; ++k) {
    const LinkRow *row = &m->rows[k];
    const double length = m->family->patterns[k].length, cosine = fabs(vector_dot(row->n, n));
    if (cosine < 1e-6 || !(row->axial > 0)) continue; /* the link lies in the plane, or its influence is 0 */
    const double tangent = (1 - cosine * cosine) / (cosine * cosine);
    sum += row->axial * length * length * cosine * (1 + 12 * row->bending / (row->axial * length) * tangent);
  }
  return sum;
}

/** The least over all planes that hold directions of links: between them it is larger. */
static double least_crossing(const Micropolar *m, int block)
{
  const int first = m->family->pattern_begin[block], last = m->family->pattern_begin[block + 1];
  double least = INFINITY;
  for (int i = first; i < last; ++i)
    for (int j = i; j < last; ++j) {
      static const double across[3] = {0, 0, 1};
      const double *other = m->body->dimensions == 3 ? m->rows[j].n : across;
      double n[3];
      vector_cross(m->rows[i].n, other, n);
      const double size = sqrt(vector_dot(n, n));
      if (size < 1e-6) continue;
      for (int k = 0; k < 3; ++k) n[k] /= size;
      least = fmin(least, crossing(m, block, n));
      if (m->body->dimensions == 2) break;
    }
  return least;
}

/** The mean over all planes of scattered particles, of the families by which links are calibrated; what links spend
 *  across themselves is left out. */
static double mean_crossing(const Micropolar *m, int block)
{
  return m->constants[block].crossed * (m->body->dimensions == 3 ? 0.5 : 2 / acos(-1));
}

/** Returns the length over which a plane crack spreads a fracture energy, treating links as points with this law. */
double micropolar_crack_length(const void *formulation, int block, const double normal[3])
{
  const Micropolar *m = formulation;
  if (!m->damage || !m->body->lattices[block].chunks || block_is_foreign(m->foreign, m->particles, block)) return NAN;
  return crossing(m, block, normal) / (2 * material_young(micropolar_material(m, block)));
}

int micropolar_find_damage_law(const Micropolar *m, int block, breccia_link *link, Error *error)
{
  if (isnan(link->fracture_energy)) return BRECCIA_OK;
  const bool lattice = m->body->lattices[block].chunks != 0;
  const double sum = lattice ? least_crossing(m, block) : mean_crossing(m, block);
  link_find_ends(link, 4 * link->fracture_energy / (link->tension_begin * sum));
  const bool bends = link->tension_first_end > 0;
  const double first_end = bends ? link->tension_first_end : link->tension_end;
  if (first_end > link->tension_begin) return BRECCIA_OK;
  char advice[80] = "take finer particles";
  if (lattice)
    snprintf(advice, sizeof advice, "take a spacing %.3g times smaller or less",
             1.001 * link->tension_begin / first_end);
  return error_add(error, BRECCIA_USER_ERROR,
                   "block '%s': its links store more up to the tensile stretch of %g than the %sfracture energy of "
                   "material '%s' lets a crack take; %s, or give more %sfracture energy",
                   m->body->blocks[block]->head.name, link->tension_begin, bends ? "initial " : "",
                   micropolar_material(m, block)->name, advice, bends ? "initial " : "");
}

static int find_laws(Micropolar *m, Error *error)
{
  LinkDamage *damage = m->damage;
  double longer = INFINITY, shorter = INFINITY;
  char reason[200];
  for (int block = 0; block < m->body->block_count; ++block) {
    const Material *material = micropolar_material(m, block);
    breccia_link *link = &damage->laws[block];
    *link = (breccia_link){.tension_begin = INFINITY,
                           .tension_end = INFINITY,
                           .fracture_energy = NAN,
                           .compression_begin = INFINITY,
                           .compression_end = INFINITY,
                           .recovery = 1};
    if (block_is_foreign(m->foreign, m->particles, block) || !material->law->link) continue;
    if (material->law->link(material->constants, link, reason, sizeof reason))
      return error_add(error, BRECCIA_USER_ERROR, "material '%s': micropolar: %s", material->name, reason);
    if (micropolar_find_damage_law(m, block, link, error)) return BRECCIA_USER_ERROR;
    longer = fmin(longer, link->tension_begin);
    shorter = fmin(shorter, link->compression_begin);
  }
  /* a little within the limits, whose last bits other formulas may round otherwise */
  damage->longer = (1 - 1e-9) * longer * (2 + longer);
  damage->shorter = shorter < 1 ? (1 - 1e-9) * -shorter * (2 - shorter) : -1;
  return BRECCIA_OK;
}

int micropolar_damage_create(Micropolar *m, Error *error)
{
  bool any = false;
  for (int block = 0; block < m->body->block_count; ++block)
    any |= !block_is_foreign(m->foreign, m->particles, block) && micropolar_material(m, block)->law->link != NULL;
  if (!any) return BRECCIA_OK;
  LinkDamage *damage = m->damage = memory_zeroed(1, sizeof *damage, "damage of links", error);
  if (!damage) return BRECCIA_FAILURE;
  damage->sweeps = micropolar_damage_chosen();
  const size_t links = (size_t)m->family->slots * SLICE;
  int failed =
      !(damage->laws = memory_zeroed((size_t)m->body->block_count, sizeof *damage->laws, "damage of links", error));
  failed |= !(damage->touched = memory_zeroed((size_t)m->particles->slices, 1, "damage of links", error));
  failed |= !(damage->grown = memory_zeroed((size_t)m->particles->slices, 1, "damage of links", error));
  failed |= !(damage->damaged = places_array(m->particles->places, "damage of links", error));
  for (int k = 0; k < 2; ++k) {
    failed |= !(damage->tension[k] = memory_zeroed(links, sizeof(double), "damage of links", error));
    failed |= !(damage->compression[k] = memory_zeroed(links, sizeof(double), "damage of links", error));
  }
  return failed ? BRECCIA_FAILURE : find_laws(m, error);
}

void micropolar_damage_destroy(Micropolar *m)
{
  LinkDamage *damage = m->damage;
  if (!damage) return;
  for (int k = 0; k < 2; ++k) {
    free(damage->tension[k]);
    free(damage->compression[k]);
  }
  places_free(&damage->damaged);
  free(damage->touched);
  free(damage->grown);
  free(damage->laws);
  free(damage);
}
