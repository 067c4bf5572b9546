#include "solver/face_work.h"

#include "base/memory.h"
#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Whether a face of a support does other work than a symmetric one at rest, which does none: it moves, it is held in all directions, so that its images
 *  are no mirror images, or layers are so few that the families of images are cut off. */
static bool does_work(const Domain *d, const Loading *loading)
{
  const Body *body = &d->body;
  const Load *load = NULL;
  int held = 0;
  for (int n = 0; n < loading->constraint_count; ++n) {
    const Constraint *c = &loading->constraints[n];
    if (!c->images) continue;
    if (c->load != load) held = 0;
    load = c->load;
    held += c->share < 0 && !c->row;
    if (held > 1 || c->value != 0) return true;
  }
  for (int m = 0; m < body->margins.count; ++m) {
    const Margin *margin = &body->margins.items[m];
    const double spacing = body->blocks[margin->block]->spacing;
    if (margin->layers < 2 * (int64_t)floor(d->family.horizon / spacing + 1e-6)) return true;
  }
  return false;
}

/** The next intact bond of a place from inside to outside or back, from a slot on; false: there is none. */
static bool next_across(const Domain *d, int32_t place, int64_t *slot, int32_t *other)
{
  const Family *f = &d->family;
  const int32_t *number = d->particles->number;
  const bool outside = body_outside(&d->body, number[place]);
  for (; *slot < f->first[place / SLICE + 1]; ++*slot) {
    if (!(f->intact[*slot] >> place % SLICE & 1)) continue;
    *other = family_bond(f, place / SLICE, *slot, place % SLICE).neighbour;
    if (body_outside(&d->body, number[*other]) != outside) return true;
  }
  return false;
}

static int64_t list_places(const Domain *d, int32_t *places)
{
  int64_t count = 0;
  for (int32_t i = 0; i < d->particles->places; ++i) {
    int64_t slot = d->family.first[i / SLICE];
    int32_t other;
    if (d->particles->number[i] < 0 || !next_across(d, i, &slot, &other)) continue;
    if (places) places[count] = i;
    ++count;
  }
  return count;
}

int face_work_create(FaceWork *w, const Domain *d, const Loading *loading, Error *error)
{
  if (d->counted == d->particles->volume || !does_work(d, loading)) return BRECCIA_OK;
  const size_t count = (size_t)list_places(d, NULL);
  w->places = memory_zeroed(count, sizeof *w->places, "work at faces", error);
  w->now = memory_zeroed(count, sizeof *w->now, "work at faces", error);
  w->then = memory_zeroed(count, sizeof *w->then, "work at faces", error);
  if (!w->places || !w->now || !w->then) return BRECCIA_FAILURE;
  w->count = list_places(d, w->places);
  return BRECCIA_OK;
}

void face_work_destroy(FaceWork *w)
{
  free(w->places);
  free(w->now);
  free(w->then);
  *w = (FaceWork){0};
}

size_t face_work_bytes(const FaceWork *w)
{
  return (size_t)w->count * (sizeof *w->places + sizeof *w->now + sizeof *w->then);
}

/** On an image t_ij of the bonds that particles inside have with it, on these - t_ji of its own; of points between places their shares. */
static void find_force(const Domain *d, int32_t place, double sum[3])
{
  const Particles *p = d->particles;
  const double sign = body_outside(&d->body, p->number[place]) ? p->volume[place] : -p->volume[place];
  int32_t other;
  memset(sum, 0, 3 * sizeof *sum);
  for (int64_t slot = d->family.first[place / SLICE]; next_across(d, place, &slot, &other); ++slot) {
    const Region *region = domain_region(d, other);
    double state[3];
    if (region->type->face_force) continue;
    region->type->half_state(region->formulation, p->displacement.row, NULL, other / SLICE,
                             family_slot(&d->family, other, place), other % SLICE, state);
    for (int k = 0; k < 3; ++k) sum[k] += sign * p->volume[other] * state[k];
  }
  for (int r = 0; r < d->region_count; ++r) {
    double force[3];
    if (!d->regions[r].type->face_force) continue;
    d->regions[r].type->face_force(d->regions[r].formulation, place, force);
    for (int k = 0; k < 3; ++k) sum[k] += force[k];
  }
}

void face_work_find(FaceWork *w, const Domain *d)
{
  if (!w->count) return;
  TEAM_FOR (n, w->count) find_force(d, w->places[n], w->now[n]);
  TEAM_SINGLE w->fresh = true;
}

typedef struct Finding {
  FaceWork *work;
  const Domain *domain;
} Finding;

static void find(void *context)
{
  const Finding *f = context;
  face_work_find(f->work, f->domain);
}

void face_work_renew(FaceWork *w, const Domain *d)
{
  if (w->count) team_run(find, &(Finding){w, d});
}

void face_work_note(FaceWork *w)
{
  double(*spare)[3] = w->then;
  w->then = w->now;
  w->now = spare;
  w->fresh = false;
}

double face_work_done(const FaceWork *w, double factor, double *const moved[3])
{
  double sum = 0;
  for (int64_t n = 0; n < w->count; ++n)
    for (int k = 0; k < 3; ++k) sum += 0.5 * (w->then[n][k] + w->now[n][k]) * factor * moved[k][w->places[n]];
  return sum;
}
