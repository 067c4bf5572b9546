#include "solver/linear_solver.h"

#include "base/team.h"
#include <math.h>
#include <string.h>

#define LINEAR(word, name, about) extern const LinearType name##_linear;
#include "solver/linear_types.h"
#undef LINEAR

static const LinearType *const types[] = {
#define LINEAR(word, name, about) &name##_linear,
#include "solver/linear_types.h"
#undef LINEAR
};

static const char *const words[] = {[LINEAR_AUTOMATIC] = "automatic",
#define LINEAR(word, name, about) word,
#include "solver/linear_types.h"
#undef LINEAR
                                    NULL};

enum { TYPES = sizeof types / sizeof *types };

/* More products than this for one solution: a way that suits the body better is taken from then on, where there is one. */
enum { TEDIOUS = 500 };

const char *linear_word(int k)
{
  return words[k];
}

const char *linear_solver_name(const LinearSolver *s)
{
  int k = 0;
  while (types[k] != s->type) ++k;
  return words[k + 1];
}

const char *linear_solver_words(const LinearSolver *s)
{
  return s->type->words ? s->type->words : linear_solver_name(s);
}

const char *linear_refusal(int word, const Unknowns *unknowns)
{
  return word != LINEAR_AUTOMATIC && types[word - 1]->refusal ? types[word - 1]->refusal(unknowns) : NULL;
}

int linear_solver_create(LinearSolver *s, int word, Error *error)
{
  s->is_free = word == LINEAR_AUTOMATIC;
  for (int k = 0; k < TYPES; ++k) {
    if (word == k + 1) s->type = types[k];
    if (s->is_free && (!s->type || types[k]->suits(s) > s->type->suits(s))) s->type = types[k];
  }
  s->first = s->type;
  return s->type->create(s, error);
}

void linear_solver_destroy(LinearSolver *s)
{
  if (s->type) s->type->destroy(s);
  *s = (LinearSolver){0};
}

LinearForesight linear_solver_foresee(const LinearSolver *s)
{
  if (s->type->foresee) return s->type->foresee(s);
  return (LinearForesight){.bytes = (double)s->type->bytes(s)};
}

void linear_solver_state(LinearSolver *s, StateList *list)
{
  state_add_count(list, "ways of equations given up", STATE_LEARNED, &s->given_up);
}

/** Takes the way that the state asks for. @return status of creating it */
static int follow_state(LinearSolver *s, Error *error)
{
  if (s->left == s->given_up) return BRECCIA_OK;
  s->type->destroy(s);
  s->own = NULL;
  s->type = s->first;
  for (s->left = 0; s->left < s->given_up && s->type->instead; ++s->left) s->type = s->type->instead;
  s->given_up = s->left;
  return s->type->create(s, error);
}

int linear_solver_prepare(LinearSolver *s, Error *error)
{
  const int status = follow_state(s, error);
  return status ? status : s->type->prepare(s, error);
}

/** The other way from now on, beginning with these equations. */
static int take_instead(LinearSolver *s, const Vector *f, const Vector *v, double tolerance, LinearRecord *record,
                        Error *error)
{
  const LinearRecord before = *record;
  *record = (LinearRecord){0};
  vector_clear(v);
  ++s->given_up;
  if (linear_solver_prepare(s, error) || s->type->solve(s, f, v, tolerance, record, error)) return BRECCIA_FAILURE;
  record->iterations += before.iterations;
  record->indefinite |= before.indefinite;
  return BRECCIA_OK;
}

int linear_solver_solve(LinearSolver *s, const Vector *f, const Vector *v, double tolerance, LinearRecord *record,
                        Error *error)
{
  *record = (LinearRecord){0};
  int status = s->left != s->given_up ? linear_solver_prepare(s, error) : BRECCIA_OK;
  if (!status) status = s->type->solve(s, f, v, tolerance, record, error);
  while (!status && !record->stopped && record->unsuited && !(s->definite && record->indefinite) && s->is_free &&
         s->type->instead && s->type->instead->suits(s) > 0)
    status = take_instead(s, f, v, tolerance, record, error);
  const LinearType *next = s->type->instead;
  if (!status && !record->stopped && s->is_free && record->iterations > TEDIOUS && next &&
      next->suits(s) > s->type->suits(s))
    ++s->given_up; /* followed when the next equations are prepared */
  return status;
}

typedef struct Weighing {
  const LinearSolver *solver;
  const Vector *v, *kv;
} Weighing;

/** Changes of forces per volume to forces against them. */
BRECCIA_CLONES
static void weigh_tile(void *context, int64_t first, int64_t last)
{
  const Weighing *w = context;
  const Particles *p = w->solver->domain->particles;
  const Lanes factor = lanes_set(w->solver->mass_factor);
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = first; i < last; i += LANES) {
      const Lanes mass = factor * lanes_load(p->inertia.row[k] + i);
      lanes_store(w->kv->row[k] + i,
                  lanes_load(p->volume + i) * (mass * lanes_load(w->v->row[k] + i) - lanes_load(w->kv->row[k] + i)));
    }
}

void linear_solver_apply(LinearSolver *s, const Vector *v, const Vector *kv)
{
  unknowns_spread(&s->unknowns, NAN, v);
  if (s->elastic)
    elastic_step_apply(s->elastic, s->domain, v, kv);
  else
    domain_linear_step(s->domain, v, kv);
  if (s->stiffness_share != 0) vector_scale(kv, 1 + s->stiffness_share);
  if (!s->elastic) domain_change_forces(s->domain, v, kv);
  loading_change(s->loading, s->domain->particles, v->row, kv->row);
  vector_each_tile(v->space, weigh_tile, &(Weighing){s, v, kv});
  unknowns_gather(&s->unknowns, kv);
}
