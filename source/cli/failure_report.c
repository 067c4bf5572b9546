/* What the verb 'failure' prints and writes: a table with the measures of every run, the same as failure.csv with a
 * curve of displacement over load, and sentences on the loads between which the body fails. */
#include "failure.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** What a run came to, in a word or two. */
static const char *outcome_of(const Trial *t)
{
  if (t->verdict == BEARS) return "bears it";
  if (t->verdict == DOUBTFUL) return "no verdict";
  if (t->verdict == UNKNOWN) return "-";
  return t->reason == BY_EQUILIBRIUM ? "stopped" : t->reason == BY_RATE ? "gives way" : "fails";
}

/** Columns between the outcome and the case. */
static const struct {
  const char *heading, *column; /* of the printed table, of the file */
  int measure;                  /* -1: the rate */
  const char *unit;             /* key of `units` in summary.json; NULL: a share */
} columns[] = {
    {"displacement", "displacement", DISPLACEMENT, "positions and displacements"},
    {"rate", "rate", -1, NULL},
    {"plastic", "plastic share", PLASTIC, NULL},
    {"control", "share of control", CONTROL, NULL},
    {"unbalanced", "forces out of balance", UNBALANCED, NULL},
    {"kinetic", "kinetic energy", KINETIC, NULL},
    {"held", "time held", HELD, "times"},
};
enum { COLUMNS = sizeof columns / sizeof *columns };

static double value_of(const Trial *t, int column)
{
  return columns[column].measure < 0 ? t->rate : t->measure[columns[column].measure];
}

/** Reads a file of a case. @return NULL: it cannot be read */
static char *text_of(const Search *s, const char *name, const char *file)
{
  char *path = words_of("%s/%s/%s", s->folder, name, file), *text = NULL;
  FILE *in = path ? fopen(path, "rb") : NULL;
  long size = -1;
  if (in && !fseek(in, 0, SEEK_END) && (size = ftell(in)) >= 0 && !fseek(in, 0, SEEK_SET) &&
      (text = malloc((size_t)size + 1)))
    text[fread(text, 1, (size_t)size, in)] = 0;
  if (in) fclose(in);
  free(path);
  return text;
}

/** Finds a unit of the deck in a summary. @param[out] unit  " (m)", or "" */
static void find_unit(const char *summary, const char *key, char *unit, size_t size)
{
  char *words = key ? words_of("\"%s\": \"", key) : NULL;
  const char *found = words && summary ? strstr(summary, words) : NULL;
  *unit = 0;
  if (found) found += strlen(words);
  if (found && *found != '"') snprintf(unit, size, " (%.*s)", (int)strcspn(found, "\""), found);
  free(words);
}

void failure_print(const Search *s)
{
  printf("%16s  %-10s", "load", "outcome");
  for (int c = 0; c < COLUMNS; ++c) printf(" %12s", columns[c].heading);
  printf("  case\n");
  for (int k = 0; k < s->count; ++k) {
    const Trial *t = &s->trials[k];
    char load[96];
    snprintf(load, sizeof load, "%.9g%s", t->load, s->unit);
    printf("%16s  %-10s", load, outcome_of(t));
    for (int c = 0; c < COLUMNS; ++c) {
      const double value = value_of(t, c);
      if (isnan(value))
        printf(" %12s", "");
      else
        printf(" %12.3g", value);
    }
    printf("  %s\n", t->name);
  }
}

static void write_trials(const Search *s, FILE *out)
{
  char *summary = s->count ? text_of(s, s->trials[0].name, "summary.json") : NULL, unit[80];
  const char *load_unit = s->unit + strspn(s->unit, " ");
  fprintf(out, *load_unit ? "step,load (%s),outcome" : "step,load%s,outcome", load_unit);
  for (int c = 0; c < COLUMNS; ++c) {
    find_unit(summary, columns[c].unit, unit, sizeof unit);
    fprintf(out, ",%s%s", columns[c].column, unit);
  }
  fprintf(out, ",case\n");
  for (int k = 0; k < s->count; ++k) {
    const Trial *t = &s->trials[k];
    fprintf(out, "%d,%.9g,%s", k + 1, t->load, outcome_of(t));
    for (int c = 0; c < COLUMNS; ++c) {
      const double value = value_of(t, c);
      if (isnan(value))
        fprintf(out, ",");
      else
        fprintf(out, ",%.6g", value);
    }
    fprintf(out, ",%s\n", t->name);
  }
  free(summary);
}

/** Draws displacement over load. The table has the same numbers, so that a picture that cannot be drawn is no failure.
 */
static void draw_curve(const Search *s)
{
  breccia_plot plot;
  char *path = words_of("%s/failure.svg", s->folder);
  breccia_error *error = breccia_error_create();
  breccia_plot_begin(&plot, sizeof plot);
  plot.title = "Largest displacement over load";
  plot.x_label = s->key;
  plot.path = path;
  plot.curve = "failure.load : failure.displacement";
  if (!path || !error)
    complain("breccia failure: failure.svg: out of memory");
  else if (breccia_plot_curve(&s->folder, 1, &plot, error))
    complain("breccia failure: failure.svg: %s", breccia_error_text(error));
  else if (!s->quiet)
    printf("  %s/failure.svg\n", s->folder);
  breccia_error_destroy(&error);
  free(path);
}

