#include "solver/control.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

static void check_control(const DeckReader *reader, void *section)
{
  const ControlSpec *c = section;
  if (c->opening.count && c->opening.count != 2)
    node_error(reader->document, section_node(c, "opening between"), reader->error,
               "opening between: expected two points, found %d", c->opening.count);
  if (c->displacement.node && isnan(c->direction[0]))
    node_error(reader->document, section_node(c, "displacement of"), reader->error,
               "control: missing key 'direction': along which the displacement counts");
  if (!c->displacement.node && !isnan(c->direction[0]))
    node_error(reader->document, section_node(c, "direction"), reader->error,
               "direction: only of 'displacement of'; an opening counts along the line between its points");
}

static const Field control_fields[] = {
    {.key = "opening between",
     .kind = FIELD_POINTS,
     .offset = offsetof(ControlSpec, opening),
     .dimension = "length",
     .standard = "",
     .meaning = "how far the particles nearest to two points move apart along the line between them",
     .group = 'A'},
    {.key = "displacement of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(ControlSpec, displacement),
     .standard = "",
     .meaning = "mean displacement of a selection along 'direction'",
     .section = &selection_section,
     .group = 'A'},
    {.key = "direction",
     .kind = FIELD_POINT,
     .offset = offsetof(ControlSpec, direction),
     .dimension = "1",
     .standard = "",
     .meaning = "of the displacement that counts, of any length"},
    {.key = "to",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ControlSpec, to),
     .dimension = "length",
     .meaning = "its value at the end of the stage; it goes there in equal parts from where it is at its beginning"},
};

const Section control_section = {.name = "control",
                                 .about = "What loads with 'history: {controlled: yes}' are to bring about: their "
                                          "common factor is found. The peak of a load and the branch behind "
                                          "it can be followed so, also where the load point goes back.",
                                 .size = sizeof(ControlSpec),
                                 FIELDS(control_fields),
                                 .check = check_control};

static int make_room(Control *c, int64_t count, Error *error)
{
  c->count = count;
  c->places = memory_zeroed((size_t)count, sizeof *c->places, "control", error);
  bool failed = !c->places;
  for (int k = 0; k < 3; ++k)
    failed |= !(c->weight[k] = memory_zeroed((size_t)count, sizeof *c->weight[k], "control", error));
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

static int measure_opening(Control *c, const Body *body, const DeckReader *reader)
{
  const double *points = c->spec->opening.values;
  const int32_t ends[2] = {body_nearest(body, points), body_nearest(body, points + 3)};
  if (ends[0] == ends[1])
    return node_error(reader->document, section_node(c->spec, "opening between"), reader->error,
                      "opening between: the same particle is nearest to both points");
  if (make_room(c, 2, reader->error)) return BRECCIA_FAILURE;
  const double distance = particles_distance(&body->particles, ends[0], ends[1]);
  for (int e = 0; e < 2; ++e) {
    c->places[e] = ends[e];
    for (int k = 0; k < 3; ++k) {
      const double *x = body->particles.position[k];
      c->weight[k][e] = (e ? 1 : -1) * (x[ends[1]] - x[ends[0]]) / distance;
    }
  }
  return BRECCIA_OK;
}

static int measure_displacement(Control *c, const Body *body, const DeckReader *reader, const SectionList *selections)
{
  Selection selection;
  const double *d = c->spec->direction, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  int status = selection_create(&selection, body, reader, selections, &c->spec->displacement);
  if (!status && !(length > 0))
    status =
        node_error(reader->document, section_node(c->spec, "direction"), reader->error, "direction: has no length");
  if (!status) status = make_room(c, selection.count, reader->error);
  for (int64_t n = 0; n < selection.count && !status; ++n) {
    c->places[n] = selection.places[n];
    for (int k = 0; k < 3; ++k) c->weight[k][n] = d[k] / length / (double)selection.count;
  }
  selection_destroy(&selection);
  return status;
}

int control_create(Control *c, const ControlSpec *spec, const Domain *domain, const DeckReader *reader,
                   const SectionList *selections)
{
  *c = (Control){.spec = spec};
  if (!spec) return BRECCIA_OK;
  return spec->opening.count ? measure_opening(c, &domain->body, reader)
                             : measure_displacement(c, &domain->body, reader, selections);
}

void control_destroy(Control *c)
{
  free(c->places);
  for (int k = 0; k < 3; ++k) free(c->weight[k]);
  *c = (Control){0};
}

static bool is_controlled(const Loading *loading, const Load *load)
{
  return history_is_controlled(&load->history) && load_acts(loading, load);
}

int control_check(const ControlSpec *spec, const Loading *loading, const DeckReader *reader, Error *error)
{
  bool any = false;
  if (!spec) return BRECCIA_OK;
  for (int l = 0; l < loading->count; ++l) any |= is_controlled(loading, &loading->loads[l]);
  if (!any)
    return node_error(reader->document, spec->head.node, error,
                      "control: no load of this stage has a factor to be found; give one 'history: {controlled: yes}'");
  for (int k = 0; k < loading->constraint_count; ++k) {
    const Constraint *c = &loading->constraints[k];
    if (c->order && is_controlled(loading, c->load))
      return node_error(reader->document, c->load->node, error,
                        "%s: its factor cannot be found by control; prescribe a displacement instead",
                        c->load->node->key);
  }
  return BRECCIA_OK;
}

double control_value(const Control *c, double *const v[3])
{
  double sum = 0;
  for (int64_t n = 0; n < c->count; ++n)
    for (int k = 0; k < 3; ++k) sum += c->weight[k][n] * v[k][c->places[n]];
  return sum;
}

double control_shown(const Control *c, const Particles *p)
{
  return control_value(c, p->displacement) - (p->zero[0] ? control_value(c, p->zero) : 0);
}

void control_add(const Loading *loading, double change)
{
  for (int l = 0; l < loading->count; ++l)
    if (is_controlled(loading, &loading->loads[l])) loading->loads[l].history.found += change;
}

void control_accept(const Loading *loading)
{
  for (int l = 0; l < loading->count; ++l) {
    History *h = &loading->loads[l].history;
    if (is_controlled(loading, &loading->loads[l])) h->most = fmax(h->most, fabs(h->found));
  }
}
