/* Reinforcing bars: lines of elements through the body, which pull on the particles around (docs/theory.md 7.1). A kind of forces
 * (forces/forces.h).
 *
 * A node of a bar moves as the particles around it, by weights that give back constant and linear displacements exactly. What an element
 * pulls with acts on the same particles by the same weights, so that momentum, moment of momentum and energy are those of the bar. */
#ifndef BRECCIA_BARS_BARS_H
#define BRECCIA_BARS_BARS_H

#include "family/cells.h"
#include "forces/forces.h"

typedef struct BarSpec {
  SectionHead head;
  NumberList points;
  double diameter, area;
  int64_t number;
  const char *material;
  bool snap;
} BarSpec;

/** Places whose displacements make that of a point, and by what weights. */
typedef struct BarWeights {
  int32_t *place;
  double *weight;
  int64_t count, capacity;
} BarWeights;

typedef struct Bars {
  const SectionList *specs; /* borrowed, as the body and the materials */
  const Body *body;
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
  double *strain, *stress;           /* as of the last evaluation */
  double *strain_held, *stress_held; /* as committed */
  double (*pull)[3];                 /* of a linearised step: changes of what elements pull with */
  double *tangent, *across;          /* of a linearised step: stiffness along an element and across it */
  Points points;                     /* a row an element, of those that are not Hooke's */
  bool has_points;
  int64_t *chunk; /* [chunk_count + 1] elements of one bar, at most BATCH, gone through together */
  int64_t chunk_count;
  double *worked;           /* work on elements that have points, since the beginning */
  double *yielded, *torn;   /* when an element did so first; below zero: it has not */
  double *lowest, *highest; /* [bars] stresses so far */
} Bars;

/** What a bar is like, and what it has gone through. */
typedef struct BarReport {
  double least_strain, largest_strain, least_stress, largest_stress; /* of its elements, as committed */
  double lowest_stress, highest_stress;                              /* so far */
  double stored, dissipated;
  double yielded, torn;              /* shares of its length */
  int64_t first_yielded, first_torn; /* the elements that did so first; -1: none has */
} BarReport;

extern const ForcesType bars_forces;

/** Where the ends of a bar's elements stand: its corners, and points between them about a spacing apart.
 *  @param[out] nodes  [3] each, to be freed
 *  @return how many; -1: no memory */
int64_t bar_nodes(const BarSpec *bar, const Body *body, double **nodes);

/** Weights of the particles around a point, by moving least squares of first order. @return false: no memory */
bool bar_weigh(BarWeights *weights, const Body *body, const Cells *cells, const double point[3]);
/** Adds a place. @return false: no memory */
bool bar_weights_add(BarWeights *weights, int32_t place, double weight);

/** Middle of an element, before it moves. */
void bar_middle(const Bars *bars, int bar, int64_t element, double middle[3]);

/* bar_report.c */

/** The bars of a body, or NULL. */
const Bars *bars_among(const Forces *forces);
/** @return the number of the bar of a name, or -1 */
int bars_find(const Bars *bars, const char *name);
const char *bar_name(const Bars *bars, int bar);
void bar_node_displacement(const Bars *bars, int64_t node, double displacement[3]);
double bar_dissipated_in(const Bars *bars, int64_t element);
BarReport bar_report(const Bars *bars, int bar);
/** The element whose middle is nearest to a point. */
int64_t bar_nearest(const Bars *bars, int bar, const double point[3]);
/** Energy that elements would give back: of one bar; of Hooke's law, or of those that have points. */
double bars_stored(const Bars *bars, int64_t from, int64_t to, bool hookean);
/** When a step has come out well: notes what has yielded or is torn since. */
void bars_note(Bars *bars);

/* bar_forces.c: as ForcesType says. */
void bars_resist(void *forces);
void bars_linearise(void *forces);
void bars_change(void *forces, double *const v[3], double *const change[3]);
int64_t bars_point_count(const void *forces);
int bars_point(const void *forces, int64_t number, Operator *point, Error *error);
void bars_accept(void *forces);
double bars_energy(void *forces);
double bars_dissipated(const void *forces);

#endif
