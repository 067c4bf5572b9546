#include "model/model.h"

#include "base/cores.h"
#include "base/memory.h"
#include "base/trap.h"
#include "deck/resolve.h"
#include "domain/tensor_copy.h"
#include "loading/support.h"
#include "model/plausibility.h"
#include "model/plausibility_parts.h"
#include "model/sized.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int model_enter(breccia_model *model, Entry *entry, Error *error)
{
  if (team_is_foreign(model->team))
    return error_add(error, BRECCIA_USER_ERROR,
                     "the model was made by another process, whose threads a fork does not copy; load it again in this "
                     "one, or with one thread before the fork");
  if (team_threads(model->team) != model->threads) {
    team_destroy(&model->team);
    if (!(model->team = team_create(model->threads, error))) return BRECCIA_FAILURE;
  }
  entry->host = host_enter();
  entry->team = team_use(model->team);
  return BRECCIA_OK;
}

int model_leave(const Entry *entry, int status, Error *error)
{
  team_use(entry->team);
  return host_leave(&entry->host, status, error);
}

/* ---- loading ---- */

/** The deck as it will be run, and its text for everybody who asks later what that was. */
static int open_deck(breccia_model *model, const DeckText *words, Error *error)
{
  const int status = deck_open(words, &deck_section, &model->laws, &model->document, &model->units, error);
  model->reader = (DeckReader){.document = model->document,
                               .whole = &deck_section,
                               .units = model->units,
                               .context = &model->laws,
                               .error = error,
                               .files = &model->files};
  if (!status) deck_write(model->document, &model->deck);
  return status;
}

static void warn_of_late_picture(breccia_model *model, const PictureSpec *picture, double time)
{
  const double end = model->solver.clock.end_time;
  if (time <= end * (1 + 1e-9)) return;
  const Node *node = section_node(picture, "at");
  char words[WHERE_SIZE];
  node_where(model->document, node, words, sizeof words);
  text_add_warning(&model->warnings, "%s: the run ends at %g, before the picture at %g, which is not made", words, end,
                   time);
}

/** Refuses bodies in which nothing holds particles together. Those that springs hold may be masses on springs. */
static int check_bonds(breccia_model *model, Error *error)
{
  const Domain *d = &model->domain;
  const BlockSpec *block = d->body.blocks[0];
  const PeridynamicsSpec *keys = model->spec->peridynamics;
  const Node *node =
      keys && node_get(keys->head.node, "horizon") ? node_get(keys->head.node, "horizon") : block->head.node;
  if (d->family.bonds || loading_eigenvalue(&model->loading, d->particles) > 0) return BRECCIA_OK;
  char length[32];
  units_name(model->units, dimension_find("length"), length, sizeof length);
  return node_error(
      model->document, node, error,
      "horizon: no bond joins any of the %lld particle%s within %g %s; choose a longer horizon, or a finer "
      "spacing",
      (long long)d->particles->count, d->particles->count == 1 ? "" : "s", d->family.horizon, length);
}

/** True for a file of `breccia material`: one material, a test or stages, no body. */
static bool looks_like_test(const Node *root)
{
  return node_get(root, "material") && (node_get(root, "test") || node_get(root, "stages")) && !node_get(root, "body");
}

/** Marks particles that are moved or held. Images beyond planes of symmetry and periodic faces are none of them: there the body goes on, and breaks as
 *  inside. */
static void mark_grips(const breccia_model *model, uint8_t *marked)
{
  const Body *body = &model->domain.body;
  loading_mark_held(&model->loading, marked);
  for (int64_t n = 0; n < body->particles.count; ++n) {
    bool goes_on = body_outside(body, n);
    for (int64_t m = n; body_outside(body, m); m = body->image_of[m]) {
      const Margin *margin = &body->margins.items[body->margin_of[m]];
      goes_on &= margin->repeats || support_slides(margin);
    }
    if (goes_on) marked[body->particles.place_of[n]] = 0;
  }
}

