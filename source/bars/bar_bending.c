/* Bars that resist bending (docs/theory.md 7.1): between two elements on one line the energy is E I / L times 1 - n_a . n_b, of their unit vectors as they
 * stand, L the mean of their lengths. So it is that of the curvature, and none where the body only turns. At corners of a line no moment is handed on. */
#include "bars/bars.h"

#include <math.h>

double bar_bending_stiffness(const Bars *b, int n)
{
  const double number = (double)((const BarSpec *)b->specs->items[n])->number, one = b->bar_area[n] / number;
  return bar_young(b, n) * number * one * one / (4 * acos(-1));
}

static bool is_straight(const Bars *b, int64_t e)
{
  const double rounding = 1e-9;
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double turn = b->rest[e + 1][k] / b->length[e + 1] - b->rest[e][k] / b->length[e];
    square += turn * turn;
  }
  return square < rounding;
}

int64_t bar_joints(const Bars *b, int n)
{
  int64_t joints = 0;
  for (int64_t e = b->first[n]; e + 1 < b->first[n + 1]; ++e) joints += b->bend[e] > 0;
  return joints;
}

int bar_bending_create(Bars *b, const ForcesParts *parts, Error *error)
{
  for (int n = 0; n < b->specs->count; ++n) b->bends |= ((const BarSpec *)b->specs->items[n])->bending;
  if (!b->bends) return BRECCIA_OK;
  b->bend = memory_zeroed((size_t)b->count, sizeof *b->bend, "bars", error);
  b->bent = memory_zeroed((size_t)b->count, sizeof *b->bent, "bars", error);
  b->turn = memory_zeroed((size_t)b->count, sizeof *b->turn, "bars", error);
  if (!b->bend || !b->bent || !b->turn) return BRECCIA_FAILURE;
  for (int n = 0; n < b->specs->count; ++n) {
    const BarSpec *bar = b->specs->items[n];
    if (!bar->bending) continue;
    const double stiffness = bar_bending_stiffness(b, n);
    for (int64_t e = b->first[n]; e + 1 < b->first[n + 1]; ++e)
      if (is_straight(b, e)) b->bend[e] = 2 * stiffness / (b->length[e] + b->length[e + 1]);
    if (!bar_joints(b, n))
      return node_error(
          parts->reader->document, section_node(bar, "bending"), error,
          "bending: no two elements of this line lie on one straight line, so that it has a corner at each of "
          "them, where no moment is handed on; draw straight parts longer than two spacings, or leave it out");
  }
  return BRECCIA_OK;
}

/** Stiffness of the joint of an element and the next one. */
static double joint(const Bars *b, int64_t e)
{
  return e >= 0 && b->bend[e] > 0 && b->torn[e] < 0 && b->torn[e + 1] < 0 ? b->bend[e] : 0;
}

static double length_now(const Bars *b, int64_t e)
{
  return b->length[e] * (1 + b->line_strain[e]);
}

/** Adds the slope of the energy of a joint along the vector of an element to what this pulls with: n (1 - n . m) - (m - n), of which only what is across n
 *  is not nothing; by the difference of both vectors, which are nearly the same. */
static void add_pull(const Bars *b, double stiffness, int64_t e, int64_t other, double pull[3])
{
  const double *n = b->along[e], *m = b->along[other];
  double along = 0;
  for (int k = 0; k < 3; ++k) along += n[k] * (m[k] - n[k]);
  for (int k = 0; k < 3; ++k) pull[k] -= stiffness / length_now(b, e) * (m[k] - n[k] - along * n[k]);
}

void bar_bend(Bars *b, int64_t from, int64_t to)
{
  for (int64_t e = from; e < to; ++e) {
    const double before = joint(b, e - 1), behind = joint(b, e);
    if (before > 0) add_pull(b, before, e, e - 1, b->pull[e]);
    if (behind > 0) add_pull(b, behind, e, e + 1, b->pull[e]);
  }
}

/** The change of what add_pull adds with those of both vectors (`turn`) and of the length (`longer`). */
static void add_change(const Bars *b, double stiffness, int64_t e, int64_t other, double pull[3])
{
  const double *n = b->along[e], *m = b->along[other], *dn = b->turn[e], *dm = b->turn[other];
  const double length = length_now(b, e), stretch = b->longer[e] / length;
  double both = 0, change = 0;
  for (int k = 0; k < 3; ++k) {
    both += n[k] * m[k];
    change += n[k] * dm[k] + m[k] * dn[k];
  }
  for (int k = 0; k < 3; ++k)
    pull[k] -= stiffness / length * (dm[k] - change * n[k] - both * dn[k] - stretch * (m[k] - both * n[k]));
}

void bar_change_bending(Bars *b, int64_t e)
{
  const double before = joint(b, e - 1), behind = joint(b, e);
  if (before > 0) add_change(b, before, e, e - 1, b->pull[e]);
  if (behind > 0) add_change(b, behind, e, e + 1, b->pull[e]);
}

void bar_accept_bending(Bars *b)
{
  for (int64_t e = 0; b->bends && e < b->count; ++e) {
    const double stiffness = joint(b, e);
    double square = 0;
    for (int k = 0; k < 3 && stiffness > 0; ++k) {
      const double turn = b->along[e + 1][k] - b->along[e][k];
      square += turn * turn;
    }
    if (!(stiffness > 0)) b->worked[e] += b->bent[e]; /* its element has torn: no more stored, so dissipated */
    b->bent[e] = stiffness * square / 2;
  }
}

double bars_bent(const Bars *b, int64_t from, int64_t to)
{
  double sum = 0;
  for (int64_t e = from; b->bends && e < to; ++e) sum += b->bent[e];
  return sum;
}

void bar_bending_state(Bars *b, StateList *list)
{
  const StateRow row = {.unit = "energy",
                        .kind = STATE_NUMBERS,
                        .entity = STATE_OF_ALL,
                        .role = STATE_COMMITTED,
                        .count = b->count,
                        .values = b->bent};
  state_add(list, &row, "energy of bending of bars", NULL);
}
