#include "results/watch_parts.h"

#include "bars/bars.h"
#include "base/memory.h"
#include "base/tensor.h"
#include "results/fields.h"
#include <stdlib.h>
#include <string.h>

static void check_between(const DeckReader *reader, const void *section, const char *key, const NumberList *points)
{
  if (points->count && points->count != 2)
    node_error(reader->document, section_node(section, key), reader->error, "%s: expected two points, found %d", key,
               points->count);
}
static void check_watch(const DeckReader *reader, void *section)
{
  const WatchSpec *w = section;
  check_between(reader, w, "opening between", &w->opening);
  check_between(reader, w, "bond between", &w->bond);
  if (!isnan(w->at[0]) && !w->bar)
    node_error(reader->document, section_node(w, "at"), reader->error,
               "at: a place on a bar; name it under 'bar', or leave 'at' out");
}

static const Field watch_fields[] = {
    {.key = "every",
     .kind = FIELD_COUNT,
     .offset = offsetof(WatchSpec, every),
     .standard = "",
     .range = "[1, inf)",
     .meaning = "a row every so many steps; when absent 10, and 1 in stages of few long steps: static, implicit"},
    {.key = "displacement of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(WatchSpec, displacement),
     .standard = "",
     .meaning = "mean displacement",
     .section = &selection_section,
     .group = 'A'},
    {.key = "velocity of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(WatchSpec, velocity),
     .standard = "",
     .meaning = "mean velocity",
     .section = &selection_section,
     .group = 'A'},
    {.key = "force on",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(WatchSpec, force),
     .standard = "",
     .meaning =
         "total force that bonds exert on these particles; at rest minus what else acts on them: loads, their weight, "
         "and the reaction where a motion is prescribed",
     .section = &selection_section,
     .group = 'A'},
    {.key = "reaction on",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(WatchSpec, reaction),
     .standard = "",
     .meaning =
         "total force that supports and prescribed motions exert on these particles, inertia and damping allowed "
         "for, and its moment about their middle; of a support, which mirrors, about the middle of its face",
     .section = &selection_section,
     .group = 'A'},
    {.key = "stress and strain of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(WatchSpec, stress),
     .standard = "",
     .meaning = "mean strain and stress",
     .section = &selection_section,
     .group = 'A'},
    {.key = "history of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(WatchSpec, history),
     .standard = "",
     .meaning = "mean of the named histories of the first particle's material (plastic strains, damage, cap ...)",
     .section = &selection_section,
     .group = 'A'},
    {.key = "damage of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(WatchSpec, damage),
     .standard = "",
     .meaning = "mean and largest damage",
     .section = &selection_section,
     .group = 'A'},
    {.key = "opening between",
     .kind = FIELD_POINTS,
     .offset = offsetof(WatchSpec, opening),
     .dimension = "length",
     .standard = "",
     .meaning = "distance of the particles nearest to two points, and its growth",
     .group = 'A'},
    {.key = "bond between",
     .kind = FIELD_POINTS,
     .offset = offsetof(WatchSpec, bond),
     .dimension = "length",
     .standard = "",
     .meaning = "stretch of the bond between the particles nearest to two points, and whether it is intact",
     .group = 'A'},
    {.key = "load",
     .kind = FIELD_NAME,
     .offset = offsetof(WatchSpec, load),
     .dimension = "load",
     .standard = "",
     .meaning =
         "factor by the history and value of a named load; both 0 in stages in which it does not act. The value of a "
         "strength reduction is the number by which strengths are divided, 1 where it does not act",
     .group = 'A'},
    {.key = "reaction of",
     .kind = FIELD_NAME,
     .offset = offsetof(WatchSpec, reaction_of),
     .dimension = "load",
     .standard = "",
     .meaning = "the same of a named support or prescribed motion: force and moment that it exerts on the body",
     .group = 'A'},
    {.key = "energy",
     .kind = FIELD_FLAG,
     .offset = offsetof(WatchSpec, energy),
     .standard = "",
     .meaning = "the energy ledger and the number of broken bonds",
     .group = 'A'},
    {.key = "bar",
     .kind = FIELD_NAME,
     .offset = offsetof(WatchSpec, bar),
     .dimension = "bar",
     .standard = "",
     .meaning =
         "a reinforcing bar: its least and largest strain and stress, its energies, and which shares of its "
         "length have yielded and are torn; with 'at' the strain, stress and force (of all parallel bars) there; and "
         "slips, with 'at' bond stress too, of a bar with 'bond'",
     .group = 'A'},
    {.key = "at",
     .kind = FIELD_POINT,
     .offset = offsetof(WatchSpec, at),
     .dimension = "length",
     .standard = "",
     .meaning = "with 'bar': a point, of whose nearest element of the bar it is"},
};

