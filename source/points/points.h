/* Material points, and only they: rows of strain, stress and history, committed and trial, in runs of one material. Who owns the points knows
 * where they are: particles by place, bonds by their rows in a list (family/bond_list.h).
 *
 * Points take six strains or one. Of six components strain and stress are arrays over rows; of one they exist only while they are worked
 * on. Histories are rows per point, because a law with a long history touches little of it. Commit is a swap. Plane stress, points that
 * cannot be integrated, and laws in other processes stay behind points_update. */
#ifndef BRECCIA_POINTS_POINTS_H
#define BRECCIA_POINTS_POINTS_H

#include "body/body.h"
#include "constitutive/material.h"

enum {
  BATCH = 128
}; /* points worked on together, at most: their strains, stresses and states stay in the first-level cache */

/** Rows first .. first + count - 1, of one material. */
typedef struct PointsRun {
  int material;
  int64_t first, count;
} PointsRun;

/** Step under way, as laws see it. The domain has one for all points; laws respond elastically in an elastic stage. */
typedef struct StepClock {
  double time, time_step; /* time at its end; its length, 0 between two steps */
  bool elastic_stage;
} StepClock;

/** Where secants are told in the place of tangents. */
typedef enum Secants {
  SECANTS_OF_NONE,
  SECANTS_OF_BONDS, /* of points of one strain, instead of a slope below zero */
  SECANTS_OF_ALL, /* and of points of six components whose law softens: the first moduli, by the share of them that is left */
} Secants;

/** Where points stand, for laws that ask (breccia_batch). All arrays NULL: no law asks. */
typedef struct PointPlaces {
  int32_t *particle[2];               /* [rows] each */
  double *position[3], *direction[3]; /* [rows] each; direction NULL for points of particles */
} PointPlaces;

typedef struct PointServers PointServers; /* laws in other processes (points/servers.c) */
typedef struct Untouched Untouched;       /* rows that remember nothing yet (points/untouched.c) */

typedef struct Points {
  int components; /* 6 or 1; 0: there are no points, because all laws are linear */
  bool plane_stress;
  bool on_bonds;      /* rows are those of a bond list; otherwise rows of points with six components are places */
  bool takes_lateral; /* one component: strain[1] of updates is the elongation by pressure across (breccia_batch) */
  int64_t count;
  double *strain[6], *stress[6]; /* [count] of points of six components; NULL: points_keep_tensors */
  bool shares;                   /* these arrays, with other points */
  double *stress_before[6];      /* [count] while points_put_by has room */
  bool exchanged;                /* these have changed places with `stress` */
  /** [count] what their law is given beside the strain of displacements: the strain at which it has the stress under which they begin, less their free
   *  strain. Of six components NULL where there is none; the first is always there if any is. Borrowed */
  double *initial[6];
  double *committed, *trial;
  size_t history_size; /* numbers in each of them */
  Untouched *untouched;
  PointsRun *runs; /* [run_count], in order; rows between them are of no use */
  int64_t run_count;
  int64_t *history_first; /* [run_count] */
  const Material *materials;
  int material_count;
  double *tangent;         /* [rows of laws that are not linear][36], once they were kept; NULL before */
  int64_t *tangent_first;  /* [run_count] where those of a run begin; -1: its law is linear */
  double *elastic_tangent; /* [materials][36] of linear laws theirs, of others by their first moduli */
  double elastic_weight;   /* of elastic tangents in those that are told, 0 to 1; the rest is as kept */
  bool keeps_tangents;
  Secants secants;
  uint8_t
      *gave_up; /* [count] 1: the law could not be integrated, and the point carries nothing; NULL: that is a failure */
  const StepClock *clock; /* borrowed */
  double length[BATCH];   /* over which laws spread a fracture energy, alike for all points; NaN: unknown */
  PointPlaces places;     /* borrowed */
  const double *strength; /* [count] factor s of each row: stress(strain) = s law(strain / s); borrowed. NULL: 1 */
  PointServers *servers;  /* NULL: no law is remote */
  double *identity;       /* by which the servers are found again after a restart */
  size_t identity_size;
} Points;

/** Whether strains and stresses of points of six components stand in rows. Otherwise laws are Hooke's, and the formulation finds both itself. */
static inline bool points_keep_tensors(const Points *points)
{
  return points->strain[0] != NULL;
}

