#include "solver/control.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void check_control(const DeckReader *reader, void *section)
{
  ControlSpec *c = section;
  if (c->opening.count && c->opening.count != 2)
    node_error(reader->document, section_node(c, "opening between"), reader->error,
               "opening between: expected two points, found %d", c->opening.count);
  if (c->displacement.node && isnan(c->direction[0]))
    node_error(reader->document, section_node(c, "displacement of"), reader->error,
               "control: missing key 'direction': along which the displacement counts");
  if (!c->displacement.node && !isnan(c->direction[0]))
    node_error(reader->document, section_node(c, "direction"), reader->error,
               "direction: only of 'displacement of'; an opening counts along the line between its points");
  const char *dimension = c->bond.node ? "1" : "length", *range = c->bond.node || c->path.node ? "(0, inf)" : NULL;
  if (c->end) deck_number(reader, c->end, "to", dimension, range, &c->to);
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
    {.key = "stretch in",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(ControlSpec, bond),
     .standard = "",
     .meaning =
         "stretch of the bond of a selection (both ends belong to it) that stretches the fastest, another one in "
         "each increment: a crack is followed wherever it runs",
     .section = &selection_section,
     .group = 'A'},
    {.key = "arc length of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(ControlSpec, path),
     .standard = "",
     .meaning =
         "root mean square of the displacements of a selection, on the way that it went in the increment before: "
         "for bodies that snap through; a sharp corner, as where brittle bars break, it does not turn",
     .section = &selection_section,
     .group = 'A'},
    {.key = "direction",
     .kind = FIELD_POINT,
     .offset = offsetof(ControlSpec, direction),
     .dimension = "1",
     .standard = "",
     .meaning = "of the displacement that counts, of any length"},
    {.key = "to",
     .kind = FIELD_QUANTITY,
     .offset = offsetof(ControlSpec, end),
     .meaning = "its value at the end of the stage; it goes there in equal parts from where it is at its beginning. "
                "Of a stretch or an arc length: the sum of all increments"},
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

/** Calls `one` for each intact bond that may be measured, from both its ends. */
static void each_bond(const Control *c, void (*one)(void *context, int64_t place, const Bond *bond), void *context)
{
  const Family *f = &c->domain->family;
  for (int64_t slice = 0; slice < c->domain->particles->places / SLICE; ++slice)
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        const int64_t place = slice * SLICE + lane;
        if (!(f->intact[slot] >> lane & 1) || !c->belongs[place]) continue;
        const Bond bond = family_bond(f, slice, slot, lane);
        if (c->belongs[bond.neighbour]) one(context, place, &bond);
      }
}

static void note(void *any, int64_t place, const Bond *bond)
{
  (void)place, (void)bond;
  *(bool *)any = true;
}

/** What a way is measured on, or a bond is looked for in. */
static int measure_found(Control *c, const Reference *in, const DeckReader *reader, const SectionList *selections)
{
  Selection selection;
  int status = selection_create(&selection, &c->domain->body, reader, selections, in);
  if (status) return status;
  const bool bond = in == &c->spec->bond;
  status = make_room(c, bond ? 2 : selection.count, reader->error);
  if (!status && !bond) memcpy(c->places, selection.places, sizeof *c->places * (size_t)c->count);
  if (!status && bond) {
    c->belongs = memory_zeroed((size_t)c->domain->particles->places, 1, "control", reader->error);
    if (!c->belongs) status = BRECCIA_FAILURE;
    bool any = false;
    for (int64_t n = 0; n < selection.count && !status; ++n) c->belongs[selection.places[n]] = 1;
    if (!status) each_bond(c, note, &any);
    if (!status && !any)
      status = node_error(reader->document, section_node(c->spec, "stretch in"), reader->error,
                          "stretch in: no bond has both its ends among these particles (%lld); take more of the body, "
                          "or 'all: yes'",
                          (long long)selection.count);
  }
  selection_destroy(&selection);
  return status;
}

int control_create(Control *c, const ControlSpec *spec, const Domain *domain, const DeckReader *reader,
                   const SectionList *selections)
{
  *c = (Control){.spec = spec, .domain = domain, .reader = reader};
  if (!spec) return BRECCIA_OK;
  if (spec->opening.count) return measure_opening(c, &domain->body, reader);
  if (spec->displacement.node) return measure_displacement(c, &domain->body, reader, selections);
  return measure_found(c, spec->path.node ? &spec->path : &spec->bond, reader, selections);
}