const Section watch_section = {.name = "watch",
                               .about = "A history, written to a CSV file of the same name.",
                               .size = sizeof(WatchSpec),
                               FIELDS(watch_fields),
                               .check = check_watch};

static void mean(double *const from[3], const Selection *s, double *values)
{
  for (int k = 0; k < 3; ++k) {
    values[k] = 0;
    for (int64_t n = 0; n < s->count; ++n) values[k] += from[k][s->places[n]];
    values[k] /= (double)s->count;
  }
}
static void displacement_row(const Watch *w, const Solver *s, double *values)
{
  const Particles *p = s->domain->particles;
  mean(p->displacement.row, &w->selection, values);
  if (!p->zero[0]) return;
  double zero[3];
  mean(p->zero, &w->selection, zero);
  for (int k = 0; k < 3; ++k) values[k] -= zero[k];
}
static void velocity_row(const Watch *w, const Solver *s, double *values)
{
  mean(s->domain->particles->velocity.row, &w->selection, values);
}
static void force_row(const Watch *w, const Solver *s, double *values)
{
  const Particles *p = s->domain->particles;
  for (int k = 0; k < 3; ++k) {
    values[k] = 0;
    for (int64_t n = 0; n < w->selection.count; ++n)
      values[k] += p->internal.row[k][w->selection.places[n]] * p->volume[w->selection.places[n]];
  }
}
static void reaction_row(const Watch *w, const Solver *s, double *values)
{
  const Wrench sum = reactions_sum(&w->reactions, s, w->on, w->spec->reaction_of, NULL);
  for (int k = 0; k < 3; ++k) {
    values[k] = sum.force[k];
    values[3 + k] = sum.moment[k];
  }
}
static void stress_row(const Watch *w, const Solver *s, double *values)
{
  double *strain = values, *stress = values + 6, tensor[6];
  for (int k = 0; k < 12; ++k) values[k] = 0;
  for (int64_t n = 0; n < w->selection.count; ++n) {
    double here[12];
    domain_look(s->domain, w->selection.places[n], here, here + 6);
    for (int k = 0; k < 12; ++k) values[k] += here[k] / (double)w->selection.count;
  }
  for (int k = 0; k < 6; ++k) tensor[k] = k < 3 ? strain[k] : strain[k] / 2;
  values[12] = 2 * tensor_octahedral_shear(tensor);
  values[13] = tensor_octahedral_shear(stress);
  values[14] = (stress[XX] + stress[YY] + stress[ZZ]) / 3;
}
static void history_row(const Watch *w, const Solver *s, double *values)
{
  for (int c = 0; c < MOST_COLUMNS && w->history[c] >= 0; ++c) {
    values[c] = 0;
    for (int64_t n = 0; n < w->selection.count; ++n)
      values[c] += domain_history(s->domain, w->selection.places[n], w->history[c]) / (double)w->selection.count;
  }
}
static void damage_row(const Watch *w, const Solver *s, double *values)
{
  values[0] = values[1] = 0;
  for (int64_t n = 0; n < w->selection.count; ++n) {
    double damage = domain_damage(s->domain, w->selection.places[n]);
    values[0] += damage / (double)w->selection.count;
    values[1] = fmax(values[1], damage);
  }
}
/** Distance of the ends now, and where displacements count from. */
static void distances(const Watch *w, const Solver *s, double *now, double *reference)
{
  const Particles *p = s->domain->particles;
  *now = *reference = 0;
  for (int k = 0; k < 3; ++k) {
    double xi = p->position[k][w->ends[1]] - p->position[k][w->ends[0]];
    double y = xi + p->displacement.row[k][w->ends[1]] - p->displacement.row[k][w->ends[0]];
    *now += y * y;
    if (p->zero[k]) xi += p->zero[k][w->ends[1]] - p->zero[k][w->ends[0]];
    *reference += xi * xi;
  }
  *now = sqrt(*now);
  *reference = sqrt(*reference);
}
static void opening_row(const Watch *w, const Solver *s, double *values)
{
  double reference;
  distances(w, s, &values[0], &reference);
  values[1] = values[0] - reference;
}
static void bond_row(const Watch *w, const Solver *s, double *values)
{
  double now, reference;
  distances(w, s, &now, &reference);
  values[0] = now / particles_distance(s->domain->particles, w->ends[0], w->ends[1]) - 1;
  values[1] = family_joins(&s->domain->family, w->ends[0], w->ends[1]);
}
static void load_row(const Watch *w, const Solver *s, double *values)
{
  values[0] = 0;
  values[1] = 0 + load_value(w->load, 0); /* not -0 */
  for (int l = 0; l < s->loading->count;
       ++l) { /* of that name one acts at most, or several that begin together: the last */
    const Load *load = &s->loading->loads[l];
    if (!load->spec->name || strcmp(load->spec->name, w->spec->load) || !load_acts(s->loading, load)) continue;
    values[0] = load_factor(load, s->clock.time);
    values[1] = load_value(load->spec, values[0]);
  }
}
static void energy_row(const Watch *w, const Solver *s, double *values)
{
  (void)w;
  Energy e = solver_energy(s);
  const double row[] = {e.kinetic,    e.internal,  e.stored,
                        e.dissipated, e.external,  e.damping,
                        e.fracture,   e.imbalance, (double)s->domain->broken_count,
                        e.friction,   e.shed};
  memcpy(values, row, sizeof row);
}

