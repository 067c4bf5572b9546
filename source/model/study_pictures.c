/* What the cases of a study gave, drawn: their curves in one picture, and results over the first varied key. */
#include "base/memory.h"
#include "model/study_report.h"
#include "results/curve.h"
#include "results/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int study_draw_curves(StudyReport *report, Error *error)
{
  const char **folders = memory_plain((size_t)report->study->count + 1, sizeof *folders);
  int done = 0, status = folders ? BRECCIA_OK : error_add(error, BRECCIA_FAILURE, "out of memory: study");
  for (int k = 0; folders && k < report->study->count; ++k)
    if (report->states[k] == BRECCIA_CASE_DONE) folders[done++] = report->study->cases[k].folder;
  for (int c = 0; c < report->curve_count && done && !status; ++c) {
    char name[160];
    curve_name(report->curves[c], name, sizeof name);
    char *path = text_format("%s/%s.png", report->plan->folder, name);
    const CurveOptions o = {.title = "", .low = NAN, .high = NAN};
    status = path ? curve_draw(folders, done, report->curves[c], &o, path, error) : BRECCIA_FAILURE;
    if (!status) text_add(report->files, "  %s\n", path);
    free(path);
  }
  free(folders);
  return status;
}

/** The number of a value and what stands behind it. @return false if it is none */
static bool number_of(const char *words, double *value, const char **unit)
{
  char *end;
  *value = strtod(words, &end);
  *unit = end + strspn(end, " ");
  return end != words && isfinite(*value);
}

/** Whether a varied key takes numbers of one unit. */
static bool is_axis(const Varied *varied, const char **unit)
{
  double ignored;
  for (int k = 0; k < varied->count; ++k) {
    const char *other;
    if (!number_of(varied->values[k], &ignored, k ? &other : unit) || (k && strcmp(other, *unit) != 0)) return false;
  }
  return varied->count > 1;
}

static bool same_line(const Study *study, const StudyCase *a, const StudyCase *b, bool together)
{
  for (int v = 1; v < study->varied_count && !together; ++v)
    if (a->which[v] != b->which[v]) return false;
  return true;
}

/** A result over the first varied key, with a line for each combination of the others. */
static int draw_result(StudyReport *report, const StudyResult *result, const char *unit, Error *error)
{
  const Study *study = report->study;
  PlotLine *lines = memory_plain((size_t)study->count, sizeof *lines);
  double *x = memory_plain((size_t)study->count * 2 + 1, sizeof *x), *y = x + study->count;
  char **titles = memory_plain((size_t)study->count, sizeof *titles);
  int count = 0, used = 0, status = BRECCIA_OK;
  if (!lines || !x || !titles) status = error_add(error, BRECCIA_FAILURE, "out of memory: study");
  for (int first = 0; first < study->count && !status; ++first) {
    const StudyCase *one = &study->cases[first];
    bool known = false;
    for (int k = 0; k < first; ++k) known |= same_line(study, one, &study->cases[k], report->plan->together);
    if (known) continue;
    Text title = {0};
    for (int v = 1; v < study->varied_count && !report->plan->together; ++v)
      text_add(&title, "%s%s %s", v > 1 ? ", " : "", study_key(study, v), study->varied[v].values[one->which[v]]);
    titles[count] = title.characters;
    lines[count] = (PlotLine){titles[count] ? titles[count] : "", x + used, y + used, 0, false, count, 0, NULL};
    for (int k = first; k < study->count; ++k) {
      const char *ignored;
      if (!same_line(study, one, &study->cases[k], report->plan->together)) continue;
      number_of(study->varied[0].values[study->cases[k].which[0]], &x[used], &ignored);
      y[used++] = result->values[k];
      ++lines[count].count;
    }
    ++count;
  }
  char name[RESULT_WORDS];
  text_file_name(result->words, name, sizeof name);
  char *path = text_format("%s/%s.png", report->plan->folder, name);
  const PlotOptions o = {.title = "",
                         .x = {study_key(study, 0), unit, NULL, false},
                         .y = {result->words, result->unit, NULL, false},
                         .low = NAN,
                         .high = NAN};
  if (!status) status = path ? plot_draw(lines, count, &o, path, error) : BRECCIA_FAILURE;
  if (!status) text_add(report->files, "  %s\n", path);
  free(path);
  for (int k = 0; titles && k < count; ++k) free(titles[k]);
  free(titles);
  free(x);
  free(lines);
  return status;
}

int study_draw_results(StudyReport *report, Error *error)
{
  const char *unit;
  int status = BRECCIA_OK;
  if (!is_axis(&report->study->varied[0], &unit)) return BRECCIA_OK;
  for (int r = 0; r < report->result_count && !status; ++r) {
    int there = 0;
    for (int k = 0; k < report->study->count; ++k) there += isfinite(report->results[r].values[k]);
    if (there > 1) status = draw_result(report, &report->results[r], unit, error);
  }
  return status;
}