/** Component k of the strain that the law of a row is given. */
static inline double points_whole_strain(const Points *points, int64_t row, int k, double strain)
{
  return points->initial[k] ? strain + points->initial[k][row] : strain;
}

/** Whether rows are places, and strain and stress are those of particles. */
static inline bool points_on_particles(const Points *points)
{
  return points->components == 6 && !points->on_bonds;
}

typedef struct PointsSpec {
  int components;
  bool plane_stress, on_bonds, takes_lateral;
  bool no_tensors;       /* the formulation finds strains and stresses itself: laws are Hooke's */
  const PointsRun *runs; /* borrowed while points are made */
  int64_t run_count;
  const Material *materials; /* borrowed for good */
  int material_count;
  double *const *strain, *const *stress; /* [6] arrays to share with other points, of six components; NULL: their own */
  const StepClock *clock;                /* borrowed for good; NULL: a constant clock at time 0 */
  const uint8_t *present;                /* [rows] 0 where a row has no point; NULL: all have one */
  bool may_give_up;                      /* points that cannot be integrated are marked and carry nothing */
  double length;
  PointPlaces places;     /* borrowed for good; zeros: nobody asks */
  const double *strength; /* [rows] borrowed for good; NULL: 1 */
} PointsSpec;

int points_create(Points *points, const PointsSpec *spec, Error *error);
void points_destroy(Points *points);

/** A row whose law does not bear the stress under which it was to begin, and the one to which it came; -1: there is none. */
typedef struct InitialMisfit {
  int64_t row;
  double reached[6];
} InitialMisfit;

/** Lets points of six components, none of them in a server, begin under stress. Laws are led to it elastically, and by their own path where it is
 *  beyond yielding; what they remember of that is their first history.
 *  @param[in] stress   [6][count] to begin under; rows of zeros begin as they are
 *  @param[out] strain  [6][count] zeros before: of each row the strain at which its law has that stress; kept by the caller as long as the points
 *  @return BRECCIA_USER_ERROR without a message for a misfit */
int points_begin_under(Points *points, double *const stress[6], double *const strain[6], InitialMisfit *misfit,
                       Error *error);

/** Whether a law in space keeps a stress to which it was led elastically, as in an elastic stage. Not for laws in servers. */
bool points_law_keeps(const Material *material, const double stress[6]);

/** Whether what must always hold of points does: runs in order, the last one up to the last row, histories behind each other. */
bool points_is_valid(const Points *points);

/** The run of a row. */
int64_t points_run(const Points *points, int64_t row);
const Material *points_material(const Points *points, int64_t row);
/** Committed history of a row. */
const double *points_history(const Points *points, int64_t row);
/** Sets value k of the committed history of a row. The trial history follows in the next evaluation. */
void points_note(const Points *points, int64_t row, int k, double value);

/** The one door to laws: stress, trial history and, where they are kept, tangents of `count` rows, of one run and at most BATCH. In plane
 *  stress the strain zz is found such that the stress zz vanishes.
 *  @param[in,out] strain, stress  [components][count]
 *  @return -1, or a row whose law could not be integrated */
int64_t points_update(Points *points, int64_t first, int count, double *const strain[6], double *const stress[6]);

/** Makes or frees the room in which points_put_by leaves stresses. */
int points_keep_stresses(Points *points, bool keep, Error *error);
/** Puts stresses by before a step, whose updates then write into other arrays; and takes them back, with those of the step put by. Nothing happens
 *  where there is no room for them. */
void points_put_by(Points *points);
/** After steps: stresses stand in the arrays again in which they stood when room was made. */
void points_put_back(Points *points);

/** Makes points of six components keep the tangents of their next updates, or no longer. Of linear laws one is kept for all their points; points of one
 *  strain keep none (points_try). */
int points_keep_tangents(Points *points, bool keep, Error *error);
/** The tangent of a row of six components as kept, and by the elastic weight, [6][6]; in plane stress the rows and columns of zz are condensed out.
 *  0 if there is none. */
void points_tangent(const Points *points, int64_t row, double *tangent);
size_t points_tangent_bytes(const Points *points);
/** Bytes of what points_keep_stresses makes room for. */
size_t points_kept_bytes(const Points *points);
/** Changes of the stresses of `count` rows of six components with changes of their strains, by their tangents. */
void points_change(const Points *points, int64_t first, int count, double *const strain[6], double *const stress[6]);

