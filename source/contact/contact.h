/* Particles that no bond joins keep each other off: two bodies that meet, and the faces of a crack that closes (docs/theory.md 2).
 *
 * Contact has an energy, a function of the positions alone between events, and its forces are the derivatives of it: momentum, angular
 * momentum and energy are kept. Pairs that may touch are kept in rows, by number, each from both its ends. A pair resists when it is nearer
 * than its rest, measured across the face between its ends; the normal of the face follows the deformation gradients of both
 * families, so that part of the force acts on these. Which face, and the rest, are chosen when pairs are found again, and only for those
 * that do not press: nothing jumps then. Where families of pressing pairs lose bonds, the rest is set so that the energy stays.
 * Pairs are found again when particles have moved by half of what rows reach beyond any contact. */
#ifndef BRECCIA_CONTACT_CONTACT_H
#define BRECCIA_CONTACT_CONTACT_H

#include "forces/forces.h"

typedef struct ContactSpec {
  SectionHead head;
  double stiffness, friction;
} ContactSpec;

extern const Section contact_section;

typedef enum PairKind {
  PAIR_NEW,    /* nothing is known of it yet */
  PAIR_BROKEN, /* its bond broke: it resists along itself */
  PAIR_CUT,    /* a plane cut parts it: it resists across the cut, as bonds did */
  PAIR_MET     /* its ends belong to faces that meet */
} PairKind;

/** A pair that may touch. What concerns direction is told from the end of the lower number to that of the higher one. */
typedef struct ContactPair {
  int32_t neighbour; /* place */
  PairKind kind;
  bool low;            /* this is the row of the lower number */
  bool bond;           /* this was a bond */
  bool found;          /* by the last search */
  int32_t act;         /* what it does, one for both ends: index of acts */
  double normal[2][3]; /* of the face, in the reference, as the lower and the higher end know it; 0: it does not */
  double depth;        /* of both ends below their faces */
  double rest;         /* distance across the face below which it resists */
} ContactPair;

/** What a pair does to both its ends, found once from the lower one; direction as in ContactPair, per volume squared. */
typedef struct PairAct {
  int32_t ends; /* rows that have the pair */
  int32_t next; /* free one, while no row has it; or -1 */
  bool presses, turns;
  double force[3];   /* on the lower end; against it on the higher one */
  double turning[3]; /* derivative of the energy by the normal as the frames make it, if it turns with these */
} PairAct;

/** What friction remembers of a pair that touches or nearly does, kept with its lower end; direction as in ContactPair. */
typedef struct Grip {
  bool known;               /* way and normal are */
  double spring[3];         /* elastic slip times the square root of the stiffness: half its square is what it stores;
                               0 unless it touches */
  double pull[3];           /* force along the face, per volume squared */
  double way[3], normal[3]; /* to the higher end, and of the face */
  double left;              /* share of the spring that sliding has left in the evaluation; 1: it sticks */
} Grip;

/** A pair that presses or touches where forces were linearised; direction as in ContactPair, per volume squared. */
typedef struct ContactJoint {
  int32_t low, pair;          /* place of the row, and which of its pairs */
  double stiffness, along;    /* across the face, and of friction along it */
  double coupling;            /* what the force along `slide` grows by with the gap; 0: it does not slide */
  double normal[3], slide[3]; /* unit vectors */
  double across, side[3];     /* way to the higher end along the normal, and along the face */
  double size;                /* of the normal as the frames make it; 0: the way itself is the normal */
} ContactJoint;

enum { MOST_CUTS = 3, MOST_FACES = 4 + 6 }; /* cuts, that of lost bonds, six sides of a lattice cell */

/** How a family is deformed. */
typedef struct Frame {
  bool known;                      /* the family has bonds enough to tell; else cofactor is 0 */
  double gradient[9], cofactor[9]; /* F, and what takes normals of the reference to those of now */
} Frame;

typedef struct ContactRow {
  int32_t place, count, capacity;
  ContactPair *pairs;         /* ascending by number of the neighbour */
  Grip *grips;                /* [capacity][2] committed and trial; NULL without friction */
  bool stale;                 /* the family has changed since its shape was found */
  bool faceless;              /* its faces are to be found */
  bool torn;                  /* the family has lost bonds in the step under way */
  bool near, framed;          /* a pair may press; one that needs frames */
  bool pulls;                 /* there is a pull */
  bool joined;                /* a joint has an end here */
  double shape[9];            /* inverse of sum of V xi (x) xi over the family; 0: too few bonds */
  Frame frame, before;        /* now; before bonds broke in the step under way */
  Frame linear;               /* where forces were linearised */
  double cofactor_change[9];  /* of a linearised step */
  double pull[9];             /* derivative of contact's energy by the deformation gradient, times shape */
  int faces, cuts;            /* the first faces are those of cuts */
  double face[MOST_FACES][3]; /* their unit normals in the reference, outwards */
  double level[MOST_CUTS];    /* of the planes of cuts along their normals */
  double depth;               /* below the faces */
  double stored, slid; /* energy, and work of friction, of the last evaluation: of pairs whose lower end this is */
} ContactRow;

