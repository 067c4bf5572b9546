/* Breccia: peridynamics for concrete, soil and rock. The public interface, and all of it.
 *
 * A model is loaded from a deck (YAML), stepped, looked at and written. Nothing here keeps state outside the objects
 * that it hands out: two models may exist in one process, each used by one thread at a time.
 * Functions return a status and put the words into the error that they are given (one line per problem). A NULL pointer
 * where an object is needed is BRECCIA_USER_ERROR; functions that look at an object return 0, NaN, NULL or "" of NULL.
 * A model with threads belongs to the process that loaded it: after a fork the child is refused.
 *
 * A struct of this header begins with its size, which whoever makes it sets: `breccia_run run = {.size = sizeof run, ...}`. So a
 * program and a library of different versions understand each other: what the older one does not know of is zero.
 *
 * The process that embeds the library stays as it is: threads of the library take no signals, no handler is set (but for
 * `trap` of breccia_options), and the locale of the calling thread and what HDF5 does with errors are given back at the end of each call. */
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

/** Words that came from elsewhere, for a message: control characters and bytes that are no UTF-8 as \n, \t, \xNN, so that they stay in one line and a
 *  terminal does not obey them. @return a copy to be given back by breccia_text_free; NULL when memory is out */
BRECCIA_API char *breccia_visible_text(const char *words);

/** Gives back text that was handed out for the caller to keep; NULL: nothing. */
BRECCIA_API void breccia_text_free(char *text);

/* ---- constitutive laws ---- */

/** One parameter of a law: the reader, the messages, the help and the documentation are made from this. An optional one that is
 *  called "length" is the length over which a fracture energy is spread; a deck that leaves it out takes that of the
 *  formulation.
 *  An optional parameter that is called "dimensions" defaults to the dimension of the body; NaN outside a body.
 *  Parameters with the names of laws that are built in ("tensile strength", "fracture energy", "yield stress", ...) get
 *  the same checks and advice. */
typedef struct breccia_parameter { /* a row of a table, and therefore without a size: it stays as it is */
  const char *name;                /* key in the deck, lower case words */
  const char *dimension;           /* "1", "stress", "density", "length", ... (docs/deck.md lists them) */
  const char *standard;            /* default as it would stand in a deck; NULL: required; "": optional, read as NaN */
  const char *range;               /* admissible interval in the deck's units, like "(0, inf)" or "[0, 1)"; NULL: any */
  const char *meaning;
} breccia_parameter;

/** Points handed to a law at once. Component order xx yy zz xy yz zx, engineering shear strains, tension positive. A
 *  law of one component has strain[0], stress[0], and one number of tangent per point. */
typedef struct breccia_batch {
  size_t size;
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
  /* Elongation of bonds by Poisson's effect of the elastic pressure across them [count], 0 or more. Filled for laws
   * with `takes_lateral`; NULL: none */
  const double *lateral;
  /* Where the points stand, for laws with `takes_places`; NULL where they stand in no body (laboratory tests, checks of
   * a law, material servers, bars). Particles are numbered by their rows in result files, from 0; a point in a layer
   * outside of a support stands where its image inside does.
   * particle: both ends of a bond; twice the same number for a point of a particle [2][count].
   * position: in the reference configuration, of a bond its midpoint [3][count], in the deck's unit of length.
   * direction: unit vector from particle[0] to particle[1] in the reference configuration [3][count]; NULL for points
   * of particles. */
  const int32_t *particle[2];
  const double *position[3], *direction[3];
} breccia_batch;

/** One point of a body, as breccia_batch has many. */
typedef struct breccia_place {
  size_t size;
  int32_t particle[2];
  double position[3];
  double direction[3]; /* 0 for points of particles */
} breccia_place;

/** How the deviator of an isotropic law flows, for formulations that have no strain to give it (ordinary peridynamics). */
typedef struct breccia_deviator {
  double yield_stress;    /* in uniaxial tension, of von Mises, without hardening; infinite: it does not yield */
  double relaxing;        /* share of the shear modulus that relaxes, 0 to 1 */
  double relaxation_time; /* in which it falls to 1 / e */
} breccia_deviator;

