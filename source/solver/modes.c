/* K q = omega^2 M q by ARPACK (Lehoucq, Sorensen and Yang 1998), in its shift-invert mode: the largest eigenvalues of (K + s M)^-1 M belong to the lowest
 * frequencies. The shift s is small and positive, so that what moves as a whole is no exception and the equations are those of an implicit step, solved
 * in the same ways. Where K is not symmetric, as beside mirror images that are held in all directions, Arnoldi's iteration takes the place of Lanczos'. */
#include "solver/modes.h"

#include "base/library_threads.h"
#include "base/memory.h"
#include "base/random.h"
#include "solver/ledger.h"
#include <arpack.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/** ARPACK remembers between two calls where it is, in one place for all: one body at a time. */
static pthread_mutex_t arpack = PTHREAD_MUTEX_INITIALIZER;

enum { LOOK_BASIS = 12 };

/** What an iteration works in. */
typedef struct Look {
  double *columns, *values, *imaginary;
  int wanted, basis;
} Look;

typedef struct Search {
  Domain *domain;
  LinearSolver linear;
  int wanted, basis;
  int row[MAX_ROWS], rows; /* of motion, that the body has */
  a_int size;              /* of a column of numbers: those rows of all particles */
  Vector from, to;
  double *start, *columns, *work, *projected;
  double *values, *imaginary; /* of omega squared; of two that are complex the columns are the vector's two parts */
  a_int *chosen;
  double *known,
      *known_masses; /* [count of them] columns that are left out, of length 1 by mass and apart from each other, and M times them */
  int known_count;
  Look look;      /* for one mode beside them */
  bool symmetric; /* K is */
} Search;

/* ---- columns and vectors ---- */

static void pack(const Search *s, const Vector *v, double *column)
{
  const Particles *p = s->domain->particles;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < s->rows; ++k) column[n * s->rows + k] = v->row[s->row[k]][p->place_of[n]];
}

static void unpack(const Search *s, const double *column, const Vector *v)
{
  const Particles *p = s->domain->particles;
  vector_clear(v);
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < s->rows; ++k) v->row[s->row[k]][p->place_of[n]] = column[n * s->rows + k];
}

static void multiply_masses(const Search *s, const double *column, double *product)
{
  const Particles *p = s->domain->particles;
  unpack(s, column, &s->from);
  unknowns_spread(&s->linear.unknowns, NAN, &s->from);
  vector_weigh_product(&s->from, p->volume, &p->inertia, &s->from);
  unknowns_gather(&s->linear.unknowns, &s->from);
  pack(s, &s->from, product);
}

static double dot(const Search *s, const double *a, const double *b)
{
  double sum = 0;
  for (a_int k = 0; k < s->size; ++k) sum += a[k] * b[k];
  return sum;
}

/** Takes what a column has of those known, by mass. */
static void take_known_out(const Search *s, double *column)
{
  for (int n = 0; n < s->known_count; ++n) {
    const size_t at = (size_t)s->size * (size_t)n;
    const double part = dot(s, s->known_masses + at, column);
    for (a_int k = 0; k < s->size; ++k) column[k] -= part * s->known[at + (size_t)k];
  }
}

static int say_inexact(double residual, Error *error)
{
  return error_add(error, BRECCIA_FAILURE,
                   "the modes could not be found: equations with the body's stiffness were solved up to a residual of "
                   "%.1g only; look for springs and materials that differ by many powers of ten, and for parts that "
                   "hang by few bonds",
                   residual);
}

static int solve(Search *s, const double *column, double *answer, Error *error)
{
  /* Iterations may not come as far as the first; beyond the second nothing can be found. */
  const double accuracy = 1e-11, enough = 1e-6;
  LinearRecord record;
  unpack(s, column, &s->from);
  vector_clear(&s->to);
  if (linear_solver_solve(&s->linear, &s->from, &s->to, accuracy, &record, error)) return BRECCIA_FAILURE;
  if (!(record.residual <= enough)) return say_inexact(record.residual, error);
  unknowns_clear_rest(&s->linear.unknowns, &s->to);
  pack(s, &s->to, answer);
  take_known_out(s, answer);
  return BRECCIA_OK;
}

