/* A whole run with its files: results, histories, checkpoints; then pictures and summary. */
#include "model/run.h"

#include "base/clock.h"
#include "base/file_bytes.h"
#include "base/folder.h"
#include "base/folder_lock.h"
#include "base/memory.h"
#include "base/regular_file.h"
#include "base/tensor.h"
#include "base/whole_file.h"
#include "model/host.h"
#include "model/sized.h"
#include "results/bar_lines.h"
#include "results/checkpoint.h"
#include "results/journal.h"
#include "results/result_view.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- pieces ---- */

static void update_peaks(breccia_model *model)
{
  const Domain *d = &model->domain;
  Peaks *peaks = &model->peaks;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    if (body_outside(&d->body, n)) continue; /* those at the edge of the layers outside a support have poor families */
    int32_t place = d->particles->place_of[n];
    double u = 0, v = 0, s[6];
    for (int k = 0; k < 3; ++k) {
      u += pow(particles_moved(d->particles, k, place), 2);
      v += pow(d->particles->velocity.row[k][place], 2);
    }
    for (int k = 0; k < 6; ++k) s[k] = d->stress[k][place];
    peaks->displacement = fmax(peaks->displacement, sqrt(u));
    peaks->velocity = fmax(peaks->velocity, sqrt(v));
    peaks->octahedral = fmax(peaks->octahedral, tensor_octahedral_shear(s));
    peaks->mean_low = fmin(peaks->mean_low, (s[XX] + s[YY] + s[ZZ]) / 3);
    peaks->mean_high = fmax(peaks->mean_high, (s[XX] + s[YY] + s[ZZ]) / 3);
    peaks->damage = fmax(peaks->damage, domain_damage(d, place));
    model_note_compression(model, place, s);
  }
  run_note_strains(model);
}

static int write_results(Run *run, Error *error)
{
  breccia_model *model = run->model;
  const double start = clock_seconds();
  int status = domain_observe(&model->domain, error);
  if (!status) {
    update_peaks(model);
    const Clock *clock = &model->solver.clock;
    const ResultMoment moment = {.step = clock->step, .time = clock->time, .stage = clock->stage};
    status = result_file_write(run->results, &model->domain, &moment, error);
    domain_stop_observing(&model->domain);
  }
  run->unwritten |= status != 0;
  const double seconds = clock_seconds() - start;
  Outlook *o = &model->outlook;
  pace_note(&o->bytes, o->state_bytes, seconds);
  run->paused += seconds;
  return status;
}

/** Brings the result file to the disk: a checkpoint must not be ahead of it when the machine goes down. */
static int settle_results(const Run *run, Error *error)
{
  char *path = text_format("%s/results.vtkhdf", run->wish->folder);
  int status = BRECCIA_OK;
  if (!path || path_settle(path))
    status =
        error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path ? path : "results.vtkhdf", strerror(errno));
  free(path);
  return status;
}

static CheckpointOf what_it_is_of(const breccia_model *model)
{
  return (CheckpointOf){text_words(&model->deck), text_words(&model->files), model->domain.particles->count};
}

static int write_histories(Run *run, bool last, Error *error)
{
  const int status = watches_write(run->model->watches, &run->model->solver, last, error);
  run->unwritten |= status != 0;
  return status;
}

static int write_checkpoint(Run *run, Error *error)
{
  breccia_model *model = run->model;
  /* Where things go wrong the checkpoint before is the better one; of this very step it need not be written twice. */
  if (ledger_is_doubtful(&model->solver.ledger) || model->solver.unbegun ||
      run->checkpoint_step == model->solver.clock.step)
    return BRECCIA_OK;
  if (result_file_show(run->results, error)) { /* a restart takes them up from there */
    run->unwritten = true;
    return BRECCIA_FAILURE;
  }
  run->last_checkpoint = clock_seconds();
  if (!domain_can_save_points(&model->domain))
    return BRECCIA_OK; /* the checkpoint before, if any, is all that is left */
  if (watches_settle(model->watches, error) || settle_results(run, error) || run_log_settle(run, error)) {
    run->unwritten = true;
    return BRECCIA_FAILURE;
  }
  StateList state = {0};
  model_state(model, &state);
  const CheckpointOf of = what_it_is_of(model);
  const int status = checkpoint_write(run->wish->folder, &state, &of, error);
  run->unwritten |= status != 0;
  state_list_destroy(&state);
  if (!status) run->checkpoint_step = model->solver.clock.step;
  const double seconds = clock_seconds() - run->last_checkpoint;
  pace_note(&run->model->outlook.checkpoints, 1, seconds);
  run->paused += seconds;
  return status;
}