/** How links of a material are damaged by their stretch, for formulations that have links in the place of points (micropolar peridynamics). All that a link
 *  carries is multiplied by (1 - damage in tension) (1 - damage in compression). */
typedef struct breccia_link {
  double tension_begin, tension_end; /* stretches at which damage in tension begins, and is 1 */
  int linear_force;                  /* 1: in between the force falls linearly; 0: damage grows linearly */
  double fracture_energy; /* per area of crack, from which the formulation finds `tension_end`; NaN: it stands there */
  double compression_begin, compression_end; /* shortening, as positive numbers; infinite: there is no such damage */
  double recovery; /* share of what tension has damaged along a link that it carries again in compression */
  double initial_fracture_energy; /* of it what the first of two lines spends that the force falls by; 0: it is one */
  double tension_kink;            /* where the second one begins, as a share of the largest force */
  double tension_first_end;       /* where the first one would end, which the formulation finds too; 0: there is one */
} breccia_link;

/** A constitutive law: strain to stress for many points. */
typedef struct breccia_law {
  size_t size;
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
  /** Writes the history of one point that was never strained: the same numbers at every call, which may come more than
   *  once for a point and from several threads. A law whose `begin` writes other numbers when it is called again is
   *  refused. NULL: zeros. */
  void (*begin)(const void *constants, double *history);
  /** Stress, trial history and, if wanted, tangent. A point without strain must have a finite stress.
   *  @return -1, or the index of the first point that could not be integrated, 0 to count - 1 */
  int (*update)(const void *constants, const breccia_batch *batch);
  /** How its deviator flows, if that and `moduli` say all. NULL: they do not. @return 0, or 1 with the reason in words */
  int (*deviator)(const void *constants, breccia_deviator *deviator, char *reason, size_t reason_size);
  int takes_time; /* 1: stress depends on how long steps take */
  /** Of a law that softens until it has spent a fracture energy: elastic energy per volume of a point pulled in one direction as it begins to.
   *  Zero-energy control then fades with the stiffness that a point has left. NULL: it does not soften. */
  double (*softening_energy)(const void *constants);
  /** How links of this material are damaged. NULL: they are not, by this law. @return 0, or 1 with the reason in words */
  int (*link)(const void *constants, breccia_link *link, char *reason, size_t reason_size);
  /** Dimension of history number k that has a name, like "stress"; "": a plain number. NULL: all are plain numbers. */
  const char *(*history_dimension)(const void *constants, int k);
  /** 1: history number k is a damage, from 0 to 1, and a bond that is broken counts as 1 in the mean over a family. NULL: none is. */
  int (*history_is_damage)(const void *constants, int k);
  /** 1: no compression is too large for it, so that the last words of a run tell the largest one. NULL: it yields,
   * crushes, or nobody knows. */
  int (*never_crushes)(const void *constants);
  /** Divides the strengths among parameter values (in table order; NaN: not given) by a factor, for factors of safety:
   * cohesions, yield stresses, and the tangents of angles of friction. Histories must stay admissible under the
   * strengths that `prepare` makes of them. NULL: the law does not tell. */
  void (*reduce_strength)(double *values, double factor);
  int takes_lateral; /* 1: the law has one component and reads `lateral` of its batches; single points have none */
  /** Returns the compressive strength of a body of bonds of this law, above 0. NULL: the law reports none. */
  double (*compressive_strength)(const void *constants);
  /** Number, counted from 1, of the history value in which bonds of plane bodies find the confining pressure after each
   * step [stress], 0 or more: the smaller principal pressure in the plane. `update` copies it. 0: the law reads none. */
  int confined_history;
  int takes_places; /* 1: `update` reads the members of breccia_batch that tell where points stand */
  /** Writes the history of one point of a body that was never strained, by where it stands: called in the place of
   *  `begin`, which is needed, too, for points in no body. As for `begin`, the same numbers at every call; they must
   *  have a stress of 0 without strain. Not with `initial stress`. NULL: `begin` serves all points. */
  void (*begin_point)(const void *constants, const breccia_place *place, double *history);
} breccia_law;

