/* Formulations: displacements to strain at material points, and stress there to forces between particles.
 * A formulation knows nothing of laws, a law nothing of formulations; what calls them in turn is domain/. */
#ifndef BRECCIA_FORMULATION_FORMULATION_H
#define BRECCIA_FORMULATION_FORMULATION_H

#include "deck/quantity.h"
#include "family/bond_list.h"
#include "formulation/operator.h"
#include "points/points.h"

typedef struct PeridynamicsSpec {
  SectionHead head;
  int formulation, space, influence, volume_correction; /* indices of their words */
  Length horizon;
  void *keys;          /* the struct of the formulation's own section */
  SectionList regions; /* of RegionSpec */
} PeridynamicsSpec;

/** Blocks with a formulation of their own. */
typedef struct RegionSpec {
  SectionHead head;
  TextList blocks;
  int formulation; /* index of its word */
  void *keys;
} RegionSpec;

extern const Section peridynamics_section;

/** Words of `space`, NULL after the last. */
const char *space_word(int k);
Space peridynamics_space(const PeridynamicsSpec *spec);
/** The horizon of the deck, or where it gives none the longest that its formulations want. */
Length peridynamics_horizon(const PeridynamicsSpec *spec);

/** Strain measures of 3-D laws, in the order of strain_measure_words. */
typedef enum StrainMeasure { STRAIN_GREEN_LAGRANGE, STRAIN_SMALL } StrainMeasure;
extern const char *const strain_measure_words[];

enum { CARRY = 9 };

/** Evenness of the members of a point (FormulationType.evenness) at which they give no strain; below, the inverse of
 *  their second moment would multiply round-off by more than a million. */
#define FORMULATION_LEAST_EVENNESS 1e-6

/** What a formulation works on; borrowed. Particles have rows of rotations if any formulation of the body wants them. */
typedef struct FormulationParts {
  const void *keys; /* of its own section; NULL: those of another formulation stand in the deck, and defaults count */
  Space space;
  const Influence *influence;
  const Body *body;
  const Particles *particles;
  const Family *family;
  const Points *points;
  const BondList *bonds; /* of points on bonds; NULL if there are none */
  const Material *materials;
  int material_count;
  const int32_t *material; /* [slices] which of the materials */
  /** [slices] 1: of another formulation; NULL: none is. Only displacements are seen of such places, at most next to own ones: what a
   *  formulation gives own places is their own force state for all their bonds, less those of own neighbours. */
  const uint8_t *foreign;
  const int64_t *stripe; /* [stripe_count + 1] slices at which stripes begin, as Phase says */
  int64_t stripe_count;
  bool may_break; /* a criterion of the deck breaks bonds */
} FormulationParts;

static inline bool is_foreign(const uint8_t *foreign, int64_t place)
{
  return foreign && foreign[place / SLICE];
}

/** Whether a block of the body belongs to others. */
static inline bool block_is_foreign(const uint8_t *foreign, const Particles *particles, int block)
{
  int64_t slice = 0;
  while (particles->block[slice] != block) ++slice;
  return foreign && foreign[slice];
}

/** What the length of bonds that cross a crack depends on. */
typedef struct BondLength {
  Space space;
  const Influence *influence;
  double horizon, spacing; /* spacing: the coarsest */
} BondLength;

/** Energy of the deformation of a place or of a bond [energy]. What was received is what is stored less half of what the forces of the moment
 *  did along the last step: what works summed by the trapezium rule have put in, if these forces end with the step. */
typedef struct StoredEnergy {
  double stored;            /* what unloading would give back, in all */
  double held;              /* of that, by the control of zero-energy modes */
  double received, control; /* by bonds that act as springs; by the control of zero-energy modes */
  double
      inside; /* of what was received, where there is a `face_force`: what the body itself had of it, without images */
  double weight; /* volume for which the law of a point stands, by the share of its stress that is carried; 0: none */
  double strain[6], was[6]; /* of that point at the end and at the beginning of the last step, with the present bonds */
} StoredEnergy;

/** Energies that bonds may hold, per volume squared and influence as in `half_state`: force times elongation over two, of both ends. */
typedef struct EnergyLimit {
  double
      half; /* half of the least of a slice's bonds: what one of the two ends has at least where both have more than that */
  const double *influence; /* [patterns] omega of bonds along lattices */
  const Influence *of;     /* omega of others */
  double moved;            /* the most that any particle has moved since stresses were evaluated */
} EnergyLimit;

