/* What the parts of bond-based peridynamics share: the table entry (bond_based.c), constants (bond_constants.c), sweeps over linear bonds
 * (bond_springs_sweep.c, what they read bond_springs.c) and over bonds with points (bond_points_sweep.c, bond_points.c), surfaces
 * (bond_surface.c) and interfaces (bond_interfaces.c). */
#ifndef BRECCIA_FORMULATION_BOND_BASED_H
#define BRECCIA_FORMULATION_BOND_BASED_H

#include "base/lane_kinds.h"
#include "formulation/formulation.h"
#include "formulation/stretch.h"

/** How the constant of bonds follows from Young's modulus. */
typedef enum Calibration { CALIBRATION_CONTINUUM, CALIBRATION_EXPANSION, CALIBRATION_UNIAXIAL } Calibration;

/** Where the numbers of a pattern stand: its vector, and what its length and weight make of d (bond_springs.c). */
typedef struct SpringRow {
  int32_t xi[3], length;
} SpringRow;

/* What is read of a length in them; each stands there four times. */
enum { LENGTH_PULL = 0, LENGTH_LIMIT = STRETCH_TERMS * QUAD };

typedef struct BondBased BondBased;

/** Forces on the slices of a sweep from linear bonds (bond_springs_sweep.c). */
typedef void BondResist(const BondBased *b, const Sweep *sweep);
LANES_CHOICE(BondResist, bond_resist_springs)

/** Over bonds with points: stretches of a batch of rows, and forces on the slices of a sweep from pulls
 *  (bond_points_sweep.c). */
typedef struct BondPointSweeps {
  void (*stretch)(const BondBased *b, const Sweep *sweep);
  BondResist *resist;
} BondPointSweeps;
LANES_CHOICE(const BondPointSweeps, bond_point_sweeps)

struct BondBased {
  const Particles *particles;
  const Family *family;
  const Body *body;
  const Points *points;
  const BondList *bonds; /* NULL: bonds need no points */
  const Material *materials;
  const int32_t *material; /* [slices] */
  const uint8_t *foreign;  /* [slices], or NULL */
  Space space;
  const Influence *influence;
  bool may_break;         /* as in FormulationParts */
  bool surface_corrected; /* bonds at surfaces are stiffened (bond_surface.c) */
  bool in_series;         /* bonds through two linear materials have the stiffness of pieces in series */
  bool crosses_rows;      /* elastic interfaces cross rows of particles */
  bool strength_of_body;  /* tensile strengths of the deck are those of the body, not of bonds */
  double *
      stiffness; /* [blocks] c, 0 of foreign ones; a bond between two has the mean. Also in the records of stored slots */
  double *per_stress; /* [blocks] c / E */
  SpringRow *rows;    /* [patterns] */
  double *numbers;    /* of these rows */
  double *shown;      /* [places][8] what bonds of stored slots read of a neighbour; NULL if there are none */
  float *by_length;   /* of linear bonds in stored slots (stretch_lengths); NULL if there are none */
  /** [slices] factors on bonds by the surface correction and interfaces [slot from the slice's first one][8]; NULL: they
   *  are 1. */
  float **surface;
  float *surfaces; /* [surface_count] which lie here */
  size_t surface_count;
  double *pull;            /* [rows of bonds] of bonds with points (bond_points.c) */
  double *tension, *slope; /* [rows of bonds] of bonds with points, as of the last linearisation; NULL before */
  double *around; /* [places][12] strains of families (bond_lateral.c); NULL: no law reads the pressure across bonds */
  /** [2][places] confining pressures (bond_confinement.c): as stored in histories, and a work array; NULL: no law reads
   *  them. */
  double *confining;
  uint8_t *range; /* [slices] range of the stretches of the last evaluation */
  uint8_t *gaps;  /* [slices] 1: bonds are missing (stretch_has_gaps) */
  BondResist *resist_springs;
  const BondPointSweeps *point_sweeps;
};

/** Material of a block. */
const Material *bond_material(const BondBased *b, int block);

/** Finds out whether a slice has gaps. */
void bond_note_gaps(BondBased *b, int64_t slice);

/* Bonds of particles from a file are calibrated where families fill at least this share of the horizon: those of thin
 * bodies are all at surfaces. */
#define LEAST_FILLED 0.95

/** Finds the surface correction (bond_surface.c). */
int bond_correct_surface(BondBased *b, Error *error);

/** Multiplies the bonds near interfaces by their factors (bond_interfaces.c). */
int bond_correct_interfaces(BondBased *b, const FormulationParts *parts, Error *error);

/** Makes factors of 1 for the bonds of slices. Does nothing if there are factors.
 *  @param[in] only  [slices] slices with an entry get factors; NULL: all do */
int bond_make_factors(BondBased *b, float *const *only, Error *error);

/** Returns the factors of the bonds of a slice, or NULL if they are 1. */
LANES_INLINE const float *bond_factors(const BondBased *b, int64_t slice)
{
  return b->surface ? b->surface[slice] : NULL;
}

/** Factors of half a slot. @param[in] factors  of the slice */
LANES_INLINE Lanes bond_surface(const BondBased *b, const float *factors, int64_t slice, int64_t slot, int half)
{
  return lanes_widen(factors + (slot - b->family->first[slice]) * SLICE + LANES * half);
}

/** Returns the factor of a bond. */
static inline double bond_factor(const BondBased *b, int64_t slice, int64_t slot, int lane)
{
  const float *factors = bond_factors(b, slice);
  return factors ? (double)factors[(slot - b->family->first[slice]) * SLICE + lane] : 1;
}