/** @return the k-th law of the library, or NULL after the last */
BRECCIA_API const breccia_law *breccia_law_at(int k);

/* ---- models ---- */

typedef struct breccia_model breccia_model;

typedef struct breccia_options {
  size_t size;
  const breccia_law *const
      *laws; /* laws of one's own, `law_count` of them, borrowed for the model's life; may be NULL */
  int law_count;
  int threads; /* 0: what OMP_NUM_THREADS says, or one for each core that the process may use; at most 16 of them a core, or 64 */
  int force;                   /* 1: accept a time step above the stable one */
  const char *const *settings; /* "key.path=value" each, instead of what the deck says; borrowed for the model's life */
  int setting_count;
  int trap; /* 1: the first division by zero, overflow or invalid operation in a step stops the run and is told with its place in the
             * program. Meanwhile the process has a handler for SIGFPE, which hands on what is not of the model's threads */
  int loose; /* 1: a body that nothing holds is no mistake in stages of statics until they begin, for breccia_model_modes */
  /** Polled by breccia_model_step as by breccia_model_run: non-zero ends it with BRECCIA_INTERRUPTED, in the state after
   *  the last step that was done. Borrowed for the model's life; may be NULL. */
  const volatile int *interrupted;
} breccia_options;

/** Reads and checks a deck and builds the body, its families and its material points. Nothing is written.
 *  @param[in] options  NULL for the defaults */
BRECCIA_API int breccia_model_load_file(const char *path, const breccia_options *options, breccia_model **model,
                                        breccia_error *error);
/** The same from text; `name` stands for the file name in messages. */
BRECCIA_API int breccia_model_load_string(const char *deck, const char *name, const breccia_options *options,
                                          breccia_model **model, breccia_error *error);
BRECCIA_API void breccia_model_destroy(breccia_model **model);

/** Advances by up to `steps` time steps (fewer where the deck's steps end). Writes no files. Displacements and
 * velocities that the program writes before a step are motions of its own: their work is booked as external work.
 *  @return BRECCIA_INTERRUPTED where `interrupted` of breccia_options asked for it */
BRECCIA_API int breccia_model_step(breccia_model *model, int64_t steps, breccia_error *error);

typedef enum breccia_restart {
  BRECCIA_RESTART_NO,
  BRECCIA_RESTART_LAST,   /* go on from the checkpoint in the folder */
  BRECCIA_RESTART_BEFORE, /* go on from the one before it, which becomes the last */
} breccia_restart;

typedef struct breccia_run {
  size_t size;
  const char *folder; /* for all files; made if need be */
  int restart;        /* breccia_restart */
  int64_t steps;      /* stop after so many steps in all; 0: as the deck says */
  const volatile int *
      interrupted; /* polled between steps, and between the iterations of an increment at rest, but not while bonds break there: non-zero stops the run cleanly, with a
                     * checkpoint; may be NULL */
  void (*progress)(void *context, int64_t step, int64_t steps,
                   double seconds_left); /* a few times a second; may be NULL */
  void *context;
} breccia_run;

/** Runs to the end and writes results, histories, checkpoints, pictures and summary.json.
 *  @return BRECCIA_INTERRUPTED after a clean stop on request; BRECCIA_FAILURE otherwise. After a step that failed the state before it is
 *  written, and a checkpoint of it. After "energy from nothing", absurd speeds or a trap results and histories hold the state
 *  at which the run stopped, to show what went wrong, and the checkpoint written before stays. A picture that cannot be written is a failure,
 *  after which all else is there; one that cannot be drawn (results do not hold it, gnuplot is not installed) a warning. */
BRECCIA_API int breccia_model_run(breccia_model *model, const breccia_run *run, breccia_error *error);