int run_write_file(Run *run, const char *name, const Text *words, Error *error)
{
  char *path = text_format("%s/%s", run->wish->folder, name);
  const int status = path ? whole_file_write(path, words, error)
                          : error_add(error, BRECCIA_FAILURE, "%s: cannot be written: out of memory", name);
  free(path);
  return status;
}

/** Takes away what an earlier run in this folder left to go on from, and what it told: both are of results that are written over now. */
static int forget_earlier(const Run *run, Error *error)
{
  static const char *const told[] = {"summary.json", "solution.txt"};
  int status = checkpoint_forget(run->wish->folder, error);
  for (size_t k = 0; k < sizeof told / sizeof *told; ++k) {
    char *path = text_format("%s/%s", run->wish->folder, told[k]);
    if (!path || (unlink(path) && errno != ENOENT))
      status = error_add(error, BRECCIA_FAILURE, "%s: cannot be removed: %s", path ? path : told[k], strerror(errno));
    free(path);
  }
  return status;
}

/** Refuses links, pipes and the like that have the name of a file of the run: nothing is written through them. */
static int refuse_links(const Run *run, Error *error)
{
  static const char *const names[] = {"results.vtkhdf", "results.vtkhdf.part", "results.xdmf",
                                      "deck.yaml",      "solution.txt",        "summary.json"};
  int status = BRECCIA_OK;
  for (size_t k = 0; k < sizeof names / sizeof *names && !status; ++k) {
    char *path = text_format("%s/%s", run->wish->folder, names[k]);
    const int cause = path ? regular_file_look(path) : ENOMEM;
    if (cause == ENOMEM)
      status = error_add(error, BRECCIA_FAILURE, "out of memory: %s", names[k]);
    else if (cause == ELOOP || cause == ESPIPE)
      status = error_add(error, BRECCIA_USER_ERROR, "%s: cannot be written: %s", path, regular_file_problem(cause));
    free(path);
  }
  return status ? status : watches_refuse_links(run->model->watches, run->wish->folder, error);
}

static const char deck_heading[] = "# What was run, by Breccia ";

/** Looks whether what will be written would take the place of a file of the user's: a deck, or a table that the deck reads. */
static int spare_files_of_others(const Run *run, Error *error)
{
  char *path = text_format("%s/deck.yaml", run->wish->folder), there[sizeof deck_heading] = "";
  if (!path) return error_add(error, BRECCIA_FAILURE, "out of memory: deck.yaml");
  const int file = text_open_file(path);
  const int64_t n = file < 0 ? 0 : file_read_at(file, there, sizeof there - 1, 0);
  int status = BRECCIA_OK;
  if (!status && n < 0) status = error_add(error, BRECCIA_FAILURE, "%s: cannot be read: %s", path, strerror(errno));
  if (!status && n > 0 && strncmp(there, deck_heading, sizeof there - 1) != 0)
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s: was not written by a run, and would be replaced by the deck as it is run: give it another "
                       "name, or the results a folder of their own by --output",
                       path);
  if (file >= 0) close(file);
  free(path);
  return status ? status : watches_spare(run->model->watches, run->wish->folder, text_words(&run->model->files), error);
}

/** The deck as it is run, beside its results. */
static int write_deck(Run *run, Error *error)
{
  const breccia_model *model = run->model;
  Text words = {0};
  text_add(&words, "%s%s, from ", deck_heading, BRECCIA_VERSION);
  text_add_json(&words, model->document->name);
  for (int k = 0; k < model->setting_count; ++k) {
    text_add(&words, " --set ");
    text_add_json(&words, model->settings[k]);
  }
  text_add(&words, "\n# Everything is worked out in it. Files that it names are beside the file above.\n%s",
           text_words(&model->deck));
  const int status = run_write_file(run, "deck.yaml", &words, error);
  text_free(&words);
  return status;
}

static int read_checkpoint(Run *run, Error *error)
{
  breccia_model *model = run->model;
  const CheckpointOf of = what_it_is_of(model);
  const CheckpointWhich which = run->wish->restart == BRECCIA_RESTART_BEFORE ? CHECKPOINT_BEFORE : CHECKPOINT_LAST;
  StateList state = {0};
  Checkpoint checkpoint;
  int status = checkpoint_open(&checkpoint, run->wish->folder, which, &of, error);
  const int64_t stage = status ? 0 : checkpoint_count(&checkpoint, "stage");
  if (stage > 0 && stage < model->solver.clock.stages && solver_enter(&model->solver, stage, error))
    status = BRECCIA_FAILURE;
  if (!status) {
    model_state(model, &state);
    status = checkpoint_read(&checkpoint, &state, error);
  }
  state_list_destroy(&state);
  checkpoint_close(&checkpoint);
  model->begun = !status;
  run->checkpoint_step = model->solver.clock.step;
  return status ? status : model_make_schedule(model, false, error);
}