void control_destroy(Control *c)
{
  free(c->places);
  free(c->belongs);
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

double control_shown(const Control *c)
{
  const Particles *p = c->domain->particles;
  return control_value(c, p->displacement.row) - (p->zero[0] ? control_value(c, p->zero) : 0);
}

/** Lets the value of a path count displacements along v. */
static void point_along(Control *c, double *const v[3])
{
  double sum = 0;
  for (int64_t n = 0; n < c->count; ++n)
    for (int k = 0; k < 3; ++k) sum += v[k][c->places[n]] * v[k][c->places[n]];
  if (!(sum > 0)) return;
  for (int64_t n = 0; n < c->count; ++n)
    for (int k = 0; k < 3; ++k) c->weight[k][n] = v[k][c->places[n]] / sqrt(sum * (double)c->count);
}

typedef struct Search {
  Control *control;
  double *const *v;
  double most; /* stretch by v so far */
} Search;

/** Lets the value be the stretch of a bond, if v stretches or shortens it more than those before. One that v shortens stretches while the loads fall: a
 *  stretched one of a crack that opens does; one that is shorter than it was would only do so for loads that turn round. */
static void consider(void *context, int64_t place, const Bond *bond)
{
  Search *s = context;
  Control *c = s->control;
  double *const *u = c->domain->particles->displacement.row;
  double along[3], stretch = 0, now = 0;
  for (int k = 0; k < 3; ++k) {
    along[k] = bond->xi[k] / (bond->length * bond->length);
    stretch += along[k] * (s->v[k][bond->neighbour] - s->v[k][place]);
    now += along[k] * (u[k][bond->neighbour] - u[k][place]);
  }
  if (!(fabs(stretch) > s->most) || (stretch < 0 && now <= 0)) return;
  s->most = fabs(stretch);
  c->places[0] = (int32_t)place;
  c->places[1] = bond->neighbour;
  for (int k = 0; k < 3; ++k) {
    c->weight[k][0] = -along[k];
    c->weight[k][1] = along[k];
  }
}

static void consider_broken(Search *s)
{
  const Domain *d = s->control->domain;
  const Particles *p = d->particles;
  for (int64_t n = 0; n < d->broken_count; ++n) {
    const int32_t a = p->place_of[d->broken[n].a], b = p->place_of[d->broken[n].b];
    if (!s->control->belongs[a] || !s->control->belongs[b]) continue;
    Bond bond = {.neighbour = b, .length = particles_distance(p, a, b)};
    for (int k = 0; k < 3; ++k) bond.xi[k] = p->position[k][b] - p->position[k][a];
    consider(s, a, &bond);
  }
}

/** Lets the value be the stretch of the bond that v stretches or shortens the most. Where the body is torn, v moves its parts as they are, and what
 *  bonds show of it are roundings: then a broken one is taken, across which the parts go on to open. */
static void take_bond(Control *c, const Vector *v)
{
  const double roundings = 1e-6; /* of mean strains */
  const Particles *p = c->domain->particles;
  Search search = {c, v->row, 0};
  double low[3], high[3], size = 0;
  each_bond(c, consider, &search);
  particles_bounds(p, low, high);
  for (int k = 0; k < 3; ++k) size = fmax(size, high[k] - low[k]);
  if (search.most * size > roundings * vector_largest(v)) return;
  search.most = 0;
  consider_broken(&search);
}

static bool follows_path(const Control *c)
{
  return c->spec->path.node;
}

void control_open(Control *c)
{
  c->open = c->spec->bond.node || follows_path(c);
}

void control_begin(Control *c)
{
  if (!c->spec) return;
  c->on_way = 0;
  c->exerted = c->exerted_most = 0;
  c->from = control_shown(c);
}

double control_target(Control *c, double before, double after)
{
  const double to = c->spec->to;
  c->open = c->spec->bond.node ? after > before : follows_path(c) && !c->on_way;
  for (int k = 0; k < 3 && c->open; ++k) memset(c->weight[k], 0, sizeof(double) * (size_t)c->count);
  const double now = control_shown(c);
  c->step = follows_path(c) || c->spec->bond.node ? to * (after - before) : c->from + (to - c->from) * after - now;
  return now + c->step;
}

double control_aim(Control *c, const Vector *motion)
{
  if (!c->open) return 0;
  if (follows_path(c))
    point_along(c, motion->row);
  else
    take_bond(c, motion);
  return control_shown(c);
}

/** The key that says what is measured. */
static const char *measure_key(const Control *c)
{
  const ControlSpec *s = c->spec;
  return s->opening.count       ? "opening between"
         : s->displacement.node ? "displacement of"
         : s->bond.node         ? "stretch in"
                                : "arc length of";
}

int control_check_answer(const Control *c, const Vector *motion, Error *error)
{
  const double least = 1e-7; /* of the largest motion: the longest beam that bends stretches by a thousandth of it */
  const double most = vector_largest(motion);
  double weights = 0;
  for (int64_t n = 0; n < c->count; ++n)
    for (int k = 0; k < 3; ++k) weights += fabs(c->weight[k][n]);
  if (most == 0)
    return node_error(c->reader->document, c->spec->head.node, error,
                      "control: the controlled loads move nothing: all that they act on is held; let them act on "
                      "particles that can move");
  if (c->spec->to == control_shown(c))
    return node_error(c->reader->document, section_node(c->spec, "to"), error,
                      "to: %g is its value at the beginning, so that the controlled loads have nothing to do",
                      c->spec->to);
  if (!isfinite(most) || !(fabs(control_value(c, motion->row)) <= least * weights * most)) return BRECCIA_OK;
  return node_error(c->reader->document, section_node(c->spec, measure_key(c)), error,
                    "%s: it does not change with the controlled loads, so that no factor of theirs can bring it about; "
                    "take what they move, in the direction in which they do",
                    measure_key(c));
}

void control_add(const Loading *loading, double change)
{
  for (int l = 0; l < loading->count; ++l)
    if (is_controlled(loading, &loading->loads[l])) loading->loads[l].history.found += change;
}

void control_accept(Control *c, const Loading *loading, double *const moved[3])
{
  for (int l = 0; l < loading->count; ++l) {
    History *h = &loading->loads[l].history;
    if (is_controlled(loading, &loading->loads[l]) && fabs(h->found) > fabs(h->most)) h->most = h->found;
  }
  if (!follows_path(c) || c->step == 0) return; /* bonds have broken on the way, which goes on */
  point_along(c, moved);
  ++c->on_way;
}

void control_note_exerted(Control *c, double force)
{
  c->exerted = force;
  c->exerted_most = fmax(c->exerted_most, force);
}

bool control_is_spent(const Control *c)
{
  const double share = 1e-3;
  return c->spec && c->spec->bond.node && c->domain->broken_count && c->exerted <= share * c->exerted_most;
}

void control_tell_torn(const Control *c, const Clock *clock, Text *warning)
{
  const Domain *d = c->domain;
  const Particles *p = d->particles;
  const BrokenBond *bond = &d->broken[d->broken_count - 1];
  const int32_t a = p->place_of[bond->a], b = p->place_of[bond->b];
  char where[WHERE_SIZE];
  double middle[3];
  for (int k = 0; k < 3; ++k) middle[k] = (p->position[k][a] + p->position[k][b]) / 2;
  node_where(c->reader->document, section_node(c->spec, "stretch in"), where, sizeof where);
  text_add(
      warning,
      "%s%s: warning: stretch in: the body is torn at time %.6g %s, its last bond near [%.4g, %.4g, %.4g], and the "
      "controlled loads exert less than a thousandth of their most: the stage ends here; to draw the parts further, "
      "control an 'opening between' them",
      warning->length ? "\n" : "", where, clock->time, clock->time_unit, middle[0], middle[1], middle[2]);
}

void control_state(Control *c, StateList *list)
{
  static const char *const axes[] = {"x", "y", "z"};
  if (!c->spec) return;
  state_add_number(list, "control at the begin", "length", STATE_COMMITTED, &c->from);
  if (c->spec->bond.node) {
    state_add_number(list, "controlled force", "force", STATE_COMMITTED, &c->exerted);
    state_add_number(list, "controlled force at most", "force", STATE_COMMITTED, &c->exerted_most);
  }
  if (!follows_path(c)) return;
  state_add_count(list, "increments of the path", STATE_COMMITTED, &c->on_way);
  for (int k = 0; k < 3; ++k)
    state_add(list,
              &(StateRow){.unit = "1",
                          .kind = STATE_NUMBERS,
                          .entity = STATE_OF_ALL,
                          .role = STATE_COMMITTED,
                          .count = c->count,
                          .values = c->weight[k]},
              "way of the path", axes[k]);
}
