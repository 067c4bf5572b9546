/* Material points: strain, stress and history, committed and trial.
 *
 * Points stand on particles, one per place, or on bonds, one per lane of a slot, on both sides of a bond. On particles strain and
 * stress are arrays by component; on bonds they exist only while they are worked on. Histories are rows per point, because a law with a
 * long history touches little of it. All points of a slice are of one material; a stored slot of bonds has a second row of
 * points for the material at their other ends, if the body has several. Commit is a swap. */
#ifndef BRECCIA_CONSTITUTIVE_POINTS_H
#define BRECCIA_CONSTITUTIVE_POINTS_H

#include "constitutive/material.h"
#include "family/family.h"

enum { BLOCK = 128 }; /* points worked on together: their strains, stresses and states stay in the first-level cache */

/** Where points are: nowhere if laws act on bonds and all are linear. */
typedef enum PointsWhere { POINTS_NOWHERE, POINTS_ON_PARTICLES, POINTS_ON_BONDS } PointsWhere;

/** Bonds whose laws are in servers are gone through twice: strains are gathered and sent, then answers are given out. */
typedef enum PointsPass { PASS_NONE, PASS_GATHER, PASS_ANSWER } PointsPass;

typedef struct Points {
  PointsWhere where;
  Space space;
  int64_t places;
  double *strain[6],
      *stress[6]; /* [places]; if points are not on particles, what domain_observe has found, NULL before */
  double *committed, *trial;
  size_t history_size;    /* numbers in each of them */
  int64_t *history_start; /* [slices] */
  int partner_values;     /* numbers of a bond's point of the other end's material */
  const Material *materials;
  int material_count;
  const int32_t *material; /* [slices] */
  const Family *family;
  int32_t *server; /* [slices] which of its material's servers holds the points of a slice; NULL: no law is remote */
  int64_t **
      starts; /* [material_count], of each: first point of each of its servers, and behind the last; NULL: not remote */
  double *identity; /* by which the servers are found again after a restart */
  size_t identity_size;
  PointsPass pass;
  double *tangent; /* [places][36] of points on particles, once they were kept; NULL before */
  bool keeps_tangents;
  int elastic_stage; /* laws respond elastically while it is set */
  uint8_t *
      gave_up; /* [places] 1: the law could not be integrated, and the point carries nothing; NULL: that is a failure */
} Points;

typedef struct PointsSpec {
  PointsWhere where;
  Space space;
  const Family *family;
  const Material *materials;
  int material_count;
  const int32_t *material; /* [slices] which of the materials; all arrays are borrowed */
  bool may_give_up;        /* points that cannot be integrated are marked and carry nothing */
} PointsSpec;

int points_create(Points *points, const PointsSpec *spec, Error *error);
void points_destroy(Points *points);

/** Makes the arrays of strains and stresses, if they are not there. */
int points_show(Points *points, Error *error);

/** Stress and trial history of slices first .. last - 1 from their strains, of points on particles; the slices must be of one material
 *  and at most BLOCK places. In plane stress the strain zz is found such that the stress zz vanishes.
 *  @param[out] tangent  [places][36] or NULL; in plane stress the rows and columns of zz are condensed out
 *  @return -1, or a place whose law could not be integrated */
int64_t points_update(Points *points, int64_t first, int64_t last, double *tangent);

/** Stress and trial history of the bonds of `count` slots of a slice, of points on bonds.
 *  @param[in] strain   [count][8]
 *  @param[out] stress  [count][8]
 *  @return -1, or a place whose law could not be integrated */
int64_t points_update_bonds(Points *points, int64_t slice, int64_t slot, int count, const double *strain,
                            double *stress);

/** The same for one lane of a stored slot, by the law at the other end. */
int64_t points_update_partner(Points *points, int64_t slice, int64_t slot, int lane, double strain, double *stress);

/** Stress of one bond at a strain by the law of its own end or of the other (of stored slots); histories stay as they are.
 *  @param[out] tangent  its slope; NULL: not wanted. Of laws in servers stress over strain */
double points_bond_stress(const Points *points, int64_t slice, int64_t slot, int lane, bool partner, double strain,
                          double *tangent);

/** Makes points on particles keep the tangents of their next updates, or no longer. */
int points_keep_tangents(Points *points, bool keep, Error *error);
/** The tangent kept of a point on a particle, [6][6]; 0 if there is none. */
void points_tangent(const Points *points, int64_t place, double tangent[36]);
/** Changes of the stresses of slices first .. last - 1 with changes of their strains, by the tangents kept; both [6][places of the slices]. */
void points_change(const Points *points, int64_t first, int64_t last, double *const strain[6], double *const stress[6]);

/** Share of the elastic energy of a stress that a point on a particle would give back, over that of an undamaged one: 1 where it
 *  unloads with its first moduli, more where damage has made it softer. Laws in servers are taken to unload elastically. */
double points_softness(const Points *points, int64_t place);

/** Share of the stretch of a bond that is elastic, 0 to 1: stress over strain, seen over the slope at which the law unloads. */
double points_bond_elastic_share(const Points *points, int64_t slice, int64_t slot, int lane, double strain);

/** Mean over the intact bonds of a place of history number k of its own law, as committed. */
double points_bond_history(const Points *points, int64_t place, int k);

/** True if no law dissipates or remembers: stresses are those of the strains, to the bit. */
bool points_are_linear(const Points *points);

/** Makes the trial state the committed one. */
void points_commit(Points *points);

/** Rows of strains, stresses, histories, and of what servers hold. Of points on bonds, strains and stresses are only shown. */
void points_state(Points *points, StateList *list);

/* ---- laws that run in other processes (constitutive/remote); nothing happens where none does ---- */

/** Whether the servers have their points. */
bool points_begun(const Points *points);
/** Makes the points in the servers: nothing was strained yet. */
int points_begin(Points *points, Error *error);
/** Brings histories and `identity` up to date, to be saved. */
int points_save(Points *points, Error *error);
/** Takes up servers and their points from histories and `identity` as they were saved. */
int points_resume(Points *points, Error *error);
/** Writes strains of slices first .. last - 1, of one material and server, to where they are sent from. */
void points_pack(Points *points, int64_t first, int64_t last);
/** Sends the strains of all points of a material in a server. */
void points_post(Points *points, int material, int server);
/** Waits for their stresses. @return -1, or the place of a point whose law failed */
int64_t points_collect(Points *points, int material, int server);
/** Stresses of slices first .. last - 1 out of what was collected. */
void points_unpack(Points *points, int64_t first, int64_t last);
/** Begins a step of bonds: if pass is PASS_GATHER then, they are to be gone through to gather their strains, and points_ask_bonds called by
 *  one thread, before points_update_bonds gives stresses. */
void points_gather_bonds(Points *points);
/** Sends what was gathered and waits for all answers. @return -1, or a place of a bond whose law failed */
int64_t points_ask_bonds(Points *points);
/** Whether all that points remember can still be saved: not, when a server is lost that remembers for them. Reaches servers
 *  again if one did not answer as it should. */
bool points_can_save(Points *points);
/** A line per server: points per second, waiting, bytes; as objects of a JSON list if `json`. */
void points_report(const Points *points, double run_seconds, bool json, Text *text);
/** What went wrong in a server, one line; "" if nothing did. */
const char *points_problem(const Points *points);

#endif
