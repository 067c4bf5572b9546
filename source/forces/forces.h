/* Forces between particles beside those of formulations. A kind is a table entry; nobody above this room knows which ones there are. Bodies
 * have the kinds whose section the deck has, and all of them are gone through in the order of the list. */
#ifndef BRECCIA_FORCES_FORCES_H
#define BRECCIA_FORCES_FORCES_H

#include "family/family.h"
#include "formulation/operator.h"
#include "points/points.h"

/** What they must know of a block of the body. */
typedef struct ForcesBlock {
  double young; /* modulus */
  double bonds; /* share of the stiffness of bonds calibrated in uniform expansion that bonds had before they broke */
  bool alike;   /* bonds are as stiff as in a whole family wherever they are */
} ForcesBlock;

/** What they are made for; borrowed. */
typedef struct ForcesParts {
  const Body *body;
  const Family *family;
  Space space;
  const StepClock *clock;    /* borrowed for good */
  const ForcesBlock *blocks; /* [blocks of the body], only while they are made */
  const DeckReader *reader;  /* the same */
  const Material *materials; /* those of the deck */
  int material_count;
} ForcesParts;

/** Each function may be NULL where there is nothing to do. */
typedef struct ForcesType {
  const char *name;
  bool rubs;   /* what they dissipate is friction; of others it is that of laws */
  bool strike; /* they may set in and end within a step or two, and works summed over such steps err by some per cent */
  /** Whether they need a material of the deck by its name. */
  bool (*uses)(const void *spec, const char *material);
  /** Whether the body takes what the deck says. @return status, after messages */
  int (*check)(const void *spec, const ForcesParts *parts);
  /** @param[out] forces  what `destroy` takes back; NULL, or what was there already where it fails, which is taken back too */
  int (*create)(const void *spec, const ForcesParts *parts, void **forces, Error *error);
  void (*destroy)(void *forces);
  /** Their own points, which are told the time and the stage like those of regions; NULL: there are none. */
  Points *(*points)(void *forces);
  /** Before the first step, when servers have their points. */
  int (*begin)(void *forces, Error *error);
  /** When a step has come out well: makes what laws have answered the committed state. By one thread. */
  void (*accept)(void *forces);
  /** Before the forces of a step: no particle has moved by more than `motion`. By one thread. */
  void (*follow)(void *forces, double motion);
  /** Before bonds break at the displacements held, by all threads. */
  void (*remember)(void *forces);
  /** The bond between two places is gone; or there again, as if it had never broken. */
  void (*bond_broke)(void *forces, int32_t a, int32_t b);
  void (*bond_mended)(void *forces, int32_t a, int32_t b);
  /** Takes back what a step that failed has changed, when its bonds are mended. */
  void (*undo)(void *forces);
  /** Displacements and bonds are others than they were. */
  void (*find_again)(void *forces);
  /** Adds the forces per volume on particles to `internal`, by all threads; trial state only.
   *  @param[in] displacement  [3] rows of displacements over places [length]
   *  @param[in,out] internal  [3] rows of forces per volume over places */
  void (*resist)(void *forces, double *const *displacement, double *const *internal);
  /* For solvers that iterate, which have no place for kinds without `change`. */
  /** Chooses at the displacements held what the next evaluation would, so that a state can be noted. By one thread. */
  void (*choose)(void *forces);
  /** How far parts of the body may move against each other from where the forces were last found again, until one might be missed. */
  double (*room)(const void *forces);
  /** After an evaluation: keeps what changes of forces need. By one thread. */
  void (*linearise)(void *forces);
  /** Adds changes of the forces per volume with changes v of displacements to arrays over places, by all threads. */
  void (*change)(void *forces, double *const v[3], double *const change[3]);
  /** Calls `join` for pairs of places that they keep together now: enough of them to tell which places belong to one piece of the body. */
  void (*join)(const void *forces, void (*join)(void *context, int32_t a, int32_t b), void *context);
  /** Why these changes cannot be assembled from points; NULL: they can. */
  const char *(*unassembled)(const void *forces);
  /** A number that changes whenever others are joined by points than were. */
  int64_t (*pattern)(const void *forces);
  int64_t (*point_count)(const void *forces);
  int (*point)(const void *forces, int64_t number, Operator *point, Error *error);
  /** Makes what the last evaluation found the committed state. By one thread. */
  void (*commit)(void *forces);
  /** Energy held at the displacements held, as committed; and what was dissipated up to the last commit. */
  double (*energy)(void *forces);
  double (*dissipated)(const void *forces);
  /** Work that loads have done on them beside that of motions, by strains that these begin from, up to the last commit. */
  double (*given)(const void *forces);
  /** The most that they add to the largest eigenvalue of stiffness over mass. */
  double (*eigenvalue)(const void *forces);
  /** Whether memory was out. */
  bool (*failed)(const void *forces);
  /** After an evaluation: what part of them, by its name, has found no equilibrium of its own, so that its forces are not to be had; NULL: none. */
  const char *(*stuck)(const void *forces);
  /** Rows of what they remember; bonds and displacements stand before them. */
  void (*state)(void *forces, StateList *list);
  /** Adds a line that ends: what they are, for people. */
  void (*describe)(const void *forces, const Units *units, Text *text);
} ForcesType;

