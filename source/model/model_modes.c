/* How a body vibrates, in words, files and pictures. */
#include "base/folder.h"
#include "base/folder_lock.h"
#include "base/memory.h"
#include "base/whole_file.h"
#include "model/host.h"
#include "model/run.h"
#include "model/sized.h"
#include "results/result_view.h"
#include "solver/modes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char axes[] = "xyz";

/** Hertz of a frequency in the deck's units. */
static double hertz(const breccia_model *model, double frequency)
{
  return units_in_si(model->units, dimension_find("frequency"), frequency);
}

static void tell_table(const breccia_model *model, const Modes *modes, Text *t)
{
  text_add(t, "mode   frequency      period   of the mass, along");
  for (int k = 0; k < model->domain.body.dimensions; ++k) text_add(t, "%s %c", k ? "    " : "", axes[k]);
  text_add(t, "\n");
  for (int n = 0; n < modes->count; ++n) {
    const Mode *mode = &modes->modes[n];
    Text frequency = {0}, period = {0};
    if (mode->frequency > 0) {
      quantity_describe(hertz(model, mode->frequency), "Hz", &frequency);
      quantity_describe(1 / hertz(model, mode->frequency), "s", &period);
    }
    text_add(t, "%4d %11s %11s                 ", n + 1, mode->frequency > 0 ? text_words(&frequency) : "0",
             mode->frequency > 0 ? text_words(&period) : "-");
    for (int k = 0; k < model->domain.body.dimensions; ++k)
      text_add(t, "%s%3.0f %%", k ? " " : "", 100 * mode->share[k]);
    text_add(t, "\n");
    text_free(&frequency);
    text_free(&period);
  }
}

/** What follows for runs of the body. */
static void tell_advice(const breccia_model *model, const Modes *modes, Text *t)
{
  if (modes->rigid)
    text_add(t, "%d of them: %s the body against moving as a whole\n", modes->rigid,
             loading_eigenvalue(&model->loading, model->domain.particles) > 0
                 ? "only springs too soft to show beside roundings hold"
                 : "nothing holds");
  if (modes->rigid == modes->count) return;
  const double first = hertz(model, modes->modes[modes->rigid].frequency),
               last = hertz(model, modes->modes[modes->count - 1].frequency);
  text_add(t, "loads that are to leave the body at rest: over 5 to 10 of its first periods, ");
  quantity_describe(5 / first, "s", t);
  text_add(t, " to ");
  quantity_describe(10 / first, "s", t);
  text_add(t, "%s\nto come to rest soonest by 'explicit': damping: {ratio: 1, at: %.4g Hz}\n",
           modes->rigid ? "" : ", or by 'static'", first);
  if (last > first)
    text_add(t, "5 %% of critical damping by 'implicit': Rayleigh damping: {ratio: 0.05, from: %.4g Hz, to: %.4g Hz}\n",
             first, last);
  text_add(t, "steps of 'implicit' that follow all of these: ");
  quantity_describe(1 / (20 * last), "s", t);
}

static int write_table(const breccia_model *model, const char *folder, const Modes *modes, Text *files, Error *error)
{
  Text t = {0};
  char *path = text_format("%s/modes.csv", folder);
  text_add(&t, "mode,frequency (Hz),mass share x,mass share y,mass share z\n");
  for (int n = 0; n < modes->count; ++n) {
    const Mode *mode = &modes->modes[n];
    text_add(&t, "%d,%.17g,%.17g,%.17g,%.17g\n", n + 1, hertz(model, mode->frequency), mode->share[0], mode->share[1],
             mode->share[2]);
  }
  const int status =
      path ? whole_file_write(path, &t, error) : error_add(error, BRECCIA_FAILURE, "out of memory: modes");
  if (!status) text_add(files, "\n  %s", path);
  text_free(&t);
  free(path);
  return status;
}