/** Stress of a point of one strain; histories stay as they are.
 *  @param[in] lateral   elongation by the pressure across the bond (breccia_batch); 0: none
 *  @param[out] tangent  its slope, and by the elastic weight Young's modulus; NULL: not wanted. A law in a server is not asked: its last stress, over the strain */
double points_try(const Points *points, int64_t row, double strain, double lateral, double *tangent);
/** Stresses and slopes of `count` rows of one strain, of one run and at most BATCH, whose law runs in a server, which is asked: a trial like that of
 *  points_update. Slopes are those that the law tells (points_mixed_slope).
 *  @return -1, or a row whose law could not be integrated */
int64_t points_ask_slopes(Points *points, int64_t first, int count, double *strain, double *stress, double *slope);
/** The slope that points_try tells, of one that the law has told at a strain and its stress: a secant in its place, and the elastic weight. */
double points_mixed_slope(const Points *points, int64_t row, double strain, double stress, double slope);
/** Stress of a point of six strains at a strain, from its committed history, which stays. In plane stress the strain across it is found.
 *  @return false where nobody can tell without a trace (laws in servers, very long histories), or the law gives up */
bool points_try_stress(const Points *points, int64_t row, const double strain[6], double stress[6]);

/** Energy per volume that a point in space would give back if it unloaded with its first moduli. */
double points_elastic_energy(const Points *points, int64_t row);
/** The same of a material at a stress. */
double points_energy_at(const Material *material, const double stress[6]);

/** Share of the elastic energy of its stress that a point in space would give back, over that of an undamaged one: 1 where it
 *  unloads with its first moduli, more where damage has made it softer. Laws in servers are taken to unload elastically. */
double points_softness(const Points *points, int64_t row);

/** Elastic strain of a point of one strain: its stress over the slope at which the law unloads. It has the sign of the stress.
 *  @param from  strain at which its law carried nothing at first: 0, but for steel that begins under stress */
double points_elastic_strain(const Points *points, int64_t row, double strain, double lateral, double from);

/** True if no law dissipates or remembers: stresses are those of the strains, to the bit. */
bool points_are_linear(const Points *points);

/** Rows of strains, stresses, histories, and of what servers hold. @param[in] of  put behind their names, or NULL */
void points_state(Points *points, const char *of, StateList *list);

/** Commits the lengths by crack normal of rows whose damage begins in the trial state (constitutive/normal_lengths.h).
 *  @return number of rows that had no length before */
int64_t points_take_lengths(Points *points);
/** Clears the lengths that points_take_lengths has committed since the last points_commit. */
void points_drop_lengths(Points *points);

/** Makes the trial state the committed one. */
void points_commit(Points *points);
/** The committed state was put in place from outside: makes the trial one the same. */
void points_take_up(Points *points);

/* ---- laws that run in other processes (constitutive/remote); nothing happens where none does ---- */

/** Makes the points in the servers: nothing was strained yet. */
int points_begin(Points *points, Error *error);
/** Asks the servers of points of one strain, all of which are there and were not strained yet, what they carry without any, and notes it in their
 *  histories: what they answer by in elastic stages, and what points_try tells. */
int points_ask_first_stresses(Points *points, Error *error);
/** Brings histories and `identity` up to date, to be saved. */
int points_save(Points *points, Error *error);
/** Takes up servers and their points from histories and `identity` as they were saved. */
int points_resume(Points *points, Error *error);
/** Whether servers are to be asked for all points at once: then all strains are sent with points_send and the answers awaited with points_await,
 *  by one thread, before points_update gives them out. */
bool points_ask_ahead(const Points *points);
/** Sends strains of `count` rows of one run; those of a server go out when the last of them is there. */
void points_send(Points *points, int64_t first, int count, double *const strain[6]);
void points_await(Points *points);
/** Whether all that points remember can still be saved: not, when a server is lost that remembers for them. Reaches servers
 *  again if one did not answer as it should. */
bool points_can_save(Points *points);
/** A line per server: points per second, waiting, bytes; as objects of a JSON list if `json`. */
void points_report(const Points *points, double run_seconds, bool json, Text *text);
/** What went wrong in a server, one line; "" if nothing did. */
const char *points_problem(const Points *points);

#endif