/** What bonds that broke leave to contact. */
typedef struct FormerBonds {
  double share; /* of the stiffness of bonds calibrated in uniform expansion that they had */
  bool alike;   /* they are as stiff where a family is not whole */
} FormerBonds;

/** What a sweep reads and writes of places. */
typedef enum Quantity {
  OF_DISPLACEMENTS = 1, /* displacements, or what stands for them in a linearised step */
  OF_SHOWN = 2,         /* what neighbours read of displacements beyond these themselves */
  OF_STRAINS = 4,       /* of the points of the batch; laws are asked before the first phase that reads OF_STRESSES */
  OF_STRESSES = 8,
  OF_STATES = 16, /* force states */
  OF_SUMS = 32,   /* sums of force states along lattice rows */
  OF_FORCES = 64
} Quantity;

/** Slices first .. last - 1, of one material and at most BATCH places, that are worked on together. */
typedef struct Sweep {
  int64_t first, last;
  double *carry; /* [CARRY][BATCH] numbers that one phase leaves for a later one: they need never leave the cache */
  /** Strains that are found and stresses that are answered, in a linearised step their changes: [6][places of the batch] of points on
   *  particles. Of points on bonds [1][rows], of a batch of rows of one material; first .. last is then their slice.
   *  If points read lateral elongations (Points.takes_lateral), strain[1] is the elongation by pressure across the
   *  bond. */
  double *strain[6], *stress[6];
  int64_t row; /* of points on bonds: the first of them (family/bond_list.h) */
  int rows;
  bool no_law; /* stresses are as they should be: laws of a formulation that keeps no points are not asked either */
  double *const *displacement; /* [motions] rows of displacements; of a linearised step, their changes v */
  /** [motions] rows of displacements at which the step is linearised; NULL: the evaluation is nonlinear. */
  double *const *linearised_at;
  double *const *internal; /* [motions] rows of forces and moments per volume, or their changes, that phases write */
  /** Where phases `ahead` write what later ones read, of slice s where s modulo `window_slices` says; NULL: in the formulation's own arrays. */
  double *window;
  int64_t window_slices; /* a power of two */
} Sweep;

typedef struct Phase {
  unsigned reads, writes; /* Quantity bits, of the batch's own places */
  unsigned of_neighbours; /* and what it reads of neighbours: all batches have written that before */
  unsigned of_lower;      /* what it reads of neighbours with lower places only, so that it may follow close behind */
  unsigned along_rows;    /* what it reads along its lattice row; only rows longer than a batch wait for that */
  bool
      by_stripes; /* one thread calls it for all batches of a stripe, in their order, so that they may add up what they find in one place */
  bool by_one;    /* one thread calls it once, for few places anywhere */
  bool
      ahead; /* what it writes is read by the next phase only: each thread may call it for slices around that one's batch, with Sweep.window */
  /** @return -1, or a place whose law could not be integrated */
  int64_t (*run)(void *formulation, const Sweep *sweep);
} Phase;

enum { MOST_PHASES = 8 };

typedef struct SumsAround {
  int64_t low, high; /* first and last slice of which it is read */
  int64_t all;       /* numbers that a slice takes in the formulation's own arrays */
  int64_t most;      /* in a window: of the phase that writes most; 0: it takes none */
} SumsAround;

/** Energies [energy] of a place whose secant stiffness is below 0.7 of the initial one; else zeros. */
typedef struct YieldedEnergy {
  double stored;  /* by law and control */
  double held;    /* of that, by the control of zero-energy modes */
  double lasting; /* of that, by a control that keeps its stiffness */
} YieldedEnergy;

/** Control of zero-energy modes. */
typedef struct ControlType {
  /** Returns true if the formulation of the deck has a control. */
  bool (*is_active)(const void *formulation);
  /** Returns true if control keeps its stiffness where points of a material have lost theirs. */
  bool (*keeps_stiffness)(const void *formulation, const Material *material);
  /** Returns true if the influence of bonds decreases with their length. Fading control is bounded on slip lines
   *  then. */
  bool (*influence_decreases)(const void *formulation);
  /** Energy that the control stores at a place. */
  double (*energy)(const void *formulation, int64_t place);
  void (*yielded_energy)(const void *formulation, int64_t place, YieldedEnergy *energy);
} ControlType;