int failure_write(const Search *s)
{
  char *path = words_of("%s/failure.csv", s->folder);
  FILE *file = path ? cases_open_file(path, false) : NULL;
  if (file) write_trials(s, file);
  const bool bad = !file || ferror(file);
  const int closed = file ? fclose(file) : 0;
  if (path && (bad || closed)) complain("%s: cannot be written", path);
  if (!bad && !closed) {
    if (!s->quiet) printf("\nwritten:\n  %s/failure.csv\n", s->folder);
    if (s->count > 1) draw_curve(s);
  }
  free(path);
  return bad || closed ? BRECCIA_FAILURE : BRECCIA_OK;
}

/** The first trial under a load of a size. */
static const Trial *trial_at(const Search *s, double size)
{
  for (int k = 0; k < s->count; ++k)
    if (fabs(s->trials[k].load) == size) return &s->trials[k];
  return NULL;
}

/** The first trial under a load that does not bear it. */
static const Trial *failing_at(const Search *s, double size)
{
  for (int k = 0; k < s->count; ++k)
    if (fabs(s->trials[k].load) == size && s->trials[k].verdict != BEARS) return &s->trials[k];
  return trial_at(s, size);
}

/** Prints the warnings of a run. */
static void tell_warnings(const Search *s, const Trial *t)
{
  char *text = text_of(s, t->name, "log.txt");
  for (char *line = text, *next; line && *line; line = next) {
    next = line + strcspn(line, "\n");
    if (*next) *next++ = 0;
    if (strstr(line, "warning: "))
      printf("under %.9g%s the run warns: %s\n", t->load, s->unit, strstr(line, "warning: ") + 9);
  }
  free(text);
}

/** Prints how many runs fail beside those that do not, where a body bears loads above one under which it fails. */
static void tell_order(const Search *s, double fails)
{
  const double most = 0.5; /* of the runs under a load */
  double last = 0;
  int all = 0, bad = 0;
  for (int k = 0; k < s->count; ++k)
    if (failure_share(s, s->trials[k].load) < most) last = fmax(last, fabs(s->trials[k].load));
  if (last < fails) return;
  printf("outcomes are not monotonic: it also bears");
  for (int k = 0, told = 0; k < s->count; ++k) {
    const double load = fabs(s->trials[k].load);
    if (load < fails || load > last) continue;
    ++all;
    bad += s->trials[k].verdict != BEARS;
    if ((k && s->trials[k - 1].load == s->trials[k].load) || failure_share(s, s->trials[k].load) >= most) continue;
    printf("%s %.9g%s", told++ ? "," : "", s->trials[k].load, s->unit);
  }
  const Trial *first = trial_at(s, fails), *end = trial_at(s, last);
  printf(" at or above a load under which it fails; of the %d runs from %.9g%s to %.9g%s %d fail (%.0f %%). Give the "
         "share of failures, by '--samples'%s, and not one load\n",
         all, first->load, s->unit, end->load, s->unit, bad, 100.0 * bad / all, s->seed ? "" : " or '--seed'");
}

/** Prints the share of failures under each load that has several runs. */
static void tell_shares(const Search *s)
{
  for (int k = 0; s->seeds > 1 && k < s->count; ++k)
    if (!k || s->trials[k].load != s->trials[k - 1].load)
      printf("under %.9g%s %.0f of %d runs fail\n", s->trials[k].load, s->unit,
             failure_share(s, s->trials[k].load) * s->seeds, s->seeds);
}

/** Prints between which factors a body fails whose load is a strength reduction, and by how much that of a step in the
 * ground may be too high. */
static void tell_factor(const Search *s, double bears, double fails)
{
  const Trial *low = trial_at(s, bears), *high = failing_at(s, fails);
  if (!low || !high) return;
  const double borne = fabs(low->load), not = fabs(high->load), factor = low->measure[REDUCTION];
  if (isnan(factor) || fabs(factor - borne) > 1e-5 * borne)
    return; /* the load is another one; six digits are written */
  printf("factor of safety: between %.4g and %.4g\n", borne, not );
  if (low->measure[STEP] > 0)
    printf("at %.0f spacings across the height of the ground's step it may be too high by some %.0f %%: halve the "
           "spacing and compare; 'breccia check' says whether it may be too low\n",
           low->measure[STEP], 100 * low->measure[EXCESS]);
}

void failure_tell(const Search *s, double sign)
{
  bool told[REASONS] = {false};
  double bears, fails;
  failure_bracket(s, &bears, &fails);
  const Trial *high = failing_at(s, fails), *low = trial_at(s, bears);
  tell_order(s, fails);
  tell_shares(s);
  if (high->verdict == DOUBTFUL)
    printf("\nbears %.9g%s; no verdict from %.9g%s on (%s): %s\n", sign * bears, s->unit, sign * fails, s->unit, s->key,
           failure_reason(high->reason));
  else
    printf("\nfails between %.9g%s and %.9g%s (%s): a body bears a load if forces out of balance are at most %g of "
           "those that act in the end, kinetic energy at most %g of the work, displacement grows at most %g times as "
           "fast with the load as at first, and nothing makes its rest doubtful\n",
           sign * bears, s->unit, sign * fails, s->unit, s->key, s->rest, s->rest, s->rate);
  tell_factor(s, bears, fails);
  for (int k = 0; k < s->count; ++k) {
    const Trial *t = &s->trials[k];
    if (t->reason == NO_REASON || told[t->reason]) continue;
    told[t->reason] = true;
    printf("%s: %s\n", outcome_of(t), failure_reason(t->reason));
  }
  for (int k = 0; k < s->count; ++k)
    if (s->trials[k].settles)
      printf(
          "under %.9g%s it still came to rest when the run ended: a longer 'longest hold' of 'quasi-static' may find "
          "that it bears this load\n",
          s->trials[k].load, s->unit);
  if (low) tell_warnings(s, low);
  if (high != low) tell_warnings(s, high);
}