/** The states that were written before the checkpoint must be there, the last of them perhaps in a journal. */
static int check_states(const Run *run, Error *error)
{
  const breccia_model *model = run->model;
  ResultView view;
  char *path = text_format("%s/results.vtkhdf", run->wish->folder);
  int status = path ? journal_finish(path, error) : error_add(error, BRECCIA_FAILURE, "out of memory: results");
  if (!status && access(path, F_OK))
    status = error_add(error, BRECCIA_USER_ERROR,
                       "%s: %s; the run goes on from step %lld and needs the states up to there: put the file back, or "
                       "run without --restart, from the beginning",
                       path, strerror(errno), (long long)model->solver.clock.step);
  if (!status) status = result_view_open(&view, path, error);
  if (!status) {
    bool last = model->last_due < 0;
    int64_t there = 0;
    for (int k = 0; k < view.steps; ++k) {
      there += view.step_numbers[k] <= model->last_due;
      last |= view.step_numbers[k] == model->last_due;
    }
    status = result_view_verify(&view, path, error);
    result_view_close(&view);
    if (status) {
      free(path);
      return status;
    }
    if (!last)
      status = error_add(error, BRECCIA_USER_ERROR,
                         "%s: lacks the state of step %lld, which was written before the checkpoint of step %lld; put "
                         "the file back as it was, or run without --restart",
                         path, (long long)model->last_due, (long long)model->solver.clock.step);
    else if (there != model->states_due)
      status =
          error_add(error, BRECCIA_USER_ERROR,
                    "%s: has %lld states up to step %lld, of which %lld were written before the checkpoint of step "
                    "%lld; put the file back as it was, or run without --restart",
                    path, (long long)there, (long long)model->last_due, (long long)model->states_due,
                    (long long)model->solver.clock.step);
  }
  free(path);
  return status;
}

static int open_files(Run *run, Error *error)
{
  breccia_model *model = run->model;
  Text stages = {0};
  char stage[64];
  for (int64_t k = 0; k < model->solver.clock.stages; ++k)
    text_add(&stages, "%s%s", k ? ";" : "", solver_stage_name(&model->solver, k, stage, sizeof stage));
  const ResultNames names = {.stages = text_words(&stages),
                             .selections = &model->spec->selections,
                             .reader = &model->reader,
                             .fields = run->names.items,
                             .count = run->names.count,
                             .single = model->spec->results->precision == PRECISION_SINGLE,
                             .deck = text_words(&model->deck)};
  int status = refuse_links(run, error);
  if (!status) status = spare_files_of_others(run, error);
  if (!status && run->wish->restart) {
    status = check_states(run, error);
    if (!status) status = run_log_check(run, error);
    if (!status) status = watches_check(model->watches, run->wish->folder, model->solver.clock.step, error);
    if (!status) /* all can be gone on from: what lies behind the checkpoint is cut off now */
      status = result_file_resume(&run->results, run->wish->folder, &model->domain, model->units, model->spec->title,
                                  &names, model->last_due, error);
  } else if (!status) {
    model->next_due = 0;
    model->last_due = -1;
    model->states_due = 0;
    model->log_bytes = 0;
    status = forget_earlier(run, error);
    if (!status)
      status = result_file_create(&run->results, run->wish->folder, &model->domain, model->units, model->spec->title,
                                  &names, error);
  }
  text_free(&stages);
  if (!status) status = write_deck(run, error);
  if (!status) status = watches_open(model->watches, run->wish->folder, model->units, run->wish->restart != 0, error);
  if (!status && run->wish->restart == BRECCIA_RESTART_BEFORE)
    status = checkpoint_return_to_before(run->wish->folder, error);
  return status;
}

/** Shows all states and ends the histories. */
static int close_files(Run *run, Error *error)
{
  int status = result_file_show(run->results, error);
  if (watches_close(run->model->watches, status ? NULL : error)) status = BRECCIA_FAILURE;
  run->unwritten |= status != 0;
  return status;
}

/* ---- the loop ---- */

