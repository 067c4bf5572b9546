/* Reinforcing bars: lines of elements through the body, which pull on the particles around (docs/theory.md 7.1). A kind of forces
 * (forces/forces.h).
 *
 * A node of a bar moves as the particles around it, by weights that give back constant and linear displacements exactly. What an element
 * pulls with acts on the same particles by the same weights, so that momentum, moment of momentum and energy are those of the bar. */
#ifndef BRECCIA_BARS_BARS_H
#define BRECCIA_BARS_BARS_H

#include "bars/bar_repeat.h"
#include "bars/bond_law.h"
#include "family/cells.h"
#include "forces/forces.h"

typedef struct BarSpec {
  SectionHead head;
  NumberList points;
  double diameter, area;
  int64_t number;
  const char *material;
  bool snap, bending;
  BondSpec *bond;     /* NULL: perfect */
  NumberList bonded;  /* from where to where along the bar */
  TextList anchored;  /* ends that do not slip */
  SectionList repeat; /* RepeatSpec: lines beside the first */
} BarSpec;

/** What bars that slip have at their nodes: how far each is ahead of the concrete along its bar. Rows of nodes as in Bars. */
typedef struct BarSlips {
  BondLaw *law;                                         /* [bars]; those of bars that do not slip are not used */
  bool *slips;                                          /* [bars] */
  bool *fixed;                                          /* a node that is anchored */
  double *surface;                                      /* of the bar, as far as it is bonded, that belongs to a node */
  double *bonded;                                       /* [2 count] the same of both halves of an element */
  double *slip, *stress;                                /* as of the last evaluation */
  double *slip_held, *stress_held, *forward, *backward; /* as committed; largest slips so far both ways */
  double *worked;                                       /* work on bond so far */
  double *pivot, *factor;                               /* of a linearised step: the equations of nodes as L D L^T */
  double *residual, *change, *stiffness;                /* while equations are solved */
  bool *stuck;                                          /* [bars] the last evaluation found no equilibrium */
} BarSlips;

/** Places whose displacements make that of a point, and by what weights. */
typedef struct BarWeights {
  int32_t *place;
  double *weight;
  int64_t count, capacity;
} BarWeights;

typedef struct Bars {
  BarLines
      lines; /* what a 'bar' is here and in what follows; bars of the deck, which may be several of them, are said to be that */
  const SectionList *specs; /* those of `lines` */
  const Body *body;         /* borrowed, as the materials and the clock */
  const StepClock *clock;
  const Material *materials;
  int64_t *first;   /* [bars + 1] elements of a bar */
  double *bar_area; /* [bars] of all its parallel bars together */
  int64_t count;    /* elements */
  double (
      *node)[3]; /* [count + bars] where ends of elements are: of element e of bar n the nodes e + n and e + n + 1 */
  int64_t *node_begin; /* [count + bars + 1] where the places of a node begin in `held` */
  BarWeights held;     /* of a node the displacement is the sum of weight times displacement */
  double (*rest)[3], *length, *area;
  double *young;     /* of elements whose law is Hooke's in space, which have no point; 0: of others */
  int64_t *begin;    /* [count + 1] where the places of an element begin in `joined` */
  BarWeights joined; /* the vector of an element is `rest` and the sum of weight times displacement */
  int32_t *touched;  /* [touched_count] places that elements pull on, in ascending order */
  int64_t touched_count;
  int64_t *touching_begin; /* [touched_count + 1] */
  int64_t *touching;       /* elements that pull on a place, in ascending order */
  double *touching_weight;
  double (*along)[3];                /* unit vector of an element as of the last evaluation */
  double *line_strain;               /* of the concrete along an element, as of the last evaluation */
  double *strain, *stress;           /* the same of the bar: of one that slips its own */
  double *strain_held, *stress_held; /* as committed */
  double *prestrain,
      *prestrain_held; /* [bars] strains by which they are shorter than their places: as loads say, and as committed */
  double given;        /* work that prestrains have done so far */
  double (*pull)[3];   /* of a linearised step: changes of what elements pull with */
  double *longer;      /* of a linearised step: changes of the lengths of elements */
  double *tangent, *across; /* of a linearised step: stiffness along an element and across it */
  Points points;            /* a row an element, of those that are not Hooke's */
  bool has_points;
  bool *served;  /* [bars] whether the law of one runs in a server, which is asked for many elements at once */
  double *slope; /* of elements of such bars: what the server told last */
  double *
      slack; /* strain at which the law of an element carries nothing at first: below zero in steel that begins in tension */
  int64_t *chunk; /* [chunk_count + 1] elements of one bar, at most BATCH, gone through together */
  int *chunk_bar; /* [chunk_count] */
  int64_t chunk_count;
  BarSlips *slips;        /* NULL: no bar does */
  bool bends;             /* some bar resists bending; else the rows of that are not there */
  double *bend;           /* of the joint of an element and the next: moment by angle; 0: none */
  double *bent;           /* energy of these joints, as committed */
  double (*turn)[3];      /* of a linearised step: changes of unit vectors */
  double *worked;         /* on elements that have points, with what they began with, and what joints held that tore */
  double *yielded, *torn; /* when an element did so first; below zero: it has not */
  double *lowest, *highest; /* [bars] stresses so far */
} Bars;

