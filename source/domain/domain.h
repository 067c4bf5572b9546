/* The part of the body that one process owns: particles, bonds, regions with the formulations that join them, and the batches
 * that its threads work on. Functions marked "by all threads" contain loops that are shared out (base/team.h): call them from
 * every thread of a team_run, or from none. Whatever is summed over particles is summed batch by batch in a fixed order. */
#ifndef BRECCIA_DOMAIN_DOMAIN_H
#define BRECCIA_DOMAIN_DOMAIN_H

#include "failure/failure.h"
#include "forces/forces.h"
#include "formulation/formulation.h"
#include "loading/load.h"

#include <math.h>

/** Where threads keep what phases `ahead` write, of slices around the batch under way only (window.c). */
typedef struct Window {
  int64_t slices;  /* that have room at a time, a power of two */
  int64_t numbers; /* of a slice */
  int threads; /* at most so many work with windows: those of more would take as much as sums of all slices; 0: none does */
  double *memory; /* [threads][slices][numbers] */
  /* [batches of the region] the first slice of which the batch or a later one reads, and the last one of which it or an earlier one does */
  int32_t *low, *high;
} Window;

/** Blocks of the body with one formulation. */
typedef struct Region {
  const char *name; /* of the deck; NULL: what no region names */
  const Node *node; /* of its keys, for messages */
  const FormulationType *type;
  const void *keys;
  void *formulation;
  Points points;
  BondList bonds; /* where points are on bonds; empty otherwise */
  /** [rows of points on bonds] strains at which their laws have the stress under which they begin; NULL: they begin under none */
  double *initial[6];
  double *beside
      [3]; /* [rows of points] what free strains put in the place of Points.initial, where it is not shared; NULL: nothing */
  PointPlaces places;   /* of its points, if a law asks; owned */
  double *row_strength; /* [rows of points on bonds] factors on strengths; NULL: 1 */
  int64_t particles;    /* of them */
  bool takes_both;      /* its formulation in the deck takes laws of one strain, too, if all are */
  bool is_linear;       /* no law of it dissipates or remembers */
  uint8_t *foreign;     /* [slices] 1: of other regions; NULL: there are none */
  int64_t *border;      /* [border_count] slices of others that have bonds with it */
  int64_t border_count, first_batch, last_batch; /* its batches: the last is not one of them */
  int64_t *stripe, *stripe_slice; /* [stripe_count + 1] batches and slices at which stripes begin (Phase, by_stripes) */
  int64_t stripe_count;
  Window window;
} Region;

/** Bonds between regions, place by place (joint.c). */
typedef struct JointBond JointBond;
typedef struct Joint {
  int64_t places, bond_count; /* each bond from both its ends */
  int32_t *place;             /* [places] */
  int64_t *first;             /* [places + 1] */
  JointBond *bonds;
} Joint;

/** Causes of broken bonds (domain/break_causes.h). */
typedef enum BreakCause {
#define BREAK_CAUSE(NAME, ...) BREAK_##NAME,
#include "domain/break_causes.h"
#undef BREAK_CAUSE
  BREAK_CAUSES
} BreakCause;

typedef struct BreakCauseType {
  const char *word;      /* in result files and summaries */
  const char *criterion; /* NULL: the failure criterion of the deck */
  const char *quantity;  /* name of the value; NULL: that of the criterion */
  bool has_limit;        /* the value is compared with a limit */
  const char *count;     /* words after a number of bonds; the criterion follows if the cause has none of its own */
  const char *about;     /* one clause for the reference of result files */
} BreakCauseType;
extern const BreakCauseType break_causes[BREAK_CAUSES];

typedef struct BrokenBond {
  int64_t step;
  double time;
  int32_t a, b; /* numbers, a < b */
  BreakCause cause;
  double value, limit; /* in the dimension of the quantity; NaN: the criterion has no value, the cause no limit */
  int quantity;        /* index among those of the criterion (Criterion.quantities); 0 for other causes */
  int material;        /* index of the material whose limit or law decided */
} BrokenBond;

/** A bond that breaks in the step under way, as judged while all bonds are intact. */
typedef struct BreakingBond {
  int64_t slice, slot;
  int lane;
  int32_t neighbour;
  BreakCause cause;
  double value, limit; /* of the failure criterion, in its dimension; NaN: none */
  int quantity;        /* index among those of the criterion (Criterion.quantities) */
} BreakingBond;