typedef struct breccia_modes {
  size_t size;
  const char *folder; /* for a table, results and pictures; made if need be; NULL: nothing is written */
  int count;          /* of modes, the slowest first */
} breccia_modes;

/** Frequencies and modes of vibration of the body, elastic and whole, as it is held in the stage under way. They are told in
 *  breccia_model_outcome, with advice for loading and damping. */
BRECCIA_API int breccia_model_modes(breccia_model *model, const breccia_modes *modes, breccia_error *error);

/** What a run would do, in some lines (NULL when memory is out); warnings about the deck, one per line; what a run did and which files it wrote.
 *  Valid until the model is next used. */
BRECCIA_API const char *breccia_model_overview(breccia_model *model);
/** What the deck's numbers mean in SI units: materials, body, waves, loads; some lines. NULL when memory is out. */
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
/** What has happened to reinforcing bars so far, to tell while a run goes on: "bars yield", "bars torn"; "" before, and without bars. */
BRECCIA_API const char *breccia_model_event(const breccia_model *model);
BRECCIA_API double breccia_model_time_step(const breccia_model *model);
BRECCIA_API double breccia_model_stable_time_step(const breccia_model *model);

/** Entries of every particle array. Particles lie in slices of eight; places that no particle uses have number -1. */
BRECCIA_API int64_t breccia_model_places(const breccia_model *model);
/** Global number of the particle in each place, or -1, [places]. Numbers run along x first, then y, then z, block by block. */
BRECCIA_API const int32_t *breccia_model_numbers(const breccia_model *model);

typedef struct breccia_array {
  size_t size;
  const char *name; /* "displacement" */
  const char *about;
  char unit[32];                  /* in the deck's units: "m"; "" for numbers without */
  int components;                 /* 1, 3 or 6 */
  int writable;                   /* 1: what is written to it between steps takes effect; others are for reading */
  const char *component_names[6]; /* "x", "xx"; NULL for one */
  double *values[6]; /* the model's own arrays, [places] each; they stay where they are as long as the stage lasts */
} breccia_array;

/** What the model has of each particle: its arrays, one after another. Strains and stresses are as of this call.
 *  @param[in] k       from 0
 *  @param[out] array  its size is set by the caller
 *  @return 1; 0 after the last */
BRECCIA_API int breccia_model_array_at(breccia_model *model, int k, breccia_array *array);
/** One component of an array by its whole name, like "displacement x", "stress xx" or "volume".
 *  @return [places], or NULL if there is no such array */
BRECCIA_API double *breccia_model_array(breccia_model *model, const char *name);

/* ---- pages that the library makes of its own tables ---- */

enum {
  BRECCIA_PAGE_DECK,   /* every key of a deck, in Markdown */
  BRECCIA_PAGE_SCHEMA, /* the same as JSON Schema, for editors */
  BRECCIA_PAGE_LAWS,   /* the constitutive laws, in Markdown */
  BRECCIA_PAGE_BUILD,  /* version, commit, vector lanes, libraries and licence of this build, a line each */
};
/** @return the page, for breccia_text_free; NULL when memory is out */
BRECCIA_API char *breccia_page(int page);
/** A law and its parameters in some lines, for people; `law` NULL: all laws, and the formulations.
 *  @return text for breccia_text_free; NULL after a message */
BRECCIA_API char *breccia_describe_law(const char *law, breccia_error *error);
/** The laws that the installed OpenSees offers to a deck, laid out for people.
 *  @param[out] text  for breccia_text_free; NULL after a failure */
BRECCIA_API int breccia_describe_opensees(char **text, breccia_error *error);
/** The title of a deck or of a laboratory test, for breccia_text_free; "" if it has none, NULL when memory is out.
 *  @param[out] is_test  1 for a laboratory test; may be NULL */
BRECCIA_API char *breccia_deck_title(const char *deck, int *is_test);
/** The one among some words that was probably meant by another; NULL if none is near. */
BRECCIA_API const char *breccia_nearest_word(const char *given, const char *const *words, int count);
/** How many threads a model gets that asks for none. */
BRECCIA_API int breccia_threads(void);