static void show_progress(Run *run, bool always)
{
  const Solver *s = &run->model->solver;
  double now = clock_seconds();
  if (!run->wish->progress || (!always && now - run->last_progress < 0.2)) return;
  pace_note(&run->model->outlook.steps, (double)(s->clock.step - run->told_at), now - run->last_progress - run->paused);
  run->last_progress = now;
  run->told_at = s->clock.step;
  run->paused = 0;
  const Task left = model_task(run->model, s->clock.step, run->steps, run->model->states_before + run->model->next_due);
  run->wish->progress(run->wish->context, s->clock.step, run->steps, outlook_left(&run->model->outlook, &left));
}

static int due(Run *run, Error *error)
{
  breccia_model *model = run->model;
  const Solver *s = &model->solver;
  const ResultsSpec *r = model->spec->results;
  int status = write_histories(run, false, error);
  if (!status) status = run_note_reduction(model, error);
  if (!status) run_note_softening(model);
  profiles_note(model->profiles, s);
  bool write = r->every > 0 && s->clock.step % r->every == 0;
  for (; model_has_passed(model, model->next_due, s->clock.time); ++model->next_due) write = true;
  write |= s->clock.ended && s->clock.stages > 1;
  if (write) {
    model->last_due = s->clock.step;
    ++model->states_due;
  }
  if (!status && write) status = write_results(run, error);
  const bool stage_ends = s->clock.ended && !solver_is_done(s); /* the next one may fail to begin */
  const bool by_steps = r->checkpoint_steps > 0 && s->clock.step && s->clock.step % r->checkpoint_steps == 0;
  if (!status && (stage_ends || by_steps || clock_seconds() - run->last_checkpoint > r->checkpoint_seconds))
    status = write_checkpoint(run, error);
  return status;
}

/** Steps to tell the progress by: as many as wished for, or as the run has as far as it can be foreseen. */
static int64_t steps_wanted(const Run *run)
{
  const int64_t wished = run->wish->steps, steps = run->model->solver.clock.steps;
  return wished > 0 && wished < steps ? wished : steps;
}

/** What was due at the end of the stage before has been written. */
static void begin_stage(breccia_model *model)
{
  model->next_due = 0;
  while (model->next_due < model->schedule_count && model->schedule[model->next_due] <= model->solver.clock.stage_time)
    ++model->next_due;
}

/** Steps of later stages may be unknown as yet, so that only a wish ends the run before its last stage. */
static bool goes_on(const Run *run)
{
  const Solver *s = &run->model->solver;
  return !solver_is_done(s) && (run->wish->steps <= 0 || s->clock.step < run->wish->steps);
}

static int loop(Run *run, Error *error)
{
  breccia_model *model = run->model;
  Solver *s = &model->solver;
  int status = run->wish->restart ? BRECCIA_OK : due(run, error);
  while (!status && goes_on(run)) {
    /* Where energy comes from nothing or speeds are absurd, some steps more show whether it goes on. */
    if (run->wish->interrupted && __atomic_load_n(run->wish->interrupted, __ATOMIC_RELAXED) &&
        !ledger_is_doubtful(&s->ledger))
      return BRECCIA_INTERRUPTED;
    const int64_t stage = s->clock.stage, step = s->clock.step;
    status = host_status(run->host, model_advance(model, error), error);
    if (s->clock.stage != stage) begin_stage(model);
    model->run_steps += s->clock.step - step;
    if (status == BRECCIA_INTERRUPTED) break;
    if (status) {
      run->step_failed = status == BRECCIA_FAILURE && !*domain_server_problem(&model->domain) &&
                         memory_refusals() == run->host->refusals;
      run_log_write(run, false, NULL); /* how it failed */
      break;
    }
    run->steps = steps_wanted(run);
    status = run_log_write(run, true, error);
    run->unwritten |= status != 0;
    if (!status) status = due(run, error);
    show_progress(run, false);
  }
  return status;
}

