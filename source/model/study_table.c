/* What the cases of a study gave, side by side. */
#include "base/csv.h"
#include "base/memory.h"
#include "base/whole_file.h"
#include "deck/document.h"
#include "model/host.h"
#include "model/study_report.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is taken of a history ---- */

static double last_of(const double *values, int count)
{
  return values[count - 1];
}

static double maximum_of(const double *values, int count)
{
  double found = values[0];
  for (int k = 1; k < count; ++k) found = fmax(found, values[k]);
  return found;
}

static double minimum_of(const double *values, int count)
{
  double found = values[0];
  for (int k = 1; k < count; ++k) found = fmin(found, values[k]);
  return found;
}

static double peak_of(const double *values, int count)
{
  double found = values[0];
  for (int k = 1; k < count; ++k)
    if (fabs(values[k]) > fabs(found)) found = values[k];
  return found;
}

static const struct {
  const char *word, *meaning;
  double (*take)(const double *values, int count);
} takers[] = {{"peak", "farthest from zero, with its sign", peak_of},
              {"maximum", "largest", maximum_of},
              {"minimum", "smallest", minimum_of},
              {"last", "at the end", last_of}};
enum { TAKERS = sizeof takers / sizeof *takers };

static int add_result(StudyReport *report, const char *words, Error *error)
{
  for (int k = 0; k < report->result_count; ++k)
    if (!strcmp(report->results[k].words, words)) return BRECCIA_OK;
  if (report->result_count == STUDY_RESULTS)
    return error_add(error, BRECCIA_USER_ERROR, "--result: at most %d", STUDY_RESULTS);
  StudyResult *r = &report->results[report->result_count];
  *r = (StudyResult){.taker = -1};
  snprintf(r->words, sizeof r->words, "%s", words);
  const size_t first = strcspn(words, " ");
  for (int k = 0; k < TAKERS; ++k)
    if (strlen(takers[k].word) == first && !strncmp(words, takers[k].word, first)) r->taker = k;
  if (r->taker >= 0) {
    const char *name = words + first + strspn(words + first, " "), *dot = strrchr(name, '.');
    if (!dot || dot == name || !dot[1])
      return error_add(error, BRECCIA_USER_ERROR, "--result: '%s' should be like '%s watch.column'", words,
                       takers[r->taker].word);
    snprintf(r->watch, sizeof r->watch, "%.*s", (int)(dot - name), name);
    snprintf(r->column, sizeof r->column, "%s", dot + 1);
  }
  r->values = memory_plain((size_t)report->study->count + 1, sizeof(double));
  if (!r->values) return error_add(error, BRECCIA_FAILURE, "out of memory: study");
  ++report->result_count;
  return BRECCIA_OK;
}

static int add_curve(StudyReport *report, const char *words, Error *error)
{
  if (report->curve_count == STUDY_RESULTS)
    return error_add(error, BRECCIA_USER_ERROR, "--curve: at most %d", STUDY_RESULTS);
  report->curves[report->curve_count] = text_format("%s", words);
  return report->curves[report->curve_count++] ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: study");
}

/** The curves that the deck draws. Those of the first case stand for all. */
static int add_curves_of_deck(StudyReport *report, Error *error)
{
  const char *deck = report->study->cases[0].deck;
  Document *document = document_parse(deck, strlen(deck), "deck", error);
  const Node *pictures = document ? node_get(document->root, "pictures") : NULL;
  int status = document ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int k = 0; pictures && k < pictures->count && !status; ++k) {
    const Node *curve = node_get(&pictures->items[k], "curve");
    if (curve && curve->kind == NODE_SCALAR) status = add_curve(report, curve->text, error);
  }
  document_destroy(&document);
  return status;
}

static int choose_results(StudyReport *report, Error *error)
{
  const breccia_study_plan *plan = report->plan;
  int status = BRECCIA_OK;
  for (int k = 0; k < plan->curve_count && !status; ++k) status = add_curve(report, plan->curves[k], error);
  if (!plan->curve_count && !status) status = add_curves_of_deck(report, error);
  for (int k = 0; k < plan->result_count && !status; ++k) status = add_result(report, plan->results[k], error);
  if (plan->result_count || status) return status;
  static const char *const usual[] = {"peaks.displacement", "broken_bonds", "energy.imbalance"};
  for (size_t k = 0; k < sizeof usual / sizeof *usual && !status; ++k) status = add_result(report, usual[k], error);
  for (int k = 0; k < report->curve_count && !status; ++k) {
    CurveNames names;
    if (curve_names(report->curves[k], &names)) continue;
    for (int c = 1; c < names.count && !status; ++c) {
      char words[2 * CURVE_NAME + 8];
      snprintf(words, sizeof words, "peak %s.%s", names.watch[c], names.column[c]);
      status = add_result(report, words, error);
    }
  }
  return status;
}

/* ---- values ---- */