/* ---- iteration ---- */

static void fill_at_random(const Search *s, uint64_t seed, const Vector *v)
{
  const Particles *p = s->domain->particles;
  for (int k = 0; k < s->rows; ++k)
    for (int64_t n = 0; n < p->count; ++n)
      v->row[s->row[k]][p->place_of[n]] =
          (random_uniform(&seed) - 0.5) / unknowns_length(&s->linear.unknowns, s->row[k]);
  unknowns_clear_rest(&s->linear.unknowns, v);
}

/** a K b is b K a, of two vectors at random. */
static int find_symmetry(Search *s, Error *error)
{
  const double roundings = 1e-11; /* images at one face of a body of 1e8 particles make more */
  const Unknowns *u = &s->linear.unknowns;
  const Particles *p = s->domain->particles;
  Vector a = {0}, b = {0};
  int status = BRECCIA_FAILURE;
  if (vector_create(&a, &p->space, "modes", error) && vector_create(&b, &p->space, "modes", error)) {
    fill_at_random(s, 2, &a);
    fill_at_random(s, 3, &b);
    linear_solver_apply(&s->linear, &a, &s->to);
    unknowns_clear_rest(u, &a); /* what follows the unknowns was set */
    const double size = sqrt(unknowns_product_of_forces(u, &s->to, &s->to) * unknowns_product_of_motions(u, &b, &b)),
                 one = vector_inner(&s->to, &b, 1);
    linear_solver_apply(&s->linear, &b, &s->to);
    s->symmetric = fabs(one - vector_inner(&s->to, &a, 1)) <= roundings * size;
    status = BRECCIA_OK;
  }
  vector_destroy(&a);
  vector_destroy(&b);
  return status;
}

static int create(Search *s, int64_t unknowns, Error *error)
{
  s->basis = (int)fmin((double)unknowns, 2 * s->wanted + 10);
  const size_t size = (size_t)s->size, basis = (size_t)s->basis;
  s->start = memory_zeroed(size, sizeof(double), "modes", error);
  s->columns = memory_zeroed(size * basis, sizeof(double), "modes", error);
  s->work = memory_zeroed(3 * size, sizeof(double), "modes", error);
  s->projected =
      memory_zeroed(3 * basis * (basis + 3), sizeof(double), "modes", error); /* what Arnoldi's needs, and more */
  s->values = memory_zeroed(basis, sizeof(double), "modes", error);
  s->imaginary = memory_zeroed(basis, sizeof(double), "modes", error);
  s->chosen = memory_zeroed(basis, sizeof(a_int), "modes", error);
  s->known = memory_zeroed(size * (size_t)s->wanted, sizeof(double), "modes", error);
  s->known_masses = memory_zeroed(size * (size_t)s->wanted, sizeof(double), "modes", error);
  s->look = (Look){.columns = memory_zeroed(size * LOOK_BASIS, sizeof(double), "modes", error),
                   .values = memory_zeroed(LOOK_BASIS, sizeof(double), "modes", error),
                   .imaginary = memory_zeroed(LOOK_BASIS, sizeof(double), "modes", error),
                   .wanted = 1};
  const Particles *p = s->domain->particles;
  const bool made = s->start && s->columns && s->work && s->projected && s->values && s->imaginary && s->chosen &&
                    s->known && s->known_masses && s->look.columns && s->look.values && s->look.imaginary &&
                    vector_create(&s->from, &p->space, "modes", error) &&
                    vector_create(&s->to, &p->space, "modes", error);
  if (!made) return BRECCIA_FAILURE;
  return BRECCIA_OK;
}