/** Makes the tables of linear bonds. */
int bond_springs_create(BondBased *b, Error *error);

/* The last of the numbers that stored slots read of a neighbour is half of its c (of its c / E where bonds have points): a bond has the sum of both. */
enum { BOND_SHOWN = STRETCH_SHOWN };

/** Of bonds with points: stretches of a batch of rows, their pulls from stresses (bond_points.c). */
int64_t bond_stretch(void *formulation, const Sweep *sweep);
int64_t bond_pull_of_stress(void *formulation, const Sweep *sweep);

/** Elongation of bonds by the pressure across them (bond_lateral.c): creation of the work array, its update after bonds
 *  of a slice have broken, and the phase that finds the strains of families. Without laws that read the pressure the
 *  functions do nothing. */
int bond_lateral_create(BondBased *b, Error *error);
void bond_lateral_renew(const BondBased *b, int64_t slice);
size_t bond_lateral_bytes(const BondBased *b);
int64_t bond_lateral_strains(void *formulation, const Sweep *sweep);
/** Computes the elongation by pressure of the bonds of a batch of rows. @param[out] sweep  strain[1] */
void bond_lateral_rows(const BondBased *b, const Sweep *sweep);
/** Returns the elongation by pressure of a bond of a place; 0 if no law reads it. */
double bond_lateral(const BondBased *b, int64_t place, const Bond *bond);
/** Returns the elongation of a bond along a unit vector by the elastic stress across it at a strain; 0 if this stress
 *  is tensile. */
double bond_elongation_of_pressure(Space space, const double strain[6], const double n[3]);

/** Returns the strain of the family of a place in the last evaluation [6]; a law must read the pressure across bonds. */
const double *bond_family_strain(const BondBased *b, int64_t place);

/** Confining pressure of bonds (bond_confinement.c): creation of the work array, its place in the state, and its update
 *  after a step. Without laws that read the pressure the functions do nothing. */
int bond_confinement_create(BondBased *b, Error *error);
size_t bond_confinement_bytes(const BondBased *b);
void bond_confinement_state(void *formulation, const char *part, StateList *list);
void bond_confinement_commit(void *formulation, bool well);

/** FormulationType.stress (bond_based.c). */
void bond_stress(const void *formulation, int64_t place, double stress[6]);

/** Changes of forces in a linearised step, and bonds one by one (bond_linear.c). */
void bond_resist_changes(const BondBased *b, const Sweep *sweep);
int bond_linearise(void *formulation, double *const *displacement, Error *error);
int64_t bond_point_count(const void *formulation);
int bond_point(const void *formulation, double *const *displacement, int64_t number, Operator *point, Error *error);

/** Tension of a bond and its slope, per weight: c s and c, or c / E times what laws answer to its stretch (bond_linear.c).
 *  @param[in] u   rows of displacements
 *  @param[out] y  from the place to its neighbour, as deformed */
void bond_tension(const BondBased *b, double *const *u, int64_t slice, int64_t slot, int lane, const Bond *bond,
                  double y[3], double *tension, double *slope);

/** Change of the force of a bond in a linearised step, per volume and weight.
 *  @param[in] v   rows of the changes of displacements
 *  @param[in] at  rows of the displacements at which the step is linearised */
void bond_change(const BondBased *b, double *const *v, double *const *at, int64_t slice, int64_t slot, int lane,
                 const Bond *bond, double change[3]);

/** Returns the share of a bond that follows the material of its own SIMD block (material_share_of_bond); 0.5 if the
 *  other end belongs to another region. */
static inline double bond_share(const BondBased *b, int64_t slice, int64_t other)
{
  const int32_t own = b->material[slice], there = b->material[other];
  return own == there || is_foreign(b->foreign, other * SLICE)
             ? 0.5
             : material_share_of_bond(&b->materials[own], &b->materials[there]);
}

/** Share of the force of a bond that its own end gives: foreign ends give the other half themselves. */
static inline double bond_own_share(const BondBased *b, const Bond *bond)
{
  return is_foreign(b->foreign, bond->neighbour) ? 1 : 0.5;
}

/** Tension over |y|, times the surface correction: force per volume, weight and length of y.
 *  @param[in] u  rows of displacements */
double bond_pull(const BondBased *b, double *const *u, int64_t slice, int64_t slot, int lane, const Bond *bond,
                 double y[3]);

/** c by the continuum's integrals (docs/theory.md 2, table and general rule). */
double bond_continuum_constant(const BondBased *b, double young);

/** Factor on the continuum's c for the lattice of a block. */
double bond_calibration(const BondBased *b, int block, Calibration calibration);

/** As FormulationType describes them. */
double bond_shown_young(const void *formulation, int block, int axis);
double bond_energy_room(const void *formulation, int64_t slice, const EnergyLimit *limit, uint8_t *found);
double bond_characteristic_length(const BondLength *of);
double bond_crack_length(const void *formulation, int block, const double normal[3]);
/** FormulationType.uniaxial_strength (bond_strength.c). */
double bond_uniaxial_strength(const void *formulation, int block, const double direction[3]);
/** FormulationType.uniaxial_crushing (bond_strength.c). */
double bond_uniaxial_crushing(const void *formulation, int block, const double direction[3]);
double bond_critical_stretch(const BondLength *of, const Material *material, double energy);
void bond_describe(const void *formulation, const Units *units, Text *text);

#endif