/** Modes as displacements, the largest a tenth of the body; the time of each is its number. */
static int write_states(breccia_model *model, const char *folder, const Modes *modes, Text *files, Error *error)
{
  static const char *const fields[] = {"displacement"};
  Domain *d = &model->domain;
  ResultFile *file = NULL;
  double low[3], high[3], size = d->body.largest_spacing, *held[3];
  particles_bounds(d->particles, low, high);
  for (int k = 0; k < 3; ++k) size = fmax(size, high[k] - low[k]);
  double *frequencies = memory_zeroed((size_t)modes->count, sizeof(double), "modes", error);
  if (!frequencies) return BRECCIA_FAILURE;
  for (int n = 0; n < modes->count; ++n) frequencies[n] = hertz(model, modes->modes[n].frequency);
  const ResultNames names = {.fields = fields, .count = 1, .frequencies = frequencies, .frequency_count = modes->count};
  int status = result_file_create(&file, folder, d, model->units, model->spec->title, &names, error);
  free(frequencies);
  for (int n = 0; n < modes->count && !status; ++n) {
    for (int k = 0; k < 3; ++k) {
      double *shape = modes->modes[n].displacement.row[k];
      for (int64_t i = 0; i < d->particles->places; ++i) shape[i] *= 0.1 * size;
      held[k] = d->particles->displacement.row[k];
      d->particles->displacement.row[k] = shape;
    }
    status = result_file_write(file, d, &(ResultMoment){.step = n + 1, .time = n + 1}, error);
    for (int k = 0; k < 3; ++k) d->particles->displacement.row[k] = held[k];
  }
  if (!status) status = result_file_show(file, error);
  result_file_destroy(&file);
  if (!status)
    text_add(files,
             "\n  %s/results.vtkhdf (and results.xdmf for older ParaView); displacements at most a tenth of the body",
             folder);
  return status;
}

static int draw(const char *folder, const Modes *modes, Text *files, Error *error)
{
  int status = BRECCIA_OK;
  char *pictures = text_format("%s/pictures", folder);
  if (!pictures || folder_make_inside(pictures, error)) status = BRECCIA_FAILURE;
  for (int n = 0; n < modes->count && !status; ++n) {
    char *path = text_format("%s/mode-%d.png", pictures, n + 1);
    breccia_plot plot;
    breccia_plot_begin(&plot, sizeof plot);
    plot.field = "displacement";
    plot.state = BRECCIA_STATE_OF_STEP;
    plot.step = n + 1;
    plot.path = path;
    status = path ? breccia_plot_field(folder, &plot, error) : BRECCIA_FAILURE;
    if (!status) text_add(files, "\n  %s", path);
    free(path);
  }
  free(pictures);
  return status;
}

/** A result file that is not of modes, or cannot be read, is a run's: it is left as it is. */
static int look_for_run(const char *folder, Error *error)
{
  char *path = text_format("%s/results.vtkhdf", folder);
  if (!path) return error_add(error, BRECCIA_FAILURE, "out of memory: modes");
  bool of_run = false;
  if (!access(path, F_OK)) {
    ResultView view;
    Error *ignored = breccia_error_create();
    of_run = result_view_open(&view, path, ignored) || !view.frequencies;
    result_view_close(&view);
    breccia_error_destroy(&ignored);
  }
  free(path);
  if (!of_run) return BRECCIA_OK;
  return error_add(error, BRECCIA_USER_ERROR,
                   "%s: holds the results of a run, which modes would write over; give them a folder of their own",
                   folder);
}

static int write_all(breccia_model *model, const char *folder, const Modes *modes, Error *error)
{
  Text files = {0};
  int status = write_table(model, folder, modes, &files, error);
  if (!status) status = write_states(model, folder, modes, &files, error);
  if (!status) status = draw(folder, modes, &files, error);
  if (!status) text_add(&model->outcome, "\nwritten:%s", text_words(&files));
  text_free(&files);
  return status;
}

int breccia_model_modes(breccia_model *model, const breccia_modes *given, breccia_error *error)
{
  if (host_lacks(model, __func__, "model", error)) return BRECCIA_USER_ERROR;
  Entry entry;
  breccia_modes wish;
  Modes modes = {0};
  FolderLock lock = {.descriptor = -1};
  int status = model_enter(model, &entry, error);
  if (status) return status;
  text_free(&model->outcome);
  status = sized_take(&wish, sizeof wish, given, "breccia_modes", error);
  if (!status && wish.count < 1)
    status = error_add(error, BRECCIA_USER_ERROR, "modes: %d are asked for; ask for one or more", wish.count);
  if (!status && wish.folder) {
    status = folder_make(wish.folder, error);
    if (!status) status = folder_lock_take(&lock, wish.folder, error);
    if (!status) status = look_for_run(wish.folder, error);
  }
  if (!status) status = modes_find(&model->domain, &model->loading, wish.count, &modes, error);
  if (!status) {
    tell_table(model, &modes, &model->outcome);
    tell_advice(model, &modes, &model->outcome);
  }
  if (!status && wish.folder) status = write_all(model, wish.folder, &modes, error);
  folder_lock_return(&lock);
  modes_destroy(&modes);
  return model_leave(&entry, status, error);
}