/** Where no bond breaks, by one item of the deck. @param[out] marked  [places] room, zeros */
static int keep_within(breccia_model *model, const NoFailureSpec *spec, uint8_t *marked, Error *error)
{
  Domain *d = &model->domain;
  Selection selection = {0};
  int status = BRECCIA_OK;
  if (spec->of.node)
    status = selection_create(&selection, &d->body, &model->reader, &model->spec->selections, &spec->of);
  else
    mark_grips(model, marked);
  for (int64_t n = 0; n < selection.count; ++n) marked[selection.places[n]] = 1;
  selection_destroy(&selection);
  const double unit = spec->distance.in_spacings ? d->body.largest_spacing : 1;
  return status ? status : domain_keep_within(d, marked, spec->distance.value * unit, error);
}

static int keep_bonds(breccia_model *model, Error *error)
{
  const FailureSpec *failure = model->spec->failure;
  const size_t places = (size_t)model->domain.particles->places;
  if (!failure) return BRECCIA_OK;
  uint8_t *marked = memory_zeroed(places, 1, "kept bonds", error);
  int status = marked ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status && failure->near_grips == NEAR_GRIPS_HOLD) {
    mark_grips(model, marked);
    status = domain_hold_grips(&model->domain, marked, error);
  }
  for (int k = 0; !status && k < failure->nowhere.count; ++k) {
    memset(marked, 0, places);
    status = keep_within(model, failure->nowhere.items[k], marked, error);
  }
  free(marked);
  return status;
}

/** Layers outside the body that supports of any stage ask for. */
static int find_margins(const breccia_model *model, MarginList *margins)
{
  const DeckSpec *spec = model->spec;
  const Length horizon = peridynamics_horizon(spec->peridynamics);
  int status = support_margins(margins, &spec->loads, &spec->selections, &spec->body, &horizon, &model->reader);
  for (int k = 0; k < spec->solve.count; ++k) {
    const SolveSpec *stage = spec->solve.items[k];
    const int bad = support_margins(margins, &stage->loads, &spec->selections, &spec->body, &horizon, &model->reader);
    if (bad) status = bad;
  }
  return status;
}

static void even_stress(const void *domain, const uint8_t *marked, double *const area[3])
{
  domain_even_stress(domain, marked, area);
}

/** Sets the displacements of a uniform uniaxial stress along an axis, with the strain `size` along that axis. */
static void set_even_pull(const breccia_model *model, int axis, double size, const Vector *displacement)
{
  const Domain *d = &model->domain;
  const Particles *p = d->particles;
  const bool plane_strain = peridynamics_space(model->spec->peridynamics) == SPACE_PLANE_STRAIN;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const bool bonds = domain_region(d, i)->type->fixed_poisson, solid = d->body.dimensions == 3;
    const double poisson = bonds ? 0.25 : material_poisson(&d->materials[d->material[i / SLICE]]);
    const bool wide = !solid && (bonds || plane_strain);
    const double across = wide ? poisson / (1 - poisson) : poisson;
    for (int k = 0; k < d->body.dimensions; ++k)
      displacement->row[k][i] = size * (k == axis ? 1 : -across) * p->position[k][i];
  }
}

/** Implements EvenStress.pull by an evaluation of internal forces, without additional forces. */
static int even_pull(void *context, int axis, double *force, Error *error)
{
  const double size = 1e-7;
  breccia_model *model = context;
  Domain *d = &model->domain;
  TensorCopy tensors;
  Vector displacement = {0}, internal = {0}, beside = {0};
  bool done = tensor_copy_create(&tensors, d, "faces", error) == BRECCIA_OK;
  done = done && vector_create(&displacement, &d->particles->space, "faces", error) &&
         vector_create(&internal, &d->particles->space, "faces", error) &&
         vector_create(&beside, &d->particles->space, "faces", error);
  if (done) {
    const bool elastic = domain_in_elastic_stage(d);
    domain_set_elastic_stage(d, true);
    set_even_pull(model, axis, size, &displacement);
    tensor_copy_save(&tensors, d);
    domain_evaluate(d, &(Evaluation){.displacement = &displacement, .internal = &internal});
    domain_forces_beside(d, &displacement, &beside);
    tensor_copy_restore(&tensors, d);
    domain_set_elastic_stage(d, elastic);
    domain_show_states(d, NULL);
    for (int32_t n = 0; n < d->particles->count; ++n) {
      const int32_t i = d->particles->place_of[n];
      force[i] = (internal.row[axis][i] - beside.row[axis][i]) /
                 (size * material_young(&d->materials[d->material[i / SLICE]]));
    }
  }
  vector_destroy(&beside);
  vector_destroy(&displacement);
  vector_destroy(&internal);
  tensor_copy_destroy(&tensors);
  return done ? BRECCIA_OK : BRECCIA_FAILURE;
}