static void destroy(Search *s)
{
  linear_solver_destroy(&s->linear);
  vector_destroy(&s->from);
  vector_destroy(&s->to);
  free(s->start);
  free(s->columns);
  free(s->work);
  free(s->projected);
  free(s->values);
  free(s->imaginary);
  free(s->chosen);
  free(s->known);
  free(s->known_masses);
  free(s->look.columns);
  free(s->look.values);
  free(s->look.imaginary);
}

/** The eigenvalues wanted, and their vectors in the first columns. @param[in] seed  of the vector to start with */
static int iterate(Search *s, double shift, uint64_t seed, Error *error)
{
  enum { MOST_RESTARTS = 300, EXACT_SHIFTS = 1, SHIFT_INVERT = 3, FIRST = -1, NEXT = 1, MASSES = 2, DONE = 99 };
  const double accuracy = 1e-10;
  a_int what = 0, status = 1, parameters[11] = {EXACT_SHIFTS, 0, MOST_RESTARTS, 1, 0, 0, SHIFT_INVERT}, at[14] = {0};
  const a_int room = 3 * s->basis * (s->basis + 3);
  fill_at_random(s, seed, &s->from);
  pack(s, &s->from, s->start);
  take_known_out(s, s->start);
  do {
    (s->symmetric ? dsaupd_c : dnaupd_c)(&what, "G", s->size, "LM", s->wanted, accuracy, s->start, s->basis, s->columns,
                                         s->size, parameters, at, s->work, s->projected, room, &status);
    double *from = s->work + at[0] - 1, *to = s->work + at[1] - 1;
    if (what == MASSES) multiply_masses(s, from, to);
    if (what == FIRST) multiply_masses(s, from, to);
    if (what == FIRST && solve(s, to, to, error)) return BRECCIA_FAILURE;
    if (what == NEXT && solve(s, s->work + at[2] - 1, to, error)) return BRECCIA_FAILURE;
  } while (what != DONE);
  if (!status && s->symmetric)
    dseupd_c(1, "A", s->chosen, s->values, s->columns, s->size, -shift, "G", s->size, "LM", s->wanted, accuracy,
             s->start, s->basis, s->columns, s->size, parameters, at, s->work, s->projected, room, &status);
  else if (!status) {
    double *scratch = memory_zeroed(3 * (size_t)s->basis, sizeof *scratch, "modes", error);
    if (!scratch) return BRECCIA_FAILURE;
    dneupd_c(1, "A", s->chosen, s->values, s->imaginary, s->columns, s->size, -shift, 0, scratch, "G", s->size, "LM",
             s->wanted, accuracy, s->start, s->basis, s->columns, s->size, parameters, at, s->work, s->projected, room,
             &status);
    free(scratch);
  }
  if (status)
    return error_add(error, BRECCIA_FAILURE,
                     "the modes could not be found: ARPACK's iteration ended with %d; ask for more or fewer of them",
                     (int)status);
  return BRECCIA_OK;
}

/** Adds a column to those known: what it has of them is taken out. */
static void make_known(Search *s, const double *column)
{
  const size_t at = (size_t)s->size * (size_t)s->known_count;
  double *known = s->known + at, *masses = s->known_masses + at;
  memcpy(known, column, sizeof(double) * (size_t)s->size);
  take_known_out(s, known);
  take_known_out(s, known); /* what roundings have left */
  multiply_masses(s, known, masses);
  const double size = sqrt(dot(s, known, masses));
  for (a_int k = 0; k < s->size; ++k) {
    known[k] /= size;
    masses[k] /= size;
  }
  ++s->known_count;
}

/** Of the values that are known. */
static int find_highest(const double *values, int count)
{
  int highest = 0;
  for (int n = 1; n < count; ++n)
    if (values[n] > values[highest]) highest = n;
  return highest;
}

