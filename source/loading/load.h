/* Loads: forces on particles, and motions prescribed to them. Each kind of load is a table entry (load/loads.h). */
#ifndef BRECCIA_LOADING_LOAD_H
#define BRECCIA_LOADING_LOAD_H

#include "body/selection.h"
#include "constitutive/material.h"
#include "family/family.h"
#include "forces/forces.h"
#include "formulation/operator.h"
#include "loading/history.h"

/** What stands under the key of a load. */
typedef union LoadValue {
  double number;
  double point[3];
  const char *text;
  void *section;
} LoadValue;

enum {
#define LOAD(name, key, kind, dimension, meaning) LOAD_##name,
#include "loading/load/loads.h"
  LOADS
};

typedef enum LoadSpread { SPREAD_BY_BONDS, SPREAD_OVER_LAYERS } LoadSpread;
typedef enum LoadPlaten { PLATEN_TURNS, PLATEN_FIXED } LoadPlaten;

typedef struct LoadSpec {
  SectionHead head;
  const char *name;
  Reference on;
  LoadValue of[LOADS]; /* exactly one is given */
  HistorySpec *history;
  double area, centre[3];
  int spread, platen; /* LoadSpread, LoadPlaten; -1: not given */
  bool only_presses;
} LoadSpec;

extern const Section load_section;

typedef struct LoadType LoadType;

/** What forces against velocities need of a step under way. */
typedef struct LoadMotion {
  double *const *velocity; /* [3][places]; NULL: the body is at rest, and they do not act */
  double lag;              /* by which these velocities are before the displacements */
  double damping;          /* mass-proportional, that acts until then [1/time] */
  double
      rate; /* what the velocity at the end of a step changes with the displacement there; 0 where none is solved for */
} LoadMotion;

/** Where loads put the strains that bodies begin from. */
typedef struct LoadStrains {
  double *of_places; /* [places]; NULL: no load has any */
  int64_t places;
  double *of_bars; /* [bars]; NULL: there are none */
  int bar_count;
} LoadStrains;

typedef struct Load {
  const LoadType *type;
  const LoadSpec *spec;
  const LoadValue *value;
  const Node *node;           /* of the value in the deck */
  Selection selection, other; /* `other`: what it joins these to, or those behind them on which it acts too */
  double volume;              /* of the selected particles */
  int64_t first, behind;      /* acts in the stages first .. behind - 1 */
  double begin;               /* time of the run from which its history counts */
  History history;
  double applied; /* factor at which its strains were put last; NaN: not since they were put elsewhere */
  LoadMotion motion;
  uint8_t *
      held; /* [particles] bits of the axes along which motions are prescribed in the stage under way; of types that brake */
  void *own; /* what the type keeps */
} Load;

enum { MAX_LEADERS = 3 };

/** A rigid plate on the particles of a load that turns freely about its centre (loading/platen.h). The motion along the
 *  direction of the constraint is
 *    u_i = (1 - sum_m S_im) U + sum_m S_im u_m
 *  with the prescribed motion U of the centre and the free motions u_m of one leading particle, in space of two. While
 *  with the prescribed motion U of the centre and the free motions u_m of the leaders: one leading particle in the
 *  plane, two in space. After a one-sided platen has let go, U is free, too, and one more particle leads. */
typedef struct Platen {
  int leaders; /* number of leaders while U is prescribed */
  /** Indices of the leaders among the particles of the load; the entry behind `leaders` leads once U is free. */
  int64_t leader[MAX_LEADERS];
  double *share[2];           /* [particles of the load] S_im. Owned */
  double *loose[MAX_LEADERS]; /* [particles of the load] S_im once U is free; NULL: U is never free. Owned */
  double given;               /* acceleration of the centre at the end of the last step */
  /** Jump of the velocity of a centre that strikes in the current explicit step; part of it at the end of the step. 0:
   *  none. */
  double strikes, still;
  bool opens; /* the platen has let go in the current explicit step */
  /** The platen closes in the current implicit step. Velocity and acceleration are those that the scheme gives the
   *  centre at the end of the step. */
  bool closes;
  double velocity, acceleration;
} Platen;

/** One-sided part of a constraint: the constraint holds while it presses on the body, and lets go where it would pull
 *  (loading/one_sided.h). A platen lets go as a whole and has one entry; otherwise each particle has an entry. */