/* Units of the numbers of summary.json, by how their names begin: keys of its map `units`. */
static const struct {
  const char *begin, *unit;
} figure_units[] = {{"energy.imbalance", NULL},
                    {"energy.", "energies"},
                    {"peaks.displacement", "positions and displacements"},
                    {"peaks.velocity", "velocities"},
                    {"peaks.octahedral", "stresses"},
                    {"peaks.mean", "stresses"},
                    {"time", "times"},
                    {"stable_time_step", "times"}};

static void find_unit(const Node *summary, StudyResult *result)
{
  for (size_t k = 0; k < sizeof figure_units / sizeof *figure_units; ++k) {
    if (strncmp(result->words, figure_units[k].begin, strlen(figure_units[k].begin)) != 0) continue;
    const Node *unit = figure_units[k].unit ? node_get(node_get(summary, "units"), figure_units[k].unit) : NULL;
    if (unit && unit->kind == NODE_SCALAR) snprintf(result->unit, sizeof result->unit, "%s", unit->text);
    return;
  }
}

/** A number of summary.json under a path like "peaks.displacement". */
static double figure(const Node *root, const char *path)
{
  const Node *node = root;
  for (const char *next = path; node && *next;) {
    const size_t n = strcspn(next, ".");
    const Node *found = NULL;
    for (int k = 0; node->kind == NODE_MAP && k < node->count; ++k)
      if (strlen(node->items[k].key) == n && !strncmp(node->items[k].key, next, n)) found = &node->items[k];
    node = found;
    next += n + (next[n] == '.');
  }
  char *end;
  const double value = node && node->kind == NODE_SCALAR ? strtod(node->text, &end) : NAN;
  return node && node->kind == NODE_SCALAR && end != node->text && !*end ? value : NAN;
}

static int read_summary_figures(StudyReport *report, int k, Error *error)
{
  char *path = text_format("%s/summary.json", report->study->cases[k].folder),
       *text = path ? text_read_file(path, NULL) : NULL;
  Document *document = text ? document_parse(text, strlen(text), path, error) : NULL;
  const int status = document || !text ? BRECCIA_OK : BRECCIA_USER_ERROR;
  for (int r = 0; r < report->result_count; ++r) {
    StudyResult *result = &report->results[r];
    if (result->taker >= 0) continue;
    result->values[k] = document ? figure(document->root, result->words) : NAN;
    if (document) find_unit(document->root, result);
  }
  document_destroy(&document);
  free(text);
  free(path);
  return status;
}

static double read_history_figure(const StudyCase *one, StudyResult *r, Error *error)
{
  char file[CURVE_NAME], label[128] = "";
  text_file_name(r->watch, file, sizeof file);
  char *path = text_format("%s/%s.csv", one->folder, file);
  int count = 0;
  double *values = path ? csv_column(path, r->column, CSV_LIVING, &count, label, error) : NULL;
  const double value = values && count ? takers[r->taker].take(values, count) : NAN;
  const char *open = strrchr(label, '(');
  if (values && open) snprintf(r->unit, sizeof r->unit, "%.*s", (int)strcspn(open + 1, ")"), open + 1);
  free(values);
  free(path);
  return value;
}

static int read_values(StudyReport *report, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < report->study->count && !status; ++k) {
    const StudyCase *one = &report->study->cases[k];
    const bool there = (report->states[k] = study_state(one)) == BRECCIA_CASE_DONE;
    if (there) status = read_summary_figures(report, k, error);
    for (int r = 0; r < report->result_count && !status; ++r) {
      StudyResult *result = &report->results[r];
      if (!there)
        result->values[k] = NAN;
      else if (result->taker >= 0) {
        const int before = error_count(error);
        result->values[k] = read_history_figure(one, result, error);
        if (error_count(error) > before) status = BRECCIA_USER_ERROR;
      } else if (isnan(result->values[k]))
        status = error_add(
            error, BRECCIA_USER_ERROR,
            "--result: %s/summary.json has no number '%s'; a number of it is named like peaks.displacement, one "
            "of a history like 'peak watch.column' (or maximum, minimum, last)",
            one->folder, result->words);
    }
  }
  return status;
}

/* ---- tables ---- */

static int write_text(StudyReport *report, const char *name, const Text *words, Error *error)
{
  char *path = text_format("%s/%s", report->plan->folder, name);
  const int status = path ? whole_file_write(path, words, error)
                          : error_add(error, BRECCIA_FAILURE, "%s: cannot be written: out of memory", name);
  if (!status) text_add(report->files, "  %s\n", path);
  free(path);
  return status;
}

static void add_cell(Text *text, const char *words)
{
  if (strpbrk(words, ",\"\n")) {
    text_add(text, "\"");
    for (; *words; ++words) text_add(text, *words == '"' ? "\"\"" : "%c", *words);
    text_add(text, "\"");
  } else
    text_add(text, "%s", words);
}

