/* What the parts of micropolar peridynamics share: the table entry (micropolar.c), constants of links (micropolar_constants.c), links one by one
 * (micropolar_link.c), their changes (micropolar_linear.c), sweeps over links in the plane (micropolar_plane.c) and in space
 * (micropolar_space.c), and damage of links (micropolar_damage.c, found by
 * micropolar_damage_sweep.c from what laws say, micropolar_damage_laws.c). */
#ifndef BRECCIA_FORMULATION_MICROPOLAR_H
#define BRECCIA_FORMULATION_MICROPOLAR_H

#include "base/lane_kinds.h"
#include "formulation/formulation.h"
#include "formulation/stretch.h"

/** Stiffness of links per volume squared and influence: axial force c s of a stretch s, end moments (d / L)(4 a + 2 b) of end rotations a, b from
 *  the chord, and a torque (twist / L) psi. So EA = c V_i V_j, EI = d V_i V_j, GJ = twist V_i V_j. */
typedef struct LinkStiffness {
  double axial, bending, twist;
} LinkStiffness;

enum { MOST_LENGTHS = 2, LINK_RECORD = 8 };

/** Links of one block. */
typedef struct LinkConstants {
  LinkStiffness any; /* of all lengths: right in uniform expansion, and in shear in the mean of all directions */
  int lengths;       /* of links on its lattice where these can be right in every direction; 0: they have `any` */
  double length[MOST_LENGTHS];
  LinkStiffness of[MOST_LENGTHS];
  double gyration; /* square of the radius of gyration of a particle */
  double crossed;  /* sum of axial stiffness w L^2 over a family inside */
} LinkConstants;

/** What sweeps read of links of a lattice pattern. */
typedef struct LinkRow {
  double xi[3], n[3]; /* reference vector, and over its length */
  double by_length;   /* 1 / L */
  double axial;       /* c w */
  double bending;     /* d w / L */
  double twist;       /* twist w / L */
} LinkRow;

/* Of a slice: in which of the two what was tried is more than what is committed, and whether a link is shorter now than it can be undamaged. */
enum { GROWN_IN_TENSION = 1, GROWN_IN_COMPRESSION = 2, PRESSED = 4 };

typedef struct Micropolar Micropolar;

/** How damage of links is found, for each kind of vectors. */
typedef struct DamageSweeps {
  /** That in tension of the links of slices, as tried. */
  void (*find_tension)(const Micropolar *m, const Sweep *sweep);
  /** Then that in compression, which asks how many links of both ends have the former. */
  void (*find_compression)(const Micropolar *m, double *const *displacement, int64_t slice);
} DamageSweeps;
LANES_CHOICE(const DamageSweeps, micropolar_damage)

/** Damage of links, and by which laws. Both ends of a link keep its damage, found from the same numbers. */
typedef struct LinkDamage {
  breccia_link *laws;                  /* [blocks] whose tension_end is found */
  double longer, shorter;              /* bounds of (|y|^2 - |xi|^2) / |xi|^2 within which no link is damaged */
  double *tension[2], *compression[2]; /* [slots * SLICE] committed, and as tried */
  double *damaged;                     /* [places] links with damage in tension, as tried */
  uint8_t *touched;                    /* [slices] some link has been beyond its bounds */
  uint8_t *grown;                      /* [slices] GROWN_IN_TENSION and the like */
  const DamageSweeps *sweeps;
} LinkDamage;

/** What sweeps over links do, for each kind of vectors. */
typedef struct MicropolarSweeps {
  /** Forces and moments on a slice. */
  void (*resist)(const Micropolar *m, const Sweep *sweep, int64_t slice);
  /** Their changes in a linearised step. */
  void (*resist_changes)(const Micropolar *m, const Sweep *sweep, int64_t slice);
  /** Spins of places from changes of their rotation vectors in a linearised step. NULL: they are equal. */
  void (*show_spins)(const Micropolar *m, const Sweep *sweep);
  /** What the places of a slice store in links, but those to other formulations. */
  void (*store)(const Micropolar *m, int64_t slice, double energies[SLICE]);
  /** What slices first .. last - 1 show at rotations among these displacements. */
  void (*show)(const Micropolar *m, double *const *at, int64_t first, int64_t last);
} MicropolarSweeps;
LANES_CHOICE(const MicropolarSweeps, micropolar_plane)
LANES_CHOICE(const MicropolarSweeps, micropolar_space)

struct Micropolar {
  const Particles *particles;
  const Family *family;
  const Body *body;
  const Material *materials;
  const int32_t *material; /* [slices] */
  const Points *points;
  const uint8_t *foreign; /* [slices], or NULL; links to such places have half of the stiffness of their own end */
  Space space;
  const Influence *influence;
  bool secant;              /* links of the thesis, which turn without a corotated frame */
  double torsion;           /* share of the torsional stiffness of a round beam */
  LinkConstants *constants; /* [blocks] */
  LinkRow *rows;            /* [patterns] */
  LinkDamage *damage;       /* NULL: all links are elastic */
  double *spin[3];          /* [places] of changes in space */
  /** [places][LINK_RECORD] position, volume and displacement, and [places][QUAD] what `shown` has, of each place side by
   *  side, as stored links read them; NULL: there are none. */
  double *record, *turns;
  double *shown[4]; /* [places] cosine and sine of the rotation in the plane, or the quaternion of a place in space */
  const MicropolarSweeps *sweeps;
};

