/* Particles that no bond joins keep each other off: two bodies that meet, and the faces of a crack that closes.
 *
 * Two particles nearer than d_c repel each other with a force per volume squared of c_s (d_c - |Y|) / delta along Y (Parks et al. 2008), where
 * c_s is a multiple of the micromodulus and d_c the smaller of a share of their reference distance and some spacings; so that
 * nothing happens at rest, nor when a bond breaks. Pairs that may come so near are kept in rows, by number, and found again when particles have
 * moved by half of what the rows reach beyond d_c; what they do not hold repels nobody, so that it does not show when they were made. */
#ifndef BRECCIA_CONTACT_CONTACT_H
#define BRECCIA_CONTACT_CONTACT_H

#include "constitutive/material.h"
#include "family/family.h"

typedef struct ContactSpec {
  SectionHead head;
  double stiffness, distance, share;
} ContactSpec;

extern const Section contact_section;

typedef struct ContactPair {
  int32_t neighbour; /* place */
  double distance;   /* d_c */
} ContactPair;

typedef struct ContactRow {
  int32_t place, count, capacity;
  ContactPair *pairs; /* ascending by number of the neighbour */
} ContactRow;

typedef struct Contact {
  const ContactSpec *spec; /* NULL: there is no contact */
  const Body *body;
  const Family *family;
  double *constant; /* [blocks] c_s / delta */
  uint8_t *touched; /* [places] a bond of this particle may be missing */
  int32_t *row_of;  /* [places] or -1 */
  ContactRow *rows;
  int32_t row_count, row_capacity;
  double margin;    /* how far the rows reach beyond d_c */
  double travelled; /* sum of largest motions since the rows were made */
  bool failed;      /* memory was out */
} Contact;

/** @param[in] constant  [blocks] micromodulus of each block over delta; copied */
int contact_create(Contact *contact, const ContactSpec *spec, const Body *body, const Family *family,
                   const double *constant, Error *error);
void contact_destroy(Contact *contact);

/** Tells that the bond between two places is gone. */
void contact_bond_broke(Contact *contact, int32_t a, int32_t b);

/** Finds the pairs again. */
void contact_search(Contact *contact);

/** Tells that no particle has moved by more than `motion`; finds the pairs again if need be. */
void contact_follow(Contact *contact, double motion);

/** Adds the forces per volume on the particles, by all threads. */
void contact_resist(const Contact *contact);

/** The most that contact adds to the largest eigenvalue of stiffness over mass: five neighbours in front of a particle. */
double contact_eigenvalue(const Contact *contact);

#endif
