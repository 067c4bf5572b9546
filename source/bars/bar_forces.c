/* What bars exert, and how that changes with displacements. Each element is found from its places, and each place sums what elements pull with in
 * their order, so that bits do not depend on the number of threads. */
#include "bars/bars.h"

#include "base/team.h"
#include "base/tensor.h"
#include <math.h>
#include <string.h>

/** The vector by which an element's own one changes with displacements. */
static void gather(const Bars *b, int64_t e, double *const u[3], double d[3])
{
  for (int k = 0; k < 3; ++k) d[k] = 0;
  for (int64_t n = b->begin[e]; n < b->begin[e + 1]; ++n)
    for (int k = 0; k < 3; ++k) d[k] += b->joined.weight[n] * u[k][b->joined.place[n]];
}

/** Adds what elements pull with, on their first end along the vector and back on the other, to forces per volume. By all threads. */
static void spread(const Bars *b, double (*const pull)[3], double *const force[3])
{
  const double *volume = b->body->particles.volume;
  TEAM_FOR (t, b->touched_count) {
    const int32_t place = b->touched[t];
    double sum[3] = {0};
    for (int64_t n = b->touching_begin[t]; n < b->touching_begin[t + 1]; ++n)
      for (int k = 0; k < 3; ++k) sum[k] -= b->touching_weight[n] * pull[b->touching[n]][k];
    for (int k = 0; k < 3; ++k) force[k][place] += sum[k] / volume[place];
  }
}

/** Strains and directions of elements in the concrete, strains without the difference of two lengths that are nearly the same. */
static void find_strains(Bars *b, double *const *u, int bar, int64_t from, int64_t to)
{
  for (int64_t e = from; e < to; ++e) {
    const double *rest = b->rest[e], length = b->length[e];
    double d[3], more = 0, square = 0, now[3];
    gather(b, e, u, d);
    for (int k = 0; k < 3; ++k) {
      now[k] = rest[k] + d[k];
      more += (2 * rest[k] + d[k]) * d[k];
      square += now[k] * now[k];
    }
    const double long_now = sqrt(square);
    b->line_strain[e] = more / (long_now + length) / length;
    b->strain[e] = b->line_strain[e] + b->prestrain[bar];
    for (int k = 0; k < 3; ++k) b->along[e][k] = long_now > 0 ? now[k] / long_now : rest[k] / length;
  }
}

void bars_resist(void *forces, double *const *displacement, double *const *internal)
{
  Bars *b = forces;
  TEAM_FOR (n, b->slips ? b->specs->count : 0) {
    if (!bar_slips(b, (int)n)) continue;
    find_strains(b, displacement, (int)n, b->first[n], b->first[n + 1]);
    bar_find_slips(b, (int)n);
  }
  const bool ahead = b->has_points && points_ask_ahead(&b->points);
  TEAM_FOR (c, b->chunk_count) {
    const int64_t from = b->chunk[c], to = b->chunk[c + 1];
    if (!bar_slips(b, b->chunk_bar[c])) find_strains(b, displacement, b->chunk_bar[c], from, to);
    double *const strain[6] = {b->strain + from};
    if (ahead && b->served[b->chunk_bar[c]]) points_send(&b->points, from, (int)(to - from), strain);
  }
  if (ahead) TEAM_SINGLE points_await(&b->points);
  TEAM_FOR (c, b->chunk_count) {
    const int64_t from = b->chunk[c], to = b->chunk[c + 1];
    if (b->young[from] > 0) {
      for (int64_t e = from; e < to; ++e) b->stress[e] = b->young[e] * b->strain[e];
    } else {
      double *const strain[6] = {b->strain + from}, *const stress[6] = {b->stress + from};
      points_update(&b->points, from, (int)(to - from), strain, stress);
    }
    for (int64_t e = from; e < to; ++e)
      for (int k = 0; k < 3; ++k) b->pull[e][k] = b->area[e] * b->stress[e] * b->along[e][k];
  }
  TEAM_FOR (c, b->bends ? b->chunk_count : 0) bar_bend(b, b->chunk[c], b->chunk[c + 1]);
  spread(b, b->pull, internal);
}

