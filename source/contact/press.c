/* Energy and forces of pairs (docs/theory.md 2).
 *
 * A pair stores V_a V_b k g^2 / 2, with g = rest - y.n, n the unit vector of nu = sum of cof(F) N over both ends that know the face, and k a
 * function of rho^2 = y.y - (y.n)^2, the square of the distance along the face. With p the derivative by n,
 *   dE = [-k g n + g^2 k' (y - (y.n) n)] . dy + p . dn,   p = -g (k + g k' (y.n)) y,
 *   p . dn = q . dnu,   q = (p - (p.n) n) / |nu|,   q . d(cof(F) N) = [(q (x) N) x F] : dF,
 * where (A x F)_mK = e_mni e_KLJ F_nL A_iJ. What acts on F acts on the family by V_j (A x F) K^-1 xi. */
#include "contact/contact_parts.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Weight of pairs of faces that meet, by their distance q along the face in spacings: the quadratic B-spline, whose sums over a row
 * of particles are 1, and weighted by their places 0, wherever the row is met: faces of particles are smooth so. */
static const double spline_reach = 1.5;
/** Integral of the spline over a plane, in spacings squared. */
static const double spline_plane = 1.2762720155208536; /* 2 pi 13 / 64 */

/* Pairs across a cut fade between these shares of the horizon: sums over lattices that slide then vary by 1 %, and not by 20 %. */
static const double fade_from = 0.7, fade_to = 1.05;

static double fade(double square, double horizon, double *slope)
{
  const double from = fade_from * fade_from * horizon * horizon, to = fade_to * fade_to * horizon * horizon;
  const double t = (square - from) / (to - from);
  *slope = 0;
  if (t <= 0) return 1;
  if (t >= 1) return 0;
  *slope = -6 * t * (1 - t) / (to - from);
  return 1 - t * t * (3 - 2 * t);
}

double contact_cut_reach(const Contact *c)
{
  return fade_to * c->family->horizon;
}

double contact_met_reach(double spacing)
{
  return spacing * sqrt(1 + spline_reach * spline_reach);
}

double contact_reach(const Contact *c, const ContactPair *pair, int32_t place)
{
  if (pair->kind == PAIR_BROKEN) return pair->rest;
  const double along = pair->kind == PAIR_CUT ? contact_cut_reach(c)
                                              : spline_reach * fmax(contact_lattice(c, place)->spacing,
                                                                    contact_lattice(c, pair->neighbour)->spacing);
  return sqrt(pair->rest * pair->rest + along * along);
}