static int create_loading(breccia_model *model, Error *error)
{
  const DeckSpec *spec = model->spec;
  LoadStage *stages = memory_zeroed((size_t)spec->solve.count, sizeof *stages, "stages", error);
  if (!stages) return BRECCIA_FAILURE;
  for (int k = 0; k < spec->solve.count; ++k) {
    const SolveSpec *stage = spec->solve.items[k];
    stages[k] = (LoadStage){&stage->loads, &stage->without, stage};
  }
  const LoadMaking making = {.loading = &model->loading,
                             .body = &model->domain.body,
                             .family = &model->domain.family,
                             .even_stress = {even_stress, &model->domain, even_pull, model},
                             .reader = &model->reader,
                             .selections = &spec->selections,
                             .materials = model->domain.materials,
                             .material = model->domain.material,
                             .forces = &model->domain.forces};
  const int status = loading_create(&making, &spec->loads, stages, spec->solve.count);
  free(stages);
  return status;
}

static bool has_initial_strains(const DeckSpec *spec)
{
  bool has = false;
  for (int k = 0; k < spec->loads.count; ++k) has |= load_strains_places(spec->loads.items[k]);
  for (int s = 0; s < spec->solve.count; ++s) {
    const SolveSpec *stage = spec->solve.items[s];
    for (int k = 0; k < stage->loads.count; ++k) has |= load_strains_places(stage->loads.items[k]);
  }
  return has;
}

/** Refuses strength reductions whose factor is 0 or less while they act. */
static int check_reductions(breccia_model *model)
{
  int status = BRECCIA_OK;
  for (int k = 0; !status && k < model->loading.count; ++k) {
    const Load *load = &model->loading.loads[k];
    status = domain_check_reduction(load, plausibility_time_of_load(model, load), &model->reader);
  }
  return status;
}

static int build(breccia_model *model, const breccia_options *options, Error *error)
{
  if (looks_like_test(model->document->root))
    return error_add(error, BRECCIA_USER_ERROR, "%s: is a laboratory test; 'breccia material %s' runs it",
                     model->document->name, model->document->name);
  int unknown = 0; /* names: what does not need them is checked all the same */
  model->reader.unknown = &unknown;
  DeckSpec *spec = section_read(&model->reader, model->document->root, &deck_section);
  model->reader.unknown = NULL;
  if (!spec || error_count(error) > unknown) return BRECCIA_USER_ERROR;
  model->spec = spec;
  if (!spec->peridynamics)
    spec->peridynamics = section_standard(&model->reader, &peridynamics_section, spec->head.node);
  if (!spec->peridynamics) return BRECCIA_FAILURE;
  MarginList margins = {0};
  int bad, status = find_margins(model, &margins);
  DomainSpec parts = {.materials = &spec->materials,
                      .blocks = &spec->body,
                      .cracks = &spec->cracks,
                      .margins = &margins,
                      .peridynamics = spec->peridynamics,
                      .failure = spec->failure,
                      .fields = spec->fields,
                      .selections = &spec->selections,
                      .forces = spec->forces,
                      .is_strained = has_initial_strains(spec),
                      .begins_under_stress = spec->initial_stress.count > 0};
  if ((bad = domain_create(&model->domain, &model->reader, &parts))) status = bad;
  free(margins.items);
  /* What follows needs the body or the materials only: its mistakes are told together with those of the rest. */
  const bool stands = model->domain.particles && model->domain.particles->count;
  if (stands) {
    bad = create_loading(model, error);
    if (bad) status = bad;
  }
  if (model->domain.family.first) {
    bad = watches_create(&model->watches, &model->domain, &model->loading, &model->reader, &spec->watches,
                         &spec->selections);
    if (bad) status = bad;
    bad = profiles_create(&model->profiles, &model->domain, &model->reader, &spec->profiles, &spec->selections);
    if (bad) status = bad;
  }
  if (model->domain.material_count == spec->materials.count && (bad = model_check_results(model))) status = bad;
  if (!status && unknown) status = BRECCIA_USER_ERROR;
  if (!status) status = stands ? keep_bonds(model, error) : BRECCIA_USER_ERROR;
  if (!status)
    status =
        domain_begin_under(&model->domain, &model->loading, &model->reader, &spec->initial_stress, &spec->selections);
  if (!status) status = domain_take_loads(&model->domain, &model->loading, &model->reader);
  if (!status) status = check_bonds(model, error);
  if (status) return status;
  model->solver = (Solver){.domain = &model->domain,
                           .loading = &model->loading,
                           .stages = &spec->solve,
                           .selections = &spec->selections,
                           .reader = &model->reader,
                           .force = options->force,
                           .loose = options->loose,
                           .trap = options->trap};
  model->domain.may_leave_tensors = domain_can_leave_tensors(&model->domain) && !solver_linearises(&spec->solve) &&
                                    !watches_look_at_tensors(model->watches) && !profiles_count(model->profiles);
  domain_leave_tensors(&model->domain, true);
  status = solver_create(&model->solver, &model->warnings, error);
  domain_leave_tensors(&model->domain, false);
  if (!status) status = model_make_compressions(model, error);
  if (!status) status = check_reductions(model);
  if (!status) status = model_make_schedule(model, true, error);
  for (int p = 0; !status && p < spec->pictures.count; ++p) {
    const PictureSpec *picture = spec->pictures.items[p];
    for (int k = 0; k < picture->times.count; ++k) warn_of_late_picture(model, picture, picture->times.values[k]);
  }
  if (!status) plausibility_warn(model);
  return status;
}

