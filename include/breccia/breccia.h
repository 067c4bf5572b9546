/* Breccia: peridynamics for concrete, soil and rock. The public interface, and all of it.
 *
 * A model is loaded from a deck (YAML), stepped, looked at and written. Nothing here keeps state outside the objects
 * that it hands out: two models may exist in one process, each used by one thread at a time.
 * Functions return a status and put the words into the error that they are given (one line per problem). */
#ifndef BRECCIA_H
#define BRECCIA_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BRECCIA_VERSION "0.1.0"
#define BRECCIA_API __attribute__((visibility("default")))

enum {
  BRECCIA_OK = 0,          /* done */
  BRECCIA_FAILURE = 1,     /* the computation or the machine failed */
  BRECCIA_USER_ERROR = 2,  /* the deck, the files or the arguments are wrong */
  BRECCIA_INTERRUPTED = 3, /* stopped on request; everything so far is written */
};

/* ---- errors ---- */

typedef struct breccia_error breccia_error;

BRECCIA_API breccia_error *breccia_error_create(void);
/** @return all lines, without a final newline; "" if nothing went wrong. Valid until the error is next used. */
BRECCIA_API const char *breccia_error_text(const breccia_error *error);
BRECCIA_API void breccia_error_destroy(breccia_error **error);

/* ---- constitutive laws ---- */

/** One parameter of a law: the reader, the messages, the help and the documentation are made from this. An optional one that is
 *  called "length" is the length over which a fracture energy is spread; where a deck leaves it out it is the formulation's. */
typedef struct breccia_parameter {
  const char *name;      /* key in the deck, lower case words */
  const char *dimension; /* "1", "stress", "density", "length", ... (docs/deck.md lists them) */
  const char *standard;  /* default as it would stand in a deck; NULL: required; "": optional, read as NaN */
  const char *range;     /* admissible interval in the deck's units, like "(0, inf)" or "[0, 1)"; NULL: any */
  const char *meaning;
} breccia_parameter;

/** Points handed to a law at once. Component order xx yy zz xy yz zx, engineering shear strains, tension positive. A
 *  law of one component has strain[0], stress[0], and one number of tangent per point. */
typedef struct breccia_batch {
  int count;
  const double *strain[6]; /* total strain, [count] each */
  double *stress[6];       /* out, [count] each */
  /* History, one row of `history_values` numbers per point. `committed` is never written. `trial` is its twin: on entry it
   * holds what an earlier trial from this same committed state left, or the state committed before it; a law with
   * a long history may rely on that and copy only what changed. Both start as `begin` made them. */
  const double *committed;
  double *trial;
  double *tangent;        /* out, [count][36] row by row, d stress / d strain; NULL: not wanted */
  int elastic_stage;      /* 1: respond elastically whatever the law (gravity stage) */
  double time, time_step; /* at the end of the step under way, and its length; 0 where time does not pass */
  const double *length;   /* over which a fracture energy is spread, [count]; NULL: not known */
} breccia_batch;

/** A constitutive law: strain to stress for many points. */
typedef struct breccia_law {
  const char *name, *about, *source; /* deck name; one line; paper and equations */
  const char *maturity;              /* "verified against ...", "validated against ..." or "experimental" */
  const char *equations;             /* for the page of models, lines of Markdown; may be NULL */
  const char *opensees;              /* command of the same law there; may be NULL */
  const breccia_parameter *parameters;
  int parameter_count;
  size_t constants_size; /* bytes that `prepare` fills */
  int components;        /* 6: takes the strains of a point in space, 1: one strain (of a bond) */
  int linear;            /* 1: stress is a constant times strain up to failure, so that points need not be kept */
  /** Parameter values (in table order) to constants. @return 0, or 1 with the reason in words */
  int (*prepare)(const double *values, void *constants, char *reason, size_t reason_size);
  /** Gives back what `prepare` took beside the constants. NULL: nothing. */
  void (*release)(void *constants);
  /** Elastic moduli of the undamaged material, for stable steps and zero-energy control. */
  void (*moduli)(const void *constants, double *bulk, double *shear);
  /** Of a law of one component: the strain beyond which a point carries nothing for good, so that its bond breaks. NULL: never. */
  double (*failure_strain)(const void *constants);
  /** Numbers of history per point; NULL: none. */
  int (*history_values)(const void *constants);
  /** Name of history number k for result files; "" where it is of no use to people. NULL: none has a name. */
  void (*history_name)(const void *constants, int k, char *name, size_t size);
  /** Writes the history of one point that was never strained. NULL: zeros. */
  void (*begin)(const void *constants, double *history);
  /** Stress, trial history and, if wanted, tangent. @return -1, or the first point that could not be integrated */
  int (*update)(const void *constants, const breccia_batch *batch);
} breccia_law;