double contact_smoothed(const Contact *c, int block)
{
  /* A bond at the angle psi across a face counts there by cos^3 psi; over all axes of the lattice. */
  const Lattice *lattice = &c->body->lattices[block];
  const double horizon = c->family->horizon,
               step = lattice->chunks && lattice_is_grid(lattice->type) ? lattice->spacing : horizon / 8;
  const int reach = (int)ceil(fade_to * horizon / step);
  double whole = 0, faded = 0, slope;
  int n[3];
  const int extent[3] = {reach, c->body->dimensions > 1 ? reach : 0, c->body->dimensions > 2 ? reach : 0};
  for (n[2] = -extent[2]; n[2] <= extent[2]; ++n[2])
    for (n[1] = -extent[1]; n[1] <= extent[1]; ++n[1])
      for (n[0] = -extent[0]; n[0] <= extent[0]; ++n[0]) {
        const double length = step * sqrt((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
        double share = 0;
        for (int k = 0; k < 3 && length > 0; ++k) share += pow(step * abs(n[k]) / length, 3);
        if (length <= horizon * (1 + 1e-9)) whole += share;
        faded += share * fade(length * length, horizon, &slope);
      }
  return faded > 0 ? whole / faded : 1;
}

/** Stiffness of faces that meet, where one particle stands right opposite another, per weight: that of a layer of both bodies. */
static double met_stiffness(const Contact *c, int one, int two, double *wide)
{
  const double da = c->body->lattices[one].spacing, db = c->body->lattices[two].spacing;
  *wide = fmax(da, db);
  const BlockSpec *block = c->body->blocks[0];
  const double plane = c->body->dimensions == 3   ? spline_plane * *wide * *wide
                       : c->body->dimensions == 2 ? *wide * block->thickness
                                                  : 0.75 * block->area;
  const double young = 2 * c->young[one] * c->young[two] / (c->young[one] + c->young[two]);
  return c->spec->stiffness * young / ((da + db) / 2 * da * db) / plane;
}

/** Stiffness of a pair as it stands; distances are known. */
static void find_stiffness(const Contact *c, const ContactRow *low, const ContactRow *high, const ContactPair *pair,
                           Press *press)
{
  const double square = press->square;
  const Particles *p = &c->body->particles;
  const int one = p->block[low->place / SLICE], two = p->block[high->place / SLICE];
  press->slope = 0;
  if (pair->kind == PAIR_MET) {
    double wide;
    const double k = met_stiffness(c, one, two, &wide), q = sqrt(square) / wide;
    if (press->central || q == 0) {
      press->stiffness = 0.75 * k;
      press->slope = press->central ? 0 : -k / (wide * wide);
    } else {
      const double left = fmax(0, spline_reach - q);
      press->stiffness = k * (q < 0.5 ? 0.75 - q * q : 0.5 * left * left);
      press->slope = -k / (wide * wide) * (q < 0.5 ? 1 : left / (2 * q));
    }
    return;
  }
  const double mean = (c->constant[one] + c->constant[two]) / 2;
  if (press->central) {
    press->stiffness = mean / particles_distance(p, low->place, high->place);
    return;
  }
  const double smoothed = (c->smoothed[one] + c->smoothed[two]) / 2;
  const double least = (c->body->lattices[one].spacing + c->body->lattices[two].spacing) / 4;
  const double length = fmax(pair->depth, least) * fmax(pair->depth, least) + square; /* squared */
  double slope;
  const double faded = fade(length, c->family->horizon, &slope);
  const double k = smoothed * mean * pair->depth * pair->depth / (length * sqrt(length));
  press->stiffness = k * faded;
  press->slope = k * (slope - 1.5 * faded / length);
}

/** Distances and directions of a pair. @return false if nothing is known of it yet */
static bool measure(const Contact *c, double *const *u, const ContactRow *low, const ContactRow *high,
                    const ContactPair *pair, bool before, Press *press)
{
  double *nu = press->long_normal;
  press->stiffness = press->slope = press->energy = press->gap = 0;
  if (pair->kind == PAIR_NEW) return false;
  present_way(&c->body->particles, u, low->place, high->place, press->way);
  const double *one = before ? low->before.cofactor : low->frame.cofactor;
  const double *two = before ? high->before.cofactor : high->frame.cofactor;
  for (int k = 0; k < 3; ++k)
    nu[k] = pair->kind == PAIR_BROKEN ? 0 : dot(one + 3 * k, pair->normal[0]) + dot(two + 3 * k, pair->normal[1]);
  const double size = dot(nu, nu), length = dot(press->way, press->way);
  press->central = !(size > 0);
  press->across = press->central ? sqrt(length) : 0;
  const double scale = press->central ? (press->across > 0 ? 1 / press->across : 0) : 1 / sqrt(size);
  for (int k = 0; k < 3; ++k) press->normal[k] = scale * (press->central ? press->way[k] : nu[k]);
  if (!press->central) press->across = dot(press->way, press->normal);
  press->gap = pair->rest - press->across;
  press->square = fmax(0, length - press->across * press->across);
  return true;
}

bool contact_press(const Contact *c, double *const *u, const ContactRow *low, const ContactRow *high,
                   const ContactPair *pair, bool before, Press *press)
{
  if (!measure(c, u, low, high, pair, before, press) || !(press->gap > 0)) return false;
  find_stiffness(c, low, high, pair, press);
  press->energy = press->stiffness * press->gap * press->gap / 2;
  return press->stiffness > 0;
}

bool contact_touch(const Contact *c, double *const *u, const ContactRow *low, const ContactRow *high,
                   const ContactPair *pair, double apart, Press *press)
{
  if (!measure(c, u, low, high, pair, false, press) || !(press->gap > -apart * pair->rest)) return false;
  find_stiffness(c, low, high, pair, press);
  return press->stiffness > 0;
}

/** Lets the energy of a pair stay as it was before bonds broke around it. */
static void keep_energy(const Contact *c, double *const *u, const ContactRow *low, const ContactRow *high,
                        ContactPair *pair)
{
  Press old, now;
  if (pair->kind == PAIR_BROKEN || pair->kind == PAIR_NEW) return;
  const bool pressed = contact_press(c, u, low, high, pair, true, &old);
  const bool presses = contact_press(c, u, low, high, pair, false, &now);
  find_stiffness(c, low, high, pair, &now);
  if (pressed && now.stiffness > 0)
    pair->rest = now.across + sqrt(2 * old.energy / now.stiffness);
  else if (presses)
    pair->rest = now.across;
}

/* ---- sweeps over rows ---- */

static void look_around(const Contact *c, double *const *u, ContactRow *row)
{
  row->near = row->framed = c->choosing;
  for (int32_t n = 0; n < row->count && !(row->near && row->framed); ++n) {
    const ContactPair *pair = &row->pairs[n];
    double y[3];
    present_way(&c->body->particles, u, row->place, pair->neighbour, y);
    const double reach = contact_reach(c, pair, row->place);
    if (!(dot(y, y) < reach * reach)) continue;
    row->near = true;
    row->framed |= pair->kind != PAIR_BROKEN;
  }
  if (row->faceless && c->choosing) {
    contact_find_faces(c, row);
    row->faceless = false;
  }
  if (row->framed && !(c->remembered && !row->stale)) contact_find_frame(c, u, row);
}

void contact_remember(Contact *c)
{
  if (!c->spec) return;
  TEAM_FOR (r, c->row_count) {
    look_around(c, c->body->particles.displacement.row, &c->rows[r]);
    c->rows[r].before = c->rows[r].frame;
  }
  TEAM_SINGLE
  {
    contact_keep(c);
    c->remembered = true;
  }
}

static void choose_row(const Contact *c, double *const *u, const ContactRow *row)
{
  for (int32_t n = 0; n < row->count; ++n)
    contact_choose(c, u, row, &c->rows[c->row_of[row->pairs[n].neighbour]], &row->pairs[n]);
}

static void keep_row(const Contact *c, double *const *u, const ContactRow *row)
{
  for (int32_t n = 0; n < row->count; ++n) {
    const ContactRow *other = &c->rows[c->row_of[row->pairs[n].neighbour]];
    if (!row->torn && !other->torn) continue;
    const bool low = row->pairs[n].low;
    keep_energy(c, u, low ? row : other, low ? other : row, &row->pairs[n]);
  }
}

/** What a pair that presses does. @param[in] pull  of friction */
static void find_act(const Press *m, const double pull[3], PairAct *act)
{
  const double along = m->gap * m->gap * m->slope;
  act->presses = true;
  act->turns = !m->central;
  for (int k = 0; k < 3; ++k) {
    const double side = m->way[k] - m->across * m->normal[k];
    act->force[k] = along * side - m->stiffness * m->gap * m->normal[k] + pull[k];
    act->turning[k] = -m->gap * (m->stiffness + m->gap * m->slope * m->across) * m->way[k] - m->across * pull[k];
  }
  if (m->central) return;
  flatten(m->normal, act->turning);
  const double size = sqrt(dot(m->long_normal, m->long_normal));
  for (int k = 0; k < 3; ++k) act->turning[k] /= size;
}

void contact_find_pull(const double f[9], const double shape[9], const double a[9], double pull[9])
{
  double stress[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int m = (i + 1) % 3, n = (i + 2) % 3, k = (j + 1) % 3, l = (j + 2) % 3;
      stress[3 * i + j] = f[3 * m + k] * a[3 * n + l] - f[3 * m + l] * a[3 * n + k] - f[3 * n + k] * a[3 * m + l] +
                          f[3 * n + l] * a[3 * m + k];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      pull[3 * i + j] = 0;
      for (int k = 0; k < 3; ++k) pull[3 * i + j] += stress[3 * i + k] * shape[3 * k + j];
    }
}

static void mark_family(Contact *c, const ContactRow *row)
{
  const Family *f = c->family;
  const int64_t slice = row->place / SLICE;
  __atomic_store_n(&c->marked[slice], 1, __ATOMIC_RELAXED);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    if (f->intact[slot] >> (row->place % SLICE) & 1)
      __atomic_store_n(&c->marked[family_bond(f, slice, slot, row->place % SLICE).neighbour / SLICE], 1,
                       __ATOMIC_RELAXED);
}

/** Energy and acts of the pairs whose lower end a row is. @param[in] only_energy  of the committed state */
static void press_row(Contact *c, double *const *u, ContactRow *row, bool only_energy)
{
  const Particles *p = &c->body->particles;
  row->slid = row->stored = 0;
  for (int32_t n = 0; n < row->count; ++n) {
    const ContactPair *pair = &row->pairs[n];
    if (!pair->low) continue;
    const ContactRow *other = &c->rows[c->row_of[pair->neighbour]];
    const Grip *before = row->grips ? &row->grips[2 * n + c->committed] : NULL;
    Grip *after = row->grips && !only_energy ? &row->grips[2 * n + !c->committed] : NULL;
    PairAct none, *act = only_energy ? &none : &c->acts[pair->act];
    const double own =
        (!body_outside(c->body, p->number[row->place]) + !body_outside(c->body, p->number[other->place])) /
        2.0; /* each end has half; outside its supports the body has nothing */
    const double volumes = own * p->volume[row->place] * p->volume[other->place];
    double pull[3] = {0};
    Press m;
    act->presses = false;
    if (after) after->known = false;
    if (only_energy && before && before->known) row->stored += volumes * dot(before->spring, before->spring) / 2;
    if (!row->near || !other->near) continue; /* nor did it press before: rows reach far beyond */
    const bool presses = contact_press(c, u, row, other, pair, false, &m);
    if (after) {
      row->slid += volumes * contact_grip(before, after, &m, c->spec->friction);
      row->stored += volumes * dot(after->spring, after->spring) / 2;
      memcpy(pull, after->pull, sizeof pull);
    }
    if (!presses) continue;
    row->stored += volumes * m.energy;
    if (!only_energy) find_act(&m, pull, act);
  }
}

/** What pairs do, with the deformation of families that goes with it, and the arrays of forces per volume to which it is added. */
typedef struct Doing {
  const PairAct *acts;
  bool linear; /* a change: of joints, with frames as they were linearised */
  double *const *force;
} Doing;

/** Forces on the particle of a row by its pairs, and what its family is pulled with. */
static void resist_row(Contact *c, ContactRow *row, const Doing *doing)
{
  const Particles *p = &c->body->particles;
  const Frame *frame = doing->linear ? &row->linear : &row->frame;
  double force[3] = {0}, moment[9] = {0};
  row->pulls = false;
  if (!(doing->linear ? row->joined : row->near)) return;
  for (int32_t n = 0; n < row->count; ++n) {
    const ContactPair *pair = &row->pairs[n];
    const PairAct *act = &doing->acts[pair->act];
    if (!act->presses) continue;
    const double volume = p->volume[pair->neighbour], share = pair->low ? volume : -volume;
    for (int k = 0; k < 3; ++k) force[k] += share * act->force[k];
    if (!act->turns || !frame->known) continue;
    row->pulls = true;
    const double *normal = pair->normal[!pair->low], volumes = volume * p->volume[row->place];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) moment[3 * i + j] += volumes * act->turning[i] * normal[j];
  }
  for (int k = 0; k < 3; ++k) doing->force[k][row->place] += force[k];
  row->pulls = row->pulls && c->body->dimensions > 1;
  if (!row->pulls) return;
  contact_find_pull(frame->gradient, row->shape, moment, row->pull);
  mark_family(c, row);
}

static const ContactRow *pulling_row(const Contact *c, int32_t place)
{
  const ContactRow *row = c->row_of[place] < 0 ? NULL : &c->rows[c->row_of[place]];
  return row && row->pulls ? row : NULL;
}

/** Forces on the particles of a slice from what acts on the deformation gradients of theirs and of their neighbours. */
static void gather(const Contact *c, int64_t slice, double *const sum[3])
{
  const Family *f = c->family;
  const Particles *p = f->particles;
  for (int lane = 0; lane < SLICE; ++lane) {
    const int32_t place = (int32_t)(slice * SLICE + lane);
    if (p->number[place] < 0) continue;
    const ContactRow *row = pulling_row(c, place);
    double force[3] = {0};
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const Bond bond = family_bond(f, slice, slot, lane);
      const ContactRow *other = pulling_row(c, bond.neighbour);
      const double share = p->volume[bond.neighbour] / p->volume[place];
      for (int i = 0; i < 3 && (row || other); ++i)
        for (int j = 0; j < 3; ++j)
          force[i] += ((row ? share * row->pull[3 * i + j] : 0) + (other ? other->pull[3 * i + j] : 0)) * bond.xi[j];
    }
    for (int k = 0; k < 3; ++k) sum[k][place] += force[k];
  }
}

