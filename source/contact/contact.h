/* Particles that no bond joins keep each other off: two bodies that meet, and the faces of a crack that closes (docs/theory.md 2).
 *
 * Pairs that may touch are kept in rows, by number. A pair that a bond joined, until a cut or a break parted it, resists as soon as it is
 * nearer than it was, as stiffly as that bond; any pair resists once the faces meet, that is, once outermost particles are half a
 * spacing of each from each other. How near a pair is, is measured across the face between them, which follows from where
 * the bonded neighbours of both ends lie; along the face it slides, and friction holds it by a spring that gives way at the
 * coefficient times the pressure. Rows are found again when particles have moved by half of what they reach beyond any contact, and with them
 * where faces look; between, that is kept: normals that tremble with every particle would feed energy to bodies that rest on each
 * other. What friction remembers is tried and committed like the state of points. */
#ifndef BRECCIA_CONTACT_CONTACT_H
#define BRECCIA_CONTACT_CONTACT_H

#include "constitutive/material.h"
#include "family/family.h"

typedef struct ContactSpec {
  SectionHead head;
  double stiffness, friction;
} ContactSpec;

extern const Section contact_section;

typedef struct ContactPair {
  int32_t neighbour; /* place */
  bool bond;         /* this was a bond */
  bool found;        /* by the last search */
  double rest; /* of a bond: share of its distance below which it resists; 1, or less where it broke when pressed */
  double normal[3]; /* of the cut that parted it, in the reference, towards the neighbour; 0: none did */
} ContactPair;

/** What friction remembers of a pair that touches. */
typedef struct Grip {
  bool touching;
  double spring[3], way[3], normal[3]; /* elastic slip, way to the neighbour and normal when it was found */
} Grip;

enum { MOST_FACES = 7 }; /* six sides of a lattice cell, and that of lost bonds */

typedef struct ContactRow {
  int32_t place, count, capacity;
  ContactPair *pairs;    /* ascending by number of the neighbour */
  Grip *grips;           /* [capacity][2] committed and trial; NULL without friction */
  bool stale;            /* the family has changed since the faces were found */
  bool turning;          /* it is to be found how the family has turned */
  bool near;             /* a pair may touch */
  double inward[3];      /* mean way to the bonded neighbours in the reference; 0: too few */
  double from[3], to[3]; /* unit vectors of it, in the reference and now: how the family has turned; 0: unknown */
  double lost[3];        /* unit normal of the face that lost bonds have left, in the reference; 0: there is none */
  int faces;             /* that the particle has */
  double face[MOST_FACES][3], turned[MOST_FACES][3]; /* their unit normals, in the reference and now */
  double depth;                                      /* below the face */
  double slid; /* work of friction at the last evaluation, of both sides of each pair */
} ContactRow;

typedef struct Contact {
  const ContactSpec *spec; /* NULL: there is no contact */
  const Body *body;
  const Family *family;
  double *young;    /* [blocks] */
  double *constant; /* [blocks] of a bond: force per volume squared and stretch */
  uint8_t *touched; /* [places] a bond of this particle may be missing */
  int32_t *row_of;  /* [places] or -1 */
  ContactRow *rows;
  int32_t row_count, row_capacity;
  double stiffest;      /* the most that contact adds to an eigenvalue */
  double margin;        /* how far the rows reach beyond any contact */
  double travelled;     /* sum of largest motions since the rows were made */
  int committed;        /* which grips are committed */
  double friction_work; /* dissipated by friction up to the last commit */
  bool failed;          /* memory was out */
} Contact;

/** @param[in] whole  bonds are as stiff as in a whole family wherever they are
 *  @param[in] bonds  share of that which former bonds carry: of the formulation
 *  @param[in] young  [blocks] Young's modulus of each block; copied */
int contact_create(Contact *contact, const ContactSpec *spec, const Body *body, const Family *family, Space space,
                   bool whole, double bonds, const double *young, Error *error);
void contact_destroy(Contact *contact);

/** Tells that the bond between two places is gone. */
void contact_bond_broke(Contact *contact, int32_t a, int32_t b);
/** Tells that it is there again, as if it had never broken. */
void contact_bond_mended(Contact *contact, int32_t a, int32_t b);

/** Finds the pairs again. */
void contact_search(Contact *contact);

/** Tells that no particle has moved by more than `motion`; finds the pairs again if need be. */
void contact_follow(Contact *contact, double motion);

/** Adds the forces per volume on the particles, by all threads; trial state only. */
void contact_resist(Contact *contact);

/** Makes what the last evaluation found the committed state, and adds the work of friction. Called by one thread. */
void contact_commit(Contact *contact);

/** The most that contact adds to the largest eigenvalue of stiffness over mass. */
double contact_eigenvalue(const Contact *contact);

/** The row of what contact remembers; bonds and displacements stand before it. */
void contact_state(Contact *contact, StateList *list);

/** The committed state as numbers, to be saved: of a pair that broke when pressed, and of one that friction holds. @return how many, or -1
 *  @param[out] numbers  to be freed; NULL if there are none */
int64_t contact_save(const Contact *contact, double **numbers);
/** Takes it up again, when displacements and bonds are as they were. @return nonzero if the numbers cannot be those of this body */
int contact_resume(Contact *contact, const double *numbers, int64_t count);

#endif
