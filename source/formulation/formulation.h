/* Formulations: displacements to strain at material points, and stress there to forces between particles.
 * A formulation knows nothing of laws, a law nothing of formulations; what calls them in turn is domain/. */
#ifndef BRECCIA_FORMULATION_FORMULATION_H
#define BRECCIA_FORMULATION_FORMULATION_H

#include "constitutive/points.h"
#include "family/family.h"

typedef struct ControlSpec { /* of zero-energy modes; exactly one is given */
  SectionHead head;
  double silling, wan;
  bool none;
} ControlSpec;

typedef struct PeridynamicsSpec {
  SectionHead head;
  const char *formulation, *space, *strain, *influence, *volume_correction, *calibration, *surface_correction;
  Length horizon;
  ControlSpec *control;
} PeridynamicsSpec;

extern const Section peridynamics_section;

Space peridynamics_space(const PeridynamicsSpec *spec);

/** How the constant of bonds follows from Young's modulus. */
typedef enum Calibration { CALIBRATION_CONTINUUM, CALIBRATION_EXPANSION, CALIBRATION_UNIAXIAL } Calibration;
const char *calibration_word(int k);

enum { CARRY = 9 };

/** What a formulation works on; borrowed. */
typedef struct FormulationParts {
  const PeridynamicsSpec *spec;
  const Body *body;
  const Particles *particles;
  const Family *family;
  Points *points;
} FormulationParts;

/** What the length of bonds that cross a crack depends on. */
typedef struct BondLength {
  Space space;
  const Influence *influence;
  double horizon;
} BondLength;

/** Energy of the deformation of a place or of a bond [energy]. */
typedef struct StoredEnergy {
  double stored; /* what unloading would give back: weight x density + beside */
  double
      half_work; /* half of what the forces of the moment did along the last step: the trapezium rule's share of the step's end */
  double beside;               /* stored by anything but the law of a point */
  double weight;               /* volume for which the law of a point stands; 0 where laws act on bonds */
  double density;              /* energy per volume that the point would give back */
  double strain[6], stress[6]; /* of the point */
} StoredEnergy;

typedef struct FormulationType {
  const char *name, *about, *source, *maturity;
  int uniaxial;      /* laws act on bonds, not on points in space */
  bool row_sums;     /* show_displacements and sum_states make sums along lattice rows for neighbours to read */
  bool bond_lengths; /* lengths of stored bonds are read in sweeps */
  bool may_stiffen;  /* the largest eigenvalue of stiffness over mass may grow as bonds break */
  /** Makes a formulation for a body. Says where families are too poor for it. */
  void *(*create)(const FormulationParts *parts, Error *error);
  void (*destroy)(void *formulation);
  /** Bonds of this slice have broken. NULL: nothing to do. */
  void (*renew)(void *formulation, int64_t slice);
  /** What neighbours will read of displacements beyond these themselves; all slices are done before any deforms. NULL: nothing. */
  void (*show_displacements)(void *formulation, int64_t first, int64_t last);
  /** Displacements to strains at the points of slices first .. last - 1, at most BLOCK places.
   *  @param[out] carry  [CARRY][BLOCK] numbers of these places that `respond` finds again: they need never leave the cache.
   *  NULL, as is `respond`, where `resist` does everything. */
  void (*deform)(void *formulation, int64_t first, int64_t last, double *carry);
  /** Stresses at these points to whatever `resist` needs of a particle and its neighbours. */
  void (*respond)(void *formulation, int64_t first, int64_t last, const double *carry);
  /** Sums of responses that neighbours will read; all slices have responded before. */
  void (*sum_states)(void *formulation, int64_t first, int64_t last);
  /** Internal force per volume on the particles of these slices; all slices are summed before.
   *  @return a place whose law could not be integrated, or -1 */
  int64_t (*resist)(void *formulation, int64_t first, int64_t last);
  /** Forces of the few particles that need another treatment; called once, by one thread, after all have resisted. May be NULL. */
  void (*finish)(void *formulation);
  /** Force per volume squared that the neighbour exerts on the particle through one bond (t_ij - t_ji). */
  void (*bond_force)(const void *formulation, int64_t slice, int64_t slot, int lane, double force[3]);
  /** Deformation gradient F at a place, row by row. */
  void (*gradient)(const void *formulation, int64_t place, double f[9]);
  /** Energy of the deformation of a place, as it stands and with its present bonds. Stresses follow elastically from those that laws gave
   *  last.
   *  @param[in] time  of the last step: displacements were those held less `time` times the velocities held */
  void (*stored_energy)(const void *formulation, int64_t place, double time, StoredEnergy *energy);
  /** The same of one bond, if bonds have energies of their own and hand nothing on when one of them breaks; or NULL. */
  void (*bond_energy)(const void *formulation, int64_t slice, int64_t slot, int lane, double time,
                      StoredEnergy *energy);
  /** Virial stress of the bonds at a place; NULL where points have a stress. */
  void (*stress)(const void *formulation, int64_t place, double stress[6]);
  /** Length over which a law must spread a fracture energy: G_F over the area below its stress against strain. NULL: unknown. */
  double (*characteristic_length)(const BondLength *of);
  /** Adds what a user should know before a run, as one line; NULL: nothing. */
  void (*describe)(const void *formulation, Text *text);
  /** Bytes beyond particles, families and points. */
  size_t (*bytes)(const void *formulation);
} FormulationType;

/** @return the k-th formulation, or NULL after the last */
const FormulationType *formulation_at(int k);
const FormulationType *formulation_find(const char *name);

/** Micromodulus c of a bond-based solid with this Young's modulus and constant influence: 12E/(pi delta^4), in the plane
 *  9E/(pi t delta^3), of a bar 2E/(A delta^2) (docs/theory.md 2). It sets the scale of zero-energy control and of lone axial bonds. */
double micromodulus(const Body *body, double young, double horizon);

#endif