/** Takes over the laws of the program, whatever version of the header it was made with. */
static int take_laws(breccia_model *model, const breccia_options *options, Error *error)
{
  const int count = options->law_count;
  if (count < 0 || (count > 0 && !options->laws))
    return error_add(error, BRECCIA_USER_ERROR, "breccia_options: laws has %d items%s; expected as many laws", count,
                     options->laws ? "" : " and is NULL");
  model->own_laws = memory_zeroed((size_t)count + 1, sizeof *model->own_laws, "laws", error);
  model->own_law_list = memory_zeroed((size_t)count + 1, sizeof *model->own_law_list, "laws", error);
  if (!model->own_laws || !model->own_law_list) return BRECCIA_FAILURE;
  for (int k = 0; k < count; ++k) {
    breccia_law *law = &model->own_laws[k];
    if (host_lacks(options->laws[k], "breccia_options", "one of the laws", error)) return BRECCIA_USER_ERROR;
    if (sized_take(law, sizeof *law, options->laws[k], "breccia_law", error)) return BRECCIA_USER_ERROR;
    if (law_refuse(law, error)) return BRECCIA_USER_ERROR;
    if (law_find(&(LawList){model->own_law_list, k}, law->name))
      return error_add(error, BRECCIA_USER_ERROR, "law '%s': there is a law of this name already; choose another name",
                       law->name);
    model->own_law_list[k] = law;
  }
  model->laws = (LawList){model->own_law_list, count};
  return BRECCIA_OK;
}

static int load(breccia_model *model, const char *deck, const char *name, const breccia_options *options, Error *error)
{
  Text ignored = {0};
  Entry entry;
  model->threads = options->threads > 0 ? options->threads : threads_by_default(&ignored);
  int status = take_laws(model, options, error);
  if (host_lacks_items(options->settings, options->setting_count, "breccia_options", "settings", error))
    status = BRECCIA_USER_ERROR;
  if (options->threads < 0)
    status = error_add(error, BRECCIA_USER_ERROR, "breccia_options: threads is %d; expected 0, or a number of threads",
                       options->threads);
  if (options->threads > threads_most())
    status = error_add(error, BRECCIA_USER_ERROR,
                       "threads: %d would only wait for each other, as this process may use %d core%s; expected %d at "
                       "most: ask for one a core, or for none",
                       options->threads, cores_available(), cores_available() == 1 ? "" : "s", threads_most());
  if (options->trap && !trap_is_possible())
    status = error_add(error, BRECCIA_USER_ERROR,
                       "floating-point traps: there are none here; expected Linux on x86-64 with the GNU C library");
  if (!status && !(status = model_enter(model, &entry, error))) {
    model->interrupted = options->interrupted;
    model->settings = options->settings;
    model->setting_count = options->setting_count;
    const DeckText words = {deck, name, options->settings, options->setting_count};
    status = open_deck(model, &words, error);
    if (!status) status = build(model, options, error);
    if (!status && error_count(error)) status = BRECCIA_USER_ERROR;
    if (ignored.length) text_add(&model->warnings, "%s%s", model->warnings.length ? "\n" : "", ignored.characters);
    status = model_leave(&entry, status, error);
  }
  text_free(&ignored);
  return status;
}

