#include "contact/contact.h"

#include "base/team.h"
#include "family/cells.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Field contact_fields[] = {
    {"stiffness", FIELD_NUMBER, offsetof(ContactSpec, stiffness), "1", "15", "(0, inf)",
     "of the repelling force, as a multiple of the micromodulus of the bonds", NULL, NULL, 0},
    {"distance", FIELD_NUMBER, offsetof(ContactSpec, distance), "1", "1.35", "(0, 2]",
     "at which particles begin to repel each other, in spacings", NULL, NULL, 0},
    {"share", FIELD_NUMBER, offsetof(ContactSpec, share), "1", "0.9", "(0, 1]",
     "of their distance at the beginning, if that is nearer", NULL, NULL, 0},
};
const Section contact_section = {
    "contact",
    "Particles that no bond joins repel each other where they come near: bodies that meet, "
    "crack faces that close. Without this section they pass through each other. It costs "
    "a shorter time step.",
    sizeof(ContactSpec),
    FIELDS(contact_fields),
    NULL,
    NULL,
    NULL,
    0};

int contact_create(Contact *c, const ContactSpec *spec, const Body *body, const Family *family, const double *constant,
                   Error *error)
{
  const int64_t places = body->particles.places;
  *c = (Contact){.spec = spec, .body = body, .family = family, .margin = 0.3 * body->largest_spacing};
  if (!spec) return BRECCIA_OK;
  c->constant = memory_zeroed((size_t)body->block_count, sizeof(double), "contact", error);
  c->touched = memory_zeroed((size_t)places, 1, "contact", error);
  c->row_of = memory_zeroed((size_t)places, sizeof(int32_t), "contact", error);
  if (!c->constant || !c->touched || !c->row_of) return BRECCIA_FAILURE;
  for (int b = 0; b < body->block_count; ++b) c->constant[b] = spec->stiffness * constant[b];
  for (int64_t i = 0; i < places; ++i) c->row_of[i] = -1;
  if (body->crack_count) memset(c->touched, 1, (size_t)places);
  contact_search(c);
  return c->failed ? error_add(error, BRECCIA_FAILURE, "out of memory: contact") : BRECCIA_OK;
}

void contact_destroy(Contact *c)
{
  for (int32_t r = 0; r < c->row_count; ++r) free(c->rows[r].pairs);
  free(c->rows);
  free(c->row_of);
  free(c->touched);
  free(c->constant);
  *c = (Contact){.spec = NULL};
}

static double contact_distance(const Contact *c, int32_t a, int32_t b)
{
  const Particles *p = &c->body->particles;
  const Lattice *one = &c->body->lattices[p->block[a / SLICE]], *other = &c->body->lattices[p->block[b / SLICE]];
  return fmin(c->spec->share * particles_distance(p, a, b), c->spec->distance * (one->spacing + other->spacing) / 2);
}

static bool bonded(const Contact *c, int32_t a, int32_t b)
{
  if (particles_distance(&c->body->particles, a, b) > c->family->horizon * (1 + 1e-9)) return false;
  return !c->touched[a] || family_joins(c->family, a, b);
}

static ContactRow *row_for(Contact *c, int32_t place)
{
  if (c->row_of[place] >= 0) return &c->rows[c->row_of[place]];
  if (c->row_count == c->row_capacity) {
    int32_t capacity = c->row_capacity ? 2 * c->row_capacity : 64;
    ContactRow *grown = realloc(c->rows, sizeof *grown * (size_t)capacity);
    if (!grown) return NULL;
    c->rows = grown;
    c->row_capacity = capacity;
  }
  c->rows[c->row_count] = (ContactRow){.place = place};
  c->row_of[place] = c->row_count++;
  return &c->rows[c->row_of[place]];
}