/* ---- changes ---- */

/** Asks for stresses and slopes of the elements of a bar whose law runs in a server. */
static void ask_slopes(Bars *b, int n)
{
  const int64_t behind = b->first[n + 1];
  for (int64_t from = b->first[n]; from < behind; from += BATCH)
    points_ask_slopes(&b->points, from, (int)(behind - from < BATCH ? behind - from : BATCH), b->strain + from,
                      b->stress + from, b->slope + from);
}

/** Slope of the stress of an element at its strain. @param[out] stress  from the committed state; NULL: not wanted */
static double slope(const Bars *b, int n, int64_t e, double *stress)
{
  double found = b->young[e] * b->strain[e], tangent = b->young[e];
  if (b->served[n])
    tangent = points_mixed_slope(&b->points, e, b->strain[e], found = b->stress[e], b->slope[e]);
  else if (!(b->young[e] > 0))
    found = points_try(&b->points, e, b->strain[e], 0, &tangent);
  if (stress) *stress = found;
  return tangent;
}

void bar_try_stresses(Bars *b, int n)
{
  if (b->served[n]) ask_slopes(b, n);
  for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) b->tangent[e] = slope(b, n, e, &b->stress[e]);
}

void bars_linearise(void *forces)
{
  Bars *b = forces;
  for (int n = 0; n < b->specs->count; ++n) {
    if (b->served[n]) ask_slopes(b, n);
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      b->tangent[e] = b->area[e] * slope(b, n, e, NULL) / b->length[e];
      b->across[e] = b->area[e] * b->stress[e] / (b->length[e] * (1 + b->line_strain[e]));
    }
    if (bar_slips(b, n)) bar_factor_slips(b, n);
  }
}

void bars_change(void *forces, double *const v[3], double *const change[3])
{
  Bars *b = forces;
  TEAM_FOR (e, b->count) {
    gather(b, e, v, b->pull[e]);
    b->longer[e] = 0;
    for (int k = 0; k < 3; ++k) b->longer[e] += b->along[e][k] * b->pull[e][k];
    for (int k = 0; k < 3; ++k) {
      const double across = b->pull[e][k] - b->longer[e] * b->along[e][k];
      b->pull[e][k] = b->across[e] * across;
      if (b->bends) b->turn[e][k] = across / (b->length[e] * (1 + b->line_strain[e]));
    }
  }
  TEAM_FOR (e, b->bends ? b->count : 0) bar_change_bending(b, e);
  TEAM_FOR (n, b->slips ? b->specs->count : 0)
    if (bar_slips(b, (int)n)) bar_change_slips(b, (int)n);
  TEAM_FOR (e, b->count)
    for (int k = 0; k < 3; ++k) b->pull[e][k] += b->tangent[e] * b->longer[e] * b->along[e][k];
  spread(b, b->pull, change);
}

const char *bars_unassembled(const void *forces)
{
  const Bars *b = forces;
  if (b->slips) return "the slips of a bar join all particles along it";
  return b->bends ? "the bending of a bar joins particles of two elements" : NULL;
}

const char *bars_stuck(const void *forces)
{
  const Bars *b = forces;
  for (int n = 0; n < b->specs->count && b->slips; ++n)
    if (bar_slips(b, n) && b->slips->stuck[n]) return bar_name(b, n);
  return NULL;
}

int64_t bars_point_count(const void *forces)
{
  return ((const Bars *)forces)->count;
}

/** A point of finite strain that answers along the element only. With the stretch s of an element Green's strain is (s^2 - 1) / 2, so that the
 *  stress is sigma / s and its slope (slope of sigma - sigma / s) / s^2. */