/* ---- pictures of results ---- */

enum { BRECCIA_STATE_LAST, BRECCIA_STATE_ALL, BRECCIA_STATE_OF_STEP, BRECCIA_STATE_NEAR_TIME };

typedef struct breccia_plot {
  size_t size;
  const char *title, *x_label, *y_label; /* NULL: the deck's title; what the axes show */
  const char *
      path; /* .png, .svg or .pdf; NULL: in the folder of pictures beside the results; with several states a number goes before
                     * the ending */
  void (*drawn)(void *context, const char *path); /* told of each file; may be NULL */
  void *context;
  double low, high; /* ends of the colours, or of the horizontal axis of a curve; NaN: from the data */
  /* of fields */
  const char *field, *component; /* component NULL: the only one, or the length of a vector */
  int state;                     /* BRECCIA_STATE_... */
  int64_t step;
  double time, deformed;     /* scale of displacements */
  double azimuth, elevation; /* degrees; NaN: chosen from the body's shape */
  int each_range;            /* 1: every picture has colours of its own range */
  int broken_bonds;          /* 1: they are drawn */
  double pixels;             /* largest width of the body; 0: 640, of bodies in space 460 */
  double rate;               /* of movies: states a second; 0: so that it lasts about ten seconds */
  /* of curves */
  const char
      *curve; /* "watch.column : watch.column", further vertical ones behind commas; NULL: all energies over time */
  const char *overlay, *log_axes; /* CSV file whose first two columns are drawn as points; "x", "y" or "xy" */
  /* of fields */
  double low_corner[3], high_corner[3]; /* of a box: only particles that stand in it before they move; NaN: no limit */
  /* of reinforcing bars */
  const char *
      bars; /* what a deck may give its pictures as `bars` (docs/deck.md), like "stress": bars in these colours over the pale body, in place of a
                     * field; NULL: the field */
  const double *times; /* [time_count] of curves over their length, up to 6; the states nearest to them are taken */
  int time_count;      /* 0: `state` */
  const char *const *
      of_bars; /* [of_bar_count] names of bars whose curves over length are drawn, one that is repeated for all of its lines */
  int of_bar_count; /* 0: all bars, of many those with the largest values */
  void (*replaces)(
      void *context,
      const char *
          path); /* told, before `drawn`, of a picture whose path was not given and that has taken the place of another file; may be NULL */
} breccia_plot;

/** Fills in what a picture is like if nobody asks for something else: the last state, undistorted colours, no scale of displacements but 1. */
BRECCIA_API void breccia_plot_begin(breccia_plot *plot, size_t size);
/** Draws a field of some written states. @param[in] result  a folder of results, or a file of them */
BRECCIA_API int breccia_plot_field(const char *result, const breccia_plot *plot, breccia_error *error);
/** All written states as a movie to `path`, an .mp4 file; needs ffmpeg. */
BRECCIA_API int breccia_plot_movie(const char *result, const breccia_plot *plot, breccia_error *error);
/** Columns of histories against each other; several folders give a line each. */
BRECCIA_API int breccia_plot_curve(const char *const *folders, int count, const breccia_plot *plot,
                                   breccia_error *error);
/** What `bars` names over the length of reinforcing bars. @param[in] result  a folder of results, or a file of them */
BRECCIA_API int breccia_plot_over_length(const char *result, const breccia_plot *plot, breccia_error *error);
/** @return 1 if pictures can be drawn to files with this ending */
BRECCIA_API int breccia_can_draw(const char *path);

/* ---- why bonds broke ---- */

typedef struct breccia_why {
  size_t size;
  long long first;   /* number of broken bonds to list, in the order in which they broke */
  int one_bond;      /* 1: only the bond between two particles */
  long long bond[2]; /* numbers of the two particles, with one_bond */
} breccia_why;