static int finish(Run *run, int status, Error *error)
{
  breccia_model *model = run->model;
  model->run_seconds = clock_seconds() - run->started;
  status = host_status(run->host, status, error);
  const bool ended_early = status != BRECCIA_OK;
  char *problem = text_format("%s", breccia_error_text(error));
  if (!status) {
    status = write_histories(run, true, error);
    /* First the checkpoint: a state written because a run stops early leaves no trace when it is taken up again. */
    if (!status) status = write_checkpoint(run, error);
    if (!status) status = write_results(run, error);
  } else if (status == BRECCIA_INTERRUPTED) {
    int bad = write_checkpoint(run, error);
    if (!bad) bad = write_results(run, error); /* so that pictures are of the state in which it was stopped */
    if (bad) status = bad;
  } else if (!run->unwritten && memory_refusals() == run->host->refusals) {
    /* The last good state. Of a step in which memory was refused nobody knows what was left out: the checkpoint before stays. */
    write_checkpoint(run, error);
    if (!ledger_has_blown_up(&model->solver.ledger)) { /* else its speeds and places mean nothing any more */
      if (!model->solver.unbegun || model->solver.clock.stage == 0) write_results(run, error);
      write_histories(run, true, error);
    }
  }
  if (close_files(run, run->unwritten ? NULL : error) && !status) status = BRECCIA_FAILURE;
  if (run_log_close(run, run->unwritten ? NULL : error) && !status) status = BRECCIA_FAILURE;
  if (status && !ended_early) {
    free(problem);
    problem = text_format("%s", breccia_error_text(error));
  }
  Text own = {0};
  text_add(&own, "  %s/deck.yaml (what was run)\n  %s/results.vtkhdf (and results.xdmf for older ParaView)\n",
           run->wish->folder, run->wish->folder);
  for (int k = 0; k < watches_count(model->watches); ++k) text_add(&own, "  %s\n", watches_path(model->watches, k));
  if (!run->unwritten && profiles_write(model->profiles, run->wish->folder, model->units, &own, error)) {
    run->unwritten = true;
    if (!status) status = BRECCIA_FAILURE;
  }
  if (!run->unwritten && bar_lines_write(&model->domain, run->wish->folder, model->units, &own, error)) {
    run->unwritten = true;
    if (!status) status = BRECCIA_FAILURE;
  }
  text_add(&own, "%s", text_words(&run->logs));
  text_free(&run->files);
  run->files = own;
  status = host_status(run->host, status, error);
  const int untold = run_write_summary(run, status, problem, run->unwritten ? NULL : error);
  if (untold && !status) status = untold;
  domain_give_way(&model->domain, true);
  const int undrawn = run->unwritten ? BRECCIA_OK : run_draw_pictures(run, error);
  domain_give_way(&model->domain, false);
  run->unwritten |= untold != BRECCIA_OK;
  run_tell_outcome(run, status);
  free(problem);
  return status ? status : undrawn;
}

static int run_whole(breccia_model *model, const breccia_run *wish, Error *error)
{
  Run run = {.model = model, .wish = wish, .checkpoint_step = -1};
  FolderLock lock = {.descriptor = -1};
  Entry entry;
  model->run_steps = 0;
  int status = model_enter(model, &entry, error);
  if (status) return status;
  run.host = &entry.host;
  model->solver.interrupted = wish->interrupted;
  domain_leave_tensors(&model->domain, true);
  status = folder_make(wish->folder, error);
  if (!status) status = folder_lock_take(&lock, wish->folder, error);
  if (!status) status = model_field_names(model, &run.names, error);
  if (!status && wish->progress) status = model_expect(model, error);
  if (!status && wish->restart) status = read_checkpoint(&run, error);
  run.steps = steps_wanted(&run); /* only now: a checkpoint may know of more */
  if (wish->restart) model->motion_is_left = false;
  if (!status) status = model_begin(model, error);
  if (!status) status = model_take_motion(model, error);
  if (!status) status = open_files(&run, error);
  status = host_status(run.host, status, error); /* headings are whole, or nothing is written below them */
  if (!status) {
    run.started = run.last_checkpoint = run.last_progress = clock_seconds();
    run.told_at = model->solver.clock.step;
    status = finish(&run, loop(&run, error), error);
  }
  model->solver.interrupted = NULL;
  domain_leave_tensors(&model->domain, false);
  result_file_destroy(&run.results);
  folder_lock_return(&lock);
  free(run.names.items);
  text_free(&run.files);
  text_free(&run.logs);
  return model_leave(&entry, status, error);
}

int breccia_model_run(breccia_model *model, const breccia_run *given_wish, breccia_error *given)
{
  if (host_lacks(model, __func__, "model", given)) return BRECCIA_USER_ERROR;
  Error *error = given ? given : breccia_error_create();
  breccia_run wish;
  int status = sized_take(&wish, sizeof wish, given_wish, "breccia_run", error);
  if (!status && !wish.folder) status = error_add(error, BRECCIA_USER_ERROR, "a run needs a folder");
  if (!status) status = run_whole(model, &wish, error);
  if (!given) breccia_error_destroy(&error);
  return status;
}