int breccia_model_load_string(const char *deck, const char *name, const breccia_options *given_options,
                              breccia_model **out, breccia_error *given)
{
  if (host_lacks(deck, __func__, "deck", given) || host_lacks(out, __func__, "the result", given))
    return BRECCIA_USER_ERROR;
  breccia_options options;
  Error *error = given ? given : breccia_error_create();
  breccia_model *model = memory_plain(1, sizeof *model);
  if (model) model->peaks = (Peaks){.mean_low = INFINITY, .mean_high = -INFINITY};
  int status = sized_take(&options, sizeof options, given_options, "breccia_options", error);
  if (!status && (!model || !error)) status = error_add(error, BRECCIA_FAILURE, "out of memory: model");
  if (!status) status = load(model, deck, name, &options, error);
  if (status)
    breccia_model_destroy(&model);
  else
    model->reader.error = NULL;
  if (!given) breccia_error_destroy(&error);
  *out = model;
  return status;
}

int breccia_model_load_file(const char *path, const breccia_options *options, breccia_model **model,
                            breccia_error *error)
{
  if (host_lacks(path, __func__, "path", error) || host_lacks(model, __func__, "model", error))
    return BRECCIA_USER_ERROR;
  *model = NULL;
  size_t length;
  const Host host = host_enter();
  char *text = document_text(path, &length, error);
  if (!text) return host_leave(&host, BRECCIA_USER_ERROR, error);
  host_leave(&host, BRECCIA_OK, NULL);
  int status = breccia_model_load_string(text, path, options, model, error);
  free(text);
  return status;
}

void breccia_model_destroy(breccia_model **out)
{
  if (!out || !*out) return;
  breccia_model *model = *out;
  watches_destroy(&model->watches);
  profiles_destroy(&model->profiles);
  solver_destroy(&model->solver);
  loading_destroy(&model->loading);
  domain_destroy(&model->domain);
  team_destroy(&model->team);
  units_destroy(&model->units);
  document_destroy(&model->document);
  text_free(&model->warnings);
  text_free(&model->overview);
  text_free(&model->plausibility);
  text_free(&model->outcome);
  text_free(&model->stage);
  vector_destroy(&model->left_displacement);
  vector_destroy(&model->left_velocity);
  free(model->compressions.stress);
  free(model->compressions.at);
  text_free(&model->thin_layers);
  free(model->schedule);
  free(model->stops);
  free(model->own_laws);
  free(model->own_law_list);
  text_free(&model->deck);
  text_free(&model->files);
  free(model);
  *out = NULL;
}

/* ---- stepping ---- */

int model_begin(breccia_model *model, Error *error)
{
  if (model->begun) return BRECCIA_OK;
  int status = domain_begin_points(&model->domain, error);
  if (!status) status = solver_begin(&model->solver, error);
  model->begun = !status;
  return status;
}

int model_advance(breccia_model *model, Error *error)
{
  int status = BRECCIA_OK;
  while (!status && model->solver.clock.ended && !solver_is_done(&model->solver)) {
    model->states_before += model->schedule_count;
    status = solver_next_stage(&model->solver, &model->warnings, error);
    if (!status) status = model_make_schedule(model, true, error);
  }
  if (status || solver_is_done(&model->solver)) return status;
  return solver_advance(&model->solver, &model->warnings, error);
}

int model_take_motion(breccia_model *model, Error *error)
{
  if (!model->motion_is_left) return BRECCIA_OK;
  model->motion_is_left = false;
  return solver_take_motion(&model->solver, &model->left_displacement, &model->left_velocity, error);
}