static void bar_row(const Watch *w, const Solver *s, double *values)
{
  const BarReport r = bar_report(bars_among(&s->domain->forces), w->bar);
  const double row[] = {r.least_strain, r.largest_strain, r.least_stress, r.largest_stress,
                        r.stored,       r.dissipated,     r.yielded,      r.torn};
  memcpy(values, row, sizeof row);
}
static void element_row(const Watch *w, const Solver *s, double *values)
{
  const Bars *b = bars_among(&s->domain->forces);
  values[0] = b->strain_held[w->element];
  values[1] = b->stress_held[w->element];
  values[2] = b->area[w->element] * b->stress_held[w->element];
}

static void slipping_bar_row(const Watch *w, const Solver *s, double *values)
{
  const BarReport r = bar_report(bars_among(&s->domain->forces), w->bar);
  bar_row(w, s, values);
  values[8] = r.least_slip;
  values[9] = r.largest_slip;
}

static void slipping_element_row(const Watch *w, const Solver *s, double *values)
{
  const Bars *b = bars_among(&s->domain->forces);
  element_row(w, s, values);
  values[3] = bar_slip_in(b, bar_of(b, w->element), w->element);
  values[4] = bar_bond_stress_in(b, bar_of(b, w->element), w->element);
}

static const Kind
    displacement_kind = {"x:length,y:length,z:length", displacement_row},
    velocity_kind = {"x:velocity,y:velocity,z:velocity", velocity_row},
    force_kind = {"x:force,y:force,z:force", force_row},
    reaction_kind = {"x:force,y:force,z:force,moment x:energy,moment y:energy,moment z:energy", reaction_row},
    stress_kind = {"strain xx:1,strain yy:1,strain zz:1,strain xy:1,strain yz:1,strain zx:1,stress xx:stress,"
                   "stress yy:stress,stress zz:stress,stress xy:stress,stress yz:stress,stress "
                   "zx:stress,octahedral shear strain:1,octahedral shear stress:stress,mean stress:stress",
                   stress_row},
    damage_kind = {"mean:1,largest:1", damage_row}, opening_kind = {"distance:length,opening:length", opening_row},
    bond_kind = {"stretch:1,intact:1", bond_row},
    energy_kind = {"kinetic:energy,internal:energy,stored:energy,dissipated:energy,external:energy,damping:"
                   "energy,fracture:energy,"
                   "imbalance:1,broken bonds:1,friction:energy,shed:energy",
                   energy_row},