/* ---- models ---- */

typedef struct breccia_model breccia_model;

typedef struct breccia_options {
  const breccia_law *const
      *laws; /* laws of one's own, `law_count` of them, borrowed for the model's life; may be NULL */
  int law_count;
  int threads;                 /* 0: what OMP_NUM_THREADS says, or one for each core that the process may use */
  int force;                   /* 1: accept a time step above the stable one */
  const char *const *settings; /* "key.path=value" each, instead of what the deck says; borrowed for the model's life */
  int setting_count;
} breccia_options;

/** Reads and checks a deck and builds the body, its families and its material points. Nothing is written.
 *  @param[in] options  NULL for the defaults */
BRECCIA_API int breccia_model_load_file(const char *path, const breccia_options *options, breccia_model **model,
                                        breccia_error *error);
/** The same from text; `name` stands for the file name in messages. */
BRECCIA_API int breccia_model_load_string(const char *deck, const char *name, const breccia_options *options,
                                          breccia_model **model, breccia_error *error);
BRECCIA_API void breccia_model_destroy(breccia_model **model);

/** Advances by up to `steps` time steps (fewer where the deck's steps end). Writes no files. */
BRECCIA_API int breccia_model_step(breccia_model *model, int64_t steps, breccia_error *error);

typedef struct breccia_run {
  const char *folder; /* for all files; made if need be */
  int restart;        /* 1: go on from the checkpoint in the folder */
  int64_t steps;      /* stop after so many steps in all; 0: as the deck says */
  const volatile int
      *interrupted; /* polled between steps: non-zero stops the run cleanly, with a checkpoint; may be NULL */
  void (*progress)(void *context, int64_t step, int64_t steps,
                   double seconds_left); /* a few times a second; may be NULL */
  void *context;
} breccia_run;

/** Runs to the end and writes results, histories, checkpoints, pictures and summary.json.
 *  @return BRECCIA_INTERRUPTED after a clean stop on request; BRECCIA_FAILURE otherwise. After a step that failed the state before it is
 *  written, and a checkpoint of it. After "energy from nothing" results and histories hold the state at which the run stopped, to
 *  show what went wrong, and the checkpoint written before stays. */
BRECCIA_API int breccia_model_run(breccia_model *model, const breccia_run *run, breccia_error *error);

/** What a run would do, in some lines; warnings about the deck, one per line; what a run did and which files it wrote.
 *  Valid until the model is next used. */
BRECCIA_API const char *breccia_model_overview(breccia_model *model);
/** What the deck's numbers mean in SI units: materials, body, waves, loads; some lines. */
BRECCIA_API const char *breccia_model_plausibility(breccia_model *model);
/** The deck as it is run, in YAML: settings, included files, aliases and expressions are worked out in it. */
BRECCIA_API const char *breccia_model_deck(const breccia_model *model);
BRECCIA_API const char *breccia_model_warnings(breccia_model *model);
BRECCIA_API const char *breccia_model_outcome(breccia_model *model);

BRECCIA_API int64_t breccia_model_particles(const breccia_model *model);
BRECCIA_API int64_t breccia_model_bonds(const breccia_model *model);        /* directed, as built: twice the pairs */
BRECCIA_API int64_t breccia_model_broken_bonds(const breccia_model *model); /* pairs */
BRECCIA_API int64_t breccia_model_steps_done(const breccia_model *model);
BRECCIA_API double breccia_model_time(const breccia_model *model);
/** "stage 2 of 3, NAME"; "" where a deck has one stage. Valid until the model is next used. */
BRECCIA_API const char *breccia_model_stage(breccia_model *model);
BRECCIA_API double breccia_model_time_step(const breccia_model *model);
BRECCIA_API double breccia_model_stable_time_step(const breccia_model *model);

/** Entries of every particle array. Particles lie in slices of eight; places that no particle uses have number -1. */
BRECCIA_API int64_t breccia_model_places(const breccia_model *model);
/** Global number of the particle in each place, or -1, [places]. Numbers run along x first, then y, then z, block by block. */
BRECCIA_API const int32_t *breccia_model_numbers(const breccia_model *model);
/** The model's own array, [places]; read it, write to it between steps. Names: "position x", "displacement x",
 *  "velocity x" (and y, z), "volume", "density"; read-only in meaning: "force x" (internal, per volume), "external force x",
 *  "acceleration x", "strain xx", "stress xx" ... (with bonds: as of this call), "displacement at zero x": what results subtract from the
 *  displacement after a stage with `displacements: zero`
 *  @return NULL if there is no such array */
BRECCIA_API double *breccia_model_array(breccia_model *model, const char *name);

#ifdef __cplusplus
}
#endif

#endif
