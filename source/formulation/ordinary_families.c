/* Bond factors with which incomplete families are isotropic: near surfaces, notches and other blocks, and of particles
 * from files.
 *
 * A family shows the moduli of its material in every uniform strain if
 *   S = sum w |xi|^2 n n n n / m
 * over its bonds is isotropic. Near a surface bonds are missing on one side, and m is less: bonds along the surface
 * count too much, by up to a half in S. A bar of ten by ten rows would be 19 % too stiff, one of three by three rows
 * twice as stiff as it should be (docs/theory.md 3).
 *
 * Every bond of which both ends lack bonds gets a factor s, alike for both ends. In each of five turns every such
 * family finds the smallest change of its factors that makes S isotropic,
 *   h(n) = x . H(n),
 * where H are the products of the fourth order of the components of n less their means:
 *   (A + c) x = -sum q H,  A = sum q H H over the bonds that may change,  q = w s |xi|^2 over its sum.
 * The factor s becomes s (1 + (h_i + h_j) / 2). The damping c leaves errors that no positive factors remove: at an
 * edge, bonds on one side only have products n_x n_y of one sign. Components of H count by their multiplicities, so
 * that nothing depends on the axes.
 *
 * With S isotropic in every family, beams of few rows would bend too much: the middle of a bond at a face is inside of
 * the face, where the strain of bending is less. A family i at a surface therefore keeps a share a of its anisotropy
 * r_i without factors. The other incomplete families j around it take the opposite:
 *   sum q H / sum q = T,  T_i = a g_i r_i at the surface,  T_j = -sum_i a g_i r_i V_i / (sum of V_j of family i).
 * The surface becomes stiffer, and the layers below become softer by the same amount. Tension is unchanged. Bending,
 * which weights stiffness by the square of the distance, becomes stiffer as required. In bodies without layers below
 * the surface g is 0. */
#include "formulation/ordinary.h"

#include "base/lanes.h"
#include "base/linear.h"
#include "base/memory.h"
#include "base/team.h"
#include "formulation/whole_family.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TERMS = 15, TERM_ROOM = 16, TURNS = 5 };

static const double damping = 0.03;          /* c, beside a trace of A of 0.8 in space and 0.6 in the plane */
static const double most_taken = 0.5;        /* share of its factor that a family takes off a bond in one turn */
static const double factors[2] = {0.05, 10}; /* limits of s */
static const double kept = 0.6;              /* a, share of the anisotropy that a surface family keeps */
static const double below_surface = 0.21,
                    at_surface = 0.3; /* missing share of volume of a family: onset; full effect */

/** A component of H. */
typedef struct FamilyTerm {
  int power[3];
  double scale, mean; /* root of its multiplicity; mean of the product over all directions */
} FamilyTerm;

/* What a place wishes: the index of its x, or one of these. */
enum { WISHES_NOTHING = -1, WISHES_AS_OTHERS = -2 };

typedef struct FamilyBalance {
  Ordinary *o;
  FamilyTerm term[MOST_TERMS];
  int terms;
  double *of_patterns; /* [patterns][TERM_ROOM] H */
  int32_t *wish;       /* [places] */
  double *x;           /* [wishes][TERM_ROOM] */
  double *own, *goal;  /* [wishes][TERM_ROOM] r and T */
  double *surface;     /* [places] weight from 0, below the surface or inside, to 1, at the surface */
  double *given;       /* [places] a g V over the volume of the families that take the opposite */
} FamilyBalance;

static void families_list_terms(FamilyBalance *b)
{
  static const double even_mean[5] = {1, 0, 1, 0, 3}, factorial[5] = {1, 1, 2, 6, 24};
  const int d = b->o->dimensions;
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4 - i; ++j) {
      const int k = 4 - i - j;
      if (d == 2 && k) continue;
      b->term[b->terms++] = (FamilyTerm){.power = {i, j, k},
                                         .scale = sqrt(factorial[4] / (factorial[i] * factorial[j] * factorial[k])),
                                         .mean = even_mean[i] * even_mean[j] * even_mean[k] / (d * (d + 2))};
    }
}

static void families_products(const FamilyBalance *b, const double xi[3], double length, double h[TERM_ROOM])
{
  double power[3][5];
  for (int k = 0; k < 3; ++k) {
    power[k][0] = 1;
    for (int n = 1; n < 5; ++n) power[k][n] = power[k][n - 1] * (xi[k] / length);
  }
  memset(h, 0, sizeof *h * TERM_ROOM);
  for (int t = 0; t < b->terms; ++t) {
    const int *n = b->term[t].power;
    h[t] = b->term[t].scale * (power[0][n[0]] * power[1][n[1]] * power[2][n[2]] - b->term[t].mean);
  }
}