#define BAR_COLUMNS                                                                                                    \
  "least strain:1,largest strain:1,least stress:stress,largest stress:stress,stored:energy,dissipated:energy,"         \
  "yielded:1,torn:1"
#define ELEMENT_COLUMNS "strain:1,stress:stress,force:force"
    bar_kind = {BAR_COLUMNS, bar_row}, element_kind = {ELEMENT_COLUMNS, element_row},
    slipping_bar_kind = {BAR_COLUMNS ",least slip:length,largest slip:length", slipping_bar_row},
    slipping_element_kind = {ELEMENT_COLUMNS ",slip:length,bond stress:stress", slipping_element_row};
#undef BAR_COLUMNS
#undef ELEMENT_COLUMNS
static int resolve_ends(Watch *w, const Body *body, const Family *family, const DeckReader *reader)
{
  const NumberList *points = w->spec->opening.count ? &w->spec->opening : &w->spec->bond;
  const char *key = w->spec->opening.count ? "opening between" : "bond between";
  for (int e = 0; e < 2; ++e) w->ends[e] = body_nearest(body, points->values + 3 * e);
  if (w->ends[0] == w->ends[1])
    return node_error(reader->document, section_node(w->spec, key), reader->error,
                      "%s: the same particle is nearest to both points", key);
  if (w->spec->bond.count && !family_joins(family, w->ends[0], w->ends[1]))
    return node_error(reader->document, section_node(w->spec, key), reader->error,
                      "%s: no bond joins the particles nearest to these points", key);
  return BRECCIA_OK;
}

/** Columns for the named histories of the material at the first particle of the selection. */
static int name_histories(Watch *w, const Domain *domain, const DeckReader *reader)
{
  const int material = domain->material[w->selection.places[0] / SLICE];
  const Material *m = &domain->materials[material];
  int count = 0;
  for (int64_t n = 0; n < w->selection.count; ++n)
    if (domain->material[w->selection.places[n] / SLICE] != material)
      return node_error(reader->document, section_node(w->spec, "history of"), reader->error,
                        "history of: the particles are of several materials, whose histories are not the same");
  for (int k = 0; m->law->history_name && k < m->history_values && count < MOST_COLUMNS - 1; ++k) {
    char name[64] = "";
    m->law->history_name(m->constants, k, name, sizeof name);
    if (!*name) continue;
    const size_t used = strlen(w->columns);
    snprintf(w->columns + used, sizeof w->columns - used, "%s%s:%s", used ? "," : "", name,
             history_field_dimension(m, k));
    w->history[count++] = k;
  }
  w->history[count] = -1;
  if (!count)
    return node_error(reader->document, section_node(w->spec, "history of"), reader->error,
                      "history of: %s has no named history", m->law_name);
  w->own = (Kind){w->columns, history_row};
  w->kind = &w->own;
  return BRECCIA_OK;
}