/** Puts a pair into its place in a row. */
static void insert(Contact *c, int32_t place, int32_t neighbour)
{
  const int32_t *number = c->body->particles.number;
  ContactRow *row = row_for(c, place);
  if (row && row->count == row->capacity) {
    int32_t capacity = row->capacity ? 2 * row->capacity : 8;
    ContactPair *grown = realloc(row->pairs, sizeof *grown * (size_t)capacity);
    if (grown) {
      row->pairs = grown;
      row->capacity = capacity;
    }
  }
  if (!row || row->count == row->capacity) {
    c->failed = true;
    return;
  }
  int32_t at = row->count;
  while (at > 0 && number[row->pairs[at - 1].neighbour] > number[neighbour]) --at;
  if (at > 0 && row->pairs[at - 1].neighbour == neighbour) return;
  memmove(row->pairs + at + 1, row->pairs + at, sizeof *row->pairs * (size_t)(row->count - at));
  row->pairs[at] = (ContactPair){neighbour, contact_distance(c, place, neighbour)};
  ++row->count;
}

void contact_bond_broke(Contact *c, int32_t a, int32_t b)
{
  if (!c->spec) return;
  c->touched[a] = c->touched[b] = 1;
  insert(c, a, b);
  insert(c, b, a);
}

void contact_search(Contact *c)
{
  const Particles *p = &c->body->particles;
  const double reach = c->spec->distance * c->body->largest_spacing + c->margin;
  double *now[3] = {0};
  Cells cells = {.width = 0};
  for (int k = 0; k < 3; ++k) {
    if (!(now[k] = places_array(p->places, "contact", NULL))) c->failed = true;
    for (int64_t i = 0; now[k] && i < p->places; ++i) now[k][i] = p->position[k][i] + p->displacement[k][i];
  }
  if (!c->failed && cells_create(&cells, p, (const double *const *)now, reach, NULL)) c->failed = true;
  for (int32_t r = 0; r < c->row_count; ++r) c->rows[r].count = 0;
  for (int64_t n = 0; n < p->count && !c->failed; ++n) {
    const int32_t place = p->place_of[n];
    const double here[3] = {now[0][place], now[1][place], now[2][place]};
    int64_t rows[9][2];
    const int count = cells_around(&cells, here, rows);
    for (int r = 0; r < count; ++r)
      for (int64_t k = rows[r][0]; k < rows[r][1]; ++k) {
        double square = 0;
        for (int j = 0; j < 3; ++j)
          square += (cells.position[3 * k + j] - here[j]) * (cells.position[3 * k + j] - here[j]);
        const int32_t other = cells.places[k];
        if (square < reach * reach && other != place && !bonded(c, place, other)) insert(c, place, other);
      }
  }
  cells_destroy(&cells);
  for (int k = 0; k < 3; ++k) places_free(&now[k]);
  c->travelled = 0;
}

void contact_follow(Contact *c, double motion)
{
  if (!c->spec) return;
  c->travelled += motion;
  if (c->travelled > c->margin / 2) contact_search(c);
}

void contact_resist(const Contact *c)
{
  if (!c->spec) return;
  const Particles *p = &c->body->particles;
  TEAM_FOR (r, c->row_count) {
    const ContactRow *row = &c->rows[r];
    const int32_t a = row->place;
    double force[3] = {0};
    for (int32_t n = 0; n < row->count; ++n) {
      const int32_t b = row->pairs[n].neighbour;
      double y[3], square = 0;
      for (int k = 0; k < 3; ++k) {
        y[k] = p->position[k][b] - p->position[k][a] + (p->displacement[k][b] - p->displacement[k][a]);
        square += y[k] * y[k];
      }
      const double d = row->pairs[n].distance;
      if (!(square < d * d) || square == 0) continue;
      const double length = sqrt(square);
      const double mean = (c->constant[p->block[a / SLICE]] + c->constant[p->block[b / SLICE]]) / 2;
      for (int k = 0; k < 3; ++k) force[k] += mean * p->volume[b] * (length - d) / length * y[k];
    }
    for (int k = 0; k < 3; ++k) p->internal[k][a] += force[k];
  }
}

double contact_eigenvalue(const Contact *c)
{
  const Particles *p = &c->body->particles;
  double most = 0;
  for (int64_t n = 0; c->spec && n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    most = fmax(most, 2 * 5 * c->constant[p->block[i / SLICE]] * p->volume[i] / p->density[i]);
  }
  return most;
}