/** H of a bond. @param[out] room  where it is found, for bonds that are in no table */
static const double *families_bond_products(const FamilyBalance *b, int64_t slice, int64_t slot, const Bond *bond,
                                            double room[TERM_ROOM])
{
  const Family *f = b->o->family;
  if (slot < f->stored[slice]) return b->of_patterns + (int64_t)TERM_ROOM * family_pattern(f, slice, slot);
  families_products(b, bond->xi, bond->length, room);
  return room;
}

static double families_along(const double h[TERM_ROOM], const double x[TERM_ROOM])
{
  double sum = 0;
  for (int t = 0; t < MOST_TERMS; ++t) sum += h[t] * x[t];
  return sum;
}

/* ---- which families ---- */

/** Whether a place has bonds enough to resist every strain. */
static bool families_resists(const Ordinary *o, int64_t place)
{
  return family_count(o->family, (int32_t)place) >= o->dimensions * (o->dimensions + 1) / 2;
}

/** Whether a place on a lattice has all bonds of the lattice, and no others. */
static bool families_is_complete(const Ordinary *o, int64_t place)
{
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  const int block = o->particles->block[slice];
  int64_t count = 0, others = 0;
  if (!o->body->lattices[block].chunks) return false;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    const bool intact = f->intact[slot] >> place % SLICE & 1;
    if (slot < f->stored[slice])
      count += intact;
    else
      others += intact;
  }
  return count == f->pattern_begin[block + 1] - f->pattern_begin[block] && !others;
}

static void families_mark(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  const Ordinary *o = b->o;
  const int32_t number = o->particles->number[place];
  b->wish[place] = WISHES_NOTHING;
  if (number < 0) return;
  /* Images beyond a plane of symmetry wish what the particles wish of which they are images. */
  const int64_t original = o->particles->place_of[body_original(o->body, number)];
  if (is_foreign(o->foreign, place))
    b->wish[place] = WISHES_AS_OTHERS;
  else if (!families_is_complete(o, original) && families_resists(o, original))
    b->wish[place] = 0;
}

static bool families_may_change(const FamilyBalance *b, int64_t slice, int64_t slot, int lane)
{
  const Family *f = b->o->family;
  return (f->intact[slot] >> lane & 1) && b->wish[slice * SLICE + lane] >= 0 &&
         b->wish[family_bond(f, slice, slot, lane).neighbour] != WISHES_NOTHING;
}

static bool families_slice_changes(const FamilyBalance *b, int64_t slice)
{
  const Family *f = b->o->family;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane)
      if (families_may_change(b, slice, slot, lane)) return true;
  return false;
}

/** Makes room for factors of 1 where they may change. */
static int families_make_factors(const FamilyBalance *b, Error *error)
{
  Ordinary *o = b->o;
  const Family *f = o->family;
  const int64_t slices = o->particles->slices;
  size_t count = 0;
  uint8_t *changes = memory_zeroed((size_t)slices, 1, "bond constants", error);
  o->surface = memory_zeroed((size_t)slices, sizeof *o->surface, "bond constants", error);
  for (int64_t slice = 0; slice < slices && changes && o->surface; ++slice)
    if ((changes[slice] = families_slice_changes(b, slice)) != 0)
      count += (size_t)(f->first[slice + 1] - f->first[slice]) * SLICE;
  if (changes && o->surface)
    o->surfaces = memory_zeroed(count ? count : 1, sizeof *o->surfaces, "bond constants", error);
  if (o->surfaces) {
    o->surface_count = count;
    float *at = o->surfaces;
    for (size_t k = 0; k < count; ++k) at[k] = 1;
    for (int64_t slice = 0; slice < slices; ++slice) {
      if (!changes[slice]) continue;
      o->surface[slice] = at;
      at += (f->first[slice + 1] - f->first[slice]) * SLICE;
    }
  }
  free(changes);
  return o->surfaces ? BRECCIA_OK : BRECCIA_FAILURE;
}

/* ---- what they wish ---- */

/** Adds q H H to rows of a matrix. */
BRECCIA_CLONES
static void families_add_square(double a[MOST_TERMS][TERM_ROOM], const double h[TERM_ROOM], double q)
{
  for (int i = 0; i < MOST_TERMS; ++i) {
    const double factor = q * h[i];
    for (int j = 0; j < TERM_ROOM; ++j) a[i][j] += factor * h[j];
  }
}

/** Returns true if bond constants of a family are sought at the place itself, and not at the original of an image. */
static bool families_is_own(const FamilyBalance *b, int64_t place)
{
  return b->wish[place] >= 0 && !body_outside(b->o->body, b->o->particles->number[place]);
}