/** Lanczos' iteration comes upon a second mode of one frequency only by roundings, which may be after it has ended: looks for the lowest mode beside
 *  those found. One below the highest of them takes its place, until there is none. Vectors of Arnoldi's iteration are no modes then.
 *  @param[in,out] values  [count] of the columns found
 *  @param[out] missed  one was missing */
static int look_for_missed(Search *s, double shift, int count, double *values, bool *missed, Error *error)
{
  const double equal = 1e-9;
  *missed = false;
  for (int looked = 0; looked < count; ++looked) {
    const int highest = find_highest(values, count);
    const int status = iterate(s, shift, 5, error);
    if (status) return status;
    if (!(s->values[0] < values[highest] - equal * (fabs(values[highest]) + shift))) return BRECCIA_OK;
    *missed = true;
    if (!s->symmetric) return BRECCIA_OK;
    values[highest] = s->values[0];
    /* The last one moves to where the highest was, so that the new one can come last. */
    const size_t size = (size_t)s->size, last = size * (size_t)(count - 1), there = size * (size_t)highest;
    const double value = values[highest];
    memmove(s->known + there, s->known + last, sizeof(double) * size);
    memmove(s->known_masses + there, s->known_masses + last, sizeof(double) * size);
    values[highest] = values[count - 1];
    values[count - 1] = value;
    --s->known_count;
    make_known(s, s->columns);
  }
  return BRECCIA_OK;
}

/** Exchanges what an iteration works in for what a look for one mode does. */
static void exchange(Search *s, Look *look)
{
  const Look held = {s->columns, s->values, s->imaginary, s->wanted, s->basis};
  s->columns = look->columns;
  s->values = look->values;
  s->imaginary = look->imaginary;
  s->wanted = look->wanted;
  s->basis = look->basis;
  *look = held;
}

/** All the lowest modes, in the columns and values. @param[in] unknowns  of the body */
static int iterate_surely(Search *s, double shift, int64_t unknowns, Error *error)
{
  enum { SEEDS = 4, LEAST = 4 };
  const int count = s->wanted;
  const bool looks = count > 1 && unknowns - count >= LEAST; /* a basis of nearly all unknowns finds all */
  bool missed = true;
  int status = BRECCIA_OK;
  for (uint64_t seed = 1; seed <= SEEDS && missed && !status; ++seed) {
    status = iterate(s, shift, seed, error);
    missed = false;
    if (status || !looks) continue;
    s->look.basis = (int)fmin(LOOK_BASIS, (double)(unknowns - count));
    s->known_count = 0;
    for (int n = 0; n < count; ++n) make_known(s, s->columns + (size_t)s->size * (size_t)n);
    double *values = s->values;
    exchange(s, &s->look);
    status = look_for_missed(s, shift, count, values, &missed, error);
    exchange(s, &s->look);
    s->known_count = 0;
    if (!s->symmetric) continue;
    memcpy(s->columns, s->known, sizeof(double) * (size_t)s->size * (size_t)count);
    missed = false;
  }
  if (!missed || status) return status;
  return error_add(error, BRECCIA_FAILURE,
                   "the modes could not be found: of several with about one frequency one is missed; ask for more or "
                   "fewer of them");
}

/* ---- what comes out ---- */

/** What is left of K q - omega^2 M q, of the whole with the shift. */
static double find_residual(Search *s, const double *column, double square)
{
  const double shifted = square + s->linear.mass_factor;
  double *forces = s->work, *masses = s->work + s->size, left = 0, whole = 0;
  unpack(s, column, &s->from);
  linear_solver_apply(&s->linear, &s->from, &s->to);
  pack(s, &s->to, forces);
  multiply_masses(s, column, masses);
  for (a_int k = 0; k < s->size; ++k) {
    const double length = unknowns_length(&s->linear.unknowns, s->row[k % s->rows]);
    left += pow((forces[k] - shifted * masses[k]) / length, 2);
    whole += pow(shifted * masses[k] / length, 2);
  }
  return sqrt(left / whole);
}