/** Material of a block. */
const Material *micropolar_material(const Micropolar *m, int block);
/** Finds the constants of a block. Says so where its material is none for links of beams. */
int micropolar_find_constants(Micropolar *m, int block, Error *error);
/** Stiffness of a link: the mean of what both ends' blocks say to its length. */
LinkStiffness micropolar_stiffness(const Micropolar *m, int64_t place, const Bond *bond);
/** Adds what a user should know before a run. */
void micropolar_describe(const void *formulation, const Units *units, Text *text);

/* ---- links one by one ---- */

/** A link as one end sees it; forces, moments and energy per volume of this end and weight of the bond. Ends in places of other formulations have no rotations:
 *  they turn with the end that has, which is exact where strains are even, and take no moments. */
typedef struct Link {
  Bond bond;
  bool alone; /* the other end is such a place */
  LinkStiffness stiffness;
  double y[3], length; /* to the other end, as deformed */
  double stretch;      /* without the free strain */
  double force[3];     /* on this end; on the other one minus this */
  double moment[2][3]; /* on this end, on the other */
  double energy;
} Link;

/** The same by the stiffness of the thesis, of a link whose y stands there, at the rotations of its ends. */
void micropolar_resist_secant(const double angle[2], Link *link);

/** An end: its quaternion, where its section points (a), m x a (b) and m . a, the rotation vector from the chord m to a, its angle t over sin t, and
 *  (1 - t cot t) / sin^2 t. */
typedef struct LinkEnd {
  double q[4], a[3], b[3], cosine, rotation[3], factor, bend;
} LinkEnd;

LinkEnd micropolar_end(const Micropolar *m, double *const *u, int64_t place, const double n[3], const double chord[3]);
/** Quaternion of the rotation from the first end to the other, by the shorter way. */
void micropolar_twist(const LinkEnd ends[2], double r[4]);

static inline double vector_dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vector_cross(const double a[3], const double b[3], double c[3])
{
  for (int k = 0; k < 3; ++k) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/** Motion of a link's ends: displacement of the other end less that of this one, and spins of both. */
typedef struct LinkMotion {
  double apart[3], spin[2][3];
} LinkMotion;

/** Returns the first row of rotations. */
static inline int micropolar_rotation(const Micropolar *m)
{
  return m->particles->space.rotation;
}

/** Returns the motion of a link's ends with changes v of displacements and rotations `at`. */
LinkMotion micropolar_motion(const Micropolar *m, double *const *v, double *const *at, int64_t place, int64_t other);

/** What a link does with it to the force on this end and the moments on both, per volume of this end and weight of the bond (micropolar_linear.c). */
typedef struct LinkChange {
  double force[3], moment[2][3];
} LinkChange;
LinkChange micropolar_change(const Micropolar *m, double *const *at, int64_t place, const Link *link,
                             const LinkMotion *motion);

/** Changes of forces and moments of a slice in a linearised step, link by link, or only of its links to places of other
 *  formulations, added to what stands there. */
void micropolar_resist_changes_one_by_one(const Micropolar *m, const Sweep *sweep, int64_t slice, bool only_foreign);
/** As FormulationType describes them. */
int64_t micropolar_point_count(const void *formulation);
int micropolar_point(const void *formulation, double *const *displacement, int64_t number, Operator *point,
                     Error *error);

/** Stretch of a bond at displacements u. @param[out] y  to the other end, as deformed */
double micropolar_stretch(double *const *u, int64_t place, const Bond *bond, double y[3]);

/** A link at rows u of displacements and rotations. */
Link micropolar_link(const Micropolar *m, double *const *u, int64_t slice, int64_t slot, int lane);

/** Forces and moments of a slice, link by link, or only of its links to places of other formulations, added to what stands there. */
void micropolar_resist_one_by_one(const Micropolar *m, const Sweep *sweep, int64_t slice, bool only_foreign);

/* ---- damage ---- */

/** Makes room for damage if some law says how links are damaged, and finds out how those of each block are. */
int micropolar_damage_create(Micropolar *m, Error *error);
void micropolar_damage_destroy(Micropolar *m);
/** Finds how the links of a block are damaged; `link` is what its law says. Says so where a fracture energy is too small for its links. */
int micropolar_find_damage_law(const Micropolar *m, int block, breccia_link *link, Error *error);
double micropolar_crack_length(const void *formulation, int block, const double normal[3]);

/** Whether damage counts now, and some link of the slice may have any. */
static inline bool micropolar_is_weak(const Micropolar *m, int64_t slice)
{
  return m->damage && m->damage->touched[slice] && !m->points->clock->elastic_stage;
}

/** Stiffness that is left at a stretch. */
void micropolar_weaken(const Micropolar *m, int64_t place, int64_t other, int64_t at, double stretch,
                       LinkStiffness *stiffness);
/** As FormulationType describes them. */
void micropolar_state(void *formulation, const char *part, StateList *list);
void micropolar_commit(void *formulation, bool well);
double micropolar_history(const void *formulation, int64_t place, int k);
/** Implements FormulationType.bond_damage: the larger of the damage in tension and the damage in compression of a
 *  link. */
double micropolar_link_damage(const void *formulation, int64_t slice, int64_t slot, int lane);
size_t micropolar_damage_bytes(const Micropolar *m);

#endif