/** Solves (A + c) x = r, both over the sum of q. */
static void families_solve(const FamilyBalance *b, double a[MOST_TERMS][TERM_ROOM], const double r[TERM_ROOM],
                           double total, double x[TERM_ROOM])
{
  const int n = b->terms;
  double matrix[MOST_TERMS * MOST_TERMS];
  int begin[MOST_TERMS];
  memset(x, 0, sizeof *x * TERM_ROOM);
  if (!(total > 0)) return;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) matrix[i * n + j] = a[i][j] / total + (i == j ? damping : 0);
  for (int i = 0; i < n; ++i) x[i] = r[i] / total;
  if (linear_factor(n, matrix, begin))
    linear_factor_solve(n, matrix, begin, x);
  else
    memset(x, 0, sizeof *x * TERM_ROOM);
}

static void families_wish(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  const Ordinary *o = b->o;
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  if (!families_is_own(b, place)) return;
  double a[MOST_TERMS][TERM_ROOM] = {{0}}, r[TERM_ROOM] = {0}, room[TERM_ROOM], total = 0, least = 0;
  double *x = b->x + (int64_t)TERM_ROOM * b->wish[place];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    const double *h = families_bond_products(b, slice, slot, &bond, room), q = bond.weight * bond.length * bond.length;
    total += q;
    for (int t = 0; t < MOST_TERMS; ++t) r[t] -= q * h[t];
    if (b->wish[bond.neighbour] != WISHES_NOTHING) families_add_square(a, h, q);
  }
  for (int t = 0; t < b->terms; ++t) r[t] += total * b->goal[(int64_t)TERM_ROOM * b->wish[place] + t];
  families_solve(b, a, r, total, x);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!families_may_change(b, slice, slot, lane)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    least = fmin(least, families_along(families_bond_products(b, slice, slot, &bond, room), x));
  }
  for (int t = 0; t < MOST_TERMS && least < -most_taken; ++t) x[t] *= most_taken / -least;
}

/** Reflects the components of H of an original for its image.
 *  @param[in,out] of  [wishes][TERM_ROOM] */
static void families_mirror(const FamilyBalance *b, int64_t place, double *of)
{
  const Body *body = b->o->body;
  int64_t number = b->o->particles->number[place];
  bool flipped[3] = {false, false, false};
  if (b->wish[place] < 0 || !body_outside(body, number)) return;
  for (; body_outside(body, number); number = body->image_of[number]) {
    const Margin *margin = &body->margins.items[body->margin_of[number]];
    flipped[margin->axis] ^= !margin->repeats;
  }
  const double *from = of + (int64_t)TERM_ROOM * b->wish[b->o->particles->place_of[number]];
  double *to = of + (int64_t)TERM_ROOM * b->wish[place];
  for (int t = 0; t < b->terms; ++t) {
    const int *n = b->term[t].power;
    const int turned = flipped[0] * n[0] + flipped[1] * n[1] + flipped[2] * n[2];
    to[t] = turned % 2 ? -from[t] : from[t];
  }
}

static void families_mirror_wish(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  families_mirror(b, place, b->x);
}

static void families_change_slice(void *context, int64_t slice)
{
  const FamilyBalance *b = context;
  const Ordinary *o = b->o;
  const Family *f = o->family;
  double room[TERM_ROOM];
  for (int64_t slot = f->first[slice]; o->surface[slice] && slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!families_may_change(b, slice, slot, lane)) continue;
      const Bond bond = family_bond(f, slice, slot, lane);
      const double *h = families_bond_products(b, slice, slot, &bond, room);
      const double own = families_along(h, b->x + (int64_t)TERM_ROOM * b->wish[slice * SLICE + lane]);
      const int32_t there = b->wish[bond.neighbour];
      const double other = there >= 0 ? families_along(h, b->x + (int64_t)TERM_ROOM * there) : own;
      float *factor = &o->surface[slice][(slot - f->first[slice]) * SLICE + lane];
      *factor = (float)fmax(factors[0], fmin(factors[1], *factor * (1 + (own + other) / 2)));
    }
}

/* ---- anisotropy kept at surfaces ---- */

/** Volume of a family inside a block with its particle: of its lattice, or the largest one of particles from a file,
 *  at most that of the horizon. */
static double families_inside_volume(const Ordinary *o, int block)
{
  const Lattice *lattice = &o->body->lattices[block];
  const int others = o->family->pattern_begin[block + 1] - o->family->pattern_begin[block];
  return lattice->chunks ? (others + 1) * lattice->volume
                         : whole_family_volume(o->body, o->family, block, 0) / WHOLE_FAMILY_SHARE;
}