/** By all threads. */
static void spread(Contact *c, const Doing *doing)
{
  TEAM_SINGLE memset(c->marked, 0, (size_t)c->body->particles.slices);
  TEAM_FOR (r, c->row_count) resist_row(c, &c->rows[r], doing);
  TEAM_FOR (s, c->body->particles.slices)
    if (c->marked[s]) gather(c, s, doing->force);
}

void contact_spread_change(Contact *c, double *const change[3])
{
  spread(c, &(Doing){c->steps, true, change});
}

static void look_and_choose(void *context)
{
  Contact *c = context;
  double *const *u = c->body->particles.displacement.row;
  TEAM_FOR (r, c->row_count) look_around(c, u, &c->rows[r]);
  TEAM_FOR (r, c->row_count) choose_row(c, u, &c->rows[r]);
}

void contact_choose_faces(Contact *c)
{
  if (!c->choosing) return;
  team_run(look_and_choose, c);
  c->choosing = false;
}

void contact_resist(Contact *c, double *const *u, double *const *internal)
{
  if (!c->spec) return;
  const bool choosing = c->choosing, keeping = c->torn && c->remembered; /* before anyone changes them */
  TEAM_FOR (r, c->row_count) look_around(c, u, &c->rows[r]);
  if (choosing) {
    TEAM_FOR (r, c->row_count) choose_row(c, u, &c->rows[r]);
  }
  if (keeping) {
    TEAM_FOR (r, c->row_count) keep_row(c, u, &c->rows[r]);
  }
  TEAM_SINGLE
  {
    for (int32_t r = 0; r < c->row_count && c->torn; ++r) c->rows[r].torn = false;
    c->choosing = c->torn = c->remembered = false;
  }
  TEAM_FOR (r, c->row_count) press_row(c, u, &c->rows[r], false);
  spread(c, &(Doing){c->acts, false, internal});
}

static void find_stored(void *context)
{
  Contact *c = context;
  double *const *u = c->body->particles.displacement.row;
  TEAM_FOR (r, c->row_count) look_around(c, u, &c->rows[r]);
  TEAM_FOR (r, c->row_count) press_row(c, u, &c->rows[r], true);
}

/** Sum over rows in the order of places: they stand in the order of events, which a restart does not know. */
static double sum_rows(const Contact *c, size_t offset)
{
  double sum = 0;
  for (int64_t place = 0; place < c->body->particles.places; ++place)
    if (c->row_of[place] >= 0) sum += *(const double *)((const char *)&c->rows[c->row_of[place]] + offset);
  return sum;
}

double contact_energy(Contact *c)
{
  if (!c->spec) return 0;
  team_run(find_stored, c);
  return sum_rows(c, offsetof(ContactRow, stored));
}

void contact_commit(Contact *c)
{
  if (!c->spec) return;
  free(c->kept);
  c->kept = NULL;
  if (!(c->spec->friction > 0)) return;
  c->committed = !c->committed;
  c->friction_work += sum_rows(c, offsetof(ContactRow, slid));
}

double contact_eigenvalue(const Contact *c)
{
  return c->stiffest;
}