/** Reports the number of broken bonds of a result by cause, and the time, position and reason of single bonds; then the
 *  number of bonds or material points past their peak at the last written state, and the most damaged ones.
 *  @param[in]  result  folder of results, or a file of them
 *  @param[out] text    for breccia_text_free; NULL after a failure
 *  @return 0; 2: no results, damaged ones, or a bond that did not break */
BRECCIA_API int breccia_explain_breaks(const char *result, const breccia_why *wish, char **text, breccia_error *error);

/* ---- the laboratory: one material point ---- */

typedef struct breccia_test breccia_test;

/** A test in words, as on a command line. NULL and 0 are what the words of the command `material` say of them. */
typedef struct breccia_test_words {
  size_t size;
  const char *law, *units;             /* units: of length, force and time, like "m, kN, s" */
  const char *const *parameters;       /* "key=value" each */
  int parameter_count, cycles;         /* cycles: 0: once to the strain */
  const char *path;                    /* CSV file of total strains, or a test: */
  const char *kind, *to, *back;        /* its kind, the strain that it goes to, and the other end of its cycles */
  const char *confining, *strain_zero; /* pressure before anything else; where strain is zero */
  int64_t steps, elastic_rows;         /* from end to end; of a path: so many rows are answered elastically */
  const char *duration;                /* of each way to an end of a test; a path may have a column 'time' */
} breccia_test_words;

/** Reads a test from its file (docs/laboratory.md), or makes one from words. */
BRECCIA_API int breccia_test_load(const char *path, breccia_test **test, breccia_error *error);
BRECCIA_API int breccia_test_make(const breccia_test_words *words, breccia_test **test, breccia_error *error);
BRECCIA_API void breccia_test_destroy(breccia_test **test);

/** Runs the test. What came before a failure is kept.
 *  @param[in] tangents  1: columns of the tangent too */
BRECCIA_API int breccia_test_run(breccia_test *test, int tangents, breccia_error *error);
/** What somebody should look at, one line each; of what was done so far. Valid until the test is next used. */
BRECCIA_API const char *breccia_test_doubts(const breccia_test *test);

/** Columns of the states that the point went through: "strain xx", "stress xx (kPa)" ... @return NULL after the last */
BRECCIA_API const char *breccia_test_heading(const breccia_test *test, int column);
BRECCIA_API const double *breccia_test_column(const breccia_test *test, int column); /* [rows] */
BRECCIA_API int breccia_test_rows(const breccia_test *test);

typedef struct breccia_comparison {
  size_t size;
  int points;                           /* measured ones; 0: there are none */
  double mean, most;                    /* distance from the curve in parts of their range: root mean square, largest */
  const char *x_label, *y_label, *unit; /* of the curve; unit: of y */
} breccia_comparison;

/** Holds measured points against the curve of the test that was run.
 *  @param[in] path  a CSV file; NULL: the one that the test's file names, if it does */
BRECCIA_API int breccia_test_compare(breccia_test *test, const char *path, breccia_comparison *comparison,
                                     breccia_error *error);
/** Draws the curve with the points that it was compared with or fitted to. */
BRECCIA_API int breccia_test_draw(const breccia_test *test, const char *path, breccia_error *error);

typedef struct breccia_fit {
  size_t size;
  int points, starts, agreeing,
      runs;                   /* descents, those that ended as near to the points as the best; runs of the test */
  double before, after, most; /* mean distance with the file's values and with the fitted ones; the largest after */
  double next;                /* mean distance of the best of the starts that did not agree; infinite: none */
} breccia_fit;

typedef struct breccia_fitted {
  size_t size;
  const char *name, *unit, *judgement; /* judgement: how well the points tell it, in words */
  double value, from, to;
  double deviation,
      margin; /* standard deviation; change that moves the curve by a thousandth; infinite: the points do not tell */
} breccia_fitted;

/** Chooses the parameters under `fit` in the test's file such that measured points lie nearest to the curve, and leaves the material with them.
 *  @param[in] path  as for breccia_test_compare */