/** Computes the surface weight of each family from the share of its volume that is missing. */
static void families_find_surface(const FamilyBalance *b)
{
  const Ordinary *o = b->o;
  const Particles *p = o->particles;
  for (int block = 0; block < o->body->block_count; ++block) {
    const double inside = families_inside_volume(o, block);
    for (int64_t place = 0; place < p->places; ++place) {
      if (p->block[place / SLICE] != block || b->wish[place] < 0) continue;
      const int32_t original = p->place_of[body_original(o->body, p->number[place])];
      const double missing = 1 - (p->volume[original] + family_volume(o->family, original)) / inside;
      b->surface[place] = fmax(0, fmin(1, (missing - below_surface) / (at_surface - below_surface)));
    }
  }
}

/** Computes the anisotropy r of a family without factors. */
static void families_find_own(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  const Ordinary *o = b->o;
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  double room[TERM_ROOM], total = 0;
  if (!families_is_own(b, place)) return;
  double *own = b->own + (int64_t)TERM_ROOM * b->wish[place];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, (int)(place % SLICE));
    const double *h = families_bond_products(b, slice, slot, &bond, room), q = bond.weight * bond.length * bond.length;
    total += q;
    for (int t = 0; t < b->terms; ++t) own[t] += q * h[t];
  }
  for (int t = 0; t < b->terms && total > 0; ++t) own[t] /= total;
}

/** Computes the anisotropy that a family keeps, over the volume of the neighbouring families that take the opposite. */
static void families_find_given(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  const Ordinary *o = b->o;
  const Family *f = o->family;
  const double *volume = o->particles->volume;
  const int64_t slice = place / SLICE;
  if (!families_is_own(b, place)) return;
  double alike = b->surface[place] * volume[place], others = (1 - b->surface[place]) * volume[place];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const int32_t there = family_bond(f, slice, slot, (int)(place % SLICE)).neighbour;
    if (b->wish[there] < 0) continue;
    alike += b->surface[there] * volume[there];
    others += (1 - b->surface[there]) * volume[there];
  }
  if (others > 0 && alike > 0)
    b->given[place] = kept * fmin(1, others / alike) * b->surface[place] * volume[place] / others;
}

static void families_mirror_own(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  const Particles *p = b->o->particles;
  families_mirror(b, place, b->own);
  if (b->wish[place] >= 0 && body_outside(b->o->body, p->number[place]))
    b->given[place] = b->given[p->place_of[body_original(b->o->body, p->number[place])]];
}

/** Adds a share of the anisotropy of a family to a goal T. */
static void families_add_own(const FamilyBalance *b, int64_t place, double share, double *goal)
{
  const double *own = b->own + (int64_t)TERM_ROOM * b->wish[place];
  for (int t = 0; t < b->terms; ++t) goal[t] += share * own[t];
}

/** Computes the goal T of a family. */
static void families_find_goal(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  const Ordinary *o = b->o;
  const Family *f = o->family;
  const double *volume = o->particles->volume;
  const int64_t slice = place / SLICE;
  if (!families_is_own(b, place)) return;
  const double inner = 1 - b->surface[place];
  double *goal = b->goal + (int64_t)TERM_ROOM * b->wish[place], others = inner * volume[place];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const int32_t there = family_bond(f, slice, slot, (int)(place % SLICE)).neighbour;
    if (b->wish[there] < 0) continue;
    families_add_own(b, there, -b->given[there] * inner, goal);
    others += (1 - b->surface[there]) * volume[there];
  }
  families_add_own(b, place, b->given[place] * (others / volume[place] - inner), goal);
}

static void families_find_goals(const FamilyBalance *b)
{
  const int64_t places = b->o->particles->places;
  families_find_surface(b);
  team_each(places, families_find_own, (void *)(uintptr_t)b);
  team_each(places, families_find_given, (void *)(uintptr_t)b);
  if (b->o->body->margin_of) team_each(places, families_mirror_own, (void *)(uintptr_t)b);
  team_each(places, families_find_goal, (void *)(uintptr_t)b);
}

/** Stores the mean products n n n n of an incomplete family, from which its stress follows (ordinary_stress.c). */
static void families_keep_fourth(void *context, int64_t place)
{
  const FamilyBalance *b = context;
  const Ordinary *o = b->o;
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  double room[TERM_ROOM], sum[TERM_ROOM] = {0}, total = 0;
  if (!families_is_own(b, place)) return;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, (int)(place % SLICE));
    const double *h = families_bond_products(b, slice, slot, &bond, room), q = bond.weight * bond.length * bond.length;
    total += q;
    for (int t = 0; t < b->terms; ++t) sum[t] += q * h[t];
  }
  float *fourth = o->fourth + (int64_t)b->terms * b->wish[place];
  for (int t = 0; t < b->terms && total > 0; ++t)
    fourth[t] = (float)(sum[t] / total / b->term[t].scale + b->term[t].mean);
}

