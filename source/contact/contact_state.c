/* What contact remembers, as numbers for a checkpoint: work of friction, travel since the last search, and every pair once. Broken bonds are made
 * again from their list before, and pairs that cuts part from the body. */
#include "base/memory.h"
#include "contact/contact_parts.h"

#include <stdlib.h>
#include <string.h>

enum { SAVED_START = 2, SAVED_PAIR = 11, SAVED_GRIP = 13 };

static int64_t saved_length(const Contact *c)
{
  return SAVED_PAIR + (c->spec->friction > 0 ? SAVED_GRIP : 0);
}

static void write_pair(const Contact *c, const ContactRow *row, int32_t n, double *out)
{
  const ContactPair *pair = &row->pairs[n];
  out[0] = c->body->particles.number[row->place];
  out[1] = c->body->particles.number[pair->neighbour];
  out[2] = pair->kind;
  memcpy(out + 3, pair->normal, sizeof pair->normal);
  out[9] = pair->depth;
  out[10] = pair->rest;
  if (!row->grips) return;
  const Grip *held = &row->grips[2 * n + c->committed];
  out += SAVED_PAIR;
  memset(out, 0, SAVED_GRIP * sizeof *out);
  if (!held->known) return;
  out[0] = 1;
  memcpy(out + 1, held->spring, sizeof held->spring);
  memcpy(out + 4, held->pull, sizeof held->pull);
  memcpy(out + 7, held->way, sizeof held->way);
  memcpy(out + 10, held->normal, sizeof held->normal);
}

/** Writes all pairs, by number, or counts them if `out` is NULL. */
static int64_t write_pairs(const Contact *c, double *out)
{
  const Particles *p = &c->body->particles;
  int64_t count = 0;
  for (int64_t i = 0; i < p->count; ++i) {
    const ContactRow *row = c->row_of[p->place_of[i]] < 0 ? NULL : &c->rows[c->row_of[p->place_of[i]]];
    for (int32_t n = 0; row && n < row->count; ++n) {
      if (p->number[row->pairs[n].neighbour] < i) continue;
      if (out) write_pair(c, row, n, out + count * saved_length(c));
      ++count;
    }
  }
  return count;
}

int64_t contact_save(const Contact *c, double **out)
{
  *out = NULL;
  if (!c->spec) return 0;
  const int64_t count = SAVED_START + write_pairs(c, NULL) * saved_length(c);
  if (!(*out = memory_plain((size_t)count, sizeof(double)))) return -1;
  (*out)[0] = c->friction_work;
  (*out)[1] = c->travelled;
  write_pairs(c, *out + SAVED_START);
  return count;
}

/** The place of a saved particle number, or -1. */
static int32_t saved_place(const Contact *c, double number)
{
  const Particles *p = &c->body->particles;
  return number >= 0 && number < (double)p->count ? p->place_of[(int64_t)number] : -1;
}

/** @return nonzero if this cannot be a pair of this body */
static int read_pair(Contact *c, const double *in)
{
  const int32_t low = saved_place(c, in[0]), high = saved_place(c, in[1]);
  if (low < 0 || high < 0 || low == high || !(in[2] >= PAIR_NEW && in[2] <= PAIR_MET)) return 1;
  for (int end = 0; end < 2; ++end) {
    ContactPair *pair = contact_pair_for(c, end ? high : low, end ? low : high);
    if (!pair) return 1;
    pair->kind = (PairKind)in[2];
    memcpy(pair->normal, in + 3, sizeof pair->normal);
    pair->depth = in[9];
    pair->rest = in[10];
    const ContactRow *row = &c->rows[c->row_of[end ? high : low]];
    if (!row->grips || !pair->low) continue;
    Grip *held = &row->grips[2 * (pair - row->pairs) + c->committed];
    const double *grip = in + SAVED_PAIR;
    held->known = grip[0] != 0;
    memcpy(held->spring, grip + 1, sizeof held->spring);
    memcpy(held->pull, grip + 4, sizeof held->pull);
    memcpy(held->way, grip + 7, sizeof held->way);
    memcpy(held->normal, grip + 10, sizeof held->normal);
  }
  return 0;
}

int contact_resume(Contact *c, const double *numbers, int64_t count)
{
  if (!c->spec) return count != 0;
  if (count < SAVED_START || (count - SAVED_START) % saved_length(c)) return 1;
  contact_forget_pairs(c);
  c->friction_work = numbers[0];
  c->travelled = numbers[1];
  for (const double *pair = numbers + SAVED_START; pair < numbers + count; pair += saved_length(c))
    if (read_pair(c, pair)) return 1;
  c->choosing = c->torn = c->remembered = false;
  for (int32_t r = 0; r < c->row_count; ++r) c->rows[r].torn = false;
  return 0;
}

void contact_keep(Contact *c)
{
  if (c->kept) return;
  c->kept_count = contact_save(c, &c->kept);
  if (c->kept_count < 0) c->failed = true;
}

void contact_undo(Contact *c)
{
  if (!c->spec) return;
  const double travelled = c->travelled_before;
  if (c->kept && contact_resume(c, c->kept, c->kept_count)) c->failed = true;
  free(c->kept);
  c->kept = NULL;
  c->travelled = travelled;
}

static int64_t save_row(const void *owner, double **numbers)
{
  return contact_save(owner, numbers);
}

static int resume_row(void *owner, const double *numbers, int64_t count, Error *error)
{
  (void)error;
  return contact_resume(owner, numbers, count) ? STATE_MISFIT : BRECCIA_OK;
}

void contact_state(Contact *c, StateList *list)
{
  static const StateCare care = {.save = save_row, .resume = resume_row};
  if (c->spec)
    state_add(list, &(StateRow){.unit = "1", .role = STATE_COMMITTED, .care = &care, .owner = c}, "contact", NULL);
}