typedef struct OneSided {
  int64_t count;   /* number of entries */
  double pushes;   /* 1 or -1: the constraint pushes along its direction or against it */
  uint8_t *open;   /* [count] 1: the entry has let go. Owned */
  double *presses; /* [count] force with which an entry presses, 0 or more, at the last accepted step. Owned */
  double *found;   /* [count] force at the last evaluation of forces; negative: the entry pulls. Owned */
} OneSided;

/** Motions prescribed to the particles of a load: u . direction = from + value times the history, or its integral, + share of that of
 *  another particle. */
typedef struct Constraint {
  Load *load;
  int row; /* of motion from which its direction counts: 0 of displacements, that of the first rotation of rotations */
  double direction[3]; /* unit vector; of rotations in the plane the first is about z */
  double value;
  int order;             /* of its integral over time: 0 a displacement, 1 a velocity, 2 an acceleration */
  double *from;          /* [particles of the load] what stood there when the load began; NULL: 0 */
  double *part;          /* [particles of the load] by which `value` is multiplied there; NULL: 1. Owned */
  double largest_part;   /* of their sizes */
  const int32_t *images; /* [particles of the load] places of the others, which take no force from it; NULL: none */
  double share;          /* 1 or -1 */
  double *moved;         /* [particles of the load] in the step under way; with images or a platen only. Owned */
  Platen *platen;        /* NULL: the particles do not turn. Owned */
  OneSided *one_sided;   /* NULL: the constraint presses and pulls. Owned */
} Constraint;

/** Particles whose motions along an axis are one. */
typedef struct TieGroups {
  int64_t count;
  int64_t *first;  /* [count + 1] group g is places first[g] .. first[g + 1] - 1 */
  int32_t *places; /* ascending within each group */
} TieGroups;

/** What a stage of the run changes in the loads. */
typedef struct LoadStage {
  const SectionList *loads; /* that begin with it; one of the name of an earlier load takes its place */
  const TextList *without;  /* names of earlier loads that end */
  const void *section;      /* of the deck, for messages */
} LoadStage;

typedef struct Loading {
  int64_t stage; /* under way */
  int count;
  Load *loads;
  Constraint *constraints;
  int constraint_count;
  TieGroups ties[3]; /* of the stage under way, along each axis */
  bool speeds_set;   /* loads that began with it have changed velocities */
} Loading;

/** What a load comes to on a body: words with a quantity behind them. */
typedef struct LoadWords {
  const char *words;            /* NULL: nothing to tell */
  double value;                 /* in the deck's units */
  const char *dimension, *unit; /* and that unit of the SI to show it in */
  double direction[3];          /* unit vector; 0: none to tell */
} LoadWords;

/** How an even stress acts on marked places, as FormulationType.even_stress says it; NAN where that is not known. */
typedef struct EvenStress {
  void (*find)(const void *domain, const uint8_t *marked, double *const area[3]);
  const void *domain;
  /** Computes the force per volume on all particles along an axis in a uniform uniaxial stress of 1 along that axis.
   *  @param[out] force  [places]
   *  @return BRECCIA_OK, or BRECCIA_FAILURE if memory is exhausted */
  int (*pull)(void *model, int axis, double *force, Error *error);
  void *model;
} EvenStress;

/** What the making of loads needs. */
typedef struct LoadMaking {
  Loading *loading;
  const Body *body;
  const Family *family;
  EvenStress even_stress;
  const DeckReader *reader;
  const SectionList *selections;
  const Material *materials;
  const int32_t *material; /* [slices] number of each one's */
  const Forces *forces;    /* beside those of bonds; NULL: there are none */
} LoadMaking;