int ordinary_balance_families(Ordinary *o, Error *error)
{
  const int64_t places = o->particles->places;
  const Family *f = o->family;
  FamilyBalance b = {.o = o};
  /* With images beside a formulation that turns its particles the stiffness was found to be unsymmetric, for a cause
   * that is not known. */
  if (o->foreign && o->body->margin_of && particles_have_rotations(o->particles)) return BRECCIA_OK;
  families_list_terms(&b);
  b.wish = memory_zeroed((size_t)places, sizeof *b.wish, "bond constants", error);
  b.of_patterns = memory_zeroed((size_t)f->pattern_count * TERM_ROOM + 1, sizeof(double), "bond constants", error);
  int32_t count = 0;
  int failed = !b.wish || !b.of_patterns;
  if (!failed) {
    team_each(places, families_mark, &b);
    for (int64_t place = 0; place < places; ++place)
      if (b.wish[place] >= 0) b.wish[place] = count++;
    for (int p = 0; p < f->pattern_count; ++p)
      families_products(&b, f->patterns[p].xi, f->patterns[p].length, b.of_patterns + (int64_t)TERM_ROOM * p);
  }
  if (!failed && count) {
    b.x = memory_zeroed((size_t)count * TERM_ROOM, sizeof(double), "bond constants", error);
    b.own = memory_zeroed((size_t)count * TERM_ROOM, sizeof(double), "bond constants", error);
    b.goal = memory_zeroed((size_t)count * TERM_ROOM, sizeof(double), "bond constants", error);
    b.surface = memory_zeroed((size_t)places, sizeof *b.surface, "bond constants", error);
    b.given = memory_zeroed((size_t)places, sizeof *b.given, "bond constants", error);
    failed = !b.x || !b.own || !b.goal || !b.surface || !b.given || families_make_factors(&b, error);
    if (!failed) families_find_goals(&b);
    for (int turn = 0; turn < TURNS && !failed; ++turn) {
      team_each(places, families_wish, &b);
      if (o->body->margin_of) team_each(places, families_mirror_wish, &b);
      team_each(o->particles->slices, families_change_slice, &b);
    }
    o->fourth = memory_zeroed((size_t)count * (size_t)b.terms, sizeof *o->fourth, "bond constants", error);
    if (o->fourth && !failed) team_each(places, families_keep_fourth, &b);
    failed |= !o->fourth;
    o->incomplete = b.wish;
    o->incomplete_count = count;
  } else
    free(b.wish);
  free(b.of_patterns);
  free(b.x);
  free(b.own);
  free(b.goal);
  free(b.surface);
  free(b.given);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

/* ---- what they show ---- */

/** Energy of a family in uniform tension along an axis, free across, over that of the continuum. */
static double families_in_tension(const Ordinary *o, int64_t place, int axis)
{
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  const Material *m = ordinary_material(o, place);
  const double young = material_young(m), poisson = young / (2 * m->shear) - 1,
               across = o->space == SPACE_PLANE_STRAIN ? poisson / (1 - poisson) : poisson;
  double even = 0, square = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    const double n = bond.xi[axis] / bond.length, elongation = bond.length * ((1 + across) * n * n - across);
    even += bond.weight * bond.length * elongation;
    square += bond.weight * elongation * elongation;
  }
  return (o->volumetric[place] * o->inverse[place] * even * even + o->shear[place] * square) /
         (o->space == SPACE_PLANE_STRAIN ? young / (1 - poisson * poisson) : young);
}

double ordinary_body_young(const void *formulation, int block, int axis)
{
  const Ordinary *o = formulation;
  const Particles *p = o->particles;
  double sum = 0, volume = 0, inside = NAN; /* inside: of a complete family, all of which are alike */
  if (block_is_foreign(o->foreign, p, block)) return NAN;
  for (int64_t place = 0; place < p->places; ++place) {
    if (p->block[place / SLICE] != block || p->number[place] < 0 || body_outside(o->body, p->number[place])) continue;
    const bool complete = families_is_complete(o, place);
    const double own = complete && !isnan(inside) ? inside : families_in_tension(o, place, axis);
    if (complete) inside = own;
    sum += p->volume[place] * own;
    volume += p->volume[place];
  }
  return sum / volume;
}