/** What a bar of the deck is like, and what it has gone through, on all of its lines. */
typedef struct BarReport {
  double least_strain, largest_strain, least_stress, largest_stress; /* of its elements, as committed */
  double lowest_stress, highest_stress;                              /* so far */
  double stored, dissipated;                                         /* with its bond */
  double least_slip, largest_slip;                                   /* of its nodes, as committed; 0 in perfect bond */
  double yielded, torn;                                              /* shares of its length */
  int64_t first_yielded, first_torn;                                 /* the elements that did so first; -1: none has */
} BarReport;

extern const ForcesType bars_forces;

/** Where the ends of a bar's elements stand: its corners, and points between them about a spacing apart.
 *  @param[out] nodes  [3] each, to be freed
 *  @return how many; -1: no memory */
int64_t bar_nodes(const BarSpec *bar, const Body *body, double **nodes);

/** Moves nodes to the nearest particles; what becomes of no length is left out. @return how many are left */
int64_t bar_snap(const Body *body, double *nodes, int64_t count);
/** The material of a bar, or NULL. */
const Material *bar_material(const BarSpec *bar, const ForcesParts *parts);
/* bar_repeat.c */
/** Adds what is wrong with the repetitions of a bar together. */
void bar_check_repeat(const DeckReader *reader, const BarSpec *bar);

/* bar_section.c: as ForcesType says. */
bool bars_use(const void *spec, const char *material);
int bars_check(const void *spec, const ForcesParts *parts);

/** Weights of the particles around a point, by moving least squares of first order. @return false: no memory */
bool bar_weigh(BarWeights *weights, const Body *body, const Cells *cells, const double point[3]);
/** Adds a place. @return false: no memory */
bool bar_weights_add(BarWeights *weights, int32_t place, double weight);

/** Middle of an element, before it moves. */
void bar_middle(const Bars *bars, int64_t element, double middle[3]);
/** The bar that an element belongs to. */
int bar_of(const Bars *bars, int64_t element);

/* bar_slip.c: bars that slip. */

/** Makes room, laws and surfaces for bars that slip, when elements are there. @return status */
int bar_slips_create(Bars *bars, const ForcesParts *parts, Error *error);
void bar_slips_destroy(Bars *bars);
bool bar_slips(const Bars *bars, int bar);
/** Slips of a bar, and with them strains of its elements, at the strains of the concrete along it. By one thread. */
void bar_find_slips(Bars *bars, int bar);
/** Keeps the equations of its nodes, when `tangent` of its elements is known. */
void bar_factor_slips(Bars *bars, int bar);
/** Adds to changes of the lengths of its elements in the concrete (`longer`) what its nodes slip with them. */
void bar_change_slips(Bars *bars, int bar);
void bar_accept_slips(Bars *bars);
/** Rows of what bond remembers. */
void bar_slips_state(Bars *bars, StateList *list);
/** Energy that the bond of a bar would give back, and work that it has not kept. */
double bar_bond_stored(const Bars *bars, int bar);
double bar_bond_dissipated(const Bars *bars, int bar);
/** Adds a line on the bond of a bar: what it bears, where, and which ends are anchored. */
void bar_slips_describe(const Bars *bars, int bar, const Units *units, Text *text);
/** Slip in the middle of an element and mean bond stress on its surface, as committed; 0 in perfect bond. */
double bar_slip_in(const Bars *bars, int bar, int64_t element);
double bar_bond_stress_in(const Bars *bars, int bar, int64_t element);

