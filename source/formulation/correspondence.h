/* Non-ordinary state-based peridynamics by correspondence (Silling et al. 2007; docs/theory.md 4).
 *
 * With w = omega beta V_j and G = F - I, particle i has
 *   G_i = (sum w eta (x) xi) K_i^-1,  E = (G + G^T + G^T G) / 2,  P = (I + G) S(E),
 * and the force on it per volume is sum w [P_i K_i^-1 + P_j K_j^-1] xi + sum w [C_i (eta - G_i xi) + C_j (eta - G_j xi)], the
 * second sum being the control of zero-energy modes: C = G_s c_b / (delta omega_mean) I (Silling 2017) or a factor times
 * C : K^-1 (Wan et al. 2019), of the family with all its bonds: a C that follows the family would give energy as bonds break
 * (docs/theory.md 4). All sums over bonds are arranged such that they are linear in what is read of the neighbour, and so can be
 * made along whole lattice rows (family/lattice_rows.h). With the moments of the family m = sum w xi and w_sum = sum w, one state
 * Q = P K^-1 - C G per particle and the sum of relative displacements e = sum w eta,
 *   sum w eta (x) xi = sum w u_j (x) xi - u_i (x) m,      e = sum w u_j - w_sum u_i,
 *   f_i = Q_i m + C_i e + sum w [Q_j xi + C_j u_j] - (sum w C_j) u_i. */
#ifndef BRECCIA_FORMULATION_CORRESPONDENCE_H
#define BRECCIA_FORMULATION_CORRESPONDENCE_H

#include "base/lane_kinds.h"
#include "base/tensor.h"
#include "family/surroundings.h"
#include "formulation/formulation.h"
#include "formulation/shape_table.h"

/* Uniform: the scalar control of a body of one material with constant influence, where C is the same everywhere; sum w C_j eta
 * is then C e, known from the first sweep. */
typedef enum Control { CONTROL_NONE, CONTROL_UNIFORM, CONTROL_SCALAR, CONTROL_TENSOR } Control;

enum { MOST_PULLS = 9 + 3 + 6 };
enum { CORRESPONDENCE_SHOWN = 8 }; /* of a place, where bonds are stored: x, y, z, 0, V u, V v, V w, V */

typedef enum ControlFades { FADES_NEVER, FADES_WITH_SOFTENING, FADES_WITH_YIELDING } ControlFades;
typedef struct Fading Fading; /* of the control where laws soften (correspondence_fading.c) */

typedef struct Correspondence Correspondence;

/** The phases that go over all bonds (correspondence_sweep.c). */
typedef struct CorrespondenceSweeps {
  int64_t (*show_displacements)(const Correspondence *c, const Sweep *sweep);
  int64_t (*deform)(const Correspondence *c, const Sweep *sweep);
  int64_t (*respond)(const Correspondence *c, const Sweep *sweep);
  int64_t (*sum_states)(const Correspondence *c, const Sweep *sweep);
  int64_t (*resist)(const Correspondence *c, const Sweep *sweep);
} CorrespondenceSweeps;
LANES_CHOICE(const CorrespondenceSweeps, correspondence_sweeps)

struct Correspondence {
  const Particles *particles;
  const Family *family;
  const Points *points;
  const Body *body;
  const uint8_t *foreign; /* [slices], or NULL */
  bool plane, finite;
  Control control;
  Control widest; /* for which there is room: of a uniform control that may fade it is CONTROL_SCALAR */
  double strength;
  ShapeTable shapes;   /* K^-1, m, w_sum */
  double *state[9];    /* Q */
  double *relative[3]; /* e */
  double uniform;      /* C, if it is uniform */
  double *hold[6];     /* C: one component, or six, or none */
  double *held[3];     /* C u, if neighbours read it */
  ControlFades fades;
  bool influence_falls; /* it is smaller at the horizon than at half of it */
  Fading *fading;       /* NULL: C stays as it is */
  /* Sums along lattice rows, for each kind of row and slice those of its eight places; what is read together lies together. */
  double *row_displacement[ROW_KINDS]; /* [slices][3][2][8] moment and sum of u_k */
  double *row_pull
      [ROW_KINDS]; /* [slices][pulls][8] for each r: moment of Q_r,along, sums of Q_r,across; sums of held; of hold */
  int64_t round; /* sums of a place stand where the place AND this says: -1, or in a window one less than its places */
  int pulls;
  /* What bonds of stored slots read of a neighbour, together (correspondence_stored.h); NULL if there are none. */
  Surroundings around;
  double *shown;     /* [places][CORRESPONDENCE_SHOWN] */
  double *row;       /* [places][state_length] of its response */
  double *gradients; /* [slices][9][8] G of the state at which it was linearised; NULL before */
  double *turns;  /* [slices][9][8] how families have turned, less 1 (correspondence_breaking.c); NULL: nobody asks */
  int32_t *axial; /* places whose bonds act as springs, ascending (some may have become free since) */
  int64_t axial_count;
  const CorrespondenceSweeps *sweeps;
};