/** A step under way. */
typedef struct Moment {
  int64_t step;     /* its number */
  double time;      /* at its end */
  double time_step; /* displacement increments are this times the velocities held */
  double motion;    /* largest displacement increment of any particle */
  int64_t most;     /* of the bonds beyond their limit about so many break, the most loaded first; 0: all */
} Moment;

/** A place whose family has lost bonds in the step under way. */
typedef struct Torn {
  int32_t place;
  double share;                         /* of the formulation, before */
  double strain[6], stress[6], elastic; /* of its point at the beginning of the step, and its energy by them */
  double received;                      /* until the end of the step, with the bonds */
  double carried, control;              /* the same without them: in proportion to the share, and not */
  double stored;                        /* at the end of the step without them */
} Torn;

/** Strains that places would take where nothing hindered them (strains.c). */
typedef struct Strains {
  Loading *loading;    /* borrowed; NULL before there are loads */
  bool any;            /* loads have strains, of particles or of bars */
  double *given;       /* [places] as loads say them; NULL: no load has any */
  double *held;        /* as of the last state */
  double *tension;     /* [places] what one would take of the body by growing by 1, as of the last state */
  double *tension_now; /* while a step is booked */
  int64_t known;       /* whether `tension` is up to date */
  double *growth;      /* of the step in which bonds break */
  double work;         /* that they have done so far */
  double whole;        /* the largest sum of squares of a family's bond lengths, by volume, before anything broke */
} Strains;

/** Fields of parameters of a deck (strength_field.h). */
typedef struct FieldsSpec FieldsSpec;

typedef struct Domain {
  Body body;
  Particles *particles; /* the body's */
  Family family;
  Material *materials;
  int material_count;
  struct MaterialLengths *lengths; /* [material_count] (domain_lengths.c); NULL: none */
  int32_t *material;               /* [slices] */
  /** [places] as people see them: of points on particles theirs, otherwise what domain_observe has found, NULL before */
  double *strain[6], *stress[6];
  bool may_leave_tensors; /* nothing but pictures and the like asks for them (domain_leave_tensors) */
  bool leaves_tensors;    /* evaluations leave them out; `strain` and `stress` are scratch of the formulation */
  bool tensors_are_old;   /* they are not of the state evaluated last */
  double *own_strain[6], *own_stress[6]; /* meanwhile: the points' own arrays */
  bool begins_under_stress;              /* some of its particles do */
  double *initial_strain
      [6]; /* [places] what points on particles that begin under stress add to their strains; NULL: none does */
  int64_t stressed; /* particles of the body that begin under stress, and between which mean stresses */
  double least_mean, largest_mean;
  double initial_energy; /* that they store by it */
  bool is_strained;      /* loads may give it free strains */
  Strains strains;
  /** [places] 1: a law of its point or bonds could not be integrated, and carries nothing; NULL: that is a failure */
  uint8_t *gave_up;
  double *strength;              /* [places] factors on strengths (strength_field.h); NULL: 1 */
  const SectionList *selections; /* named ones of the deck, borrowed while the domain is made */
  StepClock clock;               /* of the step under way */
  Region *regions;
  int region_count;
  int32_t *region; /* [slices] */
  Joint joint;
  Failure failure;
  Forces forces;
  void *const *forces_spec; /* [FORCES_KINDS] of the deck, borrowed; NULL: none */
  Batch *batches;
  int64_t batch_count;
  int64_t *lowest; /* [batches] first batch that holds a neighbour of a particle of the batch */
  bool rows_cut;   /* a row is longer than a batch */
  double *
      counted; /* [places] volumes in sums of energies: 0 outside the body's supports, else the particles', which are not copied where
                            none is outside */
  double *family_volume; /* [places] of the neighbours of each place, before anything broke; NULL: nothing breaks */
  uint8_t *suspects;     /* [slices] */
  double *look_again;    /* [slices] sum of largest motions at which the criterion looks at the slice again */
  double motion;         /* sum over steps of the largest displacement increment of any particle */
  BrokenBond *broken;    /* in the order in which they broke */
  int64_t broken_count, broken_capacity;
  double fracture_energy; /* that bonds had received, and neither gave back nor dissipated, when they broke */
  /* Energy that bonds held beyond their limits when they broke at rest, not part of `fracture_energy`. */
  double shed_energy;
  /* Sums over the bonds that break in the step under way: energy at the limit and energy held, but for a factor. */
  double energy_at_limit, energy_held;
  BreakingBond *breaking; /* those of the step under way, each from both its ends */
  int64_t breaking_count, breaking_capacity;
  Torn *torn;
  int64_t torn_count, torn_capacity;
  uint8_t *is_torn;            /* [places] 1, or 2 where its family carries less from this step on */
  int64_t broken_before;       /* bonds, at the beginning of the step under way */
  bool any_suspect;            /* in the step under way */
  bool out_of_memory;          /* while bonds broke */
  double force_sum;            /* of all internal force components' magnitudes, as of the last domain_forces */
  double *batch_sum;           /* [batches * MAX_SUMS] */
  int64_t *batch_failed;       /* [batches] */
  int64_t failed_place;        /* whose law could not be integrated, or -1 */
  const Vector *linearised_at; /* displacements of the last domain_linearise */
} Domain;