static const char *state_words(int state)
{
  static const char *const words[] = {[BRECCIA_CASE_NEW] = "not run",
                                      [BRECCIA_CASE_STOPPED] = "stopped",
                                      [BRECCIA_CASE_FAILED] = "failed",
                                      [BRECCIA_CASE_DONE] = "done"};
  return words[state];
}

static int write_csv(StudyReport *report, Error *error)
{
  const Study *study = report->study;
  Text text = {0};
  text_add(&text, "case");
  for (int v = 0; v < study->varied_count; ++v) {
    text_add(&text, ",");
    add_cell(&text, study->varied[v].key);
  }
  text_add(&text, ",state");
  for (int r = 0; r < report->result_count; ++r) {
    const StudyResult *result = &report->results[r];
    char heading[RESULT_WORDS + 72];
    snprintf(heading, sizeof heading, *result->unit ? "%s (%s)" : "%s", result->words, result->unit);
    text_add(&text, ",");
    add_cell(&text, heading);
  }
  text_add(&text, "\n");
  for (int k = 0; k < study->count; ++k) {
    add_cell(&text, study->cases[k].name);
    for (int v = 0; v < study->varied_count; ++v) {
      text_add(&text, ",");
      add_cell(&text, study->varied[v].values[study->cases[k].which[v]]);
    }
    text_add(&text, ",%s", state_words(report->states[k]));
    for (int r = 0; r < report->result_count; ++r)
      if (isfinite(report->results[r].values[k]))
        text_add(&text, ",%.10g", report->results[r].values[k]);
      else
        text_add(&text, ",");
    text_add(&text, "\n");
  }
  const int status = write_text(report, "table.csv", &text, error);
  text_free(&text);
  return status;
}

/** The words of a cell: row -1 is the heading, columns are the varied keys, the state, and the results. */
static void cell_words(const StudyReport *report, int row, int column, char *words, size_t size)
{
  const Study *study = report->study;
  const int r = column - study->varied_count - 1;
  if (column < study->varied_count)
    snprintf(words, size, "%s",
             row < 0 ? study->varied[column].key : study->varied[column].values[study->cases[row].which[column]]);
  else if (r < 0)
    snprintf(words, size, "%s", row < 0 ? "state" : state_words(report->states[row]));
  else if (row < 0)
    snprintf(words, size, *report->results[r].unit ? "%s (%s)" : "%s", report->results[r].words,
             report->results[r].unit);
  else if (isfinite(report->results[r].values[row]))
    snprintf(words, size, "%.5g", report->results[r].values[row]);
  else
    snprintf(words, size, "-");
}

static int write_table(StudyReport *report, Text *text, Error *error)
{
  const int columns = report->study->varied_count + 1 + report->result_count;
  for (int row = -1; row < report->study->count; ++row)
    for (int c = 0; c < columns; ++c) {
      int width = 0;
      char words[512];
      for (int other = -1; other < report->study->count; ++other) {
        cell_words(report, other, c, words, sizeof words);
        if ((int)strlen(words) > width) width = (int)strlen(words);
      }
      cell_words(report, row, c, words, sizeof words);
      text_add(text, "%*s%s", width, words, c + 1 < columns ? "  " : "\n");
    }
  return write_text(report, "table.txt", text, error);
}

static int make_report(Study *study, Error *error)
{
  StudyReport report = {.study = study, .plan = &study->plan, .files = &study->files};
  report.states = memory_plain((size_t)study->count + 1, sizeof *report.states);
  int status =
      report.states ? choose_results(&report, error) : error_add(error, BRECCIA_FAILURE, "out of memory: study");
  if (!status) status = read_values(&report, error);
  if (!status) status = write_csv(&report, error);
  if (!status) status = write_table(&report, &study->table, error);
  if (!status) status = study_draw_curves(&report, error);
  if (!status) status = study_draw_results(&report, error);
  for (int r = 0; r < report.result_count; ++r) free(report.results[r].values);
  for (int c = 0; c < report.curve_count; ++c) free(report.curves[c]);
  free(report.states);
  return status;
}

int breccia_study_report(breccia_study *study, breccia_error *error)
{
  if (host_lacks(study, __func__, "study", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  text_free(&study->table);
  text_free(&study->files);
  const int status = make_report(study, error);
  return host_leave(&host, status, error);
}

int breccia_study_figure(const breccia_study *study, int k, const char *name, double *value)
{
  if (!study || !name || !value) return 0;
  *value = NAN;
  if (k < 0 || k >= study->count) return 0;
  const Host host = host_enter();
  char *path = text_format("%s/summary.json", study->cases[k].folder), *text = path ? text_read_file(path, NULL) : NULL;
  Document *document = text ? document_parse(text, strlen(text), path, NULL) : NULL;
  if (document) *value = figure(document->root, name);
  document_destroy(&document);
  free(text);
  free(path);
  host_leave(&host, BRECCIA_OK, NULL);
  return !isnan(*value);
}
