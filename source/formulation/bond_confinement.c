/* Confining pressure of bonds in plane bodies: the smaller of the two principal pressures in the plane, 0 under
 * tension. Laws with a `confined_history` crush at a larger stress under this pressure. After each step the formulation
 * stores the pressure in the committed histories of bonds, as the mean over both ends, so that the forces of the next
 * step depend on displacements and committed histories only. The pressure of a particle is that of the virial stress of
 * its family. Families whose elastic stress is below 0.4 f_c have none: bonds are linear there. */
#include "base/memory.h"
#include "base/team.h"
#include "base/tensor.h"
#include "constitutive/min_max.h"
#include "formulation/bond_based.h"

#include <string.h>

/* Elastic stress, over the compressive strength, from which pressures are found. */
static const double confinement_begin = 0.4;

/** Returns the smaller principal value in the plane of a symmetric tensor, or the larger one. */
static double confinement_principal(const double s[6], bool larger)
{
  const double mean = (s[XX] + s[YY]) / 2, radius = hypot((s[XX] - s[YY]) / 2, s[XY]);
  return larger ? mean + radius : mean - radius;
}

int bond_confinement_create(BondBased *b, Error *error)
{
  bool read = false;
  for (int64_t slice = 0; slice < b->particles->slices; ++slice)
    read |= material_confined_history(&b->materials[b->material[slice]]) > 0;
  if (!read || !b->around || b->body->dimensions != 2) return BRECCIA_OK;
  b->confining =
      memory_zeroed((size_t)(2 * b->particles->places), sizeof(double), "confining pressures of bonds", error);
  return b->confining ? BRECCIA_OK : BRECCIA_FAILURE;
}

size_t bond_confinement_bytes(const BondBased *b)
{
  return b->confining ? 2 * sizeof(double) * (size_t)b->particles->places : 0;
}

void bond_confinement_state(void *formulation, const char *part, StateList *list)
{
  BondBased *b = formulation;
  if (!b->confining) return;
  state_add(list,
            &(StateRow){.unit = "stress",
                        .kind = STATE_NUMBERS,
                        .entity = STATE_OF_PLACE,
                        .role = STATE_COMMITTED,
                        .count = b->particles->places,
                        .values = b->confining},
            "confining pressure", part);
}

/** Finds the pressures of the places of a SIMD block. */
static void confinement_find(void *context, int64_t slice)
{
  const BondBased *b = context;
  const Material *m = &b->materials[b->material[slice]];
  double *next = b->confining + b->particles->places;
  const double least = confinement_begin * material_compressive_strength(m) / material_young(m);
  const bool read = material_confined_history(m) > 0 && !is_foreign(b->foreign, slice * SLICE);
  for (int64_t place = slice * SLICE; place < (slice + 1) * SLICE; ++place) {
    next[place] = 0;
    if (!read || b->particles->number[place] < 0) continue;
    if (confinement_principal(bond_family_strain(b, place), false) > -least) continue;
    double stress[6];
    bond_stress(b, place, stress);
    next[place] = fmax(0, -confinement_principal(stress, true));
  }
}

/** Stores the pressure of a bond in the history of a row, if the law of the row reads it. */
static void confinement_store(const BondBased *b, int64_t row, double pressure)
{
  const int k = material_confined_history(points_material(b->points, row));
  if (k > 0) points_note(b->points, row, k - 1, pressure);
}

/** Stores the pressures of the bonds of a SIMD block whose ends have a pressure or had one. */
static void confinement_hand_on(void *context, int64_t slice)
{
  const BondBased *b = context;
  const Family *f = b->family;
  const double *was = b->confining, *now = was + b->particles->places;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t place = slice * SLICE + lane;
      if (!(was[place] > 0 || now[place] > 0) || !(f->intact[slot] >> lane & 1)) continue;
      const int64_t other = family_bond(f, slice, slot, lane).neighbour;
      if (is_foreign(b->foreign, other) || (other < place && (was[other] > 0 || now[other] > 0))) continue;
      const bool both = material_confined_history(&b->materials[b->material[other / SLICE]]) > 0;
      int64_t rows[2];
      bond_list_rows(b->bonds, f, slice, slot, lane, rows);
      const double pressure = both ? (now[place] + now[other]) / 2 : now[place];
      confinement_store(b, rows[0], pressure);
      if (rows[1] != rows[0]) confinement_store(b, rows[1], pressure);
    }
}

void bond_confinement_commit(void *formulation, bool well)
{
  BondBased *b = formulation;
  if (!well || !b->confining) return;
  const size_t places = (size_t)b->particles->places;
  team_each(b->particles->slices, confinement_find, b);
  team_each(b->particles->slices, confinement_hand_on, b);
  memcpy(b->confining, b->confining + places, sizeof(double) * places);
}
