/* What the files of contact share: pairs and their search (contact.c), faces and frames (faces.c), energy and forces of pairs (press.c), friction
 * (friction.c), changes of forces (tangent.c), what a checkpoint holds (contact_state.c). */
#ifndef BRECCIA_CONTACT_PARTS_H
#define BRECCIA_CONTACT_PARTS_H

#include "contact/contact.h"

/** A pair as it stands; direction as in ContactPair, all per volume squared. */
typedef struct Press {
  bool central;                     /* its own direction is the normal */
  double way[3];                    /* to the higher end */
  double normal[3], long_normal[3]; /* unit; as the frames of both ends make it */
  double across, gap;               /* distance along the normal; rest less it */
  double square;                    /* of the distance along the face */
  double stiffness, slope;          /* and its derivative by that square; 0 unless the gap is above 0 */
  double energy;
} Press;

static inline double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Takes from a vector what it has along a unit normal. */
static inline void flatten(const double normal[3], double v[3])
{
  const double along = dot(normal, v);
  for (int k = 0; k < 3; ++k) v[k] -= along * normal[k];
}

/** @return false if the vector has no length */
static inline bool make_unit(double v[3])
{
  const double size = __builtin_sqrt(dot(v, v));
  for (int k = 0; k < 3 && size > 0; ++k) v[k] /= size;
  return size > 0;
}

static inline const Lattice *contact_lattice(const Contact *c, int32_t place)
{
  return &c->body->lattices[c->body->particles.block[place / SLICE]];
}

static inline void reference_way(const Particles *p, int32_t a, int32_t b, double way[3])
{
  for (int k = 0; k < 3; ++k) way[k] = p->position[k][b] - p->position[k][a];
}

static inline void present_way(const Particles *p, double *const *u, int32_t a, int32_t b, double way[3])
{
  for (int k = 0; k < 3; ++k) way[k] = p->position[k][b] - p->position[k][a] + (u[k][b] - u[k][a]);
}

/* Pairs (contact.c). */
ContactRow *contact_row_for(Contact *c, int32_t place);
/** The pair of a place with a neighbour, made if it is not there. @return NULL if memory is out */
ContactPair *contact_pair_for(Contact *c, int32_t place, int32_t neighbour);
/** Removes all pairs that are no former bonds. */
void contact_forget_pairs(Contact *c);

/* State (contact_state.c). */
/** Before pairs or rests change in a step: keeps them, once. */
void contact_keep(Contact *c);

/* Faces (faces.c). */
/** Finds the shape of the family of a row, if it has changed, and how it is deformed. */
void contact_find_frame(const Contact *c, double *const *u, ContactRow *row);
/** Adds the face of a cut, once. */
void contact_add_cut(ContactRow *row, const double normal[3], double level, double tolerance);
/** Adds the other faces: of lost bonds, open sides; and the depth below them. */
void contact_find_faces(const Contact *c, ContactRow *row);
/** Chooses the face between both ends of a pair that does not press, and its rest. */
void contact_choose(const Contact *c, double *const *u, const ContactRow *row, const ContactRow *other,
                    ContactPair *pair);
/** Which plane of a cut parts two rows: one of their faces in which they lie against each other; or -1. */
int contact_common_cut(const Contact *c, const ContactRow *row, const ContactRow *other);

/* Energy (press.c). */
/** How far apart the ends of a pair are at most when it presses. */
double contact_reach(const Contact *c, const ContactPair *pair, int32_t place);
/** Largest distance at which pairs across a cut touch, and of faces that meet. */
double contact_cut_reach(const Contact *c);
double contact_met_reach(double spacing);
/** The pair as it stands, or with the frames before bonds broke. @return whether it presses */
bool contact_press(const Contact *c, double *const *u, const ContactRow *low, const ContactRow *high,
                   const ContactPair *pair, bool before, Press *press);
/** The same of a pair that presses or whose ends are no further apart than a share of their rest beyond it; without energy. */
bool contact_touch(const Contact *c, double *const *u, const ContactRow *low, const ContactRow *high,
                   const ContactPair *pair, double apart, Press *press);
/** From the derivative a by cof(F) N that by F, times the shape of the family: what the family is pulled with. */
void contact_find_pull(const double f[9], const double shape[9], const double a[9], double pull[9]);
/** Adds what the steps of joints do to arrays of forces per volume, by all threads. */
void contact_spread_change(Contact *c, double *const change[3]);
/** Share of the constant of bonds that smoothed pairs across a cut have, so that together they are as stiff. */
double contact_smoothed(const Contact *c, int block);

/* Friction (friction.c). */
/** The spring of a pair as it stands, under its limit. @return work of friction since `before` */
double contact_grip(const Grip *before, Grip *after, const Press *press, double friction);

#endif