typedef struct DomainSpec {
  const SectionList *materials, *blocks, *cracks;
  const MarginList *margins;
  const PeridynamicsSpec *peridynamics;
  const FailureSpec *failure; /* or NULL */
  const FieldsSpec *fields;   /* or NULL */
  const SectionList *selections;
  void *const *forces;      /* [FORCES_KINDS] sections, or NULL */
  bool is_strained;         /* some load is an initial strain */
  bool begins_under_stress; /* the deck gives stresses to begin with */
} DomainSpec;

static inline Region *domain_region(const Domain *domain, int64_t place)
{
  return &domain->regions[domain->region[place / SLICE]];
}

/** Returns the largest length over which a crack in a material spreads its fracture energy by its normal [length], over
 *  24 normals in the plane x, y, and in space along z; 0: the law does not ask for the normal. */
double domain_longest_crack_length(const Domain *domain, int material);

/** Returns what limits of bonds of a region depend on, without the reader and what is present. */
LimitsOf domain_limits_of(const Domain *domain, int region, const BondLength *lengths);

/** Whether a block of a region is made of a material. */
bool region_is_made_of(const Domain *domain, const Region *region, const char *material);
/** Whether all laws of a region, NULL: of all materials of the deck, are Hooke's. */
bool domain_is_hookean(const Domain *domain, const Region *region);
/** The same; a body of one region also has materials that no block is made of, so that mistakes in them are told. */
bool region_has_material(const Domain *domain, const Region *region, const char *material);

/** Builds everything that a step needs. `domain` must be zero; destroy it in any case. */
int domain_create(Domain *domain, const DeckReader *reader, const DomainSpec *spec);
void domain_destroy(Domain *domain);

/** State at which forces are evaluated, and where they are written. */
typedef struct Evaluation {
  const Vector *displacement;  /* displacements; in a linearised step their changes, 0 in unused places */
  const Vector *linearised_at; /* displacements of the last domain_linearise; NULL: the evaluation is nonlinear */
  const Vector *internal;      /* written: forces and moments per volume; in a linearised step their changes */
} Evaluation;

/** Returns the evaluation at the particles' displacements that writes their internal forces. */
Evaluation domain_present(const Domain *domain);

/** Evaluates forces, by all threads. Overwrites trial histories, strains and stresses of points, and what particles
 *  show their neighbours; committed histories stay.
 *
 *  A linearised step writes the changes K v of internal forces, at the price of one evaluation; forces beside those of
 *  bonds are not in it (domain_change_forces). It leaves what particles show their neighbours at the step; call
 *  domain_show_states to restore that. */
void domain_forces(Domain *domain, const Evaluation *of);
/** Runs domain_forces on the team in use; called by one thread.
 *  @param[in] of  NULL: domain_present
 *  @return BRECCIA_FAILURE, without a message, if domain_has_forces is false afterwards */
int domain_evaluate(Domain *domain, const Evaluation *of);
/** Returns true if the last nonlinear evaluation found finite forces, and no law or phase has failed in it or since. */
bool domain_has_forces(const Domain *domain);

/** Makes again what particles show their neighbours, from displacements and stresses as they stand; no law is asked.
 *  @param[in] displacement  NULL: the displacements held */