struct LoadType {
  bool everywhere; /* on the whole body where the deck does not say on what */
  bool timeless;   /* it has no history */
  bool lasting;    /* it acts from the first stage to the last */
  bool goes_on;    /* its forces were there before it began */
  bool platen;     /* a platen may stand between what it prescribes and its particles */
  bool may_press;  /* the type accepts 'only presses' */
  /** Adds its constraints, and what it needs besides; its particles are known. May be NULL. */
  int (*create)(Load *load, const LoadMaking *making);
  void (*destroy)(Load *load);
  /** What must not point out of the space that the body has; NaN where nothing is prescribed. May be NULL. */
  const double *(*vector)(const LoadValue *value);
  /** Adds its forces per volume to the external ones, at displacements and velocities as held, by all threads. NULL: it is no force. */
  void (*force)(const Load *load, Particles *particles, double factor);
  /** Adds the strains that it has bodies begin from. By one thread. NULL: none. */
  void (*strain)(const Load *load, const LoadStrains *strains, double factor);
  /** Adds its forces per volume against velocities, after those of all other loads and at the internal forces held, by all threads. `time` is
   *  since it began. NULL: there are none. */
  void (*brake)(Load *load, Particles *particles, const LoadMotion *motion, double time);
  /** After a step in which particles have moved by `factor` times `moved`: takes what `brake` found last as what stands at its end, and books its
   *  work. By one thread; with `brake`. */
  void (*settle)(Load *load, const Particles *particles, double *const moved[3], double factor);
  /** Adds the force in all that it exerts on its particles in the state held, where that is no factor times a vector:
   * of springs and dashpots. `time` is since it began. NULL: it follows from `force`. */
  void (*exerts)(Load *load, const Particles *particles, double time, double force[3]);
  /** Energy that it has taken by braking. With `brake`. */
  double (*dissipated)(const Load *load);
  /** When it begins; forces are still those of the stage before. @return whether it has changed velocities. May be NULL. */
  bool (*begin)(Load *load, Particles *particles);
  /** Adds to changes of external forces per volume what they change with changes v of displacements. NULL: nothing. */
  void (*change)(const Load *load, const Particles *particles, double *const v[3], double *const change[3]);
  /** The same as points, numbered from 0, for matrices. NULL: there are none. */
  int64_t (*point_count)(const Load *load);
  int (*point)(const Load *load, const Particles *particles, int64_t number, Operator *point, Error *error);
  /** Energy that it holds and gives back. May be NULL. */
  double (*energy)(const Load *load, const Particles *particles);
  /** The most that it adds to an eigenvalue of stiffness over mass. May be NULL. */
  double (*eigenvalue)(const Load *load, const Particles *particles);
  /** Rows of what it remembers; `name` tells it from other loads. May be NULL. */
  void (*state)(Load *load, const char *name, StateList *list);
  /** What it comes to on this body, for people. May be NULL. */
  LoadWords (*tell)(const Load *load, const Particles *particles);
  /** What it prescribes at factor 1: the length of a vector, or a number with its sign. */
  double (*magnitude)(const LoadValue *value);
  /** What it prescribes at another factor. NULL: the factor times the magnitude. */
  double (*at_factor)(const LoadValue *value, double factor);
  /** What it is, where its key and the dimension in the list do not tell. May be NULL. */
  const char *(*kind)(const LoadValue *value, const char **dimension);
};

/** One load of a deck. `load` has its stages; destroy it in any case. */
int load_create(Load *load, const LoadSpec *spec, const LoadMaking *making);
void load_destroy(Load *load);

/** Resolves the loads of a deck on a body; says where a selection is empty or motions of one stage contradict each other.
 *  @param[in] making  with the loading
 *  @param[in] loads   those of the deck, from the first stage on */
int loading_create(const LoadMaking *making, const SectionList *loads, const LoadStage *stages, int stage_count);
void loading_destroy(Loading *loading);

/** Lets the loads of a stage act, those of other stages not. */
int loading_enter(Loading *loading, const Particles *particles, int64_t stage, Error *error);
/** Begins with the loads that are new in the stage under way: their histories count from this time, their motions from where the particles
 *  are. Particles that are tied from now on take their common velocity, by which no momentum is lost. Forces of loads that have ended are taken off. */
void loading_begin(Loading *loading, Particles *particles, double time);
/** Sets the velocities with which platens of the stage under way begin; in stages in motion, after loading_begin.
 *  @param[in] step  of the stage */
void loading_start_platens(Loading *loading, const Particles *particles, double time, double step);
/** Rows of when and where loads began that are not there from the start. */
void loading_state(Loading *loading, StateList *list);

