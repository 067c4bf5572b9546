#include "results/profile.h"

#include "base/folder.h"
#include "base/memory.h"
#include "base/tensor.h"
#include "base/whole_file.h"
#include "results/plot.h"
#include "results/watch.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const axes[] = {"x", "y", "z", NULL};

static const Field profile_fields[] = {
    {.key = "of",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(ProfileSpec, of),
     .meaning = "the particles; those at one place along the axis are a layer, of which the mean is taken",
     .section = &selection_section},
    {.key = "along",
     .kind = FIELD_CHOICE,
     .offset = offsetof(ProfileSpec, along),
     .meaning = "the axis",
     .words = axes},
    {.key = "every",
     .kind = FIELD_COUNT,
     .offset = offsetof(ProfileSpec, every),
     .standard = "",
     .range = "[1, inf)",
     .meaning =
         "looked at every so many steps; when absent 10, and 1 in stages of few long steps. Accelerations are changes "
         "of velocity from one look to the next"},
};

const Section profile_section = {
    .name = "profile",
    .about =
        "The largest displacement, velocity, acceleration, shear strain and shear stress of layers of particles in the "
        "course of the run, over their place along an axis: a CSV file and pictures. Shear is that on planes across "
        "the axis.",
    .size = sizeof(ProfileSpec),
    FIELDS(profile_fields)};

/* What is largest of each layer, in the order of the columns of its file. */
enum { MOVED, SPEED = MOVED + 3, SHAKEN = SPEED + 3, STRAIN = SHAKEN + 3, STRESS, PEAKS };
static const struct {
  const char *name, *dimension;
} columns[PEAKS] = {{"displacement x", "length"},       {"displacement y", "length"},
                    {"displacement z", "length"},       {"velocity x", "velocity"},
                    {"velocity y", "velocity"},         {"velocity z", "velocity"},
                    {"acceleration x", "acceleration"}, {"acceleration y", "acceleration"},
                    {"acceleration z", "acceleration"}, {"shear strain", "1"},
                    {"shear stress", "stress"}};

typedef struct Profile {
  const ProfileSpec *spec;
  int axis, count;     /* layers */
  Selection selection; /* sorted by layers */
  int64_t *first;      /* [count + 1] layer n is selection first[n] .. first[n + 1] - 1 */
  double *at;          /* [count] place along the axis */
  double *peaks;       /* [PEAKS][count] */
  double *velocity;    /* [3][count] at the last look */
  double time;         /* of it */
  int64_t looks;
} Profile;

struct Profiles {
  int count, dimensions;
  Profile *items;
};

typedef struct Standing {
  double at;
  int32_t place;
} Standing;

static int by_height(const void *a, const void *b)
{
  const Standing *one = a, *other = b;
  if (one->at != other->at) return one->at < other->at ? -1 : 1;
  return (one->place > other->place) - (one->place < other->place);
}

/** Sorts the particles into layers, lowest first. */
static int find_layers(Profile *profile, const Body *body, Error *error)
{
  const Particles *p = &body->particles;
  const int64_t count = profile->selection.count;
  const double apart = 1e-3 * body->largest_spacing;
  Standing *all = memory_zeroed((size_t)count, sizeof *all, "profiles", error);
  profile->first = memory_zeroed((size_t)count + 1, sizeof *profile->first, "profiles", error);
  profile->at = memory_zeroed((size_t)count, sizeof *profile->at, "profiles", error);
  const bool failed = !all || !profile->first || !profile->at;
  for (int64_t n = 0; n < count && !failed; ++n)
    all[n] = (Standing){p->position[profile->axis][profile->selection.places[n]], profile->selection.places[n]};
  if (!failed) qsort(all, (size_t)count, sizeof *all, by_height);
  for (int64_t n = 0; n < count && !failed; ++n) {
    if (!n || all[n].at - profile->at[profile->count - 1] > apart) {
      profile->first[profile->count] = n;
      profile->at[profile->count++] = all[n].at;
    }
    profile->selection.places[n] = all[n].place;
    profile->first[profile->count] = n + 1;
  }
  free(all);
  if (failed) return BRECCIA_FAILURE;
  profile->peaks = memory_zeroed((size_t)profile->count * PEAKS, sizeof(double), "profiles", error);
  profile->velocity = memory_zeroed((size_t)profile->count * 3, sizeof(double), "profiles", error);
  return profile->peaks && profile->velocity ? BRECCIA_OK : BRECCIA_FAILURE;
}

static int resolve(Profile *profile, const Body *body, const DeckReader *reader, const SectionList *selections)
{
  profile->axis = profile->spec->along;
  if (profile->axis >= body->dimensions)
    return node_error(reader->document, section_node(profile->spec, "along"), reader->error,
                      "along: the body does not reach along %s; take %s", axes[profile->spec->along],
                      body->dimensions == 1 ? "x" : "x or y");
  const int status = selection_create(&profile->selection, body, reader, selections, &profile->spec->of);
  return status ? status : find_layers(profile, body, reader->error);
}