void domain_show_states(Domain *domain, const Vector *displacement);

/** Lets linearised steps take secants where laws soften, or no longer: those who iterate come on by them where points soften and
 *  unload in turn, if slowly. @return whether the body has bonds of such laws */
bool domain_take_secants(Domain *domain, Secants of);
/** Whether linearised steps are secants anyway, of what is damaged. */
bool domain_has_secants(const Domain *domain);

/** Evaluates forces into the particles' own rows and keeps what linearised steps need of that: tangents of laws among
 *  it. The return value does not tell of forces that were not found (domain_has_forces).
 *  @param[in] displacement  displacements, which stay as they are until the last linearised step; NULL: those
 *                           held */
int domain_linearise(Domain *domain, const Vector *displacement, Error *error);
/** A linearised step: changes K v of internal forces with changes v of displacements (domain_forces). */
void domain_linear_step(Domain *domain, const Vector *v, const Vector *change);

/** Adds changes of the forces beside those of bonds to those of a linearised step, at the state at which forces_linearise was called.
 *  @param[in,out] change  of forces per volume */
void domain_change_forces(Domain *domain, const Vector *v, const Vector *change);

/** Forces per volume beside those of bonds; trial state only.
 *  @param[in] displacement  NULL: the displacements held */
void domain_forces_beside(Domain *domain, const Vector *displacement, const Vector *forces);

/** Rows of particles, points, bonds and forces. Of all rows but those of role STATE_FOLLOWS, taken up in their order, shapes,
 *  deformations and force states follow to the same bits. */
void domain_state(Domain *domain, StateList *list);
/** Makes or frees the room for stresses of laws that remember as they were before a step. */
int domain_keep_stresses(Domain *domain, bool keep, Error *error);
/** Puts stresses by, so that laws write those of a step into other arrays; and takes them back if it fails. By one thread. Only where there is room. */
void domain_put_stresses_by(Domain *domain);
/** After steps: stresses of points on particles stand in the arrays again in which they stood before these. */
void domain_put_stresses_back(Domain *domain);
/** Forces, strains and stresses of the state that a step began with, after all rows that it had tried have come back. */
void domain_follow(Domain *domain);

/** Tells laws with rates the time at the end of a step under way, and its length; 0 between two steps. By one thread. */
void domain_tell_time(Domain *domain, double time, double time_step);
/** Time at which the step under way began, by what was told last. */
double domain_step_begin(const Domain *domain);

/** Breaks the bonds that the criterion says, by all threads, and renews the families concerned. Displacements are those at the end of
 *  the step under way, strains and stresses those at its beginning. */
void domain_break(Domain *domain, const Moment *moment);

/** Measures the time of the failure criterion in one step. If the whole body takes longer than `enough` [s], the
 *  function measures a part and extrapolates. All bonds are tested as if stretched; displacements are restored.
 *  @return time in a step [s]; 0 without a criterion and for criteria that need not test every step */
double domain_criterion_seconds(Domain *domain, double enough);

/** When laws have answered to families without their broken bonds, by all threads: what torn places had received and have no more is booked,
 *  and families that would have gained carry less. Of the places of one region. */
void domain_settle(Domain *domain, const Region *region);

/** After the forces of a step that did not fail, by all threads. */
void domain_accept(Domain *domain);

/** Mends the bonds that domain_break broke in a step that failed; displacements are those of its beginning again. */
void domain_mend(Domain *domain);

/** Lets no bond break between particles that are marked or have an intact bond to one that is.
 *  @param[in] held  [places] 1 where a load moves the particle */
int domain_hold_grips(Domain *domain, const uint8_t *held, Error *error);
/** Lets no bond break between particles that are marked or stand within a distance of one that is.
 *  @param[in] marked  [places] */
int domain_keep_within(Domain *domain, const uint8_t *marked, double distance, Error *error);
/** Returns the value, or 0 if the value is round-off compared with `whole`. */
static inline double without_rounding(double value, double whole)
{
  return fabs(value) < 1e-12 * whole ? 0 : value;
}