/** Keeps the motion as it is left to the program. */
static int model_leave_motion(breccia_model *model, Error *error)
{
  static const char label[] = "motion of a program";
  const Particles *p = model->domain.particles;
  Vector *u = &model->left_displacement, *v = &model->left_velocity;
  if (!vector_exists(u) && !vector_create(u, &p->space, label, error)) return BRECCIA_FAILURE;
  if (!vector_exists(v) && !vector_create(v, &p->space, label, error)) return BRECCIA_FAILURE;
  vector_copy(u, &p->displacement);
  vector_copy(v, &p->velocity);
  model->motion_is_left = true;
  return BRECCIA_OK;
}

static bool model_is_interrupted(const breccia_model *model)
{
  return model->interrupted && __atomic_load_n(model->interrupted, __ATOMIC_RELAXED);
}

int breccia_model_step(breccia_model *model, int64_t steps, breccia_error *error)
{
  if (host_lacks(model, __func__, "model", error)) return BRECCIA_USER_ERROR;
  Entry entry;
  int status = model_enter(model, &entry, error);
  if (status) return status;
  status = model_begin(model, error);
  domain_leave_tensors(&model->domain, steps > 1);
  if (!status) status = model_take_motion(model, error);
  model->solver.interrupted = model->interrupted;
  for (int64_t k = 0; !status && k < steps && !solver_is_done(&model->solver); ++k)
    status = model_is_interrupted(model) ? BRECCIA_INTERRUPTED : model_advance(model, error);
  model->solver.interrupted = NULL;
  domain_leave_tensors(&model->domain, false);
  if (model->domain.tensors_are_old && domain_observe(&model->domain, error) && !status) status = BRECCIA_FAILURE;
  domain_put_stresses_back(&model->domain);
  if (model_leave_motion(model, error) && !status) status = BRECCIA_FAILURE;
  return model_leave(&entry, status, error);
}

/* ---- looking ---- */

int64_t breccia_model_particles(const breccia_model *model)
{
  if (!model) return 0;
  return model->domain.particles->count;
}
int64_t breccia_model_bonds(const breccia_model *model)
{
  if (!model) return 0;
  return model->domain.family.bonds;
}
int64_t breccia_model_broken_bonds(const breccia_model *model)
{
  if (!model) return 0;
  return model->domain.broken_count;
}
int64_t breccia_model_steps_done(const breccia_model *model)
{
  if (!model) return 0;
  return model->solver.clock.step;
}
const char *breccia_model_stage(breccia_model *model)
{
  if (!model) return "";
  const Clock *clock = &model->solver.clock;
  char name[64];
  text_free(&model->stage);
  if (clock->stages > 1)
    text_add(&model->stage, "stage %lld of %lld, %s", (long long)clock->stage + 1, (long long)clock->stages,
             solver_stage_name(&model->solver, clock->stage, name, sizeof name));
  return text_words(&model->stage);
}
double breccia_model_time(const breccia_model *model)
{
  if (!model) return NAN;
  return model->solver.clock.time;
}
double breccia_model_time_step(const breccia_model *model)
{
  if (!model) return NAN;
  return model->solver.clock.time_step;
}
double breccia_model_stable_time_step(const breccia_model *model)
{
  if (!model) return NAN;
  return model->solver.clock.stable;
}
int64_t breccia_model_places(const breccia_model *model)
{
  if (!model) return 0;
  return model->domain.particles->places;
}
const int32_t *breccia_model_numbers(const breccia_model *model)
{
  if (!model) return NULL;
  return model->domain.particles->number;
}

const char *breccia_model_plausibility(breccia_model *model)
{
  if (!model) return NULL;
  const Host host = host_enter();
  text_free(&model->plausibility);
  plausibility_describe(model, true, &model->plausibility);
  return host_leave(&host, BRECCIA_OK, NULL) ? NULL : text_words(&model->plausibility);
}

const char *breccia_model_deck(const breccia_model *model)
{
  if (!model) return "";
  return text_words(&model->deck);
}

const char *breccia_model_warnings(breccia_model *model)
{
  if (!model) return "";
  return text_words(&model->warnings);
}

const char *breccia_model_outcome(breccia_model *model)
{
  if (!model) return "";
  return text_words(&model->outcome);
}
