/* Solves K v = f for changes of the unknowns, at the state at which the domain was linearised (domain_linearise). */
#ifndef BRECCIA_SOLVER_LINEAR_SOLVER_H
#define BRECCIA_SOLVER_LINEAR_SOLVER_H

#include "solver/elastic_step.h"
#include "solver/unknowns.h"

typedef struct LinearSolver LinearSolver;

/** How a solution went. */
typedef struct LinearRecord {
  int64_t iterations; /* products with K; 0 of a direct solver */
  double residual;    /* what is left of the right-hand side, over all of it */
  bool indefinite;    /* K has a direction against which the body does not resist */
  bool unsuited;      /* the way does not solve with such a K, and another has to be taken */
  bool stopped;       /* after as many products as are allowed, with no answer */
} LinearRecord;

/** What a way to solve takes, about. */
typedef struct LinearForesight {
  double seconds, bytes; /* to make ready for other equations; 0 seconds: try it */
} LinearForesight;

/** A way to solve; the list is in linear_types.h. */
typedef struct LinearType LinearType;
struct LinearType {
  const char *words;         /* what equations are solved by, where the key of the deck does not say it; or NULL */
  bool any_stiffness;        /* also stiffness that is not symmetric */
  const LinearType *instead; /* where the deck does not say, and K turns out not to suit this one; or NULL */
  /** How well it suits the body: the way with the highest number is taken where the deck does not say; 0: not at all. */
  double (*suits)(const LinearSolver *solver);
  /** Why the matrix that it needs is not to be had of a body under the loads that act; NULL: it is, or it needs none. */
  const char *(*refusal)(const Unknowns *unknowns);
  int (*create)(LinearSolver *solver, Error *error);
  void (*destroy)(LinearSolver *solver);
  /** The domain was linearised again. */
  int (*prepare)(LinearSolver *solver, Error *error);
  /** @param[in] f  forces, a vector of unknowns; @param[out] v  a vector of unknowns; 0 before; @param[in] tolerance  of the residual over f */
  int (*solve)(LinearSolver *solver, const Vector *f, const Vector *v, double tolerance, LinearRecord *record,
               Error *error);
  size_t (*bytes)(const LinearSolver *solver);
  /** What it will take, where trying that would take as long. NULL: not long. */
  LinearForesight (*foresee)(const LinearSolver *solver);
};

struct LinearSolver {
  const LinearType *type;
  Domain *domain;
  const Loading *loading;
  Unknowns unknowns;
  /* (1 + stiffness_share) K + mass_factor M is solved instead, in implicit dynamics; both are 0 in statics. Loads that follow displacements have no
   * share. */
  double stiffness_share, mass_factor;
  const ElasticStep *elastic; /* K is this stiffness; NULL: that at which the domain was linearised */
  int64_t allowed; /* products of one solution; 0: as many as it takes; minimal residuals end the round begun */
  bool definite;   /* where K turns out not to be positive definite no other way is taken: the caller asks for it */
  bool is_free;    /* the deck does not say which */
  const LinearType *first; /* the way that was taken at the beginning */
  int64_t given_up, left;  /* ways that did not suit: by the state, which may come back, and those left so far */
  void *own;               /* what the type keeps */
};

/** Indices of the linear solvers that decks choose, in the order of linear_word. */
enum {
  LINEAR_AUTOMATIC,
#define LINEAR(word, name, about) LINEAR_##name,
#include "solver/linear_types.h"
#undef LINEAR
};
/** Returns the word of a linear solver in decks: "automatic", then the solvers; NULL after the last. */
const char *linear_word(int k);

/** Why the matrix that a way of a deck needs is not to be had of a body under the loads that act; NULL: it is, or it needs none.
 *  @param[in] word  index of linear_word */
const char *linear_refusal(int word, const Unknowns *unknowns);

/** `solver` has domain, loading and unknowns, and is zero beyond; destroy it in any case.
 *  @param[in] word  index of linear_word */
int linear_solver_create(LinearSolver *solver, int word, Error *error);
void linear_solver_destroy(LinearSolver *solver);
int linear_solver_prepare(LinearSolver *solver, Error *error);
int linear_solver_solve(LinearSolver *solver, const Vector *f, const Vector *v, double tolerance, LinearRecord *record,
                        Error *error);

/** Rows of what a solution to come depends on: which way is taken. */
void linear_solver_state(LinearSolver *solver, StateList *list);

/** Forces K v, with loads that follow displacements and the mass factor, on the unknowns.
 *  @param[in,out] v  a change of displacements: what is not free is made to follow, without motions that are prescribed
 *  @param[out] kv    a vector of unknowns */
void linear_solver_apply(LinearSolver *solver, const Vector *v, const Vector *kv);

/** What the way that is taken needs. */
LinearForesight linear_solver_foresee(const LinearSolver *solver);

/** Name of the way that is taken, as in a deck. */
const char *linear_solver_name(const LinearSolver *solver);
/** The same as words that can stand behind "by". */
const char *linear_solver_words(const LinearSolver *solver);

#endif