int profiles_create(Profiles **out, const Domain *domain, const DeckReader *reader, const SectionList *specs,
                    const SectionList *selections)
{
  Profiles *profiles = *out = memory_plain(1, sizeof *profiles);
  if (!profiles || !(profiles->items = memory_plain((size_t)specs->count + 1, sizeof(Profile))))
    return error_add(reader->error, BRECCIA_FAILURE, "out of memory: profiles");
  int status = BRECCIA_OK;
  profiles->dimensions = domain->body.dimensions;
  for (int k = 0; k < specs->count; ++k) {
    Profile *profile = &profiles->items[profiles->count++];
    profile->spec = specs->items[k];
    const int bad = resolve(profile, &domain->body, reader, selections);
    if (bad) status = bad;
  }
  return status;
}

void profiles_destroy(Profiles **out)
{
  if (!out || !*out) return;
  for (int k = 0; k < (*out)->count; ++k) {
    Profile *profile = &(*out)->items[k];
    selection_destroy(&profile->selection);
    free(profile->first);
    free(profile->at);
    free(profile->peaks);
    free(profile->velocity);
  }
  free((*out)->items);
  free(*out);
  *out = NULL;
}

int profiles_count(const Profiles *profiles)
{
  return profiles->count;
}

static void add_row(StateList *list, const char *name, const char *part, const char *dimension, double *values,
                    int count)
{
  state_add(
      list,
      &(StateRow){.unit = dimension, .kind = STATE_NUMBERS, .role = STATE_COMMITTED, .count = count, .values = values},
      name, part);
}

void profiles_state(Profiles *profiles, StateList *list)
{
  for (int k = 0; k < profiles->count; ++k) {
    Profile *profile = &profiles->items[k];
    char name[48];
    snprintf(name, sizeof name, "profile %d: largest", k + 1);
    for (int c = 0; c < PEAKS; ++c)
      add_row(list, name, columns[c].name, columns[c].dimension, profile->peaks + c * profile->count, profile->count);
    snprintf(name, sizeof name, "profile %d: last velocity", k + 1);
    add_row(list, name, NULL, "velocity", profile->velocity, 3 * profile->count);
    snprintf(name, sizeof name, "profile %d: time", k + 1);
    state_add_number(list, name, "time", STATE_COMMITTED, &profile->time);
    snprintf(name, sizeof name, "profile %d: looks", k + 1);
    state_add_count(list, name, STATE_COMMITTED, &profile->looks);
  }
}

/* ---- looking ---- */

/** Means of a layer: displacements and velocities, and shear on planes across the axis. */
static void look_at_layer(const Profile *profile, int layer, const Domain *d, double now[PEAKS])
{
  static const int shear[3][2] = {{XY, ZX}, {XY, YZ}, {YZ, ZX}}; /* along the two other axes */
  const Particles *p = d->particles;
  double across[2][2] = {{0}}; /* of strain, of stress */
  for (int c = 0; c < PEAKS; ++c) now[c] = 0;
  for (int64_t n = profile->first[layer]; n < profile->first[layer + 1]; ++n) {
    const int32_t i = profile->selection.places[n];
    double look[2][6];
    domain_look(d, i, look[0], look[1]);
    for (int k = 0; k < 3; ++k) {
      now[MOVED + k] += p->displacement.row[k][i] - (p->zero[k] ? p->zero[k][i] : 0);
      now[SPEED + k] += p->velocity.row[k][i];
    }
    for (int of = 0; of < 2; ++of)
      for (int k = 0; k < 2; ++k) across[of][k] += look[of][shear[profile->axis][k]];
  }
  for (int of = 0; of < 2; ++of) now[STRAIN + of] = hypot(across[of][0], across[of][1]);
  const double count = (double)(profile->first[layer + 1] - profile->first[layer]);
  for (int c = 0; c < PEAKS; ++c) now[c] /= count;
}

static void note(Profile *profile, const Domain *d, double time)
{
  const double passed = time - profile->time;
  for (int layer = 0; layer < profile->count; ++layer) {
    double now[PEAKS];
    look_at_layer(profile, layer, d, now);
    for (int k = 0; k < 3; ++k) {
      double *before = &profile->velocity[k * profile->count + layer];
      if (profile->looks && passed > 0) now[SHAKEN + k] = (now[SPEED + k] - *before) / passed;
      *before = now[SPEED + k];
    }
    for (int c = 0; c < PEAKS; ++c) {
      double *most = &profile->peaks[c * profile->count + layer];
      *most = fmax(*most, fabs(now[c]));
    }
  }
  profile->time = time;
  ++profile->looks;
}