/** Returns the name of quantity k of a cause, as BrokenBond.quantity counts them; NULL after the last. */
const char *domain_break_quantity(const Domain *domain, BreakCause cause, int k);
/** Returns the dimension of the quantities of a cause; "1": plain numbers. */
const char *domain_break_dimension(const Domain *domain, BreakCause cause);
/** Returns the name of the criterion of a cause; "" if the deck has none. */
const char *domain_break_criterion(const Domain *domain, BreakCause cause);
/** Returns true if a bond lies in the layers outside of supports, where it is the image of a bond of the body. */
bool domain_bond_outside(const Domain *domain, const BrokenBond *bond);
/** Counts the broken bonds of the body by cause, those in layers outside of supports apart.
 *  @return number of broken bonds in these layers */
int64_t domain_count_broken(const Domain *domain, int64_t counts[BREAK_CAUSES]);

/** Computes the midpoint of a bond inside the body. An end in a layer outside of a support is replaced by its original
 *  if both ends are in layers; otherwise the inner end alone gives the position.
 *  @param[in] ends  numbers of particles  @param[out] middle  reference position */
void domain_bond_middle(const Domain *domain, const int32_t ends[2], double middle[3]);
/** Adds a broken bond to the list. */
int domain_record(Domain *domain, const BrokenBond *bond);

/** How an even stress acts on marked places, as FormulationType.even_stress says it; NAN where that is not known. @param[out] area  [3][places] */
void domain_even_stress(const Domain *domain, const uint8_t *marked, double *const area[3]);

/** Force per volume squared that the neighbour exerts on the particle through one bond, t_ij - t_ji. */
void domain_bond_force(const Domain *domain, int64_t slice, int64_t slot, int lane, double force[3]);

/** Mixes elastic tangents, of the first moduli, into those of laws in linearised steps, 0 to 1 of the whole; points on bonds follow at the next
 *  domain_linearise. Where families flow without points nothing is mixed. */
void domain_mix_tangents(Domain *domain, double elastic_weight);

/** Whether laws respond elastically; and makes them do so. */
bool domain_in_elastic_stage(const Domain *domain);
void domain_set_elastic_stage(Domain *domain, bool elastic);
/** Whether some law says that it may soften, and is not elastic in this stage. */
bool domain_may_soften(const Domain *domain);
/** The same of laws of bonds, not of points. */
bool domain_bonds_may_soften(const Domain *domain);
/** Commits the lengths by crack normal of points whose damage begins in the trial state, so that the next evaluation
 *  spreads their fracture energy over these lengths (constitutive/normal_lengths.h). Called by one thread.
 *  @return number of points that had no length before */
int64_t domain_take_lengths(Domain *domain);
/** Clears the lengths that domain_take_lengths has committed since the last domain_commit_points. Called by one
 *  thread. */
void domain_drop_lengths(Domain *domain);
/** Makes the trial state of all points the committed one. By one thread. */
void domain_commit_points(Domain *domain);
/** Lets loads say the strains that the body begins from. Points under initial stress have begun. @param[in] loading  borrowed */
int domain_take_loads(Domain *domain, Loading *loading, const DeckReader *reader);
/** Refuses a strength reduction that no law of the body takes, or one of them refuses. */
int domain_check_strength(const Domain *domain, const Loading *loading, const DeckReader *reader);
/** Refuses a strength reduction whose factor is 0 or less at some time while the reduction acts.
 *  @param[in] time  duration for which the reduction acts */
int domain_check_reduction(const Load *load, double time, const DeckReader *reader);
/** Divides strengths as loads say at a time, by one thread; domain_tell_time does it. */
void domain_tell_strength(Domain *domain, double time);
/** Strains that loads say at a time, by one thread; domain_tell_time does it. */
void domain_tell_strains(Domain *domain, double time);
/** Puts strains half way between those of the last state and those told, for bonds that break in a step: they have taken half of the work that strains
 *  do with them, as those of forces, for the trapezium rule finds them gone. By one thread; domain_tell_strains brings those of the end back. */
void domain_halve_strains(Domain *domain);
/** Books the work of strains that have changed since, with the stresses answered last and before laws commit. By one thread. */
void domain_book_strains(Domain *domain);
/** Work that strains of loads have done on the body so far: what it has received beyond the work of forces and motions. */
double domain_strain_work(const Domain *domain);
/** Adds to forces per volume what internal ones change by, with laws elastic and displacements as held, when strains of loads that begin with the stage under way
 *  have grown (loading_grown_factor). Strains are as before then, internal forces those of neither. By one thread; `time` of the run. */