/** Numbers per place that C takes. */
static inline int hold_components(Control control)
{
  return control == CONTROL_TENSOR ? 6 : control == CONTROL_SCALAR;
}

/** A component of C (XX, ... ZX). */
static inline double hold_component(const Correspondence *c, int64_t place, int k)
{
  if (c->control == CONTROL_TENSOR) return c->hold[k][place];
  return k > ZZ || c->control == CONTROL_NONE ? 0 : c->control == CONTROL_SCALAR ? c->hold[0][place] : c->uniform;
}

/** True if neighbours read C and C u of a particle. */
static inline bool hold_is_read(Control control)
{
  return control == CONTROL_SCALAR || control == CONTROL_TENSOR;
}

/** Numbers that sums along lattice rows take for each place of a slice. */
static inline int pull_count(Control control)
{
  return 9 + (hold_is_read(control) ? 3 + hold_components(control) : 0);
}

/** Numbers of a row that shows a particle's response: Q and x, then C u and C if they are read, in fours. */
static inline int state_length(Control control)
{
  return 12 + (hold_is_read(control) ? (3 + hold_components(control) + QUAD - 1) / QUAD * QUAD : 0);
}

/* Making, and what follows from the shapes of families (correspondence_setup.c). */
extern const Section correspondence_section;
int correspondence_check(const void *keys, const Body *body, const DeckReader *reader);
void *correspondence_create(const FormulationParts *parts, Error *error);
void correspondence_destroy(void *formulation);
void correspondence_renew(void *formulation, int64_t slice);
void correspondence_gradient(const void *formulation, int64_t place, double f[9]);
bool correspondence_takes_small_strain(const void *formulation);
double *correspondence_shares(void *formulation);
size_t correspondence_bytes(const void *formulation);
bool correspondence_scratch(const void *formulation, double *strain[6], double *stress[6]);
void correspondence_give_way(void *formulation);
SumsAround correspondence_sums_around(const void *formulation, int64_t slice);
FormerBonds correspondence_former_bonds(const void *formulation);

/* Single bonds and points, and particles with too few bonds (correspondence_bonds.c). */
int64_t correspondence_finish(void *formulation, const Sweep *sweep);
void correspondence_half_state(const void *formulation, double *const *displacement, double *const *linearised_at,
                               int64_t slice, int64_t slot, int lane, double state[3]);
void correspondence_even_stress(const void *formulation, const uint8_t *marked, double *const area[3]);
int64_t correspondence_point_count(const void *formulation);
int correspondence_point(const void *formulation, double *const *displacement, int64_t place, Operator *point,
                         Error *error);
/** Gradient I + G of a family at displacements. */
void correspondence_gradient_at(const Correspondence *c, double *const *displacement, int64_t place, double f[9]);
int correspondence_linearise(void *formulation, double *const *displacement, Error *error);

/* How C fades as points soften (correspondence_fading.c). Fade: in a step, before forces: C by the factors committed, and what factors its strains and
 * stresses leave. */
bool correspondence_may_fade(const Correspondence *c, const FormulationParts *parts);
int correspondence_create_fading(Correspondence *c, Error *error);
void correspondence_destroy_fading(Correspondence *c);
void correspondence_fade(const Correspondence *c, const Sweep *sweep);
void correspondence_commit(void *formulation, bool well);
bool correspondence_lags(const void *formulation);
double correspondence_lag_allowed(const void *formulation);
void correspondence_state(void *formulation, const char *part, StateList *list);
size_t correspondence_fading_bytes(const Correspondence *c);
extern const ControlType correspondence_control;

/** How families have turned, from F = 1 + G: (F + F^-T) / 2, which for F = R U is R but for the square of the stretches; of small strains
 *  1 + (G - G^T) / 2. Written less 1.
 *  @param[in] gradient  [9][BATCH] G of four places */
void correspondence_keep_turn(const Correspondence *c, int64_t place, const double *gradient);
int correspondence_keep_turns(void *formulation, Error *error);
void correspondence_elongation(const void *formulation, int64_t slice, int64_t slot, int lane, double change[3]);
double correspondence_energy_room(const void *formulation, int64_t slice, const EnergyLimit *limit, uint8_t *found);

double correspondence_free_tension(const void *formulation, int64_t place);
void correspondence_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy);

/** A particle without a strain pulls at its bonds as half of a bond-based spring does: pull per volume squared, and its change with the
 *  neighbour's displacement, at displacements u. */
void correspondence_axial_spring(const Correspondence *c, double *const u[3], int64_t place, const Bond *bond,
                                 double pull[3], double spring[6]);

/** Width of the band of particles whose families a plane crack divides, and that follow their law to its end as it opens: nearly all within a horizon
 *  in the plane, less in space, where the farthest are hardly strained (docs/theory.md 8.7). */
double correspondence_characteristic_length(const BondLength *of);
/** Implements FormulationType.softening_length. */
double correspondence_softening_length(Space space, double horizon, double ductility);

#endif