/** Room for reactions; says so where no motion is prescribed to any particle that is watched. */
static int resolve_reaction(Watch *w, const Domain *domain, const Loading *loading, const DeckReader *reader,
                            const SectionList *selections)
{
  const char *name = w->spec->reaction_of, *key = name ? "reaction of" : "reaction on";
  w->kind = &reaction_kind;
  if (reactions_create(&w->reactions, domain->particles, reader->error)) return BRECCIA_FAILURE;
  if (!name) {
    const int status = selection_create(&w->selection, &domain->body, reader, selections, &w->spec->reaction);
    if (status) return status;
    if (!(w->on = memory_zeroed((size_t)domain->particles->places, 1, "reactions", reader->error)))
      return BRECCIA_FAILURE;
    for (int64_t n = 0; n < w->selection.count; ++n) w->on[w->selection.places[n]] = 1;
  }
  bool known = !name;
  for (int l = 0; l < loading->count && !known; ++l) {
    const char *own = loading->loads[l].spec->name;
    known = own && !strcmp(own, name);
  }
  if (!known) return BRECCIA_USER_ERROR; /* said when the deck was read (deck/names.h) */
  bool holds = false;
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    const Load *load = constraint->load;
    const bool named = name && load->spec->name && !strcmp(load->spec->name, name);
    holds |= named;
    for (int64_t n = 0; !name && n < load->selection.count; ++n) holds |= w->on[load->selection.places[n]] > 0;
  }
  if (holds) return BRECCIA_OK;
  return node_error(reader->document, section_node(w->spec, key), reader->error,
                    name
                        ? "reaction of: the load '%s' prescribes no motion; what forces come to is told by 'load'"
                        : "reaction on: no motion is prescribed to these particles; name a support under 'reaction of'",
                    name);
}

static int resolve(Watch *w, const Domain *domain, const Loading *loading, const DeckReader *reader,
                   const SectionList *selections)
{
  const WatchSpec *spec = w->spec;
  const Body *body = &domain->body;
  const Family *family = &domain->family;
  if (spec->history.node) {
    int status = selection_create(&w->selection, body, reader, selections, &spec->history);
    return status ? status : name_histories(w, domain, reader);
  }
  if (spec->bar) {
    const Bars *b = bars_among(&domain->forces);
    if ((w->bar = bars_find(b, spec->bar)) < 0) return BRECCIA_USER_ERROR; /* said when the deck was read */
    if (bar_slips(b, b->lines.first[w->bar]))
      w->kind = isnan(spec->at[0]) ? &slipping_bar_kind : &slipping_element_kind;
    else
      w->kind = isnan(spec->at[0]) ? &bar_kind : &element_kind;
    w->element = isnan(spec->at[0]) ? 0 : bar_nearest(b, w->bar, spec->at);
    return BRECCIA_OK;
  }
  if (spec->reaction.node || spec->reaction_of) return resolve_reaction(w, domain, loading, reader, selections);
  const struct {
    const Reference *reference;
    const Kind *kind;
  } selected[] = {{&spec->displacement, &displacement_kind},
                  {&spec->velocity, &velocity_kind},
                  {&spec->force, &force_kind},
                  {&spec->stress, &stress_kind},
                  {&spec->damage, &damage_kind}};
  for (int k = 0; k < 5; ++k)
    if (selected[k].reference->node) {
      w->kind = selected[k].kind;
      return selection_create(&w->selection, body, reader, selections, selected[k].reference);
    }
  if (spec->opening.count || spec->bond.count) {
    w->kind = spec->opening.count ? &opening_kind : &bond_kind;
    return resolve_ends(w, body, family, reader);
  }
  if (!spec->load) {
    w->kind = &energy_kind;
    return BRECCIA_OK;
  }
  const char *dimension = NULL, *other;
  for (int l = 0; l < loading->count; ++l) {
    if (!loading->loads[l].spec->name || strcmp(loading->loads[l].spec->name, spec->load) != 0) continue;
    w->load = loading->loads[l].spec;
    load_kind(w->load, &other);
    if (dimension && strcmp(dimension, other) != 0)
      return node_error(reader->document, section_node(spec, "load"), reader->error,
                        "load: the loads of the name '%s' are of several kinds, whose values have not one unit; give "
                        "each a name of its own, and end the earlier one by 'without'",
                        spec->load);
    dimension = other;
  }
  if (w->load) { /* the value of a load, in the unit of what it prescribes */
    snprintf(w->columns, sizeof w->columns, "factor:1,value:%s", dimension);
    w->own = (Kind){w->columns, load_row};
    w->kind = &w->own;
    return BRECCIA_OK;
  }
  return BRECCIA_USER_ERROR; /* said when the deck was read */
}

