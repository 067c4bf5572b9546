/* Ordinary state-based peridynamics (the linear peridynamic solid, Silling et al. 2007; docs/theory.md 3), in space and in the plane in one form.
 *
 * With w = omega beta V_j, the elongation e = |y| - |xi| of a bond and d dimensions, a family has the weighted volume m = sum w |xi|^2 and the
 * dilatation theta = (d / m) sum w |xi| e, and gives each bond
 *   t = omega (a |xi| + b e) y / |y|,   a = theta (d K_d - b m / d) / m,   b m = 15 G in space, 8 G in the plane,
 * where K_d is the modulus against dilatation: K, in plane strain K + G / 3, in plane stress E / (2 (1 - nu)). The force on a particle per volume
 * is sum w [(a_i + a_j) |xi| + (b_i + b_j) e] y / |y|, and t follows from the energy per volume
 *   W = (K_d - b m / d^2) theta^2 / 2 + (b / 2) sum w e^2,
 * which is never negative, whatever bonds are broken: m is that of the family as it began, so that a break takes what a bond carries and leaves the
 * others as they are.
 *
 * Weights are multiplied such that the shear modulus of a family is the same in all directions: along a lattice alike
 * for all bonds of a vector (ordinary_weights.c), of families that are not complete bond by bond
 * (ordinary_families.c). */
#ifndef BRECCIA_FORMULATION_ORDINARY_H
#define BRECCIA_FORMULATION_ORDINARY_H

#include "base/lane_kinds.h"
#include "formulation/formulation.h"
#include "formulation/stretch.h"

/** What each sweep needs of a lattice bond, with weights: 2 xi, and series in -|xi|^2 d. Side by side, as measured: a tenth faster than numbers that
 *  several patterns share. */
typedef struct OrdinaryDilating {
  double twice[3], series[STRETCH_TERMS]; /* of w |xi|^2 stretch */
  double limit;                           /* of the series */
} OrdinaryDilating;
typedef struct OrdinaryResisting {
  double twice[3], series[STRETCH_TERMS]; /* of w g / 2 */
  double weight;                          /* w / 2 */
} OrdinaryResisting;

/** How the deviator of a family answers a step (ordinary_return.c). Derivatives are with the dilatation, and with the amount sum w x de_d of the deviator
 *  x = e_d - s that is kept. */
typedef struct FlowReturn {
  double factor;       /* of the trial e_d - s that is kept, and of its further growth */
  double across;       /* p */
  double factor_by[2]; /* relative growth of the factor */
  double across_by[2];
} FlowReturn;

/** What families remember whose deviators yield or relax (ordinary_flow.c): committed and trial. */
typedef struct Flow {
  double *shift[2];       /* [slots][8] s */
  double *last[2];        /* [slots][8] deviatoric elongations of those that relax; NULL if none does */
  double *across[2];      /* [places] p */
  double *across_last[2]; /* [places] what would make it grow, of those that relax */
  double *equivalent[2];  /* [places] equivalent plastic strain */
  FlowReturn *returned;   /* [places] at the last evaluation */
  double *amount;         /* [places] in a linearised step: of x, then what x is taken times; NULL before */
  int64_t *back;          /* [slots][8] the other end's place in the arrays of slots */
} Flow;

typedef struct Ordinary Ordinary;

/** Factors of a bond near an interface: on the dilatation that its own end and the other end find in it, and on its
 *  stiffness b. */
enum { ORDINARY_OWN, ORDINARY_OTHER, ORDINARY_SPRING, ORDINARY_FACTORS };

/** Sweeps over bonds (ordinary_sweep.c): dilatations; what families make of them; forces. */
typedef struct OrdinarySweeps {
  int64_t (*dilate)(const Ordinary *o, const Sweep *sweep);
  int64_t (*respond)(const Ordinary *o, const Sweep *sweep);
  int64_t (*resist)(const Ordinary *o, const Sweep *sweep);
} OrdinarySweeps;
LANES_CHOICE(const OrdinarySweeps, ordinary_sweeps)