enum {
#define FORCES(name, about) FORCES_##name,
#include "forces/kinds.h"
#undef FORCES
  FORCES_KINDS
};

/** Those of one body. */
typedef struct Forces {
  const ForcesType *type[FORCES_KINDS];
  void *own[FORCES_KINDS];
  int count;
} Forces;

/** @param[in] specs  [FORCES_KINDS] their sections, or NULL: not these */
int forces_create(Forces *forces, void *const *specs, const ForcesParts *parts, Error *error);
void forces_destroy(Forces *forces);

/** Whether a kind uses a material. @param[in] specs  as for forces_create */
bool forces_use(void *const *specs, const char *material);
/** Whether any kind of the deck takes materials of its own. */
bool forces_use_materials(void *const *specs);

/* Each calls what ForcesType describes, of all kinds. */
void forces_follow(Forces *forces, double motion);
/** Points of the n-th kind of this body, or NULL. */
Points *forces_points(const Forces *forces, int n);
int forces_begin(Forces *forces, Error *error);
void forces_accept(Forces *forces);
void forces_describe(const Forces *forces, const Units *units, Text *text);
void forces_remember(Forces *forces);
void forces_bond_broke(Forces *forces, int32_t a, int32_t b);
void forces_bond_mended(Forces *forces, int32_t a, int32_t b);
void forces_undo(Forces *forces);
void forces_find_again(Forces *forces);
void forces_resist(Forces *forces, double *const *displacement, double *const *internal);
void forces_choose(Forces *forces);
double forces_room(const Forces *forces);
void forces_linearise(Forces *forces);
void forces_change(Forces *forces, double *const v[3], double *const change[3]);
void forces_join(const Forces *forces, void (*join)(void *context, int32_t a, int32_t b), void *context);
/** Of all kinds; NULL: there is none. */
const char *forces_unassembled(const Forces *forces);
/** @return the name of a kind that knows no changes, or NULL */
const char *forces_unchanging(const Forces *forces);
int64_t forces_pattern(const Forces *forces);
void forces_commit(Forces *forces);
double forces_energy(const Forces *forces);
double forces_dissipated(const Forces *forces);
double forces_given(const Forces *forces);
/** The part of it that is friction. */
double forces_friction(const Forces *forces);
double forces_eigenvalue(const Forces *forces);
bool forces_strike(const Forces *forces);
/** @return the name of a kind for which memory was out, or NULL */
const char *forces_failed(const Forces *forces);
/** @param[out] kind  of which kind; NULL: not wanted @return the name of a part without equilibrium, or NULL */
const char *forces_stuck(const Forces *forces, const char **kind);
void forces_state(Forces *forces, StateList *list);

#endif