typedef struct FileOf { /* a history and the name of its file */
  char name[WATCH_FILE];
  int which;
} FileOf;

static int by_name(const void *a, const void *b)
{
  const FileOf *one = a, *other = b;
  const int order = strcmp(one->name, other->name);
  return order ? order : one->which - other->which;
}

/** Refuses histories that would be written into one file: names can differ in what names of files cannot hold. */
static int check_files(const Watches *watches, const DeckReader *reader)
{
  FileOf *files = memory_zeroed((size_t)watches->count + 1, sizeof *files, "watches", reader->error);
  int status = files ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int k = 0; files && k < watches->count; ++k) {
    files[k].which = k;
    text_file_name(watches_name(watches, k), files[k].name, WATCH_FILE);
  }
  if (files) qsort(files, (size_t)watches->count, sizeof *files, by_name);
  for (int k = 1; files && k < watches->count; ++k) {
    if (strcmp(files[k - 1].name, files[k].name) != 0) continue;
    const Node where = node_of_key(watches->items[files[k].which].spec->head.node);
    status =
        node_error(reader->document, &where, reader->error,
                   "watch: '%s' would be written into %s.csv, like '%s': give it another name",
                   watches_name(watches, files[k].which), files[k].name, watches_name(watches, files[k - 1].which));
  }
  free(files);
  return status;
}

int watches_create(Watches **out, const Domain *domain, const Loading *loading, const DeckReader *reader,
                   const SectionList *specs, const SectionList *selections)
{
  Watches *watches = *out = memory_plain(1, sizeof *watches);
  if (!watches || !(watches->items = memory_plain((size_t)specs->count + 1, sizeof(Watch))))
    return error_add(reader->error, BRECCIA_FAILURE, "out of memory: watches");
  int status = BRECCIA_OK;
  for (int k = 0; k < specs->count; ++k) {
    Watch *w = &watches->items[watches->count++];
    w->spec = specs->items[k];
    w->last_step = w->kept_step = -1;
    int bad = resolve(w, domain, loading, reader, selections);
    if (bad) status = bad;
  }
  const int bad = check_files(watches, reader);
  return bad ? bad : status;
}

int watch_columns(const Kind *kind)
{
  int columns = 1;
  for (const char *c = kind->columns; *c; ++c) columns += *c == ',';
  return columns;
}

const char *watches_name(const Watches *watches, int k)
{
  return watches->items[k].spec->head.name;
}

int watches_column(const Watches *watches, int k, int c, char *name, size_t size)
{
  static const char *const first[] = {"step", "time"};
  if (c < 2) {
    snprintf(name, size, "%s", first[c]);
    return 0;
  }
  const Kind *kind = watches->items[k].kind;
  const char *column = kind ? kind->columns : NULL;
  for (int n = 2; n < c && column; ++n) {
    column = strchr(column, ',');
    if (column) ++column;
  }
  if (!column) return 1;
  snprintf(name, size, "%.*s", (int)strcspn(column, ":"), column);
  return 0;
}

int watches_count(const Watches *watches)
{
  return watches->count;
}

bool watches_look_at_tensors(const Watches *watches)
{
  bool looks = false;
  for (int k = 0; k < watches->count; ++k) looks |= watches->items[k].kind == &stress_kind;
  return looks;
}

void watches_destroy(Watches **watches)
{
  if (!watches || !*watches) return;
  for (int k = 0; k < (*watches)->count; ++k) {
    Watch *w = &(*watches)->items[k];
    selection_destroy(&w->selection);
    reactions_destroy(&w->reactions);
    free(w->on);
    if (w->file) fclose(w->file);
    free(w->path);
  }
  free((*watches)->items);
  free(*watches);
  *watches = NULL;
}