BRECCIA_API int breccia_test_fit(breccia_test *test, const char *path, breccia_fit *fit, breccia_error *error);
/** @return 1; 0 after the last of the fitted parameters; -1 when memory is out */
BRECCIA_API int breccia_test_fitted_at(breccia_test *test, int k, breccia_fitted *parameter);

typedef struct breccia_concrete { /* numbers with units, in words; NULL: by rule */
  size_t size;
  const char *compression, *tension; /* strengths; one at least is given */
  const char *fracture_energy, *aggregate, *modulus, *poisson, *density, *spacing;
  int unverified; /* 1: no plates are run, and with a fracture energy the tensile stretch is that of an even stress */
  const char *initial_fracture_energy; /* NULL: the force falls by one line */
} breccia_concrete;
/** Parameters of 'link-damage' for a lattice of links that is to be such a concrete, and what plates of it bear.
 *  @param[out] words  a block of a deck with comments, for breccia_text_free; NULL after a message */
BRECCIA_API int breccia_concrete_calibrate(const breccia_concrete *concrete, char **words, breccia_error *error);

/* ---- studies: one deck with several values of some of its keys ---- */

typedef struct breccia_study breccia_study;

typedef struct breccia_study_plan { /* borrowed for the study's life */
  size_t size;
  const char *deck, *folder;   /* the deck's file; where the cases go */
  const char *const *varied;   /* "key.path=from:to:n" or "key.path=a, b, c" */
  const char *const *settings; /* of all cases */
  const char *const *results;  /* of the table; none: peaks, broken bonds and what the deck's curves show */
  const char *const *curves;   /* drawn for all cases in one picture; none: those of the deck */
  int varied_count, setting_count, result_count, curve_count;
  int together; /* 1: the first values of all varied keys, then the second ...; 0: all combinations */
} breccia_study_plan;

enum {
  BRECCIA_CASE_NEW,     /* nothing of it is there, or of another deck */
  BRECCIA_CASE_STOPPED, /* its run ended early and can go on from its checkpoint */
  BRECCIA_CASE_FAILED,  /* its run ended early, and from where it ended it would do so again */
  BRECCIA_CASE_DONE,
};

typedef struct breccia_case {
  size_t size;
  const char *name, *folder;   /* "spacing-5-mm" */
  const char *const *settings; /* for breccia_options */
  int setting_count, state;    /* BRECCIA_CASE_..., as its folder says at this call */
} breccia_case;

/** Makes the cases and reads the deck of each as far as that goes without a body. Running them is up to the caller. */
BRECCIA_API int breccia_study_create(const breccia_study_plan *plan, breccia_study **study, breccia_error *error);
BRECCIA_API void breccia_study_destroy(breccia_study **study);
/** @return 1; 0 after the last */
BRECCIA_API int breccia_study_case_at(const breccia_study *study, int k, breccia_case *one);
/** A number of a case's summary.json, like "rest.unbalanced". @return 1, or 0 where there is none */
BRECCIA_API int breccia_study_figure(const breccia_study *study, int k, const char *name, double *value);
/** What the cases gave, from their folders: table.csv, table.txt and pictures in the study's folder. */
BRECCIA_API int breccia_study_report(breccia_study *study, breccia_error *error);
/** Of the last report: the readable table; names of the files written, a line each. */
BRECCIA_API const char *breccia_study_table(const breccia_study *study);
BRECCIA_API const char *breccia_study_files(const breccia_study *study);

/* ---- motions of the ground and of bodies: intensity, response spectra, transfer functions ---- */

typedef struct breccia_motion breccia_motion;

/** Where a motion stands: accelerations, or velocities, which are differentiated. */
typedef struct breccia_motion_file {
  size_t size;
  /* A record of PEER, the USGS (SMC), COSMOS or K-NET; two columns, times and values; values alone; or, with
   * `column`, a CSV file with a heading. */
  const char *path;
  const char *column; /* which one holds the values; NULL: the file has no heading, or is of the database */
  const char *times;  /* which one holds the times, with a column; NULL: "time" */
  const char *
      unit; /* of values where the file does not say it: "g", "m/s2", "cm/s"; NULL: it does. Times are in s where it says nothing */
  double step; /* s, between values of a file of values alone; 0: the file has times, or a step of its own */
  int channel; /* of a COSMOS file with several channels of accelerations, from 1 on; 0: the file has one */
} breccia_motion_file;