/** Sum of mass u v over the body. */
static double mass_product(const Search *s, const Mode *a, const Mode *b)
{
  const Particles *p = s->domain->particles;
  double sum = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    if (body_outside(&s->domain->body, n)) continue;
    const int32_t i = p->place_of[n];
    for (int k = 0; k < p->space.rows; ++k)
      sum += p->inertia.row[k][i] * p->volume[i] * a->displacement.row[k][i] * b->displacement.row[k][i];
  }
  return sum;
}

/** Of modes of about one frequency every mixture is one: takes that which has nothing of those before. Lanczos' iteration gives it by itself, Arnoldi's
 *  any other. */
static void part_from_equals(const Search *s, double square, const double *squares, const Modes *modes, int n)
{
  const double equal = 1e-3;
  for (int m = 0; m < n && !s->symmetric; ++m) {
    if (fabs(square - squares[m]) > equal * (fabs(square) + s->linear.mass_factor)) continue;
    const double part =
        mass_product(s, &modes->modes[n], &modes->modes[m]) / mass_product(s, &modes->modes[m], &modes->modes[m]);
    vector_combine(1, &modes->modes[n].displacement, -part, &modes->modes[m].displacement);
  }
}

/** Mirror images outside the body follow it, and are no part of its mass. */
static void finish_mode(const Search *s, Mode *mode)
{
  const Particles *p = s->domain->particles;
  double moved[3] = {0}, mass = 0, squares = 0, largest = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    if (body_outside(&s->domain->body, n)) continue;
    const int32_t i = p->place_of[n];
    mass += p->density[i] * p->volume[i];
    for (int k = 0; k < p->space.rows; ++k) {
      const double v = mode->displacement.row[k][i], u = unknowns_length(&s->linear.unknowns, k) * v;
      if (k < p->space.rotation) moved[k] += p->density[i] * p->volume[i] * v;
      squares += p->inertia.row[k][i] * p->volume[i] * v * v;
      if (fabs(u) > (1 + 1e-6) * fabs(largest)) largest = u; /* of equal ones the first, whatever their roundings */
    }
  }
  for (int k = 0; k < 3; ++k) mode->share[k] = squares > 0 ? moved[k] * moved[k] / (mass * squares) : 0;
  if (largest != 0) vector_scale(&mode->displacement, 1 / largest);
}

static int take_mode(const Search *s, int from, Mode *mode, Error *error)
{
  if (!vector_create(&mode->displacement, &s->domain->particles->space, "modes", error)) return BRECCIA_FAILURE;
  unpack(s, s->columns + (size_t)s->size * (size_t)from, &mode->displacement);
  unknowns_spread(&s->linear.unknowns, NAN, &mode->displacement);
  return BRECCIA_OK;
}

/** Omega squared up to which a mode cannot be told from one of none: so far that of some mode may lie from what was found, which leaves a residual,
 *  and ten times as far where masses or stiffness are uneven. */
static double hidden_square(const Search *s, double square, double residual)
{
  const double roundings = 1e-12; /* of the shift, which was taken off */
  return fmax(10 * residual * fabs(square + s->linear.mass_factor), roundings * s->linear.mass_factor);
}