/** Returns true if a load acts in a stage. */
static inline bool load_acts_in(const Load *load, int64_t stage)
{
  return load->first <= stage && stage < load->behind;
}
/** Whether a load acts in the stage under way. */
static inline bool load_acts(const Loading *loading, const Load *load)
{
  return load_acts_in(load, loading->stage);
}
/** Factor of a load at a time of the run. */
double load_factor(const Load *load, double time);

/** Lets loads that begin with the stage under way, and have no history of their own, grow along a straight line from 0 over this time. */
void loading_grow(Loading *loading, double time);

/** Sets the external force per volume of all particles to what the loads say at a time, by all threads; with ties, at the internal forces held. */
void loading_apply(const Loading *loading, Particles *particles, double time);

/** Sets it to what controlled loads say at factor 1, of their particles and of those of other loads; by all threads. */
void loading_apply_controlled(const Loading *loading, Particles *particles);

/** The same without what ties make of it, for those who give tied particles one displacement; by all threads. */
void loading_apply_untied(const Loading *loading, Particles *particles, double time);
/** Puts the strains that loads say at a time, unless they stand there already. By one thread. @return whether they are others */
bool loading_strain(Loading *loading, const LoadStrains *strains, double time);
/** They were put elsewhere meanwhile, and are put again the next time. */
void loading_forget_strains(Loading *loading);
/** Factor of a load at a time of the run; of one that begins with the stage under way as large as its history makes it first. */
double loading_grown_factor(const Loading *loading, const Load *load, double time);
/** Puts strains by these factors; loading_strain does not know of it. */
void loading_grown_strains(const Loading *loading, const LoadStrains *strains, double time);
/** Puts what strains have changed by since the stage under way began, at that time of the run; NaN: all of them. loading_strain does not know of it. */
void loading_changed_strains(const Loading *loading, const LoadStrains *strains, double begin, double time);
extern const LoadType gravity_load, strength_reduction_load;
/** Returns the axis of the largest component of the first gravity load, or -1 without one.
 *  @param[out] sign  1 where gravity acts against the axis, which then points up; else -1 */
int loading_gravity_axis(const Loading *loading, double *sign);
/** Returns the factor by which the loads of a stage divide strengths at a time of the run; 1: none does, as in stage -1,
 *  before the run. */
double loading_strength_reduction(const Loading *loading, int64_t stage, double time);
/** Whether a load of a deck is an initial strain of particles. */
bool load_strains_places(const LoadSpec *load);
extern const LoadType initial_strain_load;
/** Refuses a history whose factor a solver finds: what it says of forces does not hold of strains. */
int load_is_known(const Load *load, const LoadMaking *making, const char *what);

/** Adds changes of external forces per volume with changes v of displacements: of springs. By one thread.
 *  @param[in,out] change  [3][places] */
void loading_change(const Loading *loading, const Particles *particles, double *const v[3], double *const change[3]);

/** By all threads: gives tied particles one velocity and acceleration, where roundings or prescribed motions part them. */
void loading_keep_ties(const Loading *loading, Particles *particles, double *const acceleration[3]);

/** Tells loads that brake of the step under way. */
void loading_move(const Loading *loading, const LoadMotion *motion);
/** By one thread, at the end of a step or, with factor 0, at the start of a stage: LoadType.settle of all loads that act. */
void loading_settle(const Loading *loading, const Particles *particles, double *const moved[3], double factor);
/** Energy that loads have taken by braking, those that have ended too. */
double loading_dissipated(const Loading *loading);

/** Energy that springs hold. */
double loading_energy(const Loading *loading, const Particles *particles);
/** The most that loads of the stage under way add to the largest eigenvalue of stiffness over mass. */
double loading_eigenvalue(const Loading *loading, const Particles *particles);

/** Marks the particles whose motion is prescribed. @param[out] held  [places], zeros before */
void loading_mark_held(const Loading *loading, uint8_t *held);

/** What a load prescribes, as its key in the deck. @param[out] dimension  of its value */
const char *load_kind(const LoadSpec *load, const char **dimension);

/** What a load prescribes at factor 1: the length of its vector, or its number with its sign. */
double load_magnitude(const LoadSpec *load);

/** Returns what a load prescribes at a factor of its history, in the unit of load_kind: its magnitude times the factor;
 *  of a strength reduction the number by which strengths are divided. */
double load_value(const LoadSpec *load, double factor);

#endif