BRECCIA_API int breccia_motion_load(const breccia_motion_file *file, breccia_motion **motion, breccia_error *error);
BRECCIA_API void breccia_motion_destroy(breccia_motion **motion);

typedef struct breccia_motion_wish {
  size_t size;
  double damping;           /* of oscillators, share of the critical one, 0 to below 1; NaN: 0.05 */
  double shortest, longest; /* periods in s; NaN: 0.01 and 10 */
  int periods;              /* at equal ratios from the shortest to the longest; 0: 60 in each tenfold */
  double smoothing;         /* bandwidth of Konno and Ohmachi's window; 0: amplitudes of single frequencies; NaN: 40 */
} breccia_motion_wish;

/** Finds what the motion is. @param[in] over  the motion below it, over which it is held; NULL: none. It is read, and not kept
 *  @param[in] wish  NULL: what each NaN and 0 of it stands for */
BRECCIA_API int breccia_motion_analyse(breccia_motion *motion, const breccia_motion *over,
                                       const breccia_motion_wish *wish, breccia_error *error);

typedef struct breccia_intensity { /* in m and s */
  size_t size;
  double acceleration, velocity, displacement; /* largest sizes; from rest, without a correction of the baseline */
  double arias;                                /* pi / (2 g) times the integral of squared accelerations */
  double from, to;                             /* times at which 5 and 95 % of that have come; NaN of no motion */
} breccia_intensity;

/** @return 0 if the struct has no size, else 1 */
BRECCIA_API int breccia_motion_intensity(const breccia_motion *motion, breccia_intensity *intensity);

enum {
  BRECCIA_MOTION_HISTORY,  /* time, acceleration, velocity, displacement, Husid's curve */
  BRECCIA_MOTION_RESPONSE, /* period, displacement, pseudo-velocity, pseudo-acceleration, acceleration */
  BRECCIA_MOTION_FOURIER, /* frequency, amplitude; of two motions the other's amplitude, and the ratio: the transfer function,
                            * NaN where the other has less than a thousandth of its largest amplitude */
};
/** Columns of what was found: "period (s)", "displacement (m)" ... @return NULL after the last */
BRECCIA_API const char *breccia_motion_heading(const breccia_motion *motion, int table, int column);
BRECCIA_API const double *breccia_motion_column(const breccia_motion *motion, int table, int column); /* [rows] */
BRECCIA_API int breccia_motion_rows(const breccia_motion *motion, int table);

/** The same for people, in some lines; "" before it was found. */
BRECCIA_API const char *breccia_motion_words(const breccia_motion *motion);
/** Writes the tables and pictures of them to a folder, which is made if need be. */
BRECCIA_API int breccia_motion_write(breccia_motion *motion, const char *folder, breccia_error *error);
/** Names of the files written, a line each. */
BRECCIA_API const char *breccia_motion_files(const breccia_motion *motion);

/* ---- the library's own laws for other programs ---- */

typedef struct breccia_service {
  size_t size;
  const char *address;     /* tcp://127.0.0.1:PORT, unix:/PATH or udp://127.0.0.1:PORT */
  const char *secret_file; /* clients must know the words in it; NULL: none, and only this machine is listened to */
  int once;                /* 1: end when the first client has gone */
  int zeros;               /* 1: answer with zeros instead of stresses: what the protocol itself costs */
  const volatile int *interrupted;        /* non-zero ends it; may be NULL */
  void (*listening)(const char *address); /* told once it does; may be NULL */
} breccia_service;

/** Serves until it is told to end, one client at a time (docs/material-server.md). */
BRECCIA_API int breccia_serve(const breccia_service *service, breccia_error *error);

#ifdef __cplusplus
}
#endif

#endif