typedef struct FormulationType FormulationType;
struct FormulationType {
  const char *name, *about, *source, *maturity;
  int components;                /* of laws: 6, strain in space, or 1 */
  bool on_bonds;                 /* points are on bonds; otherwise on particles */
  const FormulationType *fibres; /* what it is with laws of one strain; NULL: it takes none */
  double horizon;                /* in spacings, where the deck gives none; 0: 3.015 */
  bool row_sums;                 /* neighbours read sums along lattice rows */
  bool keeps_no_points;          /* what laws say of themselves is all that the formulation needs of them */
  bool knows_hooke; /* the formulation finds strains and stresses of points on bonds itself if all laws are Hooke's */
  /** Points whose members have two stiffnesses are laminates: each of the two materials has a point there. */
  bool laminates;
  bool fixed_poisson;     /* bodies show Poisson's ratio 1/4, in plane stress 1/3, whatever the material says */
  bool locks;             /* bodies that nearly keep their volume are too stiff in bending */
  bool may_stiffen;       /* the largest eigenvalue of stiffness over mass may grow as bonds break */
  const Section *section; /* its keys, which stand among those of peridynamics */
  /** Whether it takes a law of its components. NULL: takes all. */
  bool (*takes)(const breccia_law *law);
  /** Refuses parameters of a law that it takes, with the reason. NULL: takes all. */
  int (*check_material)(const Material *material, char *reason, size_t size);
  /** Refuses bodies and spaces that the formulation does not take. NULL: takes all. */
  int (*check)(const void *keys, const Body *body, const DeckReader *reader);
  /** Makes a formulation for a body. Says where families are too poor for it. */
  void *(*create)(const FormulationParts *parts, Error *error);
  void (*destroy)(void *formulation);
  /** Square of the radius of gyration of a place: particles have rotations. NULL: they have none. */
  double (*gyration)(const void *formulation, int64_t place);
  /** Bonds of this slice have broken. NULL: nothing to do. */
  void (*renew)(void *formulation, int64_t slice);
  /** From displacements to internal forces per volume, batch by batch, in this order; up to the first without `run`. */
  Phase phases[MOST_PHASES];
  /** Keeps what a linearised step needs of the state that was evaluated last, tangents of the points among it.
   *  @param[in] displacement  [motions] rows of displacements of that state */
  int (*linearise)(void *formulation, double *const *displacement, Error *error);
  /** Force per volume squared t that a particle's own formulation gives one of its bonds: the force on it per volume is the sum of
   *  (t_ij - t_ji) V_j. Of the state that was evaluated last; in a linearised step its change.
   *  @param[in] displacement, linearised_at  as in Sweep */
  void (*half_state)(const void *formulation, double *const *displacement, double *const *linearised_at, int64_t slice,
                     int64_t slot, int lane, double state[3]);
  /** Material points, numbered for `point`: some of the numbers may have none. */
  int64_t (*point_count)(const void *formulation);
  /** How displacements make the strain of a point and its stress forces, and what springs beside it do. Slow and plain: what sweeps are
   *  checked against, and what matrices are assembled from. Of the state that was evaluated last; its tangent, if that
   *  was linearised.
   *  @param[in] displacement  [motions] rows of displacements of that state */
  int (*point)(const void *formulation, double *const *displacement, int64_t number, Operator *point, Error *error);
  /** Deformation gradient F at a place, row by row. */
  void (*gradient)(const void *formulation, int64_t place, double f[9]);
  /** Returns true if laws take small strain, so that what is told of places must be such. NULL: laws take what the
   * bonds say, and the strain of a place is told as Green-Lagrange. */
  bool (*takes_small_strain)(const void *formulation);
  /** [places] shares of its stress that the family of a place carries, beyond what its bonds allow: 1 as long as nothing breaks. They
   *  are state; after a change `renew` is called. NULL where bonds have energies of their own. */
  double *(*shares)(void *formulation);
  /** Rows of what laws remember where there are no points; NULL: nothing. @param[in] part  put behind their names, or NULL */
  void (*state)(void *formulation, const char *part, StateList *list);
  /** The step under way has come out well, or has failed: makes what laws remember of it the committed state, or forgets it. */
  void (*commit)(void *formulation, bool well);
  /** Whether forces are found with something as the step before left it, so that a step that is tried again from where it ended comes to other
   *  ones; NULL: never. */
  bool (*lags)(const void *formulation);
  /** Share of the forces that may be out of balance once what lags is as the step has left it; INFINITY or NULL: nothing lags, ever. */
  double (*lag_allowed)(const void *formulation);
  /** Whether linearised steps take what is damaged by the stiffness that it has left, without what its damage changes: such corrections always come
   *  on, but slowly. NULL: never. */
  bool (*takes_secants)(const void *formulation);
  /** Reads the strengths of laws again, which have changed; by one thread. NULL: the formulation asks laws only. */
  void (*take_strengths)(void *formulation);
  /** History number k of the law at a place, as committed, where there are no points; NULL: 0. */
  double (*history)(const void *formulation, int64_t place, int k);
  /** Committed damage of an intact bond, 0 to 1, of formulations that store the damage of bonds without points. NULL:
   *  bonds have no such damage. */
  double (*bond_damage)(const void *formulation, int64_t slice, int64_t slot, int lane);
  /** Energy of the deformation of a place at the displacements held, with its present bonds and the stress that its law gave last.
   *  @param[in] time  of the last step: displacements were those held less `time` times the velocities held */
  void (*stored_energy)(const void *formulation, int64_t place, double time, StoredEnergy *energy);
  /** What the places of a slice store, each for itself, where that is faster. All have shown their neighbours what `show_held` makes of the displacements held.
   *  Both or neither. */
  void (*stored_energies)(const void *formulation, int64_t slice, double energies[SLICE]);
  void (*show_held)(const void *formulation, int64_t slice);
  /** The same of one bond, if bonds have energies of their own and hand nothing on when one of them breaks; or NULL. */
  void (*bond_energy)(const void *formulation, int64_t slice, int64_t slot, int lane, double time,
                      StoredEnergy *energy);
  /** Where points act on places beside their bonds: the force on a place whose work, added to that of minus its internal force if it is one of the body and
   *  to none if it is an image, makes the energy of what the body itself has of the points. Of the state evaluated last. NULL: each place has the energy of its own half
   *  states. */
  void (*face_force)(const void *formulation, int64_t place, double force[3]);
  /** How a bond has changed as its particle sees it: y less the reference vector, turned as the particle's family has turned. Half of its product
   *  with the half state is the particle's share of the bond's energy. NULL: y - |xi| y / |y|, for forces along bonds. */
  void (*elongation)(const void *formulation, int64_t slice, int64_t slot, int lane, double change[3]);
  /** Tension across the section of a bond and shear along it, of the stress answered last; those of a turned body stay the same. NULL: bonds have no
   *  section. */
  void (*section_stress)(const void *formulation, int64_t slice, int64_t slot, int lane, double *tension,
                         double *shear);
  /** Energy that a bond holds, if bonds have points of their own whose forces act on other particles than their ends,
   * too. NULL: half of the product of its half states and elongations. */
  double (*held_energy)(const void *formulation, int64_t slice, int64_t slot, int lane);
  /** From now on keeps what `elongation` and `energy_room` need. NULL: nothing. */
  int (*keep_turns)(void *formulation, Error *error);
  /** Looks for bonds of which a slice's own particles hold more than half of an energy. NULL: nobody knows.
   *  @param[out] found  1 if there may be such, else 0
   *  @return how far every particle may move before there may be; 0: only until the next step */
  double (*energy_room)(const void *formulation, int64_t slice, const EnergyLimit *limit, uint8_t *found);
  /** Virial stress of the bonds at a place; NULL where points have a stress. */
  void (*stress)(const void *formulation, int64_t place, double stress[6]);
  /** Length over which a law must spread a fracture energy: G_F over the area below its stress against strain. NULL: unknown. */
  double (*characteristic_length)(const BondLength *of);
  /** Length over which points on particles must spread G_F so that running cracks take G_F [length]. NULL: the
   *  characteristic_length, whatever the law.
   *  @param[in] ductility  Hillerborg's characteristic length of the material, l = E G_F / f_t^2 [length] */
  double (*softening_length)(Space space, double horizon, double ductility);
  /** Length l over which a plane crack with that normal spreads a fracture energy in the lattice of a block: if all
   * bonds across it break at a stretch s, and nothing else is strained, they take E l s^2 / 2 per area. NULL: unknown.
   *  @return NaN for particles that stand in no lattice */
  double (*crack_length)(const void *formulation, int block, const double normal[3]);
  /** Returns the strength of the inside of a block under uniaxial tension along a unit vector with free sides, over the
   * strength of its softening law as prepared; for laws that yield, the stress well beyond yielding over that of one bond.
   * NULL: equal to the strength of the law.
   *  @return NaN for bars and lines, and for laws that neither soften nor yield or are in servers */
  double (*uniaxial_strength)(const void *formulation, int block, const double direction[3]);
  /** Returns the strength of the lattice of a block in uniaxial compression along a unit vector with free sides, over
   * the compressive strength of its law. NULL: unknown.
   *  @return NaN for particles outside of lattices, and for laws that report no such strength or are in servers */
  double (*uniaxial_crushing)(const void *formulation, int block, const double direction[3]);
  /** Returns true if the tensile strength of a law that softens along bonds is the strength of the body, so that bonds
   * take a share of it (domain/tensile_strength.h). NULL: the strength is that of bonds. */
  bool (*strength_of_body)(const void *formulation);
  /** Critical stretch of bonds with which a plane crack takes a fracture energy, by the integrals of a continuum. NULL:
   * none follows from it. */
  double (*critical_stretch)(const BondLength *of, const Material *material, double energy);
  FormerBonds (*former_bonds)(const void *formulation);
  /** What the free strain of a place would take of the body by growing by 1. NULL: the sum over its
   *  bonds of what each carries along itself times its length. */
  double (*free_tension)(const void *formulation, int64_t place);
  /** Why it takes no free strains, or NULL where it does. NULL: it does. */
  const char *(*strain_free)(const void *formulation);
  /** How an even stress acts on marked places of the body as it begins: adds the area vectors a with which the force on a place is stress . a, all 0
   *  inside and minus a particle's share of the area along the normal of a free surface; NAN where that is not known. NULL: it is nowhere.
   *  @param[in] marked  [places] @param[in,out] area  [3][places] */
  void (*even_stress)(const void *formulation, const uint8_t *marked, double *const area[3]);
  const ControlType *control; /* of zero-energy modes; NULL: none is needed */
  /** Why a free body would gain energy as it moves unless its shortest waves are damped, or NULL where it would not. NULL: it never would. */
  const char *(*flutters)(const void *formulation);
  /** Returns the evenness of the particles that give an intact bond its strain: the smallest eigenvalue of their second
   *  moment over the largest, by the bonds that are left. A bond at FORMULATION_LEAST_EVENNESS or below carries nothing
   *  and breaks with the others. NULL: all bonds carry. */
  double (*evenness)(const void *formulation, int64_t slice, int64_t slot, int lane);
  /** Young's modulus that the lattice of a block shows along one of its axes, over that of its material; NaN: it resists nothing there, or fills none.
   *  NULL: they are the same. */
  double (*shown_young)(const void *formulation, int block, int axis);
  /** Returns true if the softer of two layers of these materials acts thinner than it is. NULL: never. */
  bool (*shifts_interface)(const void *formulation, const Material *one, const Material *other);
  /** Adds what a user should know before a run, as one line, in `units`; NULL: nothing. */
  void (*describe)(const void *formulation, const Units *units, Text *text);
  /** Arrays over places, of force states and what else each evaluation writes before it reads it: strains and stresses of the state evaluated
   *  last find room there. No phase that ends before the law is asked reads them. @return false: it has none. NULL: never has */
  bool (*scratch)(const void *formulation, double *strain[6], double *stress[6]);
  /** Gives memory of the arrays that `scratch` names back, which are zero until phases write to them again. Together with `scratch`. */
  void (*give_way)(void *formulation);
  /** What phases `ahead` write, and which of it the phases that follow them read for a slice. NULL: there are no such phases. */
  SumsAround (*sums_around)(const void *formulation, int64_t slice);
  /** Bytes beyond particles, families and points. */
  size_t (*bytes)(const void *formulation);
};

/** @return the k-th formulation, or NULL after the last */
const FormulationType *formulation_at(int k);
const FormulationType *formulation_find(const char *name);

/** Micromodulus c of a bond-based solid with this Young's modulus and constant influence: 12E/(pi delta^4), in the plane
 *  9E/(pi t delta^3) (docs/theory.md 2). It sets the scale of zero-energy control and of lone axial bonds. */
double micromodulus(const Body *body, double young, double horizon);

#endif