int bars_point(const void *forces, int64_t e, Operator *point, Error *error)
{
  const Bars *b = forces;
  const double stretch = 1 + b->line_strain[e], stress = b->stress[e] / stretch,
               tangent = (slope(b, bar_of(b, e), e, NULL) - stress) / (stretch * stretch);
  double t[3], m[6];
  for (int k = 0; k < 3; ++k) t[k] = b->rest[e][k] / b->length[e];
  for (int k = 0; k < 6; ++k) m[k] = t[symmetric_row[k]] * t[symmetric_column[k]];
  operator_clear(point);
  point->components = 6;
  point->finite = true;
  point->volume = b->area[e] * b->length[e];
  for (int r = 0; r < 6; ++r) {
    point->stress[r] = stress * m[r];
    for (int k = 0; k < 6; ++k) point->tangent[6 * r + k] = tangent * m[r] * m[k];
  }
  for (int64_t n = b->begin[e]; n < b->begin[e + 1]; ++n) {
    OperatorPlace *place = operator_add(point, b->joined.place[n], error);
    if (!place) return BRECCIA_FAILURE;
    for (int k = 0; k < 3; ++k) place->g[k] = b->joined.weight[n] * t[k] / b->length[e];
  }
  return BRECCIA_OK;
}

/* ---- what was done ---- */

/** By the trapezium rule, as all works. */
static void book_prestrains(Bars *b)
{
  for (int n = 0; n < b->specs->count; ++n) {
    const double more = b->prestrain[n] - b->prestrain_held[n];
    for (int64_t e = b->first[n]; e < b->first[n + 1] && more != 0; ++e)
      b->given += b->area[e] * b->length[e] * (b->stress[e] + b->stress_held[e]) / 2 * more;
    b->prestrain_held[n] = b->prestrain[n];
  }
}

void bars_accept(void *forces)
{
  Bars *b = forces;
  book_prestrains(b);
  for (int64_t e = 0; e < b->count; ++e) {
    if (!(b->young[e] > 0))
      b->worked[e] +=
          b->area[e] * b->length[e] * (b->stress[e] + b->stress_held[e]) / 2 * (b->strain[e] - b->strain_held[e]);
    b->strain_held[e] = b->strain[e];
    b->stress_held[e] = b->stress[e];
  }
  if (b->has_points) points_commit(&b->points);
  bar_accept_slips(b);
  bar_accept_bending(b);
  bars_note(b);
}

double bars_energy(void *forces)
{
  const Bars *b = forces;
  double bond = 0;
  for (int n = 0; n < b->specs->count; ++n) bond += bar_bond_stored(b, n);
  return bars_stored(b, 0, b->count, true) + bars_stored(b, 0, b->count, false) + bond + bars_bent(b, 0, b->count);
}

double bars_given(const void *forces)
{
  return ((const Bars *)forces)->given;
}

double bars_prestress_forces(const Bars *b, const double *shorter)
{
  double sum = 0;
  for (int n = 0; n < b->specs->count; ++n) {
    const double pull = fabs(bar_young(b, n) * b->bar_area[n] * shorter[n]);
    for (int64_t e = b->first[n]; e <= b->first[n + 1] && pull > 0; ++e) {
      double square = 0;
      for (int k = 0; k < 3; ++k) {
        const double before = e > b->first[n] ? b->rest[e - 1][k] / b->length[e - 1] : 0,
                     behind = e < b->first[n + 1] ? b->rest[e][k] / b->length[e] : 0;
        square += (behind - before) * (behind - before);
      }
      sum += pull * sqrt(square);
    }
  }
  return sum;
}

double bars_dissipated(const void *forces)
{
  const Bars *b = forces;
  double work = 0;
  for (int64_t e = 0; e < b->count; ++e) work += b->worked[e];
  if (b->has_points) work -= bars_stored(b, 0, b->count, false);
  for (int n = 0; n < b->specs->count; ++n) work += bar_bond_dissipated(b, n);
  return work;
}