/* bar_bending.c: bars that resist bending. */

/** Makes room for joints, when elements are there with their points. @return status */
int bar_bending_create(Bars *bars, const ForcesParts *parts, Error *error);
/** Young's modulus times second moment of area, of all parallel bars of a line. */
double bar_bending_stiffness(const Bars *bars, int bar);
/** Joints of a bar that hand on a moment. */
int64_t bar_joints(const Bars *bars, int bar);
/** Adds to what elements pull with the moments of their joints, when unit vectors of all are found. */
void bar_bend(Bars *bars, int64_t from, int64_t to);
/** The change of that, of an element; `turn` and `longer` of its neighbours are known. */
void bar_change_bending(Bars *bars, int64_t element);
void bar_accept_bending(Bars *bars);
/** Energy that joints of elements hold. */
double bars_bent(const Bars *bars, int64_t from, int64_t to);
void bar_bending_state(Bars *bars, StateList *list);

/* bar_report.c */

/** The bars of a body, or NULL. */
const Bars *bars_among(const Forces *forces);
/** @return the number among those of the deck of the bar of a name, or -1 */
int bars_find(const Bars *bars, const char *name);
/** Whether a deck has bars that were refused, so that `bars` is NULL: why is among the errors already. */
bool bars_were_refused(const Bars *bars, const DeckReader *reader);
const char *bar_name(const Bars *bars, int bar);
/** Name and lines of a bar of the deck. */
const char *deck_bar_name(const Bars *bars, int deck_bar);
int deck_bar_lines(const Bars *bars, int deck_bar);
/** Young's modulus of a bar at first. */
double bar_young(const Bars *bars, int bar);
void bar_node_displacement(const Bars *bars, int64_t node, double displacement[3]);
double bar_dissipated_in(const Bars *bars, int64_t element);
BarReport bar_report(const Bars *bars, int deck_bar);
/** Returns the element of a bar of the deck whose middle is nearest to a point; of equally near ones the first along
 * the bar. */
int64_t bar_nearest(const Bars *bars, int deck_bar, const double point[3]);
/** Energy that elements would give back: of one bar; of Hooke's law, or of those that have points. */
double bars_stored(const Bars *bars, int64_t from, int64_t to, bool hookean);
/** When a step has come out well: notes what has yielded or is torn since. */
void bars_note(Bars *bars);
/** Stresses of elements of a bar at their strains, from the committed state, and slopes of them (`tangent`). By one thread. */
void bar_try_stresses(Bars *bars, int bar);

/* bar_forces.c: as ForcesType says. */
void bars_resist(void *forces, double *const *displacement, double *const *internal);
void bars_linearise(void *forces);
void bars_change(void *forces, double *const v[3], double *const change[3]);
int64_t bars_point_count(const void *forces);
int bars_point(const void *forces, int64_t number, Operator *point, Error *error);
void bars_accept(void *forces);
double bars_energy(void *forces);
double bars_dissipated(const void *forces);
double bars_given(const void *forces);
/** The sum of the sizes of forces that bars shorter than their places by these strains would exert at their nodes if these had not moved: at ends and bends.
 *  @param[in] shorter  [bars] */
double bars_prestress_forces(const Bars *bars, const double *shorter);
const char *bars_unassembled(const void *forces);
const char *bars_stuck(const void *forces);

#endif