struct Ordinary {
  const Particles *particles;
  const Family *family;
  const Body *body;
  const Points *points;
  const Material *materials;
  const int32_t *material; /* [slices] */
  const uint8_t *foreign;  /* [slices], or NULL */
  Space space;
  int dimensions;
  double *factor;  /* [patterns] on the weights of bonds along lattices */
  float **surface; /* [slices] further factors [slot from the slice's first one][8], alike for both ends of a
                                   bond; NULL: they are 1 */
  float *surfaces; /* [surface_count] which lie here */
  size_t surface_count;
  /** [slices] factors near interfaces [slot from the slice's first one][ORDINARY_FACTORS][8]; NULL entries: 1; NULL: all
   *  are 1 (ordinary_interfaces.c). */
  float **unlike;
  float *unlikes; /* [unlike_count] which lie here */
  size_t unlike_count;
  int32_t *incomplete; /* [places] index into `fourth`; negative: none; NULL: all families are complete */
  /** [incomplete_count][ordinary_fourth_count] mean products n n n n of the incomplete families as they began, weighted
   *  by w |xi|^2 with the factors of bonds [-]. */
  float *fourth;
  int32_t incomplete_count;
  OrdinaryDilating *dilating;   /* [patterns] */
  OrdinaryResisting *resisting; /* [patterns] */
  double *inverse;              /* [places] d / m of the family as it began; 0 where there is no bond */
  double *left;                 /* [places] share of m that is left */
  double *volumetric, *shear;   /* [places] a / theta and b, times the share */
  double *share;                /* [places] */
  double *dilatation;           /* [places] theta */
  double *base, *slope;         /* [places] a and b - a */
  double *change;               /* [places] of theta in a linearised step, then of a; NULL before */
  double *shown;                /* [places][8] what bonds of stored slots read of a neighbour; NULL if there are none */
  double *answer;               /* [places][2] a and b - a, for them too */
  float *by_length;             /* of bonds in stored slots (stretch_lengths); NULL if there are none */
  double shortest;              /* of all bonds */
  bool may_break;               /* as in FormulationParts */
  bool crosses_rows;            /* elastic interfaces cross rows of particles */
  breccia_deviator *deviators;  /* [materials] */
  int material_count;
  Flow *flow;     /* NULL: all families are elastic */
  uint8_t *range; /* [slices] how large stretches were at the last evaluation */
  uint8_t *gaps;  /* [slices] 1: bonds are missing (stretch_has_gaps) */
  const OrdinarySweeps *sweeps;
};

/** A bond with its weight. */
static inline Bond ordinary_bond(const Ordinary *o, int64_t slice, int64_t slot, int lane)
{
  Bond bond = family_bond(o->family, slice, slot, lane);
  if (slot < o->family->stored[slice]) bond.weight *= o->factor[family_pattern(o->family, slice, slot)];
  if (o->surface && o->surface[slice])
    bond.weight *= (double)o->surface[slice][(slot - o->family->first[slice]) * SLICE + lane];
  return bond;
}

/** Returns the place of a factor of a bond near an interface. @param[in] unlike  factors of the slice */
static inline float *ordinary_factor_at(const Ordinary *o, float *unlike, int64_t slice, int64_t slot, int factor)
{
  return unlike + ((slot - o->family->first[slice]) * ORDINARY_FACTORS + factor) * SLICE;
}

/** Returns a factor of a bond near an interface. @param[in] at  the bond's place in the arrays of slots */
static inline double ordinary_factor(const Ordinary *o, int64_t place, int64_t at, int factor)
{
  float *unlike = o->unlike ? o->unlike[place / SLICE] : NULL;
  return unlike ? (double)ordinary_factor_at(o, unlike, place / SLICE, at / SLICE, factor)[at % SLICE] : 1;
}

/** Free strain of a place along the plane or in space, with which a family is free of stress. */
static inline double ordinary_free(const Ordinary *o, int64_t place)
{
  return o->particles->free_strain ? o->particles->free_strain[place] : 0;
}

/** Dilatation without that which the bonds that are left have at the free strain. */
static inline double ordinary_elastic_dilatation(const Ordinary *o, int64_t place)
{
  return o->dilatation[place] - o->dimensions * o->left[place] * ordinary_free(o, place);
}

/** A bond as it is deformed. */
typedef struct OrdinaryStretch {
  double eta[3], y[3], length, elongation;
} OrdinaryStretch;

/** @param[in] u  displacements */
OrdinaryStretch ordinary_stretch(double *const u[3], int64_t place, const Bond *bond);
/** e_d. */
static inline double ordinary_deviatoric(const Ordinary *o, int64_t place, const Bond *bond, const OrdinaryStretch *s)
{
  return s->elongation - o->dilatation[place] * bond->length / o->dimensions;
}

/** What an end of a bond gives it, over its influence. */
typedef struct OrdinaryEnd {
  double tension, stiffness; /* scalar force state; its growth with the elongation alone */
  double turned;             /* growth with the change of the family, in a linearised step */
} OrdinaryEnd;
/** @param[in] at  the bond's place in the arrays of slots, seen from this end */
OrdinaryEnd ordinary_end(const Ordinary *o, int64_t place, int64_t at, const Bond *bond, const OrdinaryStretch *s);

static inline const Material *ordinary_material(const Ordinary *o, int64_t place)
{
  return &o->materials[o->material[place / SLICE]];
}

/** K_d: in-plane or volumetric stress over dilatation. */
double ordinary_bulk(Space space, const Material *material);
/** b m. */
double ordinary_shear(Space space, const Material *material);
/** What the strain across the plane is to the sum of those in it, in plane stress: -nu / (1 - nu). */
double ordinary_across(const Material *material);

/** What the inelastic dilatation p of the plane does: energies - pull theta p + own p^2 / 2. */
typedef struct Across {
  double pull, own;
} Across;
Across ordinary_coupling(Space space, const Material *material);

/** Adds to the factors of the patterns of a block what makes its lattice isotropic; leaves them where that would all but take bonds away
 *  (ordinary_weights.c). */