void profiles_note(Profiles *profiles, const Solver *solver)
{
  for (int k = 0; k < profiles->count; ++k)
    if (watch_is_due(profiles->items[k].spec->every, solver, solver->clock.step))
      note(&profiles->items[k], solver->domain, solver->clock.time);
}

/* ---- telling ---- */

/** Of a body in the plane or on a line nothing is said along axes that it does not have. */
static bool is_told(const Profiles *profiles, int column)
{
  return column >= STRAIN ? profiles->dimensions > 1 : column % 3 < profiles->dimensions;
}

static void add_heading(const Profiles *profiles, const Profile *profile, const Units *units, Text *text)
{
  char unit[64];
  units_name(units, dimension_find("length"), unit, sizeof unit);
  text_add(text, "%s (%s)", axes[profile->spec->along], unit);
  for (int c = 0; c < PEAKS; ++c) {
    if (!is_told(profiles, c)) continue;
    units_name(units, dimension_find(columns[c].dimension), unit, sizeof unit);
    text_add(text, *unit ? ",%s (%s)" : ",%s", columns[c].name, unit);
  }
  text_add(text, "\n");
}

static int write_one(const Profiles *profiles, const Profile *profile, const char *path, const Units *units,
                     Error *error)
{
  Text text = {0};
  add_heading(profiles, profile, units, &text);
  for (int layer = 0; layer < profile->count; ++layer) {
    text_add(&text, "%.10g", profile->at[layer]);
    for (int c = 0; c < PEAKS; ++c)
      if (is_told(profiles, c)) text_add(&text, ",%.17g", profile->peaks[c * profile->count + layer]);
    text_add(&text, "\n");
  }
  const int status = whole_file_write(path, &text, error);
  text_free(&text);
  return status;
}

int profiles_write(const Profiles *profiles, const char *folder, const Units *units, Text *files, Error *error)
{
  char *inside = profiles->count ? text_format("%s/profiles", folder) : NULL;
  int status = inside ? folder_make_inside(inside, error) : BRECCIA_OK;
  for (int k = 0; k < profiles->count && !status; ++k) {
    char name[160];
    text_file_name(profiles->items[k].spec->head.name, name, sizeof name);
    char *path = inside ? text_format("%s/%s.csv", inside, name) : NULL;
    status = path ? write_one(profiles, &profiles->items[k], path, units, error)
                  : error_add(error, BRECCIA_FAILURE, "out of memory: profiles");
    if (!status) text_add(files, "  %s\n", path);
    free(path);
  }
  free(inside);
  return status;
}

/** One picture: the columns of a kind along the axes that the body has. */
static int draw_kind(const Profiles *profiles, const Profile *profile, int first, const char *path, const Units *units,
                     bool *no_gnuplot, Error *error)
{
  PlotLine lines[3];
  char words[64], unit[64], along[64];
  int count = 0;
  for (int c = first; c < first + (first < STRAIN ? 3 : 1); ++c)
    if (is_told(profiles, c))
      lines[count++] = (PlotLine){.title = columns[c].name,
                                  .x = profile->peaks + c * profile->count,
                                  .y = profile->at,
                                  .count = profile->count,
                                  .colour = c - first};
  snprintf(words, sizeof words, "largest %.*s", (int)strlen(columns[first].name) - (first < STRAIN ? 2 : 0),
           columns[first].name);
  units_name(units, dimension_find(columns[first].dimension), unit, sizeof unit);
  units_name(units, dimension_find("length"), along, sizeof along);
  const PlotOptions options = {.title = profile->spec->head.name,
                               .x = {.words = words, .unit = unit},
                               .y = {.words = axes[profile->spec->along], .unit = along},
                               .low = NAN,
                               .high = NAN,
                               .no_gnuplot = no_gnuplot};
  return plot_draw(lines, count, &options, path, error);
}

int profiles_draw(const Profiles *profiles, int k, const char *folder, const Units *units, Text *files,
                  bool *no_gnuplot, Error *error)
{
  static const struct {
    int first;
    const char *name;
  } kinds[] = {{MOVED, "displacement"},
               {SPEED, "velocity"},
               {SHAKEN, "acceleration"},
               {STRAIN, "shear-strain"},
               {STRESS, "shear-stress"}};
  const Profile *profile = &profiles->items[k];
  int status = BRECCIA_OK;
  for (size_t n = 0; n < sizeof kinds / sizeof *kinds && !status; ++n) {
    if (!is_told(profiles, kinds[n].first)) continue;
    char name[160];
    text_file_name(profile->spec->head.name, name, sizeof name);
    char *path = text_format("%s/%s-%s.png", folder, name, kinds[n].name);
    status = path ? draw_kind(profiles, profile, kinds[n].first, path, units, no_gnuplot, error)
                  : error_add(error, BRECCIA_FAILURE, "out of memory: profiles");
    if (!status) text_add(files, "  %s\n", path);
    free(path);
  }
  return status;
}