/** @param[in] squares  [wanted] room for omega squared of each */
static int take_modes(Search *s, double *squares, Modes *modes, Error *error)
{
  modes->modes = memory_zeroed((size_t)s->wanted, sizeof *modes->modes, "modes", error);
  if (!modes->modes) return BRECCIA_FAILURE;
  modes->count = s->wanted;
  const double pair = 1e-3; /* complex to this share: two modes of about one frequency */
  for (int n = 0; n < s->wanted; ++n) {
    int from = 0; /* the lowest that is not taken yet */
    for (int k = 1; k < s->wanted; ++k)
      if (s->values[k] < s->values[from]) from = k;
    const double square = s->values[from];
    s->values[from] = INFINITY;
    squares[n] = square;
    if (fabs(s->imaginary[from]) > pair * (fabs(square) + s->linear.mass_factor))
      return error_add(error, BRECCIA_FAILURE,
                       "the modes could not be found: forces of mirror images outside a face join two of them; hold "
                       "layers by 'displacement' in place of 'support: {held: all}'");
    const double residual = find_residual(s, s->columns + (size_t)s->size * (size_t)from, square), enough = 1e-3;
    if (!(residual <= enough)) return say_inexact(residual, error);
    const double hidden = hidden_square(s, square, residual);
    if (square < -hidden)
      return error_add(error, BRECCIA_FAILURE, "the body gives way by itself: a mode has a negative stiffness");
    const bool rigid = n == modes->rigid && square <= hidden;
    modes->modes[n].frequency = rigid ? 0 : sqrt(fmax(0, square)) / (2 * acos(-1));
    modes->rigid += rigid;
    if (take_mode(s, from, &modes->modes[n], error)) return BRECCIA_FAILURE;
    part_from_equals(s, square, squares, modes, n);
    finish_mode(s, &modes->modes[n]);
  }
  return BRECCIA_OK;
}

void modes_destroy(Modes *modes)
{
  for (int n = 0; n < modes->count; ++n) vector_destroy(&modes->modes[n].displacement);
  free(modes->modes);
  *modes = (Modes){0};
}

/** Squared, the frequency of waves over the length of the body. */
static double wave_square(const Domain *d)
{
  double low[3], high[3], square = 0;
  particles_bounds(d->particles, low, high);
  for (int k = 0; k < 3; ++k) square += pow(high[k] - low[k], 2);
  square = fmax(square, pow(d->body.largest_spacing, 2));
  return pow(ledger_wave_speed(d), 2) / square;
}

double modes_shift(const Domain *d)
{
  return 1e-2 * wave_square(d);
}

int modes_find(Domain *d, const Loading *loading, int count, Modes *modes, Error *error)
{
  const double shift = modes_shift(d);
  Search s = {.domain = d,
              .wanted = count,
              .linear = {.domain = d, .loading = loading, .unknowns = unknowns_of(d, loading), .mass_factor = shift}};
  for (int k = 0; k < d->particles->space.rows; ++k)
    if (body_moves_along(&d->body, k)) s.row[s.rows++] = k;
  const double size = (double)s.rows * (double)d->particles->count;
  s.size = (a_int)size;
  const int64_t unknowns = unknowns_count(&s.linear.unknowns, error);
  if (unknowns < 0) return BRECCIA_FAILURE;
  if (count >= unknowns)
    return error_add(error, BRECCIA_USER_ERROR, "%d modes are too many for a body with %lld unknowns", count,
                     (long long)unknowns);
  if ((double)s.size != size) return error_add(error, BRECCIA_USER_ERROR, "the body is too large for ARPACK");
  const bool elastic = domain_in_elastic_stage(d);
  domain_set_elastic_stage(d, true);
  int status = domain_linearise(d, NULL, error);
  if (!status) forces_linearise(&d->forces);
  domain_set_elastic_stage(d, elastic);
  if (!status) status = create(&s, unknowns, error);
  if (!status) status = find_symmetry(&s, error);
  if (!status) status = linear_solver_create(&s.linear, LINEAR_AUTOMATIC, error);
  if (!status) status = linear_solver_prepare(&s.linear, error);
  if (!status) status = library_memory(error);
  if (!status) {
    pthread_mutex_lock(&arpack);
    const LibraryThreads before = library_threads_forbid();
    status = iterate_surely(&s, shift, unknowns, error);
    library_threads_allow(before);
    pthread_mutex_unlock(&arpack);
  }
  if (!status) status = take_modes(&s, s.projected, modes, error);
  destroy(&s);
  domain_evaluate(d, NULL);
  return status;
}
