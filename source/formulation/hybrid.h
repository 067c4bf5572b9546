/* What the parts of hybrid peridynamics share: the table entry and sweeps (hybrid.c), the geometry of bonds (hybrid_geometry.c), single bonds,
 * places and their energies (hybrid_bonds.c).
 *
 * Every bond has a material point in space at its middle. Its strain follows from the particles that both of its ends see, S = (H_A + A) and (H_B + B):
 *   G = sum over C in S of u_C (x) g_C,
 * a least-squares fit over S that is made exact along the bond, so that G xi = eta and no pattern of short waves goes unseen (docs/theory.md 5).
 * Points are the rows of the region's bond list; a bond of two materials has two rows, each for half of its volume. */
#ifndef BRECCIA_FORMULATION_HYBRID_H
#define BRECCIA_FORMULATION_HYBRID_H

#include "formulation/formulation.h"

enum { HYBRID_FORCE = 3 * LANES };

/** A point of which a place is a member. */
typedef struct HybridMeeting {
  int32_t row;
  int32_t member; /* its number among the members of the row */
} HybridMeeting;

typedef struct Hybrid {
  const Particles *particles;
  const Family *family;
  const Body *body;
  const Points *points;
  const BondList *bonds;
  const Material *materials;
  Space space;
  bool finite;
  bool pairwise; /* the stress of a point acts on the two ends of its bond only */
  double own;    /* share of the correction by the bond itself, beta; 1: G xi = eta */
  int dimensions;
  int64_t *first;     /* [rows + 1] of the members of a row */
  int32_t *member;    /* places: of each row the owner of its bond, the other end, then those that both see */
  double (*g)[3];     /* [members] 0 of those that a broken bond hides */
  double (*area)[3];  /* [rows] of the section of the bond, from the owner to the other end */
  double *volume;     /* [rows] for which the point stands; 0: there is no bond */
  uint8_t *idle;      /* [rows] 1: it carries nothing: no bond, a broken one, or its members span no space any more */
  int64_t *met_first; /* [places + 1] */
  HybridMeeting *met; /* of each place, in the order of rows */
  /** [rows][HYBRID_FORCE] F S times the volume, column by column; pairwise the force on the owner alone. What bonds read of one another lies together:
   *  in arrays of one component each most of the time was waiting for them. */
  double *force;
  double *shown;      /* [places][LANES] displacements, for the same reason */
  double (*tried)[3]; /* [most members of a row] for geometries that are tried out, by one thread */
  int32_t hidden[2];  /* two places whose bond counts as broken meanwhile; -1: none */
} Hybrid;

/** Members, vectors, areas and volumes of all bonds, as the body begins. Refuses bodies whose bonds see too few particles. */
int hybrid_measure(Hybrid *hybrid, Error *error);
/** Vectors g of the members of a row by the bonds that are intact now. @param[out] g  [members]
 *  @return false: there is none, and the point carries nothing */
bool hybrid_weigh(const Hybrid *hybrid, int64_t row, double (*g)[3]);
/** Bonds of a slice have broken or were mended. */
void hybrid_renew(void *formulation, int64_t slice);
/** Component (k, j) of F S times the volume of a row; of pairwise bonds component k of the force with j = 0. */
static inline double hybrid_force(const Hybrid *h, int64_t row, int k, int j)
{
  return h->force[HYBRID_FORCE * row + LANES * j + k];
}
/** Number of places that a row has as members. */
static inline int hybrid_members(const Hybrid *h, int64_t row)
{
  return (int)(h->first[row + 1] - h->first[row]);
}

/** G of a row at displacements u, row by row, by vectors of its members. */
void hybrid_gradient(const Hybrid *hybrid, int64_t row, const double (*g)[3], double *const u[3], double gradient[9]);
/** The strain that follows from it, with engineering shear. */
void hybrid_strain(const Hybrid *hybrid, const double gradient[9], double strain[6]);

/** As FormulationType describes it: whether the members of a bond's points still span space. */
bool hybrid_can_carry(const void *formulation, int64_t slice, int64_t slot, int lane);

/** As FormulationType describes them (hybrid_bonds.c). */
void hybrid_half_state(const void *formulation, double *const *at, int64_t slice, int64_t slot, int lane,
                       double state[3]);
int64_t hybrid_point_count(const void *formulation);
int hybrid_point(const void *formulation, int64_t number, Operator *point, Error *error);
void hybrid_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy);
void hybrid_bond_energy(const void *formulation, int64_t slice, int64_t slot, int lane, double time,
                        StoredEnergy *energy);
void hybrid_elongation(const void *formulation, int64_t slice, int64_t slot, int lane, double change[3]);
void hybrid_section_stress(const void *formulation, int64_t slice, int64_t slot, int lane, double *tension,
                           double *shear);
void hybrid_place_gradient(const void *formulation, int64_t place, double f[9]);
void hybrid_stress(const void *formulation, int64_t place, double stress[6]);
double hybrid_characteristic_length(const BondLength *of);

#endif