int domain_add_grown_strains(Domain *domain, double time, const Vector *force, Error *error);
/** The sum of the sizes of forces that strains of loads would exert on particles if these had not moved: by what strains have changed since the stage under way
 *  began, at that time of the run; NaN: by all of them. */
int domain_forces_of_strains(Domain *domain, double begin, double time, double *sum, Error *error);
/** Strains of a state that has come back. */
void domain_follow_strains(Domain *domain);
void domain_strains_state(Domain *domain, StateList *list);
void domain_strains_destroy(Domain *domain);

/** What went wrong in a material server, one line; "" if nothing did. */
const char *domain_server_problem(const Domain *domain);
bool domain_has_servers(const Domain *domain);
/** points_begin, points_can_save and points_report (points/points.h) of all points: those of regions and of forces beside. */
int domain_begin_points(Domain *domain, Error *error);
bool domain_can_save_points(Domain *domain);
void domain_report_servers(const Domain *domain, double run_seconds, bool json, Text *text);
/** Whether forces are found with something as the step before left it. */
bool domain_lags(const Domain *domain);
/** Share of the forces that a step may leave out of balance once it is as the step left it; INFINITY: nothing lags, ever. */
double domain_lag_allowed(const Domain *domain);
/** A material whose server cannot repeat a trial, as iterations have it do; NULL: there is none. */
const Material *domain_without_trials(const Domain *domain);
/** A material whose law does not tell how stress changes with strain; NULL: there is none. */
const Material *domain_without_tangents(const Domain *domain);
/** Why a free body would gain energy as it moves unless its shortest waves are damped; NULL: it would not. */
const char *domain_flutters(const Domain *domain);
/** Whether the stable step may fall as bonds break. */
bool domain_may_stiffen(const Domain *domain);

/** Energy that unloading would give back, of all particles of the body itself [energy]. */
double domain_stored_energy(Domain *domain);
/** The part of that which the control of zero-energy modes holds (domain/control_energy.c) [energy]. */
double domain_control_energy(const Domain *domain);
/** Whether there is such a control. */
bool domain_is_controlled(const Domain *domain);

/** True if forces show what laws on bonds remember, so that they are state. */
bool domain_laws_in_forces(const Domain *domain);

/** True if no law dissipates, so that bonds give back what they do not lose by breaking. */
bool domain_is_elastic(const Domain *domain);

/** Strain and stress at a place as the law takes and gives them; where laws act on bonds, Green-Lagrange strain of the family and
 *  virial stress of the bonds. */
void domain_look(const Domain *domain, int64_t place, double strain[6], double stress[6]);

/** History number k of the law at a place, as committed; of bonds the mean over the family, of a damage with broken ones as 1, of others
 *  without them. */
double domain_history(const Domain *domain, int64_t place, int k);

/** Brings the arrays of strains and stresses up to date where no law or step writes them; makes them when they are first wanted. */
int domain_observe(Domain *domain, Error *error);

/** Lets evaluations leave strains and stresses of points on particles out, or no longer: whoever looks calls domain_observe before. Only where
 *  `may_leave_tensors` is set; else nothing happens. */
void domain_leave_tensors(Domain *domain, bool leave);
/** Gives memory back that the next evaluation writes before it reads it, for those who need room after the last one; then takes it again, with force states of
 *  the state held. Evaluations leave nothing out from then on. Only where `may_leave_tensors` is set. */
void domain_give_way(Domain *domain, bool give);
/** Makes force states again, in whose place domain_observe has put what is left out. */
void domain_stop_observing(Domain *domain);
/** Whether points are such that evaluations may leave their strains and stresses out: one region of Hooke's laws, not in plane stress, of which no bond breaks, that nothing
 *  strains beforehand, and on which nothing acts that may fail by itself, as bars and contact. */
bool domain_can_leave_tensors(const Domain *domain);
/** Finds what is left out, at the displacements held; forces stay as they are. */
void domain_find_tensors(Domain *domain);

/** Broken share of the family of a place, 0 to 1. */
double domain_damage(const Domain *domain, int32_t place);

/** Bytes in particles and points; in bonds; in the formulation. */
size_t domain_particle_bytes(const Domain *domain);
size_t domain_bytes(const Domain *domain);

#endif