void ordinary_balance(const Ordinary *o, int block);
/** Finds the factors of bonds near interfaces; `inverse` must be known (ordinary_interfaces.c). */
int ordinary_find_interfaces(Ordinary *o, const FormulationParts *parts, Error *error);
/** Finds the factors of bonds of families that are not complete (ordinary_families.c). */
int ordinary_balance_families(Ordinary *o, Error *error);
/** Returns the number of products n_x^i n_y^j n_z^k with i + j + k = 4. */
static inline int ordinary_fourth_count(int dimensions)
{
  return dimensions == 2 ? 5 : 15;
}
/** Returns the index of the product n_x^i n_y^j n_z^k with i + j + k = 4, in ascending order of i, then of j.
 *  @param[in] power  i, j, k */
static inline int ordinary_fourth_index(int dimensions, const int power[3])
{
  return dimensions == 2 ? power[0] : power[0] * (11 - power[0]) / 2 + power[1];
}
/** Young's modulus that the families of a block show in uniform tension along an axis, over that of its material. */
double ordinary_body_young(const void *formulation, int block, int axis);
/** Shear modulus that a lattice shows in a deviatoric strain (shear components as of a tensor), over the wanted one. */
double ordinary_lattice_shear(const Ordinary *o, int block, const double e[6]);

/** As FormulationType describes them (ordinary_setup.c, ordinary_bonds.c, ordinary_linear.c, ordinary_flow_state.c). */
extern const Section ordinary_section;
int ordinary_check(const void *keys, const Body *body, const DeckReader *reader);
bool ordinary_takes(const breccia_law *law);
const char *ordinary_strain_free(const void *formulation);
int ordinary_check_material(const Material *material, char *reason, size_t size);
void *ordinary_create(const FormulationParts *parts, Error *error);
void ordinary_destroy(void *formulation);
void ordinary_renew(void *formulation, int64_t slice);
void ordinary_describe(const void *formulation, const Units *units, Text *text);
double ordinary_crack_length(const void *formulation, int block, const double normal[3]);
double ordinary_critical_stretch(const BondLength *of, const Material *material, double energy);
size_t ordinary_bytes(const void *formulation);
bool ordinary_shifts_interface(const void *formulation, const Material *one, const Material *other);
FormerBonds ordinary_former_bonds(const void *formulation);
double *ordinary_shares(void *formulation);

/** Von Mises with a yield stress.
 *  @param[in] across  committed p
 *  @param[in] shear   b
 *  @param[in] square  sum w (e_d - s)^2 of the trial */
FlowReturn ordinary_yield(Space space, const Material *material, double yield_stress, double dilatation, double across,
                          double shear, double square);
/** A share of the shear modulus that relaxes.
 *  @param[in] times   step over relaxation time
 *  @param[in] across  committed p
 *  @param[in] last    what made it grow, at the end of the last step
 *  @param[out] now    the same now */
FlowReturn ordinary_relax(Space space, const Material *material, double share, double times, double dilatation,
                          double across, double last, double *now);
/** What a relaxing part takes of a step: `gone` of what it began with, `late` of what was added evenly in it. */
typedef struct Relaxed {
  double gone, late;
} Relaxed;
Relaxed ordinary_relaxed(double times);

/** Reads the laws' deviators; makes room for what they remember. */
int ordinary_flow_create(Ordinary *o, int materials, Error *error);
void ordinary_flow_destroy(Ordinary *o);
/** Reads their yield stresses again, which a strength reduction has changed. */
void ordinary_take_strengths(void *formulation);
/** Whether a deviator does more than resist. */
bool ordinary_flows(const breccia_deviator *deviator);
/** Asks them: trial shifts of slices whose dilatations are known. */
void ordinary_flow(const Ordinary *o, const Sweep *sweep);
/** Takes what shifts take off the forces of slices. */
void ordinary_flow_resist(const Ordinary *o, const Sweep *sweep);
void ordinary_commit(void *formulation, bool well);
void ordinary_state(void *formulation, const char *part, StateList *list);
double ordinary_history(const void *formulation, int64_t place, int k);
size_t ordinary_flow_bytes(const Ordinary *o);

void ordinary_half_state(const void *formulation, double *const *displacement, double *const *linearised_at,
                         int64_t slice, int64_t slot, int lane, double state[3]);
double ordinary_energy_room(const void *formulation, int64_t slice, const EnergyLimit *limit, uint8_t *found);
void ordinary_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy);
void ordinary_gradient(const void *formulation, int64_t place, double f[9]);
void ordinary_stress(const void *formulation, int64_t place, double stress[6]);

int ordinary_linearise(void *formulation, double *const *displacement, Error *error);
int64_t ordinary_point_count(const void *formulation);
int ordinary_point(const void *formulation, double *const *displacement, int64_t place, Operator *point, Error *error);
int64_t ordinary_change_dilatation(const Ordinary *o, const Sweep *sweep);
int64_t ordinary_change_states(const Ordinary *o, const Sweep *sweep);
int64_t ordinary_change_forces(const Ordinary *o, const Sweep *sweep);

#endif