typedef struct Contact {
  const ContactSpec *spec; /* NULL: there is no contact */
  const Body *body;
  const Family *family;
  double *young;    /* [blocks] */
  double *constant; /* [blocks] of a bond: force per volume squared and stretch */
  double *smoothed; /* [blocks] share of it that pairs across a cut have (press.c) */
  uint8_t *touched; /* [places] a bond of this particle may be missing */
  uint8_t *marked;  /* [slices] some of its particles are pulled at by frames */
  int32_t *row_of;  /* [places] or -1 */
  ContactRow *rows;
  int32_t row_count, row_capacity;
  PairAct *acts;
  int32_t act_count, act_capacity, free_act; /* the first free one, or -1 */
  double stiffest;                           /* the most that contact adds to an eigenvalue */
  double margin;                             /* how far the rows reach beyond any contact */
  double travelled;                          /* sum of largest motions since the rows were made */
  int committed;                             /* which grips are committed */
  double friction_work;                      /* dissipated by friction up to the last commit */
  bool cuts;                                 /* a closed cut parts some pairs */
  bool choosing;                             /* pairs were found again: those that do not press choose their faces */
  bool remembered;                           /* frames before bonds broke in the step under way are known */
  bool torn;                                 /* rows are */
  double travelled_before;                   /* the step under way */
  ContactJoint *joints;
  int64_t joint_count, joint_capacity;
  PairAct *steps;  /* [act_capacity, when forces were linearised] what joints do in a linearised step */
  int64_t pattern; /* grows whenever other pairs are joints */
  double *kept;    /* the state before the step under way, as numbers, if it has changed since; or NULL */
  int64_t kept_count;
  bool failed; /* memory was out */
} Contact;

/** @param[in] blocks  [blocks of the body] */
int contact_create(Contact *contact, const ContactSpec *spec, const Body *body, const Family *family, Space space,
                   const ForcesBlock *blocks, Error *error);
void contact_destroy(Contact *contact);

/** By all threads, before bonds break at the displacements held: what pressing pairs have to keep. */
void contact_remember(Contact *contact);
/** Tells that the bond between two places is gone. */
void contact_bond_broke(Contact *contact, int32_t a, int32_t b);
/** Tells that it is there again, as if it had never broken. */
void contact_bond_mended(Contact *contact, int32_t a, int32_t b);

/** Takes back what a step that failed has changed, when its broken bonds are mended. */
void contact_undo(Contact *contact);

/** Calls `one` for all pairs that are no farther apart than they can be when they press. */
void contact_join(const Contact *contact, void (*one)(void *context, int32_t a, int32_t b), void *context);

/** Finds the pairs again. */
void contact_search(Contact *contact);

/** Tells that no particle has moved by more than `motion`; finds the pairs again if need be. */
void contact_follow(Contact *contact, double motion);

/** Adds the forces per volume on the particles, by all threads; trial state only. */
void contact_resist(Contact *contact, double *const *displacement, double *const *internal);

/** Chooses the faces that the next evaluation would, at the displacements held. By one thread. */
void contact_choose_faces(Contact *contact);
/** What ForcesType says of changes of forces (tangent.c). */
double contact_room(const Contact *contact);
void contact_linearise(Contact *contact);
void contact_change(Contact *contact, double *const v[3], double *const change[3]);
const char *contact_unassembled(const Contact *contact);
int contact_point(const Contact *contact, int64_t number, Operator *point, Error *error);

/** Makes what the last evaluation found the committed state, and adds the work of friction. Called by one thread. */
void contact_commit(Contact *contact);

/** Energy that pressed pairs and the springs of friction hold at the displacements held, as committed. */
double contact_energy(Contact *contact);

/** The most that contact adds to the largest eigenvalue of stiffness over mass. */
double contact_eigenvalue(const Contact *contact);

/** The row of what contact remembers; bonds and displacements stand before it. */
void contact_state(Contact *contact, StateList *list);

/** The committed state as numbers, to be saved. @return how many, or -1
 *  @param[out] numbers  to be freed; NULL if there are none */
int64_t contact_save(const Contact *contact, double **numbers);
/** Takes it up again, when displacements and bonds are as they were. @return nonzero if the numbers cannot be those of this body */
int contact_resume(Contact *contact, const double *numbers, int64_t count);

#endif
